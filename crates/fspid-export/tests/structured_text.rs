//! The Structured Text that is written answers what the controller answers, bit for bit.

use fspid_core::{
    AntiWindup, Controller, ControllerSetting, Derivative, Fspid, GainLimits, Gains, Guard,
    InputScale, Law, Limits, PidConfig, SecondInput, SelfTuner, TunerSettings,
};
use fspid_export::program::Precision;
use fspid_export::vectors::{Event, Vector, eventful};
use fspid_export::write::{Heading, structured_text, structured_text_check};
use fspid_export::{Angles, Request, Target, export, program};
use fspid_numeric::Real;
use fspid_structured_text::{Instance, Kind, Library, Mistake, Problem, Value};
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
    let heading = Heading {
        name: "pitch",
        digest: "0",
        precision: program.precision,
        angles: Some(angles),
        elevator: None,
    };
    let samples: Vec<Vec<R>> =
        vectors.iter().take(40).map(|vector| vector.sample.clone()).collect();
    Text {
        block: structured_text(&program, "pitch", &heading),
        check: structured_text_check(&program, "pitch", &heading, &[samples]),
        inputs: program.sample.iter().map(|member| member.name.clone()).collect(),
        command: program.answer[0].name.clone(),
    }
}

/// Writes over what is remembered, where that controller remembers it.
fn write<R: Real>(block: &mut Instance<'_>, name: &str, value: R) -> Result<(), Problem> {
    if block.kind(name).is_ok() { block.set(name, real(value)) } else { Ok(()) }
}

/// How many answers have other bits, the first one with a reset.
fn different<R: Real>(
    text: &Text,
    block: &mut Instance<'_>,
    vectors: &[Vector<R>],
) -> Result<usize, Problem> {
    let mut different = 0;
    let outputs = [text.command.as_str(), "kp", "ki", "kd"];
    for (k, vector) in vectors.iter().enumerate() {
        let is = |event: bool| Value::Bool(event);
        block.set("reset", is(k == 0 || vector.event == Event::Reset))?;
        block.set("clear_faults", is(vector.event == Event::Faults))?;
        block.set("track", is(matches!(vector.event, Event::Track(_))))?;
        block.set(&format!("track_{}", text.command), real(vector.event.given()))?;
        if let Event::Memory(_, value) = vector.event {
            write(block, &format!("state_{}", vector.event.name()), value)?;
        }
        for (name, value) in text.inputs.iter().zip(&vector.sample) {
            // A sample that is no number is what a controller is told to hold by.
            let nan = R::from_f64(f64::NAN);
            block.set(name, real(if vector.event == Event::Hold { nan } else { *value }))?;
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

/// What the exported check counts: how many samples, how many different.
fn counted(text: &Text) -> Result<(Value, Value), Problem> {
    let library = Library::read(&format!("{}{}", text.block, text.check))?;
    let mut check = library.instance("PRG_pitch_check")?;
    // More cycles than samples: it stops by itself.
    (0..60).try_for_each(|_| check.call())?;
    Ok((check.get("check_index")?, check.get("check_different")?))
}

fn fly<R: Real>(controller: &Controller<R>, angles: Angles) -> Result<(), TestCaseError> {
    let vectors = eventful(controller, angles, 1, 250);
    let text = text(controller, angles, &vectors);
    let told = |problem: Problem| TestCaseError::fail(format!("{problem}\n{}", text.block));
    let library = Library::read(&text.block).map_err(told)?;
    let mut block = library.instance("FB_pitch").map_err(told)?;
    prop_assert_eq!(different(&text, &mut block, &vectors).map_err(told)?, 0);
    prop_assert_eq!(
        different(&text, &mut block, &vectors[..50]).map_err(told)?,
        0,
        "after a reset"
    );
    let (asked, wrong) = counted(&text).map_err(told)?;
    prop_assert!(matches!(asked, Value::Dint(30..=40)), "{asked:?}");
    prop_assert_eq!(wrong, Value::Dint(0));
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 16, max_shrink_iters: 30, ..ProptestConfig::default() })]

    #[test]
    fn the_structured_text_of_any_controller_answers_as_the_controller_in_both_precisions(
        controller in fspid_options::any_controller(),
        degrees in any::<bool>(),
    ) {
        let angles = if degrees { Angles::Degrees } else { Angles::Radians };
        fly(&controller, angles)?;
        if let Ok(single) = controller.rounded::<f32>() {
            fly(&single, angles)?;
        }
    }
}

/// The paper's rules in 32 bits, and what they answer.
fn paper(samples: usize) -> (Text, Vec<Vector<f32>>) {
    let controller = crate::common::paper().rounded::<f32>().expect("small numbers");
    let vectors = eventful(&controller, Angles::Degrees, 1, samples);
    (text(&controller, Angles::Degrees, &vectors), vectors)
}

#[test]
fn twenty_thousand_answers_of_the_papers_rules_have_the_same_bits() {
    let (text, vectors) = paper(20_000);
    let library = Library::read(&text.block).expect("what was written");
    let mut block = library.instance("FB_pitch").expect("the block");
    assert_eq!(different(&text, &mut block, &vectors), Ok(0));
}

/// What the interpreter says of a text in which the first `old` is `new`.
fn broken(old: &str, new: &str) -> Result<usize, Mistake> {
    let (mut text, vectors) = paper(3_000);
    assert!(text.block.contains(old), "{old}");
    text.block = text.block.replacen(old, new, 1);
    let library = Library::read(&text.block).map_err(|problem| problem.mistake)?;
    let mut block = library.instance("FB_pitch").map_err(|problem| problem.mistake)?;
    different(&text, &mut block, &vectors).map_err(|problem| problem.mistake)
}

