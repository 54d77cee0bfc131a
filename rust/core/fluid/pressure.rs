//! Pressure: the smallest impulses that let nothing be compressed, bodies included.
//!
//! c_i = Σ V W_ij + Σ_B ∫_B W dA is the part of particle i's kernel that is filled, ċ = D u its rate. Pressures act by the
//! transpose: a = −(1/ρ) V Dᵀp on particles, M⁻¹ V Dᵀp on bodies. With K = V D M⁻¹ Dᵀ, positive semidefinite,
//!
//! r = K p − b ≥ 0, p ≥ 0, r·p = 0,
//!
//! where b h² is how far the parts would be above what is allowed at the end of the substep. Solved by conjugate
//! gradients on the free set, with projections (MPRGP: Dostál and Schöberl, "Minimizing quadratic functions subject to
//! bound constraints", 2005), scaled by the diagonal.

use super::pairs::{Pair, Pairs};
use super::solid::{Touch, Touches, Wet, moment};
use super::team::Team;
use crate::math::{Real, Twist, Vec2};

/// What acts between particles and bodies in a substep.
pub struct Coupling<'a> {
    /// Pairs of particles.
    pub pairs: &'a Pairs,
    /// Bodies near particles.
    pub touches: &'a Touches,
    /// 1/ρ of each particle (m²/kg).
    pub inverse_density: &'a [Real],
    /// Diagonal of K; 0 where nothing presses.
    pub diagonal: &'a [Real],
    /// Area of a particle (m²).
    pub area: Real,
    /// Threads.
    pub team: &'a Team,
}

/// What may be left, and how long to try.
#[derive(Clone, Copy, Debug)]
pub struct Goal {
    /// Mean of |r| h² over the particles: of their densities, what may be wrong.
    pub tolerance: Real,
    /// Length of the substep (s).
    pub h: Real,
    /// Most applications of K.
    pub most: u32,
}

/// What a solution took.
#[derive(Clone, Copy, Debug, Default)]
pub struct Effort {
    /// Applications of K.
    pub iterations: u32,
    /// Mean of |r| h² at the end.
    pub residual: Real,
}

/// Columns that pressures are found in.
#[derive(Clone, Debug, Default)]
pub struct Columns {
    /// Accelerations by the pressures last applied, against them (m/s²).
    pub against: Vec<Pair>,
    /// Impulses over h that they give the bodies, against them.
    pub loads: Vec<Twist>,
    gradient: Vec<Real>,
    search: Vec<Real>,
    image: Vec<Real>,
}

impl Coupling<'_> {
    /// Accelerations and loads, both reversed, that pressures give.
    pub fn act(&self, pressures: &[Real], against: &mut [Pair], loads: &mut Vec<Twist>) {
        self.pairs.push(pressures, against, self.team);
        loads.clear();
        loads.resize(self.touches.wet.len(), Twist::ZERO);
        for touch in &self.touches.list {
            let i = touch.particle as usize;
            let push = touch.slope * pressures[i];
            against[i] = [against[i][0] + push.x, against[i][1] + push.y];
            // Reversed: what presses the particle out presses the body in.
            loads[touch.wet as usize] += moment(touch.arm, push * -self.area);
        }
        for (against, inverse) in against.iter_mut().zip(self.inverse_density) {
            *against = [against[0] * inverse, against[1] * inverse];
        }
    }

    /// Rates at which the parts are filled by these velocities of particles and of bodies.
    pub fn converge(&self, velocities: &[Pair], twist: &dyn Fn(usize) -> Twist, out: &mut [Real]) {
        self.pairs.converge(velocities, out, self.team);
        for touch in &self.touches.list {
            let i = touch.particle as usize;
            out[i] += rate(touch, velocities[i], &twist(touch.wet as usize));
        }
    }

    /// K p.
    fn apply(
        &self,
        pressures: &[Real],
        (against, loads): (&mut Vec<Pair>, &mut Vec<Twist>),
        out: &mut [Real],
    ) {
        self.act(pressures, against, loads);
        let wet = &self.touches.wet;
        self.converge(against, &|k| wet[k].response(&loads[k]), out);
    }

    /// Solves for p ≥ 0, from p; `allowed` is b.
    pub fn solve(&self, p: &mut [Real], b: &[Real], goal: Goal, columns: &mut Columns) -> Effort {
        let Columns { against, loads, gradient: g, search: q, image } = columns;
        let n = p.len();
        [&mut *g, &mut *q, &mut *image].into_iter().for_each(|column| column.resize(n, 0.0));
        against.resize(n, [0.0; 2]);
        let d = self.diagonal;
        p.iter_mut().zip(d).filter(|(_, d)| **d == 0.0).for_each(|(p, _)| *p = 0.0);
        self.apply(p, (against, loads), image);
        for ((g, image), b) in g.iter_mut().zip(&*image).zip(b) {
            *g = image - b;
        }
        let mut effort = Effort { iterations: 1, residual: 0.0 };
        let mut fresh = true;
        loop {
            let state = measure(p, g, d);
            effort.residual = state.wrong * goal.h * goal.h / n as Real;
            if effort.residual <= goal.tolerance || effort.iterations >= goal.most {
                break;
            }
            if state.bound > state.free {
                // Proportioning: along the gradient of those that should leave the bound.
                for (((q, p), g), d) in q.iter_mut().zip(&*p).zip(&*g).zip(d) {
                    *q = if *p == 0.0 && *d > 0.0 { g.min(0.0) / d } else { 0.0 };
                }
                fresh = false;
            } else if fresh {
                restart(q, p, g, d);
                fresh = false;
            }
            self.apply(q, (against, loads), image);
            effort.iterations += 1;
            let (along, curve) = dots(g, q, image);
            if curve.is_nan() || curve <= FLAT * size(q, d) {
                break;
            }
            let step = along / curve;
            if state.bound > state.free {
                advance(p, g, (q, image), step);
                fresh = true;
            } else if reach(p, q) >= step {
                advance(p, g, (q, image), step);
                turn(q, (p, g), (image, d), curve);
            } else {
                // Beyond a bound: the step is projected, and the gradient is computed anew.
                for (p, q) in p.iter_mut().zip(&*q) {
                    *p = (*p - step * q).max(0.0);
                }
                self.apply(p, (against, loads), image);
                effort.iterations += 1;
                for ((g, image), b) in g.iter_mut().zip(&*image).zip(b) {
                    *g = image - b;
                }
                fresh = true;
            }
        }
        self.act(p, against, loads);
        effort
    }
}

