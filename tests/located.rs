//! Runs to a tolerance through contact: the laws of mechanics hold to it, whatever the order of creation, and the error is what
//! was asked for.

#![allow(clippy::unwrap_used, clippy::panic)] // helpers of tests may, as tests do

use culbuto::body::{BodyDef, BodyKind, Friction, Surface};
use culbuto::joint::JointDef;
use culbuto::math::{Pose, Real, Twist, Vec2, cross, vec2};
use culbuto::scenes::{Answer, scene};
use culbuto::shapes::Shape;
use culbuto::world::World;
use proptest::prelude::*;
use proptest::test_runner::RngSeed;

const G: Real = 9.81;
const TOLERANCE: Real = 1e-9;

/// Kind, place, size, velocity, spin and angle of a body.
type Thing = (u8, (Real, Real), Real, (Real, Real), Real, Real);

fn thing() -> impl Strategy<Value = Thing> {
    (
        0..3_u8,
        (-0.3..0.3_f64, -0.3..0.3_f64),
        0.3..0.6_f64,
        (-2.0..2.0_f64, -2.0..2.0_f64),
        -3.0..3.0_f64,
        -1.5..1.5_f64,
    )
}

fn shape(kind: u8, size: Real) -> Shape {
    match kind {
        0 => Shape::circle(0.5 * size).unwrap(),
        1 => Shape::rectangle(size, 0.7 * size).unwrap(),
        _ => Shape::capsule(vec2(-0.4 * size, 0.0), vec2(0.4 * size, 0.0), 0.2 * size).unwrap(),
    }
}

fn surface((friction, restitution): (Real, Real)) -> Surface {
    Surface { friction: Friction::of(friction), restitution, ..Surface::default() }
}

/// Bodies on a lattice so wide that none overlap.
fn defs(things: &[Thing], touch: (Real, Real), height: Real) -> Vec<BodyDef> {
    let place = |k: usize, (x, y): (Real, Real)| {
        vec2(1.5 * (k % 2) as Real + x, height + 1.5 * (k / 2) as Real + y)
    };
    things
        .iter()
        .enumerate()
        .map(|(k, &(kind, at, size, (vx, vy), spin, angle))| BodyDef {
            position: place(k, at),
            angle,
            velocity: vec2(vx, vy),
            angular_velocity: spin,
            surface: surface(touch),
            ..BodyDef::new(shape(kind, size))
        })
        .collect()
}

fn add_ground(world: &mut World, touch: (Real, Real)) {
    world
        .add_body(BodyDef {
            kind: BodyKind::Static,
            position: vec2(0.0, -0.5),
            surface: surface(touch),
            ..BodyDef::new(Shape::rectangle(60.0, 1.0).unwrap())
        })
        .unwrap();
}

fn momenta(world: &World) -> (Vec2, Real) {
    let bodies = world.bodies();
    let mut sums = (vec2(0.0, 0.0), 0.0);
    for ((pose, twist), mass) in bodies.poses.iter().zip(&bodies.twists).zip(&bodies.masses) {
        sums.0 += twist.linear * mass.mass;
        sums.1 += mass.mass * cross(pose.position, twist.linear) + mass.inertia * twist.angular;
    }
    sums
}

fn balance(world: &World) -> Real {
    let ledger = world.ledger();
    world.energy().unwrap().total() - ledger.work + ledger.dissipated - ledger.correction_work
}

fn apart(a: &[Pose], b: &[Pose]) -> Real {
    let off = |(a, b): (&Pose, &Pose)| (a.position - b.position).norm() + (a.angle - b.angle).abs();
    a.iter().zip(b).map(off).fold(0.0, Real::max)
}

