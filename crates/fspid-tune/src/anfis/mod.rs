//! Fuzzy systems learned from data: what rules conclude by least squares, where their sets lie by gradient descent.
//!
//! An epoch has two passes (hybrid learning). Forward, with the input sets as they are, the answers are linear in the
//! conclusions, which are fitted to the data at once. Backward, with the conclusions as they are, the sets move a step
//! against the exact gradient of the squared error. The length of the step adapts: four errors in a row that fall make it
//! longer, two falls that alternate with two rises shorter.
//!
//! ```
//! use fspid_fuzzy::system::Universe;
//! use fspid_tune::anfis::{Axis, Curve, Data, Order, Plan, grid, learn};
//!
//! let universe = Universe { lower: 0.0, upper: 3.0 };
//! let start = grid(&[Axis { name: "x".to_owned(), universe, terms: 3 }], &["y"], Curve::Bell, Order::One);
//! let mut data = Data::new(1, 1);
//! for k in 0..=30 {
//!     let x = 0.1 * f64::from(k);
//!     data.push(&[x], &[x * x * x])?;
//! }
//! let learned = learn(&start, &data, &Plan { epochs: 20, ..Plan::default() })?;
//! assert!(learned.best().training < 0.05);
//! # Ok::<(), fspid_tune::anfis::AnfisError>(())
//! ```
//!
//! # Source
//! J.-S. R. Jang, ANFIS: adaptive-network-based fuzzy inference system, IEEE Trans. Systems, Man and Cybernetics 23
//! (1993) 665. Different here: the step is measured in spans of the inputs, sets that would break a rule go a shorter
//! way, and least squares rotate rows into a triangle where the paper updates a covariance.
//!
//! Not here: choosing how many sets and rules there are.

mod answer;
mod consequents;
mod data;
mod error;
mod pace;
mod premises;
mod squares;
mod start;

use std::fmt;

use fspid_fuzzy::system::{Parts, System};
use fspid_scenario::count::{EPOCHS, PATIENCE};
use serde::Serialize;

use consequents::{Consequents, squared_error};
pub use data::{Data, DataRow};
pub use error::AnfisError;
use pace::Pace;
use premises::Premises;
pub use start::{Axis, Curve, Order, grid, sugeno};

/// How often a step that leaves a row of data without a rule is halved.
const HALVINGS: u32 = 20;

/// How to learn.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Plan {
    /// Most epochs; at least 1.
    pub epochs: usize,
    /// Whether the input sets move; if not, one epoch is all.
    pub premises: bool,
    /// Length of the first step of all that moves, where places count in spans of their input.
    pub step: f64,
    /// The search ends where the step has become shorter.
    pub least_step: f64,
    /// How strongly conclusions are drawn to 0: this times the square of what a conclusion adds to the answer at most
    /// counts like a squared error of every row. Jang's start of his recursion, the inverse of a large number.
    pub regularisation: f64,
    /// Root mean square error of training at which learning ends.
    pub enough: f64,
    /// Share of the rows that judge only; 0 for none.
    pub validation_share: f64,
    /// Seed of the choice of those rows.
    pub seed: u64,
    /// Learning ends after so many epochs without a better error of validation.
    pub patience: usize,
}

impl Default for Plan {
    fn default() -> Self {
        Self {
            epochs: 100,
            premises: true,
            step: 0.02,
            least_step: 1e-9,
            regularisation: 1e-12,
            enough: 0.0,
            validation_share: 0.0,
            seed: 1,
            patience: 20,
        }
    }
}

impl Plan {
    fn check(&self) -> Result<(), AnfisError> {
        EPOCHS.check(self.epochs)?;
        PATIENCE.check(self.patience)?;
        let positive = "a finite number above 0";
        let checks = [
            ("the step", self.step, self.step > 0.0 && self.step.is_finite(), positive),
            ("the least step", self.least_step, self.least_step >= 0.0, "0 or above"),
            (
                "the regularisation",
                self.regularisation,
                self.regularisation > 0.0 && self.regularisation.is_finite(),
                positive,
            ),
            ("the error that is enough", self.enough, self.enough >= 0.0, "0 or above"),
            (
                "the share for validation",
                self.validation_share,
                (0.0..1.0).contains(&self.validation_share),
                "0 or above, below 1",
            ),
        ];
        match checks.into_iter().find(|(_, _, good, _)| !good) {
            Some((what, found, _, allowed)) => Err(AnfisError::Plan { what, found, allowed }),
            None => Ok(()),
        }
    }
}

/// Errors after the forward pass of an epoch, of the system as it would be kept: roots of the mean square over rows and
/// outputs, of answers that are moved into the universe of an output that clamps them.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Epoch {
    /// Over the rows that are learned from.
    pub training: f64,
    /// Over the rows that judge only.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub validation: Option<f64>,
    /// Length of the step that the sets make after it.
    pub step: f64,
}

