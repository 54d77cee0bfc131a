//! What a user sees of contacts: contacts, events, hooks, sensors, platforms with one side.

#![allow(clippy::unwrap_used, clippy::panic)] // helpers of tests may, as tests do

#[path = "../common/worlds.rs"]
mod worlds;

mod contacts;
mod events;
mod hooks;
mod one_way;
mod sensors;

use culbuto::body::Role;
use culbuto::math::{Real, Vec2, vec2};
use culbuto::shapes::Shape;
use culbuto::{BodyDef, BodyHandle, BodyKind, World};

const DT: Real = 1.0 / 60.0;
const G: Real = 9.81;

fn world() -> World {
    World::new(vec2(0.0, -G)).unwrap()
}

/// A static box, its top at height 0.
fn ground(world: &mut World) -> BodyHandle {
    let slab = Shape::rectangle(40.0, 1.0).unwrap();
    let def = BodyDef { position: vec2(0.0, -0.5), kind: BodyKind::Static, ..BodyDef::new(slab) };
    world.add_body(def).unwrap()
}

fn ball(world: &mut World, at: Vec2, velocity: Vec2) -> BodyHandle {
    let def = BodyDef::new(Shape::circle(0.25).unwrap());
    world.add_body(BodyDef { position: at, velocity, ..def }).unwrap()
}

fn crate_at(world: &mut World, at: Vec2) -> BodyHandle {
    let def = BodyDef::new(Shape::rectangle(1.0, 1.0).unwrap());
    world.add_body(BodyDef { position: at, ..def }).unwrap()
}

/// A static shape with a role.
fn fixed(world: &mut World, shape: Shape, at: Vec2, role: Role) -> BodyHandle {
    let def = BodyDef { position: at, kind: BodyKind::Static, role, ..BodyDef::new(shape) };
    world.add_body(def).unwrap()
}
