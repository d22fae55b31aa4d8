//! The same controller in another precision.

use fspid_fuzzy::{Network, NumberTable, Output, Supervisor};
use fspid_numeric::Real;

use crate::controller::Controller;
use crate::controller_setting::ControllerSetting;
use crate::error::ConfigError;
use crate::gains::{GainLimits, Gains};
use crate::guard::Guard;
use crate::integral::AntiWindup;
use crate::limits::Limits;
use crate::pid::{Fspid, Pid};
use crate::pid_config::{Derivative, PidConfig, SetpointWeights};
use crate::second_input::{ReferenceModel, SecondInput, SetCentres};
use crate::tuner::{DeadZone, GainCoupling, InputScale, InputSets, Law, SelfTuner, TunerSettings};

impl<R: Real> Controller<R> {
    /// The same controller with every setting rounded to another precision.
    ///
    /// # Errors
    /// [`ConfigError`] where a rounded setting is not allowed: an infinite one, or a positive one that became zero.
    pub fn rounded<S: Real>(&self) -> Result<Controller<S>, ConfigError> {
        match self {
            Self::Fixed(pid) => {
                Ok(Controller::Fixed(Pid::new(gains(pid.gains()), config(pid.config())?)?))
            }
            Self::SelfTuning(fspid) => {
                let fspid = Fspid::new(tuner(fspid.tuner())?, config(fspid.config())?)?;
                Ok(Controller::SelfTuning(fspid))
            }
        }
    }
}

fn real<R: Real, S: Real>(value: R) -> S {
    S::from_f64(value.to_f64())
}

fn gains<R: Real, S: Real>(Gains { kp, ki, kd }: Gains<R>) -> Gains<S> {
    Gains { kp: real(kp), ki: real(ki), kd: real(kd) }
}

fn limits<R: Real, S: Real>(
    what: ControllerSetting,
    limits: Limits<R>,
) -> Result<Limits<S>, ConfigError> {
    Limits::new(what, real(limits.lower()), real(limits.upper()))
}

// All structs are taken apart in full, so that a new option does not compile until it is exported.

fn config<R: Real, S: Real>(config: &PidConfig<R>) -> Result<PidConfig<S>, ConfigError> {
    let PidConfig {
        dt_s,
        rate_gain_s,
        setpoint_weights: SetpointWeights { proportional, derivative: of_derivative },
        feedforward,
        derivative: Derivative { filter_s },
        integral,
        anti_windup,
        limits: of_command,
        slew_rad_s,
        guard,
    } = *config;
    let anti_windup = match anti_windup {
        AntiWindup::None => AntiWindup::None,
        AntiWindup::Clamping(of_term) => {
            AntiWindup::Clamping(limits(ControllerSetting::AntiWindupLimits, of_term)?)
        }
        AntiWindup::Conditional => AntiWindup::Conditional,
        AntiWindup::BackCalculation { tracking_s } => {
            AntiWindup::BackCalculation { tracking_s: real(tracking_s) }
        }
    };
    Ok(PidConfig {
        dt_s: real(dt_s),
        rate_gain_s: real(rate_gain_s),
        setpoint_weights: SetpointWeights {
            proportional: real(proportional),
            derivative: real(of_derivative),
        },
        feedforward: real(feedforward),
        derivative: Derivative { filter_s: real(filter_s) },
        integral,
        anti_windup,
        limits: of_command.map(|it| limits(ControllerSetting::OutputLimits, it)).transpose()?,
        slew_rad_s: slew_rad_s.map(real),
        guard: Guard::new(real(guard.limit_rad()))?,
    })
}

fn tuner<R: Real, S: Real>(tuner: &SelfTuner<R>) -> Result<SelfTuner<S>, ConfigError> {
    let TunerSettings {
        error_sign,
        second_input,
        change,
        input_scale: InputScale { error_per_rad, change_per_rad },
        input_sets: InputSets { error, change: of_change },
        output_scale,
        gain_coupling: GainCoupling { setpoint_weight, rate_gain },
        law,
        gain_limits,
        dead_zone,
    } = *tuner.settings();
    let settings = TunerSettings {
        error_sign,
        second_input: match second_input {
            SecondInput::Change => SecondInput::Change,
            SecondInput::Rate => SecondInput::Rate,
            SecondInput::ModelError(ReferenceModel { bandwidth_rad_s, damping }) => {
                let (bandwidth_rad_s, damping) = (real(bandwidth_rad_s), real(damping));
                SecondInput::ModelError(ReferenceModel { bandwidth_rad_s, damping })
            }
        },
        change,
        input_scale: InputScale {
            error_per_rad: real(error_per_rad),
            change_per_rad: real(change_per_rad),
        },
        input_sets: InputSets {
            error: error.map(centres).transpose()?,
            change: of_change.map(centres).transpose()?,
        },
        output_scale: gains(output_scale),
        gain_coupling: GainCoupling {
            setpoint_weight: real(setpoint_weight),
            rate_gain: real(rate_gain),
        },
        law: match law {
            Law::Memoryless => Law::Memoryless,
            Law::Accumulating { leakage_per_s } => {
                Law::Accumulating { leakage_per_s: real(leakage_per_s) }
            }
        },
        gain_limits: gain_limits.map(of_gains).transpose()?,
        dead_zone: dead_zone.map(|DeadZone { error_rad, change_rad }| DeadZone {
            error_rad: real(error_rad),
            change_rad: real(change_rad),
        }),
    };
    SelfTuner::new(gains(tuner.nominal()), supervisor(tuner.supervisor())?, settings)
}

fn centres<R: Real, S: Real>(centres: SetCentres<R>) -> Result<SetCentres<S>, ConfigError> {
    SetCentres::new(real(centres.small()), real(centres.medium()))
}

fn of_gains<R: Real, S: Real>(
    GainLimits { kp, ki, kd }: GainLimits<R>,
) -> Result<GainLimits<S>, ConfigError> {
    let rounded = |of| limits(ControllerSetting::GainLimits, of);
    Ok(GainLimits { kp: rounded(kp)?, ki: rounded(ki)?, kd: rounded(kd)? })
}

fn supervisor<R: Real, S: Real>(from: &Supervisor<R>) -> Result<Supervisor<S>, ConfigError> {
    let (range, policy) = (real(from.range()), from.out_of_range());
    if let Some(network) = from.network() {
        let network = Network::new(network.rows().map(|row| row.map(real)))?;
        return Ok(Supervisor::of_network(&network, range, policy)?);
    }
    let built = match (from.numbers(), from.table()) {
        (None, table) => {
            // Rules that conclude no numbers conclude labels.
            let table = table.unwrap_or_else(crate::paper::rules);
            Supervisor::new(&table, range, from.defuzzifier(), policy)
        }
        (Some(numbers), _) => {
            let grids = Output::ALL.map(|output| numbers.grid(output).map(|row| row.map(real)));
            NumberTable::new(grids)
                .and_then(|numbers| Supervisor::of_numbers(&numbers, range, policy))
        }
    };
    Ok(built?)
}
