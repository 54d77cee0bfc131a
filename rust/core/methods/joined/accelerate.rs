//! Accelerations of bodies that joints tie: a = M⁻¹(F + Jᵀλ) with λ such that every row that holds has
//! C̈ = Ja + J̇v = 0.
//!
//! Hairer, Wanner, "Solving Ordinary Differential Equations II" (1996), section VII.1: the system of index 1.

use super::{Joints, Tie};
use crate::constraints::joint::{Action, Row, Rows};
use crate::forces::Ledger;
use crate::joint::Coefficients;
use crate::math::{Pose, Real, Twist, Wrench, vec2};

impl Joints {
    /// Adds what joints do to the accelerations by all other forces; returns the power (W) that dampers take and that bodies of given
    /// motion put in.
    pub fn accelerate(&mut self, poses: &[Pose], twists: &[Twist], out: &mut [Twist]) -> Ledger {
        self.look(poses, twists);
        self.reactions.fill(Wrench::ZERO);
        self.share = 1.0;
        let mut power = Ledger::default();
        if !self.springless {
            power = self.add_springs(twists, out);
            self.book_springs(twists, 1.0);
        }
        if self.holds() {
            self.factor();
            self.solve(out, |row, a| -(row.velocity(a) + row.turning));
            for (a, change) in out.iter_mut().zip(&self.response) {
                *a += *change;
            }
            power.work += self.driving_of_solution(twists);
            self.book_impulses();
        }
        power
    }

    /// Adds the accelerations by springs, −M⁻¹Jᵀ(kC + cJv), where rows were last looked at, for bodies that move with
    /// `twists`; returns their powers (W).
    pub fn add_springs(&self, twists: &[Twist], out: &mut [Twist]) -> Ledger {
        let mut power = Ledger::default();
        for (tie, rows) in self.ties.iter().zip(&self.rows) {
            for row in rows.as_slice() {
                let Action::Spring(spring) = row.action else { continue };
                let rate = row.velocity(tie.of(twists));
                let force = pull(&spring, row, rate);
                self.push(tie, row, force, out);
                power.dissipated += spring.damping * rate * rate;
                power.work += self.driving((tie, row), force, twists);
            }
        }
        power
    }

    /// Adds what springs do over a time to the reactions.
    pub fn book_springs(&mut self, twists: &[Twist], time: Real) {
        for k in 0..self.ties.len() {
            let rows = self.rows[k];
            for row in rows.as_slice() {
                let Action::Spring(spring) = row.action else { continue };
                let rate = row.velocity(self.ties[k].of(twists));
                self.book_reaction(k, row, time * pull(&spring, row, rate));
            }
        }
    }

    /// Energy (J) in the springs where rows were last looked at.
    pub(super) fn spring_energy(&self) -> Real {
        let energy = |row: &Row| match row.action {
            Action::Spring(spring) => 0.5 * spring.stiffness * row.position * row.position,
            _ => 0.0,
        };
        self.rows.iter().flat_map(Rows::as_slice).map(energy).sum()
    }

    /// Adds M⁻¹Jᵀf of a row.
    pub(super) fn push(&self, tie: &Tie, row: &Row, force: Real, out: &mut [Twist]) {
        for (slot, [x, y, turn]) in tie.bodies.iter().zip(row.jacobian) {
            let Some(slot) = slot.map(|slot| slot as usize) else { continue };
            let body = &self.inverse[slot];
            out[slot].linear += body.inverse_mass.component_mul(&vec2(x, y)) * force;
            out[slot].angular += body.inverse_inertia * turn * force;
        }
    }
}

/// −kC − cĊ.
fn pull(spring: &Coefficients, row: &Row, rate: Real) -> Real {
    -spring.stiffness * row.position - spring.damping * rate
}
