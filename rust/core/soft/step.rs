//! A substep of a deformable body: the midpoint rule, solved by Newton's method with factors that are kept as long as they serve.
//!
//! Over a substep of length h from x⁻, v⁻ the contact step drifts by half, gives Δv, and drifts on: x⁺ = x⁻ + h(v⁻ + ½Δv). Here
//! MΔv = h f(x⁻, x⁺) + p, with the forces of [`super::triangle`] and the impulses p of contacts. That is implicit in Δv, with
//! A = M + (h²/4)K + (h/2)C in the middle; impulses act through A⁻¹.

use super::Spot;
use super::body::{Linear, Parts, SoftBody, Work};
use super::triangle::{Middle, Rule, Step};
use crate::constraints::matter::{Effort, Matter};
use crate::forces::Ledger;
use crate::math::{Real, Rot, Vec2, cross, hypot, perp};

/// Error of Δv at which an iteration ends, as a part of the velocities that the substep deals with.
const TOLERANCE: Real = 1e-11;
/// The same where the error no longer becomes smaller.
const ROUGH: Real = 1e-9;
/// Iterations of the midpoint rule before the body is relaxed instead.
const MOST: u32 = 30;
/// How often an error may grow.
const MOST_GROWTHS: u32 = 4;
/// New factors where an iteration leaves more than this part of the error.
const SLOW: Real = 0.1;

/// How an iteration ended.
enum Ended {
    Settled,
    Failed,
}

impl SoftBody {
    /// Sets the acceleration (m/s²) that acts on all of it in the substeps to come.
    pub(crate) fn accelerate(&mut self, acceleration: Vec2) {
        self.work.acceleration = acceleration;
    }

    fn start(&mut self, h: Real) {
        let Self { moving, work, parts, .. } = self;
        (work.h, work.relaxes, work.based, work.size) = (h, false, false, Real::INFINITY);
        work.start.clone_from(&moving.positions);
        work.before.clone_from(&moving.velocities);
        let n = moving.positions.len();
        for column in [&mut work.change, &mut work.impulses, &mut work.residual] {
            column.clear();
            column.resize(n, Vec2::zeros());
        }
        work.end.resize(n, Vec2::zeros());
        work.deformations.clear();
        let start = &work.start;
        work.deformations.extend(parts.triangles.iter().flat_map(|t| t.deformation(start)));
        self.guess();
        let Self { moving, .. } = self;
        for (x, v) in moving.positions.iter_mut().zip(&moving.velocities) {
            *x += v * (0.5 * h);
        }
    }

    /// Δv of a body that only turns: the midpoint rule turns by 2 atan(ωh/2).
    fn guess(&mut self) {
        let free = !self.is_pinned();
        let rigid = self.rigid_motion(&self.work.start, &self.work.before);
        let work = &mut self.work;
        let tangent = if free { 0.5 * rigid.spin * work.h } else { 0.0 };
        let by = 2.0 * tangent / (1.0 + tangent * tangent);
        for ((change, v), pinned) in work.change.iter_mut().zip(&work.before).zip(&self.pinned) {
            // (R − 1)v with R the Cayley transform.
            let v = v - rigid.velocity;
            let kick = if *pinned { Vec2::zeros() } else { work.acceleration * work.h };
            *change = (perp(v) - v * tangent) * by + kick;
        }
    }

    /// Goes a step of Newton's method, once the impulses that have come since the last are answered.
    fn approach_step(&mut self) -> Effort {
        let mut effort = Effort::default();
        if self.work.relaxes {
            self.relax(&mut effort);
            return effort;
        }
        effort.iterations += 1;
        let first = self.work.size.is_infinite();
        if first {
            self.make_usable(&mut effort);
        } else {
            self.answer_impulses();
        }
        self.residual();
        let mut size = self.newton_step();
        // Far from where the factors are of, a step brings it nearer only as they do.
        if !first && effort.factorisations == 0 && size > SLOW * SLOW * self.work.size {
            self.linearise(&mut effort);
            size = self.newton_step();
        }
        if !size.is_finite() {
            self.work.relaxes = true;
            self.drop_factors();
            self.relax(&mut effort);
            return effort;
        }
        self.work.size = size;
        self.work.answered.clone_from(&self.work.impulses);
        let Self { work, moving, .. } = self;
        for (i, v) in moving.velocities.iter_mut().enumerate() {
            work.change[i] += work.step[i];
            *v = work.before[i] + work.change[i];
        }
        effort
    }

