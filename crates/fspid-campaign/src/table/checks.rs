//! What is asked of a footer after the Parquet library has read it.

use std::path::Path;

use parquet::basic::{Compression, LogicalType, Repetition};
use parquet::file::metadata::{ColumnChunkMetaData, ParquetMetaData, RowGroupMetaData};
use parquet::schema::types::Type;

use super::{
    Column, Damage, Digest, Foreign, Kind, METADATA_DIGEST_KEY, ROWS_PER_GROUP, Schema, TableError,
    layout,
};

/// Why a file was refused.
#[derive(Debug)]
pub(super) enum Refusal {
    /// It does not begin and end as Parquet; with its length.
    NotParquet(u64),
    /// It was not written here.
    Foreign(Foreign),
    /// It is not whole.
    Damaged(Damage),
}

impl From<Foreign> for Refusal {
    fn from(reason: Foreign) -> Self {
        Self::Foreign(reason)
    }
}

impl From<Damage> for Refusal {
    fn from(reason: Damage) -> Self {
        Self::Damaged(reason)
    }
}

impl Refusal {
    /// The refusal as an error that names the file.
    pub(super) fn of(self, path: &Path) -> TableError {
        let path = path.to_owned();
        match self {
            Self::NotParquet(bytes) => TableError::NotParquet { path, bytes },
            Self::Foreign(reason) => TableError::Foreign { path, reason },
            Self::Damaged(reason) => TableError::Damaged { path, reason },
        }
    }
}

/// The key-value metadata of a file, in order; keys without a value are left out.
pub(super) fn key_values(metadata: &ParquetMetaData) -> Vec<(String, String)> {
    let pairs = metadata.file_metadata().key_value_metadata();
    pairs
        .into_iter()
        .flatten()
        .filter_map(|pair| Some((pair.key.clone(), pair.value.clone()?)))
        .collect()
}

/// Takes the value of a key out of the metadata.
pub(super) fn take(
    metadata: &mut Vec<(String, String)>,
    key: &'static str,
) -> Result<String, Foreign> {
    let place =
        metadata.iter().position(|(known, _)| known == key).ok_or(Foreign::NoKey { key })?;
    Ok(metadata.remove(place).1)
}

/// Takes the digest under a key out of the metadata.
pub(super) fn take_digest(
    metadata: &mut Vec<(String, String)>,
    key: &'static str,
) -> Result<Digest, Foreign> {
    take(metadata, key)?.parse().map_err(|_| Foreign::Description { key })
}

/// Takes the digest of the metadata out of it and compares it with the others.
pub(super) fn seal(metadata: &mut Vec<(String, String)>) -> Result<(), Refusal> {
    let stored = take_digest(metadata, METADATA_DIGEST_KEY)?;
    let found = Digest::of_metadata(metadata);
    if stored == found { Ok(()) } else { Err(Damage::MetadataDigest { stored, found }.into()) }
}

/// Compares the columns of the file with what its metadata says of them.
pub(super) fn columns(schema: &Schema, metadata: &ParquetMetaData) -> Result<(), Foreign> {
    let (described, found) = (schema.columns(), metadata.file_metadata().schema().get_fields());
    let differs = described.iter().zip(found).position(|(column, field)| !is_column(column, field));
    let differs =
        differs.or((described.len() != found.len()).then_some(described.len().min(found.len())));
    differs.map_or(Ok(()), |index| Err(Foreign::Column { index }))
}

/// Whether a field of the Parquet schema is a column.
fn is_column(column: &Column, field: &Type) -> bool {
    let info = field.get_basic_info();
    let text = info.logical_type_ref() == Some(&LogicalType::String);
    field.is_primitive()
        && info.name() == column.name
        && info.has_repetition()
        && info.repetition() == Repetition::OPTIONAL
        && field.get_physical_type() == layout::physical(column.kind)
        && text == (column.kind == Kind::Text)
}

/// Checks that row groups are of the size that a writer gives them and lie within the file of so many
/// bytes; returns the number of rows.
pub(super) fn row_groups(metadata: &ParquetMetaData, bytes: u64) -> Result<usize, Refusal> {
    let last = metadata.num_row_groups().saturating_sub(1);
    let mut rows = 0;
    for (row_group, group) in metadata.row_groups().iter().enumerate() {
        let found = group.num_rows();
        let full = found == ROWS_PER_GROUP as i64;
        let partial = row_group == last && (1..ROWS_PER_GROUP as i64).contains(&found);
        if !(full || partial) {
            return Err(
                Foreign::RowGroup { row_group, rows: found, allowed: ROWS_PER_GROUP }.into()
            );
        }
        chunks(row_group, group, bytes)?;
        rows += usize::try_from(found).unwrap_or(0);
    }
    let told = metadata.file_metadata().num_rows();
    if usize::try_from(told) == Ok(rows) {
        Ok(rows)
    } else {
        Err(Damage::Rows { told, found: rows }.into())
    }
}

/// Checks the columns of a row group.
fn chunks(row_group: usize, group: &RowGroupMetaData, bytes: u64) -> Result<(), Refusal> {
    let expected = group.schema_descr().num_columns();
    let found = group.num_columns();
    if found != expected {
        return Err(Damage::Chunk { row_group, column: found.min(expected) }.into());
    }
    for (column, chunk) in group.columns().iter().enumerate() {
        if chunk.compression() != Compression::UNCOMPRESSED || chunk.file_path().is_some() {
            return Err(Foreign::Storage { row_group, column }.into());
        }
        let whole = chunk.num_values() == group.num_rows();
        if !(whole && lies_within(chunk, bytes)) {
            return Err(Damage::Chunk { row_group, column }.into());
        }
    }
    Ok(())
}

/// Whether a column of a row group lies within a file of so many bytes.
fn lies_within(chunk: &ColumnChunkMetaData, bytes: u64) -> bool {
    let start = chunk.dictionary_page_offset().unwrap_or(chunk.data_page_offset());
    let range = u64::try_from(start).ok().zip(u64::try_from(chunk.compressed_size()).ok());
    let end = range.and_then(|(start, length)| start.checked_add(length));
    end.is_some_and(|end| end <= bytes)
}
