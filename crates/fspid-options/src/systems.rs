//! Fuzzy systems of every kind.

use fspid_core::fuzzy::OutOfRange;
use fspid_fuzzy::hedge::Hedge;
use fspid_fuzzy::membership::{Param, Range, ShapeKind};
use fspid_fuzzy::norm::{SNormKind, TNormKind};
use fspid_fuzzy::system::{
    Activation, Antecedent, Comparison, Conclusion, Consequent, Defuzzifier, Fallback,
    FallbackValue, Input, Membership, Output, OutputTerm, Parts, Rule, RuleBlock, Sampling,
    SetReading, Statement, System, Term, Universe, Variable,
};
use proptest::prelude::*;

/// Any fuzzy system of type 1 without formulas: every shape, norm, hedge, activation, policy and defuzzifier.
pub fn any_system() -> impl Strategy<Value = System> {
    any::<u64>().prop_filter_map("parts that go together", |seed| {
        let parts = Draw(seed).parts();
        System::new(parts).ok()
    })
}

/// A value for each input: inside its range, beyond, at an end, on a number that its sets are made of, or no number.
pub fn inputs_of(system: &System, seed: u64) -> Vec<f64> {
    let mut draw = Draw(seed);
    system.parts().inputs.iter().map(|input| draw.value(input)).collect()
}

/// Numbers by Knuth's linear congruential generator.
struct Draw(u64);

impl Draw {
    fn unit(&mut self) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn below(&mut self, count: usize) -> usize {
        (self.unit() * count as f64) as usize % count.max(1)
    }

    fn chance(&mut self, of: f64) -> bool {
        self.unit() < of
    }

    fn pick<T: Clone>(&mut self, all: &[T]) -> T {
        all[self.below(all.len())].clone()
    }

    fn between(&mut self, lower: f64, upper: f64) -> f64 {
        lower + self.unit() * (upper - lower)
    }

    fn value(&mut self, input: &Input) -> f64 {
        const BAD: [f64; 7] =
            [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 3e38, -1e300, -0.0, 5e-324];
        let Universe { lower, upper } =
            input.universe.unwrap_or(Universe { lower: -1.0, upper: 1.0 });
        let term = self.below(input.terms.len());
        match self.below(12) {
            0 => self.pick(&[lower, upper]),
            1 | 2 => match input.terms.get(term).map(|term| &term.membership) {
                Some(Membership::Shape { params, .. }) => self.pick(params),
                _ => lower,
            },
            3 => self.between(2.0 * lower - upper, 2.0 * upper - lower),
            4 if self.chance(0.2) => self.pick(&BAD),
            _ => self.between(lower, upper),
        }
    }

    fn universe(&mut self) -> Universe {
        let span = self.pick(&[1.0, 7.0, 30.0, 1e-6, 1e9]);
        let lower = self.pick(&[0.0, -0.5 * span, -span, 0.3 * span]);
        Universe { lower, upper: lower + span }
    }

    fn shape(&mut self, kind: ShapeKind, Universe { lower, upper }: Universe) -> Membership {
        let span = upper - lower;
        let mut places: Vec<f64> = (0..4)
            .map(|_| match self.below(4) {
                0 => lower + 0.25 * span * self.below(5) as f64,
                _ => self.between(lower - 0.2 * span, upper + 0.2 * span),
            })
            .collect();
        places.sort_by(f64::total_cmp);
        let mut next = places.iter().copied();
        let groups = if kind.repeats() { 4 } else { 1 };
        let all = kind.params().iter().cycle().take(groups * kind.params().len());
        let mut params: Vec<f64> = all
            .map(|Param { range, .. }| match range {
                Range::Finite | Range::Extended => next.next().unwrap_or(upper),
                Range::Positive => span * self.between(0.05, 0.6),
                Range::NonZero => span * self.between(0.05, 0.6) * self.pick(&[1.0, -1.0]),
                Range::Grade => self.unit(),
                Range::Sign => self.pick(&[1.0, -1.0]),
            })
            .collect();
        let count = params.len();
        if matches!(kind, ShapeKind::Trapezoid | ShapeKind::Rectangle) && self.chance(0.4) {
            if self.chance(0.6) {
                params[0] = f64::NEG_INFINITY;
            }
            if self.chance(0.6) {
                params[count - 1] = f64::INFINITY;
            }
        }
        let height = if self.chance(0.15) { self.between(0.2, 1.0) } else { 1.0 };
        match kind.check(&params) {
            Ok(()) => Membership::Shape { kind, params, height },
            Err(_) => Membership::Shape {
                kind: ShapeKind::Triangle,
                params: vec![lower, lower + 0.3 * span, upper],
                height,
            },
        }
    }

