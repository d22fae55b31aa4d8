//! Rejection of constant loads: the steady-state effect of a constant disturbance at the servo, and whether the controller
//! removes it within the flight.
//!
//! A trim that is off, a shifted centre of gravity, a biased servo: each is a constant at the servo. An integral takes
//! its effect away in time; a controller without one, or whose integral is slow beside the flight, does not.

use fspid_core::{Gains, PidConfig};
use fspid_lti::{LtiError, Matrix};

use crate::aircraft::AircraftPlant;
use crate::error::SimError;
use crate::integral_limits::HeldIntegral;
use crate::loop_model::{LoopModel, Memory};
use crate::plant::LinearPlant;
use crate::scenario::Scenario;
use crate::stability::holds;

/// Points at which the error of a flight is looked at; in the last tenth it is looked at each sample, for swings that are
/// faster than the points, and before the first point at ever longer intervals, for answers that are over by then. Its
/// largest value between them is missed by little, and what is missed makes the share that is left look larger, on the
/// safe side.
const POINTS: usize = 64;
/// The points before the last tenth.
const EARLY_POINTS: usize = POINTS - POINTS / 10;
/// How often the time is doubled to see where the error ends: beyond a thousand flights.
const DOUBLINGS: usize = 10;
/// How often it is doubled more where an integral is still at work then, which leaves nothing however short the flight is beside
/// it: up to 10¹⁵ flights.
const MORE_DOUBLINGS: usize = 40;
/// Share of its largest effect that may be left of a load which counts as removed: a tenth, as a step has risen when a
/// tenth of it is missing.
pub const REMOVED: f64 = 0.1;
/// Share of its largest effect up to which a load counts as half gone. A flight may be short beside an integral that
/// works; one that has not taken off half within the flight that it was tuned on is no better than none there.
pub const HALF_GONE: f64 = 0.5;
/// Share of its largest effect that may be left for good of a load which counts as removed, where there is no integral:
/// a hundredth of [`REMOVED`], far above what rounding leaves of a load that goes on shrinking (below 10⁻⁶).
const FOR_GOOD: f64 = REMOVED / 100.0;

/// The pitch error that a constant load of one degree at the servo makes from the start of the flight on, around rest,
/// no limit at work; deg for a degree.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ConstantLoad {
    /// Largest size during the flight.
    pub largest: f64,
    /// Size at the end of the flight: at its last sample, or, where the error still swings, at the last peak of a swing.
    pub at_end: f64,
    /// Size a thousand flights later, or, of an integral that is still at work then, when it is next to nothing.
    pub for_good: f64,
    /// True for a loop with an integral.
    pub has_integral: bool,
    /// True where the integral's own limits leave it less than the load takes, beside what the end of the flight does.
    pub is_cut: bool,
}

impl ConstantLoad {
    /// What is left at the end of the flight, as a share of the largest effect; 0 for a load without effect.
    #[must_use]
    pub fn share_left(&self) -> f64 {
        if self.largest > 0.0 { self.at_end / self.largest } else { 0.0 }
    }

    /// True where at most [`REMOVED`] is left at the end and, without an integral, next to nothing for good.
    #[must_use]
    pub fn is_removed(&self) -> bool {
        // Written so that NaN is not removed.
        self.share_left() <= REMOVED && !self.stays()
    }

    /// True where at most [`HALF_GONE`] is left at the end and, without an integral, next to nothing for good: what a
    /// tuning asks by default.
    #[must_use]
    pub fn is_half_gone(&self) -> bool {
        // Written so that NaN is not half gone.
        self.share_left() <= HALF_GONE && !self.stays()
    }

    /// True where, without an integral or with one whose own limits do not leave it, something is left for good.
    #[must_use]
    pub fn stays(&self) -> bool {
        // Written so that NaN stays.
        (!self.has_integral || self.is_cut) && !(self.for_good <= FOR_GOOD * self.largest)
    }

    /// True where what is left at the end goes on shrinking to nothing.
    #[must_use]
    pub fn is_slow(&self) -> bool {
        !self.is_removed() && self.for_good <= FOR_GOOD * self.largest
    }
}

