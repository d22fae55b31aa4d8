//! What holds for every command: JSON where it is asked for, errors too; templates that check and run.

use std::path::Path;
use std::process::{Command, Output, Stdio};

use serde_json::Value;

fn fspid(arguments: &[&str], folder: &Path) -> Output {
    with_input(arguments, folder, "")
}

fn with_input(arguments: &[&str], folder: &Path, input: &str) -> Output {
    use std::io::Write as _;
    let mut child = Command::new(env!("CARGO_BIN_EXE_fspid"))
        .args(arguments)
        .current_dir(folder)
        .stdin(Stdio::piped())
        .stdout(Stdio::piped())
        .stderr(Stdio::piped())
        .spawn()
        .expect("the program starts");
    let mut stdin = child.stdin.take().expect("standard input");
    // A program that reads nothing closes its end.
    let _ = stdin.write_all(input.as_bytes());
    drop(stdin);
    child.wait_with_output().expect("it ends")
}

fn code(output: &Output) -> i32 {
    output.status.code().expect("an exit code")
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8(bytes.to_vec()).expect("UTF-8")
}

fn json(output: &Output) -> Value {
    let out = text(&output.stdout);
    serde_json::from_str(&out).unwrap_or_else(|error| {
        panic!("{error}: {out}\n{}", text(&output.stderr));
    })
}

/// Names of the commands that a help lists, without `help` itself.
fn listed(help: &str) -> Vec<String> {
    let after = help.split_once("Commands:\n").map_or("", |(_, rest)| rest);
    let lines = after.lines().take_while(|line| !line.trim().is_empty());
    // A long explanation goes on in a line that begins farther to the right.
    let names = lines.filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    let names = names.filter_map(|line| line.split_whitespace().next());
    names.filter(|name| *name != "help").map(str::to_owned).collect()
}

/// Every command of the program, as words of a command line.
fn commands(folder: &Path) -> Vec<Vec<String>> {
    let mut all = Vec::new();
    for name in listed(&text(&fspid(&["-h"], folder).stdout)) {
        let below = listed(&text(&fspid(&[&name, "-h"], folder).stdout));
        match below.is_empty() {
            true => all.push(vec![name]),
            false => all.extend(below.into_iter().map(|it| vec![name.clone(), it])),
        }
    }
    all
}

/// A command that answers, the exit codes that are well, and a key of its answer. They run in this order in one folder.
const ANSWERS: [(&str, &[i32], &str); 37] = [
    ("init pitch.toml", &[0], "file"),
    ("init --list", &[0], "templates"),
    ("init --template tuning tuning.toml", &[0], "next"),
    ("init --template contest contest.toml", &[0], "about"),
    ("init --template campaign campaign.toml", &[0], "file"),
    ("init --template fuzzy-system tip.toml", &[0], "file"),
    ("init --template rule-table rules.toml", &[0], "file"),
    ("check pitch.toml", &[0], "digest"),
    ("check pitch.toml --paths", &[0], "paths"),
    ("check rules.toml", &[0], "rules"),
    ("simulate pitch.toml", &[0, 1], "controllers"),
    ("analyse pitch.toml", &[0, 1], "controllers"),
    ("certify pitch.toml --controller FSPID", &[0, 1], "controllers"),
    ("verify pitch.toml --set ctms", &[0, 1], "requirements"),
    ("campaign plan campaign.toml --runs 8 --out flown", &[0], "shards"),
    ("campaign shard 0 --quiet --out flown", &[0], "flown"),
    ("campaign merge --out flown", &[0], "digest"),
    ("campaign run campaign.toml --runs 8 --quiet --out run", &[0], "rows"),
    ("campaign report run/campaign.parquet", &[0], "schema"),
    ("campaign replay run --run 3", &[0], "schema"),
    ("campaign search campaign.toml --measure overshoot_pct --budget 30", &[0], "measure"),
    ("tune tuning.toml --budget 12 --quiet", &[0, 1], "best"),
    ("tune contest.toml --all --budget 8 --quiet", &[0, 1], "controllers"),
    ("tune pitch.toml --rule amigo", &[0, 1], "controller"),
    ("contest contest.toml --budget 4 --seeds 1 --quiet --out who", &[0], "schema"),
    ("infer printed --range 5 --error 1 --change -2", &[0], "outputs"),
    ("explain tip.toml --input service=7 --input food=8", &[0], "outputs"),
    ("convert tip.toml tip.fis", &[0], "file"),
    (
        "learn sugeno-grid --range 1 --teacher mirrored --points 5,5 --epochs 2 --out l.toml",
        &[0, 2],
        "?",
    ),
    ("surface tip.toml --nodes 3", &[0], "axes"),
    ("audit tip.toml --boxes 20", &[0], "outputs"),
    ("aircraft list", &[0], "?"),
    ("aircraft show navion", &[0], "?"),
    ("aircraft trim navion", &[0], "?"),
    ("bench --quick --threads 1", &[0], "details"),
    ("schema", &[0], "properties"),
    ("reproduce --out paper", &[0], "claims"),
];

