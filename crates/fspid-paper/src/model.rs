//! A figure's flight as a handful of numbers: what an identification moves, and the scenario file
//! that it writes.

use fspid_core::fuzzy::{Defuzzifier, OutOfRange, RuleTable, Supervisor};
use fspid_core::{
    ControllerSetting, ErrorSign, Fspid, GainLimits, Gains, InputScale, IntegralForm, Limits, Pid,
    PidConfig, SelfTuner, TunerSettings,
};
use fspid_sim::signal::{Profile, Shape};
use fspid_sim::{
    Actuator, Controller, LinearPlant, NamedController, Scenario, SimError, Surroundings, Timing,
};

use fspid_scenario::units::{degrees, radians};

/// Sample period of all figures, s (assumption A4).
pub(super) const SAMPLE_PERIOD_S: f64 = 0.01;
/// Time constant of the servo, s (the paper's 10/(s + 10)).
const SERVO_S: f64 = 0.1;
/// Size of all commands, degrees (assumption A20).
const AMPLITUDE_DEG: f64 = 1.0;
/// Samples of the accepted half periods lie on the sample grid.
const SAMPLES_PER_S: f64 = 1.0 / SAMPLE_PERIOD_S;

/// The command of a figure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Command {
    /// A step, flown for this long.
    Step {
        /// Length of the window, s.
        window_s: f64,
    },
    /// No command, flown for this long.
    Rest {
        /// Length of the window, s.
        window_s: f64,
    },
    /// A bipolar square wave.
    Square {
        /// Half period, s; a whole number of samples.
        half_period_s: f64,
        /// How many of them are flown.
        half_periods: u32,
    },
}

/// The scales of a supervisor.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Scales {
    /// Supervisor units per degree of error.
    pub error: f64,
    /// Supervisor units per degree per second of change.
    pub change: f64,
    /// Factors of the increments.
    pub output: [f64; 3],
}

/// What is common to all controllers and figures of a range.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Setting {
    /// Name of the plant.
    pub plant: &'static str,
    /// Half range of the supervisor.
    pub range: f64,
    /// Sign of its error.
    pub error_sign: ErrorSign,
}

/// Figs 5 and 6.
pub(super) const FULL_MODEL: Setting =
    Setting { plant: "b747-paper", range: 5.0, error_sign: ErrorSign::SetpointMinusMeasurement };
/// Figs 7, 8 and 9.
pub(super) const SHORT_PERIOD: Setting =
    Setting { plant: "navion-paper", range: 40.0, error_sign: ErrorSign::MeasurementMinusSetpoint };

/// A controller of a figure.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct ControllerModel {
    /// Its name.
    pub name: String,
    /// Fixed or nominal gains.
    pub gains: [f64; 3],
    /// Gain of the rate-gyro loop, s.
    pub rate_gain: f64,
    /// The supervisor's scales, for a self-tuning one.
    pub scales: Option<Scales>,
}

/// A figure's flight.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct FlightModel {
    /// Name of the scenario.
    pub name: String,
    /// Plant and supervisor.
    pub setting: Setting,
    /// The command.
    pub command: Command,
    /// The controllers that fly it, each on its own.
    pub controllers: Vec<ControllerModel>,
}

/// `half_period_s` on the sample grid.
#[must_use]
pub(super) fn on_grid(half_period_s: f64) -> f64 {
    (half_period_s * SAMPLES_PER_S).round() / SAMPLES_PER_S
}

impl FlightModel {
    /// Length of the flight, s.
    fn duration_s(&self) -> f64 {
        match self.command {
            Command::Step { window_s } | Command::Rest { window_s } => window_s,
            Command::Square { half_period_s, half_periods } => {
                f64::from(half_periods) * half_period_s
            }
        }
    }

    fn amplitude_deg(&self) -> f64 {
        match self.command {
            Command::Rest { .. } => 0.0,
            Command::Step { .. } | Command::Square { .. } => AMPLITUDE_DEG,
        }
    }

