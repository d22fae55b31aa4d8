//! Whether requirements are met.

use super::{Case, CasePlace, Evidence, NotEvaluated};
use crate::flight::ControllerResult;
use crate::metrics::Absent;
use fspid_diagnostics::digits;
use fspid_scenario::file::Study;
use fspid_scenario::measure::Family;
use fspid_scenario::requirement::Requirement;

/// What stands for a controller where the aircraft alone is judged.
pub const AIRCRAFT: &str = "(aircraft)";

/// True for a requirement of the aircraft alone, whoever flies it.
pub(crate) fn is_of_aircraft(requirement: &Requirement) -> bool {
    requirement.measure.family() == Family::Airframe && requirement.controller.is_none()
}

/// How a controller stands to a requirement.
#[derive(Clone, Debug, PartialEq)]
pub struct Judgement {
    /// Name of the controller, or [`AIRCRAFT`].
    pub controller: String,
    /// What is required.
    pub requirement: Requirement,
    /// The worst case, or why there is none (which never meets a requirement).
    pub found: Result<Case, NotEvaluated>,
    /// Whether it is met.
    pub met: bool,
    /// Size of the step, deg, where a ready set was judged on a flight of its own and not on that of the scenario.
    pub own_step_deg: Option<f64>,
}

impl Judgement {
    /// Judges one controller by its evidence.
    #[must_use]
    pub fn of(requirement: &Requirement, evidence: &Evidence<'_>) -> Self {
        let mut found = evidence.cases(requirement).and_then(|cases| worst(requirement, &cases));
        let met = found.as_ref().is_ok_and(|case| requirement.is_met_by(case.value));
        if let Ok(case) = &mut found
            && met
            && requirement.measure.is_yes_or_no()
        {
            // Stable everywhere: no place is worse than another.
            case.place = CasePlace::default();
        }
        let controller = match is_of_aircraft(requirement) {
            true => AIRCRAFT.to_owned(),
            false => evidence.controller().to_owned(),
        };
        Self { controller, requirement: requirement.clone(), found, met, own_step_deg: None }
    }

    /// True for a judgement of the aircraft alone, whoever flies it.
    #[must_use]
    pub fn is_of_aircraft(&self) -> bool {
        is_of_aircraft(&self.requirement)
    }

    /// Where the worst case is.
    #[must_use]
    pub fn place(&self) -> CasePlace {
        match &self.found {
            Ok(case) => case.place,
            Err(reason) => reason.place(),
        }
    }

    /// The value for people, with its unit, or why there is none.
    ///
    /// Five significant digits; all of them where five would hide on which side of the limit it is.
    #[must_use]
    pub fn value_in_words(&self) -> String {
        let value = match &self.found {
            Ok(case) => case.value,
            Err(reason) => return reason.to_string(),
        };
        if self.requirement.measure.is_yes_or_no() {
            let [yes, no] = self.requirement.measure.yes_and_no();
            return if value > 0.0 { yes } else { no }.to_owned();
        }
        if value.is_infinite() {
            return "without end".to_owned();
        }
        let short = digits::rounded(value, 5);
        let same_side = self.requirement.is_met_by(short) == self.met;
        let number = digits::shortest(if same_side { short } else { value });
        match self.requirement.measure.unit() {
            "" => number,
            unit => format!("{number} {unit}"),
        }
    }
}

/// The case that is nearest to its limits or farthest outside; the first of several.
pub(super) fn worst(requirement: &Requirement, cases: &[Case]) -> Result<Case, NotEvaluated> {
    let mut worst: Option<Case> = None;
    for case in cases {
        let slack = requirement.slack(case.value);
        let is_worse =
            worst.is_none_or(|worst| slack < requirement.slack(worst.value) || slack.is_nan());
        if is_worse {
            worst = Some(*case);
        }
    }
    worst.ok_or(NotEvaluated::Absent(Absent::NoStep))
}

