//! What deformable bodies are where: rays, points, regions, distances. Their borders have a thickness; what is inside belongs to them.

use crate::body::Filter;
use crate::collision::{Convex, Frame, Geometry, cast_ray, overlap};
use crate::error::{Error, Result, check};
use crate::math::{Real, Vec2, cross, vec2};
use crate::shapes::Aabb;
use crate::soft::{SoftBody, SoftHandle};
use crate::world::World;
use crate::world::soft::look::bounds;

/// Which deformable bodies a query sees. The default sees all.
#[derive(Clone, Copy, Debug, Default)]
pub struct SoftFilter<'a> {
    /// Bits of the categories that are seen; none: all.
    pub mask: Option<u32>,
    /// Bits of the categories the query belongs to: it sees only bodies with one of them in their masks.
    pub category: Option<u32>,
    /// Group, if not 0: bodies of the same one are all seen if it is above 0, and none if it is below.
    pub group: i32,
    /// Bodies that are not seen.
    pub exclude: &'a [SoftHandle],
}

/// Where a ray hits a deformable body.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SoftRayHit {
    /// The body that is hit.
    pub body: SoftHandle,
    /// Point of its border (m); the start of the ray where that is inside.
    pub point: Vec2,
    /// Its outward unit normal there.
    pub normal: Vec2,
    /// Part of the way up to the hit, 0 … 1.
    pub fraction: Real,
}

/// The deformable body that is nearest to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NearestSoft {
    /// The body.
    pub body: SoftHandle,
    /// Its point that is nearest (m): the point that was asked for, if the body holds it.
    pub point: Vec2,
    /// How far that is (m): 0 if the body holds the point.
    pub distance: Real,
}

impl SoftFilter<'_> {
    fn sees(&self, handle: SoftHandle, own: &Filter) -> bool {
        let by_bits = if self.group != 0 && self.group == own.group {
            self.group > 0
        } else {
            self.mask.is_none_or(|mask| own.category & mask != 0)
                && self.category.is_none_or(|category| own.mask & category != 0)
        };
        by_bits && !self.exclude.contains(&handle)
    }
}

/// Queries for deformable bodies. They look at all of those, whose boxes they make anew.
impl World {
    fn soft_seen<'a>(
        &'a self,
        filter: &'a SoftFilter<'a>,
    ) -> impl Iterator<Item = (SoftHandle, &'a SoftBody)> {
        let all = self.soft_handles().iter().copied().zip(self.soft_bodies());
        all.filter(|(handle, body)| filter.sees(*handle, &body.def().filter))
    }

    /// The deformable bodies that hold a point, in their order.
    ///
    /// # Errors
    /// Numbers that are not finite.
    pub fn soft_bodies_at(&self, point: Vec2, filter: &SoftFilter<'_>) -> Result<Vec<SoftHandle>> {
        check::finite_vec("point", point)?;
        let holds = |(handle, body): (SoftHandle, &SoftBody)| body.holds(point).then_some(handle);
        Ok(self.soft_seen(filter).filter_map(holds).collect())
    }

    /// The deformable bodies that share a point with a box, in their order.
    ///
    /// # Errors
    /// Numbers that are not finite, a box whose corners are exchanged.
    pub fn soft_bodies_in(
        &self,
        region: &Aabb,
        filter: &SoftFilter<'_>,
    ) -> Result<Vec<SoftHandle>> {
        check::finite_vec("lower corner", region.min)?;
        check::finite_vec("upper corner", region.max)?;
        check::finite("square of the region's size", (region.max - region.min).norm_squared())?;
        if region.min.x > region.max.x || region.min.y > region.max.y {
            let allowed = "below those of the upper one";
            let got = format!("({}, {})", region.min.x, region.min.y);
            return Err(Error::invalid("coordinates of the lower corner", got, allowed));
        }
        let meets = |(handle, body): (SoftHandle, &SoftBody)| body.meets(region).then_some(handle);
        Ok(self.soft_seen(filter).filter_map(meets).collect())
    }

    /// The first deformable body that a ray from a point along a translation (m) hits. One that starts inside a body hits it there, at fraction
    /// 0, with a normal against the ray.
    ///
    /// # Errors
    /// Numbers that are not finite.
    pub fn cast_ray_soft(
        &self,
        from: Vec2,
        translation: Vec2,
        filter: &SoftFilter<'_>,
    ) -> Result<Option<SoftRayHit>> {
        check::finite_vec("start of the ray", from)?;
        check::finite_vec("way", translation)?;
        check::finite("square of the way's length", translation.norm_squared())?;
        let hits = self.soft_seen(filter).filter_map(|(body, soft)| {
            let (fraction, point, normal) = soft.ray(from, translation)?;
            Some(SoftRayHit { body, point, normal, fraction })
        });
        // The first of several at once.
        Ok(hits.reduce(|a, b| if b.fraction < a.fraction { b } else { a }))
    }

    /// The deformable body that is nearest to a point, within a distance (m).
    ///
    /// # Errors
    /// Numbers that are not finite, a distance below 0.
    pub fn nearest_soft(
        &self,
        point: Vec2,
        within: Real,
        filter: &SoftFilter<'_>,
    ) -> Result<Option<NearestSoft>> {
        check::finite_vec("point", point)?;
        if within != Real::INFINITY {
            check::not_negative("distance", within)?;
        }
        let all = self.soft_seen(filter).map(|(body, soft)| {
            let (nearest, distance) = soft.nearest_point(point);
            NearestSoft { body, point: nearest, distance }
        });
        let first = all.reduce(|a, b| if b.distance < a.distance { b } else { a });
        Ok(first.filter(|nearest| nearest.distance <= within))
    }
}

