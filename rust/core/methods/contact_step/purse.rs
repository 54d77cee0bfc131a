//! Which groups are solved all at once: those that can pay for it.
//!
//! Every contact that persists earns a part of what sweeping it takes, and a group spends what its contacts have on factorisations.
//! What stands needs few and keeps a full purse; chains and small groups earn more than they need; in a heap that is stirred each
//! substep needs many, contacts are new and poor, and nearly all is swept. So a group costs at most so much more than sweeps alone,
//! whether or not the factorisations paid.

use super::settle::sweep;
use super::{Group, Outcome, newton};
use crate::math::Real;
use crate::solvers::sweep::Budget;

/// Work of a sweep over one contact, in products of blocks.
const SWEPT: Real = 2.5;

/// Part of the work of the most sweeps that a contact earns in a substep.
const EARNED: Real = 0.4;

/// An attempt begins with what so many steps are likely to cost: one that is cut short was for nothing.
const AHEAD: Real = 3.0;

/// Substeps for which a contact can save.
const SAVED: Real = 100.0;

/// Solves the rows all at once as far as the group can pay, by sweeps from there.
pub fn solve(group: &mut Group, budget: Budget, outcome: &mut Outcome) -> (u32, Real) {
    let earned = EARNED * SWEPT * Real::from(budget.most);
    let mut purse = 0.0;
    for link in &mut group.links {
        link.credit = (link.credit + earned).min(link.credit.max(SAVED * earned));
        purse += link.credit;
    }
    if purse < AHEAD * price(group) {
        return sweep(group, budget);
    }
    let (sweeps, residual, spent) = newton::solve(group, (budget, purse), outcome);
    let part = (1.0 - spent / purse).max(0.0);
    if spent > 0.0 {
        group.links.iter_mut().for_each(|link| link.credit *= part);
    }
    if residual <= budget.tolerance {
        return (sweeps, residual);
    }
    let (more, residual) = sweep(group, budget);
    (sweeps + more, residual)
}

/// What one step is likely to cost.
fn price(group: &Group) -> Real {
    let contacts = group.links.len() as Real;
    contacts * (20.0 + contacts.sqrt())
}
