//! The self-tuning equations of one sample: scaling of the supervisor's inputs, and gains from its increments.

use fspid_numeric::{Real, Scalar};

use super::{Memory, ends, limited, numbers};
use crate::gains::Gains;
use crate::sample::Sample;
use crate::second_input::{ModelState, ReferenceModel, SecondInput};
use crate::tuner::{Change, ErrorSign, Law, TunerSettings};

/// [`SecondInput`] without its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SecondInputKind {
    /// The change of the error.
    Change,
    /// The pitch rate, its sign turned.
    Rate,
    /// How far the pitch is behind a model.
    ModelError,
}

/// [`Law`] without its numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum LawKind {
    /// From the nominal gains.
    Memoryless,
    /// From the gains before.
    Accumulating,
}

/// Which equations a self-tuner has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TunerStructure {
    /// What the supervisor sees beside the error.
    pub second_input: SecondInputKind,
    /// How increments become gains.
    pub law: LawKind,
}

impl TunerStructure {
    fn of<R>(second_input: SecondInput<R>, law: Law<R>) -> Self {
        let second_input = match second_input {
            SecondInput::Change => SecondInputKind::Change,
            SecondInput::Rate => SecondInputKind::Rate,
            SecondInput::ModelError(_) => SecondInputKind::ModelError,
        };
        let law = match law {
            Law::Memoryless => LawKind::Memoryless,
            Law::Accumulating { .. } => LawKind::Accumulating,
        };
        Self { second_input, law }
    }
}

numbers! {
    /// The numbers in the equations of a self-tuner.
    TunerNumbers:
    /// Sample period, s.
    dt_s,
    /// 1 or -1.
    sign,
    /// Supervisor units per radian of error.
    error_per_rad,
    /// Supervisor units per unit of what is seen beside it.
    change_per_rad,
    /// The difference of the error over this is its change: the sample period or 1.
    change_divisor,
    /// Half width of the dead zone in the error; below zero without one.
    zone_error_rad,
    /// Half width of the dead zone in what is seen beside it.
    zone_change_rad,
    /// Of accumulating gains, 1/s.
    leakage_per_s,
    /// Of the reference model, rad/s.
    bandwidth_rad_s,
    /// Of the reference model.
    damping,
}

numbers! {
    /// The numbers in the equations of one gain.
    GainNumbers:
    /// Nominal value.
    nominal,
    /// Factor behind the supervisor.
    scale,
    /// Lower limit.
    lower,
    /// Upper limit.
    upper,
}

/// A self-tuner as equations, but for its rules and the places of its sets.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TunerEquations<S> {
    /// Which.
    pub structure: TunerStructure,
    /// The numbers in them.
    pub numbers: TunerNumbers<S>,
    /// Those of `kp`, `ki`, `kd`.
    pub gains: [GainNumbers<S>; 3],
}

impl<R: Real> TunerEquations<R> {
    /// The equations of settings around nominal gains; nothing is checked.
    pub fn new(settings: &TunerSettings<R>, nominal: Gains<R>, dt_s: R) -> Self {
        // In full, so that a new option does not compile until an equation has it.
        let TunerSettings {
            error_sign,
            second_input,
            change,
            input_scale,
            input_sets: _,
            output_scale,
            gain_coupling: _,
            law,
            gain_limits: _,
            dead_zone,
        } = *settings;
        let zone = dead_zone.map(|zone| (zone.error_rad, zone.change_rad));
        let (zone_error_rad, zone_change_rad) = zone.unwrap_or((-R::ONE, -R::ONE));
        let (bandwidth_rad_s, damping) = match second_input {
            SecondInput::ModelError(model) => (model.bandwidth_rad_s, model.damping),
            SecondInput::Change | SecondInput::Rate => (R::ZERO, R::ZERO),
        };
        let leakage_per_s = match law {
            Law::Accumulating { leakage_per_s } => leakage_per_s,
            Law::Memoryless => R::ZERO,
        };
        let numbers = TunerNumbers {
            dt_s,
            sign: match error_sign {
                ErrorSign::SetpointMinusMeasurement => R::ONE,
                ErrorSign::MeasurementMinusSetpoint => -R::ONE,
            },
            error_per_rad: input_scale.error_per_rad,
            change_per_rad: input_scale.change_per_rad,
            change_divisor: match change {
                Change::Rate => dt_s,
                Change::Delta => R::ONE,
            },
            zone_error_rad,
            zone_change_rad,
            leakage_per_s,
            bandwidth_rad_s,
            damping,
        };
        let structure = TunerStructure::of(second_input, law);
        Self { structure, numbers, gains: gain_numbers(settings, nominal, output_scale) }
    }

