//! Long work on threads: begun, followed, cancelled; so many at a time, so many that wait, and no more.

mod asked;
mod campaign;
mod certify;
mod check;
mod contest;
mod job;
mod memory;
mod place;
mod proof;
mod rest;
mod run;
mod task;
mod tune;

use std::collections::{BTreeMap, VecDeque};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;

use serde_json::{Value, json};

use crate::answer::Refusal;
use crate::settings::Limits;

pub(crate) use asked::Asked;
pub(crate) use job::{Event, Job};
pub(crate) use place::Place;
pub(crate) use run::{report, run};
use task::{Bounds, Ended, Task};

/// Jobs that have ended and can still be asked for.
const REMEMBERED: usize = 32;

/// All jobs of a server.
#[derive(Debug)]
pub(crate) struct Jobs {
    state: Mutex<State>,
    /// Told when a thread has ended.
    ended: Condvar,
    /// Where they keep what they write.
    place: Place,
    most: usize,
    queue: usize,
    bounds: Bounds,
}

#[derive(Debug, Default)]
struct State {
    jobs: BTreeMap<u64, Arc<Job>>,
    /// What waits, in its order.
    waiting: VecDeque<(u64, Asked, PathBuf)>,
    running: usize,
    last: u64,
    closed: bool,
}

impl Jobs {
    pub(crate) fn new(place: Place, limits: &Limits) -> Arc<Self> {
        let (state, ended) = (Mutex::default(), Condvar::new());
        let Limits { jobs: most, queue, job: longest, job_bytes: bytes, .. } = *limits;
        let bounds = Bounds { longest, bytes };
        Arc::new(Self { state, ended, place, most, queue, bounds })
    }

    /// Begins a job on the scenario at a path, or puts it behind those that wait; its id.
    pub(crate) fn begin(self: &Arc<Self>, asked: Asked, path: PathBuf) -> Result<String, Refusal> {
        let mut state = self.state();
        if state.closed {
            return Err(Refusal::busy("the server is ending"));
        }
        if state.running >= self.most && state.waiting.len() >= self.queue {
            let (running, waiting) = (state.running, state.waiting.len());
            return Err(Refusal::busy(format_args!(
                "{running} running and {waiting} waiting jobs are all there may be; cancel one, or wait"
            )));
        }
        state.last += 1;
        let id = state.last;
        let job = Arc::new(Job::new(id, asked.work.kind(), &asked.scenario, asked.options.clone()));
        state.jobs.insert(id, job);
        state.waiting.push_back((id, asked, path));
        state.forget();
        self.go_on(&mut state);
        Ok(id.to_string())
    }

    /// Begins what waits, as far as there is room.
    fn go_on(self: &Arc<Self>, state: &mut State) {
        while state.running < self.most && !state.closed {
            let Some((id, asked, path)) = state.waiting.pop_front() else { return };
            let Some(job) = state.jobs.get(&id).cloned() else { continue };
            state.running += 1;
            let (all, mine) = (Arc::clone(self), Arc::clone(&job));
            let work = move || {
                all.work(&mine, &asked, path);
                all.leave();
            };
            if let Err(reason) = thread::Builder::new().name("job".to_owned()).spawn(work) {
                state.running -= 1;
                job.end(&Ended::failed(format_args!("no thread can be had: {reason}")));
            }
        }
    }

    fn work(&self, job: &Arc<Job>, asked: &Asked, path: PathBuf) {
        job.begin();
        let work = || {
            let place = self.place.path();
            let place =
                place.map_err(|reason| Ended::failed(format_args!("no place: {reason}")))?;
            Task::begin(job, asked, path, (&place, self.bounds))?.work(&asked.work)
        };
        // What a job has seen in between is not looked at again.
        let ended = catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|_| {
            Err(Ended::failed(
                "a mistake in fspid; standard error says more, and the server goes on",
            ))
        });
        job.end(&ended.map_or_else(|ended| ended, Ended::Done));
    }

    fn leave(self: &Arc<Self>) {
        let mut state = self.state();
        state.running -= 1;
        self.go_on(&mut state);
        self.ended.notify_all();
    }

    /// The job with an id.
    pub(crate) fn find(&self, id: &str) -> Result<Arc<Job>, Refusal> {
        let found = id.parse().ok().and_then(|id: u64| self.state().jobs.get(&id).cloned());
        found.ok_or_else(|| Refusal::missing("there is no such job"))
    }

    /// Asks a job to stop; one that waits ends at once, one that has ended stays as it is.
    pub(crate) fn cancel(&self, id: &str) -> Result<Value, Refusal> {
        let job = self.find(id)?;
        let mut state = self.state();
        let before = state.waiting.len();
        state.waiting.retain(|(waiting, ..)| *waiting != job.id());
        job.cancel();
        if state.waiting.len() < before {
            job.end(&Ended::Cancelled);
        }
        Ok(job.told())
    }

    /// Every job that is known, the newest first.
    pub(crate) fn list(&self) -> Value {
        self.state().jobs.values().rev().map(|job| job.told()).collect()
    }

    /// How many there are, and may be.
    pub(crate) fn counts(&self) -> Value {
        let state = self.state();
        let (running, waiting) = (state.running, state.waiting.len());
        json!({ "running": running, "most": self.most, "waiting": waiting, "most_waiting": self.queue })
    }

    /// Ends all of them, and begins none any more; comes back when no thread works.
    pub(crate) fn close(&self) {
        let mut state = self.state();
        state.closed = true;
        for (id, ..) in std::mem::take(&mut state.waiting) {
            state.jobs.get(&id).into_iter().for_each(|job| job.end(&Ended::Cancelled));
        }
        state.jobs.values().for_each(|job| job.cancel());
        while state.running > 0 {
            state = self.ended.wait(state).unwrap_or_else(PoisonError::into_inner);
        }
        self.place.remove();
    }

    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl State {
    /// Forgets the oldest of those that have ended, where there are many.
    fn forget(&mut self) {
        let ended = self.jobs.values().filter(|job| job.is_over()).map(|job| job.id());
        let ended: Vec<u64> = ended.collect();
        for id in ended.iter().take(ended.len().saturating_sub(REMEMBERED)) {
            self.jobs.remove(id);
        }
    }
}
