//! Proved claims, flown with the simulator.

use std::ops::ControlFlow;

use fspid_core::{AntiWindup, Fspid, Guard, Pid, PidConfig, Sample, State};
use fspid_proof::{
    Asked, Certificate, Effort, LoopDescription, NotProvable, Rechecked, Verdict, certify,
};
use fspid_sim::actuator::Actuator;
use fspid_sim::signal::{Disturbance, Entry, Profile, Shape};
use fspid_sim::{
    Controller, EarlyEnd, EndCause, NamedController, Outcome, Scenario, Timing, fly_commanded,
};

/// Time constants of the proved rate that are flown, and the most samples of a flight.
const TIME_CONSTANTS: f64 = 20.0;
const MOST_SAMPLES: f64 = 60_000.0;
/// Of the largest deviation so much may be left at the end: a form may be some 10⁶ times as long as it is
/// wide, and 20 time constants are a factor of 10⁹.
const LEFT: f64 = 0.02;
/// Below this nothing is told from rounding, rad.
const ROUNDING: f64 = 1e-9;

/// What came of a drawn scenario.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Answer {
    /// No proof speaks of it.
    NotProvable(String),
    /// Neither proved nor refuted, not even for less.
    Open,
    Refuted,
    /// Proved for all that the scenario has, or for less, and every flight settled.
    Settled {
        whole: bool,
        flights: usize,
        held: bool,
        /// Steps from rest were claimed, limits acting, and flown.
        stepped: bool,
    },
    /// Proved, and a flight did not settle.
    Contradicted(String),
}

/// A quick proof: what it misses is not claimed.
pub(crate) fn quick() -> Effort {
    Effort {
        divisions: 12,
        cones: 6,
        halvings: 2,
        largest_factor: 1.0,
        frozen_points: 13,
        ..Effort::default()
    }
}

/// Certifies a scenario and flies what is proved.
pub(crate) fn answer(scenario: &Scenario) -> Answer {
    let plant = scenario.plant.linear().expect("linear");
    let controller = &scenario.controllers[0].controller;
    let described = LoopDescription::of(scenario, plant, controller);
    let outcome = described.and_then(|description| {
        let asked = Asked::of(scenario, plant, &description);
        certify(&description, &asked, &quick())
    });
    let outcome = match outcome {
        Err(reason) => return Answer::NotProvable(short(&reason)),
        Ok(outcome) => outcome,
    };
    let (proved, whole) = match (outcome.verdict, outcome.instead) {
        (Verdict::Proved(certificate, rechecked), _) => ((certificate, rechecked), true),
        (Verdict::Refuted(..), _) => return Answer::Refuted,
        (Verdict::Open, Some(found)) => (found, false),
        (Verdict::Open, None) => return Answer::Open,
    };
    fly_all(scenario, &proved, whole)
}

fn short(reason: &NotProvable) -> String {
    reason.to_string().chars().take(60).collect()
}

fn fly_all(scenario: &Scenario, proved: &(Certificate, Rechecked), whole: bool) -> Answer {
    let (certificate, rechecked) = proved;
    // A certificate that is read again has to say the same.
    if certificate.check().as_ref() != Ok(rechecked) {
        return Answer::Contradicted("checked anew it is another".to_owned());
    }
    let range = certificate.range;
    // What no limit can keep from settling is flown without limits.
    let free = without_limits(scenario);
    let (far, load) = (range.setpoint_rad, range.load_rad);
    // Beyond the range too, where the claim does not depend on it.
    let any = if rechecked.any_setpoint { 40.0_f64.to_radians() } else { far };
    let own_load = scenario.steady();
    // A bias of the sensor counts as a load, and is there in every flight.
    let room = (load
        - (own_load.load_with_offsets_rad(
            scenario.plant.linear().expect("linear"),
            controller_config(scenario),
        ) - own_load.load_rad
            - own_load.bias_rad))
        .max(0.0);
    let loads = if rechecked.any_load { [0.0, 5.0_f64.to_radians()] } else { [0.0, room] };
    let (mut flights, mut stepped) = (0, false);
    if let Err(reason) = rests_near_its_setpoint(&free, proved, room) {
        return Answer::Contradicted(reason);
    }
    for (setpoint_rad, load_rad, kick_rad) in [
        (any, 0.0, 0.0),
        (-any, loads[1], 0.0),
        (0.37 * any, -loads[1], 0.0),
        (-any, -loads[1], 20.0_f64.to_radians()),
        (any, loads[1], 1e-4),
    ] {
        let start = Start { setpoint_rad, load_rad, kick_rad, ramp: false };
        if let Err(reason) = settles(&free, proved, start) {
            return Answer::Contradicted(format!("{start:?}: {reason}"));
        }
        flights += 1;
    }
    if !certificate.description.limits().is_empty() {
        for (setpoint_rad, load_rad) in [(far, room), (-far, -room)] {
            let start = Start { setpoint_rad, load_rad, kick_rad: 0.0, ramp: true };
            if let Err(reason) = rests_as_without_limits([scenario, &free], proved, start) {
                return Answer::Contradicted(format!("within limits, {start:?}: {reason}"));
            }
            flights += 2;
        }
    }
    for start in steps_of(scenario, rechecked) {
        if let Err(reason) = ends_at_its_setpoint(scenario, proved, start) {
            return Answer::Contradicted(format!("a step with limits, {start:?}: {reason}"));
        }
        (flights, stepped) = (flights + 1, true);
    }
    let held = far > 0.0 && !rechecked.any_setpoint;
    Answer::Settled { whole, flights, held, stepped }
}

