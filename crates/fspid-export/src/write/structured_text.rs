//! Structured Text of IEC 61131-3: one function block that needs nothing else.
//!
//! Every literal has its type, every operation its brackets, every name one in front that no compiler has reserved.
//! There is no function, no conditional expression and no named type, because compilers differ most in these.

use super::dialect::{Block, Dialect, Truths, block};
use super::{Heading, Page, decimal, wrapped};
use crate::flat::{Flat, flatten};
use crate::program::{
    Expression, Kind, Member, Part, Place, Precision, Program, Statement, Value, local,
};

/// The program as the function block `FB_<prefix>`.
#[must_use]
pub fn structured_text(program: &Program, prefix: &str, heading: &Heading<'_>) -> String {
    let flat = flatten(program);
    let writer = Writer { program, flat: &flat };
    let mut page = Page::default();
    heading.lines().iter().for_each(|line| remark(&mut page, line));
    if program.function("reset").is_some() {
        remark(&mut page, ABOUT);
    }
    page.line(&format!("FUNCTION_BLOCK FB_{prefix}"));
    writer.inputs_and_outputs(&mut page);
    writer.configuration(&mut page);
    writer.memory(&mut page);
    writer.body(&mut page);
    page.line("END_FUNCTION_BLOCK");
    page.text
}

const ABOUT: &str = "Call it once every period. While `reset` is TRUE it forgets everything first, so that each answer \
                     is that to a first sample.";

/// A real with its type; it must be finite.
pub(super) fn real_literal(value: f64, precision: Precision) -> String {
    let text = decimal(value, precision == Precision::Single).replace('e', "E");
    format!("{}#{text}", real(precision))
}

/// The type of a real.
pub(super) fn real(precision: Precision) -> &'static str {
    match precision {
        Precision::Single => "REAL",
        Precision::Double => "LREAL",
    }
}

/// The name of an input or output. Those of a controller are no word of any compiler; those of a fuzzy system are its
/// user's, and get a part in front.
pub(super) fn visible_name(program: &Program, part: Part, name: &str) -> String {
    match part {
        _ if program.entry() == "step" => name.to_owned(),
        Part::Sample => format!("in_{name}"),
        _ => format!("out_{name}"),
    }
}

/// Inputs beside the sample: what is done with a controller besides a step. Name, type, what it is.
pub(super) fn events(program: &Program) -> Vec<(String, &'static str, &'static str)> {
    let mut events = Vec::new();
    if program.function("reset").is_some() {
        events.push(("reset".to_owned(), "BOOL", "Forget everything first."));
    }
    if program.function("faults").is_some() {
        let doc = "Clear what was latched first.";
        events.push(("clear_faults".to_owned(), "BOOL", doc));
    }
    if let Some(track) = program.function("track") {
        let doc = "Another commands; take part, so that taking over from it bumps nothing.";
        events.push(("track".to_owned(), "BOOL", doc));
        events.extend(track.parameters.iter().map(|given| {
            (format!("track_{}", given.name), real(program.precision), "What the other commands.")
        }));
    }
    events
}

/// A remark in the brackets that every compiler knows.
pub(super) fn remark(page: &mut Page, text: &str) {
    for line in wrapped(&text.replace('`', "'"), 92) {
        page.line(&format!("(* {line} *)"));
    }
}

/// `ARRAY[..] OF kind := [..]`, some values a line.
pub(super) fn array(kind: &str, values: &[String]) -> String {
    // Reals of seventeen digits are too wide for seven in a row.
    let in_row = if kind == "LREAL" { 3 } else { 7 };
    let rows: Vec<String> =
        values.chunks(in_row).map(|row| format!("    {}", row.join(", "))).collect();
    let last = values.len().saturating_sub(1);
    format!("ARRAY[0..{last}] OF {kind} := [\n{}\n]", rows.join(",\n"))
}

/// A statement on as many lines as it needs.
pub(super) fn statement(page: &mut Page, text: &str) {
    let lines = wrapped(text, 92);
    if let Some((first, rest)) = lines.split_first() {
        page.line(first);
        page.inside(|page| rest.iter().for_each(|line| page.line(line)));
    }
}

