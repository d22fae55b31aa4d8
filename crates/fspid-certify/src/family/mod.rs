//! All that the dispersions of a scenario can draw, certified at once: which numbers of a loop they change, and between
//! what they lie.

mod answer;
mod as_flown;
mod loop_number;
mod members;
mod source;

pub(super) use answer::{box_in_words, in_json, in_words, member_in_words, sentences};
pub use as_flown::AsFlown;
pub use members::NoFamily;
pub(super) use members::{
    is_in_a_box, is_in_no_claim, is_outside_of_the_loop, reaches_outside_of_the_loop,
};

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
        /// What came of members as they fly, where the answer is that all are proved.
        as_flown: AsFlown,
    },
    /// No question can be asked.
    None(NoFamily),
    /// The loop as it is is not proved, so that its family is not either.
    NominalNotProved,
}

impl FamilyAnswer {
    /// True if every member is proved stable, and no member that was asked does not hold as it flies.
    #[must_use]
    pub fn is_proved(&self) -> bool {
        self.proved().is_some() && self.not_held().is_none()
    }

    /// A member that does not hold as it flies, and why not.
    #[must_use]
    pub fn not_held(&self) -> Option<(&[f64], &str)> {
        match self {
            Self::Verdict { as_flown: AsFlown::NotHeld { at, because }, .. } => Some((at, because)),
            _ => None,
        }
    }

    /// The family, if every member is proved stable, as far as pitch loops go.
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
    let mut as_flown = AsFlown::LoopAlone;
    if let FamilyVerdict::Proved(family) = &verdict {
        as_flown = AsFlown::of(&members, template, description, effort.stops)?;
        let mut whole = Certificate { family: Some(family.clone()), ..certificate.clone() };
        match chosen {
            Chosen::AsABox => whole.left_out.retain(|one| *one != LeftOut::Dispersions),
            Chosen::Apart => is_about_one_choice(&mut whole),
        }
        let rechecked = Rechecked { family: Some(family.checked()), ..rechecked.clone() };
        outcome.verdict = Verdict::Proved(whole, rechecked);
    }
    Ok(Some(FamilyAnswer::Verdict { parameters, verdict: Box::new(verdict), as_flown }))
}

/// A certificate that leaves out other choices in place of all that differs.
pub(super) fn is_about_one_choice(certificate: &mut Certificate) {
    for one in &mut certificate.left_out {
        if *one == LeftOut::Dispersions {
            *one = LeftOut::OtherChoices;
        }
    }
}

/// What of a certified family is not what a scenario's dispersions draw of a loop, or does not hold as it flies: at which path
/// of an answer, what was certified, and what flies.
pub(super) struct Differs {
    pub(super) path: &'static str,
    pub(super) certified: String,
    pub(super) flown: String,
}

/// What of a certified family is not what a scenario flies of a loop; where it is, what came of members as they fly.
pub(super) fn compared(
    family: &Family,
    template: &Template,
    of: (&LoopDescription, &LinearPlant),
) -> Result<AsFlown, Differs> {
    let certified = || box_in_words(&family.parameters);
    let differs = |flown: String| Differs { path: "family", certified: certified(), flown };
    let members = Members::of((template, Chosen::Apart), of);
    let members = members.map_err(|none| differs(none.to_string()))?;
    if members.parameters() != family.parameters {
        return Err(differs(box_in_words(members.parameters())));
    }
    let encloses = |part: &fspid_proof::FamilyPart| {
        let numbers = numbers(&family.parameters, &part.ends);
        PlantSet::of(&numbers, &|at| members.plant(at)).is_ok_and(|it| part.plants.encloses(&it))
    };
    if let Some(place) = family.parts.iter().position(|part| !encloses(part)) {
        return Err(differs(format!("other plants in part {place}")));
    }
    match AsFlown::of(&members, template, of.0, || false) {
        Ok(AsFlown::NotHeld { at, because }) => Err(Differs {
            path: "family.at_rest",
            certified: "stable".to_owned(),
            flown: format!("at {}: {because}", member_in_words(&family.parameters, &at)),
        }),
        Ok(as_flown) => Ok(as_flown),
        Err(stopped) => Err(differs(stopped.to_string())),
    }
}
