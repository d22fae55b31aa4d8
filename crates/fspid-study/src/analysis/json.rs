//! The answer of `analyse --format json`.

use fspid_core::Gains;
use fspid_lti::{Complex, modulus};
use serde_json::{Value, json};

use fspid_scenario::units::degrees;

use super::answer::{Margins, NO_CROSSOVER, NO_LOWER_LIMIT, NO_UPPER_LIMIT};
use super::flights::Flights;
use super::{
    AnalysedLoop, AnalysedMode, Analysis, Equilibrium, FlownExternal, FrozenMap, FrozenPoint,
    FrozenReach, PlantLoop, RestLoop, Stability,
};
use crate::json::{by_name, merged, present, unless_empty};
use crate::metrics::Absent;

/// Version of the answer's shape.
const SCHEMA: u32 = 1;

impl Analysis {
    /// The answer for programs: an infinite margin is `null`, with its reason under `reasons`. `stability` is a loop's
    /// verdict ([`Stability::word`]), `stable` the same as true, false or `null`; where there are no margins, `absent`
    /// says why.
    #[must_use]
    pub fn json(&self) -> Value {
        present(json!({
            "schema": SCHEMA,
            "scenario": self.scenario,
            "broken_at": self.question.point.name(),
            "controllers": self.loops.iter().map(controller).collect::<Vec<_>>(),
            "externals": unless_empty(&self.externals, FlownExternal::json),
            "not_in_the_linear_loop": self.left_out,
        }))
    }
}

fn controller(found: &AnalysedLoop) -> Value {
    let absent = || {
        let reason = found.absent.map(|reason| reason.to_string());
        let undecided = Stability::Undecided;
        merged([of_stability(undecided), json!({ "absent": reason.unwrap_or_default() })])
    };
    let (kind, gains) = match &found.equilibrium {
        Equilibrium::Fixed(gains) => ("fixed", Some(*gains)),
        Equilibrium::AtRest(gains) => ("at rest", Some(*gains)),
        Equilibrium::Drifts { .. } => ("none: they drift", None),
    };
    let of_several = |it: &PlantLoop| merged([json!({ "from_s": it.from_s }), plant(it)]);
    // With a mode of an autopilot that grows, or an aircraft that is in doubt, the pitch loop alone may be stable, and has its margins.
    let is_around = found.growing_modes() > 0 || found.doubt.is_some();
    let with_modes = is_around.then(|| of_stability(found.stability()));
    let plants = if found.plants.len() > 1 { found.plants.as_slice() } else { &[] };
    merged([
        json!({ "name": found.name }),
        found.worst().map_or_else(absent, plant),
        with_modes.unwrap_or_else(|| json!({})),
        json!({ "gains_are": kind, "gains": gains.map(triple) }),
        present(json!({
            "plants": unless_empty(plants, of_several),
            "modes": unless_empty(&found.modes, AnalysedMode::json),
            "undecided": found.doubt.map(|doubt| Absent::Undecided(doubt).to_string()),
            "flights": found.flights.as_ref().map(Flights::json),
        })),
    ])
}

fn plant(plant: &PlantLoop) -> Value {
    let RestLoop { at, gains, closed_poles, open, .. } = &plant.worst;
    let is_unstable = plant.stability() == Stability::Unstable;
    let unstable = closed_poles.iter().filter(|pole| is_unstable && modulus(**pole) >= 1.0);
    // Where gains that move make a constant command part of the loop, the rest at which it is worst.
    let moves = !plant.others.is_empty();
    merged([
        of_stability(plant.stability()),
        present(json!({
            "setpoint_deg": moves.then(|| degrees(at.setpoint_rad)),
            "load_deg": moves.then(|| degrees(at.load_rad)),
            "gain_on_the_error": moves.then_some(gains.kp),
            "unstable_poles": unstable.map(|pole| pole_of(*pole, open.dt_s())).collect::<Vec<_>>(),
        })),
        plant
            .margins
            .as_ref()
            .map_or_else(|reason| json!({ "absent": reason.to_string() }), margins),
        present(json!({
            "frozen_gains": plant.map().map(frozen),
            "frozen_gains_within_reach": plant.reach().map(within_reach),
        })),
    ])
}

/// The verdict as a word, and as true, false or `null`.
fn of_stability(stability: Stability) -> Value {
    json!({ "stable": stability.known(), "stability": stability.word() })
}

