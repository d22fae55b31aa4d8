//! Nonlinear flights side by side have the bits of single flights, whatever flies beside them.

use std::ops::ControlFlow;
use std::sync::Arc;

use fspid_aircraft::aerodynamics::derivatives::{DragLaw, ThrustLaw};
use fspid_aircraft::data::Laws;
use fspid_aircraft::{Aircraft, Environment, Spool, TrimTarget};
use fspid_core::{Derivative, Gains, Pid, PidConfig};
use fspid_sim::actuator::{Actuator, Lag};
use fspid_sim::air::{
    Along, Follows, Severity, Specification, TableRow, Turbulence, Wind, WindKind, WindTable,
};
use fspid_sim::aircraft::{Forces, Lateral};
use fspid_sim::autopilot::{
    Autopilot, Condition, Entry, GlideSlope, Mode, Moves, OuterLoop, Quantity, Side, Units,
};
use fspid_sim::batch::{Entrant, InstructionSet, Refusal, fly_aircraft, fly_aircraft_by};
use fspid_sim::sensor::{PITCH, RATE, Sensor, SensorPreset};
use fspid_sim::signal::{Disturbance, Entry as Enters, Profile, Shape};
use fspid_sim::{
    AircraftPlant, Controller, Course, Instant, Outcome, Prepared, Scenario, Surroundings, Timing,
    Weather, fly,
};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

use crate::batch::Random;
use crate::support::derivative_data;

/// What may differ between cases but not between the flights of one.
#[derive(Clone, Copy, Debug)]
struct Case {
    seed: u64,
    dt_s: f64,
    aircraft: &'static str,
    laws: Laws,
    /// The standard atmosphere, or air that is the same everywhere.
    standard: bool,
    /// Above the source's own altitude, m.
    higher_m: f64,
    /// Still air, turbulence, winds, both.
    air: u8,
    autopilot: bool,
}

const AIRCRAFT: [&str; 4] = ["navion", "b747-approach", "b747-cruise-high", "cessna-172"];

fn case() -> impl Strategy<Value = Case> {
    let period = prop::sample::select(vec![0.005, 0.01, 0.02, 0.025]);
    let laws = (any::<bool>(), any::<bool>()).prop_map(|(polar, with_speed)| Laws {
        drag: if polar { DragLaw::Polar } else { DragLaw::Linear },
        thrust: if with_speed { ThrustLaw::WithSpeed } else { ThrustLaw::Constant },
    });
    let parts = (any::<u64>(), period, prop::sample::select(AIRCRAFT.to_vec()), laws);
    let rest = (any::<bool>(), prop::sample::select(vec![0.0, 800.0]), 0..4_u8, any::<bool>());
    (parts, rest).prop_map(
        |((seed, dt_s, aircraft, laws), (standard, higher_m, air, autopilot))| Case {
            seed,
            dt_s,
            aircraft,
            laws,
            standard,
            higher_m,
            air,
            autopilot,
        },
    )
}

fn plant(case: Case, random: &mut Random) -> AircraftPlant {
    let mut data = derivative_data(case.aircraft);
    data.longitudinal.pitch.alpha *= random.between(0.8, 1.2);
    data.longitudinal.lift.alpha *= random.between(0.95, 1.05);
    let environment =
        if case.standard { Environment::STANDARD } else { data.reference_environment() };
    let forces = Forces::from(data.force_model(case.laws));
    let aircraft = Aircraft::new(data.mass_properties(), forces, environment).expect("a body");
    let target = TrimTarget {
        airspeed_m_s: data.reference.airspeed_m_s * random.between(0.985, 1.005),
        altitude_m: data.reference.altitude_m + case.higher_m + 150.0,
        flight_path_rad: 0.0,
    };
    let plant = AircraftPlant::trimmed(aircraft, target).expect("flies");
    let spool = match random.bits() % 3 {
        0 => Spool::Instant,
        1 => Spool::FirstOrder { time_constant_s: random.between(0.3, 3.0) },
        _ => Spool::StevensLewis,
    };
    let yaw_damping = if random.one_in(2) { 0.4 } else { 0.0 };
    let lateral = Lateral { bank_time_s: random.between(1.0, 3.0), yaw_damping };
    // Some hit the ground.
    let ground_m = target.altitude_m - if random.one_in(5) { 0.4 } else { 1000.0 };
    let plant =
        plant.with_engine(spool).expect("an engine").with_lateral(lateral).expect("allowed");
    plant.above_ground(ground_m).expect("below")
}

