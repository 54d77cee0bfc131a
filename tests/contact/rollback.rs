//! After any error the world goes on bit for bit as if the call had not been made.

use culbuto::math::{Real, vec2};
use culbuto::shapes::Shape;
use culbuto::world::Snapshot;
use culbuto::{BodyDef, World};
use proptest::prelude::*;

use crate::common::{DT, bin, fewer, pyramid, rush};
use crate::worlds::{FailsAfter, bits, bytes};

/// Goes on for `steps`, and gives all that was seen on the way.
fn future(world: &World, steps: u32) -> Vec<Vec<u64>> {
    let mut world = world.clone();
    let see = |_| {
        world.step(DT).unwrap();
        bits(&world)
    };
    (0..steps).map(see).collect()
}

proptest! {
    #![proptest_config(fewer(16))]

    #[test]
    fn interrupted_steps_leave_contacts_pairs_and_impulses_as_they_were(
        bodies in rush(6), before in 0..60_u32, during in 0..40_u32,
    ) {
        let mut world = bin(&bodies);
        world.steps(DT, before).unwrap();
        let (state, then) = (bytes(&world), future(&world, 40));
        let mut left = during;
        let mut watch = || {
            left = left.checked_sub(1).ok_or("enough")?;
            Ok(())
        };
        prop_assert!(world.steps_watched(DT, 100, &mut watch).is_err());
        prop_assert!(state == bytes(&world), "the state has changed");
        prop_assert!(then == future(&world, 40), "the world goes on differently");
    }

    #[test]
    fn a_step_whose_field_fails_leaves_contacts_as_they_were(
        bodies in rush(6), before in 0..60_u32, later in 0.0..0.5_f64,
    ) {
        let mut world = bin(&bodies);
        world.steps(DT, before).unwrap();
        let then = future(&world, 40);
        let field = world.add_field(FailsAfter(world.time() + later));
        let with_field = bytes(&world);
        prop_assert!(world.steps(DT, 100).is_err());
        prop_assert!(with_field == bytes(&world), "the state has changed");
        world.remove_field(field).unwrap();
        prop_assert!(then == future(&world, 40), "the world goes on differently");
    }

    #[test]
    fn a_pile_goes_on_from_bytes_bit_for_bit(bodies in rush(6), before in 0..90_u32) {
        let mut world = bin(&bodies);
        world.steps(DT, before).unwrap();
        let copy = Snapshot::from_bytes(&bytes(&world), Vec::new()).unwrap().to_world();
        prop_assert!(future(&world, 60) == future(&copy, 60), "the copy goes on differently");
    }
}

#[test]
fn a_position_that_leaves_the_numbers_leaves_the_pile_as_it_was() {
    let mut world = pyramid(5);
    world.steps(DT, 30).unwrap();
    let mut far = world.clone();
    let stray = BodyDef { velocity: vec2(1e307, 0.0), ..BodyDef::new(Shape::circle(0.1).unwrap()) };
    far.add_body(BodyDef { position: vec2(0.0, 50.0), ..stray }).unwrap();
    let before = bytes(&far);
    assert!(far.steps(1.0, 40).is_err());
    assert_eq!(before, bytes(&far));
}

/// What touched it is gone: it must fall, and nothing may ask for the contact that was.
#[test]
fn a_body_whose_only_neighbour_is_removed_moves_on_alone() {
    let mut world = World::new(vec2(0.0, -10.0)).unwrap();
    let disk =
        |y: Real| BodyDef { position: vec2(0.0, y), ..BodyDef::new(Shape::circle(0.5).unwrap()) };
    let low = world.add_body(disk(0.0)).unwrap();
    let high = world.add_body(disk(1.0)).unwrap();
    world.steps(DT, 3).unwrap();
    let (y, v) = (world.body(high).unwrap().position().y, world.body(high).unwrap().velocity().y);
    world.remove_body(low).unwrap();
    world.steps(DT, 60).unwrap();
    let fallen = world.body(high).unwrap().position().y;
    assert!((fallen - (y + v - 5.0)).abs() < 1e-12, "{fallen}");
}
