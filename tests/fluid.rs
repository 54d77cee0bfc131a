//! Fluids: what stands still, what floats, what is conserved, what stays the same.

#![allow(clippy::unwrap_used)] // helpers of tests may, as tests do

use culbuto::fluid::{Material, lattice_in};
use culbuto::math::{Real, Vec2, vec2};
use culbuto::shapes::{Shape, ShapeDef};
use culbuto::world::Snapshot;
use culbuto::{BodyDef, BodyHandle, BodyKind, World};

const DT: Real = 1.0 / 60.0;

fn rectangle(low: Vec2, high: Vec2) -> Shape {
    let (size, center) = (high - low, (low + high) / 2.0);
    Shape::new(ShapeDef::Box { width: size.x, height: size.y, center, angle: 0.0 }).unwrap()
}

fn wall(world: &mut World, low: Vec2, high: Vec2) -> BodyHandle {
    let shape = rectangle(low, high);
    world.add_body(BodyDef { kind: BodyKind::Static, ..BodyDef::new(shape) }).unwrap()
}

/// A tank of this width (m), open above. Gives its floor.
fn tank(world: &mut World, width: Real) -> BodyHandle {
    wall(world, vec2(-0.5, 0.0), vec2(0.0, 4.0));
    wall(world, vec2(width, 0.0), vec2(width + 0.5, 4.0));
    wall(world, vec2(-0.5, -0.5), vec2(width + 0.5, 0.0))
}

fn pour(world: &mut World, (low, high): (Vec2, Vec2), spacing: Real, material: Material) {
    let points = lattice_in(&rectangle(low, high), spacing).unwrap();
    world.add_fluid(&points, spacing, material).unwrap();
}

fn water() -> Material {
    Material { density: 1000.0, viscosity: 0.5, ..Material::default() }
}

/// A drop of fluid around a free disk, without gravity and walls, both turning and moving.
fn free_drop(viscosity: Real) -> World {
    let mut world = World::new(Vec2::zeros()).unwrap();
    let disk = Shape::circle(0.15).unwrap();
    let body = BodyDef {
        density: 400.0,
        velocity: vec2(0.7, -0.3),
        angular_velocity: 3.0,
        ..BodyDef::new(disk)
    };
    world.add_body(body).unwrap();
    let square = rectangle(vec2(-0.4, -0.4), vec2(0.4, 0.4));
    let mut points = lattice_in(&square, 0.04).unwrap();
    points.retain(|p| p.norm() > 0.16);
    world
        .add_fluid(&points, 0.04, Material { density: 1000.0, viscosity, ..Material::default() })
        .unwrap();
    world
}

#[test]
fn water_at_rest_bears_its_weight_and_stays_where_it_is() {
    let mut world = World::default();
    let floor = tank(&mut world, 1.0);
    pour(&mut world, (vec2(0.0, 0.0), vec2(1.0, 1.0)), 0.04, water());
    world.steps(DT, 60).unwrap();
    let (mut force, mut bins) = (0.0, [(0.0, 0.0); 8]);
    for _ in 0..30 {
        world.step(DT).unwrap();
        force -= world.fluid_load(floor).unwrap().force.y / 30.0;
        weigh(&world, &mut bins);
    }
    let weight = 9.81 * world.mass();
    assert!((force / weight - 1.0).abs() < 0.025, "{}", force / weight);
    let height = world.center_of_mass().y;
    assert!((height - 0.5).abs() < 0.006, "{height}");
    let kinetic = world.energy().unwrap().kinetic;
    assert!(kinetic < 3e-4 * weight, "{kinetic}");
    let particles = &world.fluids().particles;
    let mean = particles.compressions.iter().map(|c| (c - 1.0).max(0.0)).sum::<Real>();
    assert!(mean < 1e-3 * particles.len() as Real, "{mean}");
    // The mean pressure at a depth is that of the water above, away from the surface.
    for (sum, exact) in bins {
        assert!((sum / exact - 1.0).abs() < 0.1, "{bins:?}");
    }
}

/// Adds pressures and those of the water above, in layers of a tenth of a metre.
fn weigh(world: &World, bins: &mut [(Real, Real); 8]) {
    let particles = &world.fluids().particles;
    let pressures = particles.pressures.iter().zip(&particles.relaxing);
    for (place, (p, q)) in particles.positions.iter().zip(pressures) {
        if let Some(bin) = bins.get_mut((place.y * 10.0) as usize) {
            bin.0 += p + q;
            bin.1 += 9810.0 * (1.0 - place.y);
        }
    }
}

#[test]
fn momentum_of_fluid_and_body_is_kept() {
    for viscosity in [0.0, 50.0] {
        let mut world = free_drop(viscosity);
        let (before, spin) = (world.momentum(), world.angular_momentum(Vec2::zeros()));
        let scale = before.norm();
        world.steps(DT, 30).unwrap();
        assert!((world.momentum() - before).norm() < 1e-10 * scale, "{viscosity}");
        if viscosity == 0.0 {
            let change = world.angular_momentum(Vec2::zeros()) - spin;
            assert!(change.abs() < 1e-10 * spin.abs(), "{change} of {spin}");
        }
        // The two have met: the disk no longer moves as it did.
        let body = world.bodies().twists[0];
        assert!((body.linear - vec2(0.7, -0.3)).norm() > 0.1, "{body:?}");
    }
}

