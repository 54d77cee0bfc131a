//! Contacts of a world: the shapes in it, which of them are near one another, and what a contact remembers.

mod advance;
mod backup;
mod by_events;
#[cfg(test)]
mod coulomb;
mod detect;
mod events;
mod finer;
mod hits;
mod hooks;
mod near;
mod order;
#[cfg(test)]
mod packets;
mod sleep;
mod strays;
mod surroundings;
mod touching;
mod view;

pub(super) use advance::ContactScratch;
pub(super) use backup::ContactBackup;
pub(super) use by_events::ByEvents;
pub use events::{ContactEvent, Events};
pub use hooks::{ContactHooks, PreSolve, ShapeView};
pub(super) use near::{Near, Patch};
pub(super) use strays::Strays;
pub(super) use touching::Change;
pub use view::Contact;

use rustc_hash::FxHashSet;
use serde::{Deserialize, Serialize};

use crate::body::{Bodies, Filter, Role};
use crate::collision::{BroadPhase, Collider, Frame, PairMap, ProxyId, colliders};
use crate::math::{Real, Rot, Vec2, vec2};
use crate::shapes::Aabb;

/// One collider of a body, and what its part says of it.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub(super) struct Entry {
    pub collider: Collider,
    pub filter: Filter,
    pub role: Role,
    /// Whether its surface has restitution.
    pub bounces: bool,
}

/// All that detection keeps between steps.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub(super) struct Contacts {
    broad: BroadPhase,
    /// Colliders by the numbers of their proxies; free numbers hold what was there.
    entries: Vec<Entry>,
    /// Proxies of each body, in body order.
    of_body: Vec<Vec<ProxyId>>,
    /// Pairs whose boxes meet.
    pub near: Vec<Near>,
    /// Manifolds of the pairs, pair after pair.
    pub patches: Vec<Patch>,
    /// Length (s) of the substep that the remembered impulses are of.
    pub substep: Real,
    /// What sleeps, and the pairs in which nothing moves.
    pub sleep: sleep::Sleep,
    /// Shapes that touch.
    pub touching: touching::Touching,
    #[serde(skip)]
    map: PairMap,
    #[serde(skip)]
    before: Vec<Patch>,
    #[serde(skip)]
    spare: Vec<Near>,
    /// Pairs that began or ended to touch, from above down.
    #[serde(skip)]
    changed: Vec<(order::Rank, u32)>,
    /// Frames of the bodies' centres of mass, in body order.
    #[serde(skip)]
    frames: Vec<Frame>,
    /// How far each body may be thrown in the step (m), where some were thrown before; else empty.
    #[serde(skip)]
    pub spread: Vec<Real>,
    /// Some body moves far in the step.
    #[serde(skip)]
    pub far: bool,
    /// How far from where it is each body can get before what it can meet must be looked for anew (m), in body
    /// order.
    #[serde(skip)]
    covered: Vec<Real>,
    /// How far each body may be thrown beyond its own way without that being looked for anew (m), in body order.
    #[serde(skip)]
    room: Vec<Real>,
    /// Bodies, in pairs, that a joint keeps from touching each other.
    #[serde(skip)]
    pub apart: FxHashSet<[u32; 2]>,
    /// Bodies whose place was set since the last detection.
    #[serde(skip)]
    moved: Vec<u32>,
}

/// No rotation, at the origin.
const ORIGIN: Frame = Frame { position: vec2(0.0, 0.0), rot: Rot::IDENTITY };

/// Keeping up with the bodies.
impl Contacts {
    /// Number of bodies that some filter lets touch others.
    pub fn touchable(&self) -> usize {
        (0..self.of_body.len()).filter(|body| self.can_touch(*body)).count()
    }

    /// Whether the filter of some shape of a body lets it touch others.
    pub fn can_touch(&self, body: usize) -> bool {
        let filter = |proxy: &ProxyId| self.entries[proxy.0 as usize].filter;
        self.of_body[body].iter().map(filter).any(|filter| filter.mask != 0 || filter.group > 0)
    }

    /// Whether no body that can touch others went farther than the last detection looked.
    pub fn foresaw(&self, before: &Bodies, after: &Bodies) -> bool {
        (0..self.of_body.len()).filter(|body| self.can_touch(*body)).all(|i| {
            let way = after.poses[i].position - before.poses[i].position;
            way.norm() <= self.covered[i]
        })
    }

    /// Tells of the colliders whose boxes meet a box.
    pub fn each_near(&self, around: &Aabb, mut tell: impl FnMut(ProxyId, &Entry)) {
        self.broad.query(around, &mut |proxy| {
            tell(proxy, &self.entries[proxy.0 as usize]);
            true
        });
    }

    /// Whether a body has shapes.
    pub fn has_shapes(&self, body: usize) -> bool {
        !self.of_body[body].is_empty()
    }

    /// Takes in the last body of the columns.
    pub fn add(&mut self, bodies: &Bodies) {
        self.of_body.push(Vec::new());
        self.frames.push(ORIGIN);
        self.covered.push(0.0);
        self.sleep.push();
        self.insert(bodies, bodies.len() - 1);
    }

