//! Impacts: contacts that arrive faster than they may rest, each at its own moment of the substep, in the
//! order of time.
//!
//! An impulse at the time τ from the middle changes the velocities by Δv and the places of the middle by −Δv·τ, so that all
//! that follows may go on counting from the middle: the path before τ is as it was, after τ as it must be.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::law;
use super::path::Pair;
use super::{Group, Outcome};
use crate::body::ImpactLaw;
use crate::constraints::contact::{Block, moved};
use crate::math::{Real, Twist};

/// An impact that may come, the first on top of the heap.
#[derive(Clone, Copy, Debug)]
struct Event {
    time: Real,
    approach: Real,
    block: u32,
    /// Number of impacts the two bodies had seen when it was found.
    stamp: u32,
}

impl Ord for Event {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_time = other.time.total_cmp(&self.time);
        by_time.then(self.approach.total_cmp(&other.approach)).then(other.block.cmp(&self.block))
    }
}
impl PartialOrd for Event {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}
impl PartialEq for Event {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}
impl Eq for Event {}

/// Columns of the search for impacts.
#[derive(Clone, Debug, Default)]
pub struct Watch {
    /// Blocks that may see an impact.
    pub blocks: Vec<u32>,
    /// Of each slot, where its watched blocks begin in `of_slot`.
    first: Vec<u32>,
    of_slot: Vec<u32>,
    /// Impacts of each slot in this substep.
    seen: Vec<u32>,
}

impl Watch {
    /// Forgets all.
    pub fn clear(&mut self) {
        self.blocks.clear();
        self.first.clear();
    }

    /// Sorts the watched blocks by the bodies they belong to.
    fn index(&mut self, slots: usize, blocks: &[Block]) {
        self.first.clear();
        self.first.resize(slots + 1, 0);
        let ends = |k: &u32| blocks[*k as usize].bodies;
        self.blocks.iter().flat_map(ends).for_each(|slot| self.first[slot as usize + 1] += 1);
        for slot in 0..slots {
            self.first[slot + 1] += self.first[slot];
        }
        let mut next = self.first.clone();
        self.of_slot.resize(2 * self.blocks.len(), 0);
        for k in &self.blocks {
            for slot in ends(k) {
                self.of_slot[next[slot as usize] as usize] = *k;
                next[slot as usize] += 1;
            }
        }
    }

    fn stamp(&self, [a, b]: [u32; 2]) -> u32 {
        self.seen[a as usize] + self.seen[b as usize]
    }
}

/// Resolves the impacts of a substep. The velocities are those of its middle.
pub fn resolve(group: &mut Group, h: Real, law: ImpactLaw, outcome: &mut Outcome) {
    if group.watch.blocks.is_empty() {
        return;
    }
    let mut watch = std::mem::take(&mut group.watch);
    if watch.first.is_empty() {
        watch.index(group.velocities.len(), &group.blocks);
    }
    group.sag = h * h / 8.0;
    watch.seen.clear();
    watch.seen.resize(group.velocities.len(), 0);
    let mut queue = BinaryHeap::new();
    for k in &watch.blocks {
        set_resting(group, *k as usize, h);
        queue.extend(next_event(group, &watch, *k, [-h / 2.0, h / 2.0]));
    }
    // Enough for every pair to meet many times; what a collapse leaves is for the rows.
    let mut left = 64 + 32 * watch.blocks.len();
    while let Some(event) = queue.pop() {
        let bodies = group.blocks[event.block as usize].bodies;
        if event.stamp != watch.stamp(bodies) {
            continue;
        }
        if left == 0 {
            break;
        }
        left -= 1;
        strike(group, &event, law, outcome);
        for slot in bodies {
            let fixed = group.velocities[slot as usize].is_fixed();
            watch.seen[slot as usize] += u32::from(!fixed);
        }
        for slot in bodies {
            if group.velocities[slot as usize].is_fixed() {
                continue;
            }
            let [from, to] = [0, 1].map(|k| watch.first[slot as usize + k] as usize);
            for k in &watch.of_slot[from..to] {
                queue.extend(next_event(group, &watch, *k, [event.time, h / 2.0]));
            }
        }
    }
    let struck = watch.seen.iter().any(|seen| *seen > 0);
    if struck {
        place_struck(group, &watch);
    }
    group.watch = watch;
}

