//! What is held in each mode, written by hand, and the places of which the trims of the aircraft know by themselves.

mod air;
mod limits;

use fspid_aircraft::trim::{Held, Path, Power};
use fspid_aircraft::{Trim, TrimTarget};
use fspid_core::{ControllerSetting, Limits, PidConfig};

use super::targets::{Targets, true_ones};
use super::walk::{Engaged, Walk};
use super::wanted::{Air, Nowhere, Seeker, There, Wanted, Way};
use super::{Place, is_same, places};
use crate::aircraft::{AircraftPlant, Change, Standing, pitch_rad};
use crate::autopilot::{
    AtLimits, Autopilot, Condition, Engagement, Entry, GlideSlope, Mode, Moves, OuterLoop,
    Quantity, Side, TotalEnergy, Units,
};
use crate::in_tests::{
    ALTITUDE_M, DT_S, SPEED_M_S, braked, mode, navion, outer, pid, pitch, scenario,
};
use crate::led::Leg;
use crate::scenario::Scenario;
use crate::signal::{Profile, Shape};

/// Numbers of the loops of [`loops`].
const VERTICAL_SPEED: usize = 0;
const THROTTLE: usize = 1;
const ALTITUDE: usize = 2;
const SPEED_BY_PITCH: usize = 3;
const FLIGHT_PATH: usize = 4;
const BEAM: usize = 5;
const HEADING: usize = 6;

/// Angle of the beam, rad.
const BEAM_RAD: f64 = 0.05;

fn loops() -> Vec<OuterLoop> {
    use Quantity as Q;
    let gains = [0.01, 0.001, 0.0];
    vec![
        outer("vertical speed", Q::VerticalSpeed, Moves::Pitch, gains),
        outer("autothrottle", Q::Airspeed, Moves::Throttle, gains),
        outer("altitude", Q::Altitude, Moves::Loop(VERTICAL_SPEED), gains),
        outer("speed by pitch", Q::Airspeed, Moves::Pitch, gains),
        outer("flight path", Q::FlightPath, Moves::Pitch, gains),
        outer("beam", Q::GlideSlope, Moves::Loop(FLIGHT_PATH), gains),
        outer("heading", Q::Heading, Moves::Bank, gains),
    ]
}

/// Least and largest command of a loop, in the units of its controller.
fn limited(config: &mut PidConfig<f64>, [least, most]: [f64; 2]) {
    let limits = Limits::new(ControllerSetting::OutputLimits, least, most);
    config.limits = Some(limits.expect("a range"));
}

fn total_energy() -> TotalEnergy {
    let mut config = PidConfig::sampled_every(DT_S);
    limited(&mut config, [-0.04, 0.06]);
    TotalEnergy {
        altitude_gain_1_s: 0.12,
        airspeed_gain_1_s: 0.12,
        most_path_rad: 0.1,
        most_acceleration_g: 0.1,
        energy: pid([3.0, 2.5, 0.0], config),
        distribution: pid([0.3, 0.45, 0.0], config),
    }
}

fn with_loops(loops: Vec<OuterLoop>, modes: Vec<Mode>) -> Autopilot {
    let beam = GlideSlope {
        angle_rad: BEAM_RAD,
        antenna_m: [9000.0, 0.0],
        altitude_m: 0.0,
        course_rad: 0.0,
        angle_sensor: None,
        range_sensor: None,
    };
    Autopilot::new(loops, Some(total_energy()), Some(beam), modes).expect("makes sense")
}

fn autopilot(modes: Vec<Mode>) -> Autopilot {
    with_loops(loops(), modes)
}

fn total(name: &str, engaged: &[usize]) -> Mode {
    Mode { total_energy: true, ..mode(name, engaged) }
}

fn to_hold(mode: Mode, targets: &[(Quantity, f64)]) -> Mode {
    let targets = targets.iter().map(|&(quantity, target)| Engagement { quantity, target });
    Mode { targets: targets.collect(), ..mode }
}

/// The same from a time on, when these are at least so much.
fn from(mode: Mode, at_s: f64, above: &[(Quantity, f64)]) -> Mode {
    let conditions =
        above.iter().map(|&(quantity, value)| Condition { quantity, side: Side::Above, value });
    Mode { entry: Entry { at_s, conditions: conditions.collect() }, ..mode }
}

