//! Straight lines along what a supervisor answers over a box, and how far the answer is from them.
//!
//! $$ \Delta k(e, x) = m_e e + m_x x + \rho, \qquad \rho \in R $$
//!
//! **Rules that conclude numbers.** Between the centres of neighbouring sets the answer is linear along either input, so that
//! with its lines taken away it is largest and smallest where a border of the box or a centre meets another. The lines go
//! through the ends of the box, so that R shrinks with the square of the box where no centre is inside, and with the box where
//! one is.
//!
//! **A network.** Its lines have the middle of the slopes that it has anywhere in the box; what is left is what it answers in
//! the middle and how much the slopes differ on the way from there (mean value theorem), which shrinks with the square of the
//! box. Where a box is so wide that what it answers anywhere is less, the line is level.

use fspid_core::{SelfTuner, SetCentres};
use fspid_fuzzy::{NumberTable, OutOfRange, Output};
use fspid_numeric::scalar::Interval;

use super::increments::ROUNDING;
use super::network::Net;
use super::numbers::Numbers;

/// A line along an output, and what is left beside it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Line {
    /// By error and by what is seen beside it, per unit of the supervisor.
    pub(crate) slopes: [f64; 2],
    /// R.
    pub(crate) beside: Interval,
}

/// What a tuner's supervisor answers, over inputs as the tuner scales them.
#[derive(Clone)]
pub(crate) enum Lines<'a> {
    /// Rules that conclude numbers.
    Numbers(Box<AlongNumbers<'a>>),
    /// A network.
    Network(Net<'a>),
}

/// Rules that conclude numbers.
#[derive(Clone)]
pub(crate) struct AlongNumbers<'a> {
    numbers: Numbers<'a>,
    /// Where the centres of each input's sets lie, rising.
    centres: [[Interval; 7]; 2],
}

/// A place along an input: the centre below, and the way to the next.
type Place = (usize, Interval);

impl<'a> Lines<'a> {
    /// Those of a tuner; none where rules conclude labels, or inputs are refused.
    pub(crate) fn of(tuner: &'a SelfTuner<f64>) -> Option<Self> {
        let supervisor = tuner.supervisor();
        let range = supervisor.range();
        if supervisor.out_of_range() == OutOfRange::Error {
            return None;
        }
        if let Some(network) = supervisor.network() {
            return Some(Self::Network(Net { network, range }));
        }
        let table: &NumberTable<f64> = supervisor.numbers()?;
        let sets = tuner.settings().input_sets;
        let centres = [sets.error, sets.change].map(|sets| centres(sets, range));
        let numbers = Numbers { table, range };
        Some(Self::Numbers(Box::new(AlongNumbers { numbers, centres })))
    }

    /// Every answer where error and second input lie between bounds.
    pub(crate) fn over(&self, inputs: [Interval; 2]) -> [Interval; 3] {
        match self {
            Self::Numbers(numbers) => numbers.over(inputs),
            Self::Network(network) => network.answers(inputs),
        }
    }

    /// Lines along the answers there.
    pub(crate) fn along(&self, inputs: [Interval; 2]) -> [Line; 3] {
        match self {
            Self::Numbers(numbers) => numbers.along(inputs),
            Self::Network(network) => network.along(inputs),
        }
    }
}

impl AlongNumbers<'_> {
    fn over(&self, inputs: [Interval; 2]) -> [Interval; 3] {
        let places = [0, 1].map(|input: usize| self.places(input, inputs[input]));
        Output::ALL.map(|output| self.beside(output, &places, [0.0; 2]))
    }

    fn along(&self, inputs: [Interval; 2]) -> [Line; 3] {
        let places = [0, 1].map(|input: usize| self.places(input, inputs[input]));
        Output::ALL.map(|output| {
            let slopes = [0, 1].map(|input| self.slope(output, input, inputs));
            Line { slopes, beside: self.beside(output, &places, slopes) }
        })
    }

    /// The slope from end to end of one input, in the middle of the other.
    fn slope(&self, output: Output, input: usize, inputs: [Interval; 2]) -> f64 {
        let side = inputs[input];
        let middle = self.place(1 - input, inputs[1 - input].midpoint());
        let at = |value: f64| {
            let own = self.place(input, value);
            let (row, column) = if input == 0 { (own, middle) } else { (middle, own) };
            self.numbers.at(output, row, column).midpoint()
        };
        let slope = (at(side.upper()) - at(side.lower())) / (side.upper() - side.lower());
        if slope.is_finite() { slope } else { 0.0 }
    }

    /// The answers with lines of these slopes taken away.
    fn beside(
        &self,
        output: Output,
        [errors, seconds]: &[Vec<(f64, Place)>; 2],
        [by_error, by_second]: [f64; 2],
    ) -> Interval {
        let point = Interval::point;
        let each = errors.iter().flat_map(|(error, row)| {
            seconds.iter().map(move |(second, column)| {
                self.numbers.at(output, *row, *column)
                    - point(by_error) * point(*error)
                    - point(by_second) * point(*second)
            })
        });
        let slack = ROUNDING * self.numbers.range;
        each.reduce(Interval::hull).unwrap_or(Interval::ENTIRE) + Interval::between(-slack, slack)
    }

    /// The ends of a side and the centres within it; of a centre that is enclosed both ends. What the answer does between
    /// those is far less than what the supervisor's own rounding is allowed.
    fn places(&self, input: usize, side: Interval) -> Vec<(f64, Place)> {
        let inside = |value: &f64| *value > side.lower() && *value < side.upper();
        let centres = self.centres[input].iter().flat_map(|it| [it.lower(), it.upper()]);
        let ends = [side.lower(), side.upper()].into_iter();
        ends.chain(centres.filter(inside)).map(|value| (value, self.place(input, value))).collect()
    }

    fn place(&self, input: usize, value: f64) -> Place {
        let centres = &self.centres[input];
        let below = centres.iter().skip(1).take(5).take_while(|it| it.lower() <= value).count();
        let (from, to) = (centres[below], centres[below + 1]);
        let part = (Interval::point(value) - from) / (to - from);
        let clamped = Interval::between(part.lower().clamp(0.0, 1.0), part.upper().clamp(0.0, 1.0));
        (below, clamped)
    }
}

