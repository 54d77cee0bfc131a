//! A world that the engine made, as a World of Python: an object for each of its bodies, fields and schedules.

use culbuto::World as Core;
use culbuto::arena::{Handle, Named};
use pyo3::prelude::*;

use crate::body::Body;
use crate::field::Field;
use crate::parts::Place;
use crate::schedule::Schedule;
use crate::world::{Objects, World};

impl World {
    /// A world of Python around one of the core, whose fields all come with the engine.
    pub fn adopt(py: Python<'_>, core: Core) -> PyResult<Bound<'_, Self>> {
        let bodies = core.bodies().handles().to_vec();
        let fields = core.field_handles().to_vec();
        let schedules = core.schedule_handles().to_vec();
        let world = Bound::new(py, Self::from_core(core))?;
        let adopted = Objects {
            bodies: each(&bodies, |handle| Py::new(py, Body { place: place(&world, handle) }))?,
            fields: each(&fields, |handle| {
                Py::new(py, Field { place: place(&world, handle), law: None })
            })?,
            schedules: each(&schedules, |handle| {
                Py::new(py, Schedule { place: place(&world, handle) })
            })?,
        };
        *world.get().objects() = adopted;
        Ok(world)
    }
}

fn each<T, U>(handles: &[Handle<T>], make: impl Fn(Handle<T>) -> PyResult<U>) -> PyResult<Vec<U>> {
    handles.iter().map(|handle| make(*handle)).collect()
}

fn place<T: Named>(world: &Bound<'_, World>, handle: Handle<T>) -> Place<T> {
    let place = Place::new(world);
    place.enter(handle);
    place
}
