//! Deformable bodies of a world.

mod advance;
mod events;
mod joints;
mod look;
mod queries;
mod touch;

pub(super) use advance::{SoftScratch, members, take_ends};
pub use events::{SoftContact, SoftEvents, Touched};
pub(super) use joints::{follow, keep, ties};
pub use queries::{NearestSoft, SoftFilter, SoftRayHit};

use serde::{Deserialize, Serialize};

use crate::arena::Arena;
use crate::body::{Filter, Surface};
use crate::constraints::matter::Grip;
use crate::error::Result;
use crate::joint::Joint;
use crate::math::{Real, Vec2};
use crate::soft::{Gas, Moving, SoftBody, SoftDef, SoftHandle};
use crate::world::World;
use joints::SoftJoint;

/// The deformable bodies, and what their contacts remember.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct Softs {
    pub bodies: Arena<SoftBody>,
    /// Joints that hold points of them.
    pub joints: Vec<SoftJoint>,
    /// In the order of their keys.
    pub grips: Vec<Grip>,
    /// Length (s) of the substep that their impulses are of.
    pub substep: f64,
    /// What touches.
    pub contacts: Vec<SoftContact>,
    /// What happened during the last call.
    #[serde(skip)]
    pub events: SoftEvents,
}

impl Softs {
    pub fn is_empty(&self) -> bool {
        self.bodies.values().is_empty()
    }

    /// Derives what is not stored.
    pub fn rebuild(&mut self) -> Result<()> {
        self.bodies.values_mut().iter_mut().try_for_each(SoftBody::rebuild)
    }
}

/// How deformable bodies moved, to go back to.
#[derive(Clone, Debug, Default)]
pub(super) struct SoftBackup {
    moving: Vec<Moving>,
    grips: Vec<Grip>,
    substep: f64,
    contacts: Vec<SoftContact>,
}

impl SoftBackup {
    pub fn save(&mut self, softs: &Softs) {
        self.moving.clear();
        self.moving.extend(softs.bodies.values().iter().map(|body| body.moving().clone()));
        self.grips.clone_from(&softs.grips);
        self.substep = softs.substep;
        self.contacts.clone_from(&softs.contacts);
    }

    pub fn restore(&self, softs: &mut Softs, joints: &mut Arena<Joint>) {
        if softs.is_empty() {
            return;
        }
        for (body, moving) in softs.bodies.values_mut().iter_mut().zip(&self.moving) {
            body.go_back(moving);
        }
        softs.grips.clone_from(&self.grips);
        softs.substep = self.substep;
        softs.contacts.clone_from(&self.contacts);
        follow(softs, joints);
    }
}

/// Deformable bodies.
impl World {
    /// Adds a deformable body.
    ///
    /// # Errors
    /// [`crate::Error::Invalid`] names the number that is not allowed; the world stays as it was.
    pub fn add_soft_body(&mut self, def: SoftDef) -> Result<SoftHandle> {
        let body = SoftBody::new(def)?;
        let handle = self.state.softs.bodies.insert(body);
        self.softs_changed();
        Ok(handle)
    }

    /// Removes a deformable body. The last one takes its place in their order.
    ///
    /// # Errors
    /// [`crate::Error::StaleHandle`] for one that is gone.
    pub fn remove_soft_body(&mut self, body: SoftHandle) -> Result<()> {
        self.state.softs.bodies.get(body)?;
        self.unjoin_soft(body);
        self.state.softs.bodies.remove(body)?;
        self.softs_changed();
        Ok(())
    }

    fn softs_changed(&mut self) {
        self.state.softs.grips.clear();
        self.state.softs.events.clear();
        self.plan = None;
        self.wake_all();
    }

    /// A deformable body, to read.
    ///
    /// # Errors
    /// [`crate::Error::StaleHandle`] for one that is gone.
    pub fn soft_body(&self, body: SoftHandle) -> Result<&SoftBody> {
        self.state.softs.bodies.get(body)
    }

    /// The deformable bodies.
    #[must_use]
    pub fn soft_bodies(&self) -> &[SoftBody] {
        self.state.softs.bodies.values()
    }

    /// Their handles, in the same order.
    #[must_use]
    pub fn soft_handles(&self) -> &[SoftHandle] {
        self.state.softs.bodies.handles()
    }

    /// Sets the places of the nodes of a deformable body (m).
    ///
    /// # Errors
    /// A body that is gone, another number of nodes, places that are not finite.
    pub fn set_soft_positions(&mut self, body: SoftHandle, positions: &[Vec2]) -> Result<()> {
        self.change_soft(body, |body| body.set_positions(positions))
    }

    /// Sets the velocities of the nodes of a deformable body (m/s); those that are pinned stay at rest.
    ///
    /// # Errors
    /// A body that is gone, another number of nodes, velocities that are not finite.
    pub fn set_soft_velocities(&mut self, body: SoftHandle, velocities: &[Vec2]) -> Result<()> {
        self.change_soft(body, |body| body.set_velocities(velocities))
    }

    /// Sets constant forces on the nodes of a deformable body (N).
    ///
    /// # Errors
    /// A body that is gone, another number of nodes, forces that are not finite.
    pub fn set_soft_forces(&mut self, body: SoftHandle, forces: &[Vec2]) -> Result<()> {
        self.change_soft(body, |body| body.set_forces(forces))
    }

    /// Sets how a deformable body has yielded.
    ///
    /// # Errors
    /// A body that is gone, another number of points, what is not finite.
    pub(crate) fn set_soft_flow(&mut self, body: SoftHandle, flow: &[[Real; 4]]) -> Result<()> {
        self.change_soft(body, |body| body.set_flow(flow))
    }

    /// Sets what a deformable body is like to touch.
    ///
    /// # Errors
    /// A body that is gone, coefficients that are not allowed.
    pub fn set_soft_surface(&mut self, body: SoftHandle, surface: Surface) -> Result<()> {
        surface.validated()?;
        self.change_soft(body, |body| {
            body.set_surface(surface);
            Ok(())
        })
    }

    /// Sets what a deformable body touches.
    ///
    /// # Errors
    /// A body that is gone.
    pub fn set_soft_filter(&mut self, body: SoftHandle, filter: Filter) -> Result<()> {
        self.change_soft(body, |body| {
            body.set_filter(filter);
            Ok(())
        })
    }

    /// Fixes a node of a deformable body where it is, or lets it go.
    ///
    /// # Errors
    /// A body that is gone, a node that is not there.
    pub fn pin_soft_node(&mut self, body: SoftHandle, node: u32, on: bool) -> Result<()> {
        self.change_soft(body, |body| body.set_pinned(node, on))
    }

    /// Sets the gas in a closed rope; none: it is pricked.
    ///
    /// # Errors
    /// A body that is gone or is no closed rope, numbers that are not allowed.
    pub fn set_soft_gas(&mut self, body: SoftHandle, gas: Option<Gas>) -> Result<()> {
        self.change_soft(body, |body| body.set_gas(gas))
    }

    fn change_soft(
        &mut self,
        body: SoftHandle,
        change: impl FnOnce(&mut SoftBody) -> Result<()>,
    ) -> Result<()> {
        change(self.state.softs.bodies.get_mut(body)?)?;
        follow(&self.state.softs, &mut self.state.joints);
        self.wake_all();
        Ok(())
    }
}
