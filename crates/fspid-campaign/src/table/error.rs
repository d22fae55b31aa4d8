//! What can be wrong with tables and their files, as enums whose variants hold the values.

use std::io;
use std::path::PathBuf;

use fspid_scenario::file::unread_in_words;
use parquet::errors::ParquetError;
use thiserror::Error;

use super::{Digest, Kind};

/// Why a table could not be made, written or read.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum TableError {
    /// A processor on which the Parquet library writes numbers the wrong way round.
    #[error(
        "tables are neither written nor read on processors that keep the most significant byte first: the Parquet library knows the others alone; fly the campaign on x86-64, ARM or RISC-V"
    )]
    BigEndian,
    /// A schema without columns.
    #[error("a table needs at least one column")]
    NoColumns,
    /// A name that is empty or has control characters.
    #[error(
        "column {index} is called {name:?}; a name has at least one character and no control characters"
    )]
    ColumnName {
        /// Which column.
        index: usize,
        /// What it is called.
        name: String,
    },
    /// Two columns of the same name, upper and lower case being the same.
    #[error(
        "column {second} is called \"{name}\" as column {first} is; upper and lower case do not tell names apart"
    )]
    DuplicateColumn {
        /// The name of the second.
        name: String,
        /// Index of the first.
        first: usize,
        /// Index of the second.
        second: usize,
    },
    /// A column that there is not.
    #[error("there is no column \"{name}\"; there are {}", known.join(", "))]
    UnknownColumn {
        /// What was asked for.
        name: String,
        /// What there is.
        known: Vec<String>,
    },
    /// A row with too few or too many cells, or too few or too many columns of values.
    #[error("{found} cells for {expected} columns")]
    RowLength {
        /// Cells found.
        found: usize,
        /// Columns there are.
        expected: usize,
    },
    /// A cell or a column of values of another kind.
    #[error("column \"{column}\" holds {expected}, not {found}")]
    Kind {
        /// Which column.
        column: String,
        /// Its kind.
        expected: Kind,
        /// What was found or asked for.
        found: Kind,
    },
    /// A text beyond [`MAX_TEXT_BYTES`](super::MAX_TEXT_BYTES).
    #[error("a text of {bytes} bytes for column \"{column}\"; at most {allowed} are allowed")]
    TextTooLong {
        /// Which column.
        column: String,
        /// Its length in bytes of UTF-8.
        bytes: usize,
        /// The longest that is allowed.
        allowed: usize,
    },
    /// Columns of values that do not have the same number of rows.
    #[error("column \"{column}\" has {found} rows, the first column {expected}")]
    UnequalRows {
        /// Which column.
        column: String,
        /// Its rows.
        found: usize,
        /// Rows of the first column.
        expected: usize,
    },
    /// Rows that the table does not have.
    #[error("rows {start} to {end} of a table with {rows}")]
    NoSuchRows {
        /// First row asked for.
        start: usize,
        /// One after the last.
        end: usize,
        /// Rows there are.
        rows: usize,
    },
    /// A table with other columns than those it is put to.
    #[error("the columns are not those of the table or file they are put to")]
    OtherSchema,
    /// A key of metadata that is given twice, or that the file uses itself.
    #[error("the key \"{key}\" of the metadata is taken")]
    KeyTaken {
        /// The key.
        key: String,
    },
    /// A file or another sink that does not take what is written.
    #[error("cannot write the table: {source}")]
    Write {
        /// Why.
        source: ParquetError,
    },
    /// A writer that has failed before.
    #[error("the table cannot be written on: an earlier write failed")]
    Failed,
    /// A file that cannot be opened.
    #[error("{}: cannot be read: {}", path.display(), unread_in_words(source))]
    Open {
        /// Which file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// A file that does not begin and end as a Parquet file does: another one, or part of one.
    #[error("{} is not a whole Parquet file: its {bytes} bytes do not begin and end with PAR1", path.display())]
    NotParquet {
        /// Which file.
        path: PathBuf,
        /// How long it is.
        bytes: u64,
    },
    /// A Parquet file that was not written here.
    #[error("{} is not a table of results: {reason}", path.display())]
    Foreign {
        /// Which file.
        path: PathBuf,
        /// What is different.
        reason: Foreign,
    },
    /// A file that was written here but is not whole.
    #[error("{} is damaged: {reason}", path.display())]
    Damaged {
        /// Which file.
        path: PathBuf,
        /// What is wrong.
        reason: Damage,
    },
    /// A file whose content is not the one it was written with.
    #[error("{} is damaged: its content has the digest {found}, but it was written with {stored}", path.display())]
    DigestDiffers {
        /// Which file.
        path: PathBuf,
        /// What stands in the file.
        stored: Digest,
        /// What its content gives.
        found: Digest,
    },
}

