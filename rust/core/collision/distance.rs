//! How far two shapes are apart, and where they are nearest.
//!
//! Cores are small polygons, so that every vertex is held against every edge: exact up to rounding, and
//! without iteration.

use super::core::{Core, arc_in, edges, ends, faces, highest, point_to_arc, point_to_convex};
use super::{Convex, Frame, Geometry, WireArc};
use crate::math::{Real, Vec2, perp, vec2};

/// Where two shapes are nearest to one another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Closest {
    /// Distance (m). Below 0 where they overlap: of two convex shapes, minus the least motion along the normal
    /// that parts them; of an arc that crosses a convex core, minus the radius of that.
    pub distance: Real,
    /// Point on the surface of A (m).
    pub on_a: Vec2,
    /// Point on the surface of B (m).
    pub on_b: Vec2,
    /// Unit vector from A to B.
    pub normal: Vec2,
}

/// Distance of two shapes and their nearest points, in the frame of A.
#[must_use]
pub fn distance(a: &Geometry, b: &Geometry, b_in_a: &Frame) -> Closest {
    between(a.into(), b.into(), b_in_a)
}

/// Distance of two cores with their radii, in the frame of A.
pub(super) fn between(a: Core<'_>, b: Core<'_>, b_in_a: &Frame) -> Closest {
    let radii = [a.radius(), b.radius()];
    let closest = match (a, b) {
        (Core::Convex(a), Core::Convex(b)) => convex_to_convex(a, b, b_in_a),
        (Core::Convex(a), Core::Arc(b)) => convex_to_arc(a, &arc_in(&b, b_in_a)),
        (Core::Arc(a), Core::Convex(b)) => {
            let a_in_b = Frame::IDENTITY.seen_from(b_in_a);
            convex_to_arc(b, &arc_in(&a, &a_in_b)).flipped().in_frame(b_in_a)
        }
        (Core::Arc(a), Core::Arc(b)) => arc_to_arc(&a, &arc_in(&b, b_in_a)),
    };
    closest.grown(radii)
}

impl Closest {
    /// Of two points some way apart.
    fn of_points(on_a: Vec2, on_b: Vec2) -> Self {
        let distance = (on_b - on_a).norm();
        let normal = if distance > 0.0 { (on_b - on_a) / distance } else { vec2(1.0, 0.0) };
        Self { distance, on_a, on_b, normal }
    }

    /// Of a point of A and an arc.
    fn of_point_and_arc(on_a: Vec2, arc: &WireArc) -> Self {
        let (distance, on_b, normal) = point_to_arc(arc, on_a);
        let points = Self::of_points(on_a, on_b);
        Self { distance, normal: normal.unwrap_or(points.normal), ..points }
    }

    fn crossing(at: Vec2, normal: Vec2) -> Self {
        Self { distance: 0.0, on_a: at, on_b: at, normal }
    }

    fn nearer(self, other: Self) -> Self {
        if other.distance < self.distance { other } else { self }
    }

    fn flipped(self) -> Self {
        Self { on_a: self.on_b, on_b: self.on_a, normal: -self.normal, ..self }
    }

    fn in_frame(self, frame: &Frame) -> Self {
        let [on_a, on_b] = [self.on_a, self.on_b].map(|p| frame.apply(p));
        Self { on_a, on_b, normal: frame.rot.apply(self.normal), ..self }
    }

    fn grown(self, [radius_a, radius_b]: [Real; 2]) -> Self {
        Self {
            distance: self.distance - radius_a - radius_b,
            on_a: self.on_a + self.normal * radius_a,
            on_b: self.on_b - self.normal * radius_b,
            ..self
        }
    }
}

/// The face of `a` that is farthest below all of `b`.
fn best_face(a: &Convex, b: &Convex, b_in_a: &Frame) -> Option<(Closest, bool)> {
    let mut best: Option<(Closest, bool)> = None;
    for (normal, edge) in faces(a) {
        let (lowest, _) = highest(b, b_in_a.rot.apply_inverse(-normal));
        let point = b_in_a.apply(lowest);
        let height = normal.dot(&(point - edge.ends[0]));
        if best.is_none_or(|(best, _)| height > best.distance) {
            let on_a = point - normal * height;
            best =
                Some((Closest { distance: height, on_a, on_b: point, normal }, edge.spans(point)));
        }
    }
    best
}

/// Distance of two convex cores, in the frame of A. If a face of one has the other above it, the face that
/// parts them by most is it where the nearest vertex is above the face itself; else two vertices are nearest, or
/// a vertex and another edge. (Separating axes: Gottschalk, Lin and Manocha 1996.)
fn convex_to_convex(a: &Convex, b: &Convex, b_in_a: &Frame) -> Closest {
    let a_in_b = Frame::IDENTITY.seen_from(b_in_a);
    let of_a = best_face(a, b, b_in_a);
    let of_b = best_face(b, a, &a_in_b)
        .map(|(closest, spans)| (closest.flipped().in_frame(b_in_a), spans));
    let deeper =
        |x: (Closest, bool), y: (Closest, bool)| if y.0.distance > x.0.distance { y } else { x };
    let face = match (of_a, of_b) {
        (Some(of_a), Some(of_b)) => Some(deeper(of_a, of_b)),
        (of_a, of_b) => of_a.or(of_b),
    };
    match face {
        Some((closest, spans)) if spans || closest.distance <= 0.0 => return closest,
        _ => {}
    }
    let above_a = b.vertices.iter().map(|&vertex| {
        let point = b_in_a.apply(vertex);
        Closest::of_points(point_to_convex(a, point).1, point)
    });
    let above_b = a.vertices.iter().map(|&vertex| {
        let nearest = point_to_convex(b, a_in_b.apply(vertex)).1;
        Closest::of_points(vertex, b_in_a.apply(nearest))
    });
    // OK because cores have vertices; two points at the origin stand for what cannot be.
    above_a
        .chain(above_b)
        .reduce(Closest::nearer)
        .unwrap_or(Closest::of_points(Vec2::zeros(), Vec2::zeros()))
}

