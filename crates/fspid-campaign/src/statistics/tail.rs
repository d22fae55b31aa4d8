//! Tails of the binomial distribution and where they have a given size, to nearly full relative precision.
//!
//! A tail is its first probability times the sum of the others relative to it. The first comes from Loader's saddle-point
//! form, whose terms stay small where logarithms of factorials would cancel (with a million runs they are 10⁷ and leave nine
//! digits); the sum is a continued fraction of positive value.
//!
//! # Source
//! C. Loader, *Fast and Accurate Computation of Binomial Probabilities* (2000); NIST Digital Library of Mathematical
//! Functions, 8.17.5 (binomial tail as incomplete beta function).

use std::f64::consts::TAU;

/// A probability and what it lacks to 1, each to full precision.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Chance {
    /// Of a hit.
    pub(super) hit: f64,
    /// Of a miss.
    pub(super) miss: f64,
}

impl Chance {
    pub(super) fn of(hit: f64) -> Self {
        Self { hit, miss: 1.0 - hit }
    }

    fn mirrored(self) -> Self {
        Self { hit: self.miss, miss: self.hit }
    }

    /// The larger part follows from the smaller: it has no digits to spare.
    fn balanced(self) -> Self {
        if self.hit < self.miss { Self::of(self.hit) } else { Self::of(self.miss).mirrored() }
    }
}

/// Upper tail of the binomial distribution from `count` on: logarithm, and the tail as a multiple of its first probability.
#[derive(Clone, Copy)]
struct Tail {
    log: f64,
    ratio: f64,
}

/// Chance of at least `count` hits in `runs`, 0 to 1.
pub(super) fn at_least(count: f64, runs: f64, chance: Chance) -> f64 {
    if count <= 0.0 {
        1.0
    } else if count > runs || chance.hit <= 0.0 {
        0.0
    } else if chance.miss <= 0.0 {
        1.0
    } else if count > (runs + 1.0) * chance.hit {
        libm::exp(upper_tail(count, runs, chance).log).min(1.0)
    } else {
        // Below the middle the tail is nearly everything; what is missing is the one with all its digits.
        let missing = upper_tail(runs - count + 1.0, runs, chance.mirrored());
        (1.0 - libm::exp(missing.log)).max(0.0)
    }
}

/// Chance of at most `count` hits in `runs`, 0 to 1.
pub(super) fn at_most(count: f64, runs: f64, chance: Chance) -> f64 {
    at_least(runs - count, runs, chance.mirrored())
}

/// The chance of a hit at which at least `count` of `runs` hit with the probability `wanted`, for `count` from 1 to `runs`.
pub(super) fn solve(count: f64, runs: f64, wanted: Chance) -> Chance {
    if wanted.hit <= 0.5 {
        smaller(count, runs, libm::log(wanted.hit))
    } else {
        // Too few hits are the rarer outcome.
        smaller(runs - count + 1.0, runs, libm::log(wanted.miss)).mirrored()
    }
}

/// Where the logarithm of a tail of at most one half has the value `wanted`.
///
/// Newton's method for the logarithm of the tail over the logarithm of the chance. That curve rises and is concave (the beta
/// density is log-concave for whole `count`), so its tangents meet what is wanted left of the solution: from the first step
/// on the iteration climbs towards it and cannot escape.
fn smaller(count: f64, runs: f64, wanted: f64) -> Chance {
    if count >= runs {
        // All hit: chance^runs.
        return Chance { hit: libm::exp(wanted / runs), miss: -libm::expm1(wanted / runs) };
    }
    // About where the tail is one half.
    let whole = runs + 1.0 / 3.0;
    let mut chance =
        Chance { hit: (count - 1.0 / 3.0) / whole, miss: (runs - count + 2.0 / 3.0) / whole };
    for _ in 0..STEPS {
        let tail = upper_tail(count, runs, chance);
        // d ln tail / d ln chance = count / ratio.
        let step = (wanted - tail.log) * tail.ratio / count;
        let miss = (chance.miss - chance.hit * libm::expm1(step)).clamp(0.0, 1.0);
        let change = (chance.hit * step).abs() / chance.hit.min(miss);
        // A first step from far off may fall below the least double.
        let hit = (chance.hit * libm::exp(step)).max(f64::MIN_POSITIVE);
        chance = Chance { hit, miss }.balanced();
        if !(change > ENOUGH) {
            break;
        }
    }
    chance
}

