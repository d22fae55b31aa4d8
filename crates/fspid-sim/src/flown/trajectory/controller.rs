//! Linearisation of a controller at one sample: derivatives of its command and next state with respect to its inputs and its
//! state.
//!
//! The equations are those that fly, [`fspid_core::equations`], asked with dual numbers; only the
//! increments of the supervisor bring their derivatives along.

use fspid_core::equations::{GainNumbers, Memory, PidEquations};
use fspid_core::{Faults, Fspid, Gains, Sample, State};
use fspid_numeric::Scalar;
use fspid_numeric::scalar::Dual;

use super::gains::IncrementSlopes;
use crate::controller::Controller;

/// Faults that hold the command and the whole memory.
const HOLDING: [Faults; 3] = [Faults::NOT_FINITE, Faults::IMPLAUSIBLE, Faults::OVERFLOW];

/// What a sample depends on, by its place among the derivatives of a [`Slope`].
const PITCH: usize = 0;
const RATE: usize = 1;
const INTEGRAL: usize = 2;
const DERIVATIVE: usize = 3;
const PREVIOUS: usize = 4;
const LAST_COMMAND: usize = 5;
/// The first of three.
const GAINS: usize = 6;
const DEPENDS_ON: usize = 9;

/// A number of the controller, and how it moves with what the sample depends on.
type Slope = Dual<f64, DEPENDS_ON>;

/// What a controller did at one sample.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Done {
    sample: Sample<f64>,
    /// Its memory before.
    before: State<f64>,
    /// Its gains before the first sample.
    nominal: Gains<f64>,
    pub(super) gains: Gains<f64>,
    /// Inputs of the supervisor, if it was asked.
    pub(super) seen: Option<[f64; 2]>,
    /// The sample was not used: command and memory stood still.
    held: bool,
    /// The supervisor refused its inputs: the gains stood still.
    gains_held: bool,
    /// A limit of the command or of the integral acted.
    limited: bool,
}

/// A controller that is flown beside the one of the flight, bit for bit, and looked into.
pub(super) struct Twin<'a> {
    controller: &'a Controller,
    memory: State<f64>,
}

impl<'a> Twin<'a> {
    pub(super) fn new(controller: &'a Controller) -> Self {
        Self { controller, memory: State::new() }
    }

    pub(super) fn step(&mut self, sample: Sample<f64>) -> Done {
        let before = self.memory;
        // Faults of this sample only.
        self.memory.take_faults();
        let step = self.controller.step(&mut self.memory, sample);
        let (equations, nominal) = (self.controller.equations(), self.controller.nominal());
        let first = equations.at_first(&sample, &nominal);
        let memory = remembered(&before, first, |number, _| number);
        let free = equations.free(&memory, &sample, &step.gains);
        let unclamped_rad = equations.unclamped_rad(free.wound, step.gains.ki);
        let clamped = (free.term_rad - unclamped_rad).abs() > 0.0;
        Done {
            sample,
            before,
            nominal,
            gains: step.gains,
            seen: match self.controller {
                Controller::Fixed(_) => None,
                Controller::SelfTuning(fspid) => seen(fspid, &memory, &sample),
            },
            held: HOLDING.iter().any(|fault| step.faults.contains(*fault)),
            gains_held: step.faults.contains(Faults::OUT_OF_RANGE),
            limited: step.saturated || clamped,
        }
    }
}

/// What the supervisor is asked; nothing in the dead zone.
fn seen(fspid: &Fspid<f64>, memory: &Memory<f64>, sample: &Sample<f64>) -> Option<[f64; 2]> {
    let equations = fspid.tuner_equations();
    let error_rad = sample.setpoint_rad - sample.measurement_rad;
    let second_rad = equations.second_rad(memory, sample);
    let asked = !equations.is_silent(error_rad, second_rad);
    asked.then(|| equations.seen(error_rad, second_rad))
}

