//! A controller that differs in every number that an importer may set, and in no other.

use fspid_core::{
    AntiWindup, Controller, ControllerSetting, DeadZone, Derivative, Fspid, GainCoupling,
    GainLimits, Gains, Guard, InputScale, InputSets, Law, Limits, Pid, PidConfig, ReferenceModel,
    SecondInput, SelfTuner, SetCentres, SetpointWeights, TunerSettings,
};

const LESS: f64 = 0.93;

/// Another controller with the same structure, sample period, rules and sets.
pub(crate) fn moved(controller: &Controller<f64>) -> Controller<f64> {
    match controller {
        Controller::Fixed(fixed) => {
            let nominal = gains(controller.nominal());
            Controller::Fixed(Pid::new(nominal, config(fixed.config())).expect("allowed"))
        }
        Controller::SelfTuning(fspid) => {
            let tuner = fspid.tuner();
            let settings = settings(tuner.settings());
            let nominal = gains(tuner.nominal());
            let tuner = SelfTuner::new(nominal, *tuner.supervisor(), settings).expect("allowed");
            let config = config(fspid.config());
            Controller::SelfTuning(Fspid::new(tuner, config).expect("allowed"))
        }
    }
}

fn gains(gains: Gains<f64>) -> Gains<f64> {
    Gains { kp: LESS * gains.kp, ki: LESS * gains.ki, kd: LESS * gains.kd }
}

fn limits(limits: Limits<f64>) -> Limits<f64> {
    let (lower, upper) = (LESS * limits.lower(), LESS * limits.upper());
    Limits::new(ControllerSetting::OutputLimits, lower, upper).expect("in order")
}

/// In full, so that somebody says of a new option whether an importer may set it.
fn config(config: &PidConfig<f64>) -> PidConfig<f64> {
    let PidConfig {
        dt_s,
        rate_gain_s,
        setpoint_weights,
        feedforward,
        derivative,
        integral,
        anti_windup,
        limits: command_limits,
        slew_rad_s,
        guard,
    } = *config;
    PidConfig {
        dt_s,
        rate_gain_s: LESS * rate_gain_s,
        setpoint_weights: SetpointWeights {
            proportional: LESS * setpoint_weights.proportional,
            derivative: LESS * setpoint_weights.derivative,
        },
        feedforward: LESS * feedforward,
        derivative: Derivative { filter_s: LESS * derivative.filter_s },
        integral,
        anti_windup: match anti_windup {
            AntiWindup::None => AntiWindup::None,
            AntiWindup::Conditional => AntiWindup::Conditional,
            AntiWindup::Clamping(term) => AntiWindup::Clamping(limits(term)),
            AntiWindup::BackCalculation { tracking_s } => {
                AntiWindup::BackCalculation { tracking_s: tracking_s / LESS }
            }
        },
        limits: command_limits.map(limits),
        slew_rad_s: slew_rad_s.map(|slew| LESS * slew),
        guard: Guard::new(LESS * guard.limit_rad()).expect("above zero"),
    }
}

fn settings(settings: &TunerSettings<f64>) -> TunerSettings<f64> {
    let TunerSettings {
        error_sign,
        second_input,
        change,
        input_scale,
        input_sets,
        output_scale,
        gain_coupling,
        law,
        gain_limits,
        dead_zone,
    } = *settings;
    let centres = |centres: SetCentres<f64>| {
        SetCentres::new(LESS * centres.small(), LESS * centres.medium()).expect("in order")
    };
    TunerSettings {
        error_sign,
        second_input: match second_input {
            SecondInput::Change => SecondInput::Change,
            SecondInput::Rate => SecondInput::Rate,
            SecondInput::ModelError(ReferenceModel { bandwidth_rad_s, damping }) => {
                let bandwidth_rad_s = LESS * bandwidth_rad_s;
                SecondInput::ModelError(ReferenceModel { bandwidth_rad_s, damping: LESS * damping })
            }
        },
        change,
        input_scale: InputScale {
            error_per_rad: LESS * input_scale.error_per_rad,
            change_per_rad: LESS * input_scale.change_per_rad,
        },
        input_sets: InputSets {
            error: input_sets.error.map(centres),
            change: input_sets.change.map(centres),
        },
        output_scale: gains(output_scale),
        gain_coupling: GainCoupling {
            setpoint_weight: LESS * gain_coupling.setpoint_weight,
            rate_gain: LESS * gain_coupling.rate_gain,
        },
        law: match law {
            Law::Memoryless => Law::Memoryless,
            Law::Accumulating { leakage_per_s } => {
                Law::Accumulating { leakage_per_s: LESS * leakage_per_s }
            }
        },
        gain_limits: gain_limits.map(|GainLimits { kp, ki, kd }| GainLimits {
            kp: limits(kp),
            ki: limits(ki),
            kd: limits(kd),
        }),
        dead_zone: dead_zone.map(|zone| DeadZone {
            error_rad: LESS * zone.error_rad,
            change_rad: LESS * zone.change_rad,
        }),
    }
}
