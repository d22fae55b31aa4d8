//! Columns of numbers that other libraries read where they lie.

use std::sync::Arc;

use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use pyo3::types::PyDict;

/// A column of numbers of 64 bits: a sequence, and an array for NumPy without a copy.
#[pyclass(frozen, module = "fspid", weakref, sequence)]
pub(crate) struct Column {
    name: String,
    values: Arc<Vec<f64>>,
}

impl Column {
    pub(crate) fn new(name: String, values: Vec<f64>) -> Self {
        Self { name, values: Arc::new(values) }
    }
}

#[pymethods]
impl Column {
    /// Its name, whose last part is the unit.
    #[getter]
    fn name(&self) -> &str {
        &self.name
    }

    fn __len__(&self) -> usize {
        self.values.len()
    }

    fn __getitem__(&self, index: isize) -> PyResult<f64> {
        let place =
            if index < 0 { index.checked_add_unsigned(self.values.len()) } else { Some(index) };
        let found = place.and_then(|place| usize::try_from(place).ok());
        let value = found.and_then(|place| self.values.get(place));
        value.copied().ok_or_else(|| {
            PyIndexError::new_err(format!("{index} in a column of {} numbers", self.values.len()))
        })
    }

    /// The numbers as a list.
    fn tolist(&self) -> Vec<f64> {
        self.values.to_vec()
    }

    fn __repr__(&self) -> String {
        match (self.values.first(), self.values.last()) {
            (Some(first), Some(last)) => {
                format!(
                    "<Column {}: {} numbers, {first:?} to {last:?}>",
                    self.name,
                    self.values.len()
                )
            }
            _ => format!("<Column {}: empty>", self.name),
        }
    }

    /// What NumPy reads: nobody may write there.
    #[getter]
    fn __array_interface__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyDict>> {
        let interface = PyDict::new(py);
        interface.set_item("version", 3)?;
        interface.set_item("shape", (self.values.len(),))?;
        interface
            .set_item("typestr", if cfg!(target_endian = "little") { "<f8" } else { ">f8" })?;
        interface.set_item("data", (self.values.as_ptr() as usize, true))?;
        Ok(interface)
    }
}
