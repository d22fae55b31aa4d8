//! How an actuator follows its command where no limit holds it.

use fspid_lti::TransferFunction;

use crate::error::{SimError, positive};

/// The linear part of an actuator, from command v to position x.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Lag(Kind);

#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    None,
    First { time_constant_s: f64 },
    Second { natural_frequency_rad_s: f64, damping: f64 },
}

/// Of $1 / \omega_n$: length of a piece that the response of second order is computed in.
const PIECE: f64 = 1.0 / 16.0;
/// Terms of its series; a piece leaves less than 10⁻¹⁸ behind them.
pub(crate) const TERMS: usize = 11;

impl Lag {
    /// No lag: the position is the command.
    pub const NONE: Self = Self(Kind::None);

    /// $\tau \dot x = v - x$.
    ///
    /// # Errors
    /// [`SimError::Number`] unless the time constant is finite and positive.
    pub fn first_order(time_constant_s: f64) -> Result<Self, SimError> {
        let time_constant_s = positive("time constant, s", time_constant_s)?;
        Ok(Self(Kind::First { time_constant_s }))
    }

    /// $\ddot x = \omega_n^2 (v - x) - 2 \zeta \omega_n \dot x$.
    ///
    /// # Errors
    /// [`SimError::Number`] unless frequency and damping are finite and positive.
    pub fn second_order(natural_frequency_rad_s: f64, damping: f64) -> Result<Self, SimError> {
        let natural_frequency_rad_s =
            positive("natural frequency, rad/s", natural_frequency_rad_s)?;
        let damping = positive("damping ratio", damping)?;
        Ok(Self(Kind::Second { natural_frequency_rad_s, damping }))
    }

    /// Time constant of a lag of first order, s.
    #[must_use]
    pub const fn time_constant_s(&self) -> Option<f64> {
        match self.0 {
            Kind::First { time_constant_s } => Some(time_constant_s),
            _ => None,
        }
    }

    /// Natural frequency, rad/s, and damping ratio of a lag of second order.
    #[must_use]
    pub const fn second_order_parameters(&self) -> Option<(f64, f64)> {
        match self.0 {
            Kind::Second { natural_frequency_rad_s, damping } => {
                Some((natural_frequency_rad_s, damping))
            }
            _ => None,
        }
    }

    /// Order of the lag: 0, 1 or 2.
    #[must_use]
    pub const fn order(&self) -> usize {
        match self.0 {
            Kind::None => 0,
            Kind::First { .. } => 1,
            Kind::Second { .. } => 2,
        }
    }

    /// From command to position; `None` for no lag.
    ///
    /// # Errors
    /// A lag so quick that a coefficient overflows.
    pub fn transfer_function(&self) -> Result<Option<TransferFunction>, SimError> {
        let [by_position, by_rate, by_command] = self.coefficients();
        let whole = [1.0, -by_rate, -by_position];
        let denominator = match self.order() {
            0 => return Ok(None),
            1 => &[1.0, -by_position][..],
            _ => &whole,
        };
        Ok(Some(TransferFunction::new(&[by_command], denominator)?))
    }

    /// By how much time a position that moves at a constant rate trails its command, s: $\tau$ or
    /// $2 \zeta / \omega_n$. At a rate limit R the lag takes over where the gap is R times this.
    pub(crate) fn trailing_s(&self) -> f64 {
        match self.0 {
            Kind::None => 0.0,
            Kind::First { time_constant_s } => time_constant_s,
            Kind::Second { natural_frequency_rad_s, damping } => {
                2.0 * damping / natural_frequency_rad_s
            }
        }
    }

    /// Coefficients of $\dot x$ (first order) or $\ddot x$ (second order): by x, by its rate, by v.
    pub(crate) fn coefficients(&self) -> [f64; 3] {
        match self.0 {
            Kind::None => [0.0; 3],
            Kind::First { time_constant_s } => [-1.0 / time_constant_s, 0.0, 1.0 / time_constant_s],
            Kind::Second { natural_frequency_rad_s: wn, damping } => {
                [-wn * wn, -2.0 * damping * wn, wn * wn]
            }
        }
    }