fn written(targets: &Targets) -> Vec<(Quantity, f64)> {
    let all = Quantity::ALL.into_iter();
    all.filter_map(|quantity| Some((quantity, targets[quantity.place()]?))).collect()
}

/// What a loop holds it holds on as long as it stays engaged; what begins to be held is as what lets the mode begin says.
#[test]
fn a_mode_holds_what_is_written_or_was_held_or_lets_it_begin() {
    use Quantity::{Airspeed, Altitude, VerticalSpeed};
    let (both, path) = ([VERTICAL_SPEED, THROTTLE], [VERTICAL_SPEED]);
    let rows: [(Mode, &[(Quantity, f64)]); 9] = [
        (
            to_hold(mode("climb", &both), &[(VerticalSpeed, 1.0), (Airspeed, 50.0)]),
            &[(VerticalSpeed, 1.0), (Airspeed, 50.0)],
        ),
        (mode("on", &both), &[(VerticalSpeed, 1.0), (Airspeed, 50.0)]),
        // The throttle lets go. What lets a mode begin is known of the other quantities.
        (
            from(mode("path", &path), 0.0, &[(Altitude, 310.0), (Airspeed, 45.0)]),
            &[(Altitude, 310.0), (VerticalSpeed, 1.0), (Airspeed, 45.0)],
        ),
        // It takes the airspeed that there is, whatever that is.
        (mode("again", &both), &[(VerticalSpeed, 1.0)]),
        (
            from(total("energy", &[]), 0.0, &[(Altitude, 400.0), (VerticalSpeed, 0.5)]),
            &[(Altitude, 400.0), (VerticalSpeed, 0.5)],
        ),
        // The loop of both quantities stays. Nobody holds a vertical speed.
        (total("energy on", &[]), &[(Altitude, 400.0)]),
        // Another loop takes the altitude, and gives it back.
        (mode("altitude", &[ALTITUDE, VERTICAL_SPEED]), &[]),
        (
            to_hold(mode("higher", &[ALTITUDE, VERTICAL_SPEED]), &[(Altitude, 500.0)]),
            &[(Altitude, 500.0)],
        ),
        (total("back", &[]), &[]),
    ];
    let (modes, expected): (Vec<Mode>, Vec<_>) = rows.into_iter().unzip();
    let names: Vec<String> = modes.iter().map(|mode| mode.name.clone()).collect();
    let found = super::targets::written(&autopilot(modes));
    assert_eq!(found.len(), expected.len());
    for ((name, found), expected) in names.iter().zip(&found).zip(expected) {
        assert_eq!(written(found), expected, "{name}");
    }
}

/// A walk from the trim of a scenario's aircraft.
fn walk(scenario: &Scenario) -> Walk<'_> {
    let plant = scenario.plant.aircraft().expect("an aircraft");
    Walk::new(scenario, plant, scenario.held_at_the_end_rad())
}

/// What a mode is to hold first of all.
fn held(walk: &Walk<'_>, number: usize, from: Option<&Trim>) -> Wanted {
    let plant = navion();
    let (autopilot, mode) = walk.mode(number).expect("a mode");
    let seeker = Seeker { plant: &plant, air: Air::default(), from_m_s: SPEED_M_S };
    let all = walk.held(&Engaged { autopilot, mode }, number, &walk.came(from), &seeker);
    assert_eq!(all.len(), 1, "every loop has an integral");
    all[0]
}

/// Where the Navion glides with the throttle of level flight less a tenth, a little higher.
fn glide(plant: &AircraftPlant) -> Trim {
    let held = Held {
        power: Power::Throttle(0.9 * plant.trim().point.throttle),
        path: Path::FlightPath(-0.03),
        altitude_m: ALTITUDE_M + 40.0,
    };
    plant.aircraft().at_held(plant.trim(), &held).expect("it glides")
}

