//! A certificate read and proved anew, and what that comes to.

use super::no_certificate::NoCertificate;

use fspid_proof::{Bearing, Certificate, CheckedNonlinear, Nonlinear, RecheckError, Rechecked};

use super::comparison::Comparison;
use super::file::{self, Origin, Seal};

/// A certificate that was checked.
#[derive(Clone, Debug)]
pub struct CheckedFile {
    /// The certificate.
    pub certificate: Certificate,
    /// Where it says that it comes from.
    pub origin: Origin,
    /// Whether it is as it was written.
    pub seal: Seal,
    /// What the re-check found.
    pub result: Result<Rechecked, RecheckError>,
    /// What flies, beside what is certified; none without a scenario.
    pub against: Option<Comparison>,
}

/// What a check comes to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Answer {
    /// The flown loop is stable within the scope of the certificate, and the scenario, if one was given, flies
    /// that loop.
    Holds,
    /// What the certificate refutes is refuted, be it of gains that stand still.
    Refutes(Bearing),
    /// The inequalities are proved and say nothing of the flown loop.
    SaysNothing(Bearing),
    /// An inequality is not proved, or parts do not fit together.
    NotProved,
    /// It is not as it was written.
    Edited,
    /// The scenario flies another loop.
    AnotherLoop,
}

impl Answer {
    /// Name in files.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Holds => "holds",
            Self::Refutes(_) => "refutes",
            Self::SaysNothing(_) => "says nothing of the flown loop",
            Self::NotProved => "not proved",
            Self::Edited => "edited",
            Self::AnotherLoop => "another loop",
        }
    }
}

impl Answer {
    /// True where the claim does not hold, or is of something else.
    pub(super) const fn is_refused(self) -> bool {
        matches!(self, Self::NotProved | Self::Edited | Self::AnotherLoop)
    }
}

impl CheckedFile {
    /// What it all comes to.
    #[must_use]
    pub fn answer(&self) -> Answer {
        let Some(bearing) = self.bearing() else { return Answer::NotProved };
        if self.seal != Seal::Whole {
            return Answer::Edited;
        }
        if self.against.as_ref().is_some_and(|against| !against.is_same()) {
            return Answer::AnotherLoop;
        }
        match bearing {
            Bearing::Stable | Bearing::PitchLoopStable => Answer::Holds,
            Bearing::Grows | Bearing::GrowsStandingStill | Bearing::GrowsInSomeOrder => {
                Answer::Refutes(bearing)
            }
            Bearing::OtherScale { .. } | Bearing::RateNotKept => Answer::SaysNothing(bearing),
        }
    }

    /// What is claimed of the nonlinear aircraft, where it is proved.
    pub(super) fn nonlinear(&self) -> Option<(&Nonlinear, CheckedNonlinear)> {
        let found = self.result.as_ref().ok().and_then(|rechecked| rechecked.nonlinear);
        self.certificate.nonlinear.as_ref().zip(found)
    }

    /// True if the certificate proves the flown loop stable.
    #[must_use]
    pub fn holds(&self) -> bool {
        self.answer() == Answer::Holds
    }

    /// What the claim bears on, if its inequalities are proved.
    #[must_use]
    pub fn bearing(&self) -> Option<Bearing> {
        self.result.as_ref().ok().map(|rechecked| self.certificate.bearing(rechecked))
    }
}

/// Proves the claim of a certificate anew.
///
/// # Errors
/// [`NoCertificate`] for a text that is none; a claim that does not hold is a result.
pub fn check_text(text: &str) -> Result<CheckedFile, NoCertificate> {
    check_text_until(text, || false)
}

/// As [`check_text`] for somebody who may not want the answer any more: where `stops` says so, nothing is proved.
///
/// # Errors
/// As [`check_text`].
pub fn check_text_until(text: &str, stops: fn() -> bool) -> Result<CheckedFile, NoCertificate> {
    let file::Read { certificate, origin, seal } = file::read(text)?;
    let result = certificate.check_until(stops);
    Ok(CheckedFile { certificate, origin, seal, result, against: None })
}
