//! Handles that outlive what they name: dense storage, generational handles, stale handles are errors.
//!
//! [`HandleMap`] gives each item a place in dense columns and a [`Handle`] that stays valid while
//! items come and go; [`Arena`] is the map with one column of values.

use std::fmt;
use std::hash::{Hash, Hasher};
use std::marker::PhantomData;

use serde::{Deserialize, Serialize};

use crate::error::{Error, Result};

/// What a handle names, in the words of an error message.
pub trait Named {
    /// "body", "joint", …
    const NAME: &'static str;
}

/// Names an item of kind `T`. Copyable, hashable; an error, not another item, once the item is gone.
#[derive(Serialize, Deserialize)]
#[serde(bound = "")]
pub struct Handle<T> {
    slot: u32,
    generation: u32,
    #[serde(skip)]
    kind: PhantomData<fn() -> T>,
}

impl<T> Handle<T> {
    const fn new(slot: u32, generation: u32) -> Self {
        Self { slot, generation, kind: PhantomData }
    }

    /// The slot: small, stable while the item lives, reused afterwards. For tables beside the world.
    #[must_use]
    pub const fn slot(self) -> usize {
        self.slot as usize
    }
}

impl<T> Clone for Handle<T> {
    fn clone(&self) -> Self {
        *self
    }
}
impl<T> Copy for Handle<T> {}
impl<T> PartialEq for Handle<T> {
    fn eq(&self, other: &Self) -> bool {
        (self.slot, self.generation) == (other.slot, other.generation)
    }
}
impl<T> Eq for Handle<T> {}
impl<T> Hash for Handle<T> {
    fn hash<H: Hasher>(&self, state: &mut H) {
        (self.slot, self.generation).hash(state);
    }
}
impl<T> fmt::Debug for Handle<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "#{}.{}", self.slot, self.generation)
    }
}

/// One slot: its generation, and the dense index of the item that holds it (none: the slot is free).
#[derive(Clone, Debug, Serialize, Deserialize)]
struct Slot {
    generation: u32,
    dense: Option<u32>,
}

/// Keeps handles in step with dense columns. On removal the last item takes the freed place
/// (`swap_remove`), so the columns stay dense and removal costs the same however many items there are.
#[derive(Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub struct HandleMap<T> {
    slots: Vec<Slot>,
    free: Vec<u32>,
    dense: Vec<Handle<T>>,
}

impl<T> Clone for HandleMap<T> {
    fn clone(&self) -> Self {
        Self { slots: self.slots.clone(), free: self.free.clone(), dense: self.dense.clone() }
    }
}

impl<T> Default for HandleMap<T> {
    fn default() -> Self {
        Self { slots: Vec::new(), free: Vec::new(), dense: Vec::new() }
    }
}

impl<T: Named> HandleMap<T> {
    /// Number of items.
    #[must_use]
    pub fn len(&self) -> usize {
        self.dense.len()
    }

    /// Whether there is no item.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.dense.is_empty()
    }

    /// Handles in dense order.
    #[must_use]
    pub fn handles(&self) -> &[Handle<T>] {
        &self.dense
    }

    /// Makes a handle for the item that is pushed at the end of the columns.
    pub fn insert(&mut self) -> Handle<T> {
        let dense = Some(self.dense.len() as u32);
        let handle = if let Some(slot) = self.free.pop() {
            let entry = &mut self.slots[slot as usize];
            entry.dense = dense;
            Handle::new(slot, entry.generation)
        } else {
            self.slots.push(Slot { generation: 0, dense });
            Handle::new(self.slots.len() as u32 - 1, 0)
        };
        self.dense.push(handle);
        handle
    }

    /// Dense index of the item, or an error if it is gone.
    pub fn index(&self, handle: Handle<T>) -> Result<usize> {
        match self.slots.get(handle.slot()) {
            Some(Slot { generation, dense: Some(dense) }) if *generation == handle.generation => {
                Ok(*dense as usize)
            }
            _ => Err(Error::StaleHandle(T::NAME)),
        }
    }

    /// Forgets the item and returns the dense index to `swap_remove` from every column.
    pub fn remove(&mut self, handle: Handle<T>) -> Result<usize> {
        let index = self.index(handle)?;
        self.dense.swap_remove(index);
        if let Some(moved) = self.dense.get(index) {
            self.slots[moved.slot()].dense = Some(index as u32);
        }
        let slot = &mut self.slots[handle.slot()];
        slot.dense = None;
        slot.generation = slot.generation.wrapping_add(1);
        self.free.push(handle.slot);
        Ok(index)
    }
}

/// Dense values with generational handles.
#[derive(Clone, Debug, Serialize, Deserialize)]
#[serde(bound(serialize = "T: Serialize", deserialize = "T: Deserialize<'de>"))]
pub struct Arena<T> {
    map: HandleMap<T>,
    values: Vec<T>,
}

impl<T> Default for Arena<T> {
    fn default() -> Self {
        Self { map: HandleMap::default(), values: Vec::new() }
    }
}

impl<T: Named> Arena<T> {
    /// Adds a value.
    pub fn insert(&mut self, value: T) -> Handle<T> {
        self.values.push(value);
        self.map.insert()
    }

    /// Removes and returns a value.
    pub fn remove(&mut self, handle: Handle<T>) -> Result<T> {
        Ok(self.values.swap_remove(self.map.remove(handle)?))
    }

    /// The value, or an error if it is gone.
    pub fn get(&self, handle: Handle<T>) -> Result<&T> {
        Ok(&self.values[self.map.index(handle)?])
    }

    /// The value, or an error if it is gone.
    pub fn get_mut(&mut self, handle: Handle<T>) -> Result<&mut T> {
        Ok(&mut self.values[self.map.index(handle)?])
    }

    /// Place of a value in [`Arena::values`], or an error if it is gone.
    pub fn index(&self, handle: Handle<T>) -> Result<usize> {
        self.map.index(handle)
    }

    /// All values, densely.
    #[must_use]
    pub fn values(&self) -> &[T] {
        &self.values
    }

    /// All values, to change.
    pub fn values_mut(&mut self) -> &mut [T] {
        &mut self.values
    }

    /// Handles in the order of [`Arena::values`].
    #[must_use]
    pub fn handles(&self) -> &[Handle<T>] {
        self.map.handles()
    }

    /// Removes every value for which `keep` is false.
    pub fn retain(&mut self, mut keep: impl FnMut(&T) -> bool) {
        let gone: Vec<_> = self
            .handles()
            .iter()
            .zip(&self.values)
            .filter(|(_, value)| !keep(value))
            .map(|(handle, _)| *handle)
            .collect();
        for handle in gone {
            // OK because the handle was read from this arena a moment ago and removed only once.
            let _ = self.remove(handle);
        }
    }
}
