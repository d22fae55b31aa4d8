//! Which loops are flown in sets, and of which of them one side stands for both.

use fspid_core::{
    AntiWindup, ControllerSetting, DeadZone, Derivative, Fspid, GainCoupling, Gains, Limits, Pid,
    PidConfig, ReferenceModel, SecondInput, SelfTuner, SetCentres, SetpointWeights, TunerSettings,
};
use fspid_fuzzy::{Defuzzifier, Network, NumberTable, OutOfRange, RuleTable, Supervisor};
use fspid_lti::Matrix;
use fspid_sim::actuator::{Actuator, Lag};
use fspid_sim::loop_model::Sensing;

use super::navion::{GAINS, NUMERATOR, navion};
use super::*;
use crate::certificate::Claim;
use crate::scope::Range;
use crate::solve::never;

const SCALE: Gains<f64> = Gains { kp: 0.02, ki: 0.01, kd: 0.005 };
const LEAKS: Law<f64> = Law::Accumulating { leakage_per_s: 0.5 };

fn config() -> PidConfig<f64> {
    PidConfig { derivative: Derivative { filter_s: 0.05 }, ..PidConfig::sampled_every(0.02) }
}

fn limits(least: f64, most: f64) -> Limits<f64> {
    Limits::new(ControllerSetting::OutputLimits, least, most).expect("allowed")
}

fn servo() -> Actuator {
    Actuator::new(Lag::first_order(0.1).expect("allowed"))
}

/// The Navion with a PID, both within the same limits either way.
pub(in crate::steps) fn limited() -> LoopDescription {
    let servo = servo()
        .with_command_limits(-0.35, 0.35)
        .and_then(|servo| servo.with_travel(-0.4, 0.4))
        .and_then(|servo| servo.with_rate_limit(0.35));
    let anti_windup = AntiWindup::Clamping(limits(-0.3, 0.3));
    let config = PidConfig { limits: Some(limits(-0.35, 0.35)), anti_windup, ..config() };
    navion(servo.expect("allowed"), fixed(config))
}

fn fixed(config: PidConfig<f64>) -> Controller {
    Controller::Fixed(Pid::new(GAINS, config).expect("allowed"))
}

fn of(controller: Controller) -> LoopDescription {
    LoopDescription { controller, ..limited() }
}

/// The same within limits of its servo alone, further up than down or the other way round.
pub(in crate::steps) fn uneven(mirrored: bool) -> LoopDescription {
    let [least, most] = if mirrored { [-0.35, 0.25] } else { [-0.25, 0.35] };
    let servo = servo().with_command_limits(least, most).expect("allowed");
    LoopDescription { actuator: servo, controller: fixed(config()), ..limited() }
}

/// One whose pitch rate jumps with the elevator, and is seen.
pub(in crate::steps) fn jumping() -> LoopDescription {
    let damped =
        fixed(PidConfig { rate_gain_s: 0.1, limits: Some(limits(-0.35, 0.35)), ..config() });
    LoopDescription { numerator: vec![-0.1, -11.01, -22.6, -1.31], ..of(damped) }
}

/// A certificate that nobody has proved.
pub(in crate::steps) fn claimed(description: LoopDescription, range: Range) -> Certificate {
    let form = Matrix::identity(description.states());
    Certificate {
        description,
        output_factor: 1.0,
        divisions: 4,
        range,
        left_out: Vec::new(),
        claim: Claim::CommonQuadratic { form, rate: 0.99 },
        level: None,
        steps: None,
        commanded: None,
        family: None,
        disturbances: Vec::new(),
        nonlinear: None,
    }
}

/// Rules that conclude labels, each gain rising with the error.
fn rising() -> Supervisor<f64> {
    let rows = ["NB", "NM", "NS", "ZO", "PS", "PM", "PB"].map(|label| [label; 7].join(" "));
    let table = RuleTable::parse([&*rows.join("\n"); 3]).expect("a table");
    Supervisor::new(&table, 5.0, Defuzzifier::Exact, OutOfRange::Clamp).expect("allowed")
}

/// Rules that conclude numbers: for each gain those of a place from -3 to 3 along error and change.
fn numbers(number: impl Fn(usize, i32, i32) -> f64) -> Supervisor<f64> {
    let grid = |output: usize| {
        let at = |row: usize, column: usize| {
            let [row, column] = [row, column].map(|place| i32::try_from(place).expect("small") - 3);
            number(output, row, column)
        };
        core::array::from_fn(|row| core::array::from_fn(|column| at(row, column)))
    };
    let table = NumberTable::new([0, 1, 2].map(grid)).expect("finite");
    Supervisor::of_numbers(&table, 10.0, OutOfRange::Clamp).expect("allowed")
}

