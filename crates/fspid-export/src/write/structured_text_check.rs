//! A program in Structured Text that asks the function block for its answers and counts those that differ.

use fspid_numeric::Real;

use super::structured_text::{array, events, real, real_literal, remark, statement, visible_name};
use super::{Heading, Page};
use crate::interpret::{Cell, Machine};
use crate::program::{Part, Program};
use crate::vectors::Stretch;

/// How many samples it has at most: they lie in the memory of the controller that runs it.
pub(crate) const MOST_SAMPLES: usize = 400;

/// The program `PRG_<prefix>_check`: a sample a cycle, so that no watchdog minds, each stretch from a reset on. Samples
/// that are not finite are left out, because the language has no literals for them.
#[must_use]
pub fn structured_text_check<R: Real>(
    program: &Program,
    prefix: &str,
    heading: &Heading<'_>,
    stretches: &[Stretch<R>],
) -> String {
    let columns = columns(program, stretches);
    let count = columns.first().map_or(0, |column| column.values.len());
    let mut page = Page::default();
    heading.lines().iter().for_each(|line| remark(&mut page, line));
    let about = format!(
        "Asks FB_{prefix} for {count} answers, one a cycle, and counts in check_different those that are not the expected \
         numbers; they are all asked when check_index is {count}."
    );
    remark(&mut page, &about);
    page.line(&format!("PROGRAM PRG_{prefix}_check"));
    declarations(&mut page, prefix, &columns);
    body(&mut page, &columns, count, idle(program));
    page.line("END_PROGRAM");
    page.text
}

/// A value of each sample.
struct Column {
    part: Part,
    name: String,
    /// As the function block calls it.
    visible: String,
    kind: &'static str,
    values: Vec<String>,
}

impl Column {
    /// What its list is called.
    fn list(&self) -> String {
        let before = if self.part == Part::Sample { "given" } else { "expected" };
        format!("{before}_{}", self.name)
    }
}

fn columns<R: Real>(program: &Program, stretches: &[Stretch<R>]) -> Vec<Column> {
    let mut machine = Machine::new(program);
    let mut columns = Vec::new();
    for part in [Part::Sample, Part::Answer] {
        for member in program.members(part) {
            let name = member.name.clone();
            let kind = match machine.member(part, &name) {
                Some(Cell::Byte(_)) => "BYTE",
                Some(Cell::Truth(_)) => "BOOL",
                _ => real(program.precision),
            };
            let visible = visible_name(program, part, &name);
            columns.push(Column { part, name, visible, kind, values: Vec::new() });
        }
    }
    let is_good = |sample: &&Vec<R>| sample.iter().all(|value| value.to_f64().is_finite());
    let good = stretches.iter().flat_map(|stretch| {
        stretch.iter().filter(is_good).enumerate().map(|(place, sample)| (place == 0, sample))
    });
    let mut begins = Vec::new();
    for (is_first, sample) in good.take(MOST_SAMPLES) {
        if is_first && program.function("reset").is_some() {
            machine.run("reset");
        }
        begins.push(if is_first { "TRUE" } else { "FALSE" }.to_owned());
        for (member, value) in program.members(Part::Sample).iter().zip(sample) {
            machine.set(Part::Sample, &member.name, Cell::Real(*value));
        }
        machine.run(program.entry());
        for column in &mut columns {
            let cell = machine.member(column.part, &column.name);
            column.values.extend(cell.map(|cell| literal(program, cell)));
        }
    }
    if program.function("reset").is_some() {
        columns.insert(0, resets(begins));
    }
    columns
}

/// An input beside the sample: TRUE where a stretch begins.
fn resets(values: Vec<String>) -> Column {
    let (name, visible) = ("reset".to_owned(), "reset".to_owned());
    Column { part: Part::Sample, name, visible, kind: "BOOL", values }
}

fn literal<R: Real>(program: &Program, cell: &Cell<R>) -> String {
    match cell {
        Cell::Real(value) => real_literal(value.to_f64(), program.precision),
        Cell::Byte(value) => format!("BYTE#16#{value:02X}"),
        Cell::Truth(value) => if *value { "TRUE" } else { "FALSE" }.to_owned(),
        Cell::Whole(_) | Cell::Reals(_) | Cell::Bytes(_) => {
            unreachable!("neither samples nor answers hold lists or whole numbers")
        }
    }
}

fn declarations(page: &mut Page, prefix: &str, columns: &[Column]) {
    page.line("VAR");
    page.inside(|page| {
        page.line(&format!("controller : FB_{prefix};"));
        page.line("check_index : DINT := DINT#0;");
        page.line("check_different : DINT := DINT#0;");
        page.line("check_good : BOOL := FALSE;");
        for column in columns {
            let list = array(column.kind, &column.values);
            let declared = format!("{} : {list};", column.list());
            declared.lines().for_each(|line| page.line(line));
        }
    });
    page.line("END_VAR");
}

/// The inputs beside the sample and the reset: nothing is done with them.
fn idle(program: &Program) -> Vec<String> {
    let idle = |(name, kind, _): (String, &str, &str)| match kind {
        "BOOL" => format!("{name} := FALSE"),
        kind => format!("{name} := {kind}#0.0"),
    };
    events(program).into_iter().filter(|(name, ..)| name != "reset").map(idle).collect()
}

fn body(page: &mut Page, columns: &[Column], count: usize, idle: Vec<String>) {
    let of = |column: &Column| format!("{}[check_index]", column.list());
    let (given, expected): (Vec<_>, Vec<_>) =
        columns.iter().partition(|column| column.part == Part::Sample);
    page.line(&format!("IF check_index < DINT#{count} THEN"));
    page.inside(|page| {
        let inputs = given.iter().map(|column| format!("{} := {}", column.visible, of(column)));
        let inputs: Vec<String> = idle.into_iter().chain(inputs).collect();
        let inputs = inputs.join(", ");
        statement(page, &format!("controller({inputs});"));
        page.line("check_good := TRUE;");
        for column in expected {
            page.line(&format!("IF controller.{} <> {} THEN", column.visible, of(column)));
            page.inside(|page| page.line("check_good := FALSE;"));
            page.line("END_IF;");
        }
        page.line("IF NOT (check_good) THEN");
        page.inside(|page| page.line("check_different := check_different + DINT#1;"));
        page.line("END_IF;");
        page.line("check_index := check_index + DINT#1;");
    });
    page.line("END_IF;");
}
