//! When a population has nothing left to find.

use serde::{Deserialize, Serialize};

use super::Stop;
use super::member::{Member, width};

/// A population narrower than this, of the cube, is one point.
const NARROW: f64 = 1e-12;
/// Generations with equal costs after which there is no slope to follow.
const PATIENCE: u32 = 20;

/// What a population looked like lately.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize)]
pub(super) struct Progress {
    collapsed: bool,
    flat: u32,
}

impl Progress {
    pub(super) fn note(&mut self, members: &[Member]) {
        self.collapsed = width(members) < NARROW;
        let same = |pair: &[Member]| pair[0].cost.to_bits() == pair[1].cost.to_bits();
        let flat = members.windows(2).all(same) && members.iter().all(|m| m.cost.is_finite());
        self.flat = if flat { self.flat.saturating_add(1) } else { 0 };
    }

    pub(super) fn stop(self) -> Option<Stop> {
        if self.collapsed {
            Some(Stop::Collapsed)
        } else {
            (self.flat >= PATIENCE).then_some(Stop::NoProgress)
        }
    }
}
