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

/// Times that what rows ask for may be limited: once more than for sweeps where all are solved at once, since others may give then.
const LIMITS: [u32; 2] = [1, 3];

/// Limited rows that would not give as little after so many rounds more, at the rate of the last one, are swept no further: in
/// large heaps that are not settled a round takes a tenth of it, and weakening takes the rest at once.
const HOPE: Real = 2.0;

/// Energy, as a part of that of the change of velocities, that is taken back by weakening all rows alike.
const LITTLE: Real = 1e-3;

/// Sweeps until the velocities settle or the budget is used up, and on while what they lack would bring bodies farther into one
/// another than a pass of [`project`] brings them out. Where the rows give more than a little energy (any, where all are solved at once), what
/// they ask for is limited to what gives none, and they are solved on as well, as long as that helps.
pub fn settle(
    group: &mut Group,
    (h, budget): (Real, Budget),
    solver: Solver,
    outcome: &mut Outcome,
) -> RowWork {
    let width = group.links.iter().map(|link| link.width).fold(0.0, Real::max);
    let allowed = project::MOST * width / h;
    let mut budget = budget;
    let at_once = solver == Solver::Newton;
    let most_limits = LIMITS[usize::from(at_once)];
    let mut limits = 0;
    let mut before = Real::INFINITY;
    for round in 0.. {
        let (sweeps, residual) = match solver {
            _ if round > most_limits || group.blocks.is_empty() => sweep(group, budget),
            Solver::Sweep => sweep(group, budget),
            Solver::Newton => solve_all(group, (budget, Real::INFINITY), outcome),
            Solver::Auto => purse::solve(group, budget, outcome),
        };
        outcome.sweeps += u64::from(sweeps);
        if group.wide.on && group.driven {
            wide::give_driven(group);
        }
        let work = group.row_work(h);
        let little = if at_once { work.rounding } else { LITTLE * work.changed };
        let gives = work.gain > little;
        let lacks = residual > allowed;
        let settled = residual <= budget.tolerance && (limits == most_limits || !gives);
        let part = work.gain / work.changed;
        let idle = limits > 0 && !lacks && HOPE * (before - part) < part;
        let last = round == MOST_ROUNDS || !group.ties.is_empty() || idle;
        if last || settled || !(gives || lacks) {
            outcome.residual = outcome.residual.max(residual);
            return work;
        }
        if gives && limits < most_limits {
            if group.wide.on {
                wide::limit_targets(group, h);
            } else {
                limit_targets(group, h, at_once);
            }
            limits += 1;
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

/// v ≤ −v⁻ of every row: it leaves no faster than it came, and what parts already falls back. Along the surface v = −v⁻ where sticking gives
/// energy, if that is asked for.
fn limit_targets(group: &mut Group, h: Real, along: bool) {
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
        let now = block.velocity(block.bodies.map(|slot| &velocities[slot as usize]));
        if along && !block.sliding && block.impulse[2] * (came[2] + now[2]) > 0.0 {
            block.target[2] = -came[2];
        }
    }
}

/// Weakens all impulses of the rows by that part which makes them give no energy: weakened by a factor s they do the work
/// s(gain − changed) + s²·changed. Returns s. What a body is given back counts as the speed that has as much energy.
pub fn weaken(group: &mut Group, work: &RowWork, outcome: &mut Outcome) -> Real {
    let part = (1.0 - work.gain / work.changed).max(0.0);
    let Group { velocities, free, blocks, masses, .. } = group;
    for ((velocity, free), mass) in velocities.iter_mut().zip(&*free).zip(&*masses) {
        let now = &mut velocity.twist;
        let change = now.linear - free.linear;
        let turn = now.angular - free.angular;
        let square = change.norm_squared() + mass.gyration_squared() * turn * turn;
        outcome.residual = outcome.residual.max((1.0 - part) * square.sqrt());
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
