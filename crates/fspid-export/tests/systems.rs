//! The program of a fuzzy system answers what `fspid-fuzzy` answers, bit for bit.

use std::path::Path;
use std::process::Command;

use fspid_export::interpret::{Cell, Machine};
use fspid_export::program::{Part, Precision};
use fspid_export::write::{Heading, structured_text};
use fspid_export::{
    NOT_FINITE, OUT_OF_RANGE, SystemProgram, SystemRequest, Target, export_system, source_code,
    system_program, system_vectors,
};
use fspid_fuzzy::system::System;
use proptest::prelude::*;

/// Values and sources of a program's outputs, and its faults.
type Answered = (Vec<u64>, Vec<u8>, u8);

fn of_program(machine: &mut Machine<'_, f64>, program: &SystemProgram, inputs: &[f64]) -> Answered {
    let names = &program.names;
    for (name, value) in names.inputs.iter().zip(inputs) {
        machine.set(Part::Sample, name, Cell::Real(*value));
    }
    machine.run("infer");
    let real = |name: &String| match machine.member(Part::Answer, name) {
        Some(Cell::Real(value)) => value.to_bits(),
        other => panic!("{name} is {other:?}"),
    };
    let byte = |name: &String| match machine.member(Part::Answer, name) {
        Some(Cell::Byte(value)) => *value,
        other => panic!("{name} is {other:?}"),
    };
    let values = names.outputs.iter().map(real).collect();
    (values, names.sources.iter().map(byte).collect(), byte(&names.faults))
}

fn of_system(system: &System, inputs: &[f64], previous: &mut Vec<Option<f64>>) -> Answered {
    let outputs = system.parts().outputs.len();
    match system.evaluate_after(inputs, previous, &mut system.workspace()) {
        Ok(answers) => {
            *previous = answers.iter().map(|it| it.value).collect();
            (
                answers.iter().map(|it| it.value.unwrap_or(0.0).to_bits()).collect(),
                answers.iter().map(|it| source_code(it.source)).collect(),
                0,
            )
        }
        Err(_) => {
            let bad = inputs.iter().any(|value| !value.is_finite());
            let outside = system.parts().inputs.iter().zip(inputs).any(|(input, value)| {
                let refuses = input.out_of_range == fspid_fuzzy::OutOfRange::Error;
                refuses
                    && value.is_finite()
                    && input.universe.is_some_and(|universe| !universe.contains(*value))
            });
            let faults = u8::from(bad) * NOT_FINITE + u8::from(outside) * OUT_OF_RANGE;
            (vec![0; outputs], vec![0; outputs], faults)
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, ..ProptestConfig::default() })]

    #[test]
    fn the_program_of_any_system_answers_as_the_system(
        system in fspid_options::any_system(),
        seed in any::<u64>(),
    ) {
        let Ok(program) = system_program::<f64>(&system) else { return Ok(()) };
        let mut machine = Machine::<f64>::new(&program.program);
        let mut previous = Vec::new();
        for k in 0..40 {
            let inputs = fspid_options::inputs_of(&system, seed.wrapping_add(k));
            let found = of_program(&mut machine, &program, &inputs);
            let wanted = of_system(&system, &inputs, &mut previous);
            prop_assert_eq!(found, wanted, "{:?}\n{:#?}", inputs, system.parts());
        }
    }
}