impl SoftBody {
    fn pieces(&self, from: Vec2) -> impl Iterator<Item = Geometry> + '_ {
        let radius = self.radius();
        self.def().mesh.border().iter().map(move |edge| {
            let ends = edge.map(|i| self.positions()[i as usize] - from);
            Geometry::Convex(Convex::new(ends.to_vec(), radius))
        })
    }

    fn box_of(&self) -> Aabb {
        bounds(self).grown(self.radius())
    }

    /// Whether a point is in it: around which its border winds; of an open rope, within its thickness.
    fn holds(&self, point: Vec2) -> bool {
        let own = self.box_of();
        own.overlaps(&Aabb { min: point, max: point })
            && (self.winds_around(point) || self.border_distance(point).1 <= 0.0)
    }

    /// Whether the border winds around a point. Rods of an open rope do not close.
    fn winds_around(&self, point: Vec2) -> bool {
        let mesh = self.def().mesh.border();
        let closed = self.def().mesh.rods().is_empty()
            || self.def().mesh.rods().len() == self.positions().len();
        let mut winds = 0;
        for edge in mesh {
            let [a, b] = edge.map(|i| self.positions()[i as usize] - point);
            let side = cross(a, b);
            if a.y <= 0.0 && b.y > 0.0 && side > 0.0 {
                winds += 1;
            } else if a.y > 0.0 && b.y <= 0.0 && side < 0.0 {
                winds -= 1;
            }
        }
        closed && winds != 0
    }

    /// The point of the border that is nearest (m), its thickness included, and how far that is (m), below 0 within the thickness.
    fn border_distance(&self, point: Vec2) -> (Vec2, Real) {
        let pieces = self.def().mesh.border().iter().map(|edge| {
            let [a, b] = edge.map(|i| self.positions()[i as usize]);
            let (way, from) = (b - a, point - a);
            let square = way.norm_squared();
            let part = if square > 0.0 { (way.dot(&from) / square).clamp(0.0, 1.0) } else { 0.0 };
            let off = from - way * part;
            (a + way * part, off, off.norm())
        });
        let none = (point, Vec2::zeros(), Real::INFINITY);
        let (foot, off, far) = pieces.fold(none, |a, b| if b.2 < a.2 { b } else { a });
        let out = if far > 0.0 { off / far } else { vec2(0.0, 1.0) };
        (foot + out * self.radius(), far - self.radius())
    }

    fn nearest_point(&self, point: Vec2) -> (Vec2, Real) {
        let (foot, distance) = self.border_distance(point);
        if distance <= 0.0 || self.winds_around(point) { (point, 0.0) } else { (foot, distance) }
    }

    fn meets(&self, region: &Aabb) -> bool {
        if !self.box_of().overlaps(region) {
            return false;
        }
        let size = region.max - region.min;
        let corners = [Vec2::zeros(), vec2(size.x, 0.0), size, vec2(0.0, size.y)];
        let corners = match (size.x > 0.0, size.y > 0.0) {
            (true, true) => corners.to_vec(),
            (false, false) => vec![Vec2::zeros()],
            _ => vec![Vec2::zeros(), size],
        };
        let geometry = Geometry::Convex(Convex::new(corners, 0.0));
        self.winds_around(region.min)
            || self.pieces(region.min).any(|piece| overlap(&geometry, &piece, &Frame::IDENTITY))
    }

    fn ray(&self, from: Vec2, translation: Vec2) -> Option<(Real, Vec2, Vec2)> {
        let end = from + translation;
        let swept = Aabb { min: from.inf(&end), max: from.sup(&end) };
        if !self.box_of().overlaps(&swept) {
            return None;
        }
        if self.holds(from) {
            let length = translation.norm();
            let normal = if length > 0.0 { -translation / length } else { vec2(0.0, 1.0) };
            return Some((0.0, from, normal));
        }
        let hits =
            self.pieces(from).filter_map(|piece| cast_ray(&piece, Vec2::zeros(), translation));
        let first = hits.reduce(|a, b| if b.fraction < a.fraction { b } else { a })?;
        Some((first.fraction, from + first.point, first.normal))
    }
}
