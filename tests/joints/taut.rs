//! Ropes that are exactly taut.

use culbuto::math::{Real, vec2};
use culbuto::{BodyDef, JointDef, World};

/// Points on rods between two fixed points that are just as far apart as the rods are long: under their weight they can
/// sag by rounding only, whatever tension that takes.
#[test]
fn an_exactly_taut_rope_stays() {
    for links in [2_u32, 5, 20] {
        let mut world = World::new(vec2(0.0, -9.81)).unwrap();
        let length = 1.0 / Real::from(links);
        let at = |k: u32| vec2(Real::from(k) * length, 0.0);
        let mut last = None;
        for k in 1..links {
            let def = BodyDef { position: at(k), ..BodyDef::point(1.0) };
            let body = world.add_body(def).unwrap();
            world.add_joint(JointDef::distance(last, body).anchored(at(k - 1), at(k))).unwrap();
            last = Some(body);
        }
        let tied = JointDef::distance(last, None).anchored(at(links - 1), at(links));
        world.add_joint(tied).unwrap();
        let before = world.energy().unwrap();
        world.steps(1.0 / 60.0, 120).unwrap();
        // Free, the points would fall by gh²/2 = 9e-5 m in the first substep. A sag s lengthens a rod by s²/2ℓ.
        let sag = world.bodies().poses.iter().map(|pose| pose.position.y.abs());
        let sag = sag.fold(0.0, Real::max);
        assert!(sag < 9e-5, "{links} rods: {sag:e}");
        let energy = world.energy().unwrap();
        assert!(energy.kinetic < 1e-6, "{links} rods move: {:e}", energy.kinetic);
        assert!((energy.balance() - before.balance()).abs() < 1e-12, "{links} rods");
    }
}

/// A light rod between a pin and a heavy load turns as a string under tension does; its substep is divided so that it is
/// followed, and the report says into how many parts. That of a load of its own mass is not.
#[test]
fn a_heavy_load_divides_the_substep() {
    let parts = |load: Real| {
        let mut world = World::new(vec2(0.0, -9.81)).unwrap();
        let rod = world
            .add_body(BodyDef {
                position: vec2(0.5, 0.0),
                inertia: Some(0.1),
                ..BodyDef::point(1.0)
            })
            .unwrap();
        let def = BodyDef { position: vec2(1.0, 0.0), inertia: Some(load), ..BodyDef::point(load) };
        let end = world.add_body(def).unwrap();
        world.add_joint(JointDef::revolute(None, rod).at(vec2(0.0, 0.0))).unwrap();
        world.add_joint(JointDef::revolute(rod, end).at(vec2(1.0, 0.0))).unwrap();
        let before = world.energy().unwrap().balance();
        world.steps(1.0 / 60.0, 120).unwrap();
        let change = (world.energy().unwrap().balance() - before).abs();
        assert!(change < 1e-3 * load * 9.81, "{load}: {change:e}");
        world.report().parts
    };
    assert_eq!(parts(1.0), 1);
    let heavy = parts(1e5);
    assert!(heavy > 1 && heavy <= 256, "{heavy}");
}
