//! The loop at rest while a set-point is held, with what gains that move make of the command there.
//!
//! At rest the command is not zero: it holds the plant. Of that command a part is the product of a gain
//! and a constant. With a set-point weight b other than 1, $k_p (b r - y)$ is $k_p e + k_p (b - 1) r$; the
//! literal integral is $k_i T \sum e$ with a sum that stands still. Where a gain moves with the error, so does
//! that part of the command:
//!
//! $$ \delta u = k_p e + \dots + A \frac{\partial k_p}{\partial x} \cdot \delta x
//!  + C \frac{\partial k_i}{\partial x} \cdot \delta x, \qquad A = (b - 1) r, \quad C = \frac{I}{k_i} $$
//!
//! with the supervisor's inputs x and the integral's term I at rest. With b = 1 and the bumpless integral
//! both are zero, and the loop at rest is the same at every set-point.
//!
//! Not here: accumulating laws, whose gains do not follow the inputs of the moment, and the size of a motion
//! for which this is a good approximation.

use core::f64::consts::PI;

use fspid_core::{Change, ErrorSign, Fspid, Gains, IntegralForm, Law, Sees, Shell};

use crate::controller::Controller;
use crate::error::SimError;
use crate::loop_model::{LoopModel, Memory};
use crate::math::sin_cos;
use crate::plant::LinearPlant;
use crate::scenario::Scenario;

/// Places around rest at which slopes are taken: as many sides may a surface with kinks have there.
const SIDES: u32 = 16;
/// How far from rest, and how far apart the two values of a difference, as shares of the supervisor's range.
/// Values are good to some $10^{-13}$ of it.
const AROUND: f64 = 1e-5;
const APART: f64 = 1e-7;
/// Slopes that differ by less are the same.
const SAME: f64 = 1e-4;
/// Halvings in which the pitch at rest is looked for.
const HALVINGS: usize = 80;

/// A controller at rest.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AtRest {
    /// The set-point that is held, rad from the trim.
    pub setpoint_rad: f64,
    /// The gains, and with them what a held command adds to the gain on the error.
    pub gains: Gains<f64>,
    /// What it adds on the change of the error, rad per rad and sample.
    pub change_gain: f64,
    /// What it adds to the gain of the rate loop, s.
    pub rate_gain_s: f64,
}

/// Slopes of kp and ki along error, change and seen rate, in units of the loop.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Slopes {
    kp: [f64; 2],
    ki: [f64; 2],
}

impl AtRest {
    /// Rest with the set-point at the trim, for gains that do not move.
    #[must_use]
    pub const fn still(gains: Gains<f64>) -> Self {
        Self { setpoint_rad: 0.0, gains, change_gain: 0.0, rate_gain_s: 0.0 }
    }

    /// All ways in which a controller with `gains` at rest holds one of a scenario's plants at the trim and at
    /// the furthest set-points of the scenario; one where they do not differ.
    ///
    /// Where the surface of the rules has a kink at rest, there is one for each of its sides.
    #[must_use]
    pub fn all(
        scenario: &Scenario,
        plant: &LinearPlant,
        controller: &Controller,
        gains: Gains<f64>,
    ) -> Vec<Self> {
        let still = vec![Self::still(gains)];
        let Controller::SelfTuning(fspid) = controller else { return still };
        if fspid.tuner().settings().law != Law::Memoryless || is_the_same_everywhere(fspid) {
            return still;
        }
        let scale = scenario.surroundings.pitch_sensor.map_or(1.0, |s| 1.0 + s.model().scale_error);
        let steady = scenario.steady();
        let held = Holding {
            fspid,
            // What the command has to be per rad of seen pitch.
            command_per_pitch: 1.0 / (scale * plant.steady_gain()),
        };
        let load_rad = steady.load_with_offsets_rad(plant, fspid.shell());
        let loads = if load_rad > 0.0 { vec![0.0, -load_rad, load_rad] } else { vec![0.0] };
        let [least, most] = steady.setpoint_rad;
        let mut found: Vec<Self> = Vec::new();
        for setpoint_rad in [0.0, least, most] {
            for &load_rad in &loads {
                for rest in held.at(setpoint_rad, load_rad, gains) {
                    if !found.contains(&rest) {
                        found.push(rest);
                    }
                }
            }
        }
        found
    }

