//! Fields that come with the engine. They can stand in scene files; any other field is the user's code.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

use crate::body::BodyHandle;
use crate::error::{Error, Result, check};
use crate::forces::field::{BodyColumns, BoxError, FieldFacts, ForceField};
use crate::math::{Real, Vec2, Wrench, powf, sin_cos, vec2};

/// A pull of every body towards a point, F = −strength·r^exponent (times the body's mass if
/// `per_mass`): gravitation of a sun (exponent −2, per mass), a spring (1), a constant centripetal
/// force (0).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Central {
    /// The point (m).
    #[schemars(with = "[Real; 2]")]
    pub center: Vec2,
    /// N/m^exponent, or that per kg.
    pub strength: Real,
    /// Power of the distance.
    pub exponent: Real,
    /// The force is proportional to the mass it acts on.
    #[serde(default)]
    pub per_mass: bool,
}

/// A pull of all bodies on one another, F = −strength·m₁m₂·r/(r² + softening²)^((1 − exponent)/2):
/// gravitation for exponent −2.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Attraction {
    /// N/(kg²·m^exponent).
    pub strength: Real,
    /// Power of the distance.
    pub exponent: Real,
    /// Length (m) below which the pull no longer grows.
    #[serde(default)]
    pub softening: Real,
}

/// A force and a torque on one body that vary as sin(2π·hertz·t + phase).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Oscillating {
    /// The body; the field acts on nothing once it is removed.
    pub body: BodyHandle,
    /// Amplitude of the force through the centre of mass (N).
    pub force: Vec2,
    /// Amplitude of the torque (N·m).
    pub torque: Real,
    /// Frequency (Hz).
    pub hertz: Real,
    /// Phase at t = 0 (rad).
    pub phase: Real,
}

/// Any of the fields that come with the engine, as snapshots hold it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub enum BuiltInField {
    /// Pull towards a point.
    Central(Central),
    /// Pull of all bodies on one another.
    Attraction(Attraction),
    /// Sinusoidal force on one body.
    Oscillating(Oscillating),
}

impl BuiltInField {
    /// The field, its numbers checked.
    pub fn build(self) -> Result<Arc<dyn ForceField>> {
        Ok(match self {
            Self::Central(field) => Arc::new(field.checked()?),
            Self::Attraction(field) => Arc::new(field.checked()?),
            Self::Oscillating(field) => Arc::new(field.checked()?),
        })
    }
}

/// −∫ of r^exponent·direction: the potential of a unit pull at a distance r.
fn pull_potential(r: Real, exponent: Real) -> Real {
    if exponent == -1.0 { libm::log(r) } else { powf(r, exponent + 1.0) / (exponent + 1.0) }
}

impl Central {
    fn checked(self) -> Result<Self> {
        check::finite_vec("center", self.center)?;
        check::finite("strength", self.strength)?;
        check::finite("exponent", self.exponent)?;
        Ok(self)
    }

    fn factor(&self, mass: Real) -> Real {
        if self.per_mass { self.strength * mass } else { self.strength }
    }
}

impl ForceField for Central {
    fn name(&self) -> &'static str {
        "central"
    }

    fn add_forces(
        &self,
        _: Real,
        bodies: &BodyColumns<'_>,
        out: &mut [Wrench],
    ) -> std::result::Result<(), BoxError> {
        for ((pose, mass), wrench) in bodies.poses.iter().zip(bodies.masses).zip(out) {
            let arm = pose.position - self.center;
            let r = arm.norm();
            if r > 0.0 {
                wrench.force -= arm * (self.factor(mass.mass) * powf(r, self.exponent - 1.0));
            }
        }
        Ok(())
    }

    fn potential(
        &self,
        _: Real,
        bodies: &BodyColumns<'_>,
    ) -> std::result::Result<Option<Real>, BoxError> {
        let of_body = |(pose, mass): (&crate::math::Pose, &crate::body::Mass)| {
            let r = (pose.position - self.center).norm();
            self.factor(mass.mass) * pull_potential(r, self.exponent)
        };
        let free = bodies.poses.iter().zip(bodies.masses).filter(|(_, mass)| mass.is_free());
        Ok(Some(free.map(of_body).sum()))
    }

    fn facts(&self) -> FieldFacts {
        FieldFacts { velocity_dependent: false, conservative: true, internal: false }
    }

    fn built_in(&self) -> Option<BuiltInField> {
        Some(BuiltInField::Central(self.clone()))
    }
}

