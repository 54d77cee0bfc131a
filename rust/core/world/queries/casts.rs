//! What a ray or a moving shape hits.

use super::{Asked, Placed, QueryFilter, ShapeId};
use crate::body::BodyHandle;
use crate::collision::{Collider, Geometry, Hit, cast_ray, cast_shape};
use crate::error::{Result, check};
use crate::math::{Pose, Real, Vec2};
use crate::shapes::Shape;
use crate::world::World;

/// Where a ray or a moving shape hits a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RayHit {
    /// The body that is hit.
    pub body: BodyHandle,
    /// Which of its shapes, counted from 0.
    pub part: usize,
    /// Point of that shape (m).
    pub point: Vec2,
    /// Its outward unit normal there; of wires, on the side that is hit.
    pub normal: Vec2,
    /// Part of the way up to the hit, 0 … 1.
    pub fraction: Real,
}

/// Rays: from a point along a translation (direction × length, m).
///
/// A ray that starts in a shape hits it where it starts, at fraction 0, with a normal against the ray. One
/// without length hits what its point is in.
impl World {
    /// The first shape that a ray hits; of several at once the first in body order.
    ///
    /// # Errors
    /// Numbers that are not finite, a length above 1e150 m, bodies to exclude that are gone.
    pub fn cast_ray(
        &self,
        from: Vec2,
        translation: Vec2,
        filter: &QueryFilter<'_>,
    ) -> Result<Option<RayHit>> {
        Ok(self.ask(filter)?.closest(&Cast::ray(from, translation)?))
    }

    /// All shapes that a ray hits, each where the ray first enters it, in the order of the way.
    ///
    /// # Errors
    /// As [`World::cast_ray`].
    pub fn cast_ray_all(
        &self,
        from: Vec2,
        translation: Vec2,
        filter: &QueryFilter<'_>,
    ) -> Result<Vec<RayHit>> {
        Ok(self.ask(filter)?.all(&Cast::ray(from, translation)?))
    }

    /// Calls `found` with hits of a ray, in no certain order, and with several of a shape that has several
    /// pieces. It returns the fraction of the way up to which to look from now on: that of the hit for the
    /// nearest alone, 1 to go on, −1 to end.
    ///
    /// # Errors
    /// As [`World::cast_ray`].
    pub fn visit_ray(
        &self,
        from: Vec2,
        translation: Vec2,
        filter: &QueryFilter<'_>,
        found: &mut dyn FnMut(&RayHit) -> Real,
    ) -> Result<()> {
        self.ask(filter)?.visit(&Cast::ray(from, translation)?, &mut |hit, _| found(hit));
        Ok(())
    }

    /// The first shape that a shape hits that starts at a pose (of the frame it is given in) and moves along a
    /// translation (m) without turning. What it overlaps at the start it hits at fraction 0, with the normal
    /// along which the two are soonest apart.
    ///
    /// # Errors
    /// As [`World::cast_ray`].
    pub fn cast_shape(
        &self,
        shape: &Shape,
        from: &Pose,
        translation: Vec2,
        filter: &QueryFilter<'_>,
    ) -> Result<Option<RayHit>> {
        Ok(self.ask(filter)?.closest(&Cast::shape(shape, from, translation)?))
    }

    /// All shapes that a moving shape would hit if nothing stopped it, in the order of the way.
    ///
    /// # Errors
    /// As [`World::cast_ray`].
    pub fn cast_shape_all(
        &self,
        shape: &Shape,
        from: &Pose,
        translation: Vec2,
        filter: &QueryFilter<'_>,
    ) -> Result<Vec<RayHit>> {
        Ok(self.ask(filter)?.all(&Cast::shape(shape, from, translation)?))
    }
}

/// What is cast.
enum Caster {
    Point(Vec2),
    Shape(Placed),
}

/// What is cast, and its way.
struct Cast {
    caster: Caster,
    translation: Vec2,
}

impl Cast {
    fn ray(from: Vec2, translation: Vec2) -> Result<Self> {
        check::finite_vec("start of the ray", from)?;
        Ok(Self { caster: Caster::Point(from), translation: way(translation)? })
    }

    fn shape(shape: &Shape, from: &Pose, translation: Vec2) -> Result<Self> {
        let placed = Placed::new(shape, from)?;
        Ok(Self { caster: Caster::Shape(placed), translation: way(translation)? })
    }

    /// Centre and half extents of the box that moves.
    fn moving_box(&self) -> (Vec2, Vec2) {
        match &self.caster {
            Caster::Point(from) => (*from, Vec2::zeros()),
            Caster::Shape(Placed { bounds, .. }) => {
                let half = (bounds.max - bounds.min) / 2.0;
                let rounding = 4.0 * Real::EPSILON * (bounds.min.amax() + bounds.max.amax());
                (bounds.min + half, half.add_scalar(rounding))
            }
        }
    }
}

