#![doc = include_str!("../README.md")]
//!
//! Not here: anything that flies; no crate depends on this one but in its tests.
//!
//! Each struct of settings is written out field by field, never with `..`: an option that is added to the
//! controller does not compile here until it is drawn, and then is drawn in all of these tests.

pub mod hostile;
mod systems;

pub use systems::{any_system, inputs_of};

use fspid_core::fuzzy::{Defuzzifier, Network, NumberTable, OutOfRange, Supervisor};
use fspid_core::{
    AntiWindup, Change, Controller, ControllerSetting, DeadZone, Derivative, ErrorSign, Fspid,
    GainCoupling, GainLimits, Gains, Guard, InputScale, InputSets, IntegralForm, Law, Limits, Pid,
    PidConfig, ReferenceModel, SecondInput, SelfTuner, SetCentres, SetpointWeights, TunerSettings,
};
use proptest::option;
use proptest::prelude::*;
use proptest::sample::select;

/// Sample period of every controller here, s.
pub const DT_S: f64 = 0.01;

/// What a group of flights side by side must share.
#[derive(Clone, Copy, Debug)]
pub struct Structure {
    integral: IntegralForm,
    anti_windup: AntiWindup<f64>,
    feeds_forward: bool,
    /// Of a self-tuning controller.
    tuner: Option<TunerStructure>,
}

/// What a supervisor is made of.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Conclusions {
    /// Rules that conclude labels.
    Labels,
    /// Rules that conclude numbers.
    Numbers,
    /// A network.
    Network,
}

#[derive(Clone, Copy, Debug)]
struct TunerStructure {
    second_input: SecondInput<f64>,
    law: Law<f64>,
    conclusions: Conclusions,
    defuzzifier: Defuzzifier,
    out_of_range: OutOfRange,
}

/// Any structure.
pub fn structure() -> impl Strategy<Value = Structure> {
    let integral = select(vec![IntegralForm::Bumpless, IntegralForm::Literal]);
    let feeds_forward = prop::bool::weighted(0.25);
    let tuner = option::weighted(0.8, tuner_structure());
    (integral, anti_windup(), feeds_forward, tuner).prop_map(
        |(integral, anti_windup, feeds_forward, tuner)| Structure {
            integral,
            anti_windup,
            feeds_forward,
            tuner,
        },
    )
}

fn tuner_structure() -> impl Strategy<Value = TunerStructure> {
    let defuzzifier = select(vec![Defuzzifier::Exact, Defuzzifier::Endpoints(101)]);
    let policy = select(OutOfRange::ALL.to_vec());
    let conclusions = prop_oneof![
        3 => Just(Conclusions::Labels),
        2 => Just(Conclusions::Numbers),
        2 => Just(Conclusions::Network),
    ];
    (second_input(), law(), conclusions, defuzzifier, policy).prop_map(
        |(second_input, law, conclusions, defuzzifier, out_of_range)| TunerStructure {
            second_input,
            law,
            conclusions,
            defuzzifier,
            out_of_range,
        },
    )
}

fn anti_windup() -> impl Strategy<Value = AntiWindup<f64>> {
    prop_oneof![
        Just(AntiWindup::None),
        limits(0.3).prop_map(AntiWindup::Clamping),
        Just(AntiWindup::Conditional),
        (DT_S..2.0).prop_map(|tracking_s| AntiWindup::BackCalculation { tracking_s }),
    ]
}

fn second_input() -> impl Strategy<Value = SecondInput<f64>> {
    prop_oneof![
        Just(SecondInput::Change),
        Just(SecondInput::Rate),
        (0.3..10.0, 0.3..1.5).prop_map(|(bandwidth_rad_s, damping)| {
            SecondInput::ModelError(ReferenceModel { bandwidth_rad_s, damping })
        }),
    ]
}

fn law() -> impl Strategy<Value = Law<f64>> {
    prop_oneof![
        Just(Law::Memoryless),
        (0.0..2.0).prop_map(|leakage_per_s| Law::Accumulating { leakage_per_s }),
    ]
}

