//! Rotation: decay, free spin, and a torque that varies in time.

use super::{Answer, Check, Column, Judged, Motion, Reference, Scene, Toleranced, weightless};
use crate::body::BodyDef;
use crate::error::Result;
use crate::forces::Oscillating;
use crate::math::{Pose, Real, Vec2, exp_m1, sin_cos, vec2};
use crate::shapes::Shape;
use crate::world::World;

/// A disk of radius 0.5 m that spins.
fn disk(spin: Real, damping: Real) -> Result<World> {
    let mut world = weightless()?;
    world.add_body(BodyDef {
        angular_velocity: spin,
        angular_damping: damping,
        ..BodyDef::new(Shape::circle(0.5)?)
    })?;
    Ok(world)
}

fn turned(angle: Real) -> Vec<Pose> {
    vec![Pose::new(Vec2::zeros(), angle)]
}

pub static SPIN_DECAY: Scene = Scene {
    id: "S6",
    name: "spin_decay",
    title: "A spin that decays at a rate c",
    about: "ω = ω₀e^(−ct), θ = ω₀(1 − e^(−ct))/c, with ω₀ = 10 rad/s, c = 0.8/s.",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: || disk(10.0, 0.8),
        exact: |t| turned(-10.0 * exp_m1(-0.8 * t) / 0.8),
        duration: 5.0,
        dt: 1.0 / 60.0,
        length: 0.5 * 12.5,
        fixed: 1e-12,
        toleranced: Some(Toleranced { tolerance: 1e-9, error: 1e-13 }),
        judged: Judged::AllMethods,
    }),
    checks: &[Check {
        what: "angular velocity at t = 5 against ω₀e^(−ct)",
        column: Column::Fixed,
        asked: 1e-12,
        measure: || {
            let mut world = disk(10.0, 0.8)?;
            world.steps(1.0 / 60.0, 300)?;
            Ok((world.bodies().twists[0].angular / (10.0 * crate::math::exp(-4.0)) - 1.0).abs())
        },
    }],
};

pub static FREE_SPIN: Scene = Scene {
    id: "S13",
    name: "free_spin",
    title: "A free spin of 10⁴ rad/s for 10 s",
    about: "θ = 10⁵ rad; the rotation stays of unit length. Errors are relative to θ.",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: || disk(1e4, 0.0),
        exact: |t| turned(1e4 * t),
        duration: 10.0,
        dt: 1.0 / 60.0,
        length: 0.5 * 1e5,
        fixed: 1e-12,
        toleranced: Some(Toleranced { tolerance: 1e-9, error: 1e-12 }),
        judged: Judged::AllMethods,
    }),
    checks: &[Check {
        what: "length of the rotation against 1",
        column: Column::Fixed,
        asked: 1e-12,
        measure: || {
            let mut world = disk(1e4, 0.0)?;
            world.steps(1.0 / 60.0, 600)?;
            let rot = world.bodies().poses[0].rot();
            Ok((libm::hypot(rot.cos, rot.sin) - 1.0).abs())
        },
    }],
};

/// Amplitude (N·m) and angular frequency (rad/s) of the torque; inertia of a point (kg·m²).
const TORQUE: Real = 3.0;
const HERTZ: Real = 0.7;
const INERTIA: Real = 0.5;
const PHASE: Real = 0.4;

pub static VARYING_TORQUE: Scene = Scene {
    id: "N3",
    name: "varying_torque",
    title: "A torque that varies in time, τ₀ sin(Ωt + φ)",
    about: "θ = (τ₀/I)·[cos φ·t/Ω + (sin φ − sin(Ωt + φ))/Ω²].",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: || {
            let mut world = weightless()?;
            let body = world.add_body(BodyDef {
                inertia: Some(INERTIA),
                ..BodyDef::new(Shape::circle(0.5)?)
            })?;
            let force = vec2(0.0, 0.0);
            world.add_field(Oscillating {
                body,
                force,
                torque: TORQUE,
                hertz: HERTZ,
                phase: PHASE,
            });
            Ok(world)
        },
        exact: |t| {
            let rate = std::f64::consts::TAU * HERTZ;
            let ((sin0, cos0), (sin, _)) = (sin_cos(PHASE), sin_cos(rate * t + PHASE));
            turned(TORQUE / INERTIA * (cos0 * t / rate + (sin0 - sin) / (rate * rate)))
        },
        duration: 2.0,
        dt: 1.0 / 60.0,
        length: 0.5,
        fixed: 1e-3,
        toleranced: Some(Toleranced { tolerance: 1e-10, error: 1e-9 }),
        judged: Judged::AllMethods,
    }),
    checks: &[],
};
