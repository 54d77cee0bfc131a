//! Rows of joints for a system in which contacts stand as well.

use super::{Joints, Tie, held};
use crate::constraints::joint::Row;
use crate::forces::Ledger;
use crate::math::{Pose, Real, Twist, Wrench};

/// A row that holds: place of the tie and of the row among those it holds, slots of its bodies, the row, and what rounding
/// leaves of its value.
pub type HeldRow<'a> = (usize, usize, [Option<u32>; 2], &'a Row, Real);

impl Joints {
    /// Whether there is any joint.
    #[must_use]
    pub fn any(&self) -> bool {
        !self.ties.is_empty()
    }

    /// Begins an evaluation of forces where rows were looked at: adds the springs' accelerations, returns their powers (W).
    pub fn start_forces(&mut self, twists: &[Twist], out: &mut [Twist]) -> Ledger {
        self.reactions.fill(Wrench::ZERO);
        self.share = 1.0;
        let power = self.add_springs(twists, out);
        self.book_springs(twists, 1.0);
        power
    }

    /// The rows that hold.
    pub fn held_rows<'a>(&'a self, poses: &'a [Pose]) -> impl Iterator<Item = HeldRow<'a>> {
        self.held.iter().flat_map(move |&k| {
            let tie: &Tie = &self.ties[k as usize];
            let rows = held(&self.rows[k as usize]).enumerate();
            rows.map(move |(j, row)| {
                (k as usize, j, tie.bodies, row, tie.place_rounding(row, poses))
            })
        })
    }

    /// Books the force of a row that holds; returns the power (W) that bodies of given motion put in.
    pub fn book_held(&mut self, (tie, row): (usize, usize), force: Real, twists: &[Twist]) -> Real {
        let Some(row) = held(&self.rows[tie]).nth(row).copied() else { return 0.0 };
        self.book_reaction(tie, &row, force);
        self.driving((&self.ties[tie], &row), force, twists)
    }
}
