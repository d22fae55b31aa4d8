//! The trapezoid nearest to a function.

use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::system::Universe;

/// How often the step is halved: the last one is a millionth of the universe.
const HALVINGS: u32 = 17;
/// Places at which the two are compared.
const SAMPLES: u16 = 1001;

/// Corners of a trapezoid near to `grade`, and the largest difference of grades over the samples.
/// `marks` are further places at which the two are compared, for what is narrower than the samples.
pub(super) fn trapezoid(
    grade: impl Fn(f64) -> f64,
    universe: Universe,
    marks: &[f64],
) -> ([f64; 4], f64) {
    let place = |n| universe.lower + universe.span() * (f64::from(n) / f64::from(SAMPLES - 1));
    let inside = marks.iter().copied().filter(|&x| universe.contains(x));
    let mut places: Vec<f64> = (0..SAMPLES).map(place).chain(inside).collect();
    places.sort_by(f64::total_cmp);
    let mut samples: Vec<_> = places.into_iter().map(|x| (x, grade(x))).collect();
    let mut best = begin(&samples, universe);
    let mut cost = cost(&samples, best);
    let mut step = universe.span() / 8.0;
    for _ in 0..HALVINGS {
        while let Some((corners, less)) = better(&samples, best, cost, step) {
            (best, cost) = (corners, less);
        }
        step *= 0.5;
    }
    // A top that no sample sees is told too.
    samples.extend(best.into_iter().filter(|&x| universe.contains(x)).map(|x| (x, grade(x))));
    (best, errors(&samples, best).fold(0.0, f64::max))
}

/// Corners where the samples leave 0 and reach their upper half.
fn begin(samples: &[(f64, f64)], universe: Universe) -> [f64; 4] {
    let top = samples.iter().map(|(_, grade)| *grade).fold(0.0, f64::max);
    let above = |level: f64| {
        let mut places = samples.iter().filter(|(_, grade)| *grade >= level * top).map(|(x, _)| *x);
        let first = places.next().unwrap_or(universe.lower);
        (first, places.next_back().unwrap_or(first))
    };
    let ((outer_left, outer_right), (inner_left, inner_right)) = (above(0.05), above(0.95));
    [outer_left, inner_left, inner_right, outer_right]
}

/// The first corner that can be moved to advantage.
fn better(
    samples: &[(f64, f64)],
    corners: [f64; 4],
    cost_before: f64,
    step: f64,
) -> Option<([f64; 4], f64)> {
    let moves = (0..4).flat_map(|corner| [(corner, step), (corner, -step)]);
    let mut moved = moves.map(|(corner, by)| {
        let mut other = corners;
        if let Some(place) = other.get_mut(corner) {
            *place += by;
        }
        (other, cost(samples, other))
    });
    // Gains too small to matter would keep the search going for long.
    moved.find(|(_, less)| *less < cost_before * 0.999)
}

/// Sum of eighth powers: nearly the largest error, but a search does not get stuck on it.
fn cost(samples: &[(f64, f64)], corners: [f64; 4]) -> f64 {
    if ShapeKind::Trapezoid.check(&corners).is_err() {
        return f64::INFINITY;
    }
    errors(samples, corners).map(|error| error.powi(8)).sum()
}

fn errors(samples: &[(f64, f64)], corners: [f64; 4]) -> impl Iterator<Item = f64> {
    let error = move |&(x, grade): &(f64, f64)| ShapeKind::Trapezoid.grade(&corners, x) - grade;
    samples.iter().map(error).map(f64::abs)
}

#[cfg(test)]
mod tests {
    use super::*;

    const UNIVERSE: Universe = Universe { lower: -5.0, upper: 5.0 };

    #[test]
    fn a_trapezoid_is_found_again() {
        let corners = [-3.0, -1.0, 2.0, 2.5];
        let (_, error) = trapezoid(|x| ShapeKind::Trapezoid.grade(&corners, x), UNIVERSE, &[]);
        assert!(error < 0.02, "{error}");
    }

    #[test]
    fn the_error_told_is_the_error_made() {
        let bell = |x: f64| (-0.5 * x * x).exp();
        let (corners, error) = trapezoid(bell, UNIVERSE, &[]);
        let found = (0..=10_000).map(|n| f64::from(n) * 1e-3 - 5.0);
        let found = found.map(|x| (ShapeKind::Trapezoid.grade(&corners, x) - bell(x)).abs());
        let found = found.fold(0.0, f64::max);
        assert!((0.03..0.12).contains(&error) && (found - error).abs() < 0.01, "{found} {error}");
    }

    #[test]
    fn a_function_that_is_nowhere_above_zero_ends_too() {
        assert!(trapezoid(|_| 0.0, UNIVERSE, &[]).1.is_finite());
    }

    #[test]
    fn a_function_that_is_narrower_than_the_samples_is_seen_at_its_marks() {
        let bell = |x: f64| (-0.5 * ((x - 1.2346) / 0.001).powi(2)).exp();
        let marks = [-3.0, -2.0, -1.0, -0.5, 0.0, 0.5, 1.0, 2.0, 3.0].map(|n| 1.2346 + 0.001 * n);
        let (corners, error) = trapezoid(bell, UNIVERSE, &marks);
        assert!(ShapeKind::Trapezoid.grade(&corners, 1.2346) > 0.8, "{corners:?}");
        assert!(error < 0.2, "{error}");
    }
}
