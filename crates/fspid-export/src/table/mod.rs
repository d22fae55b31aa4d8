//! The surface of a supervisor as a table, with a bound of what that costs.
//!
//! Three outputs over a square grid of both inputs, bilinear in between, in numbers of 32 bits or in steps of 16 bits. The
//! bound is of the arithmetic that is written, against the centre of gravity itself, in real numbers, for every input.

mod bound;

use fspid_core::fuzzy::{Defuzzifier, OutOfRange, Supervisor};
use fspid_core::{Controller, SelfTuner};

use crate::compose::Refusal;
use crate::vectors::Draw;

/// Points along an input if nothing is said: 6m + 1, so that the centres of the sets are among them.
pub const POINTS: usize = 49;
/// Most points along an input: 200 KB of 32 bits.
const MOST_POINTS: usize = 127;
/// Inputs that the measured difference is of.
const MEASURED: usize = 100_000;
/// Half a unit in the last place of 32 bits, relative.
const UNIT: f64 = 1.0 / (1_u64 << 24) as f64;

/// How far a table is off.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Deviation {
    /// At most, for every input: proved.
    pub proved: f64,
    /// At most of the inputs that were drawn.
    pub seen: f64,
    /// Root of the mean square of those.
    pub rms: f64,
}

/// True for rules that conclude labels whose centre of gravity is sampled: the proof of a bound then takes minutes.
#[must_use]
pub fn is_sampled(controller: &Controller<f64>) -> bool {
    let Controller::SelfTuning(fspid) = controller else { return false };
    let supervisor = fspid.tuner().supervisor();
    supervisor.has_labels() && supervisor.defuzzifier() != Defuzzifier::Exact
}

/// A supervisor's three outputs over a grid of its inputs.
#[derive(Clone, Debug, PartialEq)]
pub struct SurfaceTable {
    /// Half range of both inputs.
    pub range: f32,
    /// Points along each input.
    pub points: usize,
    /// What happens to an input beyond the range: it is moved to its end, or refused.
    pub clamps: bool,
    /// Outputs at each point, row by row: an error, and its changes from the least on.
    pub values: Vec<[f32; 3]>,
    /// The same in steps.
    pub steps: Vec<[i16; 3]>,
    /// What a step is of each output.
    pub scales: [f32; 3],
    /// How far the table of 32 bits is off, output by output.
    pub single: [Deviation; 3],
    /// How far the table of 16 bits is off.
    pub short: [Deviation; 3],
    /// Boxes that the proof has looked at.
    pub boxes: u64,
}

/// Where an input lies in the table: the point before it, and how far it is on the way to the next.
type Place = (usize, f32);

impl SurfaceTable {
    /// The table of a tuner's rules, whose settings are of 32 bits.
    ///
    /// # Errors
    /// [`Refusal`] for a number of points that would miss centres of sets, and for rules that are evaluated beyond the range.
    pub fn of(tuner: &SelfTuner<f64>, points: usize) -> Result<Self, Refusal> {
        if points % 6 != 1 || !(7..=MOST_POINTS).contains(&points) {
            return Err(Refusal::Points { found: points });
        }
        let supervisor = tuner.supervisor();
        if supervisor.network().is_some() {
            return Err(Refusal::Network);
        }
        let has_labels = supervisor.has_labels();
        let policy = supervisor.out_of_range();
        if has_labels && policy == OutOfRange::Evaluate {
            return Err(Refusal::BeyondRange);
        }
        let range = single(supervisor.range());
        let values = sampled(supervisor, points);
        let scales = [0, 1, 2].map(|output: usize| scale(&values, output));
        let step = |value: &[f32; 3]| [0, 1, 2].map(|k: usize| quantised(value[k], scales[k]));
        let steps = values.iter().map(step).collect();
        let clamps = policy != OutOfRange::Error;
        let [single, short] = [[Deviation::default(); 3]; 2];
        let mut table =
            Self { range, points, clamps, values, steps, scales, single, short, boxes: 0 };
        table.prove(supervisor);
        table.measure(supervisor);
        Ok(table)
    }

    /// Outputs by the table of 32 bits; nothing for an input that is refused.
    #[must_use]
    pub fn single(&self, error: f32, change: f32) -> Option<[f32; 3]> {
        let (row, column) = (self.place(error)?, self.place(change)?);
        Some([0, 1, 2].map(|k: usize| self.between(row, column, |at| self.values[at][k])))
    }

    /// Outputs by the table of 16 bits.
    #[must_use]
    pub fn short(&self, error: f32, change: f32) -> Option<[f32; 3]> {
        let (row, column) = (self.place(error)?, self.place(change)?);
        let of = |k: usize| self.between(row, column, |at| f32::from(self.steps[at][k]));
        Some([0, 1, 2].map(|k| of(k) * self.scales[k]))
    }

    /// Points per unit of an input.
    #[must_use]
    pub fn per_unit(&self) -> f32 {
        single((self.points - 1) as f64 / (2.0 * f64::from(self.range)))
    }

