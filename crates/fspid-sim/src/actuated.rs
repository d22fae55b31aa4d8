//! A plant with an [`Actuator`] and gusts from one sample to the next.
//!
//! Between samples the elevator disturbance $d$ and the gusts $g = (u_g, w_g, q_g)$ are held (what the air's change within
//! the sample adds comes from [`gust_response`](crate::gust_response)), and
//! the actuator passes through legs of one linear law each, so that
//!
//! $$ \dot x = A x + s B (\delta + d) + E g $$
//!
//! is solved leg by leg, by the [`law`](crate::law) of the leg. Nothing is allocated.

use fspid_lti::{FineMatrix, Matrix, exponential_change};

use crate::actuator::{Actuator, ActuatorState, Course, Leg};
use crate::error::SimError;
use crate::gust_response::PlantAir;
use crate::law::{INPUTS, Law, StateVector};
use crate::math::dot;
use crate::plant::LinearPlant;
use crate::propagator::{LinearStep, part_of_change};

/// What enters the plant beside the command, held over a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Held<'a> {
    /// Disturbance at the elevator, nose up positive, rad.
    pub(crate) elevator_rad: f64,
    /// The air's velocity forward and down, m/s, and its pitch rate, rad/s.
    pub(crate) gust: [f64; 3],
    /// What the air's change within the sample adds to the states of a linear plant at its end.
    pub(crate) added: &'a [f64],
}

/// Plant, actuator and gusts, discretised for one sample period.
#[derive(Clone, Debug)]
pub(crate) struct Actuated {
    actuator: Actuator,
    dt_s: f64,
    order: usize,
    follow: Law,
    ramp: Law,
    air: PlantAir,
    rate_row: Vec<f64>,
    elevator_per_command: f64,
}

/// How elevator and gusts enter the states of the plant.
struct Entries {
    by_elevator: Vec<f64>,
    by_gust: [Vec<f64>; 3],
}

impl Entries {
    /// Rows of the generator: those of the plant, then two of zeros for deflection and its rate. The
    /// elevator is the deflection, or the leg's input where it `follows_at_once`.
    fn rows(&self, a: &[f64], follows_at_once: bool) -> Vec<Vec<f64>> {
        let order = self.by_elevator.len();
        let input = order + 2;
        let mut rows = vec![vec![0.0; order + 2 + INPUTS]; order + 2];
        for (i, row) in rows.iter_mut().take(order).enumerate() {
            row[..order].copy_from_slice(&a[i * order..(i + 1) * order]);
            row[if follows_at_once { input } else { order }] = self.by_elevator[i];
            row[input + 1] = self.by_elevator[i];
            for (place, column) in self.by_gust.iter().enumerate() {
                row[input + 2 + place] = column[i];
            }
        }
        rows
    }
}

/// State of plant and actuator; the plant's values are followed by the deflection and its rate.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct ActuatedState {
    vector: StateVector,
    actuator: ActuatorState,
}

impl ActuatedState {
    pub(crate) fn theta_rad(&self) -> f64 {
        self.vector.values.first().copied().unwrap_or(0.0)
    }
}

impl Actuated {
    pub(crate) fn new(
        plant: &LinearPlant,
        actuator: Actuator,
        dt_s: f64,
    ) -> Result<Self, SimError> {
        let model = plant.state_space();
        let order = plant.order();
        let elevator_per_command = plant.elevator_sign().per_nose_up();
        let entries = Entries {
            by_elevator: model.b().data().iter().map(|b| elevator_per_command * b).collect(),
            by_gust: plant.gust_columns().unwrap_or_else(|| [0; 3].map(|_| vec![0.0; order])),
        };
        let law = |follows: bool| {
            let mut rows = entries.rows(model.a().data(), follows && actuator.lag().order() == 0);
            actuator_rows(&mut rows[order..], actuator, follows);
            Law::new(&rows, dt_s)
        };
        // θ' is the second state and what the elevator adds to it at once; of a plant of order 1 it
        // is its only equation.
        let mut rate_row = vec![0.0; order + 2];
        match rate_row.get_mut(1) {
            Some(rate) if order > 1 => *rate = 1.0,
            _ => rate_row[..order].copy_from_slice(model.a().data()),
        }
        rate_row[order] = entries.by_elevator.first().copied().unwrap_or(0.0);
        let mut follow = law(true)?;
        if actuator.lag().order() == 0 {
            // The remembered deflection of an ideal actuator is its target.
            follow.remember_input(order);
        }
        Ok(Self {
            actuator,
            dt_s,
            order,
            follow,
            air: PlantAir::new(model.a().data(), &entries.by_gust),
            ramp: law(false)?,
            rate_row,
            elevator_per_command,
        })
    }

    pub(crate) fn at_rest(&self) -> ActuatedState {
        let actuator = ActuatorState::default();
        let mut vector = StateVector::zeros(self.order + 2);
        vector.values[self.order] = self.actuator.deflection_rad(&actuator);
        ActuatedState { vector, actuator }
    }

    /// Pitch rate just before a sample, rad/s.
    pub(crate) fn rate_rad_s(&self, state: &ActuatedState, disturbance_rad: f64) -> f64 {
        let by_elevator = self.rate_row.get(self.order).copied().unwrap_or(0.0);
        dot(&self.rate_row, &state.vector.values) + by_elevator * disturbance_rad
    }