#[test]
fn energy_never_grows() {
    let mut world = free_drop(0.0);
    let mut last = world.energy().unwrap();
    for _ in 0..60 {
        world.step(DT).unwrap();
        let now = world.energy().unwrap();
        assert!(now.total() <= last.total() * (1.0 + 1e-12), "{now:?} {last:?}");
        assert!((now.balance() - last.balance()).abs() < 1e-12 * last.total());
        last = now;
    }
}

/// The mean acceleration over g of a light disk in the first 20 ms after it is let go in a tank.
fn rise(lightness: Real) -> Real {
    let mut world = World::default();
    tank(&mut world, 2.0);
    let radius = 0.15;
    let center = vec2(1.0, 0.5);
    let square = rectangle(vec2(0.0, 0.0), vec2(2.0, 1.0));
    let mut points = lattice_in(&square, 0.02).unwrap();
    points.retain(|p| (p - center).norm() > radius + 0.01);
    world.add_fluid(&points, 0.02, water()).unwrap();
    let def = BodyDef {
        position: center,
        density: 1000.0 * lightness,
        kind: BodyKind::Static,
        ..BodyDef::new(Shape::circle(radius).unwrap())
    };
    let disk = world.add_body(def).unwrap();
    // Long enough for the water to be at rest.
    world.steps(DT, 60).unwrap();
    world.body_mut(disk).unwrap().set_kind(BodyKind::Dynamic).unwrap();
    world.steps(DT / 2.0, 3).unwrap();
    world.body(disk).unwrap().velocity().y / (1.5 * DT) / 9.81
}

#[test]
fn a_light_disk_rises_against_the_water_it_moves() {
    for s in [0.5, 0.05] {
        let (own, exact) = (rise(s), (1.0 - s) / (1.0 + s));
        assert!((own / exact - 1.0).abs() < 0.1, "{s}: {own} for {exact}");
    }
}

#[test]
fn a_light_box_pinned_under_water_pulls_by_its_buoyancy() {
    let mut world = World::default();
    tank(&mut world, 1.0);
    let square = rectangle(vec2(0.0, 0.0), vec2(1.0, 0.8));
    let mut points = lattice_in(&square, 0.04).unwrap();
    points.retain(|p| (p.x - 0.5).abs() > 0.12 || (p.y - 0.4).abs() > 0.12);
    world.add_fluid(&points, 0.04, water()).unwrap();
    let crate_ = BodyDef {
        position: vec2(0.5, 0.4),
        density: 50.0,
        ..BodyDef::new(Shape::rectangle(0.24, 0.24).unwrap())
    };
    let body = world.add_body(crate_).unwrap();
    let joint = culbuto::JointDef::weld(body, None).at(vec2(0.5, 0.4));
    world.add_joint(joint).unwrap();
    world.steps(DT, 60).unwrap();
    let place = world.body(body).unwrap().position();
    assert!((place - vec2(0.5, 0.4)).norm() < 1e-3, "{place:?}");
    let mut lift = 0.0;
    for _ in 0..20 {
        world.step(DT).unwrap();
        lift += world.fluid_load(body).unwrap().force.y / 20.0;
    }
    let buoyancy = 1000.0 * 9.81 * 0.24 * 0.24;
    assert!((lift / buoyancy - 1.0).abs() < 0.1, "{lift} for {buoyancy}");
}

#[test]
fn threads_and_snapshots_give_the_same_bits() {
    let build = |threads: u32| {
        let mut world = World::default();
        tank(&mut world, 2.0);
        pour(&mut world, (vec2(0.0, 0.0), vec2(0.6, 1.0)), 0.02, water());
        world.set_threads(threads).unwrap();
        world
    };
    let mut one = build(1);
    let mut three = build(3);
    one.steps(DT, 6).unwrap();
    three.steps(DT, 6).unwrap();
    assert_eq!(one.fluids().particles, three.fluids().particles);
    let bytes = one.snapshot().to_bytes().unwrap();
    let mut copy = Snapshot::from_bytes(&bytes, Vec::new()).unwrap().to_world();
    one.steps(DT, 3).unwrap();
    copy.steps(DT, 3).unwrap();
    assert_eq!(one.fluids().particles, copy.fluids().particles);
}

#[test]
fn a_failed_call_leaves_the_fluid_as_it_was() {
    let mut world = free_drop(0.0);
    world.steps(DT, 2).unwrap();
    let before = world.fluids().particles.clone();
    assert!(world.advance(0.1, 1e-6).is_err());
    assert!(world.steps(1e300, 1).is_err());
    assert_eq!(world.fluids().particles, before);
    world.steps(DT, 1).unwrap();
}

