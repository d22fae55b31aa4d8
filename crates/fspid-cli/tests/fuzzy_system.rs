//! Fuzzy systems as people and scripts meet them on the command line.

use std::io::{BufRead as _, BufReader, Write as _};
use std::path::Path;
use std::process::{Command, Output, Stdio};

use serde_json::Value;

fn command(arguments: &[&str], folder: &Path) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_fspid"));
    command.args(arguments).current_dir(folder);
    command
}

fn fspid(arguments: &[&str], folder: &Path) -> Output {
    command(arguments, folder).output().expect("the program starts")
}

/// A folder with the example of a tip in it.
fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let tip = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/systems/tip.toml");
    std::fs::copy(tip, folder.path().join("tip.toml")).expect("copied");
    folder
}

fn code(output: &Output) -> i32 {
    output.status.code().expect("an exit code")
}

fn stdout(output: &Output) -> String {
    String::from_utf8(output.stdout.clone()).expect("UTF-8")
}

fn stderr(output: &Output) -> String {
    String::from_utf8(output.stderr.clone()).expect("UTF-8")
}

fn json(output: &Output) -> Value {
    assert_eq!(code(output), 0, "{}", stderr(output));
    serde_json::from_str(&stdout(output)).expect("JSON on standard output")
}

#[test]
fn infer_answers_by_names_and_says_which_rule_was_used() {
    let folder = folder();
    let ask = |more: &[&str]| {
        let mut arguments = vec!["infer", "tip.toml", "--input", "service=3", "--input", "food=8"];
        arguments.extend(more);
        fspid(&arguments, folder.path())
    };
    let answer = json(&ask(&["--format", "json"]));
    let tip = &answer["outputs"]["tip"];
    assert_eq!((&tip["rule"], &tip["source"]), (&"centroid, exact".into(), &"rules".into()));
    let value = tip["value"].as_f64().expect("a number");
    assert!(stdout(&ask(&[])).contains(&format!("{value:.12}")));
    let sampled = json(&ask(&["--defuzzifier", "endpoints:101", "--format", "json"]));
    assert_eq!(sampled["outputs"]["tip"]["rule"], "centroid, endpoints:101");
    let refused = fspid(
        &[
            "infer",
            "tip.toml",
            "--input",
            "service=3",
            "--input",
            "food=80",
            "--out-of-range",
            "error",
        ],
        folder.path(),
    );
    assert_eq!(code(&refused), 2);
    assert!(stderr(&refused).contains("food is 80.0; allowed is 0.0 to 10.0"));
}

#[test]
fn a_shipped_rule_table_is_a_system_with_a_range() {
    let folder = folder();
    let question = ["--input", "error=1", "--input", "change=-2", "--format", "json"];
    let general = json(&fspid(
        &[&["infer", "printed", "--range", "5"], &question[..]].concat(),
        folder.path(),
    ));
    let old = json(&fspid(
        &["infer", "--range", "5", "--error", "1", "--change", "-2", "--format", "json"],
        folder.path(),
    ));
    for name in ["delta_kp", "delta_ki", "delta_kd"] {
        assert_eq!(general["outputs"][name]["value"], old[name]);
    }
    let missing = fspid(&[&["infer", "printed"], &question[..]].concat(), folder.path());
    assert_eq!(code(&missing), 2);
    assert!(stderr(&missing).contains("needs --range"));
}

#[test]
fn a_mistake_in_a_file_ends_with_two_and_its_place() {
    let folder = folder();
    let text = std::fs::read_to_string(folder.path().join("tip.toml")).expect("read");
    let bad = text.replace("food is rancid", "food is ranzid");
    std::fs::write(folder.path().join("bad.toml"), bad).expect("written");
    for command in [
        &["check", "bad.toml"][..],
        &["infer", "bad.toml", "--input", "service=1", "--input", "food=1"],
        &["convert", "bad.toml", "out.fis"],
        &["surface", "bad.toml"],
        &["explain", "bad.toml", "--input", "service=1"],
        &["audit", "bad.toml"],
    ] {
        let output = fspid(command, folder.path());
        assert_eq!((code(&output), stdout(&output).len()), (2, 0), "{command:?}");
        let message = stderr(&output);
        assert!(
            message.contains("bad.toml:") && message.contains("did you mean `rancid`?"),
            "{message}"
        );
    }
    assert!(!folder.path().join("out.fis").exists());
}

