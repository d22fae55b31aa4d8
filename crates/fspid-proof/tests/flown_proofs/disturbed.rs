//! Bounds of what disturbances do, flown: switched at the sign of the impulse response, at the resonance, and as drawn,
//! at the elevator and in the air, with what a supervisor makes of them.

use std::ops::ControlFlow;
use std::sync::OnceLock;

use fspid_core::Gains;
use fspid_lti::Matrix;
use fspid_proof::{
    AirPart, Asked, Certificate, Disturbed, Extent, LoopDescription, Quantity, Rechecked, Verdict,
    Way, bound_disturbances, certify, ways_of,
};
use fspid_sim::air::{Along, TableRow, Wind, WindTable};
use fspid_sim::sensor::{PITCH, Sensor, SensorModel};
use fspid_sim::signal::{Disturbance, Entry, Profile, Shape};
use fspid_sim::{Course, LinearPlant, Plant, Scenario, Timing, Weather, fly};

use super::drawn::{self, Dice};
use super::flown::{quick, without_limits};

/// Rounding of flights, as a share, and rad.
const SHARE: f64 = 1.0 + 1e-9;
const ROUNDING_RAD: f64 = 1e-12;
/// The scenario of this number has gains that move, and limits that are covered.
const SELF_TUNING: u64 = 5;
/// Samples of a flight.
const SAMPLES: usize = 1200;

/// Who draws a scenario.
type Draw = fn(&mut Dice) -> Scenario;

fn differs(one: f64, other: f64) -> bool {
    one.total_cmp(&other).is_ne()
}

/// A scenario whose plant feels the air, with nothing that keeps it from rest at the trim.
pub(crate) fn at_rest(dice: &mut Dice, drawn: Draw) -> Scenario {
    let mut scenario = drawn(dice);
    scenario.disturbances.clear();
    scenario.setpoint = Profile::new(0.0, Shape::Step { at_s: 0.0 }).expect("allowed");
    scenario.actuator = scenario.actuator.with_bias(0.0).expect("allowed");
    if let Some(sensor) = &scenario.surroundings.pitch_sensor {
        let model = SensorModel { bias: 0.0, ..*sensor.model() };
        scenario.surroundings.pitch_sensor = Some(Sensor::new(model, 1, PITCH).expect("allowed"));
    }
    let plant = scenario.plant.linear().expect("linear");
    let function = plant.transfer_function();
    let [numerator, denominator] = [function.numerator(), function.denominator()];
    let felt = [0.002 * (dice.part() - 0.5), 0.02 * dice.part(), 0.001 * dice.part()];
    let plant = LinearPlant::new(
        numerator.coefficients(),
        denominator.coefficients(),
        plant.elevator_sign(),
    )
    .and_then(|it| it.with_gusts([&felt[..1], &felt[1..], &[]]));
    scenario.plant = Plant::from(plant.expect("allowed"));
    let dt_s = scenario.timing.dt_s();
    scenario.timing = Timing::new(dt_s, SAMPLES as f64 * dt_s).expect("allowed");
    scenario
}

/// Self-tuning, with bounds of every kind; it takes seconds.
fn self_tuning() -> &'static (Certificate, Rechecked) {
    static FOUND: OnceLock<(Certificate, Rechecked)> = OnceLock::new();
    FOUND.get_or_init(|| {
        let scenario = at_rest(&mut Dice::new(SELF_TUNING), drawn::scenario);
        bounded(&scenario).expect("bounded")
    })
}

/// The certificate of a scenario with its bounds; none where nothing is proved or bounded.
pub(crate) fn bounded(scenario: &Scenario) -> Option<(Certificate, Rechecked)> {
    let plant = scenario.plant.linear().expect("linear");
    let controller = &scenario.controllers[0].controller;
    let description = LoopDescription::of(scenario, plant, controller).ok()?;
    let asked = Asked::of(scenario, plant, &description);
    let outcome = certify(&description, &asked, &quick()).ok()?;
    let Verdict::Proved(certificate, _) = outcome.verdict else { return None };
    let found = bound_disturbances(&certificate, &ways_of(plant), &quick()).ok()?;
    assert_eq!(found.0.check().as_ref(), Ok(&found.1), "read again it says the same");
    Some(found)
}

/// Pitch angle and command of a flight, and whether a limit of the controller acted.
struct Flown {
    pitch_rad: Vec<f64>,
    command_rad: Vec<f64>,
    saturated: bool,
}

