//! Fluids of particles.

use culbuto::Part;
use culbuto::fluid::{Fluid as Kind, Fluids, Inflow as Nozzle, Material, lattice_in};
use culbuto::math::{Real, vec2};
use numpy::{PyArray1, PyArray2};
use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;

use crate::convert::{self, Vec2Arg};
use crate::error::to_py;
use crate::parts::{Place, Reduced, reduced};
use crate::record::record;
use crate::shape::{Shape, rows};
use crate::shapes::to_python;
use crate::vec2::Vec2;
use crate::world::World;

record! {
    /// A nozzle: through a segment flows fluid with one velocity, whatever presses against it. Rows of particles are born two
    /// spacings behind the segment and keep that velocity until they have passed it.
    Inflow {
        /// One end of the segment (m).
        start: Vec2,
        /// The other (m).
        end: Vec2,
        /// Velocity (m/s) of what comes out; not along the segment.
        velocity: Vec2,
        /// Way (m) of the last row since it was born; None: there was no row yet.
        progress: Option<Real> = None,
    }
}

/// A fluid of particles. Worlds make them: `World.add_fluid`.
#[pyclass(frozen, dict, weakref, module = "culbuto")]
pub struct Fluid {
    pub place: Place<Kind>,
}

impl Fluid {
    pub fn remove_from(&self, world: &Bound<'_, World>) -> PyResult<()> {
        self.place.check_world(world)?;
        let own = world.get();
        let mut core = own.core(world.py())?;
        let handle = self.place.handle()?;
        let index = core.fluids().list.handles().iter().position(|other| *other == handle);
        core.remove_fluid(handle).map_err(to_py)?;
        self.place.leave();
        let gone = index.map(|index| own.objects().fluids.swap_remove(index));
        drop(core);
        drop(gone);
        Ok(())
    }

    fn read<T>(
        &self,
        py: Python<'_>,
        read: impl FnOnce(&Fluids, culbuto::fluid::FluidHandle) -> culbuto::Result<T>,
    ) -> PyResult<T> {
        let core = self.place.world.get().core(py)?;
        read(core.fluids(), self.place.handle()?).map_err(to_py)
    }

    fn write(
        &self,
        py: Python<'_>,
        write: impl FnOnce(&mut Fluids, culbuto::fluid::FluidHandle) -> culbuto::Result<()>,
    ) -> PyResult<()> {
        let mut core = self.place.world.get().core(py)?;
        let handle = self.place.handle()?;
        write(core.fluids_mut(), handle).map_err(to_py)
    }

    fn change(&self, py: Python<'_>, change: impl FnOnce(&mut Material)) -> PyResult<()> {
        self.write(py, |fluids, fluid| {
            let mut material = fluids.material(fluid)?;
            change(&mut material);
            fluids.set_material(fluid, material)
        })
    }
}

/// Points given as an (n, 2) array, or those of a lattice in a shape.
fn points_of(points: &Bound<'_, PyAny>, spacing: Real) -> PyResult<Vec<culbuto::math::Vec2>> {
    if let Ok(shape) = points.cast::<Shape>() {
        return lattice_in(&shape.get().part.shape, spacing).map_err(to_py);
    }
    let points = convert::points("points", points, None)?;
    Ok(points.as_array().outer_iter().map(|p| vec2(p[0], p[1])).collect())
}

const STILL: Vec2Arg = Vec2Arg(vec2(0.0, 0.0));

#[pymethods]
impl Fluid {
    /// Density at rest (kg/m²).
    #[getter]
    fn density(&self, py: Python<'_>) -> PyResult<Real> {
        self.read(py, |fluids, fluid| Ok(fluids.material(fluid)?.density))
    }

    #[setter]
    fn set_density(&self, py: Python<'_>, density: Real) -> PyResult<()> {
        self.change(py, |material| material.density = density)
    }

    /// Viscosity (Pa·s).
    #[getter]
    fn viscosity(&self, py: Python<'_>) -> PyResult<Real> {
        self.read(py, |fluids, fluid| Ok(fluids.material(fluid)?.viscosity))
    }

    #[setter]
    fn set_viscosity(&self, py: Python<'_>, viscosity: Real) -> PyResult<()> {
        self.change(py, |material| material.viscosity = viscosity)
    }

    /// Surface tension (N/m). Where two fluids meet, both pull.
    #[getter]
    fn tension(&self, py: Python<'_>) -> PyResult<Real> {
        self.read(py, |fluids, fluid| Ok(fluids.material(fluid)?.tension))
    }

    #[setter]
    fn set_tension(&self, py: Python<'_>, tension: Real) -> PyResult<()> {
        self.change(py, |material| material.tension = tension)
    }

    /// Work of adhesion (N/m) to solids: σ(1 + cos θ) for a contact angle θ. Of fluids with surface tension.
    #[getter]
    fn adhesion(&self, py: Python<'_>) -> PyResult<Real> {
        self.read(py, |fluids, fluid| Ok(fluids.material(fluid)?.adhesion))
    }

