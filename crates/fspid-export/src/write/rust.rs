//! A controller in Rust: a constant of `fspid-core`.
//!
//! All structs are taken apart in full, so that a new option does not compile until it is exported.

use fspid_core::equations::{GainNumbers, PidEquations, PidNumbers, TunerEquations, TunerNumbers};
use fspid_core::{
    AntiWindup, Controller, DeadZone, Derivative, Fspid, GainCoupling, GainLimits, Gains, Guard,
    InputScale, InputSets, Law, Limits, Pid, PidConfig, ReferenceModel, SecondInput, SelfTuner,
    SetCentres, SetpointWeights, TunerSettings,
};
use fspid_numeric::Real;

use super::rust_rules::supervisor;
use super::rust_text::{Number, item, list, option, used_names};
use super::{Heading, Page, wrapped};
use crate::compose::Angles;
use crate::program::Precision;

/// The module; it needs `fspid-core` and nothing else.
#[must_use]
pub fn rust<R: Real>(controller: &Controller<R>, heading: &Heading<'_>) -> String {
    let number = Number { is_single: heading.precision == Precision::Single };
    let real = number.name();
    let mut body = Page::default();
    match controller {
        Controller::Fixed(pid) => fixed(&mut body, number, pid),
        Controller::SelfTuning(fspid) => self_tuning(&mut body, number, fspid),
    }
    body.line("");
    answer(&mut body, number, heading.angles.unwrap_or_default());
    helpers(&mut body, real);
    let mut page = Page::default();
    for line in heading.lines() {
        page.line(&format!("//! {line}"));
    }
    page.line("//!");
    page.line("//! A constant of the program: nothing is read, built or checked when it starts.");
    page.line("");
    for path in ["equations", "fuzzy", ""] {
        let names = used_names(&body.text, path);
        let path =
            if path.is_empty() { "fspid_core".into() } else { format!("fspid_core::{path}") };
        if !names.is_empty() {
            page.line(&format!("use {path}::{{"));
            page.inside(|page| {
                let lines = wrapped(&format!("{},", names.join(", ")), 90);
                lines.iter().for_each(|line| page.line(line));
            });
            page.line("};");
        }
    }
    page.line("");
    page.text.push_str(&body.text);
    page.text
}

fn constant(page: &mut Page, doc: &str, head: &str, value: &str) {
    page.line(&format!("/// {doc}"));
    page.line(&format!("{head} ="));
    page.inside(|page| {
        let mut lines = value.lines().peekable();
        while let Some(line) = lines.next() {
            let end = if lines.peek().is_none() { ";" } else { "" };
            page.line(&format!("{line}{end}"));
        }
    });
}

fn fixed<R: Real>(page: &mut Page, number: Number, pid: &Pid<R>) {
    let real = number.name();
    common(page, number, pid.config(), pid.equations());
    let value = gains(number, pid.gains());
    constant(page, "The gains.", &format!("const GAINS: Gains<{real}>"), &value);
    let made = "Pid::new_unchecked(GAINS, CONFIG, EQUATIONS)";
    constant(page, "The controller.", &format!("pub static DESIGN: Pid<{real}>"), made);
}

fn self_tuning<R: Real>(page: &mut Page, number: Number, fspid: &Fspid<R>) {
    let real = number.name();
    common(page, number, fspid.config(), fspid.equations());
    let value = supervisor(number, fspid.tuner().supervisor());
    constant(page, "The rules.", &format!("const SUPERVISOR: Supervisor<{real}>"), &value);
    let value = tuner(number, fspid.tuner());
    constant(page, "From rules to gains.", &format!("const TUNER: SelfTuner<{real}>"), &value);
    let value = tuner_equations(number, fspid.tuner_equations());
    let head = format!("const TUNER_EQUATIONS: TunerEquations<{real}>");
    constant(page, "The same in numbers.", &head, &value);
    let made = "Fspid::new_unchecked(TUNER, CONFIG, EQUATIONS, TUNER_EQUATIONS)";
    constant(page, "The controller.", &format!("pub static DESIGN: Fspid<{real}>"), made);
}