/// Why a Parquet file is not a table of results.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[non_exhaustive]
pub enum Foreign {
    /// Columns within columns.
    #[error("its columns are nested")]
    Nested,
    /// Metadata that every table of results has.
    #[error("its metadata has no \"{key}\"")]
    NoKey {
        /// The key that is not there.
        key: &'static str,
    },
    /// Metadata that cannot be read.
    #[error("its metadata \"{key}\" cannot be read")]
    Description {
        /// Under which key.
        key: &'static str,
    },
    /// Another version of the format.
    #[error("it has format {found}; known is {known}")]
    Format {
        /// The version found.
        found: u64,
        /// The version known.
        known: u64,
    },
    /// Columns that are not those of the metadata.
    #[error("column {index} is not as its metadata describes it")]
    Column {
        /// Which column, or the first that is too many or too few.
        index: usize,
    },
    /// A row group of another size.
    #[error("row group {row_group} has {rows} rows; all have {allowed}, the last at least one")]
    RowGroup {
        /// Which row group.
        row_group: usize,
        /// Its rows.
        rows: i64,
        /// Rows of a full one.
        allowed: usize,
    },
    /// A column that is compressed or kept in another file.
    #[error("column {column} of row group {row_group} is compressed or lies in another file")]
    Storage {
        /// Which row group.
        row_group: usize,
        /// Which column.
        column: usize,
    },
}

/// What is wrong with a damaged file.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum Damage {
    /// A footer that says it is longer than the file.
    #[error("its footer of {told} bytes does not fit into {bytes}")]
    FooterLength {
        /// What the file says.
        told: u64,
        /// Bytes there are in the file.
        bytes: u64,
    },
    /// A footer that cannot be followed.
    #[error("its footer cannot be read beyond byte {at}")]
    Footer {
        /// Where in the footer.
        at: usize,
    },
    /// A footer that the Parquet library does not accept, or that cannot be read from the disk.
    #[error("its footer cannot be read: {source}")]
    Metadata {
        /// Why.
        source: ParquetError,
    },
    /// Metadata that is not the one it was written with.
    #[error("its metadata has the digest {found}, but it was written with {stored}")]
    MetadataDigest {
        /// What stands in the file.
        stored: Digest,
        /// What the metadata gives.
        found: Digest,
    },
    /// A number of rows that is not that of the row groups.
    #[error("it says it has {told} rows, its row groups have {found}")]
    Rows {
        /// What the file says.
        told: i64,
        /// The sum over the row groups.
        found: usize,
    },
    /// A column that would lie outside of the file, or without a value for every row.
    #[error("column {column} of row group {row_group} does not fit into the file or its rows")]
    Chunk {
        /// Which row group.
        row_group: usize,
        /// Which column.
        column: usize,
    },
    /// Values that cannot be read.
    #[error("column {column} of row group {row_group} cannot be read: {source}")]
    Values {
        /// Which row group.
        row_group: usize,
        /// Which column.
        column: usize,
        /// Why.
        source: ParquetError,
    },
    /// Fewer values than rows.
    #[error("column {column} of row group {row_group} ends after {found} of {expected} rows")]
    Short {
        /// Which row group.
        row_group: usize,
        /// Which column.
        column: usize,
        /// Rows found.
        found: usize,
        /// Rows of the row group.
        expected: usize,
    },
    /// A text that is not UTF-8 or too long.
    #[error(
        "column {column} of row group {row_group} has a text that is not UTF-8 or longer than {allowed} bytes"
    )]
    Text {
        /// Which row group.
        row_group: usize,
        /// Which column.
        column: usize,
        /// The longest that is allowed.
        allowed: usize,
    },
    /// Something at which the Parquet library panicked.
    #[error("the Parquet library could not cope with it")]
    Panic,
}

impl TableError {
    /// What the system said, where it is what is wrong: a full disk, say.
    #[must_use]
    pub fn of_system(&self) -> Option<&io::Error> {
        let mut innermost: &dyn std::error::Error = self;
        while let Some(source) = innermost.source() {
            innermost = source;
        }
        innermost.downcast_ref()
    }
}
