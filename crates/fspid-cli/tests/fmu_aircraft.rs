//! FMUs that fly as aircraft.

use std::path::Path;
use std::process::Command;

use crate::common::{code, text};
use crate::other_simulators::{SIMULATE, ending, folder, fspid};

/// Of FMI 2.0: $\ddot\theta = -4 \theta - 2.4 \dot\theta + 4 e$ of an elevator that is nose up positive, in degrees.
const FMU: &str = r#"
#include <stddef.h>
#include <stdlib.h>
struct it { double e, theta, q; int samples; };
void *fmi2Instantiate(const char *n, int t, const char *g, const char *r, const void *c, int v, int l) { struct it *it = calloc(1, sizeof *it); it->theta = 2; return it; }
int fmi2SetupExperiment(void *it, int t, double a, double b, int s, double e) { return 0; }
int fmi2EnterInitializationMode(void *it) { return 0; }
int fmi2ExitInitializationMode(void *it) { return 0; }
int fmi2SetReal(void *of, const unsigned *w, size_t n, const double *v) { ((struct it *)of)->e = v[0]; return 0; }
int fmi2GetReal(void *of, const unsigned *w, size_t n, double *v) { struct it *it = of; v[0] = w[0] == 1 ? it->theta : it->q; return 0; }
int fmi2GetInteger(void *it, const unsigned *w, size_t n, int *v) { return 3; }
int fmi2GetBoolean(void *it, const unsigned *w, size_t n, int *v) { return 3; }
int fmi2DoStep(void *of, double t, double h, int k) {
    struct it *it = of;
    if (++it->samples == AT) abort();
    it->q += h * (-4 * (it->theta - 2) - 2.4 * it->q + 4 * it->e);
    it->theta += h * it->q;
    return 0;
}
"#;

const FMU_DESCRIPTION: &str = "<fmiModelDescription fmiVersion='2.0' guid='g'><CoSimulation modelIdentifier='plane'/><ModelVariables>\
    <ScalarVariable name='stick' causality='input' valueReference='0'><Real unit='deg'/></ScalarVariable>\
    <ScalarVariable name='pitch' causality='output' valueReference='1'><Real unit='deg'/></ScalarVariable>\
    <ScalarVariable name='rate' causality='output' valueReference='2'><Real unit='deg/s'/></ScalarVariable>\
    </ModelVariables></fmiModelDescription>";

/// A folder with a scenario that flies an FMU, which aborts at a step.
pub(crate) fn folder_of_fmu(aborts_at: i32) -> tempfile::TempDir {
    let folder = folder("flies");
    let path = folder.path();
    std::fs::write(path.join("plane.c"), FMU).expect("a source");
    let built = Command::new("cc")
        .args(["-shared", "-fPIC", "-O1", "-ffp-contract=off", "-w", "plane.c", "-o", "plane.so"])
        .arg(format!("-DAT={aborts_at}"))
        .current_dir(path)
        .status();
    assert!(built.expect("a compiler").success());
    let library = std::fs::read(path.join("plane.so")).expect("a library");
    let (arch, ending) = (std::env::consts::ARCH, std::env::consts::DLL_SUFFIX);
    let system = if cfg!(target_os = "macos") { "darwin" } else { std::env::consts::OS };
    let place = format!("binaries/{arch}-{system}/plane{ending}");
    let files = [("modelDescription.xml", FMU_DESCRIPTION.as_bytes()), (place.as_str(), &library)];
    std::fs::write(path.join("plane.fmu"), crate::foreign_fmu::zip(&files)).expect("an FMU");
    let scenario = std::fs::read_to_string(path.join("flown.toml")).expect("it is there");
    let (before, rest) = scenario.split_once("[simulator]").expect("a simulator");
    let (_, behind) = rest.split_once("[loop]").expect("a loop");
    let simulator = "[simulator]\nkind = \"fmu\"\nfile = \"plane.fmu\"\ninputs = { elevator_deg = \"-stick\" }\noutputs = { theta_deg = \"pitch\", q_deg_s = \"rate\" }\n";
    std::fs::write(path.join("flown.toml"), format!("{before}{simulator}[loop]{behind}"))
        .expect("written");
    folder
}

/// The sums of the FMU, made here, in degrees: a nose up command is a stick of the same size.
#[test]
fn an_fmu_flies_as_an_aircraft_with_names_units_and_sign_of_its_own() {
    let folder = folder_of_fmu(-1);
    let output = fspid(
        folder.path(),
        Path::new("/no/python"),
        &["simulate", "flown.toml", "--trace", "t.csv"],
    );
    assert_eq!(code(&output), 0, "{}", text(&output.stderr));
    let csv = std::fs::read_to_string(folder.path().join("t.csv")).expect("a trace");
    let mut lines = csv.lines();
    let names: Vec<&str> = lines.next().expect("a head").split(',').collect();
    // Of height and speed the FMU says nothing, and neither does the trace.
    assert!(!names.contains(&"altitude_m"), "{names:?}");
    let place = |name: &str| names.iter().position(|it| *it == name).expect("a column");
    let (theta, command) = (place("theta_deg"), place("command_deg"));
    let rows: Vec<Vec<f64>> = lines
        .map(|line| line.split(',').map(|it| it.parse().expect("a number")).collect())
        .collect();
    let (mut theta_deg, mut q_deg_s) = (0.0, 0.0);
    for two in rows.windows(2) {
        let [now, next] = two else { continue };
        for _ in 0..2 {
            q_deg_s += 0.01 * (-4.0 * theta_deg - 2.4 * q_deg_s + 4.0 * now[command]);
            theta_deg += 0.01 * q_deg_s;
        }
        assert!((next[theta] - theta_deg).abs() < 1e-9, "{now:?} {next:?}");
    }
}

#[test]
fn an_fmu_that_aborts_is_a_lost_plant_and_one_without_a_pitch_is_refused_with_what_it_offers() {
    let folder = folder_of_fmu(50);
    let output = fspid(folder.path(), Path::new("/no/python"), SIMULATE);
    assert_eq!(code(&output), 1, "{}", text(&output.stderr));
    let outcome = ending(&output)["outcome"].clone();
    assert_eq!(
        (outcome["kind"].as_str(), outcome["loss"].as_str()),
        (Some("plant lost"), Some("crashed"))
    );
    let set = ["simulate", "flown.toml", "--set", "simulator.outputs.theta_deg=height"];
    let refused = fspid(folder.path(), Path::new("/no/python"), &set);
    assert_eq!(code(&refused), 2);
    let told = text(&refused.stderr);
    assert!(
        told.contains("has no output `height`") && told.contains("one of its outputs: pitch, rate"),
        "{told}"
    );
}
