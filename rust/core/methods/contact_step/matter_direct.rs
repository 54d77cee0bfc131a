//! The points that bear and the rows of joints, all at once: where sweeps settle slowly because many points hold a stiff piece of matter.
//!
//! Each point that sticks has two rows; each that slides has one, along its normal, and pushes along n ± μt. They are solved by elimination
//! with pivots, since friction that slides makes their matrix unsymmetric.

use super::Group;
use super::matter::Scratch;
use super::matter_lever::Lever;
use super::matter_ties::MatterTie;
use crate::joint::ROWS;
use crate::math::{Real, Twist, Vec2};

/// Added to each row, as a part of its diagonal, so that rows which depend on one another share what they bear.
const SHARED: Real = 1e-9;

/// Most rows that are solved at once.
const MOST: usize = 600;

/// A row that takes part.
#[derive(Clone, Copy, Debug)]
pub(super) enum Bearing {
    /// A point, and the direction along which it pushes.
    Point(u32, Vec2),
    /// A row of a joint that holds matter: by joint and row.
    Tie(usize, usize),
    /// A row of a joint between rigid bodies.
    Rigid(usize, usize),
}

/// What a solve changes, to go back to.
#[derive(Clone, Debug, Default)]
pub(super) struct Saved {
    points: Vec<[Real; 2]>,
    ties: Vec<[Real; ROWS]>,
    rigid: Vec<Real>,
    nodes: Vec<Vec2>,
    twists: Vec<Twist>,
}

