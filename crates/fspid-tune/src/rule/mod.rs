//! Classical tuning rules: gains from a model of the loop, or from an experiment with it, without a search.
//!
//! Starting points and baselines. Most of the rules were made for stable, well damped processes with dead time; the
//! pitch of an aircraft is lightly damped, and the rules do not know that. So every [`Design`] carries what came of it:
//! the closed loop that its gains make is analysed as any other, exactly sampled, with every plant of the scenario.
//!
//! ```text
//! study ─process▶ ultimate point ─fit▶ model ─formula▶ gains ─analysis▶ verdict
//!       └─relay, flown▶ ultimate point ──────────▲
//! ```
//!
//! The process is everything from command to seen pitch: servo, delays, plant, sensor and a closed rate loop if the
//! configuration has a rate gain. A nonlinear aircraft is taken at its trim; the relay flies it as it is.

mod derive;
mod error;
mod formula;
mod isa;
mod json;
mod kind;
mod lqr;
mod model;
mod options;
mod outcome;
mod place;
mod process;
mod relay;
mod text;
mod ultimate;

use fspid_core::{Gains, Pid, PidConfig};
use fspid_scenario::file::Study;
use fspid_sim::{Controller, NamedController, Scenario};
use fspid_study::analysis::{AnalysedLoop, Analysis, Question};
use serde::Serialize;

pub use error::RuleError;
pub use isa::Isa;
pub use kind::{Form, Rule};
pub use lqr::LqrSearch;
pub use model::{FittedModel, Model, ModelParameter};
pub use options::{LqrOptions, Options, PoleOptions, ProcessKind, RelayOptions};
pub use outcome::Verdict;
pub use place::PlacedPoles;
pub use relay::RelayExperiment;
pub use ultimate::UltimatePoint;

/// What a rule found out before it gave gains.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Identified {
    /// The exact limit of stability of the proportional loop, where there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub ultimate: Option<UltimatePoint>,
    /// The fitted model, where the rule uses one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub model: Option<FittedModel>,
    /// The relay experiment of `autotune-relay`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub relay: Option<RelayExperiment>,
    /// The poles of `pole-placement`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub poles: Option<PlacedPoles>,
    /// The search of `lqr`.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub search: Option<LqrSearch>,
}

/// Which of the controller's settings beside the gains a rule gave.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Given {
    /// The gain of the rate loop.
    pub rate_gain: bool,
    /// The derivative filter.
    pub derivative_filter: bool,
    /// The set-point weights.
    pub setpoint_weights: bool,
}

/// What a rule made of a loop.
#[derive(Clone, Debug)]
pub struct Design {
    /// Name of the scenario.
    pub scenario: String,
    /// The rule.
    pub rule: Rule,
    /// The terms of the controller.
    pub form: Form,
    /// The gains, in parallel form.
    pub gains: Gains<f64>,
    /// Everything of the controller but its gains; what the rule gave of it says `given`.
    pub config: PidConfig<f64>,
    /// What of the configuration the rule gave.
    pub given: Given,
    /// What the rule found out.
    pub identified: Identified,
    /// The formula that gave the gains.
    pub formula: String,
    /// What is to be known before the gains are used.
    pub warnings: Vec<String>,
    /// The closed loop that the gains make, with every plant of the scenario.
    pub outcome: AnalysedLoop,
    /// What the outcome amounts to.
    pub verdict: Verdict,
    /// What acts in flight and is not in the linear loop.
    pub left_out: Vec<String>,
}

/// What a rule gives, before it is analysed.
struct Derived {
    form: Form,
    gains: Gains<f64>,
    config: PidConfig<f64>,
    given: Given,
    identified: Identified,
    formula: String,
    warnings: Vec<String>,
}

/// Tunes the loop of a study by a rule. The plant is the one that the scenario starts with; the outcome is analysed
/// with every plant that the scenario changes to.
///
/// # Errors
/// [`RuleError`] where the rule has nothing to start from: an option out of range, a form that the rule does not have,
/// a plant that turns the wrong way, no ultimate gain, no oscillation. Gains that make a bad loop are no error: the
/// design says so.
pub fn design(study: &Study, rule: Rule, options: &Options) -> Result<Design, RuleError> {
    design_for(&study.scenario, rule, options)
}

/// As [`design()`], for a scenario.
///
/// # Errors
/// As [`design()`].
pub fn design_for(scenario: &Scenario, rule: Rule, options: &Options) -> Result<Design, RuleError> {
    options.check()?;
    let derived = derive::derive(scenario, rule, options)?;
    let Derived { form, gains, config, given, identified, formula, mut warnings } = derived;
    let pid = Pid::new(gains, config)?;
    let controller = Controller::Fixed(pid);
    let mut flown = scenario.clone();
    flown.externals.clear();
    flown.controllers = vec![NamedController { name: rule.name().to_owned(), controller }];
    let question = Question { map_points: 0, ..Question::default() };
    let Analysis { mut loops, left_out, .. } = Analysis::of_scenario(&flown, question)?;
    let outcome = loops.pop().ok_or(RuleError::NoStart)?;
    let verdict = Verdict::of(&outcome);
    warnings.extend(outcome::warnings(&outcome, gains, identified.poles.as_ref()));
    let scenario = scenario.name.clone();
    Ok(Design {
        scenario,
        rule,
        form,
        gains,
        config,
        given,
        identified,
        formula,
        warnings,
        outcome,
        verdict,
        left_out,
    })
}

impl Design {
    /// True for a loop that is stable with every plant of the scenario, with margins of at least 6 dB and 45 deg.
    #[must_use]
    pub fn has_margins(&self) -> bool {
        self.verdict == Verdict::WithMargins
    }

    /// The gains in the standard form; none with a proportional gain of zero, or where they have no such form.
    #[must_use]
    pub fn isa(&self) -> Option<Isa> {
        let Gains { kp, ki, kd } = self.gains;
        let isa = Isa { gain: kp, ti_s: kp / ki, td_s: kd / kp };
        let isa = if ki == 0.0 { Isa { ti_s: f64::INFINITY, ..isa } } else { isa };
        (isa.ti_s > 0.0 && isa.td_s >= 0.0).then_some(isa)
    }
}
