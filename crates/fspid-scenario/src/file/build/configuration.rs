//! What varies of an aircraft in flight: its configurations, the ground below it, its fuel.

use fspid_aircraft::aerodynamics::increment::Configuration;
use fspid_aircraft::aerodynamics::varied::Deployed;
use fspid_aircraft::data::{AircraftData, DerivativeData, GroundData, ModelData};
use fspid_aircraft::{Consumption, FuelledBody};
use fspid_sim::AircraftPlant;
use fspid_sim::aircraft::{Changing, ConfigurationChange, Deployment, Fuel, MOST_CONFIGURATIONS};

use super::judged;
use crate::file::aircraft::quantity;
use crate::file::aircraft::variations::{configurations, ground_data};
use crate::file::dispersion::placed_texts;
use crate::file::spec::configuration as keys;
use crate::file::spec::flight::GROUND_M;
use crate::keyed::Section;
use fspid_diagnostics::{Report, known_words};

/// What a scenario adds to an aircraft of derivatives.
pub(super) struct Varied {
    /// Configurations that are out at some time, with how far they are at the start.
    pub(super) deployed: Vec<Deployed>,
    /// What the ground does, and its altitude, m.
    pub(super) ground: Option<(GroundData, f64)>,
    deployments: Vec<Deployment>,
    fuel: Option<Fuel>,
}

impl Varied {
    /// True where the aircraft is that of its data.
    pub(super) fn is_none(&self) -> bool {
        self.deployed.is_empty() && self.ground.is_none() && self.fuel.is_none()
    }
}

/// Every table of the scenario that only a nonlinear aircraft of derivatives can have.
fn tables(section: &Section) -> impl Iterator<Item = &Section> {
    let lists = [keys::CONFIGURATION, keys::CONFIGURATION_CHANGE].into_iter();
    let single = [keys::GROUND_EFFECT, keys::FUEL].into_iter();
    lists.flat_map(|key| section.sections(key)).chain(single.filter_map(|key| section.get(key)))
}

/// Refuses them, and what an aircraft's table says of the start; true where there is any.
pub(super) fn refuse(
    report: &mut Report,
    (section, part): (&Section, Option<&Section>),
    message: &str,
) -> bool {
    let before = report.count();
    for table in tables(section) {
        report.value(table.place, &table.path, message, "nothing; or an aircraft of derivatives");
    }
    if let Some(part) = part.filter(|part| part.given(keys::OUT_AT_START)) {
        part.wrong(report, keys::OUT_AT_START, message, "nothing; leave it out");
    }
    report.count() > before
}

/// What of an aircraft varies; `None` for a problem.
pub(super) fn varied(
    report: &mut Report,
    (section, part): (&Section, &Section),
    data: &AircraftData,
) -> Option<Varied> {
    let before = report.count();
    let nothing = Varied { deployed: vec![], ground: None, deployments: vec![], fuel: None };
    let ModelData::Derivatives(derivatives) = &data.model else {
        let message = "it is for an aircraft of derivatives; this one is known by tables";
        return (!refuse(report, (section, Some(part)), message)).then_some(nothing);
    };
    if tables(section).any(|table| !table.sound) {
        return None;
    }
    let known = known(report, section, data);
    let (deployed, deployments) = deployed(report, (section, part), &known);
    let ground = section.get(keys::GROUND_EFFECT).map(ground_data);
    let ground = ground.or(data.variations.ground).zip(part.get(GROUND_M));
    let fuel = section.get(keys::FUEL).and_then(|part| fuel_of(report, part, derivatives));
    (report.count() == before).then_some(Varied { deployed, ground, deployments, fuel })
}

/// The configurations of the aircraft's file and those of the scenario.
fn known(report: &mut Report, section: &Section, data: &AircraftData) -> Vec<Configuration> {
    let of_file = &data.variations.configurations;
    let own = configurations(report, section.sections(keys::CONFIGURATION), of_file);
    of_file.iter().cloned().chain(own).collect()
}

/// Those that are out at some time, each with how far over time.
fn deployed(
    report: &mut Report,
    (section, part): (&Section, &Section),
    known: &[Configuration],
) -> (Vec<Deployed>, Vec<Deployment>) {
    let out = out_at_start(report, part, known);
    let changes = section.sections(keys::CONFIGURATION_CHANGE);
    for part in changes {
        let name = part.own_name();
        if !known.iter().any(|one| one.name == name) {
            part.wrong(report, keys::CHANGED, unknown(name, known), "");
        }
    }
    let (mut deployed, mut deployments) = (Vec::new(), Vec::new());
    for configuration in known {
        let is_own = |part: &&Section| part.own_name() == configuration.name;
        let own: Vec<&Section> = changes.iter().filter(is_own).collect();
        let share = if out.contains(&configuration.name) { 1.0 } else { 0.0 };
        if own.is_empty() && share == 0.0 {
            continue;
        }
        deployed.push(Deployed { configuration: configuration.clone(), share });
        deployments.extend(deployment(report, &own, share));
    }
    if deployed.len() > MOST_CONFIGURATIONS {
        let message = format!("{} configurations move or are out", deployed.len());
        let allowed = format!("up to {MOST_CONFIGURATIONS} in a flight");
        report.missing(part.place, &part.path, message, allowed);
    }
    (deployed, deployments)
}

