//! Interval type-2 systems.

#![allow(clippy::float_cmp, reason = "tests ask for exact bits where they compare floats")]

use fspid_fuzzy::OutOfRange;
use fspid_fuzzy::formula::Formula;
use fspid_fuzzy::hedge::Hedge;
use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::norm::{SNormKind, TNormKind};
use fspid_fuzzy::system::{
    Activation, Antecedent, Conclusion, Consequent, Defuzzifier, Fallback, Input, Membership,
    Output, OutputTerm, Parts, Rule, RuleBlock, SNorm, Sampling, SetReading, Statement, System,
    TNorm, Term, Universe, Variable,
};

fn triangle(corners: [f64; 3], height: f64) -> Membership {
    Membership::Shape { kind: ShapeKind::Triangle, params: corners.to_vec(), height }
}

/// A triangle and a lower one within it: narrower by `blur` on each side, lower by `drop`.
fn blurred(corners: [f64; 3], blur: f64, drop: f64) -> (Membership, Option<Membership>) {
    let [left, peak, right] = corners;
    let lower = triangle([left + blur, peak, right - blur], 1.0 - drop);
    (triangle(corners, 1.0), (blur > 0.0 || drop > 0.0).then_some(lower))
}

fn system(blur: f64, drop: f64, defuzzifier: Defuzzifier, numbers: bool) -> System {
    let terms = [[-1.0, 0.0, 1.0], [0.0, 1.0, 2.0]].map(|c| blurred(c, blur, drop));
    let input_term = |(index, (membership, lower)): (usize, (Membership, Option<Membership>))| {
        Term { name: format!("set{index}"), membership, lower }
    };
    let input = |name: &str| Input {
        name: name.into(),
        description: String::new(),
        enabled: true,
        universe: Some(Universe { lower: 0.0, upper: 1.0 }),
        out_of_range: OutOfRange::Evaluate,
        terms: terms.clone().into_iter().enumerate().map(input_term).collect(),
    };
    let conclusions: Vec<Conclusion> = if numbers {
        vec![Conclusion::Interval([-1.0, -0.5]), Conclusion::Constant(2.0)]
    } else {
        [[-1.0, 0.0, 1.0], [0.0, 1.0, 2.5]]
            .map(|c| blurred(c, blur, drop))
            .map(|(membership, lower)| Conclusion::Set { membership, lower })
            .into()
    };
    let output_term = |(index, conclusion)| OutputTerm { name: format!("out{index}"), conclusion };
    let parts = Parts {
        name: "type-2".into(),
        description: String::new(),
        inputs: vec![input("a"), input("b")],
        outputs: vec![Output {
            name: "y".into(),
            description: String::new(),
            enabled: true,
            universe: Some(Universe { lower: -1.0, upper: 3.0 }),
            clamp: false,
            terms: conclusions.into_iter().enumerate().map(output_term).collect(),
            aggregation: Default::default(),
            defuzzifier,
            fallback: Fallback::default(),
        }],
        blocks: vec![block()],
    };
    System::new(parts).unwrap_or_else(|errors| panic!("{errors:?}"))
}

/// Rules with "and", "or", hedges and a weight.
fn block() -> RuleBlock {
    let is = |input, term, hedges: &[Hedge]| {
        let variable = Variable::Input(input);
        Antecedent::Is(Statement { variable, term: Some(term), hedges: hedges.to_vec() })
    };
    let rule = |antecedent, term, weight| Rule {
        name: String::new(),
        enabled: true,
        antecedent,
        consequents: vec![Consequent { output: 0, term, hedges: Vec::new() }],
        weight,
    };
    RuleBlock {
        name: String::new(),
        description: String::new(),
        enabled: true,
        and: Default::default(),
        or: Default::default(),
        implication: Default::default(),
        activation: Activation::General,
        rules: vec![
            rule(Antecedent::All(vec![is(0, 0, &[]), is(1, 0, &[])]), 0, 1.0),
            rule(Antecedent::Any(vec![is(0, 1, &[]), is(1, 1, &[Hedge::Very])]), 1, 0.8),
            rule(is(0, 0, &[Hedge::Not]), 1, 1.0),
        ],
    }
}

