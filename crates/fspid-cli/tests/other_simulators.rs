//! Aircraft that another simulator flies: verdicts, campaigns and refusals, with a stand-in for the simulator's process.
//! JSBSim itself flies in `checks/jsbsim`.

use std::path::Path;
use std::process::{Command, Output};

use serde_json::Value;

use crate::common::{code, json, text};

/// Speaks as the bridge to JSBSim does, and flies $\ddot\theta = -4 \theta - 2.4 \dot\theta - 4 (\delta_e - \delta_0)$, or
/// does what its aircraft is called. It climbs as its pitch is over the trim's, its speed follows the throttle, and the air
/// that it is told only moves in what it shows.
const STAND_IN: &str = r#"
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <signal.h>
#include <unistd.h>
static void all(const void *from, size_t size) {
    const char *bytes = from;
    while (size > 0) { ssize_t put = write(0, bytes, size); if (put <= 0) _exit(0); bytes += put; size -= (size_t)put; }
}
static void words(const char *text) { uint32_t size = (uint32_t)strlen(text); all(&size, 4); all(text, size); }
/* The air that moves: to the north, to the east and down. */
static double air[3], wind[2], place[2], speed, height, throttle = 0.5;
static void sample(uint64_t number, double theta, double q, double elevator) {
    double pitch = 0.02 + theta, climb = speed * theta;
    double ft = 1 / 0.3048;
    double n[34] = { pitch, q, 0, speed * ft, height * ft, height * ft, 0.02, elevator, 0,
        (air[0] * cos(pitch) - air[2] * sin(pitch)) * ft, air[1] * ft, (air[0] * sin(pitch) + air[2] * cos(pitch)) * ft,
        0, 0, 0, 0, 0, -2000, 2000, 0, 0, 0, 0, 0, throttle, climb * ft, (speed + wind[0]) * ft, wind[1] * ft,
        place[0], place[1], 0, 0, 0, throttle };
    all(&number, 8); all(n, sizeof n);
}
static const char *of(int count, char **arguments, const char *key) {
    for (int i = 1; i < count; i++)
        if (!strncmp(arguments[i], key, strlen(key)) && arguments[i][strlen(key)] == '=') return arguments[i] + strlen(key) + 1;
    return "";
}
int main(int count, char **arguments) {
    const char *does = of(count, arguments, "aircraft");
    int steps = atoi(of(count, arguments, "steps"));
    double step_s = atof(of(count, arguments, "step_s")), trim = -0.05, theta = 0, q = 0;
    double bias = atof(of(count, arguments, "altitude_m")) * 1e-6;
    const char *blows = of(count, arguments, "wind_m_s"), *fast = of(count, arguments, "speed");
    speed = strchr(fast, '=') ? atof(strchr(fast, '=') + 1) : 100;
    height = atof(of(count, arguments, "altitude_m"));
    if (strchr(blows, '=')) { air[0] = wind[0] = atof(blows); air[1] = wind[1] = atof(strchr(blows, '=') + 1); }
    char kind = 0;
    if (!strcmp(does, "refused")) { kind = 1; all(&kind, 1); printf("wdot cannot be trimmed\n"); fflush(stdout);
        words("cannot trim refused at this condition: {said}"); words("a speed at which it flies"); return 0; }
    if (!strcmp(does, "other-version")) { kind = 2; all(&kind, 1); words("version 0.1 is installed, and the scenario flies version 1.3.3"); words(""); return 0; }
    if (!strcmp(does, "mute")) { printf("Traceback: no module\n"); return 3; }
    all(&kind, 1); words("1.3.3"); sample(0, theta, q, trim);
    for (uint64_t number = 1;; number++) {
        double elevator = trim, held;
        if (read(0, &held, sizeof held) != sizeof held) return 0;
        for (int i = 0; i < steps; i++) {
            double input[4];
            if (read(0, input, sizeof input) != sizeof input) return 0;
            elevator = input[0]; air[0] = wind[0] + input[1]; air[1] = wind[1] + input[2]; air[2] = input[3];
            q += step_s * (-4 * theta - 2.4 * q - 4 * (elevator - trim) + bias);
            theta += step_s * q;
            if (atoi(of(count, arguments, "moves_throttle"))) { speed += step_s * 5 * (held - 0.5); throttle = held; }
            height += step_s * speed * theta;
            place[0] += step_s * (speed + wind[0]); place[1] += step_s * wind[1];
        }
        if (number == 50) {
            if (!strcmp(does, "crashes")) raise(SIGKILL);
            if (!strcmp(does, "ends")) exit(7);
            if (!strcmp(does, "slow")) usleep(100000);
            if (!strcmp(does, "hangs")) for (;;) pause();
            if (!strcmp(does, "nan")) theta = NAN;
            if (!strcmp(does, "skips")) number++;
            if (!strcmp(does, "gives-up")) number = UINT64_MAX;
            if (!strcmp(does, "half")) { all(&number, 5); return 0; }
        }
        sample(number, theta, q, elevator);
    }
}
"#;