    /// The same equations for numbers of another kind.
    pub fn lifted<S: Scalar>(&self) -> TunerEquations<S> {
        let constant = |number: &R| S::constant(number.to_f64());
        TunerEquations {
            structure: self.structure,
            numbers: self.numbers.map(constant),
            gains: self.gains.map(|gain| gain.map(constant)),
        }
    }

    /// True where the supervisor stays silent: both are within the dead zone.
    #[inline(always)]
    pub fn is_silent(&self, error_rad: R, second_rad: R) -> bool {
        let n = &self.numbers;
        (error_rad.abs() <= n.zone_error_rad) & (second_rad.abs() <= n.zone_change_rad)
    }
}

fn gain_numbers<R: Real>(
    settings: &TunerSettings<R>,
    nominal: Gains<R>,
    scale: Gains<R>,
) -> [GainNumbers<R>; 3] {
    let (kp, ki, kd) = settings
        .gain_limits
        .map_or((None, None, None), |limits| (Some(limits.kp), Some(limits.ki), Some(limits.kd)));
    let of = |nominal, scale, limits| {
        let (lower, upper) = ends(limits);
        GainNumbers { nominal, scale, lower, upper }
    };
    [of(nominal.kp, scale.kp, kp), of(nominal.ki, scale.ki, ki), of(nominal.kd, scale.kd, kd)]
}

impl<S: Scalar> TunerEquations<S> {
    /// What is seen beside the error, in rad or rad/s.
    #[inline(always)]
    pub fn second_rad(&self, memory: &Memory<S>, sample: &Sample<S>) -> S {
        match self.structure.second_input {
            SecondInputKind::Change => {
                let error_rad = sample.setpoint_rad - sample.measurement_rad;
                (error_rad - memory.error_rad) / self.numbers.change_divisor
            }
            SecondInputKind::Rate => -sample.rate_rad_s,
            SecondInputKind::ModelError => memory.model_rad - sample.measurement_rad,
        }
    }

    /// The error, rad, and what is seen beside it.
    #[inline(always)]
    pub fn inputs(&self, memory: &Memory<S>, sample: &Sample<S>) -> [S; 2] {
        [sample.setpoint_rad - sample.measurement_rad, self.second_rad(memory, sample)]
    }

    /// Both as the supervisor sees them, with its sign and in its units.
    #[inline(always)]
    pub fn seen(&self, error_rad: S, second_rad: S) -> [S; 2] {
        let n = &self.numbers;
        [n.sign * (n.error_per_rad * error_rad), n.sign * (n.change_per_rad * second_rad)]
    }

    /// Where the reference model is at the next sample; zeros without one.
    #[inline(always)]
    pub fn next_model(&self, memory: &Memory<S>, sample: &Sample<S>) -> ModelState<S> {
        let n = &self.numbers;
        match self.structure.second_input {
            SecondInputKind::Change | SecondInputKind::Rate => {
                ModelState { pitch_rad: S::zero(), rate_rad_s: S::zero() }
            }
            SecondInputKind::ModelError => {
                let (bandwidth_rad_s, damping) = (n.bandwidth_rad_s, n.damping);
                let now =
                    ModelState { pitch_rad: memory.model_rad, rate_rad_s: memory.model_rad_s };
                let model = ReferenceModel { bandwidth_rad_s, damping };
                model.next(now, sample.setpoint_rad, n.dt_s)
            }
        }
    }

    /// A gain before its limits, from what the supervisor adds, scaled: $k' + s \Delta k$ or
    /// $k_{j-1} + (s \Delta k - \lambda (k_{j-1} - k')) T$.
    #[inline(always)]
    pub fn free_gain(&self, gain: &GainNumbers<S>, before: S, scaled: S) -> S {
        match self.structure.law {
            LawKind::Memoryless => gain.nominal + scaled,
            LawKind::Accumulating => {
                let pull = self.numbers.leakage_per_s * (before - gain.nominal);
                before + (scaled - pull) * self.numbers.dt_s
            }
        }
    }
}

impl<S: Scalar> GainNumbers<S> {
    /// A gain moved into its limits.
    #[inline(always)]
    pub fn limited(&self, free: S) -> S {
        limited(free, self.lower, self.upper)
    }
}