/// The same for both sides.
fn even(_: usize, row: i32, column: i32) -> f64 {
    f64::from(row * row + row * column) / 4.0
}

fn network() -> Supervisor<f64> {
    let rows = [0.5, -0.3, 1.0, 0.7, -0.2, 0.4].map(|weight| [weight; 8]);
    Supervisor::of_network(&Network::new(rows).expect("allowed"), 5.0, OutOfRange::Clamp)
        .expect("allowed")
}

fn settings(law: Law<f64>) -> TunerSettings<f64> {
    TunerSettings { output_scale: SCALE, law, ..TunerSettings::literal() }
}

fn tuner_of(supervisor: Supervisor<f64>, settings: TunerSettings<f64>) -> SelfTuner<f64> {
    SelfTuner::new(GAINS, supervisor, settings).expect("allowed")
}

fn tuned(
    supervisor: Supervisor<f64>,
    settings: TunerSettings<f64>,
    config: PidConfig<f64>,
) -> Fspid<f64> {
    Fspid::new(tuner_of(supervisor, settings), config).expect("allowed")
}

fn self_tuning(supervisor: Supervisor<f64>, law: Law<f64>) -> Controller {
    Controller::SelfTuning(tuned(supervisor, settings(law), config()))
}

#[test]
fn one_side_stands_for_both_where_every_limit_is_the_same_either_way() {
    let good = limited();
    assert!(is_odd(&good));
    let plain = PidConfig { anti_windup: AntiWindup::None, ..config() };
    let [lower, upper] = [(-0.3, 0.35), (-0.35, 0.3)].map(|(least, most)| limits(least, most));
    for uneven in [lower, upper] {
        let output = PidConfig { limits: Some(uneven), ..plain };
        assert!(!is_odd(&of(fixed(output))), "output {uneven:?}");
        let clamped = PidConfig { anti_windup: AntiWindup::Clamping(uneven), ..plain };
        assert!(!is_odd(&of(fixed(clamped))), "integral {uneven:?}");
        let (least, most) = (uneven.lower(), uneven.upper());
        for servo in [servo().with_command_limits(least, most), servo().with_travel(least, most)] {
            let actuator = servo.expect("allowed");
            let unevenly = LoopDescription { actuator, controller: fixed(plain), ..good.clone() };
            assert!(!is_odd(&unevenly), "{actuator:?}");
        }
    }
}

#[test]
fn one_side_stands_for_both_where_gains_answer_both_alike() {
    let odd = |supervisor| is_odd(&of(self_tuning(supervisor, LEAKS)));
    assert!(odd(network()));
    assert!(odd(numbers(even)));
    // Labels are not asked: both sides are flown.
    assert!(!odd(rising()));
    // A zero is a zero, whatever its sign.
    assert!(odd(numbers(|_, row, _| if row > 0 { -0.0 } else { 0.0 })));
    for gain in 0..3 {
        let with = |by: f64, [at_row, at_column]: [i32; 2]| {
            odd(numbers(move |output, row, column| {
                let is_there = output == gain && row == at_row && column == at_column;
                even(output, row, column) + if is_there { by } else { 0.0 }
            }))
        };
        assert!(!with(1e-9, [1, 2]) && !with(-1.0, [-3, 0]), "{gain}");
        assert!(with(1.0, [0, 0]), "{gain}: the middle is its own mirror image");
        // All of one sign, so that the sizes alone tell.
        assert!(!odd(numbers(|output, row, _| if output == gain {
            4.0 + f64::from(row)
        } else {
            0.0
        })));
    }
}

#[test]
fn gains_are_elsewhere_where_they_move_and_an_error_stays() {
    let moves = of(self_tuning(numbers(even), LEAKS));
    let rest = |error_rad: f64| Rest { error_rad, ..Rest::NOTHING };
    assert!(!is_elsewhere(&moves, &rest(0.0)));
    for error_rad in [1e-12, 0.1, f64::INFINITY, f64::NAN] {
        assert!(is_elsewhere(&moves, &rest(error_rad)), "{error_rad}");
        assert!(!is_elsewhere(&limited(), &rest(error_rad)), "{error_rad}");
    }
}

