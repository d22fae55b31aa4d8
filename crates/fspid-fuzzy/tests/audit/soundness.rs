//! No point of any system lies outside of the bounds that were proved for it.

use fspid_fuzzy::OutOfRange;
use fspid_fuzzy::audit::{OutputSurface, RuleEffect, Statement, SurfaceOptions, surface};
use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::norm::{SNormKind, TNormKind};
use fspid_fuzzy::system::{
    Activation, Antecedent, Conclusion, Consequent, Defuzzifier, Fallback, FallbackValue, Input,
    Membership, Output, OutputTerm, Parts, Rule, RuleBlock, Sampling, SetReading, Statement as Is,
    System, Term, Universe, Variable,
};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

/// Rounding in an evaluation and in the difference of two.
pub(super) const ROUNDING: f64 = 1e-9;
/// Half the distance of the two points of a sampled slope.
const STEP: f64 = 1e-5;

fn set(kind: ShapeKind, params: &[f64]) -> Membership {
    Membership::Shape { kind, params: params.to_vec(), height: 1.0 }
}

/// Numbers from 0 to 1, used up one by one.
struct Dice<'d>(std::iter::Cycle<std::slice::Iter<'d, f64>>);

impl Dice<'_> {
    fn number(&mut self) -> f64 {
        *self.0.next().expect("a cycle")
    }

    fn below(&mut self, count: usize) -> usize {
        ((self.number() * count as f64) as usize).min(count - 1)
    }

    fn shape(&mut self, place: f64) -> Membership {
        let width = 0.4 + self.number();
        let (left, right) = (place - width, place + width);
        match self.below(5) {
            0 => set(ShapeKind::Triangle, &[left, place, right]),
            1 => set(ShapeKind::Trapezoid, &[left, place - 0.2, place + 0.2, right]),
            2 => set(ShapeKind::Bell, &[place, width, 1.0 + width]),
            _ => set(ShapeKind::Gaussian, &[place, 0.6 * width]),
        }
    }
}

fn inputs(dice: &mut Dice<'_>, count: usize) -> Vec<Input> {
    let term = |dice: &mut Dice<'_>, n: usize| Term {
        name: format!("t{n}"),
        membership: dice.shape(n as f64 - 1.0),
        lower: None,
    };
    let input = |dice: &mut Dice<'_>, n: usize| Input {
        name: format!("x{n}"),
        description: String::new(),
        enabled: true,
        universe: Some(Universe { lower: -1.0, upper: 1.0 }),
        out_of_range: OutOfRange::Clamp,
        terms: (0..3).map(|n| term(dice, n)).collect(),
    };
    (0..count).map(|n| input(dice, n)).collect()
}

fn output(dice: &mut Dice<'_>, inputs: usize, defuzzifier: Defuzzifier) -> Output {
    let weighs = defuzzifier.sampling().is_none();
    let conclusion = |dice: &mut Dice<'_>, place: f64| match (weighs, dice.below(2)) {
        (true, 0) => Conclusion::Constant(place + dice.number()),
        (true, _) => Conclusion::Linear {
            coefficients: (0..inputs).map(|_| dice.number() - 0.5).collect(),
            constant: place,
        },
        (false, _) => Conclusion::Set { membership: dice.shape(place), lower: None },
    };
    let term = |dice: &mut Dice<'_>, n: usize| OutputTerm {
        name: format!("t{n}"),
        conclusion: conclusion(dice, n as f64 - 1.5),
    };
    Output {
        name: "y".into(),
        description: String::new(),
        enabled: true,
        universe: Some(Universe { lower: -2.0, upper: 2.0 }),
        clamp: false,
        terms: (0..4).map(|n| term(dice, n)).collect(),
        aggregation: if dice.below(3) == 0 {
            SNormKind::AlgebraicSum.into()
        } else {
            SNormKind::Maximum.into()
        },
        defuzzifier,
        fallback: Fallback { previous: false, value: FallbackValue::Number(0.25) },
    }
}

