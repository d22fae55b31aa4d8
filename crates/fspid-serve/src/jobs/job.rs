//! A job and what it has told: a list of events with numbers, so that a client can go on where it was.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, MutexGuard, OnceLock, PoisonError};

use axum::body::Bytes;
use fspid_campaign::Progress;
use fspid_diagnostics::digits::grouped;
use serde_json::{Value, json};
use tokio::sync::watch;

use super::task::Ended;

/// Events of a job that are kept; of more, the first are lost for who has not seen them.
const MOST_EVENTS: usize = 4096;
/// Bytes of events that are kept, some more with the last.
const MOST_BYTES: usize = 16 * 1024 * 1024;

/// Something that is told.
#[derive(Clone, Debug)]
pub(crate) struct Event {
    /// Its number, where it can be asked for again.
    id: Option<u64>,
    name: &'static str,
    data: String,
}

impl Event {
    pub(crate) fn new(name: &'static str, data: &Value) -> Self {
        Self { id: None, name, data: data.to_string() }
    }

    /// As the stream writes it; JSON without line ends has none.
    pub(crate) fn piece(&self) -> Bytes {
        let id = self.id.map_or(String::new(), |id| format!("id: {id}\n"));
        format!("{id}event: {}\ndata: {}\n\n", self.name, self.data).into()
    }
}

/// Events from one on.
#[derive(Debug)]
pub(crate) struct Events {
    pub(crate) events: Vec<Event>,
    /// Number of the next one.
    pub(crate) next: u64,
    /// How many were asked for and are not kept any more.
    pub(crate) lost: u64,
    /// Whether there are no more now.
    pub(crate) is_all: bool,
    /// Whether there will be no more.
    pub(crate) is_over: bool,
}

/// Long work that somebody has asked for.
#[derive(Debug)]
pub(crate) struct Job {
    id: u64,
    kind: &'static str,
    scenario: String,
    /// What was asked for, as it was asked.
    options: Value,
    /// Where it keeps what it writes, once it has begun.
    folder: OnceLock<PathBuf>,
    log: Mutex<Log>,
    news: watch::Sender<()>,
    cancelled: AtomicBool,
    outgrown: AtomicBool,
    /// How far a campaign is; it is stopped by this.
    pub(super) campaign: Progress,
}

#[derive(Debug)]
struct Log {
    state: &'static str,
    events: VecDeque<Event>,
    bytes: usize,
    /// Number of the first that is kept.
    first: u64,
}

impl Job {
    pub(super) fn new(id: u64, kind: &'static str, scenario: &str, options: Value) -> Self {
        let log = Log { state: "waiting", events: VecDeque::new(), bytes: 0, first: 0 };
        Self {
            id,
            kind,
            scenario: scenario.to_owned(),
            options,
            folder: OnceLock::new(),
            log: Mutex::new(log),
            news: watch::Sender::new(()),
            cancelled: AtomicBool::new(false),
            outgrown: AtomicBool::new(false),
            campaign: Progress::default(),
        }
    }

    pub(super) fn id(&self) -> u64 {
        self.id
    }

    /// `{job, kind, scenario, options, state}`
    pub(super) fn told(&self) -> Value {
        let state = self.log().state;
        json!({
            "job": self.id.to_string(), "kind": self.kind, "scenario": self.scenario,
            "options": self.options, "state": state,
        })
    }