/// One of the same kind, with numbers of its own.
fn like<T: std::fmt::Debug + 'static>(
    kind: T,
    any: impl Strategy<Value = T> + 'static,
) -> BoxedStrategy<T> {
    let kind = std::mem::discriminant(&kind);
    any.prop_filter("another kind", move |other| std::mem::discriminant(other) == kind).boxed()
}

/// Around 0, so that a controller at rest is not held by them.
fn limits(size: f64) -> impl Strategy<Value = Limits<f64>> {
    (0.1 * size..size, 0.1 * size..size).prop_map(|(below, above)| {
        Limits::new(ControllerSetting::OutputLimits, -below, above).expect("in order")
    })
}

/// Everything of a controller but its gains.
fn config(structure: Structure) -> impl Strategy<Value = PidConfig<f64>> {
    let weights = (0.0..1.0, 0.0..1.0)
        .prop_map(|(proportional, derivative)| SetpointWeights { proportional, derivative });
    let filter_s = prop_oneof![Just(0.0), 0.01..0.1];
    let derivative = filter_s.prop_map(|filter_s| Derivative { filter_s });
    let guard = prop_oneof![
        3 => Just(Guard::default()),
        1 => (0.5..2.0).prop_map(|limit_rad| Guard::new(limit_rad).expect("above zero")),
    ];
    let at_limits = matches!(
        structure.anti_windup,
        AntiWindup::Conditional | AntiWindup::BackCalculation { .. }
    );
    let limits = (limits(0.5), any::<bool>())
        .prop_map(move |(limits, limited)| (limited || at_limits).then_some(limits));
    let rate_gain_s = prop_oneof![Just(0.0), 0.0..0.5];
    let feedforward: BoxedStrategy<f64> = if structure.feeds_forward {
        prop_oneof![0.01..0.5, -0.5..-0.01].boxed()
    } else {
        Just(0.0).boxed()
    };
    let numbers = (rate_gain_s, weights, feedforward, derivative, guard);
    (numbers, like(structure.anti_windup, anti_windup()), limits, option::of(0.2..5.0)).prop_map(
        move |(numbers, anti_windup, limits, slew)| {
            let (rate_gain_s, setpoint_weights, feedforward, derivative, guard) = numbers;
            PidConfig {
                dt_s: DT_S,
                rate_gain_s,
                setpoint_weights,
                feedforward,
                derivative,
                integral: structure.integral,
                anti_windup,
                limits,
                slew_rad_s: slew,
                guard,
            }
        },
    )
}

fn gains() -> impl Strategy<Value = Gains<f64>> {
    let sometimes = |largest: f64| prop_oneof![1 => Just(0.0), 5 => 0.05 * largest..largest];
    (0.1..2.0, sometimes(0.5), sometimes(0.5)).prop_map(|(kp, ki, kd)| Gains { kp, ki, kd })
}

fn input_sets(conclusions: Conclusions) -> BoxedStrategy<InputSets<f64>> {
    if conclusions == Conclusions::Network {
        return Just(InputSets::EVEN).boxed();
    }
    let centres = || {
        let drawn = (0.1..0.4, 0.5..0.9);
        option::weighted(
            0.3,
            drawn.prop_map(|(small, medium)| SetCentres::new(small, medium).expect("in order")),
        )
    };
    (centres(), centres()).prop_map(|(error, change)| InputSets { error, change }).boxed()
}

fn gain_limits(nominal: Gains<f64>) -> impl Strategy<Value = GainLimits<f64>> {
    let around = |gain: f64| {
        (0.01..0.2, 0.01..0.2).prop_map(move |(below, above)| {
            Limits::new(ControllerSetting::GainLimits, gain - below, gain + above)
                .expect("in order")
        })
    };
    (around(nominal.kp), around(nominal.ki), around(nominal.kd))
        .prop_map(|(kp, ki, kd)| GainLimits { kp, ki, kd })
}