/// The effect of a constant load with the plant of the scenario on which most of it is left. The loop must be stable; none where
/// it grows by itself and outer loops hold it, for what a load does then is theirs to say.
///
/// # Errors
/// [`SimError`] where a plant cannot be discretised, an aircraft has no linear model, or a number overflows.
pub fn constant_load(
    scenario: &Scenario,
    gains: Gains<f64>,
    config: &PidConfig<f64>,
) -> Result<Option<ConstantLoad>, SimError> {
    scenario.plant.require_equations()?;
    let trimmed = scenario.plant.aircraft().map(AircraftPlant::linear).transpose()?;
    let lasting = scenario.lasting_plants().into_iter().map(|(_, plant)| plant);
    let mut worst: Option<ConstantLoad> = None;
    for plant in trimmed.iter().chain(lasting) {
        if scenario.autopilot.is_some() && !holds(scenario, plant, gains, config) {
            return Ok(None);
        }
        let load = with_plant(scenario, plant, gains, config)?;
        let held = HeldIntegral::at_the_end(scenario, plant, gains, config);
        let room = held.map_or(1.0, |it| it.room_rad().to_degrees());
        let load = match room < 1.0 {
            true => cut(scenario, plant, (gains, config), (load, 1.0 - room))?,
            false => load,
        };
        // Written so that NaN is the worst.
        if worst.is_none_or(|worst| !(load.share_left() <= worst.share_left())) {
            worst = Some(load);
        }
    }
    Ok(worst)
}

/// A load of which the integral cannot take a share: that is held without an integral, or not at all.
fn cut(
    scenario: &Scenario,
    plant: &LinearPlant,
    (gains, config): (Gains<f64>, &PidConfig<f64>),
    (load, share): (ConstantLoad, f64),
) -> Result<ConstantLoad, SimError> {
    let is_cut = true;
    let gains = Gains { ki: 0.0, ..gains };
    if !holds(scenario, plant, gains, config) {
        let largest = load.largest;
        return Ok(ConstantLoad { at_end: largest, for_good: largest, is_cut, ..load });
    }
    let left = with_plant(scenario, plant, gains, config)?;
    Ok(ConstantLoad {
        largest: load.largest.max(share * left.largest),
        at_end: load.at_end.max(share * left.at_end),
        for_good: load.for_good.max(share * left.for_good),
        is_cut,
        ..load
    })
}

fn with_plant(
    scenario: &Scenario,
    plant: &LinearPlant,
    gains: Gains<f64>,
    config: &PidConfig<f64>,
) -> Result<ConstantLoad, SimError> {
    let memory = Memory::of_gains(gains, config);
    let model = LoopModel::of(scenario, plant, config, memory)?.without_changing_ages();
    let one = loaded(&model, gains)?;
    let samples = scenario.timing.rows().saturating_sub(1).max(1);
    let points = samples.min(POINTS);
    let stretch = samples / points;
    // What is left over of whole stretches comes first, so that the last point is the end of the flight.
    let mut at = samples % points;
    let doubled = doubled(&one, at + stretch)?;
    let several = power(&doubled, stretch)?;
    let mut state = vec![0.0; model.size() + 1];
    let mut next = state.clone();
    if let Some(load) = state.last_mut() {
        *load = 1.0;
    }
    let mut largest = largest_before(at + stretch, &doubled, &state)?;
    power(&doubled, at)?.apply(&state.clone(), &mut state)?;
    let mut history: Vec<(usize, f64)> = Vec::new();
    for point in 1..=points {
        if point > EARLY_POINTS {
            history.extend(sizes_between(&one, &state, at, stretch)?);
        }
        several.apply(&state, &mut next)?;
        std::mem::swap(&mut state, &mut next);
        at += stretch;
        // The samples between the points, found another way, have other last bits.
        let here = size(&state);
        largest = if here <= largest { largest } else { here };
        history.push((at, here));
    }
    let at_end = left_at_end(&history);
    let flight = power(&self::doubled(&several, points)?, points)?;
    let for_good = left_for_good(flight, largest, memory.integral)?;
    // A largest that is NaN was never larger than the one before.
    if !(largest.is_finite() && at_end.is_finite() && for_good.is_finite()) {
        return Err(LtiError::OutOfRange { what: "share of a constant load" }.into());
    }
    Ok(ConstantLoad { largest, at_end, for_good, has_integral: memory.integral, is_cut: false })
}

