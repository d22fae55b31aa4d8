//! Descents one after the other, as plain data.

use fspid_optimise::Bfgs;
use serde::{Deserialize, Serialize};

use super::Merit;

/// Candidates that the slope of one counts as: a flight with its way back takes three to four times as long as the flight.
pub(crate) const SLOPE_COUNTS: usize = 4;
/// What breaking a limit by all of itself costs at first, as a multiple of the start's cost.
const FIRST_PENALTY: f64 = 5.0;
/// A descent that ends farther beyond its limits than this goes on with so much more, up to so often.
const BEYOND: f64 = 1e-3;
const HARSHER: f64 = 5.0;
const MOST_HARSHER: u32 = 5;
/// More than any search counts, and little enough that sums of them are numbers.
const MOST_COUNTED: usize = 1 << 28;
/// How far a later descent begins from the best candidate, as a share of the cube: each of them in turn.
const SPREADS: [f64; 4] = [0.03, 0.1, 0.2, 0.05];

/// What a search by slopes has done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
pub struct Counted {
    /// Slopes of candidates.
    pub slopes: usize,
    /// Linear loops that were analysed for them.
    pub analyses: usize,
    /// Descents that were begun.
    pub descents: usize,
}

impl Counted {
    /// One slope with so many analyses.
    pub(crate) fn of_slope(analyses: usize) -> Self {
        Self { slopes: 1, analyses, descents: 0 }
    }

    /// True for what any search can have counted.
    pub(super) fn is_sound(self) -> bool {
        let Self { slopes, analyses, descents } = self;
        [slopes, analyses, descents].iter().all(|it| *it <= MOST_COUNTED)
    }

    /// In words: "320 are 80 slopes and 12 are 36 linear loops, in 3 descents".
    pub(crate) fn in_words(&self, flights: usize) -> String {
        let Self { slopes, analyses, descents } = self;
        let (by_slopes, all) = (SLOPE_COUNTS * slopes, self.candidates(flights));
        let loops = match analyses {
            0 => String::new(),
            _ => format!(" and {} are {analyses} linear loops", all - by_slopes),
        };
        let end = if *descents == 1 { "" } else { "s" };
        format!("{by_slopes} are {slopes} slopes{loops}, in {descents} descent{end}")
    }

    /// How many candidates all this counts as, of so many flights each: an analysis as a flight, which contains one.
    pub(crate) fn candidates(&self, flights: usize) -> usize {
        SLOPE_COUNTS * self.slopes + self.analyses.div_ceil(flights.max(1))
    }
}

/// Descents by slopes: the first from the start, each later one from near the best candidate so far, or from anywhere
/// where the search began anywhere.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(crate) struct Descents {
    run: Bfgs,
    /// Merit of a violation of 1, once the first cost is known.
    penalty: Option<f64>,
    /// How often that was made more.
    harsher: u32,
    /// Violation where the descent stands.
    violation: f64,
    seed: u64,
    anywhere: bool,
    counted: Counted,
}

impl Descents {
    pub(crate) fn new(start: &[f64], seed: u64, anywhere: bool) -> Self {
        let counted = Counted { descents: 1, ..Counted::default() };
        let first = if anywhere { Bfgs::anywhere(start.len(), seed, 0) } else { start.to_vec() };
        let run = Bfgs::at(&first);
        Self { run, penalty: None, harsher: 0, violation: 0.0, seed, anywhere, counted }
    }

    pub(crate) fn counted(&self) -> Counted {
        self.counted
    }

    pub(crate) fn is_sound(&self, dimension: usize) -> bool {
        self.run.is_sound(dimension)
            && self.penalty.is_none_or(|it| it.is_finite() && it > 0.0)
            && self.counted.is_sound()
    }

    /// The next candidate, the same until it is told.
    pub(crate) fn ask(&self) -> Vec<f64> {
        self.run.ask().to_vec()
    }

    /// What breaking a limit by all of itself costs; by the cost of the first candidate if none was flown.
    pub(crate) fn penalty(&self, cost: f64) -> f64 {
        let size = if cost.is_finite() { cost.abs().max(1e-9) } else { 1.0 };
        self.penalty.unwrap_or(FIRST_PENALTY * size)
    }

    /// True where the slope of a candidate of that merit is needed.
    pub(crate) fn wants_slope(&self, merit: &Merit) -> bool {
        self.run.wants_slope(merit.value)
    }

    /// Takes a candidate's merit and its slope, with the loops that were analysed for it; `best` is the best candidate so
    /// far.
    pub(crate) fn tell(
        &mut self,
        merit: &Merit,
        penalty: f64,
        slope: Option<(Vec<f64>, usize)>,
        best: &[f64],
    ) {
        if merit.value.is_finite() {
            self.penalty.get_or_insert(penalty);
        }
        if let Some((_, analyses)) = &slope {
            self.counted.slopes += 1;
            self.counted.analyses += analyses;
        }
        let before = self.run.best().map(|(_, value)| value);
        self.run.tell(merit.value, slope.map(|(slope, _)| slope));
        if self.run.best().map(|(_, value)| value) != before {
            self.violation = merit.violation;
        }
        if self.run.is_over() {
            self.begin_again(best);
        }
    }

    /// From where it stands with a harsher penalty, if it ended beyond its limits; from elsewhere if not.
    fn begin_again(&mut self, best: &[f64]) {
        let here = self.run.best().map(|(point, _)| point.to_vec());
        if let Some(here) = here.filter(|_| self.violation > BEYOND && self.harsher < MOST_HARSHER)
        {
            self.run = Bfgs::at(&here);
            self.penalty = self.penalty.map(|it| HARSHER * it);
            self.harsher += 1;
            return;
        }
        let number = self.counted.descents as u64;
        self.counted.descents += 1;
        let spread = SPREADS[self.counted.descents % SPREADS.len()];
        let from = match self.anywhere {
            true => Bfgs::anywhere(best.len(), self.seed, number),
            false => Bfgs::near(best, spread, self.seed, number),
        };
        self.run = Bfgs::at(&from);
    }
}
