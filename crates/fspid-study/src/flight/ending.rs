//! How a flight ended, and whether it fails by itself: the one place that says so, for single flights, campaigns,
//! tunings and contests.

use fspid_sim::Exit;

use crate::metrics::{Verdict, left_validity};
use fspid_scenario::file::RangeRule;

/// Which flights fail by themselves, whatever is required of them, wherever that is said.
pub const FAILS_BY_ITSELF: &str = "diverges, hits the ground, leaves the range of its aircraft's data where its scenario does not allow that, waits in vain for a mode of its autopilot, or is of a loop that is unstable at rest";

/// How a flight ended.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ending {
    /// What its measures come to.
    pub measured: Verdict,
    /// When it first left the range of its aircraft's data, if it did.
    pub exit: Option<Exit>,
    /// What is made of leaving that range.
    pub range_rule: RangeRule,
}

impl Ending {
    /// The range that was left, where that is a failure.
    #[must_use]
    pub fn failing_exit(self) -> Option<Exit> {
        match self.range_rule {
            RangeRule::Fails => self.exit,
            RangeRule::Warns | RangeRule::Linear | RangeRule::NoRange => None,
        }
    }

    /// The verdict: what the measures come to, unless these are of data that did not hold.
    #[must_use]
    pub fn verdict(self) -> Verdict {
        match self.failing_exit() {
            Some(exit) if !self.measured.is_failure() => Verdict::LeftRange(exit),
            _ => self.measured,
        }
    }

    /// Why the flight fails, whatever is required of it; empty for one that does not.
    #[must_use]
    pub fn failures(self) -> Vec<String> {
        let lost = self.measured.is_failure().then(|| self.measured.to_string());
        lost.into_iter().chain(self.failing_exit().map(|exit| left_validity(&exit))).collect()
    }
}

/// A flight that fails whatever is required of it.
#[derive(Clone, Debug, PartialEq)]
pub struct FailedFlight {
    /// Name of the controller.
    pub controller: String,
    /// Size of the step, deg, of a flight of a ready set's own; none for the flight of the scenario.
    pub own_step_deg: Option<f64>,
    /// Why: see [`Ending::failures`].
    pub failures: Vec<String>,
}

impl FailedFlight {
    /// Which flight: "FSPID", "FSPID, on a flight of its own with a step of 5 deg".
    #[must_use]
    pub fn who(&self) -> String {
        format!("{}{}", self.controller, on_its_own(self.own_step_deg))
    }
}

/// What is added where something is said of a ready set's own flight.
pub(crate) fn on_its_own(own_step_deg: Option<f64>) -> String {
    own_step_deg.map_or(String::new(), |step_deg| {
        let step = fspid_diagnostics::digits::to_digits(step_deg, 6);
        format!(", on a flight of its own with a step of {step} deg")
    })
}
