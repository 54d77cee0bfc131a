//! A world as it was: to go back to, to keep, to send. It continues bit for bit.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::body::BodyHandle;
use crate::error::{Error, Result};
use crate::fluid::FluidHandle;
use crate::forces::{BuiltInField, FieldHandle, ForceField, Schedule, ScheduleHandle};
use crate::joint::{Constraint, Custom, Joint, JointHandle, JointKind};
use crate::math::Real;
use crate::methods::{self, Method};
use crate::soft::SoftHandle;
use crate::world::{State, World};

/// The state of a world at one moment, fields included.
#[derive(Clone)]
pub struct Snapshot {
    state: State,
    fields: Vec<Arc<dyn ForceField>>,
    method: &'static dyn Method,
}

/// What stands in a file: the state, and for each field what it is, or that it was the user's code.
#[derive(Serialize, Deserialize)]
struct Stored {
    version: u32,
    state: State,
    fields: Vec<Option<BuiltInField>>,
}

/// Changes with the layout of [`State`].
const VERSION: u32 = 11;

impl World {
    /// Keeps the world as it is.
    #[must_use]
    pub fn snapshot(&self) -> Snapshot {
        Snapshot { state: self.state.clone(), fields: self.fields.clone(), method: self.method }
    }

    /// Goes back to a snapshot, of this world or of another. Handles of then are valid again. The hooks and the
    /// threads of this world stay.
    pub fn restore(&mut self, snapshot: &Snapshot) {
        let hooks = self.hooks.take();
        let threads = self.scratch.wet.take_threads();
        *self = snapshot.to_world();
        self.hooks = hooks;
        self.scratch.wet.give_threads(threads);
    }
}

impl Snapshot {
    /// Handles of its bodies, in body order.
    #[must_use]
    pub fn bodies(&self) -> &[BodyHandle] {
        self.state.bodies.handles()
    }

    /// Handles of its fields, in the order of [`Snapshot::fields`].
    #[must_use]
    pub fn field_handles(&self) -> &[FieldHandle] {
        self.state.field_map.handles()
    }

    /// Its fields.
    #[must_use]
    pub fn fields(&self) -> &[Arc<dyn ForceField>] {
        &self.fields
    }

    /// Handles of its joints, in the order of [`Snapshot::joints`].
    #[must_use]
    pub fn joint_handles(&self) -> &[JointHandle] {
        self.state.joints.handles()
    }

    /// Its joints.
    #[must_use]
    pub fn joints(&self) -> &[Joint] {
        self.state.joints.values()
    }

    /// Handles of its schedules, in the order of [`Snapshot::schedules`].
    #[must_use]
    pub fn schedule_handles(&self) -> &[ScheduleHandle] {
        self.state.schedules.handles()
    }

    /// Its schedules.
    #[must_use]
    pub fn schedules(&self) -> &[Schedule] {
        self.state.schedules.values()
    }

    /// Handles of its fluids.
    #[must_use]
    pub fn fluid_handles(&self) -> &[FluidHandle] {
        self.state.fluids.list.handles()
    }

    /// Handles of its deformable bodies.
    #[must_use]
    pub fn soft_handles(&self) -> &[SoftHandle] {
        self.state.softs.bodies.handles()
    }

    /// World time (s).
    #[must_use]
    pub fn time(&self) -> Real {
        self.state.clock.now
    }

    /// A world that continues from here.
    #[must_use]
    pub fn to_world(&self) -> World {
        World::from_state(self.state.clone(), self.fields.clone(), self.method)
    }

    /// The snapshot as bytes. Fields that are the user's code are not in them: [`Snapshot::from_bytes`]
    /// is handed those again.
    pub fn to_bytes(&self) -> Result<Vec<u8>> {
        let fields = self.fields.iter().map(|field| field.built_in()).collect();
        let stored = Stored { version: VERSION, state: self.state.clone(), fields };
        postcard::to_stdvec(&stored)
            .map_err(|error| Error::invalid("snapshot", error, "a state that can be written"))
    }

