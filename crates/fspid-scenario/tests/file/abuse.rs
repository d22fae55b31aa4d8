use fspid_scenario::file::{self, LoadError};

fn problems(text: &str) -> file::Problems {
    file::parse(text, "abuse.toml", None, &[]).expect_err("it is no scenario")
}

#[test]
fn a_hundred_thousand_brackets_are_refused_without_recursion() {
    let many = 100_000;
    for text in [
        format!("a = {}", "[".repeat(many)),
        format!("a = {}{}", "[".repeat(many), "]".repeat(many)),
        format!("a = {}", "{a=".repeat(many)),
        format!("{}a = 1", "a.".repeat(many)),
        format!("[{}a]", "a.".repeat(many)),
        format!("[[{}a]]", "a . ".repeat(many)),
        format!("{}a = 1", "\"a\".".repeat(many)),
        format!("a = {{ {}a = 1 }}", "a.".repeat(many)),
    ] {
        let found = problems(&text);
        assert!(found.to_string().contains("nested too deeply"), "{found}");
    }
}

#[test]
fn nesting_up_to_the_limit_is_a_matter_of_the_specification() {
    let text = format!("a = {}{}", "[".repeat(60), "]".repeat(60));
    assert!(problems(&text).to_string().contains("a: unknown key"));
}

#[test]
fn a_nul_byte_is_refused_with_its_place() {
    let found = problems("schema = 1\nname = \"a\0b\"\n");
    assert_eq!(found.list[0].line_and_column(), (2, 10));
    assert!(found.to_string().contains("NUL"), "{found}");
}

#[test]
fn bytes_that_are_no_utf_8_are_refused_with_their_place() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("latin.toml");
    std::fs::write(&path, b"schema = 1\nname = \"caf\xe9\"\n").expect("written");
    let Err(LoadError::Problems(found)) = file::load(&path, &[]) else { panic!("it is not UTF-8") };
    assert_eq!(found.list[0].line_and_column(), (2, 12));
    assert_eq!(found.list[0].found, "byte 0xE9");
}

#[test]
fn a_byte_order_mark_and_carriage_returns_change_nothing() {
    let good = file::parse(file::starter(), "x", None, &[]).expect("good").scenario;
    for text in [
        format!("\u{feff}{}", file::starter()),
        file::starter().replace('\n', "\r\n"),
        format!("\u{feff}{}", file::starter().replace('\n', "\r\n")),
    ] {
        assert_eq!(file::parse(&text, "x", None, &[]).expect("good").scenario, good);
    }
    let bad = file::starter().replace("duration_s = 10.0", "duration_s = 0.0");
    let (unix, dos) = (problems(&bad), problems(&format!("\u{feff}{}", bad.replace('\n', "\r\n"))));
    assert_eq!(unix, dos);
    let first = &problems("\u{feff}nmae = 1").list;
    assert!(
        first.iter().any(|problem| problem.path == "nmae" && problem.line_and_column() == (1, 1))
    );
}

#[test]
fn an_empty_file_is_called_empty_and_a_file_of_something_else_says_what_is_wrong() {
    for text in ["", "\n\n", "# nothing", "\u{feff}"] {
        let found = problems(text);
        assert_eq!(found.list.len(), 1, "{found}");
        assert!(found.to_string().contains("this is an empty file, and not a scenario"), "{found}");
    }
    for text in [
        "{\"schema\": 1}",
        "<html>",
        "name: x",
        "\u{7f}",
        "=",
        "[",
        "]",
        "\"",
        "\"\"\"",
        "'''",
        "a = \"\\",
        "\\",
        "a='",
        "[[",
        "a=1e",
        "a=0x",
        "a=1_",
        "a=+-1",
        "a=1979-05-27T07:32:00Z\u{202e}",
    ] {
        assert!(!problems(text).list.is_empty(), "{text}");
    }
}

#[test]
fn a_huge_line_and_a_huge_number_of_problems_are_answered_in_short() {
    for text in [
        format!("name = \"{}\"", "x".repeat(5_000_000)),
        format!("{} = 1", "x".repeat(5_000_000)),
        format!("a = [{}]", "1, ".repeat(500_000)),
        format!(
            "[setpoint]\nkind = \"table\"\nvalue_deg = [1]\ntime_s = [{}]",
            "nan, ".repeat(500_000)
        ),
        (0..100_000).map(|n| format!("key{n} = 1\n")).collect(),
        "[[controller]]\n".repeat(50_000),
    ] {
        let found = problems(&text);
        assert!(found.list.len() <= 100);
        // Of a key of five million letters only the path may be long, and it is not.
        assert!(found.to_string().len() < 40_000, "{}", found.to_string().len());
    }
}

