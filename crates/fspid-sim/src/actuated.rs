//! A plant with an [`Actuator`] and gusts from one sample to the next.
//!
//! Between samples the elevator disturbance $d$ and the gusts $g = (u_g, w_g, q_g)$ are held (what the air's change within
//! the sample adds comes from [`gust_response`](crate::gust_response)), and
//! the actuator passes through legs of one linear law each, so that
//!
//! $$ \dot x = A x + s B (\delta + d) + E g $$
//!
//! is solved leg by leg, by the [`law`](crate::law) of the leg. Nothing is allocated.

use crate::actuator::{Actuator, ActuatorState, Course, Leg};
use crate::autopilot::Commands;
use crate::error::SimError;
use crate::generator::Generator;
use crate::gust_response::PlantAir;
use crate::law::{INPUTS, Law, LinearStep, StateVector};
use crate::math::dot;
use crate::plant::LinearPlant;
use crate::propagator::Propagator;

/// What enters the plant beside the command, held over a sample.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Held<'a> {
    /// What an autopilot commands; a linear plant has neither throttle nor bank.
    pub(crate) autopilot: Commands,
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
    generator: Generator,
    follow: Law,
    ramp: Law,
    air: PlantAir,
    rate_row: Vec<f64>,
    elevator_per_command: f64,
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
        let order = plant.order();
        let by_gust = plant.gust_columns().unwrap_or_else(|| no_gusts(order));
        let generator = Generator::of(plant).by_legs(by_gust.clone());
        Ok(Self {
            actuator,
            dt_s,
            order,
            follow: generator.follow(actuator.lag(), dt_s)?,
            ramp: generator.ramp(dt_s)?,
            rate_row: generator.rate_row(),
            air: PlantAir::new(&generator.a, &by_gust),
            elevator_per_command: plant.elevator_sign().per_nose_up(),
            generator,
        })
    }

    /// Plant and servo as one system in calm air, where the actuator is such a servo; what the air does is added to it,
    /// whatever the servo does ([`gust_row`](Self::gust_row)).
    pub(crate) fn as_one(&self) -> Option<Result<Propagator, SimError>> {
        let calm = || self.generator.in_calm_air();
        self.actuator.is_first_order_servo().then(|| {
            Propagator::of_generator(&calm(), self.actuator, self.dt_s, self.elevator_per_command)
        })
    }

    /// What the three gusts, held over a sample, add to a state of the plant at its end.
    pub(crate) fn gust_row(&self, state: usize) -> &[f64] {
        let width = self.order + 2 + INPUTS;
        &self.follow.step[width * (state + 1) - 3..width * (state + 1)]
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

    /// What the air adds to the plant's states over a sample.
    pub(crate) fn by_air(&self, held: &Held<'_>) -> Vec<f64> {
        let mut vector = StateVector::zeros(self.order + 2);
        let [u, w, q] = held.gust;
        self.follow.advance(&mut vector, &[0.0, 0.0, u, w, q]);
        vector.values.truncate(self.order);
        vector.values.iter_mut().zip(held.added).for_each(|(value, more)| *value += more);
        vector.values
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

    /// Of a lag below second order the rate is no state.
    fn linear_states(&self) -> usize {
        self.order + self.actuator.lag().order().max(1)
    }

    /// The linear part of a sample: what a loop around rest obeys.
    pub(crate) fn linear_step(&self) -> LinearStep {
        self.follow.linear_step(self.linear_states(), &self.rate_row)
    }

    /// What a sample changes of the states of [`linear_step`](Self::linear_step), and what 64 bits leave out of it.
    pub(crate) fn linear_change(&self, plant: &LinearPlant) -> Result<[Vec<f64>; 2], SimError> {
        let rest = Generator::of_rest(plant).by_legs(no_gusts(self.order));
        let rest = rest.rows(self.actuator.lag());
        self.follow.change(&rest, self.linear_states(), self.dt_s)
    }
}

fn no_gusts(order: usize) -> [Vec<f64>; 3] {
    [0; 3].map(|_| vec![0.0; order])
}
