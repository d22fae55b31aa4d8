//! Rows in memory.

use std::ops::Range;
use std::sync::Arc;

use super::{Column, Kind, MAX_TEXT_BYTES, Schema, TableError};

/// A cell that is looked at or put into a table.
#[derive(Debug, Clone, Copy)]
pub enum Cell<'a> {
    /// No value; fits every column.
    Absent,
    /// A number; every NaN becomes the one with the bits `0x7ff8000000000000`.
    Float(f64),
    /// A whole number.
    Integer(i64),
    /// A text.
    Text(&'a str),
    /// True or false.
    Boolean(bool),
}

impl Cell<'_> {
    /// Its kind, unless it is absent.
    #[must_use]
    pub const fn kind(&self) -> Option<Kind> {
        match self {
            Self::Absent => None,
            Self::Float(_) => Some(Kind::Float),
            Self::Integer(_) => Some(Kind::Integer),
            Self::Text(_) => Some(Kind::Text),
            Self::Boolean(_) => Some(Kind::Boolean),
        }
    }

    /// Whether it may stand in a column.
    fn check(&self, column: &Column) -> Result<(), TableError> {
        match self.kind() {
            Some(found) if found != column.kind => {
                Err(TableError::Kind { column: column.name.clone(), expected: column.kind, found })
            }
            _ => match self {
                Self::Text(text) => check_text(text, column),
                _ => Ok(()),
            },
        }
    }
}

/// Equal bits; NaN equals NaN, and 0 does not equal -0.
impl PartialEq for Cell<'_> {
    fn eq(&self, other: &Self) -> bool {
        match (self, other) {
            (Self::Absent, Self::Absent) => true,
            (Self::Float(a), Self::Float(b)) => canonical(*a).to_bits() == canonical(*b).to_bits(),
            (Self::Integer(a), Self::Integer(b)) => a == b,
            (Self::Text(a), Self::Text(b)) => a == b,
            (Self::Boolean(a), Self::Boolean(b)) => a == b,
            _ => false,
        }
    }
}

impl Eq for Cell<'_> {}

impl From<f64> for Cell<'_> {
    fn from(value: f64) -> Self {
        Self::Float(value)
    }
}

impl From<i64> for Cell<'_> {
    fn from(value: i64) -> Self {
        Self::Integer(value)
    }
}

impl<'a> From<&'a str> for Cell<'a> {
    fn from(value: &'a str) -> Self {
        Self::Text(value)
    }
}

impl From<bool> for Cell<'_> {
    fn from(value: bool) -> Self {
        Self::Boolean(value)
    }
}

impl<'a, T: Into<Cell<'a>>> From<Option<T>> for Cell<'a> {
    fn from(value: Option<T>) -> Self {
        value.map_or(Self::Absent, Into::into)
    }
}

/// The one NaN of tables, for every NaN: what hardware makes of 0/0 differs from machine to machine.
pub(super) const fn canonical(value: f64) -> f64 {
    /// Quiet, positive, without payload: the only one that IEEE 754 and all readers agree on.
    const NAN: f64 = f64::from_bits(0x7ff8_0000_0000_0000);
    if value.is_nan() { NAN } else { value }
}

/// Whether a text is short enough.
fn check_text(text: &str, column: &Column) -> Result<(), TableError> {
    if text.len() <= MAX_TEXT_BYTES {
        return Ok(());
    }
    let (column, bytes) = (column.name.clone(), text.len());
    Err(TableError::TextTooLong { column, bytes, allowed: MAX_TEXT_BYTES })
}

/// The cells of a column, top to bottom.
#[derive(Debug, Clone)]
pub enum Values {
    /// Of a column of [`Kind::Float`].
    Float(Vec<Option<f64>>),
    /// Of a column of [`Kind::Integer`].
    Integer(Vec<Option<i64>>),
    /// Of a column of [`Kind::Text`].
    Text(Vec<Option<String>>),
    /// Of a column of [`Kind::Boolean`].
    Boolean(Vec<Option<bool>>),
}

impl Values {
    /// No cells, of a kind.
    #[must_use]
    pub const fn new(kind: Kind) -> Self {
        match kind {
            Kind::Float => Self::Float(Vec::new()),
            Kind::Integer => Self::Integer(Vec::new()),
            Kind::Text => Self::Text(Vec::new()),
            Kind::Boolean => Self::Boolean(Vec::new()),
        }
    }

