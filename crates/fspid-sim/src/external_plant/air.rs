//! The air of ours around the aircraft of another simulator: winds, gusts and turbulence along its own way.

use fspid_aircraft::{EulerAngles, Quaternion};

use super::{PlantSample, StepInput};
use crate::air::{AirPlace, Grid, Shaping};
use crate::aircraft::Atmosphere;
use crate::error::SimError;
use crate::surroundings::Weather;

/// What moves the air, whoever flies.
///
/// A simulator is told the air of the end of each of its steps, where it asks for forces: at a place that the way of the
/// sample leads to, straight on, with gusts along the axes that the body has turned to by then with its pitch rate. Rates
/// of the air are left out: velocities are all that it takes.
#[derive(Clone, Debug)]
pub(super) struct MovingAir {
    atmosphere: Atmosphere,
    /// Of the simulator's steps.
    grid: Grid,
    step_s: f64,
    steps: u32,
    /// At the start, to the north, to the east and down, m/s.
    start_m_s: [f64; 3],
}

/// Where the air is along a flight.
#[derive(Clone, Debug)]
pub(super) struct AirState {
    /// Steps so far.
    step: usize,
    turbulence: Option<Shaping>,
    /// Way through the air since the start, m.
    distance_m: f64,
}

impl MovingAir {
    /// Around an aircraft that starts at an altitude, in so many steps a sample; `None` for air that stands still.
    ///
    /// # Errors
    /// [`SimError::Number`] for a course or turbulence out of its range.
    pub(super) fn new(
        weather: &Weather,
        altitude_m: f64,
        (step_s, steps): (f64, u32),
    ) -> Result<Option<Self>, SimError> {
        let atmosphere = Atmosphere::new(Some(weather), altitude_m)?;
        if !atmosphere.moves() {
            return Ok(None);
        }
        let [north_m, east_m] = weather.course.start_m;
        let height_m = weather.course.height_m;
        let place = AirPlace { time_s: 0.0, distance_m: 0.0, north_m, east_m, height_m };
        let start_m_s = atmosphere.wind(&place).wind_ned_m_s.to_array();
        Ok(Some(Self { atmosphere, grid: Grid::new(step_s), step_s, steps, start_m_s }))
    }

    /// The wind of the start to the north and to the east, m/s.
    pub(super) fn start_m_s(&self) -> [f64; 2] {
        let [north_m_s, east_m_s, _] = self.start_m_s;
        [north_m_s, east_m_s]
    }

    pub(super) fn start(&self) -> AirState {
        AirState { step: 0, turbulence: self.atmosphere.start_turbulence(), distance_m: 0.0 }
    }

    /// The air that the steps behind a sample meet.
    pub(super) fn tell(&self, state: &mut AirState, from: &PlantSample, steps: &mut [StepInput]) {
        for (number, step) in (1_u32..).zip(steps) {
            state.step += 1;
            if let Some(turbulence) = &mut state.turbulence {
                let tick = self.grid.tick(state.step);
                while turbulence.tick() < tick {
                    turbulence.advance(from.height_m, || from.airspeed_m_s);
                }
            }
            let since_s = f64::from(number) * self.step_s;
            let now_m_s = self.at(state, from, since_s);
            step.air_m_s = std::array::from_fn(|axis| now_m_s[axis] - self.start_m_s[axis]);
        }
    }

    /// What a sample leaves behind it.
    pub(super) fn leave(&self, state: &mut AirState, [from, to]: [&PlantSample; 2]) {
        let period_s = f64::from(self.steps) * self.step_s;
        state.distance_m += 0.5 * (from.airspeed_m_s + to.airspeed_m_s) * period_s;
    }

    /// To the north, to the east and down, m/s, so long after a sample.
    fn at(&self, state: &AirState, from: &PlantSample, since_s: f64) -> [f64; 3] {
        let ([north_m, east_m], [north_m_s, east_m_s]) = (from.position_m, from.over_ground_m_s);
        let place = AirPlace {
            time_s: state.step as f64 * self.step_s,
            distance_m: state.distance_m + from.airspeed_m_s * since_s,
            north_m: north_m + north_m_s * since_s,
            east_m: east_m + east_m_s * since_s,
            height_m: from.height_m + from.climb_m_s * since_s,
        };
        let turbulence = state.turbulence.as_ref().map(Shaping::motion).unwrap_or_default();
        let air = self.atmosphere.at(&place, turbulence);
        let attitude = Quaternion::from_euler(EulerAngles {
            phi_rad: from.bank_rad,
            theta_rad: from.theta_rad + from.q_rad_s * since_s,
            psi_rad: from.heading_rad,
        });
        (air.wind_ned_m_s + attitude.to_ned(air.gust_body_m_s)).to_array()
    }
}