#[test]
fn a_mode_holds_what_its_loops_hold_and_leaves_the_rest_as_it_came() {
    use Quantity::{Airspeed, Altitude, FlightPath, VerticalSpeed};
    let plant = navion();
    let came = glide(&plant);
    let TrimTarget { airspeed_m_s, altitude_m, flight_path_rad } = came.target;
    let (throttle, theta_rad) = (came.point.throttle, came.point.alpha_rad + flight_path_rad);
    let climb_m_s = airspeed_m_s * libm::sin(flight_path_rad);
    let (stays, kept) = (Power::Throttle(throttle), Power::Airspeed(airspeed_m_s));
    let path = Way::OverGround;
    let rows: [(Mode, Power, Way, f64); 12] = [
        (mode("free", &[]), stays, Way::Pitch(theta_rad), altitude_m),
        (mode("turn", &[HEADING]), stays, Way::Pitch(theta_rad), altitude_m),
        (mode("throttle", &[THROTTLE]), kept, Way::Pitch(theta_rad), altitude_m),
        (mode("altitude", &[VERTICAL_SPEED, ALTITUDE, THROTTLE]), kept, path(0.0), altitude_m),
        (
            to_hold(mode("vertical", &[VERTICAL_SPEED, HEADING]), &[(VerticalSpeed, 0.7)]),
            stays,
            Way::Climb(0.7),
            altitude_m,
        ),
        (mode("on", &[VERTICAL_SPEED]), stays, Way::Climb(0.7), altitude_m),
        (mode("path", &[FLIGHT_PATH]), stays, Way::Through(flight_path_rad), altitude_m),
        (
            to_hold(
                mode("climb", &[FLIGHT_PATH, THROTTLE]),
                &[(FlightPath, 0.02), (Airspeed, 50.0)],
            ),
            Power::Airspeed(50.0),
            path(0.02),
            altitude_m,
        ),
        (mode("vertical again", &[VERTICAL_SPEED]), stays, Way::Climb(climb_m_s), altitude_m),
        (mode("beam", &[BEAM, FLIGHT_PATH]), stays, path(-BEAM_RAD), altitude_m),
        (
            to_hold(mode("speed", &[SPEED_BY_PITCH]), &[(Airspeed, 48.0)]),
            stays,
            Way::Airspeed(48.0),
            altitude_m,
        ),
        (to_hold(total("energy", &[]), &[(Altitude, 500.0)]), kept, path(0.0), 500.0),
    ];
    let modes = rows.iter().map(|(mode, ..)| mode.clone()).collect();
    let scenario = scenario(plant, Some(autopilot(modes)));
    let walk = walk(&scenario);
    for (number, (mode, power, way, altitude_m)) in rows.into_iter().enumerate() {
        let found = held(&walk, number, Some(&came));
        assert_eq!(
            (found.power, found.way, found.altitude_m),
            (power, way, altitude_m),
            "{}",
            mode.name
        );
    }
    // Nobody came from anywhere: the start, and the pitch that the scenario holds.
    let start = walk.start;
    let found = held(&walk, 0, None);
    let untouched = (Power::Throttle(start.point.throttle), Way::Pitch(start.point.alpha_rad));
    assert_eq!((found.power, found.way, found.altitude_m), (untouched.0, untouched.1, ALTITUDE_M));
}

/// Counted from the trim of the start and what the scenario commands there, in whatever units the controller counts.
#[test]
fn a_mode_commands_pitch_within_the_limits_of_what_moves_it() {
    let mut loops = loops();
    let mut config = PidConfig::sampled_every(DT_S);
    // Of a controller that answers in degrees.
    limited(&mut config, [-8.0, 4.0]);
    let moved = 180.0 / core::f64::consts::PI;
    loops[VERTICAL_SPEED].controller = pid([0.5, 0.1, 0.0], config);
    loops[VERTICAL_SPEED].units = Units { held: 1.0, moved };
    let modes = vec![
        mode("vertical", &[VERTICAL_SPEED]),
        // The limits of the loop that moves pitch, whatever moves its target.
        mode("altitude", &[ALTITUDE, VERTICAL_SPEED]),
        total("energy", &[]),
        mode("path", &[FLIGHT_PATH]),
        mode("free", &[]),
    ];
    let autopilot = with_loops(loops, modes);
    let deg = core::f64::consts::PI / 180.0;
    let expected = [
        Some([-8.0 * deg, 4.0 * deg]),
        Some([-8.0 * deg, 4.0 * deg]),
        Some([-0.04, 0.06]),
        None,
        None,
    ];
    let command_rad = 0.01;
    let mut scenario = scenario(navion(), Some(autopilot));
    let step = Profile::new(command_rad, Shape::Step { at_s: 1.0 });
    scenario.setpoint = step.expect("allowed");
    let walk = walk(&scenario);
    let base_rad = walk.start.point.alpha_rad + command_rad;
    for (number, expected) in expected.into_iter().enumerate() {
        let (autopilot, mode) = walk.mode(number).expect("a mode");
        let limits = Engaged { autopilot, mode }.pitch().and_then(|it| it.ends());
        let range = held(&walk, number, None).pitch_rad;
        assert_eq!([limits.is_some(), range.is_some()], [expected.is_some(); 2], "{}", mode.name);
        let Some(expected) = expected else { continue };
        for end in 0..2 {
            let (limits, range) = (limits.expect("one"), range.expect("one"));
            assert!((limits[end] - expected[end]).abs() < 1e-12, "{}", mode.name);
            assert!((range[end] - base_rad - expected[end]).abs() < 1e-12, "{}", mode.name);
        }
    }
}

