//! What a body does in a substep that its midpoint rule has no solution for: it is strained, or moves inside, far more than a step can
//! follow. It then moves as a rigid body does, and gives way inside towards rest: downhill, so that its energy never grows.

use super::body::{Linear, Parts, SoftBody};
use super::step::turn_between;
use super::tensor::{Tensor, determinant};
use super::triangle::{Rule, Step};
use crate::constraints::matter::Effort;
use crate::math::{Real, Vec2, cross, hypot, perp};

/// Newton steps downhill.
const MOST: u32 = 40;
/// Part of the energy below which a step downhill is the last.
const LITTLE: Real = 1e-6;
/// Kinetic energy, as a part of that of the strain, below which what is strained stands still. At the turn of a swing it is (ωh)² parts a
/// substep later.
const STILL: Real = 1e-8;
/// Strain that nothing but a tangle has without anything that holds it.
const FAR: Real = 0.1;
/// Halvings of a step.
const HALVINGS: u32 = 20;

/// Motion of a body as if it were rigid: that which has its momentum and its angular momentum.
#[derive(Clone, Copy, Debug, Default)]
pub struct Rigid {
    pub center: Vec2,
    pub velocity: Vec2,
    pub spin: Real,
    pub inertia: Real,
}

impl SoftBody {
    /// Whether a node is fixed.
    pub(super) fn is_pinned(&self) -> bool {
        self.pinned.contains(&true)
    }

    /// The rigid motion in these velocities.
    pub(super) fn rigid_motion(&self, at: &[Vec2], v: &[Vec2]) -> Rigid {
        let Parts { shares, mass, .. } = &self.parts;
        let from = at[0];
        let mean = |column: &[Vec2], from: Vec2| {
            shares.iter().zip(column).map(|(m, x)| (x - from) * *m).sum::<Vec2>() / *mass
        };
        let (center, velocity) = (from + mean(at, from), mean(v, Vec2::zeros()));
        let arms: Vec<Vec2> = at.iter().map(|x| x - center).collect();
        let mut heavy = vec![Vec2::zeros(); at.len()];
        self.add_mass_times(&arms, &mut heavy);
        let inertia: Real = arms.iter().zip(&heavy).map(|(r, m)| r.dot(m)).sum();
        let turning: Real = heavy.iter().zip(v).map(|(m, v)| cross(*m, v - velocity)).sum();
        let spin = if inertia > 0.0 { turning / inertia } else { 0.0 };
        Rigid { center, velocity, spin, inertia }
    }

    /// Moves the body on by a rigid motion, with the impulses as they are, and downhill inside. Impulses that come after that in the substep act
    /// through the same factors, so that contacts see a piece of matter that answers as it said.
    pub(super) fn relax(&mut self, effort: &mut Effort) {
        if self.work.based {
            return self.answer();
        }
        let (rigid, carried) = self.carried();
        self.work.carried = carried;
        self.work.end.clone_from(&self.work.carried);
        self.descend(effort);
        let end = self.work.end.clone();
        self.take_part(&end, 1.0, rigid);
        self.limit(rigid);
        let Self { work, moving, .. } = self;
        work.based = true;
        work.base_impulses.clone_from(&work.impulses);
        work.base_velocities.clone_from(&moving.velocities);
        work.base_end.clone_from(&work.end);
    }

    /// Adds the answer to the impulses since the body was relaxed.
    fn answer(&mut self) {
        let mut change = std::mem::take(&mut self.work.step);
        change.clear();
        let pairs = self.work.impulses.iter().zip(&self.work.base_impulses);
        change.extend(pairs.map(|(now, base)| now - base));
        change
            .iter_mut()
            .zip(&self.pinned)
            .filter(|(_, pin)| **pin)
            .for_each(|(p, _)| *p = Vec2::zeros());
        self.solve(&mut change);
        let h = self.work.h;
        for (i, dv) in change.iter().enumerate() {
            self.moving.velocities[i] = self.work.base_velocities[i] + dv;
            self.work.end[i] = self.work.base_end[i] + dv * h;
        }
        self.work.step = change;
        let (rigid, _) = self.carried();
        self.add_rigid(rigid);
    }

