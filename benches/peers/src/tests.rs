//! What the yardstick and the scenes claim.

use culbuto::body::BodyKind;
use culbuto::math::{Real, Rot, Vec2, cross, vec2};

use crate::engines::State;
use crate::scene::{Body, Region, Scene, Shape};
use crate::{scenes, yardstick};

const EPS: Real = 1e-12;

fn of(bodies: Vec<Body>) -> Scene {
    Scene { bodies, ..scenes::all().remove(0) }
}

fn square() -> Shape {
    Shape::rectangle(0.5, 0.5)
}

/// Overlap of two bodies of one shape each, the second at a place and angle, both then moved and
/// turned by some motion.
fn overlap(first: Shape, second: Shape, place: Vec2, angle: Real) -> Real {
    let motion = Rot::new(0.7);
    let still = Body { angle: 0.7, ..Body::new(vec2(3.0, -5.0), vec![first]) };
    let place = vec2(3.0, -5.0) + motion.apply(place);
    let other = Body { angle: 0.7 + angle, ..Body::new(place, vec![second]) };
    let found = [vec![still.clone(), other.clone()], vec![other, still]].map(|bodies| {
        let scene = of(bodies);
        yardstick::measure(&scene, &yardstick::start(&scene)).unwrap().overlap
    });
    assert!((found[0] - found[1]).abs() < EPS, "the order of two bodies does not matter");
    found[0]
}

#[track_caller]
fn assert_near(x: Real, right: Real) {
    assert!((x - right).abs() < 1e-12 * (1.0 + right.abs()), "{x} is not {right}");
}

#[test]
fn overlaps_are_the_shortest_way_out() {
    let eighth = std::f64::consts::FRAC_PI_4;
    let half_diagonal = Real::sqrt(0.5);
    assert_near(overlap(square(), square(), vec2(0.9, 0.3), 0.0), 0.1);
    assert_near(overlap(square(), square(), vec2(1.1, 0.0), 0.0), 0.0);
    // The corner of a square on its tip, 0.1 deep in the side of the other.
    assert_near(overlap(square(), square(), vec2(0.4 + half_diagonal, 0.0), eighth), 0.1);
    assert_near(overlap(Shape::disk(0.5), Shape::disk(0.25), vec2(0.45, 0.6), 0.0), 0.0);
    assert_near(overlap(Shape::disk(0.5), Shape::disk(0.25), vec2(0.3, 0.4), 0.0), 0.25);
    // A disk beyond a side, beyond a corner, and with its centre inside.
    assert_near(overlap(square(), Shape::disk(0.25), vec2(0.7, 0.2), 0.0), 0.05);
    assert_near(overlap(square(), Shape::disk(1.0), vec2(1.1, 1.3), 0.0), 0.0);
    assert_near(overlap(square(), Shape::disk(1.1), vec2(1.1, 1.3), 0.0), 0.1);
    assert_near(overlap(square(), Shape::disk(0.25), vec2(0.4, 0.0), 0.0), 0.35);
    let line = Shape::Segment { a: vec2(-2.0, 0.0), b: vec2(2.0, 0.0) };
    assert_near(overlap(line.clone(), square(), vec2(0.3, 0.48), 0.0), 0.02);
    assert_near(overlap(line.clone(), square(), vec2(0.3, -0.48), 0.0), 0.02);
    assert_near(overlap(line.clone(), square(), vec2(2.4, 0.0), 0.0), 0.1);
    assert_near(overlap(line.clone(), Shape::disk(0.5), vec2(1.0, -0.4), 0.0), 0.1);
    assert_near(overlap(line, Shape::disk(0.5), vec2(2.3, 0.4), 0.0), 0.0);
}

#[test]
fn shapes_of_one_body_and_of_bodies_that_forces_do_not_move_do_not_overlap() {
    let ground = Body::ground(vec![square(), square()]);
    let kind = BodyKind::Kinematic;
    let bodies = vec![ground, Body { kind, ..Body::new(vec2(0.1, 0.0), vec![square(), square()]) }];
    let scene = of(bodies);
    let end = yardstick::measure(&scene, &yardstick::start(&scene)).unwrap();
    assert_eq!(end.overlap, 0.0);
}

