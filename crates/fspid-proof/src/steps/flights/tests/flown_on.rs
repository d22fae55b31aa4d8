//! How a set is flown on: from where, how far, with how many unknowns, and what is forgotten before the next.

use super::self_tuned::SelfTuned;
use super::*;
use crate::steps::commands::Shares;

const PATCH: Patch = Patch { setpoint: [0.01, 0.0101], load: [0.0, 0.0] };

fn from_the_first_sample<'a>(commands: &'a Commands) -> Way<'a> {
    Way { commands, patch: PATCH, from: Beginning::Controller }
}

#[test]
fn who_gives_up_tells_how_many_samples_were_flown_from_where_it_was_flown_on() {
    let loop_ = Loop::new();
    let mut ready = loop_.ready();
    let commands = Commands::step();
    let way = from_the_first_sample(&commands);
    let begun = ready.begun(Beginning::Controller);
    let at_five = ready.until(&way, begun, 0..5).expect("known");
    ready.flown.config.guard = Guard::new(0.001).expect("allowed");
    let given_up = ready.until(&way, at_five.clone(), 5..20).map(|_| ());
    assert_eq!(given_up, Err((Stop::Guard, 0)));
    assert_eq!(ready.landed(&way, at_five, 5..20), Err((Stop::Guard, 0)));
}

#[test]
fn flights_are_looked_at_every_so_many_samples_after_the_last_change() {
    let loop_ = Loop::new();
    let mut ready = loop_.ready();
    for last in [3, 5] {
        let pulse = Shares(vec![(0, 1.0), (last, 0.9)]);
        let commands = Commands { setpoint: pulse, ..Commands::step() };
        let way = from_the_first_sample(&commands);
        let begun = ready.begun(Beginning::Controller);
        let landed = ready.landed(&way, begun, 0..20_000).expect("it lands");
        assert!((landed.samples - last).is_multiple_of(LOOKS), "{last}: {landed:?}");
    }
}

/// The first sample of a controller has none before it, whose difference it could take.
#[test]
fn only_the_controllers_first_sample_is_flown_as_its_first() {
    let loop_ = Loop::new();
    let mut ready = loop_.ready();
    let commands = Commands::step();
    let first = from_the_first_sample(&commands);
    let later = Way { from: Beginning::Rest, ..first };
    let begun = ready.begun(Beginning::Controller);
    let mut flown = |way: &Way<'_>, sample: usize, moment: Moment| {
        let mut flight = begun.clone();
        commanded(&ready.flown, &mut flight, way, sample);
        let expected = ready.after(&flight, moment).expect("known").values;
        let found = ready.until(way, begun.clone(), sample..sample + 1).expect("known").values;
        assert!(found == expected, "{sample}, {:?}", way.from);
        found
    };
    let at_first = flown(&first, 0, Moment::First);
    assert!(at_first != flown(&later, 0, Moment::Later), "the first sample is like no other");
    flown(&first, 1, Moment::Later);
    flown(&later, 1, Moment::Later);
}

#[test]
fn a_set_that_is_far_off_or_has_a_ball_without_end_is_given_up() {
    let loop_ = Loop::new();
    let mut ready = loop_.ready();
    let commands = Commands::step();
    let way =
        Way { patch: Patch { load: [-0.002, 0.001], ..PATCH }, ..from_the_first_sample(&commands) };
    let far = FAR * (0.0101 + 0.002);
    // Where a sample moves nothing but the pitch by its set-point, it stays where it is.
    for (share, is_known) in [(0.97, true), (1.03, false), (-0.97, true), (-1.03, false)] {
        let mut flight = ready.begun(Beginning::Rest);
        flight.values[0].centre = share * far;
        let next = ready.after(&flight, Moment::Later).expect("known");
        let share_then = next.values[0].magnitude() / far;
        assert!((share_then - libm::fabs(share)).abs() < 0.02, "{share_then}");
        let found = ready.until(&way, flight, 1..2);
        assert_eq!(found.is_ok(), is_known, "{share}");
        assert!(is_known || found.is_err_and(|stopped| stopped == (Stop::Lost, 0)));
    }
    let endless = Flight { ball: f64::INFINITY, ..ready.begun(Beginning::Rest) };
    assert!(ready.until(&way, endless, 1..2).is_err());
}

