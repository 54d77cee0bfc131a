//! Joints in scene files: each kind goes through text and back, and a world goes on to the bit.

use culbuto::joint::{Coefficients, Given, Hold, JointDef, JointKind, Motor, Spring, Travel};
use culbuto::math::{Real, Vec2, vec2};
use culbuto::scenes::SceneFile;
use culbuto::world::Snapshot;
use culbuto::{BodyDef, BodyHandle, BodyKind, World};
use proptest::prelude::*;

use crate::worlds::{bits, bytes};

fn number() -> impl Strategy<Value = Real> {
    prop_oneof![3 => -3.0..3.0, 1 => Just(0.0), 1 => Just(-0.0)]
}

fn vector() -> impl Strategy<Value = Vec2> {
    (number(), number()).prop_map(|(x, y)| vec2(x, y))
}

fn given() -> impl Strategy<Value = Given> {
    prop_oneof![vector().prop_map(Given::Local), vector().prop_map(Given::World)]
}

fn axis() -> impl Strategy<Value = Given> {
    (any::<bool>(), 0.1..3.0, number()).prop_map(|(world, x, y)| {
        if world { Given::World(vec2(x, y)) } else { Given::Local(vec2(x, y)) }
    })
}

fn spring() -> impl Strategy<Value = Spring> {
    prop_oneof![
        (0.1..30.0, 0.0..2.0).prop_map(|(hertz, ratio)| Spring::new(hertz, ratio)),
        (0.0..1e3, 0.0..10.0).prop_map(|(stiffness, damping)| {
            Spring::Constants(Coefficients { stiffness, damping })
        }),
    ]
}

fn hold() -> impl Strategy<Value = Hold> {
    prop_oneof![Just(Hold::Rigid), Just(Hold::Free), spring().prop_map(Hold::Spring)]
}

fn some() -> impl Strategy<Value = Option<Real>> {
    prop::option::of(0.1..9.0)
}

fn limits() -> impl Strategy<Value = Option<[Real; 2]>> {
    prop::option::of((-3.0..0.0, 0.0..3.0).prop_map(|(low, high)| [low, high]))
}

fn motor() -> impl Strategy<Value = Option<Motor>> {
    prop::option::of((number(), some()).prop_map(|(speed, max)| Motor { speed, max }))
}

fn travel() -> impl Strategy<Value = Travel> {
    (limits(), motor(), prop::option::of(spring()), number())
        .prop_map(|(limits, motor, spring, rest)| Travel { limits, motor, spring, rest })
}

fn kinds() -> impl Strategy<Value = JointKind> {
    let angle = || prop::option::of(number());
    prop_oneof![
        (some(), hold(), some()).prop_map(|(length, hold, max)| {
            JointKind::Distance { length, hold, min: 0.05, max }
        }),
        (angle(), travel()).prop_map(|(angle, travel)| JointKind::Revolute { angle, travel }),
        (axis(), angle(), travel()).prop_map(|(axis, angle, travel)| JointKind::Prismatic {
            axis,
            angle,
            travel
        }),
        (angle(), hold(), hold()).prop_map(|(angle, linear, angular)| JointKind::Weld {
            angle,
            linear,
            angular
        }),
        (axis(), hold(), limits(), motor()).prop_map(|(axis, suspension, limits, motor)| {
            JointKind::Wheel { axis, suspension, limits, motor }
        }),
        (hold(), some()).prop_map(|(hold, max_force)| JointKind::Grab { hold, max_force }),
        (vector(), angle(), hold(), some()).prop_map(|(offset, angle, linear, max_force)| {
            let (angular, max_torque) = (Hold::Rigid, None);
            JointKind::Motor { offset, angle, linear, angular, max_force, max_torque }
        }),
        (0.1..3.0, angle()).prop_map(|(ratio, phase)| JointKind::Gear { ratio, phase }),
        (vector(), 0.1..3.0, some(), any::<bool>()).prop_map(|(over, ratio, length, slack)| {
            JointKind::Pulley { over: [over, over + vec2(1.0, 0.0)], ratio, length, slack }
        }),
        (axis(), 0.1..3.0, angle()).prop_map(|(axis, radius, offset)| JointKind::Rack {
            axis,
            radius,
            offset
        }),
        (0.1..1.0, number()).prop_map(|(step, phase)| JointKind::Ratchet { step, phase }),
        (0.0..9.0, 0.0..9.0)
            .prop_map(|(max_force, max_torque)| { JointKind::Friction { max_force, max_torque } }),
        (angle(), spring()).prop_map(|(angle, spring)| JointKind::AngleSpring { angle, spring }),
        Just(JointKind::Filter),
    ]
}