/// The memory that answers a sample, as numbers by what they depend on; `first` before the first good one.
fn remembered<S: Scalar>(
    before: &State<f64>,
    first: Memory<S>,
    number: impl Fn(f64, usize) -> S,
) -> Memory<S> {
    let command_rad = number(before.command_rad, LAST_COMMAND);
    let integral = number(before.integral, INTEGRAL);
    let Some(memory) = before.memory() else {
        return Memory { command_rad, integral, ..first };
    };
    Memory {
        command_rad,
        integral,
        derivative_rad_s: number(memory.derivative_rad_s, DERIVATIVE),
        error_rad: number(memory.error_rad, PREVIOUS),
        derivative_input_rad: number(memory.derivative_input_rad, PREVIOUS),
        kp: number(memory.kp, GAINS),
        ki: number(memory.ki, GAINS + 1),
        kd: number(memory.kd, GAINS + 2),
        // No reference model is linearised.
        model_rad: S::constant(memory.model_rad),
        model_rad_s: S::constant(memory.model_rad_s),
    }
}

/// Where the controller's memory stands in the state.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Places {
    pub(super) integral: Option<usize>,
    pub(super) derivative: Option<usize>,
    pub(super) previous: Option<usize>,
    pub(super) last_command: Option<usize>,
    /// The first of the three gains.
    pub(super) gains: Option<usize>,
    /// All states.
    pub(super) size: usize,
}

impl Places {
    /// All that is remembered, in the order of what a sample depends on.
    fn remembered(&self) -> [Option<usize>; DEPENDS_ON - INTEGRAL] {
        let gain = |offset| self.gains.map(|first| first + offset);
        let Self { integral, derivative, previous, last_command, .. } = *self;
        [integral, derivative, previous, last_command, gain(0), gain(1), gain(2)]
    }

    /// The row of one state; zeros of one that is not there.
    fn unit(&self, place: Option<usize>) -> Vec<f64> {
        let mut row = vec![0.0; self.size];
        if let Some(entry) = place.and_then(|place| row.get_mut(place)) {
            *entry = 1.0;
        }
        row
    }

    /// Everything stands still.
    fn held(&self) -> Rows {
        let all = self.remembered().into_iter().flatten();
        let memory = all.map(|place| (place, self.unit(Some(place)))).collect();
        Rows { command: self.unit(self.last_command), memory }
    }
}

/// Rows from the state before a sample to what the controller makes of it.
pub(super) struct Rows {
    pub(super) command: Vec<f64>,
    /// Next memory, each with its place.
    pub(super) memory: Vec<(usize, Vec<f64>)>,
}

/// Rows over the whole state that enter a controller.
pub(super) struct Inputs<'a> {
    /// Seen pitch and seen rate by state.
    pub(super) pitch: &'a [f64],
    pub(super) rate: &'a [f64],
    /// What the supervisor makes of its inputs; `None` for gains that are frozen.
    pub(super) slopes: Option<IncrementSlopes>,
}

impl Inputs<'_> {
    /// The row of a number: by each state through everything that the number depends on.
    fn row(&self, slope: &Slope, places: &Places) -> Vec<f64> {
        let mut row = vec![0.0; places.size];
        for (seen, by) in [self.pitch, self.rate].into_iter().zip(slope.derivative) {
            if by != 0.0 {
                for (entry, value) in row.iter_mut().zip(seen) {
                    *entry += by * value;
                }
            }
        }
        for (place, by) in places.remembered().into_iter().zip(&slope.derivative[INTEGRAL..]) {
            if let Some(entry) = place.and_then(|place| row.get_mut(place)) {
                *entry += by;
            }
        }
        row
    }
}

