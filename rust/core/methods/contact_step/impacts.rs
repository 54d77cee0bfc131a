//! Impacts: contacts that arrive faster than they may rest, each at its own moment of the substep, in the
//! order of time.
//!
//! An impulse at the time τ from the middle changes the velocities by Δv and the places of the middle by −Δv·τ, so that all
//! that follows may go on counting from the middle: the path before τ is as it was, after τ as it must be.

use std::cmp::Ordering;
use std::collections::BinaryHeap;

use super::law;
use super::path::Pair;
use super::{Group, Outcome, Surroundings, Watched};
use crate::body::ImpactLaw;
use crate::collision::Manifold;
use crate::constraints::contact::{Block, moved};
use crate::math::{Real, Twist, Vec2};

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
    /// Time since which each slot is on its present way, from the middle of the substep (s).
    since: Vec<Real>,
    /// Slots that the last impact moved.
    struck: Vec<u32>,
    /// The rows are solved: swift bodies alone are looked at, and no kick is to come.
    after_rows: bool,
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

    /// Begins a substep.
    fn start(&mut self, group: &Group, from: Real) {
        let slots = group.velocities.len();
        if self.first.is_empty() {
            self.index(slots, &group.blocks);
        }
        self.seen.clear();
        self.seen.resize(slots, 0);
        self.since.clear();
        self.since.resize(slots, from);
    }

    /// Whether swift contacts are watched.
    pub fn has_swift(&self, group: &Group) -> bool {
        self.blocks.iter().any(|k| group.links[*k as usize].watched == Watched::Swift)
    }

    fn stamp(&self, [a, b]: [u32; 2]) -> u32 {
        self.seen[a as usize] + self.seen[b as usize]
    }
}

/// Resolves the impacts of a substep. The velocities are those of its middle, by half the kick.
pub fn resolve(
    group: &mut Group,
    h: Real,
    law: ImpactLaw,
    (around, outcome): (&dyn Surroundings, &mut Outcome),
) {
    if group.watch.blocks.is_empty() {
        return;
    }
    let mut watch = std::mem::take(&mut group.watch);
    watch.start(group, -h / 2.0);
    group.h = h;
    for k in &watch.blocks {
        set_resting(group, *k as usize, h);
        let link = &mut group.links[*k as usize];
        link.met = false;
        group.loaded[link.number as usize] = link.manifold;
    }
    strike_all(group, &mut watch, h / 2.0, law, (around, outcome));
    for k in &watch.blocks {
        if group.links[*k as usize].watched == Watched::Swift {
            look_again(group, &watch, *k as usize, around);
        }
    }
    if watch.seen.iter().any(|seen| *seen > 0) {
        place_struck(group, &watch);
    }
    group.watch = watch;
}

/// Resolves what swift bodies meet in the second half of the substep, after the rows have turned them.
pub fn resolve_turned(
    group: &mut Group,
    h: Real,
    law: ImpactLaw,
    (around, outcome): (&dyn Surroundings, &mut Outcome),
) {
    let mut watch = std::mem::take(&mut group.watch);
    watch.after_rows = true;
    watch.since.iter_mut().for_each(|since| *since = since.max(0.0));
    strike_all(group, &mut watch, h / 2.0, law, (around, outcome));
    watch.after_rows = false;
    group.watch = watch;
}

/// Impacts one after the other up to a time.
fn strike_all(
    group: &mut Group,
    watch: &mut Watch,
    to: Real,
    law: ImpactLaw,
    (around, outcome): (&dyn Surroundings, &mut Outcome),
) {
    let mut queue = BinaryHeap::new();
    for k in &watch.blocks {
        queue.extend(next_event(group, (watch, around), *k, to));
    }
    // Enough for every pair to meet many times; what a collapse leaves is for the rows.
    let mut left = 64 + 8 * watch.blocks.len();
    while let Some(event) = queue.pop() {
        let bodies = group.blocks[event.block as usize].bodies;
        if event.stamp != watch.stamp(bodies) {
            continue;
        }
        if left == 0 {
            break;
        }
        left -= 1;
        strike(group, watch, &event, law, outcome);
        for slot in &watch.struck {
            watch.seen[*slot as usize] += 1;
            watch.since[*slot as usize] = event.time;
        }
        for slot in watch.struck.iter().map(|slot| *slot as usize) {
            let [from, until] = [0, 1].map(|k| watch.first[slot + k] as usize);
            for k in from..until {
                queue.extend(next_event(group, (watch, around), watch.of_slot[k], to));
            }
        }
    }
}