/// Centres of the seven sets of an input.
fn centres(sets: Option<SetCentres<f64>>, range: f64) -> [Interval; 7] {
    let range = Interval::point(range);
    let third = Interval::ONE / Interval::point(3.0);
    let [small, medium] = match sets {
        Some(sets) => [sets.small(), sets.medium()].map(Interval::point),
        None => [third, third + third],
    };
    [-Interval::ONE, -medium, -small, Interval::ZERO, small, medium, Interval::ONE]
        .map(|part| part * range)
}

#[cfg(test)]
mod tests {
    use fspid_core::{Gains, InputSets, TunerSettings};
    use fspid_fuzzy::{Network, Supervisor};

    use super::*;

    fn networked() -> SelfTuner<f64> {
        let row = |seed: usize| {
            core::array::from_fn(|unit| ((unit * 7 + seed * 5) % 11) as f64 / 2.0 - 2.4)
        };
        let network = Network::new([row(0), row(3), row(4), row(7), row(9), row(10)]);
        let network = network.expect("weights");
        let supervisor = Supervisor::of_network(&network, 2.0, OutOfRange::Clamp).expect("allowed");
        let settings = TunerSettings::literal();
        SelfTuner::new(Gains { kp: 1.0, ki: 1.0, kd: 1.0 }, supervisor, settings).expect("allowed")
    }

    fn tuner(sets: Option<SetCentres<f64>>) -> SelfTuner<f64> {
        let grid = |seed: usize| {
            core::array::from_fn(|row| {
                core::array::from_fn(|column| {
                    ((row * column * 5 + row * 7 + seed) % 13) as f64 / 13.0 - 0.5
                })
            })
        };
        let table = NumberTable::new([grid(0), grid(3), grid(8)]).expect("numbers");
        let supervisor = Supervisor::of_numbers(&table, 2.0, OutOfRange::Clamp).expect("allowed");
        let settings = TunerSettings {
            input_sets: InputSets { error: sets, change: None },
            ..TunerSettings::literal()
        };
        SelfTuner::new(Gains { kp: 1.0, ki: 1.0, kd: 1.0 }, supervisor, settings).expect("allowed")
    }

    #[test]
    fn every_answer_lies_beside_its_lines() {
        let moved = SetCentres::new(0.1, 0.7).expect("rising");
        for tuner in [tuner(None), tuner(Some(moved)), networked()] {
            let lines = Lines::of(&tuner).expect("no labels");
            for (from, width) in [(-2.4, 0.3), (-0.1, 0.2), (0.3, 1.9), (0.21, 1e-3), (-2.4, 4.9)] {
                let inputs = [from, -0.7 * from].map(|at| Interval::between(at, at + width));
                let [along, over] = [
                    lines.along(inputs),
                    lines.over(inputs).map(|beside| Line { slopes: [0.0; 2], beside }),
                ];
                for step in 0..=400 {
                    let share = |by: usize| (step * by % 401) as f64 / 400.0;
                    let [error, second] = [
                        inputs[0].lower() + share(1) * width,
                        inputs[1].lower() + share(37) * width,
                    ];
                    let gains = tuner.increments_where_seen(error, second).expect("clamped");
                    for of in [along, over] {
                        for (line, answer) in of.iter().zip([gains.kp, gains.ki, gains.kd]) {
                            let off = answer - line.slopes[0] * error - line.slopes[1] * second;
                            let within = off >= line.beside.lower() - 1e-12
                                && off <= line.beside.upper() + 1e-12;
                            assert!(within, "{error} {second}: {off} {:?}", line.beside);
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn what_is_left_beside_a_line_shrinks_with_the_square_of_the_box() {
        for tuner in [tuner(None), networked()] {
            let lines = Lines::of(&tuner).expect("no labels");
            let left = |width: f64| {
                let inputs = [0.1, 0.9].map(|at| Interval::between(at, at + width));
                lines.along(inputs).map(|line| line.beside.width()).into_iter().fold(0.0, f64::max)
            };
            let [wide, narrow] = [left(0.02), left(0.002)];
            assert!(wide > 1e-5 && narrow < 0.011 * wide, "{wide} {narrow}");
        }
    }
}
