//! Columns for other libraries, through Arrow's C data interface in Python's capsules.

use std::collections::HashMap;
use std::sync::Arc;

use ::arrow_schema::ffi::FFI_ArrowSchema;
use ::arrow_schema::{ArrowError, Field, Schema};
use arrow_array::ffi_stream::FFI_ArrowArrayStream;
use arrow_array::{
    Array, ArrayRef, BooleanArray, FixedSizeListArray, Float64Array, Int64Array, ListArray, RecordBatch,
    RecordBatchIterator, StringArray, UInt64Array,
};
use arrow_buffer::{OffsetBuffer, ScalarBuffer};
use numpy::PyReadonlyArray1;
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyCapsule;

/// Lists at one depth of a column.
#[derive(FromPyObject)]
pub enum Lists {
    /// The length of each list, if all are equally long.
    Length(i32),
    /// The index at which each list begins, and the one at which the last ends.
    Offsets(Vec<i32>),
}

/// Name, unit, number of rows, lists within the rows from the outermost depth, and values.
type Given<'py> = (String, String, usize, Vec<Lists>, Bound<'py, PyAny>);

fn refused(error: ArrowError) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// Numbers, where NaN stands for none, whole numbers, flags, or texts.
fn values(object: &Bound<'_, PyAny>) -> PyResult<ArrayRef> {
    if let Ok(numbers) = object.extract::<PyReadonlyArray1<'_, f64>>() {
        let numbers = numbers.as_array();
        return Ok(if numbers.iter().any(|number| number.is_nan()) {
            Arc::new(
                numbers.iter().map(|number| (!number.is_nan()).then_some(*number)).collect::<Float64Array>(),
            )
        } else {
            Arc::new(Float64Array::from(numbers.to_vec()))
        });
    }
    if let Ok(integers) = object.extract::<PyReadonlyArray1<'_, i64>>() {
        return Ok(Arc::new(Int64Array::from(integers.as_array().to_vec())));
    }
    if let Ok(counts) = object.extract::<PyReadonlyArray1<'_, u64>>() {
        return Ok(Arc::new(UInt64Array::from(counts.as_array().to_vec())));
    }
    if let Ok(flags) = object.extract::<PyReadonlyArray1<'_, bool>>() {
        return Ok(Arc::new(BooleanArray::from(flags.as_array().to_vec())));
    }
    match object.extract::<Vec<String>>() {
        Ok(texts) => Ok(Arc::new(StringArray::from(texts))),
        Err(_) => Err(PyTypeError::new_err(format!("no column of {}", object.get_type()))),
    }
}

/// Returns a column of `rows` cells: the values, in lists of these depths.
fn nested(rows: usize, depths: Vec<Lists>, values: ArrayRef) -> Result<ArrayRef, ArrowError> {
    // The number of lists at a depth; none of them may hold a value that could be counted.
    let mut count = rows;
    let mut counted = Vec::new();
    for lists in depths {
        let inner = match &lists {
            Lists::Length(length) => count * usize::try_from(*length).unwrap_or_default(),
            Lists::Offsets(offsets) => {
                offsets.last().and_then(|end| usize::try_from(*end).ok()).unwrap_or_default()
            }
        };
        counted.push((lists, count));
        count = inner;
    }
    counted.into_iter().rev().try_fold(values, |inner, (lists, count)| -> Result<ArrayRef, ArrowError> {
        let item = Arc::new(Field::new("item", inner.data_type().clone(), true));
        let array: ArrayRef = match lists {
            Lists::Length(length) => {
                Arc::new(FixedSizeListArray::try_new_with_length(item, length, inner, None, count)?)
            }
            Lists::Offsets(offsets) => {
                let offsets = OffsetBuffer::new(ScalarBuffer::from(offsets));
                Arc::new(ListArray::try_new(item, offsets, inner, None)?)
            }
        };
        Ok(array)
    })
}

fn batch(columns: Vec<Given<'_>>, about: HashMap<String, String>) -> PyResult<RecordBatch> {
    let (mut fields, mut arrays) = (Vec::new(), Vec::<ArrayRef>::new());
    for (name, unit, rows, depths, object) in columns {
        let array = nested(rows, depths, values(&object)?).map_err(refused)?;
        let field = Field::new(name, array.data_type().clone(), true);
        let reported: HashMap<_, _> =
            (!unit.is_empty()).then(|| ("unit".to_owned(), unit)).into_iter().collect();
        fields.push(field.with_metadata(reported));
        arrays.push(array);
    }
    let schema = Arc::new(Schema::new_with_metadata(fields, about));
    RecordBatch::try_new(schema, arrays).map_err(refused)
}

/// A stream of one batch of columns; `about` is the metadata of its schema.
#[pyfunction]
pub fn arrow_stream<'py>(
    py: Python<'py>,
    columns: Vec<Given<'py>>,
    about: HashMap<String, String>,
) -> PyResult<Bound<'py, PyCapsule>> {
    let batch = batch(columns, about)?;
    let schema = batch.schema();
    let stream = FFI_ArrowArrayStream::new(Box::new(RecordBatchIterator::new([Ok(batch)], schema)));
    PyCapsule::new_with_value(py, stream, c"arrow_array_stream")
}

/// The schema of such a stream.
#[pyfunction]
pub fn arrow_schema<'py>(
    py: Python<'py>,
    columns: Vec<Given<'py>>,
    about: HashMap<String, String>,
) -> PyResult<Bound<'py, PyCapsule>> {
    let schema = batch(columns, about)?.schema();
    let reported = FFI_ArrowSchema::try_from(schema.as_ref()).map_err(refused)?;
    PyCapsule::new_with_value(py, reported, c"arrow_schema")
}
