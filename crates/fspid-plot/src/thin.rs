//! Fewer points for the same picture.
//!
//! A trace may have a hundred thousand samples where the panel has six hundred pixels. Per half pixel
//! only the first, smallest, largest and last point stay, so no peak is lost; then points that lie on
//! the line between their neighbours go.

/// Width of a column in which only four points stay (px).
const COLUMN_PX: f64 = 0.5;
/// Greatest distance of a dropped point from the drawn line (px).
const TOLERANCE_PX: f64 = 0.06;

/// Runs of finite points, thinned; a non-finite point ends a run.
///
/// `scale` is px per unit in x and y. With `stairs` each value is held until the next point.
pub(super) fn runs(
    points: impl Iterator<Item = (f64, f64)>,
    scale: (f64, f64),
    stairs: bool,
) -> Vec<Vec<(f64, f64)>> {
    let mut runs = Vec::new();
    let mut run: Vec<(f64, f64)> = Vec::new();
    for (x, y) in points {
        if !(x.is_finite() && y.is_finite()) {
            runs.push(std::mem::take(&mut run));
            continue;
        }
        if let Some(&(_, held)) = run.last().filter(|_| stairs) {
            run.push((x, held));
        }
        run.push((x, y));
    }
    runs.push(run);
    runs.retain(|run| !run.is_empty());
    runs.iter().map(|run| straighten(&columns(run, scale.0), scale)).collect()
}

/// First, smallest, largest and last point of each column of pixels, in their order.
fn columns(run: &[(f64, f64)], px_per_x: f64) -> Vec<(f64, f64)> {
    let monotone = run.windows(2).all(|pair| matches!(pair, [a, b] if a.0 <= b.0));
    if !monotone || run.len() < 500 {
        return run.to_vec();
    }
    let column = |x: f64| (x * px_per_x / COLUMN_PX).floor();
    let mut kept = Vec::new();
    for group in run.chunk_by(|a, b| column(a.0).total_cmp(&column(b.0)).is_eq()) {
        let by_height =
            |a: &(usize, &(f64, f64)), b: &(usize, &(f64, f64))| a.1.1.total_cmp(&b.1.1);
        let lowest = group.iter().enumerate().min_by(by_height).map_or(0, |found| found.0);
        let highest = group.iter().enumerate().max_by(by_height).map_or(0, |found| found.0);
        let mut indices = [0, lowest, highest, group.len() - 1];
        indices.sort_unstable();
        let mut last = None;
        for index in indices {
            if last != Some(index) {
                kept.extend(group.get(index));
                last = Some(index);
            }
        }
    }
    kept
}

/// Douglas and Peucker's line simplification, without recursion.
fn straighten(points: &[(f64, f64)], scale: (f64, f64)) -> Vec<(f64, f64)> {
    if points.len() < 3 {
        return points.to_vec();
    }
    let mut keep = vec![false; points.len()];
    let mut open = vec![(0, points.len() - 1)];
    for (first, last) in [(0, 0), (points.len() - 1, points.len() - 1)] {
        keep[first.max(last)] = true;
    }
    while let Some((first, last)) = open.pop() {
        let farthest = (first + 1..last)
            .map(|i| (distance_px(points[i], points[first], points[last], scale), i))
            .max_by(|a, b| a.0.total_cmp(&b.0));
        if let Some((distance, index)) = farthest.filter(|found| found.0 > TOLERANCE_PX) {
            debug_assert!(distance > 0.0);
            keep[index] = true;
            open.push((first, index));
            open.push((index, last));
        }
    }
    points.iter().zip(keep).filter_map(|(point, keep)| keep.then_some(*point)).collect()
}

/// Distance of `p` from the segment `a` to `b` (px).
fn distance_px(p: (f64, f64), a: (f64, f64), b: (f64, f64), scale: (f64, f64)) -> f64 {
    let (dx, dy) = ((b.0 - a.0) * scale.0, (b.1 - a.1) * scale.1);
    let (px, py) = ((p.0 - a.0) * scale.0, (p.1 - a.1) * scale.1);
    let length = dx * dx + dy * dy;
    let along = if length > 0.0 { ((px * dx + py * dy) / length).clamp(0.0, 1.0) } else { 0.0 };
    let (ex, ey) = (px - along * dx, py - along * dy);
    (ex * ex + ey * ey).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_single_peak_in_a_hundred_thousand_samples_survives() {
        let y = |i: u32| {
            if i == 54_321 { 7.0 } else { f64::from(i).sin() * 0.1 }
        };
        let kept = runs((0..100_000).map(|i| (f64::from(i) * 1e-3, y(i))), (6.0, 30.0), false);
        assert_eq!(kept.len(), 1);
        assert!(kept[0].len() < 6_000, "{}", kept[0].len());
        assert!(kept[0].iter().any(|point| point.1 > 6.9));
    }

    #[test]
    fn a_straight_line_needs_two_points() {
        let kept = runs((0..5_000).map(|i| (f64::from(i), 2.0 * f64::from(i))), (0.1, 0.1), false);
        assert_eq!(kept, [[(0.0, 0.0), (4_999.0, 9_998.0)]]);
    }

    #[test]
    fn a_point_that_is_not_finite_breaks_the_line() {
        let points = [(0.0, 0.0), (1.0, 1.0), (2.0, f64::NAN), (3.0, 0.0), (f64::INFINITY, 1.0)];
        assert_eq!(runs(points.into_iter(), (10.0, 10.0), false).len(), 2);
        assert!(runs(std::iter::empty(), (1.0, 1.0), false).is_empty());
    }

    #[test]
    fn stairs_hold_each_value_until_the_next_sample() {
        let kept = runs([(0.0, 1.0), (1.0, 2.0)].into_iter(), (10.0, 10.0), true);
        assert_eq!(kept, [[(0.0, 1.0), (1.0, 1.0), (1.0, 2.0)]]);
    }
}