fn ask(system: &System, inputs: [f64; 2]) -> (f64, [f64; 2]) {
    let mut workspace = system.workspace();
    let value = system.evaluate(&inputs, &mut workspace).expect("finite")[0].value;
    (value.expect("fires"), workspace.interval(0).unwrap_or([f64::NAN; 2]))
}

const POINTS: [[f64; 2]; 5] = [[0.2, 0.3], [0.5, 0.5], [0.9, 0.1], [0.05, 0.95], [0.6, 0.7]];

#[test]
fn without_blur_the_interval_is_the_ordinary_answer() {
    let exact = Defuzzifier::Centroid(Sampling::Exact);
    let ordinary = system(0.0, 0.0, exact, false);
    assert!(!ordinary.parts().is_interval_type2());
    let mut parts = ordinary.parts().clone();
    for term in &mut parts.inputs[0].terms {
        term.lower = Some(term.membership.clone());
    }
    let both = System::new(parts).expect("allowed");
    for point in POINTS {
        let (value, [lower, upper]) = ask(&both, point);
        let (known, _) = ask(&ordinary, point);
        assert!((value - known).abs() < 1e-14, "{point:?} {value} {known}");
        assert!((upper - lower).abs() < 1e-14, "{point:?} {lower} {upper}");
    }
}

#[test]
fn more_blur_makes_a_wider_interval_that_holds_the_narrower_one() {
    let exact = Defuzzifier::Centroid(Sampling::Exact);
    for point in POINTS {
        let mut last = [f64::INFINITY, f64::NEG_INFINITY];
        for step in 1..6_u32 {
            let blur = 0.05 * f64::from(step);
            let (_, [lower, upper]) = ask(&system(blur, blur, exact, false), point);
            assert!(lower <= last[0] + 1e-14 && upper >= last[1] - 1e-14, "{point:?} {blur}");
            assert!(lower < upper);
            last = [lower, upper];
        }
    }
}

#[test]
fn exact_end_points_are_the_limit_of_ever_more_samples() {
    for point in POINTS {
        let exact = system(0.2, 0.3, Defuzzifier::Centroid(Sampling::Exact), false);
        let sampled = Defuzzifier::Centroid(Sampling::Midpoint(40_000));
        let (_, known) = ask(&exact, point);
        let (_, close) = ask(&system(0.2, 0.3, sampled, false), point);
        for (a, b) in known.into_iter().zip(close) {
            assert!((a - b).abs() < 1e-7, "{point:?} {known:?} {close:?}");
        }
    }
}

#[test]
fn no_choice_of_ordinary_sets_within_the_bounds_leaves_the_interval() {
    let exact = Defuzzifier::Centroid(Sampling::Exact);
    let (blur, drop) = (0.2, 0.3);
    for point in POINTS {
        let (_, [lower, upper]) = ask(&system(blur, drop, exact, false), point);
        for n in 0..=10_u32 {
            // Sets between the bounds: every set narrower and lower by the same share. The negation
            // in the rules makes some strengths rise and others fall.
            let share = f64::from(n) / 10.0;
            let mut parts = system(blur, drop, exact, false).parts().clone();
            let between = |membership: &mut Membership, below: &mut Option<Membership>| {
                let (Membership::Shape { params, height, .. }, Some(Membership::Shape { .. })) =
                    (membership, below.take())
                else {
                    return;
                };
                params[0] += share * blur;
                params[2] -= share * blur;
                *height -= share * drop;
            };
            for term in parts.inputs.iter_mut().flat_map(|input| &mut input.terms) {
                between(&mut term.membership, &mut term.lower);
            }
            for term in &mut parts.outputs[0].terms {
                if let Conclusion::Set { membership, lower } = &mut term.conclusion {
                    between(membership, lower);
                }
            }
            let (value, _) = ask(&System::new(parts).expect("allowed"), point);
            assert!((lower - 1e-12..=upper + 1e-12).contains(&value), "{point:?} {share}: {value}");
        }
    }
}

