//! Input validation at run time: samples that are not finite or out of range hold the last command and latch a fault.

use core::fmt;

use fspid_numeric::Real;

use crate::controller_setting::ControllerSetting;
use crate::error::{ConfigError, positive};
use crate::sample::Sample;

/// Faults that a controller has met, latched until they are taken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Faults(u8);

impl Faults {
    /// None.
    pub const NONE: Self = Self(0);
    /// A sample was NaN or infinite; the output was held.
    pub const NOT_FINITE: Self = Self(1);
    /// A sample was beyond the guard's limit; the output was held.
    pub const IMPLAUSIBLE: Self = Self(1 << 1);
    /// The calculation overflowed from finite samples, or would have at the next; the output was
    /// held.
    pub const OVERFLOW: Self = Self(1 << 2);
    /// A supervisor that refuses inputs out of range met one; the gains were held.
    pub const OUT_OF_RANGE: Self = Self(1 << 3);
    /// Every rule of the supervisor underflowed; it answered as for the clamped inputs.
    pub const UNDERFLOW: Self = Self(1 << 4);

    const NAMES: [(Self, &'static str); 5] = [
        (Self::NOT_FINITE, "sample not finite"),
        (Self::IMPLAUSIBLE, "sample beyond the guard"),
        (Self::OVERFLOW, "overflow"),
        (Self::OUT_OF_RANGE, "supervisor input out of range"),
        (Self::UNDERFLOW, "supervisor underflow"),
    ];

    /// The bits as a number.
    #[must_use]
    pub const fn bits(self) -> u8 {
        self.0
    }

    /// Those that a number's bits stand for; bits of no fault are left out.
    #[must_use]
    pub const fn from_bits(bits: u8) -> Self {
        Self(bits & 0x1f)
    }

    /// True if every fault of `other` is among these.
    #[must_use]
    pub const fn contains(self, other: Self) -> bool {
        self.0 & other.0 == other.0
    }

    /// These but for those of `other`.
    #[must_use]
    pub const fn without(self, other: Self) -> Self {
        Self(self.0 & !other.0)
    }

    /// True if there is none.
    #[must_use]
    pub const fn is_empty(self) -> bool {
        self.0 == 0
    }

    /// True if one of them holds the command.
    pub(crate) const fn is_held(self) -> bool {
        self.0 & (Self::NOT_FINITE.0 | Self::IMPLAUSIBLE.0 | Self::OVERFLOW.0) != 0
    }

    pub(crate) fn latch(&mut self, fault: Self) {
        self.0 |= fault.0;
    }

    /// Returns the faults and clears them.
    pub fn take(&mut self) -> Self {
        core::mem::take(self)
    }
}

impl fmt::Display for Faults {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut names = Self::NAMES.iter().filter(|(fault, _)| self.contains(*fault));
        f.write_str(names.next().map_or("none", |(_, name)| name))?;
        names.try_for_each(|(_, name)| write!(f, ", {name}"))
    }
}

/// The largest sample that is believed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Guard<R> {
    limit: R,
}

impl<R: Real> Guard<R> {
    /// Believes samples up to `limit_rad` (and rates up to the same number of rad/s).
    ///
    /// # Errors
    /// [`ConfigError::Number`] unless the limit is finite and positive.
    pub fn new(limit_rad: R) -> Result<Self, ConfigError> {
        Ok(Self { limit: positive(ControllerSetting::SampleGuard, limit_rad)? })
    }

    /// The limit of a guard that was built, as a constant; nothing is checked.
    #[must_use]
    pub const fn new_unchecked(limit_rad: R) -> Self {
        Self { limit: limit_rad }
    }

    /// The largest sample that is believed, rad.
    pub fn limit_rad(&self) -> R {
        self.limit
    }

    /// The fault of a sample, if it has one.
    pub(crate) fn fault(&self, sample: Sample<R>) -> Option<Faults> {
        let values = [sample.setpoint_rad, sample.measurement_rad, sample.rate_rad_s];
        if values.iter().any(|value| !value.is_finite()) {
            return Some(Faults::NOT_FINITE);
        }
        values.iter().any(|value| value.abs() > self.limit).then_some(Faults::IMPLAUSIBLE)
    }

    /// The fault of one angle, if it has one.
    pub(crate) fn fault_of(&self, angle_rad: R) -> Option<Faults> {
        if !angle_rad.is_finite() {
            return Some(Faults::NOT_FINITE);
        }
        (angle_rad.abs() > self.limit).then_some(Faults::IMPLAUSIBLE)
    }
}

impl<R: Real> Default for Guard<R> {
    /// 10⁹ degrees: no aircraft, but far from overflow.
    fn default() -> Self {
        Self { limit: R::from_f64(1e9 * core::f64::consts::PI / 180.0) }
    }
}

#[cfg(test)]
mod tests {
    use super::{Faults, Guard, Sample};

    /// Every set of faults that there can be.
    fn all() -> impl Iterator<Item = Faults> {
        (0..32).map(Faults)
    }

    #[test]
    fn bits_come_back_as_the_same_faults_and_bits_of_no_fault_are_left_out() {
        for bits in 0..=u8::MAX {
            let faults = Faults::from_bits(bits);
            assert_eq!(faults.bits(), bits % 32);
            let named = Faults::NAMES.iter().filter(|(fault, _)| faults.contains(*fault));
            assert_eq!(named.count(), (bits % 32).count_ones() as usize);
        }
    }

    #[test]
    fn faults_without_others_have_those_that_the_others_have_not() {
        for these in all() {
            for others in all() {
                let left = these.without(others);
                for (fault, _) in Faults::NAMES {
                    let stays = these.contains(fault) && !others.contains(fault);
                    assert_eq!(left.contains(fault), stays, "{these} without {others}");
                }
            }
            assert_eq!(these.is_empty(), these == Faults::NONE);
        }
    }

    #[test]
    fn a_command_is_held_for_a_bad_sample_and_an_overflow_and_not_for_what_the_supervisor_met() {
        let holding = [Faults::NOT_FINITE, Faults::IMPLAUSIBLE, Faults::OVERFLOW];
        for faults in all() {
            let expected = holding.iter().any(|fault| faults.contains(*fault));
            assert_eq!(faults.is_held(), expected, "{faults}");
        }
    }

    #[test]
    fn an_angle_is_believed_up_to_the_limit_and_not_beyond() {
        let guard: Guard<f64> = Guard::new(2.0).expect("a limit");
        assert_eq!(guard.limit_rad().to_bits(), 2.0_f64.to_bits());
        assert_eq!(Guard::new_unchecked(2.0), guard);
        for believed in [0.0, 2.0, -2.0] {
            assert_eq!(guard.fault_of(believed), None);
            let sample = Sample { setpoint_rad: believed, measurement_rad: 0.0, rate_rad_s: 0.0 };
            assert_eq!(guard.fault(sample), None);
        }
        for beyond in [2.0_f64.next_up(), -3.0, f64::MAX] {
            assert_eq!(guard.fault_of(beyond), Some(Faults::IMPLAUSIBLE));
        }
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert_eq!(guard.fault_of(bad), Some(Faults::NOT_FINITE));
        }
    }
}
