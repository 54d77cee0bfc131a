//! Where two colliders touch or will soon: up to two points with one normal.

use serde::{Deserialize, Serialize};

use crate::math::{Real, Vec2, vec2};

/// How the normal of a manifold follows the two bodies as they move. It points from A to B.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub enum Normal {
    /// Fixed in the frame of A: a face of A, and points of B above it.
    OnA(Vec2),
    /// Fixed in the frame of B: a face of B, and points of A above it. Given in the frame of B, and pointing
    /// from A to B as well, which is into B.
    OnB(Vec2),
    /// Along the line from the anchor on A to that on B: between two core points. One point only.
    Between,
    /// Against that line: one anchor is the centre of an arc, the other stands inside it. One point only.
    Inside,
}

/// A pair of points that may touch, one of each core.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Anchor {
    /// In the frame of A's centre of mass (m).
    pub on_a: Vec2,
    /// In the frame of B's centre of mass (m).
    pub on_b: Vec2,
    /// The same features of the same colliders give the same number from step to step.
    pub feature: u32,
}

/// Up to two points where two colliders touch or will soon.
///
/// With a, b the anchors in world coordinates and n the normal, the surfaces touch at a + n·radius_a and
/// b − n·radius_b, and the gap between them is n·(b − a) − radius_a − radius_b, whatever the kind of normal.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Manifold {
    /// The normal.
    pub normal: Normal,
    /// The points; only the first `count` hold.
    pub anchors: [Anchor; 2],
    /// Number of points, 1 or 2.
    pub count: usize,
    /// From A's anchor to its surface, along the normal (m): A's rounding. Of an arc that the other shape
    /// stands inside, minus the arc's radius.
    pub radius_a: Real,
    /// From B's anchor to its surface, against the normal (m), likewise.
    pub radius_b: Real,
    /// For [`Normal::OnA`] and [`Normal::OnB`]: the stretch of the face, along the normal turned by a quarter
    /// turn counter-clockwise, in the frame that holds the normal, from that frame's origin (m).
    pub face: [Real; 2],
}

impl Default for Anchor {
    fn default() -> Self {
        Self { on_a: vec2(0.0, 0.0), on_b: vec2(0.0, 0.0), feature: 0 }
    }
}
