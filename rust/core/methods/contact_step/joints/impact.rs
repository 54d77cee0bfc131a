//! Impacts on bodies that are joined: what they strike feels all that hangs on them.

use super::active::fill;
use super::{Tie, Ties};
use crate::constraints::Velocity;
use crate::constraints::contact::Block;
use crate::constraints::joint::Action;
use crate::math::{Real, Twist};
use crate::solvers::links::Effort;

impl Ties {
    /// Whether a joint holds a body of a block.
    #[must_use]
    pub fn joins(&self, block: &Block) -> bool {
        let holds = |slot: &u32| self.list.iter().any(|tie| tie.slots.contains(&Some(*slot)));
        !self.list.is_empty() && block.bodies.iter().any(holds)
    }

    /// What the rigid rows have to change for Jv = 0, by slot: before an impact joints must not lag behind by half a
    /// substep, or energy would come of it.
    pub fn still(&mut self, velocities: &[Velocity]) -> &[Twist] {
        self.hold_rigidly(velocities);
        let Self { list, links, wanted, solved, change, solver, .. } = self;
        wanted.clear();
        wanted.resize(links.len(), [0.0; 3]);
        for tie in &*list {
            let twists = tie
                .slots
                .map(|slot| slot.map_or(Twist::ZERO, |slot| velocities[slot as usize].twist));
            for (k, now) in tie.middle.as_slice().iter().enumerate() {
                let lacks = -now.velocity([&twists[0], &twists[1]]);
                wanted[tie.first_node + k / 3][k % 3] = lacks;
            }
        }
        solved.clear();
        solved.resize(links.len(), [0.0; 3]);
        change.clear();
        change.resize(velocities.len(), Twist::ZERO);
        solver.solve(wanted, EFFORT, solved, change);
        change
    }

    /// Gives a block the response of its bodies with all that the rigid rows of [`Ties::still`] carry along, which
    /// [`Ties::carried`] then tells per unit of impulse.
    pub fn respond(&mut self, velocities: &[Velocity], block: &mut Block) {
        let directions = [block.normal, block.normal, block.tangent()];
        let Self { list, links, wanted, solved, change, solver, carried, .. } = self;
        for (row, carried) in carried.iter_mut().enumerate() {
            carried.clear();
            carried.resize(velocities.len(), Twist::ZERO);
            for (side, sign) in [(0, -1.0), (1, 1.0)] {
                let slot = block.bodies[side] as usize;
                let mut body = Velocity { twist: Twist::ZERO, ..velocities[slot] };
                body.push(directions[row], block.arms[row][side], sign);
                carried[slot] = body.twist;
            }
            wanted.clear();
            wanted.resize(links.len(), [0.0; 3]);
            for tie in &*list {
                let twists = twists_of(tie, carried);
                for (k, now) in tie.middle.as_slice().iter().enumerate() {
                    let lacks = -now.velocity([&twists[0], &twists[1]]);
                    wanted[tie.first_node + k / 3][k % 3] = lacks;
                }
            }
            solved.clear();
            solved.resize(links.len(), [0.0; 3]);
            change.clear();
            change.resize(velocities.len(), Twist::ZERO);
            solver.solve(wanted, EFFORT, solved, change);
            carried.iter_mut().zip(&*change).for_each(|(sum, change)| *sum += *change);
        }
        let entry = |i: usize, k: usize| -> Real {
            let along = |side: usize| {
                let twist = &self.carried[k][block.bodies[side] as usize];
                directions[i].dot(&twist.linear) + block.arms[i][side] * twist.angular
            };
            along(1) - along(0)
        };
        let response =
            [entry(0, 0), entry(1, 1), entry(0, 1), entry(0, 2), entry(1, 2), entry(2, 2)];
        block.respond(response);
    }

    /// Change of the velocity of a slot per unit of impulse of a row of the last block that was asked for.
    #[must_use]
    pub fn carried(&self, row: usize, slot: usize) -> Twist {
        self.carried[row][slot]
    }

    /// Hands the solver the rows that give no way in an impact: those that hold, and limits that carried a load.
    fn hold_rigidly(&mut self, velocities: &[Velocity]) {
        let Self { list, nodes, links, solver, prepared, .. } = self;
        fill(list, nodes, links.len(), |tie, k| {
            let row = &tie.middle.rows[k];
            let rigid = match row.action {
                Action::Hold => row.bound == Real::INFINITY,
                Action::Limit => tie.impulses[k] > 0.0 && row.position <= 0.0,
                _ => false,
            };
            rigid.then_some(0.0)
        });
        solver.prepare(velocities, links, nodes);
        *prepared = None;
    }
}

/// An impact happens once: what it lacks stays.
const EFFORT: Effort = Effort { sweeps: 4, accuracy: 1e-15 };

fn twists_of(tie: &Tie, twists: &[Twist]) -> [Twist; 2] {
    tie.slots.map(|slot| slot.map_or(Twist::ZERO, |slot| twists[slot as usize]))
}