#[test]
fn what_is_not_allowed_is_refused() {
    let mut world = World::default();
    let points = [vec2(0.0, 0.0)];
    let material = Material { density: -1.0, viscosity: 0.0, ..Material::default() };
    assert!(world.add_fluid(&points, 0.1, material).is_err());
    assert!(world.add_fluid(&points, 0.0, Material::default()).is_err());
    assert!(world.add_fluid(&[vec2(Real::NAN, 0.0)], 0.1, Material::default()).is_err());
    assert!(world.fluids().list.values().is_empty());
    world.add_fluid(&points, 0.1, Material::default()).unwrap();
    let error = world.add_fluid(&points, 0.2, Material::default()).unwrap_err();
    assert!(error.to_string().contains("spacing"), "{error}");
    assert!(world.set_threads(0).is_err());
}

/// Water that falls on one side of a tank with a box in it, in world or mirrored about x = 0.5, its particles first to last or
/// last to first: where they are after some steps, in the order of the first.
fn splash(mirrored: bool, reversed: bool, steps: u32) -> Vec<Vec2> {
    let mirror = |p: Vec2| if mirrored { vec2(1.0 - p.x, p.y) } else { p };
    let mut world = World::default();
    tank(&mut world, 1.0);
    let mut points = lattice_in(&rectangle(vec2(0.0, 0.0), vec2(0.4, 0.8)), 0.04).unwrap();
    points.iter_mut().for_each(|p| *p = mirror(*p));
    if reversed {
        points.reverse();
    }
    let fluid = world.add_fluid(&points, 0.04, water()).unwrap();
    let position = mirror(vec2(0.5, 0.1));
    let float = Shape::rectangle(0.16, 0.16).unwrap();
    world.add_body(BodyDef { position, density: 400.0, ..BodyDef::new(float) }).unwrap();
    world.steps(DT, steps).unwrap();
    let mut places = world.fluids().positions(fluid).unwrap();
    if reversed {
        places.reverse();
    }
    places.into_iter().map(mirror).collect()
}

fn apart(one: &[Vec2], other: &[Vec2]) -> Real {
    assert_eq!(one.len(), other.len());
    one.iter().zip(other).map(|(a, b)| (a - b).norm()).fold(0.0, Real::max)
}

#[test]
fn mirrored_water_moves_as_in_a_mirror_and_the_order_of_particles_is_no_matter() {
    // A mirror changes the rounding, and so which pressures are left when they are close enough; then motions part.
    for (steps, bound) in [(1, 1e-3), (12, 0.05)] {
        let plain = splash(false, false, steps);
        let off = apart(&plain, &splash(true, false, steps)) / 0.04;
        assert!(off < bound, "{steps}: {off}");
        let off = apart(&plain, &splash(false, true, steps)) / 0.04;
        assert!(off < 1e-12, "{steps}: {off}");
    }
}

/// Steps of a body that falls at this speed (m/s) into water under a fluid of this density (kg/m²), and what of the fluids is not
/// finite, or has gone through the floor or a wall.
fn slam(speed: Real, density: Real) -> usize {
    let mut world = World::default();
    tank(&mut world, 1.0);
    pour(&mut world, (vec2(0.0, 0.0), vec2(1.0, 0.4)), 0.04, water());
    let above = Material { density, viscosity: 0.01, ..Material::default() };
    pour(&mut world, (vec2(0.0, 0.4), vec2(1.0, 0.8)), 0.04, above);
    let body = BodyDef {
        position: vec2(0.45, 1.2),
        velocity: vec2(0.0, -speed),
        density: 800.0,
        ..BodyDef::new(Shape::rectangle(0.2, 0.2).unwrap())
    };
    world.add_body(body).unwrap();
    world.steps(DT, 30).unwrap();
    assert!(world.energy().unwrap().total().is_finite());
    // What has flown over the walls, 4 m high, may be beside them.
    let kept = |p: &&Vec2| p.y > 0.0 && (p.y > 3.9 || (p.x > 0.0 && p.x < 1.0));
    let particles = &world.fluids().particles;
    particles.len() - particles.positions.iter().filter(kept).count()
}

#[test]
fn a_body_that_slams_into_fluids_leaves_them_in_the_tank() {
    assert_eq!(slam(30.0, 1.0), 0);
    assert_eq!(slam(100.0, 1000.0), 0);
}

#[test]
fn a_particle_put_less_than_a_spacing_inside_a_wall_comes_out() {
    for depth in [0.01, 0.03] {
        let mut world = World::default();
        tank(&mut world, 1.0);
        pour(&mut world, (vec2(0.0, 0.0), vec2(1.0, 0.4)), 0.04, water());
        let points = [vec2(0.5, -depth), vec2(-depth, 0.2)];
        let fluid = world.add_fluid(&points, 0.04, water()).unwrap();
        world.steps(DT, 60).unwrap();
        for place in world.fluids().positions(fluid).unwrap() {
            assert!(place.x > 0.0 && place.x < 1.0 && place.y > 0.0 && place.y < 0.5, "{place:?}");
        }
    }
}
