//! What queries do not take, and that they say so.

use culbuto::math::{Pose, Real, vec2};
use culbuto::shapes::{Aabb, Shape};
use culbuto::world::{QueryFilter, distance_between};
use culbuto::{BodyDef, World};

fn says<T: std::fmt::Debug>(result: culbuto::Result<T>, text: &str) {
    let message = result.unwrap_err().to_string();
    assert!(message.contains(text), "{message:?} says nothing of {text:?}");
}

#[test]
fn numbers_that_are_none_are_refused() {
    let mut world = World::default();
    let disk = Shape::circle(1.0).unwrap();
    world.add_body(BodyDef::new(disk.clone())).unwrap();
    let all = QueryFilter::default();
    let zero = vec2(0.0, 0.0);
    for bad in [Real::NAN, Real::INFINITY] {
        let wrong = vec2(0.0, bad);
        let pose = Pose::new(wrong, 0.0);
        says(world.cast_ray(wrong, zero, &all), "start of the ray is (0, ");
        says(world.cast_ray_all(zero, wrong, &all), "way is (0, ");
        says(world.shapes_at(wrong, &all), "point is");
        says(world.nearest(wrong, 1.0, &all), "point is");
        says(world.shapes_in(&Aabb { min: zero, max: wrong }, &all), "upper corner is");
        says(world.boxes_in(&Aabb { min: wrong, max: zero }, &all), "lower corner is");
        says(world.overlapping(&disk, &pose, &all), "position is");
        says(world.cast_shape(&disk, &Pose::new(zero, bad), zero, &all), "angle is");
        says(distance_between((&disk, &pose), (&disk, &pose)), "position is");
    }
    says(world.nearest(zero, Real::NAN, &all), "max_distance is NaN");
    says(world.nearest(zero, -1.0, &all), "max_distance is -1");
    says(world.cast_ray(zero, vec2(1e200, 0.0), &all), "square of the way's length");
    let region = Aabb { min: vec2(1.0, 0.0), max: vec2(0.0, 1.0) };
    says(world.shapes_in(&region, &all), "x of the lower corner is 1; allowed: up to");
}

#[test]
fn bodies_that_are_gone_are_refused() {
    let mut world = World::default();
    let [a, b] = [0.0, 3.0].map(|x| {
        let def = BodyDef { position: vec2(x, 0.0), ..BodyDef::new(Shape::circle(1.0).unwrap()) };
        world.add_body(def).unwrap()
    });
    says(world.distance(a, a), "the other body");
    world.remove_body(b).unwrap();
    says(world.distance(a, b), "no longer in the world");
    let filter = QueryFilter { exclude: &[b], ..QueryFilter::default() };
    says(world.shapes_at(vec2(0.0, 0.0), &filter), "no longer in the world");
}

#[test]
fn at_the_ends_of_the_range_nothing_breaks() {
    let mut world = World::default();
    let disk = Shape::circle(1.0).unwrap();
    for x in [1e300, -1e300, Real::MAX, 0.0] {
        let def = BodyDef { position: vec2(x, 0.0), ..BodyDef::new(disk.clone()) };
        world.add_body(def).unwrap();
    }
    let all = QueryFilter::default();
    for x in [Real::MAX, -Real::MAX, 1e300, 0.0] {
        let at = vec2(x, 0.0);
        for way in [vec2(0.0, 1e150), vec2(-1e150, 0.0), vec2(5e-324, 0.0), vec2(0.0, 0.0)] {
            for hit in world.cast_ray_all(at, way, &all).unwrap() {
                assert!((0.0..=1.0).contains(&hit.fraction), "{hit:?}");
            }
            let pose = Pose::new(at, 1.0);
            for hit in world.cast_shape_all(&disk, &pose, way, &all).unwrap() {
                assert!((0.0..=1.0).contains(&hit.fraction), "{hit:?}");
            }
        }
        let near = world.nearest(at, Real::INFINITY, &all).unwrap();
        assert!(near.is_none_or(|near| near.distance >= 0.0));
    }
}
