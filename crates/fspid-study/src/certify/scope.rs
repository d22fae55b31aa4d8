//! What is said beside a verdict: where the claim holds and what it does not speak of, the same in every
//! answer, in text and JSON, from a proof and from a certificate that is checked.

use fspid_proof::{Certificate, LeftOut, Range, Rechecked, Scope};
use serde_json::{Value, json};

use super::text::line;
use crate::metrics::short;
use crate::units::degrees;

/// The scope of a claim, ready to be told.
pub(super) struct Told {
    /// None for a claim of growth, which is about no range.
    stable: Option<Stable>,
    left_out: Vec<LeftOut>,
}

/// What is said of claims of stability alone.
struct Stable {
    scope: Scope,
    /// Why limits are left out, where the reason is the actuator.
    reason: Option<&'static str>,
    /// False for a claim that no level was found for.
    has_level: bool,
}

impl Told {
    pub(super) fn of(certificate: &Certificate, rechecked: &Rechecked) -> Self {
        let scope = certificate.scope(rechecked);
        let left_out = scope.left_out.clone();
        let stable = certificate.claim.is_of_stability().then(|| Stable {
            scope,
            reason: certificate.description.limits_left_out(),
            has_level: certificate.level.is_some(),
        });
        Self { stable, left_out }
    }

    /// Sentences, each with what it is about.
    pub(super) fn sentences(&self) -> Vec<(&'static str, String)> {
        let mut sentences = Vec::new();
        if let Some(stable) = &self.stable {
            sentences.push(("holds for", range_in_words(&stable.scope)));
            if stable.scope.rest_error_rad > 0.0 {
                sentences.push(("error at rest", rest_error(&stable.scope)));
            }
            sentences.push(("remains", remains(&stable.scope)));
            sentences.push(("limits", stable.limits()));
        }
        let left_out = self.left_out.iter().enumerate();
        sentences.extend(left_out.map(|(place, one)| {
            (if place == 0 { "not in this claim" } else { "" }, one.to_string())
        }));
        sentences
    }

    pub(super) fn push(&self, out: &mut String) {
        for (about, sentence) in self.sentences() {
            line(out, format_args!("  {about:<18} {sentence}"));
        }
    }

    pub(super) fn json(&self) -> Value {
        let mut told = json!({
            "not_in_this_claim": self.left_out.iter().map(|one| one.name()).collect::<Vec<_>>(),
            "sentences": self.sentences().into_iter().map(|(_, it)| it).collect::<Vec<_>>(),
        });
        if let Some(stable) = &self.stable {
            let Scope {
                range,
                any_setpoint,
                any_load,
                rest_error_rad,
                remains_rad,
                limits,
                pitch_within_rad,
                left_out: _,
            } = &stable.scope;
            told["rest_error_deg"] = json!(degrees(*rest_error_rad));
            told["setpoint_within_deg"] = json!(degrees(range.setpoint_rad));
            told["any_setpoint"] = json!(any_setpoint);
            told["load_within_deg"] = json!(degrees(range.load_rad));
            told["any_load"] = json!(any_load);
            told["remains_deg"] = json!(degrees(*remains_rad));
            told["limits"] = json!(limits);
            told["pitch_within_deg"] = json!(pitch_within_rad.map(degrees));
        }
        told
    }
}

/// Set-points and loads in words.
pub(super) fn range_in_words(scope: &Scope) -> String {
    let setpoints = match (scope.any_setpoint, degrees(scope.range.setpoint_rad)) {
        (true, _) => "every constant set-point".to_owned(),
        (false, 0.0) => "the set-point at the trim alone".to_owned(),
        (false, most) => format!("constant set-points up to {} deg from the trim", short(most)),
    };
    let loads = match (scope.any_load, degrees(scope.range.load_rad)) {
        (true, _) => "every constant load".to_owned(),
        (false, 0.0) => "no load".to_owned(),
        (false, most) => format!("constant loads up to {} deg of elevator", short(most)),
    };
    let unlimited = scope.any_setpoint || scope.any_load;
    let limited = if unlimited && !scope.limits.is_empty() { ", while no limit acts" } else { "" };
    format!("{setpoints}, {loads}{limited}")
}

/// A range that a scenario asks for, in words.
pub(super) fn asked_in_words(range: Range) -> String {
    format!(
        "constant set-points up to {} deg from the trim, constant loads up to {} deg of elevator",
        short(degrees(range.setpoint_rad)),
        short(degrees(range.load_rad))
    )
}

/// For a cell of a table: set-points, loads, and whether limits are covered.
pub(crate) fn in_short(certificate: &Certificate, rechecked: &Rechecked) -> String {
    let scope = certificate.scope(rechecked);
    let limits = match (scope.limits.is_empty(), scope.pitch_within_rad) {
        (true, _) => "",
        (false, Some(_)) => "; near enough to rest that no limit acts",
        (false, None) => "; saturation is not covered",
    };
    format!("for {}{limits}", range_in_words(&scope))
}

fn rest_error(scope: &Scope) -> String {
    let most = short(degrees(scope.rest_error_rad));
    format!("rest is up to {most} deg from the set-point: there is no integral")
}

fn remains(scope: &Scope) -> String {
    let angle = |most: f64| if most < 1e-3 { format!("{most:.1e}") } else { short(most) };
    let rest = match degrees(scope.rest_error_rad) {
        0.0 => "rest".to_owned(),
        most => format!(
            "rest, which without an integral may be up to {} deg off the set-point",
            angle(most)
        ),
    };
    match degrees(scope.remains_rad) {
        0.0 => format!("nothing: every deviation dies out towards {rest}"),
        most => format!("the pitch angle may stay up to {} deg off {rest}", angle(most)),
    }
}

impl Stable {
    /// The set-points and loads that limits are covered for, where the claim itself is about more.
    fn held(&self) -> String {
        let Scope { range, any_setpoint, any_load, .. } = &self.scope;
        if !(*any_setpoint || *any_load) {
            return String::new();
        }
        let [setpoint, load] = [range.setpoint_rad, range.load_rad].map(|it| short(degrees(it)));
        format!(" at set-points up to {setpoint} deg and loads up to {load} deg")
    }

    fn limits(&self) -> String {
        let limits = self.scope.limits.join(", ");
        match (limits.as_str(), self.scope.pitch_within_rad, self.reason) {
            ("", ..) => "there are none in this loop".to_owned(),
            (_, Some(pitch_rad), _) => format!(
                "with a pitch angle off by up to {:.3} deg, all else at rest{}, none acts: {limits}",
                degrees(pitch_rad),
                self.held()
            ),
            (_, None, Some(reason)) => format!("SATURATION IS NOT COVERED: {limits}; {reason}"),
            (_, None, None) if self.has_level => {
                format!("SATURATION IS NOT COVERED: {limits}; rest itself lies at a limit")
            }
            (_, None, None) => format!("SATURATION IS NOT COVERED: {limits}"),
        }
    }
}
