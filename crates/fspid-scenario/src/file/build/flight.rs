//! The aircraft of a scenario: read, trimmed, and flown nonlinear or linear.

use super::flown::{Flown, FlownDerivatives, Way};
use std::path::Path;

use fspid_aircraft::data::{AircraftData, Laws, ModelData};
use fspid_aircraft::{Aircraft, Environment, ForceModel, Quantity, TrimFailure, TrimTarget};
use fspid_sim::aircraft::Forces;
use fspid_sim::{AircraftPlant, Course, Plant, SimError};

use super::{configuration, data, judged, linear_aircraft, loading, rad, simulator};
use crate::aircraft::{AircraftFailure, Units};
use crate::carried::aircraft_text;
use crate::file::aircraft::{Given, aircraft_data, quantity};
use crate::file::files::Files;
use crate::file::spec::AIRCRAFT_FILE;
use crate::file::spec::flight as keys;
use crate::file::spec::flight::{AtmosphereWord, ModelWord};
use crate::file::spec::scenario::{AIRCRAFT, PLANT, SIMULATOR};
use crate::flyer::{flyer, varied_flyer};
use crate::keyed::{Key, Section};
use fspid_diagnostics::Report;

/// What flies, of the scenario's `plant`, `aircraft` or `simulator`.
pub(super) fn flown(
    report: &mut Report,
    files: &mut Files<'_>,
    section: &Section,
) -> Option<Flown> {
    let sound = |key| section.get(key).filter(|part: &&Section| part.sound);
    if let Some(part) = sound(AIRCRAFT) {
        return aircraft(report, files, (section, part));
    }
    if section.get(AIRCRAFT).is_none() {
        let message = "it is for an aircraft of derivatives";
        configuration::refuse(report, (section, None), message);
    }
    if let Some(part) = sound(SIMULATOR) {
        return simulator::flown(report, files, section, part);
    }
    let plant = data::plant(report, files, sound(PLANT)?)?;
    Some(Flown { plant: plant.into(), way: None, derivatives: None })
}

fn aircraft(
    report: &mut Report,
    files: &mut Files<'_>,
    (section, part): (&Section, &Section),
) -> Option<Flown> {
    let key = if part.given(keys::FILE) { keys::FILE } else { keys::NAME };
    let data = read(report, files, part)?;
    let model = part.get(keys::MODEL).unwrap_or_else(|| default_model(&data));
    if part.get(keys::MODEL).is_none() {
        files.fill(part.path(keys::MODEL), model.name());
    }
    let data = loading::loaded(report, (part, key), data)?;
    let span_m = match &data.model {
        ModelData::Derivatives(data) => Some(data.geometry.span_m),
        // Tables whose moments are 0 need none.
        ModelData::Forces(data) => Some(data.geometry.span_m).filter(|span_m| *span_m > 0.0),
        ModelData::Linear(model) => {
            let message = "only a linear model of the aircraft is known";
            configuration::refuse(report, (section, Some(part)), message);
            return linear_aircraft::flown(report, (part, key), model);
        }
    };
    fits(report, part, &data)?;
    let varied = configuration::varied(report, (section, part), &data)?;
    let derivatives = match &data.model {
        ModelData::Derivatives(data) if varied.is_none() => Some(**data),
        _ => None,
    };
    let target = target(part)?;
    check_ground(report, part, target);
    let own_air = part.get(keys::ATMOSPHERE)? == AtmosphereWord::Reference;
    let aircraft = match varied.is_none() {
        true => flyer(&data, laws(part)?, own_air),
        false => {
            let added = (varied.deployed.clone(), varied.ground);
            varied_flyer(&data, laws(part)?, own_air, added)
        }
    };
    let aircraft = judged(report, (part, key), aircraft)?;
    glides(report, part, &aircraft)?;
    let plant = trimmed(report, part, &aircraft, target)?;
    let (target, alpha_rad) = (plant.trim().target, plant.trim().point.alpha_rad);
    let plant = match model {
        ModelWord::Linear => {
            configuration::refuse_changes(report, section);
            Plant::Linear(judged(report, (part, key), plant.linear())?)
        }
        ModelWord::Nonlinear => {
            let plant = above_ground(report, part, plant)?;
            configuration::changing(report, part, plant, varied)?.into()
        }
    };
    let environment = *aircraft.environment();
    let axes_rad = target.flight_path_rad + alpha_rad;
    let way = way(part, target, &environment)?;
    let course = Course { axes_rad, ..way.course };
    let laws = laws(part)?;
    let derivatives = derivatives.map(|data| FlownDerivatives { data, laws, environment, target });
    Some(Flown { plant, way: Some(Way { span_m, course, ..way }), derivatives })
}

