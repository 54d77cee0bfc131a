//! Runs a fluid and prints what it does and costs: `fluid dam 100 0.5` is a block of 100 × 100 particles for 0.5 s.

#![allow(clippy::print_stdout)] // its output is what it is for

use culbuto::fluid::{Material, lattice_in};
use culbuto::math::{Real, vec2};
use culbuto::shapes::{Shape, ShapeDef};
use culbuto::{BodyDef, BodyKind, Result, World};

/// Seconds of the processor that this thread has used.
fn busy() -> f64 {
    let text = std::fs::read_to_string("/proc/self/schedstat").unwrap_or_default();
    let first = text.split(' ').next().and_then(|word| word.parse::<f64>().ok());
    first.unwrap_or(0.0) * 1e-9
}

fn wall(world: &mut World, low: [Real; 2], high: [Real; 2]) -> Result<culbuto::BodyHandle> {
    let (width, height) = (high[0] - low[0], high[1] - low[1]);
    world.add_body(BodyDef {
        kind: BodyKind::Static,
        position: vec2(0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])),
        ..BodyDef::new(Shape::rectangle(width, height)?)
    })
}

fn block(low: [Real; 2], high: [Real; 2]) -> Result<Shape> {
    Shape::new(ShapeDef::Box {
        width: high[0] - low[0],
        height: high[1] - low[1],
        center: vec2(0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1])),
        angle: 0.0,
    })
}

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let text = |k: usize, or: &str| arguments.get(k).cloned().unwrap_or_else(|| or.into());
    let number = |k: usize, or: f64| text(k, "").parse::<f64>().unwrap_or(or);
    let mode = text(0, "dam");
    let rows = number(1, 100.0);
    let duration = number(2, 0.5);
    let threads = number(3, 1.0) as u32;
    let spacing = 1.0 / rows;
    let width = if mode == "dam" { 4.0 } else { 1.0 };
    let mut world = World::default();
    world.set_threads(threads)?;
    world.set_substeps(number(4, 4.0) as u32)?;
    let floor = wall(&mut world, [-0.5, -0.5], [width + 0.5, 0.0])?;
    wall(&mut world, [-0.5, 0.0], [0.0, 4.0])?;
    wall(&mut world, [width, 0.0], [width + 0.5, 4.0])?;
    let water = lattice_in(&block([0.0, 0.0], [1.0, 1.0])?, spacing)?;
    world.add_fluid(
        &water,
        spacing,
        Material { viscosity: number(5, 0.0), ..Material::default() },
    )?;
    let n = water.len() as Real;
    let weight = world.mass() * 9.81;
    let start = world.energy()?;
    let mut used = 0.0;
    let frames = (duration * 60.0).ceil() as u32;
    let (mut steps, mut iterations) = (0, 0);
    for frame in 0..frames {
        let before = busy();
        world.step(1.0 / 60.0)?;
        used += busy() - before;
        steps += world.report().steps;
        iterations += world.report().solves;
        if frame % (frames / 10).max(1) == 0 || frame + 1 == frames {
            let particles = &world.fluids().particles;
            let over: Real =
                particles.compressions.iter().map(|c| (c - 1.0).max(0.0)).sum::<Real>() / n;
            let worst = particles.compressions.iter().copied().fold(0.0, Real::max);
            let far = particles.positions.iter().map(|p| p.x).fold(0.0, Real::max);
            let up = particles.positions.iter().map(|p| p.y).sum::<Real>() / n;
            let out = particles.positions.iter().filter(|p| p.y < 0.0 || p.x < 0.0 || p.x > width);
            let energy = world.energy()?;
            let load = world.fluid_load(floor)?;
            println!(
                "t {:.3} com_y {up:.4} xmax {far:.4} out {} over {over:.2e} worst {worst:.4} KE/start {:.2e} E/E0 {:.4} floor {:.4} steps {} it/step {:.1} residual {:.1e}",
                world.time(),
                out.count(),
                energy.kinetic / start.potential,
                energy.total() / start.total(),
                -load.force.y / weight,
                world.report().steps,
                world.report().solves as f64 / world.report().steps as f64,
                world.report().residual,
            );
            if mode == "hydro" && frame + 1 == frames {
                let mut bins = [(0.0, 0.0); 10];
                for (p, pressure) in particles
                    .positions
                    .iter()
                    .zip(particles.pressures.iter().zip(&particles.relaxing))
                {
                    let bin = &mut bins[((p.y * 10.0) as usize).min(9)];
                    bin.0 += pressure.0 + pressure.1;
                    bin.1 += 9810.0 * (1.0 - p.y).max(0.3 * spacing);
                }
                println!("{:?}", bins.map(|(a, b)| (a / b * 1000.0_f64).round() / 1000.0));
            }
        }
    }
    println!(
        "{n} particles, {steps} substeps, {:.1} iterations each, {:.0} ns a particle and substep, {:.2} s a second",
        iterations as f64 / steps as f64,
        used / steps as f64 / n * 1e9,
        used / (f64::from(frames) / 60.0)
    );
    Ok(())
}
