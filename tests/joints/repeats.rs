//! The same calls give the same bits, also from a snapshot in the middle.

use culbuto::World;
use culbuto::math::{Real, vec2};
use culbuto::world::Snapshot;
use proptest::prelude::*;

use crate::common::{DT, chain, fewer, joined, joints, pairs};
use crate::contacts::ragdoll;
use crate::worlds::{bits, bytes};

fn goes_on_from_bytes(mut world: World, before: u32) -> Result<(), TestCaseError> {
    world.steps(DT, before).unwrap();
    let kept = bytes(&world);
    let mut again = Snapshot::from_bytes(&kept, Vec::new()).unwrap().to_world();
    let mut twin = world.clone();
    for _ in 0..30 {
        world.step(DT).unwrap();
        again.step(DT).unwrap();
        twin.step(DT).unwrap();
        prop_assert_eq!(bits(&world), bits(&again));
        prop_assert_eq!(bits(&world), bits(&twin));
    }
    prop_assert!(bytes(&world) == bytes(&again));
    Ok(())
}

proptest! {
    #![proptest_config(fewer(4))]

    #[test]
    fn any_joint_goes_on_from_bytes_bit_for_bit(bodies in pairs(), tied in joints(), before in 0..40_u32) {
        goes_on_from_bytes(joined(&bodies, &tied), before)?;
    }
}

proptest! {
    #![proptest_config(fewer(32))]

    #[test]
    fn what_falls_on_the_ground_goes_on_from_bytes_bit_for_bit(before in 0..90_u32, turn in -3.0..3.0_f64) {
        goes_on_from_bytes(ragdoll(turn), before)?;
    }
}

#[test]
fn a_long_chain_gives_the_same_bits_every_time() {
    let run = || {
        let mut world = World::new(vec2(0.0, -9.81)).unwrap();
        chain(&mut world, 30, vec2(0.0, 0.0));
        world.steps(DT, 120).unwrap();
        bits(&world)
    };
    assert_eq!(run(), run());
}

/// A call that fails in the middle leaves the joints as they were.
#[test]
fn an_interrupted_run_leaves_joints_as_they_were() {
    let mut world = World::new(vec2(0.0, -9.81)).unwrap();
    chain(&mut world, 5, vec2(0.0, 0.0));
    world.steps(DT, 20).unwrap();
    let before = bytes(&world);
    let mut left = 7;
    let mut watch = || {
        left -= 1;
        if left == 0 { Err("enough".into()) } else { Ok(()) }
    };
    assert!(world.steps_watched(DT, 100, &mut watch).is_err());
    assert!(before == bytes(&world), "the state has changed");
    let length: Real = world.joints().len() as Real;
    assert_eq!(length, 5.0);
}
