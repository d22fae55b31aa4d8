//! What an FMU says of itself: `modelDescription.xml`, `buildDescription.xml` and a page.

use super::super::decimal;
use super::variable::{Holds, Role, Unit, Variable};
use super::{Fmu, Version};
use crate::write::Heading;

const HEAD: &str = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n";
const GENERATED: &str = concat!("fspid ", env!("CARGO_PKG_VERSION"));
const LICENCE: &str = "Code: MIT or Apache-2.0, at your choice; the design is yours";

fn escaped(text: &str) -> String {
    let mut safe = String::new();
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            // What XML has no way to say.
            c if c.is_control() || matches!(c, '\u{fffe}' | '\u{ffff}') => safe.push(' '),
            c => safe.push(c),
        }
    }
    safe
}

/// Attributes in the order given.
fn attributes(pairs: &[(&str, String)]) -> String {
    pairs.iter().map(|(name, value)| format!(" {name}=\"{}\"", escaped(value))).collect()
}

fn summary(fmu: &Fmu<'_>) -> String {
    if fmu.is_system() {
        let Heading { name, digest, .. } = fmu.heading;
        return format!("Fuzzy system {name}, asked once in each step; from the file {digest}");
    }
    format!(
        "Controller {}, sampled every {} s; from the scenario {}",
        fmu.heading.name,
        fmu.period(),
        fmu.heading.digest
    )
}

/// `modelDescription.xml`.
pub(super) fn model_description(fmu: &Fmu<'_>, variables: &[Variable], token: &str) -> String {
    let token_name = match fmu.version {
        Version::Two => "guid",
        Version::Three => "instantiationToken",
    };
    // No date: the same design makes the same bytes.
    let head = attributes(&[
        ("fmiVersion", fmu.version.number().to_owned()),
        ("modelName", fmu.heading.name.to_owned()),
        (token_name, token.to_owned()),
        ("description", summary(fmu)),
        ("license", LICENCE.to_owned()),
        ("generationTool", GENERATED.to_owned()),
        ("variableNamingConvention", "flat".to_owned()),
    ]);
    let mut experiment = vec![("startTime", "0".to_owned())];
    if !fmu.is_system() {
        experiment.push(("stepSize", fmu.period()));
    }
    let experiment = attributes(&experiment);
    let body = [
        interface(fmu),
        units(variables),
        CATEGORIES.to_owned(),
        format!("  <DefaultExperiment{experiment}/>\n"),
        model_variables(fmu.version, variables),
        structure(fmu.version, variables),
    ];
    format!("{HEAD}<fmiModelDescription{head}>\n{}</fmiModelDescription>\n", body.concat())
}

const CATEGORIES: &str = "  <LogCategories>
    <Category name=\"logEvents\" description=\"Faults as they are latched\"/>
    <Category name=\"logStatusDiscard\" description=\"Values that are refused\"/>
    <Category name=\"logStatusError\" description=\"Calls that may not be made like this\"/>
  </LogCategories>
";

fn interface(fmu: &Fmu<'_>) -> String {
    let prefix = fmu.prefix;
    let identifier = format!("  <CoSimulation modelIdentifier=\"{prefix}\"");
    let variable_step = "canHandleVariableCommunicationStepSize=\"true\"";
    match fmu.version {
        Version::Two => format!(
            "{identifier} {variable_step} canNotUseMemoryManagementFunctions=\"true\" canGetAndSetFMUstate=\"true\" \
             canSerializeFMUstate=\"true\">\n    <SourceFiles>\n      <File name=\"{prefix}.c\"/>\n      <File name=\"fmu-2.c\"/>\n    \
             </SourceFiles>\n  </CoSimulation>\n"
        ),
        Version::Three => format!(
            "{identifier} {variable_step} canGetAndSetFMUState=\"true\" canSerializeFMUState=\"true\"/>\n"
        ),
    }
}

