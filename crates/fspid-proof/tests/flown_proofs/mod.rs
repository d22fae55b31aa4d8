//! Proved loops, flown: drawn scenarios with every option that a proof accepts, over their whole range of
//! set-points and loads, for 20 time constants of the proved rate. Thousands by the example `refute_proofs`.

mod disturbed;
mod drawn;
mod flown;
mod moving_bounds;
mod scaled;
mod worst;

use drawn::Dice;
use flown::Answer;
use fspid_sim::Scenario;

/// With these numbers fixed and moving gains, refutations, and claims over a range come up, quickly.
const SCENARIOS: [u64; 6] = [0, 2, 4, 5, 9, 11];

/// With these numbers gains that remember, reference models, numbers and followers are proved, over a range as well.
const STRUCTURES: [u64; 4] = [1, 4, 9, 10];

#[test]
fn every_flight_of_a_proved_loop_of_another_structure_settles_over_its_whole_range() {
    settle(&STRUCTURES, drawn::structured);
}

/// With these numbers networks are proved quickly, with gains that remember and over a range as well.
const NETWORKS: [u64; 4] = [4, 6, 7, 10];

#[test]
fn every_flight_of_a_proved_loop_with_a_network_settles_over_its_whole_range() {
    settle(&NETWORKS, drawn::networked);
}

#[test]
fn every_flight_of_a_proved_loop_settles_over_its_whole_range() {
    settle(&SCENARIOS, drawn::scenario);
}

/// Flies what is drawn with these numbers; none of what is proved may be contradicted.
fn settle(seeds: &[u64], drawn: fn(&mut Dice) -> Scenario) {
    // One of these takes a minute, and the test runner's other threads have nothing left by then.
    let counts = std::thread::scope(|scope| {
        let started = seeds.chunks(seeds.len().div_ceil(4)).map(|some| {
            scope.spawn(move || some.iter().map(|&seed| settled(seed, drawn)).collect::<Vec<_>>())
        });
        let started: Vec<_> = started.collect();
        started.into_iter().flat_map(|it| it.join().expect("no claim is contradicted")).collect()
    });
    let counts: Vec<Option<bool>> = counts;
    let proved = counts.iter().flatten().count();
    let held = counts.iter().flatten().filter(|&&held| held).count();
    assert!(proved >= 3 && held >= 1, "{proved} proved, {held} of them over a range of set-points");
}

/// Whether it is proved over a range of set-points that moving gains act on; `None` where nothing is proved.
fn settled(seed: u64, drawn: fn(&mut Dice) -> Scenario) -> Option<bool> {
    match flown::answer(&drawn(&mut Dice::new(seed))) {
        Answer::Contradicted(reason) => panic!("scenario {seed}: {reason}"),
        Answer::Settled { held, .. } => Some(held),
        Answer::NotProvable(_) | Answer::Open | Answer::Refuted => None,
    }
}

#[test]
fn every_flight_of_a_proved_step_ends_where_it_is_claimed_with_its_limits() {
    // Two of the six take half a minute of a processor each.
    let is_long = std::env::var_os("FSPID_LONG_TESTS").is_some();
    let (seeds, least) = if is_long { (vec![0, 1, 2, 3, 4, 5], 2) } else { (vec![0, 1, 3, 4], 1) };
    let mut stepped = 0;
    for seed in seeds {
        match flown::answer(&drawn::with_limits(&mut Dice::new(seed))) {
            Answer::Contradicted(reason) => panic!("scenario {seed}: {reason}"),
            Answer::Settled { stepped: here, .. } => stepped += usize::from(here),
            Answer::NotProvable(_) | Answer::Open | Answer::Refuted => {}
        }
    }
    assert!(stepped >= least, "{stepped} with steps");
}
