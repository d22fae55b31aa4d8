//! Equilibria of a loop under constant set-point and load, and the command there.

use fspid_core::{Fspid, IntegralForm, Law, SecondInput};
use fspid_numeric::scalar::Interval;
use fspid_sim::Controller;
use fspid_sim::loop_model::Followers;

use crate::check::printed;
use crate::description::LoopDescription;
use crate::gain_set::{GainSet, HeldCommand};
use crate::limits::{self, AtLimit};
use crate::scope::Range;

/// The loop at rest, for every set-point and load of a range: largest magnitudes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rest {
    /// The constant part of the command that is multiplied by gains.
    pub(crate) held: HeldCommand,
    /// The command, rad; infinite where nothing bounds it.
    pub(crate) command_rad: f64,
    /// The integral's term, rad, whatever its gain has become since.
    pub(crate) integral_rad: f64,
    /// What the sensor then shows, rad: the set-point, and without an integral the error as well.
    pub(crate) seen_rad: f64,
    /// The error, rad; 0 with an integral, infinite where nothing bounds it.
    pub(crate) error_rad: f64,
    /// What rest depends on.
    pub(crate) any_setpoint: bool,
    pub(crate) any_load: bool,
}

/// Why nothing is said of rest at other set-points or loads than zero.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum NoRest {
    /// An accumulating law moves a constant part of the command long after the error is gone.
    #[error(
        "an accumulating law without leakage, or with the literal integral, moves the command that holds a set-point or a load by gains that remember for ever: nothing is claimed but the return to rest with the set-point at zero and no load"
    )]
    Remembered,
    /// No integral, and no bound of the error that is left.
    #[error(
        "without an integral an error stays, and nothing bounds it here: nothing is claimed but the return to rest with the set-point at zero and no load"
    )]
    NoIntegral,
    /// The integral's gain may be zero at rest.
    #[error(
        "the gain of the integral may be zero at rest, so that nothing need bring the error to zero there"
    )]
    NoIntegralGain,
    /// The plant has no pitch per elevator at rest, or one of zero.
    #[error("the elevator that holds a set-point has no bound")]
    NoSteadyGain,
    /// Something is at its limit already at rest, so that what is linear there is not the loop.
    #[error("{0}")]
    AtLimit(AtLimit),
}

impl Rest {
    /// With nothing to hold, and of a loop that need not come to rest.
    pub(crate) const NOTHING: Self = Self {
        held: HeldCommand::NONE,
        command_rad: 0.0,
        integral_rad: 0.0,
        seen_rad: 0.0,
        error_rad: 0.0,
        any_setpoint: true,
        any_load: true,
    };

    /// Rest of a loop with the gains of a set, within its limits.
    pub(crate) fn of(
        description: &LoopDescription,
        set: &GainSet,
        range: Range,
    ) -> Result<Self, NoRest> {
        let holding = Holding::of(description, set, range);
        let rest = match &description.controller {
            Controller::Fixed(_) => holding.still(),
            Controller::SelfTuning(fspid) => holding.tuned(fspid)?,
        };
        limits::within_at_rest(description, &rest, range).map_err(NoRest::AtLimit)?;
        Ok(rest)
    }
}

/// What there is to hold, enclosed.
struct Holding<'a> {
    description: &'a LoopDescription,
    set: &'a GainSet,
    range: Range,
    /// Command per rad of seen pitch; none where the plant gives no pitch at rest.
    per_pitch: Option<Interval>,
    setpoint: Interval,
    load: Interval,
}

impl<'a> Holding<'a> {
    fn of(description: &'a LoopDescription, set: &'a GainSet, range: Range) -> Self {
        let last = |values: &[f64]| printed(values.last().copied().unwrap_or(0.0));
        let pitch = last(&description.numerator) * Interval::point(description.pitch.scale);
        let per_pitch = Interval::point(description.elevator_sign.per_nose_up())
            * last(&description.denominator)
            / pitch;
        let has_gain = !pitch.contains(0.0) && per_pitch.is_bounded();
        Self {
            description,
            set,
            range,
            per_pitch: has_gain.then_some(per_pitch),
            setpoint: Interval::point(range.setpoint_rad),
            load: Interval::point(range.load_rad)
                + Interval::point(description.actuator.bias_rad().abs()),
        }
    }

