//! MATLAB: one function file for a whole controller.
//!
//! The language passes values: a function answers what it has written, which is its first answers here, and a call of one
//! stands alone. Arrays begin at 1.

use fspid_numeric::Real;

use super::dialect::{
    Block, Dialect, Truths, all_arguments, arguments, block, outer, part_name, place,
};
use super::{Heading, Page, decimal, wrapped};
use crate::program::{
    Argument, Expression, Function, Kind, Member, Part, Precision, Program, Statement, Value,
};
use crate::vectors::Vector;

/// The function file: `[answer, state] = prefix(sample, state)`, and `[~, state] = prefix()` at the beginning.
#[must_use]
pub fn matlab(program: &Program, prefix: &str, heading: &Heading<'_>) -> String {
    let writer = Writer { program };
    let mut page = Page::default();
    page.line(&format!("function [answer, state] = {prefix}(sample, state)"));
    page.line(&format!("%{} one sample of a controller.", prefix.to_uppercase()));
    page.line(&format!("%   [~, state] = {prefix}() begins; [answer, state] = {prefix}(sample, state) once every period."));
    writer.members(&mut page, "sample", Part::Sample);
    writer.members(&mut page, "answer", Part::Answer);
    heading.lines().iter().for_each(|line| page.line(&format!("%   {line}")));
    page.inside(|page| {
        page.line("design = configuration();");
        page.line("answer = struct();");
        page.line("if nargin == 0");
        page.inside(|page| {
            page.line("state = reset(design, struct());");
            page.line("return");
        });
        page.line("end");
        let parts = program.function("step").map_or(&[] as &[Part], |step| step.parts);
        let given: Vec<&str> = parts.iter().map(|part| part_name(*part)).collect();
        let written: Vec<&str> = changed(parts).map(part_name).collect();
        page.line(&format!("[{}] = step({});", written.join(", "), given.join(", ")));
    });
    page.line("end");
    writer.configuration(&mut page);
    page.line("");
    page.line("function value = choose(condition, one, other)");
    page.inside(|page| {
        page.line("if condition, value = one; else, value = other; end");
    });
    page.line("end");
    for function in &program.functions {
        page.line("");
        writer.function(&mut page, function);
    }
    page.text
}

/// A script that asks the function for the answers to vectors, which stand as whole numbers of 32 bits in a file beside it,
/// and counts those with other bits.
#[must_use]
pub fn matlab_harness(program: &Program, prefix: &str) -> String {
    let kind = kind(program);
    let words = if program.precision == Precision::Single { 1 } else { 2 };
    let [reals, marks] = program.answers();
    let inputs = program.members(Part::Sample);
    let mut page = Page::default();
    page.line(&format!("function {prefix}_check"));
    page.inside(|page| {
        page.line(&format!("rows = dlmread('{prefix}_words.csv');"));
        page.line(&format!("[~, state] = {prefix}();"));
        page.line("different = 0;");
        page.line("for k = 1:size(rows, 1)");
        page.inside(|page| {
            let numbers = (inputs.len() + reals.len()) * words;
            page.line(&format!("numbers = typecast(uint32(rows(k, 1:{numbers})), '{kind}');"));
            for (index, member) in (1..).zip(inputs) {
                page.line(&format!("sample.{} = numbers({index});", member.name));
            }
            page.line(&format!("[answer, state] = {prefix}(sample, state);"));
            let reals = reals.iter().map(|name| format!("answer.{name}")).collect::<Vec<_>>();
            let marks = marks.iter().map(|name| format!("double(answer.{name})"));
            page.line(&format!("answered = [{}];", reals.join(", ")));
            let first = inputs.len() + 1;
            page.line(&format!("same = isa(answered, '{kind}') && isequal(typecast(answered, 'uint32'), typecast(numbers({first}:end), 'uint32'));"));
            let marks = marks.collect::<Vec<_>>().join(", ");
            page.line(&format!("same = same && isequal([{marks}], rows(k, {}:end));", numbers + 1));
            page.line("different = different + ~same;");
        });
        page.line("end");
        page.line("fprintf('%d samples, %d different\\n', size(rows, 1), different);");
    });
    page.line("end");
    page.text
}

