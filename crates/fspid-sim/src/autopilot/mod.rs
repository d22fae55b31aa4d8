//! The autopilot around the loop: outer loops that command the pitch set-point, the throttle and the bank, and the modes
//! that engage them.
//!
//! # The cascade
//! An [`OuterLoop`] holds one [`Quantity`] of the flight and moves the pitch set-point, the throttle, the bank or the target
//! of another outer loop. It is a [`Controller`] like the one under test, fixed or self-tuning, in SI
//! units of what it holds and moves. [`TotalEnergy`] holds altitude and airspeed together and moves pitch and throttle
//! together. All answer once a sample, the outermost first, before the pitch controller does.
//!
//! # Modes
//! A [`Mode`] says which loops are engaged and what they hold. Modes follow each other in the order in which they are
//! written: the next one begins at the first sample at which its [`Entry`] is met. A loop that is not engaged forgets;
//! one that becomes engaged takes over what is commanded ([`track`](fspid_core::Controller::track)), so that a change
//! of modes bumps nothing but what a gain without an integral has to, within its rate limit. What nobody moves any more
//! stays where it was.
//!
//! # Anti-windup across the cascade
//! While what a loop moves is cut (a limit of its own, of the loop below, of the pitch controller, of the elevator's
//! drive), its integral does not grow in that direction.
//!
//! # Where pitch, throttle and bank count from
//! Pitch and throttle are changes from the trim, as the set-point of the scenario is, which is added to the pitch of the
//! autopilot.
//!
//! # Not here
//! Air data with errors of position; localiser; flare and roll-out; go-around logic.

mod channel;
mod check;
mod error;
mod flight;
mod glide_slope;
mod mode;
mod outer_loop;
mod quantity;
mod sample;
mod total_energy;

pub use error::AutopilotError;
pub(crate) use flight::{AutopilotState, Commands, Cut, Throttle};
pub use glide_slope::GlideSlope;
pub use mode::{Condition, Engagement, Entry, Mode, Side, Target};
pub use outer_loop::{Moves, OuterLoop, Units};
pub(crate) use quantity::Observed;
pub use quantity::Quantity;
pub use sample::{AUTOPILOT_COLUMNS, AutopilotSample};
pub use total_energy::TotalEnergy;

use crate::aircraft::AircraftPlant;
use crate::controller::Controller;
use crate::timing::Timing;
use fspid_aircraft::ForceModel;
use fspid_core::{Gains, Pid, PidConfig};

/// What stands at a limit in a steady flight, so that no loop moves it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct AtLimits {
    /// The throttle.
    pub(crate) throttle: bool,
    /// The pitch that is commanded.
    pub(crate) pitch: bool,
}

/// A controller in the place of another that answers nothing.
fn silent(controller: &Controller) -> Controller {
    let config = PidConfig::sampled_every(controller.config().dt_s);
    Pid::new(Gains { kp: 0.0, ki: 0.0, kd: 0.0 }, config).map_or(*controller, Controller::Fixed)
}

/// The autopilot around the pitch loop.
#[derive(Clone, Debug, PartialEq)]
pub struct Autopilot {
    loops: Vec<OuterLoop>,
    total_energy: Option<TotalEnergy>,
    glide_slope: Option<GlideSlope>,
    modes: Vec<Mode>,
    /// For each mode its loops by number, the outermost first.
    order: Vec<Vec<usize>>,
}

impl Autopilot {
    /// Outer loops and the modes that engage them.
    ///
    /// # Errors
    /// [`AutopilotError`] names the first mode or loop that makes no sense.
    pub fn new(
        loops: Vec<OuterLoop>,
        total_energy: Option<TotalEnergy>,
        glide_slope: Option<GlideSlope>,
        modes: Vec<Mode>,
    ) -> Result<Self, AutopilotError> {
        let order = check::order(&loops, total_energy.as_ref(), glide_slope.as_ref(), &modes)?;
        Ok(Self { loops, total_energy, glide_slope, modes, order })
    }

    /// Refuses what this aircraft and a flight of this length cannot have.
    ///
    /// # Errors
    /// [`AutopilotError`] for a throttle to be moved without an engine and for a mode that begins after the flight.
    pub fn check(&self, plant: &AircraftPlant, timing: Timing) -> Result<(), AutopilotError> {
        self.check_timing(timing)?;
        match self.mover_of_throttle().filter(|_| !plant.aircraft().model().has_engine()) {
            Some(name) => Err(AutopilotError::NoEngine { name: name.to_owned() }),
            None => Ok(()),
        }
    }

