//! For which set-points and loads something is proved, and what remains.

use fspid_core::{
    Derivative, Fspid, Gains, Guard, InputScale, IntegralForm, Law, Pid, PidConfig, SelfTuner,
    SetpointWeights, TunerSettings,
};
use fspid_proof::{
    Asked, Certificate, Effort, LoopDescription, Outcome, Range, Rechecked, Verdict, certify,
};
use fspid_sim::Controller;
use fspid_sim::actuator::{Actuator, Lag};

use crate::paper_loop::{NOMINAL, loop_of, rising};

const DEG: f64 = core::f64::consts::PI / 180.0;

fn config() -> PidConfig<f64> {
    PidConfig { derivative: Derivative { filter_s: 0.05 }, ..PidConfig::sampled_every(0.01) }
}

fn weighted(weight: f64) -> PidConfig<f64> {
    let setpoint_weights = SetpointWeights { proportional: weight, derivative: 1.0 };
    PidConfig { setpoint_weights, ..config() }
}

fn pitch_per_command() -> f64 {
    0.0099096 / 0.0072771
}

fn fixed(config: PidConfig<f64>) -> LoopDescription {
    loop_of(Controller::Fixed(Pid::new(NOMINAL, config).expect("allowed")))
}

fn tuned(config: PidConfig<f64>, law: Law<f64>, nominal: Gains<f64>) -> LoopDescription {
    let settings = TunerSettings {
        input_scale: InputScale { error_per_rad: 57.0, change_per_rad: 12.0 },
        output_scale: Gains { kp: 0.09, ki: 0.02 * nominal.ki, kd: 0.045 },
        law,
        ..TunerSettings::literal()
    };
    let tuner = SelfTuner::new(nominal, rising(), settings).expect("allowed");
    loop_of(Controller::SelfTuning(Fspid::new(tuner, config).expect("allowed")))
}

fn asked(setpoint_deg: f64, load_deg: f64) -> Asked {
    Asked::within(Range { setpoint_rad: setpoint_deg * DEG, load_rad: load_deg * DEG })
}

fn answer(description: &LoopDescription, asked: &Asked) -> Outcome {
    let effort = Effort { divisions: 12, halvings: 3, largest_factor: 1.0, ..Effort::default() };
    certify(description, asked, &effort).expect("provable")
}

fn proved(outcome: Outcome) -> (Certificate, Rechecked) {
    match outcome.verdict {
        Verdict::Proved(certificate, rechecked) => (certificate, rechecked),
        other => panic!("{other:?}"),
    }
}

/// It used to be proved at every set-point: the command that a weight other than 1 leaves beside the error was
/// no part of the loop.
#[test]
fn with_a_setpoint_weight_of_zero_little_is_proved_and_much_is_not() {
    let description = tuned(weighted(0.0), Law::Memoryless, NOMINAL);
    let (certificate, rechecked) = proved(answer(&description, &asked(1.0, 0.0)));
    assert!(!rechecked.any_setpoint && rechecked.any_load);
    assert!(rechecked.remains_rad < 0.01 * DEG, "{}", rechecked.remains_rad / DEG);
    let far = answer(&description, &asked(300.0, 0.0));
    assert_eq!(far.verdict, Verdict::Open);
    let (less, _) = far.instead.expect("some of it");
    assert!(less.range.setpoint_rad < 300.0 * DEG);
    // More than was proved is not believed.
    let wide = Range { setpoint_rad: 300.0 * DEG, load_rad: 0.0 };
    assert!(Certificate { range: wide, ..certificate.clone() }.check().is_err());
    for bad in [-1.0, f64::NAN, f64::INFINITY] {
        let range = Range { setpoint_rad: bad, load_rad: 0.0 };
        assert!(Certificate { range, ..certificate.clone() }.check().is_err());
    }
}

