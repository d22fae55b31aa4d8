//! The supervisor and its exponential against high-precision values made by `oracles/`.

#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

use fspid_fuzzy::{Defuzzifier, LABEL_COUNT, Label, OutOfRange, Output, RuleTable, Supervisor};

/// Half the span times the rounding of a sum of a thousand samples.
const TOLERANCE: f64 = 1e-12;

const PRINTED: &str = include_str!("../../../data/rule-tables/printed.toml");
const MIRRORED: &str = include_str!("../../../data/rule-tables/mirrored.toml");

/// The three grids of a rule-table file: the texts between triple quotes.
fn table(file: &str) -> RuleTable {
    let parts: Vec<&str> = file.split("\"\"\"").collect();
    RuleTable::parse([parts[1], parts[3], parts[5]]).expect("a shipped table")
}

fn supervisor(file: &str, range: f64, rule: &str, out_of_range: OutOfRange) -> Supervisor<f64> {
    let rule = rule.parse().expect("a known rule");
    Supervisor::new(&table(file), range, rule, out_of_range).expect("allowed")
}

/// Rows of a reference file as columns by name.
fn rows(text: &str) -> (Vec<&str>, impl Iterator<Item = Vec<&str>>) {
    let mut lines = text.lines();
    let header = lines.next().expect("a header").split(',').collect();
    (header, lines.map(|line| line.split(',').collect()))
}

#[test]
fn the_supervisor_agrees_with_forty_digit_polygons_under_every_rule() {
    let (header, rows) = rows(include_str!("data/supervisor.csv"));
    let mut compared = 0;
    for row in rows {
        let number = |index: usize| row[index].parse::<f64>().expect("a number");
        let file = if row[0] == "printed" { PRINTED } else { MIRRORED };
        let (range, error, change) = (number(1), number(3), number(4));
        for (name, rule) in [
            ("exact", "exact"),
            ("endpoints101", "endpoints:101"),
            ("midpoint100", "midpoint:100"),
            ("midpoint1000", "midpoint:1000"),
            ("trapezoid101", "trapezoid:101"),
        ] {
            let answer = supervisor(file, range, rule, OutOfRange::Evaluate)
                .infer(error, change)
                .expect("finite inputs")
                .delta;
            for (gain, ours) in [("dkp", answer.kp), ("dki", answer.ki), ("dkd", answer.kd)] {
                let column = header.iter().position(|h| *h == format!("{gain}_{name}"));
                let theirs = number(column.expect("a column for each gain and rule"));
                let tolerance = TOLERANCE * range / 5.0;
                assert!((ours - theirs).abs() <= tolerance, "{row:?} {gain} {name}: {ours}");
                compared += 1;
            }
        }
    }
    assert_eq!(compared, 670 * 15);
}

#[test]
fn the_supervisor_answers_the_handbook_s_spot_values() {
    let supervisor = supervisor(PRINTED, 5.0, "exact", OutOfRange::Error);
    for (error, change, kp, ki, kd) in [
        (0.0, 0.0, 0.216_500_696_638, 0.0, -1.666_610_153_842),
        (5.0, 5.0, -4.234_089_847_555, 4.444_274_913_314, 3.902_748_775_224),
        (-5.0, -5.0, 4.444_385_106_649, -4.444_274_913_314, 1.020_352_034_411),
        (5.0, -5.0, -0.144_014_896_878, 0.0, 3.188_836_309_895),
        (1.0, -2.0, 0.995_958_158_631, -0.608_034_418_811, -0.642_500_373_380),
        (-3.3, 0.7, 1.628_328_059_925, -1.628_352_085_306, -3.151_303_923_865),
    ] {
        let delta = supervisor.infer(error, change).expect("inside").delta;
        // Half a unit of the last printed digit.
        for (ours, theirs) in [(delta.kp, kp), (delta.ki, ki), (delta.kd, kd)] {
            assert!((ours - theirs).abs() < 6e-13, "{error} {change}: {ours} {theirs}");
        }
    }
}

#[test]
fn a_clamped_input_answers_as_the_end_of_the_range_and_says_so() {
    let clamping = supervisor(PRINTED, 5.0, "exact", OutOfRange::Clamp);
    for (error, change) in [(7.0, 1.0), (-1e300, 2.0), (0.0, -5.000001)] {
        let outside = clamping.infer(error, change).expect("clamped");
        let ends = clamping.infer(error.clamp(-5.0, 5.0), change.clamp(-5.0, 5.0));
        assert_eq!(outside.delta, ends.expect("inside").delta);
        assert!(outside.clamped && !outside.underflowed);
    }
    assert!(!clamping.infer(5.0, -5.0).expect("on the edge").clamped);
}

#[test]
fn an_evaluated_input_far_outside_answers_as_clamped_and_never_zero_by_zero() {
    let evaluating = supervisor(PRINTED, 5.0, "exact", OutOfRange::Evaluate);
    for error in [6.0, 20.0, 31.0, 32.4, 40.0, 1e6, 1e300, f64::MAX] {
        for sign in [1.0, -1.0] {
            let answer = evaluating.infer(sign * error, 1.0).expect("finite");
            assert!(answer.delta.kp.is_finite() && answer.delta.ki.is_finite());
            assert_eq!(answer.underflowed, error > 31.9, "{error}");
            if answer.underflowed {
                let ends = evaluating.infer(sign * 5.0, 1.0).expect("inside");
                assert_eq!(answer.delta, ends.delta);
            }
        }
    }
}