    fn any_shape(&mut self, universe: Universe) -> Membership {
        let common =
            [ShapeKind::Triangle, ShapeKind::Trapezoid, ShapeKind::Gaussian, ShapeKind::SmoothS];
        let kind = if self.chance(0.4) { self.pick(&common) } else { self.pick(ShapeKind::ALL) };
        self.shape(kind, universe)
    }

    fn input(&mut self, name: &str) -> Input {
        let universe = self.universe();
        let count = 1 + self.below(4);
        let terms = (0..count).map(|term| Term {
            name: format!("t{term}"),
            membership: self.any_shape(universe),
            lower: None,
        });
        Input {
            terms: terms.collect(),
            name: name.to_owned(),
            description: String::new(),
            enabled: self.chance(0.95),
            universe: self.chance(0.9).then_some(universe),
            out_of_range: self.pick(&OutOfRange::ALL),
        }
    }

    fn sampling(&mut self) -> Sampling {
        let count = 2 + self.below(40) as u32;
        self.pick(&[
            Sampling::Exact,
            Sampling::Exact,
            Sampling::Endpoints(count),
            Sampling::Midpoint(count),
            Sampling::Trapezoid(count),
            Sampling::LeftEnd(count),
            Sampling::Vertices(count),
        ])
    }

    fn integrating(&mut self) -> Defuzzifier {
        let sampling = self.sampling();
        self.pick(&[
            Defuzzifier::Centroid(sampling),
            Defuzzifier::Centroid(sampling),
            Defuzzifier::Bisector(sampling),
            Defuzzifier::SmallestOfMaximum(sampling),
            Defuzzifier::MeanOfMaximum(sampling),
            Defuzzifier::LargestOfMaximum(sampling),
        ])
    }

    fn conclusions(&mut self, universe: Universe, inputs: usize) -> (Vec<Conclusion>, Defuzzifier) {
        let count = 2 + self.below(4);
        let set = |membership| Conclusion::Set { membership, lower: None };
        match self.below(5) {
            0 => {
                let spacing = universe.span() / (count - 1) as f64;
                let triangle = |k: usize| {
                    let peak = universe.lower + spacing * k as f64;
                    let params = vec![peak - spacing, peak, peak + spacing];
                    set(Membership::Shape { kind: ShapeKind::Triangle, params, height: 1.0 })
                };
                ((0..count).map(triangle).collect(), self.integrating())
            }
            1 | 2 => {
                let straight: Vec<ShapeKind> =
                    ShapeKind::ALL.iter().copied().filter(|it| it.is_piecewise_linear()).collect();
                let sets = (0..count).map(|_| {
                    let kind = self.pick(&straight);
                    set(self.shape(kind, universe))
                });
                (sets.collect(), self.integrating())
            }
            3 => {
                let sets = (0..count).map(|_| set(self.any_shape(universe))).collect();
                let sampled = self.integrating();
                (sets, sampled.with_sampling(Sampling::Midpoint(1 + self.below(30) as u32)))
            }
            _ => self.weighed(universe, inputs, count),
        }
    }

    fn weighed(
        &mut self,
        universe: Universe,
        inputs: usize,
        count: usize,
    ) -> (Vec<Conclusion>, Defuzzifier) {
        let rising = [
            ShapeKind::LinearS,
            ShapeKind::Ramp,
            ShapeKind::SmoothZ,
            ShapeKind::Concave,
            ShapeKind::Arc,
        ];
        let reading = self.pick(&[SetReading::Tsukamoto, SetReading::InverseTsukamoto]);
        let one = |draw: &mut Self| match draw.below(4) {
            0 => Conclusion::Constant(draw.between(universe.lower, universe.upper)),
            1 => {
                let kind = draw.pick(&rising);
                Conclusion::Set { membership: draw.shape(kind, universe), lower: None }
            }
            _ => Conclusion::Linear {
                coefficients: (0..inputs).map(|_| draw.between(-2.0, 2.0)).collect(),
                constant: draw.between(universe.lower, universe.upper),
            },
        };
        let all = (0..count).map(|_| one(self)).collect();
        let way = [Defuzzifier::WeightedAverage(reading), Defuzzifier::WeightedSum(reading)];
        (all, self.pick(&way))
    }

    fn output(&mut self, name: &str, inputs: usize) -> Output {
        let universe = self.universe();
        let (conclusions, defuzzifier) = self.conclusions(universe, inputs);
        let plain = [SNormKind::Maximum, SNormKind::UnboundedSum, SNormKind::BoundedSum];
        let aggregation = if self.chance(0.4) {
            SNormKind::Maximum
        } else if self.chance(0.6) {
            self.pick(&plain)
        } else {
            self.pick(SNormKind::ALL)
        };
        let value = [FallbackValue::Middle, FallbackValue::Number(0.25), FallbackValue::Nothing];
        let named = |(term, conclusion)| OutputTerm { name: format!("t{term}"), conclusion };
        Output {
            name: name.to_owned(),
            description: String::new(),
            enabled: self.chance(0.95),
            universe: Some(universe),
            clamp: self.chance(0.3),
            terms: conclusions.into_iter().enumerate().map(named).collect(),
            aggregation: aggregation.into(),
            defuzzifier,
            fallback: Fallback { previous: self.chance(0.05), value: self.pick(&value) },
        }
    }

