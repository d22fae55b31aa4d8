//! Poles by their names: short period and phugoid, roll, spiral and Dutch roll.

use fspid_lti::{Complex, LtiError, Mode, StateSpace, modulus};

/// A motion that pilots have a name for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum ModeName {
    /// Angle of attack and pitch rate at held speed: the fast half of the longitudinal motion.
    ShortPeriod,
    /// Speed and height: the slow half.
    Phugoid,
    /// A pair between two real poles: where short period and phugoid have lent each other a pole, as near neutral
    /// static stability.
    ThirdOscillation,
    /// Sideslip and yaw.
    DutchRoll,
    /// Roll rate that dies out.
    Roll,
    /// Bank and heading that drift.
    Spiral,
    /// Roll and spiral coupled into a slow pair.
    RollSpiral,
}

impl ModeName {
    /// Name for a table.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::ShortPeriod => "short period",
            Self::Phugoid => "phugoid",
            Self::ThirdOscillation => "third oscillation",
            Self::DutchRoll => "Dutch roll",
            Self::Roll => "roll",
            Self::Spiral => "spiral",
            Self::RollSpiral => "roll-spiral",
        }
    }
}

/// A mode of an aircraft: a pair of poles or a real one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AircraftMode {
    /// What it is called.
    pub name: ModeName,
    /// Its pole in rad/s; of a pair the one with the positive imaginary part.
    pub pole: Complex,
}

/// What becomes of the size of a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Growth {
    /// It is half after this time in s.
    Halves(f64),
    /// It is double after this time in s.
    Doubles(f64),
    /// It stays.
    Stays,
}

impl AircraftMode {
    /// Whether it swings.
    #[must_use]
    pub fn oscillates(&self) -> bool {
        self.pole.im > 0.0
    }

    /// Natural frequency and damping.
    ///
    /// # Errors
    /// A pole at the origin.
    pub fn mode(&self) -> Result<Mode, LtiError> {
        Mode::of_pole(self.pole)
    }

    /// Time of one swing in s, if it swings.
    ///
    /// $$ P = 2 \pi / \operatorname{Im} p $$
    #[must_use]
    pub fn period_s(&self) -> Option<f64> {
        self.oscillates().then(|| core::f64::consts::TAU / self.pole.im)
    }

    /// Time in s in which it falls to 1/e: negative if it grows, infinite if it stays.
    ///
    /// $$ \tau = -1 / \operatorname{Re} p $$
    #[must_use]
    pub fn time_constant_s(&self) -> f64 {
        if self.pole.re == 0.0 { f64::INFINITY } else { -1.0 / self.pole.re }
    }

    /// Time to half or double size.
    ///
    /// $$ T_2 = \ln 2 / |\operatorname{Re} p| $$
    #[must_use]
    pub fn growth(&self) -> Growth {
        let time_s = core::f64::consts::LN_2 * self.time_constant_s().abs();
        if self.pole.re < 0.0 {
            Growth::Halves(time_s)
        } else if self.pole.re > 0.0 {
            Growth::Doubles(time_s)
        } else {
            Growth::Stays
        }
    }
}

/// Modes of a longitudinal motion of four states, the fastest first.
///
/// The two poles farther from the origin are the short period, the two nearer the phugoid, as pairs or real. Where a
/// pair stands between two real poles, it is the third oscillation.
///
/// # Errors
/// A system that has not four states; eigenvalues that do not converge.
pub fn longitudinal_modes(system: &StateSpace) -> Result<Vec<AircraftMode>, LtiError> {
    modes_of_poles(&system.poles()?)
}

/// Modes of a longitudinal motion of which the four poles are known, the fastest first; as [`longitudinal_modes`].
///
/// # Errors
/// Another number of poles.
pub fn modes_of_poles(poles: &[Complex]) -> Result<Vec<AircraftMode>, LtiError> {
    use ModeName::{Phugoid, ShortPeriod, ThirdOscillation};
    let poles = fastest_first(poles.to_vec())?;
    let names = if conjugate(poles[1], poles[2]) {
        [ShortPeriod, ThirdOscillation, ThirdOscillation, Phugoid]
    } else {
        [ShortPeriod, ShortPeriod, Phugoid, Phugoid]
    };
    Ok(named(poles, names))
}

/// Modes of a lateral motion of four states (without heading), the fastest first.
///
/// A single pair is the Dutch roll; of the two real poles the one farther from the origin is the roll, the nearer the
/// spiral. Of two pairs the slower is roll and spiral coupled.
///
/// # Errors
/// As [`longitudinal_modes`].
pub fn lateral_modes(system: &StateSpace) -> Result<Vec<AircraftMode>, LtiError> {
    use ModeName::{DutchRoll, Roll, RollSpiral, Spiral};
    let poles = fastest_first(system.poles()?)?;
    let pairs = [0, 1, 2].map(|first| conjugate(poles[first], poles[first + 1]));
    let names = match pairs {
        [true, _, true] => [DutchRoll, DutchRoll, RollSpiral, RollSpiral],
        [true, _, _] => [DutchRoll, DutchRoll, Roll, Spiral],
        [_, _, true] => [Roll, Spiral, DutchRoll, DutchRoll],
        _ => [Roll, DutchRoll, DutchRoll, Spiral],
    };
    Ok(named(poles, names))
}