/// What is wrong with a name that nothing has.
fn unknown(name: &str, known: &[Configuration]) -> String {
    let names: Vec<&str> = known.iter().map(|one| one.name.as_str()).collect();
    if names.is_empty() {
        return "the aircraft has no configurations; write a [[configuration]]".to_owned();
    }
    format!("no configuration of this name{}", known_words(name, &names))
}

/// Names that are out at the start, each of something.
fn out_at_start(report: &mut Report, part: &Section, known: &[Configuration]) -> Vec<String> {
    let Some(item) = part.get(keys::OUT_AT_START) else { return Vec::new() };
    let Some(names) = placed_texts(item) else {
        let message = format!("wrong type: {}", item.value.type_name());
        part.wrong(report, keys::OUT_AT_START, message, keys::names_in_words());
        return Vec::new();
    };
    let mut out: Vec<String> = Vec::new();
    for (place, name) in names {
        let path = part.path(keys::OUT_AT_START);
        if !known.iter().any(|one| one.name == name) {
            report.value(place, &path, unknown(&name, known), "");
        } else if out.contains(&name) {
            report.value(place, &path, "it is there already", "each name once");
        } else {
            out.push(name);
        }
    }
    out
}

/// How far one is out over time; changes that are not one after the other are problems.
fn deployment(report: &mut Report, parts: &[&Section], start: f64) -> Option<Deployment> {
    let mut changes: Vec<ConfigurationChange> = Vec::new();
    let mut before: Option<(&Section, f64)> = None;
    for part in parts {
        let at_s = part.get(keys::AT_S)?;
        let (takes_s, to) = (part.get(keys::TAKES_S)?, part.get(keys::TO)?);
        if let Some((other, free_s)) = before.filter(|(_, free_s)| at_s < *free_s) {
            let message = format!("{} has not ended", other.path);
            part.wrong(report, keys::AT_S, message, format!("from {free_s:?} s on"));
            return None;
        }
        before = Some((*part, at_s + takes_s));
        changes.push(ConfigurationChange { at_s, takes_s, to });
    }
    let deployment = Deployment::new(start, changes);
    match parts.first() {
        Some(part) => judged(report, (part, keys::AT_S), deployment),
        None => deployment.ok(),
    }
}

/// Fuel on board of an aircraft as it is loaded.
fn fuel_of(report: &mut Report, part: &Section, data: &DerivativeData) -> Option<Fuel> {
    let full_kg = quantity(part, keys::ON_BOARD)?;
    let flow = quantity(part, keys::FLOW).map(|kg_s| Consumption::Flow { kg_s });
    let by_thrust =
        || quantity(part, keys::SPECIFIC).map(|kg_n_s| Consumption::ThrustSpecific { kg_n_s });
    let consumption = flow.or_else(by_thrust)?;
    let cg_mac = data.reference.cg_mac.map(|reference| reference + data.cg_aft_chords());
    let tank_aft_m = match (part.get(keys::TANK_MAC), cg_mac) {
        (None, _) => 0.0,
        (Some(tank), Some(cg)) => (tank - cg) * data.geometry.chord_m,
        (Some(_), None) => {
            let message = "the aircraft's file does not say to which centre of gravity its derivatives belong; its [reference] needs cg_mac";
            part.wrong(report, keys::TANK_MAC, message, "nothing; leave it out");
            return None;
        }
    };
    let key = keys::ON_BOARD.into_iter().find(|key| part.given(*key))?;
    let body = FuelledBody::new(data.mass_properties(), full_kg, tank_aft_m);
    match body {
        Ok(body) => Some(Fuel { body, consumption }),
        Err(error) => {
            let allowed = "less than the mass that flies, in a tank from which a body remains";
            part.wrong(report, key, error.to_string(), allowed);
            None
        }
    }
}

/// The plant with what changes in its flight.
pub(super) fn changing(
    report: &mut Report,
    part: &Section,
    plant: AircraftPlant,
    varied: Varied,
) -> Option<AircraftPlant> {
    let Some(model) = plant.aircraft().model().varied() else { return Some(plant) };
    let changing = Changing::new(model, varied.deployments, varied.fuel);
    let changing = judged(report, (part, keys::OUT_AT_START), changing)?;
    Some(plant.changing_so(changing))
}

/// Refuses what a linear model does not do: change in flight.
pub(super) fn refuse_changes(report: &mut Report, section: &Section) {
    let changes = section.sections(keys::CONFIGURATION_CHANGE).iter();
    for part in changes.chain(section.get(keys::FUEL)) {
        let message = "a linear model does not change in flight";
        report.value(part.place, &part.path, message, "nothing; or a nonlinear aircraft");
    }
}
