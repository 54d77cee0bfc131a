//! Scene files as text.

use schemars::Schema;
use serde::{Deserialize, Serialize};
use serde_json::{Map, Value};

use super::{
    SCENE_VERSION, SceneBody, SceneFile, SceneFluid, SceneJoint, SceneOscillating, SceneSettings,
    SceneSoft, wrong,
};
use crate::error::{Error, Result};

/// The schema, too, says which version there is.
pub fn known_version(schema: &mut Schema) {
    if let Some(version) = schema.pointer_mut("/properties/culbuto").and_then(Value::as_object_mut)
    {
        *version = Map::new();
        version.insert("description".into(), "Version of the format.".into());
        version.insert("const".into(), SCENE_VERSION.into());
    }
}

/// What a file of any version has.
#[derive(Deserialize)]
struct Head {
    culbuto: Option<Value>,
}

pub fn from_json(json: &str) -> Result<SceneFile> {
    let json = json.trim_start_matches('\u{feff}');
    if !json.trim_start().starts_with('{') {
        return Err(wrong(".", "a scene file is a JSON object: { … }"));
    }
    let head: Head = parse(json)?;
    match head.culbuto {
        Some(version) if version == SCENE_VERSION => parse(json),
        Some(version) => {
            Err(wrong("culbuto", format!("version {version} is not known; allowed: 1")))
        }
        None => Err(wrong(".", "no version; a scene file has \"culbuto\": 1")),
    }
}

fn parse<'de, T: Deserialize<'de>>(json: &'de str) -> Result<T> {
    let mut deserializer = serde_json::Deserializer::from_str(json);
    let value =
        serde_path_to_error::deserialize(&mut deserializer).map_err(|error| describe(&error))?;
    deserializer.end().map_err(|error| wrong(".", error))?;
    Ok(value)
}

/// Where a value is wrong, and how, in the words of scene files.
fn describe(error: &serde_path_to_error::Error<serde_json::Error>) -> Error {
    let path = error.path().to_string();
    let message = error.inner().to_string().replace("a matrix array", "two numbers");
    // "?" stands for a place that text which is no JSON does not have.
    wrong(if path.contains('?') { "." } else { &path }, message)
}

pub fn to_json(scene: &SceneFile) -> String {
    let mut file = object(scene);
    let always = ["culbuto", "gravity", "run"];
    let usual = object(&SceneFile::default());
    leave_out(&mut file, &usual, &always);
    leave_out_within(&mut file, &usual, &["air"]);
    if let Some(Value::Object(settings)) = file.get_mut("settings") {
        let usual = object(&SceneSettings::default());
        leave_out(settings, &usual, &[]);
        leave_out_within(settings, &usual, &["mixing"]);
        if let Some(Value::Object(mixing)) = settings.get_mut("mixing") {
            objects(mixing, "table").for_each(|pair| pair.retain(|_, value| !value.is_null()));
        }
    }
    let usual = object(&SceneBody::default());
    for body in objects(&mut file, "bodies") {
        leave_out(body, &usual, &[]);
        leave_out_within(body, &usual, &["locks", "filter"]);
        objects(body, "shapes").for_each(leave_out_of_shape);
    }
    let usual = object(&SceneSoft::default());
    for soft in objects(&mut file, "soft_bodies") {
        leave_out(soft, &usual, &[]);
        leave_out_within(soft, &usual, &["material", "surface", "filter", "state"]);
    }
    let usual = object(&SceneJoint::default());
    for joint in objects(&mut file, "joints") {
        leave_out(joint, &usual, &["bodies", "joint"]);
        leave_out_within(joint, &usual, &["state"]);
        leave_out_of_joint(joint);
    }
    let usual = object(&SceneFluid::default());
    for fluid in objects(&mut file, "fluids") {
        leave_out(fluid, &usual, &["spacing"]);
    }
    for schedule in objects(&mut file, "schedules") {
        schedule.retain(|_, value| *value != Value::Array(Vec::new()));
    }
    let usual = object(&SceneOscillating::default());
    for field in objects(&mut file, "fields") {
        if let Some(Value::Object(own)) = field.get_mut("oscillating") {
            leave_out(own, &usual, &["body", "hertz"]);
        }
    }
    let mut text = String::new();
    write(&Value::Object(file), 0, 0, &mut text);
    text.push('\n');
    text
}

/// What serde makes of a struct.
fn object(value: &impl Serialize) -> Map<String, Value> {
    // OK because all of these are structs whose keys are strings.
    match serde_json::to_value(value) {
        Ok(Value::Object(map)) => map,
        _ => Map::new(),
    }
}

