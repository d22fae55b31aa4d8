//! Increments of the gains over cells of the supervisor's inputs, enclosed once for all scales.

use fspid_core::fuzzy::{Defuzzifier, OutOfRange, Supervisor};
use fspid_core::{SelfTuner, SetCentres};
use fspid_fuzzy::audit::Reach;
use fspid_fuzzy::system::{Parts, System};
use fspid_numeric::scalar::Interval;

use super::network::Net;
use super::numbers::Numbers;
use super::{EVERYWHERE, GainSet, NoBound, law};
use crate::solve::never;

/// How far the supervisor's own arithmetic may be off its centre of gravity, as a share of its
/// range: $2^{-40}$, which is $8192 \epsilon$ with $\epsilon = 2^{-53}$.
///
/// What is enclosed is the centre of gravity for all strengths that the rules can have, as
/// computed. Its closed form suffers less than $60 \epsilon$ in the area and $200 \epsilon$ in the
/// moment (in spacings, a third of the range), at an area of at least $\tfrac38$ because some rule
/// fires to one half: $400 \epsilon$ of the range. Corners of triangles that are rounded add
/// $500 \epsilon$; grades that are, where a cell is enclosed by its slopes, $300 \epsilon$. The
/// places of samples, with at least [`FEWEST_CELLS`] between them, would add $2000 \epsilon$.
pub(super) const ROUNDING: f64 = 1.0 / (1_u64 << 40) as f64;
/// What each sample of a sampled centroid adds to [`ROUNDING`]: two roundings of sums up to the
/// range.
const ROUNDING_PER_SAMPLE: f64 = 1.0 / (1_u64 << 50) as f64;
/// How far the moving of an input to the even sets may be off by rounding, as a share of the range: a dozen of them.
const MOVED: f64 = 64.0 * f64::EPSILON;
/// With so many cells between its samples, a sampled centroid meets every triangle at half its
/// height or above, so that its area is not small. With fewer, nothing is said but that it lies in
/// the range.
const FEWEST_CELLS: u32 = 12;

/// What the rules add to the gains, cell by cell, before the output factors.
#[derive(Clone, Debug, PartialEq)]
pub struct IncrementMap {
    /// Cells that together hold all inputs for which the supervisor has an answer.
    pub cells: Vec<IncrementCell>,
    /// At rest.
    pub(super) rest: [Interval; 3],
    pub(super) tuner: SelfTuner<f64>,
    /// Sample period, where it is known.
    pub(super) dt_s: Option<f64>,
}

/// Increments over a cell of the supervisor's inputs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct IncrementCell {
    /// Errors, in supervisor units; outermost cells reach to infinity unless inputs beyond the
    /// range are refused.
    pub error: [f64; 2],
    /// Changes of error, likewise.
    pub change: [f64; 2],
    /// Bounds of the increments of kp, ki and kd, in supervisor units.
    pub delta: [Interval; 3],
}

impl IncrementMap {
    /// Encloses the increments of a tuner over `divisions` cells along each input within the range.
    ///
    /// The boxes shrink in proportion to the cells; multiples of 12 put the centres of the sets and
    /// the places where neighbours cross on borders of cells. Where inputs beyond the range are
    /// evaluated as they are, four cells around all others say no more than where every answer
    /// lies.
    ///
    /// # Errors
    /// [`NoBound`] for an accumulating law that nothing holds back.
    pub fn of(tuner: &SelfTuner<f64>, divisions: usize) -> Result<Self, NoBound> {
        Self::until(tuner, divisions, never)
            .map(|map| map.unwrap_or_else(|| unreachable!("nobody stops it")))
    }

