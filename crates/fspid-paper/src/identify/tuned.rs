//! The controllers of Fig. 7 and of the long-term change: the shared supervisor with the nominal
//! gains of Fig. 8b, and both kinds of controller tuned against each disturbance with equal effort.

use fspid_sim::signal::{Disturbance, Entry, Shape};
use fspid_sim::{NamedController, Scenario, simulate};

use super::super::disturbance::{SHAPES, START_S, flight_cost, scenario_name};
use super::super::figures::{DISTURBED, Stored, WEAKENED};
use super::super::model::{Command, ControllerModel, FlightModel, SHORT_PERIOD, Scales};
use super::Session;
use super::problem::{Bench, scales};
use super::staged::{SeedResult, Set};
use fspid_optimise::{Budget, Found, Parameter, Scale, Space, Start, search};
use fspid_scenario::units::radians;

/// Length of a disturbed flight, s.
const FLIGHT_S: f64 = 30.0;
/// Frequency of the continuous disturbance, Hz.
const FREQUENCY_HZ: f64 = 0.2;
/// Length of the abrupt disturbance, s.
const PULSE_S: f64 = 1.0;
/// Size at which controllers are tuned, degrees.
const TUNING_SIZE_DEG: f64 = 1.0;
/// Evaluations that each controller may spend on each disturbance.
const BUDGET: Budget = Budget { seed: 0, population: 30, global: 2_000, polish: 500 };
/// The long-term change: length of the flight and start of the change in half periods, length in s.
const CHANGE_FLIGHT_HALF_PERIODS: u32 = 10;
const CHANGE_AT_HALF_PERIODS: f64 = 4.0;
const CHANGE_RAMP_S: f64 = 10.0;
/// The short-period model with half of its elevator effectiveness: half the printed numerator.
const WEAK_ELEVATOR: &str =
    "numerator = [5.8652, 11.289]\ndenominator = [1.0, 4.9676, 12.941, 0.0]\n";

/// The shared supervisor and the nominal gains of Fig. 8b.
#[derive(Clone, Debug)]
pub(super) struct Base {
    gains: [f64; 3],
    half_period_s: f64,
    scales: Scales,
    found: SeedResult,
}

impl Base {
    pub(super) fn of(set: &Set<'_>, found: &SeedResult) -> Self {
        let part = set
            .figures
            .iter()
            .zip(set.parts(&found.point))
            .find_map(|(figure, part)| (figure.id == "8b").then_some(part));
        let (gains, half_period_s) = match part {
            Some(&[kp, ki, kd, half, ..]) => ([kp, ki, kd], super::super::model::on_grid(half)),
            _ => ([0.0; 3], 1.0),
        };
        Self { gains, half_period_s, scales: scales(&found.point), found: found.clone() }
    }

    fn pair(&self) -> Vec<ControllerModel> {
        vec![
            controller("CPID", self.gains, None),
            controller("FSPID", self.gains, Some(self.scales)),
        ]
    }
}

fn controller(name: &str, gains: [f64; 3], scales: Option<Scales>) -> ControllerModel {
    ControllerModel { name: name.to_owned(), gains, rate_gain: 0.0, scales }
}

fn shape(name: &str) -> Shape {
    match name {
        "continuous" => Shape::Sine { at_s: START_S, frequency_hz: FREQUENCY_HZ },
        _ => Shape::Pulse { at_s: START_S, width_s: PULSE_S },
    }
}

fn disturbance_toml(shape: &str, entry: &str) -> String {
    let kind = match shape {
        "continuous" => format!("kind = \"sine\"\nfrequency_hz = {FREQUENCY_HZ:?}"),
        _ => format!("kind = \"pulse\"\nwidth_s = {PULSE_S:?}"),
    };
    format!(
        "\n[[disturbance]]\n{kind}\nenters_at = \"{entry}\"\nat_s = {START_S:?}\n\
         amplitude_deg = {TUNING_SIZE_DEG:?}\n"
    )
}

/// A flight at rest under one disturbance.
fn disturbed(
    bench: &Bench,
    model: &FlightModel,
    shape_name: &str,
    entry: Entry,
) -> Option<Scenario> {
    let mut scenario = model.scenario(&bench.short, &bench.table).ok()?;
    let size_rad = radians(TUNING_SIZE_DEG);
    scenario.disturbances = vec![Disturbance::new(entry, size_rad, shape(shape_name)).ok()?];
    Some(scenario)
}

fn at_rest(name: String, controllers: Vec<ControllerModel>) -> FlightModel {
    let command = Command::Rest { window_s: FLIGHT_S };
    FlightModel { name, setting: SHORT_PERIOD, command, controllers }
}

