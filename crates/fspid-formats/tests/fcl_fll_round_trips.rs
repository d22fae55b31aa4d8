//! Random systems come back from every format as they were: parts equal, numbers to the last bit.

use crate::common;

use common::{EXACT, LOSSY};
use fspid_formats::fcl::{self, Dialect};
use fspid_formats::{fll, fml};
use fspid_fuzzy::membership::ShapeKind;
use fspid_fuzzy::system::{
    Activation, Antecedent, Comparison, Conclusion, Consequent, Defuzzifier, Fallback,
    FallbackValue, Input, Membership, Output, OutputTerm, Parts, Rule, RuleBlock, Sampling,
    SetReading, Statement, System, Term, Universe, Variable,
};
use fspid_fuzzy::{Formula, Hedge, OutOfRange, SNormKind, TNormKind};
use proptest::prelude::*;

/// Which format a system must fit into.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Target {
    Fll,
    Fcl(Dialect),
}

const IEC: Target = Target::Fcl(Dialect::Iec);
const FUZZYLITE: Target = Target::Fcl(Dialect::Fuzzylite);
const JFUZZYLOGIC: Target = Target::Fcl(Dialect::JFuzzyLogic);

/// A row of random numbers, 0 once they are used up, so that failures shrink to small systems.
struct Choices {
    numbers: Vec<u64>,
    at: usize,
    target: Target,
}

impl Choices {
    fn number(&mut self) -> u64 {
        self.at += 1;
        self.numbers.get(self.at - 1).copied().unwrap_or(0)
    }

    fn below(&mut self, count: usize) -> usize {
        (self.number() % count as u64) as usize
    }

    fn coin(&mut self) -> bool {
        self.below(2) == 1
    }

    fn one_of<T: Clone>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())].clone()
    }

    /// A finite number; one in three has random bits.
    fn real(&mut self) -> f64 {
        let plain =
            [0.0, -0.0, 1.0, -1.0, 0.1, 1.0 / 3.0, -7.25, 1e-300, 1e300, 5e-324, 123_456_789.0];
        let random = f64::from_bits(self.number());
        if self.below(3) == 0 && random.is_finite() { random } else { self.one_of(&plain) }
    }

    fn unit(&mut self) -> f64 {
        let random = (self.number() >> 11) as f64 / (1_u64 << 53) as f64;
        self.one_of(&[0.0, 1.0, 0.5, random, 1.0 / 3.0, f64::MIN_POSITIVE])
    }

    fn height(&mut self) -> f64 {
        let height = self.unit();
        if height > 0.0 { height } else { 1.0 }
    }

    fn sorted(&mut self, count: usize) -> Vec<f64> {
        let mut numbers: Vec<f64> = (0..count).map(|_| self.real()).collect();
        numbers.sort_by(f64::total_cmp);
        numbers
    }

    fn universe(&mut self) -> Option<Universe> {
        let ends = self.sorted(2);
        let fits = ends[0] < ends[1] && (ends[1] - ends[0]).is_finite();
        let (lower, upper) = if fits { (ends[0], ends[1]) } else { (-1.0, 0.1) };
        Some(Universe { lower, upper })
    }

    fn is_extended(&self) -> bool {
        matches!(self.target, Target::Fll | FUZZYLITE)
    }
}

/// Shapes that a format has words of its own for.
fn kinds(target: Target) -> Vec<ShapeKind> {
    let own = [ShapeKind::Triangle, ShapeKind::Trapezoid, ShapeKind::Points];
    let jfuzzylogic = [
        ShapeKind::Gaussian,
        ShapeKind::GaussianProduct,
        ShapeKind::Bell,
        ShapeKind::Sigmoid,
        ShapeKind::SigmoidDifference,
        ShapeKind::Cosine,
    ];
    let without = [ShapeKind::LinearS, ShapeKind::LinearZ, ShapeKind::Singleton];
    match target {
        IEC => own.to_vec(),
        JFUZZYLOGIC => [&own[..], &jfuzzylogic].concat(),
        _ => ShapeKind::ALL.iter().copied().filter(|kind| !without.contains(kind)).collect(),
    }
}

