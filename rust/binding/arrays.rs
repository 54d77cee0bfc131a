//! Whole columns of the bodies as NumPy arrays, in body order.

use culbuto::math::{Real, Vec2};
use culbuto::world::Column;
use numpy::ndarray::Dimension;
use numpy::{PyArray, PyArray1, PyArray2, PyArrayDyn, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::exceptions::{PyTypeError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::convert;
use crate::error::to_py;
use crate::world::World;

type Array1<'py> = Bound<'py, PyArray1<Real>>;
type Array2<'py> = Bound<'py, PyArray2<Real>>;

impl World {
    /// A column in an array that `make` makes for a number of bodies. Python objects are not made while the core is
    /// locked; where another thread adds or removes bodies meanwhile, the array is made anew.
    fn column<'py, D: Dimension>(
        &self,
        py: Python<'py>,
        column: Column,
        make: impl Fn(usize) -> Bound<'py, PyArray<Real, D>>,
    ) -> PyResult<Bound<'py, PyArray<Real, D>>> {
        loop {
            let array = make(self.objects().bodies.len());
            {
                let mut out = array.try_readwrite()?;
                let out = out.as_slice_mut()?;
                let core = self.core(py)?;
                if out.len() == column.width() * core.bodies().len() {
                    core.fill_column(column, out).map_err(to_py)?;
                    break Ok(array);
                }
            }
            py.detach(std::thread::yield_now);
        }
    }

    fn vectors<'py>(&self, py: Python<'py>, column: Column) -> PyResult<Array2<'py>> {
        self.column(py, column, |bodies| PyArray2::zeros(py, [bodies, 2], false))
    }

    fn numbers<'py>(&self, py: Python<'py>, column: Column) -> PyResult<Array1<'py>> {
        self.column(py, column, |bodies| PyArray1::zeros(py, bodies, false))
    }

    fn write(&self, py: Python<'_>, column: Column, values: &Bound<'_, PyAny>) -> PyResult<()> {
        let n = self.objects().bodies.len();
        let written = |values: &[Real]| self.core(py)?.write_column(column, values).map_err(to_py);
        if column.width() == 2 {
            let array = convert::points(column.name(), values, Some(n))?;
            match array.as_slice() {
                // A slice follows the memory, which may be Fortran's.
                Ok(values) if array.is_c_contiguous() => written(values),
                _ => written(&array.as_array().iter().copied().collect::<Vec<_>>()),
            }
        } else {
            let array = convert::column(column.name(), values, Some(n))?;
            match array.as_slice() {
                Ok(values) => written(values),
                Err(_) => written(&array.as_array().iter().copied().collect::<Vec<_>>()),
            }
        }
    }

    /// A number of each body that can only be read.
    fn each(
        &self,
        py: Python<'_>,
        read: impl Fn(&culbuto::body::Mass) -> Real,
    ) -> PyResult<Vec<Real>> {
        Ok(self.core(py)?.bodies().masses.iter().map(read).collect())
    }
}

