//! The numbers of a claim with their units, never better than what is proved.

use fspid_diagnostics::digits::to_six_decimals;
use fspid_page::analysis::{DataTable, Datum};
use fspid_page::number::significant;
use fspid_proof::{Certificate, Family, Parameter, Rechecked, Scope};
use fspid_scenario::units::degrees;

use crate::scope::limited_until_s;
use crate::text::{GAINS_REACHED, found, time_constant_s};
use crate::told::{at_least, at_most};
use crate::{Certified, FamilyAnswer, disturbances};

/// Every table of a loop: what the claim holds for, bounds of disturbances, the box of a family, the gains.
pub(super) fn of(certified: &Certified) -> Vec<DataTable> {
    let Ok(outcome) = &certified.outcome else { return Vec::new() };
    let stable = found(outcome).filter(|(certificate, _)| certificate.claim.is_of_stability());
    let mut tables = Vec::new();
    if let Some((certificate, rechecked)) = stable {
        tables.push(holds_for(certificate, rechecked));
        tables.extend(disturbed(&certificate.scope(rechecked)));
    }
    if let Some(FamilyAnswer::Verdict { parameters, .. }) = &certified.family {
        tables.push(family(parameters));
    }
    tables.extend(certified.family.as_ref().and_then(FamilyAnswer::proved).map(moving));
    let bounds = outcome.bounds.map(|it| [it.lower(), it.upper()]);
    let is_reached = found(outcome).is_some_and(|(_, rechecked)| rechecked.gains_are_reached);
    tables.push(gains(bounds, is_reached));
    tables
}

fn table(caption: &str, head: &[&str], rows: Vec<Vec<Datum>>) -> DataTable {
    let head = head.iter().map(|it| (*it).to_owned()).collect();
    DataTable { caption: caption.to_owned(), head, rows, cards: true }
}

/// A number of the claim: what it is, the number or words in its place, and its unit.
fn row(what: &str, value: Datum, unit: &str) -> Vec<Datum> {
    vec![Datum::Text(what.to_owned()), value, Datum::Text(unit.to_owned())]
}

fn number(value: String) -> Datum {
    Datum::Number(value)
}

fn angle(radians: f64) -> Datum {
    number(to_six_decimals(degrees(radians)))
}

fn seconds(value_s: f64) -> Datum {
    number(to_six_decimals(value_s))
}

/// An angle of a range, or that it is no range.
fn range(scope: &Scope, is_any: bool, radians: f64) -> (Datum, &'static str) {
    match (is_any, scope.limits.is_empty()) {
        (true, true) => (Datum::Absent("every".to_owned()), ""),
        (true, false) => (Datum::Absent("every, while no limit acts".to_owned()), ""),
        (false, _) => (angle(radians), "deg"),
    }
}

fn holds_for(certificate: &Certificate, rechecked: &Rechecked) -> DataTable {
    let scope = certificate.scope(rechecked);
    let (setpoint, setpoint_unit) = range(&scope, scope.any_setpoint, scope.range.setpoint_rad);
    let (load, load_unit) = range(&scope, scope.any_load, scope.range.load_rad);
    let mut rows = vec![
        row("constant set-points, from the trim, up to", setpoint, setpoint_unit),
        row("constant loads, as elevator, up to", load, load_unit),
    ];
    if scope.rest_error_rad > 0.0 {
        let value = match scope.rest_error_rad.is_finite() {
            true => (angle(scope.rest_error_rad), "deg"),
            false => (Datum::Absent("no bound".to_owned()), ""),
        };
        rows.push(row("rest seen from the set-point, up to", value.0, value.1));
    }
    let remains = number(at_most(degrees(scope.remains_rad)));
    rows.push(row("pitch angle that may stay off rest, up to", remains, "deg"));
    if let Some(pitch_rad) = scope.pitch_within_rad {
        let value = number(at_least(degrees(pitch_rad)));
        rows.push(row("pitch angle off rest from which no limit acts, up to", value, "deg"));
    }
    rows.extend(from_rest(&scope));
    if let Some(rate) = certificate.claim.rate().filter(|rate| *rate < 1.0) {
        let dt_s = certificate.description.controller.config().dt_s;
        let time = number(time_constant_s(rate, dt_s));
        rows.push(row("decay of every deviation, time constant at most", time, "s"));
        rows.push(row("the same, a sample", number(format!("{rate:.8}")), ""));
    }
    table("What the claim holds for.", &["what", "value", "unit"], rows)
}

