//! Maps of an envelope: trim, linear model, modes and flying qualities over airspeed and altitude.
//!
//! Each point is a flight or the reason why there is none. The order of the rows and every bit in them are the same at
//! any number of threads.

use std::num::NonZeroUsize;
use std::thread;

use fspid_lti::TransferFunction;

use crate::aerodynamics::ForceModel;
use crate::aircraft::Aircraft;
use crate::error::AircraftError;
use crate::linearise::{Linearisation, VelocityForm};
use crate::modes::{AircraftMode, lateral_modes, longitudinal_modes};
use crate::qualities::{Category, CommandPath, PitchModel, Qualities};
use crate::trim::{TrimFailure, TrimTarget};

/// Where an envelope is looked at, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct EnvelopeGrid {
    /// True airspeeds.
    pub airspeeds_m_s: Vec<f64>,
    /// Geopotential altitudes.
    pub altitudes_m: Vec<f64>,
    /// Angle of the flight path, climbing positive.
    pub flight_path_rad: f64,
    /// Servo and dead time between command and elevator.
    pub path: CommandPath,
    /// For which category levels are given.
    pub category: Category,
}

/// One point of an envelope, with whatever else was asked of its linear model.
#[derive(Debug, Clone, PartialEq)]
pub struct EnvelopeRow<T> {
    /// Airspeed, altitude and flight path.
    pub target: TrimTarget,
    /// What the aircraft is like there, or why it cannot fly there.
    pub flight: Result<EnvelopeFlight<T>, Box<TrimFailure>>,
}

/// An aircraft at a point of its envelope.
#[derive(Debug, Clone, PartialEq)]
pub struct EnvelopeFlight<T> {
    /// Trim and linear model.
    pub linear: Linearisation,
    /// Pitch over elevator.
    pub plant: Result<TransferFunction, AircraftError>,
    /// Longitudinal modes, the fastest first.
    pub longitudinal: Result<Vec<AircraftMode>, AircraftError>,
    /// Lateral modes, the fastest first.
    pub lateral: Result<Vec<AircraftMode>, AircraftError>,
    /// Flying qualities in pitch.
    pub qualities: Result<Qualities, AircraftError>,
    /// What was asked beside: a margin of an autopilot, for example.
    pub beside: T,
}

impl EnvelopeGrid {
    /// Grid of evenly spaced airspeeds and altitudes in straight and level flight, for category B without a servo.
    #[must_use]
    pub fn even(airspeeds_m_s: Evenly, altitudes_m: Evenly) -> Self {
        Self {
            airspeeds_m_s: airspeeds_m_s.values(),
            altitudes_m: altitudes_m.values(),
            flight_path_rad: 0.0,
            path: CommandPath::default(),
            category: Category::default(),
        }
    }

    /// Points in the order of the rows: altitudes as given, at each the airspeeds as given.
    pub fn targets(&self) -> impl Iterator<Item = TrimTarget> {
        let flight_path_rad = self.flight_path_rad;
        self.altitudes_m.iter().flat_map(move |&altitude_m| {
            self.airspeeds_m_s.iter().map(move |&airspeed_m_s| TrimTarget {
                airspeed_m_s,
                altitude_m,
                flight_path_rad,
            })
        })
    }
}

/// Evenly spaced values.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Evenly {
    /// The first.
    pub first: f64,
    /// The last.
    pub last: f64,
    /// How many; of one the first.
    pub count: usize,
}

impl Evenly {
    fn values(self) -> Vec<f64> {
        let Self { first, last, count } = self;
        let steps = count.saturating_sub(1).max(1) as f64;
        (0..count).map(|index| first + (last - first) * (index as f64 / steps)).collect()
    }
}