#[test]
fn a_file_beyond_ten_mebibytes_is_not_read() {
    let text = "#".repeat(10 * 1024 * 1024 + 1);
    assert!(problems(&text).to_string().contains("too large"));
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("large.toml");
    std::fs::write(&path, &text).expect("written");
    assert!(matches!(file::load(&path, &[]), Err(LoadError::Unreadable { .. })));
}

#[test]
fn a_flight_of_a_million_million_samples_is_refused_before_it_starts() {
    for (period, duration) in [("1e-9", "1e3"), ("1e-300", "1e300"), ("0.01", "1e10")] {
        let text = file::starter()
            .replace("sample_period_s = 0.01", &format!("sample_period_s = {period}"))
            .replace("duration_s = 10.0", &format!("duration_s = {duration}"));
        let found = problems(&text);
        assert_eq!(found.list.len(), 1, "{found}");
        assert_eq!(found.list[0].path, "loop.duration_s");
        assert!(found.list[0].message.contains("too many"), "{found}");
    }
}

#[test]
fn extreme_numbers_are_answered_and_never_a_panic() {
    for set in [
        "loop.sample_period_s=5e-324",
        "loop.sample_period_s=1e308",
        "setpoint.at_s=1e308",
        "plant={numerator=[1e308], denominator=[1e-308, 1], elevator_sign='nose-up-positive'}",
        "plant={numerator=[1], denominator=[1, 1e300, 1], elevator_sign='nose-up-positive'}",
        "plant={numerator=[1], denominator=[1, -1e9, 1], elevator_sign='nose-up-positive'}",
        "controller.PID.kp=1e308",
        "controller.PID.sample_guard_deg=1e-300",
        "controller.PID.slew_limit_deg_s=5e-324",
        "controller.FSPID.supervisor.error_scale=1e308",
        "controller.FSPID.supervisor.range=1e-100",
        "actuator.time_constant_s=5e-324",
        "actuator.time_constant_s=1e308",
        "actuator.rate_limit_deg_s=5e-324",
        "controller.PID.output_limits_deg=[0, 5e-324]",
        "loop.duration_s=0.001",
        "plant_change=[{at_s=0, ramp_s=1e308, preset='ctms-pitch'}]",
        "plant_change=[{at_s=1e308, ramp_s=1e308, preset='ctms-pitch'}]",
        "setpoint={kind='square', amplitude_deg=1, half_period_s=5e-324}",
        "setpoint={kind='ramp', amplitude_deg=1, width_s=5e-324}",
    ] {
        let study = file::parse(file::starter(), "x", None, &[set.to_owned()]);
        if let Ok(study) = study {
            let flight = fspid_sim::simulate(&study.scenario);
            assert!(flight.is_ok(), "{set}: {flight:?}");
        }
    }
}

#[test]
fn traces_that_would_not_fit_into_memory_together_are_refused() {
    let text = file::starter().replace("duration_s = 10.0", "duration_s = 1e5 # ");
    assert!(file::parse(&text.replace("1e5", "9e4"), "x", None, &[]).is_ok());
    let third = "[[controller]]\nname = \"third\"\nkind = \"p\"\nkp = 1.0\n";
    let found = problems(&format!("{}\n{third}", text.replace("1e5", "9e4")));
    assert!(found.to_string().contains("3 traces of 9000001 samples are too many"), "{found}");
}

