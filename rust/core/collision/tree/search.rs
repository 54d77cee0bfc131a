//! What a moving box meets in a tree, and what is nearest to a box: branch and bound.

use super::{NONE, Tree};
use crate::math::{Real, Vec2};
use crate::shapes::Aabb;

impl Tree {
    /// Calls `found` with the item of every leaf that a box of these half extents meets on its way, nearest
    /// first as far as boxes tell, and goes on with the largest fraction that `found` returns. Returns that.
    pub fn cast(
        &self,
        cast: &BoxCast,
        limit: Real,
        found: &mut dyn FnMut(u32, Real) -> Real,
    ) -> Real {
        self.search(|aabb| cast.entry(aabb), limit, found)
    }

    /// The same with the leaves whose boxes are within `limit` (m) of a box, and with distances in place of
    /// fractions.
    pub fn nearest(
        &self,
        aabb: &Aabb,
        limit: Real,
        found: &mut dyn FnMut(u32, Real) -> Real,
    ) -> Real {
        self.search(|other| Some(other.distance(aabb)), limit, found)
    }

    /// Goes through the leaves of which `entry` says a number up to the limit, smaller ones first as far as the
    /// boxes above tell.
    fn search(
        &self,
        entry: impl Fn(&Aabb) -> Option<Real>,
        mut limit: Real,
        found: &mut dyn FnMut(u32, Real) -> Real,
    ) -> Real {
        let mut stack: Vec<(u32, Real)> = Vec::new();
        let enter = |index: u32, limit: Real| {
            let entry = entry(&self.nodes[index as usize].aabb)?;
            (entry <= limit).then_some((index, entry))
        };
        if self.root != NONE {
            stack.extend(enter(self.root, limit));
        }
        while let Some((index, entry)) = stack.pop() {
            if entry > limit {
                continue;
            }
            let node = &self.nodes[index as usize];
            if node.is_leaf() {
                limit = limit.min(found(node.item, limit));
                continue;
            }
            match node.children.map(|child| enter(child, limit)) {
                [Some(a), Some(b)] if a.1 < b.1 => stack.extend([b, a]),
                children => stack.extend(children.into_iter().flatten()),
            }
        }
        limit
    }
}

/// A box that moves in a straight line.
pub(in super::super) struct BoxCast {
    pub origin: Vec2,
    pub translation: Vec2,
    pub half_extents: Vec2,
}

impl BoxCast {
    /// Fraction of the way at which the boxes first meet; None if they do not.
    fn entry(&self, aabb: &Aabb) -> Option<Real> {
        // So that rounding loses no touch.
        const ROUNDING: Real = 1.0 + 4.0 * Real::EPSILON;
        let (low, high) = (aabb.min - self.origin, aabb.max - self.origin);
        let (mut entry, mut exit): (Real, Real) = (0.0, 1.0);
        for axis in 0..2 {
            let (low, high) =
                (low[axis] - self.half_extents[axis], high[axis] + self.half_extents[axis]);
            let along = self.translation[axis];
            if along == 0.0 {
                if low > 0.0 || high < 0.0 {
                    return None;
                }
                continue;
            }
            let (first, last) = (low / along, high / along);
            entry = entry.max(first.min(last));
            exit = exit.min(first.max(last) * ROUNDING);
        }
        (entry <= exit).then_some(entry)
    }
}
