//! The self-tuning law: gains from the nominal ones and the supervisor's increments, memoryless or accumulated.

use fspid_fuzzy::Supervisor;
use fspid_numeric::Real;

use crate::controller_setting::ControllerSetting;
use crate::equations::{Memory, TunerEquations};
use crate::error::{ConfigError, allowed_if, finite, not_negative};
use crate::gains::{GainLimits, Gains};
use crate::guard::Faults;
use crate::sample::Sample;
use crate::second_input::{SecondInput, SetCentres};

/// Which difference the supervisor sees as its error.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ErrorSign {
    /// $e = r - y$, as the PID itself.
    #[default]
    SetpointMinusMeasurement,
    /// $e = y - r$: a large error on a positive step then raises `kp` in the paper's Table 3.
    MeasurementMinusSetpoint,
}

/// Definition of the supervisor's change-of-error input.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Change {
    /// Rate: $(e_k - e_{k-1}) / T$.
    #[default]
    Rate,
    /// Difference per sample, $e_k - e_{k-1}$, as the paper's $EC(k)$.
    Delta,
}

/// How the supervisor's increments become gains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Law<R> {
    /// $k = k' + s \Delta k$: equation (1) of the paper with its misprint mended.
    Memoryless,
    /// $k_j = k_{j-1} + s \Delta k T - \lambda (k_{j-1} - k') T$ from $k'$: common in the literature
    /// that the paper cites. The leakage $\lambda$ [1/s] pulls the gains back; 0 for none, at most
    /// $1/T$.
    Accumulating {
        /// Leakage, 1/s.
        leakage_per_s: R,
    },
}

impl<R> Law<R> {
    /// Name in files.
    #[must_use]
    pub const fn name(&self) -> &'static str {
        match self {
            Self::Memoryless => "memoryless",
            Self::Accumulating { .. } => "accumulating",
        }
    }
}

/// Factors before the supervisor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InputScale<R> {
    /// Supervisor units per radian of error.
    pub error_per_rad: R,
    /// Supervisor units per rad/s (or per rad and sample) of change, or of the other [`SecondInput`], in
    /// the place of the change.
    pub change_per_rad: R,
}

/// Errors so small that the supervisor stays silent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DeadZone<R> {
    /// Error, rad.
    pub error_rad: R,
    /// Change of error, rad/s (or rad per sample).
    pub change_rad: R,
}

/// What else moves with the gains, by how much per unit of their distance from nominal:
///
/// $$ b = b' + s_b (k_p - k_p'), \qquad k_r = k_r' + s_r (k_d - k_d') $$
///
/// Nothing new has to be remembered, and the limits of the gains bound both. The derivative and the rate
/// loop act alike, but the gyro has less noise than a difference of angles: with a small $k_d$ and a
/// large $s_r$ the rules for $k_d$ move the rate loop.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GainCoupling<R> {
    /// $s_b$, of the set-point weight in the proportional term.
    pub setpoint_weight: R,
    /// $s_r$, of the gain of the pitch-rate loop.
    pub rate_gain: R,
}

impl<R: Real> GainCoupling<R> {
    /// Nothing follows.
    pub const NONE: Self = Self { setpoint_weight: R::ZERO, rate_gain: R::ZERO };
}

/// Where the sets of the supervisor's inputs lie; evenly where nothing is said.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct InputSets<R> {
    /// Of the error.
    pub error: Option<SetCentres<R>>,
    /// Of the change, or whatever is seen in its place.
    pub change: Option<SetCentres<R>>,
}

impl<R: Real> InputSets<R> {
    /// Even sets.
    pub const EVEN: Self = Self { error: None, change: None };

    /// True if both are even.
    pub fn are_even(&self) -> bool {
        self.error.is_none() && self.change.is_none()
    }
}

/// Everything about a self-tuner but its rules and its nominal gains.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TunerSettings<R> {
    /// Sign of the supervisor's error and its change.
    pub error_sign: ErrorSign,
    /// What the supervisor sees beside the error.
    pub second_input: SecondInput<R>,
    /// Rate or difference, where it sees the change.
    pub change: Change,
    /// Factors before the supervisor.
    pub input_scale: InputScale<R>,
    /// Where the sets of its inputs lie.
    pub input_sets: InputSets<R>,
    /// Factors behind the supervisor, gain by gain.
    pub output_scale: Gains<R>,
    /// What else moves with the gains.
    pub gain_coupling: GainCoupling<R>,
    /// Memoryless or accumulating.
    pub law: Law<R>,
    /// Bounds of the total gains.
    pub gain_limits: Option<GainLimits<R>>,
    /// Where the increments are taken as zero: both error and change must be inside.
    pub dead_zone: Option<DeadZone<R>>,
}

