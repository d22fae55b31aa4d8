//! An identification as a search problem: which numbers are free, and what a candidate costs.
//!
//! The cost of a figure is the sum of squares of its claims' residuals, each in half units of the
//! last printed digit (or, for one supervisor shared by several figures, in shares of the number),
//! plus penalties that keep a fit from hiding what the paper does not show: overshoot above 10 %,
//! ringing, a chattering command. Nothing but the claims enters.

use fspid_core::fuzzy::RuleTable;
use fspid_sim::{LinearPlant, Noises, Trace, simulate};

use super::super::claim::{CLAIMS, Claim, Quantity};
use super::super::model::{
    Command, ControllerModel, FULL_MODEL, FlightModel, SHORT_PERIOD, Scales, Setting, on_grid,
};
use super::super::reading::{FigureFlight, figure_of, number, readings};
use fspid_optimise::{Parameter, Scale};
use fspid_scenario::measure::Measure;
use fspid_scenario::units::degrees;
use fspid_study::metrics::{EdgeMetrics, FlightMetrics, StepMetrics, StepWindow};

/// Reading time of Figs 5 and 6, s (assumption A15).
pub(super) const WINDOW_S: f64 = 12.0;

/// The claims speak of the first and the third step of a square wave; the search flies no further.
const JUDGED_HALF_PERIODS: u32 = 3;

/// What a flight that diverges costs, times up to two for an early end.
const DIVERGED_COST: f64 = 1e8;

/// Share of half a unit that a fit to the digits is content with: inside, with room for rounding.
const INSIDE: f64 = 0.85;

/// Name of the parameter that lies on the sample grid.
pub(super) const HALF_PERIOD: &str = "half_period_s";

/// How residuals are weighed.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Weighing {
    /// In half units of the last printed digit, to the middle of it.
    Centre,
    /// In half units of the last printed digit, content with [`INSIDE`] of one.
    Digits,
    /// In 5 % of rise times and 0.5 points or 10 % of overshoots.
    Shares,
}

/// The free numbers of a figure beside the supervisor's scales.
#[derive(Clone, Copy, Debug)]
pub(super) struct FigureProblem {
    /// Its number.
    pub(super) id: &'static str,
    /// Its name in the scenario.
    pub(super) name: &'static str,
    /// Plant and supervisor.
    pub(super) setting: Setting,
    /// How many CPID tunings it shows, each with an FSPID of the same nominal gains.
    pub(super) tunings: usize,
    /// Bounds of the half period, s; none for a step.
    pub(super) half_period_s: Option<(f64, f64)>,
    /// The rate-gyro loop works.
    pub(super) gyro: bool,
    /// Bounds of kp, ki, kd.
    pub(super) gains: [(f64, f64); 3],
}

const FULL_GAINS: [(f64, f64); 3] = [(1.0, 10.0), (1e-2, 10.0), (1e-2, 10.0)];
const SHORT_GAINS: [(f64, f64); 3] = [(0.1, 3.0), (1e-3, 1.0), (1e-3, 1.0)];

/// The figures to be identified.
pub(super) const PROBLEMS: [FigureProblem; 5] = [
    FigureProblem {
        id: "5",
        name: "Fig. 5: with the rate-gyro loop",
        setting: FULL_MODEL,
        tunings: 1,
        half_period_s: None,
        gyro: true,
        gains: [(1.0, 10.0), (1e-3, 10.0), (1e-2, 10.0)],
    },
    FigureProblem {
        id: "6",
        name: "Fig. 6: without the rate-gyro loop",
        setting: FULL_MODEL,
        tunings: 2,
        half_period_s: None,
        gyro: false,
        gains: FULL_GAINS,
    },
    FigureProblem {
        id: "8a",
        name: "Fig. 8a: a slow tuning",
        setting: SHORT_PERIOD,
        tunings: 1,
        half_period_s: Some((5.0, 9.0)),
        gyro: false,
        gains: SHORT_GAINS,
    },
    FigureProblem {
        id: "8b",
        name: "Fig. 8b: a tuning with overshoot",
        setting: SHORT_PERIOD,
        tunings: 1,
        half_period_s: Some((5.0, 8.0)),
        gyro: false,
        gains: SHORT_GAINS,
    },
    FigureProblem {
        id: "9",
        name: "Fig. 9: tracking",
        setting: SHORT_PERIOD,
        tunings: 1,
        half_period_s: Some((4.0, 30.0)),
        gyro: false,
        gains: SHORT_GAINS,
    },
];

