//! What a network answers over a box, and how steeply; see [`Network`] for its equations.

use fspid_fuzzy::{Network, Output};
use fspid_numeric::scalar::Interval;

use super::lines::Line;

/// What the arithmetic of a network may be off by, as a share of what [`Net::slack`] sums up: $2^{-46}$, which is
/// $128 \epsilon$ with $\epsilon = 2^{-53}$.
///
/// An input in parts of the range is off by $\epsilon$ of itself, what a unit sees by $4 \epsilon (|a| + |b|)$, the sum with
/// its offset by $\epsilon (|a| + |b| + |c|)$ more. The softsign never grows faster than its argument and adds
/// $3 \epsilon$. Two of them less twice that of the offset are off by less than $20 \epsilon (1 + |a| + |b| + |c|)$; their
/// weighted sum adds $9 \epsilon$ of its terms, which are below $2 |v|$, and the last softsign and the range add $4
/// \epsilon$.
const ROUNDING: f64 = 1.0 / (1_u64 << 46) as f64;
/// Parts of either input over which slopes are taken, of the error on one side of rest.
const PARTS: usize = 64;

/// A network over its range.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Net<'a> {
    pub(super) network: &'a Network<f64>,
    /// Half range of the inputs.
    pub(super) range: f64,
}

/// The softsign, which rises everywhere.
fn softsign(x: Interval) -> Interval {
    let at = |end: f64| {
        let size = Interval::ONE + Interval::point(end.abs());
        Interval::point(end) / size
    };
    Interval::between(at(x.lower()).lower(), at(x.upper()).upper())
}

/// Its slope $1 / (1 + |x|)^2$, which falls with the magnitude.
fn slope(x: Interval) -> Interval {
    let at = |size: f64| {
        let size = Interval::ONE + Interval::point(size);
        Interval::ONE / (size * size)
    };
    Interval::between(at(x.magnitude()).lower(), at(x.mignitude()).upper())
}

/// What a unit with offset c answers where it sees $u$.
///
/// For $u > 0$ its slope $\varphi'(c + u) - \varphi'(c - u)$ has one sign: c + u is farther from 0 than c - u where c is
/// above 0, and nearer where it is below. So the answer goes one way with the magnitude of u, and its ends are enough.
fn unit(u: Interval, offset: f64) -> Interval {
    let c = Interval::point(offset);
    let at = |size: f64| {
        let u = Interval::point(size);
        let rest = softsign(c);
        (softsign(c + u) - rest) + (softsign(c - u) - rest)
    };
    at(u.mignitude()).hull(at(u.magnitude()))
}

