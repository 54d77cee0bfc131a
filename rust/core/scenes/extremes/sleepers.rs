//! Many bodies that sleep.

use crate::body::BodyDef;
use crate::error::Result;
use crate::math::{Real, vec2};
use crate::scenes::gauge::at_most;
use crate::scenes::stage::{DT, HALF, add_ground, heavy, rough};
use crate::scenes::{Answer, Number, Reference, Scene};
use crate::shapes::Shape;

pub static SLEEPERS: Scene = Scene {
    id: "X12",
    name: "sleepers",
    title: "Bodies that sleep cost no work",
    about: "Stacks of two boxes of 1 m fall asleep within a second; a ball then rolls beside them. Sweeps over contacts and steps are \
        those of a world with the ball alone.",
    reference: Reference::Law,
    answer: Answer::Numbers(numbers),
    checks: &[],
};

fn numbers() -> Result<Vec<Number>> {
    let (few, _) = work(0)?;
    let (many, awake) = work(25)?;
    Ok(vec![
        at_most("bodies awake beside the ball", awake as Real - 1.0, 0.0),
        at_most("sweeps more than of the ball alone", many.0 as Real - few.0 as Real, 0.0),
        at_most("steps more than of the ball alone", many.1 as Real - few.1 as Real, 0.0),
    ])
}

/// Sweeps and steps of a ball beside so many stacks, and how many bodies are awake, the ground left out.
fn work(stacks: u32) -> Result<((u64, u64), usize)> {
    let mut world = heavy()?;
    world.set_sleeping(true);
    add_ground(&mut world, 0.0, rough(HALF))?;
    for k in 0..stacks {
        for level in [0.5, 1.5] {
            let position = vec2(3.0 * Real::from(k) + 10.0, level);
            let square = Shape::rectangle(1.0, 1.0)?;
            world.add_body(BodyDef { position, surface: rough(HALF), ..BodyDef::new(square) })?;
        }
    }
    world.steps(DT, 60)?;
    let ball = BodyDef::new(Shape::circle(0.4)?);
    world.add_body(BodyDef { position: vec2(-2.0, 0.4), velocity: vec2(1.0, 0.0), ..ball })?;
    world.steps(DT, 60)?;
    let report = world.report();
    Ok(((report.sweeps, report.steps), world.bodies().len() - 1 - world.asleep()))
}
