//! What rests goes on resting.

use culbuto::math::{Real, vec2};
use culbuto::shapes::Shape;
use culbuto::{BodyDef, World};

use crate::common::{DT, floor, pyramid, surface};
use crate::worlds::assert_below;

/// Largest way and speed of any body in `steps`.
fn stir(world: &mut World, steps: u32) -> (Real, Real) {
    let start = world.bodies().poses.clone();
    world.steps(DT, steps).unwrap();
    let bodies = world.bodies();
    let ways =
        bodies.poses.iter().zip(&start).map(|(now, then)| (now.position - then.position).norm());
    let speeds = bodies.twists.iter().map(|v| v.linear.norm() + v.angular.abs());
    (ways.fold(0.0, Real::max), speeds.fold(0.0, Real::max))
}

fn stack(sizes: &[Real], friction: Real) -> World {
    let mut world = floor(friction);
    let mut top = 0.0;
    for size in sizes {
        let def = BodyDef {
            position: vec2(0.0, top + 0.5 * size),
            surface: surface(friction, 0.0),
            ..BodyDef::new(Shape::rectangle(*size, *size).unwrap())
        };
        world.add_body(def).unwrap();
        top += size;
    }
    world
}

#[test]
fn a_stack_of_ten_boxes_stays() {
    let mut world = stack(&[1.0; 10], 0.6);
    let (way, speed) = stir(&mut world, 600);
    assert_below("way in 10 s", way, 1e-3);
    assert_below("speed", speed, 1e-3);
}

#[test]
fn a_pyramid_of_base_ten_stays() {
    let mut world = pyramid(10);
    let (way, speed) = stir(&mut world, 600);
    assert_below("way in 10 s", way, 2e-3);
    assert_below("speed", speed, 1e-3);
}

/// tan 20° = 0.364 < 0.37: it must not creep. Box2D 3 creeps by 0.56 mm in 10 s.
#[test]
fn a_box_on_a_ramp_below_the_angle_of_friction_does_not_creep() {
    let mut world = floor(0.37);
    let angle: Real = 20.0_f64.to_radians();
    let (sin, cos) = culbuto::math::sin_cos(angle);
    world.set_gravity(vec2(-10.0 * sin, -10.0 * cos)).unwrap();
    let def = BodyDef {
        position: vec2(0.0, 0.5),
        surface: surface(0.37, 0.0),
        ..BodyDef::new(Shape::rectangle(1.0, 1.0).unwrap())
    };
    world.add_body(def).unwrap();
    let (way, speed) = stir(&mut world, 600);
    assert_below("way in 10 s", way, 1e-9);
    assert_below("speed", speed, 1e-10);
}

#[test]
fn a_stack_upside_down_in_size_stays() {
    let mut world = stack(&[0.4, 0.6, 0.9], 0.6);
    let (way, speed) = stir(&mut world, 300);
    assert_below("way in 5 s", way, 1e-3);
    assert_below("speed", speed, 1e-4);
}