#[test]
fn of_gains_that_jump_the_plain_tuner_is_flown() {
    let plain = settings(Law::Memoryless);
    let flown = |supervisor, settings| not_flown(&tuned(supervisor, settings, config()));
    assert_eq!(flown(rising(), plain), None);
    let model = ReferenceModel { bandwidth_rad_s: 1.0, damping: 1.0 };
    let mut uneven = plain;
    uneven.input_sets.error = Some(SetCentres::new(0.2, 0.6).expect("allowed"));
    let others = [
        (network(), plain),
        (numbers(even), plain),
        (rising(), TunerSettings { second_input: SecondInput::Rate, ..plain }),
        (rising(), TunerSettings { second_input: SecondInput::ModelError(model), ..plain }),
        (rising(), TunerSettings { gain_coupling: rate_follows(), ..plain }),
        (rising(), uneven),
    ];
    for (supervisor, settings) in others {
        let why = flown(supervisor, settings).expect("not flown");
        assert!(why.contains("gains that jump"), "{why}");
    }
}

fn rate_follows() -> GainCoupling<f64> {
    GainCoupling { rate_gain: 0.5, ..GainCoupling::NONE }
}

#[test]
fn of_gains_that_remember_those_that_leak_and_hold_no_set_point_are_flown() {
    let plain = settings(LEAKS);
    let flown = |supervisor, settings| not_flown(&tuned(supervisor, settings, config()));
    assert_eq!(flown(numbers(even), plain), None);
    assert_eq!(flown(network(), plain), None);
    let zone = Some(DeadZone { error_rad: 0.01, change_rad: 0.01 });
    let others = [
        (rising(), plain),
        (numbers(even), settings(Law::Accumulating { leakage_per_s: 0.0 })),
        (numbers(even), TunerSettings { second_input: SecondInput::Rate, ..plain }),
        (numbers(even), TunerSettings { dead_zone: zone, ..plain }),
    ];
    for (supervisor, settings) in others {
        let why = flown(supervisor, settings).expect("not flown");
        assert!(why.contains("flown in sets where they leak"), "{why}");
    }
    // What holds a set-point moves with the gains by either alone.
    let setpoint_weights = SetpointWeights { proportional: 0.5, derivative: 1.0 };
    let weighted = PidConfig { setpoint_weights, ..config() };
    let gain_coupling = GainCoupling { setpoint_weight: 0.1, ..GainCoupling::NONE };
    let follows = TunerSettings { gain_coupling, ..plain };
    for fspid in [tuned(numbers(even), plain, weighted), tuned(numbers(even), follows, config())] {
        let why = not_flown(&fspid).expect("not flown");
        assert!(why.contains("move what holds a set-point"), "{why}");
    }
    // The same reasons are those of the loop.
    let labels = of(self_tuning(rising(), LEAKS));
    assert!(not_covered(&labels).is_some() && not_covered(&limited()).is_none());
}

/// A pitch angle that is two integrals behind the elevator, or one alone, and a rate that is seen or not.
fn seeing(numerator: &[f64], controller: Controller) -> LoopModel<Interval> {
    let description = LoopDescription { numerator: numerator.to_vec(), ..of(controller) };
    description.enclosed().expect("enclosed")
}

#[test]
fn a_load_is_seen_at_once_by_a_rate_that_is_used_of_a_plant_whose_rate_jumps() {
    let smooth: &[f64] = &NUMERATOR;
    let jumps: &[f64] = &[-0.1, -11.01, -22.6, -1.31];
    let seen = |numerator, controller| sees_loads_at_once(&seeing(numerator, controller), 0.01);
    for rate_gain_s in [0.1, -0.1] {
        let damped = fixed(PidConfig { rate_gain_s, ..config() });
        assert!(seen(jumps, damped) && !seen(smooth, damped));
        assert!(!sees_loads_at_once(&seeing(jumps, damped), 0.0));
    }
    assert!(!seen(jumps, fixed(config())) && !seen(smooth, fixed(config())));
    // A rate gain that is zero at the nominal gains, and follows them.
    let follows = TunerSettings { gain_coupling: rate_follows(), ..settings(LEAKS) };
    let follows = Controller::SelfTuning(tuned(numbers(even), follows, config()));
    assert!(seen(jumps, follows) && !seen(smooth, follows));
}

