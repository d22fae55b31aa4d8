//! Where modes lead whose throttle or pitch stands at a limit, turns, and where ways begin.

use super::*;
use crate::leads_to::walk::Stretch;

/// What a mode of these loops leads to from the start, each part of it.
fn stretches(loops: Vec<OuterLoop>, mode: Mode) -> Vec<Stretch> {
    let scenario = scenario(navion(), Some(with_loops(loops, vec![mode])));
    walk(&scenario).leads_to(&standing(navion()), 0, None)
}

/// The loops, with limits of one of them.
fn with_limits(number: usize, limits: [f64; 2]) -> Vec<OuterLoop> {
    let mut loops = loops();
    let mut config = PidConfig::sampled_every(DT_S);
    limited(&mut config, limits);
    loops[number].controller = pid([0.01, 0.001, 0.0], config);
    loops
}

/// It was asked as if it still held the airspeed, which nobody does there.
#[test]
fn a_throttle_at_its_end_is_told_with_the_flight_that_it_leaves() {
    let hold = |airspeed_m_s: f64| {
        let engaged = [ALTITUDE, VERTICAL_SPEED, THROTTLE];
        to_hold(mode("level", &engaged), &[(Quantity::Airspeed, airspeed_m_s)])
    };
    let trim = navion().trim().point.throttle;
    for (ends, airspeed_m_s, expected) in [
        ([-0.5, 0.5], SPEED_M_S + 5.0, None),
        ([-0.5, 0.004], SPEED_M_S + 5.0, Some(0.004)),
        ([-0.004, 0.5], SPEED_M_S - 5.0, Some(-0.004)),
    ] {
        let found = stretches(with_limits(THROTTLE, ends), hold(airspeed_m_s));
        let [Stretch { there: Ok(there), leg: Leg::End, plant: None }] = found.as_slice() else {
            panic!("{found:?}")
        };
        let throttle = expected.is_some();
        assert_eq!(there.at_limits, AtLimits { throttle, pitch: false }, "{ends:?}");
        let away_m_s = there.trim.target.airspeed_m_s - SPEED_M_S;
        let asked_m_s = airspeed_m_s - SPEED_M_S;
        match expected {
            Some(end) => {
                assert!((there.trim.point.throttle - trim - end).abs() < 1e-9);
                assert!(away_m_s / asked_m_s > 0.0 && away_m_s / asked_m_s < 0.9, "{away_m_s}");
            }
            None => assert!((away_m_s - asked_m_s).abs() < 1e-9),
        }
    }
}

/// A vertical speed that falls short is another flight; an altitude that it leaves is none that is held.
#[test]
fn an_altitude_that_the_limits_of_pitch_do_not_hold_is_no_flight() {
    let half_deg = core::f64::consts::PI / 360.0;
    let loops = || with_limits(VERTICAL_SPEED, [-0.2, half_deg]);
    let slower = [(Quantity::Airspeed, SPEED_M_S - 8.0)];
    let level = to_hold(mode("level", &[ALTITUDE, VERTICAL_SPEED, THROTTLE]), &slower);
    let found = stretches(loops(), level);
    assert_eq!(found[0].there, Err(Nowhere::NoFlight));
    let vertical = to_hold(mode("vertical", &[VERTICAL_SPEED, THROTTLE]), &slower);
    let found = stretches(loops(), vertical);
    let there = found[0].there.as_ref().expect("it sinks");
    assert_eq!(there.at_limits, AtLimits { throttle: false, pitch: true });
    assert!(there.trim.target.flight_path_rad < -half_deg, "{:?}", there.trim.target);
    // On the way to an altitude the limit is what makes the climb.
    let higher = to_hold(
        mode("higher", &[ALTITUDE, VERTICAL_SPEED, THROTTLE]),
        &[(Quantity::Altitude, ALTITUDE_M + 400.0)],
    );
    let found = stretches(loops(), higher);
    let [end, climb] = found.as_slice() else { panic!("{found:?}") };
    assert_eq!(end.there.as_ref().map(|it| it.at_limits), Ok(AtLimits::default()));
    let climbing = climb.there.as_ref().expect("it climbs");
    assert_eq!((climb.leg, climbing.at_limits.pitch), (Leg::OnTheWay, true));
    assert!(climbing.trim.target.flight_path_rad > 0.0);
}