    /// The loop of one of a scenario's plants around this rest.
    ///
    /// # Errors
    /// [`SimError`] where the plant cannot be sampled.
    pub fn model(
        &self,
        scenario: &Scenario,
        plant: &LinearPlant,
        controller: &Controller,
    ) -> Result<LoopModel<f64>, SimError> {
        let shell = controller.shell_at(self.gains);
        let shell = Shell { rate_gain_s: shell.rate_gain_s + self.rate_gain_s, ..shell };
        let memory = Memory::of_gains(self.gains, &shell);
        let memory = if self.change_gain == 0.0 { memory } else { memory.with_previous() };
        let model = LoopModel::of(scenario, plant, &shell, memory)?;
        Ok(model.with_change_gain(self.change_gain))
    }
}

/// True where no constant is multiplied by a gain, and there is an integral that brings the error to zero.
fn is_the_same_everywhere(fspid: &Fspid<f64>) -> bool {
    let (shell, settings) = (fspid.shell(), fspid.tuner().settings());
    let plain = (shell.setpoint_weights.proportional - 1.0) == 0.0
        && settings.followers.setpoint_weight == 0.0
        && shell.integral == IntegralForm::Bumpless;
    plain && integrates(fspid)
}

fn integrates(fspid: &Fspid<f64>) -> bool {
    fspid.tuner().nominal().ki != 0.0 || fspid.tuner().settings().output_scale.ki != 0.0
}

/// A self-tuning controller that holds a plant.
struct Holding<'a> {
    fspid: &'a Fspid<f64>,
    command_per_pitch: f64,
}

