//! The simulator's side: a process for each flight.

use std::ffi::OsString;
use std::io::{self, PipeReader, Read as _, Write as _};
use std::net::Shutdown;
use std::os::fd::OwnedFd;
use std::os::unix::net::UnixStream;
use std::os::unix::process::{CommandExt as _, ExitStatusExt as _};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::Arc;
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::sync::mpsc::{Receiver, channel};
use std::time::Duration;

use fspid_sim::core::{Sample, Step};
use fspid_sim::external::{Answers, Host, Renamed};
use fspid_sim::{ControllerLoss, External, ExternalSource, SimError};
use tempfile::TempDir;

use crate::archive::{archive, unpack};
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

/// The folder of an unpacked FMU.
fn unpacked(path: &Path) -> io::Result<TempDir> {
    let folder = tempfile::tempdir()?;
    unpack(&archive(path)?, folder.path())?;
    Ok(folder)
}

/// Starts a process of a program for each flight.
#[derive(Clone, Debug)]
pub struct ProcessHost {
    program: PathBuf,
    arguments: Vec<OsString>,
    /// What is still passed on of what controllers print, bytes; nothing where all is.
    prints: Option<Arc<AtomicU64>>,
}

impl ProcessHost {
    /// The program, and the arguments with which it calls [`serve`](crate::serve) with the kind, the period, the path
    /// and the names that follow them.
    #[must_use]
    pub fn new(program: PathBuf, arguments: &[&str]) -> Self {
        Self { program, arguments: arguments.iter().map(OsString::from).collect(), prints: None }
    }

    /// The same that passes on so many bytes of what all controllers print, and drops the rest: whoever does not read our
    /// standard error stops neither them nor us.
    #[must_use]
    pub fn printing_at_most(self, bytes: u64) -> Self {
        Self { prints: Some(Arc::new(AtomicU64::new(bytes))), ..self }
    }

    /// Where a controller prints, and what says that it has ended. Standard output holds our own answers.
    fn prints(&self) -> io::Result<(Printer, [Stdio; 2])> {
        let Some(left) = self.prints.clone() else {
            return Ok((Printer(None), [Stdio::from(io::stderr()), Stdio::inherit()]));
        };
        let (reader, writer) = io::pipe()?;
        let both = [Stdio::from(writer.try_clone()?), Stdio::from(writer)];
        let (ended, wait) = channel();
        std::thread::spawn(move || {
            pass_on(reader, &left);
            let _ = ended.send(());
        });
        Ok((Printer(Some(wait)), both))
    }

    fn spawn(&self, external: &External) -> io::Result<Process> {
        let (stream, theirs) = UnixStream::pair()?;
        let (kind, folder) = match &external.source {
            ExternalSource::Library(_) => (LIBRARY, None),
            ExternalSource::Fmu(path) => (FMU, Some(unpacked(path)?)),
        };
        let path = folder.as_ref().map_or(external.source.path(), TempDir::path);
        let (printer, [output, errors]) = self.prints()?;
        let child = Command::new(&self.program)
            .args(&self.arguments)
            .args([kind, &format!("{:?}", external.dt_s)])
            .arg(path)
            .args(external.renamed.iter().map(written))
            .stdin(Stdio::from(OwnedFd::from(theirs)))
            .stdout(output)
            .stderr(errors)
            // Ctrl-C is for us: a flight that was begun is no crash of its controller.
            .process_group(0)
            .spawn()?;
        Ok(Process {
            child,
            stream,
            sample: 0,
            limit_s: external.answer_limit_s,
            is_lost: false,
            printer,
            _folder: folder,
        })
    }
}

/// A name of an FMU's variable, as [`serve`](crate::serve) reads it.
fn written(renamed: &Renamed) -> String {
    format!("{}={}", renamed.place.key(renamed.in_degrees), renamed.name)
}

/// What hears that all was passed on that a controller printed; nothing where it prints itself.
#[derive(Debug)]
struct Printer(Option<Receiver<()>>);

/// Passes on what is left to be passed on, and reads the rest, so that nobody waits.
fn pass_on(mut reader: PipeReader, left: &AtomicU64) {
    let mut bytes = [0; 1024];
    while let Ok(read @ 1..) = reader.read(&mut bytes) {
        let taken = |left: u64| Some(left.saturating_sub(read as u64));
        let before = left.fetch_update(Relaxed, Relaxed, taken).unwrap_or_default();
        let most = usize::try_from(before).unwrap_or(read).min(read);
        let _ = io::stderr().write_all(bytes.get(..most).unwrap_or_default());
    }
}

impl Host for ProcessHost {
    fn start(&self, external: &External) -> Result<Box<dyn Answers>, SimError> {
        let refused = |reason: String, allowed: String| {
            let file = external.source.path().display().to_string();
            SimError::NotStarted { file, reason, allowed }
        };
        let spawned = self.spawn(external).and_then(|mut process| {
            let start = process.begin()?;
            Ok((process, start))
        });
        let (process, start) = spawned.map_err(|error| {
            let allowed = "a file that can be read, and a process that can be started";
            refused(error.to_string(), allowed.to_owned())
        })?;
        match start {
            Ok(Start::Ready { period_s }) if is_period(period_s, external.dt_s) => {
                Ok(Box::new(process))
            }
            Ok(Start::Ready { period_s }) => Err(refused(
                format!(
                    "its period is {period_s:?} s, and the scenario samples every {:?} s",
                    external.dt_s
                ),
                "the same period, or 0 for a controller that has none".to_owned(),
            )),
            Ok(Start::Refused { reason, allowed }) => Err(refused(reason, allowed)),
            Err(loss) => Err(refused(
                format!("the controller {loss} while it was loaded"),
                "a library that can be loaded, whose `fspid_external_reset` returns".to_owned(),
            )),
        }
    }
}

/// Written so that NaN is none.
fn is_period(period_s: f64, dt_s: f64) -> bool {
    period_s == 0.0 || (period_s - dt_s).abs() <= SAME_PERIOD * dt_s
}

/// A controller in flight.
#[derive(Debug)]
struct Process {
    child: Child,
    stream: UnixStream,
    /// Number of the next sample.
    sample: u64,
    limit_s: f64,
    /// True once there is nothing more to wait for.
    is_lost: bool,
    printer: Printer,
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
        // Its last words, unless a process that it has left behind still holds the pipe.
        if let Some(ended) = &self.printer.0 {
            let _ = ended.recv_timeout(END_LIMIT);
        }
    }
}
