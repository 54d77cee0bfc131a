//! Ragdolls and vehicles.

use culbuto::World;
use culbuto::builders::{Bone, Ragdoll, RagdollDef, VehicleDef};
use culbuto::joint::{JointKind, Spring};
use culbuto::math::{Real, vec2};

use crate::{DT, G, assert_close, earth, with_ground};

/// How far the hinges are beyond their limits (rad).
fn beyond(world: &World, ragdoll: &Ragdoll) -> Real {
    let excess = |joint: &culbuto::JointHandle| {
        let joint = world.joint(*joint).unwrap();
        let JointKind::Revolute { travel, .. } = joint.kind() else { panic!("not a hinge") };
        let [low, high] = travel.limits.unwrap();
        let angle = joint.travel()[0];
        (low - angle).max(angle - high)
    };
    ragdoll.parts.joints.iter().map(excess).fold(0.0, Real::max)
}

#[test]
fn a_ragdoll_weighs_what_it_should_and_is_as_tall() {
    let mut world = earth();
    let def = RagdollDef { position: vec2(3.0, 1.0), ..RagdollDef::new(1.8, 75.0) };
    let ragdoll = def.build(&mut world).unwrap();
    assert_close(ragdoll.parts.mass(&world).unwrap(), 75.0, 1e-12);
    let extent = |bone: Bone, side: Real| {
        let body = world.body(ragdoll.bone(bone)).unwrap();
        let bounds = body.def().shapes[0].shape.bounds_at(&body.pose());
        if side > 0.0 { bounds.max.y } else { bounds.min.y }
    };
    assert_close(extent(Bone::Head, 1.0), 1.0 + 1.8, 1e-12);
    assert_close(extent(Bone::LeftShin, -1.0), 1.0, 1e-12);
    assert_eq!(ragdoll.parts.bodies.len(), 11);
    assert_eq!(ragdoll.hinge(Bone::Pelvis), None);
    assert!(ragdoll.parts.gap(&world) < 1e-15);
    let name = |bone| world.body(ragdoll.bone(bone)).unwrap().def().name.unwrap();
    assert_eq!(name(Bone::RightForearm), "ragdoll right forearm");
}

/// Nothing inside moves the centre of mass: it falls along its parabola, whatever springs, friction and limits do.
#[test]
fn a_tumbling_ragdoll_falls_as_one_body() {
    let mut world = earth();
    let def = RagdollDef {
        velocity: vec2(3.0, 4.0),
        spring: Some(Spring::new(2.0, 0.3)),
        friction_torque: 1.0,
        ..RagdollDef::new(1.8, 75.0)
    };
    let ragdoll = def.build(&mut world).unwrap();
    // A kick at the head makes it tumble.
    let head = ragdoll.bone(Bone::Head);
    world.body_mut(head).unwrap().apply_impulse(vec2(40.0, 0.0), None).unwrap();
    let before = ragdoll.parts.center_of_mass(&world).unwrap();
    world.steps(DT, 90).unwrap();
    let (time, start) = (1.5, vec2(3.0 + 40.0 / 75.0, 4.0));
    let wanted = before + start * time + vec2(0.0, -0.5 * G * time * time);
    let now = ragdoll.parts.center_of_mass(&world).unwrap();
    assert!((now - wanted).norm() < 1e-9, "{now:?}, not {wanted:?}");
    assert!(ragdoll.parts.gap(&world) < 1e-9);
    assert!(beyond(&world, &ragdoll) < 1e-3, "{}", beyond(&world, &ragdoll));
}

/// Widest that the two anchors of a hinge are apart (m), and fastest turn (rad/s).
fn apart_and_rate(world: &World, ragdoll: &Ragdoll) -> [Real; 2] {
    let mut most = [0.0, 0.0];
    for joint in &ragdoll.parts.joints {
        let joint = world.joint(*joint).unwrap();
        let [a, b] = joint.anchors();
        most = [(b - a).norm().max(most[0]), joint.travel()[1].abs().max(most[1])];
    }
    most
}

/// Hinges hold to rounding. A limit is exceeded by no more than what a bone that the ground turns does in a substep.
#[test]
fn a_ragdoll_falls_to_the_ground_and_its_joints_hold() {
    for faces_left in [false, true] {
        let mut world = earth();
        let ground = with_ground(&mut world);
        let def = RagdollDef {
            position: vec2(0.0, 0.7),
            angle: 0.4,
            faces_left,
            ..RagdollDef::new(1.8, 75.0)
        };
        let ragdoll = def.build(&mut world).unwrap();
        let before = world.energy().unwrap().balance();
        let (mut gap, mut over, mut fastest): (Real, Real, Real) = (0.0, 0.0, 0.0);
        for _ in 0..180 {
            world.step(DT).unwrap();
            let [apart, rate] = apart_and_rate(&world, &ragdoll);
            (gap, fastest) = (gap.max(apart), fastest.max(rate));
            over = over.max(beyond(&world, &ragdoll));
            let strangers = |bodies: &[culbuto::BodyHandle; 2]| !bodies.contains(&ground);
            let touching = world.contacts().iter().any(|contact| strangers(&contact.bodies));
            assert!(!touching, "bones of one ragdoll do not touch each other");
        }
        assert!(gap < 1e-6 * 1.8, "largest gap {gap}");
        assert!(over < fastest * DT / 4.0, "beyond a limit by {over}");
        let lost = world.energy().unwrap();
        let open = lost.balance() - before;
        assert!(open.abs() < 1e-3 * before.abs(), "{open} of {before}");
        assert!(lost.dissipated > 0.3 * before, "it lies on the ground");
        let height = ragdoll.parts.center_of_mass(&world).unwrap().y;
        assert!(height < 0.4 && height > 0.0, "its centre is at {height}");
    }
}

