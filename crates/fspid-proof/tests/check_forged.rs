//! Certificates whose claim does not fit their loop, as nobody writes them who has found one: each is refused in words.

use fspid_core::{
    ControllerSetting, Fspid, Gains, Law, Limits, PidConfig, ReferenceModel, SecondInput,
    SelfTuner, SetpointWeights, TunerSettings,
};
use fspid_lti::Matrix;
use fspid_proof::{
    Asked, BoundedRate, Certificate, Claim, DisturbanceBound, Effort, Extent, LoopDescription,
    Quantity, Range, Steps, Terminal, Verdict, Way, bound_disturbances, certify,
};
use fspid_sim::Controller;

use crate::certify::{config, fixed, proved, quick, tuned};
use crate::paper_loop::{NOMINAL, loop_of};

const SCALE: Gains<f64> = Gains { kp: 0.09, ki: 0.02, kd: 0.045 };

fn good() -> Certificate {
    proved(&loop_of(tuned(SCALE, Law::Memoryless)))
}

/// The loop at a gain at which it grows.
fn growing() -> Certificate {
    let unstable = loop_of(fixed(Gains { kp: 10.0, ki: 0.0, kd: 0.0 }));
    let outcome = certify(&unstable, &Asked::rest(), &quick()).expect("provable");
    let Verdict::Refuted(grows, _) = outcome.verdict else { panic!("{outcome:?}") };
    grows
}

fn form_of(certificate: &Certificate) -> Matrix {
    let Claim::CommonQuadratic { form, .. } = &certificate.claim else {
        panic!("{:?}", certificate.claim)
    };
    form.clone()
}

fn tied_to_the_error(certificate: &Certificate) -> Certificate {
    let form = form_of(certificate);
    let claim = Claim::SProcedure { form, rate: 1.0, multipliers: vec![0.0; 8] };
    Certificate { claim, level: None, steps: None, ..certificate.clone() }
}

/// One whose form moves with kp by a hundred thousandth of itself, for a kp that moves slowly.
fn at_bounded_rate(certificate: &Certificate, ends: [[f64; 2]; 3]) -> Certificate {
    let form = form_of(certificate);
    let none = Matrix::zeros(form.rows(), form.columns());
    let forms = [form.clone(), form.scaled(1e-5), none.clone(), none];
    let changes = [0.01, 2.0, 2.0];
    let claim = Claim::BoundedRate(BoundedRate { ends, changes, forms, rate: 1.0 });
    Certificate { claim, level: None, steps: None, ..certificate.clone() }
}

fn refused(certificate: &Certificate) -> String {
    certificate.check().expect_err("forged").to_string()
}

#[test]
fn gains_that_no_error_of_the_moment_makes_are_tied_to_none() {
    let of_fixed = proved(&loop_of(fixed(NOMINAL)));
    let told = refused(&tied_to_the_error(&of_fixed));
    assert!(told.contains("fixed gains are tied to nothing"), "{told}");

    let slow = Gains { kp: 0.01, ki: 0.001, kd: 0.005 };
    let law = Law::Accumulating { leakage_per_s: 0.5 };
    let remembers = loop_of(tuned(slow, law));
    let other = Certificate { description: remembers, ..tied_to_the_error(&good()) };
    let told = refused(&other);
    assert!(told.contains("gains that remember are not tied"), "{told}");
}

#[test]
fn gains_that_see_a_reference_model_are_not_tied_to_the_change_of_the_error() {
    let Controller::SelfTuning(fspid) = tuned(SCALE, Law::Memoryless) else { panic!("tuned") };
    let model = ReferenceModel { bandwidth_rad_s: 1.0, damping: 1.0 };
    let settings =
        TunerSettings { second_input: SecondInput::ModelError(model), ..*fspid.tuner().settings() };
    let tuner = SelfTuner::new(NOMINAL, *fspid.tuner().supervisor(), settings).expect("allowed");
    let seen = loop_of(Controller::SelfTuning(Fspid::new(tuner, config()).expect("allowed")));
    let told = refused(&tied_to_the_error(&Certificate { description: seen, ..good() }));
    assert!(told.contains("another input than the change"), "{told}");
}

