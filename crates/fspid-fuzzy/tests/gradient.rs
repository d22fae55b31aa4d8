//! Derivatives of answers against central differences of sixth order.

use fspid_fuzzy::formula::Formula;
use fspid_fuzzy::hedge::Hedge;
use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::norm::{SNormKind, TNormKind};
use fspid_fuzzy::system::{
    Activation, Antecedent, Conclusion, Consequent, Defuzzifier, Fallback, GradientError, Input,
    Membership, Output, OutputTerm, Parameter, Parts, Rule, RuleBlock, Sampling, SetReading,
    Statement, System, Term, Universe, Variable,
};
use fspid_fuzzy::{OutOfRange, RuleTable, Supervisor};

/// What is left of a difference of sixth order at the steps below.
const TOLERANCE: f64 = 1e-7;

fn shape(kind: ShapeKind, params: &[f64]) -> Membership {
    Membership::Shape { kind, params: params.to_vec(), height: 0.97 }
}

fn input(name: &str, sets: &[(ShapeKind, &[f64])]) -> Input {
    let term = |(index, (kind, params)): (usize, &(ShapeKind, &[f64]))| Term {
        name: format!("{name}{index}"),
        membership: shape(*kind, params),
        lower: None,
    };
    Input {
        name: name.into(),
        description: String::new(),
        enabled: true,
        universe: Some(Universe { lower: 0.0, upper: 10.0 }),
        out_of_range: OutOfRange::Evaluate,
        terms: sets.iter().enumerate().map(term).collect(),
    }
}

fn output(conclusions: Vec<Conclusion>, defuzzifier: Defuzzifier, join: SNormKind) -> Output {
    let term = |(index, conclusion)| OutputTerm { name: format!("t{index}"), conclusion };
    Output {
        name: "y".into(),
        description: String::new(),
        enabled: true,
        universe: Some(Universe { lower: 0.0, upper: 30.0 }),
        clamp: false,
        terms: conclusions.into_iter().enumerate().map(term).collect(),
        aggregation: join.into(),
        defuzzifier,
        fallback: Fallback::default(),
    }
}

fn is(input: usize, term: usize, hedges: &[Hedge]) -> Antecedent {
    let variable = Variable::Input(input);
    Antecedent::Is(Statement { variable, term: Some(term), hedges: hedges.to_vec() })
}

fn rules() -> Vec<Rule> {
    let rule = |antecedent, term, weight| Rule {
        name: String::new(),
        enabled: true,
        antecedent,
        consequents: vec![Consequent { output: 0, term, hedges: Vec::new() }],
        weight,
    };
    vec![
        rule(Antecedent::Any(vec![is(0, 0, &[]), is(1, 0, &[Hedge::Very])]), 0, 0.9),
        rule(is(0, 1, &[]), 1, 1.0),
        rule(Antecedent::All(vec![is(0, 2, &[]), is(1, 1, &[Hedge::Somewhat])]), 2, 0.8),
        rule(Antecedent::Not(Box::new(is(1, 1, &[]))), 1, 0.4),
        rule(Antecedent::All(vec![is(0, 1, &[Hedge::Not]), is(1, 0, &[])]), 2, 0.7),
    ]
}

struct Norms {
    and: TNormKind,
    or: SNormKind,
    implication: TNormKind,
    activation: Activation,
}

const MAMDANI: Norms = Norms {
    and: TNormKind::Minimum,
    or: SNormKind::Maximum,
    implication: TNormKind::Minimum,
    activation: Activation::General,
};
const SMOOTH: Norms = Norms {
    and: TNormKind::AlgebraicProduct,
    or: SNormKind::AlgebraicSum,
    implication: TNormKind::AlgebraicProduct,
    activation: Activation::Proportional,
};
const EINSTEIN: Norms = Norms {
    and: TNormKind::EinsteinProduct,
    or: SNormKind::EinsteinSum,
    implication: TNormKind::HamacherProduct,
    activation: Activation::General,
};

fn system(output: Output, norms: &Norms) -> System {
    let service: &[(ShapeKind, &[f64])] = &[
        (ShapeKind::Gaussian, &[0.0, 1.5]),
        (ShapeKind::Bell, &[5.0, 2.0, 2.5]),
        (ShapeKind::Sigmoid, &[7.0, 1.3]),
    ];
    let food: &[(ShapeKind, &[f64])] =
        &[(ShapeKind::Trapezoid, &[-1.0, 0.0, 2.0, 8.0]), (ShapeKind::SmoothS, &[1.0, 9.0])];
    let parts = Parts {
        name: "tip".into(),
        description: String::new(),
        inputs: vec![input("service", service), input("food", food)],
        outputs: vec![output],
        blocks: vec![RuleBlock {
            name: String::new(),
            description: String::new(),
            enabled: true,
            and: norms.and.into(),
            or: norms.or.into(),
            implication: norms.implication.into(),
            activation: norms.activation,
            rules: rules(),
        }],
    };
    System::new(parts).unwrap_or_else(|errors| panic!("{errors:?}"))
}