/// Vectors as whole numbers of 32 bits, of a number of 64 the lower half first; then the marks.
#[must_use]
pub fn words<R: Real>(program: &Program, vectors: &[Vector<R>]) -> String {
    let is_single = program.precision == Precision::Single;
    let inputs = program.members(Part::Sample).len();
    let mut text = String::new();
    for vector in vectors {
        let mut cells: Vec<String> = Vec::new();
        for value in vector.sample.iter().take(inputs).chain(&vector.answer) {
            let value = value.to_f64();
            #[allow(
                clippy::cast_possible_truncation,
                reason = "halves; singles of a single program"
            )]
            if is_single {
                cells.push((value as f32).to_bits().to_string());
            } else {
                let bits = value.to_bits();
                cells.extend([bits as u32, (bits >> 32) as u32].map(|half| half.to_string()));
            }
        }
        cells.extend(vector.marks.iter().map(u8::to_string));
        text.push_str(&cells.join(","));
        text.push('\n');
    }
    text
}

fn kind(program: &Program) -> &'static str {
    match program.precision {
        Precision::Single => "single",
        Precision::Double => "double",
    }
}

/// The parts that a function may write into, of those that it is given.
fn changed(parts: &[Part]) -> impl Iterator<Item = Part> {
    [Part::Answer, Part::State].into_iter().filter(|part| parts.contains(part))
}

struct Writer<'a> {
    program: &'a Program,
}

impl Writer<'_> {
    fn members(&self, page: &mut Page, name: &str, part: Part) {
        for Member { name: member, doc, .. } in self.program.members(part) {
            page.line(&format!("%   {name}.{member}: {doc}"));
        }
    }

    fn configuration(&self, page: &mut Page) {
        page.line("");
        page.line("function design = configuration()");
        page.inside(|page| {
            for Member { name, doc, value } in &self.program.configuration {
                comment(page, doc);
                page.line(&format!("design.{name} = {};", self.value(value)));
            }
        });
        page.line("end");
    }

    fn value(&self, value: &Value) -> String {
        match value {
            Value::Real(value) => self.number(*value),
            Value::Reals(values) => {
                let values: Vec<String> = values.iter().map(|it| decimal(*it, false)).collect();
                format!("{}([{}])", kind(self.program), values.join(", "))
            }
            Value::Bytes(values) => {
                let values: Vec<String> = values.iter().map(u8::to_string).collect();
                format!("[{}]", values.join(", "))
            }
            Value::Byte(value) => value.to_string(),
            Value::Truth(value) => value.to_string(),
        }
    }

    /// The names of what a function answers.
    fn answers(function: &Function) -> Vec<&str> {
        let value = function.answers.map(|_| "answered");
        let arrays = function.parameters.iter().filter(|it| it.written).map(|it| it.name);
        value.into_iter().chain(changed(function.parts).map(part_name)).chain(arrays).collect()
    }

    fn function(&self, page: &mut Page, function: &Function) {
        comment(page, function.doc);
        let parts = function.parts.iter().map(|part| part_name(*part));
        let parameters = function.parameters.iter().map(|parameter| parameter.name);
        let given: Vec<&str> = parts.chain(parameters).collect();
        let answers = Self::answers(function).join(", ");
        page.line(&format!("function [{answers}] = {}({})", function.name, given.join(", ")));
        page.inside(|page| block(self, page, &function.body));
        page.line("end");
    }

    /// A call that stands alone, because it answers more than one value.
    fn call_alone(
        &self,
        page: &mut Page,
        name: &str,
        given: &[Argument],
        into: Option<&str>,
    ) -> bool {
        let Some(function) = self.program.function(name) else { return false };
        let arrays =
            function.parameters.iter().zip(given).filter(|(parameter, _)| parameter.written);
        let arrays = arrays.filter_map(|(_, argument)| match argument {
            Argument::Array(name) => Some(name.clone()),
            Argument::Value(_) => None,
        });
        let value = function.answers.map(|_| into.unwrap_or("~").to_owned());
        let parts = changed(function.parts).map(|part| part_name(part).to_owned());
        let answers: Vec<String> = value.into_iter().chain(parts).chain(arrays).collect();
        let call = self.call(name, arguments(self, given));
        page.line(&format!("[{}] = {call};", answers.join(", ")));
        true
    }
}

