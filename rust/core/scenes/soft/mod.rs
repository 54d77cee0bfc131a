//! Deformable bodies beside beam theory. L = 1 m, H = 0.1 m, E = 1 MPa, ν = 0.3, plane stress, unit thickness.

mod minute;
mod played;

pub use minute::{BALLOON, CART, MINUTES, PRESS, ROPES, STAIRS};

use super::{Answer, Number, Reference, Scene};
use crate::error::Result;
use crate::math::{PI, Real, Vec2, vec2};
use crate::soft::{Gas, Material, Mesh, Plane, Rope, SoftBody, SoftDef, SoftHandle};
use crate::world::World;

const LENGTH: Real = 1.0;
const HEIGHT: Real = 0.1;
const E: Real = 1e6;
const POISSON: Real = 0.3;
/// I of the section (m⁴ on a metre).
const INERTIA: Real = HEIGHT * HEIGHT * HEIGHT / 12.0;
/// Lowest frequency of the beam: (1.8751²/2π)√(EI/ρA)/L² (Hz).
const LOWEST: Real = 0.5109;
const STEP: Real = 1.0 / 60.0;

pub static END_LOAD: Scene = Scene {
    id: "D1",
    name: "cantilever",
    title: "A beam with a load at its end, 1, 2 and 4 triangles' rows through its depth",
    about: "Timoshenko: FL³/3EI + FL/(5/6)GA; 2 % is asked with 4 rows. Held at all nodes of one end, which beam theory does not hold across.",
    reference: Reference::Figures(3e-3),
    answer: Answer::Numbers(end_load),
    checks: &[],
};

pub static OWN_WEIGHT: Scene = Scene {
    id: "D2",
    name: "own_weight",
    title: "A beam under its own weight",
    about: "wL⁴/8EI + wL²/2(5/6)GA.",
    reference: Reference::Figures(3e-3),
    answer: Answer::Numbers(own_weight),
    checks: &[],
};

pub static AXIAL: Scene = Scene {
    id: "D4",
    name: "axial_bar",
    title: "A bar that swings along its length: the frequency, with 1 and 8 substeps",
    about: "√(E/ρ)/4L, with ν = 0 so that nothing moves across.",
    reference: Reference::ClosedForm,
    answer: Answer::Numbers(axial),
    checks: &[],
};

pub static LARGE: Scene = Scene {
    id: "D6",
    name: "elastica",
    title: "A beam bent far by a load that keeps its direction",
    about: "Bisshopp and Drucker (1945), PL²/EI = 1, 2, 5, 10, for a beam that neither stretches nor shears.",
    reference: Reference::Figures(0.02),
    answer: Answer::Numbers(large),
    checks: &[],
};

pub static PATCH: Scene = Scene {
    id: "D7",
    name: "patch_test",
    title: "An irregular mesh whose border is stretched and sheared alike has one strain everywhere",
    about: "Nodes inside are let go from elsewhere and come to rest where the border's motion puts them, if elements can represent a constant strain.",
    reference: Reference::Law,
    answer: Answer::Numbers(patch),
    checks: &[],
};

pub static RIGID: Scene = Scene {
    id: "D8",
    name: "rigid_motion",
    title: "Turned and moved it has no stress; thrown, it keeps momentum, angular momentum and energy",
    about: "Forces are gradients of an energy that rigid motion does not change, and steps keep that energy.",
    reference: Reference::Law,
    answer: Answer::Numbers(rigid),
    checks: &[],
};

pub static AREA: Scene = Scene {
    id: "D9",
    name: "area_kept",
    title: "A beam of ν = 0.4999 in plane strain keeps its area and does not lock; a balloon keeps p·A",
    about: "Bent by a load, against wL³/3E'I + shear with E' = E/(1 − ν²).",
    reference: Reference::Figures(0.03),
    answer: Answer::Numbers(area),
    checks: &[],
};

pub static RANDOM: Scene = Scene {
    id: "D11",
    name: "random_vertices",
    title: "A block whose nodes are put anywhere comes back to its shape",
    about: "ψ has no minimum but rest in a triangle, flat and inside out included. Energies never grow on the way.",
    reference: Reference::Law,
    answer: Answer::Numbers(random),
    checks: &[],
};

fn number(what: impl Into<String>, value: Real, exact: Real, asked: Real) -> Number {
    Number { what: what.into(), value, exact, asked }
}

fn material() -> Material {
    Material {
        youngs_modulus: E,
        poissons_ratio: POISSON,
        damping_ratio: 1.0,
        damping_frequency: LOWEST,
        ..Material::default()
    }
}

