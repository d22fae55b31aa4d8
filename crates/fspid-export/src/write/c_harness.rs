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
    page.line("/* Sample, what is given with the event, answer. */");
    page.line(&format!("static const {bits} vectors[{count}][8] = {{"));
    page.inside(|page| {
        for vector in vectors {
            let given = vector.event.given();
            let values = vector.sample.iter().chain([&given]).chain(&vector.answer);
            let values: Vec<String> = values.map(|value| hex(*value, is_single)).collect();
            page.line(&format!("{{ {} }},", values.join(", ")));
        }
    });
    page.line("};");
    page.line("/* Saturated, faults, event. */");
    page.line(&format!("static const uint8_t marks[{count}][3] = {{"));
    page.inside(|page| {
        for Vector { saturated, faults, event, .. } in vectors {
            page.line(&format!("{{ {}U, {faults}U, {}U }},", u8::from(*saturated), event.number()));
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
    main(&mut page, program, prefix, (count, real));
    page.text
}

fn main(page: &mut Page, program: &Program, prefix: &str, (count, real): (usize, &str)) {
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
            page.line(&format!("const {real} given = real(vectors[k][3]);"));
            events(page, program, prefix);
            let command = &program.members(Part::Answer)[0].name;
            let same: Vec<String> = [command.as_str(), "kp", "ki", "kd"]
                .iter()
                .zip(4..)
                .map(|(name, index)| format!("bits_of(answer.{name}) == vectors[k][{index}]"))
                .chain([
                    format!("{prefix}_saturated(&answer) == marks[k][0]"),
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

/// What is done at a vector.
fn events(page: &mut Page, program: &Program, prefix: &str) {
    let call =
        |name: &str, more: &str| format!("{prefix}_{name}(&{prefix}_design, &state, {more}&answer");
    let has = |name: &str| program.members(Part::State).iter().any(|member| member.name == name);
    page.line("switch (marks[k][2]) {");
    page.line(&format!("case 1U: {prefix}_reset(&{prefix}_design, &state); break;"));
    page.line("case 4U:");
    let all = format!("{prefix}_faults(&state) != (k > 0U ? marks[k - 1U][1] : 0U)");
    page.line(&format!("    if ({all}) {{ ++different; }}"));
    page.line("    break;");
    for (name, number) in [("command_rad", 5), ("integral", 6), ("kp", 7), ("ki", 8), ("kd", 9)] {
        if has(name) {
            page.line(&format!("case {number}U: state.{name} = given; break;"));
        }
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
    #[allow(clippy::cast_possible_truncation, reason = "numbers of a single program are singles")]
    let single = value.to_f64() as f32;
    if is_single {
        format!("{:#x}U", single.to_bits())
    } else {
        format!("{:#x}ULL", value.to_f64().to_bits())
    }
}
