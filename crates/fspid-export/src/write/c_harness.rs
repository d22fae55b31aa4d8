//! A program in C that asks the exported C for the answers to vectors and counts those with other bits.

use fspid_numeric::Real;

use super::{Page, put};
use crate::program::{Part, Precision, Program};
use crate::vectors::{Vector, written_over};

/// The program; it prints `N samples, M different` and ends with 0 where M is 0.
#[must_use]
pub fn c_harness<R: Real>(program: &Program, prefix: &str, vectors: &[Vector<R>]) -> String {
    let is_single = program.precision == Precision::Single;
    let (real, bits) = if is_single { ("float", "uint32_t") } else { ("double", "uint64_t") };
    let count = vectors.len();
    let [reals, marks] = program.answers();
    // The vectors of a controller hold the rate also where it is not asked for.
    let inputs = vectors.first().map_or(0, |vector| vector.sample.len());
    let mut page = Page::default();
    for line in ["#include <stdint.h>", "#include <stdio.h>"] {
        page.line(line);
    }
    page.line(&format!("#include \"{prefix}.h\""));
    page.line("");
    let steps = is_controller(program);
    page.line("/* Sample, of a controller what is given with the event, answer. */");
    let columns = inputs + usize::from(steps) + reals.len();
    page.line(&format!("static const {bits} vectors[{count}][{columns}] = {{"));
    // A number has up to 13 or 22 characters.
    page.text.reserve(count * columns * if is_single { 13 } else { 22 });
    page.inside(|page| {
        for vector in vectors {
            let given = steps.then(|| vector.event.given());
            let values = vector.sample.iter().chain(&given).chain(&vector.answer);
            page.row(["{ ", " },"], |text| {
                put::list(text, ", ", values, |text, value| put_hex(text, *value, is_single));
            });
        }
    });
    page.line("};");
    page.line("/* Truths and bytes of the answer, event. */");
    page.line(&format!("static const uint8_t marks[{count}][{}] = {{", marks.len() + 1));
    page.inside(|page| {
        for vector in vectors {
            let event = vector.event.number();
            let marks = vector.marks.iter().chain([&event]);
            page.row(["{ ", "U },"], |text| {
                put::list(text, "U, ", marks, |text, mark| put::byte(text, *mark));
            });
        }
    });
    page.line("};");
    let unions = [
        format!(
            "static {real} real({bits} bits) {{ union {{ {bits} bits; {real} number; }} both; both.bits = bits; return both.number; }}"
        ),
        format!(
            "static {bits} bits_of({real} number) {{ union {{ {bits} bits; {real} number; }} both; both.number = number; return both.bits; }}"
        ),
    ];
    unions.iter().for_each(|line| page.line(line));
    main(&mut page, program, prefix, ([count, inputs], real));
    page.text
}

/// True of a program that does more than to answer samples.
fn is_controller(program: &Program) -> bool {
    program.entry() == "step"
}

fn main(
    page: &mut Page,
    program: &Program,
    prefix: &str,
    ([count, inputs], real): ([usize; 2], &str),
) {
    page.line("");
    page.line("int main(void)");
    page.line("{");
    page.inside(|page| {
        if !program.state.is_empty() {
            page.line(&format!("{prefix}_state state;"));
        }
        page.line(&format!("{prefix}_sample sample;"));
        page.line(&format!("{prefix}_answer answer;"));
        page.line("unsigned different = 0U;");
        if program.function("reset").is_some() {
            page.line(&called(program, prefix, "reset"));
        }
        page.line(&format!("for (unsigned k = 0U; k < {count}U; ++k) {{"));
        page.inside(|page| {
            for (index, member) in program.members(Part::Sample).iter().enumerate() {
                page.line(&format!("sample.{} = real(vectors[k][{index}]);", member.name));
            }
            let answers = if is_controller(program) {
                page.line(&format!("const {real} given = real(vectors[k][{inputs}]);"));
                // What nobody writes is not what it should be.
                page.line("answer.saturated = 1U;");
                page.line("answer.faults = 255U;");
                events(page, program, prefix);
                inputs + 1
            } else {
                page.line(&called(program, prefix, program.entry()));
                inputs
            };
            page.line(&format!("if (!({})) {{", same(program, prefix, answers)));
            page.inside(|page| {
                page.line("if (different == 0U) { printf(\"first at sample %u\\n\", k); }");
                page.line("++different;");
            });
            page.line("}");
        });
        page.line("}");
        page.line(&format!("printf(\"%u samples, %u different\\n\", {count}U, different);"));
        page.line("return different == 0U ? 0 : 1;");
    });
    page.line("}");
}

/// A call of a function that is given parts alone.
fn called(program: &Program, prefix: &str, name: &str) -> String {
    let parts = program.function(name).map_or(&[] as &[Part], |function| function.parts);
    let given = parts.iter().map(|part| match part {
        Part::Configuration => format!("&{prefix}_design"),
        Part::State => "&state".to_owned(),
        Part::Sample => "&sample".to_owned(),
        Part::Answer => "&answer".to_owned(),
    });
    format!("{prefix}_{name}({});", given.collect::<Vec<_>>().join(", "))
}

/// True where every member of the answer is the one of the vector.
fn same(program: &Program, prefix: &str, first: usize) -> String {
    let [reals, marks] = program.answers();
    let reals = reals
        .iter()
        .zip(first..)
        .map(|(name, index)| format!("bits_of(answer.{name}) == vectors[k][{index}]"));
    let marks = marks.iter().zip(0..).map(|(name, index)| match *name {
        "saturated" => format!("{prefix}_saturated(&answer) == marks[k][{index}]"),
        name => format!("answer.{name} == marks[k][{index}]"),
    });
    reals.chain(marks).collect::<Vec<_>>().join(" && ")
}

/// What is done at a vector.
fn events(page: &mut Page, program: &Program, prefix: &str) {
    let call =
        |name: &str, more: &str| format!("{prefix}_{name}(&{prefix}_design, &state, {more}&answer");
    page.line("switch (marks[k][2]) {");
    page.line(&format!("case 1U: {prefix}_reset(&{prefix}_design, &state); break;"));
    page.line("case 4U:");
    let all = format!("{prefix}_faults(&state) != (k > 0U ? marks[k - 1U][1] : 0U)");
    page.line(&format!("    if ({all}) {{ ++different; }}"));
    page.line("    break;");
    for (number, name) in written_over(program) {
        page.line(&format!("case {number}U: state.{name} = given; break;"));
    }
    page.line("default: break;");
    page.line("}");
    page.line(&format!("if (marks[k][2] == 2U) {{ {}, 1U); }}", call("hold", "")));
    page.line(&format!(
        "else if (marks[k][2] == 3U) {{ {}, given); }}",
        call("track", "&sample, ")
    ));
    page.line(&format!("else {{ {}); }}", call("step", "&sample, ")));
}

/// The bits of a number.
pub(super) fn hex<R: Real>(value: R, is_single: bool) -> String {
    let mut text = String::new();
    put_hex(&mut text, value, is_single);
    text
}

fn put_hex<R: Real>(text: &mut String, value: R, is_single: bool) {
    put::bits(text, value.to_f64(), is_single);
    text.push_str(if is_single { "U" } else { "ULL" });
}
