//! What deformable bodies may touch in a step.

use super::advance::{Against, Pair, SoftScratch};
use crate::body::{PairSurface, Role};
use crate::joint::Joint;
use crate::math::{Real, Vec2};
use crate::shapes::Aabb;
use crate::soft::SoftBody;
use crate::world::joints::index_of;
use crate::world::{State, World};

impl World {
    /// Finds what deformable bodies may touch in a step of length dt (s). What sleeps and may be touched wakes; whether any did.
    pub(in crate::world) fn look_around_softs(&mut self, dt: Real) -> bool {
        let Self { state, scratch, .. } = self;
        let mut called = Vec::new();
        scratch.soft.touches.clear();
        scratch.soft.look_at_joints(state, &mut called);
        scratch.soft.look_around(state, dt, &mut called);
        called.sort_unstable();
        called.dedup();
        self.wake_islands(&called);
        !called.is_empty()
    }
}

impl SoftScratch {
    /// Finds what joints tie, and calls those of it that sleep.
    fn look_at_joints(&mut self, state: &State, called: &mut Vec<u32>) {
        self.joined.clear();
        self.apart.clear();
        for (joint, ends) in ends_of_joints(state) {
            let Some(pair) = both(ends) else { continue };
            self.joined.push(pair);
            let bodies = pair.iter().filter(|i| (**i as usize) < state.bodies.len());
            called.extend(bodies.filter_map(|i| state.contacts.island_of(*i as usize)));
            if !joint.def.collide_connected && ends[0].is_some() && ends[1].is_some() {
                self.apart.push(pair);
            }
        }
    }

    /// Finds pairs, and calls those that sleep.
    fn look_around(&mut self, state: &State, dt: Real, called: &mut Vec<u32>) {
        let Self { pairs, boxes, apart, .. } = self;
        let (softs, contacts) = (&state.softs.bodies, &state.contacts);
        pairs.clear();
        boxes.clear();
        let (gravity, mixing) = (state.settings.gravity, &state.settings.mixing);
        boxes.extend(softs.values().iter().map(|body| {
            let fall = (gravity * body.def().gravity_scale).norm() * dt;
            let speed = body.velocities().iter().map(Vec2::norm).fold(0.0, Real::max);
            bounds(body).grown(body.radius() + 0.1 * body.side() + (speed + fall) * dt)
        }));
        let count = state.bodies.len();
        let may_touch = |soft: usize, other: usize| {
            let [a, b] = [(count + soft) as u32, other as u32];
            !apart.contains(&[a, b]) && !apart.contains(&[b, a])
        };
        for (k, body) in softs.values().iter().enumerate() {
            let filter = &body.def().filter;
            let first = pairs.len();
            contacts.each_near(&boxes[k], |proxy, entry| {
                let rigid = entry.collider.body;
                let allowed = entry.role != Role::Sensor && filter.allows(&entry.filter);
                if allowed && may_touch(k, rigid as usize) {
                    called.extend(contacts.island_of(rigid as usize));
                    let def = &state.bodies.infos[rigid as usize].def;
                    let part = &def.shapes[entry.collider.part as usize];
                    let mixed = mixing.mix(&body.def().surface, &def.surface_of(part));
                    pairs.push(Pair::new(k, Against::Proxy(proxy, rigid), &mixed));
                }
            });
            // Whatever the order in which the tree holds them.
            pairs[first..].sort_unstable_by_key(|pair| match pair.against {
                Against::Proxy(proxy, _) => proxy.0,
                Against::Soft(_) => 0,
            });
            for (j, other) in softs.values().iter().enumerate().skip(k) {
                let allowed = if j == k {
                    body.def().touches_itself
                } else {
                    let meets = boxes[k].overlaps(&boxes[j]) && may_touch(k, count + j);
                    meets && filter.allows(&other.def().filter)
                };
                if allowed {
                    let mixed = mixing.mix(&body.def().surface, &other.def().surface);
                    pairs.push(Pair::new(k, Against::Soft(j as u32), &mixed));
                }
            }
        }
    }
}

/// The joints that hold deformable bodies, and what they tie: bodies by their places, deformable ones on from those.
fn ends_of_joints(state: &State) -> impl Iterator<Item = (&Joint, [Option<u32>; 2])> {
    let count = state.bodies.len() as u32;
    state.softs.held().filter_map(move |(own, places)| {
        let joint = state.joints.get(own.joint).ok()?;
        let ends = [0, 1].map(|side| match places[side] {
            Some(k) => Some(count + k as u32),
            None => index_of(&state.bodies, joint, side).map(|i| i as u32),
        });
        Some((joint, ends))
    })
}

/// Both ends of a link; that which there is twice where the other is the world.
fn both(ends: [Option<u32>; 2]) -> Option<[u32; 2]> {
    let [a, b] = ends;
    Some([a.or(b)?, b.or(a)?])
}

impl Pair {
    fn new(soft: usize, against: Against, mixed: &PairSurface) -> Self {
        Self {
            soft: soft as u32,
            against,
            friction: mixed.friction,
            restitution: mixed.restitution,
            tangent_speed: mixed.tangent_speeds.iter().sum(),
        }
    }
}

/// The smallest box around the nodes.
pub(super) fn bounds(body: &SoftBody) -> Aabb {
    let at = body.positions();
    let (min, max) = at.iter().fold((at[0], at[0]), |(min, max), p| (min.inf(p), max.sup(p)));
    Aabb { min, max }
}
