//! What a piece of a campaign says, such that pieces add up: merging is associative in every bit.
//!
//! Values follow each other; where they are too many, quantiles come from counts on a fixed grid and moments from exact
//! sums. What is named (the worst, the highest, the first) is chosen by value, then by run. Pieces are merged in the order
//! of their runs; how they are grouped, and by how many threads, does not show.

use rayon::prelude::*;

use super::SummaryError;
use super::flights::{self, Flights};
use super::measures::{self, Cells, Finite};
use super::requirements::{self, Tally};
use super::sensitivity::Factors;
use super::source::{Piece, Source};
use crate::table::Column;

/// What some of the rows say.
pub(super) struct Partial<F> {
    /// One a controller.
    pub(super) flights: Vec<Flights>,
    /// For each requirement, one a controller.
    pub(super) tallies: Vec<Vec<Tally>>,
    /// For each column of numbers, one a controller.
    pub(super) cells: Vec<Vec<Cells<F>>>,
    pub(super) factors: Factors,
}

impl<F: Finite> Partial<F> {
    /// Of all rows of a source.
    pub(super) fn of(source: &Source) -> Result<Self, SummaryError> {
        let asked = source.requirements();
        let tallies = asked.iter().map(|asked| requirements::tallies(source, asked));
        let columns: Vec<&Column> = source.measures().collect();
        let cells = columns.iter().map(|column| measures::read(source, &column.name));
        Ok(Self {
            flights: flights::read(source)?,
            tallies: tallies.collect::<Result<_, _>>()?,
            cells: cells.collect::<Result<_, _>>()?,
            factors: Factors::read(source)?,
        })
    }

    /// Of parts, each of which is read, checked and left again, on the threads of the pool; `None` without one.
    pub(super) fn of_pieces(pieces: &[Piece<'_>]) -> Option<Result<Self, SummaryError>> {
        let partials = pieces.par_iter().map(|piece| Self::of(&piece.open()?));
        partials.try_reduce_with(|earlier, later| Ok(earlier.merged(later)))
    }

    /// With what later rows say.
    fn merged(mut self, later: Self) -> Self {
        self.flights.iter_mut().zip(later.flights).for_each(|(mine, theirs)| mine.merge(theirs));
        for (mine, theirs) in self.tallies.iter_mut().zip(later.tallies) {
            mine.iter_mut().zip(theirs).for_each(|(mine, theirs)| mine.merge(theirs));
        }
        for (mine, theirs) in self.cells.iter_mut().zip(later.cells) {
            mine.iter_mut().zip(theirs).for_each(|(mine, theirs)| mine.merge(theirs));
        }
        self.factors.append(later.factors);
        self
    }
}