struct Writer<'a> {
    program: &'a Program,
    flat: &'a Flat,
}

impl Writer<'_> {
    fn real(&self) -> &'static str {
        real(self.program.precision)
    }

    fn inputs_and_outputs(&self, page: &mut Page) {
        page.line("VAR_INPUT");
        page.inside(|page| {
            for (name, kind, doc) in events(self.program) {
                remark(page, doc);
                page.line(&format!("{name} : {kind};"));
            }
        });
        self.members(page, Part::Sample);
        page.line("END_VAR");
        page.line("VAR_OUTPUT");
        self.members(page, Part::Answer);
        page.line("END_VAR");
    }

    fn configuration(&self, page: &mut Page) {
        let is_list = |member: &&Member| matches!(member.value, Value::Reals(_) | Value::Bytes(_));
        let (lists, numbers): (Vec<_>, Vec<_>) =
            self.program.configuration.iter().partition(is_list);
        let declare = |page: &mut Page, members: Vec<&Member>| {
            page.inside(|page| {
                members.into_iter().for_each(|it| self.member(page, Part::Configuration, it))
            });
        };
        page.line("VAR CONSTANT");
        declare(page, numbers);
        page.line("END_VAR");
        if lists.is_empty() && self.flat.powers.is_none() {
            return;
        }
        remark(page, "Nothing writes into these; not every compiler takes lists as constants.");
        page.line("VAR");
        declare(page, lists);
        if let Some((name, value)) = &self.flat.powers {
            let doc = "Exact powers of two, of which others are products.".to_owned();
            let powers = Member { name: (*name).to_owned(), doc, value: value.clone() };
            declare(page, vec![&powers]);
        }
        page.line("END_VAR");
    }

    fn memory(&self, page: &mut Page) {
        if !self.program.state.is_empty() {
            page.line("VAR");
            self.members(page, Part::State);
            page.line("END_VAR");
        }
        page.line("VAR_TEMP");
        page.inside(|page| {
            for (name, kind) in &self.flat.values {
                page.line(&format!("{name} : {};", self.kind(*kind)));
            }
        });
        page.line("END_VAR");
    }

    fn members(&self, page: &mut Page, part: Part) {
        page.inside(|page| {
            self.program.members(part).iter().for_each(|member| self.member(page, part, member));
        });
    }

    fn member(&self, page: &mut Page, part: Part, Member { name, doc, value }: &Member) {
        remark(page, doc);
        let name = self.member_name(part, name);
        let declared = format!("{name} : {};", self.declared(part, value));
        declared.lines().for_each(|line| page.line(line));
    }

    fn declared(&self, part: Part, value: &Value) -> String {
        let single = |kind: &str, value: String| match part {
            Part::Sample | Part::Answer => kind.to_owned(),
            Part::Configuration | Part::State => format!("{kind} := {value}"),
        };
        match value {
            Value::Real(value) => single(self.real(), self.number(*value)),
            Value::Byte(value) => single("BYTE", self.byte(*value)),
            Value::Truth(value) => single("BOOL", self.truth(*value)),
            Value::Reals(values) => {
                let values: Vec<String> = values.iter().map(|value| self.number(*value)).collect();
                array(self.real(), &values)
            }
            Value::Bytes(values) => {
                let values: Vec<String> =
                    values.iter().map(|value| format!("USINT#{value}")).collect();
                array("USINT", &values)
            }
        }
    }

    fn kind(&self, kind: Kind) -> String {
        match kind {
            Kind::Real => self.real().to_owned(),
            Kind::Reals(count) => {
                format!("ARRAY[0..{}] OF {}", count.saturating_sub(1), self.real())
            }
            Kind::Whole => "DINT".to_owned(),
            Kind::Byte => "BYTE".to_owned(),
            Kind::Truth => "BOOL".to_owned(),
        }
    }

    fn member_name(&self, part: Part, name: &str) -> String {
        match part {
            Part::Configuration => format!("design_{name}"),
            Part::State => format!("state_{name}"),
            Part::Sample | Part::Answer => visible_name(self.program, part, name),
        }
    }

    fn body(&self, page: &mut Page) {
        let when = |page: &mut Page, input: &str, body: &[Statement]| {
            block(self, page, &[Statement::when(local(input), body.to_vec())]);
        };
        if !self.flat.reset.is_empty() {
            when(page, "reset", &self.flat.reset);
        }
        if self.program.function("faults").is_some() {
            let none = Expression::Byte(0);
            when(page, "clear_faults", &[Statement::set_member(Part::State, "faults", none)]);
        }
        let [before, behind] = self.flat.track.clone().unwrap_or_default();
        if !before.is_empty() {
            when(page, "track", &before);
        }
        block(self, page, &self.flat.step);
        if !behind.is_empty() {
            when(page, "track", &behind);
        }
    }

    /// True if a member is a list of small whole numbers.
    fn is_bytes(&self, name: &str) -> bool {
        let mut members = self.program.configuration.iter();
        members.any(|member| member.name == name && matches!(member.value, Value::Bytes(_)))
    }
}