fn laws() -> impl Strategy<Value = (Real, Real)> {
    (prop_oneof![Just(0.0), 0.05..1.0_f64], prop_oneof![Just(0.0), 0.2..1.0_f64])
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, rng_seed: RngSeed::Fixed(5), failure_persistence: None, ..ProptestConfig::default() })]

    /// Nothing outside acts: momentum and angular momentum stay to rounding, and energy is what was dissipated less.
    #[test]
    fn collisions_keep_momenta_and_book_their_energy(
        things in prop::collection::vec(thing(), 2..6), touch in laws(),
    ) {
        let mut world = World::new(vec2(0.0, 0.0)).unwrap();
        for mut def in defs(&things, touch, 0.0) {
            // Together, so that they meet.
            def.velocity -= def.position * 1.5;
            world.add_body(def).unwrap();
        }
        let (start, energy) = (momenta(&world), balance(&world));
        world.advance(1.0, TOLERANCE).unwrap();
        let end = momenta(&world);
        prop_assert!((end.0 - start.0).norm() < 1e-12, "momentum by {:e}", (end.0 - start.0).norm());
        prop_assert!((end.1 - start.1).abs() < 1e-9, "angular momentum by {:e}", end.1 - start.1);
        prop_assert!((balance(&world) - energy).abs() < 1e-8, "energy by {:e}", balance(&world) - energy);
    }

    /// On ground, with friction and bounces: energy less what is dissipated stays, and what is dissipated only grows.
    #[test]
    fn what_falls_and_slides_books_its_energy(
        things in prop::collection::vec(thing(), 1..5), touch in laws(),
    ) {
        let mut world = World::new(vec2(0.0, -G)).unwrap();
        add_ground(&mut world, touch);
        for def in defs(&things, touch, 0.8) {
            world.add_body(def).unwrap();
        }
        let energy = balance(&world);
        let mut dissipated = 0.0;
        for _ in 0..4 {
            world.advance(0.3, TOLERANCE).unwrap();
            prop_assert!(world.ledger().dissipated >= dissipated - 1e-9);
            dissipated = world.ledger().dissipated;
            let off = balance(&world) - energy;
            prop_assert!(off.abs() < 1e-6, "energy by {:e}", off);
        }
    }

    /// A scene in a mirror moves as the mirror shows it.
    #[test]
    fn mirrored_scenes_mirror(things in prop::collection::vec(thing(), 1..4), touch in laws()) {
        let run = |sign: Real| {
            let mut world = World::new(vec2(0.0, -G)).unwrap();
            add_ground(&mut world, touch);
            for mut def in defs(&things, touch, 0.8) {
                def.position.x *= sign;
                def.velocity.x *= sign;
                (def.angle, def.angular_velocity) = (sign * def.angle, sign * def.angular_velocity);
                world.add_body(def).unwrap();
            }
            world.advance(0.7, TOLERANCE).unwrap();
            world
        };
        let (one, other) = (run(1.0), run(-1.0));
        let mirrored: Vec<Pose> = other.bodies().poses.iter()
            .map(|pose| Pose::new(vec2(-pose.position.x, pose.position.y), -pose.angle))
            .collect();
        let off = apart(&one.bodies().poses, &mirrored);
        prop_assert!(off < 1e-6, "off by {:e}", off);
    }

    /// The order in which bodies are made changes nothing but rounding.
    #[test]
    fn the_order_of_creation_does_not_matter(
        things in prop::collection::vec(thing(), 2..5), touch in laws(),
    ) {
        let run = |turned: bool| {
            let mut world = World::new(vec2(0.0, -G)).unwrap();
            let mut all = defs(&things, touch, 0.8);
            if turned {
                all.reverse();
            } else {
                add_ground(&mut world, touch);
            }
            for def in all {
                world.add_body(def).unwrap();
            }
            if turned {
                add_ground(&mut world, touch);
            }
            world.advance(0.7, TOLERANCE).unwrap();
            world.bodies().poses.clone()
        };
        let (one, mut other) = (run(false), run(true));
        other.reverse();
        let off = apart(&one, &other);
        prop_assert!(off < 1e-6, "off by {:e}", off);
    }

    /// Elastic disks that are turned round go back the way they came.
    #[test]
    fn elastic_disks_come_back(things in prop::collection::vec(thing(), 2..6)) {
        let mut world = World::new(vec2(0.0, -G)).unwrap();
        add_ground(&mut world, (0.0, 1.0));
        for mut def in defs(&things, (0.0, 1.0), 0.8) {
            def.shapes = vec![Shape::circle(0.3).unwrap().into()];
            world.add_body(def).unwrap();
        }
        let start = world.bodies().poses.clone();
        world.advance(0.6, TOLERANCE).unwrap();
        for body in world.bodies().handles().to_vec() {
            let twist = world.body(body).unwrap().twist();
            if twist != Twist::ZERO {
                let back = Twist::new(-twist.linear, -twist.angular);
                world.body_mut(body).unwrap().set_twist(back).unwrap();
            }
        }
        world.advance(0.6, TOLERANCE).unwrap();
        let off = apart(&world.bodies().poses, &start);
        prop_assert!(off < 1e-8, "off by {:e}", off);
    }

    /// A disk or a box that slides on an incline goes as the step takes it at a small h.
    #[test]
    fn runs_agree_with_the_step_at_small_h(
        kind in 0..2_u8, slope in 0.05..0.5_f64, friction in 0.0..0.6_f64, speed in -2.0..2.0_f64,
    ) {
        let make = || {
            let mut world = World::new(vec2(G * slope.sin(), -G * slope.cos())).unwrap();
            add_ground(&mut world, (friction, 0.0));
            let height = if kind == 0 { 0.25 } else { 0.5 * 0.7 * 0.5 };
            world.add_body(BodyDef {
                position: vec2(0.0, height), velocity: vec2(speed, 0.0), surface: surface((friction, 0.0)),
                ..BodyDef::new(shape(kind, 0.5))
            }).unwrap();
            world
        };
        let (mut located, mut stepped) = (make(), make());
        located.advance(1.0, TOLERANCE).unwrap();
        stepped.set_substeps(64).unwrap();
        stepped.steps(1.0 / 60.0, 60).unwrap();
        let off = apart(&located.bodies().poses, &stepped.bodies().poses);
        prop_assert!(off < 2e-3, "off by {:e}", off);
    }
}

