//! Every number of the paper and every claim in words, with what became of it.

use crate::report::Paper;
use crate::report::templates::render;
use crate::{JudgedClaim, JudgedStatement};
use fspid_page::context;
use fspid_page::number::fixed;
use fspid_page::page::{Cell, PageSection, PageTable, TableRow};

/// The tables of claims.
pub(super) fn section(paper: &Paper<'_>) -> PageSection {
    let context = context! {
        numbers => numbers(&paper.reproduction.claims),
        statements => statements(&paper.reproduction.statements),
    };
    PageSection::of("claims", "Claims", render("claims", context))
}

fn numbers(claims: &[JudgedClaim]) -> PageTable {
    let head = [
        "id", "quantity", "unit", "paper", "value", "status", "value", "status", "rests on", "note",
    ];
    let mut table = PageTable::new("Every number of the paper's results.", &head)
        .grouped(&[("", 4), ("own fit", 2), ("shared supervisor", 2), ("", 2)])
        .in_cards();
    for judged in claims {
        // One digit more than the paper prints.
        let decimals =
            judged.claim.paper.0.split_once('.').map_or(0, |(_, decimals)| decimals.len()) + 1;
        let value = |value: Result<f64, fspid_study::metrics::Absent>| match value {
            Ok(value) => Cell::number(fixed(value, decimals)),
            Err(reason) => Cell { class: "absent", ..Cell::text(reason.to_string()) },
        };
        table.push(TableRow {
            id: judged.claim.id.to_owned(),
            class: "",
            cells: vec![
                Cell::text(judged.claim.id),
                Cell::text(judged.claim.quantity),
                Cell::text(judged.claim.unit),
                Cell::number(judged.claim.paper.0),
                value(judged.ours),
                super::status(judged.status),
                value(judged.shared),
                super::status(judged.shared_status),
                Cell::links(judged.assumptions),
                Cell::linked(&judged.note),
            ],
        });
    }
    table
}

fn statements(statements: &[JudgedStatement]) -> PageTable {
    let head = ["id", "the paper says", "we find", "status", "rests on", "how it is judged"];
    let mut table =
        PageTable::new("Every claim in words that a flight can answer.", &head).in_cards();
    for judged in statements {
        table.push(TableRow {
            id: judged.id.to_owned(),
            class: "",
            cells: vec![
                Cell::text(judged.id),
                Cell::text(judged.paper),
                Cell::text(&judged.ours),
                super::status(judged.status),
                Cell::links(judged.assumptions),
                Cell::linked(judged.note),
            ],
        });
    }
    table
}
