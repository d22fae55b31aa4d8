//! What a process for a controller does: loads it, and answers samples until nobody asks any more.

use std::io;
use std::os::fd::AsFd as _;
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::process::ExitCode;

use fspid_sim::core::{Sample, Step};
use fspid_sim::external::{Place, Renamed};

use crate::fmu::FmuController;
use crate::frame::{Start, read_sample, write_answer, write_refusal};
use crate::library::{LibraryController, Refusal};
use crate::process::{FMU, LIBRARY};

/// Loads a controller of this kind, `library` or `fmu` (its folder), and answers what comes each `dt_s` over standard
/// input, which [`ProcessHost`](crate::ProcessHost) has made a socket. `renamed` are names of an FMU's variables, such as
/// `setpoint_rad=theta_ref`. What the controller prints is passed on to
/// standard error.
#[must_use]
pub fn serve(kind: &str, path: &Path, dt_s: f64, renamed: &[String]) -> ExitCode {
    // Nobody is left to be told what is wrong with the conversation.
    match converse(kind, path, dt_s, renamed) {
        Ok(()) => ExitCode::SUCCESS,
        Err(_) => ExitCode::FAILURE,
    }
}

fn converse(kind: &str, path: &Path, dt_s: f64, renamed: &[String]) -> io::Result<()> {
    let mut stream = UnixStream::from(io::stdin().as_fd().try_clone_to_owned()?);
    let mut controller = match Controller::load(kind, path, dt_s, renamed) {
        Ok(controller) => controller,
        Err((reason, allowed)) => return Start::Refused { reason, allowed }.write(&mut stream),
    };
    Start::Ready { period_s: controller.period_s() }.write(&mut stream)?;
    for number in 0.. {
        let Ok(sample) = read_sample(&mut stream) else { break };
        match controller.step(&sample) {
            Ok(step) => write_answer(&mut stream, number, &step)?,
            Err(status) => write_refusal(&mut stream, status)?,
        }
    }
    Ok(())
}

/// Reads what the simulator's side wrote.
fn read(text: &str) -> Option<Renamed> {
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
        let renamed: Vec<Renamed> = renamed.iter().filter_map(|text| read(text)).collect();
        match kind {
            LIBRARY => LibraryController::load(path).map(Self::Library),
            FMU => FmuController::load(path, dt_s, &renamed).map(|fmu| Self::Fmu(Box::new(fmu))),
            other => Err((format!("is called {other}"), format!("{LIBRARY} or {FMU}"))),
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
            Self::Library(library) => Ok(library.step(sample)),
            Self::Fmu(fmu) => fmu.step(sample),
        }
    }
}
