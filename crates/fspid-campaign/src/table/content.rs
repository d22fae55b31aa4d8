//! What a file holds: in memory where it is small, read where it lies otherwise.

use std::fs::File;
use std::io::{self, Cursor, Read};
use std::path::Path;

use bytes::Bytes;
use parquet::errors::ParquetError;
use parquet::file::reader::{ChunkReader, Length};

use super::checks::Refusal;
use super::footer;

/// Up to so many bytes a file is read as a whole: the Parquet library asks the system five times for each column of one
/// that is read where it lies, which is half of what merging small parts costs.
const SMALL_BYTES: u64 = 1 << 18;

/// The bytes of a file.
pub(super) enum Content {
    Memory(Bytes),
    File(File),
}

impl Content {
    /// Opens a file; how long it is.
    pub(super) fn open(path: &Path) -> io::Result<(Self, u64)> {
        let mut file = File::open(path)?;
        let bytes = file.metadata()?.len();
        if bytes > SMALL_BYTES {
            return Ok((Self::File(file), bytes));
        }
        let mut content = Vec::new();
        file.by_ref().take(SMALL_BYTES).read_to_end(&mut content)?;
        let bytes = content.len() as u64;
        Ok((Self::Memory(content.into()), bytes))
    }

    /// Its footer, as [`footer::read`].
    pub(super) fn footer(&mut self, bytes: u64) -> io::Result<Result<Vec<u8>, Refusal>> {
        match self {
            Self::Memory(content) => footer::read(&mut Cursor::new(&content[..]), bytes),
            Self::File(file) => footer::read(file, bytes),
        }
    }
}

impl Length for Content {
    fn len(&self) -> u64 {
        match self {
            Self::Memory(content) => content.len() as u64,
            Self::File(file) => Length::len(file),
        }
    }
}

impl ChunkReader for Content {
    type T = Box<dyn Read>;

    fn get_read(&self, start: u64) -> Result<Self::T, ParquetError> {
        Ok(match self {
            Self::Memory(content) => Box::new(content.get_read(start)?),
            Self::File(file) => Box::new(file.get_read(start)?),
        })
    }

    fn get_bytes(&self, start: u64, length: usize) -> Result<Bytes, ParquetError> {
        match self {
            Self::Memory(content) => content.get_bytes(start, length),
            Self::File(file) => file.get_bytes(start, length),
        }
    }
}
