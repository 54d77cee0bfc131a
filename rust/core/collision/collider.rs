//! What the narrow phase sees of a shape.

use crate::math::{Real, Vec2};

/// A piece of a shape, in the frame of its body's centre of mass.
#[derive(Clone, Debug)]
pub struct Collider {
    /// Place of the body in body order.
    pub body: u32,
    /// Which of the body's shapes.
    pub part: u32,
    /// What it looks like.
    pub geometry: Geometry,
    /// Smallest width (m); of a wire, its length. Slops and margins are relative to it.
    pub width: Real,
    /// Largest distance from the centre of mass (m).
    pub reach: Real,
}

/// What a collider looks like.
#[derive(Clone, Debug)]
pub enum Geometry {
    /// All points within a radius of a convex core.
    Convex(Convex),
    /// A circular wire.
    Arc(WireArc),
}

/// A convex core, counter-clockwise, and the radius it is grown by.
#[derive(Clone, Debug)]
pub struct Convex {
    /// One point, two, or a polygon (m).
    pub vertices: Box<[Vec2]>,
    /// Outward unit normal of each edge, from vertex i to the next; two for a core of two points, none for one.
    pub normals: Box<[Vec2]>,
    /// Radius (m).
    pub radius: Real,
}

/// A circular wire, counter-clockwise from `from` to `to`, which are unit vectors.
#[derive(Clone, Copy, Debug)]
pub struct WireArc {
    /// Of its circle (m).
    pub center: Vec2,
    /// Of its circle (m).
    pub radius: Real,
    /// Direction of its first point.
    pub from: Vec2,
    /// Direction of its last point.
    pub to: Vec2,
    /// Angle between the two (rad), up to 2π.
    pub sweep: Real,
}
