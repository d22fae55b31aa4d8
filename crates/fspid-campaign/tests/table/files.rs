//! Writing and reading whole files.

use std::io::{self, Write};
use std::sync::Arc;

use fspid_campaign::table::{
    Cell, Column, ColumnTable, Digest, Kind, ROWS_PER_GROUP, Reader, Schema, TableError, Values,
    Writer,
};
use proptest::prelude::*;
use tempfile::tempdir;

use crate::table::{any_table, file, file_in_pieces, long_table, read, schema};

/// Numbers of rows about the ends of row groups.
const SIZES: [usize; 7] =
    [0, 1, 2, ROWS_PER_GROUP - 1, ROWS_PER_GROUP, ROWS_PER_GROUP + 1, 2 * ROWS_PER_GROUP];

fn pair(key: &str, value: &str) -> (String, String) {
    (key.to_owned(), value.to_owned())
}

#[test]
fn a_file_of_any_length_is_read_as_written() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("t.parquet");
    for rows in SIZES {
        let table = long_table(rows);
        let (reader, whole) = read(&path, &file(&table)).unwrap();
        assert_eq!(reader.rows(), rows);
        assert!(whole == table, "{rows} rows");
        assert_eq!(reader.verify().unwrap(), Digest::of(&table));
        let groups: Vec<usize> = reader.tables().map(|table| table.unwrap().rows()).collect();
        let full = groups.split_last().map_or(&[][..], |(_, full)| full);
        assert!(full.iter().all(|rows| *rows == ROWS_PER_GROUP), "{groups:?}");
    }
}

#[test]
fn the_same_rows_are_the_same_bytes_in_pieces_of_any_size() {
    let table = long_table(2 * ROWS_PER_GROUP + 5);
    let (bytes, digest) = file_in_pieces(&table, table.rows(), &[]);
    assert_eq!(digest, Digest::of(&table));
    for piece in [97, ROWS_PER_GROUP - 1, ROWS_PER_GROUP, ROWS_PER_GROUP + 1] {
        let again = file_in_pieces(&table, piece, &[]);
        assert!(again.0 == bytes, "pieces of {piece}");
        assert_eq!(again.1, digest);
    }
}

#[test]
fn metadata_and_columns_come_back_in_their_order() {
    let folder = tempdir().unwrap();
    let columns = vec![
        Column::new("overshoot_pct", Kind::Float).unit("%").meaning("Beyond the \"final\" value."),
        Column::new("läuft", Kind::Boolean),
    ];
    let schema = Arc::new(Schema::new(columns).unwrap());
    let mut writer = Writer::new(Vec::new(), &schema, &[pair("z", "1"), pair("a", "")]).unwrap();
    writer.write(&ColumnTable::new(Arc::clone(&schema))).unwrap();
    let (bytes, digest) = writer.finish(&[pair("m", "ü\n")]).unwrap();
    let (reader, _) = read(&folder.path().join("t.parquet"), &bytes).unwrap();
    assert_eq!(reader.schema(), &schema);
    assert_eq!(reader.metadata(), [pair("z", "1"), pair("a", ""), pair("m", "ü\n")]);
    assert_eq!(reader.metadata_value("m"), Some("ü\n"));
    assert_eq!(reader.metadata_value("n"), None);
    assert_eq!(reader.digest(), digest);
}

#[test]
fn a_key_is_taken_once() {
    let schema = schema(&[Kind::Float]);
    for key in ["fspid.columns", "fspid.digest", "fspid.metadata_digest"] {
        let error = Writer::new(Vec::new(), &schema, &[pair(key, "")]).err().unwrap();
        assert!(matches!(error, TableError::KeyTaken { .. }), "{error}");
    }
    let writer = Writer::new(Vec::new(), &schema, &[pair("a", "1")]).unwrap();
    assert!(
        matches!(writer.finish(&[pair("a", "2")]), Err(TableError::KeyTaken { key }) if key == "a")
    );
}

