//! What is flown of what is commanded, and what is believed of it.

use super::*;
use crate::steps::commands::Shares;
use crate::steps::tests::allowed::{Found, jumping, limited, uneven};

const SMALL: Range = Range { setpoint_rad: 0.01, load_rad: 0.001 };

/// A set-point that steps at the first sample, and a load at the elevator later.
fn commands(later: usize) -> Commands {
    Commands {
        setpoint_rad: 0.01,
        load_rad: 0.001,
        setpoint: Shares(vec![(0, 1.0)]),
        at_servo: Shares::default(),
        at_elevator: Shares(vec![(later, 1.0)]),
    }
}

fn bits(ends: [f64; 2]) -> [u64; 2] {
    ends.map(|end| (end + 0.0).to_bits())
}

#[test]
fn all_that_is_commanded_is_flown_but_what_mirrors_it() {
    let setpoint_alone = Commands { load_rad: 0.0, ..commands(0) };
    let load_alone = Commands { setpoint_rad: 0.0, ..commands(0) };
    let both = |most: f64| [-most, most];
    let none = [0.0; 2];
    let cases = [
        (commands(0), false, both(0.01), both(0.001)),
        (commands(0), true, [0.0, 0.01], both(0.001)),
        (setpoint_alone.clone(), false, both(0.01), none),
        (setpoint_alone, true, [0.0, 0.01], none),
        (load_alone.clone(), false, none, both(0.001)),
        (load_alone, true, none, [0.0, 0.001]),
    ];
    for (commands, odd, setpoint, load) in cases {
        let found = whole(&commands, odd);
        assert_eq!(bits(found.setpoint), bits(setpoint), "{odd} {found:?}");
        assert_eq!(bits(found.load), bits(load), "{odd} {found:?}");
    }
}

#[test]
fn a_load_at_the_elevator_is_as_large_as_loads_are_and_one_at_the_servo_is_not_there() {
    assert_eq!(at_elevator_rad(&commands(3)).to_bits(), 0.001_f64.to_bits());
    let at_servo = Commands {
        at_servo: Shares(vec![(3, 1.0)]),
        at_elevator: Shares::default(),
        ..commands(3)
    };
    assert!(at_elevator_rad(&at_servo).abs() <= 0.0);
}

#[test]
fn parts_fill_a_group_from_the_least_to_the_largest_along_both() {
    let whole = Patch { setpoint: [-0.1, 0.3], load: [-0.02, 0.01] };
    let good = [-0.1, 0.0, 0.3];
    let loads = [-0.02, 0.01];
    let fills = |setpoints_rad: &[f64], loads_rad: &[f64]| {
        let ends = [setpoints_rad, loads_rad].map(<[f64]>::to_vec);
        let [setpoints_rad, loads_rad] = ends;
        Group { of: Vec::new(), setpoints_rad, loads_rad }.fills(whole).is_ok()
    };
    assert!(fills(&good, &loads) && fills(&[-0.2, 0.4], &[-0.1, 0.0, 0.0, 0.1]));
    let bad_setpoints: [&[f64]; 7] = [
        &[],
        &[-0.1],
        &[0.0, 0.3],
        &[-0.1, 0.2],
        &[-0.1, 0.4, 0.3],
        &[f64::NAN, 0.3],
        &[-0.1, f64::NAN],
    ];
    for bad in bad_setpoints {
        assert!(!fills(bad, &loads), "{bad:?}");
    }
    let bad_loads: [&[f64]; 5] = [&[], &[-0.02], &[0.0, 0.01], &[-0.02, 0.0], &[-0.02, 0.02, 0.01]];
    for bad in bad_loads {
        assert!(!fills(&good, bad), "{bad:?}");
    }
    // A part without width of what has none still has two ends.
    let point = Patch { setpoint: [0.0; 2], load: [0.0; 2] };
    let of = |ends: &[f64]| Group {
        of: Vec::new(),
        setpoints_rad: ends.to_vec(),
        loads_rad: vec![0.0; 2],
    };
    assert!(of(&[0.0; 2]).fills(point).is_ok() && of(&[0.0]).fills(point).is_err());
}

