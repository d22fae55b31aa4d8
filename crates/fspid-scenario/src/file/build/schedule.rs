//! Gains that are scheduled by the dynamic pressure of the trim.

use fspid_core::{Gains, PidConfig};

use super::flown::Flown;
use super::judged;
use crate::file::spec::scenario::PLANT;
use crate::file::spec::schedule as keys;
use crate::keyed::Section;
use fspid_diagnostics::Report;

/// What is known of the dynamic pressure of a flight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Pressure {
    /// That of the trim, Pa.
    OfTrim(f64),
    /// The aircraft is wrong, which is reported elsewhere.
    Unknown,
    /// A plant of coefficients has none.
    None,
}

impl Pressure {
    /// The pressure at the trim of what flies.
    pub(super) fn of(section: &Section, flown: Option<&Flown>) -> Self {
        match flown {
            Some(flown) => {
                flown.way.map_or(Self::None, |way| Self::OfTrim(way.dynamic_pressure_pa))
            }
            None if section.get(PLANT).is_some() => Self::None,
            None => Self::Unknown,
        }
    }
}

/// The factor of all gains, 1 without a schedule; `None` where it is wrong, which is reported.
///
/// $$ f = (\bar q / \bar q_0)^n, \quad \bar q = \tfrac12 \rho V^2 $$
///
/// The moment of an elevator deflection is $\bar q S \bar c C_{m_{\delta_e}} \delta_e$, so that $n = -1$ keeps the
/// moment that an error commands as long as the derivative does not change with speed.
pub(super) fn factor(report: &mut Report, section: &Section, pressure: Pressure) -> Option<f64> {
    let Some(part) = section.get(keys::SCHEDULE) else {
        return Some(1.0);
    };
    let (least, most) = limits(report, part)?;
    let pressure_pa = match pressure {
        Pressure::OfTrim(pressure_pa) => pressure_pa,
        // Whatever it is: what else is wrong with the controller is still found.
        Pressure::Unknown => part.get(keys::DYNAMIC_PRESSURE_PA)?,
        Pressure::None => {
            let message = "a `plant` has no dynamic pressure to schedule by";
            let allowed = "an `aircraft` in place of the plant, or no schedule";
            report.missing(section.at(keys::SCHEDULE), &part.path, message, allowed);
            return None;
        }
    };
    let ratio = pressure_pa / part.get(keys::DYNAMIC_PRESSURE_PA)?;
    let factor = libm::pow(ratio, part.get(keys::EXPONENT)?).max(least).min(most);
    // Written so that NaN fails.
    if !(factor > 0.0 && factor.is_finite()) {
        let message = format!("the gains would be multiplied by {factor:?}");
        let allowed = "a finite factor above 0, or `least_factor` and `most_factor`";
        part.wrong(report, keys::EXPONENT, message, allowed);
        return None;
    }
    Some(factor)
}

fn limits(report: &mut Report, part: &Section) -> Option<(f64, f64)> {
    let least = part.get(keys::LEAST_FACTOR).unwrap_or(0.0);
    let most = part.get(keys::MOST_FACTOR).unwrap_or(f64::INFINITY);
    if least <= most {
        return Some((least, most));
    }
    part.wrong(report, keys::MOST_FACTOR, "below `least_factor`", format!("{least:?} or above"));
    None
}

/// Gains, the gain of the rate loop and what is fed forward, times the factor.
pub(super) fn scaled(
    report: &mut Report,
    section: &Section,
    factor: f64,
    (gains, config): (Gains<f64>, PidConfig<f64>),
) -> Option<(Gains<f64>, PidConfig<f64>)> {
    let Gains { kp, ki, kd } = gains;
    let scaled = Gains { kp: kp * factor, ki: ki * factor, kd: kd * factor }.checked();
    let gains = judged(report, (section, keys::SCHEDULE), scaled)?;
    let rate_gain_s = config.rate_gain_s * factor;
    Some((gains, PidConfig { rate_gain_s, feedforward: config.feedforward * factor, ..config }))
}
