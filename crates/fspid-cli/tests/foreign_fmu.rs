//! FMUs that other tools might have written: other names, other units, another sign, and nothing to rely on.

use std::path::Path;
use std::process::{Command, Output};

use crate::common::{code, fspid, text, with_input};

/// A law in C as an FMU of both versions, with names of its own.
const LAW: &str = r#"
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>
struct law { double real[4]; int samples; };
static int set(struct law *it, const unsigned *which, size_t count, const double *values)
{
    for (size_t k = 0; k < count; k++) {
        if (which[k] > 2) return 3;
        it->real[which[k]] = values[k];
    }
    return 0;
}
static int get(struct law *it, const unsigned *which, size_t count, double *values)
{
    for (size_t k = 0; k < count; k++) {
        if (which[k] > 3) return 3;
        values[k] = it->real[which[k]];
    }
    return 0;
}
static int step(struct law *it)
{
    it->samples += 1;
    it->real[3] = -(0.8 * (it->real[0] - it->real[1]) - 0.1 * it->real[2]);
    if (it->samples == AT + 1) { STRANGE; }
    return 0;
}
void *fmi2Instantiate(const char *n, int t, const char *g, const char *r, const void *c, int v, int l) { return calloc(1, sizeof(struct law)); }
int fmi2SetupExperiment(void *it, int t, double a, double b, int s, double e) { return 0; }
int fmi2EnterInitializationMode(void *it) { return 0; }
int fmi2ExitInitializationMode(void *it) { return 0; }
int fmi2SetReal(void *it, const unsigned *w, size_t n, const double *v) { return set(it, w, n, v); }
int fmi2GetReal(void *it, const unsigned *w, size_t n, double *v) { return get(it, w, n, v); }
int fmi2GetInteger(void *it, const unsigned *w, size_t n, int *v) { return 3; }
int fmi2GetBoolean(void *it, const unsigned *w, size_t n, int *v) { return 3; }
int fmi2DoStep(void *it, double t, double h, int k) { return step(it); }
void *fmi3InstantiateCoSimulation(const char *n, const char *g, const char *r, bool v, bool l, bool e, bool y, const unsigned *i, size_t c, void *o, void *m, void *u) { return calloc(1, sizeof(struct law)); }
int fmi3EnterInitializationMode(void *it, bool t, double a, double b, bool s, double e) { return 0; }
int fmi3ExitInitializationMode(void *it) { return 0; }
int fmi3SetFloat64(void *it, const unsigned *w, size_t n, const double *v, size_t c) { return set(it, w, n, v); }
int fmi3GetFloat64(void *it, const unsigned *w, size_t n, double *v, size_t c) { return get(it, w, n, v); }
int fmi3GetInt32(void *it, const unsigned *w, size_t n, int *v, size_t c) { return 3; }
int fmi3GetBoolean(void *it, const unsigned *w, size_t n, bool *v, size_t c) { return 3; }
int fmi3DoStep(void *it, double t, double h, bool n, bool *e, bool *o, bool *a, double *l) { return step(it); }
"#;

/// The same law behind the five functions, in our names and with our sign.
const SAME: &str = r#"
#include "fspid_external.h"
uint32_t fspid_external_version(void) { return FSPID_EXTERNAL_VERSION; }
double fspid_external_period_s(void) { return 0.0; }
size_t fspid_external_state_bytes(void) { return 0; }
void fspid_external_reset(void *state) { (void)state; }
void fspid_external_step(void *state, const fspid_external_sample *sample, fspid_external_answer *answer)
{
    answer->command_rad = 0.8 * (sample->setpoint_rad - sample->measurement_rad) - 0.1 * sample->rate_rad_s;
}
"#;

/// The names of the law's variables, in a unit.
fn description(version: u8, unit: &str) -> String {
    let names = [("theta_ref", "input"), ("theta", "input"), ("q", "input"), ("delta_e", "output")];
    let variable = |(at, (name, causality)): (usize, &(&str, &str))| {
        let unit = if *name == "q" { format!("{unit}/s") } else { unit.to_owned() };
        let common = format!("name='{name}' causality='{causality}' valueReference='{at}'");
        match version {
            2 => format!("<ScalarVariable {common}><Real unit='{unit}'/></ScalarVariable>"),
            _ => format!("<Float64 {common} unit='{unit}'/>"),
        }
    };
    let variables: String = names.iter().enumerate().map(variable).collect();
    format!(
        "<fmiModelDescription fmiVersion='{version}.0' guid='g' instantiationToken='g'><CoSimulation modelIdentifier='law'/>\
         <DefaultExperiment stepSize='0.5'/><ModelVariables>{variables}</ModelVariables></fmiModelDescription>"
    )
}

