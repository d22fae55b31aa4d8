//! A scenario: its text with changes, checked, and what can be asked of it.

use std::path::{Path, PathBuf};
use std::sync::{Arc, OnceLock};

use fspid::scenario::count::MAP_POINTS;
use fspid::scenario::file::{self, STARTERS, Study};
use fspid::study::analysis::{Analysis, BreakPoint, Question};
use fspid::study::report;
use fspid::study::simulation::Simulation;
use fspid::study::verify;
use fspid::tune::{Source, TuneError, Written};
use pyo3::prelude::*;
use tempfile::TempDir;

use crate::answer::{Answer, Flight};
use crate::origin::Origin;
use crate::{error, interrupt};

/// A scenario without a mistake.
#[pyclass(frozen, module = "fspid._core")]
pub(crate) struct Scenario {
    text: String,
    /// Its file; none for one that was made in memory.
    path: Option<PathBuf>,
    /// From where it names files; none for a scenario that can name none.
    folder: Option<PathBuf>,
    overrides: Vec<String>,
    study: Arc<Study>,
    origin: Origin,
    /// Where one that was made in memory is written for what reads files.
    written: OnceLock<TempDir>,
}

impl Scenario {
    fn new(
        py: Python<'_>,
        text: String,
        path: Option<PathBuf>,
        folder: Option<PathBuf>,
        overrides: Vec<String>,
    ) -> PyResult<Self> {
        let name = name_of(path.as_deref());
        let study = py.detach(|| file::parse(&text, &name, folder.as_deref(), &overrides));
        let study = Arc::new(study.map_err(|found| error::problems(py, &found))?);
        let named = study.files.iter().map(|file| folder.iter().map(move |it| it.join(file)));
        let origin = Origin::of(path.iter().cloned().chain(named.flatten()));
        Ok(Self { text, path, folder, overrides, study, origin, written: OnceLock::new() })
    }

    /// The files that its answers are made of.
    pub(crate) fn made_of(&self) -> Origin {
        self.origin.clone()
    }

    /// The same with those of all cases of its tuning and its contest.
    pub(crate) fn made_of_all(&self, source: &Source) -> Result<Origin, TuneError> {
        let Some(folder) = &self.folder else { return Ok(self.made_of()) };
        Ok(self.origin.with(source.files()?.iter().map(|file| folder.join(file))))
    }

    pub(crate) fn study(&self) -> &Study {
        &self.study
    }

    pub(crate) fn shared_study(&self) -> Arc<Study> {
        Arc::clone(&self.study)
    }

    /// Its text, its name in messages, and from where it names files.
    pub(crate) fn origin(&self) -> (&str, String, Option<&Path>) {
        (&self.text, name_of(self.path.as_deref()), self.folder.as_deref())
    }

    /// Asks something of its text.
    pub(crate) fn written<T>(&self, ask: impl FnOnce(&Written<'_>) -> T) -> T {
        let (text, name, folder) = self.origin();
        ask(&Written { text, name: &name, folder, overrides: &self.overrides })
    }

    /// What tunings and contests read.
    pub(crate) fn source(&self, py: Python<'_>) -> PyResult<Source> {
        Ok(Source { path: self.file(py)?, overrides: self.overrides.clone() })
    }

    /// Its own file, beside which a search without a design keeps its state.
    pub(crate) fn kept_beside(&self) -> Option<PathBuf> {
        self.path.clone()
    }

    pub(crate) fn overrides(&self) -> &[String] {
        &self.overrides
    }

    /// A file with its text.
    pub(crate) fn file(&self, py: Python<'_>) -> PyResult<PathBuf> {
        if let Some(path) = &self.path {
            let now = file::read_text(path).map_err(|found| error::load(py, &found))?;
            if now == self.text {
                return Ok(path.clone());
            }
            let path = path.display();
            return Err(error::input(
                py,
                format_args!("{path} has changed since it was read; read it again"),
            ));
        }
        if let Some(folder) = self.written.get() {
            return Ok(folder.path().join(NAME));
        }
        let folder = tempfile::tempdir()?;
        std::fs::write(folder.path().join(NAME), &self.text)?;
        Ok(self.written.get_or_init(|| folder).path().join(NAME))
    }
}

/// What a scenario without a file is called in messages.
const NAME: &str = "scenario.toml";

fn name_of(path: Option<&Path>) -> String {
    path.map_or_else(|| NAME.to_owned(), |path| path.display().to_string())
}

#[pymethods]
impl Scenario {
    /// Reads a file.
    #[staticmethod]
    fn read(py: Python<'_>, path: PathBuf, overrides: Vec<String>) -> PyResult<Self> {
        let text = file::read_text(&path).map_err(|found| error::load(py, &found))?;
        let folder = path.parent().map(Path::to_owned);
        Self::new(py, text, Some(path), folder, overrides)
    }

