//! What moves a flight after its end, and the flight as it goes on under that.

#[cfg(test)]
mod tests;

use crate::scenario::{Prepared, Scenario};
use crate::signal::{Disturbance, Entry};
use crate::timing::Timing;
use crate::trace::Trace;

/// Air that changes late by no more than this share of all that it does has changed before.
const AIR_CHANGES: f64 = 0.01;

/// What keeps an error moving for ever.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Moved {
    Nothing,
    BySwings,
    ByNoise,
}

/// What of noise and swings acts on after the end of a flight; before it everything does. Set-points swing on in any case: that
/// is what is commanded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Afterwards {
    /// Nothing, and set-points that swing stand where they are: what swings on then does so by itself.
    Still,
    /// Neither noise nor swings of disturbances: what swings on then does so by itself.
    Quiet,
    /// Swings without noise, which would hide a swing that stays.
    Swings,
    /// All.
    Noise,
}

impl Moved {
    /// By what goes on after the end of the flight; what has no size, or begins later, moves nothing.
    pub(super) fn of(scenario: &Scenario, afterwards: Afterwards) -> Self {
        let (is_noisy, swings) = (is_noisy(scenario), has_swings(scenario));
        match afterwards {
            Afterwards::Noise if is_noisy => Self::ByNoise,
            Afterwards::Noise | Afterwards::Swings if swings => Self::BySwings,
            Afterwards::Noise | Afterwards::Swings | Afterwards::Quiet
                if swings_by_command(scenario) =>
            {
                Self::BySwings
            }
            _ => Self::Nothing,
        }
    }
}

/// True where noise, turbulence, or drift of a sensor acts within the flight.
pub(super) fn is_noisy(scenario: &Scenario) -> bool {
    let end_s = scenario.timing.end_s();
    let mut noises = scenario.disturbances.iter().filter(|it| it.is_noise());
    noises.any(|it| it.acts_by(end_s))
        || scenario.setpoint.is_noise()
        || scenario.surroundings.is_noisy()
}

/// True where a disturbance swings within the flight.
pub(super) fn has_swings(scenario: &Scenario) -> bool {
    let end_s = scenario.timing.end_s();
    let mut swings = scenario.disturbances.iter().filter(|it| it.goes_on() && !it.is_noise());
    swings.any(|it| it.acts_by(end_s))
}

pub(super) fn swings_by_command(scenario: &Scenario) -> bool {
    let setpoint = &scenario.setpoint;
    let end_s = scenario.timing.end_s();
    let has_size = setpoint.ends_rad().iter().any(|it| *it != 0.0);
    has_size && setpoint.period_s().is_some_and(|(from_s, _)| from_s <= end_s)
}

/// True where set-point, loads or plant change within the last fifth of a flight, too late to see what comes of it.
///
/// What is commanded is the scenario's own set-point and the mode of an autopilot, which moves the set-point all the time.
pub(super) fn changes_late(scenario: &Scenario, trace: &Trace) -> bool {
    let rows = trace.rows();
    let from = rows - rows / 5;
    let timing = scenario.timing;
    let changes = |values: &[f64]| {
        let late = values.get(from.saturating_sub(1)..).unwrap_or_default();
        late.windows(2).any(|pair| pair[0].total_cmp(&pair[1]).is_ne())
    };
    let mut loads = scenario.disturbances.iter().filter(|it| !it.goes_on());
    let is_late = |load: &Disturbance| {
        let mut values = vec![0.0; rows];
        load.add_to(&mut values, timing, 0);
        changes(&values)
    };
    let from_s = timing.time_s(from);
    let mut plants = scenario.plant_changes.iter().filter(|it| it.at_s() <= timing.end_s());
    let setpoint = || changes(&scenario.setpoint.sampled(timing).0);
    (!scenario.setpoint.goes_on() && setpoint())
        || air_changes(scenario, from)
        || trace.column("mode").is_some_and(changes)
        || loads.any(is_late)
        || plants.any(|it| it.at_s() + it.ramp_s() >= from_s)
}

