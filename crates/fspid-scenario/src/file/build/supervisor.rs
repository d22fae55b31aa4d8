//! The supervisor: rules that conclude labels, or numbers, or a network in their place.

use fspid_fuzzy::{Defuzzifier, FuzzyError, LABEL_COUNT, Network, NumberTable, Supervisor, UNITS};

use super::{data, judged};
use crate::file::files::Files;
use crate::file::spec::controller as keys;
use crate::file::spec::data::{NETWORK_ROWS, NUMBER_DELTA_KD, NUMBER_DELTA_KI, NUMBER_DELTA_KP};
use crate::keyed::Section;
use crate::system_text::{Format, LoadError, Options, numbers_of, read};
use fspid_diagnostics::Report;

/// How far the range of a system may be from that of the supervisor, as a part of it: a range that was
/// printed with ten digits and read again.
const SAME_RANGE: f64 = 1e-9;

/// The supervisor of a sound section.
pub(super) fn supervisor(
    report: &mut Report,
    files: &mut Files<'_>,
    part: &Section,
) -> Option<Supervisor<f64>> {
    let policy = part.get(keys::OUT_OF_RANGE)?;
    let range = part.get(keys::RANGE)?;
    if !part.given(keys::TABLE) {
        let before = report.count();
        refuse_defuzzifier(report, part);
        if let Some(network) = part.get(keys::NETWORK) {
            refuse_sets(report, part);
            let supervisor = Supervisor::of_network(&of_rows(network)?, range, policy);
            let supervisor = judged(report, (part, keys::RANGE), supervisor);
            return supervisor.filter(|_| report.count() == before);
        }
        let table = numbers(report, files, part, range)?;
        let supervisor = Supervisor::of_numbers(&table, range, policy);
        let supervisor = judged(report, (part, keys::RANGE), supervisor);
        return supervisor.filter(|_| report.count() == before);
    }
    if !part.given(keys::DEFUZZIFIER) {
        files.fill(part.path(keys::DEFUZZIFIER), "exact");
    }
    let defuzzifier = part.get(keys::DEFUZZIFIER).unwrap_or(Defuzzifier::Exact);
    let table = data::rules(report, files, part)?;
    let supervisor = Supervisor::new(&table, range, defuzzifier, policy);
    let key = match supervisor {
        Err(FuzzyError::SampleCount { .. }) => keys::DEFUZZIFIER.name,
        _ => keys::RANGE.name,
    };
    judged(report, (part, key), supervisor)
}

/// A network has no sets whose centres could lie anywhere.
fn refuse_sets(report: &mut Report, part: &Section) {
    for key in [keys::ERROR_SET_CENTRES, keys::CHANGE_SET_CENTRES] {
        if part.given(key) {
            let path = part.path(key);
            report.value(part.at(key), &path, "a network has no sets", "only with rules");
        }
    }
}

/// The network of a sound section.
fn of_rows(section: &Section) -> Option<Network<f64>> {
    let mut rows = [[0.0; UNITS]; 6];
    for (key, row) in NETWORK_ROWS.into_iter().zip(&mut rows) {
        for (weight, (number, _)) in row.iter_mut().zip(section.get(key)?) {
            *weight = *number;
        }
    }
    Network::new(rows).ok()
}

/// Numbers are weighted; nothing is left to choose.
fn refuse_defuzzifier(report: &mut Report, part: &Section) {
    if part.given(keys::DEFUZZIFIER) {
        let message = match part.given(keys::NETWORK) {
            true => "a network is not defuzzified",
            false => "rules that conclude numbers are not defuzzified",
        };
        let path = part.path(keys::DEFUZZIFIER);
        report.value(part.at(keys::DEFUZZIFIER), &path, message, "only with `table`");
    }
}

