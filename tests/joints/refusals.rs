//! What is not allowed is said so, and changes nothing.

use std::sync::atomic::{AtomicU32, Ordering};

use culbuto::forces::{BodyColumns, BoxError, ForceField};
use culbuto::joint::{Coefficients, Given, Hold, JointDef, JointKind, Motor, Spring, Travel};
use culbuto::math::{Real, Wrench, vec2};
use culbuto::shapes::Shape;
use culbuto::{BodyDef, BodyHandle, BodyKind, Error, World};

use crate::common::{DT, chain};
use crate::worlds::bytes;

/// Two bodies on a joint, one static, one that is gone.
fn world() -> (World, [BodyHandle; 4]) {
    let mut world = World::new(vec2(0.0, -9.81)).unwrap();
    chain(&mut world, 2, vec2(0.0, 0.0));
    let [a, b] = [0, 1].map(|k| world.bodies().handles()[k]);
    let fixed = BodyDef { kind: BodyKind::Static, ..BodyDef::default() };
    let fixed = world.add_body(fixed).unwrap();
    let gone = world.add_body(BodyDef::point(1.0)).unwrap();
    world.remove_body(gone).unwrap();
    world.steps(DT, 10).unwrap();
    (world, [a, b, fixed, gone])
}

#[track_caller]
fn refused(def: JointDef, said: &[&str]) {
    let (mut world, _) = world();
    let before = bytes(&world);
    let error = world.add_joint(def.clone()).unwrap_err().to_string();
    for part in said {
        assert!(error.contains(part), "{error:?} does not say {part:?}");
    }
    assert!(before == bytes(&world), "the world has changed");
    let joint = world.joint_handles()[0];
    assert!(world.edit_joint(joint, |own| *own = def).is_err());
    assert!(before == bytes(&world), "the world has changed by an edit");
}

const BAD: [Real; 3] = [Real::NAN, Real::INFINITY, Real::NEG_INFINITY];

#[test]
fn bodies_that_cannot_be_joined() {
    let (mut world, [a, _, fixed, gone]) = world();
    refused(JointDef::revolute(a, a), &["the same body twice", "two different bodies"]);
    refused(JointDef::revolute(None, None), &["the world twice"]);
    refused(JointDef::revolute(None, fixed), &["nothing can move", "dynamic"]);
    let stale = world.add_joint(JointDef::revolute(a, gone)).unwrap_err();
    assert!(matches!(stale, Error::StaleHandle { .. }), "{stale}");
}

#[test]
fn springs_with_bad_numbers() {
    let (_, [a, b, ..]) = world();
    for hertz in [-1.0, 0.0].into_iter().chain(BAD) {
        let spring = Spring::Frequency { hertz, damping_ratio: 0.1 };
        refused(JointDef::spring(a, b, Hold::Spring(spring)), &["hertz"]);
        refused(JointDef::new(a, b, JointKind::AngleSpring { angle: None, spring }), &["hertz"]);
    }
    for zeta in [-0.1].into_iter().chain(BAD) {
        refused(JointDef::spring(a, b, Hold::soft(1.0, zeta)), &["damping_ratio"]);
    }
    for bad in [-1.0].into_iter().chain(BAD) {
        for (stiffness, damping) in [(bad, 0.0), (1.0, bad)] {
            let spring = Spring::Constants(Coefficients { stiffness, damping });
            let what = if damping == 0.0 { "stiffness" } else { "damping" };
            refused(JointDef::spring(a, b, Hold::Spring(spring)), &[what]);
        }
    }
}

#[test]
fn places_that_are_nowhere() {
    let (_, [a, b, ..]) = world();
    for bad in BAD {
        refused(JointDef::revolute(a, b).at(vec2(bad, 0.0)), &["anchor_a"]);
        let locally = JointDef::revolute(a, b).anchored_locally(vec2(0.0, 0.0), vec2(0.0, bad));
        refused(locally, &["anchor_b"]);
        let axis = Given::World(vec2(bad, 1.0));
        let kind = JointKind::Prismatic { axis, angle: None, travel: Travel::default() };
        refused(JointDef::new(a, b, kind), &["axis"]);
        let over = [vec2(0.0, 0.0), vec2(bad, 0.0)];
        let kind = JointKind::Pulley { over, ratio: 1.0, length: None, slack: false };
        refused(JointDef::new(a, b, kind), &["over"]);
    }
    let axis = Given::Local(vec2(0.0, 0.0));
    let kind = JointKind::Rack { axis, radius: 1.0, offset: None };
    refused(JointDef::new(a, b, kind), &["axis", "direction"]);
}

