//! What the gains of an outer loop add, against the controller that flies, and where nobody can tell.

use fspid_core::{
    Fspid, GainCoupling, Gains, InputScale, IntegralForm, Law, PidConfig, ReferenceModel, Sample,
    SecondInput, SelfTuner, State, TunerSettings,
};

use super::super::settled;
use super::super::slopes;
use super::super::tests::{BESIDE, DT_S, Dice, LEAKAGE_PER_S, Moved, controller, supervisor};
use super::Rest;

const MODEL: ReferenceModel<f64> = ReferenceModel { bandwidth_rad_s: 1.5, damping: 0.8 };

/// A self-tuner of an outer loop, and what it holds.
#[derive(Clone, Copy, Debug)]
struct Case {
    weight: f64,
    coupling: f64,
    feedforward: f64,
    integral: IntegralForm,
    /// Nominal gain of the integral, and what the rules add to it.
    ki: [f64; 2],
    law: Law<f64>,
    second_input: SecondInput<f64>,
    target: f64,
    command: f64,
}

/// Everything that a proportional term with this weight holds is in the integral.
const PLAIN: Case = Case {
    weight: 1.0,
    coupling: 0.0,
    feedforward: 0.0,
    integral: IntegralForm::Bumpless,
    ki: [0.4, 0.1],
    law: Law::Memoryless,
    second_input: SecondInput::Change,
    target: 2.0,
    command: 0.3,
};
const WEIGHED: Case = Case { weight: 0.7, ..PLAIN };
const LITERAL: Case = Case { integral: IntegralForm::Literal, ..PLAIN };
/// Its gains gather without end.
const GATHERS: Law<f64> = Law::Accumulating { leakage_per_s: 0.0 };
const LEAKS: Law<f64> = Law::Accumulating { leakage_per_s: LEAKAGE_PER_S };

impl Case {
    fn fspid(&self) -> Fspid<f64> {
        let [ki, by_ki] = self.ki;
        let settings = TunerSettings {
            law: self.law,
            second_input: self.second_input,
            input_scale: InputScale { error_per_rad: 20.0, change_per_rad: 10.0 },
            output_scale: Gains { kp: 0.2, ki: by_ki, kd: 0.0 },
            gain_coupling: GainCoupling { setpoint_weight: self.coupling, rate_gain: 0.0 },
            ..TunerSettings::literal()
        };
        let mut config = PidConfig::sampled_every(DT_S);
        config.setpoint_weights.proportional = self.weight;
        config.feedforward = self.feedforward;
        config.integral = self.integral;
        let nominal = Gains { kp: 1.2, ki, kd: 0.0 };
        let tuner = SelfTuner::new(nominal, supervisor(), settings).expect("allowed");
        Fspid::new(tuner, config).expect("allowed")
    }

    fn rest(&self) -> Option<Rest> {
        let fspid = self.fspid();
        Rest::of_outer_loop(&fspid, fspid.tuner().gains_at_rest(), [self.target, self.command])
    }

