//! Joints that hold points of deformable bodies.

use super::{STEP, block, fastest, material, with_floor};
use culbuto::body::BodyHandle;
use culbuto::joint::{Coefficients, Hold, JointDef, JointHandle, JointKind, Motor, Spring, Travel};
use culbuto::math::{PI, Real, Vec2, sin_cos, vec2};
use culbuto::shapes::Shape;
use culbuto::soft::{Mesh, SoftDef, SoftHandle};
use culbuto::world::Snapshot;
use culbuto::{BodyDef, World};

/// A kind of joint, A as given and B the world or a deformable body.
type Kind = (&'static str, fn(Option<BodyHandle>) -> JointDef);

const KINDS: [Kind; 3] = [
    ("pin", |body| JointDef::revolute(body, None)),
    ("rod", |body| JointDef::distance(body, None)),
    ("spring", |body| JointDef::spring(body, None, Hold::Spring(Spring::new(3.0, 0.2)))),
];

/// A block that is thrown and spun where nothing pulls.
fn thrown(world: &mut World) -> SoftHandle {
    let (velocity, angular_velocity) = (vec2(0.5, 0.2), 2.0);
    let def = SoftDef { velocity, angular_velocity, ..block(material(1e5, 0.1)) };
    world.add_soft_body(def).expect("it is allowed")
}

/// Where a pin is, or where the ends of what has a length are.
fn anchored(name: &str, def: JointDef, pin: Vec2, ends: [Vec2; 2]) -> JointDef {
    if name == "pin" { def.at(pin) } else { def.anchored(ends[0], ends[1]) }
}

/// Steps, and tells the largest gap after the first tenth, in which velocities that do not fit are made to.
fn run(world: &mut World, count: u32) -> Real {
    let mut gap: Real = 0.0;
    for k in 0..count {
        world.step(STEP).expect("it is allowed");
        if k > count / 10 {
            gap = gap.max(world.joint_gap());
        }
    }
    gap
}

#[test]
fn joints_keep_momentum_angular_momentum_and_the_books() {
    for (name, def) in KINDS {
        for rigid in [true, false] {
            let mut world = World::new(Vec2::zeros()).unwrap();
            let soft = thrown(&mut world);
            let (body, other) = if rigid {
                let mut def = BodyDef::new(Shape::rectangle(0.7, 0.5).unwrap());
                def.density = 300.0;
                let place = BodyDef { position: vec2(1.0, 0.3), angular_velocity: -3.0, ..def };
                (Some(world.add_body(place).unwrap()), None)
            } else {
                // As if both were one body: a pin that is torn open while it closes is a torque.
                let (position, velocity) = (vec2(1.0, 0.1), vec2(0.3, 2.2));
                let def = SoftDef { position, velocity, ..block(material(3e5, 0.0)) };
                let def = SoftDef { angular_velocity: 2.0, ..def };
                (None, Some(world.add_soft_body(def).unwrap()))
            };
            let def = anchored(name, def(body), vec2(0.5, 0.3), [vec2(1.3, 0.4), vec2(-0.3, 0.3)]);
            let joint = world.add_soft_joint(def, [other, Some(soft)]).unwrap();
            let about = vec2(0.4, -0.3);
            let (p, l) = (world.momentum(), world.angular_momentum(about));
            let balance = world.energy().unwrap().balance();
            let gap = run(&mut world, 120);
            assert!(world.joint(joint).unwrap().reaction().force.norm() > 0.1, "{name}");
            assert!((world.momentum() - p).norm() < 1e-12 * p.norm(), "{name}");
            let off = (world.angular_momentum(about) - l).abs();
            assert!(off < 1e-10 * l.abs(), "{name}, rigid {rigid}: {off:e} of {l}");
            // A pin without the correction of turning arms opens by 1.4e-6 m.
            let most = if name == "pin" { 8e-7 } else { 1e-5 };
            assert!(gap < most, "{name}, rigid {rigid}: {gap:e}");
            let energy = world.energy().unwrap();
            let lost = (energy.balance() - balance).abs();
            assert!(lost < 1e-10 * balance, "{name}: {lost:e} of {balance}");
        }
    }
}

/// A block of 100 kg hangs on a spring as far down as Hooke's law says, whatever the step.
#[test]
fn a_block_hangs_on_a_spring_by_its_weight() {
    for substeps in [1, 4] {
        let mut world = World::new(vec2(0.0, -9.81)).unwrap();
        world.set_substeps(substeps).unwrap();
        let soft = world.add_soft_body(block(material(1e6, 1.0))).unwrap();
        let hold =
            Hold::Spring(Spring::Constants(Coefficients { stiffness: 2000.0, damping: 900.0 }));
        let def = JointDef::spring(None, None, hold).anchored(vec2(0.0, 2.0), vec2(0.0, 0.5));
        let joint = world.add_soft_joint(def, [None, Some(soft)]).unwrap();
        world.steps(STEP, 900).unwrap();
        let [a, b] = world.joint(joint).unwrap().anchors();
        let stretch = (b - a).norm() - 1.5;
        assert!((stretch / (100.0 * 9.81 / 2000.0) - 1.0).abs() < 1e-6, "{substeps}: {stretch}");
        let force = world.joint(joint).unwrap().reaction().force;
        assert!((force.y / 981.0 - 1.0).abs() < 1e-6, "{force}");
    }
}

/// A spring that swings thousands of times in a step takes energy or keeps it, and never gives any.
#[test]
fn a_spring_that_no_step_resolves_gives_nothing() {
    for hertz in [10.0, 1e2, 1e3, 1e4] {
        let mut world = World::new(vec2(0.0, 0.0)).unwrap();
        let soft = world.add_soft_body(block(material(1e6, 0.1))).unwrap();
        let hold = Hold::Spring(Spring::new(hertz, 0.0));
        let def = JointDef::spring(None, None, hold).anchored(vec2(0.0, 2.0), vec2(0.0, 0.5));
        world.add_soft_joint(def, [None, Some(soft)]).unwrap();
        // Half a metre a second away from where the spring is at rest.
        let velocities = vec![vec2(0.0, -0.5); world.soft_body(soft).unwrap().positions().len()];
        world.set_soft_velocities(soft, &velocities).unwrap();
        let start = world.energy().unwrap().total();
        for step in 0..120 {
            world.step(STEP).unwrap();
            let energy = world.energy().unwrap();
            let total = energy.total();
            assert!(total < start * (1.0 + 1e-6), "{hertz} Hz, step {step}: {total} of {start}");
            // What the matter's own Newton iterations leave.
            assert!((energy.balance() / start - 1.0).abs() < 1e-5, "{hertz} Hz: {energy:?}");
        }
    }
}

/// A small rigid hub tied to a wheel of rubber at eight points, and a motor between it and an axle that the world holds.
fn wheel(world: &mut World, at: Vec2, speed: Real) -> (SoftHandle, BodyHandle, BodyHandle) {
    let ring = |radius: Real, n: u32| {
        (0..n).map(move |k| {
            let (sin, cos) = sin_cos(2.0 * PI * Real::from(k) / Real::from(n));
            vec2(cos, sin) * radius
        })
    };
    let outline: Vec<Vec2> = ring(0.5, 32).collect();
    let hole: Vec<Vec2> = ring(0.2, 16).collect();
    let mesh = Mesh::polygon(&outline, &[hole], 0.12).expect("it is allowed");
    let soft = world
        .add_soft_body(SoftDef { position: at, ..SoftDef::new(mesh, material(2e6, 0.1)) })
        .expect("it is allowed");
    let mut hub = BodyDef::new(Shape::circle(0.2).expect("it is allowed"));
    hub.density = 500.0;
    let hub = world.add_body(BodyDef { position: at, ..hub }).expect("it is allowed");
    for spoke in ring(0.2, 8) {
        let def = JointDef::revolute(hub, None).at(at + spoke);
        world.add_soft_joint(def, [None, Some(soft)]).expect("it is allowed");
    }
    let mut load = BodyDef::new(Shape::rectangle(0.3, 0.3).expect("it is allowed"));
    load.density = 2000.0;
    load.filter.mask = 0;
    load.angular_damping = 0.0;
    let load = world.add_body(BodyDef { position: at, ..load }).expect("it is allowed");
    let motor = Some(Motor { speed, max: Some(400.0) });
    let kind = JointKind::Revolute { angle: None, travel: Travel { motor, ..Travel::default() } };
    world.add_joint(JointDef::new(load, hub, kind).at(at)).expect("it is allowed");
    (soft, hub, load)
}

#[test]
fn a_motor_spins_a_wheel_of_rubber_up_to_its_speed() {
    let mut world = World::new(Vec2::zeros()).unwrap();
    let (soft, hub, load) = wheel(&mut world, vec2(3.0, 4.0), 12.0);
    let gap = run(&mut world, 300);
    let spin = |world: &World, body| world.body(body).unwrap().twist().angular;
    assert!((spin(&world, hub) - spin(&world, load) - 12.0).abs() < 1e-6);
    // What the rim has got the load has lost.
    let l = world.angular_momentum(vec2(3.0, 4.0));
    assert!(l.abs() < 1e-9, "{l:e}");
    let body = world.soft_body(soft).unwrap();
    let rate = body.angular_momentum(vec2(3.0, 4.0)) / body.mass() / 0.14;
    assert!((rate / spin(&world, hub) - 1.0).abs() < 0.05, "{rate} {}", spin(&world, hub));
    assert!(gap < 1e-6, "{gap:e}");
}

#[test]
fn a_joint_that_bears_too_much_breaks_and_what_hung_on_it_falls() {
    let mut world = World::new(vec2(0.0, -9.81)).unwrap();
    let soft = world.add_soft_body(block(material(1e5, 0.1))).unwrap();
    let def = JointDef { breaking_force: Some(2000.0), ..JointDef::revolute(None, None) };
    world.add_soft_joint(def.at(vec2(0.0, 0.5)), [None, Some(soft)]).unwrap();
    world.steps(STEP, 60).unwrap();
    assert_eq!(world.joints().len(), 1, "it bears the weight of 981 N, with some swing");
    world.set_gravity(vec2(0.0, -40.0)).unwrap();
    world.steps(STEP, 60).unwrap();
    assert_eq!(world.joints().len(), 0);
    assert!(fastest(&world, soft) > 10.0);
}

#[test]
fn what_a_joint_ties_does_not_touch_unless_asked_to() {
    for collide_connected in [false, true] {
        let mut world = World::new(Vec2::zeros()).unwrap();
        let soft = world.add_soft_body(block(material(1e5, 0.1))).unwrap();
        let ball = BodyDef::new(Shape::circle(0.2).unwrap());
        let ball = world
            .add_body(BodyDef { position: vec2(1.0, 0.0), velocity: vec2(-1.0, 0.0), ..ball })
            .unwrap();
        let rope = JointDef { collide_connected, ..JointDef::rope(ball, None, 5.0) };
        let rope = rope.anchored(vec2(1.0, 0.0), vec2(0.0, 0.5));
        world.add_soft_joint(rope, [None, Some(soft)]).unwrap();
        world.steps(STEP, 60).unwrap();
        let passed = world.body(ball).unwrap().pose().position.x < 0.1;
        assert_eq!(passed, !collide_connected);
    }
}

/// A grab draws a point to where it points, with no more than its force.
#[test]
fn a_grab_draws_a_point_and_lets_go() {
    let mut world = World::new(vec2(0.0, -9.81)).unwrap();
    let soft = world.add_soft_body(block(material(1e5, 0.3))).unwrap();
    let hold = Hold::Spring(Spring::new(2.0, 1.0));
    let kind = JointKind::Grab { hold, max_force: Some(5000.0) };
    let def = JointDef::new(None, None, kind).anchored(vec2(0.0, 1.0), vec2(0.0, 0.5));
    let joint = world.add_soft_joint(def, [None, Some(soft)]).unwrap();
    world.steps(STEP, 600).unwrap();
    let [target, point] = world.joint(joint).unwrap().anchors();
    let k = world.joint(joint).unwrap().springs()[0].unwrap().stiffness;
    let sag = target - point;
    assert!((sag - vec2(0.0, 981.0 / k)).norm() < 1e-3, "{sag}");
    world
        .edit_joint(joint, |def| def.kind = JointKind::Grab { hold, max_force: Some(500.0) })
        .unwrap();
    world.steps(STEP, 60).unwrap();
    let force = world.joint(joint).unwrap().reaction().force.norm();
    assert!(force < 500.0 * (1.0 + 1e-9), "{force}");
    assert!(world.soft_body(soft).unwrap().center().y < -0.2, "it is too heavy for that");
    world.remove_joint(joint).unwrap();
    assert_eq!(world.soft_body(soft).unwrap().pinned().len(), 81);
    world.step(STEP).unwrap();
}

/// Hangs a block on a pin, and steps.
fn hung() -> (World, SoftHandle, JointHandle) {
    let mut world = with_floor();
    let def = SoftDef { position: vec2(0.0, 2.0), ..block(material(1e5, 0.1)) };
    let soft = world.add_soft_body(def).expect("it is allowed");
    let def = JointDef::revolute(None, None).at(vec2(0.5, 2.5));
    let joint = world.add_soft_joint(def, [None, Some(soft)]).expect("it is allowed");
    world.steps(STEP, 30).expect("it is allowed");
    (world, soft, joint)
}

#[test]
fn a_snapshot_holds_joints_too() {
    let (mut world, soft, _) = hung();
    let bytes = world.snapshot().to_bytes().unwrap();
    let mut copy = Snapshot::from_bytes(&bytes, Vec::new()).unwrap().to_world();
    world.steps(STEP, 30).unwrap();
    copy.steps(STEP, 30).unwrap();
    let places = |world: &World| world.soft_body(soft).unwrap().positions().to_vec();
    assert_eq!(places(&world), places(&copy));
}

#[test]
fn a_joint_goes_with_its_body() {
    let (mut world, soft, joint) = hung();
    assert_eq!(world.soft_ends(joint).unwrap(), [None, Some(soft)]);
    world.remove_soft_body(soft).unwrap();
    assert!(world.joint(joint).is_err());
    world.step(STEP).unwrap();
}

#[test]
fn what_needs_an_angle_of_a_point_is_refused() {
    let (mut world, soft, joint) = hung();
    let refused = |world: &mut World, def: JointDef, what: &str| {
        let error = world.add_soft_joint(def.at(vec2(0.0, 2.0)), [None, Some(soft)]);
        let text = error.expect_err(what).to_string();
        assert!(text.contains(what), "{text}");
    };
    refused(&mut world, JointDef::weld(None, None), "weld");
    let gear = JointKind::Gear { ratio: 2.0, phase: None };
    refused(&mut world, JointDef::new(None, None, gear), "gear");
    let travel = Travel { motor: Some(Motor { speed: 1.0, max: None }), ..Travel::default() };
    let motor = JointKind::Revolute { angle: None, travel };
    refused(&mut world, JointDef::new(None, None, motor), "revolute");
    let far = JointDef::revolute(None, None).at(vec2(5.0, 2.0));
    let text = world.add_soft_joint(far, [None, Some(soft)]).expect_err("far").to_string();
    assert!(text.contains("from the deformable body"), "{text}");
    assert!(world.edit_joint(joint, |def| def.kind = gear).is_err());
    assert_eq!(world.joints().len(), 1);
    world.step(STEP).unwrap();
}
