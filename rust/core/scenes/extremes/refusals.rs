//! What makes no sense is mended or refused, and never gets in.

use std::f64::consts::PI;

use crate::body::{BodyDef, Friction, Surface};
use crate::error::{Error, Result};
use crate::math::{Real, Vec2, Wrench, vec2};
use crate::scenes::gauge::at_most;
use crate::scenes::{Answer, Number, Reference, Scene};
use crate::shapes::Shape;
use crate::world::World;

pub static BAD_OUTLINES: Scene = Scene {
    id: "X9",
    name: "bad_outlines",
    title: "Duplicate, collinear, clockwise and self-crossing outlines",
    about: "Duplicate vertices, vertices on straight edges and the clockwise sense are mended: area 1 as of the unit square. Outlines that \
        cross, touch or fold back on themselves, have no area or are no numbers are refused with a message.",
    reference: Reference::Law,
    answer: Answer::Numbers(outlines),
    checks: &[],
};

type Points = &'static [(Real, Real)];

const MENDED: [(&str, Points); 4] = [
    ("clockwise", &[(0.0, 0.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0)]),
    (
        "duplicate",
        &[(0.0, 0.0), (0.0, 0.0), (1.0, 0.0), (1.0, 1.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.0)],
    ),
    (
        "collinear",
        &[(0.0, 0.0), (0.5, 0.0), (0.75, 0.0), (1.0, 0.0), (1.0, 1.0), (0.0, 1.0), (0.0, 0.5)],
    ),
    (
        "all three",
        &[(0.0, 0.0), (0.0, 0.5), (0.0, 1.0), (0.0, 1.0), (1.0, 1.0), (1.0, 0.0), (0.5, 0.0)],
    ),
];

const REFUSED: [Points; 9] = [
    &[],
    &[(0.0, 0.0), (1.0, 0.0)],
    &[(5.0, 5.0), (5.0, 5.0), (5.0, 5.0), (5.0, 5.0)],
    &[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)],
    &[(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)],
    &[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (4.0, 9.0), (4.0, 4.0), (0.0, 4.0)],
    &[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (2.0, 0.0), (0.0, 4.0)],
    &[(0.0, 0.0), (Real::NAN, 0.0), (1.0, 1.0)],
    &[(0.0, 0.0), (1.0, Real::INFINITY), (1.0, 1.0)],
];

fn outlines() -> Result<Vec<Number>> {
    let polygon = |points: Points| {
        Shape::polygon(&points.iter().map(|&(x, y)| vec2(x, y)).collect::<Vec<Vec2>>())
    };
    let mut numbers = Vec::new();
    for (how, points) in MENDED {
        let (what, value) = (format!("area of the square, {how}"), polygon(points)?.area());
        numbers.push(Number { what, value, exact: 1.0, asked: 1e-15 });
    }
    let let_in = REFUSED.iter().filter(|points| !refused(&polygon(points), "")).count();
    numbers.push(at_most("outlines let in or refused without a reason", let_in as Real, 0.0));
    Ok(numbers)
}

/// Whether something was refused, by a message that names it and says what is allowed.
fn refused<T>(result: &Result<T>, name: &str) -> bool {
    match result {
        Err(Error::Invalid { what, allowed, .. }) => what.contains(name) && !allowed.is_empty(),
        _ => false,
    }
}

pub static BAD_MATTER: Scene = Scene {
    id: "X11",
    name: "bad_matter",
    title: "Zero, infinite and undefined masses, inertias, forces, steps and the like",
    about: "Each is refused with a message that names it and says what is allowed, and the world is left to the bit as it was.",
    reference: Reference::Law,
    answer: Answer::Numbers(matter),
    checks: &[],
};

const NOT_FINITE: [Real; 3] = [Real::NAN, Real::INFINITY, -Real::INFINITY];

/// The name of a quantity, and what puts a number into it.
type Entry = (&'static str, fn(&mut World, Real) -> Result<()>);

/// Quantities that must be above 0.
const POSITIVE: [Entry; 6] = [
    ("mass", |w, x| add(w, BodyDef { mass: Some(x), ..BodyDef::default() })),
    ("inertia", |w, x| add(w, BodyDef { inertia: Some(x), ..BodyDef::point(1.0) })),
    ("mass", |w, x| edit(w, |body| body.set_mass(Some(x)))),
    ("inertia", |w, x| edit(w, |body| body.set_inertia(Some(x)))),
    ("dt", |w, x| w.step(x)),
    ("radius", |_, x| Shape::circle(x).map(drop)),
];

/// Quantities that must be finite.
const FINITE: [Entry; 12] = [
    ("force", |w, x| add(w, BodyDef { force: vec2(0.0, x), ..BodyDef::point(1.0) })),
    ("torque", |w, x| add(w, BodyDef { torque: x, ..BodyDef::point(1.0) })),
    ("position", |w, x| add(w, BodyDef { position: vec2(x, 0.0), ..BodyDef::point(1.0) })),
    ("velocity", |w, x| add(w, BodyDef { velocity: vec2(x, 0.0), ..BodyDef::point(1.0) })),
    ("angle", |w, x| add(w, BodyDef { angle: x, ..BodyDef::point(1.0) })),
    ("density", |w, x| add(w, BodyDef { density: x, ..BodyDef::point(1.0) })),
    ("restitution", |w, x| {
        let surface = Surface { restitution: x, ..Surface::default() };
        add(w, BodyDef { surface, ..BodyDef::point(1.0) })
    }),
    ("friction", |w, x| {
        let surface = Surface { friction: Friction::of(x), ..Surface::default() };
        add(w, BodyDef { surface, ..BodyDef::point(1.0) })
    }),
    ("force", |w, x| edit(w, |body| body.set_force(Wrench { force: vec2(x, 0.0), torque: 0.0 }))),
    ("force", |w, x| edit(w, |body| body.apply_force(vec2(x, 0.0), None))),
    ("impulse", |w, x| edit(w, |body| body.apply_impulse(vec2(x, 0.0), None))),
    ("gravity", |w, x| w.set_gravity(vec2(0.0, x))),
];

fn add(world: &mut World, def: BodyDef) -> Result<()> {
    world.add_body(def).map(drop)
}

fn edit(
    world: &mut World,
    change: impl FnOnce(&mut crate::world::BodyMut<'_>) -> Result<()>,
) -> Result<()> {
    let handle = world.bodies().handles()[0];
    change(&mut world.body_mut(handle)?)
}

fn matter() -> Result<Vec<Number>> {
    let mut world = World::default();
    world.add_body(BodyDef { angle: PI / 3.0, ..BodyDef::new(Shape::rectangle(1.0, 2.0)?) })?;
    world.steps(1.0 / 60.0, 10)?;
    let before = world.snapshot().to_bytes()?;
    let (mut let_in, mut changed) = (0.0, 0.0);
    let mut judge = |(name, put): Entry, x: Real| -> Result<()> {
        let_in += if refused(&put(&mut world, x), name) { 0.0 } else { 1.0 };
        changed += if world.snapshot().to_bytes()? == before { 0.0 } else { 1.0 };
        Ok(())
    };
    for entry in POSITIVE {
        for x in [0.0, -0.0, -1.0].into_iter().chain(NOT_FINITE) {
            judge(entry, x)?;
        }
    }
    for entry in FINITE {
        for x in NOT_FINITE {
            judge(entry, x)?;
        }
    }
    Ok(vec![
        at_most("numbers let in or refused without a reason", let_in, 0.0),
        at_most("refusals that changed the world", changed, 0.0),
    ])
}
