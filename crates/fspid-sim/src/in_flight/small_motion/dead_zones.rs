//! Modes whose self-tuning outer loops have dead zones, as they would be without them.
//!
//! Within its zone a loop has the gains that it begins with. A motion that leaves it, however small the zone is, meets the rules,
//! and with the gains of these, or what they make of a target that is held, the loop may grow: into the zone it does not come
//! back then, and a swing of any size stays. The pitch loop is asked alike ([`rest`](crate::rest)).

use fspid_core::{Fspid, SelfTuner, TunerSettings};
use fspid_lti::{eigenvalues, modulus};

use super::moving::{Sides, sides};
use super::still::still;
use super::{Asked, a_sample};
use crate::controller::Controller;
use crate::error::SimError;
use crate::rest::Stand;
use crate::stability::MODE_RADIUS;

/// Most loops with dead zones in a mode of which every part is asked.
const MOST_LOOPS: usize = 6;

/// True where the motions of a mode decay with any of its loops beyond their dead zones, and the others within.
pub(super) fn holds_beyond_dead_zones(asked: &Asked<'_>) -> Result<bool, SimError> {
    let loops = asked.autopilot.outermost_first(asked.mode).iter();
    let zoned: Vec<(usize, Controller)> = loops
        .filter_map(|&number| {
            let outer = asked.autopilot.loops().get(number)?;
            Some((number, without_dead_zone(&outer.controller)?))
        })
        .collect();
    if zoned.len() > MOST_LOOPS {
        return Ok(false);
    }
    let mut parts = vec![asked.autopilot.clone()];
    for (number, other) in zoned {
        let with: Vec<_> = parts.iter().map(|it| it.with_controller(number, other)).collect();
        parts.extend(with);
    }
    for autopilot in parts.iter().skip(1) {
        if !holds(&Asked { autopilot, ..*asked })? {
            return Ok(false);
        }
    }
    Ok(true)
}

/// True where everything that is asked of a mode decays.
fn holds(asked: &Asked<'_>) -> Result<bool, SimError> {
    let prepared = still(asked.scenario, asked.autopilot, asked.mode, asked.seeing)?;
    let small = asked.small(&prepared)?;
    let radius = match sides(asked, &small)? {
        None => eigenvalues(&small.matrix)?.iter().map(|z| modulus(*z)).fold(0.0, f64::max),
        Some(Sides { stand: Stand::Holds, largest, .. }) => largest,
        Some(_) => return Ok(false),
    };
    Ok(a_sample(radius, small.samples) <= MODE_RADIUS)
}

/// A self-tuner without its dead zone; none of what has none.
fn without_dead_zone(controller: &Controller) -> Option<Controller> {
    let Controller::SelfTuning(fspid) = controller else { return None };
    let settings = *fspid.tuner().settings();
    settings.dead_zone?;
    let (nominal, supervisor) = (fspid.tuner().nominal(), *fspid.tuner().supervisor());
    let settings = TunerSettings { dead_zone: None, ..settings };
    let tuner = SelfTuner::new_unchecked(nominal, supervisor, settings);
    Some(Controller::SelfTuning(Fspid::new(tuner, *fspid.config()).ok()?))
}