/// Rate at which a body's part at a particle grows.
fn rate(touch: &Touch, velocity: Pair, twist: &Twist) -> Real {
    let relative = Vec2::new(velocity[0], velocity[1]) - twist.at(touch.arm);
    touch.slope.dot(&relative)
}

/// Diagonal of K.
pub fn diagonal(
    (touches, wet): (&[Touch], &[Wet]),
    around: &mut [super::pairs::Around],
    (inverse_density, area): (&[Real], Real),
    out: &mut Vec<Real>,
) {
    for touch in touches {
        let around = &mut around[touch.particle as usize];
        around.part += touch.part;
        around.slope = [around.slope[0] + touch.slope.x, around.slope[1] + touch.slope.y];
        let own = moment(touch.arm, touch.slope);
        let response = wet[touch.wet as usize].response(&own);
        let body = response.linear.dot(&own.linear) + response.angular * own.angular;
        around.square += area * body;
    }
    out.clear();
    out.extend(around.iter().zip(inverse_density).map(|(around, inverse)| {
        let [x, y] = around.slope;
        around.square + (x * x + y * y) * inverse
    }));
}

/// What is wrong with a state.
struct State {
    /// Σ |r| of the free, and of the bound that should not be.
    wrong: Real,
    /// Σ φ²/d of the free.
    free: Real,
    /// Σ β²/d of the bound that should not be.
    bound: Real,
}

fn measure(p: &[Real], g: &[Real], d: &[Real]) -> State {
    let mut state = State { wrong: 0.0, free: 0.0, bound: 0.0 };
    for ((p, g), d) in p.iter().zip(g).zip(d) {
        if *d <= 0.0 {
            continue;
        }
        let free = *p > 0.0;
        let own = if free { *g } else { g.min(0.0) };
        state.wrong += own.abs();
        let square = own * own / d;
        if free {
            // What projection would take away counts only as far as it would go.
            state.free += if own > 0.0 { own.min(*p * d / STEP) * own / d } else { square };
        } else {
            state.bound += square;
        }
    }
    state
}

/// Length of projected steps, in units of the diagonal: below 2 over the largest eigenvalue, 2.3 on a lattice.
const STEP: Real = 0.5;

fn restart(q: &mut [Real], p: &[Real], g: &[Real], d: &[Real]) {
    for (((q, p), g), d) in q.iter_mut().zip(p).zip(g).zip(d) {
        *q = if *p > 0.0 && *d > 0.0 { g / d } else { 0.0 };
    }
}

/// Curvature, over that of the diagonal, below which a direction presses on nothing: where there is no free surface, the same
/// pressure everywhere. The smoothest of n rows have 2/n².
const FLAT: Real = 1e-10;

/// q·D q.
fn size(q: &[Real], d: &[Real]) -> Real {
    q.iter().zip(d).map(|(q, d)| q * q * d).sum()
}

fn dots(g: &[Real], q: &[Real], image: &[Real]) -> (Real, Real) {
    let products = g.iter().zip(q).zip(image).map(|((g, q), image)| (g * q, q * image));
    products.fold((0.0, 0.0), |sum, own| (sum.0 + own.0, sum.1 + own.1))
}

/// How far one can go along −q.
fn reach(p: &[Real], q: &[Real]) -> Real {
    let ways = p.iter().zip(q).filter(|(_, q)| **q > 0.0).map(|(p, q)| p / q);
    ways.fold(Real::INFINITY, Real::min)
}

fn advance(p: &mut [Real], g: &mut [Real], (q, image): (&[Real], &[Real]), step: Real) {
    for (((p, g), q), image) in p.iter_mut().zip(g).zip(q).zip(image) {
        *p = (*p - step * q).max(0.0);
        *g -= step * image;
    }
}

/// The next direction, conjugate to the last: q = z − (z·Kq)/(q·Kq) q, z = φ/d.
fn turn(q: &mut [Real], (p, g): (&[Real], &[Real]), (image, d): (&[Real], &[Real]), curve: Real) {
    let scaled =
        |((p, g), d): ((&Real, &Real), &Real)| if *p > 0.0 && *d > 0.0 { g / d } else { 0.0 };
    let along: Real =
        p.iter().zip(g).zip(d).map(scaled).zip(image).map(|(z, image)| z * image).sum();
    let back = along / curve;
    for (((q, p), g), d) in q.iter_mut().zip(p).zip(g).zip(d) {
        *q = if *p > 0.0 && *d > 0.0 { g / d - back * *q } else { 0.0 };
    }
}
