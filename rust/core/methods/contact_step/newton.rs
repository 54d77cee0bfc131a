//! All rows of a group solved at once: sweeps find how contacts stand and reviews how joints bear, one sparse solution moves all
//! rows to where that leads, sweeps look whether it holds.
//!
//! A set that is wrong may ask for what no impulses give, and the nearer its rows are to depending on one another, the farther
//! away the solution. So each solution is a proximal one: rows give way by ε·JM⁻¹Jᵀ of the change of their impulses, ε small where
//! that goes well and larger where it does not (as Levenberg and Marquardt damp Newton's method). Where the set is right, ε costs
//! no more than another solution with the same factors.

use super::joints::{self, Row, Ties};
use super::{Group, Outcome};
use crate::constraints::Velocity;
use crate::constraints::contact::Block;
use crate::math::{Real, Twist};
use crate::solvers::newton::{Guess, Newton};
use crate::solvers::sweep::{self, Budget};

/// What is solved to, in parts of what sweeps are asked for.
const EXACT: Real = 1e-2;

/// A sweep hardly moves a body that gives way less than this part of its contact does: what such a body lacks is not seen in what sweeps
/// change, and comes back in each substep as an impulse, which is large to the other.
const FELT: Real = 3e-3;

/// There nothing stands unless a second sweep changes no more than so many times the rounding.
const STANDS: Real = 3.0;

/// Rounding of velocities, in parts of the fastest.
const ROUNDING: Real = 1e-14;

/// ε at first. Half of the digits are lost to it in factors of the bodies alone.
const EPSILON: Real = 1e-8;

/// ε at least.
const LEAST: Real = 1e-10;

/// Change of ε after a step that goes well, and after one that does not.
const CHANGE: [Real; 2] = [0.1, 100.0];

/// Where a step went wrong, ε stays this many times above; that falls by the second from step to step.
const CAREFUL: [Real; 2] = [10.0, 0.7];

/// A step that leaves so many times as much as the best is undone.
const WORSE: Real = 10.0;

/// Sweeps that are added to those after each step that was undone, and most of them.
const MORE: [u32; 2] = [3, 20];

/// Steps that are undone before what satisfies sweeps is enough.
const PATIENCE: u32 = 3;

/// Most solutions with the same factors. Each leaves ε of what there was, times the ratio of masses: two are the rule.
const SOLUTIONS: usize = 8;

/// Another solution is worth while if the last one changed this part of the one before at most.
const SHRINKS: Real = 0.3;

/// Most factorisations and most solutions.
const MOST: [u32; 2] = [30, 80];

/// The system of a group, with the room it needs.
#[derive(Clone, Debug, Default)]
pub struct Together {
    system: Newton,
    saved: Saved,
    /// Rows of joints in the factors.
    noted: Vec<[bool; 3]>,
}

/// Impulses and velocities, to go back to.
#[derive(Clone, Debug, Default)]
struct Saved {
    contacts: Vec<([Real; 3], Real, bool)>,
    joints: Vec<Row>,
    twists: Vec<Twist>,
}

/// What moves: bodies, contacts and joints.
struct Rows<'a> {
    velocities: &'a mut [Velocity],
    blocks: &'a mut [Block],
    ties: &'a mut Ties,
}

/// How far a search has come.
struct Search {
    epsilon: Real,
    /// Below which ε does not fall now.
    least: Real,
    /// Sweeps after a step that is undone.
    more: u32,
    undone: u32,
    factorisations: u32,
    sweeps: u32,
    best: Real,
    /// Work that may be done, and that was (products of blocks).
    allowed: Real,
    spent: Real,
}

/// Solves all rows, as far as the work allowed goes; returns the number of sweeps and what the rows still lack (m/s).
pub fn solve(
    group: &mut Group,
    (budget, allowed): (Budget, Real),
    outcome: &mut Outcome,
) -> (u32, Real, Real) {
    let Group { velocities, blocks, ties, together, .. } = group;
    let mut rows = Rows { velocities, blocks, ties };
    let mut first = rows.look(1, false);
    let tolerance = EXACT * budget.tolerance;
    if first <= tolerance {
        let stands;
        (first, stands) = rows.look_again(budget.tolerance / super::CALM);
        if stands {
            return (2, first, 0.0);
        }
    }
    let tolerance = tolerance.max(ROUNDING * rows.fastest());
    let mut search = Search::new(allowed);
    let together = together.get_or_insert_default();
    let residual = together.search(&mut rows, (first, tolerance, budget), &mut search);
    outcome.factorisations += u64::from(search.factorisations);
    (search.sweeps, residual, search.spent)
}