    /// Adds A⁻¹ of the impulses that have come since the last step.
    fn answer_impulses(&mut self) {
        let mut step = std::mem::take(&mut self.work.step);
        step.clear();
        let pairs = self.work.impulses.iter().zip(&self.work.answered).zip(&self.pinned);
        step.extend(pairs.map(|((now, then), pin)| if *pin { Vec2::zeros() } else { now - then }));
        if step.iter().any(|p| *p != Vec2::zeros()) {
            self.solve(&mut step);
            self.work.change.iter_mut().zip(&step).for_each(|(change, step)| *change += step);
        }
        self.work.step = step;
    }

    /// Makes factors of the midpoint rule where there are none of this step; whether they are new.
    fn make_usable(&mut self, effort: &mut Effort) -> bool {
        let usable = |linear: &Linear| linear.h == self.work.h && !linear.end;
        let fresh = !self.moving.linear.as_ref().is_some_and(usable);
        if fresh {
            self.linearise(effort);
        }
        self.refresh(effort);
        fresh
    }

    /// Solves for Δv with the impulses as they are.
    fn solve_step(&mut self) -> Effort {
        let mut effort = Effort::default();
        if !self.work.relaxes {
            if self.work.size.is_finite() {
                self.answer_impulses();
            }
            if matches!(self.iterate(&mut effort), Ended::Settled) {
                let Self { moving, work, .. } = self;
                let columns = work.before.iter().zip(&work.change);
                for (v, (before, change)) in moving.velocities.iter_mut().zip(columns) {
                    *v = before + change;
                }
                work.answered.clone_from(&work.impulses);
                return effort;
            }
            self.work.relaxes = true;
            self.drop_factors();
        }
        self.relax(&mut effort);
        effort
    }

    /// Ends the substep: the other half of the drift, and what it did.
    fn end(&mut self) -> Ledger {
        let mut ledger = Ledger::default();
        if self.work.relaxes {
            ledger.dissipated += self.end_relaxed();
            self.drop_factors();
        } else {
            self.work.end = self.ends();
            if self.parts.moduli.viscosity > 0.0 {
                ledger.dissipated += self.viscous_loss();
            }
        }
        let Self { moving, work, forces, .. } = self;
        moving.positions.clone_from(&work.end);
        for (force, (end, start)) in forces.iter().zip(work.end.iter().zip(&work.start)) {
            ledger.work += force.dot(&(end - start));
        }
        ledger.dissipated += self.untangle();
        self.yield_where_strained(&mut ledger);
        ledger
    }

    pub(super) fn drop_factors(&mut self) {
        self.work.factored = false;
        self.moving.linear = None;
    }

    /// x⁺ = x⁻ + h(v⁻ + ½Δv).
    fn ends(&mut self) -> Vec<Vec2> {
        let mut end = std::mem::take(&mut self.work.end);
        let work = &self.work;
        for (i, x) in end.iter_mut().enumerate() {
            *x = work.start[i] + (work.before[i] + work.change[i] * 0.5) * work.h;
        }
        end
    }

    /// p + h f − MΔv.
    fn residual(&mut self) {
        let end = self.ends();
        let mut residual = std::mem::take(&mut self.work.residual);
        let Parts { moduli, stiffness, triangles, rods, bends, filling, shares, .. } = &self.parts;
        let work = &self.work;
        let step = Step { h: work.h, rule: Rule::Middle };
        residual.fill(Vec2::zeros());
        for (t, before) in triangles.iter().zip(work.deformations.chunks_exact(3)) {
            t.add_forces(moduli, step, (before, &end), &mut residual);
        }
        let ends = [&work.start[..], &end[..]];
        rods.iter().for_each(|rod| rod.add_forces(stiffness, step, ends, &mut residual));
        bends.iter().for_each(|bend| bend.add_forces(stiffness, step, ends, &mut residual));
        if let (Some(gas), Some(filling)) = (&self.def.gas, filling) {
            filling.add_forces(gas, step, ends, &mut residual);
        }
        for (force, own) in residual.iter_mut().zip(&self.forces) {
            *force += own;
        }
        for (i, r) in residual.iter_mut().enumerate() {
            *r = (*r + work.acceleration * shares[i]) * work.h + work.impulses[i];
        }
        let mut heavy = std::mem::take(&mut self.work.column);
        heavy.clear();
        heavy.resize(residual.len(), Vec2::zeros());
        self.add_mass_times(&self.work.change, &mut heavy);
        for ((r, m), pinned) in residual.iter_mut().zip(&heavy).zip(&self.pinned) {
            *r = if *pinned { Vec2::zeros() } else { *r - m };
        }
        (self.work.end, self.work.residual, self.work.column) = (end, residual, heavy);
    }

