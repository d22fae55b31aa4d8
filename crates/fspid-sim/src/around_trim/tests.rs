//! What is asked about a trim beside the trim of the start: the wind of the end, and sensors that show a motion otherwise.

use std::sync::Arc;

use super::blown::{SeenAs, blown};
use super::{GrowthAtRest, of_mode};
use crate::air::{Along, Steady, TableRow, Wind, WindTable};
use crate::autopilot::{Autopilot, Engagement, Mode, Moves, OuterLoop, Quantity};
use crate::controller::Controller;
use crate::in_tests::{ALTITUDE_M, DT_S, SPEED_M_S, mode, navion, outer, pitch, scenario};
use crate::rest::Doubt;
use crate::scenario::Scenario;
use crate::sensor::{PITCH, Sensor, SensorModel};
use crate::surroundings::{Course, Weather};

/// The Navion with one mode that engages these loops.
fn flight(loops: Vec<OuterLoop>) -> Scenario {
    let all: Vec<usize> = (0..loops.len()).collect();
    let autopilot = Autopilot::new(loops, None, None, vec![mode("hold", &all)]);
    scenario(navion(), Some(autopilot.expect("makes sense")))
}

fn steady(earth_m_s: [f64; 3]) -> Wind {
    Wind::Steady(Steady { earth_m_s })
}

/// A wind that goes along straight lines over time from one of these to the next, every 20 s.
fn table(winds: [[f64; 3]; 4]) -> Wind {
    let rows = (0..4_u8).zip(winds).map(|(row, earth_m_s)| TableRow {
        at: 20.0 * f64::from(row),
        earth_m_s,
        ..TableRow::default()
    });
    Wind::Table(Arc::new(WindTable::new(Along::Time, rows.collect()).expect("allowed")))
}

fn in_winds(scenario: Scenario, winds: Vec<Wind>) -> Scenario {
    let course = Course {
        airspeed_m_s: SPEED_M_S,
        height_m: ALTITUDE_M,
        climb_rad: 0.0,
        axes_rad: 0.0,
        heading_rad: 0.0,
        start_m: [0.0, 0.0],
    };
    let mut scenario = scenario;
    scenario.surroundings.weather = Some(Weather { course, winds, turbulence: None });
    scenario
}

/// The flight is a minute long.
#[test]
fn a_mode_is_asked_in_the_wind_of_the_end_where_that_is_another_than_at_the_start() {
    let end = [-4.0, 2.0, 0.5];
    let constant = steady([-1.0, 3.0, 0.0]);
    let asked = |winds: Vec<Wind>| blown(&in_winds(flight(Vec::new()), winds));
    for (winds, expected) in [
        (vec![], None),
        (vec![constant.clone()], None),
        (vec![table([end; 4])], None),
        // It blows meanwhile, and is over.
        (vec![table([[0.0; 3], end, end, [0.0; 3]])], None),
        (vec![table([[0.0; 3], [0.0; 3], [0.0; 3], end])], Some(end)),
        (vec![table([end, [0.0; 3], [0.0; 3], [0.0; 3]])], Some([0.0; 3])),
        // One part of it alone is another.
        (vec![table([end, end, end, [-4.0, 2.0, 0.6]])], Some([-4.0, 2.0, 0.6])),
        (vec![table([end, end, end, [4.0, 2.0, 0.5]])], Some([4.0, 2.0, 0.5])),
        (vec![constant, table([[0.0; 3], [0.0; 3], end, end])], Some([-5.0, 5.0, 0.5])),
    ] {
        let found = asked(winds.clone());
        let found: Vec<_> = found
            .iter()
            .map(|it| (winds_of(&it.scenario), it.modes.as_slice(), it.seen_as))
            .collect();
        let expected = expected.map(|end| (vec![steady(end)], [0].as_slice(), SeenAs::AtTheEnd));
        assert_eq!(found, Vec::from_iter(expected), "{winds:?}");
    }
    // Nobody but an autopilot sees the ground.
    let alone = scenario(navion(), None);
    let winds = vec![table([[0.0; 3], [0.0; 3], [0.0; 3], end])];
    assert!(blown(&in_winds(alone, winds)).is_empty());
}

fn winds_of(scenario: &Scenario) -> Vec<Wind> {
    scenario.surroundings.weather.as_ref().map_or(Vec::new(), |it| it.winds.clone())
}

/// Modes one after the other of which each turns to a heading or flies a bank, deg, or neither.
fn turning(turns: &[(Option<f64>, f64)]) -> Scenario {
    let heading = outer("heading", Quantity::Heading, Moves::Bank, [1.0, 0.0, 0.0]);
    let modes = turns.iter().enumerate().map(|(place, &(heading_deg, bank_deg))| {
        let engaged: &[usize] = if heading_deg.is_some() { &[0] } else { &[] };
        let target = heading_deg
            .map(|it| Engagement { quantity: Quantity::Heading, target: it.to_radians() });
        let mut own = mode("turn", engaged);
        own.name = format!("turn {place}");
        own.entry.at_s = 10.0 * place as f64;
        Mode { targets: Vec::from_iter(target), bank_rad: bank_deg.to_radians(), ..own }
    });
    let autopilot = Autopilot::new(vec![heading], None, None, modes.collect());
    scenario(navion(), Some(autopilot.expect("makes sense")))
}

