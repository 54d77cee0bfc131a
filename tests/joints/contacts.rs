//! Islands that have joints and contacts.

use culbuto::body::{Friction, Surface};
use culbuto::joint::{Given, Hold, JointDef, JointHandle, JointKind, Motor, Spring, Travel};
use culbuto::math::{Real, Rot, Vec2, vec2};
use culbuto::shapes::Shape;
use culbuto::{BodyDef, BodyHandle, BodyKind, World};
use proptest::prelude::*;

use crate::common::{DT, H, fewer};
use crate::worlds::assert_below;

fn surface() -> Surface {
    Surface { friction: Friction::of(0.8), ..Surface::default() }
}

/// Gravity, and ground whose top is at y = 0.
fn ground() -> World {
    let mut world = World::new(vec2(0.0, -9.81)).unwrap();
    world
        .add_body(BodyDef {
            kind: BodyKind::Static,
            position: vec2(0.0, -1.0),
            surface: surface(),
            ..BodyDef::new(Shape::rectangle(200.0, 2.0).unwrap())
        })
        .unwrap();
    world
}

fn limb(world: &mut World, from: Vec2, to: Vec2, radius: Real) -> BodyHandle {
    let middle = (from + to) * 0.5;
    let shape = Shape::capsule(from - middle, to - middle, radius).unwrap();
    world.add_body(BodyDef { position: middle, surface: surface(), ..BodyDef::new(shape) }).unwrap()
}

fn hinge(world: &mut World, a: BodyHandle, b: BodyHandle, at: Vec2, limits: [Real; 2]) {
    let travel =
        Travel { limits: Some(limits), spring: Some(Spring::new(1.0, 0.7)), ..Travel::default() };
    let kind = JointKind::Revolute { angle: None, travel };
    world.add_joint(JointDef::new(a, b, kind).at(at)).unwrap();
}

/// A trunk, a head and four limbs of two parts, 2 m above the ground, turned.
pub fn ragdoll(turn: Real) -> World {
    let mut world = ground();
    let rot = Rot::new(turn);
    let p = |x: Real, y: Real| vec2(0.0, 2.0) + rot.apply(vec2(x, y));
    let trunk = limb(&mut world, p(0.0, -0.3), p(0.0, 0.3), 0.15);
    let head = limb(&mut world, p(0.0, 0.55), p(0.0, 0.65), 0.12);
    hinge(&mut world, trunk, head, p(0.0, 0.45), [-0.5, 0.5]);
    for side in [-1.0, 1.0] {
        for (y, out) in [(0.25, 0.2), (-0.4, 0.1)] {
            let joint = p(side * out, y);
            let (elbow, hand) = (p(side * (out + 0.3), y - 0.1), p(side * (out + 0.6), y - 0.2));
            let upper = limb(&mut world, joint, elbow, 0.06);
            let lower = limb(&mut world, elbow, hand, 0.05);
            hinge(&mut world, trunk, upper, joint, [-1.2, 1.2]);
            hinge(&mut world, upper, lower, elbow, [-1.5, 0.2]);
        }
    }
    world
}

/// Runs, and looks after each step: the books close to a part of what there ever was, no energy comes from nowhere,
/// no joint opens by more than a thousandth of a millimetre, or passes a limit by more than an impact turns it within a substep.
fn sound(world: &mut World, steps: u32) -> Result<(), TestCaseError> {
    let start = world.energy().unwrap();
    let weight = world.mass() * world.settings().gravity.norm();
    let scale = start.kinetic + weight * 2.0;
    for step in 0..steps {
        let rates = |world: &World| -> Vec<Real> {
            let rate = |joint: &JointHandle| world.joint(*joint).unwrap().travel()[1].abs();
            world.joint_handles().iter().map(rate).collect()
        };
        let before = rates(world);
        world.step(DT).unwrap();
        let fastest = before.iter().chain(&rates(world)).copied().fold(0.0, Real::max);
        let now = world.energy().unwrap();
        let scale = scale.max(now.work.abs());
        let off = (now.balance() - start.balance()).abs() / scale;
        prop_assert!(off <= 1e-9, "step {}: balance off by {:e}", step, off);
        let more = now.total() - start.total() - (now.work - start.work) - now.correction_work;
        prop_assert!(more <= 1e-4 * scale, "step {}: {:e} J from nowhere", step, more);
        for joint in world.joint_handles() {
            let joint = world.joint(*joint).unwrap();
            if let JointKind::Revolute { travel, .. } = joint.kind() {
                let [a, b] = joint.anchors();
                // As the pendulum of the catalogue.
                prop_assert!((b - a).norm() <= 1e-6, "step {}: {:e} m open", step, (b - a).norm());
                let [low, high] = travel.limits.unwrap_or([-9.0, 9.0]);
                let [angle, _] = joint.travel();
                let most = 1e-9 + fastest * H;
                let within = angle >= low - most && angle <= high + most;
                prop_assert!(within, "step {}: {} in {}..{}", step, angle, low, high);
            }
        }
        let finite = world.bodies().poses.iter().all(|pose| pose.position.norm() < 1e3);
        prop_assert!(finite, "step {}: something flew off", step);
    }
    Ok(())
}

