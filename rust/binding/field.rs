//! Force fields: the user's own functions, and those that come with the engine.

use std::sync::OnceLock;

use culbuto::World as Core;
use culbuto::forces::{self, BuiltInField, Field as Kind};
use culbuto::math::{Real, vec2};
use pyo3::exceptions::PyTypeError;
use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;

use crate::body::Body;
use crate::error::to_py;
use crate::law::Law;
use crate::parts::{Place, Reduced, reduced};
use crate::record::record;
use crate::vec2::Vec2;
use crate::world::World;

record! {
    /// A pull of every body towards a point, −strength·r^exponent (N; times the body's mass if `per_mass`):
    /// gravitation of a sun (exponent −2, per mass), a spring (1), a constant pull (0).
    Central {
        /// The point (m).
        center: Vec2,
        /// N/m^exponent, or that per kg.
        strength: Real,
        /// Power of the distance.
        exponent: Real,
        /// Whether the force is proportional to the mass it acts on.
        per_mass: bool = false,
    }
}

record! {
    /// A pull of all bodies on one another, −strength·m₁m₂·r/(r² + softening²)^((1 − exponent)/2) (N):
    /// gravitation for exponent −2.
    Attraction {
        /// N/(kg²·m^exponent).
        strength: Real,
        /// Power of the distance.
        exponent: Real = -2.0,
        /// Length (m) below which the pull no longer grows.
        softening: Real = 0.0,
    }
}

/// A force through the centre of mass of one body, and a torque on it, that vary as sin(2π·hertz·t + phase).
#[pyclass(frozen, get_all, module = "culbuto")]
pub struct Oscillating {
    /// The body. The field acts on nothing once it is removed.
    body: Py<Body>,
    /// Amplitude of the force (N).
    force: Vec2,
    /// Amplitude of the torque (N·m).
    torque: Real,
    /// Frequency (Hz).
    hertz: Real,
    /// Phase at t = 0 (rad).
    phase: Real,
}

const NONE: Vec2 = Vec2(vec2(0.0, 0.0));

#[pymethods]
impl Oscillating {
    #[new]
    #[pyo3(signature = (body, force=NONE, torque=0.0, hertz=1.0, phase=0.0))]
    fn new(body: Py<Body>, force: Vec2, torque: Real, hertz: Real, phase: Real) -> Self {
        Self { body, force, torque, hertz, phase }
    }

    fn __eq__(&self, other: &Bound<'_, PyAny>) -> bool {
        let numbers = |o: &Self| (o.force, [o.torque, o.hertz, o.phase]);
        other.cast::<Self>().is_ok_and(|other| {
            let other = other.get();
            self.body.is(&other.body) && numbers(self) == numbers(other)
        })
    }

    fn __repr__(&self, py: Python<'_>) -> PyResult<String> {
        let body = self.body.bind(py).repr()?;
        let Self { force, torque, hertz, phase, .. } = self;
        let (x, y) = (force.0.x, force.0.y);
        Ok(format!(
            "Oscillating({body}, force=({x:?}, {y:?}), torque={torque:?}, hertz={hertz:?}, phase={phase:?})"
        ))
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> (Bound<'py, PyAny>, Arguments) {
        let Self { body, force, torque, hertz, phase } = slf.get();
        let arguments = (body.clone_ref(slf.py()), *force, *torque, *hertz, *phase);
        (slf.get_type().into_any(), arguments)
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        visit.call(&self.body)
    }
}

type Arguments = (Py<Body>, Vec2, Real, Real, Real);

/// A field of a world. Worlds make them: `World.add_field`.
#[pyclass(frozen, dict, weakref, module = "culbuto")]
pub struct Field {
    pub place: Place<Kind>,
    /// The user's own code; none for a field that comes with the engine.
    law: OnceLock<Py<Law>>,
}

impl Field {
    /// A field that is yet to be given its place.
    pub fn new(world: &Bound<'_, World>, law: Option<Py<Law>>) -> Self {
        let field = Self { place: Place::new(world), law: OnceLock::new() };
        field.adopt(law);
        field
    }

