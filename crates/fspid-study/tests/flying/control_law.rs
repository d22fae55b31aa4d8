//! Control laws from files in flight.

use std::path::PathBuf;

use fspid_scenario::file::{self, Study};
use fspid_sim::Outcome;
use fspid_study::simulation::Simulation;

fn path() -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../examples/control-law/navion.toml")
}

fn study(overrides: &[&str]) -> Study {
    let overrides: Vec<String> = overrides.iter().map(|&it| it.to_owned()).collect();
    file::load(&path(), &overrides).unwrap_or_else(|problems| panic!("{problems}"))
}

fn column(study: &Study, name: &str) -> Vec<f64> {
    let trace = fspid_sim::simulate(&study.scenario).expect("it flies").traces.remove(0);
    assert_eq!(trace.outcome, Outcome::Completed);
    trace.column(name).expect("there").to_vec()
}

#[test]
fn the_example_climbs_where_it_is_sent_and_meets_its_requirement() {
    let study = study(&[]);
    assert!(study.warnings.is_empty(), "{:?}", study.warnings);
    let simulation = Simulation::of(&study).expect("it flies");
    assert!(simulation.requirements_met(), "{}", simulation.text());
    let altitude_m = column(&study, "altitude_m");
    let last_ft = altitude_m.last().expect("samples") / 0.3048;
    assert!((1075.0..1100.0).contains(&last_ft), "{last_ft}");
}

/// Its elevator at the start is that of the trim, whatever the trim is, so that calm air moves nothing before the climb.
#[test]
fn a_trimmed_law_holds_the_trim_in_calm_air_until_its_input_changes() {
    let study = study(&["turbulence.intensity=light", "controller[0].input[2].at_s=50.0"]);
    let mut calm = study.clone();
    if let Some(weather) = &mut calm.scenario.surroundings.weather {
        weather.turbulence = None;
    }
    let altitude_m = column(&calm, "altitude_m");
    let (before, after) = altitude_m.split_at(2500);
    assert!(before.iter().all(|it| (it - 304.8).abs() < 1e-6), "{:?}", before.last());
    assert!(after.last().expect("samples") > &310.0);
}

/// Aileron and rudder are the law's: half of the bank's gain in degrees, from the bank of the sample before.
#[test]
fn the_aileron_is_the_laws_and_not_the_wing_levellers() {
    let study = study(&["turbulence.intensity=moderate"]);
    let [bank, roll, aileron] =
        ["bank_rad", "p_rad_s", "aileron_rad"].map(|name| column(&study, name));
    let mut moved = 0.0_f64;
    for k in 1..bank.len() {
        let wanted = 0.4 * bank[k - 1] + 0.2 * roll[k - 1];
        assert!((aileron[k] - wanted).abs() < 1e-12, "{k}: {} {wanted}", aileron[k]);
        moved = moved.max(wanted.abs());
    }
    assert!(moved > 1e-4, "{moved}");
}

#[test]
fn what_a_law_cannot_fly_is_refused_with_what_it_can() {
    let text = std::fs::read_to_string(path()).expect("readable");
    let refused = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        let folder = path().parent().map(std::path::Path::to_path_buf);
        let problems = file::parse(&text.replace(from, to), "a.toml", folder.as_deref(), &[]);
        problems.expect_err("wrong").to_string()
    };
    let plant = refused(
        "[aircraft]\nname = \"navion\"\nairspeed_ft_s = 176.0\naltitude_ft = 1000.0\nthrust = \"with-speed\"\n",
        "[plant]\npreset = \"navion-paper\"\n",
    );
    assert!(plant.contains("hears all that an aircraft shows"), "{plant}");
    let unset = refused(
        "name = \"altitudeMslCommand\"\nvalue = 1000.0",
        "name = \"altitudeMslCommand\"\nvalue = 1000.0\nat_s = 1.0",
    );
    assert!(unset.contains("a flight has no `altitudeMslCommand`"), "{unset}");
    let unknown = refused("trimmedPilotControl_long", "trim");
    assert!(unknown.contains("there is no input `trim`; the file has altitudeMsl"), "{unknown}");
    let mode = refused(
        "[[controller]]",
        "[[mode]]\nname = \"turn\"\nengage = []\nbank_deg = 20.0\n\n[[controller]]",
    );
    assert!(mode.contains("outer loops or modes would too"), "{mode}");
    let power = refused("trims = \"elevator\"", "trims = \"throttle\"");
    assert!(power.contains("powerLeverAngle"), "{power}");
}
