//! Time reversal: what a conservative motion must be able to do.

use super::{Answer, Number, Reference, Scene, weightless};
use crate::body::BodyDef;
use crate::error::Result;
use crate::forces::Attraction;
use crate::math::{Real, Twist, vec2};
use crate::methods::REGISTRY;
use crate::world::World;

pub static THREE_BODIES: Scene = Scene {
    id: "S19",
    name: "reversal",
    title: "Three bodies that attract one another: there, velocities reversed, and back",
    about: "A conservative motion run for 3 s, then with reversed velocities for 3 s more, is back at its start.",
    reference: Reference::Law,
    answer: Answer::Numbers(numbers),
    checks: &[],
};

fn numbers() -> Result<Vec<Number>> {
    let mut numbers = Vec::new();
    for method in REGISTRY.iter().map(|method| method.facts()).filter(|facts| facts.reversible) {
        let value = there_and_back(|world| {
            world.set_method(method.name)?;
            world.steps(1.0 / 60.0, 180)
        })?;
        let what = format!("distance from the start at a fixed step, {}", method.name);
        numbers.push(Number { what, value, exact: 0.0, asked: 1e-10 });
    }
    let value = there_and_back(|world| world.advance(3.0, 1e-12).map(drop))?;
    let what = "distance from the start with a tolerance".into();
    numbers.push(Number { what, value, exact: 0.0, asked: 1e-9 });
    Ok(numbers)
}

fn three_bodies() -> Result<World> {
    let mut world = weightless()?;
    world.add_field(Attraction { strength: 1.0, exponent: -2.0, softening: 0.0 });
    let bodies = [
        (1.0, vec2(0.0, 0.0), vec2(0.0, -0.2)),
        (0.5, vec2(1.0, 0.1), vec2(0.1, 1.1)),
        (0.25, vec2(-1.5, 0.4), vec2(-0.2, -0.8)),
    ];
    for (mass, position, velocity) in bodies {
        world.add_body(BodyDef { position, velocity, ..BodyDef::point(mass) })?;
    }
    Ok(world)
}

/// Largest distance of a body from its start after a run, a reversal and the same run.
fn there_and_back(run: impl Fn(&mut World) -> Result<()>) -> Result<Real> {
    let mut world = three_bodies()?;
    let start = world.bodies().poses.clone();
    run(&mut world)?;
    for body in world.bodies().handles().to_vec() {
        let twist = world.body(body)?.twist();
        world.body_mut(body)?.set_twist(Twist::new(-twist.linear, -twist.angular))?;
    }
    run(&mut world)?;
    let ends = world.bodies().poses.iter().zip(&start);
    Ok(ends.map(|(end, start)| (end.position - start.position).norm()).fold(0.0, Real::max))
}