/// Compiles an export and asks it for its vectors.
fn ran(system: &System, precision: Precision, folder: &Path) -> Option<String> {
    let request =
        SystemRequest { name: "a system", target: Target::C, precision, samples: 300, digest: "0" };
    let exported = export_system(system, &request).ok()?;
    for file in exported.files.iter().filter(|file| !file.name.contains('/')) {
        std::fs::write(folder.join(&file.name), &file.bytes).expect("a temporary file");
    }
    let built = Command::new("cc")
        .args([
            "-std=c99",
            "-O1",
            "-Wall",
            "-Wextra",
            "-Wconversion",
            "-Werror",
            "-ffp-contract=off",
        ])
        .args(["a_system.c", "a_system_check.c", "-o", "check"])
        .current_dir(folder)
        .output()
        .expect("the compiler that links Rust");
    assert!(built.status.success(), "{}", String::from_utf8_lossy(&built.stderr));
    let ran = Command::new(folder.join("check")).output().expect("what was built");
    Some(String::from_utf8_lossy(&ran.stdout).into_owned())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, max_shrink_iters: 4, ..ProptestConfig::default() })]

    #[test]
    fn the_c_of_any_system_answers_as_the_system_without_a_warning(
        system in fspid_options::any_system(),
    ) {
        let folder = tempfile::tempdir().expect("a temporary folder");
        for precision in [Precision::Double, Precision::Single] {
            let text = ran(&system, precision, folder.path());
            prop_assert!(text.is_none_or(|text| text == "300 samples, 0 different\n"));
        }
    }
}

/// How many answers of the function block have other bits.
fn different(system: &System) -> Option<usize> {
    use fspid_structured_text::{Library, Value};
    let program = system_program::<f64>(system).ok()?;
    let heading = Heading {
        name: "a",
        digest: "0",
        precision: Precision::Double,
        angles: None,
        elevator: None,
    };
    let text = structured_text(&program.program, "a", &heading);
    let library = Library::read(&text).unwrap_or_else(|problem| panic!("{problem}\n{text}"));
    let mut block = library.instance("FB_a").unwrap_or_else(|problem| panic!("{problem}\n{text}"));
    let names = &program.names;
    let mut different = 0;
    for vector in system_vectors(system, 3, 60) {
        let inputs = names.inputs.iter().zip(&vector.sample);
        inputs.for_each(|(name, value)| {
            block.set(&format!("in_{name}"), Value::Lreal(*value)).expect("an input")
        });
        block.call().unwrap_or_else(|problem| panic!("{problem}\n{text}"));
        let same_values = names.outputs.iter().zip(&vector.answer).all(|(name, value)| {
            matches!(block.get(&format!("out_{name}")), Ok(Value::Lreal(found)) if found.to_bits() == value.to_bits())
        });
        let marks = names.sources.iter().chain([&names.faults]).zip(&vector.marks);
        let same_marks = marks.into_iter().all(
            |(name, mark)| matches!(block.get(&format!("out_{name}")), Ok(Value::Byte(found)) if found == *mark),
        );
        different += usize::from(!(same_values && same_marks));
    }
    Some(different)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 40, ..ProptestConfig::default() })]

    #[test]
    fn the_structured_text_of_any_system_answers_as_the_system(
        system in fspid_options::any_system(),
    ) {
        prop_assert!(different(&system).is_none_or(|count| count == 0), "{:#?}", system.parts());
    }
}

/// What a real Lua of the same digits prints.
fn printed_by_lua(system: &System, precision: Precision) -> Option<String> {
    let request =
        SystemRequest { name: "a", target: Target::Lua, precision, samples: 200, digest: "0" };
    let exported = export_system(system, &request).ok()?;
    let folder = tempfile::tempdir().expect("a temporary folder");
    for file in exported.files.iter().filter(|file| !file.name.contains('/')) {
        std::fs::write(folder.path().join(&file.name), &file.bytes).expect("a temporary file");
    }
    let output = crate::lua_interpreter::run(precision, folder.path(), "a_check.lua");
    Some(crate::lua_interpreter::printed(&output))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 20, max_shrink_iters: 4, ..ProptestConfig::default() })]

    #[test]
    fn the_lua_of_any_system_answers_as_the_system_in_both_kinds_of_lua(
        system in fspid_options::any_system(),
    ) {
        for precision in [Precision::Double, Precision::Single] {
            let text = printed_by_lua(&system, precision);
            prop_assert!(text.as_ref().is_none_or(|it| it == "200 samples, 0 different\n"), "{text:?}");
        }
    }
}
