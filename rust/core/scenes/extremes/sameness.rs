//! What must come out the same: at any size, far from the origin, and every time.

use super::layout::{ALL, Layout, Small, difference};
use crate::error::Result;
use crate::math::{Real, vec2};
use crate::scenes::gauge::at_most;
use crate::scenes::{Answer, Number, Reference, Scene};
use crate::world::{Snapshot, World};

pub static SIZES: Scene = Scene {
    id: "X3",
    name: "sizes",
    title: "A tumbling box, a bouncing ball and a pile at sizes from 10⁻³ to 10⁶",
    about: "Lengths times s, times and speeds times √s, gravity the same: the same numbers, for 2 s and in the pile ½ s, before \
        rounding grows. Differences of places over s, of velocities over √s and of angles; any length, speed or time hidden \
        in the engine would show.",
    reference: Reference::Law,
    answer: Answer::Numbers(sizes),
    checks: &[],
};

fn sizes() -> Result<Vec<Number>> {
    let mut numbers = Vec::new();
    for small in ALL {
        for size in [1e-3, 1e6] {
            let layouts = [Layout::PLAIN, Layout::of_size(size)];
            let [place, velocity] = difference(small, layouts, 1.0 / 60.0)?;
            let what = format!("difference at {size:e} times the size, {}", small.name);
            numbers.push(at_most(what, place.max(velocity), 1e-9));
        }
    }
    Ok(numbers)
}

pub static OFFSET: Scene = Scene {
    id: "X7",
    name: "far_from_the_origin",
    title: "A tumbling box, a bouncing ball and a pile 10⁶ and 10⁷ m from the origin",
    about: "The same motion as at the origin, for 2 s and in the pile ½ s. Coordinates of 10⁷ m have steps of 1.9·10⁻⁹ m.",
    reference: Reference::Law,
    answer: Answer::Numbers(offset),
    checks: &[],
};

fn offset() -> Result<Vec<Number>> {
    let mut numbers = Vec::new();
    for small in ALL {
        for far in [1e6, 1e7] {
            let layouts = [Layout::PLAIN, Layout::at(vec2(far, -far))];
            let [place, _] = difference(small, layouts, 1.0 / 60.0)?;
            numbers.push(at_most(
                format!("difference {far:e} m away, {}", small.name),
                place,
                1e-7,
            ));
        }
    }
    Ok(numbers)
}

pub static REPEATS: Scene = Scene {
    id: "X14",
    name: "repeats",
    title: "The same bits every time",
    about: "A tumbling box, a bouncing ball and a pile for 5 s: again; from a copy; and through the bytes of a snapshot halfway. \
        Numbers (places, angles, velocities) that differ in any bit.",
    reference: Reference::Law,
    answer: Answer::Numbers(repeats),
    checks: &[],
};

fn repeats() -> Result<Vec<Number>> {
    let mut numbers = Vec::new();
    for Small { name, build, .. } in ALL {
        let (dt, half) = (1.0 / 60.0, 150);
        let mut first = build(Layout::PLAIN)?;
        first.steps(dt, half)?;
        let mut copy = first.clone();
        let bytes = first.snapshot().to_bytes()?;
        let mut restored = Snapshot::from_bytes(&bytes, Vec::new())?.to_world();
        let mut again = build(Layout::PLAIN)?;
        again.steps(dt, half)?;
        for world in [&mut first, &mut copy, &mut restored, &mut again] {
            world.steps(dt, half)?;
        }
        for (how, other) in [("again", &again), ("a copy", &copy), ("a snapshot", &restored)] {
            let count = different(&first, other);
            numbers.push(at_most(format!("numbers that differ, {name}, {how}"), count, 0.0));
        }
    }
    Ok(numbers)
}

/// How many numbers of two worlds differ in any bit.
fn different(one: &World, other: &World) -> Real {
    let bits = |world: &World| -> Vec<u64> {
        let bodies = world.bodies();
        let poses = bodies.poses.iter().flat_map(|p| [p.position.x, p.position.y, p.angle]);
        let twists = bodies.twists.iter().flat_map(|v| [v.linear.x, v.linear.y, v.angular]);
        poses.chain(twists).map(Real::to_bits).collect()
    };
    bits(one).iter().zip(&bits(other)).filter(|(a, b)| a != b).count() as Real
}
