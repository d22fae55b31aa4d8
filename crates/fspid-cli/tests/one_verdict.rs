//! One verdict on stability, asked of every command in its own way.

use std::path::Path;

use crate::common::{code, fspid, json, text};

const REQUIRED: &str = r#"
[[requirement]]
measure = "stable"
[[requirement]]
measure = "phase_margin_deg"
least = 0.0
"#;

const DISPERSED: &str = r#"
[[dispersion]]
path = "plant.preset.numerator[0]"
distribution = "normal"
mean = 1.0
standard_deviation = 0.01
lower = 0.9
upper = 1.1
relative = true
"#;

/// The starter with its PID changed, limited and alone; with requirements and without.
fn starter(folder: &Path, changes: &[(&str, &str)]) {
    assert_eq!(code(&fspid(&["init", "start.toml"], folder)), 0);
    let mut text = std::fs::read_to_string(folder.join("start.toml")).expect("written");
    let rest = text.find("# The same gains, tuned").expect("a second controller");
    text.truncate(rest);
    let limits = ("# output_limits_deg", "output_limits_deg");
    for (from, to) in changes.iter().chain([&limits]) {
        assert!(text.contains(from), "{from}");
        text = text.replacen(from, to, 1);
    }
    for (file, more) in [("asked.toml", REQUIRED), ("drawn.toml", DISPERSED)] {
        std::fs::write(folder.join(file), format!("{text}{more}")).expect("written");
    }
}

/// What each command says of the only controller, and how it ends.
fn said(folder: &Path) -> [(i32, String); 6] {
    let run = ["campaign", "run", "drawn.toml", "--runs", "20", "--quiet", "--out", "c"];
    assert_eq!(code(&fspid(&run, folder)), 0);
    [
        &["simulate", "asked.toml"][..],
        &["simulate", "drawn.toml"],
        &["analyse", "asked.toml"],
        &["analyse", "asked.toml", "--format", "json"],
        &["verify", "asked.toml"],
        &["campaign", "report", "c/campaign.parquet"],
    ]
    .map(|words| {
        let output = fspid(words, folder);
        (code(&output), text(&output.stdout))
    })
}

/// With limits it was settled: the loop doubles in half an hour, and the flight takes ten seconds.
#[test]
fn a_limited_controller_whose_loop_grows_slowly_is_unstable_for_every_command() {
    let folder = tempfile::tempdir().expect("a folder");
    starter(folder.path(), &[("ki = 0.5", "ki = -0.0004")]);
    let said = said(folder.path());
    for ((code, told), words) in said.iter().zip([
        "unstable at rest (doubles every 1730 s, spectral radius 1.000004)",
        "unstable at rest (doubles every 1730 s, spectral radius 1.000004)",
        "UNSTABLE with kp 1.0000",
        "\"stability\": \"unstable\"",
        "unstable",
        "unstable 20",
    ]) {
        assert!(told.contains(words), "{words}: {told}");
        assert!(*code == 1 || words == "unstable 20", "{words}: {code}");
    }
    let reason = "the loop is unstable: spectral radius 1.000004 of the sampled loop";
    assert!([2, 3, 4].iter().all(|place| said[*place].1.contains(reason)), "{said:#?}");
    // Nothing is required: that is said first, and what fails by itself is counted.
    let counted = "nothing is required of it; not settled, or failed by itself: 20 of 20: at least";
    assert!(said[5].1.contains(counted), "{}", said[5].1);
}

/// A pole on the unit circle was UNSTABLE for `analyse`, without a pole or a reason, and nothing at all for a flight.
#[test]
fn what_nobody_can_tell_is_undecided_for_every_command_with_the_same_reason() {
    let folder = tempfile::tempdir().expect("a folder");
    let off = [("kp = 1.0", "kp = 0.0"), ("ki = 0.5", "ki = 0.0"), ("kd = 0.05", "kd = 0.0")];
    starter(folder.path(), &off);
    let said = said(folder.path());
    let reason = "undecided: rounding may carry poles across the unit circle (spectral radius 1.000000000 as computed)";
    let one_line = |text: &str| text.split_whitespace().collect::<Vec<_>>().join(" ");
    for (code, told) in &said[..5] {
        assert!(one_line(told).contains(reason), "{told}");
        assert!(!told.to_lowercase().contains("unstable at rest"), "{told}");
        assert!(*code == 1 || told.starts_with("my first flight"), "{code}: {told}");
    }
    // A campaign had no word for it.
    assert!(said[5].1.contains("stability at rest undecided: 20"), "{}", said[5].1);
    let answer = fspid(&["analyse", "asked.toml", "--format", "json"], folder.path());
    let loop_ = &json(&answer)["controllers"][0];
    assert!(loop_["stable"].is_null() && loop_["stability"] == "undecided", "{loop_}");
    assert_eq!(loop_["absent"], reason);
}

/// "fails 0 of 20" was said where nothing was required, as if something had been judged.
#[test]
fn a_campaign_without_requirements_does_not_say_that_nothing_fails() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    starter(folder, &[]);
    let run = ["campaign", "run", "drawn.toml", "--runs", "20", "--quiet", "--out", "c"];
    assert_eq!(code(&fspid(&run, folder)), 0);
    let report = ["campaign", "report", "c/campaign.parquet", "--out", "page.html"];
    let told = text(&fspid(&report, folder).stdout);
    assert!(!told.contains("fails 0 of") && told.contains("nothing is required of it"), "{told}");
    let page = std::fs::read_to_string(folder.join("page.html")).expect("written");
    assert!(page.contains("Nothing required: none of 20 flights failed"), "no such box");
}
