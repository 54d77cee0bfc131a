//! Rows swept until they settle and give no energy.

use super::group::RowWork;
use super::{Group, Outcome, joints, newton, project, purse, wide};
use crate::constraints::Velocity;
use crate::constraints::contact::Block;
use crate::math::{Real, Twist};
use crate::solvers::Solver;
use crate::solvers::sweep::{self, Budget};

/// Times that the budget of sweeps is granted again.
const MOST_ROUNDS: u32 = 20;

/// Rounds in which all rows may be solved at once: before targets are limited, and after.
const SOLVED: u32 = 2;

/// Limited rows that would not give as little after so many rounds more, at the rate of the last one, are swept no further: in
/// large heaps that are not settled a round takes a tenth of it, and weakening takes the rest at once.
const HOPE: Real = 2.0;

/// Energy, as a part of that of the change of velocities, that is taken back by weakening all rows alike.
const LITTLE: Real = 1e-3;

/// Sweeps until the velocities settle or the budget is used up, and on while what they lack would bring bodies farther into one
/// another than a pass of [`project`] brings them out. Where the rows give more than a little energy, what they ask for is
/// limited to what gives none, and they are swept on as well, as long as that helps.
pub fn settle(
    group: &mut Group,
    (h, budget): (Real, Budget),
    solver: Solver,
    outcome: &mut Outcome,
) -> RowWork {
    let width = group.links.iter().map(|link| link.width).fold(0.0, Real::max);
    let allowed = project::MOST * width / h;
    let mut budget = budget;
    let mut limited = false;
    let mut before = Real::INFINITY;
    for round in 0.. {
        let (sweeps, residual) = match solver {
            _ if round >= SOLVED || group.blocks.is_empty() => sweep(group, budget),
            Solver::Sweep => sweep(group, budget),
            Solver::Newton => solve_all(group, (budget, Real::INFINITY), outcome),
            Solver::Auto => purse::solve(group, budget, outcome),
        };
        outcome.sweeps += u64::from(sweeps);
        if group.wide.on && group.driven {
            wide::give_driven(group);
        }
        let work = group.row_work(h);
        let gives = work.gain > LITTLE * work.changed;
        let lacks = residual > allowed;
        let settled = residual <= budget.tolerance && (limited || !gives);
        let part = work.gain / work.changed;
        let idle = limited && !lacks && HOPE * (before - part) < part;
        let last = round == MOST_ROUNDS || !group.ties.is_empty() || idle;
        if last || settled || !(gives || lacks) {
            outcome.residual = outcome.residual.max(residual);
            return work;
        }
        if gives && !limited {
            if group.wide.on {
                wide::limit_targets(group, h);
            } else {
                limit_targets(group, h);
            }
            limited = true;
        } else {
            before = part;
        }
        if lacks {
            budget.tolerance = budget.tolerance.max(allowed);
        }
    }
    unreachable!("the last round returns")
}

/// All rows at once; where that fails, sweeps go on from the best.
fn solve_all(
    group: &mut Group,
    (budget, allowed): (Budget, Real),
    outcome: &mut Outcome,
) -> (u32, Real) {
    let (sweeps, residual, _) = newton::solve(group, (budget, allowed), outcome);
    if residual <= budget.tolerance {
        return (sweeps, residual);
    }
    let (more, residual) = sweep(group, budget);
    (sweeps + more, residual)
}

pub(super) fn sweep(group: &mut Group, budget: Budget) -> (u32, Real) {
    let Group { velocities, blocks, lanes, ties, wide, .. } = group;
    if wide.on {
        let result = lanes.solve(blocks, budget);
        lanes.give_velocities(velocities);
        return result;
    }
    if ties.is_empty() {
        sweep::solve_many(velocities, blocks, lanes, budget)
    } else {
        alternate(ties, (velocities, blocks), budget)
    }
}

/// Joints, all at once, and contacts, one after the other, in turn until neither changes; joints have the last word.
fn alternate(
    ties: &mut joints::Ties,
    (velocities, blocks): (&mut [Velocity], &mut [Block]),
    budget: Budget,
) -> (u32, Real) {
    joints::solve(ties, velocities, if blocks.is_empty() { joints::ROUNDS } else { joints::TURN });
    if blocks.is_empty() {
        return (0, 0.0);
    }
    let single = Budget { most: 1, ..budget };
    let mut residual = 0.0;
    for sweep in 1..=budget.most {
        (_, residual) = sweep::solve(velocities, blocks, single);
        residual = joints::solve(ties, velocities, joints::TURN).max(residual);
        if residual <= budget.tolerance {
            return (sweep, residual);
        }
    }
    (budget.most, residual)
}

/// v ≤ −v⁻ of every row: it leaves no faster than it came, and what parts already falls back.
fn limit_targets(group: &mut Group, h: Real) {
    let Group { velocities, places, blocks, free, .. } = group;
    for block in blocks {
        let start = block.bodies.map(|slot| {
            let slot = slot as usize;
            let kick = places[slot].kick(h);
            let twist =
                Twist::new(free[slot].linear - kick.linear, free[slot].angular - kick.angular);
            Velocity { twist, ..velocities[slot] }
        });
        let came = block.velocity([&start[0], &start[1]]);
        for (target, came) in block.target.iter_mut().zip(came).take(usize::from(block.count)) {
            *target = target.min(-came);
        }
    }
}

/// Weakens all impulses of the rows by that part which makes them give no energy: weakened by a factor s they do the work
/// s(gain − changed) + s²·changed. Returns s.
pub fn weaken(group: &mut Group, work: &RowWork, outcome: &mut Outcome) -> Real {
    let part = (1.0 - work.gain / work.changed).max(0.0);
    let Group { velocities, free, blocks, .. } = group;
    for (velocity, free) in velocities.iter_mut().zip(&*free) {
        let now = &mut velocity.twist;
        let change = now.linear - free.linear;
        outcome.residual = outcome.residual.max((1.0 - part) * change.norm());
        now.linear = free.linear + change * part;
        now.angular = free.angular + (now.angular - free.angular) * part;
    }
    for block in blocks {
        block.impulse.iter_mut().for_each(|impulse| *impulse *= part);
        block.rolling *= part;
    }
    if group.wide.on {
        wide::weaken(group, part);
    }
    part
}