impl Holding<'_> {
    /// Rest at a set-point under a load, once for each side that the rules have there.
    fn at(&self, setpoint_rad: f64, load_rad: f64, gains: Gains<f64>) -> Vec<AtRest> {
        let (error_rad, gains) = if integrates(self.fspid) {
            (0.0, gains)
        } else {
            let error_rad = self.error_at_rest(setpoint_rad, load_rad);
            (error_rad, self.gains_at([self.seen_error(error_rad), self.seen_beside(error_rad)]))
        };
        let pitch_rad = setpoint_rad - error_rad;
        let weight = self.fspid.shell_at(gains).setpoint_weights.proportional;
        let by_weight = self.fspid.tuner().settings().followers.setpoint_weight;
        let by_kp = weight * setpoint_rad - pitch_rad;
        let integral_rad = self.command_per_pitch * pitch_rad + load_rad - gains.kp * by_kp;
        // The error's own part of kp e is in the gains.
        let by_kp = by_kp + by_weight * gains.kp * setpoint_rad;
        let by_ki = match self.fspid.shell().integral {
            IntegralForm::Literal if gains.ki != 0.0 => integral_rad / gains.ki,
            _ => 0.0,
        };
        let rest = |slopes: Slopes| self.with(setpoint_rad, gains, slopes, [by_kp, by_ki]);
        self.slopes_around(error_rad).into_iter().map(rest).collect()
    }

    fn with(
        &self,
        setpoint_rad: f64,
        gains: Gains<f64>,
        slopes: Slopes,
        [by_kp, by_ki]: [f64; 2],
    ) -> AtRest {
        let along = |input: usize| by_kp * slopes.kp[input] + by_ki * slopes.ki[input];
        let (of_error, beside) = (along(0), along(1));
        let mut rest = AtRest { setpoint_rad, ..AtRest::still(gains) };
        rest.gains.kp += of_error;
        match self.fspid.tuner().settings().sees {
            Sees::ErrorAndChange => rest.change_gain = beside,
            // What is seen is the rate with its sign turned, as the rate loop takes it off.
            Sees::ErrorAndRate => rest.rate_gain_s = beside,
            // The model has come to rest at the set-point.
            Sees::ErrorAndModelError(_) => rest.gains.kp += beside,
        }
        rest
    }

    /// The error at rest without an integral, by halving: of all such errors one.
    fn error_at_rest(&self, setpoint_rad: f64, load_rad: f64) -> f64 {
        let missing = |error_rad: f64| {
            let gains = self.gains_at([self.seen_error(error_rad), self.seen_beside(error_rad)]);
            let weight = self.fspid.shell_at(gains).setpoint_weights.proportional;
            let pitch_rad = setpoint_rad - error_rad;
            gains.kp * (weight * setpoint_rad - pitch_rad)
                - self.command_per_pitch * pitch_rad
                - load_rad
        };
        let (mut near, mut far) = (0.0, 0.0);
        let mut size = setpoint_rad.abs().max(load_rad.abs());
        for _ in 0..HALVINGS {
            for side in [size, -size] {
                if missing(0.0) * missing(side) <= 0.0 {
                    far = side;
                }
            }
            if far != 0.0 || size == 0.0 {
                break;
            }
            size *= 2.0;
        }
        for _ in 0..HALVINGS {
            let middle = 0.5 * (near + far);
            if missing(near) * missing(middle) <= 0.0 { far = middle } else { near = middle }
        }
        near
    }

    fn sign(&self) -> f64 {
        match self.fspid.tuner().settings().error_sign {
            ErrorSign::SetpointMinusMeasurement => 1.0,
            ErrorSign::MeasurementMinusSetpoint => -1.0,
        }
    }

    fn seen_error(&self, error_rad: f64) -> f64 {
        self.sign() * self.fspid.tuner().settings().input_scale.error_per_rad * error_rad
    }

    /// What stands beside a constant error.
    fn seen_beside(&self, error_rad: f64) -> f64 {
        let settings = self.fspid.tuner().settings();
        match settings.sees {
            Sees::ErrorAndChange | Sees::ErrorAndRate => 0.0,
            Sees::ErrorAndModelError(_) => {
                self.sign() * settings.input_scale.change_per_rad * error_rad
            }
        }
    }

    /// The gains where the supervisor sees this; the nominal ones where it refuses to answer.
    fn gains_at(&self, [error, beside]: [f64; 2]) -> Gains<f64> {
        let tuner = self.fspid.tuner();
        let nominal = tuner.nominal();
        let Some(added) = tuner.increments_where_seen(error, beside) else { return nominal };
        let free = Gains {
            kp: nominal.kp + added.kp,
            ki: nominal.ki + added.ki,
            kd: nominal.kd + added.kd,
        };
        tuner.settings().gain_limits.map_or(free, |limits| Gains {
            kp: limits.kp.clamp(free.kp),
            ki: limits.ki.clamp(free.ki),
            kd: limits.kd.clamp(free.kd),
        })
    }

    /// Slopes on all sides of a constant error.
    fn slopes_around(&self, error_rad: f64) -> Vec<Slopes> {
        let settings = self.fspid.tuner().settings();
        let level = Slopes { kp: [0.0; 2], ki: [0.0; 2] };
        // Within a dead zone gains do not move.
        let zone = settings.dead_zone;
        if zone.is_some_and(|zone| error_rad.abs() < zone.error_rad && zone.change_rad > 0.0) {
            return vec![level];
        }
        let range = self.fspid.tuner().supervisor().range();
        let centre = [self.seen_error(error_rad), self.seen_beside(error_rad)];
        let mut found: Vec<Slopes> = Vec::new();
        for side in 0..SIDES {
            let (sine, cosine) = sin_cos(2.0 * PI * (f64::from(side) + 0.5) / f64::from(SIDES));
            let place = [centre[0] + AROUND * range * cosine, centre[1] + AROUND * range * sine];
            let slopes = self.slopes_at(place);
            if !found.iter().any(|known| known.is_near(&slopes)) {
                found.push(slopes);
            }
        }
        found
    }

    fn slopes_at(&self, place: [f64; 2]) -> Slopes {
        let tuner = self.fspid.tuner();
        let settings = tuner.settings();
        let apart = APART * tuner.supervisor().range();
        let scale = settings.input_scale;
        let time_s = match (settings.sees, settings.change) {
            (Sees::ErrorAndChange, Change::Rate) => self.fspid.shell().dt_s,
            _ => 1.0,
        };
        let per_unit = [scale.error_per_rad, scale.change_per_rad / time_s];
        let mut slopes = Slopes { kp: [0.0; 2], ki: [0.0; 2] };
        for input in 0..2 {
            let moved = |by: f64| {
                let mut place = place;
                place[input] += by;
                self.gains_at(place)
            };
            let (more, less) = (moved(apart), moved(-apart));
            let by = self.sign() * per_unit[input] / (2.0 * apart);
            slopes.kp[input] = by * (more.kp - less.kp);
            slopes.ki[input] = by * (more.ki - less.ki);
        }
        slopes
    }
}

impl Slopes {
    fn is_near(&self, other: &Self) -> bool {
        let pairs = self.kp.iter().chain(&self.ki).zip(other.kp.iter().chain(&other.ki));
        pairs.into_iter().all(|(one, two)| {
            (one - two).abs() <= SAME * (one.abs() + two.abs()) + f64::MIN_POSITIVE
        })
    }
}
