//! The cells of a column of a row group, decoded.

use parquet::column::reader::ColumnReaderImpl;
use parquet::data_type::{BoolType, ByteArray, ByteArrayType, DataType, DoubleType, Int64Type};
use parquet::errors::ParquetError;
use parquet::file::reader::{FileReader as _, RowGroupReader};
use parquet::file::serialized_reader::SerializedFileReader;

use super::content::Content;
use super::pages::Guard;
use super::{Damage, Kind, MAX_TEXT_BYTES, Values};

/// A column of a row group.
pub(super) struct Chunk<'a> {
    pub(super) file: &'a SerializedFileReader<Content>,
    pub(super) row_group: usize,
    pub(super) column: usize,
    pub(super) kind: Kind,
}

impl Chunk<'_> {
    /// Its cells, one for each row.
    pub(super) fn values(&self) -> Result<Values, Damage> {
        let (row_group, column) = (self.row_group, self.column);
        let unreadable = |source| Damage::Values { row_group, column, source };
        let group = self.file.get_row_group(row_group).map_err(unreadable)?;
        let rows = usize::try_from(group.metadata().num_rows()).unwrap_or(0);
        let values = self.decode(&*group, rows).map_err(unreadable)?;
        let values = values.ok_or(Damage::Text { row_group, column, allowed: MAX_TEXT_BYTES })?;
        let found = values.len();
        if found == rows {
            Ok(values)
        } else {
            Err(Damage::Short { row_group, column, found, expected: rows })
        }
    }

    /// Its cells; none if a text is not UTF-8 or too long.
    fn decode(
        &self,
        group: &dyn RowGroupReader,
        rows: usize,
    ) -> Result<Option<Values>, ParquetError> {
        Ok(Some(match self.kind {
            Kind::Float => Values::Float(self.cells::<DoubleType, _>(group, rows, |value| value)?),
            Kind::Integer => {
                Values::Integer(self.cells::<Int64Type, _>(group, rows, |value| value)?)
            }
            Kind::Boolean => {
                Values::Boolean(self.cells::<BoolType, _>(group, rows, |value| value)?)
            }
            Kind::Text => {
                let texts = self.cells::<ByteArrayType, _>(group, rows, |bytes| text(&bytes))?;
                let texts =
                    texts.into_iter().map(|cell| cell.map_or(Some(None), |text| text.map(Some)));
                return Ok(texts.collect::<Option<Vec<_>>>().map(Values::Text));
            }
        }))
    }

    /// Its cells, each value made into another.
    fn cells<T: DataType, C>(
        &self,
        group: &dyn RowGroupReader,
        rows: usize,
        value: impl Fn(T::T) -> C,
    ) -> Result<Vec<Option<C>>, ParquetError> {
        let descriptor = group.metadata().column(self.column).column_descr_ptr();
        let pages = Guard::new(group.get_column_page_reader(self.column)?, self.kind, rows);
        let mut reader = ColumnReaderImpl::<T>::new(descriptor, Box::new(pages));
        let (mut values, mut present) = (Vec::new(), Vec::new());
        reader.read_records(rows, Some(&mut present), None, &mut values)?;
        let mut values = values.into_iter().map(value);
        Ok(present
            .into_iter()
            .map(|level: i16| if level == 1 { values.next() } else { None })
            .collect())
    }
}

/// A text that is UTF-8 and short enough.
fn text(bytes: &ByteArray) -> Option<String> {
    bytes.as_utf8().ok().filter(|text| text.len() <= MAX_TEXT_BYTES).map(str::to_owned)
}
