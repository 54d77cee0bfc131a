//! Runs a fluid and prints what it does and costs: `fluid dam 100 0.5 2` is a block of 100 × 100 particles that is let go
//! in a tank of four times its width, for 0.5 s, on two threads; `fluid column 40 2` one at rest.

#![allow(clippy::print_stdout)] // its output is what it is for

use culbuto::fluid::{Material, lattice_in};
use culbuto::math::{Real, vec2};
use culbuto::shapes::{Shape, ShapeDef};
use culbuto::{BodyDef, BodyHandle, BodyKind, Result, World};

const DT: Real = 1.0 / 60.0;

/// What is run.
struct Run {
    world: World,
    floor: BodyHandle,
    width: Real,
}

/// What it took.
#[derive(Default)]
struct Cost {
    seconds: f64,
    wall: f64,
    substeps: u64,
    iterations: u64,
}

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let number = |k: usize, or: f64| arguments.get(k).and_then(|x| x.parse().ok()).unwrap_or(or);
    let width = if arguments.first().is_some_and(|mode| mode == "column") { 1.0 } else { 4.0 };
    let (rows, duration, threads) = (number(1, 100.0), number(2, 0.5), number(3, 1.0));
    let mut run = Run::new(width, 1.0 / rows, number(4, 0.0))?;
    run.world.set_threads(threads as u32)?;
    let frames = (duration / DT).ceil() as u32;
    let mut cost = Cost::default();
    for frame in 1..=frames {
        cost.step(&mut run.world)?;
        if frame % (frames / 10).max(1) == 0 || frame == frames {
            run.tell()?;
        }
    }
    let particles = run.world.fluids().particles.len() as f64;
    println!(
        "{particles} particles, {} substeps of {:.1} iterations, {:.0} ns a particle and substep, {:.2} s of processor and {:.2} s of time a second",
        cost.substeps,
        cost.iterations as f64 / cost.substeps as f64,
        cost.seconds / cost.substeps as f64 / particles * 1e9,
        cost.seconds / (f64::from(frames) * DT),
        cost.wall / (f64::from(frames) * DT),
    );
    Ok(())
}

impl Cost {
    fn step(&mut self, world: &mut World) -> Result<()> {
        let (before, start) = (busy(), std::time::Instant::now());
        world.step(DT)?;
        self.seconds += busy() - before;
        self.wall += start.elapsed().as_secs_f64();
        self.substeps += world.report().steps;
        self.iterations += world.report().solves;
        Ok(())
    }
}

impl Run {
    fn new(width: Real, spacing: Real, viscosity: Real) -> Result<Self> {
        let mut world = World::default();
        let floor = wall(&mut world, [-0.5, -0.5], [width + 0.5, 0.0])?;
        wall(&mut world, [-0.5, 0.0], [0.0, 4.0])?;
        wall(&mut world, [width, 0.0], [width + 0.5, 4.0])?;
        let center = vec2(0.5, 0.5);
        let block = ShapeDef::Box { width: 1.0, height: 1.0, center, angle: 0.0 };
        let points = lattice_in(&Shape::new(block)?, spacing)?;
        let material = Material { viscosity, ..Material::default() };
        world.add_fluid(&points, spacing, material)?;
        Ok(Self { world, floor, width })
    }

    /// What can be seen of the state.
    fn tell(&self) -> Result<()> {
        let world = &self.world;
        let particles = &world.fluids().particles;
        let over = particles.compressions.iter().map(|c| (c - 1.0).max(0.0)).sum::<Real>();
        let worst = particles.compressions.iter().copied().fold(0.0, Real::max);
        let front = particles.positions.iter().map(|p| p.x).fold(0.0, Real::max);
        let inside = |x: Real, y: Real| y > 0.0 && (0.0..self.width).contains(&x);
        let out = particles.positions.iter().filter(|p| !inside(p.x, p.y)).count();
        let energy = world.energy()?;
        let load = -world.fluid_load(self.floor)?.force.y / (world.mass() * 9.81);
        println!(
            "t {:.3} center {:.4} front {front:.4} outside {out} mean over {:.1e} worst {worst:.4} kinetic {:.2e} energy {:.4} floor {load:.4}",
            world.time(),
            world.center_of_mass().y,
            over / particles.len() as Real,
            energy.kinetic / energy.total(),
            energy.total() / (world.mass() * 9.81),
        );
        Ok(())
    }
}

fn wall(world: &mut World, low: [Real; 2], high: [Real; 2]) -> Result<BodyHandle> {
    let shape = Shape::rectangle(high[0] - low[0], high[1] - low[1])?;
    let position = vec2(0.5 * (low[0] + high[0]), 0.5 * (low[1] + high[1]));
    world.add_body(BodyDef { kind: BodyKind::Static, position, ..BodyDef::new(shape) })
}

/// Seconds of the processor that this thread has used, where the system tells.
fn busy() -> f64 {
    let text = std::fs::read_to_string("/proc/self/schedstat").unwrap_or_default();
    let first = text.split(' ').next().and_then(|word| word.parse::<f64>().ok());
    first.unwrap_or(0.0) * 1e-9
}
