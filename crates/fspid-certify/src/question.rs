//! What is asked of the loops of a scenario beside their stability, and all of it answered: once, for the program, the
//! server, Python, and the cases of a scenario.

use fspid_proof::Effort;
use fspid_scenario::file::Template;
use fspid_sim::SimError;
use fspid_study::shell;

use super::Certification;
use super::family::Chosen;
use super::nonlinear::Prove;

/// What is asked of a scenario.
#[derive(Clone, Copy, Debug)]
pub struct Question<'a> {
    /// The controller, or all of them.
    pub only: Option<&'a str>,
    /// What disturbances do at most as well.
    pub disturbances: bool,
    /// All that the dispersions can draw as well.
    pub family: bool,
    /// The nonlinear aircraft near its trim as well.
    pub nonlinear: bool,
    /// How hard to try.
    pub effort: &'a Effort,
}

impl Question<'_> {
    /// What is asked as `fspid certify` takes it behind a scenario, with a space before each word.
    #[must_use]
    pub fn options(&self) -> String {
        let only = self.only.map(|name| format!(" --controller {}", shell::word(name)));
        let beside = [
            (self.disturbances, " --disturbances"),
            (self.family, " --family"),
            (self.nonlinear, " --nonlinear"),
        ];
        let beside = beside.into_iter().filter(|(is_asked, _)| *is_asked);
        only.into_iter().chain(beside.map(|(_, option)| option.to_owned())).collect()
    }

    /// How much is asked of each controller, stability among it.
    #[must_use]
    pub fn parts(&self) -> usize {
        1 + [self.disturbances, self.family, self.nonlinear].into_iter().filter(|it| *it).count()
    }
}

impl Certification {
    /// Certifies the controllers of a scenario, with all that is asked beside. Tells before each part what is certified.
    ///
    /// # Errors
    /// [`SimError`] where a plant has no linear model; where the effort was stopped, loops have no answer.
    pub fn answering(
        template: &Template,
        question: Question<'_>,
        tell: &mut dyn FnMut(&str),
    ) -> Result<Self, SimError> {
        let Question { only, effort, .. } = question;
        let stable = Self::watched(template.study(), only, effort, tell)?;
        let mut prove = Prove::default();
        stable.with_all_beside(template, question, (Chosen::AsABox, &mut prove), tell)
    }

    /// Adds what is asked beside stability, with what becomes of choices and who proves of the nonlinear aircraft.
    pub(super) fn with_all_beside(
        self,
        template: &Template,
        question: Question<'_>,
        (chosen, prove): (Chosen, &mut Prove),
        tell: &mut dyn FnMut(&str),
    ) -> Result<Self, SimError> {
        let Question { disturbances, family, nonlinear, effort, .. } = question;
        let (study, mut found) = (template.study(), self);
        if disturbances {
            let mut told = |name: &str| tell(&format!("what disturbances do to {name}"));
            found = found.with_disturbances(study, effort, &mut told)?;
        }
        if family {
            let mut told = |name: &str| tell(&format!("all that can be drawn of {name}"));
            found = found.with_families(template, effort, chosen, &mut told)?;
        }
        if nonlinear {
            let mut told = |name: &str| tell(&format!("the nonlinear aircraft with {name}"));
            found = found.with_nonlinear(prove, study, effort, &mut told);
        }
        Ok(found)
    }
}
