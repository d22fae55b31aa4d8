//! A plant and its first-order servo from one sample to the next, by the exact matrix exponential.
//!
//! Between samples everything that enters is held, so the solution of
//!
//! $$ \dot x = A x + s B (\delta + d), \qquad \tau \dot \delta = v - \delta $$
//!
//! is one matrix product. Where the rate limit holds the servo, $\dot \delta = \rho$ is constant,
//! and the sample is cut at the instant the limit lets go; no step size and no error is involved.

use crate::actuator::Actuator;
use crate::error::SimError;
use crate::generator::Generator;
use crate::law::{Law, LinearStep};
use crate::math::dot;
use crate::plant::LinearPlant;

/// Inputs of the propagated system beside its state: servo command (or rate), elevator disturbance.
pub(crate) const INPUTS: usize = 2;

/// Plant and servo, discretised for one sample period.
#[derive(Clone, Debug)]
pub(crate) struct Propagator {
    /// A first-order servo.
    pub(crate) servo: Actuator,
    dt_s: f64,
    order: usize,
    /// Free servo: input 0 is the command.
    pub(crate) free: Law,
    /// Rate-limited servo: input 0 is the rate.
    ramp: Law,
    /// Row vector from the plant's state, then the elevator's deflection, to pitch rate.
    rate_row: Vec<f64>,
    pub(crate) elevator_per_command: f64,
}

/// Plant state and servo deflection (nose up positive), rad.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct PlantState {
    values: Vec<f64>,
    scratch: Vec<f64>,
}

impl PlantState {
    pub(crate) fn at_rest(order: usize) -> Self {
        Self { values: vec![0.0; order + 1], scratch: vec![0.0; order + 1] }
    }

    /// State of the plant followed by the servo's deflection.
    pub(crate) fn values(&self) -> &[f64] {
        &self.values
    }

    pub(crate) fn theta_rad(&self) -> f64 {
        self.values.first().copied().unwrap_or(0.0)
    }

    /// Moves one of the values.
    pub(crate) fn nudge(&mut self, place: usize, by: f64) {
        if let Some(value) = self.values.get_mut(place) {
            *value += by;
        }
    }

    /// Servo deflection, nose up positive, rad.
    pub(crate) fn deflection_rad(&self) -> f64 {
        self.values.last().copied().unwrap_or(0.0)
    }

    pub(crate) fn values_mut(&mut self) -> &mut [f64] {
        &mut self.values
    }

    fn set_deflection(&mut self, deflection_rad: f64) {
        if let Some(last) = self.values.last_mut() {
            *last = deflection_rad;
        }
    }

    /// x ← M [x; input; disturbance]
    fn advance(&mut self, rows: &[f64], input: f64, disturbance_rad: f64) {
        let held = [input, disturbance_rad];
        let values = &mut self.values;
        // A length known to the compiler makes of a product straight code; the sums are the same.
        let done = match values.len() {
            3 => product::<3, 5>(rows, values, held),
            4 => product::<4, 6>(rows, values, held),
            5 => product::<5, 7>(rows, values, held),
            _ => None,
        };
        if done.is_none() {
            self.advance_any(rows, held);
        }
    }

    fn advance_any(&mut self, rows: &[f64], [input, disturbance_rad]: [f64; INPUTS]) {
        let width = self.values.len();
        for (next, row) in self.scratch.iter_mut().zip(rows.chunks_exact(width + INPUTS)) {
            let (state_part, input_part) = row.split_at(width);
            let free: f64 = state_part.iter().zip(&self.values).map(|(a, x)| a * x).sum();
            let &[by_input, by_disturbance] = input_part else {
                continue;
            };
            *next = free + by_input * input + by_disturbance * disturbance_rad;
        }
        std::mem::swap(&mut self.values, &mut self.scratch);
    }
}

/// x ← M [x; u] for that many states and columns; `None`, with nothing done, for another number.
#[inline]
fn product<const STATES: usize, const COLUMNS: usize>(
    rows: &[f64],
    values: &mut [f64],
    held: [f64; INPUTS],
) -> Option<()> {
    let (rows, _) = rows.as_chunks::<COLUMNS>();
    let values: &mut [f64; STATES] = values.try_into().ok()?;
    let before = *values;
    for (value, row) in values.iter_mut().zip(rows) {
        let (state_part, input_part) = row.split_at(STATES);
        let free: f64 = state_part.iter().zip(&before).map(|(a, x)| a * x).sum();
        let &[by_input, by_disturbance] = input_part else {
            continue;
        };
        let [input, disturbance_rad] = held;
        *value = free + by_input * input + by_disturbance * disturbance_rad;
    }
    Some(())
}

