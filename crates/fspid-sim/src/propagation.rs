//! Propagation of plant and actuator over one sample, by one of four methods: a single linear system, segment by segment of a
//! nonlinear actuator, numerical integration of an aircraft, or another simulator. All stages of one flight use the same
//! method, so that its state keeps one form when the plant changes.

use crate::actuated::{Actuated, ActuatedState, Held};
use crate::aircraft::{AircraftFlight, AircraftMotion, AircraftSample};
use crate::autopilot::{Cut, Throttle};
use crate::beyond::BEYOND;
use crate::error::SimError;
use crate::external_plant::{ExternalFlight, ExternalMotion, PlantLoss};
use crate::law::LinearStep;
use crate::loop_model::SampledPlant;
use crate::plant::LinearPlant;
use crate::propagator::{PlantState, Propagator};

/// Beyond this pitch angle a flight has diverged: 10⁶ degrees.
pub(crate) const DIVERGED_RAD: f64 = 1e6 * std::f64::consts::PI / 180.0;

/// Half the width of differences, relative to values above 1: limits let go and take hold at corners,
/// so that it has to be small, and what is straight between them leaves nothing but rounding, 10⁻⁹.
const DIFFERENCE: f64 = 1e-7;

/// A plant and what moves its elevator, discretised.
#[derive(Clone, Debug)]
pub(crate) enum Propagation {
    /// A first-order servo in calm air, sampled with its plant: what lanes fly.
    AsOne(Propagator),
    /// Any other actuator, and any in moving air.
    ByLegs(Actuated),
    /// A nonlinear aircraft with an actuator, in moving air.
    Aircraft(Box<AircraftFlight>),
    /// An aircraft that another simulator flies, with an actuator.
    External(Box<ExternalFlight>),
}

/// Where plant and elevator are.
#[derive(Clone, Debug)]
pub(crate) enum Motion {
    AsOne(PlantState),
    ByLegs(ActuatedState),
    Aircraft(Box<AircraftMotion>),
    External(Box<ExternalMotion>),
}

impl Motion {
    pub(crate) fn theta_rad(&self) -> f64 {
        match self {
            Self::AsOne(state) => state.theta_rad(),
            Self::ByLegs(state) => state.theta_rad(),
            Self::Aircraft(state) => state.theta_rad(),
            Self::External(state) => state.theta_rad(),
        }
    }

    /// True for a pitch angle beyond ± 10⁶ degrees or not finite, and for an aircraft on its back.
    #[inline(always)]
    pub(crate) fn is_lost(&self) -> bool {
        // Written so that NaN is lost.
        !(self.theta_rad().abs() <= DIVERGED_RAD)
            || matches!(self, Self::Aircraft(state) if state.is_lost())
            || matches!(self, Self::External(state) if state.is_lost())
    }

    /// The throttle at the trim of another simulator, which nobody knows before.
    pub(crate) fn throttle(&self) -> Option<Throttle> {
        match self {
            Self::External(state) => state.throttle(),
            _ => None,
        }
    }

    /// How another simulator was lost, if it was.
    #[inline(always)]
    pub(crate) fn plant_loss(&self) -> Option<PlantLoss> {
        match self {
            Self::External(state) => state.loss(),
            _ => None,
        }
    }
}

impl Propagation {
    /// Where a flight begins; another simulator is started.
    pub(crate) fn start(&self) -> Result<Motion, SimError> {
        Ok(match self {
            Self::AsOne(propagator) => Motion::AsOne(PlantState::at_rest(propagator.order())),
            Self::ByLegs(actuated) => Motion::ByLegs(actuated.at_rest()),
            Self::Aircraft(flight) => Motion::Aircraft(Box::new(flight.at_rest())),
            Self::External(flight) => Motion::External(Box::new(flight.start()?)),
        })
    }

    /// True for an aircraft at or below the ground; a linear plant has no height.
    #[inline(always)]
    pub(crate) fn is_at_ground(&self, motion: &Motion) -> bool {
        match (self, motion) {
            (Self::Aircraft(it), Motion::Aircraft(state)) => it.is_at_ground(state),
            (_, Motion::External(state)) => state.is_at_ground(),
            _ => false,
        }
    }

