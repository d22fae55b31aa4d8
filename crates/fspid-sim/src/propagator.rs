//! The plant and its servo from one sample to the next, by the exact matrix exponential.
//!
//! Between samples everything that enters is held, so the solution of
//!
//! $$ \dot x = A x + s B (\delta + d), \qquad \tau \dot \delta = v - \delta $$
//!
//! is one matrix product. Where the rate limit holds the servo, $\dot \delta = \rho$ is constant,
//! and the sample is cut at the instant the limit lets go; no step size and no error is involved.

use fspid_lti::{FineMatrix, Matrix, StateSpace, exponential, exponential_change};

use crate::error::SimError;
use crate::plant::LinearPlant;
use crate::servo::Servo;

/// Inputs of the propagated system beside its state: servo command (or rate), elevator disturbance.
pub(crate) const INPUTS: usize = 2;

/// The continuous system of plant, servo and held inputs, discretised for one sample period.
#[derive(Clone, Debug)]
pub(crate) struct Propagator {
    pub(crate) servo: Servo,
    dt_s: f64,
    order: usize,
    /// Free servo: input 0 is the command.
    free: Matrix,
    pub(crate) free_step: Vec<f64>,
    /// Rate-limited servo: input 0 is the rate.
    ramp: Matrix,
    ramp_step: Vec<f64>,
    /// Row vector from state and elevator to pitch rate.
    pub(crate) rate_output: Vec<f64>,
    pub(crate) rate_feedthrough: f64,
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
    pub(crate) fn new(plant: &LinearPlant, servo: Servo, dt_s: f64) -> Result<Self, SimError> {
        let model = plant.state_space();
        let elevator_per_command = plant.elevator_sign().per_nose_up();
        let free = generator(&model, elevator_per_command, &ServoMotion::Free(servo))?;
        let ramp = generator(&model, elevator_per_command, &ServoMotion::Ramp)?;
        let order = plant.order();
        let markov = plant.transfer_function().markov_parameters(2);
        let rate_output = (0..order).map(|column| if column == 1 { 1.0 } else { 0.0 }).collect();
        let mut propagator = Self {
            servo,
            dt_s,
            order,
            free_step: step_rows(&free, dt_s)?,
            free,
            ramp_step: step_rows(&ramp, dt_s)?,
            ramp,
            rate_output,
            rate_feedthrough: markov.get(1).copied().unwrap_or(0.0),
            elevator_per_command,
        };
        if order == 1 {
            // θ' = -a0 θ + h1 δ: no second state holds the rate.
            propagator.rate_output = model.a().data().to_vec();
        }
        Ok(propagator)
    }

    pub(crate) fn order(&self) -> usize {
        self.order
    }

    /// Pitch rate $q = \dot \theta$ just before a sample, rad/s.
    pub(crate) fn rate_rad_s(&self, state: &PlantState, disturbance_rad: f64) -> f64 {
        let by_state: f64 = self.rate_output.iter().zip(state.values()).map(|(c, x)| c * x).sum();
        by_state + self.rate_feedthrough * self.elevator_rad(state, disturbance_rad)
    }

    /// Elevator in the plant's own sign, disturbance included, rad.
    pub(crate) fn elevator_rad(&self, state: &PlantState, disturbance_rad: f64) -> f64 {
        self.elevator_per_command * (state.deflection_rad() + disturbance_rad)
    }

    /// Moves an ideal servo to its command at once; a real one stays where it is.
    pub(crate) fn settle_ideal_servo(&self, state: &mut PlantState, command_rad: f64) {
        if self.servo.is_at_once() {
            state.set_deflection(self.servo.limited(command_rad));
        }
    }

    /// One sample period with everything held.
    pub(crate) fn advance(
        &self,
        state: &mut PlantState,
        command_rad: f64,
        disturbance_rad: f64,
    ) -> Result<(), SimError> {
        let command_rad = self.servo.limited(command_rad);
        let gap_rad = command_rad - state.deflection_rad();
        let Some((rate_rad_s, duration_s)) = self.servo.rate_limited_phase(gap_rad, self.dt_s)
        else {
            state.advance(&self.free_step, command_rad, disturbance_rad);
            return Ok(());
        };
        if duration_s >= self.dt_s {
            state.advance(&self.ramp_step, rate_rad_s, disturbance_rad);
            return Ok(());
        }
        let ramp = step_rows(&self.ramp, duration_s)?;
        state.advance(&ramp, rate_rad_s, disturbance_rad);
        let free = step_rows(&self.free, self.dt_s - duration_s)?;
        state.advance(&free, command_rad, disturbance_rad);
        Ok(())
    }

