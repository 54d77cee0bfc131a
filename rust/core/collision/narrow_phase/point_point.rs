//! Two core points: circles, corners, ends.

use super::super::{Anchor, Manifold, Normal};
use crate::math::{Real, Vec2, vec2};

/// Two circles; `b` is the centre of B in the frame of A, the anchor that in its own.
#[inline]
pub(super) fn collide(anchor: Anchor, b: Vec2, radii: [Real; 2], margin: Real) -> Option<Manifold> {
    let far = margin + radii[0] + radii[1];
    let squared = (b - anchor.on_a).norm_squared();
    if far < 0.0 || squared > far * far {
        return None;
    }
    // Centres in one place have no direction: any that stays the same from step to step will do.
    let normal = if squared > 0.0 { Normal::Between } else { Normal::OnA(vec2(0.0, 1.0)) };
    Some(Manifold::point(normal, anchor, radii))
}
