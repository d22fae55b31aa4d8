//! What holds for every system that the format can say, and for every text.

use fspid_formats::{WriteOptions, fis};
use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::system::{
    Antecedent, Conclusion, Consequent, Defuzzifier, Fallback, FallbackValue, Input, Membership,
    Output, OutputTerm, Parts, Rule, RuleBlock, Sampling, SetReading, Statement, Term, Universe,
    Variable,
};
use fspid_fuzzy::{Hedge, OutOfRange, SNormKind, TNormKind};
use proptest::prelude::*;

const MATLAB: Sampling = Sampling::Endpoints(101);

/// Finite numbers of every size whose differences stay finite.
fn number() -> impl Strategy<Value = f64> {
    prop_oneof![
        -100.0..100.0,
        -1e-300..1e-300,
        -1e300..1e300,
        Just(0.0),
        Just(-0.0),
        (-50i32..50).prop_map(f64::from)
    ]
}

fn positive() -> impl Strategy<Value = f64> {
    prop_oneof![1e-3..100.0, 1e-300..1e-200, Just(0.1)]
}

/// Numbers in ascending order.
fn ascending(count: usize) -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(number(), count).prop_map(|mut numbers| {
        numbers.sort_by(f64::total_cmp);
        numbers
    })
}

fn universe() -> impl Strategy<Value = Universe> {
    ascending(2)
        .prop_filter("two ends", |ends| ends[0] < ends[1])
        .prop_map(|ends| Universe { lower: ends[0], upper: ends[1] })
}

/// Every membership function that MATLAB has, with parameters that it allows.
fn membership() -> impl Strategy<Value = Membership> {
    use ShapeKind::*;
    let pair = || (number(), positive()).prop_map(|(c, s)| vec![c, s]);
    let four =
        || (number(), positive(), number(), positive()).prop_map(|(a, b, c, d)| vec![a, b, c, d]);
    let shape = prop_oneof![
        ascending(3).prop_map(|p| (Triangle, p)),
        ascending(4).prop_map(|p| (Trapezoid, p)),
        ascending(2).prop_map(|p| (Trapezoid, vec![p[0], p[1], f64::INFINITY, f64::INFINITY])),
        pair().prop_map(|p| (Gaussian, p)),
        four().prop_map(|p| (GaussianProduct, p)),
        (number(), positive(), positive()).prop_map(|(c, w, s)| (Bell, vec![c, w, s])),
        pair().prop_map(|p| (Sigmoid, p)),
        four().prop_map(|p| (SigmoidDifference, p)),
        four().prop_map(|p| (SigmoidProduct, p)),
        ascending(2).prop_map(|p| (SmoothS, p)),
        ascending(2).prop_map(|p| (SmoothZ, p)),
        ascending(4).prop_map(|p| (Pi, p)),
        ascending(2).prop_map(|p| (LinearS, p)),
        ascending(2).prop_map(|p| (LinearZ, p)),
        number().prop_map(|p| (Singleton, vec![p])),
    ];
    shape
        .prop_filter("allowed", |(kind, params)| kind.check(params).is_ok())
        .prop_map(|(kind, params)| Membership::Shape { kind, params, height: 1.0 })
}

/// Names that a line can hold, made different by a number.
fn name() -> impl Strategy<Value = String> {
    "[A-Za-z0-9äß %#=:,.\\[\\]\"_-]{0,8}"
}

fn numbered(name: &str, number: usize) -> String {
    format!("{name}{number}").trim().into()
}

fn input() -> impl Strategy<Value = Input> {
    let terms = prop::collection::vec((name(), membership()), 1..4);
    (name(), universe(), terms).prop_map(|(name, universe, terms)| Input {
        name,
        description: String::new(),
        enabled: true,
        universe: Some(universe),
        out_of_range: OutOfRange::Evaluate,
        terms: terms
            .into_iter()
            .enumerate()
            .map(|(n, (name, membership))| Term {
                name: numbered(&name, n),
                membership,
                lower: None,
            })
            .collect(),
    })
}

