//! A function in C that asks the exported C whether it is what was written, in a file of its own.

use fspid_core::equations::Memory;
use fspid_core::{Controller, Faults, Fspid, Gains, Sample, SecondInput, SetCentres, State};
use fspid_numeric::Real;

use super::c_harness::hex;
use super::{Heading, Page, decimal};
use crate::compose::{Angles, GAINS};
use crate::program::{Member, Part, Precision, Program, Value};

/// What the header says of it.
pub(super) const DOC: &str = "0 if the tables and the gains that follow from them are what was written, else what is wrong \
    first: 1 to 49 the table at the rules R1 to R49 of kp, 101 to 149 of ki, 201 to 249 of kd; 300 another number of the \
    configuration; 401 to 449, 501 to 549, 601 to 649 the gain kp, ki, kd of a step at the centre of that rule, which is a matter \
    of compiler flags or of the floating-point unit. For the start of a machine, not for flight.";

/// An odd factor: a change of one word always changes the sum.
const FACTOR: u32 = 16_777_619;
const START: u32 = 2_166_136_261;

/// The source of the function.
#[must_use]
pub fn c_selftest<R: Real>(
    program: &Program,
    controller: &Controller<R>,
    prefix: &str,
    heading: &Heading<'_>,
) -> String {
    let is_single = program.precision == Precision::Single;
    let lines = heading.lines().join("\n * ");
    let mut page = Page { text: format!("/* {lines} */\n"), depth: 0 };
    page.line(&format!("#include \"{prefix}.h\""));
    page.line("");
    let rules: Vec<&Member> = program.configuration.iter().filter(|it| it.is_rules()).collect();
    let asked = heading.angles.and_then(|angles| Asked::of(controller, angles));
    for member in &rules {
        let (kind, values) = expected(&member.value, is_single);
        page.line(&format!("static const {kind} expected_{}[49] = {{", member.name));
        page.inside(|page| {
            for row in values.chunks(7) {
                page.line(&format!("{},", row.join(", ")));
            }
        });
        page.line("};");
    }
    if let Some(asked) = &asked {
        tables(&mut page, asked, is_single);
    }
    page.line("");
    helpers(&mut page, prefix, is_single);
    page.line("");
    page.line(&format!("uint16_t {prefix}_selftest(const {prefix}_configuration *configuration)"));
    page.line("{");
    page.inside(|page| {
        page.line("uint16_t wrong = 0U;");
        for (member, output) in rules.iter().zip(0..) {
            cells(page, member, (prefix, 100 * output));
        }
        checksum(page, program, prefix);
        if let Some(asked) = &asked {
            // Nobody knows what a step does with a configuration that was found to be wrong.
            page.line("if (wrong == 0U) {");
            page.inside(|page| inferred(page, program, prefix, asked));
            page.line("}");
        }
        page.line("return wrong;");
    });
    page.line("}");
    page.text
}

/// The type and the texts of what a table must hold.
fn expected(value: &Value, is_single: bool) -> (&'static str, Vec<String>) {
    match value {
        Value::Bytes(values) => ("uint8_t", values.iter().map(|it| format!("{it}U")).collect()),
        Value::Reals(values) => {
            (bits_type(is_single), values.iter().map(|it| hex(*it, is_single)).collect())
        }
        Value::Real(_) | Value::Byte(_) | Value::Truth(_) => ("uint8_t", Vec::new()),
    }
}

fn bits_type(is_single: bool) -> &'static str {
    if is_single { "uint32_t" } else { "uint64_t" }
}

/// What a self-tuner is asked at the centres of its sets, and what it answers.
struct Asked {
    /// Set-points, in the unit of the export; the pitch is 0.
    setpoints: Vec<f64>,
    /// What stands beside the error: a rate in the unit of the export, else a number of the memory in rad.
    beside: Vec<f64>,
    /// The member of the memory, `None` for the rate.
    member: Option<&'static str>,
    /// Gains at each pair, the second counting faster.
    gains: Vec<[f64; 3]>,
}

