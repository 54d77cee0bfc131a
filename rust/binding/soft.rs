//! Deformable bodies.

use culbuto::World as Core;
use culbuto::body::{Filter, Surface};
use culbuto::math::{Real, Vec2 as CoreVec2};
use culbuto::soft::{Gas, SoftBody as Kind, SoftHandle};
use numpy::{PyArray1, PyArray2, PyArrayMethods};
use pyo3::exceptions::PyValueError;
use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;

use crate::add_soft::plane_name;
use crate::convert::{self, Vec2Arg, count};
use crate::error::to_py;
use crate::parts::{Place, Reduced, reduced};
use crate::shape::rows;
use crate::surface::{self, Coefficients, FrictionArg, coefficients};
use crate::vec2::Vec2;
use crate::world::World;

/// A deformable body. Worlds make them: `World.add_soft_body`.
#[pyclass(frozen, dict, weakref, module = "culbuto")]
pub struct SoftBody {
    pub place: Place<Kind>,
}

/// A list of what Python has another of; a `ValueError` that names `what` where it has not.
pub fn numbers<'py, T>(what: &str, object: &Bound<'py, PyAny>, wanted: &str) -> PyResult<Vec<T>>
where
    Vec<T>: for<'a> FromPyObject<'a, 'py, Error = PyErr>,
{
    object.extract::<Vec<T>>().map_err(|cause| {
        let error = PyValueError::new_err(format!("{what} are none; allowed: {wanted}"));
        error.set_cause(object.py(), Some(cause));
        error
    })
}

/// Numbers of nodes as rows.
fn table<'py, const N: usize>(
    py: Python<'py>,
    elements: &[[u32; N]],
) -> PyResult<Bound<'py, PyArray2<i64>>> {
    let flat = elements.iter().flatten().map(|i| i64::from(*i)).collect();
    PyArray1::from_vec(py, flat).reshape([elements.len(), N])
}

/// Three components as rows.
fn tensors<'py>(py: Python<'py>, rows: &[[Real; 3]]) -> PyResult<Bound<'py, PyArray2<Real>>> {
    PyArray1::from_vec(py, rows.as_flattened().to_vec()).reshape([rows.len(), 3])
}

impl World {
    /// The object of a deformable body.
    pub fn soft_body(&self, py: Python<'_>, handle: SoftHandle) -> Option<Py<SoftBody>> {
        let is = |body: &&Py<SoftBody>| body.get().place.known() == Some(handle);
        self.objects().softs.iter().find(is).map(|body| body.clone_ref(py))
    }
}

impl SoftBody {
    pub fn remove_from(&self, world: &Bound<'_, World>) -> PyResult<()> {
        self.place.check_world(world)?;
        let own = world.get();
        let mut core = own.core(world.py())?;
        let handle = self.place.handle()?;
        let index = core.soft_handles().iter().position(|other| *other == handle);
        core.remove_soft_body(handle).map_err(to_py)?;
        self.place.leave();
        let mut objects = own.objects();
        let gone = index.map(|index| objects.softs.swap_remove(index));
        let joints = objects.keep_joints(core.joint_handles());
        drop(objects);
        drop(core);
        drop((gone, joints));
        Ok(())
    }

    fn read<T>(&self, py: Python<'_>, read: impl FnOnce(&Kind) -> T) -> PyResult<T> {
        let core = self.place.world.get().core(py)?;
        Ok(read(core.soft_body(self.place.handle()?).map_err(to_py)?))
    }

    fn write(
        &self,
        py: Python<'_>,
        write: impl FnOnce(&mut Core, SoftHandle) -> culbuto::Result<()>,
    ) -> PyResult<()> {
        let mut core = self.place.world.get().core(py)?;
        let handle = self.place.handle()?;
        write(&mut core, handle).map_err(to_py)
    }

    fn set_surface(&self, py: Python<'_>, set: impl FnOnce(&mut Surface)) -> PyResult<()> {
        self.write(py, |core, body| {
            let mut surface = core.soft_body(body)?.def().surface.clone();
            set(&mut surface);
            core.set_soft_surface(body, surface)
        })
    }

