//! What a proof in intervals is asked of the C: from any memory within bounds and for any finite sample, no number
//! overflows, and the memory is within the same bounds afterwards; so for ever.

use std::fmt::Write as _;

use fspid_core::equations::LawKind;
use fspid_core::fuzzy::OutOfRange;
use fspid_core::{Controller, IntegralForm, largest_remembered};
use fspid_numeric::Real;

use super::Subject;
use crate::compose::GAINS;
use crate::program::{Member, Part, Precision, Value};
use crate::targets::File;
use crate::write::c_number;

/// Why no proof is tried with hope, if so.
fn obstacle<R: Real>(subject: &Subject<'_, R>) -> Option<&'static str> {
    let Controller::SelfTuning(fspid) = subject.controller else {
        return literal(subject.controller);
    };
    let (settings, supervisor) = (fspid.tuner().settings(), fspid.tuner().supervisor());
    let accumulates = fspid.tuner_equations().structure.law == LawKind::Accumulating;
    let has_labels = supervisor.numbers().is_none();
    if accumulates && settings.gain_limits.is_none() {
        return Some(
            "gains that accumulate without limits have no bound; gain_limits would give them one",
        );
    }
    if has_labels && subject.program.precision == Precision::Double {
        return Some(
            "the exponential of 64 bits cannot be asked for every number; --numbers single can",
        );
    }
    if has_labels && supervisor.out_of_range() == OutOfRange::Evaluate {
        return Some(
            "outside of the range the area under the rules has no lower bound; out_of_range = \"clamp\" has",
        );
    }
    literal(subject.controller)
}

fn literal<R: Real>(controller: &Controller<R>) -> Option<&'static str> {
    let acts = controller.config().anti_windup != fspid_core::AntiWindup::None;
    let is_literal = controller.config().integral == IntegralForm::Literal;
    (is_literal && acts)
        .then_some("the literal integral divides by its gain; the bumpless one does not")
}

pub(super) fn first_line<R: Real>(subject: &Subject<'_, R>) -> String {
    match obstacle(subject) {
        Some(why) => format!("Not proved: {why}."),
        None => {
            "Not proved yet: `make-evidence.sh` asks Frama-C and writes its verdict into this line."
                .to_owned()
        }
    }
}

pub(super) fn files<R: Real>(subject: &Subject<'_, R>) -> Vec<File> {
    vec![File::text("eva_main.c", main(subject)), File::text("sweep.c", sweep(subject))]
}

/// Bounds of a member of the memory.
fn bounds<R: Real>(subject: &Subject<'_, R>, name: &str) -> [f64; 2] {
    let [rate, integral] = largest_remembered::<R>().map(R::to_f64);
    let around = |most: f64| [-most, most];
    let config = subject.controller.config();
    let guard = config.guard.limit_rad().to_f64();
    if let Some(gain) = GAINS.iter().position(|gain| *gain == name) {
        return gain_bounds(subject, gain);
    }
    match name {
        "command_rad" => {
            config.limits.map_or(around(0.1 * subject.program.precision.largest()), |it| {
                let largest = subject.program.precision.largest();
                [it.lower().to_f64().max(-largest), it.upper().to_f64().min(largest)]
            })
        }
        "integral" => around(integral),
        "model_rad" | "model_rad_s" => around(rate),
        "error_rad" => around(2.01 * guard),
        "derivative_input_rad" => {
            let weight = config.setpoint_weights.derivative.to_f64();
            around((1.01 + 1.01 * weight.abs()) * guard)
        }
        // A filter goes on from any number towards a smaller one.
        _ => around(rate / 1000.0),
    }
}

fn gain_bounds<R: Real>(subject: &Subject<'_, R>, gain: usize) -> [f64; 2] {
    let Controller::SelfTuning(fspid) = subject.controller else { return [0.0, 0.0] };
    let numbers = fspid.tuner_equations().gains[gain].map(|it| it.to_f64());
    if numbers.lower.is_finite() && numbers.upper.is_finite() {
        return [numbers.lower, numbers.upper];
    }
    let supervisor = fspid.tuner().supervisor();
    let labels = supervisor.range().to_f64() * 1.001;
    let most = supervisor.numbers().map_or(labels, |table| {
        let grid = table.grid(fspid_core::fuzzy::Output::ALL[gain]);
        grid.iter().flatten().fold(0.0, |most: f64, it| most.max(it.to_f64().abs())) * 1.001
    });
    let reach = numbers.scale.abs() * most;
    [(numbers.nominal - reach).max(numbers.lower), (numbers.nominal + reach).min(numbers.upper)]
}