#[test]
fn energies_speeds_and_losses() {
    // A square of density 3 about (1, 0) of its frame, which stands at (2, 3), turned a quarter.
    let off_center = Shape::Box { center: vec2(1.0, 0.0), half: vec2(0.5, 0.5) };
    let body = Body {
        angle: std::f64::consts::FRAC_PI_2,
        velocity: vec2(3.0, 4.0),
        angular_velocity: 2.0,
        density: 3.0,
        ..Body::new(vec2(2.0, 3.0), vec![off_center])
    };
    let low = Body::new(vec2(9.0, -1.0), vec![square()]);
    let scene = of(vec![Body::ground(vec![square()]), body, low]);
    let mut states = yardstick::start(&scene);
    let end = yardstick::measure(&scene, &states).unwrap();
    assert_near(end.kinetic, 0.5 * 3.0 * 25.0 + 0.5 * (3.0 / 6.0) * 4.0);
    assert_near(end.total, end.kinetic + 3.0 * 10.0 * 4.0 - 10.0);
    assert_near(end.rms_speed, Real::sqrt(25.0 / 2.0));
    assert_eq!(end.lost, 1);
    states[1].velocity.x = Real::NAN;
    let end = yardstick::measure(&scene, &states).unwrap();
    assert_eq!((end.lost, end.kinetic, end.total), (2, 0.0, -10.0));
    assert!(yardstick::measure(&scene, &states[1..]).is_err());
}

#[test]
fn regions_hold_numbers_only() {
    let disk = Region::Disk { center: vec2(0.0, 10.0), radius: 2.0 };
    for region in [Region::Everywhere, Region::Above(1.0), disk] {
        assert!(region.holds(vec2(1.0, 11.0)));
        assert!(!region.holds(vec2(Real::NAN, 11.0)) && !region.holds(vec2(0.0, Real::NAN)));
    }
    assert!(!Region::Above(1.0).holds(vec2(0.0, 0.9)) && !disk.holds(vec2(0.0, 12.1)));
}

#[test]
fn scenes_start_whole_and_without_overlaps() {
    for scene in scenes::all() {
        let end = yardstick::measure(&scene, &yardstick::start(&scene)).unwrap();
        assert!(end.overlap < EPS, "{}: {}", scene.name, end.overlap);
        assert_eq!(end.lost, 0, "{}", scene.name);
        for shape in scene.bodies.iter().flat_map(|body| &body.shapes) {
            let corners = shape.corners();
            let n = corners.len();
            let turn = |i: usize| {
                let [a, b, c] = [i, i + 1, i + 2].map(|k| corners[k % n]);
                cross(b - a, c - b)
            };
            assert!(n < 3 || (0..n).all(|i| turn(i) > 0.0), "{}: {shape:?}", scene.name);
        }
    }
}

#[test]
fn scenes_have_the_sizes_of_their_models() {
    let sizes = scenes::all().iter().map(|scene| (scene.name, scene.dynamic())).collect::<Vec<_>>();
    let right = [
        ("stack_10", 10),
        ("chain_100", 100),
        ("rope_30", 31),
        ("pyramid_20", 210),
        ("circles_1000", 1000),
        ("circles_5000", 5000),
        ("large_pyramid", 5050),
        ("ragdolls_25", 275),
        ("tumbler", 2025),
        ("joint_grid", 9993),
        ("junkyard", 8000),
        ("compounds", 3000),
        ("smash", 9601),
        ("washer", 8100),
        ("many_pyramids", 22_000),
    ];
    assert_eq!(sizes, right);
}

/// A scene of the catalogue as one for all engines.
fn translated(name: &str) -> Result<Scene, &'static str> {
    let scene = culbuto::scenes::scene(name).unwrap();
    let culbuto::scenes::Answer::Motion(motion) = scene.answer else {
        panic!("{name} has no motion")
    };
    crate::translate::translate(scene.name, scene.title, &(motion.build)().unwrap())
}

#[test]
fn scenes_of_the_catalogue_keep_what_matters_when_they_are_translated() {
    let springs = translated("S7").unwrap();
    assert_eq!((springs.bodies.len(), springs.joints.len()), (5, 4));
    for joint in &springs.joints {
        let spring = joint.spring.unwrap();
        assert_near(spring.hertz, 2.0);
        let mass = spring.stiffness / (std::f64::consts::TAU * 2.0).powi(2);
        assert_near(mass, yardstick_mass(&springs.bodies[joint.bodies[1]]));
    }
    let ball = translated("elastic_ball").unwrap();
    assert_near(ball.restitution, 1.0);
    // A rod of 1 m and 1 kg that touches nothing.
    let rod = &translated("rod_pendulum").unwrap().bodies[0];
    let Shape::Circle { center, radius } = rod.shapes[0] else { panic!("no disk") };
    assert_eq!(center, vec2(0.0, 0.0));
    assert_near(yardstick_mass(rod), 1.0);
    assert_near(0.5 * radius * radius, 1.0 / 12.0);
    assert_eq!(translated("kepler").unwrap_err(), "a field or a schedule of forces acts");
    assert_eq!(translated("fall_with_drag").unwrap_err(), "the air resists");
}

/// Mass of a disk.
fn yardstick_mass(body: &Body) -> Real {
    let Shape::Circle { radius, .. } = body.shapes[0] else { panic!("no disk") };
    body.density * std::f64::consts::PI * radius * radius
}

