//! The plants of all lanes between two samples: measurements to the controllers, commands to the actuators.

use super::lane::{Lanes, Mask};
use super::plant::Plants;
use super::queue::Queue;

/// What a sample's signals add, in all lanes.
#[derive(Clone, Debug)]
pub(super) struct Entering<const W: usize> {
    pub(super) setpoint_rad: Lanes<W>,
    pub(super) at_servo_rad: Lanes<W>,
    pub(super) at_elevator_rad: Lanes<W>,
    pub(super) at_measurement_rad: Lanes<W>,
}

impl<const W: usize> Entering<W> {
    pub(super) const NOTHING: Self = Self {
        setpoint_rad: [0.0; W],
        at_servo_rad: [0.0; W],
        at_elevator_rad: [0.0; W],
        at_measurement_rad: [0.0; W],
    };
}

/// What there is to see.
#[derive(Clone, Debug)]
pub(super) struct Sighted<const W: usize> {
    pub(super) theta_rad: Lanes<W>,
    pub(super) q_rad_s: Lanes<W>,
    pub(super) measurement_rad: Lanes<W>,
}

/// Plants with their servos, and commands on their way to these.
#[derive(Clone, Debug)]
pub(super) struct Airframes<const W: usize> {
    pub(super) plants: Plants<W>,
    pub(super) queue: Queue<W>,
}

impl<const W: usize> Airframes<W> {
    #[inline(always)]
    pub(super) fn look(&self, entering: &Entering<W>) -> Sighted<W> {
        let theta_rad = self.plants.theta_rad();
        let mut measurement_rad = entering.at_measurement_rad;
        for lane in 0..W {
            measurement_rad[lane] += theta_rad[lane];
        }
        let q_rad_s = self.plants.rate_rad_s(&entering.at_elevator_rad);
        Sighted { theta_rad, q_rad_s, measurement_rad }
    }

    /// Takes the commands given at sample `k` and answers those that arrive at the servos.
    #[inline(always)]
    pub(super) fn take(
        &mut self,
        k: usize,
        command_rad: &Lanes<W>,
        entering: &Entering<W>,
    ) -> Lanes<W> {
        let mut command_rad = self.queue.pass(k, command_rad);
        for lane in 0..W {
            command_rad[lane] += entering.at_servo_rad[lane];
        }
        self.plants.settle(&command_rad);
        command_rad
    }

    /// Flies to the next sample; answers which lanes a rate limit holds, as [`Plants::advance`].
    #[inline(always)]
    pub(super) fn advance(&mut self, command_rad: &Lanes<W>, entering: &Entering<W>) -> Mask<W> {
        self.plants.advance(command_rad, &entering.at_elevator_rad)
    }

    /// Makes a lane one of zeros at rest.
    pub(super) fn park(&mut self, lane: usize) {
        self.plants.park(lane);
        self.queue.park(lane);
    }
}
