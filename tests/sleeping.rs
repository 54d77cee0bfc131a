//! Claims about islands that fall asleep.

#![allow(clippy::unwrap_used)] // helpers of tests may, as tests do

use culbuto::body::{BodyHandle, Friction, Surface};
use culbuto::math::{Real, Vec2, vec2};
use culbuto::shapes::Shape;
use culbuto::world::Snapshot;
use culbuto::{BodyDef, BodyKind, Part, World};

const DT: Real = 1.0 / 60.0;

fn surface() -> Surface {
    Surface { friction: Friction::of(0.6), ..Surface::default() }
}

fn square(side: Real, position: Vec2) -> BodyDef {
    let shape = Shape::rectangle(side, side).unwrap();
    BodyDef { position, surface: surface(), ..BodyDef::new(shape) }
}

/// A floor whose top is at y = 0, in gravity −10, and boxes of a side on it, at heights and places in sides.
fn world_of(scale: Real, places: &[(Real, Real)]) -> (World, Vec<BodyHandle>) {
    let mut world = World::new(vec2(0.0, -10.0)).unwrap();
    world.set_sleeping(true);
    let shape = Shape::rectangle(400.0 * scale, 2.0 * scale).unwrap();
    let floor = BodyDef {
        kind: BodyKind::Static,
        position: vec2(0.0, -scale),
        surface: surface(),
        ..BodyDef::new(shape)
    };
    let mut handles = vec![world.add_body(floor).unwrap()];
    for (x, y) in places {
        handles.push(world.add_body(square(scale, vec2(*x, *y) * scale)).unwrap());
    }
    (world, handles)
}

const STACK: [(Real, Real); 3] = [(0.0, 0.5), (0.0, 1.5), (0.0, 2.5)];

/// A stack of three that sleeps.
fn sleeping_stack() -> (World, Vec<BodyHandle>) {
    let (mut world, bodies) = world_of(1.0, &STACK);
    world.steps(DT, 60).unwrap();
    assert_eq!(world.asleep(), 3);
    (world, bodies)
}

fn bytes(world: &World) -> Vec<u8> {
    world.snapshot().to_bytes().unwrap()
}

fn bits(world: &World) -> Vec<u64> {
    let bodies = world.bodies();
    let poses = bodies.poses.iter().flat_map(|p| [p.position.x, p.position.y, p.angle]);
    let twists = bodies.twists.iter().flat_map(|v| [v.linear.x, v.linear.y, v.angular]);
    poses.chain(twists).map(Real::to_bits).collect()
}

#[test]
fn a_stack_sleeps_in_about_half_a_second_and_never_with_sleeping_off() {
    let (mut world, bodies) = world_of(1.0, &STACK);
    world.steps(DT, 24).unwrap();
    assert_eq!(world.asleep(), 0, "too soon");
    world.steps(DT, 36).unwrap();
    assert_eq!(world.asleep(), 3);
    assert!(world.body(bodies[1]).unwrap().is_asleep());
    assert!(!world.body(bodies[0]).unwrap().is_asleep());
    let before = bits(&world);
    world.steps(DT, 100).unwrap();
    assert_eq!(before, bits(&world), "what sleeps moves");
    assert!(world.explain().contains("3 bodies asleep"), "{}", world.explain());
    world.set_sleeping(false);
    world.steps(DT, 100).unwrap();
    assert_eq!(world.asleep(), 0);
}

#[test]
fn sleep_scales() {
    // Lengths by 4^n, times by 2^n: without rounding. The floor's thickness, too.
    let moment = |n: i32| {
        let (scale, dt) = (Real::powi(4.0, n), DT * Real::powi(2.0, n));
        let (mut world, _) = world_of(scale, &[(0.0, 1.2), (0.2, 2.5)]);
        (0..600).find(|_| {
            world.step(dt).unwrap();
            world.asleep() > 0
        })
    };
    let normal = moment(0);
    assert!(normal.is_some_and(|steps| steps > 40), "{normal:?}");
    assert_eq!(normal, moment(-5));
    assert_eq!(normal, moment(8));
}

