//! Ropes, chains and bridges.

use culbuto::builders::{Assembly, BridgeDef, ChainDef, End, RopeDef, RopeForm};
use culbuto::joint::Coefficients;
use culbuto::math::{PI, Real, Vec2, vec2};
use culbuto::shapes::Shape;
use culbuto::{BodyDef, World};

use crate::{DT, G, assert_close, earth};

const FORMS: [RopeForm; 2] = [RopeForm::Links { radius: None }, RopeForm::Points];

fn between(a: [Real; 2], b: [Real; 2]) -> [End; 2] {
    [End::World(vec2(a[0], a[1])), End::World(vec2(b[0], b[1]))]
}

/// Where the joints of links hold, from one end to the other.
fn hinges(world: &World, line: &Assembly) -> Vec<Vec2> {
    line.joints.iter().map(|joint| world.joint(*joint).unwrap().anchors()[1]).collect()
}

/// Points along a rope of points.
fn points(world: &World, line: &Assembly) -> Vec<Vec2> {
    line.bodies.iter().map(|body| world.body(*body).unwrap().position()).collect()
}

fn length(points: &[Vec2]) -> Real {
    points.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum()
}

#[test]
fn a_rope_has_the_length_and_the_mass_it_is_given_and_keeps_them() {
    for form in FORMS {
        for (links, whole) in [(2, 2.5), (7, 2.5), (20, 2.01), (20, 6.0)] {
            let mut world = earth();
            let ends = between([1.0, 5.0], [3.0, 5.0]);
            let rope = RopeDef {
                length: Some(whole),
                mass_per_length: 0.3,
                form,
                links,
                ..RopeDef::new(ends)
            };
            let rope = rope.build(&mut world).unwrap();
            assert_close(rope.mass(&world).unwrap(), 0.3 * whole, 1e-12);
            let along = |world: &World| match form {
                RopeForm::Links { .. } => length(&hinges(world, &rope)),
                RopeForm::Points => length(&points(world, &rope)),
            };
            assert_close(along(&world), whole, 1e-12);
            world.steps(DT, 60).unwrap();
            // Gaps are closed to a part of the lengths that is rounding; each link may add one.
            assert_close(along(&world), whole, 1e-9);
            assert!(rope.gap(&world) < 1e-9 * whole, "{form:?} {links}: {}", rope.gap(&world));
        }
    }
}

/// A straight rope that bears a weight: what holds it up carries weight and rope, whatever it consists of.
#[test]
fn a_rope_carries_its_own_weight_and_that_of_what_hangs_on_it() {
    for form in FORMS {
        let mut world = earth();
        let box_ = BodyDef::new(Shape::rectangle(0.4, 0.4).unwrap());
        let weight = BodyDef { mass: Some(5.0), position: vec2(0.0, -2.2), ..box_ };
        let weight = world.add_body(weight).unwrap();
        let ends = [End::World(vec2(0.0, 0.0)), End::Body(weight, vec2(0.0, 0.2))];
        let rope = RopeDef { form, mass_per_length: 0.5, ..RopeDef::new(ends) };
        let rope = rope.build(&mut world).unwrap();
        world.steps(DT, 30).unwrap();
        let force = |joint: usize| world.joint(rope.joints[joint]).unwrap().reaction().force;
        let (top, bottom) = match form {
            RopeForm::Links { .. } => (0, rope.joints.len() - 1),
            RopeForm::Points => (rope.joints.len() - 2, rope.joints.len() - 1),
        };
        assert_close(force(top).y, (5.0 + 0.5 * 2.0) * G, 1e-9);
        assert_close(force(bottom).y, -5.0 * G, 1e-9);
        let moved = world.body(weight).unwrap().position() - vec2(0.0, -2.2);
        assert!(moved.norm() < 1e-12, "{moved:?}");
    }
}

/// ½B∫κ² of a half circle is ½Bπ/R; n links have n − 1 hinges for n lengths.
#[test]
fn a_bent_rope_stores_what_a_bent_rod_does() {
    let (radius, stiffness, links) = (0.5, 3.0, 200_u32);
    let mut world = earth();
    let rope = RopeDef {
        length: Some(PI * radius),
        links: links as usize,
        bending: Some(Coefficients { stiffness, damping: 0.0 }),
        ..RopeDef::new(between([0.0, 0.0], [2.0 * radius, 0.0]))
    };
    rope.build(&mut world).unwrap();
    let n = Real::from(links);
    // A polygon of n chords as long as the arc bulges by a part of order 1/n² less.
    let tolerance = 4.0 / (n * n);
    let energy = world.spring_energy() * n / (n - 1.0);
    assert_close(energy, 0.5 * stiffness * PI / radius, tolerance);
}

/// Horizontal force H is the same everywhere, and every link adds its weight to the vertical one: the slopes of the links of a
/// chain at rest are in arithmetic progression.
fn assert_catenary(points: &[Vec2], tolerance: Real) {
    let slopes: Vec<Real> =
        points.windows(2).map(|p| (p[1].y - p[0].y) / (p[1].x - p[0].x)).collect();
    let last = slopes.len() - 1;
    let step = (slopes[last] - slopes[0]) / last as Real;
    assert!(step > 0.1, "it sags");
    for (k, slope) in slopes.iter().enumerate() {
        let wanted = slopes[0] + step * k as Real;
        assert!((slope - wanted).abs() < tolerance, "link {k}: {slope}, not {wanted}");
    }
}

