//! Many bodies at one point.

use super::random::Dice;
use crate::body::BodyDef;
use crate::error::Result;
use crate::math::{Real, vec2};
use crate::scenes::gauge::{Gauge, at_most};
use crate::scenes::{Answer, Number, Reference, Scene, weightless};
use crate::shapes::Shape;

pub static CROWD: Scene = Scene {
    id: "X8",
    name: "crowd",
    title: "50 bodies at one point",
    about: "Disks of radius 0.1, or boxes of 0.2, all put at the same point, without gravity, at rest. They part by corrections of their \
        places: in 60 s none overlaps by more than 10⁻³ of its width, and no speed above 10⁻⁶ m/s comes of it. Boxes turned \
        at random, too.",
    reference: Reference::Law,
    answer: Answer::Numbers(numbers),
    checks: &[],
};

fn numbers() -> Result<Vec<Number>> {
    let mut numbers = Vec::new();
    for name in ["disks", "boxes", "turned boxes"] {
        let mut world = weightless()?;
        let mut dice = Dice::new(8);
        for _ in 0..50 {
            let shape =
                if name == "disks" { Shape::circle(0.1)? } else { Shape::rectangle(0.2, 0.2)? };
            let angle = if name == "turned boxes" { dice.between(0.0, 6.0) } else { 0.0 };
            world.add_body(BodyDef { position: vec2(1.0, 2.0), angle, ..BodyDef::new(shape) })?;
        }
        let rest = world.clone();
        let mut gauge = Gauge::new(&world, 1.0)?;
        let dt = 1.0 / 60.0;
        let mut fastest: Real = 0.0;
        for _ in 0..120 {
            world.steps(dt, 30)?;
            gauge.seen.overlap = 0.0;
            gauge.settle(&rest);
            gauge.look_closely(&world);
            fastest = fastest.max(gauge.seen.speed);
        }
        let seen = gauge.seen;
        numbers.push(at_most(
            format!("overlap at the end, part of the width, {name}"),
            seen.overlap,
            1e-3,
        ));
        numbers.push(at_most(format!("fastest (m/s), {name}"), fastest, 1e-6));
        let near = (world.momentum().norm(), seen.drift);
        numbers.push(at_most(format!("momentum (kg·m/s), {name}"), near.0, 1e-12));
        numbers.push(at_most(format!("farthest from the start (m), {name}"), near.1, 5.0));
    }
    Ok(numbers)
}
