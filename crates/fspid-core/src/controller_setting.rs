//! The settings of a controller, as errors name them.

use core::fmt;

/// A setting of a controller that an error is about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum ControllerSetting {
    /// Proportional gain.
    Kp,
    /// Integral gain.
    Ki,
    /// Derivative gain.
    Kd,
    /// Gain of the ISA form.
    Gain,
    /// Integral time of the ISA form.
    IntegralTime,
    /// Derivative time of the ISA form.
    DerivativeTime,
    /// Derivative time over the time constant of its filter, in the ISA form.
    FilterRatio,
    /// Time from sample to sample.
    SamplePeriod,
    /// Gain of the inner loop of pitch rate.
    RateGain,
    /// Set-point weight of the proportional term.
    ProportionalWeight,
    /// Set-point weight of the derivative term.
    DerivativeWeight,
    /// Command per set-point beside the gains.
    Feedforward,
    /// Time constant of the derivative's filter.
    DerivativeFilter,
    /// Lowest and highest command.
    OutputLimits,
    /// Largest rate of the command.
    SlewLimit,
    /// Lowest and highest part of the integral in the command.
    AntiWindupLimits,
    /// Tracking time of back-calculation.
    TrackingTime,
    /// Largest sample that is believed.
    SampleGuard,
    /// Factor of the supervisor's error.
    ErrorScale,
    /// Factor of what the supervisor sees beside the error.
    ChangeScale,
    /// Factor of the increment of the proportional gain.
    OutputScaleKp,
    /// Factor of the increment of the integral gain.
    OutputScaleKi,
    /// Factor of the increment of the derivative gain.
    OutputScaleKd,
    /// Centre of the small sets of an input.
    SmallSets,
    /// Centre of the medium sets of an input.
    MediumSets,
    /// Natural frequency of the reference model.
    ModelBandwidth,
    /// Damping of the reference model.
    ModelDamping,
    /// How far the set-point weight moves with the proportional gain.
    WeightPerKp,
    /// How far the rate gain moves with the derivative gain.
    RateGainPerKd,
    /// How fast accumulated gains return to nominal.
    Leakage,
    /// Error up to which the supervisor stays silent.
    ErrorDeadZone,
    /// Change up to which the supervisor stays silent.
    ChangeDeadZone,
    /// Lowest and highest total of a gain.
    GainLimits,
    /// Nominal proportional gain, within its limits.
    NominalKp,
    /// Nominal integral gain, within its limits.
    NominalKi,
    /// Nominal derivative gain, within its limits.
    NominalKd,
}

impl ControllerSetting {
    /// What it is called in sentences, with its unit.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Kp => "kp",
            Self::Ki => "ki",
            Self::Kd => "kd",
            Self::Gain => "gain K",
            Self::IntegralTime => "Ti, s",
            Self::DerivativeTime => "Td, s",
            Self::FilterRatio => "N",
            Self::SamplePeriod => "sample period, s",
            Self::RateGain => "rate_gain, s",
            Self::ProportionalWeight => "set-point weight of the proportional term",
            Self::DerivativeWeight => "set-point weight of the derivative term",
            Self::Feedforward => "command per set-point that is fed forward",
            Self::DerivativeFilter => "derivative filter, s",
            Self::OutputLimits => "output limits",
            Self::SlewLimit => "slew limit, rad/s",
            Self::AntiWindupLimits => "anti-windup limits",
            Self::TrackingTime => "anti-windup tracking time, s",
            Self::SampleGuard => "sample guard, rad",
            Self::ErrorScale => "error_scale",
            Self::ChangeScale => "change_scale",
            Self::OutputScaleKp => "output_scale kp",
            Self::OutputScaleKi => "output_scale ki",
            Self::OutputScaleKd => "output_scale kd",
            Self::SmallSets => "centre of the small sets",
            Self::MediumSets => "centre of the medium sets",
            Self::ModelBandwidth => "bandwidth of the reference model, rad/s",
            Self::ModelDamping => "damping of the reference model",
            Self::WeightPerKp => "set-point weight per kp",
            Self::RateGainPerKd => "rate_gain per kd",
            Self::Leakage => "leakage, 1/s",
            Self::ErrorDeadZone => "dead zone of the error",
            Self::ChangeDeadZone => "dead zone of the change",
            Self::GainLimits => "gain limits",
            Self::NominalKp => "nominal kp",
            Self::NominalKi => "nominal ki",
            Self::NominalKd => "nominal kd",
        }
    }
}

impl fmt::Display for ControllerSetting {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}