    /// In how many pieces a time is followed, so that no event between them goes unseen. A response
    /// of first order is monotone and needs one.
    #[must_use]
    pub fn pieces(&self, duration_s: f64) -> u32 {
        let Kind::Second { natural_frequency_rad_s, damping } = self.0 else {
            return 1;
        };
        let fastest = natural_frequency_rad_s * (2.0 * damping).max(1.0);
        let pieces = (duration_s * fastest / PIECE).ceil();
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "not negative, and the cast saturates"
        )]
        let pieces = pieces as u32;
        pieces.max(1)
    }

    /// A piece of time, for [`after`](Self::after): what does not depend on where the actuator is.
    pub(super) fn piece(&self, time_s: f64) -> Piece {
        match self.0 {
            Kind::None => Piece::AtOnce,
            Kind::First { time_constant_s } => {
                Piece::First { covered: -libm::expm1(-time_s / time_constant_s) }
            }
            Kind::Second { natural_frequency_rad_s: wn, damping } => {
                Piece::Second { wn, damping, powers: powers(wn * time_s) }
            }
        }
    }

    /// Position and rate (0 below second order) a piece of time later, with the command held at
    /// `target_rad`.
    pub(super) fn after(&self, from: [f64; 2], target_rad: f64, time_s: f64) -> [f64; 2] {
        self.piece(time_s).after(from, target_rad)
    }
}

/// A piece of time as a lag passes through it.
#[derive(Clone, Copy, Debug)]
pub(super) enum Piece {
    AtOnce,
    First { covered: f64 },
    Second { wn: f64, damping: f64, powers: [f64; TERMS] },
}

impl Piece {
    /// Position and rate (0 below second order) behind it, with the command held at `target_rad`.
    pub(super) fn after(&self, [position_rad, rate_rad_s]: [f64; 2], target_rad: f64) -> [f64; 2] {
        match self {
            Self::AtOnce => [target_rad, 0.0],
            Self::First { covered } => [position_rad + (target_rad - position_rad) * covered, 0.0],
            Self::Second { wn, damping, powers } => {
                second_order_after([position_rad, rate_rad_s], target_rad, [*wn, *damping], powers)
            }
        }
    }
}

/// Position and rate of a lag of second order behind a piece of time, given by its [`powers`] of $\omega_n t$.
#[inline(always)]
pub(crate) fn second_order_after(
    [position_rad, rate_rad_s]: [f64; 2],
    target_rad: f64,
    [wn, damping]: [f64; 2],
    powers: &[f64; TERMS],
) -> [f64; 2] {
    let gap_rad = target_rad - position_rad;
    let (x, rate) = series([-gap_rad, rate_rad_s / wn], damping, powers);
    [position_rad + x, wn * rate]
}

/// $t^n / n!$ from n = 1 on.
#[inline(always)]
pub(crate) fn powers(time: f64) -> [f64; TERMS] {
    let mut power = 1.0;
    let mut term = 0.0;
    [(); TERMS].map(|()| {
        term += 1.0;
        power *= time / term;
        power
    })
}

/// Change of x and rate of x'' + 2 ζ x' + x = 0 over a time, by its Taylor series.
#[inline(always)]
fn series([x, rate]: [f64; 2], damping: f64, powers: &[f64; TERMS]) -> (f64, f64) {
    let (mut here, mut next) = (x, rate);
    let (mut change, mut rate_sum) = (0.0, rate);
    for power in powers {
        (here, next) = (next, -here - 2.0 * damping * next);
        change += here * power;
        rate_sum += next * power;
    }
    (change, rate_sum)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Handbook oracle: 1 - e^(-10 T) is 0.0951626 at 10 ms and 0.1812692 at 20 ms.
    #[test]
    fn ten_over_s_plus_ten_covers_its_printed_share_in_10_and_20_ms() {
        let lag = Lag::first_order(0.1).expect("allowed");
        for (time_s, expected) in [(0.01, 0.095_162_6), (0.02, 0.181_269_2)] {
            let [position, _] = lag.after([0.0; 2], 1.0, time_s);
            assert!((position - expected).abs() < 5.1e-8, "{position}");
        }
    }

    /// x = 1 - e^(-ζω t) (cos ω_d t + ζ/√(1-ζ²) sin ω_d t).
    #[test]
    fn a_second_order_step_is_that_of_the_textbook() {
        let (wn, damping) = (30.0, 0.7);
        let lag = Lag::second_order(wn, damping).expect("allowed");
        let root = (1.0 - damping * damping).sqrt();
        let mut state = [0.0; 2];
        let pieces = lag.pieces(0.5);
        for piece in 1..=pieces {
            state = lag.after(state, 1.0, 0.5 / f64::from(pieces));
            let time_s = 0.5 * f64::from(piece) / f64::from(pieces);
            let (sine, cosine) = crate::math::sin_cos(wn * root * time_s);
            let decay = crate::math::exp(-damping * wn * time_s);
            let expected = 1.0 - decay * (cosine + damping / root * sine);
            assert!((state[0] - expected).abs() < 1e-13, "{time_s} {}", state[0] - expected);
        }
    }

    #[test]
    fn lags_without_a_positive_finite_constant_are_refused() {
        for bad in [0.0, -1.0, f64::NAN, f64::INFINITY] {
            assert!(Lag::first_order(bad).is_err());
            assert!(Lag::second_order(bad, 0.7).is_err() && Lag::second_order(30.0, bad).is_err());
        }
    }
}