/// Which features of a swift contact touch now, for its rows: those that met in an impact, or those that the middle of
/// the substep shows, or the moment of the last impact after it, since before that a body's way is not its own; none if
/// the shapes are apart there.
fn look_again(group: &mut Group, watch: &Watch, k: usize, around: &dyn Surroundings) {
    let [since_a, since_b] = group.blocks[k].bodies.map(|slot| watch.since[slot as usize]);
    let now = since_a.max(since_b).max(0.0);
    let pair = pair(group, k, false);
    let ways = [0, 1].map(|side| pair.way(side, [now, group.h / 2.0]));
    let link = &mut group.links[k];
    if !link.met {
        let seen = around.look(link, &ways);
        link.apart_now = seen.is_none();
        link.manifold = seen.unwrap_or(link.manifold);
    }
    let block = &mut group.blocks[k];
    block.count = link.manifold.count as u8;
    remember(block, &group.loaded[link.number as usize], &link.manifold);
    super::place_block(group, k, now);
}

/// Gives a block the impulses of those points of `before` that its manifold still has.
fn remember(block: &mut Block, before: &Manifold, manifold: &Manifold) {
    let old = block.impulse;
    block.impulse = [0.0; 3];
    for k in 0..manifold.count {
        for (anchor, impulse) in before.anchors.iter().zip(old).take(before.count) {
            if manifold.anchors[k].feature == anchor.feature {
                block.impulse[k] = impulse;
            }
        }
    }
    let (kept, sum) = (block.impulse[0] + block.impulse[1], old[0] + old[1]);
    if kept > 0.0 {
        block.impulse[2] = old[2] * (kept / sum);
    }
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

fn next_event(
    group: &mut Group,
    (watch, around): (&Watch, &dyn Surroundings),
    block: u32,
    to: Real,
) -> Option<Event> {
    let k = block as usize;
    let bodies = group.blocks[k].bodies;
    let [since_a, since_b] = bodies.map(|slot| watch.since[slot as usize]);
    let from = since_a.max(since_b);
    let arrival = if group.links[k].watched == Watched::Swift {
        let pair = pair(group, k, watch.after_rows);
        let (arrival, manifold) = pair.first_meeting([from, to], around)?;
        group.found[group.links[k].number as usize] = manifold;
        arrival
    } else if watch.after_rows {
        return None;
    } else {
        pair(group, k, false).first_arrival(from, to)?
    };
    let stamp = watch.stamp(bodies);
    Some(Event { time: arrival.time, approach: arrival.approach, block, stamp })
}

fn pair(group: &Group, k: usize, kicked: bool) -> Pair<'_> {
    let [a, b] = group.blocks[k].bodies.map(|slot| slot as usize);
    Pair {
        link: &group.links[k],
        places: [&group.places[a], &group.places[b]],
        velocities: [&group.velocities[a], &group.velocities[b]],
        angles: [group.angles[a], group.angles[b]],
        kicked,
        h: group.h,
    }
}

/// One impact.
fn strike(
    group: &mut Group,
    watch: &mut Watch,
    event: &Event,
    law: ImpactLaw,
    outcome: &mut Outcome,
) {
    let (k, kicked) = (event.block as usize, watch.after_rows);
    if group.links[k].watched == Watched::Swift {
        let link = &mut group.links[k];
        link.manifold = group.found[link.number as usize];
        (link.met, link.apart_now) = (true, false);
    }
    let (link, time) = (group.links[k], event.time);
    let joined = group.ties.joins(&group.blocks[k]);
    watch.struck.clear();
    if joined {
        outcome.ledger.dissipated -= hold_still(group, watch, time);
    }
    let pair = pair(group, k, kicked);
    let (places, velocities) = (pair.places_at(time), pair.velocities_at(time));
    let bodies = [&velocities[0], &velocities[1]];
    let at = moved(&link.manifold, link.apart, [&places[0], &places[1]]);
    let mut block = group.blocks[k];
    block.place(&link.manifold, &at, bodies);
    block.impulse = [0.0; 3];
    block.sliding = false;
    let mut u = block.velocity(bodies);
    u[2] -= link.tangent_speed;
    let mut restitution = [0.0; 2];
    // What meets within rounding of the first point meets with it.
    let nearest = at.gap[..link.manifold.count].iter().copied().fold(Real::INFINITY, Real::min);
    let touching = (1e-9 * link.width).max(4.0 * nearest);
    for p in 0..2 {
        let touches = p < link.manifold.count && at.gap[p] <= touching;
        block.on[p] = touches && u[p] < 0.0;
        restitution[p] = if -u[p] > link.resting[p] { link.restitution } else { 0.0 };
    }
    if joined {
        group.ties.respond(&group.velocities, &mut block);
    } else {
        block.prepare(bodies);
    }
    let impulse = law::impulses(law, &block, u, restitution);

    outcome.impacts += 1;
    let given = if group.driven {
        super::group::driving_work(&block, (&impulse, link.tangent_speed), bodies)
    } else {
        0.0
    };
    outcome.ledger.work += given;
    outcome.ledger.dissipated -= if joined {
        push_all(group, watch, &impulse, time) - given
    } else {
        push_two(group, watch, (&block, &impulse), time);
        law::gain(&block, &u, &impulse)
    };
    let hit = &mut group.links[k].hit;
    hit.impulse += impulse[0] + impulse[1];
    if event.approach > hit.approach {
        (hit.approach, hit.time, hit.normal) = (event.approach, group.middle + time, block.normal);
        let struck = (0..link.manifold.count).filter(|p| block.on[*p]);
        let points = struck.clone().map(|p| at.surface_point(&link.manifold, p));
        hit.point = places[0].way + points.sum::<Vec2>() / struck.count().max(1) as Real;
    }
}

