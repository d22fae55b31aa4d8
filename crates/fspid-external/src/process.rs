//! The simulator's side: a process for each flight.

use std::ffi::OsString;
use std::io;
use std::net::Shutdown;
use std::os::fd::OwnedFd;
use std::os::unix::net::UnixStream;
use std::os::unix::process::{CommandExt as _, ExitStatusExt as _};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::Duration;

use fspid_sim::core::{Sample, Step};
use fspid_sim::external::{Answers, Contents, Host, Lost};
use fspid_sim::{ControllerLoss, External, ExternalSource, SimError};
use tempfile::TempDir;

use crate::archive::unpack;
use crate::frame::{Start, read_answer, write_sample};

/// The longest time for loading a controller: no library of a controller takes as many seconds, however busy a machine is.
const LOAD_LIMIT: Duration = Duration::from_secs(30);
/// How long a process has to end once nobody asks any more: what it has to print is printed by then.
const END_LIMIT: Duration = Duration::from_secs(1);
/// How often, and how far apart, it is looked whether a process has ended whose socket is closed: a second in all.
const ENDING_LOOKS: u32 = 500;
const ENDING_PAUSE: Duration = Duration::from_millis(2);
/// Of the period: how far a controller's may lie beside the scenario's. A period in 32 bits is near enough.
const SAME_PERIOD: f64 = 1e-6;

/// What a process is told that its controller is.
pub(crate) const LIBRARY: &str = "library";
pub(crate) const FMU: &str = "fmu";

/// What is wrong with a machine, or with an FMU.
enum Unspawned {
    Host(io::Error),
    Archive(String),
}

impl From<io::Error> for Unspawned {
    fn from(error: io::Error) -> Self {
        Self::Host(error)
    }
}

/// The folder of an unpacked FMU.
fn unpacked(path: &Path, contents: Option<&Contents>) -> Result<TempDir, Unspawned> {
    let folder = tempfile::tempdir()?;
    let archive = contents.map_or_else(|| std::fs::read(path).map(Into::into), |it| Ok(it.0.clone()))?;
    unpack(&archive, folder.path()).map_err(|error| match error.kind() {
        // What the reader of archives says; all else is the system's.
        io::ErrorKind::InvalidData => Unspawned::Archive(error.to_string()),
        _ => Unspawned::Host(error),
    })?;
    Ok(folder)
}

const CHANGED: &str = "the file has changed since it was read; begin again with what it is now, or put back what it was";

/// Starts a process of a program for each flight.
#[derive(Clone, Debug)]
pub struct ProcessHost {
    program: PathBuf,
    arguments: Vec<OsString>,
}

impl ProcessHost {
    /// The program, and the arguments with which it calls [`serve`](crate::serve) with the kind, the period and the path
    /// that follow them.
    #[must_use]
    pub fn new(program: PathBuf, arguments: &[&str]) -> Self {
        Self { program, arguments: arguments.iter().map(OsString::from).collect() }
    }

    fn spawn(&self, external: &External) -> Result<Process, Unspawned> {
        let (stream, theirs) = UnixStream::pair()?;
        let (kind, folder) = match &external.source {
            ExternalSource::Library(_) => (LIBRARY, None),
            ExternalSource::Fmu(path) => (FMU, Some(unpacked(path, external.contents.as_ref())?)),
        };
        let path = folder.as_ref().map_or(external.source.path(), TempDir::path);
        let child = Command::new(&self.program)
            .args(&self.arguments)
            .args([kind, &format!("{:?}", external.dt_s)])
            .arg(path)
            .stdin(Stdio::from(OwnedFd::from(theirs)))
            // Standard output holds our own answers.
            .stdout(Stdio::from(io::stderr()))
            // Ctrl-C is for us: a flight that was begun is no crash of its controller.
            .process_group(0)
            .spawn()?;
        Ok(Process {
            child,
            stream,
            sample: 0,
            limit_s: external.answer_limit_s,
            is_lost: false,
            _folder: folder,
        })
    }
}

