//! Overlap removed by moving positions only, so that no velocity comes of it (Cline and Pai, "Post-stabilization
//! for rigid body simulation with contact and constraints", 2003), but for what keeps angular momentum.
//!
//! Moving bodies carries their momenta to other lines; the two that are parted are then turned back together, so that
//! angular momentum stays.

use super::{Group, Outcome, wide};
use crate::constraints::contact::{Block, moved};
use crate::constraints::{Place, Velocity};
use crate::math::{Real, Twist, cross, perp};

/// Overlap that is left alone, as a part of the smaller width: contacts stay closed and calm.
pub const SLOP: Real = 5e-4;
/// Part of the rest that one pass removes.
pub const PART: Real = 0.3;
/// Most that a pass removes, as a part of the width.
pub const MOST: Real = 0.05;
/// Passes a substep.
const PASSES: usize = 2;

/// Moves bodies apart, and books the work that takes against the forces.
pub fn apart(group: &mut Group, h: Real, outcome: &mut Outcome) {
    if group.wide.on {
        wide::take_bodies(group);
    }
    for pass in 0..PASSES {
        let any = if group.wide.on {
            wide::part(group, (pass, h), outcome)
        } else {
            (0..group.blocks.len()).fold(false, |any, k| {
                let overlaps = pass > 0 || may_overlap(group, k, h);
                any | (overlaps && part_block(group, (k, h), outcome))
            })
        };
        if !any {
            break;
        }
    }
    if group.wide.on {
        wide::give_bodies(group);
    }
}

/// Whether a block will overlap at the end of the substep, by its gap in the middle.
fn may_overlap(group: &Group, k: usize, h: Real) -> bool {
    let (block, link) = (&group.blocks[k], &group.links[k]);
    let bodies = block.bodies.map(|slot| &group.velocities[slot as usize]);
    let along = block.velocity(bodies);
    (0..usize::from(block.count))
        .any(|p| block.on[p] && block.gap[p] + 0.5 * h * along[p] < -SLOP * link.width)
}

/// Parts one block. Points that part by themselves within two substeps are left to do so.
fn part_block(group: &mut Group, (k, h): (usize, Real), outcome: &mut Outcome) -> bool {
    let Group { velocities, places, blocks, links, masses, .. } = group;
    let (block, link) = (&blocks[k], &links[k]);
    let [a, b] = block.bodies.map(|slot| slot as usize);
    let at = moved(&link.manifold, link.apart, [&places[a], &places[b]]);
    let slop = SLOP * link.width;
    if !at.gap[..link.manifold.count].iter().any(|gap| *gap < -slop) {
        return false;
    }
    let mut now = *block;
    now.place(&link.manifold, &at, [&velocities[a], &velocities[b]]);
    let along = now.velocity([&velocities[a], &velocities[b]]);
    let mut wanted = [0.0; 2];
    for p in 0..link.manifold.count {
        let leaves = at.gap[p] + 2.0 * h * along[p] >= 0.0;
        now.on[p] = at.gap[p] < -slop && block.on[p] && !leaves;
        if now.on[p] {
            wanted[p] = (-PART * (at.gap[p] + slop)).min(MOST * link.width);
        }
    }
    if now.on == [false, false] {
        return false;
    }
    let push = pushes(&mut now, wanted, [&velocities[a], &velocities[b]]);
    let mut carried = 0.0;
    for (side, slot, sign) in [(0, a, -1.0), (1, b, 1.0)] {
        let impulse = push.map(|x| sign * x);
        let torque = now.arms[0][side] * impulse[0] + now.arms[1][side] * impulse[1];
        let sum = now.normal * (impulse[0] + impulse[1]);
        let (place, velocity): (&mut Place, &Velocity) = (&mut places[slot], &velocities[slot]);
        let (way, turn) =
            (velocity.inverse_mass.component_mul(&sum), velocity.inverse_inertia * torque);
        place.way += way;
        place.rotate(turn);
        carried += masses[slot].mass * cross(way, velocity.twist.linear);
        let force = place.acceleration;
        outcome.ledger.correction_work -= masses[slot].mass * force.linear.dot(&way)
            + masses[slot].inertia * force.angular * turn;
    }
    turn_back(group, (k, carried), 0.0, outcome);
    true
}

/// Gives back what the impulses of rows that are placed after the middle of the substep took of the angular momentum, since they
/// act in the middle, where the bodies are not yet there.
pub fn turn_back_late(group: &mut Group, h: Real, outcome: &mut Outcome) {
    for k in 0..group.blocks.len() {
        let (block, link) = (&group.blocks[k], &group.links[k]);
        if link.late && block.impulse != [0.0; 3] {
            let [a, b] = block.bodies.map(|slot| &group.places[slot as usize]);
            let carried = block.couple(link.apart + (b.way - a.way));
            turn_back(group, (k, carried), h, outcome);
        }
    }
}

/// Takes angular momentum from the two bodies of a block, by the least change of velocities that does: they turn as one rigid body
/// about their common centre of mass, so that they move against one another at the contact as before. The energy that it gives
/// is booked, the kick of the substep of length h being done. Bodies that do not give way in every direction keep no
/// angular momentum.
fn turn_back(group: &mut Group, (k, carried): (usize, Real), h: Real, outcome: &mut Outcome) {
    let Group { velocities, places, blocks, links, masses, .. } = group;
    let [a, b] = blocks[k].bodies.map(|slot| slot as usize);
    let free = |slot: usize| {
        let Velocity { inverse_mass, inverse_inertia, .. } = velocities[slot];
        inverse_mass.x > 0.0 && inverse_mass.y > 0.0 && inverse_inertia > 0.0
    };
    if carried == 0.0 || !free(a) || !free(b) {
        return;
    }
    let apart = links[k].apart + (places[b].way - places[a].way);
    let [m, n] = [a, b].map(|slot| masses[slot].mass);
    let shares = [-n / (m + n), m / (m + n)];
    let inertia = masses[a].inertia + masses[b].inertia + n * shares[1] * apart.norm_squared();
    let turn = -carried / inertia;
    for (slot, share) in [(a, shares[0]), (b, shares[1])] {
        let change = Twist::new(perp(apart) * (share * turn), turn);
        let old = velocities[slot].twist;
        velocities[slot].twist += change;
        let (new, kick) = (velocities[slot].twist, places[slot].kick(h));
        let mean = Twist::new(
            (old.linear + new.linear - kick.linear) * 0.5,
            0.5 * (old.angular + new.angular - kick.angular),
        );
        outcome.ledger.correction_work += masses[slot].work(&change, &mean);
        // What other contacts of the body do not know.
        let size = change.linear.norm() + turn.abs() * links[k].width;
        outcome.residual = outcome.residual.max(size);
    }
}

/// Shares of the two points that move both by what is wanted, or one of them at least that much.
fn pushes(now: &mut Block, wanted: [Real; 2], bodies: [&Velocity; 2]) -> [Real; 2] {
    now.prepare(bodies);
    let [k00, k11, k01, ..] = now.response;
    let alone = |w: Real, k: Real| if k > 0.0 { w / k } else { 0.0 };
    let det = k00 * k11 - k01 * k01;
    if now.on == [true, true] && det > 1e-6 * k00 * k11 {
        let both =
            [(k11 * wanted[0] - k01 * wanted[1]) / det, (k00 * wanted[1] - k01 * wanted[0]) / det];
        if both[0] >= 0.0 && both[1] >= 0.0 {
            return both;
        }
    }
    let single = [alone(wanted[0], k00), alone(wanted[1], k11)];
    if single[0] > single[1] { [single[0], 0.0] } else { [0.0, single[1]] }
}
