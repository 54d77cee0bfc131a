//! What a world can have, to be counted in three ways: never had, had and taken away again, and there.

use culbuto::body::BodyKind;
use culbuto::forces::{Air, Central, ForceSchedule};
use culbuto::joint::JointDef;
use culbuto::math::{Vec2, Wrench, vec2};
use culbuto::shapes::Shape;
use culbuto::{BodyDef, BodyHandle, Result, World, fluid, soft};

/// Where things are added that shall meet nothing (m).
const FAR: f64 = 1e4;

/// Steps that a world takes with a feature before it loses it.
const BEFORE: u32 = 3;

/// Name of a world, and how it is made.
type Base = (&'static str, fn() -> Result<World>);

/// What every world here begins with; its last body is the one that forces and damping are given to.
pub const BASES: &[Base] = &[
    ("a ball that falls", || {
        let mut world = World::new(vec2(0.0, -9.81))?;
        world.add_body(BodyDef::new(Shape::circle(0.1)?))?;
        Ok(world)
    }),
    ("a box on a floor", || {
        let mut world = World::new(vec2(0.0, -9.81))?;
        rest(&mut world, 0.0)?;
        Ok(world)
    }),
    ("a pendulum", || {
        let mut world = World::new(vec2(0.0, -9.81))?;
        hang(&mut world, 0.0)?;
        Ok(world)
    }),
];

/// A name, and how it is given to a world whose last body is this one.
type Feature = (&'static str, fn(&mut World, BodyHandle) -> Result<()>);

/// Every feature.
pub const FEATURES: &[Feature] = &[
    ("air", |world, _| world.set_air(Air { density: 1.2, ..Air::default() })),
    ("damping", |world, body| world.body_mut(body)?.set_damping(0.1, 0.1)),
    ("field of force", |world, _| {
        let center = vec2(0.0, 9.0);
        world.add_field(Central { center, strength: 0.0, exponent: -2.0, per_mass: true });
        Ok(())
    }),
    ("schedule of forces", |world, body| {
        let forces = ForceSchedule::new(vec![0.0, 1.0], vec![Wrench::ZERO])?;
        world.add_schedule(body, forces).map(drop)
    }),
    ("contact", |world, _| rest(world, FAR)),
    ("1000 static boxes", |world, _| {
        (0..1000).try_for_each(|k| {
            let kind = BodyKind::Static;
            let position = vec2(FAR + 2.0 * f64::from(k), 0.0);
            let square = BodyDef::new(Shape::rectangle(1.0, 1.0)?);
            world.add_body(BodyDef { kind, position, ..square }).map(drop)
        })
    }),
    ("joint", |world, _| hang(world, FAR)),
    ("sleeping", |world, _| {
        world.set_sleeping(true);
        Ok(())
    }),
    ("fluid", |world, _| {
        let points: Vec<Vec2> =
            (0..100).map(|k| vec2(FAR + f64::from(k % 10), f64::from(k / 10))).collect();
        world.add_fluid(&points, 1.0, fluid::Material::default()).map(drop)
    }),
    ("deformable body", |world, _| {
        let mesh = soft::Mesh::rectangle(1.0, 1.0, [2, 2])?;
        let position = vec2(FAR, 0.0);
        let def = soft::SoftDef::new(mesh, soft::Material::default());
        world.add_soft_body(soft::SoftDef { position, ..def }).map(drop)
    }),
    ("timing of stages", |world, _| {
        world.set_timing(true);
        Ok(())
    }),
];

/// A world after a few steps: "never" with the feature, "had" (with it, then without), "there" (with it all the time).
pub fn world(base: &str, feature: &str, how: &str) -> Result<Option<World>> {
    let base = BASES.iter().find(|(name, _)| *name == base);
    let feature = FEATURES.iter().find(|(name, _)| *name == feature);
    let (Some((_, build)), Some((_, give))) = (base, feature) else { return Ok(None) };
    let mut world = build()?;
    let bodies = world.bodies().handles().to_vec();
    let joints = world.joint_handles().to_vec();
    if how != "never" {
        give(&mut world, bodies[bodies.len() - 1])?;
    }
    world.steps(1.0 / 60.0, BEFORE)?;
    if how == "had" {
        strip(&mut world, &bodies, joints.len())?;
    }
    Ok(Some(world))
}

/// Takes away all but these bodies and the first joints.
fn strip(world: &mut World, bodies: &[BodyHandle], joints: usize) -> Result<()> {
    world.set_air(Air::default())?;
    world.set_sleeping(false);
    world.set_timing(false);
    world.body_mut(bodies[bodies.len() - 1])?.set_damping(0.0, 0.0)?;
    while let Some(joint) = world.joint_handles().get(joints).copied() {
        world.remove_joint(joint)?;
    }
    for body in world.bodies().handles().to_vec() {
        if !bodies.contains(&body) {
            world.remove_body(body)?;
        }
    }
    for field in world.field_handles().to_vec() {
        world.remove_field(field)?;
    }
    for schedule in world.schedule_handles().to_vec() {
        world.remove_schedule(schedule)?;
    }
    for fluid in world.fluids().list.handles().to_vec() {
        world.remove_fluid(fluid)?;
    }
    for body in world.soft_handles().to_vec() {
        world.remove_soft_body(body)?;
    }
    Ok(())
}

/// A box of 1 m on a floor, there.
fn rest(world: &mut World, x: f64) -> Result<()> {
    let kind = BodyKind::Static;
    let floor = BodyDef::new(Shape::rectangle(10.0, 1.0)?);
    world.add_body(BodyDef { kind, position: vec2(x, -0.5), ..floor })?;
    let square = BodyDef::new(Shape::rectangle(1.0, 1.0)?);
    world.add_body(BodyDef { position: vec2(x, 0.5), ..square }).map(drop)
}

/// A ball hinged 1 m beside itself to the world, there.
fn hang(world: &mut World, x: f64) -> Result<()> {
    let position = vec2(x, 0.0);
    let ball = world.add_body(BodyDef { position, ..BodyDef::new(Shape::circle(0.1)?) })?;
    let hinge = JointDef::revolute(None, ball);
    let anchors = (vec2(x - 1.0, 0.0), vec2(-1.0, 0.0));
    world.add_joint(hinge.anchored_locally(anchors.0, anchors.1)).map(drop)
}