    /// Refuses what a flight of this length cannot have, whoever flies.
    ///
    /// # Errors
    /// [`AutopilotError`] for a mode that begins after the flight.
    pub fn check_timing(&self, timing: Timing) -> Result<(), AutopilotError> {
        check::within(&self.modes, timing)
    }

    /// Least and largest pitch set-point that its modes can command, rad from the trim, a right angle where nothing limits it;
    /// none where no mode moves pitch.
    #[must_use]
    pub fn pitch_rad(&self) -> Option<[f64; 2]> {
        let engaged = |number: &usize| self.modes.iter().any(|mode| mode.engaged.contains(number));
        let by_loops = self
            .loops
            .iter()
            .enumerate()
            .filter(|(number, outer)| outer.moves == Moves::Pitch && engaged(number));
        let by_loops = by_loops.map(|(_, outer)| (&outer.controller, outer.units.moved));
        let total =
            self.total_energy.iter().filter(|_| self.modes.iter().any(|it| it.total_energy));
        let by_energy = total.map(|total| (&total.distribution, 1.0));
        let ends = by_loops.chain(by_energy).map(|(controller, per_rad)| {
            let most_rad = core::f64::consts::FRAC_PI_2;
            controller.config().limits.map_or([-most_rad, most_rad], |limits| {
                [limits.lower(), limits.upper()]
                    .map(|end| (end / per_rad).clamp(-most_rad, most_rad))
            })
        });
        ends.reduce(|[least, most], [lower, upper]| [least.min(lower), most.max(upper)])
    }

    /// True where anything of it moves the throttle.
    #[must_use]
    pub fn moves_throttle(&self) -> bool {
        self.mover_of_throttle().is_some()
    }

    fn mover_of_throttle(&self) -> Option<&str> {
        let by_throttle = self.loops.iter().find(|outer| outer.moves == Moves::Throttle);
        let name = by_throttle.map(|outer| outer.name.as_str());
        name.or_else(|| self.total_energy.map(|_| "total energy"))
    }

    /// The outer loops, as they are written.
    #[must_use]
    pub fn loops(&self) -> &[OuterLoop] {
        &self.loops
    }

    /// The modes, in order.
    #[must_use]
    pub fn modes(&self) -> &[Mode] {
        &self.modes
    }

    /// Numbers of the loops that a mode engages, the outermost first.
    pub(crate) fn outermost_first(&self, mode: usize) -> &[usize] {
        self.order.get(mode).map_or(&[], Vec::as_slice)
    }

    /// The same with nothing in a mode that moves what stands at a limit.
    pub(crate) fn released(&self, mode: usize, at_limits: AtLimits) -> Self {
        let mut other = self.clone();
        let moves_it = |number: usize| match self.moves_in_the_end(number) {
            Moves::Throttle => at_limits.throttle,
            Moves::Pitch => at_limits.pitch,
            Moves::Bank | Moves::Loop(_) => false,
        };
        if let Some(mode) = other.modes.get_mut(mode) {
            mode.engaged.retain(|&number| !moves_it(number));
            mode.total_energy &= !(at_limits.throttle && at_limits.pitch);
        }
        if let Some(order) = other.order.get_mut(mode) {
            order.retain(|&number| !moves_it(number));
        }
        if let Some(total) = &mut other.total_energy {
            let movers = [
                (at_limits.throttle, &mut total.energy),
                (at_limits.pitch, &mut total.distribution),
            ];
            for (_, mover) in movers.into_iter().filter(|(is_at_limit, _)| *is_at_limit) {
                *mover = silent(mover);
            }
        }
        other
    }

    /// What a loop moves, over those whose target it moves.
    fn moves_in_the_end(&self, number: usize) -> Moves {
        let mut moves = self.loops.get(number).map_or(Moves::Loop(number), |it| it.moves);
        // There are no circles, so that this is enough.
        for _ in 0..self.loops.len() {
            let Moves::Loop(below) = moves else { break };
            moves = self.loops.get(below).map_or(moves, |it| it.moves);
        }
        moves
    }

    /// The same with another controller in the place of one of its loops.
    pub(crate) fn with_controller(&self, number: usize, controller: Controller) -> Self {
        let mut other = self.clone();
        if let Some(outer) = other.loops.get_mut(number) {
            outer.controller = controller;
        }
        other
    }

    /// The beam that is followed.
    #[must_use]
    pub fn glide_slope(&self) -> Option<&GlideSlope> {
        self.glide_slope.as_ref()
    }

    /// The loop for altitude and airspeed together.
    #[must_use]
    pub fn total_energy(&self) -> Option<&TotalEnergy> {
        self.total_energy.as_ref()
    }
}
