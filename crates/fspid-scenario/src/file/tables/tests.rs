//! An invented aircraft in files of tables: read, flown, refused.

use std::fs;

use fspid_aircraft::data::AircraftData;
use tempfile::TempDir;

use super::*;
use crate::file::{Problems, parse, parse_aircraft};

const AERO: &str = include_str!("../../../../fspid-daveml/tests/data/glider_aero.dml");
const BODY: &str = include_str!("../../../../fspid-daveml/tests/data/glider_body.dml");
const ENGINE: &str = include_str!("../../../../fspid-daveml/tests/data/glider_engine.dml");

const AIRCRAFT: &str = r#"
    kind = "tables"
    name = "lines"
    source = "invented"
    [tables]
    aerodynamics = "aero.dml"
    inertia = "body.dml"
    propulsion = "engine.dml"
    [body]
    gravity_ft_s2 = 32.17
    centre_of_mass_pct = 30.0
    [engine]
    angular_momentum_slug_ft2_s = 160.0
    [travel]
    elevator_deg = [-25.0, 20.0]
    aileron_deg = [-20.0, 20.0]
    rudder_deg = [-30.0, 30.0]
"#;

const SCENARIO: &str = r#"
    schema = 1
    name = "lines"
    [aircraft]
    file = "planes/lines.toml"
    airspeed_m_s = 80.0
    altitude_m = 1000.0
    [loop]
    sample_period_s = 0.01
    duration_s = 8.0
    [setpoint]
    kind = "step"
    amplitude_deg = 1.0
    at_s = 1.0
    [[controller]]
    name = "PID"
    kind = "pid"
    kp = 1.0
    ki = 0.5
    kd = 0.3
"#;

/// A folder with the aircraft and its tables in `planes`.
fn hangar() -> TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    fs::create_dir(folder.path().join("planes")).expect("made");
    let files =
        [("aero.dml", AERO), ("body.dml", BODY), ("engine.dml", ENGINE), ("lines.toml", AIRCRAFT)];
    files.iter().for_each(|(name, text)| put(&folder, name, text));
    folder
}

fn put(folder: &TempDir, name: &str, text: &str) {
    fs::write(folder.path().join("planes").join(name), text).expect("written");
}

fn read(folder: &TempDir, text: &str) -> Result<AircraftData, Problems> {
    parse_aircraft(text, "lines.toml", Some(&folder.path().join("planes")))
}

fn forces(data: &AircraftData) -> &ForceData {
    match &data.model {
        fspid_aircraft::data::ModelData::Forces(forces) => forces,
        _ => panic!("forces"),
    }
}

#[test]
fn tables_become_an_aircraft_in_si() {
    let data = read(&hangar(), AIRCRAFT).expect("an aircraft");
    let ForceData { mass, geometry, gravity_m_s2, forces, .. } = forces(&data);
    assert!((mass.mass_kg - 1_459.390_293_720_636).abs() < 1e-9);
    assert!((mass.engine_kg_m2_s - 216.930_871_733).abs() < 1e-6);
    assert!((geometry.span_m - 9.144).abs() < 1e-12);
    assert!((gravity_m_s2 - 9.805_416).abs() < 1e-12);
    assert!((forces.travel().elevator_rad.min.to_degrees() + 25.0).abs() < 1e-12);
    assert!((forces.validity().alpha_rad.max.to_degrees() - 15.0).abs() < 1e-12);
}

#[test]
fn a_scenario_flies_tables_and_its_digest_covers_them() {
    let folder = hangar();
    let study = |folder: &TempDir| parse(SCENARIO, "s.toml", Some(folder.path()), &[]);
    let before = study(&folder).expect("a study");
    let flight = fspid_sim::simulate(&before.scenario).expect("a flight");
    let theta_rad = flight.traces[0].theta_rad.last().expect("samples");
    assert!((theta_rad.to_degrees() - 1.0).abs() < 0.2, "{theta_rad}");
    put(&folder, "engine.dml", &ENGINE.replace("<cn>20</cn>", "<cn>25</cn>"));
    assert_ne!(study(&folder).expect("a study").digest, before.digest);
}

#[test]
fn what_only_derivatives_can_do_is_refused_at_its_key() {
    let line = "altitude_m = 1000.0\natmosphere = \"reference\"\ndrag = \"polar\"";
    let text = SCENARIO.replace("altitude_m = 1000.0", line);
    let problems = parse(&text, "s.toml", Some(hangar().path()), &[]).expect_err("refused");
    let paths: Vec<&str> = problems.list.iter().map(|problem| problem.path.as_str()).collect();
    assert_eq!(paths, ["aircraft.atmosphere", "aircraft.drag"]);
}

#[test]
fn air_of_its_own_is_that_of_the_file() {
    let air = "[air]\ndensity_slug_ft3 = 2.377e-3\nspeed_of_sound_ft_s = 1116.7\n";
    let data = read(&hangar(), &format!("{AIRCRAFT}{air}")).expect("an aircraft");
    let found = data.reference_environment().expect("air").air_at(5000.0);
    assert!((found.density_kg_m3 - 1.225_055_451).abs() < 1e-8);
    let without = read(&hangar(), AIRCRAFT).expect("an aircraft");
    assert!(without.reference_environment().is_err());
}

