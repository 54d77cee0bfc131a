//! Two disks that meet, and a row of them.

use crate::body::BodyDef;
use crate::error::Result;
use crate::math::{Real, Vec2, atan2, vec2};
use crate::scenes::stage::{DT, TOLERANCE, at_fixed_step, smooth, with_tolerance};
use crate::scenes::{Answer, Judged, Motion, Number, Reference, Scene, Toleranced, at, weightless};
use crate::shapes::Shape;
use crate::world::World;

/// A disk of 1 m across: place, velocity, mass and restitution.
fn add_disk(
    world: &mut World,
    [position, velocity]: [Vec2; 2],
    (mass, restitution): (Real, Real),
) -> Result<()> {
    let shape = Shape::circle(0.5)?;
    let surface = smooth(restitution);
    world.add_body(BodyDef {
        position,
        velocity,
        mass: Some(mass),
        surface,
        ..BodyDef::new(shape)
    })?;
    Ok(())
}

pub static HEAD_ON: Scene = Scene {
    id: "C3",
    name: "head_on",
    title: "Two disks meet head-on, masses from 1e-3 to 1e6 kg, restitution from 0 to 1",
    about: "m₁v₁ + m₂v₂ stays, and they part with e times the speed they meet with (Newton).",
    reference: Reference::ClosedForm,
    answer: Answer::Numbers(|| head_on(|world| world.steps(DT, 30))),
    checks: &[with_tolerance("change of momentum, and restitution, largest", 1e-13, || {
        let numbers = head_on(|world| world.advance(0.5, TOLERANCE).map(drop))?;
        Ok(numbers.iter().map(|number| number.value).fold(0.0, Real::max))
    })],
};

fn head_on(run: impl Fn(&mut World) -> Result<()>) -> Result<Vec<Number>> {
    const MASSES: [Real; 4] = [1e-3, 1.0, 1e3, 1e6];
    const SPEEDS: [Real; 2] = [3.0, -2.0];
    let mut numbers = Vec::new();
    for first in MASSES {
        for second in MASSES {
            let (mut momentum, mut parting): (Real, Real) = (0.0, 0.0);
            for e in [0.0, 0.2, 0.5, 0.7, 1.0] {
                let mut world = weightless()?;
                add_disk(&mut world, [vec2(-1.0, 0.0), vec2(SPEEDS[0], 0.0)], (first, e))?;
                add_disk(&mut world, [vec2(0.3, 0.0), vec2(SPEEDS[1], 0.0)], (second, e))?;
                run(&mut world)?;
                let [a, b] = [0, 1].map(|k| world.bodies().twists[k].linear.x);
                let sizes = first * SPEEDS[0].abs() + second * SPEEDS[1].abs();
                let change = first * (a - SPEEDS[0]) + second * (b - SPEEDS[1]);
                momentum = momentum.max((change / sizes).abs());
                parting = parting.max(((b - a) / (SPEEDS[0] - SPEEDS[1]) - e).abs());
            }
            let of = format!("{first:e} kg against {second:e} kg");
            for (what, value) in [("change of momentum", momentum), ("restitution", parting)] {
                let what = format!("{what}, {of}");
                numbers.push(Number { what, value, exact: 0.0, asked: 1e-12 });
            }
        }
    }
    Ok(numbers)
}

pub static SMOOTH_DISKS: Scene = Scene {
    id: "C4",
    name: "smooth_disks",
    title: "A smooth disk strikes another at impact parameter b",
    about: "The struck one leaves along the normal, asin(b/2R) off the line of flight; with equal masses and e = 1 the other at a right angle to it.",
    reference: Reference::ClosedForm,
    answer: Answer::Numbers(|| smooth_disks(|world| world.steps(DT, 60))),
    checks: &[with_tolerance("error of the directions, largest (rad)", 1e-10, || {
        let numbers = smooth_disks(|world| world.advance(1.0, TOLERANCE).map(drop))?;
        Ok(numbers.iter().map(|number| number.value.abs()).fold(0.0, Real::max))
    })],
};

