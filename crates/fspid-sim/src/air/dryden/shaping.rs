//! Turbulence from one time of its grid to the next, along a flight.

use std::sync::Arc;

use super::super::grid::GRID_S;
use super::super::wind::AirMotion;
use super::{Dryden, DrydenState, Follows, Turbulence};
use crate::error::SimError;

/// Height in steps of which the filters follow a flight, m.
const HEIGHT_STEP_M: f64 = 0.25;
/// Airspeed in steps of which they do, m/s.
const AIRSPEED_STEP_M_S: f64 = 0.1;

/// Turbulence at a time of the grid.
///
/// That of [`Follows::Flight`] has at each time of the grid the filters of the height and the airspeed with which the
/// aircraft comes there, rounded to 0.25 m and 0.1 m/s: what the air was goes on, and forgets and is driven as the filters
/// of the new place do. The random numbers are those of the time alone.
#[derive(Clone, Debug)]
pub(crate) struct Shaping {
    turbulence: Turbulence,
    /// Shared by all flights that have not left the condition of the start.
    filters: Arc<Dryden>,
    state: DrydenState,
    tick: usize,
}

impl Shaping {
    pub(crate) fn start(turbulence: &Turbulence) -> Result<Self, SimError> {
        let filters = Dryden::new(turbulence, GRID_S)?;
        let state = filters.start();
        Ok(Self { turbulence: turbulence.clone(), filters: Arc::new(filters), state, tick: 0 })
    }

    /// The time of the grid that has been reached.
    pub(crate) fn tick(&self) -> usize {
        self.tick
    }

    /// On to the next time of the grid, reached at a height above the ground with an airspeed, which is asked for where it
    /// counts.
    pub(crate) fn advance(&mut self, height_m: f64, airspeed_m_s: impl FnOnce() -> f64) {
        if self.turbulence.follows == Follows::Flight {
            self.follow(height_m, airspeed_m_s());
        }
        self.tick += 1;
        self.filters.advance(&mut self.state, self.tick);
    }

    /// Takes the filters of a height and an airspeed; where there are none, as at rest, the last ones stay.
    fn follow(&mut self, height_m: f64, airspeed_m_s: f64) {
        let height_m = (height_m / HEIGHT_STEP_M).round() * HEIGHT_STEP_M;
        let airspeed_m_s = (airspeed_m_s / AIRSPEED_STEP_M_S).round() * AIRSPEED_STEP_M_S;
        let here = Turbulence { height_m, airspeed_m_s, ..self.turbulence.clone() };
        if here == self.turbulence {
            return;
        }
        if let Ok(filters) = Dryden::new(&here, GRID_S) {
            self.filters = Arc::new(filters);
            self.turbulence = here;
        }
    }

    /// How the air moves.
    pub(crate) fn motion(&self) -> AirMotion {
        self.filters.motion(&self.state)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Severity, Specification};
    use super::*;

    fn turbulence(height_m: f64, follows: Follows) -> Turbulence {
        Turbulence {
            specification: Specification::MilF8785c,
            intensity: Severity::Moderate.into(),
            height_m,
            airspeed_m_s: 60.0,
            wing_span_m: 10.0,
            noise: 8.into(),
            follows,
            driven_until_s: f64::INFINITY,
        }
    }

    /// Vertical gusts of a minute at the heights that a flight has.
    fn gusts(follows: Follows, height_m: impl Fn(usize) -> f64) -> Vec<f64> {
        let mut shaping = Shaping::start(&turbulence(height_m(0), follows)).expect("allowed");
        let mut next = |tick| {
            shaping.advance(height_m(tick), || 60.0);
            shaping.motion().body_m_s[2]
        };
        (1..=6000).map(&mut next).collect()
    }

    #[test]
    fn a_level_flight_at_its_speed_meets_what_does_not_follow_it() {
        assert_eq!(gusts(Follows::Flight, |_| 300.0), gusts(Follows::Start, |_| 300.0));
    }

    #[test]
    fn a_flight_that_has_come_to_a_height_meets_the_air_of_that_height() {
        // From 600 m down to 60 m within 20 s: after some lengths of the air there, that of a flight that began there.
        let height_m = |tick: usize| 600.0 - 540.0 * (tick as f64 / 2000.0).min(1.0);
        let (coming, there) = (gusts(Follows::Flight, height_m), gusts(Follows::Start, |_| 60.0));
        for (coming, there) in coming.iter().zip(&there).skip(4000) {
            assert!((coming - there).abs() < 1e-6, "{coming} {there}");
        }
        assert_ne!(coming[1000], there[1000]);
    }

    #[test]
    fn nothing_that_a_flight_may_do_stops_the_air() {
        let mut shaping = Shaping::start(&turbulence(100.0, Follows::Flight)).expect("allowed");
        for (height_m, airspeed_m_s) in
            [(f64::NAN, 60.0), (-50.0, 0.0), (1e9, 1e5), (0.0, f64::NAN)]
        {
            shaping.advance(height_m, || airspeed_m_s);
            assert!(shaping.motion().body_m_s.iter().all(|value| value.is_finite()));
        }
    }
}