impl<R: Real> TunerSettings<R> {
    /// No factors but 1, no limits, equation (1).
    pub fn literal() -> Self {
        Self {
            error_sign: ErrorSign::default(),
            second_input: SecondInput::Change,
            change: Change::default(),
            input_scale: InputScale { error_per_rad: R::ONE, change_per_rad: R::ONE },
            input_sets: InputSets::EVEN,
            output_scale: Gains { kp: R::ONE, ki: R::ONE, kd: R::ONE },
            gain_coupling: GainCoupling::NONE,
            law: Law::Memoryless,
            gain_limits: None,
            dead_zone: None,
        }
    }

    fn check(&self) -> Result<(), ConfigError> {
        finite(ControllerSetting::ErrorScale, self.input_scale.error_per_rad)?;
        finite(ControllerSetting::ChangeScale, self.input_scale.change_per_rad)?;
        finite(ControllerSetting::OutputScaleKp, self.output_scale.kp)?;
        finite(ControllerSetting::OutputScaleKi, self.output_scale.ki)?;
        finite(ControllerSetting::OutputScaleKd, self.output_scale.kd)?;
        finite(ControllerSetting::WeightPerKp, self.gain_coupling.setpoint_weight)?;
        finite(ControllerSetting::RateGainPerKd, self.gain_coupling.rate_gain)?;
        if let Law::Accumulating { leakage_per_s } = self.law {
            not_negative(ControllerSetting::Leakage, leakage_per_s)?;
        }
        if let Some(zone) = self.dead_zone {
            not_negative(ControllerSetting::ErrorDeadZone, zone.error_rad)?;
            not_negative(ControllerSetting::ChangeDeadZone, zone.change_rad)?;
        }
        Ok(())
    }

    /// True where a change of the error is what the supervisor sees, its sets are even and nothing but
    /// the gains moves: the structure that flights in sets and gains along a trajectory are written for.
    pub fn is_plain(&self) -> bool {
        // In full, so that somebody says of a new setting whether it is plain.
        let Self {
            error_sign: _,
            second_input,
            change: _,
            input_scale: _,
            input_sets,
            output_scale: _,
            gain_coupling,
            law: _,
            gain_limits: _,
            dead_zone: _,
        } = self;
        *second_input == SecondInput::Change
            && input_sets.are_even()
            && *gain_coupling == GainCoupling::NONE
    }
}

const NETWORK_HAS_NO_SETS: &str = "the supervisor is a network, which has no sets: error_set_centres and change_set_centres must be left out";

/// The gains of the moment from error and change of error.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SelfTuner<R> {
    nominal: Gains<R>,
    supervisor: Supervisor<R>,
    settings: TunerSettings<R>,
}

impl<R: Real> SelfTuner<R> {
    /// A tuner around `nominal` gains.
    ///
    /// # Errors
    /// [`ConfigError`] for a gain or factor that is not finite, a negative dead zone or leakage,
    /// nominal gains outside the gain limits, and uneven sets before a network.
    pub fn new(
        nominal: Gains<R>,
        supervisor: Supervisor<R>,
        settings: TunerSettings<R>,
    ) -> Result<Self, ConfigError> {
        settings.check()?;
        if supervisor.network().is_some() && !settings.input_sets.are_even() {
            return Err(ConfigError::Conflict { what: NETWORK_HAS_NO_SETS });
        }
        let nominal = nominal.checked()?;
        if let Some(limits) = settings.gain_limits {
            limits.check(nominal)?;
        }
        Ok(Self { nominal, supervisor, settings })
    }

    /// The parts of a tuner that was built, as a constant; nothing is checked.
    #[must_use]
    pub const fn new_unchecked(
        nominal: Gains<R>,
        supervisor: Supervisor<R>,
        settings: TunerSettings<R>,
    ) -> Self {
        Self { nominal, supervisor, settings }
    }

    /// The nominal gains $k'$.
    pub fn nominal(&self) -> Gains<R> {
        self.nominal
    }

    /// Everything but the rules and the nominal gains.
    pub fn settings(&self) -> &TunerSettings<R> {
        &self.settings
    }

    /// True for [plain](TunerSettings::is_plain) settings around rules that conclude labels.
    pub fn is_plain(&self) -> bool {
        self.settings.is_plain() && self.supervisor.has_labels()
    }

    /// The rules.
    pub fn supervisor(&self) -> &Supervisor<R> {
        &self.supervisor
    }

    /// Refuses a leakage that would overshoot within one sample, and a reference model too fast for it.
    pub(crate) fn check_period(&self, dt_s: R) -> Result<(), ConfigError> {
        if let SecondInput::ModelError(model) = self.settings.second_input {
            model.check(dt_s)?;
        }
        if let Law::Accumulating { leakage_per_s } = self.settings.law {
            let good = leakage_per_s * dt_s <= R::ONE;
            let allowed = "at most one per sample period";
            allowed_if(good, ControllerSetting::Leakage, leakage_per_s, allowed)?;
        }
        Ok(())
    }