    /// Takes in a body that was edited.
    pub fn replace(&mut self, bodies: &Bodies, body: usize) {
        self.take_out(bodies, body);
        self.insert(bodies, body);
    }

    /// Forgets a body that is still in the columns; the last one takes its place.
    pub fn remove(&mut self, bodies: &Bodies, body: usize) {
        self.take_out(bodies, body);
        self.of_body.swap_remove(body);
        self.frames.swap_remove(body);
        self.covered.swap_remove(body);
        self.sleep.swap_remove(body);
        let last = self.of_body.len() as u32;
        self.moved.retain(|moved| *moved as usize != body);
        self.moved
            .iter_mut()
            .filter(|moved| **moved == last)
            .for_each(|moved| *moved = body as u32);
        if let Some(proxies) = self.of_body.get(body) {
            for proxy in proxies {
                self.entries[proxy.0 as usize].collider.body = body as u32;
            }
        }
    }

    /// What a body may touch is looked for anew.
    pub fn look_anew(&mut self, body: usize) {
        self.of_body[body].iter().for_each(|proxy| self.broad.touch(*proxy));
        self.touch(body);
    }

    /// Tells that the place of a body was set.
    pub fn touch(&mut self, body: usize) {
        if !self.has_shapes(body) {
            return;
        }
        self.moved.push(body as u32);
        // Worlds that are set and never stepped must not gather names without end.
        if self.moved.len() > 2 * self.of_body.len() {
            self.moved.sort_unstable();
            self.moved.dedup();
        }
    }

    /// Tells that the places of all bodies were set.
    pub fn touch_all(&mut self) {
        self.moved.clear();
        self.moved.extend(
            (0..self.of_body.len() as u32).filter(|body| !self.of_body[*body as usize].is_empty()),
        );
    }

    /// Derives what is not stored.
    pub fn rebuild(&mut self, bodies: &Bodies) {
        self.map_pairs();
        self.frames.resize(self.of_body.len(), ORIGIN);
        self.covered.resize(self.of_body.len(), 0.0);
        self.touch_all();
        self.retell(bodies.handles());
    }

    /// Derives the map of pairs.
    fn map_pairs(&mut self) {
        self.map = self
            .near
            .iter()
            .chain(self.sleep.near())
            .map(|near| (near.proxies[0], near.proxies[1]))
            .collect();
    }

    fn insert(&mut self, bodies: &Bodies, body: usize) {
        let def = &bodies.infos[body].def;
        if def.shapes.is_empty() {
            return;
        }
        let frame = Frame::of(&bodies.poses[body]);
        self.frames[body] = frame;
        let moving = def.kind != crate::body::BodyKind::Static;
        for collider in colliders(body as u32, &def.shapes, bodies.local_centers[body]) {
            let part = &def.shapes[collider.part as usize];
            let (filter, role) = (def.filter_of(part), def.role_of(part));
            let bounces = def.surface_of(part).restitution > 0.0;
            let entry = Entry { filter, role, bounces, collider };
            let (tight, margin) =
                (entry.collider.geometry.bounds_at(&frame), margin(&entry.collider));
            let proxy = self.broad.insert(&tight, margin, moving);
            match self.entries.get_mut(proxy.0 as usize) {
                Some(free) => *free = entry,
                None => self.entries.push(entry),
            }
            self.of_body[body].push(proxy);
        }
    }

    fn take_out(&mut self, bodies: &Bodies, body: usize) {
        let proxies = std::mem::take(&mut self.of_body[body]);
        if proxies.is_empty() {
            return;
        }
        for proxy in &proxies {
            self.broad.remove(*proxy);
        }
        let handles = bodies.handles();
        self.drop_near(handles, |near, _| near.proxies.iter().any(|proxy| proxies.contains(proxy)));
    }

    fn body_of(&self, proxy: ProxyId) -> u32 {
        self.entries[proxy.0 as usize].collider.body
    }
}

/// How much larger than needed a box is kept, as a part of the width.
const MARGIN: Real = 0.1;

/// The same (m).
fn margin(collider: &Collider) -> Real {
    MARGIN * collider.width
}

/// How far a collider is expected to go on beyond its way in this step: that way three times more if it leaves its margin soon, but
/// not beyond its own width, so that boxes do not meet much that the collider never will.
fn ahead(collider: &Collider, way: Vec2) -> Vec2 {
    const STEPS: Real = 3.0;
    let length = way.norm();
    if 2.0 * STEPS * length <= margin(collider) {
        return Vec2::zeros();
    }
    way * STEPS.min(collider.width / length)
}

/// A motion beyond this part of a collider's width is a far one: the collider may bounce and end up anywhere around.
const FAR: Real = 0.25;

/// The box of a collider on its way through a step: moved by `way`, or as far in any direction, and turned by any of
/// the angles up to `turn`.
fn swept(collider: &Collider, frame: &Frame, (way, turn): (Vec2, Real), spread: Real) -> Aabb {
    let here = collider.geometry.bounds_at(frame).grown(turn.min(2.0) * collider.reach);
    let length = way.norm().max(spread);
    if length > FAR * collider.width {
        return here.grown(length);
    }
    here.merged(&Aabb { min: here.min + way, max: here.max + way })
}
