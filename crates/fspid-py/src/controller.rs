//! A controller by itself, for loops that are written in Python.

use std::sync::Mutex;

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
    now: Mutex<Now>,
}

/// The memory, and the last answer.
#[derive(Clone, Copy)]
struct Now {
    state: State<f64>,
    last: Option<Step<f64>>,
}

impl Controller {
    fn with<T>(&self, work: impl FnOnce(&mut Now) -> T) -> T {
        // A panic elsewhere leaves a whole memory: it is written as one.
        work(&mut self.now.lock().unwrap_or_else(std::sync::PoisonError::into_inner))
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
        Ok(Self { controller: found.controller, now: Mutex::new(BEGINNING()) })
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
    fn reset(&self) {
        self.with(|now| *now = BEGINNING());
    }

    /// Answers a sample.
    #[pyo3(signature = (setpoint, measurement, rate=0.0))]
    fn step(&self, setpoint: f64, measurement: f64, rate: f64) -> f64 {
        let sample =
            Sample { setpoint_rad: setpoint, measurement_rad: measurement, rate_rad_s: rate };
        self.with(|now| {
            let step = self.controller.step(&mut now.state, sample);
            now.last = Some(step);
            step.command_rad
        })
    }

    /// Takes part in a sample that another has commanded.
    #[pyo3(signature = (setpoint, measurement, command, rate=0.0))]
    fn track(&self, setpoint: f64, measurement: f64, command: f64, rate: f64) -> f64 {
        let sample =
            Sample { setpoint_rad: setpoint, measurement_rad: measurement, rate_rad_s: rate };
        self.with(|now| {
            let step = self.controller.track(&mut now.state, sample, command);
            now.last = Some(step);
            step.command_rad
        })
    }

    /// Answers the last command once more, for a sample that is known to be bad.
    fn hold(&self) -> f64 {
        self.with(|now| {
            let step = self.controller.hold(&mut now.state, Faults::NOT_FINITE);
            now.last = Some(step);
            step.command_rad
        })
    }

    /// Answers samples one after the other: set-points, measurements, and rates if they are given.
    fn step_many(&self, py: Python<'_>, inputs: &Bound<'_, PyTuple>) -> PyResult<Column> {
        let names = ["setpoint", "measurement", "rate"].map(str::to_owned);
        let columns: Vec<Numbers> = same_length(py, &names[..inputs.len().clamp(2, 3)], inputs)?;
        let (controller, mut now) = (self.controller, self.with(|now| *now));
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
        self.with(|mine| *mine = now);
        Ok(Column::new("command_rad".to_owned(), commands))
    }
}