/// Newton's method took 6 or 7 steps from 100 to 10¹² runs; this only ends what rounding keeps going.
const STEPS: u32 = 100;

/// The error after a step is about its square, times at most 10³ for a million runs.
const ENOUGH: f64 = 1e-11;

/// Of at least `count` hits, for `count` from 1 to `runs` and a chance inside (0, 1).
fn upper_tail(count: f64, runs: f64, chance: Chance) -> Tail {
    let ratio = chance.miss * fraction(count, runs - count + 1.0, chance);
    Tail { log: log_probability(count, runs, chance) + libm::log(ratio), ratio }
}

/// Logarithm of the chance of exactly `count` hits in `runs`.
///
/// $$ \ln p = \delta(n) - \delta(k) - \delta(n-k) - D(k, np) - D(n-k, nq) + \tfrac{1}{2} \ln \frac{n}{2 \pi k (n-k)} $$
fn log_probability(count: f64, runs: f64, chance: Chance) -> f64 {
    let misses = runs - count;
    if count <= 0.0 {
        return runs * libm::log1p(-chance.hit);
    }
    if misses <= 0.0 {
        return runs * libm::log1p(-chance.miss);
    }
    let stirling = stirling_error(runs) - stirling_error(count) - stirling_error(misses);
    let deviance = deviance(count, runs * chance.hit) + deviance(misses, runs * chance.miss);
    stirling - deviance - 0.5 * libm::log(TAU * count * (misses / runs))
}

/// What Stirling's formula lacks: $\delta(n) = \ln n! - (n + 1/2) \ln n + n - \ln \sqrt{2 \pi}$.
fn stirling_error(n: f64) -> f64 {
    if let Some(&error) = STIRLING_ERRORS.get(n as usize - 1) {
        return error;
    }
    // Bernoulli numbers B₂ⱼ / (2j (2j − 1)); from 16 on the sixth term is below 1e-16.
    let square = n * n;
    let terms = [1.0 / 12.0, -1.0 / 360.0, 1.0 / 1260.0, -1.0 / 1680.0, 1.0 / 1188.0];
    terms.iter().rev().fold(0.0, |sum, term| sum / square + term) / n
}

/// [`stirling_error`] of 1 to 15, from its definition in 60 digits.
const STIRLING_ERRORS: [f64; 15] = [
    0.08106146679532726,
    0.0413406959554093,
    0.02767792568499834,
    0.020790672103765093,
    0.016644691189821193,
    0.013876128823070748,
    0.01189670994589177,
    0.010411265261972096,
    0.009255462182712733,
    0.00833056343336287,
    0.007573675487951841,
    0.00694284010720953,
    0.006408994188004207,
    0.0059513701127588475,
    0.005554733551962801,
];

/// How far `found` is from `expected`, zero where they agree: $D(x, m) = x \ln (x / m) + m - x$.
fn deviance(found: f64, expected: f64) -> f64 {
    let off = (found - expected) / (found + expected);
    if off.abs() > 0.1 {
        return found * libm::log(found / expected) + expected - found;
    }
    // ln (x / m) = 2 artanh v with v = (x − m) / (x + m); the ninth term of the series is below 1e-17 of the first.
    let square = off * off;
    let series = (1..=8).rev().fold(0.0, |sum, term| sum * square + 1.0 / f64::from(2 * term + 1));
    (found - expected) * off + 2.0 * found * off * square * series
}

/// What the first probability, over the chance of a miss, is multiplied with to give the tail: a continued fraction of the
/// incomplete beta function $I_x(a, b)$, evaluated from its front.
///
/// $$ \frac{a}{\beta_0 +} \frac{\alpha_1}{\beta_1 +} \frac{\alpha_2}{\beta_2 +} \cdots, \quad
/// \alpha_m = \frac{(a+m-1)(a+b+m-1) m (b-m) x^2}{(a+2m-1)^2}, $$
/// $$ \beta_m = m + \frac{m (b-m) x}{a+2m-1} + \frac{(a+m) (a (1-x) - b x + 1 + m (2-x))}{a+2m+1} $$
///
/// All terms are positive up to the middle of the distribution, so that nothing cancels; it ends at $m = b$ at the latest
/// and otherwise takes of the order of $\sqrt n$ terms.
///
/// # Source
/// A. R. DiDonato, A. H. Morris, *Significant Digit Computation of the Incomplete Beta Function Ratios*, ACM Transactions on
/// Mathematical Software 18 (1992); W. J. Lentz, Applied Optics 15 (1976), for the evaluation from the front.
fn fraction(a: f64, b: f64, chance: Chance) -> f64 {
    let x = chance.hit;
    let lead = a * chance.miss - b * x + 1.0;
    let mut value = a * lead / (a + 1.0);
    let (mut above, mut below) = (value, 0.0);
    for m in 1..TERMS {
        let m = f64::from(m);
        let odd = a + 2.0 * m - 1.0;
        let share = m * (b - m) * x / odd;
        let alpha = (a + m - 1.0) / odd * (a + b + m - 1.0) * x * share;
        let beta = m + share + (a + m) * (lead + m * (2.0 - x)) / (a + 2.0 * m + 1.0);
        above = beta + alpha / above;
        below = 1.0 / (beta + alpha * below);
        let change = above * below;
        value *= change;
        if !((change - 1.0).abs() > 2.0 * f64::EPSILON) {
            break;
        }
    }
    a / value
}

