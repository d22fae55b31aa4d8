//! How a schema lies in a Parquet file: types, encodings, what is left out.
//!
//! Chosen by measuring columns of 2²⁰ values, in bytes a value, with
//! `cargo run --release -p fspid-campaign --example table_encodings`:
//!
//! | column | plain | plain, snappy | split, snappy | dictionary of at most 16 KiB, else plain |
//! | --- | --- | --- | --- | --- |
//! | uniform in 0 … 1 | 8.01 | 8.01 | 7.23 | 8.18 |
//! | uniform in 1 … 1.01 | 8.01 | 8.01 | 6.16 | 8.18 |
//! | multiples of 0.02 up to 30 | 8.01 | 3.81 | 7.38 | 2.12 |
//! | three values | 8.01 | 1.50 | 2.71 | 0.26 |
//! | constant | 8.01 | 0.38 | 0.38 | 0.01 |

use std::sync::Arc;

use parquet::basic::{Compression, Encoding, LogicalType, Repetition, Type as Physical};
use parquet::errors::ParquetError;
use parquet::file::properties::{EnabledStatistics, WriterProperties};
use parquet::schema::types::{ColumnPath, Type, TypePtr};

use super::{Column, Kind, ROWS_PER_GROUP, Schema};

/// Name of the root of the Parquet schema; readers show it nowhere.
const ROOT: &str = "table";

/// A dictionary of numbers beyond this is given up, in bytes: 2048 distinct values in a row group.
///
/// Enough for times that are multiples of a sample period and for factors of a few levels. Larger
/// ones make columns of all different values pay for the attempt: with 64 KiB they take 8.82 bytes a
/// value, with 1 MiB, which is everything, 9.76 and at least four times as long to write.
const NUMBER_DICTIONARY_BYTES: usize = 16 * 1024;

/// Cells that are written before the size of a dictionary is looked at again.
const BATCH_ROWS: usize = 256;

/// The type of a Parquet column.
pub(super) const fn physical(kind: Kind) -> Physical {
    match kind {
        Kind::Float => Physical::DOUBLE,
        Kind::Integer => Physical::INT64,
        Kind::Text => Physical::BYTE_ARRAY,
        Kind::Boolean => Physical::BOOLEAN,
    }
}

/// How values are written where there is no dictionary; texts are always in one.
///
/// Two encodings would save some bytes, but the library (60.1) panics at damaged ones, and what is
/// wrong with them cannot be seen without decoding them. Whole numbers as differences: an index of runs,
/// of which a table has one, would take next to nothing instead of 8 bytes. Texts without a dictionary: those that
/// are all different cost two bytes more with one.
pub(super) const fn plain(kind: Kind) -> bool {
    !matches!(kind, Kind::Text)
}

/// A dictionary beyond this is given up, in bytes; none if there is no dictionary at all.
pub(super) const fn dictionary_bytes(kind: Kind) -> Option<usize> {
    match kind {
        Kind::Float | Kind::Integer => Some(NUMBER_DICTIONARY_BYTES),
        Kind::Text => Some(usize::MAX),
        Kind::Boolean => None,
    }
}

/// The Parquet schema of a table.
pub(super) fn parquet_schema(schema: &Schema) -> Result<TypePtr, ParquetError> {
    let fields = schema.columns().iter().map(parquet_column).collect::<Result<_, _>>()?;
    Ok(Arc::new(Type::group_type_builder(ROOT).with_fields(fields).build()?))
}

/// The Parquet schema of a column.
fn parquet_column(column: &Column) -> Result<TypePtr, ParquetError> {
    let logical = (column.kind == Kind::Text).then_some(LogicalType::String);
    let column = Type::primitive_type_builder(&column.name, physical(column.kind))
        .with_repetition(Repetition::OPTIONAL)
        .with_logical_type(logical);
    Ok(Arc::new(column.build()?))
}

/// What is written how.
///
/// - Nothing is compressed. What would gain, splitting the bytes of floats and snappy, saves 10 to 23 %
///   of columns of all different values and takes four to five times as long to read as plain; and a
///   page that is compressed can announce 2 GB, for which the library (60.1) takes memory before it
///   looks. Without, no file can ask for much more than its own size.
/// - Statistics for whole numbers only, so that a query for some runs finds their row groups. Floats
///   hardly ever leave a group out, and how NaN counts in statistics has changed with the versions of
///   the format; the readers of `checks/parquet` answer rightly either way.
/// - No page index: a row group has few pages.
pub(super) fn properties(schema: &Schema) -> WriterProperties {
    let mut properties = WriterProperties::builder()
        .set_compression(Compression::UNCOMPRESSED)
        .set_encoding(Encoding::PLAIN)
        .set_statistics_enabled(EnabledStatistics::None)
        .set_offset_index_disabled(true)
        .set_write_batch_size(BATCH_ROWS)
        .set_max_row_group_row_count(Some(ROWS_PER_GROUP));
    for column in schema.columns() {
        let path = || ColumnPath::new(vec![column.name.clone()]);
        let dictionary_bytes = dictionary_bytes(column.kind);
        properties = properties
            .set_column_dictionary_enabled(path(), dictionary_bytes.is_some())
            .set_column_dictionary_page_size_limit(path(), dictionary_bytes.unwrap_or(0));
        if column.kind == Kind::Integer {
            properties = properties.set_column_statistics_enabled(path(), EnabledStatistics::Chunk);
        }
    }
    properties.build()
}