/// A folder with the stand-in, and a scenario that flies the aircraft of that name.
pub(crate) fn folder(aircraft: &str) -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    let scenario = format!(
        r#"schema = 1
name = "another simulator"
[simulator]
kind = "jsbsim"
aircraft = "{aircraft}"
airspeed_m_s = 100.0
altitude_m = 1000.0
answer_limit_s = 0.5
[loop]
sample_period_s = 0.02
duration_s = 10.0
[setpoint]
kind = "step"
at_s = 0.5
amplitude_deg = 2.0
[[controller]]
name = "PID"
kind = "pid"
kp = 1.0
ki = 1.5
kd = 0.2
"#
    );
    std::fs::write(folder.path().join("flown.toml"), scenario).expect("a scenario");
    std::fs::write(folder.path().join("stand-in.c"), STAND_IN).expect("a source");
    let built = Command::new("cc")
        .args(["-std=gnu99", "-O1", "-o", "stand-in", "stand-in.c", "-lm"])
        .current_dir(&folder)
        .status();
    assert!(built.expect("a compiler").success());
    folder
}

pub(crate) fn fspid(folder: &Path, python: &Path, arguments: &[&str]) -> Output {
    Command::new(env!("CARGO_BIN_EXE_fspid"))
        .args(arguments)
        .current_dir(folder)
        .env("FSPID_PYTHON", python)
        .output()
        .expect("it runs")
}

fn asked(aircraft: &str, arguments: &[&str]) -> Output {
    let folder = folder(aircraft);
    fspid(folder.path(), &folder.path().join("stand-in"), arguments)
}

/// The end of the only controller's flight.
pub(crate) fn ending(output: &Output) -> Value {
    json(output)["controllers"][0].clone()
}

pub(crate) const SIMULATE: &[&str] = &["simulate", "flown.toml", "--format", "json"];

#[test]
fn what_another_simulator_flies_is_measured_and_judged() {
    let output = asked("flies", SIMULATE);
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    assert_eq!(ending(&output)["verdict"], "settled");
}

/// The sums of the stand-in, made here: our loop with an ideal servo asks for the trim less the command.
#[test]
fn the_trace_is_that_of_the_simulator_and_its_elevator_is_the_one_that_it_shows() {
    let folder = folder("flies");
    let python = folder.path().join("stand-in");
    let output = fspid(folder.path(), &python, &["simulate", "flown.toml", "--trace", "t.csv"]);
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    let csv = std::fs::read_to_string(folder.path().join("t.csv")).expect("a trace");
    let mut lines = csv.lines();
    let names: Vec<&str> = lines.next().expect("a head").split(',').collect();
    let place = |name: &str| {
        names.iter().position(|it| it.contains(name)).unwrap_or_else(|| panic!("{name}: {names:?}"))
    };
    let rows: Vec<Vec<f64>> = lines
        .map(|line| line.split(',').map(|it| it.parse().expect("a number")).collect())
        .collect();
    let (theta, command, elevator) = (place("theta"), place("command"), place("elevator"));
    let degree = std::f64::consts::PI / 180.0;
    let (mut theta_rad, mut q_rad_s) = (0.0, 0.0);
    for two in rows.windows(2) {
        let [now, next] = two else { continue };
        let command_rad = now[command] * degree;
        for _ in 0..2 {
            let acceleration = -4.0 * theta_rad - 2.4 * q_rad_s + 4.0 * command_rad + 1e-3;
            q_rad_s += 0.01 * acceleration;
            theta_rad += 0.01 * q_rad_s;
        }
        assert!((next[theta] * degree - theta_rad).abs() < 1e-9, "{now:?} {next:?}");
        assert!((next[elevator] * degree - (-0.05 - command_rad)).abs() < 1e-9);
    }
    assert!(names.contains(&"load_factor") || names.iter().any(|it| it.contains("load")));
}