    /// Ends a substep in which the body relaxes: its energy is at most what it had and what was done on it. Returns the rest (J).
    pub(super) fn end_relaxed(&mut self) -> Real {
        let (rigid, carried) = self.carried();
        let allowed = self.start_energy() + self.pushed_work();
        if allowed + self.steady_work() < self.energy_now() {
            self.work.carried = carried;
            self.limit_to(allowed, rigid);
        }
        allowed + self.steady_work() - self.energy_now()
    }

    /// By how much (J) the substep would end above that, as things stand.
    pub(super) fn excess_relaxed(&mut self) -> Real {
        let (velocities, end) = (self.moving.velocities.clone(), self.work.end.clone());
        let carried = self.work.carried.clone();
        let excess = (-self.end_relaxed()).max(0.0);
        (self.moving.velocities, self.work.end, self.work.carried) = (velocities, end, carried);
        excess
    }

    fn limit(&mut self, rigid: Rigid) {
        let allowed = self.start_energy() + self.pushed_work();
        self.limit_to(allowed, rigid);
    }

    /// Takes from the velocity inside, then from the way inside, until the energy is at most what is allowed beside the work of steady
    /// forces.
    fn limit_to(&mut self, allowed: Real, rigid: Rigid) {
        let end = self.work.end.clone();
        let mut part = 1.0;
        for _ in 0..HALVINGS {
            if self.energy_now() <= allowed + self.steady_work() {
                return;
            }
            self.still(rigid);
            if self.energy_now() <= allowed + self.steady_work() {
                return;
            }
            part *= 0.5;
            self.take_part(&end, part, rigid);
        }
        self.take_part(&end, 0.0, rigid);
    }

    /// The end of the substep with a part of the way inside, and the velocities of that.
    fn take_part(&mut self, end: &[Vec2], part: Real, rigid: Rigid) {
        let Self { work, moving, .. } = self;
        for (i, x) in work.end.iter_mut().enumerate() {
            let way = (end[i] - work.carried[i]) * part;
            *x = work.carried[i] + way;
            moving.velocities[i] = way / work.h;
        }
        self.add_rigid(rigid);
    }

    /// Leaves only the rigid motion.
    fn still(&mut self, rigid: Rigid) {
        self.moving.velocities.fill(Vec2::zeros());
        self.add_rigid(rigid);
    }

    /// Gives the velocities the momentum and angular momentum of a rigid motion.
    fn add_rigid(&mut self, rigid: Rigid) {
        if self.is_pinned() {
            return;
        }
        let now = self.rigid_motion(&self.work.end, &self.moving.velocities);
        let spin = if now.inertia > 0.0 { rigid.spin * rigid.inertia / now.inertia } else { 0.0 };
        for (v, x) in self.moving.velocities.iter_mut().zip(&self.work.end) {
            *v += rigid.velocity - now.velocity + perp(x - now.center) * (spin - now.spin);
        }
    }

    /// Whether it is strained and yet stands still inside, though nothing holds it: tangled, in a hollow of its energy. Its columns are those
    /// at the end of a substep.
    fn is_stuck(&mut self) -> bool {
        let strained = |f: &Tensor| {
            let (stretch, shear) = (f[0] - f[3], f[1] + f[2]);
            hypot(stretch, shear) > FAR || (determinant(f) - 1.0).abs() > FAR
        };
        let held = self.is_pinned() || !self.forces.is_empty();
        if held
            || !self.work.deformations.iter().any(strained)
            || self.work.impulses.iter().any(|p| *p != Vec2::zeros())
        {
            return false;
        }
        let energy = self.strain_energy();
        let before = self.work.before.clone();
        let now = self.moving.velocities.clone();
        let (at, start) = (self.moving.positions.clone(), self.work.start.clone());
        self.energy_inside(&start, &before).max(self.energy_inside(&at, &now)) < STILL * energy
    }