    pub(super) fn kind(&self) -> &'static str {
        self.kind
    }

    /// Remembers where it keeps what it writes.
    pub(super) fn keeps_in(&self, folder: &Path) {
        // A job begins once.
        let _ = self.folder.set(folder.to_owned());
    }

    /// Where it keeps what it writes; none before it has begun.
    pub(super) fn folder(&self) -> Option<&Path> {
        self.folder.get().map(PathBuf::as_path)
    }

    pub(super) fn begin(&self) {
        self.log().state = "running";
    }

    /// Keeps an event, and tells those who follow.
    pub(super) fn tell(&self, name: &'static str, data: &Value) {
        self.log().push(Event::new(name, data));
        self.news.send_replace(());
    }

    /// Tells how far it is: so many of so many.
    pub(super) fn progress(&self, done: u64, total: u64, what: &str) {
        let text = format!("{} of {} {what}", grouped(done), grouped(total));
        self.tell("progress", &json!({ "done": done, "total": total, "text": text }));
    }

    /// The last event.
    pub(super) fn end(&self, ended: &Ended) {
        {
            let mut log = self.log();
            log.push(Event::new(ended.state(), &ended.json()));
            log.state = ended.state();
        }
        self.news.send_replace(());
    }

    /// Asks it to stop.
    pub(super) fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
        self.campaign.stop();
    }

    pub(super) fn is_cancelled(&self) -> bool {
        self.cancelled.load(Ordering::Relaxed)
    }

    /// Has it stop, for it takes more memory than it may.
    pub(super) fn outgrow(&self) {
        self.outgrown.store(true, Ordering::Relaxed);
        self.campaign.stop();
    }

    pub(super) fn is_outgrown(&self) -> bool {
        self.outgrown.load(Ordering::Relaxed)
    }

    pub(super) fn is_over(&self) -> bool {
        self.log().is_over()
    }

    /// Tells of news, for one who follows.
    pub(crate) fn news(&self) -> watch::Receiver<()> {
        self.news.subscribe()
    }

    /// Events from a number on, so many at most.
    pub(crate) fn events(&self, from: u64, most: usize) -> Events {
        let log = self.log();
        let end = log.first + log.events.len() as u64;
        // A number that was never given is one of another server: what there is, is news.
        let from = if from > end { 0 } else { from };
        let begin = from.max(log.first);
        let skipped = usize::try_from(begin - log.first).unwrap_or(usize::MAX);
        let events: Vec<Event> = log.events.iter().skip(skipped).take(most).cloned().collect();
        let next = begin + events.len() as u64;
        Events { next, lost: begin - from, is_all: next == end, is_over: log.is_over(), events }
    }

    fn log(&self) -> MutexGuard<'_, Log> {
        self.log.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl Log {
    fn push(&mut self, mut event: Event) {
        event.id = Some(self.first + self.events.len() as u64);
        self.bytes += event.data.len();
        self.events.push_back(event);
        while self.events.len() > MOST_EVENTS || (self.bytes > MOST_BYTES && self.events.len() > 1)
        {
            let Some(gone) = self.events.pop_front() else { return };
            self.bytes -= gone.data.len();
            self.first += 1;
        }
    }

    fn is_over(&self) -> bool {
        !["waiting", "running"].contains(&self.state)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_comes_back_gets_what_came_since_and_is_told_what_is_lost() {
        let job = Job::new(7, "tune", "a", json!({}));
        (0..5).for_each(|number| job.tell("progress", &json!({ "number": number })));
        let found = job.events(3, 1);
        assert_eq!((found.next, found.lost, found.is_all, found.is_over), (4, 0, false, false));
        assert_eq!(found.events[0].piece(), "id: 3\nevent: progress\ndata: {\"number\":3}\n\n");
        for _ in 0..MOST_EVENTS {
            job.tell("progress", &json!(null));
        }
        job.end(&Ended::Done(json!({})));
        let found = job.events(2, 10);
        assert_eq!((found.lost, found.next, found.is_over), (4, 16, true));
        let all = job.events(found.next, usize::MAX);
        assert!(all.is_all && all.next == 5 + MOST_EVENTS as u64 + 1);
        assert_eq!(all.events.last().expect("the end").name, "done");
        // Numbers of another server.
        assert_eq!(job.events(1_000_000, 1).lost, 6);
    }

    #[test]
    fn events_take_no_more_memory_than_they_may() {
        let job = Job::new(1, "campaign", "a", json!({}));
        let large = json!("x".repeat(MOST_BYTES / 3));
        (0..9).for_each(|_| job.tell("rows", &large));
        let kept = job.events(0, usize::MAX);
        assert!(kept.events.len() == 2 && kept.lost == 7, "{} kept", kept.events.len());
    }
}