fn common<R: Real>(
    page: &mut Page,
    number: Number,
    config: &PidConfig<R>,
    equations: &PidEquations<R>,
) {
    let real = number.name();
    let value = pid_config(number, config);
    let doc = "Everything but the gains.";
    constant(page, doc, &format!("const CONFIG: PidConfig<{real}>"), &value);
    let value = pid_equations(number, equations);
    let head = format!("const EQUATIONS: PidEquations<{real}>");
    constant(page, "The same in numbers, with which it flies.", &head, &value);
    if let Some(slew) = config.slew_rad_s {
        let slew = number.of(slew);
        page.line(&format!(
            "const _: () = assert!(EQUATIONS.numbers.slew_rad == {slew} * CONFIG.dt_s);"
        ));
    }
}

fn gains<R: Real>(number: Number, Gains { kp, ki, kd }: Gains<R>) -> String {
    let [kp, ki, kd] = [kp, ki, kd].map(|gain| number.finite(gain));
    item("Gains", &[("kp", kp), ("ki", ki), ("kd", kd)])
}

fn limits<R: Real>(number: Number, limits: Limits<R>) -> String {
    format!("limits({}, {})", number.of(limits.lower()), number.of(limits.upper()))
}

fn guard<R: Real>(number: Number, guard: Guard<R>) -> String {
    format!("Guard::new_unchecked({})", number.positive(guard.limit_rad()))
}

fn pid_config<R: Real>(number: Number, config: &PidConfig<R>) -> String {
    let PidConfig {
        dt_s,
        rate_gain_s,
        setpoint_weights: SetpointWeights { proportional, derivative: of_derivative },
        feedforward,
        derivative: Derivative { filter_s },
        integral,
        anti_windup,
        limits: of_command,
        slew_rad_s,
        guard: largest,
    } = *config;
    let anti_windup = match anti_windup {
        AntiWindup::None => "AntiWindup::None".to_owned(),
        AntiWindup::Clamping(of_term) => {
            format!("AntiWindup::Clamping({})", limits(number, of_term))
        }
        AntiWindup::Conditional => "AntiWindup::Conditional".to_owned(),
        AntiWindup::BackCalculation { tracking_s } => {
            item("AntiWindup::BackCalculation", &[("tracking_s", number.positive(tracking_s))])
        }
    };
    let weights = [
        ("proportional", number.finite(proportional)),
        ("derivative", number.finite(of_derivative)),
    ];
    item(
        "PidConfig",
        &[
            ("dt_s", number.positive(dt_s)),
            ("rate_gain_s", number.finite(rate_gain_s)),
            ("setpoint_weights", item("SetpointWeights", &weights)),
            ("feedforward", number.finite(feedforward)),
            ("derivative", item("Derivative", &[("filter_s", number.not_negative(filter_s))])),
            ("integral", format!("IntegralForm::{integral:?}")),
            ("anti_windup", anti_windup),
            ("limits", option(of_command.map(|it| limits(number, it)))),
            ("slew_rad_s", option(slew_rad_s.map(|it| number.positive(it)))),
            ("guard", guard(number, largest)),
        ],
    )
}

fn pid_equations<R: Real>(number: Number, equations: &PidEquations<R>) -> String {
    let PidEquations { structure, numbers } = equations;
    let structure = item(
        "PidStructure",
        &[
            ("integral", format!("IntegralForm::{:?}", structure.integral)),
            ("anti_windup", format!("AntiWindupKind::{:?}", structure.anti_windup)),
            ("coupled", structure.coupled.to_string()),
            ("feeds_forward", structure.feeds_forward.to_string()),
            ("limited", structure.limited.to_string()),
        ],
    );
    item("PidEquations", &[("structure", structure), ("numbers", pid_numbers(number, numbers))])
}

fn pid_numbers<R: Real>(number: Number, numbers: &PidNumbers<R>) -> String {
    let mut fields = Vec::new();
    numbers.map_named(|name, _, value| fields.push((name, number.of(*value))));
    item("PidNumbers", &fields)
}