#[test]
fn problems_of_all_files_are_told_at_once_where_they_are() {
    let folder = hangar();
    put(
        &folder,
        "aero.dml",
        &AERO.replacen("varID=\"el\" units=\"deg\"", "varID=\"el\" units=\"grad\"", 1),
    );
    put(&folder, "body.dml", &BODY.replace("vrsPositionOfCM", "fuel"));
    let told = read(&folder, AIRCRAFT).expect_err("two problems").to_string();
    assert!(told.contains("lines.toml:6:20: tables.aerodynamics: `elevatorDeflection`"), "{told}");
    assert!(told.contains("tables.inertia: there is no input `vrsPositionOfCM`"), "{told}");
    put(&folder, "engine.dml", &ENGINE.replacen("</variableDef>", "", 1));
    let told = read(&folder, &AIRCRAFT.replace("body.dml", "b.dml")).expect_err("two").to_string();
    assert!(told.contains("engine.dml:") && told.contains("there is no such file"), "{told}");
    let told = parse_aircraft(AIRCRAFT, "lines.toml", None).expect_err("no folder").to_string();
    assert!(told.contains("3 problems"), "{told}");
}

/// It used to need an engine: "propulsion" was a key that had to be there.
#[test]
fn an_aircraft_without_an_engine_flies_its_glide() {
    let glider = AIRCRAFT
        .replace("    propulsion = \"engine.dml\"\n", "")
        .replace("    [engine]\n    angular_momentum_slug_ft2_s = 160.0\n", "");
    let folder = hangar();
    fs::write(folder.path().join("planes/lines.toml"), &glider).expect("written");
    let study = parse(SCENARIO, "glide.toml", Some(folder.path()), &[]).expect("it flies");
    let fspid_sim::Plant::Aircraft(plant) = study.scenario.plant else { panic!("nonlinear") };
    let path_deg = plant.trim().target.flight_path_rad.to_degrees();
    assert!(path_deg < -1.0 && path_deg > -20.0, "{path_deg}");
    let set = ["aircraft.climb_angle_deg=0".to_owned()];
    let told = parse(SCENARIO, "glide.toml", Some(folder.path()), &set).expect_err("it glides");
    assert!(told.to_string().contains("has no engine"), "{told}");
    let half = AIRCRAFT.replace("    propulsion = \"engine.dml\"\n", "");
    let told = parse_aircraft(&half, "half.toml", Some(&folder.path().join("planes")));
    assert!(told.expect_err("half").to_string().contains("there is no propulsion"));
}

/// The centre of gravity of tables is that of the scenario where it says one.
#[test]
fn a_centre_of_gravity_of_a_scenario_places_the_body_of_tables() {
    let folder = hangar();
    let elevator = |set: &[&str]| {
        let set: Vec<String> = set.iter().map(|&change| change.to_owned()).collect();
        let study = parse(SCENARIO, "cg.toml", Some(folder.path()), &set).expect("it flies");
        let fspid_sim::Plant::Aircraft(plant) = study.scenario.plant else { panic!("nonlinear") };
        plant.trim().point.elevator_rad
    };
    assert_eq!(elevator(&[]).to_bits(), elevator(&["aircraft.cg_mac=0.3"]).to_bits());
    let (known, file) = (
        elevator(&["aircraft.cg_mac=0.25"]),
        elevator(&["aircraft.file.body.centre_of_mass_pct=25.0"]),
    );
    assert!((known - file).abs() < 1e-12 && (known - elevator(&[])).abs() > 1e-4);
}

/// A flight that left a table by anything but the quantities of its box was "settled".
#[test]
fn a_flight_that_reads_a_table_beyond_its_data_has_left_the_range() {
    let table = "<variableDef name=\"copy\" varID=\"a2\" units=\"deg\"><calculation><math><apply><times/><cn>1</cn>\
                 <ci>alpha</ci></apply></math></calculation></variableDef>\
                 <variableDef name=\"cma\" varID=\"CmA\" units=\"nd\"/>\
                 <breakpointDef bpID=\"K\" units=\"deg\"><bpVals>0, 2.5</bpVals></breakpointDef>";
    let function = "<function name=\"cm\"><independentVarRef varID=\"a2\"/><dependentVarRef varID=\"CmA\"/><functionDefn>\
                    <griddedTableDef><breakpointRefs><bpRef bpID=\"K\"/></breakpointRefs><dataTable>0, 0</dataTable>\
                    </griddedTableDef></functionDefn></function></DAVEfunc>";
    let text = AERO.replacen("<cn>0.02</cn>", "<cn>0.02</cn><ci>CmA</ci>", 1);
    let text = text.replacen("  <breakpointDef", &format!("  {table}\n  <breakpointDef"), 1);
    let folder = hangar();
    put(&folder, "aero.dml", &text.replacen("</DAVEfunc>", function, 1));
    let steep = SCENARIO.replace("amplitude_deg = 1.0", "amplitude_deg = 8.0");
    let study = parse(&steep, "s.toml", Some(folder.path()), &[]).expect("a study");
    let flight = fspid_sim::simulate(&study.scenario).expect("a flight");
    let exit = flight.traces[0].exit.expect("the table is left");
    assert!(exit.departure.to_string().starts_with("table input a2 "), "{}", exit.departure);
    assert!(exit.departure.value > 2.5);
}

#[test]
fn an_input_that_no_flight_has_is_a_warning_of_every_scenario_that_flies_it() {
    let folder = hangar();
    let study = parse(SCENARIO, "s.toml", Some(folder.path()), &[]).expect("a study");
    let [warning] = study.warnings.as_slice() else { panic!("{:?}", study.warnings) };
    let held = "tables.aerodynamics: a flight has no `gearPosition`, which stays at its initial value, 0.0; known are";
    assert!(warning.starts_with(held), "{warning}");
    let data = read(&folder, AIRCRAFT).expect("an aircraft");
    assert_eq!(forces(&data).held.len(), 1);
}