    /// Pitch rate just before a sample, rad/s.
    #[inline(always)]
    pub(crate) fn rate_rad_s(&self, motion: &Motion, disturbance_rad: f64) -> f64 {
        match (self, motion) {
            (Self::AsOne(it), Motion::AsOne(state)) => it.rate_rad_s(state, disturbance_rad),
            (Self::ByLegs(it), Motion::ByLegs(state)) => it.rate_rad_s(state, disturbance_rad),
            (_, Motion::Aircraft(state)) => state.rate_rad_s(),
            (_, Motion::External(state)) => state.rate_rad_s(),
            _ => 0.0,
        }
    }

    /// Elevator in the plant's own sign, disturbance included, rad; that of an aircraft counts from
    /// where its data have zero, so that it begins with the trim's.
    #[inline(always)]
    pub(crate) fn elevator_rad(&self, motion: &Motion, disturbance_rad: f64) -> f64 {
        match (self, motion) {
            (Self::AsOne(it), Motion::AsOne(state)) => it.elevator_rad(state, disturbance_rad),
            (Self::ByLegs(it), Motion::ByLegs(state)) => it.elevator_rad(state, disturbance_rad),
            (Self::Aircraft(it), Motion::Aircraft(state)) => {
                it.elevator_rad(state, disturbance_rad)
            }
            (_, Motion::External(state)) => state.elevator_rad(),
            _ => 0.0,
        }
    }

    /// What an aircraft shows beyond pitch.
    pub(crate) fn sample(&self, motion: &Motion, disturbance_rad: f64) -> Option<AircraftSample> {
        match (self, motion) {
            (Self::Aircraft(it), Motion::Aircraft(state)) => {
                Some(it.sample(state, it.elevator_rad(state, disturbance_rad)))
            }
            (_, Motion::External(state)) => state.sample(),
            _ => None,
        }
    }

    /// Moves what has no lag to its command at once.
    #[inline(always)]
    pub(crate) fn settle(&self, motion: &mut Motion, command_rad: f64) {
        match (self, motion) {
            (Self::AsOne(it), Motion::AsOne(state)) => it.settle_ideal_servo(state, command_rad),
            (Self::ByLegs(it), Motion::ByLegs(state)) => it.settle(state, command_rad),
            (Self::Aircraft(it), Motion::Aircraft(state)) => it.settle(state, command_rad),
            (Self::External(it), Motion::External(state)) => it.settle(state, command_rad),
            _ => {}
        }
    }

    /// One sample period with everything held.
    pub(crate) fn advance(
        &self,
        motion: &mut Motion,
        command_rad: f64,
        held: &Held<'_>,
    ) -> Result<(), SimError> {
        match (self, motion) {
            (Self::AsOne(it), Motion::AsOne(state)) => {
                it.advance(state, command_rad, held.elevator_rad)?;
            }
            (Self::ByLegs(it), Motion::ByLegs(state)) => it.advance(state, command_rad, held),
            (Self::Aircraft(it), Motion::Aircraft(state)) => {
                it.advance(state, command_rad, held);
            }
            (Self::External(it), Motion::External(state)) => {
                it.advance(state, command_rad, held);
            }
            _ => {}
        }
        Ok(())
    }

    /// True where a limit makes of the coming sample another than one without limits.
    pub(crate) fn is_limited(&self, motion: &Motion, command_rad: f64) -> bool {
        match (self, motion) {
            (Self::AsOne(it), Motion::AsOne(state)) => it.is_limited(state, command_rad),
            (Self::ByLegs(it), Motion::ByLegs(state)) => it.is_limited(state, command_rad),
            (Self::Aircraft(it), Motion::Aircraft(state)) => it.is_limited(state, command_rad),
            _ => false,
        }
    }

    /// Which way the elevator of an aircraft cannot follow the command.
    pub(crate) fn cut(&self, motion: &Motion, command_rad: f64) -> Cut {
        match (self, motion) {
            (Self::Aircraft(it), Motion::Aircraft(state)) => it.cut(state, command_rad),
            (Self::External(it), Motion::External(state)) => it.cut(state, command_rad),
            _ => Cut::Not,
        }
    }

