//! The simulator's side: a process for each flight.

use std::collections::BTreeSet;
use std::ffi::OsString;
use std::io::{self, PipeReader, Read as _, Write as _};
use std::net::Shutdown;
use std::os::fd::OwnedFd;
use std::os::unix::net::UnixStream;
use std::os::unix::process::CommandExt as _;
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::sync::atomic::{AtomicU64, Ordering::Relaxed};
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::Duration;

use fspid_sim::core::{Sample, Step};
use fspid_sim::external::{Answers, Contents, Host, Lost, Renamed};
use fspid_sim::{ControllerLoss, External, ExternalSource, SimError};
use rustix::process::{Pid, Signal, WaitId, WaitIdOptions, kill_process_group, waitid};
use tempfile::TempDir;

use crate::archive::{archive, unpack};
use crate::flight_stack;
use crate::frame::{Start, read_answer, write_sample};
use crate::library::OVERRAN;
use crate::timed::Timed;

/// What loading a controller may take beyond its time for an answer: a process starts in less, however busy a machine is.
const START_LIMIT: Duration = Duration::from_secs(5);
/// How long a process has to end once nobody asks any more: what it has to print is printed by then.
const END_LIMIT: Duration = Duration::from_secs(1);
/// How often it is looked whether a process has ended whose socket is closed, and how far apart at first; each pause is
/// twice the one before: a second in all.
const ENDING_LOOKS: u32 = 14;
const FIRST_PAUSE: Duration = Duration::from_micros(64);
/// Of the period: how far a controller's may lie beside the scenario's. A period in 32 bits is near enough.
const SAME_PERIOD: f64 = 1e-6;

/// What a process is told that its controller is.
pub(crate) const LIBRARY: &str = "library";
pub(crate) const FMU: &str = "fmu";
pub(crate) const FMU_PLANT: &str = "fmu-plant";
/// How the folder of an unpacked FMU begins: nothing else is ever removed.
pub(crate) const FOLDER: &str = "fspid-fmu-";
/// Says that everything is there to be loaded.
const LOAD: [u8; 1] = [1];

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

/// Where the file of a controller lies that is one: flight stacks never come here.
fn path_of(external: &External) -> &Path {
    external.source.path().unwrap_or(Path::new(""))
}

/// Unpacks what was read of an FMU, or else what lies there.
fn unpack_into(folder: &Path, external: &External) -> Result<(), Unspawned> {
    let unpacked = || {
        let bytes: Arc<[u8]> = match &external.contents {
            Some(Contents(bytes)) => Arc::clone(bytes),
            None => archive(path_of(external))?.into(),
        };
        unpack(&bytes, folder)
    };
    unpacked().map_err(|error| match error.kind() {
        // What the reader of archives says; all else is the system's.
        io::ErrorKind::InvalidData => Unspawned::Archive(error.to_string()),
        _ => Unspawned::Host(error),
    })
}

const CHANGED: &str = "the file has changed since it was read; begin again with what it is now, or put back what it was";

/// Starts a process of a program for each flight.
#[derive(Clone, Debug)]
pub struct ProcessHost {
    program: PathBuf,
    arguments: Vec<OsString>,
    notes: Arc<Notes>,
    /// What is still passed on of what controllers print, bytes; nothing where all is.
    prints: Option<Arc<AtomicU64>>,
    /// Who is told how late flight stacks were, where a flight takes as long as it is.
    real_time: Option<fn(&str)>,
}

impl ProcessHost {
    /// The program, and the arguments with which it calls [`serve`](crate::serve) with the kind, the period, the path
    /// and the names that follow them.
    #[must_use]
    pub fn new(program: PathBuf, arguments: &[&str]) -> Self {
        let arguments = arguments.iter().map(OsString::from).collect();
        Self { program, arguments, notes: Arc::default(), prints: None, real_time: None }
    }

    /// Says who is told what a controller does that is part of no verdict: how it ends behind its last sample.
    #[must_use]
    pub fn telling(self, tell: fn(&str)) -> Self {
        Self { notes: Arc::new(Notes { tell: Some(tell), ..Notes::default() }), ..self }
    }

