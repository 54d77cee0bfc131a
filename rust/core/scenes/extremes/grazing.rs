//! Contacts that hardly are: grazing, parallel edges, vertex on vertex.

use std::f64::consts::FRAC_PI_4;

use crate::body::{BodyDef, BodyKind, Friction, Surface};
use crate::error::Result;
use crate::math::{Real, Vec2, vec2};
use crate::scenes::gauge::{Gauge, at_most};
use crate::scenes::stacks::ground;
use crate::scenes::{Answer, Number, Scene, weightless};
use crate::shapes::Shape;
use crate::world::World;

pub static GRAZING: Scene = Scene {
    id: "X13",
    name: "grazing",
    title: "Contacts that graze by 10⁻⁹ of a size, parallel edges, vertex on vertex",
    about: "A disk and a box pass a box at 5 m/s, without friction and without gravity, 10⁻⁹ m away or as deep in it: they keep \
        their velocity to 10⁻⁶. Two squares fall corner on corner, also off by 10⁻⁹; one slides along a seam of two \
        others, and between two walls that touch it: finite, no energy from nothing.",
    answer: Answer::Numbers(numbers),
    checks: &[],
};

fn smooth() -> Surface {
    Surface { friction: Friction::of(0.0), ..Surface::default() }
}

fn numbers() -> Result<Vec<Number>> {
    let mut numbers = Vec::new();
    for (body, shape) in [("a disk", Shape::circle(0.5)?), ("a box", Shape::rectangle(1.0, 1.0)?)] {
        for gap in [1e-9, 0.0, -1e-9] {
            for restitution in [0.0, 1.0] {
                let how = format!("{body}, gap {gap:e} m, e = {restitution}");
                let (change, gauge) = pass(shape.clone(), gap, restitution)?;
                numbers.push(at_most(format!("change of velocity (m/s), {how}"), change, 1e-6));
                numbers.extend(gauge.laws(&how));
            }
        }
    }
    for off in [0.0, 1e-9, -1e-9] {
        for restitution in [0.0, 0.5] {
            let gauge = corners(off, restitution)?;
            let how = format!("corner on corner, off by {off:e} m, e = {restitution}");
            numbers.push(at_most(format!("overlap at rest, {how}"), gauge.seen.overlap, 1e-3));
            numbers.extend(gauge.laws(&how));
        }
    }
    numbers.extend(seam()?);
    numbers.extend(channel()?);
    Ok(numbers)
}

/// The change of velocity of what passes a box.
fn pass(shape: Shape, gap: Real, restitution: Real) -> Result<(Real, Gauge)> {
    let mut world = weightless()?;
    let surface = Surface { restitution, ..smooth() };
    add_static(&mut world, vec2(0.0, -0.5), surface.clone())?;
    let velocity = vec2(5.0, 0.0);
    let position = vec2(-2.0, 0.5 + gap);
    world.add_body(BodyDef { position, velocity, surface, ..BodyDef::new(shape) })?;
    let mut gauge = Gauge::new(&world, 1.0)?;
    gauge.run(&mut world, 1.0 / 60.0, 60, 1)?;
    Ok(((world.bodies().twists[1].linear - velocity).norm(), gauge))
}

fn add_static(world: &mut World, position: Vec2, surface: Surface) -> Result<()> {
    let kind = BodyKind::Static;
    let shape = Shape::rectangle(1.0, 1.0)?;
    world.add_body(BodyDef { kind, position, surface, ..BodyDef::new(shape) })?;
    Ok(())
}

/// Two squares on their corners, the upper falling on the lower.
fn corners(off: Real, restitution: Real) -> Result<Gauge> {
    let mut world = ground()?;
    let half = (0.5_f64).sqrt();
    for (x, y) in [(0.0, half), (off, 3.0 * half + 0.2)] {
        world.add_body(BodyDef {
            position: vec2(x, y),
            angle: FRAC_PI_4,
            surface: Surface { restitution, ..Surface::default() },
            ..BodyDef::new(Shape::rectangle(1.0, 1.0)?)
        })?;
    }
    let mut gauge = Gauge::new(&world, 1.0)?;
    gauge.run(&mut world, 1.0 / 60.0, 300, 1)?;
    Ok(gauge)
}

/// A box that slides over a seam of two boxes under its weight: v stays, height stays.
fn seam() -> Result<Vec<Number>> {
    let mut world = World::default();
    for x in [0.0, 1.0, 2.0, 3.0] {
        add_static(&mut world, vec2(x, -0.5), smooth())?;
    }
    let velocity = vec2(1.0, 0.0);
    world.add_body(BodyDef {
        position: vec2(0.0, 0.25),
        velocity,
        surface: smooth(),
        ..BodyDef::new(Shape::rectangle(0.5, 0.5)?)
    })?;
    let mut gauge = Gauge::new(&world, 1.0)?;
    gauge.run(&mut world, 1.0 / 60.0, 150, 15)?;
    let change = (world.bodies().twists[4].linear - velocity).norm();
    let mut numbers = vec![at_most("change of velocity over seams (m/s)", change, 1e-6)];
    numbers.extend(gauge.laws("over seams"));
    Ok(numbers)
}

/// A box between two walls that touch it on both sides, falling: v = gt.
fn channel() -> Result<Vec<Number>> {
    let mut world = World::default();
    for x in [-1.0, 1.0] {
        for y in [0.0, 1.0, 2.0, 3.0] {
            add_static(&mut world, vec2(x, y), smooth())?;
        }
    }
    let shape = Shape::rectangle(1.0, 1.0)?;
    world.add_body(BodyDef {
        position: vec2(0.0, 3.0),
        surface: smooth(),
        ..BodyDef::new(shape)
    })?;
    let mut gauge = Gauge::new(&world, 1.0)?;
    gauge.run(&mut world, 1.0 / 60.0, 30, 3)?;
    let exact = vec2(0.0, -9.81 * 0.5);
    let change = (world.bodies().twists[8].linear - exact).norm();
    let mut numbers =
        vec![at_most("difference from a free fall between walls (m/s)", change, 1e-6)];
    numbers.extend(gauge.laws("between walls"));
    Ok(numbers)
}
