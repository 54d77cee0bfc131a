//! Links of chains and pieces of polygons: the normals that their neighbours leave them.

use super::super::Manifold;
use super::axes::{Axis, Core, visit};
use super::closest::{Closest, closest};
use super::convex_convex::{Pair, is_contact};
use super::{Side, UNKNOWN};
use crate::math::{Real, Vec2};

/// Angle (rad) by which a normal may leave the cone of a vertex: rounding of unit vectors, and no more.
const SLACK: Real = 1e-9;

/// The manifold of two shapes at least one of which has joins.
///
/// Apart, the closest features decide if the joins allow their normal, as they do without joins. Otherwise
/// the best axis that they allow is taken, for what of the other shape stands above its face: beside it,
/// the neighbour reports.
pub(super) fn collide(pair: &Pair<'_>) -> Result<Manifold, Real> {
    if is_behind(pair.a, pair.b_in_a.apply(pair.b.middle()))
        || is_behind(pair.b, pair.a_in_b.apply(pair.a.middle()))
    {
        return Err(UNKNOWN);
    }
    let sides = [Side::A, Side::B].map(|side| bests(pair, side));
    let (side, axis) = pair.larger(sides[0].any, sides[1].any).ok_or(UNKNOWN)?;
    if axis.separation > pair.farthest() {
        return Err(pair.gap(&axis));
    }
    near(pair, (side, &axis), sides).ok_or(UNKNOWN)
}

/// The same where no axis parts them by more than is asked; the one that parts them most.
fn near(
    pair: &Pair<'_>,
    (side, axis): (Side, &Axis),
    [on_a, on_b]: [Bests; 2],
) -> Option<Manifold> {
    let rounding = pair.rounding(side, axis);
    let apart = axis.separation >= -rounding;
    if apart && let Some(found) = of_closest(pair) {
        return found;
    }
    let (side, axis) = pair.larger(on_a.allowed, on_b.allowed)?;
    let face = pair.face(side, axis);
    let above = face.above();
    if above.beside {
        return None;
    }
    // Shapes that are apart do not overlap, however deep the one lies below a face's line.
    let floor = if apart { -rounding } else { Real::NEG_INFINITY };
    above.manifold(&face, pair.margin, floor)
}

/// What the closest features make, if their normal is allowed.
fn of_closest(pair: &Pair<'_>) -> Option<Option<Manifold>> {
    let (features, squared) = closest(pair.a, pair.b, pair.b_in_a);
    match features {
        Closest::Vertices(i, j) => {
            if is_contact(pair, (i, j), squared) {
                return None;
            }
            let on_b = pair.b_in_a.apply(pair.b.vertices[j]);
            let normal = (on_b - pair.a.vertices[i]).normalize();
            let opposite = -pair.b_in_a.rot.apply_inverse(normal);
            let allowed = allows(pair.a, i, normal) && allows(pair.b, j, opposite);
            allowed.then(|| pair.corners((i, j)))
        }
        Closest::Face(side, axis) => {
            let face = pair.face(side, axis);
            let above = face.above();
            is_allowed(pair, side, &axis)
                .then(|| above.manifold(&face, pair.margin, Real::NEG_INFINITY))
        }
    }
}

/// The axes of largest separation on one side: of all, and of those that the joins allow.
struct Bests {
    any: Option<Axis>,
    allowed: Option<Axis>,
}

fn bests(pair: &Pair<'_>, side: Side) -> Bests {
    let (reference, other, frame) = match side {
        Side::A => (pair.a, pair.b, pair.b_in_a),
        Side::B => (pair.b, pair.a, &pair.a_in_b),
    };
    let mut bests = Bests { any: None, allowed: None };
    visit(reference, other, frame, |axis| {
        let beats = |best: Option<Axis>| best.is_none_or(|best| axis.separation > best.separation);
        if beats(bests.any) {
            bests.any = Some(axis);
        }
        if beats(bests.allowed) && is_allowed(pair, side, &axis) {
            bests.allowed = Some(axis);
        }
        true
    });
    bests
}

/// Whether a face may be touched, and the deepest vertex along its normal.
fn is_allowed(pair: &Pair<'_>, side: Side, axis: &Axis) -> bool {
    let face = pair.face(side, *axis);
    let outer = face.reference.joins.is_none_or(|joins| joins.outer[axis.face]);
    let normal = face.reference.normals[axis.face];
    outer && allows(face.other, axis.vertex, -face.frame.rot.apply_inverse(normal))
}

/// Whether a shape may be touched at a vertex under a normal.
fn allows(core: Core<'_>, vertex: usize, normal: Vec2) -> bool {
    let Some(joins) = core.joins else { return true };
    joins.cones[vertex].is_some_and(|cone| cone.holds(normal, SLACK))
}

/// Whether a point stands behind a shape with one side.
fn is_behind(core: Core<'_>, point: Vec2) -> bool {
    let Some(joins) = core.joins.filter(|joins| joins.one_sided) else { return false };
    let mut faces = joins.outer.iter().zip(core.normals).zip(core.vertices);
    faces.any(|((&outer, normal), vertex)| outer && normal.dot(&(point - vertex)) < 0.0)
}
