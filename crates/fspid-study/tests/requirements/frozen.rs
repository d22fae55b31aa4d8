//! Margins of gains that are frozen: those of the map, of numbers and beyond both.

use fspid_scenario::measure::Measure;
use fspid_sim::Doubt;
use fspid_study::analysis::{Analysis, Margins, Question};
use fspid_study::judgement::{Judgement, NotEvaluated};
use fspid_study::metrics::Absent;

use crate::requirements::{JUMBO, of, one, study, values, verified, written};

#[test]
fn the_frozen_margins_are_the_least_of_the_map() {
    let analysis = Analysis::of(&study(JUMBO, &[]), Question::default()).expect("it is analysed");
    let map = analysis.loops[1].plants[0].map().expect("it tunes itself");
    let least = |of: fn(&Margins) -> f64| {
        let points = map.points.iter().chain([&map.worst]);
        points.map(|p| of(&p.margins.expect("stable"))).fold(f64::INFINITY, f64::min)
    };
    let ours = |measure| values(JUMBO, measure, "controller = \"FSPID\"", &[])[0];
    assert_eq!(ours(Measure::FrozenPhaseMargin), least(|m| m.phase_margin_deg));
    assert_eq!(ours(Measure::FrozenDiskMargin), least(|m| m.disk_margin));
    assert_eq!(ours(Measure::FrozenGainMargin), least(Margins::smaller_gain_margin_db));
    let disk = of("FSPID", "measure = \"frozen_disk_margin\"\nleast = 0.0", &[]);
    let points = || map.points.iter().chain([&map.worst]).filter_map(|it| it.margins.ok());
    let at = points().min_by(|one, other| one.disk_margin.total_cmp(&other.disk_margin));
    assert_eq!(disk.place().frequency_rad_s, at.map(|it| it.disk_rad_s));
    assert!(ours(Measure::FrozenPhaseMargin) <= values(JUMBO, Measure::PhaseMargin, "", &[])[1]);
    // Fixed gains are frozen as they are.
    let fixed = |measure| values(JUMBO, measure, "controller = \"P\"", &[])[0];
    assert_eq!(fixed(Measure::FrozenPhaseMargin), fixed(Measure::PhaseMargin));
}

#[test]
fn gains_that_drift_at_rest_have_no_margins_but_a_flight() {
    let text = JUMBO
        .replace("law = \"memoryless\"", "law = \"accumulating\"")
        .replace("table = \"mirrored\"", "table = \"printed\"");
    let of = |requirement: &str| one(&text, &format!("{requirement}\ncontroller = \"FSPID\""), &[]);
    let margin = of("measure = \"phase_margin_deg\"\nleast = 0.0");
    assert_eq!(margin.found, Err(NotEvaluated::Absent(Absent::Undecided(Doubt::DriftingGains))));
    let frozen = of("measure = \"frozen_disk_margin\"\nleast = 0.0");
    assert!(matches!(frozen.found, Err(NotEvaluated::BeyondMap { .. })), "{frozen:?}");
    assert!(of("measure = \"largest_error_deg\"\nmost = 99.0").met);
}

#[test]
fn frozen_gains_that_do_not_hold_the_plant_are_told_with_the_inputs_that_give_them() {
    let wild = [
        "controller.FSPID.supervisor.output_scale.kp=2.0",
        "controller.FSPID.supervisor.output_scale.ki=1.0",
        "controller.FSPID.supervisor.output_scale.kd=1.0",
    ];
    let stable = of("FSPID", "measure = \"frozen_stable\"", &wild);
    assert!(!stable.met && stable.value_in_words() == "unstable");
    let place = stable.place();
    assert!(place.spectral_radius.expect("told") >= 1.0 && place.frozen.is_some(), "{place}");
    let margin = of("FSPID", "measure = \"frozen_disk_margin\"\nleast = 0.0", &wild);
    assert!(!margin.met);
    let Err(NotEvaluated::Unstable { place, .. }) = margin.found else { panic!("{margin:?}") };
    assert_eq!(place.frozen, stable.place().frozen);
}

