//! Flights of tunings and contests by others: what Python gives out as tasks, and what it asks of a worker.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};

use fspid::campaign::local;
use fspid::tune::{self, Engine, Order, Source, TuneError};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;

use crate::error;

/// Flies parts of orders that somebody else made of the same scenario.
#[pyclass(frozen, module = "fspid._core")]
pub(crate) struct Worker(tune::Worker);

#[pymethods]
impl Worker {
    /// A worker with a scenario; nothing is read yet.
    #[new]
    fn new(path: PathBuf, overrides: Vec<String>) -> Self {
        Self(tune::Worker::new(Source { path, overrides }))
    }

    /// Flies some flights of an order on one thread: from the first to that before the end.
    fn fly(&self, py: Python<'_>, order: &str, first: usize, end: usize) -> PyResult<String> {
        let flown = py.detach(|| local::in_threads(1, || self.0.fly(order, first..end)));
        let flown = flown.map_err(|found| error::campaign(py, &found))?;
        flown.map_err(|found| error::tune(py, &found))
    }
}

/// A function of Python that flies orders: text, how many flights, how many together; it answers a list of texts.
pub(crate) struct Caller {
    function: Py<PyAny>,
    /// What it raised, so that it goes on as it is.
    raised: Mutex<Option<PyErr>>,
}

impl Caller {
    pub(crate) fn new(function: Py<PyAny>) -> Self {
        Self { function, raised: Mutex::new(None) }
    }

    /// An error as Python shall see it: what the function raised, or what was found.
    pub(crate) fn raise(&self, py: Python<'_>, found: &TuneError) -> PyErr {
        let raised = self.raised.lock().unwrap_or_else(PoisonError::into_inner).take();
        raised.unwrap_or_else(|| error::tune(py, found))
    }

    /// Calls a function; Ctrl-C ends the work.
    pub(crate) fn call<T>(
        &self,
        called: impl FnOnce(Python<'_>) -> PyResult<T>,
    ) -> Result<T, TuneError> {
        Python::attach(|py| {
            called(py).map_err(|error| {
                let reason = error.value(py).to_string();
                let is_stop = error.is_instance_of::<PyKeyboardInterrupt>(py);
                *self.raised.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
                if is_stop { TuneError::Stopped } else { TuneError::Engine { reason } }
            })
        })
    }
}

impl Engine for Caller {
    fn fly(&self, order: &Order) -> Result<Vec<String>, TuneError> {
        self.call(|py| {
            let asked = (order.text(), order.flights(), order.at_once());
            self.function.call1(py, asked)?.extract(py)
        })
    }
}
