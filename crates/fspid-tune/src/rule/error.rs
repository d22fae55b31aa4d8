//! Why a rule gives no gains.

use fspid_core::ConfigError;
use fspid_lti::LtiError;
use fspid_sim::SimError;

/// Why a rule gives no gains.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum RuleError {
    /// The loop cannot be sampled or analysed.
    #[error(transparent)]
    Loop(#[from] SimError),
    /// The gains make no controller.
    #[error("the rule's gains make no controller: {0}")]
    Controller(#[from] ConfigError),
    /// A number that is not allowed.
    #[error("{what} is {found:?}; allowed is {allowed}")]
    Number {
        /// Name of the option, with its unit.
        what: &'static str,
        /// What was given.
        found: f64,
        /// What is allowed.
        allowed: &'static str,
    },
    /// A form that the rule was not published for.
    #[error("{rule} has no form {found}; it has {allowed}")]
    Form {
        /// Name of the rule.
        rule: &'static str,
        /// What was asked for.
        found: &'static str,
        /// What there is.
        allowed: String,
    },
    /// A rule that does not start from an ultimate point.
    #[error("the relay's ultimate point is for ziegler-nichols or tyreus-luyben, not for {found}")]
    RelayRule {
        /// What was asked for.
        found: &'static str,
    },
    /// A configuration for another sample period.
    #[error("the controller is sampled every {found:?} s; the scenario asks for {allowed:?} s")]
    SamplePeriod {
        /// Of the configuration, s.
        found: f64,
        /// Of the scenario, s.
        allowed: f64,
    },
    /// A plant that turns the wrong way in the long run.
    #[error(
        "a nose-up command turns the nose down in the long run (steady gain {steady:?}); the rules need a plant that follows its command: check the plant's elevator sign"
    )]
    WrongSign {
        /// Steady pitch angle, or pitch rate, per command.
        steady: f64,
    },
    /// A plant that a model of a lag or an integrator cannot stand for.
    #[error(
        "the plant is unstable without control (spectral radius {spectral_radius:.6}); {rule} needs a stable or integrating one: allowed here are ziegler-nichols, tyreus-luyben, pole-placement and lqr"
    )]
    UnstablePlant {
        /// Name of the rule.
        rule: &'static str,
        /// Largest modulus of a pole.
        spectral_radius: f64,
    },
    /// More than one integrator.
    #[error("the plant has {found} poles at the origin; {rule} needs one or none")]
    Integrators {
        /// Name of the rule.
        rule: &'static str,
        /// Poles at the origin.
        found: usize,
    },
    /// No proportional gain holds the plant.
    #[error(
        "no gain of a proportional controller makes the loop stable, so that there is no ultimate gain; a rate loop may help (rate_gain)"
    )]
    NeverStable,
    /// Every proportional gain holds the plant.
    #[error(
        "the proportional loop is stable up to a gain of {tried:e}, so that there is no ultimate gain"
    )]
    AlwaysStable {
        /// Highest gain that was tried.
        tried: f64,
    },
    /// The loop becomes unstable without an oscillation.
    #[error(
        "at its ultimate gain {gain:.4} the loop runs away without oscillating: no ultimate period"
    )]
    NoUltimatePeriod {
        /// The ultimate gain.
        gain: f64,
    },
    /// No model of that kind passes through the points it is fitted to.
    #[error("no {kind} model goes through the plant's points at -180 deg and {other}")]
    NoModel {
        /// Kind of model.
        kind: &'static str,
        /// The other point.
        other: &'static str,
    },
    /// Poles that no gains can put there.
    #[error("no gains put poles at {frequency_rad_s:.4} rad/s: the plant passes nothing there")]
    NotPlaceable {
        /// Where, rad/s.
        frequency_rad_s: f64,
    },
    /// No start for a search.
    #[error(
        "lqr found no gains that hold the loop to start from; a plant like this needs other weights"
    )]
    NoStart,
    /// A relay whose command the actuator does not let through.
    #[error(
        "the actuator cuts the relay's {amplitude_rad:?} rad to {reached_rad:?} rad; choose a smaller amplitude"
    )]
    RelayCut {
        /// The relay's command, rad.
        amplitude_rad: f64,
        /// What the actuator makes of it, rad.
        reached_rad: f64,
    },
    /// The relay's loop ran away.
    #[error("the loop under the relay diverged at {at_s:.2} s")]
    RelayDiverged {
        /// When, s.
        at_s: f64,
    },
    /// The aircraft came down to the ground.
    #[error(
        "the aircraft under the relay hit the ground at {at_s:.2} s; choose a higher altitude or a shorter experiment"
    )]
    RelayHitGround {
        /// When, s.
        at_s: f64,
    },
    /// No oscillation that repeats.
    #[error(
        "the relay's oscillation did not settle within {longest_s} s ({cycles} cycles); choose a longer experiment, another amplitude or hysteresis"
    )]
    NoOscillation {
        /// Length of the experiment, s.
        longest_s: f64,
        /// Cycles that were seen.
        cycles: usize,
    },
    /// An oscillation within the hysteresis.
    #[error(
        "the relay's oscillation of {amplitude_rad:?} rad is not larger than its hysteresis of {hysteresis_rad:?} rad; choose a larger amplitude or a smaller hysteresis"
    )]
    RelayTooSmall {
        /// Of the oscillation, rad.
        amplitude_rad: f64,
        /// Of the relay, rad.
        hysteresis_rad: f64,
    },
}

impl From<LtiError> for RuleError {
    fn from(error: LtiError) -> Self {
        Self::Loop(error.into())
    }
}
