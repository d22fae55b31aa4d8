//! Inputs bound to quantities of a flight, outputs turned into SI.

use crate::flight::error::FlightError;
use crate::flight::quantity::{Quantities, Quantity, output_factor};
use crate::model::{Model, Port};
use fspid_diagnostics::known_words;

/// Most inputs, and most outputs, of a model that flies.
pub(super) const ROOM: usize = 64;

/// Where each input of a model comes from.
#[derive(Clone, Debug)]
pub(super) struct Wiring(Vec<Wire>);

/// Where one input comes from.
#[derive(Clone, Copy, Debug)]
enum Wire {
    /// A quantity in SI, divided by what one unit of the model is.
    Quantity(Quantity, f64),
    /// Always the same.
    Fixed(f64),
}

impl Wiring {
    pub(super) fn of(model: &Model) -> Result<Self, FlightError> {
        let wires = model.inputs().map(wire).collect::<Result<Vec<_>, _>>()?;
        few(wires.len())?;
        Ok(Self(wires))
    }

    /// How many inputs there are.
    pub(super) fn count(&self) -> usize {
        self.0.len()
    }

    pub(super) fn inputs(&self, quantities: &Quantities) -> [f64; ROOM] {
        let mut inputs = [0.0; ROOM];
        for (input, wire) in inputs.iter_mut().zip(&self.0) {
            *input = match *wire {
                Wire::Quantity(quantity, unit) => quantities.get(quantity) / unit,
                Wire::Fixed(value) => value,
            };
        }
        inputs
    }
}

fn wire(port: &Port) -> Result<Wire, FlightError> {
    match (Quantity::named(&port.name), port.initial) {
        (Some(quantity), _) => Ok(Wire::Quantity(quantity, quantity.factor(port)?)),
        (None, Some(value)) => Ok(Wire::Fixed(value)),
        (None, None) => {
            Err(FlightError::Input { name: port.name.clone(), known: Quantity::names() })
        }
    }
}

/// Sentences about inputs that a flight leaves at the value of their file: those that it does not have, with what may be
/// meant, and of an engine the rate of the angle of attack, by which only the loads of the air may go.
pub(super) fn held(model: &Model, is_engine: bool) -> Vec<String> {
    model.inputs().filter_map(|port| held_input(port, is_engine)).collect()
}

fn held_input(port: &Port, is_engine: bool) -> Option<String> {
    let Port { name, units, initial, .. } = port;
    let unit = if units == "nd" { String::new() } else { format!(" {units}") };
    match Quantity::named(name) {
        None => Some(format!(
            "a flight has no `{name}`, which stays at its initial value, {:?}{unit}{}",
            (*initial)?,
            known_words(name, &Quantity::all_names())
        )),
        Some(Quantity::AlphaRate) if is_engine => Some(format!(
            "`{name}` stays at 0{unit} for the engine: only loads of the air go by it"
        )),
        Some(_) => None,
    }
}

pub(super) fn few(found: usize) -> Result<(), FlightError> {
    if found <= ROOM { Ok(()) } else { Err(FlightError::TooMany { found, allowed: ROOM }) }
}

/// Which outputs of a model are used, and what one unit of each is in SI.
#[derive(Clone, Debug)]
pub(super) struct Answers<const N: usize> {
    outputs: usize,
    picks: [(usize, f64); N],
}

impl<const N: usize> Answers<N> {
    pub(super) fn of(model: &Model, names: &[&'static str; N]) -> Result<Self, FlightError> {
        let outputs = model.outputs().count();
        few(outputs)?;
        let mut picks = [(0, 1.0); N];
        for (pick, name) in picks.iter_mut().zip(names) {
            *pick = picked(model, name)?;
        }
        Ok(Self { outputs, picks })
    }

    /// The outputs in SI.
    pub(super) fn read(&self, model: &Model, wiring: &Wiring, quantities: &Quantities) -> [f64; N] {
        let inputs = wiring.inputs(quantities);
        self.computed(model, inputs.get(..wiring.0.len()).unwrap_or_default())
    }

    fn computed(&self, model: &Model, inputs: &[f64]) -> [f64; N] {
        let mut outputs = [f64::NAN; ROOM];
        let room = outputs.get_mut(..self.outputs).unwrap_or_default();
        let computed = model.evaluate(inputs, room);
        debug_assert!(computed.is_ok(), "inputs and outputs were counted before");
        self.picks.map(|(index, unit)| outputs.get(index).copied().unwrap_or(f64::NAN) * unit)
    }
}

fn picked(model: &Model, name: &'static str) -> Result<(usize, f64), FlightError> {
    let mut outputs = model.outputs().enumerate();
    let found = outputs.find(|(_, port)| port.name == name);
    let (index, port) = found.ok_or(FlightError::Output { name })?;
    Ok((index, output_factor(port)?))
}

/// Outputs in SI that do not depend on the flight: read at the initial inputs.
pub(super) fn constants<const N: usize>(
    model: &Model,
    names: &[&'static str; N],
) -> Result<[f64; N], FlightError> {
    let answers = Answers::of(model, names)?;
    Ok(answers.computed(model, &model.initial_inputs()))
}

/// Outputs in SI at given inputs, in the order of the model and in its units.
pub(super) fn outputs_at<const N: usize>(
    model: &Model,
    names: &[&'static str; N],
    inputs: &[f64],
) -> Result<[f64; N], FlightError> {
    Ok(Answers::of(model, names)?.computed(model, inputs))
}
