//! What no answer holds, whatever is asked: an infinity, a NaN, a null without its reason, and no end.

use std::path::Path;

use crate::common;
use common::{code, fspid, text};
use serde_json::Value;

const TSUKAMOTO: &str =
    concat!(env!("CARGO_MANIFEST_DIR"), "/../fspid-formats/tests/data/fll/tsukamoto.fll");

const CERTIFICATE: &str =
    concat!(env!("CARGO_MANIFEST_DIR"), "/../../data/designs/navion-paper.certificate.json");

/// Commands over inputs at the ends of what is allowed, each as text and as JSON. They run in this order in one folder.
const HOSTILE: [&str; 63] = [
    "check a.toml --set controller.PID.kd=-1e308",
    "check a.toml --paths",
    "check a.toml",
    "check a.toml --set plant.preset.denominator[2]=1e300",
    "check air.toml --set aircraft.name.longitudinal.pitch.speed=1e308",
    "check air.toml --set aircraft.name.geometry.span_ft=1e300",
    "check a.toml --set loop.duration_s=1e308",
    "simulate a.toml --set controller.PID.kd=-1e308",
    "simulate a.toml --set controller.PID.kp=1e100",
    "simulate a.toml --set controller.FSPID.nominal.kd=-1e100",
    "simulate a.toml --set setpoint.amplitude_deg=0",
    "simulate air.toml --set loop.duration_s=3 --set controller.PID.kp=1e100",
    "simulate a.toml --set controller.PID.kp=1 --set controller.PID.rate_gain=-1e100",
    "verify a.toml --set controller.PID.kp=1e100 --set ctms",
    "verify a.toml --set ctms --set setpoint.amplitude_deg=0",
    "verify air.toml --set loop.duration_s=3 --set mil-f-8785c",
    "verify a.toml --set mil-f-9490d --set controller.PID.ki=0",
    "analyse a.toml --map 0 --set controller.PID.kd=-1e308",
    "analyse a.toml --map 0 --set controller.PID.kd=1e100",
    "analyse a.toml --map 0 --set controller.PID.kp=0 --set controller.PID.ki=0 --set controller.PID.kd=0",
    "analyse a.toml --map 0 --set controller.PID.ki=0",
    "analyse a.toml --map 3 --broken-at rate",
    "analyse a.toml --map 3 --broken-at pitch --set controller.PID.kp=1e-300",
    "certify a.toml --controller PID --set controller.PID.kd=1e100",
    "certify a.toml --controller PID",
    "certify a.toml --controller PID --set controller.PID.kp=0 --set controller.PID.ki=0 --set controller.PID.kd=0",
    "certify --check CERTIFICATE",
    "certify --check CERTIFICATE --against a.toml",
    "audit TSUKAMOTO --boxes 200",
    "audit tip.toml --boxes 20",
    "audit printed --range 5 --boxes 20",
    "infer TSUKAMOTO --input x=0",
    "infer TSUKAMOTO --input x=1",
    "infer tip.toml --input service=1e308 --input food=-1e308",
    "infer printed --range 5 --error 0 --change 0",
    "explain TSUKAMOTO --input x=1",
    "explain printed --range 5 --error 1e308 --change 0",
    "explain tip.toml --input service=0 --input food=0 --why-not tip=generous",
    "surface TSUKAMOTO --nodes 5",
    "surface tip.toml --nodes 3",
    "surface printed --range 1e-300 --nodes 3",
    "learn tip.toml --conclude linear --data d.csv --validate 0.5 --epochs 2 --out l.toml",
    "learn tip.toml --conclude linear --teacher tip.toml --points 3,3 --epochs 2 --out l.toml",
    "tune a.toml --rule amigo --set plant.preset.numerator[0]=1e-300",
    "tune a.toml --rule amigo --set controller.PID.kd=1e100",
    "tune a.toml --rule ziegler-nichols",
    "tune a.toml --rule list",
    "tune tuning.toml --budget 3 --quiet --population 2",
    "campaign run campaign.toml --runs 2 --quiet --out run",
    "campaign report run/campaign.parquet",
    "campaign replay run --run 1",
    "campaign run campaign.toml --runs 2 --quiet --out still --set setpoint.amplitude_deg=0",
    "campaign report still/campaign.parquet",
    "campaign search campaign.toml --measure rise_time_s --budget 12 --set controller.PID.kp=1e50",
    "contest contest.toml --budget 4 --seeds 1 --quiet --out who",
    "aircraft trim navion --mass 1kg",
    "aircraft linearise ctms-transport",
    "aircraft modes navion",
    "aircraft modes ctms-transport",
    "aircraft qualities navion --mass 1kg",
    "aircraft envelope navion --speeds 20:80:3 --altitudes 0:9000:2",
    "export a.toml --controller FSPID --to c --samples 5 --out code",
    "export a.toml --controller PID --to c --samples 5 --out code --set controller.PID.kd=1e100",
];

