//! What begins and ends to touch deformable bodies, and what hits them.

use super::{STEP, block, material, with_floor};
use culbuto::body::{Filter, Friction, Surface};
use culbuto::math::{Real, Vec2, vec2};
use culbuto::shapes::Shape;
use culbuto::soft::SoftDef;
use culbuto::world::{Snapshot, SoftEvents, Touched};
use culbuto::{BodyDef, World};

/// Steps, and gathers what happens.
fn watch(world: &mut World, steps: u32) -> SoftEvents {
    let mut all = SoftEvents::default();
    for _ in 0..steps {
        world.step(STEP).expect("it steps");
        let SoftEvents { begin, end, hit } = world.soft_events().clone();
        all.begin.extend(begin);
        all.end.extend(end);
        all.hit.extend(hit);
    }
    all
}

#[test]
fn a_block_that_falls_hits_begins_to_touch_and_bears_its_weight() {
    let mut world = with_floor();
    let def = SoftDef { position: vec2(0.0, 1.52), ..block(material(1e6, 1.0)) };
    let soft = world.add_soft_body(def).unwrap();
    let floor = Touched::Body(world.bodies().handles()[0], 0);
    let fallen = watch(&mut world, 40);
    // It may hop off its corners, and each time come back.
    assert_eq!(fallen.begin.len(), fallen.end.len() + 1, "{fallen:?}");
    assert_eq!(fallen.begin[0].time, fallen.hit[0].time);
    let hit = fallen.hit[0];
    assert_eq!((hit.soft, hit.other), (soft, floor));
    let speed = (2.0 * 9.81 * 1.0_f64).sqrt();
    assert!((hit.approach_speed / speed - 1.0).abs() < 0.05, "{}", hit.approach_speed);
    assert!((hit.normal - vec2(0.0, -1.0)).norm() < 1e-9);
    assert!(hit.point.y.abs() < 0.1 && hit.impulse > 1.0, "{hit:?}");
    let settled = watch(&mut world, 600);
    assert_eq!(settled.begin.len(), settled.end.len());
    let calm = watch(&mut world, 60);
    assert!(calm.begin.is_empty() && calm.end.is_empty() && calm.hit.is_empty());
    let contacts = world.soft_contacts();
    assert_eq!(contacts.len(), 1);
    assert!((contacts[0].impulse / (981.0 * STEP) - 1.0).abs() < 1e-6, "{}", contacts[0].impulse);
    // Lifted, it ends.
    let up: Vec<Vec2> =
        world.soft_body(soft).unwrap().positions().iter().map(|p| p + vec2(0.0, 3.0)).collect();
    world.set_soft_positions(soft, &up).unwrap();
    let lifted = watch(&mut world, 1);
    assert_eq!(lifted.end.len(), 1);
    assert_eq!(lifted.end[0].other, floor);
    assert!(world.soft_contacts().is_empty());
}

/// What comes no faster than a substep's fall touches and does not hit.
#[test]
fn what_is_set_down_begins_to_touch_and_hits_nothing() {
    let mut world = with_floor();
    let height = world.add_soft_body(block(material(1e6, 1.0))).unwrap();
    let radius = world.soft_body(height).unwrap().radius();
    world.remove_soft_body(height).unwrap();
    let def = SoftDef { position: vec2(0.0, 0.5 + radius), ..block(material(1e6, 1.0)) };
    world.add_soft_body(def).unwrap();
    let set_down = watch(&mut world, 1);
    assert_eq!((set_down.begin.len(), set_down.hit.len()), (1, 0), "{set_down:?}");
}

#[test]
fn two_that_meet_tell_of_each_other() {
    let mut world = World::new(Vec2::zeros()).unwrap();
    let a = world.add_soft_body(block(material(1e5, 0.1))).unwrap();
    let thrown = SoftDef {
        position: vec2(2.0, 0.1),
        velocity: vec2(-2.0, 0.0),
        ..block(material(1e5, 0.1))
    };
    let b = world.add_soft_body(thrown).unwrap();
    let met = watch(&mut world, 120);
    assert_eq!((met.begin.len(), met.hit.len()), (1, 1), "{met:?}");
    assert_eq!((met.hit[0].soft, met.hit[0].other), (a, Touched::Soft(b)));
    assert!((met.hit[0].approach_speed - 2.0).abs() < 1e-6);
    assert!(met.hit[0].normal.x > 0.99);
    assert_eq!(met.end.len(), 1, "they part again");
}

#[test]
fn filters_and_surfaces_can_be_set() {
    let mut world = with_floor();
    let def = SoftDef { position: vec2(0.0, 0.52), ..block(material(1e5, 0.1)) };
    let soft = world.add_soft_body(SoftDef { velocity: vec2(3.0, 0.0), ..def }).unwrap();
    let slippery = Surface { friction: Friction::of(0.0), ..Surface::default() };
    world.set_soft_surface(soft, slippery.clone()).unwrap();
    let wrong = Surface { restitution: Real::NAN, ..Surface::default() };
    assert!(world.set_soft_surface(soft, wrong).is_err());
    world.steps(STEP, 60).unwrap();
    let speed = world.soft_body(soft).unwrap().momentum().x / 100.0;
    assert!((speed - 3.0).abs() < 1e-9, "without friction it slides on: {speed}");
    world.set_soft_surface(soft, Surface { friction: Friction::of(0.8), ..slippery }).unwrap();
    world.steps(STEP, 60).unwrap();
    let speed = world.soft_body(soft).unwrap().momentum().x / 100.0;
    assert!(speed.abs() < 0.5, "{speed}");
    world.set_soft_filter(soft, Filter { mask: 0, ..Filter::default() }).unwrap();
    world.steps(STEP, 60).unwrap();
    assert!(world.soft_body(soft).unwrap().center().y < -2.0, "it falls through");
}

#[test]
fn a_copy_knows_what_touches_and_a_failed_step_tells_nothing() {
    let mut world = with_floor();
    let def = SoftDef { position: vec2(0.0, 0.6), ..block(material(1e6, 1.0)) };
    world.add_soft_body(def).unwrap();
    world.steps(STEP, 300).unwrap();
    let bytes = world.snapshot().to_bytes().unwrap();
    let mut copy = Snapshot::from_bytes(&bytes, Vec::new()).unwrap().to_world();
    assert_eq!(copy.soft_contacts(), world.soft_contacts());
    copy.step(STEP).unwrap();
    assert!(copy.soft_events().begin.is_empty(), "what touched before begins nothing");
    let before = world.soft_contacts().to_vec();
    world
        .add_body(BodyDef {
            velocity: vec2(1e308, 0.0),
            position: vec2(0.0, 50.0),
            ..BodyDef::new(Shape::circle(0.1).unwrap())
        })
        .unwrap();
    if world.steps(1e10, 2).is_err() {
        assert_eq!(world.soft_contacts(), before);
        assert_eq!(*world.soft_events(), SoftEvents::default());
    }
}
