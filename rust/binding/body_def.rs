//! What a body is: its kind, its shapes and mass, and what it feels of gravity and air.

use culbuto::math::Real;
use pyo3::prelude::*;
use pyo3::types::PyTuple;

use crate::body::Body;
use crate::convert::Vec2Arg;
use crate::shape::parts;
use crate::shapes::to_python;
use crate::vec2::Vec2;
use crate::words::{KindArg, Width, WidthArg, kind_name};

#[pymethods]
impl Body {
    /// "dynamic", "static" or "kinematic". Making a body static stops it.
    #[getter]
    fn kind(&self, py: Python<'_>) -> PyResult<&'static str> {
        self.def(py, |def| kind_name(def.kind))
    }

    #[setter]
    fn set_kind(&self, py: Python<'_>, kind: KindArg) -> PyResult<()> {
        self.edit(py, |body| body.set_kind(kind.0))
    }

    /// Name, or None.
    #[getter]
    fn name(&self, py: Python<'_>) -> PyResult<Option<String>> {
        self.def(py, |def| def.name.clone())
    }

    #[setter]
    fn set_name(&self, py: Python<'_>, name: Option<String>) -> PyResult<()> {
        self.edit(py, |body| body.set_name(name))
    }

    /// The shapes, in the body's frame; empty for a point. May be set to a shape, several or None.
    #[getter]
    fn shapes<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let parts = self.def(py, |def| def.shapes.clone())?;
        let shapes: PyResult<Vec<_>> = parts.into_iter().map(|part| to_python(py, part)).collect();
        PyTuple::new(py, shapes?)
    }

    #[setter]
    fn set_shapes(&self, py: Python<'_>, shapes: Option<&Bound<'_, PyAny>>) -> PyResult<()> {
        let parts = parts(shapes)?;
        self.edit(py, |body| body.set_shapes(parts))
    }

    /// Mass (kg). Setting None lets it follow from the densities again.
    #[getter]
    fn mass(&self, py: Python<'_>) -> PyResult<Real> {
        self.read(py, |body| body.mass().mass)
    }

    #[setter]
    fn set_mass(&self, py: Python<'_>, mass: Option<Real>) -> PyResult<()> {
        self.edit(py, |body| body.set_mass(mass))
    }

    /// Moment of inertia about the centre of mass (kg·m²). Setting None lets it follow from shapes and mass again.
    #[getter]
    fn inertia(&self, py: Python<'_>) -> PyResult<Real> {
        self.read(py, |body| body.mass().inertia)
    }

    #[setter]
    fn set_inertia(&self, py: Python<'_>, inertia: Option<Real>) -> PyResult<()> {
        self.edit(py, |body| body.set_inertia(inertia))
    }

    /// Density of shapes that have none of their own (kg/m²; kg/m of wires).
    #[getter]
    fn density(&self, py: Python<'_>) -> PyResult<Real> {
        self.def(py, |def| def.density)
    }

    #[setter]
    fn set_density(&self, py: Python<'_>, density: Real) -> PyResult<()> {
        self.edit(py, |body| body.set_density(density))
    }

    /// Centre of mass in the body's frame (m). Setting None lets it follow from the shapes again; the
    /// frame stays where it is.
    #[getter]
    fn local_center(&self, py: Python<'_>) -> PyResult<Vec2> {
        self.read(py, |body| Vec2(body.local_center()))
    }

    #[setter]
    fn set_local_center(&self, py: Python<'_>, center: Option<Vec2Arg>) -> PyResult<()> {
        self.edit(py, |body| body.set_center_of_mass(center.map(|center| center.0)))
    }

    /// Whether the body cannot move along x. Locking stops it there.
    #[getter]
    fn lock_x(&self, py: Python<'_>) -> PyResult<bool> {
        self.def(py, |def| def.locks.x)
    }

    #[setter]
    fn set_lock_x(&self, py: Python<'_>, lock: bool) -> PyResult<()> {
        self.set_locks(py, |locks| locks.x = lock)
    }

    /// Whether the body cannot move along y. Locking stops it there.
    #[getter]
    fn lock_y(&self, py: Python<'_>) -> PyResult<bool> {
        self.def(py, |def| def.locks.y)
    }

    #[setter]
    fn set_lock_y(&self, py: Python<'_>, lock: bool) -> PyResult<()> {
        self.set_locks(py, |locks| locks.y = lock)
    }

    /// Whether the body cannot rotate. Locking stops its rotation.
    #[getter]
    fn lock_rotation(&self, py: Python<'_>) -> PyResult<bool> {
        self.def(py, |def| def.locks.rotation)
    }

    #[setter]
    fn set_lock_rotation(&self, py: Python<'_>, lock: bool) -> PyResult<()> {
        self.set_locks(py, |locks| locks.rotation = lock)
    }

    /// How many times gravity acts.
    #[getter]
    fn gravity_scale(&self, py: Python<'_>) -> PyResult<Real> {
        self.def(py, |def| def.gravity_scale)
    }

    #[setter]
    fn set_gravity_scale(&self, py: Python<'_>, scale: Real) -> PyResult<()> {
        self.edit(py, |body| body.set_gravity_scale(scale))
    }

    /// Rate at which the velocity against the air decays (1/s).
    #[getter]
    fn linear_damping(&self, py: Python<'_>) -> PyResult<Real> {
        self.def(py, |def| def.linear_damping)
    }

    #[setter]
    fn set_linear_damping(&self, py: Python<'_>, rate: Real) -> PyResult<()> {
        self.edit(py, |body| {
            let angular = body.get().info().def.angular_damping;
            body.set_damping(rate, angular)
        })
    }

    /// Rate at which the angular velocity decays (1/s).
    #[getter]
    fn angular_damping(&self, py: Python<'_>) -> PyResult<Real> {
        self.def(py, |def| def.angular_damping)
    }

    #[setter]
    fn set_angular_damping(&self, py: Python<'_>, rate: Real) -> PyResult<()> {
        self.edit(py, |body| {
            let linear = body.get().info().def.linear_damping;
            body.set_damping(linear, rate)
        })
    }

    /// C in the air drag ½ρCAv².
    #[getter]
    fn drag_coefficient(&self, py: Python<'_>) -> PyResult<Real> {
        self.def(py, |def| def.drag_coefficient)
    }

    #[setter]
    fn set_drag_coefficient(&self, py: Python<'_>, coefficient: Real) -> PyResult<()> {
        self.edit(py, |body| {
            let width = body.get().info().def.drag_width;
            body.set_drag(coefficient, width)
        })
    }

    /// A in the air drag ½ρCAv²: "silhouette" (the true projected width), "bounding_box", or a width (m).
    #[getter]
    fn drag_width(&self, py: Python<'_>) -> PyResult<Width> {
        self.def(py, |def| def.drag_width.into())
    }

    #[setter]
    fn set_drag_width(&self, py: Python<'_>, width: WidthArg) -> PyResult<()> {
        self.edit(py, |body| {
            let coefficient = body.get().info().def.drag_coefficient;
            body.set_drag(coefficient, width.0)
        })
    }
}