fn tuner_numbers<R: Real>(number: Number, numbers: &TunerNumbers<R>) -> String {
    let mut fields = Vec::new();
    numbers.map_named(|name, _, value| fields.push((name, number.of(*value))));
    item("TunerNumbers", &fields)
}

fn gain_numbers<R: Real>(number: Number, numbers: &GainNumbers<R>) -> String {
    let mut fields = Vec::new();
    numbers.map_named(|name, _, value| fields.push((name, number.of(*value))));
    item("GainNumbers", &fields)
}

fn tuner_equations<R: Real>(number: Number, equations: &TunerEquations<R>) -> String {
    let TunerEquations { structure, numbers, gains } = equations;
    let structure = item(
        "TunerStructure",
        &[
            ("second_input", format!("SecondInputKind::{:?}", structure.second_input)),
            ("law", format!("LawKind::{:?}", structure.law)),
        ],
    );
    let gains: Vec<String> = gains.iter().map(|gain| gain_numbers(number, gain)).collect();
    item(
        "TunerEquations",
        &[
            ("structure", structure),
            ("numbers", tuner_numbers(number, numbers)),
            ("gains", list(&gains)),
        ],
    )
}

fn tuner<R: Real>(number: Number, tuner: &SelfTuner<R>) -> String {
    let nominal = gains(number, tuner.nominal());
    let settings = settings(number, tuner.settings());
    format!("SelfTuner::new_unchecked(\n    {nominal},\n    SUPERVISOR,\n    {},\n)", {
        settings.replace('\n', "\n    ")
    })
}

fn settings<R: Real>(number: Number, settings: &TunerSettings<R>) -> String {
    let TunerSettings {
        error_sign,
        second_input,
        change,
        input_scale: InputScale { error_per_rad, change_per_rad },
        input_sets: InputSets { error, change: of_change },
        output_scale,
        gain_coupling: GainCoupling { setpoint_weight, rate_gain },
        law,
        gain_limits,
        dead_zone,
    } = *settings;
    let scale = [
        ("error_per_rad", number.finite(error_per_rad)),
        ("change_per_rad", number.finite(change_per_rad)),
    ];
    let sets = [error, of_change].map(|it| option(it.map(|it| centres(number, it))));
    let [error, of_change] = sets;
    let coupling = [
        ("setpoint_weight", number.finite(setpoint_weight)),
        ("rate_gain", number.finite(rate_gain)),
    ];
    item(
        "TunerSettings",
        &[
            ("error_sign", format!("ErrorSign::{error_sign:?}")),
            ("second_input", second(number, second_input)),
            ("change", format!("Change::{change:?}")),
            ("input_scale", item("InputScale", &scale)),
            ("input_sets", item("InputSets", &[("error", error), ("change", of_change)])),
            ("output_scale", gains(number, output_scale)),
            ("gain_coupling", item("GainCoupling", &coupling)),
            ("law", law_of(number, law)),
            ("gain_limits", option(gain_limits.map(|it| of_gains(number, it)))),
            ("dead_zone", option(dead_zone.map(|it| zone(number, it)))),
        ],
    )
}

fn second<R: Real>(number: Number, second_input: SecondInput<R>) -> String {
    match second_input {
        SecondInput::Change => "SecondInput::Change".to_owned(),
        SecondInput::Rate => "SecondInput::Rate".to_owned(),
        SecondInput::ModelError(ReferenceModel { bandwidth_rad_s, damping }) => {
            let fields = [
                ("bandwidth_rad_s", number.positive(bandwidth_rad_s)),
                ("damping", number.positive(damping)),
            ];
            format!("SecondInput::ModelError({})", item("ReferenceModel", &fields))
        }
    }
}

fn law_of<R: Real>(number: Number, law: Law<R>) -> String {
    match law {
        Law::Memoryless => "Law::Memoryless".to_owned(),
        Law::Accumulating { leakage_per_s } => {
            item("Law::Accumulating", &[("leakage_per_s", number.not_negative(leakage_per_s))])
        }
    }
}

fn centres<R: Real>(number: Number, centres: SetCentres<R>) -> String {
    let [small, medium] = [centres.small(), centres.medium()].map(|it| number.positive(it));
    format!("SetCentres::new_unchecked({small}, {medium})")
}

