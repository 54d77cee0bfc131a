//! A substep of the fluid: what is near what, divergence, forces, pressure, motion.

use super::cells::Cells;
use super::kernel::{Kernel, lattice};
use super::pairs::{Around, Pair, Pairs};
use super::particles::Spare;
use super::pressure::{self, Coupling, Effort, Goal};
use super::solid::{Solid, Touches};
use super::team::Team;
use super::viscosity::{self, Friction};
use super::{Fluids, Material};
use crate::body::Bodies;
use crate::math::{Real, Twist, Vec2};

/// What the fluid works with in a step; nothing of it is part of the state.
#[derive(Clone, Debug, Default)]
pub struct Flow {
    /// Threads.
    pub team: Team,
    /// Borders of the bodies, in body order.
    pub solids: Vec<Solid>,
    /// Bodies near particles, and what they add.
    pub touches: Touches,
    /// What the last call took.
    pub effort: Effort,
    cells: Cells,
    pairs: Pairs,
    spare: Spare,
    around: Vec<Around>,
    diagonal: Vec<Real>,
    inverse_density: Vec<Real>,
    density: Vec<Real>,
    viscosity: Vec<Real>,
    target: Vec<Real>,
    rates: Vec<Real>,
    /// Velocities before the pressures.
    free: Vec<Vec2>,
    /// Impulses (N·s) that the bodies have got before the pressures.
    given: Vec<Twist>,
    /// All impulses that the bodies get in the substep.
    pub impulses: Vec<Twist>,
    columns: pressure::Columns,
    braking: viscosity::Columns,
}

/// Part of the overdensity that is taken back in a substep, so that it sets nothing swinging.
const CORRECTION: Real = 0.2;

/// How far below its density a particle may be without being pressed: a band in which pressures stay.
const BAND: Real = 0.01;

/// Part of the density below which divergence is none of the pressure's business.
const LOOSE: Real = 0.95;

/// Largest way of a particle in a substep, over the spacing.
pub const COURANT: Real = 0.4;

/// The part of a kernel that is filled by particles that are near no others, 0.455, and a little more.
pub(super) const ALONE: Real = 0.55;

/// What may be left of what is to be pressed away.
const REST: Real = 0.2;

/// The largest mean error of densities, whatever is to be pressed away.
const WORST: Real = 2e-4;

/// Most applications of the operator of pressure a solution.
const MOST: u32 = 300;

impl Flow {
    /// Takes in the shapes of the bodies.
    pub fn look(&mut self, bodies: &Bodies, spacing: Real) {
        self.solids.clear();
        let each = bodies.infos.iter().zip(&bodies.local_centers);
        self.solids.extend(each.map(|(info, center)| Solid::new(&info.def, *center, spacing)));
    }

    /// The longest substep (s) in which no particle, and no body near them, goes too far.
    #[must_use]
    pub fn longest(&self, fluids: &Fluids, bodies: &Bodies, rest: Real) -> Real {
        let particles = &fluids.particles;
        let speeds = particles.velocities.iter().zip(&particles.compressions);
        let fastest = speeds.filter(|(_, part)| **part > ALONE).map(|(v, _)| v.norm_squared());
        let mut fastest = fastest.fold(0.0, Real::max).sqrt();
        let (low, high) = super::cells::bounds(&particles.positions);
        for (i, solid) in self.solids.iter().enumerate() {
            let twist = &bodies.twists[i];
            let speed = twist.linear.norm() + twist.angular.abs() * solid.reach;
            let place = bodies.poses[i].position;
            let apart = (place - place.sup(&low).inf(&high)).norm() - solid.reach;
            if apart < speed * rest + fluids.spacing {
                fastest = fastest.max(speed);
            }
        }
        COURANT * fluids.spacing / fastest
    }

    /// Finds what is near what, takes back the divergence, and lets the forces act. Bodies then have their velocities as
    /// they would be without the fluid's pressures but for `changes`, what all else does to them in the substep.
    pub fn begin(&mut self, fluids: &mut Fluids, bodies: &Bodies, (gravity, h): (Vec2, Real)) {
        let team = self.team.clone();
        team.run(|| self.prepare(fluids, bodies, (gravity, h)));
    }

