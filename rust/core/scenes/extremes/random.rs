//! Random scenes for a long time.

use std::ops::Range;
use std::sync::Mutex;
use std::sync::atomic::{AtomicU32, Ordering};
use std::thread;

use crate::body::{BodyDef, BodyKind, Friction, Surface};
use crate::error::Result;
use crate::math::{Real, vec2};
use crate::scenes::gauge::{Gauge, Seen, at_most, worse};
use crate::scenes::{Answer, Number, Reference, Scene};
use crate::shapes::Shape;
use crate::world::World;

const ABOUT: &str = "Boxes, disks, capsules, regular polygons and triangles, 5 to 12 of them, 0.2 to 1 m large, 1 : 100 in density, thrown \
    into a bin of 8 m by walls of 20 m; friction 0 to 1, restitution 0 to 1, a belt as the floor of every third, steps of 1/30, \
    1/60 or 1/120 s. E ≤ E₀ + work + correction_work + 10⁻⁶, as a part of E₀ and of what a fall through 1 m gives; what is \
    dissipated never comes back, the books balance, and nothing leaves the bin.";

pub static RANDOM: Scene = SHORT;

const SHORT: Scene = Scene {
    id: "X15",
    name: "random_bins",
    title: "Random scenes in a bin: 10 for 1000 steps",
    about: ABOUT,
    reference: Reference::Law,
    answer: Answer::Numbers(|| numbers(0..10, 1_000)),
    checks: &[],
};

/// All of them, ten by ten.
pub static ALL_RANDOM: [Scene; 10] = [
    ten::<0>(),
    ten::<1>(),
    ten::<2>(),
    ten::<3>(),
    ten::<4>(),
    ten::<5>(),
    ten::<6>(),
    ten::<7>(),
    ten::<8>(),
    ten::<9>(),
];

const fn ten<const K: u32>() -> Scene {
    Scene {
        title: TITLES[K as usize],
        answer: Answer::Numbers(|| numbers(10 * K..10 * K + 10, 100_000)),
        ..SHORT
    }
}

const TITLES: [&str; 10] = [
    "Random scenes 0 to 9 for 100 000 steps",
    "Random scenes 10 to 19 for 100 000 steps",
    "Random scenes 20 to 29 for 100 000 steps",
    "Random scenes 30 to 39 for 100 000 steps",
    "Random scenes 40 to 49 for 100 000 steps",
    "Random scenes 50 to 59 for 100 000 steps",
    "Random scenes 60 to 69 for 100 000 steps",
    "Random scenes 70 to 79 for 100 000 steps",
    "Random scenes 80 to 89 for 100 000 steps",
    "Random scenes 90 to 99 for 100 000 steps",
];

/// Random numbers: `SplitMix64` (Steele, Lea and Flood, "Fast splittable pseudorandom number generators", 2014).
pub(super) struct Dice(u64);

impl Dice {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let z = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Evenly in from..to.
    pub fn between(&mut self, from: Real, to: Real) -> Real {
        from + (to - from) * (self.next() >> 11) as Real / (1_u64 << 53) as Real
    }

    /// Evenly in 0..n.
    pub fn below(&mut self, n: u64) -> u64 {
        self.next() % n
    }
}

const HALF_WIDTH: Real = 4.0;
const HEIGHT: Real = 20.0;

/// The random scene of a seed, and its step (s).
pub(in crate::scenes) fn bin(seed: u32) -> Result<(World, Real)> {
    let mut dice = Dice::new(u64::from(seed));
    let mut world = World::default();
    let restitution = [0.0, 0.3, 0.8, 1.0][dice.below(4) as usize];
    let surface = |dice: &mut Dice| Surface {
        friction: Friction::of(dice.between(0.0, 1.0)),
        restitution,
        ..Surface::default()
    };
    for (width, height, x, y) in [
        (2.0 * HALF_WIDTH + 4.0, 2.0, 0.0, -1.0),
        (2.0, HEIGHT, HALF_WIDTH + 1.0, HEIGHT / 2.0),
        (2.0, HEIGHT, -HALF_WIDTH - 1.0, HEIGHT / 2.0),
    ] {
        let belt = y < 0.0 && seed.is_multiple_of(3);
        let tangent_speed = if belt { dice.between(-2.0, 2.0) } else { 0.0 };
        world.add_body(BodyDef {
            kind: BodyKind::Static,
            position: vec2(x, y),
            surface: Surface { tangent_speed, ..surface(&mut dice) },
            ..BodyDef::new(Shape::rectangle(width, height)?)
        })?;
    }
    let columns = 4;
    for k in 0..5 + dice.below(8) {
        let (column, row) = ((k % columns) as Real, (k / columns) as Real);
        world.add_body(BodyDef {
            position: vec2(1.5 * (column - 1.5), 1.0 + 1.5 * row),
            angle: dice.between(0.0, 6.0),
            velocity: vec2(dice.between(-3.0, 3.0), dice.between(-3.0, 3.0)),
            angular_velocity: dice.between(-5.0, 5.0),
            density: crate::math::powf(100.0, dice.between(-0.5, 0.5)),
            surface: surface(&mut dice),
            ..BodyDef::new(shape(&mut dice)?)
        })?;
    }
    let dt = 1.0 / [30.0, 60.0, 120.0][dice.below(3) as usize];
    Ok((world, dt))
}

