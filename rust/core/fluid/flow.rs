//! A substep of the fluid: what is near what, divergence, forces, pressure, motion.

use super::balance::Balance;
use super::cells::Cells;
use super::kernel::Kernel;
use super::pairs::{Around, Pair, Pairs};
use super::particles::Spare;
use super::pressure::{self, Coupling, Effort, Goal};
use super::solid::{Solid, Touches};
use super::streams::Held;
use super::team::Team;
use super::tension::{Seen, Surface};
use super::viscosity::{self, Friction};
use super::{Fluids, Material};
use crate::body::Bodies;
use crate::math::{Real, Twist, Vec2};

mod forces;

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
    /// What jitter of light fluids under pressure is braked by (Pa·s).
    stiff: Vec<Real>,
    /// What pressures are to keep: parts of kernels that are filled, of light fluids their means.
    filled: Vec<Real>,
    target: Vec<Real>,
    rates: Vec<Real>,
    /// Velocities before the pressures.
    free: Vec<Vec2>,
    /// Particles that inflows hold.
    held: Vec<Held>,
    /// Work (J) of inflows on what they hold, in this substep.
    pub work: Real,
    surface: Surface,
    tension: Vec<Real>,
    adhesion: Vec<Real>,
    forces: Vec<Pair>,
    /// Impulses (N·s) that the bodies have got before the pressures.
    given: Vec<Twist>,
    /// All impulses that the bodies get in the substep.
    pub impulses: Vec<Twist>,
    columns: pressure::Columns,
    braking: viscosity::Columns,
    balance: Balance,
}

/// Part of the overdensity that is taken back in a substep, so that it sets nothing swinging.
const CORRECTION: Real = 0.2;

/// Farthest way of a particle and its neighbours in a substep to take overdensity back, over the spacing: what was put into
/// a wall, or into other particles, comes out gently.
const GENTLE: Real = 0.1;

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
        let mut fastest = fastest.fold(0.0, Real::max).sqrt().max(fluids.fastest_inflow());
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
        (COURANT * fluids.spacing / fastest).min(fluids.longest_wave())
    }

    /// Finds what is near what, takes back the divergence, and lets the forces act. Bodies then have their velocities as
    /// they would be without the fluid's pressures but for `changes`, what all else does to them in the substep.
    pub fn begin(&mut self, fluids: &mut Fluids, bodies: &Bodies, (gravity, h): (Vec2, Real)) {
        let team = self.team.clone();
        team.run(|| self.prepare(fluids, bodies, (gravity, h)));
    }

    fn prepare(&mut self, fluids: &mut Fluids, bodies: &Bodies, (gravity, h): (Vec2, Real)) {
        self.work = 0.0;
        self.neighbours(fluids, bodies, h);
        self.relax(fluids, h);
        self.force(fluids, gravity, h);
        let area = fluids.area();
        self.hold(&mut fluids.particles.velocities, area);
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
        let particles = &fluids.particles;
        let n = particles.len();
        self.pairs.find(&self.cells, &particles.positions, (&kernel, area), &self.team);
        let (cells, positions) = (&self.cells, &particles.positions[..]);
        self.touches.find((&self.solids, bodies), (cells, positions), &kernel, h);
        self.impulses.clear();
        self.impulses.resize(self.touches.wet.len(), Twist::ZERO);
        fill(&mut self.density, fluids, |material| material.density);
        self.inverse_density.clear();
        self.inverse_density.extend(self.density.iter().map(|density| 1.0 / density));
        fluids.held(&mut self.held);
        // What an inflow holds gives way to nothing.
        for Held { particle, velocity } in &self.held {
            self.inverse_density[*particle as usize] = 0.0;
            fluids.particles.velocities[*particle as usize] = *velocity;
        }
        let particles = &mut fluids.particles;
        self.around.resize(n, Around::default());
        self.pairs.sum_around(&self.inverse_density, &mut self.around, &self.team);
        self.balance(area * kernel.value(0.0));
        let touches = (&self.touches.list[..], &self.touches.wet[..]);
        let own = (&self.inverse_density[..], area);
        pressure::diagonal(touches, &mut self.around, own, &mut self.diagonal);
        // What is held gives way to nothing, so that nothing presses it; its neighbours are pressed away from it.
        self.held.iter().for_each(|held| self.diagonal[held.particle as usize] = 0.0);
        // A particle that nothing is near cannot be pressed.
        let least = 1e-9 / (fluids.spacing * fluids.spacing);
        for (diagonal, inverse) in self.diagonal.iter_mut().zip(&self.inverse_density) {
            if *diagonal < least * inverse {
                *diagonal = 0.0;
            }
        }
        let own = area * kernel.value(0.0);
        let parts = self.around.iter().map(|around| around.part + own);
        particles.compressions.clear();
        particles.compressions.extend(parts);
        self.filled.clone_from(&particles.compressions);
        self.balance.even(&self.pairs, &mut self.filled, &self.team);
    }

    /// Lets the same pressure everywhere exert no force on what is light; `own` is what a particle adds to its own part.
    fn balance(&mut self, own: Real) {
        let Self { balance, pairs, around, touches, density, rates, .. } = self;
        balance.choose(density);
        if !balance.at_work() {
            return;
        }
        rates.clear();
        rates.extend(around.iter().map(|around| around.part + own));
        for touch in &touches.list {
            rates[touch.particle as usize] += touch.part;
        }
        balance.keep(|i| rates[i] > LOOSE);
        balance.correct(pairs, (around, &touches.list), &self.team);
        pairs.sum_around(&self.inverse_density, around, &self.team);
    }

    /// Takes back the divergence that the last step left, where the fluid is dense.
    fn relax(&mut self, fluids: &mut Fluids, h: Real) {
        let particles = &mut fluids.particles;
        self.converge(&particles.velocities);
        let parts = self.rates.iter().zip(&self.filled);
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
        let parts = self.rates.iter().zip(&self.filled).zip(&self.diagonal);
        let lightest = self.density.iter().copied().fold(Real::INFINITY, Real::min);
        self.target.clear();
        self.target.extend(parts.map(|((rate, part), diagonal)| {
            let over = part - 1.0;
            if over <= 0.0 {
                return h * rate + (over + BAND).min(0.0);
            }
            let most = GENTLE * fluids.spacing * (diagonal * lightest).sqrt();
            h * rate + (CORRECTION * over).min(most)
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
        if !self.held.is_empty() {
            self.push(fluids, h);
        }
        let particles = &mut fluids.particles;
        for (position, velocity) in particles.positions.iter_mut().zip(&particles.velocities) {
            *position += velocity * h;
        }
        self.balance.spread(&mut particles.positions, fluids.spacing);
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