    /// Elevator in the plant's own sign, disturbance included, rad.
    pub(crate) fn elevator_rad(&self, state: &ActuatedState, disturbance_rad: f64) -> f64 {
        let deflection_rad = self.actuator.deflection_rad(&state.actuator);
        self.elevator_per_command * (deflection_rad + disturbance_rad)
    }

    /// Moves an actuator without lag to its command at once; another stays where it is.
    pub(crate) fn settle(&self, state: &mut ActuatedState, command_rad: f64) {
        self.actuator.settle(&mut state.actuator, command_rad);
    }

    /// One sample period with everything held.
    pub(crate) fn advance(&self, state: &mut ActuatedState, command_rad: f64, held: &Held<'_>) {
        let mut actuator = state.actuator;
        self.actuator
            .legs(&mut actuator, command_rad, self.dt_s, |leg| self.pass(state, &leg, held));
        state.actuator = actuator;
        let values = state.vector.values.iter_mut().take(self.order);
        values.zip(held.added).for_each(|(value, more)| *value += more);
    }

    /// How the plant answers to the air.
    pub(crate) fn air(&self) -> &PlantAir {
        &self.air
    }

    /// One leg.
    fn pass(&self, state: &mut ActuatedState, leg: &Leg, held: &Held<'_>) {
        let (law, input) = match leg.course {
            Course::Follow { target_rad } => (&self.follow, target_rad),
            Course::Ramp { rate_rad_s } => (&self.ramp, rate_rad_s),
        };
        let [u, w, q] = held.gust;
        let inputs = [input, held.elevator_rad, u, w, q];
        if let [deflection_rad, rate_rad_s] = &mut state.vector.values[self.order..] {
            (*deflection_rad, *rate_rad_s) = (leg.from_rad, leg.from_rate_rad_s);
        }
        if leg.duration_s >= self.dt_s {
            law.advance(&mut state.vector, &inputs);
        } else {
            law.advance_by_series(&mut state.vector, &inputs, leg.duration_s);
        }
    }

    /// True where a limit makes of the coming sample another than the linear one.
    pub(crate) fn is_limited(&self, state: &ActuatedState, command_rad: f64) -> bool {
        self.actuator.is_limited(&state.actuator, command_rad, self.dt_s)
    }

    /// States of the plant, deflection and, for a lag of second order, its rate: those of
    /// [`linear_step`](Self::linear_step).
    pub(crate) fn values(&self, state: &ActuatedState) -> Vec<f64> {
        let mut values = state.vector.values[..self.order].to_vec();
        values.push(self.actuator.deflection_rad(&state.actuator));
        values.extend((self.actuator.lag().order() == 2).then(|| state.actuator.rate_rad_s()));
        values
    }

    /// Moves one of [`values`](Self::values).
    pub(crate) fn nudge(&self, state: &mut ActuatedState, place: usize, by: f64) {
        match place.checked_sub(self.order) {
            None => state.vector.values[place] += by,
            Some(part) => state.actuator.nudge(part, by),
        }
    }

    /// The linear part of a sample: what a loop around rest obeys. The rate of a lag below second
    /// order is no state of it.
    pub(crate) fn linear_step(&self) -> LinearStep {
        let (all, states) = (self.order + 2, self.order + self.actuator.lag().order().max(1));
        let rows = self.follow.step_rows().take(states);
        let entries = |row: &[f64]| -> Vec<f64> { [&row[..states], &row[all..all + 2]].concat() };
        LinearStep {
            states,
            rows: rows.flat_map(entries).collect(),
            rate_row: self.rate_row.iter().take(states).copied().collect(),
        }
    }
}

impl Actuated {
    /// What a sample changes of the states of [`linear_step`](Self::linear_step), and what 64 bits leave out of it.
    pub(crate) fn linear_change(&self, plant: &LinearPlant) -> Result<[Vec<f64>; 2], SimError> {
        let order = self.actuator.lag().order();
        let rest = plant.transfer_function().state_space_rest();
        let entries = Entries {
            by_elevator: rest.b().data().iter().map(|b| self.elevator_per_command * b).collect(),
            by_gust: [0; 3].map(|_| vec![0.0; self.order]),
        };
        let mut rows = entries.rows(rest.a().data(), order == 0);
        let generator = self.follow.generator()?;
        rows.resize(generator.rows(), vec![0.0; generator.columns()]);
        let generator = FineMatrix::new(generator, Matrix::from_rows(&rows)?)?;
        let at_once = (order == 0).then_some(self.order);
        let places = (self.order + order.max(1), self.order + 2);
        part_of_change(&exponential_change(&generator, self.dt_s)?, places, at_once)
    }
}

/// Rows of deflection and its rate.
fn actuator_rows(rows: &mut [Vec<f64>], actuator: Actuator, follows: bool) {
    let [deflection, rate] = rows else {
        return;
    };
    let place = deflection.len() - INPUTS - 2;
    let [by_deflection, by_rate, by_target] = actuator.lag().coefficients();
    match (follows, actuator.lag().order()) {
        (false, _) => deflection[place + 2] = 1.0,
        (true, 1) => {
            (deflection[place], deflection[place + 2]) = (by_deflection, by_target);
        }
        (true, 2) => {
            deflection[place + 1] = 1.0;
            (rate[place], rate[place + 1], rate[place + 2]) = (by_deflection, by_rate, by_target);
        }
        (true, _) => {}
    }
}
