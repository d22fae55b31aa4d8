//! Set-points and disturbances.

use fspid_sim::SimError;
use fspid_sim::signal::{Disturbance, Entry, Interpolation, Profile, Shape};

use super::{judged, rad};
use crate::file::report::Report;
use crate::file::section::Section;

pub(super) fn setpoint(report: &mut Report, section: &Section) -> Option<Profile> {
    if section.kind == "table" {
        return table(report, section);
    }
    let amplitude_rad = rad(section.number("amplitude_deg")?);
    let profile = Profile::new(amplitude_rad, shape(section)?);
    judged(report, (section, "amplitude_deg"), profile)
}

/// The shape of a set-point or disturbance.
fn shape(section: &Section) -> Option<Shape> {
    let at_s = section.number("at_s")?;
    let width_s = section.number("width_s");
    Some(match section.kind {
        "square" => Shape::Square {
            at_s,
            half_period_s: section.number("half_period_s")?,
            bipolar: section.boolean("bipolar")?,
        },
        "doublet" => Shape::Doublet { at_s, width_s: width_s? },
        "pulse" => Shape::Pulse { at_s, width_s: width_s? },
        "ramp" => Shape::Ramp { at_s, width_s: width_s? },
        "sine" => Shape::Sine { at_s, frequency_hz: section.number("frequency_hz")? },
        "noise" => Shape::Noise { at_s, seed: u64::try_from(section.integer("seed")?).ok()? },
        _ => Shape::Step { at_s },
    })
}

fn table(report: &mut Report, section: &Section) -> Option<Profile> {
    let times = section.placed_numbers("time_s")?;
    let values = section.numbers("value_deg")?;
    let interpolation = match section.text("interpolation")? {
        "linear" => Interpolation::Linear,
        _ => Interpolation::Hold,
    };
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
    let word = section.text("enters_at")?;
    let entry = Entry::ALL.into_iter().find(|entry| entry.name() == word)?;
    let size = if section.kind == "noise" { "standard_deviation_deg" } else { "amplitude_deg" };
    let amplitude_rad = rad(section.number(size)?);
    let disturbance = Disturbance::new(entry, amplitude_rad, shape(section)?);
    judged(report, (section, size), disturbance)
}
