//! What is measured: inferences, closed loops and flights with all their measures.
//!
//! Scalar and batched work has the same inputs and must have the same answers.

use std::hint::black_box;
use std::ops::ControlFlow;

use fspid_core::fuzzy::{Answers, Increments, Supervisor};
use fspid_scenario::file::{Extra, Template};
use fspid_sim::batch::{BatchRow, Entrant, LANES, fly_group};
use fspid_sim::{Controller, Prepared, fly};

use crate::campaign::{Campaign, Progress};
use crate::error::CampaignError;
use crate::plan::{MOST_RUNS, Plan};
use crate::range::Range;
use crate::sample::Sampling;
use crate::table::ColumnTable;

/// The scenario that is flown, a file that `fspid simulate` takes too.
pub const SCENARIO: &str = include_str!("scenario.toml");
/// Seed of what the flights draw.
const SEED: u64 = 1;
/// Inputs of a pass of inferences: answers and inputs stay in the nearest caches.
const INPUTS: usize = 4096;
/// Flights whose steps are counted: two groups in lanes.
const LOOPS: u64 = 2 * LANES as u64;

/// Everything that is needed, read and prepared once.
#[derive(Debug)]
pub struct Work {
    campaign: Campaign,
    prepared: Vec<Prepared>,
    controllers: Vec<Controller>,
    inputs: Vec<(f64, f64)>,
    errors: Vec<f64>,
    changes: Vec<f64>,
}

impl Work {
    /// All of it.
    ///
    /// # Errors
    /// None: the scenario is built in.
    pub fn new() -> Result<Self, CampaignError> {
        let campaign = campaign()?;
        let (mut prepared, mut controllers) = (Vec::new(), Vec::new());
        for run in 0..LOOPS {
            let refused = |reason| CampaignError::Refused { run, reason };
            let study = campaign.study(&campaign.drawn(run)).map_err(refused)?;
            let loops = study.scenario.prepare();
            prepared.push(loops.map_err(|error| refused(error.to_string()))?);
            controllers.extend(study.scenario.controllers.first().map(|named| named.controller));
        }
        let range = controllers.first().and_then(supervisor).map_or(0.0, Supervisor::range);
        let inputs: Vec<(f64, f64)> = (1..=INPUTS).map(|n| input(n, range)).collect();
        let (errors, changes) = inputs.iter().copied().unzip();
        Ok(Self { campaign, prepared, controllers, inputs, errors, changes })
    }

    /// The campaign whose flights are measured.
    #[must_use]
    pub fn campaign(&self) -> &Campaign {
        &self.campaign
    }

    /// Inferences of a pass.
    #[must_use]
    pub fn inferences(&self) -> usize {
        self.inputs.len()
    }

    /// Steps of a pass: samples of all loops.
    #[must_use]
    pub fn steps(&self) -> usize {
        self.prepared.iter().map(|prepared| prepared.timing().rows()).sum()
    }

    /// Passes of inferences, one by one, and the sum of the answers of one.
    #[must_use]
    pub fn infer_one_by_one(&self, passes: usize) -> f64 {
        let mut places = Places::new();
        let supervisor = self.controllers.first().and_then(supervisor);
        for _ in 0..passes {
            for (place, &(error, change)) in black_box(&self.inputs).iter().enumerate() {
                if let Some(Ok(answer)) = supervisor.map(|it| black_box(it).infer(error, change)) {
                    places.put(place, answer.delta);
                }
            }
            black_box(&mut places);
        }
        places.sum()
    }

    /// The same passes as batches.
    #[must_use]
    pub fn infer_as_batch(&self, passes: usize) -> f64 {
        let mut places = Places::new();
        let supervisor = self.controllers.first().and_then(supervisor);
        for _ in 0..passes {
            let (errors, changes) = (black_box(&self.errors), black_box(&self.changes));
            let answers = black_box(&mut places).answers();
            let done = supervisor.map(|it| black_box(it).infer_many(errors, changes, answers));
            if !matches!(done, Some(Ok(()))) {
                return f64::NAN;
            }
        }
        places.sum()
    }

