//! Reading the aircraft files of JSBSim, as far as they are tables and sums: an aircraft of tables.
//!
//! Aerodynamics whose forces and moments are proportional to the dynamic pressure become coefficients; mass, points of
//! mass and fuel become a rigid body. What a flight here does not have (flaps, gear, ground) is held at a value that the
//! notes say; what is neither known nor held is refused, all of it at once. Engines of JSBSim are no tables: one of a
//! constant largest thrust stands for them if it is asked for.
//!
//! # Source
//! J. S. Berndt, *JSBSim Reference Manual*, jsbsim.sourceforge.net; axes, signs and units as JSBSim 1.3.3 behaves.

mod axes;
mod body;
mod class;
mod ends;
mod engine;
mod expression;
mod metrics;
mod property;
mod reach;
mod surface;
mod table;
mod unit;

#[cfg(test)]
mod tests;

use crate::compile::compile;
use crate::document::{Document, Header, Source};
use crate::finding::{Findings, Origin};
use crate::flight::{Body, FlightError, Setting, TableForces};
use crate::model::Model;
use crate::xml::element::Element;
use crate::xml::parse;
use crate::{MAX_DEPTH, Note, Problem, Problems};
use fspid_aircraft::{Gearing, Range, Travel};

pub use surface::Stops;

/// What the file of an aircraft does not say.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Assumptions {
    /// Properties of JSBSim that are held at a value.
    pub held: Vec<(String, f64)>,
    /// Largest thrust of the engine that stands for those of the file; without it there is none.
    pub thrust_lbf: Option<f64>,
}

/// An aircraft that was read.
#[derive(Clone, Debug)]
pub struct JsbsimAircraft {
    /// Name in the file.
    pub name: String,
    /// Coefficients, with area, span and chord of reference.
    pub aerodynamics: Document,
    /// Mass, moments of inertia and centre of mass.
    pub inertia: Document,
    /// The engine that stands for those of the file.
    pub propulsion: Option<Document>,
    /// Stops of the surfaces.
    pub stops: Stops,
    /// What was assumed and left out, in the order of places.
    pub notes: Vec<Note>,
}

/// True for the text of an aircraft file of JSBSim, right or wrong.
#[must_use]
pub fn is_aircraft(text: &str) -> bool {
    text.contains("<fdm_config")
}

/// Reads an aircraft file of JSBSim.
///
/// # Errors
/// Every problem with its place: XML that is none, what is outside of the subset, tables that do not rise, units that are
/// not known, loads that are not proportional to the dynamic pressure, a body that is none.
pub fn read(text: &str, assumptions: &Assumptions) -> Result<JsbsimAircraft, Problems> {
    let tree = parse(text).map_err(|problem| Problems::of_text(vec![problem]))?;
    let mut findings = Findings::default();
    let aircraft = aircraft(Element::root(&tree), assumptions, &mut findings);
    if findings.good() {
        let documents = [&aircraft.aerodynamics, &aircraft.inertia];
        for document in documents.into_iter().chain(&aircraft.propulsion) {
            let _ = compile(document, &mut findings);
        }
    }
    let notes = findings.finish(text)?;
    let aircraft = described(JsbsimAircraft { notes, ..aircraft });
    match aircraft.flies() {
        Ok(_) => Ok(aircraft),
        Err(error) => Err(Problems::of_text(vec![Problem::whole(error.to_string(), "")])),
    }
}

impl JsbsimAircraft {
    /// Its body and its forces.
    ///
    /// # Errors
    /// A body that is none, such as one with moments of inertia that no mass has.
    pub fn flies(&self) -> Result<(Body, TableForces), FlightError> {
        let model = |document| Model::new(document).map_err(|_| FlightError::Output { name: "" });
        let body = Body::placed(&model(&self.inertia)?, None, 0.0)?;
        let engine = self.propulsion.as_ref().map(model).transpose()?;
        let Stops { elevator, aileron, rudder } = self.stops;
        let radians = |deg: (f64, f64)| Range { min: deg.0.to_radians(), max: deg.1.to_radians() };
        let travel = Travel {
            elevator_rad: radians(elevator),
            aileron_rad: radians(aileron),
            rudder_rad: radians(rudder),
            throttle: Range { min: 0.0, max: 1.0 },
        };
        let setting = Setting {
            centre_of_mass_m: body.centre_of_mass_m,
            gearing: Gearing::Proportional,
            travel,
        };
        Ok((body, TableForces::new(model(&self.aerodynamics)?, engine, setting)?))
    }
}

