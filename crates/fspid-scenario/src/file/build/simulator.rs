//! An aircraft that another simulator flies.

use std::path::PathBuf;

use fspid_aircraft::airspeed::true_of_calibrated_m_s;
use fspid_aircraft::atmosphere::{Air, STANDARD_GRAVITY_M_S2};
use fspid_sim::external::Contents;
use fspid_sim::external_plant::{FmuPlant, Jsbsim, JsbsimSpeed};
use fspid_sim::{Course, ExternalPlant, Simulator};

use super::external::called;
use super::flown::{Flown, Way};
use super::rad;
use crate::file::aircraft::{quantity, unit_size};
use crate::file::files::Files;
use crate::file::spec::scenario::{GUST, TURBULENCE, WIND};
use crate::file::spec::simulator as keys;
use crate::file::spec::simulator::{GearWord, SimulatorKind, WingsWord};
use crate::keyed::Section;
use fspid_diagnostics::Report;

/// The aircraft of a sound table.
pub(super) fn flown(
    report: &mut Report,
    files: &mut Files<'_>,
    section: &Section,
    part: &Section,
) -> Option<Flown> {
    if part.variant() == Some(SimulatorKind::Fmu) {
        refuse_air(report, section);
    }
    let simulator = match part.variant()? {
        SimulatorKind::Jsbsim => Simulator::Jsbsim(jsbsim(report, files, part)?),
        SimulatorKind::Fmu => Simulator::Fmu(fmu(report, files, part)?),
    };
    let plant = ExternalPlant { simulator, answer_limit_s: part.get(keys::ANSWER_LIMIT_S)? };
    let way = way(&plant);
    Some(Flown { plant: plant.into(), way, derivatives: None })
}

fn jsbsim(report: &mut Report, files: &mut Files<'_>, part: &Section) -> Option<Jsbsim> {
    let aircraft = part.get(keys::AIRCRAFT)?;
    // Names of folders and files are made of it.
    if aircraft.is_empty() || aircraft.starts_with('.') || aircraft.contains(['/', '\\', '\0']) {
        let allowed = "the name of a folder under `aircraft`, such as \"c172x\"";
        part.wrong(report, keys::AIRCRAFT, "no name of an aircraft", allowed);
        return None;
    }
    let version = part.get(keys::VERSION).unwrap_or(keys::JSBSIM_VERSION);
    if part.get(keys::VERSION).is_none() {
        files.fill(part.path(keys::VERSION), keys::JSBSIM_VERSION);
    }
    files.digest(version);
    let property = |part: &Section| {
        let name = part.get(keys::NAME)?;
        Some((name.to_owned(), part.get(keys::VALUE)?))
    };
    for part in part.sections(keys::PROPERTY) {
        if part.get(keys::NAME).is_some_and(|name| name.contains(['\0', '='])) {
            part.wrong(
                report,
                keys::NAME,
                "no name of a property",
                "one such as \"atmosphere/turb-type\"",
            );
        }
    }
    Some(Jsbsim {
        aircraft: aircraft.to_owned(),
        folder: folder(report, files, part)?,
        version: version.to_owned(),
        speed: speed(part)?,
        altitude_m: quantity(part, keys::ALTITUDE)?,
        climb_rad: rad(part.get(keys::CLIMB_ANGLE_DEG)?),
        heading_rad: rad(part.get(keys::HEADING_DEG)?),
        gear_is_down: part.get(keys::GEAR)? == GearWord::Down,
        levels_wings: part.get(keys::WINGS)? == WingsWord::Levelled,
        seed: u32::try_from(part.get(keys::SEED)?).ok()?,
        properties: part.sections(keys::PROPERTY).iter().filter_map(property).collect(),
    })
}