impl Propagator {
    pub(crate) fn new(plant: &LinearPlant, servo: Actuator, dt_s: f64) -> Result<Self, SimError> {
        let sign = plant.elevator_sign().per_nose_up();
        Self::of_generator(&Generator::of(plant), servo, dt_s, sign)
    }

    /// The same of a plant's generator without gusts, and the elevator in its sign for each of a command.
    pub(crate) fn of_generator(
        generator: &Generator,
        servo: Actuator,
        dt_s: f64,
        elevator_per_command: f64,
    ) -> Result<Self, SimError> {
        Ok(Self {
            servo,
            dt_s,
            order: generator.order(),
            free: generator.follow(servo.lag(), dt_s)?,
            ramp: generator.ramp(dt_s)?,
            rate_row: generator.rate_row(),
            elevator_per_command,
        })
    }

    pub(crate) fn order(&self) -> usize {
        self.order
    }

    pub(crate) fn dt_s(&self) -> f64 {
        self.dt_s
    }

    /// The rows of a sample of which the rate limit holds the servo for so long, and those of its rest, if it has one.
    pub(crate) fn rate_limited_rows(
        &self,
        duration_s: f64,
    ) -> Result<(Vec<f64>, Option<Vec<f64>>), SimError> {
        if duration_s >= self.dt_s {
            return Ok((self.ramp.step.clone(), None));
        }
        let rest = self.free.step_over(self.dt_s - duration_s)?;
        Ok((self.ramp.step_over(duration_s)?, Some(rest)))
    }

    /// From the plant's states to pitch rate.
    pub(crate) fn rate_output(&self) -> &[f64] {
        &self.rate_row[..self.order]
    }

    /// From the elevator, in its own sign, to pitch rate.
    pub(crate) fn rate_feedthrough(&self) -> f64 {
        self.elevator_per_command * self.rate_row[self.order]
    }

    /// Pitch rate $q = \dot \theta$ just before a sample, rad/s.
    pub(crate) fn rate_rad_s(&self, state: &PlantState, disturbance_rad: f64) -> f64 {
        let by_state = dot(self.rate_output(), state.values());
        by_state + self.rate_feedthrough() * self.elevator_rad(state, disturbance_rad)
    }

    /// Elevator in the plant's own sign, disturbance included, rad.
    pub(crate) fn elevator_rad(&self, state: &PlantState, disturbance_rad: f64) -> f64 {
        self.elevator_per_command * (state.deflection_rad() + disturbance_rad)
    }

    /// Moves an ideal servo to its command at once; a real one stays where it is.
    pub(crate) fn settle_ideal_servo(&self, state: &mut PlantState, command_rad: f64) {
        if self.servo.is_at_once() {
            state.set_deflection(self.servo.limited_rad(command_rad));
        }
    }

    /// One sample period with everything held.
    pub(crate) fn advance(
        &self,
        state: &mut PlantState,
        command_rad: f64,
        disturbance_rad: f64,
    ) -> Result<(), SimError> {
        let command_rad = self.servo.limited_rad(command_rad);
        let gap_rad = command_rad - state.deflection_rad();
        let Some((rate_rad_s, duration_s)) = self.servo.rate_limited_phase(gap_rad, self.dt_s)
        else {
            state.advance(&self.free.step, command_rad, disturbance_rad);
            return Ok(());
        };
        if duration_s >= self.dt_s {
            state.advance(&self.ramp.step, rate_rad_s, disturbance_rad);
            return Ok(());
        }
        let ramp = self.ramp.step_over(duration_s)?;
        state.advance(&ramp, rate_rad_s, disturbance_rad);
        let free = self.free.step_over(self.dt_s - duration_s)?;
        state.advance(&free, command_rad, disturbance_rad);
        Ok(())
    }

    /// True where a limit makes of the coming sample another than the linear one.
    pub(crate) fn is_limited(&self, state: &PlantState, command_rad: f64) -> bool {
        let limited_rad = self.servo.limited_rad(command_rad);
        let gap_rad = limited_rad - state.deflection_rad();
        let rate = self.servo.rate_limited_phase(gap_rad, self.dt_s).is_some();
        rate || (limited_rad - command_rad).abs() > 0.0
    }

    /// The linear part of a sample: what a loop around rest obeys.
    pub(crate) fn linear_step(&self) -> LinearStep {
        self.free.linear_step(self.order + 1, &self.rate_row)
    }

    /// What a sample changes of the states of [`linear_step`](Self::linear_step), and what 64 bits leave out of it.
    pub(crate) fn linear_change(&self, plant: &LinearPlant) -> Result<[Vec<f64>; 2], SimError> {
        let rest = Generator::of_rest(plant).rows(self.servo.lag());
        self.free.change(&rest, self.order + 1, self.dt_s)
    }
}