/// Along a target in the air of an environment, by an aircraft without a span.
pub(super) fn way(part: &Section, target: TrimTarget, environment: &Environment) -> Option<Way> {
    let density_kg_m3 = environment.air_at(target.altitude_m).density_kg_m3;
    Some(Way {
        course: course(part, target)?,
        span_m: None,
        gravity_m_s2: environment.gravity_m_s2,
        altitude_m: target.altitude_m,
        dynamic_pressure_pa: 0.5 * density_kg_m3 * target.airspeed_m_s * target.airspeed_m_s,
        assumed: false,
    })
}

/// What flies where the scenario does not choose: the most that the data allow.
fn default_model(data: &AircraftData) -> ModelWord {
    match data.model {
        ModelData::Linear(_) => ModelWord::Linear,
        ModelData::Derivatives(_) | ModelData::Forces(_) => ModelWord::Nonlinear,
    }
}

fn read(report: &mut Report, files: &mut Files<'_>, part: &Section) -> Option<AircraftData> {
    let (key, section, place) = match part.get(keys::NAME) {
        Some(name) => {
            let path = part.path(keys::NAME);
            let named = (name, aircraft_text(name)?, path.as_str());
            (keys::NAME, data::carried(report, files, &AIRCRAFT_FILE, named)?, None)
        }
        None => {
            let (file, at) = (part.get(keys::FILE)?, (part.at(keys::FILE), part.path(keys::FILE)));
            let section = data::referred(report, files, &AIRCRAFT_FILE, (file, at))?;
            (keys::FILE, section, Path::new(file).parent())
        }
    };
    let place = place.unwrap_or(Path::new(""));
    let given = Given::of(files.written(&part.path(key)), part.get(keys::CG_MAC));
    let aircraft = aircraft_data(report, files, (&section, place), given);
    files.keep(part.path(key), &AIRCRAFT_FILE, section);
    aircraft
}

pub(super) fn target(part: &Section) -> Option<TrimTarget> {
    Some(TrimTarget {
        airspeed_m_s: quantity(part, keys::AIRSPEED)?,
        altitude_m: quantity(part, keys::ALTITUDE)?,
        flight_path_rad: rad(part.get(keys::CLIMB_ANGLE_DEG).unwrap_or(0.0)),
    })
}

pub(super) fn check_ground(report: &mut Report, part: &Section, target: TrimTarget) {
    let ground_m = part.get(keys::GROUND_M).filter(|_| part.given(keys::GROUND_M));
    if ground_m.is_some_and(|ground_m| ground_m > target.altitude_m) {
        let allowed = format!("up to the altitude of the aircraft, {:?} m", target.altitude_m);
        part.wrong(report, keys::GROUND_M, "the ground is above the aircraft", allowed);
    }
}

/// The aircraft over its ground, or a problem where it begins there: a flight ends at the ground.
fn above_ground(
    report: &mut Report,
    part: &Section,
    plant: AircraftPlant,
) -> Option<AircraftPlant> {
    let (ground_m, altitude_m) = (part.get(keys::GROUND_M)?, plant.trim().target.altitude_m);
    let above = plant.above_ground(ground_m);
    // A ground above the aircraft that the file gives is told by itself.
    let told = part.given(keys::GROUND_M) && ground_m > altitude_m;
    if above.is_err() && !told {
        let key = altitude_key(part);
        let allowed = format!("above the ground, {ground_m:?} m; or a lower `ground_m`");
        part.wrong(report, key, "the flight begins at the ground", allowed);
    }
    above.ok()
}

pub(super) fn altitude_key(part: &Section) -> Key<f64> {
    given(part, keys::ALTITUDE)
}

pub(super) fn airspeed_key(part: &Section) -> Key<f64> {
    given(part, keys::AIRSPEED)
}

/// The one of some keys that is given, the first if none is.
fn given<const N: usize>(part: &Section, keys: [Key<f64>; N]) -> Key<f64> {
    keys.into_iter().find(|key| part.given(*key)).unwrap_or(keys[0])
}

fn laws(part: &Section) -> Option<Laws> {
    Some(Laws { drag: part.get(keys::DRAG)?, thrust: part.get(keys::THRUST)? })
}

