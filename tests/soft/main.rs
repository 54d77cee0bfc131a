//! Deformable bodies in a world: what they keep, how they touch, what is refused.

mod events;
mod files;
mod joints;
mod laws;
mod queries;
mod refusals;
mod touch;

use culbuto::body::BodyKind;
use culbuto::math::{Real, Vec2, vec2};
use culbuto::shapes::Shape;
use culbuto::soft::{Material, Mesh, SoftDef, SoftHandle};
use culbuto::{BodyDef, World};

const STEP: Real = 1.0 / 60.0;

/// A world with a floor whose top is at y = 0.
fn with_floor() -> World {
    let mut world = World::new(vec2(0.0, -9.81)).expect("finite");
    let shape = Shape::rectangle(40.0, 1.0).expect("a box");
    let floor = BodyDef { kind: BodyKind::Static, ..BodyDef::new(shape) };
    world.add_body(BodyDef { position: vec2(0.0, -0.5), ..floor }).expect("a floor");
    world
}

fn material(youngs_modulus: Real, damping_ratio: Real) -> Material {
    let base = Material { density: 100.0, damping_frequency: 5.0, ..Material::default() };
    Material { youngs_modulus, damping_ratio, ..base }
}

fn block(material: Material) -> SoftDef {
    SoftDef::new(Mesh::rectangle(1.0, 1.0, [4, 4]).expect("a box"), material)
}

fn fastest(world: &World, soft: SoftHandle) -> Real {
    let body = world.soft_body(soft).expect("it is there");
    body.velocities().iter().map(Vec2::norm).fold(0.0, Real::max)
}
