//! What a step costs, by what a world holds. `cargo bench` prints time a step; the instruction counts
//! of the same worlds come from `make count`.

use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use culbuto::forces::{Air, Central};
use culbuto::math::vec2;
use culbuto::shapes::Shape;
use culbuto::{BodyDef, Result, World};

/// `n` balls thrown in all directions.
fn balls(n: u32) -> Result<World> {
    let mut world = World::new(vec2(0.0, -9.81))?;
    for i in 0..n {
        let velocity = vec2(f64::from(i % 17) - 8.0, f64::from(i % 13));
        world.add_body(BodyDef { velocity, ..BodyDef::new(Shape::circle(0.1)?) })?;
    }
    Ok(world)
}

fn worlds() -> Result<Vec<(&'static str, World)>> {
    let mut list = vec![("one free body", balls(1)?), ("1000 free bodies", balls(1000)?)];
    let mut in_air = balls(1)?;
    in_air.set_air(Air { density: 1.2, ..Air::default() })?;
    list.push(("one ball in air, 4 substeps", in_air));
    let mut orbit = balls(1)?;
    orbit.set_substeps(1)?;
    orbit.add_field(Central {
        center: vec2(0.0, 5.0),
        strength: 30.0,
        exponent: -2.0,
        per_mass: true,
    });
    list.push(("one body in a central field, 1 substep", orbit));
    Ok(list)
}

fn step(criterion: &mut Criterion) {
    let Ok(worlds) = worlds() else { return };
    for (name, world) in worlds {
        criterion.bench_function(&format!("step: {name}"), |bencher| {
            bencher.iter_batched_ref(
                || world.clone(),
                |world| (0..100).try_for_each(|_| world.step(1.0 / 60.0)),
                BatchSize::SmallInput,
            );
        });
    }
}

criterion_group!(benches, step);
criterion_main!(benches);
