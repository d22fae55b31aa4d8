//! Lua 5.3: one module of functions and tables.

use fspid_numeric::Real;

use super::dialect::{Block, Dialect, Truths, all_arguments, block, part_name};
use super::{Heading, Page, decimal, wrapped};
use crate::program::{Function, Kind, Member, Part, Precision, Program, Value};
use crate::vectors::{Vector, written_over};

/// The program as a module that answers `{ design, reset, step, hold, track, saturated, faults }`, of a fuzzy system
/// `{ design, infer }`. It has the bits of its precision where Lua's
/// numbers do: `LUA_32BITS` for single ones, else double ones.
#[must_use]
pub fn lua(program: &Program, heading: &Heading<'_>) -> String {
    let writer = Writer { program };
    let mut page = Page::default();
    heading.lines().iter().for_each(|line| page.line(&format!("-- {line}")));
    writer.head(&mut page);
    writer.table(&mut page, "design", Part::Configuration);
    for function in &program.functions {
        page.line("");
        writer.function(&mut page, function);
    }
    page.line("");
    let names = ["reset", "step", "hold", "track", "saturated", "faults", "infer"];
    let functions = names.into_iter().filter(|name| program.function(name).is_some());
    let fields = ["design"].into_iter().chain(functions).map(|name| format!("{name} = {name}"));
    page.line(&format!("return {{ {} }}", fields.collect::<Vec<_>>().join(", ")));
    page.text
}

/// A script that asks the module `name` for the answers to vectors and counts those with other bits; it prints
/// `N samples, M different`.
#[must_use]
pub fn lua_harness<R: Real>(program: &Program, name: &str, vectors: &[Vector<R>]) -> String {
    let writer = Writer { program };
    let mut page = Page::default();
    page.line(&format!("local controller = require(\"{name}\")"));
    if program.entry() == "step" {
        check_of_controller(&mut page, program);
    } else {
        check_of_system(&mut page, program);
    }
    let names: Vec<&str> =
        program.members(Part::Sample).iter().map(|member| member.name.as_str()).collect();
    let [_, marked] = program.answers();
    for vector in vectors {
        let sample: Vec<String> = names
            .iter()
            .zip(&vector.sample)
            .map(|(name, value)| format!("{name} = {}", writer.any(value.to_f64())))
            .collect();
        let reals = vector.answer.iter().map(|value| writer.any(value.to_f64()));
        let marks = marked.iter().zip(&vector.marks).map(|(name, mark)| {
            let holds_truth = program
                .answer
                .iter()
                .any(|member| member.name == *name && matches!(member.value, Value::Truth(_)));
            if holds_truth { (*mark != 0).to_string() } else { mark.to_string() }
        });
        let answer: Vec<String> = reals.chain(marks).collect();
        let event = if program.entry() == "step" {
            let given = writer.any(vector.event.given().to_f64());
            format!("{}, {given}, ", vector.event.number())
        } else {
            String::new()
        };
        page.line(&format!("check({event}{{ {} }}, {})", sample.join(", "), answer.join(", ")));
    }
    page.line(&format!(
        "print(string.format(\"{} samples, %d different\", different))",
        vectors.len()
    ));
    page.text
}

fn check_of_controller(page: &mut Page, program: &Program) {
    page.line("local state, answer, different = {}, {}, 0");
    page.line("controller.reset(controller.design, state)");
    page.line("local function same(a, b) return a == b and 1 / a == 1 / b end");
    let call = |name: &str| format!("controller.{name}(controller.design, state");
    page.line("local latched = 0");
    page.line("local function check(event, given, sample, command, kp, ki, kd, saturated, faults)");
    page.inside(|page| {
        page.line(&format!("if event == 1 then {}) end", call("reset")));
        page.line("if event == 4 and controller.faults(state) ~= latched then different = different + 1 end");
        for (event, name) in written_over(program) {
            page.line(&format!("if event == {event} then state.{name} = given end"));
        }
        page.line("if event == 2 then");
        page.line(&format!("    {}, answer, 1)", call("hold")));
        page.line("elseif event == 3 then");
        page.line(&format!("    {}, sample, answer, given)", call("track")));
        page.line("else");
        page.line(&format!("    {}, sample, answer)", call("step")));
        page.line("end");
        page.line("latched = faults");
        let command = &program.members(Part::Answer)[0].name;
        page.line(&format!("local good = same(answer.{command}, command) and same(answer.kp, kp)"));
        page.line("good = good and same(answer.ki, ki) and same(answer.kd, kd)");
        page.line("good = good and answer.saturated == saturated and answer.faults == faults");
        page.line("if not good then different = different + 1 end");
    });
    page.line("end");
}

