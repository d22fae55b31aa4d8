//! The integral of a PID controller: what it remembers, and what keeps it from winding up.

use fspid_numeric::Real;

use crate::error::{ConfigError, at_least};
use crate::limits::Limits;

/// What the integral remembers when its gain changes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum IntegralForm {
    /// $I_k = I_{k-1} + k_i e_k T$: a new gain bends the integral, the command never jumps.
    #[default]
    Bumpless,
    /// $I_k = k_i \sum e_j T$, as the paper prints it: a change of the gain moves the command at
    /// once by $\Delta k_i \sum e_j T$.
    Literal,
}

/// What happens to the integral while the command is cut.
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
            at_least(dt_s, "anti-windup tracking time, s", tracking_s, allowed)?;
        }
        Ok(())
    }

    /// True if it does nothing without a limit of the command.
    pub(crate) fn acts_at_limits(&self) -> bool {
        matches!(self, Self::Conditional | Self::BackCalculation { .. })
    }
}

/// The integral at one sample. Its memory is $I$ in rad (bumpless) or $\sum e$ in rad (literal).
#[derive(Clone, Copy, Debug)]
pub(crate) struct Integrator<R> {
    pub(crate) form: IntegralForm,
    pub(crate) anti_windup: AntiWindup<R>,
    pub(crate) dt_s: R,
    pub(crate) ki: R,
}

impl<R: Real> Integrator<R> {
    /// The memory with this sample's error in it.
    pub(crate) fn wound(&self, memory: R, error_rad: R) -> R {
        match self.form {
            IntegralForm::Bumpless => memory + self.ki * error_rad * self.dt_s,
            IntegralForm::Literal => memory + error_rad,
        }
    }

    /// The integral's term of the command, rad.
    pub(crate) fn term_rad(&self, memory: R) -> R {
        let term_rad = self.unclamped_rad(memory);
        match self.anti_windup {
            AntiWindup::Clamping(limits) => limits.clamp(term_rad),
            _ => term_rad,
        }
    }

    /// The memory to keep: `wound` after anti-windup. `before` is the memory of the last sample,
    /// `excess_rad` how much of the command was cut off.
    pub(crate) fn unwound(&self, before: R, wound: R, excess_rad: R, error_rad: R) -> R {
        match self.anti_windup {
            AntiWindup::None => wound,
            AntiWindup::Clamping(limits) => {
                let term_rad = self.unclamped_rad(wound);
                let kept_rad = limits.clamp(term_rad);
                if kept_rad == term_rad {
                    return wound;
                }
                self.memory_of(kept_rad).unwrap_or(wound)
            }
            AntiWindup::Conditional => {
                // Signs, not a product: that of two small numbers underflows to zero.
                let drive = self.ki * error_rad;
                let further_out = (excess_rad > R::ZERO && drive > R::ZERO)
                    || (excess_rad < R::ZERO && drive < R::ZERO);
                if further_out { before } else { wound }
            }
            AntiWindup::BackCalculation { .. } if self.ki == R::ZERO => wound,
            AntiWindup::BackCalculation { tracking_s } => self
                .memory_of(excess_rad * self.dt_s / tracking_s)
                .map_or(wound, |shift| wound - shift),
        }
    }

    fn unclamped_rad(&self, memory: R) -> R {
        match self.form {
            IntegralForm::Bumpless => memory,
            IntegralForm::Literal => self.ki * memory * self.dt_s,
        }
    }

    /// What has to be remembered for a term of `term_rad`; `None` where the gain is too small for
    /// any sum to make that term.
    fn memory_of(&self, term_rad: R) -> Option<R> {
        let memory = match self.form {
            IntegralForm::Bumpless => term_rad,
            IntegralForm::Literal => term_rad / (self.ki * self.dt_s),
        };
        memory.is_finite().then_some(memory)
    }
}
