//! Nonlinear aircraft in the loop: against the linear model, in moving air, at their limits.
#![allow(clippy::float_cmp, reason = "the same bits are asked for")]

mod about_trims;
mod agreement;
mod at_rest;
mod away_from_rest;
mod beyond_limits;
mod configurations;
mod control_law;
mod design_gusts;
mod flown_on;
mod gains_at_rest;
mod gallery;
mod ground;
mod held_away;
mod limits;
mod linear_file;
mod loading;
mod lqi;
mod modes_at_rest;
mod moving_air;
mod old_scenarios;
mod one_verdict;
mod outer_gains;
mod outer_loops;
mod requirements;
mod six_dof;
mod turns;
mod what_is_held;
mod where_it_leads;
mod wind_table;

use fspid_scenario::file::{self, Study};
use fspid_sim::{AircraftPlant, Doubt, EarlyEnd, EndCause, Plant, Trace};
use fspid_study::metrics::Verdict;
use fspid_study::simulation::{ControllerResult, Simulation};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

/// A quiet flight of the Navion at its reference speed.
const NAVION: &str = include_str!("../data/navion.toml");

/// Numbers that are the same each time.
struct Draw(ChaCha8Rng);

impl Draw {
    fn seeded(seed: u64) -> Self {
        Self(ChaCha8Rng::seed_from_u64(seed))
    }

    fn of<T: Copy>(&mut self, values: &[T]) -> T {
        values[self.0.next_u32() as usize % values.len()]
    }

    fn between(&mut self, lower: f64, upper: f64) -> f64 {
        lower + (upper - lower) * f64::from(self.0.next_u32()) / f64::from(u32::MAX)
    }
}

/// A scenario with changes, as `--set` has them.
fn study(text: &str, set: &[&str]) -> Study {
    let set: Vec<String> = set.iter().map(|&change| change.to_owned()).collect();
    file::parse(text, "test.toml", None, &set).unwrap_or_else(|problems| panic!("{problems}"))
}

/// The Navion with these changes, trimmed.
fn trimmed(set: &[&str]) -> AircraftPlant {
    match study(NAVION, set).scenario.plant {
        Plant::Aircraft(plant) => *plant,
        Plant::Linear(_) | Plant::External(_) => panic!("it flies nonlinear"),
    }
}

/// What is said of the Navion with changes that are wrong.
fn refusal(set: &[&str]) -> String {
    let set: Vec<String> = set.iter().map(|&change| change.to_owned()).collect();
    file::parse(NAVION, "test.toml", None, &set).expect_err("it is wrong").to_string()
}

/// The trace of the only controller.
fn flown(text: &str, set: &[&str]) -> Trace {
    result(text, set).trace
}

/// What the first controller's flight comes to.
fn result(text: &str, set: &[&str]) -> ControllerResult {
    let found = Simulation::of(&study(text, set)).expect("it flies");
    found.results.into_iter().next().expect("a controller")
}

fn is_lost(flown: &ControllerResult) -> bool {
    matches!(flown.metrics.verdict, Verdict::EndedEarly(EarlyEnd { cause: EndCause::Diverged, .. }))
}

/// How far the error moves in the last fifth of a flight, and in the fifth before it, deg.
fn last_fifths_move_deg(flown: &ControllerResult) -> [f64; 2] {
    let errors = flown.trace.setpoint_rad.iter().zip(&flown.trace.theta_rad);
    let errors: Vec<f64> = errors.map(|(r, y)| (r - y).to_degrees()).collect();
    let from = |fifths: usize| errors.len() * fifths / 5;
    let size = |part: &[f64]| {
        let most = part.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        most - part.iter().copied().fold(f64::INFINITY, f64::min)
    };
    [size(&errors[from(4)..]), size(&errors[from(3)..from(4)])]
}

/// Why it is undecided whether a flight holds at rest, where it is.
fn doubt(result: &ControllerResult) -> Option<Doubt> {
    result.at_rest.undecided.map(|it| it.doubt)
}

/// A column that the flight has.
fn column<'a>(trace: &'a Trace, name: &str) -> &'a [f64] {
    trace.column(name).unwrap_or_else(|| panic!("{name}"))
}

/// Largest distance between two columns.
fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

fn largest(values: &[f64]) -> f64 {
    values.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()))
}
