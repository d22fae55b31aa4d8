//! `fspid bench` as people and scripts meet it. What rates are is the machine's business; that they are
//! there, and of the same work, is tested.

use std::path::Path;

use crate::common::{code, fspid, json, text};

// What rates cost is measuring them: once by one thread as people see it, once by two as scripts do.
#[test]
fn a_machine_is_measured_with_the_same_answers_on_any_number_of_threads_and_with_units() {
    let output = fspid(&["bench", "--quick", "--threads", "1"], Path::new("."));
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    let people = text(&output.stdout);
    for words in ["FSPID steps, side by side", "/s", "scaling", "spread is from quartile", "Digest"]
    {
        assert!(people.contains(words), "{words}: {people}");
    }
    let asked = ["bench", "--quick", "--threads", "2", "--format", "json"];
    let scripts = json(&fspid(&asked, Path::new(".")));
    for key in [
        "inference_scalar_per_s",
        "inference_batch_per_s",
        "step_scalar_per_s",
        "step_batch_per_s",
        "flights_per_s",
    ] {
        assert!(scripts[key].as_f64().is_some_and(|rate| rate > 0.0), "{key}: {scripts}");
    }
    let digest = scripts["details"]["digest"].as_str().expect("a digest");
    assert!(people.contains(&digest[..16]), "{digest}: {people}");
    assert_eq!(scripts["details"]["threads"], 2);
    let measurements = scripts["details"]["measurements"].as_array().expect("a list");
    assert_eq!(measurements.len(), 10);
    for measurement in measurements {
        let rate = |key: &str| measurement[key].as_f64().expect("a rate");
        assert!(rate("lower_quartile_per_s") <= rate("median_per_s"), "{measurement}");
        assert!(rate("median_per_s") <= rate("upper_quartile_per_s"), "{measurement}");
        assert!(rate("upper_quartile_per_s") <= rate("best_per_s"), "{measurement}");
    }
}