/// An input that is evaluated beyond the range lies beyond the map: no margin of the map is then one of all gains.
#[test]
fn gains_beyond_the_map_have_no_frozen_margins() {
    let text = JUMBO.replace("range = 5.0", "range = 5.0\nout_of_range = \"evaluate\"");
    for measure in ["frozen_stable", "frozen_disk_margin"] {
        let limit = if measure == "frozen_stable" { "" } else { "least = 0.0" };
        let requirement = format!("measure = \"{measure}\"\n{limit}\ncontroller = \"FSPID\"");
        let judgement = one(&text, &requirement, &[]);
        assert!(!judgement.met);
        assert!(matches!(judgement.found, Err(NotEvaluated::BeyondMap { .. })), "{judgement:?}");
    }
    let at_rest = one(&text, "measure = \"disk_margin\"\nleast = 0.0\ncontroller = \"FSPID\"", &[]);
    assert!(at_rest.met, "{at_rest:?}");
}

/// Under the accumulating law the worst is that of all gains that the law may come to.
#[test]
fn frozen_margins_of_an_accumulating_law_are_the_least_of_what_it_may_come_to() {
    let leaking = "law = \"accumulating\"\nleakage_per_s = 0.5";
    let text = JUMBO.replace("law = \"memoryless\"", leaking);
    let question = Question { every_point_in_full: true, ..Question::default() };
    let analysis = Analysis::of(&study(&text, &[]), question).expect("it is analysed");
    let reach = analysis.loops[1].plants[0].reach().expect("leakage bounds the gains");
    for (measure, of) in [
        ("disk_margin", (|m| m.disk_margin) as fn(&Margins) -> f64),
        ("phase_margin_deg", |m| m.phase_margin_deg),
        ("gain_margin_db", Margins::smaller_gain_margin_db),
    ] {
        let requirement =
            format!("measure = \"frozen_{measure}\"\nleast = 0.1\ncontroller = \"FSPID\"");
        let judgement = one(&text, &requirement, &[]);
        let least = reach.all().map(|it| of(&it.margins.expect("stable")));
        let least = least.fold(f64::INFINITY, f64::min);
        assert_eq!(judgement.found.as_ref().expect("stable").value, least, "{measure}");
        let at = judgement.place().frozen.expect("it is told");
        let [kp, ki, kd] = [at.gains.kp, at.gains.ki, at.gains.kd];
        assert_eq!(fixed(&text, measure, [kp, ki, kd]), least, "{measure}: {at:?}");
    }
    let stable = one(&text, "measure = \"frozen_stable\"\ncontroller = \"FSPID\"", &[]);
    assert!(stable.met, "{stable:?}");
    let wild = ["controller.FSPID.supervisor.output_scale.kp=1.0"];
    let unstable = one(&text, "measure = \"frozen_stable\"\ncontroller = \"FSPID\"", &wild);
    assert!(!unstable.met && unstable.value_in_words() == "unstable", "{unstable:?}");
}

/// Grids with numbers for the three gains at some cells, and 0 at the others.
fn with_cells(text: &str, cells: &[([usize; 2], [f64; 3])]) -> String {
    let grid = |gain: usize| {
        let cell = |row: usize, column: usize| {
            let own = cells.iter().find(|(at, _)| *at == [row, column]);
            format!("{:?}", own.map_or(0.0, |(_, numbers)| numbers[gain]))
        };
        let row = |row| format!("[{}]", [0, 1, 2, 3, 4, 5, 6].map(|it| cell(row, it)).join(", "));
        format!("[{}]", [0, 1, 2, 3, 4, 5, 6].map(row).join(", "))
    };
    let [kp, ki, kd] = [0, 1, 2].map(grid);
    let numbers = format!("numbers = {{ delta_kp = {kp}, delta_ki = {ki}, delta_kd = {kd} }} #");
    text.replace("table = ", &numbers)
}

/// What is found for fixed gains in place of the self-tuning ones, with the same filter of the derivative.
fn fixed(text: &str, measure: &str, [kp, ki, kd]: [f64; 3]) -> f64 {
    let filter = text.lines().find(|line| line.starts_with("derivative_filter_s"));
    let filter = filter.unwrap_or_default();
    let gains = format!("kp = {kp:?}\nki = {ki:?}\nkd = {kd:?}\n{filter}");
    let text = text.replacen("kp = 1.0", &gains, 1);
    let requirement = format!("measure = \"{measure}\"\nleast = 0.0\ncontroller = \"P\"");
    one(&text, &requirement, &[]).found.expect("stable").value
}

