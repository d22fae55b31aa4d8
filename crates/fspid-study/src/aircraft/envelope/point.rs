//! One speed and altitude: what is read off a row of the envelope.

use fspid_aircraft::envelope::{EnvelopeFlight, EnvelopeRow};
use fspid_aircraft::qualities::ShortPeriod;
use fspid_aircraft::{Growth, ModeName};
use fspid_lti::Mode;

use super::judged::Loop;
use fspid_scenario::aircraft::departure;
use fspid_scenario::aircraft::units::Units;

/// A speed and altitude, and what the aircraft is like there or why it cannot fly there.
pub(super) type Point = EnvelopeRow<Option<Loop>>;

/// A flight that is held, with the sampled loop where there is an autopilot.
pub(super) type Held = EnvelopeFlight<Option<Loop>>;

/// The loop at a point that can be flown, where there is an autopilot.
pub(super) fn loop_at(point: &Point) -> Option<&Loop> {
    point.flight.as_ref().ok()?.beside.as_ref()
}

/// Why a point cannot be flown, in a line.
pub(super) fn reason(point: &Point, units: Units) -> Option<String> {
    let failure = point.flight.as_ref().err()?;
    let limits: Vec<String> = failure.limits.iter().map(|limit| departure(limit, units)).collect();
    Some(match limits.is_empty() {
        true => "no balance of forces found".to_owned(),
        false => limits.join("; "),
    })
}

/// Frequency and damping of a motion that is a pair.
pub(super) fn pair(held: &Held, name: ModeName) -> Option<Mode> {
    let all = [&held.longitudinal, &held.lateral];
    let mut modes = all.into_iter().flatten().flatten();
    let found = modes.find(|mode| mode.name == name && mode.oscillates());
    found.and_then(|mode| mode.mode().ok())
}

/// Time in which the longitudinal motion that grows fastest doubles, swinging or not, s; none where nothing grows.
pub(super) fn doubles_s(held: &Held) -> Option<f64> {
    let modes = held.longitudinal.as_ref().ok()?.iter();
    let times = modes.filter_map(|mode| match mode.growth() {
        Growth::Doubles(time_s) => Some(time_s),
        Growth::Halves(_) | Growth::Stays => None,
    });
    times.min_by(f64::total_cmp)
}

/// The short period, judged.
pub(super) fn short_period(held: &Held) -> Option<ShortPeriod> {
    held.qualities.as_ref().ok()?.short_period.ok()
}
