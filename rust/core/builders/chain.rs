//! Chains.

use super::Assembly;
use super::line::{End, Hinges, Layout};
use super::plan::Plan;
use crate::body::BodyDef;
use crate::error::{Result, check};
use crate::math::{Real, vec2};
use crate::shapes::Shape;
use crate::world::World;

/// A chain of links that hang together, seen from the side: one broad, the next on edge, and so on.
///
/// The links have the proportions of a short-link chain: three times the wire's thickness from one to the next, 3.4 times
/// wide, and five times long over all.
#[derive(Clone, Debug, PartialEq)]
pub struct ChainDef {
    /// Bodies are called "`name` 0" and so on, joints "`name` joint 0".
    pub name: String,
    /// Where it begins and ends.
    pub ends: [End; 2],
    /// Length (m); none: as far as the ends are apart, and a thousandth more where both are fixed.
    pub length: Option<Real>,
    /// Number of links.
    pub links: usize,
    /// Mass per length (kg/m).
    pub mass_per_length: Real,
    /// Thickness of the wire (m); none: a third of the way from one link to the next.
    pub wire: Option<Real>,
    /// Force (N) above which a link breaks; none: never.
    pub breaking_force: Option<Real>,
    /// Surface, filter, damping and the like of all links. Place, shape and mass come from the chain.
    pub body: BodyDef,
}

impl ChainDef {
    /// Twenty links of 1 kg/m from one end to the other.
    #[must_use]
    pub fn new(ends: [End; 2]) -> Self {
        Self {
            name: "chain".into(),
            ends,
            length: None,
            links: 20,
            mass_per_length: 1.0,
            wire: None,
            breaking_force: None,
            body: BodyDef::default(),
        }
    }

    /// Adds the chain.
    ///
    /// # Errors
    /// [`crate::Error::Invalid`] for numbers that are not allowed, among them a length below the distance of the ends, or no
    /// slack between fixed ones;
    /// [`crate::Error::StaleHandle`] for a body that is gone. The world stays as it was.
    pub fn build(&self, world: &mut World) -> Result<Assembly> {
        check::positive("mass_per_length", self.mass_per_length)?;
        let layout = Layout { ends: self.ends, length: self.length, count: self.links };
        let line = layout.line(world)?;
        let wire = self.wire.unwrap_or(line.pitch / 3.0);
        check::positive("wire", wire)?;
        // Over all a link is as long as from one to the next and a wire more at either end.
        let capsule = |radius: Real| {
            let half = vec2((0.5 * line.pitch + wire - radius).max(0.1 * line.pitch), 0.0);
            Shape::capsule(-half, half, radius)
        };
        let shapes = [capsule(1.7 * wire)?, capsule(0.5 * wire)?];
        let mut plan = Plan::default();
        let (name, ends, breaking_force) = (self.name.as_str(), self.ends, self.breaking_force);
        line.hinge(&mut plan, &Hinges { name, ends, spring: None, breaking_force }, |k| BodyDef {
            shapes: vec![shapes[k % 2].clone().into()],
            mass: Some(self.mass_per_length * line.pitch),
            ..self.body.clone()
        });
        plan.add(world)
    }
}
