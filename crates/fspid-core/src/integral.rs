//! The integral of a PID controller: what it remembers, and what keeps it from winding up.

use fspid_numeric::Real;

use crate::controller_setting::ControllerSetting;
use crate::error::{ConfigError, at_least};
use crate::limits::Limits;

/// Form of the integral term: whether its state is the integral of the error or of the gain times the error.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum IntegralForm {
    /// $I_k = I_{k-1} + k_i e_k T$: a new gain bends the integral, the command never jumps.
    #[default]
    Bumpless,
    /// $I_k = k_i \sum e_j T$, as the paper prints it: a change of the gain moves the command at
    /// once by $\Delta k_i \sum e_j T$.
    Literal,
}

/// Anti-windup method: how the integral behaves while the command is saturated.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum AntiWindup<R> {
    /// Nothing: it winds up.
    None,
    /// The integral term is kept within these limits, rad, in the command as in the memory.
    Clamping(Limits<R>),
    /// Its memory stands still while the error would drive a cut command further out.
    Conditional,
    /// Its memory is pulled towards the limit: $I \leftarrow I + (u - u_{free}) T / T_t$; not while
    /// $k_i$ is zero, when nothing winds up and nothing would bring it back.
    ///
    /// The literal form corrects its sum by that over $k_i T$: with a gain that a tuner takes near
    /// zero this is large, and comes back as a jump when the gain does. Prefer the bumpless form.
    BackCalculation {
        /// Tracking time $T_t$, s; at least the sample period, at which one sample corrects all.
        tracking_s: R,
    },
}

impl<R: Real> AntiWindup<R> {
    pub(crate) fn check(&self, dt_s: R) -> Result<(), ConfigError> {
        if let Self::BackCalculation { tracking_s } = *self {
            let allowed = "a finite number, at least the sample period";
            at_least(dt_s, ControllerSetting::TrackingTime, tracking_s, allowed)?;
        }
        Ok(())
    }

    /// True if it does nothing without a limit of the command.
    pub(crate) fn acts_at_limits(&self) -> bool {
        matches!(self, Self::Conditional | Self::BackCalculation { .. })
    }
}
