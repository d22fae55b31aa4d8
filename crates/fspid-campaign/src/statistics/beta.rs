//! The incomplete beta function, behind the distributions of Student and of ratios of variances.

/// Steps of the continued fraction; it settles within some tens for every number of degrees of freedom here.
const MOST_STEPS: usize = 10_000;

/// The chance that a number of the beta distribution is at most `x`; `rest` is 1 - x without its rounding.
///
/// # Source
/// NIST Digital Library of Mathematical Functions, 8.17; the continued fraction of 8.17.22, summed as Lentz (1976) and
/// Thompson and Barnett (1986) do.
#[must_use]
pub fn at_most(a: f64, b: f64, (x, rest): (f64, f64)) -> f64 {
    // The fraction converges fast on the side of the mean.
    let share = match x < (a + 1.0) / (a + b + 2.0) {
        true => incomplete(a, b, (x, rest)),
        false => 1.0 - incomplete(b, a, (rest, x)),
    };
    share.clamp(0.0, 1.0)
}

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
