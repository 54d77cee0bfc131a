//! Beginnings, ends and hits.

use std::collections::HashMap;

use culbuto::body::Filter;
use culbuto::math::{Real, vec2};
use culbuto::shapes::Shape;
use culbuto::{BodyDef, BodyHandle, BodyKind, World};
use proptest::prelude::*;

use super::{DT, G, ball, crate_at, ground, world};

#[test]
fn a_ball_that_lands_hits_begins_and_stays() {
    let mut world = world();
    let ground = ground(&mut world);
    let ball = ball(&mut world, vec2(0.0, 2.25), vec2(0.0, 0.0));
    world.steps(DT, 120).unwrap();
    let events = world.events();
    assert_eq!((events.begin.len(), events.end.len(), events.hit.len()), (1, 0, 1));
    assert_eq!(events.begin[0].bodies, [ground, ball]);
    let hit = &events.hit[0];
    let (time, speed) = ((4.0 / G).sqrt(), (4.0 * G).sqrt());
    assert!((hit.time - time).abs() < 1e-6, "{} {time}", hit.time);
    assert!((hit.approach_speed - speed).abs() < 1e-6 * speed, "{}", hit.approach_speed);
    assert!((hit.point.unwrap() - vec2(0.0, 0.0)).norm() < 1e-6);
    assert!((hit.normal.unwrap() - vec2(0.0, 1.0)).norm() < 1e-9);
    let begin = events.begin[0];
    assert!(begin.time >= hit.time && begin.time < hit.time + DT + 1e-9);
    assert!((begin.point.unwrap()).norm() < 1e-3 && begin.normal.unwrap().y > 0.999);
    // What the next call does is another thing.
    world.steps(DT, 10).unwrap();
    assert!(world.events().is_empty());
}

#[test]
fn the_impulse_of_a_hit_is_the_change_of_momentum() {
    let mut world = World::new(vec2(0.0, 0.0)).unwrap();
    let ball = |x: Real, v: Real, mass: Real| {
        let mut def = BodyDef::new(Shape::circle(0.25).unwrap());
        (def.position, def.velocity, def.mass) = (vec2(x, 0.0), vec2(v, 0.0), Some(mass));
        def.surface.restitution = 0.7;
        def
    };
    let one = world.add_body(ball(0.0, 3.0, 2.0)).unwrap();
    let other = world.add_body(ball(1.0, -1.0, 5.0)).unwrap();
    world.steps(0.01, 40).unwrap();
    let hit = world.events().hit[0];
    assert_eq!(world.events().hit.len(), 1);
    assert_eq!(hit.bodies, [one, other]);
    let change = 5.0 * (world.body(other).unwrap().velocity().x + 1.0);
    assert!((hit.impulse - change).abs() < 1e-12 * change, "{} {change}", hit.impulse);
    assert!((hit.impulse - 2.0 * 5.0 / 7.0 * 1.7 * 4.0).abs() < 1e-12 * change);
    assert!((hit.approach_speed - 4.0).abs() < 1e-12);
    assert!((hit.time - 0.125).abs() < 1e-12, "{}", hit.time);
    assert!((hit.point.unwrap() - vec2(0.625, 0.0)).norm() < 1e-12);
    // They parted in the step they met in: no touch that lasted.
    assert!(world.events().begin.is_empty() && world.events().end.is_empty());
}

#[test]
fn a_ball_over_a_chain_touches_it_once() {
    let mut world = world();
    let points: Vec<_> = (0..40).map(|i| vec2(Real::from(i) * 0.5 - 5.0, 0.0)).rev().collect();
    let chain = Shape::chain(&points, false).unwrap();
    let def = BodyDef { kind: BodyKind::Static, ..BodyDef::new(chain) };
    world.add_body(def).unwrap();
    ball(&mut world, vec2(-4.0, 0.25), vec2(3.0, 0.0));
    world.steps(DT, 150).unwrap();
    assert_eq!(world.events().begin.len(), 1, "{:?}", world.events());
    assert!(world.events().end.is_empty());
}

/// A crate that rests on the ground, for whatever ends its touch.
fn resting() -> (World, BodyHandle, BodyHandle) {
    let mut world = world();
    let ground = ground(&mut world);
    let crate_ = crate_at(&mut world, vec2(0.0, 0.5));
    world.steps(DT, 10).unwrap();
    assert_eq!(world.events().begin.len(), 1);
    (world, ground, crate_)
}

#[test]
fn a_removed_body_ends_its_touch() {
    for first in [true, false] {
        let (mut world, ground, crate_) = resting();
        let bystander = ball(&mut world, vec2(9.0, 9.0), vec2(0.0, 0.0));
        world.remove_body(if first { ground } else { crate_ }).unwrap();
        world.step(DT).unwrap();
        let ends = &world.events().end;
        assert_eq!(ends.len(), 1);
        assert_eq!(ends[0].bodies, [ground, crate_], "named still, though one is gone");
        assert!(world.body(bystander).is_ok());
        world.step(DT).unwrap();
        assert!(world.events().is_empty());
    }
}

