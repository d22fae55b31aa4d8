//! What a process for a controller does: loads it, and answers samples until nobody asks any more.

use std::io;
use std::os::fd::AsFd as _;
use std::os::unix::net::UnixStream;
use std::path::Path;
use std::process::ExitCode;

use crate::frame::{Start, read_sample, write_answer};
use crate::library::LibraryController;

/// Loads the library and answers what comes over standard input, which [`ProcessHost`](crate::ProcessHost) has made a
/// socket. What the controller prints is passed on to standard error.
#[must_use]
pub fn serve(library: &Path) -> ExitCode {
    // Nobody is left to be told what is wrong with the conversation.
    match converse(library) {
        Ok(()) => ExitCode::SUCCESS,
        Err(_) => ExitCode::FAILURE,
    }
}

fn converse(library: &Path) -> io::Result<()> {
    let mut stream = UnixStream::from(io::stdin().as_fd().try_clone_to_owned()?);
    let mut controller = match LibraryController::load(library) {
        Ok(controller) => controller,
        Err((reason, allowed)) => return Start::Refused { reason, allowed }.write(&mut stream),
    };
    Start::Ready { period_s: controller.period_s }.write(&mut stream)?;
    for number in 0.. {
        let Ok(sample) = read_sample(&mut stream) else { break };
        write_answer(&mut stream, number, &controller.step(&sample))?;
    }
    Ok(())
}