/// The size of the error: the pitch angle is the plant's first state, and the set-point stays at zero.
fn size(state: &[f64]) -> f64 {
    state.first().copied().unwrap_or(0.0).abs()
}

/// The size of the error a thousand flights later, and where an integral is still at work then, when it is next to nothing.
fn left_for_good(mut flight: Matrix, largest: f64, has_integral: bool) -> Result<f64, LtiError> {
    let left_by = |flight: &Matrix| flight.get(0, flight.rows() - 1).unwrap_or(f64::NAN).abs();
    for _ in 0..DOUBLINGS {
        flight = flight.product(&flight)?;
    }
    let mut left = left_by(&flight);
    for _ in 0..MORE_DOUBLINGS {
        if !has_integral || left <= FOR_GOOD * largest {
            break;
        }
        flight = flight.product(&flight)?;
        let later = left_by(&flight);
        // On the edge of stability rounding makes it grow some time. Written so that NaN grows.
        if !(later <= left.max(largest)) {
            break;
        }
        left = later;
    }
    Ok(left)
}

/// The largest size of the error before a sample, by the samples 1, 2, 3, 4, 6, 8, 12 …: of a motion that rises and falls
/// once, however fast, the largest of them is at most a twentieth less than its peak.
fn largest_before(end: usize, doubled: &[Matrix], load: &[f64]) -> Result<f64, LtiError> {
    let (mut state, mut later) = (load.to_vec(), load.to_vec());
    let (mut at, mut largest) = (1, 0.0_f64);
    let mut half: Option<&Matrix> = None;
    for matrix in doubled {
        matrix.apply(load, &mut state)?;
        if at < end {
            largest = largest.max(size(&state));
        }
        if let Some(half) = half.filter(|_| at + at / 2 < end) {
            half.apply(&state, &mut later)?;
            largest = largest.max(size(&later));
        }
        at *= 2;
        half = Some(matrix);
    }
    Ok(largest)
}

/// The samples of a stretch but for its ends, with the size of the error at each.
fn sizes_between(
    one: &Matrix,
    state: &[f64],
    from: usize,
    stretch: usize,
) -> Result<Vec<(usize, f64)>, LtiError> {
    let (mut state, mut next) = (state.to_vec(), state.to_vec());
    let of_sample = |sample| {
        one.apply(&state, &mut next)?;
        std::mem::swap(&mut state, &mut next);
        Ok((sample, size(&state)))
    };
    (from + 1..from + stretch).map(of_sample).collect()
}

/// What is left at the end of a history of sizes: the last one, or the last peak where the error still swings. It does
/// where another peak could follow: the last is no farther from the end than from the peak before it.
fn left_at_end(history: &[(usize, f64)]) -> f64 {
    let peaks: Vec<(usize, f64)> = history
        .windows(3)
        .filter_map(|three| match three {
            [(_, before), peak, (_, after)] => {
                (*before < peak.1 && peak.1 >= *after).then_some(*peak)
            }
            _ => None,
        })
        .collect();
    let (end, last) = history.last().copied().unwrap_or((0, f64::NAN));
    match peaks.as_slice() {
        [.., (before, _), (at, size)] if end - at <= at - before && *size > last => *size,
        _ => last,
    }
}

/// The one-sample matrix of the closed loop with one more state: a load that stays, added to the arriving command.
fn loaded(model: &LoopModel<f64>, gains: Gains<f64>) -> Result<Matrix, LtiError> {
    let plant = model.plant();
    let width = plant.states + 1;
    let entry = |row: usize| match row < plant.states {
        true => plant.rows.get(row * width + plant.states).copied().unwrap_or(0.0),
        false => 0.0,
    };
    let mut rows = model.closed(gains);
    for (index, row) in rows.iter_mut().enumerate() {
        row.push(entry(index));
    }
    let mut load = vec![0.0; rows.len()];
    load.push(1.0);
    rows.push(load);
    Matrix::from_rows(&rows)
}

/// A matrix to the powers 1, 2, 4, 8 …, up to one.
fn doubled(matrix: &Matrix, up_to: usize) -> Result<Vec<Matrix>, LtiError> {
    let mut doubled = vec![matrix.clone()];
    while let Some(last) = doubled.last().filter(|_| up_to >> doubled.len() > 0) {
        doubled.push(last.product(last)?);
    }
    Ok(doubled)
}