    fn hedges(&mut self) -> Vec<Hedge> {
        let count = if self.chance(0.2) { 1 + self.below(2) } else { 0 };
        (0..count).map(|_| self.pick(Hedge::NAMED)).collect()
    }

    fn statement(&mut self, inputs: &[Input], outputs: &[Output], chained: bool) -> Antecedent {
        let about_output = chained && self.chance(0.2);
        let (variable, terms) = if about_output {
            let output = self.below(outputs.len());
            (Variable::Output(output), outputs[output].terms.len())
        } else {
            let input = self.below(inputs.len());
            (Variable::Input(input), inputs[input].terms.len())
        };
        let term = (!self.chance(0.03)).then(|| self.below(terms));
        let hedges = if term.is_none() { vec![Hedge::Any] } else { self.hedges() };
        Antecedent::Is(Statement { variable, term, hedges })
    }

    fn antecedent(
        &mut self,
        parts: (&[Input], &[Output]),
        chained: bool,
        depth: u32,
    ) -> Antecedent {
        let (inputs, outputs) = parts;
        let some = |draw: &mut Self| -> Vec<Antecedent> {
            let count = 1 + draw.below(3);
            (0..count).map(|_| draw.antecedent(parts, chained, depth + 1)).collect()
        };
        match self.below(if depth > 1 { 3 } else { 8 }) {
            3 | 4 => Antecedent::All(some(self)),
            5 | 6 => Antecedent::Any(some(self)),
            7 if self.chance(0.3) => Antecedent::Always,
            7 => Antecedent::Not(Box::new(self.antecedent(parts, chained, depth + 1))),
            _ => self.statement(inputs, outputs, chained),
        }
    }

    fn rule(&mut self, inputs: &[Input], outputs: &[Output], chained: bool) -> Rule {
        let count = 1 + self.below(outputs.len());
        let consequents = (0..count).map(|_| {
            let output = self.below(outputs.len());
            let term = self.below(outputs[output].terms.len());
            Consequent { output, term, hedges: self.hedges() }
        });
        Rule {
            consequents: consequents.collect(),
            name: String::new(),
            enabled: self.chance(0.95),
            antecedent: self.antecedent((inputs, outputs), chained, 0),
            weight: if self.chance(0.2) { self.unit() } else { 1.0 },
        }
    }

    fn activation(&mut self) -> Activation {
        let (count, threshold) = (self.below(4) as u32, self.pick(&[0.0, 0.2, 0.5]));
        let comparison = self.pick(&[
            Comparison::Less,
            Comparison::AtMost,
            Comparison::Equal,
            Comparison::Unequal,
            Comparison::AtLeast,
            Comparison::Greater,
        ]);
        match self.below(16) {
            0 => Activation::First { count, threshold },
            1 => Activation::Last { count, threshold },
            2 => Activation::Highest { count },
            3 => Activation::Lowest { count },
            4 => Activation::Proportional,
            5 => Activation::Threshold { comparison, threshold },
            _ => Activation::General,
        }
    }

    fn block(&mut self, inputs: &[Input], outputs: &[Output]) -> RuleBlock {
        let implication = [TNormKind::Minimum, TNormKind::AlgebraicProduct];
        let implication = if self.chance(0.5) {
            TNormKind::Minimum
        } else if self.chance(0.6) {
            self.pick(&implication)
        } else {
            self.pick(TNormKind::ALL)
        };
        let count = 1 + self.below(8);
        let chained = self.chance(0.2);
        RuleBlock {
            name: String::new(),
            description: String::new(),
            enabled: self.chance(0.95),
            and: self.pick(TNormKind::ALL).into(),
            or: self.pick(SNormKind::ALL).into(),
            implication: implication.into(),
            activation: self.activation(),
            rules: (0..count).map(|_| self.rule(inputs, outputs, chained)).collect(),
        }
    }

    fn parts(&mut self) -> Parts {
        let count = 1 + self.below(3);
        let inputs: Vec<Input> = (0..count).map(|k| self.input(&format!("in {k}"))).collect();
        let count = 1 + self.below(2);
        let outputs: Vec<Output> =
            (0..count).map(|k| self.output(&format!("out {k}"), inputs.len())).collect();
        let count = if self.chance(0.2) { 2 } else { 1 };
        let blocks = (0..count).map(|_| self.block(&inputs, &outputs)).collect();
        Parts { name: String::new(), description: String::new(), inputs, outputs, blocks }
    }
}
