//! Balls in bowls.

use crate::body::{BodyDef, BodyKind};
use crate::error::Result;
use crate::math::{Pose, Real, sin_cos, vec2};
use crate::scenes::stage::{DT, G, at_fixed_step, heavy, rough, standing};
use crate::scenes::{Answer, Judged, Motion, Reference, Scene, Toleranced, at};
use crate::shapes::Shape;
use crate::world::World;

/// Radii of bowl and ball, of the path of the ball's centre, and the distance between two bowls (m).
const BOWL_RADIUS: Real = 1.0;
const BALL: Real = 0.1;
const PATH: Real = BOWL_RADIUS - BALL;
const APART: Real = 10.0;
/// Friction of the two bowls: one smooth, in the other the ball rolls; and what of gravity moves the ball.
const BOWLS: [(Real, Real); 2] = [(0.0, 1.0), (1.0, 2.0 / 3.0)];
/// Angle from the lowest point at which the balls are let go (rad), and where frequencies are measured.
const START: Real = 0.5;
const SMALL: Real = 0.02;

/// Where a ball of the k-th bowl is at an angle, having started at another.
fn ball(k: usize, angle: Real, start: Real) -> Pose {
    let (sin, cos) = sin_cos(angle);
    let rolls = if BOWLS[k].0 > 0.0 { -PATH / BALL } else { 0.0 };
    Pose::new(vec2(APART * k as Real + PATH * sin, -PATH * cos), rolls * (angle - start))
}

fn bowls(start: Real) -> Result<World> {
    use std::f64::consts::PI;
    let mut world = heavy()?;
    for (k, (friction, _)) in BOWLS.into_iter().enumerate() {
        let center = vec2(APART * k as Real, 0.0);
        world.add_body(BodyDef {
            kind: BodyKind::Static,
            position: center,
            surface: rough(friction),
            ..BodyDef::new(Shape::arc(vec2(0.0, 0.0), BOWL_RADIUS, -PI, PI)?)
        })?;
        let place = ball(k, start, start);
        world.add_body(standing(Shape::circle(BALL)?, place, rough(friction)))?;
    }
    Ok(world)
}

/// Angle of a pendulum ü = −ω² sin u let go at rest: sin(u/2) = k·cd(ωt, k), k = sin(u₀/2) (Abramowitz and
/// Stegun, 16.4, for the elliptic functions).
fn pendulum(start: Real, rate: Real, t: Real) -> Real {
    let (k, cos) = sin_cos(0.5 * start);
    let (mut means, mut ratios) = ((1.0, cos), Vec::new());
    for _ in 0..8 {
        let (a, b): (Real, Real) = means;
        means = (0.5 * (a + b), libm::sqrt(a * b));
        ratios.push(0.5 * (a - b) / means.0);
    }
    let mut phase = 256.0 * means.0 * rate * t;
    for ratio in ratios.iter().rev() {
        phase = 0.5 * (phase + libm::asin(ratio * libm::sin(phase)));
    }
    let (sn, cn) = sin_cos(phase);
    2.0 * libm::asin(k * cn / libm::sqrt(1.0 - k * k * sn * sn))
}

/// ω of small swings in the k-th bowl (rad/s).
fn rate(k: usize) -> Real {
    libm::sqrt(BOWLS[k].1 * G / PATH)
}

/// Frequency of the k-th ball over 20 s of small swings, from where it passes the lowest point.
fn measured_rate(k: usize) -> Result<Real> {
    let mut world = bowls(SMALL)?;
    let place = |world: &World| world.bodies().poses[2 * k + 1].position.x - APART * k as Real;
    let (mut passes, mut before) = (Vec::new(), place(&world));
    for _ in 0..1200 {
        let time = world.time();
        world.step(DT)?;
        let now = place(&world);
        if before.signum() != now.signum() {
            passes.push(time + DT * before / (before - now));
        }
        before = now;
    }
    let (Some(first), Some(last)) = (passes.first(), passes.last()) else { return Ok(0.0) };
    Ok(std::f64::consts::PI * (passes.len() as Real - 1.0) / (last - first))
}

pub static BOWL: Scene = Scene {
    id: "F18",
    name: "bowl",
    title: "A ball in a bowl, smooth and rolling",
    about: "A pendulum of length R − r; of small swings ω = √(g/(R − r)) where it is smooth, √(2g/3(R − r)) where the ball rolls. Nothing is lost.",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: || bowls(START),
        exact: |t| {
            let angle = |k: usize| pendulum(START, rate(k), t);
            let ball = |k: usize| ball(k, angle(k), START);
            vec![at(0.0, 0.0), ball(0), at(APART, 0.0), ball(1)]
        },
        duration: 20.0,
        dt: DT,
        length: BOWL_RADIUS,
        fixed: 1e-2,
        toleranced: Some(Toleranced { tolerance: 1e-9, error: 1e-3 }),
        judged: Judged::Contact { order: true },
    }),
    checks: &[
        at_fixed_step("frequency of the smooth ball, relative", 1e-2, || {
            Ok((measured_rate(0)? / rate(0) - 1.0).abs())
        }),
        at_fixed_step("frequency of the rolling ball, relative", 1e-2, || {
            Ok((measured_rate(1)? / rate(1) - 1.0).abs())
        }),
        at_fixed_step("change of the energy over 20 s, of that of the swing", 1e-3, || {
            let mut world = bowls(START)?;
            let swing = world.bodies().masses.iter().map(|mass| mass.mass).sum::<Real>()
                * G
                * PATH
                * (1.0 - libm::cos(START));
            let before = world.energy()?.total();
            let mut worst: Real = 0.0;
            for _ in 0..1200 {
                world.step(DT)?;
                worst = worst.max((world.energy()?.total() - before).abs() / swing);
            }
            Ok(worst)
        }),
    ],
};