    fn prepare(&mut self, fluids: &mut Fluids, bodies: &Bodies, (gravity, h): (Vec2, Real)) {
        self.neighbours(fluids, bodies, h);
        self.relax(fluids, h);
        self.force(fluids, gravity, h);
        self.free.clear();
        self.free.extend_from_slice(&fluids.particles.velocities);
        self.given.clear();
        self.given.extend_from_slice(&self.impulses);
    }

    fn neighbours(&mut self, fluids: &mut Fluids, bodies: &Bodies, h: Real) {
        let kernel = Kernel::new(fluids.spacing);
        let area = fluids.area();
        self.cells.sort(&fluids.particles.positions, kernel.support);
        fluids.particles.reorder(&self.cells.order, &mut self.spare);
        let Fluids { particles, .. } = &mut *fluids;
        let n = particles.len();
        self.pairs.find(&self.cells, &particles.positions, (&kernel, area), &self.team);
        let (cells, positions) = (&self.cells, &particles.positions[..]);
        self.touches.find((&self.solids, bodies), (cells, positions), &kernel, h);
        self.impulses.clear();
        self.impulses.resize(self.touches.wet.len(), Twist::ZERO);
        fill(&mut self.density, fluids, |material| material.density);
        self.inverse_density.clear();
        self.inverse_density.extend(self.density.iter().map(|density| 1.0 / density));
        self.around.resize(n, Around::default());
        self.pairs.sum_around(&self.inverse_density, &mut self.around, &self.team);
        let touches = (&self.touches.list[..], &self.touches.wet[..]);
        let own = (&self.inverse_density[..], area);
        pressure::diagonal(touches, &mut self.around, own, &mut self.diagonal);
        // A particle that nothing is near cannot be pressed.
        let least = 1e-9 / (fluids.spacing * fluids.spacing);
        for (diagonal, inverse) in self.diagonal.iter_mut().zip(&self.inverse_density) {
            if *diagonal < least * inverse {
                *diagonal = 0.0;
            }
        }
        let own = area * kernel.value(0.0);
        let parts = self.around.iter().map(|around| around.part + own);
        fluids.particles.compressions.clear();
        fluids.particles.compressions.extend(parts);
    }

    /// Takes back the divergence that the last step left, where the fluid is dense.
    fn relax(&mut self, fluids: &mut Fluids, h: Real) {
        let particles = &mut fluids.particles;
        self.converge(&particles.velocities);
        let parts = self.rates.iter().zip(&particles.compressions);
        self.target.clear();
        self.target.extend(parts.map(|(rate, part)| h * rate + (part - LOOSE).min(0.0)));
        let mut pressures = std::mem::take(&mut particles.relaxing);
        self.solve(&mut pressures, fluids.area(), h);
        let particles = &mut fluids.particles;
        particles.relaxing = pressures;
        for (velocity, against) in particles.velocities.iter_mut().zip(&self.columns.against) {
            *velocity -= Vec2::new(against[0], against[1]) * h;
        }
        self.book(h);
        let wet = self.touches.wet.iter_mut().zip(&self.impulses);
        wet.for_each(|(wet, impulse)| wet.push(impulse));
    }

