//! Newton's second law with forces that are constant, and constant between given times.

use super::{Answer, Check, Column, Judged, Motion, Reference, Scene, Toleranced, at, weightless};
use crate::body::BodyDef;
use crate::error::Result;
use crate::forces::ForceSchedule;
use crate::math::{Pose, Real, Wrench, vec2};
use crate::shapes::Shape;
use crate::world::World;

pub static PROJECTILE: Scene = Scene {
    id: "S1",
    name: "projectile",
    title: "A ball thrown from 1.5 m at (12, 9) m/s",
    about: "x = x₀ + v₀t + ½gt². At t = 2: (24, −0.12).",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: || {
            let mut world = World::new(vec2(0.0, -G))?;
            world.add_body(BodyDef {
                position: vec2(0.0, 1.5),
                velocity: vec2(12.0, 9.0),
                ..BodyDef::new(Shape::circle(0.1)?)
            })?;
            Ok(world)
        },
        exact: |t| vec![at(12.0 * t, 1.5 + 9.0 * t - 0.5 * G * t * t)],
        duration: 2.0,
        dt: 1.0 / 60.0,
        length: 24.0,
        fixed: 1e-12,
        toleranced: Some(Toleranced { tolerance: 1e-9, error: 1e-13 }),
        judged: Judged::AllMethods,
    }),
    checks: &[Check {
        what: "vertical velocity at t = 2 against −10.62 m/s",
        column: Column::Fixed,
        asked: 1e-12,
        measure: || {
            let Answer::Motion(motion) = PROJECTILE.answer else { return Ok(Real::INFINITY) };
            let mut world = (motion.build)()?;
            world.steps(motion.dt, 120)?;
            Ok((world.bodies().twists[0].linear.y / -10.62 - 1.0).abs())
        },
    }],
};

const G: Real = 9.81;
/// Force (N), torque (N·m) and the body they act on: a box of 2 × 1 m, 3 kg.
const FORCE: Wrench = Wrench::new(vec2(4.0, -7.0), 2.5);
const MASS: Real = 3.0;
const INERTIA: Real = MASS * (2.0 * 2.0 + 1.0 * 1.0) / 12.0;

fn constant_force() -> Result<World> {
    let mut world = weightless()?;
    world.add_body(BodyDef {
        mass: Some(MASS),
        force: FORCE.force,
        torque: FORCE.torque,
        ..BodyDef::new(Shape::rectangle(2.0, 1.0)?)
    })?;
    Ok(world)
}

fn under_constant_force(t: Real) -> Pose {
    let half = 0.5 * t * t;
    Pose::new(FORCE.force * (half / MASS), FORCE.torque * half / INERTIA)
}

pub static CONSTANT_FORCE: Scene = Scene {
    id: "S2",
    name: "constant_force",
    title: "A box under a constant force and torque, any step up to half a second",
    about: "x = ½Ft²/m, θ = ½τt²/I.",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: constant_force,
        exact: |t| vec![under_constant_force(t)],
        duration: 4.0,
        dt: 0.5,
        length: 20.0,
        fixed: 1e-12,
        toleranced: Some(Toleranced { tolerance: 1e-9, error: 1e-13 }),
        judged: Judged::AllMethods,
    }),
    checks: &[Check {
        what: "largest error over steps from 1e-4 to 0.5 s",
        column: Column::Fixed,
        asked: 1e-12,
        measure: || {
            let mut worst: Real = 0.0;
            for (dt, steps) in [(0.5, 8), (0.3, 13), (0.1, 40), (1.0 / 60.0, 240), (1e-4, 40_000)] {
                let mut world = constant_force()?;
                world.steps(dt, steps)?;
                let (pose, exact) = (world.bodies().poses[0], under_constant_force(world.time()));
                let apart = (pose.position - exact.position).norm() / exact.position.norm();
                worst = worst.max(apart).max((pose.angle / exact.angle - 1.0).abs());
            }
            Ok(worst)
        },
    }],
};

/// Times of change (s) that no step of 1/60 s hits, and the forces (N) between them on 2 kg.
const TIMES: [Real; 4] = [0.105, 0.77, 1.3, 2.4];
const FORCES: [(Real, Real); 3] = [(6.0, 0.0), (-2.0, 5.0), (0.0, -8.0)];

pub static SCHEDULED_FORCE: Scene = Scene {
    id: "N2",
    name: "scheduled_force",
    title: "A force that is constant between given times",
    about: "x(t) = Σ Fᵢ/m·(½s² + s·(t − end of piece i)), s the time that piece i has acted.",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: || {
            let mut world = weightless()?;
            let body = world.add_body(BodyDef::point(2.0))?;
            let wrenches = FORCES.map(|(x, y)| Wrench::new(vec2(x, y), 0.0)).to_vec();
            world.add_schedule(body, ForceSchedule::new(TIMES.to_vec(), wrenches)?)?;
            Ok(world)
        },
        exact: |t| {
            let mut position = vec2(0.0, 0.0);
            for (i, force) in FORCES.iter().enumerate() {
                let acted = (t.min(TIMES[i + 1]) - TIMES[i]).max(0.0);
                let after = (t - TIMES[i + 1]).max(0.0);
                position += vec2(force.0, force.1) * ((0.5 * acted * acted + acted * after) / 2.0);
            }
            vec![Pose::new(position, 0.0)]
        },
        duration: 3.0,
        dt: 1.0 / 60.0,
        length: 5.0,
        fixed: 1e-12,
        toleranced: Some(Toleranced { tolerance: 1e-9, error: 1e-12 }),
        judged: Judged::AllMethods,
    }),
    checks: &[],
};
