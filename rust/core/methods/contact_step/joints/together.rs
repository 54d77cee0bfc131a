//! The rows of joints as a part of a larger system, that of all rows of a group.

use super::Ties;
use super::active::{self, Row, State, fill};
use super::prepare::push;
use crate::constraints::Velocity;
use crate::math::Real;
use crate::solvers::direct::{Link, Rows, Triple};

impl Ties {
    /// The links of the joints.
    pub fn links(&self) -> &[Link] {
        &self.links
    }

    /// The rows that are solved, or none where they are those that were noted.
    pub fn solved_rows(&mut self, noted: &mut Vec<[bool; 3]>) -> Option<&[Rows]> {
        let Self { list, rows, nodes, links, .. } = self;
        if active::note_solved((list, rows), noted, links.len()) {
            return None;
        }
        fill(list, nodes, links.len(), |tie, k| {
            let row = &rows[tie.first_row + k];
            (row.state == State::Solved).then_some(row.compliance)
        });
        Some(nodes)
    }

    /// Writes what the rows that are solved lack.
    pub fn lack(&self, velocities: &[Velocity], wanted: &mut [Triple]) {
        self.each_lack(velocities, |node, k, lacks| wanted[node][k] = lacks);
    }

    /// The most that a row that is solved lacks (m/s or rad/s).
    pub fn largest_lack(&self, velocities: &[Velocity]) -> Real {
        let mut largest: Real = 0.0;
        self.each_lack(velocities, |_, _, lacks| largest = largest.max(lacks.abs()));
        largest
    }

    fn each_lack(&self, velocities: &[Velocity], mut take: impl FnMut(usize, usize, Real)) {
        for tie in &self.list {
            let [a, b] = active::twists(velocities, tie);
            for (k, now) in tie.middle.as_slice().iter().enumerate() {
                let row = &self.rows[tie.first_row + k];
                if row.state == State::Solved {
                    take(tie.first_node + k / 3, k % 3, active::missing(row, now, [&a, &b]));
                }
            }
        }
    }

    /// Adds to the impulses, and gives the bodies what that does.
    pub fn add(&mut self, velocities: &mut [Velocity], solved: &[Triple]) {
        let Self { list, rows, .. } = self;
        for tie in &*list {
            for (k, now) in tie.middle.as_slice().iter().enumerate() {
                let change = solved[tie.first_node + k / 3][k % 3];
                rows[tie.first_row + k].impulse += change;
                push(velocities, tie.slots, now, change);
            }
        }
    }

    /// Pins rows beyond their bounds and lets those go that come back, of which only the first if so asked.
    pub fn review(&mut self, velocities: &mut [Velocity], one_by_one: bool) {
        active::review(self, velocities, one_by_one);
    }

    /// Keeps what the rows have come to.
    pub fn save(&self, rows: &mut Vec<Row>) {
        rows.clone_from(&self.rows);
    }

    /// Goes back to it.
    pub fn restore(&mut self, rows: &[Row]) {
        self.rows.copy_from_slice(rows);
    }
}