/// The objects in a list of an object's.
fn objects<'a>(
    of: &'a mut Map<String, Value>,
    key: &str,
) -> impl Iterator<Item = &'a mut Map<String, Value>> {
    let list = of.get_mut(key).and_then(Value::as_array_mut).map_or(&mut [][..], Vec::as_mut_slice);
    list.iter_mut().filter_map(Value::as_object_mut)
}

/// Drops what is as usual. Text decides, which knows −0 from 0.
fn leave_out(map: &mut Map<String, Value>, usual: &Map<String, Value>, always: &[&str]) {
    map.retain(|key, value| {
        let same = usual.get(key).is_some_and(|usual| spaced(usual) == spaced(value));
        !same || always.contains(&key.as_str())
    });
}

/// Drops what is as usual in objects of an object's.
fn leave_out_within(map: &mut Map<String, Value>, usual: &Map<String, Value>, keys: &[&str]) {
    for key in keys {
        if let (Some(Value::Object(own)), Some(Value::Object(usual))) =
            (map.get_mut(*key), usual.get(*key))
        {
            leave_out(own, usual, &[]);
        }
    }
}

/// In a shape, no turn, no offset, no hole, no rounding and no flag are the defaults.
fn leave_out_of_shape(part: &mut Map<String, Value>) {
    if let Some(Value::Object(filter)) = part.get_mut("filter") {
        filter.retain(|_, value| !value.is_null());
    }
    let kinds = part.get_mut("shape").and_then(Value::as_object_mut);
    for shape in kinds.into_iter().flat_map(Map::values_mut).filter_map(Value::as_object_mut) {
        shape.retain(|key, value| {
            let usual = match key.as_str() {
                "center" => "[0.0, 0.0]",
                "angle" | "radius" => "0.0",
                "holes" => "[]",
                "closed" | "one_sided" => "false",
                _ => return true,
            };
            spaced(value) != usual
        });
    }
}

/// In what a joint does, what is not there and what is rigid are the defaults.
fn leave_out_of_joint(joint: &mut Map<String, Value>) {
    let kinds = joint.get_mut("joint").and_then(Value::as_object_mut);
    for kind in kinds.into_iter().flat_map(Map::values_mut).filter_map(Value::as_object_mut) {
        if let Some(Value::Object(travel)) = kind.get_mut("travel") {
            travel
                .retain(|key, value| !value.is_null() && (key != "rest" || spaced(value) != "0.0"));
        }
        kind.retain(|key, value| match key.as_str() {
            "hold" | "linear" | "angular" | "suspension" => value.as_str() != Some("rigid"),
            "slack" => *value != Value::Bool(false),
            "travel" => *value != Value::Object(Map::new()),
            "min_length" => spaced(value) != "0.0",
            _ => !value.is_null(),
        });
    }
}

/// What fits into a line stands in a line; all else is broken up.
fn write(value: &Value, indent: usize, column: usize, out: &mut String) {
    const WIDTH: usize = 100;
    let short = spaced(value);
    let fits = column + short.chars().count() < WIDTH;
    // Of the lists of objects that a scene is made of, each object begins a line.
    let is_part =
        indent == 1 && value.as_array().is_some_and(|list| list.iter().any(Value::is_object));
    if indent > 0 && fits && !is_part {
        out.push_str(&short);
        return;
    }
    let inner = "  ".repeat(indent + 1);
    let line = |lead: &str, value: &Value, last: bool, out: &mut String| {
        out.push_str(&inner);
        out.push_str(lead);
        write(value, indent + 1, inner.len() + lead.chars().count(), out);
        out.push_str(if last { "\n" } else { ",\n" });
    };
    match value {
        Value::Object(map) if !map.is_empty() => {
            out.push_str("{\n");
            for (i, (key, value)) in map.iter().enumerate() {
                let lead = format!("{}: ", Value::from(key.as_str()));
                line(&lead, value, i + 1 == map.len(), out);
            }
            out.push_str(&"  ".repeat(indent));
            out.push('}');
        }
        Value::Array(list) if !list.is_empty() => {
            out.push_str("[\n");
            for (i, value) in list.iter().enumerate() {
                line("", value, i + 1 == list.len(), out);
            }
            out.push_str(&"  ".repeat(indent));
            out.push(']');
        }
        _ => out.push_str(&short),
    }
}

/// A value in one line, with a space after commas and colons.
fn spaced(value: &Value) -> String {
    match value {
        Value::Array(list) => {
            let parts: Vec<_> = list.iter().map(spaced).collect();
            format!("[{}]", parts.join(", "))
        }
        Value::Object(map) => {
            let pair = |(key, value): (&String, &Value)| {
                format!("{}: {}", Value::from(key.as_str()), spaced(value))
            };
            let parts: Vec<_> = map.iter().map(pair).collect();
            format!("{{{}}}", parts.join(", "))
        }
        _ => value.to_string(),
    }
}