#[test]
fn a_simulator_that_is_lost_ends_its_flight_as_a_verdict_and_never_as_a_hang() {
    let lost = [
        ("crashes", "crashed", "crashed with SIGKILL"),
        ("ends", "ended", "ended its process with code 7"),
        ("hangs", "silent", "gave no answer within 0.5 s"),
        ("nan", "not finite", "a number that is not finite"),
        ("skips", "no answer", "wrote something else than an answer"),
        ("gives-up", "refused", "said that it cannot go on"),
        ("half", "ended", "ended its process with code 0"),
    ];
    for (aircraft, loss, words) in lost {
        let output = asked(aircraft, SIMULATE);
        assert_eq!(code(&output), 1, "{aircraft}: {}", text(&output.stderr));
        let outcome = ending(&output)["outcome"].clone();
        assert_eq!(
            (outcome["kind"].as_str(), outcome["loss"].as_str()),
            (Some("plant lost"), Some(loss))
        );
        let told = text(&asked(aircraft, &["simulate", "flown.toml"]).stdout);
        assert!(told.contains("the simulator ") && told.contains(words), "{aircraft}: {told}");
    }
}

#[test]
fn what_cannot_be_flown_ends_with_2_and_says_why_and_what_would_be_right() {
    let refused = [
        (
            "refused",
            "cannot trim refused at this condition: wdot cannot be trimmed; allowed is a speed",
        ),
        ("other-version", "version 0.1 is installed, and the scenario flies version 1.3.3"),
        ("mute", "ended its process with code 3 before its flight, and said: Traceback: no module"),
    ];
    for (aircraft, words) in refused {
        let output = asked(aircraft, SIMULATE);
        assert_eq!(code(&output), 2, "{aircraft}");
        let message = json(&output)["error"]["message"].to_string();
        assert!(message.contains("JSBSim") && message.contains(words), "{aircraft}: {message}");
    }
    let folder = folder("flies");
    let nowhere = fspid(folder.path(), Path::new("/no/python"), SIMULATE);
    assert_eq!(code(&nowhere), 2);
    let message = json(&nowhere)["error"]["message"].to_string();
    assert!(
        message.contains("there is no Python at /no/python; install one, or name one in"),
        "{message}"
    );
}

#[test]
fn what_asks_equations_is_refused_and_says_what_to_do_instead() {
    let questions: [&[&str]; 3] = [
        &["analyse", "flown.toml"],
        &["certify", "flown.toml"],
        &["analyse", "flown.toml", "--fly"],
    ];
    for question in questions {
        let output = asked("flies", question);
        let told = text(&output.stderr) + &text(&output.stdout);
        assert_eq!(code(&output), 2, "{question:?}: {told}");
        assert!(
            told.contains("JSBSim flies the aircraft") && told.contains("fspid aircraft import"),
            "{question:?}: {told}"
        );
    }
}

#[test]
fn a_flight_of_another_simulator_is_not_called_stable_at_rest() {
    let output = asked("flies", &["simulate", "flown.toml"]);
    let told = text(&output.stdout);
    assert!(told.contains("the loop at rest could not be asked: JSBSim flies"), "{told}");
    let json = json(&asked("flies", SIMULATE)).to_string();
    assert!(!json.contains("\"stable\""), "{json}");
}

