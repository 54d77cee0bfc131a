//! Fluids: surface tension and adhesion, inflows, drains, lifetimes, several fluids.

#![allow(clippy::unwrap_used)] // helpers of tests may, as tests do

use culbuto::fluid::{FluidHandle, Inflow, Material, lattice_in};
use culbuto::math::{PI, Real, Vec2, vec2};
use culbuto::shapes::{Shape, ShapeDef};
use culbuto::world::Snapshot;
use culbuto::{BodyDef, BodyKind, World};

const DT: Real = 1.0 / 60.0;
const SIGMA: Real = 10.0;

fn rectangle(low: Vec2, high: Vec2) -> Shape {
    let (size, center) = (high - low, (low + high) / 2.0);
    Shape::new(ShapeDef::Box { width: size.x, height: size.y, center, angle: 0.0 }).unwrap()
}

fn wall(world: &mut World, low: Vec2, high: Vec2) {
    let shape = rectangle(low, high);
    world.add_body(BodyDef { kind: BodyKind::Static, ..BodyDef::new(shape) }).unwrap();
}

fn oily(viscosity: Real) -> Material {
    Material { viscosity, tension: SIGMA, ..Material::default() }
}

const RADIUS: Real = 0.2;

/// A drop without gravity, stretched along x by this factor and squeezed along y, and the radius of its area.
fn drop(spacing: Real, stretch: Real, material: Material) -> (World, Real) {
    let mut world = World::new(Vec2::zeros()).unwrap();
    let side = 2.0 * RADIUS;
    let mut points = lattice_in(&rectangle(vec2(-side, -side), vec2(side, side)), spacing).unwrap();
    points.retain(|p| vec2(p.x / stretch, p.y * stretch).norm() < RADIUS);
    world.add_fluid(&points, spacing, material).unwrap();
    let area = points.len() as Real * spacing * spacing;
    (world, (area / PI).sqrt())
}

/// Mean pressure (Pa) of a drop, but for its rim, over a second.
fn pressure(world: &mut World) -> Real {
    let mut mean = 0.0;
    for _ in 0..60 {
        world.step(DT).unwrap();
        let particles = &world.fluids().particles;
        let inner = (0..particles.len()).filter(|&i| particles.positions[i].norm() < 0.6 * RADIUS);
        let inner: Vec<_> = inner.map(|i| particles.pressures[i] + particles.relaxing[i]).collect();
        mean += inner.iter().sum::<Real>() / inner.len() as Real / 60.0;
    }
    mean
}

#[test]
fn the_pressure_in_a_drop_is_tension_over_radius() {
    for spacing in [0.04, 0.02, 0.01] {
        let (mut world, radius) = drop(spacing, 1.0, oily(1.0));
        world.steps(DT, 60).unwrap();
        let ratio = pressure(&mut world) * radius / SIGMA;
        // The border goes through the outer particles, half a spacing inside.
        let bound = 0.02 + 0.75 * spacing / radius;
        assert!((ratio - 1.0).abs() < bound, "{spacing}: {ratio}");
    }
}

/// Times at which a drop that was stretched is as wide as high, in its periods by theory: ω² = n(n² − 1) σ/(ρR³), n = 2.
fn swings(spacing: Real) -> Vec<Real> {
    let (mut world, radius) = drop(spacing, 1.1, oily(0.0));
    let period = 2.0 * PI / (6.0 * SIGMA / (1000.0 * radius.powi(3))).sqrt();
    let (mut times, mut last) = (Vec::new(), (0.0, 1.0));
    for _ in 0..100 {
        world.step(0.014 * period).unwrap();
        let places = &world.fluids().particles.positions;
        let now =
            (world.time() / period, places.iter().map(|p| p.x * p.x - p.y * p.y).sum::<Real>());
        if (now.1 > 0.0) != (last.1 > 0.0) {
            times.push(last.0 + (now.0 - last.0) * last.1 / (last.1 - now.1));
        }
        last = now;
    }
    times
}

#[test]
fn a_drop_swings_with_rayleighs_period() {
    for spacing in [0.02, 0.01] {
        let times = swings(spacing);
        let half = (times[2] - times[0]) / 2.0;
        assert!((half / 0.5 - 1.0).abs() < 0.03, "{spacing}: {times:?}");
    }
}

