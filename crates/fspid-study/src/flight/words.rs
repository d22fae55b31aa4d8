//! What is said of a flight beside its measures.

use fspid_core::Gains;
use fspid_sim::RestPoint;
use fspid_sim::load::{ConstantLoad, HALF_GONE, REMOVED};
use fspid_sim::stability::Unstable;

use super::ControllerResult;
use crate::analysis::{AtRest, RestGains, held_in_words};
use crate::metrics::{Absent, EdgeMetrics, left_validity};
use fspid_diagnostics::digits::{to_digits, to_six_decimals};
use fspid_scenario::file::RangeRule;
use fspid_scenario::turned::turned_and_asked_in_words;
use fspid_scenario::units::degrees;

/// What is asked where the first movement is steadily away from the set-point, and gains are not turned.
pub const WRONG_WAY: &str = "moves the wrong way: is elevator_sign right?";

/// Beyond this no elevator moves, deg: assumption A37.
const FAR_DEG: f64 = 60.0;

/// What is said of the measures of steps where the air moves.
const IN_MOVING_AIR: &str =
    "the air moves: the measures of a step are those of the step and of the air";

/// Gains to five digits.
fn gains(gains: Gains<f64>) -> String {
    let [kp, ki, kd] = [gains.kp, gains.ki, gains.kd].map(|gain| to_digits(gain, 5));
    format!("kp {kp}, ki {ki}, kd {kd}")
}

impl AtRest {
    /// The gains at rest beside the nominal ones; none for fixed gains.
    #[must_use]
    pub fn gains_in_words(&self) -> Option<String> {
        let nominal = gains(self.nominal);
        Some(match self.gains {
            RestGains::Fixed(_) => return None,
            RestGains::Unknown => "a program without equations here: its flight is judged; stability at rest, margins and constant loads are not asked".to_owned(),
            RestGains::Tuned(tuned) => format!("gains nominal {nominal}; at rest {}", gains(tuned)),
            RestGains::Kept => format!(
                "gains nominal {nominal}; at rest those that they have come to (accumulating law without leakage)"
            ),
            RestGains::Drifting => format!(
                "gains nominal {nominal}; at rest they drift without end"
            ),
        })
    }

    /// What is said where the first movement is steadily away from the set-point: a gain of the wrong sign is the nearer cause.
    #[must_use]
    pub fn wrong_way_in_words(&self) -> String {
        turned_and_asked_in_words(self.nominal)
            .map_or_else(|| WRONG_WAY.to_owned(), |turned| format!("moves the wrong way: {turned}"))
    }

    /// Why stability or load at rest could not be asked; none where they were, or there are no gains at rest.
    #[must_use]
    pub fn not_asked_in_words(&self) -> Option<String> {
        self.not_asked
            .as_ref()
            .map(|reason| format!("the loop at rest could not be asked: {reason}"))
    }

    /// At which rest the loop is unstable, where it is not at the trim.
    fn unstable_where_in_words(&self) -> Option<String> {
        let Unstable { at, mode, .. } = self.unstable?;
        if let Some(mode) = mode {
            return Some(format!(
                "unstable with the outer loops of mode {} of the autopilot, which the pitch loop alone is not",
                mode + 1
            ));
        }
        (at != RestPoint::TRIM).then(|| {
            let held = held_in_words(at);
            format!("unstable {held}: where gains move, the loop is another one at each set-point and load")
        })
    }

    /// That stability is undecided, where and why; none where it is known.
    #[must_use]
    pub fn undecided_in_words(&self) -> Option<String> {
        let undecided = self.undecided?;
        let why = Absent::Undecided(undecided.doubt);
        if undecided.doubt.is_beyond_the_loop() {
            return Some(format!("stability at rest: {why}"));
        }
        Some(format!("stability at rest {}: {why}", held_in_words(undecided.at)))
    }

    /// What is said of a constant load that is not removed within the flight; none where it is, or nobody can tell.
    #[must_use]
    pub fn load_in_words(&self, duration_s: f64) -> Option<String> {
        let load = self.load.filter(|load| !load.is_removed())?;
        Some(of_load(&load, duration_s))
    }
}