    #[setter]
    fn set_adhesion(&self, py: Python<'_>, adhesion: Real) -> PyResult<()> {
        self.change(py, |material| material.adhesion = adhesion)
    }

    /// Name; None if it has none.
    #[getter]
    fn name(&self, py: Python<'_>) -> PyResult<Option<String>> {
        self.read(py, |fluids, fluid| Ok(fluids.list.get(fluid)?.name.clone()))
    }

    #[setter]
    fn set_name(&self, py: Python<'_>, name: Option<String>) -> PyResult<()> {
        self.write(py, |fluids, fluid| fluids.rename(fluid, name))
    }

    /// How long (s) its particles are there, from when they were added or from when this was first set; None: for ever.
    #[getter]
    fn lifetime(&self, py: Python<'_>) -> PyResult<Option<Real>> {
        self.read(py, |fluids, fluid| Ok(fluids.list.get(fluid)?.lifetime))
    }

    #[setter]
    fn set_lifetime(&self, py: Python<'_>, lifetime: Option<Real>) -> PyResult<()> {
        self.write(py, |fluids, fluid| fluids.set_lifetime(fluid, lifetime))
    }

    /// Where it flows in. Setting it replaces all; one at a segment where there was one goes on from its last row.
    #[getter]
    fn inflows(&self, py: Python<'_>) -> PyResult<Vec<Inflow>> {
        let own = self.read(py, Fluids::inflows)?;
        let inflow = |own: Nozzle| Inflow {
            start: Vec2(own.start),
            end: Vec2(own.end),
            velocity: Vec2(own.velocity),
            progress: own.progress,
        };
        Ok(own.into_iter().map(inflow).collect())
    }

    #[setter]
    fn set_inflows(&self, py: Python<'_>, inflows: Vec<Py<Inflow>>) -> PyResult<()> {
        let inflow = |own: Py<Inflow>| {
            let Inflow { start, end, velocity, progress } = own.get().clone();
            Nozzle { start: start.0, end: end.0, velocity: velocity.0, progress }
        };
        let inflows: Vec<_> = inflows.into_iter().map(inflow).collect();
        self.write(py, |fluids, fluid| fluids.set_inflows(fluid, &inflows))
    }

    /// Distance of its particles from one another at rest (m).
    #[getter]
    fn spacing(&self, py: Python<'_>) -> PyResult<Real> {
        self.read(py, |fluids, _| Ok(fluids.spacing))
    }

    /// Mass of each of its particles (kg).
    #[getter]
    fn particle_mass(&self, py: Python<'_>) -> PyResult<Real> {
        self.read(py, |fluids, fluid| Ok(fluids.particle_mass(fluid.slot() as u32)))
    }

    /// Positions (n, 2) of its particles (m), oldest first.
    #[getter]
    fn positions<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<Real>>> {
        rows(py, &self.read(py, Fluids::positions)?)
    }

    /// Velocities (n, 2) of its particles (m/s), oldest first. May be set; all or nothing.
    #[getter]
    fn velocities<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray2<Real>>> {
        rows(py, &self.read(py, Fluids::velocities)?)
    }

    #[setter]
    fn set_velocities(&self, py: Python<'_>, values: &Bound<'_, PyAny>) -> PyResult<()> {
        let values = convert::points("velocities", values, None)?;
        let values: Vec<_> = values.as_array().outer_iter().map(|v| vec2(v[0], v[1])).collect();
        self.write(py, |fluids, fluid| fluids.set_velocities(fluid, &values))
    }

    /// Densities (n,) at its particles in the last substep (kg/m²), oldest first; less at a free surface.
    #[getter]
    fn densities<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<Real>>> {
        Ok(PyArray1::from_vec(py, self.read(py, Fluids::densities)?))
    }

    /// Pressures (n,) at its particles in the last substep (Pa), oldest first.
    #[getter]
    fn pressures<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyArray1<Real>>> {
        Ok(PyArray1::from_vec(py, self.read(py, Fluids::pressures)?))
    }

    /// Adds particles at points (n, 2) (m), or on a lattice in a shape, with this velocity (m/s).
    #[pyo3(signature = (points, *, velocity=STILL))]
    fn add(&self, py: Python<'_>, points: &Bound<'_, PyAny>, velocity: Vec2Arg) -> PyResult<()> {
        let points = points_of(points, self.spacing(py)?)?;
        self.write(py, |fluids, fluid| fluids.pour(fluid, &points, velocity.0))
    }

    /// Removes particles by their numbers, those of the arrays.
    fn remove_particles(&self, py: Python<'_>, numbers: &Bound<'_, PyAny>) -> PyResult<()> {
        let numbers: Vec<usize> = numbers.extract()?;
        self.write(py, |fluids, fluid| fluids.take(fluid, &numbers))
    }

