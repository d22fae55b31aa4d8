//! The script for ArduPilot runs in Lua with numbers of 32 bits, among tables that stand for what ArduPilot offers.

use std::path::Path;

use fspid_core::Controller;
use fspid_export::program::Precision;
use fspid_export::write::{Heading, ardupilot, lua};
use fspid_export::{Angles, program};

use crate::lua_interpreter::{printed, run};

/// What the script asks for, and a clock, an attitude and a servo that a test can turn and see.
const STAND_IN: &str = include_str!("data/ardupilot_stand_in.lua");

fn write(controller: &Controller<f32>, angles: Angles, folder: &Path) {
    let program = program(controller, angles).expect("nothing here is refused");
    let heading = Heading {
        name: "pitch",
        digest: "0",
        precision: program.precision,
        angles: Some(angles),
        elevator: None,
    };
    for (name, text) in [
        ("pitch.lua", lua(&program, &heading)),
        ("pitch_ardupilot.lua", ardupilot(&program, "pitch", &heading).expect("10 ms")),
        ("stand_in.lua", STAND_IN.to_owned()),
    ] {
        std::fs::write(folder.join(name), text).expect("a temporary file");
    }
}

fn told(angles: Angles, test: &str) -> String {
    let controller = crate::common::paper().rounded::<f32>().expect("small numbers");
    let folder = tempfile::tempdir().expect("a temporary folder");
    write(&controller, angles, folder.path());
    let test = format!("local world = require(\"stand_in\")\n{test}");
    std::fs::write(folder.path().join("test.lua"), test).expect("a temporary file");
    printed(&run(Precision::Single, folder.path(), "test.lua"))
}

#[test]
fn the_script_moves_nothing_until_it_is_enabled_and_then_as_the_module_answers() {
    let test = r#"
        world.run(5)
        assert(world.moved == 0, "moved before it was enabled")
        world.values.PITCH_ENABLE, world.values.PITCH_SETPT_DEG, world.values.PITCH_THROW_DEG = 1, 2, 100
        local controller, state, answer = require("pitch"), {}, {}
        controller.reset(controller.design, state)
        local different = 0
        for k = 0, 199 do
            world.pitch_rad = 0.1 * math.sin(0.05 * k)
            world.rate_rad_s = 0.01 * k
            world.run(1)
            controller.step(controller.design, state, world.sample(2), answer)
            if world.servo ~= world.command_deg(answer) / 100 then different = different + 1 end
        end
        print(world.moved, different, world.servo_function, world.now)
        print(table.concat(world.told, "; "))
    "#;
    for angles in [Angles::Degrees, Angles::Radians] {
        // Six idle waits of 200 ms, and 200 samples 10 ms apart.
        let expected = "200\t0\t94\t3190\npitch: waits for PITCH_ENABLE; pitch: runs\n";
        assert_eq!(told(angles, test), expected);
    }
}

#[test]
fn the_script_tells_faults_and_late_samples_and_starts_anew_when_it_is_enabled_again() {
    let test = r#"
        world.values.PITCH_ENABLE = 1
        world.run(1)
        world.pitch_rad = 0.0 / 0.0
        world.run(1)
        world.pitch_rad = 0.05
        world.delay_ms = 25
        world.run(12)
        world.delay_ms = 0
        world.values.PITCH_ENABLE = 0
        world.run(1)
        world.values.PITCH_ENABLE = 1
        world.run(1)
        world.values.PITCH_THROW_DEG = 0
        world.run(1)
        assert(world.servo >= -1 and world.servo <= 1)
        print(table.concat(world.told, "; "))
    "#;
    let expected = "pitch: waits for PITCH_ENABLE; pitch: runs; pitch: faults 1; pitch: late 1 times; \
                    pitch: late 10 times; pitch: is switched off; pitch: runs; \
                    pitch: PITCH_THROW_DEG is to be positive\n";
    assert_eq!(told(Angles::Degrees, test), expected);
}

#[test]
fn a_period_that_is_no_whole_number_of_milliseconds_has_no_script() {
    let controller = crate::common::paper_every(0.0025).rounded::<f32>().expect("small numbers");
    let program = program(&controller, Angles::Radians).expect("nothing here is refused");
    let (precision, angles) = (program.precision, Angles::Radians);
    let heading =
        Heading { name: "pitch", digest: "0", precision, angles: Some(angles), elevator: None };
    assert_eq!(ardupilot(&program, "pitch", &heading), None);
}
