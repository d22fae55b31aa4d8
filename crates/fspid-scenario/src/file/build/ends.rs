//! What every controller has around its gains: limits, anti-windup, guard.

use fspid_core::{AntiWindup, ConfigError, ControllerSetting, Guard, Limits, PidConfig};
use fspid_diagnostics::Report;

use super::{judged, rad};
use crate::file::spec::controller as keys;
use crate::file::spec::controller::AntiWindupKind;
use crate::keyed::{KeyName, Section};

/// The controller, or what is wrong with it at the setting that it is about.
pub(super) fn placed<T>(
    report: &mut Report,
    section: &Section,
    result: Result<T, ConfigError>,
) -> Option<T> {
    let place = result.as_ref().err().and_then(|error| place_of(section, error));
    judged(report, place.unwrap_or((section, keys::NAME.name)), result)
}

/// Where a setting stands that is sound by itself, and not with others: limits that exclude each other, times that the sample period
/// bounds.
fn place_of<'s>(section: &'s Section, error: &ConfigError) -> Option<(&'s Section, KeyName)> {
    match error {
        ConfigError::Conflict { .. } => Some((section, keys::ANTI_WINDUP.name)),
        ConfigError::Number { what: ControllerSetting::TrackingTime, .. } => {
            Some((section.get(keys::ANTI_WINDUP)?, keys::TRACKING_S.name))
        }
        ConfigError::Number { what: ControllerSetting::ModelBandwidth, .. } => {
            let model = section.get(keys::SUPERVISOR)?.get(keys::MODEL)?;
            Some((model, keys::BANDWIDTH_RAD_S.name))
        }
        _ => None,
    }
}

/// A configuration with limits, anti-windup and guard alone.
pub(super) fn ends(report: &mut Report, section: &Section, dt_s: f64) -> Option<PidConfig<f64>> {
    let limits = match section.get(keys::OUTPUT_LIMITS_DEG) {
        Some((lower, upper)) => {
            let limits = Limits::new(ControllerSetting::OutputLimits, rad(lower), rad(upper));
            Some(judged(report, (section, keys::OUTPUT_LIMITS_DEG), limits)?)
        }
        None => None,
    };
    let guard = Guard::new(rad(section.get(keys::SAMPLE_GUARD_DEG)?));
    let guard = judged(report, (section, keys::SAMPLE_GUARD_DEG), guard);
    let anti_windup = anti_windup(report, section, limits.is_some());
    Some(PidConfig {
        anti_windup: anti_windup?,
        limits,
        slew_rad_s: section.get(keys::SLEW_LIMIT_DEG_S).map(rad),
        guard: guard?,
        ..PidConfig::sampled_every(dt_s)
    })
}

fn anti_windup(report: &mut Report, section: &Section, limited: bool) -> Option<AntiWindup<f64>> {
    let Some(part) = section.get(keys::ANTI_WINDUP) else {
        return Some(AntiWindup::None);
    };
    let kind = part.variant()?;
    let acts_at_limits =
        matches!(kind, AntiWindupKind::Conditional | AntiWindupKind::BackCalculation);
    if acts_at_limits && !limited && section.get(keys::SLEW_LIMIT_DEG_S).is_none() {
        let message = format!("\"{}\" has no limit to act at", part.kind);
        let allowed = "with `output_limits_deg` or `slew_limit_deg_s`, or left out";
        report.missing(section.at(keys::ANTI_WINDUP), &part.path, message, allowed);
        return None;
    }
    Some(match kind {
        AntiWindupKind::Clamping => {
            let (lower, upper) = (part.get(keys::LOWER_DEG)?, part.get(keys::UPPER_DEG)?);
            if lower >= upper {
                part.wrong(
                    report,
                    keys::UPPER_DEG,
                    "not above `lower_deg`",
                    format!("above {lower:?} deg"),
                );
                return None;
            }
            let limits = Limits::new(ControllerSetting::AntiWindupLimits, rad(lower), rad(upper));
            AntiWindup::Clamping(judged(report, (part, keys::UPPER_DEG), limits)?)
        }
        AntiWindupKind::Conditional => AntiWindup::Conditional,
        AntiWindupKind::BackCalculation => {
            AntiWindup::BackCalculation { tracking_s: part.get(keys::TRACKING_S)? }
        }
        AntiWindupKind::None => AntiWindup::None,
    })
}
