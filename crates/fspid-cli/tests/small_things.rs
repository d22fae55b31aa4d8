//! Small things that cost a user minutes, each once: what it did, and what it does.

use crate::common;

use std::process::{Command, Stdio};

use common::{code, fspid, json, started, text};

/// "rule \"amigo\"" gave gains without saying whose; for a self-tuner as if its supervisor were in them.
#[test]
fn a_rule_says_whose_gains_it_took_and_that_a_supervisor_is_not_used() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    assert_eq!(code(&fspid(&["init", "a.toml"], folder)), 0);
    let pid = text(&fspid(&["tune", "a.toml", "--rule", "amigo"], folder).stdout);
    assert!(pid.contains("for \"PID\":") && pid.contains("\"FSPID\" stays"), "{pid}");
    assert!(!pid.contains("supervisor"), "{pid}");
    let words = ["tune", "a.toml", "--rule", "amigo", "--controller", "FSPID"];
    let fspid_text = text(&fspid(&words, folder).stdout);
    assert!(fspid_text.contains("its supervisor is not used"), "{fspid_text}");
    let answer = json(&fspid(&[&words[..], &["--format", "json"]].concat(), folder));
    assert_eq!(answer["controller"], "FSPID");
    assert!(answer["supervisor"].as_str().is_some_and(|it| it.starts_with("not used")), "{answer}");
}

#[test]
fn all_controllers_are_tuned_alike_and_stand_side_by_side() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    assert_eq!(code(&fspid(&["init", "--template", "contest", "a.toml"], folder)), 0);
    let words = ["tune", "a.toml", "--all", "--budget", "30", "--quiet", "--out", "d.toml"];
    let tuned = fspid(&words, folder);
    let told = text(&tuned.stdout);
    let table = told.split_once("Side by side").map_or("", |(_, table)| table);
    for words in ["PID         FSPID", "iae_deg_s", "cost", "names no winner"] {
        assert!(table.contains(words), "{words}: {told}\n{}", text(&tuned.stderr));
    }
    for design in ["d-PID.toml", "d-FSPID.toml"] {
        assert_eq!(code(&fspid(&["check", design], folder)), 0, "{design}");
    }
    // A controller alone finds the same.
    let alone =
        fspid(&["tune", "a.toml", "--controller", "PID", "--budget", "30", "--quiet"], folder);
    assert!(told.starts_with(&text(&alone.stdout)), "{told}");
    let left = std::fs::read_dir(folder).expect("a folder").count();
    assert_eq!(left, 3, "no state stays when a search is over");
}

/// A search without a design kept nothing, and Ctrl-C said nothing.
#[cfg(unix)]
#[test]
fn an_interrupted_search_says_how_to_go_on_and_does() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    assert_eq!(code(&fspid(&["init", "--template", "tuning", "a.toml"], folder)), 0);
    let words = ["tune", "a.toml", "--budget", "10000000", "--quiet"];
    let child = Command::new(env!("CARGO_BIN_EXE_fspid"))
        .args(words)
        .current_dir(folder)
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    // The first generation is kept at once: from then on it can be interrupted.
    let state = folder.join("a.toml.PID.state.json");
    while !state.exists() {
        std::thread::yield_now();
    }
    let killed = Command::new("kill").args(["-INT", &child.id().to_string()]).status();
    assert!(killed.is_ok_and(|status| status.success()));
    let output = child.wait_with_output().expect("it ends");
    let told = text(&output.stderr);
    assert_eq!(code(&output), 130, "{told}");
    assert!(told.contains("the same command goes on from there: fspid tune a.toml"), "{told}");
    assert!(state.exists(), "its state stays beside the scenario");
    // Another search took its place, and removed it when it was over.
    let kept = std::fs::read(&state).expect("a state");
    let other = fspid(&["tune", "a.toml", "--budget", "12", "--seed", "2", "--quiet"], folder);
    let told = text(&other.stderr);
    assert!(code(&other) < 2 && told.contains("another search; it stays as it is"), "{told}");
    assert_eq!(std::fs::read(&state).expect("it is still there"), kept);
}

