//! Steps from rest that are proved with the limits acting on the way.

use fspid_core::{AntiWindup, ControllerSetting, Derivative, Gains, Limits, Pid, PidConfig};
use fspid_proof::{
    Asked, Certificate, Commanded, Commands, Effort, Leg, LegGroup, LoopDescription, Range, Shares,
    Steps, Terminal, Verdict, certify,
};
use fspid_sim::actuator::Actuator;
use fspid_sim::loop_model::Sensing;
use fspid_sim::{Controller, ElevatorSign};

const DEG: f64 = core::f64::consts::PI / 180.0;

/// The Navion with a PID behind a servo of 20 deg and `rate_deg_s`, up to a step.
pub(crate) fn proved(
    rate_deg_s: f64,
    step_deg: f64,
) -> (Certificate, Option<fspid_proof::Stepped>) {
    let limits = Limits::new(ControllerSetting::OutputLimits, -20.0 * DEG, 20.0 * DEG);
    let config = PidConfig {
        derivative: Derivative { filter_s: 0.05 },
        limits: Some(limits.expect("allowed")),
        anti_windup: AntiWindup::BackCalculation { tracking_s: 1.25 },
        ..PidConfig::sampled_every(0.02)
    };
    let gains = Gains { kp: 0.82, ki: 0.43, kd: 0.165 };
    let servo = Actuator::first_order(0.1)
        .and_then(|servo| servo.with_position_limit(20.0 * DEG))
        .and_then(|servo| servo.with_rate_limit(rate_deg_s * DEG))
        .and_then(|servo| servo.with_delay(1));
    let description = LoopDescription {
        numerator: vec![-11.01, -22.6, -1.31],
        denominator: vec![1.0, 5.1, 13.3, 0.684, 0.632],
        elevator_sign: ElevatorSign::NoseDownPositive,
        actuator: servo.expect("allowed"),
        pitch: Sensing::DIRECT,
        rate: Sensing::DIRECT,
        controller: Controller::Fixed(Pid::new(gains, config).expect("allowed")),
    };
    let range = Range { setpoint_rad: step_deg * DEG, load_rad: 0.5 * DEG };
    // A load at 1 s, and after it a doublet.
    let commands = Commands {
        setpoint_rad: step_deg * DEG,
        load_rad: 0.5 * DEG,
        setpoint: Shares(vec![(500, 1.0), (700, -1.0), (900, 0.0)]),
        at_servo: Shares(vec![(50, 1.0)]),
        at_elevator: Shares::default(),
    };
    let asked = Asked { commands: Ok(Some(commands)), ..Asked::within(range) };
    let outcome = certify(&description, &asked, &Effort::default()).expect("an answer");
    let Verdict::Proved(certificate, rechecked) = outcome.verdict else { panic!("not proved") };
    (certificate, rechecked.stepped)
}

#[test]
fn a_step_of_five_degrees_through_a_slow_servo_is_proved_with_its_limits() {
    let (certificate, stepped) = proved(10.0, 5.0);
    let stepped = stepped.expect("steps are proved");
    assert!((stepped.setpoint_rad - 5.0 * DEG).abs() < 1e-12 && stepped.limited, "{stepped:?}");
    assert_eq!(certificate.check().expect("holds").stepped, Some(stepped));
}

#[test]
fn steps_are_not_believed_beyond_their_boxes_their_range_or_their_form() {
    let (certificate, _) = proved(20.0, 2.0);
    let steps = certificate.steps.clone().expect("steps are proved");
    let refused = |steps: Steps| {
        let changed = Certificate { steps: Some(steps), ..certificate.clone() };
        changed.check().expect_err("refused").to_string()
    };
    let wider = Steps { setpoint_rad: 1.5 * steps.setpoint_rad, ..steps.clone() };
    assert!(refused(wider).contains("range"));
    let mut ends = steps.ends.clone();
    ends.pop();
    assert!(refused(Steps { ends, ..steps.clone() }).contains("fill") || steps.ends.len() == 2);
    let heavier = Steps { load_rad: 2.0 * steps.load_rad, ..steps.clone() };
    assert!(refused(heavier).contains("range"));
    let level = 4.0 * steps.terminal.level;
    let larger = Steps { terminal: Terminal { level, ..steps.terminal.clone() }, ..steps.clone() };
    refused(larger);
    let rate = 0.5 * steps.terminal.rate;
    let faster = Steps { terminal: Terminal { rate, ..steps.terminal.clone() }, ..steps };
    refused(faster);
}

