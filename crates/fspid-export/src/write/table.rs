//! A surface as a table in C, as CSV, and a program that asks the C for drawn inputs.

use super::{Heading, Page, decimal};
use crate::table::{Deviation, SurfaceTable, infer, single};
use crate::vectors::Draw;
use fspid_core::fuzzy::Supervisor;

/// The outputs in the order of all arrays here.
const OUTPUTS: [&str; 3] = ["kp", "ki", "kd"];

/// The text of the files.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TableFiles {
    /// The header of both tables.
    pub header: String,
    /// The table of 32 bits.
    pub single: String,
    /// The table of 16 bits.
    pub short: String,
}

/// Which of the two tables.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Width {
    Single,
    Short,
}

impl Width {
    fn name(self) -> &'static str {
        match self {
            Self::Single => "f32",
            Self::Short => "i16",
        }
    }
}

/// The tables in C; every name that others see begins with `prefix` and `_table`.
#[must_use]
pub fn table(table: &SurfaceTable, prefix: &str, heading: &Heading<'_>) -> TableFiles {
    let head = format!("/* {} */\n", heading.of_table().join("\n * "));
    let source = |width| head.clone() + &source(table, prefix, width);
    let (single, short) = (source(Width::Single), source(Width::Short));
    TableFiles { header: head.clone() + &header(table, prefix), single, short }
}

fn header(table: &SurfaceTable, prefix: &str) -> String {
    let guard = format!("{}_TABLE_H", prefix.to_uppercase());
    let outside = if table.clamps {
        "An input beyond the range is moved to its end."
    } else {
        "An input beyond the range is refused."
    };
    let mut page = Page::default();
    for line in
        [&format!("#ifndef {guard}"), &format!("#define {guard}"), "", "#include <stdint.h>", ""]
    {
        page.line(line);
    }
    page.line(&format!(
        "/* Increments of kp, ki and kd over error and its change, each from -{0} to {0}: {1} points along each,",
        decimal(f64::from(table.range), true),
        table.points
    ));
    page.line(" * bilinear in between, in the supervisor's own units (behind its input scales and set centres, before its output");
    page.line(&format!(" * scales). {outside}"));
    page.line(" * How far they are off the centre of gravity: proved for every input by interval arithmetic, rounding included; and");
    page.line(" * the largest difference and the root of the mean square of 100000 drawn inputs.");
    for (width, deviations) in [("f32", &table.single), ("i16", &table.short)] {
        for (name, Deviation { proved, seen, rms }) in OUTPUTS.iter().zip(deviations) {
            page.line(&format!(
                " * {width} {name}: at most {}; seen {seen:.3e}, {rms:.3e}",
                above(*proved)
            ));
        }
    }
    page.line(" */");
    for line in ["#ifdef __cplusplus", "extern \"C\" {", "#endif"] {
        page.line(line);
    }
    for width in [Width::Single, Width::Short] {
        let name = width.name();
        page.line("");
        page.line("/* 1, and the increments; 0, and nothing written, for an input that is refused or not finite. */");
        page.line(&format!(
            "uint8_t {prefix}_table_{name}(float error, float change, float delta[3]);"
        ));
        page.line("/* What they are off at most. */");
        page.line(&format!("extern const float {prefix}_table_{name}_bound[3];"));
    }
    for line in ["", "#ifdef __cplusplus", "}", "#endif", "", "#endif"] {
        page.line(line);
    }
    page.text
}

/// A bound in four digits that are not below it: they are off by half of the fourth at most.
fn above(bound: f64) -> String {
    format!("{:.3e}", 1.0005 * bound)
}

