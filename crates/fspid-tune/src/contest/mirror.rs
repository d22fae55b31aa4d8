//! Whether a case that is called the mirror image of another is one.

use std::collections::{BTreeMap, BTreeSet};

use fspid_scenario::file::{Setting, Template};
use fspid_scenario::tuning::Contest as Rules;

/// Tables of what commands and disturbs a flight.
const DRIVES: [&str; 3] = ["setpoint", "disturbance", "gust"];
/// Their numbers that have the other sign in the mirror.
const SIGNED: [&str; 4] = ["amplitude_deg", "value_deg", "forward_m_s", "up_m_s"];

/// What two flights that are told as mirror images do not mirror: how alike both are flown is an answer about a
/// controller only where the flights are.
///
/// `templates` are the scenarios of the cases, in their order.
pub(super) fn problems(rules: &Rules, templates: &[Template]) -> Vec<String> {
    let place = |name: &String| rules.cases.iter().position(|it| it.name == *name);
    let pairs = rules.cases.iter().enumerate().filter_map(|(here, case)| {
        let there = place(case.mirror_of.as_ref()?)?;
        Some((case, &rules.cases[there], templates.get(here)?, templates.get(there)?))
    });
    let told = pairs.filter_map(|(case, mirrored, here, there)| {
        let unlike = unlike(&here.study().settings, &there.study().settings);
        let first = unlike.first()?;
        let others = match unlike.len() {
            1 => String::new(),
            all => format!("; {} more", all - 1),
        };
        Some(format!(
            "case \"{}\" is no mirror image of \"{}\": {first}{others}; leave out mirror_of, or turn the signs of what commands and disturbs alone",
            case.name, mirrored.name
        ))
    });
    told.collect()
}

fn unlike(here: &[Setting], there: &[Setting]) -> Vec<String> {
    let by_path = |all: &[Setting]| -> BTreeMap<String, String> {
        all.iter().map(|it| (it.path.clone(), it.value.clone())).collect()
    };
    let (here, there) = (by_path(here), by_path(there));
    let paths: BTreeSet<&String> = here.keys().chain(there.keys()).collect();
    let told = paths.into_iter().filter_map(|path| match (here.get(path), there.get(path)) {
        (Some(mine), Some(theirs)) if is_signed(path) => {
            let wanted = negated(theirs);
            (*mine != wanted).then(|| format!("`{path}` is {mine}, its mirror image is {wanted}"))
        }
        (Some(mine), Some(theirs)) => {
            (mine != theirs).then(|| format!("`{path}` is {mine} here and {theirs} there"))
        }
        (Some(mine), None) => Some(format!("`{path}` is {mine} here and not set there")),
        (None, theirs) => {
            let theirs = theirs.map_or("", String::as_str);
            Some(format!("`{path}` is {theirs} there and not set here"))
        }
    });
    told.collect()
}

fn is_signed(path: &str) -> bool {
    let table = path.split(['.', '[']).next().unwrap_or_default();
    let key = path.rsplit('.').next().unwrap_or_default();
    DRIVES.contains(&table) && SIGNED.contains(&key)
}

/// The value with every number's sign turned, as the settings write numbers.
fn negated(value: &str) -> String {
    let numbers = value.split_inclusive([',', ' ', '[', ']']).map(|part| {
        let number = part.trim_end_matches([',', ' ', '[', ']']);
        let rest = &part[number.len()..];
        let is_number = number.parse::<f64>().is_ok();
        let is_none = number.parse::<f64>().is_ok_and(|it| !(it < 0.0) && !(it > 0.0));
        match number.strip_prefix('-') {
            Some(positive) if is_number && !is_none => format!("{positive}{rest}"),
            None if is_number && !is_none => format!("-{part}"),
            _ => part.to_owned(),
        }
    });
    numbers.collect()
}