fn main<R: Real>(subject: &Subject<'_, R>) -> String {
    let (prefix, program) = (subject.prefix, subject.program);
    let real = if program.precision == Precision::Single { "float" } else { "double" };
    let number = |value: f64| c_number(program, value);
    let (zero, one) = (number(0.0), number(1.0));
    let mut text = "/* From any memory within its bounds and for any finite sample: nothing overflows, and the memory is within\n   \
        the same bounds afterwards. What is asked of the exponential, sweep.c shows for every number. */\n"
        .to_owned();
    let _ = writeln!(text, "#include \"{prefix}.h\"");
    if program.function("exponential").is_some() {
        let _ = writeln!(
            text,
            "/*@ requires x <= {zero}; assigns \\result \\from x; ensures \\is_finite(\\result);\n    ensures {zero} <= \
             \\result; ensures \\result <= {one}; */\nstatic {real} {prefix}_exponential({real} x);"
        );
    }
    let _ = write!(
        text,
        "#include \"{prefix}.c\"\n\n/*@ assigns \\result \\from \\nothing; ensures \\is_finite(\\result); */\nextern {real} \
         any_number(void);\n/*@ assigns \\result \\from \\nothing; */\nextern int any_choice(void);\n\nstatic {real} \
         between({real} least, {real} most)\n{{\n    {real} number = any_number();\n    if (!(least <= number && number \
         <= most)) {{\n        number = least;\n    }}\n    return number;\n}}\n\nint main(void)\n{{\n    {prefix}_state state;\n    \
         {prefix}_sample sample;\n    {prefix}_answer answer;\n    {prefix}_init(&state);\n"
    );
    let kept: Vec<&Member> = program.members(Part::State).iter().collect();
    let asserted = |text: &mut String, when: &str| {
        for Member { name, value, .. } in &kept {
            if matches!(value, Value::Real(_)) {
                let [least, most] = bounds(subject, name).map(number);
                let _ = writeln!(
                    text,
                    "    /*@ assert {name}_{when}: {least} <= state.{name} <= {most}; */"
                );
            }
        }
    };
    asserted(&mut text, "begins");
    for Member { name, value, .. } in &kept {
        let value = match value {
            Value::Real(_) => {
                let [least, most] = bounds(subject, name).map(number);
                format!("between({least}, {most})")
            }
            Value::Truth(_) => "(any_choice() ? 1U : 0U)".to_owned(),
            _ => "(uint8_t)any_choice()".to_owned(),
        };
        let _ = writeln!(text, "    state.{name} = {value};");
    }
    for member in program.members(Part::Sample) {
        let _ = writeln!(text, "    sample.{} = any_number();", member.name);
    }
    let _ = write!(
        text,
        "    switch (any_choice()) {{\n    case 0:\n        {prefix}_hold(&{prefix}_design, &state, &answer, 1U);\n        \
         break;\n    case 1:\n        {prefix}_track(&{prefix}_design, &state, &sample, &answer, any_number());\n        \
         break;\n    default:\n        {prefix}_step(&{prefix}_design, &state, &sample, &answer);\n        break;\n    }}\n"
    );
    asserted(&mut text, "goes_on");
    let command = &program.members(Part::Answer)[0].name;
    let [least, most] = bounds(subject, "command_rad");
    // Degrees are rounded once more.
    let unit = subject
        .heading
        .angles
        .and_then(crate::Angles::per_radian)
        .map_or(1.0, |per_radian| per_radian * (1.0 + 1e-6));
    if subject.controller.config().limits.is_some() {
        let [least, most] = [least * unit, most * unit].map(number);
        let _ = writeln!(
            text,
            "    /*@ assert within_limits: {least} <= answer.{command} <= {most}; */"
        );
    }
    let _ = writeln!(text, "    /*@ assert finite: \\is_finite(answer.{command}); */");
    text += "    return 0;\n}\n";
    text
}

fn sweep<R: Real>(subject: &Subject<'_, R>) -> String {
    let prefix = subject.prefix;
    if subject.program.precision == Precision::Double {
        return "/* Numbers of 64 bits are too many for a sweep. */\n#include <stdio.h>\nint main(void)\n{\n    printf(\"not \
                swept: numbers of 64 bits\\n\");\n    return 0;\n}\n"
            .to_owned();
    }
    let number = |value: f64| c_number(subject.program, value);
    let largest = number(subject.program.precision.largest());
    let guard = number(subject.controller.config().guard.limit_rad().to_f64());
    let exponential = if subject.program.function("exponential").is_some() {
        format!(
            "        if (number <= 0.0f) {{\n            const float power = {prefix}_exponential(number);\n            wrong += \
             !(0.0f <= power && power <= 1.0f);\n            sum = (sum ^ bits_of(power)) * 16777619U;\n        }}\n"
        )
    } else {
        String::new()
    };
    format!(
        "/* Every number of 32 bits, NaN and infinities too: what is asked of a sample says what its bits say, the \
         magnitude\n   is that of the bits, and the exponential of what is not above 0 lies in 0 to 1. */\n#include <stdint.h>\n\
         #include <stdio.h>\n#include \"{prefix}.c\"\n\nstatic uint32_t bits_of(float number)\n{{\n    union {{ float number; \
         uint32_t bits; }} both;\n    both.number = number;\n    return both.bits;\n}}\n\nint main(void)\n{{\n    unsigned long \
         wrong = 0UL;\n    uint32_t sum = 2166136261U, bits = 0U;\n    do {{\n        union {{ uint32_t bits; float number; \
         }} both;\n        both.bits = bits;\n        const float number = both.number;\n        const uint32_t size = bits & \
         0x7FFFFFFFU;\n        const int finite = (-{largest} <= number) && (number <= {largest});\n        const int \
         believed = (-{guard} <= number) && (number <= {guard});\n        wrong += finite != (size < 0x7F800000U);\n        \
         wrong += believed != (size <= bits_of({guard}));\n        if (size <= 0x7F800000U) {{\n            wrong += \
         bits_of({prefix}_magnitude(number)) != size;\n        }}\n{exponential}        ++bits;\n    }} while (bits != 0U);\n    \
         printf(\"4294967296 numbers, %lu wrong, sum %08lx\\n\", wrong, (unsigned long)sum);\n    return wrong == 0UL ? 0 : \
         1;\n}}\n"
    )
}
