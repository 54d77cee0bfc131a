//! The order in which contacts are dealt with: from above down, whatever the order in which their pairs were found.

use super::{Contacts, Near, Patch};
use crate::body::Bodies;
use crate::collision::ProxyId;
use crate::math::{Real, Vec2};

/// A pair by its height, then by its numbers, whatever else is in the world.
pub(super) type Rank = (u64, [ProxyId; 2]);

/// The direction against gravity; without gravity along x.
pub(super) fn upwards(gravity: Vec2) -> Vec2 {
    if gravity == Vec2::zeros() { Vec2::x() } else { -gravity.normalize() }
}

impl Contacts {
    /// Where a pair stands in the order.
    pub(super) fn rank(&self, pair: &Near, bodies: &Bodies, up: Vec2) -> Rank {
        (descending(self.height(pair, bodies, up)), pair.proxies)
    }

    /// How high a pair stands (m).
    fn height(&self, pair: &Near, bodies: &Bodies, up: Vec2) -> Real {
        let height = |proxy: ProxyId| {
            let body = self.body_of(proxy) as usize;
            (bodies.masses[body].is_free(), bodies.poses[body].position.dot(&up))
        };
        match pair.proxies.map(height) {
            [(true, a), (true, b)] => 0.5 * (a + b),
            [(true, a), _] | [_, (_, a)] => a,
        }
    }

    /// Keeps pairs and their patches in memory as the groups of a step go through them, `places` being the patches in that order:
    /// large worlds would wait for memory otherwise. Pairs that are in no group come last. Nothing is moved while few are out of
    /// their place. The groups must be those of the present patches.
    pub(in crate::world) fn line_up(&mut self, places: impl Iterator<Item = u32> + Clone) {
        let turns = places.clone().zip(places.clone().skip(1));
        let wrong = turns.filter(|(before, after)| after < before).count();
        if SCATTERED * wrong <= self.patches.len() {
            return;
        }
        let Self { near, patches, before, spare, .. } = self;
        before.clear();
        spare.clear();
        let mut take = |pair: &mut Near| {
            let first = before.len() as u32;
            for patch in &patches[pair.patches()] {
                before.push(Patch { near: spare.len() as u32, ..*patch });
            }
            spare.push(Near { first, ..pair.clone() });
            // Taken.
            pair.proxies[1] = pair.proxies[0];
        };
        for place in places {
            let pair = &mut near[patches[place as usize].near as usize];
            if pair.proxies[0] != pair.proxies[1] {
                take(pair);
            }
        }
        near.iter_mut().filter(|pair| pair.proxies[0] != pair.proxies[1]).for_each(take);
        std::mem::swap(near, spare);
        std::mem::swap(patches, before);
    }
}

/// Patches to one that follows another which stands behind it in memory, from which on all are put in line.
const SCATTERED: usize = 8;

/// A number that is the smaller, the larger a height is, in the order of [`Real::total_cmp`].
fn descending(height: Real) -> u64 {
    let bits = height.to_bits();
    if bits >> 63 == 0 { !(bits | 1 << 63) } else { bits }
}