impl<M: ForceModel + Sync> Aircraft<M> {
    /// Map of an envelope, with an answer of `beside` to the linear model of each flight.
    ///
    /// Rows come in the order of [`EnvelopeGrid::targets`], whichever thread made them.
    ///
    /// # Example
    /// ```
    /// # use fspid_aircraft::{
    /// #     AircraftError, Aircraft, Controls, Environment, Flow, ForceModel, Loads, MassProperties, Travel, Validity,
    /// # };
    /// # use fspid_aircraft::envelope::{EnvelopeGrid, Evenly, one_thread};
    /// # struct Stone;
    /// # impl ForceModel for Stone {
    /// #     fn loads(&self, _: &Flow, _: &Controls) -> Loads { Loads::default() }
    /// #     fn thrust_n(&self, _: &Flow, _: &Controls) -> f64 { 0.0 }
    /// #     fn validity(&self) -> &Validity { &Validity::EVERYWHERE }
    /// #     fn travel(&self) -> &Travel { &Travel::UNLIMITED }
    /// # }
    /// # fn main() -> Result<(), AircraftError> {
    /// # let mass = MassProperties {
    /// #     mass_kg: 1.0, ix_kg_m2: 1.0, iy_kg_m2: 1.0, iz_kg_m2: 1.0, ixz_kg_m2: 0.0, engine_kg_m2_s: 0.0,
    /// # };
    /// # let stone = Aircraft::new(mass, Stone, Environment::STANDARD)?;
    /// let grid = EnvelopeGrid::even(
    ///     Evenly { first: 50.0, last: 80.0, count: 4 },
    ///     Evenly { first: 0.0, last: 3000.0, count: 2 },
    /// );
    /// let rows = stone.envelope(&grid, one_thread(), |linear| linear.trim.thrust_n);
    /// assert_eq!(rows.len(), 8);
    /// assert!(rows.iter().all(|row| row.flight.is_err()), "a stone does not fly");
    /// # Ok(())
    /// # }
    /// ```
    pub fn envelope<T: Send>(
        &self,
        grid: &EnvelopeGrid,
        threads: NonZeroUsize,
        beside: impl Fn(&Linearisation) -> T + Sync,
    ) -> Vec<EnvelopeRow<T>> {
        let targets: Vec<TrimTarget> = grid.targets().collect();
        let threads = threads.get().min(targets.len()).max(1);
        // Slow points lie side by side in an envelope, so the threads take turns.
        let share = |first: usize| -> Vec<EnvelopeRow<T>> {
            let mine = targets.iter().skip(first).step_by(threads);
            mine.map(|target| self.envelope_row(grid, *target, &beside)).collect()
        };
        let shares = thread::scope(|scope| {
            let workers: Vec<_> =
                (0..threads).map(|first| scope.spawn(move || share(first))).collect();
            workers.into_iter().map(joined).collect::<Vec<_>>()
        });
        in_turn(shares)
    }

    fn envelope_row<T>(
        &self,
        grid: &EnvelopeGrid,
        target: TrimTarget,
        beside: impl Fn(&Linearisation) -> T,
    ) -> EnvelopeRow<T> {
        let trim = self.trim(target).map_err(Box::new);
        let flight = trim.map(|trim| {
            let linear = self.linearise(&trim);
            let beside = beside(&linear);
            let gravity_m_s2 = self.environment().gravity_m_s2;
            EnvelopeFlight {
                plant: linear.theta_over_elevator(),
                longitudinal: longitudinal(&linear),
                lateral: lateral(&linear),
                qualities: qualities(grid, &linear, gravity_m_s2),
                linear,
                beside,
            }
        });
        EnvelopeRow { target, flight }
    }
}

fn longitudinal(linear: &Linearisation) -> Result<Vec<AircraftMode>, AircraftError> {
    Ok(longitudinal_modes(&linear.longitudinal(VelocityForm::Components)?)?)
}

fn lateral(linear: &Linearisation) -> Result<Vec<AircraftMode>, AircraftError> {
    Ok(lateral_modes(&linear.lateral(VelocityForm::Components)?)?)
}

fn qualities(
    grid: &EnvelopeGrid,
    linear: &Linearisation,
    gravity_m_s2: f64,
) -> Result<Qualities, AircraftError> {
    let model = PitchModel::of(linear, gravity_m_s2)?.behind(grid.path.clone());
    Ok(Qualities::of(&model, grid.category))
}

/// What a thread made; its panic, if it had one, goes on.
fn joined<T>(worker: thread::ScopedJoinHandle<'_, T>) -> T {
    worker.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic))
}

/// One of each share in turn, as they were dealt.
fn in_turn<T>(shares: Vec<Vec<T>>) -> Vec<T> {
    let total = shares.iter().map(Vec::len).sum();
    let mut shares: Vec<_> = shares.into_iter().map(Vec::into_iter).collect();
    let mut rows = Vec::with_capacity(total);
    while rows.len() < total {
        rows.extend(shares.iter_mut().filter_map(Iterator::next));
    }
    rows
}

/// One thread, for callers that bring their own.
#[must_use]
pub const fn one_thread() -> NonZeroUsize {
    NonZeroUsize::MIN
}