    /// Newton's method for the midpoint rule, with old factors as long as they bring it forward.
    fn iterate(&mut self, effort: &mut Effort) -> Ended {
        let ([enough, rough], mut last, mut growths) = (self.enough(), Real::INFINITY, 0);
        let mut fresh = self.make_usable(effort);
        for _ in 0..MOST {
            effort.iterations += 1;
            self.residual();
            let size = self.newton_step();
            if !size.is_finite() || growths > MOST_GROWTHS {
                return Ended::Failed;
            }
            // What no longer becomes smaller is what rounding leaves.
            let settled = size <= enough || (size <= rough && size > SLOW * last);
            if !settled && !fresh && size > SLOW * SLOW * last {
                self.linearise(effort);
                (fresh, last) = (true, Real::INFINITY);
                continue;
            }
            growths += u32::from(size > last);
            (fresh, last) = (false, size);
            let Work { change, step, .. } = &mut self.work;
            change.iter_mut().zip(&*step).for_each(|(change, step)| *change += step);
            if settled {
                return Ended::Settled;
            }
        }
        Ended::Failed
    }

    /// A⁻¹ of the residual; returns the size of the error, squared (J).
    fn newton_step(&mut self) -> Real {
        let mut step = std::mem::take(&mut self.work.step);
        step.clone_from(&self.work.residual);
        self.solve(&mut step);
        let size = step.iter().zip(&self.work.residual).map(|(a, b)| a.dot(b)).sum();
        self.work.step = step;
        size
    }

    /// Size of the error, squared (J), at which an iteration ends: a part of the energies that the substep deals with, or what rounding of
    /// the places leaves; and that at which it ends where it does not become smaller.
    fn enough(&self) -> [Real; 2] {
        let Self { moving, work, parts, forces, .. } = self;
        let fastest = work.before.iter().map(Vec2::norm_squared).fold(0.0, Real::max);
        let kick = work.acceleration.norm_squared() * work.h * work.h;
        let pushed: Real = work.impulses.iter().map(Vec2::norm).sum();
        let pulled: Real = forces.iter().map(Vec2::norm).sum::<Real>() * work.h;
        let scale = parts.mass * (fastest + kick)
            + (pushed * pushed + pulled * pulled) / parts.mass
            + self.strain_energy_at(&work.start);
        let far = moving.positions.iter().map(Vec2::amax).fold(0.0, Real::max);
        let strain = Real::EPSILON * far / parts.side;
        let area: Real = parts.triangles.iter().map(|t| t.area).sum();
        let length: Real = parts.rods.iter().map(|rod| rod.length).sum();
        let stiff = parts.moduli.area * area + parts.stiffness.stretch * length;
        let rounding = 30.0 * stiff * strain * strain;
        [TOLERANCE * TOLERANCE * scale + rounding, ROUGH * ROUGH * scale + 100.0 * rounding]
    }
}

/// The linear system.
impl SoftBody {
    /// Factors A in the middle of the substep as far as it is known.
    fn linearise(&mut self, effort: &mut Effort) {
        let work = &self.work;
        let way = |i: usize| (work.before[i] + work.change[i] * 0.5) * (0.5 * work.h);
        let way: Vec<Vec2> = (0..work.start.len()).map(way).collect();
        let at = work.start.iter().zip(&way).map(|(x, way)| x + way).collect();
        let linear = Linear { h: work.h, at, way, definite: false, end: false };
        self.moving.linear = Some(linear);
        self.work.factored = false;
        self.refresh(effort);
    }

