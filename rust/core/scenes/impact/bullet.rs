//! Shots at thin things: nothing passes through.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_3, TAU};

use crate::body::{BodyDef, BodyKind, Surface};
use crate::error::Result;
use crate::math::{Real, Twist, Vec2, sin_cos, vec2};
use crate::scenes::stage::{DT, Random};
use crate::scenes::{Answer, Number, Reference, Scene, weightless};
use crate::shapes::Shape;

/// Thickness of the wall and of the bar (m).
const THIN: Real = 1e-3;

pub static BULLETS: Scene = Scene {
    id: "C12",
    name: "bullets",
    title: "1000 shots of 1e3 to 1e5 m/s at a wall of 1 mm, and 200 at a bar of 1 mm that turns",
    about: "None goes through.",
    reference: Reference::Law,
    answer: Answer::Numbers(bullets),
    checks: &[],
};

fn bullets() -> Result<Vec<Number>> {
    let mut random = Random(2);
    let (mut through, mut past) = (0, 0);
    for _ in 0..1000 {
        through += u32::from(passes_the_wall(&mut random)?);
    }
    for _ in 0..200 {
        past += u32::from(passes_the_bar(&mut random)?);
    }
    let number = |what: &str, count: u32| Number {
        what: what.to_owned(),
        value: Real::from(count),
        exact: 0.0,
        asked: 0.0,
    };
    Ok(vec![number("shots through the wall", through), number("shots past the bar", past)])
}

/// A ball, a box or a rod of a few centimetres, turned and turning.
fn bullet(random: &mut Random, [position, velocity]: [Vec2; 2]) -> Result<BodyDef> {
    let size = random.between(0.01, 0.05);
    let shape = match random.between(0.0, 3.0) as u32 {
        0 => Shape::circle(size)?,
        1 => Shape::rectangle(size, 2.0 * size)?,
        _ => Shape::capsule(vec2(-size, 0.0), vec2(size, 0.0), 0.3 * size)?,
    };
    let surface = Surface { restitution: random.between(0.0, 1.0), ..Surface::default() };
    let (angle, angular_velocity) = (random.between(0.0, TAU), random.between(-100.0, 100.0));
    Ok(BodyDef { position, angle, velocity, angular_velocity, surface, ..BodyDef::new(shape) })
}

/// Speeds spread evenly over their powers of ten.
fn speed(random: &mut Random) -> Real {
    libm::pow(10.0, random.between(3.0, 5.0))
}

fn passes_the_wall(random: &mut Random) -> Result<bool> {
    let mut world = weightless()?;
    world.add_body(BodyDef {
        kind: BodyKind::Static,
        ..BodyDef::new(Shape::rectangle(THIN, 1e4)?)
    })?;
    let (speed, angle) = (speed(random), random.between(-FRAC_PI_3, FRAC_PI_3));
    let (sin, cos) = sin_cos(angle);
    // Met at any moment of the first two steps.
    let way = 0.2 + speed * cos * DT * random.between(0.0, 2.0);
    let shot = bullet(random, [vec2(-way, 0.0), vec2(cos, sin) * speed])?;
    world.add_body(shot)?;
    for _ in 0..4 {
        world.step(DT)?;
        if world.bodies().poses[1].position.x > 0.0 {
            return Ok(true);
        }
    }
    Ok(false)
}

fn passes_the_bar(random: &mut Random) -> Result<bool> {
    let mut world = weightless()?;
    let spin = random.between(-50.0, 50.0);
    let start = random.between(0.0, TAU);
    world.add_body(BodyDef {
        kind: BodyKind::Kinematic,
        angle: start,
        angular_velocity: spin,
        ..BodyDef::new(Shape::rectangle(2.0, THIN)?)
    })?;
    // Aimed at where a place on the bar will be.
    let (speed, place) = (speed(random), random.between(-0.8, 0.8));
    let time = DT * random.between(0.2, 2.0);
    let along = start + spin * time;
    let aim = FRAC_PI_2 * 0.7 * random.between(-1.0, 1.0) + FRAC_PI_2;
    let [target, flight] = [(along, place), (along + aim, speed)].map(|(angle, length)| {
        let (sin, cos) = sin_cos(angle);
        vec2(cos, sin) * length
    });
    let shot = bullet(random, [target - flight * time, flight])?;
    let body = world.add_body(shot)?;
    let before = world.body(body)?.twist();
    world.steps(DT, 4)?;
    let after: Twist = world.body(body)?.twist();
    Ok(after == before)
}
