//! Rows in memory, schemas and digests.

use std::sync::Arc;

use fspid_campaign::table::{
    Cell, Column, ColumnTable, Digest, Digester, Kind, MAX_TEXT_BYTES, Schema, TableError, Values,
};
use proptest::prelude::*;

use crate::table::{any_table, schema};

#[test]
fn a_schema_without_columns_is_refused() {
    assert!(matches!(Schema::new(Vec::new()), Err(TableError::NoColumns)));
}

#[test]
fn names_that_an_sql_engine_would_take_for_one_are_refused() {
    let columns = ["kp", "ki", "Kp"].map(|name| Column::new(name, Kind::Float));
    let error = Schema::new(columns.to_vec()).unwrap_err();
    assert!(
        matches!(&error, TableError::DuplicateColumn { name, first: 0, second: 2 } if name == "Kp"),
        "{error}"
    );
}

#[test]
fn a_name_without_letters_or_with_a_line_feed_is_refused() {
    for name in ["", "a\nb"] {
        let error = Schema::new(vec![Column::new(name, Kind::Float)]).unwrap_err();
        assert!(matches!(error, TableError::ColumnName { index: 0, .. }), "{error}");
    }
}

#[test]
fn a_row_that_does_not_fit_leaves_the_table_as_it_was() {
    let mut table = ColumnTable::new(schema(&[Kind::Float, Kind::Text]));
    let error = table.push(&[1.0.into()]).unwrap_err();
    assert!(matches!(error, TableError::RowLength { found: 1, expected: 2 }), "{error}");
    let error = table.push(&[1.0.into(), 2_i64.into()]).unwrap_err();
    assert!(
        matches!(error, TableError::Kind { expected: Kind::Text, found: Kind::Integer, .. }),
        "{error}"
    );
    let long = "x".repeat(MAX_TEXT_BYTES + 1);
    let error = table.push(&[1.0.into(), long.as_str().into()]).unwrap_err();
    assert!(matches!(error, TableError::TextTooLong { bytes: 4097, allowed: 4096, .. }), "{error}");
    assert_eq!(table.rows(), 0);
    assert!(table.values().iter().all(Values::is_empty));
    table.push(&[Cell::Absent, long[1..].into()]).unwrap();
    assert_eq!(table.rows(), 1);
}

#[test]
fn columns_that_do_not_fit_are_refused() {
    let schema = schema(&[Kind::Float, Kind::Text]);
    let (float, text) =
        (|rows| Values::Float(vec![None; rows]), |rows| Values::Text(vec![None; rows]));
    let error = ColumnTable::from_values(Arc::clone(&schema), vec![float(2), text(3)]).unwrap_err();
    assert!(matches!(error, TableError::UnequalRows { found: 3, expected: 2, .. }), "{error}");
    let error = ColumnTable::from_values(Arc::clone(&schema), vec![text(2), float(2)]).unwrap_err();
    assert!(matches!(error, TableError::Kind { .. }), "{error}");
    let error = ColumnTable::from_values(Arc::clone(&schema), vec![float(2)]).unwrap_err();
    assert!(matches!(error, TableError::RowLength { found: 1, expected: 2 }), "{error}");
    let long = Values::Text(vec![Some("x".repeat(MAX_TEXT_BYTES + 1)), None]);
    let error = ColumnTable::from_values(schema, vec![float(2), long]).unwrap_err();
    assert!(matches!(error, TableError::TextTooLong { .. }), "{error}");
}

#[test]
fn rows_that_a_table_does_not_have_are_refused_and_not_invented() {
    let table = crate::table::long_table(5);
    for rows in [3..6, 6..6, std::ops::Range { start: 4, end: 3 }] {
        assert!(matches!(table.slice(rows), Err(TableError::NoSuchRows { rows: 5, .. })));
    }
    assert!(table.cell(5, 0).is_none());
    assert!(table.cell(0, 5).is_none());
    assert_eq!(table.cell(0, 2), Some(Cell::Absent));
}

#[test]
fn numbers_are_had_by_the_name_of_their_column() {
    let table = crate::table::long_table(5);
    assert_eq!(table.floats("e").unwrap(), [None, Some(0.25), Some(0.25), Some(0.25), None]);
    assert!(matches!(
        table.floats("b"),
        Err(TableError::Kind { expected: Kind::Integer, found: Kind::Float, .. })
    ));
    let error = table.floats("z").unwrap_err();
    assert_eq!(error.to_string(), "there is no column \"z\"; there are a, b, c, d, e");
}

#[test]
fn tables_of_other_columns_are_not_appended() {
    let mut table = ColumnTable::new(schema(&[Kind::Float]));
    let other = ColumnTable::new(schema(&[Kind::Integer]));
    assert!(matches!(table.append(&other), Err(TableError::OtherSchema)));
}

