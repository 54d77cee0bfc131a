//! What gives way inside, as the contact step sees it: nodes that impulses move through A⁻¹, and points of contact on them.

use super::motion::Velocity;
use crate::body::Friction;
use crate::forces::Ledger;
use crate::math::{Real, Vec2, cross, perp};

/// What a solution took.
#[derive(Clone, Copy, Debug, Default)]
pub struct Effort {
    /// Iterations.
    pub iterations: u64,
    /// Factorisations.
    pub factorisations: u64,
}

/// Matter whose nodes are moved by the contact step, in the order begin, push and settle (as often as contacts ask), finish.
pub trait Matter {
    /// Begins a substep of length h (s): half of the drift.
    fn begin(&mut self, h: Real);

    /// Adds an impulse (N·s) to a node in this substep.
    fn push(&mut self, node: u32, impulse: Vec2);

    /// Goes a step of Newton's method towards the velocities after the substep under the impulses that it has got, which are
    /// answered through the same A⁻¹ as [`Matter::respond`] tells of.
    fn approach(&mut self) -> Effort;

    /// Finds the velocities after the substep under the impulses that it has got.
    fn settle(&mut self) -> Effort;

    /// Place of a node in the middle of the substep (m).
    fn place(&self, node: u32) -> Vec2;

    /// How far from there (m) impulses on a node act on the angular momentum, as last settled: where the step, implicit as it is, has its middle.
    fn lead(&self, node: u32) -> Vec2;

    /// Velocity of a node (m/s) before the substep, and after it as last settled.
    fn velocities(&self, node: u32) -> [Vec2; 2];

    /// The blocks of A⁻¹ between these nodes, row after row, each as [xx, xy, yx, yy] (1/kg).
    fn respond(&mut self, nodes: &[u32], out: &mut Vec<[Real; 4]>);

    /// Energy (J) that it would end with beyond what it had, what was done on it and what pushed it, as last settled: above 0 only where it is
    /// pushed by more than it can follow.
    fn excess(&mut self) -> Real;

    /// Ends the substep: the other half of the drift. Returns what its forces did.
    fn finish(&mut self) -> Ledger;
}

/// What bears at a point of contact.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Side {
    /// A rigid body: its slot, and the point from its centre of mass (m).
    Body(u32, Vec2),
    /// A point between two nodes: the number of the matter, its nodes and their weights.
    Nodes(u32, [u32; 2], [Real; 2]),
}

/// What two surfaces do at a point: remembered from one substep to the next.
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Grip {
    /// Which features of what.
    pub key: [u32; 4],
    /// Impulses along the normal and the tangent (N·s).
    pub impulse: [Real; 2],
    /// Whether it slid.
    pub sliding: bool,
}

/// A point of contact of which one side at least is matter.
#[derive(Clone, Copy, Debug)]
pub struct Point {
    /// A and B.
    pub sides: [Side; 2],
    /// From A to B.
    pub normal: Vec2,
    /// Gap in the middle of the substep (m).
    pub gap: Real,
    /// Length that overlaps are measured against (m).
    pub width: Real,
    /// Coulomb's coefficients.
    pub friction: Friction,
    /// Restitution.
    pub restitution: Real,
    /// Tangential velocity (m/s) of B against A at which nothing slides.
    pub tangent_speed: Real,
    /// What is kept of it.
    pub grip: Grip,
    /// Impulse on B that its matter has got in the substep (N·s).
    pub handed: Vec2,
}

impl Point {
    /// Unit vectors of its rows.
    #[must_use]
    pub fn directions(&self) -> [Vec2; 2] {
        [self.normal, perp(self.normal)]
    }

    /// The impulse on B (N·s).
    #[must_use]
    pub fn impulse(&self) -> Vec2 {
        let [n, t] = self.directions();
        n * self.grip.impulse[0] + t * self.grip.impulse[1]
    }
}

impl Velocity {
    /// Velocity of a point at an arm from the centre of mass (m/s).
    #[must_use]
    pub fn at(&self, arm: Vec2) -> Vec2 {
        self.twist.at(arm)
    }

    /// Gives the body an impulse (N·s) at an arm from its centre of mass.
    pub fn push_at(&mut self, arm: Vec2, impulse: Vec2) {
        self.twist.linear += self.inverse_mass.component_mul(&impulse);
        self.twist.angular += self.inverse_inertia * cross(arm, impulse);
    }
}