/// Nothing is cut, so that a sample adds no unknown.
#[test]
fn the_smallest_unknowns_become_a_ball_when_there_are_more_than_are_told_apart() {
    let loop_ = Loop::new();
    let mut ready = loop_.ready();
    for (symbols, left) in [
        (MOST_SYMBOLS - 1, MOST_SYMBOLS - 1),
        (MOST_SYMBOLS, MOST_SYMBOLS),
        (MOST_SYMBOLS + 1, OWN + KEPT_SYMBOLS),
    ] {
        let flight = with_unknowns(&ready, &mut Dice::new(7), symbols, 1e-6);
        let flight = Flight { ball: 1e-6, ..flight };
        let next = ready.after(&flight, Moment::Later).expect("known");
        assert_eq!((next.symbols, next.limited), (left, false));
    }
}

#[test]
fn where_rest_is_not_known_to_the_digit_a_set_has_to_be_nearer() {
    let loop_ = Loop::new();
    let mut ready = loop_.ready();
    let rest = at_rest(&ready);
    let size = rest.setpoint.magnitude() + rest.load.magnitude();
    for (share, is_near) in [(1.0 - HAIR, true), (1.0 + HAIR, false)] {
        ready.off_rest = share * ready.within / size;
        assert_eq!(ready.is_near(&rest), is_near, "{share}");
    }
}

/// Entries are compared as parts of themselves where they are large, and as they are where they are small.
#[test]
fn what_rounding_makes_of_an_entry_does_not_make_another_loop_of_it() {
    let loop_ = Loop::new();
    let ready = loop_.ready();
    let at_rest = ready.flown.gains.at_rest();
    let is_the_model = |change: &dyn Fn(Interval) -> Interval, row: usize, column: usize| {
        let mut other = ready.clone();
        let entry = &mut other.flown.plant[row][column];
        *entry = change(*entry);
        other.is_the_model(&loop_.model, at_rest)
    };
    let entries = (0..ready.flown.plant.len())
        .flat_map(|row| (0..ready.flown.plant[row].len()).map(move |column| (row, column)));
    let mut largest = (0.0, 0, 0);
    for (row, column) in entries {
        let by = Interval::point(8e-10);
        assert!(is_the_model(&|entry| entry + by, row, column), "{row} {column}");
        let size = ready.flown.plant[row][column].magnitude();
        if size > largest.0 {
            largest = (size, row, column);
        }
    }
    let (size, row, column) = largest;
    assert!(size > 0.5, "{size}");
    let by = |off: f64| move |entry: Interval| entry + Interval::point(off);
    assert!(is_the_model(&by(1e-9 * (1.0 + 0.8 * size)), row, column));
    assert!(!is_the_model(&by(1e-9 * (1.0 + 1.2 * size)), row, column));
}

/// What is answered depends on nothing that another set has asked.
#[test]
fn what_gains_were_asked_for_is_forgotten_before_another_set() {
    let without_memory = SelfTuned::without_memory();
    let mut ready = without_memory.ready();
    let asked = |ready: &Ready<'_>, most: f64| {
        let side = Interval::between(0.0, most);
        ready.flown.gains.seen(side, side).expect("some")
    };
    let alone = asked(&ready, 0.016);
    ready.begun(Beginning::Rest);
    asked(&ready, 0.02);
    assert!(asked(&ready, 0.016) != alone, "it is answered as the wider one was");
    ready.begun(Beginning::Rest);
    assert_eq!(asked(&ready, 0.016), alone);
}