#[pymethods]
impl World {
    /// Positions of the bodies' frames (n, 2) (m). May be set; all or nothing.
    #[getter]
    fn positions<'py>(&self, py: Python<'py>) -> PyResult<Array2<'py>> {
        self.vectors(py, Column::Positions)
    }

    #[setter]
    fn set_positions(&self, py: Python<'_>, values: &Bound<'_, PyAny>) -> PyResult<()> {
        self.write(py, Column::Positions, values)
    }

    /// Angles (n,) (rad). May be set; all or nothing.
    #[getter]
    fn angles<'py>(&self, py: Python<'py>) -> PyResult<Array1<'py>> {
        self.numbers(py, Column::Angles)
    }

    #[setter]
    fn set_angles(&self, py: Python<'_>, values: &Bound<'_, PyAny>) -> PyResult<()> {
        self.write(py, Column::Angles, values)
    }

    /// Velocities of the centres of mass (n, 2) (m/s). May be set; all or nothing.
    #[getter]
    fn velocities<'py>(&self, py: Python<'py>) -> PyResult<Array2<'py>> {
        self.vectors(py, Column::Velocities)
    }

    #[setter]
    fn set_velocities(&self, py: Python<'_>, values: &Bound<'_, PyAny>) -> PyResult<()> {
        self.write(py, Column::Velocities, values)
    }

    /// Angular velocities (n,) (rad/s). May be set; all or nothing.
    #[getter]
    fn angular_velocities<'py>(&self, py: Python<'py>) -> PyResult<Array1<'py>> {
        self.numbers(py, Column::AngularVelocities)
    }

    #[setter]
    fn set_angular_velocities(&self, py: Python<'_>, values: &Bound<'_, PyAny>) -> PyResult<()> {
        self.write(py, Column::AngularVelocities, values)
    }

    /// Constant forces (n, 2) (N). May be set; all or nothing.
    #[getter]
    fn forces<'py>(&self, py: Python<'py>) -> PyResult<Array2<'py>> {
        self.vectors(py, Column::Forces)
    }

    #[setter]
    fn set_forces(&self, py: Python<'_>, values: &Bound<'_, PyAny>) -> PyResult<()> {
        self.write(py, Column::Forces, values)
    }

    /// Constant torques (n,) (N·m). May be set; all or nothing.
    #[getter]
    fn torques<'py>(&self, py: Python<'py>) -> PyResult<Array1<'py>> {
        self.numbers(py, Column::Torques)
    }

    #[setter]
    fn set_torques(&self, py: Python<'_>, values: &Bound<'_, PyAny>) -> PyResult<()> {
        self.write(py, Column::Torques, values)
    }

    /// Masses (n,) (kg).
    #[getter]
    fn masses<'py>(&self, py: Python<'py>) -> PyResult<Array1<'py>> {
        Ok(PyArray1::from_vec(py, self.each(py, |mass| mass.mass)?))
    }

    /// Moments of inertia about the centres of mass (n,) (kg·m²).
    #[getter]
    fn inertias<'py>(&self, py: Python<'py>) -> PyResult<Array1<'py>> {
        Ok(PyArray1::from_vec(py, self.each(py, |mass| mass.inertia)?))
    }

    /// Centres of mass in the world (n, 2) (m).
    #[getter]
    fn centers<'py>(&self, py: Python<'py>) -> PyResult<Array2<'py>> {
        let centers: Vec<Vec2> =
            self.core(py)?.bodies().poses.iter().map(|pose| pose.position).collect();
        crate::shape::rows(py, &centers)
    }

    /// Fills an array of floats, contiguous and of the right shape, with "positions", "angles",
    /// "velocities", "angular_velocities", "forces" or "torques", and returns it; makes one without `out`.
    #[pyo3(signature = (column, *, out=None))]
    fn read<'py>(
        slf: &Bound<'py, Self>,
        column: &str,
        out: Option<Bound<'py, PyAny>>,
    ) -> PyResult<Bound<'py, PyAny>> {
        let py = slf.py();
        let world = slf.get();
        let column = named(column)?;
        let Some(out) = out else {
            return Ok(match column.width() {
                2 => world.vectors(py, column)?.into_any(),
                _ => world.numbers(py, column)?.into_any(),
            });
        };
        let array = out.cast::<PyArrayDyn<Real>>().map_err(|_| {
            PyTypeError::new_err("out is no array of floats (numpy.ndarray of float64)")
        })?;
        let n = world.objects().bodies.len();
        let shape: &[usize] = if column.width() == 2 { &[n, 2] } else { &[n] };
        if array.shape() != shape || !array.is_c_contiguous() {
            let (got, wanted) = (PyTuple::new(py, array.shape())?, PyTuple::new(py, shape)?);
            return Err(PyValueError::new_err(format!(
                "out has shape {got}; wanted a C-contiguous array of floats of shape {wanted}"
            )));
        }
        let mut view = array
            .try_readwrite()
            .map_err(|error| PyValueError::new_err(format!("out cannot be written: {error}")))?;
        world.core(py)?.fill_column(column, view.as_slice_mut()?).map_err(to_py)?;
        drop(view);
        Ok(out)
    }
}

/// The column of a name.
fn named(name: &str) -> PyResult<Column> {
    const ALL: [Column; 6] = [
        Column::Positions,
        Column::Angles,
        Column::Velocities,
        Column::AngularVelocities,
        Column::Forces,
        Column::Torques,
    ];
    ALL.into_iter().find(|column| column.name() == name).ok_or_else(|| {
        let names = ALL.map(Column::name).join(", ");
        PyValueError::new_err(format!("column is {name:?}; allowed: {names}"))
    })
}