/// Only `tune` said so as JSON, and `learn` died without a word.
#[cfg(unix)]
#[test]
fn an_interrupted_command_says_so_as_json_too() {
    use std::io::Write as _;
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    assert_eq!(code(&fspid(&["init", "--template", "campaign", "a.toml"], folder)), 0);
    let more = "# A line that says nothing.\n".repeat(10_000);
    for (signal, words) in [
        ("-INT", "campaign run a.toml --runs 100000000 --quiet --out c"),
        ("-TERM", "campaign search - --measure overshoot_pct"),
        ("-TERM", "learn - --teacher mirrored --range 1 --points 3,3 --out l.toml"),
        ("-TERM", "simulate -"),
    ] {
        let arguments: Vec<&str> = words.split(' ').chain(["--format", "json"]).collect();
        let mut child = started(&arguments, folder);
        // Kept open: the program waits for the rest. More than a pipe holds has gone when it listens.
        let mut input = child.stdin.take().expect("standard input");
        match words.contains(" - ") || words.ends_with(" -") {
            true => input.write_all(more.as_bytes()).expect("it reads"),
            false => {
                while !folder.join("c/campaign.json").exists() {
                    std::thread::yield_now();
                }
            }
        }
        let killed = Command::new("kill").args([signal, &child.id().to_string()]).status();
        assert!(killed.is_ok_and(|status| status.success()));
        let output = child.wait_with_output().expect("it ends");
        assert_eq!(code(&output), 130, "{words}: {}", text(&output.stderr));
        let error = &json(&output)["error"];
        assert_eq!(
            (error["code"].as_i64(), error["kind"].as_str()),
            (Some(130), Some("interrupted"))
        );
        assert!(text(&output.stderr).contains("fspid: interrupted"), "{words}");
    }
}

#[test]
fn every_source_and_every_spelling_of_inputs_goes_with_infer_explain_and_surface() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    for (template, file) in
        [("pitch-hold", "a.toml"), ("fuzzy-system", "tip.toml"), ("rule-table", "rules.toml")]
    {
        assert_eq!(code(&fspid(&["init", "--template", template, file], folder)), 0);
    }
    let of_supervisor = ["--error 1 --change -2", "--input error=1 --input change=-2"];
    let sources = [
        "printed --range 5",
        "--table mirrored --range 5",
        "rules.toml --range 5",
        "--table rules.toml --range 5",
        "a.toml",
    ];
    for source in sources {
        let mut answers = Vec::new();
        for inputs in of_supervisor {
            for command in ["infer", "explain"] {
                let words = format!("{command} {source} {inputs} --format json");
                let output = fspid(&words.split(' ').collect::<Vec<_>>(), folder);
                assert_eq!(code(&output), 0, "{words}: {}", text(&output.stderr));
                answers.push((command, text(&output.stdout)));
            }
        }
        assert_eq!(answers[1], answers[3], "{source}: two spellings, one answer");
        let words = format!("surface {source} --output delta_kp --nodes 3 --out s.svg");
        let output = fspid(&words.split(' ').collect::<Vec<_>>(), folder);
        assert_eq!(code(&output), 0, "{words}: {}", text(&output.stderr));
    }
    for words in [
        "infer tip.toml --input service=7 --input food=8",
        "explain tip.toml --input service=7 --input food=8",
        "surface tip.toml --x service --input food=8 --out s.svg",
    ] {
        let output = fspid(&words.split(' ').collect::<Vec<_>>(), folder);
        assert_eq!(code(&output), 0, "{words}: {}", text(&output.stderr));
    }
}

