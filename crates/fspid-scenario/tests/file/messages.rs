//! The words of the messages, as a file to be read aloud.
//!
//! To write them anew after a change: `FSPID_WRITE_MESSAGES=1 cargo test -p fspid-scenario messages`.

use fspid_scenario::file;

use crate::file::{repository, text};

const GOLDEN: &str = "crates/fspid-scenario/tests/scenarios/messages.txt";

/// A mistake: what it is, what is replaced in the starter, and by what.
const MISTAKES: [(&str, &str, &str); 50] = [
    ("a mistyped key", "sample_period_s", "sample_perod_s"),
    ("a key without its unit", "duration_s", "duration"),
    ("a key in another unit", "sample_period_s = 0.01", "sample_period_ms = 10"),
    ("an angle in radians", "amplitude_deg = 5.0", "amplitude_rad = 0.08"),
    ("a number with its unit in a text", "duration_s = 10.0", "duration_s = \"500 ms\""),
    ("a key that does not exist", "name = \"my first flight\"", "name = \"x\"\ncolour = \"red\""),
    ("a missing table", "[loop]\nsample_period_s = 0.01\nduration_s = 10.0", ""),
    ("a missing key", "amplitude_deg = 5.0", ""),
    ("a text for a number", "duration_s = 10.0", "duration_s = \"ten seconds\""),
    ("a period of zero", "sample_period_s = 0.01", "sample_period_s = 0.0"),
    ("a number that is none", "kp = 1.0", "kp = nan"),
    ("a number beyond all bounds", "kp = 1.0", "kp = 1e999"),
    ("far too many samples", "duration_s = 10.0", "duration_s = 1e10"),
    ("a flight shorter than a sample", "duration_s = 10.0", "duration_s = 0.001"),
    ("an unknown plant", "preset = \"navion-paper\"", "preset = \"b747\""),
    (
        "a plant said twice",
        "preset = \"navion-paper\"",
        "preset = \"navion-paper\"\nnumerator = [1.0]\ndenominator = [1.0, 1.0]",
    ),
    ("a plant said by half", "preset = \"navion-paper\"", "numerator = [1.0]"),
    ("a plant not said at all", "preset = \"navion-paper\"", ""),
    (
        "an improper transfer function",
        "preset = \"navion-paper\"",
        "numerator = [1.0, 2.0, 3.0]\ndenominator = [1.0, 1.0]\nelevator_sign = \"nose-up-positive\"",
    ),
    (
        "a transfer function of zeros",
        "preset = \"navion-paper\"",
        "numerator = [0.0]\ndenominator = [0.0, 1.0]\nelevator_sign = \"nose-up-positive\"",
    ),
    (
        "an empty list",
        "preset = \"navion-paper\"",
        "numerator = []\ndenominator = [1.0, 1.0]\nelevator_sign = \"nose-up-positive\"",
    ),
    ("an unknown kind", "kind = \"step\"", "kind = \"stairs\""),
    ("a key of another kind", "kp = 1.0\n", "kp = 1.0\nnominal = { kp = 1.0 }\n"),
    ("two controllers of one name", "name = \"FSPID\"", "name = \"PID\""),
    ("nominal gains out of their limits", "kd_min = 0.0", "kd_min = 0.5"),
    ("gain limits without room", "kd_min = 0.0", "kd_min = 0.0\nkd_max = 0.0"),
    (
        "command limits the wrong way round",
        "kd = 0.05\n",
        "kd = 0.05\noutput_limits_deg = [20, -20]\n",
    ),
    (
        "anti-windup without a limit",
        "kd = 0.05\n",
        "kd = 0.05\nanti_windup = { kind = \"conditional\" }\n",
    ),
    (
        "a tracking time below the sample period",
        "kd = 0.05\n",
        "kd = 0.05\noutput_limits_deg = [-20, 20]\nanti_windup = { kind = \"back-calculation\", tracking_s = 0.001 }\n",
    ),
    (
        "a reference model that is faster than the samples",
        "range = 5.0",
        "range = 5.0\nsecond_input = \"error-and-model-error\"\nmodel = { bandwidth_rad_s = 60.0, damping = 0.7 }",
    ),
    (
        "leakage without accumulation",
        "law = \"memoryless\"",
        "law = \"memoryless\"\nleakage_per_s = 1.0",
    ),
    ("an unknown rule table", "table = \"mirrored\"", "table = \"printd\""),
    (
        "a change that nobody sees",
        "range = 5.0",
        "range = 5.0\nsecond_input = \"error-and-rate\"\nchange = \"delta\"",
    ),
    (
        "an old key beside its new one",
        "range = 5.0",
        "range = 5.0\nsees = \"error-and-rate\"\nsecond_input = \"error-and-rate\"",
    ),
    (
        "a model that is not there",
        "range = 5.0",
        "range = 5.0\nsecond_input = \"error-and-model-error\"",
    ),
    ("a model that nobody sees", "range = 5.0", "range = 5.0\nmodel = { bandwidth_rad_s = 1.0 }"),
    ("sets out of their order", "range = 5.0", "range = 5.0\nerror_set_centres = [0.6, 0.3]"),
    ("a set at the end of the range", "range = 5.0", "range = 5.0\nerror_set_centres = [0.3, 1.0]"),
    ("an unknown defuzzifier", "range = 5.0", "range = 5.0\ndefuzzifier = \"centroid\""),
    ("a rule file that is not there", "table = \"mirrored\"", "table = \"my-rules.toml\""),
    ("a table for a list of tables", "[[disturbance]]", "[disturbance]"),
    ("no TOML", "duration_s = 10.0", "duration_s = 10,0"),
    (
        "a plant with the names of MATLAB",
        "preset = \"navion-paper\"",
        "num = [1.0]\nden = [1.0, 1.0]",
    ),
    ("a plant by its states", "preset = \"navion-paper\"", "A = [[1.0]]\nB = [1.0]"),
    ("a plant by its poles", "preset = \"navion-paper\"", "zeros = [1.0]\npoles = [1.0, 2.0]"),
    (
        "a PID in standard form",
        "kp = 1.0\nki = 0.5\nkd = 0.05",
        "kp = 1.0\nTi = 2.0\nTd = 0.1\nN = 10",
    ),
    (
        "a self-tuner in standard form",
        "nominal = { kp = 1.0, ki = 0.5",
        "nominal = { kp = 1.0, Ti = 2.0",
    ),
    ("a coefficient of a filter", "kd = 0.05", "kd = 0.05\nN = 100"),
    ("a rate for a period", "sample_period_s = 0.01", "sample_rate_hz = 100"),
    (
        "lines of MATLAB",
        "preset = \"navion-paper\"",
        "numerator = [11.73 22.578]\ndenominator = [1 0.739 0.921];\nelevator_sign = 1 % up",
    ),
];

