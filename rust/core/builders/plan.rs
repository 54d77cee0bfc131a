//! An object before it is in the world, so that what can fail fails first.

use super::Assembly;
use crate::body::{BodyDef, BodyHandle};
use crate::error::Result;
use crate::joint::JointDef;
use crate::world::World;

/// What a planned joint holds on to.
#[derive(Clone, Copy, Debug)]
pub enum Side {
    /// The world.
    World,
    /// A body of the plan, by its number.
    New(usize),
    /// A body that is there already.
    Known(BodyHandle),
}

/// Bodies and joints to be added.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    bodies: Vec<BodyDef>,
    joints: Vec<([Side; 2], JointDef)>,
}

impl Plan {
    /// Plans a body.
    pub fn body(&mut self, def: BodyDef) -> Side {
        self.bodies.push(def);
        Side::New(self.bodies.len() - 1)
    }

    /// Plans a joint; the bodies of its definition are filled in.
    pub fn joint(&mut self, sides: [Side; 2], def: JointDef) {
        self.joints.push((sides, def));
    }

    /// Checks everything, then adds it.
    ///
    /// # Errors
    /// What a body or a joint of the plan cannot be. The world stays as it was.
    pub fn add(self, world: &mut World) -> Result<Assembly> {
        for def in &self.bodies {
            def.validated()?;
            def.mass_properties()?;
        }
        for (sides, def) in &self.joints {
            def.validated()?;
            for side in sides {
                if let Side::Known(body) = side {
                    world.body(*body)?;
                }
            }
        }
        let mut added = Assembly::default();
        let outcome = self.put(world, &mut added);
        if outcome.is_err() {
            added.remove(world);
        }
        outcome.map(|()| added)
    }

    fn put(self, world: &mut World, added: &mut Assembly) -> Result<()> {
        for def in self.bodies {
            added.bodies.push(world.add_body(def)?);
        }
        for (sides, def) in self.joints {
            let bodies = sides.map(|side| match side {
                Side::World => None,
                Side::New(k) => Some(added.bodies[k]),
                Side::Known(body) => Some(body),
            });
            added.joints.push(world.add_joint(JointDef { bodies, ..def })?);
        }
        Ok(())
    }
}
