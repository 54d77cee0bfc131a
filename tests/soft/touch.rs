//! Contact of deformable bodies with rigid ones, with one another, and extremes of it.

use super::{STEP, block, fastest, material, with_floor};
use culbuto::body::{BodyKind, Friction};
use culbuto::math::{Real, Vec2, vec2};
use culbuto::shapes::Shape;
use culbuto::soft::{Gas, Mesh, Rope, SoftDef};
use culbuto::{BodyDef, World};

#[test]
fn a_block_comes_to_rest_on_the_floor_at_any_stiffness() {
    for stiff in [1e4, 1e6, 1e8, 1e11] {
        let mut world = with_floor();
        let def = SoftDef { position: vec2(0.0, 0.6), ..block(material(stiff, 0.3)) };
        let body = world.add_soft_body(def).unwrap();
        world.steps(STEP, 480).unwrap();
        let low = world.soft_body(body).unwrap().positions().iter().map(|p| p.y);
        let low = low.fold(Real::INFINITY, Real::min);
        let radius = world.soft_body(body).unwrap().radius();
        assert!((low - radius).abs() < 1e-4, "E = {stiff:e}: lowest node at {low}");
        let speed = fastest(&world, body);
        assert!(speed < 2e-2, "E = {stiff:e}: {speed:e} m/s");
    }
}

#[test]
fn friction_holds_on_a_slope_and_lets_slide_by_coulombs_law() {
    let slope: Real = 0.3;
    for (friction, slides) in [(0.5, false), (0.1, true)] {
        let gravity = 9.81 * vec2(slope.sin(), -slope.cos());
        let mut world = World::new(gravity).unwrap();
        let shape = Shape::rectangle(400.0, 1.0).unwrap();
        let mut floor = BodyDef { kind: BodyKind::Static, ..BodyDef::new(shape) };
        floor.surface.friction = Friction::of(friction);
        world.add_body(BodyDef { position: vec2(0.0, -0.5), ..floor }).unwrap();
        let mut def = SoftDef { position: vec2(0.0, 0.51), ..block(material(1e6, 0.3)) };
        def.surface.friction = Friction::of(friction);
        let body = world.add_soft_body(def).unwrap();
        world.steps(STEP, 60).unwrap();
        let before = world.soft_body(body).unwrap().momentum().x;
        world.steps(STEP, 60).unwrap();
        let body = world.soft_body(body).unwrap();
        let gained = (body.momentum().x - before) / body.mass();
        let law = if slides { 9.81 * (slope.sin() - friction * slope.cos()) } else { 0.0 };
        assert!((gained - law).abs() < 0.02, "μ = {friction}: {gained} m/s², {law} by Coulomb");
    }
}

#[test]
fn a_heavy_box_presses_a_block_that_springs_back_when_it_is_gone() {
    let mut world = with_floor();
    let mut soft = SoftDef { position: vec2(0.0, 0.52), ..block(material(1e5, 0.3)) };
    // Rough, its foot would stay spread.
    soft.surface.friction = Friction::of(0.0);
    let body = world.add_soft_body(soft).unwrap();
    let rest = world.soft_body(body).unwrap().area();
    let mut weight = BodyDef::new(Shape::rectangle(2.0, 0.5).unwrap());
    // Thirty times as heavy: it rests on the block, a third of whose height is gone.
    weight.density = 3e3;
    let weight = world.add_body(BodyDef { position: vec2(0.0, 1.4), ..weight }).unwrap();
    let start = world.energy().unwrap();
    world.steps(STEP, 120).unwrap();
    let crushed = world.soft_body(body).unwrap().area();
    assert!(crushed < 0.9 * rest, "{crushed} m²");
    assert!(world.energy().unwrap().total() < start.total());
    world.remove_body(weight).unwrap();
    world.steps(STEP, 600).unwrap();
    let back = world.soft_body(body).unwrap().area();
    assert!((back - rest).abs() < 0.02 * rest, "{back} of {rest} m²");
}

/// A box of so many kg per m² that falls on a block of 100 kg: energies at the start and at most, and the block's area after the box is gone,
/// as a part of that at rest.
fn crush(density: Real, friction: Real, height: Real) -> ([Real; 2], Real) {
    let mut world = with_floor();
    let mut soft = SoftDef { position: vec2(0.0, 0.52), ..block(material(1e5, 0.3)) };
    soft.surface.friction = Friction::of(friction);
    let body = world.add_soft_body(soft).expect("allowed");
    let rest = world.soft_body(body).expect("allowed").area();
    let mut weight = BodyDef::new(Shape::rectangle(2.0, 0.5).expect("allowed"));
    (weight.density, weight.surface.friction) = (density, Friction::of(friction));
    let weight =
        world.add_body(BodyDef { position: vec2(0.0, height), ..weight }).expect("allowed");
    let start = world.energy().expect("allowed").total();
    let mut most = start;
    for _ in 0..120 {
        world.step(STEP).expect("allowed");
        most = most.max(world.energy().expect("allowed").total());
    }
    world.remove_body(weight).expect("allowed");
    world.steps(STEP, 600).expect("allowed");
    ([start, most], world.soft_body(body).expect("allowed").area() / rest)
}

