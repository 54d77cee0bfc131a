//! Motors, brakes and ratchets: forces and torques with bounds.

use super::{BOUNDED, disk, pin, rod};
use crate::body::{BodyDef, BodyHandle};
use crate::error::Result;
use crate::joint::{Given, Hold, JointDef, JointKind, Motor, Travel};
use crate::math::{Pose, Real, Vec2, vec2};
use crate::scenes::gauge::at_most;
use crate::scenes::stage::{DT, G, at_fixed_step, heavy};
use crate::scenes::{Answer, Judged, Motion, Number, Reference, Scene, at, weightless};
use crate::world::World;

/// Mass (kg) and inertia (kg·m²) of the disk, bound of its motor (N·m), and the speed it is brought to (rad/s).
const HEAVY: Real = 4.0;
const INERTIA: Real = 0.5;
const TORQUE: Real = 1.5;
const SPEED: Real = 20.0;

/// A disk on a pin whose motor may use so much torque.
fn motored(max: Real) -> Result<World> {
    let mut world = weightless()?;
    let body = world.add_body(disk(0.5, HEAVY, Vec2::zeros())?)?;
    let motor = Some(Motor { speed: SPEED, max: Some(max) });
    let kind = JointKind::Revolute { angle: None, travel: Travel { motor, ..Travel::default() } };
    world.add_joint(JointDef::new(None, body, kind))?;
    Ok(world)
}

pub static MOTOR: Scene = Scene {
    id: "J9",
    name: "motor_with_bounded_torque",
    title: "A motor of 1.5 N·m spins up a disk",
    about: "ω = τt/I until the speed that it is to have, then that.",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: || motored(TORQUE),
        exact: |t| vec![Pose::new(Vec2::zeros(), 0.5 * TORQUE / INERTIA * t * t)],
        duration: 4.0,
        dt: DT,
        length: 0.5,
        fixed: 1e-10,
        toleranced: None,
        judged: BOUNDED,
    }),
    checks: &[
        at_fixed_step("speed in the end, relative", 1e-12, || {
            let mut world = motored(TORQUE)?;
            world.steps(DT, 600)?;
            Ok((world.bodies().twists[0].angular / SPEED - 1.0).abs())
        }),
        at_fixed_step("largest torque above the bound, relative", 1e-12, || {
            let mut world = motored(TORQUE)?;
            let joint = world.joint_handles()[0];
            let mut most: Real = 0.0;
            for _ in 0..600 {
                world.step(DT)?;
                most = most.max(world.joint(joint)?.reaction().torque.abs());
            }
            Ok((most / TORQUE - 1.0).max(0.0))
        }),
    ],
};

/// Bound (N), mass (kg) and inclination (as tan α = ¾) of the slider that a motor lifts.
const PUSH: Real = 20.0;
const SLED: Real = 2.0;
const UP: Vec2 = vec2(0.8, 0.6);

fn slider() -> Result<(World, BodyHandle)> {
    let mut world = heavy()?;
    let body = world.add_body(rod(0.5, SLED, Vec2::zeros())?)?;
    let motor = Some(Motor { speed: 6.0, max: Some(PUSH) });
    let travel = Travel { motor, limits: Some([-1.0, 10.0]), ..Travel::default() };
    let kind = JointKind::Prismatic { axis: Given::World(UP), angle: None, travel };
    world.add_joint(JointDef::new(None, body, kind))?;
    Ok((world, body))
}

pub static SLIDER: Scene = Scene {
    id: "J8",
    name: "prismatic_motor",
    title: "A motor of 20 N lifts 2 kg along a slider of slope ¾, to a limit at 10 m",
    about: "½(F/m − g sin α)t² until its speed is reached; in the end it stands at the limit.",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: || Ok(slider()?.0),
        exact: |t| {
            let way = UP * (0.5 * (PUSH / SLED - G * UP.y) * t * t);
            vec![at(way.x, way.y)]
        },
        duration: 1.25,
        dt: DT,
        length: 1.0,
        fixed: 1e-10,
        toleranced: None,
        judged: BOUNDED,
    }),
    checks: &[
        at_fixed_step("speed once it is reached, relative", 1e-10, || {
            let (mut world, body) = slider()?;
            world.steps(DT, 120)?;
            Ok((world.body(body)?.velocity() - UP * 6.0).norm() / 6.0)
        }),
        at_fixed_step("off the limit in the end (m)", 1e-9, || {
            let (mut world, body) = slider()?;
            world.steps(DT, 300)?;
            Ok((world.body(body)?.position() - UP * 10.0).norm())
        }),
    ],
};

/// A disk on a ratchet with notches 0.3 rad apart, turned to 1 rad and then driven back for 5 s. Its angle and speed.
fn ratchet() -> Result<[Real; 2]> {
    let mut world = weightless()?;
    let def = BodyDef { angular_velocity: 2.0, ..disk(0.5, HEAVY, Vec2::zeros())? };
    let body = world.add_body(def)?;
    pin(&mut world, None, body, Vec2::zeros())?;
    world.add_joint(JointDef::new(None, body, JointKind::Ratchet { step: 0.3, phase: 0.0 }))?;
    world.steps(DT, 30)?;
    world.body_mut(body)?.set_force(crate::math::Wrench::new(Vec2::zeros(), -TORQUE))?;
    world.steps(DT, 300)?;
    Ok([world.body(body)?.angle(), world.body(body)?.angular_velocity()])
}