/// The first example of its help was "not evaluated" 8 of 8: the command has a step of another size.
#[test]
fn a_ready_set_brings_its_own_step() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    assert_eq!(code(&fspid(&["init", "a.toml"], folder)), 0);
    let words = ["verify", "a.toml", "--set", "ctms", "--replay", "again", "--junit", "j.xml"];
    let verified = fspid(&words, folder);
    let told = text(&verified.stdout);
    // The starter has a load in its flight, which the overshoot of the PID and of the FSPID does not bear.
    assert!(told.contains("6 of 8 requirements met; FAIL"), "{told}");
    assert!(!told.contains("not evaluated"), "{told}");
    assert!(told.contains("Judged on a flight of their own"), "{told}");
    let answer = json(&fspid(&[&words[..], &["--format", "json"]].concat(), folder));
    let line = &answer["requirements"][0];
    assert!(line["own_flight"]["step_deg"].as_f64().is_some_and(|deg| (deg - 11.459).abs() < 1e-3));
    // The replay of a line gives its number again, with the step in its own command.
    let replay = line["replay"].as_str().expect("a file");
    let again = json(&fspid(&["verify", replay, "--format", "json"], folder));
    assert_eq!(again["requirements"][0]["value"], line["value"]);
    assert!(again["requirements"][0]["own_flight"].is_null(), "{again}");
    // JUnit has the number, its limit and how far it is from it.
    let junit = std::fs::read_to_string(folder.join("j.xml")).expect("written");
    let value = line["value"].as_f64().expect("a number");
    for (name, value) in [
        ("value", value),
        ("most", 10.0),
        ("margin", 10.0 - value),
        ("own_flight_step_deg", 11.459155902616466),
    ] {
        let property = format!("<property name=\"{name}\" value=\"{value:?}\"/>");
        assert!(junit.contains(&property), "{property}: {junit}");
    }
}

/// `fspid: entry 0 of the matrix is -inf` named nothing of the file.
#[test]
fn a_number_that_overflows_is_told_by_its_key() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    assert_eq!(code(&fspid(&["init", "a.toml"], folder)), 0);
    for (command, set, key) in [
        ("simulate", "controller.PID.kd=1e308", "found: 1e308; allowed: -1e100 to 1e100"),
        ("analyse", "controller.PID.kd=-1e308", "-1e100 to 1e100"),
        ("check", "actuator.time_constant_s=1e-310", "actuator.time_constant_s: so short"),
    ] {
        let output = fspid(&[command, "a.toml", "--set", set], folder);
        let told = text(&output.stderr);
        assert!(code(&output) == 2 && told.contains(key), "{command}: {told}");
        assert!(!told.contains("matrix") && !told.contains("vector"), "{told}");
    }
}

/// Least squares that were judged by rows beyond all numbers ended with code 0.
/// A Navion of 100 g was refused for being "a nonlinear aircraft", of which the outer loops are analysed as well.
#[test]
fn an_aircraft_that_leaves_its_trim_at_once_is_refused_with_that_and_its_time() {
    let words = ["altitude-capture.toml", "--set", "aircraft.mass_kg=0.1"];
    let gallery = std::path::Path::new(crate::accepted::SCENARIOS).join("gallery");
    let analysed = fspid(&[&["analyse"], &words[..]].concat(), &gallery);
    let told = text(&analysed.stderr);
    assert_eq!(code(&analysed), 2, "{told}");
    assert!(told.contains("begun at its trim in mode 1 of the autopilot"), "{told}");
    assert!(told.contains("diverges at t = 0.0"), "{told}");
    assert!(!told.contains("no linear loop"), "{told}");
}

