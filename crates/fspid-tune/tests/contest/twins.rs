//! Cases that fly the same are evidence once.

use fspid_tune::contest::Options;

use super::{LOOP, cases, marked, pid, place};

/// Fourteen copies of a case made a winner of whom nobody was.
#[test]
fn copies_of_a_case_are_refused_however_they_are_written() {
    let copy = "\n[[contest.case]]\nname = \"copy\"\nset = [\"setpoint.amplitude_deg=2.00\", \"actuator.time_constant_s=0.040\"]\n";
    let told = place(&(marked() + copy)).refused(&Options::default());
    let expected = "case \"copy\" flies what case \"2 deg\" flies, and would count twice";
    assert!(told.contains(expected), "{told}");
}

/// Twelve durations of one flight, the first ten seconds of which were tuned on, made a winner with p = 0.0005, and twelve others the
/// other one; so did twelve times at which its step begins.
#[test]
fn a_flight_cut_or_begun_at_other_times_is_the_same_case() {
    let judged = |name: &str, set: &str| {
        format!(
            "\n[[contest.case]]\nname = \"{name}\"\nset = [\"setpoint.amplitude_deg=2.5\", \"{set}\"]\n"
        )
    };
    let cases = judged("long", "loop.duration_s=31.0")
        + &judged("longer", "loop.duration_s=32.0")
        + &judged("late", "setpoint.at_s=1.7")
        + "\n[[contest.case]]\nname = \"on\"\nset = [\"loop.duration_s=33.0\"]\n";
    let told = place(&(marked() + &cases)).refused(&Options::default());
    for expected in [
        "case \"longer\" flies what case \"long\" flies, for another time, and would count twice",
        "case \"late\" flies what case \"long\" flies, at and for another time, and would count twice",
        "case \"on\" flies what \"as written\" of the tuning flies, for another time; judge on",
    ] {
        assert!(told.contains(expected), "{told}");
    }
}

/// A load that is moved, alone or with the step; a step moved beside a load of no size, or one after the end; a dispersion of which
/// nothing is drawn: twelve of each made either of two designs the winner, with p = 0.0005.
#[test]
fn a_flight_is_the_same_whenever_its_loads_set_in_and_whatever_nobody_draws() {
    let load = |size_deg: f64, at_s: f64| {
        format!(
            "\n[[disturbance]]\nkind = \"step\"\nenters_at = \"servo\"\namplitude_deg = {size_deg:?}\nat_s = {at_s:?}\n"
        )
    };
    let judged = |name: &str, set: &[&str]| {
        let set: Vec<String> = set.iter().map(|it| format!("\"{it}\"")).collect();
        let common = "\"setpoint.amplitude_deg=2.5\"";
        format!("\n[[contest.case]]\nname = \"{name}\"\nset = [{common}, {}]\n", set.join(", "))
    };
    let refused = |beside: &str, second: &[&str]| {
        let first = judged("first", &["loop.duration_s=31.0"]);
        // The third is refused in any case.
        let third = judged("third", &["loop.duration_s=35.0"]);
        let text = marked() + &first + &judged("second", second) + &third + beside;
        place(&text).refused(&Options::default())
    };
    let at = "case \"second\" flies what case \"first\" flies, at and for another time, and would count twice";
    let of_duration =
        "case \"second\" flies what case \"first\" flies, for another time, and would count twice";
    let later = ["setpoint.at_s=3.5", "disturbance[0].at_s=7.5"];
    let told = refused(&load(1.0, 5.0), &later);
    assert!(told.contains(at), "both are moved: {told}");
    let told = refused(&load(0.0, 5.0), &later[..1]);
    assert!(told.contains(at), "of no size: {told}");
    let told = refused(&load(1.0, 100.0), &later[..1]);
    assert!(told.contains(at), "after the end: {told}");
    let told = refused(&load(1.0, 5.0), &later[..1]);
    assert!(!told.contains("case \"second\" flies what"), "the step alone is moved: {told}");
    let drawn = "\n[[dispersion]]\npath = \"actuator.time_constant_s\"\ndistribution = \"uniform\"\nlower = 0.04\nupper = 0.06\n";
    let told = refused(drawn, &["loop.duration_s=33.0"]);
    assert!(told.contains(of_duration), "nothing is drawn: {told}");
}

/// A limit that never acts, moved, is another scenario and the same flight; so is what is written with a delay that a
/// controller was tuned on. Twelve of them made a winner with p = 0.0005.
#[test]
fn cases_that_are_flown_alike_are_evidence_once_and_those_of_the_tuning_never() {
    let idle = |place: usize| {
        format!(
            "\n[[contest.case]]\nname = \"idle {place}\"\nset = [\"setpoint.amplitude_deg=1.0\", \"actuator.time_constant_s=0.06\", \"actuator.position_limit_deg={}\"]\n",
            40 + place
        )
    };
    let trained =
        "\n[[contest.case]]\nname = \"trained\"\nset = [\"actuator.position_limit_deg=90.0\"]\n";
    let text = marked() + &idle(0) + &idle(1) + &idle(2) + trained;
    let held = place(&text).held();
    let judged = &held.judged;
    let at = |name: &str| judged.cases.iter().position(|it| it.name == name).expect("a case");
    assert_eq!(judged.twin_of[at("idle 0")], None);
    assert_eq!(judged.twin_of[at("idle 1")], Some(at("idle 0")));
    assert_eq!(judged.twin_of[at("idle 2")], Some(at("idle 0")));
    assert_eq!(
        judged.trained_as[0][at("trained")].as_ref().map(|it| it.case.as_str()),
        Some("as written")
    );
    assert_eq!(judged.trained_as[0][at("idle 0")], None);
    let said = held.text();
    assert!(said.contains("\"idle 1\" as \"idle 0\""), "{said}");
    assert!(said.contains("\"trained\" as \"as written\" of the tuning"), "{said}");
    // The ratio is that of the contest without them.
    let alone = place(&(marked() + &idle(0))).held();
    let ratio = |outcome: &fspid_tune::contest::Outcome| outcome.comparison(1).map(|it| it.ratio);
    assert_eq!(ratio(&held), ratio(&alone));
}

