//! Objects made of bodies and joints: ropes, chains, bridges, ragdolls, vehicles, lattices of springs.
//!
//! Each is a small definition; `build` adds it to a world and gives the handles, which are those of ordinary bodies and
//! joints. A `build` that fails leaves the world as it was.
//!
//! ```
//! use culbuto::builders::{End, RopeDef};
//! use culbuto::{World, math::vec2};
//!
//! let mut world = World::new(vec2(0.0, -9.81))?;
//! let ends = [End::World(vec2(0.0, 2.0)), End::World(vec2(3.0, 2.0))];
//! let rope = RopeDef { length: Some(4.0), mass_per_length: 0.2, ..RopeDef::new(ends) };
//! let rope = rope.build(&mut world)?;
//! world.steps(1.0 / 60.0, 60)?;
//! assert!((rope.mass(&world)? - 0.8).abs() < 1e-12);
//! assert!(rope.gap(&world) < 1e-9);
//! # Ok::<(), culbuto::Error>(())
//! ```

mod bridge;
mod cells;
mod chain;
mod lattice;
mod line;
mod plan;
mod ragdoll;
mod rope;
mod vehicle;

pub use bridge::BridgeDef;
pub use chain::ChainDef;
pub use lattice::{Elasticity, Lattice, LatticeDef, Moduli, Pattern};
pub use line::End;
pub use ragdoll::{Bone, Ragdoll, RagdollDef};
pub use rope::{RopeDef, RopeForm};
pub use vehicle::{Vehicle, VehicleDef};

use crate::body::BodyHandle;
use crate::error::Result;
use crate::joint::JointHandle;
use crate::math::{Real, Vec2};
use crate::world::World;

/// What a builder added.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Assembly {
    /// Its bodies, in the order along the object.
    pub bodies: Vec<BodyHandle>,
    /// Its joints, likewise.
    pub joints: Vec<JointHandle>,
}

impl Assembly {
    /// Sum of the masses (kg).
    ///
    /// # Errors
    /// [`crate::Error::StaleHandle`] if one of the bodies is gone.
    pub fn mass(&self, world: &World) -> Result<Real> {
        self.bodies.iter().map(|body| Ok(world.body(*body)?.mass().mass)).sum()
    }

    /// Common centre of mass (m).
    ///
    /// # Errors
    /// [`crate::Error::StaleHandle`] if one of the bodies is gone.
    pub fn center_of_mass(&self, world: &World) -> Result<Vec2> {
        let mut moment = Vec2::zeros();
        for body in &self.bodies {
            let body = world.body(*body)?;
            moment += body.center_of_mass() * body.mass().mass;
        }
        Ok(moment / self.mass(world)?)
    }

    /// How far its joints are from what they hold: the largest [`crate::world::JointRef::gap`] of those that are left
    /// (m, or rad where a joint holds an angle).
    #[must_use]
    pub fn gap(&self, world: &World) -> Real {
        self.joints
            .iter()
            .filter_map(|joint| world.joint(*joint).ok())
            .map(|joint| joint.gap())
            .fold(0.0, Real::max)
    }

    /// Takes what is left of it out of the world, joints included.
    pub fn remove(&self, world: &mut World) {
        for joint in self.joints.iter().rev() {
            // What broke is gone already.
            let _ = world.remove_joint(*joint);
        }
        for body in self.bodies.iter().rev() {
            // And so is what the user removed.
            let _ = world.remove_body(*body);
        }
    }
}