#[test]
fn a_box_of_gains_that_move_holds_every_gain_of_the_law() {
    let scale = Gains { kp: 0.09, ki: 0.0, kd: 0.0 };
    let good = proved(&loop_of(tuned(scale, Law::Memoryless)));
    let ends = good.check().expect("it holds").bounds.map(|it| [it.lower(), it.upper()]);
    at_bounded_rate(&good, ends).check().expect("it holds of a box with all gains");
    for gain in 0..3 {
        for side in 0..2 {
            let mut narrow = ends;
            // Of a gain that stands still the box is a point.
            let inwards = [1.0, -1.0][side] * 1e-3;
            narrow[gain] = if gain == 0 { ends[gain] } else { ends[gain].map(|it| it + inwards) };
            narrow[gain][side] = ends[gain][side] + inwards;
            let told = refused(&at_bounded_rate(&good, narrow));
            assert!(told.contains("does not hold every gain"), "{gain} {side}: {told}");
        }
        let mut endless = ends;
        endless[gain][1] = f64::INFINITY;
        let told = refused(&at_bounded_rate(&good, endless));
        assert!(told.contains("two finite numbers in order"), "{gain}: {told}");
    }
    let [[lower, upper], ki, kd] = ends;
    let told = refused(&at_bounded_rate(&good, [[upper, lower], ki, kd]));
    assert!(told.contains("two finite numbers in order"), "{told}");
}

#[test]
fn growth_is_at_least_one_and_bounds_no_disturbance_and_no_step() {
    let grows = growing();
    let Claim::FrozenGrowth { input, factor, form, direction } = grows.claim.clone() else {
        panic!("{:?}", grows.claim)
    };
    assert!(factor > 1.0);
    for factor in [1.0 - 1e-12, 0.5, 0.0, f64::INFINITY, f64::NAN] {
        let claim =
            Claim::FrozenGrowth { input, factor, form: form.clone(), direction: direction.clone() };
        let told = refused(&Certificate { claim, ..grows.clone() });
        assert!(told.contains("factor of the growth is below 1"), "{factor}: {told}");
    }
    let bound = DisturbanceBound {
        way: Way::Elevator,
        quantity: Quantity::Pitch,
        extent: Extent::Energy,
        decay: 1.0,
        gain: 1.0,
        form: form.clone(),
        by_gain: None,
    };
    let told = refused(&Certificate { disturbances: vec![bound], ..grows.clone() });
    assert!(told.contains("bounded are those of a loop that is stable"), "{told}");
}

#[test]
fn forms_have_the_size_of_the_loop() {
    let good = good();
    let form = form_of(&good);
    let size = form.rows();
    let small = Matrix::identity(size - 1);
    let claim = Claim::CommonQuadratic { form: small.clone(), rate: 1.0 };
    let told = refused(&Certificate { claim, ..good.clone() });
    assert!(told.contains("claim.form"), "{told}");
    let ends = good.check().expect("it holds").bounds.map(|it| [it.lower(), it.upper()]);
    let moving = at_bounded_rate(&good, ends);
    let Claim::BoundedRate(claim) = &moving.claim else { panic!("just made") };
    for place in 0..4 {
        let mut claim = claim.clone();
        claim.forms[place] = small.clone();
        let told = refused(&Certificate { claim: Claim::BoundedRate(claim), ..moving.clone() });
        assert!(told.contains("forms"), "{place}: {told}");
    }
}

#[test]
fn a_rate_is_above_0_and_at_most_1() {
    let good = proved(&loop_of(fixed(NOMINAL)));
    let form = form_of(&good);
    let at = |rate: f64| {
        let claim = Claim::CommonQuadratic { form: form.clone(), rate };
        Certificate { claim, ..good.clone() }
    };
    at(1.0).check().expect("a form that falls at all");
    for rate in [0.0, -0.5, 1.0 + 1e-12, f64::INFINITY, f64::NAN] {
        let told = refused(&at(rate));
        assert!(told.contains("the rate is not above 0 and at most 1"), "{rate}: {told}");
    }
    let told = refused(&Certificate {
        claim: Claim::CommonQuadratic { form: form.scaled(-1.0), rate: 1.0 },
        ..good
    });
    assert!(told.contains("the Lyapunov matrix is not positive definite"), "{told}");
}

