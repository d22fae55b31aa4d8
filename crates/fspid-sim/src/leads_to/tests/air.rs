//! Paths over the ground, in air that moves along the heading and upwards, and how long a way and a mode last.

use super::*;
use crate::air::{Steady, Wind};
use crate::leads_to::walk::Stretch;
use crate::surroundings::{Course, Weather};

const AHEAD_M_S: f64 = 12.0;
const UP_M_S: f64 = 1.5;

/// A scenario at a heading in a steady wind.
fn in_wind(heading_rad: f64, earth_m_s: [f64; 3]) -> Scenario {
    let mut scenario = scenario(navion(), Some(autopilot(vec![mode("free", &[])])));
    let course = Course {
        airspeed_m_s: SPEED_M_S,
        height_m: ALTITUDE_M,
        climb_rad: 0.0,
        axes_rad: 0.0,
        heading_rad,
        start_m: [0.0, 0.0],
    };
    let winds = vec![Wind::Steady(Steady { earth_m_s })];
    scenario.surroundings.weather = Some(Weather { course, winds, turbulence: None });
    scenario
}

#[test]
fn air_is_counted_along_the_heading_and_upwards() {
    let (sine, cosine) = (0.6, 0.8);
    let along = [cosine * AHEAD_M_S - sine * 3.0, sine * AHEAD_M_S + cosine * 3.0, -UP_M_S];
    let found = Air::of(&in_wind(libm::atan2(sine, cosine), along));
    assert!((found.ahead_m_s - AHEAD_M_S).abs() < 1e-12, "{found:?}");
    assert!((found.up_m_s - UP_M_S).abs() < 1e-12, "{found:?}");
    let still = scenario(navion(), None);
    assert_eq!(Air::of(&still), Air::default());
}

/// An angle over the ground is the climb over the ground by the speed over it, and a climb over the ground is one through the air
/// that rises.
#[test]
fn paths_over_the_ground_are_those_of_air_that_moves() {
    let plant = navion();
    let air = Air { ahead_m_s: AHEAD_M_S, up_m_s: UP_M_S };
    let seeker = Seeker { plant: &plant, air, from_m_s: SPEED_M_S };
    let wanted = |way| Wanted {
        power: Power::Airspeed(SPEED_M_S),
        way,
        altitude_m: ALTITUDE_M,
        throttle: [0.0, 2.0],
        pitch_rad: None,
        is_gathered: false,
    };
    let [path_rad, climb_m_s] = [0.04, 2.0];
    let over_ground = seeker.end(&wanted(Way::OverGround(path_rad))).expect("it flies").trim;
    let TrimTarget { airspeed_m_s, flight_path_rad, .. } = over_ground.target;
    let ahead_m_s = airspeed_m_s * libm::cos(flight_path_rad) + AHEAD_M_S;
    let up_m_s = airspeed_m_s * libm::sin(flight_path_rad) + UP_M_S;
    assert!((up_m_s / ahead_m_s - libm::tan(path_rad)).abs() < 1e-5, "{flight_path_rad}");
    assert!((seeker.climb_m_s(&over_ground) - up_m_s).abs() < 1e-12);
    let climbing = seeker.end(&wanted(Way::Climb(climb_m_s))).expect("it flies").trim;
    assert!((seeker.climb_m_s(&climbing) - climb_m_s).abs() < 1e-9);
    // In still air the angle is that through the air, to the bit.
    let still = Seeker { air: Air::default(), ..seeker };
    let [over_ground, through] = [Way::OverGround(path_rad), Way::Through(path_rad)]
        .map(|way| still.end(&wanted(way)).expect("it flies").trim);
    assert_eq!((over_ground.target, over_ground.point), (through.target, through.point));
}

/// Where modes lead a Navion with loops of these limits.
fn led(loops: Vec<OuterLoop>, modes: Vec<Mode>, number: usize) -> Vec<Stretch> {
    let scenario = scenario(navion(), Some(with_loops(loops, modes)));
    walk(&scenario).leads_to(&standing(navion()), number, None)
}

/// 30 s are none: a mode of so long a turn is passed over, and the last mode has no end.
#[test]
fn a_turn_is_asked_where_nothing_ends_it_within_half_a_minute() {
    let turn = Mode { bank_rad: 0.8, ..mode("turn", &[VERTICAL_SPEED]) };
    let then = |at_s: f64, above: &[(Quantity, f64)]| from(mode("then", &[]), at_s, above);
    let condition = [(Quantity::Altitude, 500.0)];
    for (at_s, conditions, is_asked) in [
        (29.0, &[][..], false),
        (30.0, &[], false),
        (31.0, &[], true),
        // Whether it is ever met nobody knows.
        (5.0, &condition[..], true),
    ] {
        let modes = vec![turn.clone(), then(at_s, conditions)];
        let found = led(loops(), modes, 0);
        assert_eq!(found[0].leg == Leg::Turn, is_asked, "{at_s}");
    }
    let late = from(Mode { bank_rad: 0.8, ..mode("late", &[VERTICAL_SPEED]) }, 50.0, &[]);
    let found = led(loops(), vec![mode("free", &[]), late.clone()], 1);
    assert_eq!(found[0].leg, Leg::Turn);
    for (at_s, is_asked) in [(70.0, false), (90.0, true)] {
        let found = led(loops(), vec![mode("free", &[]), late.clone(), then(at_s, &[])], 1);
        assert_eq!(found[0].leg == Leg::Turn, is_asked, "{at_s}");
    }
    // Pitch that holds the airspeed holds it in a turn as well.
    let by_pitch = Mode { bank_rad: 0.8, ..mode("by pitch", &[SPEED_BY_PITCH]) };
    let found = led(loops(), vec![by_pitch], 0);
    assert!(found.iter().all(|it| it.leg != Leg::Turn), "{found:?}");
}

