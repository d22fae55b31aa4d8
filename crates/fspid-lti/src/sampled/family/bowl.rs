//! The lowest point of a function between two higher ones.

/// Steps of one search; ten are usual.
const STEPS_MAX: usize = 60;
/// Part of the larger side for a step where parabolas do not help, $(3 - \sqrt 5)/2$.
const GOLDEN: f64 = 0.381_966_011_250_105_1;
/// Where a parabola promises less than this share of the value, the search ends, unless a point beside tells otherwise.
const PROMISE: f64 = 1e-12;
/// That point, as part of the larger side: through three points that lie evenly a parabola may turn anywhere.
const PROBE: f64 = 0.1;

/// A place and the value there.
pub(in crate::sampled) type Point = (f64, f64);

/// The lowest point found between two places from a lower one between them; ends early at a value below `enough`.
///
/// Parabolas through the three best points, golden sections where they do not shrink fast.
///
/// # Source
/// R. P. Brent, Algorithms for Minimization without Derivatives, Prentice-Hall (1973), chapter 5.
pub(in crate::sampled) fn lowest(
    function: impl Fn(f64) -> f64,
    points: [Point; 3],
    enough: f64,
) -> Point {
    let mut search = Search::between(points);
    for _ in 0..STEPS_MAX {
        let Some(place) = search.next_place() else { break };
        search.take((place, function(place)));
        if search.best.1 < enough {
            break;
        }
    }
    search.best
}

/// What is known of the lowest point.
struct Search {
    low: f64,
    high: f64,
    best: Point,
    second: Point,
    third: Point,
    /// From the best point of then to the one that was asked for last, and the same of the one before.
    step: f64,
    before: f64,
    /// A parabola promised nothing, and a point beside is asked.
    doubted: bool,
}

impl Search {
    fn between([left, middle, right]: [Point; 3]) -> Self {
        let (second, third) = if left.1 < right.1 { (left, right) } else { (right, left) };
        let (low, high) = (left.0, right.0);
        let step = high - low;
        Self { low, high, best: middle, second, third, step, before: step, doubted: false }
    }

    /// Where to ask next; nowhere where the best point is as low as can be told.
    fn next_place(&mut self) -> Option<f64> {
        let Self { low, high, best, .. } = *self;
        let end = if best.0 < 0.5 * (low + high) { high } else { low };
        let is_shorter = |place: f64| (place - best.0).abs() < 0.5 * self.before.abs();
        let next = match vertex(best, self.second, self.third) {
            Some((_, promise)) if promise <= PROMISE * best.1.abs() => {
                if self.doubted {
                    return None;
                }
                self.doubted = true;
                best.0 + PROBE * (end - best.0)
            }
            Some((place, _)) if low < place && place < high && is_shorter(place) => {
                self.doubted = false;
                place
            }
            _ => {
                self.doubted = false;
                self.step = end - best.0;
                best.0 + GOLDEN * self.step
            }
        };
        (self.before, self.step) = (self.step, next - best.0);
        (self.step.abs() > 4.0 * f64::EPSILON * best.0.abs()).then_some(next)
    }

    fn take(&mut self, point: Point) {
        let is_left = point.0 < self.best.0;
        if point.1 < self.best.1 {
            *(if is_left { &mut self.high } else { &mut self.low }) = self.best.0;
            (self.third, self.second, self.best) = (self.second, self.best, point);
            return;
        }
        *(if is_left { &mut self.low } else { &mut self.high }) = point.0;
        // Two points at the same bits are one, which no parabola goes through.
        if point.1 <= self.second.1 || self.second.0.to_bits() == self.best.0.to_bits() {
            (self.third, self.second) = (self.second, point);
        } else if point.1 <= self.third.1 {
            self.third = point;
        }
    }
}

/// The lowest point of the parabola through three points, and how far below the first it lies; `None` if it opens
/// downwards.
pub(super) fn vertex(best: Point, second: Point, third: Point) -> Option<Point> {
    let (d2, d3) = (second.0 - best.0, third.0 - best.0);
    let (s2, s3) = ((second.1 - best.1) / d2, (third.1 - best.1) / d3);
    let curvature = (s3 - s2) / (d3 - d2);
    let slope = s2 - curvature * d2;
    let promise = 0.25 * slope * slope / curvature;
    (curvature > 0.0 && promise.is_finite()).then(|| (best.0 - 0.5 * slope / curvature, promise))
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::cell::Cell;

    fn searched(function: impl Fn(f64) -> f64, places: [f64; 3]) -> (Point, usize) {
        let asked = Cell::new(0);
        let counted = |place: f64| {
            asked.set(asked.get() + 1);
            function(place)
        };
        let found =
            lowest(counted, places.map(|place| (place, function(place))), f64::NEG_INFINITY);
        (found, asked.get())
    }

    #[test]
    fn the_lowest_point_is_found_in_few_steps() {
        let (found, steps) = searched(|x| (x - 0.3) * (x - 0.3) + 2.0, [0.0, 0.4, 1.0]);
        assert!((found.1 - 2.0).abs() < 1e-14 && steps <= 3, "{found:?} {steps}");
        let bent = |x: f64| (x - 0.3) * (x - 0.3) * (1.0 + 3.0 * x) + 0.5;
        let (found, steps) = searched(bent, [0.2, 0.29, 0.4]);
        assert!((found.1 - 0.5).abs() < 1e-11 && steps <= 10, "{found:?} {steps}");
    }

    #[test]
    fn a_narrow_bowl_on_a_wide_slope_is_found() {
        let narrow = |x: f64| 1.0 + x - 1.0 / (1.0 + 1e8 * (x - 0.501) * (x - 0.501));
        let (found, steps) = searched(narrow, [0.4, 0.5011, 0.6]);
        assert!((found.0 - 0.501).abs() < 1e-8 && steps < 40, "{found:?} {steps}");
    }

    #[test]
    fn three_even_points_do_not_end_the_search() {
        let bent = |x: f64| (x - 0.3) * (x - 0.3) * (1.0 + 3.0 * x) + 0.5;
        // As high on the left as at 0.35: the first step goes to the middle between the two, where a parabola through
        // all three has its lowest point again.
        let even = |x: f64| bent(x) - bent(0.35);
        let (left, _) = crate::sampled::scan::root(&even, (0.2, even(0.2)), (0.3, even(0.3)));
        let (found, steps) = searched(bent, [left, 0.35, 1.0]);
        assert!((found.1 - 0.5).abs() < 1e-11 && steps > 2 && steps <= 15, "{found:?} {steps}");
    }

    #[test]
    fn kinks_end_the_search_too() {
        let (found, steps) = searched(|x| (x - 0.3_f64).abs() + 1.0, [0.0, 0.2, 1.0]);
        assert!((found.0 - 0.3).abs() < 1e-9 && steps <= STEPS_MAX, "{found:?} {steps}");
    }

    #[test]
    fn a_value_that_is_low_enough_ends_the_search() {
        let points = [0.0, 0.4, 1.0].map(|x| (x, (x - 0.3) * (x - 0.3)));
        let found = lowest(|x| (x - 0.3) * (x - 0.3) - 1.0, points, -0.5);
        assert!(found.1 < -0.5);
    }
}
