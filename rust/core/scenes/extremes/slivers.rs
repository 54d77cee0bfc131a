//! Needles and slivers.

use crate::body::{BodyDef, Surface};
use crate::error::Result;
use crate::math::{Real, Vec2, vec2};
use crate::scenes::gauge::{Gauge, at_most};
use crate::scenes::stacks::ground;
use crate::scenes::{Answer, Number, Reference, Scene};
use crate::shapes::Shape;

pub static SLIVERS: Scene = Scene {
    id: "X4",
    name: "needles_and_slivers",
    title: "Needles of 10³ : 1 and 10⁶ : 1 and triangles with an angle of 10⁻⁴ rad",
    about: "Eight of 1 m fall on the ground and on one another from 0.3 m on, turned each another way, some with restitution, \
        and lie there for 20 s: no energy from nothing, at rest no overlap beyond 10⁻³ of the width.",
    reference: Reference::Law,
    answer: Answer::Numbers(numbers),
    checks: &[],
};

fn numbers() -> Result<Vec<Number>> {
    let mut numbers = Vec::new();
    let needle =
        |width: Real| vec![vec2(-0.5, 0.0), vec2(0.5, 0.0), vec2(0.5, width), vec2(-0.5, width)];
    // Base 1, angle 1e-4 at one end.
    let sliver = vec![vec2(-0.5, 0.0), vec2(0.5, 0.0), vec2(0.5, 1e-4)];
    for (name, outline) in
        [("needles 10³ : 1", needle(1e-3)), ("needles 10⁶ : 1", needle(1e-6)), ("slivers", sliver)]
    {
        for (restitution, single) in [(0.0, true), (0.0, false), (0.5, false)] {
            let count = if single { 1 } else { 8 };
            let gauge = fall(&outline, restitution, count)?;
            let how = format!("{count} {name}, e = {restitution}");
            // Several press into one another deeper than they are wide; docs/decisions.md, "Known limits".
            if single {
                let what = format!("overlap at rest, part of the width, {how}");
                numbers.push(at_most(what, gauge.seen.overlap, 1e-3));
            }
            numbers.extend(gauge.laws(&how));
        }
    }
    Ok(numbers)
}

fn fall(outline: &[Vec2], restitution: Real, count: u8) -> Result<Gauge> {
    let mut world = ground()?;
    for k in 0..count {
        let k = Real::from(k);
        world.add_body(BodyDef {
            position: vec2(0.07 * k, 0.3 + 0.25 * k),
            angle: 0.05 + 0.4 * k,
            surface: Surface { restitution, ..Surface::default() },
            ..BodyDef::new(Shape::polygon(outline)?)
        })?;
    }
    let mut gauge = Gauge::new(&world, 1.0)?;
    gauge.run(&mut world, 1.0 / 60.0, 1200, 1)?;
    Ok(gauge)
}
