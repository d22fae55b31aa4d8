//! What is proved of the nonlinear aircraft in every case, each about its own trim: from the least that a flight may begin
//! off, within the largest of the boxes.

use fspid_proof::{Begun, CheckedNonlinear, Nonlinear, Reach};
use serde_json::{Value, json};

use super::CertifiedCases;
use crate::nonlinear;
use crate::text::found;

/// What holds of several loops.
struct Everywhere {
    reach: Reach,
    /// After a reset, where one of them asks for it.
    begun: Begun,
    checked: CheckedNonlinear,
    /// In which air; none where it is not the same everywhere.
    air: Option<String>,
}

impl Everywhere {
    fn of((claim, checked): (&Nonlinear, CheckedNonlinear)) -> Self {
        Self {
            reach: claim.reach,
            begun: claim.begun,
            checked,
            air: Some(nonlinear::air(&claim.aircraft)),
        }
    }

    /// What holds of both: whoever begins within the smaller pitch angle stays within the larger box, and ends as near.
    fn and(self, other: Self) -> Self {
        let largest =
            |one: [f64; 5], other: [f64; 5]| std::array::from_fn(|at| one[at].max(other[at]));
        let reach = Reach {
            motion: largest(self.reach.motion, other.reach.motion),
            command_rad: self.reach.command_rad.max(other.reach.command_rad),
        };
        let (one, other_checked) = (self.checked, other.checked);
        let checked = CheckedNonlinear {
            corners: one.corners.max(other_checked.corners),
            inequalities: one.inequalities + other_checked.inequalities,
            pitch_within_rad: one.pitch_within_rad.min(other_checked.pitch_within_rad),
            reached: largest(one.reached, other_checked.reached),
            gains: std::array::from_fn(|at| one.gains[at].hull(other_checked.gains[at])),
            remains: largest(one.remains, other_checked.remains),
        };
        let begun = if other.begun == Begun::Reset { Begun::Reset } else { self.begun };
        Self { reach, begun, checked, air: self.air.filter(|it| other.air.as_ref() == Some(it)) }
    }

    fn sentence(&self) -> String {
        let air = self.air.as_deref().unwrap_or("of its own case");
        format!(
            "PROVED: the equations of motion themselves, in every case about its own trim: a flight that begins{begun}{stays}, at samples and between them, meets no limit, {comes}; {conditions}",
            begun = nonlinear::begun_and(self.begun, &self.checked),
            stays = nonlinear::stays(&self.reach, &self.checked),
            comes = nonlinear::comes(&self.checked),
            conditions = nonlinear::conditions(air),
        )
    }
}

impl CertifiedCases {
    /// Whether the nonlinear aircraft was asked for.
    fn asks_for_nonlinear(&self) -> bool {
        let mut results = self.cases.iter().flat_map(|case| &case.certification.results);
        results.any(|it| it.nonlinear.is_some())
    }

    /// What is proved in all cases of a controller; none where one is missing.
    fn near_trim_everywhere(&self, controller: &str) -> Option<Everywhere> {
        let each = self.in_every_change(controller)?.into_iter().map(|certified| {
            let (certificate, rechecked) = found(certified.outcome.as_ref().ok()?)?;
            let claim = certificate.nonlinear.as_ref().zip(rechecked.nonlinear)?;
            Some(Everywhere::of(claim))
        });
        each.collect::<Option<Vec<Everywhere>>>()?.into_iter().reduce(Everywhere::and)
    }

    /// A sentence about all cases of a controller; none where it was not asked for.
    pub(super) fn near_trim_in_words(&self, controller: &str) -> Option<String> {
        let open = || "OPEN: the nonlinear aircraft is not proved in every case".to_owned();
        let found = self.near_trim_everywhere(controller);
        self.asks_for_nonlinear().then(|| found.map_or_else(open, |it| it.sentence()))
    }

    /// The same for programs; empty where it was not asked for.
    pub(super) fn near_trim_in_json(&self, controller: &str) -> Value {
        let Some(in_words) = self.near_trim_in_words(controller) else { return json!({}) };
        let found = self.near_trim_everywhere(controller);
        let mut answer = found.map_or_else(nonlinear::open_in_json, |it| {
            nonlinear::proved_in_json(&it.reach, it.begun, &it.checked)
        });
        answer["in_words"] = in_words.into();
        json!({ "nonlinear": answer })
    }
}
