//! What a proof in intervals is asked of the C: from any memory within bounds and for any finite sample, no number
//! overflows, and the memory is within the same bounds afterwards; so for ever.

use fspid_core::equations::LawKind;
use fspid_core::fuzzy::OutOfRange;
use fspid_core::{Controller, IntegralForm, largest_remembered};
use fspid_numeric::Real;

use super::Subject;
use crate::compose::GAINS;
use crate::file::File;
use crate::program::{Member, Part, Precision, Program, Value};
use crate::write::c_number;

/// Why no proof is tried with hope, if so.
fn obstacle<R: Real>(subject: &Subject<'_, R>) -> Option<&'static str> {
    if subject.program.precision == Precision::Double {
        return Some(
            "numbers of 64 bits are too many for a sweep, and a proof rests on one; --numbers single has one",
        );
    }
    let Controller::SelfTuning(fspid) = subject.controller else {
        return literal(subject.controller);
    };
    let (equations, supervisor) = (fspid.tuner_equations(), fspid.tuner().supervisor());
    let accumulates = equations.structure.law == LawKind::Accumulating;
    let are_bounded = equations.gains.iter().all(|it| it.lower.is_finite() && it.upper.is_finite());
    let has_labels = supervisor.has_labels();
    if accumulates && !are_bounded {
        return Some(
            "gains that accumulate have no bound on a side without a limit; both ends of gain_limits would give them one",
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

/// The text of `eva_main.c`.
fn main<R: Real>(subject: &Subject<'_, R>) -> String {
    let program = subject.program;
    let [zero, one] = [0.0, 1.0].map(|value| c_number(program, value));
    let exponential = match program.function("exponential") {
        Some(_) => EXPONENTIAL.replace("@ZERO@", &zero).replace("@ONE@", &one),
        None => String::new(),
    };
    let sample = program.members(Part::Sample).iter();
    let sample: String =
        sample.map(|member| format!("    sample.{} = any_number();\n", member.name)).collect();
    let is_swept = program.precision == Precision::Single;
    let swept = if is_swept {
        "sweep.c shows for every number"
    } else {
        "nothing shows: 64 bits are not swept"
    };
    include_str!("scripts/eva_main.c")
        .replace("@SWEPT@", swept)
        .replace("@EXPONENTIAL@\n", &exponential)
        .replace("@BEGINS@\n", &asserted(subject, "begins"))
        .replace("@MEMORY@\n", &memory(subject))
        .replace("@SAMPLE@\n", &sample)
        .replace("@GOES_ON@\n", &asserted(subject, "goes_on"))
        .replace("@LIMITS@\n", &within_limits(subject))
        .replace("@COMMAND@", &program.members(Part::Answer)[0].name)
        .replace("@REAL@", real(program))
        .replace("@PREFIX@", subject.prefix)
}

/// What Eva believes of it, and `sweep.c` shows.
const EXPONENTIAL: &str =
    "/*@ requires x <= @ZERO@; assigns \\result \\from x; ensures \\is_finite(\\result);
    ensures @ZERO@ <= \\result; ensures \\result <= @ONE@; */
static @REAL@ @PREFIX@_exponential(@REAL@ x);
";

fn real(program: &Program) -> &'static str {
    if program.precision == Precision::Single { "float" } else { "double" }
}

/// That every number of the memory is within its bounds.
fn asserted<R: Real>(subject: &Subject<'_, R>, when: &str) -> String {
    let reals = subject.program.members(Part::State).iter();
    let reals = reals.filter(|member| matches!(member.value, Value::Real(_)));
    let line = |Member { name, .. }: &Member| {
        let [least, most] = bounds(subject, name).map(|value| c_number(subject.program, value));
        format!("    /*@ assert {name}_{when}: {least} <= state.{name} <= {most}; */\n")
    };
    reals.map(line).collect()
}

/// Any memory within its bounds.
fn memory<R: Real>(subject: &Subject<'_, R>) -> String {
    let line = |Member { name, value, .. }: &Member| {
        let value = match value {
            Value::Real(_) => {
                let ends = bounds(subject, name).map(|value| c_number(subject.program, value));
                format!("between({})", ends.join(", "))
            }
            Value::Truth(_) => "(any_choice() ? 1U : 0U)".to_owned(),
            _ => "(uint8_t)any_choice()".to_owned(),
        };
        format!("    state.{name} = {value};\n")
    };
    subject.program.members(Part::State).iter().map(line).collect()
}

/// That the command is within its limits, where it has some.
fn within_limits<R: Real>(subject: &Subject<'_, R>) -> String {
    if subject.controller.config().limits.is_none() {
        return String::new();
    }
    // Degrees are rounded once more.
    let per_radian = subject.heading.angles.and_then(crate::Angles::per_radian);
    let unit = per_radian.map_or(1.0, |per_radian| per_radian * (1.0 + 1e-6));
    let [least, most] =
        bounds(subject, "command_rad").map(|value| c_number(subject.program, value * unit));
    format!("    /*@ assert within_limits: {least} <= answer.@COMMAND@ <= {most}; */\n")
}

/// The text of `sweep.c`.
fn sweep<R: Real>(subject: &Subject<'_, R>) -> String {
    let program = subject.program;
    if program.precision == Precision::Double {
        return include_str!("scripts/not_swept.c").to_owned();
    }
    let exponential = match program.function("exponential") {
        Some(_) => SWEPT_EXPONENTIAL,
        None => "",
    };
    let guard = subject.controller.config().guard.limit_rad().to_f64();
    include_str!("scripts/sweep.c")
        .replace("@EXPONENTIAL@\n", exponential)
        .replace("@LARGEST@", &c_number(program, program.precision.largest()))
        .replace("@GUARD@", &c_number(program, guard))
        .replace("@PREFIX@", subject.prefix)
}

const SWEPT_EXPONENTIAL: &str = "        if (number <= 0.0f) {
            const float power = @PREFIX@_exponential(number);
            wrong += !(0.0f <= power && power <= 1.0f);
            sum = (sum ^ bits_of(power)) * 16777619U;
        }
";