/// The others, whose answers the tests of their own commands look at.
const ELSEWHERE: [&str; 7] = [
    "fly",
    "aircraft linearise",
    "aircraft modes",
    "aircraft qualities",
    "aircraft envelope",
    "aircraft derive",
    "aircraft import",
];

#[test]
fn every_command_answers_with_one_json_object() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    for command in commands(folder) {
        let command = command.join(" ");
        let is_here = ANSWERS
            .iter()
            .any(|(words, ..)| *words == command || words.starts_with(&format!("{command} ")));
        assert!(is_here || ELSEWHERE.contains(&command.as_str()), "{command} is nowhere");
    }
    for (words, codes, key) in ANSWERS {
        let mut arguments: Vec<&str> = words.split(' ').collect();
        arguments.extend(["--format", "json"]);
        let output = fspid(&arguments, folder);
        assert!(codes.contains(&code(&output)), "{words}: {}", text(&output.stderr));
        let answer = json(&output);
        assert!(answer.is_object() || answer.is_array(), "{words}: {answer}");
        if key != "?" {
            assert!(!answer[key].is_null(), "{words} has no {key}: {answer}");
        }
    }
}

/// An error used to be words alone, and standard output empty.
#[test]
fn every_command_tells_what_is_wrong_as_json_too() {
    let folder = tempfile::tempdir().expect("a folder");
    for command in commands(folder.path()) {
        let mut words: Vec<&str> = command.iter().map(String::as_str).collect();
        words.extend(["--no-such-option", "--format", "json"]);
        let output = fspid(&words, folder.path());
        assert_eq!(code(&output), 2, "{command:?}");
        let error = &json(&output)["error"];
        assert_eq!((error["code"].as_i64(), error["kind"].as_str()), (Some(2), Some("input")));
        assert!(error["message"].as_str().is_some_and(|it| it.contains("no-such-option")));
        assert!(!output.stderr.is_empty(), "people are told too");
    }
}

#[test]
fn the_problems_of_a_file_have_their_places_in_json() {
    let folder = tempfile::tempdir().expect("a folder");
    let (folder, set) = (folder.path(), "controller.PID.kq=1");
    assert_eq!(code(&fspid(&["init", "a.toml"], folder)), 0);
    let output = fspid(&["check", "a.toml", "--set", set, "--format", "json"], folder);
    let answer = json(&output);
    let problem = &answer["error"]["problems"]["problems"][0];
    assert_eq!(problem["path"], "controller[0].kq", "{answer}");
    assert_eq!(code(&output), 2);
}

/// Every template with a command that runs it.
const TEMPLATES: [(&str, &str); 8] = [
    ("pitch-hold", "simulate FILE --report report.html"),
    ("aircraft-in-turbulence", "simulate FILE --set loop.duration_s=5 --report report.html"),
    ("requirements", "verify FILE"),
    ("campaign", "campaign run FILE --runs 16 --quiet --out robust"),
    ("tuning", "tune FILE --budget 40 --quiet --out design.toml"),
    ("contest", "contest FILE --budget 30 --seeds 2 --quiet --out who"),
    ("rule-table", "infer FILE --range 5 --error 1 --change -2"),
    ("fuzzy-system", "infer FILE --input service=7 --input food=8"),
];

#[test]
fn every_template_checks_and_runs() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let list = text(&fspid(&["init", "--list"], folder).stdout);
    assert_eq!(list.lines().count(), TEMPLATES.len(), "{list}");
    for (name, command) in TEMPLATES {
        assert!(list.contains(name), "{name} is not in the list");
        let file = format!("{name}.toml");
        let written = fspid(&["init", "--template", name, &file], folder);
        assert_eq!(code(&written), 0, "{}", text(&written.stderr));
        let content = std::fs::read_to_string(folder.join(&file)).expect("it is there");
        assert!(content.lines().filter(|line| line.contains('#')).count() > 5, "{name}");
        assert!(content.contains("fspid check FILE"), "{name} does not say how to check it");
        let checked = fspid(&["check", &file], folder);
        assert_eq!(code(&checked), 0, "{name}: {}", text(&checked.stderr));
        let told = text(&checked.stderr);
        assert!(!told.contains("warning"), "{name}: {told}");
        let words = command.replace("FILE", &file);
        let ran = fspid(&words.split(' ').collect::<Vec<_>>(), folder);
        assert_eq!(code(&ran), 0, "{words}: {}{}", text(&ran.stdout), text(&ran.stderr));
    }
    let wrong = fspid(&["init", "--template", "tunning"], folder);
    assert!(code(&wrong) == 2 && text(&wrong.stderr).contains("did you mean `tuning`?"));
}