/// The sum that archives carry, bit by bit.
fn crc32(bytes: &[u8]) -> u32 {
    let turned = |sum: u32, _| (sum >> 1) ^ (0xedb8_8320 & (sum & 1).wrapping_neg());
    !bytes.iter().fold(u32::MAX, |sum, byte| (0..8).fold(sum ^ u32::from(*byte), turned))
}

/// An archive of files as they are.
pub(crate) fn zip(files: &[(&str, &[u8])]) -> Vec<u8> {
    let (mut bytes, mut directory) = (Vec::new(), Vec::new());
    for (name, content) in files {
        let [offset, size] = [bytes.len(), content.len()].map(|it| (it as u32).to_le_bytes());
        let name_size = (name.len() as u16).to_le_bytes();
        let sum = crc32(content).to_le_bytes();
        let common =
            [&[20, 0, 0, 0, 0, 0, 0, 0, 0, 0][..], &sum, &size, &size, &name_size, &[0, 0]];
        let common = common.concat();
        bytes.extend([b"PK\x03\x04", &common[..], name.as_bytes(), content].concat());
        let places = [&[0; 10][..], &offset, name.as_bytes()].concat();
        directory.extend([b"PK\x01\x02\x14\0", &common[..], &places].concat());
    }
    let count = (files.len() as u16).to_le_bytes();
    let [size, offset] = [directory.len(), bytes.len()].map(|it| (it as u32).to_le_bytes());
    let end = [b"PK\x05\x06\0\0\0\0", &count[..], &count, &size, &offset, &[0, 0]].concat();
    [bytes, directory, end].concat()
}

/// Compiles the law as it is, but for what it does at a sample.
fn compiled(folder: &Path, does: &str, at: usize) -> Vec<u8> {
    std::fs::write(folder.join("law.c"), LAW).expect("a file");
    let built = Command::new("cc")
        .args([
            "-shared",
            "-fPIC",
            "-O1",
            "-ffp-contract=off",
            "-w",
            "law.c",
            "-lm",
            "-o",
            "law.so",
        ])
        .args([format!("-DSTRANGE={does}"), format!("-DAT={at}")])
        .current_dir(folder)
        .status();
    assert!(built.is_ok_and(|status| status.success()));
    std::fs::read(folder.join("law.so")).expect("a library")
}

/// Writes an FMU of the law.
fn fmu(folder: &Path, name: &str, (version, unit): (u8, &str), library: &[u8]) {
    let (arch, ending) = (std::env::consts::ARCH, std::env::consts::DLL_SUFFIX);
    let system = if cfg!(target_os = "macos") { "darwin" } else { std::env::consts::OS };
    let place = format!("binaries/{arch}-{system}/law{ending}");
    let text = description(version, unit);
    let files = [("modelDescription.xml", text.as_bytes()), (place.as_str(), library)];
    std::fs::write(folder.join(name), zip(&files)).expect("an FMU");
}

fn folder() -> tempfile::TempDir {
    let folder = tempfile::tempdir().expect("a folder");
    assert_eq!(code(&fspid(&["init", "pitch.toml"], folder.path())), 0);
    folder
}

const NAMED: [&str; 8] = [
    "--input",
    "setpoint_rad=theta_ref",
    "--input",
    "measurement_rad=theta",
    "--input",
    "rate_rad_s=q",
    "--output",
    "command_rad=-delta_e",
];

fn flown(folder: &Path, fmu: &str, names: &[&str]) -> Output {
    fspid(&[&["simulate", "pitch.toml", "--trace", "t.csv", "--fmu", fmu], names].concat(), folder)
}

/// A column of the last trace.
fn column(folder: &Path, name: &str) -> Vec<f64> {
    let csv = std::fs::read_to_string(folder.join("t.csv")).expect("traces");
    let at = csv.lines().next().and_then(|line| line.split(',').position(|it| it == name));
    let at = at.expect("a column");
    let number = |line: &str| line.split(',').nth(at).and_then(|it| it.parse().ok());
    csv.lines().skip(1).map(|line| number(line).expect("a number")).collect()
}

