//! What is seen of all lanes at one sample.

use fspid_core::{Faults, Gains, Step};

use super::lane::{Lanes, Mask, YES};
use crate::instant::Instant;

/// Everything observable of a group at one sample, one entry a lane. What stands in a lane that does
/// not fly means nothing.
#[derive(Clone, Copy, Debug)]
pub struct BatchRow<'a, const W: usize> {
    /// Index of the sample.
    pub k: usize,
    pub(super) flying: &'a Mask<W>,
    /// Commanded pitch, rad.
    pub setpoint_rad: &'a Lanes<W>,
    /// Pitch angle, rad.
    pub theta_rad: &'a Lanes<W>,
    /// Pitch rate, rad/s.
    pub q_rad_s: &'a Lanes<W>,
    /// Elevator in the plant's own sign, rad.
    pub elevator_rad: &'a Lanes<W>,
    /// Pitch angle as the controller saw it, rad.
    pub measurement_rad: &'a Lanes<W>,
    /// Command of the controller, nose up positive, rad.
    pub command_rad: &'a Lanes<W>,
    /// Gains used: `kp`, `ki`, `kd`.
    pub gains: &'a [Lanes<W>; 3],
    pub(super) excess: &'a Mask<W>,
    pub(super) faults: &'a [Faults; W],
}

impl<const W: usize> BatchRow<'_, W> {
    /// True for a lane whose flight goes on; false without such a lane.
    #[inline(always)]
    #[must_use]
    pub fn flies(&self, lane: usize) -> bool {
        self.flying.get(lane) == Some(&YES)
    }

    /// True where the command was cut.
    #[inline(always)]
    #[must_use]
    pub fn saturated(&self, lane: usize) -> bool {
        self.excess.get(lane) == Some(&YES)
    }

    /// Faults latched by the controller of a lane; none without such a lane.
    #[inline(always)]
    #[must_use]
    pub fn faults(&self, lane: usize) -> Faults {
        self.faults.get(lane).copied().unwrap_or(Faults::NONE)
    }

    /// What [`fly`](crate::fly) shows of a lane's flight at this sample; `None` where none flies.
    #[inline(always)]
    #[must_use]
    pub fn instant(&self, lane: usize) -> Option<Instant> {
        if !self.flies(lane) {
            return None;
        }
        let [kp, ki, kd] = self.gains;
        let q_rad_s = self.q_rad_s[lane];
        Some(Instant {
            k: self.k,
            setpoint_rad: self.setpoint_rad[lane],
            theta_rad: self.theta_rad[lane],
            q_rad_s,
            elevator_rad: self.elevator_rad[lane],
            measured: [self.measurement_rad[lane], q_rad_s],
            aircraft: None,
            autopilot: None,
            step: Step {
                command_rad: self.command_rad[lane],
                gains: Gains { kp: kp[lane], ki: ki[lane], kd: kd[lane] },
                saturated: self.saturated(lane),
                faults: self.faults[lane],
            },
        })
    }
}
