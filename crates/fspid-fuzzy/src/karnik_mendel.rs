//! End points of the centroid of an interval type-2 set.
//!
//! Between a lower grade $\underline\mu(x)$ and an upper grade $\overline\mu(x)$ lie many ordinary
//! sets. The smallest of their centroids takes the upper grade left of itself and the lower grade
//! right of itself, the largest the other way round:
//!
//! $$ c_l = \frac{\int_{x \le c_l} x \overline\mu + \int_{x > c_l} x \underline\mu}
//!               {\int_{x \le c_l} \overline\mu + \int_{x > c_l} \underline\mu} $$
//!
//! Both are fixed points that the iteration of Karnik and Mendel reaches from one side, at last with
//! quadratic speed. Here every integral is exact, over straight pieces or over weighted points, so
//! that the end points are exact to rounding.
//!
//! # Source
//! N. N. Karnik and J. M. Mendel, *Centroid of a type-2 fuzzy set*, Information Sciences 132 (2001)
//! 195–220; convergence: J. M. Mendel and F. Liu, *Super-exponential convergence of the
//! Karnik–Mendel algorithms*, IEEE Transactions on Fuzzy Systems 15 (2007) 309–320.

/// A straight piece of a membership function.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Straight {
    /// Left and right end.
    pub x: [f64; 2],
    /// Grades there.
    pub grade: [f64; 2],
}

/// A point with a weight between two bounds: what a rule of an interval type-2 system concludes.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct WeightedPoint {
    /// Smallest and largest value.
    pub value: [f64; 2],
    /// Smallest and largest weight.
    pub weight: [f64; 2],
}

/// Which end point is sought.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum End {
    Left,
    Right,
}

/// More iterations than any case needs: the error squares at each.
const MAX_ITERATIONS: usize = 100;

/// Smallest and largest centroid between the piecewise-linear grades `lower` and `upper`; nothing
/// where the upper one has no area.
///
/// Pieces may come in any order, and must not overlap within one grade.
#[must_use]
pub fn centroid_end_points(lower: &[Straight], upper: &[Straight]) -> Option<[f64; 2]> {
    let end = |end| {
        let start = start(upper)?;
        Some(fixed_point(start, end, |c| {
            let (left, right) = match end {
                End::Left => (upper, lower),
                End::Right => (lower, upper),
            };
            let (left_area, left_moment) = moments(left, c, Side::Left);
            let (right_area, right_moment) = moments(right, c, Side::Right);
            (left_area + right_area, left_moment + right_moment)
        }))
    };
    Some([end(End::Left)?, end(End::Right)?])
}

/// Smallest and largest $\sum w_i z_i / \sum w_i$ with each $w_i$ and $z_i$ between its bounds;
/// nothing where all weights are zero.
#[must_use]
pub fn average_end_points(points: &[WeightedPoint]) -> Option<[f64; 2]> {
    let end = |end| {
        let pick = |point: &WeightedPoint| match end {
            End::Left => point.value[0],
            End::Right => point.value[1],
        };
        let total: f64 = points.iter().map(|p| p.weight[1]).sum();
        let sum: f64 = points.iter().map(|p| p.weight[1] * pick(p)).sum();
        (total >= f64::MIN_POSITIVE).then(|| {
            fixed_point(sum / total, end, |c| {
                points.iter().fold((0.0, 0.0), |(area, moment), point| {
                    let distance = pick(point) - c;
                    let heavy = (distance <= 0.0) == (end == End::Left);
                    let weight = point.weight[usize::from(heavy)];
                    (area + weight, moment + weight * distance)
                })
            })
        })
    };
    Some([end(End::Left)?, end(End::Right)?])
}

/// $c \leftarrow c + M(c)/A(c)$ until it stays, where $A$ is an area and $M$ its moment about $c$.
///
/// Every choice of grades has a centroid between the end points, so that each step goes towards the
/// end that is sought; one that does not is rounding, and the last.
fn fixed_point(start: f64, end: End, area_and_moment: impl Fn(f64) -> (f64, f64)) -> f64 {
    let mut centre = start;
    for _ in 0..MAX_ITERATIONS {
        let (area, moment) = area_and_moment(centre);
        let step = moment / area;
        let onwards = match end {
            End::Left => step < 0.0,
            End::Right => step > 0.0,
        };
        // Without area the quotient is no number, and the centre already at the end of the set.
        if !(area >= f64::MIN_POSITIVE && onwards)
            || step.abs() <= 0.25 * f64::EPSILON * centre.abs()
        {
            break;
        }
        centre += step;
    }
    centre
}