    /// Makes the factors those of what is kept, and finds by how much the body has turned since.
    pub(super) fn refresh(&mut self, effort: &mut Effort) {
        let Some(mut linear) = self.moving.linear.take() else { return };
        if !self.work.factored {
            effort.factorisations += 1;
            if !self.factor(&linear) {
                linear.definite = true;
                // Positive definite by construction, up to rounding, which leaves the iteration without an end: it then fails.
                self.factor(&linear);
            }
            self.work.factored = true;
        }
        self.work.turn = turn_between(&linear.at, &self.moving.positions);
        self.moving.linear = Some(linear);
    }

    fn factor(&mut self, linear: &Linear) -> bool {
        let Self { parts, work, def, pinned, .. } = self;
        let Parts { moduli, stiffness, triangles, rods, bends, filling, envelope, .. } = parts;
        let (alpha, beta) = match linear.end {
            false => (0.25 * linear.h * linear.h, 0.5 * linear.h),
            true => (linear.h * linear.h, 0.0),
        };
        let matrix = &mut work.matrix;
        matrix.clear(envelope);
        work.columns.clear();
        let mut add = |pair: (u32, u32), block| matrix.add(envelope, pair, block);
        let (density, at) = (def.material.density, &linear.at[..]);
        let by = (alpha, beta, linear.definite);
        let middle = Middle { at, way: &linear.way, h: linear.h };
        triangles.iter().for_each(|t| t.tangent((density, moduli), by, middle, &mut add));
        rods.iter().for_each(|rod| rod.tangent((density, stiffness), by, middle, &mut add));
        bends.iter().for_each(|bend| bend.tangent(stiffness, (alpha, beta), at, &mut add));
        let gas = def.gas.as_ref().zip(filling.as_ref());
        if let Some((gas, filling)) = gas.filter(|_| !linear.definite) {
            filling.tangent(gas, alpha, at, &mut add);
        }
        for (node, _) in pinned.iter().enumerate().filter(|(_, pin)| **pin) {
            matrix.pin(envelope, node as u32);
        }
        if !matrix.factor(envelope) {
            return false;
        }
        work.gas_by = 0.0;
        if let Some((gas, filling)) = gas {
            let stiff = alpha * filling.slopes(gas, at, &mut work.gas_slopes);
            work.gas_slopes
                .iter_mut()
                .zip(&*pinned)
                .filter(|(_, pin)| **pin)
                .for_each(|(s, _)| *s = Vec2::zeros());
            work.gas.clone_from(&work.gas_slopes);
            matrix.solve(envelope, &mut work.gas);
            let along: Real = work.gas.iter().zip(&work.gas_slopes).map(|(a, b)| a.dot(b)).sum();
            work.gas_by = stiff / (1.0 + stiff * along);
        }
        true
    }

    /// A⁻¹ of a column, in place, by the factors at hand, turned with the body.
    pub(super) fn solve(&mut self, column: &mut [Vec2]) {
        let rot = self.work.turn;
        column.iter_mut().for_each(|v| *v = rot.apply_inverse(*v));
        self.solve_as_linearised(column);
        column.iter_mut().for_each(|v| *v = rot.apply(*v));
    }

    /// The same, as the body stood when it was linearised.
    fn solve_as_linearised(&mut self, column: &mut [Vec2]) {
        let Self { parts, work, .. } = self;
        work.matrix.solve(&parts.envelope, column);
        if work.gas_by != 0.0 {
            // Sherman and Morrison: A + c g gᵀ.
            let along: Real = column.iter().zip(&work.gas_slopes).map(|(a, b)| a.dot(b)).sum();
            let by = work.gas_by * along;
            column.iter_mut().zip(&work.gas).for_each(|(v, u)| *v -= u * by);
        }
    }
}

/// Nodes and, numbered on from those, the points that are held.
impl SoftBody {
    /// Sets the points that are held; returns the number of the first.
    pub(crate) fn hold(&mut self, spots: &[Spot]) -> u32 {
        if self.work.spots != spots {
            self.work.spots.clear();
            self.work.spots.extend_from_slice(spots);
            self.work.columns.clear();
        }
        self.pinned.len() as u32
    }

