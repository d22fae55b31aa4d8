//! How the aircraft of a question is loaded.

use fspid_aircraft::MassProperties;
use fspid_aircraft::data::{AircraftData, Loading, ModelData, Moment};

use super::facts::Facts;
use super::parse::quantity;
use fspid_scenario::aircraft::AircraftFailure;
use fspid_scenario::aircraft::units::{INERTIAS, Kind, MASSES, Units};
use fspid_scenario::supervisor::Refused;

/// A loading as it is written; what is left out is that of the aircraft's data.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LoadingQuestion<'a> {
    /// Mass.
    pub mass: Option<&'a str>,
    /// Centre of gravity as a share of the mean chord.
    pub cg: Option<&'a str>,
    /// Moment of inertia about the forward axis.
    pub ix: Option<&'a str>,
    /// Moment of inertia about the right axis.
    pub iy: Option<&'a str>,
    /// Moment of inertia about the downward axis.
    pub iz: Option<&'a str>,
}

impl LoadingQuestion<'_> {
    /// The loading, every mistake in it at once.
    pub(super) fn read(&self, units: Units) -> Result<Loading, Refused> {
        let mut problems = Vec::new();
        let mut read = |option, text: Option<&str>, known: &[_], kind| {
            let value = quantity(option, text?, known, units.of(kind));
            let value = value.map_err(|problem| problems.push(problem)).ok()?;
            if kind == Kind::Plain && !(-1.0..=2.0).contains(&value) {
                problems.push(format!(
                    "{option} {value}: a share of the chord, between -1 and 2, such as 0.25"
                ));
            } else if kind != Kind::Plain && !(value > 0.0) {
                problems.push(format!("{option} must be above 0"));
            }
            Some(value)
        };
        let loading = Loading {
            mass_kg: read("--mass", self.mass, &MASSES, Kind::Mass),
            cg_mac: read("--cg", self.cg, &[], Kind::Plain),
            roll: read("--ix", self.ix, &INERTIAS, Kind::Inertia).map(Moment::Inertia),
            pitch: read("--iy", self.iy, &INERTIAS, Kind::Inertia).map(Moment::Inertia),
            yaw: read("--iz", self.iz, &INERTIAS, Kind::Inertia).map(Moment::Inertia),
            ..Loading::default()
        };
        if problems.is_empty() { Ok(loading) } else { Err(Refused::all(problems)) }
    }
}

/// The aircraft as loaded; that of tables came with its centre of gravity.
pub(super) fn loaded(
    data: AircraftData,
    loading: Loading,
) -> Result<AircraftData, AircraftFailure> {
    Ok(data.loaded(loading)?)
}

/// What is loaded otherwise than in the data; nothing where nothing is.
pub(super) fn facts(facts: Facts, loading: &Loading, data: &AircraftData) -> Facts {
    let mass = match &data.model {
        ModelData::Derivatives(data) => Some(data.mass_properties()),
        ModelData::Forces(data) => Some(data.mass),
        ModelData::Linear(_) => None,
    };
    let moment = |given: Option<Moment>, of: fn(&MassProperties) -> f64| {
        given.and_then(|_| mass.as_ref().map(of))
    };
    let rows = [
        ("mass, as loaded", "mass", Kind::Mass, loading.mass_kg),
        ("centre of gravity, share of the chord", "cg_mac", Kind::Plain, loading.cg_mac),
        ("Ix, as loaded", "ix", Kind::Inertia, moment(loading.roll, |mass| mass.ix_kg_m2)),
        ("Iy, as loaded", "iy", Kind::Inertia, moment(loading.pitch, |mass| mass.iy_kg_m2)),
        ("Iz, as loaded", "iz", Kind::Inertia, moment(loading.yaw, |mass| mass.iz_kg_m2)),
    ];
    rows.into_iter().fold(facts, |facts, (name, key, kind, value)| match value {
        Some(value) => facts.number(name, key, kind, value),
        None => facts,
    })
}
