//! What no answer holds, whatever is asked: an infinity, a NaN, a null without its reason, and no end.

use std::path::Path;

use crate::common;
use common::{code, fspid, text};
use serde_json::Value;

const TSUKAMOTO: &str =
    concat!(env!("CARGO_MANIFEST_DIR"), "/../fspid-formats/tests/data/fll/tsukamoto.fll");

/// Commands over inputs at the ends of what is allowed, each as text and as JSON.
const HOSTILE: [&str; 22] = [
    "check a.toml --set controller.PID.kd=-1e308",
    "simulate a.toml --set controller.PID.kd=-1e308",
    "simulate a.toml --set controller.PID.kp=1e100",
    "simulate a.toml --set controller.FSPID.nominal.kd=-1e100",
    "simulate a.toml --set setpoint.amplitude_deg=0",
    "verify a.toml --set controller.PID.kp=1e100 --requirements ctms",
    "analyse a.toml --map 0 --set controller.PID.kd=-1e308",
    "analyse a.toml --map 0 --set controller.PID.kd=1e100",
    "analyse a.toml --map 0 --set controller.PID.kp=0 --set controller.PID.ki=0 --set controller.PID.kd=0",
    "analyse a.toml --map 0 --set controller.PID.ki=0",
    "audit TSUKAMOTO --boxes 200",
    "infer TSUKAMOTO --input x=0",
    "infer TSUKAMOTO --input x=1",
    "explain TSUKAMOTO --input x=1",
    "surface TSUKAMOTO --nodes 5",
    "surface tip.toml --nodes 3",
    "audit tip.toml --boxes 20",
    "learn tip.toml --conclude linear --data d.csv --validate 0.5 --epochs 2 --out l.toml",
    "learn tip.toml --conclude linear --teacher tip.toml --points 3,3 --epochs 2 --out l.toml",
    "tune a.toml --rule amigo --set plant.preset.numerator[0]=1e-300",
    "aircraft envelope navion --speeds 20:80:3 --altitudes 0:9000:2",
    "certify a.toml --controller PID --set controller.PID.kd=1e100",
];

/// Keys that give the reason of a null beside or below them.
const REASONS: [&str; 4] = ["absent", "reasons", "reason", "null"];

/// Keys whose null says that there is no such thing, which is no number that is missing: no range of stable gains below,
/// a grid without a controller, a factor that nothing was refused at.
const NONE: [&str; 6] =
    ["lowest_gain", "relative_dead_time", "supervisor", "controller", "not_proved", "open_because"];

#[test]
fn no_answer_holds_an_infinity_a_nan_or_a_null_without_its_reason() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    assert_eq!(code(&fspid(&["init", "a.toml"], folder)), 0);
    assert_eq!(code(&fspid(&["init", "--template", "fuzzy-system", "tip.toml"], folder)), 0);
    let row = |n: u32| format!("{},{},{}1e200\n", n % 10, (3 * n) % 10, ["", "-"][n as usize % 2]);
    let rows: String = (0..20).map(row).collect();
    std::fs::write(folder.join("d.csv"), format!("service,food,tip\n{rows}")).expect("written");
    for words in HOSTILE {
        holds(words, "text", folder);
        holds(words, "json", folder);
    }
}

fn holds(words: &str, format: &str, folder: &Path) {
    let line = words.split(' ').map(|word| if word == "TSUKAMOTO" { TSUKAMOTO } else { word });
    let line: Vec<&str> = line.chain(["--format", format]).collect();
    let output = fspid(&line, folder);
    let (out, told) = (text(&output.stdout), text(&output.stderr));
    assert!([0, 1, 2].contains(&code(&output)), "{words}: {told}");
    for all in [&out, &told] {
        assert_eq!(unnumbered(all), None, "{words}: {all}");
    }
    if format == "json" {
        let answer: Value = serde_json::from_str(&out).unwrap_or_else(|_| panic!("{words}: {out}"));
        assert_eq!(bare_null(&answer, words, false), None, "{answer:#}");
    }
}

