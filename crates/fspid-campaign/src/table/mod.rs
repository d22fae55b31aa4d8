//! Tables of results: columns with names and units, written as Parquet and read again.
//!
//! A [`ColumnTable`] is rows in memory under a [`Schema`]; every cell may be absent. A [`Writer`] takes
//! tables of any size and writes a Parquet file whose bytes depend on the rows and the metadata
//! only; a [`Reader`] gives them back one row group at a time. A [`Digest`] names the content,
//! whatever file it lies in.
//!
//! ```text
//! rows ─push▶ Table ─write▶ Writer ─finish▶ file + Digest;  file ─open▶ Reader ─tables, columns▶ Table
//! ```
//!
//! It is not a general reader of Parquet: a file that a [`Writer`] did not write is refused
//! ([`Foreign`]). Other programs read these files as they read any Parquet file.
//!
//! # The file
//! Format 1 of Parquet (data pages of version 1), row groups of [`ROWS_PER_GROUP`] rows, not
//! compressed, every column optional and flat, without page index. Key-value metadata, in this order:
//!
//! | key | value |
//! | --- | --- |
//! | [`COLUMNS_KEY`] | JSON: `{"format":1,"columns":[{"name","kind","unit","meaning"}, …]}`, the kinds named as in [`Kind`] |
//! | the caller's keys | as given to [`Writer::new`], then as given to [`Writer::finish`] |
//! | [`DIGEST_KEY`] | the [`Digest`] of the content, 64 hexadecimal digits |
//! | [`METADATA_DIGEST_KEY`] | SHA-256 of the metadata before it: for each key and value the length in 8 bytes, little-endian, and the UTF-8 |

mod checks;
mod chunk;
mod content;
mod digest;
mod error;
mod footer;
mod layout;
mod pages;
mod reader;
mod schema;
mod values;
mod writer;

pub use digest::{Digest, Digester, NotADigest};
pub use error::{Damage, Foreign, TableError};
pub use reader::Reader;
pub use schema::{Column, Kind, Schema};
pub use values::{Cell, ColumnTable, Values};
pub use writer::Writer;

/// Rows of every row group but the last, which may have fewer.
///
/// Fixed, so that the same rows give the same bytes however they arrive; 60 columns of it take
/// about 16 MB of memory. Smaller groups cost more of the some 70 bytes that a column of a group
/// takes in the footer; larger ones more memory.
pub const ROWS_PER_GROUP: usize = 16_384;

/// Longest text of a cell, in bytes of UTF-8.
///
/// A cell is a word or a sentence. The limit also bounds what a damaged file can ask for: a row
/// group of texts is at most 64 MB, although a dictionary could repeat one long text in every row.
pub const MAX_TEXT_BYTES: usize = 4096;

/// Key of the metadata under which the columns stand.
pub const COLUMNS_KEY: &str = "fspid.columns";

/// Key of the metadata under which the digest stands.
pub const DIGEST_KEY: &str = "fspid.digest";

/// Key of the metadata under which the digest of the metadata stands.
pub const METADATA_DIGEST_KEY: &str = "fspid.metadata_digest";

/// Whether tables can be written and read here.
///
/// The Parquet library writes the lengths of texts as the processor keeps them, and says of itself that it knows little-endian
/// processors alone: on others it writes files that nobody can read.
///
/// # Errors
/// [`TableError::BigEndian`].
pub(crate) fn supported() -> Result<(), TableError> {
    if cfg!(target_endian = "big") {
        return Err(TableError::BigEndian);
    }
    Ok(())
}
