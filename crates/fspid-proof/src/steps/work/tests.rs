//! What is counted as work, and which form falls for all gains.

use fspid_core::fuzzy::{Defuzzifier, OutOfRange, Supervisor};
use fspid_core::{ControllerSetting, Fspid, Limits, Pid, PidConfig, SelfTuner, TunerSettings};
use fspid_lti::Matrix;
use fspid_sim::actuator::Actuator;

use super::*;
use crate::steps::commands::{Commands, Shares};
use crate::steps::flights::Patch;
use crate::steps::flights::tests::self_tuned::SelfTuned;
use crate::steps::tests::navion::{GAINS, navion, proved};

fn config() -> PidConfig<f64> {
    let limits = Limits::new(ControllerSetting::OutputLimits, -0.35, 0.35).expect("allowed");
    PidConfig { limits: Some(limits), ..PidConfig::sampled_every(0.02) }
}

/// The Navion.
fn fixed() -> LoopDescription {
    navion(
        Actuator::first_order(0.1).expect("allowed"),
        Controller::Fixed(Pid::new(GAINS, config()).expect("allowed")),
    )
}

fn with_flights(asks: impl FnOnce(Flights<'_>)) {
    let certificate = proved(&fixed());
    let terminal = &certificate.steps.as_ref().expect("steps are proved").terminal;
    let model = fixed().enclosed().expect("enclosed");
    let set = GainSet::fixed(GAINS);
    let flights = Flights::of(&certificate, &model, &set, terminal, None);
    asks(flights.expect("enclosed"));
}

#[test]
fn the_form_that_falls_for_all_gains_is_that_of_the_claim_with_its_rate_where_gains_move() {
    let claimed = |rate: f64| Claim::CommonQuadratic { form: Matrix::identity(2), rate };
    let form = Matrix::identity(2).scaled(3.0);
    let terminal = Terminal { form, rate: 0.99, level: 7.0, gains: None };
    let mut certificate = Certificate { claim: claimed(0.9), ..proved(&fixed()) };
    assert_eq!(common(&certificate, &terminal), terminal, "gains stand still");
    let (rules, rule) = (fspid_core::paper::rules(), Defuzzifier::Exact);
    let labels = Supervisor::new(&rules, 5.0, rule, OutOfRange::Clamp).expect("allowed");
    let tuner = SelfTuner::new(GAINS, labels, TunerSettings::literal()).expect("allowed");
    let fspid = Fspid::new(tuner, config()).expect("allowed");
    certificate.description.controller = Controller::SelfTuning(fspid);
    let of_claim = Terminal { form: Matrix::identity(2), rate: 0.9, ..terminal.clone() };
    assert_eq!(common(&certificate, &terminal), of_claim);
    certificate.claim = claimed(1.0);
    assert_eq!(common(&certificate, &terminal), terminal, "it does not fall");
}

#[test]
fn of_two_the_later_counts_and_the_work_of_both() {
    let one = Landed { flown: 2, samples: 9, limited: true };
    let other = Landed { flown: 3, samples: 4, limited: false };
    let both = Landed { flown: 5, samples: 9, limited: true };
    assert_eq!([one.worse(other), other.worse(one)], [both; 2]);
}

#[test]
fn a_flight_may_go_beyond_the_most_work_by_its_own_length_and_none_begins_there() {
    with_flights(|mut flights| {
        (flights.each, flights.longest, flights.most) = (6, 10, 6000);
        for (flown, left) in
            [(600, Ok(900)), (5990, Ok(10)), (6000, Ok(10)), (6001, Err(Stop::Work))]
        {
            flights.flown = flown;
            assert_eq!(flights.left(), left, "{flown}");
        }
        let commands = Commands::step();
        let from = Beginning::Controller;
        let patch = Patch { setpoint: [0.0099, 0.01], load: [0.0; 2] };
        let way = Way { commands: &commands, patch, from };
        let begun = flights.begun(from);
        flights.flown = 5990;
        assert_eq!(flights.until(&way, begun.clone(), [3, 14]).err(), Some(Stop::Work));
        assert!(flights.until(&way, begun, [3, 13]).is_ok());
        assert_eq!(flights.flown, 5990 + 10 * 6);
        flights.flown = 0;
        flights.halted.store(true, Ordering::Relaxed);
        assert_eq!(flights.left(), Err(Stop::Lost));
    });
}

#[test]
fn a_search_may_take_its_part_of_more_than_a_check_and_is_stopped_by_who_asked() {
    with_flights(|mut flights| {
        flights.most = 1000;
        let search = flights.searching(0.5, || true);
        assert_eq!((search.most, search.paced), (3000, true));
        assert!(search.is_stopped() && search.left() == Err(Stop::Lost));
        assert!(!search.another().is_stopped(), "another is told by `halted` alone");
        assert_eq!(search.another().most, 3000);
    });
}

#[test]
fn what_was_flown_until_it_landed_or_was_given_up_is_counted_as_often_as_a_sample_costs() {
    with_flights(|mut flights| {
        assert_eq!(flights.rests_s(), None, "gains stand still");
        let from = Beginning::Controller;
        let commands = Commands::step();
        let patch = Patch { setpoint: [0.0099, 0.01], load: [0.0; 2] };
        let way = Way { commands: &commands, patch, from };
        let begun = flights.begun(from);
        flights.each = 6;
        let landed = flights.landed(&way, begun.clone(), 0).expect("it lands");
        assert_eq!(flights.flown, 6 * landed.flown);
        flights.flown = 0;
        flights.longest = landed.flown / 2;
        assert_eq!(flights.landed(&way, begun.clone(), 0).err(), Some(Stop::Lost));
        assert_eq!(flights.flown, 6 * (landed.flown / 2));
        // A last change may be as far as what is left, and no further.
        (flights.flown, flights.longest, flights.most) = (0, 10, 6 * 40);
        let later = |last: usize| {
            let pulse = Shares(vec![(0, 1.0), (last, 0.5)]);
            Commands { setpoint: pulse, ..Commands::step() }
        };
        for (last, stop) in [(40, Stop::Lost), (41, Stop::Work)] {
            let commands = later(last);
            let way = Way { commands: &commands, ..way };
            flights.flown = 0;
            assert_eq!(flights.landed(&way, begun.clone(), 0).err(), Some(stop), "{last}");
        }
    });
}

#[test]
fn a_rest_is_that_of_gains_that_remember_and_what_was_asked_is_forgotten() {
    let asked = |flights: &Flights<'_>, most: f64| {
        let side = Interval::between(0.0, most);
        flights.ready.flown.gains.seen(side, side).expect("some")
    };
    with_flights(|flights| {
        let remembering = SelfTuned::remembering();
        let of_gains = Flights { ready: remembering.ready(), ..flights.clone() };
        assert_eq!(of_gains.rests_s(), of_gains.ready.rests_s());
        assert!(of_gains.rests_s().is_some());
        let without_memory = SelfTuned::without_memory();
        let mut flights = Flights { ready: without_memory.ready(), ..flights };
        let alone = asked(&flights, 0.016);
        flights.forget();
        asked(&flights, 0.02);
        assert!(asked(&flights, 0.016) != alone, "it is answered as the wider one was");
        flights.forget();
        assert_eq!(asked(&flights, 0.016), alone);
    });
}