#[test]
fn no_answer_holds_an_infinity_a_nan_or_a_null_without_its_reason() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    assert_eq!(code(&fspid(&["init", "a.toml"], folder)), 0);
    for (template, file) in [
        ("fuzzy-system", "tip.toml"),
        ("tuning", "tuning.toml"),
        ("campaign", "campaign.toml"),
        ("contest", "contest.toml"),
        ("aircraft-in-turbulence", "air.toml"),
    ] {
        assert_eq!(code(&fspid(&["init", "--template", template, file], folder)), 0);
    }
    let row = |n: u32| format!("{},{},{}1e200\n", n % 10, (3 * n) % 10, ["", "-"][n as usize % 2]);
    let rows: String = (0..20).map(row).collect();
    std::fs::write(folder.join("d.csv"), format!("service,food,tip\n{rows}")).expect("written");
    for words in HOSTILE {
        // What one of them has written is in the way of the other.
        let out = words.split_once(" --out ").map_or("", |(_, out)| out);
        let again = out.split(' ').next().unwrap_or_default();
        holds(words, "json", folder);
        let again = folder.join(again);
        if again != folder.join("") && again.is_dir() && !words.contains("--runs") {
            std::fs::remove_dir_all(again).expect("removed");
        }
        holds(words, "text", folder);
    }
}

fn holds(words: &str, format: &str, folder: &Path) {
    let stored = |word| match word {
        "TSUKAMOTO" => TSUKAMOTO,
        "CERTIFICATE" => CERTIFICATE,
        word => word,
    };
    let line = words.split(' ').map(stored);
    let line: Vec<&str> = line.chain(["--format", format]).collect();
    let output = fspid(&line, folder);
    let (out, told) = (text(&output.stdout), text(&output.stderr));
    assert!([0, 1, 2].contains(&code(&output)), "{words}: {told}");
    for all in [&out, &told] {
        assert_eq!(unnumbered(all), None, "{words}: {all}");
    }
    if format == "json" {
        let answer: Value = serde_json::from_str(&out).unwrap_or_else(|_| panic!("{words}: {out}"));
        assert_eq!(bare_null(&answer), None, "{answer:#}");
    }
}

/// A word that stands for a number and is none.
pub(crate) fn unnumbered(text: &str) -> Option<&str> {
    let words = text.split(|c: char| !(c.is_alphanumeric() || c == '_' || c == '-'));
    words.into_iter().find(|it| ["inf", "-inf", "NaN", "nan", "-nan", "Infinity"].contains(it))
}

/// Keys that give the reason of every null beside or below them.
const REASONS: [&str; 3] = ["absent", "reasons", "reason"];

/// Where a null is that has no reason beside it, nor around it, nor by its key in a table `null`.
pub(crate) fn bare_null(answer: &Value) -> Option<String> {
    bare_below(answer, "", &[])
}