fn calm() -> BodyDef {
    BodyDef { linear_damping: 5.0, angular_damping: 5.0, ..BodyDef::default() }
}

#[test]
fn a_bridge_sags_symmetrically_into_the_shape_of_a_hanging_chain() {
    for planks in [7, 12] {
        let mut world = earth();
        let anchors = between([-3.0, 1.0], [3.0, 1.0]);
        let bridge =
            BridgeDef { length: Some(7.0), planks, body: calm(), ..BridgeDef::new(anchors) };
        let bridge = bridge.build(&mut world).unwrap();
        let assert_symmetric = |world: &World, when: &str| {
            let points = hinges(world, &bridge);
            for (p, q) in points.iter().zip(points.iter().rev()) {
                let apart = vec2(p.x + q.x, p.y - q.y).norm();
                assert!(apart < 1e-9, "{planks} planks, {when}: {p:?} {q:?}");
            }
        };
        assert_symmetric(&world, "at first");
        world.steps(DT, 30).unwrap();
        assert_symmetric(&world, "as it swings");
        world.steps(DT, 870).unwrap();
        assert_symmetric(&world, "at rest");
        // What is left of the swing after 15 s of damping at 5/s is far below.
        assert_catenary(&hinges(&world, &bridge), 1e-7);
    }
}

#[test]
fn a_chain_hangs_between_two_points_as_a_chain_does_and_its_links_do_not_touch() {
    let mut world = earth();
    let ends = between([0.0, 0.0], [2.0, 0.5]);
    let chain = ChainDef { length: Some(2.6), body: calm(), ..ChainDef::new(ends) };
    let chain = chain.build(&mut world).unwrap();
    assert_close(chain.mass(&world).unwrap(), 2.6, 1e-12);
    world.steps(DT, 900).unwrap();
    assert_catenary(&hinges(&world, &chain), 1e-7);
    assert_eq!(world.contacts().len(), 0);
}

/// The pull at an anchor is above half the weight. Hinges that bear three times the bridge's weight bear the bridge, and
/// not a box of ten times its mass that falls on it.
#[test]
fn a_bridge_breaks_under_what_is_too_heavy_and_only_then() {
    let mut world = earth();
    let bridge = BridgeDef {
        length: Some(6.6),
        breaking_force: Some(3.0 * 6.6 * G),
        ..BridgeDef::new(between([-3.0, 0.0], [3.0, 0.0]))
    };
    let bridge = bridge.build(&mut world).unwrap();
    world.steps(DT, 120).unwrap();
    assert!(bridge.joints.iter().all(|joint| world.joint(*joint).is_ok()), "it bears itself");
    let box_ = BodyDef::new(Shape::rectangle(1.0, 1.0).unwrap());
    let box_ = BodyDef { mass: Some(66.0), position: vec2(0.0, 2.0), ..box_ };
    let box_ = world.add_body(box_).unwrap();
    let mut broken = Vec::new();
    for _ in 0..180 {
        world.step(DT).unwrap();
        broken.extend(world.broken_joints().iter().cloned());
    }
    assert!(!broken.is_empty());
    for joint in &broken {
        assert!(bridge.joints.contains(&joint.joint));
        assert!(joint.def.name.as_ref().unwrap().starts_with("bridge joint "));
        assert!(joint.reaction.force.norm() > 3.0 * 6.6 * G);
    }
    let fallen = world.body(box_).unwrap().position().y;
    assert!(fallen < -5.0, "the box is at {fallen}");
}

/// Between fixed ends it is a thousandth longer than straight: sag² = ⅜·span·(length − span) of a shallow parabola.
#[test]
fn a_bridge_that_is_given_no_length_hardly_sags_and_bears_itself() {
    let mut world = earth();
    let bridge = BridgeDef { body: calm(), ..BridgeDef::new(between([-3.0, 0.0], [3.0, 0.0])) };
    let bridge = bridge.build(&mut world).unwrap();
    assert_close(bridge.mass(&world).unwrap(), 6.006, 1e-12);
    world.steps(DT, 600).unwrap();
    let lowest = hinges(&world, &bridge).iter().map(|p| p.y).fold(0.0, Real::min);
    assert_close(-lowest, (0.375 * 6.0 * 0.006_f64).sqrt(), 1e-2);
}

#[test]
fn a_rope_from_a_body_to_nowhere_follows_the_body() {
    let mut world = World::new(vec2(0.0, 0.0)).unwrap();
    let ship = BodyDef { velocity: vec2(2.0, 0.0), ..BodyDef::new(Shape::circle(0.5).unwrap()) };
    let ship = world.add_body(ship).unwrap();
    let ends = [End::Body(ship, vec2(-0.5, 0.0)), End::Free(vec2(-2.5, 0.0))];
    let rope = RopeDef { mass_per_length: 0.1, links: 8, ..RopeDef::new(ends) };
    let rope = rope.build(&mut world).unwrap();
    let before = world.momentum();
    world.steps(DT, 120).unwrap();
    // Taut from the start: the hit of the first step shares the momentum, and all go on together.
    let mass = world.mass();
    let common = before.x / mass;
    for body in rope.bodies.iter().chain([&ship]) {
        let velocity = world.body(*body).unwrap().velocity();
        assert!((velocity - vec2(common, 0.0)).norm() < 1e-9, "{velocity:?}, not {common}");
    }
}