/// The numbers of `numbers` or of the file that `system` names.
fn numbers(
    report: &mut Report,
    files: &mut Files<'_>,
    part: &Section,
    range: f64,
) -> Option<NumberTable<f64>> {
    match part.get(keys::NUMBERS) {
        Some(grids) => of_grids(report, grids, range),
        None => of_system(report, files, part, range),
    }
}

fn of_grids(report: &mut Report, section: &Section, range: f64) -> Option<NumberTable<f64>> {
    let mut grids = [[[0.0; LABEL_COUNT]; LABEL_COUNT]; 3];
    let mut is_sound = true;
    let keys = [NUMBER_DELTA_KP, NUMBER_DELTA_KI, NUMBER_DELTA_KD];
    for (key, grid) in keys.into_iter().zip(&mut grids) {
        let cells = section.get(key)?;
        for (index, (cell, (number, place))) in
            grid.as_flattened_mut().iter_mut().zip(cells).enumerate()
        {
            *cell = *number;
            if !(number.abs() <= range) {
                let (row, column) = (index / LABEL_COUNT, index % LABEL_COUNT);
                let path = format!("{}[{row}][{column}]", section.path(key));
                report.value(*place, &path, "beyond the supervisor's range", within(range));
                is_sound = false;
            }
        }
    }
    NumberTable::new(grids).ok().filter(|_| is_sound)
}

fn within(range: f64) -> String {
    format!("-{range:?} to {range:?}; `output_scale` makes increments larger")
}

/// The numbers of a fuzzy system in a file.
fn of_system(
    report: &mut Report,
    files: &mut Files<'_>,
    part: &Section,
    range: f64,
) -> Option<NumberTable<f64>> {
    const ALLOWED: &str = "a readable .toml, .fis, .t2fis, .fcl, .fll or .xml file, its path relative to the scenario's folder";
    let name = part.get(keys::SYSTEM)?;
    let text = match (Format::of(name.as_ref()), files.read(name)) {
        (None, _) => {
            part.wrong(report, keys::SYSTEM, "no file of a known format", ALLOWED);
            return None;
        }
        (_, Err(reason)) => {
            part.wrong(report, keys::SYSTEM, format!("cannot be read: {reason}"), ALLOWED);
            return None;
        }
        (Some(_), Ok(text)) => text,
    };
    files.digest(&text);
    let loaded = match read(name, &text, Format::of(name.as_ref())?, Options::default()) {
        Ok(loaded) => loaded,
        Err(LoadError::Problems(problems)) => {
            for found in &problems.list {
                let (line, column) = found.line_and_column();
                let message = format!("{name}:{line}:{column}: {}", found.message);
                part.problem(report, keys::SYSTEM, message, found.allowed.clone());
            }
            return None;
        }
        Err(error) => {
            part.problem(report, keys::SYSTEM, error.to_string(), "a fuzzy system");
            return None;
        }
    };
    let (told, allowed) = match numbers_of(loaded.system.parts()) {
        Ok(found) if !((found.range - range).abs() <= SAME_RANGE * range) => {
            let told = format!("its sets reach to {:?}, and the range is {range:?}", found.range);
            (vec![told], format!("`range = {:?}`", found.range))
        }
        Ok(found) => match found.beyond(range) {
            told if told.is_empty() => return NumberTable::new(found.grids_within(range)).ok(),
            told => (told, within(range)),
        },
        Err(differences) => (differences, ALLOWED_SYSTEM.to_owned()),
    };
    // What is allowed is said once, behind the last of them.
    let last = told.len().saturating_sub(1);
    for (index, difference) in told.into_iter().enumerate() {
        let allowed = if index == last { allowed.as_str() } else { "" };
        part.wrong(report, keys::SYSTEM, difference, allowed);
    }
    None
}

/// What a system must be to fly.
const ALLOWED_SYSTEM: &str = "inputs error and change with seven triangles each, from neighbour to neighbour and evenly over \
     -range to range, outputs delta_kp, delta_ki and delta_kd, and 49 rules with numbers of their own, \
     joined by products and a weighted average";