fn comment(page: &mut Page, text: &str) {
    for line in wrapped(text, 92) {
        page.line(&format!("% {line}"));
    }
}

impl Dialect for Writer<'_> {
    fn number(&self, value: f64) -> String {
        // The digits of 64 bits: read as such, rounding changes nothing.
        match self.program.precision {
            Precision::Single => format!("single({})", decimal(value, false)),
            Precision::Double => decimal(value, false),
        }
    }

    fn byte(&self, value: u8) -> String {
        value.to_string()
    }

    fn truth(&self, value: bool) -> String {
        value.to_string()
    }

    fn truths(&self) -> Truths {
        Truths { not_equal: "~=", and: "&&", or: "||" }
    }

    fn member(&self, part: Part, name: &str) -> String {
        format!("{}.{name}", part_name(part))
    }

    fn element(&self, array: &str, index: &str) -> String {
        format!("{array}({index} + 1)")
    }

    fn not(&self, value: &str) -> String {
        format!("~{value}")
    }

    fn magnitude(&self, value: &str) -> String {
        format!("abs({value})")
    }

    fn bits(&self, left: &str, right: &str) -> String {
        format!("bitor({left}, {right})")
    }

    fn select(&self, condition: &str, then: &str, otherwise: &str) -> String {
        format!("choose({condition}, {then}, {otherwise})")
    }

    fn to_real(&self, value: &str) -> String {
        format!("{}({value})", kind(self.program))
    }

    fn power_of_two(&self, exponent: &str) -> String {
        format!("pow2({}, {exponent})", self.number(1.0))
    }

    fn call(&self, name: &str, given: Vec<String>) -> String {
        format!("{name}({})", all_arguments(self.program, name, given, part_name))
    }

    fn own(&self, page: &mut Page, statement: &Statement) -> bool {
        match statement {
            Statement::Call(name, given) => self.call_alone(page, name, given, None),
            Statement::Set(at, Expression::Call(name, given)) => {
                self.call_alone(page, name, given, Some(&place(self, at)))
            }
            Statement::Let(local, _, Expression::Call(name, given)) => {
                self.call_alone(page, name, given, Some(local))
            }
            Statement::If(condition, then, otherwise) if then.is_empty() => {
                let condition = Expression::Not(Box::new(condition.clone()));
                page.line(&format!("if {}", outer(self, &condition)));
                page.inside(|page| block(self, page, otherwise));
                page.line("end");
                true
            }
            _ => false,
        }
    }

    fn remark(&self, page: &mut Page, text: &str) {
        comment(page, text);
    }

    fn declare(&self, page: &mut Page, name: &str, _: Kind, value: &str) {
        page.line(&format!("{name} = {value};"));
    }

    fn declare_array(&self, page: &mut Page, name: &str, count: usize) {
        page.line(&format!("{name} = zeros(1, {count}, '{}');", kind(self.program)));
    }

    fn assign(&self, page: &mut Page, place: &str, value: &str) {
        page.line(&format!("{place} = {value};"));
    }

    fn run(&self, page: &mut Page, call: &str) {
        page.line(&format!("{call};"));
    }

    fn when(&self, condition: &str) -> String {
        format!("if {condition}")
    }

    fn otherwise(&self) -> &'static str {
        "else"
    }

    fn repeat(&self, name: &str, first: i32, last: i32) -> String {
        format!("for {name} = {first}:{last}")
    }

    fn end(&self, _: Block) -> &'static str {
        "end"
    }

    fn answer(&self, value: Option<&str>) -> Vec<String> {
        let value = value.map(|value| format!("answered = {value};"));
        value.into_iter().chain(["return".to_owned()]).collect()
    }
}