/// `told` are the keys of which a table around says why they are null.
fn bare_below(value: &Value, path: &str, told: &[&str]) -> Option<String> {
    match value {
        Value::Null => {
            let key = path.rsplit('.').next().unwrap_or_default().trim_end_matches("[]");
            (!told.contains(&key)).then(|| path.to_owned())
        }
        Value::Object(keys) => {
            let says = |reason: &&str| keys.get(*reason).is_some_and(|it| !it.is_null());
            // One text is the reason of all nulls.
            if REASONS.iter().any(says) || keys.get("null").is_some_and(Value::is_string) {
                return None;
            }
            let table = keys.get("null").and_then(Value::as_object);
            let here = table.into_iter().flat_map(|table| table.keys().map(String::as_str));
            // Why a loop is undecided is why `stable` is neither true nor false.
            let here = here.chain(keys.contains_key("undecided").then_some("stable"));
            let told: Vec<&str> = told.iter().copied().chain(here).collect();
            keys.iter().find_map(|(key, value)| bare_below(value, &format!("{path}.{key}"), &told))
        }
        Value::Array(list) => {
            list.iter().find_map(|value| bare_below(value, &format!("{path}[]"), told))
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
        (ideal("pitch={delay_s=1000.0}"), "sensor.pitch.delay_s", "grow with them"),
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
        (ideal("pitch={period_s=500.0}"), "sensor.pitch.period_s", "grow with them"),
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
        "actuator.delay_samples=10000".to_owned(),
        ideal("pitch={delay_s=100.03}"),
        ideal("rate={period_s=1e-5}"),
        second("natural_frequency_rad_s=1e3,damping=0.7"),
        "controller.PID.kd=-1e100".to_owned(),
    ] {
        assert_eq!(code(&fspid(&["check", "a.toml", "--set", &set], folder)), 0, "{set}");
        assert!(code(&fspid(&["simulate", "a.toml", "--set", &set], folder)) < 2, "{set}");
    }
}

/// A flight of a nonlinear aircraft waits without cost; the question whether it holds at rest did not end, and what no loop
/// can be judged with was refused by the flight, as the fault of a gain of 0.8.
#[test]
fn what_a_nonlinear_aircraft_would_not_be_answered_is_refused_by_check_too() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let step = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/gallery/navion-step.toml");
    let text_of = std::fs::read_to_string(step).expect("shipped");
    std::fs::write(folder.join("a.toml"), &text_of).expect("written");
    for (set, key, reason) in [
        ("sensor={preset='ideal',pitch={delay_s=300.0}}", "sensor.pitch.delay_s", "grow with them"),
        ("aircraft.name.longitudinal.drag.reference=1e200", "aircraft.name", "at the trim"),
        ("aircraft.name.longitudinal.lift.pitch_rate=1e30", "aircraft.name", "not a number"),
        ("aircraft.name.longitudinal.lift.alpha=1e12", "aircraft.name", "at the trim"),
        ("aircraft.name.longitudinal.pitch.alpha=-1e50", "aircraft.name", "64-bit"),
    ] {
        let output = fspid(&["check", "a.toml", "--set", set], folder);
        let told = text(&output.stderr);
        assert!(code(&output) == 2 && told.contains(key) && told.contains(reason), "{set}: {told}");
    }
    // Each mode of an autopilot is a matrix of everything.
    let outer =
        concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/gallery/altitude-capture.toml");
    let output = fspid(&["check", outer, "--set", "actuator.delay_samples=500"], folder);
    assert!(code(&output) == 2 && text(&output.stderr).contains("cube"), "{output:?}");
    let light = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/contest/light.toml");
    let scale = "controller.\"FSPID, mirrored\".supervisor.change_scale=1e300";
    let told = text(&fspid(&["check", light, "--set", scale], folder).stderr);
    assert!(told.contains("supervisor: with its scales"), "{told}");
    let drawn = "\n[[dispersion]]\npath = \"sensor.pitch.delay_s\"\ndistribution = \"uniform\"\nlower = 0.0\nupper = 1000.0\n";
    let sensor = "\n[sensor]\npreset = \"ideal\"\npitch = { delay_s = 0.0 }\n";
    std::fs::write(folder.join("d.toml"), format!("{text_of}{sensor}{drawn}")).expect("written");
    let output = fspid(&["check", "d.toml"], folder);
    let told = text(&output.stderr);
    assert!(
        code(&output) == 2 && told.contains("dispersion[0]") && told.contains("grow with them"),
        "{told}"
    );
}

