//! Which shapes touch: seen after each step, told as events when it changes.

use std::collections::HashMap;

use rustc_hash::FxBuildHasher;
use serde::{Deserialize, Serialize};

use super::events::{ContactEvent, Events};
use super::near::Kind;
use super::order::upwards;
use super::view::place_of;
use super::{Contacts, Near};
use crate::body::{Bodies, BodyHandle, Role};
use crate::collision::{Frame, Manifold, ProxyId, collide, distance};
use crate::constraints::contact::moved;
use crate::math::{Real, Vec2};
use crate::methods::events::Touch;
use crate::world::World;

/// A gap below this part of the smaller width is none: where a touch begins, and where it ends. Rounding does not
/// end what it did not begin.
const CLOSED: Real = 1e-9;
const OPEN: Real = 1e-6;

/// Two shapes, in the order in which events name them.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub(in crate::world) struct ShapePair {
    pub bodies: [BodyHandle; 2],
    pub parts: [u32; 2],
    pub sensor: bool,
}

/// Where a touch began, and with what impulse.
type Spot = Option<(Vec2, Vec2, Real)>;

/// How many pieces of two shapes touch, and whether an event has told that they do.
#[derive(Clone, Copy, Debug, Default)]
struct Told {
    pieces: u32,
    told: bool,
}

/// A change that is not told yet.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(in crate::world) struct Change {
    pair: ShapePair,
    told: bool,
    spot: Spot,
}

/// Shapes that touch. Asked by pair, never listed, so that no order depends on hashes.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(in crate::world) struct Touching {
    #[serde(skip)]
    pairs: HashMap<ShapePair, Told, FxBuildHasher>,
    /// Since the last step: by bodies that were removed or edited; else empty.
    changes: Vec<Change>,
}

impl Touching {
    /// Whether there is something to tell.
    pub fn changed(&self) -> bool {
        !self.changes.is_empty()
    }

    /// What is not told yet.
    pub fn changes(&self) -> &[Change] {
        &self.changes
    }

    /// Goes back to changes that were not told before a call that failed.
    pub fn set_changes(&mut self, changes: &[Change]) {
        self.changes.clear();
        self.changes.extend_from_slice(changes);
    }

    /// One piece more touches, or one less.
    fn count(&mut self, pair: ShapePair, touches: bool, spot: Spot) {
        let entry = self.pairs.entry(pair).or_default();
        self.changes.push(Change { pair, told: entry.told, spot });
        entry.pieces = if touches { entry.pieces + 1 } else { entry.pieces.saturating_sub(1) };
    }

    fn tell(&mut self, time: Real, events: &mut Events) {
        for Change { pair, spot, .. } in self.changes.drain(..) {
            let Some(entry) = self.pairs.get_mut(&pair) else { continue };
            let begins = entry.pieces > 0;
            if begins != entry.told {
                entry.told = begins;
                let list = match (pair.sensor, begins) {
                    (false, true) => &mut events.begin,
                    (false, false) => &mut events.end,
                    (true, true) => &mut events.sensor_begin,
                    (true, false) => &mut events.sensor_end,
                };
                list.push(pair.event(time, if begins { spot } else { None }));
            }
            if !begins {
                self.pairs.remove(&pair);
            }
        }
    }
}

impl ShapePair {
    pub fn event(&self, time: Real, spot: Spot) -> ContactEvent {
        ContactEvent {
            time,
            bodies: self.bodies,
            parts: self.parts.map(|part| part as usize),
            point: spot.map(|(point, ..)| point),
            normal: spot.map(|(_, normal, _)| normal),
            approach_speed: 0.0,
            impulse: spot.map_or(0.0, |(.., impulse)| impulse),
        }
    }
}

impl World {
    /// Tells what began and ended to touch on the way from event to event, in the order of time.
    pub(in crate::world) fn notice_located(&mut self, mut touched: Vec<([ProxyId; 2], Touch)>) {
        let Self { state, events, .. } = self;
        let (handles, contacts) = (state.bodies.handles(), &mut state.contacts);
        touched.sort_by(|(_, a), (_, b)| a.time.total_cmp(&b.time));
        let places: HashMap<[ProxyId; 2], usize, FxBuildHasher> =
            contacts.near.iter().enumerate().map(|(place, near)| (near.proxies, place)).collect();
        for (proxies, touch) in touched {
            let Some(place) = places.get(&proxies).copied() else { continue };
            if contacts.near[place].touching == touch.touches {
                continue;
            }
            contacts.near[place].touching = touch.touches;
            let (pair, flipped) = contacts.shapes_of(&contacts.near[place], handles);
            let spot = touch.spot.map(|(point, n)| (point, if flipped { -n } else { n }, 0.0));
            contacts.touching.count(pair, touch.touches, spot);
            contacts.touching.tell(touch.time, events);
        }
    }

    /// The stage that tells what began and ended to touch in a step.
    pub(in crate::world) fn notice(&mut self) {
        let Self { state, scratch, events, .. } = self;
        let (bodies, contacts) = (&state.bodies, &mut state.contacts);
        contacts.see_touching(bodies, state.settings.gravity, &mut scratch.contacts);
        let time = state.clock.now;
        contacts.touching.tell(time, events);
        let first = events.hit.partition_point(|hit| hit.time < scratch.contacts.start);
        events.hit[first..].sort_by(|a, b| a.time.total_cmp(&b.time));
    }
}

