//! Force fields: what a user adds to the laws of motion.

use crate::arena::{Handle, HandleMap, Named};
use crate::body::{Body, BodyHandle, Mass};
pub use crate::error::BoxError;
use crate::forces::library::BuiltInField;
use crate::math::{Pose, Real, Twist, Wrench};

/// All bodies of the world at one moment, in body order.
#[derive(Clone, Copy)]
pub struct BodyColumns<'a> {
    /// Positions of the centres of mass, angles.
    pub poses: &'a [Pose],
    /// Velocities of the centres of mass, angular velocities.
    pub twists: &'a [Twist],
    /// Masses and inertias.
    pub masses: &'a [Mass],
    /// Which body stands where in the columns.
    pub handles: &'a HandleMap<Body>,
}

impl BodyColumns<'_> {
    /// Place of a body in the columns; none once it is removed.
    #[must_use]
    pub fn index(&self, body: BodyHandle) -> Option<usize> {
        self.handles.index(body).ok()
    }
}

/// What a field says of itself. The defaults are safe for any field; a field that knows better is
/// stepped at less cost.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FieldFacts {
    /// The forces depend on the velocities. (Where they do not, leapfrog needs one evaluation a step.)
    pub velocity_dependent: bool,
    /// [`ForceField::potential`] gives the energy whose gradient the forces are. (Where there is
    /// none, what the forces do is booked as work.)
    pub conservative: bool,
    /// The forces act between bodies of this world and sum to zero, torques too (Newton's third law).
    pub internal: bool,
}

impl Default for FieldFacts {
    fn default() -> Self {
        Self { velocity_dependent: true, conservative: false, internal: false }
    }
}

/// A force on every body as a function of time, place and velocity. Whole columns in, whole columns
/// out; the engine's methods call it at their own stages.
///
/// ```
/// use culbuto::forces::{BodyColumns, BoxError, ForceField};
/// use culbuto::math::{Real, Wrench};
///
/// struct Spring { stiffness: Real } // pulls every body to the origin
///
/// impl ForceField for Spring {
///     fn name(&self) -> &str { "spring" }
///     fn add_forces(&self, _: Real, bodies: &BodyColumns<'_>, out: &mut [Wrench]) -> Result<(), BoxError> {
///         for (pose, wrench) in bodies.poses.iter().zip(out) {
///             wrench.force -= self.stiffness * pose.position;
///         }
///         Ok(())
///     }
/// }
/// ```
pub trait ForceField: Send + Sync {
    /// A name for messages and `explain()`.
    fn name(&self) -> &str;

    /// Adds the force (N) and torque (N·m) on each body to `out`, which has a place for every body.
    fn add_forces(
        &self,
        time: Real,
        bodies: &BodyColumns<'_>,
        out: &mut [Wrench],
    ) -> Result<(), BoxError>;

    /// Potential energy of all bodies in this field (J); none where it has no potential.
    fn potential(&self, _time: Real, _bodies: &BodyColumns<'_>) -> Result<Option<Real>, BoxError> {
        Ok(None)
    }

    /// What holds of this field.
    fn facts(&self) -> FieldFacts {
        FieldFacts::default()
    }

    /// The field as snapshots and scene files hold it; none for a field that is the user's code.
    fn built_in(&self) -> Option<BuiltInField> {
        None
    }
}

/// A field of a world. Only its [`FieldHandle`] is ever held by the user.
#[derive(Debug)]
pub enum Field {}

impl Named for Field {
    const NAME: &'static str = "force field";
}

/// Names a field.
pub type FieldHandle = Handle<Field>;
