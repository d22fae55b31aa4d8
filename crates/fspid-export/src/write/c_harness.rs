//! A program in C that asks the exported C for the answers to vectors and counts those with other bits.

use fspid_numeric::Real;

use super::Page;
use crate::program::{Part, Precision, Program};
use crate::vectors::Vector;

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
    page.line(&format!("static const {bits} vectors[{count}][{}] = {{", inputs + reals.len()));
    page.inside(|page| {
        for vector in vectors {
            let values = vector.sample.iter().chain(&vector.answer);
            let values: Vec<String> = values.map(|value| hex(*value, is_single)).collect();
            page.line(&format!("{{ {} }},", values.join(", ")));
        }
    });
    page.line("};");
    page.line(&format!("static const uint8_t marks[{count}][{}] = {{", marks.len()));
    page.inside(|page| {
        for vector in vectors {
            let values: Vec<String> = vector.marks.iter().map(|mark| format!("{mark}U")).collect();
            page.line(&format!("{{ {} }},", values.join(", ")));
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
    main(&mut page, program, prefix, [count, inputs]);
    page.text
}

fn main(page: &mut Page, program: &Program, prefix: &str, [count, inputs]: [usize; 2]) {
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
            page.line(&called(program, prefix, program.entry()));
            page.line(&format!("if (!({})) {{", same(program, inputs)));
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
fn same(program: &Program, inputs: usize) -> String {
    let [reals, marks] = program.answers();
    let reals = reals
        .iter()
        .zip(inputs..)
        .map(|(name, index)| format!("bits_of(answer.{name}) == vectors[k][{index}]"));
    let marks =
        marks.iter().zip(0..).map(|(name, index)| format!("answer.{name} == marks[k][{index}]"));
    reals.chain(marks).collect::<Vec<_>>().join(" && ")
}

fn hex<R: Real>(value: R, is_single: bool) -> String {
    #[allow(clippy::cast_possible_truncation, reason = "numbers of a single program are singles")]
    let single = value.to_f64() as f32;
    if is_single {
        format!("{:#x}U", single.to_bits())
    } else {
        format!("{:#x}ULL", value.to_f64().to_bits())
    }
}
