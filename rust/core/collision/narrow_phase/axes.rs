//! The walk around the Minkowski difference of two cores.

use super::super::{Convex, Frame, Joins};
use crate::math::{Real, Vec2};

/// A convex shape by reference: what [`Convex`] owns.
#[derive(Clone, Copy)]
pub(super) struct Core<'a> {
    pub vertices: &'a [Vec2],
    pub normals: &'a [Vec2],
    pub radius: Real,
    pub joins: Option<&'a Joins>,
}

/// A face of one core, the vertex of the other that lies deepest along its normal, and how far that lies
/// above the face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    pub face: usize,
    pub vertex: usize,
    pub separation: Real,
}

impl<'a> Core<'a> {
    pub fn of(convex: &'a Convex) -> Self {
        let Convex { vertices, normals, radius, joins } = convex;
        Self { vertices, normals, radius: *radius, joins: joins.as_deref() }
    }

    /// A disk.
    pub fn disk(center: &'a Vec2, radius: Real) -> Self {
        Self { vertices: std::slice::from_ref(center), normals: &[], radius, joins: None }
    }

    /// The vertex after this one.
    pub fn after(&self, vertex: usize) -> usize {
        if vertex + 1 < self.vertices.len() { vertex + 1 } else { 0 }
    }

    /// The vertex before this one.
    pub fn before(&self, vertex: usize) -> usize {
        if vertex > 0 { vertex - 1 } else { self.vertices.len() - 1 }
    }

    /// Mean of the vertices: inside the core.
    pub fn middle(&self) -> Vec2 {
        let first = self.vertices[0];
        let sum: Vec2 = self.vertices.iter().map(|v| v - first).sum();
        first + sum / self.vertices.len() as Real
    }

    /// The vertex of least height along a direction, and that height.
    #[inline]
    fn lowest(&self, direction: Vec2) -> (usize, Real) {
        let mut lowest = (0, Real::INFINITY);
        for (i, v) in self.vertices.iter().enumerate() {
            let height = v.dot(&direction);
            lowest = if height < lowest.1 { (i, height) } else { lowest };
        }
        lowest
    }

    /// The same, from a vertex that comes before it. It looks two vertices ahead, so that an edge as short
    /// as rounding does not stop it.
    fn lowest_from(&self, direction: Vec2, from: usize) -> (usize, Real) {
        let height = |i: usize| self.vertices[i].dot(&direction);
        let mut lowest = (from, height(from));
        let mut ahead = from;
        for _ in 0..2 * self.vertices.len() {
            ahead = self.after(ahead);
            let next = height(ahead);
            if next < lowest.1 {
                lowest = (ahead, next);
            } else if ahead != self.after(lowest.0) {
                break;
            }
        }
        lowest
    }
}

impl Axis {
    /// How much its separation may differ by rounding: a fraction of the coordinates that make it (m).
    pub fn rounding(&self, reference: Core<'_>, other: Core<'_>, frame: &Frame) -> Real {
        let corner = reference.vertices[self.face].amax();
        EQUAL * (frame.position.amax() + corner + other.vertices[self.vertex].amax())
    }
}

/// Two separations that differ by less than this fraction of the coordinates they come from are equal.
const EQUAL: Real = 1e-12;

/// All faces of `reference` against `other`, in order, until the visitor says to stop (false).
///
/// The deepest vertex runs round as the normal does (rotating calipers; M. I. Shamos, "Computational
/// geometry", 1978), so this takes as long as both have vertices.
#[inline]
pub(super) fn visit(
    reference: Core<'_>,
    other: Core<'_>,
    frame: &Frame,
    mut visitor: impl FnMut(Axis) -> bool,
) {
    let few = other.vertices.len() <= FEW;
    let mut vertex = usize::MAX;
    for (face, (&normal, begin)) in reference.normals.iter().zip(reference.vertices).enumerate() {
        let down = frame.rot.apply_inverse(normal);
        let (deepest, height) = if few || vertex == usize::MAX {
            other.lowest(down)
        } else {
            other.lowest_from(down, vertex)
        };
        vertex = deepest;
        let separation = normal.dot(&(frame.position - begin)) + height;
        if !visitor(Axis { face, vertex, separation }) {
            return;
        }
    }
}

/// Up to this many vertices, looking at all is as fast.
const FEW: usize = 8;

/// The smallest extent of a core along one of its normals (m).
pub(in super::super) fn width(convex: &Convex) -> Real {
    let core = Core::of(convex);
    let mut width = Real::INFINITY;
    visit(core, core, &Frame::IDENTITY, |axis| {
        width = width.min(-axis.separation);
        true
    });
    width
}

/// The axis of largest separation, or the first one of more than `enough`.
#[inline]
pub(super) fn best(
    reference: Core<'_>,
    other: Core<'_>,
    frame: &Frame,
    enough: Real,
) -> Option<Axis> {
    let mut best: Option<Axis> = None;
    visit(reference, other, frame, |axis| {
        if best.is_none_or(|best| axis.separation > best.separation) {
            best = Some(axis);
        }
        axis.separation <= enough
    });
    best
}