    fn spot(&self, node: u32) -> Option<&Spot> {
        let k = (node as usize).checked_sub(self.pinned.len())?;
        Some(&self.work.spots[k])
    }

    /// What a column says of a node or a point.
    fn of(&self, node: u32, column: &[Vec2]) -> Vec2 {
        self.spot(node).map_or_else(|| column[node as usize], |spot| spot.of(column))
    }

    /// A⁻¹ of a unit impulse along an axis on a node or a point, as the body stood when it was linearised.
    fn column(&mut self, node: u32, axis: Vec2) -> Vec<Vec2> {
        let mut column = vec![Vec2::zeros(); self.pinned.len()];
        let mut put = |node: u32, weight: Real| {
            if !self.pinned[node as usize] {
                column[node as usize] += axis * weight;
            }
        };
        match self.spot(node) {
            None => put(node, 1.0),
            Some(spot) => spot.parts().for_each(|(node, weight)| put(node, weight)),
        }
        self.solve_as_linearised(&mut column);
        column
    }
}

impl Matter for SoftBody {
    fn begin(&mut self, h: Real) {
        self.start(h);
    }

    fn push(&mut self, node: u32, impulse: Vec2) {
        let Some(spot) = self.spot(node).copied() else {
            self.work.impulses[node as usize] += impulse;
            return;
        };
        for (node, weight) in spot.parts() {
            self.work.impulses[node as usize] += impulse * weight;
        }
    }

    fn approach(&mut self) -> Effort {
        self.approach_step()
    }

    fn settle(&mut self) -> Effort {
        self.solve_step()
    }

    fn place(&self, node: u32) -> Vec2 {
        self.of(node, &self.moving.positions)
    }

    fn lead(&self, node: u32) -> Vec2 {
        if self.work.relaxes {
            return Vec2::zeros();
        }
        self.of(node, &self.work.change) * (0.25 * self.work.h)
    }

    fn velocities(&self, node: u32) -> [Vec2; 2] {
        let now = self.of(node, &self.moving.velocities);
        // None before the first substep.
        let before = &self.work.before;
        [if before.is_empty() { now } else { self.of(node, before) }, now]
    }

    fn respond(&mut self, nodes: &[u32], out: &mut Vec<[Real; 4]>) {
        for &node in nodes {
            if !self.work.columns.contains_key(&node) {
                let columns = [Vec2::x(), Vec2::y()].map(|axis| self.column(node, axis));
                self.work.columns.insert(node, columns);
            }
        }
        out.clear();
        let Rot { cos, sin } = self.work.turn;
        for i in nodes {
            for j in nodes {
                let [x, y] = &self.work.columns[j];
                let (x, y) = (self.of(*i, x), self.of(*i, y));
                // R B Rᵀ.
                let turned = |v: Vec2| [cos * v.x - sin * v.y, sin * v.x + cos * v.y];
                let (a, b) = (turned(x), turned(y));
                out.push([
                    a[0] * cos - b[0] * sin,
                    a[0] * sin + b[0] * cos,
                    a[1] * cos - b[1] * sin,
                    a[1] * sin + b[1] * cos,
                ]);
            }
        }
    }

    fn excess(&mut self) -> Real {
        if self.work.relaxes { self.excess_relaxed() } else { 0.0 }
    }

    fn finish(&mut self) -> Ledger {
        self.end()
    }
}

/// Rotation that takes one set of places nearest to another, about their middles.
pub(super) fn turn_between(from: &[Vec2], to: &[Vec2]) -> Rot {
    let count = 1.0 / from.len() as Real;
    let (a, b) = (from[0], to[0]);
    let middle = |at: &[Vec2], first: Vec2| at.iter().map(|p| p - first).sum::<Vec2>() * count;
    let (ma, mb) = (middle(from, a), middle(to, b));
    let (mut along, mut across) = (0.0, 0.0);
    for (p, q) in from.iter().zip(to) {
        let (p, q) = (p - a - ma, q - b - mb);
        along += p.dot(&q);
        across += cross(p, q);
    }
    let length = hypot(along, across);
    if length > 0.0 { Rot { cos: along / length, sin: across / length } } else { Rot::IDENTITY }
}