    /// Reads a text.
    #[staticmethod]
    fn parse(py: Python<'_>, text: String, overrides: Vec<String>) -> PyResult<Self> {
        Self::new(py, text, None, None, overrides)
    }

    /// The same with more changes.
    fn changed(&self, py: Python<'_>, overrides: Vec<String>) -> PyResult<Self> {
        let all = self.overrides.iter().cloned().chain(overrides).collect();
        Self::new(py, self.text.clone(), self.path.clone(), self.folder.clone(), all)
    }

    /// Another scenario, which names files from where this one does: a design of it.
    fn beside(&self, py: Python<'_>, text: String) -> PyResult<Self> {
        Self::new(py, text, None, self.folder.clone(), Vec::new())
    }

    /// From where it names files; None for one that can name none.
    #[getter]
    fn folder(&self) -> Option<PathBuf> {
        self.folder.clone()
    }

    /// Files that it names, with all cases of its tuning and its contest, as they are named there.
    fn files(&self, py: Python<'_>) -> PyResult<Vec<String>> {
        self.source(py)?.files().map_err(|found| error::tune(py, &found))
    }

    /// Its text, without its changes.
    #[getter]
    fn text(&self) -> &str {
        &self.text
    }

    /// Its changes, as `--set` takes them.
    #[getter(overrides)]
    fn given_overrides(&self) -> Vec<String> {
        self.overrides.clone()
    }

    /// Its name; empty for none.
    #[getter]
    fn name(&self) -> &str {
        &self.study.scenario.name
    }

    /// SHA-256 of everything that it says.
    #[getter]
    fn digest(&self) -> &str {
        &self.study.digest
    }

    /// What is allowed and probably not meant.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.study.warnings.clone()
    }

    /// Names of its controllers, in their order.
    #[getter]
    pub(crate) fn controllers(&self) -> Vec<String> {
        self.study.scenario.flyers().map(|flyer| flyer.name().to_owned()).collect()
    }

    /// Checks what its dispersions draw, and the cases of its tuning and its contest.
    fn check(&self, py: Python<'_>) -> PyResult<()> {
        let checked = py.detach(|| self.written(|written| written.check()));
        checked.map_err(|wrong| error::not_right(py, &wrong))
    }

    /// Every place that can be changed, as `fspid check --paths` prints it.
    fn paths(&self, py: Python<'_>) -> PyResult<Answer> {
        let rows = file::paths(&self.file(py)?, &self.overrides);
        let rows = rows.map_err(|found| error::load(py, &found))?;
        let answer = Answer::new(file::paths_text(&rows), &file::paths_json(&rows), true);
        Ok(answer.from(self.made_of()))
    }

    /// Flies it.
    fn simulate(&self, py: Python<'_>) -> PyResult<Flight> {
        let study = Arc::clone(&self.study);
        let flown = interrupt::run(py, move || Simulation::of(&study))?;
        let simulation = flown.map_err(|found| error::input(py, found))?;
        Ok(Flight::new(Arc::clone(&self.study), simulation, self.made_of()))
    }

