//! FMUs of fuzzy systems: asked once in each step, with the bits of `fspid-fuzzy`.

use std::process::Command;

use fspid_export::program::Precision;
use fspid_export::{SystemRequest, Target, export_system};
use fspid_fuzzy::system::System;
use proptest::prelude::*;
use roxmltree::Document;

use crate::unpacked::unpacked;

/// Asks a library for rows of numbers in bits: `asking LIBRARY TOKEN ROWS INPUTS REALS WHOLES`. References count from 1, as columns do.
const ASKING: &str = r#"
#include <dlfcn.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#if FMI == 2
#define MORE
#define ENTER(it) (((int (*)(void *, int, double, double, int, double))named("fmi2SetupExperiment"))(it, 0, 0.0, 0.0, 0, 0.0), ((int (*)(void *))named("fmi2EnterInitializationMode"))(it))
#define EXIT "fmi2ExitInitializationMode"
#define SET "fmi2SetReal"
#define GET "fmi2GetReal"
#define WHOLE "fmi2GetInteger"
#else
#define MORE , 1
#define ENTER(it) ((int (*)(void *, bool, double, double, bool, double))named("fmi3EnterInitializationMode"))(it, false, 0.0, 0.0, false, 0.0)
#define EXIT "fmi3ExitInitializationMode"
#define SET "fmi3SetFloat64"
#define GET "fmi3GetFloat64"
#define WHOLE "fmi3GetInt32"
#endif
static void *library;
static void *named(const char *name)
{
    void *found = dlsym(library, name);
    if (found == NULL) { printf("no %s\n", name); exit(2); }
    return found;
}
static void *made(const char *token)
{
#if FMI == 2
    return ((void *(*)(const char *, int, const char *, const char *, const void *, int, int))named("fmi2Instantiate"))("it", 1, token, "", NULL, 0, 0);
#else
    return ((void *(*)(const char *, const char *, const char *, bool, bool, bool, bool, const unsigned *, size_t, void *, void *, void *))named(
        "fmi3InstantiateCoSimulation"))("it", token, "", false, false, false, false, NULL, 0, NULL, NULL, NULL);
#endif
}
static int stepped(void *it, double from, double by)
{
#if FMI == 2
    return ((int (*)(void *, double, double, int))named("fmi2DoStep"))(it, from, by, 1);
#else
    bool event, over, early;
    double reached;
    return ((int (*)(void *, double, double, bool, bool *, bool *, bool *, double *))named("fmi3DoStep"))(it, from, by, true, &event, &over, &early, &reached);
#endif
}
int main(int count, char **words)
{
    int inputs = atoi(words[4]), reals = atoi(words[5]), wholes = atoi(words[6]), different = 0, rows = 0;
    double time = 0.0;
    unsigned long long word;
    FILE *file = fopen(words[3], "r");
    library = dlopen(words[1], RTLD_NOW);
    if (library == NULL) { printf("%s\n", dlerror()); return 2; }
    void *it = made(words[2]);
    if (it == NULL || ENTER(it) != 0 || ((int (*)(void *))named(EXIT))(it) != 0) { printf("no instance\n"); return 2; }
    while (fscanf(file, "%llx", &word) == 1) {
        for (unsigned k = 1; k <= inputs + reals + wholes; k++) {
            double value;
            int whole = -1, status;
            if (k > 1 && fscanf(file, "%llx", &word) != 1) { return 2; }
            memcpy(&value, &word, sizeof value);
            if (k <= inputs) {
                status = ((int (*)(void *, const unsigned *, size_t, const double *, size_t))named(SET))(it, &k, 1, &value, 1);
                if (k == inputs) { status |= stepped(it, time, 0.5 + rows % 3); time += 0.5 + rows % 3; }
            } else if (k <= inputs + reals) {
                double found;
                status = ((int (*)(void *, const unsigned *, size_t, double *, size_t))named(GET))(it, &k, 1, &found, 1);
                different += memcmp(&found, &value, sizeof value) != 0;
            } else {
                status = ((int (*)(void *, const unsigned *, size_t, int *, size_t))named(WHOLE))(it, &k, 1, &whole, 1);
                different += whole != (int)value;
            }
            if (status != 0) { printf("status %d at %u\n", status, k); return 2; }
        }
        rows++;
    }
    printf("%d rows, %d different\n", rows, different);
    return 0;
}
"#;

/// What the FMU of a system answers to its vectors; nothing for one that cannot be exported.
fn asked(system: &System, target: Target) -> Option<String> {
    let request = SystemRequest {
        name: "system",
        target,
        precision: Precision::Double,
        samples: 500,
        digest: "0",
    };
    let exported = export_system(system, &request).ok()?;
    let bytes = |name: &str| {
        exported.files.iter().find(|it| it.name == name).expect("a file").bytes.clone()
    };
    let files = unpacked(&bytes("system.fmu"));
    let file =
        |ending: &str| &files.iter().find(|(name, _)| name.ends_with(ending)).expect(ending).1;
    let described = String::from_utf8(file("modelDescription.xml").clone()).expect("text");
    let document = Document::parse(&described).expect("XML");
    let root = document.root_element();
    let token = root.attribute("guid").or(root.attribute("instantiationToken")).expect("a token");
    let of = |causality: &str| {
        root.descendants().filter(|it| it.attribute("causality") == Some(causality)).count()
    };
    let reals = system.parts().outputs.len();
    let counts = [of("input"), reals, of("output") - reals];
    let csv = String::from_utf8(bytes("vectors.csv")).expect("text");
    let bits = |cell: &str| format!("{:x}", cell.parse::<f64>().expect("a number").to_bits());
    let ordered = |line: &str| {
        let cells: Vec<&str> = line.split(',').collect();
        cells.iter().map(|cell| bits(cell)).collect::<Vec<_>>().join(" ")
    };
    let rows: Vec<String> = csv.lines().skip(1).map(ordered).collect();
    let folder = tempfile::tempdir().expect("a folder");
    let at = |name: &str| folder.path().join(name);
    std::fs::write(at("rows"), rows.join("\n"))
        .and_then(|()| std::fs::write(at("asking.c"), ASKING))
        .and_then(|()| std::fs::write(at("library"), file(std::env::consts::DLL_SUFFIX)))
        .expect("files");
    let version = if target == Target::Fmu2 { "-DFMI=2" } else { "-DFMI=3" };
    let built = Command::new("cc")
        .args(["-std=gnu99", "-w", version, "asking.c", "-ldl", "-o", "asking"])
        .current_dir(folder.path())
        .output()
        .expect("the compiler that links Rust");
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    let ran = Command::new(at("asking"))
        .args([at("library").as_os_str(), token.as_ref(), at("rows").as_os_str()])
        .args(counts.map(|count| count.to_string()))
        .output()
        .expect("a program");
    Some(String::from_utf8_lossy(&ran.stdout).into_owned())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 8, max_shrink_iters: 4, ..ProptestConfig::default() })]

    #[test]
    fn the_fmu_of_any_system_answers_its_vectors_in_steps_of_any_length(
        system in fspid_options::any_system(),
        is_three in any::<bool>(),
    ) {
        let target = if is_three { Target::Fmu3 } else { Target::Fmu2 };
        if let Some(told) = asked(&system, target) {
            prop_assert_eq!(told, "500 rows, 0 different\n");
        }
    }
}
