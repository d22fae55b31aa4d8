//! Affine enclosures of saturation functions: the secant through the ends of a range, and the largest deviation from it.
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
            return Self::between(Interval::between(lower, upper));
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

    /// All that the limit makes of a range lies on the line, and the line is no wider than that.
    #[test]
    fn the_line_of_a_clamped_number_is_the_closest_with_its_slope() {
        for (a, b, slope) in [
            (-3.0, 3.0, 1.0 / 3.0),
            (-0.5, 4.0, 1.0 / 3.0),
            (-4.0, -0.9, 0.1 / 3.1),
            (-4.0, 0.5, 1.5 / 4.5),
            (-2.0, 7.0, 2.0 / 9.0),
        ] {
            let line = Line::clamped(Interval::between(a, b), -1.0, 1.0);
            assert!((line.slope - slope).abs() < 1e-15, "{a} {b}: {line:?}");
            let offs = (0..=4000).map(|step| a + (b - a) * f64::from(step) / 4000.0);
            let offs = offs.chain([-1.0, 1.0].into_iter().filter(|at| (a..=b).contains(at)));
            let offs: Vec<f64> = offs.map(|x| x.clamp(-1.0, 1.0) - slope * x).collect();
            let least = offs.iter().copied().fold(f64::INFINITY, f64::min);
            let most = offs.iter().copied().fold(f64::NEG_INFINITY, f64::max);
            assert!((line.half - 0.5 * (most - least)).abs() < 1e-14, "{a} {b}: {line:?}");
            let middle = line.offset.midpoint();
            assert!((middle - 0.5 * (most + least)).abs() < 1e-14, "{a} {b}: {line:?}");
        }
    }

    #[test]
    fn a_number_without_bounds_is_all_between_its_limits() {
        for range in [Interval::ENTIRE, Interval::new(0.0, f64::INFINITY).unwrap()] {
            let line = Line::clamped(range, -1.0, 3.0);
            assert!(line.slope.abs() <= 0.0 && line.half >= 2.0 && line.half < 2.0 + 1e-14);
            assert!((line.offset.midpoint() - 1.0).abs() <= 0.0, "{line:?}");
        }
    }

    /// From 2 at 1 with slopes of 1/2 to 1 up to 3, less a quarter of what is gone along.
    #[test]
    fn what_is_beside_a_line_begins_with_a_value_and_goes_on_with_its_slopes() {
        let slopes = Interval::between(0.5, 1.0);
        let beside = beside_line([1.0, 3.0], Interval::between(2.0, 2.25), slopes, 0.25);
        assert!((beside.lower() - 1.75).abs() < 1e-14, "{beside:?}");
        assert!((beside.upper() - 3.5).abs() < 1e-14, "{beside:?}");
        let falls = beside_line([-1.0, 1.0], Interval::point(2.0), Interval::point(-1.0), 0.5);
        assert!((falls.lower() + 0.5).abs() < 1e-14, "{falls:?}");
        assert!((falls.upper() - 2.5).abs() < 1e-14, "{falls:?}");
    }

    #[test]
    fn numbers_are_the_same_bit_for_bit() {
        assert!(is_same(1.0, 1.0) && !is_same(1.0, 1.0_f64.next_up()));
        assert!(!is_same(0.0, -0.0));
    }
}