fn actuator(random: &mut Random) -> Actuator {
    let second = |random: &mut Random| {
        Actuator::new(
            Lag::second_order(random.between(15.0, 70.0), random.between(0.4, 1.3))
                .expect("allowed"),
        )
    };
    match random.bits() % 6 {
        0 => Actuator::ideal(),
        1 => Actuator::first_order(random.between(0.03, 0.2)).expect("allowed"),
        2 | 3 => second(random).with_bias(random.between(-0.01, 0.01)).expect("allowed"),
        4 => second(random).with_rate_limit(random.between(0.05, 1.0)).expect("allowed"),
        _ => {
            let wide = second(random).with_travel(-0.1, 0.2).expect("allowed");
            wide.with_play(0.01).expect("allowed").with_delay(2).expect("allowed")
        }
    }
}

fn winds(random: &mut Random, speed_m_s: f64, height_m: f64) -> Vec<Wind> {
    let build = |kind: WindKind, params: &[f64]| kind.build(params).expect("allowed");
    let start_m = random.between(0.0, 1.5) * speed_m_s;
    let rows = (0..6).map(|row| TableRow {
        at: 0.13 + 0.37 * f64::from(row),
        earth_m_s: [f64::from(row % 2), 0.0, -f64::from(row % 3)],
        ..TableRow::default()
    });
    let table = WindTable::new(Along::Time, rows.collect()).expect("allowed");
    let all = [
        build(WindKind::Steady, &[-4.0, 2.0, 0.1]),
        build(WindKind::FullCycle, &[1.0, 2.0, -5.0, random.between(9.0, 80.0), start_m]),
        build(WindKind::RampHold, &[0.0, -2.0, 3.0, 40.0, 0.5 * start_m + 1.0]),
        build(WindKind::Microburst, &[9.0, 900.0, 0.3 * height_m.max(10.0), 300.0, 20.0]),
        Wind::Table(Arc::new(table)),
    ];
    all.into_iter()
        .filter(|_| random.one_in(2))
        .chain([build(WindKind::Steady, &[1.0, 0.0, 0.0])])
        .collect()
}

fn weather(case: Case, random: &mut Random, plant: &AircraftPlant) -> Option<Weather> {
    let TrimTarget { airspeed_m_s, altitude_m, .. } = plant.trim().target;
    let height_m = altitude_m - plant.ground_altitude_m().unwrap_or(0.0);
    let heading_rad = random.between(-3.0, 3.0);
    let course = Course {
        airspeed_m_s,
        height_m,
        climb_rad: 0.0,
        axes_rad: 0.0,
        heading_rad,
        start_m: [10.0, -7.0],
    };
    let turbulence = Turbulence {
        specification: Specification::MilF8785c,
        intensity: Severity::Moderate.into(),
        height_m,
        airspeed_m_s,
        wing_span_m: 11.0,
        noise: random.bits().into(),
        follows: if random.one_in(3) { Follows::Flight } else { Follows::Start },
        driven_until_s: f64::INFINITY,
    };
    let winds = |random: &mut Random| winds(random, airspeed_m_s, height_m);
    match case.air {
        0 => None,
        1 => Some(Weather { course, winds: Vec::new(), turbulence: Some(turbulence) }),
        2 => Some(Weather { course, winds: winds(random), turbulence: None }),
        _ => {
            let winds = if random.one_in(3) { Vec::new() } else { winds(random) };
            Some(Weather { course, winds, turbulence: Some(turbulence) })
        }
    }
}

fn pid(gains: [f64; 3], config: PidConfig<f64>) -> Controller {
    let [kp, ki, kd] = gains;
    Controller::Fixed(Pid::new(Gains { kp, ki, kd }, config).expect("allowed"))
}

fn autopilot(dt_s: f64, altitude_m: f64) -> Autopilot {
    let outer = |name: &str, holds, moves, gains| OuterLoop {
        name: name.to_owned(),
        holds,
        moves,
        controller: pid(gains, PidConfig::sampled_every(dt_s)),
        units: Units::SI,
        sensor: None,
    };
    let loops = vec![
        outer("altitude", Quantity::Altitude, Moves::Loop(2), [0.002, 0.0, 0.0]),
        outer("beam", Quantity::GlideSlope, Moves::Loop(2), [0.0015, 0.000_08, 0.0]),
        outer("path", Quantity::FlightPath, Moves::Pitch, [0.6, 0.4, 0.0]),
        outer("throttle", Quantity::Airspeed, Moves::Throttle, [0.1, 0.02, 0.0]),
    ];
    let mode = |name: &str, engaged: &[usize], conditions: Vec<Condition>| Mode {
        name: name.to_owned(),
        entry: Entry { at_s: if conditions.is_empty() { 0.0 } else { 0.5 }, conditions },
        engaged: engaged.to_vec(),
        total_energy: false,
        targets: Vec::new(),
        bank_rad: 0.1,
    };
    let above = Condition { quantity: Quantity::GlideSlope, side: Side::Above, value: -90.0 };
    let modes = vec![mode("level", &[0, 2, 3], Vec::new()), mode("beam", &[1, 2, 3], vec![above])];
    let beam = GlideSlope {
        angle_rad: 0.05,
        antenna_m: [3000.0, 0.0],
        altitude_m: altitude_m - 200.0,
        course_rad: 0.1,
        angle_sensor: None,
        range_sensor: None,
    };
    Autopilot::new(loops, None, Some(beam), modes).expect("makes sense")
}