#[test]
fn nothing_is_proved_for_somebody_who_does_not_wait() {
    let told = good().check_until(|| true).expect_err("stopped").to_string();
    assert!(told.contains("nobody wants the answer any more"), "{told}");
}

/// The Navion with limits of its output, and of a servo's travel and rate, up to small steps.
fn limited() -> Certificate {
    crate::steps::proved(20.0, 0.3).0
}

/// One that the form is positive, one that it falls at each corner of the gains, one for each limit there.
#[test]
fn inequalities_are_counted() {
    let count = |certificate: &Certificate| certificate.check().expect("it holds").inequalities;
    assert_eq!(count(&proved(&loop_of(fixed(NOMINAL)))), 2);
    assert_eq!(count(&limited()), 5, "output, command and rate of the servo have limits");
    let grows = growing();
    assert_eq!(count(&grows), 2, "that the form falls, and that it is above zero along a motion");

    let good = good();
    let tied = tied_to_the_error(&good);
    let [of_all, of_cones] = [count(&good), count(&tied)];
    // A cell lies in one cone, or in those on whose border it is: each of its corners is then asked in each.
    assert!(of_cones > of_all && of_cones < 8 * of_all, "{of_all} {of_cones}");
}

#[test]
fn the_end_of_a_step_is_a_form_that_falls_within_its_limits_in_a_loop_that_is_stable() {
    let good = limited();
    let steps = good.steps.clone().expect("steps are proved");
    let rechecked = good.check().expect("it holds");
    assert!(rechecked.stepped.is_some() && rechecked.ended.is_some());
    let with = |change: &dyn Fn(&mut Terminal)| {
        let mut terminal = steps.terminal.clone();
        change(&mut terminal);
        refused(&Certificate { steps: Some(Steps { terminal, ..steps.clone() }), ..good.clone() })
    };
    let still = with(&|it| it.rate = 1.0);
    assert!(still.contains("near rest something remains"), "{still}");
    for rate in [0.0, 1.0 + 1e-9, f64::NAN] {
        let told = with(&|it| it.rate = rate);
        assert!(told.contains("the rate is not above 0 and at most 1"), "{rate}: {told}");
    }
    let wide = with(&|it| it.level *= 1e4);
    assert!(wide.contains("on the ellipsoid"), "{wide}");
    let turned = with(&|it| it.form = it.form.scaled(-1.0));
    assert!(turned.contains("not positive definite"), "{turned}");

    let grows = growing();
    let size = grows.description.states();
    let terminal = Terminal { form: Matrix::identity(size), ..steps.terminal.clone() };
    let told = refused(&Certificate { steps: Some(Steps { terminal, ..steps }), ..grows });
    assert!(told.contains("not claimed to be stable"), "{told}");
}

/// Without an integral an error stays at a set-point; with a weight below 1 moving gains make something of what holds it.
#[test]
fn where_an_error_or_a_command_stays_gains_are_tied_to_nothing_and_no_step_ends() {
    let Controller::SelfTuning(fspid) = tuned(SCALE, Law::Memoryless) else { panic!("tuned") };
    let with = |nominal: Gains<f64>, scale: Gains<f64>, config: PidConfig<f64>| {
        let settings = TunerSettings { output_scale: scale, ..*fspid.tuner().settings() };
        let tuner = SelfTuner::new(nominal, *fspid.tuner().supervisor(), settings);
        loop_of(Controller::SelfTuning(
            Fspid::new(tuner.expect("allowed"), config).expect("allowed"),
        ))
    };
    let asked = Asked::within(Range { setpoint_rad: 0.02, load_rad: 0.0 });
    let coarse = Effort { divisions: 8, largest_factor: 1.0, ..quick() };
    let proved = |description: &LoopDescription| match certify(description, &asked, &coarse)
        .expect("provable")
        .verdict
    {
        Verdict::Proved(certificate, _) => certificate,
        other => panic!("{other:?}"),
    };
    let none = Gains { ki: 0.0, ..SCALE };
    let leaves = proved(&with(Gains { ki: 0.0, ..NOMINAL }, none, config()));
    assert!(leaves.check().expect("it holds").rest_error_rad > 0.0);
    let told = refused(&tied_to_the_error(&leaves));
    assert!(told.contains("where an error stays, gains are not tied"), "{told}");

    let limits = Limits::new(ControllerSetting::OutputLimits, -0.35, 0.35).expect("allowed");
    let setpoint_weights = SetpointWeights { proportional: 0.5, derivative: 1.0 };
    let config = PidConfig { limits: Some(limits), setpoint_weights, ..config() };
    let holds = proved(&with(NOMINAL, Gains { kp: SCALE.kp, ..Gains::ZERO }, config));
    let form = form_of(&holds);
    let terminal = Terminal { form, rate: 0.999_999, level: 1e-12, gains: None };
    let steps =
        Steps { setpoint_rad: 0.001, load_rad: 0.0, terminal, ends: vec![-0.001, 0.001], loads: 1 };
    let told = refused(&Certificate { steps: Some(steps), ..holds });
    assert!(told.contains("near rest something remains"), "{told}");
}

