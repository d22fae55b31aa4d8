//! The memories of all lanes' controllers.

use fspid_core::equations::Memory;
use fspid_core::{Faults, State};

use super::lane::{Lanes, Mask, NO, YES};

const REST: Memory<f64> = Memory {
    command_rad: 0.0,
    integral: 0.0,
    derivative_rad_s: 0.0,
    error_rad: 0.0,
    derivative_input_rad: 0.0,
    kp: 0.0,
    ki: 0.0,
    kd: 0.0,
    model_rad: 0.0,
    model_rad_s: 0.0,
};

/// As [`State`], one a lane.
#[derive(Clone, Debug)]
pub(super) struct Memories<const W: usize> {
    /// Mean something where there was a good sample.
    pub(super) numbers: Memory<Lanes<W>>,
    /// True where there was a good sample.
    pub(super) has_previous: Mask<W>,
    pub(super) faults: [Faults; W],
}

impl<const W: usize> Memories<W> {
    /// Memories that have seen a sample of zeros and answered it by zeros.
    pub(super) fn at_rest() -> Self {
        let numbers = REST.map(|&number| [number; W]);
        Self { numbers, has_previous: [YES; W], faults: [Faults::NONE; W] }
    }

    /// The numbers of one lane.
    #[inline(always)]
    pub(super) fn at(&self, lane: usize) -> Memory<f64> {
        self.numbers.map(|column| column[lane])
    }

    /// The memory of one lane.
    pub(super) fn state(&self, lane: usize) -> State<f64> {
        let faults = self.faults[lane];
        if self.has_previous[lane] == YES {
            return State::remembering(self.at(lane), faults);
        }
        State { faults, ..State::new() }
    }

    /// Puts a memory into a lane.
    pub(super) fn set(&mut self, lane: usize, state: &State<f64>) {
        let memory = state.memory();
        self.has_previous[lane] = if memory.is_some() { YES } else { NO };
        self.faults[lane] = state.faults;
        self.numbers.put(memory.unwrap_or(REST), |column, number| column[lane] = number);
    }

    /// Makes a lane one that has seen zeros and answered zeros.
    pub(super) fn park(&mut self, lane: usize) {
        self.numbers.put(REST, |column, number| column[lane] = number);
        (self.has_previous[lane], self.faults[lane]) = (YES, Faults::NONE);
    }
}
