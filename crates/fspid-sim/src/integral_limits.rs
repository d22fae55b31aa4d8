//! Whether the limits of its own that an anti-windup by clamping gives an integral leave what a rest takes of it.
//!
//! Where they do not, the integral stands at one of them and acts no more: the loop is the one without an integral, which may
//! grow, or rest with an error.

use fspid_core::{AntiWindup, Gains, PidConfig};

use crate::controller::Controller;
use crate::held_limits::{last_plant, load_unseen_rad, moves_by_itself};
use crate::plant::LinearPlant;
use crate::rest::{command_per_pitch, rate_bias_rad_s};
use crate::scenario::Scenario;
use crate::stability::holds;

/// What the integral is where a flight ends, with the error at zero, and where it may go.
#[derive(Clone, Copy, Debug)]
pub(crate) struct HeldIntegral {
    /// Its part of the command, rad.
    term_rad: f64,
    /// The least and the most that it may be, rad.
    ends_rad: [f64; 2],
    /// The command for a pitch that is seen as zero, but for the integral's part and what holds the plant there, rad.
    without_rad: f64,
    /// What is missing of the command per rad of seen pitch.
    per_seen: f64,
}

impl HeldIntegral {
    /// Of a controller with `gains` at rest, `config` with what follows them, and a scenario's plant; none without limits of the
    /// integral or without an integral, and with an autopilot, whose set-point is not that of the scenario.
    pub(crate) fn at_the_end(
        scenario: &Scenario,
        plant: &LinearPlant,
        gains: Gains<f64>,
        config: &PidConfig<f64>,
    ) -> Option<Self> {
        let AntiWindup::Clamping(limits) = config.anti_windup else { return None };
        if gains.ki == 0.0 || scenario.autopilot.is_some() {
            return None;
        }
        let setpoint_rad = scenario.held_at_the_end_rad();
        let by_setpoint = gains.kp * config.setpoint_weights.proportional + config.feedforward;
        let without_rad = by_setpoint * setpoint_rad
            - config.rate_gain_s * rate_bias_rad_s(scenario)
            - load_unseen_rad(scenario, plant);
        let per_seen = command_per_pitch(scenario, plant) + gains.kp;
        let term_rad = per_seen * setpoint_rad - without_rad;
        let ends_rad = [limits.lower(), limits.upper()];
        Some(Self { term_rad, ends_rad, without_rad, per_seen })
    }

    /// How far it may go on from there to the nearer of its limits, rad; nothing where it does not come there.
    pub(crate) fn room_rad(&self) -> f64 {
        let [least_rad, most_rad] = self.ends_rad;
        f64::min(self.term_rad - least_rad, most_rad - self.term_rad).max(0.0)
    }

    /// True where its limits leave what the rest takes.
    fn fits(&self) -> bool {
        let [least_rad, most_rad] = self.ends_rad;
        // Written so that NaN does not fit.
        least_rad <= self.term_rad && self.term_rad <= most_rad
    }

    /// The pitch, as it is seen, at which the plant rests with the integral at a limit; none where the error comes to zero.
    pub(crate) fn seen_at_limit_rad(&self) -> Option<f64> {
        let [least_rad, most_rad] = self.ends_rad;
        let stops_rad = self.term_rad.max(least_rad).min(most_rad);
        (!self.fits()).then_some((self.without_rad + stops_rad) / self.per_seen)
    }
}

/// True where set-point and loads of the last sample, held on, take more of the integral than its limits leave, and the loop does
/// not hold while it stands at one; of a self-tuner, whose gains are others at the error that stays, a plant that does not come
/// to rest by itself counts as not held.
pub(crate) fn are_exceeded(
    scenario: &Scenario,
    controller: &Controller,
    gains: Gains<f64>,
) -> bool {
    let config = controller.config_at(gains);
    if !matches!(config.anti_windup, AntiWindup::Clamping(_)) {
        return false;
    }
    last_plant(scenario).is_some_and(|plant| {
        let held = HeldIntegral::at_the_end(scenario, &plant, gains, &config);
        let moves = matches!(controller, Controller::SelfTuning(_)) && moves_by_itself(&plant);
        held.is_some_and(|it| !it.fits())
            && (moves || !holds(scenario, &plant, Gains { ki: 0.0, ..gains }, &config))
    })
}
