//! Aircraft whose forces and body are tables in files of their own.

use std::path::Path;
use std::sync::Arc;

use fspid_aircraft::data::ForceData;
use fspid_aircraft::{Air, Gearing, Vector3};
use fspid_daveml::flight::{Body, FlightError, Setting, TableForces};
use fspid_daveml::{Model, Problem, Reading};

use crate::file::aircraft::{quantity, surfaces};
use crate::file::files::Files;
use crate::file::spec::tables as keys;
use crate::keyed::{Key, Section};
use crate::regular_file::STANDARD_INPUT;
use fspid_diagnostics::{Report, Span};

/// What each file of tables may be.
const ALLOWED: &str =
    "a DAVE-ML file, or one that `fspid aircraft import` wrote, its path relative to this file";

/// Reads a model as the ending of its file says.
pub fn read_model(path: &Path, text: &str) -> Result<Reading, fspid_daveml::Problems> {
    let is_toml = path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml"));
    // Standard input has no ending; XML begins with a sign that no TOML begins with.
    let is_toml =
        is_toml || (path == Path::new(STANDARD_INPUT) && !text.trim_start().starts_with('<'));
    if is_toml { fspid_daveml::data::read(text) } else { fspid_daveml::read(text) }
}

/// The forces and the body of an aircraft file, whose tables are relative to `place` in the folder of `files`.
pub(super) fn tables(
    report: &mut Report,
    files: &mut Files<'_>,
    (section, place): (&Section, &Path),
    cg_mac: Option<f64>,
) -> Option<ForceData> {
    let part = section.get(keys::TABLES)?;
    engine_fits(report, section, part)?;
    let [aerodynamics, inertia] =
        [keys::AERODYNAMICS, keys::INERTIA].map(|key| model(report, files, (part, key), place));
    let propulsion = match part.given(keys::PROPULSION) {
        true => Some(model(report, files, (part, keys::PROPULSION), place)),
        false => None,
    };
    let body = inertia.and_then(|inertia| body(report, section, (&inertia, cg_mac)));
    // Without a body the forces are looked at all the same, so that all problems are told at once.
    let centre_of_mass_m = body.map_or(Vector3::ZERO, |body| body.centre_of_mass_m);
    let forces = forces(
        report,
        section,
        (aerodynamics?, propulsion.map_or(Some(None), |it| it.map(Some))?),
        centre_of_mass_m,
    )?;
    let held = held(report, part, &forces);
    Some(ForceData {
        mass: body?.mass,
        geometry: forces.geometry(),
        gravity_m_s2: quantity(section.get(keys::BODY)?, keys::GRAVITY)?,
        air: section.get(keys::AIR).and_then(air),
        table_inputs: forces.table_inputs(),
        held,
        forces: Arc::new(forces),
    })
}

/// What a flight leaves as a file has it, as warnings too: a misspelled input flies, and flies another aircraft.
fn held(report: &mut Report, part: &Section, forces: &TableForces) -> Vec<String> {
    let of = [
        (keys::AERODYNAMICS, forces.held_inputs()),
        (keys::PROPULSION, forces.held_inputs_of_the_engine()),
    ];
    let told = of.into_iter().flat_map(|(key, sentences)| {
        let path = part.path(key);
        sentences.into_iter().map(move |sentence| format!("{path}: {sentence}"))
    });
    let told: Vec<String> = told.collect();
    told.iter().for_each(|sentence| report.warn(sentence.clone()));
    told
}

fn air(section: &Section) -> Option<Air> {
    Some(Air::with_density(
        quantity(section, keys::DENSITY)?,
        quantity(section, keys::SPEED_OF_SOUND)?,
    ))
}