    /// The largest command at rest where the error is zero.
    fn command_rad(&self) -> f64 {
        let of_setpoint = self.per_pitch.map_or(f64::INFINITY, |per| {
            (Interval::point(per.magnitude()) * self.setpoint).upper()
        });
        let of_setpoint = if self.range.setpoint_rad == 0.0 { 0.0 } else { of_setpoint };
        (Interval::point(of_setpoint) + self.load).upper()
    }

    /// Largest magnitude of what is fed forward, $k_f r$.
    fn fed_forward(&self) -> Interval {
        let size = self.description.controller.config().feedforward.abs();
        Interval::point(size) * self.setpoint
    }

    /// Largest magnitude of (b - 1) r.
    fn by_weight(&self) -> Interval {
        let weight = self.description.controller.config().setpoint_weights.proportional;
        let off = (Interval::point(weight) - Interval::ONE).magnitude();
        Interval::point(off) * self.setpoint
    }

    /// Largest magnitude of what a unit of kp makes of the command that the weight holds: $h(k_p) = k_p (b - 1) r$ with
    /// $b = b' + s_b (k_p - k_p')$, from the gains at rest to any other,
    ///
    /// $$ \frac{h(k_p) - h(k_0)}{k_p - k_0} = (b' - 1 + s_b (k_p + k_0 - k_p')) r $$
    fn weight_per_kp(&self) -> Interval {
        let Followers { coupling, nominal } = Followers::of(&self.description.controller);
        if coupling.setpoint_weight == 0.0 {
            return self.by_weight();
        }
        let weight = self.description.controller.config().setpoint_weights.proportional;
        let [kp, ..] = self.set.bounds();
        let [at_rest, ..] = self.set.rest;
        let off = Interval::point(weight) - Interval::ONE
            + Interval::point(coupling.setpoint_weight)
                * (kp + at_rest - Interval::point(nominal.kp));
        Interval::point(off.magnitude()) * self.setpoint
    }

    /// Largest magnitude of $k_p (b - 1) r$ at rest.
    fn of_weight_at_rest(&self) -> Interval {
        let [kp, ..] = self.set.rest;
        let Followers { coupling, nominal } = Followers::of(&self.description.controller);
        let size = Interval::point(kp.magnitude());
        if coupling.setpoint_weight == 0.0 {
            return size * self.by_weight();
        }
        let weight = self.description.controller.config().setpoint_weights.proportional;
        let off = Interval::point(weight) - Interval::ONE
            + Interval::point(coupling.setpoint_weight) * (kp - Interval::point(nominal.kp));
        size * Interval::point(off.magnitude()) * self.setpoint
    }

    fn has_integral(&self) -> bool {
        self.description.settings().memory.integral
    }

    /// Gains that stand still: all is linear, whatever is held.
    fn still(&self) -> Rest {
        let [kp, ..] = self.set.rest;
        let (command_rad, error_rad) = match self.has_integral() {
            true => (self.command_rad(), 0.0),
            false => match self.proportional(kp) {
                Some(Proportional { command_rad, error_rad, .. }) => (command_rad, error_rad),
                None => (f64::INFINITY, f64::INFINITY),
            },
        };
        let kp = Interval::point(kp.magnitude());
        Rest {
            held: HeldCommand::NONE,
            command_rad,
            integral_rad: (Interval::point(command_rad)
                + kp * self.by_weight()
                + self.fed_forward())
            .upper(),
            seen_rad: self.seen_at(error_rad),
            error_rad,
            any_setpoint: true,
            any_load: true,
        }
    }

