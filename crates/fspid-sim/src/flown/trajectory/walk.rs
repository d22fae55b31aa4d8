//! A flown loop, linearised sample by sample.

use std::ops::ControlFlow;

use fspid_core::fuzzy::OutOfRange;
use fspid_core::{Faults, Fspid, Gains, Law, Sample};

use super::controller::{Done, Inputs, Places, Twin};
use super::gains::{IncrementSlopes, TunerSlopes, system_of};
use crate::closed_loop::{Coming, fly, watch};
use crate::controller::Controller;
use crate::error::SimError;
use crate::flown::Perturbation;
use crate::flown::empirical::gains_around_rest;
use crate::instant::Instant;
use crate::loop_model::{LoopModel, LoopParts, LoopSettings, Memory};
use crate::propagation::Propagation;
use crate::scenario::{Prepared, Scenario};
use crate::trace::Outcome;

const NO_GAINS: Gains<f64> = Gains { kp: 0.0, ki: 0.0, kd: 0.0 };

/// The loop at one sample of a flight, for small changes of its state.
#[derive(Clone, Debug, PartialEq)]
pub struct SmallSignal {
    /// Index of the sample.
    pub k: usize,
    /// Its time, s.
    pub time_s: f64,
    /// Gains used.
    pub gains: Gains<f64>,
    /// A limit, a held sample or an input that is not believed makes of the sample another than the one
    /// without them; the matrices are those of the limited one.
    pub limited: bool,
    /// Next state by state with the gains frozen, row after row; without the states of the gains.
    pub frozen: Vec<Vec<f64>>,
    /// Next state by state with gains that move, row after row.
    pub matrix: Vec<Vec<f64>>,
    /// Next state by a change of the command that this sample gives.
    pub by_command: Vec<f64>,
}

/// Flies a controller and shows the loop at every sample for small changes. Answers how the flight
/// ended, and what the states are.
///
/// The states are those of [`LoopModel`](crate::loop_model::LoopModel) (pitch angle first), then the
/// last command where a slew limit or a held sample needs it, then the three gains where they carry
/// over from sample to sample. The plant is the one that flies then: its exact matrices, or, where a
/// limit acts on the actuator, its differences; of a nonlinear aircraft the differences of its
/// own motion in pitch angle, forward and downward speed, pitch rate, deflection and its rate, so that
/// altitude, heading and everything lateral are left out. A sensor that has a clock of its own is
/// taken at the largest age of its values.
///
/// # Errors
/// [`SimError`] where the scenario cannot be flown.
pub fn walk_along(
    scenario: &Scenario,
    controller: &Controller,
    mut visit: impl FnMut(&SmallSignal) -> ControlFlow<()>,
) -> Result<(Outcome, Vec<String>), SimError> {
    walk(scenario, controller, |small, _| visit(small))
}

/// As [`walk_along`]; shows the loop at the gains of rest as well, without states of gains and of the
/// last command.
pub(super) fn walk(
    scenario: &Scenario,
    controller: &Controller,
    mut visit: impl FnMut(&SmallSignal, &[Vec<f64>]) -> ControlFlow<()>,
) -> Result<(Outcome, Vec<String>), SimError> {
    if let Controller::SelfTuning(fspid) = controller
        && !fspid.tuner().is_plain()
    {
        return Err(SimError::Structure);
    }
    scenario.plant.require_equations()?;
    let prepared = scenario.prepare()?;
    let system = match controller {
        Controller::SelfTuning(fspid) => system_of(fspid.tuner().supervisor()),
        Controller::Fixed(_) => None,
    };
    let slopes = match (controller, &system) {
        (Controller::SelfTuning(fspid), Some(system)) => {
            Some(TunerSlopes::new(fspid.tuner(), system))
        }
        _ => None,
    };
    let mut walk = Walk::new(scenario, controller, &prepared, slopes)?;
    let mut failure = None;
    let outcome = watch(&prepared, controller, &Perturbation::NONE, |instant, coming| match walk
        .at(&prepared, instant, coming)
    {
        Ok(small) => visit(&small, &walk.rest),
        Err(error) => {
            failure = Some(error);
            ControlFlow::Break(())
        }
    })?;
    let names = walk.names();
    failure.map_or(Ok((outcome, names)), Err)
}

/// What is kept from sample to sample.
struct Walk<'a> {
    controller: &'a Controller,
    settings: LoopSettings,
    twin: Twin<'a>,
    slopes: Option<TunerSlopes<'a>>,
    holds: bool,
    carries_gains: bool,
    /// The loop's parts and how many stages of the flight had begun by then.
    parts: Option<(usize, LoopParts)>,
    names: Vec<String>,
    rest: Vec<Vec<f64>>,
}

impl<'a> Walk<'a> {
    fn new(
        scenario: &Scenario,
        controller: &'a Controller,
        prepared: &Prepared,
        slopes: Option<TunerSlopes<'a>>,
    ) -> Result<Self, SimError> {
        let config = controller.config();
        let (memory, carries_gains) = match controller {
            Controller::Fixed(pid) => (Memory::of_gains(pid.gains(), config), false),
            Controller::SelfTuning(fspid) => (memory_of(fspid), carries_gains(fspid)),
        };
        Ok(Self {
            controller,
            settings: LoopSettings::of(scenario, config, memory),
            twin: Twin::new(controller),
            slopes,
            holds: config.slew_rad_s.is_some() || !faults(prepared, controller)?.is_empty(),
            carries_gains,
            parts: None,
            names: Vec::new(),
            rest: Vec::new(),
        })
    }

