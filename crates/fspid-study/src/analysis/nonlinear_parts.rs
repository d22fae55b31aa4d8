//! What acts in flight and is not in the linear loop.

use fspid_core::Law;
use fspid_sim::loop_model::Sensing;
use fspid_sim::{Controller, Scenario};

/// Everything of a scenario that its linear loops leave out, in sentences.
#[must_use]
pub fn not_in_the_linear_loop(scenario: &Scenario) -> Vec<String> {
    let mut left_out = Vec::new();
    let mut say = |applies: bool, sentence: &str| {
        if applies {
            left_out.push(sentence.to_owned());
        }
    };
    let surroundings = &scenario.surroundings;
    say(
        scenario.plant.aircraft().is_some(),
        "The aircraft is nonlinear: analysed is its linear model at the trim.",
    );
    let limited = match &surroundings.actuator {
        Some(actuator) => !actuator.is_linear(),
        None => !scenario.servo.is_linear(),
    };
    say(limited, "Limits of the actuator are left out; they act beyond small motions.");
    let widths = surroundings
        .actuator
        .as_ref()
        .is_some_and(|actuator| actuator.deadband_rad() > 0.0 || actuator.play_rad() > 0.0);
    say(
        widths,
        "Deadband and play of the actuator are left out: a loop that is called stable may keep a small oscillation.",
    );
    let sensors = || [&surroundings.pitch_sensor, &surroundings.rate_sensor].into_iter().flatten();
    say(
        sensors().any(|sensor| sensor.model().resolution > 0.0),
        "The resolution of the sensors is left out: a loop that is called stable may keep a small oscillation.",
    );
    let erects = surroundings.pitch_sensor.is_some_and(|s| s.model().erection_rad_s > 0.0);
    say(
        erects && scenario.plant.aircraft().is_some(),
        "The vertical gyro's erection is left out: it follows the apparent vertical at a bounded rate, so that a loop that is called stable may keep an oscillation.",
    );
    let shells = || scenario.controllers.iter().map(|named| named.controller.shell());
    say(
        shells().any(|shell| !shell.is_linear()),
        "Limits of the controller's output and its anti-windup are left out; they act beyond small motions.",
    );
    let tuning =
        |named: &fspid_sim::NamedController| matches!(named.controller, Controller::SelfTuning(_));
    say(
        scenario.controllers.iter().any(tuning),
        "Of gains that move only what they add to a held command is in these numbers; for all else they stand still. Only a certificate speaks of gains that move.",
    );
    let accumulates = |named: &fspid_sim::NamedController| match &named.controller {
        Controller::SelfTuning(fspid) => fspid.tuner().settings().law != Law::Memoryless,
        Controller::Fixed(_) => false,
    };
    say(
        scenario.controllers.iter().any(accumulates),
        "An accumulating law is analysed at its equilibrium alone: where else its gains can stand, a certificate says.",
    );
    let dt_s = scenario.timing.dt_s();
    let aged = [surroundings.pitch_sensor.as_ref(), surroundings.rate_sensor.as_ref()]
        .into_iter()
        .any(|sensor| Sensing::through(sensor, dt_s).at_largest_age);
    say(
        aged,
        "A sensor has a clock of its own, so that the age of its values changes: they are taken at their largest age.",
    );
    left_out
}