    #[allow(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a place is from 0 to the number of points"
    )]
    fn place(&self, input: f32) -> Option<Place> {
        let largest = if self.clamps { f32::MAX } else { self.range };
        if !(input >= -largest && input <= largest) {
            return None;
        }
        let inside = input.clamp(-self.range, self.range);
        let at = (inside + self.range) * self.per_unit();
        let point = (at as usize).min(self.points - 2);
        let part = at - point as f32;
        Some((point, if part > 1.0 { 1.0 } else { part }))
    }

    fn between(&self, row: Place, column: Place, value: impl Fn(usize) -> f32) -> f32 {
        let at = row.0 * self.points + column.0;
        let along = |from: usize| {
            let (first, second) = (value(from), value(from + 1));
            first + (second - first) * column.1
        };
        let (first, second) = (along(at), along(at + self.points));
        first + (second - first) * row.1
    }

    fn prove(&mut self, supervisor: &Supervisor<f64>) {
        let found = bound::of(self, supervisor);
        self.boxes = found.boxes;
        for k in 0..3 {
            let rounding = self.rounding(k);
            self.single[k].proved = found.bounds[k] + rounding;
            // Between points an interpolation is no further off than at the worse of them.
            let off = |(value, step): (&[f32; 3], &[i16; 3])| {
                (f64::from(value[k]) - f64::from(step[k]) * f64::from(self.scales[k])).abs()
            };
            let quantised = self.values.iter().zip(&self.steps).map(off).fold(0.0, f64::max);
            self.short[k].proved = found.bounds[k] + quantised * (1.0 + 4.0 * UNIT) + rounding;
        }
    }

    /// What the arithmetic of 32 bits may add.
    ///
    /// Let $u = 2^{-24}$, V the largest value and D the largest difference of neighbours. The place of an input is the
    /// rounded product of a rounded sum and a rounded constant, off by less than $4 u N$ points, each worth D along its
    /// input: $8 u N D$ for both. Each of the three interpolations rounds a difference (of at most 2V), a product and a sum,
    /// $5 u V$, and the outer one takes the difference of two that are off by that: $20 u V$, with a last product by the
    /// step's size $21 u V$. A fused product and sum rounds less often. What underflows adds less than the smallest normal
    /// number.
    fn rounding(&self, output: usize) -> f64 {
        let value = |at: usize| f64::from(self.values[at][output]);
        let step = f64::from(self.scales[output]);
        let largest = (0..self.values.len()).map(|at| value(at).abs()).fold(step, f64::max) + step;
        let mut steepest = 0.0_f64;
        for at in 0..self.values.len() {
            let is_last = at % self.points == self.points - 1;
            let right = if is_last { 0.0 } else { value(at + 1) - value(at) };
            let below = at + self.points;
            let down = if below < self.values.len() { value(below) - value(at) } else { 0.0 };
            steepest = steepest.max(right.abs()).max(down.abs());
        }
        // A step more at each end, for the table of 16 bits.
        steepest += 2.0 * step;
        let points = self.points as f64;
        UNIT * (32.0 * largest + 8.0 * points * steepest) + f64::from(f32::MIN_POSITIVE)
    }

    fn measure(&mut self, supervisor: &Supervisor<f64>) {
        let mut draw = Draw(1);
        for _ in 0..MEASURED {
            let [error, change] = [(); 2].map(|()| single(draw.around(f64::from(self.range))));
            let exact = infer(supervisor, f64::from(error), f64::from(change));
            let answers = [self.single(error, change), self.short(error, change)];
            for (kind, answer) in [&mut self.single, &mut self.short].into_iter().zip(answers) {
                for ((kind, answer), exact) in
                    kind.iter_mut().zip(answer.unwrap_or_default()).zip(exact)
                {
                    let off = (f64::from(answer) - exact).abs();
                    kind.seen = kind.seen.max(off);
                    kind.rms += off * off;
                }
            }
        }
        for kind in self.single.iter_mut().chain(&mut self.short) {
            kind.rms = libm::sqrt(kind.rms / MEASURED as f64);
        }
    }
}

/// The supervisor's three outputs within its range.
pub(crate) fn infer(supervisor: &Supervisor<f64>, error: f64, change: f64) -> [f64; 3] {
    let range = supervisor.range();
    let inside = |input: f64| input.clamp(-range, range);
    // Within the range there always is an answer.
    let answer = supervisor.infer(inside(error), inside(change)).map(|answer| answer.delta);
    answer.map_or([f64::NAN; 3], |delta| [delta.kp, delta.ki, delta.kd])
}

#[allow(clippy::cast_possible_truncation, reason = "rounding to the nearest f32 is meant")]
pub(crate) fn single(value: f64) -> f32 {
    value as f32
}

fn sampled(supervisor: &Supervisor<f64>, points: usize) -> Vec<[f32; 3]> {
    let range = supervisor.range();
    let at = |point: usize| range * (2.0 * point as f64 / (points - 1) as f64 - 1.0);
    let of = |error: usize, change: usize| infer(supervisor, at(error), at(change)).map(single);
    (0..points * points).map(|k| of(k / points, k % points)).collect()
}

/// The size of a step of 16 bits with which all values of an output can be written.
fn scale(values: &[[f32; 3]], output: usize) -> f32 {
    let largest = values.iter().map(|value| value[output].abs()).fold(0.0, f32::max);
    let step = (largest / f32::from(i16::MAX)).next_up();
    if largest > 0.0 { step } else { 1.0 }
}

#[allow(clippy::cast_possible_truncation, reason = "no value is larger than the largest step")]
fn quantised(value: f32, scale: f32) -> i16 {
    libm::round(f64::from(value) / f64::from(scale)) as i16
}
