//! A controller by itself, for loops that are written in Python.

use std::sync::{Mutex, MutexGuard, PoisonError};

use fspid::core::{Faults, Sample, State, Step};
use fspid::sim::Controller as Asked;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::array::{Column, Numbers, same_length};
use crate::scenario::Scenario;
use crate::{error, interrupt};

/// A controller of a scenario and its memory; angles in radians, nose up positive.
#[pyclass(frozen, module = "fspid._core")]
pub(crate) struct Controller {
    controller: Asked,
    memory: Mutex<Memory>,
}

/// What a controller remembers, and whether many samples are being answered from a copy of it.
struct Memory {
    now: Now,
    lent: bool,
}

/// The memory, and the last answer.
#[derive(Clone, Copy)]
struct Now {
    state: State<f64>,
    last: Option<Step<f64>>,
}

impl Controller {
    fn memory(&self) -> MutexGuard<'_, Memory> {
        // A panic elsewhere leaves a whole memory: it is written as one.
        self.memory.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Refuses samples without a rate where the controller needs one: zero would take its damping away, and nobody would see it.
    fn has_its_rate(&self, py: Python<'_>, is_given: bool) -> PyResult<()> {
        match is_given || !self.controller.uses_rate() {
            true => Ok(()),
            false => Err(error::input(py, NEEDS_RATE)),
        }
    }

    /// A sample, which has to have its rate.
    fn sample(
        &self,
        py: Python<'_>,
        (setpoint_rad, measurement_rad): (f64, f64),
        rate_rad_s: Option<f64>,
    ) -> PyResult<Sample<f64>> {
        self.has_its_rate(py, rate_rad_s.is_some())?;
        Ok(Sample { setpoint_rad, measurement_rad, rate_rad_s: rate_rad_s.unwrap_or(0.0) })
    }

    fn with<T>(&self, work: impl FnOnce(&Now) -> T) -> T {
        work(&self.memory().now)
    }

    /// Changes the memory, unless it is lent.
    fn changing<T>(&self, py: Python<'_>, work: impl FnOnce(&mut Now) -> T) -> PyResult<T> {
        let mut memory = self.memory();
        let changed = (!memory.lent).then(|| work(&mut memory.now));
        // Raising runs Python, in which another thread may ask for the memory.
        drop(memory);
        changed.ok_or_else(|| error::input(py, LENT))
    }

    /// Lends the memory until what is answered is dropped: another thread would change what is then overwritten.
    fn lend(&self, py: Python<'_>) -> PyResult<(Lent<'_>, Now)> {
        let mut memory = self.memory();
        let (was_lent, now) = (memory.lent, memory.now);
        memory.lent = true;
        drop(memory);
        if was_lent { Err(error::input(py, LENT)) } else { Ok((Lent(self), now)) }
    }
}

const NEEDS_RATE: &str = "this controller uses the pitch rate, rad/s: give `rate` with each sample (`uses_rate` tells which need one)";

const LENT: &str = "step_many answers samples of this controller in another thread; each thread needs a controller of its own";

/// The memory of a controller is lent as long as this lives.
struct Lent<'c>(&'c Controller);

impl Lent<'_> {
    fn give_back(self, now: Now) {
        self.0.memory().now = now;
    }
}

impl Drop for Lent<'_> {
    fn drop(&mut self) {
        self.0.memory().lent = false;
    }
}

const BEGINNING: fn() -> Now = || Now { state: State::new(), last: None };

#[pymethods]
impl Controller {
    /// The controller of that name in a scenario.
    #[new]
    fn new(py: Python<'_>, scenario: &Scenario, name: &str) -> PyResult<Self> {
        let controllers = &scenario.study().scenario.controllers;
        let found = controllers.iter().find(|named| named.name == name);
        let names: Vec<&str> = controllers.iter().map(|named| named.name.as_str()).collect();
        let known = || fspid::scenario::file::known_words(name, &names);
        let found = found.ok_or_else(|| {
            error::input(
                py,
                format_args!("there is no controller `{name}` with equations{}", known()),
            )
        })?;
        Ok(Self {
            controller: found.controller,
            memory: Mutex::new(Memory { now: BEGINNING(), lent: false }),
        })
    }