    /// As [`of`](Self::of), and nothing where `stops`, which is asked for each row of cells, says so.
    pub(crate) fn until(
        tuner: &SelfTuner<f64>,
        divisions: usize,
        stops: fn() -> bool,
    ) -> Result<Option<Self>, NoBound> {
        let parts = Parts::try_from(tuner.supervisor()).ok();
        let system = parts.and_then(|parts| System::new(parts).ok());
        let mut enclosure = Enclosure::new(tuner, system.as_ref());
        // The origin is in every dead zone, also in one without width.
        let rest = match tuner.settings().dead_zone {
            Some(_) => [Interval::ZERO; 3],
            None => enclosure.over([Side::point(0.0); 2]),
        };
        let scale = tuner.settings().input_scale;
        let sets = tuner.settings().input_sets;
        let along = |scale, centres| sides(tuner.supervisor(), divisions.max(1), scale, centres);
        let [errors, changes] =
            [along(scale.error_per_rad, sets.error), along(scale.change_per_rad, sets.change)];
        let mut cells = Vec::with_capacity(errors.len() * changes.len() + 4);
        for &error in &errors {
            if stops() {
                return Ok(None);
            }
            for &change in &changes {
                cells.push(enclosure.cell([error, change]));
            }
        }
        if tuner.supervisor().out_of_range() == OutOfRange::Evaluate
            && !is_level(tuner.supervisor())
        {
            let far = beyond([&errors, &changes]);
            cells.extend(far.into_iter().map(|sides| enclosure.far(sides)));
        }
        let map = Self { cells, rest, tuner: *tuner, dt_s: None };
        law::check(&map)?;
        Ok(Some(map))
    }

    /// The same of a controller with this sample period, s: of an accumulating law it is then known which combinations
    /// of gains it reaches.
    #[must_use]
    pub fn sampled_every(self, dt_s: f64) -> Self {
        Self { dt_s: Some(dt_s), ..self }
    }

    /// The gains for `output_factor` times the tuner's output factors.
    ///
    /// $$ k = k' + f s \Delta k, $$
    ///
    /// moved into the gain limits, for the memoryless law; for the accumulating law one box over
    /// all inputs. The factor is a finite number that is not negative; 1 for the tuner as it is.
    #[must_use]
    pub fn gains(&self, output_factor: f64) -> GainSet {
        law::gains(self, output_factor)
    }
}

/// A side of a cell.
#[derive(Clone, Copy, Debug)]
pub(super) struct Side {
    /// What the rules are asked for.
    pub(super) asked: Interval,
    /// The inputs that this stands for.
    pub(super) inputs: [f64; 2],
}

impl Side {
    pub(super) fn point(value: f64) -> Self {
        Self { asked: Interval::point(value), inputs: [value; 2] }
    }

    fn between(lower: f64, upper: f64) -> Self {
        Self { asked: Interval::between(lower, upper), inputs: [lower, upper] }
    }

    /// Inputs between two of the range, whose rules are asked where the tuner moves them to, which it does in order; its
    /// rounding is added.
    pub(super) fn seen(
        [lower, upper]: [f64; 2],
        range: f64,
        centres: Option<SetCentres<f64>>,
    ) -> Self {
        let Some(centres) = centres else { return Self::between(lower, upper) };
        let slack = Interval::between(-MOVED * range, MOVED * range);
        let [from, to] = [lower, upper].map(|input| centres.warp(input, range));
        let asked = Interval::between(from, to) + slack;
        let within = asked.intersection(Interval::between(-range, range));
        Self { asked: within.unwrap_or(asked), inputs: [lower, upper] }
    }
}

/// True where answers beyond the range are those at its border.
fn is_level(supervisor: &Supervisor<f64>) -> bool {
    supervisor.out_of_range() == OutOfRange::Clamp || !supervisor.has_labels()
}

/// Sides of the cells along an input: of even widths as the even sets see them. A side is told by its inputs.
fn sides(
    supervisor: &Supervisor<f64>,
    divisions: usize,
    scale: f64,
    centres: Option<SetCentres<f64>>,
) -> Vec<Side> {
    // Such an input is always zero.
    if scale == 0.0 {
        return vec![Side::point(0.0)];
    }
    let (range, count) = (supervisor.range(), divisions as f64);
    let at = |cell: usize| range * (2.0 * cell as f64 / count - 1.0);
    let side = |cell: usize| match centres {
        None => Side::between(at(cell), at(cell + 1)),
        Some(moved) => {
            let inputs = [cell, cell + 1].map(|cell| match cell {
                0 => -range,
                cell if cell == divisions => range,
                cell => moved_back(moved, at(cell), range),
            });
            Side::seen(inputs, range, centres)
        }
    };
    let mut sides: Vec<Side> = (0..divisions).map(side).collect();
    if is_level(supervisor) && supervisor.out_of_range() != OutOfRange::Error {
        if let Some(first) = sides.first_mut() {
            first.inputs[0] = f64::NEG_INFINITY;
        }
        if let Some(last) = sides.last_mut() {
            last.inputs[1] = f64::INFINITY;
        }
    }
    sides
}

