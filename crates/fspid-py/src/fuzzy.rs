//! Fuzzy systems and supervisors: asked one by one and by the column, explained, audited, drawn.

use std::path::PathBuf;
use std::sync::Arc;

use fspid::core::fuzzy::{Answers, BatchError, Supervisor as Asked};
use fspid::fuzzy::system::System;
use fspid::scenario::fuzzy_system::{self, Format, LoadError, Options};
use fspid::scenario::supervisor::Question;
use fspid::study::fuzzy_system::{AuditQuestion, SliceQuestion, ask, audit, explain, slice};
use fspid::study::{inference, report};
use pyo3::prelude::*;
use pyo3::types::PyTuple;
use rayon::prelude::*;

use crate::answer::Answer;
use crate::array::{Column, same_length};
use crate::origin::Origin;
use crate::{error, interrupt};

/// A fuzzy system of any size.
#[pyclass(frozen, module = "fspid._core")]
pub(crate) struct FuzzySystem {
    system: Arc<System>,
    /// What was assumed while it was read.
    #[pyo3(get)]
    notes: Vec<String>,
    origin: Origin,
}

fn refused(py: Python<'_>, error: &LoadError) -> PyErr {
    match error {
        LoadError::Problems(found) => error::problems(py, found),
        _ => error::input(py, error),
    }
}

impl FuzzySystem {
    fn input_names(&self) -> Vec<String> {
        self.system.parts().inputs.iter().map(|input| input.name.clone()).collect()
    }
}

#[pymethods]
impl FuzzySystem {
    /// Reads a file, or takes what has this name.
    #[staticmethod]
    #[pyo3(signature = (name, range, defuzzifier, out_of_range, block, controller))]
    fn read(
        py: Python<'_>,
        name: &str,
        range: Option<f64>,
        defuzzifier: Option<&str>,
        out_of_range: Option<&str>,
        block: Option<&str>,
        controller: Option<&str>,
    ) -> PyResult<Self> {
        let sampling = defuzzifier;
        let options = Options { range, sampling, out_of_range, dialect: None, block, controller };
        let loaded = py.detach(|| fuzzy_system::load(name, options));
        let loaded = loaded.map_err(|found| refused(py, &found))?;
        // A name is that of a file, or of what the program carries; nothing is written over either.
        let origin = Origin::of([PathBuf::from(name)]);
        Ok(Self { system: Arc::new(loaded.system), notes: loaded.notes, origin })
    }

    /// Reads a text in a format, which is named by the ending of its files.
    #[staticmethod]
    fn parse(py: Python<'_>, text: &str, ending: &str) -> PyResult<Self> {
        let format = Format::of_ending(ending).ok_or_else(|| {
            let allowed = Format::endings_in_words();
            error::input(py, format_args!("the format is `{ending}`; allowed are {allowed}"))
        })?;
        let loaded = py.detach(|| fuzzy_system::read("text", text, format, Options::default()));
        let loaded = loaded.map_err(|found| refused(py, &found))?;
        let (system, origin) = (Arc::new(loaded.system), Origin::default());
        Ok(Self { system, notes: loaded.notes, origin })
    }

    /// Its name.
    #[getter]
    fn name(&self) -> &str {
        &self.system.parts().name
    }

    /// Inputs with the ends of their universes, none where there is no universe.
    #[getter]
    fn inputs(&self) -> Vec<(String, Option<(f64, f64)>)> {
        let ends =
            |input: &fspid::fuzzy::system::Input| input.universe.map(|it| (it.lower, it.upper));
        self.system.parts().inputs.iter().map(|input| (input.name.clone(), ends(input))).collect()
    }

    /// Names of the outputs.
    #[getter]
    fn outputs(&self) -> Vec<String> {
        self.system.parts().outputs.iter().map(|output| output.name.clone()).collect()
    }

    /// The answers at these inputs; none where there is no answer.
    fn infer(&self, py: Python<'_>, inputs: Vec<f64>) -> PyResult<Vec<Option<f64>>> {
        let mut workspace = self.system.workspace();
        let answers = self.system.evaluate(&inputs, &mut workspace);
        let answers = answers.map_err(|found| error::input(py, found))?;
        Ok(answers.iter().map(|answer| answer.value).collect())
    }

