//! A scenario certified as each of several changes makes it: by the cases of its tuning or its contest, or by what its
//! dispersions choose among. One answer about all of them, and a certificate for each loop.

mod answer;
mod asked;
mod choices;
mod disturbed;
mod near_trim;
mod page;

use fspid_proof::{Asked, LoopDescription, NotProvable, Outcome, certify};
use fspid_scenario::file::{Study, Template};
use fspid_scenario::tuning::Case;
use fspid_sim::SimError;

use super::family::Chosen;
use super::nonlinear::Prove;
use super::{Certification, Certified, Question};
use fspid_study::output::{Names, Place};

pub use asked::CasesError;
pub(super) use choices::{is_chosen_apart, only_choices_differ};

/// Most changes that are certified as one answer.
pub const MOST_CASES: usize = 256;

/// Which changes of a scenario.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Cases {
    /// Those that its tuning flies.
    Tuning,
    /// Those that its contest judges by.
    Contest,
    /// Every combination of what its dispersions choose among, where no interval holds the choices.
    Choices,
}

impl Cases {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Tuning, Self::Contest, Self::Choices];

    /// What they are asked for by, as behind `--cases`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Tuning => "tuning",
            Self::Contest => "contest",
            Self::Choices => "choices",
        }
    }

    /// Those of a name.
    ///
    /// # Errors
    /// A sentence with the names that there are.
    pub fn named(name: &str) -> Result<Self, String> {
        let names = Self::ALL.map(Self::name);
        Self::ALL.into_iter().find(|it| it.name() == name).ok_or_else(|| {
            let known = fspid_diagnostics::known_words(name, &names);
            format!("there are no cases `{name}`{known}")
        })
    }

    /// The changes of a scenario.
    fn changes(self, study: &Study) -> Result<Vec<Change>, NoCases> {
        let of = self.words();
        match self.found(study) {
            0 => return Err(NoCases::None(of)),
            found if found > MOST_CASES => return Err(NoCases::TooMany { found, of }),
            _ => {}
        }
        Ok(match self {
            Self::Tuning => {
                study.tuning.iter().flat_map(|it| &it.cases).map(Change::from).collect()
            }
            Self::Contest => {
                study.contest.iter().flat_map(|it| &it.cases).map(Change::from).collect()
            }
            Self::Choices => choices::all(study),
        })
    }

    /// How many a scenario has.
    #[must_use]
    pub fn found(self, study: &Study) -> usize {
        match self {
            Self::Tuning => study.tuning.iter().map(|it| it.cases.len()).sum(),
            Self::Contest => study.contest.iter().map(|it| it.cases.len()).sum(),
            Self::Choices => choices::count(study),
        }
    }

    /// What they are, after a number of them.
    #[must_use]
    pub const fn words(self) -> &'static str {
        match self {
            Self::Tuning => "cases of [tuning]",
            Self::Contest => "cases of [contest]",
            Self::Choices => "choices of the dispersions",
        }
    }
}

/// A change of a scenario.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Change {
    /// What it is called; unique among its kind.
    pub name: String,
    /// The values, as `--set` takes them.
    pub set: Vec<String>,
}

impl From<&Case> for Change {
    fn from(case: &Case) -> Self {
        Self { name: case.name.clone(), set: case.set.clone() }
    }
}

/// Why there are no cases to certify.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum NoCases {
    /// The scenario has none.
    #[error("the scenario has no {0}; leave --cases out to certify it as it is")]
    None(&'static str),
    /// Choices that no combination holds, since they are numbers of a family.
    #[error(
        "{0}: chosen as well, as numbers of a family, and not one by one: --family asks every combination with them; or give one value with --set and leave the dispersion out"
    )]
    InAFamily(String),
    /// Factors of what stands there, which `--set` does not know.
    #[error(
        "{0}: chosen as factors, with `relative = true`; write the values themselves, which are certified one by one"
    )]
    Factors(String),
    /// More than are certified at once.
    #[error("{found} {of}; allowed are up to {MOST_CASES}")]
    TooMany {
        /// How many.
        found: usize,
        /// Of what.
        of: &'static str,
    },
}

/// A scenario with a change, certified.
#[derive(Clone, Debug)]
pub struct CertifiedCase {
    /// The change.
    pub change: Change,
    /// What came of it.
    pub certification: Certification,
}

