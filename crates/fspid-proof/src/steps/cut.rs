//! What limits make of a number: straight lines through the ends of its range, and how far the limit is from them.
//!
//! For a function f of one number between a and b and any slope m, $f(x) = m x + c + \rho \nu$ with $|\nu| \le 1$, where c is
//! the middle of $f(x) - m x$ and ρ half its range. The slope is that of the line through both ends.

use fspid_numeric::scalar::Interval;

use super::affine::Affine;

/// A line with a half width.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Line {
    pub(super) slope: f64,
    pub(super) offset: Interval,
    pub(super) half: f64,
}

impl Line {
    /// The number itself.
    pub(super) const SAME: Self = Self { slope: 1.0, offset: Interval::ZERO, half: 0.0 };

    /// A number between limits, for everything that it may be.
    pub(super) fn clamped(range: Interval, lower: f64, upper: f64) -> Self {
        let [a, b] = [range.lower(), range.upper()];
        if a >= lower && b <= upper {
            return Self::SAME;
        }
        let beyond = [(b <= lower, lower), (a >= upper, upper)];
        if let Some((_, limit)) = beyond.into_iter().find(|(beyond, _)| *beyond) {
            return Self { slope: 0.0, offset: Interval::point(limit), half: 0.0 };
        }
        if !range.is_bounded() {
            return Self { slope: 0.0, ..Self::between(Interval::between(lower, upper)) };
        }
        let slope = ((b.min(upper) - a.max(lower)) / (b - a)).clamp(0.0, 1.0);
        let off = |x: f64| {
            Interval::point(x.clamp(lower, upper)) - Interval::point(slope) * Interval::point(x)
        };
        // Of a broken line the extremes are at its ends and where it breaks.
        let breaks = [lower, upper].into_iter().filter(|at| *at > a && *at < b);
        let offs = [a, b].into_iter().chain(breaks).map(off);
        let whole = offs.reduce(Interval::hull).unwrap_or(Interval::ENTIRE);
        Self { slope, ..Self::between(whole) }
    }

    /// Everything between two ends, without a slope.
    pub(super) fn between(whole: Interval) -> Self {
        let middle = whole.midpoint();
        let half = (whole - Interval::point(middle)).magnitude();
        Self { slope: 0.0, offset: Interval::point(middle), half }
    }

    /// The number on its line, with an unknown of its own where there is a width.
    pub(super) fn of(&self, value: &Affine, symbol: &mut dyn FnMut() -> usize) -> Affine {
        let constant = Affine::constant(self.offset);
        let line = Affine::sum([(Interval::point(self.slope), value), (Interval::ONE, &constant)]);
        line.and_noise(self.half, symbol)
    }
}

/// Bounds of $f(x) - m x$ over a piece that begins at `from`, where f is `value` and its slopes lie in `slopes`.
pub(super) fn beside_line(
    [from, to]: [f64; 2],
    value: Interval,
    slopes: Interval,
    slope: f64,
) -> Interval {
    let along = (Interval::point(to) - Interval::point(from)).hull(Interval::ZERO);
    value - Interval::point(slope) * Interval::point(from)
        + (slopes - Interval::point(slope)) * along
}

/// True where both are the same number, bit for bit.
pub(super) fn is_same(one: f64, other: f64) -> bool {
    one.to_bits() == other.to_bits()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_clamped_number_lies_on_its_line() {
        for (a, b) in [(-3.0, 3.0), (-0.5, 4.0), (-4.0, -0.9), (1.0, 2.0), (-2.0, -1.5), (0.0, 0.5)]
        {
            let line = Line::clamped(Interval::between(a, b), -1.0, 1.0);
            for step in 0..=100 {
                let x = a + (b - a) * f64::from(step) / 100.0;
                let off = x.clamp(-1.0, 1.0) - line.slope * x - line.offset.midpoint();
                assert!(off.abs() <= line.half + 1e-15, "{a} {b} {x}: {off} {}", line.half);
            }
        }
        assert_eq!(Line::clamped(Interval::between(-0.5, 1.0), -1.0, 1.0), Line::SAME);
        assert!(Line::clamped(Interval::between(1.0, 2.0), -1.0, 1.0).half <= 0.0);
    }
}
