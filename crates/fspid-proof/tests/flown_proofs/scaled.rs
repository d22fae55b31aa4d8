//! Families of drawn loops whose sensors show more or less than there is: each member of a proved one comes to rest.

use fspid_core::Sample;
use fspid_numeric::scalar::Interval;
use fspid_proof::check::{ActuatorLag, ContinuousPlant, LagOf, NotProved, Sloped};
use fspid_proof::{
    Asked, Certificate, FamilyVerdict, LoopDescription, Parameter, ScaledSensor, Verdict, certify,
    prove_family,
};
use fspid_sim::Scenario;
use fspid_sim::sensor::{Sensor, SensorModel};

use super::drawn::{self, Dice};
use super::flown::{Start, quick, settles, settles_seeing, without_limits};

/// With these numbers families of fixed and moving gains are proved, cut into parts and not, and one grows.
const SCENARIOS: [u64; 8] = [3, 4, 6, 7, 8, 9, 11, 12];

#[test]
fn every_flight_of_a_proved_family_of_sensors_comes_to_rest() {
    let is_long = std::env::var_os("FSPID_LONG_TESTS").is_some();
    let seeds = if is_long { (0..41).collect() } else { SCENARIOS.to_vec() };
    let mut found = [0; 4];
    for seed in seeds {
        let dice = &mut Dice::new(seed);
        let drawn = if seed % 2 == 0 { drawn::scenario(dice) } else { drawn::structured(dice) };
        let what = came_to_rest(seed, &without_bias(&drawn), dice);
        found[usize::from(what.unwrap_or(3))] += 1;
    }
    let [refuted, proved, changing, _] = found;
    let is_enough = proved + changing >= 3 && changing >= 1 && refuted >= 1;
    assert!(is_enough, "refuted, proved, proved with scales that change, neither: {found:?}");
}

/// 1 where the family is proved and every flight comes to rest, 2 where its scales may change as well, 0 where a member is
/// shown to grow; `None` otherwise.
fn came_to_rest(seed: u64, scenario: &Scenario, dice: &mut Dice) -> Option<u8> {
    let plant = scenario.plant.linear().expect("linear");
    let loop_ = LoopDescription::of(scenario, plant, &scenario.controllers[0].controller).ok()?;
    let ends = [ScaledSensor::Pitch, ScaledSensor::Rate]
        .map(|sensor| (sensor, [-dice.between(5.0, 60.0), dice.between(20.0, 400.0)]));
    let parameters = ends.map(|(sensor, ends)| Parameter {
        name: format!("{sensor:?}"),
        paths: Vec::new(),
        relative: false,
        inverse: false,
        sensors: vec![sensor],
        ends,
    });
    let makes = |_: &[Sloped]| as_printed(&loop_);
    let family = match prove_family(&loop_, &parameters, &quick(), &makes).ok()? {
        FamilyVerdict::Proved(family) => family,
        FamilyVerdict::Refuted { .. } => return Some(0),
        FamilyVerdict::Open { .. } => return None,
    };
    let outcome = certify(&loop_, &Asked::rest(), &quick()).ok()?;
    let Verdict::Proved(certificate, rechecked) = outcome.verdict else { return None };
    let whole = Certificate { family: Some(family.clone()), ..certificate.clone() };
    assert!(whole.check().is_ok(), "scenario {seed}: checked anew it is another");
    let free = without_limits(scenario);
    let corner = |number: usize| ends.each_ref().map(|(_, ends)| ends[number.min(1)]);
    let mut members = vec![corner(0), corner(1), [ends[0].1[0], ends[1].1[1]]];
    members.extend((0..3).map(|_| ends.map(|(_, [from, to])| dice.between(from, to))));
    let start =
        Start { setpoint_rad: 0.0, load_rad: 0.0, kick_rad: 20.0_f64.to_radians(), ramp: false };
    for scales_pct in members {
        let of_part = family.parts.iter().find(|part| {
            part.ends.iter().zip(scales_pct).all(|(ends, it)| (ends[0]..=ends[1]).contains(&it))
        });
        let claim = of_part.expect("a part for every member").claim.clone();
        let proved = (Certificate { claim, ..certificate.clone() }, rechecked.clone());
        let flown = with_scales(&free, scales_pct);
        if let Err(reason) = settles(&flown, &proved, start) {
            panic!("scenario {seed} with {scales_pct:?} %: {reason}");
        }
    }
    if !family.scales_may_change() {
        return Some(1);
    }
    // The plant is one, so that all parts have one claim.
    let claim = family.parts[0].claim.clone();
    let proved = (Certificate { claim, ..certificate }, rechecked);
    let as_it_is = with_scales(&free, [0.0; 2]);
    for way in Way::ALL {
        let mut sees = way.between(ends.map(|(_, ends)| ends), dice);
        if let Err(reason) = settles_seeing(&as_it_is, &proved, start, &mut sees) {
            panic!("scenario {seed} whose scales change, {way:?}: {reason}");
        }
    }
    Some(2)
}

