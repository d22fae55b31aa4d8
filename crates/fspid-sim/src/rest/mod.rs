//! The equilibria of a loop, and the linear loop about each: which pitch, gains and command a constant set-point and load lead to,
//! and whether small motions about them decay. A rest is such an equilibrium.
//!
//! | file | for |
//! | --- | --- |
//! | this one | equilibria of the scenario ([`Rest::all`]), and the loop that is linearised about each ([`Side::model`]) |
//! | `dead_zone` | rests within a dead zone, and the same with the rules as they are beyond its border |
//! | `integral` | whether an integral acts, and what one comes to whose gain is zero at rest |
//! | `slopes` | linearisation of the rules: slopes of the gains in every direction from an equilibrium, where kinks make them several |
//! | `stand` | stability: poles of the linear loop, and with kinks motions of the piecewise linear one ([`Stand`]) |
//! | `clocked` | stability where a sensor has a sample period of its own: the loop of a whole period of both |
//! | `doubt` | every reason why stability is undecided, with its sentence ([`Doubt`]) |
//!
//! Saturation is not here: about an equilibrium no limit of controller or servo acts. Whether limits leave the command that an
//! equilibrium takes is asked in `held_limits`, and what they make of large motions in [`describing`](crate::describing) and in
//! flight.
//!
//! # The linear loop where gains move
//!
//! At rest the command is not zero: it holds the plant. Of that command a part is the product of a gain
//! and a constant. With a set-point weight b other than 1, $k_p (b r - y)$ is $k_p e + k_p (b - 1) r$; the
//! literal integral is $k_i T \sum e$ with a sum that stands still. Where a gain moves with the error, so does
//! that part of the command:
//!
//! $$ \delta u = k_p e + \dots + A \frac{\partial k_p}{\partial x} \cdot \delta x +
//!  C \frac{\partial k_i}{\partial x} \cdot \delta x, \qquad A = (b - 1) r, \quad C = \frac{I}{k_i} $$
//!
//! with the supervisor's inputs x and the integral's term I at rest. With b = 1 and the bumpless integral
//! both are zero, and the loop at rest is the same at every set-point.
//!
//! A rate sensor with a bias shows a rate at rest. Where the gain of the rate loop follows kd, that adds
//! $-s_r q \partial k_d / \partial x$ in the same way.
//!
//! The surfaces of rules have kinks, often right at rest: there the loop is another one on each side, see [`Stand`].
//!
//! Gains of an accumulating law with leakage λ follow the inputs late. What they add to such a part of the command is a
//! state of the loop, in place of the sum above:
//!
//! $$ w_k = (1 - \lambda T) w_{k-1} + \lambda T \left( A \frac{\partial k_p}{\partial x} +
//!  C \frac{\partial k_i}{\partial x} \right) \cdot \delta x_k $$
//!
//! with the gains k(x) that inputs x would bring about if they stayed, $k' + s \Delta k(x) / \lambda$ within the limits.
//!
//! Not here either: accumulating laws without leakage, which have no gains at rest, and the size of a motion for which this is
//! a good approximation.

mod clocked;
mod dead_zone;
mod doubt;
mod integral;
mod outer;
mod slopes;
mod stand;
#[cfg(test)]
mod tests;

use fspid_core::{ErrorSign, Fspid, Gains, IntegralForm, Law, PidConfig, SecondInput};

use crate::controller::Controller;
use crate::error::SimError;
use crate::loop_model::{Gathered, LoopModel, LoopSettings, Memory, SampledPlant};
use crate::plant::LinearPlant;
use crate::scenario::Scenario;
use crate::sensor::Sensor;
use crate::steady::Steady;
use integral::integrates;
use slopes::{DIRECTIONS, Slopes};

pub use doubt::Doubt;
pub(crate) use integral::{has_integral, may_not_come_to_rest};
pub use stand::Stand;
pub(crate) use stand::{Found, stand_of_sides};

/// Halvings in which the pitch at rest is looked for, and doublings of how far from the set-point.
const HALVINGS: usize = 60;
/// Steps over the supervisor's range in which errors at rest are told apart.
const STEPS: u32 = 128;
/// Where there is no integral the error at rest moves through the rules as the set-point grows: it is looked at in
/// this many steps to the furthest one.
const LADDER: u32 = 4;

