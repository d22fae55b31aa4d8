//! The aircraft of a scenario: read, trimmed, and flown nonlinear or linear.

use std::path::Path;

use fspid_aircraft::data::{AircraftData, Laws, ModelData};
use fspid_aircraft::{Aircraft, Environment, ForceModel, Quantity, TrimFailure, TrimTarget};
use fspid_sim::aircraft::Forces;
use fspid_sim::{AircraftPlant, Course, Plant, SimError};

use super::{data, judged, linear_aircraft, loading, rad};
use crate::aircraft::{AircraftFailure, Units};
use crate::file::aircraft::{Given, aircraft_data, aircraft_text, quantity};
use crate::file::files::Files;
use crate::file::section::Section;
use crate::file::spec::AIRCRAFT_FILE;
use crate::file::spec::flight::{AtmosphereWord, ModelWord};
use crate::flyer::flyer;
use fspid_diagnostics::Report;

/// A plant and what the air around it depends on.
pub(super) struct Flown {
    pub(super) plant: Plant,
    /// Where it flies, and its span; for an aircraft.
    pub(super) way: Option<Way>,
}

/// The way of an aircraft.
#[derive(Clone, Copy)]
pub(super) struct Way {
    pub(super) course: Course,
    /// `None` where the aircraft's file has none.
    pub(super) span_m: Option<f64>,
    pub(super) gravity_m_s2: f64,
    /// At the trim, before any wind.
    pub(super) dynamic_pressure_pa: f64,
    /// Whether airspeed and altitude are the scenario's alone, since the aircraft's file has no condition.
    pub(super) assumed: bool,
}

/// What flies, of the scenario's `plant` or `aircraft`.
pub(super) fn flown(
    report: &mut Report,
    files: &mut Files<'_>,
    section: &Section,
) -> Option<Flown> {
    let sound = |name: &str| section.section(name).filter(|part| part.sound);
    if let Some(part) = sound("aircraft") {
        return aircraft(report, files, part);
    }
    let plant = data::plant(report, files, sound("plant")?)?;
    Some(Flown { plant: plant.into(), way: None })
}

fn aircraft(report: &mut Report, files: &mut Files<'_>, part: &Section) -> Option<Flown> {
    let key = if part.given("file") { "file" } else { "name" };
    let data = read(report, files, part)?;
    let model = part.word("model").unwrap_or_else(|| default_model(&data));
    if part.text("model").is_none() {
        files.fill(part.path("model"), model.name());
    }
    let data = loading::loaded(report, (part, key), data)?;
    let span_m = match &data.model {
        ModelData::Derivatives(data) => Some(data.geometry.span_m),
        // Tables whose moments are 0 need none.
        ModelData::Forces(data) => Some(data.geometry.span_m).filter(|span_m| *span_m > 0.0),
        ModelData::Linear(model) => return linear_aircraft::flown(report, (part, key), model),
    };
    fits(report, part, &data)?;
    let target = target(part)?;
    check_ground(report, part, target);
    let own_air = part.word::<AtmosphereWord>("atmosphere")? == AtmosphereWord::Reference;
    let aircraft = flyer(&data, laws(part)?, own_air);
    let aircraft = judged(report, (part, key), aircraft)?;
    glides(report, part, &aircraft)?;
    let plant = trimmed(report, part, &aircraft, target)?;
    let target = plant.trim().target;
    let plant = match model {
        ModelWord::Linear => Plant::Linear(judged(report, (part, key), plant.linear())?),
        ModelWord::Nonlinear => above_ground(report, part, plant)?.into(),
    };
    let way = way(part, target, aircraft.environment())?;
    Some(Flown { plant, way: Some(Way { span_m, ..way }) })
}

