//! The linear-quadratic regulator with integral action, as a PID of the project.

use fspid_core::{Gains, Pid, PidConfig, SetpointWeights};
use fspid_lti::{DampedIntegrator, IntegralRegulator, IntegralWeights, integral_regulator};
use fspid_sim::Controller;

use super::controller::{ends, placed};
use crate::file::section::Section;
use fspid_diagnostics::Report;

/// The controller of a sound section.
///
/// $$ u = k_i \int (r - \theta) \ dt + k_\theta (b r - \theta) - k_q q $$
///
/// with the gains that are optimal in continuous time; $b$, the set-point weight, is no part of the design.
pub(super) fn controller(report: &mut Report, section: &Section, dt_s: f64) -> Option<Controller> {
    let found = regulator(report, section);
    let config = ends(report, section, dt_s);
    let (found, config) = (found?, config?);
    let gains = Gains { kp: found.position, ki: found.integral_per_s, kd: 0.0 };
    let config = PidConfig {
        rate_gain_s: found.rate_s,
        setpoint_weights: SetpointWeights {
            proportional: section.number("setpoint_weight")?,
            ..config.setpoint_weights
        },
        ..config
    };
    placed(report, section, Pid::new(gains, config)).map(Controller::Fixed)
}

fn regulator(report: &mut Report, section: &Section) -> Option<IntegralRegulator> {
    let (design, weights) = (section.section("design")?, section.section("weights")?);
    let model = DampedIntegrator {
        damping_per_s: design.number("pitch_damping_per_s")?,
        power_per_s2: design.number("elevator_power_per_s2")?,
    };
    let found = integral_regulator(
        model,
        IntegralWeights {
            integral_per_s2: weights.number("integral")?,
            position: weights.number("pitch")?,
            rate_s2: weights.number("rate")?,
        },
    );
    match found {
        Ok(found) => Some(found),
        Err(error) => {
            let allowed = "a model and weights nearer to 1";
            report.missing(section.at("design"), &design.path, error.to_string(), allowed);
            None
        }
    }
}
