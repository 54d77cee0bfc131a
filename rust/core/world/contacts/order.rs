//! The order in which pairs are dealt with: from above down, whatever the order in which they were found.

use super::{Contacts, Near};
use crate::body::Bodies;
use crate::collision::ProxyId;
use crate::math::{Real, Vec2};

/// A pair by its height, then by its numbers, whatever else is in the world; and its place among all.
pub(super) type Rank = (u64, [ProxyId; 2], u32);

/// No pair.
const NONE: u32 = u32::MAX;

impl Contacts {
    /// Orders the pairs that have manifolds from above down. Sweeps that follow the load settle several times sooner than
    /// those in any order.
    pub(super) fn order(&mut self, bodies: &Bodies, gravity: Vec2) {
        let mut ranks = std::mem::take(&mut self.ranks);
        self.in_last_order();
        ranks.clear();
        ranks.extend(self.order.iter().map(|place| self.rank(*place, bodies, gravity)));
        if !ranks.is_sorted() {
            ranks.sort_unstable();
        }
        self.order.clear();
        for (turn, (.., place)) in ranks.iter().enumerate() {
            self.near[*place as usize].turn = turn as u32;
            self.order.push(*place);
        }
        self.ranks = ranks;
    }

    /// Pairs that resist and places of their patches, from above down: those that bore a load in the last substep, or the rest.
    pub(super) fn solid(&self, bears: bool) -> impl Iterator<Item = (&Near, usize)> {
        let pairs = self.order.iter().map(|place| &self.near[*place as usize]);
        let solid = pairs.filter(|near| near.resists());
        let patches = solid.flat_map(|near| near.patches().map(move |place| (near, place)));
        patches.filter(move |(_, place)| self.patches[*place].bears() == bears)
    }

    /// Pairs that have manifolds, as they were ordered last: that is often right still. What is new comes last.
    fn in_last_order(&mut self) {
        let Self { near, order, .. } = self;
        let count = order.len();
        order.fill(NONE);
        for (place, pair) in near.iter().enumerate().filter(|(_, pair)| pair.count > 0) {
            match order[..count].get_mut(pair.turn as usize) {
                Some(free) if *free == NONE => *free = place as u32,
                _ => order.push(place as u32),
            }
        }
        order.retain(|place| *place != NONE);
    }

    /// Where the pair at a place stands in the order.
    pub(super) fn rank(&self, place: u32, bodies: &Bodies, gravity: Vec2) -> Rank {
        let pair = &self.near[place as usize];
        (descending(self.height(pair, bodies, gravity)), pair.proxies, place)
    }

    /// How high a pair stands against gravity (m); without gravity along x.
    fn height(&self, pair: &Near, bodies: &Bodies, gravity: Vec2) -> Real {
        let up = if gravity == Vec2::zeros() { Vec2::x() } else { -gravity.normalize() };
        let height = |proxy: ProxyId| {
            let body = self.body_of(proxy) as usize;
            (bodies.masses[body].is_free(), bodies.poses[body].position.dot(&up))
        };
        match pair.proxies.map(height) {
            [(true, a), (true, b)] => 0.5 * (a + b),
            [(true, a), _] | [_, (_, a)] => a,
        }
    }
}

/// A number that is the smaller, the larger a height is, in the order of [`Real::total_cmp`].
fn descending(height: Real) -> u64 {
    let bits = height.to_bits();
    if bits >> 63 == 0 { !(bits | 1 << 63) } else { bits }
}