fn shape(choices: &mut Choices) -> Membership {
    let kind = choices.one_of(&kinds(choices.target));
    let count = if kind.repeats() { 2 * (2 + choices.below(4)) } else { kind.params().len() };
    let mut params = choices.sorted(count);
    if kind == ShapeKind::Points {
        let grades: Vec<f64> = (0..count / 2).map(|_| choices.unit()).collect();
        params = params.iter().step_by(2).zip(grades).flat_map(|(x, grade)| [*x, grade]).collect();
        // In FCL points that are a triangle or a trapezoid are read as such.
        params[1] = 0.25;
    }
    if kind == ShapeKind::Trapezoid && choices.target == Target::Fll && choices.coin() {
        params[0] = f64::NEG_INFINITY;
    }
    // Half of a width among the smallest numbers is another's half too, and a trapezoid with one top
    // is a triangle.
    let tiny = kind == ShapeKind::Cosine && (2.0 * (0.5 * params[1])).total_cmp(&params[1]).is_ne();
    let pointed = kind == ShapeKind::Trapezoid && !(params[1] < params[2]);
    // jFuzzyLogic cuts at 0 where the second step is the higher one.
    let cut = kind == ShapeKind::SigmoidDifference && choices.target == JFUZZYLOGIC;
    if kind.check(&params).is_err() || tiny || pointed || cut {
        params = kind.example().to_vec();
    }
    let scaled =
        choices.target == Target::Fll || (choices.target == FUZZYLITE && kind != ShapeKind::Points);
    let height = if scaled { choices.height() } else { 1.0 };
    Membership::Shape { kind, params, height }
}

fn membership(choices: &mut Choices, names: &[&str]) -> Membership {
    let formulas = choices.is_extended();
    if !formulas || choices.below(6) > 0 {
        return shape(choices);
    }
    let names: Vec<&str> = ["x"].iter().chain(names).copied().collect();
    let text = choices.one_of(&["x", "max(0, 1 - abs(x - in0))", "x^2 / (1 + in0 ^ 2)"]);
    Membership::Formula { formula: Formula::parse(text, &names).expect("a formula"), height: 1.0 }
}

fn input(choices: &mut Choices, index: usize, names: &[&str]) -> Input {
    let lockable = if choices.target == IEC {
        vec![OutOfRange::Evaluate, OutOfRange::Clamp, OutOfRange::Error]
    } else if choices.is_extended() {
        vec![OutOfRange::Evaluate, OutOfRange::Clamp]
    } else {
        vec![OutOfRange::Evaluate]
    };
    let universe =
        if choices.coin() && choices.target != JFUZZYLOGIC { choices.universe() } else { None };
    let mut terms = Vec::new();
    for number in 0..1 + choices.below(3) {
        let singleton = matches!(choices.target, Target::Fcl(_)) && choices.below(8) == 7;
        let membership = if singleton {
            Membership::Shape {
                kind: ShapeKind::Singleton,
                params: vec![choices.real()],
                height: 1.0,
            }
        } else {
            membership(choices, names)
        };
        terms.push(Term { name: format!("t{number}"), membership, lower: None });
    }
    Input {
        name: format!("in{index}"),
        description: description(choices),
        enabled: choices.target == JFUZZYLOGIC || choices.coin(),
        universe,
        out_of_range: choices.one_of(&lockable),
        terms,
    }
}

fn description(choices: &mut Choices) -> String {
    let fll = choices.target == Target::Fll;
    if fll { choices.one_of(&["", "what it is: 1 (one)"]).into() } else { String::new() }
}

