//! The vector that Python gets back: immutable, and at home among tuples and arrays.

use culbuto::math::{self, Real};
use numpy::{PyArray1, PyUntypedArray};
use pyo3::exceptions::{PyIndexError, PyTypeError, PyValueError, PyZeroDivisionError};
use pyo3::prelude::*;
use pyo3::types::{PyFloat, PyIterator, PyTuple};

use crate::convert::{Operand, Vec2Arg};

/// An immutable vector or point in the plane (SI units, y up).
///
/// Wherever culbuto wants a vector, a tuple of two numbers does as well; what it gives back is a
/// `Vec2`, which unpacks like a tuple, equals the tuple of its components and hashes like it.
#[pyclass(frozen, module = "culbuto")]
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vec2(pub math::Vec2);

#[pymethods]
impl Vec2 {
    /// NumPy's scalars rank below, so that `np.float64(2) * v` is a `Vec2`; its arrays rank above,
    /// so that `array * v` is an array.
    #[classattr]
    #[pyo3(name = "__array_priority__")]
    const ARRAY_PRIORITY: Real = -1.0;

    /// `case Vec2(x, y)` in a match statement.
    #[classattr]
    #[pyo3(name = "__match_args__")]
    const MATCH_ARGS: (&'static str, &'static str) = ("x", "y");

    #[new]
    fn new(x: Real, y: Real) -> Self {
        Self(math::vec2(x, y))
    }

    /// First component.
    #[getter]
    fn x(&self) -> Real {
        self.0.x
    }

    /// Second component.
    #[getter]
    fn y(&self) -> Real {
        self.0.y
    }

    /// Euclidean length, without overflow or underflow on the way.
    #[getter]
    fn length(&self) -> Real {
        self.0.x.hypot(self.0.y)
    }

    /// Angle against +x (rad), counter-clockwise, in [−π, π].
    #[getter]
    fn angle(&self) -> Real {
        math::atan2(self.0.y, self.0.x)
    }

    /// Dot product with another vector.
    fn dot(&self, other: Vec2Arg) -> Real {
        self.0.dot(&other.0)
    }

    /// z component of the cross product: positive if `other` lies counter-clockwise of this vector.
    fn cross(&self, other: Vec2Arg) -> Real {
        math::cross(self.0, other.0)
    }

    fn __add__(&self, other: Operand) -> Self {
        Self(self.0 + other.0)
    }

    fn __radd__(&self, other: Operand) -> Self {
        Self(other.0 + self.0)
    }

    fn __sub__(&self, other: Operand) -> Self {
        Self(self.0 - other.0)
    }

    fn __rsub__(&self, other: Operand) -> Self {
        Self(other.0 - self.0)
    }

    fn __mul__(&self, factor: Scalar) -> Self {
        Self(self.0 * factor.0)
    }

    fn __rmul__(&self, factor: Scalar) -> Self {
        Self(self.0 * factor.0)
    }

    fn __truediv__(&self, divisor: Scalar) -> PyResult<Self> {
        if divisor.0 == 0.0 {
            return Err(PyZeroDivisionError::new_err("Vec2 divided by zero"));
        }
        Ok(Self(self.0 / divisor.0))
    }

    fn __neg__(&self) -> Self {
        Self(-self.0)
    }

    fn __pos__(&self) -> Self {
        *self
    }

    fn __abs__(&self) -> Real {
        self.length()
    }

    fn __eq__(&self, other: Operand) -> bool {
        self.0 == other.0
    }

    /// The hash of the tuple it equals, so that either finds the other in a set or a dict.
    fn __hash__(&self, py: Python<'_>) -> PyResult<isize> {
        self.tuple(py)?.hash()
    }

    fn __len__(&self) -> usize {
        2
    }

    fn __getitem__(&self, index: isize) -> PyResult<Real> {
        match index {
            0 | -2 => Ok(self.0.x),
            1 | -1 => Ok(self.0.y),
            _ => Err(PyIndexError::new_err(format!("Vec2 has components 0 and 1, not {index}"))),
        }
    }

    fn __iter__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyIterator>> {
        self.tuple(py)?.try_iter()
    }

    /// A new array of shape (2,). As it is always new, `copy=False` is a `ValueError` (NumPy's protocol).
    #[pyo3(signature = (dtype=None, copy=None))]
    fn __array__<'py>(
        &self,
        py: Python<'py>,
        dtype: Option<Bound<'py, PyAny>>,
        copy: Option<bool>,
    ) -> PyResult<Bound<'py, PyAny>> {
        if copy == Some(false) {
            return Err(PyValueError::new_err("a Vec2 has no array that could be shared"));
        }
        let array = PyArray1::from_slice(py, &[self.0.x, self.0.y]).into_any();
        match dtype {
            None => Ok(array),
            Some(dtype) => array.call_method1("astype", (dtype,)),
        }
    }

    fn __repr__(&self) -> String {
        format!("Vec2({:?}, {:?})", self.0.x, self.0.y)
    }

    fn __reduce__<'py>(
        slf: &Bound<'py, Self>,
    ) -> PyResult<(Bound<'py, PyAny>, Bound<'py, PyTuple>)> {
        Ok((slf.get_type().into_any(), slf.get().tuple(slf.py())?))
    }
}

/// As a field of a plain record, whose constructor takes what every vector argument does.
impl<'py> FromPyObject<'_, 'py> for Vec2 {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        Vec2Arg::extract(object).map(|v| Self(v.0))
    }
}

impl Vec2 {
    fn tuple<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        (self.0.x, self.0.y).into_pyobject(py)
    }
}

/// A number that scales a vector. Arrays are left to NumPy, even those that hold a single number.
#[derive(Clone, Copy)]
struct Scalar(Real);

impl<'py> FromPyObject<'_, 'py> for Scalar {
    type Error = PyErr;

    fn extract(object: Borrowed<'_, 'py, PyAny>) -> PyResult<Self> {
        if let Ok(float) = object.cast::<PyFloat>() {
            return Ok(Self(float.value()));
        }
        match object.extract() {
            Ok(number) if object.cast::<PyUntypedArray>().is_err() => Ok(Self(number)),
            _ => Err(PyTypeError::new_err("expected a number")),
        }
    }
}