/// A translation whose length can be squared.
fn way(translation: Vec2) -> Result<Vec2> {
    check::finite_vec("way", translation)?;
    check::finite("square of the way's length", translation.norm_squared())?;
    Ok(translation)
}

impl Asked<'_> {
    /// Calls `found` with every hit, and with the fraction up to which is looked.
    fn visit(&self, cast: &Cast, found: &mut dyn FnMut(&RayHit, Real) -> Real) {
        let mut see = |collider: &Collider, limit: Real| {
            let hit = match &cast.caster {
                Caster::Point(from) => self.ray(collider, *from, cast.translation),
                Caster::Shape(placed) => self.shape_cast(collider, placed, cast.translation),
            };
            match hit {
                Some(Hit { fraction, point, normal }) if fraction <= limit => {
                    let ShapeId { body, part } = self.id(collider);
                    found(&RayHit { body, part, point, normal, fraction }, limit)
                }
                _ => limit,
            }
        };
        self.state.contacts.cast(
            self.strays,
            cast.moving_box(),
            cast.translation,
            &mut |entry, limit| {
                if self.sees(entry) { see(&entry.collider, limit) } else { limit }
            },
        );
    }

    fn closest(&self, cast: &Cast) -> Option<RayHit> {
        let mut best: Option<RayHit> = None;
        self.visit(cast, &mut |hit, _| {
            if best.is_none_or(|best| self.order(hit) < self.order(&best)) {
                best = Some(*hit);
            }
            hit.fraction
        });
        best
    }

    fn all(&self, cast: &Cast) -> Vec<RayHit> {
        let mut hits = Vec::new();
        self.visit(cast, &mut |hit, limit| {
            hits.push(*hit);
            limit
        });
        // The first hit of each shape, then along the way.
        let order = |hit: &RayHit| self.order(hit);
        let shape = |hit: &RayHit| (order(hit).1, order(hit).2);
        hits.sort_by(|a, b| shape(a).cmp(&shape(b)).then(a.fraction.total_cmp(&b.fraction)));
        hits.dedup_by_key(|hit| shape(hit));
        // Stable: hits at once stay in body order.
        hits.sort_by(|a, b| a.fraction.total_cmp(&b.fraction));
        hits
    }

    /// By the way, then by body and shape, so that no answer depends on how the trees grew.
    fn order(&self, hit: &RayHit) -> (Real, usize, usize) {
        // OK because the body was found a moment ago.
        let body = self.state.bodies.index(hit.body).unwrap_or(usize::MAX);
        (hit.fraction, body, hit.part)
    }

    /// First point of a collider on a ray, in the world.
    fn ray(&self, collider: &Collider, from: Vec2, translation: Vec2) -> Option<Hit> {
        let frame = self.frame(collider);
        let (start, way) = (frame.apply_inverse(from), frame.rot.apply_inverse(translation));
        // A start on the cut between two pieces may be outside both by rounding.
        if is_piece(&collider.geometry) && translation != Vec2::zeros() {
            let (shape, center) = self.shape(collider);
            if shape.contains(start + center) {
                return Some(Hit { fraction: 0.0, point: from, normal: -translation.normalize() });
            }
        }
        let hit = cast_ray(&collider.geometry, start, way)?;
        let point = if hit.fraction == 0.0 { from } else { frame.apply(hit.point) };
        Some(Hit { point, normal: frame.rot.apply(hit.normal), ..hit })
    }

    /// First point of a collider that a moving shape touches, in the world.
    fn shape_cast(&self, collider: &Collider, placed: &Placed, way: Vec2) -> Option<Hit> {
        let body = self.pose(collider);
        // From the body, so that places far from the origin keep their digits.
        let start = Pose::new(placed.pose.position - body.position, placed.pose.angle);
        let rest = Pose::new(Vec2::zeros(), body.angle);
        let hits = placed
            .pieces
            .iter()
            .filter_map(|piece| cast_shape((piece, &start), way, (&collider.geometry, &rest)));
        let first = hits.min_by(|a, b| a.fraction.total_cmp(&b.fraction))?;
        Some(Hit { point: body.position + first.point, ..first })
    }
}

/// Whether a collider is one of several pieces that an outline was cut into.
fn is_piece(geometry: &Geometry) -> bool {
    match geometry {
        Geometry::Convex(core) => core.joins.is_some() && core.vertices.len() > 2,
        Geometry::Arc(_) => false,
    }
}
