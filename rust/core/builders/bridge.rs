//! Bridges.

use super::Assembly;
use super::line::{End, Hinges, Layout};
use super::plan::Plan;
use crate::body::BodyDef;
use crate::error::{Result, check};
use crate::math::Real;
use crate::shapes::Shape;
use crate::world::World;

/// Planks hinged end to end between two anchors.
#[derive(Clone, Debug, PartialEq)]
pub struct BridgeDef {
    /// Bodies are called "`name` 0" and so on, joints "`name` joint 0".
    pub name: String,
    /// What it hangs on.
    pub anchors: [End; 2],
    /// Length along the planks (m); none: as far as the anchors are apart, and a thousandth more where both are fixed.
    pub length: Option<Real>,
    /// Number of planks.
    pub planks: usize,
    /// Thickness of a plank (m); none: a fifth of its length.
    pub thickness: Option<Real>,
    /// Mass per length (kg/m).
    pub mass_per_length: Real,
    /// Force (N) above which a hinge breaks; none: never.
    pub breaking_force: Option<Real>,
    /// Surface, filter, damping and the like of all planks. Place, shape and mass come from the bridge.
    pub body: BodyDef,
}

impl BridgeDef {
    /// Twelve planks of 1 kg/m from one anchor to the other.
    #[must_use]
    pub fn new(anchors: [End; 2]) -> Self {
        Self {
            name: "bridge".into(),
            anchors,
            length: None,
            planks: 12,
            thickness: None,
            mass_per_length: 1.0,
            breaking_force: None,
            body: BodyDef::default(),
        }
    }

    /// Adds the bridge.
    ///
    /// # Errors
    /// [`crate::Error::Invalid`] for numbers that are not allowed, among them a length below the distance of the anchors, or
    /// no slack between fixed ones;
    /// [`crate::Error::StaleHandle`] for a body that is gone. The world stays as it was.
    pub fn build(&self, world: &mut World) -> Result<Assembly> {
        check::positive("mass_per_length", self.mass_per_length)?;
        let layout = Layout { ends: self.anchors, length: self.length, count: self.planks };
        let line = layout.line(world)?;
        let plank = Shape::rectangle(line.pitch, self.thickness.unwrap_or(0.2 * line.pitch))?;
        let mut plan = Plan::default();
        let (name, ends, breaking_force) = (self.name.as_str(), self.anchors, self.breaking_force);
        line.hinge(&mut plan, &Hinges { name, ends, spring: None, breaking_force }, |_| BodyDef {
            shapes: vec![plank.clone().into()],
            mass: Some(self.mass_per_length * line.pitch),
            ..self.body.clone()
        });
        plan.add(world)
    }
}
