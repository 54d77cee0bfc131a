//! Balls that are dropped.

use crate::body::{BodyDef, Surface};
use crate::error::Result;
use crate::math::{Pose, Real, vec2};
use crate::scenes::stage::{
    DT, G, TOLERANCE, add_ground, at_fixed_step, ground, heavy, smooth, with_tolerance,
};
use crate::scenes::{Answer, Judged, Motion, Reference, Scene, Toleranced, at};
use crate::shapes::Shape;
use crate::world::World;

const RADIUS: Real = 0.1;

/// Balls side by side, each with its restitution, dropped from this height under their lowest points.
fn dropped(height: Real, restitutions: &[Real]) -> Result<World> {
    let mut world = heavy()?;
    add_ground(&mut world, 0.0, Surface::default())?;
    for (k, restitution) in restitutions.iter().enumerate() {
        world.add_body(BodyDef {
            position: vec2(k as Real, RADIUS + height),
            surface: smooth(*restitution),
            ..BodyDef::new(Shape::circle(RADIUS)?)
        })?;
    }
    Ok(world)
}

/// Height over the ground at a time, dropped from `start`.
fn height(start: Real, restitution: Real, t: Real) -> Real {
    let first = libm::sqrt(2.0 * start / G);
    if t < first {
        return start - 0.5 * G * t * t;
    }
    let (mut since, mut speed) = (t - first, restitution * G * first);
    while speed > 1e-12 * G * first {
        let flight = 2.0 * speed / G;
        if since < flight {
            return since * (speed - 0.5 * G * since);
        }
        since -= flight;
        speed *= restitution;
    }
    0.0
}

/// The ground, then the balls.
fn poses(start: Real, restitutions: &[Real], t: Real) -> Vec<Pose> {
    let ball = |(k, e): (usize, &Real)| at(k as Real, RADIUS + height(start, *e, t));
    std::iter::once(ground(0.0)).chain(restitutions.iter().enumerate().map(ball)).collect()
}

/// Restitutions of the three balls, and when each has come to rest (s).
const RESTITUTIONS: [Real; 3] = [0.5, 0.8, 0.9];
const RESTS: [Real; 3] = [1.354_570_922_96, 4.063_712_768_87, 8.578_949_178_73];

pub static DROPS: Scene = Scene {
    id: "C1",
    name: "drops",
    title: "Balls dropped from 1 m come to rest, restitution 0.5, 0.8 and 0.9",
    about: "First at the ground at √(2h/g) = 0.451523640986 s; the k-th top is e²ᵏh; at rest after √(2h/g)·(1 + e)/(1 − e), infinitely many bounces later.",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: || dropped(1.0, &RESTITUTIONS),
        exact: |t| poses(1.0, &RESTITUTIONS, t),
        duration: 10.0,
        dt: DT,
        length: 1.0,
        fixed: 1e-2,
        toleranced: Some(Toleranced { tolerance: TOLERANCE, error: 1e-9 }),
        judged: Judged::Contact { order: false },
    }),
    checks: &[
        at_fixed_step("time to rest against 1.3546, 4.0637 and 8.5789 s, relative", 2e-2, || {
            let mut last: [Real; 3] = [0.0; 3];
            for_each_step(|world| {
                for (k, last) in last.iter_mut().enumerate() {
                    let speed = world.bodies().twists[k + 1].linear.norm();
                    let moves = speed > 1e-6 || height_now(world, k) > 1e-6;
                    *last = if moves { world.time() } else { *last };
                }
            })?;
            Ok(worst(last.iter().zip(&RESTS).map(|(time, exact)| time / exact - 1.0)))
        }),
        at_fixed_step("heights of the tops against e²ᵏ h, of h", 1e-2, || {
            let mut tops: [Vec<Real>; 3] = Default::default();
            let mut before = [[1.0; 2]; 3];
            for_each_step(|world| {
                for (k, [older, old]) in before.iter_mut().enumerate() {
                    let now = height_now(world, k);
                    if *old > *older && *old > now {
                        tops[k].push(*old);
                    }
                    [*older, *old] = [*old, now];
                }
            })?;
            let off = tops.iter().zip(RESTITUTIONS).flat_map(|(tops, e)| {
                tops.iter().zip(1_u32..).map(move |(top, k)| top - libm::pow(e, Real::from(2 * k)))
            });
            Ok(worst(off))
        }),
        with_tolerance("moments of the first 20 bounces of each, relative", 1e-10, || {
            let mut world = dropped(1.0, &RESTITUTIONS)?;
            world.advance(10.0, TOLERANCE)?;
            let hits = &world.events().hit;
            let off = (1..=3).flat_map(|k| {
                let body = world.bodies().handles()[k];
                let own = hits.iter().filter(move |hit| hit.bodies.contains(&body));
                let e = RESTITUTIONS[k - 1];
                let exact = bounces(1.0, e).take(20);
                own.map(|hit| hit.time).zip(exact).map(|(time, exact)| time / exact - 1.0)
            });
            Ok(worst(off))
        }),
        with_tolerance("speed left a billionth after coming to rest (m/s)", 0.0, || {
            let mut left: Real = 0.0;
            for (k, rest) in RESTS.iter().enumerate() {
                let mut world = dropped(1.0, &RESTITUTIONS)?;
                world.advance(rest * (1.0 + 1e-9), TOLERANCE)?;
                left = left.max(world.bodies().twists[k + 1].linear.norm());
            }
            Ok(left)
        }),
    ],
};