/// The set-point and the load that are held while a loop rests.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RestPoint {
    /// The set-point, rad from the trim.
    pub setpoint_rad: f64,
    /// The command, rad and nose up positive, that loads and offsets of the pitch sensor ask for, and that holds the trim of an
    /// aircraft that has become another.
    pub load_rad: f64,
}

impl RestPoint {
    /// Nothing is held.
    pub const TRIM: Self = Self { setpoint_rad: 0.0, load_rad: 0.0 };
}

/// A controller at rest while a set-point and a load are held.
#[derive(Clone, Debug, PartialEq)]
pub struct Rest {
    /// What is held; of several points with the same loop the first that was looked at, the trim before all others.
    pub at: RestPoint,
    /// It is a set-point that loops around the pitch loop may command, and the scenario does not.
    pub is_only_commanded: bool,
    /// It is the rest of a controller without its dead zone: what motions beyond the zone's border are pulled to.
    pub is_beyond_dead_zone: bool,
    /// The loops there: one, or one for each side of the kinks that the rules have there.
    pub sides: Vec<Side>,
    /// Which of them a motion in each direction is on.
    of_direction: [usize; DIRECTIONS],
    /// What the supervisor sees of a unit of error, and of what stands beside it.
    seen_per_unit: [f64; 2],
    /// What stands beside it.
    second_input: SecondInput<f64>,
}

/// The loop at rest for motions to one side.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Side {
    /// The gains, and with them what a held command adds to the gain on the error.
    pub gains: Gains<f64>,
    /// What it adds on the change of the error, rad per rad and sample.
    pub change_gain: f64,
    /// What it adds to the gain of the rate loop, s.
    pub rate_gain_s: f64,
    /// What it adds in place of all these where the gains remember.
    pub gathered: Option<Gathered<f64>>,
}

impl Side {
    /// For gains that do not move.
    const fn still(gains: Gains<f64>) -> Self {
        Self { gains, change_gain: 0.0, rate_gain_s: 0.0, gathered: None }
    }

    /// The loop of one of a scenario's plants at rest on this side.
    ///
    /// # Errors
    /// [`SimError`] where the plant cannot be sampled.
    pub fn model(
        &self,
        scenario: &Scenario,
        plant: &LinearPlant,
        controller: &Controller,
    ) -> Result<LoopModel<f64>, SimError> {
        Ok(self.around(scenario, &SampledPlant::of(scenario, plant)?, controller, false))
    }

    fn config(&self, controller: &Controller) -> PidConfig<f64> {
        let config = controller.config_at(self.gains);
        PidConfig { rate_gain_s: config.rate_gain_s + self.rate_gain_s, ..config }
    }

    fn memory(&self, controller: &Controller) -> Memory {
        let memory = Memory::of_gains(self.gains, &self.config(controller));
        let sees_change =
            self.change_gain != 0.0 || self.gathered.is_some_and(|it| it.by_change != 0.0);
        if sees_change { memory.with_previous() } else { memory }
    }

    /// The same with a plant that is sampled already; beside other sides it remembers the last sample, as they do.
    fn around(
        &self,
        scenario: &Scenario,
        plant: &SampledPlant<f64>,
        controller: &Controller,
        beside_others: bool,
    ) -> LoopModel<f64> {
        let memory = self.memory(controller);
        let memory = if beside_others { memory.with_previous() } else { memory };
        let settings = LoopSettings::of(scenario, &self.config(controller), memory);
        let model = LoopModel::new(plant.clone(), settings).with_change_gain(self.change_gain);
        model.with_gathered(self.gathered)
    }
}

impl Rest {
    /// Rest for gains that do not move: the same at every set-point.
    #[must_use]
    pub fn still(gains: Gains<f64>) -> Self {
        Self {
            at: RestPoint::TRIM,
            is_only_commanded: false,
            is_beyond_dead_zone: false,
            sides: vec![Side::still(gains)],
            of_direction: [0; DIRECTIONS],
            seen_per_unit: [1.0; 2],
            second_input: SecondInput::Change,
        }
    }