/// Requirements, each wrong in another way.
const WRONG_REQUIREMENTS: &str = r#"
[[requirement]]
measure = "phase_margin_deg"

[[requirement]]
measure = "mode_damping"
least = 0.8
most = 0.3

[[requirement]]
measure = "disk_margin"
least = 0.8
step_deg = 5.0

[[requirement]]
measure = "recovery_time_s"
most = 5.0
step_deg = 5.0
from_s = 2.0

[[requirement]]
measure = "rms_error_deg"
most = 5.0
from_s = 4.0
to_s = 3.0

[[requirement]]
set = "ctms"
level = 2

[[requirement]]
set = "mil-f-9490"

[[requirement]]
set = "mil-f-8785c"
measure = "phugoid_damping"

[[requirement]]
least = 6.0

[[requirement]]
id = "twice"
measure = "stable"

[[requirement]]
id = "twice"
measure = "frozen_stable"
confidence = "sure"
"#;

/// Mistakes that take more than a replacement.
fn longer() -> Vec<(&'static str, String)> {
    let inline = |grid: &str| {
        let grids = format!("delta_kp = \"\"\"\n{grid}\"\"\"\ndelta_ki = \"ZO\"\ndelta_kd = 3");
        let table = format!("[controller.supervisor.table]\n{grids}\n\n[controller.gain_limits]");
        file::starter()
            .lines()
            .filter(|line| !line.starts_with("table = "))
            .collect::<Vec<_>>()
            .join("\n")
            .replace("[controller.gain_limits]", &table)
    };
    let row = "NB NM NS ZO PS PM PB\n";
    let hole = [row, row, row, "NB NM NS    PS PM PB\n", row, row, row].concat();
    let label = [row, row, row, "NB NM NS ZO PQ PM PB\n", row, row, row].concat();
    let conflict = "setpoint_weights = { derivative = 1.0 }\nderivative_on = \"measurement\"";
    let change = "[[plant_change]]\nat_s = 5.0\npreset = \"b747-paper\"\n\n[[plant_change]]\nat_s = 4.0\nramp_s = 1.0\npreset = \"ctms-pitch\"\n\n[setpoint]";
    let starter = file::starter();
    vec![
        ("a hole in a rule table", inline(&hole)),
        ("an unknown label in a rule table", inline(&label)),
        (
            "a derivative on both",
            starter.replace("kd = 0.05\n", &format!("kd = 0.05\n{conflict}\n")),
        ),
        ("plant changes of another order and out of order", starter.replace("[setpoint]", change)),
        ("a table of set-points out of order", setpoint_table()),
        (
            "a requirement of nobody",
            format!(
                "{starter}\n[[requirement]]\ncontroller = \"FPID\"\nmeasure = \"overshoot\"\nmost = -1\n\n[[requirement]]\ncontroller = \"FPID\"\nmeasure = \"overshoot_pct\"\nmost = 1"
            ),
        ),
        (
            "requirements that ask nothing that could be answered",
            format!("{starter}\n{WRONG_REQUIREMENTS}"),
        ),
        (
            "no controller at all",
            format!(
                "controller = []\n{}",
                starter.split("# A controller with").next().unwrap_or_default()
            ),
        ),
        (
            "a key written twice",
            starter.replace("duration_s = 10.0", "duration_s = 10.0\nduration_s = 12.0"),
        ),
    ]
}