fn flown(scenario: &Scenario) -> Flown {
    let prepared = scenario.prepare().expect("flies");
    let mut flown = Flown { pitch_rad: Vec::new(), command_rad: Vec::new(), saturated: false };
    let outcome = fly(&prepared, &scenario.controllers[0].controller, |instant| {
        flown.pitch_rad.push(instant.theta_rad);
        flown.command_rad.push(instant.step.command_rad);
        flown.saturated |= instant.step.saturated;
        ControlFlow::Continue(())
    });
    outcome.expect("flies");
    flown
}

/// A scenario with a disturbance that is held over each sample; in the air it passes within a seventh of a sample.
fn disturbed(scenario: &Scenario, way: &Way, values: &[f64]) -> Scenario {
    let mut disturbed = scenario.clone();
    let dt_s = scenario.timing.dt_s();
    let Way::Air { part, .. } = way else {
        let before = std::iter::once(&0.0).chain(values);
        let steps =
            values.iter().zip(before).enumerate().filter(|(_, (now, last))| differs(**now, **last));
        let steps = steps.map(|(k, (now, last))| {
            let at_s = k as f64 * dt_s;
            Disturbance::new(Entry::Elevator, now - last, Shape::Step { at_s }).expect("allowed")
        });
        disturbed.disturbances = steps.collect();
        return disturbed;
    };
    let place = if *part == AirPart::Forward { 0 } else { 2 };
    let row = |at: f64, value: f64| {
        let mut body_m_s = [0.0; 3];
        body_m_s[place] = value;
        TableRow { at, body_m_s, ..TableRow::default() }
    };
    // Between samples as well: it begins a third of a sample late.
    let mut rows = vec![row(-1.0, 0.0)];
    let mut last = 0.0;
    for (k, &value) in values.iter().enumerate().filter(|(k, _)| *k > 0) {
        if differs(value, last) {
            let from_s = (k as f64 + 1.0 / 3.0) * dt_s;
            rows.extend([row(from_s, last), row(from_s + dt_s / 7.0, value)]);
            last = value;
        }
    }
    let course = Course {
        airspeed_m_s: 50.0,
        height_m: 500.0,
        climb_rad: 0.0,
        axes_rad: 0.0,
        heading_rad: 0.0,
        start_m: [0.0; 2],
    };
    let table = WindTable::new(Along::Time, rows).expect("a table");
    disturbed.surroundings.weather =
        Some(Weather { course, winds: vec![Wind::Table(table.into())], turbulence: None });
    disturbed
}

/// Disturbances of magnitude 1: switched so that what came earlier adds up at the end, constant, at the resonance of
/// the impulse response, and as drawn.
fn signals(impulse: &[f64], dice: &mut Dice) -> Vec<Vec<f64>> {
    let last = SAMPLES - 1;
    let sign = |value: f64| if value < 0.0 { -1.0 } else { 1.0 };
    let worst: Vec<f64> = (0..SAMPLES).map(|k| sign(impulse[last - k])).collect();
    let at = |frequency: f64, k: usize| libm::sin(frequency * k as f64);
    let size = |frequency: f64| {
        let [sine, cosine] = [0.0, core::f64::consts::FRAC_PI_2].map(|phase| {
            let each = impulse.iter().enumerate();
            each.map(|(k, h)| h * libm::sin(frequency * k as f64 + phase)).sum::<f64>()
        });
        libm::hypot(sine, cosine)
    };
    let frequencies = (0..200).map(|step| 0.002 * libm::pow(1000.0, f64::from(step) / 200.0));
    let resonance = frequencies.max_by(|a, b| size(*a).total_cmp(&size(*b))).expect("some");
    let held = 1 + (20.0 * dice.part()) as usize;
    let mut value = 1.0;
    let steps = (0..SAMPLES).map(|k| {
        if k % held == 0 {
            value = 2.0 * dice.part() - 1.0;
        }
        value
    });
    let steps: Vec<f64> = steps.collect();
    vec![
        worst,
        vec![1.0; SAMPLES],
        (0..SAMPLES).map(|k| at(resonance, k)).collect(),
        (0..SAMPLES).map(|k| sign(at(resonance, k))).collect(),
        steps,
    ]
}

/// The share of the bound that a flight comes to; above 1 where it is refuted. `values` are the disturbance.
fn share(bound: &Disturbed, flown: &Flown, values: &[f64], (dt_s, remains_rad): (f64, f64)) -> f64 {
    let seen = match bound.quantity {
        Quantity::Pitch => &flown.pitch_rad,
        Quantity::Command => &flown.command_rad,
        Quantity::Limits => unreachable!("not told alone"),
    };
    let most = |values: &[f64]| values.iter().fold(0.0_f64, |most, it| most.max(it.abs()));
    let root = |values: &[f64]| (dt_s * values.iter().map(|it| it * it).sum::<f64>()).sqrt();
    let (reached, allowed) = match bound.extent {
        Extent::Peak => (most(seen), bound.per_unit * most(values) + remains_rad),
        // What passes in a straight line has no more energy than the larger of its ends for as long.
        Extent::Energy => (root(seen), bound.per_unit * root(values)),
    };
    (reached - ROUNDING_RAD) / (allowed * SHARE)
}