impl Together {
    /// Steps until the rows lack no more than a tolerance, or little enough for sweeps after steps that went wrong, or the
    /// most of all is reached. The best is kept.
    fn search(
        &mut self,
        rows: &mut Rows,
        (first, tolerance, budget): (Real, Real, Budget),
        search: &mut Search,
    ) -> Real {
        self.system.analyse(rows.velocities, rows.blocks, rows.ties.links());
        self.noted.clear();
        let mut residual = first;
        for step in 0..MOST[1] {
            if residual < search.best || step == 0 {
                search.best = residual;
                self.saved.save(rows);
            }
            if residual <= WORSE * search.best {
                search.goes_well();
            } else {
                self.saved.restore(rows);
                residual = rows.look(search.more, false);
                search.best = residual;
                self.saved.save(rows);
                search.goes_wrong();
            }
            let enough = search.undone >= PATIENCE && residual <= budget.tolerance;
            let spent = search.spent > 0.0 && search.spent >= search.allowed;
            let done = step > 0 && residual <= tolerance;
            if done || enough || spent || search.factorisations >= MOST[0] {
                break;
            }
            residual = self.step(rows, search, tolerance).unwrap_or(Real::INFINITY);
        }
        if residual > search.best {
            self.saved.restore(rows);
        } else if search.factorisations > 0 && residual <= tolerance {
            return self.even_out(rows, (residual, tolerance), search);
        }
        residual.min(search.best)
    }

    /// Where two bodies meet in more contacts than one, as a table on its legs does with the ground, rows depend on one another, and how they
    /// share loads depends on the order of sweeps and on the last substep. Of all impulses that do what was found, takes the
    /// smallest ones: those that a solution from none at all leads to, with all that touches bearing and all that does not slip
    /// sticking. Kept only if nothing is lacking then; returns what is.
    fn even_out(
        &mut self,
        rows: &mut Rows,
        (residual, tolerance): (Real, Real),
        search: &mut Search,
    ) -> Real {
        if !self.system.meets_twice() {
            return residual;
        }
        self.saved.save(rows);
        let joints = rows.ties.solved_rows(&mut self.noted);
        let how = (EPSILON, Guess::Touching(tolerance));
        let made = self.system.factor((rows.velocities, rows.blocks), joints, how);
        search.factorisations += u32::from(made);
        search.spent += self.system.cost(made);
        rows.release();
        let solved = self.solutions(rows).is_some();
        let left = rows.look(1, false);
        if solved && left <= residual.max(rows.rounding()) {
            return left;
        }
        self.saved.restore(rows);
        residual
    }

    /// Solutions with the present factors, as long as they gain; none where they are no numbers.
    fn solutions(&mut self, rows: &mut Rows) -> Option<()> {
        let system = &mut self.system;
        let contacts = system.contacts();
        let mut before = Real::INFINITY;
        for _ in 0..SOLUTIONS {
            system.lack(rows.velocities, rows.blocks);
            rows.ties.lack(rows.velocities, &mut system.wanted[contacts..]);
            let change = system.solve(rows.velocities, rows.blocks)?;
            rows.ties.add(rows.velocities, &system.solved[contacts..]);
            if change <= rows.rounding() || change > SHRINKS * before {
                break;
            }
            before = change;
        }
        Some(())
    }

    /// One solution and a sweep: what the rows lack then, or nothing if that is no number.
    fn step(&mut self, rows: &mut Rows, search: &mut Search, tolerance: Real) -> Option<Real> {
        let Self { system, noted, .. } = self;
        let joints = rows.ties.solved_rows(noted);
        let guess = match search.factorisations {
            0 => Guess::Cold(tolerance),
            _ => Guess::Swept,
        };
        let how = (search.epsilon, guess);
        let made = system.factor((rows.velocities, rows.blocks), joints, how);
        search.factorisations += u32::from(made);
        search.spent += system.cost(made);
        self.solutions(rows)?;
        search.sweeps += 1;
        let residual = rows.look(1, search.factorisations > joints::TOGETHER as u32);
        rows.fastest().is_finite().then_some(residual)
    }
}

