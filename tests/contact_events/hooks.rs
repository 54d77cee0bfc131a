//! The user's own code in the step, and filters.

use std::sync::Arc;
use std::sync::atomic::{AtomicU32, Ordering};

use culbuto::body::{Filter, Friction};
use culbuto::forces::BoxError;
use culbuto::math::vec2;
use culbuto::shapes::Shape;
use culbuto::world::{ContactHooks, PreSolve, ShapeView};
use culbuto::{BodyDef, BodyHandle, Error, World};
use proptest::prelude::*;

use super::worlds::bits;
use super::{DT, ball, crate_at, ground, world};

/// Whether two crates that fall onto one another touch.
fn meet(world: &mut World, filters: [Filter; 2]) -> bool {
    let bodies = [0.0, 1.2].map(|y| crate_at(world, vec2(0.0, y)));
    for (body, filter) in bodies.into_iter().zip(filters) {
        world.body_mut(body).unwrap().set_filter(filter).unwrap();
    }
    world.body_mut(bodies[1]).unwrap().set_velocity(vec2(0.0, -3.0)).unwrap();
    world.steps(DT, 20).unwrap();
    let met = !world.events().hit.is_empty();
    assert_eq!(met, !world.events().begin.is_empty());
    met
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(32))]

    #[test]
    fn filters_decide_who_meets(
        categories in [0..4_u32, 0..4_u32],
        masks in [0..4_u32, 0..4_u32],
        groups in [-1..2_i32, -1..2_i32],
    ) {
        let [a, b] = [0, 1].map(|k| Filter { category: categories[k], mask: masks[k], group: groups[k] });
        let by_bits = a.category & b.mask != 0 && b.category & a.mask != 0;
        let wanted = if a.group == b.group && a.group != 0 { a.group > 0 } else { by_bits };
        prop_assert_eq!(meet(&mut World::new(vec2(0.0, 0.0)).unwrap(), [a, b]), wanted);
    }
}

/// Lets nothing touch one body, and counts.
struct Ghost {
    body: BodyHandle,
    asked: AtomicU32,
    solved: AtomicU32,
}

impl ContactHooks for Ghost {
    fn allows(&self, a: &ShapeView<'_>, b: &ShapeView<'_>) -> Result<bool, BoxError> {
        self.asked.fetch_add(1, Ordering::Relaxed);
        assert!(a.shape().shape.area() > 0.0 && a.pose().position.x.is_finite());
        Ok(a.body() != self.body && b.body() != self.body)
    }

    fn pre_solve(&self, contact: &mut PreSolve<'_>) -> Result<(), BoxError> {
        self.solved.fetch_add(1, Ordering::Relaxed);
        assert!(contact.count > 0 && (contact.normal.norm() - 1.0).abs() < 1e-12);
        Ok(())
    }
}

#[test]
fn a_filter_hook_lets_through_what_it_does_not_allow() {
    let mut world = world();
    ground(&mut world);
    let ghost = crate_at(&mut world, vec2(3.0, 0.5));
    let other = crate_at(&mut world, vec2(0.0, 0.5));
    world.steps(DT, 5).unwrap();
    let (asked, solved) = (AtomicU32::new(0), AtomicU32::new(0));
    let hooks = Arc::new(Ghost { body: ghost, asked, solved });
    // Set while both stand on the ground: the touch of one ends.
    world.set_hooks(Some(hooks.clone())).unwrap();
    assert_eq!(hooks.asked.load(Ordering::Relaxed), 2);
    world.steps(DT, 10).unwrap();
    assert_eq!(world.events().end.len(), 1);
    assert!(world.body(ghost).unwrap().position().y < 0.4);
    assert!((world.body(other).unwrap().position().y - 0.5).abs() < 1e-3);
    assert_eq!(hooks.solved.load(Ordering::Relaxed), 10);
    // And begins again without the hook.
    world.body_mut(ghost).unwrap().set_position(vec2(3.0, 0.5)).unwrap();
    world.set_hooks(None).unwrap();
    world.steps(DT, 10).unwrap();
    assert_eq!(world.contacts().len(), 2);
    assert_eq!(hooks.solved.load(Ordering::Relaxed), 10);
}