#[test]
fn a_table_of_other_columns_is_not_written() {
    let mut writer = Writer::new(Vec::new(), &schema(&[Kind::Float]), &[]).unwrap();
    let other = ColumnTable::new(schema(&[Kind::Float, Kind::Float]));
    assert!(matches!(writer.write(&other), Err(TableError::OtherSchema)));
}

#[test]
fn reading_some_columns_gives_what_reading_all_gives() {
    let folder = tempdir().unwrap();
    let table = long_table(ROWS_PER_GROUP + 100);
    let (reader, _) = read(&folder.path().join("t.parquet"), &file(&table)).unwrap();

    let mut floats = Vec::new();
    reader.floats("e").unwrap().for_each(|cells| floats.extend(cells.unwrap()));
    assert_eq!(floats, table.floats("e").unwrap());

    for (index, column) in table.schema().columns().iter().enumerate() {
        let mut row = 0;
        for values in reader.column(&column.name).unwrap() {
            let values = values.unwrap();
            assert_eq!(values.kind(), column.kind);
            for cell in 0..values.len() {
                assert_eq!(values.cell(cell), table.cell(row, index));
                row += 1;
            }
        }
        assert_eq!(row, table.rows());
    }

    let mut rows = 0;
    for part in reader.columns(&["d", "a"]).unwrap() {
        let part = part.unwrap();
        assert_eq!(
            part.schema().columns().iter().map(|column| &*column.name).collect::<Vec<_>>(),
            ["d", "a"]
        );
        assert_eq!(part.cell(0, 0), table.cell(rows, 3));
        assert_eq!(part.cell(part.rows() - 1, 1), table.cell(rows + part.rows() - 1, 0));
        rows += part.rows();
    }
    assert_eq!(rows, table.rows());
}

#[test]
fn columns_that_a_file_does_not_have_are_refused_by_name() {
    let folder = tempdir().unwrap();
    let (reader, _) = read(&folder.path().join("t.parquet"), &file(&long_table(3))).unwrap();
    assert!(matches!(reader.columns(&["a", "z"]).err(), Some(TableError::UnknownColumn { .. })));
    assert!(matches!(reader.columns(&["a", "a"]).err(), Some(TableError::DuplicateColumn { .. })));
    assert!(matches!(reader.columns(&[]).err(), Some(TableError::NoColumns)));
    assert!(matches!(reader.column("z").err(), Some(TableError::UnknownColumn { .. })));
    let error = reader.floats("b").err().unwrap();
    assert!(
        matches!(error, TableError::Kind { expected: Kind::Integer, found: Kind::Float, .. }),
        "{error}"
    );
}

#[test]
fn two_columns_of_a_reader_can_be_read_at_the_same_time() {
    let folder = tempdir().unwrap();
    let table = long_table(ROWS_PER_GROUP + 3);
    let (reader, _) = read(&folder.path().join("t.parquet"), &file(&table)).unwrap();
    let (a, b) = (reader.column("a").unwrap(), reader.column("b").unwrap());
    let mut row = 0;
    for (a, b) in a.zip(b) {
        let (a, b) = (a.unwrap(), b.unwrap());
        assert_eq!(a.cell(0), table.cell(row, 0));
        assert_eq!(b.cell(0), table.cell(row, 1));
        row += a.len();
    }
    assert_eq!(row, table.rows());
}

#[test]
fn the_longest_texts_all_different_go_through() {
    let folder = tempdir().unwrap();
    let schema = schema(&[Kind::Text]);
    let texts = (0..300).map(|i| Some(format!("{i:0>4096}"))).collect();
    let table = ColumnTable::from_values(schema, vec![Values::Text(texts)]).unwrap();
    let (reader, whole) = read(&folder.path().join("t.parquet"), &file(&table)).unwrap();
    assert!(whole == table);
    reader.verify().unwrap();
}

/// A sink that takes some bytes, and at most some in one go.
struct Sink {
    taken: Vec<u8>,
    room: usize,
    at_once: usize,
}