#[test]
fn numbers_are_level_beyond_the_range_so_that_their_map_is_whole() {
    // The corner of the greatest error and change adds 5 * 0.1 to kp.
    let clamping = with_cells(JUMBO, &[([6, 6], [5.0, 0.0, 0.0])]);
    let evaluating = clamping.replace("range = 5.0", "range = 5.0\nout_of_range = \"evaluate\"");
    let requirement = "measure = \"frozen_disk_margin\"\nleast = 0.0\ncontroller = \"FSPID\"";
    let frozen = |text: &str| one(text, requirement, &[]);
    let value = |judgement: &Judgement| judgement.found.as_ref().expect("found").value;
    assert!(frozen(&evaluating).met);
    assert_eq!(value(&frozen(&evaluating)), value(&frozen(&clamping)));
    // Two ways to the margins, the family's and that of the eigenvalues.
    let [at_rest, corner] = [1.33, 1.83].map(|kp| fixed(JUMBO, "disk_margin", [kp, 1.0, 1.22]));
    assert!((at_rest - corner).abs() > 1e-3, "{at_rest} {corner}");
    assert!((value(&frozen(&evaluating)) - at_rest.min(corner)).abs() < 1e-9, "{corner}");
}

/// The cell with the least disk margin need not have the least gain margin, nor the least phase margin: every
/// measure asks for its own worst.
#[test]
fn frozen_margins_of_numbers_are_no_better_than_those_of_any_of_their_cells() {
    let text = JUMBO
        .replace("b747-paper", "navion-full")
        .replace("time_constant_s = 0.1", "time_constant_s = 0.05")
        .replace("derivative_filter_s = 0.05", "")
        .replace("{ kp = 1.33, ki = 1.0, kd = 1.22 }", "{ kp = 1.0, ki = 1.0, kd = 0.1 }")
        .replace("{ kp = 0.1, ki = 0.05, kd = 0.05 }", "{ kp = 1.0, ki = 1.0, kd = 1.0 }");
    // The first of each pair is the worst by its disk margin in one case, the second in the other.
    for [first, second] in
        [[[0.82, 5.0, 0.165], [3.0, 2.0, 0.0]], [[0.85, 4.8, 0.165], [3.0, 2.0, 0.0]]]
    {
        let added = |[kp, ki, kd]: [f64; 3]| [kp - 1.0, ki - 1.0, kd - 0.1];
        let numbers = with_cells(&text, &[([1, 1], added(first)), ([5, 1], added(second))]);
        for measure in ["gain_margin_db", "phase_margin_deg", "disk_margin"] {
            let requirement =
                format!("measure = \"frozen_{measure}\"\nleast = 6.0\ncontroller = \"FSPID\"");
            let judgement = one(&numbers, &requirement, &[]);
            let found = judgement.found.as_ref().expect("stable").value;
            let least = [first, second].map(|gains| fixed(&text, measure, gains));
            assert!(found <= least[0].min(least[1]) + 1e-9, "{measure}: {found} {least:?}");
            if measure == "gain_margin_db" {
                // That of (3, 2, 0), by `analyse` of these gains as fixed ones.
                assert!(!judgement.met && (found - 3.8813).abs() < 1e-4, "{judgement:?}");
                let place = judgement.place().frozen.expect("it is told");
                assert!((place.gains.kp - 3.0).abs() < 1e-9, "{place:?}");
            }
        }
    }
}

#[test]
fn the_answer_says_that_the_cells_of_numbers_are_among_the_frozen_gains() {
    let told = |text: &str| {
        let requirement = "[[requirement]]\nmeasure = \"frozen_stable\"\n";
        let (_folder, path) = written(&format!("{text}\n{requirement}"));
        let text = verified(&path, &[], &[]).text(None);
        text.split_whitespace().collect::<Vec<_>>().join(" ")
    };
    let cells = "the 49 cells where rules conclude numbers";
    assert!(told(&with_cells(JUMBO, &[])).contains(cells));
    assert!(!told(JUMBO).contains("49 cells"));
    let reach = "of an accumulating law those that it may come to";
    let leaking = "law = \"accumulating\"\nleakage_per_s = 0.5";
    assert!(told(&JUMBO.replace("law = \"memoryless\"", leaking)).contains(reach));
    assert!(!told(JUMBO).contains(reach));
}
