#![doc = include_str!("../README.md")]
//!
//! Each controller is certified with each plant that lasts. A certificate is a file that is complete in itself; [`check_text`]
//! proves its claim anew and trusts nothing in it but its numbers.
//!
//! No features. Not here: how proofs are found and re-checked (`fspid-proof`), margins and flights (`fspid-study`), printing
//! (`fspid-cli`).

#![cfg_attr(
    test,
    allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")
)]

mod against;
mod around;
mod cases;
mod certificate_files;
mod checked;
mod checked_text;
mod commanded_file;
mod comparison;
mod controller_file;
mod coverage;
mod digest;
#[cfg(test)]
mod disturbance_tests;
mod disturbances;
mod disturbances_file;
mod family;
mod family_file;
mod file;
#[cfg(test)]
mod flight_tests;
mod json;
mod json_text;
mod loop_file;
mod no_certificate;
mod nonlinear;
mod nonlinear_file;
mod page;
mod question;
mod scope;
mod shape;
mod steps_file;
#[cfg(test)]
mod tests;
mod text;
mod told;

use fspid_diagnostics::digits::to_six_decimals;
use fspid_proof::{
    Asked, Certificate, LeftOut, LoopDescription, NotProvable, Outcome, Unbounded, Verdict,
    bound_disturbances, certify, ways_of,
};
use fspid_sim::{LinearPlant, SimError};

use fspid_scenario::file::{Study, Template};
use fspid_study::analysis::lasting_plants;
use fspid_study::output::{Names, Place};

pub use fspid_proof::Effort;

use around::not_held_in_words;
pub use cases::{Cases, CasesError, CertifiedCase, CertifiedCases, Change, MOST_CASES, NoCases};
pub use certificate_files::{CertificateFile, NotWritable};
pub use checked::{Answer, CheckedFile, check_text, check_text_until};
pub use comparison::{Comparison, Difference};
pub use coverage::{COVERAGE, KeyCoverage, Treatment, coverage_table};
pub use disturbances::DisturbanceAnswer;
pub use family::{AsFlown, FamilyAnswer, NoFamily};
pub use file::{Origin, SCHEMA, Seal, from_text, to_text};
pub use fspid_study::analysis::Around;
pub use no_certificate::NoCertificate;
pub use nonlinear::{NoNonlinear, NonlinearAnswer};
pub use page::Subject;
pub use question::Question;
pub use scope::in_short as scope_in_short;
pub use shape::Wrong;

/// What came of certifying one controller with one plant.
#[derive(Clone, Debug)]
pub struct Certified {
    /// Name of the controller.
    pub controller: String,
    /// From when the plant is that one, s.
    pub from_s: f64,
    /// The answer, or why there can be none.
    pub outcome: Result<Outcome, NotProvable>,
    /// What came of all that the dispersions can draw, where that was asked.
    pub family: Option<FamilyAnswer>,
    /// What came of bounds of disturbances, where they were asked for.
    pub disturbances: Option<DisturbanceAnswer>,
    /// What came of the nonlinear aircraft near its trim, where that was asked.
    pub nonlinear: Option<NonlinearAnswer>,
    /// What flies around the loop, where that is an autopilot.
    pub around: Option<Around>,
    /// What the flight does at rest, or may do, of which no claim speaks; none where everything holds.
    pub not_held: Option<String>,
    /// Where its certificates come from.
    pub origin: Origin,
}

impl Certified {
    /// True if stability is proved, of the whole family, of the nonlinear aircraft and with bounds of disturbances where that was
    /// asked, and the flight around it is held at rest.
    #[must_use]
    pub fn is_proved(&self) -> bool {
        let itself =
            matches!(&self.outcome, Ok(outcome) if matches!(outcome.verdict, Verdict::Proved(..)));
        itself
            && self.family.as_ref().is_none_or(FamilyAnswer::is_proved)
            && self.disturbances.as_ref().is_none_or(DisturbanceAnswer::is_bounded)
            && self.nonlinear.as_ref().is_none_or(NonlinearAnswer::is_proved)
            && self.trouble().is_none()
    }

    /// Why a flight may not hold though the loop is proved: outer loops around it, what is no pitching, what it comes to later.
    fn trouble(&self) -> Option<String> {
        let of_modes = self.around.as_ref().and_then(Around::trouble);
        of_modes.or_else(|| self.not_held.clone())
    }

