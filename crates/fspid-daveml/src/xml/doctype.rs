//! The document type: a name of the standard is fine, declarations of one's own are not.
//!
//! Entities that a file declares could blow up a short text; a model needs none of them.

use fspid_diagnostics::{LineStarts, Problem};

/// Refuses a document type with declarations inside the file, which begin with `[`.
pub(super) fn check(text: &str) -> Result<(), Problem> {
    match declarations(text) {
        None => Ok(()),
        Some(byte) => Err(Problem::at(
            LineStarts::of(text).place(text, byte),
            "[",
            "declarations inside the file are not read",
            "a <!DOCTYPE …> without [ … ], and numbers instead of entities",
        )),
    }
}

/// Byte of the `[` in the document type; `None` if there is none before the first element.
fn declarations(text: &str) -> Option<usize> {
    let mut at = 0;
    loop {
        let rest = text.get(at..)?;
        let start = at + rest.find('<')?;
        let rest = text.get(start..)?;
        if rest.starts_with("<!DOCTYPE") {
            return bracket(text, start);
        }
        at = start + length_of_remark(rest)?;
    }
}

/// Length of a comment or processing instruction; `None` for anything else.
fn length_of_remark(rest: &str) -> Option<usize> {
    let end = if rest.starts_with("<!--") {
        "-->"
    } else if rest.starts_with("<?") {
        "?>"
    } else {
        return None;
    };
    rest.find(end).map(|length| length + end.len())
}

/// First `[` outside of quotes between a byte and the next `>` outside of quotes.
fn bracket(text: &str, start: usize) -> Option<usize> {
    let mut quote = None;
    for (index, character) in text.get(start..)?.char_indices() {
        match (quote, character) {
            (None, '"' | '\'') => quote = Some(character),
            (None, '[') => return Some(start + index),
            (None, '>') => return None,
            (Some(open), _) if open == character => quote = None,
            _ => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use fspid_diagnostics::Place;

    use super::*;

    #[test]
    fn a_document_type_of_the_standard_is_fine() {
        let text =
            "<?xml version=\"1.0\"?>\n<!-- [ -->\n<!DOCTYPE DAVEfunc PUBLIC \"a[b\" 'c>d'>\n<a/>";
        assert_eq!(check(text), Ok(()));
        assert_eq!(check("<a><![CDATA[x]]></a>"), Ok(()));
        assert_eq!(check("no markup"), Ok(()));
    }

    #[test]
    fn declarations_inside_the_file_are_refused_with_their_place() {
        let problem = check("<!-- x -->\n<!DOCTYPE a [<!ENTITY b 'c'>]><a/>").expect_err("refused");
        assert_eq!(problem.place, Some(Place { line: 2, column: 13 }));
    }
}