/// True where the winds along the way change from some sample on by more than a hundredth of all that they do.
fn air_changes(scenario: &Scenario, from: usize) -> bool {
    let Some(weather) = &scenario.surroundings.weather else { return false };
    let timing = scenario.timing;
    let changes: Vec<[f64; 3]> =
        (0..timing.rows()).map(|k| weather.wind_change(timing.time_s(k))).collect();
    let reach = |changes: &[[f64; 3]], part: usize| {
        let values = changes.iter().map(|it| it[part]);
        let (least, most) = values.fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), it| {
            (least.min(it), most.max(it))
        });
        most - least
    };
    (0..3).any(|part| reach(&changes[from..], part) > AIR_CHANGES * reach(&changes, part))
}

/// The flight as it goes on to so many samples: what stands still at its end is held, what swings swings on where it is to, and
/// what would begin later does not. Winds are those along the way, which goes on.
pub(super) fn held_on(
    scenario: &Scenario,
    rows: usize,
    afterwards: Afterwards,
) -> Option<Prepared> {
    let before = scenario.timing.rows();
    let (dt_s, end_s) = (scenario.timing.dt_s(), scenario.timing.end_s());
    let mut own = scenario.clone();
    own.timing = Timing::new(dt_s, dt_s * (rows - 1) as f64).ok()?;
    own.plant_changes.retain(|it| it.at_s() <= end_s);
    if afterwards != Afterwards::Noise {
        own.surroundings = own.surroundings.silent_from(end_s + 0.5 * dt_s);
    }
    let disturbances = core::mem::take(&mut own.disturbances);
    let mut prepared = own.prepare().ok()?;
    let after = match &scenario.setpoint {
        noise if noise.is_noise() => After::of_noise(afterwards),
        swing if swing.goes_on() && afterwards != Afterwards::Still => After::GoesOn,
        _ => After::Holds,
    };
    hold(&mut prepared.setpoint_rad, before, after);
    let places = [
        (Entry::Servo, &mut prepared.at_servo),
        (Entry::Elevator, &mut prepared.at_elevator),
        (Entry::Measurement, &mut prepared.at_measurement),
    ];
    for (entry, values) in places {
        for (stream, disturbance) in (0_u64..).zip(&disturbances) {
            if disturbance.entry() == entry {
                let mut one = vec![0.0; rows];
                disturbance.add_to(&mut one, own.timing, stream);
                hold(&mut one, before, After::of_disturbance(disturbance, afterwards));
                let values = values.get_or_insert_with(|| vec![0.0; rows]);
                values.iter_mut().zip(one).for_each(|(sum, value)| *sum += value);
            }
        }
    }
    Some(prepared)
}

/// What a signal does after the end of the flight.
#[derive(Clone, Copy, PartialEq, Eq)]
enum After {
    GoesOn,
    Holds,
    /// It is nothing any more.
    Ends,
}

impl After {
    fn of_noise(afterwards: Afterwards) -> Self {
        if afterwards == Afterwards::Noise { Self::GoesOn } else { Self::Ends }
    }

    fn of_disturbance(disturbance: &Disturbance, afterwards: Afterwards) -> Self {
        match (disturbance, afterwards) {
            (noise, _) if noise.is_noise() => Self::of_noise(afterwards),
            (load, _) if !load.goes_on() => Self::Holds,
            (_, Afterwards::Quiet | Afterwards::Still) => Self::Ends,
            (_, Afterwards::Swings | Afterwards::Noise) => Self::GoesOn,
        }
    }
}

/// What a signal of the flight's own length becomes; one that is nothing within it stays so.
fn hold(values: &mut [f64], before: usize, after: After) {
    let begins_later = values.iter().take(before).all(|value| *value == 0.0);
    let last = values.get(before - 1).copied().unwrap_or(0.0);
    let held = match after {
        After::GoesOn if !begins_later => return,
        After::GoesOn | After::Holds => last,
        After::Ends => 0.0,
    };
    values.iter_mut().skip(before).for_each(|value| *value = held);
}
