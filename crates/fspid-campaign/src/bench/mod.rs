//! How fast this machine is: inferences, closed-loop steps and whole flights a second.
//!
//! All is measured by the wall, in rounds: each round does every kind of work once, so that what disturbs
//! the machine for a while hits all kinds alike. Rates are medians over the rounds. The work is the
//! same everywhere, and so are its answers: they are compared from round to round, between threads, between
//! scalar and batched work, and named by a digest that two machines can compare.

mod clock;
mod error;
mod rates;
mod report;
mod work;

pub use error::BenchError;
pub use rates::Rates;
pub use work::{SCENARIO, Work};

use fspid_sim::batch::InstructionSet;
use rayon::ThreadPool;

use crate::local::pool;
use crate::plan::Plan;
use crate::table::Digest;
use clock::timed;

/// How long to measure.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Effort {
    /// Rounds that count; one before them does not.
    pub rounds: usize,
    /// Flights of a round, more where there are so many threads that each would have next to nothing to do.
    pub flights: u64,
    /// Multiplies the inferences and steps of a round.
    pub passes: usize,
}

impl Effort {
    /// Some seconds.
    pub const USUAL: Self = Self { rounds: 15, flights: 256, passes: 4 };
    /// Less than a second.
    pub const QUICK: Self = Self { rounds: 3, flights: 64, passes: 1 };
}

/// Fewest flights of a round for each thread: four groups.
const FLIGHTS_OF_A_THREAD: u64 = 4 * fspid_sim::batch::LANES as u64;

/// A kind of work.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Inferences of the supervisor, one by one.
    InferenceScalar,
    /// Inferences as a batch.
    InferenceBatch,
    /// Samples of closed loops, one flight after the other.
    StepScalar,
    /// Samples of closed loops, flights side by side.
    StepBatch,
    /// Flights of a campaign: drawn, built, flown side by side, measured, judged.
    Flights,
}

impl Kind {
    /// All of them.
    pub const ALL: [Self; 5] = [
        Self::InferenceScalar,
        Self::InferenceBatch,
        Self::StepScalar,
        Self::StepBatch,
        Self::Flights,
    ];

    /// What it is called in JSON, without `_per_s`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::InferenceScalar => "inference_scalar",
            Self::InferenceBatch => "inference_batch",
            Self::StepScalar => "step_scalar",
            Self::StepBatch => "step_batch",
            Self::Flights => "flights",
        }
    }

    /// Passes of a round: what is fast is done more often.
    const fn passes(self) -> usize {
        match self {
            Self::InferenceScalar => 8,
            Self::InferenceBatch => 32,
            Self::StepScalar | Self::Flights => 1,
            Self::StepBatch => 4,
        }
    }
}

/// A kind of work on one thread and on all.
#[derive(Clone, Debug, PartialEq)]
pub struct Measurement {
    /// What was done.
    pub kind: Kind,
    /// On one thread.
    pub one: Rates,
    /// On all threads together.
    pub all: Rates,
}

/// What was found.
#[derive(Clone, Debug, PartialEq)]
pub struct Bench {
    /// How long was measured.
    pub effort: Effort,
    /// All threads.
    pub threads: usize,
    /// One entry a kind, in their order.
    pub measurements: Vec<Measurement>,
    /// Names all answers; the same on every machine for the same effort and version.
    pub digest: String,
}

/// Name and version of the program, as campaigns carry them.
#[must_use]
pub fn program() -> String {
    Plan::this_program()
}

/// Vector instructions that batches are computed with here.
#[must_use]
pub fn instruction_set() -> &'static str {
    InstructionSet::best().name()
}

impl Bench {
    /// Measures this machine on one thread and on `threads`; 0 for as many as it has.
    ///
    /// # Errors
    /// [`BenchError::Differs`] where the same work gives another answer; threads that cannot be had.
    pub fn of_this_machine(threads: usize, effort: Effort) -> Result<Self, BenchError> {
        let work = Work::new()?;
        let (one, all) = (pool(1)?, pool(threads)?);
        let mut answers = [const { None }; Kind::ALL.len()];
        let mut rates = [const { [const { Vec::new() }; 2] }; Kind::ALL.len()];
        for round in 0..=effort.rounds {
            for ((kind, answer), rates) in Kind::ALL.into_iter().zip(&mut answers).zip(&mut rates) {
                for (pool, rates) in [&one, &all].into_iter().zip(rates) {
                    let rate = measure(&work, kind, pool, effort, answer)?;
                    // The first round warms up.
                    if round > 0 {
                        rates.push(rate);
                    }
                }
            }
        }
        let [scalar, batch, scalar_loops, batch_loops, _] = &answers;
        same("inferences as a batch", scalar, batch)?;
        same("closed loops side by side", scalar_loops, batch_loops)?;
        let measurements = Kind::ALL.into_iter().zip(rates).map(|(kind, rates)| {
            let [one, all] = rates.map(Rates::new);
            Measurement { kind, one, all }
        });
        Ok(Self {
            effort,
            threads: all.current_num_threads(),
            measurements: measurements.collect(),
            digest: Digest::of_texts(answers.iter().flatten().map(String::as_str)).to_string(),
        })
    }
}

