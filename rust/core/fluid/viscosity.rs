//! Viscosity, by implicit Euler, which any step and any viscosity allow: (M − h L) v = M v*.
//!
//! L v at particle i is Σ 2μ V (−W′/r)(v_j − v_i) after Morris, Fox and Zhu ("Modeling low Reynolds number incompressible
//! flows using SPH", 1997), whose error is the same in all directions; at bodies the same integrated over the solid. Bodies
//! are part of the unknowns. Found by conjugate gradients, scaled by the diagonal.

use super::kernel::lattice;
use super::pairs::{Pair, Pairs};
use super::solid::{Touches, Wet, moment};
use super::team::Team;
use crate::math::{Real, Twist, Vec2};

/// What brakes in a substep.
pub struct Friction<'a> {
    /// Pairs of particles.
    pub pairs: &'a Pairs,
    /// Bodies near particles.
    pub touches: &'a Touches,
    /// Where the particles are (m).
    pub positions: &'a [Vec2],
    /// Viscosity at each particle (Pa·s).
    pub viscosity: &'a [Real],
    /// What brakes a particle and each of its neighbours besides (Pa·s): see `Balance::stiffen`.
    pub stiff: &'a [Real],
    /// Density of each particle (kg/m²).
    pub density: &'a [Real],
    /// Area of a particle (m²).
    pub area: Real,
    /// Length of the substep (s).
    pub h: Real,
    /// Threads.
    pub team: &'a Team,
}

/// Velocities of particles and of bodies.
#[derive(Clone, Debug, Default)]
struct Motion {
    particles: Vec<Pair>,
    bodies: Vec<Twist>,
}

/// Columns that velocities are found in.
#[derive(Clone, Debug, Default)]
pub struct Columns {
    rest: Motion,
    search: Motion,
    image: Motion,
    scaled: Motion,
    diagonal: Vec<Real>,
    /// Response of each body, with what brakes it.
    bodies: Vec<[Real; 3]>,
}

/// Relative change of the velocities that is small enough.
const SMALL: Real = 1e-8;

/// Most steps.
const MOST: u32 = 400;

impl Motion {
    fn resize(&mut self, particles: usize, bodies: usize) {
        self.particles.resize(particles, [0.0; 2]);
        self.bodies.resize(bodies, Twist::ZERO);
    }

    fn dot(&self, other: &Self) -> Real {
        let own = |(a, b): (&Pair, &Pair)| a[0] * b[0] + a[1] * b[1];
        let particles: Real = self.particles.iter().zip(&other.particles).map(own).sum();
        let body = |(a, b): (&Twist, &Twist)| a.linear.dot(&b.linear) + a.angular * b.angular;
        particles + self.bodies.iter().zip(&other.bodies).map(body).sum::<Real>()
    }

    /// self = other + factor·self.
    fn follow(&mut self, other: &Self, factor: Real) {
        for (own, other) in self.particles.iter_mut().zip(&other.particles) {
            *own = [other[0] + factor * own[0], other[1] + factor * own[1]];
        }
        for (own, other) in self.bodies.iter_mut().zip(&other.bodies) {
            own.linear = other.linear + own.linear * factor;
            own.angular = other.angular + factor * own.angular;
        }
    }

    /// self += factor·other.
    fn add(&mut self, other: &Self, factor: Real) {
        for (own, other) in self.particles.iter_mut().zip(&other.particles) {
            *own = [own[0] + factor * other[0], own[1] + factor * other[1]];
        }
        for (own, other) in self.bodies.iter_mut().zip(&other.bodies) {
            *own += Twist::new(other.linear * factor, factor * other.angular);
        }
    }
}