    /// Reads a snapshot. `own` are the fields of the user's own, in the order in which they stand
    /// among the world's fields.
    ///
    /// # Errors
    /// Bytes that are no snapshot of this version, or fewer or more fields than it had.
    pub fn from_bytes(bytes: &[u8], own: Vec<Arc<dyn ForceField>>) -> Result<Self> {
        Self::from_bytes_with(bytes, own, Vec::new())
    }

    /// The same for a world with joints of the user's own, whose constraints are handed again in the order in which the joints
    /// stand among the world's.
    ///
    /// # Errors
    /// Those of [`Snapshot::from_bytes`], and fewer or more constraints than it had.
    pub fn from_bytes_with(
        bytes: &[u8],
        own: Vec<Arc<dyn ForceField>>,
        constraints: Vec<Arc<dyn Constraint>>,
    ) -> Result<Self> {
        let wrong = |got: String| {
            Error::invalid(
                "snapshot",
                got,
                format!("bytes written by version {VERSION} of snapshots"),
            )
        };
        let mut stored: Stored =
            postcard::from_bytes(bytes).map_err(|error| wrong(error.to_string()))?;
        if stored.version != VERSION {
            return Err(wrong(format!("version {}", stored.version)));
        }
        let method = methods::method(&stored.state.settings.method)?;
        let wanted = stored.fields.iter().filter(|field| field.is_none()).count();
        if own.len() != wanted {
            let got = format!("{} fields", own.len());
            return Err(Error::invalid("fields of the snapshot", got, format!("{wanted}")));
        }
        let mut own = own.into_iter();
        let mut fields = Vec::with_capacity(stored.fields.len());
        for field in stored.fields {
            match field {
                Some(built_in) => fields.push(built_in.build()?),
                None => fields.extend(own.next()),
            }
        }
        hand(stored.state.joints.values_mut(), constraints)?;
        stored.state.bodies.rebuild();
        stored.state.softs.rebuild()?;
        stored.state.contacts.rebuild(&stored.state.bodies);
        Ok(Self { state: stored.state, fields, method })
    }
}

/// Gives custom joints their constraints.
fn hand(joints: &mut [Joint], constraints: Vec<Arc<dyn Constraint>>) -> Result<()> {
    let mut own: Vec<_> =
        joints.iter_mut().filter(|joint| joint.def.kind == JointKind::Custom).collect();
    if own.len() != constraints.len() {
        let got = format!("{} constraints", constraints.len());
        return Err(Error::invalid("joints of the snapshot", got, format!("{}", own.len())));
    }
    for (joint, constraint) in own.iter_mut().zip(constraints) {
        joint.custom = Some(Custom::new(constraint)?);
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::{BodyDef, Friction, Role};
    use crate::math::vec2;
    use crate::shapes::Shape;

    #[test]
    fn bytes_hold_bodies_with_and_without_what_is_optional() {
        let mut world = World::default();
        let ball = BodyDef::new(Shape::circle(1.0).unwrap());
        world.add_body(ball.clone()).unwrap();
        let named = BodyDef { name: Some("ball".into()), inertia: Some(2.0), ..ball };
        let mut rough = BodyDef { velocity: vec2(1.0, 2.0), role: Role::Sensor, ..named };
        rough.surface.friction = Friction { sticking: 0.7, sliding: 0.4 };
        rough.shapes[0].surface.friction = Some(Friction::of(0.2));
        rough.shapes[0].surface.material = Some("ice".into());
        rough.shapes[0].filter.group = Some(-3);
        rough.shapes[0].role = Some(Role::OneWay(vec2(0.0, 1.0)));
        world.add_body(rough).unwrap();
        let bytes = world.snapshot().to_bytes().unwrap();
        let mut copy = Snapshot::from_bytes(&bytes, Vec::new()).unwrap().to_world();
        world.steps(0.1, 10).unwrap();
        copy.steps(0.1, 10).unwrap();
        assert_eq!(world.bodies().poses, copy.bodies().poses);
        assert_eq!(world.bodies().infos[1].def, copy.bodies().infos[1].def);
    }
}