impl Asked {
    fn of<R: Real>(controller: &Controller<R>, angles: Angles) -> Option<Self> {
        let Controller::SelfTuning(fspid) = controller else { return None };
        let numbers = &fspid.tuner_equations().numbers;
        let supervisor = fspid.tuner().supervisor();
        let range = supervisor.range();
        let sets = fspid.tuner().settings().input_sets;
        let places = |centres: Option<SetCentres<R>>| {
            let third = R::from_f64(1.0 / 3.0);
            let (small, medium) =
                centres.map_or((third, third + third), |it| (it.small(), it.medium()));
            [-R::ONE, -medium, -small, R::ZERO, small, medium, R::ONE].map(|part| part * range)
        };
        let per_radian = angles.per_radian().map_or(R::ONE, R::from_f64);
        let setpoints =
            places(sets.error).map(|it| it / (numbers.sign * numbers.error_per_rad) * per_radian);
        let seen = places(sets.change).map(|it| it / (numbers.sign * numbers.change_per_rad));
        let (member, beside) = match fspid.tuner().settings().second_input {
            SecondInput::Change => {
                (Some("error_rad"), seen.map(|it| -(it * numbers.change_divisor)))
            }
            SecondInput::Rate => (None, seen.map(|it| -it * per_radian)),
            SecondInput::ModelError(_) => (Some("model_rad"), seen),
        };
        let pairs = setpoints.iter().flat_map(|it| beside.iter().map(move |other| [*it, *other]));
        let gains = pairs.map(|pair| asked(fspid, controller, angles, pair).map(Real::to_f64));
        let gains = gains.collect();
        let [setpoints, beside] = [setpoints, beside].map(|it| it.map(Real::to_f64).into());
        Some(Self { setpoints, beside, member, gains })
    }
}

/// The gains of one step; `beside` as in [`Asked`].
fn asked<R: Real>(
    fspid: &Fspid<R>,
    controller: &Controller<R>,
    angles: Angles,
    [setpoint, beside]: [R; 2],
) -> [R; 3] {
    let radians = angles.radians().map_or(R::ONE, R::from_f64);
    let Gains { kp, ki, kd } = controller.nominal();
    let rest = Sample { setpoint_rad: R::ZERO, measurement_rad: R::ZERO, rate_rad_s: R::ZERO };
    let memory = Memory { kp, ki, kd, ..fspid.equations().at_first(&rest, &controller.nominal()) };
    let mut sample = Sample { setpoint_rad: setpoint * radians, ..rest };
    let memory = match fspid.tuner().settings().second_input {
        SecondInput::Change => Memory { error_rad: sample.setpoint_rad + beside, ..memory },
        SecondInput::ModelError(_) => Memory { model_rad: beside, ..memory },
        SecondInput::Rate => {
            sample.rate_rad_s = beside * radians;
            memory
        }
    };
    let mut state = State::remembering(memory, Faults::NONE);
    let Gains { kp, ki, kd } = controller.step(&mut state, sample).gains;
    [kp, ki, kd]
}

fn tables(page: &mut Page, asked: &Asked, is_single: bool) {
    let (real, end) = if is_single { ("float", "f") } else { ("double", "") };
    page.line("/* Centres of the sets as set-points and as what stands beside the error, and the gains at each pair. */");
    for (name, values) in [("setpoints", &asked.setpoints), ("beside", &asked.beside)] {
        let values = values.iter().map(|it| format!("{}{end}", decimal(*it, is_single)));
        let values: Vec<String> = values.collect();
        page.line(&format!("static const {real} {name}[7] = {{ {} }};", values.join(", ")));
    }
    page.line(&format!("static const {} gains[49][3] = {{", bits_type(is_single)));
    page.inside(|page| {
        for gains in &asked.gains {
            page.line(&format!("{{ {} }},", gains.map(|it| hex(it, is_single)).join(", ")));
        }
    });
    page.line("};");
}

fn helpers(page: &mut Page, prefix: &str, is_single: bool) {
    let (real, bits) = (if is_single { "float" } else { "double" }, bits_type(is_single));
    page.line(&format!("static {bits} {prefix}_bits({real} number)"));
    page.line("{");
    page.inside(|page| {
        page.line(&format!("union {{ {real} number; {bits} bits; }} both;"));
        page.line("both.number = number;");
        page.line("return both.bits;");
    });
    page.line("}");
    page.line("");
    page.line(&format!("static uint32_t {prefix}_mixed(uint32_t sum, {real} number)"));
    page.line("{");
    page.inside(|page| {
        page.line(&format!("const {bits} bits = {prefix}_bits(number);"));
        page.line(&format!("uint32_t mixed = (sum ^ (uint32_t)bits) * {FACTOR}U;"));
        if !is_single {
            page.line(&format!("mixed = (mixed ^ (uint32_t)(bits >> 32)) * {FACTOR}U;"));
        }
        page.line("return mixed;");
    });
    page.line("}");
}