/// 10 000 samples were 2.3 GB and no answer; 401 were refused. Margins are still asked of 400 at most, and say so.
#[test]
fn a_long_delay_is_judged_and_only_its_margins_are_refused_by_name() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    assert_eq!(code(&fspid(&["init", "a.toml"], folder)), 0);
    let late = ["a.toml", "--set", "actuator.delay_samples=10000"];
    let told = text(&fspid(&[&["simulate"][..], &late].concat(), folder).stdout);
    assert!(told.contains("unstable at rest"), "{told}");
    let calm = ["--set", "controller.PID={kind='pid',kp=0.001,ki=0.0,kd=0.0}"];
    let told = text(&fspid(&[&["simulate"][..], &late, &calm].concat(), folder).stdout);
    assert!(!told.contains("PID         unstable"), "{told}");
    let refused = fspid(&[&["analyse"][..], &late].concat(), folder);
    let told = text(&refused.stderr);
    assert!(code(&refused) == 2 && told.contains("10000 samples are on their way"), "{told}");
}

/// A proof at the limit of its states takes minutes; the first line of progress says that it is sought.
#[cfg(unix)]
#[test]
fn ctrl_c_ends_a_proof_that_is_sought() {
    use std::io::{BufRead as _, BufReader, Read as _};
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    assert_eq!(code(&fspid(&["init", "a.toml"], folder)), 0);
    let late = "actuator={time_constant_s=0.05,delay_samples=15}";
    let words = ["certify", "a.toml", "--controller", "FSPID", "--set", late];
    let mut child = common::started(&words, folder);
    let mut stderr = BufReader::new(child.stderr.take().expect("standard error"));
    let mut line = String::new();
    while !line.contains("certifying") {
        line.clear();
        assert!(stderr.read_line(&mut line).expect("text") > 0, "it has ended");
    }
    let killed =
        std::process::Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(killed.is_ok_and(|status| status.success()));
    let mut told = String::new();
    stderr.read_to_string(&mut told).expect("text");
    assert_eq!(child.wait().expect("it ends").code(), Some(130), "{told}");
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

/// A sensor of an outer loop that remembers for ever, or looks without end, was accepted and then not flown.
#[test]
fn sensors_of_outer_loops_are_refused_by_check_as_those_of_the_pitch_loop_are() {
    let scenario =
        concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/gallery/altitude-capture.toml");
    for (key, numbers) in [
        ("period_s", "period_s=1e15"),
        ("delay_s", "delay_s=1e9"),
        ("period_s", "period_s=1e-12"),
        ("period_s", "period_s=1e-12,delay_s=0.1"),
    ] {
        let set = format!("outer_loop[0].sensor={{{numbers}}}");
        let told = fspid(&["check", scenario, "--set", &set], Path::new("."));
        assert_eq!(code(&told), 2, "{set}");
        let text = text(&told.stderr);
        assert!(text.contains(&format!("outer_loop[0].sensor.{key}")), "{text}");
    }
}

/// An aircraft without inertia: its loads were no numbers a sample before its motion was none, and the last row said so.
#[test]
fn a_trace_ends_before_the_first_row_that_is_not_finite() {
    let delay = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenarios/gallery/delay.toml");
    let folder = tempfile::tempdir().expect("a folder");
    let light = "aircraft.iy_slug_ft2=0.7529278283267127";
    let words = ["simulate", delay, "--set", light, "--trace", "t.csv"];
    let flown = fspid(&words, folder.path());
    let told = text(&flown.stdout);
    let trace = std::fs::read_to_string(folder.path().join("t.csv")).expect("written");
    let rows: Vec<&str> = trace.lines().skip(1).collect();
    let is_number = |cell: &str| cell.parse::<f64>().is_ok_and(f64::is_finite);
    assert!(rows.iter().all(|row| row.split(',').all(is_number)), "{trace}");
    // The flight ends there, and says so.
    assert_eq!(rows.len(), 4, "{trace}");
    assert!(told.contains("diverged at t = 0.04 s"), "{told}");
}