#[test]
fn the_outermost_loop_of_the_path_says_what_is_held() {
    use Quantity::{Airspeed, Altitude, FlightPath, GlideSlope, VerticalSpeed};
    let rows: [(&[usize], Option<Quantity>); 7] = [
        (&[THROTTLE, HEADING], None),
        (&[THROTTLE, VERTICAL_SPEED], Some(VerticalSpeed)),
        (&[VERTICAL_SPEED, ALTITUDE, THROTTLE], Some(Altitude)),
        (&[HEADING, ALTITUDE, VERTICAL_SPEED], Some(Altitude)),
        (&[FLIGHT_PATH, BEAM], Some(GlideSlope)),
        (&[THROTTLE, FLIGHT_PATH], Some(FlightPath)),
        (&[SPEED_BY_PITCH], Some(Airspeed)),
    ];
    for (engaged, expected) in rows {
        let mode = mode("one", engaged);
        let autopilot = autopilot(vec![mode.clone()]);
        let found = Engaged { autopilot: &autopilot, mode: &mode }.outermost().map(|it| it.holds);
        assert_eq!(found, expected, "{engaged:?}");
    }
}

#[test]
fn places_are_the_same_that_differ_by_next_to_nothing_alone() {
    let one = TrimTarget { airspeed_m_s: 50.0, altitude_m: 1000.0, flight_path_rad: 0.05 };
    assert!(is_same(&one, &one));
    for by in [1.0, -1.0] {
        let near = [
            TrimTarget { airspeed_m_s: 50.0 * (1.0 + 0.9e-4 * by), ..one },
            TrimTarget { flight_path_rad: 0.05 + 0.9e-4 * by, ..one },
            TrimTarget { altitude_m: 1000.0 + 0.9 * by, ..one },
        ];
        let far = [
            TrimTarget { airspeed_m_s: 50.0 * (1.0 + 1.1e-4 * by), ..one },
            TrimTarget { flight_path_rad: 0.05 + 1.1e-4 * by, ..one },
            TrimTarget { altitude_m: 1000.0 + 1.1 * by, ..one },
            TrimTarget { airspeed_m_s: 100.0, ..one },
            TrimTarget { flight_path_rad: -0.05, ..one },
            TrimTarget { altitude_m: 3000.0, ..one },
        ];
        for other in near {
            assert!(is_same(&one, &other) && is_same(&other, &one), "{other:?}");
        }
        for other in far {
            assert!(!is_same(&one, &other) && !is_same(&other, &one), "{other:?}");
        }
    }
}

fn standing(plant: AircraftPlant) -> Standing {
    let (by, plant) = (Change::Nothing, Some(plant));
    Standing { by, from_s: 0.0, until_s: f64::INFINITY, plant }
}

/// Where a mode that holds a vertical speed by pitch leads, with these limits of its pitch.
fn led(climb_m_s: f64, limits_rad: [f64; 2]) -> Result<There, Nowhere> {
    let mut loops = loops();
    let mut config = PidConfig::sampled_every(DT_S);
    limited(&mut config, limits_rad);
    loops[VERTICAL_SPEED].controller = pid([0.01, 0.001, 0.0], config);
    let to_climb =
        to_hold(mode("climb", &[VERTICAL_SPEED]), &[(Quantity::VerticalSpeed, climb_m_s)]);
    let scenario = scenario(navion(), Some(with_loops(loops, vec![to_climb])));
    let mut ends = walk(&scenario).leads_to(&standing(navion()), 0, None).into_iter();
    let end = ends.next().expect("an end");
    assert_eq!((end.leg, ends.count()), (Leg::End, 0));
    end.there
}