    /// The states that a linear model of the coming sample has: those of
    /// [`linear_step`](Self::linear_step), or pitch, u, w, q and actuator of an aircraft; none of another simulator.
    pub(crate) fn values(&self, motion: &Motion) -> Vec<f64> {
        match (self, motion) {
            (Self::AsOne(_), Motion::AsOne(state)) => state.values().to_vec(),
            (Self::ByLegs(it), Motion::ByLegs(state)) => it.values(state),
            (Self::Aircraft(it), Motion::Aircraft(state)) => it.values(state),
            _ => Vec::new(),
        }
    }

    pub(crate) fn nudge(&self, motion: &mut Motion, place: usize, by: f64) {
        match (self, motion) {
            (Self::AsOne(_), Motion::AsOne(state)) => state.nudge(place, by),
            (Self::ByLegs(it), Motion::ByLegs(state)) => it.nudge(state, place, by),
            (Self::Aircraft(it), Motion::Aircraft(state)) => it.nudge(state, place, by),
            _ => {}
        }
    }

    /// Of an aircraft: altitude, heading, v, p, r, bank and power of the engine; SI.
    pub(crate) fn beyond(&self, motion: &Motion) -> [f64; BEYOND] {
        match (self, motion) {
            (Self::Aircraft(it), Motion::Aircraft(state)) => it.beyond(state),
            _ => [0.0; BEYOND],
        }
    }

    /// True for an aircraft whose engine does not follow its throttle at once.
    pub(crate) fn has_lagging_engine(&self) -> bool {
        matches!(self, Self::Aircraft(it) if it.has_lagging_engine())
    }

    /// On which sides of half power an engine is asked and is, where that matters.
    pub(crate) fn sides_of_half_power(&self, motion: &Motion) -> Option<[bool; 2]> {
        match (self, motion) {
            (Self::Aircraft(it), Motion::Aircraft(state)) => it.sides_of_half_power(state),
            _ => None,
        }
    }

    /// Moves one of these.
    pub(crate) fn nudge_beyond(&self, motion: &mut Motion, place: usize, by: f64) {
        if let (Self::Aircraft(it), Motion::Aircraft(state)) = (self, motion) {
            it.nudge_beyond(state, place, by);
        }
    }

    /// The coming sample as a linear model around where the motion is, limits as they act there, by
    /// central differences.
    pub(crate) fn slopes(
        &self,
        motion: &Motion,
        command_rad: f64,
        held: &Held<'_>,
    ) -> Result<SampledPlant<f64>, SimError> {
        let from = self.values(motion);
        let states = from.len();
        let mut rows = vec![0.0; states * (states + 1)];
        for column in 0..=states {
            let half = DIFFERENCE * from.get(column).copied().unwrap_or(command_rad).abs().max(1.0);
            let arrive = |by: f64| {
                let (mut nudged, mut command_rad) = (motion.clone(), command_rad);
                if column < states {
                    self.nudge(&mut nudged, column, by);
                } else {
                    command_rad += by;
                }
                self.advance(&mut nudged, command_rad, held)?;
                Ok::<_, SimError>(self.values(&nudged))
            };
            let (more, less) = (arrive(half)?, arrive(-half)?);
            for (row, (more, less)) in more.iter().zip(&less).enumerate() {
                rows[row * (states + 1) + column] = (more - less) / (2.0 * half);
            }
        }
        let rate = match self.linear_step() {
            Some(step) => step.rate_row,
            None => (0..states).map(|place| if place == 3 { 1.0 } else { 0.0 }).collect(),
        };
        Ok(SampledPlant { states, rows, rate })
    }

    /// What a sample changes of the states of [`linear_step`](Self::linear_step), and what 64 bits leave out of it; `None`
    /// for an aircraft.
    pub(crate) fn linear_change(
        &self,
        plant: &LinearPlant,
    ) -> Result<Option<[Vec<f64>; 2]>, SimError> {
        match self {
            Self::AsOne(it) => it.linear_change(plant).map(Some),
            Self::ByLegs(it) => it.linear_change(plant).map(Some),
            Self::Aircraft(_) | Self::External(_) => Ok(None),
        }
    }

    pub(crate) fn linear_step(&self) -> Option<LinearStep> {
        match self {
            Self::AsOne(it) => Some(it.linear_step()),
            Self::ByLegs(it) => Some(it.linear_step()),
            Self::Aircraft(_) | Self::External(_) => None,
        }
    }
}