#[test]
fn limits_motors_and_bounds_with_bad_numbers() {
    let (_, [a, b, ..]) = world();
    let hinge = |travel: Travel| JointDef::new(a, b, JointKind::Revolute { angle: None, travel });
    for bad in BAD {
        refused(hinge(Travel { limits: Some([bad, 1.0]), ..Travel::default() }), &["limit"]);
        let motor = Some(Motor { speed: bad, max: None });
        refused(hinge(Travel { motor, ..Travel::default() }), &["motor speed"]);
        refused(hinge(Travel { rest: bad, ..Travel::default() }), &["rest"]);
        if bad != Real::INFINITY {
            refused(JointDef::rope(a, b, bad), &["max"]);
        }
        refused(
            JointDef { breaking_force: Some(bad), ..JointDef::weld(a, b) },
            &["breaking_force"],
        );
        let kind = JointKind::Friction { max_force: bad, max_torque: 1.0 };
        refused(JointDef::new(a, b, kind), &["max_force"]);
        refused(JointDef::new(a, b, JointKind::Gear { ratio: bad, phase: None }), &["ratio"]);
        refused(JointDef::new(a, b, JointKind::Ratchet { step: bad, phase: 0.0 }), &["step"]);
    }
    refused(hinge(Travel { limits: Some([1.0, 0.0]), ..Travel::default() }), &["upper limit"]);
    let motor = Some(Motor { speed: 1.0, max: Some(-1.0) });
    refused(hinge(Travel { motor, ..Travel::default() }), &["motor"]);
    refused(JointDef { breaking_torque: Some(-1.0), ..JointDef::weld(a, b) }, &["breaking_torque"]);
    refused(JointDef::new(a, b, JointKind::Gear { ratio: 0.0, phase: None }), &["ratio"]);
    refused(JointDef::new(a, b, JointKind::Ratchet { step: 0.0, phase: 0.0 }), &["step"]);
    let kind = JointKind::Distance { length: None, hold: Hold::Free, min: 2.0, max: Some(1.0) };
    refused(JointDef::new(a, b, kind), &["max", "2 or above"]);
}

#[test]
fn joints_that_are_gone() {
    let (mut world, _) = world();
    let joint = world.joint_handles()[0];
    world.remove_joint(joint).unwrap();
    let before = bytes(&world);
    assert!(world.remove_joint(joint).is_err());
    assert!(world.joint(joint).is_err());
    assert!(world.edit_joint(joint, |_| ()).is_err());
    assert!(before == bytes(&world));
}

/// Fails at its tenth evaluation.
struct Fails(AtomicU32);

impl ForceField for Fails {
    fn name(&self) -> &'static str {
        "fails"
    }

    fn add_forces(&self, _: Real, _: &BodyColumns<'_>, _: &mut [Wrench]) -> Result<(), BoxError> {
        if self.0.fetch_add(1, Ordering::Relaxed) < 10 {
            Ok(())
        } else {
            Err("out of order".into())
        }
    }
}

/// A run to a tolerance over joints with bounds, of bodies that can meet nothing, goes another way than one over contacts.
#[test]
fn a_run_that_fails_changes_nothing() {
    for alone in [true, false] {
        let mut world = World::new(vec2(0.0, -9.81)).unwrap();
        let wheel = BodyDef::new(Shape::rectangle(1.0, 0.3).unwrap());
        let body = world.add_body(wheel.clone()).unwrap();
        if !alone {
            world.add_body(BodyDef { position: vec2(5.0, 0.0), ..wheel }).unwrap();
        }
        let kind = JointKind::Ratchet { step: 0.3, phase: 0.0 };
        world.add_joint(JointDef::new(None, body, kind)).unwrap();
        world.add_field(Fails(AtomicU32::new(0)));
        let before = bytes(&world);
        let error = world.advance(1.0, 1e-6).unwrap_err().to_string();
        assert!(error.contains("out of order"), "{error}");
        assert!(before == bytes(&world), "the world has changed, alone: {alone}");
    }
}