/// Flies the ways of a scenario at some sizes; the largest share of each measure that is reached.
fn attack(seed: u64, drawn: Draw) -> Option<[f64; 2]> {
    let mut dice = Dice::new(seed);
    let scenario = at_rest(&mut dice, drawn);
    let found = match seed {
        SELF_TUNING => self_tuning().clone(),
        _ => bounded(&scenario)?,
    };
    Some(attack_of(dice, &scenario, &found))
}

/// The same of a scenario whose certificate is known.
pub(crate) fn attack_of(
    mut dice: Dice,
    scenario: &Scenario,
    (certificate, rechecked): &(Certificate, Rechecked),
) -> [f64; 2] {
    let free = without_limits(scenario);
    let own = (scenario.timing.dt_s(), rechecked.remains_rad);
    let mut largest = [0.0_f64; 2];
    let mut ways: Vec<Way> = certificate.disturbances.iter().map(|it| it.way.clone()).collect();
    ways.dedup();
    for way in &ways {
        let sizes = if *way == Way::Elevator { [1e-3, 0.5] } else { [0.1, 60.0] };
        let mut pulse = vec![0.0; SAMPLES];
        pulse[1] = sizes[0];
        let impulse = flown(&disturbed(&free, way, &pulse)).pitch_rad;
        for signal in signals(&impulse[1..], &mut dice) {
            for size in sizes {
                let mut values: Vec<f64> = signal.iter().map(|it| size * it).collect();
                values.truncate(SAMPLES - 1);
                let flight = flown(&disturbed(&free, way, &values));
                for bound in rechecked.disturbed.iter().filter(|it| it.way == *way) {
                    let share = share(bound, &flight, &values, own);
                    assert!(share <= 1.0, "{bound:?}: {share} of it");
                    let place = usize::from(bound.extent == Extent::Peak);
                    largest[place] = largest[place].max(share);
                }
            }
        }
    }
    largest
}

#[test]
fn no_flight_goes_beyond_what_is_bounded_of_disturbances() {
    let seeds: [(u64, Draw); 3] =
        [(5, drawn::scenario), (9, drawn::scenario), (9, drawn::structured)];
    let shares: Vec<[f64; 2]> = std::thread::scope(|scope| {
        let started: Vec<_> =
            seeds.iter().map(|&(seed, drawn)| scope.spawn(move || attack(seed, drawn))).collect();
        started.into_iter().filter_map(|it| it.join().expect("no bound is refuted")).collect()
    });
    assert!(shares.len() >= 3, "{} bounded", shares.len());
    // The bounds are no idle ones: flights come near some of them.
    let nearest = |place: usize| shares.iter().map(|it| it[place]).fold(0.0, f64::max);
    assert!(nearest(0) > 0.8 && nearest(1) > 0.3, "{shares:?}");
}

/// The largest gain from energy to pitch angle that any frequency finds in a loop whose gains stand still, at the elevator:
/// $\sqrt T |c (e^{j \omega} - M)^{-1} E|$.
pub(crate) fn frozen_norm(certificate: &Certificate, gains: Gains<f64>) -> f64 {
    let description = &certificate.description;
    let model = description.enclosed().expect("enclosed").midpoint();
    let matrix = model.closed_matrix(gains).expect("a matrix");
    let plant = description.printed();
    let entry = plant.driven(None).expect("driven");
    let (states, inputs) = (matrix.rows(), entry.columns());
    let at = |frequency: f64| {
        let (sine, cosine) = (libm::sin(frequency), libm::cos(frequency));
        // Transposed, real part above imaginary part.
        let place = |row: usize, column: usize| {
            let (i, j) = (row % states, column % states);
            let same = f64::from(u8::from(i == j));
            match (row < states, column < states) {
                (true, true) | (false, false) => {
                    cosine * same - matrix.get(j, i).expect("an entry")
                }
                (true, false) => -sine * same,
                (false, true) => sine * same,
            }
        };
        let rows = (0..2 * states).map(|row| (0..2 * states).map(|it| place(row, it)).collect());
        let rows: Vec<Vec<f64>> = rows.collect();
        let first = (0..2 * states).map(|row| [f64::from(u8::from(row == 0))]);
        let first = Matrix::from_rows(&first.collect::<Vec<_>>()).expect("finite");
        let solved = Matrix::from_rows(&rows).expect("finite").solve(&first).expect("regular");
        let parts = (0..2 * inputs).map(|input| {
            let (part, column) = (input / inputs, input % inputs);
            let own = (0..entry.rows()).map(|state| {
                entry.get(state, column).expect("an entry") * solved.data()[part * states + state]
            });
            own.sum::<f64>()
        });
        (plant.dt_s * parts.map(|it| it * it).sum::<f64>()).sqrt()
    };
    let frequencies = (0..2000).map(|step| 1e-4 * libm::pow(3e4, f64::from(step) / 2000.0));
    frequencies.map(at).fold(at(0.0), f64::max)
}