/// Distance of a convex core and an arc in its frame. They are nearest at an end of the arc, at a vertex, or
/// where an edge and the arc have one normal; or they cross.
fn convex_to_arc(core: &Convex, arc: &WireArc) -> Closest {
    let at_end = |end: Vec2| {
        let (distance, nearest) = point_to_convex(core, end);
        if distance > 0.0 {
            Closest::of_points(nearest, end)
        } else {
            Closest::crossing(end, outward(nearest, end))
        }
    };
    let [from, to] = ends(arc).map(at_end);
    let mut closest = from.nearer(to);
    for &vertex in &core.vertices {
        closest = closest.nearer(Closest::of_point_and_arc(vertex, arc));
    }
    for edge in edges(core) {
        let height = edge.normal.dot(&(arc.center - edge.ends[0]));
        let foot = arc.center - edge.normal * height;
        if height > arc.radius && edge.spans(foot) && arc.includes(-edge.normal) {
            let on_arc = arc.center - edge.normal * arc.radius;
            let distance = height - arc.radius;
            closest =
                closest.nearer(Closest { distance, on_a: foot, on_b: on_arc, normal: edge.normal });
        }
        if height.abs() <= arc.radius {
            let half = ((arc.radius - height) * (arc.radius + height)).max(0.0).sqrt();
            for at in [-half, half].map(|x| foot + perp(edge.normal) * x) {
                if edge.spans(at) && arc.includes(at - arc.center) {
                    closest = closest.nearer(Closest::crossing(at, edge.normal));
                }
            }
        }
    }
    closest
}

/// From a point inside a core to the nearest of its border.
fn outward(border: Vec2, inside: Vec2) -> Vec2 {
    Closest::of_points(inside, border).normal
}

/// Distance of two arcs in one frame. They are nearest at an end of one, or on the line through the centres;
/// or they cross.
fn arc_to_arc(a: &WireArc, b: &WireArc) -> Closest {
    let of_b = |end: Vec2| Closest::of_point_and_arc(end, a).flipped();
    let of_a = |end: Vec2| Closest::of_point_and_arc(end, b);
    let ends = ends(b).map(of_b).into_iter().chain(ends(a).map(of_a));
    let apart = b.center - a.center;
    let length = apart.norm();
    let mut closest = ends.fold(
        Closest { distance: Real::INFINITY, ..Closest::of_points(a.center, b.center) },
        Closest::nearer,
    );
    if length == 0.0 {
        return closest;
    }
    let u = apart / length;
    // Points at ±u on either circle; from one to the other it is along u.
    for side_a in [1.0, -1.0].into_iter().filter(|side| a.includes(u * *side)) {
        for side_b in [1.0, -1.0].into_iter().filter(|side| b.includes(u * *side)) {
            let along = length + side_b * b.radius - side_a * a.radius;
            let [on_a, on_b] =
                [(a, side_a), (b, side_b)].map(|(arc, side)| arc.center + u * (side * arc.radius));
            let normal = u * Real::signum(along);
            closest = closest.nearer(Closest { distance: along.abs(), on_a, on_b, normal });
        }
    }
    // Where the circles cross: x along the line through the centres, from that of A.
    let x = (length + (a.radius - b.radius) * ((a.radius + b.radius) / length)) / 2.0;
    let half = (a.radius - x) * (a.radius + x);
    if half >= 0.0 {
        for at in [-half.sqrt(), half.sqrt()].map(|y| u * x + perp(u) * y) {
            if a.includes(at) && b.includes(at - apart) {
                closest = closest.nearer(Closest::crossing(a.center + at, u));
            }
        }
    }
    closest
}

/// Whether two shapes share a point.
#[must_use]
pub fn overlap(a: &Geometry, b: &Geometry, b_in_a: &Frame) -> bool {
    distance(a, b, b_in_a).distance <= 0.0
}

/// Whether a shape holds a point, its border included. Arcs hold none.
#[must_use]
pub fn contains(geometry: &Geometry, point: Vec2) -> bool {
    match geometry {
        Geometry::Convex(core) => point_to_convex(core, point).0 <= core.radius,
        Geometry::Arc(_) => false,
    }
}

/// Distance of a point from a shape, below 0 inside, with the nearest point of its surface as `on_a`, and the
/// outward normal there.
#[must_use]
pub fn distance_to_point(geometry: &Geometry, point: Vec2) -> Closest {
    let core = match geometry {
        Geometry::Convex(core) => core,
        Geometry::Arc(arc) => return Closest::of_point_and_arc(point, arc).flipped(),
    };
    let (distance, nearest) = point_to_convex(core, point);
    let mut closest = Closest::of_points(nearest, point);
    if distance < 0.0 {
        closest = Closest { distance, normal: -closest.normal, ..closest };
    }
    closest.grown([core.radius, 0.0])
}