/// Moments at which a ball that is dropped from a height meets the ground.
fn bounces(height: Real, restitution: Real) -> impl Iterator<Item = Real> {
    let first = libm::sqrt(2.0 * height / G);
    let mut flight = 2.0 * first;
    std::iter::successors(Some(first), move |time| {
        flight *= restitution;
        Some(time + flight)
    })
}

fn height_now(world: &World, k: usize) -> Real {
    world.bodies().poses[k + 1].position.y - RADIUS
}

fn for_each_step(mut look: impl FnMut(&World)) -> Result<()> {
    let mut world = dropped(1.0, &RESTITUTIONS)?;
    for _ in 0..600 {
        world.step(DT)?;
        look(&world);
    }
    Ok(())
}

fn worst(numbers: impl Iterator<Item = Real>) -> Real {
    numbers.map(Real::abs).fold(0.0, Real::max)
}

pub static ELASTIC_BALL: Scene = Scene {
    id: "C2",
    name: "elastic_ball",
    title: "A ball that keeps all its energy, dropped from 5 m for 20 s",
    about: "It meets the ground every 2√(2h/g) and is back at h in between; its energy stays what it is.",
    reference: Reference::ClosedForm,
    answer: Answer::Motion(Motion {
        build: || dropped(5.0, &[1.0]),
        exact: |t| poses(5.0, &[1.0], t),
        duration: 20.0,
        dt: DT,
        length: 5.0,
        fixed: 1e-12,
        toleranced: Some(Toleranced { tolerance: TOLERANCE, error: 1e-12 }),
        judged: Judged::Contact { order: false },
    }),
    checks: &[
        at_fixed_step("change of the energy, largest over the steps", 1e-12, || {
            let mut world = dropped(5.0, &[1.0])?;
            let before = world.energy()?.total();
            let mut worst: Real = 0.0;
            for _ in 0..1200 {
                world.step(DT)?;
                worst = worst.max((world.energy()?.total() / before - 1.0).abs());
            }
            Ok(worst)
        }),
        with_tolerance("change of the energy, largest over the samples", 1e-12, || {
            let mut world = dropped(5.0, &[1.0])?;
            let before = world.energy()?.total();
            let mut worst: Real = 0.0;
            for _ in 0..200 {
                world.advance(0.1, TOLERANCE)?;
                worst = worst.max((world.energy()?.total() / before - 1.0).abs());
            }
            Ok(worst)
        }),
        with_tolerance("moments of the bounces, relative", 1e-10, || {
            let mut world = dropped(5.0, &[1.0])?;
            world.advance(20.0, TOLERANCE)?;
            let hits = &world.events().hit;
            if hits.len() != 10 {
                return Ok(Real::INFINITY);
            }
            Ok(worst(hits.iter().zip(bounces(5.0, 1.0)).map(|(hit, exact)| hit.time / exact - 1.0)))
        }),
    ],
};