fn aircraft(
    root: Element<'_, '_>,
    assumptions: &Assumptions,
    findings: &mut Findings,
) -> JsbsimAircraft {
    let mut read = JsbsimAircraft {
        name: root.optional("name"),
        aerodynamics: Document::default(),
        inertia: Document::default(),
        propulsion: None,
        stops: Stops::default(),
        notes: Vec::new(),
    };
    if let Some(deep) = root.deeper_than(MAX_DEPTH) {
        let expected = format!("at most {MAX_DEPTH} elements inside each other");
        findings.problem(deep.origin(), deep.name(), "nested too deeply", expected);
        return read;
    }
    if root.name() != "fdm_config" {
        let message = "this is not an aircraft file of JSBSim";
        findings.problem(root.origin(), root.name(), message, "<fdm_config> around everything");
        return read;
    }
    elsewhere(root, findings);
    let metrics = metrics::read(root, findings);
    let mass = body::read(root, &metrics, findings);
    read.aerodynamics = axes::read(root, (&metrics, &assumptions.held), findings);
    read.propulsion = engine::propulsion(root, assumptions.thrust_lbf, &mass, findings);
    read.inertia = mass.document();
    read.stops = surface::stops(root, findings);
    read
}

/// Loads from outside of `<aerodynamics>`.
fn elsewhere(root: Element<'_, '_>, findings: &mut Findings) {
    for part in root.elements() {
        match part.name() {
            "external_reactions" => part.leave_out("no such force acts", findings),
            "buoyant_forces" => {
                part.refuse("fdm_config", "an aircraft that is heavier than air", findings);
            }
            _ => {}
        }
    }
}

/// An element of the file that has to be in it.
fn required<'a, 'i>(
    root: Element<'a, 'i>,
    name: &str,
    findings: &mut Findings,
) -> Option<Element<'a, 'i>> {
    let found = root.child(name);
    match found {
        None => {
            let expected = format!("<{name}> inside of <{}>", root.name());
            findings.problem(root.origin(), root.name(), format!("no <{name}>"), expected);
        }
        Some(part) if part.attribute("file").is_some() => {
            let message = format!("the <{name}> are in a file of their own");
            let word = part.optional("file");
            findings.problem(part.origin(), &word, message, "the elements of that file in here");
            return None;
        }
        Some(_) => {}
    }
    found
}

/// A header for each model, with what was assumed.
fn described(mut aircraft: JsbsimAircraft) -> JsbsimAircraft {
    let notes: Vec<_> = aircraft.notes.iter().map(ToString::to_string).collect();
    let header = |what: &str| Header {
        name: format!("{}: {what}", aircraft.name),
        description: format!(
            "Read from an aircraft file of JSBSim. Assumed: {}.",
            notes.join("; ")
        ),
        references: vec![Source {
            title: format!("aircraft file of JSBSim, {}", aircraft.name),
            ..Source::default()
        }],
        ..Header::default()
    };
    let headers = [header("aerodynamics"), header("body"), header("engine")];
    let [aerodynamics, body, engine] = headers;
    aircraft.aerodynamics.header = aerodynamics;
    aircraft.inertia.header = body;
    if let Some(propulsion) = &mut aircraft.propulsion {
        propulsion.header = engine;
    }
    aircraft
}

/// A constant that is answered, such as a mass.
fn answer(id: &str, (name, units): (&str, &str), value: f64) -> crate::document::Variable {
    crate::document::Variable {
        id: id.to_owned(),
        name: name.to_owned(),
        units: units.to_owned(),
        initial: Some(value),
        roles: vec![crate::document::Role::Output],
        origin: Origin(None),
        ..crate::document::Variable::default()
    }
}