#[test]
fn an_error_of_validation_that_is_infinite_is_a_failure_with_words() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let rows = |answer: &str| {
        let mut rows = String::from("error,change,delta_kp,delta_ki,delta_kd\n");
        for i in 0..15 {
            for j in 0..15 {
                let (e, c) = (f64::from(i - 7) / 7.0, f64::from(j - 7) / 7.0);
                let kp = if (i, j) == (3, 4) { answer.to_owned() } else { format!("{}", e * c) };
                rows.push_str(&format!("{e},{c},{kp},0,0\n"));
            }
        }
        rows
    };
    let learn = |seed: &str| {
        let words = format!(
            "learn sugeno-grid --range 1 --sets-stay --data d.csv --validate 0.3 --seed {seed} --out l.toml"
        );
        fspid(&words.split(' ').collect::<Vec<_>>(), folder)
    };
    std::fs::write(folder.join("d.csv"), rows("0")).expect("written");
    assert_eq!(code(&learn("1")), 0);
    std::fs::remove_file(folder.join("l.toml")).expect("it was written");
    std::fs::write(folder.join("d.csv"), rows("1e200")).expect("written");
    // The row judges with some seeds, and is learned from with others, where it overflows too.
    let mut told = String::new();
    for seed in 1..=8 {
        let output = learn(&seed.to_string());
        assert_eq!(code(&output), 2, "seed {seed}: {}", text(&output.stdout));
        told.push_str(&text(&output.stderr));
    }
    assert!(told.contains("the error of the rows for validation is no finite number"), "{told}");
    assert!(!folder.join("l.toml").exists());
}

/// The page of a flight in turbulence spoke of bands and tuners that it did not have.
#[test]
fn the_caption_of_a_report_names_what_is_drawn() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let caption = |template: &str, sets: &[&str]| {
        let file = format!("{template}.toml");
        assert_eq!(code(&fspid(&["init", "--template", template, &file], folder)), 0);
        let mut words = vec!["simulate", &file, "--report", "r.html"];
        sets.iter().for_each(|set| words.extend(["--set", set]));
        assert!(code(&fspid(&words, folder)) < 2);
        let page = std::fs::read_to_string(folder.join("r.html")).expect("written");
        let captions = page.split("From above: ").skip(1);
        let captions = captions.filter_map(|rest| rest.split_once('.').map(|(caption, _)| caption));
        captions.collect::<Vec<_>>().join("; ")
    };
    let gusts = caption("aircraft-in-turbulence", &["loop.duration_s=2"]);
    assert!(gusts.contains("airspeed, altitude") && !gusts.contains("bands"), "{gusts}");
    let step = caption("pitch-hold", &[]);
    assert!(
        step.contains("bands of 2 %")
            && step.contains("the gains kp, ki and kd of the self-tuning"),
        "{step}"
    );
    let alone = caption("tuning", &[]);
    assert!(alone.contains("bands of 2") && !alone.contains("gains"), "{alone}");
}

#[test]
fn every_path_is_listed_with_its_unit_value_and_range() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    assert_eq!(code(&fspid(&["init", "a.toml"], folder)), 0);
    let answer = json(&fspid(&["check", "a.toml", "--paths", "--format", "json"], folder));
    let rows = answer["paths"].as_array().expect("rows");
    let row = |path: &str| rows.iter().find(|row| row["path"] == path).expect(path);
    let kp = row("controller.PID.kp");
    assert_eq!((kp["dispersion"].as_bool(), kp["mark"].as_bool()), (Some(true), Some(true)));
    let rate = row("actuator.rate_limit_deg_s");
    assert!(rate["value"].is_null() && rate["unit"] == "deg/s", "{rate}");
    assert_eq!(row("plant.preset.numerator[0]")["mark"], false, "no mark stands in a file");
    assert!(rows.iter().all(|row| row["allowed"].as_str().is_some_and(|it| !it.is_empty())));
    assert!(
        !rows.iter().any(|row| row["path"].as_str().is_some_and(|it| it.starts_with("aircraft")))
    );
    // What the list says may be set can be set: to the value that it has, default or not.
    let sets: Vec<String> = rows
        .iter()
        .filter(|row| !row["value"].is_null())
        .map(|row| format!("{}={}", row["path"].as_str().expect("a path"), row["value"]))
        .collect();
    assert!(sets.len() > 60, "{sets:?}");
    for set in &sets {
        let output = fspid(&["check", "a.toml", "--set", set], folder);
        assert_eq!(code(&output), 0, "{set}: {}", text(&output.stderr));
    }
    // Numbers are numbers, with their limits; kinds and what belongs to them stand there too.
    assert_eq!((kp["value"].as_f64(), &kp["schema"]["type"]), (Some(1.0), &"number".into()));
    assert_eq!(row("loop.sample_period_s")["schema"]["exclusiveMinimum"], 0);
    assert_eq!(row("disturbance[0].kind")["value"], "step");
    for absent in ["wind.speed_m_s", "controller.PID.anti_windup.tracking_s", "sensor.seed"] {
        assert!(row(absent)["value"].is_null() && row(absent)["dispersion"] == false, "{absent}");
    }
    assert_eq!(row("controller.PID.name")["dispersion"], false);
    let table = text(&fspid(&["check", "a.toml", "--paths"], folder).stdout);
    assert!(table.starts_with("--set takes every path"), "{table}");
    assert!(table.lines().count() > 60 && table.contains("controller.FSPID.nominal.kp"), "{table}");
}

