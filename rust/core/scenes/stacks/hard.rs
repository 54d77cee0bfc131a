//! Structures that sweeps do not hold, by the solver that takes all rows at once.

use super::towers::{Build, boxes, ground_of, tower};
use crate::body::{BodyDef, Friction, Surface};
use crate::error::Result;
use crate::math::{Real, cos, sin_cos, vec2};
use crate::scenes::gauge::{Gauge, at_most};
use crate::scenes::stage::DT;
use crate::scenes::{Answer, Number, Reference, Scene};
use crate::shapes::Shape;
use crate::solvers::Solver;
use crate::world::World;

const ABOUT: &str = "Boxes of 1 m, put down exactly and, as a second run, let fall by gaps of 1 cm with their centres off by up to \
    1 cm, for 10 s with the solver pinned to newton. Each carries the weight above and nothing moves.";

pub static TALL: [Scene; 2] = [
    Scene {
        id: "K1c",
        name: "stack_of_20_solved",
        title: "Stack of 20 boxes, all rows at once",
        about: ABOUT,
        reference: Reference::Law,
        answer: Answer::Numbers(|| stand(tower::<20>)),
        checks: &[],
    },
    Scene {
        id: "K1d",
        name: "stack_of_100_solved",
        title: "Stack of 100 boxes, all rows at once",
        about: ABOUT,
        reference: Reference::Law,
        answer: Answer::Numbers(|| stand(tower::<100>)),
        checks: &[],
    },
];

pub static TOP_HEAVY: Scene = Scene {
    id: "K2",
    name: "top_heavy_stack",
    title: "Ten boxes, the top one 100 times as heavy",
    answer: Answer::Numbers(|| {
        stand(|loose, gap| boxes(10, |level| if level == 9 { 100.0 } else { 1.0 }, (loose, gap)))
    }),
    ..TALL[0]
};

pub static RATIOS: Scene = Scene {
    id: "K3",
    name: "heavy_on_light",
    title: "A heavy box on a light one, and the other way round",
    about: "Two boxes of 1 m whose masses are as 10⁻⁶ to 10⁶, the heavier ones above, for 10 s with the solver pinned to newton. They \
        stand. A fall by 1 cm and 4 s of rest take about as many factorisations whatever the ratio up to 10⁵; with 10⁶ on the light one the \
        last digit of its load is a velocity that moves it, and every other substep takes one.",
    reference: Reference::Law,
    answer: Answer::Numbers(ratios),
    checks: &[],
};

pub static CARDS: Scene = Scene {
    id: "K5",
    name: "house_of_cards",
    title: "Two cards, and a house of five storeys",
    about: "Two cards of length L with round ends of radius r lean on one another, 25° from the vertical. They stand where \
        μ ≥ ½tan 25°/(1 + r/(L cos 25°)), 0.2331 for thin ones. A house of five storeys with μ = 0.6 stands for a minute. By newton.",
    reference: Reference::ClosedForm,
    answer: Answer::Numbers(cards),
    checks: &[],
};

pub static OVERHANG: Scene = Scene {
    id: "K6",
    name: "harmonic_overhang",
    title: "Bricks that overhang",
    about: "Each of n bricks of length 1 m reaches beyond the one below by 1/2i, i counted from the top: 1.0417 m for 4, \
        1.4645 m for 10. At 0.98 of it they stand, at 1.02 they fall. By newton.",
    reference: Reference::ClosedForm,
    answer: Answer::Numbers(overhang),
    checks: &[],
};