/// Refuses what only derivatives can do, where there are tables.
fn fits(report: &mut Report, part: &Section, data: &AircraftData) -> Option<()> {
    let ModelData::Forces(data) = &data.model else {
        return Some(());
    };
    let before = report.count();
    refuse_laws(report, part, "the aircraft is known by tables, which say it themselves");
    if data.air.is_none() {
        let message = "the aircraft is known by tables, and its file says no air of its own";
        refuse_own_air(report, part, message);
    }
    (report.count() == before).then_some(())
}

/// Refuses a path for an aircraft that glides on its own.
fn glides(report: &mut Report, part: &Section, aircraft: &Aircraft<Forces>) -> Option<()> {
    if aircraft.model().has_engine() || !part.given(keys::CLIMB_ANGLE_DEG) {
        return Some(());
    }
    let message = "the aircraft has no engine; at its speed its path is that of its glide";
    part.wrong(report, keys::CLIMB_ANGLE_DEG, message, "nothing; leave it out");
    None
}

/// Refuses the laws that are for derivatives.
pub(super) fn refuse_laws(report: &mut Report, part: &Section, message: &str) {
    for key in [keys::DRAG.name, keys::THRUST.name].into_iter().filter(|key| part.given(*key)) {
        part.wrong(report, key, message, "nothing; leave it out");
    }
}

/// Refuses the air of a source that has none.
pub(super) fn refuse_own_air(report: &mut Report, part: &Section, message: &str) {
    if part.get(keys::ATMOSPHERE) == Some(AtmosphereWord::Reference) {
        let at = (part.at(keys::ATMOSPHERE), part.path(keys::ATMOSPHERE));
        report.value(at.0, &at.1, message, "\"standard\"");
    }
}

/// Keys that say together, beside those of the loading, which flight is to be held.
const OF_TRIM: [Key<f64>; 6] = [
    keys::AIRSPEED[0],
    keys::AIRSPEED[1],
    keys::AIRSPEED[2],
    keys::ALTITUDE[0],
    keys::ALTITUDE[1],
    keys::CLIMB_ANGLE_DEG,
];

/// The aircraft at its trim, or a problem: at what lies out of its own range, else at the table as a whole.
fn trimmed(
    report: &mut Report,
    part: &Section,
    aircraft: &Aircraft<Forces>,
    target: TrimTarget,
) -> Option<AircraftPlant> {
    let plant = AircraftPlant::trimmed(aircraft.clone(), target);
    if let Err(SimError::Trim(failure)) = &plant {
        let words = AircraftFailure::Trim { failure: failure.clone(), units: Units::Si };
        let message = in_a_line(&words.to_string());
        match out_of_range(part, failure) {
            Some(key) => {
                let allowed = "a speed and an altitude at which the aircraft can be trimmed";
                part.wrong(report, key, message, allowed);
            }
            None => {
                let of_trim = OF_TRIM.iter().map(|key| key.name);
                let names = of_trim.chain(keys::LOADING.iter().map(|key| key.name()));
                let given = names.filter(|name| part.given(*name));
                let given = given.map(|name| format!("{name} = {}", report.text(part.at(name))));
                let given = given.collect::<Vec<_>>().join(", ");
                let allowed = format!("a flight that can be held; it follows from {given}");
                report.missing(part.place, &part.path, message, allowed);
            }
        }
    }
    plant.ok()
}

/// The key of the speed or the altitude where that itself is not one that the aircraft is known for.
fn out_of_range(part: &Section, failure: &TrimFailure) -> Option<Key<f64>> {
    failure.limits.iter().find_map(|limit| match limit.quantity {
        Quantity::Airspeed | Quantity::Mach => Some(airspeed_key(part)),
        Quantity::Altitude => Some(altitude_key(part)),
        _ => None,
    })
}

/// Sentences in lines of their own, as one line of a problem.
fn in_a_line(text: &str) -> String {
    let lines: Vec<&str> = text.lines().map(|line| line.trim().trim_end_matches(';')).collect();
    lines.join("; ")
}

fn course(part: &Section, target: TrimTarget) -> Option<Course> {
    Some(Course {
        airspeed_m_s: target.airspeed_m_s,
        height_m: target.altitude_m - part.get(keys::GROUND_M)?,
        climb_rad: target.flight_path_rad,
        axes_rad: target.flight_path_rad,
        heading_rad: rad(part.get(keys::HEADING_DEG)?),
        start_m: [0.0; 2],
    })
}