fn check_of_system(page: &mut Page, program: &Program) {
    let [reals, marks] = program.answers();
    let given = |name: &str| {
        let parts = program.function(name).map_or(&[] as &[Part], |function| function.parts);
        let words = parts.iter().map(|part| match part {
            Part::Configuration => "controller.design",
            other => part_name(*other),
        });
        format!("controller.{name}({})", words.collect::<Vec<_>>().join(", "))
    };
    page.line("local state, answer, different = {}, {}, 0");
    if program.function("reset").is_some() {
        page.line(&given("reset"));
    }
    page.line("local function same(a, b) return a == b and 1 / a == 1 / b end");
    page.line("local function check(sample, ...)");
    page.inside(|page| {
        page.line(&given("infer"));
        page.line("local wanted = { ... }");
        page.line("local good = true");
        for (name, index) in reals.iter().zip(1..) {
            page.line(&format!("good = good and same(answer.{name}, wanted[{index}])"));
        }
        for (name, index) in marks.iter().zip(1 + reals.len()..) {
            page.line(&format!("good = good and answer.{name} == wanted[{index}]"));
        }
        page.line("if not good then different = different + 1 end");
    });
    page.line("end");
}

struct Writer<'a> {
    program: &'a Program,
}

impl Writer<'_> {
    fn is_single(&self) -> bool {
        self.program.precision == Precision::Single
    }

    /// A number that may not be finite.
    fn any(&self, value: f64) -> String {
        match value {
            value if value.is_nan() => "0.0 / 0.0".to_owned(),
            value if value.is_infinite() => {
                format!("{}1.0 / 0.0", if value < 0.0 { "-" } else { "" })
            }
            value => self.number(value),
        }
    }

    fn head(&self, page: &mut Page) {
        let (one, text) = match self.program.precision {
            Precision::Single => ("16777216.0", "32 bits (LUA_32BITS)"),
            Precision::Double => ("9007199254740992.0", "64 bits"),
        };
        let more = if self.is_single() {
            format!("{one} + 1.0 ~= {one}")
        } else {
            format!("{one} + 1.0 ~= {one} or {} + 1.0 == {}", "16777216.0", "16777216.0")
        };
        comment(page, &format!("Written for numbers of {text}; others would round otherwise."));
        page.line(&format!("if {more} then"));
        page.inside(|page| {
            page.line(&format!("error(\"this controller needs numbers of {text}\")"))
        });
        page.line("end");
        page.line("");
        page.line("local function magnitude(number)");
        page.inside(|page| {
            page.line("if number > 0.0 then return number else return 0.0 - number end")
        });
        page.line("end");
        page.line("");
        if self.program.function("exponential").is_some() {
            power_of_two(page);
        }
    }

    fn table(&self, page: &mut Page, name: &str, part: Part) {
        page.line(&format!("local {name} = {{"));
        page.inside(|page| {
            for Member { name, doc, value } in self.program.members(part) {
                comment(page, doc);
                page.line(&format!("{name} = {},", self.value(value)));
            }
        });
        page.line("}");
    }

    fn value(&self, value: &Value) -> String {
        let listed = |values: Vec<String>| match values.split_first() {
            Some((first, rest)) => format!("{{ [0] = {first}, {} }}", rest.join(", ")),
            None => "{}".to_owned(),
        };
        match value {
            Value::Real(value) => self.number(*value),
            Value::Reals(values) => {
                listed(values.iter().map(|value| self.number(*value)).collect())
            }
            Value::Bytes(values) => listed(values.iter().map(u8::to_string).collect()),
            Value::Byte(value) => value.to_string(),
            Value::Truth(value) => value.to_string(),
        }
    }

    fn function(&self, page: &mut Page, function: &Function) {
        comment(page, function.doc);
        let parts = function.parts.iter().map(|part| part_name(*part));
        let parameters = function.parameters.iter().map(|parameter| parameter.name);
        let all: Vec<&str> = parts.chain(parameters).collect();
        page.line(&format!("local function {}({})", function.name, all.join(", ")));
        page.inside(|page| block(self, page, &function.body));
        page.line("end");
    }
}

