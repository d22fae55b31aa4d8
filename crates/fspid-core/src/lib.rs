#![doc = include_str!("../README.md")]
//!
//! A sample that is not finite or absurdly large leaves the output and the memory as they were and latches a
//! [fault](Faults).
//!
//! # In a firmware
//!
//! The paper's self-tuner with its rules as a constant; `checks/firmware/check.sh` builds it for a Cortex-M4F:
//!
//! ```
#![doc = include_str!("../examples/firmware.rs")]
//! # extern crate std;
//! # fn main() -> Result<(), ConfigError> {
//! #     let (autopilot, mut state) = (autopilot()?, State::new());
//! #     let sample = Sample { setpoint_rad: 0.1, measurement_rad: 0.0, rate_rad_s: 0.0 };
//! #     let command_rad = on_timer(&autopilot, &mut state, sample);
//! #     assert!(0.1 < command_rad && command_rad <= 0.35);
//! #     Ok(())
//! # }
//! ```
//!
//! # Control narrative
//!
//! At sample $k$ the measurement $y_k$ is taken. The error is $e_k = r_k - y_k$, its change
//! $\Delta e_k = e_k - e_{k-1}$ (zero at the first sample). A self-tuning controller asks the
//! supervisor for the gains first ([`SelfTuner`]); then, with $T$ the sample period,
//!
//! $$ I_k = I_{k-1} + k_i e_k T, \qquad D_k = \frac{e_k - e_{k-1}}{T}, \qquad
//!    u_k = k_p e_k + I_k + k_d D_k - k_r q_k + k_f r_k $$
//!
//! where $q_k$ is the pitch rate and $k_r$ the gain of the rate-gyro loop, and $k_f$ what is
//! fed forward from the set-point, which does not move with the gains. The command is limited
//! and, if asked for, the integral follows the limit (anti-windup). A positive command means nose
//! up; the sign of the elevator belongs to the plant.
//!
//! No features: always `no_std`. Not here: time (the period is fixed at construction), plants, files, units other
//! than SI.
#![no_std]
#![cfg_attr(
    test,
    allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")
)]

#[cfg(test)]
extern crate std;

mod controller;
mod controller_setting;
pub mod equations;
mod error;
mod gains;
mod guard;
mod integral;
mod limits;
pub mod paper;
mod pid;
mod pid_config;
mod rounded;
mod sample;
mod second_input;
mod state;
mod tuner;

pub use controller::Controller;
pub use controller_setting::ControllerSetting;
pub use error::ConfigError;
pub use gains::{GainLimits, Gains};
pub use guard::{Faults, Guard};
pub use integral::{AntiWindup, IntegralForm};
pub use limits::Limits;
pub use pid::{Fspid, Pid};
pub use pid_config::{Derivative, PidConfig, SetpointWeights, largest_remembered};
pub use sample::Sample;
pub use second_input::{ModelState, ReferenceModel, SecondInput, SetCentres};
pub use state::{Previous, State, Step};
pub use tuner::{
    Change, DeadZone, ErrorSign, GainCoupling, InputScale, InputSets, Law, SelfTuner, TunerSettings,
};

pub use fspid_fuzzy as fuzzy;