fn source(table: &SurfaceTable, prefix: &str, width: Width) -> String {
    let (name, points) = (width.name(), table.points);
    let real = |value: f32| format!("{}f", decimal(f64::from(value), true));
    let (kind, deviations) = match width {
        Width::Single => ("float", &table.single),
        Width::Short => ("int16_t", &table.short),
    };
    let mut page = Page::default();
    page.line(&format!("#include \"{prefix}_table.h\""));
    page.line("");
    // Rounded up, so that it remains a bound.
    let bounds = deviations.each_ref().map(|it| real(single(it.proved).next_up()));
    page.line(&format!(
        "const float {prefix}_table_{name}_bound[3] = {{ {} }};",
        bounds.join(", ")
    ));
    if width == Width::Short {
        let scales = table.scales.map(real).join(", ");
        page.line(&format!("static const float scales[3] = {{ {scales} }};"));
    }
    page.line(&format!("static const {kind} values[{}][3] = {{", points * points));
    page.inside(|page| match width {
        Width::Single => rows(page, &table.values, points, |value| real(*value)),
        Width::Short => rows(page, &table.steps, points, i16::to_string),
    });
    page.line("};");
    page.line("");
    let largest = if table.clamps { f32::MAX } else { table.range };
    let text = LOOKUP
        .replace("PREFIX", prefix)
        .replace("NAME", name)
        .replace("LARGEST", &real(largest))
        .replace("RANGE", &real(table.range))
        .replace("PER_UNIT", &real(table.per_unit()))
        .replace("BEFORE_LAST", &format!("{}U", points - 2))
        .replace("POINTS", &format!("{points}U"))
        .replace("ANSWER", if width == Width::Short { "between * scales[k]" } else { "between" });
    page.text.push_str(&text);
    page.text
}

/// A line of the text for each three points.
fn rows<T>(page: &mut Page, values: &[[T; 3]], points: usize, text: impl Fn(&T) -> String) {
    for row in values.chunks(points) {
        for some in row.chunks(3) {
            let cell = |cell: &[T; 3]| format!("{{ {} }},", cell.each_ref().map(&text).join(", "));
            page.line(&some.iter().map(cell).collect::<Vec<_>>().join(" "));
        }
    }
}

// The same operations in the same order as `SurfaceTable::single`.
const LOOKUP: &str = "\
/* The point before an input and how far it is on the way to the next; 0 for one that is refused. */
static uint8_t place(float input, uint32_t *point, float *part)
{
    float at;
    if (!(input >= -LARGEST && input <= LARGEST)) {
        return 0U;
    }
    if (input < -RANGE) {
        input = -RANGE;
    }
    if (input > RANGE) {
        input = RANGE;
    }
    at = (input + RANGE) * PER_UNIT;
    *point = (uint32_t)at;
    if (*point > BEFORE_LAST) {
        *point = BEFORE_LAST;
    }
    *part = at - (float)*point;
    if (*part > 1.0f) {
        *part = 1.0f;
    }
    return 1U;
}

static float along(uint32_t at, uint32_t k, float part)
{
    float first = (float)values[at][k];
    float second = (float)values[at + 1U][k];
    return first + (second - first) * part;
}

uint8_t PREFIX_table_NAME(float error, float change, float delta[3])
{
    uint32_t row, column, at, k;
    float down, right;
    if (!place(error, &row, &down) || !place(change, &column, &right)) {
        return 0U;
    }
    at = row * POINTS + column;
    for (k = 0U; k < 3U; ++k) {
        float first = along(at, k, right);
        float second = along(at + POINTS, k, right);
        float between = first + (second - first) * down;
        delta[k] = ANSWER;
    }
    return 1U;
}
";

/// The table of 32 bits, one line a point.
#[must_use]
pub fn table_csv(table: &SurfaceTable) -> String {
    let mut text = "error,change,delta_kp,delta_ki,delta_kd\n".to_owned();
    let range = f64::from(table.range);
    let at = |point: usize| range * (2.0 * point as f64 / (table.points - 1) as f64 - 1.0);
    for (k, value) in table.values.iter().enumerate() {
        let inputs = [at(k / table.points), at(k % table.points)].map(|it| decimal(it, false));
        let values = value.map(|it| decimal(f64::from(it), true));
        text.push_str(&format!("{},{}\n", inputs.join(","), values.join(",")));
    }
    text
}