impl Attraction {
    fn checked(self) -> Result<Self> {
        check::finite("strength", self.strength)?;
        check::finite("exponent", self.exponent)?;
        check::not_negative("softening", self.softening)?;
        Ok(self)
    }

    /// Calls `visit` with both bodies' places, the vector between them and the softened distance.
    fn pairs(&self, bodies: &BodyColumns<'_>, mut visit: impl FnMut(usize, usize, Vec2, Real)) {
        for i in 0..bodies.poses.len() {
            for j in 0..i {
                let arm = bodies.poses[i].position - bodies.poses[j].position;
                let r = libm::sqrt(arm.norm_squared() + self.softening * self.softening);
                if r > 0.0 {
                    visit(i, j, arm, r);
                }
            }
        }
    }
}

impl ForceField for Attraction {
    fn name(&self) -> &'static str {
        "attraction"
    }

    fn add_forces(
        &self,
        _: Real,
        bodies: &BodyColumns<'_>,
        out: &mut [Wrench],
    ) -> std::result::Result<(), BoxError> {
        self.pairs(bodies, |i, j, arm, r| {
            let masses = bodies.masses[i].mass * bodies.masses[j].mass;
            let force = arm * (self.strength * masses * powf(r, self.exponent - 1.0));
            out[i].force -= force;
            out[j].force += force;
        });
        Ok(())
    }

    fn potential(
        &self,
        _: Real,
        bodies: &BodyColumns<'_>,
    ) -> std::result::Result<Option<Real>, BoxError> {
        let mut sum = 0.0;
        self.pairs(bodies, |i, j, _, r| {
            let masses = bodies.masses[i].mass * bodies.masses[j].mass;
            sum += self.strength * masses * pull_potential(r, self.exponent);
        });
        Ok(Some(sum))
    }

    fn facts(&self) -> FieldFacts {
        FieldFacts { velocity_dependent: false, conservative: true, internal: true }
    }

    fn built_in(&self) -> Option<BuiltInField> {
        Some(BuiltInField::Attraction(self.clone()))
    }
}

impl Oscillating {
    fn checked(self) -> Result<Self> {
        check::finite_vec("force", self.force)?;
        check::finite("torque", self.torque)?;
        check::not_negative("hertz", self.hertz)?;
        check::finite("phase", self.phase)?;
        if self.force == vec2(0.0, 0.0) && self.torque == 0.0 {
            return Err(Error::invalid("force and torque", 0, "at least one of them not 0"));
        }
        Ok(self)
    }
}

impl ForceField for Oscillating {
    fn name(&self) -> &'static str {
        "oscillating"
    }

    fn add_forces(
        &self,
        time: Real,
        bodies: &BodyColumns<'_>,
        out: &mut [Wrench],
    ) -> std::result::Result<(), BoxError> {
        if let Some(i) = bodies.index(self.body) {
            let (sin, _) = sin_cos(std::f64::consts::TAU * self.hertz * time + self.phase);
            out[i] += Wrench::new(self.force * sin, self.torque * sin);
        }
        Ok(())
    }

    fn facts(&self) -> FieldFacts {
        FieldFacts { velocity_dependent: false, conservative: false, internal: false }
    }

    fn built_in(&self) -> Option<BuiltInField> {
        Some(BuiltInField::Oscillating(self.clone()))
    }
}