    /// The same that lets a flight with a flight stack take as long as it is, and tells which samples were late.
    #[must_use]
    pub fn in_real_time(self, tell: fn(&str)) -> Self {
        Self { real_time: Some(tell), ..self }
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
        let folder = || tempfile::Builder::new().prefix(FOLDER).tempdir();
        let (stream, theirs) = UnixStream::pair()?;
        let (kind, folder) = match &external.source {
            ExternalSource::Library(_) | ExternalSource::FlightStack(_) => (LIBRARY, None),
            ExternalSource::Fmu(_) => (FMU, Some(folder()?)),
            ExternalSource::FmuPlant(_) => (FMU_PLANT, Some(folder()?)),
            ExternalSource::Law(_) => return Err(io::Error::other("a control law is no program")),
        };
        let path = folder.as_ref().map_or(path_of(external), TempDir::path);
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
            limit: Duration::from_secs_f64(external.answer_limit_s),
            is_lost: false,
            file: path_of(external).to_owned(),
            notes: Arc::clone(&self.notes),
            printer,
            folder,
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
        if let Some(stack) = external.source.flight_stack() {
            let notes = Arc::clone(&self.notes);
            let tell = Arc::new(move |words| notes.tell(words));
            return flight_stack::start(external, stack, self.real_time, tell);
        }
        let file = external.source.name();
        let begun = || -> Result<_, Unspawned> {
            let mut process = self.spawn(external)?;
            let start = process.begin(external)?;
            require_unchanged(external)?;
            Ok((process, start))
        };
        let (process, start) = begun().map_err(|error| match error {
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

/// What a process ended with: its socket closes a moment before that is known. None for one that goes on without it.
pub(crate) fn ended(child: &Child) -> Option<ControllerLoss> {
    let mut pause = FIRST_PAUSE;
    for _ in 0..ENDING_LOOKS {
        if let Some(ending) = ending(child) {
            return Some(ending);
        }
        std::thread::sleep(pause);
        pause *= 2;
    }
    None
}

/// What a process ended with, if it has. Its number stays its own, which is also that of its group.
pub(crate) fn ending(child: &Child) -> Option<ControllerLoss> {
    let options = WaitIdOptions::EXITED | WaitIdOptions::NOHANG | WaitIdOptions::NOWAIT;
    let status = waitid(WaitId::Pid(Pid::from_child(child)), options);
    let Ok(status) = status else { return Some(ControllerLoss::Gone) };
    let status = status?;
    let code = status.exit_status().unwrap_or_default();
    let crashed = |signal| ControllerLoss::Crashed { signal };
    Some(status.terminating_signal().map_or(ControllerLoss::Ended { code }, crashed))
}

/// What is told of controllers that were done with a flight, once each.
#[derive(Debug, Default)]
struct Notes {
    tell: Option<fn(&str)>,
    told: Mutex<BTreeSet<String>>,
}

impl Notes {
    fn tell(&self, words: String) {
        let mut told = self.told.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(tell) = self.tell.filter(|_| !told.contains(&words)) {
            tell(&words);
            told.insert(words);
        }
    }
}

/// A controller in flight.
#[derive(Debug)]
struct Process {
    child: Child,
    stream: UnixStream,
    /// Number of the next sample.
    sample: u64,
    limit: Duration,
    /// True once there is nothing more to wait for.
    is_lost: bool,
    file: PathBuf,
    notes: Arc<Notes>,
    printer: Printer,
    /// What an FMU was unpacked into, removed behind it.
    folder: Option<TempDir>,
}

impl Process {
    /// Its first words, or how it was lost before them. An FMU is unpacked when the process is there: whichever of both
    /// goes first, the other one removes the folder.
    fn begin(&mut self, external: &External) -> Result<Result<Start, ControllerLoss>, Unspawned> {
        self.stream.write_all(&std::process::id().to_ne_bytes())?;
        if let Some(folder) = &self.folder {
            unpack_into(folder.path(), external)?;
        }
        self.stream.write_all(&LOAD)?;
        let limit = START_LIMIT + self.limit;
        let start = Start::read(&mut Timed::new(&self.stream, limit));
        Ok(start.map_err(|error| self.lost(&error, limit)))
    }

    /// What an error of the conversation means.
    fn lost(&mut self, error: &io::Error, limit: Duration) -> ControllerLoss {
        use io::ErrorKind::{BrokenPipe, ConnectionReset, TimedOut, UnexpectedEof, WouldBlock};
        self.is_lost = true;
        match error.kind() {
            // A process that it left behind may hold the socket.
            WouldBlock | TimedOut => {
                self.ending().unwrap_or(ControllerLoss::Silent { limit_s: limit.as_secs_f64() })
            }
            UnexpectedEof | BrokenPipe | ConnectionReset => {
                self.ended().unwrap_or(ControllerLoss::NoAnswer)
            }
            _ => ControllerLoss::NoAnswer,
        }
    }

    fn ended(&self) -> Option<ControllerLoss> {
        ended(&self.child)
    }

    fn ending(&self) -> Option<ControllerLoss> {
        ending(&self.child)
    }

    /// Lets it end once nobody asks any more, and tells how if that is not as it should be.
    fn let_end(&mut self) {
        let _ = self.stream.shutdown(Shutdown::Write);
        // Its side closes when it has ended; anything else is passed over.
        let closed = io::copy(&mut Timed::new(&self.stream, END_LIMIT), &mut io::sink());
        let ending = if closed.is_ok() { self.ended() } else { self.ending() };
        let told = match ending {
            Some(ControllerLoss::Ended { code: 0 }) => return,
            Some(loss) => loss.to_string(),
            None => format!("did not end within {:?} s and was ended", END_LIMIT.as_secs_f64()),
        };
        let file = self.file.display();
        self.notes.tell(format!(
            "note: external controller {file} {told}, behind the last sample of a flight, whose verdict that is not part of"
        ));
    }
}

impl Answers for Process {
    fn answer(&mut self, sample: Sample<f64>) -> Result<Step<f64>, ControllerLoss> {
        let mut timed = Timed::new(&self.stream, self.limit);
        let written = write_sample(&mut timed, &sample);
        let read = written.and_then(|()| read_answer(&mut timed));
        let answer = read.map_err(|error| self.lost(&error, self.limit))?;
        let (number, step) = answer.map_err(|status| match status {
            OVERRAN => ControllerLoss::Overran,
            status => ControllerLoss::Refused { status },
        })?;
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
    /// Lets it end; one that does not is ended, and so is what it left behind in its group.
    fn drop(&mut self) {
        if !self.is_lost {
            self.let_end();
        }
        // Before it is waited for, while nobody else can have its number.
        if self.ending() != Some(ControllerLoss::Gone) {
            let _ = kill_process_group(Pid::from_child(&self.child), Signal::KILL);
        }
        let _ = self.child.kill();
        let _ = self.child.wait();
        // Its last words, unless a process that it has left behind still holds the pipe.
        if let Some(ended) = &self.printer.0 {
            let _ = ended.recv_timeout(END_LIMIT);
        }
    }
}