/// At the edge of the range a loop comes to rest no further from its set-point than is told.
fn rests_near_its_setpoint(
    free: &Scenario,
    proved: &(Certificate, Rechecked),
    room: f64,
) -> Result<(), String> {
    let (Certificate { range, .. }, rechecked) = proved;
    let sensor = free.surroundings.pitch_sensor.as_ref();
    // A bias is a load to the certificate, and an error to whoever looks at the pitch angle.
    if sensor.is_some_and(|it| it.bias() != 0.0) {
        return Ok(());
    }
    let scale = sensor.map_or(1.0, |it| 1.0 + it.model().scale_error);
    for load_rad in [0.0, room, -room] {
        let setpoint_rad = range.setpoint_rad;
        let start = Start { setpoint_rad, load_rad, kick_rad: 0.0, ramp: false };
        let end = settles(free, proved, start)?;
        let off = (scale * end - setpoint_rad).abs();
        let slack = 2.0 * LEFT * (setpoint_rad + end.abs()) + 2.0 * rechecked.remains_rad;
        if !(off <= rechecked.rest_error_rad + slack + ROUNDING) {
            let told = rechecked.rest_error_rad;
            return Err(format!("{start:?}: rests {off:e} rad off, told are {told:e}"));
        }
    }
    Ok(())
}

/// Steps up to the edge of what is claimed, either way, with loads.
fn steps_of(scenario: &Scenario, rechecked: &Rechecked) -> Vec<Start> {
    // Steps are claimed for sensors without bias.
    let biased = scenario.surroundings.pitch_sensor.as_ref().is_some_and(|it| it.bias() != 0.0);
    let Some(stepped) = rechecked.stepped.filter(|_| !biased) else { return Vec::new() };
    let shares = [(1.0, 1.0), (-1.0, 1.0), (0.999, -1.0), (-0.61, 0.3), (0.37, 0.0), (0.05, -0.7)];
    let start = |(setpoint, load): (f64, f64)| Start {
        setpoint_rad: setpoint * stepped.setpoint_rad,
        load_rad: load * stepped.load_rad,
        kick_rad: 0.0,
        ramp: false,
    };
    shares.map(start).to_vec()
}

/// A flight of the loop with its limits ends where the same loop without limits does.
fn ends_at_its_setpoint(
    scenario: &Scenario,
    proved: &(Certificate, Rechecked),
    start: Start,
) -> Result<(), String> {
    rests_as_without_limits([scenario, &without_limits(scenario)], proved, start)
}

fn controller_config(scenario: &Scenario) -> &PidConfig<f64> {
    scenario.controllers[0].controller.config()
}

/// How a flight begins.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Start {
    pub(crate) setpoint_rad: f64,
    pub(crate) load_rad: f64,
    /// At the servo for a second.
    pub(crate) kick_rad: f64,
    /// Slowly, so that no limit acts on the way.
    pub(crate) ramp: bool,
}

/// No limit keeps the loop from where it comes to rest: it ends where the same loop without limits does.
fn rests_as_without_limits(
    scenarios: [&Scenario; 2],
    proved: &(Certificate, Rechecked),
    start: Start,
) -> Result<(), String> {
    let [limited, free] = scenarios.map(|scenario| settles(scenario, proved, start));
    let (limited, free) = (limited?, free?);
    let allowed = LEFT * free.abs() + 2.0 * proved.1.remains_rad + ROUNDING;
    if (limited - free).abs() <= allowed {
        return Ok(());
    }
    Err(format!("ends at {limited:e} rad, without limits at {free:e}"))
}

