//! The points and the rows of joints, all at once: where sweeps settle slowly because many points hold a stiff piece of matter.
//!
//! Each point parts, sticks or slides. As it is thought to do it has no row, two, or one along its normal with which it pushes along n ± μt; the
//! rows are solved by elimination with pivots, since friction that slides makes their matrix unsymmetric, and points that then do something
//! else are exchanged until none does (block principal pivoting: Júdice and Pires, 1994, here with friction).

use super::Group;
use super::matter::Scratch;
use super::matter_lever::Lever;
use super::matter_ties::MatterTie;
use crate::constraints::matter::Point;
use crate::joint::ROWS;
use crate::math::{Real, Twist, Vec2};

/// Added to each row, as a part of its diagonal, so that rows which depend on one another share what they bear.
const SHARED: Real = 1e-9;

/// Most rows that are solved at once.
const MOST: usize = 600;

/// Times that points are exchanged, for each row, and those of them that may exchange no fewer than before; then they are one by one.
const EXCHANGES: usize = 10;
const IDLE: u32 = 5;
/// Most multiplications in all of them.
const WORK: usize = 10_000_000;

/// A row that takes part.
#[derive(Clone, Copy, Debug)]
pub(super) enum Bearing {
    /// A point, along its normal; the next row is that along its tangent.
    Normal(usize),
    /// A point along its tangent.
    Tangent(usize),
    /// A row of a joint that holds matter: by joint and row.
    Tie(usize, usize),
    /// A row of a joint between rigid bodies.
    Rigid(usize, usize),
}

/// What a point does.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Mode {
    Parts,
    Sticks,
    /// It pushes along n + μt with this μ, below 0 against the tangent.
    Slides(Real),
}

/// Columns of the solve.
#[derive(Clone, Debug, Default)]
pub(super) struct Direct {
    rows: Vec<Bearing>,
    levers: Vec<Lever>,
    /// J A⁻¹ Jᵀ + Σ of all rows, and what they lack without any of their impulses (m/s).
    response: Vec<Real>,
    lacks: Vec<Real>,
    /// What points do, in their order, and those that do something else.
    modes: Vec<Mode>,
    wrong: Vec<(usize, Mode)>,
    /// Rows that have an unknown, and their system.
    active: Vec<usize>,
    dense: Vec<Real>,
    right: Vec<Real>,
    impulses: Vec<Real>,
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
    /// Brings the rows of joints, and the points, to their targets. False if that does not bring them nearer, as where the same node is held
    /// from both sides: then all is as it was.
    pub(super) fn solve_together(&mut self, group: &mut Group) -> bool {
        let mut direct = std::mem::take(&mut self.direct);
        let nearer = self.list_rows(group, &mut direct) && self.bring(group, &mut direct);
        self.direct = direct;
        nearer
    }

