//! All forces but pressure: gravity, surface tension and viscosity, and what inflows hold.

use super::{Coupling, Flow, Friction, Held, Pair, Seen, fill};
use crate::body::Bodies;
use crate::fluid::kernel::{Kernel, SUPPORT, lattice};
use crate::fluid::{Fluids, Particles};
use crate::math::{Real, Twist, Vec2};

impl Flow {
    /// Gives what inflows hold its velocity back, and books the work of that.
    pub(super) fn hold(&mut self, velocities: &mut [Vec2], area: Real) {
        for Held { particle, velocity } in &self.held {
            let i = *particle as usize;
            let change = velocity - velocities[i];
            self.work += self.density[i] * area * change.dot(velocity);
            velocities[i] = *velocity;
        }
    }

    /// Books the work of inflows against the pressures last found and those against divergence.
    pub(super) fn push(&mut self, fluids: &Fluids, h: Real) {
        let area = fluids.area();
        let mut columns = std::mem::take(&mut self.columns);
        let Particles { pressures, relaxing, .. } = &fluids.particles;
        self.tension.clear();
        self.tension.extend(pressures.iter().zip(relaxing).map(|(p, q)| p + q));
        // Forces over areas, not accelerations.
        self.adhesion.clear();
        self.adhesion.resize(self.tension.len(), 1.0);
        let plain = Coupling { inverse_density: &self.adhesion, ..self.coupling(area) };
        plain.act(&self.tension, &mut columns.against, &mut columns.loads);
        for Held { particle, velocity } in &self.held {
            let against = columns.against[*particle as usize];
            self.work += h * area * (against[0] * velocity.x + against[1] * velocity.y);
        }
        self.columns = columns;
    }

    /// Surface tension and adhesion.
    fn draw(&mut self, fluids: &mut Fluids, h: Real) {
        fill(&mut self.tension, fluids, |material| material.tension);
        fill(&mut self.adhesion, fluids, |material| material.adhesion);
        fluids.surface = None;
        if self.tension.iter().all(|tension| *tension == 0.0) {
            return;
        }
        let Particles { positions, velocities, kinds, .. } = &mut fluids.particles;
        let seen = Seen {
            positions,
            kinds,
            tension: &self.tension,
            adhesion: &self.adhesion,
            support: SUPPORT * fluids.spacing,
        };
        self.forces.clear();
        self.forces.resize(positions.len(), [0.0; 2]);
        self.given.clear();
        self.given.resize(self.impulses.len(), Twist::ZERO);
        let out = (&mut self.forces[..], &mut self.given[..]);
        fluids.surface = Some(self.surface.pull((&self.pairs, &self.touches), seen, out, h));
        let area = lattice().area * fluids.spacing * fluids.spacing;
        for ((velocity, force), density) in
            velocities.iter_mut().zip(&self.forces).zip(&self.density)
        {
            *velocity += Vec2::new(force[0], force[1]) * (h / (density * area));
        }
        self.give();
    }

    /// Hands the impulses just found to the bodies.
    fn give(&mut self) {
        for ((wet, all), own) in
            self.touches.wet.iter_mut().zip(&mut self.impulses).zip(&self.given)
        {
            wet.push(own);
            *all += *own;
        }
    }

    /// Energy (J) of the surfaces as they are.
    #[must_use]
    pub fn surface_energy(&mut self, fluids: &Fluids, bodies: &Bodies) -> Real {
        if fluids.list.values().iter().all(|fluid| fluid.material.tension == 0.0) {
            return 0.0;
        }
        let mut fluids = fluids.clone();
        self.look(bodies, fluids.spacing);
        self.neighbours(&mut fluids, bodies, 0.0);
        self.draw(&mut fluids, 0.0);
        fluids.surface.unwrap_or(0.0)
    }

    /// Gravity, surface tension and viscosity.
    pub(super) fn force(&mut self, fluids: &mut Fluids, gravity: Vec2, h: Real) {
        let area = fluids.area();
        fill(&mut self.viscosity, fluids, |material| material.viscosity);
        let particles = &mut fluids.particles;
        particles.velocities.iter_mut().for_each(|velocity| *velocity += gravity * h);
        self.draw(fluids, h);
        let particles = &mut fluids.particles;
        let pressures = (&particles.pressures[..], &particles.relaxing[..]);
        self.balance.stiffen(pressures, &self.density, (area, h), &mut self.stiff);
        if self.viscosity.iter().chain(&self.stiff).all(|viscosity| *viscosity == 0.0) {
            return;
        }
        self.even_out(&particles.positions, area);
        let friction = Friction {
            pairs: &self.pairs,
            touches: &self.touches,
            positions: &particles.positions,
            viscosity: &self.viscosity,
            stiff: &self.stiff,
            density: &self.density,
            area,
            h,
            team: &self.team,
        };
        let velocities: &mut [Pair] = bytemuck::cast_slice_mut(&mut particles.velocities);
        let mut given = std::mem::take(&mut self.given);
        given.clear();
        given.resize(self.impulses.len(), Twist::ZERO);
        friction.brake(velocities, &mut given, &mut self.braking);
        self.given = given;
        self.give();
    }

    /// Scales the viscosity at each particle by what its neighbours lack to pull as those on a lattice do: where rows slide
    /// past one another they pull 2 % less in the mean. The discrete divergence of the field x, which is 2, lacks the same;
    /// where neighbours are missing, at surfaces, the part of the kernel that they fill tells that it should.
    fn even_out(&mut self, positions: &[Vec2], area: Real) {
        let Self { pairs, touches, around, rates, team, .. } = self;
        let lattice = lattice();
        rates.resize(positions.len(), 0.0);
        pairs.converge(bytemuck::cast_slice(positions), rates, team);
        rates.iter_mut().for_each(|rate| *rate *= -0.5 * lattice.shear);
        for touch in &touches.list {
            rates[touch.particle as usize] += lattice.pull * touch.part;
        }
        let spacing = (area / lattice.area).sqrt();
        let full = 1.0 - area * Kernel::new(spacing).value(0.0);
        for ((viscosity, around), pull) in self.viscosity.iter_mut().zip(around).zip(rates) {
            // What lies nearly in one place pulls together anyway.
            let part = around.part / full;
            *viscosity *= if part > 0.0 { part / pull.max(0.5 * part) } else { 1.0 };
        }
    }
}
