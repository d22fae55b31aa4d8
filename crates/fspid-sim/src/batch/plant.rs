//! Plants and servos of all lanes.

use super::lane::{Lanes, Mask, NO, YES, mask};
use fspid_numeric::Real;

use crate::error::SimError;
use crate::propagator::{INPUTS, PlantState, Propagator};

/// Discretised plants with their servos, and where they are.
#[derive(Clone, Debug)]
pub(super) struct Plants<const W: usize> {
    /// Rows of one sample, entry by entry: those of a state, then its two inputs.
    rows: Vec<Lanes<W>>,
    /// States of the plant, then the deflection.
    states: Vec<Lanes<W>>,
    next: Vec<Lanes<W>>,
    rate_output: Vec<Lanes<W>>,
    rate_feedthrough: Lanes<W>,
    elevator_per_command: Lanes<W>,
    /// To both sides.
    command_limit_rad: Lanes<W>,
    rate_limit_rad_s: Lanes<W>,
    time_constant_s: Lanes<W>,
    at_once: Mask<W>,
    /// True if a lane has command limits.
    any_command_limit: bool,
    /// True if a lane has a rate limit.
    any_rate_limit: bool,
    /// True if a lane has a servo without lag.
    any_at_once: bool,
    /// A single flight's state, for samples that a rate limit shapes.
    single: PlantState,
}

/// What an empty sum begins with: minus zero, which leaves every first term its sign.
#[inline(always)]
fn empty_sum() -> f64 {
    std::iter::empty::<f64>().sum()
}

impl<const W: usize> Plants<W> {
    /// Plants of that order at rest, all of them nothing but zeros.
    pub(super) fn at_rest(order: usize) -> Self {
        let zeros = |count: usize| vec![[0.0; W]; count];
        Self {
            rows: zeros((order + 1) * (order + 1 + INPUTS)),
            states: zeros(order + 1),
            next: zeros(order + 1),
            rate_output: zeros(order),
            rate_feedthrough: [0.0; W],
            elevator_per_command: [0.0; W],
            command_limit_rad: [f64::INFINITY; W],
            rate_limit_rad_s: [f64::INFINITY; W],
            time_constant_s: [0.0; W],
            at_once: [NO; W],
            any_command_limit: false,
            any_rate_limit: false,
            any_at_once: false,
            single: PlantState::at_rest(order),
        }
    }

    /// Order of the plants.
    pub(super) fn order(&self) -> usize {
        self.rate_output.len()
    }

    /// Lets a lane go on with this plant from where it is.
    pub(super) fn load(&mut self, lane: usize, propagator: &Propagator) {
        for (place, &entry) in self.rows.iter_mut().zip(&propagator.free.step) {
            place[lane] = entry;
        }
        for (place, &entry) in self.rate_output.iter_mut().zip(propagator.rate_output()) {
            place[lane] = entry;
        }
        self.rate_feedthrough[lane] = propagator.rate_feedthrough();
        self.elevator_per_command[lane] = propagator.elevator_per_command;
        let servo = &propagator.servo;
        let limit_rad = servo.command_limits_rad().map_or(f64::INFINITY, |(_, most)| most);
        self.command_limit_rad[lane] = limit_rad;
        let rate = servo.rate_limit_rad_s().unwrap_or(f64::INFINITY);
        self.rate_limit_rad_s[lane] = rate;
        self.time_constant_s[lane] = servo.lag().trailing_s();
        self.at_once[lane] = mask(servo.is_at_once());
        self.any_at_once |= servo.is_at_once();
        self.any_command_limit |= limit_rad < f64::INFINITY;
        self.any_rate_limit |= rate < f64::INFINITY;
    }

    /// Makes a lane a plant of zeros at rest.
    pub(super) fn park(&mut self, lane: usize) {
        let columns = self.rows.iter_mut().chain(&mut self.states).chain(&mut self.rate_output);
        columns.for_each(|column| column[lane] = 0.0);
        (self.rate_feedthrough[lane], self.elevator_per_command[lane]) = (0.0, 0.0);
        self.rate_limit_rad_s[lane] = f64::INFINITY;
        self.at_once[lane] = NO;
    }

    #[inline(always)]
    pub(super) fn theta_rad(&self) -> Lanes<W> {
        self.states.first().copied().unwrap_or([0.0; W])
    }

    #[inline(always)]
    fn deflection_rad(&self) -> Lanes<W> {
        self.states.last().copied().unwrap_or([0.0; W])
    }

