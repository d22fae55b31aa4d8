//! Student's distribution, for intervals and tests with few cases and seeds.

use fspid_campaign::statistics::beta;

/// Halvings of a bracket: more than a double has digits.
const HALVINGS: usize = 200;

/// The chance to lie at least so far from 0 on either side.
///
/// $$ P(|T| \ge t) = I_x(\nu / 2, 1 / 2), \quad x = \frac{\nu}{\nu + t^2} $$
///
/// 1 where a number is NaN: nothing is then known.
///
/// # Source
/// NIST Digital Library of Mathematical Functions, 8.17.
pub(crate) fn two_sided(t: f64, freedom: f64) -> f64 {
    if !(freedom > 0.0) || t.is_nan() {
        return 1.0;
    }
    if t.is_infinite() {
        return 0.0;
    }
    let (x, rest) = (freedom / (freedom + t * t), t * t / (freedom + t * t));
    beta::at_most(freedom / 2.0, 0.5, (x, rest))
}

/// The distance from 0 that is exceeded on either side with this chance.
pub(crate) fn beyond(chance: f64, freedom: f64) -> f64 {
    let mut upper = 1.0;
    while two_sided(upper, freedom) > chance && upper < 1e300 {
        upper *= 2.0;
    }
    let mut lower = 0.0;
    for _ in 0..HALVINGS {
        let middle = 0.5 * (lower + upper);
        match two_sided(middle, freedom) > chance {
            true => lower = middle,
            false => upper = middle,
        }
    }
    0.5 * (lower + upper)
}