#[test]
fn a_ball_wakes_what_it_hits_and_both_move_as_if_it_had_never_slept() {
    let run = |sleeping: bool| {
        let (mut world, bodies) = world_of(1.0, &[(0.0, 0.5), (20.0, 0.5)]);
        world.set_sleeping(sleeping);
        world.steps(DT, 90).unwrap();
        assert_eq!(world.asleep(), if sleeping { 2 } else { 0 });
        let ball = BodyDef {
            position: vec2(-4.0, 0.6),
            velocity: vec2(12.0, 1.0),
            surface: Surface { restitution: 0.5, ..surface() },
            ..BodyDef::new(Shape::circle(0.3).unwrap())
        };
        let ball = world.add_body(ball).unwrap();
        world.steps(DT, 60).unwrap();
        let place = |body| world.body(body).unwrap().position();
        if sleeping {
            assert_eq!(world.asleep(), 1, "the other sleeps on");
        }
        [place(bodies[1]), place(ball)]
    };
    let [slept, awake] = [run(true), run(false)];
    assert!(awake[0].x > 0.3, "the box was pushed: {awake:?}");
    for (a, b) in slept.iter().zip(&awake) {
        assert!((a - b).norm() < 1e-6, "{slept:?} {awake:?}");
    }
}

#[test]
fn momentum_goes_on_into_what_slept() {
    // The striker hits one that is awake, which the same step throws against one that sleeps.
    let mut world = World::new(vec2(0.0, 0.0)).unwrap();
    world.set_sleeping(true);
    let ball = |x: Real, v: Real| BodyDef {
        position: vec2(x, 0.0),
        velocity: vec2(v, 0.0),
        surface: Surface { restitution: 1.0, ..Surface::default() },
        ..BodyDef::new(Shape::circle(0.5).unwrap())
    };
    let last = world.add_body(ball(2.05, 0.0)).unwrap();
    world.body_mut(last).unwrap().sleep();
    assert_eq!(world.asleep(), 1);
    world.add_body(ball(1.0, 0.0)).unwrap();
    world.add_body(ball(-1.0, 10.0)).unwrap();
    world.steps(0.05, 20).unwrap();
    let speeds: Vec<_> = world.bodies().twists.iter().map(|v| v.linear.x).collect();
    assert!((speeds[0] - 10.0).abs() < 1e-12, "{speeds:?}");
    assert!(speeds[1].abs() + speeds[2].abs() < 1e-12, "{speeds:?}");
}

#[test]
fn waking_a_pile_changes_nothing_of_its_rest() {
    let (mut world, bodies) = sleeping_stack();
    let before = world.bodies().poses.clone();
    world.body_mut(bodies[2]).unwrap().wake();
    assert_eq!(world.asleep(), 0, "the whole island wakes");
    assert_eq!(world.contacts().len(), 3);
    world.step(DT).unwrap();
    for (now, then) in world.bodies().poses.iter().zip(&before) {
        // Impulses are warm: nothing sinks.
        assert!((now.position - then.position).norm() < 1e-7);
    }
}

#[test]
fn contacts_and_touches_of_sleepers_stay() {
    let (mut world, _) = world_of(1.0, &STACK);
    world.steps(DT, 10).unwrap();
    let awake = world.contacts().len();
    world.steps(DT, 60).unwrap();
    assert_eq!((world.asleep(), world.contacts().len()), (3, awake));
    assert!(world.events().is_empty());
    let heights: Real = world.contacts().iter().map(|c| c.force().y).fold(0.0, Real::max);
    assert!((heights - 30.0).abs() < 1e-3, "the load stays: {heights}");
}

type Touch = fn(&mut World, &[BodyHandle]);

