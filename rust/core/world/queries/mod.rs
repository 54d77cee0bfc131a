//! What is where in a world: rays, points, regions, shapes that move, distances.
//!
//! Queries see the bodies where they are at the call, however they came there, and change nothing: a world steps
//! on to the same bits whether it was asked or not. Each looks at few bodies, by trees of boxes. The first one
//! after a step looks once at each body that moves, whether it has left its box (some 0.2 µs each); bodies that
//! are static or were set by hand cost nothing more.
//!
//! Shapes are solid, borders included; wires hold no point and are met from both sides. What touches up to
//! rounding may count or not. Sensors are seen if [`QueryFilter::sensors`] says so.

mod apart;
mod casts;
mod regions;

pub use apart::{Nearest, distance_between};
pub use casts::RayHit;

use crate::body::{BodyHandle, Part, Role};
use crate::collision::{Collider, Frame, Geometry, colliders};
use crate::error::{Result, check};
use crate::math::{Pose, Real, Vec2};
use crate::shapes::{Aabb, Shape};
use crate::world::contacts::{Entry, Strays};
use crate::world::{State, World};

/// A shape of a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct ShapeId {
    /// The body.
    pub body: BodyHandle,
    /// Which of its shapes, counted from 0.
    pub part: usize,
}

/// Which shapes a query sees. The default sees all but sensors.
#[derive(Clone, Copy, Default)]
pub struct QueryFilter<'a> {
    /// Bits of the categories that are seen; none: all. A shape's own mask plays no part in this.
    pub mask: Option<u32>,
    /// Bits of the categories the query belongs to: it sees only shapes with one of them in their masks.
    pub category: Option<u32>,
    /// Group, if not 0: shapes of the same one are all seen if it is above 0, and none if it is below.
    pub group: i32,
    /// Whether sensors are seen.
    pub sensors: bool,
    /// Bodies that are not seen.
    pub exclude: &'a [BodyHandle],
    /// A shape is seen only if this says so.
    pub predicate: Option<&'a dyn Fn(ShapeId) -> bool>,
}

/// Keeping up with the bodies.
impl World {
    /// Takes note that the place of a body was set.
    pub(super) fn placed(&mut self, body: usize) {
        self.disturbed(body);
        let State { contacts, bodies, .. } = &mut self.state;
        contacts.touch(body);
        if let Some(strays) = self.strays.get_mut() {
            strays.follow(contacts, bodies, body);
        }
    }

    /// Takes note that detection is about to forget a body.
    pub(super) fn forget_strays(&mut self, body: usize) {
        if let Some(strays) = self.strays.get_mut() {
            strays.forget(&self.state.contacts, body);
        }
    }

    /// What has left the boxes of detection.
    fn strays(&self) -> &Strays {
        self.strays.get_or_init(|| {
            let State { contacts, bodies, .. } = &self.state;
            match &self.plan {
                Some(plan) => Strays::among(contacts, bodies, plan.moving()),
                None => Strays::among(contacts, bodies, 0..bodies.len()),
            }
        })
    }

    /// Begins a query.
    fn ask<'a>(&'a self, filter: &'a QueryFilter<'a>) -> Result<Asked<'a>> {
        let index = |body: &BodyHandle| self.state.bodies.index(*body);
        let excluded = filter.exclude.iter().map(index).collect::<Result<_>>()?;
        Ok(Asked { state: &self.state, strays: self.strays(), filter, excluded })
    }
}

/// A query under way.
struct Asked<'a> {
    state: &'a State,
    strays: &'a Strays,
    filter: &'a QueryFilter<'a>,
    excluded: Vec<usize>,
}

impl Asked<'_> {
    /// Whether a collider is seen.
    fn sees(&self, entry: &Entry) -> bool {
        let QueryFilter { mask, category, group, sensors, predicate, .. } = *self.filter;
        let own = &entry.filter;
        let by_bits = if group != 0 && group == own.group {
            group > 0
        } else {
            mask.is_none_or(|mask| own.category & mask != 0)
                && category.is_none_or(|category| own.mask & category != 0)
        };
        by_bits
            && (sensors || entry.role != Role::Sensor)
            && !self.excluded.contains(&(entry.collider.body as usize))
            && predicate.is_none_or(|predicate| predicate(self.id(&entry.collider)))
    }

    fn id(&self, collider: &Collider) -> ShapeId {
        let body = self.state.bodies.handles()[collider.body as usize];
        ShapeId { body, part: collider.part as usize }
    }

    /// Where the body of a collider is.
    fn pose(&self, collider: &Collider) -> &Pose {
        &self.state.bodies.poses[collider.body as usize]
    }

    fn frame(&self, collider: &Collider) -> Frame {
        Frame::of(self.pose(collider))
    }

    /// The shape a collider is of, and the centre of mass in its frame.
    fn shape(&self, collider: &Collider) -> (&Shape, Vec2) {
        let (body, bodies) = (collider.body as usize, &self.state.bodies);
        let part = &bodies.infos[body].def.shapes[collider.part as usize];
        (&part.shape, bodies.local_centers[body])
    }
}

/// A shape at a place, in its pieces.
struct Placed {
    pieces: Vec<Geometry>,
    /// Of the shape's centroid.
    pose: Pose,
    bounds: Aabb,
}

impl Placed {
    /// The shape of a body whose frame would be at `pose`.
    fn new(shape: &Shape, pose: &Pose) -> Result<Self> {
        check::finite_vec("position", pose.position)?;
        check::finite("angle", pose.angle)?;
        let center = shape.centroid();
        let all = colliders(0, &[Part::from(shape.clone())], center);
        let pieces: Vec<_> = all.into_iter().map(|collider| collider.geometry).collect();
        let pose = Pose::new(pose.apply(center), pose.angle);
        Ok(Self { bounds: bounds(&pieces, &Frame::of(&pose)), pieces, pose })
    }
}

/// The box around all pieces.
fn bounds(pieces: &[Geometry], frame: &Frame) -> Aabb {
    let boxes = pieces.iter().map(|piece| piece.bounds_at(frame));
    // OK because shapes have pieces; the place alone stands for what cannot be.
    let none = Aabb { min: frame.position, max: frame.position };
    boxes.reduce(|a, b| a.merged(&b)).unwrap_or(none)
}

/// A distance that may be infinite.
fn checked_limit(what: &str, x: Real) -> Result<Real> {
    if x >= 0.0 { Ok(x) } else { check::not_negative(what, x) }
}
