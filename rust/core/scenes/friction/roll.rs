//! Disks that roll.

use crate::body::{BodyDef, Mixing, Rule};
use crate::error::Result;
use crate::math::{Pose, Real, atan2};
use crate::scenes::stage::{
    DT, G, HALF, TOLERANCE, add_ground, at_fixed_step, ground, heavy, on_plane, rough, standing,
    threshold, threshold_to, with_tolerance,
};
use crate::scenes::{Answer, Judged, Motion, Reference, Scene, Toleranced};
use crate::shapes::Shape;
use crate::world::World;

const RADIUS: Real = 0.5;

/// Where a disk is that has gone this way along a plane and turned by this angle, forwards above 0.
fn disk(slope: Real, way: Real, turn: Real) -> Pose {
    on_plane(slope, [way, RADIUS], -turn)
}

/// Disks on a plane, each with its friction, place along it, and speed.
fn disks(slope: Real, disks: &[[Real; 3]]) -> Result<World> {
    let mut world = heavy()?;
    // The disk's own friction, against a ground that is rougher.
    world.set_mixing(Mixing { friction: Rule::Minimum, ..Mixing::default() })?;
    add_ground(&mut world, slope, rough(1.0))?;
    for [friction, way, speed] in disks {
        let place = disk(slope, *way, 0.0);
        let velocity = on_plane(slope, [*speed, 0.0], 0.0).position;
        let def = standing(Shape::circle(RADIUS)?, place, rough(*friction));
        world.add_body(BodyDef { velocity, ..def })?;
    }
    Ok(world)
}

/// Friction of a disk that rolls and of one that slides, a little above and below 1/6, and their places (m).
const FRICTIONS: [Real; 2] = [0.17, 0.16];
const PLACES: [Real; 2] = [0.0, -20.0];

pub static ROLLING: Scene = Scene {
    id: "F5",
    name: "rolling_disk",
    title: "A disk on an incline rolls, or slides where friction is too little",
    about: "With tan α = ½ it rolls iff μ ≥ tan α/3 = 1/6, at ⅔g sin α = 2.92477691457 m/s²; else it goes at g(sin α − μ cos α) and turns at 2μg cos α/r.",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: || {
            let start = |k: usize| [FRICTIONS[k], PLACES[k], 0.0];
            disks(atan2(HALF, 1.0), &[start(0), start(1)])
        },
        exact: |t| {
            let slope = atan2(HALF, 1.0);
            let cos = 1.0 / libm::sqrt(1.0 + HALF * HALF);
            let (half, weight) = (0.5 * t * t, G * cos);
            let rolled = HALF * weight * 2.0 / 3.0 * half;
            let slid = weight * (HALF - FRICTIONS[1]) * half;
            let turned = 2.0 * FRICTIONS[1] * weight / RADIUS * half;
            vec![
                ground(slope),
                disk(slope, PLACES[0] + rolled, rolled / RADIUS),
                disk(slope, PLACES[1] + slid, turned),
            ]
        },
        duration: 3.0,
        dt: DT,
        length: 13.0,
        fixed: 1e-4,
        toleranced: Some(Toleranced { tolerance: TOLERANCE, error: 1e-11 }),
        judged: Judged::Contact { order: true },
    }),
    checks: &[
        at_fixed_step("acceleration against 2.92477691457 m/s², relative", 1e-4, || {
            let mut world = disks(atan2(HALF, 1.0), &[[0.17, 0.0, 0.0]])?;
            world.steps(DT, 120)?;
            Ok((world.bodies().twists[1].linear.norm() / 2.0 / 2.924_776_914_57 - 1.0).abs())
        }),
        at_fixed_step("least friction with which it rolls against 1/6, relative", 1e-4, || {
            let rolls = |friction: Real| rolls(friction, |world| world.steps(DT, 60));
            Ok((6.0 * threshold([0.1, 0.3], rolls)? - 1.0).abs())
        }),
        with_tolerance("least friction with which it rolls against 1/6, relative", 1e-8, || {
            let rolls =
                |friction: Real| rolls(friction, |world| world.advance(1.0, TOLERANCE).map(drop));
            Ok((6.0 * threshold_to(32, [0.1, 0.3], rolls)? - 1.0).abs())
        }),
    ],
};

/// Whether a disk rolls down the incline: whether its slip is rounding.
fn rolls(friction: Real, run: impl Fn(&mut World) -> Result<()>) -> Result<bool> {
    let mut world = disks(atan2(HALF, 1.0), &[[friction, 0.0, 0.0]])?;
    run(&mut world)?;
    let twist = &world.bodies().twists[1];
    let slip = twist.linear.norm() + twist.angular * RADIUS;
    Ok(slip.abs() < 1e-9 * twist.linear.norm())
}

/// Start (m/s) and friction; when it begins to roll (s).
const SPEED: Real = 10.0;
const FRICTION: Real = 0.5;
const ROLLS: Real = SPEED / (3.0 * FRICTION * G);

pub static SLIDE_TO_ROLL: Scene = Scene {
    id: "F6",
    name: "slide_to_roll",
    title: "A disk that slides at 10 m/s begins to roll, μ = 0.5",
    about: "At t = v/3μg = 0.679578661230 s and x = 5.66315551025 m, at ⅔v = 20/3 m/s.",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: || disks(0.0, &[[FRICTION, 0.0, SPEED]]),
        exact: |t| {
            let (sliding, rolling) = (t.min(ROLLS), (t - ROLLS).max(0.0));
            let half = 0.5 * sliding * sliding;
            let rolled = SPEED * 2.0 / 3.0 * rolling;
            let way = SPEED * sliding - FRICTION * G * half + rolled;
            let turn = 2.0 * FRICTION * G / RADIUS * half + rolled / RADIUS;
            vec![ground(0.0), disk(0.0, way, turn)]
        },
        duration: 1.5,
        dt: DT,
        length: 11.0,
        fixed: 1e-3,
        toleranced: Some(Toleranced { tolerance: TOLERANCE, error: 1e-10 }),
        judged: Judged::Contact { order: false },
    }),
    checks: &[
        at_fixed_step("speed of rolling against 20/3 m/s, relative", 1e-3, || {
            let mut world = disks(0.0, &[[FRICTION, 0.0, SPEED]])?;
            world.steps(DT, 60)?;
            Ok((world.bodies().twists[1].linear.x / (20.0 / 3.0) - 1.0).abs())
        }),
        at_fixed_step("slip when it rolls, of 10 m/s", 1e-3, || {
            let mut world = disks(0.0, &[[FRICTION, 0.0, SPEED]])?;
            world.steps(DT, 60)?;
            let twist = &world.bodies().twists[1];
            Ok((twist.linear.x + twist.angular * RADIUS).abs() / SPEED)
        }),
    ],
};
