//! Objects made of joints are what their definitions say, and move as such things do.

#![allow(clippy::unwrap_used, clippy::panic)] // helpers of tests may, as tests do

mod figures;
mod lattices;
mod lines;
mod refusals;

use culbuto::math::{Real, vec2};
use culbuto::shapes::Shape;
use culbuto::{BodyDef, BodyHandle, BodyKind, World};

const DT: Real = 1.0 / 60.0;
const G: Real = 9.81;

fn earth() -> World {
    World::new(vec2(0.0, -G)).unwrap()
}

/// Ground whose surface is y = 0.
fn with_ground(world: &mut World) -> BodyHandle {
    let ground = BodyDef {
        kind: BodyKind::Static,
        position: vec2(0.0, -1.0),
        ..BodyDef::new(Shape::rectangle(1000.0, 2.0).unwrap())
    };
    world.add_body(ground).unwrap()
}

/// |a − b| ≤ tolerance · |b|.
#[track_caller]
fn assert_close(a: Real, b: Real, tolerance: Real) {
    assert!((a - b).abs() <= tolerance * b.abs(), "{a:e} is not {b:e} to {tolerance:e}");
}
