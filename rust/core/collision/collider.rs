//! What the narrow phase sees of a shape.

mod chain;
mod pieces;

use std::f64::consts::PI;

use serde::{Deserialize, Serialize};

use super::narrow_phase::width;
use crate::body::Part;
use crate::math::{Real, Rot, Vec2, cross, perp, vec2};
use crate::shapes::{Shape, ShapeDef};

/// A piece of a shape, in the frame of its body's centre of mass.
#[derive(Clone, Debug, Serialize, Deserialize)]
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
#[derive(Clone, Debug, Serialize, Deserialize)]
pub enum Geometry {
    /// All points within a radius of a convex core.
    Convex(Convex),
    /// A circular wire.
    Arc(WireArc),
}

/// A convex core, counter-clockwise, and the radius it is grown by.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Convex {
    /// One point, two, or a polygon (m).
    pub vertices: Box<[Vec2]>,
    /// Outward unit normal of each edge, from vertex i to the next; two for a core of two points, none for one.
    pub normals: Box<[Vec2]>,
    /// Radius (m).
    pub radius: Real,
    /// Of a link of a chain or a piece of a polygon: what its neighbours leave it. None: all is free.
    pub joins: Option<Box<Joins>>,
}

/// Where a piece is joined to others of its shape, so that nothing catches on what is no corner of the whole.
///
/// The normals under which a shape can be touched at a vertex are those between the normals of the two edges
/// that meet there (its Gauss image); at an inner corner there are none.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Joins {
    /// For each edge: whether it belongs to the border of the whole. Cuts between pieces do not.
    pub outer: Box<[bool]>,
    /// For each vertex: the normals under which it can be touched, if any.
    pub cones: Box<[Option<Cone>]>,
    /// Whether only what has its centre beyond an outer edge is touched at all: a chain with one side.
    pub one_sided: bool,
}

/// The directions counter-clockwise from one unit vector to another, at most half a turn.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Cone {
    /// First direction.
    pub from: Vec2,
    /// Last direction.
    pub to: Vec2,
}

/// A circular wire, counter-clockwise from `from` to `to`, which are unit vectors.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
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

impl Convex {
    /// A core and the radius around it, joined to nothing.
    #[must_use]
    pub fn new(vertices: Vec<Vec2>, radius: Real) -> Self {
        let n = vertices.len();
        let edges = if n > 1 { n } else { 0 };
        let normal = |i: usize| -perp((vertices[(i + 1) % n] - vertices[i]).normalize());
        let normals = (0..edges).map(normal).collect();
        Self { vertices: vertices.into(), normals, radius, joins: None }
    }

    /// The smallest width (m), or the length of a wire.
    fn width(&self) -> Real {
        match *self.vertices {
            [a, b] if self.radius == 0.0 => (b - a).norm(),
            [_] | [_, _] => 2.0 * self.radius,
            _ => width(self) + 2.0 * self.radius,
        }
    }

    fn reach(&self) -> Real {
        self.vertices.iter().map(Vec2::norm_squared).fold(0.0, Real::max).sqrt() + self.radius
    }
}

impl Cone {
    /// Whether a unit vector lies in the cone, up to this sine of an angle.
    #[must_use]
    pub fn holds(&self, direction: Vec2, slack: Real) -> bool {
        cross(self.from, direction) >= -slack
            && cross(direction, self.to) >= -slack
            && direction.dot(&(self.from + self.to)) >= -slack
    }
}

impl WireArc {
    /// The wire of this signed sweep (rad, up to ±2π) from the direction `start` on.
    #[must_use]
    pub fn new(center: Vec2, radius: Real, start: Real, sweep: Real) -> Self {
        let unit = |angle: Real| Rot::new(angle).apply(vec2(1.0, 0.0));
        let (first, last) = (unit(start), unit(start + sweep));
        let (from, to) = if sweep < 0.0 { (last, first) } else { (first, last) };
        Self { center, radius, from, to, sweep: sweep.abs() }
    }

    /// Whether the wire goes all the way round.
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.sweep >= 2.0 * PI
    }

    /// Whether the ray from the centre along `direction` meets the wire.
    #[must_use]
    pub fn includes(&self, direction: Vec2) -> bool {
        let after = cross(self.from, direction);
        let before = cross(direction, self.to);
        if self.sweep <= PI {
            // Opposite a short wire both products vanish in rounding as well.
            let ahead = direction.dot(&self.from) >= 0.0 || direction.dot(&self.to) >= 0.0;
            return after >= 0.0 && before >= 0.0 && ahead;
        }
        self.is_closed() || after >= 0.0 || before >= 0.0
    }

    fn reach(&self) -> Real {
        if self.includes(self.center) {
            return self.center.norm() + self.radius;
        }
        let end = |direction: Vec2| (self.center + direction * self.radius).norm();
        end(self.from).max(end(self.to))
    }
}

/// What the narrow phase sees of a body's shapes, about its centre of mass (in the frame of the shapes, m).
///
/// Concave polygons come in their convex pieces, chains in their links; all else as one collider.
#[must_use]
pub fn colliders(body: u32, parts: &[Part], center: Vec2) -> Vec<Collider> {
    let of_part = |(index, part): (usize, &Part)| {
        let geometries = geometries(&part.shape, center);
        geometries.into_iter().map(move |geometry| Collider::new(body, index as u32, geometry))
    };
    parts.iter().enumerate().flat_map(of_part).collect()
}

impl Collider {
    /// Whether it is a disk.
    #[must_use]
    pub fn is_round(&self) -> bool {
        matches!(&self.geometry, Geometry::Convex(convex) if convex.vertices.len() == 1)
    }

    /// A piece of a shape of a body.
    #[must_use]
    pub fn new(body: u32, part: u32, geometry: Geometry) -> Self {
        let (width, reach) = match &geometry {
            Geometry::Convex(convex) => (convex.width(), convex.reach()),
            Geometry::Arc(arc) => (arc.radius * arc.sweep, arc.reach()),
        };
        Self { body, part, geometry, width, reach }
    }
}

fn geometries(shape: &Shape, center: Vec2) -> Vec<Geometry> {
    match *shape.def() {
        ShapeDef::Arc { center: own, radius, start, sweep } => {
            vec![Geometry::Arc(WireArc::new(own - center, radius, start, sweep))]
        }
        ShapeDef::Polygon { ref vertices, ref holes, .. } if shape.convex_pieces().len() > 1 => {
            let rings = std::iter::once(vertices).chain(holes);
            let pieces = pieces::joined(rings, shape.convex_pieces(), center);
            pieces.into_iter().map(Geometry::Convex).collect()
        }
        ShapeDef::Chain { ref points, closed, one_sided } => {
            let points: Vec<Vec2> = points.iter().map(|p| p - center).collect();
            let links = chain::links(&points, closed, one_sided);
            links.into_iter().map(Geometry::Convex).collect()
        }
        _ => {
            let (core, radius) = shape.core_about(center);
            vec![Geometry::Convex(Convex::new(core, radius))]
        }
    }
}
