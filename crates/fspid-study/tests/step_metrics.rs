//! Step metrics against event-located values made by `oracles/make_step_metrics.py`.

#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

use std::path::Path;

use fspid_study::metrics::{Measured, StepMetrics, StepWindow};

fn read(file: &str) -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data").join(file);
    std::fs::read_to_string(path).expect("a reference file")
}

fn numbers(line: &str) -> Vec<Option<f64>> {
    line.split(',').skip(1).map(|word| word.parse().ok()).collect()
}

#[test]
fn step_metrics_agree_with_located_events() {
    let mut signals = 0;
    for line in read("step_metrics.csv").lines().skip(1) {
        let name = line.split(',').next().expect("a name");
        let reference = numbers(line);
        let value = |index: usize| reference.get(index).copied().flatten();
        let (from, to) = (value(0).expect("start"), value(1).expect("final"));
        let (time_s, response): (Vec<f64>, Vec<f64>) = read(&format!("step_{name}.csv"))
            .lines()
            .skip(1)
            .map(|row| {
                let (t, y) = row.split_once(',').expect("two columns");
                (t.parse::<f64>().expect("time"), y.parse::<f64>().expect("response"))
            })
            .unzip();
        let window = StepWindow { time_s: &time_s, response: &response, from, to };
        let metrics = StepMetrics::of(window);
        let extreme = |fraction: Measured| fraction.map(|way| from + way * (to - from));
        let (low, high) = (extreme(metrics.settling_min), extreme(metrics.settling_max));
        // For a fall the lowest of the way is the highest of the signal.
        let (least, greatest) = if to > from { (low, high) } else { (high, low) };
        let rows = [
            ("rise time", metrics.rise_time_s, value(4)),
            ("settling time", metrics.settling_time_s, value(5)),
            ("least after rise", least, value(6)),
            ("greatest after rise", greatest, value(7)),
            ("overshoot", metrics.overshoot_pct, value(8)),
            ("undershoot", metrics.undershoot_pct, value(9)),
            ("peak", metrics.peak, value(10)),
            ("peak time", metrics.peak_time_s, value(11)),
        ];
        for (what, ours, theirs) in rows {
            match (ours, theirs) {
                // A response that creeps up to the last sample: rounding decides where it is highest.
                (Ok(ours), Some(end)) if what == "peak time" && end == time_s[time_s.len() - 1] => {
                    assert!(ours > 0.9 * end, "{name} {what}: {ours} {end}");
                }
                // Straight lines between samples 1 to 20 ms apart leave this much.
                (Ok(ours), Some(theirs)) => {
                    let tolerance = 2e-4 * theirs.abs().max(1.0);
                    assert!((ours - theirs).abs() < tolerance, "{name} {what}: {ours} {theirs}");
                }
                (Err(_), None) => {}
                (ours, theirs) => panic!("{name} {what}: {ours:?} {theirs:?}"),
            }
        }
        signals += 1;
    }
    assert_eq!(signals, 8);
}
