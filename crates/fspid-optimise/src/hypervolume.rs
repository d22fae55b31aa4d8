//! The volume that a set of trade-offs dominates (Zitzler and Thiele, PPSN V, 1998), by slicing one
//! objective after the other.

/// Volume of what is dominated by `points` and itself dominates `reference`; all objectives are
/// minimised.
///
/// $$ H = \lambda\Bigl(\bigcup_p [p_1, r_1] \times \dots \times [p_m, r_m]\Bigr) $$
///
/// Points that do not reach below the reference in every objective, have another number of
/// objectives or are not numbers add nothing. Two objectives take n² operations, each further one n
/// times as many: for three that is a matter of milliseconds for a hundred points.
#[must_use]
pub fn hypervolume<P: AsRef<[f64]>>(points: &[P], reference: &[f64]) -> f64 {
    let below = |point: &&[f64]| {
        point.len() == reference.len()
            && point.iter().zip(reference).all(|(p, r)| p < r && p.is_finite() && r.is_finite())
    };
    let points: Vec<&[f64]> = points.iter().map(AsRef::as_ref).filter(below).collect();
    sliced(points, reference)
}

fn sliced(mut points: Vec<&[f64]>, reference: &[f64]) -> f64 {
    let Some((&end, rest)) = reference.split_last() else {
        return 0.0;
    };
    let last = |point: &[f64]| point.last().copied().unwrap_or(end);
    points.sort_by(|a, b| last(a).total_cmp(&last(b)));
    if rest.is_empty() {
        return points.first().map_or(0.0, |point| end - last(point));
    }
    if rest.len() == 1 {
        return staircase(&points, reference);
    }
    let mut volume = 0.0;
    for (index, point) in points.iter().enumerate() {
        let next = points.get(index + 1).map_or(end, |point| last(point));
        let height = next - last(point);
        if height > 0.0 {
            let slice = points[..=index].iter().map(|point| &point[..rest.len()]).collect();
            volume += height * sliced(slice, rest);
        }
    }
    volume
}

/// Area under points ordered by their second objective.
fn staircase(points: &[&[f64]], reference: &[f64]) -> f64 {
    let (mut area, mut left, mut low) = (0.0, reference[0], None::<f64>);
    for point in points {
        area += low.map_or(0.0, |low| (point[1] - low) * (reference[0] - left));
        low = Some(point[1]);
        left = left.min(point[0]);
    }
    area + low.map_or(0.0, |low| (reference[1] - low) * (reference[0] - left))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_point_dominates_a_box() {
        assert_eq!(hypervolume(&[[0.25, 0.5]], &[1.0, 1.0]), 0.375);
        assert_eq!(hypervolume(&[[0.5, 0.5, 0.75]], &[1.0, 1.0, 1.0]), 0.0625);
        assert_eq!(hypervolume(&[[0.5; 4]], &[1.0; 4]), 0.0625);
    }

    #[test]
    fn boxes_that_overlap_count_once() {
        // Two squares of 1 by 2 that share 1 by 1; three boxes by inclusion and exclusion.
        assert_eq!(hypervolume(&[[0.0, 1.0], [1.0, 0.0]], &[2.0, 2.0]), 3.0);
        let corners = [[0.0, 1.0, 1.0], [1.0, 0.0, 1.0], [1.0, 1.0, 0.0]];
        assert_eq!(hypervolume(&corners, &[2.0; 3]), 3.0 * 2.0 - 3.0 + 1.0);
    }

    #[test]
    fn a_dense_line_has_half_the_square_and_a_dense_plane_a_sixth_of_the_cube_less() {
        let n = 200;
        let line: Vec<_> =
            (0..=n).map(|i| [i as f64 / n as f64, 1.0 - i as f64 / n as f64]).collect();
        // The steps of a staircase with n squares are missing: 1/2 - 1/(2n).
        assert!((hypervolume(&line, &[1.0, 1.0]) - (0.5 - 0.5 / n as f64)).abs() < 1e-12);
        let m = 40usize;
        let part = |i: usize| i as f64 / m as f64;
        let plane: Vec<_> = (0..=m)
            .flat_map(|i| (0..=m - i).map(move |j| [part(i), part(j), part(m - i - j)]))
            .collect();
        // Of m³ cubes those with i + j + k < m are not dominated: m (m + 1) (m + 2) / 6.
        let free = (m * (m + 1) * (m + 2)) as f64 / 6.0;
        let expected = 1.0 - free / (m * m * m) as f64;
        assert!((hypervolume(&plane, &[1.0; 3]) - expected).abs() < 1e-12);
    }

    #[test]
    fn what_does_not_reach_below_the_reference_adds_nothing() {
        let points =
            [[0.5, 0.5], [2.0, 0.0], [f64::NAN, 0.0], [f64::NEG_INFINITY, 0.0], [1.0, 0.2]];
        assert_eq!(hypervolume(&points, &[1.0, 1.0]), 0.25);
        assert_eq!(hypervolume::<[f64; 2]>(&[], &[1.0, 1.0]), 0.0);
        assert_eq!(hypervolume(&[[0.5, 0.5]], &[1.0; 3]), 0.0);
    }
}
