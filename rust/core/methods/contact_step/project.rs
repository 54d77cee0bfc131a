//! Overlap removed by moving positions only, so that no velocity comes of it (Cline and Pai, "Post-stabilization
//! for rigid body simulation with contact and constraints", 2003).

use super::Group;
use crate::constraints::contact::moved;
use crate::constraints::{Place, Velocity};
use crate::math::Real;

/// Overlap that is left alone, as a part of the smaller width: contacts stay closed and calm.
const SLOP: Real = 5e-4;
/// Part of the rest that one pass removes.
const PART: Real = 0.3;
/// Most that a pass removes, as a part of the width.
const MOST: Real = 0.05;
/// Passes a substep.
const PASSES: usize = 2;

/// Moves bodies apart; returns the work that takes against the forces (J).
pub fn apart(group: &mut Group, h: Real) -> Real {
    let mut work = 0.0;
    for pass in 0..PASSES {
        let mut any = false;
        for k in 0..group.blocks.len() {
            if pass > 0 || may_overlap(group, k, h) {
                any |= part_block(group, (k, h), &mut work);
            }
        }
        if !any {
            break;
        }
    }
    work
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
fn part_block(group: &mut Group, (k, h): (usize, Real), work: &mut Real) -> bool {
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
    for (side, slot, sign) in [(0, a, -1.0), (1, b, 1.0)] {
        let impulse = push.map(|x| sign * x);
        let torque = now.arms[0][side] * impulse[0] + now.arms[1][side] * impulse[1];
        let sum = now.normal * (impulse[0] + impulse[1]);
        let (place, velocity): (&mut Place, &Velocity) = (&mut places[slot], &velocities[slot]);
        let (way, turn) =
            (velocity.inverse_mass.component_mul(&sum), velocity.inverse_inertia * torque);
        place.way += way;
        place.rotate(turn);
        let force = place.acceleration;
        *work -= masses[slot].mass * force.linear.dot(&way)
            + masses[slot].inertia * force.angular * turn;
    }
    true
}

/// Shares of the two points that move both by what is wanted, or one of them at least that much.
fn pushes(
    now: &mut crate::constraints::contact::Block,
    wanted: [Real; 2],
    bodies: [&Velocity; 2],
) -> [Real; 2] {
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