#[test]
fn with_a_weight_of_one_and_the_bumpless_integral_every_setpoint_and_load_is_proved() {
    let description = tuned(config(), Law::Memoryless, NOMINAL);
    let (_, rechecked) = proved(answer(&description, &asked(300.0, 100.0)));
    assert!(rechecked.any_setpoint && rechecked.any_load);
    assert_eq!(rechecked.remains_rad.to_bits(), 0.0_f64.to_bits());
    let (_, rechecked) = proved(answer(&fixed(weighted(0.0)), &asked(300.0, 100.0)));
    assert!(rechecked.any_setpoint && rechecked.any_load);
}

/// A weight of 0.5 at the nominal gains, as a part that no gain moves: the integral takes it up once.
#[test]
fn what_is_fed_forward_leaves_every_setpoint_proved_where_a_weight_does_not() {
    let fed = PidConfig { feedforward: -0.5 * NOMINAL.kp, ..config() };
    for law in [Law::Memoryless, Law::Accumulating { leakage_per_s: 1.0 }] {
        let (_, rechecked) = proved(answer(&tuned(fed, law, NOMINAL), &asked(300.0, 100.0)));
        assert!(rechecked.any_setpoint && rechecked.any_load);
        let (_, rechecked) = proved(answer(&tuned(weighted(0.5), law, NOMINAL), &asked(1.0, 0.0)));
        assert!(!rechecked.any_setpoint);
    }
    // Without an integral it is an error that stays, which is stated.
    let nominal = Gains { ki: 0.0, ..NOMINAL };
    let error = |config| {
        let description = tuned(config, Law::Memoryless, nominal);
        proved(answer(&description, &asked(1.0, 0.0))).1.rest_error_rad
    };
    assert!(error(fed) > error(config()) + 0.1 * DEG);
}

/// It used to be proved for every load.
#[test]
fn the_literal_integral_is_proved_for_small_loads_and_not_for_large_ones() {
    let literal = PidConfig { integral: IntegralForm::Literal, ..config() };
    let description = tuned(literal, Law::Memoryless, NOMINAL);
    let (certificate, rechecked) = proved(answer(&description, &asked(0.3, 0.1)));
    assert!(!rechecked.any_setpoint && !rechecked.any_load);
    let load_rad = 1000.0 * DEG;
    let heavy = Certificate { range: Range { load_rad, ..certificate.range }, ..certificate };
    assert!(heavy.check().is_err());
    assert_eq!(answer(&description, &asked(0.3, 1000.0)).verdict, Verdict::Open);
}

#[test]
fn an_accumulating_law_with_a_weight_is_proved_for_a_range_and_with_the_literal_integral_for_rest()
{
    let law = Law::Accumulating { leakage_per_s: 1.0 };
    let description = tuned(weighted(0.5), law, NOMINAL);
    let (certificate, rechecked) = proved(answer(&description, &asked(1.0, 0.0)));
    assert!(!rechecked.any_setpoint && rechecked.any_load);
    assert!(rechecked.remains_rad < 0.01 * DEG, "{}", rechecked.remains_rad / DEG);
    // The same matrices are no proof for set-points that move the gains' part of the command as far as it goes.
    let setpoint_rad = 1000.0 * DEG;
    let far = Certificate { range: Range { setpoint_rad, ..certificate.range }, ..certificate };
    assert!(far.check().is_err());
    // The literal integral makes something of the whole command.
    let literal = PidConfig { integral: IntegralForm::Literal, ..weighted(0.5) };
    let outcome = answer(&tuned(literal, law, NOMINAL), &asked(1.0, 0.0));
    assert_eq!(outcome.verdict, Verdict::Open);
    let (certificate, _) = outcome.instead.expect("return to rest");
    assert_eq!(certificate.range, Range::REST);
    let (_, rechecked) = proved(answer(&tuned(config(), law, NOMINAL), &asked(20.0, 5.0)));
    assert!(rechecked.any_setpoint && rechecked.any_load);
}