/// `--trace -` wrote a file that was called `-`.
#[test]
fn a_hyphen_is_standard_input_and_output() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    let scenario = text(&fspid(&["init"], folder).stdout);
    let tip = text(&fspid(&["init", "--template", "fuzzy-system"], folder).stdout);
    let flown = with_input(&["simulate", "-", "--trace", "-"], folder, &scenario);
    assert_eq!(code(&flown), 0, "{}", text(&flown.stderr));
    assert!(text(&flown.stdout).starts_with("time_s,setpoint_deg,PID.theta_deg"));
    assert!(text(&flown.stderr).contains("my first flight"), "the answer is for people");
    for (words, begins) in [
        ("simulate - --report -", "<!doctype html>"),
        ("analyse - --map 0 --report -", "<!doctype html>"),
        ("verify - --set ctms --junit -", "<?xml"),
        ("check -", "-: good; my first flight"),
        ("tune - --rule amigo --controller PID --out -", "# "),
    ] {
        let output = with_input(&words.split(' ').collect::<Vec<_>>(), folder, &scenario);
        assert!(code(&output) < 2, "{words}: {}", text(&output.stderr));
        let out = text(&output.stdout);
        assert!(out.starts_with(begins), "{words}: {}", out.chars().take(200).collect::<String>());
    }
    for (words, begins) in [
        ("infer - --input service=7 --input food=8", "tip"),
        ("convert - - --as fis", "[System]"),
        ("surface - --out -", "<svg"),
        ("surface - --csv -", "service,food,tip"),
        ("explain - --input service=7 --input food=8 --svg -", "<svg"),
    ] {
        let output = with_input(&words.split(' ').collect::<Vec<_>>(), folder, &tip);
        assert_eq!(code(&output), 0, "{words}: {}", text(&output.stderr));
        assert!(text(&output.stdout).starts_with(begins), "{words}: {}", text(&output.stdout));
    }
    assert!(!folder.join("-").exists(), "no file of that name was written");
    let both = with_input(&["simulate", "-", "--trace", "-", "--report", "-"], folder, &scenario);
    assert!(code(&both) == 2 && text(&both.stderr).contains("standard output holds one thing"));
}

/// `surface x.fis --out tipper.png` made a folder of that name.
#[test]
fn an_unknown_ending_is_refused_and_the_known_ones_are_named() {
    let folder = tempfile::tempdir().expect("a folder");
    let folder = folder.path();
    assert_eq!(code(&fspid(&["init", "a.toml"], folder)), 0);
    for (words, known) in [
        ("simulate a.toml --trace a.png", "known is .csv"),
        ("simulate a.toml --report a.pdf", "known are .html, .htm"),
        ("analyse a.toml --report a", "no ending; known are .html, .htm"),
        ("verify a.toml --set ctms --junit a.json", "known is .xml"),
        ("tune a.toml --history a.csv", "known is .parquet"),
        ("tune a.toml --out a.json", "known is .toml"),
        ("surface printed --range 5 --out a.png", "known is .svg"),
        ("explain printed --range 5 --error 1 --change 0 --svg a.png", "known is .svg"),
        ("surface printed --range 5 --csv a.txt", "known is .csv"),
        ("convert printed --range 5 a.txt", "known are .toml, .fis, .fcl, .fll"),
        ("init a.json", "known is .toml"),
        ("campaign merge --to a.csv --out x", "known is .parquet"),
        ("aircraft import a.dml --out a.json", "known is .toml"),
    ] {
        let output = fspid(&words.split(' ').collect::<Vec<_>>(), folder);
        let told = text(&output.stderr);
        assert!(code(&output) == 2 && told.contains(known), "{words}: {told}");
    }
    assert_eq!(std::fs::read_dir(folder).expect("a folder").count(), 1, "nothing was written");
}