impl Dialect for Writer<'_> {
    fn number(&self, value: f64) -> String {
        real_literal(value, self.program.precision)
    }

    fn byte(&self, value: u8) -> String {
        format!("BYTE#16#{value:02X}")
    }

    fn truth(&self, value: bool) -> String {
        if value { "TRUE" } else { "FALSE" }.to_owned()
    }

    fn whole(&self, value: i32) -> String {
        format!("DINT#{value}")
    }

    fn equal(&self) -> &'static str {
        "="
    }

    fn truths(&self) -> Truths {
        Truths { not_equal: "<>", and: "AND", or: "OR" }
    }

    fn member(&self, part: Part, name: &str) -> String {
        self.member_name(part, name)
    }

    fn read(&self, place: &Place, text: String) -> String {
        match place {
            Place::MemberElement(Part::Configuration, name, _) if self.is_bytes(name) => {
                format!("USINT_TO_DINT({text})")
            }
            _ => text,
        }
    }

    fn not(&self, value: &str) -> String {
        // A function in some compilers' eyes and an operator in others': both take it so.
        if value.starts_with('(') { format!("NOT {value}") } else { format!("NOT ({value})") }
    }

    fn magnitude(&self, value: &str) -> String {
        format!("ABS({value})")
    }

    fn bits(&self, left: &str, right: &str) -> String {
        format!("({left} OR {right})")
    }

    fn select(&self, condition: &str, _: &str, _: &str) -> String {
        unreachable!("a flat program has no choice inside of an expression, such as by {condition}")
    }

    fn to_real(&self, value: &str) -> String {
        format!("DINT_TO_{}({value})", self.real())
    }

    fn power_of_two(&self, exponent: &str) -> String {
        unreachable!("a flat program has no power of two, such as that of {exponent}")
    }

    fn call(&self, name: &str, _: Vec<String>) -> String {
        unreachable!("a flat program does not call {name}")
    }

    fn remark(&self, page: &mut Page, text: &str) {
        remark(page, text);
    }

    fn declare(&self, page: &mut Page, name: &str, _: Kind, value: &str) {
        self.assign(page, name, value);
    }

    fn declare_array(&self, _: &mut Page, name: &str, _: usize) {
        unreachable!("the list {name} of a flat program is declared before its statements")
    }

    fn assign(&self, page: &mut Page, place: &str, value: &str) {
        statement(page, &format!("{place} := {value};"));
    }

    fn run(&self, page: &mut Page, call: &str) {
        page.line(&format!("{call};"));
    }

    fn when(&self, condition: &str) -> String {
        format!("IF {condition} THEN")
    }

    fn open(&self, page: &mut Page, text: &str) {
        statement(page, text);
    }

    fn otherwise(&self) -> &'static str {
        "ELSE"
    }

    fn repeat(&self, name: &str, first: i32, last: i32) -> String {
        format!("FOR {name} := DINT#{first} TO DINT#{last} DO")
    }

    fn end(&self, block: Block) -> &'static str {
        match block {
            Block::If => "END_IF;",
            Block::For => "END_FOR;",
        }
    }

    fn answer(&self, _: Option<&str>) -> Vec<String> {
        vec!["RETURN;".to_owned()]
    }
}