fn straight() -> Vec<Conclusion> {
    let set = |corners: &[f64]| {
        let kind = if corners.len() == 3 { ShapeKind::Triangle } else { ShapeKind::Trapezoid };
        Conclusion::Set { membership: shape(kind, corners), lower: None }
    };
    vec![set(&[0.0, 5.0, 11.0]), set(&[9.0, 14.0, 16.0, 20.0]), set(&[18.0, 25.0, 30.0])]
}

fn curved() -> Vec<Conclusion> {
    let set =
        |kind, params: &[f64]| Conclusion::Set { membership: shape(kind, params), lower: None };
    vec![
        set(ShapeKind::Gaussian, &[4.0, 2.0]),
        set(ShapeKind::Bell, &[15.0, 3.0, 2.0]),
        set(ShapeKind::SmoothS, &[18.0, 29.0]),
    ]
}

fn monotone() -> Vec<Conclusion> {
    let set =
        |kind, params: &[f64]| Conclusion::Set { membership: shape(kind, params), lower: None };
    vec![
        set(ShapeKind::Ramp, &[10.0, 0.0]),
        set(ShapeKind::Sigmoid, &[14.0, 0.8]),
        set(ShapeKind::SmoothS, &[18.0, 29.0]),
    ]
}

fn numbers() -> Vec<Conclusion> {
    let formula = Formula::parse("2 + service * food / (1 + food)", &["service", "food"]);
    vec![
        Conclusion::Constant(4.0),
        Conclusion::Linear { coefficients: vec![1.5, -0.5], constant: 12.0 },
        Conclusion::Formula(formula.expect("a formula")),
    ]
}

/// Difference of sixth order, with a long and a short step; a kink near by makes the two differ.
fn differences(f: impl Fn(f64) -> Option<f64>, at: f64) -> Option<(f64, f64)> {
    let difference = |h: f64| {
        let d = |n: f64| Some(f(at + n * h)? - f(at - n * h)?);
        Some((45.0 * d(1.0)? - 9.0 * d(2.0)? + d(3.0)?) / (60.0 * h))
    };
    let h = 2e-4 * at.abs().max(1.0);
    Some((difference(h)?, difference(h / 64.0)?))
}

/// Compares every derivative of a system at some points; answers how many were compared.
fn compare(what: &str, system: &System, output: usize, points: &[[f64; 2]]) -> usize {
    let differentiator = system.differentiator();
    let mut workspace = system.workspace();
    let value = |system: &System, point: &[f64]| {
        let mut workspace = system.workspace();
        system.evaluate(point, &mut workspace).ok()?.get(output)?.value
    };
    let mut compared = 0;
    let mut check = |name: &str, point: &[f64], exact: f64, numeric: Option<(f64, f64)>| {
        let Some((long, short)) = numeric else { return };
        let scale = 1.0 + exact.abs();
        // A kink within reach of the difference shows as a disagreement of the two.
        if (long - short).abs() > 3e-8 * scale {
            return;
        }
        compared += 1;
        assert!(
            (exact - long).abs() < TOLERANCE * scale,
            "{what} {name} {point:?}: {exact} {long}"
        );
    };
    for point in points {
        let gradient = differentiator
            .gradient(point, output, &mut workspace)
            .unwrap_or_else(|error| panic!("{what} {point:?}: {error}"));
        for (index, &exact) in gradient.inputs.iter().enumerate() {
            let along = |x: f64| {
                let mut moved = *point;
                moved[index] = x;
                value(system, &moved)
            };
            check("input", point, exact, differences(along, point[index]));
        }
        for (&parameter, &exact) in differentiator.parameters().iter().zip(&gradient.parameters) {
            let parts = system.parts();
            let along = |p: f64| {
                let mut parts = parts.clone();
                parts.set_parameter(parameter, p);
                value(&System::new(parts).ok()?, point)
            };
            let now = parts.parameter(parameter).expect("a listed parameter");
            let name = parts.parameter_name(parameter);
            check(&name, point, exact, differences(along, now));
        }
    }
    compared
}

const POINTS: [[f64; 2]; 6] =
    [[1.3, 2.7], [4.4, 6.1], [8.2, 3.3], [2.9, 8.8], [6.6, 5.2], [9.4, 9.1]];

