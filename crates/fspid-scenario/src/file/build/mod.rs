//! From a checked file to the scenario: units become SI, and the models judge their numbers.

mod actuator;
mod air;
mod airframe;
mod autopilot;
mod configuration;
mod control_law;
mod controller;
mod cost;
pub(crate) mod data;
mod derived;
mod ends;
mod external;
mod flight;
mod flight_stack;
mod flown;
mod idle;
mod linear_aircraft;
mod loading;
pub(super) mod loops;
mod lqi;
mod range_rule;
mod schedule;
mod sensor;
mod signal;
mod simulator;
mod supervisor;
mod timing;
mod wind_table;

pub use airframe::Airframe;
pub use derived::{DerivedGains, GainSource};
use flight_stack::Which;
use flown::Flown;
pub use flown::FlownDerivatives;
use fspid_sim::actuator::Actuator;
use fspid_sim::signal::Disturbance;
use fspid_sim::{
    Autopilot, ElevatorSign, LinearPlant, NamedController, NamedExternal, Scenario, Surroundings,
    Timing,
};
pub use range_rule::RangeRule;
use schedule::Pressure;
pub use schedule::Schedule;
use timing::Sampling;

use crate::dispersion::Dispersion;
use crate::file::dispersion::dispersions;
use crate::file::files::Files;
use crate::file::overrides;
use crate::file::requirement::requirements;
use crate::file::spec::controller::{ControllerKind, NAME};
use crate::file::spec::scenario as keys;
use crate::file::tuning::{contest, tuning};
use crate::keyed::{KeyName, Section};
use crate::requirement::Requirement;
use crate::tuning::{Contest, Tuning};
use crate::units::radians as rad;
use fspid_diagnostics::{Report, in_two};

/// A period that stands in where the loop is wrong, so that controllers are judged all the same, s.
const STAND_IN_PERIOD_S: f64 = 0.01;

/// A scenario with what is asked of it.
pub(crate) struct Built {
    pub(crate) scenario: Scenario,
    pub(crate) requirements: Vec<Requirement>,
    pub(crate) airframes: Vec<Airframe>,
    pub(crate) dispersions: Vec<Dispersion>,
    pub(crate) derived_gains: Vec<DerivedGains>,
    pub(crate) tuning: Option<Tuning>,
    pub(crate) contest: Option<Contest>,
    pub(crate) range_rule: RangeRule,
    pub(crate) derivatives: Option<FlownDerivatives>,
}

/// The scenario with its requirements; every part that the check left sound is built even where
/// another is wrong, so that its own problems are found too.
pub(crate) fn scenario(
    report: &mut Report,
    files: &mut Files<'_>,
    section: &Section,
) -> Option<Built> {
    section.get(keys::SET).into_iter().for_each(|item| overrides::check_listed(report, item));
    let timing = sound(section.get(keys::LOOP)).and_then(|part| timing::timing(report, part));
    let flown = flown(report, files, section);
    let actuator = actuator(report, section);
    let sampling = timing.zip(actuator).map(|(timing, actuator)| Sampling { timing, actuator });
    check_linear(report, section, flown.as_ref(), sampling);
    let setpoint =
        sound(section.get(keys::SETPOINT)).and_then(|part| signal::setpoint(report, part));
    let disturbances = disturbances(report, section);
    let plant_changes = timing::plant_changes(
        report,
        files,
        section.sections(keys::PLANT_CHANGE),
        flown.as_ref().map(|flown| &flown.plant),
        sampling,
    );
    let surroundings = surroundings(report, files, section, flown.as_ref());
    let autopilot =
        autopilot::autopilot(report, files, section, (flown.as_ref(), period_s(timing)));
    let pressure = Pressure::of(section, flown.as_ref());
    let (controllers, derived_gains) = controllers(report, files, section, (timing, pressure));
    let externals = externals(report, files, section, (flown.as_ref(), timing, autopilot.as_ref()));
    timing::check_memory(report, section, timing);
    let names = names(section);
    let requirements = requirements(report, files, section.sections(keys::REQUIREMENT), &names);
    let tuning = section.get(keys::TUNING).and_then(|part| tuning(report, part, &names));
    let contest = section.get(keys::CONTEST).and_then(|part| contest(report, part, &names));
    let airframes = airframe::airframes(files, section, flown.as_ref());
    let derivatives = flown.as_ref().and_then(|flown| flown.derivatives.clone());
    let scenario = Scenario {
        name: section.get(keys::NAME)?.to_owned(),
        plant: flown?.plant,
        plant_changes,
        actuator: actuator?,
        timing: timing?,
        setpoint: setpoint?,
        disturbances,
        controllers,
        externals,
        surroundings: surroundings?,
        autopilot: autopilot?,
    };
    check_whole(report, section, &scenario);
    Some(Built {
        range_rule: RangeRule::of(section, &scenario),
        derivatives,
        scenario,
        requirements,
        airframes,
        dispersions: dispersions(report, section.sections(keys::DISPERSION)),
        derived_gains,
        tuning,
        contest,
    })
}

/// What flies, with its engine and what looks after its lateral motion.
fn flown(report: &mut Report, files: &mut Files<'_>, section: &Section) -> Option<Flown> {
    let flown = flight::flown(report, files, section)?;
    autopilot::equipped(report, section, flown)
}

/// Asks of a scenario whose every part is sound what only the whole can answer.
fn check_whole(report: &mut Report, section: &Section, scenario: &Scenario) {
    if section.sound {
        timing::check_flight(report, section, scenario);
        cost::check(report, section, scenario);
    }
}