#[test]
fn tension_keeps_momentum_and_loses_energy_only() {
    let (mut world, _) = drop(0.02, 1.3, oily(0.0));
    let disk = BodyDef {
        position: vec2(0.4, 0.1),
        velocity: vec2(-0.6, 0.0),
        ..BodyDef::new(Shape::circle(0.1).unwrap())
    };
    world.add_body(disk).unwrap();
    let (before, spin) = (world.momentum(), world.angular_momentum(Vec2::zeros()));
    let first = world.energy().unwrap();
    world.steps(DT, 60).unwrap();
    assert!((world.momentum() - before).norm() < 1e-10 * before.norm());
    assert!((world.angular_momentum(Vec2::zeros()) - spin).abs() < 1e-10 * spin.abs());
    let last = world.energy().unwrap();
    assert!(last.total() < first.total());
    assert!(world.bodies().twists[0].linear.x > -0.59);
}

/// What adheres to a free body gives it what it takes. Its angular momentum is not judged: forces act at the body's border, not at particles.
#[test]
fn adhesion_keeps_momentum() {
    let material = Material { adhesion: 1.5 * SIGMA, ..oily(0.5) };
    let (mut world, _) = drop(0.02, 1.0, material);
    let disk = BodyDef { position: vec2(0.3, 0.0), ..BodyDef::new(Shape::circle(0.1).unwrap()) };
    let disk = world.add_body(disk).unwrap();
    world.steps(DT, 60).unwrap();
    let mass = world.mass();
    let drawn = world.body(disk).unwrap().position().x;
    assert!(drawn < 0.299, "it is drawn into the drop: {drawn}");
    assert!(world.momentum().norm() < 1e-12 * mass, "{}", world.momentum());
}

/// Height over radius of what a drop on a floor takes the shape of after a while.
fn flatness(adhesion: Real) -> Real {
    let mut world = World::new(Vec2::zeros()).unwrap();
    wall(&mut world, vec2(-2.0, -0.5), vec2(2.0, 0.0));
    let points = lattice_in(&rectangle(vec2(-0.3, 0.0), vec2(0.3, 0.2)), 0.02).unwrap();
    world.add_fluid(&points, 0.02, Material { adhesion, ..oily(2.0) }).unwrap();
    world.steps(DT, 240).unwrap();
    let places = &world.fluids().particles.positions;
    let high = places.iter().map(|p| p.y).fold(0.0, Real::max) + 0.01;
    high / (0.12 / PI).sqrt()
}

#[test]
fn a_drop_meets_a_wall_at_the_angle_of_young_and_dupre() {
    // Of a segment of a disk whose tangent meets the floor at θ: area R²(θ − sin θ cos θ), height R(1 − cos θ).
    for degrees in [60.0_f64, 90.0, 120.0] {
        let (sin, cos) = degrees.to_radians().sin_cos();
        let exact = (1.0 - cos) * (PI / (degrees.to_radians() - sin * cos)).sqrt();
        let own = flatness(SIGMA * (1.0 + cos));
        assert!((own / exact - 1.0).abs() < 0.1, "{degrees}: {own} for {exact}");
    }
}

/// A jet to the right out of a segment 0.2 m high, without gravity.
fn jet(spacing: Real) -> (World, FluidHandle) {
    let mut world = World::new(Vec2::zeros()).unwrap();
    let fluid = world.add_fluid(&[], spacing, Material::default()).unwrap();
    let inflow = Inflow {
        start: vec2(0.0, 0.0),
        end: vec2(0.0, 0.2),
        velocity: vec2(1.5, 0.0),
        progress: None,
    };
    world.fluids_mut().set_inflows(fluid, &[inflow]).unwrap();
    (world, fluid)
}

#[test]
fn an_inflow_is_a_lattice_that_moves() {
    let (mut world, fluid) = jet(0.04);
    world.steps(DT, 40).unwrap();
    let places = world.fluids().positions(fluid).unwrap();
    // Its first row was born at once, two spacings behind; later ones follow at a spacing.
    let time = 40.0 * DT;
    let rows = (1.5 * time / 0.04).floor();
    assert!((places.len() as Real / 5.0 - rows).abs() <= 2.0, "{}", places.len());
    let front = places.iter().map(|p| p.x).fold(0.0, Real::max);
    assert!((front - (1.5 * time - 0.08)).abs() < 0.04, "{front}");
    for (k, row) in places.chunks(5).rev().enumerate() {
        for (j, place) in row.iter().enumerate() {
            assert!((place.y - 0.02 - 0.04 * j as Real).abs() < 1e-9, "{place:?}");
            assert!((place.x - places[places.len() - 5].x - 0.04 * k as Real).abs() < 1e-9);
        }
    }
    let energy = world.energy().unwrap();
    assert!((energy.work - energy.total()).abs() < 1e-9 * energy.total(), "{energy:?}");
    assert!(energy.balance().abs() < 1e-9 * energy.total(), "{energy:?}");
}