/// A matrix to a whole power, from those that are [`doubled`] up to it.
fn power(doubled: &[Matrix], exponent: usize) -> Result<Matrix, LtiError> {
    let size = doubled.first().map_or(0, Matrix::rows);
    let mut result = Matrix::identity(size);
    for (place, factor) in doubled.iter().enumerate() {
        if exponent >> place & 1 == 1 {
            result = result.product(factor)?;
        }
    }
    Ok(result)
}

#[cfg(test)]
mod tests {
    use fspid_core::{Gains, PidConfig};

    use super::*;
    use crate::actuator::Actuator;
    use crate::controller::Controller;
    use crate::plant::{ElevatorSign, Plant};
    use crate::signal::Profile;
    use crate::stability::growth_at_rest;
    use crate::timing::Timing;

    const DT_S: f64 = 0.01;

    /// θ = 1/s of the elevator, without a servo.
    fn integrator(duration_s: f64) -> Scenario {
        let plant = LinearPlant::new(&[1.0], &[1.0, 0.0], ElevatorSign::NoseUpPositive);
        Scenario {
            name: String::new(),
            plant: Plant::Linear(plant.expect("a plant")),
            plant_changes: Vec::new(),
            actuator: Actuator::ideal(),
            timing: Timing::new(DT_S, duration_s).expect("a timing"),
            setpoint: Profile::new(0.0, crate::signal::Shape::Step { at_s: 0.0 }).expect("a step"),
            disturbances: Vec::new(),
            controllers: Vec::new(),
            externals: Vec::new(),
            surroundings: crate::Surroundings::default(),
            autopilot: None,
        }
    }

    fn asked(duration_s: f64, gains: Gains<f64>) -> ConstantLoad {
        let load = constant_load(&integrator(duration_s), gains, &PidConfig::sampled_every(DT_S));
        load.expect("no overflow").expect("a plant")
    }

    /// The pole of the loop is 1 - kp T: what a load leaves is (1 - (1 - kp T)^n) / kp.
    #[test]
    fn without_an_integral_a_load_leaves_its_size_over_the_gain() {
        let gains = Gains { kp: 2.0, ki: 0.0, kd: 0.0 };
        let load = asked(5.0, gains);
        let exact = (1.0 - libm::pow(1.0 - 2.0 * DT_S, 500.0)) / 2.0;
        assert!((load.at_end - exact).abs() < 1e-12, "{load:?} {exact}");
        assert!((load.for_good - 0.5).abs() < 1e-12 && !load.has_integral);
        assert!(!load.is_removed() && !load.is_half_gone() && !load.is_slow());
    }

    #[test]
    fn an_integral_removes_a_load_in_time_and_not_before() {
        let gains = Gains { kp: 2.0, ki: 0.2, kd: 0.0 };
        let (short, long) = (asked(5.0, gains), asked(60.0, gains));
        assert!(!short.is_removed() && short.is_slow(), "{short:?}");
        assert!(long.is_removed() && long.is_half_gone(), "{long:?}");
        assert!(short.for_good < 1e-6 && long.for_good < 1e-6);
    }

    /// The slow pole of the loop takes 10 000 s, so that some of it was left after a thousand flights of 3 s.
    #[test]
    fn an_integral_leaves_nothing_for_good_however_short_the_flight_is_beside_it() {
        for duration_s in [0.5, 3.0, 12.0, 60.0, 2000.0] {
            let load = asked(duration_s, Gains { kp: 2.0, ki: 2e-4, kd: 0.0 });
            assert!(load.for_good <= FOR_GOOD * load.largest && !load.stays(), "{load:?}");
            assert!(load.is_slow() && !load.is_removed(), "{load:?}");
        }
    }