#[test]
fn a_path_is_held_as_far_as_its_pitch_may_be_commanded() {
    let plant = navion();
    let start = plant.trim();
    let deg = core::f64::consts::PI / 180.0;
    for climb_m_s in [-1.5, 0.3] {
        let held = Held {
            power: Power::Throttle(start.point.throttle),
            path: Path::VerticalSpeed(climb_m_s),
            altitude_m: ALTITUDE_M,
        };
        let path = plant.aircraft().at_held(start, &held).expect("it flies");
        let takes_rad = pitch_rad(&path) - pitch_rad(start);
        assert!(takes_rad * climb_m_s > 0.0 && takes_rad.abs() > 0.1 * deg, "{takes_rad}");
        // The same flight, to the bit: nothing else was looked for.
        let free = led(climb_m_s, [-0.2, 0.2]).expect("it flies");
        assert_eq!(free.at_limits, AtLimits::default());
        let free = free.trim;
        assert_eq!((free.target, free.point), (path.target, path.point));
        // Half of the pitch that it takes, from below and, of a climb, from above.
        let half_rad = 0.5 * takes_rad;
        let limits_rad = if climb_m_s < 0.0 { [half_rad, 0.2] } else { [-0.2, half_rad] };
        let cut = led(climb_m_s, limits_rad).expect("it flies");
        assert_eq!(cut.at_limits, AtLimits { pitch: true, throttle: false });
        let cut = cut.trim;
        assert!((pitch_rad(&cut) - pitch_rad(start) - half_rad).abs() < 1e-8);
        assert!((cut.point.throttle - start.point.throttle).abs() < 1e-9);
        let found_m_s = cut.target.airspeed_m_s * libm::sin(cut.target.flight_path_rad);
        let part = found_m_s / climb_m_s;
        assert!(part > 0.1 && part < 0.9, "{climb_m_s} {found_m_s}");
    }
    // No pitch makes this engine climb so.
    assert_eq!(led(40.0, [-1.5, 1.5]).err(), Some(Nowhere::NoFlight));
}

/// A mode in which the throttle holds 50 m/s and pitch stays, and another in which nobody moves anything, from a time on.
fn slower_then_free(free_at_s: f64) -> Scenario {
    let slower = to_hold(mode("slower", &[THROTTLE]), &[(Quantity::Airspeed, 50.0)]);
    let free = from(mode("free", &[]), free_at_s, &[]);
    scenario(navion(), Some(autopilot(vec![slower, free])))
}

/// The throttle of a place that a mode leads to with an aircraft.
fn throttle(places: &[Place], mode: usize, with: &AircraftPlant) -> Option<f64> {
    let mut found = places.iter().filter_map(|place| {
        let plant = place.plant.as_ref()?;
        let is_it = place.led?.mode == mode && plant.aircraft() == with.aircraft();
        is_it.then(|| plant.trim().point.throttle)
    });
    let one = found.next();
    assert_eq!(found.next(), None, "one place");
    one
}

