//! Joints whose rows are the user's own code, and how the engine calls it.
//!
//! As with fields, the Python function is held where the garbage collector sees it, by a [`Rule`] of the joint's
//! object, and the engine's side holds a weak reference.

use std::sync::Arc;

use culbuto::error::BoxError;
use culbuto::joint::{Constraint, CustomRow};
use culbuto::math::{Pose, Real};
use numpy::{AllowTypeChange, PyArray1, PyArrayLike1, PyArrayLike2, PyUntypedArrayMethods};
use pyo3::exceptions::{PyRuntimeError, PyTypeError, PyValueError};
use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;
use pyo3::types::{PyWeakrefMethods, PyWeakrefReference};

use crate::convert;

/// The user's function, of the poses of A and B, and what is said of it.
#[pyclass(frozen, weakref)]
pub struct Rule {
    pub function: Py<PyAny>,
    name: String,
    rows: usize,
}

#[pymethods]
impl Rule {
    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        visit.call(&self.function)
    }
}

/// What makes a rule again, for pickles.
pub type RuleParts = (Py<PyAny>, usize);

impl Rule {
    pub fn new(py: Python<'_>, (function, rows): RuleParts) -> PyResult<Py<Self>> {
        let own = function.bind(py);
        let kind = own.get_type().name()?.to_string();
        if !own.is_callable() {
            let message = format!("constraint is a {kind}; wanted a function of two poses");
            return Err(PyTypeError::new_err(message));
        }
        let name = own.getattr_opt("__name__")?.map_or(kind, |name| name.to_string());
        Py::new(py, Self { function, name, rows })
    }

    pub fn parts(&self, py: Python<'_>) -> RuleParts {
        (self.function.clone_ref(py), self.rows)
    }

    /// The engine's side of a rule.
    pub fn shared(rule: &Bound<'_, Self>) -> PyResult<Arc<dyn Constraint>> {
        let Self { name, rows, .. } = rule.get();
        let rule = PyWeakrefReference::new(rule)?.unbind();
        Ok(Arc::new(Caller { rule, name: name.clone(), rows: *rows }))
    }
}

/// The engine's side of a [`Rule`].
struct Caller {
    rule: Py<PyWeakrefReference>,
    name: String,
    rows: usize,
}

impl Caller {
    fn call(&self, py: Python<'_>, poses: &[Pose; 2], rows: &mut [CustomRow]) -> PyResult<()> {
        let gone = || PyRuntimeError::new_err(format!("the joint {:?} is gone", self.name));
        let rule = self.rule.bind(py).upgrade_as::<Rule>()?.ok_or_else(gone)?;
        let [a, b] = poses
            .map(|pose| PyArray1::from_vec(py, vec![pose.position.x, pose.position.y, pose.angle]));
        let result = rule.get().function.bind(py).call1((a, b))?;
        let (positions, jacobians) =
            result.extract::<(Bound<'_, PyAny>, Bound<'_, PyAny>)>().map_err(|_| {
                let message =
                    format!("the joint {:?} gives C and its Jacobian: a tuple", self.name);
                PyTypeError::new_err(message)
            })?;
        self.read_positions(&positions, rows)?;
        self.read_jacobians(&jacobians, rows)
    }

    /// C (k,), or a number if there is one row.
    fn read_positions(&self, given: &Bound<'_, PyAny>, rows: &mut [CustomRow]) -> PyResult<()> {
        if let ([row], Ok(position)) = (&mut *rows, given.extract::<Real>()) {
            row.position = position;
            return Ok(());
        }
        let what = format!("C of the joint {:?}", self.name);
        let positions = convert::column(&what, given, Some(rows.len()))?;
        rows.iter_mut().zip(positions.as_array()).for_each(|(row, c)| row.position = *c);
        Ok(())
    }

    /// J (k, 6), or (6,) if there is one row.
    fn read_jacobians(&self, given: &Bound<'_, PyAny>, rows: &mut [CustomRow]) -> PyResult<()> {
        let flat: Option<Vec<Real>> =
            match given.extract::<PyArrayLike2<'_, Real, AllowTypeChange>>() {
                Ok(all) if all.shape() == [rows.len(), 6] => {
                    Some(all.as_array().iter().copied().collect())
                }
                Ok(_) => None,
                Err(_) => given
                    .extract::<PyArrayLike1<'_, Real, AllowTypeChange>>()
                    .ok()
                    .filter(|one| rows.len() == 1 && one.shape() == [6])
                    .map(|one| one.as_array().iter().copied().collect()),
            };
        let flat = flat.ok_or_else(|| {
            let message = format!(
                "the Jacobian of the joint {:?} is no array of floats of shape ({}, 6): by x, y and angle of A, \
                 then of B",
                self.name,
                rows.len()
            );
            PyValueError::new_err(message)
        })?;
        for (row, j) in rows.iter_mut().zip(flat.chunks_exact(6)) {
            row.jacobian = [[j[0], j[1], j[2]], [j[3], j[4], j[5]]];
        }
        Ok(())
    }
}

impl Constraint for Caller {
    fn name(&self) -> &str {
        &self.name
    }

    fn rows(&self) -> usize {
        self.rows
    }

    fn evaluate(&self, poses: &[Pose; 2], rows: &mut [CustomRow]) -> Result<(), BoxError> {
        Ok(Python::attach(|py| self.call(py, poses, rows))?)
    }
}