/// Cost of one controller under one disturbance; infinite where the flight has none.
fn cost(bench: &Bench, model: ControllerModel, shape_name: &str, entry: Entry) -> f64 {
    let fixed = model.scales.is_none();
    let model = at_rest(String::new(), vec![model]);
    let Some(scenario) = disturbed(bench, &model, shape_name, entry) else {
        return f64::INFINITY;
    };
    let Some(NamedController { controller, .. }) = scenario.controllers.first() else {
        return f64::INFINITY;
    };
    let unstable = fixed
        && fspid_sim::stability::instability(&scenario, controller).map_or(true, |u| u.is_some());
    if unstable {
        return f64::INFINITY;
    }
    let Ok(flight) = simulate(&scenario) else {
        return f64::INFINITY;
    };
    match flight.traces.first() {
        Some(trace) if trace.rows() == scenario.timing.rows() => {
            flight_cost(trace, TUNING_SIZE_DEG)
        }
        _ => f64::INFINITY,
    }
}

impl Session<'_> {
    /// The scenarios of Fig. 7.
    pub(super) fn disturbances(&mut self, base: &Base) -> Vec<Stored> {
        let mut files = Vec::new();
        for shape_name in SHAPES {
            for entry in Entry::ALL {
                let fixed = self.tune(base, shape_name, entry, false);
                let fuzzy = self.tune(base, shape_name, entry, true);
                let mut controllers = base.pair();
                let at = entry.name();
                controllers.push(controller("CPID tuned", gains(&fixed.point), None));
                let tuned_scales = fuzzy.point.get(3..).map(scales);
                controllers.push(controller("FSPID tuned", gains(&fuzzy.point), tuned_scales));
                let name = format!("Fig. 7: {shape_name} disturbance at the {at}");
                let model = at_rest(name, controllers);
                let what = format!(
                    "Fig. 7, {shape_name} disturbance at the {at}: CPID and FSPID as shared \
                     by Figs 8 and 9 (gains of Fig. 8b), and both tuned with {} evaluations each.",
                    BUDGET.global + BUDGET.polish
                );
                let heading = self.heading(&what, &base.found, DISTURBED);
                let text = model.toml(&heading) + &disturbance_toml(shape_name, at);
                files.push(Stored { name: scenario_name(shape_name, at), text });
            }
        }
        files
    }

    fn tune(&mut self, base: &Base, shape_name: &str, entry: Entry, fuzzy: bool) -> Found {
        let log = |name, lower, upper| Parameter { name, lower, upper, scale: Scale::Logarithmic };
        let mut parameters =
            vec![log("kp", 0.05, 10.0), log("ki", 1e-3, 10.0), log("kd", 1e-3, 3.0)];
        let mut about = base.gains.to_vec();
        if fuzzy {
            // Wide enough for a supervisor that has next to nothing to say: the CPID is within reach.
            parameters.extend([
                log("error_scale", 0.1, 100.0),
                log("change_scale", 0.1, 100.0),
                log("output_scale kp", 1e-5, 1.0),
                log("output_scale ki", 1e-5, 1.0),
                log("output_scale kd", 1e-5, 1.0),
            ]);
            let Scales { error, change, output } = base.scales;
            about.extend([error, change]);
            about.extend(output);
        }
        let space = Space::new(parameters);
        let budget = Budget { seed: self.options.seed, ..BUDGET };
        // Both begin from what was identified, spread over much of the box.
        let found = search(&space, budget, Start::About(&about, 0.3), 0.0, |point| {
            let tuned_scales = point.get(3..).filter(|rest| !rest.is_empty()).map(scales);
            cost(self.bench, controller("", gains(point), tuned_scales), shape_name, entry)
        });
        let kind = if fuzzy { "FSPID" } else { "CPID" };
        let name = format!("Fig. 7, {kind} tuned, {shape_name} at the {}", entry.name());
        let run = SeedResult {
            seed: budget.seed,
            attempts: 1,
            evaluations: found.evaluations,
            cost: found.cost,
            point: found.point.clone(),
        };
        self.keep(&name, &space, vec![run]);
        found
    }

    /// The flight of claim S2: the elevator loses half of its effectiveness.
    pub(super) fn long_term_change(&self, base: &Base) -> Stored {
        let model = FlightModel {
            name: "S2: the elevator loses half of its effectiveness".to_owned(),
            setting: SHORT_PERIOD,
            command: Command::Square {
                half_period_s: base.half_period_s,
                half_periods: CHANGE_FLIGHT_HALF_PERIODS,
            },
            controllers: base.pair(),
        };
        let what = "Claim S2: CPID and FSPID as shared by Figs 8 and 9 (gains of Fig. 8b), while the \
                    elevator loses half of its effectiveness.";
        let heading = self.heading(what, &base.found, WEAKENED);
        let change = format!(
            "\n[[plant_change]]\nat_s = {:?}\nramp_s = {CHANGE_RAMP_S:?}\n{WEAK_ELEVATOR}",
            CHANGE_AT_HALF_PERIODS * base.half_period_s
        );
        let text = model.toml(&heading) + &change;
        Stored { name: "long-term-change.toml".to_owned(), text }
    }
}

fn gains(point: &[f64]) -> [f64; 3] {
    match *point {
        [kp, ki, kd, ..] => [kp, ki, kd],
        _ => [0.0; 3],
    }
}
