//! The shadow a body casts: its width across the motion, which air drag asks for.

use super::Shape;
use super::arc::WireArc;
use super::bounds::Interval;
use super::geometry::Geometry;
use crate::math::{Real, Rot, Vec2, perp, vec2};

/// The outline of one body's shapes as seen from far away, ready to be asked often.
#[derive(Clone, Debug)]
pub struct Silhouette {
    /// Hull vertices of all parts, relative to the centroid of the first: only directions matter
    /// here.
    points: Vec<Vec2>,
    parts: Vec<Part>,
}

/// Points within a radius of the convex hull of `points[from..to]`, or a wire about the first of
/// them.
#[derive(Clone, Debug)]
struct Part {
    from: usize,
    to: usize,
    radius: Real,
    arc: Option<WireArc>,
}

/// Between two kinks, the width of a silhouette across a unit vector n is c·n + r: the points that
/// bound it stay the same. Kinks are where others take over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facet {
    arm: Vec2,
    round: Real,
}

/// A point that bounds an extent, and how far the extent goes beyond it.
type Bound = (Vec2, Real);

/// Up to this many parts, no memory is asked for.
const FEW: usize = 16;

impl Silhouette {
    /// Of the shapes of one body, all in its frame.
    #[must_use]
    pub fn new(shapes: &[&Shape]) -> Self {
        let origin = shapes.first().map_or(vec2(0.0, 0.0), |shape| shape.centroid());
        let (mut points, mut parts) = (Vec::new(), Vec::new());
        for shape in shapes {
            let (hull, radius) = shape.core_about(origin);
            let from = points.len();
            points.extend(hull);
            let arc = if let Geometry::Arc(arc) = shape.0.geometry { Some(arc) } else { None };
            parts.push(Part { from, to: points.len(), radius, arc });
        }
        Self { points, parts }
    }

    /// Width of the shadow that light along `direction` (in the frame of the body, of any length
    /// above 0) casts on a line across it (m): the measure of the union of the parts' extents, so
    /// that gaps between parts do not count, and overlaps count once. 0 without shapes. Exact for
    /// every shape: 2r for a circle, a |sin φ| + b |cos φ| for a box seen at φ, the extent of the
    /// hull for a polygon.
    #[must_use]
    pub fn width_across(&self, direction: Vec2) -> Real {
        let Some(across) = perp(direction).try_normalize(0.0) else { return 0.0 };
        if let [part] = &self.parts[..] {
            return self.extent(part, across).length();
        }
        let mut few = [Interval::EMPTY; FEW];
        let mut many = Vec::new();
        let extents = if self.parts.len() <= FEW {
            &mut few[..self.parts.len()]
        } else {
            many.resize(self.parts.len(), Interval::EMPTY);
            &mut many[..]
        };
        for (extent, part) in extents.iter_mut().zip(&self.parts) {
            *extent = self.extent(part, across);
        }
        measure_of_union(extents)
    }

    /// What bounds the width across a direction; it gives the same width until another point takes over.
    #[must_use]
    pub fn facet(&self, direction: Vec2) -> Facet {
        let mut facet = Facet { arm: Vec2::zeros(), round: 0.0 };
        let Some(across) = perp(direction).try_normalize(0.0) else { return facet };
        let reach = |(point, round): Bound| point.dot(&across) + round;
        let mut parts: Vec<_> = self.parts.iter().map(|part| self.bounds(part, across)).collect();
        parts.sort_unstable_by(|a, b| reach(a.0).total_cmp(&reach(b.0)));
        let mut parts = parts.into_iter().peekable();
        while let Some((first, mut last)) = parts.next() {
            while let Some((_, end)) = parts.next_if(|next| reach(next.0) <= reach(last)) {
                last = if reach(end) > reach(last) { end } else { last };
            }
            facet.arm += last.0 - first.0;
            facet.round += last.1 - first.1;
        }
        facet
    }

    /// The bounds of a part along −across and along across.
    fn bounds(&self, part: &Part, across: Vec2) -> (Bound, Bound) {
        let points = &self.points[part.from..part.to];
        if let Some(arc) = &part.arc {
            return arc.bounds(points[0], across);
        }
        let height = |a: &&Vec2, b: &&Vec2| a.dot(&across).total_cmp(&b.dot(&across));
        let (low, high) = (points.iter().min_by(height), points.iter().max_by(height));
        let bound = |point: Option<&Vec2>, radius| (point.copied().unwrap_or_default(), radius);
        (bound(low, -part.radius), bound(high, part.radius))
    }

    /// Extent, across the motion, of the box along the world's axes that holds the turned shapes
    /// (m): with its width w and height h, w |sin| + h |cos| of the motion's angle. The simple
    /// estimate that many games make, never below [`Silhouette::width_across`]; for comparison with
    /// it.
    #[must_use]
    pub fn bounding_box_width_across(&self, direction_world: Vec2, rot: Rot) -> Real {
        let Some(across) = perp(direction_world).try_normalize(0.0) else { return 0.0 };
        let axis = |axis: Vec2| {
            let across = rot.apply_inverse(axis);
            let extents = self.parts.iter().map(|part| self.extent(part, across));
            extents.fold(Interval::EMPTY, Interval::merged).length()
        };
        axis(vec2(1.0, 0.0)) * across.x.abs() + axis(vec2(0.0, 1.0)) * across.y.abs()
    }

    fn extent(&self, part: &Part, across: Vec2) -> Interval {
        let points = &self.points[part.from..part.to];
        match &part.arc {
            Some(arc) => arc.span(across).moved(points[0].dot(&across)),
            None => Interval::of(points, across).grown(part.radius),
        }
    }
}

impl Facet {
    /// Width across a direction (in the frame of the body), as long as this facet bounds it.
    #[must_use]
    pub fn width_across(&self, direction: Vec2) -> Real {
        let Some(across) = perp(direction).try_normalize(0.0) else { return 0.0 };
        self.arm.dot(&across) + self.round
    }
}

fn measure_of_union(extents: &mut [Interval]) -> Real {
    extents.sort_unstable_by(|a, b| a.min.total_cmp(&b.min));
    let mut covered = Real::NEG_INFINITY;
    let mut measure = 0.0;
    for extent in extents {
        if extent.max > covered {
            measure += extent.max - extent.min.max(covered);
            covered = extent.max;
        }
    }
    measure
}
