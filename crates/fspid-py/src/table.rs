//! Columns for other libraries, through the C data interface of Arrow.

use std::sync::Arc;

use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::{
    ArrayRef, BooleanArray, Float64Array, Int64Array, RecordBatch, RecordBatchIterator,
    RecordBatchReader, StringArray,
};
use arrow_schema::ffi::FFI_ArrowSchema;
use arrow_schema::{ArrowError, DataType, Field, Schema, SchemaRef};
use fspid::campaign::table::{ColumnTable, Kind, Schema as Columns, Values};
use pyo3::prelude::*;
use pyo3::types::PyCapsule;

use crate::array::Column;
use crate::error;

/// Columns of one length; whoever takes Arrow takes them where they lie.
#[pyclass(frozen, module = "fspid")]
pub(crate) struct Table {
    schema: SchemaRef,
    batches: Vec<RecordBatch>,
}

impl Table {
    /// The rows of a campaign.
    pub(crate) fn of_rows(columns: &Columns, rows: Vec<ColumnTable>) -> Result<Self, ArrowError> {
        let fields = columns.columns().iter().map(|column| {
            let facts = [("unit", &column.unit), ("meaning", &column.meaning)];
            let facts = facts.into_iter().filter(|(_, text)| !text.is_empty());
            let facts = facts.map(|(key, text)| (key.to_owned(), text.clone()));
            let facts: std::collections::HashMap<String, String> = facts.collect();
            Field::new(&column.name, data_type(column.kind), true).with_metadata(facts)
        });
        let schema = Arc::new(Schema::new(fields.collect::<Vec<_>>()));
        let batch = |rows: ColumnTable| {
            let columns = rows.values().iter().map(array).collect();
            RecordBatch::try_new(Arc::clone(&schema), columns)
        };
        let batches = rows.into_iter().map(batch).collect::<Result<_, _>>()?;
        Ok(Self { schema, batches })
    }
}

fn data_type(kind: Kind) -> DataType {
    match kind {
        Kind::Float => DataType::Float64,
        Kind::Integer => DataType::Int64,
        Kind::Text => DataType::Utf8,
        Kind::Boolean => DataType::Boolean,
    }
}

fn array(values: &Values) -> ArrayRef {
    match values {
        Values::Float(cells) => Arc::new(cells.iter().copied().collect::<Float64Array>()),
        Values::Integer(cells) => Arc::new(cells.iter().copied().collect::<Int64Array>()),
        Values::Text(cells) => {
            Arc::new(cells.iter().map(Option::as_deref).collect::<StringArray>())
        }
        Values::Boolean(cells) => Arc::new(cells.iter().copied().collect::<BooleanArray>()),
    }
}

#[pymethods]
impl Table {
    /// Columns of one length.
    #[new]
    fn new(py: Python<'_>, columns: Vec<PyRef<'_, Column>>) -> PyResult<Self> {
        let fields = columns.iter().map(|it| Field::new(it.name_of(), DataType::Float64, false));
        let schema = Arc::new(Schema::new(fields.collect::<Vec<_>>()));
        let arrays = columns.iter().map(|column| Arc::new(column.arrow()) as ArrayRef).collect();
        let batch = RecordBatch::try_new(Arc::clone(&schema), arrays);
        let batch = batch.map_err(|found| error::input(py, found))?;
        Ok(Self { schema, batches: vec![batch] })
    }

    /// Names of the columns.
    #[getter]
    fn names(&self) -> Vec<String> {
        self.schema.fields().iter().map(|field| field.name().clone()).collect()
    }

    fn __len__(&self) -> usize {
        self.batches.iter().map(RecordBatch::num_rows).sum()
    }

    fn __repr__(&self) -> String {
        format!("<Table of {} rows: {}>", self.__len__(), self.names().join(", "))
    }

    fn __arrow_c_schema__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyCapsule>> {
        let schema = FFI_ArrowSchema::try_from(self.schema.as_ref());
        let schema = schema.map_err(|found| error::input(py, found))?;
        PyCapsule::new_with_value(py, schema, c"arrow_schema")
    }

    /// All rows; who asks for other types gets these, as the protocol allows.
    #[pyo3(signature = (requested_schema=None))]
    fn __arrow_c_stream__<'py>(
        &self,
        py: Python<'py>,
        requested_schema: Option<&Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyCapsule>> {
        let _ = requested_schema;
        let batches: Vec<_> = self.batches.iter().cloned().map(Ok).collect();
        let reader = RecordBatchIterator::new(batches, Arc::clone(&self.schema));
        let reader: Box<dyn RecordBatchReader + Send> = Box::new(reader);
        PyCapsule::new_with_value(py, FFI_ArrowArrayStream::new(reader), c"arrow_array_stream")
    }
}
