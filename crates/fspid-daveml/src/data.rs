//! Models in a TOML file of this project: what a `.dml` file says, without XML, to be read back bit for bit.
//!
//! The keys are the fields of [`Document`]; formulas are texts such as `plus(CL0, times(k, CL, CL))` with the function
//! names of MathML, `piecewise(value, condition, …, otherwise)` among them. Numbers are written with the shortest digits
//! that give the same bits.
//!
//! ```
//! use fspid_daveml::data;
//!
//! let text = r#"
//! schema = 1
//! [header]
//! name = "lift"
//! [[variables]]
//! id = "alpha"
//! name = "angleOfAttack"
//! units = "deg"
//! roles = ["input"]
//! [[variables]]
//! id = "CL"
//! name = "liftCoefficient"
//! units = "nd"
//! roles = ["output"]
//! formula = "times(0.1, alpha)"
//! "#;
//! let reading = data::read(text)?;
//! assert_eq!(data::read(&data::write(&reading.document))?.document, reading.document);
//! # Ok::<(), fspid_daveml::Problems>(())
//! ```

use serde::{Deserialize, Serialize};

use crate::MAX_INPUT_BYTES;
use crate::compile::compile;
use crate::document::{Breakpoints, Document, GridTable, Header, Shot, TableFunction, Variable};
use crate::finding::{Findings, Origin};
use crate::xml::Reading;
use fspid_diagnostics::Problems;

/// Version of the keys.
const SCHEMA: u32 = 1;

/// Longest line of numbers.
const WIDTH: usize = 120;

#[derive(Deserialize, Serialize)]
#[serde(deny_unknown_fields)]
struct File {
    schema: u32,
    header: Header,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    variables: Vec<Variable>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    breakpoints: Vec<Breakpoints>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    tables: Vec<GridTable>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    functions: Vec<TableFunction>,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    shots: Vec<Shot>,
}

impl From<Document> for File {
    fn from(document: Document) -> Self {
        let Document { header, variables, breakpoints, tables, functions, shots } = document;
        Self { schema: SCHEMA, header, variables, breakpoints, tables, functions, shots }
    }
}

impl From<File> for Document {
    fn from(file: File) -> Self {
        let File { header, variables, breakpoints, tables, functions, shots, .. } = file;
        Self { header, variables, breakpoints, tables, functions, shots }
    }
}

/// The text of a file.
#[must_use]
pub fn write(document: &Document) -> String {
    let written = toml::to_string(&File::from(document.clone()));
    // Strings, numbers and lists of them: nothing that TOML cannot say.
    let text = written.unwrap_or_default();
    text.lines().map(folded).collect()
}

/// A line, or several if it is a long list of numbers.
fn folded(line: &str) -> String {
    let mut text = String::with_capacity(line.len() + 1);
    let mut width = 0;
    let foldable = line.len() > WIDTH && line.starts_with("values = [");
    for piece in line.split_inclusive(", ") {
        if foldable && width + piece.len() > WIDTH {
            text.truncate(text.trim_end().len());
            text.push_str("\n  ");
            width = 2;
        }
        text.push_str(piece);
        width += piece.len();
    }
    text.push('\n');
    text
}

/// Reads a file that [`write()`] or somebody made.
///
/// # Errors
/// The first thing that is not TOML or not a key or value of this format, with its place; or every problem of names,
/// numbers, sizes and order.
pub fn read(text: &str) -> Result<Reading, Problems> {
    let mut findings = Findings::default();
    let document = parsed(text, &mut findings);
    let model = document.as_ref().and_then(|document| compile(document, &mut findings));
    let notes = findings.finish(text)?;
    let both = document.zip(model);
    both.map(|(document, model)| Reading { document, model, notes })
        .ok_or_else(|| Problems::of_text(Vec::new()))
}

fn parsed(text: &str, findings: &mut Findings) -> Option<Document> {
    if text.len() > MAX_INPUT_BYTES {
        let expected = format!("at most {MAX_INPUT_BYTES} bytes");
        findings.problem(Origin(None), "", format!("{} bytes", text.len()), expected);
        return None;
    }
    match toml::from_str::<File>(text) {
        Ok(file) if file.schema == SCHEMA => Some(file.into()),
        Ok(file) => {
            let found = file.schema.to_string();
            findings.problem(Origin(None), &found, "unknown schema", SCHEMA.to_string());
            None
        }
        Err(error) => {
            let at = Origin(error.span().map(|span| span.start));
            findings.problem(at, "", error.message(), "");
            None
        }
    }
}