#[test]
fn derivatives_of_every_smooth_way_from_sets_agree_with_differences() {
    use Defuzzifier::{
        Bisector, Centroid, LargestOfMaximum, MeanOfMaximum, SmallestOfMaximum, WeightedAverage,
    };
    let of = |conclusions, defuzzifier| output(conclusions, defuzzifier, SNormKind::Maximum);
    let exact = Centroid(Sampling::Exact);
    let trapezoid = Centroid(Sampling::Trapezoid(40));
    let endpoints = Centroid(Sampling::Endpoints(101));
    agree(&[
        ("mamdani", of(straight(), exact), &MAMDANI),
        ("larsen", of(straight(), exact), &SMOOTH),
        ("sum", output(straight(), exact, SNormKind::UnboundedSum), &MAMDANI),
        ("bisector", of(straight(), Bisector(Sampling::Exact)), &MAMDANI),
        ("endpoints", output(curved(), endpoints, SNormKind::AlgebraicSum), &SMOOTH),
        ("midpoint", of(straight(), Centroid(Sampling::Midpoint(57))), &MAMDANI),
        ("trapezoid", output(curved(), trapezoid, SNormKind::EinsteinSum), &EINSTEIN),
        ("tsukamoto", of(monotone(), WeightedAverage(SetReading::Tsukamoto)), &EINSTEIN),
        (
            "inverse tsukamoto",
            of(curved(), WeightedAverage(SetReading::InverseTsukamoto)),
            &MAMDANI,
        ),
        ("mean of maximum", of(straight(), MeanOfMaximum(Sampling::Exact)), &MAMDANI),
        ("smallest of maximum", of(straight(), SmallestOfMaximum(Sampling::Exact)), &MAMDANI),
        ("largest of maximum, peaks", of(straight(), LargestOfMaximum(Sampling::Exact)), &SMOOTH),
    ]);
}

#[test]
fn derivatives_of_weighted_numbers_agree_with_differences() {
    let of = |defuzzifier| output(numbers(), defuzzifier, SNormKind::Maximum);
    agree(&[
        ("numbers", of(Defuzzifier::WeightedAverage(SetReading::Tsukamoto)), &MAMDANI),
        ("sum of numbers", of(Defuzzifier::WeightedSum(SetReading::Tsukamoto)), &SMOOTH),
    ]);
}

/// Away from kinks, which four fifths of what is asked are at least.
fn agree(cases: &[(&str, Output, &Norms)]) {
    for (what, output, norms) in cases {
        let system = system(output.clone(), norms);
        let compared = compare(what, &system, 0, &POINTS);
        let all = POINTS.len() * (2 + system.differentiator().parameters().len());
        assert!(compared * 10 >= all * 8, "{what}: only {compared} of {all} away from kinks");
    }
}

#[test]
fn derivatives_of_curved_sets_with_an_exact_centroid_agree_with_differences() {
    let output = output(curved(), Defuzzifier::Centroid(Sampling::Exact), SNormKind::Maximum);
    for norms in [&MAMDANI, &SMOOTH] {
        let system = system(output.clone(), norms);
        assert!(compare("curved", &system, 0, &POINTS) > 150);
    }
}

#[test]
fn derivatives_of_the_paper_s_supervisor_agree_with_differences() {
    let file = include_str!("../../../data/rule-tables/printed.toml");
    let parts: Vec<&str> = file.split("\"\"\"").collect();
    let table = RuleTable::parse([parts[1], parts[3], parts[5]]).expect("a shipped table");
    let supervisor =
        Supervisor::new(&table, 5.0, fspid_fuzzy::Defuzzifier::Exact, OutOfRange::Clamp);
    let system = System::new(Parts::try_from(&supervisor.expect("allowed")).expect("rules"))
        .expect("allowed");
    for output in 0..3 {
        let points = [[0.31, -1.27], [-3.3, 0.7], [4.1, 3.9]];
        assert!(compare("supervisor", &system, output, &points) > 240, "{output}");
    }
}

#[test]
fn a_clamped_input_has_no_effect_and_a_jump_has_no_derivative() {
    let centroid = output(straight(), Defuzzifier::Centroid(Sampling::Exact), SNormKind::Maximum);
    let mut parts = system(centroid, &MAMDANI).parts().clone();
    parts.inputs[0].out_of_range = OutOfRange::Clamp;
    let clamping = System::new(parts).expect("allowed");
    let mut workspace = clamping.workspace();
    let gradient = clamping.differentiator().gradient(&[12.0, 3.0], 0, &mut workspace);
    let gradient = gradient.expect("an answer");
    assert!(gradient.inputs[0] == 0.0 && gradient.inputs[1] != 0.0);

    let sampled = Defuzzifier::Bisector(Sampling::Endpoints(101));
    let jumping = system(output(straight(), sampled, SNormKind::Maximum), &MAMDANI);
    let mut workspace = jumping.workspace();
    let answer = jumping.differentiator().gradient(&[5.0, 5.0], 0, &mut workspace);
    assert!(matches!(answer, Err(GradientError::Jumps { .. })), "{answer:?}");
}

#[test]
fn every_parameter_can_be_read_and_written_at_its_address() {
    let parts = system(
        output(numbers(), Defuzzifier::WeightedSum(SetReading::Tsukamoto), SNormKind::Maximum),
        &MAMDANI,
    );
    let mut parts = parts.parts().clone();
    let all = parts.parameters();
    assert!(all.contains(&Parameter::Weight { block: 0, rule: 4 }));
    for (index, &parameter) in all.iter().enumerate() {
        let value = 0.25 + index as f64;
        assert!(parts.set_parameter(parameter, value), "{parameter:?}");
        assert_eq!(parts.parameter(parameter), Some(value), "{parameter:?}");
    }
    assert_eq!(parts.parameter(Parameter::Weight { block: 3, rule: 0 }), None);
}