/// In the middle of 10⁸ and 10¹² runs it took 2027 and 42 589; this only ends what rounding keeps going.
const TERMS: u32 = 1_000_000;

#[cfg(test)]
mod tests {
    use super::*;

    /// By adding up the probabilities, each from the one before: independent of the continued fraction.
    fn summed(count: u32, runs: u32, hit: f64) -> f64 {
        let mut probability = libm::pow(1.0 - hit, f64::from(runs));
        let mut sum = 0.0;
        for hits in 0..=runs {
            if hits >= count {
                sum += probability;
            }
            probability *= f64::from(runs - hits) / f64::from(hits + 1) * hit / (1.0 - hit);
        }
        sum
    }

    #[test]
    fn a_tail_is_the_sum_of_its_probabilities() {
        for runs in [1, 2, 3, 7, 15, 16, 17, 40, 200] {
            for count in 0..=runs {
                for hit in [1e-3, 0.1, 0.37, 0.5, 0.81] {
                    let found = at_least(f64::from(count), f64::from(runs), Chance::of(hit));
                    let expected = summed(count, runs, hit);
                    // Below it doubles lose digits.
                    if expected < 1e-300 {
                        continue;
                    }
                    // 200 rounded products in the sum, a last place of its logarithm in the tail.
                    let tolerance = 5e-14 - 2e-15 * libm::log(expected);
                    let off = (found / expected - 1.0).abs();
                    assert!(off < tolerance, "{count} of {runs} at {hit}: {found} {expected}");
                }
            }
        }
    }

    #[test]
    fn the_two_tails_make_one() {
        for (count, runs, hit) in
            [(3.0, 10.0, 0.3), (499_000.0, 1e6, 0.5), (12.0, 1e6, 1e-5), (999_990.0, 1e6, 0.99999)]
        {
            let chance = Chance::of(hit);
            let sum = at_least(count, runs, chance) + at_most(count - 1.0, runs, chance);
            assert!((sum - 1.0).abs() < 1e-15, "{count} {runs} {hit}: {sum}");
        }
    }

    #[test]
    fn a_certain_hit_and_a_certain_miss_leave_no_doubt() {
        let (never, always) = (Chance::of(0.0), Chance::of(1.0));
        assert_eq!((at_least(1.0, 5.0, never), at_most(0.0, 5.0, never)), (0.0, 1.0));
        assert_eq!((at_least(5.0, 5.0, always), at_most(4.0, 5.0, always)), (1.0, 0.0));
        assert_eq!((at_least(0.0, 5.0, never), at_least(6.0, 5.0, always)), (1.0, 0.0));
    }

    #[test]
    fn the_solution_has_the_tail_that_was_wanted() {
        for (count, runs) in [
            (1.0, 2.0),
            (2.0, 3.0),
            (7.0, 40.0),
            (39.0, 40.0),
            (1.0, 1e6),
            (5e5, 1e6),
            (999_999.0, 1e6),
        ] {
            for wanted in [1e-300, 1e-9, 0.025, 0.5, 0.9] {
                let chance = solve(count, runs, Chance::of(wanted));
                let found = at_least(count, runs, chance);
                // A last place of the chance is up to count last places of the tail.
                assert!((found / wanted - 1.0).abs() < 1e-9, "{count} of {runs}: {found} {wanted}");
                assert_eq!(chance.hit + chance.miss, 1.0);
            }
        }
    }
}
