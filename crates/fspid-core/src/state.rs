//! The result of one controller step, and the state that is carried to the next one.

use fspid_numeric::Real;

use crate::equations::{Memory, PidEquations};
use crate::gains::Gains;
use crate::guard::Faults;
use crate::sample::Sample;
use crate::second_input::ModelState;

/// Outputs of one controller step.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Step<R> {
    /// Command, rad; positive is nose up.
    pub command_rad: R,
    /// Gains used; at a held sample those of the last good one, before the first good one the nominal ones.
    pub gains: Gains<R>,
    /// The command was cut by an output or slew limit.
    pub saturated: bool,
    /// Faults latched so far.
    pub faults: Faults,
}

/// A controller's memory. To start a controller anew, give it a new one.
///
/// Open, so that the memories of many controllers can be kept side by side; a controller writes all
/// of it or nothing.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State<R> {
    /// The last command, rad.
    pub command_rad: R,
    /// The integral of `ki e` (bumpless) or the sum of `e` (literal), rad.
    pub integral: R,
    /// The filtered derivative, rad/s.
    pub derivative_rad_s: R,
    /// The last good sample, `None` before the first.
    pub previous: Option<Previous<R>>,
    /// Faults latched so far.
    pub faults: Faults,
}

/// State kept from the last valid sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Previous<R> {
    /// Its error, rad.
    pub error_rad: R,
    /// What the derivative acts on, rad: $c r - y$.
    pub derivative_input_rad: R,
    /// The gains it was answered with.
    pub gains: Gains<R>,
    /// The reference model at the next sample; zeros for a controller without one.
    pub model: ModelState<R>,
}

impl<R: Real> State<R> {
    /// At rest: no command, empty integral, no previous sample.
    #[must_use]
    pub fn new() -> Self {
        Self {
            command_rad: R::ZERO,
            integral: R::ZERO,
            derivative_rad_s: R::ZERO,
            previous: None,
            faults: Faults::NONE,
        }
    }

    /// Faults latched since the last call, which clears them.
    pub fn take_faults(&mut self) -> Faults {
        self.faults.take()
    }

    /// What the integral remembers: its term in rad (bumpless) or the sum of errors in rad (literal).
    pub fn integral(&self) -> R {
        self.integral
    }

    /// The derivative of the last good sample, rad/s.
    pub fn derivative_rad_s(&self) -> R {
        self.derivative_rad_s
    }

    /// Gains of the last good sample, `None` before the first.
    pub(crate) fn gains(&self) -> Option<Gains<R>> {
        self.previous.map(|previous| previous.gains)
    }

    /// What is remembered, in numbers; `None` before the first good sample.
    #[inline(always)]
    pub fn memory(&self) -> Option<Memory<R>> {
        let Previous { error_rad, derivative_input_rad, gains, model } = self.previous?;
        Some(Memory {
            command_rad: self.command_rad,
            integral: self.integral,
            derivative_rad_s: self.derivative_rad_s,
            error_rad,
            derivative_input_rad,
            kp: gains.kp,
            ki: gains.ki,
            kd: gains.kd,
            model_rad: model.pitch_rad,
            model_rad_s: model.rate_rad_s,
        })
    }

    /// The memory with which these equations answer a sample, the first one too.
    #[inline(always)]
    pub(crate) fn memory_for(
        &self,
        equations: &PidEquations<R>,
        sample: &Sample<R>,
        nominal: &Gains<R>,
    ) -> Memory<R> {
        let Self { command_rad, integral, .. } = *self;
        let first = || Memory { command_rad, integral, ..equations.at_first(sample, nominal) };
        self.memory().unwrap_or_else(first)
    }

    /// What remembers these numbers and faults.
    #[inline(always)]
    pub fn remembering(memory: Memory<R>, faults: Faults) -> Self {
        let Memory { command_rad, integral, derivative_rad_s, .. } = memory;
        let Memory { error_rad, derivative_input_rad, kp, ki, kd, .. } = memory;
        let model = ModelState { pitch_rad: memory.model_rad, rate_rad_s: memory.model_rad_s };
        let gains = Gains { kp, ki, kd };
        let previous = Some(Previous { error_rad, derivative_input_rad, gains, model });
        Self { command_rad, integral, derivative_rad_s, previous, faults }
    }

    pub(crate) fn latch(&mut self, fault: Faults) {
        self.faults.latch(fault);
    }
}

impl<R: Real> Default for State<R> {
    fn default() -> Self {
        Self::new()
    }
}
