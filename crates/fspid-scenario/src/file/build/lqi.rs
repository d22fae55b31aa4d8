//! The linear-quadratic regulator with integral action, as a PID of the project.

use fspid_core::{Gains, Pid, PidConfig, SetpointWeights};
use fspid_lti::{DampedIntegrator, IntegralRegulator, IntegralWeights, integral_regulator};
use fspid_sim::Controller;

use super::ends::{ends, placed};
use crate::file::spec::lqi as keys;
use crate::keyed::Section;
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
            proportional: section.get(keys::SETPOINT_WEIGHT)?,
            ..config.setpoint_weights
        },
        ..config
    };
    placed(report, section, Pid::new(gains, config)).map(Controller::Fixed)
}

fn regulator(report: &mut Report, section: &Section) -> Option<IntegralRegulator> {
    let (design, weights) = (section.get(keys::DESIGN)?, section.get(keys::WEIGHTS)?);
    let model = DampedIntegrator {
        damping_per_s: design.get(keys::PITCH_DAMPING_PER_S)?,
        power_per_s2: design.get(keys::ELEVATOR_POWER_PER_S2)?,
    };
    let found = integral_regulator(
        model,
        IntegralWeights {
            integral_per_s2: weights.get(keys::INTEGRAL)?,
            position: weights.get(keys::PITCH)?,
            rate_s2: weights.get(keys::RATE)?,
        },
    );
    match found {
        Ok(found) => Some(found),
        Err(error) => {
            let allowed = "a model and weights nearer to 1";
            report.missing(section.at(keys::DESIGN), &design.path, error.to_string(), allowed);
            None
        }
    }
}
