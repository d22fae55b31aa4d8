//! All that the dispersions of a scenario can draw, certified at once: which numbers of a loop they change, and between
//! what they lie.

mod answer;
mod loop_number;
mod members;
mod source;

pub(super) use answer::{box_in_words, in_json, in_words, sentences};
pub use members::NoFamily;
pub(super) use members::{is_in_a_box, is_outside_of_the_loop, reaches_outside_of_the_loop};

use fspid_proof::check::{PlantSet, Sloped};
use fspid_proof::{
    Certificate, Effort, Family, FamilyVerdict, LeftOut, LoopDescription, NotProvable, Outcome,
    Rechecked, Verdict, numbers, prove_family,
};
use fspid_scenario::file::Template;
use fspid_sim::LinearPlant;

use members::Members;

/// What came of a family.
#[derive(Clone, Debug)]
pub enum FamilyAnswer {
    /// Proved, refuted or open, with the numbers that differ.
    Verdict {
        /// What differs in the loop.
        parameters: Vec<fspid_proof::Parameter>,
        /// The answer.
        verdict: Box<FamilyVerdict>,
    },
    /// No question can be asked.
    None(NoFamily),
    /// The loop as it is is not proved, so that its family is not either.
    NominalNotProved,
}

impl FamilyAnswer {
    /// True if every member is proved stable.
    #[must_use]
    pub fn is_proved(&self) -> bool {
        self.proved().is_some()
    }

    /// The family, if every member is proved stable.
    #[must_use]
    pub fn proved(&self) -> Option<&Family> {
        match self {
            Self::Verdict { verdict, .. } => match &**verdict {
                FamilyVerdict::Proved(family) => Some(family),
                FamilyVerdict::Refuted { .. } | FamilyVerdict::Open { .. } => None,
            },
            Self::None(_) | Self::NominalNotProved => None,
        }
    }
}

/// What becomes of dispersions that choose among values of which no box is made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Chosen {
    /// They are refused by name.
    AsABox,
    /// Each choice is certified on its own by whoever asks, so that here nothing differs by them.
    Apart,
}

/// Certifies the family of a loop beside its own verdict, whose certificate then speaks of both. None where choices alone
/// differ, each of which is certified on its own.
///
/// # Errors
/// [`NotProvable`] where the effort was stopped.
pub(super) fn certified(
    (template, chosen): (&Template, Chosen),
    (description, plant): (&LoopDescription, &LinearPlant),
    outcome: &mut Outcome,
    effort: &Effort,
) -> Result<Option<FamilyAnswer>, NotProvable> {
    let Verdict::Proved(certificate, rechecked) = &mut outcome.verdict else {
        return Ok(Some(FamilyAnswer::NominalNotProved));
    };
    let members = match Members::of((template, chosen), (description, plant)) {
        Ok(members) => members,
        Err(NoFamily::NothingDiffers) if chosen == Chosen::Apart => {
            is_about_one_choice(certificate);
            return Ok(None);
        }
        Err(none) => return Ok(Some(FamilyAnswer::None(none))),
    };
    let plant = |at: &[Sloped]| members.plant(at);
    let parameters = members.parameters().to_vec();
    let verdict = prove_family(description, &parameters, effort, &plant)?;
    if let FamilyVerdict::Proved(family) = &verdict {
        let mut whole = Certificate { family: Some(family.clone()), ..certificate.clone() };
        match chosen {
            Chosen::AsABox => whole.left_out.retain(|one| *one != LeftOut::Dispersions),
            Chosen::Apart => is_about_one_choice(&mut whole),
        }
        let rechecked = Rechecked { family: Some(family.checked()), ..rechecked.clone() };
        outcome.verdict = Verdict::Proved(whole, rechecked);
    }
    Ok(Some(FamilyAnswer::Verdict { parameters, verdict: Box::new(verdict) }))
}

/// A certificate that leaves out other choices in place of all that differs.
fn is_about_one_choice(certificate: &mut Certificate) {
    for one in &mut certificate.left_out {
        if *one == LeftOut::Dispersions {
            *one = LeftOut::OtherChoices;
        }
    }
}

/// What of a certified family is not what a scenario's dispersions draw of a loop, in words; none where it is.
pub(super) fn differs(
    family: &Family,
    template: &Template,
    of: (&LoopDescription, &LinearPlant),
) -> Option<String> {
    let members = match Members::of((template, Chosen::Apart), of) {
        Ok(members) => members,
        Err(none) => return Some(none.to_string()),
    };
    if members.parameters() != family.parameters {
        return Some(box_in_words(members.parameters()));
    }
    let encloses = |part: &fspid_proof::FamilyPart| {
        let numbers = numbers(&family.parameters, &part.ends);
        PlantSet::of(&numbers, &|at| members.plant(at)).is_ok_and(|it| part.plants.encloses(&it))
    };
    let place = family.parts.iter().position(|part| !encloses(part))?;
    Some(format!("other plants in part {place}"))
}
