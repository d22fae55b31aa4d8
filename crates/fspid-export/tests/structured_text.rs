//! The Structured Text that is written answers what the controller answers, bit for bit.

use fspid_core::Controller;
use fspid_export::vectors::{Vector, vectors};
use fspid_export::write::{Heading, structured_text, structured_text_check};
use fspid_export::{Angles, program};
use fspid_numeric::Real;
use fspid_structured_text::{Instance, Library, Problem, Value};
use proptest::prelude::*;

/// A number as the language has it.
fn real<R: Real>(value: R) -> Value {
    #[allow(clippy::cast_possible_truncation, reason = "of 32 bits already")]
    match fspid_export::precision_of::<R>() {
        fspid_export::program::Precision::Single => Value::Real(value.to_f64() as f32),
        fspid_export::program::Precision::Double => Value::Lreal(value.to_f64()),
    }
}

fn bits(value: Value) -> u64 {
    match value {
        Value::Real(value) => u64::from(value.to_bits()),
        Value::Lreal(value) => value.to_bits(),
        other => panic!("{other:?} is no real"),
    }
}

struct Text {
    block: String,
    check: String,
    inputs: Vec<String>,
    command: String,
}

fn text<R: Real>(controller: &Controller<R>, angles: Angles, vectors: &[Vector<R>]) -> Text {
    let program = program(controller, angles).expect("nothing here is refused");
    let heading =
        Heading { name: "pitch", digest: "0", precision: program.precision, angles: Some(angles) };
    let samples: Vec<Vec<R>> = vectors.iter().map(|vector| vector.sample.clone()).collect();
    Text {
        block: structured_text(&program, "pitch", &heading),
        check: structured_text_check(&program, "pitch", &heading, &samples),
        inputs: program.sample.iter().map(|member| member.name.clone()).collect(),
        command: program.answer[0].name.clone(),
    }
}

/// How many answers have other bits.
fn different<R: Real>(
    block: &mut Instance<'_>,
    text: &Text,
    vectors: &[Vector<R>],
) -> Result<usize, Problem> {
    let mut different = 0;
    let outputs = [text.command.as_str(), "kp", "ki", "kd"];
    for vector in vectors {
        for (name, value) in text.inputs.iter().zip(&vector.sample) {
            block.set(name, real(*value))?;
        }
        block.call()?;
        let mut is_same = block.get("saturated")? == Value::Bool(vector.marks[0] == 1)
            && block.get("faults")? == Value::Byte(vector.marks[1]);
        for (name, value) in outputs.into_iter().zip(&vector.answer) {
            is_same &= bits(block.get(name)?) == bits(real(*value));
        }
        different += usize::from(!is_same);
    }
    Ok(different)
}

fn fly<R: Real>(
    controller: &Controller<R>,
    angles: Angles,
    samples: usize,
) -> Result<(), TestCaseError> {
    let vectors = vectors(controller, angles, 1, samples);
    let text = text(controller, angles, &vectors);
    let told = |problem: Problem| TestCaseError::fail(format!("{problem}\n{}", text.block));
    let library = Library::read(&format!("{}{}", text.block, text.check)).map_err(told)?;
    let mut block = library.instance("FB_pitch").map_err(told)?;
    prop_assert_eq!(different(&mut block, &text, &vectors).map_err(told)?, 0);
    // From a reset on it answers as at the beginning.
    block.set("reset", Value::Bool(true)).map_err(told)?;
    block.call().map_err(told)?;
    block.set("reset", Value::Bool(false)).map_err(told)?;
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 30, max_shrink_iters: 30, ..ProptestConfig::default() })]

    #[test]
    fn the_structured_text_of_any_controller_answers_as_the_controller_in_both_precisions(
        controller in fspid_options::any_controller(),
        degrees in any::<bool>(),
    ) {
        let angles = if degrees { Angles::Degrees } else { Angles::Radians };
        fly(&controller, angles, 300)?;
        if let Ok(single) = controller.rounded::<f32>() {
            fly(&single, angles, 300)?;
        }
    }
}
