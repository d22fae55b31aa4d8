//! `fspid bench` as people and scripts meet it. What rates are is the machine's business; that they are
//! there, and of the same work, is tested.

use std::process::{Command, Output};

use serde_json::Value;

fn bench(arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_fspid"))
        .args(["bench", "--quick"])
        .args(arguments)
        .output()
        .expect("the program starts")
}

fn json(arguments: &[&str]) -> Value {
    let output = bench(&[arguments, &["--format", "json"]].concat());
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    serde_json::from_slice(&output.stdout).expect("JSON on standard output")
}

#[test]
fn a_machine_is_measured_with_the_same_answers_on_any_number_of_threads() {
    let (one, two) = (json(&["--threads", "1"]), json(&["--threads", "2"]));
    for key in [
        "inference_scalar_per_s",
        "inference_batch_per_s",
        "step_scalar_per_s",
        "step_batch_per_s",
        "flights_per_s",
    ] {
        for rates in [&one, &two] {
            assert!(rates[key].as_f64().is_some_and(|rate| rate > 0.0), "{key}: {rates}");
        }
    }
    assert_eq!(one["details"]["digest"], two["details"]["digest"]);
    assert_eq!((&one["details"]["threads"], &two["details"]["threads"]), (&1.into(), &2.into()));
    let measurements = two["details"]["measurements"].as_array().expect("a list");
    assert_eq!(measurements.len(), 10);
    for measurement in measurements {
        let rate = |key: &str| measurement[key].as_f64().expect("a rate");
        assert!(rate("lower_quartile_per_s") <= rate("median_per_s"), "{measurement}");
        assert!(rate("median_per_s") <= rate("upper_quartile_per_s"), "{measurement}");
        assert!(rate("upper_quartile_per_s") <= rate("best_per_s"), "{measurement}");
    }
}

#[test]
fn people_get_a_table_with_units_and_a_word_on_the_spread() {
    let output = bench(&[]);
    assert!(output.status.success());
    let text = String::from_utf8(output.stdout).expect("UTF-8");
    for words in ["FSPID steps, side by side", "/s", "scaling", "spread is from quartile", "Digest"]
    {
        assert!(text.contains(words), "{words}: {text}");
    }
}