impl Epoch {
    /// What the best epoch has least of: the error of validation where there is one.
    fn cost(&self) -> f64 {
        self.validation.unwrap_or(self.training)
    }
}

/// Why learning ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// All epochs are done.
    Epochs,
    /// The error of training is small enough.
    Enough,
    /// The error of validation has not fallen for as many epochs as the patience lasts.
    Patience,
    /// The step has become shorter than the least.
    ShortStep,
    /// The error does not change with anything that moves.
    Flat,
    /// No step, however short, leaves every row of data a rule that fires and an error that is finite.
    Stuck,
    /// Nothing is to move: the conclusions are those of least squares.
    Fitted,
}

impl fmt::Display for Stop {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Epochs => "all epochs are done",
            Self::Enough => "the error of training is small enough",
            Self::Patience => "the error of validation does not fall any more",
            Self::ShortStep => "the step has become too short",
            Self::Flat => "the error does not change with anything that moves",
            Self::Stuck => "no step leaves every row of data a rule that fires",
            Self::Fitted => "nothing is to move; the conclusions are those of least squares with its regularisation",
        })
    }
}

/// What was learned.
#[derive(Clone, Debug, PartialEq)]
pub struct Learned {
    /// The system as it was in the best epoch.
    pub parts: Parts,
    /// Every epoch.
    pub history: Vec<Epoch>,
    /// Position of the best epoch: with the least error of validation, or of training without one.
    pub best: usize,
    /// Why learning ended.
    pub stop: Stop,
    /// The rows that judged; none where none did.
    pub judges: Option<Judges>,
}

/// Rows that judge only.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Judges {
    /// How many there are.
    pub rows: usize,
    /// How many of them are among those that are learned from, number by number, and judge nothing.
    pub also_learned: usize,
}

impl Learned {
    /// The errors of the best epoch.
    #[must_use]
    pub fn best(&self) -> Epoch {
        let nothing = Epoch { training: f64::NAN, validation: None, step: 0.0 };
        self.history.get(self.best).copied().unwrap_or(nothing)
    }
}

/// Learns from data, a share of which judges only if the plan says so.
///
/// What is learned are answers before they are moved into the universe of an output; errors are those of the answers that
/// are given. What an output shows with several rules of
/// one term is learned once for the term.
///
/// # Errors
/// [`AnfisError`]; in particular for a system that is not of Takagi and Sugeno, and for data at which no rule fires.
pub fn learn(parts: &Parts, data: &Data, plan: &Plan) -> Result<Learned, AnfisError> {
    plan.check()?;
    let (training, validation) = data.split(plan.validation_share, plan.seed);
    if training.is_empty() && !data.is_empty() {
        return Err(AnfisError::AllJudge { share: plan.validation_share, rows: data.len() });
    }
    learn_beside(parts, &training, validation.as_ref(), plan)
}

/// As [`learn`], judged by data of their own.
///
/// # Errors
/// As [`learn`].
pub fn learn_beside(
    parts: &Parts,
    training: &Data,
    validation: Option<&Data>,
    plan: &Plan,
) -> Result<Learned, AnfisError> {
    plan.check()?;
    check_data(parts, training, "learn from")?;
    if let Some(validation) = validation {
        check_data(parts, validation, "judge by")?;
    }
    let mut start = parts.clone();
    start.outputs.iter_mut().for_each(|output| output.clamp = false);
    let consequents = Consequents::of(&start, training, plan.regularisation)?;
    let premises = Premises::of(&start, training);
    let clamps = parts.outputs.iter().map(|output| output.clamp).collect();
    let session = Session { training, validation, plan, consequents, premises, clamps };
    let mut learned = session.run(&start)?;
    // Nothing was judged: no epoch is better than another.
    if let Some(found) = learned.best().validation.filter(|error| !error.is_finite()) {
        return Err(AnfisError::Validation { found });
    }
    learned.judges = validation.map(|validation| Judges {
        rows: validation.len(),
        also_learned: validation.rows_among(training),
    });
    Ok(learned)
}

fn check_data(parts: &Parts, data: &Data, what: &'static str) -> Result<(), AnfisError> {
    let needed = parts.inputs.len() + parts.outputs.len();
    if data.inputs() != parts.inputs.len() || data.outputs() != parts.outputs.len() {
        return Err(AnfisError::Width { row: 1, found: data.inputs() + data.outputs(), needed });
    }
    if data.is_empty() { Err(AnfisError::NoData { what }) } else { Ok(()) }
}

