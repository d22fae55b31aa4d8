//! The aircraft configurations at which a flight is trimmed and judged: at the start, after each change of configuration,
//! with empty tanks.

use fspid_aircraft::{Aircraft, Trim};

use super::{AircraftPlant, Changing, Forces};
use crate::plant::{Away, Plant};
use crate::scenario::Scenario;

/// Pitch angle of a trim, rad.
pub(crate) fn pitch_rad(trim: &Trim) -> f64 {
    trim.point.alpha_rad + trim.target.flight_path_rad
}

/// An aircraft that stays as it is, at its trim at the speed and altitude of the start.
#[derive(Clone, Debug)]
pub(crate) struct Standing {
    /// What brought it about.
    pub(crate) by: Change,
    /// From when on a flight has it, s.
    pub(crate) from_s: f64,
    /// When it has begun to be another, s; infinite for what lasts.
    pub(crate) until_s: f64,
    /// The plant; none where it has no such trim.
    pub(crate) plant: Option<AircraftPlant>,
}

/// What an aircraft has become another by.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Change {
    /// Nothing: the aircraft of the start.
    Nothing,
    /// A configuration that has moved.
    Configuration,
    /// Fuel that was burnt, all of it, which a flight may or may not come to.
    Fuel,
}

impl Standing {
    /// True for one that a change of a configuration has brought about.
    pub(crate) fn is_after_a_change(&self) -> bool {
        self.by == Change::Configuration
    }

    /// A scenario with this aircraft from the start on; none without a trim.
    pub(crate) fn flown_in(&self, scenario: &Scenario) -> Option<Scenario> {
        let plant = Plant::Aircraft(Box::new(self.plant.clone()?));
        Some(Scenario { plant, ..scenario.clone() })
    }

    /// Numbers of the modes of a scenario's autopilot that may be flown with it, and when each begins at the earliest, s: those
    /// that begin when the aircraft is another are not.
    pub(crate) fn modes(&self, scenario: &Scenario) -> Vec<(usize, f64)> {
        let modes = scenario.autopilot.iter().flat_map(|autopilot| autopilot.modes());
        let begins = modes.map(|mode| mode.entry.at_s).enumerate();
        begins.filter(|(_, at_s)| *at_s < self.until_s).collect()
    }
}

impl AircraftPlant {
    /// The aircraft that a flight stands with, in order of time, and last that with an empty tank, if it burns fuel.
    pub(crate) fn standings(&self) -> Vec<Standing> {
        let ended_s = self.changing().ended_s();
        let next_s = |place: usize| ended_s.get(place).copied().unwrap_or(f64::INFINITY);
        let full = self.changing().fuel().map(|fuel| fuel.left_kg(0.0));
        let (by, plant) = (Change::Nothing, Some(self.clone()));
        let mut all = vec![Standing { by, from_s: 0.0, until_s: next_s(0), plant }];
        for (place, &from_s) in ended_s.iter().enumerate() {
            let (by, plant) = (Change::Configuration, self.standing_at(from_s, full));
            all.push(Standing { by, from_s, until_s: next_s(place + 1), plant });
        }
        if full.is_some() {
            let from_s = ended_s.last().copied().unwrap_or(0.0);
            let plant = self.standing_at(from_s, Some(0.0));
            all.push(Standing { by: Change::Fuel, from_s, until_s: f64::INFINITY, plant });
        }
        all
    }

    /// How far its trim is from the one that is counted from.
    pub(crate) fn away(&self) -> Away {
        let [here, start] = [&self.trim, &self.counted_from];
        Away {
            // The trailing edge goes up where the command turns the nose up.
            command_rad: start.point.elevator_rad - here.point.elevator_rad,
            pitch_rad: pitch_rad(here) - pitch_rad(start),
            throttle: here.point.throttle - start.point.throttle,
        }
    }

    /// The aircraft where it has another trim.
    pub(crate) fn at(&self, trim: Trim) -> Self {
        Self { trim, ..self.clone() }
    }

    /// An aircraft that is so many times as heavy, at the same airspeed, path and altitude; nothing where it has no trim.
    pub(crate) fn under_load(&self, load: f64) -> Option<Self> {
        let aircraft = self.aircraft();
        let mut environment = *aircraft.environment();
        environment.gravity_m_s2 *= load;
        let model = aircraft.model().clone();
        let aircraft = Aircraft::new(*aircraft.mass(), model, environment).ok()?;
        let trim = aircraft.trim(self.trim().target).ok()?;
        Some(Self { aircraft, trim, ..self.clone() })
    }

    /// The aircraft of a time with that much fuel, as if it stayed so; nothing where it has no trim.
    pub(super) fn standing_at(&self, time_s: f64, fuel_kg: Option<f64>) -> Option<Self> {
        let (model, changing) = (self.aircraft().model().varied()?, self.changing());
        let fuel = changing.fuel().zip(fuel_kg).map(|(fuel, left_kg)| (&fuel.body, left_kg));
        let aircraft = model.starting_at(self.aircraft(), changing.shares(time_s), fuel);
        let changing = Changing::none_of(aircraft.model());
        let aircraft = aircraft.with_model(Forces::from);
        let trim = aircraft.trim(self.trim().target).ok()?;
        Some(Self { aircraft, trim, changing, ..self.clone() })
    }
}
