//! Sign changes of a function between known candidate frequencies: bracketed roots.

/// Steps of one search; halving alone needs some sixty for all digits.
const STEPS_MAX: usize = 200;
/// A function that goes from one sign to the other without values below this size jumps.
const JUMP: f64 = 1e-3;

/// All sign changes of a function between two places, rising, tried at the candidates and between each two of them.
///
/// The function should be scaled to about 1. Places where it jumps, as a phase does at a pole on the unit circle, are
/// not zeros.
pub(super) fn sign_changes(
    function: impl Fn(f64) -> f64,
    candidates: &[f64],
    (low, high): (f64, f64),
) -> Vec<f64> {
    let places = with_middles(candidates, (low, high));
    let values: Vec<f64> = places.iter().map(|&place| function(place)).collect();
    let mut found = Vec::new();
    for (pair, ends) in places.windows(2).zip(values.windows(2)) {
        if ends[0] == 0.0 {
            found.push(pair[0]);
        } else if ends[0] < 0.0 && ends[1] > 0.0 || ends[0] > 0.0 && ends[1] < 0.0 {
            let (place, value) = root(&function, (pair[0], ends[0]), (pair[1], ends[1]));
            found.extend((value.abs() < JUMP).then_some(place));
        }
    }
    if let (Some(&place), Some(&value)) = (places.last(), values.last())
        && value == 0.0
    {
        found.push(place);
    }
    found
}

/// The ends, the candidates between them and a place between each two, rising.
pub(super) fn with_middles(candidates: &[f64], (low, high): (f64, f64)) -> Vec<f64> {
    let inside = candidates.iter().copied().filter(|&place| low < place && place < high);
    let mut places: Vec<f64> = inside.chain([low, high]).collect();
    places.sort_by(f64::total_cmp);
    places.dedup();
    let middles: Vec<f64> = places.windows(2).map(|pair| middle(pair[0], pair[1])).collect();
    places.extend(middles);
    places.sort_by(f64::total_cmp);
    places.dedup();
    places
}

/// Between two places; by their ratio where they lie far apart.
pub(super) fn middle(low: f64, high: f64) -> f64 {
    if low > 0.0 && high > 2.0 * low { (low * high).sqrt() } else { 0.5 * (low + high) }
}

/// The zero between two places with values of opposite signs, to the last digits, and the value there.
///
/// Inverse quadratic interpolation where it is safe, halving elsewhere.
///
/// # Source
/// T. R. Chandrupatla, A new hybrid quadratic/bisection algorithm for finding the zero of a nonlinear function without
/// using derivatives, Advances in Engineering Software 28 (1997) 145.
pub(super) fn root(
    function: &impl Fn(f64) -> f64,
    low: (f64, f64),
    high: (f64, f64),
) -> (f64, f64) {
    // The newest place, the one on the other side, and the one before.
    let (mut near, mut far) = (low, high);
    let mut share = 0.5;
    for _ in 0..STEPS_MAX {
        let place = near.0 + share * (far.0 - near.0);
        let value = function(place);
        if value == 0.0 {
            return (place, value);
        }
        let old;
        if (value > 0.0) == (near.1 > 0.0) {
            old = near;
        } else {
            old = far;
            far = near;
        }
        near = (place, value);
        let best = near.0.abs().max(far.0.abs());
        let least = f64::EPSILON * best / (far.0 - near.0).abs();
        if !(least < 0.5) {
            break;
        }
        share = next_share(near, far, old).clamp(least, 1.0 - least);
    }
    if near.1.abs() < far.1.abs() { near } else { far }
}

/// Which part of the way from `near` to `far` to go next.
fn next_share(near: (f64, f64), far: (f64, f64), old: (f64, f64)) -> f64 {
    let (xi, phi) = ((near.0 - far.0) / (old.0 - far.0), (near.1 - far.1) / (old.1 - far.1));
    // Only then is the inverse parabola through the three monotone between them.
    if phi * phi < xi && (1.0 - phi) * (1.0 - phi) < 1.0 - xi {
        let first = near.1 / (far.1 - near.1) * (old.1 / (far.1 - old.1));
        let second = (old.0 - near.0) / (far.0 - near.0) * near.1 / (old.1 - near.1)
            * (far.1 / (old.1 - far.1));
        let share = first + second;
        if share.is_finite() { share } else { 0.5 }
    } else {
        0.5
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "the same bits are asked for")]
mod tests {
    use super::*;

    #[test]
    fn zeros_are_found_to_the_last_digits_between_rough_candidates() {
        let found = sign_changes(libm::sin, &[3.0, 6.5, 9.0], (1.0, 10.0));
        let expected = [1.0, 2.0, 3.0].map(|turns| turns * core::f64::consts::PI);
        assert_eq!(found.len(), 3, "{found:?}");
        for (found, expected) in found.iter().zip(expected) {
            assert!(
                (found - expected).abs() <= 2.0 * f64::EPSILON * expected,
                "{found} {expected}"
            );
        }
    }

    #[test]
    fn candidates_beyond_the_ends_are_left_out_and_each_part_has_a_middle() {
        assert_eq!(with_middles(&[0.5, 5.0, 1.0, 3.0], (1.0, 3.0)), [1.0, 3.0_f64.sqrt(), 3.0]);
        assert_eq!(with_middles(&[], (0.0, 1.0)), [0.0, 0.5, 1.0]);
        assert_eq!(with_middles(&[1.5], (1.0, 2.0)), [1.0, 1.25, 1.5, 1.75, 2.0]);
        assert_eq!(middle(-1.0, 3.0), 1.0);
    }

    #[test]
    fn two_zeros_around_a_candidate_are_told_apart() {
        let found = sign_changes(|x| (x - 2.0) * (x - 2.0) - 1e-12, &[2.0], (1.0, 3.0));
        assert_eq!(found.len(), 2, "{found:?}");
        assert!((found[1] - found[0] - 2e-6).abs() < 1e-9, "{found:?}");
    }

    #[test]
    fn zeros_at_candidates_and_ends_count_once_and_jumps_do_not_count() {
        assert_eq!(sign_changes(|x| x - 2.0, &[2.0], (1.0, 3.0)), vec![2.0]);
        assert_eq!(sign_changes(|x| x - 3.0, &[2.0], (1.0, 3.0)), vec![3.0]);
        assert_eq!(sign_changes(|x| x - 1.0, &[], (1.0, 3.0)), vec![1.0]);
        assert_eq!(sign_changes(|x| if x < 1.7 { -1.0 } else { 1.0 }, &[], (1.0, 3.0)), vec![]);
    }

    #[test]
    fn a_root_is_bracketed_however_flat_or_steep_the_function() {
        for power in [1, 3, 9] {
            let function =
                |x: f64| libm::pow((x - 0.3).abs(), f64::from(power)) * (x - 0.3).signum();
            let (place, _) = root(&function, (0.0, function(0.0)), (1.0, function(1.0)));
            assert!((place - 0.3).abs() < 1e-15, "{power}: {place}");
        }
        let steep = |x: f64| libm::atan(1e9 * (x - 0.3));
        let (place, _) = root(&steep, (0.0, steep(0.0)), (1.0, steep(1.0)));
        assert!((place - 0.3).abs() < 1e-15, "{place}");
    }
}
