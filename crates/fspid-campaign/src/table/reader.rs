//! Tables from a Parquet file.

use std::cell::Cell;
use std::marker::PhantomData;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Arc;

use parquet::file::metadata::ParquetStatisticsPolicy;
use parquet::file::reader::FileReader as _;
use parquet::file::serialized_reader::{ReadOptionsBuilder, SerializedFileReader};

use super::checks::{self, Refusal};
use super::chunk::Chunk;
use super::content::Content;
use super::{
    COLUMNS_KEY, ColumnTable, DIGEST_KEY, Damage, Digest, Digester, Kind, Schema, TableError,
    Values, footer,
};

/// A file that a [`Writer`](super::Writer) wrote.
///
/// Opening reads the footer alone. Rows are read a row group at a time, of the columns that are asked
/// for. What a file can be made to ask for is bounded by its own size, whoever made it: footer and
/// pages are looked at before the Parquet library sees them, and should it panic all the same, that
/// is [`Damage::Panic`] (with its message on standard error, which is where the hook of the process
/// puts it). That values were changed within their pages is found by [`Reader::verify`].
///
/// A reader can be sent to another thread but not be shared: it has one position in its file. Open
/// the file once a thread.
pub struct Reader {
    path: PathBuf,
    file: SerializedFileReader<Content>,
    schema: Arc<Schema>,
    metadata: Vec<(String, String)>,
    digest: Digest,
    rows: usize,
    not_shared: PhantomData<Cell<()>>,
}

impl Reader {
    /// Opens a file and reads its footer.
    ///
    /// # Errors
    /// [`TableError::BigEndian`], [`TableError::Open`], [`TableError::NotParquet`],
    /// [`TableError::Foreign`], [`TableError::Damaged`].
    pub fn open(path: impl AsRef<Path>) -> Result<Self, TableError> {
        super::supported()?;
        let path = path.as_ref();
        let open = || {
            let (mut content, bytes) = Content::open(path)?;
            let footer = content.footer(bytes)?;
            Ok((content, bytes, footer))
        };
        let (content, bytes, footer) =
            open().map_err(|source| TableError::Open { path: path.to_owned(), source })?;
        let refused = |refusal: Refusal| refusal.of(path);
        footer.and_then(|footer| footer::check(&footer)).map_err(refused)?;
        guarded(path, || Self::parse(path, content, bytes).map_err(refused))
    }

    /// Reads a footer that has been looked at.
    fn parse(path: &Path, content: Content, bytes: u64) -> Result<Self, Refusal> {
        // Statistics are not used, and the library would panic at some that are too short.
        let options = ReadOptionsBuilder::new()
            .with_column_stats_policy(ParquetStatisticsPolicy::SkipAll)
            .with_size_stats_policy(ParquetStatisticsPolicy::SkipAll)
            .build();
        let file = SerializedFileReader::new_with_options(content, options)
            .map_err(|source| Damage::Metadata { source })?;
        let mut metadata = checks::key_values(file.metadata());
        checks::seal(&mut metadata)?;
        let schema = Schema::from_json(&checks::take(&mut metadata, COLUMNS_KEY)?)?;
        let digest = checks::take_digest(&mut metadata, DIGEST_KEY)?;
        checks::columns(&schema, file.metadata())?;
        let rows = checks::row_groups(file.metadata(), bytes)?;
        let (path, schema) = (path.to_owned(), Arc::new(schema));
        Ok(Self { path, file, schema, metadata, digest, rows, not_shared: PhantomData })
    }

    /// Where the file is.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// The columns' names, kinds, units and meanings.
    #[must_use]
    pub const fn schema(&self) -> &Arc<Schema> {
        &self.schema
    }

    /// The metadata that the writer was given, in that order.
    #[must_use]
    pub fn metadata(&self) -> &[(String, String)] {
        &self.metadata
    }

    /// A value of the metadata, if there is one.
    #[must_use]
    pub fn metadata_value(&self, key: &str) -> Option<&str> {
        self.metadata.iter().find(|(known, _)| known == key).map(|(_, value)| value.as_str())
    }

    /// The digest that the file says it has; [`Reader::verify`] compares it with the content.
    #[must_use]
    pub const fn digest(&self) -> Digest {
        self.digest
    }

    /// How many rows there are.
    #[must_use]
    pub const fn rows(&self) -> usize {
        self.rows
    }

