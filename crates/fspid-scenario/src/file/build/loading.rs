//! How the aircraft of a scenario is loaded.

use fspid_aircraft::AircraftError;
use fspid_aircraft::data::{AircraftData, Loading, Moment};

use crate::file::aircraft::quantity;
use crate::file::spec::flight as keys;
use crate::keyed::{Key, KeyName, Section};
use fspid_diagnostics::Report;

/// A moment of inertia, or the radius of gyration in its place: one of them may be given.
struct MomentKeys {
    inertia: [Key<f64>; 2],
    gyration: Option<Key<f64>>,
}

const MOMENTS: [MomentKeys; 4] =
    [ROLL, PITCH, YAW, MomentKeys { inertia: keys::IXZ, gyration: None }];
const ROLL: MomentKeys = MomentKeys { inertia: keys::IX, gyration: Some(keys::IX_GYRATION_M) };
const PITCH: MomentKeys = MomentKeys { inertia: keys::IY, gyration: Some(keys::IY_GYRATION_M) };
const YAW: MomentKeys = MomentKeys { inertia: keys::IZ, gyration: Some(keys::IZ_GYRATION_M) };

/// The aircraft with the loading that the scenario asks for.
pub(super) fn loaded(
    report: &mut Report,
    (part, key): (&Section, Key<str>),
    data: AircraftData,
) -> Option<AircraftData> {
    let before = report.count();
    MOMENTS.iter().for_each(|moment| at_most_one(report, part, moment));
    if report.count() > before {
        return None;
    }
    let loading = loading(part);
    let loading = merged(&data, loading);
    match data.loaded(loading) {
        Ok(data) => Some(data),
        Err(error) => {
            let (at, allowed) = fault(part, key, &error);
            part.wrong(report, at, error.to_string(), allowed);
            None
        }
    }
}

fn loading(part: &Section) -> Loading {
    let moment = |MomentKeys { inertia, gyration }: MomentKeys| {
        let radius = gyration.and_then(|key| part.get(key)).map(Moment::Gyration);
        radius.or_else(|| quantity(part, inertia).map(Moment::Inertia))
    };
    Loading {
        mass_kg: part.get(keys::MASS_KG),
        cg_mac: part.get(keys::CG_MAC),
        roll: moment(ROLL),
        pitch: moment(PITCH),
        yaw: moment(YAW),
        ixz_kg_m2: quantity(part, keys::IXZ),
    }
}

/// The scenario's loading; a mass that a change of the aircraft's own weight made stays where the scenario says none.
fn merged(data: &AircraftData, loading: Loading) -> Loading {
    let changed = data.derivatives().ok().and_then(|data| data.loading.mass_kg);
    Loading { mass_kg: loading.mass_kg.or(changed), ..loading }
}

fn at_most_one(report: &mut Report, part: &Section, moment: &MomentKeys) {
    let all = moment.inertia.into_iter().chain(moment.gyration);
    let mut given = all.filter(|key| part.given(*key));
    if let (Some(first), Some(second)) = (given.next(), given.next()) {
        let message = format!("not together with `{}`", first.name);
        part.wrong(report, second, message, "one of them");
    }
}

/// The key that an error is about, and what is allowed there.
fn fault(part: &Section, key: Key<str>, error: &AircraftError) -> (KeyName, &'static str) {
    let mut names = keys::LOADING.iter().map(|key| key.name());
    let first = names.find(|name| part.given(*name)).unwrap_or(key.name);
    match error {
        AircraftError::NoReferenceCg => (keys::CG_MAC.name, "nothing; leave it out"),
        AircraftError::FixedLoading { .. } => {
            (first, "nothing; leave mass, cg_mac and inertia out")
        }
        _ => (first, "a mass and moments of inertia that a body can have"),
    }
}
