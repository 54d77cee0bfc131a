//! What a user may pass for a vector or an array of them, and how it is read quickly.

use culbuto::math::{self, Real};
use numpy::{AllowTypeChange, PyArrayLike1, PyArrayLike2, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::vec2::Vec2;

/// A two-dimensional vector as an argument: a `Vec2`, a tuple, or any sequence or array of two numbers.
///
/// The common types come first and are told apart by their type alone: no exception is made and
/// thrown away on the way to the right one.
#[derive(Clone, Copy)]
pub struct Vec2Arg(pub math::Vec2);

impl<'py> FromPyObject<'_, 'py> for Vec2Arg {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Some(v) = vec2_or_tuple(object)? {
            return Ok(Self(v));
        }
        let Ok(length) = object.len() else {
            let kind = object.get_type().name()?;
            return Err(PyTypeError::new_err(format!("expected two numbers, got {kind}")));
        };
        check_two(length)?;
        Ok(Self(math::vec2(object.get_item(0)?.extract()?, object.get_item(1)?.extract()?)))
    }
}

/// The other operand of Vec2's `+`, `-` and `==`: a `Vec2` or a tuple of two numbers, nothing else,
/// so that NumPy keeps the last word on its arrays.
#[derive(Clone, Copy)]
pub struct Operand(pub math::Vec2);

impl<'py> FromPyObject<'_, 'py> for Operand {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        match vec2_or_tuple(object)? {
            Some(v) => Ok(Self(v)),
            None => Err(PyTypeError::new_err("expected a Vec2 or a tuple of two numbers")),
        }
    }
}

fn vec2_or_tuple(object: Borrowed<'_, '_, PyAny>) -> PyResult<Option<math::Vec2>> {
    if let Ok(v) = object.cast::<Vec2>() {
        return Ok(Some(v.get().0));
    }
    let Ok(tuple) = object.cast::<PyTuple>() else {
        return Ok(None);
    };
    check_two(tuple.len())?;
    let number = |index| tuple.get_borrowed_item(index)?.extract::<Real>();
    Ok(Some(math::vec2(number(0)?, number(1)?)))
}

fn check_two(length: usize) -> PyResult<()> {
    if length == 2 {
        Ok(())
    } else {
        Err(PyValueError::new_err(format!("expected two numbers, got {length}")))
    }
}

/// An (n, 2) array of floats: the array itself if it is one already, otherwise a converted copy.
///
/// # Errors
/// `ValueError` naming `what` if the shape is not (n, 2), or not (`rows`, 2) where `rows` is given.
pub fn points<'py>(
    what: &str,
    object: &Bound<'py, PyAny>,
    rows: Option<usize>,
) -> PyResult<PyArrayLike2<'py, Real, AllowTypeChange>> {
    let wanted = rows.map_or_else(|| "(n, 2)".to_owned(), |n| format!("({n}, 2)"));
    let array = object
        .extract::<PyArrayLike2<'py, Real, AllowTypeChange>>()
        .map_err(|cause| wrong_shape(what, object, &wanted, Some(cause)))?;
    let [n, width] = [array.shape()[0], array.shape()[1]];
    if width == 2 && rows.is_none_or(|rows| rows == n) {
        Ok(array)
    } else {
        Err(wrong_shape(what, object, &wanted, None))
    }
}

/// An (n,) array of floats: the array itself if it is one already, otherwise a converted copy.
///
/// # Errors
/// `ValueError` naming `what` if the shape is not (n,), or not (`rows`,) where `rows` is given.
pub fn column<'py>(
    what: &str,
    object: &Bound<'py, PyAny>,
    rows: Option<usize>,
) -> PyResult<PyArrayLike1<'py, Real, AllowTypeChange>> {
    let wanted = rows.map_or_else(|| "(n,)".to_owned(), |n| format!("({n},)"));
    let array = object
        .extract::<PyArrayLike1<'py, Real, AllowTypeChange>>()
        .map_err(|cause| wrong_shape(what, object, &wanted, Some(cause)))?;
    if rows.is_none_or(|rows| rows == array.shape()[0]) {
        Ok(array)
    } else {
        Err(wrong_shape(what, object, &wanted, None))
    }
}

/// "`what` has shape (3,); wanted an array of floats of shape (n, 2)".
fn wrong_shape(what: &str, object: &Bound<'_, PyAny>, wanted: &str, cause: Option<PyErr>) -> PyErr {
    let py = object.py();
    let shape = py.import("numpy").and_then(|numpy| numpy.call_method1("shape", (object,)));
    let got = shape.map_or_else(|_| "is no array".to_owned(), |shape| format!("has shape {shape}"));
    let error =
        PyValueError::new_err(format!("{what} {got}; wanted an array of floats of shape {wanted}"));
    error.set_cause(py, cause);
    error
}

/// The rows of an (n, 2) array.
///
/// # Errors
/// Those of [`points`].
pub fn vectors(
    what: &str,
    object: &Bound<'_, PyAny>,
    rows: Option<usize>,
) -> PyResult<Vec<math::Vec2>> {
    let array = points(what, object, rows)?;
    Ok(array.as_array().rows().into_iter().map(|row| math::vec2(row[0], row[1])).collect())
}

/// A whole number, 0 or above.
///
/// # Errors
/// `ValueError` naming `what` for numbers that are not.
pub fn count(what: &str, n: i64) -> PyResult<u32> {
    u32::try_from(n).map_err(|_| {
        PyValueError::new_err(format!(
            "{what} is {n}; allowed: a whole number from 0 to {}",
            u32::MAX
        ))
    })
}
