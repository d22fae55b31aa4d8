//! Set-points and disturbances.

use fspid_sim::SimError;
use fspid_sim::signal::{Disturbance, Profile, Shape};

use super::{judged, rad};
use crate::file::section::Section;
use crate::file::spec::signal::SignalKind;
use fspid_diagnostics::Report;

pub(super) fn setpoint(report: &mut Report, section: &Section) -> Option<Profile> {
    let Some(shape) = shape(section)? else {
        return table(report, section);
    };
    let amplitude_rad = rad(section.number("amplitude_deg")?);
    let profile = Profile::new(amplitude_rad, shape);
    judged(report, (section, "amplitude_deg"), profile)
}

/// The shape of a set-point or disturbance; the inner `None` for a table, which has none.
#[allow(clippy::option_option, reason = "a table and a problem are two things")]
fn shape(section: &Section) -> Option<Option<Shape>> {
    let at_s = || section.number("at_s");
    let width_s = || section.number("width_s");
    Some(Some(match section.variant()? {
        SignalKind::Step => Shape::Step { at_s: at_s()? },
        SignalKind::Square => Shape::Square {
            at_s: at_s()?,
            half_period_s: section.number("half_period_s")?,
            bipolar: section.boolean("bipolar")?,
        },
        SignalKind::Doublet => Shape::Doublet { at_s: at_s()?, width_s: width_s()? },
        SignalKind::Pulse => Shape::Pulse { at_s: at_s()?, width_s: width_s()? },
        SignalKind::Ramp => Shape::Ramp { at_s: at_s()?, width_s: width_s()? },
        SignalKind::Sine => {
            Shape::Sine { at_s: at_s()?, frequency_hz: section.number("frequency_hz")? }
        }
        SignalKind::Noise => {
            Shape::Noise { at_s: at_s()?, seed: u64::try_from(section.integer("seed")?).ok()? }
        }
        SignalKind::Table => return Some(None),
    }))
}

fn table(report: &mut Report, section: &Section) -> Option<Profile> {
    let times = section.placed_numbers("time_s")?;
    let values = section.numbers("value_deg")?;
    let interpolation = section.word("interpolation")?;
    if times.len() != values.len() {
        let message = format!("{} values for {} times", values.len(), times.len());
        let path = section.path("value_deg");
        report.missing(section.at("value_deg"), &path, message, "as many values as times");
        return None;
    }
    let time_s = times.iter().map(|(time_s, _)| *time_s).collect();
    let setpoint_rad = values.into_iter().map(rad).collect();
    let profile = Profile::table(time_s, setpoint_rad, interpolation);
    if let Err(SimError::Table { row, .. }) = profile
        && let Some((_, place)) = times.get(row - 1)
    {
        let path = format!("{}[{}]", section.path("time_s"), row - 1);
        report.value(*place, &path, "not in order of time", "a time after the one before");
        return None;
    }
    judged(report, (section, "time_s"), profile)
}

pub(super) fn disturbance(report: &mut Report, section: &Section) -> Option<Disturbance> {
    let entry = section.word("enters_at")?;
    let shape = shape(section)??;
    let is_noise = section.variant() == Some(SignalKind::Noise);
    let size = if is_noise { "standard_deviation_deg" } else { "amplitude_deg" };
    let amplitude_rad = rad(section.number(size)?);
    let disturbance = Disturbance::new(entry, amplitude_rad, shape);
    judged(report, (section, size), disturbance)
}