fn units(variables: &[Variable]) -> String {
    let is_used = |unit: &&Unit| {
        variables.iter().any(|variable| variable.unit.is_some_and(|used| used.name == unit.name))
    };
    let written = |unit: &Unit| {
        let mut base = Vec::new();
        for (name, exponent) in [("s", unit.s), ("rad", unit.rad)] {
            if exponent != 0 {
                base.push((name, exponent.to_string()));
            }
        }
        if unit.factor.to_bits() != 1.0_f64.to_bits() {
            base.push(("factor", decimal(unit.factor, false)));
        }
        let shown = unit.shown.map_or_else(String::new, |(name, factor)| {
            let factor = decimal(factor, false);
            format!("<DisplayUnit name=\"{name}\" factor=\"{factor}\"/>")
        });
        let (name, base) = (unit.name, attributes(&base));
        format!("    <Unit name=\"{name}\"><BaseUnit{base}/>{shown}</Unit>\n")
    };
    let all: String = Unit::ALL.iter().filter(is_used).map(written).collect();
    format!("  <UnitDefinitions>\n{all}  </UnitDefinitions>\n")
}

fn model_variables(version: Version, variables: &[Variable]) -> String {
    let written = |(reference, variable): (usize, &Variable)| {
        let common = common(reference, variable);
        let value = value(version, variable);
        match version {
            Version::Two => {
                let kind = match variable.holds {
                    Holds::Real => "Real",
                    Holds::Whole => "Integer",
                    Holds::Truth => "Boolean",
                };
                format!("    <ScalarVariable{common}><{kind}{value}/></ScalarVariable>\n")
            }
            Version::Three => {
                let kind = match variable.holds {
                    Holds::Real => "Float64",
                    Holds::Whole => "Int32",
                    Holds::Truth => "Boolean",
                };
                format!("    <{kind}{common}{value}/>\n")
            }
        }
    };
    let all: String = variables.iter().enumerate().map(written).collect();
    format!("  <ModelVariables>\n{all}  </ModelVariables>\n")
}

fn common(reference: usize, variable: &Variable) -> String {
    let (causality, variability, initial) = match variable.role {
        Role::Time => ("independent", "continuous", None),
        // Between samples nothing of an input is seen.
        Role::Input => ("input", "discrete", None),
        Role::Parameter => ("parameter", "tunable", Some("exact")),
        Role::Output => ("output", "discrete", Some("calculated")),
    };
    let mut pairs = vec![
        ("name", variable.name.clone()),
        ("valueReference", reference.to_string()),
        ("description", variable.doc.clone()),
        ("causality", causality.to_owned()),
        ("variability", variability.to_owned()),
    ];
    pairs.extend(initial.map(|initial| ("initial", initial.to_owned())));
    attributes(&pairs)
}

/// What is said of a number: unit, range, start.
fn value(version: Version, variable: &Variable) -> String {
    let mut pairs = Vec::new();
    if let Some(unit) = variable.unit {
        pairs.push(("unit", unit.name.to_owned()));
        pairs.extend(unit.shown.map(|(name, _)| ("displayUnit", name.to_owned())));
    }
    if variable.role == Role::Parameter {
        let (least, most) = variable.range;
        // That every number is allowed goes without saying.
        let is_end = |end: f64| end.abs() < f64::from(f32::MAX);
        pairs.extend(is_end(least).then(|| ("min", decimal(least, false))));
        pairs.extend(is_end(most).then(|| ("max", decimal(most, false))));
    }
    if matches!(variable.role, Role::Input | Role::Parameter) {
        pairs.push(("start", decimal(variable.start, false)));
    }
    if version == Version::Three && variable.role == Role::Input {
        // The default of inputs, said so that nobody has to look.
        pairs.insert(0, ("initial", "exact".to_owned()));
    }
    attributes(&pairs)
}

