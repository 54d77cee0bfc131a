//! Rows solved one block after the other, again and again (block Gauss–Seidel), until the velocities
//! change by no more than is asked or the sweeps are used up.

use super::block;
use super::lanes::Lanes;
use crate::constraints::Velocity;
use crate::constraints::contact::Block;
use crate::math::Real;

/// How long to sweep.
#[derive(Clone, Copy, Debug)]
pub struct Budget {
    /// Change of velocity in a sweep below which it is over (m/s).
    pub tolerance: Real,
    /// Most sweeps.
    pub most: u32,
}

/// Gives the bodies the impulses that the blocks remember.
pub fn warm_start(velocities: &mut [Velocity], blocks: &mut [Block]) {
    for block in blocks {
        for k in 0..2 {
            if !block.on[k] {
                block.impulse[k] = 0.0;
            }
        }
        let bound = block.friction.sticking * (block.impulse[0] + block.impulse[1]);
        block.impulse[2] = block.impulse[2].clamp(-bound, bound);
        if block.impulse != [0.0; 3] || block.rolling != 0.0 {
            let (impulse, rolling) = (block.impulse, block.rolling);
            let bodies = pair(velocities, block.bodies);
            turn(bodies, rolling);
            block.push(pair(velocities, block.bodies), impulse);
        }
    }
}

/// Sweeps over the blocks, eight at a time where that pays, to the same bits; returns the number of sweeps and the largest
/// change in the last one (m/s).
pub fn solve_many(
    velocities: &mut [Velocity],
    blocks: &mut [Block],
    lanes: &mut Lanes,
    budget: Budget,
) -> (u32, Real) {
    if lanes.pay(velocities, blocks) {
        solve_packed(velocities, blocks, lanes, budget)
    } else {
        solve(velocities, blocks, budget)
    }
}

/// The same over blocks that are packed.
pub(super) fn solve_packed(
    velocities: &mut [Velocity],
    blocks: &mut [Block],
    lanes: &mut Lanes,
    budget: Budget,
) -> (u32, Real) {
    lanes.load(velocities, blocks);
    let result = lanes.solve(blocks, budget);
    lanes.store(velocities, blocks);
    result
}

/// Sweeps over the blocks; returns the number of sweeps and the largest change in the last one (m/s).
pub fn solve(velocities: &mut [Velocity], blocks: &mut [Block], budget: Budget) -> (u32, Real) {
    let mut change = 0.0;
    for sweep in 1..=budget.most {
        change = 0.0;
        for block in &mut *blocks {
            let bodies = pair(velocities, block.bodies);
            change = block::solve(block, bodies).max(change);
            if block.rolling_resistance > 0.0 {
                resist_rolling(block, pair(velocities, block.bodies));
            }
        }
        if change <= budget.tolerance {
            return (sweep, change);
        }
    }
    (budget.most, change)
}

/// One sweep whose pushes are not rounded to the impulses' last digits (see `block::refine`); `watch` sees each block
/// with its bodies and the change of its impulses. Returns the largest change (m/s).
pub fn refine(
    velocities: &mut [Velocity],
    blocks: &mut [Block],
    watch: &mut impl FnMut(&Block, [&Velocity; 2], &[Real; 3]),
) -> Real {
    let mut largest: Real = 0.0;
    for block in blocks {
        let [a, b] = pair(velocities, block.bodies);
        let change = block::refine(block, [a, b]);
        watch(block, [a, b], &change);
        largest = largest.max(along(block, &change));
        if block.rolling_resistance > 0.0 {
            resist_rolling(block, pair(velocities, block.bodies));
        }
    }
    largest
}

/// The largest velocity (m/s) that a change of a block's impulses gives along one of its rows.
pub fn along(block: &Block, change: &[Real; 3]) -> Real {
    let [k00, k11, _, _, _, ktt] = block.response;
    (change[0] * k00).abs().max((change[1] * k11).abs()).max((change[2] * ktt).abs())
}

/// |λ_r| ≤ arm·(λ_0 + λ_1), ω_b = ω_a within it.
fn resist_rolling(block: &mut Block, [a, b]: [&mut Velocity; 2]) {
    let response = a.inverse_inertia + b.inverse_inertia;
    if response == 0.0 {
        return;
    }
    let bound = block.rolling_resistance * (block.impulse[0] + block.impulse[1]);
    let wanted = block.rolling - (b.twist.angular - a.twist.angular) / response;
    let new = wanted.clamp(-bound, bound);
    turn([a, b], new - block.rolling);
    block.rolling = new;
}

/// Turns two bodies against one another by an impulse (N·m·s).
pub fn turn([a, b]: [&mut Velocity; 2], impulse: Real) {
    a.twist.angular -= a.inverse_inertia * impulse;
    b.twist.angular += b.inverse_inertia * impulse;
}

/// Two different slots at once.
///
/// # Panics
/// If the two are one, which no contact is: a body does not touch itself.
pub fn pair(velocities: &mut [Velocity], [a, b]: [u32; 2]) -> [&mut Velocity; 2] {
    let [a, b] = [a as usize, b as usize];
    // OK because a contact is always between two different bodies of the group.
    velocities.get_disjoint_mut([a, b]).expect("two different bodies")
}
