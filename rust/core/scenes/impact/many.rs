//! Many impacts.

use crate::body::{BodyDef, BodyKind};
use crate::error::Result;
use crate::math::{Real, Twist, Vec2, vec2};
use crate::scenes::stage::{DT, G, Random, TOLERANCE, at_fixed_step, smooth, with_tolerance};
use crate::scenes::{Answer, Number, Reference, Scene, weightless};
use crate::shapes::Shape;
use crate::world::World;

pub static GALPERIN: Scene = Scene {
    id: "C10",
    name: "galperin",
    title: "A heavy ball drives a light one against a wall, again and again",
    about: "Wall, 1 kg at rest, 100^N kg arriving, e = 1: the number of hits has the first digits of π, 3 and 31 for N = 0 and 1 (Galperin, Playing pool with π, 2003).",
    reference: Reference::ClosedForm,
    answer: Answer::Numbers(|| {
        galperin(&[(1.0, 3.0), (100.0, 31.0)], |world| world.steps(DT, 1200))
    }),
    checks: &[
        with_tolerance(
            "hits with 1, 100, 1e4 and 1e6 kg, off from 3, 31, 314 and 3141",
            0.0,
            || {
                Ok(of_pi()?
                    .iter()
                    .step_by(2)
                    .map(|n| (n.value - n.exact).abs())
                    .fold(0.0, Real::max))
            },
        ),
        with_tolerance("change of the energy", 1e-10, || {
            Ok(of_pi()?.iter().skip(1).step_by(2).map(|n| n.value.abs()).fold(0.0, Real::max))
        }),
    ],
};

/// The same to a tolerance, with more digits.
fn of_pi() -> Result<Vec<Number>> {
    let digits = [(1.0, 3.0), (1e2, 31.0), (1e4, 314.0), (1e6, 3141.0)];
    galperin(&digits, |world| world.advance(20.0, TOLERANCE).map(drop))
}

fn galperin(
    digits: &[(Real, Real)],
    run: impl Fn(&mut World) -> Result<()>,
) -> Result<Vec<Number>> {
    let mut numbers = Vec::new();
    for &(heavy, hits) in digits {
        let mut world = weightless()?;
        add_box(&mut world, vec2(-0.5, 0.0), [1.0, 10.0])?;
        for (x, v, mass) in [(2.0, 0.0, 1.0), (5.0, -1.0, heavy)] {
            world.add_body(BodyDef {
                position: vec2(x, 0.0),
                velocity: vec2(v, 0.0),
                mass: Some(mass),
                surface: smooth(1.0),
                ..BodyDef::new(Shape::circle(0.5)?)
            })?;
        }
        let before = world.energy()?.total();
        run(&mut world)?;
        let value = world.report().impacts as Real;
        let what = format!("hits with {heavy} kg");
        numbers.push(Number { what, value, exact: hits, asked: 0.0 });
        let value = world.energy()?.total() / before - 1.0;
        let what = format!("change of the energy with {heavy} kg");
        numbers.push(Number { what, value, exact: 0.0, asked: 1e-10 });
    }
    Ok(numbers)
}

fn add_box(world: &mut World, position: Vec2, [width, height]: [Real; 2]) -> Result<()> {
    let (kind, surface) = (BodyKind::Static, smooth(1.0));
    world.add_body(BodyDef {
        kind,
        position,
        surface,
        ..BodyDef::new(Shape::rectangle(width, height)?)
    })?;
    Ok(())
}

/// Half the width of the box that disks fly in (m).
const HALF: Real = 10.0;

/// n² disks of 0.6 m in a box of 20 × 20 m, at speeds up to 5 m/s each way.
fn disks_in_a_box(gravity: Real, (columns, rows): (u32, u32)) -> Result<World> {
    let mut world = World::new(vec2(0.0, -gravity))?;
    for side in [-1.0, 1.0] {
        add_box(&mut world, vec2(side * (HALF + 0.5), 0.0), [1.0, 2.0 * HALF + 2.0])?;
        add_box(&mut world, vec2(0.0, side * (HALF + 0.5)), [2.0 * HALF + 2.0, 1.0])?;
    }
    let mut random = Random(1);
    let place = |k: u32, of: u32| HALF * ((2.0 * Real::from(k) + 1.0) / Real::from(of) - 1.0);
    for row in 0..rows {
        for column in 0..columns {
            world.add_body(BodyDef {
                position: vec2(place(column, columns), place(row, rows)),
                velocity: vec2(random.between(-5.0, 5.0), random.between(-5.0, 5.0)),
                surface: smooth(1.0),
                ..BodyDef::new(Shape::circle(0.3)?)
            })?;
        }
    }
    Ok(world)
}

/// Largest change of the energy over a minute, of the kinetic energy at the start.
fn energy_over_a_minute(mut world: World) -> Result<Real> {
    let before = world.energy()?;
    let mut worst: Real = 0.0;
    for _ in 0..3600 {
        world.step(DT)?;
        worst = worst.max((world.energy()?.total() - before.total()).abs() / before.kinetic);
    }
    Ok(worst)
}

pub static BILLIARD: Scene = Scene {
    id: "C11",
    name: "elastic_disks",
    title: "200 elastic disks in a box for a minute",
    about: "Their energy stays what it is. With all velocities reversed they go back the way they came, for as long as rounding is not yet blown up: the first half of a second here.",
    reference: Reference::Law,
    answer: Answer::Numbers(|| Ok(Vec::new())),
    checks: &[
        at_fixed_step("change of the energy", 1e-3, || {
            energy_over_a_minute(disks_in_a_box(0.0, (20, 10))?)
        }),
        at_fixed_step("distance from the start, half a second there and back (m)", 1e-9, || {
            let mut world = disks_in_a_box(0.0, (20, 10))?;
            let start = world.bodies().poses.clone();
            world.steps(DT, 30)?;
            for body in world.bodies().handles().to_vec() {
                let twist = world.body(body)?.twist();
                if twist != Twist::ZERO {
                    world.body_mut(body)?.set_twist(Twist::new(-twist.linear, -twist.angular))?;
                }
            }
            world.steps(DT, 30)?;
            let ends = world.bodies().poses.iter().zip(&start);
            Ok(ends.map(|(end, start)| (end.position - start.position).norm()).fold(0.0, Real::max))
        }),
        with_tolerance("change of the energy", 1e-10, || {
            let mut world = disks_in_a_box(0.0, (20, 10))?;
            let before = world.energy()?.total();
            world.advance(60.0, TOLERANCE)?;
            Ok((world.energy()?.total() / before - 1.0).abs())
        }),
    ],
};

pub static GAS: Scene = Scene {
    id: "C11g",
    name: "elastic_gas",
    title: "A gas of 100 elastic disks keeps its energy for a minute, without weight and with it",
    about: "Energy stays what it is.",
    reference: Reference::Law,
    answer: Answer::Numbers(|| Ok(Vec::new())),
    checks: &[
        at_fixed_step("change of the energy, without weight", 1e-3, || {
            energy_over_a_minute(disks_in_a_box(0.0, (10, 10))?)
        }),
        at_fixed_step("change of the energy, under gravity", 1e-3, || {
            energy_over_a_minute(disks_in_a_box(G, (10, 10))?)
        }),
    ],
};
