//! Central forces: Kepler's ellipse, and uniform circular motion.

use std::f64::consts::TAU;

use super::stage::with_tolerance;
use super::{Answer, Judged, Motion, Reference, Scene, Toleranced, at, weightless};
use crate::body::BodyDef;
use crate::error::Result;
use crate::forces::Central;
use crate::math::{Pose, Real, Vec2, sin_cos, vec2};
use crate::world::World;

/// Eccentricity of an ellipse with semi-axis a = 1 around μ = 1; the period is 2π.
const E: Real = 0.6;

fn kepler() -> Result<World> {
    let mut world = weightless()?;
    world.set_substeps(1)?;
    world.add_field(Central {
        center: Vec2::zeros(),
        strength: 1.0,
        exponent: -2.0,
        per_mass: true,
    });
    world.add_body(BodyDef {
        position: vec2(1.0 - E, 0.0),
        velocity: vec2(0.0, 2.0),
        ..BodyDef::point(1.0)
    })?;
    Ok(world)
}

/// Kepler's equation M = u − e sin u by Newton's iteration; x = cos u − e, y = √(1 − e²) sin u.
fn on_ellipse(t: Real) -> Pose {
    let turns = (t / TAU).round();
    let mean = t - turns * TAU;
    let mut u = mean + E * mean.signum() * 0.85;
    for _ in 0..30 {
        let (sin, cos) = sin_cos(u);
        u -= (u - E * sin - mean) / (1.0 - E * cos);
    }
    let (sin, cos) = sin_cos(u);
    at(cos - E, libm::sqrt(1.0 - E * E) * sin)
}

pub static KEPLER: Scene = Scene {
    id: "S12",
    name: "kepler",
    title: "Kepler's ellipse, e = 0.6, from the nearest point, as a force field",
    about: "Kepler's equation t = u − e sin u; period 2π. At t = 1: (−0.628948176827, 0.799664730970). The fixed step is a 500th of the period.",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: kepler,
        exact: |t| vec![on_ellipse(t)],
        duration: TAU,
        dt: TAU / 500.0,
        length: 1.0,
        fixed: 1e-2,
        toleranced: Some(Toleranced { tolerance: 1e-12, error: 1e-10 }),
        judged: Judged::AllMethods,
    }),
    checks: &[
        with_tolerance(
            "position at t = 1 against (−0.628948176827, 0.799664730970)",
            1e-10,
            || {
                let mut world = kepler()?;
                world.advance(1.0, 1e-12)?;
                let exact = vec2(-0.628_948_176_827, 0.799_664_730_970);
                Ok((world.bodies().poses[0].position - exact).norm())
            },
        ),
        with_tolerance("energy over 1000 orbits", 1e-9, || {
            let mut world = kepler()?;
            let before = world.energy()?.balance();
            let mut worst: Real = 0.0;
            for _ in 0..1000 {
                world.advance(TAU, 1e-13)?;
                worst = worst.max((world.energy()?.balance() / before - 1.0).abs());
            }
            Ok(worst)
        }),
    ],
};

/// Radius (m), speed (m/s) and mass (kg) of the circle.
const RADIUS: Real = 2.0;
const SPEED: Real = 3.0;
const MASS: Real = 1.5;

pub static CIRCLE: Scene = Scene {
    id: "N1",
    name: "circular_motion",
    title: "Uniform circular motion under the centripetal force mv²/r",
    about: "(r cos ωt, r sin ωt), ω = v/r, where the force towards the centre is mv²/r.",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: || {
            let mut world = weightless()?;
            let strength = MASS * SPEED * SPEED / RADIUS;
            world.add_field(Central {
                center: Vec2::zeros(),
                strength,
                exponent: 0.0,
                per_mass: false,
            });
            world.add_body(BodyDef {
                position: vec2(RADIUS, 0.0),
                velocity: vec2(0.0, SPEED),
                ..BodyDef::point(MASS)
            })?;
            Ok(world)
        },
        exact: |t| {
            let (sin, cos) = sin_cos(SPEED / RADIUS * t);
            vec![at(RADIUS * cos, RADIUS * sin)]
        },
        duration: 5.0,
        dt: 1.0 / 60.0,
        length: RADIUS,
        fixed: 1e-3,
        toleranced: Some(Toleranced { tolerance: 1e-10, error: 1e-9 }),
        judged: Judged::AllMethods,
    }),
    checks: &[],
};