#[test]
fn without_an_integral_the_error_that_stays_is_stated() {
    let nominal = Gains { ki: 0.0, ..NOMINAL };
    let description = tuned(config(), Law::Memoryless, nominal);
    let (_, rechecked) = proved(answer(&description, &asked(1.0, 0.0)));
    // 1 deg over 1 + kp G with a pitch of 1.36 per command.
    assert!(rechecked.rest_error_rad > 0.2 * DEG && rechecked.rest_error_rad < 0.6 * DEG);
    assert!(!rechecked.any_setpoint);
}

/// A certificate of fixed gains without an integral used to say nothing of the error that stays, as if there were none.
#[test]
fn fixed_gains_without_an_integral_state_the_error_that_stays_and_what_is_fed_forward_takes_away() {
    let nominal = Gains { ki: 0.0, ..NOMINAL };
    let error = |config: PidConfig<f64>, range: (f64, f64)| {
        let pid = Pid::new(nominal, config).expect("allowed");
        let description = LoopDescription { controller: Controller::Fixed(pid), ..fixed(config) };
        let (_, rechecked) = proved(answer(&description, &asked(range.0, range.1)));
        assert!(rechecked.any_setpoint && rechecked.any_load);
        rechecked.rest_error_rad / DEG
    };
    let near = |found: f64, expected: f64| {
        assert!(found >= expected && found <= expected * (1.0 + 1e-9), "{found} {expected}");
    };
    let per = pitch_per_command().recip();
    let open = nominal.kp + per;
    near(error(config(), (2.0, 0.0)), 2.0 * per / open);
    near(error(config(), (2.0, 0.5)), (2.0 * per + 0.5) / open);
    near(error(weighted(0.5), (2.0, 0.0)), 2.0 * (per + 0.5 * nominal.kp) / open);
    let fed = |feedforward| PidConfig { feedforward, ..config() };
    near(error(fed(0.25 * per), (2.0, 0.0)), 2.0 * 0.75 * per / open);
    assert!(error(fed(per), (2.0, 0.0)) < 1e-9, "all of it is fed forward");
    assert!(error(config(), (0.0, 0.0)) == 0.0, "nothing is held");
    let integral = proved(answer(&fixed(config()), &asked(2.0, 0.5))).1;
    assert!(integral.rest_error_rad == 0.0);
}

/// It used to be proved that every deviation falls, and a step of half the resolution left a command that
/// swings.
#[test]
fn with_a_resolution_it_is_stated_what_remains() {
    let mut description = fixed(config());
    description.pitch.resolution = 0.01 * DEG;
    let (_, rechecked) = proved(answer(&description, &asked(1.0, 0.0)));
    assert!(rechecked.remains_rad > 0.005 * DEG, "{}", rechecked.remains_rad / DEG);
    // With gains that stand still the bound is that of the response itself: a few steps.
    assert!(rechecked.remains_rad < 0.05 * DEG, "{}", rechecked.remains_rad / DEG);
    // What remains grows with the resolution until a limit may act in it: then nothing is proved.
    let limited = description.actuator.with_command_limits(-0.35, 0.35).expect("allowed");
    description.actuator = limited;
    description.pitch.resolution = 1e-4 * DEG;
    proved(answer(&description, &asked(1.0, 0.0)));
    description.pitch.resolution = 5.0 * DEG;
    assert_eq!(answer(&description, &asked(1.0, 0.0)).verdict, Verdict::Open);
}

#[test]
fn set_points_loads_and_the_sample_guard_come_off_the_limits() {
    let mut description = fixed(config());
    let actuator = description.actuator.with_command_limits(-0.35, 0.35).expect("allowed");
    description.actuator = actuator;
    let within = |description: &LoopDescription, setpoint_deg, load_deg| match answer(
        description,
        &asked(setpoint_deg, load_deg),
    )
    .verdict
    {
        Verdict::Proved(_, rechecked) => rechecked.pitch_within_rad,
        _ => None,
    };
    let rest = within(&description, 0.0, 0.0).expect("an ellipsoid");
    // Small ones: that steps of five degrees are flown in sets as well takes a minute, and is tested elsewhere.
    let held = within(&description, 0.5, 0.0).expect("an ellipsoid");
    let loaded = within(&description, 0.5, 0.5).expect("an ellipsoid");
    assert!(rest > held && held > loaded, "{rest} {held} {loaded}");
    // 747: 40 deg of pitch take more than 20 deg of elevator.
    assert_eq!(within(&description, 40.0, 0.0), None);
    let guard = Guard::new(10.0 * DEG).expect("allowed");
    let guarded = fixed(PidConfig { guard, ..config() });
    assert_eq!(guarded.limits(), ["sample guard of the controller"]);
    let pitch_rad = within(&guarded, 4.0, 0.0).expect("an ellipsoid");
    assert!(pitch_rad < 6.0 * DEG, "{}", pitch_rad / DEG);
    assert_eq!(within(&guarded, 11.0, 0.0), None);
}

