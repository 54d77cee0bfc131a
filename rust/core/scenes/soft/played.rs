//! Worlds of deformable bodies among rigid ones, as games and machines have them. Made once, they run by themselves.

use crate::body::{BodyDef, BodyHandle, BodyKind, Friction, Locks, Surface};
use crate::error::Result;
use crate::joint::{JointDef, JointKind, Motor, Travel};
use crate::math::{PI, Real, Rot, Vec2, vec2};
use crate::shapes::Shape;
use crate::soft::{Gas, Material, Mesh, Rope, SoftDef, SoftHandle};
use crate::world::World;

const G: Real = 9.81;

fn heavy() -> Result<World> {
    World::new(vec2(0.0, -G))
}

fn with_friction(friction: Real) -> Surface {
    Surface { friction: Friction::of(friction), ..Surface::default() }
}

/// Adds a box that does not move, by its lowest and highest corner (m).
fn add_wall(world: &mut World, [low, high]: [Vec2; 2], friction: Real) -> Result<BodyHandle> {
    let size = high - low;
    world.add_body(BodyDef {
        kind: BodyKind::Static,
        position: (low + high) * 0.5,
        surface: with_friction(friction),
        ..BodyDef::new(Shape::rectangle(size.x, size.y)?)
    })
}

/// Rubber with 0.3 of critical damping at 5 Hz.
fn rubber(youngs_modulus: Real, density: Real) -> Material {
    let damped = Material { damping_ratio: 0.3, damping_frequency: 5.0, ..Material::default() };
    Material { youngs_modulus, density, ..damped }
}

/// Points of a circle, the first at +x.
fn ring(radius: Real, count: u32) -> impl Iterator<Item = Vec2> {
    let turn = 2.0 * PI / Real::from(count);
    (0..count).map(move |k| Rot::new(turn * Real::from(k)).apply(vec2(radius, 0.0)))
}

/// Mass of the plate of the press (kg).
pub const PLATE: Real = 2000.0;

/// What the block of a metre in the press is made of.
pub fn pressed() -> Material {
    rubber(1e5, 100.0)
}

/// A smooth block between a floor and a plate, which guides keep level.
pub fn press() -> Result<World> {
    let mut world = heavy()?;
    add_wall(&mut world, [vec2(-2.0, -0.5), vec2(2.0, 0.0)], 0.0)?;
    let plate = BodyDef {
        position: vec2(0.0, 1.2),
        mass: Some(PLATE),
        locks: Locks { x: true, y: false, rotation: true },
        surface: with_friction(0.0),
        ..BodyDef::new(Shape::rectangle(3.0, 0.2)?)
    };
    world.add_body(plate)?;
    let def = SoftDef {
        position: vec2(0.0, 0.52),
        surface: with_friction(0.0),
        ..SoftDef::new(Mesh::rectangle(1.0, 1.0, [4, 4])?, pressed())
    };
    world.add_soft_body(def)?;
    Ok(world)
}

/// Steps of the stairs, and their lengths (m).
const STEPS: u32 = 5;
const TREAD: Real = 0.6;
const RISE: Real = 0.3;

/// A jelly that is thrown down a flight of stairs with a wall at its foot.
pub fn stairs() -> Result<World> {
    let mut world = heavy()?;
    add_wall(&mut world, [vec2(-3.0, -0.5), vec2(9.0, 0.0)], 0.6)?;
    for k in 1..=STEPS {
        let right = TREAD * Real::from(STEPS - k + 1);
        let low = RISE * Real::from(k - 1);
        add_wall(&mut world, [vec2(-3.0, low), vec2(right, low + RISE)], 0.6)?;
    }
    add_wall(&mut world, [vec2(8.0, 0.0), vec2(8.5, 2.0)], 0.6)?;
    let def = SoftDef {
        position: vec2(-0.4, 2.6),
        angle: 0.3,
        velocity: vec2(1.5, 0.0),
        surface: with_friction(0.6),
        ..SoftDef::new(Mesh::rectangle(0.8, 0.5, [5, 3])?, rubber(2e4, 300.0))
    };
    world.add_soft_body(def)?;
    Ok(world)
}

const GAS: Gas = Gas { pressure: 1.02e5, outside: 1e5, exponent: 1.0 };

/// A box that falls on a balloon, kept upright by guides.
pub fn balloon() -> Result<World> {
    let mut world = heavy()?;
    add_wall(&mut world, [vec2(-4.0, -0.5), vec2(4.0, 0.0)], 0.6)?;
    let points: Vec<Vec2> = ring(0.6, 40).collect();
    let skin = Material { damping_ratio: 0.3, ..rubber(1.0, 1.0) };
    let def = SoftDef {
        position: vec2(0.0, 0.63),
        rope: Some(Rope { stretch_stiffness: 3e3, bending_stiffness: 0.0 }),
        gas: Some(GAS),
        surface: with_friction(0.6),
        ..SoftDef::new(Mesh::rope(&points, true)?, skin)
    };
    world.add_soft_body(def)?;
    let load = BodyDef {
        position: vec2(0.0, 2.5),
        density: 200.0,
        locks: Locks { x: true, y: false, rotation: true },
        surface: with_friction(0.6),
        ..BodyDef::new(Shape::rectangle(0.6, 0.4)?)
    };
    world.add_body(load)?;
    Ok(world)
}