/// The sample period, or what stands in for it, s.
fn period_s(timing: Option<Timing>) -> f64 {
    timing.map_or(STAND_IN_PERIOD_S, |timing| timing.dt_s())
}

/// Asks of a linear plant what it has to be at this period and with this actuator, where all three are sound.
fn check_linear(
    report: &mut Report,
    section: &Section,
    flown: Option<&Flown>,
    sampling: Option<Sampling>,
) {
    let linear = flown.and_then(|flown| flown.plant.linear());
    if let (Some(plant), Some(sampling)) = (linear, sampling) {
        timing::check_plant(report, section, plant, sampling);
    }
}

/// What moves the elevator.
fn actuator(report: &mut Report, section: &Section) -> Option<Actuator> {
    match section.get(keys::ACTUATOR) {
        None => Some(Actuator::ideal()),
        part => sound(part).and_then(|part| actuator::actuator(report, part)),
    }
}

fn disturbances(report: &mut Report, section: &Section) -> Vec<Disturbance> {
    let parts = section.sections(keys::DISTURBANCE).iter().filter(|part| part.sound);
    parts.filter_map(|part| signal::disturbance(report, part)).collect()
}

/// Moving air and sensors; what is wrong with them is reported.
fn surroundings(
    report: &mut Report,
    files: &mut Files<'_>,
    section: &Section,
    flown: Option<&Flown>,
) -> Option<Surroundings> {
    let weather = flown.map(|flown| air::weather(report, files, (section, flown)));
    let sensors = match section.get(keys::SENSOR) {
        None => Some((None, None)),
        part => sound(part).and_then(|part| sensor::sensors(report, part)),
    };
    let (pitch_sensor, rate_sensor) = sensors?;
    Some(Surroundings { weather: weather?, pitch_sensor, rate_sensor })
}

/// A part in which the check found nothing wrong.
fn sound(part: Option<&Section>) -> Option<&Section> {
    part.filter(|part| part.sound)
}

/// Which way the elevator is counted.
pub(crate) fn elevator_sign(section: &Section) -> Option<ElevatorSign> {
    section.get(keys::ELEVATOR_SIGN)
}

/// The value, or a problem at `key` in the model's own words.
fn judged<T, E: std::fmt::Display>(
    report: &mut Report,
    (section, key): (&Section, impl Into<KeyName>),
    result: Result<T, E>,
) -> Option<T> {
    match result {
        Ok(value) => Some(value),
        Err(error) => {
            let (text, key) = (error.to_string(), key.into());
            let (message, allowed) = in_two(&text);
            section.problem(report, key, message, allowed);
            None
        }
    }
}

/// Names of all controllers, sound or not.
fn names(section: &Section) -> Vec<&str> {
    let controllers = section.sections(keys::CONTROLLER).iter();
    controllers.filter_map(|part| part.get(NAME)).collect()
}

fn controllers(
    report: &mut Report,
    files: &mut Files<'_>,
    section: &Section,
    (timing, pressure): (Option<Timing>, Pressure),
) -> (Vec<NamedController>, Vec<DerivedGains>) {
    let parts = section.sections(keys::CONTROLLER);
    for (index, part) in parts.iter().enumerate() {
        let earlier = parts.get(..index).unwrap_or_default();
        let name = part.get(NAME);
        if let Some(twin) = earlier.iter().find(|other| name.is_some() && other.get(NAME) == name) {
            let message = format!("the name is taken by {}", twin.path);
            part.wrong(report, NAME, message, "a name of its own");
        }
    }
    let dt_s = period_s(timing);
    let (mut controllers, mut derived_gains) = (Vec::new(), Vec::new());
    for part in parts.iter().filter(|part| part.sound) {
        let name = part.get(NAME).unwrap_or_default().to_owned();
        let controller = controller::controller(report, files, part, (dt_s, pressure));
        if let Some(controller) = controller {
            derived_gains.extend(derived::derived(part, &controller, pressure));
            controllers.push(NamedController { name, controller });
        }
    }
    (controllers, derived_gains)
}

/// The controllers without equations.
fn externals(
    report: &mut Report,
    files: &mut Files<'_>,
    section: &Section,
    (flown, timing, autopilot): (Option<&Flown>, Option<Timing>, Option<&Option<Autopilot>>),
) -> Vec<NamedExternal> {
    let has_autopilot = autopilot.is_some_and(Option::is_some);
    let plant = flown.map(|flown| &flown.plant);
    let around = (period_s(timing), plant, has_autopilot);
    let build = |part: &Section| match part.variant()? {
        ControllerKind::External => {
            external::external(report, files, part, (flown, timing, has_autopilot))
        }
        ControllerKind::ArduPilot => {
            flight_stack::flight_stack(report, files, (part, Which::ArduPilot), around)
        }
        ControllerKind::Px4 => {
            flight_stack::flight_stack(report, files, (part, Which::Px4), around)
        }
        // Built elsewhere: they have equations.
        ControllerKind::P | ControllerKind::Pid | ControllerKind::Fspid | ControllerKind::Lqi => {
            None
        }
    };
    let parts = section.sections(keys::CONTROLLER).iter().filter(|part| part.sound);
    parts.filter_map(build).collect()
}

/// True for a plant of another order.
fn order_differs(before: &LinearPlant, after: &LinearPlant) -> bool {
    before.order() != after.order()
}