    /// Kinetic energy (J) beyond that of the rigid motion.
    fn energy_inside(&self, at: &[Vec2], v: &[Vec2]) -> Real {
        let rigid = self.rigid_motion(at, v);
        let inside =
            |(x, v): (&Vec2, &Vec2)| v - rigid.velocity - perp(x - rigid.center) * rigid.spin;
        let inside: Vec<Vec2> = at.iter().zip(v).map(inside).collect();
        let mut heavy = vec![Vec2::zeros(); at.len()];
        self.add_mass_times(&inside, &mut heavy);
        0.5 * inside.iter().zip(&heavy).map(|(v, p)| v.dot(p)).sum::<Real>()
    }

    /// Leads what is stuck out of its hollow: straight towards the shape at rest, turned and placed as the body is, as little as lowers the
    /// energy. Returns what that takes (J).
    pub(super) fn untangle(&mut self) -> Real {
        if self.parts.triangles.is_empty() || !self.is_stuck() {
            return 0.0;
        }
        let (rest, at) = (&self.def.mesh.rest, &self.moving.positions);
        let rot = turn_between(rest, at);
        let center = |at: &[Vec2]| self.rigid_motion(at, &self.moving.velocities).center;
        let (from, to) = (center(rest), center(at));
        let energy = self.strain_energy();
        let mut part = 1.0 / 64.0;
        while part <= 1.0 {
            let lead = |(x, rest): (&Vec2, &Vec2)| x + (to + rot.apply(rest - from) - x) * part;
            let led: Vec<Vec2> = at.iter().zip(rest).map(lead).collect();
            let now = self.strain_energy_at(&led);
            if now < 0.999 * energy {
                self.moving.positions = led;
                self.drop_factors();
                return energy - now;
            }
            part *= 2.0;
        }
        0.0
    }

    fn start_energy(&mut self) -> Real {
        let now = std::mem::replace(&mut self.moving.velocities, self.work.before.clone());
        let energy = self.kinetic_energy() + self.strain_energy_at(&self.work.start);
        self.moving.velocities = now;
        energy
    }

    fn energy_now(&self) -> Real {
        self.kinetic_energy() + self.strain_energy_at(&self.work.end)
    }

    /// Work (J) of gravity and forces along the way.
    fn steady_work(&self) -> Real {
        let work = &self.work;
        let of = |i: usize| (work.end[i] - work.start[i]).dot(&(self.pull(i) - work.impulses[i]));
        (0..work.end.len()).map(of).sum::<Real>() / work.h
    }

    /// Work (J) of the impulses, as contacts book it: p·½(v⁻ + v⁺).
    fn pushed_work(&self) -> Real {
        let work = &self.work;
        let of = |i: usize| (work.before[i] + self.moving.velocities[i]).dot(&work.impulses[i]);
        0.5 * (0..work.end.len()).map(of).sum::<Real>()
    }

    /// What pulls at a node in the substep (N·s).
    fn pull(&self, i: usize) -> Vec2 {
        let work = &self.work;
        let force = self.forces.get(i).copied().unwrap_or_default();
        (force + work.acceleration * self.parts.shares[i]) * work.h + work.impulses[i]
    }

    /// The rigid motion after the substep, and where it brings the nodes.
    fn carried(&self) -> (Rigid, Vec<Vec2>) {
        let work = &self.work;
        if self.is_pinned() {
            return (Rigid::default(), work.start.clone());
        }
        let mut rigid = self.rigid_motion(&work.start, &work.before);
        let (mut push, mut twist) = (Vec2::zeros(), 0.0);
        // In the middle of the substep, where contacts act.
        let middle = rigid.center + rigid.velocity * (0.5 * work.h);
        for (i, x) in self.moving.positions.iter().enumerate() {
            let pull = self.pull(i);
            push += pull;
            twist += cross(x - middle, pull);
        }
        let before = rigid;
        rigid.velocity += push / self.parts.mass;
        if rigid.inertia > 0.0 {
            rigid.spin += twist / rigid.inertia;
        }
        let way = (before.velocity + rigid.velocity) * (0.5 * work.h);
        let tangent = 0.25 * work.h * (before.spin + rigid.spin);
        let by = 2.0 * tangent / (1.0 + tangent * tangent);
        let moved = |x: &Vec2| {
            let r = x - before.center;
            x + way + (perp(r) - r * tangent) * by
        };
        (rigid, work.start.iter().map(moved).collect())
    }

