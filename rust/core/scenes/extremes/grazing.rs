//! Contacts that hardly are: grazing, parallel edges, vertex on vertex.

use std::f64::consts::FRAC_PI_4;

use crate::body::{BodyDef, BodyKind, Friction, Surface};
use crate::error::Result;
use crate::math::{Real, Vec2, vec2};
use crate::scenes::gauge::{Gauge, at_most};
use crate::scenes::stacks::ground;
use crate::scenes::{Answer, Number, Reference, Scene, weightless};
use crate::shapes::Shape;
use crate::world::World;

pub static GRAZING: Scene = Scene {
    id: "X13",
    name: "grazing",
    title: "Contacts that graze by 10⁻⁹ of a size, parallel edges, vertex on vertex",
    about: "A disk, r = ½, and a box pass a box at v = 5 m/s, without friction and without gravity. 10⁻⁹ m away they keep their velocity. \
        δ = 10⁻⁹ m too low, the disk is hit by (1 + e)·v·√(2δ/r); without a bounce it may slip by, its overlap being so small. Two squares fall corner on corner, \
        also off by 10⁻⁹; a box slides along links that lie in one line, and falls between two walls that touch it.",
    reference: Reference::ClosedForm,
    answer: Answer::Numbers(numbers),
    checks: &[],
};

fn smooth() -> Surface {
    Surface { friction: Friction::of(0.0), ..Surface::default() }
}

const SPEED: Real = 5.0;

fn numbers() -> Result<Vec<Number>> {
    let mut numbers = Vec::new();
    for (body, shape) in [("a disk", Shape::circle(0.5)?), ("a box", Shape::rectangle(1.0, 1.0)?)] {
        for gap in [1e-9, 0.0, -1e-9] {
            for restitution in [0.0, 1.0] {
                let how = format!("{body}, gap {gap:e} m, e = {restitution}");
                let (change, gauge) = pass(shape.clone(), gap, restitution)?;
                numbers.extend(gauge.laws(&how));
                let what = format!("change of velocity (m/s), {how}");
                if gap > 0.0 {
                    numbers.push(at_most(what, change, 1e-12));
                } else if gap < 0.0 && body == "a disk" {
                    let normal = SPEED * (2.0 * -gap / 0.5).sqrt();
                    numbers.push(if restitution > 0.0 {
                        let exact = (1.0 + restitution) * normal;
                        Number { what, value: change, exact, asked: 1e-3 }
                    } else {
                        at_most(what, change, normal)
                    });
                }
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
    world.add_body(BodyDef {
        kind: BodyKind::Static,
        position: vec2(0.0, -0.5),
        surface: surface.clone(),
        ..BodyDef::new(Shape::rectangle(1.0, 1.0)?)
    })?;
    let velocity = vec2(SPEED, 0.0);
    let position = vec2(-2.0, 0.5 + gap);
    world.add_body(BodyDef { position, velocity, surface, ..BodyDef::new(shape) })?;
    let mut gauge = Gauge::new(&world, 1.0)?;
    gauge.run(&mut world, 1.0 / 60.0, 60, 1)?;
    Ok(((world.bodies().twists[1].linear - velocity).norm(), gauge))
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

/// A box that slides along the joints of a chain: v stays.
fn seam() -> Result<Vec<Number>> {
    let mut world = World::default();
    let points: Vec<Vec2> = (-4..=16).map(|k| vec2(0.25 * Real::from(k), 0.0)).collect();
    world.add_body(BodyDef {
        kind: BodyKind::Static,
        surface: smooth(),
        ..BodyDef::new(Shape::chain(&points, false)?)
    })?;
    let velocity = vec2(1.0, 0.0);
    let shape = Shape::rectangle(0.5, 0.5)?;
    let position = vec2(0.0, 0.25);
    world.add_body(BodyDef { position, velocity, surface: smooth(), ..BodyDef::new(shape) })?;
    let mut gauge = Gauge::new(&world, 1.0)?;
    gauge.run(&mut world, 1.0 / 60.0, 150, 15)?;
    let change = (world.bodies().twists[1].linear - velocity).norm();
    let mut numbers =
        vec![at_most("change of velocity over joints (m/s)", change, 1e-6 * 9.81 / 240.0)];
    numbers.extend(gauge.laws("over joints"));
    Ok(numbers)
}

/// A box between two walls that touch it, falling: v = gt.
fn channel() -> Result<Vec<Number>> {
    let mut world = World::default();
    for x in [-1.0, 1.0] {
        world.add_body(BodyDef {
            kind: BodyKind::Static,
            position: vec2(x, 0.0),
            surface: smooth(),
            ..BodyDef::new(Shape::rectangle(1.0, 8.0)?)
        })?;
    }
    let (shape, position) = (Shape::rectangle(1.0, 1.0)?, vec2(0.0, 3.0));
    world.add_body(BodyDef { position, surface: smooth(), ..BodyDef::new(shape) })?;
    let mut gauge = Gauge::new(&world, 1.0)?;
    gauge.run(&mut world, 1.0 / 60.0, 30, 3)?;
    let exact = vec2(0.0, -9.81 * 0.5);
    let apart = (world.bodies().twists[2].linear - exact).norm();
    let mut numbers =
        vec![at_most("difference from a free fall between walls (m/s)", apart, 1e-12)];
    numbers.extend(gauge.laws("between walls"));
    Ok(numbers)
}