impl Contacts {
    /// The shapes of a pair as events name them, and whether that turns the pair round.
    pub(super) fn shapes_of(&self, near: &Near, handles: &[BodyHandle]) -> (ShapePair, bool) {
        let entries = near.proxies.map(|proxy| &self.entries[proxy.0 as usize]);
        let [x, y] =
            entries.map(|entry| (handles[entry.collider.body as usize], entry.collider.part));
        let sensor = near.kind == Kind::Sensor;
        let flipped =
            if sensor { entries[0].role != Role::Sensor } else { y.0.slot() < x.0.slot() };
        let [a, b] = if flipped { [y, x] } else { [x, y] };
        (ShapePair { bodies: [a.0, b.0], parts: [a.1, b.1], sensor }, flipped)
    }

    /// Looks which pairs touch now. What has changed is told from above down.
    fn see_touching(
        &mut self,
        bodies: &Bodies,
        gravity: Vec2,
        scratch: &mut super::ContactScratch,
    ) {
        let mut changed = std::mem::take(&mut self.changed);
        changed.clear();
        let up = upwards(gravity);
        for place in 0..self.near.len() {
            let near = &self.near[place];
            let touches = match near.kind {
                Kind::Sensor => self.is_noticed(near, bodies),
                Kind::OneWay { solid: false } => false,
                _ => self.touches(near, bodies, scratch),
            };
            if touches != near.touching {
                changed.push((self.rank(near, bodies, up), place as u32));
                self.near[place].touching = touches;
            }
        }
        changed.sort_unstable();
        for (_, place) in &changed {
            let near = &self.near[*place as usize];
            let touches = near.touching;
            let (pair, flipped) = self.shapes_of(near, bodies.handles());
            let spot = if touches { self.spot(near, bodies, flipped) } else { None };
            self.touching.count(pair, touches, spot);
        }
        self.changed = changed;
    }

    /// Whether a sensor overlaps the other shape.
    fn is_noticed(&self, near: &Near, bodies: &Bodies) -> bool {
        let [x, y] = near.proxies.map(|proxy| &self.entries[proxy.0 as usize].collider);
        let [a, b] = [x, y].map(|collider| Frame::of(&bodies.poses[collider.body as usize]));
        let slack = if near.touching { CLOSED * x.width.min(y.width) } else { 0.0 };
        distance(&x.geometry, &y.geometry, &b.seen_from(&a)).distance <= slack
    }

    /// Whether two solid pieces touch: by an impulse, or by their gap. Manifolds foresee the gap; where they say that
    /// something has changed the narrow phase is asked.
    fn touches(&self, near: &Near, bodies: &Bodies, scratch: &mut super::ContactScratch) -> bool {
        let resists = |k: u32| scratch.answers.get(k as usize).is_none_or(|answer| answer.on);
        let patches = (near.first..near.first + near.count).filter(|k| resists(*k));
        let patches = patches.map(|k| &self.patches[k as usize]);
        if patches.clone().any(|patch| patch.memory.impulse[0] + patch.memory.impulse[1] > 0.0) {
            return true;
        }
        if patches.clone().next().is_none() {
            return false;
        }
        let [x, y] = near.proxies.map(|proxy| &self.entries[proxy.0 as usize].collider);
        let pose = [x, y].map(|collider| &bodies.poses[collider.body as usize]);
        let frames = pose.map(Frame::of);
        let gap = |manifold: &Manifold| {
            let apart = frames[1].position - frames[0].position;
            let at = moved(manifold, apart, [&place_of(&frames[0]), &place_of(&frames[1])]);
            at.gap[..manifold.count].iter().copied().fold(Real::INFINITY, Real::min)
        };
        let limit = if near.touching { OPEN } else { CLOSED } * x.width.min(y.width);
        let smallest = patches.map(|patch| gap(&patch.manifold)).fold(Real::INFINITY, Real::min);
        if (smallest <= limit) == near.touching {
            return near.touching;
        }
        scratch.found.clear();
        let b_in_a = frames[1].seen_from(&frames[0]);
        collide(&x.geometry, &y.geometry, &b_in_a, limit, &mut scratch.found);
        !scratch.found.is_empty()
    }

    /// Where a pair touches, as events name it.
    fn spot(&self, near: &Near, bodies: &Bodies, flipped: bool) -> Spot {
        let patch = self.patches_of(near).first()?;
        let [i, j] = near.proxies.map(|proxy| self.body_of(proxy) as usize);
        let seen = super::view::seen(&patch.manifold, [&bodies.poses[i], &bodies.poses[j]]);
        let points = &seen.points[..patch.manifold.count];
        let middle = points.iter().sum::<Vec2>() / points.len() as Real;
        let normal = if flipped { -seen.normal } else { seen.normal };
        let impulse = patch.memory.impulse[0] + patch.memory.impulse[1];
        Some((bodies.poses[i].position + middle, normal, impulse))
    }

    /// Counts a pair that is forgotten as one that no longer touches.
    pub(super) fn forget_touch(&mut self, near: &Near, handles: &[BodyHandle]) {
        if near.touching {
            let pair = self.shapes_of(near, handles).0;
            self.touching.count(pair, false, None);
        }
    }

    /// Derives which shapes touch from the pairs, and from what was not told yet.
    pub(in crate::world) fn retell(&mut self, handles: &[BodyHandle]) {
        let mut pairs: HashMap<ShapePair, Told, FxBuildHasher> = HashMap::default();
        for near in self.near.iter().chain(self.sleep.near()).filter(|near| near.touching) {
            let entry = pairs.entry(self.shapes_of(near, handles).0).or_default();
            *entry = Told { pieces: entry.pieces + 1, told: true };
        }
        // The first change of a pair knows what was told before.
        for change in self.touching.changes.iter().rev() {
            pairs.entry(change.pair).or_default().told = change.told;
        }
        self.touching.pairs = pairs;
    }
}
