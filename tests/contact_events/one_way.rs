//! Platforms with one side.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

use culbuto::body::Role;
use culbuto::forces::BoxError;
use culbuto::math::{Real, vec2};
use culbuto::shapes::Shape;
use culbuto::world::{ContactHooks, PreSolve};
use culbuto::{BodyDef, BodyHandle, BodyKind, World};

use super::{DT, ball, crate_at, fixed, world};

const UP: Role = Role::OneWay(vec2(0.0, 2.0));

fn shelf(world: &mut World) -> BodyHandle {
    fixed(world, Shape::rectangle(4.0, 0.2).unwrap(), vec2(0.0, -0.1), UP)
}

fn height(world: &World, body: BodyHandle) -> Real {
    world.body(body).unwrap().position().y
}

#[test]
fn a_ball_jumps_up_through_lands_on_top_and_rests() {
    for scale in [1.0, 1e-3, 1e3] {
        let mut world = World::new(vec2(0.0, -9.81 * scale)).unwrap();
        let shelf = Shape::rectangle(4.0 * scale, 0.2 * scale).unwrap();
        fixed(&mut world, shelf, vec2(0.0, -0.1 * scale), UP);
        let def = BodyDef::new(Shape::circle(0.25 * scale).unwrap());
        let (position, velocity) = (vec2(0.3, -2.0) * scale, vec2(0.0, 8.0) * scale);
        let ball = world.add_body(BodyDef { position, velocity, ..def }).unwrap();
        world.steps(DT, 30).unwrap();
        // Free flight: nothing has braked it on its way through.
        let free = -2.0 + 8.0 * 0.5 - 0.5 * 9.81 * 0.25;
        assert!((height(&world, ball) / scale - free).abs() < 1e-9, "{}", height(&world, ball));
        assert!(world.events().begin.is_empty() && world.events().hit.is_empty());
        world.steps(DT, 170).unwrap();
        assert!((height(&world, ball) / scale - 0.25).abs() < 1e-3, "{}", height(&world, ball));
        assert_eq!((world.events().begin.len(), world.events().end.len()), (1, 0));
        assert_eq!(world.contacts().len(), 1);
    }
}

#[test]
fn a_tall_crate_that_turns_back_inside_falls_down_again() {
    let mut world = world();
    shelf(&mut world);
    let crate_ = crate_at(&mut world, vec2(0.0, -1.5));
    world.body_mut(crate_).unwrap().set_velocity(vec2(0.0, 5.0)).unwrap();
    world.steps(DT, 90).unwrap();
    let free = -1.5 + 5.0 * 1.5 - 0.5 * 9.81 * 2.25;
    assert!((height(&world, crate_) - free).abs() < 1e-9);
}

#[test]
fn a_fast_ball_from_above_lands_and_a_side_does_not_stop() {
    let mut world = world();
    shelf(&mut world);
    let fast = ball(&mut world, vec2(0.0, 3.0), vec2(0.0, -20.0));
    let aside = ball(&mut world, vec2(-4.0, -0.1), vec2(30.0, 0.0));
    world.steps(DT, 6).unwrap();
    let x = world.body(aside).unwrap().position().x;
    assert!((x + 1.0).abs() < 1e-9, "{x}");
    world.steps(DT, 60).unwrap();
    assert!((height(&world, fast) - 0.25).abs() < 1e-3);
}

#[test]
fn a_platform_that_moves_up_takes_what_is_above_and_passes_what_is_below() {
    let mut world = world();
    let def = BodyDef {
        kind: BodyKind::Kinematic,
        velocity: vec2(0.0, 1.0),
        role: UP,
        ..BodyDef::new(Shape::rectangle(4.0, 0.2).unwrap())
    };
    let lift = world.add_body(BodyDef { position: vec2(0.0, -0.1), ..def }).unwrap();
    let rider = crate_at(&mut world, vec2(-1.0, 0.5));
    let below = ball(&mut world, vec2(1.0, -1.0), vec2(0.0, 6.0));
    world.steps(DT, 180).unwrap();
    let top = height(&world, lift) + 0.1;
    assert!((top - 3.0).abs() < 1e-9);
    assert!((height(&world, rider) - top - 0.5).abs() < 2e-3, "{}", height(&world, rider) - top);
    assert!((height(&world, below) - top - 0.25).abs() < 2e-3, "{}", height(&world, below) - top);
}

#[test]
fn the_side_turns_with_the_platform() {
    let mut world = World::new(vec2(0.0, 0.0)).unwrap();
    let shape = Shape::rectangle(4.0, 0.2).unwrap();
    let angle = std::f64::consts::FRAC_PI_2; // its upper side now looks to the left
    let def = BodyDef { kind: BodyKind::Static, angle, role: UP, ..BodyDef::new(shape) };
    world.add_body(def).unwrap();
    let left = ball(&mut world, vec2(-2.0, 0.0), vec2(2.0, 0.0));
    let right = ball(&mut world, vec2(2.0, 1.0), vec2(-2.0, 0.0));
    world.steps(DT, 120).unwrap();
    assert!(world.body(left).unwrap().position().x < -0.3);
    assert!((world.body(right).unwrap().position().x + 2.0).abs() < 1e-9);
}

struct DropThrough(AtomicBool);

impl ContactHooks for DropThrough {
    fn pre_solve(&self, contact: &mut PreSolve<'_>) -> Result<(), BoxError> {
        contact.enabled = !self.0.load(Ordering::Relaxed);
        Ok(())
    }
}

#[test]
fn a_ball_drops_through_when_a_hook_lets_go_for_one_step() {
    let mut world = world();
    shelf(&mut world);
    let ball = ball(&mut world, vec2(0.0, 0.25), vec2(0.0, 0.0));
    let hooks = Arc::new(DropThrough(AtomicBool::new(false)));
    world.set_hooks(Some(hooks.clone())).unwrap();
    world.steps(DT, 30).unwrap();
    assert!((height(&world, ball) - 0.25).abs() < 1e-3);
    hooks.0.store(true, Ordering::Relaxed);
    world.steps(DT, 1).unwrap();
    assert_eq!(world.events().end.len(), 1);
    hooks.0.store(false, Ordering::Relaxed);
    world.steps(DT, 60).unwrap();
    assert!(height(&world, ball) < -3.0, "{}", height(&world, ball));
    assert!(world.events().begin.is_empty());
}
