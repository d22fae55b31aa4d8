//! The rows that a summary is made of: those of one file, or of parts one after the other.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use rayon::prelude::*;

use crate::parts::Seen;
use crate::table::{ColumnTable, Digest, Digester, Reader, Schema, TableError, Values};

/// Files whose rows follow each other. The first stays open, others are opened for as long as they are read.
pub(crate) struct Files {
    first: Reader,
    others: Vec<PathBuf>,
    /// Where each file begins.
    begins: Vec<Begin>,
    rows: usize,
}

/// The first row and the first run of a file.
#[derive(Clone, Copy)]
struct Begin {
    row: usize,
    run: u64,
}

impl Files {
    /// A merged file.
    pub(crate) fn merged(reader: Reader) -> Self {
        let rows = reader.rows();
        Self { first: reader, others: Vec::new(), begins: vec![Begin { row: 0, run: 0 }], rows }
    }

    /// One part.
    pub(super) fn one(part: &Seen) -> Result<Self, TableError> {
        let first = Reader::open(&part.path)?;
        let rows = first.rows();
        Ok(Self {
            first,
            others: Vec::new(),
            begins: vec![Begin { row: 0, run: part.range.first }],
            rows,
        })
    }

    /// Parts in the order of their runs; `None` without one.
    ///
    /// # Errors
    /// A first part that cannot be read.
    pub(crate) fn of(parts: &[Seen]) -> Result<Option<Self>, TableError> {
        let Some((first, others)) = parts.split_first() else {
            return Ok(None);
        };
        let mut rows = 0;
        let mut begins = Vec::with_capacity(parts.len());
        for part in parts {
            begins.push(Begin { row: rows, run: part.range.first });
            rows += part.rows;
        }
        let others = others.iter().map(|part| part.path.clone()).collect();
        Ok(Some(Self { first: Reader::open(&first.path)?, others, begins, rows }))
    }

    /// The first file.
    pub(crate) fn first(&self) -> &Reader {
        &self.first
    }

    /// Where they are: the first file.
    pub(crate) fn path(&self) -> &Path {
        self.first.path()
    }

    pub(crate) fn schema(&self) -> &Arc<Schema> {
        self.first.schema()
    }

    /// Rows of all files.
    pub(crate) fn rows(&self) -> usize {
        self.rows
    }

    /// The first row of the file with this number.
    pub(super) fn begin(&self, number: usize) -> usize {
        self.begins.get(number).map_or(self.rows, |begin| begin.row)
    }

    /// The run of a row, where each run has `of_run` rows.
    pub(crate) fn run(&self, row: usize, of_run: usize) -> u64 {
        let in_first = Begin { row: 0, run: 0 };
        let begin = match self.begins.as_slice() {
            [one] => *one,
            all => {
                let place = all.partition_point(|begin| begin.row <= row);
                place.checked_sub(1).and_then(|it| all.get(it)).copied().unwrap_or(in_first)
            }
        };
        begin.run + ((row - begin.row) / of_run.max(1)) as u64
    }

    /// Reads everything and compares each file with the digest that it says it has; the digest of all rows.
    pub(super) fn verify(&self) -> Result<Digest, TableError> {
        let first = self.first.verify()?;
        if self.others.is_empty() {
            return Ok(first);
        }
        let mut digester = Digester::new(self.schema());
        self.first.tables().try_for_each(|table| table.map(|table| digester.update(&table)))?;
        for some in self.others.chunks(AT_ONCE) {
            let read: Vec<_> = some.par_iter().map(|path| verified(path)).collect();
            for tables in read {
                tables?.iter().for_each(|table| digester.update(table));
            }
        }
        Ok(digester.finish())
    }

    /// Some columns, a row group at a time.
    pub(crate) fn columns<'a>(
        &'a self,
        names: &'a [&'a str],
    ) -> Result<impl Iterator<Item = Result<ColumnTable, TableError>> + 'a, TableError> {
        let of = move |path| all_of(path, |reader| Ok(reader.columns(names)?.collect()));
        Ok(self.first.columns(names)?.chain(self.others.iter().flat_map(of)))
    }

    /// One column, a row group at a time.
    pub(super) fn column<'a>(
        &'a self,
        name: &'a str,
    ) -> Result<impl Iterator<Item = Result<Values, TableError>> + 'a, TableError> {
        let of = move |path| all_of(path, |reader| Ok(reader.column(name)?.collect()));
        Ok(self.first.column(name)?.chain(self.others.iter().flat_map(of)))
    }

    /// One column of numbers, a row group at a time.
    pub(super) fn floats<'a>(
        &'a self,
        name: &'a str,
    ) -> Result<impl Iterator<Item = Result<Vec<Option<f64>>, TableError>> + 'a, TableError> {
        let of = move |path| all_of(path, |reader| Ok(reader.floats(name)?.collect()));
        Ok(self.first.floats(name)?.chain(self.others.iter().flat_map(of)))
    }
}

/// Parts that are in memory together.
const AT_ONCE: usize = 4;

/// All rows of a part, if they have its digest.
fn verified(path: &Path) -> Result<Vec<ColumnTable>, TableError> {
    let reader = Reader::open(path)?;
    let tables = reader.tables().collect::<Result<Vec<_>, _>>()?;
    let mut digester = Digester::new(reader.schema());
    tables.iter().for_each(|table| digester.update(table));
    let (stored, found) = (reader.digest(), digester.finish());
    match stored == found {
        true => Ok(tables),
        false => Err(TableError::DigestDiffers { path: path.to_owned(), stored, found }),
    }
}

/// What is read of one file, which is a part and thus small.
fn all_of<T>(
    path: &PathBuf,
    read: impl FnOnce(&Reader) -> Result<Vec<Result<T, TableError>>, TableError>,
) -> Vec<Result<T, TableError>> {
    Reader::open(path).and_then(|reader| read(&reader)).unwrap_or_else(|error| vec![Err(error)])
}