/// A beam from x = 0, held there.
fn beam(rows: u32, material: Material, gravity: Real) -> Result<(World, SoftHandle)> {
    let mesh = Mesh::rectangle(LENGTH, HEIGHT, [10 * rows, rows])?;
    let pins = mesh.nodes_where(|p| p.x < -0.499_999 * LENGTH);
    let position = vec2(0.5 * LENGTH, 0.0);
    let mut world = World::new(vec2(0.0, -gravity))?;
    let beam = world.add_soft_body(SoftDef { pins, position, ..SoftDef::new(mesh, material) })?;
    Ok((world, beam))
}

/// Spreads a force evenly over the free end: a sixth, four sixths and a sixth of each side's part on its nodes.
fn load_end(world: &mut World, beam: SoftHandle, force: Real) -> Result<()> {
    let body = world.soft_body(beam)?;
    let ends = at_end(body);
    let part = force / ((ends.len() - 1) as Real / 2.0);
    let mut forces = vec![Vec2::zeros(); body.positions().len()];
    // In order of height, corners and middles take turns.
    for (k, node) in ends.iter().enumerate() {
        let middle = k % 2 == 1;
        let outer = k == 0 || k + 1 == ends.len();
        let share = if middle {
            4.0
        } else if outer {
            1.0
        } else {
            2.0
        };
        forces[*node as usize].y = -part * share / 6.0;
    }
    world.set_soft_forces(beam, &forces)
}

/// Nodes at the free end, from below up.
fn at_end(body: &SoftBody) -> Vec<u32> {
    let mesh = &body.def().mesh;
    let mut ends = mesh.nodes_where(|p| p.x > 0.499_999 * LENGTH);
    ends.sort_by(|a, b| {
        let height = |i: &u32| mesh.rest()[*i as usize].y;
        height(a).total_cmp(&height(b))
    });
    ends
}

/// Mean displacement of the free end, seconds later.
fn deflection(world: &mut World, beam: SoftHandle, seconds: u32) -> Result<Vec2> {
    let end = |world: &World| -> Result<Vec2> {
        let body = world.soft_body(beam)?;
        let ends = at_end(body);
        let sum: Vec2 = ends.iter().map(|i| body.positions()[*i as usize]).sum();
        Ok(sum / ends.len() as Real)
    };
    let before = end(world)?;
    world.steps(STEP, 60 * seconds)?;
    Ok(end(world)? - before)
}

/// 1/(5/6)GA (1/N).
fn shear(e: Real, nu: Real) -> Real {
    2.0 * (1.0 + nu) / e / (5.0 / 6.0 * HEIGHT)
}

fn end_load() -> Result<Vec<Number>> {
    let exact = LENGTH.powi(3) / (3.0 * E * INERTIA) + LENGTH * shear(E, POISSON);
    let mut numbers = Vec::new();
    for rows in [1, 2, 4] {
        let (mut world, beam) = beam(rows, material(), 0.0)?;
        load_end(&mut world, beam, 1.0)?;
        let down = -deflection(&mut world, beam, 12)?.y;
        numbers.push(number(format!("deflection with {rows} rows (m)"), down, exact, 0.02));
    }
    Ok(numbers)
}

fn own_weight() -> Result<Vec<Number>> {
    let gravity = 0.01;
    let weight = 1000.0 * HEIGHT * gravity;
    let exact = weight * LENGTH.powi(4) / (8.0 * E * INERTIA)
        + 0.5 * weight * LENGTH * LENGTH * shear(E, POISSON);
    let (mut world, beam) = beam(2, material(), gravity)?;
    let down = -deflection(&mut world, beam, 12)?.y;
    Ok(vec![number("deflection (m)", down, exact, 0.02)])
}

fn axial() -> Result<Vec<Number>> {
    let exact = (E / 1000.0).sqrt() / (4.0 * LENGTH);
    let mut numbers = Vec::new();
    for substeps in [1, 8] {
        let free = Material { poissons_ratio: 0.0, damping_ratio: 0.0, ..material() };
        let (mut world, beam) = beam(1, free, 0.0)?;
        world.set_substeps(substeps)?;
        let places: Vec<Vec2> = world
            .soft_body(beam)?
            .positions()
            .iter()
            .map(|p| vec2(p.x + 1e-4 * (0.5 * PI * p.x / LENGTH).sin(), p.y))
            .collect();
        world.set_soft_positions(beam, &places)?;
        let frequency = frequency_of(&mut world, beam, 20)?;
        let what = format!("frequency with {substeps} substeps of 1/960 s (Hz)");
        numbers.push(number(what, frequency, exact, 0.02));
    }
    Ok(numbers)
}