fn sampling(choices: &mut Choices) -> Sampling {
    match choices.target {
        Target::Fll | FUZZYLITE => {
            let count = choices.one_of(&[1000, 100, 7]);
            Sampling::Midpoint(count)
        }
        JFUZZYLOGIC => Sampling::LeftEnd(1000),
        Target::Fcl(Dialect::Iec) => choices.one_of(&[
            Sampling::Exact,
            Sampling::Endpoints(101),
            Sampling::Midpoint(100),
            Sampling::Trapezoid(11),
            Sampling::LeftEnd(3),
            Sampling::Vertices(101),
        ]),
    }
}

fn method(choices: &mut Choices) -> Defuzzifier {
    let sampling = sampling(choices);
    let weighted = Defuzzifier::WeightedAverage(SetReading::Tsukamoto);
    let standard = [
        Defuzzifier::Centroid(sampling),
        Defuzzifier::Bisector(sampling),
        Defuzzifier::SmallestOfMaximum(sampling),
        Defuzzifier::LargestOfMaximum(sampling),
        weighted,
    ];
    let more =
        [Defuzzifier::MeanOfMaximum(sampling), Defuzzifier::WeightedSum(SetReading::Tsukamoto)];
    if choices.is_extended() {
        choices.one_of(&[&standard[..], &more].concat())
    } else {
        choices.one_of(&standard)
    }
}

fn conclusion(choices: &mut Choices, weighted: bool, names: &[&str]) -> Conclusion {
    if !weighted {
        return Conclusion::Set { membership: membership(choices, names), lower: None };
    }
    let plane = |choices: &mut Choices| Conclusion::Linear {
        coefficients: names.iter().map(|_| choices.real()).collect(),
        constant: choices.real(),
    };
    let monotone = |choices: &mut Choices| {
        let kind = choices.one_of(&[
            ShapeKind::Ramp,
            ShapeKind::Sigmoid,
            ShapeKind::SmoothS,
            ShapeKind::Arc,
        ]);
        let membership =
            Membership::Shape { kind, params: kind.example().to_vec(), height: choices.height() };
        Conclusion::Set { membership, lower: None }
    };
    match choices.below(4) {
        1 if choices.is_extended() => plane(choices),
        2 if choices.target != IEC => {
            Conclusion::Formula(Formula::parse("in0 * 2 - 1", names).expect("a formula"))
        }
        3 if choices.is_extended() => monotone(choices),
        _ => Conclusion::Constant(choices.real()),
    }
}

fn fallback(choices: &mut Choices) -> Fallback {
    let number = FallbackValue::Number(choices.real());
    let previous = choices.coin();
    let value = match choices.below(3) {
        0 => FallbackValue::Nothing,
        1 if choices.target == IEC => FallbackValue::Middle,
        _ if choices.target == JFUZZYLOGIC && previous => FallbackValue::Nothing,
        _ => number,
    };
    Fallback { previous, value }
}

fn output(choices: &mut Choices, index: usize, names: &[&str], aggregation: SNormKind) -> Output {
    let defuzzifier = method(choices);
    let weighted = defuzzifier.sampling().is_none();
    let terms = (0..1 + choices.below(3)).map(|number| OutputTerm {
        name: format!("t{number}"),
        conclusion: conclusion(choices, weighted, names),
    });
    let terms = terms.collect();
    Output {
        name: format!("out{index}"),
        description: description(choices),
        enabled: choices.target == JFUZZYLOGIC || choices.coin(),
        universe: if !weighted || choices.coin() { choices.universe() } else { None },
        clamp: choices.target != JFUZZYLOGIC && choices.coin(),
        terms,
        aggregation: aggregation.into(),
        defuzzifier,
        fallback: fallback(choices),
    }
}

fn hedges(choices: &mut Choices) -> Vec<Hedge> {
    let known: &[Hedge] = if choices.is_extended() { Hedge::NAMED } else { &[Hedge::Not] };
    (0..choices.below(3)).map(|_| choices.one_of(known)).collect()
}