/// Gives the two bodies of a block an impact's impulses, and notes who was moved.
fn push_two(
    group: &mut Group,
    watch: &mut Watch,
    (block, impulse): (&Block, &[Real; 3]),
    time: Real,
) {
    let before = block.bodies.map(|slot| group.velocities[slot as usize]);
    block.push(crate::solvers::sweep::pair(&mut group.velocities, block.bodies), *impulse);
    for (slot, before) in block.bodies.into_iter().zip(&before) {
        let (now, old) = (group.velocities[slot as usize].twist, &before.twist);
        let change = Twist::new(now.linear - old.linear, now.angular - old.angular);
        group.places[slot as usize].drift(&change, -time);
        if !before.is_fixed() {
            watch.struck.push(slot);
        }
    }
}

/// Gives all bodies what an impact's impulses and the joints' answers to them change. Returns the kinetic energy that they
/// gain (J).
fn push_all(group: &mut Group, watch: &mut Watch, impulse: &[Real; 3], time: Real) -> Real {
    let ties = &group.ties;
    let change = |slot: usize| {
        let mut sum = Twist::ZERO;
        for (row, p) in impulse.iter().enumerate() {
            let unit = ties.carried(row, slot);
            sum += Twist::new(unit.linear * *p, unit.angular * p);
        }
        sum
    };
    let changes: Vec<Twist> = (0..group.velocities.len()).map(change).collect();
    change_all(group, watch, &changes, time)
}

/// Lets rigid rows hold at the moment of an impact. Returns the kinetic energy that the bodies gain (J).
fn hold_still(group: &mut Group, watch: &mut Watch, time: Real) -> Real {
    let mut velocities = group.velocities.clone();
    let since = if watch.after_rows { time - 0.5 * group.h } else { time };
    for (velocity, place) in velocities.iter_mut().zip(&group.places) {
        velocity.twist += place.kick(since);
    }
    let changes = group.ties.still(&velocities).to_vec();
    change_all(group, watch, &changes, time)
}

/// Changes the velocities of all bodies at the moment of an impact, and notes who was moved. Returns the kinetic
/// energy that they gain (J).
fn change_all(group: &mut Group, watch: &mut Watch, changes: &[Twist], time: Real) -> Real {
    let Group { velocities, places, masses, h, .. } = group;
    // As Pair::velocities_at has it.
    let since = if watch.after_rows { time - 0.5 * *h } else { time };
    let mut gained = 0.0;
    for (slot, change) in changes.iter().enumerate().filter(|(_, change)| **change != Twist::ZERO) {
        let mut mean = velocities[slot].twist;
        mean += places[slot].kick(since);
        mean += Twist::new(change.linear * 0.5, change.angular * 0.5);
        gained += masses[slot].work(change, &mean);
        velocities[slot].twist += *change;
        places[slot].drift(change, -time);
        if !watch.struck.contains(&(slot as u32)) {
            watch.struck.push(slot as u32);
        }
    }
    gained
}

/// Takes the geometry anew where an impact moved it: that of the middle, or of the last impact if it came after,
/// because the path that the bodies take from there was not theirs before.
fn place_struck(group: &mut Group, watch: &Watch) {
    for k in 0..group.blocks.len() {
        let slots = group.blocks[k].bodies.map(|slot| slot as usize);
        if slots.iter().any(|slot| watch.seen[*slot] > 0) {
            let time = slots.map(|slot| watch.since[slot]);
            super::place_block(group, k, time[0].max(time[1]).max(0.0));
        }
    }
}