/// The parameters of the supervisor's scales.
pub(super) fn scale_parameters(setting: Setting) -> Vec<Parameter> {
    let log = |name, lower, upper| Parameter { name, lower, upper, scale: Scale::Logarithmic };
    if setting == FULL_MODEL {
        vec![
            log("error_scale", 0.1, 100.0),
            log("change_scale", 0.03, 30.0),
            log("output_scale kp", 1e-3, 10.0),
            log("output_scale ki", 1e-3, 10.0),
            log("output_scale kd", 1e-3, 10.0),
        ]
    } else {
        vec![
            log("error_scale", 5.0, 100.0),
            log("change_scale", 5.0, 100.0),
            log("output_scale kp", 0.05, 1.0),
            log("output_scale ki", 1e-5, 0.1),
            log("output_scale kd", 1e-5, 0.2),
        ]
    }
}

pub(super) fn scales(point: &[f64]) -> Scales {
    match *point {
        [error, change, kp, ki, kd, ..] => Scales { error, change, output: [kp, ki, kd] },
        _ => Scales { error: 0.0, change: 0.0, output: [0.0; 3] },
    }
}

impl FigureProblem {
    /// The figure with its half period confined to one of `parts` equal parts of its interval.
    pub(super) fn part(&self, index: usize, parts: usize) -> Self {
        let half_period_s = self.half_period_s.map(|(lower, upper)| {
            let width = (upper - lower) / parts as f64;
            (lower + width * index as f64, lower + width * (index + 1) as f64)
        });
        Self { half_period_s, ..*self }
    }

    /// Nominal gains of each tuning, then the half period if there is one.
    pub(super) fn parameters(&self) -> Vec<Parameter> {
        const NAMES: [[&str; 3]; 2] = [["kp", "ki", "kd"], ["kp 2", "ki 2", "kd 2"]];
        let gains = NAMES.iter().take(self.tunings).flat_map(|names| {
            names.iter().zip(self.gains).map(|(name, (lower, upper))| Parameter {
                name,
                lower,
                upper,
                scale: Scale::Logarithmic,
            })
        });
        let half = self.half_period_s.map(|(lower, upper)| Parameter {
            name: HALF_PERIOD,
            lower,
            upper,
            scale: Scale::Linear,
        });
        gains.chain(half).collect()
    }

    /// The figure's flight for a point of [`parameters`](Self::parameters), with FSPIDs if there are
    /// scales, and with the proportional controller if there is one.
    pub(super) fn flight(
        &self,
        point: &[f64],
        scales: Option<Scales>,
        proportional: Option<[f64; 2]>,
    ) -> FlightModel {
        let command = match (self.half_period_s, point.get(3 * self.tunings)) {
            (Some(_), Some(&half)) => {
                Command::Square { half_period_s: on_grid(half), half_periods: JUDGED_HALF_PERIODS }
            }
            _ => Command::Step { window_s: WINDOW_S },
        };
        let [gain, gyro_gain] = proportional.unwrap_or([0.0; 2]);
        let rate_gain = if self.gyro { gyro_gain } else { 0.0 };
        let model =
            |name: String, gains, scales| ControllerModel { name, gains, rate_gain, scales };
        let mut controllers = Vec::new();
        if self.setting == FULL_MODEL && proportional.is_some() {
            controllers.push(model("PC".to_owned(), [gain, 0.0, 0.0], None));
        }
        let kinds =
            [("CPID", None)].into_iter().chain(scales.map(|scales| ("FSPID", Some(scales))));
        for (kind, scales) in kinds {
            for (index, gains) in point.chunks_exact(3).take(self.tunings).enumerate() {
                let number =
                    if self.tunings > 1 { format!(" {}", index + 1) } else { String::new() };
                let gains = [gains[0], gains[1], gains[2]];
                controllers.push(model(format!("{kind}{number}"), gains, scales));
            }
        }
        FlightModel { name: self.name.to_owned(), setting: self.setting, command, controllers }
    }
}

