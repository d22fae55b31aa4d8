//! The digest of a table's content.

use std::fmt;
use std::str::FromStr;

use sha2::{Digest as _, Sha256};

use super::values::canonical;
use super::{Cell, Column, ColumnTable, Kind, Schema, Values};

/// First bytes of every digested content: what it is, and the version of the rules below.
const HEADER: &[u8] = b"fspid table 1\n";

/// Bytes that are gathered before they are hashed; any number gives the same digest.
const CHUNK_BYTES: usize = 1 << 16;

/// SHA-256 of what a table says: its columns, then its cells row by row.
///
/// It does not depend on row groups, encodings or pieces, so that a file that was merged from
/// others has the digest of one that was written at once. Digested are, one after the other:
///
/// 1. `fspid table 1` and a line feed;
/// 2. the number of columns, then for each its name, kind, unit and meaning;
/// 3. for each row, for each column, the cell.
///
/// Numbers of things and lengths are 8 bytes, as everything little-endian. A text is its length in
/// bytes and its UTF-8. A kind is a byte: 1 float, 2 integer, 3 text, 4 boolean. A cell is the byte
/// 0 if it is absent, else the byte of its kind and then 8 bytes (float, integer), a text, or a byte
/// 0 or 1. Every NaN is `0x7ff8000000000000`.
#[derive(Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Digest([u8; 32]);

impl Digest {
    /// The digest of one table.
    #[must_use]
    pub fn of(table: &ColumnTable) -> Self {
        let mut digester = Digester::new(table.schema());
        digester.update(table);
        digester.finish()
    }

    /// The digest of metadata: each key and value with its length.
    pub(super) fn of_metadata(metadata: &[(String, String)]) -> Self {
        Self::of_texts(metadata.iter().flat_map(|(key, value)| [key.as_str(), value.as_str()]))
    }

    /// The digest of some texts, each with its length.
    #[must_use]
    pub fn of_texts<'a>(texts: impl IntoIterator<Item = &'a str>) -> Self {
        let mut bytes = Vec::new();
        texts.into_iter().for_each(|text| put_text(&mut bytes, text));
        Self(Sha256::digest(&bytes).into())
    }

    /// The 32 bytes.
    #[must_use]
    pub const fn bytes(&self) -> &[u8; 32] {
        &self.0
    }
}

impl fmt::Display for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.0.iter().try_for_each(|byte| write!(f, "{byte:02x}"))
    }
}

impl fmt::Debug for Digest {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Digest({self})")
    }
}

/// A text that is not 64 hexadecimal digits in lower case.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{found:?} is not a digest of 64 hexadecimal digits in lower case")]
pub struct NotADigest {
    /// What was found.
    pub found: String,
}

impl FromStr for Digest {
    type Err = NotADigest;

    fn from_str(text: &str) -> Result<Self, NotADigest> {
        let mut bytes = [0; 32];
        let mut digits = text.chars().map(|digit| "0123456789abcdef".find(digit));
        let complete = text.chars().count() == 2 * bytes.len();
        for byte in &mut bytes {
            let pair = digits.next().flatten().zip(digits.next().flatten()).filter(|_| complete);
            let (high, low) = pair.ok_or_else(|| NotADigest { found: text.to_owned() })?;
            // Both are below 16.
            *byte = ((high << 4) | low) as u8;
        }
        Ok(Self(bytes))
    }
}

/// A digest in the making, over tables that follow each other.
#[derive(Clone)]
pub struct Digester {
    hash: Sha256,
    gathered: Vec<u8>,
}

impl Digester {
    /// The digest of a table without rows, to begin with.
    #[must_use]
    pub fn new(schema: &Schema) -> Self {
        let mut gathered = HEADER.to_vec();
        put_length(&mut gathered, schema.columns().len());
        for Column { name, kind, unit, meaning } in schema.columns() {
            put_text(&mut gathered, name);
            gathered.push(tag(*kind));
            put_text(&mut gathered, unit);
            put_text(&mut gathered, meaning);
        }
        Self { hash: Sha256::new(), gathered }
    }

    /// Adds the rows of a table, whose schema must be the one given to [`Digester::new`].
    pub fn update(&mut self, table: &ColumnTable) {
        self.update_values(table.values(), table.rows());
    }

    /// The digest of all rows so far.
    #[must_use]
    pub fn finish(mut self) -> Digest {
        self.hash.update(&self.gathered);
        Digest(self.hash.finalize().into())
    }

    /// Adds rows from their columns.
    fn update_values(&mut self, values: &[Values], rows: usize) {
        for row in 0..rows {
            for cell in values.iter().filter_map(|column| column.cell(row)) {
                put_cell(&mut self.gathered, cell);
            }
            if self.gathered.len() >= CHUNK_BYTES {
                self.hash.update(&self.gathered);
                self.gathered.clear();
            }
        }
    }
}

impl fmt::Debug for Digester {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Digester").finish_non_exhaustive()
    }
}

/// The byte of a kind.
const fn tag(kind: Kind) -> u8 {
    match kind {
        Kind::Float => 1,
        Kind::Integer => 2,
        Kind::Text => 3,
        Kind::Boolean => 4,
    }
}

/// A number of things.
fn put_length(to: &mut Vec<u8>, length: usize) {
    to.extend_from_slice(&(length as u64).to_le_bytes());
}

/// A text with its length.
fn put_text(to: &mut Vec<u8>, text: &str) {
    put_length(to, text.len());
    to.extend_from_slice(text.as_bytes());
}

/// A cell with its kind.
fn put_cell(to: &mut Vec<u8>, cell: Cell<'_>) {
    to.push(cell.kind().map_or(0, tag));
    match cell {
        Cell::Absent => {}
        Cell::Float(value) => to.extend_from_slice(&canonical(value).to_bits().to_le_bytes()),
        Cell::Integer(value) => to.extend_from_slice(&value.to_le_bytes()),
        Cell::Text(text) => put_text(to, text),
        Cell::Boolean(value) => to.push(u8::from(value)),
    }
}