/// A word that stands for a number and is none.
fn unnumbered(text: &str) -> Option<&str> {
    let words = text.split(|c: char| !(c.is_alphanumeric() || c == '_' || c == '-'));
    words.into_iter().find(|it| ["inf", "-inf", "NaN", "nan", "-nan", "Infinity"].contains(it))
}

/// Where a null is that has no reason beside it, nor around it.
fn bare_null(value: &Value, path: &str, explained: bool) -> Option<String> {
    match value {
        Value::Null => (!explained).then(|| path.to_owned()),
        Value::Object(keys) => {
            let explained = explained || REASONS.iter().any(|reason| keys.get(*reason).is_some());
            let mut below = keys.iter();
            below.find_map(|(key, value)| {
                let explained = explained || (value.is_null() && NONE.contains(&key.as_str()));
                bare_null(value, &format!("{path}.{key}"), explained)
            })
        }
        Value::Array(list) => {
            list.iter().find_map(|value| bare_null(value, &format!("{path}[]"), explained))
        }
        Value::Bool(_) | Value::Number(_) | Value::String(_) => None,
    }
}

/// `check` called all of them good, and a flight, a proof or an audit did not end.
#[test]
fn what_would_not_be_answered_is_refused_by_check_at_its_key_with_the_reason() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    assert_eq!(code(&fspid(&["init", "a.toml"], folder)), 0);
    let ideal = |channel: &str| format!("sensor={{preset='ideal',{channel}}}");
    let second = |numbers: &str| format!("actuator={{{numbers}}}");
    for (set, key, reason) in [
        ("actuator.delay_samples=2000".to_owned(), "actuator.delay_samples", "cube"),
        (ideal("pitch={delay_s=100.0}"), "sensor.pitch.delay_s", "cube"),
        (ideal("pitch={delay_s=1e20}"), "sensor.pitch.delay_s", "a million sample periods"),
        (ideal("rate={period_s=1e-12}"), "sensor.rate.period_s", "would not end"),
        (
            second("natural_frequency_rad_s=1e6,damping=0.7"),
            "actuator.natural_frequency_rad_s",
            "would not end",
        ),
        (
            second("natural_frequency_rad_s=30,damping=1e5"),
            "actuator.natural_frequency_rad_s",
            "would not end",
        ),
        ("controller.PID.kd=1e308".to_owned(), "controller[0].kd", "-1e100 to 1e100"),
    ] {
        let output = fspid(&["check", "a.toml", "--set", &set], folder);
        let told = text(&output.stderr);
        assert!(code(&output) == 2 && told.contains(key) && told.contains(reason), "{set}: {told}");
        // In a file its line and column stand before.
        assert!(told.contains("1 problem in a.toml"), "{set}: {told}");
    }
    for set in [
        "actuator.delay_samples=100".to_owned(),
        ideal("rate={period_s=1e-5}"),
        second("natural_frequency_rad_s=1e3,damping=0.7"),
        "controller.PID.kd=-1e100".to_owned(),
    ] {
        assert_eq!(code(&fspid(&["check", "a.toml", "--set", &set], folder)), 0, "{set}");
        assert!(code(&fspid(&["simulate", "a.toml", "--set", &set], folder)) < 2, "{set}");
    }
}

#[test]
fn a_model_with_hundreds_of_thousands_of_attributes_is_refused_at_its_place() {
    let folder = tempfile::tempdir().expect("a folder");
    let attributes: String = (0..300_000).map(|n| format!(" a{n}='x'")).collect();
    for (name, words) in [("a.dml", "aircraft import a.dml"), ("a.xml", "check a.xml")] {
        let text_of = format!("<?xml version='1.0'?>\n<DAVEfunc{attributes}/>\n");
        std::fs::write(folder.path().join(name), text_of).expect("written");
        let output = fspid(&words.split(' ').collect::<Vec<_>>(), folder.path());
        let told = text(&output.stderr);
        assert!(code(&output) == 2 && told.contains("at most 1000 attributes"), "{name}: {told}");
        assert!(told.contains("2:1"), "{name}: {told}");
    }
}