fn rule(dice: &mut Dice<'_>, cell: &[usize], terms: usize) -> Rule {
    let is = |input: usize, term: usize| {
        let variable = Variable::Input(input);
        Antecedent::Is(Is { variable, term: Some(term), hedges: vec![] })
    };
    let parts: Vec<_> = cell.iter().enumerate().map(|(input, &term)| is(input, term)).collect();
    Rule {
        name: String::new(),
        enabled: dice.number() < 0.95,
        antecedent: if dice.below(8) == 0 {
            Antecedent::Not(Antecedent::Any(parts).into())
        } else {
            Antecedent::All(parts)
        },
        consequents: vec![Consequent { output: 0, term: dice.below(terms), hedges: vec![] }],
        weight: if dice.below(4) == 0 { 0.75 } else { 1.0 },
    }
}

pub(super) fn random_system(numbers: &[f64], count: usize, defuzzifier: Defuzzifier) -> System {
    let mut dice = Dice(numbers.iter().cycle());
    let inputs = inputs(&mut dice, count);
    let output = output(&mut dice, count, defuzzifier);
    let cells = (0..3_usize.pow(count as u32))
        .map(|n| (0..count).map(|input| n / 3_usize.pow(input as u32) % 3).collect::<Vec<_>>());
    let rules = cells.map(|cell| rule(&mut dice, &cell, 4)).collect();
    let product = dice.below(2) == 0;
    let norm = |product| {
        if product { TNormKind::AlgebraicProduct } else { TNormKind::Minimum }
    };
    let block = RuleBlock {
        name: String::new(),
        description: String::new(),
        enabled: true,
        and: norm(product).into(),
        or: SNormKind::Maximum.into(),
        implication: norm(dice.below(2) == 0).into(),
        activation: if dice.below(4) == 0 { Activation::Proportional } else { Activation::General },
        rules,
    };
    let parts = Parts { inputs, outputs: vec![output], blocks: vec![block], ..Parts::default() };
    System::new(parts).expect("a sound system")
}

pub(super) fn defuzzifier() -> impl Strategy<Value = Defuzzifier> {
    prop_oneof![
        4 => Just(Defuzzifier::Centroid(Sampling::Exact)),
        1 => Just(Defuzzifier::Centroid(Sampling::Endpoints(21))),
        1 => Just(Defuzzifier::Centroid(Sampling::Midpoint(20))),
        1 => Just(Defuzzifier::Centroid(Sampling::LeftEnd(20))),
        1 => Just(Defuzzifier::Centroid(Sampling::Vertices(21))),
        1 => Just(Defuzzifier::Bisector(Sampling::Exact)),
        1 => Just(Defuzzifier::MeanOfMaximum(Sampling::Exact)),
        1 => Just(Defuzzifier::LargestOfMaximum(Sampling::Midpoint(40))),
        2 => Just(Defuzzifier::WeightedAverage(SetReading::Tsukamoto)),
        1 => Just(Defuzzifier::WeightedSum(SetReading::Tsukamoto)),
    ]
}

fn value(system: &System, point: &[f64]) -> f64 {
    let mut workspace = system.workspace();
    let answers = system.evaluate(point, &mut workspace).expect("finite");
    answers[0].value.expect("there is a fallback")
}

fn check(system: &System, proved: &OutputSurface, point: &[f64]) -> Result<(), TestCaseError> {
    let found = value(system, point);
    prop_assert!(proved.least.bounds[0] <= found + ROUNDING, "{found} {:?}", proved.least);
    prop_assert!(found <= proved.most.bounds[1] + ROUNDING, "{found} {:?}", proved.most);
    for (input, along) in proved.along.iter().enumerate() {
        let [mut from, mut to] = [point.to_vec(), point.to_vec()];
        from[input] = (from[input] - STEP).max(-1.0);
        to[input] = (to[input] + STEP).min(1.0);
        let slope = (value(system, &to) - value(system, &from)) / (to[input] - from[input]);
        let slack = 2.0 * ROUNDING / STEP;
        prop_assert!(along.least_slope.bounds[0] <= slope + slack, "{slope} {along:?}");
        prop_assert!(slope <= along.most_slope.bounds[1] + slack, "{slope} {along:?}");
        prop_assert!(slope.abs() <= along.lipschitz[1] + slack, "{slope} {along:?}");
        if along.monotone.statement == Statement::Proved {
            let signed = if along.monotone.rises { slope } else { -slope };
            prop_assert!(signed >= -slack);
        }
    }
    let opposite: Vec<f64> = point.iter().map(|x| -x).collect();
    let mirrored = value(system, &opposite);
    prop_assert!((found + mirrored).abs() <= proved.odd.departure.bounds[1] + ROUNDING);
    prop_assert!((found - mirrored).abs() <= proved.even.departure.bounds[1] + ROUNDING);
    Ok(())
}