    fn __len__(&self, py: Python<'_>) -> PyResult<usize> {
        self.read(py, |fluids, fluid| Ok(fluids.positions(fluid)?.len()))
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

    /// Removes the fluid from its world.
    fn remove(&self, py: Python<'_>) -> PyResult<()> {
        self.remove_from(self.place.world.bind(py))
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        if self.removed() {
            return "<removed Fluid>".to_owned();
        }
        match self.__len__(py) {
            Ok(n) => format!("<Fluid of {n} particles>"),
            Err(_) => "<Fluid of a world at work>".to_owned(),
        }
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced(slf, "fluid", &slf.get().place)
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        self.place.traverse(&visit)
    }
}

#[pymethods]
impl World {
    /// Adds a fluid with particles at points (n, 2) (m), or on a lattice in a shape given in the frame of the world;
    /// `spacing` is their distance at rest (m), the same for all fluids of a world, `density` in kg/m², `viscosity` in Pa·s,
    /// `tension` and `adhesion` in N/m. Without points, particles come by `inflows` or `add`.
    #[pyo3(signature = (points=None, *, spacing, density=1000.0, viscosity=0.0, tension=0.0, adhesion=0.0, name=None))]
    #[allow(clippy::too_many_arguments, reason = "keywords of Python")]
    fn add_fluid<'py>(
        slf: &Bound<'py, Self>,
        points: Option<&Bound<'py, PyAny>>,
        spacing: Real,
        density: Real,
        viscosity: Real,
        tension: Real,
        adhesion: Real,
        name: Option<String>,
    ) -> PyResult<Bound<'py, Fluid>> {
        let points = points.map_or(Ok(Vec::new()), |points| points_of(points, spacing))?;
        let fluid = Bound::new(slf.py(), Fluid { place: Place::new(slf) })?;
        let world = slf.get();
        let mut core = world.core(slf.py())?;
        let material = Material { density, viscosity, tension, adhesion };
        let handle = core.add_fluid(&points, spacing, material).map_err(to_py)?;
        core.fluids_mut().rename(handle, name).map_err(to_py)?;
        fluid.get().place.enter(handle);
        world.objects().fluids.push(fluid.clone().unbind());
        drop(core);
        Ok(fluid)
    }

    /// All fluids.
    #[getter]
    fn fluids(&self, py: Python<'_>) -> Vec<Py<Fluid>> {
        self.objects().fluids.iter().map(|fluid| fluid.clone_ref(py)).collect()
    }

    /// Regions, in the frame of the world, that remove the particles of fluids which enter them.
    #[getter]
    fn drains<'py>(&self, py: Python<'py>) -> PyResult<Vec<Bound<'py, PyAny>>> {
        let drains = self.core(py)?.fluids().drains().to_vec();
        drains.into_iter().map(|shape| to_python(py, Part::from(shape))).collect()
    }

    #[setter]
    fn set_drains(&self, py: Python<'_>, drains: Vec<Bound<'_, Shape>>) -> PyResult<()> {
        let shapes = drains.into_iter().map(|drain| drain.get().part.shape.clone()).collect();
        self.core(py)?.fluids_mut().set_drains(shapes);
        Ok(())
    }

    /// Energy of the surfaces of fluids (J), part of the potential energy: at the start of the last substep, or as it is if
    /// the fluids were changed since.
    #[getter]
    fn surface_energy(&self, py: Python<'_>) -> PyResult<Real> {
        Ok(self.core(py)?.surface_energy())
    }

    /// Threads that work on fluids, 1 unless set. The bits of a run are the same on any number.
    #[getter]
    fn threads(&self, py: Python<'_>) -> PyResult<usize> {
        Ok(self.core(py)?.threads())
    }

    #[setter]
    fn set_threads(&self, py: Python<'_>, threads: u32) -> PyResult<()> {
        self.set(py, |core| core.set_threads(threads))
    }

    /// Pressure of the fluids at a point (Pa): the mean of the particles around it; None where there is none.
    fn pressure_at(&self, py: Python<'_>, point: Vec2Arg) -> PyResult<Option<Real>> {
        Ok(self.core(py)?.fluids().pressure_at(point.0))
    }

    /// Height of the highest free surface of a fluid above a place x (m); None where there is none.
    fn height_at(&self, py: Python<'_>, x: Real) -> PyResult<Option<Real>> {
        Ok(self.core(py)?.fluids().height_at(x))
    }

    /// Mean force (N) and torque (N·m, about the centre of mass) of the fluids on a body in the last step.
    fn fluid_load(
        slf: &Bound<'_, Self>,
        body: &Bound<'_, crate::body::Body>,
    ) -> PyResult<(Vec2, Real)> {
        let place = &body.get().place;
        place.check_world(slf)?;
        let core = slf.get().core(slf.py())?;
        let load = core.fluid_load(place.handle()?).map_err(to_py)?;
        Ok((Vec2(load.force), load.torque))
    }
}