    /// What there is at rest without an integral:
    ///
    /// $$ k_p (b r - y) + k_f r = y / G + d, \qquad b r - y = \frac{b r / G + d - k_f r}{k_p + 1 / G}, \qquad
    ///    r - y = \frac{(1 / G - k_f + k_p (1 - b)) r + d}{k_p + 1 / G} $$
    ///
    /// with G the pitch per command. Some rest there is, as kp is a continuous function of the error.
    fn proportional(&self, kp: Interval) -> Option<Proportional> {
        if self.holds_nothing() {
            return Some(Proportional { command_rad: 0.0, driven_rad: 0.0, error_rad: 0.0 });
        }
        let per = self.per_pitch?;
        let sum = kp + per;
        let weight = self.description.controller.config().setpoint_weights.proportional;
        let size = |value: Interval| Interval::point(value.magnitude());
        let known = !sum.contains(0.0) && sum.is_bounded();
        let weight = Interval::point(weight);
        let fed = Interval::point(self.description.controller.config().feedforward);
        let driven = (size(per * weight - fed) * self.setpoint + self.load) / size_least(sum);
        let error = size((per - fed + kp * (Interval::ONE - weight)) / sum) * self.setpoint
            + self.load / size_least(sum);
        let command = size(kp) * driven + self.fed_forward();
        known.then_some(Proportional {
            command_rad: command.upper(),
            driven_rad: driven.upper(),
            error_rad: error.upper(),
        })
    }

    fn holds_nothing(&self) -> bool {
        self.range == Range::REST && self.load == Interval::ZERO
    }

    /// The pitch that is seen with an error, rad.
    fn seen_at(&self, error_rad: f64) -> f64 {
        (self.setpoint + Interval::point(error_rad)).upper()
    }

    fn tuned(&self, fspid: &Fspid<f64>) -> Result<Rest, NoRest> {
        if !self.has_integral() {
            return self.without_integral(fspid);
        }
        let [_, at_rest, _] = self.set.rest;
        let least = size_least(at_rest);
        if !(least.lower() > 0.0) {
            return Err(NoRest::NoIntegralGain);
        }
        let literal = fspid.config().integral == IntegralForm::Literal;
        let command_rad = self.command_rad();
        let integral = Interval::point(command_rad) + self.of_weight_at_rest() + self.fed_forward();
        let by_kp = self.weight_per_kp().upper();
        let mut rest = Rest {
            held: HeldCommand { by_kp, by_ki: 0.0, at_origin: true },
            command_rad,
            integral_rad: integral.upper(),
            ..self.still()
        };
        rest.any_setpoint = self.plain() && !literal;
        rest.any_load = !literal;
        if literal && integral.upper() > 0.0 {
            if !integral.upper().is_finite() {
                return Err(NoRest::NoSteadyGain);
            }
            let per_gain = integral / least;
            let [_, ki, _] = self.set.bounds();
            rest.held.by_ki = per_gain.upper();
            rest.integral_rad = (per_gain * Interval::point(ki.magnitude())).upper();
        }
        let remembers = match fspid.tuner().settings().law {
            Law::Memoryless => false,
            // Without leakage gains rest wherever they are.
            Law::Accumulating { leakage_per_s } => literal || !(leakage_per_s > 0.0),
        };
        if remembers && !rest.held.is_none() {
            return Err(NoRest::Remembered);
        }
        Ok(rest)
    }

    fn plain(&self) -> bool {
        let weight = self.description.controller.config().setpoint_weights.proportional;
        weight - 1.0 == 0.0 && !self.weight_follows()
    }

    /// True where the set-point weight follows kp.
    fn weight_follows(&self) -> bool {
        Followers::of(&self.description.controller).coupling.setpoint_weight != 0.0
    }