type Ends = (usize, Option<usize>);

fn joints() -> impl Strategy<Value = (Ends, JointDef)> {
    let name = prop::option::of(prop::sample::select(vec!["knee", "ü \"x\""]));
    let ends = prop::sample::select(vec![(0, Some(1)), (1, Some(2)), (2, None), (0, Some(3))]);
    (ends, name, [given(), given()], kinds(), any::<bool>(), [some(), some()]).prop_map(
        |(ends, name, anchors, kind, collide_connected, [breaking_force, breaking_torque])| {
            let def = JointDef {
                name: name.map(Into::into),
                anchors,
                collide_connected,
                // Far above what acts here, so that nothing breaks on the way.
                breaking_force: breaking_force.map(|force| force * 1e9),
                breaking_torque: breaking_torque.map(|torque| torque * 1e9),
                ..JointDef::new(None, None, kind)
            };
            (ends, def)
        },
    )
}

/// Three points that move, one that is fixed, and joints among them, after some steps.
fn worlds() -> impl Strategy<Value = World> {
    let steps = prop::collection::vec(1e-3..0.02, 0..6);
    (prop::collection::vec(joints(), 1..4), steps).prop_map(|(joints, steps)| {
        let mut world = World::default();
        let gone = world.add_body(BodyDef::point(1.0)).unwrap();
        let mut bodies: Vec<BodyHandle> = (0..3)
            .map(|i| {
                let (x, spin) = (Real::from(i), 0.3 * Real::from(i));
                let def = BodyDef { inertia: Some(0.5), ..BodyDef::point(1.0 + x) };
                let position = vec2(x, 0.5 * x);
                world.add_body(BodyDef { position, angular_velocity: spin, ..def }).unwrap()
            })
            .collect();
        bodies.push(
            world.add_body(BodyDef { kind: BodyKind::Static, ..BodyDef::default() }).unwrap(),
        );
        world.remove_body(gone).unwrap();
        for ((a, b), def) in joints {
            let pair = [Some(bodies[a]), b.map(|b| bodies[b])];
            world.add_joint(JointDef { bodies: pair, ..def }).unwrap();
        }
        for dt in steps {
            // What pulls apart without bound may leave the range; the world then stays.
            let _ = world.step(dt);
        }
        world
    })
}

proptest! {
    #[test]
    fn a_world_with_joints_goes_on_bit_for_bit_from_its_file(mut world in worlds()) {
        let file = SceneFile::from_world(&world).unwrap();
        let text = file.to_json();
        let read = SceneFile::from_json(&text).unwrap();
        prop_assert_eq!(&read, &file, "{}", text);
        let mut again = read.world().unwrap();
        let known = |world: &World| -> Vec<_> {
            let known = |joint: &culbuto::joint::Joint| {
                (joint.def.kind, joint.anchors(), joint.springs, joint.impulses, joint.notch)
            };
            world.joints().iter().map(known).collect()
        };
        prop_assert_eq!(known(&world), known(&again), "{}", text);
        prop_assert_eq!(&SceneFile::from_world(&again).unwrap().to_json(), &text);
        for dt in [1.0 / 60.0, 0.004] {
            let (one, other) = (world.step(dt), again.step(dt));
            prop_assert_eq!(one.is_ok(), other.is_ok());
            prop_assert_eq!(bits(&world), bits(&again), "{}", text);
        }
    }

    #[test]
    fn a_world_with_joints_goes_through_bytes(mut world in worlds()) {
        let snapshot = world.snapshot().to_bytes().unwrap();
        let mut again = Snapshot::from_bytes(&snapshot, Vec::new()).unwrap().to_world();
        prop_assert_eq!(bytes(&world), bytes(&again));
        let (one, other) = (world.step(0.01), again.step(0.01));
        prop_assert_eq!(one.is_ok(), other.is_ok());
        prop_assert_eq!(bytes(&world), bytes(&again));
    }
}