/// Nine problems of a scenario were told of a rule table.
#[test]
fn a_file_that_is_no_scenario_is_called_what_it_is() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    for (template, what) in [("rule-table", "a rule table"), ("fuzzy-system", "a fuzzy system")] {
        assert_eq!(code(&fspid(&["init", "--template", template, "x.toml"], folder)), 0);
        for words in ["check x.toml --paths", "simulate x.toml", "verify x.toml", "tune x.toml"] {
            let output = fspid(&words.split(' ').collect::<Vec<_>>(), folder);
            let told = text(&output.stderr);
            assert!(code(&output) == 2 && told.lines().count() < 4, "{words}: {told}");
            assert!(told.contains(&format!("this is {what}, and not a scenario")), "{told}");
        }
        std::fs::remove_file(folder.join("x.toml")).expect("it is there");
    }
    let data = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data");
    for (file, what) in [
        ("aircraft/navion.toml", "an aircraft"),
        ("plants/b747-paper.toml", "a plant"),
        ("requirements/rvsm.toml", "a set of requirements"),
    ] {
        let path = data.join(file).display().to_string();
        for command in ["analyse", "simulate"] {
            let output = fspid(&[command, &path], folder);
            let told = text(&output.stderr);
            assert!(code(&output) == 2 && told.lines().count() < 4, "{command} {file}: {told}");
            assert!(told.contains(&format!("this is {what}, and not a scenario")), "{told}");
        }
    }
}

/// "This is a fuzzy system" of a report.
#[test]
fn a_page_is_not_called_a_fuzzy_system() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    std::fs::write(folder.join("a.html"), "<!DOCTYPE html>\n<html></html>\n").expect("written");
    std::fs::write(folder.join("a.svg"), "<?xml version=\"1.0\"?>\n<svg/>\n").expect("written");
    for (file, what) in [("a.html", "HTML"), ("a.svg", "XML")] {
        for command in ["simulate", "certify", "check"] {
            let output = fspid(&[command, file], folder);
            let told = text(&output.stderr);
            assert_eq!(code(&output), 2, "{told}");
            assert!(told.contains(&format!("this is {what}, and not a scenario")), "{told}");
            assert!(told.contains("a scenario, which is TOML"), "{told}");
        }
    }
}

/// "to pass '--controller' as a value, use '-- --controller'", which no command takes.
#[test]
fn an_option_that_a_command_lacks_is_not_told_to_be_a_file() {
    let folder = tempfile::tempdir().expect("a folder");
    let output = fspid(&["analyse", "a.toml", "--controller", "PID"], folder.path());
    let told = text(&output.stderr);
    assert_eq!(code(&output), 2, "{told}");
    assert!(
        told.contains("unexpected argument '--controller'") && !told.contains("tip:"),
        "{told}"
    );
    assert!(told.contains("\n\nUsage: fspid analyse"), "{told}");
    // Other advice stays.
    let output = fspid(&["simulate", "a.toml", "--reprot", "a.html"], folder.path());
    assert!(text(&output.stderr).contains("'--report'"), "{}", text(&output.stderr));
}