    fn set_filter(&self, py: Python<'_>, set: impl FnOnce(&mut Filter)) -> PyResult<()> {
        self.write(py, |core, body| {
            let mut filter = core.soft_body(body)?.def().filter;
            set(&mut filter);
            core.set_soft_filter(body, filter)
        })
    }

    /// A column of vectors, one for each node.
    fn column(
        &self,
        py: Python<'_>,
        what: &str,
        values: &Bound<'_, PyAny>,
    ) -> PyResult<Vec<CoreVec2>> {
        convert::vectors(what, values, Some(self.__len__(py)?))
    }
}

/// What moves, and what can be set.
#[pymethods]
impl SoftBody {
    /// Positions (n, 2) of its nodes (m). May be set; all or nothing.
    #[getter]
    fn positions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<Real>>> {
        rows(py, &self.read(py, |body| body.positions().to_vec())?)
    }

    #[setter]
    fn set_positions(&self, py: Python<'_>, values: &Bound<'_, PyAny>) -> PyResult<()> {
        let values = self.column(py, "positions", values)?;
        self.write(py, |core, body| core.set_soft_positions(body, &values))
    }

    /// Velocities (n, 2) of its nodes (m/s). May be set, all or nothing; those of pinned nodes stay 0.
    #[getter]
    fn velocities<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<Real>>> {
        rows(py, &self.read(py, |body| body.velocities().to_vec())?)
    }

    #[setter]
    fn set_velocities(&self, py: Python<'_>, values: &Bound<'_, PyAny>) -> PyResult<()> {
        let values = self.column(py, "velocities", values)?;
        self.write(py, |core, body| core.set_soft_velocities(body, &values))
    }

    /// Constant forces (n, 2) on its nodes (N). May be set; all or nothing.
    #[getter]
    fn forces<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<Real>>> {
        let forces = self.read(py, |body| {
            let mut forces = body.forces().to_vec();
            forces.resize(body.positions().len(), CoreVec2::zeros());
            forces
        })?;
        rows(py, &forces)
    }

    #[setter]
    fn set_forces(&self, py: Python<'_>, values: &Bound<'_, PyAny>) -> PyResult<()> {
        let values = self.column(py, "forces", values)?;
        self.write(py, |core, body| core.set_soft_forces(body, &values))
    }

    /// Which of its nodes (n,) stay where they are. May be set.
    #[getter]
    fn pinned<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<bool>>> {
        Ok(PyArray1::from_vec(py, self.read(py, |body| body.pinned().to_vec())?))
    }

    #[setter]
    fn set_pinned(&self, py: Python<'_>, values: &Bound<'_, PyAny>) -> PyResult<()> {
        let nodes = self.__len__(py)?;
        let wanted = format!("True or False for each of the {nodes} nodes");
        let values: Vec<bool> = numbers("pinned", values, &wanted)?;
        if values.len() != nodes {
            let got = values.len();
            return Err(PyValueError::new_err(format!("pinned has {got}; allowed: {wanted}")));
        }
        self.write(py, |core, body| {
            let now = core.soft_body(body)?.pinned().to_vec();
            for (node, on) in (0..).zip(&values).filter(|(node, on)| now[*node as usize] != **on) {
                core.pin_soft_node(body, node, *on)?;
            }
            Ok(())
        })
    }

    /// Fills a closed rope with a gas: its pressure (Pa) in the area at rest, that outside (Pa), and γ of pAᵞ.
    #[pyo3(signature = (pressure, *, outside=0.0, exponent=1.0))]
    fn inflate(
        &self,
        py: Python<'_>,
        pressure: Real,
        outside: Real,
        exponent: Real,
    ) -> PyResult<()> {
        let gas = Gas { pressure, outside, exponent };
        self.write(py, |core, body| core.set_soft_gas(body, Some(gas)))
    }

    /// Pricks it: the gas in it is gone.
    fn puncture(&self, py: Python<'_>) -> PyResult<()> {
        self.write(py, |core, body| core.set_soft_gas(body, None))
    }
}

/// What it is made of.
#[pymethods]
impl SoftBody {
    /// Name; None if it has none.
    #[getter]
    fn name(&self, py: Python<'_>) -> PyResult<Option<String>> {
        self.read(py, |body| body.def().name.clone())
    }