    /// A pass of closed loops, one by one, and the sum of their pitch angles and gains.
    #[must_use]
    pub fn fly_one_by_one(&self) -> f64 {
        let loops = self.prepared.iter().zip(&self.controllers);
        loops.fold(0.0, |total, (prepared, controller)| {
            let mut sum = 0.0;
            let outcome = fly(black_box(prepared), controller, |instant| {
                sum += instant.theta_rad + instant.step.gains.kp;
                ControlFlow::Continue(())
            });
            total + outcome.map_or(f64::NAN, |_| sum)
        })
    }

    /// The same loops side by side.
    #[must_use]
    pub fn fly_in_lanes(&self) -> f64 {
        let loops = self.prepared.iter().zip(&self.controllers);
        let loops: Vec<Entrant<'_>> =
            loops.map(|(prepared, controller)| Entrant { prepared, controller }).collect();
        let mut total = 0.0;
        for group in loops.chunks(LANES) {
            let mut sums = [0.0; LANES];
            let outcomes = fly_group(black_box(group), |row: &BatchRow<'_, LANES>| {
                let [kp, ..] = row.gains;
                for (sum, (theta_rad, kp)) in sums.iter_mut().zip(row.theta_rad.iter().zip(kp)) {
                    *sum += theta_rad + kp;
                }
            });
            total = if outcomes.is_ok() { sums.iter().fold(total, |a, b| a + b) } else { f64::NAN };
        }
        total
    }

    /// The first flights with their measures, on the threads of the pool that this is called in.
    ///
    /// # Errors
    /// None: the scenario is built in.
    pub fn fly(&self, flights: u64) -> Result<ColumnTable, CampaignError> {
        self.campaign.fly(Range { first: 0, end: flights }, &Progress::default())
    }
}

/// Where the answers of a pass go.
struct Places {
    gains: [[f64; INPUTS]; 3],
    flags: [[bool; INPUTS]; 2],
}

impl Places {
    fn new() -> Box<Self> {
        // A place that is not answered shows in the sum.
        Box::new(Self { gains: [[f64::NAN; INPUTS]; 3], flags: [[false; INPUTS]; 2] })
    }

    fn put(&mut self, place: usize, answer: Increments<f64>) {
        let [kps, kis, kds] = &mut self.gains;
        (kps[place], kis[place], kds[place]) = (answer.kp, answer.ki, answer.kd);
    }

    fn answers(&mut self) -> Answers<'_, f64> {
        let ([kp, ki, kd], [clamped, underflowed]) = (&mut self.gains, &mut self.flags);
        Answers { kp, ki, kd, clamped, underflowed }
    }

    /// A sum in which each gain has another weight, so that none can stand for another.
    fn sum(&self) -> f64 {
        let [kps, kis, kds] = &self.gains;
        let answers = kps.iter().zip(kis).zip(kds);
        answers.fold(0.0, |sum, ((kp, ki), kd)| sum + (kp + 3.0 * ki + 7.0 * kd))
    }
}

fn supervisor(controller: &Controller) -> Option<&Supervisor<f64>> {
    match controller {
        Controller::SelfTuning(fspid) => Some(fspid.tuner().supervisor()),
        Controller::Fixed(_) => None,
    }
}

/// Input `n` of those that fill the square evenly: multiples of the two numbers of the plastic
/// constant, modulo 1 (M. Roberts, *The unreasonable effectiveness of quasirandom sequences*, 2018).
fn input(n: usize, range: f64) -> (f64, f64) {
    let place = |step: f64| range * (2.0 * (n as f64 * step).fract() - 1.0);
    (place(0.754_877_666_246_692_8), place(0.569_840_290_998_053_3))
}

fn campaign() -> Result<Campaign, CampaignError> {
    let name = "the built-in benchmark";
    let template = Template::parse(SCENARIO, name, None, &Extra::default())
        .map_err(CampaignError::Scenario)?;
    let plan = Plan {
        scenario_text: SCENARIO.to_owned(),
        scenario_path: name.to_owned(),
        scenario_folder: ".".into(),
        scenario_digest: template.study().digest.clone(),
        overrides: Vec::new(),
        sampling: Sampling::Random,
        // More than any machine is asked for; independent points do not depend on how many there are.
        runs: MOST_RUNS,
        seed: SEED,
        shard_runs: MOST_RUNS,
        program: Plan::this_program(),
    };
    Campaign::of_template(plan, template)
}
