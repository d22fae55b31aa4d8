//! Slopes of merits against differences of exact scores.

use super::*;
use crate::crew::Crew;
use crate::source::Source;

const SCENARIO: &str = r#"schema = 1
name = "to be learned"

[aircraft]
name = "navion"
airspeed_ft_s = 176.0
altitude_ft = 0.0
model = "linear"

[actuator]
time_constant_s = 0.1
position_limit_deg = 20.0
rate_limit_deg_s = 37.0
delay_samples = 1

[sensor]
preset = "ideal"
pitch = { noise_deg_rt_hz = 0.003 }
rate = { noise_deg_s_rt_hz = 0.007 }

[loop]
sample_period_s = 0.01
duration_s = 6.0

[setpoint]
kind = "step"
amplitude_deg = 5.0
at_s = 1.0

[[controller]]
name = "FSPID"
kind = "fspid"
nominal.kp = { tune = [0.2, 4.0], scale = "log", start = 1.2 }
nominal.ki = { tune = [0.2, 4.0], scale = "log", start = 1.1 }
nominal.kd = 0.005
rate_gain = { tune = [0.01, 1.0], start = 0.1 }
setpoint_weights = { proportional = { tune = [0.0, 1.3], start = 0.9 } }
derivative_filter_s = { tune = [0.01, 0.5], scale = "log", start = 0.05 }
output_limits_deg = [-20.0, 20.0]
law = "accumulating"
leakage_per_s = { tune = [0.01, 5.0], scale = "log", start = 0.8 }
supervisor.range = 1.0
supervisor.second_input = "error-and-model-error"
supervisor.model = { bandwidth_rad_s = { tune = [0.2, 6.0], scale = "log", start = 1.4 }, damping = 1.0 }
supervisor.error_scale = { tune = [0.02, 5.0], scale = "log", start = 0.3 }
supervisor.change_scale = 0.6
supervisor.error_set_centres = [{ tune = [0.02, 0.49], start = 0.3 }, 0.7]
supervisor.output_scale.kp = { tune = [0.0, 2.0], start = 0.6 }
supervisor.output_scale.ki = 0.5
supervisor.output_scale.kd = 0.005
supervisor.numbers.delta_kp = { tune = "numbers", reach = 0.4, symmetric = true, start = GRID }
supervisor.numbers.delta_ki = GRID
supervisor.numbers.delta_kd = GRID
REQUIRED
[tuning]
over = "tail"
share = 0.75
constant_load = "ignored"

[[tuning.case]]
name = "slow"
set = ["aircraft.airspeed_ft_s=140"]

[[tuning.case]]
name = "as it is"
set = []
weight = 0.5

[[tuning.case]]
name = "rough"
set = ["turbulence.intensity=moderate", "turbulence.seed=11"]

[[tuning.objective]]
measure = "iae_deg_s"

[[tuning.objective]]
measure = "itae_deg_s2"
weight = 0.02

[[tuning.objective]]
measure = "rms_error_deg"
weight = 0.5

[[tuning.objective]]
measure = "elevator_travel_deg"
weight = 0.1

[[tuning.objective]]
measure = "command_variation_deg"
weight = 0.02

[[tuning.limit]]
measure = "elevator_travel_deg"
most = 5.0
"#;

/// Asked of the flights: broken at the start, but for the last three, which have nothing to follow: one is met, one is
/// broken by more than the violation counts, and one is broken by the same whatever is flown, but for the case in rough air.
const OF_FLIGHTS: &str = r#"
[[requirement]]
measure = "overshoot_pct"
most = 10.0

[[requirement]]
measure = "largest_error_deg"
most = 4.0

[[requirement]]
measure = "largest_command_deg"
most = 50.0

[[requirement]]
measure = "rms_error_deg"
most = 0.1

[[requirement]]
measure = "rms_error_deg"
air = "turbulent"
most = 1.0
"#;

const OF_THE_LOOP: &str = r#"
[[requirement]]
measure = "sensitivity_peak"
most = 1.05
"#;

fn problem(required: &str, changes: &[(&str, &str)]) -> Result<TuningProblem, TuneError> {
    problem_of(&[], required, changes)
}