    /// Places (n, 2) of its nodes at rest (m), in its frame.
    #[getter]
    fn rest<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<Real>>> {
        rows(py, &self.read(py, |body| body.def().mesh.rest().to_vec())?)
    }

    /// Its triangles (m, 6): the nodes at the corners, counter-clockwise, then those on the sides 01, 12, 20.
    #[getter]
    fn triangles<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<i64>>> {
        table(py, &self.read(py, |body| body.def().mesh.triangles().to_vec())?)
    }

    /// Its rods (m, 2): the nodes at their ends.
    #[getter]
    fn rods<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<i64>>> {
        table(py, &self.read(py, |body| body.def().mesh.rods().to_vec())?)
    }

    /// Pieces of its border (b, 2) from node to node, with the matter on the left; of ropes, the rods.
    #[getter]
    fn border<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<i64>>> {
        table(py, &self.read(py, |body| body.def().mesh.border().to_vec())?)
    }

    /// Mass per area (kg/m²); of ropes per length (kg/m).
    #[getter]
    fn density(&self, py: Python<'_>) -> PyResult<Real> {
        self.read(py, |body| body.def().material.density)
    }

    /// Young's modulus (Pa).
    #[getter]
    fn youngs_modulus(&self, py: Python<'_>) -> PyResult<Real> {
        self.read(py, |body| body.def().material.youngs_modulus)
    }

    /// Poisson's ratio.
    #[getter]
    fn poissons_ratio(&self, py: Python<'_>) -> PyResult<Real> {
        self.read(py, |body| body.def().material.poissons_ratio)
    }

    /// What is zero across the plane: "stress" or "strain".
    #[getter]
    fn plane(&self, py: Python<'_>) -> PyResult<&'static str> {
        self.read(py, |body| plane_name(body.def().material.plane))
    }

    /// Part of critical damping at `damping_frequency`.
    #[getter]
    fn damping_ratio(&self, py: Python<'_>) -> PyResult<Real> {
        self.read(py, |body| body.def().material.damping_ratio)
    }

    /// Frequency at which `damping_ratio` holds (Hz).
    #[getter]
    fn damping_frequency(&self, py: Python<'_>) -> PyResult<Real> {
        self.read(py, |body| body.def().material.damping_frequency)
    }

    /// Difference of the principal strains beyond which it stays bent; None: never.
    #[getter]
    fn yield_strain(&self, py: Python<'_>) -> PyResult<Option<Real>> {
        self.read(py, |body| body.def().material.yield_strain)
    }

    /// Static and kinetic friction. May be set, to one number for both.
    #[getter]
    fn friction(&self, py: Python<'_>) -> PyResult<Coefficients> {
        self.read(py, |body| coefficients(body.def().surface.friction))
    }

    #[setter]
    fn set_friction(&self, py: Python<'_>, friction: FrictionArg) -> PyResult<()> {
        self.set_surface(py, |surface| surface.friction = friction.0)
    }

    /// Coefficient of restitution. May be set.
    #[getter]
    fn restitution(&self, py: Python<'_>) -> PyResult<Real> {
        self.read(py, |body| body.def().surface.restitution)
    }

    #[setter]
    fn set_restitution(&self, py: Python<'_>, restitution: Real) -> PyResult<()> {
        self.set_surface(py, |surface| surface.restitution = restitution)
    }

    /// Bits of the categories to which it belongs. May be set.
    #[getter]
    fn category(&self, py: Python<'_>) -> PyResult<u32> {
        self.read(py, |body| body.def().filter.category)
    }

    #[setter]
    fn set_category(&self, py: Python<'_>, bits: i64) -> PyResult<()> {
        let bits = count("category", bits)?;
        self.set_filter(py, |filter| filter.category = bits)
    }

    /// Bits of the categories that it touches. May be set.
    #[getter]
    fn mask(&self, py: Python<'_>) -> PyResult<u32> {
        self.read(py, |body| body.def().filter.mask)
    }

    #[setter]
    fn set_mask(&self, py: Python<'_>, bits: i64) -> PyResult<()> {
        let bits = count("mask", bits)?;
        self.set_filter(py, |filter| filter.mask = bits)
    }

    /// Its group, 0 for none: those of one always touch if it is above 0, never if it is below. May be set.
    #[getter]
    fn group(&self, py: Python<'_>) -> PyResult<i32> {
        self.read(py, |body| body.def().filter.group)
    }

    #[setter]
    fn set_group(&self, py: Python<'_>, group: i64) -> PyResult<()> {
        let group = surface::group(group)?;
        self.set_filter(py, |filter| filter.group = group)
    }

    /// By how much its border is thicker than its nodes say (m).
    #[getter]
    fn radius(&self, py: Python<'_>) -> PyResult<Real> {
        self.read(py, Kind::radius)
    }
}

/// What can be asked of it.
#[pymethods]
impl SoftBody {
    /// Mass (kg).
    #[getter]
    fn mass(&self, py: Python<'_>) -> PyResult<Real> {
        self.read(py, Kind::mass)
    }

