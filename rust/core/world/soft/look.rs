//! What deformable bodies may touch in a step.

use super::advance::{Against, Pair};
use crate::body::{PairSurface, Role};
use crate::math::{Real, Vec2};
use crate::shapes::Aabb;
use crate::soft::SoftBody;
use crate::world::World;
use crate::world::joints::index_of;

impl World {
    /// Finds what deformable bodies may touch in a step of length dt (s). What sleeps and may be touched wakes; whether any did.
    pub(in crate::world) fn look_around_softs(&mut self, dt: Real) -> bool {
        let Self { state, scratch, .. } = self;
        let (softs, contacts) = (&state.softs, &state.contacts);
        let (pairs, boxes) = (&mut scratch.soft.pairs, &mut scratch.soft.boxes);
        pairs.clear();
        boxes.clear();
        let (gravity, mixing) = (state.settings.gravity, &state.settings.mixing);
        boxes.extend(softs.bodies.values().iter().map(|body| {
            let fall = (gravity * body.def().gravity_scale).norm() * dt;
            let speed = body.velocities().iter().map(Vec2::norm).fold(0.0, Real::max);
            bounds(body).grown(body.radius() + 0.1 * body.side() + (speed + fall) * dt)
        }));
        let mut called = Vec::new();
        let (joined, apart) = (&mut scratch.soft.joined, &mut scratch.soft.apart);
        joined.clear();
        apart.clear();
        let count = state.bodies.len() as u32;
        for (own, places) in softs.held() {
            let Ok(joint) = state.joints.get(own.joint) else { continue };
            let place = |side: usize| match places[side] {
                Some(k) => Some(count + k as u32),
                None => index_of(&state.bodies, joint, side).map(|i| i as u32),
            };
            let ends = [place(0), place(1)];
            let Some(pair) = both(ends) else { continue };
            joined.push(pair);
            let bodies = pair.iter().filter(|i| **i < count);
            called.extend(bodies.filter_map(|i| contacts.island_of(*i as usize)));
            if !joint.def.collide_connected && ends[0].is_some() && ends[1].is_some() {
                apart.push(pair);
            }
        }
        let may_touch = |a: u32, b: u32| !apart.contains(&[a, b]) && !apart.contains(&[b, a]);
        let softs = &softs.bodies;
        for (k, body) in softs.values().iter().enumerate() {
            let filter = &body.def().filter;
            let first = pairs.len();
            contacts.each_near(&boxes[k], |proxy, entry| {
                let rigid = entry.collider.body;
                let allowed = entry.role != Role::Sensor
                    && filter.allows(&entry.filter)
                    && may_touch(rigid, count + k as u32);
                if allowed {
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
                    filter.allows(&other.def().filter)
                        && boxes[k].overlaps(&boxes[j])
                        && may_touch(count + k as u32, count + j as u32)
                };
                if allowed {
                    let mixed = mixing.mix(&body.def().surface, &other.def().surface);
                    pairs.push(Pair::new(k, Against::Soft(j as u32), &mixed));
                }
            }
        }
        called.sort_unstable();
        called.dedup();
        self.wake_islands(&called);
        !called.is_empty()
    }
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