    /// The scenario, built directly; equal to what its [file](Self::toml) reads as.
    ///
    /// # Errors
    /// [`SimError`] for numbers that no scenario may have.
    pub(super) fn scenario(
        &self,
        plant: &LinearPlant,
        table: &RuleTable,
    ) -> Result<Scenario, SimError> {
        let shape = match self.command {
            Command::Step { .. } | Command::Rest { .. } => Shape::Step { at_s: 0.0 },
            Command::Square { half_period_s, .. } => {
                Shape::Square { at_s: 0.0, half_period_s, bipolar: true }
            }
        };
        let controllers = self.controllers.iter().map(|model| {
            let controller = self.controller(model, table)?;
            Ok(NamedController { name: model.name.clone(), controller })
        });
        Ok(Scenario {
            name: self.name.clone(),
            plant: plant.clone().into(),
            plant_changes: Vec::new(),
            actuator: Actuator::first_order(SERVO_S)?,
            timing: Timing::new(SAMPLE_PERIOD_S, self.duration_s())?,
            setpoint: Profile::new(radians(self.amplitude_deg()), shape)?,
            disturbances: Vec::new(),
            controllers: controllers.collect::<Result<_, SimError>>()?,
            externals: Vec::new(),
            surroundings: Surroundings::default(),
            autopilot: None,
        })
    }

    fn controller(
        &self,
        model: &ControllerModel,
        table: &RuleTable,
    ) -> Result<Controller, SimError> {
        let [kp, ki, kd] = model.gains;
        let gains = Gains { kp, ki, kd };
        let config =
            PidConfig { rate_gain_s: model.rate_gain, ..PidConfig::sampled_every(SAMPLE_PERIOD_S) };
        let Some(scales) = model.scales else {
            return Ok(Controller::Fixed(Pid::new(gains, config)?));
        };
        let config = PidConfig { integral: IntegralForm::Literal, ..config };
        let rule = (Defuzzifier::Exact, OutOfRange::Clamp);
        let supervisor = Supervisor::new(table, self.setting.range, rule.0, rule.1)?;
        let floor = Limits::new(ControllerSetting::GainLimits, 0.0, f64::INFINITY)?;
        let [kp, ki, kd] = scales.output;
        let settings = TunerSettings {
            error_sign: self.setting.error_sign,
            // A factor per degree is as many times larger per radian as a radian has degrees.
            input_scale: InputScale {
                error_per_rad: degrees(scales.error),
                change_per_rad: degrees(scales.change),
            },
            output_scale: Gains { kp, ki, kd },
            gain_limits: Some(GainLimits { kp: floor, ki: floor, kd: floor }),
            ..TunerSettings::literal()
        };
        let tuner = SelfTuner::new(gains, supervisor, settings)?;
        Ok(Controller::SelfTuning(Fspid::new(tuner, config)?))
    }

    /// The scenario file, with a heading of comment lines.
    #[must_use]
    pub(super) fn toml(&self, heading: &[String]) -> String {
        let mut out = String::new();
        for comment in heading {
            out.push_str(&format!("# {comment}\n"));
        }
        out.push_str(&format!("schema = 1\nname = \"{}\"\n", self.name));
        out.push_str(&format!("\n[plant]\npreset = \"{}\"\n", self.setting.plant));
        out.push_str(&format!("\n[actuator]\ntime_constant_s = {SERVO_S:?}\n"));
        let setpoint = match self.command {
            Command::Step { .. } | Command::Rest { .. } => "kind = \"step\"".to_owned(),
            Command::Square { half_period_s, .. } => {
                format!("kind = \"square\"\nhalf_period_s = {half_period_s:?}\nbipolar = true")
            }
        };
        let (duration_s, amplitude_deg) = (self.duration_s(), self.amplitude_deg());
        out.push_str(&format!(
            "\n[loop]\nsample_period_s = {SAMPLE_PERIOD_S:?}\nduration_s = {duration_s:?}\n"
        ));
        out.push_str(&format!("\n[setpoint]\n{setpoint}\namplitude_deg = {amplitude_deg:?}\n"));
        for controller in &self.controllers {
            self.push_controller(&mut out, controller);
        }
        out
    }