/// The same with other changes before the grid and what is required are filled in.
fn problem_of(
    before: &[(&str, &str)],
    required: &str,
    changes: &[(&str, &str)],
) -> Result<TuningProblem, TuneError> {
    let grid = (0..7).map(|i| {
        let row = (0..7).map(|j: i32| format!("{:.2}", f64::from((i - 3) * (j - 3)) / 18.0));
        format!("[{}]", row.collect::<Vec<_>>().join(","))
    });
    let grid = format!("[{}]", grid.collect::<Vec<_>>().join(","));
    let text = before.iter().fold(SCENARIO.to_owned(), |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    });
    let text = text.replace("GRID", &grid).replace("REQUIRED", required);
    let text = changes.iter().fold(text, |text, (from, to)| {
        assert!(text.contains(from), "{from}");
        text.replace(from, to)
    });
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("learned.toml");
    std::fs::write(&path, text).expect("written");
    TuningProblem::new(&Source { path, overrides: Vec::new() }, None)
}

fn merit(slopes: &Differentiable<'_>, point: &[f64], penalty: f64) -> Merit {
    let flights = slopes.problem.flights_of(&[point.to_vec()], Crew::UNSTOPPED).expect("flown");
    slopes.merit(&flights[0], penalty)
}

/// Compares the slope at the start with differences of exact scores, coordinate by coordinate; the analyses it took.
fn compare(problem: &TuningProblem, step: f64, tolerance: f64) -> usize {
    const PENALTY: f64 = 30.0;
    let slopes = Differentiable::new(problem, "bfgs").expect("it has slopes");
    let start = problem.space().start();
    let here = merit(&slopes, &start, PENALTY);
    assert!(here.value.is_finite() && here.violation > 0.0, "{here:?}");
    let found = slopes.slope(&start, &here.weights).expect("a slope");
    let size = found.slope.iter().fold(0.0_f64, |most, it| most.max(it.abs()));
    for (coordinate, slope) in found.slope.iter().enumerate() {
        // Cells of a grid are rounded to a few digits.
        let is_cell = problem.space().names()[coordinate].contains('[')
            && problem.space().names()[coordinate].contains("numbers");
        let by = if is_cell { 100.0 * step } else { step };
        let at = |by: f64| {
            let mut moved = start.clone();
            moved[coordinate] += by;
            merit(&slopes, &moved, PENALTY).value
        };
        let difference = (at(by) - at(-by)) / (2.0 * by);
        assert!(
            (slope - difference).abs() < tolerance * size,
            "{}: {slope} by the way back, {difference} by differences; the largest {size}",
            problem.space().names()[coordinate]
        );
    }
    found.analyses
}

#[test]
fn slopes_of_costs_limits_and_requirements_of_flights_are_those_of_differences() {
    let problem = problem(OF_FLIGHTS, &[]).expect("a tuning");
    assert_eq!(compare(&problem, 1e-5, 2e-3), 0, "no loop is asked");
}

/// Free weights in the place of rules.
fn network() -> String {
    let rows = ["error", "change", "offset", "delta_kp", "delta_ki", "delta_kd"];
    let rows = rows.iter().zip([1.5, -1.1, 0.9, 0.7, -0.6, 0.5]).map(|(row, first)| {
        let weight = |unit: u32| {
            let start =
                f64::from(unit + 1) * first * if unit.is_multiple_of(2) { 0.4 } else { -0.3 };
            format!("{{ tune = [-6.0, 6.0], start = {start:.3} }}")
        };
        let weights: Vec<String> = (0..8).map(weight).collect();
        format!("supervisor.network.{row} = [{}]\n", weights.join(", "))
    });
    rows.collect()
}

#[test]
fn slopes_of_the_weights_of_a_network_are_those_of_differences() {
    let rules = "supervisor.numbers.delta_kp = { tune = \"numbers\", reach = 0.4, symmetric = true, start = GRID }
supervisor.numbers.delta_ki = GRID
supervisor.numbers.delta_kd = GRID
";
    let sets = "supervisor.error_set_centres = [{ tune = [0.02, 0.49], start = 0.3 }, 0.7]\n";
    let changes = [(rules, network()), (sets, String::new())];
    let changes = changes.each_ref().map(|(from, to)| (*from, to.as_str()));
    let problem = problem_of(&changes, OF_FLIGHTS, &[]).expect("a tuning");
    assert_eq!(compare(&problem, 1e-5, 2e-3), 0, "no loop is asked");
}

#[test]
fn slopes_of_what_the_linear_loop_breaks_are_those_of_differences() {
    // With another weight gains move what is held, to either side by as much: where the worse side changes there is no slope.
    let weight = "{ proportional = { tune = [0.0, 1.3], start = 0.9 } }";
    let problem =
        problem_of(&[(weight, "{ proportional = 1.0 }")], OF_THE_LOOP, &[]).expect("a tuning");
    let coordinates = problem.space().dimension();
    assert_eq!(compare(&problem, 1e-4, 1e-2), 3 * (coordinates + 1), "three loops are asked");
}

