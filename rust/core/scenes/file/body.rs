//! Bodies of a scene file: a [`BodyDef`] whose surface stands among its other keys, whose shapes may name
//! a material, and that may be placed by its centre of mass.

use std::borrow::Cow;
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::{MapAccessDeserializer, StringDeserializer};
use serde::de::{DeserializeSeed, Error as _, MapAccess, Visitor};
use serde::ser::Error as _;
use serde::{Deserialize, Deserializer, Serialize, Serializer};
use serde_json::Value;

use super::Material;
use crate::body::{BodyDef, FilterOverride, Friction, Part, Role, SurfaceOverride};
use crate::math::{Real, Vec2};
use crate::shapes::Shape;

/// A body. In the file it is one object: all that a [`BodyDef`] and its surface have, but for the shapes,
/// which are [`ScenePart`]s, and with `center_at`.
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
    /// What it is made of: a name from `materials`; none: what the body is made of.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub material: Option<String>,
    /// Density (kg/m², or kg/m of a wire); none: that of the material, else that of the body.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub density: Option<Real>,
    /// Static and kinetic friction; none: that of the material, else that of the body.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub friction: Option<Friction>,
    /// Speed after over speed before a collision, 0 to 1; none: likewise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub restitution: Option<Real>,
    /// Arm (m) by which the normal force opposes rolling; none: likewise.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rolling_resistance: Option<Real>,
    /// Speed (m/s) of the surface along its border, counter-clockwise; none: that of the body.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub tangent_speed: Option<Real>,
    /// What it can touch; what is not there: the body's.
    #[serde(default, skip_serializing_if = "is_default")]
    pub filter: FilterOverride,
    /// What it is there for; none: as the body.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub role: Option<Role>,
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

impl From<Part> for ScenePart {
    fn from(Part { shape, density, surface, filter, role }: Part) -> Self {
        let SurfaceOverride { friction, restitution, rolling_resistance, tangent_speed, material } =
            surface;
        Self {
            shape,
            material,
            density,
            friction,
            restitution,
            rolling_resistance,
            tangent_speed,
            filter,
            role,
        }
    }
}

impl ScenePart {
    /// The part of a body, with the values of a material where it has none of its own.
    pub(super) fn part(&self, material: Option<&Material>) -> Part {
        let of = |own: Option<Real>, value: fn(&Material) -> Option<Real>| {
            own.or_else(|| material.and_then(value))
        };
        let friction = self.friction.or_else(|| material.and_then(|material| material.friction));
        Part {
            shape: self.shape.clone(),
            density: of(self.density, |material| material.density),
            surface: SurfaceOverride {
                friction,
                restitution: of(self.restitution, |material| material.restitution),
                rolling_resistance: of(self.rolling_resistance, |m| m.rolling_resistance),
                tangent_speed: self.tangent_speed,
                material: self.material.clone(),
            },
            filter: self.filter,
            role: self.role,
        }
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
const SURFACE: &str = "surface";

impl Serialize for SceneBody {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        let value = |result: serde_json::Result<Value>| result.map_err(S::Error::custom);
        let mut body = value(serde_json::to_value(&self.def))?;
        if let Value::Object(body) = &mut body {
            body[SHAPES] = value(serde_json::to_value(&self.shapes))?;
            let place = body.keys().position(|key| key == SURFACE).unwrap_or(0);
            if let Some(Value::Object(surface)) = body.shift_remove(SURFACE) {
                for (i, (key, value)) in surface.into_iter().enumerate() {
                    body.shift_insert(place + i, key, value);
                }
            }
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
        let mut entries = DefEntries {
            map,
            shapes: None,
            center_at: None,
            surface: SurfaceOverride::default(),
            placed: false,
        };
        let mut def = BodyDef::deserialize(MapAccessDeserializer::new(&mut entries))?;
        let DefEntries { shapes, center_at, surface, placed, .. } = entries;
        if placed && center_at.is_some() {
            return Err(M::Error::custom("give `position` or `center_at`, not both"));
        }
        def.surface = surface.over(&def.surface);
        Ok(SceneBody { def, shapes: shapes.unwrap_or_default(), center_at })
    }
}

/// The entries of a body as [`BodyDef`] knows them; those that are the file's own are kept back.
struct DefEntries<M> {
    map: M,
    shapes: Option<Vec<ScenePart>>,
    center_at: Option<Vec2>,
    surface: SurfaceOverride,
    placed: bool,
}

impl<'de, M: MapAccess<'de>> DefEntries<M> {
    /// Keeps the value of a key back, if the key is the file's own.
    fn keep(&mut self, key: &str) -> Result<bool, M::Error> {
        let Self { map, shapes, center_at, surface, .. } = self;
        match key {
            SHAPES => *shapes = Some(once(map, SHAPES, shapes.is_some())?),
            CENTER_AT => *center_at = once(map, CENTER_AT, center_at.is_some())?,
            "friction" => {
                surface.friction = Some(once(map, "friction", surface.friction.is_some())?);
            }
            "restitution" => {
                surface.restitution =
                    Some(once(map, "restitution", surface.restitution.is_some())?);
            }
            "rolling_resistance" => {
                let twice = surface.rolling_resistance.is_some();
                surface.rolling_resistance = Some(once(map, "rolling_resistance", twice)?);
            }
            "tangent_speed" => {
                let twice = surface.tangent_speed.is_some();
                surface.tangent_speed = Some(once(map, "tangent_speed", twice)?);
            }
            "material" => surface.material = once(map, "material", surface.material.is_some())?,
            // Its values are keys of the body itself.
            SURFACE => return Err(M::Error::custom("unknown field `surface`")),
            _ => return Ok(false),
        }
        Ok(true)
    }
}

/// The next value of a map, unless its key was there before.
fn once<'de, M: MapAccess<'de>, T: Deserialize<'de>>(
    map: &mut M,
    key: &'static str,
    twice: bool,
) -> Result<T, M::Error> {
    if twice { Err(M::Error::duplicate_field(key)) } else { map.next_value() }
}

impl<'de, M: MapAccess<'de>> MapAccess<'de> for &mut DefEntries<M> {
    type Error = M::Error;

    fn next_key_seed<K: DeserializeSeed<'de>>(
        &mut self,
        seed: K,
    ) -> Result<Option<K::Value>, M::Error> {
        while let Some(key) = self.map.next_key::<String>()? {
            if !self.keep(&key)? {
                self.placed |= key == "position";
                return seed.deserialize(StringDeserializer::new(key)).map(Some);
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
