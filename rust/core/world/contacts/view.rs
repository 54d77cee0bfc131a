//! Contacts as a user sees them.

use super::near::Kind;
use super::{Contacts, Near, Patch};
use crate::body::{Bodies, BodyHandle};
use crate::collision::{Frame, Manifold};
use crate::constraints::Place;
use crate::constraints::contact::moved;
use crate::error::Result;
use crate::math::{Pose, Real, Twist, Vec2, perp, vec2};
use crate::world::{State, World};

/// Where two bodies touch: one or two points with one normal. Of a pair of shapes there may be several.
///
/// The body whose slot is smaller comes first, as in events.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Contact {
    /// A and B.
    pub bodies: [BodyHandle; 2],
    /// Their places in body order.
    pub indices: [usize; 2],
    /// Which shape of each, counted from 0.
    pub parts: [usize; 2],
    /// Unit vector from A to B.
    pub normal: Vec2,
    /// Number of points, 1 or 2.
    pub count: usize,
    /// The points (m), half-way between the surfaces; only the first `count` hold.
    pub points: [Vec2; 2],
    /// Gaps at the points (m), below 0 where the surfaces overlap.
    pub gaps: [Real; 2],
    /// Impulses (N·s) on B along the normal at each point, in the last substep.
    pub normal_impulses: [Real; 2],
    /// Impulse (N·s) on B along the normal turned by a quarter turn counter-clockwise, in the last substep.
    pub tangential_impulse: Real,
    /// Whether the surfaces slid.
    pub sliding: bool,
    /// Length of the substep that the impulses are of (s).
    pub substep: Real,
}

impl Contact {
    /// Unit vector along the surfaces: the normal turned by a quarter turn counter-clockwise.
    #[must_use]
    pub fn tangent(&self) -> Vec2 {
        perp(self.normal)
    }

    /// Impulse on B in the last substep (N·s); that on A is its opposite.
    #[must_use]
    pub fn impulse(&self) -> Vec2 {
        let [first, second] = self.normal_impulses;
        self.normal * (first + second) + self.tangent() * self.tangential_impulse
    }

    /// Mean force on B over the last substep (N); that on A is its opposite.
    #[must_use]
    pub fn force(&self) -> Vec2 {
        if self.substep > 0.0 { self.impulse() / self.substep } else { vec2(0.0, 0.0) }
    }

    fn flipped(self) -> Self {
        let Self { indices: [i, j], normal, .. } = self;
        Self { indices: [j, i], normal: -normal, ..self }
    }
}

/// Where a manifold is: normal, points from A's centre of mass, gaps.
pub(super) struct Seen {
    pub normal: Vec2,
    pub points: [Vec2; 2],
    pub gaps: [Real; 2],
}

/// A manifold where its bodies are now.
pub(super) fn seen(manifold: &Manifold, poses: [&Pose; 2]) -> Seen {
    let frames = poses.map(Frame::of);
    let apart = frames[1].position - frames[0].position;
    let at = moved(manifold, apart, [&place_of(&frames[0]), &place_of(&frames[1])]);
    let points = [0, 1].map(|k| at.surface_point(manifold, k));
    Seen { normal: at.normal, points, gaps: at.gap }
}

/// A body that has not moved yet.
pub(super) fn place_of(frame: &Frame) -> Place {
    Place { way: vec2(0.0, 0.0), turn: 0.0, rot: frame.rot, acceleration: Twist::ZERO }
}

impl Contacts {
    fn view(&self, near: &Near, patch: &Patch, bodies: &Bodies) -> Contact {
        let indices = near.proxies.map(|proxy| self.body_of(proxy) as usize);
        let poses = indices.map(|i| &bodies.poses[i]);
        let seen = seen(&patch.manifold, poses);
        let (pair, flipped) = self.shapes_of(near, bodies.handles());
        let memory = &patch.memory;
        let contact = Contact {
            bodies: pair.bodies,
            indices,
            parts: pair.parts.map(|part| part as usize),
            normal: seen.normal,
            count: patch.manifold.count,
            points: seen.points.map(|point| poses[0].position + point),
            gaps: seen.gaps,
            normal_impulses: [memory.impulse[0], memory.impulse[1]],
            // The tangent turns with the normal and the impulse is on the other body: its sign stays.
            tangential_impulse: memory.impulse[2],
            sliding: memory.sliding,
            substep: self.substep,
        };
        if flipped { contact.flipped() } else { contact }
    }

    fn views<'a>(
        &'a self,
        bodies: &'a Bodies,
        wanted: impl Fn(&Near) -> bool + 'a,
    ) -> impl Iterator<Item = Contact> + 'a {
        let resists = |near: &Near| near.touching && near.kind != Kind::Sensor;
        let awake = self.near.iter().map(|near| (near, self.patches_of(near)));
        let pairs =
            awake.chain(self.sleep.pairs()).filter(move |(near, _)| resists(near) && wanted(near));
        let all = pairs.flat_map(|(near, patches)| patches.iter().map(move |p| (near, p)));
        let closed = |(near, patch): &(&Near, &Patch)| {
            near.count == 1 || patch.memory.impulse[0] + patch.memory.impulse[1] > 0.0
        };
        all.filter(closed).map(|(near, patch)| self.view(near, patch, bodies))
    }
}

/// What touches now.
impl World {
    /// All contacts: where solid shapes touched after the last step. Points and gaps follow bodies that were put
    /// elsewhere since; impulses are those of the last substep.
    #[must_use]
    pub fn contacts(&self) -> Vec<Contact> {
        self.state.contacts.views(&self.state.bodies, |_| true).collect()
    }

    /// Deepest overlap of two shapes that touch (m); 0 where none do.
    #[must_use]
    pub fn overlap(&self) -> Real {
        let views = self.state.contacts.views(&self.state.bodies, |_| true);
        let deepest = |contact: Contact| {
            contact.gaps[..contact.count].iter().map(|gap| -gap).fold(0.0, Real::max)
        };
        views.map(deepest).fold(0.0, Real::max)
    }

    /// The contacts of one body.
    ///
    /// # Errors
    /// [`crate::Error::StaleHandle`] for a body that is gone.
    pub fn contacts_of(&self, body: BodyHandle) -> Result<Vec<Contact>> {
        let contacts = &self.state.contacts;
        let index = self.state.bodies.index(body)? as u32;
        let of_body = move |near: &Near| near.proxies.iter().any(|p| contacts.body_of(*p) == index);
        Ok(contacts.views(&self.state.bodies, of_body).collect())
    }

    /// Shapes that a sensor of this body, or this body in a sensor, overlaps after the last step: the other body and
    /// its shape.
    ///
    /// # Errors
    /// [`crate::Error::StaleHandle`] for a body that is gone.
    pub fn overlaps_of(&self, body: BodyHandle) -> Result<Vec<(BodyHandle, usize)>> {
        let State { bodies, contacts, .. } = &self.state;
        bodies.index(body)?;
        let sensed = contacts
            .near
            .iter()
            .chain(contacts.sleep.near())
            .filter(|near| near.kind == Kind::Sensor && near.touching);
        let mut found = Vec::new();
        for near in sensed {
            let pair = contacts.shapes_of(near, bodies.handles()).0;
            let Some(own) = pair.bodies.iter().position(|other| *other == body) else { continue };
            let other = (pair.bodies[1 - own], pair.parts[1 - own] as usize);
            if !found.contains(&other) {
                found.push(other);
            }
        }
        Ok(found)
    }
}