/// Twelve cases that differ in the ninth digit of a gain of the plant made a winner: no bit of their flights is the same.
#[test]
fn cases_that_differ_in_a_ninth_digit_are_evidence_once() {
    let digit = |place: usize| {
        format!(
            "\n[[contest.case]]\nname = \"digit {place}\"\nset = [\"setpoint.amplitude_deg=1.0000000{place:02}\"]\n"
        )
    };
    let digits: String = (0..12).map(digit).collect();
    let text = format!(
        "{LOOP}{}{}\n[contest]\nagainst = \"slack\"\n{digits}",
        pid("slack", "kp = 0.2\nki = 0.1\nkd = 0.05"),
        pid("good", "kp = 0.8\nki = 0.4\nkd = 0.16"),
    );
    let outcome = place(&text).held();
    let found = outcome.comparison(1).expect("a comparison");
    assert_eq!((found.evidence, found.is_sure), (1, false));
    assert!(outcome.json()["verdict"]["winner"].is_null(), "{}", outcome.text());
}

/// Five seeds of one candidate each are the start, five times.
#[test]
fn seeds_that_find_the_same_are_one_tuning_and_nobody_wins() {
    let once = marked().replace("budget = 24", "budget = 1");
    let held = place(&once).held();
    assert!(held.judged.is_tuned_once());
    let said = held.text();
    assert!(said.starts_with("every seed found the same: no winner can be named"), "{said}");
}

/// Twelve seeds of a rate gyro's noise, which a third controller alone reads: "Y wins ... p = 0.0010 ... judged on 12 cases",
/// of one flight each of the two.
#[test]
fn seeds_that_a_third_controller_alone_sees_are_one_case_between_two_others() {
    let sensor =
        "\n[sensor]\npreset = \"ideal\"\nseed = 1\n\n[sensor.rate]\nnoise_deg_s_rt_hz = 0.05\n";
    let seeds: String = (2..14)
        .map(|seed| {
            format!("\n[[contest.case]]\nname = \"{seed}\"\nset = [\"sensor.seed={seed}\"]\n")
        })
        .collect();
    let text = format!(
        "{LOOP}{sensor}{}{}\n[[controller]]\nname = \"with rate\"\nkind = \"pid\"\nkp = 0.5\nki = 0.4\nrate_gain = 0.1\n\n[contest]\nagainst = \"slack\"\n{seeds}",
        pid("slack", "kp = 0.2\nki = 0.1\nkd = 0.05"),
        pid("good", "kp = 0.8\nki = 0.4\nkd = 0.16"),
    );
    let place = place(&text);
    let outcome = place.held();
    let found = outcome.comparison(1).expect("a comparison");
    assert_eq!((found.evidence, found.is_sure, found.p), (1, false, 1.0));
    let told = outcome.text();
    assert!(!told.lines().next().is_some_and(|line| line.contains("wins,")), "{told}");
    assert!(told.contains("Between good and slack 1 of 12 cases is evidence"), "{told}");
    let page = std::fs::read_to_string(place.out().join("contest.html")).expect("a page");
    assert!(page.contains("Between good and slack 1 of 12 cases is evidence"));
    assert!(outcome.json()["verdict"]["winner"].is_null());
}

/// The first was held against the controller that all are compared with, and against nobody else.
#[test]
fn the_same_controller_twice_does_not_win_beside_a_poor_one() {
    let good = "kp = 0.8\nki = 0.4\nkd = 0.16";
    let text = format!(
        "{LOOP}{}{}{}{}",
        pid("slack", "kp = 0.2\nki = 0.1\nkd = 0.05"),
        pid("good", good),
        pid("again", good),
        cases("")
    );
    let place = place(&text);
    let outcome = place.held();
    let told = outcome.text();
    let first = "good is first, and nobody wins: it is better than slack, and nothing decides between it and again.";
    assert!(told.starts_with(first), "{told}");
    assert!(told.contains("Beside good, which is first: again not significant (p = 1"), "{told}");
    let verdict = &outcome.json()["verdict"];
    assert!(verdict["winner"].is_null() && verdict["first"] == "good", "{verdict}");
    let page = std::fs::read_to_string(place.out().join("contest.html")).expect("a page");
    assert!(page.contains("good is first, and nobody wins") && page.contains("Beside good"));
}