    /// Its sample period, s.
    #[getter]
    fn period_s(&self) -> f64 {
        self.controller.config().dt_s
    }

    /// True if it uses the measured pitch rate.
    #[getter]
    fn uses_rate(&self) -> bool {
        self.controller.uses_rate()
    }

    /// The gains of the last step; those that it begins with before the first.
    #[getter]
    fn gains(&self) -> (f64, f64, f64) {
        let gains = self.with(|now| now.last.map(|step| step.gains));
        let gains = gains.unwrap_or_else(|| self.controller.nominal());
        (gains.kp, gains.ki, gains.kd)
    }

    /// Whether a limit cut the last command.
    #[getter]
    fn saturated(&self) -> bool {
        self.with(|now| now.last.is_some_and(|step| step.saturated))
    }

    /// Faults that are latched, in words.
    #[getter]
    fn faults(&self) -> String {
        self.with(|now| now.state.faults.to_string())
    }

    /// Begins anew.
    fn reset(&self, py: Python<'_>) -> PyResult<()> {
        self.changing(py, |now| *now = BEGINNING())
    }

    /// Answers a sample.
    #[pyo3(signature = (setpoint, measurement, rate=None))]
    fn step(
        &self,
        py: Python<'_>,
        setpoint: f64,
        measurement: f64,
        rate: Option<f64>,
    ) -> PyResult<f64> {
        let sample = self.sample(py, (setpoint, measurement), rate)?;
        self.changing(py, |now| {
            let step = self.controller.step(&mut now.state, sample);
            now.last = Some(step);
            step.command_rad
        })
    }

    /// Takes part in a sample that another has commanded.
    #[pyo3(signature = (setpoint, measurement, command, rate=None))]
    fn track(
        &self,
        py: Python<'_>,
        setpoint: f64,
        measurement: f64,
        command: f64,
        rate: Option<f64>,
    ) -> PyResult<f64> {
        let sample = self.sample(py, (setpoint, measurement), rate)?;
        self.changing(py, |now| {
            let step = self.controller.track(&mut now.state, sample, command);
            now.last = Some(step);
            step.command_rad
        })
    }

    /// Answers the last command once more, for a sample that is known to be bad.
    fn hold(&self, py: Python<'_>) -> PyResult<f64> {
        self.changing(py, |now| {
            let step = self.controller.hold(&mut now.state, Faults::NOT_FINITE);
            now.last = Some(step);
            step.command_rad
        })
    }

    /// Answers samples one after the other: set-points, measurements, and rates if they are given.
    fn step_many(&self, py: Python<'_>, inputs: &Bound<'_, PyTuple>) -> PyResult<Column> {
        let names = ["setpoint", "measurement", "rate"].map(str::to_owned);
        let columns: Vec<Numbers> = same_length(py, &names[..inputs.len().clamp(2, 3)], inputs)?;
        self.has_its_rate(py, columns.len() == names.len())?;
        let controller = self.controller;
        let (lent, mut now) = self.lend(py)?;
        let (now, commands) = interrupt::run(py, move || {
            let all = columns.iter().map(Numbers::as_slice).collect::<Vec<_>>();
            let rate = |k: usize| all.get(2).map_or(0.0, |rate| rate[k]);
            let commands = (0..all[0].len()).map(|k| {
                let sample = Sample {
                    setpoint_rad: all[0][k],
                    measurement_rad: all[1][k],
                    rate_rad_s: rate(k),
                };
                let step = controller.step(&mut now.state, sample);
                now.last = Some(step);
                step.command_rad
            });
            let commands: Vec<f64> = commands.collect();
            (now, commands)
        })?;
        lent.give_back(now);
        Ok(Column::new("command_rad".to_owned(), commands))
    }
}
