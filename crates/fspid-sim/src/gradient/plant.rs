//! Plants and servos of a group, forwards and backwards.

use crate::actuated::Actuated;
use crate::batch::Refusal;
use crate::error::SimError;
use crate::propagation::Propagation;
use crate::propagator::{INPUTS, Propagator};
use crate::scenario::Prepared;
use crate::surroundings::held;

/// What a sample does to a lane in which the rate limit acts: rows over the states, the arrived command, and what is added.
#[derive(Clone, Debug)]
pub(super) struct Held {
    pub(super) lane: usize,
    rows: Vec<f64>,
    by_command: Vec<f64>,
    added: Vec<f64>,
}

/// Discretised plants with their servos.
#[derive(Clone, Debug)]
pub(super) struct Plants<'a, const W: usize> {
    propagators: Vec<Propagator>,
    /// Moving air of a lane, if it has any.
    air: Vec<Option<(&'a Actuated, &'a Prepared)>>,
    order: usize,
    /// Rows of one sample, entry by entry: those of a state, then its two inputs.
    rows: Vec<[f64; W]>,
    rate_output: Vec<[f64; W]>,
    rate_feedthrough: [f64; W],
    elevator_per_command: [f64; W],
    limits_rad: [[f64; W]; 2],
    /// Gaps to the command within which servos are slower than their rate limits.
    free_gap_rad: [f64; W],
}

impl<'a, const W: usize> Plants<'a, W> {
    pub(super) fn new(lanes: Vec<Lane<'a>>) -> Self {
        let (propagators, air): (Vec<Propagator>, Vec<_>) =
            lanes.into_iter().map(|lane| (lane.propagator, lane.air)).unzip();
        let order = propagators.first().map_or(1, |it| it.order());
        let states = order + 1;
        let mut plants = Self {
            order,
            rows: vec![[0.0; W]; states * (states + INPUTS)],
            rate_output: vec![[0.0; W]; order],
            rate_feedthrough: [0.0; W],
            elevator_per_command: [0.0; W],
            limits_rad: [[f64::NEG_INFINITY; W], [f64::INFINITY; W]],
            free_gap_rad: [f64::INFINITY; W],
            propagators,
            air,
        };
        for (lane, propagator) in plants.propagators.iter().enumerate() {
            for (place, entry) in plants.rows.iter_mut().zip(&propagator.free.step) {
                place[lane] = *entry;
            }
            for (place, entry) in plants.rate_output.iter_mut().zip(propagator.rate_output()) {
                place[lane] = *entry;
            }
            plants.rate_feedthrough[lane] = propagator.rate_feedthrough();
            plants.elevator_per_command[lane] = propagator.elevator_per_command;
            plants.free_gap_rad[lane] = propagator.servo.free_gap_rad();
            if let Some((least, most)) = propagator.servo.command_limits_rad() {
                (plants.limits_rad[0][lane], plants.limits_rad[1][lane]) = (least, most);
            }
        }
        plants
    }

    /// States of plant and servo.
    pub(super) fn states(&self) -> usize {
        self.order + 1
    }

    /// Elevator in the plant's own sign, disturbance included, rad.
    #[inline(always)]
    pub(super) fn elevator_rad(&self, states: &[[f64; W]], disturbance: &[f64; W]) -> [f64; W] {
        let mut elevator = states[self.order];
        for lane in 0..W {
            elevator[lane] = self.elevator_per_command[lane] * (elevator[lane] + disturbance[lane]);
        }
        elevator
    }

    /// Pitch rate, rad/s.
    #[inline(always)]
    pub(super) fn rate_rad_s(&self, states: &[[f64; W]], elevator_rad: &[f64; W]) -> [f64; W] {
        let mut rate = [0.0; W];
        for (output, state) in self.rate_output.iter().zip(states) {
            for lane in 0..W {
                rate[lane] += output[lane] * state[lane];
            }
        }
        for lane in 0..W {
            rate[lane] += self.rate_feedthrough[lane] * elevator_rad[lane];
        }
        rate
    }