/// From the times at which the end passes its place at rest.
fn frequency_of(world: &mut World, beam: SoftHandle, passes: usize) -> Result<Real> {
    let mut times = Vec::new();
    let end = |world: &World| -> Result<Real> {
        let body = world.soft_body(beam)?;
        Ok(body.positions()[at_end(body)[0] as usize].x - LENGTH)
    };
    let (h, mut before) = (1.0 / 960.0, end(world)?);
    while times.len() < passes {
        world.step(h)?;
        let now = end(world)?;
        if before < 0.0 && now >= 0.0 {
            times.push(world.time() - h * now / (now - before));
        }
        before = now;
    }
    Ok((passes - 1) as Real / (times[passes - 1] - times[0]))
}

fn large() -> Result<Vec<Number>> {
    let known = [
        (1.0, 0.301_720_773_800, 0.056_433_236_283_4),
        (2.0, 0.493_457_480_397, 0.160_641_720_825),
        (5.0, 0.713_791_523_612, 0.387_628_360_724),
        (10.0, 0.810_609_024_880, 0.554_995_597_754),
    ];
    let mut numbers = Vec::new();
    for (load, down, inward) in known {
        let (mut world, beam) = beam(2, material(), 0.0)?;
        load_end(&mut world, beam, load * E * INERTIA / (LENGTH * LENGTH))?;
        let way = deflection(&mut world, beam, 12)?;
        numbers.push(number(format!("down at {load} EI/L² (m)"), -way.y, down, 0.03));
        numbers.push(number(format!("inward at {load} EI/L² (m)"), -way.x, inward, 0.03));
    }
    Ok(numbers)
}

fn patch() -> Result<Vec<Number>> {
    let outline = [vec2(0.0, 0.0), vec2(1.0, 0.1), vec2(1.2, 0.9), vec2(0.4, 1.1), vec2(-0.1, 0.6)];
    let mesh = Mesh::polygon(&outline, &[], 0.35)?;
    let pins: Vec<u32> = mesh.border().iter().map(|edge| edge[0]).collect();
    let stretched = |p: &Vec2| vec2(1.1 * p.x + 0.05 * p.y, 0.95 * p.y - 0.1 * p.x);
    let right: Vec<Vec2> = mesh.rest().iter().map(stretched).collect();
    let mut start = right.clone();
    for (i, p) in start.iter_mut().enumerate().filter(|(i, _)| !pins.contains(&(*i as u32))) {
        *p += vec2(0.01, -0.005) * if i % 2 == 0 { 1.0 } else { -1.0 };
    }
    let stiff = Material { damping_ratio: 1.0, damping_frequency: 20.0, ..material() };
    let mut world = World::new(Vec2::zeros())?;
    let body = world.add_soft_body(SoftDef { pins, ..SoftDef::new(mesh, stiff) })?;
    world.set_soft_positions(body, &start)?;
    world.steps(STEP, 600)?;
    let body = world.soft_body(body)?;
    let off = body.positions().iter().zip(&right).map(|(a, b)| (a - b).norm()).fold(0.0, Real::max);
    let strains = body.strains();
    let spread = strains.iter().fold(0.0, |worst: Real, s| {
        (0..3).fold(worst, |worst, k| worst.max((s[k] - strains[0][k]).abs()))
    });
    Ok(vec![
        number("largest distance of a node from its place (m)", off, 0.0, 1e-12),
        number("largest difference of strains", spread, 0.0, 1e-12),
    ])
}

fn rigid() -> Result<Vec<Number>> {
    let mesh = Mesh::rectangle(1.0, 0.4, [6, 2])?;
    let stiff = Material { damping_ratio: 0.0, ..material() };
    let turned =
        SoftDef { position: vec2(30.0, -7.0), angle: 2.0, ..SoftDef::new(mesh.clone(), stiff) };
    let still = SoftBody::new(turned)?;
    let stress = still.stresses().iter().flatten().fold(0.0, |worst: Real, s| worst.max(s.abs()));
    let mut world = World::new(Vec2::zeros())?;
    let thrown =
        SoftDef { velocity: vec2(2.0, 1.0), angular_velocity: 6.0, ..SoftDef::new(mesh, stiff) };
    world.add_soft_body(thrown)?;
    let about = vec2(0.3, 0.2);
    let measure = |world: &World| -> Result<(Vec2, Real, Real)> {
        Ok((world.momentum(), world.angular_momentum(about), world.energy()?.balance()))
    };
    let before = measure(&world)?;
    world.steps(STEP, 600)?;
    let after = measure(&world)?;
    let part = |after: Real, before: Real| (after - before).abs() / before.abs();
    Ok(vec![
        number("largest stress over E after a rigid motion", stress / E, 0.0, 1e-13),
        number("momentum", (after.0 - before.0).norm() / before.0.norm(), 0.0, 1e-12),
        number("angular momentum", part(after.1, before.1), 0.0, 1e-11),
        number("energy", part(after.2, before.2), 0.0, 1e-10),
    ])
}