#[test]
fn a_bound_by_energy_is_above_the_norm_of_frozen_loops_and_near_that_of_fixed_gains() {
    let fixed = at_rest(&mut Dice::new(9), drawn::scenario);
    for (found, most) in [(&bounded(&fixed).expect("bounded"), 1.02), (self_tuning(), 3.0)] {
        let (certificate, rechecked) = found;
        let bound = rechecked.disturbed.iter().find(|it| {
            (&it.way, it.quantity, it.extent) == (&Way::Elevator, Quantity::Pitch, Extent::Energy)
        });
        let norm = frozen_norm(certificate, certificate.description.controller.nominal());
        let ratio = bound.expect("bounded").per_unit / norm;
        assert!((1.0..most).contains(&ratio), "{ratio}");
    }
}

#[test]
fn up_to_the_disturbance_that_is_told_no_limit_acts() {
    let mut flights = 0;
    for seed in 0..3 {
        let mut dice = Dice::new(seed);
        let scenario = at_rest(&mut dice, drawn::with_limits);
        let Some((_, rechecked)) = bounded(&scenario) else { continue };
        let free = without_limits(&scenario);
        for bound in rechecked.disturbed.iter().filter(|it| it.extent == Extent::Peak) {
            let size = bound.unlimited_up_to.expect("limits are covered");
            assert!(size.is_finite() && size > 0.0, "{bound:?}");
            let mut pulse = vec![0.0; SAMPLES];
            pulse[1] = 1e-3 * size;
            let impulse = flown(&disturbed(&free, &bound.way, &pulse)).pitch_rad;
            for signal in signals(&impulse[1..], &mut dice) {
                let values: Vec<f64> = signal[1..].iter().map(|it| size * it).collect();
                let [limited, free] = [&scenario, &free]
                    .map(|scenario| flown(&disturbed(scenario, &bound.way, &values)));
                let pairs = limited.pitch_rad.iter().zip(&free.pitch_rad);
                let apart = pairs.map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
                assert!(!limited.saturated && apart < 1e-9, "scenario {seed}, {bound:?}: {apart}");
                flights += 1;
            }
        }
    }
    assert!(flights >= 10, "{flights}");
}

#[test]
fn a_bound_that_is_made_smaller_or_of_another_measure_is_not_believed() {
    let (certificate, _) = self_tuning();
    let with = |change: &dyn Fn(&mut fspid_proof::DisturbanceBound)| {
        let mut changed = certificate.clone();
        changed.disturbances.iter_mut().for_each(change);
        changed.check()
    };
    assert!(with(&|_| {}).is_ok());
    assert!(with(&|bound| bound.gain *= 0.98).is_err());
    assert!(with(&|bound| bound.gain = f64::NAN).is_err());
    assert!(with(&|bound| bound.gain = 0.0).is_err());
    assert!(with(&|bound| bound.decay = 1.0).is_err());
    assert!(with(&|bound| bound.decay = 0.5).is_err());
    assert!(with(&|bound| bound.form = bound.form.scaled(0.5)).is_err());
    assert!(with(&|bound| bound.form = bound.form.scaled(-1.0)).is_err());
    // A gust that acts ten times as strongly is not bounded by what bounds this one.
    assert!(
        with(&|bound| if let Way::Air { numerator, .. } = &mut bound.way {
            numerator.iter_mut().for_each(|it| *it *= 10.0);
        })
        .is_err()
    );
    // Nor one of another length.
    assert!(
        with(&|bound| if let Way::Air { numerator, .. } = &mut bound.way {
            numerator.push(0.0);
        })
        .is_err()
    );
    let mut many = certificate.clone();
    many.disturbances = vec![certificate.disturbances[0].clone(); 25];
    assert!(many.check().is_err());
}