#[test]
fn what_has_no_slope_is_refused_by_name_before_anything_is_searched() {
    let told = |required: &str, changes: &[(&str, &str)]| {
        let problem = problem(required, changes).unwrap_or_else(|it| panic!("{it}"));
        Differentiable::new(&problem, "bfgs").expect_err("it is refused").to_string()
    };
    let settling = "\n[[requirement]]\nmeasure = \"settling_time_s\"\nmost = 4.0\n";
    assert!(told(settling, &[]).contains("requirement settling_time_s"), "{}", told(settling, &[]));
    let lag = ("time_constant_s = 0.1", "time_constant_s = { tune = [0.05, 0.2] }");
    assert!(told("", &[lag]).contains("actuator.time_constant_s"), "{}", told("", &[lag]));
    let steps = ("noise_deg_rt_hz = 0.003", "resolution_deg = 0.01");
    let told_of_steps = told("", &[steps]);
    assert!(told_of_steps.contains("a sensor with a resolution"), "{told_of_steps}");
    assert!(told_of_steps.contains("case \"slow\""), "{told_of_steps}");
    let high = ("altitude_ft = 0.0", "altitude_ft = 1000.0");
    let nonlinear = [high, ("model = \"linear\"", "model = \"nonlinear\"")];
    assert!(told("", &nonlinear).contains("a nonlinear aircraft"), "{}", told("", &nonlinear));
}

/// Compares every row at the start with differences of the rows at its sides.
fn compare_rows(problem: &TuningProblem, step: f64, tolerance: f64) -> Vec<rows::Which> {
    let slopes = Differentiable::new(problem, "sqp").expect("it has slopes");
    let rows_at = |point: &[f64]| {
        let flights = problem.flights_of(&[point.to_vec()], Crew::UNSTOPPED).expect("flown");
        let weights = slopes.merit(&flights[0], 0.0).weights;
        let cost = slopes.merit(&flights[0], 0.0).value;
        (cost, slopes.rows(point, &flights[0], &weights).expect("rows"))
    };
    let start = problem.space().start();
    let (_, here) = rows_at(&start);
    let sides = |coordinate: usize, by: f64| {
        let mut moved = start.clone();
        moved[coordinate] += by;
        rows_at(&moved)
    };
    for coordinate in (0..start.len()).step_by(5) {
        let is_cell = problem.space().names()[coordinate].contains("numbers");
        let by = if is_cell { 100.0 * step } else { step };
        let (above, below) = (sides(coordinate, by), sides(coordinate, -by));
        let check = |slope: &[f64], above: f64, below: f64| {
            let size = slope.iter().fold(0.0_f64, |most, it| most.max(it.abs()));
            let difference = (above - below) / (2.0 * by);
            let (found, name) = (slope[coordinate], &problem.space().names()[coordinate]);
            assert!(
                (found - difference).abs() < tolerance * size,
                "{name}: {found} by the way back, {difference} by differences; the largest {size}"
            );
        };
        check(&here.cost, above.0, below.0);
        for row in &here.limits {
            let of = |rows: &rows::Rows| {
                let same = rows.limits.iter().find(|it| it.of == row.of);
                same.expect("the same limit").excess
            };
            check(&row.slope, of(&above.1), of(&below.1));
        }
    }
    here.limits.iter().map(|it| it.of).collect()
}

#[test]
fn slopes_of_each_limit_of_flights_and_means_are_those_of_differences() {
    let problem = problem(OF_FLIGHTS, &[]).expect("a tuning");
    let found = compare_rows(&problem, 1e-5, 2e-3);
    assert_eq!(found[0], rows::Which::Mean(0), "{found:?}");
    let of_flights = |it: &&rows::Which| matches!(it, rows::Which::Flight(..));
    assert!(found.iter().filter(of_flights).count() >= 6, "{found:?}");
}

#[test]
fn slopes_of_each_limit_of_linear_loops_are_those_of_differences() {
    let problem = problem(OF_THE_LOOP, &[]).expect("a tuning");
    let found = compare_rows(&problem, 1e-4, 2e-2);
    let of_loops = |it: &&rows::Which| matches!(it, rows::Which::Loop(..));
    assert_eq!(found.iter().filter(of_loops).count(), 3, "{found:?}");
}