#[test]
fn an_inflow_fills_a_tank_against_gravity() {
    let mut world = World::default();
    wall(&mut world, vec2(-0.5, -0.5), vec2(1.5, 0.0));
    wall(&mut world, vec2(-0.5, 0.0), vec2(0.0, 3.0));
    wall(&mut world, vec2(1.0, 0.0), vec2(1.5, 3.0));
    let water = Material { viscosity: 1.0, ..Material::default() };
    let points = lattice_in(&rectangle(vec2(0.0, 0.0), vec2(1.0, 0.3)), 0.05).unwrap();
    let fluid = world.add_fluid(&points, 0.05, water).unwrap();
    world.steps(DT, 30).unwrap();
    let nozzle = Inflow {
        start: vec2(0.4, 0.1),
        end: vec2(0.6, 0.1),
        velocity: vec2(0.0, 0.5),
        progress: None,
    };
    world.fluids_mut().set_inflows(fluid, &[nozzle]).unwrap();
    let (before, mass) = (world.energy().unwrap(), world.mass());
    world.steps(DT, 60).unwrap();
    let (after, grown) = (world.energy().unwrap(), world.mass() - mass);
    // ρ v × length, in rows.
    assert!((grown - 1000.0 * 0.5 * 0.2).abs() < 25.0, "{grown}");
    // But for what the nozzle holds, which gives way to nothing.
    let particles = &world.fluids().particles;
    let free = particles.positions.iter().zip(&particles.compressions);
    let free = free.filter(|(p, _)| p.y > 0.15 || (p.x - 0.5).abs() > 0.15);
    let most = free.map(|(_, part)| *part).fold(0.0, Real::max);
    assert!(most < 1.1, "{most}");
    assert!((after.balance() - before.balance()).abs() < 1e-9 * after.total(), "{after:?}");
    assert!(after.work > before.work + 9.81 * 0.35 * grown, "{before:?} {after:?}");
}

#[test]
fn drains_and_lifetimes_end_particles() {
    let (mut world, fluid) = jet(0.04);
    world.fluids_mut().set_drains(vec![rectangle(vec2(0.5, -1.0), vec2(1.0, 1.0))]);
    world.steps(DT, 60).unwrap();
    let count = world.fluids().particles.len() as Real;
    assert!((count / 5.0 - 0.58 / 0.04).abs() < 1.5, "{count}");
    world.fluids_mut().set_drains(Vec::new());
    world.fluids_mut().set_lifetime(fluid, Some(0.2)).unwrap();
    world.steps(DT, 60).unwrap();
    let count = world.fluids().particles.len() as Real;
    assert!((count / 5.0 - 0.3 / 0.04).abs() < 1.5, "{count}");
    let energy = world.energy().unwrap();
    assert!(energy.balance().abs() < 1e-9 * energy.total(), "{energy:?}");
    assert!(world.fluids_mut().set_lifetime(fluid, Some(0.0)).is_err());
    let along = Inflow { velocity: vec2(0.0, 1.0), ..world.fluids().inflows(fluid).unwrap()[0] };
    assert!(world.fluids_mut().set_inflows(fluid, &[along]).is_err());
}

/// Rows that would be born faster than steps can follow end the call, even where a drain lets none of them stay.
#[test]
fn absurd_inflows_are_refused() {
    let (mut world, fluid) = jet(0.04);
    let inflow = world.fluids().inflows(fluid).unwrap()[0];
    let long = Inflow { end: inflow.start + vec2(0.0, 1e9), ..inflow };
    let far = Inflow { progress: Some(1e300), ..inflow };
    for wrong in [long, far] {
        assert!(world.fluids_mut().set_inflows(fluid, &[wrong]).is_err());
    }
    world.fluids_mut().set_drains(vec![rectangle(vec2(-10.0, -10.0), vec2(10.0, 10.0))]);
    world.steps(DT, 2).unwrap();
    let fast = Inflow { velocity: inflow.velocity * 1e12, ..inflow };
    world.fluids_mut().set_inflows(fluid, &[fast]).unwrap();
    let before = world.snapshot().to_bytes().unwrap();
    assert!(world.step(DT).is_err());
    assert!(world.snapshot().to_bytes().unwrap() == before, "nothing is lost");
}

