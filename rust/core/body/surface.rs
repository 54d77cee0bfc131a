//! What a shape is like to touch: friction, restitution, and which shapes it touches at all.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result, check};
use crate::math::{Real, Vec2};

/// Coulomb's coefficients: a contact that sticks holds up to μs·N, one that slides rubs with μk·N.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Friction {
    /// μs.
    #[serde(rename = "static")]
    pub sticking: Real,
    /// μk, at most μs.
    #[serde(rename = "kinetic")]
    pub sliding: Real,
}

impl Friction {
    /// One coefficient for both.
    #[must_use]
    pub const fn of(coefficient: Real) -> Self {
        Self { sticking: coefficient, sliding: coefficient }
    }
}

/// How a shape touches others. What two shapes make of their values together, the world's rules say.
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
    /// Name of the material, for the world's table of pairs.
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
        let Friction { sticking, sliding } = self.friction;
        check::not_negative("static friction", sticking)?;
        check::not_negative("kinetic friction", sliding)?;
        if sliding > sticking {
            let allowed = format!("0 to the static friction, {sticking}");
            return Err(Error::invalid("kinetic friction", sliding, allowed));
        }
        if !(0.0..=1.0).contains(&self.restitution) {
            return Err(Error::invalid("restitution", self.restitution, "0 to 1"));
        }
        check::not_negative("rolling_resistance", self.rolling_resistance)?;
        check::finite("tangent_speed", self.tangent_speed).map(drop)
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