    /// Gives a law to a field that has none yet.
    pub fn adopt(&self, law: Option<Py<Law>>) {
        if let Some(law) = law {
            // A field that has a law keeps it: they are the same.
            let _ = self.law.set(law);
        }
    }

    /// The user's own code; none for a field that comes with the engine.
    pub fn law(&self) -> Option<&Py<Law>> {
        self.law.get()
    }

    /// Removes the field; its object stays, and says that it was removed.
    pub fn remove_from(&self, world: &Bound<'_, World>) -> PyResult<()> {
        self.place.check_world(world)?;
        let own = world.get();
        let mut core = own.core(world.py())?;
        let handle = self.place.handle()?;
        let index = core.field_handles().iter().position(|other| *other == handle);
        core.remove_field(handle).map_err(to_py)?;
        self.place.leave();
        let mut objects = own.objects();
        let index = index.filter(|&index| index < objects.fields.len());
        let gone = index.map(|index| objects.fields.swap_remove(index));
        drop(objects);
        drop(core);
        drop(gone);
        Ok(())
    }

    /// Something of the field in the core.
    fn read<T>(
        &self,
        py: Python<'_>,
        read: impl FnOnce(&dyn forces::ForceField) -> T,
    ) -> PyResult<T> {
        let core = self.place.world.get().core(py)?;
        let handle = self.place.handle()?;
        let index = core.field_handles().iter().position(|other| *other == handle);
        let field = index.and_then(|index| core.fields().get(index));
        match field {
            Some(field) => Ok(read(field.as_ref())),
            None => Err(to_py(culbuto::Error::StaleHandle("force field"))),
        }
    }
}

#[pymethods]
impl Field {
    /// Name, for messages and `explain()`.
    #[getter]
    fn name(&self, py: Python<'_>) -> PyResult<String> {
        self.read(py, |field| field.name().to_owned())
    }

    /// The user's function, or the `Central`, `Attraction` or `Oscillating` it is.
    #[getter]
    fn function<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        if let Some(law) = self.law() {
            return Ok(law.get().function.bind(py).clone());
        }
        let found = {
            let world = self.place.world.get();
            let built_in = self.read(py, |field| field.built_in())?;
            built_in.map(|built_in| {
                let body = match &built_in {
                    BuiltInField::Oscillating(field) => world.body(py, field.body),
                    _ => None,
                };
                (built_in, body)
            })
        };
        match found {
            Some((built_in, body)) => to_python(py, built_in, body),
            None => Ok(py.None().into_bound(py)),
        }
    }

    /// The user's potential; None for fields without, and for those that come with the engine.
    #[getter]
    fn potential<'py>(&self, py: Python<'py>) -> Option<Bound<'py, PyAny>> {
        let potential = self.law()?.get().potential.as_ref()?;
        Some(potential.bind(py).clone())
    }

    /// Whether it has a potential; the work of other fields is booked as such.
    #[getter]
    fn conservative(&self, py: Python<'_>) -> PyResult<bool> {
        self.read(py, |field| field.facts().conservative)
    }

    /// Whether the forces depend on velocities.
    #[getter]
    fn velocity_dependent(&self, py: Python<'_>) -> PyResult<bool> {
        self.read(py, |field| field.facts().velocity_dependent)
    }

    /// Whether the forces act between the bodies and sum to zero, torques too.
    #[getter]
    fn internal(&self, py: Python<'_>) -> PyResult<bool> {
        self.read(py, |field| field.facts().internal)
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

    /// Removes the field from its world.
    fn remove(&self, py: Python<'_>) -> PyResult<()> {
        self.remove_from(self.place.world.bind(py))
    }

    fn __repr__(&self, py: Python<'_>) -> String {
        if self.removed() {
            return "<removed Field>".to_owned();
        }
        self.name(py).map_or_else(
            |_| "<Field of a world at work>".to_owned(),
            |name| format!("<Field {name:?}>"),
        )
    }

    fn __reduce__<'py>(slf: &Bound<'py, Self>) -> PyResult<Reduced<'py>> {
        reduced(slf, "field", &slf.get().place)
    }

    fn __traverse__(&self, visit: PyVisit<'_>) -> Result<(), PyTraverseError> {
        self.place.traverse(&visit)?;
        if self.place.made.yes() { visit.call(self.law()) } else { Ok(()) }
    }
}