#[test]
fn what_a_scenario_commands_is_proved_with_its_limits_and_believed_as_far_as_its_sets_go() {
    let (certificate, _) = proved(20.0, 2.0);
    let commanded = certificate.commanded.clone().expect("flights are proved");
    assert!((commanded.commands.setpoint_rad - 2.0 * DEG).abs() < 1e-12, "{commanded:?}");
    let ended = certificate.check().expect("holds").ended.expect("flights are proved");
    assert!(ended.settled_s > 18.0 && ended.settled_s < 60.0, "{ended:?}");

    let refused = |changed: Commanded| {
        let changed = Certificate { commanded: Some(changed), ..certificate.clone() };
        changed.check().expect_err("refused").to_string()
    };
    let with = |change: &dyn Fn(&mut Commanded)| {
        let mut changed = commanded.clone();
        change(&mut changed);
        refused(changed)
    };
    assert!(with(&|it| it.commands.setpoint_rad *= 1.5).contains("range"));
    assert!(with(&|it| it.commands.load_rad *= 1.5).contains("range"));
    assert!(with(&|it| it.commands.at_servo = Shares(vec![(50, 2.0)])).contains("range"));
    assert!(with(&|it| it.commands.at_servo = Shares(vec![(50, 0.5)])).contains("range"));
    assert!(with(&|it| it.commands.setpoint = Shares::default()).contains("range"));
    assert!(with(&|it| it.legs.clear()).contains("legs"));
    assert!(with(&|it| it.legs[0].from_sample = 1).contains("follow"));
    let shorter = |group: &mut LegGroup| {
        group.setpoints_rad.pop();
    };
    let fewer = with(&|it| it.legs.iter_mut().for_each(|leg| shorter(&mut leg.groups[0])));
    assert!(fewer.contains("fill") || fewer.contains("ends of parts"), "{fewer}");
    assert!(with(&|it| it.legs[0].groups[0].loads_rad[0] *= 0.5).contains("fill"));
    let last = |it: &mut Commanded, change: &dyn Fn(&mut Leg)| {
        if let Some(leg) = it.legs.last_mut() {
            change(leg);
        }
    };
    assert!(with(&|it| last(it, &|leg| leg.groups[0].of = vec![999])).contains("is not"));
    let missing = with(&|it| {
        last(it, &|leg| {
            leg.groups[0].of.pop();
        });
    });
    assert!(missing.contains("no group"), "{missing}");
    with(&|it| it.terminal.level *= 4.0);
    with(&|it| it.terminal.rate *= 0.5);
}

#[test]
fn a_leg_that_would_be_flown_for_a_year_or_in_a_million_sets_is_refused() {
    let (certificate, _) = proved(20.0, 2.0);
    let commanded = certificate.commanded.clone().expect("flights are proved");
    let refused = |change: &dyn Fn(&mut Commanded)| {
        let mut changed = commanded.clone();
        change(&mut changed);
        let changed = Certificate { commanded: Some(changed), ..certificate.clone() };
        changed.check().expect_err("refused").to_string()
    };
    let late = refused(&|it| {
        let last = it.legs[0].clone();
        it.legs.push(Leg { from_sample: 4_000_000_000, ..last });
    });
    assert!(late.contains("than a check may fly") || late.contains("no group"), "{late}");
    let later = refused(&|it| it.commands.setpoint.0[2].0 = 4_000_000_000);
    assert!(later.contains("than a check may fly"), "{later}");
    let many = refused(&|it| {
        let [least, most] = [it.legs[0].groups[0].loads_rad[0], 0.01];
        let at = |part: usize| least + (most - least) * part as f64 / 900.0;
        it.legs[0].groups[0].loads_rad = (0..=900).map(at).collect();
        it.legs[0].groups[0].setpoints_rad = (0..=900).map(at).collect();
    });
    assert!(many.contains("sets of a leg"), "{many}");
}