#[test]
fn whatever_is_set_wakes() {
    let acts: [(&str, Touch); 13] = [
        ("velocity", |w, b| w.body_mut(b[3]).unwrap().set_velocity(vec2(0.1, 0.0)).unwrap()),
        ("position", |w, b| w.body_mut(b[3]).unwrap().set_position(vec2(0.1, 2.5)).unwrap()),
        ("force", |w, b| w.body_mut(b[1]).unwrap().apply_force(vec2(1.0, 0.0), None).unwrap()),
        ("torque", |w, b| w.body_mut(b[1]).unwrap().apply_torque(1.0).unwrap()),
        ("impulse", |w, b| w.body_mut(b[1]).unwrap().apply_impulse(vec2(1.0, 0.0), None).unwrap()),
        ("density", |w, b| w.body_mut(b[2]).unwrap().set_density(2.0).unwrap()),
        ("gravity", |w, _| w.set_gravity(vec2(1.0, -10.0)).unwrap()),
        ("ground", |w, b| w.remove_body(b[0]).unwrap()),
        ("lower ground", |w, b| w.body_mut(b[0]).unwrap().set_position(vec2(0.0, -2.0)).unwrap()),
        ("turned ground", |w, b| w.body_mut(b[0]).unwrap().set_angle(0.1).unwrap()),
        ("a lower box", |w, b| w.remove_body(b[1]).unwrap()),
        ("a field", |w, _| {
            w.add_field(culbuto::forces::Central {
                center: vec2(0.0, 9.0),
                strength: 1.0,
                exponent: 1.0,
                per_mass: true,
            });
        }),
        ("a wall", |w, _| {
            let wall = BodyDef { kind: BodyKind::Static, ..square(1.0, vec2(0.9, 1.5)) };
            w.add_body(wall).unwrap();
        }),
    ];
    for (name, act) in acts {
        let (mut world, bodies) = sleeping_stack();
        act(&mut world, &bodies);
        assert_eq!(world.asleep(), 0, "{name}");
        world.steps(DT, 5).unwrap();
    }
    let (mut world, bodies) = sleeping_stack();
    world.remove_body(bodies[0]).unwrap();
    world.steps(DT, 60).unwrap();
    assert!(world.body(bodies[1]).unwrap().position().y < -4.0, "it falls");
    assert_eq!(world.asleep(), 0, "what falls does not sleep");
}

#[test]
fn a_moving_ground_lets_nothing_sleep_and_wakes_what_it_meets() {
    let (mut world, bodies) = world_of(1.0, &[(0.0, 0.5)]);
    let mut floor = world.body_mut(bodies[0]).unwrap();
    floor.set_kind(BodyKind::Kinematic).unwrap();
    floor.set_velocity(vec2(0.01, 0.0)).unwrap();
    world.steps(DT, 120).unwrap();
    assert_eq!(world.asleep(), 0);
    world.body_mut(bodies[0]).unwrap().set_velocity(vec2(0.0, 0.0)).unwrap();
    world.steps(DT, 120).unwrap();
    assert_eq!(world.asleep(), 1);
    let ram = BodyDef {
        kind: BodyKind::Kinematic,
        velocity: vec2(1.0, 0.0),
        ..square(0.5, vec2(-2.0, 0.5))
    };
    world.add_body(ram).unwrap();
    world.steps(DT, 20).unwrap();
    assert_eq!(world.asleep(), 1, "it is not there yet");
    world.steps(DT, 160).unwrap();
    assert!(world.body(bodies[1]).unwrap().position().x > 1.0, "it is pushed");
}

