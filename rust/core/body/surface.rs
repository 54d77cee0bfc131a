//! What a shape is like to touch: friction, restitution, and which shapes it touches at all.
//!
//! A body has a [`Surface`], a [`Filter`] and a [`Role`]; each of its shapes may have values of its own
//! instead ([`SurfaceOverride`], [`FilterOverride`]), one by one, as it may have a density.

use std::borrow::Cow;
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::value::MapAccessDeserializer;
use serde::de::{MapAccess, Visitor};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use crate::error::{Error, Result, check};
use crate::math::{Real, Vec2};

/// Coulomb's coefficients: a contact that sticks holds up to μs·N, one that slides rubs with μk·N.
///
/// In a text format it is one number for both, or `{"static": μs, "kinetic": μk}`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Friction {
    /// μs.
    pub sticking: Real,
    /// μk, at most μs.
    pub sliding: Real,
}

impl Friction {
    /// One coefficient for both.
    #[must_use]
    pub const fn of(coefficient: Real) -> Self {
        Self { sticking: coefficient, sliding: coefficient }
    }

    /// Whether one number says it, to the bit.
    #[must_use]
    pub fn is_one_number(&self) -> bool {
        self.sticking.to_bits() == self.sliding.to_bits()
    }

    /// Both numbers checked.
    pub(crate) fn validated(&self) -> Result<()> {
        let Self { sticking, sliding } = *self;
        let names = ["static friction", "kinetic friction"];
        let [first, second] = if self.is_one_number() { ["friction"; 2] } else { names };
        check::not_negative(first, sticking)?;
        check::not_negative(second, sliding)?;
        if sliding > sticking {
            let allowed = format!("0 to the static friction, {sticking}");
            return Err(Error::invalid(second, sliding, allowed));
        }
        Ok(())
    }
}

/// Friction as an object of a text format.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct TwoCoefficients {
    #[serde(rename = "static")]
    sticking: Real,
    #[serde(rename = "kinetic")]
    sliding: Real,
}

impl Serialize for Friction {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        let Self { sticking, sliding } = *self;
        if !serializer.is_human_readable() {
            (sticking, sliding).serialize(serializer)
        } else if self.is_one_number() {
            sticking.serialize(serializer)
        } else {
            TwoCoefficients { sticking, sliding }.serialize(serializer)
        }
    }
}

impl<'de> Deserialize<'de> for Friction {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        if deserializer.is_human_readable() {
            return deserializer.deserialize_any(FrictionVisitor);
        }
        let (sticking, sliding) = Deserialize::deserialize(deserializer)?;
        Ok(Self { sticking, sliding })
    }
}

struct FrictionVisitor;

impl<'de> Visitor<'de> for FrictionVisitor {
    type Value = Friction;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a number, or {\"static\": …, \"kinetic\": …}")
    }

    fn visit_f64<E>(self, x: f64) -> std::result::Result<Friction, E> {
        Ok(Friction::of(x))
    }

    fn visit_i64<E>(self, x: i64) -> std::result::Result<Friction, E> {
        Ok(Friction::of(x as Real))
    }

    fn visit_u64<E>(self, x: u64) -> std::result::Result<Friction, E> {
        Ok(Friction::of(x as Real))
    }

    fn visit_map<M: MapAccess<'de>>(self, map: M) -> std::result::Result<Friction, M::Error> {
        let TwoCoefficients { sticking, sliding } =
            TwoCoefficients::deserialize(MapAccessDeserializer::new(map))?;
        Ok(Friction { sticking, sliding })
    }
}

impl JsonSchema for Friction {
    fn schema_name() -> Cow<'static, str> {
        "Friction".into()
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        let number =
            |what: &str| json_schema!({"description": what, "type": "number", "minimum": 0});
        json_schema!({
            "description": "Coulomb's coefficients: one number for both, or each.",
            "anyOf": [
                number("Static and kinetic friction."),
                {
                    "type": "object",
                    "properties": {
                        "static": number("A contact that sticks holds up to this times the normal force."),
                        "kinetic": number("A contact that slides rubs with this times the normal force; at most `static`.")
                    },
                    "required": ["static", "kinetic"],
                    "additionalProperties": false
                }
            ]
        })
    }
}

/// How a shape touches others. What two shapes make of their values together, the world's
/// [`crate::body::Mixing`] says.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Surface {
    /// Static and kinetic friction.
    pub friction: Friction,
    /// Speed after over speed before a collision, 0 to 1.
    pub restitution: Real,
    /// Arm (m) by which the normal force opposes rolling: τ ≤ arm·N.
    pub rolling_resistance: Real,
    /// Speed (m/s) at which the surface runs along its border, counter-clockwise, as a conveyor's belt.
    pub tangent_speed: Real,
    /// What it is made of: a name, for the world's table of pairs.
    pub material: Option<String>,
}

