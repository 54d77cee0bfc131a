//! What two surfaces make of their coefficients together.
//!
//! No physics derives the friction of a pair from numbers of each side: it is measured pair by pair. The
//! rules are conventions, good enough where no table says better.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::body::surface::{self, Friction, Surface};
use crate::error::{Error, Result};
use crate::math::{Real, hypot};

/// How two coefficients a, b ≥ 0 become one. All rules are symmetric and grow with a and b.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Rule {
    /// √(ab): between the two, and 0 where one is.
    #[default]
    GeometricMean,
    /// √(a² + b²): never below the larger.
    Hypotenuse,
    /// ab: never above either where both are at most 1.
    Product,
    /// The smaller.
    Minimum,
    /// The larger.
    Maximum,
    /// (a + b)/2.
    Average,
}

impl Rule {
    /// All rules, with their names in scene files.
    pub const ALL: [(&'static str, Self); 6] = [
        ("geometric_mean", Self::GeometricMean),
        ("hypotenuse", Self::Hypotenuse),
        ("product", Self::Product),
        ("minimum", Self::Minimum),
        ("maximum", Self::Maximum),
        ("average", Self::Average),
    ];

    /// The coefficient of a pair. Of finite numbers it is a finite one: what would be larger than the
    /// largest number is that.
    #[must_use]
    pub fn apply(self, a: Real, b: Real) -> Real {
        let (low, high) = (a.min(b), a.max(b));
        match self {
            // Between the two to the last bit, so that two like surfaces keep their number.
            Self::GeometricMean => (a.sqrt() * b.sqrt()).clamp(low, high),
            Self::Average => (0.5 * (a + b)).clamp(low, high),
            Self::Hypotenuse => hypot(a, b).clamp(high, Real::MAX),
            Self::Product => (a * b).min(Real::MAX),
            Self::Minimum => low,
            Self::Maximum => high,
        }
    }
}

/// How the surfaces of a pair become the pair's.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Mixing {
    /// Of friction, static and kinetic alike.
    pub friction: Rule,
    /// Of restitution; what comes out above 1 is 1.
    pub restitution: Rule,
    /// Pairs of materials that the rules are not asked for.
    pub table: Vec<PairOfMaterials>,
}

impl Default for Mixing {
    fn default() -> Self {
        Self { friction: Rule::GeometricMean, restitution: Rule::Maximum, table: Vec::new() }
    }
}

/// What is known of two materials together. Their order does not matter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PairOfMaterials {
    /// Name of the one.
    pub a: String,
    /// Name of the other; may be the same.
    pub b: String,
    /// Friction of the pair; none: by the rule.
    #[serde(default)]
    pub friction: Option<Friction>,
    /// Restitution of the pair; none: by the rule.
    #[serde(default)]
    pub restitution: Option<Real>,
}

impl PairOfMaterials {
    /// Whether it is about these two.
    #[must_use]
    pub fn is_of(&self, a: &str, b: &str) -> bool {
        (self.a == a && self.b == b) || (self.a == b && self.b == a)
    }

    fn validated(&self) -> Result<()> {
        self.friction.map_or(Ok(()), |friction| friction.validated())?;
        self.restitution.map_or(Ok(()), surface::restitution)
    }
}

/// How two surfaces, A's and B's, touch one another.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PairSurface {
    /// Static and kinetic friction.
    pub friction: Friction,
    /// Speed after over speed before, 0 to 1.
    pub restitution: Real,
    /// Arm (m) by which the normal force opposes rolling: the larger of the two, since the softer body
    /// is the one that is deformed.
    pub rolling_resistance: Real,
    /// Speeds (m/s) at which the surfaces of A and B run along their borders, counter-clockwise. With n the
    /// normal from A to B and t = n turned by a quarter turn counter-clockwise, A's surface moves at s_A·t
    /// and B's at −s_B·t against its body, so B's slips over A's at −(s_A + s_B)·t beyond what the bodies do.
    pub tangent_speeds: [Real; 2],
}

impl Mixing {
    /// What two surfaces make together. Symmetric, but for the order of the tangent speeds.
    #[must_use]
    pub fn mix(&self, a: &Surface, b: &Surface) -> PairSurface {
        let known = self.pair(a, b);
        let by_rule = || Friction {
            sticking: self.friction.apply(a.friction.sticking, b.friction.sticking),
            sliding: self.friction.apply(a.friction.sliding, b.friction.sliding),
        };
        let restitution = || self.restitution.apply(a.restitution, b.restitution).min(1.0);
        PairSurface {
            friction: known.and_then(|pair| pair.friction).unwrap_or_else(by_rule),
            restitution: known.and_then(|pair| pair.restitution).unwrap_or_else(restitution),
            rolling_resistance: a.rolling_resistance.max(b.rolling_resistance),
            tangent_speeds: [a.tangent_speed, b.tangent_speed],
        }
    }

    /// What the table knows of two surfaces.
    fn pair(&self, a: &Surface, b: &Surface) -> Option<&PairOfMaterials> {
        if self.table.is_empty() {
            return None;
        }
        let (a, b) = (a.material.as_deref()?, b.material.as_deref()?);
        self.table.iter().find(|pair| pair.is_of(a, b))
    }

    /// Puts a pair into the table, in the place of what it knew of these materials. A pair of which
    /// nothing is given leaves the table.
    pub fn set_pair(&mut self, pair: PairOfMaterials) {
        let nothing = pair.friction.is_none() && pair.restitution.is_none();
        match self.table.iter().position(|old| old.is_of(&pair.a, &pair.b)) {
            Some(i) if nothing => drop(self.table.remove(i)),
            Some(i) => self.table[i] = pair,
            None if nothing => {}
            None => self.table.push(pair),
        }
    }

    /// Every number checked, and that no pair stands twice.
    ///
    /// # Errors
    /// [`Error::Invalid`] names the pair.
    pub fn validated(&self) -> Result<()> {
        for (i, pair) in self.table.iter().enumerate() {
            let named = |what: &str| format!("{what} of {:?} and {:?}", pair.a, pair.b);
            pair.validated().map_err(|error| match error {
                Error::Invalid { what, got, allowed } => Error::invalid(named(&what), got, allowed),
                other => other,
            })?;
            if self.table[..i].iter().any(|other| other.is_of(&pair.a, &pair.b)) {
                return Err(Error::invalid(named("the pair"), "given twice", "once"));
            }
        }
        Ok(())
    }
}

/// What the coefficient of restitution e is a ratio of. The three agree without friction, and with it
/// where the sliding neither stops nor turns round during the collision.
///
/// Stronge, "Rigid body collisions with friction", Proc. R. Soc. Lond. A 431 (1990).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum ImpactLaw {
    /// Of normal velocities: after = −e·before. With friction it may gain energy.
    #[default]
    Newton,
    /// Of normal impulses: restitution's is e times compression's.
    Poisson,
    /// Of works of the normal force: restitution gives e² of compression's back. Never gains energy.
    Stronge,
}

impl ImpactLaw {
    /// All laws, with their names in scene files.
    pub const ALL: [(&'static str, Self); 3] =
        [("newton", Self::Newton), ("poisson", Self::Poisson), ("stronge", Self::Stronge)];
}