    /// Gravity and viscosity.
    fn force(&mut self, fluids: &mut Fluids, gravity: Vec2, h: Real) {
        let area = fluids.area();
        fill(&mut self.viscosity, fluids, |material| material.viscosity);
        let particles = &mut fluids.particles;
        particles.velocities.iter_mut().for_each(|velocity| *velocity += gravity * h);
        if self.viscosity.iter().all(|viscosity| *viscosity == 0.0) {
            return;
        }
        self.even_out(&particles.positions, area);
        let friction = Friction {
            pairs: &self.pairs,
            touches: &self.touches,
            positions: &particles.positions,
            viscosity: &self.viscosity,
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
        for ((wet, all), own) in self.touches.wet.iter_mut().zip(&mut self.impulses).zip(&given) {
            wet.push(own);
            *all += *own;
        }
        self.given = given;
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

    /// Finds the pressures that keep the density, where all else changes the velocities of the wet bodies by `changes`
    /// in the substep. Velocities and impulses then are those at its end.
    pub fn press(&mut self, fluids: &mut Fluids, changes: &[Twist], h: Real) {
        let team = self.team.clone();
        team.run(|| self.press_on(fluids, changes, h));
    }

    fn press_on(&mut self, fluids: &mut Fluids, changes: &[Twist], h: Real) {
        for (wet, change) in self.touches.wet.iter_mut().zip(changes) {
            wet.twist += *change;
        }
        let free = std::mem::take(&mut self.free);
        self.converge(&free);
        self.free = free;
        for (wet, change) in self.touches.wet.iter_mut().zip(changes) {
            wet.twist += Twist::new(-change.linear, -change.angular);
        }
        let parts = self.rates.iter().zip(&fluids.particles.compressions);
        self.target.clear();
        self.target.extend(parts.map(|(rate, part)| {
            let over = part - 1.0;
            h * rate + if over > 0.0 { CORRECTION * over } else { (over + BAND).min(0.0) }
        }));
        let mut pressures = std::mem::take(&mut fluids.particles.pressures);
        self.solve(&mut pressures, fluids.area(), h);
        let particles = &mut fluids.particles;
        particles.pressures = pressures;
        let ends = particles.velocities.iter_mut().zip(&self.free).zip(&self.columns.against);
        for ((velocity, free), against) in ends {
            *velocity = free - Vec2::new(against[0], against[1]) * h;
        }
        self.impulses.clone_from(&self.given);
        self.book(h);
    }

    /// Moves the particles.
    pub fn finish(&mut self, fluids: &mut Fluids, h: Real) {
        let particles = &mut fluids.particles;
        for (position, velocity) in particles.positions.iter_mut().zip(&particles.velocities) {
            *position += velocity * h;
        }
    }

    /// Adds the loads of the pressures to the impulses.
    fn book(&mut self, h: Real) {
        for (impulse, load) in self.impulses.iter_mut().zip(&self.columns.loads) {
            *impulse += Twist::new(load.linear * -h, load.angular * -h);
        }
    }

    /// Rates at which the parts are filled.
    fn converge(&mut self, velocities: &[Vec2]) {
        let mut rates = std::mem::take(&mut self.rates);
        rates.resize(velocities.len(), 0.0);
        let wet = &self.touches.wet;
        let velocities: &[Pair] = bytemuck::cast_slice(velocities);
        self.coupling(0.0).converge(velocities, &|k| wet[k].twist, &mut rates);
        self.rates = rates;
    }

    fn coupling(&self, area: Real) -> Coupling<'_> {
        Coupling {
            pairs: &self.pairs,
            touches: &self.touches,
            inverse_density: &self.inverse_density,
            diagonal: &self.diagonal,
            area,
            team: &self.team,
        }
    }

    fn solve(&mut self, pressures: &mut [Real], area: Real, h: Real) {
        let mut target = std::mem::take(&mut self.target);
        let size = target.iter().map(|b| b.max(0.0)).sum::<Real>() / target.len().max(1) as Real;
        target.iter_mut().for_each(|b| *b /= h * h);
        let goal = Goal { tolerance: (REST * size).min(WORST), h, most: MOST };
        let mut columns = std::mem::take(&mut self.columns);
        let effort = self.coupling(area).solve(pressures, &target, goal, &mut columns);
        self.effort.iterations += effort.iterations;
        self.effort.residual = self.effort.residual.max(effort.residual);
        self.columns = columns;
        self.target = target;
    }
}

/// Fills a column with what the material of each particle has.
fn fill(column: &mut Vec<Real>, fluids: &Fluids, of: impl Fn(&Material) -> Real) {
    column.clear();
    let table = fluids.materials();
    column.extend(fluids.particles.kinds.iter().map(|kind| of(&table[*kind as usize])));
}