/// A mode that had begun before the aircraft became another takes that to where it was; one that begins later takes what the mode
/// before it made of that aircraft.
#[test]
fn a_mode_leads_on_from_where_it_was_when_the_aircraft_became_another() {
    let (clean, brake) = (navion(), braked(0.01));
    let at_50 = |plant: &AircraftPlant| {
        let held = Held {
            power: Power::Airspeed(50.0),
            path: Path::Pitch(pitch_rad(clean.trim())),
            altitude_m: ALTITUDE_M,
        };
        let found = plant.aircraft().at_held(plant.trim(), &held).expect("it flies");
        found.point.throttle
    };
    let [without, with] = [&clean, &brake].map(at_50);
    assert!(with > without + 0.003, "{without} {with}");
    let near = |found: Option<f64>, expected: f64| {
        found.is_some_and(|found| (found - expected).abs() < 1e-9)
    };
    let from_s = 10.0;
    for (by, free_at_s, expected) in [
        (Change::Configuration, 5.0, without),
        (Change::Configuration, 10.0, with),
        (Change::Configuration, 15.0, with),
        // How much is burnt, and when, nobody knows.
        (Change::Fuel, 5.0, without),
        (Change::Fuel, 15.0, without),
    ] {
        let scenario = slower_then_free(free_at_s);
        let until_s = if by == Change::Fuel { f64::INFINITY } else { 9.0 };
        let standings = [
            Standing { until_s, ..standing(clean.clone()) },
            Standing { by, from_s, ..standing(brake.clone()) },
        ];
        let found = places(&scenario, &clean, &standings, (&pitch(), pitch().nominal()));
        assert!(near(throttle(&found, 0, &clean), without), "{by:?} {free_at_s}");
        assert!(near(throttle(&found, 0, &brake), with), "{by:?} {free_at_s}");
        let later = throttle(&found, 1, &brake);
        assert!(near(later, expected), "{by:?} {free_at_s} {later:?}");
        // A mode that begins when the aircraft is another is not flown with the one before.
        let is_flown = free_at_s < until_s;
        assert_eq!(throttle(&found, 1, &clean).is_some(), is_flown, "{by:?} {free_at_s}");
    }
}

#[test]
fn a_mode_that_leads_nowhere_else_than_the_trim_is_asked_there_alone() {
    let level = mode("level", &[VERTICAL_SPEED]);
    let slower = to_hold(mode("slower", &[THROTTLE]), &[(Quantity::Airspeed, 50.0)]);
    let steep = to_hold(mode("steep", &[VERTICAL_SPEED]), &[(Quantity::VerticalSpeed, 40.0)]);
    // As far as the throttle goes, with a pitch that nobody moves.
    let fast = to_hold(mode("fast", &[THROTTLE]), &[(Quantity::Airspeed, 150.0)]);
    let scenario = scenario(navion(), Some(autopilot(vec![level, slower, steep, fast])));
    let held = (&pitch(), pitch().nominal());
    let found = places(&scenario, &navion(), &[standing(navion())], held);
    let led: Vec<_> =
        found.iter().map(|it| (it.led.expect("a mode"), it.plant.is_some())).collect();
    let [(slower, is_flown), (steep, climbs), (fast, flies)] = led.as_slice() else {
        panic!("{led:?}")
    };
    let fastest_m_s = fast.airspeed_m_s.expect("it is flown");
    assert!(fast.mode == 3 && *flies && fastest_m_s > SPEED_M_S && fastest_m_s < 100.0);
    assert_eq!(
        (slower.mode, slower.target, *is_flown),
        (1, Some((Quantity::Airspeed, 50.0)), true)
    );
    assert!((slower.airspeed_m_s.expect("it is flown") - 50.0).abs() < 1e-9);
    assert!((SPEED_M_S - 50.0).abs() > 1.0);
    assert_eq!(
        (steep.mode, steep.target, steep.airspeed_m_s, *climbs),
        (2, Some((Quantity::VerticalSpeed, 40.0)), None, false)
    );
}

/// A loop sees its quantity through its sensor: what it holds in truth is what is written less the error.
#[test]
fn what_a_mode_holds_in_truth_is_what_its_sensor_shows_as_written() {
    use crate::sensor::{PITCH, Sensor, SensorModel};
    let mut loops = loops();
    let model = SensorModel { bias: 3.0, scale_error: 0.05, ..SensorModel::default() };
    let sensor = Sensor::new(model, 7, PITCH).expect("allowed");
    loops[THROTTLE].sensor = Some(sensor);
    let to_50 = [(Quantity::Airspeed, 50.0)];
    let modes = vec![
        to_hold(mode("throttle", &[THROTTLE]), &to_50),
        // Another loop, which sees it as it is.
        to_hold(mode("pitch", &[SPEED_BY_PITCH]), &to_50),
    ];
    let found = true_ones(&with_loops(loops, modes));
    let airspeed = |mode: usize| found[mode][Quantity::Airspeed.place()].expect("written");
    let shown_m_s = 1.05 * airspeed(0) + sensor.bias();
    assert!((shown_m_s - 50.0).abs() < 1e-12 && sensor.bias().abs() > 0.1, "{shown_m_s}");
    assert!((airspeed(1) - 50.0).abs() < 1e-12);
}
