//! A job at work: where its files lie, whether it shall stop, what it tells and how it ends.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use fspid_campaign::CampaignError;
use fspid_scenario::file::{self, LoadError, Template};
use fspid_study::output::{self, OutputError};
use fspid_tune::{Source, TuneError};
use serde_json::{Value, json};

use super::asked::{Asked, Work};
use super::job::Job;
use super::memory;
use crate::scenarios::digest;

/// How often progress is told.
const PERIOD: Duration = Duration::from_millis(100);

/// How a job ends.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Ended {
    /// With what it found.
    Done(Value),
    Cancelled,
    /// Why, and every problem of the scenario if it is that.
    Failed(String, Option<Value>),
}

impl Ended {
    pub(super) fn failed(reason: impl ToString) -> Self {
        Self::Failed(reason.to_string(), None)
    }

    pub(super) fn state(&self) -> &'static str {
        match self {
            Self::Done(_) => "done",
            Self::Cancelled => "cancelled",
            Self::Failed(..) => "failed",
        }
    }

    /// What it found, or why it found nothing: `{reason, problems}`.
    pub(super) fn json(&self) -> Value {
        match self {
            Self::Done(found) => found.clone(),
            Self::Cancelled => json!({}),
            Self::Failed(reason, problems) => json!({ "reason": reason, "problems": problems }),
        }
    }
}

impl From<LoadError> for Ended {
    fn from(error: LoadError) -> Self {
        let problems = match &error {
            LoadError::Problems(problems) => Some(problems.to_json()),
            LoadError::Unreadable { .. } => None,
        };
        Self::Failed(error.to_string(), problems)
    }
}

impl From<TuneError> for Ended {
    fn from(error: TuneError) -> Self {
        match error {
            TuneError::Stopped | TuneError::NotKept => Self::Cancelled,
            TuneError::Campaign(CampaignError::Stopped) => Self::Cancelled,
            error => Self::Failed(error.to_string(), error.problems()),
        }
    }
}

impl From<CampaignError> for Ended {
    fn from(error: CampaignError) -> Self {
        match error {
            CampaignError::Stopped => Self::Cancelled,
            error => Self::failed(error),
        }
    }
}

impl From<OutputError> for Ended {
    fn from(error: OutputError) -> Self {
        Self::failed(error)
    }
}

/// What a job may take.
#[derive(Clone, Copy, Debug)]
pub(super) struct Bounds {
    /// Time.
    pub(super) longest: Duration,
    /// Memory.
    pub(super) bytes: u64,
}

/// When a job shall stop.
#[derive(Clone, Debug)]
pub(super) struct Stopping {
    job: Arc<Job>,
    begun: Instant,
    bounds: Bounds,
}

impl Stopping {
    pub(super) fn is_asked(&self) -> bool {
        self.job.is_cancelled()
            || self.job.is_outgrown()
            || self.begun.elapsed() >= self.bounds.longest
    }
}

/// A job at work.
pub(super) struct Task<'a> {
    pub(super) job: &'a Job,
    /// The scenario with its changes.
    pub(super) source: Source,
    pub(super) template: Template,
    /// Where it keeps what it writes: the same for the same work on the same scenario, so that it goes on there.
    pub(super) folder: PathBuf,
    pub(super) stopping: Stopping,
    /// What the scenario's file held when it began.
    seen: String,
}

impl<'a> Task<'a> {
    pub(super) fn begin(
        job: &'a Arc<Job>,
        asked: &Asked,
        path: PathBuf,
        (place, bounds): (&Path, Bounds),
    ) -> Result<Self, Ended> {
        let seen = text_digest(&path)?;
        let source = Source { path, overrides: asked.work.overrides().to_vec() };
        let template = Template::load(&source.path, &source.overrides)?;
        let study = template.study();
        memory::check(&asked.work, study, bounds.bytes)?;
        let all = format!("{:?} {}", asked.work, study.digest);
        let mut name = digest(all.as_bytes());
        name.truncate(16);
        let folder = place.join(format!("{}-{name}", asked.work.kind()));
        output::make_folder(&folder)?;
        job.keeps_in(&folder);
        study.warnings.iter().for_each(|warning| job.tell("warning", &json!({ "text": warning })));
        let stopping = Stopping { job: Arc::clone(job), begun: Instant::now(), bounds };
        Ok(Self { job, source, template, folder, stopping, seen })
    }

    pub(super) fn work(&self, work: &Work) -> Result<Value, Ended> {
        let bytes = self.stopping.bounds.bytes;
        let done = memory::watched(self.job, bytes, || match work {
            Work::Tune(tune) => tune.work(self),
            Work::Campaign(campaign) => campaign.work(self),
            Work::Contest(contest) => contest.work(self),
            Work::Certify(certify) => certify.work(self),
            Work::Check(check) => check.work(self),
        });
        match done {
            Err(Ended::Cancelled) if self.job.is_cancelled() => Err(Ended::Cancelled),
            Err(Ended::Cancelled) if self.job.is_outgrown() => Err(memory::too_large(bytes)),
            Err(Ended::Cancelled) => Err(self.too_long()),
            done => done,
        }
    }

    fn too_long(&self) -> Ended {
        let hours = self.stopping.bounds.longest.as_secs_f64() / 3600.0;
        Ended::failed(format_args!("a job may take {hours} h here; the command line has no limit"))
    }

    pub(super) fn tell(&self, name: &'static str, data: &Value) {
        self.job.tell(name, data);
    }

    /// Tells how far it is: so many of so many.
    pub(super) fn progress(&self, done: u64, total: u64, what: &str) {
        self.job.progress(done, total, what);
    }

    /// True once somebody has cancelled it, or it took too long.
    pub(super) fn is_stopped(&self) -> bool {
        self.stopping.is_asked()
    }

    /// Whether the file of the scenario is the one that was read. Places in its text mean nothing in another one.
    pub(super) fn is_as_seen(&self) -> bool {
        text_digest(&self.source.path).is_ok_and(|now| now == self.seen)
    }
}

fn text_digest(path: &Path) -> Result<String, Ended> {
    Ok(digest(file::read_text(path)?.as_bytes()))
}

/// When something is told next.
#[derive(Debug)]
pub(super) struct Pace(Option<Instant>);

impl Pace {
    pub(super) fn new() -> Self {
        Self(None)
    }

    /// True if it is time; the first time it is.
    pub(super) fn is_due(&mut self, period: Duration) -> bool {
        let is_due = self.0.is_none_or(|told| told.elapsed() >= period);
        if is_due {
            self.0 = Some(Instant::now());
        }
        is_due
    }

    /// The same for progress.
    pub(super) fn is_time_to_tell(&mut self) -> bool {
        self.is_due(PERIOD)
    }
}