fn stand(build: Build) -> Result<Vec<Number>> {
    let mut numbers = Vec::new();
    for (loose, gap, how) in
        [(false, 0.0, "put down exactly"), (true, 0.01, "let fall by gaps of 1 cm")]
    {
        let mut world = build(loose, gap)?;
        world.set_solver(Solver::Newton);
        let mut gauge = Gauge::new(&world, 1.0)?;
        gauge.run(&mut world, DT, 300, 30)?;
        gauge.settle(&world);
        gauge.run(&mut world, DT, 300, 30)?;
        let (seen, aside) = (gauge.seen, lateral(&world, &build(loose, 0.0)?));
        numbers.extend([
            at_most(format!("overlap per metre, {how}"), seen.overlap, 1e-4),
            at_most(format!("lateral drift (m), {how}"), aside, 1e-6),
            at_most(format!("drift over the last 5 s (m), {how}"), seen.drift, 1e-6),
            at_most(format!("speed over the last 5 s (m/s), {how}"), seen.speed, 1e-6),
            at_most(format!("what rows lack (m/s), {how}"), world.report().residual, 1e-8),
        ]);
        numbers.extend(gauge.laws(how));
    }
    Ok(numbers)
}

/// How far bodies have moved aside (m).
fn lateral(world: &World, start: &World) -> Real {
    let poses = world.bodies().poses.iter().zip(&start.bodies().poses);
    poses.map(|(now, then)| (now.position.x - then.position.x).abs()).fold(0.0, Real::max)
}

fn ratios() -> Result<Vec<Number>> {
    let mut numbers = Vec::new();
    for power in -6..=6 {
        let ratio = Real::powi(10.0, power);
        let build =
            |loose, gap| boxes(2, |level| if level == 1 { ratio } else { 1.0 }, (loose, gap));
        let mut world = build(false, 0.0)?;
        world.set_solver(Solver::Newton);
        let mut gauge = Gauge::new(&world, 1.0)?;
        gauge.run(&mut world, DT, 600, 60)?;
        let seen = gauge.seen;
        numbers.extend([
            at_most(format!("overlap per metre, ratio 1e{power}"), seen.overlap, 1e-6),
            at_most(format!("drift (m), ratio 1e{power}"), seen.drift, 1e-6),
        ]);
        numbers.extend(gauge.laws(&format!("ratio 1e{power}")));
        let mut falling = build(true, 0.01)?;
        falling.set_solver(Solver::Newton);
        let (mut most, mut sum) = (0, 0);
        for _ in 0..240 {
            falling.step(DT)?;
            let count = falling.report().factorisations;
            (most, sum) = (count.max(most), sum + count);
        }
        let what = format!("factorisations in a step of four substeps, ratio 1e{power}");
        numbers.push(at_most(what, most as Real, MOST));
        let what = format!("factorisations in 960 substeps, ratio 1e{power}");
        numbers.push(at_most(what, sum as Real, if power < 6 { IN_ALL } else { 480.0 }));
    }
    Ok(numbers)
}

/// Factorisations in a step of four substeps, whatever the ratio of masses.
const MOST: Real = 5.0;

/// The same in 4 s.
const IN_ALL: Real = 16.0;

/// A card of length 1 m along y with round ends.
fn card(x: Real, y: Real, angle: Real, mu: Real) -> Result<BodyDef> {
    Ok(BodyDef {
        position: vec2(x, y),
        angle,
        surface: Surface { friction: Friction::of(mu), ..Surface::default() },
        ..BodyDef::new(Shape::capsule(vec2(0.0, -0.5), vec2(0.0, 0.5), ROUND)?)
    })
}

const ROUND: Real = 5e-3;
const LEAN: Real = 25.0 * crate::math::PI / 180.0;

fn two_cards(mu: Real) -> Result<World> {
    let mut world = ground_of(mu)?;
    for side in [-1.0, 1.0] {
        let (x, y) = (0.5 * sin_cos(LEAN).0 + ROUND, 0.5 * cos(LEAN) + ROUND);
        world.add_body(card(side * x, y, side * LEAN, mu)?)?;
    }
    world.set_solver(Solver::Newton);
    Ok(world)
}