/// Methods and conclusions of a Mamdani or a Sugeno system.
#[derive(Clone, Debug)]
struct Method {
    defuzzifier: Defuzzifier,
    aggregation: SNormKind,
    implication: TNormKind,
}

fn method() -> impl Strategy<Value = Method> {
    use Defuzzifier::*;
    let sets =
        [Centroid(MATLAB), Bisector(MATLAB), SmallestOfMaximum(MATLAB), LargestOfMaximum(MATLAB)];
    let norms = [SNormKind::Maximum, SNormKind::UnboundedSum, SNormKind::AlgebraicSum];
    let shaping = [TNormKind::Minimum, TNormKind::AlgebraicProduct];
    let weighted = [WeightedAverage(SetReading::Tsukamoto), WeightedSum(SetReading::Tsukamoto)];
    prop_oneof![
        (
            prop::sample::select(sets.to_vec()),
            prop::sample::select(norms.to_vec()),
            prop::sample::select(shaping.to_vec())
        )
            .prop_map(|(defuzzifier, aggregation, implication)| Method {
                defuzzifier,
                aggregation,
                implication
            }),
        prop::sample::select(weighted.to_vec()).prop_map(|defuzzifier| Method {
            defuzzifier,
            aggregation: SNormKind::UnboundedSum,
            implication: TNormKind::AlgebraicProduct,
        }),
    ]
    .no_shrink()
}

fn conclusion(weighs: bool, inputs: usize) -> BoxedStrategy<Conclusion> {
    if !weighs {
        return membership()
            .prop_map(|membership| Conclusion::Set { membership, lower: None })
            .boxed();
    }
    let linear = (prop::collection::vec(number(), inputs), number());
    prop_oneof![
        number().prop_map(Conclusion::Constant),
        linear.prop_map(|(coefficients, constant)| Conclusion::Linear { coefficients, constant }),
    ]
    .boxed()
}

fn output(method: Method, inputs: usize) -> impl Strategy<Value = Output> {
    let weighs = method.defuzzifier.sampling().is_none();
    let terms = prop::collection::vec((name(), conclusion(weighs, inputs)), 1..4);
    (name(), universe(), terms).prop_map(move |(name, universe, terms)| Output {
        name,
        description: String::new(),
        enabled: true,
        universe: Some(universe),
        clamp: false,
        terms: terms
            .into_iter()
            .enumerate()
            .map(|(n, (name, conclusion))| OutputTerm { name: numbered(&name, n), conclusion })
            .collect(),
        aggregation: method.aggregation.into(),
        defuzzifier: method.defuzzifier,
        fallback: Fallback { previous: false, value: FallbackValue::Middle },
    })
}

/// Hedges as they are read.
fn hedges() -> impl Strategy<Value = Vec<Hedge>> {
    let power = (2u8..99).prop_filter("words", |code| ![5, 10, 20].contains(code));
    let hedge = prop_oneof![
        Just(None),
        Just(Some(Hedge::Somewhat)),
        Just(Some(Hedge::Very)),
        Just(Some(Hedge::Seldom)),
        power.prop_map(|code| Some(Hedge::Power(f64::from(code) / 10.0))),
    ];
    (any::<bool>(), hedge)
        .prop_map(|(not, hedge)| not.then_some(Hedge::Not).into_iter().chain(hedge).collect())
}