/// The drag of a turn was not held against the throttle.
#[test]
fn a_turn_takes_the_throttle_that_its_load_takes() {
    let turn = |bank_deg: f64| Mode {
        bank_rad: bank_deg.to_radians(),
        ..mode("turn", &[ALTITUDE, VERTICAL_SPEED, THROTTLE])
    };
    let start = navion().trim().point.throttle;
    let takes = |bank_deg: f64| {
        let heavy = navion().under_load(1.0 / libm::cos(bank_deg.to_radians())).expect("it flies");
        heavy.trim().point.throttle - start
    };
    assert!(takes(30.0) > 0.002 && takes(45.0) > 2.0 * takes(30.0), "{}", takes(45.0));
    for (bank_deg, most, is_told) in [
        (30.0, 1.01 * takes(30.0), false),
        (30.0, 0.99 * takes(30.0), true),
        (45.0, 1.01 * takes(30.0), true),
        (10.0, 0.001 * takes(30.0), false),
    ] {
        let found = stretches(with_limits(THROTTLE, [-0.5, most]), turn(bank_deg));
        let turns = found.iter().find(|it| it.leg == Leg::InTurn);
        assert_eq!(turns.is_some(), is_told, "{bank_deg} {most}");
        let Some(Stretch { there: Ok(there), plant: Some(plant), .. }) = turns else { continue };
        assert!(there.at_limits.throttle && there.trim.target.airspeed_m_s < SPEED_M_S);
        assert!(plant.aircraft().environment().gravity_m_s2 > 11.0);
    }
}

#[test]
fn what_stands_at_a_limit_is_moved_by_nobody() {
    let engaged = [HEADING, ALTITUDE, THROTTLE, VERTICAL_SPEED];
    let all = with_loops(loops(), vec![mode("both", &engaged), total("energy", &[HEADING])]);
    let [throttle, pitch, both] = [[true, false], [false, true], [true, true]]
        .map(|[throttle, pitch]| AtLimits { throttle, pitch });
    for (at_limits, kept) in [
        (AtLimits::default(), &engaged[..]),
        (throttle, &[HEADING, ALTITUDE, VERTICAL_SPEED]),
        (pitch, &[HEADING, THROTTLE]),
        (both, &[HEADING]),
    ] {
        let found = all.released(0, at_limits);
        assert_eq!(found.modes()[0].engaged, kept, "{at_limits:?}");
        let mut order = found.outermost_first(0).to_vec();
        order.sort_unstable();
        let mut kept = kept.to_vec();
        kept.sort_unstable();
        assert_eq!(order, kept, "{at_limits:?}");
        assert_eq!(found.modes()[1], all.modes()[1]);
    }
    // Of total energy one of two goes on alone.
    let gains = |autopilot: &Autopilot| {
        let total = autopilot.total_energy().expect("one");
        [total.energy, total.distribution].map(|it| it.nominal().ki)
    };
    let [energy, distribution] = gains(&all);
    assert!(energy > 0.0 && distribution > 0.0);
    for (at_limits, expected, is_engaged) in [
        (throttle, [0.0, distribution], true),
        (pitch, [energy, 0.0], true),
        (both, [0.0, 0.0], false),
    ] {
        let found = all.released(1, at_limits);
        assert_eq!((gains(&found), found.modes()[1].total_energy), (expected, is_engaged));
    }
}

/// The way to an altitude was counted from the start, where a mode begins at another one.
#[test]
fn a_way_begins_where_what_lets_the_mode_begin_is_met() {
    let target_m = ALTITUDE_M + 500.0;
    let level = [(Quantity::Altitude, target_m)];
    let climb = to_hold(mode("climb", &[VERTICAL_SPEED]), &[(Quantity::VerticalSpeed, 1.0)]);
    let capture = |above_m: f64| {
        let level = to_hold(mode("capture", &[ALTITUDE, VERTICAL_SPEED]), &level);
        from(level, 5.0, &[(Quantity::Altitude, above_m)])
    };
    for (above_m, lasts) in [(target_m - 1.0, false), (ALTITUDE_M - 50.0, true)] {
        let modes = vec![climb.clone(), capture(above_m)];
        let loops = with_limits(ALTITUDE, [-2.0, 2.0]);
        let scenario = scenario(navion(), Some(with_loops(loops, modes)));
        let found = walk(&scenario).leads_to(&standing(navion()), 1, None);
        let on_the_way = found.iter().any(|it| it.leg == Leg::OnTheWay);
        assert_eq!(on_the_way, lasts, "{above_m}");
    }
}

/// "holds vertical speed at 1 m/s", of a mode whose altitude hold moves that.
#[test]
fn what_another_loop_moves_is_not_told_as_what_a_mode_holds() {
    let climb = to_hold(mode("climb", &[VERTICAL_SPEED]), &[(Quantity::VerticalSpeed, 1.0)]);
    let higher = [(Quantity::Altitude, ALTITUDE_M + 500.0)];
    let capture = to_hold(mode("capture", &[ALTITUDE, VERTICAL_SPEED]), &higher);
    let loops = with_limits(ALTITUDE, [-2.0, 2.0]);
    let scenario = scenario(navion(), Some(with_loops(loops, vec![climb, capture])));
    let held = (&pitch(), pitch().nominal());
    let found = places(&scenario, &navion(), &[standing(navion())], held);
    let led = found.iter().find_map(|it| it.led.filter(|led| led.mode == 1)).expect("it leads");
    assert_eq!(led.target, Some((Quantity::Altitude, ALTITUDE_M + 500.0)));
}