/// The Python object of a field that comes with the engine. A body that is gone makes it None.
fn to_python(
    py: Python<'_>,
    field: BuiltInField,
    body: Option<Py<Body>>,
) -> PyResult<Bound<'_, PyAny>> {
    Ok(match field {
        BuiltInField::Central(forces::Central { center, strength, exponent, per_mass }) => {
            let central = Central { center: Vec2(center), strength, exponent, per_mass };
            Bound::new(py, central)?.into_any()
        }
        BuiltInField::Attraction(forces::Attraction { strength, exponent, softening }) => {
            Bound::new(py, Attraction { strength, exponent, softening })?.into_any()
        }
        BuiltInField::Oscillating(field) => match body {
            None => py.None().into_bound(py),
            Some(body) => {
                let forces::Oscillating { force, torque, hertz, phase, .. } = field;
                let own = Oscillating { body, force: Vec2(force), torque, hertz, phase };
                Bound::new(py, own)?.into_any()
            }
        },
    })
}

/// A field as an argument: one of the engine's, or none of them.
fn built_in(world: &Bound<'_, World>, field: &Bound<'_, PyAny>) -> PyResult<Option<BuiltInField>> {
    if let Ok(field) = field.cast::<Central>() {
        let Central { center, strength, exponent, per_mass } = *field.get();
        let central = forces::Central { center: center.0, strength, exponent, per_mass };
        return Ok(Some(BuiltInField::Central(central)));
    }
    if let Ok(field) = field.cast::<Attraction>() {
        let Attraction { strength, exponent, softening } = *field.get();
        let attraction = forces::Attraction { strength, exponent, softening };
        return Ok(Some(BuiltInField::Attraction(attraction)));
    }
    if let Ok(field) = field.cast::<Oscillating>() {
        let Oscillating { body, force, torque, hertz, phase } = field.get();
        let place = &body.get().place;
        place.check_world(world)?;
        return Ok(Some(BuiltInField::Oscillating(forces::Oscillating {
            body: place.handle()?,
            force: force.0,
            torque: *torque,
            hertz: *hertz,
            phase: *phase,
        })));
    }
    Ok(None)
}

#[pymethods]
impl World {
    /// Adds a field of force, which acts on all bodies: one of the engine's (`Central`, `Attraction`,
    /// `Oscillating`), or a function of a `State` that returns forces (n, 2) (N), or a tuple of forces and
    /// torques (n,) (N·m).
    ///
    /// `potential` is a function of a `State` that returns the energy (J) whose gradient the forces are;
    /// without it the forces do work. `velocity_dependent=False` saves evaluations where it is true.
    /// `internal=True` says that the forces act between the bodies and sum to zero, torques too.
    #[pyo3(signature = (field, *, potential=None, velocity_dependent=true, internal=false, name=None))]
    #[allow(clippy::too_many_arguments, reason = "one keyword each in Python")]
    fn add_field<'py>(
        slf: &Bound<'py, Self>,
        field: &Bound<'py, PyAny>,
        potential: Option<&Bound<'py, PyAny>>,
        velocity_dependent: bool,
        internal: bool,
        name: Option<String>,
    ) -> PyResult<Bound<'py, Field>> {
        let py = slf.py();
        let (law, shared) = match built_in(slf, field)? {
            Some(built_in) => (None, built_in.build().map_err(to_py)?),
            None => {
                let law = Law::new(field, potential, (velocity_dependent, internal), name)?;
                let law = Bound::new(py, law)?;
                let shared = Law::shared(&law)?;
                (Some(law.unbind()), shared)
            }
        };
        let own = law.is_some();
        let options = potential.is_some() || !velocity_dependent || internal;
        if !own && options {
            return Err(PyTypeError::new_err(
                "a field that comes with the engine knows its potential and its facts itself",
            ));
        }
        let field = Bound::new(py, Field::new(slf, law))?;
        let world = slf.get();
        let mut core = world.core(py)?;
        let handle = Core::add_shared_field(&mut core, shared);
        field.get().place.enter(handle);
        world.objects().fields.push(field.clone().unbind());
        drop(core);
        Ok(field)
    }
}
