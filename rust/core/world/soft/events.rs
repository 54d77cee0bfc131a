//! What deformable bodies touch, and what begins and ends to touch them.

use serde::{Deserialize, Serialize};

use super::Softs;
use super::advance::Members;
use crate::body::{Bodies, BodyHandle};
use crate::constraints::Matter;
use crate::constraints::matter::{Point, Side};
use crate::math::{Real, Vec2};
use crate::methods::contact_step::Group;
use crate::soft::SoftHandle;
use crate::world::World;

/// What a deformable body touches.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Touched {
    /// A shape of a body, counted from 0.
    Body(BodyHandle, usize),
    /// A deformable body; of one that touches itself, that one.
    Soft(SoftHandle),
}

/// A deformable body and something else that touch, or that began to, ended to, or hit one another. A body may have been removed since.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct SoftContact {
    /// World time (s) at the end of the step.
    pub time: Real,
    /// The deformable body; of two, the one that was added first.
    pub soft: SoftHandle,
    /// What it touches.
    pub other: Touched,
    /// Where most of the load is, or where they are nearest (m).
    pub point: Vec2,
    /// Unit vector from the deformable body to the other there.
    pub normal: Vec2,
    /// How fast they came together along the normal at the fastest point (m/s). Of hits; 0 else.
    pub approach_speed: Real,
    /// Along the normals over the step (N·s).
    pub impulse: Real,
}

/// What happened to deformable bodies during a call, in the order of time.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SoftEvents {
    /// Pairs that began to touch.
    pub begin: Vec<SoftContact>,
    /// Pairs that no longer touch, with what was last known of them.
    pub end: Vec<SoftContact>,
    /// Pairs that began to touch faster than the forces of a substep make them.
    pub hit: Vec<SoftContact>,
}

impl SoftEvents {
    pub(in crate::world) fn clear(&mut self) {
        [&mut self.begin, &mut self.end, &mut self.hit].into_iter().for_each(Vec::clear);
    }
}

/// What points of a pair did in a substep.
#[derive(Clone, Copy, Debug)]
pub struct Touch {
    /// The deformable body by its place, and what it touches.
    pub pair: (u32, Other),
    /// In the last substep of the step, whether it touches.
    closed: bool,
    /// Normal impulse of the fullest point, and of all (N·s).
    most: Real,
    impulse: Real,
    point: Vec2,
    normal: Vec2,
    approach: Real,
    /// Speed that the substep's own forces give (m/s).
    kick: Real,
}

/// What is touched: a body and its shape, or a deformable body, by places.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Other {
    Body(u32, u32),
    Soft(u32),
}

impl Touch {
    /// One point of it.
    pub fn new(
        (pair, point): ((u32, Other), &Point),
        members: &mut Members<'_>,
        (group, h): (&Group, Real),
    ) -> Self {
        let mut before = Vec2::zeros();
        let (mut place, mut kick) = (None, Vec2::zeros());
        for (side, sign) in point.sides.iter().zip([-1.0, 1.0]) {
            match *side {
                Side::Body(slot, arm) => {
                    let own = group.places[slot as usize].kick(h);
                    kick += own.linear * sign;
                    before += group.before(slot, h).at(arm) * sign;
                }
                Side::Nodes(k, nodes, weights) => {
                    let (body, pull) = members.body_of(k);
                    kick += pull * (h * sign);
                    for (node, weight) in nodes.iter().zip(weights).filter(|(_, w)| *w != 0.0) {
                        before += Matter::velocities(body, *node)[0] * (sign * weight);
                    }
                    let of = |n: usize| body.place(nodes[n]) * weights[n];
                    let foot = of(0) + of(1) - point.normal * (sign * body.radius());
                    place.get_or_insert(foot);
                }
            }
        }
        let impulse = point.grip.impulse[0];
        Self {
            pair,
            closed: impulse > 0.0 || point.gap <= 0.0,
            most: impulse,
            impulse,
            point: place.unwrap_or_default(),
            normal: point.normal,
            approach: -point.normal.dot(&before),
            kick: point.normal.dot(&kick).abs(),
        }
    }

    /// Adds what another point of the pair did, in the same substep or a later one.
    pub fn join(&mut self, other: &Self) {
        self.closed |= other.closed;
        self.impulse += other.impulse;
        if other.most > self.most {
            (self.most, self.point, self.normal) = (other.most, other.point, other.normal);
        }
        if other.approach > self.approach {
            (self.approach, self.kick) = (other.approach, other.kick);
        }
    }

    /// Begins another substep.
    pub fn open(&mut self) {
        self.closed = false;
    }
}

impl World {
    /// What began and ended to touch deformable bodies, and what hit them, during the last call that moved the world on.
    #[must_use]
    pub fn soft_events(&self) -> &SoftEvents {
        &self.state.softs.events
    }

    /// What touches deformable bodies after the last step.
    #[must_use]
    pub fn soft_contacts(&self) -> &[SoftContact] {
        &self.state.softs.contacts
    }

    /// Tells what began and ended to touch in a step.
    pub(in crate::world) fn notice_softs(&mut self) {
        let time = self.time();
        let Self { state, scratch, .. } = self;
        let touches = &mut scratch.soft.touches;
        touches.sort_by_key(|touch| touch.pair);
        touches.dedup_by(|later, first| {
            let same = later.pair == first.pair;
            if same {
                first.join(later);
            }
            same
        });
        state.softs.notice(&state.bodies, touches, time);
    }
}

impl Softs {
    fn notice(&mut self, bodies: &Bodies, touches: &[Touch], time: Real) {
        let Self { bodies: softs, events, contacts, .. } = self;
        let before = std::mem::take(contacts);
        let handles = softs.handles();
        let named = touches.iter().map(|touch| {
            let other = match touch.pair.1 {
                Other::Body(body, part) => {
                    Touched::Body(bodies.handles()[body as usize], part as usize)
                }
                Other::Soft(soft) => Touched::Soft(handles[soft as usize]),
            };
            let contact = SoftContact {
                time,
                soft: handles[touch.pair.0 as usize],
                other,
                point: touch.point,
                normal: touch.normal,
                approach_speed: 0.0,
                impulse: touch.impulse,
            };
            (contact, touch)
        });
        let same = |a: &SoftContact, b: &SoftContact| (a.soft, a.other) == (b.soft, b.other);
        for (contact, touch) in named {
            let known = before.iter().any(|old| same(old, &contact));
            if !known && touch.impulse > 0.0 && touch.approach > touch.kick * (1.0 + 1e-6) {
                events.hit.push(SoftContact { approach_speed: touch.approach, ..contact });
            }
            if touch.closed {
                if !known {
                    events.begin.push(contact);
                }
                contacts.push(contact);
            }
        }
        let gone = before.iter().filter(|old| !contacts.iter().any(|now| same(old, now)));
        events.end.extend(gone.map(|old| SoftContact { time, impulse: 0.0, ..*old }));
    }
}