    /// Hands what pitch rate and elevator are worth to the states.
    #[inline(always)]
    pub(super) fn back_seen(&self, worth: &mut [[f64; W]], rate: &[f64; W], elevator: &[f64; W]) {
        for (output, worth) in self.rate_output.iter().zip(worth.iter_mut()) {
            for lane in 0..W {
                worth[lane] += output[lane] * rate[lane];
            }
        }
        let deflection = &mut worth[self.order];
        for lane in 0..W {
            let by_elevator = elevator[lane] + self.rate_feedthrough[lane] * rate[lane];
            deflection[lane] += self.elevator_per_command[lane] * by_elevator;
        }
    }

    fn limited(&self, command: &[f64; W]) -> [f64; W] {
        let mut limited = *command;
        for lane in 0..W {
            let below = self.limits_rad[1][lane].min(command[lane]);
            limited[lane] = below.max(self.limits_rad[0][lane]);
        }
        limited
    }

    /// What moving air adds to the states at the next sample, whatever the servo does.
    #[inline(always)]
    pub(super) fn add_air(&self, k: usize, next: &mut [[f64; W]]) {
        for (lane, air) in self.air.iter().enumerate() {
            let Some((actuated, prepared)) = air else { continue };
            let of_air = (prepared.gusts(), prepared.gust_responses.as_deref());
            let held = held(0.0, of_air, k);
            for (state, next) in next.iter_mut().take(self.order).enumerate() {
                let row = actuated.gust_row(state).iter();
                let by_gust: f64 = row.zip(held.gust).map(|(entry, gust)| entry * gust).sum();
                next[lane] += by_gust + held.added.get(state).copied().unwrap_or(0.0);
            }
        }
    }

    /// The states at the next sample, into their place; lanes that the rate limit holds are told.
    #[inline(always)]
    pub(super) fn advance(
        &self,
        (next, mut held): (&mut [[f64; W]], impl FnMut(Held)),
        states: &[[f64; W]],
        command: &[f64; W],
        disturbance: &[f64; W],
    ) -> Result<(), SimError> {
        let command = self.limited(command);
        let width = self.states() + INPUTS;
        for (next, row) in next.iter_mut().zip(self.rows.chunks_exact(width)) {
            let mut sum = [0.0; W];
            for (entry, state) in row.iter().zip(states) {
                for lane in 0..W {
                    sum[lane] += entry[lane] * state[lane];
                }
            }
            let [by_command, by_disturbance] = [&row[width - 2], &row[width - 1]];
            for lane in 0..W {
                next[lane] = sum[lane]
                    + by_command[lane] * command[lane]
                    + by_disturbance[lane] * disturbance[lane];
            }
        }
        let deflection = states[self.order];
        let mut is_held = false;
        for lane in 0..W {
            is_held |= (command[lane] - deflection[lane]).abs() > self.free_gap_rad[lane];
        }
        if !is_held {
            return Ok(());
        }
        for (lane, propagator) in self.propagators.iter().enumerate() {
            let gap_rad = command[lane] - deflection[lane];
            let Some((rate_rad_s, duration_s)) =
                propagator.servo.rate_limited_phase(gap_rad, propagator.dt_s())
            else {
                continue;
            };
            let part = Part { lane, rate_rad_s, duration_s, disturbance_rad: disturbance[lane] };
            let it = part.held(propagator)?;
            let states_of = |row: &[f64]| -> f64 {
                row.iter().zip(states).map(|(entry, state)| entry * state[lane]).sum()
            };
            let rows = it.rows.chunks_exact(self.states()).zip(&it.by_command).zip(&it.added);
            for (next, ((row, by_command), added)) in next.iter_mut().zip(rows) {
                next[lane] = states_of(row) + by_command * command[lane] + added;
            }
            held(it);
        }
        Ok(())
    }

