//! One speed and altitude.

use fspid_aircraft::qualities::{Category, PitchModel, ShortPeriod};
use fspid_aircraft::{
    Aircraft, AircraftMode, Linearisation, ModeName, Trim, TrimFailure, TrimTarget, VelocityForm,
    longitudinal_modes,
};
use fspid_sim::aircraft::Forces;

use super::autopilot::{Autopilot, Loop};
use crate::aircraft::failure::departure;
use crate::aircraft::units::Units;

/// A speed and altitude, and what the aircraft is like there.
#[derive(Clone, Debug)]
pub(super) struct Point {
    pub(super) airspeed_m_s: f64,
    pub(super) altitude_m: f64,
    /// The flight, or why there is none.
    pub(super) held: Result<Held, Box<TrimFailure>>,
}

/// A flight that is held.
#[derive(Clone, Debug)]
pub(super) struct Held {
    pub(super) trim: Trim,
    pub(super) modes: Vec<AircraftMode>,
    /// Short period with its control anticipation, judged.
    pub(super) short_period: Option<ShortPeriod>,
    /// The sampled loop, where there is an autopilot.
    pub(super) judged: Option<Loop>,
}

impl Point {
    pub(super) fn of(
        aircraft: &Aircraft<Forces>,
        (airspeed_m_s, altitude_m): (f64, f64),
        (category, autopilot): (Category, Option<&Autopilot>),
    ) -> Self {
        let gravity_m_s2 = aircraft.environment().gravity_m_s2;
        let target = TrimTarget { airspeed_m_s, altitude_m, flight_path_rad: 0.0 };
        let held = match aircraft.trim(target) {
            Ok(trim) => {
                let model = aircraft.linearise(&trim);
                let short_period = short_period(&model, gravity_m_s2, category);
                Ok(Held { short_period, ..Held::of(&model, autopilot) })
            }
            Err(failure) => Err(Box::new(failure)),
        };
        Self { airspeed_m_s, altitude_m, held }
    }

    /// Why it cannot be flown, in a line.
    pub(super) fn reason(&self, units: Units) -> Option<String> {
        let failure = self.held.as_ref().err()?;
        let limits: Vec<String> =
            failure.limits.iter().map(|limit| departure(limit, units)).collect();
        Some(match limits.is_empty() {
            true => "no balance of forces found".to_owned(),
            false => limits.join("; "),
        })
    }
}

impl Held {
    fn of(model: &Linearisation, autopilot: Option<&Autopilot>) -> Self {
        let longitudinal = model.longitudinal(VelocityForm::Components).ok();
        let modes = longitudinal.and_then(|system| longitudinal_modes(&system).ok());
        let plant = model.theta_over_elevator().ok();
        let judged = autopilot.and_then(|autopilot| autopilot.judge(&plant?));
        let modes = modes.unwrap_or_default();
        Self { trim: model.trim, modes, short_period: None, judged }
    }

    /// Frequency and damping of a mode that is a pair.
    pub(super) fn pair(&self, name: ModeName) -> Option<fspid_lti::Mode> {
        let found = self.modes.iter().find(|mode| mode.name == name && mode.oscillates());
        found.and_then(|mode| mode.mode().ok())
    }
}

fn short_period(
    model: &Linearisation,
    gravity_m_s2: f64,
    category: Category,
) -> Option<ShortPeriod> {
    let model = PitchModel::of(model, gravity_m_s2).ok()?;
    ShortPeriod::of(&model, category).ok()
}