    /// All ways in which a controller with `gains` at rest holds one of a scenario's plants at the trim, at the set-points that
    /// the scenario holds, and at the furthest ones of it and of the loops around the pitch loop, without a load and under the
    /// largest ones; one where they do not differ.
    #[must_use]
    pub fn all(
        scenario: &Scenario,
        plant: &LinearPlant,
        controller: &Controller,
        gains: Gains<f64>,
    ) -> Vec<Self> {
        let still = Self::still(gains);
        let Controller::SelfTuning(fspid) = controller else { return vec![still] };
        let steady = scenario.resting();
        let rate_rad_s = rate_bias_rad_s(scenario);
        let leakage_per_s = leakage_per_s(fspid);
        if leakage_per_s == Some(0.0) {
            return vec![still];
        }
        let held = Holding {
            fspid,
            command_per_pitch: command_per_pitch(scenario, plant),
            gains,
            leakage_per_s,
        };
        if is_the_same_everywhere(fspid, rate_rad_s) {
            return held.still_beside(still);
        }
        // A seen rate is no load here: it has its own place in the controller.
        let loads = loads_rad(scenario, plant);
        let own = held.setpoints(&steady).into_iter().chain(scenario.setpoint.held_rad());
        let own = own.map(|setpoint_rad| (setpoint_rad, false));
        let commanded = scenario.commanded_rad().into_iter().flatten();
        let commanded = commanded.map(|setpoint_rad| (setpoint_rad, true));
        let mut found: Vec<Self> = Vec::new();
        for (setpoint_rad, is_only_commanded) in own.chain(commanded) {
            for &load_rad in &loads {
                for rest in held.at(RestPoint { setpoint_rad, load_rad }, rate_rad_s) {
                    if !found.iter().any(|known| known.says_as_much_as(&rest)) {
                        found.push(Self { is_only_commanded, ..rest });
                    }
                }
            }
        }
        found
    }

    /// True where what is held changes the loop at rest.
    #[must_use]
    pub fn depends_on_what_is_held(scenario: &Scenario, controller: &Controller) -> bool {
        let rate_rad_s = rate_bias_rad_s(scenario);
        match controller {
            Controller::Fixed(_) => false,
            Controller::SelfTuning(fspid) => !is_the_same_everywhere(fspid, rate_rad_s),
        }
    }

    /// True for the same loop, of the same controller, whose verdict is no less certain.
    fn says_as_much_as(&self, other: &Self) -> bool {
        self.sides == other.sides
            && self.of_direction == other.of_direction
            && (!self.is_beyond_dead_zone || other.is_beyond_dead_zone)
    }
}

/// What a rate sensor shows at rest; a bias is drawn once, with its sign.
pub(crate) fn rate_bias_rad_s(scenario: &Scenario) -> f64 {
    scenario.surroundings.rate_sensor.as_ref().map_or(0.0, Sensor::bias)
}

/// Leakage of a law that accumulates, 1/s; none of one that does not.
pub(crate) fn leakage_per_s(fspid: &Fspid<f64>) -> Option<f64> {
    match fspid.tuner().settings().law {
        Law::Memoryless => None,
        Law::Accumulating { leakage_per_s } => Some(leakage_per_s),
    }
}

/// The gains that a self-tuner comes to with everything at zero; none where they gather without end.
pub(crate) fn settled(fspid: &Fspid<f64>) -> Option<Gains<f64>> {
    let tuner = fspid.tuner();
    let Some(leakage_per_s) = leakage_per_s(fspid) else { return Some(tuner.gains_at_rest()) };
    let is_silent = tuner.settings().dead_zone.is_some();
    let added = tuner.increments_where_seen(0.0, 0.0).filter(|_| !is_silent);
    let (added, nominal) = (added.unwrap_or(Gains::ZERO), tuner.nominal());
    // Nothing gathers to nothing, without leakage too.
    let free = |nominal: f64, added: f64| match added {
        0.0 => nominal,
        added => nominal + added / leakage_per_s,
    };
    let [kp, ki, kd] =
        [free(nominal.kp, added.kp), free(nominal.ki, added.ki), free(nominal.kd, added.kd)];
    let gains = tuner.settings().gain_limits.map_or(Gains { kp, ki, kd }, |limits| Gains {
        kp: limits.kp.clamp(kp),
        ki: limits.ki.clamp(ki),
        kd: limits.kd.clamp(kd),
    });
    gains.checked().ok()
}

/// What the command has to be per rad of seen pitch.
pub(crate) fn command_per_pitch(scenario: &Scenario, plant: &LinearPlant) -> f64 {
    let sensor = scenario.surroundings.pitch_sensor;
    let scale = sensor.map_or(1.0, |it| 1.0 + it.model().scale_error);
    1.0 / (scale * plant.steady_gain())
}

