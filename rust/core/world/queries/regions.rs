//! What is at a point, in a box, or under a shape.

use super::{Asked, Placed, QueryFilter, ShapeId};
use crate::collision::{Collider, Convex, Frame, Geometry, overlap};
use crate::error::{Error, Result, check};
use crate::math::{Pose, Rot, Vec2, vec2};
use crate::shapes::{Aabb, Shape};
use crate::world::World;
use crate::world::contacts::Entry;

/// What is where. Answers are in body order, each shape once.
impl World {
    /// The shapes that hold a point, borders included.
    ///
    /// # Errors
    /// Numbers that are not finite, bodies to exclude that are gone.
    pub fn shapes_at(&self, point: Vec2, filter: &QueryFilter<'_>) -> Result<Vec<ShapeId>> {
        check::finite_vec("point", point)?;
        let asked = self.ask(filter)?;
        Ok(asked.gather(&Aabb { min: point, max: point }, &|collider| {
            let (shape, center) = asked.shape(collider);
            shape.contains(asked.frame(collider).apply_inverse(point) + center)
        }))
    }

    /// The shapes that share a point with a box.
    ///
    /// # Errors
    /// As [`World::shapes_at`], and for a box whose corners are exchanged.
    pub fn shapes_in(&self, region: &Aabb, filter: &QueryFilter<'_>) -> Result<Vec<ShapeId>> {
        let mut found = Vec::new();
        let asked = self.ask(filter)?;
        asked.visit_region(region, &mut |entry| {
            found.push(key(entry));
            true
        })?;
        Ok(asked.named(found))
    }

    /// The shapes whose own boxes along the axes share a point with a box: less exact than
    /// [`World::shapes_in`], and faster where shapes have many corners.
    ///
    /// # Errors
    /// As [`World::shapes_in`].
    pub fn boxes_in(&self, region: &Aabb, filter: &QueryFilter<'_>) -> Result<Vec<ShapeId>> {
        checked(region)?;
        let asked = self.ask(filter)?;
        Ok(asked.gather(region, &|collider| {
            let (shape, _) = asked.shape(collider);
            let frame = asked.state.bodies.origin(collider.body as usize);
            shape.bounds_at(&frame).overlaps(region)
        }))
    }

    /// Calls `found` with the shapes of [`World::shapes_in`], in no certain order, and once for each piece of a
    /// shape that has several, until it says no.
    ///
    /// # Errors
    /// As [`World::shapes_in`].
    pub fn visit_region(
        &self,
        region: &Aabb,
        filter: &QueryFilter<'_>,
        found: &mut dyn FnMut(ShapeId) -> bool,
    ) -> Result<()> {
        let asked = self.ask(filter)?;
        asked.visit_region(region, &mut |entry| found(asked.id(&entry.collider)))
    }

    /// The shapes that share a point with a shape at a pose (of the frame it is given in).
    ///
    /// # Errors
    /// As [`World::shapes_at`].
    pub fn overlapping(
        &self,
        shape: &Shape,
        pose: &Pose,
        filter: &QueryFilter<'_>,
    ) -> Result<Vec<ShapeId>> {
        let placed = Placed::new(shape, pose)?;
        let frame = Frame::of(&placed.pose);
        let asked = self.ask(filter)?;
        Ok(asked.gather(&placed.bounds, &|collider| {
            let other = asked.frame(collider).seen_from(&frame);
            placed.pieces.iter().any(|piece| overlap(piece, &collider.geometry, &other))
        }))
    }
}

/// Body and shape of a collider.
fn key(entry: &Entry) -> (u32, u32) {
    (entry.collider.body, entry.collider.part)
}

impl Asked<'_> {
    /// The shapes with a collider whose box meets `aabb` and of which `holds` is true.
    fn gather(&self, aabb: &Aabb, holds: &dyn Fn(&Collider) -> bool) -> Vec<ShapeId> {
        let mut found = Vec::new();
        self.state.contacts.query(self.strays, aabb, &mut |entry| {
            if self.sees(entry) && holds(&entry.collider) {
                found.push(key(entry));
            }
            true
        });
        self.named(found)
    }

    fn named(&self, mut found: Vec<(u32, u32)>) -> Vec<ShapeId> {
        found.sort_unstable();
        found.dedup();
        let handles = self.state.bodies.handles();
        let name = |(body, part)| ShapeId { body: handles[body as usize], part: part as usize };
        found.into_iter().map(name).collect()
    }

    fn visit_region(&self, region: &Aabb, found: &mut dyn FnMut(&Entry) -> bool) -> Result<()> {
        checked(region)?;
        let (geometry, frame) = solid(region);
        self.state.contacts.query(self.strays, region, &mut |entry| {
            let collider = &entry.collider;
            let other = self.frame(collider).seen_from(&frame);
            let meets = self.sees(entry) && overlap(&geometry, &collider.geometry, &other);
            !meets || found(entry)
        });
        Ok(())
    }
}

fn checked(region: &Aabb) -> Result<()> {
    check::finite_vec("lower corner", region.min)?;
    check::finite_vec("upper corner", region.max)?;
    check::finite("square of the region's size", (region.max - region.min).norm_squared())?;
    for (axis, name) in ["x", "y"].into_iter().enumerate() {
        let (low, high) = (region.min[axis], region.max[axis]);
        if low > high {
            let what = format!("{name} of the lower corner");
            return Err(Error::invalid(what, low, format!("up to that of the upper one, {high}")));
        }
    }
    Ok(())
}

/// A box as a shape, from its lower corner. It may be a point or a line.
fn solid(region: &Aabb) -> (Geometry, Frame) {
    let size = region.max - region.min;
    let corners = match (size.x > 0.0, size.y > 0.0) {
        (true, true) => vec![Vec2::zeros(), vec2(size.x, 0.0), size, vec2(0.0, size.y)],
        (false, false) => vec![Vec2::zeros()],
        _ => vec![Vec2::zeros(), size],
    };
    let frame = Frame { position: region.min, rot: Rot::IDENTITY };
    (Geometry::Convex(Convex::new(corners, 0.0)), frame)
}