/// Three bodies and the joint of this text.
fn with(joint: &str) -> String {
    format!(
        r#"{{"culbuto": 1, "gravity": [0.0, 0.0], "bodies": [{{"name": "a", "kind": "static"}},
        {{"name": "b", "mass": 2.0, "position": [3.0, 4.0]}}, {{"mass": 1.0}}], "joints": [{joint}]}}"#
    )
}

#[test]
fn a_joint_is_pleasant_to_write() {
    let json = with(
        r#"{"bodies": ["a", 1], "anchors": [{"world": [0, 1]}, [0.5, 0]],
            "joint": {"distance": {"hold": {"hertz": 2, "damping_ratio": 0.1}}}},
           {"bodies": [null, "b"], "joint": {"revolute": {"travel": {"limits": [-1, 1], "motor": {"speed": 2}}}}},
           {"bodies": [1, 2], "joint": {"weld": {"linear": {"stiffness": 100}, "angular": "free"}}},
           {"bodies": [1, 2], "joint": "filter"}"#,
    );
    let world = SceneFile::from_json(&json).unwrap().world().unwrap();
    let joints = world.joints();
    assert_eq!(
        joints[0].def.bodies,
        [Some(world.bodies().handles()[0]), Some(world.bodies().handles()[1])]
    );
    assert_eq!(joints[0].anchors(), [vec2(0.0, 1.0), vec2(0.5, 0.0)]);
    let (length, hold) = (Some((3.5 * 3.5 + 3.0 * 3.0_f64).sqrt()), Hold::soft(2.0, 0.1));
    assert_eq!(joints[0].def.kind, JointKind::Distance { length, hold, min: 0.0, max: None });
    assert_eq!(joints[1].def.bodies, [None, Some(world.bodies().handles()[1])]);
    let linear = Hold::Spring(Spring::Constants(Coefficients { stiffness: 100.0, damping: 0.0 }));
    let angle = Some(0.0);
    assert_eq!(joints[2].def.kind, JointKind::Weld { angle, linear, angular: Hold::Free });
    assert_eq!(joints[3].def.kind, JointKind::Filter);
}