/// How often a way is tried that is flown in parts no wider than this, and what comes of it.
fn tried(way: [f64; 2], widest: f64) -> (usize, Result<Vec<f64>, Stop>) {
    let (mut tries, mut flown) = (0, Vec::new());
    let ends = swept(way, &mut |piece| {
        tries += 1;
        assert!(tries < 10_000, "it does not end");
        if (piece[1] - piece[0]).abs() > widest {
            return Err(Stop::Lost);
        }
        flown.push(piece);
        Ok(())
    });
    if let Ok(ends) = &ends {
        let pieces: Vec<[u64; 2]> = ends.windows(2).map(|it| bits([it[0], it[1]])).collect();
        let flown: Vec<[u64; 2]> = flown.into_iter().map(bits).collect();
        assert_eq!(pieces, flown, "each part is one that was flown");
    }
    (tries, ends)
}

#[test]
fn a_way_is_swept_in_parts_that_are_flown_and_given_up_at_the_narrowest() {
    let (tries, ends) = tried([-8.0, 8.0], 100.0);
    let ends = ends.expect("flown");
    assert_eq!(tries, ends.len() - 1);
    assert_eq!(bits([ends[0], ends[tries]]), bits([-8.0, 8.0]));
    let (_, ends) = tried([-8.0, 8.0], 0.1);
    assert!(ends.is_ok(), "wide enough that no half is narrower than a 512th of the whole");
    // From an eighth to a 512th: 2, 1, 1/2, ... 1/32.
    let (tries, ends) = tried([-8.0, 8.0], 0.03);
    assert_eq!((tries, ends.err()), (7, Some(Stop::Lost)));
    // What has no width is flown once.
    let (tries, ends) = tried([1.0, 1.0], 0.0);
    assert_eq!((tries, ends.map(|it| it.len()).ok()), (1, Some(2)));
    let (tries, ends) = tried([1.0, 1.0], -1.0);
    assert_eq!((tries, ends.err()), (1, Some(Stop::Lost)));
    let stopped = swept([0.0, 1.0], &mut |_| Err(Stop::Work));
    assert_eq!(stopped.err(), Some(Stop::Work));
}

#[test]
fn what_is_commanded_is_found_and_proved_for_each_side_that_is_its_own() {
    for (description, least) in [(uneven(false), -0.01), (limited(), 0.0)] {
        let found = Found::of(description, SMALL);
        // Both at once, and one after the other.
        for (later, count) in [(0, 1), (50, 2)] {
            let commanded = found.search().commanded(&commands(later)).expect("found");
            assert_eq!(commanded.legs.len(), count);
            let group = &commanded.legs[0].groups[0];
            let ends = [group.setpoints_rad[0], group.setpoints_rad[group.setpoints_rad.len() - 1]];
            assert_eq!(bits(ends), bits([least, 0.01]));
            let loads = &group.loads_rad;
            if later == 0 {
                let widths = loads.windows(2).map(|it| it[1] - it[0]);
                assert!(widths.clone().all(|width| (width - 0.000_25).abs() < 1e-12), "{loads:?}");
                assert_eq!(widths.count(), 8);
            }
            let ended = commanded.proved(found.checked()).expect("proved");
            assert_eq!(ended.sets, commanded.legs.iter().map(Leg::sets).sum::<usize>());
            assert!(ended.sets > 1 && ended.settled_s < 3.0, "{ended:?}");
            // Gains that stand still are all alike: what follows is flown of one group.
            assert!(commanded.legs.iter().all(|leg| leg.groups.len() == 1), "{commanded:?}");
        }
    }
}

#[test]
fn nothing_is_looked_for_beyond_the_range_or_where_a_load_is_seen_at_once() {
    let found = Found::of(limited(), SMALL);
    let larger = Commands { setpoint_rad: 0.011, ..commands(0) };
    assert_eq!(found.search().commanded(&larger), None);
    let found = Found::of(jumping(), SMALL);
    assert_eq!(found.search().commanded(&commands(0)), None);
}