/// The level flight at an airspeed.
fn at_airspeed(airspeed_m_s: f64) -> Trim {
    let plant = navion();
    let held = Held {
        power: Power::Airspeed(airspeed_m_s),
        path: Path::FlightPath(0.0),
        altitude_m: ALTITUDE_M,
    };
    plant.aircraft().at_held(plant.trim(), &held).expect("it flies")
}

/// The end of a mode that holds altitude and airspeed, from another airspeed, with a throttle within these ends.
fn level_at(airspeed_m_s: f64, from_m_s: f64, ends: [f64; 2]) -> Result<AtLimits, Nowhere> {
    let start = navion().trim().point.throttle;
    let level = to_hold(
        mode("level", &[ALTITUDE, VERTICAL_SPEED, THROTTLE]),
        &[(Quantity::Airspeed, airspeed_m_s), (Quantity::Altitude, ALTITUDE_M)],
    );
    let loops = with_limits(THROTTLE, ends.map(|end| end - start));
    let scenario = scenario(navion(), Some(with_loops(loops, vec![level])));
    let from = at_airspeed(from_m_s);
    let found = walk(&scenario).leads_to(&standing(navion()), 0, Some(&from));
    found[0].there.as_ref().map(|it| it.at_limits).map_err(|it| *it)
}

/// Below the airspeed of least drag a slower flight takes more throttle: what suffices for the end may not for the way there.
#[test]
fn an_airspeed_is_come_to_with_a_throttle_that_suffices_on_the_way() {
    let takes = |airspeed_m_s: f64| at_airspeed(airspeed_m_s).point.throttle;
    let [slow, held] = [takes(34.0), takes(50.0)];
    assert!(slow > held + 0.1, "{slow} {held}");
    let free = Ok(AtLimits::default());
    assert_eq!(level_at(50.0, 34.0, [0.5, slow + 0.01]), free);
    assert_eq!(level_at(50.0, 34.0, [0.5, slow - 0.01]), Err(Nowhere::NoFlight));
    // Nobody comes from there.
    assert_eq!(level_at(50.0, SPEED_M_S, [0.5, slow - 0.01]), free);
    // And back: to slow down it has to be less than that of least drag.
    let least = takes(45.0);
    assert_eq!(level_at(42.0, 50.0, [least - 0.01, 1.5]), free);
    assert_eq!(level_at(42.0, 50.0, [least + 0.002, 1.5]), Err(Nowhere::NoFlight));
}

/// "stable", of a throttle that suffices for the airspeed that is held, and not for a little less: it is lost by the overshoot.
#[test]
fn a_throttle_that_does_not_bring_back_an_overshoot_is_at_its_end() {
    let takes = |airspeed_m_s: f64| at_airspeed(airspeed_m_s).point.throttle;
    let (to_m_s, from_m_s) = (42.0, SPEED_M_S);
    let overshot = takes(to_m_s - 0.5 * (from_m_s - to_m_s));
    assert!(overshot > takes(to_m_s) + 0.05, "{overshot}");
    let at_its_end = Ok(AtLimits { throttle: true, pitch: false });
    assert_eq!(level_at(to_m_s, from_m_s, [0.5, overshot - 0.01]), at_its_end);
    assert_eq!(level_at(to_m_s, from_m_s, [0.5, overshot + 0.01]), Ok(AtLimits::default()));
    // Who speeds up on the back side overshoots to where less throttle would do.
    let fastest = takes(42.0 + 0.5 * (42.0 - 34.0));
    assert!(fastest < takes(42.0) - 0.002, "{fastest}");
    assert_eq!(level_at(42.0, 34.0, [fastest + 0.001, 1.5]), at_its_end);
    assert_eq!(level_at(42.0, 34.0, [fastest - 0.001, 1.5]), Ok(AtLimits::default()));
    // Who is there already overshoots nothing.
    assert_eq!(level_at(to_m_s, to_m_s, [0.5, overshot - 0.01]), Ok(AtLimits::default()));
}

/// "stable", of a climb in which pitch and throttle at their limits let it sink.
#[test]
fn who_sinks_on_the_way_up_never_comes_there() {
    let half_deg = core::f64::consts::PI / 360.0;
    let mut loops = with_limits(VERTICAL_SPEED, [-0.2, half_deg]);
    let mut config = PidConfig::sampled_every(DT_S);
    limited(&mut config, [-0.2, -0.1]);
    loops[THROTTLE].controller = pid([0.01, 0.001, 0.0], config);
    let higher = to_hold(
        mode("higher", &[ALTITUDE, VERTICAL_SPEED, THROTTLE]),
        &[(Quantity::Altitude, ALTITUDE_M + 400.0)],
    );
    let found = stretches(loops, higher);
    let climb = found.iter().find(|it| it.leg == Leg::OnTheWay).expect("a way");
    assert_eq!(climb.there, Err(Nowhere::NoFlight));
}