/// The centroid of one grade, where the iteration starts.
fn start(upper: &[Straight]) -> Option<f64> {
    let origin = upper.first()?.x[0];
    let (left_area, left_moment) = moments(upper, origin, Side::Left);
    let (right_area, right_moment) = moments(upper, origin, Side::Right);
    let area = left_area + right_area;
    (area >= f64::MIN_POSITIVE).then(|| origin + (left_moment + right_moment) / area)
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Side {
    Left,
    Right,
}

/// Area, and moment about `c`, of what lies on one side of `c`.
fn moments(pieces: &[Straight], c: f64, side: Side) -> (f64, f64) {
    pieces.iter().filter_map(|piece| cut(piece, c, side)).fold((0.0, 0.0), |(area, moment), p| {
        let (own_area, own_moment) = piece_moments(&p, c);
        (area + own_area, moment + own_moment)
    })
}

/// The part of a piece on one side of `c`.
fn cut(piece: &Straight, c: f64, side: Side) -> Option<Straight> {
    let [x0, x1] = piece.x;
    let [y0, y1] = piece.grade;
    match side {
        Side::Left if x1 <= c => Some(*piece),
        Side::Right if x0 >= c => Some(*piece),
        Side::Left if x0 >= c => None,
        Side::Right if x1 <= c => None,
        _ => {
            let middle = y0 + (y1 - y0) * ((c - x0) / (x1 - x0));
            Some(match side {
                Side::Left => Straight { x: [x0, c], grade: [y0, middle] },
                Side::Right => Straight { x: [c, x1], grade: [middle, y1] },
            })
        }
    }
}

/// Area and moment about `c` of a straight piece: with width $w$, grades $a, b$ and its ends at
/// distances $s, t$ from `c`, $A = w (a + b)/2$ and $M = w \left(a (2s + t) + b (s + 2t)\right)/6$.
fn piece_moments(piece: &Straight, c: f64) -> (f64, f64) {
    let [s, t] = piece.x.map(|x| x - c);
    let [a, b] = piece.grade;
    let width = t - s;
    let area = 0.5 * width * (a + b);
    let moment = width * (a * (2.0 * s + t) + b * (s + 2.0 * t)) / 6.0;
    (area, moment)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec::Vec;

    fn straight(points: &[(f64, f64)]) -> Vec<Straight> {
        let piece = |pair: &[(f64, f64)]| Straight {
            x: [pair[0].0, pair[1].0],
            grade: [pair[0].1, pair[1].1],
        };
        points.windows(2).map(piece).collect()
    }

    #[test]
    fn equal_grades_have_one_centroid() {
        let triangle = straight(&[(0.0, 0.0), (1.0, 1.0), (4.0, 0.0)]);
        let [left, right] = centroid_end_points(&triangle, &triangle).expect("area");
        // The centroid of a triangle is the mean of its corners.
        assert!((left - 5.0 / 3.0).abs() < 1e-15 && (right - 5.0 / 3.0).abs() < 1e-15);
    }

    #[test]
    fn the_end_points_of_a_uniform_band_are_known_in_closed_form() {
        // Grades 1 and h over [-1, 1]: (1 - h) c^2 + 2 (1 + h) c + (1 - h) = 0 for the right end with
        // the sign turned: with q = sqrt(h), c = (1 - q)/(1 + q).
        for h in [0.01, 0.25, 0.5, 0.9] {
            let upper = straight(&[(-1.0, 1.0), (1.0, 1.0)]);
            let lower = straight(&[(-1.0, h), (1.0, h)]);
            let [left, right] = centroid_end_points(&lower, &upper).expect("area");
            let root = libm::sqrt(h);
            let known = (1.0 - root) / (1.0 + root);
            assert!((right - known).abs() < 2e-15, "{h}: {right} {known}");
            assert!((left + known).abs() < 2e-15, "{h}: {left}");
        }
    }

    #[test]
    fn an_end_point_is_its_own_switch_point() {
        let upper = straight(&[(0.0, 0.1), (2.0, 0.9), (5.0, 0.6), (9.0, 0.0)]);
        let lower = straight(&[(0.0, 0.0), (3.0, 0.4), (9.0, 0.0)]);
        let [left, right] = centroid_end_points(&lower, &upper).expect("area");
        assert!(left < right);
        for (c, inner, outer) in [(left, &upper, &lower), (right, &lower, &upper)] {
            let (a, m) = moments(inner, c, Side::Left);
            let (b, n) = moments(outer, c, Side::Right);
            assert!(((m + n) / (a + b)).abs() < 1e-14, "{c}");
        }
    }

    #[test]
    fn a_set_without_area_has_no_centroid() {
        let nothing = straight(&[(0.0, 0.0), (1.0, 0.0)]);
        assert_eq!(centroid_end_points(&nothing, &nothing), None);
        assert_eq!(average_end_points(&[]), None);
    }

    proptest::proptest! {
        #[test]
        fn averages_agree_with_all_choices_of_end_weights(
            rows in proptest::collection::vec((-10.0..10.0_f64, 0.0..1.0_f64, 0.0..1.0_f64), 1..8)
        ) {
            let points: Vec<_> = rows
                .iter()
                .map(|&(z, a, b)| WeightedPoint { value: [z, z + 0.5], weight: [a.min(b), a.max(b)] })
                .collect();
            let Some([left, right]) = average_end_points(&points) else { return Ok(()) };
            let (mut least, mut most) = (f64::INFINITY, f64::NEG_INFINITY);
            for choice in 0..1_u32 << points.len() {
                for end in 0..2 {
                    let weights = points.iter().enumerate();
                    let weights: Vec<_> = weights.map(|(i, p)| p.weight[(choice >> i & 1) as usize]).collect();
                    let total: f64 = weights.iter().sum();
                    if total > 0.0 {
                        let sum: f64 = points.iter().zip(&weights).map(|(p, w)| p.value[end] * w).sum();
                        least = least.min(sum / total);
                        most = most.max(sum / total);
                    }
                }
            }
            proptest::prop_assert!((left - least).abs() < 1e-12 && (right - most).abs() < 1e-12);
        }
    }
}
