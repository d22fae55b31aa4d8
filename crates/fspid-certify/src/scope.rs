//! What is said beside a verdict: where the claim holds and what it does not speak of, the same in every
//! answer, in text and JSON, from a proof and from a certificate that is checked.

use fspid_diagnostics::digits::to_six_decimals;
use fspid_proof::{
    Certificate, Claim, Commands, Ended, LeftOut, Range, Rechecked, Scope, Shares, Stepped, Way,
};
use serde_json::{Value, json};

use super::text::{Line, is_fixed};
use super::told::{at_least, at_most};
use super::{disturbances, family, nonlinear};
use fspid_scenario::turned::turned_in_words;
use fspid_scenario::units::degrees;
use fspid_study::json::merged;

/// What the first of the sentences is about that say what a claim does not speak of; the others have nothing there.
pub(super) const NOT_IN_CLAIM: &str = "not in this claim";

/// What is proved of air by a certificate that is held against no scenario.
const AIR_OF_THE_FILE: &str = "proved of gusts is what they do as the file says that the plant feels them; that this plant does is computed by \
                               --against SCENARIO";

/// The scope of a claim, ready to be told.
pub(super) struct Told {
    /// None for a claim of growth, which is about no range.
    stable: Option<Scope>,
    left_out: Vec<LeftOut>,
    family: Vec<String>,
    /// How gains move, after a bound of disturbances.
    moving: &'static str,
    nonlinear: Option<String>,
    /// What is commanded, where flights are claimed.
    commanded: String,
    /// How the plant feels the air nobody has computed.
    air_is_of_the_file: bool,
    /// That gains have a sign that turns the loop around, where they do.
    turned: Option<String>,
}

impl Told {
    pub(super) fn of(certificate: &Certificate, rechecked: &Rechecked) -> Self {
        let scope = certificate.scope(rechecked);
        let left_out = scope.left_out.clone();
        let stable = certificate.claim.is_of_stability().then_some(scope);
        let family = certificate.family.as_ref().zip(rechecked.family);
        let family = family.map_or_else(Vec::new, |(family, _)| family::sentences(family));
        let nonlinear = certificate.nonlinear.as_ref().zip(rechecked.nonlinear);
        let nonlinear = nonlinear.map(|(claim, it)| nonlinear::sentence(certificate, claim, &it));
        let moving = match &certificate.claim {
            _ if is_fixed(certificate) => "",
            Claim::BoundedRate(_) => ", with gains moving no faster than the law lets them",
            _ => ", with gains moving as they like",
        };
        let dt_s = certificate.description.controller.config().dt_s;
        let commanded = certificate.commanded.as_ref();
        let commanded =
            commanded.map(|it| commands_in_words(&it.commands, dt_s)).unwrap_or_default();
        let turned = turned_in_words(certificate.description.controller.nominal());
        let air_is_of_the_file = false;
        Self { stable, left_out, family, moving, nonlinear, commanded, air_is_of_the_file, turned }
    }

    /// As [`of`](Self::of) of a certificate that was read and held against no scenario: what its words make of its plants
    /// nobody has computed.
    pub(super) fn read(certificate: &Certificate, rechecked: &Rechecked) -> Self {
        let mut told = Self::of(certificate, rechecked);
        if !told.family.is_empty() {
            let words = "proved are the plants in the file; that they are those of the numbers named is computed by --against SCENARIO";
            told.family.push(words.to_owned());
        }
        told.air_is_of_the_file = told
            .stable
            .iter()
            .flat_map(|scope| &scope.disturbed)
            .any(|it| matches!(it.way, Way::Air { .. }));
        if let Some(sentence) = &mut told.nonlinear {
            sentence.push_str(
                "; everything was enclosed anew from the aircraft in the file; that it is the scenario's is asked by --against SCENARIO",
            );
        }
        told
    }