    /// The answers at many inputs, a column for each output; NaN where there is no answer.
    fn infer_many(&self, py: Python<'_>, inputs: &Bound<'_, PyTuple>) -> PyResult<Vec<Column>> {
        let columns = same_length(py, &self.input_names(), inputs)?;
        let system = Arc::clone(&self.system);
        let answered = interrupt::run(py, move || {
            let rows = columns.first().map_or(0, |column| column.as_slice().len());
            let mut workspace = system.workspace();
            let mut values = vec![Vec::with_capacity(rows); system.parts().outputs.len()];
            let mut inputs = vec![0.0; columns.len()];
            for row in 0..rows {
                for (input, column) in inputs.iter_mut().zip(&columns) {
                    *input = column.as_slice()[row];
                }
                let answers = system.evaluate(&inputs, &mut workspace);
                let answers = answers.map_err(|found| format!("row {row}: {found}"))?;
                for (values, answer) in values.iter_mut().zip(answers) {
                    values.push(answer.value.unwrap_or(f64::NAN));
                }
            }
            Ok(values)
        })?;
        let answered = answered.map_err(|found: String| error::input(py, found))?;
        Ok(self
            .outputs()
            .into_iter()
            .zip(answered)
            .map(|(name, it)| Column::new(name, it))
            .collect())
    }

    /// The answer of an output and its derivative by each input.
    fn gradient(
        &self,
        py: Python<'_>,
        inputs: Vec<f64>,
        output: usize,
    ) -> PyResult<(f64, Vec<f64>)> {
        let mut workspace = self.system.workspace();
        let found = self.system.differentiator().gradient(&inputs, output, &mut workspace);
        let found = found.map_err(|found| error::input(py, found))?;
        Ok((found.value, found.inputs))
    }

    /// As `fspid infer` answers.
    fn ask(&self, py: Python<'_>, values: Vec<String>) -> PyResult<Answer> {
        let asked = ask(&self.system, &values).map_err(|found| error::input(py, found))?;
        Ok(Answer::new(asked.text(), &asked.json(), true))
    }

    /// As `fspid explain` answers; the files are drawings.
    fn explain(
        &self,
        py: Python<'_>,
        values: Vec<String>,
        why_not: Option<&str>,
    ) -> PyResult<Answer> {
        let found = explain(&self.system, &values, why_not);
        let found = found.map_err(|found| error::input(py, found))?;
        let figures = found.figures().into_iter();
        let files = figures.map(|(name, svg)| (format!("{name}.svg"), svg.into_string())).collect();
        Ok(Answer::new(found.text(), &found.json(), true).with_files(files))
    }

    /// As `fspid audit` answers.
    fn audit(&self, py: Python<'_>, spans: Vec<String>, rest: Vec<String>) -> PyResult<Answer> {
        let system = Arc::clone(&self.system);
        let answer = interrupt::run(py, move || {
            let question = AuditQuestion { spans: &spans, rest: &rest, boxes: None };
            let found = audit(&system, &question).map_err(|found| found.to_string())?;
            let page = report::of_audit(&found);
            Ok(Answer::new(found.text(), &found.json(), true).with_page(page))
        })?;
        let answer = answer.map_err(|found: String| error::input(py, found))?;
        Ok(answer.from(self.origin.clone()))
    }

    /// As `fspid surface` answers: a drawing for each output, and the values as CSV.
    fn surface(
        &self,
        py: Python<'_>,
        x: Option<&str>,
        y: Option<&str>,
        fixed: Vec<String>,
        nodes: Option<usize>,
    ) -> PyResult<Answer> {
        let question = SliceQuestion { x, y, fixed: &fixed, spans: &[], output: None, nodes };
        let found = py.detach(|| slice(&self.system, &question));
        let found = found.map_err(|found| error::input(py, found))?;
        let figures = found.figures().into_iter();
        let mut files: Vec<_> =
            figures.map(|(name, svg)| (format!("{name}.svg"), svg.into_string())).collect();
        files.push(("values.csv".to_owned(), found.csv()));
        Ok(Answer::new(found.csv(), &found.json(), true).with_files(files))
    }
}

