//! Bodies and joints that several tests share.

use culbuto::joint::Hold;
use culbuto::math::{Real, Vec2, sin_cos, vec2};
use culbuto::{BodyDef, JointDef, World};

pub const G: Real = 9.81;

/// A world with gravity that steps with this method, one substep a step.
pub fn world(method: &str) -> World {
    let mut world = World::new(vec2(0.0, -G)).unwrap();
    world.set_method(method).unwrap();
    world.set_substeps(1).unwrap();
    world
}

/// A uniform rod of mass and length 1, from `end` on along an angle.
pub fn rod(end: Vec2, angle: Real) -> BodyDef {
    let (sin, cos) = sin_cos(angle);
    let position = end + vec2(cos, sin) * 0.5;
    BodyDef { position, angle, inertia: Some(1.0 / 12.0), ..BodyDef::point(1.0) }
}

/// S9: a point on a rod of length 1, from 90°.
pub fn pendulum(method: &str) -> World {
    let mut world = world(method);
    let bob = BodyDef { position: vec2(1.0, 0.0), ..BodyDef::point(1.0) };
    let bob = world.add_body(bob).unwrap();
    world
        .add_joint(JointDef::distance(None, bob).anchored(vec2(0.0, 0.0), vec2(1.0, 0.0)))
        .unwrap();
    world
}

/// Angle from hanging down.
pub fn swing(position: Vec2) -> Real {
    position.x.atan2(-position.y)
}

/// S11: two rods, pinned to the world and to one another, released along +x.
pub fn double_pendulum(method: &str) -> World {
    let mut world = world(method);
    let a = world.add_body(rod(vec2(0.0, 0.0), 0.0)).unwrap();
    let b = world.add_body(rod(vec2(1.0, 0.0), 0.0)).unwrap();
    world.add_joint(JointDef::revolute(None, a).at(vec2(0.0, 0.0))).unwrap();
    world.add_joint(JointDef::revolute(a, b).at(vec2(1.0, 0.0))).unwrap();
    world
}

/// S7: a mass on a spring of 2 Hz, 0.25 beyond its rest, without gravity.
pub fn spring(method: &str, damping_ratio: Real) -> World {
    let mut world = world(method);
    world.set_gravity(vec2(0.0, 0.0)).unwrap();
    let body = world.add_body(BodyDef { position: vec2(1.0, 0.0), ..BodyDef::point(2.0) }).unwrap();
    let def = JointDef::spring(None, body, Hold::soft(2.0, damping_ratio));
    world.add_joint(def.anchored(vec2(0.0, 0.0), vec2(1.0, 0.0))).unwrap();
    let joint = world.joint_handles()[0];
    assert!(world.joint(joint).unwrap().gap() == 0.0);
    world.body_mut(body).unwrap().set_position(vec2(1.25, 0.0)).unwrap();
    world
}

/// Q2: a chain of point masses of 1 kg and rods of 1 m that hangs down, the last of another mass.
pub fn chain(method: &str, n: usize, last: Real) -> World {
    let mut world = world(method);
    let mut above = None;
    for k in 0..n {
        let mass = if k + 1 == n { last } else { 1.0 };
        let (from, to) = (vec2(0.0, -(k as Real)), vec2(0.0, -(k as Real) - 1.0));
        let body = world.add_body(BodyDef { position: to, ..BodyDef::point(mass) }).unwrap();
        world.add_joint(JointDef::distance(above, body).anchored(from, to)).unwrap();
        above = Some(body);
    }
    world
}
