//! What a sample refuses, and what it makes of a limit and of an integral at it.

use fspid_core::{ControllerSetting, Guard, Limits};

use super::*;
use crate::steps::flights::Ready;
use crate::steps::flights::tests::{Loop, at_rest};

const HAIR: f64 = 1e-9;

/// A number between two ends, by an unknown that is not any other's.
fn between(lower: f64, upper: f64) -> Affine {
    Affine::unknown([lower, upper], OWN)
}

#[test]
fn flights_that_may_meet_an_end_of_the_travel_are_refused() {
    let loop_ = Loop::new();
    let mut flown = loop_.ready().flown;
    let place = flown.layout.plant - 1;
    let mut flight = at_rest(&loop_.ready());
    flight.load = Affine::constant(point(0.01));
    flight.ball = 0.002;
    let of_ball = flown.reach[place] * flight.ball;
    // A deflection from -0.1 to 0.3, the load that enters behind it left out.
    flight.values[place] = between(-0.09, 0.31);
    let [least, most] = [-0.1 - of_ball, 0.3 + of_ball];
    for (travel, is_within) in [
        ((least - HAIR, most + HAIR), true),
        ((least + HAIR, most + HAIR), false),
        ((least - HAIR, most - HAIR), false),
        ((least + HAIR, most - HAIR), false),
    ] {
        flown.travel = Some(travel);
        assert_eq!(flown.within_travel(&flight).is_ok(), is_within, "{travel:?}");
    }
    // Where the deflection is no state, or goes beyond where it is at samples, something else is asked.
    for lag_order in [0, 2] {
        flown.lag_order = lag_order;
        assert!(flown.within_travel(&flight).is_ok());
    }
    (flown.lag_order, flown.travel) = (1, None);
    assert!(flown.within_travel(&flight).is_ok());
}

#[test]
fn a_sample_ends_where_a_deflection_would_meet_the_end_of_its_travel() {
    let loop_ = Loop::new();
    let ready = loop_.ready();
    let mut flown = ready.flown.clone();
    let flight = at_rest(&ready);
    flown.travel = Some((-1.0, 1.0));
    assert!(flown.pass(&flight, Moment::Later, Judge::Measured).is_ok());
    flown.travel = Some((0.5, 1.0));
    let stop = flown.pass(&flight, Moment::Later, Judge::Measured).err();
    assert_eq!(stop, Some(Stop::Travel));
}

#[test]
fn what_the_sample_guard_may_not_believe_is_refused() {
    let loop_ = Loop::new();
    let ready = loop_.ready();
    let mut flown = ready.flown.clone();
    let mut flight = at_rest(&ready);
    flight.ball = 0.0;
    let size = flight.setpoint.magnitude();
    for (factor, is_believed) in [(1.0 + 1e-6, true), (1.0 - 1e-6, false)] {
        flown.config.guard = Guard::new(factor * size).expect("allowed");
        let stop = flown.pass(&flight, Moment::Later, Judge::Measured).err();
        assert_eq!(stop, (!is_believed).then_some(Stop::Guard));
    }
    // The pitch angle, and what the ball adds to it.
    flown.config.guard = Guard::new(2.0 * size).expect("allowed");
    flight.ball = 1.5 * size / flown.reach[0];
    let stop = flown.pass(&flight, Moment::Later, Judge::Measured).err();
    assert_eq!(stop, Some(Stop::Guard));
}

/// What conditional integration makes of 1 with so much added, beyond so much of a limit: the range, and its share.
fn conditional(ready: &Ready<'_>, added: [f64; 2], excess: Option<[f64; 2]>) -> (Interval, f64) {
    let now = at_rest(ready);
    let flown = &ready.flown;
    let mut pass = Pass { flown, now: &now, judge: Judge::Measured, shares: FREE, symbols: 10 };
    let [lower, upper] = added;
    let added = Affine::unknown([lower, upper], 2);
    let excess = excess.map(|[lower, upper]| Affine::unknown([lower, upper], 3));
    let before = Affine::constant(Interval::ONE);
    let kept = pass.conditional(&before, &added, excess.as_ref());
    (kept.range(), pass.shares[INTEGRAL])
}

