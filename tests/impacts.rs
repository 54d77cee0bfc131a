//! Impacts that do not brake twice, and fall on their moment.

use culbuto::World;
use culbuto::body::{BodyDef, Friction, Surface};
use culbuto::math::{Real, vec2};
use culbuto::shapes::Shape;

/// The path after an impact is not theirs before it: rows that looked at it there braked disks that only graze.
#[test]
fn disks_that_graze_keep_their_energy() {
    for part in [0.9, 0.99, 0.999, 0.9999] {
        for phase in 0..100 {
            let mut world = World::new(vec2(0.0, 0.0)).unwrap();
            let x = 0.02 * Real::from(phase) / 100.0 - 0.2;
            let surface =
                Surface { friction: Friction::of(0.0), restitution: 1.0, ..Surface::default() };
            for (position, velocity) in
                [(vec2(0.0, 0.0), vec2(0.0, 0.0)), (vec2(x, 0.6 * part), vec2(11.4, 0.0))]
            {
                let surface = surface.clone();
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