#[test]
fn a_campaign_flies_and_has_the_same_rows_on_any_number_of_threads() {
    let folder = folder("flies");
    let python = folder.path().join("stand-in");
    let path = folder.path().join("flown.toml");
    let scenario = std::fs::read_to_string(&path).expect("it is there")
        + "[[dispersion]]\npath = \"simulator.altitude_m\"\ndistribution = \"uniform\"\nlower = 0.5\nupper = 3.0\n";
    std::fs::write(&path, scenario).expect("it is written");
    for threads in ["1", "3"] {
        let campaign = [
            "campaign",
            "run",
            "flown.toml",
            "--runs",
            "6",
            "--quiet",
            "--threads",
            threads,
            "--out",
            threads,
        ];
        let output = fspid(folder.path(), &python, &campaign);
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    }
    let rows = |threads| {
        std::fs::read(folder.path().join(threads).join("campaign.parquet")).expect("rows")
    };
    assert_eq!(rows("1"), rows("3"));
}

#[test]
fn what_belongs_to_aircraft_of_our_own_is_refused_by_name() {
    let folder = folder("flies");
    let path = folder.path().join("flown.toml");
    let written = std::fs::read_to_string(&path).expect("it is there");
    let with = [
        (
            "[engine]\nkind = \"stevens-lewis\"\n",
            "another simulator flies, whose engine is its own",
        ),
        (
            "[lateral]\nyaw_damping = 0.5\n",
            "another simulator flies, whose wings are held by `wings`",
        ),
        (
            "[[plant_change]]\nat_s = 1.0\npreset = \"navion\"\n",
            "an aircraft that is not linear cannot be changed in flight",
        ),
        ("[plant]\npreset = \"navion\"\n", "simulator"),
    ];
    for (more, words) in with {
        std::fs::write(&path, format!("{written}{more}")).expect("it is written");
        let output = fspid(folder.path(), Path::new("/no/python"), &["check", "flown.toml"]);
        assert_eq!(code(&output), 2);
        assert!(text(&output.stderr).contains(words), "{}", text(&output.stderr));
    }
}

/// A trace, as columns by name.
fn columns(folder: &Path, name: &str) -> impl Fn(&str) -> Vec<f64> + use<> {
    let csv = std::fs::read_to_string(folder.join(name)).expect("a trace");
    let mut lines = csv.lines();
    let names: Vec<String> = lines.next().expect("a head").split(',').map(str::to_owned).collect();
    let rows: Vec<Vec<f64>> = lines
        .map(|line| line.split(',').map(|it| it.parse().expect("a number")).collect())
        .collect();
    move |name| {
        let place = names.iter().position(|it| it == name);
        let place = place.unwrap_or_else(|| panic!("{name}: {names:?}"));
        rows.iter().map(|row| row[place]).collect()
    }
}

/// The scenario of a folder with some of its words replaced and more behind it.
fn rewrite(folder: &Path, name: &str, replaced: &[(&str, &str)], more: &str) {
    let mut text = std::fs::read_to_string(folder.join("flown.toml")).expect("it is there");
    for (word, by) in replaced {
        assert!(text.contains(word), "{word}");
        text = text.replace(word, by);
    }
    std::fs::write(folder.join(name), text + more).expect("it is written");
}

const FASTER: (&str, &str) =
    ("airspeed_m_s = 100.0\naltitude_m = 1000.0", "airspeed_m_s = 200.0\naltitude_m = 6000.0");

/// The same air around an aircraft of ours and around that of a simulator. The stand-in turns what it is told into its own
/// axes, which have turned a little further than was foreseen, and its airspeed feels no gust.
fn meets_the_same_air(more: &str, near_m_s: f64) {
    let folder = folder("flies");
    let (path, python) = (folder.path(), folder.path().join("stand-in"));
    let still = ("amplitude_deg = 2.0", "amplitude_deg = 0.0");
    let own = (
        "[simulator]\nkind = \"jsbsim\"\naircraft = \"flies\"\n",
        "[aircraft]\nname = \"b747-cruise-low\"\n",
    );
    let limit = ("answer_limit_s = 0.5\n", "");
    rewrite(path, "theirs.toml", &[FASTER, still], more);
    rewrite(path, "ours.toml", &[FASTER, still, own, limit], more);
    for name in ["theirs", "ours"] {
        let (scenario, trace) = (format!("{name}.toml"), format!("{name}.csv"));
        let output = fspid(path, &python, &["simulate", &scenario, "--trace", &trace]);
        assert!(code(&output) < 2, "{}", text(&output.stderr));
        let told = text(&output.stderr).contains("the rates p, q and r of gusts and turbulence");
        assert_eq!(told, name == "theirs", "{}", text(&output.stderr));
    }
    let (theirs, ours) = (columns(path, "theirs.csv"), columns(path, "ours.csv"));
    for axis in ["air_forward_m_s", "air_right_m_s", "air_down_m_s"] {
        let (theirs, ours) = (theirs(axis), ours(axis));
        let largest = ours.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        assert!(largest > 0.9, "{axis}: {largest}");
        for k in 1..theirs.len() {
            let apart = (theirs[k] - ours[k]).abs();
            assert!(apart < near_m_s, "{axis}, {k}: {} {}", theirs[k], ours[k]);
        }
    }
}