/// The four poles by falling distance from the origin, the two of a pair next to each other.
fn fastest_first(mut poles: Vec<Complex>) -> Result<[Complex; 4], LtiError> {
    let size = |pole: &Complex| modulus(*pole);
    poles.sort_by(|left, right| {
        size(right).total_cmp(&size(left)).then(right.im.total_cmp(&left.im))
    });
    let found = (poles.len(), 1);
    poles.try_into().map_err(|_| LtiError::Shape { what: "list of poles", found, allowed: (4, 1) })
}

fn conjugate(left: Complex, right: Complex) -> bool {
    left.im > 0.0 && right.im < 0.0
}

fn named(poles: [Complex; 4], names: [ModeName; 4]) -> Vec<AircraftMode> {
    let upper = poles.into_iter().zip(names).filter(|(pole, _)| pole.im >= 0.0);
    upper.map(|(pole, name)| AircraftMode { name, pole }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use fspid_lti::Matrix;

    /// A system with these poles: real ones and pairs as blocks.
    fn system(pairs: &[(f64, f64)], reals: &[f64]) -> StateSpace {
        let size = 2 * pairs.len() + reals.len();
        let mut a = Matrix::zeros(size, size);
        for (index, &(re, im)) in pairs.iter().enumerate() {
            let at = 2 * index;
            for (row, column, value) in [(0, 0, re), (1, 1, re), (0, 1, im), (1, 0, -im)] {
                a.set(at + row, at + column, value).expect("inside");
            }
        }
        for (index, &real) in reals.iter().enumerate() {
            let at = 2 * pairs.len() + index;
            a.set(at, at, real).expect("inside");
        }
        let (b, c, d) = (Matrix::zeros(size, 0), Matrix::zeros(0, size), Matrix::zeros(0, 0));
        StateSpace::new(a, b, c, d).expect("shapes that fit")
    }

    fn names(modes: &[AircraftMode]) -> Vec<ModeName> {
        modes.iter().map(|mode| mode.name).collect()
    }

    #[test]
    fn two_pairs_are_short_period_and_phugoid() {
        let modes = longitudinal_modes(&system(&[(-0.002, 0.07), (-0.6, 1.1)], &[])).expect("four");
        assert_eq!(names(&modes), [ModeName::ShortPeriod, ModeName::Phugoid]);
        assert!(modes.iter().all(AircraftMode::oscillates));
        assert!((modes[0].period_s().expect("a pair") - core::f64::consts::TAU / 1.1).abs() < 1e-9);
    }

    #[test]
    fn real_poles_keep_the_name_of_the_half_they_belong_to() {
        let split = longitudinal_modes(&system(&[(-0.02, 0.07)], &[-1.9, 0.1])).expect("four");
        assert_eq!(
            names(&split),
            [ModeName::ShortPeriod, ModeName::ShortPeriod, ModeName::Phugoid]
        );
        assert!(
            matches!(split[1].growth(), Growth::Doubles(time_s) if (time_s - 6.93).abs() < 0.01)
        );
        let third = longitudinal_modes(&system(&[(-0.2, 0.3)], &[-1.5, 0.05])).expect("four");
        let expected = [ModeName::ShortPeriod, ModeName::ThirdOscillation, ModeName::Phugoid];
        assert_eq!(names(&third), expected);
    }

    #[test]
    fn lateral_poles_are_named_whatever_their_order() {
        use ModeName::{DutchRoll, Roll, RollSpiral, Spiral};
        let usual = lateral_modes(&system(&[(-0.5, 2.3)], &[-8.4, -0.009])).expect("four");
        assert_eq!(names(&usual), [Roll, DutchRoll, Spiral]);
        let slow_roll = lateral_modes(&system(&[(-0.5, 2.3)], &[-0.8, 0.01])).expect("four");
        assert_eq!(names(&slow_roll), [DutchRoll, Roll, Spiral]);
        let coupled = lateral_modes(&system(&[(-0.5, 2.3), (-0.1, 0.2)], &[])).expect("four");
        assert_eq!(names(&coupled), [DutchRoll, RollSpiral]);
    }

    #[test]
    fn a_pole_at_the_origin_stays() {
        let modes = lateral_modes(&system(&[(-0.5, 2.3)], &[-8.4, 0.0])).expect("four");
        assert_eq!(modes[2].growth(), Growth::Stays);
        assert!(modes[2].time_constant_s().is_infinite());
        assert!(modes[2].mode().is_err());
    }

    #[test]
    fn systems_of_another_size_are_refused() {
        assert!(longitudinal_modes(&system(&[(-0.5, 2.3)], &[-8.4])).is_err());
    }
}