    fn without_integral(&self, fspid: &Fspid<f64>) -> Result<Rest, NoRest> {
        let rest = Rest { any_setpoint: false, any_load: false, ..self.still() };
        if self.holds_nothing() {
            return Ok(rest);
        }
        if fspid.tuner().settings().law != Law::Memoryless {
            return Err(NoRest::Remembered);
        }
        // With another weight at every gain the error that stays is another; and a model's error stays with it.
        let settings = fspid.tuner().settings();
        if self.weight_follows() || settings.second_input != SecondInput::Change {
            return Err(NoRest::NoIntegral);
        }
        let [kp, ..] = self.set.bounds();
        let Proportional { command_rad, driven_rad, error_rad } =
            self.proportional(kp).ok_or(NoRest::NoIntegral)?;
        let at_origin = error_rad == 0.0;
        let held = HeldCommand { by_kp: driven_rad, by_ki: 0.0, at_origin };
        let seen_rad = self.seen_at(error_rad);
        Ok(Rest { held, command_rad, integral_rad: 0.0, seen_rad, error_rad, ..rest })
    }
}

/// Rest without an integral, largest magnitudes, rad.
struct Proportional {
    command_rad: f64,
    /// What kp multiplies.
    driven_rad: f64,
    /// How far the pitch that is seen is from the set-point.
    error_rad: f64,
}

/// The smallest magnitude in an interval, as a number that divides.
fn size_least(value: Interval) -> Interval {
    Interval::point(value.lower().max(-value.upper()).max(0.0))
}

#[cfg(test)]
#[path = "../tests/flown_proofs/drawn.rs"]
#[allow(clippy::expect_used, clippy::indexing_slicing, dead_code, reason = "shared with a test")]
pub(crate) mod drawn;

#[cfg(test)]
mod tests {
    use fspid_core::Law;

    use super::drawn::{self, Dice};
    use super::*;
    use crate::gain_set::{IncrementMap, KnownSlopes};
    use crate::recheck::produced;
    use crate::scope::Asked;

    /// Rest is derived twice, here with bounds and in the simulator for margins: the one holds the other.
    #[test]
    fn what_moving_gains_make_of_a_held_command_lies_within_its_bounds() {
        // Scenarios of a law that does not remember and that holds a command; the first four are quick.
        let seeds = [8, 11, 12, 16, 6, 7, 15, 18];
        let is_long = std::env::var_os("FSPID_LONG_TESTS").is_some();
        let seeds = if is_long { &seeds[..] } else { &seeds[..4] };
        let mut compared = 0;
        for &seed in seeds {
            let scenario = drawn::scenario(&mut Dice::new(seed));
            let (plant, named) = (scenario.plant.linear(), &scenario.controllers[0]);
            let Controller::SelfTuning(fspid) = &named.controller else { continue };
            let plant = plant.expect("linear");
            if fspid.tuner().settings().law != Law::Memoryless {
                continue;
            }
            let Ok(description) = LoopDescription::of(&scenario, plant, &named.controller) else {
                continue;
            };
            let range = Asked::of(&scenario, plant, &description).range;
            let set = IncrementMap::of(fspid.tuner(), 4).expect("bounded").gains(1.0);
            let Ok(rest) = Rest::of(&description, &set, range) else { continue };
            let known = KnownSlopes::default();
            let held = set.holding(fspid, 1.0, rest.held, &known);
            let Some((held, _)) = held.ok().filter(|_| !rest.held.is_none()) else { continue };
            let [kp, ..] = held.bounds();
            let change = held.cells.iter().map(|cell| cell.change_gain).fold(0.0, f64::max);
            let gains = produced(&named.controller, [0.0; 2]);
            let rests = fspid_sim::Rest::all(&scenario, plant, &named.controller, gains);
            for side in rests.iter().flat_map(|rest| &rest.sides) {
                // Slopes of the plain one are differences, good to some digits.
                let slack = 1e-6 * (1.0 + kp.magnitude());
                let by_error = side.gains.kp;
                assert!(kp.lower() - slack <= by_error && by_error <= kp.upper() + slack, "{seed}");
                let by_change = side.change_gain.abs();
                assert!(by_change <= change + slack, "{seed}: {by_change} {change}");
            }
            compared += 1;
        }
        assert_eq!(compared, seeds.len());
    }
}