    /// From where the rigid motion brings it, down ½|x − x rigid|²_M/h² + ψ(x) − p·x/h: backward Euler's rule without the velocity inside.
    fn descend(&mut self, effort: &mut Effort) {
        let mut value = self.value();
        for _ in 0..MOST {
            effort.iterations += 1;
            let at = self.work.end.clone();
            let (h, way) = (self.work.h, Vec::new());
            let linear = Linear { h, at: at.clone(), way, definite: true, end: true };
            (self.moving.linear, self.work.factored) = (Some(linear), false);
            self.refresh(effort);
            self.work.turn = crate::math::Rot::IDENTITY;
            let mut step = self.slope();
            let slope = step.clone();
            self.solve(&mut step);
            let size: Real = step.iter().zip(&slope).map(|(a, b)| a.dot(b)).sum();
            let mut part = 1.0;
            let lower = loop {
                for ((x, at), step) in self.work.end.iter_mut().zip(&at).zip(&step) {
                    *x = at + step * part;
                }
                let now = self.value();
                if now <= value - 1e-4 * part * size {
                    break Some(value - now);
                }
                part *= 0.5;
                if part < 1e-6 {
                    break None;
                }
            };
            let Some(lower) = lower else {
                self.work.end = at;
                return;
            };
            value -= lower;
            if lower <= LITTLE * value.abs() {
                return;
            }
        }
    }

    /// h² times the function that is descended.
    fn value(&mut self) -> Real {
        let work = &self.work;
        let ways: Vec<Vec2> = work.end.iter().zip(&work.carried).map(|(x, c)| x - c).collect();
        let mut heavy = vec![Vec2::zeros(); ways.len()];
        self.add_mass_times(&ways, &mut heavy);
        let h = self.work.h;
        let own = |(i, way): (usize, &Vec2)| way.dot(&(heavy[i] * 0.5 - self.pull_inside(i) * h));
        h * h * self.strain_energy_at(&self.work.end)
            + ways.iter().enumerate().map(own).sum::<Real>()
    }

    /// What pulls at a node beyond what the rigid motion takes up; all of it where the body is pinned.
    fn pull_inside(&self, i: usize) -> Vec2 {
        if self.is_pinned() { self.pull(i) } else { self.work.impulses[i] }
    }

    /// Minus the gradient of [`SoftBody::value`].
    fn slope(&self) -> Vec<Vec2> {
        let work = &self.work;
        let Parts { moduli, stiffness, triangles, rods, bends, filling, .. } = &self.parts;
        let step = Step { h: work.h, rule: Rule::End };
        let mut slope = vec![Vec2::zeros(); work.end.len()];
        let ends = [&work.start[..], &work.end[..]];
        for (t, before) in triangles.iter().zip(work.deformations.chunks_exact(3)) {
            t.add_forces(moduli, step, (before, &work.end), &mut slope);
        }
        rods.iter().for_each(|rod| rod.add_forces(stiffness, step, ends, &mut slope));
        bends.iter().for_each(|bend| bend.add_forces(stiffness, step, ends, &mut slope));
        if let (Some(gas), Some(filling)) = (&self.def.gas, filling) {
            filling.add_forces(gas, step, ends, &mut slope);
        }
        let ways: Vec<Vec2> = work.end.iter().zip(&work.carried).map(|(x, c)| x - c).collect();
        let mut heavy = vec![Vec2::zeros(); ways.len()];
        self.add_mass_times(&ways, &mut heavy);
        for (i, s) in slope.iter_mut().enumerate() {
            *s = if self.pinned[i] {
                Vec2::zeros()
            } else {
                *s * (work.h * work.h) + self.pull_inside(i) * work.h - heavy[i]
            };
        }
        slope
    }
}