/// A loop that was asked for before, with its answer.
#[derive(Clone, Debug)]
struct Known {
    description: LoopDescription,
    asked: Asked,
    outcome: Result<Outcome, NotProvable>,
}

/// What came of all changes.
#[derive(Clone, Debug)]
pub struct CertifiedCases {
    scenario: String,
    which: Cases,
    changes: Vec<Change>,
    folders: Names,
    cases: Vec<CertifiedCase>,
    known: Vec<Known>,
    /// What was asked of nonlinear aircraft before.
    nonlinear: Prove,
}

impl CertifiedCases {
    /// The changes that are to be certified, each to be [added](Self::add).
    ///
    /// # Errors
    /// [`NoCases`].
    pub fn new(study: &Study, which: Cases) -> Result<Self, NoCases> {
        let changes = which.changes(study)?;
        let folders = Names::of(Place::PlainFile, changes.iter().map(|it| &it.name));
        let scenario = study.scenario.name.clone();
        let (cases, known, nonlinear) = (Vec::new(), Vec::new(), Prove::default());
        Ok(Self { scenario, which, changes, folders, cases, known, nonlinear })
    }

    /// The changes.
    #[must_use]
    pub fn changes(&self) -> &[Change] {
        &self.changes
    }

    /// The changes that were certified.
    #[must_use]
    pub fn cases(&self) -> &[CertifiedCase] {
        &self.cases
    }

    /// A name for the folder of a change's certificates, which no other change has.
    pub(super) fn folder(&self, change: &Change) -> String {
        self.folders.name(&change.name)
    }

    /// Certifies a change; `template` is the scenario with it. A loop of which the same was asked before has that answer.
    /// Tells the name of each controller before.
    ///
    /// # Errors
    /// [`SimError`] where a plant has no linear model.
    pub fn add(
        &mut self,
        change: &Change,
        template: &Template,
        question: Question<'_>,
        tell: &mut dyn FnMut(&str),
    ) -> Result<(), SimError> {
        let Question { only, effort, .. } = question;
        let known = &mut self.known;
        let mut ask = |description: &LoopDescription, asked: &Asked| {
            let mut asked = asked.clone();
            if !effort.long_flights {
                // Not asked for, and no two cases are to differ by it.
                asked.commands = Ok(None);
            }
            let same = |it: &&Known| it.description == *description && it.asked == asked;
            if let Some(before) = known.iter().find(same) {
                return before.outcome.clone();
            }
            let outcome = certify(description, &asked, effort);
            let description = description.clone();
            known.push(Known { description, asked, outcome: outcome.clone() });
            outcome
        };
        let mut stable = Certification::asking(template.study(), only, &mut ask, tell)?;
        if self.which == Cases::Choices && only_choices_differ(template.study()) {
            stable.are_about_one_choice();
        }
        let chosen = match self.which {
            Cases::Choices => Chosen::Apart,
            Cases::Tuning | Cases::Contest => Chosen::AsABox,
        };
        let beside = (chosen, &mut self.nonlinear);
        let certification = stable.with_all_beside(template, question, beside, tell)?;
        self.cases.push(CertifiedCase { change: change.clone(), certification });
        Ok(())
    }

    /// Every loop of a controller in every change; none where a change is missing.
    fn in_every_change(&self, controller: &str) -> Option<Vec<&Certified>> {
        let results = self.cases.iter().flat_map(|case| &case.certification.results);
        let own: Vec<&Certified> = results.filter(|it| it.controller == controller).collect();
        // Every change has the controller, with a plant or more.
        let has_own = |case: &CertifiedCase| {
            case.certification.results.iter().any(|it| it.controller == controller)
        };
        let is_whole = self.cases.len() == self.changes.len() && self.cases.iter().all(has_own);
        is_whole.then_some(own)
    }

    /// True if every loop of every change is proved stable, and none is missing.
    #[must_use]
    pub fn all_proved(&self) -> bool {
        self.cases.len() == self.changes.len()
            && self.cases.iter().all(|it| it.certification.all_proved())
    }
}

/// True if a scenario's dispersions choose among values of a loop that no interval holds, so that each is to be certified on
/// its own ([`Cases::Choices`]).
#[must_use]
pub(super) fn has_choices(study: &Study) -> bool {
    study.dispersions.iter().any(is_chosen_apart)
}
