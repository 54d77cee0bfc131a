//! Limits, motors, grabs and friction keep their bounds; what breaks, breaks where it should.

use culbuto::joint::{Hold, JointDef, JointKind, Motor, Travel};
use culbuto::math::{Real, Vec2, vec2};
use culbuto::{BodyDef, World};
use proptest::prelude::*;

use crate::common::{DT, H, Thrown, Tied, chain, fewer, joined, pairs, vector};

/// Largest force and torque of the only joint in so many steps.
fn largest(world: &mut World, steps: u32) -> (Real, Real) {
    let joint = world.joint_handles()[0];
    let (mut force, mut torque): (Real, Real) = (0.0, 0.0);
    for _ in 0..steps {
        world.step(DT).unwrap();
        let reaction = world.joint(joint).unwrap().reaction();
        force = force.max(reaction.force.norm());
        torque = torque.max(reaction.torque.abs());
    }
    (force, torque)
}

proptest! {
    #![proptest_config(fewer(2))]

    /// The rows foresee a limit, and what is passed is closed: to a part of 1e-9 of a turn, which the four steps that close a gap
    /// leave.
    #[test]
    fn a_hinge_stays_within_its_limits(
        bodies in pairs(), low in -1.0..-0.1_f64, high in 0.1..1.0_f64, speed in -9.0..9.0_f64,
    ) {
        let motor = Some(Motor { speed, max: None });
        let travel = Travel { limits: Some([low, high]), motor, ..Travel::default() };
        let tied = Tied { kind: JointKind::Revolute { angle: None, travel }, anchors: [Vec2::zeros(); 2] };
        let mut world = joined(&bodies, &tied);
        let joint = world.joint_handles()[0];
        let most = 1e-9;
        for _ in 0..60 {
            world.step(DT).unwrap();
            let [angle, _] = world.joint(joint).unwrap().travel();
            prop_assert!(angle >= low - most && angle <= high + most, "{} in {}..{}", angle, low, high);
        }
    }

    /// Along a curve a substep cuts the corner by L(ωh)²/8 at most; what is passed is closed at its end.
    #[test]
    fn a_rope_is_never_longer_than_it_is(bodies in pairs(), slack in 1.0..1.5_f64) {
        let apart = (bodies[1].place - bodies[0].place).norm();
        let most = apart * slack;
        let kind = JointKind::Distance { length: None, hold: Hold::Free, min: 0.3 * apart, max: Some(most) };
        let mut world = joined(&bodies, &Tied { kind, anchors: bodies.each_ref().map(|body| body.place) });
        let joint = world.joint_handles()[0];
        for _ in 0..120 {
            let twists = &world.bodies().twists;
            let speed = twists[0].linear.norm() + twists[1].linear.norm();
            world.step(DT).unwrap();
            let [long, _] = world.joint(joint).unwrap().travel();
            let corner = (speed * H).powi(2) / (8.0 * 0.3 * apart);
            prop_assert!(long <= most + corner, "{} of {}", long, most);
            prop_assert!(long >= 0.3 * apart - corner, "{} of {}", long, 0.3 * apart);
        }
    }

    #[test]
    fn a_motor_never_exceeds_its_torque(bodies in pairs(), speed in -9.0..9.0_f64, max in 0.0..3.0_f64) {
        let motor = Some(Motor { speed, max: Some(max) });
        let kind = JointKind::Revolute { angle: None, travel: Travel { motor, ..Travel::default() } };
        // By their centres, so that the force of the hinge has no arm in the middle of a substep, where it is open by (ωh)².
        let middle =
            |body: &Thrown| Thrown { place: Vec2::zeros(), velocity: Vec2::zeros(), ..*body };
        let tied = Tied { kind, anchors: [Vec2::zeros(); 2] };
        let (_, torque) = largest(&mut joined(&bodies.each_ref().map(middle), &tied), 60);
        prop_assert!(torque <= max * (1.0 + 1e-9) + 1e-15, "{} of {}", torque, max);
    }

    /// The length of the force, in any direction.
    #[test]
    fn grabs_motors_and_friction_never_exceed_their_force(
        bodies in pairs(), which in 0..3_u8, max_force in 0.0..6.0_f64, max_torque in 0.0..2.0_f64,
        soft in prop::bool::ANY, a in vector(0.3), b in vector(0.3),
    ) {
        let hold = if soft { Hold::soft(4.0, 0.3) } else { Hold::Rigid };
        let kind = match which {
            0 => JointKind::Grab { hold, max_force: Some(max_force) },
            1 => JointKind::Friction { max_force, max_torque },
            _ => JointKind::Motor {
                offset: vec2(0.2, -0.1),
                angle: Some(0.5),
                linear: hold,
                angular: hold,
                max_force: Some(max_force),
                max_torque: Some(max_torque),
            },
        };
        let anchors = [bodies[0].place + a, bodies[1].place + b];
        let mut world = joined(&bodies, &Tied { kind, anchors });
        let (force, torque) = largest(&mut world, 90);
        prop_assert!(force <= max_force * (1.0 + 1e-9) + 1e-15, "{} of {}", force, max_force);
        if which > 0 {
            let rounding = 1e-12 * force;
            prop_assert!(torque <= max_torque * (1.0 + 1e-9) + rounding, "{} of {}", torque, max_torque);
        }
    }

    /// It breaks in the step in which it bore more than it may, and in no other: until then the two worlds are the same
    /// to the bit.
    #[test]
    fn a_joint_breaks_where_it_bears_too_much(part in 0.2..1.3_f64, links in 1..5_usize, which in 0..5_usize) {
        let which = which % links;
        let mut free = World::new(vec2(0.0, -9.81)).unwrap();
        chain(&mut free, links, Vec2::zeros());
        let joint = free.joint_handles()[which];
        let mut borne = Vec::new();
        let mut world = free.clone();
        for _ in 0..60 {
            world.step(DT).unwrap();
            borne.push(world.joint(joint).unwrap().reaction().force.norm());
        }
        let bound = part * borne.iter().copied().fold(0.0, Real::max);
        let mut world = free.clone();
        world.edit_joint(joint, |def| def.breaking_force = Some(bound)).unwrap();
        let first = borne.iter().position(|force| *force > bound);
        for (step, force) in borne.iter().enumerate() {
            world.step(DT).unwrap();
            let broke = world.broken_joints();
            if Some(step) == first {
                prop_assert_eq!(broke.len(), 1);
                prop_assert_eq!(broke[0].joint, joint);
                prop_assert_eq!(broke[0].reaction.force.norm(), *force);
                prop_assert_eq!(broke[0].time, world.time());
                prop_assert!(world.joint(joint).is_err());
                break;
            }
            prop_assert!(broke.is_empty(), "step {}", step);
            prop_assert!(world.joint(joint).is_ok());
        }
        prop_assert_eq!(first.is_none(), world.joint(joint).is_ok());
    }
}

