//! Boxes that tip over.

use crate::body::BodyDef;
use crate::error::Result;
use crate::math::{Real, atan2, vec2};
use crate::scenes::stage::{
    DT, G, TOLERANCE, add_ground, heavy, on_plane, rough, standing, threshold, threshold_to,
    with_tolerance,
};
use crate::scenes::{Answer, Number, Reference, Scene};
use crate::shapes::Shape;
use crate::world::World;

/// Width and height of the box (m), and what counts as having tipped (rad) or slid (m) after 5 s.
const WIDTH: Real = 0.5;
const HEIGHT: Real = 1.0;
const MOVED: Real = 1e-3;

/// A box of 1 kg on a plane, under a force along it at its centre and a torque.
fn upright(slope: Real, friction: Real, [force, torque]: [Real; 2]) -> Result<World> {
    let mut world = heavy()?;
    add_ground(&mut world, slope, rough(friction))?;
    let place = on_plane(slope, [0.0, 0.5 * HEIGHT], 0.0);
    let def = standing(Shape::rectangle(WIDTH, HEIGHT)?, place, rough(friction));
    let force = on_plane(slope, [force, 0.0], 0.0).position;
    world.add_body(BodyDef { mass: Some(1.0), force, torque, ..def })?;
    Ok(world)
}

/// Angle (rad) by which the box has turned after 5 s, or as soon as it has tipped, and how far it went (m).
fn moved(mut world: World) -> Result<[Real; 2]> {
    let start = world.bodies().poses[1];
    let mut moved = [0.0; 2];
    for _ in 0..300 {
        world.step(DT)?;
        let now = world.bodies().poses[1];
        moved = [(now.angle - start.angle).abs(), (now.position - start.position).norm()];
        if moved[0] > MOVED {
            break;
        }
    }
    Ok(moved)
}

/// The same to a tolerance after 2 s: what stays has not moved at all.
fn moved_at_all(mut world: World) -> Result<[Real; 2]> {
    let start = world.bodies().poses[1];
    world.advance(2.0, TOLERANCE)?;
    let now = world.bodies().poses[1];
    Ok([(now.angle - start.angle).abs(), (now.position - start.position).norm()])
}

/// What counts as having moved at all (rad, m): far above rounding, far below what a millionth beyond a threshold does in 2 s.
const AT_ALL: Real = 1e-8;

pub static TIPPING: Scene = Scene {
    id: "F8",
    name: "tipping_box",
    title: "A box b × h on an incline tips over",
    about: "It tips iff tan α > b/h.",
    reference: Reference::ClosedForm,
    answer: Answer::Numbers(|| {
        let tips =
            |tangent: Real| Ok(moved(upright(atan2(tangent, 1.0), 2.0, [0.0; 2])?)?[0] > MOVED);
        let value = threshold([0.2, 1.0], tips)?;
        let what = "tan α at which a box 0.5 × 1 tips".into();
        Ok(vec![Number { what, value, exact: WIDTH / HEIGHT, asked: 1e-2 }])
    }),
    checks: &[with_tolerance("tan α at which a box 0.5 × 1 tips, relative", 1e-6, || {
        let tips = |tangent: Real| {
            Ok(moved_at_all(upright(atan2(tangent, 1.0), 2.0, [0.0; 2])?)?[0] > AT_ALL)
        };
        Ok((threshold_to(24, [0.2, 1.0], tips)? / (WIDTH / HEIGHT) - 1.0).abs())
    })],
};

/// Height at which the box is pushed (m).
const PUSHED_AT: Real = 0.9;

/// A force there, as one at the centre and a torque.
fn push(force: Real) -> [Real; 2] {
    [force, -force * (PUSHED_AT - 0.5 * HEIGHT)]
}

pub static PUSHED_BOX: Scene = Scene {
    id: "F9",
    name: "pushed_box",
    title: "A box pushed at a height H tips or slides",
    about: "It tips iff F > mgb/2H, and slides iff F > μmg.",
    reference: Reference::ClosedForm,
    answer: Answer::Numbers(|| {
        let tips = |force: Real| Ok(moved(upright(0.0, 1.0, push(force))?)?[0] > MOVED);
        let slides = |force: Real| {
            let [turn, way] = moved(upright(0.0, 0.2, push(force))?)?;
            Ok(way > MOVED && turn < MOVED)
        };
        let number = |what: &str, value: Real, exact: Real| Number {
            what: what.to_owned(),
            value,
            exact,
            asked: 1e-2,
        };
        Ok(vec![
            number(
                "force at 0.9 m at which a box 0.5 × 1 of 1 kg tips (N), μ = 1",
                threshold([0.1 * G, 0.6 * G], tips)?,
                G * WIDTH / (2.0 * PUSHED_AT),
            ),
            number(
                "force at which it slides (N), μ = 0.2",
                threshold([0.1 * G, 0.26 * G], slides)?,
                0.2 * G,
            ),
        ])
    }),
    checks: &[
        with_tolerance("force at 0.9 m at which it tips, relative, μ = 1", 1e-6, || {
            let tips = |force: Real| Ok(moved_at_all(upright(0.0, 1.0, push(force))?)?[0] > AT_ALL);
            let exact = G * WIDTH / (2.0 * PUSHED_AT);
            Ok((threshold_to(24, [0.1 * G, 0.6 * G], tips)? / exact - 1.0).abs())
        }),
        with_tolerance("force at which it slides, relative, μ = 0.2", 1e-6, || {
            let slides = |force: Real| {
                let [turn, way] = moved_at_all(upright(0.0, 0.2, push(force))?)?;
                Ok(way > AT_ALL && turn < AT_ALL)
            };
            Ok((threshold_to(24, [0.1 * G, 0.26 * G], slides)? / (0.2 * G) - 1.0).abs())
        }),
    ],
};

/// Width of a domino of 1 m, and how many there are.
const DOMINO: Real = 0.1;
const COUNT: u32 = 8;

/// How many dominoes have fallen 8 s after the first was pushed.
fn fallen(gap: Real) -> Result<u32> {
    let mut world = heavy()?;
    add_ground(&mut world, 0.0, rough(0.5))?;
    for k in 0..COUNT {
        let place = on_plane(0.0, [Real::from(k) * (gap + DOMINO), 0.5], 0.0);
        let mut def = standing(Shape::rectangle(DOMINO, 1.0)?, place, rough(0.5));
        if k == 0 {
            // About its lower right corner.
            (def.angular_velocity, def.velocity) = (-2.0, vec2(1.0, DOMINO));
        }
        world.add_body(def)?;
    }
    world.steps(DT, 480)?;
    let over = |pose: &&crate::math::Pose| pose.angle.abs() > 0.5;
    Ok(world.bodies().poses.iter().filter(over).count() as u32)
}

pub static DOMINOES: Scene = Scene {
    id: "K8",
    name: "dominoes",
    title: "Eight dominoes, half a height apart and more than a height apart",
    about: "The first does not reach the second where the gap is above the height, and the wave passes at half of it.",
    reference: Reference::ClosedForm,
    answer: Answer::Numbers(|| {
        let number = |what: &str, gap: Real, exact: u32| {
            let what = format!("dominoes fallen at a gap of {gap} {what}");
            Ok(Number { what, value: Real::from(fallen(gap)?), exact: exact.into(), asked: 0.0 })
        };
        Ok(vec![
            number("heights", 0.5, COUNT)?,
            number("heights", 1.05, 1)?,
            number("heights", 1.5, 1)?,
        ])
    }),
    checks: &[],
};