/// Everything that stays the same while learning goes on.
struct Session<'a> {
    training: &'a Data,
    validation: Option<&'a Data>,
    plan: &'a Plan,
    consequents: Consequents,
    premises: Premises,
    /// Which outputs move their answers into their universe, once they are learned.
    clamps: Vec<bool>,
}

impl Session<'_> {
    fn run(&self, start: &Parts) -> Result<Learned, AnfisError> {
        let mut system = self.fitted(start)?;
        let mut pace = Pace::new(self.plan.step);
        let mut learned = Learned {
            parts: Parts::default(),
            history: Vec::new(),
            best: 0,
            stop: Stop::Epochs,
            judges: None,
        };
        if !self.plan.premises || self.premises.is_empty() {
            let squared = squared_error(&system, self.training)?;
            if !squared.is_finite() {
                return Err(AnfisError::Overflow);
            }
            self.record(&mut learned, &system, squared, 0.0)?;
            learned.stop = Stop::Fitted;
            return Ok(learned);
        }
        loop {
            let slopes = self.premises.slopes(&system, self.training)?;
            let training = root_mean(slopes.squared_error, self.training);
            if !training.is_finite() {
                // Conclusions within the range of numbers, squared errors beyond it.
                return match learned.history.is_empty() {
                    true => Err(AnfisError::Overflow),
                    false => Ok(Learned { stop: Stop::Stuck, ..learned }),
                };
            }
            pace.see(training);
            self.record(&mut learned, &system, slopes.squared_error, pace.step())?;
            let norm = slopes.norm();
            if let Some(stop) = self.stop(&learned, pace.step(), norm) {
                learned.stop = stop;
                return Ok(learned);
            }
            let Some(next) = self.next(&system, &slopes, pace.step()) else {
                learned.stop = Stop::Stuck;
                return Ok(learned);
            };
            system = next;
        }
    }

    /// The system with these premises, with conclusions fitted, if its rules cover all data.
    fn fitted(&self, premises: &Parts) -> Result<System, AnfisError> {
        let system = self.consequents.fitted(premises, self.training)?;
        if let Some(validation) = self.validation {
            squared_error(&system, validation)?;
        }
        Ok(system)
    }

    /// The system after a step, which is shorter where it would leave data without a rule.
    fn next(&self, system: &System, slopes: &premises::Slopes, step: f64) -> Option<System> {
        let mut length = step;
        for _ in 0..HALVINGS {
            let moved = self.premises.moved(system.parts(), slopes, length);
            if let Ok(next) = self.fitted(&moved) {
                return Some(next);
            }
            length *= 0.5;
        }
        None
    }

    fn record(
        &self,
        learned: &mut Learned,
        system: &System,
        squared: f64,
        step: f64,
    ) -> Result<(), AnfisError> {
        let clamping = self.clamping(system)?;
        let (kept, squared) = match &clamping {
            Some(clamping) => (clamping, squared_error(clamping, self.training)?),
            None => (system, squared),
        };
        let validation = match self.validation {
            Some(data) => Some(root_mean(squared_error(kept, data)?, data)),
            None => None,
        };
        let epoch = Epoch { training: root_mean(squared, self.training), validation, step };
        if learned.history.is_empty() || epoch.cost() < learned.best().cost() {
            learned.best = learned.history.len();
            learned.parts = kept.parts().clone();
        }
        learned.history.push(epoch);
        Ok(())
    }

    /// The system as it is kept where an output moves its answers into its universe; none where none does.
    fn clamping(&self, system: &System) -> Result<Option<System>, AnfisError> {
        if !self.clamps.contains(&true) {
            return Ok(None);
        }
        let mut parts = system.parts().clone();
        for (output, clamp) in parts.outputs.iter_mut().zip(&self.clamps) {
            output.clamp = *clamp;
        }
        System::new(parts).map(Some).map_err(AnfisError::System)
    }

    fn stop(&self, learned: &Learned, step: f64, norm: f64) -> Option<Stop> {
        let done = learned.history.len();
        let last = learned.history.last()?;
        // The last two are written so that NaN stops.
        if last.training <= self.plan.enough {
            Some(Stop::Enough)
        } else if self.validation.is_some() && done > learned.best + self.plan.patience {
            Some(Stop::Patience)
        } else if done >= self.plan.epochs {
            Some(Stop::Epochs)
        } else if !(norm > 0.0 && norm.is_finite()) {
            Some(Stop::Flat)
        } else if !(step >= self.plan.least_step) {
            Some(Stop::ShortStep)
        } else {
            None
        }
    }
}

/// Root of the mean over rows and outputs.
fn root_mean(squared: f64, data: &Data) -> f64 {
    (squared / (data.len() * data.outputs().max(1)) as f64).sqrt()
}
