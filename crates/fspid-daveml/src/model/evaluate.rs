//! Computing a model.

use crate::MAX_VARIABLES;
use crate::expression::is_true;
use crate::model::axis::{Location, limited};
use crate::model::{Model, Operation, STACK, Step};
use crate::number::Number;

/// Why a model was not computed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum EvaluateError {
    /// Too many or too few inputs.
    #[error("{found} inputs were given; the model has {expected}")]
    Inputs {
        /// How many were given.
        found: usize,
        /// How many the model has.
        expected: usize,
    },
    /// Room for too many or too few answers.
    #[error("there is room for {found} answers; the model gives {expected}")]
    Outputs {
        /// For how many there was room.
        found: usize,
        /// How many the model gives.
        expected: usize,
    },
}

impl Model {
    /// Answers the outputs for inputs, each in the order of the file and in its units there.
    ///
    /// The heap is not used. Numbers that cannot be computed (a division of 0 by 0, an input that is NaN) are NaN.
    ///
    /// # Errors
    /// Slices of other lengths than the model has inputs and outputs.
    pub fn evaluate<N: Number>(
        &self,
        inputs: &[N],
        outputs: &mut [N],
    ) -> Result<(), EvaluateError> {
        self.answer(inputs, &self.outputs, outputs)
    }

    /// Answers all variables in the order of the file.
    ///
    /// # Errors
    /// Slices of other lengths than the model has inputs and variables.
    pub fn evaluate_all<N: Number>(
        &self,
        inputs: &[N],
        variables: &mut [N],
    ) -> Result<(), EvaluateError> {
        let expected = self.variables.len();
        if variables.len() != expected {
            return Err(EvaluateError::Outputs { found: variables.len(), expected });
        }
        // Numbers of slots, without the heap.
        let mut slots = [0; MAX_VARIABLES];
        for (index, slot) in slots.iter_mut().enumerate() {
            *slot = index;
        }
        self.answer(inputs, slots.get(..expected).unwrap_or_default(), variables)
    }

    /// Answers the variables in these slots.
    ///
    /// # Errors
    /// Slices of other lengths than the model has inputs, and than there are slots.
    pub(crate) fn answer<N: Number>(
        &self,
        inputs: &[N],
        slots: &[usize],
        answers: &mut [N],
    ) -> Result<(), EvaluateError> {
        if inputs.len() != self.inputs.len() {
            let (found, expected) = (inputs.len(), self.inputs.len());
            return Err(EvaluateError::Inputs { found, expected });
        }
        if answers.len() != slots.len() {
            let (found, expected) = (answers.len(), slots.len());
            return Err(EvaluateError::Outputs { found, expected });
        }
        // A small model does not pay for the room of a large one.
        match self.variables.len().max(self.axes.len()) {
            0..=32 => self.run::<N, 32>(inputs, slots, answers),
            33..=128 => self.run::<N, 128>(inputs, slots, answers),
            _ => self.run::<N, MAX_VARIABLES>(inputs, slots, answers),
        }
        Ok(())
    }

    fn run<N: Number, const ROOM: usize>(&self, inputs: &[N], slots: &[usize], answers: &mut [N]) {
        let mut memory = Memory::<N, ROOM>::new();
        for (place, &value) in memory.values.iter_mut().zip(&self.start) {
            *place = N::constant(value);
        }
        for (&slot, &input) in self.inputs.iter().zip(inputs) {
            memory.set(slot, input);
        }
        for step in &self.steps {
            self.step(step, &mut memory);
        }
        for (answer, &slot) in answers.iter_mut().zip(slots) {
            *answer = memory.get(slot);
        }
    }

    fn step<N: Number, const ROOM: usize>(&self, step: &Step, memory: &mut Memory<N, ROOM>) {
        match step {
            Step::Formula { slot, range } => {
                let code = self.code.get(range.clone()).unwrap_or_default();
                let value = memory.calculated(code);
                memory.set(*slot, value);
            }
            Step::Locate { axis } => {
                if let (Some(axis), index) = (self.axes.get(*axis), *axis) {
                    memory.set_location(index, axis.locate(memory.get(axis.slot)));
                }
            }
            Step::Interpolate { slot, grid } => {
                if let Some(grid) = self.grids.get(*grid) {
                    memory.set(*slot, grid.read(&memory.locations));
                }
            }
            Step::Limit { slot, min, max } => {
                memory.set(*slot, limited(memory.get(*slot), *min, *max));
            }
        }
    }
}

/// Values of variables, places on axes, and numbers that wait for an operation.
struct Memory<N, const ROOM: usize> {
    values: [N; ROOM],
    locations: [Location<N>; ROOM],
    stack: Stack<N>,
}

impl<N: Number, const ROOM: usize> Memory<N, ROOM> {
    fn new() -> Self {
        let location = Location { cell: 0, part: N::zero() };
        let stack = Stack { numbers: [N::zero(); STACK], count: 0 };
        Self { values: [N::zero(); ROOM], locations: [location; ROOM], stack }
    }

    #[inline]
    fn get(&self, slot: usize) -> N {
        self.values.get(slot).copied().unwrap_or(N::constant(f64::NAN))
    }

    #[inline]
    fn set(&mut self, slot: usize, value: N) {
        if let Some(place) = self.values.get_mut(slot) {
            *place = value;
        }
    }

    fn set_location(&mut self, axis: usize, location: Location<N>) {
        if let Some(place) = self.locations.get_mut(axis) {
            *place = location;
        }
    }

    /// The value of a formula.
    fn calculated(&mut self, code: &[Operation]) -> N {
        self.stack.count = 0;
        for operation in code {
            match *operation {
                Operation::Number(value) => self.stack.push(N::constant(value)),
                Operation::Variable(slot) => self.stack.push(self.get(slot)),
                Operation::One(function) => {
                    let a = self.stack.pop();
                    self.stack.push(function.apply(a));
                }
                Operation::Two(function) => {
                    let b = self.stack.pop();
                    let a = self.stack.pop();
                    self.stack.push(function.apply(a, b));
                }
                Operation::Choose => {
                    let condition = self.stack.pop();
                    let value = self.stack.pop();
                    let otherwise = self.stack.pop();
                    self.stack.push(if is_true(condition) { value } else { otherwise });
                }
            }
        }
        self.stack.pop()
    }
}

/// Numbers that wait for an operation.
struct Stack<N> {
    numbers: [N; STACK],
    count: usize,
}

impl<N: Number> Stack<N> {
    #[inline]
    fn push(&mut self, value: N) {
        if let Some(place) = self.numbers.get_mut(self.count) {
            *place = value;
            self.count += 1;
        }
    }

    #[inline]
    fn pop(&mut self) -> N {
        self.count = self.count.saturating_sub(1);
        self.numbers.get(self.count).copied().unwrap_or(N::constant(f64::NAN))
    }
}
