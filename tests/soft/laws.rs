//! Momentum, angular momentum, energy; snapshots; mirror images.

use super::{STEP, block, material, with_floor};
use culbuto::math::{Real, Vec2, vec2};
use culbuto::shapes::Shape;
use culbuto::soft::SoftDef;
use culbuto::world::Snapshot;
use culbuto::{BodyDef, World};

#[test]
fn momentum_and_angular_momentum_pass_between_soft_and_rigid() {
    let mut world = World::new(Vec2::zeros()).unwrap();
    let thrown =
        SoftDef { velocity: vec2(3.0, 0.2), angular_velocity: 2.0, ..block(material(1e5, 0.1)) };
    world.add_soft_body(thrown).unwrap();
    let mut ball = BodyDef::new(Shape::rectangle(0.7, 0.5).unwrap());
    ball.density = 300.0;
    world.add_body(BodyDef { position: vec2(2.0, 0.3), angular_velocity: -3.0, ..ball }).unwrap();
    let about = vec2(0.4, -0.3);
    let (p, l) = (world.momentum(), world.angular_momentum(about));
    let before = world.bodies().twists[0];
    let balance = world.energy().unwrap().balance();
    world.steps(STEP, 120).unwrap();
    assert!((world.bodies().twists[0].linear - before.linear).norm() > 0.1, "they met");
    assert!((world.momentum() - p).norm() < 1e-12 * p.norm());
    assert!((world.angular_momentum(about) - l).abs() < 1e-10 * l.abs());
    let energy = world.energy().unwrap();
    assert!((energy.balance() - balance).abs() < 1e-10 * balance, "{energy:?}");
    assert!(energy.dissipated >= 0.0);
}

#[test]
fn the_energy_of_a_drop_is_accounted_for_at_any_stiffness() {
    for (stiff, damping) in [(1e2, 0.1), (1e5, 0.0), (1e8, 0.1), (1e11, 0.1), (1e11, 0.0)] {
        let mut world = with_floor();
        let def =
            SoftDef { position: vec2(0.0, 1.5), angle: 0.2, ..block(material(stiff, damping)) };
        world.add_soft_body(def).unwrap();
        let start = world.energy().unwrap();
        let mut dissipated = 0.0;
        for _ in 0..180 {
            world.step(STEP).unwrap();
            let energy = world.energy().unwrap();
            let off = (energy.balance() - start.balance()).abs();
            assert!(off < 1e-8 * start.total(), "E = {stiff:e}: {off:e} J of {}", start.total());
            assert!(energy.dissipated > dissipated - 1e-3 * start.total(), "E = {stiff:e}");
            dissipated = energy.dissipated;
        }
        assert!(world.energy().unwrap().total() < start.total());
    }
}

#[test]
fn work_of_forces_is_energy() {
    let mut world = World::new(Vec2::zeros()).unwrap();
    let body = world.add_soft_body(block(material(1e5, 0.0))).unwrap();
    let mut forces = vec![Vec2::zeros(); world.soft_body(body).unwrap().positions().len()];
    (forces[0], forces[24]) = (vec2(3.0, -20.0), vec2(15.0, 4.0));
    world.set_soft_forces(body, &forces).unwrap();
    world.steps(STEP, 120).unwrap();
    let energy = world.energy().unwrap();
    assert!(energy.work > 1.0);
    assert!((energy.total() - energy.work).abs() < 1e-10 * energy.work);
}

#[test]
fn a_mirrored_scene_moves_mirrored() {
    let run = |sign: Real| {
        let mut world = with_floor();
        let (position, velocity) = (vec2(0.0, 1.2), vec2(2.0 * sign, -1.0));
        let def =
            SoftDef { position, velocity, angular_velocity: sign, ..block(material(1e5, 0.1)) };
        let body = world.add_soft_body(def).unwrap();
        world.steps(STEP, 60).unwrap();
        world.soft_body(body).unwrap().center()
    };
    let (right, left) = (run(1.0), run(-1.0));
    assert!((right.x + left.x).abs() < 1e-4 && (right.y - left.y).abs() < 1e-4, "{right} {left}");
}

#[test]
fn a_snapshot_goes_on_to_the_same_bits() {
    let mut world = with_floor();
    let def =
        SoftDef { position: vec2(0.0, 0.6), velocity: vec2(1.0, 0.0), ..block(material(1e5, 0.1)) };
    let body = world.add_soft_body(def).unwrap();
    world.steps(STEP, 30).unwrap();
    let bytes = world.snapshot().to_bytes().unwrap();
    let mut copy = Snapshot::from_bytes(&bytes, Vec::new()).unwrap().to_world();
    world.steps(STEP, 30).unwrap();
    copy.steps(STEP, 30).unwrap();
    let places = |world: &World| world.soft_body(body).unwrap().positions().to_vec();
    assert_eq!(places(&world), places(&copy));
}