/// Answers of a block: they and their flags stay in the nearest caches, and a block is worth a thread.
const BLOCK: usize = 4096;

/// Increments of kp, ki and kd, block by block on all threads; the first inputs that are refused.
fn in_blocks(
    supervisor: &Asked<f64>,
    error: &[f64],
    change: &[f64],
) -> Result<[Vec<f64>; 3], BatchError> {
    let mut gains = [(); 3].map(|()| vec![0.0; error.len()]);
    let [kp, ki, kd] = &mut gains;
    let blocks = error
        .par_chunks(BLOCK)
        .zip(change.par_chunks(BLOCK))
        .zip(kp.par_chunks_mut(BLOCK).zip(ki.par_chunks_mut(BLOCK)).zip(kd.par_chunks_mut(BLOCK)));
    let answered = blocks.enumerate().filter_map(|(block, ((error, change), ((kp, ki), kd)))| {
        let (mut clamped, mut underflowed) = ([false; BLOCK], [false; BLOCK]);
        let (clamped, underflowed) = (&mut clamped[..error.len()], &mut underflowed[..error.len()]);
        let answers = Answers { kp, ki, kd, clamped, underflowed };
        let refused = supervisor.infer_many(error, change, answers).err()?;
        Some((block, refused))
    });
    match answered.min_by_key(|(block, _)| *block) {
        None => Ok(gains),
        Some((block, BatchError::Refused { index, error })) => {
            Err(BatchError::Refused { index: block * BLOCK + index, error })
        }
        Some((_, other)) => Err(other),
    }
}

/// The supervisor of a self-tuning controller: three increments of gains for an error and its change.
#[pyclass(frozen, module = "fspid._core")]
pub(crate) struct Supervisor {
    supervisor: Asked<f64>,
}

#[pymethods]
impl Supervisor {
    /// A rule table with a half range.
    #[new]
    fn new(
        py: Python<'_>,
        table: &str,
        range: f64,
        defuzzifier: &str,
        out_of_range: &str,
    ) -> PyResult<Self> {
        let question = Question { table, range, defuzzifier, out_of_range };
        let supervisor = question.supervisor().map_err(|found| error::input(py, found))?;
        Ok(Self { supervisor })
    }

    /// Half range of inputs and outputs.
    #[getter]
    fn range(&self) -> f64 {
        self.supervisor.range()
    }

    /// Increments of kp, ki and kd, whether an input was moved to the end of its range, and whether all rules underflowed.
    fn infer(&self, py: Python<'_>, error: f64, change: f64) -> PyResult<([f64; 3], bool, bool)> {
        let found = self.supervisor.infer(error, change).map_err(|it| error::input(py, it))?;
        let delta = found.delta;
        Ok(([delta.kp, delta.ki, delta.kd], found.clamped, found.underflowed))
    }

    /// As `fspid infer` answers.
    fn ask(&self, py: Python<'_>, error: f64, change: f64) -> PyResult<Answer> {
        let found = self.supervisor.infer(error, change).map_err(|it| error::input(py, it))?;
        Ok(Answer::new(inference::text(&found), &inference::json(&found), true))
    }

    /// Increments at many errors and changes, a column for each gain.
    fn infer_many(&self, py: Python<'_>, inputs: &Bound<'_, PyTuple>) -> PyResult<Vec<Column>> {
        let columns = same_length(py, &["error".to_owned(), "change".to_owned()], inputs)?;
        let supervisor = self.supervisor;
        let answered = interrupt::run(py, move || {
            let [error, change] = [columns[0].as_slice(), columns[1].as_slice()];
            in_blocks(&supervisor, error, change)
        })?;
        let answered = answered.map_err(|found| error::input(py, found))?;
        let names = ["delta_kp", "delta_ki", "delta_kd"];
        Ok(names
            .into_iter()
            .zip(answered)
            .map(|(name, it)| Column::new(name.to_owned(), it))
            .collect())
    }
}
