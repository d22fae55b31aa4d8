//! Certificates for programs.

use fspid_numeric::scalar::Interval;
use fspid_proof::{Bearing, Certificate, Outcome, Rechecked, Verdict};
use serde_json::{Value, json};

use super::scope::{Told, told_deg};
use super::text::found;
use super::{
    Around, Certification, Certified, CheckedFile, Comparison, DisturbanceAnswer, NotProvable,
    Seal, family, nonlinear,
};
use fspid_study::json::{merged, present, with_null_reasons};

/// Version of the answer's shape.
const SCHEMA: u32 = 2;

/// Why nothing is said of steps.
const NO_STEPS: &str = "no step from rest is proved with limits acting; of gains that remember it is asked in cases with --steps alone";

/// Why nothing is said of the flights that a scenario commands.
const NO_FLIGHTS: &str = "the flights that the scenario commands are not proved with limits acting; in cases they are asked for with --steps alone";

/// Why keys of these answers are null.
pub(super) const NULLS: [(&str, &str); 26] = [
    ("partly", "everything that is commanded is certified, or no flights are"),
    ("decay_per_sample", "the claim is one of growth, or no rate is proved"),
    (
        "law_keeps_to_the_rate",
        "the claim is about no rate, or it is not shown that the law keeps to it",
    ),
    ("limits_left_out", "no limit is left out"),
    ("pitch_within_deg", "the claim holds for every pitch angle"),
    ("steps_within_deg", NO_STEPS),
    ("steps_load_within_deg", NO_STEPS),
    ("steps_limited_until_s", NO_STEPS),
    ("steps_after_rest_s", "no such step is proved, or no gains remember"),
    ("flights_setpoint_within_deg", NO_FLIGHTS),
    ("flights_load_within_deg", NO_FLIGHTS),
    ("flights_limited_until_s", NO_FLIGHTS),
    ("no_limit_acts_up_to", "there are no limits, or they are not covered"),
    ("open_because", "there is an answer, or nothing more is known of why there is none"),
    ("at", "no question can be asked of the family, or the loop as it is is not proved"),
    ("parts", "the family is not proved"),
    ("scales_may_change", "the family is not proved"),
    ("numbers_may_cross_in_s", "no pace is proved at which the numbers of the family may move"),
    ("box", "nothing is proved of the nonlinear aircraft"),
    ("begins_with", "nothing is proved of the nonlinear aircraft"),
    ("gains_near_trim", "nothing is proved of the nonlinear aircraft"),
    ("begins_within_deg", "nothing is proved of the nonlinear aircraft"),
    ("not_proved", "no factor was tried and not proved"),
    ("bearing", "the certificate does not hold"),
    ("bearing_in_words", "the certificate does not hold"),
    ("digests", "the text of the scenario is the one that was certified"),
];

impl Certification {
    /// The answer of `certify --format json`.
    #[must_use]
    pub fn json(&self) -> Value {
        let answer = json!({
            "schema": SCHEMA,
            "scenario": self.scenario,
            "controllers": self.results.iter().map(result).collect::<Vec<_>>(),
        });
        with_null_reasons(answer, &NULLS)
    }
}

fn result(certified: &Certified) -> Value {
    let of = json!({ "name": certified.controller, "plant_from_s": certified.from_s });
    let refused =
        |reason: &NotProvable| json!({ "verdict": "not provable", "reason": reason.to_string() });
    let family = certified.family.as_ref().map(family::in_json);
    let trouble = certified.trouble();
    let around = certified.around.as_ref().map(Around::json);
    let not_bounded = certified.disturbances.as_ref().and_then(DisturbanceAnswer::trouble);
    let nonlinear = certified.nonlinear.as_ref().map(nonlinear::in_json);
    let besides = present(json!({
        "family": family,
        "nonlinear": nonlinear,
        "outer_loops": around,
        "not_held": trouble,
        "disturbances_not_bounded": not_bounded,
    }));
    let proved = |found: &Outcome| outcome(found, trouble.is_none());
    merged([of, certified.outcome.as_ref().map_or_else(refused, proved), besides])
}