    /// Sentences, each with what it is about.
    pub(super) fn sentences(&self) -> Vec<Line> {
        let mut sentences = Vec::new();
        if let Some(scope) = &self.stable {
            sentences.push(("holds for", range_in_words(scope)));
            sentences.extend(self.turned.iter().map(|it| ("sign", sign(it))));
            if scope.rest_error_rad > 0.0 {
                sentences.push(("error at rest", rest_error(scope)));
            }
            sentences.push(("remains", remains(scope)));
            sentences.push(("limits", limits(scope)));
            sentences.extend(scope.stepped.map(|stepped| ("steps", steps(&stepped))));
            sentences.extend(
                scope.ended.map(|ended| ("flights", flights(&ended, scope.range, &self.commanded))),
            );
            let disturbed = disturbances::sentences(scope, self.moving);
            let of_the_file = self.air_is_of_the_file.then(|| AIR_OF_THE_FILE.to_owned());
            let disturbed = disturbed.into_iter().chain(of_the_file);
            sentences.extend(disturbed.map(|it| ("disturbances", it)));
        }
        sentences.extend(self.family.iter().map(|sentence| ("family", sentence.clone())));
        sentences.extend(self.nonlinear.iter().map(|it| ("nonlinear", it.clone())));
        let left_out = self.left_out.iter().enumerate();
        sentences.extend(left_out.map(|(place, one)| {
            let about = if place == 0 { NOT_IN_CLAIM } else { "" };
            (about, disturbances::left_out(*one, self.stable.as_ref()))
        }));
        sentences
    }

    pub(super) fn json(&self) -> Value {
        let told = json!({
            "not_in_this_claim": self.left_out.iter().map(|one| one.name()).collect::<Vec<_>>(),
            "sentences": self.sentences().into_iter().map(|(_, it)| it).collect::<Vec<_>>(),
        });
        let stable = |scope: &Scope| {
            let Scope {
                range,
                any_setpoint,
                any_load,
                rest_error_rad,
                remains_rad,
                limits,
                pitch_within_rad,
                limits_left_out,
                stepped,
                ended,
                disturbed,
                left_out: _,
            } = scope;
            let bounds = match disturbed.is_empty() {
                true => json!({}),
                false => disturbances::in_json(scope),
            };
            let told = json!({
                "rest_error_deg": told_deg(*rest_error_rad),
                "setpoint_within_deg": told_deg(range.setpoint_rad),
                "any_setpoint": any_setpoint,
                "load_within_deg": told_deg(range.load_rad),
                "any_load": any_load,
                "remains_deg": told_deg(*remains_rad),
                "limits": limits,
                "pitch_within_deg": pitch_within_rad.map(told_deg),
                "limits_left_out": limits_left_out,
                "steps_within_deg": stepped.map(|it| told_deg(it.setpoint_rad)),
                "steps_load_within_deg": stepped.map(|it| told_deg(it.load_rad)),
                "steps_limited_until_s": stepped.map(|it| limited_until_s(it.limited, it.settled_s)),
                "steps_after_rest_s": stepped.and_then(|it| it.rested_s),
                "flights_setpoint_within_deg": ended.map(|it| told_deg(it.setpoint_rad)),
                "flights_load_within_deg": ended.map(|it| told_deg(it.load_rad)),
                "flights_limited_until_s": ended.map(|it| limited_until_s(it.limited, it.settled_s)),
            });
            merged([told, bounds])
        };
        merged([told, self.stable.as_ref().map_or_else(|| json!({}), stable)])
    }
}

/// Set-points and loads in words.
pub(super) fn range_in_words(scope: &Scope) -> String {
    let setpoints = match (scope.any_setpoint, degrees(scope.range.setpoint_rad)) {
        (true, _) => "every constant set-point".to_owned(),
        (false, 0.0) => "the set-point at the trim alone".to_owned(),
        (false, most) => {
            format!("constant set-points up to {} deg from the trim", to_six_decimals(most))
        }
    };
    let loads = match (scope.any_load, degrees(scope.range.load_rad)) {
        (true, _) => "every constant load".to_owned(),
        (false, 0.0) => "no load".to_owned(),
        (false, most) => format!("constant loads up to {} deg of elevator", to_six_decimals(most)),
    };
    let unlimited = scope.any_setpoint || scope.any_load;
    let limited = if unlimited && !scope.limits.is_empty() { ", while no limit acts" } else { "" };
    format!("{setpoints}, {loads}{limited}")
}

