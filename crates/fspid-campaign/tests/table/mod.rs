//! Tables of results: what is written is read, the same rows are the same bytes, and no file,
//! whatever is in it, does more than be refused.

#![allow(
    clippy::unwrap_used,
    clippy::float_cmp,
    clippy::print_stdout,
    reason = "a test; floats that are compared are the same bits"
)]

mod damage;
mod files;
mod rows;

use std::path::Path;
use std::sync::Arc;

use fspid_campaign::table::{
    Cell, Column, ColumnTable, Digest, Kind, Reader, Schema, TableError, Writer,
};
use proptest::prelude::*;

/// A cell that owns its text.
#[derive(Debug, Clone)]
pub(crate) enum Owned {
    Absent,
    Float(f64),
    Integer(i64),
    Text(String),
    Boolean(bool),
}

impl Owned {
    fn cell(&self) -> Cell<'_> {
        match self {
            Self::Absent => Cell::Absent,
            Self::Float(value) => Cell::Float(*value),
            Self::Integer(value) => Cell::Integer(*value),
            Self::Text(text) => Cell::Text(text),
            Self::Boolean(value) => Cell::Boolean(*value),
        }
    }
}

/// Columns of these kinds, called a, b, c, …
pub(crate) fn schema(kinds: &[Kind]) -> Arc<Schema> {
    let names = ('a'..='z').map(String::from);
    let columns = names
        .zip(kinds)
        .map(|(name, kind)| Column::new(name, *kind).unit("m/s").meaning("a thing"));
    Arc::new(Schema::new(columns.collect()).unwrap())
}

/// A table of these rows.
pub(crate) fn table(schema: &Arc<Schema>, rows: &[Vec<Owned>]) -> ColumnTable {
    let mut table = ColumnTable::new(Arc::clone(schema));
    for row in rows {
        table.push(&row.iter().map(Owned::cell).collect::<Vec<_>>()).unwrap();
    }
    table
}

/// A table of every kind whose cells are made from the row, with absent ones and all different ones.
pub(crate) fn long_table(rows: usize) -> ColumnTable {
    let schema = schema(&[Kind::Float, Kind::Integer, Kind::Text, Kind::Boolean, Kind::Float]);
    let mut table = ColumnTable::new(schema);
    for row in 0..rows {
        let text = format!("run {}", row % 7);
        let float = (row as f64).sqrt();
        let cells: [Cell<'_>; 5] = [
            float.into(),
            (row as i64).into(),
            (row % 5 > 0).then_some(text.as_str()).into(),
            (row % 3 > 0).then_some(row % 2 == 0).into(),
            (row % 4 > 0).then_some(0.25).into(),
        ];
        table.push(&cells).unwrap();
    }
    table
}

/// A file of a table that arrives in pieces of so many rows.
pub(crate) fn file_in_pieces(
    table: &ColumnTable,
    piece: usize,
    metadata: &[(String, String)],
) -> (Vec<u8>, Digest) {
    let mut writer = Writer::new(Vec::new(), table.schema(), metadata).unwrap();
    let mut start = 0;
    while start < table.rows() {
        let end = table.rows().min(start + piece);
        writer.write(&table.slice(start..end).unwrap()).unwrap();
        start = end;
    }
    writer.finish(&[]).unwrap()
}

/// A file of a table.
pub(crate) fn file(table: &ColumnTable) -> Vec<u8> {
    file_in_pieces(table, usize::MAX / 2, &[("campaign".to_owned(), "test".to_owned())]).0
}

/// Everything in a file whose bytes are put to a path.
pub(crate) fn read(path: &Path, bytes: &[u8]) -> Result<(Reader, ColumnTable), TableError> {
    std::fs::write(path, bytes).unwrap();
    let reader = Reader::open(path)?;
    let mut whole = ColumnTable::new(Arc::clone(reader.schema()));
    for table in reader.tables() {
        whole.append(&table?)?;
    }
    Ok((reader, whole))
}

/// Any cell of a column of some kind.
fn any_cell(kind: Kind) -> BoxedStrategy<Owned> {
    let few =
        prop::sample::select(vec![0.0, -0.0, f64::NAN, f64::INFINITY, f64::NEG_INFINITY, 5e-324]);
    let value = match kind {
        Kind::Float => {
            prop_oneof![any::<u64>().prop_map(f64::from_bits), few].prop_map(Owned::Float).boxed()
        }
        Kind::Integer => prop_oneof![any::<i64>(), -3_i64..3].prop_map(Owned::Integer).boxed(),
        Kind::Text => prop_oneof!["[a-c]?", ".{0,40}"].prop_map(Owned::Text).boxed(),
        Kind::Boolean => any::<bool>().prop_map(Owned::Boolean).boxed(),
    };
    prop_oneof![1 => Just(Owned::Absent), 3 => value].boxed()
}

/// Any table of at most five columns and so many rows.
pub(crate) fn any_table(rows: std::ops::Range<usize>) -> impl Strategy<Value = ColumnTable> {
    let kinds = prop::collection::vec(prop::sample::select(Kind::ALL.to_vec()), 1..6);
    (kinds, rows).prop_flat_map(|(kinds, rows)| {
        let row: Vec<_> = kinds.iter().map(|kind| any_cell(*kind)).collect();
        let rows = prop::collection::vec(row, rows);
        rows.prop_map(move |rows| table(&schema(&kinds), &rows))
    })
}