    /// What is known of it.
    fn known(&self) -> Known {
        let gains = self.fspid().tuner().gains_at_rest();
        match self.rest() {
            None => Known::Nothing,
            Some(rest) if rest.adds_nothing_to(gains) => Known::Still,
            Some(_) => Known::Moving,
        }
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Known {
    Nothing,
    /// No constant is multiplied by what moves.
    Still,
    Moving,
}

/// One sample beside rest, as in the pitch loop: there a part of the command is a constant and a gain that moves.
#[test]
fn a_held_target_adds_what_the_flown_controller_of_an_outer_loop_answers_beside_rest() {
    let mut dice = Dice(41);
    let mut compared = [0; 2];
    for round in 0..300 {
        let fspid = controller(&mut dice);
        let target = dice.between(-3.0, 3.0);
        let at_rest = Sample { setpoint_rad: target, measurement_rad: target, rate_rad_s: 0.0 };
        let mut state = State::new();
        // The reference model comes to rest, and so do gains that remember.
        for _ in 0..3000 {
            fspid.step(&mut state, at_rest);
        }
        state.integral = match fspid.config().integral {
            IntegralForm::Bumpless => dice.between(-1.0, 1.0),
            IntegralForm::Literal => dice.between(-20.0, 20.0),
        };
        let rested = fspid.step(&mut { state }, at_rest);
        let held = rested.command_rad;
        // Gains that gather come to more or less than what the rules add in a second.
        let gains = settled(&fspid).expect("they stand still");
        let apart = [gains.kp - rested.gains.kp, gains.ki - rested.gains.ki];
        assert!(apart.iter().all(|apart| apart.abs() < 1e-9), "{round}: {apart:?}");
        let rest = Rest::of_outer_loop(&fspid, gains, [target, held]);
        // Of a rate nobody knows what it is there.
        let second_input = fspid.tuner().settings().second_input;
        assert_eq!(rest.is_none(), second_input == SecondInput::Rate, "{round}");
        let Some(rest) = rest else { continue };
        assert_eq!(rest.sees_change(), second_input == SecondInput::Change);

        let [per_error, beside] = rest.seen_per_unit;
        let error = dice.between(-1.0, 1.0) * BESIDE / per_error.abs();
        let second = dice.between(-1.0, 1.0) * BESIDE / beside.abs();
        let is_change = rest.sees_change();
        let last_error = if is_change { error - second } else { 0.0 };
        if let Some(previous) = &mut state.previous {
            previous.error_rad = last_error;
        }
        let flown = fspid.step(&mut state, Sample { measurement_rad: target - error, ..at_rest });
        let seen = [per_error * error, beside * if is_change { second } else { error }];
        let side = rest.sides[rest.of_direction[slopes::direction(seen)]];
        let moved = Moved { error_rad: error, last_error_rad: last_error, rate_off_rad_s: 0.0 };
        let expected = moved.command_rad(&side, &fspid.config_at(gains));
        let found = flown.command_rad - held;
        // As of the pitch loop: sides whose slopes differ by 10⁻⁴ are one.
        let allowed = 2e-4 * (side.gains.kp.abs() * error.abs() + expected.abs()) + 5e-13;
        assert!((found - expected).abs() <= allowed, "{round}: {found} {expected} {side:?}");
        compared[usize::from(side.gathered.is_some())] += 1;
    }
    assert!(compared.iter().all(|count| *count > 50), "{compared:?}");
}

#[test]
fn gains_that_multiply_no_constant_of_what_is_held_add_nothing() {
    let gathers = |case: Case| Case { law: GATHERS, ..case };
    let rows = [
        (PLAIN, "all of the target is error"),
        (gathers(PLAIN), "the same, with gains that gather"),
        (gathers(Case { target: 0.0, ..WEIGHED }), "no target"),
        (gathers(Case { target: 1e-7, ..WEIGHED }), "a target of rounding"),
        (Case { second_input: SecondInput::Rate, target: 0.0, ..WEIGHED }, "no target, a rate"),
        (gathers(Case { command: 0.0, ..LITERAL }), "an integral that holds nothing"),
        (gathers(Case { feedforward: 0.15, ..LITERAL }), "the feedforward commands it all"),
        (gathers(Case { ki: [0.0; 2], command: 0.0, ..PLAIN }), "no integral, and none needed"),
        (Case { ki: [0.0; 2], target: 0.0, command: 0.0, ..WEIGHED }, "nothing at all"),
    ];
    for (case, why) in rows {
        assert_eq!(case.known(), Known::Still, "{why}");
    }
}

#[test]
fn gains_that_multiply_a_constant_of_what_is_held_are_known_or_nothing_is() {
    let rows = [
        (WEIGHED, "a weight of the target"),
        (Case { coupling: 0.5, ..PLAIN }, "a weight that follows the gain"),
        (LITERAL, "an integral"),
        (Case { target: 0.0, ..LITERAL }, "an integral without a target"),
        (Case { feedforward: 0.6, command: 0.0, ..LITERAL }, "one that takes back what is fed"),
    ];
    for (case, why) in rows {
        let leaks = Case { law: LEAKS, ..case };
        let sees = |second_input| Case { second_input, ..case };
        assert_eq!(case.known(), Known::Moving, "{why}");
        assert_eq!(leaks.known(), Known::Moving, "{why}");
        assert_eq!(sees(SecondInput::ModelError(MODEL)).known(), Known::Moving, "{why}");
        // With gains that gather without end, and a rate that is no rate of the error.
        assert_eq!(Case { law: GATHERS, ..case }.known(), Known::Nothing, "{why}");
        assert_eq!(sees(SecondInput::Rate).known(), Known::Nothing, "{why}");
    }
    // Without an integral an error stays where there is a command, or a part of the target that is none.
    let without = |case: Case| Case { ki: [0.0; 2], ..case };
    let rows = [
        without(PLAIN),
        without(WEIGHED),
        without(Case { command: 0.0, ..WEIGHED }),
        without(Case { target: 0.0, ..WEIGHED }),
    ];
    for case in rows {
        assert_eq!(case.known(), Known::Nothing, "{case:?}");
    }
}