/// Asks each cell of a table.
fn cells(page: &mut Page, member: &Member, (prefix, first): (&str, u16)) {
    let name = &member.name;
    let held = format!("configuration->{name}[rule]");
    let held = match member.value {
        Value::Reals(_) => format!("{prefix}_bits({held})"),
        _ => held,
    };
    page.line("for (uint16_t rule = 0U; rule < 49U; ++rule) {");
    page.inside(|page| {
        page.line(&format!("if ((wrong == 0U) && ({held} != expected_{name}[rule])) {{"));
        page.line(&format!("    wrong = (uint16_t)(rule + {}U);", first + 1));
        page.line("}");
    });
    page.line("}");
}

fn checksum(page: &mut Page, program: &Program, prefix: &str) {
    page.line(&format!("uint32_t sum = {START}U;"));
    let mut sum = START;
    let mut mixed = |value: f64| {
        #[allow(
            clippy::cast_possible_truncation,
            reason = "halves, and singles of a single program"
        )]
        let words = match program.precision {
            Precision::Single => vec![(value as f32).to_bits()],
            Precision::Double => vec![value.to_bits() as u32, (value.to_bits() >> 32) as u32],
        };
        words.into_iter().for_each(|word| sum = (sum ^ word).wrapping_mul(FACTOR));
    };
    for member in program.configuration.iter().filter(|it| !it.is_rules()) {
        let name = &member.name;
        match &member.value {
            Value::Real(value) => {
                mixed(*value);
                page.line(&format!("sum = {prefix}_mixed(sum, configuration->{name});"));
            }
            Value::Reals(values) => {
                values.iter().for_each(|value| mixed(*value));
                let count = values.len();
                page.line(&format!("for (uint16_t k = 0U; k < {count}U; ++k) {{"));
                page.line(&format!("    sum = {prefix}_mixed(sum, configuration->{name}[k]);"));
                page.line("}");
            }
            Value::Bytes(_) | Value::Byte(_) | Value::Truth(_) => {}
        }
    }
    page.line(&format!("if ((wrong == 0U) && (sum != {sum}U)) {{"));
    page.line("    wrong = 300U;");
    page.line("}");
}

/// Asks for a step at the centres.
fn inferred(page: &mut Page, program: &Program, prefix: &str, asked: &Asked) {
    let zero = if program.precision == Precision::Single { "0.0f" } else { "0.0" };
    let [setpoint, measurement, rate @ ..] = program.members(Part::Sample) else { return };
    page.line("for (uint16_t rule = 0U; rule < 49U; ++rule) {");
    page.inside(|page| {
        page.line(&format!("{prefix}_state state;"));
        page.line(&format!("{prefix}_sample sample;"));
        page.line(&format!("{prefix}_answer answer;"));
        page.line(&format!("{prefix}_reset(configuration, &state);"));
        page.line(&format!("sample.{} = setpoints[rule / 7U];", setpoint.name));
        page.line(&format!("sample.{} = {zero};", measurement.name));
        for rate in rate {
            let value = if asked.member.is_none() { "beside[rule % 7U]" } else { zero };
            page.line(&format!("sample.{} = {value};", rate.name));
        }
        page.line("state.started = 1U;");
        if let Some(member) = asked.member {
            let error = match setpoint.name.ends_with("_deg") {
                true => format!("(sample.{} * {})", setpoint.name, radians(program)),
                false => format!("sample.{}", setpoint.name),
            };
            let first = if member == "error_rad" { format!("{error} + ") } else { String::new() };
            page.line(&format!("state.{member} = {first}beside[rule % 7U];"));
        }
        page.line(&format!("{prefix}_step(configuration, &state, &sample, &answer);"));
        for (gain, output) in GAINS.iter().zip([401, 501, 601]) {
            page.line(&format!(
                "if ((wrong == 0U) && ({prefix}_bits(answer.{gain}) != gains[rule][{}])) {{",
                (output - 401) / 100
            ));
            page.line(&format!("    wrong = (uint16_t)(rule + {output}U);"));
            page.line("}");
        }
    });
    page.line("}");
}

fn radians(program: &Program) -> String {
    let is_single = program.precision == Precision::Single;
    let factor = decimal(Angles::Degrees.radians().unwrap_or(1.0), is_single);
    if is_single { format!("{factor}f") } else { factor }
}
