//! Reading.

use std::collections::BTreeMap;

use fspid_fuzzy::system::Parts;

use super::MAX_DEPTH;
use super::document::{Context, Element, parse};
use super::knowledge::{self, Knowledge};
use super::rules::{BASES, Reader};
use crate::check;
use crate::note::Reading;
use fspid_diagnostics::Problems;

/// Reads a system in the Fuzzy Markup Language.
///
/// # Errors
/// Every problem of the text, each with its place.
pub fn read(text: &str) -> Result<Reading, Problems> {
    let document = parse(text).map_err(|problem| Problems::of_text(vec![problem]))?;
    let mut context = Context::of(text);
    let root = Element::root(&document);
    let parts = match root.too_deep() {
        Some(deep) => {
            let expected = format!("at most {MAX_DEPTH} elements inside each other");
            context.problem(deep.start(), deep.name(), "nested too deeply", expected);
            Parts::default()
        }
        None => system(root, &mut context),
    };
    tell(&parts, &mut context);
    check::complete(parts, context.report)
}

fn system(root: Element<'_, '_>, context: &mut Context<'_>) -> Parts {
    const ROOTS: [&str; 2] = ["fuzzySystem", "fuzzyController"];
    if !root.is_any(&ROOTS) {
        let message = "this is no fuzzy system in FML";
        context.problem(root.start(), root.name(), message, "`<fuzzySystem>` around everything");
        return Parts::default();
    }
    context.only(root, &["name"]);
    let (mut knowledge, mut bases) = (None, Vec::new());
    for part in root.children() {
        if part.is("knowledgeBase") {
            match knowledge {
                None => knowledge = Some(knowledge::read(part, context)),
                Some(_) => {
                    let message = "a second knowledge base";
                    context.problem(part.start(), part.name(), message, "one");
                }
            }
        } else if part.is_any(&BASES) {
            bases.push(part);
        } else if part.is("anYaRuleBase") {
            let message = "rules about clouds of data (AnYa) are not read";
            context.problem(part.start(), part.name(), message, "");
        } else {
            context.refuse(part, root.name(), &[&["knowledgeBase"], &BASES[..3]].concat());
        }
    }
    let Some(mut knowledge) = knowledge else {
        context.problem(root.start(), "", "there is no knowledge base", "`<knowledgeBase>`");
        return Parts::default();
    };
    let names = knowledge.names();
    let mut reader =
        Reader { names: &names, knowledge: &mut knowledge, context, made: BTreeMap::new() };
    let blocks = bases.into_iter().flat_map(|base| reader.base(base)).collect();
    let name = root.attribute("name").unwrap_or_default().to_owned();
    let inputs = knowledge.named_inputs();
    let Knowledge { outputs, .. } = knowledge;
    Parts { name, description: String::new(), inputs, outputs, blocks }
}

/// What the file does not say.
fn tell(parts: &Parts, context: &mut Context<'_>) {
    if parts.outputs.iter().any(|output| output.defuzzifier.sampling().is_some()) {
        let message = "integrals are exact, for the standard does not say how they are computed";
        context.report.note_whole(message);
    }
}