#[test]
fn the_integral_stands_still_where_it_would_drive_a_cut_command_further_out_and_may_do_either_between()
 {
    let is_about = |found: (Interval, f64), [lower, upper]: [f64; 2], share: f64| {
        let (range, of) = found;
        let off = (range.lower() - lower).abs().max((range.upper() - upper).abs());
        assert!(off < HAIR && (of - share).abs() < HAIR, "{range:?} {of}");
    };
    let loop_ = Loop::new();
    let ready = loop_.ready();
    let of = |added: [f64; 2], excess: Option<[f64; 2]>| conditional(&ready, added, excess);
    let (up, down) = ([0.1, 0.2], [-0.2, -0.1]);
    // Beyond the upper limit, and the lower one.
    is_about(of(up, Some([0.3, 0.4])), [1.0, 1.0], 0.0);
    is_about(of(down, Some([-0.4, -0.3])), [1.0, 1.0], 0.0);
    // Back into the limits, and where nothing is cut.
    is_about(of(down, Some([0.3, 0.4])), [0.8, 0.9], 1.0);
    is_about(of(up, Some([-0.4, -0.3])), [1.1, 1.2], 1.0);
    is_about(of(up, None), [1.1, 1.2], 1.0);
    // Just at a limit nothing is beyond it, on the way back.
    is_about(of(down, Some([1e-3, 0.4])), [0.8, 0.9], 1.0);
    // Either: half of what is added, and half of its largest magnitude to both sides.
    is_about(of(up, Some([-0.1, 0.4])), [0.95, 1.2], 0.5);
    is_about(of(down, Some([-0.1, 0.4])), [0.8, 1.05], 0.5);
    is_about(of([-0.1, 0.2], Some([0.3, 0.4])), [0.85, 1.2], 0.5);
}

/// A slew limit holds on to the command before, whose ball is not that of now.
#[test]
fn what_a_slew_limit_keeps_of_the_ball_of_the_command_before_belongs_to_the_command_alone() {
    let loop_ = Loop::new();
    let ready = loop_.ready();
    let mut flown = ready.flown.clone();
    let most = flown.config.slew_rad_s.expect("limited") * flown.config.dt_s;
    flown.config.limits =
        Some(Limits::new(ControllerSetting::OutputLimits, -9.0, 9.0).expect("allowed"));
    let mut now = at_rest(&ready);
    now.last = Affine { of_ball: 0.01, ..Affine::constant(Interval::ONE) };
    let flown = &flown;
    let mut pass = Pass { flown, now: &now, judge: Judge::Measured, shares: FREE, symbols: 10 };
    let far = Affine::constant(point(1.0 + 3.0 * most));
    let command = pass.limited(&far);
    assert!((command.centre - 1.0 - most).abs() < 0.011 && pass.shares[COMMAND] < 1.0);
    let range = command.range();
    assert!(range.lower() <= 1.0 + most - 0.01 && range.upper() >= 1.0 + most + 0.01, "{range:?}");
    // Nothing is cut on the way: the ball before is not asked.
    let mut pass = Pass { flown, now: &now, judge: Judge::Measured, shares: FREE, symbols: 10 };
    let near = Affine::constant(point(1.0 + 0.1 * most));
    assert_eq!(pass.limited(&near), near);
    assert!(pass.shares[COMMAND] >= 1.0);
}

fn pass<'a, 's>(flown: &'a Flown<'s>, now: &'a Flight, judge: Judge) -> Pass<'a, 's> {
    Pass { flown, now, judge, shares: FREE, symbols: now.symbols }
}

#[test]
fn what_the_ball_adds_to_a_row_is_its_reach_along_each_state_times_the_factor() {
    let loop_ = Loop::new();
    let ready = loop_.ready();
    let mut now = at_rest(&ready);
    now.ball = 0.002;
    let row = vec![(0, point(0.5)), (2, point(-3.0))];
    let found = pass(&ready.flown, &now, Judge::Measured).row(&row);
    let reach = &ready.flown.reach;
    let expected = (0.5 * reach[0] + 3.0 * reach[2]) * now.ball;
    assert!(found.of_ball >= expected && found.of_ball < expected * (1.0 + HAIR));
    now.ball = 0.0;
    assert!(pass(&ready.flown, &now, Judge::Measured).row(&row).of_ball == 0.0);
}

/// What a controller sees, with kp 0.8, kd 0.2 and so much of ki.
fn seen(error: Affine, [ki, off_ki]: [f64; 2]) -> Seen {
    Seen {
        pitch: Affine::default(),
        rate: between(-0.02, 0.3),
        error,
        derivative: Some(Affine::default()),
        gains: Between { middle: [0.8, ki, 0.2], radius: [0.0, off_ki, 0.05] },
        tuned: None,
    }
}

