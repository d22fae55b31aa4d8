//! Set-points and disturbances.

use fspid_sim::SimError;
use fspid_sim::signal::{Disturbance, Profile, Shape};

use super::{judged, rad};
use crate::file::spec::signal as keys;
use crate::file::spec::signal::SignalKind;
use crate::keyed::Section;
use fspid_diagnostics::Report;

pub(super) fn setpoint(report: &mut Report, section: &Section) -> Option<Profile> {
    let Some(shape) = shape(section)? else {
        return table(report, section);
    };
    let amplitude_rad = rad(section.get(keys::AMPLITUDE)?);
    let profile = Profile::new(amplitude_rad, shape);
    judged(report, (section, keys::AMPLITUDE), profile)
}

/// The shape of a set-point or disturbance; the inner `None` for a table, which has none.
#[allow(clippy::option_option, reason = "a table and a problem are two things")]
fn shape(section: &Section) -> Option<Option<Shape>> {
    let at_s = || section.get(keys::AT);
    Some(Some(match section.variant()? {
        SignalKind::Step => Shape::Step { at_s: at_s()? },
        SignalKind::Square => Shape::Square {
            at_s: at_s()?,
            half_period_s: section.get(keys::HALF_PERIOD_S)?,
            bipolar: section.get(keys::BIPOLAR)?,
        },
        SignalKind::Doublet => {
            Shape::Doublet { at_s: at_s()?, width_s: section.get(keys::DOUBLET_WIDTH_S)? }
        }
        SignalKind::Pulse => {
            Shape::Pulse { at_s: at_s()?, width_s: section.get(keys::PULSE_WIDTH_S)? }
        }
        SignalKind::Ramp => {
            Shape::Ramp { at_s: at_s()?, width_s: section.get(keys::RAMP_WIDTH_S)? }
        }
        SignalKind::Sine => {
            Shape::Sine { at_s: at_s()?, frequency_hz: section.get(keys::FREQUENCY_HZ)? }
        }
        SignalKind::Noise => {
            Shape::Noise { at_s: at_s()?, seed: u64::try_from(section.get(keys::SEED)?).ok()? }
        }
        SignalKind::Table => return Some(None),
    }))
}

fn table(report: &mut Report, section: &Section) -> Option<Profile> {
    let times = section.get(keys::TIME_S)?;
    let values = section.numbers(keys::VALUE_DEG)?;
    let interpolation = section.get(keys::INTERPOLATION)?;
    if times.len() != values.len() {
        let message = format!("{} values for {} times", values.len(), times.len());
        let path = section.path(keys::VALUE_DEG);
        report.missing(section.at(keys::VALUE_DEG), &path, message, "as many values as times");
        return None;
    }
    let time_s = times.iter().map(|(time_s, _)| *time_s).collect();
    let setpoint_rad = values.into_iter().map(rad).collect();
    let profile = Profile::table(time_s, setpoint_rad, interpolation);
    if let Err(SimError::Table { row, .. }) = profile
        && let Some((_, place)) = times.get(row - 1)
    {
        let path = format!("{}[{}]", section.path(keys::TIME_S), row - 1);
        report.value(*place, &path, "not in order of time", "a time after the one before");
        return None;
    }
    judged(report, (section, keys::TIME_S), profile)
}

pub(super) fn disturbance(report: &mut Report, section: &Section) -> Option<Disturbance> {
    let entry = section.get(keys::ENTERS_AT)?;
    let shape = shape(section)??;
    let is_noise = section.variant() == Some(SignalKind::Noise);
    let size = if is_noise { keys::STANDARD_DEVIATION_DEG } else { keys::AMPLITUDE };
    let amplitude_rad = rad(section.get(size)?);
    let disturbance = Disturbance::new(entry, amplitude_rad, shape);
    judged(report, (section, size), disturbance)
}