/// The approach that the kicks of the substep give a contact by themselves, and rounding.
fn set_resting(group: &mut Group, k: usize, h: Real) {
    let Group { velocities, places, blocks, links, .. } = group;
    let (block, link) = (&blocks[k], &mut links[k]);
    let [a, b] = block.bodies.map(|slot| slot as usize);
    let speed = velocities[a].twist.linear.norm() + velocities[b].twist.linear.norm();
    for p in 0..link.manifold.count {
        let kick = |slot: usize, side: usize| {
            let a = &places[slot].acceleration;
            block.normal.dot(&a.linear) + block.arms[p][side] * a.angular
        };
        link.resting[p] = (kick(b, 1) - kick(a, 0)).abs() * h * (1.0 + 1e-6) + 1e-11 * speed;
    }
}

fn next_event(group: &Group, watch: &Watch, block: u32, [from, to]: [Real; 2]) -> Option<Event> {
    let bodies = group.blocks[block as usize].bodies;
    let arrival = pair(group, block as usize).first_arrival(from, to)?;
    let stamp = watch.stamp(bodies);
    Some(Event { time: arrival.time, approach: arrival.approach, block, stamp })
}

fn pair(group: &Group, k: usize) -> Pair<'_> {
    let [a, b] = group.blocks[k].bodies.map(|slot| slot as usize);
    Pair {
        link: &group.links[k],
        places: [&group.places[a], &group.places[b]],
        velocities: [&group.velocities[a], &group.velocities[b]],
        sag: group.sag,
    }
}

/// One impact.
fn strike(group: &mut Group, event: &Event, law: ImpactLaw, outcome: &mut Outcome) {
    let k = event.block as usize;
    let (link, time) = (group.links[k], event.time);
    let pair = pair(group, k);
    let (places, velocities) = (pair.places_at(time), pair.velocities_at(time));
    let bodies = [&velocities[0], &velocities[1]];
    let at = moved(&link.manifold, link.apart, [&places[0], &places[1]]);
    let mut block = group.blocks[k];
    block.place(&link.manifold, &at, bodies);
    block.impulse = [0.0; 3];
    block.sliding = false;
    let mut u = block.velocity(bodies);
    u[2] -= block.target[2];
    let mut restitution = [0.0; 2];
    for p in 0..2 {
        let touches = p < link.manifold.count && at.gap[p] <= 1e-9 * link.width;
        block.on[p] = touches && u[p] < 0.0;
        restitution[p] = if -u[p] > link.resting[p] { link.restitution } else { 0.0 };
    }
    block.prepare(bodies);
    let impulse = law::impulses(law, &block, u, restitution);
    outcome.impacts += 1;
    outcome.ledger.dissipated -= law::gain(&block, &u, &impulse);
    if group.driven {
        let given = super::group::driving_work(&block, &impulse, bodies);
        outcome.ledger.work += given;
    }
    let link = &mut group.links[k];
    link.impact += impulse[0] + impulse[1];
    link.approach = link.approach.max(event.approach);
    let [a, b] = block.bodies;
    let before = [a, b].map(|slot| group.velocities[slot as usize].twist);
    block.push(crate::solvers::sweep::pair(&mut group.velocities, [a, b]), impulse);
    for (slot, before) in [a, b].into_iter().zip(before) {
        let now = group.velocities[slot as usize].twist;
        let change = Twist::new(now.linear - before.linear, now.angular - before.angular);
        group.places[slot as usize].drift(&change, -time);
    }
}

/// Takes the geometry of the middle anew where an impact moved it.
fn place_struck(group: &mut Group, watch: &Watch) {
    for k in 0..group.blocks.len() {
        let struck = |slot: &u32| watch.seen[*slot as usize] > 0;
        if group.blocks[k].bodies.iter().any(struck) {
            super::place_block(group, k);
        }
    }
}