    /// Hands what the next states are worth to the states, and answers what the command is worth.
    #[inline(always)]
    pub(super) fn back(
        &self,
        worth: &[[f64; W]],
        command: &[f64; W],
        held: &[(usize, Held)],
        before: &mut [[f64; W]],
    ) -> [f64; W] {
        let (width, mut of_command) = (self.states() + INPUTS, [0.0; W]);
        before.iter_mut().for_each(|it| *it = [0.0; W]);
        for (worth, row) in worth.iter().zip(self.rows.chunks_exact(width)) {
            for (entry, before) in row.iter().zip(before.iter_mut()) {
                for lane in 0..W {
                    before[lane] += entry[lane] * worth[lane];
                }
            }
            for lane in 0..W {
                of_command[lane] += row[width - 2][lane] * worth[lane];
            }
        }
        for (_, it) in held {
            let lane = it.lane;
            for (state, before) in before.iter_mut().enumerate() {
                let column = it.rows.iter().skip(state).step_by(self.states());
                before[lane] = column.zip(worth).map(|(entry, worth)| entry * worth[lane]).sum();
            }
            let column = it.by_command.iter().zip(worth);
            of_command[lane] = column.map(|(entry, worth)| entry * worth[lane]).sum();
        }
        for lane in 0..W {
            let (least, most) = (self.limits_rad[0][lane], self.limits_rad[1][lane]);
            let is_free = (command[lane] >= least) & (command[lane] <= most);
            of_command[lane] = if is_free { of_command[lane] } else { 0.0 };
        }
        of_command
    }
}

/// A sample that begins with a servo at its rate limit.
struct Part {
    lane: usize,
    rate_rad_s: f64,
    duration_s: f64,
    disturbance_rad: f64,
}

impl Part {
    fn held(&self, propagator: &Propagator) -> Result<Held, SimError> {
        let (first, then) = propagator.rate_limited_rows(self.duration_s)?;
        let states = propagator.order() + 1;
        let width = states + INPUTS;
        let inputs = [self.rate_rad_s, self.disturbance_rad];
        let input = |row: &[f64]| row[states] * inputs[0] + row[states + 1] * inputs[1];
        let mut rows: Vec<f64> =
            first.chunks_exact(width).flat_map(|row| &row[..states]).copied().collect();
        let mut added: Vec<f64> = first.chunks_exact(width).map(input).collect();
        let mut by_command = vec![0.0; states];
        if let Some(then) = then {
            let (before, moved) = (rows.clone(), added.clone());
            for (i, row) in then.chunks_exact(width).enumerate() {
                for j in 0..states {
                    let column = before.iter().skip(j).step_by(states);
                    rows[states * i + j] = row.iter().zip(column).map(|(a, b)| a * b).sum();
                }
                let sum: f64 = row.iter().zip(&moved).map(|(a, b)| a * b).sum();
                added[i] = sum + row[states + 1] * self.disturbance_rad;
                by_command[i] = row[states];
            }
        }
        Ok(Held { lane: self.lane, rows, by_command, added })
    }
}

/// The plant and the servo of a flight, with the air that moves around them.
pub(super) struct Lane<'a> {
    pub(super) propagator: Propagator,
    air: Option<(&'a Actuated, &'a Prepared)>,
}

impl<'a> Lane<'a> {
    /// The only plant of a flight, if it has a gradient here.
    pub(super) fn of(flight: usize, prepared: &'a Prepared) -> Result<Self, Refusal> {
        let refused = |what| Err(Refusal::Part { flight, what });
        let [stage] = prepared.stages.as_slice() else {
            return refused("a plant that changes");
        };
        let (propagator, air) = match &stage.propagation {
            Propagation::AsOne(propagator) => (propagator.clone(), None),
            Propagation::ByLegs(actuated) => match actuated.as_one() {
                Some(Ok(propagator)) => (propagator, Some((actuated, prepared))),
                Some(Err(_)) => return refused("a servo so quick that its matrix overflows"),
                None => return refused("an actuator that is no first-order servo"),
            },
            Propagation::Aircraft(_) => return refused("a nonlinear aircraft"),
            Propagation::External(_) => return refused("another simulator"),
        };
        match propagator.servo.is_at_once() {
            true => refused("a servo without lag"),
            false => Ok(Self { propagator, air }),
        }
    }
}
