//! The parts of a loop model kept apart (plant, delays, controller), for analyses in which the loop is not affine in the
//! gains.

use fspid_core::Gains;

use super::assembly::OpenLoop;
use super::{BreakPoint, LoopModel};

/// A loop broken at the command.
#[derive(Clone, Debug)]
pub(crate) struct LoopParts {
    /// Next state by state with the command at zero.
    pub(crate) matrix: Vec<Vec<f64>>,
    /// Next state by command.
    pub(crate) by_command: Vec<f64>,
    /// Seen pitch and seen rate by state.
    pub(crate) pitch: Vec<f64>,
    pub(crate) rate: Vec<f64>,
    /// Where the controller's memory stands in the state.
    pub(crate) integral: Option<usize>,
    pub(crate) derivative: Option<usize>,
    pub(crate) previous: Option<usize>,
}

impl LoopModel<f64> {
    pub(crate) fn parts(&self, gains: Gains<f64>) -> LoopParts {
        let assembly = self.assembly(gains);
        let OpenLoop { matrix, entry, .. } = assembly.broken(BreakPoint::Command);
        let layout = &assembly.layout;
        LoopParts {
            matrix,
            by_command: entry,
            pitch: assembly.broken(BreakPoint::Pitch).exit,
            rate: assembly.broken(BreakPoint::Rate).exit,
            integral: layout.integral,
            derivative: layout.derivative,
            previous: layout.previous,
        }
    }
}
