//! The closest features of two cores that do not overlap.

use super::super::Frame;
use super::Side;
use super::axes::{Axis, Core, visit};
use crate::math::{Real, Vec2, perp};

/// Which features are closest.
#[derive(Clone, Copy)]
pub(super) enum Closest {
    /// A face of one side and a vertex of the other.
    Face(Side, Axis),
    /// A vertex of A and one of B.
    Vertices(usize, usize),
}

/// The closest features and the square of their distance (m²). At least one core has faces.
///
/// The point of the Minkowski difference closest to the origin lies on an edge of it, that is on a face of
/// one core and a vertex of the other that lies deepest along the normal. Where faces are parallel the
/// deepest vertex is one of two; hence neighbours as deep are looked at as well.
pub(super) fn closest(a: Core<'_>, b: Core<'_>, b_in_a: &Frame) -> (Closest, Real) {
    let mut least = (Closest::Vertices(0, 0), Real::INFINITY);
    for (side, reference, other, frame) in
        [(Side::A, a, b, *b_in_a), (Side::B, b, a, b_in_a.inverse())]
    {
        let few = other.vertices.len().min(3);
        visit(reference, other, &frame, |axis| {
            let limit = axis.separation + axis.rounding(reference, other, &frame);
            let near = [axis.vertex, other.after(axis.vertex), other.before(axis.vertex)];
            for &vertex in &near[..few] {
                let arm = frame.apply(other.vertices[vertex]) - reference.vertices[axis.face];
                let separation = reference.normals[axis.face].dot(&arm);
                if separation > limit {
                    continue;
                }
                let found = of_face(side, reference, Axis { vertex, separation, ..axis }, arm);
                if let Some(found) = found.filter(|found| found.1 < least.1) {
                    least = found;
                }
            }
            true
        });
    }
    least
}

/// Distance of a vertex, which stands off the begin of a face by `arm`; none if it stands behind the face.
fn of_face(side: Side, reference: Core<'_>, axis: Axis, arm: Vec2) -> Option<(Closest, Real)> {
    let Axis { face, vertex, separation } = axis;
    let end = reference.after(face);
    let edge = reference.vertices[end] - reference.vertices[face];
    let along = perp(reference.normals[face]);
    let corner = |corner: usize, arm: Vec2| {
        let pair = if side == Side::A { (corner, vertex) } else { (vertex, corner) };
        Some((Closest::Vertices(pair.0, pair.1), arm.norm_squared()))
    };
    if along.dot(&arm) < 0.0 {
        return corner(face, arm);
    }
    if along.dot(&arm) > along.dot(&edge) {
        return corner(end, arm - edge);
    }
    (separation >= 0.0).then_some((Closest::Face(side, axis), separation * separation))
}
