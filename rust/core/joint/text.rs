//! Anchors, springs and holds in two forms: short where people read them, tagged where only programs do.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::{Coefficients, Given, Hold, Spring};
use crate::math::{Real, Vec2};

/// Reads and writes `$type` as `$text` where people read, and as `$bytes`, its mirror, elsewhere.
macro_rules! two_forms {
    ($type:ident, $text:ty, $bytes:ty) => {
        impl Serialize for $type {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                if serializer.is_human_readable() {
                    <$text>::from(*self).serialize(serializer)
                } else {
                    <$bytes>::serialize(self, serializer)
                }
            }
        }

        impl<'de> Deserialize<'de> for $type {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                if deserializer.is_human_readable() {
                    <$text as Deserialize>::deserialize(deserializer).map(Self::from)
                } else {
                    <$bytes>::deserialize(deserializer)
                }
            }
        }

        impl JsonSchema for $type {
            fn schema_name() -> Cow<'static, str> {
                stringify!($type).into()
            }

            fn json_schema(generator: &mut SchemaGenerator) -> Schema {
                <$text>::json_schema(generator)
            }
        }
    };
}

two_forms!(Given, GivenText, GivenBytes);
two_forms!(Spring, SpringText, SpringBytes);
two_forms!(Hold, HoldText, HoldBytes);

/// A point or a direction: `[x, y]` in the body's frame, or in the world where the body stands when the joint is made.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(
    untagged,
    deny_unknown_fields,
    expecting = "two numbers, in the body's frame, or {\"world\": [x, y]}"
)]
enum GivenText {
    /// In the body's frame.
    Local(#[schemars(with = "[Real; 2]")] Vec2),
    /// In the world.
    World {
        /// Where the body stands when the joint is made.
        #[schemars(with = "[Real; 2]")]
        world: Vec2,
    },
}

impl From<Given> for GivenText {
    fn from(given: Given) -> Self {
        match given {
            Given::Local(vector) => Self::Local(vector),
            Given::World(world) => Self::World { world },
        }
    }
}

impl From<GivenText> for Given {
    fn from(given: GivenText) -> Self {
        match given {
            GivenText::Local(vector) => Self::Local(vector),
            GivenText::World { world } => Self::World(world),
        }
    }
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Given")]
enum GivenBytes {
    Local(Vec2),
    World(Vec2),
}

/// A spring with a damper, by its frequency and damping ratio or by its coefficients.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(
    untagged,
    deny_unknown_fields,
    expecting = "{\"hertz\": …, \"damping_ratio\": …} or {\"stiffness\": …, \"damping\": …}"
)]
enum SpringText {
    /// By what is to be seen.
    Frequency {
        /// Frequency of the undamped swing (Hz).
        hertz: Real,
        /// 0 swings for ever, 1 comes back without swinging.
        #[serde(default)]
        damping_ratio: Real,
    },
    /// By its coefficients.
    Constants(Coefficients),
}

impl From<Spring> for SpringText {
    fn from(spring: Spring) -> Self {
        match spring {
            Spring::Frequency { hertz, damping_ratio } => Self::Frequency { hertz, damping_ratio },
            Spring::Constants(coefficients) => Self::Constants(coefficients),
        }
    }
}

impl From<SpringText> for Spring {
    fn from(spring: SpringText) -> Self {
        match spring {
            SpringText::Frequency { hertz, damping_ratio } => {
                Self::Frequency { hertz, damping_ratio }
            }
            SpringText::Constants(coefficients) => Self::Constants(coefficients),
        }
    }
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Spring")]
enum SpringBytes {
    Frequency { hertz: Real, damping_ratio: Real },
    Constants(Coefficients),
}

/// How a coordinate is held.
#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(
    untagged,
    expecting = "\"rigid\", \"free\", or a spring: {\"hertz\": …, \"damping_ratio\": …} or {\"stiffness\": …, \"damping\": …}"
)]
enum HoldText {
    /// Exactly, or not at all.
    Word(Word),
    /// By a spring.
    Spring(Spring),
}

#[derive(Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
enum Word {
    /// Exactly.
    Rigid,
    /// Not at all.
    Free,
}

impl From<Hold> for HoldText {
    fn from(hold: Hold) -> Self {
        match hold {
            Hold::Rigid => Self::Word(Word::Rigid),
            Hold::Free => Self::Word(Word::Free),
            Hold::Spring(spring) => Self::Spring(spring),
        }
    }
}

impl From<HoldText> for Hold {
    fn from(hold: HoldText) -> Self {
        match hold {
            HoldText::Word(Word::Rigid) => Self::Rigid,
            HoldText::Word(Word::Free) => Self::Free,
            HoldText::Spring(spring) => Self::Spring(spring),
        }
    }
}

#[derive(Serialize, Deserialize)]
#[serde(remote = "Hold")]
enum HoldBytes {
    Rigid,
    Spring(Spring),
    Free,
}
