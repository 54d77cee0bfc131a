//! Bodies of a scene file: a [`BodyDef`] whose shapes may name a material, and that may be placed by
//! its centre of mass.

use std::borrow::Cow;
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::{MapAccessDeserializer, StringDeserializer};
use serde::de::{DeserializeSeed, Error as _, MapAccess, Visitor};
use serde::ser::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::Value;

use crate::body::{BodyDef, Part};
use crate::math::{Real, Vec2};
use crate::shapes::Shape;

/// A body. In the file it is one object: all that a [`BodyDef`] has, but for the shapes, which are
/// [`ScenePart`]s, and with `center_at`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct SceneBody {
    /// Everything but the shapes; its own list of shapes is not looked at.
    pub def: BodyDef,
    /// The shapes.
    pub shapes: Vec<ScenePart>,
    /// Where the centre of mass is (m), instead of `position`.
    pub center_at: Option<Vec2>,
}

/// One shape of a body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ScenePart {
    /// The shape, in the body's frame.
    pub shape: Shape,
    /// What it is made of: a name from `materials`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub material: Option<String>,
    /// Density (kg/m², or kg/m of a wire); none: that of the material, else that of the body.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density: Option<Real>,
}

impl From<Part> for ScenePart {
    fn from(Part { shape, density, .. }: Part) -> Self {
        Self { shape, material: None, density }
    }
}

impl From<BodyDef> for SceneBody {
    fn from(mut def: BodyDef) -> Self {
        let shapes = std::mem::take(&mut def.shapes);
        Self { def, shapes: shapes.into_iter().map(ScenePart::from).collect(), center_at: None }
    }
}

const SHAPES: &str = "shapes";
const CENTER_AT: &str = "center_at";

impl Serialize for SceneBody {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let value = |result: serde_json::Result<Value>| result.map_err(S::Error::custom);
        let mut body = value(serde_json::to_value(&self.def))?;
        if let Value::Object(body) = &mut body {
            body[SHAPES] = value(serde_json::to_value(&self.shapes))?;
            if let Some(center) = self.center_at {
                let place = body.keys().position(|key| key == "position").unwrap_or(0);
                body.shift_remove("position");
                let center = value(serde_json::to_value(center))?;
                body.shift_insert(place, CENTER_AT.into(), center);
            }
        }
        body.serialize(serializer)
    }
}

impl<'de> Deserialize<'de> for SceneBody {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        deserializer.deserialize_map(BodyVisitor)
    }
}

struct BodyVisitor;

impl<'de> Visitor<'de> for BodyVisitor {
    type Value = SceneBody;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a body: an object")
    }

    fn visit_map<M: MapAccess<'de>>(self, map: M) -> Result<SceneBody, M::Error> {
        let mut entries = DefEntries { map, shapes: None, center_at: None, placed: false };
        let def = BodyDef::deserialize(MapAccessDeserializer::new(&mut entries))?;
        let DefEntries { shapes, center_at, placed, .. } = entries;
        if placed && center_at.is_some() {
            return Err(M::Error::custom("give `position` or `center_at`, not both"));
        }
        Ok(SceneBody { def, shapes: shapes.unwrap_or_default(), center_at })
    }
}

/// The entries of a body as [`BodyDef`] knows them; those that are the file's own are kept back.
struct DefEntries<M> {
    map: M,
    shapes: Option<Vec<ScenePart>>,
    center_at: Option<Vec2>,
    placed: bool,
}

impl<'de, M: MapAccess<'de>> MapAccess<'de> for &mut DefEntries<M> {
    type Error = M::Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(
        &mut self,
        seed: K,
    ) -> Result<Option<K::Value>, M::Error> {
        while let Some(key) = self.map.next_key::<String>()? {
            match key.as_str() {
                SHAPES if self.shapes.is_some() => return Err(M::Error::duplicate_field(SHAPES)),
                SHAPES => self.shapes = Some(self.map.next_value()?),
                CENTER_AT if self.center_at.is_some() => {
                    return Err(M::Error::duplicate_field(CENTER_AT));
                }
                CENTER_AT => self.center_at = self.map.next_value()?,
                _ => {
                    self.placed |= key == "position";
                    return seed.deserialize(StringDeserializer::new(key)).map(Some);
                }
            }
        }
        Ok(None)
    }

    fn next_value_seed<V: DeserializeSeed<'de>>(&mut self, seed: V) -> Result<V::Value, M::Error> {
        self.map.next_value_seed(seed)
    }
}

impl JsonSchema for SceneBody {
    fn schema_name() -> Cow<'static, str> {
        "SceneBody".into()
    }

    fn json_schema(generator: &mut SchemaGenerator) -> Schema {
        let mut schema = BodyDef::json_schema(generator);
        let part = generator.subschema_for::<ScenePart>();
        let point = generator.subschema_for::<[Real; 2]>();
        schema.insert("description".into(), "A body.".into());
        if let Some(Value::Object(properties)) = schema.get_mut("properties") {
            properties.insert(
                SHAPES.into(),
                json_schema!({
                    "description": "The shapes. None: a point.",
                    "type": "array", "items": part, "default": []
                })
                .to_value(),
            );
            let mut center = point;
            let what = "Where the centre of mass is (m), instead of `position`.";
            center.insert("description".into(), what.into());
            properties.insert(CENTER_AT.into(), center.to_value());
        }
        schema.insert("not".into(), serde_json::json!({"required": ["position", CENTER_AT]}));
        schema
    }
}
