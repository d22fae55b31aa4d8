//! From degrees to answers, as `system/evaluate.rs`, `output/weighted.rs` and `output/partition.rs` of `fspid-fuzzy`.

use fspid_fuzzy::system::{
    Conclusion, Defuzzifier, FallbackValue, Membership, Output, Sampling, SetReading, Way,
};
use fspid_numeric::Real;

use super::firing::clamped;
use super::{Composer, SystemRefusal, Trouble, at, count_of, index_of, put, root};
use crate::compose::{centroid, precision_of};
use crate::program::{
    Argument, Expression, Operator, Part, Statement, Value, element, local, member, member_element,
    number,
};

/// Codes of where a value comes from.
const RULES: u8 = 1;
const MIDDLE: u8 = 2;
const DEFAULT: u8 = 3;
const PREVIOUS: u8 = 4;

impl<R: Real> Composer<'_, R> {
    /// Every output, one after the other; answers which way each is computed.
    pub(super) fn outputs(&mut self) -> Result<Vec<String>, SystemRefusal> {
        let parts = self.system.parts();
        let actors = (0..parts.outputs.len()).map(|output| self.system.actors(output).len());
        let most = actors.max().unwrap_or(0);
        // The last level is that of no actor: always 0.
        self.body.push(Statement::Array("levels".to_owned(), most + 1));
        self.body.push(Statement::Array("found".to_owned(), 2));
        self.polygons();
        let mut ways = Vec::new();
        for (index, output) in parts.outputs.iter().enumerate() {
            let place = || format!("output `{}`", output.name);
            let way = self.output(index, output).map_err(|trouble| trouble.at(place()))?;
            ways.push(format!("output `{}`: {way}", output.name));
        }
        Ok(ways)
    }

    fn output(&mut self, index: usize, output: &Output) -> Result<String, Trouble> {
        let name = self.names.outputs[index].clone();
        self.body.push(Statement::Remark(format!("Output {}.", super::clean(&output.name))));
        self.body.extend([0, 1].map(|place| put("found", place, number(0.0))));
        let way = match (output.enabled, self.system.way(index)) {
            (true, Some(way)) => self.way(index, output, &way)?,
            _ => "it is switched off, and has its fallback alone".to_owned(),
        };
        let value = || at("found", 1);
        let is_good = number(0.5)
            .less(at("found", 0))
            .and(value().magnitude().at_most(number(precision_of::<R>().largest())));
        let given = self.given(index, &name, output, value(), RULES);
        let remembers = output.fallback.previous;
        let fallback = match (output.fallback.value, output.universe) {
            (FallbackValue::Middle, Some(universe)) => {
                self.given(index, &name, output, number(universe.middle()), MIDDLE)
            }
            (FallbackValue::Number(value), _) => {
                self.given(index, &name, output, number(value), DEFAULT)
            }
            _ => Vec::new(),
        };
        if !remembers {
            self.body.push(Statement::If(is_good, given, fallback));
            return Ok(way);
        }
        let known = super::known(&name);
        let previous = member(Part::State, &name);
        let kept = self.given(index, &name, output, previous, PREVIOUS);
        let fallback = vec![Statement::If(member(Part::State, &known), kept, fallback)];
        let from = member(Part::Answer, &self.names.sources[index]);
        let nothing = Expression::binary(Operator::Equal, from, Expression::Byte(0));
        let remembered = vec![
            Statement::set_member(Part::State, &name, member(Part::Answer, &name)),
            Statement::set_member(Part::State, &known, Expression::Truth(true)),
        ];
        self.body.push(Statement::If(is_good, given, fallback));
        self.body.push(Statement::when(nothing.negated(), remembered));
        Ok(way)
    }

    /// An answer, moved into the universe where the output asks for that.
    fn given(
        &mut self,
        index: usize,
        name: &str,
        output: &Output,
        value: Expression,
        source: u8,
    ) -> Vec<Statement> {
        let value = match output.universe {
            Some(universe) if output.clamp => {
                let [lower, upper] = self.range(name, universe);
                clamped(value, lower, upper)
            }
            _ => value,
        };
        let from = self.names.sources[index].clone();
        vec![
            Statement::set_member(Part::Answer, name, value),
            Statement::set_member(Part::Answer, &from, Expression::Byte(source)),
        ]
    }

    fn way(&mut self, index: usize, output: &Output, way: &Way) -> Result<String, Trouble> {
        match way {
            Way::Weighted => self.weighted(index, output),
            Way::Partition { rule, actors, middle, spacing } => {
                self.levels(index)?;
                self.partition(index, *rule, actors, [*middle, *spacing])
            }
            Way::Polygon { .. } => {
                self.levels(index)?;
                self.polygon(index, output, way)
            }
            Way::Sampled(sampling) => {
                self.levels(index)?;
                self.sampled(index, output, *sampling)
            }
            Way::Integral => Err(Trouble::Said(
                "an exact integral of curved sets takes a number of steps that depends on the inputs",
                "possible are straight-sided sets, or a sampled rule: --defuzzifier midpoint:1000",
            )),
            Way::Type2 => Err(Trouble::Said(
                "interval type-2 sets are reduced by an iteration",
                "possible is the same system with the upper sets alone",
            )),
        }
    }

    /// Evenly spaced triangles: the centroid of the fixed-size supervisor.
    fn partition(
        &mut self,
        index: usize,
        rule: Sampling,
        actors: &[Option<usize>],
        [middle, spacing]: [f64; 2],
    ) -> Result<String, Trouble> {
        let name = self.names.outputs[index].clone();
        let count = actors.len();
        let sets = format!("sorted_{index}");
        let strongest = format!("strongest_{index}");
        self.body.push(Statement::Array(sets.clone(), count));
        self.body.push(Statement::real(&strongest, number(0.0)));
        for (place, actor) in actors.iter().enumerate() {
            let Some(actor) = actor else { continue };
            self.body.push(put(&sets, place, at("levels", *actor)));
            let larger = self.library.larger::<R>(local(&strongest), at(&sets, place))?;
            self.body.push(Statement::set(&strongest, larger));
        }
        let called = self.centroid_function(rule, count)?;
        let centre = Expression::Call(called, vec![Argument::Array(sets)]);
        let doc = "Middle of the range, and the distance from peak to peak.";
        let peaks = self.member(&format!("peaks {index}"), &format!("{name}_peaks"));
        self.configuration.add(&peaks, doc, Value::Reals(vec![middle, spacing]));
        let read = |place| member_element(Part::Configuration, &peaks, index_of(place));
        self.body.push(Statement::when(
            number(super::library::least(precision_of::<R>())).at_most(local(&strongest)),
            vec![put("found", 0, number(1.0)), put("found", 1, read(0) + centre * read(1))],
        ));
        let how = if rule == Sampling::Exact {
            "closed form".to_owned()
        } else {
            format!("samples, {rule}")
        };
        Ok(format!("{how}, for its {count} triangles stand evenly and cross at one half"))
    }

    /// Weighted averages and sums.
    fn weighted(&mut self, index: usize, output: &Output) -> Result<String, Trouble> {
        let (reading, averages) = match output.defuzzifier {
            Defuzzifier::WeightedSum(reading) => (reading, false),
            Defuzzifier::WeightedAverage(reading) => (reading, true),
            _ => {
                return Err(Trouble::Said(
                    "its defuzzifier weighs nothing",
                    "possible is a weighted average",
                ));
            }
        };
        let conclusions: Vec<usize> =
            (0..self.conclusions.len()).filter(|&own| self.conclusions[own][1] == index).collect();
        let names = ["strongest", "scaled", "sum", "weights"].map(|name| format!("{name}_{index}"));
        let [strongest, scaled, sum, weights] = &names;
        self.body.push(Statement::real(strongest, number(0.0)));
        for &own in &conclusions {
            let larger = self.library.larger::<R>(local(strongest), at("degrees", own))?;
            self.body.push(Statement::set(strongest, larger));
        }
        self.scale_function();
        let call = super::library::called("scale", [local(strongest)]);
        let mut inside = vec![
            Statement::real(scaled, call),
            Statement::real(sum, number(0.0)),
            Statement::real(weights, number(0.0)),
        ];
        for &own in &conclusions {
            let term = self.conclusions[own][2];
            let value = self.value([index, term], &output.terms[term].conclusion, reading, own)?;
            let weight = || at("degrees", own) * local(scaled);
            inside.push(Statement::when(
                number(0.0).less(at("degrees", own)),
                vec![
                    Statement::set(sum, local(sum) + weight() * value),
                    Statement::set(weights, local(weights) + weight()),
                ],
            ));
        }
        let by = if averages { local(weights) } else { local(scaled) };
        inside.extend([put("found", 0, number(1.0)), put("found", 1, local(sum) / by)]);
        let fires = number(super::library::least(precision_of::<R>())).at_most(local(strongest));
        self.body.push(Statement::when(fires, inside));
        let what = if averages { "average" } else { "sum" };
        Ok(format!("weighted {what} of what {} rules conclude", conclusions.len()))
    }

    /// The number that a conclusion stands for.
    fn value(
        &mut self,
        [output, term]: [usize; 2],
        conclusion: &Conclusion,
        reading: SetReading,
        own: usize,
    ) -> Result<Expression, Trouble> {
        let name = self.term_name(output, term);
        match conclusion {
            Conclusion::Constant(constant) => {
                Ok(self.configuration.real(&name, "A number that rules conclude.", *constant))
            }
            Conclusion::Linear { coefficients, constant } => {
                let mut numbers = vec![*constant];
                numbers.extend(coefficients);
                let doc = "A straight law that rules conclude: its constant, then a slope for each input.";
                self.configuration.add(&name, doc, Value::Reals(numbers));
                let read = |place| member_element(Part::Configuration, &name, index_of(place));
                let add = |sum, input| sum + read(input + 1) * at("inputs", input);
                Ok((0..coefficients.len()).fold(read(0), add))
            }
            Conclusion::Set { membership, .. } => match (reading, membership) {
                (SetReading::InverseTsukamoto, set) => self.graded(&name, set, at("degrees", own)),
                (SetReading::Tsukamoto, Membership::Shape { kind, params, height }) => {
                    let given = self.parameters(&name, (*kind, params), 1.0);
                    let share = at("degrees", own) / number(*height);
                    let grade = share.smaller(number(1.0));
                    self.library.inverse::<R>((*kind, params), given, grade)
                }
                (SetReading::Tsukamoto, Membership::Formula { .. }) => Err(FORMULA),
            },
            Conclusion::Formula(_) => Err(FORMULA),
            Conclusion::Interval(_) => {
                Err(Trouble::Said("an interval is of type 2", "possible is its middle, a number"))
            }
        }
    }

    /// The name of the function for so many triangles.
    fn centroid_function(&mut self, rule: Sampling, count: usize) -> Result<&'static str, Trouble> {
        const NAMES: [&str; 8] = [
            "centroid",
            "centroid_2",
            "centroid_3",
            "centroid_4",
            "centroid_5",
            "centroid_6",
            "centroid_7",
            "centroid_8",
        ];
        for name in NAMES {
            let function = centroid::of::<R>(name, rule, count).map_err(|_| VERTICES)?;
            match self.library.functions.iter().find(|known| known.name == name) {
                Some(known) if *known == function => return Ok(name),
                Some(_) => {}
                None => {
                    self.library.functions.push(function);
                    return Ok(name);
                }
            }
        }
        Err(Trouble::Said(
            "outputs of more than eight different numbers of even triangles",
            "possible is a system for each of them",
        ))
    }

    pub(super) fn scale_function(&mut self) {
        if !self.library.functions.iter().any(|function| function.name == "scale") {
            self.library.functions.push(root::scale(precision_of::<R>()));
        }
    }
}

