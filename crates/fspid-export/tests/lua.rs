//! The Lua that is written answers what the controller answers, bit for bit, in a real Lua 5.3 built both ways.

use std::path::Path;

use fspid_core::{
    Controller, Derivative, Fspid, PidConfig, ReferenceModel, SecondInput, SelfTuner, TunerSettings,
};
use fspid_export::program::Precision;
use fspid_export::vectors::eventful;
use fspid_export::write::{Heading, lua, lua_harness};
use fspid_export::{Angles, Request, Target, export, precision_of, program};
use fspid_numeric::Real;
use proptest::prelude::*;

use crate::lua_interpreter::{printed, run};

/// As many as the guide asks for: the first few hundred do not come to every number that is remembered.
const SAMPLES: usize = 2000;

/// Writes the module and its check.
fn write<R: Real>(controller: &Controller<R>, angles: Angles, folder: &Path) {
    let program = program(controller, angles).expect("nothing here is refused");
    let heading = Heading {
        name: "pitch",
        digest: "0",
        precision: program.precision,
        angles: Some(angles),
        elevator: None,
    };
    let vectors = eventful(controller, angles, 1, SAMPLES);
    for (name, text) in [
        ("pitch.lua", lua(&program, &heading)),
        ("check.lua", lua_harness(&program, "pitch", &vectors)),
    ] {
        std::fs::write(folder.join(name), text).expect("a temporary file");
    }
}

fn checked<R: Real>(controller: &Controller<R>, angles: Angles) -> String {
    let folder = tempfile::tempdir().expect("a temporary folder");
    write(controller, angles, folder.path());
    printed(&run(precision_of::<R>(), folder.path(), "check.lua"))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 16, max_shrink_iters: 8, ..ProptestConfig::default() })]

    #[test]
    fn the_lua_of_any_controller_answers_as_the_controller_in_both_kinds_of_lua(
        controller in fspid_options::any_controller(),
        degrees in any::<bool>(),
    ) {
        let angles = if degrees { Angles::Degrees } else { Angles::Radians };
        prop_assert_eq!(checked(&controller, angles), "2000 samples, 0 different\n");
        if let Ok(single) = controller.rounded::<f32>() {
            prop_assert_eq!(checked(&single, angles), "2000 samples, 0 different\n");
        }
    }
}

/// The guide's own example said `58 different` of a module that is right: events that write over the derivative and the
/// reference model were left out of its check.
#[test]
fn the_check_of_a_self_tuner_writes_over_each_number_that_is_remembered() {
    let Controller::SelfTuning(paper) = crate::common::paper() else { unreachable!("it tunes") };
    let second_input =
        SecondInput::ModelError(ReferenceModel { bandwidth_rad_s: 2.0, damping: 1.0 });
    let settings = TunerSettings { second_input, ..*paper.tuner().settings() };
    let (nominal, supervisor) = (paper.tuner().nominal(), *paper.tuner().supervisor());
    let tuner = SelfTuner::new(nominal, supervisor, settings).expect("a tuner");
    let derivative = Derivative { filter_s: 0.17 };
    let config = PidConfig { derivative, rate_gain_s: 0.2, ..*paper.config() };
    let controller = Controller::SelfTuning(Fspid::new(tuner, config).expect("a controller"));
    let vectors = eventful(&controller, Angles::Degrees, 1, SAMPLES);
    for name in ["derivative_rad_s", "model_rad", "model_rad_s"] {
        assert!(vectors.iter().any(|vector| vector.event.name() == name), "{name}");
    }
    let single = controller.rounded::<f32>().expect("small numbers");
    assert_eq!(checked(&controller, Angles::Degrees), "2000 samples, 0 different\n");
    assert_eq!(checked(&single, Angles::Degrees), "2000 samples, 0 different\n");
}

#[test]
fn a_module_refuses_a_lua_with_other_numbers_by_a_sentence() {
    let controller = crate::common::paper();
    let single = controller.rounded::<f32>().expect("small numbers");
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (precision, bits) in
        [(Precision::Double, "32 bits (LUA_32BITS)"), (Precision::Single, "64 bits")]
    {
        match precision {
            Precision::Double => write(&single, Angles::Degrees, folder.path()),
            Precision::Single => write(&controller, Angles::Degrees, folder.path()),
        }
        let output = run(precision, folder.path(), "check.lua");
        let told = String::from_utf8_lossy(&output.stderr);
        assert!(!output.status.success(), "{told}");
        assert!(told.contains(&format!("this controller needs numbers of {bits}")), "{told}");
    }
}

#[test]
fn a_module_with_another_rule_or_number_answers_differently() {
    let controller = crate::common::paper().rounded::<f32>().expect("small numbers");
    let folder = tempfile::tempdir().expect("a temporary folder");
    write(&controller, Angles::Degrees, folder.path());
    let file = folder.path().join("pitch.lua");
    let text = std::fs::read_to_string(&file).expect("the module");
    // R25, where both inputs are around zero, and a number in its last digit.
    for (old, new) in [
        ("5, 5, 4, 3, 2, 1, 1, 4", "5, 5, 4, 6, 2, 1, 1, 4"),
        ("nominal_kp = 1.0", "nominal_kp = 1.0000001"),
    ] {
        assert!(text.contains(old), "{old}");
        std::fs::write(&file, text.replace(old, new)).expect("a temporary file");
        let told = printed(&run(Precision::Single, folder.path(), "check.lua"));
        assert!(!told.contains(" 0 different"), "{new}: {told}");
    }
}

/// `require("math")` answers Lua's own library, whatever file lies there.
#[test]
fn a_controller_that_is_called_like_a_library_gets_another_name_and_answers() {
    let request = Request {
        name: "Math",
        target: Target::Lua,
        precision: Precision::Double,
        angles: Angles::Radians,
        samples: 50,
        points: 25,
        digest: "0",
        elevator: None,
        its_loop: None,
        evidence: false,
    };
    let exported = export(&crate::common::paper(), &request).expect("nothing here is refused");
    assert_eq!(exported.prefix, "controller_math");
    assert!(exported.notes.iter().any(|note| note.contains("`Math` is called `controller_math`")));
    let folder = tempfile::tempdir().expect("a temporary folder");
    for file in &exported.files {
        std::fs::write(folder.path().join(&file.name), &file.bytes).expect("a temporary file");
    }
    let told = printed(&run(Precision::Double, folder.path(), "controller_math_check.lua"));
    assert_eq!(told, "50 samples, 0 different\n");
}