#[test]
fn flights_of_one_side_or_of_legs_at_the_same_sample_are_not_believed() {
    let found = Found::of(uneven(false), SMALL);
    let good = found.search().commanded(&commands(0)).expect("found");
    let told = |change: &dyn Fn(&mut Commanded)| {
        let mut changed = good.clone();
        change(&mut changed);
        changed.proved(found.checked()).expect_err("refused")
    };
    let above = told(&|it| it.legs[0].groups[0].setpoints_rad.retain(|end| *end >= 0.0));
    assert!(above.contains("do not fill"), "{above}");
    let twice = told(&|it| it.legs.push(it.legs[0].clone()));
    assert!(twice.contains("do not follow"), "{twice}");
}

#[test]
fn one_set_is_flown_on_alone_and_several_are_joined() {
    let found = Found::of(limited(), SMALL);
    let mut flights = found.flights();
    let at_rest = flights.begun(Beginning::Controller);
    let of = |load: [f64; 2]| (Patch { setpoint: [0.0, 0.01], load }, at_rest.clone());
    let sets = [of([-0.001, 0.0]), of([0.0, 0.001])];
    let next = |places: &[usize]| Course::next(&flights, &sets, places.to_vec(), 50);
    let alone = next(&[1]).expect("there");
    assert!(matches!(alone.origin, Origin::Alone(_)) && alone.whole == sets[1].0);
    let joined = next(&[0, 1]).expect("there");
    assert!(matches!(joined.origin, Origin::Joined(..)));
    assert_eq!(bits(joined.whole.load), bits([-0.001, 0.001]));
    assert!(next(&[2]).is_none() && next(&[]).is_none());
}

#[test]
fn a_group_of_several_sets_that_is_not_flown_may_be_halved_and_one_alone_may_not() {
    let found = Found::of(uneven(false), SMALL);
    let commands = commands(0);
    let course = Course { commands: &commands };
    let legs = Legs { course, fineness: FINENESS[0] };
    // More load than the servo holds.
    let whole = Patch { setpoint: [0.0, 0.001], load: [0.28; 2] };
    let tried = |of: &[usize], change: fn(&mut Flights<'_>)| {
        let mut flights = found.flights();
        let start = Start { of: of.to_vec(), ..course.start(&mut flights, whole) };
        change(&mut flights);
        let tried = legs.tried(&mut flights, &[start], Along::Setpoint, None)?;
        Ok(tried.iter().map(Option::is_some).collect::<Vec<bool>>())
    };
    assert_eq!(tried(&[0, 1], |_| ()), Ok(vec![false]));
    assert_eq!(tried(&[0], |_| ()), Err(Stop::Guard));
    // Halves take no less work, and nobody waits for them.
    assert_eq!(tried(&[0, 1], |it| (it.flown, it.most) = (1, 0)), Err(Stop::Work));
    assert_eq!(tried(&[0, 1], |it| it.stops = || true), Err(Stop::Lost));
}

#[test]
fn flights_of_a_part_are_as_near_each_other_as_is_asked_where_a_leg_follows() {
    let found = Found::of(limited(), SMALL);
    let commands = commands(50);
    let course = Course { commands: &commands };
    let mut flights = found.flights();
    let start = course.start(&mut flights, whole(&commands, true));
    let of = (&start, start.whole);
    let flight = course.through(&mut flights, of, 50).expect("flown");
    // Of what set-point and load are together.
    let share = flights.apart_rad(&flight) / 0.011;
    assert!(share > 0.0, "{share}");
    let mut near = |apart: f64, to: Option<usize>| {
        let legs = Legs { course, fineness: Fineness { apart, gains: 0.1 } };
        legs.part(&mut flights, of, to).is_ok()
    };
    assert!(near(1.01 * share, Some(50)) && !near(0.99 * share, Some(50)));
    assert!(near(0.0, None), "of the last leg nothing is asked but that it lands");
}
