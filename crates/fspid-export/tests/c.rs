//! The C that is written answers what the controller answers, bit for bit.

use std::path::Path;
use std::process::Command;

use fspid_core::Controller;
use fspid_export::program::Value;
use fspid_export::vectors::eventful;
use fspid_export::write::{Heading, c, c_harness, c_selftest, platformio, sketch};
use fspid_export::{Angles, program};
use fspid_numeric::Real;
use proptest::prelude::*;

const FLAGS: [&str; 8] = [
    "-std=c99",
    "-O1",
    "-Wall",
    "-Wextra",
    "-Wconversion",
    "-Wfloat-equal",
    "-Werror",
    "-ffp-contract=off",
];

/// What a program of these sources prints.
fn built_and_run(folder: &Path, sources: &[&str]) -> String {
    let built = Command::new("cc")
        .args(FLAGS)
        .args(sources)
        .args(["-o", "main"])
        .current_dir(folder)
        .output()
        .expect("the compiler that links Rust");
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    let ran = Command::new(folder.join("main")).output().expect("what was built");
    String::from_utf8_lossy(&ran.stdout).into_owned()
}

pub(crate) fn write_all<R: Real>(
    controller: &Controller<R>,
    angles: Angles,
    folder: &Path,
    main: Option<&str>,
) {
    let program = program(controller, angles).expect("nothing here is refused");
    let heading = Heading {
        name: "pitch",
        digest: "0",
        precision: program.precision,
        angles: Some(angles),
        elevator: None,
    };
    let files = c(&program, "pitch", &heading);
    let vectors = eventful(controller, angles, 1, 3000);
    let harness = c_harness(&program, "pitch", &vectors);
    let selftest = c_selftest(&program, controller, "pitch", &heading);
    for (name, text) in [
        ("pitch.h", files.header.as_str()),
        ("pitch.c", &files.source),
        ("pitch_selftest.c", &selftest),
        ("main.c", main.unwrap_or(&harness)),
    ] {
        std::fs::write(folder.join(name), text).expect("a temporary file");
    }
}

fn run<R: Real>(controller: &Controller<R>, angles: Angles, folder: &Path) -> String {
    write_all(controller, angles, folder, None);
    built_and_run(folder, &["pitch.c", "main.c"])
}

/// Asks the self test of the design, of each rule that says something else, and of a number that is another one.
const WRONG: &str = r#"
#include <stdio.h>
#include "pitch.h"
int main(void)
{
    unsigned missed = 0U;
    pitch_configuration other = pitch_design;
    if (pitch_selftest(&pitch_design) != 0U) { printf("the design: %u\n", pitch_selftest(&pitch_design)); }
#ifdef RULES
    for (unsigned rule = 0U; rule < 49U; ++rule) {
        for (unsigned label = 1U; label < 7U; ++label) {
            other = pitch_design;
            CHANGE(other.rules_kp[rule]);
            missed += pitch_selftest(&other) != rule + 1U;
            other = pitch_design;
            CHANGE(other.rules_ki[rule]);
            missed += pitch_selftest(&other) != rule + 101U;
            other = pitch_design;
            CHANGE(other.rules_kd[rule]);
            missed += pitch_selftest(&other) != rule + 201U;
        }
    }
#endif
    other = pitch_design;
    other.dt_s += other.dt_s / 1000000;
    missed += pitch_selftest(&other) != 300U;
    printf("%u missed\n", missed);
    return 0;
}
"#;

/// What a self test of this controller does not find.
fn self_tested<R: Real>(controller: &Controller<R>, angles: Angles, folder: &Path) -> String {
    let program = program(controller, angles).expect("nothing here is refused");
    let rules = program.configuration.iter().find(|member| member.name == "rules_kp");
    let change = match rules.map(|member| &member.value) {
        None => "",
        Some(Value::Bytes(_)) => {
            "#define RULES\n#define CHANGE(cell) cell = (uint8_t)((cell + label) % 7U)\n"
        }
        Some(_) => "#define RULES\n#define CHANGE(cell) cell += (cell / 1000000) + 1\n",
    };
    let main = change.to_owned() + WRONG;
    write_all(controller, angles, folder, Some(&main));
    built_and_run(folder, &["pitch.c", "pitch_selftest.c", "main.c"])
}

/// What the compiler says of the controller's source with these flags; nothing where it takes it.
fn refusal(folder: &Path, flags: &[&str]) -> String {
    let built = Command::new("cc")
        .args(["-std=c99", "-O1", "-fsyntax-only", "pitch.c"])
        .args(flags)
        .current_dir(folder)
        .output()
        .expect("the compiler that links Rust");
    if built.status.success() {
        String::new()
    } else {
        String::from_utf8_lossy(&built.stderr).into_owned()
    }
}

