//! Sensors notice, and change nothing.

use culbuto::body::Role;
use culbuto::math::{Real, vec2};
use culbuto::shapes::Shape;
use culbuto::{BodyDef, BodyKind, World};
use proptest::prelude::*;

use super::worlds::bits;
use super::{DT, ball, crate_at, fixed, ground, world};

#[test]
fn a_ball_through_a_sensor_is_noticed_once_and_not_braked() {
    let mut world = World::new(vec2(0.0, 0.0)).unwrap();
    let sensor =
        fixed(&mut world, Shape::rectangle(1.0, 1.0).unwrap(), vec2(0.0, 0.0), Role::Sensor);
    let ball = ball(&mut world, vec2(-2.0, 0.0), vec2(2.0, 0.0));
    let mut inside = 0;
    for _ in 0..20 {
        world.steps(0.1, 1).unwrap();
        inside += world.overlaps_of(sensor).unwrap().len();
        assert_eq!(
            world.overlaps_of(sensor).unwrap().len(),
            world.overlaps_of(ball).unwrap().len()
        );
    }
    // The gap of 1.25 m closes after 0.625 s, and opens again after 1.375 s.
    assert_eq!(inside, 7);
    let x = world.body(ball).unwrap().position().x;
    assert!((x - 2.0).abs() < 1e-14);
    world.body_mut(ball).unwrap().set_position(vec2(-2.0, 0.0)).unwrap();
    world.steps(0.1, 20).unwrap();
    let events = world.events();
    assert_eq!((events.sensor_begin.len(), events.sensor_end.len()), (1, 1));
    assert_eq!(events.sensor_begin[0].bodies, [sensor, ball]);
    assert!(
        (events.sensor_begin[0].time - 2.7).abs() < 1e-9
            && (events.sensor_end[0].time - 3.4).abs() < 1e-9
    );
    assert!(events.begin.is_empty() && events.end.is_empty() && events.hit.is_empty());
    assert!(world.contacts().is_empty());
}

#[test]
fn a_moving_sensor_notices_what_stands_still_and_no_other_sensor() {
    let mut world = World::new(vec2(0.0, 0.0)).unwrap();
    let probe = BodyDef {
        kind: BodyKind::Kinematic,
        role: Role::Sensor,
        velocity: vec2(1.0, 0.0),
        ..BodyDef::new(Shape::circle(0.5).unwrap())
    };
    let wall = fixed(&mut world, Shape::rectangle(1.0, 1.0).unwrap(), vec2(2.0, 0.0), Role::Solid);
    fixed(&mut world, Shape::rectangle(1.0, 1.0).unwrap(), vec2(2.0, 0.0), Role::Sensor);
    let probe = world.add_body(probe).unwrap();
    world.steps(0.1, 15).unwrap();
    assert_eq!(world.events().sensor_begin.len(), 1);
    assert_eq!(world.events().sensor_begin[0].bodies, [probe, wall]);
    world.remove_body(wall).unwrap();
    world.step(0.1).unwrap();
    assert_eq!(world.events().sensor_end.len(), 1);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(16))]

    /// The same trajectory, to the bit, with and without sensors.
    #[test]
    fn sensors_change_no_motion(
        places in prop::collection::vec((-3.0..3.0, 0.5..6.0, -5.0..5.0), 2..10),
        sensors in prop::collection::vec((-3.0..3.0, -0.5..4.0, 0.2..2.0), 1..5),
        pyramid in any::<bool>(),
    ) {
        let fill = |with: bool| {
            let mut world = world();
            ground(&mut world);
            let count = world.bodies().len();
            if pyramid {
                for row in 0..4 {
                    for k in 0..4 - row {
                        let (k, row) = (Real::from(k), Real::from(row));
                        crate_at(&mut world, vec2(k + 0.5 * row - 2.0, 0.5 + row));
                    }
                }
            } else {
                for (x, y, v) in &places {
                    ball(&mut world, vec2(*x, *y), vec2(*v, 0.0));
                }
            }
            let solid = world.bodies().len() - count;
            if with {
                for (x, y, size) in &sensors {
                    let shape = Shape::rectangle(*size, 1.0).unwrap();
                    fixed(&mut world, shape, vec2(*x, *y), Role::Sensor);
                }
            }
            (world, solid + count)
        };
        let ((mut with, n), (mut without, _)) = (fill(true), fill(false));
        with.steps(DT, 60).unwrap();
        without.steps(DT, 60).unwrap();
        // Poses of the solid bodies come first.
        prop_assert_eq!(&bits(&with)[..3 * n], &bits(&without)[..3 * n]);
    }
}
