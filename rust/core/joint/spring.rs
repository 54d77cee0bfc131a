//! How firmly a joint holds.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use crate::error::{Result, check};
use crate::math::{PI, Real};

/// A spring with a damper: a force −kC − cĊ along a coordinate C. In readable text it is one object with the keys
/// `hertz` and `damping_ratio`, or `stiffness` and `damping`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Spring {
    /// By what is to be seen. With m_eff = 1/(J M⁻¹ Jᵀ) where the joint is made and ω = 2π·hertz:
    /// k = m_eff ω², c = 2 m_eff ζ ω (E. Catto, "Soft constraints", GDC 2011).
    Frequency {
        /// Frequency of the undamped swing (Hz).
        hertz: Real,
        /// ζ: 0 swings for ever, 1 comes back without swinging.
        damping_ratio: Real,
    },
    /// By its coefficients.
    Constants(Coefficients),
}

/// k and c of a spring.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Coefficients {
    /// k (N/m, or N·m/rad).
    pub stiffness: Real,
    /// c (N·s/m, or N·m·s/rad).
    #[serde(default)]
    pub damping: Real,
}

/// How a joint holds a coordinate at its rest value. In readable text it is `"rigid"`, `"free"` or a [`Spring`].
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Hold {
    /// Exactly.
    #[default]
    Rigid,
    /// By a spring.
    Spring(Spring),
    /// Not at all.
    Free,
}

impl Spring {
    /// By frequency (Hz) and damping ratio.
    #[must_use]
    pub const fn new(hertz: Real, damping_ratio: Real) -> Self {
        Self::Frequency { hertz, damping_ratio }
    }

    /// k and c for an effective mass (kg, or kg·m²).
    #[must_use]
    pub fn coefficients(&self, mass: Real) -> Coefficients {
        match *self {
            Self::Frequency { hertz, damping_ratio } => {
                let omega = 2.0 * PI * hertz;
                Coefficients {
                    stiffness: mass * omega * omega,
                    damping: 2.0 * mass * damping_ratio * omega,
                }
            }
            Self::Constants(coefficients) => coefficients,
        }
    }

    pub(crate) fn validated(&self) -> Result<()> {
        match *self {
            Self::Frequency { hertz, damping_ratio } => {
                check::positive("hertz", hertz)?;
                check::not_negative("damping_ratio", damping_ratio)?;
            }
            Self::Constants(Coefficients { stiffness, damping }) => {
                check::not_negative("stiffness", stiffness)?;
                check::not_negative("damping", damping)?;
            }
        }
        Ok(())
    }
}

impl Hold {
    /// By frequency (Hz) and damping ratio; 0 Hz is rigid.
    #[must_use]
    pub fn soft(hertz: Real, damping_ratio: Real) -> Self {
        if hertz == 0.0 { Self::Rigid } else { Self::Spring(Spring::new(hertz, damping_ratio)) }
    }

    /// The spring, if it is one.
    #[must_use]
    pub fn spring(&self) -> Option<Spring> {
        if let Self::Spring(spring) = self { Some(*spring) } else { None }
    }

    pub(crate) fn validated(&self) -> Result<()> {
        self.spring().map_or(Ok(()), |spring| spring.validated())
    }
}