fn shape(dice: &mut Dice) -> Result<Shape> {
    let size = dice.between(0.1, 0.5);
    match dice.below(5) {
        0 => Shape::circle(size),
        1 => Shape::rectangle(2.0 * size, 2.0 * size * dice.between(0.2, 1.0)),
        2 => Shape::capsule(vec2(-0.6 * size, 0.0), vec2(0.6 * size, 0.0), 0.4 * size),
        3 => Shape::regular_polygon(5 + dice.below(4) as u32, size),
        _ => Shape::polygon(&[
            vec2(-size, 0.0),
            vec2(size, 0.0),
            vec2(dice.between(-size, size), size),
        ]),
    }
}

/// What one scene has shown, and how many bodies have left it.
fn run(seed: u32, steps: u32) -> Result<(Seen, Real)> {
    let (mut world, dt) = bin(seed)?;
    let mut gauge = Gauge::new(&world, 1.0)?;
    gauge.run(&mut world, dt, steps, steps / 100)?;
    let free = world.bodies().poses.iter().skip(3);
    let outside = |x: Real, y: Real| x.abs() > HALF_WIDTH || y < 0.0;
    let lost = free.filter(|pose| outside(pose.position.x, pose.position.y)).count();
    Ok((gauge.seen, lost as Real))
}

/// Runs the scenes on as many threads as the machine has.
fn numbers(seeds: Range<u32>, steps: u32) -> Result<Vec<Number>> {
    let next = AtomicU32::new(seeds.start);
    let all = Mutex::new(Vec::new());
    let work = || loop {
        let seed = next.fetch_add(1, Ordering::Relaxed);
        if seed >= seeds.end {
            break;
        }
        let result = run(seed, steps);
        // OK because a thread that panics ends the scope, and with it the run.
        all.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push((seed, result));
    };
    thread::scope(|scope| {
        for _ in 0..thread::available_parallelism().map_or(1, usize::from) {
            scope.spawn(work);
        }
    });
    let mut all = all.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    all.sort_by_key(|(seed, _)| *seed);
    collect(all)
}

/// The worst of all scenes, and which one it was of.
fn collect(all: Vec<(u32, Result<(Seen, Real)>)>) -> Result<Vec<Number>> {
    type Figure = (&'static str, Real, fn(&(Seen, Real)) -> Real);
    let figures: [Figure; 5] = [
        ("energy gained", 1e-6, |(seen, _)| seen.gained),
        ("energy given by contacts", 1e-9, |(seen, _)| seen.returned),
        ("change of the energy balance", 1e-6, |(seen, _)| seen.unbalanced),
        ("overlap, part of the width", 0.05, |(seen, _)| seen.overlap),
        ("bodies lost", 0.0, |(_, lost)| *lost),
    ];
    let mut worst = [(0.0, 0); 5];
    for (seed, result) in all {
        let seen = result?;
        for (worst, figure) in worst.iter_mut().zip(&figures) {
            let value = worse(worst.0, figure.2(&seen));
            if value > worst.0 {
                *worst = (value, seed);
            }
        }
    }
    let number = |((what, asked, _), (value, seed)): (&Figure, (Real, u32))| {
        at_most(format!("{what}, worst in scene {seed}"), value, *asked)
    };
    Ok(figures.iter().zip(worst).map(number).collect())
}