/// Along a target in the air of an environment, by an aircraft without a span.
pub(super) fn way(part: &Section, target: TrimTarget, environment: &Environment) -> Option<Way> {
    let density_kg_m3 = environment.air_at(target.altitude_m).density_kg_m3;
    Some(Way {
        course: course(part, target)?,
        span_m: None,
        gravity_m_s2: environment.gravity_m_s2,
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
    let (key, section, place) = match part.text("name") {
        Some(name) => {
            let path = part.path("name");
            let named = (name, aircraft_text(name)?, path.as_str());
            ("name", data::carried(report, files, &AIRCRAFT_FILE, named)?, None)
        }
        None => {
            let (file, at) = (part.text("file")?, (part.at("file"), part.path("file")));
            let section = data::referred(report, files, &AIRCRAFT_FILE, (file, at))?;
            ("file", section, Path::new(file).parent())
        }
    };
    let place = place.unwrap_or(Path::new(""));
    let given = Given::of(files.written(&part.path(key)), part.number("cg_mac"));
    let aircraft = aircraft_data(report, files, (&section, place), given);
    files.keep(part.path(key), &AIRCRAFT_FILE, section);
    aircraft
}

pub(super) fn target(part: &Section) -> Option<TrimTarget> {
    Some(TrimTarget {
        airspeed_m_s: quantity(part, "airspeed")?,
        altitude_m: quantity(part, "altitude")?,
        flight_path_rad: rad(part.number("climb_angle_deg").unwrap_or(0.0)),
    })
}

pub(super) fn check_ground(report: &mut Report, part: &Section, target: TrimTarget) {
    let ground_m = part.number("ground_m").filter(|_| part.given("ground_m"));
    if ground_m.is_some_and(|ground_m| ground_m > target.altitude_m) {
        let allowed = format!("up to the altitude of the aircraft, {:?} m", target.altitude_m);
        let (place, path) = (part.at("ground_m"), part.path("ground_m"));
        report.value(place, &path, "the ground is above the aircraft", allowed);
    }
}

/// The aircraft over its ground, or a problem where it begins there: a flight ends at the ground.
fn above_ground(
    report: &mut Report,
    part: &Section,
    plant: AircraftPlant,
) -> Option<AircraftPlant> {
    let (ground_m, altitude_m) = (part.number("ground_m")?, plant.trim().target.altitude_m);
    let above = plant.above_ground(ground_m);
    // A ground above the aircraft that the file gives is told by itself.
    let told = part.given("ground_m") && ground_m > altitude_m;
    if above.is_err() && !told {
        let key = altitude_key(part);
        let allowed = format!("above the ground, {ground_m:?} m; or a lower `ground_m`");
        report.value(part.at(key), &part.path(key), "the flight begins at the ground", allowed);
    }
    above.ok()
}

fn altitude_key(part: &Section) -> &'static str {
    if part.given("altitude_ft") { "altitude_ft" } else { "altitude_m" }
}

fn laws(part: &Section) -> Option<Laws> {
    Some(Laws { drag: part.word("drag")?, thrust: part.word("thrust")? })
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
    if aircraft.model().has_engine() || !part.given("climb_angle_deg") {
        return Some(());
    }
    let message = "the aircraft has no engine; at its speed its path is that of its glide";
    let (at, path) = (part.at("climb_angle_deg"), part.path("climb_angle_deg"));
    report.value(at, &path, message, "nothing; leave it out");
    None
}

/// Refuses the laws that are for derivatives.
pub(super) fn refuse_laws(report: &mut Report, part: &Section, message: &str) {
    for key in ["drag", "thrust"].into_iter().filter(|key| part.given(key)) {
        report.value(part.at(key), &part.path(key), message, "nothing; leave it out");
    }
}

/// Refuses the air of a source that has none.
pub(super) fn refuse_own_air(report: &mut Report, part: &Section, message: &str) {
    if part.word("atmosphere") == Some(AtmosphereWord::Reference) {
        let at = (part.at("atmosphere"), part.path("atmosphere"));
        report.value(at.0, &at.1, message, "\"standard\"");
    }
}

/// Keys that say together, beside those of the loading, which flight is to be held.
const OF_TRIM: [&str; 6] = [
    "airspeed_m_s",
    "airspeed_kt",
    "airspeed_ft_s",
    "altitude_m",
    "altitude_ft",
    "climb_angle_deg",
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
                report.value(part.at(key), &part.path(key), message, allowed);
            }
            None => {
                let given = OF_TRIM.iter().chain(&loading::KEYS).filter(|key| part.given(key));
                let given = given.map(|key| format!("{key} = {}", report.text(part.at(key))));
                let given = given.collect::<Vec<_>>().join(", ");
                let allowed = format!("a flight that can be held; it follows from {given}");
                report.missing(part.place, &part.path, message, allowed);
            }
        }
    }
    plant.ok()
}

/// The key of the speed or the altitude where that itself is not one that the aircraft is known for.
fn out_of_range(part: &Section, failure: &TrimFailure) -> Option<&'static str> {
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

pub(super) fn airspeed_key(part: &Section) -> &'static str {
    let keys = ["airspeed_m_s", "airspeed_kt", "airspeed_ft_s"];
    keys.into_iter().find(|key| part.given(key)).unwrap_or("airspeed_m_s")
}

fn course(part: &Section, target: TrimTarget) -> Option<Course> {
    Some(Course {
        airspeed_m_s: target.airspeed_m_s,
        height_m: target.altitude_m - part.number("ground_m")?,
        climb_rad: target.flight_path_rad,
        heading_rad: rad(part.number("heading_deg")?),
        start_m: [0.0; 2],
    })
}
