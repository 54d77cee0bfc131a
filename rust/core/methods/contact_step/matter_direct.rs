//! The points that bear, all at once: where sweeps settle slowly because many points hold a stiff piece of matter.
//!
//! Each point that sticks has two rows; each that slides has one, along its normal, and pushes along n ± μt. They are solved by elimination
//! with pivots, since friction that slides makes their matrix unsymmetric.

use super::Group;
use super::matter::Scratch;
use crate::constraints::matter::Side;
use crate::math::{Real, Vec2, cross};

/// Added to each row, as a part of its diagonal, so that rows which depend on one another share what they bear.
const SHARED: Real = 1e-9;

/// Most rows that are solved at once.
const MOST: usize = 600;

impl Scratch {
    /// Brings the points that bear to their targets, as if they bore on as they do. False if that does not bring them nearer, as where the same
    /// node is held from both sides: then all is as it was.
    pub(super) fn solve_together(&mut self, group: &mut Group) -> bool {
        self.find_bearing();
        let n = self.bearing.len();
        if n == 0 || n > MOST {
            return false;
        }
        self.fill(group);
        if !eliminate(&mut self.dense, &mut self.right) {
            return false;
        }
        let before = self.lack(group);
        self.save(group);
        for i in 0..n {
            let (point, direction) = self.bearing[i];
            let k = point as usize;
            let change = direction * self.right[i];
            let [n, t] = self.points[k].directions();
            let grip = &mut self.points[k].grip;
            grip.impulse[0] += n.dot(&change);
            grip.impulse[1] += t.dot(&change);
            self.give(group, k, change);
        }
        self.admit(group);
        let nearer = self.lack(group) < before;
        if !nearer {
            self.go_back(group);
        }
        nearer
    }

    /// Largest velocity (m/s) by which a normal row misses its target, while it bears or would have to.
    fn lack(&self, group: &Group) -> Real {
        let mut lack: Real = 0.0;
        for (k, point) in self.points.iter().enumerate() {
            let [n, t] = point.directions();
            let now = self.velocity(group, k);
            let [target, beside] = self.rows[k].target;
            let error = n.dot(&now) - target;
            let bears = point.grip.impulse[0] > 0.0;
            lack = lack.max(if bears { error.abs() } else { -error });
            if bears && !self.slides(k) {
                lack = lack.max((t.dot(&now) - beside).abs());
            }
        }
        lack
    }

    fn save(&mut self, group: &Group) {
        let (impulses, nodes, twists) = &mut self.saved;
        impulses.clear();
        impulses.extend(self.points.iter().map(|point| point.grip.impulse));
        nodes.clone_from(&self.velocities);
        twists.clear();
        twists.extend(group.velocities.iter().map(|velocity| velocity.twist));
    }

    fn go_back(&mut self, group: &mut Group) {
        let (impulses, nodes, twists) = &self.saved;
        self.points.iter_mut().zip(impulses).for_each(|(point, old)| point.grip.impulse = *old);
        self.velocities.clone_from(nodes);
        group.velocities.iter_mut().zip(twists).for_each(|(velocity, old)| velocity.twist = *old);
    }

    /// Directions along which points bear.
    fn find_bearing(&mut self) {
        let Self { points, bearing, .. } = self;
        bearing.clear();
        for (k, point) in points.iter().enumerate() {
            let [n, t] = point.directions();
            let [normal, tangent] = point.grip.impulse;
            if normal <= 0.0 {
                continue;
            }
            if point.grip.sliding {
                let way = n + t * (point.friction.sliding * tangent.signum());
                bearing.push((k as u32, way));
            } else {
                bearing.push((k as u32, n));
                bearing.push((k as u32, t));
            }
        }
    }