/// What every cost is computed with.
#[derive(Clone, Debug)]
pub(super) struct Bench {
    /// The full model.
    pub(super) full: LinearPlant,
    /// The short-period model.
    pub(super) short: LinearPlant,
    /// The printed rule table.
    pub(super) table: RuleTable,
}

impl Bench {
    fn plant(&self, setting: Setting) -> &LinearPlant {
        if setting == FULL_MODEL { &self.full } else { &self.short }
    }

    /// Cost of a figure's flight.
    pub(super) fn cost(&self, id: &str, model: &FlightModel, weighing: Weighing) -> Cost {
        let Ok(scenario) = model.scenario(self.plant(model.setting), &self.table) else {
            return Cost::NONE;
        };
        let Ok(flight) = simulate(&scenario) else {
            return Cost::NONE;
        };
        let metrics: Vec<FlightMetrics> = flight
            .traces
            .iter()
            .map(|trace| {
                let pushes_s = scenario.pushes_s(Noises::None);
                FlightMetrics::of(trace, &flight.edges, scenario.timing, None, &pushes_s)
            })
            .collect();
        let flights: Vec<FigureFlight<'_>> = model
            .controllers
            .iter()
            .zip(&metrics)
            .map(|(controller, metrics)| FigureFlight {
                figure: id,
                controller: &controller.name,
                metrics,
            })
            .collect();
        let diverged: f64 = flight
            .traces
            .iter()
            .filter(|trace| trace.rows() < scenario.timing.rows())
            .map(|trace| {
                DIVERGED_COST * (2.0 - trace.rows() as f64 / scenario.timing.rows() as f64)
            })
            .sum();
        if diverged > 0.0 {
            return Cost { required: diverged, preferred: 0.0 };
        }
        let misses = |preference: bool| -> f64 {
            claims_of(id, &flights)
                .filter(|claim| is_preference(claim) == preference)
                .map(|claim| residual(claim, &flights, weighing))
                .sum()
        };
        let flaws: f64 = flights
            .iter()
            .zip(&flight.traces)
            .map(|(flight, trace)| flaws(flight, trace, model.command))
            .sum();
        Cost { required: misses(false) + flaws, preferred: misses(true) }
    }
}

/// What a candidate costs: claims that have to be met with the flaws, and claims that cannot be.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Cost {
    pub(super) required: f64,
    pub(super) preferred: f64,
}

impl Cost {
    /// No flight at all.
    const NONE: Self = Self { required: f64::INFINITY, preferred: 0.0 };
    /// How much a miss of 10 % of a claim that cannot be met counts, in half units of a digit.
    const PREFERENCE: f64 = 1e-2;

    pub(super) fn total(self) -> f64 {
        self.required + Self::PREFERENCE * self.preferred
    }
}

/// The claims of a figure whose controllers are all there.
fn claims_of<'a>(
    id: &'a str,
    flights: &'a [FigureFlight<'_>],
) -> impl Iterator<Item = &'static Claim> + 'a {
    let there = move |name: &&str| flights.iter().any(|flight| flight.controller == *name);
    CLAIMS.iter().filter(move |claim| {
        let readings = readings(claim);
        // The change that F9.2 speaks of cannot be had (its percentage would outweigh the rest).
        let hopeless = claim.id == "F9.2.3";
        let flown = readings.iter().all(|r| r.controllers.iter().all(there));
        figure_of(claim) == id && flown && !hopeless
    })
}

/// Claims that yield to the others: no fixed-gain loop meets F9.2, and the FSPID of the same figure must
/// not suffer for it; and percentages, which the paper computes from numbers it rounds differently.
fn is_preference(claim: &Claim) -> bool {
    claim.id.starts_with("F9.2") || matches!(claim.source, Quantity::Percent { .. })
}

