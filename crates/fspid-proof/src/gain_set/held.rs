//! Varying gains times a constant: bounds on how the part of the command that holds the set-point varies with the gains.
//!
//! At rest with a constant set-point the command holds the plant, and a constant part of it is multiplied by
//! a gain: $A k_p + C k_i$, with A and C within bounds. Off rest that part moves with the gains, by
//!
//! $$ w = A (k_p(x) - k_p(0)) + C (k_i(x) - k_i(0)) $$
//!
//! with the supervisor's inputs x = (error, change). Here it is written as $w = g_e x_e + g_c x_c$ plus a
//! remainder, with bounds of both factors over each cell: as secants of what the gains are bounded by
//! there, or by the proved slopes between rest and the cell.

use core::cell::OnceCell;
use std::rc::Rc;

use fspid_core::fuzzy::OutOfRange;
use fspid_core::{Change, Fspid, Law, SecondInput, SelfTuner};
use fspid_numeric::scalar::Interval;

use crate::remembered::Remembered;

use super::slopes::{IncrementSlopes, NoSlopes};
use super::{GainCell, GainSet};

/// Sides of the squares around rest over which slopes are bounded, as shares of the range.
const SQUARES: [f64; 3] = [0.25, 0.5, 1.0];
/// Inputs are computed with a rounding or two: secants are taken over so much less of a distance.
const ROUNDED: f64 = 1.0 - 1e-12;

/// Largest magnitudes of the constants that a gain multiplies, rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct HeldCommand {
    /// A, beside kp.
    pub(crate) by_kp: f64,
    /// C, beside ki: rad per unit of ki.
    pub(crate) by_ki: f64,
    /// Rest is at the origin of the supervisor's inputs.
    pub(crate) at_origin: bool,
}

impl HeldCommand {
    /// Nothing is held.
    pub(crate) const NONE: Self = Self { by_kp: 0.0, by_ki: 0.0, at_origin: true };

    pub(crate) fn is_none(self) -> bool {
        self.by_kp == 0.0 && self.by_ki == 0.0
    }
}

/// Slopes of the held command within a square around rest, rad per supervisor unit, along error and change.
struct Square {
    side: f64,
    slopes: [f64; 2],
}

/// Sides of squares with the slopes there, or why there are none.
type Squares = Result<Vec<(f64, IncrementSlopes)>, NoSlopes>;

/// Proved slopes of a tuner's increments within squares around rest, smallest first. They depend neither on
/// what is held nor on the output scale, and take longer than all else here: found once, they serve again, in every
/// clone.
#[derive(Clone, Debug, Default)]
pub(crate) struct KnownSlopes(Rc<OnceCell<Squares>>);

impl KnownSlopes {
    fn of(&self, tuner: &SelfTuner<f64>) -> Result<&[(f64, IncrementSlopes)], NoSlopes> {
        let range = tuner.supervisor().range();
        let found = self.0.get_or_init(|| {
            let square = |share: f64| {
                let side = share * range;
                IncrementSlopes::of(tuner, [side; 2]).map(|slopes| (side, slopes))
            };
            SQUARES.into_iter().map(square).collect()
        });
        found.as_deref().map_err(|reason| *reason)
    }
}

impl GainSet {
    /// The set with what a held command adds: the gain on the error stands with kp, that on the change
    /// beside the gains. With it the most that remains of the held command, rad.
    ///
    /// # Errors
    /// [`NoSlopes`] where nothing bounds what the gains make of a held command.
    pub(crate) fn holding(
        &self,
        fspid: &Fspid<f64>,
        factor: f64,
        held: HeldCommand,
        known: &KnownSlopes,
    ) -> Result<(Self, f64), NoSlopes> {
        if held.is_none() {
            return Ok((self.clone(), 0.0));
        }
        if fspid.tuner().settings().law != Law::Memoryless {
            let remembered = Some(Remembered::of(self, fspid, factor, held)?);
            return Ok((Self { remembered, ..self.clone() }, 0.0));
        }
        // A second input that is not in the loop's state has no gain there.
        if fspid.tuner().settings().second_input != SecondInput::Change {
            return Err(NoSlopes::OtherInput);
        }
        let over = Held::of(self, fspid, factor, held, known)?;
        let mut set = self.clone();
        let mut remains = 0.0_f64;
        for cell in &mut set.cells {
            let (factors, remainder) = over.cell(cell).ok_or(NoSlopes::Unbounded)?;
            let [by_error, by_change] = over.in_the_loop(factors);
            cell.gains[0] = cell.gains[0] + Interval::between(-by_error, by_error);
            cell.change_gain = by_change;
            remains = remains.max(remainder);
        }
        Ok((set, remains))
    }
}

/// A held command over the supervisor's inputs.
struct Held<'a> {
    fspid: &'a Fspid<f64>,
    held: HeldCommand,
    rest: [Interval; 3],
    squares: Vec<Square>,
    /// What slopes leave of the held command, rad.
    off_rad: f64,
    /// What slopes within the range and secants beyond it say of all inputs.
    anywhere: Option<[f64; 2]>,
    /// Half sides of the dead zone, supervisor units; infinite along an input that is always 0.
    zone: Option<[f64; 2]>,
}

