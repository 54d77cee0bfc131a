//! Fluids of a scene file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::wrong;
use crate::error::Result;
use crate::fluid::{FluidHandle, Inflow, Material, lattice_in};
use crate::math::{Real, Vec2};
use crate::shapes::Shape;
use crate::world::World;

/// A fluid of particles.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SceneFluid {
    /// A name to find it by.
    pub name: Option<String>,
    /// Distance (m) of its particles at rest; the same for all fluids.
    pub spacing: Real,
    /// Density at rest (kg/m²).
    pub density: Real,
    /// Viscosity (Pa·s).
    pub viscosity: Real,
    /// Surface tension (N/m).
    pub tension: Real,
    /// Work of adhesion (N/m) to solids.
    pub adhesion: Real,
    /// How long (s) its particles are there; none: for ever.
    pub lifetime: Option<Real>,
    /// Regions filled with particles on a lattice.
    pub fill: Vec<SceneFill>,
    /// Particles beside those (m), oldest first.
    #[schemars(with = "Vec<[Real; 2]>")]
    pub positions: Vec<Vec2>,
    /// Velocities (m/s) of these; none: at rest.
    #[schemars(with = "Vec<[Real; 2]>")]
    pub velocities: Vec<Vec2>,
    /// Where it flows in.
    pub inflows: Vec<Inflow>,
}

/// A region filled with a fluid.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SceneFill {
    /// The region, in the frame of the world.
    pub shape: Shape,
    /// Velocity (m/s).
    #[serde(default)]
    #[schemars(with = "[Real; 2]")]
    pub velocity: Vec2,
}

impl Default for SceneFluid {
    fn default() -> Self {
        let Material { density, viscosity, tension, adhesion } = Material::default();
        Self {
            name: None,
            spacing: 0.0,
            density,
            viscosity,
            tension,
            adhesion,
            lifetime: None,
            fill: Vec::new(),
            positions: Vec::new(),
            velocities: Vec::new(),
            inflows: Vec::new(),
        }
    }
}

impl SceneFluid {
    /// A fluid of a world as it is.
    pub(super) fn of(world: &World, fluid: FluidHandle) -> Result<Self> {
        let fluids = world.fluids();
        let own = fluids.list.get(fluid)?;
        let Material { density, viscosity, tension, adhesion } = own.material;
        Ok(Self {
            name: own.name.clone(),
            spacing: fluids.spacing,
            density,
            viscosity,
            tension,
            adhesion,
            lifetime: own.lifetime,
            fill: Vec::new(),
            positions: fluids.positions(fluid)?,
            velocities: fluids.velocities(fluid)?,
            inflows: fluids.inflows(fluid)?,
        })
    }

    /// Adds it to a world.
    pub(super) fn add(&self, world: &mut World, path: &str) -> Result<()> {
        let Self { density, viscosity, tension, adhesion, .. } = *self;
        let material = Material { density, viscosity, tension, adhesion };
        let at = super::to_world::at(path);
        let fluid = world.add_fluid(&[], self.spacing, material).map_err(&at)?;
        let fluids = world.fluids_mut();
        fluids.rename(fluid, self.name.clone())?;
        for (i, fill) in self.fill.iter().enumerate() {
            let path = format!("{path}.fill[{i}]");
            let at = super::to_world::at(&path);
            let points = lattice_in(&fill.shape, self.spacing).map_err(&at)?;
            fluids.pour(fluid, &points, fill.velocity).map_err(&at)?;
        }
        let filled = fluids.velocities(fluid)?;
        fluids.pour(fluid, &self.positions, Vec2::zeros()).map_err(&at)?;
        if !self.velocities.is_empty() {
            if self.velocities.len() != self.positions.len() {
                let count = self.positions.len();
                let message = format!(
                    "{} for {count} positions; allowed: {count}, or none",
                    self.velocities.len()
                );
                return Err(wrong(format!("{path}.velocities"), message));
            }
            let all = [&filled[..], &self.velocities].concat();
            fluids.set_velocities(fluid, &all).map_err(&at)?;
        }
        fluids.set_inflows(fluid, &self.inflows).map_err(&at)?;
        fluids.set_lifetime(fluid, self.lifetime).map_err(&at)
    }
}
