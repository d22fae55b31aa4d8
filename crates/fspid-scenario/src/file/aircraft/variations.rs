//! What a file says that is added to derivatives in flight.

use fspid_aircraft::aerodynamics::derivatives::{Lateral, LateralCoefficient, Longitudinal};
use fspid_aircraft::aerodynamics::increment::{Configuration, Increment};
use fspid_aircraft::aerodynamics::mach_table::{MachRow, MachTable};
use fspid_aircraft::data::{GroundData, Variations};

use super::{lateral_row, longitudinal_row, quantity};
use crate::file::spec::configuration as keys;
use crate::keyed::{Key, Section};
use fspid_diagnostics::Report;

/// Everything that a checked aircraft file has of it; `None` for a problem.
pub(super) fn variations(report: &mut Report, section: &Section) -> Option<Variations> {
    let before = report.count();
    let configurations = configurations(report, section.sections(keys::FILE_CONFIGURATION), &[]);
    let mach = mach_table(report, section);
    let ground = section.get(keys::FILE_GROUND_EFFECT).map(ground_data);
    (report.count() == before).then_some(Variations { configurations, mach, ground })
}

/// The configurations of some tables; those of a name that is taken are problems.
pub(in crate::file) fn configurations(
    report: &mut Report,
    parts: &[Section],
    taken: &[Configuration],
) -> Vec<Configuration> {
    let mut all: Vec<Configuration> = Vec::new();
    for part in parts.iter().filter(|part| part.sound) {
        let name = part.own_name();
        if taken.iter().chain(&all).any(|other| other.name == name) {
            part.wrong(report, keys::NAME, "the name is taken", "a name of its own");
            continue;
        }
        all.extend(configuration(report, part));
    }
    all
}

fn configuration(report: &mut Report, part: &Section) -> Option<Configuration> {
    let mut limits = keys::MOST_AIRSPEED.into_iter().filter(|key| part.given(*key));
    if let (Some(first), Some(second)) = (limits.next(), limits.next()) {
        let message = format!("not together with `{}`", first.name);
        part.wrong(report, second, message, "one of them");
        return None;
    }
    let text = |key| part.get::<str>(key).map(str::to_owned);
    Some(Configuration {
        name: part.get(keys::NAME)?.to_owned(),
        increment: increment(part),
        most_airspeed_m_s: quantity(part, keys::MOST_AIRSPEED).unwrap_or(f64::INFINITY),
        source: text(keys::SOURCE).or_else(|| text(keys::ASSUMPTION))?,
    })
}

/// The increments of a table; what is left out adds nothing.
fn increment(part: &Section) -> Increment {
    let row = |key| part.get(key).map(longitudinal_row).unwrap_or_default();
    let aside = |key: Key<Section>| -> LateralCoefficient {
        part.get(key).map(lateral_row).unwrap_or_default()
    };
    Increment {
        longitudinal: Longitudinal {
            lift: row(keys::LIFT),
            drag: row(keys::DRAG),
            pitch: row(keys::PITCH),
            thrust_speed: 0.0,
        },
        lateral: Lateral {
            side: aside(keys::SIDE),
            roll: aside(keys::ROLL),
            yaw: aside(keys::YAW),
        },
    }
}

fn mach_table(report: &mut Report, section: &Section) -> Option<MachTable> {
    let parts = section.sections(keys::MACH_ROWS);
    if parts.is_empty() {
        return None;
    }
    let row = |part: &Section| {
        Some(MachRow { mach: part.get(keys::ROW_MACH)?, increment: increment(part) })
    };
    let rows: Vec<MachRow> = parts.iter().map(row).collect::<Option<_>>()?;
    for ((part, row), before) in parts.iter().zip(&rows).skip(1).zip(&rows) {
        if row.mach <= before.mach {
            let allowed = format!("above {:?}, that of the row before", before.mach);
            part.wrong(report, keys::ROW_MACH, "rows must rise", allowed);
        }
    }
    // What it could refuse has been told.
    MachTable::new(rows).ok()
}

/// What the ground does.
pub(in crate::file) fn ground_data(part: &Section) -> GroundData {
    GroundData {
        wing_height_m: quantity(part, keys::WING_HEIGHT).unwrap_or_default(),
        induced_drag_factor: part.get(keys::INDUCED_DRAG_FACTOR),
    }
}