/// "unexpected argument '2' found", and of other tools that each target was unknown.
#[test]
fn what_a_newcomer_writes_is_told_as_it_is_written_here() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    assert_eq!(code(&fspid(&["init", "a.toml"], folder)), 0);
    let told = |words: &str| {
        let output = fspid(&words.split(' ').collect::<Vec<_>>(), folder);
        assert_eq!(code(&output), 2, "{words}: {}", text(&output.stdout));
        text(&output.stderr)
    };
    for (words, expected) in [
        (
            "check a.toml --set controller.PID.kp 2",
            "fspid: --set takes one word: controller.PID.kp=2\n",
        ),
        (
            "check --set controller.PID.kp 2 a.toml",
            "fspid: --set takes one word: controller.PID.kp=2\n",
        ),
        ("check a.toml --set controller.FSPID.kp=2", "did you mean `nominal.kp`?"),
        ("export a.toml --to px4 --out o", "PX4 takes the C of `--to c`"),
        ("export a.toml --to ArduPilot --out o", "ArduPilot takes a script, `--to lua`"),
        ("export a.toml --to c++ --out o", "C++ takes the C of `--to c`"),
        ("contest a.toml --out o", "fspid init --template contest"),
    ] {
        let told = told(words);
        assert!(told.contains(expected), "{words}: {told}");
    }
    let analysed = fspid(&["analyze", "a.toml"], folder);
    assert_eq!(code(&analysed), 0, "{}", text(&analysed.stderr));
    let help = text(&fspid(&["check", "--help"], folder).stdout);
    let (own, of_every) = help.split_once("Options of every command:").expect("a heading");
    assert!(!own.contains("--max-memory") && of_every.contains("--max-memory"), "{help}");
}

/// "it is no regular file".
#[cfg(unix)]
#[test]
fn standard_input_by_the_name_of_its_device_is_told_as_it_is_written_here() {
    let output = fspid(&["check", "/dev/stdin"], std::path::Path::new("."));
    assert_eq!(code(&output), 2, "{}", text(&output.stdout));
    assert_eq!(text(&output.stderr), "fspid: /dev/stdin: standard input is `-`\n");
}

#[test]
fn a_contest_says_how_long_it_takes_and_its_page_has_reasons_in_a_table() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    assert_eq!(code(&fspid(&["init", "--template", "contest", "a.toml"], folder)), 0);
    let words = "contest a.toml --budget 4 --seeds 1 --out who --set requirement[0].most=0.001";
    let held = fspid(&words.split(' ').collect::<Vec<_>>(), folder);
    let told = text(&held.stderr);
    assert_eq!(code(&held), 0, "{told}");
    assert!(told.contains("2 controllers tuned with 4 candidates each: about "), "{told}");
    let page = std::fs::read_to_string(folder.join("who/contest.html")).expect("written");
    let (_, reasons) = page.split_once("Why flights failed").expect("a heading");
    let table = reasons.split_once("</table>").map_or("", |(table, _)| table);
    for words in ["<table", "flight conditions", "commands", "FSPID", "overshoot_pct"] {
        assert!(table.contains(words), "{words}: {table}");
    }
    assert!(!table.contains("<li>"), "{table}");
}

/// "fspid 0.1.0" was all that a report of a wrong verdict could say of the program.
#[test]
fn the_long_version_tells_commit_machine_compiler_and_the_schemas_that_are_written() {
    let folder = tempfile::tempdir().expect("a folder");
    let told = text(&fspid(&["--version"], folder.path()).stdout);
    let lines: Vec<&str> = told.lines().collect();
    let [version, commit, machine, schemas] = lines[..] else { panic!("{told}") };
    assert_eq!(version, concat!("fspid ", env!("CARGO_PKG_VERSION")));
    assert!(commit.starts_with("commit ") || commit == "of no known commit", "{told}");
    assert!(machine.contains(std::env::consts::ARCH) && machine.contains("rustc"), "{told}");
    let certificates = format!("certificates of schema {}", fspid_certify::SCHEMA);
    assert!(schemas.contains(&certificates), "{told}");
    let refused = json(&fspid(&["check", "none.toml", "--format", "json"], folder.path()));
    assert!(schemas.contains(&format!("answers of schema {}", refused["schema"])), "{told}");
    let short = text(&fspid(&["-V"], folder.path()).stdout);
    assert_eq!(short.trim_end(), version);
}