fn statement(choices: &mut Choices, parts: &Parts) -> Antecedent {
    let chained = choices.below(4) == 3;
    let (variable, count) = if chained {
        let index = choices.below(parts.outputs.len());
        (Variable::Output(index), parts.outputs[index].terms.len())
    } else {
        let index = choices.below(parts.inputs.len());
        (Variable::Input(index), parts.inputs[index].terms.len())
    };
    let mut hedges = hedges(choices);
    let mut term = Some(choices.below(count));
    if choices.is_extended() && choices.below(6) == 5 {
        term = None;
        hedges.push(Hedge::Any);
    }
    Antecedent::Is(Statement { variable, term, hedges })
}

fn antecedent(choices: &mut Choices, parts: &Parts, depth: usize) -> Antecedent {
    if depth == 0 {
        return statement(choices, parts);
    }
    let several = |choices: &mut Choices| {
        (0..2 + choices.below(2)).map(|_| antecedent(choices, parts, depth - 1)).collect()
    };
    match choices.below(5) {
        1 => Antecedent::All(several(choices)),
        2 => Antecedent::Any(several(choices)),
        3 if !choices.is_extended() => {
            Antecedent::Not(Box::new(antecedent(choices, parts, depth - 1)))
        }
        _ => statement(choices, parts),
    }
}

fn rule(choices: &mut Choices, parts: &Parts, all_outputs: bool) -> Rule {
    let outputs = if all_outputs { parts.outputs.len() } else { 1 };
    // Where hedges go on to the conclusions behind them, a system has rules that such a file can have.
    let mut carried = Vec::new();
    let consequents = (0..outputs).map(|output| {
        let term = choices.below(parts.outputs[output].terms.len());
        let mut hedges = hedges(choices);
        if choices.is_extended() && parts.outputs[output].enabled {
            hedges.append(&mut carried);
            carried.clone_from(&hedges);
        }
        Consequent { output, term, hedges }
    });
    let consequents = consequents.collect();
    let named = matches!(choices.target, Target::Fcl(_)) && choices.coin();
    Rule {
        consequents,
        name: if named { "r_7".into() } else { String::new() },
        enabled: true,
        antecedent: antecedent(choices, parts, 3),
        weight: choices.unit(),
    }
}

fn activation(choices: &mut Choices) -> Activation {
    let count = choices.number() as u32;
    let threshold = choices.real();
    let comparisons = [
        Comparison::Less,
        Comparison::AtMost,
        Comparison::Equal,
        Comparison::Unequal,
        Comparison::AtLeast,
        Comparison::Greater,
    ];
    let comparison = choices.one_of(&comparisons);
    choices.one_of(&[
        Activation::General,
        Activation::First { count, threshold },
        Activation::Last { count, threshold },
        Activation::Highest { count },
        Activation::Lowest { count },
        Activation::Proportional,
        Activation::Threshold { comparison, threshold },
    ])
}

/// Any two; of jFuzzyLogic one of its pairs.
fn connectives(choices: &mut Choices) -> (TNormKind, SNormKind) {
    let extended = choices.is_extended();
    if choices.target == JFUZZYLOGIC {
        return choices.one_of(&[
            (TNormKind::Minimum, SNormKind::Maximum),
            (TNormKind::AlgebraicProduct, SNormKind::AlgebraicSum),
            (TNormKind::BoundedDifference, SNormKind::BoundedSum),
            (TNormKind::HamacherProduct, SNormKind::EinsteinSum),
            (TNormKind::NilpotentMinimum, SNormKind::NilpotentMaximum),
            (TNormKind::DrasticProduct, SNormKind::DrasticSum),
        ]);
    }
    let and = if extended { TNormKind::ALL } else { &TNormKind::ALL[..3] };
    let or = if extended { SNormKind::ALL } else { &SNormKind::ALL[..3] };
    (choices.one_of(and), choices.one_of(or))
}