#[test]
fn a_filter_that_changes_ends_the_touch_and_begins_it_again() {
    let (mut world, _, crate_) = resting();
    let set = |world: &mut World, mask| {
        let filter = Filter { mask, ..Filter::default() };
        world.body_mut(crate_).unwrap().set_filter(filter).unwrap();
        world.step(1e-6).unwrap();
    };
    set(&mut world, 0);
    assert_eq!((world.events().end.len(), world.events().begin.len()), (1, 0));
    set(&mut world, u32::MAX);
    assert_eq!((world.events().end.len(), world.events().begin.len()), (0, 1));
}

#[test]
fn an_edit_that_changes_no_touch_tells_none() {
    let (mut world, _, crate_) = resting();
    world.body_mut(crate_).unwrap().set_mass(Some(3.0)).unwrap();
    world.step(DT).unwrap();
    assert!(world.events().begin.is_empty() && world.events().end.is_empty());
    // Told or not, a copy by bytes knows the same.
    world.body_mut(crate_).unwrap().set_position(vec2(0.0, 5.0)).unwrap();
    let mut copy = world.snapshot().to_world();
    let bytes = world.snapshot().to_bytes().unwrap();
    let mut read = culbuto::world::Snapshot::from_bytes(&bytes, Vec::new()).unwrap().to_world();
    for world in [&mut world, &mut copy, &mut read] {
        world.step(DT).unwrap();
        assert_eq!((world.events().begin.len(), world.events().end.len()), (0, 1));
    }
}

#[test]
fn an_edit_is_told_by_a_world_that_was_stored_after_it() {
    let (mut world, _, crate_) = resting();
    world.body_mut(crate_).unwrap().set_filter(Filter { mask: 0, ..Filter::default() }).unwrap();
    let bytes = world.snapshot().to_bytes().unwrap();
    let mut read = culbuto::world::Snapshot::from_bytes(&bytes, Vec::new()).unwrap().to_world();
    read.step(DT).unwrap();
    assert_eq!(read.events().end.len(), 1);
}

#[test]
fn a_call_that_fails_tells_nothing_and_forgets_nothing() {
    let mut world = world();
    ground(&mut world);
    let crate_ = crate_at(&mut world, vec2(0.0, 0.6));
    let mut calls = 0;
    let mut watch = || {
        calls += 1;
        if calls > 20 { Err("enough".into()) } else { Ok(()) }
    };
    assert!(world.steps_watched(DT, 60, &mut watch).is_err());
    assert!(world.events().is_empty());
    world.steps(DT, 60).unwrap();
    assert_eq!((world.events().begin.len(), world.events().end.len()), (1, 0));
    // What waits to be told waits on.
    world.remove_body(crate_).unwrap();
    assert!(world.steps_watched(DT, 1, &mut || Err("no".into())).is_err());
    assert!(world.events().is_empty());
    world.step(DT).unwrap();
    assert_eq!(world.events().end.len(), 1);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(24))]

    /// For each two shapes beginnings and ends take turns, whatever happens between the steps, and what touches
    /// at the end is what has begun and not ended.
    #[test]
    fn beginnings_and_ends_take_turns(
        places in prop::collection::vec((-3.0..3.0, 0.3..6.0, -5.0..5.0, any::<bool>()), 2..12),
        edits in prop::collection::vec((0..12_usize, 0..4_u8), 0..6),
        restitution in prop_oneof![Just(0.0), 0.0..1.0_f64],
    ) {
        let mut world = world();
        ground(&mut world);
        for (x, y, v, round) in places {
            let shape = if round { Shape::circle(0.3) } else { Shape::rectangle(0.6, 0.5) }.unwrap();
            let mut def = BodyDef { position: vec2(x, y), velocity: vec2(v, 0.0), ..BodyDef::new(shape) };
            def.surface.restitution = restitution;
            world.add_body(def).unwrap();
        }
        let mut touching: HashMap<_, bool> = HashMap::new();
        for round in 0..8 {
            world.steps(DT, 12).unwrap();
            let events = world.events();
            let mut all: Vec<_> = events.begin.iter().map(|event| (event, true)).collect();
            all.extend(events.end.iter().map(|event| (event, false)));
            all.sort_by(|a, b| a.0.time.total_cmp(&b.0.time));
            for (event, begins) in all {
                let before = touching.insert((event.bodies, event.parts), begins).unwrap_or(false);
                prop_assert_ne!(before, begins, "{:?}", event);
            }
            for hit in &events.hit {
                prop_assert!(hit.approach_speed > 0.0 && hit.impulse > 0.0, "{:?}", hit);
                prop_assert!((hit.normal.unwrap().norm() - 1.0).abs() < 1e-9);
            }
            let mut now: Vec<_> = world.contacts().iter().map(|c| (c.bodies, c.parts)).collect();
            now.dedup();
            for pair in &now {
                prop_assert_eq!(touching.get(pair), Some(&true));
            }
            prop_assert_eq!(now.len(), touching.values().filter(|on| **on).count());
            if let Some((which, how)) = edits.get(round) {
                let handles = world.bodies().handles();
                let body = handles[1 + which % (handles.len() - 1)];
                match how {
                    0 if world.bodies().len() > 2 => world.remove_body(body).unwrap(),
                    1 => world.body_mut(body).unwrap().set_density(2.0).unwrap(),
                    2 => world.body_mut(body).unwrap().set_position(vec2(0.0, 4.0)).unwrap(),
                    _ => world.body_mut(body).unwrap().set_velocity(vec2(0.0, 3.0)).unwrap(),
                }
            }
        }
    }
}
