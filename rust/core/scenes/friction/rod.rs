//! Rods on a floor.

use crate::body::{BodyDef, Surface};
use crate::error::Result;
use crate::math::{Pose, Real, atan2, sin_cos, vec2};
use crate::scenes::stage::{
    DT, G, TOLERANCE, add_ground, at_fixed_step, ground, heavy, rough, with_tolerance,
};
use crate::scenes::{Answer, Judged, Motion, Reference, Scene, Toleranced};
use crate::shapes::Shape;
use crate::world::World;

/// Adds a rod of 1 m that stands on the floor with its lower end, at an angle over the floor.
fn rod(angle: Real, surface: &Surface, speed: Real) -> Result<World> {
    let mut world = heavy()?;
    add_ground(&mut world, 0.0, surface.clone())?;
    let (sin, cos) = sin_cos(angle);
    world.add_body(BodyDef {
        position: vec2(0.5 * cos, 0.5 * sin),
        angle,
        velocity: vec2(speed, 0.0),
        surface: surface.clone(),
        ..BodyDef::new(Shape::segment(vec2(-0.5, 0.0), vec2(0.5, 0.0))?)
    })?;
    Ok(world)
}

/// Angle off the vertical of the falling rod at the start (rad).
const LEAN: Real = 0.1;
const UPRIGHT: Real = std::f64::consts::FRAC_PI_2;

/// Angular acceleration on a smooth floor at an angle off the vertical: (J + ¼ sin²)ü = ½g sin − ¼ sin cos u̇².
fn tilting(angle: Real, rate: Real) -> Real {
    let (sin, cos) = sin_cos(angle);
    sin * (0.5 * G - 0.25 * cos * rate * rate) / (1.0 / 12.0 + 0.25 * sin * sin)
}

/// Moves [angle, rate] on by t with 2000 steps of the classical Runge–Kutta method: to 1e-13 over the fall.
fn fall(state: [Real; 2], t: Real) -> [Real; 2] {
    fall_in(2000, state, t)
}

/// By how much the fall is off (rad, of 1 m the same in m): what is left of half the steps is 16 times as much, and rounding,
/// half a unit in the last place of each step.
fn fall_is_off() -> Real {
    let end = DT * Real::from(STEPS);
    let gap = fall([LEAN, 0.0], end)[0] - fall_in(1000, [LEAN, 0.0], end)[0];
    gap.abs() / 15.0 + 2000.0 * Real::EPSILON
}

fn fall_in(steps: u32, [mut angle, mut rate]: [Real; 2], t: Real) -> [Real; 2] {
    let h = t / Real::from(steps);
    for _ in 0..steps {
        let [a1, b1] = [rate, tilting(angle, rate)];
        let [a2, b2] = [rate + 0.5 * h * b1, tilting(angle + 0.5 * h * a1, rate + 0.5 * h * b1)];
        let [a3, b3] = [rate + 0.5 * h * b2, tilting(angle + 0.5 * h * a2, rate + 0.5 * h * b2)];
        let [a4, b4] = [rate + h * b3, tilting(angle + h * a3, rate + h * b3)];
        angle += h / 6.0 * (a1 + 2.0 * (a2 + a3) + a4);
        rate += h / 6.0 * (b1 + 2.0 * (b2 + b3) + b4);
    }
    [angle, rate]
}

/// Time from a state until the rod lies flat, and its rate then, by Newton's iteration.
fn flat(state: [Real; 2]) -> [Real; 2] {
    let mut time = (UPRIGHT - state[0]) / state[1];
    let mut rate = state[1];
    for _ in 0..20 {
        let now = fall(state, time);
        rate = now[1];
        time += (UPRIGHT - now[0]) / rate;
    }
    [time, rate]
}

/// Steps before the rod lies flat.
const STEPS: u32 = 35;

/// When the rod lies flat, and its rate then, from where the engine has it in the last step before.
fn end_of_fall() -> Result<[Real; 2]> {
    let mut world = rod(UPRIGHT - LEAN, &rough(0.0), 0.0)?;
    world.steps(DT, STEPS)?;
    let (pose, twist) = (world.bodies().poses[1], world.bodies().twists[1]);
    let [time, rate] = flat([UPRIGHT - pose.angle, -twist.angular]);
    Ok([world.time() + time, rate])
}