    /// As [`Propagator::elevator_rad`].
    #[inline(always)]
    pub(super) fn elevator_rad(&self, disturbance_rad: &Lanes<W>) -> Lanes<W> {
        let mut elevator_rad = self.deflection_rad();
        for lane in 0..W {
            elevator_rad[lane] =
                self.elevator_per_command[lane] * (elevator_rad[lane] + disturbance_rad[lane]);
        }
        elevator_rad
    }

    /// As [`Propagator::rate_rad_s`].
    #[inline(always)]
    pub(super) fn rate_rad_s(&self, disturbance_rad: &Lanes<W>) -> Lanes<W> {
        let mut rate_rad_s = [empty_sum(); W];
        for (output, state) in self.rate_output.iter().zip(&self.states) {
            for lane in 0..W {
                rate_rad_s[lane] += output[lane] * state[lane];
            }
        }
        let elevator_rad = self.elevator_rad(disturbance_rad);
        for lane in 0..W {
            rate_rad_s[lane] += self.rate_feedthrough[lane] * elevator_rad[lane];
        }
        rate_rad_s
    }

    /// As [`Propagator::settle_ideal_servo`].
    #[inline(always)]
    pub(super) fn settle(&mut self, command_rad: &Lanes<W>) {
        if !self.any_at_once {
            return;
        }
        let command_rad = self.limited(command_rad);
        if let Some(deflection_rad) = self.states.last_mut() {
            for lane in 0..W {
                if self.at_once[lane] == YES {
                    deflection_rad[lane] = command_rad[lane];
                }
            }
        }
    }

    #[inline(always)]
    fn limited(&self, command_rad: &Lanes<W>) -> Lanes<W> {
        let mut inside_rad = *command_rad;
        if !self.any_command_limit {
            return inside_rad;
        }
        for lane in 0..W {
            let limit_rad = self.command_limit_rad[lane];
            inside_rad[lane] = inside_rad[lane].limited(-limit_rad, limit_rad);
        }
        inside_rad
    }

    /// As [`Propagator::advance`] in lanes whose servo no rate limit holds. Answers which are held:
    /// where they were is still there for [`advance_held`](Self::advance_held).
    #[inline(always)]
    pub(super) fn advance(
        &mut self,
        command_rad: &Lanes<W>,
        disturbance_rad: &Lanes<W>,
    ) -> Mask<W> {
        let command_rad = self.limited(command_rad);
        let held = self.held(&command_rad);
        let width = self.states.len();
        for (next, row) in self.next.iter_mut().zip(self.rows.chunks_exact(width + INPUTS)) {
            let (state_part, input_part) = row.split_at(width);
            let mut sum = [empty_sum(); W];
            for (a, x) in state_part.iter().zip(&self.states) {
                for lane in 0..W {
                    sum[lane] += a[lane] * x[lane];
                }
            }
            if let [by_input, by_disturbance] = input_part {
                for lane in 0..W {
                    sum[lane] = sum[lane]
                        + by_input[lane] * command_rad[lane]
                        + by_disturbance[lane] * disturbance_rad[lane];
                }
            }
            *next = sum;
        }
        std::mem::swap(&mut self.states, &mut self.next);
        held
    }

    /// As [`Actuator::rate_limited_phase`](crate::Actuator).
    #[inline(always)]
    fn held(&self, command_rad: &Lanes<W>) -> Mask<W> {
        let mut held = [NO; W];
        if !self.any_rate_limit {
            return held;
        }
        let deflection_rad = self.deflection_rad();
        for lane in 0..W {
            let limit = self.rate_limit_rad_s[lane];
            let gap_rad = command_rad[lane] - deflection_rad[lane];
            let free_gap_rad = limit * self.time_constant_s[lane];
            // Without a limit this is NaN or 0, and so no.
            held[lane] = mask((gap_rad.abs() - free_gap_rad) / limit > 0.0);
        }
        held
    }

    /// The sample that [`advance`](Self::advance) has just passed, anew for a lane that is held.
    #[cold]
    #[inline(never)]
    pub(super) fn advance_held(
        &mut self,
        lane: usize,
        propagator: &Propagator,
        command_rad: f64,
        disturbance_rad: f64,
    ) -> Result<(), SimError> {
        for (value, state) in self.single.values_mut().iter_mut().zip(&self.next) {
            *value = state[lane];
        }
        propagator.advance(&mut self.single, command_rad, disturbance_rad)?;
        for (value, state) in self.single.values().iter().zip(&mut self.states) {
            state[lane] = *value;
        }
        Ok(())
    }
}