/// Flags as of a machine whose constant `name` is `value`.
fn machine(name: &str, value: &str) -> [String; 2] {
    [format!("-U{name}"), format!("-D{name}={value}")]
}

#[test]
fn a_compiler_with_other_numbers_than_those_that_were_checked_stops() {
    let (controller, folder) =
        (crate::common::paper(), tempfile::tempdir().expect("a temporary folder"));
    let refused = |flags: &[String]| {
        let flags: Vec<&str> = flags.iter().map(String::as_str).collect();
        refusal(folder.path(), &flags)
    };
    let eval = |method: &str| machine("__FLT_EVAL_METHOD__", method);
    let plain = |flag: &str| [flag.to_owned()];
    let other_bits = "-DFSPID_OTHER_BITS".to_owned();
    let single = controller.rounded::<f32>().expect("a controller of 32 bits");
    write_all(&single, Angles::Radians, folder.path(), None);
    assert_eq!(refused(&machine("__DBL_MANT_DIG__", "24")), "", "an AVR");
    assert!(refused(&eval("1")).contains("rounded at every operation"));
    write_all(&controller, Angles::Radians, folder.path(), None);
    assert_eq!(refused(&[]), "");
    let avr = [&machine("__DBL_MANT_DIG__", "24")[..], std::slice::from_ref(&other_bits)].concat();
    assert!(refused(&avr).contains("--numbers single"), "an AVR");
    assert!(refused(&plain("-ffinite-math-only")).contains("-ffast-math"));
    assert_eq!(refused(&eval("1")), "");
    for method in ["2", "-1"] {
        assert!(refused(&eval(method)).contains("rounded at every operation"), "{method}");
    }
    for word in ["__ASSOCIATIVE_MATH__", "__RECIPROCAL_MATH__", "__NO_SIGNED_ZEROS__"] {
        let flags = machine(word, "1");
        assert!(refused(&flags).contains("as it is written"), "{word}");
        assert_eq!(
            refused(&[&flags[..], std::slice::from_ref(&other_bits)].concat()),
            "",
            "{word}"
        );
    }
}

#[test]
fn what_lies_beside_a_controller_of_64_bits_says_that_an_avr_has_none() {
    let controller = crate::common::paper();
    let program_of_64 = program(&controller, Angles::Degrees).expect("nothing here is refused");
    let single = controller.rounded::<f32>().expect("a controller of 32 bits");
    let program_of_32 = program(&single, Angles::Degrees).expect("nothing here is refused");
    for (program, avr) in [(program_of_64, false), (program_of_32, true)] {
        let angles = Some(Angles::Degrees);
        let heading = Heading {
            name: "pitch",
            digest: "0",
            precision: program.precision,
            angles,
            elevator: None,
        };
        let sketch = sketch(&program, "pitch", &heading).expect("a sketch");
        assert_eq!(sketch.contains("export it with --numbers single"), !avr);
        let library = platformio("pitch", program.precision);
        assert_eq!(library.contains("\"platforms\": \"*\""), avr, "{library}");
        assert!(!library.contains("avr"), "{library}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 8, max_shrink_iters: 8, ..ProptestConfig::default() })]

    #[test]
    fn the_c_of_any_controller_answers_as_the_controller_without_a_warning(
        controller in fspid_options::any_controller(),
        degrees in any::<bool>(),
    ) {
        let angles = if degrees { Angles::Degrees } else { Angles::Radians };
        let folder = tempfile::tempdir().expect("a temporary folder");
        prop_assert_eq!(run(&controller, angles, folder.path()), "3000 samples, 0 different\n");
        if let Ok(single) = controller.rounded::<f32>() {
            prop_assert_eq!(run(&single, angles, folder.path()), "3000 samples, 0 different\n");
        }
    }

    #[test]
    fn the_self_test_names_the_rule_that_is_wrong(
        controller in fspid_options::any_controller(),
        degrees in any::<bool>(),
    ) {
        let angles = if degrees { Angles::Degrees } else { Angles::Radians };
        let folder = tempfile::tempdir().expect("a temporary folder");
        prop_assert_eq!(self_tested(&controller, angles, folder.path()), "0 missed\n");
        if let Ok(single) = controller.rounded::<f32>() {
            prop_assert_eq!(self_tested(&single, angles, folder.path()), "0 missed\n");
        }
    }
}
