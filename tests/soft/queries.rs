//! Where deformable bodies are.

use super::{STEP, block, material};
use culbuto::World;
use culbuto::body::Filter;
use culbuto::math::{Real, Vec2, vec2};
use culbuto::shapes::Aabb;
use culbuto::soft::{Material, Mesh, Rope, SoftDef};
use culbuto::world::SoftFilter;

const ALL: SoftFilter<'static> = SoftFilter { mask: None, category: None, group: 0, exclude: &[] };

/// Two blocks of a metre beside each other and a rope below; borders are 0 thick.
fn scene() -> World {
    let mut world = World::new(Vec2::zeros()).expect("finite");
    for x in [0.0, 3.0] {
        let filter = Filter { category: if x > 0.0 { 2 } else { 1 }, ..Filter::default() };
        let def = SoftDef {
            position: vec2(x, 0.0),
            radius: Some(0.0),
            filter,
            ..block(material(1e5, 0.1))
        };
        world.add_soft_body(def).expect("it is allowed");
    }
    let mesh =
        Mesh::rope(&[vec2(-1.0, -2.0), vec2(1.0, -2.0), vec2(4.0, -2.0)], false).expect("a rope");
    let rope = Some(Rope { stretch_stiffness: 1e3, bending_stiffness: 0.0 });
    let def = SoftDef { rope, radius: Some(0.1), ..SoftDef::new(mesh, Material::default()) };
    world.add_soft_body(def).expect("it is allowed");
    world
}

#[test]
fn points_are_in_what_holds_them() {
    let world = scene();
    let [a, b, rope] = world.soft_handles().try_into().unwrap();
    let at = |x: Real, y: Real| world.soft_bodies_at(vec2(x, y), &ALL).unwrap();
    assert_eq!(at(0.4, -0.45), [a]);
    assert_eq!(at(3.0, 0.0), [b]);
    assert_eq!(at(1.5, 0.0), []);
    assert_eq!(at(2.0, -2.05), [rope]);
    assert_eq!(at(2.0, -2.2), []);
    assert!(world.soft_bodies_at(vec2(Real::NAN, 0.0), &ALL).is_err());
}

#[test]
fn regions_meet_borders_and_what_is_inside() {
    let world = scene();
    let [a, b, rope] = world.soft_handles().try_into().unwrap();
    let within = |min: Vec2, max: Vec2| world.soft_bodies_in(&Aabb { min, max }, &ALL).unwrap();
    assert_eq!(within(vec2(-0.1, -0.1), vec2(0.1, 0.1)), [a], "all inside it");
    assert_eq!(within(vec2(0.45, -3.0), vec2(2.55, 0.0)), [a, b, rope]);
    assert_eq!(within(vec2(0.6, -1.0), vec2(2.4, 1.0)), []);
    assert_eq!(within(vec2(-9.0, -9.0), vec2(9.0, 9.0)), [a, b, rope]);
    assert!(
        world.soft_bodies_in(&Aabb { min: vec2(1.0, 0.0), max: vec2(0.0, 1.0) }, &ALL).is_err()
    );
}

#[test]
fn rays_meet_the_first_border_on_their_way() {
    let world = scene();
    let [a, b, rope] = world.soft_handles().try_into().unwrap();
    let hit = world.cast_ray_soft(vec2(-2.0, 0.1), vec2(8.0, 0.0), &ALL).unwrap().unwrap();
    assert_eq!(hit.body, a);
    assert!(
        (hit.fraction - 1.5 / 8.0).abs() < 1e-12 && (hit.point - vec2(-0.5, 0.1)).norm() < 1e-12
    );
    assert!((hit.normal - vec2(-1.0, 0.0)).norm() < 1e-12);
    let only = SoftFilter { mask: Some(2), ..ALL };
    assert_eq!(
        world.cast_ray_soft(vec2(-2.0, 0.1), vec2(8.0, 0.0), &only).unwrap().unwrap().body,
        b
    );
    // A query of a category sees those that let it in, one of a group by the group alone.
    let mut world = world;
    let blind = Filter { mask: 1, ..world.soft_body(a).unwrap().def().filter };
    world.set_soft_filter(a, blind).unwrap();
    let first = |filter: &SoftFilter<'_>| {
        world.cast_ray_soft(vec2(-2.0, 0.1), vec2(8.0, 0.0), filter).unwrap().unwrap().body
    };
    assert_eq!(first(&SoftFilter { category: Some(1), ..ALL }), a);
    assert_eq!(first(&SoftFilter { category: Some(2), ..ALL }), b);
    let not = [a];
    let but = SoftFilter { exclude: &not, ..ALL };
    assert_eq!(
        world.cast_ray_soft(vec2(-2.0, 0.1), vec2(8.0, 0.0), &but).unwrap().unwrap().body,
        b
    );
    let inside = world.cast_ray_soft(vec2(0.0, 0.0), vec2(0.0, 5.0), &ALL).unwrap().unwrap();
    assert_eq!((inside.fraction, inside.normal), (0.0, vec2(0.0, -1.0)));
    let down = world.cast_ray_soft(vec2(1.5, 0.0), vec2(0.0, -5.0), &ALL).unwrap().unwrap();
    assert_eq!(down.body, rope);
    assert!((down.point.y + 1.9).abs() < 1e-12, "its thickness counts: {}", down.point);
    assert!(world.cast_ray_soft(vec2(1.5, 0.0), vec2(0.0, 5.0), &ALL).unwrap().is_none());
}

#[test]
fn the_nearest_is_found_within_a_distance() {
    let world = scene();
    let [a, _, rope] = world.soft_handles().try_into().unwrap();
    let near = world.nearest_soft(vec2(0.0, 0.8), Real::INFINITY, &ALL).unwrap().unwrap();
    assert_eq!(near.body, a);
    assert!((near.distance - 0.3).abs() < 1e-12 && (near.point - vec2(0.0, 0.5)).norm() < 1e-12);
    assert!(world.nearest_soft(vec2(0.0, 0.8), 0.2, &ALL).unwrap().is_none());
    let inside = world.nearest_soft(vec2(0.2, 0.1), 0.0, &ALL).unwrap().unwrap();
    assert_eq!((inside.body, inside.distance, inside.point), (a, 0.0, vec2(0.2, 0.1)));
    let below = world.nearest_soft(vec2(2.0, -3.0), 9.0, &ALL).unwrap().unwrap();
    assert_eq!(below.body, rope);
    assert!((below.distance - 0.9).abs() < 1e-12);
    assert!(world.nearest_soft(vec2(0.0, 0.0), -1.0, &ALL).is_err());
}

/// Queries see nodes where they are, and change nothing.
#[test]
fn queries_follow_the_nodes() {
    let (mut asked, mut left) = (scene(), scene());
    let soft = asked.soft_handles()[0];
    for world in [&mut asked, &mut left] {
        let up: Vec<Vec2> =
            world.soft_body(soft).unwrap().positions().iter().map(|p| p + vec2(0.0, 7.0)).collect();
        world.set_soft_positions(soft, &up).unwrap();
    }
    assert_eq!(asked.soft_bodies_at(vec2(0.0, 7.2), &ALL).unwrap(), [soft]);
    assert!(asked.soft_bodies_at(vec2(0.0, 0.2), &ALL).unwrap().is_empty());
    asked.step(STEP).unwrap();
    left.step(STEP).unwrap();
    assert_eq!(
        asked.soft_body(soft).unwrap().positions(),
        left.soft_body(soft).unwrap().positions()
    );
}
