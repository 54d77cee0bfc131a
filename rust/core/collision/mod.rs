//! Which shapes touch, where, and how shapes lie to one another.
//!
//! A shape of a body becomes one or more [`Collider`]s: convex cores grown by a radius, or arcs, in the
//! frame of the body's centre of mass. Nothing here knows of mass, time or forces.

mod broad_phase;
mod cast;
mod collider;
mod core;
mod distance;
mod extent;
mod manifold;
mod narrow_phase;
mod pairs;
mod time_of_impact;
mod tree;

pub use broad_phase::{BroadPhase, ProxyId, TreeQuality};
pub use cast::{Hit, cast_ray, cast_shape};
pub use collider::{Collider, Cone, Convex, Geometry, Joins, WireArc, colliders};
pub use distance::{Closest, contains, distance, distance_to_point, overlap};
pub use manifold::{Anchor, Manifold, Normal};
pub use narrow_phase::collide;
pub use pairs::PairMap;
pub use time_of_impact::{Impact, Sweep, first_impact, time_of_impact};

use crate::math::{Pose, Rot, Vec2, vec2};

/// A frame in another: where its origin stands and how it is turned.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Position of the origin (m).
    pub position: Vec2,
    /// Rotation.
    pub rot: Rot,
}

impl Frame {
    /// The outer frame itself.
    pub const IDENTITY: Self = Self { position: vec2(0.0, 0.0), rot: Rot::IDENTITY };

    /// The frame of a pose.
    #[must_use]
    pub fn of(pose: &Pose) -> Self {
        Self { position: pose.position, rot: pose.rot() }
    }

    /// This frame seen from another. Positions are subtracted first, so that places far from the origin
    /// keep their digits.
    #[must_use]
    pub fn seen_from(&self, other: &Self) -> Self {
        let Rot { cos, sin } = other.rot;
        let rot = Rot {
            cos: cos * self.rot.cos + sin * self.rot.sin,
            sin: cos * self.rot.sin - sin * self.rot.cos,
        };
        Self { position: other.rot.apply_inverse(self.position - other.position), rot }
    }

    /// The outer frame seen from this one.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let rot = Rot { cos: self.rot.cos, sin: -self.rot.sin };
        Self { position: rot.apply(-self.position), rot }
    }

    /// A point of this frame in the outer one.
    #[must_use]
    pub fn apply(&self, local: Vec2) -> Vec2 {
        self.position + self.rot.apply(local)
    }

    /// A point of the outer frame in this one.
    #[must_use]
    pub fn apply_inverse(&self, outer: Vec2) -> Vec2 {
        self.rot.apply_inverse(outer - self.position)
    }
}
