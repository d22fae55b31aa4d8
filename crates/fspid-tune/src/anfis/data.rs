//! What is learned from: rows of inputs and the answers that belong to them.

use std::collections::BTreeSet;
use std::fs::File;
use std::io::{self, BufRead, BufReader};
use std::path::Path;

use fspid_campaign::sample::{Cube, Sampling};
use fspid_fuzzy::system::{Parts, System};
use fspid_scenario::count::TAUGHT_POINTS;
use fspid_scenario::file::unread_in_words;
use fspid_study::rows::{self, RowAnswers, RowsError};

use super::error::AnfisError;

/// Most points of a grid.
const GRID_LIMIT: usize = TAUGHT_POINTS.most as usize;

/// Rows of inputs with the answers that belong to them, all finite.
#[derive(Clone, Debug, PartialEq)]
pub struct Data {
    inputs: usize,
    outputs: usize,
    /// Row after row, inputs first.
    values: Vec<f64>,
    /// Numbers of the rows, counted from 1 in the data as they were given.
    numbers: Vec<usize>,
}

/// A row of the data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DataRow<'d> {
    /// Its number in the data as they were given, counted from 1.
    pub number: usize,
    /// The inputs.
    pub inputs: &'d [f64],
    /// The answers.
    pub outputs: &'d [f64],
}

impl Data {
    /// No rows yet, of so many inputs and outputs.
    #[must_use]
    pub fn new(inputs: usize, outputs: usize) -> Self {
        Self { inputs, outputs, values: Vec::new(), numbers: Vec::new() }
    }

    /// Adds a row.
    ///
    /// # Errors
    /// [`AnfisError::Width`] for another number of inputs or outputs, [`AnfisError::NotFinite`].
    pub fn push(&mut self, inputs: &[f64], outputs: &[f64]) -> Result<(), AnfisError> {
        let row = self.len() + 1;
        if inputs.len() != self.inputs || outputs.len() != self.outputs {
            let (found, needed) = (inputs.len() + outputs.len(), self.inputs + self.outputs);
            return Err(AnfisError::Width { row, found, needed });
        }
        let numbers = inputs.iter().chain(outputs);
        if let Some(&found) = numbers.clone().find(|number| !number.is_finite()) {
            return Err(AnfisError::NotFinite { row, found });
        }
        self.values.extend(numbers);
        self.numbers.push(row);
        Ok(())
    }

    /// How many rows there are.
    #[must_use]
    pub fn len(&self) -> usize {
        self.numbers.len()
    }