/// Pitches, as they are seen, at which a plant rests whose controller has no integral with `gains` at rest: where the command
/// that they bring about is the one that holds it. A self-tuner whose integral acts elsewhere comes to the set-point; one whose
/// gains gather without end comes from what `gains` hold towards the set-point.
pub(crate) fn pitches_without_integral(
    scenario: &Scenario,
    plant: &LinearPlant,
    controller: &Controller,
    gains: Gains<f64>,
    at: RestPoint,
) -> Vec<f64> {
    let command_per_pitch = command_per_pitch(scenario, plant);
    let rate_rad_s = rate_bias_rad_s(scenario);
    let RestPoint { setpoint_rad, load_rad } = at;
    let config = controller.config_at(gains);
    let by_setpoint = gains.kp * config.setpoint_weights.proportional + config.feedforward;
    let commanded_rad = by_setpoint * setpoint_rad - config.rate_gain_s * rate_rad_s - load_rad;
    let with_gains_rad = commanded_rad / (command_per_pitch + gains.kp);
    match controller {
        Controller::Fixed(_) => vec![with_gains_rad],
        Controller::SelfTuning(fspid) if integrates(fspid) => vec![setpoint_rad],
        Controller::SelfTuning(fspid) => match leakage_per_s(fspid) {
            Some(0.0) => vec![with_gains_rad, setpoint_rad],
            leakage_per_s => {
                let held = Holding { fspid, command_per_pitch, gains, leakage_per_s };
                let errors = held.errors_at_rest(at, rate_rad_s);
                errors.into_iter().map(|error_rad| setpoint_rad - error_rad).collect()
            }
        },
    }
}

/// The loads under which a plant may rest, none and the largest to either side, with what holds an aircraft's trim away from that
/// of the start.
fn loads_rad(scenario: &Scenario, plant: &LinearPlant) -> Vec<f64> {
    let ends = scenario.resting_loads_rad(plant).into_iter().filter(|load_rad| *load_rad != 0.0);
    std::iter::once(0.0).chain(ends).map(|load_rad| plant.held_away_rad() + load_rad).collect()
}

/// True where no constant is multiplied by a gain that moves, and there is an integral that brings the error to zero.
fn is_the_same_everywhere(fspid: &Fspid<f64>, rate_rad_s: f64) -> bool {
    let (config, settings) = (fspid.config(), fspid.tuner().settings());
    let gain_coupling = settings.gain_coupling;
    let shows_rate = gain_coupling.rate_gain != 0.0 || settings.second_input == SecondInput::Rate;
    let plain = (config.setpoint_weights.proportional - 1.0) == 0.0
        && gain_coupling.setpoint_weight == 0.0
        && config.integral == IntegralForm::Bumpless
        && !(shows_rate && rate_rad_s != 0.0);
    plain && integrates(fspid)
}

/// A self-tuning controller that holds a plant.
struct Holding<'a> {
    fspid: &'a Fspid<f64>,
    command_per_pitch: f64,
    /// At rest with everything at zero.
    gains: Gains<f64>,
    /// Of an accumulating law, 1/s.
    leakage_per_s: Option<f64>,
}

/// Constants that gains multiply at rest: derivatives of the command by kp, ki, kd.
#[derive(Clone, Copy)]
struct Held {
    by_kp: f64,
    by_ki: f64,
    by_kd: f64,
}