    /// What the states are.
    fn names(self) -> Vec<String> {
        let more = self.holds.then_some("last command").into_iter();
        let gains = self.carries_gains.then_some(["kp", "ki", "kd"]).into_iter().flatten();
        self.names.into_iter().chain(more.chain(gains).map(str::to_owned)).collect()
    }

    fn at(
        &mut self,
        prepared: &Prepared,
        instant: &Instant,
        coming: &Coming<'_>,
    ) -> Result<SmallSignal, SimError> {
        let [measurement_rad, rate_rad_s] = instant.measured;
        let setpoint_rad = instant.setpoint_rad;
        let done = self.twin.step(Sample { setpoint_rad, measurement_rad, rate_rad_s });
        let cut = coming.propagation.is_limited(coming.motion, coming.command_rad);
        let begun = prepared.stages.partition_point(|stage| stage.from <= instant.k);
        let parts = self.parts(begun, coming, cut)?;
        // A supervisor that is silent does not move.
        let asked = self.slopes.as_mut().zip(done.seen);
        let slopes = asked.map_or([[0.0; 2]; 3], |(slopes, seen)| slopes.at(seen));
        let frozen = self.places(&parts, false);
        let moving = self.places(&parts, self.carries_gains);
        let small = SmallSignal {
            k: instant.k,
            time_s: prepared.timing.time_s(instant.k),
            gains: done.gains,
            limited: cut || !done.is_free(),
            frozen: self.matrix(&parts, &frozen, &done, None),
            matrix: self.matrix(&parts, &moving, &done, Some(slopes)),
            by_command: padded(&parts.by_command, moving.size),
        };
        self.parts = Some((begun, parts)).filter(|_| !cut && is_linear(coming.propagation));
        Ok(small)
    }

    /// The loop broken at the command, for the plant of a sample.
    fn parts(
        &mut self,
        begun: usize,
        coming: &Coming<'_>,
        cut: bool,
    ) -> Result<LoopParts, SimError> {
        match self.parts.take() {
            Some((known, parts)) if known == begun && !cut => return Ok(parts),
            _ => {}
        }
        let plant = match coming.propagation.linear_step() {
            Some(step) if !cut => step.into(),
            _ => coming.propagation.slopes(coming.motion, coming.command_rad, coming.held)?,
        };
        let model = LoopModel::new(plant, self.settings.clone());
        if self.names.is_empty() {
            self.names = model.state_names();
            self.rest = model.closed(gains_around_rest(self.controller));
        }
        Ok(model.parts(NO_GAINS))
    }

    fn places(&self, parts: &LoopParts, with_gains: bool) -> Places {
        let mut size = parts.by_command.len();
        let mut more = |count: usize| {
            let first = size;
            size += count;
            first
        };
        let last_command = self.holds.then(|| more(1));
        let gains = with_gains.then(|| more(3));
        Places {
            integral: parts.integral,
            derivative: parts.derivative,
            previous: parts.previous,
            last_command,
            gains,
            size,
        }
    }

    fn matrix(
        &self,
        parts: &LoopParts,
        places: &Places,
        done: &Done,
        slopes: Option<IncrementSlopes>,
    ) -> Vec<Vec<f64>> {
        let (pitch, rate) = (padded(&parts.pitch, places.size), padded(&parts.rate, places.size));
        let inputs = Inputs { pitch: &pitch, rate: &rate, slopes };
        let controller = done.rows(self.controller, places, &inputs);
        let mut rows: Vec<Vec<f64>> =
            parts.matrix.iter().map(|row| padded(row, places.size)).collect();
        for (row, by) in rows.iter_mut().zip(&parts.by_command) {
            if *by != 0.0 {
                for (entry, command) in row.iter_mut().zip(&controller.command) {
                    *entry += by * command;
                }
            }
        }
        rows.resize(places.size, Vec::new());
        for (place, row) in controller.memory {
            rows[place] = row;
        }
        rows
    }
}

/// What of the memory a self-tuning controller may ever let out.
fn memory_of(fspid: &Fspid<f64>) -> Memory {
    let (nominal, scale) = (fspid.tuner().nominal(), fspid.tuner().settings().output_scale);
    let ever = |nominal: f64, scale: f64| nominal != 0.0 || scale != 0.0;
    let integral = ever(nominal.ki, scale.ki);
    Memory::of_terms(integral, ever(nominal.kd, scale.kd), fspid.config()).with_previous()
}

fn carries_gains(fspid: &Fspid<f64>) -> bool {
    let tuner = fspid.tuner();
    matches!(tuner.settings().law, Law::Accumulating { .. })
        || tuner.supervisor().out_of_range() == OutOfRange::Error
}

/// Faults that hold samples in a flight.
fn faults(prepared: &Prepared, controller: &Controller) -> Result<Faults, SimError> {
    let mut faults = Faults::NONE;
    fly(prepared, controller, |instant| {
        faults = instant.step.faults;
        ControlFlow::Continue(())
    })?;
    Ok(faults)
}

fn is_linear(propagation: &Propagation) -> bool {
    !matches!(propagation, Propagation::Aircraft(_) | Propagation::External(_))
}

fn padded(row: &[f64], size: usize) -> Vec<f64> {
    let mut row = row.to_vec();
    row.resize(size, 0.0);
    row
}
