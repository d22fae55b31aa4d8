//! Words of a file: each is built as what it says, and none falls to a default.

use std::path::{Path, PathBuf};

use fspid_scenario::file;

/// The scenario that comes of the starter with these changes, in the words of the debugger, which leave nothing out.
fn built(set: &[&str]) -> String {
    let set: Vec<String> = set.iter().map(|it| (*it).to_owned()).collect();
    let study = file::parse(file::starter(), "mine.toml", None, &set).expect("a scenario");
    format!("{:?}", study.scenario)
}

/// Used to hold by chance: the last word of a list was whatever no arm named, so that a renamed word changed the
/// controller in silence.
#[test]
fn every_word_of_a_controller_builds_something_of_its_own() {
    const LIMITS: &str = "controller.FSPID.output_limits_deg=[-20.0, 20.0]";
    const MODEL: &str = "controller.FSPID.supervisor.model={ bandwidth_rad_s = 2.0 }";
    let families: [&[&[&str]]; 7] = [
        &[&["controller.FSPID.integral=bumpless"], &["controller.FSPID.integral=literal"]],
        &[
            &["controller.FSPID.derivative_on=error"],
            &["controller.FSPID.derivative_on=measurement"],
        ],
        &[
            &[LIMITS, "controller.FSPID.anti_windup={ kind = \"none\" }"],
            &[LIMITS, "controller.FSPID.anti_windup={ kind = \"conditional\" }"],
            &[
                LIMITS,
                "controller.FSPID.anti_windup={ kind = \"back-calculation\", tracking_s = 1.0 }",
            ],
            &[
                LIMITS,
                "controller.FSPID.anti_windup={ kind = \"clamping\", lower_deg = -1.0, upper_deg = 1.0 }",
            ],
        ],
        &[&["controller.FSPID.law=memoryless"], &["controller.FSPID.law=accumulating"]],
        &[
            &["controller.FSPID.supervisor.error_sign=setpoint-minus-measurement"],
            &["controller.FSPID.supervisor.error_sign=measurement-minus-setpoint"],
        ],
        &[
            &["controller.FSPID.supervisor.change=rate"],
            &["controller.FSPID.supervisor.change=delta"],
            &["controller.FSPID.supervisor.second_input=error-and-rate"],
            &["controller.FSPID.supervisor.second_input=error-and-model-error", MODEL],
        ],
        &[
            &["controller.FSPID.supervisor.out_of_range=clamp"],
            &["controller.FSPID.supervisor.out_of_range=evaluate"],
            &["controller.FSPID.supervisor.out_of_range=error"],
        ],
    ];
    for family in families {
        let all: Vec<String> = family.iter().map(|set| built(set)).collect();
        for (place, one) in all.iter().enumerate() {
            for (other, set) in all.iter().zip(family).take(place) {
                assert!(one != other, "{:?} and {set:?} build the same", family[place]);
            }
        }
    }
}

/// The types of words are matched without a wildcard; a string that is compared would be a way around them.
#[test]
fn no_reader_of_files_compares_a_word_as_a_string() {
    let sources = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut found = Vec::new();
    for folder in ["file", "requirement", "system_text"] {
        visit(&sources.join(folder), &mut found);
    }
    assert!(found.is_empty(), "{found:#?}");
}

fn visit(folder: &Path, found: &mut Vec<String>) {
    for entry in std::fs::read_dir(folder).expect("a folder") {
        let path = entry.expect("readable").path();
        if path.is_dir() {
            visit(&path, found);
        } else if path.extension().is_some_and(|it| it == "rs") {
            let text = std::fs::read_to_string(&path).expect("a source file");
            let lines = text.lines().enumerate().filter(|(_, line)| compares(line));
            found.extend(lines.map(|(at, line)| format!("{}:{}: {line}", path.display(), at + 1)));
        }
    }
}

