//! C99, freestanding: one header and one source, with `stdint.h` and `float.h` alone.

use super::dialect::{Block, Dialect, Truths, all_arguments, block};
use super::{Heading, Page, decimal, wrapped};
use crate::program::{
    Expression, Function, Kind, Member, Parameter, Part, Precision, Program, Value,
};

/// The text of both files.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CFiles {
    /// The header.
    pub header: String,
    /// The source.
    pub source: String,
}

const PARTS: [Part; 4] = [Part::Configuration, Part::State, Part::Sample, Part::Answer];

/// The program in C; every name that others see begins with `prefix`.
#[must_use]
pub fn c(program: &Program, prefix: &str, heading: &Heading<'_>) -> CFiles {
    let writer = Writer { program, prefix };
    let lines = heading.lines().join("\n * ");
    let head = format!("/* {lines} */\n");
    CFiles { header: head.clone() + &writer.header(), source: head + &writer.source() }
}

/// A number as it is written in C.
pub(crate) fn c_number(program: &Program, value: f64) -> String {
    Writer { program, prefix: "" }.number(value)
}

/// An expression as it is written in C.
pub(crate) fn c_expression(program: &Program, prefix: &str, value: &Expression) -> String {
    super::dialect::outer(&Writer { program, prefix }, value)
}

/// What the preprocessor asks of a compiler before anything is built. Tools that read the code without its headers know none
/// of these words and pass.
const ARITHMETIC: &str = "\
#if defined(DIGITS) && (DIGITS != COUNT)
#error \"OTHER NUMBERS\"
#endif
#if defined(__FAST_MATH__) || (defined(__FINITE_MATH_ONLY__) && (__FINITE_MATH_ONLY__ != 0))
#error \"This controller needs the arithmetic of IEEE 754: build it without -ffast-math.\"
#endif
/* Define FSPID_OTHER_BITS to fly it where answers may differ in their last bits from those it was checked with. */
#if !defined(FSPID_OTHER_BITS)
#if defined(__ASSOCIATIVE_MATH__) || defined(__RECIPROCAL_MATH__) || defined(__NO_SIGNED_ZEROS__)
#error \"The bits of this controller need every operation as it is written: build it without -funsafe-math-optimizations.\"
#endif
#if defined(FLT_EVAL_METHOD) && (WIDER(FLT_EVAL_METHOD == 2) || (FLT_EVAL_METHOD == -1))
#error \"The bits of this controller need numbers that are rounded at every operation: for x86 build it with -msse2 -mfpmath=sse.\"
#endif
#endif
";

struct Writer<'a> {
    program: &'a Program,
    prefix: &'a str,
}

fn part_name(part: Part) -> &'static str {
    match part {
        Part::Configuration => "configuration",
        Part::State => "state",
        Part::Sample => "sample",
        Part::Answer => "answer",
    }
}