fn smooth_disks(run: impl Fn(&mut World) -> Result<()>) -> Result<Vec<Number>> {
    let mut numbers = Vec::new();
    for b in [0.0, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99] {
        let mut world = weightless()?;
        add_disk(&mut world, [vec2(-3.03, b), vec2(5.0, 0.0)], (1.0, 1.0))?;
        add_disk(&mut world, [vec2(0.0, 0.0), vec2(0.0, 0.0)], (1.0, 1.0))?;
        run(&mut world)?;
        let [shot, struck] = [0, 1].map(|k| {
            let v = world.bodies().twists[k].linear;
            atan2(v.y, v.x)
        });
        let value = struck + libm::asin(b);
        let what = format!("direction of the struck disk (rad), b = {b}·2R");
        numbers.push(Number { what, value, exact: 0.0, asked: 1e-3 });
        if b > 0.0 {
            let value = shot - struck - std::f64::consts::FRAC_PI_2;
            let what = format!("angle between the two less 90° (rad), b = {b}·2R");
            numbers.push(Number { what, value, exact: 0.0, asked: 1e-3 });
        }
    }
    Ok(numbers)
}

/// Way of the first ball to the second, and of each of the others to its next (m).
const GAPS: [Real; 4] = [0.5, 1e-3, 1e-3, 1e-3];
const SPEED: Real = 1.0;

fn cradle(gaps: [Real; 4], speed: Real) -> Result<World> {
    let mut world = weightless()?;
    let mut x = 0.0;
    for k in 0..5 {
        let v = if k == 0 { speed } else { 0.0 };
        add_disk(&mut world, [vec2(x, 0.0), vec2(v, 0.0)], (1.0, 1.0))?;
        x += 1.0 + gaps.get(k).copied().unwrap_or(0.0);
    }
    Ok(world)
}

/// Largest difference of the speeds from those of a cradle whose last ball alone moves, of that speed.
fn off_the_cradle(world: &World, speed: Real) -> Real {
    let off = |(k, twist): (usize, &crate::math::Twist)| {
        let exact = if k == 4 { speed } else { 0.0 };
        (twist.linear - vec2(exact, 0.0)).norm() / speed
    };
    world.bodies().twists.iter().enumerate().map(off).fold(0.0, Real::max)
}

pub static CRADLE: Scene = Scene {
    id: "C5",
    name: "cradle",
    title: "Newton's cradle of five balls, 1 mm apart and touching",
    about: "Each ball hands all its speed to the next, and the last leaves with it.",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: || cradle(GAPS, SPEED),
        exact: |t| {
            let (mut x, mut before) = (0.0, 0.0);
            let mut poses = Vec::new();
            for k in 0..5 {
                let gap = GAPS.get(k).copied().unwrap_or(Real::INFINITY);
                poses.push(at(x + (SPEED * t - before).clamp(0.0, gap), 0.0));
                (x, before) = (x + 1.0 + gap, before + gap);
            }
            poses
        },
        duration: 2.0,
        dt: DT,
        length: 1.0,
        fixed: 1e-6,
        toleranced: Some(Toleranced { tolerance: TOLERANCE, error: 1e-12 }),
        judged: Judged::Contact { order: false },
    }),
    checks: &[
        at_fixed_step("speeds after, of v₀, 1 mm apart", 1e-6, || {
            let mut world = cradle(GAPS, SPEED)?;
            world.steps(DT, 60)?;
            Ok(off_the_cradle(&world, SPEED))
        }),
        at_fixed_step("speeds after against 0 0 0 0 5 m/s, of 5, touching", 1e-6, || {
            let mut world = cradle([0.5, 0.0, 0.0, 0.0], 5.0)?;
            world.steps(DT, 60)?;
            Ok(off_the_cradle(&world, 5.0))
        }),
        with_tolerance("speeds after against 0 0 0 0 5 m/s, of 5, touching", 1e-12, || {
            let mut world = cradle([0.5, 0.0, 0.0, 0.0], 5.0)?;
            world.advance(1.0, TOLERANCE)?;
            Ok(off_the_cradle(&world, 5.0))
        }),
    ],
};
