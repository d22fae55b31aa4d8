//! Numbers that cross over where they lie: columns that other libraries read, arrays that are read here.

#![allow(unsafe_code, reason = "memory of another library is read where it lies")]

use arrow_array::Float64Array;
use pyo3::exceptions::PyIndexError;
use pyo3::prelude::*;
use pyo3::types::{PyDict, PyTuple};

use crate::error;

/// Numbers of 64 bits in the order of this machine, as NumPy names them.
const FLOAT64: &str = if cfg!(target_endian = "little") { "<f8" } else { ">f8" };

/// A column of numbers of 64 bits: a sequence, and an array for NumPy without a copy.
#[pyclass(frozen, module = "fspid", weakref, sequence)]
#[derive(Clone)]
pub(crate) struct Column {
    name: String,
    values: Float64Array,
}

impl Column {
    pub(crate) fn arrow(&self) -> Float64Array {
        self.values.clone()
    }

    pub(crate) fn name_of(&self) -> &str {
        &self.name
    }

    pub(crate) fn new(name: String, values: Vec<f64>) -> Self {
        Self { name, values: Float64Array::from(values) }
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
        let value = found.and_then(|place| self.values.values().get(place));
        value.copied().ok_or_else(|| {
            PyIndexError::new_err(format!("{index} in a column of {} numbers", self.values.len()))
        })
    }

    /// The numbers as a list.
    fn tolist(&self) -> Vec<f64> {
        self.values.values().to_vec()
    }

    fn __repr__(&self) -> String {
        match (self.values.values().first(), self.values.values().last()) {
            (Some(first), Some(last)) => {
                let count = self.values.len();
                format!("<Column {}: {count} numbers, {first:?} to {last:?}>", self.name)
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
        interface.set_item("typestr", FLOAT64)?;
        interface.set_item("data", (self.values.values().as_ptr() as usize, true))?;
        Ok(interface)
    }
}

/// Numbers that were given: an array of NumPy where it lies, or a copy of a sequence.
pub(crate) enum Numbers {
    /// An array of numbers of 64 bits, side by side, which `owner` keeps alive.
    Lying { pointer: *const f64, length: usize, _owner: Py<PyAny> },
    /// A copy.
    Copied(Vec<f64>),
}

// SAFETY: the memory belongs to an array that `_owner` keeps alive, and is only read. Who writes to an array while a call
// reads it gets numbers of before or after, as in every library that lets go of the interpreter.
unsafe impl Send for Numbers {}

impl Numbers {
    /// Takes numbers called `name` in messages.
    pub(crate) fn of(given: &Bound<'_, PyAny>, name: &str) -> PyResult<Self> {
        let py = given.py();
        if given.hasattr("__cuda_array_interface__")? {
            let told = "it lies on another device; copy it to this machine's memory first";
            return Err(error::input(py, format_args!("{name}: {told}")));
        }
        if let Ok(interface) = given.getattr("__array_interface__") {
            unmasked(given, name)?;
            return Self::of_array(given, &interface, name);
        }
        let copied = given.extract::<Vec<f64>>();
        copied.map(Self::Copied).map_err(|_| {
            let found = given.get_type().name().map_or_else(|_| String::new(), |it| it.to_string());
            let allowed = "allowed are an array or a sequence of numbers";
            error::input(py, format_args!("{name} is {found}; {allowed}"))
        })
    }

    fn of_array(
        given: &Bound<'_, PyAny>,
        interface: &Bound<'_, PyAny>,
        name: &str,
    ) -> PyResult<Self> {
        let kind: String = interface.get_item("typestr")?.extract()?;
        if !matches!(kind.get(1..2), Some("f" | "i" | "u" | "b")) {
            let dtype = given.getattr("dtype").map_or(kind, |dtype| dtype.to_string());
            let told = format!("{name} is an array of {dtype}; allowed are real numbers");
            return Err(error::input(given.py(), told));
        }
        let strides = interface.get_item("strides").ok().filter(|strides| !strides.is_none());
        if kind != FLOAT64 || strides.is_some() {
            // Other numbers, and numbers that do not lie side by side, are copied.
            let flat = given.call_method0("ravel")?.call_method0("tolist")?;
            return Ok(Self::Copied(flat.extract()?));
        }
        let shape: Vec<usize> = interface.get_item("shape")?.extract()?;
        let (address, _): (usize, bool) = interface.get_item("data")?.extract()?;
        let length = shape.iter().product();
        if length == 0 {
            return Ok(Self::Copied(Vec::new()));
        }
        let pointer = address as *const f64;
        if pointer.is_null() || !pointer.is_aligned() {
            return Ok(Self::Copied(
                given.call_method0("ravel")?.call_method0("tolist")?.extract()?,
            ));
        }
        Ok(Self::Lying { pointer, length, _owner: given.clone().unbind() })
    }

    /// All of them.
    pub(crate) fn as_slice(&self) -> &[f64] {
        match self {
            // SAFETY: the array's own description says that so many aligned numbers lie there side by side, and it lives.
            Self::Lying { pointer, length, .. } => unsafe {
                std::slice::from_raw_parts(*pointer, *length)
            },
            Self::Copied(values) => values,
        }
    }
}

/// Refuses arrays of another shape than a column: which of their numbers belong together would be guessed.
fn one_dimensional(given: &Bound<'_, PyAny>, name: &str) -> PyResult<()> {
    let Ok(interface) = given.getattr("__array_interface__") else { return Ok(()) };
    let shape: Vec<usize> = interface.get_item("shape")?.extract()?;
    if shape.len() == 1 {
        return Ok(());
    }
    let told = format!(
        "{name} is an array of {} dimensions; allowed is one, such as of `array.ravel()`",
        shape.len()
    );
    Err(error::input(given.py(), told))
}

/// Refuses arrays of which numbers are masked: they would be read as they lie.
fn unmasked(given: &Bound<'_, PyAny>, name: &str) -> PyResult<()> {
    if given.hasattr("filled")? && given.hasattr("mask")? {
        let masked: bool = given.getattr("mask")?.call_method0("any")?.is_truthy()?;
        if masked {
            let told = "numbers of it are masked; fill them, or leave their rows out";
            return Err(error::input(given.py(), format_args!("{name}: {told}")));
        }
    }
    Ok(())
}

/// Several columns of one length, each with its name.
pub(crate) fn same_length(
    py: Python<'_>,
    names: &[String],
    given: &Bound<'_, PyTuple>,
) -> PyResult<Vec<Numbers>> {
    if names.len() != given.len() {
        let told = format!("{} are asked for: {}", names.len(), names.join(", "));
        return Err(error::input(py, format_args!("{} inputs are given; {told}", given.len())));
    }
    let columns: Vec<Numbers> = names
        .iter()
        .zip(given.iter())
        .map(|(name, given)| one_dimensional(&given, name).and_then(|()| Numbers::of(&given, name)))
        .collect::<PyResult<_>>()?;
    let lengths: Vec<usize> = columns.iter().map(|column| column.as_slice().len()).collect();
    if lengths.windows(2).any(|pair| pair[0] != pair[1]) {
        let each = names.iter().zip(&lengths).map(|(name, length)| format!("{name} {length}"));
        let told = each.collect::<Vec<_>>().join(", ");
        return Err(error::input(py, format_args!("inputs differ in length: {told}")));
    }
    Ok(columns)
}
