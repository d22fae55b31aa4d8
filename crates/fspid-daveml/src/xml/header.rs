//! The header of a file, and where parts of it come from.

use crate::document::{Author, Header, Modification, Provenance, Source};
use crate::finding::Findings;
use crate::xml::element::Element;

pub(super) fn read(header: Element<'_, '_>, findings: &mut Findings) -> Header {
    header.only(&["name"], findings);
    let mut read = Header { name: header.required("name", findings), ..Header::default() };
    for part in header.children(findings) {
        match part.name() {
            "author" => read.authors.push(author(part)),
            "creationDate" | "fileCreationDate" => read.date = part.optional("date"),
            "fileVersion" => read.version = part.prose(),
            "description" => read.description = part.prose(),
            "reference" => read.references.push(source(part, findings)),
            "modificationRecord" => read.modifications.push(modification(part, findings)),
            "provenance" | "classification" | "dataRights" => {
                part.leave_out("only the other parts of the header are kept", findings);
            }
            _ => part.refuse(
                "fileHeader",
                "author, creationDate, fileVersion, description, reference, modificationRecord",
                findings,
            ),
        }
    }
    read
}

fn author(author: Element<'_, '_>) -> Author {
    Author {
        name: author.optional("name"),
        organisation: author.optional("org"),
        email: author.optional("email"),
    }
}

fn authors(parent: Element<'_, '_>) -> Vec<Author> {
    parent.elements().filter(|part| part.name() == "author").map(author).collect()
}

fn source(reference: Element<'_, '_>, findings: &mut Findings) -> Source {
    Source {
        id: reference.required("refID", findings),
        author: reference.optional("author"),
        title: reference.optional("title"),
        accession: reference.optional("accession"),
        date: reference.optional("date"),
        address: reference.optional("href"),
        description: reference.prose_of("description"),
    }
}

fn modification(record: Element<'_, '_>, findings: &mut Findings) -> Modification {
    Modification {
        id: record.required("modID", findings),
        date: record.optional("date"),
        authors: authors(record),
        description: record.prose_of("description"),
    }
}

/// Where a table or function comes from.
pub(super) fn provenance(part: Element<'_, '_>) -> Provenance {
    let references = part.elements().filter(|inside| inside.name() == "documentRef");
    let date = part.child("creationDate").or_else(|| part.child("functionCreationDate"));
    Provenance {
        authors: authors(part),
        date: date.map(|date| date.optional("date")).unwrap_or_default(),
        references: references.map(identifier).collect(),
        description: part.prose_of("description"),
    }
}

/// Identifier of a publication; `docID` is its name before version 2.
fn identifier(reference: Element<'_, '_>) -> String {
    let id = reference.optional("refID");
    if id.is_empty() { reference.optional("docID") } else { id }
}
