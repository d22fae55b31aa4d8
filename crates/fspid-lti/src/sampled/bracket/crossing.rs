//! Rigorous enclosures of the zeros of polynomials (crossover frequencies), around approximations that are found in ordinary
//! arithmetic.

use core::f64::consts::PI;

use super::number::Number;
use super::real::value_at;
use super::sign::{self, Between};
use super::{ABOVE, angle_of, place_of};
use crate::sampled::scan;

/// Halvings of the place of a crossing.
const HALVINGS: usize = 80;
/// Crossings whose angles differ by less than this share are one.
const SAME_PLACE: f64 = 1e-6;

/// Angles of zeros of a polynomial: those given, those that are proved and not among them, and in place of given ones
/// that are off by more than 10⁻⁹ those that are proved.
pub(super) fn completed<T: Number>(
    mut given: Vec<f64>,
    ends: (f64, f64),
    polynomial: &[T],
) -> Vec<f64> {
    let near = |angle_rad: f64, other: f64| (angle_rad - other).abs() <= SAME_PLACE * other;
    for between in sign::zeros(polynomial) {
        let [low, high] = [between.low, between.high].map(angle_of);
        let inside = low * (1.0 - SAME_PLACE)..=high * (1.0 + SAME_PLACE);
        let mut known = given.iter_mut().filter(|known| inside.contains(*known));
        let only = match (known.next(), known.next()) {
            (Some(only), None) => Some(only),
            _ => None,
        };
        if only.as_ref().is_some_and(|only| changes_around(polynomial, **only)) {
            continue;
        }
        let angle_rad = angle_of(zero(polynomial, between));
        match only {
            // Another zero that lies beside is not this one.
            Some(only) if near(*only, angle_rad) => *only = angle_rad,
            _ => {
                let allowed = ends.0 <= angle_rad && angle_rad <= ends.1;
                if allowed && !given.iter().any(|&known| near(angle_rad, known)) {
                    given.push(angle_rad);
                }
            }
        }
    }
    given.sort_by(f64::total_cmp);
    given
}

/// Whether a polynomial is proved to change its sign within 10⁻⁹ of an angle.
pub(super) fn changes_around<T: Number>(polynomial: &[T], angle_rad: f64) -> bool {
    let [before, after] = [1.0 - ABOVE, 1.0 + ABOVE]
        .map(|share| value_at(polynomial, place_of((angle_rad * share).min(PI))));
    before.positive() && after.negative() || before.negative() && after.positive()
}

/// The zero between two places, by halving; the middle where no sign is told.
fn zero<T: Number>(polynomial: &[T], Between { mut low, mut high }: Between) -> f64 {
    let rises = value_at(polynomial, low).negative();
    for _ in 0..HALVINGS {
        let middle = scan::middle(low, high);
        if !(low < middle && middle < high) {
            break;
        }
        let there = value_at(polynomial, middle);
        if !(there.positive() || there.negative()) {
            return middle;
        }
        if there.negative() == rises { low = middle } else { high = middle }
    }
    scan::middle(low, high)
}
