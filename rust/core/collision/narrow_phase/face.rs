//! Points of one core above a face of the other.

use super::super::{Anchor, Frame, Manifold, Normal};
use super::axes::{Axis, Core};
use super::{SAME, Side, vertex_on_edge};
use crate::math::{Real, Vec2, perp};

/// An edge this much turned against the face (cosine) has one point above it that counts, not two.
const STEEP: Real = std::f64::consts::FRAC_1_SQRT_2;

/// A face of the core on `side`, and the other core as it is seen from there.
#[derive(Clone, Copy)]
pub(super) struct Face<'a> {
    pub side: Side,
    pub reference: Core<'a>,
    pub other: Core<'a>,
    pub frame: &'a Frame,
    pub axis: Axis,
}

/// Points of the other core above the face, the stretch of the face, and whether it holds any of them.
pub(super) struct Above {
    points: [Point; 2],
    count: usize,
    stretch: [Real; 2],
    /// The other core's edge ends before the face begins: what stands here is its deepest vertex.
    pub beside: bool,
    /// The other core's edge and the face share next to nothing of their lengths.
    pub grazes: bool,
}

/// Part of an edge's length that is next to nothing: twice what overlap is left alone.
const GRAZE: Real = 1e-3;

/// A point of the other core: along the face, above it, in its own frame, and its feature.
#[derive(Clone, Copy)]
struct Point {
    along: Real,
    height: Real,
    local: Vec2,
    feature: u32,
}

impl Face<'_> {
    /// The other core's edge that faces this face most, clipped to it.
    pub fn above(&self) -> Above {
        let Self { reference, other, axis: Axis { face, vertex, separation }, .. } = *self;
        let normal = reference.normals[face];
        let along = perp(normal);
        let begin = reference.vertices[face];
        let end = reference.vertices[reference.after(face)];
        let stretch = [along.dot(&begin), along.dot(&end)];
        let point = |vertex: usize| {
            let local = other.vertices[vertex];
            let place = self.frame.apply(local);
            let feature = vertex_on_edge(self.side.other(), vertex, face);
            let height = normal.dot(&(place - begin));
            Point { along: along.dot(&place), height, local, feature }
        };
        let deepest = Point { height: separation, ..point(vertex) };
        let is_beside = |p: &Point| p.along < stretch[0] || p.along > stretch[1];
        let beside = is_beside(&deepest);
        let single = Above { points: [deepest; 2], count: 1, stretch, beside, grazes: false };
        let Some((edge, neighbour)) = self.incident(normal) else { return single };
        let far = point(neighbour);
        let clip = |p: Point, q: Point| self.clipped(edge, p, q, stretch);
        let (Some(near), Some(far_end)) = (clip(deepest, far), clip(far, deepest)) else {
            return Above { beside: true, ..single };
        };
        let shortest = (far.along - deepest.along).abs().min(stretch[1] - stretch[0]);
        let shared = (near.along - far_end.along).abs();
        Above {
            points: [near, far_end],
            count: if shared > SAME * shortest { 2 } else { 1 },
            stretch,
            beside: false,
            grazes: shared <= GRAZE * shortest,
        }
    }

    /// The edge at the deepest vertex that faces the face most, and its other end.
    fn incident(&self, normal: Vec2) -> Option<(usize, usize)> {
        if self.other.vertices.len() < 2 {
            return None;
        }
        let down = self.frame.rot.apply_inverse(normal);
        let vertex = self.axis.vertex;
        let before = self.other.before(vertex);
        let facing = |edge: usize| -down.dot(&self.other.normals[edge]);
        let after = self.other.after(vertex);
        let (edge, end) =
            if facing(vertex) >= facing(before) { (vertex, after) } else { (before, before) };
        (facing(edge) >= STEEP).then_some((edge, end))
    }

    /// p moved towards q until it lies above the face; none if the way from p to q misses it.
    fn clipped(&self, edge: usize, p: Point, q: Point, [low, high]: [Real; 2]) -> Option<Point> {
        let face = self.axis.face;
        let (limit, corner) = if p.along < low {
            (low, face)
        } else if p.along > high {
            (high, self.reference.after(face))
        } else {
            return Some(p);
        };
        let part = (limit - p.along) / (q.along - p.along);
        // The way may also lead off, or p and q be one.
        (0.0..=1.0).contains(&part).then(|| Point {
            along: limit,
            height: p.height + (q.height - p.height) * part,
            local: p.local + (q.local - p.local) * part,
            feature: vertex_on_edge(self.side, corner, edge),
        })
    }
}

impl Above {
    /// Height of the lowest point (m).
    pub fn lowest(&self) -> Real {
        self.points[..self.count].iter().map(|p| p.height).fold(Real::INFINITY, Real::min)
    }

    /// The manifold of those points whose gap is at most `margin` and whose height is at least `floor`.
    pub fn manifold(&self, face: &Face<'_>, margin: Real, floor: Real) -> Option<Manifold> {
        let Face { side, reference, other, axis, .. } = *face;
        let normal = reference.normals[axis.face];
        let (begin, along) = (reference.vertices[axis.face], perp(normal));
        let mut anchors = [Anchor::default(); 2];
        let mut count = 0;
        let highest = margin + reference.radius + other.radius;
        for point in &self.points[..self.count] {
            if point.height > highest || point.height < floor {
                continue;
            }
            let foot = begin + along * (point.along - self.stretch[0]);
            anchors[count] = Anchor { on_a: foot, on_b: point.local, feature: point.feature };
            count += 1;
        }
        let manifold = Manifold {
            normal: Normal::OnA(normal),
            anchors,
            count,
            radius_a: reference.radius,
            radius_b: other.radius,
            face: self.stretch,
        };
        let oriented = if side == Side::A { manifold } else { manifold.mirrored() };
        (count > 0).then_some(oriented)
    }
}