    fn push_controller(&self, out: &mut String, controller: &ControllerModel) {
        let ControllerModel { name, gains: [kp, ki, kd], rate_gain, scales } = controller;
        out.push_str(&format!("\n[[controller]]\nname = \"{name}\"\n"));
        match scales {
            None if *ki == 0.0 && *kd == 0.0 => {
                out.push_str(&format!("kind = \"p\"\nkp = {kp:?}\n"));
            }
            None => {
                out.push_str(&format!("kind = \"pid\"\nkp = {kp:?}\nki = {ki:?}\nkd = {kd:?}\n"));
            }
            Some(_) => {
                out.push_str(&format!(
                    "kind = \"fspid\"\nnominal = {{ kp = {kp:?}, ki = {ki:?}, kd = {kd:?} }}\n\
                    law = \"memoryless\"\nintegral = \"literal\"\n\
                    gain_limits = {{ kp_min = 0.0, ki_min = 0.0, kd_min = 0.0 }}\n"
                ));
            }
        }
        if *rate_gain != 0.0 {
            out.push_str(&format!("rate_gain = {rate_gain:?}\n"));
        }
        if let Some(scales) = scales {
            self.push_supervisor(out, scales);
        }
    }

    fn push_supervisor(&self, out: &mut String, scales: &Scales) {
        let sign = match self.setting.error_sign {
            ErrorSign::SetpointMinusMeasurement => "setpoint-minus-measurement",
            ErrorSign::MeasurementMinusSetpoint => "measurement-minus-setpoint",
        };
        let [kp, ki, kd] = scales.output;
        out.push_str(&format!(
            "supervisor.table = \"printed\"\nsupervisor.range = {:?}\n\
            supervisor.error_sign = \"{sign}\"\nsupervisor.error_scale = {:?}\n\
            supervisor.change = \"rate\"\nsupervisor.change_scale = {:?}\n\
            supervisor.output_scale = {{ kp = {kp:?}, ki = {ki:?}, kd = {kd:?} }}\n",
            self.setting.range, scales.error, scales.change
        ));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use fspid_scenario::file;

    fn model(setting: Setting, command: Command, rate_gain: f64) -> FlightModel {
        let scales = Scales { error: 23.71, change: 29.5, output: [0.28, 0.0096, 0.034] };
        let controller = |name: &str, gains, scales| ControllerModel {
            name: name.to_owned(),
            gains,
            rate_gain,
            scales,
        };
        FlightModel {
            name: "a figure".to_owned(),
            setting,
            command,
            controllers: vec![
                controller("PC", [3.531_360_275_7, 0.0, 0.0], None),
                controller("CPID", [0.5423, 0.0354, 0.177], None),
                controller("FSPID", [0.5423, 0.0354, 0.177], Some(scales)),
            ],
        }
    }

    #[test]
    fn the_scenario_that_is_searched_is_the_one_that_is_written() {
        let table = file::rule_table("printed").expect("shipped");
        for (setting, command, rate_gain) in [
            (FULL_MODEL, Command::Step { window_s: 12.0 }, 0.93),
            (SHORT_PERIOD, Command::Square { half_period_s: 6.61, half_periods: 4 }, 0.0),
            (SHORT_PERIOD, Command::Rest { window_s: 30.0 }, 0.0),
        ] {
            let model = model(setting, command, rate_gain);
            let plant = file::preset(setting.plant).expect("shipped").plant;
            let built = model.scenario(&plant, &table).expect("allowed");
            let heading = ["a heading".to_owned()];
            let read = file::parse(&model.toml(&heading), "model", None, &[]);
            assert_eq!(read.expect("good").scenario, built);
        }
    }
}
