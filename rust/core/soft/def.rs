//! What the user writes of a deformable body.

use serde::{Deserialize, Serialize};

use super::{Gas, Material, Mesh};
use crate::body::{Filter, Surface};
use crate::error::{Error, Result, check};
use crate::math::{Real, Vec2};

/// How stiff the rods of a mesh are.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, schemars::JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct Rope {
    /// EA (N): force over relative stretch.
    pub stretch_stiffness: Real,
    /// EI (N·m²): moment over curvature. Ropes are straight at rest.
    pub bending_stiffness: Real,
}

/// A deformable body as the user writes it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct SoftDef {
    /// Nodes and elements.
    pub mesh: Mesh,
    /// What its triangles are made of; of ropes the density and the damping.
    pub material: Material,
    /// What its rods are.
    pub rope: Option<Rope>,
    /// What fills it, if it is a closed rope.
    pub gas: Option<Gas>,
    /// Where the origin of the mesh is put (m).
    pub position: Vec2,
    /// By how much it is turned (rad).
    pub angle: Real,
    /// Velocity of its centre of mass (m/s).
    pub velocity: Vec2,
    /// Angular velocity (rad/s).
    pub angular_velocity: Real,
    /// What gravity is multiplied by.
    pub gravity_scale: Real,
    /// Nodes that stay where they are put.
    pub pins: Vec<u32>,
    /// By how much its border is thicker than its nodes say (m); none: a fiftieth of the mean side of its border.
    pub radius: Option<Real>,
    /// What it is like to touch.
    pub surface: Surface,
    /// What it touches.
    pub filter: Filter,
    /// Whether its border touches itself.
    pub touches_itself: bool,
    /// Name.
    pub name: Option<String>,
}

impl SoftDef {
    /// A mesh of a material at the origin, at rest.
    #[must_use]
    pub fn new(mesh: Mesh, material: Material) -> Self {
        Self {
            mesh,
            material,
            rope: None,
            gas: None,
            position: Vec2::zeros(),
            angle: 0.0,
            velocity: Vec2::zeros(),
            angular_velocity: 0.0,
            gravity_scale: 1.0,
            pins: Vec::new(),
            radius: None,
            surface: Surface::default(),
            filter: Filter::default(),
            touches_itself: false,
            name: None,
        }
    }

    pub(super) fn validated(&self) -> Result<()> {
        self.material.validated()?;
        self.surface.validated()?;
        check::finite_vec("position", self.position)?;
        check::finite("angle", self.angle)?;
        check::finite_vec("velocity", self.velocity)?;
        check::finite("angular_velocity", self.angular_velocity)?;
        check::finite("gravity_scale", self.gravity_scale)?;
        if let Some(radius) = self.radius {
            check::not_negative("radius", radius)?;
        }
        if let Some(pin) = self.pins.iter().find(|pin| **pin as usize >= self.mesh.rest.len()) {
            return Err(Error::invalid("a pin", pin, "the number of a node"));
        }
        self.validate_rope()
    }

    fn validate_rope(&self) -> Result<()> {
        match (&self.rope, self.mesh.rods.is_empty()) {
            (Some(rope), false) => {
                check::positive("stretch_stiffness", rope.stretch_stiffness)?;
                check::not_negative("bending_stiffness", rope.bending_stiffness)?;
            }
            (None, false) => {
                return Err(Error::invalid(
                    "rope",
                    "none",
                    "the stiffness of the rods of the mesh",
                ));
            }
            (Some(_), true) => {
                return Err(Error::invalid("rope", "given", "none, since the mesh has no rods"));
            }
            (None, true) => {}
        }
        let Some(gas) = &self.gas else { return Ok(()) };
        gas.validated()?;
        if self.mesh.rods.is_empty() || self.mesh.rods.len() != self.mesh.rest.len() {
            return Err(Error::invalid("gas", "given", "none, unless the mesh is one closed rope"));
        }
        Ok(())
    }
}