/// For each input a term and hedges, or nothing; as a rule as it is read.
fn rule(sizes: Vec<usize>, outputs: Vec<usize>) -> impl Strategy<Value = Rule> {
    let asked: Vec<_> = sizes.iter().map(|&n| prop::option::of((0..n, hedges()))).collect();
    let told: Vec<_> = outputs.iter().map(|&n| prop::option::of(0..n)).collect();
    let weight = prop_oneof![0.0..=1.0, Just(1.0)];
    (asked, told, weight, any::<bool>())
        .prop_filter("a conclusion", |(_, told, ..)| told.iter().any(Option::is_some))
        .prop_map(|(asked, told, weight, any)| {
            let statement = |(input, (term, hedges)): (usize, (usize, Vec<Hedge>))| {
                let variable = Variable::Input(input);
                Antecedent::Is(Statement { variable, term: Some(term), hedges })
            };
            let asked = asked.into_iter().enumerate().filter_map(|(n, found)| Some((n, found?)));
            let mut parts: Vec<_> = asked.map(statement).collect();
            let antecedent = match (parts.len(), any) {
                (0, false) => Antecedent::Always,
                (0, true) => Antecedent::Not(Box::new(Antecedent::Always)),
                (1, _) => parts.remove(0),
                (_, false) => Antecedent::All(parts),
                (_, true) => Antecedent::Any(parts),
            };
            let told = told.into_iter().enumerate().filter_map(|(n, term)| Some((n, term?)));
            let consequents =
                told.map(|(output, term)| Consequent { output, term, hedges: vec![] }).collect();
            Rule { name: String::new(), enabled: true, antecedent, consequents, weight }
        })
}

fn parts() -> impl Strategy<Value = Parts> {
    (prop::collection::vec(input(), 1..4), method())
        .prop_flat_map(|(inputs, method)| {
            let outputs = prop::collection::vec(output(method.clone(), inputs.len()), 1..3);
            (Just(inputs), Just(method), outputs)
        })
        .prop_flat_map(|(inputs, method, outputs)| {
            let sizes = inputs.iter().map(|input| input.terms.len()).collect();
            let told = outputs.iter().map(|output| output.terms.len()).collect();
            let rules = prop::collection::vec(rule(sizes, told), 0..6);
            (Just(inputs), Just(method), Just(outputs), rules, name(), any::<bool>(), any::<bool>())
        })
        .prop_map(|(mut inputs, method, mut outputs, rules, name, product, probabilistic)| {
            let names = inputs.iter_mut().map(|i| &mut i.name);
            let names = names.chain(outputs.iter_mut().map(|o| &mut o.name));
            names.enumerate().for_each(|(n, name)| *name = numbered(name, n));
            let and = if product { TNormKind::AlgebraicProduct } else { TNormKind::Minimum };
            let or = if probabilistic { SNormKind::AlgebraicSum } else { SNormKind::Maximum };
            let block = RuleBlock {
                name: String::new(),
                description: String::new(),
                enabled: true,
                and: and.into(),
                or: or.into(),
                implication: method.implication.into(),
                activation: Default::default(),
                rules,
            };
            let (name, description) = (name.trim().into(), String::new());
            Parts { name, description, inputs, outputs, blocks: vec![block] }
        })
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1000, ..ProptestConfig::default() })]

    #[test]
    fn every_system_that_the_format_can_say_comes_back_bit_for_bit(parts in parts()) {
        let writing = fis::write(&parts, WriteOptions { lossy: false });
        let writing = writing.map_err(|problems| TestCaseError::fail(problems.to_string()))?;
        let reading = fis::read(&writing.text);
        let reading = reading.map_err(|problems| TestCaseError::fail(format!("{problems}\n{}", writing.text)))?;
        // Debug text tells -0 from 0.
        prop_assert_eq!(format!("{:?}", reading.parts), format!("{:?}", parts));
    }

    #[test]
    fn no_text_whatever_makes_the_reader_panic(text in "\\PC{0,200}") {
        let _ = fis::read(&text);
    }

    #[test]
    fn no_change_to_a_file_makes_the_reader_panic(
        at in 0.0..1.0f64,
        length in 0usize..20,
        by in "[\\PC\n]{0,10}",
    ) {
        for text in [include_str!("data/fis/quirks.fis"), include_str!("data/fis/type2.fis")] {
            let characters: Vec<char> = text.chars().collect();
            let begin = (at * characters.len() as f64) as usize;
            let end = (begin + length).min(characters.len());
            let other: String =
                characters[..begin].iter().copied().chain(by.chars()).chain(characters[end..].iter().copied()).collect();
            if let Ok(reading) = fis::read(&other) {
                let _ = fis::write(&reading.parts, WriteOptions { lossy: true });
            }
        }
    }
}
