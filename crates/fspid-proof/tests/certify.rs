//! From loops to proved, refuted, refused; and certificates that are tampered with.

use fspid_core::{
    ControllerSetting, Derivative, Fspid, GainCoupling, GainLimits, Gains, InputScale, InputSets,
    Law, Limits, Pid, PidConfig, ReferenceModel, SecondInput, SelfTuner, SetCentres, TunerSettings,
};
use fspid_fuzzy::{NumberTable, OutOfRange, Supervisor};
use fspid_lti::Matrix;
use fspid_proof::gain_set::{IncrementCell, IncrementMap, IncrementSlopes};
use fspid_proof::{
    Asked, Bearing, BoundedRate, Certificate, Claim, Effort, LeftOut, LoopDescription, NotProvable,
    Range, Verdict, certify,
};
use fspid_sim::Controller;

use crate::paper_loop::{NOMINAL, loop_of, rising};

pub(crate) fn config() -> PidConfig<f64> {
    PidConfig { derivative: Derivative { filter_s: 0.05 }, ..PidConfig::sampled_every(0.01) }
}

pub(crate) fn fixed(gains: Gains<f64>) -> Controller {
    Controller::Fixed(Pid::new(gains, config()).expect("allowed"))
}

/// Gains within ± 8/9 of `scale` times 5 around the nominal ones.
pub(crate) fn tuned(scale: Gains<f64>, law: Law<f64>) -> Controller {
    with_inputs(InputScale { error_per_rad: 57.0, change_per_rad: 12.0 }, scale, law)
}

fn with_inputs(input_scale: InputScale<f64>, scale: Gains<f64>, law: Law<f64>) -> Controller {
    let settings =
        TunerSettings { input_scale, output_scale: scale, law, ..TunerSettings::literal() };
    let tuner = SelfTuner::new(NOMINAL, rising(), settings).expect("allowed");
    Controller::SelfTuning(Fspid::new(tuner, config()).expect("allowed"))
}

pub(crate) fn quick() -> Effort {
    Effort { halvings: 2, largest_factor: 2.0, ..Effort::default() }
}

