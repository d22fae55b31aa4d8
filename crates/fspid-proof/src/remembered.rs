//! Accumulating gains times a constant: the deviation of a remembered gain from its equilibrium as an extra state of the
//! loop.
//!
//! With a set-point weight b other than 1 the command that holds a set-point r has a part $h(k_p) = k_p (b - 1) r$, and
//! off rest it is off by $c d$, with $d = k_p - k_0$ counted from the gain at rest and a bounded c. Under the
//! accumulating law d has a memory of its own,
//!
//! $$ d^+ = \theta \big( (1 - \lambda T) d + T s (\Delta k_p(x) - \Delta k_p(0)) \big), \quad
//! \Delta k_p(x) - \Delta k_p(0) = g \cdot x, \quad z^+ = M(k) z + b_u c \ d^+ $$
//!
//! with the supervisor's inputs x, g within the slopes of its surface, and $0 \le \theta \le 1$ where a limit of the
//! gain cuts off: it only ever brings the gain nearer to rest, which is within the limits. So d is one more state of
//! the loop, and all that is not known of it enters affinely: the corners of k, c, g and θ are enough. Where the
//! supervisor sees the error of a reference model, that model is two more states, which come to rest by themselves.

use fspid_core::fuzzy::OutOfRange;
use fspid_core::{Change, ErrorSign, Fspid, Gains, Law, SecondInput};
use fspid_numeric::scalar::{Base, Interval};
use fspid_sim::Controller;
use fspid_sim::loop_model::LoopModel;

use crate::description::LoopDescription;
use crate::gain_set::{GainSet, HeldCommand, IncrementSlopes, NoSlopes};
use crate::scope::Range;

/// Rules that conclude numbers are off by their own rounding alone, as a share of the range.
const OFF_OF_NUMBERS: f64 = 1.0 / (1_u64 << 38) as f64;

/// Bounds of everything in the memory's equation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Remembered {
    /// Largest magnitude of c, rad per unit of kp.
    by_kp: f64,
    /// Least and largest of what a unit of each input adds to kp in a sample.
    slopes: [[f64; 2]; 2],
    /// A limit may cut kp off.
    may_stop: bool,
    /// What the increments of a sample may be off by, in units of kp.
    pub(crate) off: f64,
}

/// One end of everything.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RememberedCorner {
    by_kp: f64,
    slopes: [f64; 2],
    /// False where a limit holds the gain at rest.
    moves: bool,
}

impl LoopDescription {
    /// States that the memory of gains adds to a loop, for a claim about a range.
    pub(crate) fn remembered_states(&self, range: Range) -> usize {
        let Controller::SelfTuning(fspid) = &self.controller else { return 0 };
        let settings = fspid.tuner().settings();
        let weight = fspid.config().setpoint_weights.proportional;
        let plain = weight - 1.0 == 0.0 && settings.gain_coupling.setpoint_weight == 0.0;
        if settings.law == Law::Memoryless || plain || range.setpoint_rad == 0.0 {
            return 0;
        }
        match settings.second_input {
            SecondInput::ModelError(_) => 3,
            SecondInput::Change | SecondInput::Rate => 1,
        }
    }
}

impl Remembered {
    /// The bounds for a command that is held.
    pub(crate) fn of(
        set: &GainSet,
        fspid: &Fspid<f64>,
        factor: f64,
        held: HeldCommand,
    ) -> Result<Self, NoSlopes> {
        let tuner = fspid.tuner();
        let settings = tuner.settings();
        let supervisor = tuner.supervisor();
        let has_numbers = supervisor.numbers().is_some();
        let level = match supervisor.out_of_range() {
            OutOfRange::Clamp => true,
            OutOfRange::Evaluate => !supervisor.has_labels(),
            // The gains then stay as they are, however far off.
            OutOfRange::Error => false,
        };
        if !level {
            return Err(NoSlopes::BeyondRange);
        }
        if settings.second_input == SecondInput::Rate && fspid.config().rate_gain_s == 0.0 {
            return Err(NoSlopes::OtherInput);
        }
        let range = supervisor.range();
        let known = IncrementSlopes::of_surface(tuner, [range; 2])?;
        let dt_s = Interval::point(fspid.config().dt_s);
        let by = Interval::point(factor) * Interval::point(settings.output_scale.kp) * dt_s;
        let [of_kp, ..] = known.slopes;
        // Beyond the range the surface is level.
        let slopes = of_kp.map(|slope| by * slope.hull(Interval::ZERO));
        let off = if has_numbers { OFF_OF_NUMBERS * range } else { known.off };
        let [kp, ..] = set.bounds();
        let may_stop = settings.gain_limits.is_some_and(|limits| {
            !(limits.kp.lower() < kp.lower() && kp.upper() < limits.kp.upper())
        });
        Ok(Self {
            by_kp: held.by_kp,
            slopes: slopes.map(|slope| [slope.lower(), slope.upper()]),
            may_stop,
            off: (Interval::point(by.magnitude()) * Interval::point(off)).upper(),
        })
    }

