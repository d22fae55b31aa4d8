//! The linear plant of an aircraft around its trim.

use fspid_aircraft::linearise::{Linearisation, VelocityForm};
use fspid_aircraft::{AirMotion, Consumption, RIGID_STATES, Vector3};
use fspid_lti::Matrix;

use super::AircraftPlant;
use crate::error::SimError;
use crate::longitudinal::LongitudinalModel;
use crate::plant::{ElevatorSign, LinearPlant};

/// Half the width of the differences, m/s and rad/s.
const DIFFERENCE: f64 = 1e-3;
/// Places of u, w, q and of the derivative of pitch, which is q, in a rigid state.
const STATES: [usize; 3] = [3, 5, 11];

/// An aircraft that has burnt fuel, as if it stayed so.
#[derive(Clone, Debug, PartialEq)]
pub struct AfterBurning {
    /// Around the trim of the same speed and altitude; nothing without a trim there, or without a transfer function.
    pub plant: Option<LinearPlant>,
    /// Whether a flight of that length comes to it for certain.
    pub is_reached: bool,
}

impl AircraftPlant {
    /// The linear model from elevator and gusts to pitch at the trim: u, w, q, θ with the air's
    /// density constant, by central differences of the same equations that fly; it says so where the aircraft's data have a
    /// kink there ([`LinearPlant::is_between_slopes`]).
    ///
    /// # Errors
    /// [`SimError`] where the model has no transfer function from elevator to pitch.
    pub fn linear(&self) -> Result<LinearPlant, SimError> {
        let linearisation = self.aircraft().linearise(self.trim());
        let (denominator, numerators) = self.model(&linearisation)?.transfer_functions()?;
        let [elevator, forward, down, pitch] = numerators;
        let plant = LinearPlant::new(&elevator, &denominator, ElevatorSign::NoseDownPositive)?;
        let plant = plant.with_gusts([&forward, &down, &pitch])?;
        let plant = plant.being_away(self.away());
        Ok(plant.between_slopes(self.aircraft().has_kink_at(self.trim())))
    }

    /// The plants that last: of the trim, and after each change of a configuration that of the trim at the same speed and
    /// altitude, each with the time from which on it stands, s. Nothing in the place of one that has no trim there, or no
    /// transfer function. Burnt fuel is another question.
    ///
    /// # Errors
    /// As [`linear`](Self::linear).
    pub fn lasting(&self) -> Result<Vec<(f64, Option<LinearPlant>)>, SimError> {
        let mut plants = vec![(0.0, Some(self.linear()?))];
        for later in self.standings().iter().filter(|it| it.is_after_a_change()) {
            let plant = later.plant.as_ref().and_then(|plant| plant.linear().ok());
            plants.push((later.from_s, plant));
        }
        Ok(plants)
    }

    /// The aircraft with the fuel that is left at a time, s, which is that of the end of a flight; nothing where none is burnt.
    ///
    /// With a flow that is the same all the time that is what is left then. What an engine takes by its thrust only the flight
    /// tells: there the tank is empty.
    #[must_use]
    pub fn after_burning(&self, end_s: f64) -> Option<AfterBurning> {
        let fuel = self.changing().fuel()?;
        let (left_kg, is_reached) = match fuel.consumption {
            Consumption::Flow { kg_s } => (fuel.left_kg(kg_s * end_s), true),
            Consumption::ThrustSpecific { .. } => (0.0, false),
        };
        let plant = self.standing_at(end_s, Some(left_kg));
        let plant = plant.and_then(|plant| plant.linear().ok());
        Some(AfterBurning { plant, is_reached })
    }

    /// States u, w, q, θ; inputs elevator, forward gust, downward gust, pitch gust.
    fn model(&self, linearisation: &Linearisation) -> Result<LongitudinalModel, SimError> {
        let system = linearisation.longitudinal(VelocityForm::Components);
        let system = system.map_err(|_| SimError::NotLinear)?;
        let entry = |matrix: &Matrix, row, column| matrix.get(row, column).unwrap_or(0.0);
        let gusts = [self.by_gust(0), self.by_gust(1), self.by_gust(2)];
        let b = |row: usize, input: usize| match input {
            0 => entry(system.b(), row, 0),
            _ => gusts.get(input - 1).and_then(|gust| gust.get(row)).copied().unwrap_or(0.0),
        };
        Ok(LongitudinalModel {
            a: std::array::from_fn(|row| {
                std::array::from_fn(|column| entry(system.a(), row, column))
            }),
            b: std::array::from_fn(|row| std::array::from_fn(|input| b(row, input))),
        })
    }

    /// What a gust forward (0), down (1) or in pitch (2) adds to the rates of u, w, q, θ.
    fn by_gust(&self, gust: usize) -> [f64; 4] {
        let rate = |size: f64| {
            let part = |index: usize| if gust == index { size } else { 0.0 };
            let motion = AirMotion {
                gust_body_m_s: Vector3::new(part(0), 0.0, part(1)),
                gust_rates_rad_s: Vector3::new(0.0, part(2), 0.0),
                ..AirMotion::STILL
            };
            let trim = self.trim();
            self.aircraft().rate(&trim.state.to_array(), &trim.controls, &motion)
        };
        let (more, less): ([f64; RIGID_STATES], _) = (rate(DIFFERENCE), rate(-DIFFERENCE));
        let [u, w, q] = STATES.map(|place| match (more.get(place), less.get(place)) {
            (Some(more), Some(less)) => (more - less) / (2.0 * DIFFERENCE),
            _ => 0.0,
        });
        [u, w, q, 0.0]
    }
}