/// An output follows from what was set before a step, never from what is set behind it.
fn structure(version: Version, variables: &[Variable]) -> String {
    let outputs: Vec<usize> = (0..variables.len())
        .filter(|reference| variables[*reference].role == Role::Output)
        .collect();
    let all = |written: &dyn Fn(usize) -> String| -> String {
        outputs.iter().map(|reference| written(*reference)).collect()
    };
    let inside = match version {
        Version::Two => {
            // Counted from 1.
            let output = |reference| {
                format!("      <Unknown index=\"{}\" dependencies=\"\"/>\n", reference + 1)
            };
            let initial = |reference| format!("      <Unknown index=\"{}\"/>\n", reference + 1);
            format!(
                "    <Outputs>\n{}    </Outputs>\n    <InitialUnknowns>\n{}    </InitialUnknowns>\n",
                all(&output),
                all(&initial)
            )
        }
        Version::Three => {
            let output = |reference| {
                format!("    <Output valueReference=\"{reference}\" dependencies=\"\"/>\n")
            };
            let initial =
                |reference| format!("    <InitialUnknown valueReference=\"{reference}\"/>\n");
            format!("{}{}", all(&output), all(&initial))
        }
    };
    format!("  <ModelStructure>\n{inside}  </ModelStructure>\n")
}

/// `sources/buildDescription.xml`, the same in both versions.
pub(super) fn build_description(fmu: &Fmu<'_>) -> String {
    let prefix = fmu.prefix;
    let (source, _) = fmu.version.source();
    let define = match fmu.version {
        Version::Two => "FMI2_OVERRIDE_FUNCTION_PREFIX",
        Version::Three => "FMI3_OVERRIDE_FUNCTION_PREFIX",
    };
    format!(
        "{HEAD}<fmiBuildDescription fmiVersion=\"3.0\">\n  <BuildConfiguration modelIdentifier=\"{prefix}\">\n    \
         <SourceFileSet language=\"C99\" compilerOptions=\"-ffp-contract=off\">\n      <SourceFile name=\"{prefix}.c\"/>\n      \
         <SourceFile name=\"{source}\"/>\n      <PreprocessorDefinition name=\"{define}\" value=\"1\" optional=\"true\" \
         description=\"For a shared library, where names have no prefix\"/>\n    </SourceFileSet>\n  </BuildConfiguration>\n\
         </fmiBuildDescription>\n"
    )
}

/// `documentation/index.html`.
pub(super) fn page(fmu: &Fmu<'_>) -> String {
    let name = escaped(fmu.heading.name);
    let lines: Vec<String> = fmu.heading.lines().iter().map(|line| escaped(line)).collect();
    let told = if fmu.is_system() { ASKED.to_owned() } else { sampled(fmu) };
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head><meta charset=\"utf-8\"><title>{name}</title></head>\n<body>\n\
         <h1>{name}</h1>\n<p>{}</p>\n\
         {told}</body>\n</html>\n",
        lines.join(" ")
    )
}

/// What there is to know of a fuzzy system.
const ASKED: &str = "<p>Every communication step asks the system once, with the inputs that were set before it, however long it is; \
the outputs show the answer until the next. Inputs outside of their ranges are answered as the file says. Faults and sources of values are \
described with their variables; without a value the output is 0. A call that is not allowed in the present state ends the run; reset or an \
older state begins again.</p>\n";

/// What there is to know of a controller.
fn sampled(fmu: &Fmu<'_>) -> String {
    let period = fmu.period();
    format!(
        "<p>A sample is taken at each multiple of {period} s after the start that lies in a communication step, its end \
         excluded; between samples the command is held. An output shows the last sample before the end of the step.</p>\n\
         <p>Angles and commands: nose up is positive. A sample that is not finite or beyond the guard holds the command and \
         latches a fault. Parameters may be changed at any communication point; a value outside of its range, or limits in \
         the wrong order, are refused with a message and change nothing. A call that is not allowed in the present state \
         ends the run; reset or an older state begins again.</p>\n\
         <p>Whether the loop is good is not asked here: fspid verify and certify judge the design with its own parameters.</p>\n"
    )
}
