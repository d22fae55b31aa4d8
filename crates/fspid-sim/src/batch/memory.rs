//! The memories of all lanes' controllers.

use fspid_core::{Faults, Gains, ModelState, Previous, State};

use super::lane::{Lanes, Mask, NO, YES};

/// As [`State`], one a lane.
#[derive(Clone, Debug)]
pub(super) struct Memories<const W: usize> {
    pub(super) command_rad: Lanes<W>,
    pub(super) integral: Lanes<W>,
    pub(super) derivative_rad_s: Lanes<W>,
    /// True where there was a good sample; what follows is of the last one.
    pub(super) has_previous: Mask<W>,
    pub(super) error_rad: Lanes<W>,
    pub(super) derivative_input_rad: Lanes<W>,
    pub(super) gains: [Lanes<W>; 3],
    /// The reference model at the next sample.
    pub(super) model_rad: Lanes<W>,
    pub(super) model_rad_s: Lanes<W>,
    pub(super) faults: [Faults; W],
}

impl<const W: usize> Memories<W> {
    /// Memories that have seen a sample of zeros and answered it by zeros.
    pub(super) fn at_rest() -> Self {
        Self {
            command_rad: [0.0; W],
            integral: [0.0; W],
            derivative_rad_s: [0.0; W],
            has_previous: [YES; W],
            error_rad: [0.0; W],
            derivative_input_rad: [0.0; W],
            gains: [[0.0; W]; 3],
            model_rad: [0.0; W],
            model_rad_s: [0.0; W],
            faults: [Faults::NONE; W],
        }
    }

    /// The memory of one lane.
    pub(super) fn state(&self, lane: usize) -> State<f64> {
        let [kp, ki, kd] = self.gains.each_ref().map(|gains| gains[lane]);
        State {
            command_rad: self.command_rad[lane],
            integral: self.integral[lane],
            derivative_rad_s: self.derivative_rad_s[lane],
            previous: (self.has_previous[lane] == YES).then(|| Previous {
                error_rad: self.error_rad[lane],
                derivative_input_rad: self.derivative_input_rad[lane],
                gains: Gains { kp, ki, kd },
                model: ModelState {
                    pitch_rad: self.model_rad[lane],
                    rate_rad_s: self.model_rad_s[lane],
                },
            }),
            faults: self.faults[lane],
        }
    }

    /// Puts a memory into a lane.
    pub(super) fn set(&mut self, lane: usize, state: &State<f64>) {
        self.command_rad[lane] = state.command_rad;
        self.integral[lane] = state.integral;
        self.derivative_rad_s[lane] = state.derivative_rad_s;
        self.faults[lane] = state.faults;
        self.has_previous[lane] = NO;
        let Some(Previous { error_rad, derivative_input_rad, gains, model }) = state.previous
        else {
            return;
        };
        self.has_previous[lane] = YES;
        self.error_rad[lane] = error_rad;
        self.derivative_input_rad[lane] = derivative_input_rad;
        (self.model_rad[lane], self.model_rad_s[lane]) = (model.pitch_rad, model.rate_rad_s);
        for (place, gain) in self.gains.iter_mut().zip([gains.kp, gains.ki, gains.kd]) {
            place[lane] = gain;
        }
    }
}
