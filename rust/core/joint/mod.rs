//! Joints as the user writes them: what ties two bodies, or a body and the world.
//!
//! What follows for the motion, the rows, stands in `constraints::joint`.

mod custom;
mod def;
mod kind;
mod spring;
mod text;

pub use custom::{Constraint, Custom, CustomRow};
pub use def::{Given, JointDef};
pub use kind::{JointKind, Motor, Travel};
pub use spring::{Coefficients, Hold, Spring};

use serde::{Deserialize, Serialize};

use crate::arena::{Handle, Named};
use crate::math::{Real, Vec2, Wrench};

/// Names a joint of a world.
pub type JointHandle = Handle<Joint>;

impl Named for Joint {
    const NAME: &'static str = "joint";
}

/// Most rows of one joint.
pub const ROWS: usize = 6;

/// A joint of a world.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Joint {
    /// The definition, with all that was left open when the joint was made.
    pub def: JointDef,
    /// Springs of the rows as they were made from frequencies, row by row; none where a row is no spring.
    pub springs: [Option<Coefficients>; ROWS],
    /// Impulses of the rows over the last substep (N·s, N·m·s).
    pub impulses: [Real; ROWS],
    /// Length of that substep (s).
    pub substep: Real,
    /// What the joint did to its second body in the last step, on average: force (N) and torque about the second
    /// anchor (N·m). The first body got the opposite.
    pub reaction: Wrench,
    /// The notch at which a ratchet stands (rad).
    pub notch: Real,
    /// It ties rigid bodies to one another or to the world: no filter, and no joint of matter.
    pub rigid: bool,
    /// Of sides that are points of matter, that.
    pub matter: [Option<MatterEnd>; 2],
    /// The user's own rows, of a custom joint.
    #[serde(skip)]
    pub custom: Option<Custom>,
}

/// An end that is a point of matter, which its anchor follows.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct MatterEnd {
    /// 1/m of all of the matter (1/kg).
    pub inverse_mass: Real,
    /// Velocity of the point (m/s).
    pub velocity: Vec2,
}

impl Joint {
    /// Anchors from the bodies' frames (m); of the world, in its coordinates.
    #[must_use]
    pub fn anchors(&self) -> [Vec2; 2] {
        self.def.anchors.map(|anchor| anchor.vector())
    }
}