impl Write for Sink {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let room = self.room - self.taken.len();
        if room == 0 && !bytes.is_empty() {
            return Err(io::ErrorKind::StorageFull.into());
        }
        let count = bytes.len().min(room).min(self.at_once);
        self.taken.extend(&bytes[..count]);
        Ok(count)
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

/// The table written to a sink, and then, if that failed, written on.
fn write_to(sink: Sink, table: &ColumnTable) -> Result<Vec<u8>, TableError> {
    let mut writer = Writer::new(sink, table.schema(), &[pair("campaign", "test")])?;
    if let Err(error) = writer.write(table) {
        assert!(matches!(writer.write(table), Err(TableError::Failed)));
        assert!(matches!(writer.finish(&[]), Err(TableError::Failed)));
        return Err(error);
    }
    Ok(writer.finish(&[])?.0.taken)
}

#[test]
fn a_disk_that_is_full_after_any_byte_is_an_error() {
    for (table, step) in [(long_table(12), 1), (long_table(ROWS_PER_GROUP + 10), 1999)] {
        let whole = file(&table);
        for room in (0..whole.len()).step_by(step).chain([whole.len() - 1]) {
            let sink = Sink { taken: Vec::new(), room, at_once: usize::MAX };
            let error = write_to(sink, &table).err();
            assert!(matches!(error, Some(TableError::Write { .. })), "room {room}: {error:?}");
        }
        let sink = Sink { taken: Vec::new(), room: whole.len(), at_once: usize::MAX };
        assert!(write_to(sink, &table).unwrap() == whole);
    }
}

#[test]
fn a_sink_that_takes_little_at_once_gets_the_same_bytes() {
    let table = long_table(500);
    for at_once in [1, 7] {
        let sink = Sink { taken: Vec::new(), room: usize::MAX, at_once };
        assert!(write_to(sink, &table).unwrap() == file(&table));
    }
}

/// A sink whose flush fails.
struct NoFlush;

impl Write for NoFlush {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Err(io::ErrorKind::StorageFull.into())
    }
}

#[test]
fn a_sink_that_cannot_be_flushed_is_an_error() {
    let writer = Writer::new(NoFlush, &schema(&[Kind::Float]), &[]).unwrap();
    let error = writer.finish(&[]).err();
    assert!(matches!(error, Some(TableError::Write { .. })), "{error:?}");
}

#[test]
fn numbers_that_are_none_come_back_as_they_were() {
    let folder = tempdir().unwrap();
    let nan = f64::from_bits(0xfff8_dead_beef_0001);
    let mut table = ColumnTable::new(schema(&[Kind::Float]));
    for value in [nan, f64::INFINITY, f64::NEG_INFINITY, -0.0, 0.0, 5e-324] {
        table.push(&[value.into()]).unwrap();
    }
    table.push(&[Cell::Absent]).unwrap();
    let (_, whole) = read(&folder.path().join("t.parquet"), &file(&table)).unwrap();
    let bits: Vec<_> =
        whole.floats("a").unwrap().iter().map(|cell| cell.map(f64::to_bits)).collect();
    let expected = [
        Some(0x7ff8_0000_0000_0000),
        Some(0x7ff0_0000_0000_0000),
        Some(0xfff0_0000_0000_0000),
        Some(0x8000_0000_0000_0000),
        Some(0),
        Some(1),
        None,
    ];
    assert_eq!(bits, expected);
}

proptest! {
    #[test]
    fn any_table_is_read_as_written(table in any_table(0..60)) {
        let folder = tempdir().unwrap();
        let path = folder.path().join("t.parquet");
        let (bytes, digest) = file_in_pieces(&table, 7, &[]);
        let (reader, whole) = read(&path, &bytes).unwrap();
        prop_assert!(whole == table);
        prop_assert_eq!(reader.schema(), table.schema());
        prop_assert_eq!(reader.verify().unwrap(), digest);
        prop_assert!(file_in_pieces(&table, 60, &[]).0 == bytes);
    }
}

/// Readers can be sent to other threads.
#[test]
fn a_reader_can_be_sent_to_a_thread() {
    fn sent<T: Send>() {}
    sent::<Reader>();
    sent::<Writer<Vec<u8>>>();
}