/// Judges every requirement of a study for every controller that it concerns.
#[must_use]
pub fn judge(study: &Study, results: &[ControllerResult]) -> Vec<Judgement> {
    let evidence: Vec<Evidence<'_>> = study
        .scenario
        .flyers()
        .zip(results)
        .map(|(flyer, result)| Evidence::new(study, flyer, result))
        .collect();
    let mut judgements = Vec::new();
    for requirement in &study.requirements {
        let asked = |evidence: &&Evidence<'_>| {
            requirement.controller.as_ref().is_none_or(|name| name == evidence.controller())
        };
        // The aircraft alone is the same whoever flies it: it is judged once.
        let most = if is_of_aircraft(requirement) { 1 } else { usize::MAX };
        let concerned = evidence.iter().filter(asked).take(most);
        judgements.extend(concerned.map(|evidence| Judgement::of(requirement, evidence)));
    }
    judgements
}

#[cfg(test)]
mod tests {
    use super::*;
    use fspid_scenario::measure::Measure;
    use fspid_scenario::requirement::{AskedIn, Conditions, Origin};

    fn requirement(least: Option<f64>, most: Option<f64>) -> Requirement {
        Requirement {
            id: "x".to_owned(),
            controller: None,
            measure: Measure::ModeDamping,
            least,
            most,
            conditions: Conditions::default(),
            origin: Origin::default(),
            cases: AskedIn::default(),
        }
    }

    fn worst_of(requirement: &Requirement, values: &[f64]) -> f64 {
        let cases: Vec<Case> =
            values.iter().map(|&value| Case { value, place: CasePlace::default() }).collect();
        worst(requirement, &cases).expect("there are cases").value
    }

    #[test]
    fn what_is_equal_to_a_limit_meets_it_and_nan_meets_nothing() {
        let both = requirement(Some(0.3), Some(2.0));
        assert!(both.is_met_by(0.3) && both.is_met_by(2.0) && !both.is_met_by(2.0000000000000004));
        assert!(!both.is_met_by(f64::NAN));
        assert!(!requirement(None, None).is_met_by(f64::NAN));
        assert!(requirement(Some(6.0), None).is_met_by(f64::INFINITY));
        assert!(!requirement(Some(6.0), Some(20.0)).is_met_by(f64::INFINITY));
    }

    #[test]
    fn the_worst_case_is_the_one_nearest_to_its_limit_or_farthest_outside() {
        assert_eq!(worst_of(&requirement(Some(0.3), None), &[0.9, 0.4, 0.5]), 0.4);
        assert_eq!(worst_of(&requirement(None, Some(2.0)), &[0.9, 1.5, 0.4]), 1.5);
        assert_eq!(worst_of(&requirement(Some(0.3), Some(2.0)), &[0.9, 0.2, 2.5]), 2.5);
        assert!(worst_of(&requirement(Some(0.3), None), &[0.9, f64::NAN]).is_nan());
        let at = |at_s: f64| Case {
            value: 0.4,
            place: CasePlace { at_s: Some(at_s), ..CasePlace::default() },
        };
        let first = worst(&requirement(Some(0.3), None), &[at(1.0), at(2.0)]).expect("two");
        assert_eq!(first.place.at_s, Some(1.0));
    }

    #[test]
    fn a_value_is_never_shown_on_the_wrong_side_of_its_limit() {
        let judgement = |value: f64| {
            let requirement = requirement(Some(0.3), None);
            let met = requirement.is_met_by(value);
            let found = Ok(Case { value, place: CasePlace::default() });
            let (controller, own_step_deg) = ("c".to_owned(), None);
            Judgement { controller, requirement, found, met, own_step_deg }.value_in_words()
        };
        assert_eq!(judgement(0.299_999_999), "0.299999999");
        assert_eq!(judgement(0.300_000_001), "0.3");
        assert_eq!(judgement(0.123_456_789), "0.12346");
    }
}