/// A range that a scenario asks for, in words.
pub(super) fn asked_in_words(range: Range) -> String {
    format!(
        "constant set-points up to {} deg from the trim, constant loads up to {} deg of elevator",
        to_six_decimals(degrees(range.setpoint_rad)),
        to_six_decimals(degrees(range.load_rad))
    )
}

/// For a cell of a table: set-points, loads, what error stays, and whether limits are covered.
#[must_use]
pub fn in_short(certificate: &Certificate, rechecked: &Rechecked) -> String {
    let scope = certificate.scope(rechecked);
    let limits = match (scope.limits.is_empty(), scope.pitch_within_rad) {
        (true, _) => "",
        (false, Some(_)) => "; near enough to rest that no limit acts",
        (false, None) => "; saturation is not covered",
    };
    let off = match scope.rest_error_rad {
        0.0 => String::new(),
        _ => format!("; {}", rest_error(&scope)),
    };
    format!("for {}{off}{limits}", range_in_words(&scope))
}

fn rest_error(scope: &Scope) -> String {
    if !scope.rest_error_rad.is_finite() {
        return "nothing bounds how far rest is from the set-point: there is no integral"
            .to_owned();
    }
    let most = to_six_decimals(degrees(scope.rest_error_rad));
    let at = held(scope.range);
    format!("REST IS SEEN UP TO {most} deg FROM THE SET-POINT, at {at}: there is no integral")
}

fn remains(scope: &Scope) -> String {
    let rest = match scope.rest_error_rad {
        0.0 => "rest",
        _ => "rest, which without an integral is not the set-point",
    };
    match degrees(scope.remains_rad) {
        0.0 => format!("nothing: every deviation dies out towards {rest}"),
        most => format!("the pitch angle may stay up to {} deg off {rest}", at_most(most)),
    }
}

/// What a claim of a loop with gains of the other sign is worth.
fn sign(turned: &str) -> String {
    format!(
        "{turned}: proved is the loop with elevator_sign as it is written; if that is wrong, the aircraft's own loop is another one"
    )
}

/// What becomes of limits.
fn limits(scope: &Scope) -> String {
    let named = scope.limits.join(", ");
    match (named.as_str(), scope.pitch_within_rad, scope.limits_left_out) {
        ("", ..) => "there are none in this loop".to_owned(),
        (_, Some(pitch_rad), _) => format!(
            "none acts where the pitch angle begins up to {} deg off rest and nothing else is off, at {}: {named}",
            at_least(degrees(pitch_rad)),
            held(scope.range)
        ),
        (_, None, Some(reason)) => format!("SATURATION IS NOT COVERED: {named}; {reason}"),
        (_, None, None) => format!("SATURATION IS NOT COVERED: {named}"),
    }
}

/// Steps from rest, limits acting on the way. With an integral that is the set-point; the error at rest is told beside it.
fn steps(stepped: &Stepped) -> String {
    let [setpoint, load] = [stepped.setpoint_rad, stepped.load_rad].map(degrees);
    let loaded = match load {
        0.0 => String::new(),
        most => {
            format!(" and of a load by up to {} deg of elevator at once", to_six_decimals(most))
        }
    };
    let settled_s = to_six_decimals(stepped.settled_s);
    let acting = acting(stepped.limited, &format!("{settled_s} s later"));
    let rest = match stepped.rested_s {
        None => "from rest at the trim".to_owned(),
        Some(rested_s) => format!(
            "from rest at the trim, at the controller's first sample or after a rest of {} s",
            to_six_decimals(rested_s)
        ),
    };
    format!(
        "{rest}, sensors without bias, any step of the set-point by up to {} deg{loaded} ends where the loop without limits does, {acting}",
        to_six_decimals(setpoint)
    )
}

/// Until when a limit acts at most, s.
pub(super) fn limited_until_s(limited: bool, settled_s: f64) -> f64 {
    if limited { settled_s } else { 0.0 }
}

/// What limits do on the way, and the time after which none acts any more.
fn acting(limited: bool, settled: &str) -> String {
    match limited {
        true => format!("with its limits acting on the way; {settled} none acts any more"),
        false => "and no limit acts at any time".to_owned(),
    }
}