/// The model in the file that a key names, if its check cases pass.
pub(super) fn model(
    report: &mut Report,
    files: &mut Files<'_>,
    (part, key): (&Section, Key<str>),
    place: &Path,
) -> Option<Model> {
    let path = place.join(part.get(key)?);
    let name = path.display().to_string();
    let text = files.read(&name).map_err(|reason| {
        part.wrong(report, key, format!("cannot be read: {reason}"), ALLOWED);
    });
    let text = text.ok()?;
    files.digest(&text);
    match read_model(&path, &text) {
        Ok(reading) => checked(report, (part, key), reading.model),
        Err(problems) => {
            let source = report.add_source(Some(name), &text);
            problems.list.iter().for_each(|problem| located(report, (source, &text), problem));
            None
        }
    }
}

/// The model if it gives what its own check cases say.
fn checked(report: &mut Report, (part, key): (&Section, Key<str>), model: Model) -> Option<Model> {
    let checks = model.check();
    let failed = checks.shots.iter().find(|shot| !shot.passed());
    let Some(shot) = failed else { return Some(model) };
    let message = format!("its check case `{}` fails", shot.name);
    part.wrong(report, key, message, "a file whose check cases pass");
    None
}

/// A problem of a model at its place in the text of its file.
fn located(report: &mut Report, (source, text): (usize, &str), problem: &Problem) {
    let at = problem.place.map_or(0, |place| place.byte_in(text));
    let message = match problem.found.as_str() {
        "" => problem.message.clone(),
        word => format!("`{word}`: {}", problem.message),
    };
    let place = Span { source, start: at, end: at };
    report.missing(place, "", message, problem.allowed.clone());
}

fn body(
    report: &mut Report,
    section: &Section,
    (inertia, cg_mac): (&Model, Option<f64>),
) -> Option<Body> {
    let loaded_pct = cg_mac.map(|share| 100.0 * share);
    let place_pct = loaded_pct.or(section.get(keys::BODY)?.get(keys::CENTRE_OF_MASS_PCT));
    let engine_kg_m2_s = match section.get(keys::ENGINE) {
        Some(engine) => quantity(engine, keys::ANGULAR_MOMENTUM)?,
        None => 0.0,
    };
    fitting(report, (section, keys::INERTIA), Body::placed(inertia, place_pct, engine_kg_m2_s))
}

/// Aerodynamics alone first, so that a problem is told of the file that has it.
fn forces(
    report: &mut Report,
    section: &Section,
    (aerodynamics, propulsion): (Model, Option<Model>),
    centre_of_mass_m: Vector3,
) -> Option<TableForces> {
    let setting = Setting {
        centre_of_mass_m,
        gearing: section.get(keys::ENGINE).map_or(Some(Gearing::default()), gearing)?,
        travel: surfaces(section.get(keys::TRAVEL)?)?,
    };
    let alone = TableForces::new(aerodynamics, None, setting);
    let alone = fitting(report, (section, keys::AERODYNAMICS), alone)?;
    match propulsion {
        Some(engine) => fitting(report, (section, keys::PROPULSION), alone.with_engine(engine)),
        None => Some(alone),
    }
}

/// Propulsion and what its tables do not say come together, or neither does.
fn engine_fits(report: &mut Report, section: &Section, part: &Section) -> Option<()> {
    match (part.given(keys::PROPULSION), section.get(keys::ENGINE)) {
        (true, None) => {
            let message = "the propulsion needs an [engine], which says what its tables do not";
            part.wrong(report, keys::PROPULSION, message, "[engine]");
            None
        }
        (false, Some(engine)) => {
            let message = "there is no propulsion, so that nothing is left to say of an engine";
            report.value(engine.place, &engine.path, message, "nothing; leave it out");
            None
        }
        _ => Some(()),
    }
}

fn gearing(engine: &Section) -> Option<Gearing> {
    engine.get(keys::GEARING)
}

/// A part of the aircraft, or a problem at the file that does not make it.
fn fitting<T>(
    report: &mut Report,
    (section, key): (&Section, Key<str>),
    part: Result<T, FlightError>,
) -> Option<T> {
    let tables = section.get(keys::TABLES)?;
    let told = |error: FlightError| {
        let allowed = "tables with the names and units of AIAA S-119";
        tables.wrong(report, key, error.to_string(), allowed);
    };
    part.map_err(told).ok()
}

#[cfg(test)]
mod tests;
