//! Where a function that is monotone between known places changes its sign.

/// Halvings of an interval of frequencies; from eighteen decades fewer are needed.
const HALVINGS_MAX: usize = 200;

/// All sign changes of a function between two frequencies, rising; it is monotone between its turns.
pub(super) fn all(
    function: impl Fn(f64) -> f64,
    turns_rad_s: &[f64],
    (low, high): (f64, f64),
) -> Vec<f64> {
    let inside = turns_rad_s.iter().copied().filter(|&turn| low < turn && turn < high);
    let ends: Vec<f64> = core::iter::once(low).chain(inside).chain([high]).collect();
    let mut found: Vec<f64> =
        ends.windows(2).filter_map(|pair| between(&function, pair[0], pair[1])).collect();
    found.dedup();
    found
}

/// The sign change between two frequencies, if there is one; by halving their ratio, then their distance.
fn between(function: &impl Fn(f64) -> f64, mut low: f64, mut high: f64) -> Option<f64> {
    let (first, last) = (function(low), function(high));
    if first == 0.0 {
        return Some(low);
    }
    if !(first < 0.0 && last > 0.0 || first > 0.0 && last < 0.0) {
        return None;
    }
    for _ in 0..HALVINGS_MAX {
        let middle = middle(low, high);
        if middle <= low || middle >= high {
            break;
        }
        if (function(middle) > 0.0) == (first > 0.0) { low = middle } else { high = middle }
    }
    Some(if function(low).abs() <= function(high).abs() { low } else { high })
}

fn middle(low: f64, high: f64) -> f64 {
    if high > 2.0 * low { (low * high).sqrt() } else { 0.5 * (low + high) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_count_once_from_the_lower_end_up_to_below_the_upper_one() {
        for sign in [1.0, -1.0] {
            let line = |zero: f64| move |x: f64| sign * (x - zero);
            for turns in [vec![], vec![2.0], vec![1.0, 2.0, 3.0]] {
                assert_eq!(all(line(1.0), &turns, (1.0, 3.0)), [1.0]);
                assert_eq!(all(line(2.0), &turns, (1.0, 3.0)), [2.0]);
                assert_eq!(
                    all(line(3.0), &turns, (1.0, 3.0)),
                    [0.0; 0],
                    "the upper end is outside"
                );
            }
            // A turn below the band would make a part of what lies outside.
            assert_eq!(all(line(1.0), &[0.5], (2.0, 3.0)), [0.0; 0]);
        }
    }

    #[test]
    fn two_hundred_decades_are_halved_by_their_ratio() {
        for zero in [1e-90, 1.0, 1e90] {
            let found = all(|x| x - zero, &[], (1e-100, 1e100));
            assert!(found.len() == 1 && (found[0] / zero - 1.0).abs() < 1e-15, "{found:?}");
        }
    }
}