fn scenario(case: Case, random: &mut Random, end_s: f64) -> Scenario {
    let plant = plant(case, random);
    let sensors = SensorPreset::ALL.get((random.bits() % 6) as usize).map(|preset| {
        let start = |model, channel| Sensor::new(model, 7, channel).expect("allowed");
        (start(preset.pitch, PITCH), start(preset.rate, RATE))
    });
    let surroundings = Surroundings {
        weather: weather(case, random, &plant),
        pitch_sensor: sensors.map(|(pitch, _)| pitch),
        rate_sensor: sensors.map(|(_, rate)| rate),
    };
    let gains = [random.between(0.2, 1.0), random.between(0.0, 0.5), random.between(0.0, 0.3)];
    // Some are flown onto their backs.
    let gains = if random.one_in(8) { gains.map(|gain| -40.0 * gain) } else { gains };
    let config = PidConfig {
        derivative: Derivative { filter_s: 0.05 },
        ..PidConfig::sampled_every(case.dt_s)
    };
    let step =
        Profile::new(random.between(-0.03, 0.03), Shape::Step { at_s: 0.2 }).expect("allowed");
    let push =
        Disturbance::new(Enters::Elevator, 0.003, Shape::Step { at_s: 0.6 }).expect("allowed");
    let altitude_m = plant.trim().target.altitude_m;
    let timing = Timing::new(case.dt_s, end_s).expect("allowed");
    Scenario {
        actuator: actuator(random),
        surroundings,
        disturbances: vec![push],
        autopilot: case.autopilot.then(|| autopilot(case.dt_s, altitude_m)),
        ..Scenario::new("flight", plant, timing, step).with_controller("PID", pid(gains, config))
    }
}

/// Everything that is seen of a sample, in bits.
fn bits(instant: &Instant) -> Vec<u64> {
    let aircraft = instant.aircraft.expect("an aircraft");
    let more = [
        instant.k as f64,
        instant.setpoint_rad,
        instant.theta_rad,
        instant.q_rad_s,
        instant.elevator_rad,
        instant.measured[0],
        instant.measured[1],
        instant.step.command_rad,
        aircraft.path_acceleration_m_s2,
        aircraft.apparent_vertical_rad,
        aircraft.ground_speed_m_s,
    ];
    let autopilot = instant.autopilot.map(|sample| sample.values());
    let values = aircraft.values().into_iter().chain(more).chain(autopilot.into_iter().flatten());
    values.map(f64::to_bits).collect()
}

type Flown = (Vec<Vec<u64>>, Outcome);

fn alone(prepared: &Prepared, controller: &Controller) -> Flown {
    let mut rows = Vec::new();
    let outcome = fly(prepared, controller, |instant| {
        rows.push(bits(&instant));
        ControlFlow::Continue(())
    });
    (rows, outcome.expect("flies"))
}

fn entrants<'a>(scenarios: &'a [Scenario], prepared: &'a [Prepared]) -> Vec<Entrant<'a>> {
    let pairs = scenarios.iter().zip(prepared);
    pairs
        .map(|(it, prepared)| Entrant { prepared, controller: &it.controllers[0].controller })
        .collect()
}

