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

/// How the gains of a controller follow the dynamic pressure of its trim.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Schedule {
    /// Dynamic pressure for which the gains are written, Pa.
    pub written_for_pa: f64,
    /// Power of the ratio of pressures.
    pub exponent: f64,
    /// Ends of the factor.
    pub limits: [f64; 2],
}

impl Schedule {
    /// The factor of all gains at a dynamic pressure.
    ///
    /// $$ f = (\bar q / \bar q_0)^n, \quad \bar q = \tfrac12 \rho V^2 $$
    ///
    /// The moment of an elevator deflection is $\bar q S \bar c C_{m_{\delta_e}} \delta_e$, so that $n = -1$ keeps the
    /// moment that an error commands as long as the derivative does not change with speed.
    #[must_use]
    pub fn factor(&self, dynamic_pressure_pa: f64) -> f64 {
        let [least, most] = self.limits;
        libm::pow(dynamic_pressure_pa / self.written_for_pa, self.exponent).max(least).min(most)
    }
}

/// The schedule of a section; `None` where its limits are wrong, which is reported.
pub(super) fn schedule(report: &mut Report, part: &Section) -> Option<Schedule> {
    let (least, most) = limits(report, part)?;
    Some(Schedule {
        written_for_pa: part.get(keys::DYNAMIC_PRESSURE_PA)?,
        exponent: part.get(keys::EXPONENT)?,
        limits: [least, most],
    })
}

/// The factor of all gains, 1 without a schedule; `None` where it is wrong, which is reported.
pub(super) fn factor(report: &mut Report, section: &Section, pressure: Pressure) -> Option<f64> {
    let Some(part) = section.get(keys::SCHEDULE) else {
        return Some(1.0);
    };
    let schedule = schedule(report, part)?;
    let pressure_pa = match pressure {
        Pressure::OfTrim(pressure_pa) => pressure_pa,
        // Whatever it is: what else is wrong with the controller is still found.
        Pressure::Unknown => schedule.written_for_pa,
        Pressure::None => {
            let message = "a `plant` has no dynamic pressure to schedule by";
            let allowed = "an `aircraft` in place of the plant, or no schedule";
            report.missing(section.at(keys::SCHEDULE), &part.path, message, allowed);
            return None;
        }
    };
    let factor = schedule.factor(pressure_pa);
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
