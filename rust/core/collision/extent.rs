//! Boxes around colliders.

use super::{Frame, Geometry};
use crate::math::Vec2;
use crate::shapes::{Aabb, Interval};

impl Geometry {
    /// A box along the axes around the collider, in the outer frame: the smallest for convex cores, that of the
    /// whole circle for arcs.
    #[must_use]
    pub fn bounds_at(&self, frame: &Frame) -> Aabb {
        match self {
            Self::Convex(convex) => {
                let rot = frame.rot;
                let empty = (Interval::EMPTY, Interval::EMPTY);
                let (x, y) = convex.vertices.iter().fold(empty, |(x, y), vertex| {
                    let turned = rot.apply(*vertex);
                    (x.with(turned.x), y.with(turned.y))
                });
                let grow = |span: Interval, at| span.grown(convex.radius).moved(at);
                Aabb::new(grow(x, frame.position.x), grow(y, frame.position.y))
            }
            Self::Arc(arc) => {
                let center = frame.apply(arc.center);
                let all = Vec2::new(arc.radius, arc.radius);
                Aabb { min: center - all, max: center + all }
            }
        }
    }
}
