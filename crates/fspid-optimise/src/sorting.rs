//! Ranks and crowding of trade-offs (Deb, Pratap, Agarwal and Meyarivan, IEEE Transactions on
//! Evolutionary Computation 6, 2002, section III).

use std::cmp::Ordering;

/// Less when `a` dominates `b`: nowhere worse and somewhere better; all objectives are minimised.
/// Nothing when neither dominates.
pub(super) fn order(a: &[f64], b: &[f64]) -> Option<Ordering> {
    let (mut better, mut worse) = (false, false);
    for (a, b) in a.iter().zip(b) {
        better |= a < b;
        worse |= a > b;
    }
    match (better, worse) {
        (true, false) => Some(Ordering::Less),
        (false, true) => Some(Ordering::Greater),
        (false, false) => Some(Ordering::Equal),
        (true, true) => None,
    }
}

/// Indices by rank: what nothing dominates first, then what only those dominate, and so on.
pub(super) fn fronts(objectives: &[&[f64]]) -> Vec<Vec<usize>> {
    let count = objectives.len();
    let mut below = vec![Vec::new(); count];
    let mut above = vec![0_usize; count];
    for i in 0..count {
        for j in i + 1..count {
            match order(objectives[i], objectives[j]) {
                Some(Ordering::Less) => {
                    below[i].push(j);
                    above[j] += 1;
                }
                Some(Ordering::Greater) => {
                    below[j].push(i);
                    above[i] += 1;
                }
                _ => {}
            }
        }
    }
    let mut fronts = Vec::new();
    let mut front: Vec<usize> = (0..count).filter(|&i| above[i] == 0).collect();
    while !front.is_empty() {
        let mut next = Vec::new();
        for &j in front.iter().flat_map(|&i| &below[i]) {
            above[j] -= 1;
            if above[j] == 0 {
                next.push(j);
            }
        }
        next.sort_unstable();
        fronts.push(std::mem::replace(&mut front, next));
    }
    fronts
}

/// Crowding distance of each of a front: the sides of the box between its neighbours, in shares of
/// the front's extent; infinite at the ends of each objective. What equals another in all objectives
/// has no distance: one of the two is enough.
pub(super) fn crowding(objectives: &[&[f64]], front: &[usize]) -> Vec<f64> {
    let mut distance = vec![0.0; front.len()];
    let kinds = front.first().map_or(0, |&i| objectives[i].len());
    let along = |kind: usize| front.iter().map(|&i| objectives[i][kind]).collect::<Vec<f64>>();
    for values in (0..kinds).map(along) {
        crowd_along(&values, &mut distance);
    }
    for repeated in repeated(objectives, front) {
        distance[repeated] = 0.0;
    }
    distance
}

/// Adds what one objective contributes.
fn crowd_along(values: &[f64], distance: &mut [f64]) {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|&a, &b| values[a].total_cmp(&values[b]));
    let (Some(&first), Some(&last)) = (order.first(), order.last()) else {
        return;
    };
    let extent = values[last] - values[first];
    (distance[first], distance[last]) = (f64::INFINITY, f64::INFINITY);
    // Nothing to share out where all are equal or one is infinite.
    if extent > 0.0 && extent.is_finite() {
        for three in order.windows(3) {
            distance[three[1]] += (values[three[2]] - values[three[0]]) / extent;
        }
    }
}

/// Places in the front of what stands there already.
fn repeated(objectives: &[&[f64]], front: &[usize]) -> Vec<usize> {
    let mut order: Vec<usize> = (0..front.len()).collect();
    let objectives = |place: usize| objectives[front[place]];
    order.sort_by(|&a, &b| {
        let pairs = objectives(a).iter().zip(objectives(b));
        pairs.map(|(a, b)| a.total_cmp(b)).find(|o| o.is_ne()).unwrap_or(Ordering::Equal)
    });
    let same = order.windows(2).filter(|two| objectives(two[0]) == objectives(two[1]));
    same.map(|two| two[1]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranks_are_those_of_the_definition() {
        let points: [&[f64]; 6] =
            [&[1.0, 1.0], &[0.0, 2.0], &[2.0, 2.0], &[2.0, 0.0], &[3.0, 3.0], &[1.0, 1.0]];
        assert_eq!(fronts(&points), [vec![0, 1, 3, 5], vec![2], vec![4]]);
    }

    #[test]
    fn the_ends_are_never_crowded_and_the_middle_has_the_sides_of_its_box() {
        let points: [&[f64]; 4] = [&[0.0, 4.0], &[1.0, 2.0], &[2.0, 1.0], &[4.0, 0.0]];
        let distance = crowding(&points, &[0, 1, 2, 3]);
        assert_eq!(distance, [f64::INFINITY, 0.5 + 0.75, 0.75 + 0.5, f64::INFINITY]);
    }

    #[test]
    fn what_stands_twice_counts_once() {
        let points: [&[f64]; 4] = [&[0.0, 4.0], &[2.0, 2.0], &[0.0, 4.0], &[4.0, 0.0]];
        assert_eq!(crowding(&points, &[0, 1, 2, 3])[2], 0.0);
        assert_eq!(crowding(&points, &[0, 1, 2, 3])[0], f64::INFINITY);
    }

    #[test]
    fn infinite_objectives_are_dominated_and_crowd_nothing() {
        assert_eq!(order(&[0.0, 0.0], &[f64::INFINITY, 0.0]), Some(Ordering::Less));
        let points: [&[f64]; 3] = [&[0.0, f64::INFINITY], &[1.0, f64::INFINITY], &[2.0, 3.0]];
        assert!(crowding(&points, &[0, 1, 2]).iter().all(|d| !d.is_nan()));
    }
}
