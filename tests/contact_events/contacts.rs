//! Contacts as views.

use culbuto::BodyKind;
use culbuto::body::Role;
use culbuto::math::vec2;
use culbuto::shapes::Shape;

use super::{DT, G, ball, crate_at, fixed, ground, world};

#[test]
fn the_impulses_of_a_resting_box_sum_to_its_weight_times_the_substep() {
    let mut world = world();
    let ground = ground(&mut world);
    let crate_ = crate_at(&mut world, vec2(3.0, 0.5));
    world.steps(DT, 60).unwrap();
    let contacts = world.contacts();
    assert_eq!(contacts.len(), 1);
    let contact = &contacts[0];
    assert_eq!((contact.bodies, contact.indices), ([ground, crate_], [0, 1]));
    assert_eq!((contact.parts, contact.count, contact.sliding), ([0, 0], 2, false));
    assert!((contact.normal - vec2(0.0, 1.0)).norm() < 1e-12);
    let weight = world.body(crate_).unwrap().mass().mass * G;
    let impulse: f64 = contact.normal_impulses.iter().sum();
    assert!((impulse - weight * DT / 4.0).abs() < 1e-9 * impulse, "{impulse}");
    assert!((contact.force() - vec2(0.0, weight)).norm() < 1e-8 * weight);
    let mut places = contact.points.map(|p| p.x);
    places.sort_by(f64::total_cmp);
    assert!((places[0] - 2.5).abs() < 1e-6 && (places[1] - 3.5).abs() < 1e-6, "{places:?}");
    assert!(contact.points.iter().all(|p| p.y.abs() < 1e-6));
    assert!(contact.gaps.iter().all(|gap| gap.abs() < 1e-6));
    assert_eq!(world.contacts_of(ground).unwrap(), contacts);
}

#[test]
fn contacts_far_from_the_origin_are_those_at_the_origin_moved() {
    let [near, far] = [0.0, 1e7].map(|x| {
        let mut world = world();
        for at in [vec2(x, -0.25), vec2(x + 0.1, 0.2)] {
            ball(&mut world, at, vec2(0.0, 0.0));
        }
        world.steps(DT, 1).unwrap();
        world.contacts()[0]
    });
    assert!((near.gaps[0] - far.gaps[0]).abs() < 1e-8);
    assert!((near.points[0] + vec2(1e7, 0.0) - far.points[0]).norm() < 1e-8);
    assert!((near.normal - far.normal).norm() < 1e-7);
}

#[test]
fn what_only_comes_near_is_no_contact() {
    let mut world = world();
    ground(&mut world);
    let high = ball(&mut world, vec2(0.0, 0.26), vec2(0.0, 1.0));
    world.steps(DT, 1).unwrap();
    assert!(world.contacts().is_empty());
    assert!(world.contacts_of(high).unwrap().is_empty());
    world.remove_body(high).unwrap();
    assert!(world.contacts_of(high).is_err());
}

#[test]
fn a_sliding_box_is_told_to_slide_and_its_friction_opposes_it() {
    let mut world = world();
    let ground = ground(&mut world);
    let crate_ = crate_at(&mut world, vec2(0.0, 0.5));
    world.body_mut(crate_).unwrap().set_velocity(vec2(5.0, 0.0)).unwrap();
    world.steps(DT, 6).unwrap();
    let contact = world.contacts()[0];
    assert!(contact.sliding);
    assert_eq!(contact.bodies, [ground, crate_]);
    let (force, weight) = (contact.force(), world.body(crate_).unwrap().mass().mass * G);
    assert!((force - vec2(-0.5 * weight, weight)).norm() < 1e-6 * weight, "{force:?}");
}

#[test]
fn the_body_added_first_comes_first_whichever_moves() {
    let mut world = world();
    let falling = crate_at(&mut world, vec2(0.0, 0.5));
    let ground = ground(&mut world);
    world.steps(DT, 10).unwrap();
    let contact = world.contacts()[0];
    assert_eq!((contact.bodies, contact.indices), ([falling, ground], [0, 1]));
    assert!(contact.normal.y < -0.999);
    assert!(contact.force().y < 0.0, "on the ground: down");
}

#[test]
fn a_rider_stays_on_a_lift_whichever_way_it_goes() {
    for speed in [1.0, -1.0, 5.0] {
        let mut world = world();
        let floor = Shape::rectangle(4.0, 0.2).unwrap();
        let lift = fixed(&mut world, floor, vec2(0.0, -0.1), Role::Solid);
        world.body_mut(lift).unwrap().set_kind(BodyKind::Kinematic).unwrap();
        world.body_mut(lift).unwrap().set_velocity(vec2(0.5, speed)).unwrap();
        let rider = crate_at(&mut world, vec2(-1.0, 0.5));
        world.body_mut(rider).unwrap().set_velocity(vec2(0.5, speed)).unwrap();
        world.steps(DT, 60).unwrap();
        let apart = world.body(rider).unwrap().position() - world.body(lift).unwrap().position();
        assert!((apart - vec2(-1.0, 0.6)).norm() < 1e-9, "{apart:?}");
        let weight = world.body(rider).unwrap().mass().mass * G;
        assert!((world.contacts()[0].force().y - weight).abs() < 1e-9 * weight);
    }
}