/// How scales change in flight.
#[derive(Clone, Copy, Debug)]
enum Way {
    /// To one of the ends, anew in each sample.
    Jumps,
    /// Slowly, from end to end, each sensor in a time of its own.
    Waves,
    /// Less is shown of small values than of large ones.
    Bent,
    /// More is shown on the way out, less on the way back.
    Against,
}

impl Way {
    const ALL: [Self; 4] = [Self::Jumps, Self::Waves, Self::Bent, Self::Against];

    /// What is seen of a sample by sensors whose scale errors lie between these ends, %.
    fn between<'a>(
        self,
        ends: [[f64; 2]; 2],
        dice: &'a mut Dice,
    ) -> impl FnMut(Sample<f64>) -> Sample<f64> + 'a {
        let (mut k, mut before_rad) = (0.0, 0.0);
        move |sample| {
            let Sample { measurement_rad, rate_rad_s, .. } = sample;
            let outward = measurement_rad.abs() > f64::abs(before_rad);
            let share = |which: usize, value: f64, dice: &mut Dice| match self {
                Self::Jumps => dice.between(0.0, 1.0).round(),
                Self::Waves => 0.5 + 0.5 * libm::sin(k / (40.0 + 90.0 * which as f64)),
                Self::Bent => f64::from(u8::from(value.abs() > 0.01)),
                Self::Against => f64::from(u8::from(outward)),
            };
            let shown = |which: usize, value: f64, dice: &mut Dice| {
                let [from, to] = ends[which];
                value * (1.0 + (from + share(which, value, dice) * (to - from)) / 100.0)
            };
            let seen = Sample {
                measurement_rad: shown(0, measurement_rad, dice),
                rate_rad_s: shown(1, rate_rad_s, dice),
                ..sample
            };
            (k, before_rad) = (k + 1.0, measurement_rad);
            seen
        }
    }
}

/// The plant and actuator of a loop as they are.
fn as_printed(loop_: &LoopDescription) -> Result<ContinuousPlant<Sloped>, NotProved> {
    let fixed = |value: f64| Sloped::fixed(Interval::point(value));
    let all = |values: &[f64]| -> Vec<Sloped> { values.iter().map(|&it| fixed(it)).collect() };
    let lag = match ActuatorLag::from(loop_.actuator.lag()) {
        ActuatorLag::None => LagOf::None,
        ActuatorLag::First { time_constant_s } => LagOf::First(fixed(1.0 / time_constant_s)),
        ActuatorLag::Second { natural_frequency_rad_s, damping } => {
            LagOf::Second(fixed(natural_frequency_rad_s), fixed(damping))
        }
    };
    let (numerator, denominator) = (all(&loop_.numerator), all(&loop_.denominator));
    Ok(ContinuousPlant::of_transfer_function(&numerator, &denominator, loop_.elevator_sign, lag))
}

/// A scenario in which what sensors show is off by nothing that stays.
fn without_bias(scenario: &Scenario) -> Scenario {
    sensed(scenario, |_, model| SensorModel { bias: 0.0, resolution: 0.0, ..model })
}

fn with_scales(scenario: &Scenario, scales_pct: [f64; 2]) -> Scenario {
    sensed(scenario, |which, model| SensorModel { scale_error: scales_pct[which] / 100.0, ..model })
}

/// With sensors of pitch and pitch rate that are made of those that there are.
fn sensed(scenario: &Scenario, change: impl Fn(usize, SensorModel) -> SensorModel) -> Scenario {
    let mut changed = scenario.clone();
    let surroundings = &mut changed.surroundings;
    let sensors = [&mut surroundings.pitch_sensor, &mut surroundings.rate_sensor];
    for (which, sensor) in sensors.into_iter().enumerate() {
        let model = sensor.as_ref().map_or_else(SensorModel::default, |it| *it.model());
        let channel = u32::try_from(which).expect("few");
        *sensor = Some(Sensor::new(change(which, model), 1, channel).expect("allowed"));
    }
    changed
}