/// The starter with a table in place of its step.
fn setpoint_table() -> String {
    let (before, rest) = file::starter().split_once("kind = \"step\"").expect("there is one");
    let (_, after) = rest.split_once("at_s = 0.0").expect("it has a start");
    format!("{before}kind = \"table\"\ntime_s = [0, 2, 1]\nvalue_deg = [0, 1, 2]{after}")
}

fn all() -> String {
    let replaced = MISTAKES.iter().map(|(title, from, to)| {
        let text = file::starter().replacen(from, to, 1);
        assert_ne!(text, file::starter(), "{title}");
        (*title, text)
    });
    let mut messages = String::new();
    for (title, text) in replaced.chain(longer()) {
        let problems = file::parse(&text, "starter.toml", None, &[]);
        let problems = problems.expect_err(title);
        messages.push_str(&format!("# {title}\n{problems}\n\n"));
    }
    let sets = [
        "loop.sample_period_s=0",
        "controller.FPID.nominal.kp=2",
        "controller.FSPID.kp=2",
        "loop.period=1",
        "loop",
    ];
    let sets: Vec<String> = sets.iter().map(|&text| text.to_owned()).collect();
    let problems =
        file::parse(file::starter(), "starter.toml", None, &sets).expect_err("bad settings");
    messages.push_str(&format!("# settings from outside\n{problems}\n"));
    messages
}

#[test]
fn the_messages_are_those_that_were_read_aloud() {
    let messages = all();
    if std::env::var_os("FSPID_WRITE_MESSAGES").is_some() {
        std::fs::write(repository(GOLDEN), &messages).expect("written");
    }
    let golden = text(GOLDEN);
    for (number, (found, expected)) in messages.lines().zip(golden.lines()).enumerate() {
        assert_eq!(found, expected, "line {}", number + 1);
    }
    assert_eq!(messages.lines().count(), golden.lines().count());
}

/// What is told of the starter with one replacement.
fn told(from: &str, to: &str) -> String {
    let text = file::starter().replacen(from, to, 1);
    assert_ne!(text, file::starter(), "{from}");
    file::parse(&text, "starter.toml", None, &[]).expect_err(to).to_string()
}

/// "did you mean "p"?" dropped the derivative.
#[test]
fn a_controller_of_two_terms_is_a_pid_whose_third_gain_is_0() {
    for (kind, words) in [
        ("pd", "unknown kind; a PD controller is \"pid\" with ki = 0"),
        ("PD", "is \"pid\" with ki = 0"),
        ("pi", "is \"pid\" with kd = 0"),
        ("pids", "did you mean \"pid\"?"),
    ] {
        let told = told("kind = \"pid\"", &format!("kind = \"{kind}\""));
        assert!(told.contains(words), "{kind}: {told}");
    }
    let told = told("kind = \"step\"", "kind = \"pd\"");
    assert!(!told.contains("PD controller"), "a set-point is none: {told}");
}

/// "belongs to kind "lqi"" alone led to another controller.
#[test]
fn a_key_of_another_kind_that_is_here_in_the_plural_is_told_with_that() {
    let told = told("kd = 0.05\n", "kd = 0.05\nsetpoint_weight = 0.5\n");
    let words = "belongs to kind \"lqi\", not to kind \"pid\"; did you mean `setpoint_weights`: a table of proportional, derivative?";
    assert!(told.contains(words), "{told}");
}

/// "invalid float, expected `nan`".
#[test]
fn a_word_without_quotes_is_told_so_whatever_letter_it_begins_with() {
    for word in ["navion-paper", "inner", "trial", "falcon", "b747-paper"] {
        let told = told("preset = \"navion-paper\"", &format!("preset = {word}"));
        assert!(told.contains("must be quoted"), "{word}: {told}");
    }
}

/// "is here twice" stood at the second controller.
#[test]
fn a_first_controller_in_single_brackets_is_told_at_its_own_line() {
    let told = told("[[controller]]", "[controller]");
    let lines = file::starter().lines();
    let line = lines.clone().position(|it| it == "[[controller]]").expect("there") + 1;
    assert!(told.starts_with(&format!("starter.toml:{line}:1: `[[controller]]`")), "{told}");
    assert!(told.contains("double brackets, the first as well"), "{told}");
}

