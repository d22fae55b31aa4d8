//! Values of structs as text in Rust.

use fspid_numeric::Real;

use super::decimal;

/// How numbers are written.
#[derive(Clone, Copy, Debug)]
pub(super) struct Number {
    pub(super) is_single: bool,
}

impl Number {
    pub(super) fn name(self) -> &'static str {
        if self.is_single { "f32" } else { "f64" }
    }

    pub(super) fn of<R: Real>(self, value: R) -> String {
        match value.to_f64() {
            value if value.is_nan() => format!("{}::NAN", self.name()),
            value if value.is_infinite() && value < 0.0 => format!("{}::NEG_INFINITY", self.name()),
            value if value.is_infinite() => format!("{}::INFINITY", self.name()),
            value => decimal(value, self.is_single),
        }
    }

    /// A number of 64 bits in the digits of the export.
    #[allow(clippy::cast_possible_truncation, reason = "rounding to the nearest f32 is meant")]
    pub(super) fn rounded(self, value: f64) -> String {
        if self.is_single { self.of(value as f32) } else { self.of(value) }
    }

    pub(super) fn finite<R: Real>(self, value: R) -> String {
        format!("finite({})", self.of(value))
    }

    pub(super) fn positive<R: Real>(self, value: R) -> String {
        format!("positive({})", self.of(value))
    }

    pub(super) fn not_negative<R: Real>(self, value: R) -> String {
        format!("not_negative({})", self.of(value))
    }
}

/// Lines that are longer are broken.
const WIDTH: usize = 80;

/// A struct, in one line if it fits.
pub(super) fn item(name: &str, fields: &[(&str, String)]) -> String {
    let fields: Vec<String> =
        fields.iter().map(|(name, value)| format!("{name}: {value}")).collect();
    format!("{name} {}", broken("{ ", &fields, " }"))
}

/// An array, in one line if it fits.
pub(super) fn list(values: &[String]) -> String {
    broken("[", values, "]")
}

fn broken(open: &str, values: &[String], close: &str) -> String {
    let line = values.join(", ");
    if line.len() < WIDTH && !line.contains('\n') {
        return format!("{open}{line}{close}");
    }
    let lines: Vec<String> =
        values.iter().map(|value| format!("    {},", value.replace('\n', "\n    "))).collect();
    format!("{}\n{}\n{}", open.trim_end(), lines.join("\n"), close.trim_start())
}

pub(super) fn option(value: Option<String>) -> String {
    value.map_or_else(|| "None".to_owned(), |value| format!("Some({value})"))
}

/// The names of a module of `fspid-core` that a text uses, in the order of the alphabet.
pub(super) fn used_names(text: &str, module: &str) -> Vec<&'static str> {
    let names: &[&str] = match module {
        "equations" => &[
            "AntiWindupKind",
            "GainNumbers",
            "LawKind",
            "PidEquations",
            "PidNumbers",
            "PidStructure",
            "SecondInputKind",
            "TunerEquations",
            "TunerNumbers",
            "TunerStructure",
        ],
        "fuzzy" => &[
            "Defuzzifier",
            "Grid",
            "Network",
            "NumberTable",
            "OutOfRange",
            "RuleTable",
            "Supervisor",
            "SupervisorNumbers",
        ],
        _ => &[
            "AntiWindup",
            "Change",
            "DeadZone",
            "Derivative",
            "ErrorSign",
            "Faults",
            "Fspid",
            "GainCoupling",
            "GainLimits",
            "Gains",
            "Guard",
            "InputScale",
            "InputSets",
            "IntegralForm",
            "Law",
            "Limits",
            "Pid",
            "PidConfig",
            "ReferenceModel",
            "Sample",
            "SecondInput",
            "SelfTuner",
            "SetCentres",
            "SetpointWeights",
            "State",
            "Step",
            "TunerSettings",
        ],
    };
    let is_name = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let words: Vec<&str> = text.split(|c| !is_name(c)).collect();
    names.iter().copied().filter(|name| words.contains(name)).collect()
}