pub static RATCHET: Scene = Scene {
    id: "J10",
    name: "ratchet",
    title: "A ratchet with notches 0.3 rad apart, turned forward by hand and driven back by a torque",
    about: "It turns forward freely, and back only to the last notch that it has passed.",
    reference: Reference::ClosedForm,
    answer: Answer::Numbers(|| {
        let [angle, speed] = ratchet()?;
        // At 2 rad/s it is at 1 rad after ½ s; the torque takes it on to 1 + ω²I/2τ = 5/3 rad, past the notch at 1.5.
        Ok(vec![
            Number { what: "where it rests (rad)".into(), value: angle, exact: 1.5, asked: 1e-9 },
            at_most("its speed there (rad/s)", speed.abs(), 1e-9),
        ])
    }),
    checks: &[],
};

/// Bounds of the friction joint (N, N·m), mass and first motion of what it brakes.
const GRIP: (Real, Real) = (3.0, 0.4);
const THROWN: (Real, Real) = (4.0, 3.0);

/// A disk that a friction joint brakes; thrown askew.
fn braked() -> Result<(World, BodyHandle)> {
    let mut world = weightless()?;
    let body = world.add_body(BodyDef {
        velocity: vec2(0.6, 0.8) * THROWN.0,
        angular_velocity: THROWN.1,
        ..disk(0.5, HEAVY, Vec2::zeros())?
    })?;
    let kind = JointKind::Friction { max_force: GRIP.0, max_torque: GRIP.1 };
    world.add_joint(JointDef::new(None, body, kind))?;
    Ok((world, body))
}

pub static FRICTION: Scene = Scene {
    id: "J11",
    name: "friction_joint",
    title: "A friction joint brings a disk to rest that moves and spins",
    about: "Straight on, with F/m and τ/I, to rest after mv²/2F and Iω²/2τ.",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: || Ok(braked()?.0),
        exact: |t| {
            let stop = |speed: Real, brake: Real| {
                let t = t.min(speed / brake);
                speed * t - 0.5 * brake * t * t
            };
            let way = vec2(0.6, 0.8) * stop(THROWN.0, GRIP.0 / HEAVY);
            vec![Pose::new(way, stop(THROWN.1, GRIP.1 / INERTIA))]
        },
        duration: 8.0,
        dt: DT,
        length: 10.0,
        // As F3, friction on the ground.
        fixed: 1e-4,
        toleranced: None,
        judged: Judged::Contact { order: false },
    }),
    checks: &[at_fixed_step("speed at rest, |v| + |ω|", 1e-12, || {
        let (mut world, body) = braked()?;
        world.steps(DT, 480)?;
        let body = world.body(body)?;
        Ok(body.velocity().norm() + body.angular_velocity().abs())
    })],
};

/// Bound of the grab joint (N), and how far above it draws to (m).
const PULL: Real = 30.0;

/// 2 kg at rest that a hard grab joint lifts to a height.
fn lifted(height: Real) -> Result<World> {
    let mut world = heavy()?;
    let body = world.add_body(BodyDef::point(SLED))?;
    let kind = JointKind::Grab { hold: Hold::Rigid, max_force: Some(PULL) };
    let joint = JointDef::new(None, body, kind);
    world.add_joint(joint.anchored_locally(vec2(0.0, height), Vec2::zeros()))?;
    Ok(world)
}

pub static BOUNDED_GRAB: Scene = Scene {
    id: "J14",
    name: "bounded_grab",
    title: "A hard grab joint of at most 30 N lifts 2 kg",
    about: "While the point is far it draws with all it has, ½(F/m − g)t²; it brakes in time, and holds.",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: || lifted(100.0),
        exact: |t| vec![at(0.0, 0.5 * (PULL / SLED - G) * t * t)],
        duration: 2.0,
        dt: DT,
        length: 1.0,
        fixed: 1e-10,
        toleranced: None,
        judged: BOUNDED,
    }),
    checks: &[
        // As Q4.
        at_fixed_step("offset once it holds (m)", 1e-6, || {
            let mut world = lifted(5.0)?;
            world.steps(DT, 600)?;
            Ok((world.bodies().poses[0].position - vec2(0.0, 5.0)).norm())
        }),
        at_fixed_step("largest force above the bound, relative", 1e-12, || {
            let mut world = lifted(5.0)?;
            let joint = world.joint_handles()[0];
            let mut most: Real = 0.0;
            for _ in 0..600 {
                world.step(DT)?;
                most = most.max(world.joint(joint)?.reaction().force.norm());
            }
            Ok((most / PULL - 1.0).max(0.0))
        }),
    ],
};
