//! Viscous flows with a known profile: between plates, and vortices that decay.

use super::{WATER, between, number};
use crate::body::{BodyDef, BodyKind};
use crate::error::Result;
use crate::fluid::{Material, lattice_in};
use crate::math::{PI, Real, exp, sin_cos, vec2};
use crate::scenes::{Answer, Number, Reference, Scene};
use crate::world::World;

/// Between the plates (m).
const GAP: Real = 1.0;
const ROWS: Real = 40.0;
/// Kinematic viscosity (m²/s): momentum crosses the gap in a second.
const NU: Real = 1.0;
/// Largest speed of the steady flows (m/s).
const SPEED: Real = 0.5;
/// Length of the slug between the plates (m).
const LENGTH: Real = 3.0;

/// Fluid at rest between two plates, the upper of which moves, in this gravity along them (m/s²).
fn channel(gravity: Real, moved: Real) -> Result<World> {
    let mut world = World::new(vec2(gravity, 0.0))?;
    for (low, speed) in [(-0.25, 0.0), (GAP, moved)] {
        let plate = between(vec2(-1.0, low), vec2(LENGTH + 1.0, low + 0.25))?;
        let velocity = vec2(speed, 0.0);
        world.add_body(BodyDef { kind: BodyKind::Kinematic, velocity, ..BodyDef::new(plate) })?;
    }
    let points = lattice_in(&between(vec2(0.0, 0.0), vec2(LENGTH, GAP))?, GAP / ROWS)?;
    let material = Material { density: WATER, viscosity: NU * WATER, ..Material::default() };
    world.add_fluid(&points, GAP / ROWS, material)?;
    Ok(world)
}

/// Greatest difference of a profile u(y, t) from the mean velocities of 20 layers in the middle of the slug, and its mean
/// square's root over the particles there, over the largest speed of the profile.
fn errors(world: &World, profile: impl Fn(Real, Real) -> Real) -> (Real, Real) {
    const LAYERS: usize = 20;
    let particles = &world.fluids().particles;
    let middle = world.center_of_mass().x;
    let mut layers = [(0.0, 0.0); LAYERS];
    let (mut square, mut count, mut largest): (Real, Real, Real) = (0.0, 0.0, 0.0);
    for (place, velocity) in particles.positions.iter().zip(&particles.velocities) {
        if (place.x - middle).abs() > 0.25 * LENGTH {
            continue;
        }
        let exact = profile(place.y / GAP, world.time());
        let off = velocity.x - exact;
        let layer = &mut layers[((place.y / GAP * LAYERS as Real) as usize).min(LAYERS - 1)];
        *layer = (layer.0 + off, layer.1 + 1.0);
        (square, count) = (square + off * off + velocity.y * velocity.y, count + 1.0);
        largest = largest.max(exact.abs());
    }
    let worst = layers.iter().map(|(off, count)| (off / count).abs()).fold(0.0, Real::max);
    (worst / largest, (square / count).sqrt() / largest)
}

/// Runs the channel to these times (s), and judges the profile at each.
fn profiles(world: &mut World, profile: fn(Real, Real) -> Real) -> Result<Vec<Number>> {
    let mut numbers = Vec::new();
    for (time, steps) in [(0.1, 15), (0.6, 15)] {
        world.steps((time - world.time()) / Real::from(steps), steps)?;
        let (worst, mean) = errors(world, profile);
        numbers.push(number(format!("worst layer at {time} s over the speed"), worst, 0.0, 0.02));
        numbers.push(number(format!("mean error at {time} s over the speed"), mean, 0.0, 0.02));
    }
    Ok(numbers)
}

/// Σ over n of `amplitude`(n) sin(nπy) e^(−n²π²νt/h²).
fn modes(y: Real, t: Real, amplitude: impl Fn(Real) -> Real) -> Real {
    let each = (1..60).map(|n| {
        let k = Real::from(n) * PI;
        amplitude(Real::from(n)) * sin_cos(k * y).0 * exp(-k * k * NU * t / (GAP * GAP))
    });
    each.sum()
}

pub static POISEUILLE: Scene = Scene {
    id: "W9",
    name: "poiseuille",
    title: "Fluid between two plates begins to flow by its weight along them",
    about: "40 rows. u = U (4y(h − y)/h² − Σ 32/(n³π³) sin(nπy/h) e^(−n²π²νt/h²)) over odd n, U = gh²/(8ν), at Uh/ν = 0.5; the \
            fluid is a slug with free ends, and is judged in its middle half, before and after it is steady.",
    reference: Reference::ClosedForm,
    answer: Answer::Numbers(poiseuille),
    checks: &[],
};

fn poiseuille() -> Result<Vec<Number>> {
    let mut world = channel(8.0 * NU * SPEED / (GAP * GAP), 0.0)?;
    profiles(&mut world, |y, t| {
        let odd = |n: Real| if n % 2.0 == 1.0 { 32.0 / (n * PI).powi(3) } else { 0.0 };
        SPEED * (4.0 * y * (1.0 - y) - modes(y, t, odd))
    })
}

pub static COUETTE: Scene = Scene {
    id: "W9b",
    name: "couette",
    title: "Fluid between two plates, one of which moves",
    about: "40 rows. u = U (y/h + Σ 2(−1)ⁿ/(nπ) sin(nπy/h) e^(−n²π²νt/h²)), at Uh/ν = 0.5; judged as the flow by weight.",
    reference: Reference::ClosedForm,
    answer: Answer::Numbers(couette),
    checks: &[],
};

fn couette() -> Result<Vec<Number>> {
    let mut world = channel(0.0, SPEED)?;
    profiles(&mut world, |y, t| {
        let sign = |n: Real| if n % 2.0 == 1.0 { -1.0 } else { 1.0 };
        SPEED * (y + modes(y, t, |n| 2.0 * sign(n) / (n * PI)))
    })
}