fn block(choices: &mut Choices, parts: &Parts, index: usize) -> RuleBlock {
    let extended = choices.is_extended();
    let (and, or) = connectives(choices);
    let implication = if extended { TNormKind::ALL } else { &TNormKind::ALL[..2] };
    let activation =
        if choices.target == Target::Fll { activation(choices) } else { Activation::General };
    RuleBlock {
        name: if extended && choices.coin() { String::new() } else { format!("block{index}") },
        description: description(choices),
        enabled: !extended || choices.coin(),
        and: and.into(),
        or: or.into(),
        implication: choices.one_of(implication).into(),
        activation,
        rules: (0..1 + choices.below(3)).map(|number| rule(choices, parts, number == 0)).collect(),
    }
}

fn system(choices: &mut Choices) -> Parts {
    let inputs = 1 + choices.below(3);
    let names = &["in0", "in1", "in2"][..inputs];
    let standard = [SNormKind::Maximum, SNormKind::BoundedSum, SNormKind::NormalizedSum];
    // Equal conclusions that are weighed are added up, of which jFuzzyLogic must be told for all outputs of a block.
    let known = match choices.target {
        JFUZZYLOGIC => &[SNormKind::UnboundedSum],
        _ if choices.is_extended() => SNormKind::ALL,
        _ => &standard[..],
    };
    let common = choices.one_of(known);
    let mut parts =
        Parts { name: "system".into(), description: description(choices), ..Parts::default() };
    parts.inputs = (0..inputs).map(|index| input(choices, index, names)).collect();
    for index in 0..1 + choices.below(2) {
        let own = choices.one_of(known);
        let aggregation = if choices.is_extended() { own } else { common };
        let output = output(choices, index, names, aggregation);
        parts.outputs.push(output);
    }
    for index in 0..1 + choices.below(2) {
        let block = block(choices, &parts, index);
        parts.blocks.push(block);
    }
    parts
}

/// Equal, and every number has the same bits: the debug output shows them all.
fn comes_back(numbers: Vec<u64>, target: Target) -> Result<(), TestCaseError> {
    let parts = system(&mut Choices { numbers, at: 0, target });
    prop_assert!(System::new(parts.clone()).is_ok(), "{:?}", System::new(parts).err());
    let written = match target {
        Target::Fll => fll::write(&parts, EXACT),
        Target::Fcl(dialect) => fcl::write(&parts, dialect, EXACT),
    };
    let text = written.map_err(|problems| TestCaseError::fail(problems.to_string()))?.text;
    let read = if target == Target::Fll { fll::read(&text) } else { fcl::read(&text) };
    let read = read.map_err(|problems| TestCaseError::fail(format!("{problems}\n{text}")))?;
    let (found, wanted) = (format!("{:#?}", read.parts), format!("{parts:#?}"));
    let unlike = found.lines().zip(wanted.lines()).find(|(found, wanted)| found != wanted);
    prop_assert!(found == wanted && read.parts == parts, "{text}\n{unlike:?}");
    Ok(())
}

/// The part of a system that FML has words for, as far as single statements go.
fn tamed(mut parts: Parts) -> Parts {
    for input in &mut parts.inputs {
        (input.enabled, input.out_of_range) = (true, OutOfRange::Evaluate);
    }
    for output in &mut parts.outputs {
        (output.enabled, output.clamp, output.fallback.previous) = (true, false, false);
        output.defuzzifier = output.defuzzifier.with_sampling(Sampling::Exact);
    }
    for block in &mut parts.blocks {
        block.activation = Activation::General;
        for rule in &mut block.rules {
            rule.consequents.iter_mut().for_each(|consequent| consequent.hedges.clear());
            rule.antecedent = flattened(&rule.antecedent);
        }
    }
    parts
}