/// Errors follow the tolerance within a factor 10, from 1e-2 to 1e-12.
#[test]
fn errors_follow_the_tolerance() {
    for name in ["C1", "F3", "F6", "F11", "F18"] {
        let Answer::Motion(motion) = scene(name).unwrap().answer else { panic!("{name}") };
        for digits in 2..=12 {
            let tolerance = Real::powi(10.0, -digits);
            let mut world = (motion.build)().unwrap();
            let times: Vec<Real> =
                (1..=50).map(|k| motion.duration * Real::from(k) / 50.0).collect();
            let run = world.advance_sampled(motion.duration, tolerance, &times).unwrap();
            let error = motion.error(&world, &run);
            assert!(error <= 10.0 * tolerance, "{name} at {tolerance:e}: {error:e}");
        }
    }
}

/// A pinned rod strikes a wall: rows of the joint and the impact together; energy is kept, and the pin holds.
#[test]
fn a_pinned_rod_bounces_off_a_wall_as_fast_as_it_came() {
    let mut world = World::new(vec2(0.0, -G)).unwrap();
    let wall = BodyDef {
        kind: BodyKind::Static,
        position: vec2(-0.5, 0.0),
        surface: surface((0.0, 1.0)),
        ..BodyDef::new(Shape::rectangle(1.0, 8.0).unwrap())
    };
    world.add_body(wall).unwrap();
    let rod = BodyDef {
        position: vec2(1.2, 1.0),
        surface: surface((0.0, 1.0)),
        ..BodyDef::new(Shape::rectangle(2.0, 0.1).unwrap())
    };
    let rod = world.add_body(rod).unwrap();
    world.add_joint(JointDef::revolute(None, rod).at(vec2(0.2, 1.0))).unwrap();
    let before = world.energy().unwrap().total();
    world.advance(5.0, 1e-11).unwrap();
    assert!(world.report().impacts >= 2, "{:?}", world.report());
    assert_eq!(world.report().fallback, None);
    let change = world.energy().unwrap().total() - before;
    assert!(change.abs() < 1e-9, "{change:e}");
    let pin = world.body(rod).unwrap().pose().apply(vec2(-1.0, 0.0));
    assert!((pin - vec2(0.2, 1.0)).norm() < 1e-13, "{pin:?}");
}

/// A block that rocks from corner to corner comes to rest: infinitely many impacts in a finite time.
#[test]
fn a_rocking_block_comes_to_rest() {
    let mut world = World::new(vec2(0.0, -G)).unwrap();
    add_ground(&mut world, (0.9, 0.0));
    let lean: Real = 0.2;
    let (sin, cos) = lean.sin_cos();
    world
        .add_body(BodyDef {
            position: vec2(0.25 * cos - 0.5 * sin, 0.25 * sin + 0.5 * cos),
            angle: lean,
            surface: surface((0.9, 0.0)),
            ..BodyDef::new(Shape::rectangle(0.5, 1.0).unwrap())
        })
        .unwrap();
    world.advance(4.0, TOLERANCE).unwrap();
    assert_eq!(world.bodies().twists[1], Twist::ZERO);
    assert!(world.bodies().poses[1].angle.abs() < TOLERANCE);
    assert_eq!(world.report().fallback, None);
}

/// Where a group is too large for events, the run says so, when and why.
#[test]
fn a_run_says_where_events_were_not_followed() {
    let mut world = World::new(vec2(0.0, -G)).unwrap();
    add_ground(&mut world, (0.5, 0.0));
    for k in 0..30 {
        let position = vec2(f64::from(k), 0.5);
        let def = BodyDef {
            position,
            surface: surface((0.5, 0.0)),
            ..BodyDef::new(Shape::rectangle(1.0, 1.0).unwrap())
        };
        world.add_body(def).unwrap();
    }
    world.advance(0.1, 1e-4).unwrap();
    let fallback = world.report().fallback;
    assert!(
        fallback.is_some_and(|(time, why)| time == 0.0 && why.contains("large")),
        "{fallback:?}"
    );
}