impl Friction<'_> {
    /// Brakes velocities, and gives each body an impulse (N·s): both changes are added.
    pub fn brake(&self, velocities: &mut [Pair], impulses: &mut [Twist], columns: &mut Columns) {
        let (n, wet) = (velocities.len(), &self.touches.wet);
        let Columns { rest, search, image, scaled, diagonal, bodies } = columns;
        for motion in [&mut *rest, &mut *search, &mut *image, &mut *scaled] {
            motion.resize(n, wet.len());
        }
        self.measure(diagonal, bodies);
        // The change of velocity is the unknown: M Δv − h L Δv = h L v.
        let start = |k: usize| wet[k].twist;
        self.forces(velocities, &start, rest);
        let mut change = std::mem::take(scaled);
        change.particles.fill([0.0; 2]);
        change.bodies.fill(Twist::ZERO);
        search.particles.fill([0.0; 2]);
        search.bodies.fill(Twist::ZERO);
        let (mut before, mut first) = (1.0, None);
        for _ in 0..MOST {
            self.scale(rest, (diagonal, bodies), image);
            let size = rest.dot(image);
            let first = *first.get_or_insert(size);
            if size <= SMALL * SMALL * first || size == 0.0 {
                break;
            }
            search.follow(image, size / before);
            before = size;
            self.image(search, image);
            let step = size / search.dot(image);
            change.add(search, step);
            rest.add(image, -step);
        }
        // By the forces at the end, so that what one loses another gains to the last digit.
        for (end, velocity) in change.particles.iter_mut().zip(&*velocities) {
            *end = [velocity[0] + end[0], velocity[1] + end[1]];
        }
        let twist = |k: usize| {
            let mut twist = wet[k].twist;
            twist += change.bodies[k];
            twist
        };
        self.forces(&change.particles, &twist, rest);
        for ((velocity, given), density) in
            velocities.iter_mut().zip(&rest.particles).zip(self.density)
        {
            let mass = density * self.area;
            *velocity = [velocity[0] + given[0] / mass, velocity[1] + given[1] / mass];
        }
        impulses.iter_mut().zip(&rest.bodies).for_each(|(impulse, given)| *impulse += *given);
        *scaled = change;
    }

    /// h Σ 2μ V (−W′/r)(u_j − u_i) of particles and what bodies add, over the area; on bodies as impulses.
    fn forces(&self, velocities: &[Pair], twist: &dyn Fn(usize) -> Twist, out: &mut Motion) {
        let factor = 2.0 * self.h * lattice().shear;
        let (x, viscosity) = (self.positions, self.viscosity);
        let give = |i: usize, j: usize, _: Real, slope: Pair| {
            let way = x[i] - x[j];
            let square = way.norm_squared();
            if square == 0.0 {
                return [0.0; 2];
            }
            // Of two viscosities the harmonic mean: the stress is the same on both sides.
            let sum = viscosity[i] + viscosity[j];
            let mean = if sum > 0.0 { 2.0 * viscosity[i] * viscosity[j] / sum } else { 0.0 };
            let mean = mean + self.stiff[i].max(self.stiff[j]);
            let pull = -factor * mean * (slope[0] * way.x + slope[1] * way.y) / square;
            [
                pull * (velocities[j][0] - velocities[i][0]),
                pull * (velocities[j][1] - velocities[i][1]),
            ]
        };
        self.pairs.exchange(&give, &mut out.particles, self.team);
        out.bodies.fill(Twist::ZERO);
        for touch in &self.touches.list {
            let i = touch.particle as usize;
            let pull = self.h * viscosity[i] * touch.friction;
            let at = twist(touch.wet as usize).at(touch.arm);
            let force = Vec2::new(at.x - velocities[i][0], at.y - velocities[i][1]) * pull;
            out.particles[i] = [out.particles[i][0] + force.x, out.particles[i][1] + force.y];
            out.bodies[touch.wet as usize] += moment(touch.arm, force * -self.area);
        }
        let scale = self.area;
        out.particles.iter_mut().for_each(|force| *force = [force[0] * scale, force[1] * scale]);
    }

    /// (M − h L) of a motion.
    fn image(&self, motion: &Motion, out: &mut Motion) {
        let twist = |k: usize| motion.bodies[k];
        self.forces(&motion.particles, &twist, out);
        for ((out, own), density) in
            out.particles.iter_mut().zip(&motion.particles).zip(self.density)
        {
            let mass = density * self.area;
            *out = [mass * own[0] - out[0], mass * own[1] - out[1]];
        }
        for ((out, own), wet) in out.bodies.iter_mut().zip(&motion.bodies).zip(&self.touches.wet) {
            let inertia = inertia(wet);
            let linear = Vec2::new(inertia[0] * own.linear.x, inertia[1] * own.linear.y);
            *out = Twist::new(linear - out.linear, inertia[2] * own.angular - out.angular);
            hold(out, &inertia);
        }
    }

    /// A motion over the diagonal.
    fn scale(
        &self,
        rest: &mut Motion,
        (diagonal, bodies): (&[Real], &[[Real; 3]]),
        out: &mut Motion,
    ) {
        for ((out, rest), diagonal) in out.particles.iter_mut().zip(&rest.particles).zip(diagonal) {
            *out = [rest[0] / diagonal, rest[1] / diagonal];
        }
        let each = out.bodies.iter_mut().zip(&mut rest.bodies).zip(bodies).zip(&self.touches.wet);
        for (((out, rest), [x, y, turn]), wet) in each {
            hold(rest, &inertia(wet));
            *out = Twist::new(Vec2::new(rest.linear.x / x, rest.linear.y / y), rest.angular / turn);
        }
    }

    /// The diagonal of M − h L.
    fn measure(&self, diagonal: &mut Vec<Real>, bodies: &mut Vec<[Real; 3]>) {
        diagonal.clear();
        let braked = self.viscosity.iter().zip(self.stiff).map(|(own, more)| own + more);
        diagonal.extend(self.density.iter().zip(braked).map(|(density, viscosity)| {
            // Of the neighbours what they are on a lattice: close enough to scale by.
            self.area * density + self.h * viscosity * LATTICE
        }));
        bodies.clear();
        bodies.extend(
            self.touches.wet.iter().map(|wet| inertia(wet).map(|m| if m > 0.0 { m } else { 1.0 })),
        );
        for touch in &self.touches.list {
            let i = touch.particle as usize;
            let pull = self.h * self.viscosity[i] * touch.friction * self.area;
            diagonal[i] += pull;
            let body = &mut bodies[touch.wet as usize];
            *body = [body[0] + pull, body[1] + pull, body[2] + pull * touch.arm.norm_squared()];
        }
    }
}

/// Σ 2 V (−W′/r) V on a lattice, of which the four nearest and the four next neighbours are part.
const LATTICE: Real = 3.4;

/// m, m and I; 0 where nothing moves.
fn inertia(wet: &Wet) -> [Real; 3] {
    let of = |inverse: Real| if inverse > 0.0 { 1.0 / inverse } else { 0.0 };
    [of(wet.inverse_mass.x), of(wet.inverse_mass.y), of(wet.inverse_inertia)]
}

/// Leaves nothing along what does not move.
fn hold(twist: &mut Twist, inertia: &[Real; 3]) {
    let keep = |x: Real, m: Real| if m > 0.0 { x } else { 0.0 };
    twist.linear = Vec2::new(keep(twist.linear.x, inertia[0]), keep(twist.linear.y, inertia[1]));
    twist.angular = keep(twist.angular, inertia[2]);
}
