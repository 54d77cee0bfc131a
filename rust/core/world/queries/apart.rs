//! How far things are apart.

use super::{Asked, Placed, QueryFilter, ShapeId, checked_limit};
use crate::body::BodyHandle;
use crate::collision::{Closest, Collider, Convex, Frame, Geometry, distance, distance_to_point};
use crate::error::{Error, Result, check};
use crate::math::{Pose, Real, Vec2};
use crate::shapes::{Aabb, Shape};
use crate::world::World;

/// The shape that is nearest to a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Nearest {
    /// The body.
    pub body: BodyHandle,
    /// Which of its shapes, counted from 0.
    pub part: usize,
    /// Its point that is nearest (m): the point that was asked for, if the shape holds it.
    pub point: Vec2,
    /// How far that is (m): 0 if the shape holds the point.
    pub distance: Real,
}

impl World {
    /// The shape that is nearest to a point, if one is within `max_distance` (m, may be infinite); of several
    /// as near the first in body order.
    ///
    /// # Errors
    /// Numbers that are not finite, a distance below 0, bodies to exclude that are gone.
    pub fn nearest(
        &self,
        point: Vec2,
        max_distance: Real,
        filter: &QueryFilter<'_>,
    ) -> Result<Option<Nearest>> {
        check::finite_vec("point", point)?;
        checked_limit("max_distance", max_distance)?;
        Ok(self.ask(filter)?.nearest(point, max_distance))
    }

    /// How far two bodies are apart, and where they are nearest (in the world). Filters and roles play no part; a
    /// body without shapes is a point.
    ///
    /// Where they overlap the distance is below 0: minus the most that a convex piece of one has to move to be
    /// clear of a piece of the other.
    ///
    /// # Errors
    /// Bodies that are gone, and one body given twice.
    pub fn distance(&self, a: BodyHandle, b: BodyHandle) -> Result<Closest> {
        let (i, j) = (self.state.bodies.index(a)?, self.state.bodies.index(b)?);
        if i == j {
            return Err(Error::invalid("the other body", "the same body", "another one"));
        }
        let point = Geometry::Convex(Convex::new(vec![Vec2::zeros()], 0.0));
        let pieces = |body: usize| -> Vec<&Geometry> {
            let own = self.state.contacts.of_body(body);
            let mut pieces: Vec<_> = own.map(|entry| &entry.collider.geometry).collect();
            if pieces.is_empty() {
                pieces.push(&point);
            }
            pieces
        };
        let frame = |body: usize| Frame::of(&self.state.bodies.poses[body]);
        Ok(closest((&pieces(i), &frame(i)), (&pieces(j), &frame(j))))
    }
}

/// How far two shapes are apart whose frames are at these poses, as [`World::distance`] says it of bodies.
///
/// # Errors
/// Poses that are not finite.
pub fn distance_between(
    (a, pose_a): (&Shape, &Pose),
    (b, pose_b): (&Shape, &Pose),
) -> Result<Closest> {
    let (a, b) = (Placed::new(a, pose_a)?, Placed::new(b, pose_b)?);
    let [of_a, of_b] = [&a, &b].map(|placed| placed.pieces.iter().collect::<Vec<_>>());
    Ok(closest((&of_a, &Frame::of(&a.pose)), (&of_b, &Frame::of(&b.pose))))
}

/// The nearest of all pairs of pieces; pairs whose boxes are farther apart are passed by.
fn closest(
    (of_a, frame_a): (&[&Geometry], &Frame),
    (of_b, frame_b): (&[&Geometry], &Frame),
) -> Closest {
    let b_in_a = frame_b.seen_from(frame_a);
    let boxes: Vec<Aabb> = of_b.iter().map(|b| b.bounds_at(&b_in_a)).collect();
    let none = Closest {
        distance: Real::INFINITY,
        on_a: Vec2::zeros(),
        on_b: Vec2::zeros(),
        normal: Vec2::x(),
    };
    let mut best = none;
    for a in of_a {
        let around = a.bounds_at(&Frame::IDENTITY);
        for (b, other) in of_b.iter().zip(&boxes) {
            if around.distance(other) > best.distance.max(0.0) {
                continue;
            }
            let found = distance(a, b, &b_in_a);
            if found.distance < best.distance {
                best = found;
            }
        }
    }
    let [on_a, on_b] = [best.on_a, best.on_b].map(|point| frame_a.apply(point));
    Closest { on_a, on_b, normal: frame_a.rot.apply(best.normal), ..best }
}

impl Asked<'_> {
    fn nearest(&self, point: Vec2, max_distance: Real) -> Option<Nearest> {
        let mut best: Option<((Real, u32, u32), Nearest)> = None;
        let here = Aabb { min: point, max: point };
        let contacts = &self.state.contacts;
        contacts.nearest(self.strays, &here, max_distance, &mut |entry, limit| {
            let collider = &entry.collider;
            if !self.sees(entry) {
                return limit;
            }
            let (distance, at) = self.nearest_of(collider, point);
            let order = (distance, collider.body, collider.part);
            if distance.is_nan()
                || distance > limit
                || best.is_some_and(|(before, _)| before <= order)
            {
                return limit;
            }
            let ShapeId { body, part } = self.id(collider);
            best = Some((order, Nearest { body, part, point: at, distance }));
            distance
        });
        best.map(|(_, nearest)| nearest)
    }

    /// How far a point is from a collider, and the point of it that is nearest.
    fn nearest_of(&self, collider: &Collider, point: Vec2) -> (Real, Vec2) {
        let frame = self.frame(collider);
        let closest = distance_to_point(&collider.geometry, frame.apply_inverse(point));
        if closest.distance <= 0.0 {
            (0.0, point)
        } else {
            (closest.distance, frame.apply(closest.on_a))
        }
    }
}