#[test]
fn a_refusing_supervisor_names_the_input_and_its_range() {
    let refusing = supervisor(PRINTED, 5.0, "exact", OutOfRange::Error);
    let message = refusing.infer(5.5, 0.0).expect_err("outside").to_string();
    assert_eq!(message, "error is 5.5; allowed is -5.0 to 5.0");
    assert!(refusing.infer(0.0, -5.1).expect_err("outside").to_string().starts_with("change"));
    assert!(refusing.infer(5.0, -5.0).is_ok());
}

#[test]
fn no_policy_answers_an_input_that_is_not_finite() {
    for policy in OutOfRange::ALL {
        let supervisor = supervisor(PRINTED, 5.0, "exact", policy);
        for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
            assert!(supervisor.infer(bad, 0.0).is_err() && supervisor.infer(0.0, bad).is_err());
        }
    }
}

#[test]
fn a_range_that_is_no_range_is_refused() {
    for range in [0.0, -5.0, f64::NAN, f64::INFINITY, 1e-300, 1e300] {
        let built = Supervisor::new(&table(PRINTED), range, Defuzzifier::Exact, OutOfRange::Clamp);
        assert!(built.is_err(), "{range}");
    }
    let single = Supervisor::new(&table(PRINTED), 1e-30_f32, Defuzzifier::Exact, OutOfRange::Clamp);
    assert!(single.is_err());
}

#[test]
fn every_single_wrong_label_changes_the_answer_at_its_own_peak() {
    // 49 rules, 3 gains, 6 wrong labels each: the power-on self-test of the embedded handbook.
    let right = supervisor(PRINTED, 5.0, "exact", OutOfRange::Clamp);
    let printed = table(PRINTED);
    let mut detected = 0;
    for output in Output::ALL {
        for error in Label::ALL {
            for change in Label::ALL {
                for wrong in Label::ALL {
                    if wrong == printed.grid(output).at(error, change) {
                        continue;
                    }
                    let faulty = with_label(&printed, output, error, change, wrong);
                    let faulty =
                        Supervisor::new(&faulty, 5.0, Defuzzifier::Exact, OutOfRange::Clamp)
                            .expect("allowed");
                    let peak = |label: Label| (label.index() as f64 - 3.0) * 5.0 / 3.0;
                    let at = |s: &Supervisor<f64>| s.infer(peak(error), peak(change));
                    detected += usize::from(at(&right) != at(&faulty));
                }
            }
        }
    }
    assert_eq!(detected, 882);
}

fn with_label(
    table: &RuleTable,
    output: Output,
    error: Label,
    change: Label,
    label: Label,
) -> RuleTable {
    let grids = Output::ALL.map(|o| {
        let mut rows = [[Label::ZO; LABEL_COUNT]; LABEL_COUNT];
        for e in Label::ALL {
            for c in Label::ALL {
                let changed = (o, e, c) == (output, error, change);
                rows[e.index()][c.index()] = if changed { label } else { table.grid(o).at(e, c) };
            }
        }
        fspid_fuzzy::Grid::new(rows)
    });
    RuleTable::new(grids)
}

#[test]
fn the_mirrored_file_is_the_printed_table_mirrored() {
    assert_eq!(table(MIRRORED), table(PRINTED).mirrored());
}

#[test]
fn scaling_all_ranges_by_eight_scales_the_answer_bit_for_bit() {
    let small = supervisor(PRINTED, 5.0, "exact", OutOfRange::Clamp);
    let large = supervisor(PRINTED, 40.0, "exact", OutOfRange::Clamp);
    for k in 0..1000 {
        let (error, change) = (f64::from(k % 41) * 0.23 - 4.6, f64::from(k % 37) * 0.27 - 4.9);
        let a = small.infer(error, change).expect("inside").delta;
        let b = large.infer(8.0 * error, 8.0 * change).expect("inside").delta;
        assert_eq!((8.0 * a.kp, 8.0 * a.ki, 8.0 * a.kd), (b.kp, b.ki, b.kd));
    }
}

proptest::proptest! {
    #[test]
    fn single_precision_is_near_double_precision(error in -5.0_f32..=5.0, change in -5.0_f32..=5.0) {
        let double = supervisor(PRINTED, 5.0, "exact", OutOfRange::Clamp);
        let single = Supervisor::new(&table(PRINTED), 5.0_f32, Defuzzifier::Exact, OutOfRange::Clamp)
            .expect("allowed");
        let a = double.infer(error.into(), change.into()).expect("inside").delta;
        let b = single.infer(error, change).expect("inside").delta;
        for (a, b) in [(a.kp, b.kp), (a.ki, b.ki), (a.kd, b.kd)] {
            // Twenty roundings of a number near 5.
            proptest::prop_assert!((a - f64::from(b)).abs() < 1e-5, "{} {}", a, b);
        }
    }

    #[test]
    fn increments_stay_within_the_reachable_range(error in -50.0_f64..50.0, change in -50.0_f64..50.0) {
        for policy in [OutOfRange::Clamp, OutOfRange::Evaluate] {
            let delta = supervisor(PRINTED, 5.0, "exact", policy)
                .infer(error, change).expect("finite").delta;
            // The outermost half triangle has its centroid a third of a spacing inside.
            let bound = 5.0 - 5.0 / 9.0 + 1e-12;
            for gain in [delta.kp, delta.ki, delta.kd] {
                proptest::prop_assert!(gain.abs() <= bound, "{}", gain);
            }
        }
    }
}