fn fmu(report: &mut Report, files: &mut Files<'_>, part: &Section) -> Option<FmuPlant> {
    let (file, bytes) = match files.program(part.get(keys::FILE)?) {
        Ok(found) => found,
        Err(reason) => {
            let allowed = "an FMU, its path relative to the scenario's folder";
            part.wrong(report, keys::FILE, format!("cannot be read: {reason}"), allowed);
            return None;
        }
    };
    let inputs = part.get(keys::INPUTS).map(|inputs| (inputs, &[keys::FMU_INPUTS][..]));
    let outputs = part.get(keys::OUTPUTS).map(|outputs| (outputs, &keys::FMU_OUTPUTS[..]));
    let mut renamed = Vec::new();
    for (section, rows) in inputs.into_iter().chain(outputs) {
        for keys in rows {
            renamed.extend(called(report, section, keys)?);
        }
    }
    let trim_elevator_rad = rad(part.get(keys::TRIM_ELEVATOR_DEG)?);
    Some(FmuPlant { file, contents: Contents(bytes), renamed, trim_elevator_rad })
}

/// The folder of one's own, if there is one; the aircraft's files are part of the digest.
fn folder(report: &mut Report, files: &mut Files<'_>, part: &Section) -> Option<Option<PathBuf>> {
    let Some(folder) = part.get(keys::FOLDER) else { return Some(None) };
    let found = files.model_folder(folder, part.get(keys::AIRCRAFT)?);
    match found {
        Ok(path) => Some(Some(path)),
        Err(reason) => {
            let allowed = "a folder with `aircraft/NAME/NAME.xml` in it, its path relative to the scenario's folder";
            part.wrong(report, keys::FOLDER, reason, allowed);
            None
        }
    }
}

fn speed(part: &Section) -> Option<JsbsimSpeed> {
    if let Some(knots) = part.get(keys::CALIBRATED_KT) {
        return Some(JsbsimSpeed::Calibrated(knots * unit_size("kt")));
    }
    if let Some(mach) = part.get(keys::MACH) {
        return Some(JsbsimSpeed::Mach(mach));
    }
    quantity(part, keys::AIRSPEED).map(JsbsimSpeed::True)
}

/// Wing span of turbulence around another simulator, m: the rates of the air depend on it alone, which are left out there.
const ANY_SPAN_M: f64 = 10.0;

/// The way of a flight of JSBSim, in the standard atmosphere as there.
fn way(plant: &ExternalPlant) -> Option<Way> {
    let Simulator::Jsbsim(jsbsim) = &plant.simulator else { return None };
    let air = Air::standard(jsbsim.altitude_m).ok()?;
    let airspeed_m_s = match jsbsim.speed {
        JsbsimSpeed::True(airspeed_m_s) => airspeed_m_s,
        JsbsimSpeed::Calibrated(calibrated_m_s) => {
            true_of_calibrated_m_s(calibrated_m_s, &air).ok()?
        }
        JsbsimSpeed::Mach(mach) => mach * air.speed_of_sound_m_s,
    };
    let density_kg_m3 = air.density_kg_m3;
    Some(Way {
        course: Course {
            airspeed_m_s,
            height_m: jsbsim.altitude_m,
            climb_rad: jsbsim.climb_rad,
            axes_rad: jsbsim.climb_rad,
            heading_rad: jsbsim.heading_rad,
            start_m: [0.0; 2],
        },
        span_m: Some(ANY_SPAN_M),
        gravity_m_s2: STANDARD_GRAVITY_M_S2,
        altitude_m: jsbsim.altitude_m,
        dynamic_pressure_pa: 0.5 * density_kg_m3 * airspeed_m_s * airspeed_m_s,
        assumed: false,
    })
}

/// An FMU hears of an elevator alone.
fn refuse_air(report: &mut Report, section: &Section) {
    let parts = [WIND, TURBULENCE].into_iter().filter_map(|key| section.get(key));
    for part in parts.chain(section.sections(GUST)) {
        let message = "an FMU flies the aircraft, which hears of its elevator alone";
        let allowed = "still air, or kind = \"jsbsim\"";
        report.value(part.place, &part.path, message, allowed);
    }
}
