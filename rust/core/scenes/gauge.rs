//! What runs with contacts are judged by: overlap, drift, speed, and energy that comes from nothing.

use super::Number;
use crate::collision::{Collider, Frame, colliders, distance};
use crate::error::Result;
use crate::math::{Pose, Real};
use crate::world::World;

/// What a run has shown. Energies are parts of the gauge's energy.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Seen {
    /// Deepest overlap, as a part of the smaller width of the two shapes.
    pub overlap: Real,
    /// Largest E − E₀ − work − correction_work.
    pub gained: Real,
    /// Most that contacts have given instead of taken: largest fall of what is dissipated below its start.
    pub returned: Real,
    /// Largest change of E − work − correction_work + dissipated.
    pub unbalanced: Real,
    /// Largest |v| + ℓ|ω| (m/s) since the speeds were last forgotten.
    pub speed: Real,
    /// Largest way of a body from its start (m).
    pub drift: Real,
}

/// Looks at a world as it moves.
pub(super) struct Gauge {
    colliders: Vec<Collider>,
    start: Vec<Pose>,
    /// What energies are measured against (J).
    scale: Real,
    balance: Real,
    energy: Real,
    dissipated: Real,
    /// What has been seen.
    pub seen: Seen,
}

/// The larger of two, where what is no number is larger than anything.
pub(super) fn worse(a: Real, b: Real) -> Real {
    if b.is_nan() { Real::INFINITY } else { a.max(b) }
}

impl Gauge {
    /// For a world as it is now. Energies are measured against its kinetic energy and what a fall through `height` (m)
    /// gives all bodies.
    pub fn new(world: &World, height: Real) -> Result<Self> {
        let bodies = world.bodies();
        let of_body = |i: usize| {
            colliders(i as u32, &bodies.infos[i].def.shapes, bodies.local_centers[i]).into_iter()
        };
        let energy = world.energy()?;
        let fall = world.mass() * world.settings().gravity.norm() * height;
        Ok(Self {
            colliders: (0..bodies.len()).flat_map(of_body).collect(),
            start: bodies.poses.clone(),
            scale: energy.kinetic + fall,
            balance: energy.balance(),
            energy: energy.total() - energy.work - energy.correction_work,
            dissipated: energy.dissipated,
            seen: Seen::default(),
        })
    }

    /// Looks at the energies.
    pub fn look(&mut self, world: &World) -> Result<()> {
        let energy = world.energy()?;
        let now = energy.total() - energy.work - energy.correction_work;
        let Self { seen, scale, .. } = self;
        seen.gained = worse(seen.gained, (now - self.energy) / *scale);
        seen.returned = worse(seen.returned, (self.dissipated - energy.dissipated) / *scale);
        seen.unbalanced = worse(seen.unbalanced, (energy.balance() - self.balance).abs() / *scale);
        Ok(())
    }

    /// Looks at places, speeds and overlaps.
    pub fn look_closely(&mut self, world: &World) {
        let bodies = world.bodies();
        for (i, (pose, twist)) in bodies.poses.iter().zip(&bodies.twists).enumerate() {
            if !bodies.masses[i].is_free() {
                continue;
            }
            let size = bodies.infos[i].size;
            let way = (pose.position - self.start[i].position).norm();
            self.seen.drift = worse(self.seen.drift, way);
            let speed = twist.linear.norm() + size * twist.angular.abs();
            self.seen.speed = worse(self.seen.speed, speed);
        }
        self.seen.overlap = worse(self.seen.overlap, deepest(&self.colliders, world));
    }

    /// Steps and looks: at the energies after each step, at all else `looks` times.
    pub fn run(&mut self, world: &mut World, dt: Real, steps: u32, looks: u32) -> Result<()> {
        let every = (steps / looks).max(1);
        for step in 1..=steps {
            world.step(dt)?;
            self.look(world)?;
            if step % every == 0 {
                self.look_closely(world);
            }
        }
        Ok(())
    }

    /// Forgets speeds and drift; from now on drift is counted from where the bodies stand in `rest`.
    pub fn settle(&mut self, rest: &World) {
        self.start.clone_from(&rest.bodies().poses);
        (self.seen.speed, self.seen.drift) = (0.0, 0.0);
    }

    /// What is asked of every run: no energy from nothing, none that contacts give back, the books in balance.
    pub fn laws(&self, of: &str) -> [Number; 3] {
        [
            at_most(format!("energy gained, {of}"), self.seen.gained, 1e-6),
            at_most(format!("energy given by contacts, {of}"), self.seen.returned, 1e-9),
            at_most(format!("change of the energy balance, {of}"), self.seen.unbalanced, 1e-6),
        ]
    }
}

/// A number that must not be above a bound.
pub(super) fn at_most(what: impl Into<String>, value: Real, asked: Real) -> Number {
    Number { what: what.into(), value, exact: 0.0, asked }
}

/// Deepest overlap of two colliders of which one can move, as a part of the smaller width.
fn deepest(colliders: &[Collider], world: &World) -> Real {
    let bodies = world.bodies();
    let place = |collider: &Collider| &bodies.poses[collider.body as usize];
    let free = |collider: &Collider| bodies.masses[collider.body as usize].is_free();
    let mut worst = 0.0;
    for (k, a) in colliders.iter().enumerate() {
        let frame = Frame::of(place(a));
        for b in &colliders[..k] {
            let reach = a.reach + b.reach;
            let apart = place(b).position - place(a).position;
            if a.body == b.body || !(free(a) || free(b)) || apart.norm_squared() > reach * reach {
                continue;
            }
            let between = Frame::of(place(b)).seen_from(&frame);
            let gap = distance(&a.geometry, &b.geometry, &between).distance;
            worst = worse(worst, -gap / a.width.min(b.width));
        }
    }
    worst
}
