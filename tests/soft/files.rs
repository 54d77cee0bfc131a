//! Scene files hold deformable bodies and the joints on them.

use super::{STEP, block, material, with_floor};
use culbuto::World;
use culbuto::joint::JointDef;
use culbuto::math::{Real, Vec2, vec2};
use culbuto::scenes::SceneFile;
use culbuto::soft::{Gas, Material, Mesh, Rope, SoftDef};

/// A block that hangs on a pin, one that yields, and a balloon, all on their way.
fn busy() -> World {
    let mut world = with_floor();
    let def = SoftDef {
        position: vec2(0.0, 2.0),
        name: Some("hung".into()),
        ..block(material(1e5, 0.1))
    };
    let hung = world.add_soft_body(def).expect("it is allowed");
    let pin = JointDef::revolute(None, None).at(vec2(0.5, 2.5));
    world.add_soft_joint(pin, [None, Some(hung)]).expect("it is allowed");
    let soft = Material { yield_strain: Some(0.02), ..material(2e4, 0.5) };
    let def = SoftDef { position: vec2(3.0, 0.8), angle: 0.3, ..block(soft) };
    world.add_soft_body(def).expect("it is allowed");
    let ring: Vec<Vec2> = (0..16)
        .map(|k| culbuto::math::sin_cos(culbuto::math::PI * Real::from(k) / 8.0))
        .map(|(sin, cos)| vec2(cos, sin) * 0.4)
        .collect();
    let rope = Some(Rope { stretch_stiffness: 3e3, bending_stiffness: 0.1 });
    let gas = Some(Gas { pressure: 1.02e5, outside: 1e5, exponent: 1.4 });
    let def = SoftDef {
        rope,
        gas,
        position: vec2(-3.0, 0.6),
        ..SoftDef::new(
            Mesh::rope(&ring, true).expect("a ring"),
            Material { density: 1.0, ..Material::default() },
        )
    };
    world.add_soft_body(def).expect("it is allowed");
    world.steps(STEP, 40).expect("it steps");
    world
}

#[test]
fn what_is_written_is_read_and_goes_on() {
    let mut world = busy();
    assert!(!world.soft_bodies()[1].flow().is_empty(), "it has yielded");
    let text = SceneFile::from_world(&world).unwrap().to_json();
    let file = SceneFile::from_json(&text).unwrap();
    assert_eq!(file.to_json(), text);
    let mut copy = file.world().unwrap();
    assert_eq!(SceneFile::from_world(&copy).unwrap().to_json(), text);
    for (own, other) in world.soft_bodies().iter().zip(copy.soft_bodies()) {
        assert_eq!(own.positions(), other.positions());
        assert_eq!(own.velocities(), other.velocities());
        assert_eq!((own.pinned(), own.flow()), (other.pinned(), other.flow()));
        let energies = [own, other].map(culbuto::soft::SoftBody::strain_energy);
        let off = (energies[0] - energies[1]).abs();
        assert!(off <= 1e-12 * energies[0].abs(), "{energies:?}");
    }
    world.steps(STEP, 5).unwrap();
    copy.steps(STEP, 5).unwrap();
    for (own, other) in world.soft_bodies().iter().zip(copy.soft_bodies()) {
        let off = own.positions().iter().zip(other.positions()).map(|(a, b)| (a - b).norm());
        let off = off.fold(0.0, Real::max);
        assert!(off < 1e-6, "{off:e}");
    }
    assert!(copy.joint_gap() < 1e-5);
}

#[test]
fn a_file_by_hand_cuts_shapes_and_names_bodies() {
    let text = r#"{"culbuto": 1, "soft_bodies": [
        {"name": "jelly", "shape": {"circle": {"radius": 0.5}}, "size": 0.2, "position": [0, 2], "material": {"youngs_modulus": 1e5}},
        {"points": [[0, 0], [1, 0], [2, 0]], "rope": {"stretch_stiffness": 1e3}, "pins": [0]}],
        "joints": [{"bodies": [null, null], "soft_bodies": [null, "jelly"], "anchors": [{"world": [0, 3]}, {"world": [0, 2.5]}], "joint": {"distance": {}}}]}"#;
    let mut world = SceneFile::from_json(text).unwrap().world().unwrap();
    assert_eq!(world.soft_bodies().len(), 2);
    world.steps(STEP, 60).unwrap();
    let [a, b] = world.joint(world.joint_handles()[0]).unwrap().anchors();
    assert!(((a - b).norm() - 0.5).abs() < 1e-2, "{a} {b}");
    assert_eq!(world.soft_bodies()[1].positions()[0], Vec2::zeros());
}

#[test]
fn what_is_wrong_is_named_by_its_path() {
    let wrong = [
        (r#""soft_bodies": [{"points": [[0, 0]]}]"#, "soft_bodies[0]"),
        (r#""soft_bodies": [{"shape": {"circle": {"radius": 0.5}}}]"#, "size"),
        (
            r#""soft_bodies": [{"points": [[0, 0], [1, 0], [0, 1]], "triangles": [[0, 1, 7]]}]"#,
            "soft_bodies[0]",
        ),
        (
            r#""soft_bodies": [{"points": [[0, 0], [1, 0], [0, 1]], "triangles": [[0, 1, 2]], "state": {"positions": [[0, 0]]}}]"#,
            "soft_bodies[0].state",
        ),
        (
            r#""soft_bodies": [{"points": [[0, 0], [1, 0], [0, 1]], "triangles": [[0, 1, 2]], "state": {"flow": [[1, 0, 0, 1], [0, 0, 0, 0], [1, 0, 0, 1]]}}]"#,
            "soft_bodies[0].state",
        ),
        (
            r#""joints": [{"bodies": [null, null], "soft_bodies": [null, "jelly"], "joint": {"distance": {}}}]"#,
            "joints[0].soft_bodies[1]",
        ),
        (
            r#""joints": [{"bodies": [null, null], "soft_bodies": [3, null], "joint": {"distance": {}}}]"#,
            "joints[0].soft_bodies[0]",
        ),
    ];
    for (part, path) in wrong {
        let text = format!("{{\"culbuto\": 1, {part}}}");
        let error = SceneFile::from_json(&text).and_then(|file| file.world()).expect_err(part);
        assert!(error.to_string().contains(path), "{error}");
    }
}