/// The first statements of a condition, each with one hedge at most.
fn flattened(antecedent: &Antecedent) -> Antecedent {
    match antecedent {
        Antecedent::Is(statement) => {
            let mut statement = statement.clone();
            statement.hedges.truncate(usize::from(statement.term.is_some()));
            statement.term = Some(statement.term.unwrap_or(0));
            Antecedent::Is(statement)
        }
        Antecedent::All(parts) | Antecedent::Any(parts) => {
            let first = |part: &Antecedent| match flattened(part) {
                Antecedent::All(parts) | Antecedent::Any(parts) => parts[0].clone(),
                other => other,
            };
            let statements = parts.iter().map(first).collect();
            match antecedent {
                Antecedent::All(_) => Antecedent::All(statements),
                _ => Antecedent::Any(statements),
            }
        }
        Antecedent::Not(part) => match flattened(part) {
            Antecedent::All(parts) | Antecedent::Any(parts) => parts[0].clone(),
            other => other,
        },
        Antecedent::Always => Antecedent::Always,
    }
}

/// What FML can say, or a loss, is read back, and is then the same for ever.
fn comes_back_from_fml(parts: &Parts) -> Result<bool, TestCaseError> {
    let exact = fml::write(parts, EXACT);
    let said = exact.is_ok();
    let Ok(writing) = exact.or_else(|_| fml::write(parts, LOSSY)) else { return Ok(false) };
    let read = |text: &str| {
        fml::read(text).map_err(|problems| TestCaseError::fail(format!("{problems}\n{text}")))
    };
    let first = read(&writing.text)?.parts;
    let again = fml::write(&first, EXACT).map_err(|p| TestCaseError::fail(p.to_string()))?;
    let second = read(&again.text)?.parts;
    prop_assert_eq!(format!("{first:#?}"), format!("{second:#?}"), "{}", again.text);
    Ok(said)
}

fn numbers() -> impl Strategy<Value = Vec<u64>> {
    proptest::collection::vec(any::<u64>(), 0..300)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn systems_come_back_from_fll(numbers in numbers()) {
        comes_back(numbers, Target::Fll)?;
    }

    #[test]
    fn systems_come_back_from_the_standard_s_fcl(numbers in numbers()) {
        comes_back(numbers, IEC)?;
    }

    #[test]
    fn systems_come_back_from_fuzzylite_s_fcl(numbers in numbers()) {
        comes_back(numbers, FUZZYLITE)?;
    }

    #[test]
    fn systems_come_back_from_jfuzzylogic_s_fcl(numbers in numbers()) {
        comes_back(numbers, JFUZZYLOGIC)?;
    }

    /// Whatever is read is written and read again as the same, however it was put together.
    #[test]
    fn shuffled_files_are_a_problem_or_a_fixpoint(lines in Just(pool()).prop_shuffle(), count in 1_usize..60) {
        let text = lines[..count.min(lines.len())].join("\n");
        if let Ok(reading) = fll::read(&text) {
            let written = fll::write(&reading.parts, EXACT).map_err(|p| TestCaseError::fail(p.to_string()))?;
            prop_assert_eq!(fll::read(&written.text).unwrap().parts, reading.parts);
        }
        let _ = fcl::read(&text);
    }
}

/// Lines of the fixtures of both formats.
fn pool() -> Vec<String> {
    let files =
        [include_str!("data/fll/tipper.fll"), include_str!("data/fcl/tipper-fuzzylite.fcl")];
    files.iter().flat_map(|text| text.lines()).map(String::from).collect()
}

// What FML cannot say is measured by certified quadrature, which takes its time: fewer cases.
proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    #[test]
    fn systems_come_back_from_fml(numbers in numbers()) {
        for target in [Target::Fll, IEC] {
            let parts = system(&mut Choices { numbers: numbers.clone(), at: 0, target });
            comes_back_from_fml(&parts)?;
            comes_back_from_fml(&tamed(parts))?;
        }
    }
}
