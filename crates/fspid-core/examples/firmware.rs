//! The paper's self-tuning pitch controller in a microcontroller: f32, no heap, no panic.
#![no_std]
use fspid_core::fuzzy::{Defuzzifier, OutOfRange, Supervisor};
use fspid_core::{AntiWindup, ConfigError, ControllerSetting, Fspid, Gains, InputScale, Limits};
use fspid_core::{PidConfig, Sample, SelfTuner, State, TunerSettings, paper};

/// Built once, before the loop starts; the only part that may fail.
pub fn autopilot() -> Result<Fspid<f32>, ConfigError> {
    let rules = paper::rules().mirrored();
    let supervisor = Supervisor::new(&rules, 5.0, Defuzzifier::Exact, OutOfRange::Clamp)?;
    let settings = TunerSettings {
        input_scale: InputScale { error_per_rad: 60.0, change_per_rad: 12.0 },
        output_scale: Gains { kp: 0.05, ki: 0.01, kd: 0.01 },
        ..TunerSettings::literal()
    };
    let tuner = SelfTuner::new(Gains { kp: 2.0, ki: 0.5, kd: 1.0 }, supervisor, settings)?;
    let limits = Some(Limits::new(ControllerSetting::OutputLimits, -0.35, 0.35)?);
    let every_10_ms = PidConfig::sampled_every(0.01);
    Fspid::new(tuner, PidConfig { limits, anti_windup: AntiWindup::Conditional, ..every_10_ms })
}
/// Called by the timer every 10 ms; answers the command in rad, positive for nose up.
pub fn on_timer(autopilot: &Fspid<f32>, state: &mut State<f32>, sample: Sample<f32>) -> f32 {
    autopilot.step(state, sample).command_rad
}