/// What keeps flights of a certificate from being believed, with a load at the elevator.
fn refused(certificate: &Certificate, load_rad: f64) -> Option<&'static str> {
    let description = &certificate.description;
    let model = description.enclosed().expect("enclosed");
    let set = all_gains(&description.controller);
    Checked { certificate, model: &model, set: &set, stops: never }.allowed(load_rad).err()
}

#[test]
fn flights_are_believed_of_loops_that_are_flown_in_sets_at_their_own_scale_and_rest() {
    let range = Range { setpoint_rad: 0.01, load_rad: 0.001 };
    let good = claimed(limited(), range);
    assert_eq!(refused(&good, 0.001), None);
    let told = |certificate: &Certificate| refused(certificate, 0.001).unwrap_or("nothing");
    let pitch = Sensing { resolution: 1e-4, ..Sensing::DIRECT };
    let coarse = LoopDescription { pitch, ..limited() };
    assert!(told(&claimed(coarse, range)).contains("resolves in steps"));
    for output_factor in [0.5, 1.0_f64.next_up()] {
        let scaled = Certificate { output_factor, ..good.clone() };
        assert!(told(&scaled).contains("another output scale"));
    }
    let jumps = claimed(jumping(), range);
    assert!(told(&jumps).contains("shows a load at once"));
    assert_eq!(refused(&jumps, 0.0), None);
    let far = Certificate { range: Range { setpoint_rad: 10.0, ..range }, ..good };
    assert!(told(&far).contains("rest is not known"));
}

#[test]
fn where_gains_move_and_an_error_stays_no_flight_is_believed() {
    let without =
        TunerSettings { output_scale: Gains { ki: 0.0, ..SCALE }, ..settings(Law::Memoryless) };
    let nominal = Gains { ki: 0.0, ..GAINS };
    let tuner = SelfTuner::new(nominal, rising(), without).expect("allowed");
    let fspid = Fspid::new(tuner, config()).expect("allowed");
    let leaves = of(Controller::SelfTuning(fspid));
    let told = |range| refused(&claimed(leaves.clone(), range), 0.0);
    assert_eq!(told(Range::REST), None);
    let why = told(Range { setpoint_rad: 0.01, load_rad: 0.0 }).expect("refused");
    assert!(why.contains("an error stays"), "{why}");
}

#[test]
fn no_flight_is_looked_for_of_a_loop_that_is_not_flown_in_sets() {
    let range = Range { setpoint_rad: 0.01, load_rad: 0.0 };
    let looked_for = |description: LoopDescription| {
        let model = description.enclosed().expect("enclosed");
        let set = all_gains(&description.controller);
        Search::of(&claimed(description, range), &model, [&set, &set], never).is_some()
    };
    assert!(looked_for(limited()));
    let pitch = Sensing { resolution: 1e-4, ..Sensing::DIRECT };
    assert!(!looked_for(LoopDescription { pitch, ..limited() }));
    let free = LoopDescription { actuator: servo(), ..of(fixed(config())) };
    assert!(!looked_for(free));
}

/// A loop with its form near rest, to be flown by tests beside this one.
pub(in crate::steps) struct Found {
    pub(in crate::steps) certificate: Certificate,
    pub(in crate::steps) model: LoopModel<Interval>,
    pub(in crate::steps) set: GainSet,
    terminal: Terminal,
}

impl Found {
    pub(in crate::steps) fn of(description: LoopDescription, range: Range) -> Self {
        let model = description.enclosed().expect("enclosed");
        let set = all_gains(&description.controller);
        let bare = claimed(description, range);
        let found = Search::of(&bare, &model, [&set, &set], never).expect("a form near rest");
        let terminal = found.terminal.clone();
        let claim = Claim::CommonQuadratic { form: terminal.form.clone(), rate: terminal.rate };
        Self { certificate: Certificate { claim, ..bare }, model, set, terminal }
    }

    pub(in crate::steps) fn search(&self) -> Search<'_> {
        let Self { certificate, model, set, terminal } = self;
        Search { certificate, model, set, terminal: terminal.clone(), system: None, stops: never }
    }

    pub(in crate::steps) fn flights(&self) -> work::Flights<'_> {
        let Self { certificate, model, set, terminal } = self;
        work::Flights::of(certificate, model, set, terminal, None).expect("enclosed")
    }

    pub(in crate::steps) fn checked(&self) -> Checked<'_> {
        let Self { certificate, model, set, .. } = self;
        Checked { certificate, model, set, stops: never }
    }
}