/// The input that sets with these centres move to `even`, but for rounding.
fn moved_back(centres: SetCentres<f64>, even: f64, range: f64) -> f64 {
    let (small, medium) = (centres.small(), centres.medium());
    let thirds = 3.0 * even.abs() / range;
    let part = if thirds <= 1.0 {
        small * thirds
    } else if thirds <= 2.0 {
        small + (medium - small) * (thirds - 1.0)
    } else {
        medium + (1.0 - medium) * (thirds - 2.0)
    };
    if even < 0.0 { -part * range } else { part * range }
}

/// Four regions around all cells, as far as inputs can be there.
fn beyond([errors, changes]: [&[Side]; 2]) -> Vec<[[f64; 2]; 2]> {
    let ends = |sides: &[Side]| {
        let first = sides.first().map_or(0.0, |side| side.inputs[0]);
        [first, sides.last().map_or(0.0, |side| side.inputs[1])]
    };
    let [[left, right], [below, above]] = [ends(errors), ends(changes)];
    // An input that is always zero has nothing beyond.
    let moves = |lower: f64, upper: f64| lower < upper;
    let all_changes = if moves(below, above) { EVERYWHERE } else { [below, above] };
    let mut regions = Vec::new();
    if moves(left, right) {
        regions.push([[f64::NEG_INFINITY, left], all_changes]);
        regions.push([[right, f64::INFINITY], all_changes]);
    }
    if moves(below, above) {
        regions.push([[left, right], [f64::NEG_INFINITY, below]]);
        regions.push([[left, right], [above, f64::INFINITY]]);
    }
    regions
}

/// Encloses increments over cells.
pub(super) struct Enclosure<'a> {
    reach: Option<Reach<'a>>,
    /// Rules that conclude numbers.
    numbers: Option<Numbers<'a>>,
    /// A network in place of rules.
    net: Option<Net<'a>>,
    /// Where every answer of the supervisor lies.
    universe: Interval,
    slack: Interval,
    /// Half sides of the dead zone, as the supervisor sees it.
    zone: Option<[f64; 2]>,
}

impl<'a> Enclosure<'a> {
    pub(super) fn new(tuner: &'a SelfTuner<f64>, system: Option<&'a System>) -> Self {
        let supervisor = tuner.supervisor();
        let (range, rule) = (supervisor.range(), supervisor.defuzzifier());
        let samples = samples(rule);
        let net = supervisor.network().map(|network| Net { network, range });
        let of_rules = range * (ROUNDING + ROUNDING_PER_SAMPLE * f64::from(samples));
        let slack = net.map_or(of_rules, |net| net.slack());
        let has_labels = supervisor.has_labels();
        let reach = system.filter(|_| has_labels && is_dense(rule)).map(Reach::new);
        let slack = Interval::between(-slack, slack);
        let half = if has_labels { furthest(range, rule) } else { range };
        let universe = Interval::between(-half, half) + slack;
        let settings = tuner.settings();
        let zone = settings.dead_zone.map(|zone| {
            let scale = settings.input_scale;
            // As the tuner computes it; an input on the border becomes this very number.
            [scale.error_per_rad * zone.error_rad, scale.change_per_rad * zone.change_rad]
                .map(f64::abs)
        });
        let numbers = supervisor.numbers().map(|table| Numbers { table, range });
        Self { reach, numbers, net, universe, slack, zone }
    }

    fn cell(&mut self, sides: [Side; 2]) -> IncrementCell {
        let [error, change] = sides.map(|side| side.inputs);
        IncrementCell { error, change, delta: self.over(sides) }
    }