#[test]
fn numbers_and_intervals_are_averaged_between_their_bounds() {
    let average = Defuzzifier::WeightedAverage(SetReading::Tsukamoto);
    let (value, [lower, upper]) = ask(&system(0.2, 0.3, average, true), [0.4, 0.6]);
    assert!((-1.0..=2.0).contains(&lower) && lower < upper && upper <= 2.0);
    assert_eq!(value, 0.5 * lower + 0.5 * upper);
}

#[test]
fn an_exact_interval_of_curved_sets_is_refused_with_what_to_do() {
    let mut parts = system(0.2, 0.0, Defuzzifier::Centroid(Sampling::Exact), false).parts().clone();
    let Conclusion::Set { membership, .. } = &mut parts.outputs[0].terms[0].conclusion else {
        panic!("a set")
    };
    *membership =
        Membership::Shape { kind: ShapeKind::Gaussian, params: vec![0.0, 1.0], height: 1.0 };
    let errors = System::new(parts).expect_err("curved");
    assert!(errors[0].to_string().contains("endpoints:101"), "{}", errors[0]);
}

/// The default used to be told as the answer of such an output wherever its rules fire.
#[test]
fn an_exact_interval_of_sets_that_do_not_stay_straight_is_refused_with_what_to_do() {
    let refused = |change: fn(&mut Parts)| {
        let exact = Defuzzifier::Centroid(Sampling::Exact);
        let mut parts = system(0.2, 0.0, exact, false).parts().clone();
        change(&mut parts);
        let errors = System::new(parts.clone()).expect_err("neither has a closed form");
        let text = errors[0].to_string();
        assert!(text.starts_with("output `y`: the exact centroid"), "{text}");
        assert!(text.contains("endpoints:101"), "{text}");
        parts.outputs[0].defuzzifier = Defuzzifier::Centroid(Sampling::Endpoints(101));
        assert!(System::new(parts).is_ok());
    };
    refused(|parts| parts.outputs[0].aggregation = SNormKind::AlgebraicSum.into());
    refused(|parts| parts.blocks[0].implication = TNormKind::EinsteinProduct.into());
}

/// `a*(1-b)` of grades from 0.2 to 0.7 and from 0.3 to 0.8 lies between 0.04 and 0.49, and was told as 0.14 to 0.14.
#[test]
fn norms_that_are_formulas_are_refused_where_grades_are_intervals() {
    let t_norm = || TNorm::Formula(Formula::parse("a*(1-b)", &["a", "b"]).expect("a formula"));
    let s_norm = || SNorm::Formula(Formula::parse("a+b-a*b", &["a", "b"]).expect("a formula"));
    let changes: [&dyn Fn(&mut Parts); 4] = [
        &|parts| parts.blocks[0].and = t_norm(),
        &|parts| parts.blocks[0].or = s_norm(),
        &|parts| parts.blocks[0].implication = t_norm(),
        &|parts| parts.outputs[0].aggregation = s_norm(),
    ];
    for change in changes {
        let sampled = Defuzzifier::Centroid(Sampling::Endpoints(101));
        let mut parts = system(0.2, 0.3, sampled, false).parts().clone();
        change(&mut parts);
        let errors = System::new(parts.clone()).expect_err("it need not rise");
        assert!(errors[0].to_string().contains("a norm that is a formula"), "{}", errors[0]);
        for term in parts.inputs.iter_mut().flat_map(|input| &mut input.terms) {
            term.lower = None;
        }
        for term in &mut parts.outputs[0].terms {
            if let Conclusion::Set { lower, .. } = &mut term.conclusion {
                *lower = None;
            }
        }
        assert!(System::new(parts).is_ok(), "ordinary systems have them");
    }
}

