//! `fmu-model.h`: what the C around every controller needs to know of this one.

use super::super::decimal;
use super::parameter::orders;
use super::variable::{Holds, Role, Variable, part_name, plain};
use super::{Fmu, Version};
use crate::program::{Part, Precision, Program};

/// The header; `mark` are 16 bytes that states of this model begin with.
pub(super) fn model(fmu: &Fmu<'_>, variables: &[Variable], token: &str, mark: &[u8]) -> String {
    let Fmu { program, prefix, version, .. } = fmu;
    let real = match program.precision {
        Precision::Single => "float",
        Precision::Double => "double",
    };
    let number = match version {
        Version::Two => 2,
        Version::Three => 3,
    };
    let mut text = format!(
        "/* What the C around every controller needs to know of this one: names, variables, what is remembered. */\n\
         #ifndef FSPID_MODEL_H\n#define FSPID_MODEL_H\n\n\
         #include <stddef.h>\n#include \"{prefix}.h\"\n\n\
         /* In a library that is linked statically every function begins with this. */\n\
         #define FMI{number}_FUNCTION_PREFIX {prefix}_\n\n\
         typedef {real} real;\n"
    );
    match fmu.is_system() {
        true => text.push_str(&system(program, prefix)),
        false => {
            text.push_str(&controller(prefix));
            let period = fmu.period();
            text.push_str(&format!("{CLOCK}#define MODEL_PERIOD_S {period}\n"));
        }
    }
    text.push_str(MEMORY);
    text.push_str(&format!("static const char model_token[] = \"{token}\";\n"));
    let mark: Vec<String> = mark.iter().map(|byte| format!("{byte:#04x}")).collect();
    text.push_str(&format!("static const uint8_t model_mark[16] = {{ {} }};\n\n", mark.join(", ")));
    text.push_str(&table(variables));
    text.push_str(&remembered(program));
    text.push_str(&order_table(variables));
    text.push_str("\n#endif\n");
    text
}

/// What a controller is called.
fn controller(prefix: &str) -> String {
    let mut text = String::new();
    for name in ["design", "reset", "hold", "step"] {
        text.push_str(&format!("#define model_{name} {prefix}_{name}\n"));
    }
    for part in [Part::Configuration, Part::State, Part::Sample, Part::Answer] {
        let part = part_name(part);
        text.push_str(&format!("typedef {prefix}_{part} model_{part};\n"));
    }
    text + "static int model_has_begun(const model_state *state)\n{\n    return state->started != 0U;\n}\n"
}

/// A fuzzy system in the place of a controller: nothing to configure, perhaps nothing to remember, nothing to hold.
fn system(program: &Program, prefix: &str) -> String {
    let remembers = !program.state.is_empty();
    let configured = !program.configuration.is_empty() || remembers;
    let state = match remembers {
        true => format!("typedef {prefix}_state model_state;"),
        false => "typedef struct { uint8_t nothing; } model_state;".to_owned(),
    };
    let reset = match remembers {
        true => format!("{prefix}_reset(state);"),
        false => "(void)state;".to_owned(),
    };
    let configuration = if configured { format!("&{prefix}_design, ") } else { String::new() };
    let asked = if remembers { "state, " } else { "" };
    let unused = if remembers { "" } else { " (void)state;" };
    format!(
        "/* It has no period: a step asks it once. */\n#define MODEL_IS_ASKED_EACH_STEP 1\n\
         typedef struct {{ uint8_t nothing; }} model_configuration;\n{state}\n\
         typedef {prefix}_sample model_sample;\ntypedef {prefix}_answer model_answer;\n\
         static const model_configuration model_design = {{ 0U }};\n\
         static void model_reset(const model_configuration *design, model_state *state)\n{{\n    (void)design;\n    {reset}\n}}\n\
         static void model_hold(const model_configuration *design, model_state *state, model_answer *answer, uint8_t fault)\n\
         {{\n    (void)design;\n    (void)state;\n    (void)answer;\n    (void)fault;\n}}\n\
         static int model_has_begun(const model_state *state)\n{{\n    (void)state;\n    return 1;\n}}\n\
         static void model_step(const model_configuration *design, model_state *state, const model_sample *sample, model_answer *answer)\n\
         {{\n    (void)design;{unused}\n    {prefix}_infer({configuration}{asked}sample, answer);\n}}\n"
    )
}