/// Made by hand from the rules that [`Digest`] states, and hashed with Python's `hashlib`.
#[test]
fn the_digest_is_what_its_rules_say() {
    let columns = vec![
        Column::new("x_m", Kind::Float).unit("m").meaning("é"),
        Column::new("n", Kind::Integer),
        Column::new("t", Kind::Text),
        Column::new("b", Kind::Boolean),
    ];
    let mut table = ColumnTable::new(Arc::new(Schema::new(columns).unwrap()));
    let nan = f64::from_bits(0xfff8_dead_beef_0001);
    table.push(&[nan.into(), (-2_i64).into(), "ü".into(), true.into()]).unwrap();
    table.push(&[(-0.0).into(), Cell::Absent, "".into(), false.into()]).unwrap();
    let expected = "074b45673742beb0448f51c8dfa61e5b54fc47aa70387f03a86c37323b04ec86";
    assert_eq!(Digest::of(&table).to_string(), expected);
    assert_eq!(expected.parse::<Digest>().unwrap(), Digest::of(&table));
}

#[test]
fn a_digest_is_read_from_64_small_hexadecimal_digits_only() {
    let good = Digest::of(&crate::table::long_table(1)).to_string();
    assert_eq!(good.len(), 64);
    assert_eq!(good.parse::<Digest>().unwrap().to_string(), good);
    for bad in
        [&good[1..], &format!("{good}0"), &good.replace(&good[..1], "g"), "", &"é".repeat(32)]
    {
        assert!(bad.parse::<Digest>().is_err(), "{bad}");
    }
}

#[test]
fn the_digest_changes_with_every_word_of_the_columns() {
    let column = Column::new("a", Kind::Float).unit("m").meaning("x");
    let digest = |column: Column| {
        Digest::of(&ColumnTable::new(Arc::new(Schema::new(vec![column]).unwrap())))
    };
    let others = [
        Column { name: "b".to_owned(), ..column.clone() },
        Column { kind: Kind::Integer, ..column.clone() },
        column.clone().unit("s"),
        column.clone().meaning("y"),
        column.clone().unit("mx").meaning(""),
    ];
    for other in others {
        assert_ne!(digest(other.clone()), digest(column.clone()), "{other:?}");
    }
}

/// Another cell than the one given, in the same column.
fn other_than(cell: Cell<'_>, kind: Kind) -> Cell<'static> {
    match (cell, kind) {
        (Cell::Absent, Kind::Float) => 0.0.into(),
        (Cell::Absent, Kind::Integer) => 0_i64.into(),
        (Cell::Absent, Kind::Text) => "".into(),
        (Cell::Absent, Kind::Boolean) => false.into(),
        // The last bit; of NaN and infinity, whose neighbours may be NaN again, the kind of number.
        (Cell::Float(value), _) if value.is_finite() => f64::from_bits(value.to_bits() ^ 1).into(),
        (Cell::Float(_), _) => 1.0.into(),
        (Cell::Integer(value), _) => (value ^ 1).into(),
        (Cell::Text(text), _) => if text.is_empty() { "\0" } else { "" }.into(),
        (Cell::Boolean(value), _) => (!value).into(),
    }
}

/// The table with one cell replaced.
fn with_cell(table: &ColumnTable, place: (usize, usize), cell: Cell<'_>) -> ColumnTable {
    let mut other = ColumnTable::new(Arc::clone(table.schema()));
    for row in 0..table.rows() {
        let mut cells: Vec<Cell<'_>> =
            table.values().iter().map(|values| values.cell(row).unwrap()).collect();
        if row == place.0 {
            cells[place.1] = cell;
        }
        other.push(&cells).unwrap();
    }
    other
}

proptest! {
    #[test]
    fn the_digest_changes_with_any_cell(
        table in any_table(1..8), row in any::<prop::sample::Index>(), column in any::<prop::sample::Index>(),
    ) {
        let kinds = table.schema().columns();
        let (row, column) = (row.index(table.rows().max(1)), column.index(kinds.len()));
        prop_assume!(table.rows() > 0);
        let cell = other_than(table.cell(row, column).unwrap(), kinds[column].kind);
        let other = with_cell(&table, (row, column), cell);
        prop_assert_ne!(Digest::of(&other), Digest::of(&table));
        prop_assert!(other != table);
    }

    #[test]
    fn the_digest_does_not_see_how_rows_arrive(table in any_table(0..20), piece in 1_usize..7) {
        let mut digester = Digester::new(table.schema());
        let mut start = 0;
        while start < table.rows() {
            let end = table.rows().min(start + piece);
            digester.update(&table.slice(start..end).unwrap());
            start = end;
        }
        prop_assert_eq!(digester.finish(), Digest::of(&table));
    }

    #[test]
    fn slices_put_together_are_the_table(table in any_table(0..20), cut in any::<prop::sample::Index>()) {
        let cut = cut.index(table.rows() + 1);
        let mut joined = table.slice(0..cut).unwrap();
        joined.append(&table.slice(cut..table.rows()).unwrap()).unwrap();
        prop_assert!(joined == table);
    }

    #[test]
    fn a_table_of_its_own_columns_is_the_same(table in any_table(0..20)) {
        let again = ColumnTable::from_values(Arc::clone(table.schema()), table.values().to_vec()).unwrap();
        prop_assert!(again == table);
    }
}