    /// Margins of its loops.
    fn analyse(
        &self,
        py: Python<'_>,
        broken_at: &str,
        map_points: usize,
        fly: bool,
    ) -> PyResult<Answer> {
        let point = match broken_at {
            "command" => BreakPoint::Command,
            "pitch" => BreakPoint::Pitch,
            "rate" => BreakPoint::Rate,
            _ => {
                let message =
                    format!("broken_at is `{broken_at}`; allowed is command, pitch or rate");
                return Err(error::input(py, message));
            }
        };
        MAP_POINTS.check(map_points).map_err(|found| error::input(py, found))?;
        let study = Arc::clone(&self.study);
        let question = Question { point, map_points, fly, ..Question::default() };
        let answer = interrupt::run(py, move || {
            let analysis = Analysis::of(&study, question)?;
            let page = report::of_analysis(&study, &analysis)?;
            let answer = Answer::new(analysis.text(), &analysis.json(), analysis.all_held());
            Ok::<_, fspid::sim::SimError>(answer.with_page(page).with_curves(analysis.open_loops()))
        })?;
        let answer = answer.map_err(|found| error::input(py, found))?;
        Ok(answer.from(self.made_of()))
    }

    /// Judges its requirements, those of ready sets and of files; the files replay what is not met.
    fn verify(
        &self,
        py: Python<'_>,
        sets: Vec<String>,
        requirement_files: Vec<PathBuf>,
        replays: PathBuf,
    ) -> PyResult<Answer> {
        let path = self.file(py)?;
        let settings: Vec<String> = self.overrides.iter().cloned().chain(sets).collect();
        let origin = self.origin.with(requirement_files.iter().cloned());
        let answer = interrupt::run(py, move || {
            let requirement_files: Vec<&Path> =
                requirement_files.iter().map(AsRef::as_ref).collect();
            let question = verify::Question {
                path: &path,
                settings: &settings,
                requirement_files: &requirement_files,
            };
            let found = verify::verify(&question)?;
            let good = found.unmet() == 0 && found.failed_flights.is_empty();
            let files = found.replays(&replays).into_iter().map(|it| (it.name, it.text)).collect();
            let answer = Answer::new(found.text(None), &found.json(None), good);
            Ok::<_, verify::VerifyError>(answer.with_files(files))
        })?;
        Ok(answer.map_err(|found| error::verify(py, &found))?.from(origin))
    }
}

/// A scenario that comes with fspid.
#[pyfunction]
pub(crate) fn preset(py: Python<'_>, name: &str) -> PyResult<&'static str> {
    let known = presets();
    known.iter().find(|preset| preset.name == name).map(|preset| preset.text).ok_or_else(|| {
        let names: Vec<&str> = known.iter().map(|preset| preset.name.as_str()).collect();
        let known = file::known_words(name, &names);
        error::input(py, format_args!("there is no scenario `{name}`{known}"))
    })
}

/// Names of all scenarios that come with fspid, each with what it is about.
#[pyfunction(name = "presets")]
pub(crate) fn preset_names() -> Vec<(String, String)> {
    presets().into_iter().map(|preset| (preset.name, preset.about)).collect()
}

struct Preset {
    name: String,
    about: String,
    text: &'static str,
}

/// Those to begin with, and those of the paper; rule tables and fuzzy systems are none.
fn presets() -> Vec<Preset> {
    let named = |text| file::parse(text, "preset", None, &[]).ok().map(|study| study.scenario.name);
    let starters = STARTERS.iter().filter(|it| named(it.text).is_some());
    let starters = starters.map(|it| Preset {
        name: it.name.to_owned(),
        about: it.about.to_owned(),
        text: it.text,
    });
    let of_the_paper = fspid_data::PAPER.iter().filter_map(|&(name, text)| {
        let name = format!("paper/{}", name.strip_suffix(".toml")?);
        Some(Preset { name, about: named(text)?, text })
    });
    starters.chain(of_the_paper).collect()
}
