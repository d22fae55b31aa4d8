//! Which flights failed, over the parameters of their runs: read from the file in two passes.

use crate::rows::{FAILED, PARAMETER, RUN};
use crate::summary::{Files, SummaryError};
use crate::table::{ColumnTable, Values};

/// Flights that failed, and all of them, in a box.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Counts {
    pub(super) failed: u64,
    pub(super) all: u64,
}

impl Counts {
    fn add(&mut self, failed: bool) {
        self.all += 1;
        self.failed += u64::from(failed);
    }
}

/// What is counted for one controller.
#[derive(Clone, Debug, Default)]
pub(super) struct ByParameter {
    /// For each parameter: its bins.
    pub(super) alone: Vec<Vec<Counts>>,
    /// For each pair of parameters, in the order of [`pairs`]: rows of the second, columns of the first.
    pub(super) together: Vec<Vec<Vec<Counts>>>,
    /// Runs over the first two parameters: those that did not fail, and those that did.
    pub(super) passed: Vec<(f64, f64)>,
    pub(super) failed: Vec<(f64, f64)>,
    /// Numbers of the runs of both.
    pub(super) runs: [Vec<u64>; 2],
}

/// Most points of each kind that are kept.
pub(super) const MOST_FAILED: usize = 1500;
pub(super) const MOST_PASSED: usize = 2000;

/// Pairs of so many parameters, the first two first.
pub(super) fn pairs(parameters: usize) -> Vec<(usize, usize)> {
    let all = (0..parameters).flat_map(|b| (0..b).map(move |a| (a, b)));
    all.collect()
}

/// What is counted, and between which ends.
pub(super) struct Counted {
    /// Smallest and largest value of each parameter.
    pub(super) ends: Vec<(f64, f64)>,
    /// One a controller.
    pub(super) of: Vec<ByParameter>,
}

/// What is counted of a flight.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Event {
    /// That it failed.
    Failed,
    /// That a value lies beyond a limit.
    Beyond {
        /// Column of the value.
        column: String,
        /// Limit of each controller; NaN where it has none.
        limits: Vec<f64>,
        /// True where values above it count, false where those below do.
        above: bool,
    },
}

impl Event {
    fn column(&self) -> &str {
        match self {
            Self::Failed => FAILED,
            Self::Beyond { column, .. } => column,
        }
    }

    /// Whether it happened in each row of a table that begins with that row of the file.
    fn happened(&self, table: &ColumnTable, first: usize, controllers: usize) -> Vec<bool> {
        match self {
            Self::Failed => booleans(table),
            Self::Beyond { column, limits, above } => {
                let values = floats(table, column).into_iter().enumerate();
                let beyond = |(at, value): (usize, f64)| {
                    let limit = limits.get((first + at) % controllers.max(1));
                    let limit = limit.copied().unwrap_or(f64::NAN);
                    if *above { value > limit } else { value < limit }
                };
                values.map(beyond).collect()
            }
        }
    }
}

/// Counts an event over some parameters, in so many bins of equal width each; `None` where a parameter has no
/// values, or they are all the same.
///
/// # Errors
/// A file that cannot be read.
pub(super) fn counted(
    files: &Files,
    parameters: &[String],
    event: &Event,
    (controllers, bins): (usize, usize),
) -> Result<Option<Counted>, SummaryError> {
    let columns: Vec<String> = parameters.iter().map(|name| format!("{PARAMETER}{name}")).collect();
    let Some(ends) = ends(files, &columns)? else { return Ok(None) };
    let axes = Axes { ends, pairs: pairs(parameters.len()) };
    let empty = ByParameter {
        alone: vec![vec![Counts::default(); bins]; parameters.len()],
        together: vec![vec![vec![Counts::default(); bins]; bins]; axes.pairs.len()],
        ..ByParameter::default()
    };
    let mut of = vec![empty; controllers.max(1)];
    let mut names: Vec<&str> = columns.iter().map(String::as_str).collect();
    names.extend([event.column(), RUN]);
    let mut row = 0_usize;
    for table in files.columns(&names)? {
        let table = table?;
        let failed = event.happened(&table, row, controllers);
        let runs = floats(&table, RUN);
        let numbers: Vec<Vec<f64>> = columns.iter().map(|name| floats(&table, name)).collect();
        for (at, failed) in failed.into_iter().enumerate() {
            let place = row % controllers.max(1);
            row += 1;
            let value = |n: usize| numbers.get(n).and_then(|it| it.get(at)).copied();
            let values: Vec<f64> =
                (0..columns.len()).map(|n| value(n).unwrap_or(f64::NAN)).collect();
            if values.iter().all(|value| value.is_finite()) {
                of[place].add(&values, &axes, (failed, runs[at] as u64));
            }
        }
    }
    Ok(Some(Counted { ends: axes.ends, of }))
}