#[test]
fn the_turbulence_that_a_simulator_is_told_is_the_one_that_an_aircraft_of_ours_meets() {
    meets_the_same_air("[turbulence]\nintensity = \"moderate\"\nseed = 7\n", 1e-3);
}

#[test]
fn the_gust_that_a_simulator_is_told_is_the_one_that_an_aircraft_of_ours_meets() {
    let gust = "[[gust]]\nkind = \"full-cycle\"\nup_m_s = 3.0\nright_m_s = 1.0\nforward_m_s = 1.0\n\
        gradient_m = 150.0\nat_s = 4.0\n";
    // A gust from behind lasts a little longer for who gains airspeed in it.
    meets_the_same_air(gust, 0.05);
}

#[test]
fn a_simulator_begins_in_the_wind_of_its_start_and_hears_of_its_changes() {
    let folder = folder("flies");
    let (path, python) = (folder.path(), folder.path().join("stand-in"));
    let steady = "[wind]\nkind = \"steady\"\nspeed_m_s = 12.0\nfrom_deg = 30.0\n";
    rewrite(path, "windy.toml", &[FASTER, ("amplitude_deg = 2.0", "amplitude_deg = 0.0")], steady);
    let output = fspid(path, &python, &["simulate", "windy.toml", "--trace", "t.csv"]);
    assert!(code(&output) < 2, "{}", text(&output.stderr));
    // A wind that is the same everywhere turns nothing, and nothing of it is left out.
    assert!(!text(&output.stderr).contains("rates"), "{}", text(&output.stderr));
    let trace = columns(path, "t.csv");
    let (sine, cosine) = (30.0_f64).to_radians().sin_cos();
    let pitch_rad: Vec<f64> = trace("attitude_deg").into_iter().map(f64::to_radians).collect();
    let all = trace("air_forward_m_s").into_iter().zip(trace("air_right_m_s")).zip(pitch_rad);
    for ((forward, right), pitch_rad) in all {
        assert!((right + 12.0 * sine).abs() < 1e-9, "{right}");
        assert!((forward + 12.0 * cosine * pitch_rad.cos()).abs() < 1e-9, "{forward}");
    }
}

const AROUND: &str = "[[outer_loop]]\nname = \"altitude\"\nkind = \"pid\"\nholds = \"altitude\"\nmoves = \"vertical speed\"\n\
    kp = 0.3\nleast = -5.0\nmost = 5.0\n\
    [[outer_loop]]\nname = \"vertical speed\"\nkind = \"pid\"\nholds = \"vertical-speed\"\nmoves = \"pitch\"\n\
    kp = 0.3\nki = 0.5\nleast = -8.0\nmost = 8.0\n\
    [[outer_loop]]\nname = \"autothrottle\"\nkind = \"pid\"\nholds = \"airspeed\"\nmoves = \"throttle\"\nkp = 0.3\n\
    [[mode]]\nname = \"level\"\nengage = [\"altitude\", \"vertical speed\", \"autothrottle\"]\n\
    [[mode]]\nname = \"climb\"\nat_s = 2.0\nengage = [\"altitude\", \"vertical speed\", \"autothrottle\"]\n\
    target = { altitude_m = 1050.0, airspeed_m_s = 101.0 }\n";

