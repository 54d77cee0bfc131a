//! Contacts eight at a time against one by one: the same bits in whole worlds.

use proptest::prelude::*;

use crate::body::{BodyDef, BodyKind, Friction, ImpactLaw};
use crate::math::{Real, vec2};
use crate::shapes::Shape;
use crate::world::World;

const DT: Real = 1.0 / 60.0;

/// What each is, its size, where over its column it lies, and its turn.
type Crowd = Vec<(u8, Real, Real, Real)>;

fn crowds() -> impl Strategy<Value = Crowd> {
    let one = (0..5_u8, 0.4..0.9_f64, -0.1..0.1_f64, -1.5..1.5_f64);
    prop::collection::vec(one, 60..90)
}

fn given(kind: BodyKind, (width, height): (Real, Real), (x, y): (Real, Real)) -> BodyDef {
    BodyDef { kind, position: vec2(x, y), ..BodyDef::new(Shape::rectangle(width, height).unwrap()) }
}

/// A crowd over a bin with a floor that drives, a slow paddle and walls.
fn bin(crowd: &Crowd, friction: Friction) -> World {
    let mut world = World::new(vec2(0.0, -10.0)).unwrap();
    world.set_impact_law(ImpactLaw::Newton);
    let mut floor = given(BodyKind::Static, (12.0, 2.0), (0.0, -1.0));
    floor.surface.tangent_speed = 0.3;
    let paddle =
        BodyDef { angular_velocity: 0.4, ..given(BodyKind::Kinematic, (2.0, 0.2), (0.0, 1.5)) };
    let walls = [-4.5, 4.5].map(|x| given(BodyKind::Static, (1.0, 30.0), (x, 14.0)));
    for mut def in [floor, paddle].into_iter().chain(walls) {
        def.surface.friction = friction;
        world.add_body(def).unwrap();
    }
    for (k, (what, size, aside, turn)) in crowd.iter().enumerate() {
        let shape = match what {
            0 => Shape::circle(0.5 * size).unwrap(),
            1 | 2 => Shape::rectangle(*size, 0.7 * size).unwrap(),
            3 => Shape::regular_polygon(5, 0.5 * size).unwrap(),
            _ => Shape::capsule(vec2(-0.3 * size, 0.0), vec2(0.3 * size, 0.0), 0.2 * size).unwrap(),
        };
        let (column, row) = ((k % 7) as Real, (k / 7) as Real);
        let mut def = BodyDef {
            position: vec2(1.1 * (column - 3.0) + aside, 2.2 + 0.95 * row),
            angle: *turn,
            ..BodyDef::new(shape)
        };
        def.surface.friction = friction;
        world.add_body(def).unwrap();
    }
    world
}

/// Steps two worlds of the same bodies, one of them one by one, and compares all that a step leaves.
fn compare(packed: &mut World, single: &mut World, steps: u32) -> Result<(), TestCaseError> {
    single.scratch.contacts.group.one_by_one();
    for step in 0..steps {
        packed.step(DT).unwrap();
        single.step(DT).unwrap();
        let pairs = packed.bodies().twists.iter().zip(&single.bodies().twists);
        for (body, (packed, single)) in pairs.enumerate() {
            prop_assert_eq!(packed, single, "body {} in step {}", body, step);
        }
        prop_assert_eq!(&packed.bodies().poses, &single.bodies().poses);
        let impulses = |world: &World| -> Vec<[Real; 3]> {
            world.state.contacts.patches.iter().map(|patch| patch.memory.impulse).collect()
        };
        prop_assert_eq!(impulses(packed), impulses(single));
        prop_assert_eq!(packed.state.ledger, single.state.ledger);
        prop_assert_eq!(packed.report().sweeps, single.report().sweeps);
        prop_assert_eq!(&packed.events().hit, &single.events().hit);
    }
    Ok(())
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 12, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn packets_move_a_crowd_to_the_bits_of_one_by_one(
        crowd in crowds(), sticking in 0.0..1.0_f64, part in 0.5..=1.0_f64,
    ) {
        let friction = Friction { sticking, sliding: sticking * part };
        compare(&mut bin(&crowd, friction), &mut bin(&crowd, friction), 150)?;
    }
}

#[test]
fn packets_move_a_pyramid_to_the_bits_of_one_by_one() {
    let pyramid = || {
        let mut world = World::new(vec2(0.0, -10.0)).unwrap();
        world.add_body(given(BodyKind::Static, (40.0, 2.0), (0.0, -1.0))).unwrap();
        for row in 0..16 {
            for column in 0..16 - row {
                let x = Real::from(column) + 0.5 * Real::from(row);
                let place = (x - 8.0, Real::from(row) + 0.5);
                world.add_body(given(BodyKind::Dynamic, (1.0, 1.0), place)).unwrap();
            }
        }
        world
    };
    let (mut packed, mut single) = (pyramid(), pyramid());
    compare(&mut packed, &mut single, 40).unwrap();
    // Every one of its steps, but perhaps for the first, in which nothing touches yet.
    assert!(packed.scratch.contacts.group.packings() >= 39);
    assert_eq!(single.scratch.contacts.group.packings(), 0);
}