    /// All columns, a row group at a time.
    ///
    /// # Errors
    /// Each item: [`TableError::Damaged`]. After an error come the other row groups.
    pub fn tables(&self) -> impl Iterator<Item = Result<ColumnTable, TableError>> + '_ {
        let indices: Vec<usize> = (0..self.schema.columns().len()).collect();
        self.select(Arc::clone(&self.schema), indices)
    }

    /// Some columns in the order in which they are named, a row group at a time; no others are read.
    ///
    /// # Errors
    /// [`TableError::UnknownColumn`], [`TableError::NoColumns`], [`TableError::DuplicateColumn`]; each
    /// item as of [`Reader::tables`].
    pub fn columns(
        &self,
        names: &[&str],
    ) -> Result<impl Iterator<Item = Result<ColumnTable, TableError>> + '_, TableError> {
        let indices =
            names.iter().map(|name| self.schema.index(name)).collect::<Result<Vec<_>, _>>()?;
        let schema = Arc::new(self.schema.select(&indices)?);
        Ok(self.select(schema, indices))
    }

    /// One column, a row group at a time; no others are read.
    ///
    /// # Errors
    /// [`TableError::UnknownColumn`]; each item as of [`Reader::tables`].
    pub fn column(
        &self,
        name: &str,
    ) -> Result<impl Iterator<Item = Result<Values, TableError>> + '_, TableError> {
        let index = self.schema.index(name)?;
        Ok(self
            .row_groups()
            .map(move |row_group| guarded(&self.path, || self.read(row_group, index))))
    }

    /// One column of numbers, a row group at a time; no others are read.
    ///
    /// # Errors
    /// [`TableError::UnknownColumn`], [`TableError::Kind`]; each item as of [`Reader::tables`].
    pub fn floats(
        &self,
        name: &str,
    ) -> Result<impl Iterator<Item = Result<Vec<Option<f64>>, TableError>> + '_, TableError> {
        let column = name.to_owned();
        let wrong = move |expected| TableError::Kind {
            column: column.clone(),
            expected,
            found: Kind::Float,
        };
        let kind = self.schema.columns().get(self.schema.index(name)?).map(|column| column.kind);
        if let Some(other) = kind.filter(|kind| *kind != Kind::Float) {
            return Err(wrong(other));
        }
        Ok(self.column(name)?.map(move |values| match values? {
            Values::Float(cells) => Ok(cells),
            other => Err(wrong(other.kind())),
        }))
    }

    /// Reads everything and compares its digest with the one that the file was written with.
    ///
    /// # Errors
    /// [`TableError::DigestDiffers`], [`TableError::Damaged`].
    pub fn verify(&self) -> Result<Digest, TableError> {
        let mut digester = Digester::new(&self.schema);
        for table in self.tables() {
            digester.update(&table?);
        }
        let (stored, found) = (self.digest, digester.finish());
        if stored == found {
            return Ok(found);
        }
        Err(TableError::DigestDiffers { path: self.path.clone(), stored, found })
    }

    /// The row groups' indices.
    fn row_groups(&self) -> std::ops::Range<usize> {
        0..self.file.num_row_groups()
    }

    /// Columns at some indices under their schema.
    fn select(
        &self,
        schema: Arc<Schema>,
        indices: Vec<usize>,
    ) -> impl Iterator<Item = Result<ColumnTable, TableError>> + '_ {
        self.row_groups().map(move |row_group| {
            guarded(&self.path, || {
                let values = indices
                    .iter()
                    .map(|&index| self.read(row_group, index))
                    .collect::<Result<_, _>>()?;
                ColumnTable::from_values(Arc::clone(&schema), values)
            })
        })
    }

    /// The cells of a column of a row group.
    fn read(&self, row_group: usize, column: usize) -> Result<Values, TableError> {
        let kind = self.schema.columns().get(column).map_or(Kind::Float, |column| column.kind);
        let values = Chunk { file: &self.file, row_group, column, kind }.values();
        values.map_err(|damage| Refusal::from(damage).of(&self.path))
    }
}

impl std::fmt::Debug for Reader {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.debug_struct("Reader")
            .field("path", &self.path)
            .field("rows", &self.rows)
            .finish_non_exhaustive()
    }
}

/// Runs what calls the Parquet library on bytes that may be damaged.
///
/// The library (60.1) has assertions on what it reads. Those that were found are kept from it, by the
/// looks at footer and pages; a panic at another one must not take down a campaign of hours. Nothing
/// that was being changed is seen afterwards: a reader does not change, what was being read is dropped.
fn guarded<T>(path: &Path, read: impl FnOnce() -> Result<T, TableError>) -> Result<T, TableError> {
    let read = catch_unwind(AssertUnwindSafe(read));
    read.unwrap_or_else(|_| Err(Refusal::from(Damage::Panic).of(path)))
}