#[test]
fn a_file_of_points_is_answered_whole_or_not_at_all() {
    let folder = folder();
    std::fs::write(folder.path().join("p.csv"), "food,note,service\n8,x,3\n1,y,9\n")
        .expect("written");
    let output = fspid(&["infer", "tip.toml", "--points", "p.csv"], folder.path());
    assert_eq!(code(&output), 0, "{}", stderr(&output));
    let text = stdout(&output);
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!((lines.len(), lines[0]), (3, "service,food,tip"));
    assert!(lines[1].starts_with("3.0,8.0,"));
    std::fs::write(folder.path().join("p.csv"), "food,service\n8,3\n1,x\n2,3\n").expect("written");
    let output = fspid(&["infer", "tip.toml", "--points", "p.csv"], folder.path());
    assert_eq!((code(&output), stdout(&output).len()), (2, 0));
    assert!(stderr(&output).contains("p.csv:3: service is `x`"), "{}", stderr(&output));
    let missing = fspid(&["infer", "tip.toml", "--points", "nowhere.csv"], folder.path());
    assert_eq!(code(&missing), 2);
    assert!(
        stderr(&missing).contains("nowhere.csv: cannot be read: there is no such file"),
        "{}",
        stderr(&missing)
    );
}

/// The program answering a stream, with both its ends.
fn streaming(folder: &Path) -> std::process::Child {
    command(&["infer", "tip.toml", "--points", "-"], folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts")
}

/// Answers come while questions are still being asked, so the program cannot hold the table; the
/// pipes between hold some 64 KiB each.
#[test]
fn three_hundred_thousand_rows_are_answered_as_they_come() {
    const ROWS: u32 = 300_000;
    let folder = folder();
    let mut child = streaming(folder.path());
    let mut questions = child.stdin.take().expect("a pipe");
    let mut answers = BufReader::new(child.stdout.take().expect("a pipe"));
    let row =
        |n: u32| format!("{},{}\n", f64::from(n % 100) / 10.0, f64::from(n / 100 % 100) / 10.0);
    let half = ROWS / 2;
    questions.write_all(b"service,food\n").expect("taken");
    let (halfway, first_half_answered) = std::sync::mpsc::channel();
    let asker = std::thread::spawn(move || {
        for n in 0..half {
            questions.write_all(row(n).as_bytes()).expect("taken");
        }
        // The second half is asked only after answers to the first were read.
        first_half_answered.recv().expect("answers come before all questions are asked");
        for n in half..ROWS {
            questions.write_all(row(n).as_bytes()).expect("taken");
        }
    });
    let mut line = String::new();
    let mut count = 0_u32;
    while answers.read_line(&mut line).expect("UTF-8") > 0 {
        count += 1;
        if count == half / 2 {
            halfway.send(()).expect("the asker waits");
        }
        line.clear();
    }
    asker.join().expect("all was asked");
    assert_eq!(count, ROWS + 1);
    assert!(child.wait().expect("it ends").success());
}

#[test]
fn a_bad_row_of_a_stream_ends_with_two_and_the_number_of_answered_rows() {
    let folder = folder();
    let mut child = streaming(folder.path());
    let mut questions = child.stdin.take().expect("a pipe");
    questions.write_all(b"service,food\n1,2\n3,4\n5,bad\n7,8\n").expect("taken");
    drop(questions);
    let output = child.wait_with_output().expect("it ends");
    assert_eq!((code(&output), stdout(&output).lines().count()), (2, 3));
    let message = stderr(&output);
    assert!(message.contains("-:4: food is `bad`; allowed is a number"), "{message}");
    assert!(message.contains("2 rows were answered before the first problem"), "{message}");
}

#[test]
fn a_reader_that_has_gone_away_is_a_silent_end() {
    let folder = folder();
    let mut child = streaming(folder.path());
    let mut questions = child.stdin.take().expect("a pipe");
    drop(child.stdout.take());
    questions.write_all(b"service,food\n").expect("taken");
    for _ in 0..50_000 {
        if questions.write_all(b"1,2\n").is_err() {
            break;
        }
    }
    drop(questions);
    let output = child.wait_with_output().expect("it ends");
    assert_eq!((code(&output), stderr(&output).as_str()), (0, ""));
}

#[test]
fn the_old_form_reads_a_stream_too() {
    let folder = folder();
    let mut child = command(&["infer", "--range", "5", "--points", "-"], folder.path())
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .spawn()
        .expect("the program starts");
    child.stdin.take().expect("a pipe").write_all(b"e,ec\n1,-2\n").expect("taken");
    let output = child.wait_with_output().expect("it ends");
    let text = stdout(&output);
    assert_eq!(text.lines().next(), Some("e,ec,delta_kp,delta_ki,delta_kd"));
    assert!(text.contains("1.0000000000000000e0,-2.0000000000000000e0,9.9595815863"), "{text}");
}

#[test]
fn surface_draws_a_file_a_folder_and_a_table() {
    let folder = folder();
    let one =
        fspid(&["surface", "tip.toml", "--out", "tip.svg", "--csv", "tip.csv"], folder.path());
    assert_eq!(code(&one), 0, "{}", stderr(&one));
    let svg = std::fs::read_to_string(folder.path().join("tip.svg")).expect("written");
    assert!(svg.starts_with("<svg") && svg.contains(">service<"));
    let csv = std::fs::read_to_string(folder.path().join("tip.csv")).expect("written");
    assert_eq!((csv.lines().next(), csv.lines().count()), (Some("service,food,tip"), 81 * 81 + 1));
    let curve = fspid(&["surface", "tip.toml", "--fix", "food=8", "--csv", "-"], folder.path());
    assert!(stdout(&curve).starts_with("service,tip\n0.0,"));
    let several = fspid(&["surface", "printed", "--range", "5"], folder.path());
    assert_eq!(code(&several), 2);
    assert!(stderr(&several).contains("delta_kp, delta_ki, delta_kd"));
    let all = fspid(
        &["surface", "printed", "--range", "5", "--nodes", "9", "--out", "all"],
        folder.path(),
    );
    assert_eq!(code(&all), 0, "{}", stderr(&all));
    assert_eq!(std::fs::read_dir(folder.path().join("all")).expect("made").count(), 3);
    let wrong = fspid(&["surface", "tip.toml", "--x", "fod"], folder.path());
    assert!(code(&wrong) == 2 && stderr(&wrong).contains("did you mean `food`?"));
}

#[test]
fn convert_tells_losses_and_writes_nothing_where_they_are_not_allowed() {
    let folder = folder();
    let path = folder.path().join("tip.fis");
    let refused = fspid(&["convert", "tip.toml", "tip.fis"], folder.path());
    assert_eq!(code(&refused), 2);
    assert!(!path.exists() && stderr(&refused).contains("--lossy"), "{}", stderr(&refused));
    let lossy = fspid(&["convert", "tip.toml", "tip.fis", "--lossy"], folder.path());
    assert_eq!((code(&lossy), stdout(&lossy).len()), (0, 0), "{}", stderr(&lossy));
    assert!(path.exists() && stderr(&lossy).contains("lost: "), "{}", stderr(&lossy));
    let back = fspid(&["convert", "tip.fis", "back.toml"], folder.path());
    assert_eq!(code(&back), 0, "{}", stderr(&back));
    assert!(
        stderr(&back).contains("warning: tip.fis: answers by MATLAB's rule"),
        "{}",
        stderr(&back)
    );
    let ask = |file: &str| {
        json(&fspid(
            &["infer", file, "--input", "service=3", "--input", "food=8", "--format", "json"],
            folder.path(),
        ))
    };
    assert_eq!(ask("tip.fis")["outputs"], ask("back.toml")["outputs"]);
    for (arguments, part) in [
        (
            &["convert", "tip.toml", "tip.txt"][..],
            "unknown ending; known are .toml, .fis, .t2fis, .fcl, .fll, .xml",
        ),
        (&["convert", "tip.toml", "tip.fis", "--to", "iec"], "goes with an .fcl file"),
        (&["convert", "nowhere.fcl", "tip.toml"], "there is no such file"),
    ] {
        let output = fspid(arguments, folder.path());
        assert!(code(&output) == 2 && stderr(&output).contains(part), "{}", stderr(&output));
    }
    let unwritable = fspid(&["convert", "tip.toml", "missing/tip.toml"], folder.path());
    assert_eq!(code(&unwritable), 4);
}

/// It was advised as well where it helps nothing: a hedge has no word in the standard, and no nearest one.
#[test]
fn lossy_is_advised_where_it_helps_and_nowhere_else() {
    let folder = folder();
    for format in ["fis", "t2fis", "fcl", "fll", "xml"] {
        let out = format!("out.{format}");
        let strict = fspid(&["convert", "tip.toml", &out], folder.path());
        let lossy = fspid(&["convert", "tip.toml", &out, "--lossy"], folder.path());
        let is_advised = stderr(&strict).contains("--lossy");
        assert_eq!(is_advised, code(&strict) != 0 && code(&lossy) == 0, "{}", stderr(&strict));
        assert!(!stderr(&lossy).contains("--lossy"), "{}", stderr(&lossy));
        assert!(code(&lossy) == 0 || stderr(&lossy).contains(".toml file") || format == "t2fis");
    }
}

#[test]
fn every_format_comes_back_with_the_answers_of_the_file_that_was_written() {
    let folder = folder();
    for file in ["tip.fll", "tip.fcl", "tip.fis", "tip.xml", "tip2.toml"] {
        let written = fspid(&["convert", "tip.toml", file, "--lossy"], folder.path());
        if file == "tip.fcl" && code(&written) != 0 {
            // A hedge has no word in the standard; fuzzylite's dialect has one.
            let other = fspid(
                &["convert", "tip.toml", file, "--lossy", "--to", "fuzzylite"],
                folder.path(),
            );
            assert_eq!(code(&other), 0, "{}", stderr(&other));
        }
        let back = fspid(&["convert", file, "back.toml"], folder.path());
        assert_eq!(code(&back), 0, "{file}: {}", stderr(&back));
        let ask = |file: &str| {
            json(&fspid(
                &["infer", file, "--input", "service=7", "--input", "food=8.5", "--format", "json"],
                folder.path(),
            ))["outputs"]["tip"]["value"]
                .clone()
        };
        assert_eq!(ask(file), ask("back.toml"), "{file}");
    }
}

#[test]
fn explain_shares_an_answer_out_and_says_why_not_another() {
    let folder = folder();
    let ask = |more: &[&str]| {
        let mut arguments =
            vec!["explain", "tip.toml", "--input", "service=3", "--input", "food=8"];
        arguments.extend(more);
        fspid(&arguments, folder.path())
    };
    let found = json(&ask(&["--format", "json", "--why-not", "tip=cheap"]));
    let shares = &found["shares"]["tip"];
    let parts: f64 = shares["rules"]
        .as_array()
        .expect("a list")
        .iter()
        .filter_map(|share| share["area_share"].as_f64())
        .sum();
    assert!((parts - 1.0).abs() < 1e-12);
    let (sum, value) = (&shares["sum"], &found["outputs"]["tip"]["value"]);
    assert!((sum.as_f64().expect("a number") - value.as_f64().expect("a number")).abs() < 1e-9);
    assert!(found["rules"][0]["strength"].as_f64() >= found["rules"][1]["strength"].as_f64());
    assert_eq!(found["why_not"]["term"], "cheap");
    assert!(shares["polygon"].as_array().expect("a list").len() >= 4);
    let text = stdout(&ask(&["--svg", "why.svg"]));
    assert!(text.contains("rules by strength") && text.contains("shares in tip"), "{text}");
    assert!(folder.path().join("why.svg").exists());
    let wrong = ask(&["--why-not", "tip=dear"]);
    assert!(code(&wrong) == 2 && stderr(&wrong).contains("known are cheap, average, generous"));
}

#[test]
fn audit_tells_what_is_true_in_text_json_and_a_page() {
    let folder = folder();
    let quick = ["audit", "tip.toml", "--boxes", "200"];
    let text = fspid(&[&quick[..], &["--report", "tip.html"]].concat(), folder.path());
    assert_eq!(code(&text), 0, "{}", stderr(&text));
    assert!(stdout(&text).contains("no two contradict each other"));
    let page = std::fs::read_to_string(folder.path().join("tip.html")).expect("written");
    assert!(page.contains("</html>") && page.matches("<script").count() == 1);
    let found = json(&fspid(&[&quick[..], &["--format", "json"]].concat(), folder.path()));
    assert!(found["outputs"]["tip"]["least"]["bounds"].is_array());
    assert_eq!(found["rules"]["contradictions"], 0);
}

#[test]
fn check_and_schema_know_fuzzy_systems() {
    let folder = folder();
    let good = fspid(&["check", "tip.toml"], folder.path());
    assert_eq!(code(&good), 0, "{}", stderr(&good));
    assert!(stdout(&good).contains("2 inputs, 1 output, 3 rules"), "{}", stdout(&good));
    let schema = json(&fspid(&["schema", "fuzzy-system"], folder.path()));
    assert_eq!(schema["properties"]["kind"]["enum"][0], "fuzzy-system");
}

#[test]
fn the_examples_are_good() {
    let examples = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/systems");
    let mut count = 0;
    for entry in std::fs::read_dir(examples).expect("listed") {
        let path = entry.expect("an entry").path();
        let output = fspid(&["check", &path.display().to_string()], Path::new("."));
        assert_eq!(code(&output), 0, "{}: {}", path.display(), stderr(&output));
        count += 1;
    }
    assert!(count >= 3, "{count}");
}

#[test]
fn options_that_do_not_fit_are_refused_with_advice() {
    let folder = folder();
    for (arguments, part) in [
        (&["infer"][..], "required"),
        (&["infer", "--error", "1", "--change", "1"], "add --range"),
        (&["infer", "tip.toml", "--error", "1", "--change", "1"], "there is no input `error`"),
        (
            &["infer", "tip.toml", "--input", "service=1", "--input", "food=1", "--range", "5"],
            "--range goes with a shipped rule table",
        ),
        (&["infer", "nowhere", "--input", "x=1"], "known are files that end in .toml"),
        (&["explain", "tip.toml"], "--input"),
    ] {
        let output = fspid(arguments, folder.path());
        assert_eq!(code(&output), 2, "{arguments:?}");
        assert!(stderr(&output).contains(part), "{arguments:?}: {}", stderr(&output));
    }
}

const FML: &str = include_str!("../../fspid-formats/tests/data/fml/heater.xml");
const TYPE_2: &str = include_str!("../../fspid-formats/tests/data/fis/type2.fis");

/// Both endings said no format.
#[test]
fn every_command_takes_fml_and_files_of_the_type_2_toolbox() {
    let folder = folder();
    let folder = folder.path();
    std::fs::write(folder.join("heater.xml"), FML).expect("written");
    std::fs::write(folder.join("two.t2fis"), TYPE_2).expect("written");
    for file in ["heater.xml", "two.t2fis"] {
        let checked = fspid(&["check", file], folder);
        assert_eq!(code(&checked), 0, "{file}: {}", stderr(&checked));
        let converted = fspid(&["convert", file, "back.toml"], folder);
        assert_eq!(code(&converted), 0, "{file}: {}", stderr(&converted));
    }
    let at = ["--input", "cold=-2", "--input", "draught=4.5"];
    for command in [
        &["infer", "heater.xml"][..],
        &["explain", "heater.xml"],
        &["convert", "heater.xml", "heater.fll"],
        &["surface", "heater.xml", "--out", "heater.svg"],
        &["audit", "heater.xml", "--boxes", "200"],
    ] {
        let asks = matches!(command[0], "infer" | "explain");
        let arguments = if asks { [command, &at[..]].concat() } else { command.to_vec() };
        let output = fspid(&arguments, folder);
        let refused = command[0] == "convert" && code(&output) == 2;
        // fuzzylite samples its integrals: that is a loss.
        assert!(code(&output) < 2 || refused, "{command:?}: {}", stderr(&output));
    }
    let out = fspid(&["convert", "two.t2fis", "again.t2fis"], folder);
    assert_eq!(code(&out), 0, "{}", stderr(&out));
    let refused = fspid(&["convert", "tip.toml", "tip.t2fis", "--lossy"], folder);
    assert_eq!(code(&refused), 2);
    assert!(stderr(&refused).contains("holds an interval type-2 system"), "{}", stderr(&refused));
    std::fs::write(folder.join("bad.xml"), FML.replace("COG", "COK")).expect("written");
    let told = fspid(&["check", "bad.xml"], folder);
    assert_eq!(code(&told), 2);
    assert!(stderr(&told).contains("bad.xml:21:39: not known as defuzzifier"), "{}", stderr(&told));
}

/// What a compiled export prints.
fn checked(folder: &Path, name: &str) -> String {
    let sources = [format!("{name}.c"), format!("{name}_check.c")];
    let built = Command::new("cc")
        .args(["-std=c99", "-O1", "-ffp-contract=off", "-o", "check"])
        .args(sources)
        .current_dir(folder)
        .output()
        .expect("the compiler that links Rust");
    assert!(built.status.success(), "{}", stderr(&built));
    stdout(&Command::new(folder.join("check")).output().expect("what was built"))
}

#[test]
fn the_shipped_systems_are_exported_and_answer_alike_in_c() {
    let folder = tempfile::tempdir().expect("a folder");
    let systems = concat!(env!("CARGO_MANIFEST_DIR"), "/../../examples/systems");
    for (name, way) in [
        ("tip", "the centroid of a polygon"),
        ("fan", "the centroid of a polygon"),
        ("glide", "weighted average of what 3 rules conclude"),
    ] {
        let file = format!("{systems}/{name}.toml");
        let export = ["export", &file, "--to", "c", "--samples", "500", "--out", name];
        let output = fspid(&export, folder.path());
        assert_eq!(code(&output), 0, "{}", stderr(&output));
        assert!(stderr(&output).contains(way), "{}", stderr(&output));
        assert_eq!(checked(&folder.path().join(name), name), "500 samples, 0 different\n");
    }
}

#[test]
fn what_of_a_system_cannot_be_exported_is_refused_with_what_would_make_it_possible() {
    let folder = folder();
    let tip = std::fs::read_to_string(folder.path().join("tip.toml")).expect("a file");
    let curved = tip.replace(
        "{ shape = \"triangle\", left = 0, peak = 5, right = 10 }",
        "{ shape = \"gaussian\", centre = 5, sigma = 2 }",
    );
    std::fs::write(folder.path().join("curved.toml"), curved).expect("written");
    let bell = tip.replace(
        "{ shape = \"gaussian\", centre = 5, sigma = 1.5 }",
        "{ shape = \"bell\", centre = 5, width = 2, slope = 2 }",
    );
    std::fs::write(folder.path().join("bell.toml"), bell).expect("written");
    for (arguments, words) in [
        ("curved.toml --to c", ["output `tip`: an exact integral", "--defuzzifier midpoint:1000"]),
        ("tip.toml --to c --defuzzifier vertices:26", ["vertices:N", "midpoint:N"]),
        (
            "bell.toml --to c",
            ["input `service`, term `good`: the membership function `bell`", "gaussian"],
        ),
        (
            "tip.toml --to rust",
            ["rust is not written of fuzzy systems", "possible are c, lua, st, fmu2 and fmu3"],
        ),
        ("tip.toml --to matlab", ["a .fis, which `fspid convert SYSTEM OUT.fis`", "--lossy"]),
        ("tip.toml --to c --angles degrees", ["--angles", "units of its file"]),
    ] {
        let mut all = vec!["export"];
        all.extend(arguments.split(' '));
        all.extend(["--out", "code"]);
        let output = fspid(&all, folder.path());
        assert_eq!(code(&output), 2, "{arguments}: {}", stderr(&output));
        for word in words {
            assert!(stderr(&output).contains(word), "{arguments}: {}", stderr(&output));
        }
        assert!(!folder.path().join("code").exists());
    }
    let sampled = [
        "export",
        "curved.toml",
        "--to",
        "c",
        "--defuzzifier",
        "midpoint:50",
        "--samples",
        "50",
        "--out",
        "code",
    ];
    assert_eq!(code(&fspid(&sampled, folder.path())), 0);
}