    /// The certificate of the verdict: of stability, or of growth; where the answer is neither for what the
    /// scenario asks, of the smaller range that is proved.
    #[must_use]
    pub fn certificate(&self) -> Option<&Certificate> {
        text::found(self.outcome.as_ref().ok()?).map(|(certificate, _)| certificate)
    }

    /// What its certificate is of: the controller, and a plant that is not the first.
    fn subject(&self) -> String {
        self.controller.clone() + &later(self.from_s)
    }
}

/// What stands behind a controller's name in that of a certificate, for a plant that is not the first.
fn later(from_s: f64) -> String {
    match from_s {
        0.0 => String::new(),
        from_s => format!("-from-{}-s", to_six_decimals(from_s)),
    }
}

/// The controllers of a study, certified.
#[derive(Clone, Debug)]
pub struct Certification {
    /// Name of the scenario.
    pub scenario: String,
    /// One for each controller and lasting plant.
    pub results: Vec<Certified>,
    /// Names of their files, among those of all controllers of the scenario.
    files: Names,
}

impl Certification {
    /// Certifies the controllers of a study: all of them, or the one with a name.
    ///
    /// # Errors
    /// [`SimError`] where a plant has no linear model.
    pub fn of(study: &Study, only: Option<&str>, effort: &Effort) -> Result<Self, SimError> {
        Self::watched(study, only, effort, &mut |_| {})
    }

    /// As [`of`](Self::of), and tells the name of each controller before it is certified.
    ///
    /// # Errors
    /// [`SimError`] where a plant has no linear model.
    pub fn watched(
        study: &Study,
        only: Option<&str>,
        effort: &Effort,
        tell: &mut dyn FnMut(&str),
    ) -> Result<Self, SimError> {
        let mut ask =
            |description: &LoopDescription, asked: &Asked| certify(description, asked, effort);
        Self::asking(study, only, &mut ask, tell)
    }

    /// As [`watched`](Self::watched), with the answer of a loop from whoever has it.
    fn asking(
        study: &Study,
        only: Option<&str>,
        ask: &mut dyn FnMut(&LoopDescription, &Asked) -> Result<Outcome, NotProvable>,
        tell: &mut dyn FnMut(&str),
    ) -> Result<Self, SimError> {
        let scenario = &study.scenario;
        let plants = lasting_plants(scenario)?;
        let mut results = Vec::new();
        let wanted = |name: &str| only.is_none_or(|only| only == name);
        for named in scenario.controllers.iter().filter(|named| wanted(&named.name)) {
            tell(&named.name);
            let around = Around::of(scenario, &named.controller)?;
            let not_held = not_held_in_words(scenario, named);
            for (from_s, plant) in &plants {
                let described = LoopDescription::of(scenario, plant, &named.controller);
                results.push(Certified {
                    controller: named.name.clone(),
                    from_s: *from_s,
                    outcome: described.and_then(|loop_| ask(&loop_, &asked(study, plant, &loop_))),
                    family: None,
                    disturbances: None,
                    nonlinear: None,
                    around: around.clone(),
                    not_held: not_held.clone(),
                    origin: Origin {
                        program: env!("CARGO_PKG_VERSION").to_owned(),
                        scenario: scenario.name.clone(),
                        digest: study.digest.clone(),
                        controller: named.name.clone(),
                    },
                });
            }
        }
        let each = |name: &String| {
            plants.iter().map(|(at, _)| (name.clone(), later(*at))).collect::<Vec<_>>()
        };
        let subjects = scenario.controllers.iter().flat_map(|named| each(&named.name));
        let files = Names::with_endings(Place::PlainFile, subjects);
        Ok(Self { scenario: scenario.name.clone(), results, files })
    }

    /// Certifies all that the dispersions of the scenario can draw, with each of its loops that is proved; `template` is the
    /// scenario that was certified, `chosen` what becomes of choices. Tells the name of each controller before.
    fn with_families(
        mut self,
        template: &Template,
        effort: &Effort,
        chosen: family::Chosen,
        tell: &mut dyn FnMut(&str),
    ) -> Result<Self, SimError> {
        let scenario = &template.study().scenario;
        let plants = lasting_plants(scenario)?;
        for certified in &mut self.results {
            let Ok(outcome) = &mut certified.outcome else { continue };
            let named = scenario.controllers.iter().find(|it| it.name == certified.controller);
            let plant = plant_from(&plants, certified.from_s);
            let (Some(named), Some(plant)) = (named, plant) else { continue };
            tell(&certified.controller);
            let described = LoopDescription::of(scenario, plant, &named.controller);
            let answer = described.and_then(|description| {
                let subject = (template, chosen);
                family::certified(subject, (&description, plant), outcome, effort)
            });
            match answer {
                Ok(answer) => certified.family = answer,
                Err(stopped) => certified.outcome = Err(stopped),
            }
        }
        Ok(self)
    }

