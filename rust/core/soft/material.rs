//! What a deformable body is made of.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{Error, Result, check};
use crate::math::{PI, Real};

/// What is zero across the plane.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Plane {
    /// The stress: a thin sheet, which becomes thinner where it is drawn out.
    #[default]
    Stress,
    /// The strain: a slice of something long, which cannot become thinner.
    Strain,
}

/// An elastic material. Bodies are of unit thickness, so that forces are those on a slice of a metre.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Material {
    /// Mass per area (kg/m²); of ropes per length (kg/m).
    pub density: Real,
    /// Young's modulus E (Pa).
    pub youngs_modulus: Real,
    /// Poisson's ratio ν, above −1 and below 0.5 (0.5 itself in plane stress).
    pub poissons_ratio: Real,
    /// Part ζ of critical damping at the frequency below. The stress grows with the rate of strain (Kelvin and Voigt), so that
    /// other frequencies are damped in proportion to theirs, and rigid motion is not damped.
    pub damping_ratio: Real,
    /// The frequency that ζ is given at (Hz).
    pub damping_frequency: Real,
    /// Plane stress or plane strain.
    pub plane: Plane,
    /// Difference of the principal strains (logarithmic) beyond which it stays deformed; none: never.
    pub yield_strain: Option<Real>,
}

impl Default for Material {
    fn default() -> Self {
        Self {
            density: 1000.0,
            youngs_modulus: 1e6,
            poissons_ratio: 0.3,
            damping_ratio: 0.0,
            damping_frequency: 1.0,
            plane: Plane::Stress,
            yield_strain: None,
        }
    }
}

/// What elements need of a material.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Moduli {
    /// Shear modulus μ (Pa).
    pub shear: Real,
    /// λ + μ, the modulus of area (Pa).
    pub area: Real,
    /// Viscosity over stiffness β (s).
    pub viscosity: Real,
}

impl Material {
    /// The material, if it is one.
    ///
    /// # Errors
    /// Numbers that are not finite or out of range.
    pub fn validated(&self) -> Result<()> {
        check::positive("density", self.density)?;
        check::positive("youngs_modulus", self.youngs_modulus)?;
        check::not_negative("damping_ratio", self.damping_ratio)?;
        check::positive("damping_frequency", self.damping_frequency)?;
        if let Some(strain) = self.yield_strain {
            check::positive("yield_strain", strain)?;
        }
        let nu = self.poissons_ratio;
        let most = self.plane == Plane::Stress && nu == 0.5;
        if !(nu > -1.0 && (nu < 0.5 || most)) {
            let allowed = "above -1 and below 0.5 (0.5 itself in plane stress)";
            return Err(Error::invalid("poissons_ratio", nu, allowed));
        }
        let Moduli { shear, area, viscosity } = self.moduli();
        for x in [shear, area, viscosity * shear] {
            check::finite("a modulus of the material", x)?;
        }
        Ok(())
    }

    /// μ = E/2(1 + ν); λ + μ = E/2(1 − ν) in plane stress, E/2(1 + ν)(1 − 2ν) in plane strain; β = ζ/πf.
    #[must_use]
    pub fn moduli(&self) -> Moduli {
        let (e, nu) = (self.youngs_modulus, self.poissons_ratio);
        let area = match self.plane {
            Plane::Stress => e / (2.0 * (1.0 - nu)),
            Plane::Strain => e / (2.0 * (1.0 + nu) * (1.0 - 2.0 * nu)),
        };
        Moduli {
            shear: e / (2.0 * (1.0 + nu)),
            area,
            viscosity: self.damping_ratio / (PI * self.damping_frequency),
        }
    }
}