    /// All corners.
    pub(crate) fn corners(&self) -> Vec<RememberedCorner> {
        let ends = |[lower, upper]: [f64; 2]| {
            let one = (lower < upper).then_some(upper);
            core::iter::once(lower).chain(one).collect::<Vec<_>>()
        };
        let [by_error, by_second] = self.slopes.map(ends);
        let mut corners = Vec::new();
        for by_kp in [-self.by_kp, self.by_kp] {
            for error in &by_error {
                for second in &by_second {
                    let slopes = [*error, *second];
                    corners.push(RememberedCorner { by_kp, slopes, moves: true });
                }
            }
        }
        if self.may_stop {
            corners.push(RememberedCorner { by_kp: 0.0, slopes: [0.0; 2], moves: false });
        }
        corners
    }

    /// What a unit that the memory is off by adds to the next state, with c at either end.
    pub(crate) fn entries(
        &self,
        model: &LoopModel<Interval>,
        fspid: &Fspid<f64>,
    ) -> [Vec<Interval>; 2] {
        let of_model = model_states(fspid);
        [-self.by_kp, self.by_kp].map(|by_kp| {
            let by = model.by_command().into_iter().map(|entry| entry * Interval::point(by_kp));
            let model = core::iter::repeat_n(Interval::ZERO, of_model);
            by.chain([Interval::ONE]).chain(model).collect()
        })
    }
}

/// States of a reference model.
fn model_states(fspid: &Fspid<f64>) -> usize {
    match fspid.tuner().settings().second_input {
        SecondInput::ModelError(_) => 2,
        SecondInput::Change | SecondInput::Rate => 0,
    }
}

impl RememberedCorner {
    /// The loop with the memory, at some gains: states of the loop, d, pitch and rate of the model.
    pub(crate) fn closed<T: Base>(
        &self,
        model: &LoopModel<T>,
        fspid: &Fspid<f64>,
        gains: Gains<T>,
    ) -> Vec<Vec<T>> {
        let mut rows = model.closed(gains);
        let own = rows.len();
        let more = 1 + model_states(fspid);
        rows.iter_mut().for_each(|row| row.resize(own + more, T::zero()));
        let memory = self.memory(model, fspid, own + more);
        for (row, entry) in rows.iter_mut().zip(model.by_command()) {
            for (place, by_state) in row.iter_mut().zip(&memory) {
                *place = *place + entry * T::constant(self.by_kp) * *by_state;
            }
        }
        rows.push(memory);
        rows.extend(of_model(fspid, own + 1, own + more));
        rows
    }

    /// The next d by state.
    fn memory<T: Base>(&self, model: &LoopModel<T>, fspid: &Fspid<f64>, size: usize) -> Vec<T> {
        let mut memory = vec![T::zero(); size];
        if !self.moves {
            return memory;
        }
        let settings = fspid.tuner().settings();
        let dt_s = T::constant(fspid.config().dt_s);
        let leakage_per_s = match settings.law {
            Law::Memoryless => 0.0,
            Law::Accumulating { leakage_per_s } => leakage_per_s,
        };
        let [error, change] = model.error_rows();
        let own = error.len();
        let sign = match settings.error_sign {
            ErrorSign::SetpointMinusMeasurement => T::one(),
            ErrorSign::MeasurementMinusSetpoint => -T::one(),
        };
        let scale = settings.input_scale;
        let by_error = sign * T::constant(self.slopes[0]) * T::constant(scale.error_per_rad);
        let by_second = sign * T::constant(self.slopes[1]) * T::constant(scale.change_per_rad);
        for (place, entry) in memory.iter_mut().zip(&error) {
            *place = by_error * *entry;
        }
        let mut see = |row: &[T], by: T| {
            for (place, entry) in memory.iter_mut().zip(row) {
                *place = *place + by * *entry;
            }
        };
        match settings.second_input {
            SecondInput::Change => {
                let time_s = match settings.change {
                    Change::Rate => dt_s,
                    Change::Delta => T::one(),
                };
                see(&change, by_second / time_s);
            }
            SecondInput::Rate => {
                let [_, rate] = model.seen_rows();
                see(&rate, -by_second);
            }
            SecondInput::ModelError(_) => {
                // The model is as far behind the set-point as its pitch is off, and the seen pitch by the error.
                see(&error, by_second);
                memory[own + 1] = by_second;
            }
        }
        memory[own] = T::one() - T::constant(leakage_per_s) * dt_s;
        memory
    }
}

/// The rows of a reference model around a set-point that stands still; its first state is at `place`.
fn of_model<T: Base>(fspid: &Fspid<f64>, place: usize, size: usize) -> Vec<Vec<T>> {
    let SecondInput::ModelError(model) = fspid.tuner().settings().second_input else {
        return Vec::new();
    };
    let [bandwidth, damping, dt_s] =
        [model.bandwidth_rad_s, model.damping, fspid.config().dt_s].map(T::constant);
    let spring = bandwidth * bandwidth * dt_s;
    let kept = T::one() - T::constant(2.0) * damping * bandwidth * dt_s;
    let mut pitch = vec![T::zero(); size];
    let mut rate = vec![T::zero(); size];
    (rate[place], rate[place + 1]) = (-spring, kept);
    (pitch[place], pitch[place + 1]) = (T::one() - spring * dt_s, kept * dt_s);
    vec![pitch, rate]
}
