//! What is flat as a whole is flat: bodies slide over the seams of tiles that lie side by side, each a body of its own.

use culbuto::body::{BodyDef, BodyKind, Friction, Surface};
use culbuto::math::{Real, Vec2, vec2};
use culbuto::shapes::Shape;
use culbuto::{BodyHandle, World};
use proptest::prelude::*;

use crate::common::fewer;

fn smooth() -> Surface {
    Surface { friction: Friction::of(0.0), ..Surface::default() }
}

/// A square of half a metre that slides with its centre at 1 m along a row of tiles of 1 m, their tops along `way`.
fn slide(way: Vec2, gravity: Vec2, speed: Real) -> (World, BodyHandle) {
    let mut world = World::new(gravity).unwrap();
    let up = vec2(-way.y, way.x);
    for k in 0..30 {
        let position = way * Real::from(k) - up * 0.5;
        let (kind, surface) = (BodyKind::Static, smooth());
        let tile = BodyDef::new(Shape::rectangle(1.0, 1.0).unwrap());
        world.add_body(BodyDef { kind, position, surface, ..tile }).unwrap();
    }
    let square = BodyDef::new(Shape::rectangle(0.5, 0.5).unwrap());
    let (position, velocity) = (way + up * 0.25, way * speed);
    let slider = BodyDef { position, velocity, surface: smooth(), ..square };
    let slider = world.add_body(slider).unwrap();
    (world, slider)
}

proptest! {
    #![proptest_config(fewer(4))]

    /// Without friction it keeps its velocity along the floor, whatever its speed, the step and the load on the floor. It goes by up to a
    /// quarter of its width in a step, and gravity would make it fall by up to 2 cm.
    #[test]
    fn no_seam_stops_what_slides_over_tiles(
        way in 0.001..0.125_f64, rate in 15.0..240.0_f64, fall in 1e-4..0.02_f64,
    ) {
        let (speed, load) = (way * rate, fall * rate * rate);
        let (mut world, slider) = slide(vec2(1.0, 0.0), vec2(0.0, -load), speed);
        world.steps(1.0 / rate, ((25.0 / way) as u32).min(2000)).unwrap();
        let body = world.body(slider).unwrap();
        // What a tip of the square takes as one tile hands it to the next: far less than the kick of a substep.
        let little = 1e-3 * (speed + load / (4.0 * rate));
        prop_assert!((body.velocity().x - speed).abs() < little, "{}", body.velocity());
        prop_assert!((body.position().y - 0.25).abs() < 1e-3 * 0.5, "{}", body.position());
    }
}

/// A wall of tiles, against which the square is pressed while it falls along it.
#[test]
fn no_seam_stops_what_falls_along_a_wall_of_tiles() {
    let (mut world, slider) = slide(vec2(0.0, -1.0), vec2(-3.0, -10.0), 0.0);
    let before = world.body(slider).unwrap().position();
    world.steps(1.0 / 60.0, 120).unwrap();
    let body = world.body(slider).unwrap();
    assert!((body.velocity().y + 20.0).abs() < 1e-6, "{}", body.velocity());
    assert!((body.position().x - before.x).abs() < 1e-3 * 0.5, "{}", body.position());
}