fn compares(line: &str) -> bool {
    let of_kind = ["section.kind {", "part.kind {", "section.kind ==", "part.kind =="];
    let of_text = line.contains(".get(") && line.contains("Some(\"");
    of_text || of_kind.iter().any(|it| line.contains(it))
}

/// What another simulator is asked to fly is all of what the file says, and in SI.
#[test]
fn every_key_of_a_simulator_arrives_at_it() {
    use fspid_sim::external_plant::{JsbsimSpeed, Simulator};
    let text = crate::file::text("crates/fspid-scenario/tests/scenarios/every-key-simulator.toml");
    let asked = |set: &[&str]| {
        let set: Vec<String> = set.iter().map(|it| (*it).to_owned()).collect();
        let study = file::parse(&text, "mine.toml", None, &set).expect("a scenario");
        let plant = study.scenario.plant.external().expect("a simulator").clone();
        let Simulator::Jsbsim(jsbsim) = plant.simulator else { panic!("JSBSim") };
        (jsbsim, plant.answer_limit_s, study.digest)
    };
    let (jsbsim, limit_s, digest) = asked(&[]);
    assert_eq!(
        (jsbsim.aircraft.as_str(), jsbsim.version.as_str(), limit_s),
        ("B747", "1.3.3", 2.0)
    );
    assert_eq!((jsbsim.speed, jsbsim.seed), (JsbsimSpeed::Mach(0.65), 7));
    assert!((jsbsim.altitude_m - 6096.0).abs() < 1e-9);
    assert!((jsbsim.heading_rad - std::f64::consts::FRAC_PI_2).abs() < 1e-15);
    assert!(jsbsim.gear_is_down && !jsbsim.levels_wings);
    assert_eq!(jsbsim.properties, [("atmosphere/turb-type".to_owned(), 4.0)]);
    let (other, _, changed) = asked(&["simulator.gear=up", "simulator.wings=levelled"]);
    assert!(!other.gear_is_down && other.levels_wings && digest != changed);
    let refused = |set: &str| {
        let problems = file::parse(&text, "mine.toml", None, &[set.to_owned()]);
        problems.expect_err(set).to_string()
    };
    assert!(refused("simulator.aircraft=\"../x\"").contains("no name of an aircraft"));
    assert!(refused("simulator.calibrated_kt=200").contains("mach"));
}

/// A disturbance was asked for, did nothing, and its flight was judged as one with it.
#[test]
fn what_happens_between_samples_and_is_not_seen_is_warned_of() {
    let warned = |set: &[&str]| {
        let set: Vec<String> = set.iter().map(|&change| change.to_owned()).collect();
        let study = file::parse(file::starter(), "x.toml", None, &set);
        study.unwrap_or_else(|problems| panic!("{problems}")).warnings.join("\n")
    };
    let pulse = |at_s: f64, width_s: f64| {
        let pulse = format!(
            "disturbance=[{{enters_at='elevator', kind='pulse', amplitude_deg=5.0, at_s={at_s:?}, width_s={width_s:?}}}]"
        );
        warned(&["loop.sample_period_s=0.02", &pulse])
    };
    let told = pulse(2.001, 0.018);
    assert!(told.contains("disturbance[0].width_s") && told.contains("does not act"), "{told}");
    for (at_s, width_s) in [(2.0, 0.001), (2.001, 0.02), (1.999, 0.002)] {
        assert_eq!(pulse(at_s, width_s), "", "{at_s} {width_s}");
    }
    let servo = |frequency: f64, damping: f64| {
        let servo =
            format!("actuator={{natural_frequency_rad_s={frequency:?}, damping={damping:?}}}");
        warned(&["loop.sample_period_s=0.05", &servo])
    };
    assert!(servo(70.0, 0.1).contains("the actuator swings at 70.0 rad/s"), "{}", servo(70.0, 0.1));
    assert_eq!(servo(60.0, 0.1) + &servo(70.0, 0.7), "");
}
