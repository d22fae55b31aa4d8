//! What a process for a controller does: loads it, and answers samples until nobody asks any more.

use std::io::{self, Write as _};
use std::os::fd::AsFd as _;
use std::os::unix::net::UnixStream;
use std::os::unix::process::parent_id;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Duration;

use fspid_sim::core::{Sample, Step};
use fspid_sim::external::{Place, Renamed};
use rustix::process::{Signal, kill_current_process_group};

use crate::fmu::FmuController;
use crate::frame::{Start, read, read_sample, write_answer, write_refusal};
use crate::library::{LibraryController, Refusal};
use crate::process::{FMU, FMU_PLANT, FOLDER, LIBRARY};

/// How often a process looks whether the one that asks it is still there.
const LOOK_AGAIN: Duration = Duration::from_millis(100);

/// Loads a controller of this kind, `library` or `fmu` (its folder), or an aircraft, `fmu-plant`, and answers what comes each `dt_s` over standard
/// input, which [`ProcessHost`](crate::ProcessHost) has made a socket. `renamed` are names of an FMU's variables, such as
/// `setpoint_rad=theta_ref`. What the controller prints is passed on to
/// standard error.
#[must_use]
pub fn serve(kind: &str, path: &Path, dt_s: f64, renamed: &[String]) -> ExitCode {
    let Ok(mut stream) = asked(kind, path) else { return ExitCode::FAILURE };
    let conversed = converse(&mut stream, kind, path, dt_s, renamed);
    if kind != LIBRARY {
        remove(path);
    }
    // Who ends in order still listens; who was ended looks after nobody.
    if stream.write_all(&[0]).is_err() {
        let _ = kill_current_process_group(Signal::KILL);
    }
    // Nobody is left to be told what is wrong with the conversation.
    match conversed {
        Ok(()) => ExitCode::SUCCESS,
        Err(_) => ExitCode::FAILURE,
    }
}

/// The way to the one that asks, whose end is this process's from here on.
fn asked(kind: &str, path: &Path) -> io::Result<UnixStream> {
    let mut stream = UnixStream::from(io::stdin().as_fd().try_clone_to_owned()?);
    let asked_by = u32::from_ne_bytes(read(&mut stream)?);
    let folder = (kind != LIBRARY).then(|| path.to_owned());
    std::thread::Builder::new().spawn(move || end_with(asked_by, folder))?;
    Ok(stream)
}

fn converse(
    stream: &mut UnixStream,
    kind: &str,
    path: &Path,
    dt_s: f64,
    renamed: &[String],
) -> io::Result<()> {
    // From here on there is something to load, if there ever is.
    if read::<1>(stream).is_err() {
        return Ok(());
    }
    let mut controller = match Controller::load(kind, path, dt_s, renamed) {
        Ok(controller) => controller,
        Err((reason, allowed)) => return Start::Refused { reason, allowed }.write(stream),
    };
    Start::Ready { period_s: controller.period_s() }.write(stream)?;
    for number in 0.. {
        let Ok(sample) = read_sample(stream) else { break };
        match controller.step(&sample) {
            Ok(step) => write_answer(stream, number, &step)?,
            Err(status) => write_refusal(stream, status)?,
        }
    }
    Ok(())
}

/// Ends this process and all that it began once the one that asks is gone, of whatever it died: a controller that hangs
/// would go on for ever. Of an FMU the folder goes too, which nobody else removes then.
fn end_with(asked_by: u32, folder: Option<PathBuf>) {
    while parent_id() == asked_by {
        std::thread::sleep(LOOK_AGAIN);
    }
    if let Some(folder) = folder {
        remove(&folder);
    }
    let _ = kill_current_process_group(Signal::KILL);
}

/// Removes the folder of an FMU, and nothing else that somebody may have named.
fn remove(folder: &Path) {
    let name = folder.file_name().unwrap_or_default();
    if name.to_string_lossy().starts_with(FOLDER) {
        let _ = std::fs::remove_dir_all(folder);
    }
}

/// Reads what the simulator's side wrote.
fn named(text: &str) -> Option<Renamed> {
    let (key, name) = text.split_once('=')?;
    let (place, in_degrees) = Place::of_key(key)?;
    Some(Renamed { place, in_degrees, name: name.to_owned() })
}

enum Controller {
    Library(LibraryController),
    Fmu(Box<FmuController>),
}

impl Controller {
    fn load(kind: &str, path: &Path, dt_s: f64, renamed: &[String]) -> Result<Self, Refusal> {
        let renamed: Vec<Renamed> = renamed.iter().filter_map(|text| named(text)).collect();
        match kind {
            LIBRARY => LibraryController::load(path).map(Self::Library),
            FMU | FMU_PLANT => {
                let fmu = FmuController::load(path, dt_s, (&renamed, kind == FMU_PLANT))?;
                Ok(Self::Fmu(Box::new(fmu)))
            }
            other => {
                Err((format!("is called {other}"), format!("{LIBRARY}, {FMU} or {FMU_PLANT}")))
            }
        }
    }

    fn period_s(&self) -> f64 {
        match self {
            Self::Library(library) => library.period_s,
            Self::Fmu(fmu) => fmu.period_s(),
        }
    }

    fn step(&mut self, sample: &Sample<f64>) -> Result<Step<f64>, i32> {
        match self {
            Self::Library(library) => library.step(sample),
            Self::Fmu(fmu) => fmu.step(sample),
        }
    }
}