#[test]
fn an_fmu_with_names_of_its_own_flies_as_the_same_law_does() {
    let folder = folder();
    let place = folder.path();
    std::fs::write(place.join("fspid_external.h"), fspid_export::write::EXTERNAL_HEADER)
        .and_then(|()| std::fs::write(place.join("same.c"), SAME))
        .expect("files");
    crate::external::library(place, "same.so", &["same.c".into()], &[]);
    assert_eq!(
        code(&fspid(
            &["simulate", "pitch.toml", "--library", "same.so", "--trace", "t.csv"],
            place
        )),
        0
    );
    let own = column(place, "same.so.command_deg");
    let library = compiled(place, "", 0);
    let in_degrees = NAMED.map(|it| it.replace("_rad=", "_deg=").replace("rad_s=", "deg_s="));
    for version in [2, 3] {
        fmu(place, "law.fmu", (version, "rad"), &library);
        let output = flown(place, "law.fmu", &NAMED);
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
        assert!(column(place, "law.fmu.command_deg") == own, "FMI {version}: bits differ");
        // In degrees the same law rounds elsewhere.
        fmu(place, "law.fmu", (version, "deg"), &library);
        let output = flown(place, "law.fmu", &in_degrees.each_ref().map(String::as_str));
        assert_eq!(code(&output), 0, "{}", text(&output.stderr));
        let near = column(place, "law.fmu.command_deg");
        assert!(
            near.len() == own.len() && near.iter().zip(&own).all(|(a, b)| (a - b).abs() < 1e-9)
        );
    }
    // The same in a scenario.
    fmu(place, "law.fmu", (3, "rad"), &library);
    let inputs = "inputs = { setpoint_rad = \"theta_ref\", measurement_rad = \"theta\", rate_rad_s = \"q\" }";
    let entry = format!(
        "\n[[controller]]\nname = \"law\"\nkind = \"external\"\nfmu = \"law.fmu\"\n{inputs}\noutputs = {{ command_rad = \"-delta_e\" }}\n"
    );
    let scenario = std::fs::read_to_string(place.join("pitch.toml")).expect("a scenario");
    std::fs::write(place.join("law.toml"), scenario + &entry).expect("a scenario");
    assert_eq!(code(&fspid(&["simulate", "law.toml", "--trace", "t.csv"], place)), 0);
    assert!(column(place, "law.command_deg") == own);
}

#[test]
fn what_does_not_fit_an_fmu_is_refused_with_what_it_offers() {
    let folder = folder();
    fmu(folder.path(), "law.fmu", (2, "rad"), &compiled(folder.path(), "", 0));
    let told = |names: &[&str]| {
        let output = flown(folder.path(), "law.fmu", names);
        assert_eq!(code(&output), 2, "{names:?}");
        text(&output.stderr)
    };
    let changed = |at: usize, name: &'static str| {
        let mut names = NAMED;
        names[at] = name;
        told(&names)
    };
    let none = told(&[]);
    assert!(none.contains("has no variable setpoint_rad"), "{none}");
    assert!(
        none.contains("--input setpoint_rad=NAME with one of its inputs: theta_ref, theta, q"),
        "{none}"
    );
    let near = changed(1, "setpoint_rad=thetaref");
    assert!(near.contains("has no input `thetaref`, did you mean `theta_ref`; allowed is one of its inputs: theta_ref, theta, q"), "{near}");
    let unit = changed(3, "measurement_deg=theta");
    assert!(
        unit.contains(
            "`theta` is in rad, not as measurement_deg says; allowed is measurement_rad=theta"
        ),
        "{unit}"
    );
    let swapped = changed(7, "command_rad=theta");
    assert!(
        swapped.contains(
            "its variable `theta` is no output but input; allowed is one of its outputs: delta_e"
        ),
        "{swapped}"
    );
    let key = changed(1, "setpoint=theta_ref");
    assert!(key.contains("setpoint_rad"), "{key}");
    assert!(
        changed(1, "theta_ref")
            .contains("allowed is NAME=VARIABLE, such as setpoint_rad=theta_ref")
    );
    let both = told(&[&NAMED[..], &["--input", "setpoint_deg=theta_ref"]].concat());
    assert!(both.contains("is given beside setpoint_rad"), "{both}");
    let two = told(&[&NAMED[..], &["--fmu", "law.fmu"]].concat());
    assert!(two.contains("--input and --output go with one --fmu"), "{two}");
    let entry = "controller[]={ name = \"X\", kind = \"external\", library = \"law.so\", inputs = { setpoint_rad = \"x\" } }";
    let output = fspid(&["simulate", "pitch.toml", "--set", entry], folder.path());
    assert!(
        code(&output) == 2 && text(&output.stderr).contains("inputs"),
        "{}",
        text(&output.stderr)
    );
}