impl Net<'_> {
    /// How far the supervisor's own arithmetic may be off the formula, in the units of the range.
    pub(super) fn slack(&self) -> f64 {
        let of_output = |output: Output| -> f64 {
            let units = self.network.hidden().zip(self.network.output(output));
            units.map(|([a, b, c], v)| v.abs() * (1.0 + a.abs() + b.abs() + c.abs())).sum()
        };
        let most = Output::ALL.map(of_output).into_iter().fold(0.0, f64::max);
        ROUNDING * self.range * (1.0 + most)
    }

    /// All answers over inputs, but for the rounding of the supervisor's own arithmetic.
    ///
    /// A sum of units over a box is what each answers there, and also what they answer in the middle and how steep they
    /// are on the way: it lies in both.
    pub(super) fn over(&self, asked: [Interval; 2]) -> [Interval; 3] {
        let inputs = asked.map(|side| self.part(side));
        Output::ALL.map(|output| {
            let (sum, _) = self.sum_with_slopes(output, inputs);
            Interval::point(self.range) * softsign(sum)
        })
    }

    /// All answers over inputs, with the rounding of the supervisor's own arithmetic.
    pub(super) fn answers(&self, asked: [Interval; 2]) -> [Interval; 3] {
        let slack = self.rounding();
        self.over(asked).map(|answer| answer + slack)
    }

    fn rounding(&self) -> Interval {
        let slack = self.slack();
        Interval::between(-slack, slack)
    }

    /// Lines along the answers over inputs, with the rounding of the supervisor's own arithmetic.
    pub(super) fn along(&self, asked: [Interval; 2]) -> [Line; 3] {
        let (rounding, inputs) = (self.rounding(), asked.map(|side| self.part(side)));
        let is_finite = asked.iter().all(|side| side.width().is_finite());
        let middle = asked.map(|side| Interval::point(side.midpoint()));
        // Beyond the range answers are level.
        let is_beyond = asked.map(|side| side.magnitude() > self.range);
        Output::ALL.map(|output| {
            let (sum, by_inputs) = self.sum_with_slopes(output, inputs);
            let answer = |sum| Interval::point(self.range) * softsign(sum) + rounding;
            let level = Line { slopes: [0.0; 2], beside: answer(sum) };
            if !is_finite {
                return level;
            }
            let in_middle = self.sum(output, middle.map(|side| self.part(side)));
            let (mut slopes, mut beside) = ([0.0; 2], answer(in_middle));
            for input in 0..2 {
                // The range that answers are multiplied by is the one that inputs are divided by.
                let by = slope(sum) * by_inputs[input];
                let by = if is_beyond[input] { by.hull(Interval::ZERO) } else { by };
                slopes[input] = by.midpoint();
                let (along, away) = (Interval::point(slopes[input]), asked[input] - middle[input]);
                beside = beside - along * middle[input] + (by - along) * away;
            }
            if beside.width() < level.beside.width() { Line { slopes, beside } } else { level }
        })
    }

    /// The sum over a box, and its slopes there along both inputs in parts of the range.
    fn sum_with_slopes(&self, output: Output, inputs: [Interval; 2]) -> (Interval, [Interval; 2]) {
        let middle = inputs.map(|side| Interval::point(side.midpoint()));
        let away = [0, 1].map(|input: usize| inputs[input] - middle[input]);
        let whole = self.sum(output, inputs);
        let [by_x, by_y] = self.sum_slopes(output, inputs);
        let from_middle = self.sum(output, middle) + by_x * away[0] + by_y * away[1];
        (whole.intersection(from_middle).unwrap_or(whole), [by_x, by_y])
    }

    /// Least and largest slope of each output along error and change where both are, in magnitude, within these; beyond
    /// the range answers are level.
    pub(super) fn slopes(&self, within: [f64; 2]) -> [[Interval; 2]; 3] {
        let [most_error, most_change] = within.map(|side| side.min(self.range));
        let parts = |from: f64, to: f64| {
            let at = move |part: usize| from + (to - from) * (part as f64 / PARTS as f64);
            let last = move |part| if part + 1 == PARTS { to } else { at(part + 1) };
            (0..PARTS).map(move |part| Interval::between(at(part), last(part)))
        };
        // At rest every slope is zero.
        let mut slopes = [[Interval::ZERO; 2]; 3];
        for error in parts(0.0, most_error) {
            for change in parts(-most_change, most_change) {
                let inputs = [error, change].map(|side| self.part(side));
                for (output, slopes) in Output::ALL.into_iter().zip(&mut slopes) {
                    let (sum, by_inputs) = self.sum_with_slopes(output, inputs);
                    for (widest, by) in slopes.iter_mut().zip(by_inputs) {
                        let found = slope(sum) * by;
                        // Both inputs turned, the answer is the same and its slopes are turned.
                        *widest = widest.hull(found).hull(-found);
                    }
                }
            }
        }
        slopes
    }

    /// An input in parts of the range, moved into it.
    fn part(&self, side: Interval) -> Interval {
        let part = side / Interval::point(self.range);
        let within = |end: f64| end.clamp(-1.0, 1.0);
        Interval::between(within(part.lower()), within(part.upper()))
    }

    fn sum(&self, output: Output, [x, y]: [Interval; 2]) -> Interval {
        let units = self.network.hidden().zip(self.network.output(output));
        units.fold(Interval::ZERO, |sum, ([a, b, c], v)| {
            let u = Interval::point(a) * x + Interval::point(b) * y;
            sum + Interval::point(*v) * unit(u, c)
        })
    }

    /// Slopes of the sum along both inputs in parts of the range.
    fn sum_slopes(&self, output: Output, [x, y]: [Interval; 2]) -> [Interval; 2] {
        let units = self.network.hidden().zip(self.network.output(output));
        units.fold([Interval::ZERO; 2], |[by_x, by_y], ([a, b, c], v)| {
            let (a, b, c) = (Interval::point(a), Interval::point(b), Interval::point(c));
            let u = a * x + b * y;
            let by_u = Interval::point(*v) * (slope(c + u) - slope(c - u));
            [by_x + by_u * a, by_y + by_u * b]
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fspid_fuzzy::{OutOfRange, Supervisor};

    /// Weights up to `size` that look as if they were drawn.
    fn network(size: f64, seed: u32) -> Network<f64> {
        let mut state = seed;
        let rows = [[0.0; 8]; 6].map(|row| {
            row.map(|_: f64| {
                state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                size * (f64::from(state >> 8) / f64::from(1 << 23) - 1.0)
            })
        });
        Network::new(rows).expect("allowed")
    }

    fn answers(supervisor: &Supervisor<f64>, at: [f64; 2]) -> [f64; 3] {
        let delta = supervisor.infer(at[0], at[1]).expect("finite").delta;
        [delta.kp, delta.ki, delta.kd]
    }

    #[test]
    fn answers_within_a_box_lie_in_what_is_said_of_it_with_the_slack_of_rounding() {
        for (size, seed) in [(0.5, 1), (3.0, 2), (20.0, 3), (1e3, 4), (1e6, 5)] {
            let network = network(size, seed);
            let supervisor = Supervisor::of_network(&network, 2.0, OutOfRange::Clamp).expect("ok");
            let net = Net { network: &network, range: 2.0 };
            let slack = net.slack();
            for (error, change) in
                [([-0.3, 0.9], [0.1, 0.2]), ([-2.0, 2.0], [-2.0, 2.0]), ([0.0, 0.0], [-1.9, 2.0])]
            {
                let told = net.over([error, change].map(|[a, b]| Interval::between(a, b)));
                for i in 0..=40 {
                    for j in 0..=40 {
                        let at =
                            |[from, to]: [f64; 2], n: i32| from + (to - from) * f64::from(n) / 40.0;
                        let found = answers(&supervisor, [at(error, i), at(change, j)]);
                        for (told, value) in told.iter().zip(found) {
                            let held =
                                told.lower() - slack <= value && value <= told.upper() + slack;
                            assert!(held, "{size}: {told:?} {value}");
                        }
                    }
                }
            }
        }
    }

    #[test]
    fn small_boxes_are_enclosed_tightly() {
        let network = network(3.0, 9);
        let net = Net { network: &network, range: 2.0 };
        for width in [1e-2, 1e-4] {
            let told = net.over([0.7, -0.4].map(|at| Interval::between(at, at + width)));
            for told in told {
                assert!(told.width() < 40.0 * width, "{width}: {told:?}");
            }
        }
        assert!(net.slack() < 1e-11, "{}", net.slack());
    }

    #[test]
    fn differences_of_answers_are_within_the_slopes() {
        for (size, seed) in [(1.0, 11), (6.0, 12)] {
            let network = network(size, seed);
            let supervisor = Supervisor::of_network(&network, 2.0, OutOfRange::Clamp).expect("ok");
            let net = Net { network: &network, range: 2.0 };
            for within in [[2.0, 2.0], [0.3, 1.0]] {
                let slopes = net.slopes(within);
                let mut steepest = [0.0_f64; 3];
                for i in 0..=40 {
                    for j in 0..=40 {
                        let at = [i, j].map(|n| f64::from(n) / 20.0 - 1.0);
                        let from = [at[0] * within[0], at[1] * within[1]];
                        let step = 1e-3 * within[0];
                        let to = [(from[0] + step).min(within[0]), from[1]];
                        let (a, b) = (answers(&supervisor, from), answers(&supervisor, to));
                        for gain in 0..3 {
                            let by = (b[gain] - a[gain]) / (to[0] - from[0]).max(1e-12);
                            let [along, _] = slopes[gain];
                            assert!(along.lower() - 1e-6 <= by && by <= along.upper() + 1e-6);
                            steepest[gain] = steepest[gain].max(by.abs());
                        }
                    }
                }
                for (slopes, steepest) in slopes.iter().zip(steepest) {
                    assert!(slopes[0].magnitude() < 2.0 * steepest + 1.0, "{slopes:?} {steepest}");
                }
            }
        }
    }
}