#[test]
fn other_engines_can_have_all_hard_scenes() {
    for hard in culbuto::scenes::hard::HARD {
        let world = (hard.build)().unwrap();
        let scene = crate::translate::translate(hard.name, hard.about, &world).unwrap();
        let start = yardstick::start(&scene);
        for (state, right) in start.iter().zip(culbuto::report::stability::states(&world)) {
            assert!((state.position - right.pose.position).norm() < EPS, "{}", hard.name);
        }
    }
}

#[test]
fn a_scene_in_another_unit_is_the_same_scene() {
    let scene = scenes::all().into_iter().find(|scene| scene.name == "rope_30").unwrap();
    let mut states = yardstick::start(&scene);
    states[3].velocity = vec2(1.0, 2.0);
    let end = yardstick::measure(&scene, &states).unwrap();
    for state in &mut states {
        state.position /= 5.0;
        state.velocity /= 5.0;
    }
    let other = yardstick::measure(&scene.in_units_of(5.0), &states).unwrap();
    assert_near(other.kinetic, end.kinetic / 25.0);
    assert_near(other.total, end.total / 25.0);
    assert_near(other.gap, end.gap / 5.0);
}

#[test]
fn what_swings_is_where_it_should_be_after_every_step() {
    let scene = scenes::all().into_iter().find(|scene| scene.swing.is_some()).unwrap();
    let swing = scene.swing.unwrap();
    let mut x = 0.0;
    for step in 0..scene.steps {
        x += swing.velocity(step, scene.dt).x * scene.dt;
        assert_near(x, 60.0 * (0.2 * Real::from(step + 1) / 60.0).sin());
    }
}

/// Whether an entrant can be raced: those of Python with Python, Box2D 2 not, which has no hinges with springs.
fn able(name: &str, python: bool) -> bool {
    name != crate::engines::BOX2D_2 && (python || !crate::engines::PYTHON.contains(&name))
}

#[test]
fn every_engine_starts_with_the_scene() {
    let python = std::env::var("PEERS_PYTHON").ok(); // without it pymunk is not tested
    let able = |name: &str| able(name, python.is_some());
    for (name, make) in crate::engines::ALL.iter().filter(|(name, _)| able(name)) {
        let mut entrant = make(python.as_deref()).unwrap();
        for scene in scenes::all().iter().filter(|scene| scene.name != "many_pyramids") {
            entrant.start(scene).unwrap();
            let pairs = entrant.state().unwrap().into_iter().zip(yardstick::start(scene));
            let off = pairs.map(|(ours, right): (State, State)| {
                let place = (ours.position - right.position).norm();
                let turn = ours.angular_velocity - right.angular_velocity;
                let motion = (ours.velocity - right.velocity).norm() + turn.abs();
                place + (ours.angle - right.angle).abs() + motion
            });
            let off = off.fold(0.0, Real::max);
            assert!(off < 1e-4, "{name}, {}: {off}", scene.name);
        }
    }
}

/// Of every engine: what is kinematic goes where the scene says, and what falls freely falls.
#[test]
fn every_engine_moves_what_swings_and_what_falls() {
    let python = std::env::var("PEERS_PYTHON").ok();
    let able = |name: &str| able(name, python.is_some());
    let mut scene = scenes::all().into_iter().find(|scene| scene.swing.is_some()).unwrap();
    for (name, make) in crate::engines::ALL.iter().filter(|(name, _)| able(name)) {
        scene.steps = 30;
        let mut entrant = make(python.as_deref()).unwrap();
        entrant.start(&scene).unwrap();
        entrant.advance(&scene, 0..scene.steps).unwrap();
        let states = entrant.state().unwrap();
        let pusher = states[scene.swing.unwrap().body].position;
        assert!((pusher.x - 60.0 * Real::sin(0.1)).abs() < 1e-3, "{name}: {pusher}");
        assert!(pusher.y.abs() < 1e-9, "{name}: {pusher}");
        // 0.5 s of fall, 1.25 m; methods of first order are off by half a step's gain, ½ght.
        let off = 15.0 - states[1].position.y - 1.25;
        assert!(off.abs() < 0.5 * 10.0 * scene.dt * 0.5 + 1e-4, "{name}: {off}");
    }
}

#[test]
fn the_spread_of_times_is_median_least_greatest() {
    let entry = |times: &[Real]| crate::race::Entry {
        entrant: "one".into(),
        times: times.to_vec(),
        end: None,
        error: None,
    };
    assert_eq!(entry(&[3.0, 1.0, 9.0]).spread(), Some([3.0, 1.0, 9.0]));
    assert_eq!(entry(&[4.0, 1.0, 2.0, 9.0]).spread(), Some([3.0, 1.0, 9.0]));
    assert_eq!(entry(&[]).spread(), None);
}
