//! Student's distribution, for intervals and tests with few cases and seeds.

/// Steps of the continued fraction; it settles within some tens for every number of degrees of freedom here.
const MOST_STEPS: usize = 10_000;
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
    let (a, b) = (freedom / 2.0, 0.5);
    // The fraction converges fast on the side of the mean.
    let share = match x < (a + 1.0) / (a + b + 2.0) {
        true => incomplete(a, b, (x, rest)),
        false => 1.0 - incomplete(b, a, (rest, x)),
    };
    share.clamp(0.0, 1.0)
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

/// The regularised incomplete beta function; `rest` is 1 - x without its rounding.
///
/// # Source
/// The continued fraction of DLMF 8.17.22, summed as Lentz (1976) and Thompson and Barnett (1986) do.
fn incomplete(a: f64, b: f64, (x, rest): (f64, f64)) -> f64 {
    if !(x > 0.0) {
        return 0.0;
    }
    const TINY: f64 = 1e-300;
    let kept = |value: f64| if value.abs() < TINY { TINY } else { value };
    let mut c = 1.0;
    let mut d = 1.0 / kept(1.0 - (a + b) * x / (a + 1.0));
    let mut fraction = d;
    for step in 1..=MOST_STEPS {
        let m = step as f64;
        let even = m * (b - m) * x / ((a + 2.0 * m - 1.0) * (a + 2.0 * m));
        d = 1.0 / kept(1.0 + even * d);
        c = kept(1.0 + even / c);
        fraction *= c * d;
        let odd = -(a + m) * (a + b + m) * x / ((a + 2.0 * m) * (a + 2.0 * m + 1.0));
        d = 1.0 / kept(1.0 + odd * d);
        c = kept(1.0 + odd / c);
        fraction *= c * d;
        if (c * d - 1.0).abs() < 1e-15 {
            break;
        }
    }
    let beta = libm::lgamma(a + b) - libm::lgamma(a) - libm::lgamma(b);
    let power = a * libm::log(x) + b * libm::log(rest);
    libm::exp(beta + power) * fraction / a
}