#[test]
fn two_ragdolls_touch_each_other() {
    let mut world = World::new(vec2(0.0, 0.0)).unwrap();
    let left = RagdollDef { velocity: vec2(1.0, 0.0), ..RagdollDef::new(1.0, 10.0) };
    let right = RagdollDef { position: vec2(0.6, 0.0), ..RagdollDef::new(1.0, 10.0) };
    let (left, right) = (left.build(&mut world).unwrap(), right.build(&mut world).unwrap());
    let group =
        |ragdoll: &Ragdoll| world.body(ragdoll.bone(Bone::Head)).unwrap().def().filter.group;
    assert!(group(&left) < 0 && group(&right) < 0 && group(&left) != group(&right));
    world.steps(DT, 60).unwrap();
    let pushed = world.body(right.bone(Bone::Chest)).unwrap().velocity().x;
    assert!(pushed > 0.1, "the right one got {pushed}");
}

/// It is built in balance: nothing moves before the motor does. Wheels just touch, and a contact keeps a gap of rounding.
#[test]
fn a_vehicle_stands_in_the_balance_of_its_springs() {
    let mut world = earth();
    with_ground(&mut world);
    let car = VehicleDef::new(2.0, 100.0).build(&mut world).unwrap();
    let before = world.body(car.chassis).unwrap().pose();
    world.steps(DT, 120).unwrap();
    let after = world.body(car.chassis).unwrap().pose();
    assert!((after.position - before.position).norm() < 1e-6, "{before:?} {after:?}");
    assert!((after.angle - before.angle).abs() < 1e-6);
}

/// x = −r·θ for wheels that roll, and the speed asked for in the end; the chassis is where its wheels are. Until the contact
/// bears, for a substep of length h at most, a driven wheel spins freely and slips by ½(τ/I)h²r.
#[test]
fn a_vehicle_drives_as_far_as_its_wheels_roll() {
    for (speed, driven) in [(3.0, [true, false]), (-2.0, [true, true])] {
        let mut world = earth();
        with_ground(&mut world);
        let torque = 30.0;
        let max_torque = Some(torque);
        let def = VehicleDef { speed, driven, max_torque, ..VehicleDef::new(2.0, 100.0) };
        let car = def.build(&mut world).unwrap();
        let start = car.wheels.map(|wheel| world.body(wheel).unwrap().pose());
        let chassis = world.body(car.chassis).unwrap().position().x;
        world.steps(DT, 600).unwrap();
        for (wheel, start) in car.wheels.iter().zip(start) {
            let now = world.body(*wheel).unwrap().pose();
            let rolled = -car.wheel_radius * (now.angle - start.angle);
            assert!(rolled.abs() > 10.0);
            let turn = torque / world.body(*wheel).unwrap().mass().inertia;
            let slip = 0.5 * turn * (DT / 4.0).powi(2) * car.wheel_radius;
            let way = now.position.x - start.position.x;
            assert!((way - rolled).abs() < slip, "{way}, not {rolled} to {slip}");
            assert_close(world.body(*wheel).unwrap().velocity().x, speed, 1e-6);
        }
        let way = world.body(car.chassis).unwrap().position().x - chassis;
        let rolled = world.body(car.wheels[0]).unwrap().position().x - start[0].position.x;
        assert!((way - rolled).abs() < 1e-2 * car.wheel_radius, "{way} {rolled}");
        car.drive(&mut world, 0.0).unwrap();
        world.steps(DT, 300).unwrap();
        assert!(world.body(car.chassis).unwrap().velocity().norm() < 1e-6, "the motor brakes");
    }
}

/// Below its speed the motor gives its greatest torque: F = τ/r pushes the chassis and the wheels, whose turn counts as
/// I/r² more mass each. The chassis nods meanwhile, which shifts the way by less than the length by which it nods.
#[test]
fn a_vehicle_gains_speed_as_its_torque_says() {
    let mut world = earth();
    with_ground(&mut world);
    let def = VehicleDef { speed: 100.0, max_torque: Some(40.0), ..VehicleDef::new(2.0, 100.0) };
    let car = def.build(&mut world).unwrap();
    world.steps(DT, 240).unwrap();
    let r = car.wheel_radius;
    let wheel = world.body(car.wheels[0]).unwrap().mass();
    let carried = 100.0 + 2.0 * (wheel.mass + wheel.inertia / (r * r));
    let speed = world.body(car.wheels[1]).unwrap().velocity().x;
    assert_close(speed, 40.0 / r / carried * 4.0, 1e-3);
}
