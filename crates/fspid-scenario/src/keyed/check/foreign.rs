//! What keys are called by other tools, and how it is written here.

use crate::keyed::document::{Member, Value};
use fspid_diagnostics::digits::shortest;

/// The state-space form of a plant.
const STATES: [&str; 4] = ["A", "B", "C", "D"];
/// The plant by where it has poles and zeros.
const PLACES: [&str; 6] = ["zeros", "poles", "gain", "z", "p", "k"];
/// Other names of keys that are here.
const NAMES: [(&str, &str); 6] = [
    ("num", "numerator"),
    ("den", "denominator"),
    ("ts", "sample_period_s"),
    ("dt", "sample_period_s"),
    ("tf", "derivative_filter_s"),
    ("t_end", "duration_s"),
];
/// Keys of the standard form of a PID, as others and as this program call them.
const STANDARD: [(&[&str], &str); 4] = [
    (&["kp", "k", "kc"], "gain"),
    (&["ti", "ti_s", "tau_i"], "ti_s"),
    (&["td", "td_s", "tau_d"], "td_s"),
    (&["n"], "n"),
];

/// What follows "unknown key" where the key is one of another tool, and the key of this table that it stands for, if it is
/// one alone.
pub(super) fn of_key(
    name: &str,
    members: &[Member],
    known: &[&'static str],
) -> Option<(Option<&'static str>, String)> {
    let lower = name.to_lowercase();
    let is_known = |key: &str| known.contains(&key);
    if let Some(&(_, key)) = NAMES.iter().find(|(other, key)| *other == lower && is_known(key)) {
        return Some((Some(key), format!("did you mean `{key}`?")));
    }
    if is_known("numerator") && STATES.contains(&name) {
        let told = "a plant is polynomials: `[num, den] = ss2tf(A, B, C, D)` gives them";
        return Some((None, told.to_owned()));
    }
    if is_known("numerator") && PLACES.contains(&lower.as_str()) {
        let told = "a plant is polynomials: `[num, den] = zp2tf(z, p, k)` gives them";
        return Some((None, told.to_owned()));
    }
    let (form, parallel) = standard_form(known)?;
    if lower == "n" && is_known("derivative_filter_s") && !has_times(members) {
        let told = "a coefficient N of the derivative's filter is `derivative_filter_s`, 1/N in s";
        return Some((None, format!("{told}; a ratio N is `n` of `{form}`")));
    }
    let is_of_standard = STANDARD[1..].iter().any(|(others, _)| others.contains(&lower.as_str()));
    let told =
        || format!("in the standard form: `{form} = {{ {} }}`, {parallel}", standard(members));
    is_of_standard.then(|| (None, told()))
}

/// The key of gains in standard form that belongs to a table, and what it stands in place of; none of other tables.
fn standard_form(known: &[&str]) -> Option<(&'static str, &'static str)> {
    let is_known = |key: &str| known.contains(&key);
    if is_known("isa") {
        Some(("isa", "in place of kp, ki, kd"))
    } else if is_known("nominal_isa") || (is_known("ki") && !is_known("kind")) {
        // Of the gains of a self-tuner the table beside them is meant.
        Some(("nominal_isa", "in place of `nominal`"))
    } else {
        None
    }
}

/// True for an integral or derivative time among the keys.
fn has_times(members: &[Member]) -> bool {
    STANDARD[1..3].iter().any(|(others, _)| number(members, others).is_some())
}

/// The numbers that are given, as the standard form has them.
fn standard(members: &[Member]) -> String {
    let one = |(others, key): &(&[&str], &str)| match number(members, others) {
        Some(number) => Some(format!("{key} = {}", shortest(number))),
        None => (*key == "gain").then(|| "gain = …".to_owned()),
    };
    STANDARD.iter().filter_map(one).collect::<Vec<_>>().join(", ")
}

/// The number of the key that has one of these names.
fn number(members: &[Member], names: &[&str]) -> Option<f64> {
    let named = |member: &&Member| names.contains(&member.name.to_lowercase().as_str());
    match members.iter().find(named)?.item.value {
        Value::Integer(number, _) | Value::Float(number) => Some(number),
        _ => None,
    }
}
