//! Elements of XML with more attributes than anything needs.
//!
//! A reader of XML compares each attribute of an element with those before it, so that one element of 300 000 takes
//! minutes; here they are counted first, in one pass.

use crate::{LineStarts, Problem};

/// Most attributes of an element; formats that are read here have some ten.
pub const MOST_ATTRIBUTES: usize = 1000;

/// Where an element begins that has more than [`MOST_ATTRIBUTES`], bytes from the start.
fn crowded(text: &str) -> Option<usize> {
    let mut at = 0;
    while let Some(found) = text.get(at..)?.find('<') {
        let begin = at + found;
        let rest = text.get(begin..)?;
        at = begin
            + match skipped(rest) {
                Some(length) => length,
                None => {
                    let (length, attributes) = tag(rest);
                    if attributes > MOST_ATTRIBUTES {
                        return Some(begin);
                    }
                    length
                }
            };
    }
    None
}

/// The problem of such an element, if there is one.
#[must_use]
pub fn too_many(text: &str) -> Option<Problem> {
    let place = LineStarts::of(text).place(text, crowded(text)?);
    let message = "so many attributes that reading them would take minutes";
    Some(Problem::at(place, "<", message, format!("at most {MOST_ATTRIBUTES} attributes")))
}

/// How long what has no attributes is: a comment, a block of characters, an instruction.
fn skipped(text: &str) -> Option<usize> {
    let kinds = [("<!--", "-->"), ("<![CDATA[", "]]>"), ("<?", "?>")];
    let (_, end) = kinds.into_iter().find(|(begin, _)| text.starts_with(begin))?;
    Some(text.find(end).map_or(text.len(), |at| at + end.len()))
}

/// How long a tag is, and how many attributes it has: signs of equality outside of quotes.
fn tag(text: &str) -> (usize, usize) {
    let (mut quote, mut attributes) = (None, 0);
    for (at, byte) in text.bytes().enumerate() {
        match (quote, byte) {
            (Some(open), byte) if byte == open => quote = None,
            (Some(_), _) => {}
            (None, b'"' | b'\'') => quote = Some(byte),
            (None, b'=') => attributes += 1,
            (None, b'>') => return (at + 1, attributes),
            (None, _) => {}
        }
    }
    (text.len(), attributes)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_element_with_too_many_attributes_is_found_where_it_begins() {
        let attributes =
            |count: usize| (0..count).map(|n| format!(" a{n}='>='")).collect::<String>();
        let text =
            |count| format!("<?xml a=b?><!-- <x a=b> --><r b=\"=\"><x{}/></r>", attributes(count));
        assert_eq!(crowded(&text(MOST_ATTRIBUTES)), None);
        let crowd = text(MOST_ATTRIBUTES + 1);
        assert_eq!(crowded(&crowd), crowd.find("<x a0"));
        for odd in ["", "<", "<!--", "<a b='", "é<é a=é", "<![CDATA[ <"] {
            assert_eq!(crowded(odd), None, "{odd}");
        }
    }
}