fn of_gains<R: Real>(number: Number, GainLimits { kp, ki, kd }: GainLimits<R>) -> String {
    let [kp, ki, kd] = [kp, ki, kd].map(|it| limits(number, it));
    item("GainLimits", &[("kp", kp), ("ki", ki), ("kd", kd)])
}

fn zone<R: Real>(number: Number, DeadZone { error_rad, change_rad }: DeadZone<R>) -> String {
    let fields = [
        ("error_rad", number.not_negative(error_rad)),
        ("change_rad", number.not_negative(change_rad)),
    ];
    item("DeadZone", &fields)
}

/// The function that is called once every period.
fn answer(page: &mut Page, number: Number, angles: Angles) {
    let real = number.name();
    let (Some(radians), Some(per_radian)) = (angles.radians(), angles.per_radian()) else {
        page.line("/// Answers one sample in rad and rad/s; call it once every period.");
        let head = format!(
            "pub fn step(state: &mut State<{real}>, sample: Sample<{real}>) -> Step<{real}>"
        );
        page.line(&format!("{head} {{"));
        page.inside(|page| page.line("DESIGN.step(state, sample)"));
        page.line("}");
        return;
    };
    let [radians, per_radian] = [radians, per_radian].map(|it| number.rounded(it));
    for line in IN_DEGREES.lines() {
        let line = line.replace("REAL", real);
        page.line(&line.replace("PER_RADIAN", &per_radian).replace("RADIANS", &radians));
    }
}

const IN_DEGREES: &str = "\
/// What the controller is given.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampleInDegrees {
    /// Commanded pitch, degrees.
    pub setpoint_deg: REAL,
    /// Measured pitch, degrees.
    pub measurement_deg: REAL,
    /// Measured pitch rate, degrees per second.
    pub rate_deg_s: REAL,
}

/// What the controller answers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct AnswerInDegrees {
    /// Command, degrees; positive is nose up.
    pub command_deg: REAL,
    /// Gains used.
    pub gains: Gains<REAL>,
    /// The command was cut by a limit.
    pub saturated: bool,
    /// Faults latched so far.
    pub faults: Faults,
}

/// Answers one sample; call it once every period.
pub fn step(state: &mut State<REAL>, sample: SampleInDegrees) -> AnswerInDegrees {
    let SampleInDegrees { setpoint_deg, measurement_deg, rate_deg_s } = sample;
    let sample = Sample {
        setpoint_rad: setpoint_deg * RADIANS,
        measurement_rad: measurement_deg * RADIANS,
        rate_rad_s: rate_deg_s * RADIANS,
    };
    let Step { command_rad, gains, saturated, faults } = DESIGN.step(state, sample);
    AnswerInDegrees { command_deg: command_rad * PER_RADIAN, gains, saturated, faults }
}
";

/// Functions that are asked while the code is compiled: a number that was edited to what is not allowed does not compile.
fn helpers(page: &mut Page, real: &str) {
    const HELPERS: [(&str, &str); 3] = [
        ("finite", "value > REAL::NEG_INFINITY && value < REAL::INFINITY"),
        ("positive", "value > 0.0 && value < REAL::INFINITY"),
        ("not_negative", "value >= 0.0 && value < REAL::INFINITY"),
    ];
    for (name, good) in HELPERS {
        if !page.text.contains(&format!("{name}(")) {
            continue;
        }
        let good = good.replace("REAL", real);
        page.line("");
        page.line(&format!("const fn {name}(value: {real}) -> {real} {{"));
        page.inside(|page| {
            page.line(&format!("assert!({good});"));
            page.line("value");
        });
        page.line("}");
    }
    if page.text.contains("limits(") {
        page.line("");
        page.line(&format!("const fn limits(lower: {real}, upper: {real}) -> Limits<{real}> {{"));
        page.inside(|page| {
            page.line("assert!(lower < upper);");
            page.line("Limits::new_unchecked(lower, upper)");
        });
        page.line("}");
    }
}