/// It was asked in the wind as it blows on the heading of the start alone.
#[test]
fn a_mode_is_asked_on_the_heading_that_it_turns_to_and_the_next_on_the_one_that_it_finds() {
    let wind = [5.0, 0.0, 0.0];
    let asked = |turns: &[(Option<f64>, f64)]| {
        let found = blown(&in_winds(turning(turns), vec![steady(wind)]));
        let of = |it: &super::blown::Blown| {
            assert_eq!(it.seen_as, SeenAs::OnAnotherHeading);
            let [Wind::Steady(blows)] = winds_of(&it.scenario)[..] else { panic!("one wind") };
            (blows.earth_m_s.map(|it| it.round() + 0.0), it.modes.clone())
        };
        found.iter().map(of).collect::<Vec<_>>()
    };
    assert_eq!(asked(&[(None, 0.0), (Some(0.0), 0.0), (Some(360.0), 0.0)]), []);
    // From the left of an aircraft that flies to the east comes what blows to the north: to its left, which is the west of the start.
    assert_eq!(
        asked(&[(None, 0.0), (Some(180.0), 0.0), (None, 0.0), (Some(90.0), 0.0)]),
        [([-5.0, 0.0, 0.0], vec![1, 2]), ([0.0, -5.0, 0.0], vec![3])]
    );
    // A turn without end comes to every heading, and what follows it keeps any; a bank that a loop moves is none.
    assert_eq!(asked(&[(None, 0.0), (None, 20.0), (None, 0.0)]), [([-5.0, 0.0, 0.0], vec![1, 2])]);
    assert_eq!(asked(&[(Some(0.0), 20.0)]), []);
}

fn vertical_speed(gains: [f64; 3]) -> OuterLoop {
    outer("vertical speed", Quantity::VerticalSpeed, Moves::Pitch, gains)
}

fn throttle() -> OuterLoop {
    outer("autothrottle", Quantity::Airspeed, Moves::Throttle, [0.05, 0.005, 0.0])
}

fn asked(scenario: &Scenario) -> GrowthAtRest {
    let controller: Controller = pitch();
    of_mode(scenario, 0, (&controller, controller.nominal())).expect("it flies")
}

/// Small motions see a gyro that erects as one that shows the apparent vertical.
#[test]
fn a_mode_is_in_doubt_where_it_holds_with_an_upright_gyro_alone() {
    let through_a_gyro = |loops: Vec<OuterLoop>, erection_rad_s: f64| {
        let model = SensorModel { erection_rad_s, ..SensorModel::default() };
        let mut scenario = flight(loops);
        scenario.surroundings.pitch_sensor = Some(Sensor::new(model, 1, PITCH).expect("allowed"));
        asked(&scenario)
    };
    let erects = 1e-3;
    // Nobody holds the speed, and pitch alone comes to a swing.
    assert!(through_a_gyro(Vec::new(), 0.0).holds());
    let swings = through_a_gyro(Vec::new(), erects);
    let Some(Doubt::Erection { spectral_radius }) = swings.undecided.map(|it| it.doubt) else {
        panic!("{swings:?}");
    };
    assert!(spectral_radius > 1.0 && swings.certain.is_none(), "{swings:?}");
    // Held as it erects, too.
    let held = || vec![vertical_speed([0.008, 0.004, 0.0]), throttle()];
    for erection_rad_s in [0.0, erects] {
        let found = through_a_gyro(held(), erection_rad_s);
        assert!(found.holds(), "{erection_rad_s}: {found:?}");
    }
    // What grows with either is certain.
    for erection_rad_s in [0.0, erects] {
        let found = through_a_gyro(vec![vertical_speed([0.3, 0.0, 0.0])], erection_rad_s);
        let grows = found.certain.expect("it grows");
        assert!(grows.spectral_radius > 1.001 && grows.mode == Some(0), "{found:?}");
        assert!(found.undecided.is_none(), "{found:?}");
    }
}

/// A period that no number of samples makes whole: the sensor is asked with its largest age, its mean and none.
#[test]
fn a_mode_that_holds_with_every_age_of_its_sensors_holds() {
    let seen_every = |period_s: f64, gains: [f64; 3]| {
        let model = SensorModel { period_s, delay_s: 0.5 * DT_S, ..SensorModel::default() };
        let sensor = Sensor::new(model, 1, PITCH).expect("allowed");
        let slow = OuterLoop { sensor: Some(sensor), ..vertical_speed(gains) };
        asked(&flight(vec![slow, throttle()]))
    };
    let period_s = 0.050_123_4;
    let found = seen_every(period_s, [0.008, 0.004, 0.0]);
    assert!(found.holds(), "{found:?}");
    // What grows may do so with one age alone, and is no more certain.
    let found = seen_every(period_s, [0.3, 0.0, 0.0]);
    assert_eq!(found.undecided.map(|it| it.doubt), Some(Doubt::ChangingAge), "{found:?}");
    assert!(found.certain.is_none());
}