/// Products of exact powers: Lua has no bits of a number at hand.
fn power_of_two(page: &mut Page) {
    comment(page, "2 to the power of a whole number, by products of exact powers.");
    for line in [
        "local function power_of_two(exponent)",
        "    local factor, power, rest = 2.0, 1.0, exponent",
        "    if rest < 0.0 then factor, rest = 0.5, 0.0 - rest end",
        "    while rest >= 1.0 do",
        "        if rest % 2.0 == 1.0 then power, rest = power * factor, rest - 1.0 end",
        "        rest = rest / 2.0",
        "        if rest >= 1.0 then factor = factor * factor end",
        "    end",
        "    return power",
        "end",
        "",
    ] {
        page.line(line);
    }
}

fn comment(page: &mut Page, text: &str) {
    for line in wrapped(text, 92) {
        page.line(&format!("-- {line}"));
    }
}

impl Dialect for Writer<'_> {
    fn number(&self, value: f64) -> String {
        decimal(value, self.is_single())
    }

    fn byte(&self, value: u8) -> String {
        value.to_string()
    }

    fn truth(&self, value: bool) -> String {
        value.to_string()
    }

    fn truths(&self) -> Truths {
        Truths { not_equal: "~=", and: "and", or: "or" }
    }

    fn member(&self, part: Part, name: &str) -> String {
        format!("{}.{name}", part_name(part))
    }

    fn not(&self, value: &str) -> String {
        format!("not {value}")
    }

    fn magnitude(&self, value: &str) -> String {
        format!("magnitude({value})")
    }

    fn bits(&self, left: &str, right: &str) -> String {
        format!("{left} | {right}")
    }

    fn select(&self, condition: &str, then: &str, otherwise: &str) -> String {
        // A number is never false.
        format!("({condition} and {then} or {otherwise})")
    }

    fn to_real(&self, value: &str) -> String {
        format!("({value} + 0.0)")
    }

    fn power_of_two(&self, exponent: &str) -> String {
        format!("power_of_two({exponent})")
    }

    fn call(&self, name: &str, given: Vec<String>) -> String {
        format!("{name}({})", all_arguments(self.program, name, given, part_name))
    }

    fn remark(&self, page: &mut Page, text: &str) {
        comment(page, text);
    }

    fn declare(&self, page: &mut Page, name: &str, _: Kind, value: &str) {
        page.line(&format!("local {name} = {value}"));
    }

    fn declare_array(&self, page: &mut Page, name: &str, count: usize) {
        let rest = vec!["0.0"; count - 1].join(", ");
        page.line(&format!("local {name} = {{ [0] = 0.0, {rest} }}"));
    }

    fn assign(&self, page: &mut Page, place: &str, value: &str) {
        page.line(&format!("{place} = {value}"));
    }

    fn run(&self, page: &mut Page, call: &str) {
        page.line(call);
    }

    fn when(&self, condition: &str) -> String {
        format!("if {condition} then")
    }

    fn otherwise(&self) -> &'static str {
        "else"
    }

    fn repeat(&self, name: &str, first: i32, last: i32) -> String {
        format!("for {name} = {first}, {last} do")
    }

    fn end(&self, _: Block) -> &'static str {
        "end"
    }

    fn answer(&self, value: Option<&str>) -> Vec<String> {
        vec![
            value.map_or_else(
                || "do return end".to_owned(),
                |value| format!("do return {value} end"),
            ),
        ]
    }
}