/// A pole in the z-plane and as a mode.
fn pole_of(pole: Complex, dt_s: f64) -> Value {
    let mode = super::text::mode(pole, dt_s);
    json!({
        "re": pole.re,
        "im": pole.im,
        "modulus": modulus(pole),
        "natural_frequency_rad_s": mode.natural_frequency_rad_s,
        "damping": mode.damping_ratio,
    })
}

/// JSON has no infinity: a margin without an end is null, and has a reason.
fn margins(margins: &Margins) -> Value {
    let [low, high] = margins.gain_margin_db;
    let crossover = margins.gain_crossover_rad_s.unwrap_or(f64::INFINITY);
    let reasons = [
        ("gain_margin_db[0]", low, NO_LOWER_LIMIT),
        ("gain_margin_db[1]", high, NO_UPPER_LIMIT),
        ("phase_margin_deg", margins.phase_margin_deg, NO_CROSSOVER),
        ("delay_margin_s", margins.delay_margin_s, NO_CROSSOVER),
        ("gain_crossover_rad_s", crossover, NO_CROSSOVER),
    ];
    let reasons = reasons.into_iter().filter(|(_, value, _)| !value.is_finite());
    let reasons = reasons.map(|(name, _, reason)| (name.to_owned(), json!(reason)));
    let open = margins.open_brackets().into_iter();
    let open = open.map(|(name, it)| (name.to_owned(), json!([it.at_least, it.at_most])));
    merged([
        json!({
            "gain_margin_db": margins.gain_margin_db,
            "phase_margin_deg": margins.phase_margin_deg,
            "delay_margin_s": margins.delay_margin_s,
            "disk_margin": margins.disk_margin,
            "sensitivity_peak": margins.sensitivity_peak,
            "gain_crossover_rad_s": margins.gain_crossover_rad_s,
            "phase_crossover_rad_s": margins.phase_crossover_rad_s,
            "disk_gain_db": margins.disk_gain_db,
            "disk_phase_deg": margins.disk_phase_deg,
            "complementary_peak": margins.complementary_peak,
            "spectral_radius": margins.spectral_radius,
        }),
        present(json!({ "proved_between": by_name(open), "reasons": by_name(reasons) })),
    ])
}

fn triple(gains: Gains<f64>) -> Value {
    json!({ "kp": gains.kp, "ki": gains.ki, "kd": gains.kd })
}

/// Points of the map and, where rules conclude numbers, the cells beside them.
fn frozen(map: &FrozenMap) -> Value {
    let has_cells = !map.nodes.is_empty();
    let undecided =
        |points| Some(FrozenMap::count(points, Stability::Undecided)).filter(|count| *count > 0);
    merged([
        of_stability(map.stability()),
        present(json!({
            "points": map.points.len(),
            "unstable": map.unstable(),
            "undecided": undecided(&map.points),
            "worst": frozen_point(&map.worst),
            "map": map.points.iter().map(frozen_point).collect::<Vec<_>>(),
            "cells": has_cells.then_some(map.nodes.len()),
            "unstable_cells": has_cells.then(|| map.unstable_nodes()),
            "undecided_cells": undecided(&map.nodes),
            "map_of_cells": unless_empty(&map.nodes, frozen_point),
        })),
    ])
}

/// Gains that an accumulating law may come to: how many were looked at, and the worst.
fn within_reach(reach: &FrozenReach) -> Value {
    let undecided = Some(reach.count(Stability::Undecided)).filter(|count| *count > 0);
    merged([
        of_stability(reach.stability()),
        present(json!({
            "points": reach.points.len(),
            "unstable": reach.count(Stability::Unstable),
            "undecided": undecided,
            "worst": frozen_gains(reach.worst.gains, &reach.worst.margins),
        })),
    ])
}

fn frozen_point(point: &FrozenPoint) -> Value {
    let [error, change] = point.input;
    merged([json!({ "error": error, "change": change }), frozen_gains(point.gains, &point.margins)])
}

fn frozen_gains(gains: Gains<f64>, found: &Result<Margins, Absent>) -> Value {
    merged([
        json!({ "gains": triple(gains) }),
        of_stability(Stability::of(found)),
        match found {
            Ok(found) => margins(found),
            Err(reason) => json!({ "absent": reason.to_string() }),
        },
    ])
}