    /// Scaled increments $s \Delta k$ for an error and what is seen beside it, as the loop has them.
    #[inline(always)]
    fn increments(
        &self,
        equations: &TunerEquations<R>,
        error_rad: R,
        second_rad: R,
    ) -> Result<(Gains<R>, Faults), Faults> {
        if equations.is_silent(error_rad, second_rad) {
            return Ok((Gains::ZERO, Faults::NONE));
        }
        let [error, second] = equations.seen(error_rad, second_rad);
        if !(error.is_finite() && second.is_finite()) {
            return Err(Faults::OVERFLOW);
        }
        self.inferred(error, second)
    }

    /// Scaled increments for inputs as the supervisor sees them.
    #[inline(always)]
    fn inferred(&self, error: R, change: R) -> Result<(Gains<R>, Faults), Faults> {
        let (error, change) = self.warp(error, change);
        let Ok(inference) = self.supervisor.infer(error, change) else {
            return Err(Faults::OUT_OF_RANGE);
        };
        let fault = if inference.underflowed { Faults::UNDERFLOW } else { Faults::NONE };
        let delta = Gains::from(inference.delta);
        Ok((self.settings.output_scale.zip(delta, |s, d| s * d), fault))
    }

    /// Both inputs as the even sets see them.
    #[inline(always)]
    fn warp(&self, error: R, change: R) -> (R, R) {
        let (sets, range) = (self.settings.input_sets, self.supervisor.range());
        let warp = |places: Option<SetCentres<R>>, input| {
            places.map_or(input, |places| places.warp(input, range))
        };
        (warp(sets.error, error), warp(sets.change, change))
    }

    /// Scaled increments $s \Delta k$ where the supervisor sees `error` and `change`, in its own units
    /// and with its sign, outside of any dead zone; `None` for inputs that it refuses.
    pub fn increments_where_seen(&self, error: R, change: R) -> Option<Gains<R>> {
        self.inferred(error, change).ok().map(|(increments, _)| increments)
    }

    /// The gains of a sample; with them a fault to latch. A supervisor that refuses the input leaves the
    /// gains as they were.
    ///
    /// # Errors
    /// [`Faults::OVERFLOW`] where there are none.
    #[inline(always)]
    pub(crate) fn gains(
        &self,
        equations: &TunerEquations<R>,
        memory: &Memory<R>,
        sample: &Sample<R>,
    ) -> Result<(Gains<R>, Faults), Faults> {
        self.gains_where(equations, memory, equations.inputs(memory, sample))
    }

    /// The same where the loop has this error and this beside it.
    ///
    /// # Errors
    /// As [`gains`](Self::gains).
    #[inline(always)]
    pub(crate) fn gains_where(
        &self,
        equations: &TunerEquations<R>,
        memory: &Memory<R>,
        [error_rad, second_rad]: [R; 2],
    ) -> Result<(Gains<R>, Faults), Faults> {
        let before = Gains { kp: memory.kp, ki: memory.ki, kd: memory.kd };
        let (scaled, fault) = match self.increments(equations, error_rad, second_rad) {
            Err(Faults::OUT_OF_RANGE) => return Ok((before, Faults::OUT_OF_RANGE)),
            answer => answer?,
        };
        let [kp, ki, kd] = &equations.gains;
        let free = Gains {
            kp: equations.free_gain(kp, before.kp, scaled.kp),
            ki: equations.free_gain(ki, before.ki, scaled.ki),
            kd: equations.free_gain(kd, before.kd, scaled.kd),
        };
        if !free.are_finite() {
            return Err(Faults::OVERFLOW);
        }
        let limited =
            Gains { kp: kp.limited(free.kp), ki: ki.limited(free.ki), kd: kd.limited(free.kd) };
        Ok((limited, fault))
    }

    /// The gains at rest, e = 0 and no change: nominal plus what the rules add at the origin.
    ///
    /// Under the accumulating law this is where the first second at rest takes the gains if nothing
    /// leaks; with a leakage they settle at $k' + s \Delta k / \lambda$.
    pub fn gains_at_rest(&self) -> Gains<R> {
        // The origin is within every range, so there always is an answer.
        let equations = TunerEquations::new(&self.settings, self.nominal, R::ONE);
        let added = self.increments(&equations, R::ZERO, R::ZERO);
        let (added, _) = added.unwrap_or((Gains::ZERO, Faults::NONE));
        let gains = self.nominal.zip(added, |nominal, delta| nominal + delta);
        self.settings.gain_limits.map_or(gains, |limits| limits.apply(gains))
    }

    /// True if the supervisor sees the measured pitch rate.
    pub fn sees_rate(&self) -> bool {
        self.settings.second_input == SecondInput::Rate
    }
}