impl Scratch {
    /// Brings the rows of joints, and the points that bear, to their targets, as if they bore on as they do. False if that does not bring them nearer,
    /// as where the same node is held from both sides: then all is as it was.
    pub(super) fn solve_together(&mut self, group: &mut Group) -> bool {
        self.find_bearing(group);
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
            let (impulse, lever) = (self.right[i], self.levers[i][1]);
            match self.bearing[i] {
                Bearing::Point(k, direction) => {
                    let point = &mut self.points[k as usize];
                    let [n, t] = point.directions();
                    point.grip.impulse[0] += n.dot(&direction) * impulse;
                    point.grip.impulse[1] += t.dot(&direction) * impulse;
                }
                Bearing::Tie(t, k) => self.ties[t].add(k, impulse),
                Bearing::Rigid(t, k) => group.ties.add_to((t, k), impulse),
            }
            self.apply_lever(group, &lever, impulse);
        }
        self.admit(group);
        let nearer = self.lack(group) < before;
        if !nearer {
            self.go_back(group);
        }
        nearer
    }

    /// Largest velocity (m/s) by which a row misses its target, while it bears or would have to.
    fn lack(&self, group: &Group) -> Real {
        let mut lack = self.lack_of_ties(group).max(lack_of_rigid(group));
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
        let Saved { points, ties, rigid, nodes, twists } = &mut self.saved;
        points.clear();
        points.extend(self.points.iter().map(|point| point.grip.impulse));
        ties.clear();
        ties.extend(self.ties.iter().map(MatterTie::row_impulses));
        rigid.clear();
        rigid.extend(group.ties.impulses());
        nodes.clone_from(&self.velocities);
        twists.clear();
        twists.extend(group.velocities.iter().map(|velocity| velocity.twist));
    }

    fn go_back(&mut self, group: &mut Group) {
        let Saved { points, ties, rigid, nodes, twists } = &self.saved;
        self.points.iter_mut().zip(points).for_each(|(point, old)| point.grip.impulse = *old);
        self.ties.iter_mut().zip(ties).for_each(|(tie, old)| tie.set_row_impulses(old));
        group.ties.set_impulses(rigid);
        self.velocities.clone_from(nodes);
        group.velocities.iter_mut().zip(twists).for_each(|(velocity, old)| velocity.twist = *old);
    }

    /// Rows that take part: those of joints, and the directions along which points bear.
    fn find_bearing(&mut self, group: &Group) {
        let mut bearing = std::mem::take(&mut self.bearing);
        bearing.clear();
        for (k, point) in self.points.iter().enumerate() {
            let [n, t] = point.directions();
            let [normal, tangent] = point.grip.impulse;
            if normal <= 0.0 {
                continue;
            }
            let k = k as u32;
            if point.grip.sliding {
                let way = n + t * (point.friction.sliding * tangent.signum());
                bearing.push(Bearing::Point(k, way));
            } else {
                bearing.extend([n, t].map(|along| Bearing::Point(k, along)));
            }
        }
        bearing.extend(self.free_rows().map(|(t, k)| Bearing::Tie(t, k)));
        bearing.extend(group.ties.solved().map(|(t, k)| Bearing::Rigid(t, k)));
        self.bearing = bearing;
    }

    /// The response, row after row, and the right-hand side.
    fn fill(&mut self, group: &Group) {
        let n = self.bearing.len();
        let (mut dense, mut levers) =
            (std::mem::take(&mut self.dense), std::mem::take(&mut self.levers));
        dense.clear();
        levers.clear();
        self.right.clear();
        for i in 0..n {
            let (sides, lacks) = match self.bearing[i] {
                Bearing::Point(k, direction) => self.bearing_point(group, k as usize, direction),
                Bearing::Tie(t, k) => {
                    let lever = self.lever_of_row(t, k);
                    ([lever; 2], self.lacks(group, (t, k), &lever).0)
                }
                Bearing::Rigid(t, k) => rigid_row(group, (t, k)),
            };
            levers.push(sides);
            self.right.push(lacks);
        }
        for (i, [along, _]) in levers.iter().enumerate() {
            dense.extend(levers.iter().map(|[_, pushed]| self.coupling(group, along, pushed)));
            let own = &mut dense[i * n + i];
            *own = *own * (1.0 + SHARED) + self.compliance(group, i);
        }
        (self.dense, self.levers) = (dense, levers);
    }

    /// What a bearing point asks along, what it pushes along, and what it lacks (m/s). What slides asks along its normal only.
    fn bearing_point(&self, group: &Group, k: usize, direction: Vec2) -> ([Lever; 2], Real) {
        let [normal, tangent] = self.points[k].directions();
        let along = if self.slides(k) { normal } else { direction };
        let target = self.rows[k].target;
        let wanted = normal * target[0] + tangent * target[1];
        let levers = [along, direction].map(|along| self.lever_of_point(k, along));
        (levers, along.dot(&(wanted - self.velocity(group, k))))
    }

    fn compliance(&self, group: &Group, i: usize) -> Real {
        match self.bearing[i] {
            Bearing::Point(..) => 0.0,
            Bearing::Tie(t, k) => self.ties[t].compliance(k),
            Bearing::Rigid(t, k) => group.ties.row((t, k)).2.compliance,
        }
    }

    fn slides(&self, k: usize) -> bool {
        self.points[k].grip.sliding
    }

    /// Brings impulses back into the cones of their points, and within the bounds of their rows.
    fn admit(&mut self, group: &mut Group) {
        self.admit_ties(group);
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

/// What a row of a joint between rigid bodies acts on, and what it lacks (m/s).
fn rigid_row(group: &Group, at: (usize, usize)) -> ([Lever; 2], Real) {
    let (tie, now, row) = group.ties.row(at);
    let mut lever = Lever::default();
    let mut lacks = row.wanted - row.compliance * row.impulse;
    for (slot, jacobian) in tie.slots.iter().zip(now.jacobian) {
        let Some(slot) = *slot else { continue };
        lever.add_body(slot, jacobian);
        let twist = &group.velocities[slot as usize].twist;
        let [x, y, turn] = jacobian;
        lacks -= x * twist.linear.x + y * twist.linear.y + turn * twist.angular;
    }
    ([lever; 2], lacks)
}

fn lack_of_rigid(group: &Group) -> Real {
    group.ties.solved().map(|at| rigid_row(group, at).1.abs()).fold(0.0, Real::max)
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