/// The flights that a scenario commands, limits acting on the way.
fn flights(ended: &Ended, range: Range, commanded_over_time: &str) -> String {
    let [setpoint, load] = [ended.setpoint_rad, ended.load_rad].map(degrees);
    let commanded = match (setpoint > 0.0, load > 0.0) {
        (true, true) => format!(
            "the set-point over time as commanded, times any number up to {} deg either way, and the loads likewise up to {} deg of elevator",
            to_six_decimals(setpoint),
            to_six_decimals(load)
        ),
        (true, false) => format!(
            "the set-point over time as commanded, times any number up to {} deg either way",
            to_six_decimals(setpoint)
        ),
        (false, _) => format!(
            "the loads over time as commanded, times any number up to {} deg of elevator either way",
            to_six_decimals(load)
        ),
    };
    let smaller = ended.setpoint_rad < range.setpoint_rad || ended.load_rad < range.load_rad;
    let part = if smaller { "; OF LARGER ONES THIS IS NOT SHOWN" } else { "" };
    format!(
        "from rest at the trim at the controller's first sample, sensors without bias, {commanded} ({commanded_over_time}): each flight ends where the loop without limits does, {}{part}",
        acting(ended.limited, &format!("from {} s on", to_six_decimals(ended.settled_s)))
    )
}

/// Changes of a signal that are told one by one.
const TOLD: usize = 4;

/// Set-point and loads over time.
pub(super) fn commands_in_words(commands: &Commands, dt_s: f64) -> String {
    let Commands { setpoint_rad, load_rad, setpoint, at_servo, at_elevator } = commands;
    let parts = [
        ("set-point", setpoint_rad, setpoint),
        ("load at the servo", load_rad, at_servo),
        ("load at the elevator", load_rad, at_elevator),
    ];
    let parts = parts.into_iter().filter(|(_, size, shares)| **size > 0.0 && !shares.0.is_empty());
    let said = parts.map(|(what, size, Shares(changes))| {
        let change = |(sample, share): &(usize, f64)| {
            format!("{} from {} s", to_six_decimals(*share), to_six_decimals(*sample as f64 * dt_s))
        };
        let told: Vec<String> = changes.iter().take(TOLD).map(change).collect();
        let more = match changes.len().saturating_sub(TOLD) {
            0 => String::new(),
            more => format!(" and {more} changes more"),
        };
        format!(
            "{what} of {} deg times {}{more}",
            to_six_decimals(size.to_degrees()),
            told.join(", ")
        )
    });
    said.collect::<Vec<_>>().join("; ")
}

/// The set-points and loads that limits are covered for, which may be fewer than those of the claim itself.
fn held(range: Range) -> String {
    let [setpoint, load] =
        [range.setpoint_rad, range.load_rad].map(|it| to_six_decimals(degrees(it)));
    let setpoints = match range.setpoint_rad {
        0.0 => "the trim".to_owned(),
        _ => format!("set-points up to {setpoint} deg"),
    };
    match range.load_rad {
        0.0 => format!("{setpoints} without load"),
        _ => format!("{setpoints} under loads up to {load} deg"),
    }
}

/// An angle for programs: without the last digits, which are those of the conversion.
pub(super) fn told_deg(radians: f64) -> f64 {
    const DIGITS: i32 = 12;
    let angle = degrees(radians);
    if angle == 0.0 || !angle.is_finite() {
        return angle;
    }
    let scale = libm::pow(10.0, f64::from(DIGITS - 1) - libm::floor(libm::log10(angle.abs())));
    let told = libm::round(angle * scale) / scale;
    if told.is_finite() { told } else { angle }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::float_cmp, reason = "the same numbers are asked for")]

    use super::*;

    /// "0.16 s later it is near rest", with 97 % of the step still to go.
    #[test]
    fn steps_that_no_limit_touches_are_told_without_a_time() {
        assert_eq!(acting(false, "0.16 s later"), "and no limit acts at any time");
        let limited = "with its limits acting on the way; 3 s later none acts any more";
        assert_eq!(acting(true, "3 s later"), limited);
        assert_eq!([false, true].map(|limited| limited_until_s(limited, 3.0)), [0.0, 3.0]);
    }
}