#[test]
fn the_energy_that_sleep_takes_is_booked() {
    let (mut world, _) = world_of(1.0, &[(0.0, 1.3), (3.0, 2.0), (3.1, 3.2)]);
    let start = world.energy().unwrap().balance();
    world.steps(DT, 240).unwrap();
    assert_eq!(world.asleep(), 3);
    let end = world.energy().unwrap();
    assert_eq!(end.kinetic, 0.0);
    assert!((end.balance() - start).abs() < 1e-9 * start, "{start} {}", end.balance());
    // Laid down in flight it loses what it had.
    let ball = world.add_body(BodyDef { velocity: vec2(3.0, 0.0), ..square(1.0, vec2(9.0, 9.0)) });
    let start = world.energy().unwrap().balance();
    world.body_mut(ball.unwrap()).unwrap().sleep();
    let end = world.energy().unwrap();
    assert_eq!((world.asleep(), end.kinetic), (4, 0.0));
    assert!((end.balance() - start).abs() < 1e-12 * start);
}

#[test]
fn snapshots_and_failed_calls_keep_sleep_to_the_last_bit() {
    let (mut world, _) = sleeping_stack();
    let ball = BodyDef { velocity: vec2(0.0, -4.0), ..square(0.7, vec2(0.1, 4.5)) };
    world.add_body(ball).unwrap();
    for _ in 0..25 {
        let state = bytes(&world);
        let mut copy = Snapshot::from_bytes(&state, Vec::new()).unwrap().to_world();
        let mut left = 30;
        let mut watch = || {
            left -= 1;
            if left == 0 { Err("enough".into()) } else { Ok(()) }
        };
        assert!(world.steps_watched(DT, 100, &mut watch).is_err());
        assert!(state == bytes(&world), "a call that failed has changed something");
        world.steps(DT, 4).unwrap();
        copy.steps(DT, 4).unwrap();
        assert_eq!(bits(&world), bits(&copy));
        assert_eq!(world.asleep(), copy.asleep());
    }
    assert_eq!(world.asleep(), 4);
}

#[test]
fn removing_others_leaves_sleepers_asleep() {
    let (mut world, bodies) = world_of(1.0, &[(50.0, 0.5), (0.0, 0.5), (0.0, 1.5)]);
    world.steps(DT, 60).unwrap();
    assert_eq!(world.asleep(), 3);
    // The last body takes the place of the first box.
    world.remove_body(bodies[1]).unwrap();
    assert_eq!(world.asleep(), 2);
    world.body_mut(bodies[2]).unwrap().wake();
    assert_eq!(world.asleep(), 0, "both of the stack");
    world.steps(DT, 60).unwrap();
    assert_eq!(world.asleep(), 2);
}

#[test]
fn without_gravity_only_what_stands_still_sleeps() {
    let mut world = World::new(vec2(0.0, 0.0)).unwrap();
    world.set_sleeping(true);
    for (x, v) in [(0.0, 0.0), (1.0, 0.0), (5.0, 1e-9), (6.0, 1e-9), (20.0, 0.0)] {
        let def = BodyDef { velocity: vec2(v, 0.0), ..square(1.0, vec2(x, 0.0)) };
        world.add_body(def).unwrap();
    }
    world.steps(DT, 200).unwrap();
    // The slow pair goes on, and what touches nothing is free.
    assert_eq!(world.asleep(), 2);
}

#[test]
fn what_sleeps_costs_no_work() {
    let field = |n: u32| {
        let places: Vec<_> =
            (0..n).flat_map(|k| [0.5, 1.5].map(|y| (3.0 * Real::from(k) - 190.0, y))).collect();
        let (mut world, _) = world_of(1.0, &places);
        world.steps(DT, 60).unwrap();
        assert_eq!(world.asleep(), places.len());
        let ball = Part::from(Shape::circle(0.4).unwrap());
        let ball =
            BodyDef { shapes: vec![ball], position: vec2(-189.0, 1.9), ..BodyDef::default() };
        world.add_body(ball).unwrap();
        world.steps(DT, 6).unwrap();
        world.report().clone()
    };
    // A ball by the first stack wakes this one, and no more whatever stands elsewhere.
    assert_eq!(field(3), field(120));
}
