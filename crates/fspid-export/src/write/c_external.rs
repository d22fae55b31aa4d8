//! The exported C behind the functions of `fspid_external.h`, so that fspid can fly what it has written.

use super::{Heading, Page, decimal};
use crate::program::{Part, Precision, Program};

/// The header that a controller from outside keeps to.
pub const EXTERNAL_HEADER: &str = include_str!("fspid_external.h");

/// Degrees in a radian, in C with 64 bits.
const DEGREES: &str = "57.29577951308232";

/// The source that gives the exported code these functions; it stands in a folder of its own below that code.
#[must_use]
pub fn c_external(program: &Program, prefix: &str, period_s: f64, heading: &Heading<'_>) -> String {
    let mut page = Page::default();
    page.line(&format!("/* {} */", heading.lines().join("\n * ")));
    page.line("#include \"fspid_external.h\"");
    page.line(&format!("#include \"../{prefix}.h\""));
    let constants = [
        ("uint32_t fspid_external_version(void)", "FSPID_EXTERNAL_VERSION".to_owned()),
        ("double fspid_external_period_s(void)", decimal(period_s, false)),
        ("size_t fspid_external_state_bytes(void)", format!("sizeof({prefix}_state)")),
    ];
    for (signature, value) in constants {
        function(&mut page, signature, &[format!("return {value};")]);
    }
    let reset = format!("{prefix}_reset(&{prefix}_design, ({prefix}_state *)state);");
    function(&mut page, "void fspid_external_reset(void *state)", &[reset]);
    page.line("");
    page.line("void fspid_external_step(void *state, const fspid_external_sample *sample,");
    page.line("                         fspid_external_answer *answer)");
    body(&mut page, &step(program, prefix));
    page.text
}

fn function(page: &mut Page, signature: &str, lines: &[String]) {
    page.line("");
    page.line(signature);
    body(page, lines);
}

fn body(page: &mut Page, lines: &[String]) {
    page.line("{");
    page.inside(|page| lines.iter().for_each(|line| page.line(line)));
    page.line("}");
}

fn step(program: &Program, prefix: &str) -> Vec<String> {
    let mut lines = vec![format!("{prefix}_sample seen;"), format!("{prefix}_answer given;")];
    // In the order of every program: set-point, measurement and, where it matters, rate.
    let names = ["setpoint_rad", "measurement_rad", "rate_rad_s"];
    for (member, name) in program.members(Part::Sample).iter().zip(names) {
        let value = match is_in_degrees(&member.name) {
            true => format!("(sample->{name} * {DEGREES})"),
            false => format!("sample->{name}"),
        };
        lines.push(match program.precision {
            Precision::Single => format!("seen.{} = (float){value};", member.name),
            Precision::Double => format!("seen.{} = {value};", member.name),
        });
    }
    lines.push(format!("{prefix}_step(&{prefix}_design, ({prefix}_state *)state, &seen, &given);"));
    for member in program.members(Part::Answer) {
        let name = &member.name;
        lines.push(match name.as_str() {
            "kp" | "ki" | "kd" => format!("answer->{name} = (double)given.{name};"),
            "saturated" | "faults" => format!("answer->{name} = given.{name};"),
            _ if is_in_degrees(name) => {
                format!("answer->command_rad = (double)given.{name} / {DEGREES};")
            }
            _ => format!("answer->command_rad = (double)given.{name};"),
        });
    }
    lines
}

fn is_in_degrees(name: &str) -> bool {
    name.contains("_deg")
}