impl<'a> Held<'a> {
    fn of(
        set: &GainSet,
        fspid: &'a Fspid<f64>,
        factor: f64,
        held: HeldCommand,
        known: &KnownSlopes,
    ) -> Result<Self, NoSlopes> {
        let tuner = fspid.tuner();
        let settings = tuner.settings();
        let range = tuner.supervisor().range();
        let scale = settings.input_scale;
        let zone = settings.dead_zone.map(|zone| {
            let side = |scale: f64, side: f64| {
                if scale == 0.0 { f64::INFINITY } else { (scale * side).abs() }
            };
            [side(scale.error_per_rad, zone.error_rad), side(scale.change_per_rad, zone.change_rad)]
        });
        let mut over = Self {
            fspid,
            held,
            rest: set.rest,
            squares: Vec::new(),
            off_rad: 0.0,
            anywhere: None,
            zone,
        };
        if zone.is_some() {
            // Gains jump where it ends: secants alone.
            return if held.at_origin { Ok(over) } else { Err(NoSlopes::DeadZone) };
        }
        let clamps = tuner.supervisor().out_of_range() == OutOfRange::Clamp;
        if !held.at_origin && !clamps {
            return Err(NoSlopes::BeyondRange);
        }
        over.bound_slopes(factor, known.of(tuner)?);
        let by_slopes = over.squares.last().map_or([f64::INFINITY; 2], |square| square.slopes);
        let whole = set.cells.iter().map(|cell| over.moved(cell)).fold(0.0, f64::max);
        let secant = up(Interval::point(whole) / Interval::point(ROUNDED * range));
        // Beyond the range the surface is level, or nothing is known of its slopes.
        let anywhere = by_slopes.map(|slope| if clamps { slope } else { slope.max(secant) });
        over.anywhere = Some(anywhere);
        Ok(over)
    }

    fn bound_slopes(&mut self, factor: f64, known: &[(f64, IncrementSlopes)]) {
        let scale = self.fspid.tuner().settings().output_scale;
        let by = |constant: f64, scale: f64| {
            Interval::point(constant) * Interval::point(factor) * Interval::point(scale.abs())
        };
        let [by_kp, by_ki] = [by(self.held.by_kp, scale.kp), by(self.held.by_ki, scale.ki)];
        // Where rest is elsewhere, only slopes over the whole range lie between it and any input.
        let skipped = if self.held.at_origin { 0 } else { known.len().saturating_sub(1) };
        for (side, known) in known.iter().skip(skipped) {
            let along = |input: usize| {
                let [kp, ki] = [0, 1].map(|gain: usize| known.slopes[gain][input].magnitude());
                up(by_kp * Interval::point(kp) + by_ki * Interval::point(ki))
            };
            self.squares.push(Square { side: *side, slopes: [along(0), along(1)] });
            self.off_rad = self.off_rad.max(up((by_kp + by_ki) * Interval::point(known.off)));
        }
    }

    /// How far the held command may be from rest over a cell, rad.
    fn moved(&self, cell: &GainCell) -> f64 {
        let [kp, ki] = [0, 1].map(|gain: usize| (cell.gains[gain] - self.rest[gain]).magnitude());
        let [by_kp, by_ki] = [self.held.by_kp, self.held.by_ki].map(Interval::point);
        up(by_kp * Interval::point(kp) + by_ki * Interval::point(ki))
    }

    /// Bounds of both factors over a cell, and what remains of the held command, rad.
    ///
    /// Each candidate holds for every input of the cell; the one with the smallest effect in the loop is taken.
    fn cell(&self, cell: &GainCell) -> Option<([f64; 2], f64)> {
        let moved = self.moved(cell);
        let secant = |side: f64| up(Interval::point(moved) / Interval::point(ROUNDED * side));
        let mut candidates = Vec::new();
        if self.held.at_origin {
            let [error, change] = [nearest(cell.error), nearest(cell.change)];
            if moved == 0.0 {
                candidates.push(([0.0; 2], 0.0));
            }
            if error > 0.0 {
                candidates.push(([secant(error), 0.0], 0.0));
            }
            if change > 0.0 {
                candidates.push(([0.0, secant(change)], 0.0));
            }
            // In the zone nothing moves; beyond it, one of the inputs is beyond its side.
            if let Some([error, change]) = self.zone.filter(|zone| zone.iter().all(|s| *s > 0.0)) {
                candidates.push(([secant(error), secant(change)], 0.0));
            }
        }
        let furthest = furthest(cell.error).max(furthest(cell.change));
        let within = self.squares.iter().find(|square| furthest <= square.side);
        let slopes = within.map(|square| square.slopes).or(self.anywhere);
        candidates.extend(slopes.map(|slopes| (slopes, self.off_rad)));
        let size = |factors: [f64; 2]| {
            let [by_error, by_change] = self.in_the_loop(factors);
            by_error + by_change
        };
        candidates.into_iter().min_by(|one, other| size(one.0).total_cmp(&size(other.0)))
    }

    /// Factors per supervisor unit as gains on the error and on its change in a sample.
    fn in_the_loop(&self, [by_error, by_change]: [f64; 2]) -> [f64; 2] {
        let [error, change] = units(self.fspid);
        [up(Interval::point(by_error) * error), up(Interval::point(by_change) * change)]
    }
}

/// Supervisor units per rad of error and per rad of change in a sample, without a sign.
fn units(fspid: &Fspid<f64>) -> [Interval; 2] {
    let settings = fspid.tuner().settings();
    let time_s = match settings.change {
        Change::Rate => Interval::point(fspid.config().dt_s),
        Change::Delta => Interval::ONE,
    };
    let scale = settings.input_scale;
    [
        Interval::point(scale.error_per_rad.abs()),
        Interval::point(scale.change_per_rad.abs()) / time_s,
    ]
}

fn up(value: Interval) -> f64 {
    value.upper()
}

/// The smallest magnitude in a side.
fn nearest([lower, upper]: [f64; 2]) -> f64 {
    lower.max(-upper).max(0.0)
}

/// The largest magnitude in a side.
fn furthest([lower, upper]: [f64; 2]) -> f64 {
    (-lower).max(upper)
}