/// The ends of each parameter, and which pairs of parameters are counted together.
struct Axes {
    ends: Vec<(f64, f64)>,
    pairs: Vec<(usize, usize)>,
}

impl ByParameter {
    fn add(&mut self, values: &[f64], axes: &Axes, (failed, run): (bool, u64)) {
        let bins = self.alone.first().map_or(1, Vec::len);
        let bin = |n: usize| place(values[n], axes.ends[n], bins);
        for (n, counts) in self.alone.iter_mut().enumerate() {
            counts[bin(n)].add(failed);
        }
        for (grid, (a, b)) in self.together.iter_mut().zip(&axes.pairs) {
            grid[bin(*b)][bin(*a)].add(failed);
        }
        if let [x, y, ..] = *values {
            let (list, most) = match failed {
                true => (&mut self.failed, MOST_FAILED),
                false => (&mut self.passed, MOST_PASSED),
            };
            if list.len() < most {
                list.push((x, y));
                self.runs[usize::from(failed)].push(run);
            }
        }
    }
}

/// The bin of a value; the last one holds its upper end.
fn place(value: f64, (lo, hi): (f64, f64), bins: usize) -> usize {
    (((value - lo) / (hi - lo) * bins as f64) as usize).min(bins.saturating_sub(1))
}

fn ends(files: &Files, columns: &[String]) -> Result<Option<Vec<(f64, f64)>>, SummaryError> {
    let mut found = vec![None::<(f64, f64)>; columns.len()];
    let names: Vec<&str> = columns.iter().map(String::as_str).collect();
    for table in files.columns(&names)? {
        let table = table?;
        for (found, name) in found.iter_mut().zip(columns) {
            for value in floats(&table, name).into_iter().filter(|value| value.is_finite()) {
                *found =
                    Some(found.map_or((value, value), |(lo, hi)| (lo.min(value), hi.max(value))));
            }
        }
    }
    let wide = |(lo, hi): &(f64, f64)| lo < hi && (hi - lo).is_finite();
    Ok(found.into_iter().map(|ends| ends.filter(wide)).collect())
}

/// Numbers of a column, NaN where there is none.
fn floats(table: &ColumnTable, name: &str) -> Vec<f64> {
    match table.column(name) {
        Ok(Values::Float(cells)) => cells.iter().map(|cell| cell.unwrap_or(f64::NAN)).collect(),
        Ok(Values::Integer(cells)) => {
            cells.iter().map(|cell| cell.map_or(f64::NAN, |whole| whole as f64)).collect()
        }
        _ => vec![f64::NAN; table.rows()],
    }
}

fn booleans(table: &ColumnTable) -> Vec<bool> {
    match table.column(FAILED) {
        Ok(Values::Boolean(cells)) => cells.iter().map(|cell| *cell == Some(true)).collect(),
        _ => vec![false; table.rows()],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_ends_of_a_parameter_are_in_a_bin() {
        let bin = |value| place(value, (1.0, 2.0), 4);
        assert_eq!([bin(1.0), bin(1.24), bin(1.26), bin(2.0)], [0, 0, 1, 3]);
    }

    #[test]
    fn the_first_pair_is_that_of_the_first_two() {
        assert_eq!(pairs(3), [(0, 1), (0, 2), (1, 2)]);
        assert!(pairs(1).is_empty());
    }
}