#[test]
fn a_rate_gain_that_follows_kd_is_as_uncertain_as_its_share_of_it() {
    let loop_ = Loop::new();
    let ready = loop_.ready();
    let mut flown = ready.flown.clone();
    flown.config.rate_gain_s = 0.1;
    flown.followers.coupling.rate_gain = -0.7;
    flown.followers.nominal.kd = 0.15;
    let now = at_rest(&ready);
    let seen = seen(Affine::default(), [0.4, 0.0]);
    let (damping, off) = pass(&flown, &now, Judge::Measured).damped(&seen);
    let gain = 0.1 - 0.7 * (0.2 - 0.15);
    let [lower, upper] = [damping.range().lower(), damping.range().upper()];
    assert!((lower - -0.02 * gain).abs() < HAIR && (upper - 0.3 * gain).abs() < HAIR);
    assert!((off - 0.7 * 0.05 * 0.3).abs() < HAIR, "{off}");
}

/// The excess over the limits is pulled out of the integral; while the gain is zero nothing is.
#[test]
fn back_calculation_pulls_what_is_cut_where_it_is_known_that_there_is_a_gain() {
    let loop_ = Loop::new();
    let ready = loop_.ready();
    let mut flown = ready.flown.clone();
    flown.config.slew_rad_s = None;
    flown.config.anti_windup = AntiWindup::BackCalculation { tracking_s: 0.5 };
    flown.config.limits =
        Some(Limits::new(ControllerSetting::OutputLimits, -0.1, 0.1).expect("allowed"));
    let mut now = at_rest(&ready);
    now.values.iter_mut().for_each(|value| *value = Affine::default());
    let mut answered = |setpoint: f64, ki: [f64; 2]| {
        now.setpoint = Affine::constant(point(setpoint));
        let seen = seen(now.setpoint.clone(), ki);
        let answered = pass(&flown, &now, Judge::Measured).answered(&seen);
        answered.map(|answered| answered.integral.expect("there is one"))
    };
    let (known, perhaps_none) = ([0.4, 0.0], [0.4, 0.41]);
    // Nothing is cut: nothing is pulled.
    let added = 0.4 * 0.02 * 0.05;
    let free = answered(0.05, known).expect("known");
    assert!((free.centre - added).abs() < HAIR && answered(0.05, perhaps_none).is_ok());
    // A command of 0.8 times the set-point and what the integral has, of which 0.1 is left.
    let wound = 0.4 * 0.02 * 0.5;
    let excess = 0.8 * 0.5 + wound - 0.1;
    let cut = answered(0.5, known).expect("known").centre;
    assert!((cut - (wound - 0.02 / 0.5 * excess)).abs() < HAIR, "{cut}");
    assert_eq!(answered(0.5, perhaps_none).err(), Some(Stop::Lost));
}

#[test]
fn what_is_kept_of_the_ball_before_is_what_a_slew_limit_does_not_let_through() {
    let loop_ = Loop::new();
    let ready = loop_.ready();
    let mut flown = ready.flown.clone();
    let most = flown.config.slew_rad_s.expect("limited") * flown.config.dt_s;
    flown.config.limits = None;
    let mut now = at_rest(&ready);
    now.last = Affine { of_ball: 0.01 * most, ..Affine::constant(Interval::ONE) };
    let mut pass = pass(&flown, &now, Judge::Measured);
    let command = pass.limited(&between(1.0 + 0.2 * most, 1.0 + 1.5 * most));
    let share = pass.shares[COMMAND];
    assert!(share > 0.2 && share < 0.9, "{share}");
    let expected = (1.0 - share) * 0.01 * most;
    assert!((command.off - expected).abs() < HAIR * most, "{} {expected}", command.off);
}

/// Between all and nothing of what a rate limit lets through, a sample goes along a straight line.
#[test]
fn a_share_of_a_rate_limit_lets_through_that_share_of_what_moves_the_servo() {
    let loop_ = Loop::new();
    let ready = loop_.ready();
    let flown = &ready.flown;
    let gains = flown.gains.at_rest();
    let mut now = at_rest(&ready);
    now.ball = 0.01;
    now.load = Affine::constant(point(0.03));
    let with = |share: f64| {
        let shares = core::array::from_fn(|place| if place == RATE { share } else { 1.0 });
        flown.pass(&now, Moment::Later, Judge::Forced(shares, gains)).expect("known").flight
    };
    let [none, part, all] = [0.0, 0.4, 1.0].map(with);
    let mut moved = 0.0_f64;
    for ((none, part), all) in none.values.iter().zip(&part.values).zip(&all.values) {
        let between = 0.6 * none.centre + 0.4 * all.centre;
        assert!((part.centre - between).abs() < HAIR, "{} {between}", part.centre);
        // The share of the ball goes along with it.
        assert!(part.off < 1e-8, "{}", part.off);
        moved = moved.max((all.centre - none.centre).abs());
    }
    assert!(moved > 1e-3, "{moved}");
}