#[test]
fn what_is_as_usual_of_a_joint_is_not_written() {
    let json = with(r#"{"bodies": [null, "b"], "joint": {"revolute": {}}}"#);
    let text = SceneFile::from_json(&json).unwrap().to_json();
    assert!(
        text.contains("    {\"bodies\": [null, \"b\"], \"joint\": {\"revolute\": {}}}\n"),
        "{text}"
    );
    let world = SceneFile::from_json(&text).unwrap().world().unwrap();
    let text = SceneFile::from_world(&world).unwrap().to_json();
    let written = r#"{"bodies": [null, "b"], "joint": {"revolute": {"angle": 0.0}}}"#;
    assert!(text.contains(written), "{text}");
}

/// (the joint, path, part of the message).
const BAD: &[(&str, &str, &str)] = &[
    (r#"{"bodies": [1, 2], "joint": "custom"}"#, "joints[0].joint.custom", "without a constraint"),
    (r#"{"joint": "filter"}"#, "joints[0]", "missing field `bodies`"),
    (r#"{"bodies": ["a", "b"]}"#, "joints[0]", "missing field `joint`"),
    (r#"{"bodies": ["a"], "joint": "filter"}"#, "joints[0].bodies", "length"),
    (r#"{"bodies": ["a", "c"], "joint": "filter"}"#, "joints[0].bodies[1]", "no body is called"),
    (r#"{"bodies": [7, "b"], "joint": "filter"}"#, "joints[0].bodies[0]", "there are 3"),
    (r#"{"bodies": ["b", 1], "joint": "filter"}"#, "joints[0].bodies", "the same body twice"),
    (r#"{"bodies": [null, null], "joint": "filter"}"#, "joints[0].bodies", "the world twice"),
    (r#"{"bodies": [null, "a"], "joint": "filter"}"#, "joints[0].bodies", "dynamic"),
    (r#"{"bodies": [1, 2], "joint": "glue"}"#, "joints[0].joint", "expected one of `distance`"),
    (r#"{"bodies": [1, 2], "joint": {"gear": {}}}"#, "joints[0].joint.gear", "`ratio`"),
    (
        r#"{"bodies": [1, 2], "joint": {"weld": {"stiff": 1}}}"#,
        "joints[0].joint.weld.stiff",
        "unknown field `stiff`",
    ),
    (
        r#"{"bodies": [1, 2], "joint": {"weld": {"linear": {"hertz": 1, "damping": 2}}}}"#,
        "joints[0].joint.weld.linear",
        "\"rigid\", \"free\", or a spring",
    ),
    (
        r#"{"bodies": [1, 2], "joint": {"weld": {"linear": {"hertz": -1}}}}"#,
        "joints[0].joint.weld",
        "hertz is -1; allowed: a finite number above 0",
    ),
    (
        r#"{"bodies": [1, 2], "joint": {"angle_spring": {"spring": "rigid"}}}"#,
        "joints[0].joint.angle_spring.spring",
        "{\"hertz\": …",
    ),
    (
        r#"{"bodies": [1, 2], "joint": {"prismatic": {"axis": [0, 0]}}}"#,
        "joints[0].joint.prismatic",
        "axis is (0, 0)",
    ),
    (
        r#"{"bodies": [1, 2], "joint": {"prismatic": {"axis": {"screen": [1, 0]}}}}"#,
        "joints[0].joint.prismatic.axis",
        "{\"world\": [x, y]}",
    ),
    (
        r#"{"bodies": [1, 2], "joint": {"revolute": {"travel": {"limits": [2, 1]}}}}"#,
        "joints[0].joint.revolute",
        "upper limit is 1; allowed: 2 or above",
    ),
    (
        r#"{"bodies": [1, 2], "anchors": [[0, 0], [0, 1e999]], "joint": {"revolute": {}}}"#,
        "joints[0].anchors[1][1]",
        "out of range",
    ),
    (
        r#"{"bodies": [1, 2], "joint": {"revolute": {}}, "breaking_force": -1}"#,
        "joints[0].breaking_force",
        "0 or above",
    ),
    (
        r#"{"bodies": [1, 2], "joint": {"revolute": {}}, "state": {"impulses": [1, 2, 3, 4, 5, 6, 7]}}"#,
        "joints[0].state.impulses",
        "7 rows",
    ),
    (
        r#"{"bodies": [1, 2], "joint": {"revolute": {}}, "state": {"springs": [{"stiffness": -1}]}}"#,
        "joints[0].state.springs[0]",
        "0 or above",
    ),
    (
        r#"{"bodies": [1, 2], "joint": {"revolute": {}}, "state": {"substep": -1}}"#,
        "joints[0].state.substep",
        "0 or above",
    ),
];

#[test]
fn a_joint_that_is_wrong_is_named_by_its_path() {
    for (joint, path, part) in BAD {
        let error = SceneFile::from_json(&with(joint)).and_then(|scene| scene.world());
        let Err(culbuto::Error::SceneFile { path: got, message }) = error else {
            panic!("{joint} is allowed");
        };
        assert_eq!(got, *path, "{joint}: {message}");
        assert!(message.contains(part), "{joint}: {message}");
    }
}
