//! A disk that strikes the ground at a slant, by every law of impact.

use crate::body::{BodyDef, ImpactLaw, Mixing, Rule};
use crate::error::Result;
use crate::math::{Pose, Real, vec2};
use crate::scenes::stage::{
    DT, TOLERANCE, add_ground, at_fixed_step, ground, rough, with_tolerance,
};
use crate::scenes::{Answer, Judged, Motion, Reference, Scene, Toleranced, weightless};
use crate::shapes::Shape;
use crate::world::World;

const RADIUS: Real = 0.5;
const RESTITUTION: Real = 0.8;
/// Height of the lowest point at the start (m), and when it is at the ground (s).
const HEIGHT: Real = 1.5;
const IMPACT: Real = 0.5;
/// Friction of the two disks, where they start (m), and their velocity (m/s) and spin (rad/s) after.
const DISKS: [(Real, Real, [Real; 3]); 2] =
    [(0.1, 0.0, [3.46, 2.4, -2.16]), (0.5, 20.0, [8.0 / 3.0, 2.4, -16.0 / 3.0])];

fn disks() -> Result<World> {
    let mut world = weightless()?;
    // The disk's own friction, against a ground that is rougher.
    world.set_mixing(Mixing { friction: Rule::Minimum, ..Mixing::default() })?;
    add_ground(&mut world, 0.0, rough(1.0))?;
    for (friction, x, _) in DISKS {
        let mut surface = rough(friction);
        surface.restitution = RESTITUTION;
        world.add_body(BodyDef {
            position: vec2(x, RADIUS + HEIGHT),
            velocity: vec2(4.0, -3.0),
            surface,
            ..BodyDef::new(Shape::circle(RADIUS)?)
        })?;
    }
    Ok(world)
}

/// Largest difference of the velocities after the impact from the exact ones (m/s, rad/s).
fn off_by(law: ImpactLaw, run: impl Fn(&mut World) -> Result<()>) -> Result<Real> {
    let mut world = disks()?;
    world.set_impact_law(law);
    run(&mut world)?;
    let mut worst: Real = 0.0;
    for (twist, (_, _, exact)) in world.bodies().twists[1..].iter().zip(DISKS) {
        let now = [twist.linear.x, twist.linear.y, twist.angular];
        worst = now.iter().zip(exact).map(|(v, exact)| (v - exact).abs()).fold(worst, Real::max);
    }
    Ok(worst)
}

pub static OBLIQUE: Scene = Scene {
    id: "C9",
    name: "oblique_impact",
    title: "A disk strikes rough ground at (4, −3) m/s, e = 0.8",
    about: "With μ = 0.1 it slides all through the impact: (3.46, 2.4) m/s and 2.16 rad/s; with μ = 0.5 it ends rolling: (8/3, 2.4) and 16/3. The centre lies on the normal, so that Newton's, Poisson's and Stronge's laws agree (Stronge, Impact Mechanics, 2000, ch. 3).",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: disks,
        exact: |t| {
            let disk = |(_, x, [vx, vy, spin]): &(Real, Real, [Real; 3])| {
                let (before, after) = (t.min(IMPACT), (t - IMPACT).max(0.0));
                let way = vec2(4.0, -3.0) * before + vec2(*vx, *vy) * after;
                Pose::new(vec2(*x, RADIUS + HEIGHT) + way, spin * after)
            };
            std::iter::once(ground(0.0)).chain(DISKS.iter().map(disk)).collect()
        },
        duration: 1.0,
        dt: DT,
        length: 4.0,
        fixed: 1e-3,
        toleranced: Some(Toleranced { tolerance: TOLERANCE, error: 1e-12 }),
        judged: Judged::Contact { order: false },
    }),
    checks: &[
        at_fixed_step("velocity and spin after, Newton's law", 1e-3, || {
            off_by(ImpactLaw::Newton, |world| world.steps(DT, 60))
        }),
        at_fixed_step("velocity and spin after, Poisson's law", 1e-3, || {
            off_by(ImpactLaw::Poisson, |world| world.steps(DT, 60))
        }),
        at_fixed_step("velocity and spin after, Stronge's law", 1e-3, || {
            off_by(ImpactLaw::Stronge, |world| world.steps(DT, 60))
        }),
        with_tolerance("velocity and spin after, by all laws", 1e-12, || {
            let mut worst: Real = 0.0;
            for (_, law) in ImpactLaw::ALL {
                worst = worst.max(off_by(law, |world| world.advance(1.0, TOLERANCE).map(drop))?);
            }
            Ok(worst)
        }),
    ],
};
