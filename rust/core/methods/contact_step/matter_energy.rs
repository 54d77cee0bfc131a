//! What the rows of a group with matter give and take, and how they are kept from giving.

use super::group::RowWork;
use super::matter::{Matters, Scratch, all, apply};
use super::{Group, Outcome, joints, settle};
use crate::constraints::matter::{Point, Side};
use crate::math::{Real, Vec2};

/// Part of the energy of the change of velocities that rows may give before all are weakened alike, and how often they are.
const LITTLE: Real = 1e-3;
const WEAKENED: usize = 4;

impl Scratch {
    /// Weakens all rows alike as long as they give more than a little energy, which rows that are solved never do. Matter that is crushed is far
    /// from the linear answer that sweeps take it for; in the end they do nothing.
    pub(super) fn weaken(
        &mut self,
        group: &mut Group,
        h: Real,
        matters: &mut dyn Matters,
        outcome: &mut Outcome,
    ) {
        for time in 1..=WEAKENED {
            let mut work = self.gain(group, h, matters);
            if !group.ties.is_empty() || !self.ties.is_empty() || work.gain <= LITTLE * work.changed
            {
                return;
            }
            if time == WEAKENED {
                work.gain = work.changed;
            }
            self.follow_lead(group, matters, -1.0);
            let part = settle::weaken(group, &work, outcome);
            for point in &mut self.points {
                point.grip.impulse.iter_mut().for_each(|impulse| *impulse *= part);
            }
            self.given(matters);
            all(matters, |piece| piece.settle());
            self.follow_lead(group, matters, 1.0);
        }
    }

    /// What all rows give beyond what parting overlaps may, with the energy that matter would have too much, and ½ΔvᵀMΔv of the change of
    /// velocities that they make (J).
    fn gain(&mut self, group: &Group, h: Real, matters: &mut dyn Matters) -> RowWork {
        let mut work = group.row_work(h);
        let mut parted = 0.0;
        for (point, row) in self.points.iter().zip(&self.rows) {
            work.gain += given_to_nodes(point, matters);
            if point.gap <= 0.0 {
                parted += point.grip.impulse[0] * row.target[0];
            }
        }
        work.gain += (0..matters.count()).map(|k| matters.piece(k).excess()).sum::<Real>();
        work.changed += self.changed();
        work.gain -= parted;
        work
    }

    /// ½ pᵀA⁻¹p over the nodes that are touched (J).
    fn changed(&mut self) -> Real {
        let Self { points, rows, first, responses, pushed, nodes, .. } = self;
        pushed.clear();
        pushed.resize(nodes.len(), Vec2::zeros());
        for (point, row) in points.iter().zip(&*rows) {
            for (place, weight) in row.places.iter().zip(row.weights).filter(|(_, w)| *w != 0.0) {
                pushed[*place as usize] += point.impulse() * weight;
            }
        }
        let mut sum = 0.0;
        for (piece, responses) in first.windows(2).zip(&*responses) {
            let own = &pushed[piece[0]..piece[1]];
            for (row, a) in responses.chunks_exact(own.len().max(1)).zip(own) {
                let answer = row.iter().zip(own).map(|(block, b)| apply(block, *b)).sum::<Vec2>();
                sum += 0.5 * a.dot(&answer);
            }
        }
        sum
    }
}

/// What the impulse of a point gives the nodes at its sides (J): p·½(v⁻ + v⁺).
fn given_to_nodes(point: &Point, matters: &mut dyn Matters) -> Real {
    let (impulse, mut given) = (point.impulse(), 0.0);
    for (side, sign) in point.sides.iter().zip([-1.0, 1.0]) {
        if let Side::Nodes(k, nodes, weights) = *side {
            for (node, weight) in nodes.iter().zip(weights) {
                let [before, after] = matters.piece(k as usize).velocities(*node);
                given += 0.5 * sign * weight * impulse.dot(&(before + after));
            }
        }
    }
    given
}

/// Books what the rows did: an impulse p does the work p·½(v⁻ + v⁺) on each side.
pub(super) fn book(
    group: &mut Group,
    h: Real,
    (matters, scratch): (&mut dyn Matters, &mut Scratch),
    outcome: &mut Outcome,
) {
    let work = group.row_work(h);
    let mut gained = work.gain;
    if !group.ties.is_empty() {
        gained -= joints::book(group, h, &mut outcome.ledger);
    }
    gained -= scratch.book_ties(group, h, matters, &mut outcome.ledger);
    outcome.ledger.work += work.given;
    for point in &scratch.points {
        gained += given_to_nodes(point, matters);
        for (side, sign) in point.sides.iter().zip([-1.0, 1.0]) {
            // What a body with a given motion does is work.
            if let Side::Body(slot, arm) = *side
                && let velocity = &group.velocities[slot as usize]
                && velocity.is_fixed()
            {
                let work = -sign * point.impulse().dot(&velocity.at(arm));
                outcome.ledger.work += work;
                gained -= work;
            }
        }
        let belt = point.grip.impulse[1] * point.tangent_speed;
        outcome.ledger.work += belt;
        gained -= belt;
    }
    outcome.ledger.dissipated -= gained;
}
