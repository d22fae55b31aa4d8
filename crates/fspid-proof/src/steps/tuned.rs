//! A self-tuner that remembers, for all flights of a set at once: its gains and its reference model are numbers over the
//! unknowns of the set, as the states of the loop are.
//!
//! What the rules, or a network, add to a gain is a straight line along what the supervisor sees, and an unknown for the rest;
//! what a gain multiplies is the linear part of the product, and an unknown for the rest. Both rests shrink with the square of
//! a box, but where what is seen passes the centre of a set.

use fspid_core::Fspid;
use fspid_core::equations::{LawKind, SecondInputKind, TunerEquations};
use fspid_numeric::scalar::Interval;

use super::affine::Affine;
use super::cut::Line;
use crate::gain_set::Lines;
use crate::reference_model::{model_matrix, most_later};

/// Of the way from any gains to those at rest so much may be left when a step comes.
pub(super) const LEFT: f64 = 1.0 / 1024.0;

/// What a self-tuner remembers at a sample.
#[derive(Clone, Debug)]
pub(super) struct Tuned {
    /// kp, ki, kd.
    pub(super) gains: [Affine; 3],
    /// Pitch of the reference model, rad, and its rate, rad/s.
    pub(super) model: [Affine; 2],
}

impl Tuned {
    /// Everything that is remembered.
    pub(super) fn each(&self) -> impl Iterator<Item = &Affine> {
        self.gains.iter().chain(&self.model)
    }

    /// The same, to be changed.
    pub(super) fn each_mut(&mut self) -> impl Iterator<Item = &mut Affine> {
        self.gains.iter_mut().chain(&mut self.model)
    }
}

/// The tuner of a loop.
#[derive(Clone)]
pub(super) struct Tuner<'a> {
    lines: Lines<'a>,
    equations: TunerEquations<f64>,
    /// Most that the reference model is off later, in units of where it is.
    later: f64,
}

/// What a supervisor is shown.
pub(super) struct Shown<'a> {
    pub(super) error: &'a Affine,
    /// The difference of the error.
    pub(super) change: &'a Affine,
    pub(super) pitch: &'a Affine,
    pub(super) setpoint: &'a Affine,
}

impl<'a> Tuner<'a> {
    /// The tuner of a law with leakage whose supervisor has rules that conclude numbers, or a network; nothing of another.
    pub(super) fn of(fspid: &'a Fspid<f64>) -> Option<Self> {
        let equations = *fspid.tuner_equations();
        let structure = equations.structure;
        let settings = fspid.tuner().settings();
        let leaks = structure.law == LawKind::Accumulating && equations.numbers.leakage_per_s > 0.0;
        let sees = structure.second_input != SecondInputKind::Rate;
        if !(leaks && sees) || settings.dead_zone.is_some() {
            return None;
        }
        let lines = Lines::of(fspid.tuner())?;
        let later = match structure.second_input {
            SecondInputKind::ModelError => most_later(&equations)?,
            SecondInputKind::Change | SecondInputKind::Rate => 0.0,
        };
        Some(Self { lines, equations, later })
    }

    /// At rest: at the controller's first sample the nominal gains, later those of a box. The symbol and the two after it are
    /// those of the gains: one may rise where another falls, and limits end the way of each for itself.
    pub(super) fn begun(&self, rested: [Interval; 3], first: bool, symbol: usize) -> Tuned {
        let gains = [0, 1, 2].map(|gain: usize| {
            let nominal = self.equations.gains[gain].nominal;
            let [lower, upper] = match first {
                true => [nominal; 2],
                false => [rested[gain].lower(), rested[gain].upper()],
            };
            Affine::unknown([lower, upper], symbol + gain)
        });
        Tuned { gains, model: [Affine::default(), Affine::default()] }
    }

    /// How long a rest has to last, s, for gains to have come within [`LEFT`] of the way to those at rest, from wherever they
    /// were: $(1 - \lambda T)^n$ of it is left after n samples.
    pub(super) fn rests_s(&self) -> f64 {
        let numbers = &self.equations.numbers;
        let share = numbers.leakage_per_s * numbers.dt_s;
        let samples = libm::ceil(libm::log(LEFT) / libm::log(1.0 - share.min(0.5))) + 1.0;
        samples * numbers.dt_s
    }

