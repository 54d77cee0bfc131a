//! Bad input: the path of the value that is wrong, and what is allowed.

use culbuto::forces::{Central, Oscillating};
use culbuto::math::vec2;
use culbuto::scenes::SceneFile;
use culbuto::{BodyDef, Error, World};

use crate::worlds::Righting;

/// (the rest of a file after `"culbuto": 1`, path, part of the message).
const BAD: &[(&str, &str, &str)] = &[
    (r#""plasmas": []"#, "plasmas", "unknown field"),
    (r#""gravity": "down""#, "gravity", "expected two numbers"),
    (r#""gravity": [0]"#, "gravity", "expected two numbers"),
    (r#""gravity": [0, 1, 2]"#, "gravity", "expected two numbers"),
    (r#""gravity": [0, 1e999]"#, "gravity[1]", "out of range"),
    (r#""gravity": [0, NaN]"#, "gravity", "expected value"),
    (r#""name": 3"#, "name", "expected a string"),
    (r#""air": {"density": -1}"#, "air.density", "0 or above"),
    (r#""air": {"desnity": 1}"#, "air.desnity", "unknown field"),
    (r#""settings": {"method": "magic"}"#, "settings.method", "allowed: leapfrog"),
    (r#""settings": {"substeps": 0}"#, "settings.substeps", "1 to 65536"),
    (r#""settings": {"substeps": -2}"#, "settings.substeps", "invalid value"),
    (r#""run": {"dt": 0}"#, "run.dt", "above 0"),
    (r#""run": {"duration": -1}"#, "run.duration", "0 or above"),
    (r#""bodies": {}"#, "bodies", "expected a sequence"),
    (r#""bodies": [7]"#, "bodies[0]", "a body"),
    (r#""bodies": [{}]"#, "bodies[0]", "mass of a dynamic body is 0"),
    (r#""bodies": [{"mass": 1}, {"mass": -1}]"#, "bodies[1].mass", "above 0"),
    (r#""bodies": [{"mass": 1, "colour": 3}]"#, "bodies[0]", "unknown field `colour`"),
    (r#""bodies": [{"mass": 1, "mass": 2}]"#, "bodies[0]", "duplicate field"),
    (r#""bodies": [{"shapes": [], "shapes": []}]"#, "bodies[0]", "duplicate field"),
    (r#""bodies": [{"center_at": [1, 1], "center_at": [1, 1]}]"#, "bodies[0]", "duplicate field"),
    (r#""bodies": [{"mass": 1, "position": [0, "a"]}]"#, "bodies[0].position[1]", "expected f64"),
    (r#""bodies": [{"position": [0, 1], "center_at": [1, 1]}]"#, "bodies[0]", "not both"),
    (r#""bodies": [{"mass": 1, "center_at": [1]}]"#, "bodies[0].center_at", "two numbers"),
    (r#""bodies": [{"kind": "loose"}]"#, "bodies[0].kind", "expected one of `static`"),
    (r#""bodies": [{"kind": "static", "velocity": [1, 1]}]"#, "bodies[0]", "velocity x is 1"),
    (r#""bodies": [{"mass": 1, "locks": {"z": true}}]"#, "bodies[0].locks.z", "unknown field"),
    (r#""bodies": [{"mass": 1, "drag_width": {"fixed": -1}}]"#, "bodies[0].drag_width", "above"),
    (
        r#""bodies": [{"shapes": [{"shape": {"box": {"width": 1}}}]}]"#,
        "bodies[0].shapes[0].shape.box",
        "missing field `height`",
    ),
    (
        r#""bodies": [{"shapes": [{"shape": {"circle": {"radius": 0}}}]}]"#,
        "bodies[0].shapes[0].shape",
        "above 0",
    ),
    (
        r#""bodies": [{"shapes": [{"shape": {"blob": {}}}]}]"#,
        "bodies[0].shapes[0].shape",
        "expected one of `circle`",
    ),
    (
        r#""bodies": [{"shapes": [{"shape": {"polygon": {"vertices": [[0, 0], [1, 1], [1, 0], [0, 1]]}}}]}]"#,
        "bodies[0].shapes[0].shape",
        "edge 0–1 crosses edge 2–3",
    ),
    (
        r#""bodies": [{"shapes": [{"shape": {"circle": {"radius": 1}}, "material": "wood"}]}]"#,
        "bodies[0].shapes[0].material",
        "there are: none",
    ),
    (
        r#""materials": {"ice": {}}, "bodies": [{"shapes": [{"shape": {"circle": {"radius": 1}}, "material": "wood"}]}]"#,
        "bodies[0].shapes[0].material",
        r#"there are: "ice""#,
    ),
    (r#""materials": {"wood": {"density": -600}}"#, "materials.wood.density", "0 or above"),
    (
        r#""bodies": [{"shapes": [{"shape": {"circle": {"radius": 1}}, "density": -1}]}]"#,
        "bodies[0].shapes[0].density",
        "0 or above",
    ),
    (
        r#""bodies": [{"shapes": [{"shape": {"chain": {"points": [[0, 0]]}}}]}]"#,
        "bodies[0].shapes[0].shape",
        "the number of points of the open chain is 1",
    ),
    (
        r#""bodies": [{"shapes": [{"shape": {"chain": {"points": [[0, 0], [1, 0]], "closed": 1}}}]}]"#,
        "bodies[0].shapes[0].shape.chain.closed",
        "expected a boolean",
    ),
    (r#""materials": {"ice": {"friction": -1}}"#, "materials.ice.friction", "0 or above"),
    (r#""bodies": [{"mass": 1, "friction": -1}]"#, "bodies[0].friction", "0 or above"),
    (r#""bodies": [{"mass": 1, "friction": "low"}]"#, "bodies[0].friction", "a number, or {"),
    (r#""bodies": [{"mass": 1, "friction": null}]"#, "bodies[0].friction", "a number, or {"),
    (r#""bodies": [{"mass": 1, "friction": [1, 1]}]"#, "bodies[0].friction", "a number, or {"),
    (r#""bodies": [{"mass": 1, "friction": {"static": 1}}]"#, "bodies[0].friction", "`kinetic`"),
    (
        r#""bodies": [{"mass": 1, "friction": {"static": 1, "kinetic": 1, "rolling": 1}}]"#,
        "bodies[0].friction.rolling",
        "unknown field `rolling`",
    ),
    (
        r#""bodies": [{"mass": 1, "friction": {"static": 0.2, "kinetic": 0.3}}]"#,
        "bodies[0]",
        "kinetic friction is 0.3; allowed: 0 to the static friction, 0.2",
    ),
    (r#""bodies": [{"mass": 1, "friction": 1, "friction": 1}]"#, "bodies[0]", "duplicate field"),
    (r#""bodies": [{"mass": 1, "surface": {}}]"#, "bodies[0]", "unknown field `surface`"),
    (r#""bodies": [{"mass": 1, "restitution": 1.5}]"#, "bodies[0].restitution", "0 to 1"),
    (r#""bodies": [{"mass": 1, "material": "wood"}]"#, "bodies[0].material", "there are: none"),
    (r#""bodies": [{"mass": 1, "filter": {"mask": -1}}]"#, "bodies[0].filter.mask", "u32"),
    (r#""bodies": [{"mass": 1, "role": {"one_way": [0, 0]}}]"#, "bodies[0]", "length of one_way"),
    (
        r#""bodies": [{"shapes": [{"shape": {"circle": {"radius": 1}}, "restitution": 2}]}]"#,
        "bodies[0].shapes[0].restitution",
        "0 to 1",
    ),
    (
        r#""bodies": [{"shapes": [{"shape": {"circle": {"radius": 1}}, "role": "ghost"}]}]"#,
        "bodies[0].shapes[0].role",
        "expected one of `solid`",
    ),
    (
        r#""settings": {"mixing": {"table": [{"a": "ice", "b": "ice"}]}}"#,
        "settings.mixing.table[0].a",
        "there are: none",
    ),
    (
        r#""materials": {"ice": {}}, "settings": {"mixing": {"table": [{"a": "ice", "b": "ice", "restitution": 2}]}}"#,
        "settings.mixing",
        r#"restitution of "ice" and "ice" is 2"#,
    ),
    (r#""settings": {"mixing": {"friction": "mean"}}"#, "settings.mixing.friction", "`average`"),
    (r#""settings": {"impact_law": "hooke"}"#, "settings.impact_law", "`stronge`"),
    (r#""settings": {"solver": "guess"}"#, "settings.solver", "`newton`"),
    (
        r#""schedules": [{"body": 0, "times": [0, 1], "forces": [[1, 2]]}]"#,
        "schedules[0].body",
        "there is no body 0; there are 0",
    ),
    (
        r#""schedules": [{"body": "b", "times": [0, 1], "forces": [[1, 2]]}]"#,
        "schedules[0].body",
        r#"no body is called "b""#,
    ),
    (r#""schedules": [{"body": -1, "times": [0, 1]}]"#, "schedules[0].body", "counted from 0"),
    (
        r#""bodies": [{"mass": 1, "name": "a"}, {"mass": 1, "name": "a"}], "schedules": [{"body": "a", "times": [0, 1]}]"#,
        "schedules[0].body",
        "bodies 0 and 1",
    ),
    (
        r#""bodies": [{"mass": 1}], "schedules": [{"body": 0, "times": [0, 0]}]"#,
        "schedules[0]",
        "increasing times",
    ),
    (
        r#""bodies": [{"mass": 1}], "schedules": [{"body": 0, "times": [1]}]"#,
        "schedules[0]",
        "at least one force",
    ),
    (
        r#""bodies": [{"mass": 1}], "schedules": [{"body": 0, "times": [null, 1]}]"#,
        "schedules[0].times[0]",
        "last time",
    ),
    (
        r#""bodies": [{"mass": 1}], "schedules": [{"body": 0, "times": [0, 1], "forces": [[1, 2], [3, 4]]}]"#,
        "schedules[0].forces",
        "allowed: 1",
    ),
    (
        r#""bodies": [{"mass": 1}], "schedules": [{"body": 0, "times": [0, 1], "torques": [1, 2]}]"#,
        "schedules[0].torques",
        "allowed: 1",
    ),
    (r#""fields": [{"magnetic": {}}]"#, "fields[0]", "expected one of `central`"),
    (
        r#""fields": [{"attraction": {"strength": 1, "exponent": -2, "softening": -1}}]"#,
        "fields[0].attraction.softening",
        "0 or above",
    ),
    (
        r#""fields": [{"oscillating": {"body": 2, "hertz": 1}}]"#,
        "fields[0].oscillating.body",
        "no body 2",
    ),
    (
        r#""bodies": [{"mass": 1}], "fields": [{"oscillating": {"body": 0, "force": [1, 0], "hertz": -1}}]"#,
        "fields[0].oscillating.hertz",
        "0 or above",
    ),
];

fn refusal(json: &str) -> (String, String) {
    match SceneFile::from_json(json).and_then(|scene| scene.world().map(drop)) {
        Err(Error::SceneFile { path, message }) => (path, message),
        other => panic!("{json}: {other:?}"),
    }
}

#[test]
fn what_is_wrong_is_named_with_its_path() {
    for (rest, path, part) in BAD {
        let (got, message) = refusal(&format!(r#"{{"culbuto": 1, {rest}}}"#));
        assert_eq!(got, *path, "{rest}: {message}");
        assert!(message.contains(part), "{rest}: {message}");
    }
}

#[test]
fn a_file_of_another_kind_or_version_is_refused_as_a_whole() {
    for (json, path, part) in [
        ("{}", ".", r#"has "culbuto": 1"#),
        (r#"{"culbuto": 2, "fluids": []}"#, "culbuto", "version 2 is not known"),
        (r#"{"culbuto": "1"}"#, "culbuto", "is not known"),
        ("[1]", ".", "a JSON object"),
        ("", ".", "a JSON object"),
        (r#"{"culbuto": 1,"#, ".", "EOF"),
        (r#"{"culbuto": 1} {}"#, ".", "trailing"),
    ] {
        let (got, message) = refusal(json);
        assert_eq!(got, path, "{json}: {message}");
        assert!(message.contains(part), "{json}: {message}");
    }
    let scene = SceneFile { culbuto: 3, ..SceneFile::default() };
    assert!(scene.world().unwrap_err().to_string().contains("version 3"));
}

#[test]
fn a_file_that_is_not_there_is_an_error_with_its_name() {
    let error = SceneFile::read("no/such/scene.json").unwrap_err();
    assert!(matches!(&error, Error::Io { path, .. } if path == "no/such/scene.json"), "{error}");
    let error = SceneFile::default().write("no/such/scene.json").unwrap_err();
    assert!(matches!(&error, Error::Io { .. }), "{error}");
}

#[test]
fn a_world_that_a_file_cannot_hold_is_refused() {
    let world = || {
        let mut world = World::default();
        let body = world.add_body(BodyDef::point(1.0)).unwrap();
        (world, body)
    };
    let refused = |world: &World, path: &str, part: &str| match SceneFile::from_world(world) {
        Err(Error::SceneFile { path: got, message }) => {
            assert_eq!(got, path);
            assert!(message.contains(part), "{message}");
        }
        other => panic!("{other:?}"),
    };

    let (mut own, _) = world();
    let center = vec2(0.0, 0.0);
    own.add_field(Central { center, strength: 1.0, exponent: 1.0, per_mass: false });
    own.add_field(Righting { strength: 1.0 });
    refused(&own, "fields[1]", "\"righting\" is code of your own");

    let (mut applied, body) = world();
    applied.body_mut(body).unwrap().apply_torque(1.0).unwrap();
    refused(&applied, "bodies[0]", "next step only");
    applied.step(0.1).unwrap();
    SceneFile::from_world(&applied).unwrap();

    let (mut orphan, body) = world();
    let (force, phase) = (vec2(1.0, 0.0), 0.0);
    orphan.add_field(Oscillating { body, force, torque: 0.0, hertz: 1.0, phase });
    orphan.remove_body(body).unwrap();
    refused(&orphan, "fields[0]", "no longer in the world");
}