impl Host for ProcessHost {
    fn start(&self, external: &External) -> Result<Box<dyn Answers>, SimError> {
        let file = external.source.path().display().to_string();
        let spawned = self.spawn(external).and_then(|mut process| {
            let start = process.begin()?;
            require_unchanged(external)?;
            Ok((process, start))
        });
        let (process, start) = spawned.map_err(|error| match error {
            Unspawned::Host(reason) => {
                SimError::Host { file: file.clone(), reason: reason.to_string() }
            }
            Unspawned::Archive(reason) => {
                let allowed = "an FMU, which is a zip archive, whole and without encryption";
                SimError::NotStarted { file: file.clone(), reason, allowed: allowed.to_owned() }
            }
        })?;
        let refused = |reason, allowed| Err(SimError::NotStarted { file, reason, allowed });
        match start {
            Ok(Start::Ready { period_s }) if is_period(period_s, external.dt_s) => {
                Ok(Box::new(process))
            }
            Ok(Start::Ready { period_s }) => refused(
                format!(
                    "its period is {period_s:?} s, and the scenario samples every {:?} s",
                    external.dt_s
                ),
                "the same period, or 0 for a controller that has none".to_owned(),
            ),
            Ok(Start::Refused { reason, allowed }) => refused(reason, allowed),
            // Crashing before the first sample is as much of a verdict as crashing at it.
            Err(loss) => Ok(Box::new(Lost(loss))),
        }
    }
}

/// Refuses a library that is another one than was read: what is told of a flight would be told of that one. An FMU is
/// unpacked from what was read; a library has to be loaded where it lies, for it may look for others beside itself.
fn require_unchanged(External { source, contents, .. }: &External) -> io::Result<()> {
    let (ExternalSource::Library(path), Some(Contents(bytes))) = (source, contents) else {
        return Ok(());
    };
    match std::fs::read(path).is_ok_and(|found| found == **bytes) {
        true => Ok(()),
        false => Err(io::Error::other(CHANGED)),
    }
}

/// Written so that NaN is none.
fn is_period(period_s: f64, dt_s: f64) -> bool {
    period_s == 0.0 || (period_s - dt_s).abs() <= SAME_PERIOD * dt_s
}

/// A controller in flight.
struct Process {
    child: Child,
    stream: UnixStream,
    /// Number of the next sample.
    sample: u64,
    limit_s: f64,
    /// True once there is nothing more to wait for.
    is_lost: bool,
    /// What an FMU was unpacked into, removed behind it.
    _folder: Option<TempDir>,
}

impl Process {
    /// Its first words, or how it was lost before them.
    fn begin(&mut self) -> io::Result<Result<Start, ControllerLoss>> {
        self.stream.set_read_timeout(Some(LOAD_LIMIT))?;
        let start = Start::read(&mut self.stream);
        let start = start.map_err(|error| self.lost(&error, LOAD_LIMIT.as_secs_f64()));
        self.stream.set_read_timeout(Some(Duration::from_secs_f64(self.limit_s)))?;
        Ok(start)
    }

    /// What an error of the conversation means.
    fn lost(&mut self, error: &io::Error, limit_s: f64) -> ControllerLoss {
        use io::ErrorKind::{BrokenPipe, ConnectionReset, TimedOut, UnexpectedEof, WouldBlock};
        self.is_lost = true;
        match error.kind() {
            WouldBlock | TimedOut => ControllerLoss::Silent { limit_s },
            UnexpectedEof | BrokenPipe | ConnectionReset => {
                self.ended().map_or(ControllerLoss::NoAnswer, of_status)
            }
            _ => ControllerLoss::NoAnswer,
        }
    }

    /// What it ended with: its socket closes a moment before that is known. None for one that goes on without it.
    fn ended(&mut self) -> Option<ExitStatus> {
        for _ in 0..ENDING_LOOKS {
            if let Ok(Some(status)) = self.child.try_wait() {
                return Some(status);
            }
            std::thread::sleep(ENDING_PAUSE);
        }
        None
    }
}

fn of_status(status: ExitStatus) -> ControllerLoss {
    match (status.signal(), status.code()) {
        (Some(signal), _) => ControllerLoss::Crashed { signal },
        (None, code) => ControllerLoss::Ended { code: code.unwrap_or_default() },
    }
}

impl Answers for Process {
    fn answer(&mut self, sample: Sample<f64>) -> Result<Step<f64>, ControllerLoss> {
        let limit_s = self.limit_s;
        let written = write_sample(&mut self.stream, &sample);
        let read = written.and_then(|()| read_answer(&mut self.stream));
        let answer = read.map_err(|error| self.lost(&error, limit_s))?;
        let (number, step) = answer.map_err(|status| ControllerLoss::Refused { status })?;
        if number != self.sample {
            self.is_lost = true;
            return Err(ControllerLoss::NoAnswer);
        }
        self.sample += 1;
        match step.command_rad.is_finite() {
            true => Ok(step),
            false => Err(ControllerLoss::NotFinite),
        }
    }
}

impl Drop for Process {
    /// Lets it end; one that does not is ended.
    fn drop(&mut self) {
        if !self.is_lost {
            let _ = self.stream.shutdown(Shutdown::Write);
            let _ = self.stream.set_read_timeout(Some(END_LIMIT));
            // Its side closes when it has ended; anything else is passed over.
            let _ = io::copy(&mut self.stream, &mut io::sink());
        }
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
