//! Where two colliders touch or will soon.
//!
//! All convex shapes are cores grown by a radius: one point (circles), two (capsules, segments, links of
//! chains) or a polygon. Separation along a face normal and the closest features of two cores both follow
//! from one walk around the border of their Minkowski difference ([`axes::visit`]): its edges are the faces of one
//! core against the vertex of the other that lies deepest along their normal.

mod arc_arc;
mod arc_convex;
mod axes;
mod closest;
mod convex_convex;
mod face;
mod joined;
mod point_point;

use axes::Core;
pub(super) use axes::width;

use super::{Anchor, Frame, Geometry, Manifold, Normal};
use crate::math::{Real, Vec2};

/// Below this fraction of a length two points are one.
const SAME: Real = 1e-9;

/// Manifolds of two colliders whose gap is at most `margin` (m), added to `out`: none, one, or two where an
/// arc is touched in two directions. The frame is that of B's centre of mass seen from A's.
///
/// Apart, the closest features decide; overlapping, the axis of least penetration. Of two faces that lie as
/// deep up to rounding, A's is the reference.
///
/// Returns a gap (m) that the two have at least: −∞ if none is known.
pub fn collide(
    a: &Geometry,
    b: &Geometry,
    b_in_a: &Frame,
    margin: Real,
    out: &mut Vec<Manifold>,
) -> Real {
    match (a, b) {
        (Geometry::Convex(a), Geometry::Convex(b)) => {
            match convex_convex::collide(Core::of(a), Core::of(b), b_in_a, margin) {
                Ok(manifold) => out.push(manifold),
                Err(gap) => return gap,
            }
        }
        (Geometry::Arc(a), Geometry::Convex(b)) => {
            arc_convex::collide(a, Core::of(b), b_in_a, margin).push_to(out, false);
        }
        (Geometry::Convex(a), Geometry::Arc(b)) => {
            arc_convex::collide(b, Core::of(a), &b_in_a.inverse(), margin).push_to(out, true);
        }
        (Geometry::Arc(a), Geometry::Arc(b)) => {
            arc_arc::collide(a, b, b_in_a, margin).push_to(out, false);
        }
    }
    UNKNOWN
}

/// A gap of which nothing is known (m).
const UNKNOWN: Real = Real::NEG_INFINITY;

/// Which collider.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Side {
    A,
    B,
}

impl Side {
    fn other(self) -> Self {
        if self == Self::A { Self::B } else { Self::A }
    }
}

/// The number of a pair of features: a vertex of one side and an edge of the other, whichever of the two is
/// the reference, so that it lasts when that changes.
fn vertex_on_edge(side: Side, vertex: usize, edge: usize) -> u32 {
    let kind = if side == Side::A { 0 } else { 1 };
    feature(kind, vertex, edge)
}

/// The number of a vertex of A and one of B.
fn vertex_on_vertex(a: usize, b: usize) -> u32 {
    feature(2, a, b)
}

/// The number of a pair in which one is an arc or an end of it.
fn on_arc(a: usize, b: usize) -> u32 {
    feature(3, a, b)
}

/// Polygons of more sides share numbers among vertices far apart.
const PLACES: usize = 1 << 15;

/// The first of the two numbers in a feature.
fn first_of(feature: u32) -> usize {
    (feature >> 15) as usize % PLACES
}

/// 2 + 15 + 15 bits.
fn feature(kind: u32, first: usize, second: usize) -> u32 {
    kind << 30 | ((first % PLACES) as u32) << 15 | (second % PLACES) as u32
}

impl Manifold {
    /// One point, without a face.
    fn point(normal: Normal, anchor: Anchor, radii: [Real; 2]) -> Self {
        Self {
            normal,
            anchors: [anchor, Anchor::default()],
            count: 1,
            radius_a: radii[0],
            radius_b: radii[1],
            face: [0.0, 0.0],
        }
    }

    /// The same with A and B exchanged: the normal turns round, and with it the direction along the face.
    fn mirrored(&self) -> Self {
        let normal = match self.normal {
            Normal::OnA(n) => Normal::OnB(-n),
            Normal::OnB(n) => Normal::OnA(-n),
            same => same,
        };
        let mirrored = |anchor: Anchor| Anchor { on_a: anchor.on_b, on_b: anchor.on_a, ..anchor };
        Self {
            normal,
            anchors: self.anchors.map(mirrored),
            count: self.count,
            radius_a: self.radius_b,
            radius_b: self.radius_a,
            face: [-self.face[1], -self.face[0]],
        }
    }
}

/// The unit vector along v; none where it is lost in lengths of this scale.
fn direction(v: Vec2, scale: Real) -> Option<(Vec2, Real)> {
    let length = v.norm();
    (length > SAME * scale).then(|| (v / length, length))
}

/// Up to two manifolds, those of the smallest gaps.
#[derive(Default)]
struct Two {
    found: [Option<(Real, Manifold)>; 2],
}

impl Two {
    fn add(&mut self, gap: Real, manifold: Manifold) {
        let [first, second] = &mut self.found;
        let below = |other: &Option<(Real, Manifold)>| other.is_none_or(|(least, _)| gap < least);
        if below(first) {
            *second = first.replace((gap, manifold));
        } else if below(second) {
            *second = Some((gap, manifold));
        }
    }

    fn push_to(self, out: &mut Vec<Manifold>, mirror: bool) {
        let found = self.found.into_iter().flatten();
        out.extend(found.map(|(_, found)| if mirror { found.mirrored() } else { found }));
    }
}
