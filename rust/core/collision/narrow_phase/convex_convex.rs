//! Two convex cores and the radii around them.

use super::super::{Anchor, Frame, Manifold};
use super::axes::{Axis, Core, best};
use super::closest::{Closest, closest};
use super::face::Face;
use super::{SAME, Side, UNKNOWN, joined, point_point, vertex_on_vertex};
use crate::math::{Real, Vec2};

/// The manifold of two convex shapes, or a gap (m) that they have at least.
#[inline]
pub(super) fn collide(
    a: Core<'_>,
    b: Core<'_>,
    b_in_a: &Frame,
    margin: Real,
) -> Result<Manifold, Real> {
    if let ([center], [other]) = (a.vertices, b.vertices) {
        let gap = || (b_in_a.apply(*other) - center).norm() - (a.radius + b.radius);
        return corners(a, b, b_in_a, (0, 0), margin).ok_or_else(gap);
    }
    let pair = Pair { a, b, b_in_a, a_in_b: b_in_a.inverse(), margin };
    if a.joins.is_some() || b.joins.is_some() { joined::collide(&pair) } else { free(&pair) }
}

/// Two cores, each seen from the other.
pub(super) struct Pair<'a> {
    pub a: Core<'a>,
    pub b: Core<'a>,
    pub b_in_a: &'a Frame,
    pub a_in_b: Frame,
    pub margin: Real,
}

impl Pair<'_> {
    /// The face of an axis.
    pub fn face(&self, side: Side, axis: Axis) -> Face<'_> {
        let (reference, other, frame) = match side {
            Side::A => (self.a, self.b, self.b_in_a),
            Side::B => (self.b, self.a, &self.a_in_b),
        };
        Face { side, reference, other, frame, axis }
    }

    /// How much a separation may differ by rounding.
    pub fn rounding(&self, side: Side, axis: &Axis) -> Real {
        let Face { reference, other, frame, .. } = self.face(side, *axis);
        axis.rounding(reference, other, frame)
    }

    /// Separation of the cores beyond which nothing is reported (m).
    pub fn farthest(&self) -> Real {
        self.margin + self.a.radius + self.b.radius
    }

    /// Gap of the shapes that an axis shows at least (m).
    pub fn gap(&self, axis: &Axis) -> Real {
        axis.separation - self.a.radius - self.b.radius
    }

    /// Of two axes, that of larger separation; A's where they are equal.
    pub fn larger(&self, on_a: Option<Axis>, on_b: Option<Axis>) -> Option<(Side, Axis)> {
        match (on_a, on_b) {
            (Some(x), Some(y)) => {
                let b_wins = y.separation > x.separation + self.rounding(Side::B, &y);
                Some(if b_wins { (Side::B, y) } else { (Side::A, x) })
            }
            (Some(x), None) => Some((Side::A, x)),
            (None, y) => y.map(|y| (Side::B, y)),
        }
    }

    /// The manifold of a vertex of A and one of B.
    pub fn corners(&self, vertices: (usize, usize)) -> Option<Manifold> {
        corners(self.a, self.b, self.b_in_a, vertices, self.margin)
    }
}

/// Shapes that are joined to nothing.
fn free(pair: &Pair<'_>) -> Result<Manifold, Real> {
    let far = pair.farthest();
    let on_a = best(pair.a, pair.b, pair.b_in_a, far);
    if let Some(axis) = on_a.filter(|axis| axis.separation > far) {
        return Err(pair.gap(&axis));
    }
    let on_b = best(pair.b, pair.a, &pair.a_in_b, far);
    if let Some(axis) = on_b.filter(|axis| axis.separation > far) {
        return Err(pair.gap(&axis));
    }
    near(pair, on_a, on_b).ok_or(UNKNOWN)
}

/// The same where no axis parts them by more than is asked.
fn near(pair: &Pair<'_>, on_a: Option<Axis>, on_b: Option<Axis>) -> Option<Manifold> {
    let (side, axis) = pair.larger(on_a, on_b)?;
    let rounding = pair.rounding(side, &axis);
    let face = pair.face(side, axis);
    let above = face.above();
    // Sharp edges that end where the other's begin pass by: a box that slides over the seams of a floor of tiles, or falls along a wall of
    // them, is not stopped by the tile to come. If it does overlap that one, then by so little that it parts across.
    if above.grazes && pair.a.radius + pair.b.radius == 0.0 {
        return None;
    }
    // A deepest point above the face is the closest one; so it is where the cores overlap.
    let overlap = axis.separation < -rounding;
    if overlap || (!above.beside && above.lowest() <= axis.separation + rounding) {
        return above.manifold(&face, pair.margin, Real::NEG_INFINITY);
    }
    let (features, squared) = closest(pair.a, pair.b, pair.b_in_a);
    match features {
        Closest::Vertices(i, j) if !is_contact(pair, (i, j), squared) => pair.corners((i, j)),
        Closest::Vertices(..) => above.manifold(&face, pair.margin, Real::NEG_INFINITY),
        Closest::Face(side, axis) => {
            let face = pair.face(side, axis);
            face.above().manifold(&face, pair.margin, Real::NEG_INFINITY)
        }
    }
}

/// Whether two vertices are too close for the line between them to be a normal.
pub(super) fn is_contact(pair: &Pair<'_>, (i, j): (usize, usize), squared: Real) -> bool {
    let length = |core: Core<'_>, i: usize| {
        let next = core.vertices[core.after(i)];
        (next - core.vertices[i]).norm_squared()
    };
    let longest = length(pair.a, i).max(length(pair.b, j));
    squared <= SAME * SAME * longest
}

#[inline]
fn corners(
    a: Core<'_>,
    b: Core<'_>,
    b_in_a: &Frame,
    (i, j): (usize, usize),
    margin: Real,
) -> Option<Manifold> {
    let (on_a, on_b): (Vec2, Vec2) = (a.vertices[i], b.vertices[j]);
    let anchor = Anchor { on_a, on_b, feature: vertex_on_vertex(i, j) };
    point_point::collide(anchor, b_in_a.apply(on_b), [a.radius, b.radius], margin)
}
