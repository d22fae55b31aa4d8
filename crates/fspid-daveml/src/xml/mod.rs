//! Reading DAVE-ML.

mod arithmetic;
mod doctype;
pub(crate) mod element;
mod function;
mod header;
mod math;
mod shot;
mod table;
mod variable;

use roxmltree::{Document as Tree, ParsingOptions};

use crate::compile::compile;
use crate::document::Document;
use crate::finding::{Findings, Origin};
use crate::model::Model;
use crate::{MAX_DEPTH, MAX_INPUT_BYTES};
use element::Element;
use fspid_diagnostics::{Note, Place, Problem, Problems, attributes};

/// Most elements and texts of a file; each takes some hundred bytes of memory.
const MAX_NODES: u32 = 2_000_000;

/// A model that was read.
#[derive(Clone, Debug)]
pub struct Reading {
    /// What the file says.
    pub document: Document,
    /// The model that computes it.
    pub model: Model,
    /// What was assumed and left out, in the order of places.
    pub notes: Vec<Note>,
}

/// Reads a DAVE-ML file.
///
/// # Errors
/// Every problem of the text with its place; if each element can be read, every problem of what they mean together: XML
/// numbers that are none, names that nothing has, tables of the wrong size, calculations that go in a circle.
pub fn read(text: &str) -> Result<Reading, Problems> {
    let tree = parse(text).map_err(|problem| Problems::of_text(vec![problem]))?;
    let mut findings = Findings::default();
    let document = document(&tree, &mut findings);
    let model = if findings.good() { compile(&document, &mut findings) } else { None };
    let notes = findings.finish(text)?;
    let model = model.ok_or_else(|| Problems::of_text(Vec::new()))?;
    Ok(Reading { document, model, notes })
}

pub(crate) fn parse(text: &str) -> Result<Tree<'_>, Problem> {
    if text.len() > MAX_INPUT_BYTES {
        return Err(too_long(text.len()));
    }
    doctype::check(text)?;
    attributes::too_many(text).map_or(Ok(()), Err)?;
    let options =
        ParsingOptions { allow_dtd: true, nodes_limit: MAX_NODES, ..ParsingOptions::default() };
    Tree::parse_with_options(text, options).map_err(|error| not_well_formed(&error))
}

fn too_long(bytes: usize) -> Problem {
    Problem::whole(format!("{bytes} bytes"), format!("at most {MAX_INPUT_BYTES} bytes"))
}

fn not_well_formed(error: &roxmltree::Error) -> Problem {
    let at = error.pos();
    let sentence = error.to_string();
    let sentence = sentence.split(" at ").next().unwrap_or_default();
    let place = Place { line: at.row as usize, column: at.col as usize };
    Problem::at(place, "", format!("this is not well-formed XML: {sentence}"), "")
}

fn document(tree: &Tree<'_>, findings: &mut Findings) -> Document {
    let mut document = Document::default();
    let root = Element::root(tree);
    if let Some(deep) = root.deeper_than(MAX_DEPTH) {
        let expected = format!("at most {MAX_DEPTH} elements inside each other");
        findings.problem(deep.origin(), deep.name(), "nested too deeply", expected);
    } else if root.name() == "DAVEfunc" {
        parts(root, &mut document, findings);
    } else {
        findings.problem(
            root.origin(),
            root.name(),
            "this is not a DAVE-ML file",
            "<DAVEfunc> around everything",
        );
    }
    document
}

fn parts(root: Element<'_, '_>, document: &mut Document, findings: &mut Findings) {
    for part in root.children(findings) {
        match part.name() {
            "fileHeader" => document.header = header::read(part, findings),
            "variableDef" => document.variables.push(variable::read(part, findings)),
            "breakpointDef" => document.breakpoints.push(table::breakpoints(part, findings)),
            "griddedTableDef" | "griddedTable" => {
                document.tables.push(table::read(part, None, findings));
            }
            "function" => function::read(part, document, findings),
            "checkData" => shot::read(part, document, findings),
            "ungriddedTableDef" | "ungriddedTable" => {
                part.refuse("DAVEfunc", function::UNGRIDDED, findings);
            }
            _ => part.refuse(
                "DAVEfunc",
                "fileHeader, variableDef, breakpointDef, griddedTableDef, function, checkData",
                findings,
            ),
        }
    }
    if document.variables.is_empty() && findings.good() {
        findings.problem(
            Origin(None),
            "",
            "a model without variables",
            "at least one <variableDef>",
        );
    }
}