impl Writer<'_> {
    fn real(&self) -> &'static str {
        match self.program.precision {
            Precision::Single => "float",
            Precision::Double => "double",
        }
    }

    fn header(&self) -> String {
        let prefix = self.prefix;
        let guard = format!("{}_H", prefix.to_uppercase());
        let mut page = Page::default();
        page.line(&format!("#ifndef {guard}"));
        page.line(&format!("#define {guard}"));
        page.line("");
        page.line("#include <stdint.h>");
        page.line("");
        page.line("#ifdef __cplusplus");
        page.line("extern \"C\" {");
        page.line("#endif");
        for part in PARTS.into_iter().filter(|part| !self.program.members(*part).is_empty()) {
            page.line("");
            self.structure(&mut page, part);
        }
        if !self.program.configuration.is_empty() {
            page.line("");
            page.line("/* The design as it was tuned. */");
            page.line(&format!("extern const {prefix}_configuration {prefix}_design;"));
        }
        for function in self.program.functions.iter().filter(|function| is_public(function)) {
            page.line("");
            comment(&mut page, function.doc);
            page.line(&format!("{};", self.signature(function)));
        }
        if self.program.entry() == "step" {
            page.line("");
            comment(&mut page, super::c_selftest::DOC);
            let asked = format!("const {prefix}_configuration *configuration");
            page.line(&format!("uint16_t {prefix}_selftest({asked});"));
            page.line("");
            page.line("/* As before the first sample, with the design as it was tuned. */");
            page.line(&format!("void {prefix}_init({prefix}_state *state);"));
        }
        page.line("");
        page.line("#ifdef __cplusplus");
        page.line("}");
        page.line("#endif");
        page.line("");
        page.line("#endif");
        page.text
    }

    fn structure(&self, page: &mut Page, part: Part) {
        page.line("typedef struct {");
        page.inside(|page| {
            for member in self.program.members(part) {
                comment(page, &member.doc);
                page.line(&format!("{};", self.declared(member)));
            }
        });
        page.line(&format!("}} {}_{};", self.prefix, part_name(part)));
    }

    fn declared(&self, Member { name, value, .. }: &Member) -> String {
        match value {
            Value::Real(_) => format!("{} {name}", self.real()),
            Value::Reals(values) => format!("{} {name}[{}]", self.real(), values.len()),
            Value::Bytes(values) => format!("uint8_t {name}[{}]", values.len()),
            Value::Byte(_) | Value::Truth(_) => format!("uint8_t {name}"),
        }
    }

    fn source(&self) -> String {
        let prefix = self.prefix;
        let mut page = Page::default();
        page.line(&format!("#include \"{prefix}.h\""));
        page.line("#include <float.h>");
        page.line("");
        self.arithmetic(&mut page);
        page.line(
            "/* Products and sums are rounded one by one; for gcc build with -ffp-contract=off. */",
        );
        page.line("#if defined(__clang__) || !defined(__GNUC__)");
        page.line("#pragma STDC FP_CONTRACT OFF");
        page.line("#endif");
        page.line("");
        if !self.program.configuration.is_empty() {
            self.design(&mut page);
            page.line("");
        }
        self.magnitude(&mut page);
        if self.uses_power_of_two() {
            page.line("");
            self.power_of_two(&mut page);
        }
        for function in &self.program.functions {
            page.line("");
            self.function(&mut page, function);
        }
        if self.program.entry() == "step" {
            page.line("");
            page.line(&format!("void {prefix}_init({prefix}_state *state)"));
            page.line("{");
            page.inside(|page| page.line(&format!("{prefix}_reset(&{prefix}_design, state);")));
            page.line("}");
        }
        page.text
    }

    /// Stops compilers whose numbers are not those that the answers were computed with.
    fn arithmetic(&self, page: &mut Page) {
        let ([digits, count], wider) = match self.program.precision {
            Precision::Single => (["FLT_MANT_DIG", "24"], "(FLT_EVAL_METHOD == 1) || "),
            Precision::Double => (["DBL_MANT_DIG", "53"], ""),
        };
        let other = match self.program.precision {
            Precision::Single => "float has not the 32 bits of IEEE 754 here.",
            Precision::Double => {
                "double has not the 64 bits of IEEE 754 here, as on an AVR: export this controller with --numbers single."
            }
        };
        let text = ARITHMETIC
            .replace("DIGITS", digits)
            .replace("COUNT", count)
            .replace("OTHER NUMBERS", other)
            .replace("WIDER", wider);
        text.lines().for_each(|line| page.line(line));
    }

    fn design(&self, page: &mut Page) {
        page.line(&format!("const {0}_configuration {0}_design = {{", self.prefix));
        page.inside(|page| {
            for member in &self.program.configuration {
                let rule = |(text, place): (String, usize)| {
                    let rule = place + 1;
                    if member.is_rules() { format!("/* R{rule} */ {text}") } else { text }
                };
                let value = match &member.value {
                    Value::Real(value) => self.number(*value),
                    Value::Byte(value) => self.byte(*value),
                    Value::Truth(value) => self.truth(*value),
                    Value::Reals(values) => {
                        let texts = values.iter().map(|value| self.number(*value));
                        listed(texts.zip(0..).map(rule).collect())
                    }
                    Value::Bytes(values) => {
                        let texts = values.iter().map(|value| self.byte(*value));
                        listed(texts.zip(0..).map(rule).collect())
                    }
                };
                page.line(&format!("/* {} */", member.name));
                for line in format!("{value},").lines() {
                    page.line(line);
                }
            }
        });
        page.line("};");
    }

    fn magnitude(&self, page: &mut Page) {
        let (real, zero) = (self.real(), self.number(0.0));
        page.line(&format!("static {real} {}_magnitude({real} number)", self.prefix));
        page.line("{");
        page.inside(|page| {
            page.line(&format!("return (number > {zero}) ? number : ({zero} - number);"));
        });
        page.line("}");
    }

    fn uses_power_of_two(&self) -> bool {
        self.program.function("exponential").is_some()
    }

    fn power_of_two(&self, page: &mut Page) {
        let (real, bits, bias, shift) = match self.program.precision {
            Precision::Single => ("float", "32", 127, 23),
            Precision::Double => ("double", "64", 1023, 52),
        };
        page.line("/* 2 to the power of a whole number, by the bits of its exponent. */");
        page.line(&format!("static {real} {}_power_of_two({real} exponent)", self.prefix));
        page.line("{");
        page.inside(|page| {
            page.line(&format!("union {{ uint{bits}_t bits; {real} number; }} power;"));
            page.line(&format!("const int32_t biased = (int32_t)exponent + {bias};"));
            page.line(&format!("power.bits = (uint{bits}_t)biased << {shift};"));
            page.line("return power.number;");
        });
        page.line("}");
    }

    fn signature(&self, function: &Function) -> String {
        let prefix = self.prefix;
        let mut parameters: Vec<String> = function
            .parts
            .iter()
            .map(|part| {
                let name = part_name(*part);
                let constant = if self.program.writes(function, *part) { "" } else { "const " };
                format!("{constant}{prefix}_{name} *{name}")
            })
            .collect();
        parameters.extend(function.parameters.iter().map(|parameter| self.parameter(parameter)));
        let answers = function.answers.map_or("void", |kind| self.kind(kind));
        let hidden = if is_public(function) { "" } else { "static " };
        format!("{hidden}{answers} {prefix}_{}({})", function.name, parameters.join(", "))
    }

    fn parameter(&self, Parameter { name, kind, written }: &Parameter) -> String {
        let constant = if *written { "" } else { "const " };
        match kind {
            Kind::Reals(count) => format!("{constant}{} {name}[{count}]", self.real()),
            kind => format!("{} {name}", self.kind(*kind)),
        }
    }

    fn kind(&self, kind: Kind) -> &'static str {
        match kind {
            Kind::Real | Kind::Reals(_) => self.real(),
            Kind::Whole => "int32_t",
            Kind::Byte | Kind::Truth => "uint8_t",
        }
    }

    fn function(&self, page: &mut Page, function: &Function) {
        if !is_public(function) {
            comment(page, function.doc);
        }
        page.line(&self.signature(function));
        page.line("{");
        page.inside(|page| {
            let mut inside = Page { text: String::new(), depth: page.depth };
            block(self, &mut inside, &function.body);
            for part in function.parts.iter().map(|part| part_name(*part)) {
                if !inside.text.contains(part) {
                    page.line(&format!("(void){part};"));
                }
            }
            page.text.push_str(&inside.text);
        });
        page.line("}");
    }
}