#[test]
fn whatever_an_fmu_does_ends_its_flight_alone() {
    let folder = folder();
    for (does, told) in [
        ("*(volatile int *)8 = 1", "crashed with SIGSEGV"),
        ("exit(3)", "ended its process with code 3"),
        ("it->real[3] = NAN", "answered a command that is not finite"),
        ("it->real[3] = INFINITY", "answered a command that is not finite"),
        ("return 3", "refused with FMI status 3"),
        ("return 5", "refused with FMI status 5"),
    ] {
        for (version, at) in [(2, 0), (3, 9)] {
            fmu(folder.path(), "law.fmu", (version, "rad"), &compiled(folder.path(), does, at));
            let output = flown(folder.path(), "law.fmu", &NAMED);
            let time_s = ["0", "0.09"][at / 9];
            let said = text(&output.stdout);
            assert_eq!(code(&output), 1, "{does}: {}", text(&output.stderr));
            assert!(said.contains(&format!("the controller {told} at t = {time_s} s")), "{said}");
            let asked = [&["fly", "pitch.toml", "--fmu", "law.fmu"], &NAMED[..]].concat();
            let output = with_input(&asked, folder.path(), &"5 1 0.01 0\n".repeat(12));
            assert_eq!((code(&output), text(&output.stdout).lines().count()), (1, 12));
            assert!(text(&output.stderr).contains(&format!("{told} at t = {time_s} s")));
        }
    }
}

#[test]
fn an_archive_that_means_harm_is_refused_and_writes_nothing_outside() {
    let folder = folder();
    let place = folder.path().join("inside");
    std::fs::create_dir(&place).expect("a folder");
    let evil = folder.path().join("evil.txt");
    let absolute = evil.to_str().expect("text");
    let refused = |name: &str, bytes: &[u8], words: &str| {
        std::fs::write(folder.path().join(name), bytes).expect("a file");
        let told = text(&flown(folder.path(), name, &NAMED).stderr);
        assert!(told.contains(words), "{name}: {told}");
    };
    for (name, path) in [("up.fmu", "../../../../../../../evil.txt"), ("root.fmu", absolute)] {
        refused(name, &zip(&[(path, b"harm")]), "a name in it leads out of the folder");
    }
    assert!(!evil.exists());
    refused("empty.fmu", &zip(&[]), "its modelDescription.xml cannot be read");
    refused("no.fmu", &zip(&[("modelDescription.xml", b"<a><b></a>")]), "is no XML");
    let description = description(2, "rad");
    let bare = zip(&[("modelDescription.xml", description.as_bytes())]);
    refused("bare.fmu", &bare, "has no library for");
    let led_out = description.replace("Identifier='law'", "Identifier='../../law'");
    let led_out = zip(&[("modelDescription.xml", led_out.as_bytes())]);
    refused("led.fmu", &led_out, "its model identifier \"../../law\" is no name");
    for cut in [10, 40, bare.len() / 2, bare.len() - 30] {
        std::fs::write(folder.path().join("cut.fmu"), &bare[..cut]).expect("a file");
        assert_eq!(code(&flown(folder.path(), "cut.fmu", &NAMED)), 2, "{cut}");
    }
    // Without its bytes: a file system keeps none for it.
    let large = std::fs::File::create(folder.path().join("large.fmu")).expect("a file");
    large.set_len((64 << 20) + 1).expect("room");
    let told = text(&flown(folder.path(), "large.fmu", &NAMED).stderr);
    assert!(told.contains("it is larger than 64 MiB"), "{told}");
}