/// Where the pitch angle ends, rad.
pub(crate) fn settles(
    scenario: &Scenario,
    proved: &(Certificate, Rechecked),
    start: Start,
) -> Result<f64, String> {
    settles_seeing(scenario, proved, start, |sample| sample)
}

/// A scenario that begins so, and lasts so long.
fn started(scenario: &Scenario, start: Start, duration_s: f64) -> Scenario {
    let mut flown = scenario.clone();
    flown.timing = Timing::new(scenario.timing.dt_s(), duration_s).expect("allowed");
    let shape = match start.ramp {
        true => Shape::Ramp { at_s: 0.0, width_s: 190.0 },
        false => Shape::Step { at_s: 0.0 },
    };
    flown.setpoint = Profile::new(start.setpoint_rad, shape.clone()).expect("allowed");
    flown.disturbances = vec![
        Disturbance::new(Entry::Elevator, start.load_rad, shape).expect("allowed"),
        Disturbance::new(Entry::Servo, start.kick_rad, Shape::Pulse { at_s: 0.0, width_s: 1.0 })
            .expect("allowed"),
    ];
    flown
}

/// The same of a controller that sees something else than the sensors show.
pub(crate) fn settles_seeing(
    scenario: &Scenario,
    (certificate, rechecked): &(Certificate, Rechecked),
    start: Start,
    mut seen: impl FnMut(Sample<f64>) -> Sample<f64>,
) -> Result<f64, String> {
    let rate = certificate.claim.rate().expect("of stability");
    let dt_s = scenario.timing.dt_s();
    let samples = (TIME_CONSTANTS / -libm::log(rate)).clamp(1000.0, MOST_SAMPLES);
    let enough = rate < 1.0 && samples * -libm::log(rate) > 0.6 * TIME_CONSTANTS;
    let begin_s = if start.ramp { 200.0 } else { 1.0 };
    let flown = started(scenario, start, begin_s + samples * dt_s);
    let prepared = flown.prepare().map_err(|error| error.to_string())?;
    let mut theta = Vec::new();
    let mut saturated = 0_usize;
    let mut memory = State::new();
    let command_rad = |sample: Sample<f64>| {
        let step = flown.controllers[0].controller.step(&mut memory, seen(sample));
        saturated += usize::from(step.saturated);
        step.command_rad
    };
    let outcome = fly_commanded(&prepared, command_rad, |instant| {
        theta.push(instant.theta_rad);
        ControlFlow::Continue(())
    });
    if let Outcome::EndedEarly(EarlyEnd { at_s, cause: EndCause::Diverged }) =
        outcome.map_err(|error| error.to_string())?
    {
        return Err(format!("diverged at {at_s} s, rate {rate}"));
    }
    let held_from = (begin_s / dt_s) as usize;
    let last = theta.len() - theta.len() / 10;
    let spread = |part: &[f64]| {
        let (least, most) = part
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), v| (a.min(*v), b.max(*v)));
        most - least
    };
    let (whole, end) = (spread(&theta), spread(&theta[last..]));
    let left = if enough { LEFT } else { 0.5 };
    let allowed = left * whole + 2.0 * rechecked.remains_rad + ROUNDING;
    if !(end <= allowed) {
        return Err(format!(
            "from a spread of {whole:e} rad {end:e} rad is left, allowed {allowed:e}; rate {rate}, {} samples, {saturated} at limits, {}",
            theta.len() - held_from,
            certificate.claim.name()
        ));
    }
    Ok(theta.last().copied().unwrap_or(0.0))
}

pub(crate) fn without_limits(scenario: &Scenario) -> Scenario {
    let mut free = scenario.clone();
    let actuator = scenario.actuator;
    let plain = Actuator::new(actuator.lag()).with_delay(actuator.delay_samples());
    let plain = plain.and_then(|plain| plain.with_bias(actuator.bias_rad())).expect("allowed");
    free.actuator = plain;
    let config = PidConfig {
        limits: None,
        slew_rad_s: None,
        anti_windup: AntiWindup::None,
        guard: Guard::default(),
        ..*controller_config(scenario)
    };
    let controller = match &scenario.controllers[0].controller {
        Controller::Fixed(pid) => {
            Controller::Fixed(Pid::new(pid.gains(), config).expect("allowed"))
        }
        Controller::SelfTuning(fspid) => {
            Controller::SelfTuning(Fspid::new(*fspid.tuner(), config).expect("allowed"))
        }
    };
    free.controllers = vec![NamedController { name: "C".to_owned(), controller }];
    free
}