    /// True where a limit makes of the coming sample another than the linear one.
    pub(crate) fn is_limited(&self, state: &PlantState, command_rad: f64) -> bool {
        let limited_rad = self.servo.limited(command_rad);
        let gap_rad = limited_rad - state.deflection_rad();
        let rate = self.servo.rate_limited_phase(gap_rad, self.dt_s).is_some();
        rate || (limited_rad - command_rad).abs() > 0.0
    }

    /// The linear part of a sample: what a loop around rest obeys.
    pub(crate) fn linear_step(&self) -> LinearStep {
        let mut rate_row = self.rate_output.clone();
        rate_row.push(self.rate_feedthrough * self.elevator_per_command);
        LinearStep { states: self.order + 1, rows: self.free_step.clone(), rate_row }
    }

    /// What a sample changes of its states: rows of [`linear_step`](Self::linear_step) over states and command, less 1
    /// on the diagonal, and what 64 bits leave out of them.
    pub(crate) fn linear_change(&self, plant: &LinearPlant) -> Result<[Vec<f64>; 2], SimError> {
        let states = self.order + 1;
        let mut rest = generator(
            &plant.transfer_function().state_space_rest(),
            self.elevator_per_command,
            &ServoMotion::Free(self.servo),
        )?;
        for place in 0..self.free.columns() {
            rest.set(self.order, place, 0.0)?;
        }
        let at_once = self.servo.is_at_once().then_some(self.order);
        let generator = FineMatrix::new(self.free.clone(), rest)?;
        part_of_change(&exponential_change(&generator, self.dt_s)?, (states, states), at_once)
    }
}

/// One sample of plant and actuator without limits.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct LinearStep {
    /// States of plant and actuator, pitch angle first.
    pub(crate) states: usize,
    /// Rows over states, command and elevator disturbance, flat.
    pub(crate) rows: Vec<f64>,
    /// Row from states to pitch rate.
    pub(crate) rate_row: Vec<f64>,
}

/// The part over some states and one input; of a state that only remembers its input nothing is left.
pub(crate) fn part_of_change(
    change: &FineMatrix,
    (states, input): (usize, usize),
    remembers: Option<usize>,
) -> Result<[Vec<f64>; 2], SimError> {
    let part = |matrix: &Matrix, [left, kept]: [f64; 2]| {
        let rows = matrix.data().chunks_exact(matrix.columns()).take(states);
        let columns = |row: &[f64]| [&row[..states], &row[input..=input]].concat();
        let mut part: Vec<f64> = rows.flat_map(columns).collect();
        if let Some(place) = remembers {
            let row = &mut part[place * (states + 1)..(place + 1) * (states + 1)];
            row.fill(0.0);
            (row[place], row[states]) = (left, kept);
        }
        part
    };
    Ok([part(change.high(), [-1.0, 1.0]), part(change.low(), [0.0, 0.0])])
}

enum ServoMotion {
    /// Follows its command by its own lag (or at once).
    Free(Servo),
    /// Moves at a constant rate.
    Ramp,
}

/// Generator of plant state, servo and the two held inputs.
fn generator(model: &StateSpace, sign: f64, motion: &ServoMotion) -> Result<Matrix, SimError> {
    let order = model.states();
    let (servo, input, disturbance) = (order, order + 1, order + 2);
    let size = order + 1 + INPUTS;
    let mut rows = vec![vec![0.0; size]; size];
    let elevator = match motion {
        // An ideal servo is its input; its own state only remembers where it is.
        ServoMotion::Free(s) if s.time_constant_s() == 0.0 => input,
        _ => servo,
    };
    let by_elevator = model.b().data();
    for ((row, by_state), by_elevator) in
        rows.iter_mut().zip(model.a().data().chunks_exact(order)).zip(by_elevator)
    {
        row[..order].copy_from_slice(by_state);
        row[elevator] = sign * by_elevator;
        row[disturbance] = sign * by_elevator;
    }
    match motion {
        ServoMotion::Free(s) if s.time_constant_s() > 0.0 => {
            rows[servo][servo] = -1.0 / s.time_constant_s();
            rows[servo][input] = 1.0 / s.time_constant_s();
        }
        ServoMotion::Free(_) => {}
        ServoMotion::Ramp => rows[servo][input] = 1.0,
    }
    Ok(Matrix::from_rows(&rows)?)
}

/// The rows of e^(G t) that belong to plant and servo, flat.
fn step_rows(generator: &Matrix, duration_s: f64) -> Result<Vec<f64>, SimError> {
    let step = exponential(&generator.scaled(duration_s))?;
    let width = generator.columns();
    let servo = width - INPUTS - 1;
    let mut rows = step.data()[..(servo + 1) * width].to_vec();
    let servo_moves =
        generator.data()[servo * width..(servo + 1) * width].iter().any(|g| *g != 0.0);
    if !servo_moves {
        // The remembered deflection of an ideal servo is its last command.
        rows[servo * width..].fill(0.0);
        rows[servo * width + servo + 1] = 1.0;
    }
    Ok(rows)
}