/// There was no word of the mark that was meant.
#[test]
fn a_range_for_a_number_that_can_be_tuned_is_told_how_a_mark_is_written() {
    for range in ["{ min = 0.1, max = 10 }", "[0.1, 10]"] {
        let told = told("kp = 1.0\n", &format!("kp = {range}\n"));
        assert!(told.contains("is { tune = [lower, upper] }"), "{range}: {told}");
    }
    let requirement = format!(
        "{}\n[[requirement]]\nmeasure = \"overshoot_pct\"\nmost = [1, 2]\n",
        file::starter()
    );
    let problems = file::parse(&requirement, "starter.toml", None, &[]).expect_err("a list");
    assert!(!problems.to_string().contains("tune ="), "nothing is tuned there: {problems}");
}

/// "invalid float, expected nothing".
#[test]
fn a_semicolon_at_the_end_of_a_line_is_told_by_name() {
    for line in ["kp = 1.0;\n", "kp = 1.0; # as in MATLAB\n", "kp = [1.0];\n"] {
        let told = told("kp = 1.0\n", line);
        assert!(told.contains("a line ends without a semicolon"), "{line}: {told}");
    }
}

/// 10⁶ deg were allowed, and a loop that came there had "diverged": `verify` called it unstable, `analyse` stable.
#[test]
fn set_points_and_loads_near_where_a_flight_counts_as_diverged_are_refused_with_their_range() {
    for (from, to) in [
        ("amplitude_deg = 5.0", "amplitude_deg = 1e6"),
        ("amplitude_deg = 5.0", "amplitude_deg = -10001.0"),
    ] {
        let told = told(from, to);
        assert!(told.contains("out of range") && told.contains("-10000 to 10000 deg"), "{told}");
    }
    let noise = "[[disturbance]]\nenters_at = \"servo\"\nkind = \"noise\"\nstandard_deviation_deg = 1e5\nseed = 1\n\n[[disturbance]]";
    let told = told("[[disturbance]]", noise);
    assert!(told.contains("standard_deviation_deg: out of range"), "{told}");
}

#[test]
fn problems_as_json_hold_what_the_text_says() {
    let text = file::starter().replace("sample_period_s = 0.01", "sample_period_s = 0.0");
    let problems = file::parse(&text, "mine.toml", None, &[]).expect_err("a period of zero");
    let json = problems.to_json();
    let line = text.lines().position(|line| line.contains("sample_period_s")).expect("there") + 1;
    let expected = serde_json::json!({
        "file": "mine.toml",
        "problems": [{
            "origin": null, "path": "loop.sample_period_s", "line": line, "column": 19,
            "message": "out of range", "found": "0.0", "allowed": "a finite number above 0, in s",
        }],
        "omitted": 0,
    });
    assert_eq!(json, expected);
}

#[test]
fn many_problems_are_reported_together_and_in_the_order_of_the_file() {
    let text = file::starter()
        .replace("schema = 1", "schema = 7")
        .replace("navion-paper", "nothing")
        .replace("duration_s = 10.0", "duration_s = -10.0")
        .replace("kp = 1.0\n", "kp = inf\n")
        .replace("range = 5.0", "range = 0")
        .replace("law = ", "low = ");
    let problems = file::parse(&text, "mine.toml", None, &[]).expect_err("six mistakes");
    let paths: Vec<&str> = problems.list.iter().map(|problem| problem.path.as_str()).collect();
    let expected = [
        "schema",
        "plant.preset",
        "loop.duration_s",
        "controller[0].kp",
        "controller[1].low",
        "controller[1].supervisor.range",
    ];
    assert_eq!(paths, expected, "{problems}");
    assert!(problems.to_string().ends_with("6 problems in mine.toml"), "{problems}");
}

/// What only the models can judge is found in the sound parts even where others are wrong.
#[test]
fn a_mistake_of_form_does_not_hide_a_mistake_of_meaning() {
    let text = file::starter()
        .replace("duration_s = 10.0", "duration_s = \"long\"")
        .replace(
            "preset = \"navion-paper\"",
            "numerator = [1, 2]\ndenominator = [1, 2]\nelevator_sign = \"nose-up-positive\"",
        )
        .replace("kd_min = 0.0", "kd_min = 3.0");
    let problems = file::parse(&text, "mine.toml", None, &[]).expect_err("three mistakes");
    let paths: Vec<&str> = problems.list.iter().map(|problem| problem.path.as_str()).collect();
    assert_eq!(
        paths,
        ["plant.numerator", "loop.duration_s", "controller[1].nominal.kd"],
        "{problems}"
    );
}