fn outcome(outcome: &Outcome, is_held: bool) -> Value {
    let verdict = match &outcome.verdict {
        Verdict::Proved(..) if !is_held => "not proved as it flies",
        Verdict::Proved(..) => "proved",
        Verdict::Refuted(..) => "refuted",
        Verdict::Open => "open",
    };
    let claim = |(certificate, rechecked): (&Certificate, &Rechecked)| {
        let bearing = match certificate.bearing(rechecked) {
            Bearing::Stable if !is_held => Bearing::PitchLoopStable,
            bearing => bearing,
        };
        json!({
            // Of an open answer the claim is one about less than the scenario asks.
            "claim_is_for_less": matches!(outcome.verdict, Verdict::Open),
            "claim": certificate.claim.name(),
            "decay_per_sample": certificate.claim.rate(),
            "inequalities": rechecked.inequalities,
            "boxes_of_gains": rechecked.cells,
            "every_combination_of_gains": !rechecked.gains_are_reached,
            "law_keeps_to_the_rate": kept(rechecked),
            "bearing": bearing.name(),
            "bearing_in_words": bearing.to_string(),
            "scope": Told::of(certificate, rechecked).json(),
        })
    };
    merged([
        json!({
            "verdict": verdict,
            "asked": {
                "setpoint_within_deg": told_deg(outcome.asked.setpoint_rad),
                "load_within_deg": told_deg(outcome.asked.load_rad),
            },
        }),
        found(outcome).map_or_else(|| json!({}), claim),
        json!({
            "gains": gains(outcome.bounds),
            "largest_output_factor": {
                "proved": outcome.largest.proved,
                "not_proved": outcome.largest.not_proved,
            },
            "open_because": outcome.open_because.as_ref().map(ToString::to_string),
        }),
    ])
}

/// Both ends of each gain.
fn gains(bounds: [Interval; 3]) -> Value {
    let [kp, ki, kd] = bounds.map(|gain| [gain.lower(), gain.upper()]);
    json!({ "kp": kp, "ki": ki, "kd": kd })
}

impl CheckedFile {
    /// The answer of `certify --check --format json`.
    #[must_use]
    pub fn json(&self) -> Value {
        let claim = &self.certificate.claim;
        // What does not hold bears on nothing that flies.
        let bearing = self.bearing().filter(|_| !self.answer().is_refused());
        let answer = merged([
            json!({
                "schema": SCHEMA,
                "holds": self.holds(),
                "answer": self.answer().name(),
                "claim": claim.name(),
                "decay_per_sample": claim.rate(),
                "output_factor": self.certificate.output_factor,
                "bearing": bearing.map(Bearing::name),
                "bearing_in_words": bearing.map(|bearing| bearing.to_string()),
                "origin": self.origin,
                "as_written": self.seal == Seal::Whole,
            }),
            match &self.result {
                Ok(rechecked) => json!({
                    "inequalities": rechecked.inequalities,
                    "boxes_of_gains": rechecked.cells,
                    "every_combination_of_gains": !rechecked.gains_are_reached,
                    "law_keeps_to_the_rate": kept(rechecked),
                    "scope": self.told(rechecked).json(),
                    "gains": gains(rechecked.bounds),
                }),
                Err(doubt) => json!({ "reason": doubt.to_string() }),
            },
            present(json!({
                "nonlinear": self.nonlinear().map(|(claim, it)| nonlinear::proved_in_json(&claim.reach, claim.begun, &it)),
                "against": self.against.as_ref().map(comparison),
            })),
        ]);
        with_null_reasons(answer, &NULLS)
    }
}

/// Where the law keeps to the rate of a claim about one; `null` where that is not shown, or not asked.
fn kept(rechecked: &Rechecked) -> Option<&'static str> {
    rechecked.keeps_to_the_rate.then_some("everywhere")
}

fn comparison(against: &Comparison) -> Value {
    let told = json!({
        "scenario": against.scenario,
        "same": against.is_same(),
        "differences": against.differences,
        "partly": against.partly,
        "digests": against.other_text,
    });
    merged([told, present(json!({ "members": against.members }))])
}
