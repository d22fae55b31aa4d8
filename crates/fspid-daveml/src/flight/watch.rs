//! Tables that are read beyond their data in flight, by something that the box of a flight does not have.
//!
//! The box has speed, Mach number, angles of the flow and altitude. A table may be entered by a control, a rate, or by what
//! the model calculates; beyond its data it goes on as its file says, and of the aircraft that says nothing.

use fspid_aircraft::{Departure, Quantity as Limit, Range, TableInput};

use super::port::{ROOM, Wiring};
use super::quantity::{Quantities, Quantity};
use crate::model::{Bounds, Model};

/// How far beyond an end a variable still is at it, of the size of the range: what turning units costs.
const ROUNDING: f64 = 1e-9;

/// Variables that enter tables and are looked at in flight.
#[derive(Clone, Debug)]
pub(super) struct Watch {
    slots: Vec<usize>,
    inputs: Vec<(TableInput, Range)>,
}

impl Watch {
    /// All that changes in flight and is not in the box already. What is held at a value is read where its file holds it.
    pub(super) fn of(model: &Model) -> Self {
        let moved = model.moved_by(|port| {
            Quantity::named(&port.name).is_some_and(|quantity| quantity != Quantity::AlphaRate)
        });
        let mut watch = Self { slots: Vec::new(), inputs: Vec::new() };
        for Bounds { variable, min, max } in model.bounds() {
            let Some(port) = model.variables().get(variable) else { continue };
            let boxed = Quantity::named(&port.name).is_some_and(|it| it.limit().is_some());
            if moved.get(variable) == Some(&true) && !boxed {
                watch.slots.push(variable);
                watch.inputs.push((TableInput::new(&port.id, &port.units), Range { min, max }));
            }
        }
        watch
    }

    /// The variables with the ranges of their tables.
    pub(super) fn ranges(&self) -> impl Iterator<Item = (TableInput, Range)> {
        self.inputs.iter().copied()
    }

    /// The first variable that is beyond its tables.
    pub(super) fn departure(
        &self,
        model: &Model,
        wiring: &Wiring,
        quantities: &Quantities,
    ) -> Option<Departure> {
        if self.slots.is_empty() {
            return None;
        }
        let inputs = wiring.inputs(quantities);
        let inputs = inputs.get(..wiring.count()).unwrap_or_default();
        self.slots.chunks(ROOM).zip(self.inputs.chunks(ROOM)).find_map(|(slots, watched)| {
            let mut values = [f64::NAN; ROOM];
            let room = values.get_mut(..slots.len()).unwrap_or_default();
            let computed = model.answer(inputs, slots, room);
            debug_assert!(computed.is_ok(), "inputs and slots were counted before");
            watched.iter().zip(values).find_map(|(watched, value)| beyond(watched, value))
        })
    }
}

/// A value that is not in the range of its tables; one that is not a number never is.
fn beyond(&(input, allowed): &(TableInput, Range), value: f64) -> Option<Departure> {
    let margin = ROUNDING * allowed.min.abs().max(allowed.max.abs());
    let wide = Range { min: allowed.min - margin, max: allowed.max + margin };
    let departure = Departure { quantity: Limit::Table(input), value, allowed };
    (!wide.contains(value)).then_some(departure)
}
