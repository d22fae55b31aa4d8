//! A model that can be computed.

mod axis;
mod check;
mod evaluate;

use core::ops::Range;

use crate::document::Document;
use crate::expression::{One, Two};

pub use axis::Bounds;
pub(crate) use axis::{Axis, Grid};
pub use check::{CheckReport, Deviation, ShotReport};
pub(crate) use check::{ResolvedShot, ResolvedSignal};
pub use evaluate::EvaluateError;

/// Most numbers of a formula that wait at once.
pub(crate) const STACK: usize = 64;

/// A model whose names are resolved and whose order of computing is known. Computing it does not use the heap.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    pub(crate) variables: Vec<Port>,
    pub(crate) inputs: Vec<usize>,
    pub(crate) outputs: Vec<usize>,
    /// Constants in their slots; everything else is computed.
    pub(crate) start: Vec<f64>,
    pub(crate) steps: Vec<Step>,
    pub(crate) code: Vec<Operation>,
    pub(crate) axes: Vec<Axis>,
    pub(crate) grids: Vec<Grid>,
    pub(crate) shots: Vec<ResolvedShot>,
}

/// A variable as it is seen from outside.
#[derive(Clone, Debug, PartialEq)]
pub struct Port {
    /// Identifier in the file.
    pub id: String,
    /// Name, often one of the standard.
    pub name: String,
    /// Units in the spelling of the standard.
    pub units: String,
    /// Which way it counts, in the words of the file; empty where it does not say so.
    pub sign: String,
    /// Value of an input that is not given, if the file has one.
    pub initial: Option<f64>,
}

/// One step of computing a model.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Step {
    /// Computes a variable by code.
    Formula { slot: usize, range: Range<usize> },
    /// Finds a variable between the breakpoints of an axis.
    Locate { axis: usize },
    /// Reads a variable off a grid.
    Interpolate { slot: usize, grid: usize },
    /// Keeps a variable within its limits.
    Limit { slot: usize, min: f64, max: f64 },
}

/// One step of computing a formula.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Operation {
    /// Puts down a number.
    Number(f64),
    /// Puts down the value of a variable.
    Variable(usize),
    /// Replaces the last number.
    One(One),
    /// Replaces the last two numbers.
    Two(Two),
    /// Replaces otherwise, value, condition by one of the first two.
    Choose,
}

impl From<One> for Operation {
    fn from(one: One) -> Self {
        Self::One(one)
    }
}

impl From<Two> for Operation {
    fn from(two: Two) -> Self {
        Self::Two(two)
    }
}

impl Operation {
    /// How many waiting numbers it takes.
    pub(crate) fn operands(self) -> usize {
        match self {
            Self::Number(_) | Self::Variable(_) => 0,
            Self::One(_) => 1,
            Self::Two(_) => 2,
            Self::Choose => 3,
        }
    }
}

impl Step {
    /// The variable that it makes.
    pub(crate) fn slot(&self) -> Option<usize> {
        match *self {
            Self::Formula { slot, .. } | Self::Interpolate { slot, .. } => Some(slot),
            Self::Limit { .. } | Self::Locate { .. } => None,
        }
    }
}

impl Model {
    /// A model with the variables of a document and nothing to compute.
    pub(crate) fn empty(document: &Document) -> Self {
        let ports = document.variables.iter().map(|variable| Port {
            id: variable.id.clone(),
            name: variable.name.clone(),
            units: variable.units.clone(),
            sign: variable.sign.clone(),
            initial: variable.initial,
        });
        Self {
            variables: ports.collect(),
            inputs: Vec::new(),
            outputs: Vec::new(),
            start: vec![0.0; document.variables.len()],
            steps: Vec::new(),
            code: Vec::new(),
            axes: Vec::new(),
            grids: Vec::new(),
            shots: Vec::new(),
        }
    }

    pub(crate) fn set_start(&mut self, slot: usize, value: f64) {
        if let Some(place) = self.start.get_mut(slot) {
            *place = value;
        }
    }

    /// The axes with which a step enters its grid.
    pub(crate) fn axes_of(&self, step: &Step) -> Vec<usize> {
        match step {
            Step::Interpolate { grid, .. } => {
                self.grids.get(*grid).map(|grid| grid.axes.clone()).unwrap_or_default()
            }
            _ => Vec::new(),
        }
    }

    /// All variables, in the order of the file.
    #[must_use]
    pub fn variables(&self) -> &[Port] {
        &self.variables
    }

    /// Variables that have to be given, in the order in which they are given.
    pub fn inputs(&self) -> impl Iterator<Item = &Port> {
        self.ports(&self.inputs)
    }

    /// Variables that are answered, in the order in which they are answered.
    pub fn outputs(&self) -> impl Iterator<Item = &Port> {
        self.ports(&self.outputs)
    }

    fn ports<'a>(&'a self, slots: &'a [usize]) -> impl Iterator<Item = &'a Port> {
        slots.iter().filter_map(|&slot| self.variables.get(slot))
    }

    /// The value of an output that nothing computes; `None` for another, and where there is none of that name.
    #[must_use]
    pub fn constant(&self, name: &str) -> Option<f64> {
        let named =
            |slot: &&usize| self.variables.get(**slot).is_some_and(|port| port.name == name);
        let slot = *self.outputs.iter().find(named)?;
        let computed = self.steps.iter().any(|step| step.slot() == Some(slot));
        (!computed && !self.inputs.contains(&slot)).then(|| self.start.get(slot).copied()).flatten()
    }

    /// For each variable whether it changes with an input for which `moves` holds, by itself or by a calculation or table.
    pub(crate) fn moved_by(&self, moves: impl Fn(&Port) -> bool) -> Vec<bool> {
        let mut moved = vec![false; self.variables.len()];
        for &slot in &self.inputs {
            let port = self.variables.get(slot);
            if let (Some(place), Some(port)) = (moved.get_mut(slot), port) {
                *place = moves(port);
            }
        }
        // In the order of computing what a step needs is known before it.
        for step in &self.steps {
            let is_moved = self.needs(step).iter().any(|&slot| moved.get(slot) == Some(&true));
            if let (true, Some(place)) = (is_moved, step.slot().and_then(|it| moved.get_mut(it))) {
                *place = true;
            }
        }
        moved
    }

    /// Variables that a step makes its own of.
    fn needs(&self, step: &Step) -> Vec<usize> {
        let code = match step {
            Step::Formula { range, .. } => self.code.get(range.clone()).unwrap_or_default(),
            _ => &[],
        };
        let named = code.iter().filter_map(|operation| match operation {
            Operation::Variable(slot) => Some(*slot),
            _ => None,
        });
        let axes = self.axes_of(step).into_iter().filter_map(|axis| self.axes.get(axis));
        named.chain(axes.map(|axis| axis.slot)).collect()
    }

    /// Values of the inputs that the file gives, 0 for the others.
    #[must_use]
    pub fn initial_inputs(&self) -> Vec<f64> {
        self.inputs().map(|port| port.initial.unwrap_or(0.0)).collect()
    }
}