/// Radius of the wheels (m), and the speed of the motors (rad/s).
pub const WHEEL: Real = 0.4;
pub const SPEED: Real = 4.0;

/// Adds a tyre of rubber around a hub that is tied to it at ten points.
fn add_wheel(world: &mut World, at: Vec2) -> Result<(SoftHandle, BodyHandle)> {
    let rim = 0.45 * WHEEL;
    let outline: Vec<Vec2> = ring(WHEEL, 32).collect();
    let hole: Vec<Vec2> = ring(rim, 20).collect();
    let mesh = Mesh::polygon(&outline, &[hole], 0.12)?;
    let def = SoftDef {
        position: at,
        surface: with_friction(0.9),
        ..SoftDef::new(mesh, rubber(5e5, 200.0))
    };
    let tyre = world.add_soft_body(def)?;
    let hub = BodyDef { position: at, density: 300.0, ..BodyDef::new(Shape::circle(rim)?) };
    let hub = world.add_body(hub)?;
    for spoke in ring(rim, 10) {
        let def = JointDef::revolute(hub, None).at(at + spoke);
        world.add_soft_joint(def, [None, Some(tyre)])?;
    }
    Ok((tyre, hub))
}

/// A cart on two wheels of rubber that its motors drive over bumps.
pub fn cart() -> Result<World> {
    let mut world = heavy()?;
    add_wall(&mut world, [vec2(-5.0, -0.5), vec2(200.0, 0.0)], 0.9)?;
    for k in 0..40_u32 {
        let x = 3.0 + 2.3 * Real::from(k);
        let bump = BodyDef {
            kind: BodyKind::Static,
            position: vec2(x, -0.1),
            surface: with_friction(0.9),
            ..BodyDef::new(Shape::circle(0.18)?)
        };
        world.add_body(bump)?;
    }
    let axle = WHEEL + 0.01;
    let chassis = BodyDef {
        position: vec2(0.0, axle + 0.55),
        density: 150.0,
        ..BodyDef::new(Shape::rectangle(1.6, 0.2)?)
    };
    let chassis = world.add_body(chassis)?;
    for x in [-0.7, 0.7] {
        let at = vec2(x, axle);
        let (_, hub) = add_wheel(&mut world, at)?;
        let motor = Some(Motor { speed: -SPEED, max: Some(150.0) });
        let kind =
            JointKind::Revolute { angle: None, travel: Travel { motor, ..Travel::default() } };
        world.add_joint(JointDef::new(chassis, hub, kind).at(at))?;
    }
    Ok(world)
}

const DRUM: Real = 0.5;
const GRIP: Real = 0.3;
/// Where the two drums stand.
const PLACES: [Real; 2] = [0.0, 4.0];
/// Length of a rod of the ropes (m).
const ROD: Real = 0.07;

/// Rods that hang to the left and to the right of each: at 0.82 and at 1.56 of what friction holds, by Euler and Eytelwein with the weight of
/// what lies on the drum, T₁ = T₂e^(μπ) + 2μwR(1 + e^(μπ))/(1 + μ²).
const HANGS: [[u32; 2]; 2] = [[24, 6], [30, 2]];

/// Two ropes over drums that do not turn: one that friction holds, one that runs off.
pub fn ropes() -> Result<World> {
    let mut world = heavy()?;
    add_wall(&mut world, [vec2(-3.0, -0.5), vec2(7.0, 0.0)], 0.6)?;
    for (place, hangs) in PLACES.into_iter().zip(HANGS) {
        let drum = BodyDef {
            kind: BodyKind::Static,
            position: vec2(place, 4.0),
            surface: with_friction(GRIP),
            ..BodyDef::new(Shape::circle(DRUM)?)
        };
        world.add_body(drum)?;
        let radius = DRUM + 0.011;
        let around = (0..=24_u32).map(|k| PI * (1.0 - Real::from(k) / 24.0));
        let over = around.map(|angle| Rot::new(angle).apply(vec2(radius, 0.0)) + vec2(place, 4.0));
        let hang = |side: Real, k: u32| vec2(place + side * radius, 4.0 - ROD * Real::from(k));
        let left = (1..=hangs[0]).rev().map(|k| hang(-1.0, k));
        let right = (1..=hangs[1]).map(|k| hang(1.0, k));
        let points: Vec<Vec2> = left.chain(over).chain(right).collect();
        let def = SoftDef {
            rope: Some(Rope { stretch_stiffness: 1e4, bending_stiffness: 1e-2 }),
            radius: Some(0.01),
            surface: with_friction(GRIP),
            ..SoftDef::new(Mesh::rope(&points, false)?, rubber(1.0, 1.0))
        };
        world.add_soft_body(def)?;
    }
    Ok(world)
}