/// What a constant load does that is not removed within the flight.
fn of_load(load: &ConstantLoad, duration_s: f64) -> String {
    let why = match load.has_integral {
        true if load.is_cut => {
            "the limits of the integral leave it less than that beside what the end of the flight takes"
        }
        false => "no integral at rest (ki = 0)",
        true if load.at_end >= load.largest => {
            "the flight is too short to tell what the integral does"
        }
        true if load.is_half_gone() => "the flight is short beside the integral at rest",
        true => "little integral at rest",
    };
    let (at_end, duration) = (to_digits(load.at_end, 3), to_six_decimals(duration_s));
    let then = match load.is_slow() {
        true => ", and goes on shrinking".to_owned(),
        false => format!(", and {} deg for good", to_digits(load.for_good, 3)),
    };
    let [removed, half_gone] = [REMOVED, HALF_GONE].map(|share| 100.0 * share);
    format!(
        "{why}: a constant load of 1 deg at the servo leaves an error of {at_end} deg after {duration} s, {:.0} % of its largest effect (removed: at most {removed} %, half gone: at most {half_gone} %){then}",
        100.0 * load.share_left()
    )
}

impl EdgeMetrics {
    /// What is added to the measures of a step where a disturbance begins before they end; they are those of both.
    #[must_use]
    pub fn disturbed_in_words(&self) -> String {
        self.of_both_in_words().map_or(String::new(), |of_both| format!("; {of_both}"))
    }

    /// The same as a sentence of its own.
    pub(crate) fn disturbed_within_in_words(&self) -> Option<String> {
        let of_both = self.of_both_in_words()?;
        Some(format!(
            "the measures of the step at {} s are those {of_both}",
            to_six_decimals(self.at_s)
        ))
    }

    /// When what disturbs begins, where the measures of the step have it in them.
    pub(crate) fn measured_with_load_from_s(&self) -> Option<f64> {
        self.disturbed_from_s.filter(|_| self.step.overshoot_pct.is_ok())
    }

    fn of_both_in_words(&self) -> Option<String> {
        let from_s = self.measured_with_load_from_s()?;
        Some(format!("of the step and of what disturbs from {} s on", to_six_decimals(from_s)))
    }
}

impl ControllerResult {
    /// That command or elevator goes where no elevator does, and nothing stops it; none where something would, or neither does.
    fn far_in_words(&self) -> Option<String> {
        if self.is_limited {
            return None;
        }
        let (command, elevator) = (self.metrics.effort.ok()?, self.metrics.elevator.ok()?);
        let largest_deg = degrees(command.largest_rad.max(elevator.largest_rad));
        (largest_deg > FAR_DEG).then(|| {
            let largest = to_digits(largest_deg, 4);
            format!("commands {largest} deg of elevator, and no limit is given: actuator.position_limit_deg")
        })
    }

    /// What is to be known beside the verdict and fails nothing: the question of the sign, a load that stays, what could
    /// not be asked, a range that may be left and was.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        let question = self.metrics.wrong_way.then(|| self.at_rest.wrong_way_in_words());
        let load = self.at_rest.load_in_words(self.duration_s);
        let allowed = self.trace.exit.filter(|_| self.range_rule == RangeRule::Warns);
        let left = allowed.map(|exit| left_validity(&exit));
        let not_asked = self.at_rest.not_asked_in_words();
        let held = self
            .at_rest
            .unstable_where_in_words()
            .into_iter()
            .chain(self.at_rest.undecided_in_words());
        let has_steps = self.metrics.edges.iter().any(|edge| edge.step.overshoot_pct.is_ok());
        let air = (self.in_moving_air && has_steps).then(|| IN_MOVING_AIR.to_owned());
        let far = self.far_in_words();
        let of_flight = load.into_iter().chain(air).chain(far).chain(left).chain(not_asked);
        question.into_iter().chain(held).chain(of_flight).collect()
    }
}