/// Steps and flights from rest, with limits acting on the way.
fn from_rest(scope: &Scope) -> Vec<Vec<Datum>> {
    let mut rows = Vec::new();
    if let Some(steps) = &scope.stepped {
        rows.push(row("steps of the set-point from rest, up to", angle(steps.setpoint_rad), "deg"));
        rows.push(row("steps of a load at once, up to", angle(steps.load_rad), "deg"));
        if let Some(rested_s) = steps.rested_s {
            rows.push(row("rest before a step, at least", seconds(rested_s), "s"));
        }
        let until = seconds(limited_until_s(steps.limited, steps.settled_s));
        rows.push(row("no limit acts any more after a step by", until, "s"));
    }
    if let Some(flights) = &scope.ended {
        let setpoint = angle(flights.setpoint_rad);
        rows.push(row("flights as commanded, set-point up to", setpoint, "deg"));
        rows.push(row("flights as commanded, load up to", angle(flights.load_rad), "deg"));
        let until = seconds(limited_until_s(flights.limited, flights.settled_s));
        rows.push(row("no limit acts any more in those flights from", until, "s"));
    }
    rows
}

fn disturbed(scope: &Scope) -> Option<DataTable> {
    let row = |cells: [String; 5]| {
        let [way, measure, quantity, bound, unlimited] = cells;
        let words = [way, measure, quantity].map(Datum::Text);
        let numbers = [bound, unlimited].map(Datum::Number);
        words.into_iter().chain(numbers).collect()
    };
    let rows: Vec<Vec<Datum>> =
        scope.disturbed.iter().map(|one| row(disturbances::cells(one))).collect();
    let head = ["disturbance", "measured by", "moves", "by at most", "no limit acts up to"];
    let caption = "What disturbances do at most, from rest.";
    (!rows.is_empty()).then(|| table(caption, &head, rows))
}

fn family(parameters: &[Parameter]) -> DataTable {
    let row = |one: &Parameter| {
        let [from, to] = one.ends.map(|end| number(to_six_decimals(end)));
        let unit = if one.relative { "times as large" } else { "as the scenario has it" };
        let places = Datum::Code(one.paths.join(" "));
        vec![Datum::Text(one.name.clone()), places, from, to, Datum::Text(unit.to_owned())]
    };
    let rows = parameters.iter().map(row).collect();
    let head = ["number", "keys of the scenario", "from", "to", "unit"];
    table("The box of the family, of which it is asked.", &head, rows)
}

/// How the numbers of a proved family may move.
fn moving(family: &Family) -> DataTable {
    let (time, unit) = match family.pace.as_ref().map(|it| it.crosses_in_s) {
        Some(time_s) if time_s > 0.0 => (number(time_s.to_string()), "s"),
        Some(_) => (Datum::Absent("any".to_owned()), ""),
        None => (Datum::Absent("none is proved".to_owned()), ""),
    };
    let scales = if family.scales_may_change() { "yes" } else { "no" };
    let rows = vec![
        row("time in which a number may go through its range, at least", time, unit),
        row(
            "scales of sensors may change from sample to sample",
            Datum::Text(scales.to_owned()),
            "",
        ),
    ];
    table("How the numbers of the family may move in flight.", &["what", "value", "unit"], rows)
}

fn gains(bounds: [[f64; 2]; 3], is_reached: bool) -> DataTable {
    let names = [("kp", ""), ("ki", "1/s"), ("kd", "s")];
    let rows = names.into_iter().zip(bounds).map(|((name, unit), ends)| {
        let [from, to] = ends.map(|end| number(significant(end, 6)));
        vec![Datum::Text(name.to_owned()), from, to, Datum::Text(unit.to_owned())]
    });
    let caption = match is_reached {
        true => format!("Gains that the controller can have, enclosed ({GAINS_REACHED})."),
        false => "Gains that the controller can have, enclosed.".to_owned(),
    };
    table(&caption, &["gain", "from", "to", "unit"], rows.collect())
}