fn abreast(instructions: InstructionSet, entrants: &[Entrant<'_>]) -> Vec<Flown> {
    let mut rows = vec![Vec::new(); entrants.len()];
    let outcomes =
        fly_aircraft_by(instructions, entrants, |place, instant| rows[place].push(bits(instant)));
    let outcomes =
        outcomes.expect("side by side").into_iter().map(|outcome| outcome.expect("flies"));
    rows.into_iter().zip(outcomes).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, rng_seed: RngSeed::Fixed(20), ..ProptestConfig::default() })]

    #[test]
    fn aircraft_side_by_side_have_the_bits_of_single_flights(case in case(), count in 1..=8_usize) {
        let mut random = Random(case.seed);
        let scenarios: Vec<Scenario> = (0..count).map(|_| scenario(case, &mut random, 2.5)).collect();
        let prepared: Vec<Prepared> = scenarios.iter().map(|it| it.prepare().expect("prepares")).collect();
        let entrants = entrants(&scenarios, &prepared);
        let expected: Vec<Flown> = entrants.iter().map(|it| alone(it.prepared, it.controller)).collect();
        for instructions in InstructionSet::available() {
            for (flight, (found, expected)) in abreast(instructions, &entrants).iter().zip(&expected).enumerate() {
                prop_assert_eq!(&found.1, &expected.1, "flight {}", flight);
                prop_assert_eq!(found.0.len(), expected.0.len(), "flight {}", flight);
                for (k, (found, expected)) in found.0.iter().zip(&expected.0).enumerate() {
                    prop_assert_eq!(found, expected, "flight {}, sample {}", flight, k);
                }
            }
        }
    }
}

const EVERYTHING: Case = Case {
    seed: 4,
    dt_s: 0.01,
    aircraft: "navion",
    laws: Laws { drag: DragLaw::Polar, thrust: ThrustLaw::WithSpeed },
    standard: true,
    higher_m: 0.0,
    air: 3,
    autopilot: true,
};

fn some(case: Case, end_s: f64) -> (Vec<Scenario>, Vec<Prepared>) {
    let mut random = Random(case.seed);
    let scenarios: Vec<Scenario> = (0..8).map(|_| scenario(case, &mut random, end_s)).collect();
    let prepared = scenarios.iter().map(|it| it.prepare().expect("prepares")).collect();
    (scenarios, prepared)
}

#[test]
fn a_flight_with_outer_loops_allocates_no_more_when_it_is_longer_alone_and_side_by_side() {
    // Turbulence that follows the flight makes filters anew, which is the one thing that allocates.
    let held = |(mut scenarios, _): (Vec<Scenario>, Vec<Prepared>)| {
        for scenario in &mut scenarios {
            let weather = scenario.surroundings.weather.as_mut();
            if let Some(turbulence) = weather.and_then(|it| it.turbulence.as_mut()) {
                turbulence.follows = Follows::Start;
            }
        }
        let prepared: Vec<Prepared> =
            scenarios.iter().map(|it| it.prepare().expect("prepares")).collect();
        (scenarios, prepared)
    };
    let allocations = |end_s: f64, side_by_side: bool| {
        let (scenarios, prepared) = held(some(EVERYTHING, end_s));
        let entrants = entrants(&scenarios, &prepared);
        // Once before, so that what a thread keeps is there.
        let mut rows = 0;
        let mut flown = || {
            if side_by_side {
                fly_aircraft(&entrants, |_, _| rows += 1).expect("side by side");
                return;
            }
            for it in &entrants {
                fly(it.prepared, it.controller, |_| {
                    rows += 1;
                    ControlFlow::Continue(())
                })
                .expect("flies");
            }
        };
        flown();
        let counted = allocation_counter::measure(flown).count_total;
        assert!(rows > 500);
        counted
    };
    for side_by_side in [false, true] {
        assert_eq!(allocations(1.0, side_by_side), allocations(8.0, side_by_side));
    }
}

#[test]
fn what_cannot_fly_beside_others_is_refused_by_name() {
    let (scenarios, prepared) = some(EVERYTHING, 1.0);
    let case = Case { laws: Laws { drag: DragLaw::Linear, ..EVERYTHING.laws }, ..EVERYTHING };
    let still = Case { air: 0, ..EVERYTHING };
    let slower = Case { dt_s: 0.02, ..EVERYTHING };
    for (case, what) in [
        (case, "its law of drag or thrust"),
        (still, "whether the air moves"),
        (slower, "its timing"),
    ] {
        let (others, also) = some(case, 1.0);
        let (mut all, other) =
            (entrants(&scenarios[..3], &prepared[..3]), entrants(&others, &also));
        all.push(other[0]);
        assert_eq!(fly_aircraft(&all, |_, _| ()), Err(Refusal::Differs { flight: 3, what }));
    }
    let mut many = entrants(&scenarios, &prepared);
    many.push(many[0]);
    assert_eq!(fly_aircraft(&many, |_, _| ()), Err(Refusal::TooMany { found: 9, most: 8 }));
    assert_eq!(fly_aircraft(&[], |_, _| ()), Ok(Vec::new()));
}