impl Holding<'_> {
    /// Set-points at which rest is looked at.
    fn setpoints(&self, steady: &Steady) -> Vec<f64> {
        let steps = if integrates(self.fspid) { 1 } else { LADDER };
        let towards =
            |end: f64| (1..=steps).map(move |step| end * f64::from(step) / f64::from(steps));
        let [least, most] = steady.setpoint_rad;
        let mut setpoints = vec![0.0];
        for setpoint_rad in towards(least).chain(towards(most)).filter(|it| *it != 0.0) {
            setpoints.push(setpoint_rad);
        }
        setpoints
    }

    /// Rest at a set-point under a load with a rate that is seen and not there: one, or several without an integral.
    fn at(&self, at: RestPoint, rate_rad_s: f64) -> Vec<Rest> {
        let errors = match integrates(self.fspid) {
            true => vec![0.0],
            false => self.errors_at_rest(at, rate_rad_s),
        };
        let rests = errors.into_iter().flat_map(|error_rad| {
            let held = [error_rad, rate_rad_s];
            [Some(self.with_error(at, rate_rad_s, error_rad)), self.beyond_dead_zone(at, held)]
        });
        rests.flatten().collect()
    }

    fn with_error(&self, at: RestPoint, rate_rad_s: f64, error_rad: f64) -> Rest {
        let centre = self.seen(error_rad, rate_rad_s);
        let is_zero = centre.iter().all(|seen| *seen == 0.0);
        let is_silent = self.is_silent([error_rad, rate_rad_s]);
        let gains = match is_silent || is_zero {
            true => self.gains,
            false => self.gains_at(centre),
        };
        self.with_gains(at, [error_rad, rate_rad_s], gains, is_silent)
    }

    /// Rest with this error and a rate that is seen and not there, with these gains, which small motions move but where the
    /// supervisor is silent.
    fn with_gains(
        &self,
        at: RestPoint,
        [error_rad, rate_rad_s]: [f64; 2],
        gains: Gains<f64>,
        is_silent: bool,
    ) -> Rest {
        let RestPoint { setpoint_rad, load_rad } = at;
        let centre = self.seen(error_rad, rate_rad_s);
        let config = self.fspid.config_at(gains);
        let gain_coupling = self.fspid.tuner().settings().gain_coupling;
        let pitch_rad = setpoint_rad - error_rad;
        let by_kp = config.setpoint_weights.proportional * setpoint_rad - pitch_rad;
        let integral_rad = self.command_per_pitch * pitch_rad + load_rad
            - gains.kp * by_kp
            - config.feedforward * setpoint_rad
            + config.rate_gain_s * rate_rad_s;
        let held = Held {
            // The error's own part of kp e is in the gains.
            by_kp: by_kp + gain_coupling.setpoint_weight * gains.kp * setpoint_rad,
            by_ki: match config.integral {
                IntegralForm::Literal if gains.ki != 0.0 => integral_rad / gains.ki,
                _ => 0.0,
            },
            by_kd: -gain_coupling.rate_gain * rate_rad_s,
        };
        self.around(at, (gains, held), centre, is_silent)
    }

    /// Rest with these gains and constants where the supervisor sees this.
    fn around(
        &self,
        at: RestPoint,
        (gains, held): (Gains<f64>, Held),
        centre: [f64; 2],
        is_silent: bool,
    ) -> Rest {
        let (mut sides, mut known): (Vec<Side>, Vec<Slopes>) = (Vec::new(), Vec::new());
        let around = match is_silent {
            true => [Slopes::default(); DIRECTIONS],
            false => self.slopes_around(centre),
        };
        let of_direction = around.map(|slopes| {
            let place = known.iter().position(|it| it.is_near(&slopes));
            place.unwrap_or_else(|| {
                known.push(slopes);
                sides.push(self.side(gains, slopes, held));
                known.len() - 1
            })
        });
        let mut rest = Rest {
            at,
            is_only_commanded: false,
            is_beyond_dead_zone: false,
            sides,
            of_direction,
            seen_per_unit: self.seen_per_unit(),
            second_input: self.fspid.tuner().settings().second_input,
        };
        rest.join_equal_sides();
        rest
    }

    fn side(&self, gains: Gains<f64>, slopes: Slopes, held: Held) -> Side {
        let along = |input: usize| {
            held.by_kp * slopes.kp[input]
                + held.by_ki * slopes.ki[input]
                + held.by_kd * slopes.kd[input]
        };
        let (of_error, beside) = (along(0), along(1));
        let mut side = Side::still(gains);
        if let Some(leakage_per_s) = self.leakage_per_s {
            side.gathered = Some(self.gathered(leakage_per_s, [of_error, beside]));
            return side;
        }
        side.gains.kp += of_error;
        match self.fspid.tuner().settings().second_input {
            SecondInput::Change => side.change_gain = beside,
            // What is seen is the rate with its sign turned, as the rate loop takes it off.
            SecondInput::Rate => side.rate_gain_s = beside,
            // The model has come to rest at the set-point.
            SecondInput::ModelError(_) => side.gains.kp += beside,
        }
        side
    }

    /// The same where gains come to it late.
    fn gathered(&self, leakage_per_s: f64, [of_error, beside]: [f64; 2]) -> Gathered<f64> {
        let leaks = leakage_per_s * self.fspid.config().dt_s;
        let [of_error, beside] = [leaks * of_error, leaks * beside];
        let still =
            Gathered { keeps: 1.0 - leaks, by_error: of_error, by_change: 0.0, by_rate: 0.0 };
        match self.fspid.tuner().settings().second_input {
            SecondInput::Change => Gathered { by_change: beside, ..still },
            SecondInput::Rate => Gathered { by_rate: beside, ..still },
            SecondInput::ModelError(_) => Gathered { by_error: of_error + beside, ..still },
        }
    }

    /// The errors at rest without an integral: where rules weaken the gain as the error grows there may be several.
    fn errors_at_rest(&self, at: RestPoint, rate_rad_s: f64) -> Vec<f64> {
        let RestPoint { setpoint_rad, load_rad } = at;
        let missing = |error_rad: f64| {
            let gains = self.gains_at(self.seen(error_rad, rate_rad_s));
            let config = self.fspid.config_at(gains);
            let pitch_rad = setpoint_rad - error_rad;
            gains.kp * (config.setpoint_weights.proportional * setpoint_rad - pitch_rad)
                + config.feedforward * setpoint_rad
                - self.command_per_pitch * pitch_rad
                - load_rad
                - config.rate_gain_s * rate_rad_s
        };
        let range = self.fspid.tuner().supervisor().range();
        let range_rad = (range / self.seen_per_unit()[0]).abs();
        let inside = (0..=STEPS).map(|step| (f64::from(step) / f64::from(STEPS) - 0.5) * 2.0);
        let mut places: Vec<f64> = inside.map(|share| share * range_rad).collect();
        let mut far_rad = range_rad;
        for _ in 0..HALVINGS {
            far_rad *= 2.0;
            places.extend([-far_rad, far_rad]);
        }
        places.sort_by(f64::total_cmp);
        let mut found: Vec<f64> = Vec::new();
        for ends in places.windows(2) {
            let (mut near, mut far) = (ends[0], ends[1]);
            if !(missing(near) * missing(far) <= 0.0) {
                continue;
            }
            for _ in 0..HALVINGS {
                let middle = 0.5 * (near + far);
                if missing(near) * missing(middle) <= 0.0 { far = middle } else { near = middle }
            }
            // A root at a place itself is found on both sides of it.
            let known = found.last().is_some_and(|last| (near - last).abs() <= 1e-12 * range_rad);
            if !known {
                found.push(near);
            }
        }
        found
    }

    fn sign(&self) -> f64 {
        match self.fspid.tuner().settings().error_sign {
            ErrorSign::SetpointMinusMeasurement => 1.0,
            ErrorSign::MeasurementMinusSetpoint => -1.0,
        }
    }

    /// What the supervisor sees of a constant error and a constant rate.
    fn seen(&self, error_rad: f64, rate_rad_s: f64) -> [f64; 2] {
        let [per_error, beside] = self.seen_per_unit();
        let second = match self.fspid.tuner().settings().second_input {
            SecondInput::Change => 0.0,
            SecondInput::Rate => -beside * rate_rad_s,
            SecondInput::ModelError(_) => beside * error_rad,
        };
        [per_error * error_rad, second]
    }

    /// The gains where the supervisor sees this; the nominal ones where it refuses to answer.
    fn gains_at(&self, [error, beside]: [f64; 2]) -> Gains<f64> {
        let tuner = self.fspid.tuner();
        let nominal = tuner.nominal();
        let Some(added) = tuner.increments_where_seen(error, beside) else { return nominal };
        // Where gains remember, what they come to if the inputs stay.
        let lasting = self.leakage_per_s.map_or(1.0, |leakage_per_s| 1.0 / leakage_per_s);
        let free = Gains {
            kp: nominal.kp + lasting * added.kp,
            ki: nominal.ki + lasting * added.ki,
            kd: nominal.kd + lasting * added.kd,
        };
        tuner.settings().gain_limits.map_or(free, |limits| Gains {
            kp: limits.kp.clamp(free.kp),
            ki: limits.ki.clamp(free.ki),
            kd: limits.kd.clamp(free.kd),
        })
    }
}
