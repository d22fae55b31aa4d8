//! Gains that no key of a file states, because a schedule or a design makes them.

use fspid_core::Gains;
use fspid_sim::Controller;

use super::schedule::{self, Pressure, Schedule};
use crate::file::spec::controller as keys;
use crate::file::spec::controller::ControllerKind;
use crate::file::spec::schedule::SCHEDULE;
use crate::keyed::Section;
use fspid_diagnostics::Report;

/// The gains that a controller flies with, where they are not those of its file.
#[derive(Clone, Debug, PartialEq)]
pub struct DerivedGains {
    /// Name of the controller.
    pub controller: String,
    /// Its gains.
    pub gains: Gains<f64>,
    /// Gain of its rate loop, s.
    pub rate_gain_s: f64,
    /// Where they come from.
    pub source: GainSource,
}

/// What makes the gains of a controller.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum GainSource {
    /// Those of the file times a factor.
    Schedule {
        /// Dynamic pressure of the trim, Pa.
        dynamic_pressure_pa: f64,
        /// The factor.
        factor: f64,
        /// What it is at any pressure.
        schedule: Schedule,
    },
    /// A linear-quadratic regulator of a model and weights.
    Regulator,
}

impl std::fmt::Display for GainSource {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Schedule { dynamic_pressure_pa, factor, .. } => write!(
                f,
                "those of the file times {factor:.6}: schedule at a dynamic pressure of {dynamic_pressure_pa:.2} Pa"
            ),
            Self::Regulator => f.write_str("linear-quadratic regulator of its design model"),
        }
    }
}

/// One line, as `fspid check` has it.
impl std::fmt::Display for DerivedGains {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { controller, gains: Gains { kp, ki, kd }, rate_gain_s, source } = self;
        write!(f, "{controller}: kp {kp:.6}, ki {ki:.6} 1/s, kd {kd:.6} s, ")?;
        write!(f, "rate gain {rate_gain_s:.6} s; {source}")
    }
}

/// The gains of a controller that its section does not state; `None` where it states them.
pub(super) fn derived(
    section: &Section,
    controller: &Controller,
    pressure: Pressure,
) -> Option<DerivedGains> {
    let source = source(section, pressure)?;
    Some(DerivedGains {
        controller: section.get(keys::NAME)?.to_owned(),
        gains: controller.nominal(),
        rate_gain_s: controller.config().rate_gain_s,
        source,
    })
}

fn source(section: &Section, pressure: Pressure) -> Option<GainSource> {
    if section.variant() == Some(ControllerKind::Lqi) {
        return Some(GainSource::Regulator);
    }
    let part = section.get(SCHEDULE)?;
    // It was sound when the controller was built.
    let report = &mut Report::default();
    let factor = schedule::factor(report, section, pressure)?;
    let schedule = schedule::schedule(report, part)?;
    match pressure {
        Pressure::OfTrim(dynamic_pressure_pa) => {
            Some(GainSource::Schedule { dynamic_pressure_pa, factor, schedule })
        }
        Pressure::Unknown | Pressure::None => None,
    }
}