    /// True without rows.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.numbers.is_empty()
    }

    /// How many inputs a row has.
    #[must_use]
    pub fn inputs(&self) -> usize {
        self.inputs
    }

    /// How many outputs a row has.
    #[must_use]
    pub fn outputs(&self) -> usize {
        self.outputs
    }

    /// The rows in order.
    pub fn rows(&self) -> impl Iterator<Item = DataRow<'_>> {
        let rows = self.values.chunks_exact((self.inputs + self.outputs).max(1));
        rows.zip(&self.numbers).map(|(row, &number)| {
            let (inputs, outputs) = row.split_at(self.inputs);
            DataRow { number, inputs, outputs }
        })
    }

    /// Reads a CSV table: a column for each input and each output of the system, found by its name;
    /// other columns are passed over.
    ///
    /// # Errors
    /// [`AnfisError::Table`] with the lines that are wrong; a number that is not finite is.
    pub fn read(parts: &Parts, table: &mut impl BufRead) -> Result<Self, AnfisError> {
        let inputs = parts.inputs.iter().map(|input| input.name.as_str());
        let outputs = parts.outputs.iter().map(|output| output.name.as_str());
        let columns = inputs.chain(outputs).collect();
        let data = Self::new(parts.inputs.len(), parts.outputs.len());
        let mut collector = Collector { columns, data };
        match rows::answer_rows(&mut collector, table, &mut io::sink()) {
            Ok(_) => Ok(collector.data),
            Err(RowsError::Problems { problems, .. }) => Err(AnfisError::Table { problems }),
            Err(error) => Err(AnfisError::Table { problems: vec![error.to_string()] }),
        }
    }

    /// Reads a CSV file, as [`read`](Self::read).
    ///
    /// # Errors
    /// As [`read`](Self::read); each problem begins with the path.
    pub fn load(parts: &Parts, path: &Path) -> Result<Self, AnfisError> {
        let named = |problem: String| format!("{}:{problem}", path.display());
        if path == Path::new("-") {
            return Self::read(parts, &mut io::stdin().lock());
        }
        let file = File::open(path);
        let file = file.map_err(|error| {
            let reason = format!(" cannot be read: {}", unread_in_words(&error));
            AnfisError::Table { problems: vec![named(reason)] }
        })?;
        Self::read(parts, &mut BufReader::new(file)).map_err(|error| match error {
            AnfisError::Table { problems } => {
                AnfisError::Table { problems: problems.into_iter().map(named).collect() }
            }
            other => other,
        })
    }

    /// What a teacher answers on an even grid over its universes, ends included; the last input runs
    /// fastest. Points at which it has no answer are left out.
    ///
    /// # Errors
    /// A teacher that is wrong, an input without a universe, a grid of fewer than two points along an
    /// input or of more than a million.
    pub fn taught(teacher: &Parts, points: &[usize]) -> Result<Self, AnfisError> {
        let system = System::new(teacher.clone()).map_err(AnfisError::System)?;
        let total = checked_grid(teacher, points)?;
        let mut data = Self::new(teacher.inputs.len(), teacher.outputs.len());
        let mut workspace = system.workspace();
        for index in 0..total {
            let inputs = grid_point(teacher, points, index)?;
            let answers = system
                .evaluate(&inputs, &mut workspace)
                .map_err(|reason| AnfisError::Input { row: index + 1, reason })?;
            let outputs: Option<Vec<f64>> = answers.iter().map(|answer| answer.value).collect();
            if let Some(outputs) = outputs {
                data.push(&inputs, &outputs)?;
            }
        }
        Ok(data)
    }

    /// The data in two: what is learned from, and a `share` of the rows, drawn with the seed, that
    /// only judges. Nothing judges where the share comes to less than half a row.
    #[must_use]
    pub fn split(&self, share: f64, seed: u64) -> (Self, Option<Self>) {
        let wanted = libm::round(share * self.len() as f64).max(0.0) as usize;
        let cube = Cube::new(Sampling::Random, 1, self.len().max(1) as u64, seed);
        let (Ok(cube), true) = (cube, wanted > 0) else {
            return (self.clone(), None);
        };
        let draw = |row: usize| {
            let mut number = [0.0];
            cube.point(row as u64, &mut number);
            number[0]
        };
        let mut order: Vec<(f64, usize)> = (0..self.len()).map(|row| (draw(row), row)).collect();
        order.sort_by(|one, other| one.0.total_cmp(&other.0).then(one.1.cmp(&other.1)));
        let mut judges = vec![false; self.len()];
        for &(_, row) in order.iter().take(wanted) {
            if let Some(place) = judges.get_mut(row) {
                *place = true;
            }
        }
        (self.chosen(&judges, false), Some(self.chosen(&judges, true)))
    }

    /// How many of these rows are among those of others, number by number.
    #[must_use]
    pub fn rows_among(&self, others: &Self) -> usize {
        // The two zeros are one number.
        let bits = |row: DataRow<'_>| {
            let numbers = row.inputs.iter().chain(row.outputs);
            numbers.map(|it| (it + 0.0).to_bits()).collect::<Vec<u64>>()
        };
        let known: BTreeSet<Vec<u64>> = others.rows().map(bits).collect();
        self.rows().filter(|row| known.contains(&bits(*row))).count()
    }

    /// The rows that are so marked.
    fn chosen(&self, marks: &[bool], wanted: bool) -> Self {
        let mut chosen = Self::new(self.inputs, self.outputs);
        for (row, _) in self.rows().zip(marks).filter(|(_, mark)| **mark == wanted) {
            chosen.values.extend(row.inputs.iter().chain(row.outputs));
            chosen.numbers.push(row.number);
        }
        chosen
    }
}

/// Collects the rows of a table.
struct Collector<'p> {
    columns: Vec<&'p str>,
    data: Data,
}

impl RowAnswers for Collector<'_> {
    fn inputs(&self) -> Vec<&str> {
        self.columns.clone()
    }

    fn outputs(&self) -> Vec<&str> {
        Vec::new()
    }

    fn check(&self, row: &[f64]) -> Result<(), String> {
        let mut cells = self.columns.iter().zip(row);
        match cells.find(|(_, number)| !number.is_finite()) {
            Some((name, number)) => Err(format!("{name} is {number}; allowed is a finite number")),
            None => Ok(()),
        }
    }

    fn answer(&mut self, row: &[f64], _: &mut String) -> Result<(), String> {
        self.check(row)?;
        let (inputs, outputs) = row.split_at(self.data.inputs.min(row.len()));
        self.data.push(inputs, outputs).map_err(|error| error.to_string())
    }
}

/// How many points the grid has.
fn checked_grid(teacher: &Parts, points: &[usize]) -> Result<usize, AnfisError> {
    let total = points.iter().try_fold(1_usize, |total, &points| total.checked_mul(points));
    let fits = points.len() == teacher.inputs.len() && points.iter().all(|&points| points >= 2);
    match total {
        Some(total) if fits && total <= GRID_LIMIT => Ok(total),
        _ => {
            let inputs = teacher.inputs.len();
            let allowed =
                format!("allowed are {inputs} counts of at least 2, {GRID_LIMIT} points in all");
            Err(AnfisError::Grid { found: points.to_vec(), allowed })
        }
    }
}

fn grid_point(teacher: &Parts, points: &[usize], index: usize) -> Result<Vec<f64>, AnfisError> {
    let mut rest = index;
    let mut inputs = Vec::with_capacity(points.len());
    for (input, &points) in teacher.inputs.iter().zip(points).rev() {
        let Some(universe) = input.universe else {
            return Err(AnfisError::NoUniverse { input: input.name.clone() });
        };
        let share = (rest % points) as f64 / (points - 1) as f64;
        rest /= points;
        // Each end exactly.
        inputs.push(universe.lower * (1.0 - share) + universe.upper * share);
    }
    inputs.reverse();
    Ok(inputs)
}