    /// Its effect is over long before the first of 64 points of a long flight: what was largest of it there was what
    /// rounding left, which does not shrink, so that nothing was removed in the longest.
    #[test]
    fn a_load_that_is_removed_in_seconds_is_removed_in_flights_of_any_length() {
        for gains in [
            Gains { kp: 2.0, ki: 1.0, kd: 0.0 },
            Gains { kp: 20.0, ki: 80.0, kd: 0.0 },
            // Swings with a period of 0.6 s that are gone after 10 s.
            Gains { kp: 1.0, ki: 100.0, kd: 0.0 },
        ] {
            let each_sample = asked(0.6, gains).largest.max(asked(6.0, gains).largest);
            for duration_s in [20.0, 60.0, 200.0, 600.0, 2000.0, 6000.0, 50_000.0] {
                let load = asked(duration_s, gains);
                let share = load.largest / each_sample;
                assert!((0.9..1.0001).contains(&share), "{duration_s} {gains:?} {load:?}");
                assert!(load.is_removed() && load.share_left() < 0.01, "{duration_s} {load:?}");
            }
        }
    }

    #[test]
    fn a_peak_before_the_first_point_is_missed_by_a_twentieth_at_most() {
        // n r^n, whose peak is at -1 / ln r.
        for peak in 1..300 {
            let ratio = libm::exp(-1.0 / f64::from(peak));
            let rows =
                Matrix::from_rows(&[vec![ratio, ratio], vec![0.0, ratio]]).expect("a matrix");
            let found = doubled(&rows, 4000).expect("no overflow");
            let found = largest_before(4000, &found, &[0.0, 1.0]).expect("sizes that fit");
            let exact = f64::from(peak) * libm::exp(-1.0);
            assert!((0.95..1.0001).contains(&(found / exact)), "{peak} {found} {exact}");
        }
    }

    #[test]
    fn a_power_of_doubled_matrices_is_that_of_single_steps() {
        let rows = Matrix::from_rows(&[vec![0.5, 0.25], vec![0.0, 1.0]]).expect("a matrix");
        let mut expected = Matrix::identity(2);
        for exponent in 0..20 {
            let found = power(&doubled(&rows, exponent).expect("small"), exponent).expect("small");
            assert!(
                (found.get(0, 1).expect("there") - expected.get(0, 1).expect("there")).abs()
                    < 1e-15
            );
            expected = expected.product(&rows).expect("small");
        }
    }

    /// The error swings with a period of 6.3 s and a fiftieth of the damping: what was left used to be whatever the last
    /// sample was, next to nothing where a swing passes zero there.
    #[test]
    fn what_is_left_of_a_swing_does_not_depend_on_where_the_flight_ends() {
        for tenths in 0..32 {
            let load = asked(30.0 + f64::from(tenths) / 10.0, Gains { kp: 0.02, ki: 1.0, kd: 0.0 });
            assert!((0.6..0.8).contains(&load.share_left()), "{tenths} {load:?}");
            assert!(!load.is_removed() && load.is_slow());
        }
        // Swings faster than the points.
        let fast = Gains { kp: 0.02, ki: 900.0, kd: 0.0 };
        for samples in 0..10 {
            let load = asked(20.0 + DT_S * f64::from(samples), fast);
            assert!(load.share_left() > 0.5, "{samples} {load:?}");
        }
    }

    #[test]
    fn a_swing_that_is_over_leaves_what_is_there_at_the_end() {
        let sizes = [0.0, 1.0, 0.5, 0.0, 0.3, 0.2, 0.1, 0.05, 0.02, 0.01];
        let history: Vec<(usize, f64)> = sizes.into_iter().enumerate().collect();
        assert_eq!(left_at_end(&history), 0.01);
        assert_eq!(left_at_end(&history[..7]), 0.3);
        assert!(left_at_end(&[]).is_nan());
    }

    #[test]
    fn a_pole_on_the_circle_grows_nothing_and_one_outside_does() {
        let asked = |kp| {
            let gains = Gains { kp, ki: 0.0, kd: 0.0 };
            let pid = fspid_core::Pid::new(gains, PidConfig::sampled_every(DT_S)).expect("allowed");
            growth_at_rest(&integrator(5.0), &Controller::Fixed(pid), gains)
                .expect("eigenvalues")
                .certain
        };
        assert_eq!(asked(0.0), None);
        assert_eq!(asked(-1e-9), None);
        let grows = asked(-0.1).expect("the pole is 1.001");
        assert!(
            (grows.doubling_s - DT_S * libm::log(2.0) / libm::log(1.001)).abs() < 1e-9,
            "{grows:?}"
        );
    }
}