pub static FALLING_ROD: Scene = Scene {
    id: "F11",
    name: "falling_rod",
    title: "A rod falls on a smooth floor from 0.1 rad off the vertical",
    about: "Its centre falls straight down; (1/12 + ¼ sin² u)ü = ½(g/L) sin u − ¼ sin u cos u·u̇². Flat at 0.585947472819 s with 5.41137437109 rad/s.",
    reference: Reference::Integrated(fall_is_off),
    answer: Answer::Motion(Motion {
        build: || rod(UPRIGHT - LEAN, &rough(0.0), 0.0),
        exact: |t| {
            let [angle, _] = fall([LEAN, 0.0], t);
            let center = vec2(0.5 * libm::sin(LEAN), 0.5 * libm::cos(angle));
            vec![ground(0.0), Pose::new(center, UPRIGHT - angle)]
        },
        duration: DT * STEPS as Real,
        dt: DT,
        length: 1.0,
        fixed: 1e-3,
        toleranced: Some(Toleranced { tolerance: TOLERANCE, error: 1e-9 }),
        judged: Judged::Contact { order: true },
    }),
    checks: &[
        at_fixed_step("moment at which it lies flat, relative", 1e-3, || {
            Ok((end_of_fall()?[0] / 0.585_947_472_819 - 1.0).abs())
        }),
        at_fixed_step("angular velocity then, relative", 1e-3, || {
            Ok((end_of_fall()?[1] / 5.411_374_371_09 - 1.0).abs())
        }),
        with_tolerance("moment at which it strikes flat, and how fast, relative", 1e-9, || {
            let mut world = rod(UPRIGHT - LEAN, &rough(0.0), 0.0)?;
            world.advance(0.6, TOLERANCE)?;
            let Some(hit) = world.events().hit.first() else { return Ok(Real::INFINITY) };
            // The far end comes down at ωL.
            let [time, speed] =
                [hit.time / 0.585_947_472_819, hit.approach_speed / 5.411_374_371_09];
            Ok((time - 1.0).abs().max((speed - 1.0).abs()))
        }),
    ],
};

/// What comes of a rod that is pushed over the floor, its lower end ahead, at tan θ = 2.
struct Pushed {
    /// Energy above that at the start, of it.
    above: Real,
    /// Largest gain of energy in a step, of the energy at the start.
    gain: Real,
    /// Deepest that an end went below the floor (m).
    depth: Real,
}

fn pushed(friction: Real, run: impl Fn(&mut World) -> Result<()>) -> Result<Pushed> {
    let mut world = rod(atan2(2.0, 1.0), &rough(friction), -5.0)?;
    let start = world.energy()?.total();
    let mut before = start;
    let mut all = Pushed { above: Real::NEG_INFINITY, gain: Real::NEG_INFINITY, depth: 0.0 };
    for _ in 0..180 {
        run(&mut world)?;
        let (now, pose) = (world.energy()?.total(), world.bodies().poses[1]);
        if !(now.is_finite() && pose.position.norm().is_finite()) {
            let none = Real::INFINITY;
            return Ok(Pushed { above: none, gain: none, depth: none });
        }
        all.above = all.above.max((now - start) / start);
        all.gain = all.gain.max((now - before) / start);
        all.depth = all.depth.max(0.5 * libm::sin(pose.angle).abs() - pose.position.y);
        before = now;
    }
    Ok(all)
}

/// The same by fixed steps.
fn stepped(friction: Real) -> Result<Pushed> {
    pushed(friction, |world| world.step(DT))
}

/// The same to a tolerance.
fn located(friction: Real) -> Result<Pushed> {
    pushed(friction, |world| world.advance(DT, TOLERANCE).map(drop))
}

pub static PAINLEVE: Scene = Scene {
    id: "F13",
    name: "painleve",
    title: "Painlevé’s rod, pushed over the floor at tan θ = 2",
    about: "Rigid bodies with Coulomb’s friction have no solution without a jump where μ > (t + 4/t)/3, t = tan θ: not with μ = 1.2, but with 1.6 (Painlevé 1895; Génot and Brogliato 1999). Either way it must stay finite, gain no energy and stay above the floor.",
    reference: Reference::Law,
    answer: Answer::Numbers(|| Ok(Vec::new())),
    checks: &[
        at_fixed_step("energy above that of the start, μ = 1.2", 1e-12, || Ok(stepped(1.2)?.above)),
        at_fixed_step("energy above that of the start, μ = 1.6", 1e-12, || Ok(stepped(1.6)?.above)),
        // What pivots on an end that sticks keeps its energy to the order of the step.
        at_fixed_step("gain of energy in a step, μ = 1.2", 1e-6, || Ok(stepped(1.2)?.gain)),
        at_fixed_step("gain of energy in a step, μ = 1.6", 1e-6, || Ok(stepped(1.6)?.gain)),
        at_fixed_step("overlap, of the length, μ = 1.2", 1e-3, || Ok(stepped(1.2)?.depth)),
        at_fixed_step("overlap, of the length, μ = 1.6", 1e-3, || Ok(stepped(1.6)?.depth)),
        with_tolerance("energy above that of the start, μ = 1.2 and 1.6", 1e-9, || {
            Ok(located(1.2)?.above.max(located(1.6)?.above))
        }),
        with_tolerance("overlap, of the length, μ = 1.2 and 1.6", 1e-8, || {
            Ok(located(1.2)?.depth.max(located(1.6)?.depth))
        }),
        // Without it the rod would be asked for a force that does not exist.
        with_tolerance(
            "moment of the jump with μ = 1.6 (s), and slip left after it (m/s)",
            1e-12,
            || {
                let mut world = rod(atan2(2.0, 1.0), &rough(1.6), -5.0)?;
                world.advance(1e-3, TOLERANCE)?;
                let Some(jump) = world.events().hit.first() else { return Ok(Real::INFINITY) };
                let (pose, twist) = (&world.bodies().poses[1], &world.bodies().twists[1]);
                let end = twist.at(pose.rot().apply(vec2(-0.5, 0.0)));
                Ok(if end.y > 0.0 || world.report().fallback.is_some() {
                    jump.time
                } else {
                    end.x.abs().max(jump.time)
                })
            },
        ),
    ],
};