impl Default for Surface {
    fn default() -> Self {
        Self {
            friction: Friction::of(0.5),
            restitution: 0.0,
            rolling_resistance: 0.0,
            tangent_speed: 0.0,
            material: None,
        }
    }
}

impl Surface {
    /// Every number checked; errors name the field.
    pub(crate) fn validated(&self) -> Result<()> {
        self.friction.validated()?;
        restitution(self.restitution)?;
        check::not_negative("rolling_resistance", self.rolling_resistance)?;
        check::finite("tangent_speed", self.tangent_speed).map(drop)
    }
}

/// A coefficient of restitution, checked.
pub(super) fn restitution(e: Real) -> Result<()> {
    let allowed = (0.0..=1.0).contains(&e);
    if allowed { Ok(()) } else { Err(Error::invalid("restitution", e, "0 to 1")) }
}

/// What of a [`Surface`] a shape has of its own; none: the body's.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct SurfaceOverride {
    /// Static and kinetic friction.
    pub friction: Option<Friction>,
    /// Speed after over speed before a collision, 0 to 1.
    pub restitution: Option<Real>,
    /// Arm (m) by which the normal force opposes rolling.
    pub rolling_resistance: Option<Real>,
    /// Speed (m/s) of the surface along its border, counter-clockwise.
    pub tangent_speed: Option<Real>,
    /// Name of the material.
    pub material: Option<String>,
}

impl SurfaceOverride {
    /// The surface of a shape that has this of its own, on a body with that surface.
    #[must_use]
    pub fn over(&self, body: &Surface) -> Surface {
        Surface {
            friction: self.friction.unwrap_or(body.friction),
            restitution: self.restitution.unwrap_or(body.restitution),
            rolling_resistance: self.rolling_resistance.unwrap_or(body.rolling_resistance),
            tangent_speed: self.tangent_speed.unwrap_or(body.tangent_speed),
            material: self.material.clone().or_else(|| body.material.clone()),
        }
    }

    /// Every number that is there checked; errors name the field.
    ///
    /// # Errors
    /// [`Error::Invalid`] for what no [`Surface`] may have.
    pub fn validated(&self) -> Result<()> {
        self.over(&Surface::default()).validated()
    }
}

/// Which shapes a shape can touch. Two shapes of one group (not 0) always touch if it is above 0 and
/// never if it is below; otherwise each one's category must be in the other's mask.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Filter {
    /// Bits of the categories the shape belongs to.
    pub category: u32,
    /// Bits of the categories it touches.
    pub mask: u32,
    /// Group; 0: none.
    pub group: i32,
}

impl Default for Filter {
    fn default() -> Self {
        Self { category: 1, mask: u32::MAX, group: 0 }
    }
}

impl Filter {
    /// Whether two shapes can touch.
    #[must_use]
    pub fn allows(&self, other: &Self) -> bool {
        if self.group != 0 && self.group == other.group {
            return self.group > 0;
        }
        self.category & other.mask != 0 && other.category & self.mask != 0
    }
}

/// What of a [`Filter`] a shape has of its own; none: the body's.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct FilterOverride {
    /// Bits of the categories the shape belongs to.
    pub category: Option<u32>,
    /// Bits of the categories it touches.
    pub mask: Option<u32>,
    /// Group; 0: none.
    pub group: Option<i32>,
}

impl FilterOverride {
    /// The filter of a shape that has this of its own, on a body with that filter.
    #[must_use]
    pub fn over(&self, body: &Filter) -> Filter {
        Filter {
            category: self.category.unwrap_or(body.category),
            mask: self.mask.unwrap_or(body.mask),
            group: self.group.unwrap_or(body.group),
        }
    }
}

/// What a shape is there for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// It touches other shapes.
    #[default]
    Solid,
    /// It only notices what overlaps it, and is touched by nothing.
    Sensor,
    /// A platform: it stops only what comes from the side that this vector, in the body's frame, points to.
    OneWay(#[schemars(with = "[Real; 2]")] Vec2),
}

impl Role {
    /// Its vector checked.
    ///
    /// # Errors
    /// [`Error::Invalid`] for a vector that points nowhere.
    pub fn validated(&self) -> Result<()> {
        let Self::OneWay(side) = *self else { return Ok(()) };
        check::finite_vec("one_way", side)?;
        check::positive("length of one_way", side.norm()).map(drop)
    }
}