/// The certificate of a loop that is proved.
pub(crate) fn proved(description: &LoopDescription) -> Certificate {
    match certify(description, &Asked::rest(), &quick()).expect("provable").verdict {
        Verdict::Proved(certificate, _) => certificate,
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_stable_loop_with_fixed_gains_is_proved_and_an_unstable_one_refuted() {
    assert!(proved(&loop_of(fixed(NOMINAL))).check().is_ok());
    let unstable = loop_of(fixed(Gains { kp: 10.0, ki: 0.0, kd: 0.0 }));
    let outcome = certify(&unstable, &Asked::rest(), &quick()).expect("provable");
    let Verdict::Refuted(certificate, _) = outcome.verdict else { panic!("{outcome:?}") };
    assert!(matches!(certificate.claim, Claim::FrozenGrowth { .. }));
    assert!(certificate.check().is_ok());
}

#[test]
fn gains_that_move_by_a_fifth_are_proved_at_any_speed() {
    let scale = Gains { kp: 0.09, ki: 0.02, kd: 0.045 };
    let certificate = proved(&loop_of(tuned(scale, Law::Memoryless)));
    assert!(matches!(certificate.claim, Claim::CommonQuadratic { rate, .. } if rate < 1.0));
    let rechecked = certificate.check().expect("it holds");
    assert!(rechecked.inequalities > rechecked.cells);
    assert!(rechecked.bounds[0].lower() < 1.65 && rechecked.bounds[0].upper() > 2.35);
}

#[test]
fn gains_that_do_not_hold_where_the_supervisor_puts_them_are_refuted() {
    let scale = Gains { kp: 0.0, ki: 0.0, kd: 0.5 };
    let description = loop_of(tuned(scale, Law::Memoryless));
    let outcome = certify(&description, &Asked::rest(), &quick()).expect("provable");
    let Verdict::Refuted(certificate, _) = outcome.verdict else { panic!("{outcome:?}") };
    assert!(matches!(certificate.claim, Claim::FrozenGrowth { .. }), "{:?}", certificate.claim);
    assert!(outcome.largest.proved > 0.0 && outcome.largest.proved < 1.0);
}

/// Where the gains at rest themselves let the loop grow, the flown loop does not settle; it used to be said that it
/// may.
#[test]
fn growth_at_rest_refutes_the_flown_loop_itself() {
    let scale = Gains { kp: 0.0, ki: 0.0, kd: 0.01 };
    let supervisor = |nominal| {
        let Controller::SelfTuning(fspid) = tuned(scale, Law::Memoryless) else { panic!("tuned") };
        let tuner = fspid.tuner();
        SelfTuner::new(nominal, *tuner.supervisor(), *tuner.settings()).expect("allowed")
    };
    let unstable = supervisor(Gains { kp: 10.0, ki: 0.0, kd: 0.0 });
    let fspid = Fspid::new(unstable, config()).expect("allowed");
    let description = loop_of(Controller::SelfTuning(fspid));
    let outcome = certify(&description, &Asked::rest(), &quick()).expect("provable");
    let Verdict::Refuted(certificate, rechecked) = outcome.verdict else { panic!("{outcome:?}") };
    let bearing = certificate.bearing(&rechecked);
    assert_eq!(bearing, Bearing::Grows);
    assert!(bearing.is_refutation() && !bearing.to_string().contains("may still settle"));
    // Nothing of set-points and loads: the claim is about gains.
    let left_out = certificate.scope(&rechecked).left_out;
    assert_eq!(left_out, [LeftOut::Rounding]);
}

/// The error at rest is taken as zero where there is an integral: one whose gain is zero there brings it nowhere.
#[test]
fn with_an_integral_gain_of_zero_at_rest_nothing_is_proved() {
    let Controller::SelfTuning(fspid) =
        tuned(Gains { kp: 0.09, ki: 0.02, kd: 0.045 }, Law::Memoryless)
    else {
        panic!("tuned")
    };
    let around =
        |least, most| Limits::new(ControllerSetting::GainLimits, least, most).expect("allowed");
    let limits = GainLimits { kp: around(0.5, 4.0), ki: around(0.0, 1.0), kd: around(0.0, 3.0) };
    let settings = TunerSettings { gain_limits: Some(limits), ..*fspid.tuner().settings() };
    let nominal = Gains { ki: 0.0, ..NOMINAL };
    let tuner = SelfTuner::new(nominal, *fspid.tuner().supervisor(), settings).expect("allowed");
    let description =
        loop_of(Controller::SelfTuning(Fspid::new(tuner, config()).expect("allowed")));
    let outcome = certify(&description, &Asked::rest(), &quick()).expect("provable");
    assert_eq!(outcome.verdict, Verdict::Open);
    let because = outcome.open_because.expect("a reason").to_string();
    assert!(because.contains("gain of the integral may be zero at rest"), "{because}");
}

thread_local! {
    /// How often it was asked whether to stop, and from which question on the answer is yes.
    static ASKED: std::cell::Cell<(u32, u32)> = const { std::cell::Cell::new((0, u32::MAX)) };
}

fn counted() -> bool {
    let (asked, most) = ASKED.get();
    ASKED.set((asked + 1, most));
    asked >= most
}

/// A proof went on for up to half a minute after nobody wanted it any more.
#[test]
fn a_search_that_is_stopped_is_an_error_soon_and_never_an_answer() {
    let scale = Gains { kp: 0.09, ki: 0.02, kd: 0.045 };
    let description = loop_of(tuned(scale, Law::Memoryless));
    let effort = Effort { stops: counted, divisions: 12, cones: 0, frozen_points: 9, ..quick() };
    let whole = certify(&description, &Asked::rest(), &effort).expect("provable");
    let all = ASKED.get().0;
    assert!(all > 100, "asked {all} times");
    let patient = Effort { stops: Effort::default().stops, ..effort };
    let unasked = certify(&description, &Asked::rest(), &patient).expect("provable");
    assert_eq!(whole, unasked, "who asks changes nothing");
    for most in [0, 1, 2, 7, all / 3, all / 2, all - 1] {
        ASKED.set((0, most));
        let stopped = certify(&description, &Asked::rest(), &effort);
        assert_eq!(stopped, Err(NotProvable::Stopped), "after {most}");
        let more = ASKED.get().0 - most;
        assert!(more < 20, "asked {more} times more after {most}");
    }
}

#[test]
fn gains_without_bounds_and_actuators_with_play_are_refused_with_words() {
    let law = Law::Accumulating { leakage_per_s: 0.0 };
    let drifting = loop_of(tuned(Gains { kp: 0.1, ki: 0.0, kd: 0.0 }, law));
    let refused = certify(&drifting, &Asked::rest(), &quick()).expect_err("without bounds");
    assert!(matches!(refused, NotProvable::UnboundedGains(_)), "{refused}");
    let mut loose = loop_of(fixed(NOMINAL));
    loose.actuator = loose.actuator.with_play(0.01).expect("allowed");
    let refused = loose.provable().expect_err("play");
    assert!(refused.to_string().contains("play"), "{refused}");
}

#[test]
fn limits_that_do_not_act_near_rest_are_in_the_proof() {
    let mut description = loop_of(fixed(NOMINAL));
    let actuator = description.actuator.with_command_limits(-0.35, 0.35);
    description.actuator = actuator.and_then(|a| a.with_rate_limit(0.65)).expect("allowed");
    let outcome = certify(&description, &Asked::rest(), &quick()).expect("provable");
    let Verdict::Proved(_, rechecked) = outcome.verdict else { panic!("{outcome:?}") };
    let pitch_rad = rechecked.pitch_within_rad.expect("an ellipsoid");
    assert!(pitch_rad > 1e-4 && pitch_rad < 0.35, "{pitch_rad}");
    let mut certificate = proved(&description);
    assert!(certificate.check().is_ok());
    // Twice the level that was found lets a limit act.
    certificate.level = certificate.level.map(|level| 2.0 * level);
    assert!(certificate.check().is_err());
}

#[test]
fn a_certificate_of_another_loop_or_a_better_rate_does_not_hold() {
    let scale = Gains { kp: 0.09, ki: 0.02, kd: 0.045 };
    let good = proved(&loop_of(tuned(scale, Law::Memoryless)));
    let mut wider = good.clone();
    wider.output_factor = 8.0;
    assert!(wider.check().is_err());
    let mut other = good.clone();
    other.description.denominator[1] = 0.1;
    assert!(other.check().is_err());
    let mut faster = good.clone();
    if let Claim::CommonQuadratic { rate, .. } = &mut faster.claim {
        *rate = 0.999;
    }
    assert!(faster.check().is_err());
    let mut later = good;
    later.description.actuator = later.description.actuator.with_delay(40).expect("allowed");
    assert!(later.check().is_err(), "the form has another size");
}

#[test]
fn a_certificate_that_asks_nothing_of_the_loop_does_not_hold() {
    let description = loop_of(tuned(Gains { kp: 0.0, ki: 0.0, kd: 0.5 }, Law::Memoryless));
    let size = description.enclosed().expect("a model").size();
    let s_procedure = |multipliers| Certificate {
        description: description.clone(),
        output_factor: 1.0,
        divisions: 4,
        range: Range::REST,
        left_out: Vec::new(),
        steps: None,
        commanded: None,
        claim: Claim::SProcedure { form: Matrix::identity(size), rate: 1.0, multipliers },
        level: None,
        family: None,
        disturbances: Vec::new(),
        nonlinear: None,
    };
    let refused = s_procedure(vec![]).check().expect_err("no cones");
    assert!(refused.to_string().contains("double cones"), "{refused}");
    assert!(s_procedure(vec![0.0]).check().is_err());
    assert!(s_procedure(vec![0.0; 1001]).check().is_err());
    let good = proved(&loop_of(fixed(NOMINAL)));
    for output_factor in [-1.0, f64::NAN, f64::INFINITY] {
        assert!(Certificate { output_factor, ..good.clone() }.check().is_err());
    }
    for divisions in [0, usize::MAX] {
        assert!(Certificate { divisions, ..good.clone() }.check().is_err());
    }
}

#[test]
fn an_input_that_the_supervisor_never_sees_refutes_nothing() {
    let scale = Gains { kp: 0.0, ki: 0.0, kd: 0.5 };
    let seeing = loop_of(tuned(scale, Law::Memoryless));
    let outcome = certify(&seeing, &Asked::rest(), &quick()).expect("provable");
    let Verdict::Refuted(mut certificate, _) = outcome.verdict else { panic!("{outcome:?}") };
    // The table answers to the error alone: without it the gains stay as they are.
    let blind = InputScale { error_per_rad: 0.0, change_per_rad: 12.0 };
    let description = loop_of(with_inputs(blind, scale, Law::Memoryless));
    let outcome = certify(&description, &Asked::rest(), &quick()).expect("provable");
    assert!(!matches!(outcome.verdict, Verdict::Refuted(..)), "{outcome:?}");
    certificate.description = description;
    assert!(certificate.check().is_err());
}

#[test]
fn rules_that_conclude_numbers_are_proved_as_what_they_say() {
    let grid = core::array::from_fn(|row| {
        core::array::from_fn(|column| row as f64 / 3.0 - 1.0 + 0.1 * (column % 2) as f64)
    });
    let numbers = NumberTable::new([grid; 3]).expect("finite");
    let supervisor = Supervisor::of_numbers(&numbers, 5.0, OutOfRange::Clamp).expect("allowed");
    let output_scale = Gains { kp: 0.3, ki: 0.1, kd: 0.2 };
    let settings = TunerSettings { output_scale, ..TunerSettings::literal() };
    let tuner = SelfTuner::new(NOMINAL, supervisor, settings).expect("allowed");
    let fspid = Fspid::new(tuner, config()).expect("allowed");
    assert!(proved(&loop_of(Controller::SelfTuning(fspid))).check().is_ok());
    let map = IncrementMap::of(&tuner, 3).expect("bounded");
    let holds = |cell: &IncrementCell| {
        let bounds = cell.delta.map(|delta| [delta.lower(), delta.upper()]);
        bounds.iter().all(|[lower, upper]| *lower >= -1.01 && *upper <= 1.11)
    };
    assert!(map.cells.iter().all(holds));
    let slopes = IncrementSlopes::of(&tuner, [1.0; 2]).expect("bilinear").slopes;
    let near = |one: f64, other: f64| (one - other).abs() < 1e-12;
    for [by_error, by_change] in slopes {
        assert!(near(by_error.upper(), 0.2) && by_error.lower() <= 0.0);
        assert!(near(by_change.upper(), 0.06) && near(by_change.lower(), -0.06));
    }
}

#[test]
fn a_tuner_of_another_structure_is_proved_as_what_it_is() {
    let model = ReferenceModel { bandwidth_rad_s: 1.0, damping: 1.0 };
    let uneven = InputSets { error: SetCentres::new(0.2, 0.5).ok(), change: None };
    let output_scale = Gains { kp: 0.09, ki: 0.02, kd: 0.045 };
    let proved = |settings: TunerSettings<f64>| {
        let tuner = SelfTuner::new(NOMINAL, rising(), settings);
        let fspid = Fspid::new(tuner.expect("allowed"), config()).expect("allowed");
        let certificate = proved(&loop_of(Controller::SelfTuning(fspid)));
        certificate.check().expect("it holds")
    };
    let plain = TunerSettings { output_scale, ..TunerSettings::literal() };
    let law = Law::Accumulating { leakage_per_s: 1.0 };
    for settings in [
        TunerSettings { second_input: SecondInput::Rate, ..plain },
        TunerSettings { second_input: SecondInput::ModelError(model), ..plain },
        TunerSettings { input_sets: uneven, ..plain },
        TunerSettings { second_input: SecondInput::ModelError(model), law, ..plain },
    ] {
        let rechecked = proved(settings);
        assert!(rechecked.bounds[0].lower() < 1.65 && rechecked.bounds[0].upper() > 2.35);
    }
    // A rate loop that follows kd is in the loop that is proved: what it does there is not what kd does.
    let gain_coupling = GainCoupling { setpoint_weight: 0.1, rate_gain: 0.5 };
    assert!(proved(TunerSettings { gain_coupling, law, ..plain }).cells == 1);
    let wild = GainCoupling { setpoint_weight: 0.0, rate_gain: -40.0 };
    let settings = TunerSettings { gain_coupling: wild, law, ..plain };
    let tuner = SelfTuner::new(NOMINAL, rising(), settings).expect("allowed");
    let wild = Controller::SelfTuning(Fspid::new(tuner, config()).expect("allowed"));
    let outcome = certify(&loop_of(wild), &Asked::rest(), &quick()).expect("provable");
    assert!(!matches!(outcome.verdict, Verdict::Proved(..)), "{outcome:?}");
}

#[test]
fn a_rate_that_the_law_is_not_known_to_keep_says_nothing_of_the_flown_loop() {
    // Gains that the form does not move with are anywhere at once: here only kp moves.
    let scale = Gains { kp: 0.09, ki: 0.0, kd: 0.0 };
    let good = proved(&loop_of(tuned(scale, Law::Memoryless)));
    let rechecked = good.check().expect("it holds");
    assert_eq!(good.bearing(&rechecked), Bearing::Stable);
    let Claim::CommonQuadratic { form, .. } = &good.claim else { panic!("{:?}", good.claim) };
    // A form that moves with kp by a hundred thousandth of itself falls as long as kp moves slowly.
    let none = Matrix::zeros(form.rows(), form.columns());
    let claim = BoundedRate {
        ends: rechecked.bounds.map(|bounds| [bounds.lower(), bounds.upper()]),
        changes: [0.01, 2.0, 2.0],
        forms: [form.clone(), form.scaled(1e-5), none.clone(), none],
        rate: 1.0,
    };
    let slow = Certificate { claim: Claim::BoundedRate(claim), level: None, ..good.clone() };
    let rechecked = slow.check().expect("the inequalities are proved");
    assert_eq!(
        (rechecked.keeps_to_the_rate, slow.bearing(&rechecked)),
        (false, Bearing::RateNotKept)
    );
    assert!(!slow.bearing(&rechecked).is_stability());
    let still = Certificate { output_factor: 0.0, ..good };
    let rechecked = still.check().expect("gains that stand still hold");
    assert_eq!(still.bearing(&rechecked), Bearing::OtherScale { factor: 0.0 });
}

#[test]
fn what_is_too_large_is_told_at_once_and_before_the_loop_is_enclosed() {
    let scale = Gains { kp: 0.09, ki: 0.02, kd: 0.045 };
    let good = proved(&loop_of(tuned(scale, Law::Memoryless)));
    let enclosed = good.description.enclosed().expect("a model").size();
    assert_eq!(good.description.states(), enclosed);
    let mut large = Certificate { divisions: 1000, ..good };
    large.description.actuator = large.description.actuator.with_delay(10_000).expect("allowed");
    let refused = large.check().expect_err("too large").to_string();
    for part in [
        "loop: 10008 states",
        "divisions: 1000 cells",
        "claim.form: 8 rows",
        " products of the re-check",
    ] {
        assert!(refused.contains(part), "{part}: {refused}");
    }
    let refused = large.description.provable().expect_err("too large").to_string();
    assert!(refused.starts_with("loop: 10008 states"), "{refused}");
}
