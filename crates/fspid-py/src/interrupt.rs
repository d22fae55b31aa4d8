//! Work beside the interpreter, which Ctrl-C ends.

use std::panic::resume_unwind;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{self, RecvTimeoutError};
use std::thread;
use std::time::Duration;

use pyo3::prelude::*;

/// How often somebody looks whether Ctrl-C was pressed.
const PERIOD: Duration = Duration::from_millis(20);

/// Does work that keeps nothing. Ctrl-C leaves it at once; what was begun ends by itself, and nobody hears of it.
pub(crate) fn run<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> T + Send + 'static,
) -> PyResult<T> {
    watched(py, work, PyResult::<()>::Err)
}

/// Does work that keeps what it has: Ctrl-C calls `stop`, and the work is waited for.
pub(crate) fn run_until<T: Send + 'static>(
    py: Python<'_>,
    stop: impl Fn(),
    work: impl FnOnce() -> T + Send + 'static,
) -> PyResult<T> {
    let mut raised = None;
    let answer = watched(py, work, |error| {
        stop();
        raised.get_or_insert(error);
        Ok(())
    });
    raised.map_or(answer, Err)
}

/// The same with a flag that the work looks at.
pub(crate) fn run_flagged<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce(&AtomicBool) -> T + Send + 'static,
) -> PyResult<T> {
    let stop = Arc::new(AtomicBool::new(false));
    let asked = Arc::clone(&stop);
    run_until(py, || stop.store(true, Ordering::Relaxed), move || work(&asked))
}

/// Answers what the work does; what signals raise is told to `interrupted`, which may go on waiting.
fn watched<T: Send + 'static>(
    py: Python<'_>,
    work: impl FnOnce() -> T + Send + 'static,
    mut interrupted: impl FnMut(PyErr) -> PyResult<()>,
) -> PyResult<T> {
    let (answer, mut answered) = mpsc::sync_channel(1);
    let worker = thread::Builder::new().name("fspid".to_owned()).spawn(move || {
        // Nobody may listen any more.
        let _ = answer.send(work());
    })?;
    loop {
        let received;
        (answered, received) = py.detach(move || {
            let received = answered.recv_timeout(PERIOD);
            (answered, received)
        });
        match received {
            Ok(value) => return Ok(value),
            Err(RecvTimeoutError::Timeout) => {
                if let Err(error) = py.check_signals() {
                    interrupted(error)?;
                }
            }
            Err(RecvTimeoutError::Disconnected) => match worker.join() {
                Err(panic) => resume_unwind(panic),
                Ok(()) => return Err(pyo3::exceptions::PyRuntimeError::new_err("no answer")),
            },
        }
    }
}