impl Dialect for Writer<'_> {
    fn number(&self, value: f64) -> String {
        match self.program.precision {
            Precision::Single => format!("{}f", decimal(value, true)),
            Precision::Double => decimal(value, false),
        }
    }

    fn byte(&self, value: u8) -> String {
        format!("{value}U")
    }

    fn truth(&self, value: bool) -> String {
        format!("{}U", u8::from(value))
    }

    fn truths(&self) -> Truths {
        Truths { not_equal: "!=", and: "&&", or: "||" }
    }

    fn member(&self, part: Part, name: &str) -> String {
        format!("{}->{name}", part_name(part))
    }

    fn not(&self, value: &str) -> String {
        format!("!{value}")
    }

    fn magnitude(&self, value: &str) -> String {
        format!("{}_magnitude({value})", self.prefix)
    }

    /// Two comparisons tell a proof in intervals where the value lies; the magnitude does not.
    fn within(&self, value: &str, most: &str) -> Option<String> {
        let least = most.strip_prefix('-').map_or_else(|| format!("-{most}"), str::to_owned);
        Some(format!("({least} <= {value}) && ({value} <= {most})"))
    }

    fn bits(&self, left: &str, right: &str) -> String {
        format!("(uint8_t)({left} | {right})")
    }

    fn select(&self, condition: &str, then: &str, otherwise: &str) -> String {
        format!("({condition} ? {then} : {otherwise})")
    }

    fn to_real(&self, value: &str) -> String {
        format!("({}){value}", self.real())
    }

    fn power_of_two(&self, exponent: &str) -> String {
        format!("{}_power_of_two({exponent})", self.prefix)
    }

    fn call(&self, name: &str, given: Vec<String>) -> String {
        format!("{}_{name}({})", self.prefix, all_arguments(self.program, name, given, part_name))
    }

    fn remark(&self, page: &mut Page, text: &str) {
        comment(page, text);
    }

    fn declare(&self, page: &mut Page, name: &str, kind: Kind, value: &str) {
        page.line(&format!("{} {name} = {value};", self.kind(kind)));
    }

    fn declare_array(&self, page: &mut Page, name: &str, count: usize) {
        let zeros = vec![self.number(0.0); count].join(", ");
        page.line(&format!("{} {name}[{count}] = {{ {zeros} }};", self.real()));
    }

    fn assign(&self, page: &mut Page, place: &str, value: &str) {
        page.line(&format!("{place} = {value};"));
    }

    fn run(&self, page: &mut Page, call: &str) {
        page.line(&format!("{call};"));
    }

    fn when(&self, condition: &str) -> String {
        format!("if ({condition}) {{")
    }

    fn otherwise(&self) -> &'static str {
        "} else {"
    }

    fn repeat(&self, name: &str, first: i32, last: i32) -> String {
        format!("for (int32_t {name} = {first}; {name} <= {last}; ++{name}) {{")
    }

    fn end(&self, _: Block) -> &'static str {
        "}"
    }

    fn answer(&self, value: Option<&str>) -> Vec<String> {
        vec![value.map_or_else(|| "return;".to_owned(), |value| format!("return {value};"))]
    }
}

/// What others may call.
fn is_public(function: &Function) -> bool {
    matches!(function.name, "reset" | "step" | "hold" | "track" | "saturated" | "faults")
        || function.parts.contains(&Part::Answer)
}

fn comment(page: &mut Page, text: &str) {
    let lines = wrapped(text, 92);
    match lines.as_slice() {
        [line] => page.line(&format!("/* {line} */")),
        lines => {
            for (index, line) in lines.iter().enumerate() {
                let begin = if index == 0 { "/* " } else { " * " };
                let end = if index + 1 == lines.len() { " */" } else { "" };
                page.line(&format!("{begin}{line}{end}"));
            }
        }
    }
}

/// Values of an array, seven a line.
fn listed(values: Vec<String>) -> String {
    let rows: Vec<String> = values.chunks(7).map(|row| format!("    {}", row.join(", "))).collect();
    format!("{{\n{}\n}}", rows.join(",\n"))
}
