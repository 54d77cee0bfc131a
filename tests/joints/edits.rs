//! Joints that are changed, removed, and that let bodies touch or not.

use culbuto::joint::{Hold, JointDef, JointKind, Motor, Travel};
use culbuto::math::{Real, Vec2, vec2};
use culbuto::shapes::Shape;
use culbuto::{BodyDef, World};

use crate::common::{DT, chain};
use crate::worlds::{assert_below, bits};

/// A wheel of 1 kg·m² on a pin.
fn wheel(travel: Travel) -> World {
    let mut world = World::new(vec2(0.0, 0.0)).unwrap();
    let body = world.add_body(BodyDef { inertia: Some(1.0), ..BodyDef::point(1.0) }).unwrap();
    let kind = JointKind::Revolute { angle: None, travel };
    world.add_joint(JointDef::new(None, body, kind)).unwrap();
    world
}

#[test]
fn an_edit_that_changes_nothing_changes_nothing() {
    let mut plain = World::new(vec2(0.0, -9.81)).unwrap();
    chain(&mut plain, 4, vec2(0.0, 0.0));
    let mut edited = plain.clone();
    for _ in 0..30 {
        plain.step(DT).unwrap();
        edited.step(DT).unwrap();
        for joint in edited.joint_handles().to_vec() {
            edited.edit_joint(joint, |_| ()).unwrap();
        }
    }
    assert_eq!(bits(&plain), bits(&edited));
}

#[test]
fn motors_springs_and_lengths_change_while_the_world_runs() {
    let mut world = wheel(Travel::default());
    let joint = world.joint_handles()[0];
    let set = |world: &mut World, to: Travel| {
        let edit =
            |def: &mut JointDef| def.kind = JointKind::Revolute { angle: Some(0.0), travel: to };
        world.edit_joint(joint, edit).unwrap();
    };
    world.steps(DT, 10).unwrap();
    assert_eq!(world.bodies().twists[0].angular, 0.0);
    let motor = |speed: Real| Some(Motor { speed, max: Some(2.0) });
    set(&mut world, Travel { motor: motor(5.0), ..Travel::default() });
    world.steps(DT, 60).unwrap();
    assert_below("2 N·m for 1 s", (world.bodies().twists[0].angular - 2.0).abs(), 1e-12);
    set(&mut world, Travel { motor: motor(0.5), ..Travel::default() });
    world.steps(DT, 60).unwrap();
    assert_below("braked", (world.bodies().twists[0].angular - 0.5).abs(), 1e-12);
    set(&mut world, Travel::default());
    world.steps(DT, 60).unwrap();
    assert_below("free", (world.bodies().twists[0].angular - 0.5).abs(), 1e-12);
}

/// A rod that is made longer draws its end there, without a blow: positions only.
#[test]
fn a_rod_takes_its_new_length() {
    let mut world = World::new(vec2(0.0, -9.81)).unwrap();
    let bob = world.add_body(BodyDef { position: vec2(0.0, -1.0), ..BodyDef::point(1.0) }).unwrap();
    let rod = JointDef::distance(None, bob).anchored(Vec2::zeros(), vec2(0.0, -1.0));
    let rod = world.add_joint(rod).unwrap();
    world.steps(DT, 10).unwrap();
    world
        .edit_joint(rod, |def| {
            def.kind =
                JointKind::Distance { length: Some(1.25), hold: Hold::Rigid, min: 0.0, max: None };
        })
        .unwrap();
    world.steps(DT, 1).unwrap();
    assert_below("place", (world.body(bob).unwrap().position() - vec2(0.0, -1.25)).norm(), 1e-12);
    assert_below("speed", world.body(bob).unwrap().velocity().norm(), 1e-9);
}

#[test]
fn joints_go_with_their_bodies() {
    let mut world = World::new(vec2(0.0, -9.81)).unwrap();
    chain(&mut world, 4, vec2(0.0, 0.0));
    let joints = world.joint_handles().to_vec();
    let bodies = world.bodies().handles().to_vec();
    world.steps(DT, 5).unwrap();
    world.remove_body(bodies[1]).unwrap();
    for (k, joint) in joints.iter().enumerate() {
        assert_eq!(world.joint(*joint).is_ok(), k == 0 || k == 3, "joint {k}");
    }
    let falls = world.body(bodies[3]).unwrap().velocity();
    world.steps(DT, 60).unwrap();
    // The two that are left of the lower end fall freely: their centre of mass gains gt.
    let now = world.body(bodies[3]).unwrap().velocity();
    assert!(now.y < falls.y - 5.0, "{now:?}");
    // The gap of the first is closed as ever.
    assert_below("gap", world.joint(joints[0]).unwrap().gap(), 1e-12);
}

/// Two boxes whose rope lets them meet: they do only if they may.
#[test]
fn what_is_joined_touches_only_if_it_may() {
    let meet = |collide_connected: bool, filter: bool| {
        let mut world = World::new(vec2(0.0, 0.0)).unwrap();
        let square = |x: Real, v: Real| BodyDef {
            position: vec2(x, 0.0),
            velocity: vec2(v, 0.0),
            ..BodyDef::new(Shape::rectangle(1.0, 1.0).unwrap())
        };
        let a = world.add_body(square(-1.0, 1.0)).unwrap();
        let b = world.add_body(square(1.0, -1.0)).unwrap();
        let rope =
            if filter { JointDef::new(a, b, JointKind::Filter) } else { JointDef::rope(a, b, 5.0) };
        world.add_joint(JointDef { collide_connected, ..rope }).unwrap();
        world.steps(DT, 60).unwrap();
        let joint = world.joint_handles()[0];
        let through =
            world.body(a).unwrap().position().x > world.body(b).unwrap().position().x - 0.5;
        // What may not touch and overlaps is parted once it may.
        world.edit_joint(joint, |def| def.collide_connected = !collide_connected).unwrap();
        world.steps(DT, 60).unwrap();
        through
    };
    assert!(meet(false, false), "they met");
    assert!(!meet(true, false), "they went through");
    assert!(meet(false, true), "the filter did not keep them from meeting");
}