/// After a run contacts say what they bear: the weight, and the friction that holds it on an incline.
#[test]
fn contacts_bear_the_weight_after_a_run() {
    let slope: Real = 0.3;
    let mut world = World::new(vec2(G * slope.sin(), -G * slope.cos())).unwrap();
    add_ground(&mut world, (0.5, 0.0));
    let position = vec2(0.0, 0.35);
    let def = BodyDef {
        position,
        mass: Some(2.0),
        surface: surface((0.5, 0.0)),
        ..BodyDef::new(Shape::rectangle(1.0, 0.5).unwrap())
    };
    world.add_body(def).unwrap();
    world.advance(1.0, TOLERANCE).unwrap();
    let contacts = world.contacts();
    let force: Vec2 = contacts.iter().map(culbuto::world::Contact::force).sum();
    let weight = vec2(G * slope.sin(), -G * slope.cos()) * 2.0;
    assert!((force + weight).norm() < 1e-9, "{contacts:?}");
    // Steps go on from there.
    world.step(1.0 / 60.0).unwrap();
    assert!(world.bodies().twists[1].linear.norm() < 1e-9);
}

/// A body as fast as numbers go makes every stretch that it is free in as good as nothing. The call ends all the same.
#[test]
fn what_is_as_fast_as_numbers_go_ends_a_call() {
    let mut world = World::new(vec2(0.0, -10.0)).unwrap();
    for k in 0..8 {
        let position = vec2(2.0 * Real::from(k), 0.0);
        let velocity = vec2(0.0, if k == 3 { 1e200 } else { 0.0 });
        let shape = Shape::rectangle(1.0, 0.3).unwrap();
        world.add_body(BodyDef { position, velocity, ..BodyDef::new(shape) }).unwrap();
    }
    let before = world.snapshot().to_bytes().unwrap();
    if world.advance(0.03, 1e-6).is_err() {
        assert!(world.snapshot().to_bytes().unwrap() == before, "nothing is lost");
    }
}

/// A touch begins when what bounces comes to rest, ends where it lets go, and says so at that time, in a call of any length.
#[test]
fn touches_begin_and_end_when_they_do() {
    for restitution in [0.0, 0.5] {
        let mut world = World::new(vec2(0.0, -G)).unwrap();
        // A table 2 m wide, 1 m above the floor.
        add_ground(&mut world, (0.0, restitution));
        let top = BodyDef {
            kind: BodyKind::Static,
            position: vec2(-1.0, 0.9),
            surface: surface((0.0, restitution)),
            ..BodyDef::new(Shape::rectangle(2.0, 0.2).unwrap())
        };
        let table = world.add_body(top).unwrap();
        // A ball falls 0.5 m onto it, and slides off it at 1.5 m/s: too fast to turn about the edge (v² > gr).
        let (speed, radius, height) = (1.5, 0.1, 0.5);
        let fall = |height: Real| (2.0 * height / G).sqrt();
        let rests = |height: Real| fall(height) * (1.0 + restitution) / (1.0 - restitution);
        let ball = BodyDef {
            position: vec2(-1.9, 1.0 + radius + height),
            velocity: vec2(speed, 0.0),
            surface: surface((0.0, restitution)),
            ..BodyDef::new(Shape::circle(radius).unwrap())
        };
        let ball = world.add_body(ball).unwrap();
        world.advance(5.0, TOLERANCE).unwrap();
        let events = world.events().clone();
        let edge = 1.9 / speed;
        let wanted = [rests(height), edge + rests(1.0)];
        let begin: Vec<Real> = events.begin.iter().map(|event| event.time).collect();
        assert!(apart_in_time(&begin, &wanted) < 1e-5, "{begin:?} {wanted:?}");
        let end: Vec<Real> = events.end.iter().map(|event| event.time).collect();
        assert!(apart_in_time(&end, &[edge]) < 1e-8, "{end:?} {edge}");
        assert_eq!(events.begin[0].bodies, [table, ball]);
        let place = vec2(speed * wanted[0] - 1.9, 1.0);
        assert!((events.begin[0].point.unwrap() - place).norm() < 1e-4);
        assert!((events.begin[0].normal.unwrap() - vec2(0.0, 1.0)).norm() < 1e-9);
        // The next call has nothing to tell.
        world.advance(0.1, TOLERANCE).unwrap();
        assert!(world.events().is_empty(), "{:?}", world.events());
    }
}

fn apart_in_time(some: &[Real], others: &[Real]) -> Real {
    if some.len() != others.len() {
        return Real::INFINITY;
    }
    some.iter().zip(others).map(|(a, b)| (a - b).abs()).fold(0.0, Real::max)
}