/// It used to be proved at every set-point, "every deviation dies out", and flights ended a third of the set-point
/// off: the servo does not hold it.
#[test]
fn what_a_limit_does_not_leave_at_rest_is_open_with_the_largest_range_that_it_does() {
    let mut description = fixed(config());
    let limit_rad = 15.0 * DEG;
    description.actuator =
        description.actuator.with_command_limits(-limit_rad, limit_rad).expect("allowed");
    // A pitch of 1.36 per command: 20.4 deg can be held.
    let outcome = answer(&description, &asked(60.0, 0.0));
    assert_eq!(outcome.verdict, Verdict::Open);
    let because = outcome.open_because.expect("a reason").to_string();
    assert!(because.contains("rest at 60.00 deg needs 44.06 deg"), "{because}");
    let limit =
        "the servo's command limit is at 15.00 deg, of which 10 % have to be left for motions";
    assert!(because.contains(limit), "{because}");
    let (certificate, _) = outcome.instead.expect("what the servo holds");
    let proved_deg = certificate.range.setpoint_rad / DEG;
    // A tenth of the limit is left for motions.
    assert!(proved_deg > 18.0 && proved_deg < 0.9 * 20.43, "{proved_deg}");
    // The same of a certificate that is written by hand, at a load, a guard and the end of the travel.
    let wide = Range { setpoint_rad: 60.0 * DEG, load_rad: 0.0 };
    let by_hand = Certificate { range: wide, level: None, ..certificate };
    let refused = by_hand.check().expect_err("at the limit").to_string();
    assert!(refused.starts_with("rest at 60.00 deg needs 44.06 deg"), "{refused}");
    assert_eq!(answer(&description, &asked(1.0, 16.0)).verdict, Verdict::Open);
    let travel = Actuator::new(Lag::first_order(0.1).expect("allowed"));
    description.actuator = travel.with_travel(-limit_rad, limit_rad).expect("allowed");
    assert_eq!(answer(&description, &asked(21.0, 0.0)).verdict, Verdict::Open);
    let guard = Guard::new(10.0 * DEG).expect("allowed");
    let guarded = fixed(PidConfig { guard, ..config() });
    assert_eq!(answer(&guarded, &asked(11.0, 0.0)).verdict, Verdict::Open);
}

/// It used to be proved, "the pitch angle may stay up to 6211 deg off rest".
#[test]
fn a_proof_that_leaves_more_than_a_flight_shows_is_open_with_the_number() {
    let mut description = tuned(config(), Law::Memoryless, NOMINAL);
    description.pitch.resolution = 0.1 * DEG;
    let outcome = answer(&description, &asked(1.0, 0.0));
    assert_eq!(outcome.verdict, Verdict::Open);
    let because = outcome.open_because.expect("a reason").to_string();
    assert!(because.contains("may stay up to"), "{because}");
    assert!(because.contains("allowed are 1.000 deg"), "{because}");
    // Of a large set-point and with small steps little remains.
    description.pitch.resolution = 1e-5 * DEG;
    let (_, rechecked) = proved(answer(&description, &asked(100.0, 0.0)));
    assert!(rechecked.remains_rad > 0.0 && rechecked.remains_rad <= 10.0 * DEG);
}