#[test]
fn bounds_of_disturbances_hold_for_their_measure_their_form_and_what_can_be_told() {
    let bare = Certificate { steps: None, commanded: None, ..limited() };
    let (good, rechecked) = bound_disturbances(&bare, &[Way::Elevator], &quick()).expect("bounded");
    let of = |quantity: Quantity, extent: Extent| {
        let mut bounds = good.disturbances.iter().enumerate();
        let found = bounds.find(|(_, it)| (it.quantity, it.extent) == (quantity, extent));
        found.map(|(place, _)| place).expect("every quantity in both measures")
    };
    // How far a share of the limits is reached is told with the others, and the best form tells it.
    let told = &rechecked.disturbed;
    assert_eq!(told.len(), 4, "{told:?}");
    assert!(told.iter().all(|it| it.quantity != Quantity::Limits && it.at_servo));
    for extent in Extent::ALL {
        let up_to: Vec<Option<f64>> =
            told.iter().filter(|it| it.extent == extent).map(|it| it.unlimited_up_to).collect();
        assert!(up_to.len() == 2 && up_to[0].is_some() && up_to[0] == up_to[1], "{up_to:?}");
    }
    let energy =
        told.iter().find(|it| it.extent == Extent::Energy && it.quantity == Quantity::Pitch);
    let gain = good.disturbances[of(Quantity::Pitch, Extent::Energy)].gain;
    let per_unit = energy.expect("told").per_unit;
    assert!((per_unit - gain.sqrt()).abs() <= 1e-12 * per_unit, "{per_unit} {gain}");

    let with = |place: usize, change: &dyn Fn(&mut DisturbanceBound)| {
        let mut changed = good.clone();
        change(&mut changed.disturbances[place]);
        changed.check()
    };
    let refused = |place: usize, change: &dyn Fn(&mut DisturbanceBound)| {
        with(place, change).expect_err("forged").to_string()
    };
    let [of_energy, of_peak] =
        Extent::ALL.map(|extent| Quantity::ALL.map(|quantity| of(quantity, extent)));
    for place in of_energy {
        let told = refused(place, &|it| it.decay = 0.999);
        assert!(told.contains("the decay is 1 of an energy"), "{told}");
    }
    for place in of_peak {
        for decay in [1.0, 1.5, f64::NAN] {
            let told = refused(place, &|it| it.decay = decay);
            assert!(told.contains("below it of a peak"), "{decay}: {told}");
        }
    }
    for place in of_energy.into_iter().chain(of_peak) {
        let told = refused(place, &|it| it.gain *= 0.25);
        assert!(told.contains("could not be shown") || told.contains("not positive"), "{told}");
        let moves = refused(place, &|it| it.by_gain = Some([0; 3].map(|_| it.form.clone())));
        assert!(moves.contains("where the claim is about their rate"), "{moves}");
        with(place, &|it| it.gain *= 1.0 + 1e-6).expect("a larger gain is no better");
    }

    let unlimited = proved(&loop_of(fixed(NOMINAL)));
    let of_limits = good.disturbances[of(Quantity::Limits, Extent::Peak)].clone();
    let form = Matrix::identity(unlimited.description.states());
    let disturbances = vec![DisturbanceBound { form, ..of_limits }];
    let told =
        Certificate { disturbances, ..unlimited }.check().expect_err("no limits").to_string();
    assert!(told.contains("there are no limits"), "{told}");
}
