//! Gains that remember: where they are near those at rest, how much of their reach a set has, and what is gathered of them.

use super::self_tuned::{LEAKAGE_PER_S, SelfTuned};
use super::*;

/// Flights at their rests, with all the gains that are near.
fn near_rest(remembering: &SelfTuned, ready: &Ready<'_>) -> Flight {
    let mut flight = at_rest(ready);
    flight.symbols = OWN + 3;
    let gains = remembering.near().gains;
    let gains = [0, 1, 2].map(|gain: usize| inside(gains[gain], OWN + gain));
    flight.tuned = Some(Tuned { gains, model: [flight.setpoint.clone(), Affine::default()] });
    flight
}

/// All between two ends but for a hair.
fn inside([least, most]: [f64; 2], symbol: usize) -> Affine {
    let hair = HAIR * (most - least);
    Affine::unknown([least + hair, most - hair], symbol)
}

fn tuned(flight: &mut Flight) -> &mut Tuned {
    flight.tuned.as_mut().expect("remembers")
}

#[test]
fn a_rest_has_to_last_as_long_as_the_gains_of_a_loop_take() {
    let remembering = SelfTuned::remembering();
    let ready = remembering.ready();
    let share = LEAKAGE_PER_S * 0.02;
    let samples = libm::log(1.0 / 1024.0) / libm::log(1.0 - share);
    let rests_s = ready.rests_s().expect("it remembers");
    assert!((rests_s / 0.02 - samples) >= 0.0 && rests_s / 0.02 - samples < 2.001, "{rests_s}");
}

#[test]
fn flights_are_near_rest_while_each_of_their_gains_is() {
    let remembering = SelfTuned::remembering();
    let ready = remembering.ready();
    let rest = near_rest(&remembering, &ready);
    assert!(ready.is_near(&rest) && ready.is_near_in_gains(&rest));
    for gain in 0..3 {
        let [least, most] = remembering.near().gains[gain];
        let hair = 3.0 * HAIR * (most - least);
        for beyond in [[least - hair, most], [least, most + hair]] {
            let mut flight = rest.clone();
            tuned(&mut flight).gains[gain] = Affine::unknown(beyond, OWN + gain);
            assert!(!ready.is_near_in_gains(&flight), "{gain}: {beyond:?}");
            assert!(!ready.is_near(&flight), "{gain}: {beyond:?}");
        }
    }
}

/// Bounds of a set may be wider than all that its law can reach.
#[test]
fn gains_are_near_where_all_that_their_law_reaches_is() {
    let mut remembering = SelfTuned::remembering();
    let reach = around(&remembering.set, 1.0);
    let ends = reach.map(|reach| [reach.lower(), reach.upper()]);
    remembering.terminal.gains = Some(NearGains { gains: ends, model_rad: 0.01 });
    let ready = remembering.ready();
    let mut flight = near_rest(&remembering, &ready);
    for (gain, [least, most]) in ends.into_iter().enumerate() {
        let wide = [least - 0.1, most + 0.1];
        tuned(&mut flight).gains[gain] = Affine::unknown(wide, OWN + gain);
    }
    assert!(ready.is_near_in_gains(&flight));
}

#[test]
fn flights_are_near_rest_while_their_reference_model_is() {
    let remembering = SelfTuned::remembering();
    let ready = remembering.ready();
    let rest = near_rest(&remembering, &ready);
    let tuner = ready.flown.tuner.as_ref().expect("remembers");
    let later = |off_rad: f64| {
        let mut flight = rest.clone();
        tuned(&mut flight).model[0].centre += off_rad;
        (tuner.model_later(flight.tuned.as_ref().expect("remembers"), &flight.setpoint), flight)
    };
    let unit = later(0.001).0 / 0.001;
    assert!(unit >= 1.0, "it is off at least by what it is off now: {unit}");
    for (share, is_near) in [(1.0 - HAIR, true), (1.0 + HAIR, false)] {
        let (_, flight) = later(share * remembering.near().model_rad / unit);
        assert_eq!(ready.is_near_in_gains(&flight), is_near, "{share}");
        assert_eq!(ready.is_near(&flight), is_near, "{share}");
    }
}

#[test]
fn without_a_place_for_gains_that_remember_or_without_such_gains_nothing_is_near() {
    let remembering = SelfTuned::remembering();
    let ready = remembering.ready();
    let rest = near_rest(&remembering, &ready);
    let without_place = Ready { near_gains: None, ..ready.clone() };
    assert!(!without_place.is_near_in_gains(&rest));
    assert!(!ready.is_near_in_gains(&Flight { tuned: None, ..rest.clone() }));
    let loop_ = Loop::new();
    let fixed = loop_.ready();
    let fixed_rest = at_rest(&fixed);
    assert!(fixed.is_near_in_gains(&fixed_rest));
    let with_place = Ready { near_gains: ready.near_gains, ..fixed.clone() };
    assert!(!with_place.is_near_in_gains(&fixed_rest));
    assert!(!fixed.is_near_in_gains(&Flight { tuned: rest.tuned, ..fixed_rest }));
}

