//! What was found out, as it crosses over: sentences, JSON, a page, columns.

use std::path::PathBuf;
use std::sync::Arc;

use fspid::scenario::file::Study;
use fspid::study::analysis::Columns;
use fspid::study::report::{self, traces::Drawing};
use fspid::study::simulation::Simulation;
use pyo3::prelude::*;

use crate::array::Column;
use crate::origin::Origin;

/// Width of a drawing in a notebook, px.
const WIDTH_PX: f64 = 760.0;

/// An answer: what a person reads, what a program reads, and whether all is well.
#[pyclass(frozen, module = "fspid._core")]
pub(crate) struct Answer {
    /// For people, as the program prints it.
    #[pyo3(get)]
    text: String,
    /// For programs, as the program prints it.
    #[pyo3(get)]
    json: String,
    /// What the program says by its exit code: true for 0.
    #[pyo3(get)]
    good: bool,
    /// A page that opens offline, where there is one.
    #[pyo3(get)]
    page: Option<String>,
    /// Files that go with it, each with its name.
    #[pyo3(get)]
    files: Vec<(String, String)>,
    /// Curves that go with it, each with its name and columns.
    #[pyo3(get)]
    curves: Vec<(String, Vec<Column>)>,
    origin: Origin,
}

impl Answer {
    pub(crate) fn new(text: String, json: &serde_json::Value, good: bool) -> Self {
        let json = fspid::study::json::answer_text(json);
        let (files, curves, origin) = (Vec::new(), Vec::new(), Origin::default());
        Self { text, json, good, page: None, files, curves, origin }
    }

    pub(crate) fn with_page(self, page: String) -> Self {
        Self { page: Some(page), ..self }
    }

    pub(crate) fn with_curves(self, curves: Vec<(String, Columns)>) -> Self {
        let column = |(name, values): (&str, Vec<f64>)| Column::new(name.to_owned(), values);
        let curve = |(name, columns): (String, Columns)| {
            (name, columns.into_iter().map(column).collect::<Vec<_>>())
        };
        Self { curves: curves.into_iter().map(curve).collect(), ..self }
    }

    pub(crate) fn with_files(self, files: Vec<(String, String)>) -> Self {
        Self { files, ..self }
    }

    /// The same of these files, over which it is not written.
    pub(crate) fn from(self, origin: Origin) -> Self {
        Self { origin, ..self }
    }
}

#[pymethods]
impl Answer {
    /// Writes the page, whole or not at all.
    fn save_page(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        self.origin.write(py, &path, self.page.as_deref().unwrap_or_default())
    }

    /// Writes the files into a folder, all of them or none; their paths.
    fn save_files(&self, py: Python<'_>, folder: PathBuf) -> PyResult<Vec<PathBuf>> {
        self.origin.write_all(py, &folder, &self.files)
    }
}

/// A scenario that was flown.
#[pyclass(frozen, module = "fspid._core")]
pub(crate) struct Flight {
    study: Arc<Study>,
    simulation: Simulation,
    origin: Origin,
}

impl Flight {
    pub(crate) fn new(study: Arc<Study>, simulation: Simulation, origin: Origin) -> Self {
        Self { study, simulation, origin }
    }
}

#[pymethods]
impl Flight {
    /// For people, as the program prints it.
    #[getter]
    fn text(&self) -> String {
        self.simulation.text()
    }

    /// For programs, as the program prints it.
    #[getter]
    fn json(&self) -> String {
        fspid::study::json::answer_text(&self.simulation.json())
    }

    /// True where every requirement is met and no flight fails.
    #[getter]
    fn good(&self) -> bool {
        self.simulation.requirements_met() && self.simulation.failed_flights().is_empty()
    }

    /// Names of the controllers, in the order of the scenario.
    #[getter]
    fn controllers(&self) -> Vec<String> {
        self.simulation.results.iter().map(|result| result.name.clone()).collect()
    }

    /// The columns of a controller's flight.
    fn columns(&self, controller: &str) -> Option<Vec<Column>> {
        let columns = self.simulation.result(controller)?.columns();
        Some(columns.into_iter().map(|(name, values)| Column::new(name, values)).collect())
    }

    /// All traces as CSV, as `fspid simulate --trace` writes them.
    fn csv(&self) -> String {
        self.simulation.csv()
    }

    /// The report, as `fspid simulate --report` writes it.
    fn page(&self) -> String {
        report::of_simulation(&self.study, &self.simulation)
    }

    /// Writes all traces as CSV, whole or not at all.
    fn save_csv(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        self.origin.write(py, &path, &self.csv())
    }

    /// Writes the report, whole or not at all.
    fn save_page(&self, py: Python<'_>, path: PathBuf) -> PyResult<()> {
        self.origin.write(py, &path, &self.page())
    }

    /// The time response as SVG.
    fn svg(&self) -> String {
        let drawing = Drawing {
            title: &self.simulation.scenario,
            scenario: &self.study.scenario,
            simulation: &self.simulation,
            only: &[],
            detailed: true,
            width_px: WIDTH_PX,
        };
        drawing.render().into_string()
    }
}