/// Does a round of a kind of work and answers its rate, 1/s.
fn measure(
    work: &Work,
    kind: Kind,
    pool: &ThreadPool,
    effort: Effort,
    expected: &mut Option<String>,
) -> Result<f64, BenchError> {
    let passes = effort.passes * kind.passes();
    let flights = effort.flights.max(FLIGHTS_OF_A_THREAD * pool.current_num_threads() as u64);
    let each = |pass: &(dyn Fn() -> f64 + Sync)| {
        let (answers, time_s) = timed(|| pool.broadcast(|_| pass()));
        (answers.into_iter().map(in_words).collect::<Vec<_>>(), time_s)
    };
    let many = |pass: &(dyn Fn() -> f64 + Sync)| {
        each(&|| (0..passes).map(|_| pass()).last().unwrap_or(f64::NAN))
    };
    let (answers, time_s) = match kind {
        Kind::InferenceScalar => each(&|| work.infer_one_by_one(passes)),
        Kind::InferenceBatch => each(&|| work.infer_as_batch(passes)),
        Kind::StepScalar => many(&|| work.fly_one_by_one()),
        Kind::StepBatch => many(&|| work.fly_in_lanes()),
        Kind::Flights => {
            let (table, time_s) = timed(|| pool.install(|| work.fly(flights)));
            let first = table?.slice(0..usize::try_from(effort.flights).unwrap_or(0))?;
            (vec![Digest::of(&first).to_string()], time_s)
        }
    };
    for answer in &answers {
        let expected = expected.get_or_insert_with(|| answer.clone());
        differs(kind.name(), expected, answer)?;
    }
    let all_passes = (answers.len() * passes) as f64;
    let done = match kind {
        Kind::InferenceScalar | Kind::InferenceBatch => all_passes * work.inferences() as f64,
        Kind::StepScalar | Kind::StepBatch => all_passes * work.steps() as f64,
        Kind::Flights => flights as f64,
    };
    Ok(done / time_s)
}

/// All bits of a sum.
fn in_words(sum: f64) -> String {
    format!("{sum:?} ({:016x})", sum.to_bits())
}

fn same(
    what: &'static str,
    expected: &Option<String>,
    found: &Option<String>,
) -> Result<(), BenchError> {
    match (expected, found) {
        (Some(expected), Some(found)) => differs(what, expected, found),
        _ => Ok(()),
    }
}

fn differs(what: &'static str, expected: &str, found: &str) -> Result<(), BenchError> {
    if expected == found {
        return Ok(());
    }
    Err(BenchError::Differs { what, expected: expected.to_owned(), found: found.to_owned() })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn work_that_gives_another_answer_is_no_measurement() {
        let work = Work::new().expect("built in");
        let one = pool(1).expect("a thread");
        let effort = Effort { rounds: 1, flights: 1, passes: 1 };
        let mut expected = None;
        for _ in 0..2 {
            let rate = measure(&work, Kind::StepBatch, &one, effort, &mut expected);
            assert!(rate.expect("the same answer") > 0.0);
        }
        let mut other = Some(in_words(0.5));
        let refused = measure(&work, Kind::StepBatch, &one, effort, &mut other);
        let refused = refused.expect_err("another answer").to_string();
        assert!(refused.contains("0.5 (3fe0000000000000)"), "{refused}");
        assert!(refused.contains(&expected.expect("an answer")), "{refused}");
    }

    #[test]
    fn the_scenario_is_one_that_scalar_and_batched_work_agree_on() {
        let work = Work::new().expect("built in");
        assert_eq!(work.fly_one_by_one().to_bits(), work.fly_in_lanes().to_bits());
        assert_eq!(work.infer_one_by_one(1).to_bits(), work.infer_as_batch(1).to_bits());
        assert_eq!((work.inferences(), work.steps()), (4096, 16 * 5001));
        let table = work.fly(9).expect("flown");
        assert_eq!(table.rows(), 9);
    }
}