/// Such a rule used to conclude all that is not its conclusion, or all there is, as strongly as can be.
#[test]
fn a_rule_that_does_not_fire_concludes_nothing_whatever_its_hedges() {
    for hedge in [Hedge::Not, Hedge::Any] {
        let exact = Defuzzifier::Centroid(Sampling::Exact);
        let mut parts = system(0.0, 0.0, exact, false).parts().clone();
        parts.inputs[0].terms[1].membership = triangle([2.0, 3.0, 4.0], 1.0);
        let mut hedged = parts.blocks[0].rules[2].clone();
        parts.blocks[0].rules.truncate(1);
        let Antecedent::Is(statement) = &mut hedged.antecedent else { panic!("a statement") };
        (statement.term, statement.hedges) = (Some(1), Vec::new());
        hedged.consequents[0].hedges = vec![hedge];
        parts.blocks[0].rules.push(hedged);
        let ordinary = System::new(parts.clone()).expect("allowed");
        for term in &mut parts.inputs[0].terms {
            term.lower = Some(term.membership.clone());
        }
        let both = System::new(parts.clone()).expect("allowed");
        let known = ask(&ordinary, [0.2, 0.3]).0;
        let (_, [lower, upper]) = ask(&both, [0.2, 0.3]);
        assert!((lower - known).abs() < 1e-12 && (upper - known).abs() < 1e-12, "{hedge:?}");
        // Where it may fire or not, both count.
        parts.inputs[0].terms[1].membership = triangle([-1.0, 0.2, 1.0], 1.0);
        parts.inputs[0].terms[1].lower = Some(triangle([2.0, 3.0, 4.0], 1.0));
        let (_, [lower, upper]) = ask(&System::new(parts).expect("allowed"), [0.2, 0.3]);
        assert!(lower <= known + 1e-12 && known + 0.1 < upper, "{hedge:?} {lower} {upper}");
    }
}

/// The number of the largest strength alone used to be told, as an interval without width.
#[test]
fn sets_that_are_read_by_a_strength_which_is_an_interval_are_refused() {
    let exact = Defuzzifier::Centroid(Sampling::Exact);
    for reading in [SetReading::Tsukamoto, SetReading::InverseTsukamoto] {
        for method in [Defuzzifier::WeightedAverage(reading), Defuzzifier::WeightedSum(reading)] {
            let mut parts = system(0.2, 0.3, exact, false).parts().clone();
            parts.outputs[0].defuzzifier = method;
            for term in &mut parts.outputs[0].terms {
                let (kind, params) = (ShapeKind::Ramp, vec![0.0, 1.0]);
                let membership = Membership::Shape { kind, params, height: 1.0 };
                term.conclusion = Conclusion::Set { membership, lower: None };
            }
            let errors = System::new(parts).expect_err("no interval of numbers");
            assert!(errors[0].to_string().contains("needs numbers, intervals"), "{}", errors[0]);
        }
    }
}

/// The exact rule used to take such a lower set as it is, and samples to take the smaller of both.
#[test]
fn exact_and_sampled_answers_agree_where_a_lower_set_is_above_its_upper_one() {
    let lowers = [
        triangle([1.0, 1.8, 2.4], 1.0),
        Membership::Shape { kind: ShapeKind::Rectangle, params: vec![0.5, 1.5], height: 0.9 },
        triangle([-0.5, 0.5, 2.9], 0.4),
    ];
    for set in lowers {
        let [exact, sampled] = [Sampling::Exact, Sampling::Midpoint(40_000)].map(|sampling| {
            let method = Defuzzifier::Centroid(sampling);
            let mut parts = system(0.2, 0.3, method, false).parts().clone();
            let Conclusion::Set { lower, .. } = &mut parts.outputs[0].terms[1].conclusion else {
                panic!("a set")
            };
            *lower = Some(set.clone());
            System::new(parts).expect("allowed")
        });
        for point in POINTS {
            let ((_, known), (_, close)) = (ask(&exact, point), ask(&sampled, point));
            for (a, b) in known.into_iter().zip(close) {
                assert!((a - b).abs() < 1e-6, "{set:?} {point:?} {known:?} {close:?}");
            }
        }
    }
}
