//! Bounds on the slopes of the gain increments with respect to the supervisor's inputs.

use fspid_core::fuzzy::OutOfRange;
use fspid_core::{Law, SelfTuner, SetCentres};
use fspid_fuzzy::audit::{SurfaceOptions, slopes};
use fspid_fuzzy::system::{Parts, System};
use fspid_numeric::scalar::Interval;

use super::increments::is_dense;
use super::network::Net;
use super::numbers::Numbers;

/// Bounds may be so far apart. Increments and inputs are in the same unit, and slopes of some 1 to 3.
const TOLERANCE: f64 = 0.1;
/// Most boxes for each bound.
const BOXES: u64 = 3000;
/// What differences of increments may be off by that are computed of slopes, as a share of the range:
/// $2^{-21}$.
///
/// The supervisor's own arithmetic is off by less than $2^{-38}$ of the range, see
/// [`IncrementMap`](super::IncrementMap). Slopes leave out strips of $10^{-12}$ of the distances in
/// question, which here are five ranges at most, along fifty-two lines, on each of which thirteen ties
/// meet. Slopes inside them are those of a centre of gravity whose area is 3/8 of a spacing at least:
/// of seven levels each moves it by no more than 32 spacings, and 1.43 per spacing is the steepest slope
/// of a grade, which makes 320. Together that is $10^{-7}$ of the range.
const OFF: f64 = 1.0 / (1_u64 << 21) as f64;

/// Rounding of the moving of an input.
const MOVED: f64 = 64.0 * f64::EPSILON;

/// Slopes of the increments of kp, ki and kd, in supervisor units.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IncrementSlopes {
    /// Along error and change, of each gain.
    pub slopes: [[Interval; 2]; 3],
    /// What a difference of two increments may be off by.
    pub off: f64,
}

/// Why nothing is said of slopes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum NoSlopes {
    /// The gains are not a function of the inputs of the moment.
    #[error("gains that remember have no slopes over the supervisor's inputs")]
    Remembered,
    /// Gains jump where the dead zone ends.
    #[error("at the border of the dead zone the gains jump")]
    DeadZone,
    /// Inputs may leave the range, where the surface is not known.
    #[error("beyond the supervisor's range nothing is known of slopes")]
    BeyondRange,
    /// The gains are tied to something else than error and its change.
    #[error("beside the error the supervisor sees something else than its change")]
    OtherInput,
    /// No bounds were found.
    #[error("the slopes of the supervisor's surface have no bounds")]
    Unbounded,
}

impl IncrementSlopes {
    /// The slopes of a memoryless tuner where error and change are, in magnitude, no larger than `within`,
    /// in supervisor units.
    ///
    /// With them $\Delta k(x^+) - \Delta k(x) = g \cdot (x^+ - x)$ up to [`off`](Self::off), for some g
    /// between the bounds. Inputs that are moved to the range move by no more than they did.
    ///
    /// # Errors
    /// [`NoSlopes`].
    pub fn of(tuner: &SelfTuner<f64>, within: [f64; 2]) -> Result<Self, NoSlopes> {
        let settings = tuner.settings();
        if settings.law != Law::Memoryless {
            return Err(NoSlopes::Remembered);
        }
        Self::of_surface(tuner, within)
    }

    /// The slopes of what the rules answer, whatever the law makes of it.
    pub(crate) fn of_surface(tuner: &SelfTuner<f64>, within: [f64; 2]) -> Result<Self, NoSlopes> {
        let settings = tuner.settings();
        if settings.dead_zone.is_some() {
            return Err(NoSlopes::DeadZone);
        }
        let supervisor = tuner.supervisor();
        let range = supervisor.range();
        let inside = |side: &f64| *side >= 0.0 && *side <= range;
        let clamps = supervisor.out_of_range() == OutOfRange::Clamp;
        if !clamps && !within.iter().all(inside) {
            return Err(NoSlopes::BeyondRange);
        }
        let sets = [settings.input_sets.error, settings.input_sets.change];
        if let Some(table) = supervisor.numbers() {
            let slopes = moved(Numbers { table, range }.slopes(), sets);
            return Ok(Self { slopes, off: OFF * range });
        }
        if let Some(network) = supervisor.network() {
            let net = Net { network, range };
            let slopes = level_beyond(net.slopes(within), within.each_ref().map(inside));
            return Ok(Self { slopes, off: 2.0 * net.slack() });
        }
        if !is_dense(supervisor.defuzzifier()) {
            return Err(NoSlopes::Unbounded);
        }
        let even = |side: f64, centres: Option<SetCentres<f64>>| {
            centres.map_or(side, |centres| (centres.warp(side, range) * (1.0 + MOVED)).min(range))
        };
        let parts = Parts::try_from(supervisor).map_err(|_| NoSlopes::Unbounded)?;
        let system = System::new(parts).map_err(|_| NoSlopes::Unbounded)?;
        let sides = [even(within[0].min(range), sets[0]), even(within[1].min(range), sets[1])];
        let domain = sides.map(|side| if inside(&side) { [-side, side] } else { [-range, range] });
        let options = SurfaceOptions {
            domain: Some(domain.to_vec()),
            slope_tolerance: TOLERANCE,
            boxes: BOXES,
            ..SurfaceOptions::default()
        };
        let found = slopes(&system, &options).map_err(|_| NoSlopes::Unbounded)?;
        let mut bounds = [[Interval::ENTIRE; 2]; 3];
        for (bounds, found) in bounds.iter_mut().zip(&found) {
            for (bound, found) in bounds.iter_mut().zip(found) {
                let [least, most] = [found[0].bounds[0], found[1].bounds[1]];
                *bound = Interval::new(least, most).unwrap_or(Interval::ENTIRE);
            }
        }
        let bounds = level_beyond(bounds, within.each_ref().map(inside));
        let known = bounds.iter().flatten().all(|bound| bound.is_bounded());
        let slopes = Self { slopes: moved(bounds, sets), off: OFF * range };
        known.then_some(slopes).ok_or(NoSlopes::Unbounded)
    }
}

/// Slopes with those beyond the range, where increments are level; `inside` tells of which inputs nothing is beyond it.
fn level_beyond(mut slopes: [[Interval; 2]; 3], inside: [bool; 2]) -> [[Interval; 2]; 3] {
    for slopes in &mut slopes {
        for (slope, _) in slopes.iter_mut().zip(inside).filter(|(_, inside)| !inside) {
            *slope = slope.hull(Interval::ZERO);
        }
    }
    slopes
}

/// Slopes over inputs that the tuner moves to even sets first: those over the even ones times those of the moving, of
/// which each third of the range has one.
fn moved(slopes: [[Interval; 2]; 3], sets: [Option<SetCentres<f64>>; 2]) -> [[Interval; 2]; 3] {
    let moving = sets.map(|centres| {
        centres.map_or(Interval::ONE, |centres| {
            let [small, medium] = [centres.small(), centres.medium()].map(Interval::point);
            let third = Interval::ONE / Interval::point(3.0);
            let parts = [small, medium - small, Interval::ONE - medium];
            let [one, other, last] = parts.map(|part| third / part);
            one.hull(other).hull(last)
        })
    });
    slopes.map(|[by_error, by_change]| [by_error * moving[0], by_change * moving[1]])
}