#[test]
fn what_is_crushed_flat_gets_no_energy_from_nothing() {
    // Up to 10⁴ times as heavy as the block: it goes through to the floor.
    for (density, friction, height) in
        [(1e4, 0.5, 1.3), (1e5, 0.5, 1.4), (1e6, 0.0, 1.4), (1e6, 0.5, 1.4), (1e6, 0.5, 3.0)]
    {
        let ([start, most], back) = crush(density, friction, height);
        assert!(most <= start * (1.0 + 1e-9), "{density:e}, μ = {friction}: {start:e}, {most:e} J");
        // A rough foot stays as it was spread.
        assert!(friction > 0.0 || (back - 1.0).abs() < 0.02, "{density:e}: {back} of its area");
    }
}

#[test]
fn what_is_put_into_the_floor_comes_out() {
    for gravity in [-9.81, 0.0] {
        let mut world = with_floor();
        world.set_gravity(vec2(0.0, gravity)).unwrap();
        let def = SoftDef { position: vec2(0.0, 0.47), ..block(material(1e5, 0.3)) };
        let body = world.add_soft_body(def).unwrap();
        let low = |world: &World| {
            let body = world.soft_body(body).unwrap();
            body.positions().iter().map(|p| p.y).fold(Real::INFINITY, Real::min) - body.radius()
        };
        let start = low(&world);
        world.steps(STEP, 240).unwrap();
        let end = low(&world);
        assert!(end > 0.1 * start, "{gravity}: from {start} to {end} m");
    }
}

#[test]
fn blocks_stack_on_one_another() {
    let mut world = with_floor();
    let bodies: Vec<_> = (0..3)
        .map(|k| {
            let position = vec2(0.03 * Real::from(k), 0.55 + 1.1 * Real::from(k));
            world.add_soft_body(SoftDef { position, ..block(material(1e5, 1.5)) }).unwrap()
        })
        .collect();
    world.steps(STEP, 480).unwrap();
    for (k, body) in bodies.iter().enumerate() {
        let height = world.soft_body(*body).unwrap().center().y;
        assert!((height - 0.5 - k as Real).abs() < 0.1, "block {k} at {height}");
        assert!(fastest(&world, *body) < 0.05);
    }
}

#[test]
fn a_fast_ball_does_not_pass_through() {
    let mut world = World::new(Vec2::zeros()).unwrap();
    let body = world.add_soft_body(block(material(1e5, 0.1))).unwrap();
    let ball = BodyDef { velocity: vec2(300.0, 0.0), ..BodyDef::new(Shape::circle(0.1).unwrap()) };
    let ball = world.add_body(BodyDef { position: vec2(-2.0, 0.1), density: 1.0, ..ball }).unwrap();
    world.steps(STEP, 60).unwrap();
    let (ball, soft) = (world.body(ball).unwrap().velocity(), world.soft_body(body).unwrap());
    assert!(ball.x < soft.momentum().x / soft.mass(), "ball {ball}");
}

#[test]
fn a_rope_hangs_over_a_drum_and_a_balloon_bears_a_box() {
    let mut world = with_floor();
    let drum = BodyDef { kind: BodyKind::Static, ..BodyDef::new(Shape::circle(0.5).unwrap()) };
    world.add_body(BodyDef { position: vec2(0.0, 3.0), ..drum }).unwrap();
    let points: Vec<Vec2> = (0..41).map(|k| vec2(-1.0 + 0.05 * Real::from(k), 3.6)).collect();
    let rope = Rope { stretch_stiffness: 1e4, bending_stiffness: 0.01 };
    let def = SoftDef::new(Mesh::rope(&points, false).unwrap(), material(1.0, 0.3));
    let mut def = SoftDef { rope: Some(rope), ..def };
    def.material.density = 0.5;
    let rope = world.add_soft_body(def).unwrap();
    let ring: Vec<Vec2> = (0..32)
        .map(|k| {
            let (sin, cos) = (Real::from(k) * std::f64::consts::PI / 16.0).sin_cos();
            vec2(5.0 + 0.6 * cos, 0.65 + 0.6 * sin)
        })
        .collect();
    let skin = Rope { stretch_stiffness: 3e3, bending_stiffness: 0.0 };
    let def = SoftDef::new(Mesh::rope(&ring, true).unwrap(), material(1.0, 0.3));
    let gas = Gas { pressure: 1.02e5, outside: 1e5, exponent: 1.4 };
    let mut def = SoftDef { rope: Some(skin), gas: Some(gas), ..def };
    def.material.density = 1.0;
    let balloon = world.add_soft_body(def).unwrap();
    let load = BodyDef::new(Shape::rectangle(0.6, 0.4).unwrap());
    let load =
        world.add_body(BodyDef { position: vec2(5.0, 1.8), density: 200.0, ..load }).unwrap();
    world.steps(STEP, 600).unwrap();
    let lowest = world.soft_body(rope).unwrap().positions().iter().map(|p| p.y);
    assert!(lowest.fold(Real::INFINITY, Real::min) > 1.5, "the rope hangs on the drum");
    let height = world.body(load).unwrap().position().y;
    assert!(height > 0.7, "the balloon bears the box at {height}");
    let pressure = world.soft_body(balloon).unwrap().pressure().unwrap();
    assert!(pressure > 500.0, "{pressure}");
    world.set_soft_gas(balloon, None).unwrap();
    world.steps(STEP, 300).unwrap();
    assert!(world.body(load).unwrap().position().y < 0.4, "pricked, it bears nothing");
}