    /// What the cells are.
    #[must_use]
    pub const fn kind(&self) -> Kind {
        match self {
            Self::Float(_) => Kind::Float,
            Self::Integer(_) => Kind::Integer,
            Self::Text(_) => Kind::Text,
            Self::Boolean(_) => Kind::Boolean,
        }
    }

    /// How many cells there are.
    #[must_use]
    pub const fn len(&self) -> usize {
        match self {
            Self::Float(cells) => cells.len(),
            Self::Integer(cells) => cells.len(),
            Self::Text(cells) => cells.len(),
            Self::Boolean(cells) => cells.len(),
        }
    }

    /// Whether there are no cells.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// A cell; none beyond the last.
    #[must_use]
    pub fn cell(&self, row: usize) -> Option<Cell<'_>> {
        Some(match self {
            Self::Float(cells) => (*cells.get(row)?).into(),
            Self::Integer(cells) => (*cells.get(row)?).into(),
            Self::Text(cells) => cells.get(row)?.as_deref().into(),
            Self::Boolean(cells) => (*cells.get(row)?).into(),
        })
    }

    /// Puts a cell that has been checked below the others.
    fn push(&mut self, cell: Cell<'_>) {
        match (self, cell) {
            (Self::Float(cells), Cell::Float(value)) => cells.push(Some(canonical(value))),
            (Self::Integer(cells), Cell::Integer(value)) => cells.push(Some(value)),
            (Self::Text(cells), Cell::Text(value)) => cells.push(Some(value.to_owned())),
            (Self::Boolean(cells), Cell::Boolean(value)) => cells.push(Some(value)),
            (Self::Float(cells), _) => cells.push(None),
            (Self::Integer(cells), _) => cells.push(None),
            (Self::Text(cells), _) => cells.push(None),
            (Self::Boolean(cells), _) => cells.push(None),
        }
    }

    /// Puts some rows of another column of the same kind below; rows beyond its end are none.
    fn extend(&mut self, other: &Self, rows: Range<usize>) {
        match (self, other) {
            (Self::Float(to), Self::Float(from)) => to.extend(from.get(rows).unwrap_or_default()),
            (Self::Integer(to), Self::Integer(from)) => {
                to.extend(from.get(rows).unwrap_or_default())
            }
            (Self::Text(to), Self::Text(from)) => {
                to.extend_from_slice(from.get(rows).unwrap_or_default())
            }
            (Self::Boolean(to), Self::Boolean(from)) => {
                to.extend(from.get(rows).unwrap_or_default())
            }
            _ => {}
        }
    }

    /// Takes all cells out, leaving the memory for others.
    fn clear(&mut self) {
        match self {
            Self::Float(cells) => cells.clear(),
            Self::Integer(cells) => cells.clear(),
            Self::Text(cells) => cells.clear(),
            Self::Boolean(cells) => cells.clear(),
        }
    }

    /// Checks that these can be the cells of a column, and makes all NaN one.
    fn checked(mut self, column: &Column, rows: usize) -> Result<Self, TableError> {
        let name = || column.name.clone();
        if self.kind() != column.kind {
            return Err(TableError::Kind {
                column: name(),
                expected: column.kind,
                found: self.kind(),
            });
        }
        if self.len() != rows {
            return Err(TableError::UnequalRows {
                column: name(),
                found: self.len(),
                expected: rows,
            });
        }
        match &mut self {
            Self::Float(cells) => {
                cells.iter_mut().flatten().for_each(|value| *value = canonical(*value))
            }
            Self::Text(cells) => {
                cells.iter().flatten().try_for_each(|text| check_text(text, column))?
            }
            Self::Integer(_) | Self::Boolean(_) => {}
        }
        Ok(self)
    }
}

/// Rows under a schema.
#[derive(Debug, Clone)]
pub struct ColumnTable {
    schema: Arc<Schema>,
    values: Vec<Values>,
}

impl ColumnTable {
    /// No rows.
    #[must_use]
    pub fn new(schema: Arc<Schema>) -> Self {
        let values = schema.columns().iter().map(|column| Values::new(column.kind)).collect();
        Self { schema, values }
    }