/// How many systems are drawn: the first of those of the long checks.
fn systems() -> u32 {
    if std::env::var_os("FSPID_LONG_TESTS").is_some() { 60 } else { 15 }
}

proptest! {
    // The same systems at each run; other seeds belong to the long checks.
    #![proptest_config(ProptestConfig {
        rng_seed: RngSeed::Fixed(60),
        ..ProptestConfig::with_cases(systems())
    })]

    #[test]
    fn no_random_point_lies_outside_of_proved_bounds(
        numbers in proptest::collection::vec(0.0_f64..1.0, 97),
        count in 1_usize..=3,
        defuzzifier in defuzzifier(),
        points in proptest::collection::vec(proptest::array::uniform3(-1.0_f64..=1.0), 40),
    ) {
        let system = random_system(&numbers, count, defuzzifier);
        let options = SurfaceOptions { boxes: 16, ..SurfaceOptions::default() };
        let audit = surface(&system, &options).expect("universes are known");
        let proved = &audit.outputs[0];
        for point in &points {
            check(&system, proved, &point[..count])?;
        }
        for (extreme, sign) in [(&proved.least, -1.0), (&proved.most, 1.0)] {
            let here = sign * value(&system, &extreme.at);
            let bounds = extreme.bounds.map(|bound| sign * bound);
            prop_assert!(here >= bounds[0].min(bounds[1]) - ROUNDING, "{extreme:?}");
        }
        for effect in &audit.rules {
            if let RuleEffect::None { rule } = effect {
                let mut parts = system.parts().clone();
                parts.blocks[rule.block].rules[rule.rule].enabled = false;
                let without = System::new(parts).expect("still sound");
                for point in &points {
                    let change = value(&system, &point[..count]) - value(&without, &point[..count]);
                    prop_assert!(change.abs() < ROUNDING);
                }
            }
        }
    }
}

/// Half of the rules of a system ask for any of their statements, and their grades are added up.
fn added_up(system: &System) -> System {
    let mut parts = system.parts().clone();
    parts.blocks[0].or = SNormKind::UnboundedSum.into();
    for rule in parts.blocks[0].rules.iter_mut().step_by(2) {
        if let Antecedent::All(statements) = &rule.antecedent {
            rule.antecedent = Antecedent::Any(statements.clone());
        }
    }
    System::new(parts).expect("still sound")
}

/// Strengths above 1 used to be cut: "at most 6" of a sum that comes to 10.
#[test]
fn strengths_above_one_are_within_the_bounds_where_grades_are_added_up() {
    let methods = [
        Defuzzifier::WeightedSum(SetReading::Tsukamoto),
        Defuzzifier::WeightedAverage(SetReading::Tsukamoto),
        Defuzzifier::Centroid(Sampling::Endpoints(21)),
        Defuzzifier::Centroid(Sampling::Exact),
    ];
    let mut state = 5_u64;
    let mut number = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let mut above = 0;
    for n in 0..24 {
        let numbers: Vec<f64> = (0..97).map(|_| number()).collect();
        let count = 1 + n % 2;
        let system = added_up(&random_system(&numbers, count, methods[n / 2 % 4]));
        let options = SurfaceOptions { boxes: 16, ..SurfaceOptions::default() };
        let audit = surface(&system, &options).expect("universes are known");
        for _ in 0..60 {
            let point: Vec<f64> = (0..count).map(|_| 2.0 * number() - 1.0).collect();
            check(&system, &audit.outputs[0], &point).expect("within the bounds");
            let mut workspace = system.workspace();
            system.evaluate(&point, &mut workspace).expect("finite");
            let most = system.firings(&workspace).map(|firing| firing.acting).fold(0.0, f64::max);
            above += u32::from(most > 1.01);
            let least = audit.outputs[0].coverage.least.bounds[0];
            assert!(least <= most + ROUNDING, "{n}: {least} {most}");
        }
    }
    assert!(above > 200, "{above} points with a strength above 1");
}