/// Changes what it is told to.
struct Change(fn(&mut PreSolve<'_>));

impl ContactHooks for Change {
    fn pre_solve(&self, contact: &mut PreSolve<'_>) -> Result<(), BoxError> {
        (self.0)(contact);
        Ok(())
    }
}

fn slide(change: fn(&mut PreSolve<'_>)) -> World {
    let mut world = world();
    ground(&mut world);
    let crate_ = crate_at(&mut world, vec2(0.0, 0.5));
    world.body_mut(crate_).unwrap().set_velocity(vec2(4.0, 0.0)).unwrap();
    world.set_hooks(Some(Arc::new(Change(change)))).unwrap();
    world.steps(DT, 30).unwrap();
    world
}

#[test]
fn a_hook_changes_friction_restitution_and_the_speed_of_the_surface() {
    let speed = |world: &World| world.bodies().twists[1].linear.x;
    let smooth = slide(|contact| contact.friction = Friction::of(0.0));
    assert!((speed(&smooth) - 4.0).abs() < 1e-12);
    let rough = slide(|contact| contact.friction = Friction::of(0.1));
    assert!((speed(&rough) - (4.0 - 0.1 * 9.81 * 0.5)).abs() < 1e-9);
    let belt = slide(|contact| contact.tangent_speed = -4.0);
    assert!((speed(&belt) - 4.0).abs() < 1e-9, "{}", speed(&belt));
    let mut bouncy = world();
    ground(&mut bouncy);
    ball(&mut bouncy, vec2(0.0, 1.0), vec2(0.0, -3.0));
    bouncy.set_hooks(Some(Arc::new(Change(|contact| contact.restitution = 1.0)))).unwrap();
    bouncy.steps(DT, 20).unwrap();
    assert!(bouncy.bodies().twists[1].linear.y > 1.0);
}

#[test]
fn numbers_that_are_not_allowed_stop_the_step_and_change_nothing() {
    let mut world = world();
    ground(&mut world);
    crate_at(&mut world, vec2(0.0, 0.5));
    world.steps(DT, 3).unwrap();
    let changes: [fn(&mut PreSolve<'_>); 4] = [
        |contact| contact.friction.sticking = f64::NAN,
        |contact| contact.restitution = 2.0,
        |contact| contact.tangent_speed = f64::INFINITY,
        |contact| contact.rolling_resistance = -1.0,
    ];
    for change in changes {
        world.set_hooks(Some(Arc::new(Change(change)))).unwrap();
        let before = bits(&world);
        assert!(matches!(world.steps(DT, 2), Err(Error::Invalid { .. })));
        assert_eq!(before, bits(&world));
    }
}

struct Fails(AtomicU32);

impl ContactHooks for Fails {
    fn allows(&self, _: &ShapeView<'_>, _: &ShapeView<'_>) -> Result<bool, BoxError> {
        self.0.fetch_add(1, Ordering::Relaxed);
        if self.0.load(Ordering::Relaxed) < 2 { Err("not yet".into()) } else { Ok(true) }
    }
}

#[test]
fn a_hook_that_fails_stops_the_step_and_the_next_one_finds_the_pair_again() {
    let mut world = world();
    ground(&mut world);
    let crate_ = crate_at(&mut world, vec2(0.0, 0.5));
    world.set_hooks(Some(Arc::new(Fails(AtomicU32::new(0))))).unwrap();
    let error = world.steps(DT, 1).unwrap_err();
    assert!(matches!(error, Error::Hook { .. }) && error.to_string().contains("not yet"));
    world.steps(DT, 30).unwrap();
    assert!((world.body(crate_).unwrap().position().y - 0.5).abs() < 1e-3);
    assert_eq!(world.contacts().len(), 1);
}

#[test]
fn a_copy_has_the_hooks_and_a_restored_world_keeps_its_own() {
    let mut world = world();
    ground(&mut world);
    let def = BodyDef::new(Shape::circle(0.25).unwrap());
    world.add_body(BodyDef { position: vec2(0.0, 0.25), ..def }).unwrap();
    let kept = world.snapshot();
    world.set_hooks(Some(Arc::new(Change(|contact| contact.enabled = false)))).unwrap();
    let mut copy = world.clone();
    let mut bare = world.snapshot().to_world();
    world.restore(&kept);
    for (world, falls) in [(&mut world, true), (&mut copy, true), (&mut bare, false)] {
        world.steps(DT, 30).unwrap();
        assert_eq!(world.bodies().poses[1].position.y < 0.0, falls);
    }
}
