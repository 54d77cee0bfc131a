//! The links of a chain, and what their neighbours leave them.

use super::{Cone, Convex, Joins};
use crate::math::{Vec2, cross, perp};

/// The links of a chain through `points` (about the centre of mass), each of which knows its neighbours.
pub(super) fn links(points: &[Vec2], closed: bool, one_sided: bool) -> Vec<Convex> {
    let n = points.len();
    let count = if closed { n } else { n - 1 };
    let end = |i: usize| points[(i + 1) % n];
    let way = |i: usize| (end(i) - points[i]).normalize();
    let link = |i: usize| {
        let before = (closed || i > 0).then(|| way((i + count - 1) % count));
        let after = (closed || i + 1 < count).then(|| way((i + 1) % count));
        let cones = [cone(before, Some(way(i)), one_sided), cone(Some(way(i)), after, one_sided)];
        // Of a core of two points the first edge has the right side outside, the second the left.
        let joins = Joins { outer: [!one_sided, true].into(), cones: cones.into(), one_sided };
        let convex = Convex::new(vec![points[i], end(i)], 0.0);
        Convex { joins: Some(Box::new(joins)), ..convex }
    };
    (0..count).map(link).collect()
}

/// The normals left at a point with a link that leads to it and one that leads on.
fn cone(before: Option<Vec2>, after: Option<Vec2>, one_sided: bool) -> Option<Cone> {
    let cone = |from: Vec2, to: Vec2| Some(Cone { from, to });
    match (before, after) {
        (Some(before), Some(after)) if cross(before, after) > 0.0 => {
            if one_sided {
                None
            } else {
                cone(-perp(before), -perp(after))
            }
        }
        (Some(before), Some(after)) => cone(perp(after), perp(before)),
        (Some(before), None) => cone(if one_sided { before } else { -perp(before) }, perp(before)),
        (None, Some(after)) => cone(perp(after), if one_sided { -after } else { -perp(after) }),
        (None, None) => None,
    }
}
