//! Proofs of stability while the gains move, and refutations, for the controllers of a scenario.
//!
//! Each controller is certified with each plant that lasts. A certificate is a file that is complete in
//! itself; [`check_text`] proves its claim anew and trusts nothing in it but its numbers.

mod controller_file;
mod coverage;
mod file;
mod json;
mod loop_file;
mod text;

use std::fmt;

use fspid_proof::{
    Asked, Certificate, Doubt, LeftOut, LoopDescription, NotProvable, Outcome, Rechecked, Verdict,
    certify, left_out_of,
};
use fspid_sim::{LinearPlant, SimError};

use crate::analysis::lasting_plants;
use crate::file::Study;

pub use fspid_proof::Effort;

pub use coverage::{COVERAGE, Row, Treatment, coverage_table};
pub use file::{Origin, from_text, to_text};

/// What came of certifying one controller with one plant.
#[derive(Clone, Debug)]
pub struct Certified {
    /// Name of the controller.
    pub controller: String,
    /// From when the plant is that one, s.
    pub from_s: f64,
    /// The answer, or why there can be none.
    pub outcome: Result<Outcome, NotProvable>,
    /// What limits motions that are not small, in words.
    pub limits: Vec<&'static str>,
    /// Where its certificates come from.
    pub origin: Origin,
}

impl Certified {
    /// True if stability is proved.
    #[must_use]
    pub fn is_proved(&self) -> bool {
        matches!(&self.outcome, Ok(outcome) if matches!(outcome.verdict, Verdict::Proved(..)))
    }

    /// The certificate of the verdict: of stability, or of growth.
    #[must_use]
    pub fn certificate(&self) -> Option<&Certificate> {
        match &self.outcome.as_ref().ok()?.verdict {
            Verdict::Proved(certificate, _) | Verdict::Refuted(certificate, _) => Some(certificate),
            Verdict::Open => None,
        }
    }

    /// A file name for its certificate.
    #[must_use]
    pub fn file_name(&self) -> String {
        let plain = |c: char| if c.is_ascii_alphanumeric() || c == '-' { c } else { '-' };
        let name: String = self.controller.chars().map(plain).collect();
        let later = match self.from_s {
            0.0 => String::new(),
            from_s => format!("-from-{}-s", crate::metrics::short(from_s)),
        };
        format!("{}{later}.certificate.json", name.to_lowercase())
    }
}

/// The controllers of a study, certified.
#[derive(Clone, Debug)]
pub struct Certification {
    /// Name of the scenario.
    pub scenario: String,
    /// One for each controller and lasting plant.
    pub results: Vec<Certified>,
    /// What the proofs leave out, in sentences.
    pub left_out: Vec<String>,
}

impl Certification {
    /// Certifies the controllers of a study: all of them, or the one with a name.
    ///
    /// # Errors
    /// [`SimError`] where a plant has no linear model.
    pub fn of(study: &Study, only: Option<&str>, effort: &Effort) -> Result<Self, SimError> {
        let scenario = &study.scenario;
        let plants = lasting_plants(scenario)?;
        let mut results = Vec::new();
        let wanted = |name: &str| only.is_none_or(|only| only == name);
        for named in scenario.controllers.iter().filter(|named| wanted(&named.name)) {
            for (from_s, plant) in &plants {
                let described = LoopDescription::of(scenario, plant, &named.controller);
                let limits = described.as_ref().map(LoopDescription::limits).unwrap_or_default();
                results.push(Certified {
                    controller: named.name.clone(),
                    from_s: *from_s,
                    outcome: described
                        .and_then(|loop_| certify(&loop_, &asked(study, plant, &loop_), effort)),
                    limits,
                    origin: Origin {
                        program: env!("CARGO_PKG_VERSION").to_owned(),
                        scenario: scenario.name.clone(),
                        digest: study.digest.clone(),
                        controller: named.name.clone(),
                    },
                });
            }
        }
        let left_out = left_out(study);
        Ok(Self { scenario: scenario.name.clone(), results, left_out })
    }

    /// True if every loop is proved stable.
    #[must_use]
    pub fn all_proved(&self) -> bool {
        !self.results.is_empty() && self.results.iter().all(Certified::is_proved)
    }
}

/// What is asked of a loop of a study.
fn asked(study: &Study, plant: &LinearPlant, description: &LoopDescription) -> Asked {
    let mut asked = Asked::of(&study.scenario, plant, description);
    if !study.dispersions.is_empty() {
        asked.left_out.push(LeftOut::Dispersions);
    }
    asked
}

/// What the claims of a study leave out, in sentences.
fn left_out(study: &Study) -> Vec<String> {
    let mut left_out = left_out_of(&study.scenario);
    if !study.dispersions.is_empty() {
        left_out.push(LeftOut::Dispersions);
    }
    left_out.iter().map(ToString::to_string).collect()
}

/// A certificate that was checked.
#[derive(Clone, Debug)]
pub struct CheckedFile {
    /// The certificate.
    pub certificate: Certificate,
    /// Where it says that it comes from.
    pub origin: Origin,
    /// What the re-check found.
    pub result: Result<Rechecked, Doubt>,
}

/// Why a text is no certificate.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NoCertificate {
    /// The reason.
    pub reason: String,
}

impl fmt::Display for NoCertificate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.reason)
    }
}

impl std::error::Error for NoCertificate {}

/// Proves the claim of a certificate anew.
///
/// # Errors
/// [`NoCertificate`] for a text that is none; a claim that does not hold is a result.
pub fn check_text(text: &str) -> Result<CheckedFile, NoCertificate> {
    let (certificate, origin) = from_text(text).map_err(|reason| NoCertificate { reason })?;
    let result = certificate.check();
    Ok(CheckedFile { certificate, origin, result })
}