    /// Bounds what disturbances do to each of its loops that is proved; `study` is what was certified. Tells the name of each
    /// controller before.
    ///
    /// # Errors
    /// [`SimError`] where a plant has no linear model; where the effort was stopped, the loop has no answer.
    pub fn with_disturbances(
        mut self,
        study: &Study,
        effort: &Effort,
        tell: &mut dyn FnMut(&str),
    ) -> Result<Self, SimError> {
        let plants = lasting_plants(&study.scenario)?;
        for certified in &mut self.results {
            let Ok(outcome) = &mut certified.outcome else { continue };
            let Some(plant) = plant_from(&plants, certified.from_s) else { continue };
            tell(&certified.controller);
            let Verdict::Proved(certificate, _) = &outcome.verdict else {
                let reason = "the loop itself is not proved".to_owned();
                certified.disturbances = Some(DisturbanceAnswer::NotBounded(reason));
                continue;
            };
            match bound_disturbances(certificate, &ways_of(plant), effort) {
                Ok((certificate, rechecked)) => {
                    outcome.verdict = Verdict::Proved(certificate, rechecked);
                    certified.disturbances = Some(DisturbanceAnswer::Bounded);
                }
                Err(Unbounded::NotProvable(stopped)) => certified.outcome = Err(stopped),
                Err(reason) => {
                    let reason = reason.to_string();
                    certified.disturbances = Some(DisturbanceAnswer::NotBounded(reason));
                }
            }
        }
        Ok(self)
    }

    /// Certifies the nonlinear aircraft near its trim, with each of the loops that is proved. Tells the name of each
    /// controller before; where the effort was stopped, the loop has no answer.
    fn with_nonlinear(
        mut self,
        prove: &mut nonlinear::Prove,
        study: &Study,
        effort: &Effort,
        tell: &mut dyn FnMut(&str),
    ) -> Self {
        for certified in &mut self.results {
            let Ok(outcome) = &mut certified.outcome else { continue };
            tell(&certified.controller);
            match nonlinear::certified(study, outcome, prove, effort) {
                Ok(answer) => certified.nonlinear = Some(answer),
                Err(stopped) => certified.outcome = Err(stopped),
            }
        }
        self
    }

    /// A file name for a certificate, which no other controller of the scenario has.
    #[must_use]
    pub fn file_name(&self, certified: &Certified) -> String {
        format!("{}.certificate.json", self.files.name(&certified.subject()))
    }

    /// True if every loop is proved stable.
    #[must_use]
    pub fn all_proved(&self) -> bool {
        !self.results.is_empty() && self.results.iter().all(Certified::is_proved)
    }

    /// Its certificates are those of one choice of the dispersions, beside which nothing is drawn.
    fn are_about_one_choice(&mut self) {
        for result in &mut self.results {
            if let Ok(Outcome { verdict: Verdict::Proved(certificate, _), .. }) =
                &mut result.outcome
            {
                family::is_about_one_choice(certificate);
            }
        }
    }
}

/// The plant that lasts from this time on, s.
fn plant_from(plants: &[(f64, LinearPlant)], from_s: f64) -> Option<&LinearPlant> {
    plants.iter().find(|(at_s, _)| at_s.total_cmp(&from_s).is_eq()).map(|(_, plant)| plant)
}

/// What is asked of a loop of a study.
fn asked(study: &Study, plant: &LinearPlant, description: &LoopDescription) -> Asked {
    let mut asked = Asked::of(&study.scenario, plant, description);
    if !study.dispersions.is_empty() {
        asked.left_out.push(LeftOut::Dispersions);
    }
    if study.dispersions.iter().any(family::reaches_outside_of_the_loop) {
        asked.left_out.push(LeftOut::DrawnCommands);
    }
    asked
}
