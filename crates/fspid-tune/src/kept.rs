//! A search whose state is kept in a file, so that it goes on where it was after an interruption.

use std::path::{Path, PathBuf};

use fspid_optimise::Stop;
use fspid_study::output;

use crate::crew::Crew;
use crate::error::TuneError;
use crate::problem::TuningProblem;
use crate::sealed;
use crate::search::{Effort, Search, State};

/// What is done before the next generation.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Then {
    /// Nothing.
    GoOn,
    /// The state of the search is saved.
    Save,
    /// The state of the search is saved, and it ends there until it is begun again.
    Stop,
}

/// What becomes of a state that is there and of another search, or cannot be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unfit {
    /// It is told, and nothing is searched: somebody asked for a file there.
    Refused,
    /// It stays as it is, and the search keeps no state: hours of somebody's work may be in it.
    Left,
    /// It is written over, unless it was changed after it was written.
    Replaced,
}

/// Where the state of a search is kept while it goes on.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Kept {
    /// None where nothing can be kept.
    path: Option<PathBuf>,
    unfit: Unfit,
}

/// How a search began.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Beginning {
    /// At its start.
    Anew,
    /// Where it was: from which file.
    Resumed(PathBuf),
    /// At its start, without a place for its state: what is there is not its own, and why.
    Unkept(String),
}

impl Kept {
    /// Kept in this file, if there is one.
    #[must_use]
    pub fn at(path: Option<PathBuf>, unfit: Unfit) -> Self {
        Self { path, unfit }
    }

    /// Kept beside a design that is written, where a state of another search is refused; beside the scenario where no
    /// design is, for the controller of that name, where what is there stays.
    #[must_use]
    pub fn beside(design: Option<&Path>, scenario: Option<&Path>, controller: &str) -> Self {
        let with = |path: &Path, ending: &str| {
            let mut name = path.as_os_str().to_owned();
            name.push(ending);
            PathBuf::from(name)
        };
        match design {
            Some(design) => Self::at(Some(with(design, ".state.json")), Unfit::Refused),
            None => {
                let ending = format!(".{}.state.json", output::file_name(controller));
                Self::at(scenario.map(|scenario| with(scenario, &ending)), Unfit::Left)
            }
        }
    }

    /// The search where it was, or from the start.
    ///
    /// # Errors
    /// A start without a cost, and a state that is refused.
    pub fn begun<'a>(
        &mut self,
        problem: &'a TuningProblem,
        effort: &Effort,
        crew: Crew<'a>,
    ) -> Result<(Search<'a>, Beginning), TuneError> {
        let anew = || Search::begin(problem, effort.clone(), crew);
        let Some(path) = self.path.clone().filter(|path| path.exists()) else {
            return Ok((anew()?, Beginning::Anew));
        };
        match (resumed(&path, (problem, crew), effort), self.unfit) {
            (Ok(search), _) => Ok((search, Beginning::Resumed(path))),
            (Err(TuneError::State { .. }), Unfit::Replaced) => Ok((anew()?, Beginning::Anew)),
            (
                Err(TuneError::State { path, reason } | TuneError::Changed { path, reason }),
                Unfit::Left,
            ) => {
                self.path = None;
                Ok((anew()?, Beginning::Unkept(format!("{path}: {reason}"))))
            }
            (Err(error), _) => Err(error),
        }
    }

    /// Searches to the end; `then` is asked before each generation.
    ///
    /// # Errors
    /// [`TuneError::Stopped`] where `then` or the crew says so, [`TuneError::NotKept`] if the state could not be kept then, a
    /// crew that could not fly, and a state that somebody asked for and that cannot be written.
    pub fn search(
        &self,
        search: &mut Search<'_>,
        then: &mut dyn FnMut(&Search<'_>) -> Then,
    ) -> Result<Stop, TuneError> {
        loop {
            match then(search) {
                Then::GoOn => {}
                Then::Save => {
                    self.save(search)?;
                }
                Then::Stop => return Err(self.left(search, TuneError::Stopped)),
            }
            match search.advance() {
                Ok(None) => {}
                Ok(Some(stop)) => return Ok(stop),
                Err(error) => return Err(self.left(search, error)),
            }
        }
    }

    /// What is told of a search that does not go on, and why: its state is saved.
    #[must_use]
    pub fn left(&self, search: &Search<'_>, why: TuneError) -> TuneError {
        match (self.save(search), why) {
            (Ok(false), TuneError::Stopped) => TuneError::NotKept,
            (Err(error), TuneError::Stopped) => error,
            (_, why) => why,
        }
    }

    /// Whether it could be kept.
    fn save(&self, search: &Search<'_>) -> Result<bool, TuneError> {
        let Some(path) = &self.path else {
            return Ok(false);
        };
        match output::write(path, sealed::text(&search.state())) {
            Ok(()) => Ok(true),
            // Nobody asked for a file there: the folder may be one that nobody may write to.
            Err(_) if self.unfit == Unfit::Left => Ok(false),
            Err(error) => Err(error.into()),
        }
    }

    /// Removes the state: that of a search that is over is of no use any more.
    ///
    /// # Errors
    /// The file that could not be removed.
    pub fn remove(&self) -> Result<(), &Path> {
        let Some(path) = self.path.as_deref().filter(|path| path.exists()) else {
            return Ok(());
        };
        std::fs::remove_file(path).map_err(|_| path)
    }
}

fn resumed<'a>(
    path: &Path,
    who: (&'a TuningProblem, Crew<'a>),
    effort: &Effort,
) -> Result<Search<'a>, TuneError> {
    let state: State = sealed::read_file(path)?;
    Search::resume(who, effort, state, &path.display().to_string())
}