pub(in crate::scenes) fn house(storeys: u32, mu: Real) -> Result<World> {
    let mut world = ground_of(mu)?;
    let surface = Surface { friction: Friction::of(mu), ..Surface::default() };
    let half = vec2(0.5 * sin_cos(LEAN).0 + ROUND, 0.5 * cos(LEAN) + ROUND);
    let mut y = 0.0;
    for storey in 0..storeys {
        let pairs = storeys - storey;
        for pair in 0..pairs {
            let x = 4.0 * half.x * (Real::from(pair) - 0.5 * Real::from(pairs - 1));
            for side in [-1.0, 1.0] {
                world.add_body(card(x + side * half.x, y + half.y, side * LEAN, mu)?)?;
            }
        }
        y += 2.0 * half.y;
        for flat in 1..pairs {
            let x = 4.0 * half.x * (Real::from(flat) - 0.5 * Real::from(pairs));
            world.add_body(BodyDef {
                position: vec2(x, y + 0.01),
                surface: surface.clone(),
                ..BodyDef::new(Shape::rectangle(4.0 * half.x - ROUND, 0.02)?)
            })?;
        }
        y += 0.02;
    }
    world.set_solver(Solver::Newton);
    Ok(world)
}

fn cards() -> Result<Vec<Number>> {
    let needed = 0.5 * (sin_cos(LEAN).0 / cos(LEAN)) / (1.0 + ROUND / cos(LEAN));
    let mut numbers = vec![Number {
        what: "friction that two cards need".into(),
        value: needed,
        exact: 0.233_153_829,
        asked: 2.0 * ROUND,
    }];
    for (mu, stands) in [(0.24, true), (0.225, false)] {
        let mut world = two_cards(mu)?;
        let mut gauge = Gauge::new(&world, 1.0)?;
        gauge.run(&mut world, DT, 600, 60)?;
        let drift = gauge.seen.drift;
        numbers.push(if stands {
            at_most(format!("drift of two cards (m), μ = {mu}"), drift, 1e-6)
        } else {
            at_most(format!("two cards that stay up, μ = {mu}"), (0.4 - drift).max(0.0), 0.0)
        });
        numbers.extend(gauge.laws(&format!("two cards, μ = {mu}")));
    }
    let mut world = house(5, 0.6)?;
    let mut gauge = Gauge::new(&world, 1.0)?;
    gauge.run(&mut world, DT, 3600, 120)?;
    numbers.extend([
        at_most("drift of the house (m)", gauge.seen.drift, 1e-3),
        at_most("overlap in the house", gauge.seen.overlap, 0.05),
    ]);
    numbers.extend(gauge.laws("the house"));
    Ok(numbers)
}

pub(in crate::scenes) fn bricks(count: u32, part: Real) -> Result<World> {
    let mut world = ground_of(0.6)?;
    let mut reach = 0.0;
    for level in 0..count {
        let above = count - level;
        world.add_body(BodyDef {
            position: vec2(reach, 0.1 + 0.2 * Real::from(level)),
            surface: Surface { friction: Friction::of(0.6), ..Surface::default() },
            ..BodyDef::new(Shape::rectangle(1.0, 0.2)?)
        })?;
        reach += part * 0.5 / Real::from(above - 1).max(1.0);
    }
    world.set_solver(Solver::Newton);
    Ok(world)
}

fn overhang() -> Result<Vec<Number>> {
    let mut numbers = Vec::new();
    for count in [4, 10] {
        // The lowest brick stands on the ground and does not overhang.
        for (part, stands) in [(0.98, true), (1.02, false)] {
            let mut world = bricks(count + 1, part)?;
            let mut gauge = Gauge::new(&world, 1.0)?;
            gauge.run(&mut world, DT, 600, 60)?;
            let what = format!("{count} bricks at {part}");
            numbers.push(if stands {
                at_most(format!("drift of {what} (m)"), gauge.seen.drift, 1e-6)
            } else {
                at_most(format!("{what} that stay up"), (0.5 - gauge.seen.drift).max(0.0), 0.0)
            });
            numbers.extend(gauge.laws(&what));
        }
    }
    Ok(numbers)
}