/// A way is as fast as the loop that holds the altitude commands, by its gain near the altitude and at its limits far from it.
#[test]
fn a_way_lasts_as_long_as_its_loop_lets_it() {
    let fixed = |gain: f64, ends: Option<[f64; 2]>| {
        let mut loops = loops();
        let mut config = PidConfig::sampled_every(DT_S);
        if let Some(ends) = ends {
            limited(&mut config, ends);
        }
        loops[ALTITUDE].controller = pid([gain, 0.0, 0.0], config);
        loops
    };
    let to = |left_m: f64| {
        let target = [(Quantity::Altitude, ALTITUDE_M + left_m)];
        to_hold(mode("to", &[ALTITUDE, VERTICAL_SPEED, THROTTLE]), &target)
    };
    for (gain, ends, left_m, lasts) in [
        // A plain gain comes nearer by the same part each second: whatever is left is too little for half a minute where a
        // thirtieth of it is flown each second.
        (0.04, None, 40.0, false),
        (0.03, None, 40.0, true),
        (0.04, Some([-1.0, 1.0]), 40.0, true),
        (0.04, Some([-1.0, 1.0]), 29.0, false),
        (0.04, Some([-1.0, 1.0]), -29.0, false),
        (0.04, Some([-1.0, 1.0]), -40.0, true),
        (0.04, Some([-1.0, 2.0]), 40.0, false),
    ] {
        let found = led(fixed(gain, ends), vec![to(left_m)], 0);
        let way = found.iter().find(|it| it.leg == Leg::OnTheWay);
        assert_eq!(way.is_some(), lasts, "{gain} {ends:?} {left_m}");
        let Some(way) = way else { continue };
        let target = way.there.as_ref().expect("it flies").trim.target;
        let climb_m_s = target.airspeed_m_s * libm::sin(target.flight_path_rad);
        let commanded_m_s = match ends {
            Some([least, most]) => (gain * left_m).clamp(least, most),
            None => gain * left_m,
        };
        assert!((climb_m_s - commanded_m_s).abs() < 1e-6, "{climb_m_s} {commanded_m_s}");
    }
}

/// By a path or by the pitch itself, and with an integral at the end of what is allowed.
#[test]
fn a_way_is_as_steep_as_the_loop_below_lets_it() {
    let start = navion();
    let base_rad = pitch_rad(start.trim());
    for (moves, below, end) in
        [(Moves::Loop(FLIGHT_PATH), Some(FLIGHT_PATH), 0.03), (Moves::Pitch, None, 0.02)]
    {
        for (left_m, gains) in [
            (600.0, [0.01, 0.0, 0.0]),
            (-600.0, [0.01, 0.0, 0.0]),
            (600.0, [1e-6, 1e-6, 0.0]),
            (-600.0, [1e-6, 1e-6, 0.0]),
        ] {
            let mut loops = loops();
            let mut config = PidConfig::sampled_every(DT_S);
            limited(&mut config, [-end, end]);
            loops[ALTITUDE].controller = pid(gains, config);
            loops[ALTITUDE].moves = moves;
            let engaged: Vec<usize> = [ALTITUDE, THROTTLE].into_iter().chain(below).collect();
            let target = [(Quantity::Altitude, ALTITUDE_M + left_m)];
            let found = led(loops, vec![to_hold(mode("to", &engaged), &target)], 0);
            let way = found.iter().find(|it| it.leg == Leg::OnTheWay).expect("it lasts");
            let trim = way.there.as_ref().expect("it flies").trim;
            let found = match below {
                Some(_) => trim.target.flight_path_rad,
                None => pitch_rad(&trim) - base_rad,
            };
            assert!((found - end * left_m.signum()).abs() < 1e-6, "{moves:?} {left_m} {found}");
        }
    }
}

#[test]
fn places_are_asked_once_that_are_the_same_aircraft_at_the_same_limits() {
    use crate::autopilot::AtLimits;
    use crate::leads_to::is_asked_by;
    let place = |plant: Option<AircraftPlant>, throttle: bool| {
        let at_limits = AtLimits { throttle, pitch: false };
        Place { standing: 0, led: None, plant, at_limits }
    };
    let [light, heavy] = [navion(), navion().under_load(1.2).expect("it flies")];
    let here = place(Some(light.clone()), false);
    assert!(is_asked_by(&here, &place(Some(light.clone()), false)));
    assert!(is_asked_by(&place(None, false), &place(None, false)));
    assert!(!is_asked_by(&here, &place(None, false)));
    assert!(!is_asked_by(&here, &place(Some(light), true)));
    assert!(!is_asked_by(&here, &place(Some(heavy), false)));
    assert!(!is_asked_by(&here, &Place { standing: 1, ..here.clone() }));
}
