//! Steps of any length.

use super::layout::{Layout, pile, resting};
use super::random::Dice;
use crate::error::Result;
use crate::math::powf;
use crate::scenes::gauge::{Gauge, at_most};
use crate::scenes::{Answer, Number, Reference, Scene};

pub static STEPS: Scene = Scene {
    id: "X10",
    name: "steps_of_any_length",
    title: "A resting box and a pile at steps from 10⁻⁶ s to 0.5 s, and at steps that vary",
    about: "The box stays; the pile finishes; neither gains energy. Varying steps are drawn anew each time, evenly on the scale of \
        their logarithms.",
    reference: Reference::Law,
    answer: Answer::Numbers(numbers),
    checks: &[],
};

fn numbers() -> Result<Vec<Number>> {
    let mut numbers = Vec::new();
    let fixed = [1e-6, 1e-4, 1e-2, 0.1, 0.5].map(|dt| (format!("dt = {dt:e}"), Some(dt)));
    for (how, dt) in fixed.into_iter().chain([("varying dt".into(), None)]) {
        for (name, build) in [("the box", resting as super::layout::Build), ("the pile", pile)] {
            let mut world = build(Layout::PLAIN)?;
            let mut gauge = Gauge::new(&world, 1.0)?;
            let mut dice = Dice::new(1);
            for _ in 0..600 {
                let dt = dt.unwrap_or_else(|| 0.5 * powf(2e-6, dice.between(0.0, 1.0)));
                gauge.run(&mut world, dt, 1, 1)?;
            }
            let how = format!("{name}, {how}");
            if name == "the box" {
                numbers.push(at_most(format!("drift (m), {how}"), gauge.seen.drift, 1e-9));
            }
            numbers.extend(gauge.laws(&how));
        }
    }
    Ok(numbers)
}