    /// What is remembered after a sample, with the gains that answer it; `symbol` gives a new unknown.
    pub(super) fn after(
        &self,
        now: &Tuned,
        shown: &Shown<'_>,
        symbol: &mut dyn FnMut() -> usize,
    ) -> Tuned {
        let n = self.equations.numbers.map(|number| Interval::point(*number));
        let second = match self.equations.structure.second_input {
            SecondInputKind::ModelError => now.model[0].less(shown.pitch),
            SecondInputKind::Change | SecondInputKind::Rate => {
                shown.change.times(Interval::ONE / n.change_divisor)
            }
        };
        let error = shown.error.times(n.sign * n.error_per_rad);
        let second = second.times(n.sign * n.change_per_rad);
        let lines = self.lines.along([error.range(), second.range()]);
        let keeps = Interval::ONE - n.leakage_per_s * n.dt_s;
        let gains = [0, 1, 2].map(|gain: usize| {
            let (own, line) = (&self.equations.gains[gain], &lines[gain]);
            let per_increment = Interval::point(own.scale) * n.dt_s;
            let beside = line.beside * per_increment;
            let pulled = n.leakage_per_s * n.dt_s * Interval::point(own.nominal);
            let middle = Interval::point(beside.midpoint());
            let constant = Affine::constant(middle + pulled);
            let [by_error, by_second] =
                line.slopes.map(|slope| Interval::point(slope) * per_increment);
            let free = Affine::sum([
                (keeps, &now.gains[gain]),
                (by_error, &error),
                (by_second, &second),
                (Interval::ONE, &constant),
            ]);
            let radius = (beside - middle).magnitude();
            let free = free.and_noise(radius, symbol).owned();
            let within = Line::clamped(free.range(), own.lower, own.upper);
            if within == Line::SAME {
                return free;
            }
            within.of(&free, symbol).owned()
        });
        Tuned { gains, model: self.model_after(now, shown.setpoint) }
    }

    fn model_after(&self, now: &Tuned, setpoint: &Affine) -> [Affine; 2] {
        let [pitch, rate] = &now.model;
        if self.equations.structure.second_input != SecondInputKind::ModelError {
            return now.model.clone();
        }
        let [[by_pitch, by_rate], [held, damped]] = model_matrix(&self.equations);
        // What the set-point adds is what the place no longer pulls.
        let next_rate = Affine::sum([(held, pitch), (damped, rate), (-held, setpoint)]);
        let to_pitch = Interval::ONE - by_pitch;
        let next_pitch = Affine::sum([(by_pitch, pitch), (by_rate, rate), (to_pitch, setpoint)]);
        [next_pitch, next_rate]
    }

    /// Most that the reference model is away from its set-point from now on, rad.
    pub(super) fn model_later(&self, now: &Tuned, setpoint: &Affine) -> f64 {
        let unit = Interval::ONE / Interval::point(self.equations.numbers.bandwidth_rad_s);
        let [pitch, rate] = &now.model;
        if self.equations.structure.second_input != SecondInputKind::ModelError {
            return 0.0;
        }
        let most = pitch.less(setpoint).magnitude().max(rate.times(unit).magnitude());
        (Interval::point(most) * Interval::point(self.later)).upper()
    }

    /// Bounds of the gains of a set: those of its numbers, and their limits.
    pub(super) fn ranges(&self, tuned: &Tuned) -> [Interval; 3] {
        [0, 1, 2].map(|gain: usize| {
            let own = &self.equations.gains[gain];
            let range = tuned.gains[gain].range();
            let limits = Interval::new(own.lower, own.upper).unwrap_or(Interval::ENTIRE);
            range.intersection(limits).unwrap_or(range)
        })
    }

    /// True where gains that lie in a box stay there while error and what is seen beside it, rad, keep to these sizes.
    ///
    /// $k^+ = (1 - \lambda T) k + \lambda T (k' + s \Delta k / \lambda)$ is a mean of two numbers of the box, and so is what limits
    /// make of it, where the box lies within them.
    pub(super) fn keeps(&self, gains: [Interval; 3], seen: [f64; 2]) -> bool {
        let within = |gain: usize| {
            let own = &self.equations.gains[gain];
            gains[gain].lower() >= own.lower && gains[gain].upper() <= own.upper
        };
        let targets = self.targets(seen).into_iter();
        targets.zip(gains).all(|(to, own)| own.encloses(to)) && (0..3).all(within)
    }

    /// Where gains tend to while inputs lie between bounds: their increments over the leakage, within the limits.
    pub(super) fn targets(&self, [error_rad, second_rad]: [f64; 2]) -> [Interval; 3] {
        let n = self.equations.numbers.map(|number| Interval::point(*number));
        let between = |most: f64| Interval::between(-most, most);
        let inputs = [n.error_per_rad * between(error_rad), n.change_per_rad * between(second_rad)];
        let answers = self.lines.over(inputs);
        [0, 1, 2].map(|gain: usize| {
            let own = &self.equations.gains[gain];
            let free = Interval::point(own.nominal)
                + Interval::point(own.scale) * answers[gain] / n.leakage_per_s;
            let within = |end: f64| end.max(own.lower).min(own.upper);
            Interval::between(within(free.lower()), within(free.upper()))
        })
    }

    /// What is seen beside the error is a change of it in this unit; nothing for a reference model.
    pub(super) fn change_divisor(&self) -> Option<f64> {
        let is_model = self.equations.structure.second_input == SecondInputKind::ModelError;
        (!is_model).then_some(self.equations.numbers.change_divisor)
    }
}

#[cfg(test)]
pub(super) mod tests;
