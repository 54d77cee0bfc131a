//! What the Python objects of bodies, fields and schedules have in common: they belong to a world, and
//! may be removed from it.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use culbuto::arena::{Handle, Named};
use pyo3::prelude::*;

use crate::error::StaleHandleError;
use crate::world::World;

/// A place in a world. The world's objects and its core are in step: a place is alive exactly while the
/// world holds the object it belongs to, so a handle that is used again never finds another thing.
pub struct Place<T> {
    pub world: Py<World>,
    handle: OnceLock<Handle<T>>,
    alive: AtomicBool,
}

impl<T: Named> Place<T> {
    /// A place that is yet to be given.
    pub fn new(world: &Bound<'_, World>) -> Self {
        Self {
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

    pub fn is_alive(&self) -> bool {
        self.alive.load(Ordering::Relaxed)
    }

    /// The handle it has or had.
    pub fn known(&self) -> Option<Handle<T>> {
        self.handle.get().copied()
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

    pub fn lives_in(&self, world: &Bound<'_, World>) -> bool {
        self.world.is(world) && self.is_alive()
    }
}
