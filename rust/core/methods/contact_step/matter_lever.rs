//! What an impulse along a row acts on: nodes through A⁻¹, rigid bodies through their masses.

use super::Group;
use super::matter::{Scratch, apply};
use crate::constraints::matter::Side;
use crate::math::{Real, Vec2, cross, vec2};

/// Most nodes, or rigid bodies, on which a row acts.
const NODES: usize = 4;
const BODIES: usize = 2;

/// J of a row: by places among the touched nodes, and by slots.
#[derive(Clone, Copy, Debug)]
pub(super) struct Lever {
    nodes: [(u32, Vec2); NODES],
    bodies: [(u32, [Real; 3]); BODIES],
    counts: [usize; 2],
}

impl Default for Lever {
    fn default() -> Self {
        let none = (0, [0.0; 3]);
        Self { nodes: [(0, vec2(0.0, 0.0)); NODES], bodies: [none; BODIES], counts: [0; 2] }
    }
}

impl Lever {
    pub fn add_node(&mut self, place: u32, along: Vec2) {
        self.nodes[self.counts[0]] = (place, along);
        self.counts[0] += 1;
    }

    pub fn add_body(&mut self, slot: u32, jacobian: [Real; 3]) {
        self.bodies[self.counts[1]] = (slot, jacobian);
        self.counts[1] += 1;
    }

    fn nodes(&self) -> &[(u32, Vec2)] {
        &self.nodes[..self.counts[0]]
    }

    fn bodies(&self) -> &[(u32, [Real; 3])] {
        &self.bodies[..self.counts[1]]
    }
}

impl Scratch {
    /// Point k along a direction.
    pub(super) fn lever_of_point(&self, k: usize, along: Vec2) -> Lever {
        let (point, row) = (&self.points[k], &self.rows[k]);
        let mut lever = Lever::default();
        for (side, sign) in point.sides.iter().zip([-1.0, 1.0]) {
            if let Side::Body(slot, arm) = *side {
                lever.add_body(slot, [sign * along.x, sign * along.y, sign * cross(arm, along)]);
            }
        }
        for (place, weight) in row.places.iter().zip(row.weights).filter(|(_, w)| *w != 0.0) {
            lever.add_node(*place, along * weight);
        }
        lever
    }

    /// J A⁻¹ J'ᵀ of two rows.
    pub(super) fn coupling(&self, group: &Group, a: &Lever, b: &Lever) -> Real {
        let mut sum = 0.0;
        for (slot, own) in a.bodies() {
            for (_, other) in b.bodies().iter().filter(|(same, _)| same == slot) {
                let inverse = group.velocities[*slot as usize].inverse();
                sum += (0..3).map(|i| own[i] * inverse[i] * other[i]).sum::<Real>();
            }
        }
        for (place, own) in a.nodes() {
            for (at, other) in b.nodes() {
                if let Some(block) = self.block(*place, *at) {
                    sum += own.dot(&apply(&block, *other));
                }
            }
        }
        sum
    }

    /// Jv of a row.
    pub(super) fn velocity_along(&self, group: &Group, lever: &Lever) -> Real {
        let nodes =
            lever.nodes().iter().map(|(place, along)| along.dot(&self.velocities[*place as usize]));
        let bodies = lever.bodies().iter().map(|(slot, [x, y, turn])| {
            let twist = &group.velocities[*slot as usize].twist;
            x * twist.linear.x + y * twist.linear.y + turn * twist.angular
        });
        nodes.sum::<Real>() + bodies.sum::<Real>()
    }

    /// Gives an impulse along a row.
    pub(super) fn apply_lever(&mut self, group: &mut Group, lever: &Lever, impulse: Real) {
        if impulse == 0.0 {
            return;
        }
        for (slot, [x, y, turn]) in lever.bodies() {
            group.velocities[*slot as usize].push(vec2(*x, *y), *turn, impulse);
        }
        for (place, along) in lever.nodes() {
            self.push_node(*place, along * impulse);
        }
    }

    /// Lets the nodes of a piece feel an impulse on one of them.
    pub(super) fn push_node(&mut self, place: u32, p: Vec2) {
        let piece = self.piece_of(place);
        let range = self.first[piece]..self.first[piece + 1];
        // Of a symmetric matrix the row of a node is its column.
        let at = (place as usize - range.start) * range.len();
        let blocks = &self.responses[piece][at..at + range.len()];
        for (v, block) in self.velocities[range].iter_mut().zip(blocks) {
            v.x += block[0] * p.x + block[2] * p.y;
            v.y += block[1] * p.x + block[3] * p.y;
        }
    }

    /// The number of the piece that a touched node is of.
    pub(super) fn piece_of(&self, place: u32) -> usize {
        self.first.partition_point(|first| *first <= place as usize) - 1
    }
}