proptest! {
    #![proptest_config(fewer(16))]

    #[test]
    fn a_ragdoll_falls_on_the_ground(turn in -3.1..3.1_f64) {
        let mut world = ragdoll(turn);
        sound(&mut world, 180)?;
        let lowest = world.bodies().poses[1..].iter().map(|pose| pose.position.y).fold(9.0, Real::min);
        prop_assert!(lowest > 0.0, "{} under ground", lowest);
    }

    #[test]
    fn a_chain_falls_over_a_drum(off in -0.4..0.4_f64, links in 6..16_u32) {
        let mut world = ground();
        let drum = BodyDef {
            kind: BodyKind::Static,
            position: vec2(0.0, 3.0),
            surface: surface(),
            ..BodyDef::new(Shape::circle(0.5).unwrap())
        };
        world.add_body(drum).unwrap();
        let (long, mut before) = (0.3, None);
        for k in 0..links {
            let left = vec2(off + long * (Real::from(k) - 0.5 * Real::from(links)), 3.7);
            let body = limb(&mut world, left, left + vec2(long, 0.0), 0.05);
            if let Some(before) = before {
                world.add_joint(JointDef::revolute(before, body).at(left)).unwrap();
            }
            before = Some(body);
        }
        sound(&mut world, 180)?;
    }
}

/// A chassis on two wheels with springs, driven: it goes where the motors turn it, rolling.
#[test]
fn a_cart_drives() {
    let mut world = ground();
    let chassis = BodyDef {
        position: vec2(0.0, 0.8),
        surface: surface(),
        ..BodyDef::new(Shape::rectangle(2.0, 0.4).unwrap())
    };
    let chassis = world.add_body(chassis).unwrap();
    for x in [-0.7, 0.7] {
        let wheel = BodyDef {
            position: vec2(x, 0.35),
            surface: surface(),
            ..BodyDef::new(Shape::circle(0.3).unwrap())
        };
        let wheel = world.add_body(wheel).unwrap();
        let kind = JointKind::Wheel {
            axis: Given::World(vec2(0.0, 1.0)),
            suspension: Hold::soft(3.0, 0.7),
            limits: Some([-0.2, 0.2]),
            motor: Some(Motor { speed: -5.0, max: Some(20.0) }),
        };
        world.add_joint(JointDef::new(chassis, wheel, kind).at(vec2(x, 0.35))).unwrap();
    }
    sound(&mut world, 240).unwrap();
    let speed = world.body(chassis).unwrap().velocity();
    // Clockwise by 5 rad/s against the chassis, on wheels of 0.3 m: 1.5 m/s to the right.
    assert_below("speed", (speed.x - 1.5).abs(), 0.01);
    assert!(world.body(chassis).unwrap().angle().abs() < 0.05);
    assert!(world.body(chassis).unwrap().position().x > 3.0);
}

/// What two boxes on each other bear is what a joint between them bears as well: a box hung by a rod from the ceiling
/// over a box on the ground that it just touches carries its weight on either, and the rows share it without a fight.
#[test]
fn a_hung_box_on_a_box_rests() {
    let mut world = ground();
    let square = |y: Real| BodyDef {
        position: vec2(0.0, y),
        surface: surface(),
        ..BodyDef::new(Shape::rectangle(1.0, 1.0).unwrap())
    };
    world.add_body(square(0.5)).unwrap();
    let upper = world.add_body(square(1.5)).unwrap();
    let rod = JointDef::distance(None, upper).anchored(vec2(0.0, 4.0), vec2(0.0, 2.0));
    world.add_joint(rod).unwrap();
    sound(&mut world, 240).unwrap();
    let twists = &world.bodies().twists;
    assert!(twists.iter().all(|twist| twist.linear.norm() < 1e-6), "{twists:?}");
}
