//! What the Python objects of bodies, fields and schedules have in common: they belong to a world, and
//! may be removed from it.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use culbuto::arena::{Handle, Named};
use pyo3::gc::{PyTraverseError, PyVisit};
use pyo3::prelude::*;

use crate::error::StaleHandleError;
use crate::world::World;

/// Whether an object has its contents yet.
///
/// CPython 3.11 makes the `__dict__` of an object between allocating it and PyO3's filling it. If that sets off the
/// garbage collector, `__traverse__` sees zeros where the contents will be, and must look no further.
pub struct Made(AtomicBool);

impl Default for Made {
    /// To be part of the contents.
    fn default() -> Self {
        Self(AtomicBool::new(true))
    }
}

impl Made {
    /// Whether the contents are there.
    pub fn yes(&self) -> bool {
        self.0.load(Ordering::Relaxed)
    }
}

/// What `__reduce__` gives: a function, its arguments, and the attributes of the user's own.
pub type Reduced<'py> = (Bound<'py, PyAny>, (Py<World>,), Bound<'py, PyAny>);

/// How a part of a world is pickled and copied: as what its world finds in its slot.
pub fn reduced<'py, T: Named>(
    part: &Bound<'py, PyAny>,
    kind: &str,
    place: &Place<T>,
) -> PyResult<Reduced<'py>> {
    let py = part.py();
    let slot = place.known().filter(|_| place.is_alive()).map(Handle::slot);
    let caller = py.import("operator")?.getattr("methodcaller")?.call1(("_part", kind, slot))?;
    Ok((caller, (place.world.clone_ref(py),), part.getattr("__dict__")?))
}

/// A place in a world. The world's objects and its core are in step: a place is alive exactly while the
/// world holds the object it belongs to, so a handle that is used again never finds another thing.
pub struct Place<T> {
    /// See [`Made`].
    pub made: Made,
    /// The world it is, or was, in.
    pub world: Py<World>,
    handle: OnceLock<Handle<T>>,
    alive: AtomicBool,
}

impl<T: Named> Place<T> {
    /// A place that is yet to be given.
    pub fn new(world: &Bound<'_, World>) -> Self {
        Self {
            made: Made::default(),
            world: world.clone().unbind(),
            handle: OnceLock::new(),
            alive: AtomicBool::new(false),
        }
    }

    /// Puts the object into its world, for the first time or again. A second handle is refused: an object
    /// stands for one thing. Called with the core locked.
    pub fn enter(&self, handle: Handle<T>) {
        self.alive.store(*self.handle.get_or_init(|| handle) == handle, Ordering::Relaxed);
    }

    /// Takes the object out of its world. Called with the core locked.
    pub fn leave(&self) {
        self.alive.store(false, Ordering::Relaxed);
    }

    /// Whether the thing is in its world.
    pub fn is_alive(&self) -> bool {
        self.alive.load(Ordering::Relaxed)
    }

    /// The handle it has or had.
    pub fn known(&self) -> Option<Handle<T>> {
        self.handle.get().copied()
    }

    /// The slot it has or had.
    pub fn slot(&self) -> Option<usize> {
        self.known().map(Handle::slot)
    }

    /// The handle, if the thing is still there. Asked with the core locked, it stays there.
    #[inline]
    pub fn handle(&self) -> PyResult<Handle<T>> {
        match self.handle.get() {
            Some(handle) if self.is_alive() => Ok(*handle),
            _ => Err(StaleHandleError::new_err(format!(
                "this {} is no longer in its world: it was removed",
                T::NAME
            ))),
        }
    }

    /// An error unless the thing is of this world.
    pub fn check_world(&self, world: &Bound<'_, World>) -> PyResult<()> {
        if self.world.is(world) {
            return Ok(());
        }
        let message = format!("this {} belongs to another world", T::NAME);
        Err(StaleHandleError::new_err(message))
    }

    /// Shows the garbage collector the way to the world.
    pub fn traverse(&self, visit: &PyVisit<'_>) -> Result<(), PyTraverseError> {
        if self.made.yes() { visit.call(&self.world) } else { Ok(()) }
    }

    /// Whether the thing is in this world.
    pub fn lives_in(&self, world: &Bound<'_, World>) -> bool {
        self.world.is(world) && self.is_alive()
    }
}