/// `cannot open`, `No such file or directory (os error 2)` and others stood beside each other.
#[test]
fn a_missing_file_is_told_in_the_same_words_everywhere() {
    let folder = tempfile::tempdir().expect("a folder");
    for words in [
        "check none.toml",
        "simulate none.toml",
        "analyse none.toml",
        "certify none.toml",
        "certify --check none.toml",
        "verify none.toml",
        "tune none.toml",
        "fly none.toml",
        "contest none.toml --out c",
        "campaign run none.toml --out c",
        "campaign report none.toml",
        "campaign search none.toml --measure x",
        "infer none.toml --input x=1",
        "infer printed --range 5 --points none.toml",
        "explain none.toml --input x=1",
        "audit none.toml",
        "surface none.toml",
        "convert none.toml m.fcl",
        "aircraft show none.toml",
        "aircraft import none.toml",
        "learn sugeno-grid --range 5 --data none.toml --out o.toml",
    ] {
        let output = fspid(&words.split(' ').collect::<Vec<_>>(), folder.path());
        let told = text(&output.stderr);
        assert_eq!(code(&output), 2, "{words}");
        assert!(
            told.contains("none.toml: cannot be read: there is no such file"),
            "{words}: {told}"
        );
    }
}

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
    let words = ["tune", "a.toml", "--budget", "100000000", "--quiet"];
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
    assert!(told.contains("8 of 8 requirements met; PASS"), "{told}");
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
        ("simulate", "controller.PID.kd=1e308", "controller.PID.kd is 1e308"),
        ("analyse", "controller.PID.kd=1e308", "controller.PID.kd is 1e308"),
        ("check", "actuator.time_constant_s=1e-310", "actuator.time_constant_s: so short"),
    ] {
        let output = fspid(&[command, "a.toml", "--set", set], folder);
        let told = text(&output.stderr);
        assert!(code(&output) == 2 && told.contains(key), "{command}: {told}");
        assert!(!told.contains("matrix") && !told.contains("vector"), "{told}");
    }
}

/// Least squares that were judged by rows beyond all numbers ended with code 0.
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
    assert!(told.contains("the error of the rows for validation is inf"), "{told}");
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
        let (_, rest) = page.split_once("From above: ").expect("a caption");
        rest.split_once('.').map_or(String::new(), |(caption, _)| caption.to_owned())
    };
    let gusts = caption("aircraft-in-turbulence", &["loop.duration_s=2"]);
    assert!(gusts.contains("airspeed, altitude") && !gusts.contains("bands"), "{gusts}");
    let step = caption("pitch-hold", &[]);
    assert!(step.contains("bands of 2 %") && step.contains("gains of the self-tuning"), "{step}");
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
    // What the list says may be set can be set: to the value that it has.
    for row in rows.iter().filter(|row| row["given"] == true) {
        let (path, value) =
            (row["path"].as_str().expect("a path"), row["value"].as_str().expect("a value"));
        if value.contains('…') {
            continue;
        }
        let set = format!("{path}={value}");
        let output = fspid(&["check", "a.toml", "--set", &set], folder);
        assert_eq!(code(&output), 0, "{set}: {}", text(&output.stderr));
    }
    let table = text(&fspid(&["check", "a.toml", "--paths"], folder).stdout);
    assert!(table.lines().count() > 60 && table.contains("controller.FSPID.nominal.kp"), "{table}");
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
    assert!(told.contains("2 controller(s) tuned with 4 candidates each: about "), "{told}");
    let page = std::fs::read_to_string(folder.join("who/contest.html")).expect("written");
    let (_, reasons) = page.split_once("Why flights failed").expect("a heading");
    let table = reasons.split_once("</table>").map_or("", |(table, _)| table);
    for words in ["<table", "flight conditions", "commands", "FSPID", "overshoot_pct"] {
        assert!(table.contains(words), "{words}: {table}");
    }
    assert!(!table.contains("<li>"), "{table}");
}

/// `error: unexpected argument '-5' found`, with a tip that made it worse.
#[test]
fn a_negative_count_says_what_is_allowed() {
    let folder = tempfile::tempdir().expect("a folder");
    for (words, told) in [
        (
            "campaign run a.toml --runs -5 --out c",
            "--runs is -5; allowed is a whole number, 0 or more",
        ),
        ("tune a.toml --budget -5", "--budget is -5; allowed is a whole number, 0 or more"),
        ("tune a.toml --seed x", "--seed is x; allowed is a whole number, 0 or more"),
        ("analyse a.toml --map -1", "--map is -1; allowed is 0 to 201"),
        ("audit printed --range x", "--range is x; allowed is a number"),
    ] {
        let output = fspid(&words.split(' ').collect::<Vec<_>>(), folder.path());
        let found = text(&output.stderr);
        assert!(code(&output) == 2 && found.contains(told), "{words}: {found}");
    }
}