const CLOCK: &str = "/* Of the clock, s; equations have it as they were rounded. */\n";

const MEMORY: &str = "
enum role { role_time, role_input, role_output, role_parameter };
enum type { type_real, type_whole, type_truth };

/* All that an instance is, but for whom it talks to. */
struct memory {
    double time_s;
    double start_s;
    double stop_s;
    uint64_t samples;
    model_configuration configuration;
    model_state state;
    model_sample sample;
    model_answer answer;
    uint8_t mode;
    uint8_t has_stop;
};

struct variable { enum role role; enum type type; size_t offset; double lowest; double highest; const char *name; };
struct place { enum type type; size_t offset; };
/* Two value references. */
struct order { unsigned below; unsigned above; int may_be_equal; };
";

fn type_name(holds: Holds) -> &'static str {
    match holds {
        Holds::Real => "type_real",
        Holds::Whole => "type_whole",
        Holds::Truth => "type_truth",
    }
}

fn table(variables: &[Variable]) -> String {
    let mut text = format!(
        "#define VARIABLE_COUNT {}U\n/* At its value reference each. */\n",
        variables.len()
    );
    text.push_str("static const struct variable variables[VARIABLE_COUNT] = {\n");
    for variable in variables {
        let role = match variable.role {
            Role::Time => "role_time",
            Role::Input => "role_input",
            Role::Output => "role_output",
            Role::Parameter => "role_parameter",
        };
        let holds = type_name(variable.holds);
        let place = if variable.place.is_empty() { "time_s" } else { &variable.place };
        let (lowest, highest) = match variable.role {
            Role::Parameter => variable.range,
            Role::Time | Role::Input | Role::Output => (0.0, 0.0),
        };
        let (lowest, highest) = (decimal(lowest, false), decimal(highest, false));
        text.push_str(&format!(
            "    {{ {role}, {holds}, offsetof(struct memory, {place}), {lowest}, {highest}, \"{}\" }},\n",
            variable.name
        ));
    }
    text + "};\n\n"
}

fn remembered(program: &Program) -> String {
    let members: Vec<Variable> =
        program.state.iter().filter_map(|member| plain(member, Part::State)).collect();
    let mut text = format!("#define REMEMBERED_COUNT {}U\n", members.len());
    if members.is_empty() {
        // C has no empty array.
        text.push_str("static const struct place remembered[] = {\n    { type_whole, 0U },\n");
        return text + "};\n\n";
    }
    text.push_str("static const struct place remembered[REMEMBERED_COUNT] = {\n");
    for member in &members {
        let holds = type_name(member.holds);
        text.push_str(&format!("    {{ {holds}, offsetof(struct memory, {}) }},\n", member.place));
    }
    text + "};\n\n"
}

fn order_table(variables: &[Variable]) -> String {
    let at = |name: &str| variables.iter().position(|variable| variable.name == name);
    let row = |below: &str, above: &str, may_be_equal: bool| {
        let (below, above) = (at(below)?, at(above)?);
        Some(format!("    {{ {below}U, {above}U, {} }},\n", u8::from(may_be_equal)))
    };
    let rows: Vec<String> = orders(variables)
        .iter()
        .filter_map(|order| row(&order.below, &order.above, order.may_be_equal))
        .collect();
    // C has no empty array.
    let last = "    { 0U, 0U, 1 },\n";
    format!(
        "static const size_t order_count = {}U;\nstatic const struct order orders[] = {{\n{}{last}}};\n",
        rows.len(),
        rows.concat()
    )
}