fn settings(
    structure: TunerStructure,
    nominal: Gains<f64>,
) -> impl Strategy<Value = TunerSettings<f64>> {
    let sign =
        select(vec![ErrorSign::SetpointMinusMeasurement, ErrorSign::MeasurementMinusSetpoint]);
    let change = select(vec![Change::Rate, Change::Delta]);
    let input_scale = (2.0..40.0, 0.2..8.0)
        .prop_map(|(error_per_rad, change_per_rad)| InputScale { error_per_rad, change_per_rad });
    let output_scale =
        (0.0..0.2, 0.0..0.05, 0.0..0.1).prop_map(|(kp, ki, kd)| Gains { kp, ki, kd });
    let coupling = (-1.0..1.0, -1.0..1.0)
        .prop_map(|(setpoint_weight, rate_gain)| GainCoupling { setpoint_weight, rate_gain });
    let coupling = prop_oneof![Just(GainCoupling::NONE), coupling];
    let zone =
        (0.0..0.1, 0.0..0.3).prop_map(|(error_rad, change_rad)| DeadZone { error_rad, change_rad });
    let kinds =
        (sign, like(structure.second_input, second_input()), change, like(structure.law, law()));
    let numbers = (input_scale, input_sets(structure.conclusions), output_scale, coupling);
    let bounds = (option::of(gain_limits(nominal)), option::weighted(0.3, zone));
    (kinds, numbers, bounds).prop_map(
        |(
            (error_sign, second_input, change, law),
            (input_scale, input_sets, output_scale, gain_coupling),
            (gain_limits, dead_zone),
        )| TunerSettings {
            error_sign,
            second_input,
            change,
            input_scale,
            input_sets,
            output_scale,
            gain_coupling,
            law,
            gain_limits,
            dead_zone,
        },
    )
}

/// The paper's rules.
pub fn labels(policy: OutOfRange) -> Supervisor<f64> {
    Supervisor::new(&fspid_core::paper::rules(), 5.0, Defuzzifier::Exact, policy).expect("allowed")
}

fn supervisor(structure: TunerStructure) -> BoxedStrategy<Supervisor<f64>> {
    let policy = structure.out_of_range;
    let drawn = prop::array::uniform32(-5.0..5.0);
    match structure.conclusions {
        Conclusions::Labels => {
            let rules = fspid_core::paper::rules();
            let labels = Supervisor::new(&rules, 5.0, structure.defuzzifier, policy);
            Just(labels.expect("allowed")).boxed()
        }
        Conclusions::Numbers => drawn
            .prop_map(move |drawn| {
                let mut next = drawn.into_iter().cycle();
                let mut grid = || [0; 7].map(|_| [0; 7].map(|_| next.next().unwrap_or(0.0)));
                let numbers = NumberTable::new([0; 3].map(|_| grid())).expect("finite");
                Supervisor::of_numbers(&numbers, 5.0, policy).expect("allowed")
            })
            .boxed(),
        Conclusions::Network => drawn
            .prop_map(move |drawn| {
                let mut next = drawn.into_iter().chain(drawn.map(|it| 0.37 * it));
                let rows = [0; 6].map(|_| [0; 8].map(|_| next.next().unwrap_or(0.0)));
                let network = Network::new(rows).expect("allowed");
                Supervisor::of_network(&network, 5.0, policy).expect("allowed")
            })
            .boxed(),
    }
}

/// A controller of that structure, everything else drawn.
pub fn controller(structure: Structure) -> BoxedStrategy<Controller<f64>> {
    let configs = config(structure);
    let Some(tuner) = structure.tuner else {
        return (gains(), configs)
            .prop_map(|(gains, config)| {
                Controller::Fixed(Pid::new(gains, config).expect("allowed"))
            })
            .boxed();
    };
    gains()
        .prop_flat_map(move |nominal| (Just(nominal), supervisor(tuner), settings(tuner, nominal)))
        .prop_map(|(nominal, supervisor, settings)| {
            SelfTuner::new(nominal, supervisor, settings).expect("allowed")
        })
        .prop_flat_map(move |tuner| (Just(tuner), config(structure)))
        .prop_map(|(tuner, config)| {
            Controller::SelfTuning(Fspid::new(tuner, config).expect("allowed"))
        })
        .boxed()
}

/// Any controller.
pub fn any_controller() -> impl Strategy<Value = Controller<f64>> {
    structure().prop_flat_map(controller)
}