fn area() -> Result<Vec<Number>> {
    let mut numbers = Vec::new();
    let nu: Real = 0.4999;
    let tough = Material { poissons_ratio: nu, plane: Plane::Strain, ..material() };
    let stiffness = E / (1.0 - nu * nu);
    let exact = LENGTH.powi(3) / (3.0 * stiffness * INERTIA) + LENGTH * shear(E, nu);
    let (mut world, bent) = beam(4, tough, 0.0)?;
    let before = world.soft_body(bent)?.area();
    load_end(&mut world, bent, 1.0)?;
    let down = -deflection(&mut world, bent, 12)?.y;
    numbers.push(number("deflection with 4 rows (m)", down, exact, 0.03));
    let (mut world, pulled) = beam(2, tough, 0.0)?;
    load_end(&mut world, pulled, 50.0)?;
    world.steps(STEP, 720)?;
    let after = world.soft_body(pulled)?.area();
    numbers.push(number("area of a beam bent far (m²)", after, before, 1e-3));
    let ring: Vec<Vec2> = (0..48)
        .map(|k| 0.5 * crate::math::Rot::new(PI / 24.0 * Real::from(k)).apply(vec2(1.0, 0.0)))
        .collect();
    let gas = Gas { pressure: 3000.0, outside: 1000.0, exponent: 1.0 };
    let rope = Rope { stretch_stiffness: 2000.0, bending_stiffness: 0.0 };
    let skin = Material { density: 1.0, damping_ratio: 0.5, damping_frequency: 10.0, ..material() };
    let def = SoftDef {
        gas: Some(gas),
        rope: Some(rope),
        ..SoftDef::new(Mesh::rope(&ring, true)?, skin)
    };
    let mut world = World::new(Vec2::zeros())?;
    let balloon = world.add_soft_body(def)?;
    let rest = world.soft_body(balloon)?.area();
    world.steps(STEP, 600)?;
    let body = world.soft_body(balloon)?;
    let pressure = body.pressure().unwrap_or(Real::NAN) + gas.outside;
    numbers.push(number("p·A of a balloon (N·m)", pressure * body.area(), 3000.0 * rest, 1e-12));
    // Pressure against the tension of the skin: T = p·a, a the apothem at which the sides stand.
    let tension = body.stresses()[0][0];
    let side = (body.positions()[1] - body.positions()[0]).norm();
    let radius = 0.5 * side / (PI / 48.0).sin();
    let apothem = radius * (PI / 48.0).cos();
    numbers.push(number(
        "tension of its skin (N)",
        tension,
        (pressure - gas.outside) * apothem,
        1e-6,
    ));
    Ok(numbers)
}

fn random() -> Result<Vec<Number>> {
    let mut numbers = Vec::new();
    for seed in 1..4_u64 {
        let mesh = Mesh::rectangle(1.0, 0.5, [4, 2])?;
        let damped = Material { damping_ratio: 0.3, damping_frequency: 10.0, ..material() };
        let mut world = World::new(Vec2::zeros())?;
        let body = world.add_soft_body(SoftDef::new(mesh, damped))?;
        let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let mut next = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as Real / (1_u64 << 31) as Real - 0.5
        };
        let count = world.soft_body(body)?.positions().len();
        let places: Vec<Vec2> = (0..count).map(|_| vec2(next(), 0.5 * next())).collect();
        world.set_soft_positions(body, &places)?;
        let start = world.energy()?.total();
        let (mut energy, mut grown) = (start, 0.0_f64);
        for _ in 0..1200 {
            world.step(STEP)?;
            let now = world.energy()?.total();
            grown = grown.max((now - energy) / start);
            energy = now;
        }
        let left = world.soft_body(body)?.strain_energy() / (E * 0.5);
        numbers.push(number(format!("strain energy left over EA, seed {seed}"), left, 0.0, 1e-12));
        numbers.push(number(
            format!("largest growth of energy in a step, seed {seed}"),
            grown,
            0.0,
            1e-12,
        ));
    }
    Ok(numbers)
}