/// Square of how far a claim is missed.
fn residual(claim: &Claim, flights: &[FigureFlight<'_>], weighing: Weighing) -> f64 {
    let paper = claim.paper.value();
    let Ok(ours) = number(claim, flights) else {
        // Not risen within its window: far off, and no slope to follow but the other residuals'.
        return 1e4;
    };
    if paper == 0.0 {
        // Half of what a printed zero accepts is as good as nothing.
        return excess(ours, 0.2, 0.15);
    }
    let distance = (ours - paper).abs();
    let half_unit = claim.paper.half_unit();
    match weighing {
        Weighing::Shares if matches!(claim.source, Quantity::Percent { .. }) => 0.0,
        _ if is_preference(claim) => excess(distance, INSIDE * half_unit, 0.1 * paper),
        Weighing::Digits => excess(distance, INSIDE * half_unit, half_unit),
        Weighing::Centre => square(distance / half_unit),
        Weighing::Shares if claim.unit == "s" => square(distance / (0.05 * paper)),
        Weighing::Shares => square(distance / (0.1 * paper).max(0.5)),
    }
}

/// What the paper does not show: overshoot above 10 % that no claim speaks of, a response that has
/// not come near its command, ringing, chatter.
fn flaws(flight: &FigureFlight<'_>, trace: &Trace, command: Command) -> f64 {
    if flight.controller == "PC" {
        return 0.0;
    }
    let is_square = matches!(command, Command::Square { .. });
    let fuzzy = flight.controller.starts_with("FSPID");
    let claimed = CLAIMS.iter().any(|claim| {
        let readings = readings(claim);
        readings.iter().any(|reading| {
            reading.figure == flight.figure
                && reading.controllers.contains(&flight.controller)
                && reading.measure == Measure::Overshoot
        })
    });
    let mut cost = 0.0;
    for edge in &flight.metrics.edges {
        let downward = edge.to_rad < edge.from_rad;
        let leave = if downward { 0.02 } else { 1.0 };
        if !claimed || downward {
            cost += leave * excess(edge.step.overshoot_pct.unwrap_or(0.0), 9.0, 1.0);
        }
        cost += end_flaws(&edge.step, is_square, fuzzy);
        cost += excess(graze_s(trace, edge), 0.1, 0.05);
    }
    if !is_square {
        cost += excess(swing_pct(flight, trace), if fuzzy { 1.0 } else { 3.0 }, 0.5);
        cost += excess(flight.metrics.effort.map_or(0.0, |e| degrees(e.variation_rad)), 40.0, 20.0);
    }
    cost
}

fn end_flaws(step: &StepMetrics, is_square: bool, fuzzy: bool) -> f64 {
    let (most_pct, slowest_s) = if is_square { (8.0, 3.0) } else { (3.5, 3.0) };
    let mut cost = excess(step.final_error_pct.map_or(100.0, f64::abs), most_pct, 1.0);
    if fuzzy && !is_square {
        cost += excess(step.rise_time_s.unwrap_or(10.0), 2.0, 0.5);
    } else if !is_square {
        cost += excess(step.rise_time_s.unwrap_or(10.0), slowest_s, 0.5);
    }
    cost
}

/// How long the response takes about the 90 % level, s. A response that only grazes it has a rise time
/// that jumps by half a second for a change of the last digit: no fit to rely on.
fn graze_s(trace: &Trace, edge: &EdgeMetrics) -> f64 {
    let from = trace.time_s.partition_point(|&time| time < edge.at_s);
    let (Some(time_s), Some(response)) = (trace.time_s.get(from..), trace.theta_rad.get(from..))
    else {
        return 0.0;
    };
    let window = StepWindow { time_s, response, from: edge.from_rad, to: edge.to_rad };
    match (window.first_crossing_s(0.897), window.first_crossing_s(0.903)) {
        (Some(before), Some(after)) => after - before,
        _ => 0.0,
    }
}

/// Swing over the last quarter of the window, per cent of the step.
fn swing_pct(flight: &FigureFlight<'_>, trace: &Trace) -> f64 {
    let theta = trace.theta_rad.get(trace.rows() * 3 / 4..).unwrap_or_default();
    let highest = theta.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let lowest = theta.iter().copied().fold(f64::INFINITY, f64::min);
    let step = flight.metrics.edges.first().map_or(1.0, |edge| (edge.to_rad - edge.from_rad).abs());
    100.0 * (highest - lowest) / step
}

fn square(x: f64) -> f64 {
    x * x
}

/// How far `value` is above `most`, in `unit`s, squared.
fn excess(value: f64, most: f64, unit: f64) -> f64 {
    if value > most { square((value - most) / unit) } else { 0.0 }
}