#[test]
fn a_text_that_is_broken_on_purpose_is_refused_by_its_mistake() {
    assert_eq!(broken("REAL#0.0", "0.0"), Err(Mistake::Untyped("0".to_owned())));
    assert_eq!(broken("DINT#6", "6"), Err(Mistake::Untyped("6".to_owned())));
    assert_eq!(broken("REAL#0.5", "LREAL#0.5"), Err(Mistake::Type(Kind::Real, Kind::Lreal)));
    assert_eq!(broken("step_fault :", "step :"), Err(Mistake::Reserved("STEP".to_owned())));
    assert_eq!(broken("infer_rule : DINT;", ""), Err(Mistake::Undeclared("INFER_RULE".to_owned())));
    assert!(matches!(broken("END_IF;", "END_IF"), Err(Mistake::Missing { .. })));
    assert!(matches!(broken("TO DINT#6", "TO DINT#7"), Err(Mistake::Index(..))));
    assert_eq!(broken("infer_rule := DINT#0;", ""), Err(Mistake::Unset("INFER_RULE".to_owned())));
    assert_eq!(broken("reset : BOOL;", "Kp : BOOL;"), Err(Mistake::Twice("KP".to_owned())));
    assert_eq!(broken("(state_faults OR", "(reset OR"), Err(Mistake::Type(Kind::Bool, Kind::Byte)));
}

#[test]
fn a_text_with_another_rule_number_or_sign_answers_differently() {
    for (old, new) in [
        // R25: both inputs around zero.
        ("USINT#3, USINT#2, USINT#1, USINT#1,", "USINT#6, USINT#2, USINT#1, USINT#1,"),
        ("design_nominal_kp : REAL := REAL#1.0", "design_nominal_kp : REAL := REAL#1.0000001"),
        ("step_error_rad := step_setpoint_rad - ", "step_error_rad := step_setpoint_rad + "),
        ("centroid_position := REAL#-3.0", "centroid_position := REAL#-2.9999998"),
    ] {
        assert!(matches!(broken(old, new), Ok(1..)), "{new}: {:?}", broken(old, new));
    }
}

/// A self-tuner with a guard, limits of command and gains, and what else acts seldom.
fn limited() -> Controller<f32> {
    let limits = |lower, upper| Limits::new(ControllerSetting::OutputLimits, lower, upper);
    let limits = |lower, upper| limits(lower, upper).expect("in order");
    let Controller::SelfTuning(paper) = crate::common::paper() else { unreachable!("it tunes") };
    let settings = TunerSettings {
        second_input: SecondInput::Rate,
        law: Law::Accumulating { leakage_per_s: 0.5 },
        output_scale: Gains { kp: 0.03, ki: 0.03, kd: 0.01 },
        input_scale: InputScale { error_per_rad: 30.0, change_per_rad: 60.0 },
        gain_limits: Some(GainLimits {
            kp: limits(0.9, 1.1),
            ki: limits(0.4, 0.6),
            kd: limits(0.17, 0.23),
        }),
        ..*paper.tuner().settings()
    };
    let tuner = SelfTuner::new(paper.tuner().nominal(), *paper.tuner().supervisor(), settings);
    let config = PidConfig {
        rate_gain_s: 0.2,
        derivative: Derivative { filter_s: 0.1 },
        limits: Some(limits(-0.35, 0.35)),
        anti_windup: AntiWindup::BackCalculation { tracking_s: 0.5 },
        guard: Guard::new(1.5).expect("positive"),
        ..*paper.config()
    };
    let fspid = Fspid::new(tuner.expect("a tuner"), config).expect("a controller");
    Controller::SelfTuning(fspid).rounded::<f32>().expect("small numbers")
}

/// Of the first 400 samples none had a rate, and none met a limit or the guard.
#[test]
fn the_check_for_a_plc_notices_each_number_of_a_design_that_is_turned() {
    let request = Request {
        name: "pitch",
        target: Target::StructuredText,
        precision: Precision::Single,
        angles: Angles::Radians,
        samples: 2000,
        points: 25,
        digest: "0",
        elevator: None,
        its_loop: None,
        evidence: false,
    };
    let controller = limited().rounded::<f64>().expect("the same numbers");
    let exported = export(&controller, &request).expect("nothing here is refused");
    let text = |name: &str| {
        let file = exported.files.iter().find(|file| file.name == name).expect("a file");
        String::from_utf8(file.bytes.clone()).expect("text")
    };
    let (block, check) = (text("pitch.st"), text("pitch_check.st"));
    let differs = |block: &str| {
        let library = Library::read(&format!("{block}{check}")).expect("it is read");
        let mut check = library.instance("PRG_pitch_check").expect("the check");
        (0..400).try_for_each(|_| check.call()).expect("it runs");
        assert!(matches!(check.get("check_index"), Ok(Value::Dint(100..=400))));
        check.get("check_different").expect("counted") != Value::Dint(0)
    };
    assert!(!differs(&block));
    let mut unnoticed = Vec::new();
    for line in block.lines().filter(|line| line.contains(" : REAL := REAL#")) {
        let (name, number) = line.trim().split_once(" : REAL := REAL#").expect("a number");
        let number: f32 = number.trim_end_matches(';').parse().expect("a number");
        if !name.starts_with("design_") {
            continue;
        }
        let other = if number == 0.0 { 0.5 } else { 1.5 * number };
        let turned = block.replace(line, &format!("{name} : REAL := REAL#{other:?};"));
        if !differs(&turned) {
            unnoticed.push(name.to_owned());
        }
    }
    assert_eq!(unnoticed, Vec::<String>::new());
}