#[test]
fn streams_and_surfaces_go_on_bit_for_bit() {
    let (mut world, fluid) = jet(0.04);
    world.fluids_mut().set_material(fluid, oily(0.1)).unwrap();
    world.fluids_mut().set_lifetime(fluid, Some(0.3)).unwrap();
    wall(&mut world, vec2(0.2, -1.0), vec2(0.3, 1.0));
    world.steps(DT, 25).unwrap();
    let bytes = world.snapshot().to_bytes().unwrap();
    let file = culbuto::scenes::SceneFile::from_world(&world).unwrap().to_json();
    let read = culbuto::scenes::SceneFile::from_json(&file).unwrap();
    let others =
        [Snapshot::from_bytes(&bytes, Vec::new()).unwrap().to_world(), read.world().unwrap()];
    assert_eq!(read.to_json(), file);
    world.steps(DT, 10).unwrap();
    for mut other in others {
        other.steps(DT, 10).unwrap();
        assert_eq!(other.fluids().particles, world.fluids().particles);
    }
}

/// Heights of the centres of a heavy and a light fluid of this ratio of densities, one above the other, with a small wave between
/// them, in an open tank or in a box that they fill. Energy does not grow by more than what is taken back of overdensity, 1 %.
fn layers(ratio: Real, heavy_above: bool, closed: bool, steps: u32) -> (Real, Real) {
    let mut world = World::default();
    wall(&mut world, vec2(-0.5, -0.5), vec2(1.0, 0.0));
    wall(&mut world, vec2(-0.5, 0.0), vec2(0.0, 3.0));
    wall(&mut world, vec2(0.5, 0.0), vec2(1.0, 3.0));
    if closed {
        wall(&mut world, vec2(0.0, 1.0), vec2(0.5, 1.5));
    }
    let points = lattice_in(&rectangle(vec2(0.0, 0.0), vec2(0.5, 1.0)), 0.025).unwrap();
    let above = |p: &Vec2| p.y > 0.5 + 0.05 * (2.0 * PI * p.x / 0.5).cos();
    let (top, bottom): (Vec<_>, Vec<_>) = points.iter().partition(|p| above(p));
    let of = |density: Real| Material { density, ..Material::default() };
    let (over, under) =
        if heavy_above { (1000.0, 1000.0 / ratio) } else { (1000.0 / ratio, 1000.0) };
    let over = world.add_fluid(&top, 0.025, of(over)).unwrap();
    let under = world.add_fluid(&bottom, 0.025, of(under)).unwrap();
    let most = 1.01 * world.energy().unwrap().total();
    for _ in 0..steps {
        world.step(DT).unwrap();
        let now = world.energy().unwrap().total();
        assert!(now < most, "{ratio} {now} {most}");
    }
    let mean = |fluid| {
        let places = world.fluids().positions(fluid).unwrap();
        let fastest =
            world.fluids().velocities(fluid).unwrap().iter().map(Vec2::norm).fold(0.0, Real::max);
        let top = if closed { 1.0 } else { Real::INFINITY };
        assert!(places.iter().all(|p| p.y > 0.0 && p.y < top && p.x > 0.0 && p.x < 0.5));
        assert!(fastest < 10.0, "{fastest}");
        places.iter().map(|p| p.y).sum::<Real>() / places.len() as Real
    };
    (mean(over), mean(under))
}

#[test]
fn a_heavy_fluid_falls_through_a_light_one() {
    for (ratio, closed, steps) in [(3.0, false, 180), (10.0, false, 180), (100.0, false, 70)] {
        let (heavy, light) = layers(ratio, true, closed, steps);
        assert!(heavy < light - 0.1, "{ratio} {heavy} {light}");
    }
}

#[test]
fn a_heavy_fluid_in_a_full_box_comes_down_and_nothing_leaves() {
    let (heavy, light) = layers(10.0, true, true, 60);
    assert!(heavy < 0.7 && light > 0.3, "{heavy} {light}");
}

#[test]
fn a_light_fluid_stays_on_a_heavy_one() {
    for ratio in [3.0, 1000.0] {
        let (light, heavy) = layers(ratio, false, false, 60);
        assert!(light - heavy > 0.48, "{ratio} {heavy} {light}");
    }
}