    /// The response, row after row, and the right-hand side.
    fn fill(&mut self, group: &Group) {
        let n = self.bearing.len();
        let mut dense = std::mem::take(&mut self.dense);
        dense.clear();
        dense.resize(n * n, 0.0);
        self.right.clear();
        for i in 0..n {
            let (k, direction) = self.bearing[i];
            let k = k as usize;
            let [normal, tangent] = self.points[k].directions();
            // What slides asks along its normal only.
            let along = if self.slides(k) { normal } else { direction };
            for j in 0..n {
                let (l, other) = self.bearing[j];
                dense[i * n + j] = self.between(group, (k, along), (l as usize, other));
            }
            dense[i * n + i] *= 1.0 + SHARED;
            let target = self.rows[k].target;
            let wanted = normal * target[0] + tangent * target[1];
            self.right.push(along.dot(&(wanted - self.velocity(group, k))));
        }
        self.dense = dense;
    }

    fn slides(&self, k: usize) -> bool {
        self.points[k].grip.sliding
    }

    /// Response of point k along a direction to an impulse at point l along another.
    fn between(&self, group: &Group, (k, d): (usize, Vec2), (l, e): (usize, Vec2)) -> Real {
        let mut sum = 0.0;
        for (a, sign) in self.points[k].sides.iter().zip([-1.0, 1.0]) {
            for (b, other) in self.points[l].sides.iter().zip([-1.0, 1.0]) {
                if let (Side::Body(slot, arm), Side::Body(same, lever)) = (*a, *b)
                    && slot == same
                {
                    let velocity = &group.velocities[slot as usize];
                    let rows = [(d, cross(arm, d)), (e, cross(lever, e))];
                    sum += sign * other * velocity.coupling(rows[0], rows[1]);
                }
            }
        }
        let (row, column) = (&self.rows[k], &self.rows[l]);
        for a in (0..4).filter(|a| row.weights[*a] != 0.0) {
            for b in (0..4).filter(|b| column.weights[*b] != 0.0) {
                if let Some(x) = self.block(row.places[a], column.places[b]) {
                    let moved = Vec2::new(x[0] * e.x + x[1] * e.y, x[2] * e.x + x[3] * e.y);
                    sum += row.weights[a] * column.weights[b] * d.dot(&moved);
                }
            }
        }
        sum
    }

    /// Brings impulses back into the cones of their points.
    fn admit(&mut self, group: &mut Group) {
        for k in 0..self.points.len() {
            let point = &self.points[k];
            let [normal, tangent] = point.grip.impulse;
            let held = normal.max(0.0);
            let bound = held * point.friction.sticking;
            let allowed = [held, tangent.clamp(-bound, bound)];
            let [n, t] = point.directions();
            let change = n * (allowed[0] - normal) + t * (allowed[1] - tangent);
            if change != Vec2::zeros() {
                self.points[k].grip.impulse = allowed;
                self.give(group, k, change);
            }
        }
    }
}

/// Solves a dense system in place, with pivots by rows; false if it is singular.
fn eliminate(a: &mut [Real], x: &mut [Real]) -> bool {
    let n = x.len();
    for i in 0..n {
        let size = |row: usize| a[row * n + i].abs();
        let pivot = (i..n).fold(i, |best, row| if size(row) > size(best) { row } else { best });
        if pivot != i {
            (0..n).for_each(|column| a.swap(i * n + column, pivot * n + column));
            x.swap(i, pivot);
        }
        let (above, below) = a.split_at_mut((i + 1) * n);
        let row = &above[i * n..];
        if row[i] == 0.0 || !row[i].is_finite() {
            return false;
        }
        for (k, other) in below.chunks_exact_mut(n).enumerate() {
            let by = other[i] / row[i];
            if by != 0.0 {
                other[i..].iter_mut().zip(&row[i..]).for_each(|(b, a)| *b -= by * a);
                x[i + 1 + k] -= by * x[i];
            }
        }
    }
    for i in (0..n).rev() {
        let sum: Real = (i + 1..n).map(|k| a[i * n + k] * x[k]).sum();
        x[i] = (x[i] - sum) / a[i * n + i];
    }
    x.iter().all(|x| x.is_finite())
}
