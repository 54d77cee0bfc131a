//! What a step changes of the contacts, kept to go back to if it fails.

use super::{Contacts, Near, Patch};
use crate::collision::BroadPhase;
use crate::math::Real;

/// A copy of what steps change. Columns keep their memory from call to call, so that a warm copy
/// allocates nothing; colliders, filters and roles do not change in a step and are not in it.
#[derive(Clone, Debug, Default)]
pub(in crate::world) struct ContactBackup {
    broad: BroadPhase,
    near: Vec<Near>,
    patches: Vec<Patch>,
    moved: Vec<u32>,
    substep: Real,
}

impl ContactBackup {
    /// Keeps the contacts as they are.
    pub fn save(&mut self, contacts: &mut Contacts) {
        contacts.broad.save_into(&mut self.broad);
        self.near.clone_from(&contacts.near);
        self.patches.clone_from(&contacts.patches);
        self.moved.clone_from(&contacts.moved);
        self.substep = contacts.substep;
    }

    /// Puts the contacts back.
    pub fn restore(&self, contacts: &mut Contacts) {
        contacts.broad.clone_from(&self.broad);
        contacts.near.clone_from(&self.near);
        contacts.patches.clone_from(&self.patches);
        contacts.moved.clone_from(&self.moved);
        contacts.substep = self.substep;
        contacts.map_pairs();
    }
}
