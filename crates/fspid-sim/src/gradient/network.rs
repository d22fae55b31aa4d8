//! A supervisor that is a network, forwards and backwards; see [`Network`](fspid_core::fuzzy::Network) for its equations.

use fspid_core::fuzzy::UNITS;

/// Weights of a network.
pub(super) const WEIGHTS: usize = 6 * UNITS;

fn softsign(x: f64) -> f64 {
    x / (1.0 + x.abs())
}

/// Slope of the softsign.
fn slope(x: f64) -> f64 {
    1.0 / ((1.0 + x.abs()) * (1.0 + x.abs()))
}

/// A network between its weights and its range.
#[derive(Clone, Copy, Debug)]
pub(super) struct FlownNetwork<'a> {
    /// Row by row, [`WEIGHTS`] of them.
    pub(super) weights: &'a [f64],
    pub(super) range: f64,
}

impl FlownNetwork<'_> {
    /// The inputs in parts of the range, moved into it.
    fn inputs(&self, seen: [f64; 2]) -> [f64; 2] {
        seen.map(|input| (input / self.range).clamp(-1.0, 1.0))
    }

    /// Weights of a hidden unit: of both inputs, and its offset.
    fn unit(&self, unit: usize) -> [f64; 3] {
        [0, 1, 2].map(|row| self.weights[UNITS * row + unit])
    }

    fn output(&self, gain: usize) -> &[f64] {
        &self.weights[UNITS * (3 + gain)..][..UNITS]
    }

    fn hidden(&self, [x, y]: [f64; 2]) -> [f64; UNITS] {
        core::array::from_fn(|unit| {
            let [a, b, c] = self.unit(unit);
            let u = a * x + b * y;
            (softsign(c + u) - softsign(c)) + (softsign(c - u) - softsign(c))
        })
    }

    fn sum(&self, gain: usize, hidden: &[f64; UNITS]) -> f64 {
        self.output(gain).iter().zip(hidden).map(|(weight, unit)| weight * unit).sum()
    }

    /// What it adds to each gain, before any factor.
    pub(super) fn deltas(&self, seen: [f64; 2]) -> [f64; 3] {
        let hidden = self.hidden(self.inputs(seen));
        [0, 1, 2].map(|gain| self.range * softsign(self.sum(gain, &hidden)))
    }

    /// Hands what the increments are worth to what is seen and to the weights; answers the first.
    pub(super) fn back(&self, seen: [f64; 2], worth: [f64; 3], gradient: &mut [f64]) -> [f64; 2] {
        let inputs = self.inputs(seen);
        let hidden = self.hidden(inputs);
        let of_sums =
            [0, 1, 2].map(|gain| worth[gain] * self.range * slope(self.sum(gain, &hidden)));
        let mut of_inputs = [0.0; 2];
        for (unit, answer) in hidden.into_iter().enumerate() {
            let [a, b, c] = self.unit(unit);
            let mut of_unit = 0.0;
            for (gain, of_sum) in of_sums.into_iter().enumerate() {
                gradient[UNITS * (3 + gain) + unit] += of_sum * answer;
                of_unit += of_sum * self.output(gain)[unit];
            }
            let u = a * inputs[0] + b * inputs[1];
            let [ahead, behind] = [slope(c + u), slope(c - u)];
            let of_u = of_unit * (ahead - behind);
            gradient[unit] += of_u * inputs[0];
            gradient[UNITS + unit] += of_u * inputs[1];
            gradient[2 * UNITS + unit] += of_unit * (ahead + behind - 2.0 * slope(c));
            of_inputs[0] += of_u * a;
            of_inputs[1] += of_u * b;
        }
        // Beyond the range the answer is level.
        let inside =
            seen.map(|input| if input.abs() < self.range { 1.0 / self.range } else { 0.0 });
        [of_inputs[0] * inside[0], of_inputs[1] * inside[1]]
    }
}