    /// Gives the rows the impulses that the exchange ends with, if that is nearer.
    fn bring(&mut self, group: &mut Group, direct: &mut Direct) -> bool {
        self.fill(group, direct);
        direct.exchange(&self.points);
        if direct.impulses.iter().any(|impulse| !impulse.is_finite()) {
            return false;
        }
        let before = self.lack(group);
        self.save(group);
        for (i, row) in direct.rows.iter().enumerate() {
            let change = direct.impulses[i] - self.impulse_of(group, *row);
            match *row {
                Bearing::Normal(k) => {
                    self.points[k].grip.impulse[0] += change;
                    self.points[k].grip.sliding = matches!(direct.modes[k], Mode::Slides(_));
                }
                Bearing::Tangent(k) => self.points[k].grip.impulse[1] += change,
                Bearing::Tie(t, k) => self.ties[t].add(k, change),
                Bearing::Rigid(t, k) => group.ties.add_to((t, k), change),
            }
            self.apply_lever(group, &direct.levers[i], change);
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

    /// Lists the rows that take part; false if there are none, or too many.
    fn list_rows(&self, group: &Group, direct: &mut Direct) -> bool {
        let Direct { rows, modes, .. } = direct;
        rows.clear();
        modes.clear();
        for (k, point) in self.points.iter().enumerate() {
            rows.extend([Bearing::Normal(k), Bearing::Tangent(k)]);
            let [normal, tangent] = point.grip.impulse;
            modes.push(match point.grip.sliding {
                _ if normal <= 0.0 => Mode::Parts,
                true => Mode::Slides(point.friction.sliding * tangent.signum()),
                false => Mode::Sticks,
            });
        }
        rows.extend(self.free_rows().map(|(t, k)| Bearing::Tie(t, k)));
        rows.extend(group.ties.solved().map(|(t, k)| Bearing::Rigid(t, k)));
        !rows.is_empty() && rows.len() <= MOST
    }

    /// The response of all rows, row after row, and what they lack.
    fn fill(&self, group: &Group, direct: &mut Direct) {
        let Direct { rows, levers, response, lacks, .. } = direct;
        let n = rows.len();
        levers.clear();
        lacks.clear();
        for row in &*rows {
            let (lever, lack) = self.lever_of(group, *row);
            levers.push(lever);
            lacks.push(lack);
        }
        response.clear();
        response.resize(n * n, 0.0);
        for i in 0..n {
            for j in 0..=i {
                let both = self.coupling(group, &levers[i], &levers[j]);
                (response[i * n + j], response[j * n + i]) = (both, both);
            }
            let own = &mut response[i * n + i];
            *own = *own * (1.0 + SHARED) + self.compliance(group, rows[i]);
        }
        for (i, lack) in lacks.iter_mut().enumerate() {
            let own = response[i * n..(i + 1) * n].iter().zip(&*rows);
            *lack += own.map(|(w, row)| w * self.impulse_of(group, *row)).sum::<Real>();
        }
    }

    /// What a row acts on, and what it lacks as things are (m/s).
    fn lever_of(&self, group: &Group, row: Bearing) -> (Lever, Real) {
        let along = |k: usize, axis: usize| {
            let along = self.points[k].directions()[axis];
            let now = along.dot(&self.velocity(group, k));
            (self.lever_of_point(k, along), self.rows[k].target[axis] - now)
        };
        match row {
            Bearing::Normal(k) => along(k, 0),
            Bearing::Tangent(k) => along(k, 1),
            Bearing::Tie(t, k) => {
                let lever = self.lever_of_row(t, k);
                (lever, self.lacks(group, (t, k), &lever).0)
            }
            Bearing::Rigid(t, k) => rigid_row(group, (t, k)),
        }
    }

    fn impulse_of(&self, group: &Group, row: Bearing) -> Real {
        match row {
            Bearing::Normal(k) => self.points[k].grip.impulse[0],
            Bearing::Tangent(k) => self.points[k].grip.impulse[1],
            Bearing::Tie(t, k) => self.ties[t].row_impulses()[k],
            Bearing::Rigid(t, k) => group.ties.row((t, k)).2.impulse,
        }
    }

    fn compliance(&self, group: &Group, row: Bearing) -> Real {
        match row {
            Bearing::Normal(_) | Bearing::Tangent(_) => 0.0,
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

impl Direct {
    /// Exchanges what points do until each does as it is thought to, or for as long as it is worth.
    fn exchange(&mut self, points: &[Point]) {
        let (mut fewest, mut idle) = (usize::MAX, 0);
        let n = self.rows.len();
        let most = (EXCHANGES * n).min(WORK / (n * n * n) + 2 * IDLE as usize);
        for _ in 0..most {
            self.solve();
            self.find_wrong(points);
            let Some(&last) = self.wrong.last() else { return };
            if self.wrong.len() < fewest {
                (fewest, idle) = (self.wrong.len(), 0);
            } else {
                idle += 1;
            }
            // All at once may go round in a circle; the last one alone does not, without friction.
            if idle > IDLE {
                self.modes[last.0] = last.1;
            } else {
                self.wrong.iter().for_each(|(k, mode)| self.modes[*k] = *mode);
            }
        }
    }

    /// The impulses of all rows, points as they are thought to do.
    fn solve(&mut self) {
        let Self { rows, response, lacks, modes, active, dense, right, impulses, .. } = self;
        let n = rows.len();
        active.clear();
        active.extend((0..n).filter(|i| match rows[*i] {
            Bearing::Normal(k) => modes[k] != Mode::Parts,
            Bearing::Tangent(k) => modes[k] == Mode::Sticks,
            _ => true,
        }));
        dense.clear();
        for i in &*active {
            let row = &response[i * n..(i + 1) * n];
            dense.extend(active.iter().map(|j| match rows[*j] {
                Bearing::Normal(k) => match modes[k] {
                    Mode::Slides(friction) => row[*j] + friction * row[j + 1],
                    _ => row[*j],
                },
                _ => row[*j],
            }));
        }
        right.clear();
        right.extend(active.iter().map(|i| lacks[*i]));
        impulses.clear();
        if !eliminate(dense, right) {
            impulses.resize(n, Real::NAN);
            return;
        }
        impulses.resize(n, 0.0);
        for (i, impulse) in active.iter().zip(&*right) {
            impulses[*i] = *impulse;
            if let Bearing::Normal(k) = rows[*i]
                && let Mode::Slides(friction) = modes[k]
            {
                impulses[i + 1] = friction * impulse;
            }
        }
    }

    /// Lists the points that do not do what they are thought to.
    fn find_wrong(&mut self, points: &[Point]) {
        let Self { rows, response, lacks, modes, wrong, impulses, .. } = self;
        let n = rows.len();
        let lack = |i: usize| {
            let given = response[i * n..(i + 1) * n].iter().zip(&*impulses);
            lacks[i] - given.map(|(w, p)| w * p).sum::<Real>()
        };
        wrong.clear();
        for (k, point) in points.iter().enumerate() {
            // Rows of points are the first.
            let [i, j] = [2 * k, 2 * k + 1];
            let (normal, tangent) = (impulses[i], impulses[j]);
            let held = point.friction.sticking * normal;
            let mode = match modes[k] {
                Mode::Parts if lack(i) > 0.0 => Mode::Sticks,
                Mode::Parts => Mode::Parts,
                _ if normal < 0.0 => Mode::Parts,
                Mode::Sticks if tangent.abs() > held => {
                    Mode::Slides(point.friction.sliding * tangent.signum())
                }
                // It opposes the sliding: what the tangent lacks has its sign.
                Mode::Slides(friction) if friction * lack(j) < 0.0 => Mode::Sticks,
                same => same,
            };
            if mode != modes[k] {
                wrong.push((k, mode));
            }
        }
    }
}

/// What a row of a joint between rigid bodies acts on, and what it lacks (m/s).
fn rigid_row(group: &Group, at: (usize, usize)) -> (Lever, Real) {
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
    (lever, lacks)
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
