//! How the aircraft of a scenario is loaded.

use fspid_aircraft::AircraftError;
use fspid_aircraft::data::{AircraftData, Loading, Moment};

use crate::file::aircraft::quantity;
use crate::file::section::Section;
use fspid_diagnostics::Report;

/// Ends of the keys of a moment of inertia, of which one may be given.
const MOMENT_ENDS: [&str; 3] = ["kg_m2", "slug_ft2", "gyration_m"];

/// The aircraft with the loading that the scenario asks for.
pub(super) fn loaded(
    report: &mut Report,
    (part, key): (&Section, &str),
    data: AircraftData,
) -> Option<AircraftData> {
    let before = report.count();
    for axis in ["ix", "iy", "iz", "ixz"] {
        at_most_one(report, part, axis);
    }
    if report.count() > before {
        return None;
    }
    let loading = loading(part);
    let loading = merged(&data, loading);
    match data.loaded(loading) {
        Ok(data) => Some(data),
        Err(error) => {
            let (at, allowed) = fault(part, key, &error);
            report.value(part.at(at), &part.path(at), error.to_string(), allowed);
            None
        }
    }
}

fn loading(part: &Section) -> Loading {
    let moment = |axis: &str| {
        let radius = part.number(&format!("{axis}_gyration_m")).map(Moment::Gyration);
        radius.or_else(|| quantity(part, axis).map(Moment::Inertia))
    };
    Loading {
        mass_kg: part.number("mass_kg"),
        cg_mac: part.number("cg_mac"),
        roll: moment("ix"),
        pitch: moment("iy"),
        yaw: moment("iz"),
        ixz_kg_m2: quantity(part, "ixz"),
    }
}

/// The scenario's loading; a mass that a change of the aircraft's own weight made stays where the scenario says none.
fn merged(data: &AircraftData, loading: Loading) -> Loading {
    let changed = data.derivatives().ok().and_then(|data| data.loading.mass_kg);
    Loading { mass_kg: loading.mass_kg.or(changed), ..loading }
}

fn at_most_one(report: &mut Report, part: &Section, axis: &str) {
    let names = MOMENT_ENDS.map(|end| format!("{axis}_{end}"));
    let mut given = names.iter().filter(|name| part.given(name));
    if let (Some(first), Some(second)) = (given.next(), given.next()) {
        let message = format!("not together with `{first}`");
        report.value(part.at(second), &part.path(second), message, "one of them");
    }
}

/// The key that an error is about, and what is allowed there.
fn fault<'a>(part: &Section, key: &'a str, error: &AircraftError) -> (&'a str, &'static str) {
    let first = |names: &[&'static str]| names.iter().copied().find(|name| part.given(name));
    match error {
        AircraftError::NoReferenceCg => ("cg_mac", "nothing; leave it out"),
        AircraftError::FixedLoading { .. } => {
            (first(&KEYS).unwrap_or(key), "nothing; leave mass, cg_mac and inertia out")
        }
        _ => (first(&KEYS).unwrap_or(key), "a mass and moments of inertia that a body can have"),
    }
}

/// Every key of a loading.
pub(super) const KEYS: [&str; 13] = [
    "mass_kg",
    "cg_mac",
    "ix_kg_m2",
    "ix_slug_ft2",
    "ix_gyration_m",
    "iy_kg_m2",
    "iy_slug_ft2",
    "iy_gyration_m",
    "iz_kg_m2",
    "iz_slug_ft2",
    "iz_gyration_m",
    "ixz_kg_m2",
    "ixz_slug_ft2",
];