    /// A region of which nothing is known but where answers lie.
    fn far(&self, [error, change]: [[f64; 2]; 2]) -> IncrementCell {
        let delta = [self.universe; 3];
        IncrementCell { error, change, delta: self.silenced([error, change], delta) }
    }

    pub(super) fn over(&mut self, sides: [Side; 2]) -> [Interval; 3] {
        let asked = sides.map(|side| side.asked);
        let answers = self.reach.as_mut().map(|reach| reach.over(&asked));
        let known: Option<[Interval; 3]> = answers.and_then(|answers| answers.try_into().ok());
        let known = known.or_else(|| self.numbers.map(|numbers| numbers.over(asked)));
        let known = known.or_else(|| self.net.map(|net| net.over(asked)));
        let (slack, universe) = (self.slack, self.universe);
        let delta = known.map_or([universe; 3], |known| {
            known.map(|delta| (delta + slack).intersection(universe).unwrap_or(universe))
        });
        self.silenced(sides.map(|side| side.inputs), delta)
    }

    /// The increments with the dead zone, in which there are none.
    ///
    /// Let $x = \mathrm{fl}(s y)$ be what the supervisor sees of an input $y$, and
    /// $z = \mathrm{fl}(|s| d)$ the same of the zone's half side $d$. Rounding is monotone:
    /// $|y| \le d$ makes $|x| \le z$, and $|x| < z$ comes from $|y| \le d$ only.
    fn silenced(&self, inputs: [[f64; 2]; 2], delta: [Interval; 3]) -> [Interval; 3] {
        let Some(zone) = self.zone else { return delta };
        let mut sides = inputs.into_iter().zip(zone);
        let inside = |([lower, upper], zone): ([f64; 2], f64)| lower > -zone && upper < zone;
        if sides.clone().all(inside) {
            return [Interval::ZERO; 3];
        }
        let meets = |([lower, upper], zone): ([f64; 2], f64)| lower <= zone && upper >= -zone;
        if sides.all(meets) { delta.map(|delta| delta.hull(Interval::ZERO)) } else { delta }
    }
}

/// The largest magnitude of any answer.
///
/// A centre of gravity lies where its set does. Without samples it is no further out than that of
/// the outermost triangle, 8/3 spacings. For let the universe end at 3, and the union be cut into
/// its level sets: at height $h$ the outermost triangle contributes $[2 + h, 3]$, and all others
/// only what is below $2 + h$ and below $3 - h$, hence below 8/3. The former's moment about 8/3, up
/// to the strength $s$, is
///
/// $$ \int_0^s \left( \tfrac{h}{2} - \tfrac16 \right) (1 - h) \ dh = -\tfrac{s}{6} (1 - s)^2 \le 0 $$
fn furthest(range: f64, rule: Defuzzifier) -> f64 {
    if rule == Defuzzifier::Exact {
        let spacing = Interval::point(range) / Interval::point(3.0);
        (spacing * (Interval::point(8.0) / Interval::point(3.0))).upper()
    } else {
        range
    }
}

/// How many samples a centroid is computed of.
fn samples(rule: Defuzzifier) -> u32 {
    match rule {
        Defuzzifier::Exact => 0,
        Defuzzifier::Endpoints(samples)
        | Defuzzifier::Midpoint(samples)
        | Defuzzifier::Trapezoid(samples)
        | Defuzzifier::LeftEnd(samples)
        | Defuzzifier::Vertices(samples) => samples,
    }
}

/// True if the error of the computed centroid is known.
pub(super) fn is_dense(rule: Defuzzifier) -> bool {
    let cells = match rule {
        Defuzzifier::Exact => return true,
        Defuzzifier::Endpoints(samples) | Defuzzifier::Trapezoid(samples) => {
            samples.saturating_sub(1)
        }
        Defuzzifier::Midpoint(samples) | Defuzzifier::LeftEnd(samples) => samples,
        Defuzzifier::Vertices(_) => return false,
    };
    cells >= FEWEST_CELLS
}