/// Both said that they had written it, and one of the two files was gone.
#[test]
fn of_two_that_begin_one_file_at_once_one_is_told() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    for round in 0..8 {
        let file = format!("a{round}.toml");
        let begun = ["pitch-hold", "campaign"].map(|template| {
            started(&["init", &file, "--template", template, "--format", "json"], folder)
        });
        let ended = begun.map(|child| child.wait_with_output().expect("it ends"));
        let wrote = ended.iter().filter(|output| code(output) == 0);
        let told: Vec<String> = wrote.map(|output| text(&output.stdout)).collect();
        let [told] = told.as_slice() else { panic!("{ended:?}") };
        let campaign = std::fs::read_to_string(folder.join(&file)).expect("a file");
        assert_eq!(told.contains("\"campaign\""), campaign.contains("[[dispersion]]"), "{told}");
    }
}

/// The whole search was flown first.
#[test]
fn a_folder_in_the_place_of_a_design_is_refused_before_anything_is_searched() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    assert_eq!(code(&fspid(&["init", "--template", "tuning", "a.toml"], folder)), 0);
    std::fs::create_dir(folder.join("there")).expect("a folder");
    let output = fspid(&["tune", "a.toml", "--budget", "10000000", "--out", "there"], folder);
    assert_eq!(code(&output), 4);
    assert!(text(&output.stderr).contains("it is a folder"), "{}", text(&output.stderr));
    assert!(!folder.join("there.state.json").exists());
}

/// Git and stores do not keep empty folders.
#[test]
fn a_plan_that_comes_without_its_empty_folder_is_flown() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    assert_eq!(code(&fspid(&["init", "--template", "campaign", "a.toml"], folder)), 0);
    let plan = ["campaign", "plan", "a.toml", "--runs", "4", "--shard-runs", "2", "--out", "plan"];
    assert_eq!(code(&fspid(&plan, folder)), 0);
    std::fs::remove_dir(folder.join("plan/shards")).expect("it is empty");
    for number in ["1", "0"] {
        let output = fspid(&["campaign", "shard", number, "--quiet", "--out", "plan"], folder);
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    }
    assert_eq!(code(&fspid(&["campaign", "merge", "--out", "plan"], folder)), 0);
}

/// A controller of which a requirement asks nothing has no share of flights, and a note may be of no measure: the published
/// schema had a number and a key there.
#[test]
fn reports_of_campaigns_of_the_templates_are_what_their_schema_says() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let drawn =
        "\n[[dispersion]]\npath = \"loop.duration_s\"\ndistribution = \"choice\"\nvalues = [3.0]\n";
    for template in ["requirements", "pitch-hold"] {
        assert_eq!(code(&fspid(&["init", "--template", template, "a.toml"], folder)), 0);
        let file = folder.join("a.toml");
        let written = std::fs::read_to_string(&file).expect("written");
        std::fs::write(&file, format!("{written}{drawn}")).expect("written");
        let run = ["campaign", "run", "a.toml", "--runs", "4", "--quiet", "--out", template];
        assert_eq!(code(&fspid(&run, folder)), 0, "{template}");
        // Each answer is held against its schema.
        let report = json(&fspid(&["campaign", "report", template, "--format", "json"], folder));
        if template == "pitch-hold" {
            assert_eq!(report["notes"][0]["note"], "nothing-required", "{report}");
            continue;
        }
        let lines = report["controllers"][0]["requirements"].as_array().expect("a list");
        let other = lines.iter().find(|line| line["id"] == "R-4").expect("of the FSPID alone");
        assert!(other["not_met"]["estimate"].is_null() && other["not_judged"] == 4, "{other}");
        std::fs::remove_file(&file).expect("removed");
    }
}
