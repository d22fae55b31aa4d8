//! Between the throttle and the power of an engine, and how power follows.

/// What the throttle does to the power that an engine is asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Gearing {
    /// Power is the throttle's part of its travel. Also for an engine with a lag, whose power comes in as throttle.
    #[default]
    Proportional,
    /// That of the F-16 model: dry power up to 0.77 of the travel, afterburner above.
    StevensLewis,
}

impl Gearing {
    /// Power, 0 to 1, that is asked for by a throttle from 0 to 1.
    ///
    /// $$ P = 0.6494 \delta \ \text{for}\ \delta \le 0.77, \quad 2.1738 \delta - 1.1738 \ \text{above} $$
    ///
    /// # Source
    /// Stevens and Lewis, *Aircraft Control and Simulation*, appendix A, `TGEAR`; NASA TM-2003-212145.
    #[must_use]
    pub fn power(self, throttle: f64) -> f64 {
        match self {
            Self::Proportional => throttle,
            Self::StevensLewis if throttle <= 0.77 => 0.6494 * throttle,
            Self::StevensLewis => 2.1738 * throttle - 1.1738,
        }
    }

    /// The throttle that asks for a power: the inverse of [`power`](Self::power), which rises with the throttle.
    #[must_use]
    pub fn throttle(self, power: f64) -> f64 {
        match self {
            Self::Proportional => power,
            Self::StevensLewis if power <= 0.6494 * 0.77 => power / 0.6494,
            Self::StevensLewis => (power + 1.1738) / 2.1738,
        }
    }
}

/// How the power of an engine follows the one that is asked for.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Spool {
    /// At once.
    #[default]
    Instant,
    /// $\dot P = (P_t - P) / \tau$.
    FirstOrder {
        /// $\tau$, s.
        time_constant_s: f64,
    },
    /// That of the F-16 model: [`power_rate_per_s`].
    StevensLewis,
}

impl Spool {
    /// Rate of the power, 1/s.
    #[must_use]
    pub fn rate_per_s(self, power: f64, asked: f64) -> f64 {
        match self {
            Self::Instant => 0.0,
            Self::FirstOrder { time_constant_s } => (asked - power) / time_constant_s,
            Self::StevensLewis => power_rate_per_s(power, asked),
        }
    }
}

/// The border of the afterburner of the F-16's engine: across it the rate of the power jumps ([`power_rate_per_s`]).
pub const HALF_POWER: f64 = 0.5;

/// Rate in 1/s at which the power of the F-16's engine follows the one that is asked for, both from 0 to 1.
///
/// Across the border of the afterburner at 0.5 the engine is first led to 0.4 or 0.6.
///
/// $$ \dot P = \frac{P_t - P}{\tau}, \quad \frac{1}{\tau} = 5 \ \text{with afterburner, else}\ 1 \ldots 0.1
///    \ \text{as}\ P_t - P \ \text{goes from}\ 0.25 \ \text{to}\ 0.5 $$
///
/// # Source
/// Stevens and Lewis, *Aircraft Control and Simulation*, appendix A, `PDOT` and `RTAU`; NASA TM-2003-212145.
#[must_use]
pub fn power_rate_per_s(power: f64, asked: f64) -> f64 {
    let (target, quick) = match (asked >= HALF_POWER, power >= HALF_POWER) {
        (true, true) => (asked, true),
        (true, false) => (0.6, false),
        (false, true) => (0.4, true),
        (false, false) => (asked, false),
    };
    let per_s = if quick { 5.0 } else { dry_rate(target - power) };
    per_s * (target - power)
}

/// Inverse of the time constant without afterburner.
fn dry_rate(missing: f64) -> f64 {
    if missing <= 0.25 {
        1.0
    } else if missing >= 0.5 {
        0.1
    } else {
        1.9 - 3.6 * missing
    }
}

#[cfg(test)]
#[allow(clippy::float_cmp, reason = "numbers that are chosen so that nothing is rounded")]
mod tests {
    use super::*;

    #[test]
    fn the_two_parts_of_the_gearing_meet_within_the_digits_of_the_source() {
        let (dry, wet): (f64, f64) = (0.6494 * 0.77, 2.1738 * 0.77 - 1.1738);
        assert!((dry - wet).abs() < 2e-5);
        assert_eq!(Gearing::StevensLewis.power(1.0), 1.0);
        assert_eq!(Gearing::Proportional.power(0.3), 0.3);
    }

    #[test]
    fn the_throttle_of_a_power_asks_for_that_power() {
        for gearing in [Gearing::Proportional, Gearing::StevensLewis] {
            for step in 0..=20 {
                let power = f64::from(step) / 20.0;
                assert!((gearing.power(gearing.throttle(power)) - power).abs() < 1e-15, "{power}");
            }
        }
    }

    #[test]
    fn a_spool_of_first_order_takes_its_time_constant_and_an_instant_one_none() {
        assert_eq!(Spool::FirstOrder { time_constant_s: 4.0 }.rate_per_s(0.25, 0.75), 0.125);
        assert_eq!(Spool::Instant.rate_per_s(0.2, 0.6), 0.0);
        assert_eq!(Spool::StevensLewis.rate_per_s(0.8, 1.0), power_rate_per_s(0.8, 1.0));
    }

    #[test]
    fn power_follows_what_is_asked_and_then_rests() {
        assert_eq!(power_rate_per_s(0.3, 0.3), 0.0);
        assert!((power_rate_per_s(0.2, 0.3) - 0.1).abs() < 1e-15);
        assert!((power_rate_per_s(0.0, 0.45) - 0.45 * (1.9 - 3.6 * 0.45)).abs() < 1e-15);
        assert!((power_rate_per_s(0.0, 1.0) - 0.06).abs() < 1e-15);
        assert!((power_rate_per_s(0.8, 0.2) - -2.0).abs() < 1e-12);
        assert!((power_rate_per_s(0.8, 1.0) - 1.0).abs() < 1e-12);
    }
}