/// A starter with random damage is refused with a reason or flies; it never makes the reader fall.
#[test]
fn a_damaged_scenario_is_refused_with_a_reason_or_accepted() {
    let mut state = 1_u64;
    let mut random = move |below: usize| {
        // Numerical Recipes' generator; its upper bits are good enough for damage.
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    let bits = [
        "",
        "=",
        "[",
        "]",
        "{",
        "}",
        "\"",
        "'",
        ",",
        ".",
        "\n",
        "nan",
        "-1",
        "1e9",
        "kind",
        "[[controller]]",
        "\u{e9}",
        "\0",
        "#",
    ];
    let (mut refused, mut accepted) = (0, 0);
    for _ in 0..3000 {
        let mut text: Vec<char> = file::starter().chars().collect();
        for _ in 0..=random(3) {
            let at = random(text.len());
            let end = (at + random(4)).min(text.len());
            text.splice(at..end, bits[random(bits.len())].chars());
        }
        let text: String = text.into_iter().collect();
        match file::parse(&text, "damaged.toml", None, &[]) {
            Ok(_) => accepted += 1,
            Err(found) => {
                assert!(!found.list.is_empty(), "{text}");
                let lines = text.lines().count() + 1;
                assert!(
                    found
                        .list
                        .iter()
                        .all(|problem| (1..=lines).contains(&problem.line_and_column().0)),
                    "{found}"
                );
                refused += 1;
            }
        }
    }
    assert!(refused > 500 && accepted > 500, "{refused} {accepted}");
}

#[test]
fn a_ramp_of_the_plant_that_takes_too_many_discretisations_is_refused() {
    let change = |ramp_s: &str| {
        format!(
            "{}\n[[plant_change]]\nat_s = 1.0\nramp_s = {ramp_s}\npreset = \"ctms-pitch\"\n",
            file::starter().replace("duration_s = 10.0", "duration_s = 2000.0")
        )
    };
    let found = problems(&change("1500.0"));
    assert_eq!(found.list[0].path, "plant_change[0].ramp_s", "{found}");
    assert!(file::parse(&change("1.0"), "x", None, &[]).is_ok());
}

#[test]
fn a_ramp_through_a_plant_without_effect_is_refused() {
    let plant = |sign: &str| format!("numerator = [{sign}1.0]\ndenominator = [1.0, 1.0, 0.0]\n");
    let text = file::starter().replace(
        "preset = \"navion-paper\"\n",
        &format!("{}elevator_sign = \"nose-up-positive\"\n", plant("")),
    );
    let found =
        problems(&format!("{text}\n[[plant_change]]\nat_s = 1.0\nramp_s = 1.0\n{}", plant("-")));
    assert_eq!(found.list[0].path, "plant_change[0].ramp_s", "{found}");
    // Wherever the flight ends and its samples lie; it used to be refused where a sample lay right there, with "the numerator
    // has no coefficients".
    let there = |at_s: f64, ramp_s: f64| {
        let change = format!("\n[[plant_change]]\nat_s = {at_s:?}\nramp_s = {ramp_s:?}\n");
        problems(&format!("{text}{change}{}", plant("-"))).to_string()
    };
    for (at_s, ramp_s, zero_s) in
        [(1.0, 1.013, "1.50"), (9.0, 30.0, "24.000 s"), (12.0, 2.0, "13.000 s")]
    {
        let told = there(at_s, ramp_s);
        assert!(told.contains("plant_change[0].ramp_s"), "{told}");
        assert!(told.contains("opposite senses") && told.contains(zero_s), "{told}");
    }
    // The next change ends the ramp before it comes there; a change at once needs no way.
    let short = "\n[[plant_change]]\nat_s = 1.0\nramp_s = 2.0\n";
    let back = "\n[[plant_change]]\nat_s = 1.5\n";
    let text = format!("{text}{short}{}{back}{}", plant("-"), plant(""));
    assert!(file::parse(&text, "x", None, &[]).is_ok());
    let at_once = text.replace("ramp_s = 2.0", "ramp_s = 0.0");
    assert!(file::parse(&at_once, "x", None, &[]).is_ok());
}

#[test]
fn a_plant_that_a_flight_does_not_come_to_is_told_at_its_place() {
    let told = |at_s: f64, ramp_s: f64| {
        let change = format!("[[plant_change]]\nat_s = {at_s:?}\nramp_s = {ramp_s:?}\n");
        let text = format!("{}\n{change}preset = \"navion-paper\"\n", file::starter());
        let study = file::parse(&text, "x", None, &[]).expect("allowed");
        study.warnings.iter().map(ToString::to_string).collect::<Vec<_>>().join("\n")
    };
    let judged_all_the_same = "after the flight's end at 10.0 s; the loop at rest is judged with";
    for (at_s, ramp_s, key) in [(9.0, 2.0, "ramp_s"), (11.0, 0.0, "at_s"), (11.0, 3.0, "at_s")] {
        let told = told(at_s, ramp_s);
        assert!(told.contains(&format!("plant_change[0].{key}")), "{told}");
        assert!(told.contains(judged_all_the_same), "{told}");
    }
    assert!(!told(8.0, 2.0).contains("plant_change"), "it is reached at the last sample");
}