#[test]
fn gains_of_a_set_are_told_as_shares_of_what_their_law_reaches() {
    let remembering = SelfTuned::remembering();
    let mut ready = remembering.ready();
    let mut flight = near_rest(&remembering, &ready);
    for share in ready.gains_of_reach(&flight) {
        let share = share.width();
        assert!((share - 0.25).abs() < 1e-5, "{share}");
    }
    // A gain that its law cannot move has no share, wherever it is.
    let rest = remembering.set.rest[1].midpoint();
    ready.around.last_mut().expect("some")[1] = Interval::point(rest);
    let [kp, ki, _] = ready.gains_of_reach(&flight);
    assert!(kp.width() > 0.2 && ki == Interval::ZERO);
    flight.tuned = None;
    assert_eq!(ready.gains_of_reach(&flight), [Interval::ZERO; 3]);
}

/// Of a law with memory a norm has to fall for all gains: those of the widest box.
#[test]
fn the_ball_grows_by_all_gains_that_a_law_with_memory_reaches() {
    let remembering = SelfTuned::remembering();
    let mut ready = remembering.ready();
    ready.growth = vec![Growth::default(); SHARES.len()];
    let at_rest = ready.flown.gains.at_rest();
    let by = |place: usize, shares: [f64; PLACES]| {
        let mut other = ready.clone();
        let kept = other.around[place];
        other.around.fill(kept);
        other.grown(shares, at_rest)
    };
    let [all, fewest] = [SHARES.len() - 1, 0].map(|place| by(place, FREE));
    assert!(all > fewest, "{all} {fewest}");
    assert_eq!(ready.grown(FREE, at_rest).to_bits(), all.to_bits());
}

/// A sample adds as many unknowns whatever there are, so that the most that is followed can be met.
#[test]
fn unknowns_of_gains_that_remember_are_gathered_when_there_are_too_many() {
    let remembering = SelfTuned::remembering();
    let mut ready = remembering.ready();
    let mut after = |symbols: usize| {
        let mut flight = with_unknowns(&ready, &mut Dice::new(5), symbols, 1e-6);
        flight.ball = 1e-6;
        flight.tuned = near_rest(&remembering, &ready).tuned;
        ready.after(&flight, Moment::Later).expect("known")
    };
    let added = after(OWN + 400).symbols - OWN - 400;
    for (symbols, is_gathered) in
        [(OWN + 400, false), (MOST_FOLLOWED - added, false), (MOST_FOLLOWED - added + 1, true)]
    {
        let next = after(symbols);
        assert_eq!(next.symbols < symbols, is_gathered, "{symbols}: {}", next.symbols);
        assert_eq!(next.ball.to_bits() == 0, is_gathered);
    }
}

#[test]
fn flights_begin_with_the_nominal_gains_or_with_those_after_a_rest() {
    let remembering = SelfTuned::remembering();
    let mut ready = remembering.ready();
    let nominal = [GAINS.kp, GAINS.ki, GAINS.kd];
    let rested = ready.flown.rested;
    let first = ready.begun(Beginning::Controller).tuned.expect("remembers").gains;
    let later = ready.begun(Beginning::Rest).tuned.expect("remembers").gains;
    for gain in 0..3 {
        assert!((first[gain].centre - nominal[gain]).abs() < 1e-12 && first[gain].spread() < 1e-12);
        let range = later[gain].range();
        assert!(range.encloses(rested[gain]) && rested[gain].width() > 1e-9, "{gain}");
        assert!(range.width() < rested[gain].width() * (1.0 + 1e-9));
    }
}

#[test]
fn what_is_gathered_of_gains_that_remember_counts_them_and_is_held_in_them() {
    let remembering = SelfTuned::remembering();
    let ready = remembering.ready();
    let dice = &mut Dice::new(6);
    let symbols = OWN + KEPT_FOLLOWED + 30;
    let mut flight = with_unknowns(&ready, dice, symbols, 1e-3);
    flight.tuned = near_rest(&remembering, &ready).tuned;
    // The last is the smallest of the loop, and the largest of a gain: it is kept.
    let last = symbols - 1;
    for value in tuned(&mut flight).each_mut() {
        let parts = (0..symbols).map(|symbol| match symbol {
            _ if symbol == last => 1.0,
            _ if symbol < OWN => value.parts.of(symbol),
            _ => dice.between(-1e-4, 1e-4),
        });
        value.parts = parts.collect();
        value.off = 1e-7;
    }
    let before = flight.clone();
    ready.gather(&mut flight);
    assert_eq!(flight.symbols, OWN + KEPT_FOLLOWED + flight.values.len() + 1 + 5);
    let each = |flight: &Flight| -> Vec<Affine> {
        flight.tuned.iter().flat_map(Tuned::each).cloned().collect()
    };
    let first = OWN + KEPT_FOLLOWED + flight.values.len() + 1;
    for ((now, then), own) in each(&flight).iter().zip(each(&before)).zip(first..) {
        same(now.spread(), then.spread() + then.off);
        assert!(now.parts.of(own) > 0.0 && now.off <= 1e-12);
        assert!(now.parts.each().contains(&1.0), "the largest is kept");
        let others = (first..flight.symbols).filter(|symbol| *symbol != own);
        assert!(others.map(|symbol| now.parts.of(symbol)).all(|part| part == 0.0));
    }
}
