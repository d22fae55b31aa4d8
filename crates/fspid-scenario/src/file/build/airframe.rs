//! What is known of the flight of each plant: flying qualities depend on it.

use fspid_aircraft::atmosphere::STANDARD_GRAVITY_M_S2;
use fspid_sim::Scenario;

use super::flown::Flown;
use crate::file::files::Files;
use crate::file::spec::data::{CONDITION, SPEED_M_S};
use crate::file::spec::scenario as keys;
use crate::keyed::Section;

/// Airspeed and gravity of a plant.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Airframe {
    /// True airspeed, m/s, if anybody said it.
    pub airspeed_m_s: Option<f64>,
    /// Gravity, m/s².
    pub gravity_m_s2: f64,
}

impl Airframe {
    /// Nobody said how fast the plants of this scenario fly.
    pub(in crate::file) fn unknown(scenario: &Scenario) -> Vec<Self> {
        let unknown = Self { airspeed_m_s: None, gravity_m_s2: STANDARD_GRAVITY_M_S2 };
        vec![unknown; 1 + scenario.plant_changes.len()]
    }
}

/// One for the plant at the start and one for each change, in the file's order.
pub(super) fn airframes(
    files: &Files<'_>,
    section: &Section,
    flown: Option<&Flown>,
) -> Vec<Airframe> {
    let of_file = |part: &Section| Airframe {
        airspeed_m_s: speed_of_file(files, part),
        gravity_m_s2: STANDARD_GRAVITY_M_S2,
    };
    let first = match flown.and_then(|flown| flown.way) {
        Some(way) => Some(Airframe {
            airspeed_m_s: (!way.assumed).then_some(way.course.airspeed_m_s),
            gravity_m_s2: way.gravity_m_s2,
        }),
        None => match section.get(keys::PLANT) {
            Some(part) => Some(of_file(part)),
            // How fast another simulator flies is its own to say.
            None => section
                .get(keys::SIMULATOR)
                .map(|_| Airframe { airspeed_m_s: None, gravity_m_s2: STANDARD_GRAVITY_M_S2 }),
        },
    };
    first.into_iter().chain(section.sections(keys::PLANT_CHANGE).iter().map(of_file)).collect()
}

/// The speed in the condition of the plant file that a table names.
fn speed_of_file(files: &Files<'_>, part: &Section) -> Option<f64> {
    let named = [keys::PRESET, keys::FILE].into_iter().find(|key| part.given(*key))?;
    let (_, file) = files.referred(&part.path(named))?;
    file.get(CONDITION)?.get(SPEED_M_S)
}
