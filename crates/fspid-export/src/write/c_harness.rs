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
    let mut page = Page::default();
    for line in ["#include <stdint.h>", "#include <stdio.h>"] {
        page.line(line);
    }
    page.line(&format!("#include \"{prefix}.h\""));
    page.line("");
    page.line(&format!("static const {bits} vectors[{count}][7] = {{"));
    page.inside(|page| {
        for vector in vectors {
            let values = vector.sample.iter().chain(&vector.answer);
            let values: Vec<String> = values.map(|value| hex(*value, is_single)).collect();
            page.line(&format!("{{ {} }},", values.join(", ")));
        }
    });
    page.line("};");
    page.line(&format!("static const uint8_t marks[{count}][2] = {{"));
    page.inside(|page| {
        for vector in vectors {
            page.line(&format!("{{ {}U, {}U }},", u8::from(vector.saturated), vector.faults));
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
    main(&mut page, program, prefix, count);
    page.text
}

fn main(page: &mut Page, program: &Program, prefix: &str, count: usize) {
    page.line("");
    page.line("int main(void)");
    page.line("{");
    page.inside(|page| {
        page.line(&format!("{prefix}_state state;"));
        page.line(&format!("{prefix}_sample sample;"));
        page.line(&format!("{prefix}_answer answer;"));
        page.line("unsigned different = 0U;");
        page.line(&format!("{prefix}_reset(&{prefix}_design, &state);"));
        page.line(&format!("for (unsigned k = 0U; k < {count}U; ++k) {{"));
        page.inside(|page| {
            for (index, member) in program.members(Part::Sample).iter().enumerate() {
                page.line(&format!("sample.{} = real(vectors[k][{index}]);", member.name));
            }
            page.line(&format!("{prefix}_step(&{prefix}_design, &state, &sample, &answer);"));
            let command = &program.members(Part::Answer)[0].name;
            let same: Vec<String> = [command.as_str(), "kp", "ki", "kd"]
                .iter()
                .zip(3..)
                .map(|(name, index)| format!("bits_of(answer.{name}) == vectors[k][{index}]"))
                .chain([
                    "answer.saturated == marks[k][0]".to_owned(),
                    "answer.faults == marks[k][1]".to_owned(),
                ])
                .collect();
            page.line(&format!("if (!({})) {{", same.join(" && ")));
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

fn hex<R: Real>(value: R, is_single: bool) -> String {
    #[allow(clippy::cast_possible_truncation, reason = "numbers of a single program are singles")]
    let single = value.to_f64() as f32;
    if is_single {
        format!("{:#x}U", single.to_bits())
    } else {
        format!("{:#x}ULL", value.to_f64().to_bits())
    }
}