    /// A table from its columns.
    ///
    /// # Errors
    /// [`TableError::RowLength`] for another number of columns than the schema's,
    /// [`TableError::Kind`], [`TableError::UnequalRows`], [`TableError::TextTooLong`].
    pub fn from_values(schema: Arc<Schema>, values: Vec<Values>) -> Result<Self, TableError> {
        let expected = schema.columns().len();
        if values.len() != expected {
            return Err(TableError::RowLength { found: values.len(), expected });
        }
        let rows = values.first().map_or(0, Values::len);
        let checked = values
            .into_iter()
            .zip(schema.columns())
            .map(|(values, column)| values.checked(column, rows));
        let values = checked.collect::<Result<_, _>>()?;
        Ok(Self { schema, values })
    }

    /// The columns' names, kinds, units and meanings.
    #[must_use]
    pub const fn schema(&self) -> &Arc<Schema> {
        &self.schema
    }

    /// How many rows there are.
    #[must_use]
    pub fn rows(&self) -> usize {
        self.values.first().map_or(0, Values::len)
    }

    /// Puts a row below the others: one cell a column, in the order of the schema.
    ///
    /// # Errors
    /// [`TableError::RowLength`], [`TableError::Kind`], [`TableError::TextTooLong`]; the table is
    /// then as it was.
    pub fn push(&mut self, row: &[Cell<'_>]) -> Result<(), TableError> {
        let columns = self.schema.columns();
        if row.len() != columns.len() {
            return Err(TableError::RowLength { found: row.len(), expected: columns.len() });
        }
        row.iter().zip(columns).try_for_each(|(cell, column)| cell.check(column))?;
        self.values.iter_mut().zip(row).for_each(|(values, cell)| values.push(*cell));
        Ok(())
    }

    /// A cell; none beyond the last row or column.
    #[must_use]
    pub fn cell(&self, row: usize, column: usize) -> Option<Cell<'_>> {
        self.values.get(column)?.cell(row)
    }

    /// The columns' cells, in the order of the schema.
    #[must_use]
    pub fn values(&self) -> &[Values] {
        &self.values
    }

    /// The cells of a column.
    ///
    /// # Errors
    /// [`TableError::UnknownColumn`].
    pub fn column(&self, name: &str) -> Result<&Values, TableError> {
        let index = self.schema.index(name)?;
        self.values.get(index).ok_or(TableError::NoColumns)
    }

    /// The numbers of a column.
    ///
    /// # Errors
    /// [`TableError::UnknownColumn`], [`TableError::Kind`] if it does not hold [`Kind::Float`].
    pub fn floats(&self, name: &str) -> Result<&[Option<f64>], TableError> {
        match self.column(name)? {
            Values::Float(cells) => Ok(cells),
            other => Err(TableError::Kind {
                column: name.to_owned(),
                expected: other.kind(),
                found: Kind::Float,
            }),
        }
    }

    /// Puts the rows of another table below these.
    ///
    /// # Errors
    /// [`TableError::OtherSchema`].
    pub fn append(&mut self, other: &Self) -> Result<(), TableError> {
        if self.schema != other.schema {
            return Err(TableError::OtherSchema);
        }
        self.extend(other, 0..other.rows());
        Ok(())
    }

    /// Some rows as a table of their own.
    ///
    /// # Errors
    /// [`TableError::NoSuchRows`].
    pub fn slice(&self, rows: Range<usize>) -> Result<Self, TableError> {
        if !(rows.start <= rows.end && rows.end <= self.rows()) {
            return Err(TableError::NoSuchRows {
                start: rows.start,
                end: rows.end,
                rows: self.rows(),
            });
        }
        let mut slice = Self::new(Arc::clone(&self.schema));
        slice.extend(self, rows);
        Ok(slice)
    }

    /// Puts some rows of a table with the same schema below.
    pub(super) fn extend(&mut self, other: &Self, rows: Range<usize>) {
        for (to, from) in self.values.iter_mut().zip(&other.values) {
            to.extend(from, rows.clone());
        }
    }

    /// Takes all rows out.
    pub(super) fn clear(&mut self) {
        self.values.iter_mut().for_each(Values::clear);
    }
}

/// The same columns and the same cells, bit for bit.
impl PartialEq for ColumnTable {
    fn eq(&self, other: &Self) -> bool {
        self.schema == other.schema
            && self.rows() == other.rows()
            && self
                .values
                .iter()
                .zip(&other.values)
                .all(|(a, b)| (0..a.len()).all(|row| a.cell(row) == b.cell(row)))
    }
}