impl Done {
    /// The equations of the sample, derived by everything that it depends on. A command that is cut moves
    /// with its limit, and the memory as the anti-windup moves it.
    pub(super) fn rows(
        &self,
        controller: &Controller,
        places: &Places,
        inputs: &Inputs<'_>,
    ) -> Rows {
        if self.held {
            return places.held();
        }
        let equations = controller.equations().lifted();
        let (sample, memory) = self.varied(&equations);
        let gains = match (controller, inputs.slopes) {
            (Controller::SelfTuning(_), Some(_)) if self.gains_held => {
                Gains { kp: memory.kp, ki: memory.ki, kd: memory.kd }
            }
            (Controller::SelfTuning(fspid), Some(slopes)) => {
                self.tuned(fspid, &memory, &sample, slopes)
            }
            _ => fixed(self.gains),
        };
        let free = equations.free(&memory, &sample, &gains);
        let regulated = equations.regulated(&memory, &free, gains.ki);
        let row = |slope: &Slope| inputs.row(slope, places);
        let (command, integral) = (row(&regulated.command_rad), row(&regulated.integral));
        let integral = finite(integral, &row(&free.wound));
        let mut memory = Vec::new();
        memory.extend(places.integral.map(|place| (place, integral)));
        memory.extend(places.derivative.map(|place| (place, row(&free.derivative_rad_s))));
        memory.extend(places.previous.map(|place| (place, row(&free.error_rad))));
        memory.extend(places.last_command.map(|place| (place, command.clone())));
        let gains = [gains.kp, gains.ki, gains.kd].map(|gain| row(&gain));
        memory.extend(places.gains.into_iter().flat_map(|first| first..).zip(gains));
        Rows { command, memory }
    }

    /// What is seen and what is remembered as what the sample depends on.
    fn varied(&self, equations: &PidEquations<Slope>) -> (Sample<Slope>, Memory<Slope>) {
        let sample = Sample {
            setpoint_rad: Slope::fixed(self.sample.setpoint_rad),
            measurement_rad: Slope::variable(self.sample.measurement_rad, PITCH),
            rate_rad_s: Slope::variable(self.sample.rate_rad_s, RATE),
        };
        let first = equations.at_first(&sample, &fixed(self.nominal));
        (sample, remembered(&self.before, first, Slope::variable))
    }

    /// The gains, with the supervisor's slopes where it was asked.
    fn tuned(
        &self,
        fspid: &Fspid<f64>,
        memory: &Memory<Slope>,
        sample: &Sample<Slope>,
        slopes: IncrementSlopes,
    ) -> Gains<Slope> {
        let equations = fspid.tuner_equations().lifted();
        let error_rad = sample.setpoint_rad - sample.measurement_rad;
        let second_rad = equations.second_rad(memory, sample);
        let [error, second] = equations.seen(error_rad, second_rad);
        let [kp, ki, kd] = &equations.gains;
        let answer = self
            .seen
            .and_then(|[error, second]| fspid.tuner().increments_where_seen(error, second));
        let scaled = answer.unwrap_or(Gains::ZERO);
        let gain =
            |numbers: &GainNumbers<Slope>, before, value, [by_error, by_second]: [f64; 2]| {
                let moves = error * Slope::fixed(by_error) + second * Slope::fixed(by_second);
                let derivative = (numbers.scale * moves).derivative;
                let free = equations.free_gain(numbers, before, Slope { value, derivative });
                numbers.limited(free)
            };
        let [by_kp, by_ki, by_kd] = slopes;
        Gains {
            kp: gain(kp, memory.kp, scaled.kp, by_kp),
            ki: gain(ki, memory.ki, scaled.ki, by_ki),
            kd: gain(kd, memory.kd, scaled.kd, by_kd),
        }
    }

    /// True where nothing but the linear controller with these gains acted.
    pub(super) fn is_free(&self) -> bool {
        !(self.limited || self.held || self.gains_held)
    }
}

fn fixed(gains: Gains<f64>) -> Gains<Slope> {
    Gains { kp: Slope::fixed(gains.kp), ki: Slope::fixed(gains.ki), kd: Slope::fixed(gains.kd) }
}

/// The first row, or the second where a gain was too small for the first to be finite.
fn finite(row: Vec<f64>, otherwise: &[f64]) -> Vec<f64> {
    if row.iter().all(|entry| entry.is_finite()) { row } else { otherwise.to_vec() }
}