pub(super) const FORMULA: Trouble = Trouble::Said(
    "a conclusion that is a formula cannot be exported",
    "possible is a number or a straight law of the inputs",
);
pub(super) const VERTICES: Trouble = Trouble::Said(
    "the rule vertices:N takes a number of steps that depends on the inputs",
    "possible are exact, endpoints:N, midpoint:N, trapezoid:N, left-end:N, by --defuzzifier",
);

/// A loop over whole numbers from 0 with the count of a `usize`.
pub(super) fn repeat(name: &str, count: usize, body: Vec<Statement>) -> Statement {
    Statement::repeat(name, count_of(count), body)
}

/// The next place.
pub(super) fn plus(name: &str, steps: i32) -> Expression {
    Expression::binary(Operator::Add, local(name), crate::program::whole(steps))
}

/// A value in a row of a table that lies flat in an array of the function.
pub(super) fn cell(array: &str, row: Expression, width: i32, column: i32) -> Expression {
    element(array, flat(row, width, column))
}

/// The place of a value in a flat table.
pub(super) fn flat(row: Expression, width: i32, column: i32) -> Expression {
    let whole = crate::program::whole;
    let first = Expression::binary(Operator::Multiply, row, whole(width));
    Expression::binary(Operator::Add, first, whole(column))
}
