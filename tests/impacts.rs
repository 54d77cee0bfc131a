//! Impacts that do not brake twice, and fall on their moment.

use culbuto::World;
use culbuto::body::{BodyDef, BodyKind, Friction, Surface};
use culbuto::math::{Real, Vec2, vec2};
use culbuto::shapes::Shape;
use proptest::prelude::*;

fn elastic() -> Surface {
    Surface { friction: Friction::of(0.0), restitution: 1.0, ..Surface::default() }
}

/// The path after an impact is not theirs before it: rows that looked at it there braked disks that only graze.
#[test]
fn disks_that_graze_keep_their_energy() {
    for part in [0.9, 0.99, 0.999, 0.9999] {
        for phase in 0..100 {
            let mut world = World::new(vec2(0.0, 0.0)).unwrap();
            let x = 0.02 * Real::from(phase) / 100.0 - 0.2;
            for (position, velocity) in
                [(vec2(0.0, 0.0), vec2(0.0, 0.0)), (vec2(x, 0.6 * part), vec2(11.4, 0.0))]
            {
                let surface = elastic();
                let shape = Shape::circle(0.3).unwrap();
                world
                    .add_body(BodyDef { position, velocity, surface, ..BodyDef::new(shape) })
                    .unwrap();
            }
            let before = world.energy().unwrap().total();
            world.steps(1.0 / 60.0, 3).unwrap();
            let after = world.energy().unwrap().total();
            assert!(
                (after / before - 1.0).abs() < 1e-13,
                "{part} {phase}: {:e}",
                after / before - 1.0
            );
        }
    }
}

/// 100 disks of 0.6 m in a box of 20 × 20 m, in rows.
fn gas(velocities: &[Vec2]) -> culbuto::Result<World> {
    let mut world = World::new(vec2(0.0, -10.0))?;
    for side in [-10.5, 10.5] {
        let walls = [(vec2(side, 0.0), [1.0, 22.0]), (vec2(0.0, side), [22.0, 1.0])];
        for (position, [width, height]) in walls {
            let shape = Shape::rectangle(width, height)?;
            let (kind, surface) = (BodyKind::Static, elastic());
            world.add_body(BodyDef { kind, position, surface, ..BodyDef::new(shape) })?;
        }
    }
    for (k, velocity) in velocities.iter().enumerate() {
        let position = vec2(2.0 * (k % 10) as Real - 9.0, 2.0 * (k / 10) as Real - 9.0);
        let (velocity, surface) = (*velocity, elastic());
        let shape = Shape::circle(0.3)?;
        world.add_body(BodyDef { position, velocity, surface, ..BodyDef::new(shape) })?;
    }
    Ok(world)
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 6, failure_persistence: None, ..ProptestConfig::default() })]

    /// What one impact sends towards a third body meets that one in the same step, not a step late and deep inside. A disk that arrives at
    /// less than the kick of a substep, g·h, comes to rest, which takes up to ½m(gh)² = 1e-6 of the energy.
    #[test]
    fn a_gas_under_gravity_keeps_its_energy(
        velocities in prop::collection::vec((-5.0..5.0_f64, -5.0..5.0_f64).prop_map(|(x, y)| vec2(x, y)), 100),
    ) {
        let mut world = gas(&velocities).unwrap();
        let before = world.energy().unwrap();
        for step in 0..1800 {
            world.step(1.0 / 60.0).unwrap();
            let change = (world.energy().unwrap().total() - before.total()) / before.kinetic;
            prop_assert!(change.abs() < 1e-5, "{change:e} in step {step}");
        }
    }
}