/// Both ways, and told by whether it moves.
#[test]
fn a_ratchet_turns_one_way() {
    for step in [0.3, -0.3] {
        let mut world = World::new(vec2(0.0, 0.0)).unwrap();
        let wheel = BodyDef { inertia: Some(1.0), ..BodyDef::point(1.0) };
        let body = world.add_body(BodyDef { torque: -step, ..wheel }).unwrap();
        world
            .add_joint(JointDef::new(None, body, JointKind::Ratchet { step, phase: 0.0 }))
            .unwrap();
        world.steps(DT, 120).unwrap();
        assert!(world.body(body).unwrap().angle().abs() <= 1e-12, "it turned back");
        world
            .body_mut(body)
            .unwrap()
            .set_force(culbuto::math::Wrench::new(vec2(0.0, 0.0), step))
            .unwrap();
        world.steps(DT, 120).unwrap();
        assert!(world.body(body).unwrap().angle() * step.signum() > 0.5, "it did not turn");
    }
}

/// A torque bound breaks a weld; a force bound that is not passed does not.
#[test]
fn a_weld_breaks_by_its_moment() {
    let hang = |torque: Real| {
        let mut world = World::new(vec2(0.0, -10.0)).unwrap();
        let body = Thrown {
            size: (1.0, 0.1),
            density: 10.0,
            place: vec2(0.5, 0.0),
            angle: 0.0,
            velocity: Vec2::zeros(),
            spin: 0.0,
        };
        let body = world.add_body(body.def()).unwrap();
        // 1 kg, ½ m out: 5 N·m.
        let def = JointDef::weld(None, body).at(Vec2::zeros());
        let breaking =
            JointDef { breaking_force: Some(11.0), breaking_torque: Some(torque), ..def };
        world.add_joint(breaking).unwrap();
        world.steps(DT, 10).unwrap();
        world.joints().len()
    };
    assert_eq!(hang(5.1), 1);
    assert_eq!(hang(4.9), 0);
}
