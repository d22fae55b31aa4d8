//! A search whose state is kept in a file, so that it goes on where it was after an interruption.

use std::path::{Path, PathBuf};

use fspid_optimise::Stop;
use fspid_study::output::{self, Locked, NotLocked, OutputError};

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
#[derive(Debug)]
pub struct Kept {
    /// None where nothing can be kept.
    path: Option<PathBuf>,
    unfit: Unfit,
    /// Two searches that keep their states in one file would each write over the other's, and then over its design.
    lock: Option<Locked>,
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
        Self { path, unfit, lock: None }
    }

    /// Kept beside a design that is written, where a state of another search is refused; beside the scenario where no
    /// design is, by the controller's name in those of files, where what is there stays.
    #[must_use]
    pub fn beside(design: Option<&Path>, scenario: Option<&Path>, file_name: &str) -> Self {
        let with = |path: &Path, ending: &str| {
            let mut name = path.as_os_str().to_owned();
            name.push(ending);
            PathBuf::from(name)
        };
        match design {
            Some(design) => Self::at(Some(with(design, ".state.json")), Unfit::Refused),
            None => {
                let ending = format!(".{file_name}.state.json");
                Self::at(scenario.map(|scenario| with(scenario, &ending)), Unfit::Left)
            }
        }
    }

    /// The search where it was, or from the start.
    ///
    /// # Errors
    /// A start without a cost, a state that is refused, and another process that searches there.
    pub fn begun<'a>(
        &mut self,
        problem: &'a TuningProblem,
        effort: &Effort,
        crew: Crew<'a>,
    ) -> Result<(Search<'a>, Beginning), TuneError> {
        let anew = || Search::begin(problem, effort.clone(), crew);
        if let Some(why) = self.locked()? {
            return Ok((anew()?, Beginning::Unkept(why)));
        }
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

    /// The search as its state was saved last, whoever goes on with it, to take what was found so far.
    ///
    /// # Errors
    /// No state, one of another search, and one that was changed after it was written.
    pub fn as_saved<'a>(
        &self,
        problem: &'a TuningProblem,
        effort: &Effort,
        crew: Crew<'a>,
    ) -> Result<Search<'a>, TuneError> {
        match self.path.as_deref() {
            Some(path) if path.exists() => resumed(path, (problem, crew), effort),
            path => Err(TuneError::State {
                path: path.map_or_else(String::new, |path| path.display().to_string()),
                reason: "there is none: no search was saved there that is not over".to_owned(),
            }),
        }
    }

    /// Keeps other processes away; why nothing is kept, where another one is there and nobody asked for a file.
    fn locked(&mut self) -> Result<Option<String>, TuneError> {
        let wants = self.unfit != Unfit::Replaced && self.lock.is_none();
        let Some(path) = self.path.clone().filter(|_| wants) else {
            return Ok(None);
        };
        match (Locked::beside(&path), self.unfit) {
            (Ok(lock), _) => self.lock = Some(lock),
            // It is told where the state cannot be written.
            (Err(NotLocked::Failed(_)), Unfit::Left) => {}
            (Err(NotLocked::Failed(reason)), _) => return Err(OutputError { path, reason }.into()),
            (Err(busy @ NotLocked::Busy), Unfit::Left) => {
                self.path = None;
                return Ok(Some(format!("{}: {busy}", path.display())));
            }
            (Err(NotLocked::Busy), _) => {
                return Err(TuneError::Busy { path: path.display().to_string() });
            }
        }
        Ok(None)
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