#[test]
fn outer_loops_move_pitch_and_throttle_of_a_simulator_and_requirements_are_asked_of_its_flight() {
    let folder = folder("flies");
    let (path, python) = (folder.path(), folder.path().join("stand-in"));
    let long = ("duration_s = 10.0", "duration_s = 60.0");
    let still = ("amplitude_deg = 2.0", "amplitude_deg = 0.0");
    let asked = "[[requirement]]\nmeasure = \"largest_load_factor_g\"\nmost = 2.0\n\
        [[requirement]]\nmeasure = \"altitude_deviation_ft\"\nfrom_s = 45.0\ntarget_m = 1050.0\nmost = 3.0\n\
        [[requirement]]\nmeasure = \"largest_airspeed_kt\"\nmost = 197.0\n";
    rewrite(path, "around.toml", &[long, still], &format!("{AROUND}{asked}"));
    let output = fspid(path, &python, &["simulate", "around.toml", "--trace", "t.csv"]);
    assert_eq!(code(&output), 0, "{}{}", text(&output.stderr), text(&output.stdout));
    let trace = columns(path, "t.csv");
    let last = |name: &str| trace(name).last().copied().unwrap_or(f64::NAN);
    assert!((last("altitude_m") - 1050.0).abs() < 0.5, "{}", last("altitude_m"));
    assert!((last("airspeed_m_s") - 101.0).abs() < 0.1, "{}", last("airspeed_m_s"));
    // What is asked for is what the simulator shows a sample later.
    let (asked, shown) = (trace("throttle_command"), trace("throttle"));
    for (asked, shown) in asked.iter().zip(shown.iter().skip(1)) {
        assert!((asked - shown).abs() < 1e-12, "{asked} {shown}");
    }
}

#[test]
fn a_mode_that_never_begins_in_a_simulator_fails_the_flight() {
    let folder = folder("flies");
    let (path, python) = (folder.path(), folder.path().join("stand-in"));
    let never =
        format!("{AROUND}[[mode]]\nname = \"high\"\nwhen = {{ altitude_above_m = 2000.0 }}\n");
    rewrite(path, "never.toml", &[], &never);
    let output = fspid(path, &python, &["simulate", "never.toml", "--format", "json"]);
    assert_eq!(code(&output), 1, "{}", text(&output.stderr));
    assert_eq!(ending(&output)["outcome"]["kind"], "mode never began");
}

#[test]
fn what_nothing_holds_and_what_an_fmu_does_not_hear_is_refused_by_name() {
    let folder = crate::fmu_aircraft::folder_of_fmu(-1);
    let path = folder.path();
    let with = [
        (
            "[turbulence]\nintensity = \"light\"\n",
            "an FMU flies the aircraft, which hears of its elevator alone",
        ),
        (AROUND, "an FMU shows neither altitude nor airspeed that outer loops could hold"),
    ];
    for (more, words) in with {
        rewrite(path, "refused.toml", &[], more);
        let output = fspid(path, Path::new("/no/python"), &["check", "refused.toml"]);
        assert_eq!(code(&output), 2);
        assert!(text(&output.stderr).contains(words), "{}", text(&output.stderr));
    }
    let folder = self::folder("flies");
    let banked = format!("{AROUND}bank_deg = 10.0\n");
    rewrite(folder.path(), "banked.toml", &[], &banked);
    let output = fspid(folder.path(), Path::new("/no/python"), &["check", "banked.toml"]);
    assert_eq!(code(&output), 2);
    let told = text(&output.stderr);
    assert!(told.contains("the bridge to JSBSim levels the wings and holds no bank"), "{told}");
}

/// The simulator sleeps 0.1 s at its 50th sample, of 0.02 s; what else is late on a busy machine is told as well.
#[test]
fn a_flight_in_real_time_names_the_samples_that_come_late() {
    let real_time = ["simulate", "flown.toml", "--set", "loop.duration_s=1.2", "--real-time"];
    let output = asked("slow", &real_time);
    let told = text(&output.stderr);
    assert!(told.contains("real time: ") && told.contains("t = 1.000 s by "), "{told}");
    let folder = folder("flies");
    std::fs::write(folder.path().join("own.toml"), fspid_scenario::file::starter())
        .expect("written");
    let output =
        fspid(folder.path(), Path::new("python3"), &["simulate", "own.toml", "--real-time"]);
    assert_eq!(code(&output), 2);
    assert!(text(&output.stderr).contains("--real-time goes with a scenario that has [simulator]"));
}