impl Search {
    fn new(allowed: Real) -> Self {
        Self {
            allowed,
            spent: 0.0,
            epsilon: EPSILON / CHANGE[0],
            least: LEAST,
            more: 1,
            undone: 0,
            factorisations: 0,
            sweeps: 1,
            best: Real::INFINITY,
        }
    }

    fn goes_well(&mut self) {
        self.epsilon = (self.epsilon * CHANGE[0]).max(self.least);
        self.least = (self.least * CAREFUL[1]).max(LEAST);
    }

    fn goes_wrong(&mut self) {
        self.least = (self.epsilon * CAREFUL[0]).min(1.0);
        self.epsilon = (self.epsilon * CHANGE[1]).min(1.0);
        self.sweeps += self.more;
        self.more = (self.more + MORE[0]).min(MORE[1]);
        self.undone += 1;
    }
}

impl Rows<'_> {
    /// Reviews the joints and sweeps the contacts a number of times; returns what they lack.
    fn look(&mut self, sweeps: u32, one_by_one: bool) -> Real {
        let Self { velocities, blocks, ties, .. } = self;
        let mut residual = 0.0;
        for _ in 0..sweeps {
            ties.review(velocities, one_by_one);
            residual = sweep::refine(velocities, blocks, &mut |_, _, _| {});
            residual = residual.max(ties.largest_lack(velocities));
        }
        residual
    }

    /// Sweeps once more; returns what the rows lack, and whether no impulse changed beyond rounding where one of the bodies hardly feels it.
    /// The kick is the velocity that forces give in the substep.
    fn look_again(&mut self, kick: Real) -> (Real, bool) {
        let noise = ROUNDING * self.fastest();
        let Self { velocities, blocks, ties } = self;
        let mut stands = true;
        let residual = sweep::refine(velocities, blocks, &mut |block, bodies, change| {
            let least = least_response(block, bodies);
            if least < FELT * block.response[0].min(block.response[1]) {
                let load = block.impulse[0] + block.impulse[1];
                let rounding = STANDS * Real::EPSILON * (kick + load * least);
                stands &= sweep::along(block, change) <= rounding + noise;
            }
        });
        let residual = residual.max(ties.largest_lack(velocities));
        (residual, stands)
    }

    /// Takes the contacts' impulses back.
    fn release(&mut self) {
        for block in &mut *self.blocks {
            let back = block.impulse.map(|impulse| -impulse);
            block.push(sweep::pair(self.velocities, block.bodies), back);
            sweep::turn(sweep::pair(self.velocities, block.bodies), -block.rolling);
            (block.impulse, block.rolling) = ([0.0; 3], 0.0);
        }
    }

    /// What the last digits of the contacts' impulses change along their rows, at most (m/s).
    fn rounding(&self) -> Real {
        let of = |block: &Block| sweep::along(block, &block.impulse);
        Real::EPSILON * self.blocks.iter().map(of).fold(0.0, Real::max)
    }

    /// The largest velocity (m/s); infinite if one is no number.
    fn fastest(&self) -> Real {
        let speed = |velocity: &Velocity| {
            let known = velocity.twist.angular.is_finite();
            let speed = velocity.twist.linear.norm();
            if known && !speed.is_nan() { speed } else { Real::INFINITY }
        };
        self.velocities.iter().map(speed).fold(0.0, Real::max)
    }
}

/// What a unit impulse along the normal gives that body of a contact which gives way less.
fn least_response(block: &Block, bodies: [&Velocity; 2]) -> Real {
    let normal = |side: usize| (block.normal, block.arms[0][side]);
    let gives = [0, 1].map(|side| bodies[side].coupling(normal(side), normal(side)));
    match gives {
        [a, b] if a > 0.0 && b > 0.0 => a.min(b),
        [a, b] => a + b,
    }
}

impl Saved {
    fn save(&mut self, rows: &Rows) {
        self.contacts.clear();
        self.contacts
            .extend(rows.blocks.iter().map(|block| (block.impulse, block.rolling, block.sliding)));
        rows.ties.save(&mut self.joints);
        self.twists.clear();
        self.twists.extend(rows.velocities.iter().map(|velocity| velocity.twist));
    }

    fn restore(&self, rows: &mut Rows) {
        for (block, saved) in rows.blocks.iter_mut().zip(&self.contacts) {
            (block.impulse, block.rolling, block.sliding) = *saved;
        }
        rows.ties.restore(&self.joints);
        for (velocity, twist) in rows.velocities.iter_mut().zip(&self.twists) {
            velocity.twist = *twist;
        }
    }
}
