//! Writing: what MATLAB reads, or why there is no such file.

mod antecedent;
mod fit;
mod losses;
mod method;
mod rules;
mod shape;
mod variable;

use fspid_fuzzy::system::{Conclusion, Parts, System};

use crate::difference::{Difference, differences, questions};
use crate::note::{WriteOptions, Writing};
use crate::number::written;
use fspid_diagnostics::{Problem, Problems};
use losses::Losses;
use method::Methods;

/// The system as a `.fis` file.
///
/// What the file cannot say is refused, or, if losses are allowed, approximated with a note that
/// tells the error. What only looks otherwise in the file and answers the same is noted.
///
/// # Errors
/// Everything that the file cannot say.
pub fn write(parts: &Parts, options: WriteOptions) -> Result<Writing, Problems> {
    buildable(parts)?;
    let mut losses = Losses::new(options.lossy);
    let text = text(parts, &mut losses);
    left_out(parts, &mut losses);
    if losses.any && losses.is_clean() {
        measured(parts, &text, &mut losses);
    }
    let notes = losses.finish()?;
    Ok(Writing { text, notes })
}

/// Only what can be built is written.
fn buildable(parts: &Parts) -> Result<(), Problems> {
    let problem = |error: &fspid_fuzzy::system::SystemError| Problem::whole(error.to_string(), "");
    match System::new(parts.clone()) {
        Ok(_) => Ok(()),
        Err(errors) => Err(Problems::of_text(errors.iter().map(problem).collect())),
    }
}

fn text(parts: &Parts, losses: &mut Losses) -> String {
    let methods = Methods::of(parts, losses);
    let pair = has_intervals(parts);
    if pair {
        paired(&methods, losses);
    }
    let rules = rules::lines(parts, &methods, losses);
    let mut text = header(parts, &methods, rules.len(), pair, losses);
    for (index, input) in parts.inputs.iter().enumerate() {
        text += &variable::input(index + 1, input, pair, losses);
    }
    for (index, output) in parts.outputs.iter().enumerate() {
        text += &variable::output(index + 1, output, pair, losses);
    }
    text += "[Rules]\n";
    rules.iter().for_each(|line| text.extend([line, "\n"]));
    text
}

fn header(
    parts: &Parts,
    methods: &Methods,
    rules: usize,
    pair: bool,
    losses: &mut Losses,
) -> String {
    let name = variable::label(&parts.name, losses);
    let kind = if methods.sugeno { "sugeno" } else { "mamdani" };
    let Methods { and, or, implication, aggregation, defuzzifier, .. } = methods;
    let (inputs, outputs) = (parts.inputs.len(), parts.outputs.len());
    let reduction = if pair { "TypeRedMethod='Karnik-Mendel'\n" } else { "" };
    format!(
        "[System]\nName='{name}'\nType='{kind}'\nVersion=2.0\nNumInputs={inputs}\n\
         NumOutputs={outputs}\nNumRules={rules}\nAndMethod='{and}'\nOrMethod='{or}'\n\
         ImpMethod='{implication}'\nAggMethod='{aggregation}'\nDefuzzMethod='{defuzzifier}'\n\
         {reduction}\n"
    )
}

/// True if some set or number is an interval.
fn has_intervals(parts: &Parts) -> bool {
    let inputs = parts.inputs.iter().flat_map(|input| &input.terms);
    let outputs = parts.outputs.iter().flat_map(|output| &output.terms);
    inputs.into_iter().any(|term| term.lower.is_some())
        || outputs.into_iter().any(|term| {
            matches!(
                term.conclusion,
                Conclusion::Interval(_) | Conclusion::Set { lower: Some(_), .. }
            )
        })
}

fn paired(methods: &Methods, losses: &mut Losses) {
    if methods.sugeno {
        losses.note(
            "interval sets are written for Taskin's type-2 toolbox; MATLAB does not read them",
        );
    } else {
        losses.never("interval sets can be written for Sugeno systems only");
    }
}

/// Says what has no place in the file and changes no answer.
fn left_out(parts: &Parts, losses: &mut Losses) {
    let variables = parts.inputs.iter().map(|input| &input.description);
    let variables = variables.chain(parts.outputs.iter().map(|output| &output.description));
    let blocks = parts.blocks.iter().flat_map(|block| [&block.name, &block.description]);
    let rules = parts.blocks.iter().flat_map(|block| &block.rules).map(|rule| &rule.name);
    let mut texts = variables.chain(blocks).chain(rules).chain([&parts.description]);
    if texts.any(|text| !text.is_empty()) {
        losses.note("descriptions and names of rules and rule blocks are left out");
    }
    if parts.blocks.iter().any(|block| !block.enabled && !block.rules.is_empty()) {
        losses.note("rule blocks that are switched off are left out");
    }
}

/// Compares the answers of the system with those of the file, and notes where they differ.
fn measured(parts: &Parts, text: &str, losses: &mut Losses) {
    let reading = super::read(text).ok();
    let points = questions(parts);
    let found = reading.and_then(|reading| differences(parts, &reading.parts));
    let Some(found) = found else {
        losses.note("how far the answers change could not be measured".to_owned());
        return;
    };
    for (output, found) in parts.outputs.iter().zip(found) {
        let Difference { largest, unanswered } = found;
        // Answers that are the same are no loss.
        if largest == 0.0 && unanswered == 0 {
            continue;
        }
        let name = &output.name;
        let unanswered = if unanswered > 0 {
            format!("; {unanswered} are answered by only one of the two")
        } else {
            String::new()
        };
        let largest = written(largest);
        losses.note(format!(
            "output `{name}`: answers differ by up to {largest} at {points} points of the ranges and near the worst of them, beyond the ranges not measured{unanswered}"
        ));
    }
}