    /// What each of its nodes (n,) weighs where all move alike (kg).
    #[getter]
    fn node_masses<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<Real>>> {
        Ok(PyArray1::from_vec(py, self.read(py, |body| body.shares().to_vec())?))
    }

    /// Centre of mass (m).
    #[getter]
    fn center(&self, py: Python<'_>) -> PyResult<Vec2> {
        Ok(Vec2(self.read(py, Kind::center)?))
    }

    /// Momentum (kg·m/s).
    #[getter]
    fn momentum(&self, py: Python<'_>) -> PyResult<Vec2> {
        Ok(Vec2(self.read(py, Kind::momentum)?))
    }

    /// Angular momentum about a point (kg·m²/s).
    fn angular_momentum(&self, py: Python<'_>, about: Vec2Arg) -> PyResult<Real> {
        self.read(py, |body| body.angular_momentum(about.0))
    }

    /// Kinetic energy (J).
    #[getter]
    fn kinetic_energy(&self, py: Python<'_>) -> PyResult<Real> {
        self.read(py, Kind::kinetic_energy)
    }

    /// Energy of what is strained, and of the gas in it (J).
    #[getter]
    fn strain_energy(&self, py: Python<'_>) -> PyResult<Real> {
        self.read(py, Kind::strain_energy)
    }

    /// Area of its triangles (m²), or inside a rope that is filled.
    #[getter]
    fn area(&self, py: Python<'_>) -> PyResult<Real> {
        self.read(py, Kind::area)
    }

    /// Pressure of the gas in it above that outside (Pa); None without a gas.
    #[getter]
    fn pressure(&self, py: Python<'_>) -> PyResult<Option<Real>> {
        self.read(py, Kind::pressure)
    }

    /// Green's strain (m, 3) of each triangle: xx, yy, xy in the axes of its frame. Of ropes each rod's relative stretch, as xx.
    #[getter]
    fn strains<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<Real>>> {
        tensors(py, &self.read(py, Kind::strains)?)
    }

    /// Cauchy's stress (m, 3) of each triangle without the viscous part (Pa): xx, yy, xy in the axes of the world. Of ropes each rod's
    /// tension (N), as xx.
    #[getter]
    fn stresses<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<Real>>> {
        tensors(py, &self.read(py, Kind::stresses)?)
    }

    /// Number of its nodes.
    fn __len__(&self, py: Python<'_>) -> PyResult<usize> {
        self.read(py, |body| body.positions().len())
    }

    fn __bool__(&self) -> bool {
        true
    }

    /// The world it is, or was, in.
    #[getter]
    fn world(&self, py: Python<'_>) -> Py<World> {
        self.place.world.clone_ref(py)
    }

    /// Whether it was removed from its world.
    #[getter]
    fn removed(&self) -> bool {
        !self.place.is_alive()
    }

    /// Removes the body from its world.
    fn remove(&self, py: Python<'_>) -> PyResult<()> {
        self.remove_from(self.place.world.bind(py))
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        if self.removed() {
            return "<removed SoftBody>".to_owned();
        }
        let said = self.read(py, |body| (body.def().name.clone(), body.positions().len()));
        match said {
            Ok((Some(name), n)) => format!("<SoftBody {name:?} of {n} nodes>"),
            Ok((None, n)) => format!("<SoftBody of {n} nodes>"),
            Err(_) => "<SoftBody of a world at work>".to_owned(),
        }
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced(slf, "soft body", &slf.get().place)
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        self.place.traverse(&visit)
    }
}