/// A program that asks the C for drawn inputs: it prints how many answers have other bits than the tables here, and how
/// many are further off the supervisor than was proved.
#[must_use]
pub fn table_harness(
    table: &SurfaceTable,
    supervisor: &Supervisor<f64>,
    prefix: &str,
    count: usize,
) -> String {
    let mut draw = Draw(2);
    let mut page = Page::default();
    page.line(&format!("#define COUNT {count}U"));
    page.line("static const struct { uint32_t input[2]; uint32_t answer[2][3]; double exact[3]; unsigned answered; } inputs[COUNT] = {");
    page.inside(|page| {
        for _ in 0..count {
            let input = [(); 2].map(|()| drawn(&mut draw, table.range));
            page.line(&sample(table, supervisor, input));
        }
    });
    page.line("};");
    CHECK.replace("PREFIX", prefix).replace("/* INPUTS */\n", &page.text)
}

/// An input in the range or near it, now and then one that is none.
fn drawn(draw: &mut Draw, range: f32) -> f32 {
    const BAD: [f32; 5] = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 3e38, -0.0];
    let inside = single(draw.around(1.1 * f64::from(range)));
    let which = draw.unit() * 500.0;
    BAD.into_iter().zip(1..).find(|(_, k)| which < f64::from(*k)).map_or(inside, |(bad, _)| bad)
}

fn sample(table: &SurfaceTable, supervisor: &Supervisor<f64>, [error, change]: [f32; 2]) -> String {
    let answers = [table.single(error, change), table.short(error, change)];
    let answered = answers.iter().all(Option::is_some);
    let exact =
        if answered { infer(supervisor, f64::from(error), f64::from(change)) } else { [0.0; 3] };
    let bits = |values: &[f32]| {
        let bits: Vec<String> = values.iter().map(|it| format!("{:#x}U", it.to_bits())).collect();
        format!("{{ {} }}", bits.join(", "))
    };
    let [single, short] = answers.map(|answer| bits(&answer.unwrap_or_default()));
    let exact = exact.map(|it| format!("{it:e}")).join(", ");
    let input = bits(&[error, change]);
    format!("{{ {input}, {{ {single}, {short} }}, {{ {exact} }}, {} }},", u8::from(answered))
}

const CHECK: &str = "\
#include <stdint.h>
#include <stdio.h>
#include \"PREFIX_table.h\"

/* INPUTS */

static float real(uint32_t bits) { union { uint32_t bits; float number; } both; both.bits = bits; return both.number; }
static uint32_t bits_of(float number) { union { uint32_t bits; float number; } both; both.number = number; return both.bits; }

int main(void)
{
    unsigned different = 0U, beyond = 0U;
    for (unsigned n = 0U; n < COUNT; ++n) {
        float delta[2][3] = { { 0.0f, 0.0f, 0.0f }, { 0.0f, 0.0f, 0.0f } };
        const float error = real(inputs[n].input[0]), change = real(inputs[n].input[1]);
        const unsigned single = PREFIX_table_f32(error, change, delta[0]);
        const unsigned narrow = PREFIX_table_i16(error, change, delta[1]);
        unsigned same = single == inputs[n].answered && narrow == inputs[n].answered;
        for (unsigned k = 0U; k < 3U; ++k) {
            for (unsigned kind = 0U; kind < 2U; ++kind) {
                const double off = (double)delta[kind][k] - inputs[n].exact[k];
                const double bound = (double)(kind == 0U ? PREFIX_table_f32_bound[k] : PREFIX_table_i16_bound[k]);
                same = same && bits_of(delta[kind][k]) == inputs[n].answer[kind][k];
                beyond += !(off <= bound && -off <= bound);
            }
        }
        different += !same;
    }
    printf(\"%u inputs, %u different, %u beyond the bound\\n\", COUNT, different, beyond);
    return different + beyond == 0U ? 0 : 1;
}
";

#[cfg(test)]
mod tests {
    use super::above;

    /// A bound of 1.2344e-3 was told as 1.234e-3.
    #[test]
    fn a_bound_is_told_in_digits_that_are_not_below_it() {
        for k in 0..100_000 {
            let bound = f64::from(k) * 1.000_07e-7;
            assert!(above(bound).parse::<f64>().is_ok_and(|told| told >= bound), "{bound}");
        }
        assert_eq!(above(0.0), "0.000e0");
    }
}
