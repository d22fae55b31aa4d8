//! Effects that act in flight and are neglected in the linear analysis: limits, deadband, quantisation and the like.

use fspid_core::Law;
use fspid_sim::loop_model::Sensing;
use fspid_sim::{Controller, Scenario};

/// Something that a linear loop leaves out: whether a scenario has it, and what is said of it.
type LeftOut = (bool, &'static str);

/// Everything of a scenario that its linear loops leave out, in sentences.
#[must_use]
pub fn not_in_the_linear_loop(scenario: &Scenario) -> Vec<String> {
    let all = [&of_what_flies(scenario)[..], &of_controllers(scenario), &of_times(scenario)];
    let applying = all.into_iter().flatten().filter(|(applies, _)| *applies);
    applying.map(|(_, sentence)| (*sentence).to_owned()).collect()
}

fn of_what_flies(scenario: &Scenario) -> [LeftOut; 8] {
    let surroundings = &scenario.surroundings;
    let actuator = &scenario.actuator;
    let is_aircraft = scenario.plant.aircraft().is_some();
    let is_limited = !actuator.is_linear();
    let has_widths = actuator.deadband_rad() > 0.0 || actuator.play_rad() > 0.0;
    let mut sensors = [&surroundings.pitch_sensor, &surroundings.rate_sensor].into_iter().flatten();
    let is_stepped = sensors.any(|sensor| sensor.model().resolution > 0.0);
    let erects = surroundings.pitch_sensor.is_some_and(|s| s.model().erection_rad_s > 0.0);
    [
        (is_aircraft, "The aircraft is nonlinear: analysed is its linear model at the trim."),
        (
            is_aircraft && scenario.autopilot.is_none(),
            "Roll, yaw and bank are not in these numbers: whether they grow about the trim, with leveller and damper, is in the verdict alone.",
        ),
        (
            scenario.plant.aircraft().is_some_and(|plant| !plant.changing().is_still()),
            "While configurations move and fuel is burnt, the aircraft is none of those that are analysed: as it is at the start, after each change of a configuration with the fuel of the start, and at the end of a flight that burns fuel with what is left then (with an empty tank, where thrust decides how much is burnt), all at the trim of the same speed and altitude.",
        ),
        (
            scenario.autopilot.is_some(),
            "Margins are those of the pitch loop alone; of the loops around it the poles of each mode are told, around the trim, with sensors as late as they are and without limits.",
        ),
        (is_limited, "Limits of the actuator are left out; they act beyond small motions."),
        (
            has_widths,
            "Deadband and play of the actuator are left out: a loop that is called stable may keep a small oscillation.",
        ),
        (
            is_stepped,
            "The resolution of the sensors is left out: a loop that is called stable may keep a small oscillation.",
        ),
        (
            erects && is_aircraft,
            "The vertical gyro's erection is left out: it follows the apparent vertical at a bounded rate, so that a loop that is called stable may keep an oscillation.",
        ),
    ]
}

fn of_controllers(scenario: &Scenario) -> [LeftOut; 3] {
    let controllers = || scenario.controllers.iter().map(|named| &named.controller);
    let mut tuners = controllers().filter_map(|controller| match controller {
        Controller::SelfTuning(fspid) => Some(fspid.tuner()),
        Controller::Fixed(_) => None,
    });
    [
        (
            controllers().any(|controller| !controller.config().is_linear()),
            "Limits of the controller's output and its anti-windup are left out; they act beyond small motions.",
        ),
        (
            controllers().any(|controller| matches!(controller, Controller::SelfTuning(_))),
            "Of gains that move only what they add to a held command is in these numbers; for all else they stand still. Only a certificate speaks of gains that move.",
        ),
        (
            tuners.any(|tuner| tuner.settings().law != Law::Memoryless),
            "Gains that an accumulating law may come to are bounded from outside: a flight need not come to each of them.",
        ),
    ]
}

fn of_times(scenario: &Scenario) -> [LeftOut; 3] {
    let (surroundings, dt_s) = (&scenario.surroundings, scenario.timing.dt_s());
    let sensors = [&surroundings.pitch_sensor, &surroundings.rate_sensor];
    let seen = sensors.map(|sensor| Sensing::through(sensor.as_ref(), dt_s));
    [
        (
            seen.iter().any(|it| it.at_largest_age),
            "A sensor has a clock of its own, so that the age of its values changes: they are taken at their largest age.",
        ),
        (
            seen.iter().any(|it| it.part > 0.0),
            "A sensor is late by no whole number of samples: between two samples its quantity is taken to go in a straight line, in flights as here, so that what moves as fast as samples follow is seen too smooth.",
        ),
        (
            scenario.plant_changes.iter().any(|change| change.ramp_s() > 0.0),
            "A plant that changes bit by bit passes plants that are not asked: asked is each that lasts.",
        ),
    ]
}
