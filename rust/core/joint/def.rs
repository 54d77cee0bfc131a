//! What the user writes to make a joint.

use serde::{Deserialize, Serialize};

use super::{Hold, JointKind, Travel};
use crate::body::BodyHandle;
use crate::error::{Result, check};
use crate::math::{Real, Vec2, vec2};

/// A point or a direction, as it is given. A joint in a world has it in local coordinates.
/// In readable text it is `[x, y]` or `{"world": [x, y]}`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Given {
    /// In the body's frame.
    Local(Vec2),
    /// In the world, where the body stands when the joint is made.
    World(Vec2),
}

impl Given {
    /// The numbers, in whichever frame.
    #[must_use]
    pub const fn vector(&self) -> Vec2 {
        match self {
            Self::Local(vector) | Self::World(vector) => *vector,
        }
    }
}

/// Everything about a joint that is about to be made.
///
/// ```
/// use culbuto::{BodyDef, World, joint::JointDef, math::vec2};
/// let mut world = World::new(vec2(0.0, -9.81))?;
/// let bob = world.add_body(BodyDef { position: vec2(1.0, 0.0), ..BodyDef::point(1.0) })?;
/// world.add_joint(JointDef::distance(None, bob).anchored(vec2(0.0, 0.0), vec2(1.0, 0.0)))?;
/// # Ok::<(), culbuto::Error>(())
/// ```
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct JointDef {
    /// A name to find the joint by; need not be unique.
    pub name: Option<String>,
    /// A and B; none: the world.
    pub bodies: [Option<BodyHandle>; 2],
    /// Where the joint holds A and B.
    pub anchors: [Given; 2],
    /// What it does.
    pub kind: JointKind,
    /// Whether A and B can touch each other.
    pub collide_connected: bool,
    /// Force (N) above which the joint breaks; none: never.
    pub breaking_force: Option<Real>,
    /// Torque (N·m) above which it breaks; none: never.
    pub breaking_torque: Option<Real>,
}

impl JointDef {
    /// Of any kind, with the anchors in the bodies' origins.
    #[must_use]
    pub fn new(
        a: impl Into<Option<BodyHandle>>,
        b: impl Into<Option<BodyHandle>>,
        kind: JointKind,
    ) -> Self {
        Self {
            name: None,
            bodies: [a.into(), b.into()],
            anchors: [Given::Local(vec2(0.0, 0.0)); 2],
            kind,
            collide_connected: false,
            breaking_force: None,
            breaking_torque: None,
        }
    }

    /// A rod as long as the anchors are apart.
    #[must_use]
    pub fn distance(a: impl Into<Option<BodyHandle>>, b: impl Into<Option<BodyHandle>>) -> Self {
        let kind = JointKind::Distance { length: None, hold: Hold::Rigid, min: 0.0, max: None };
        Self::new(a, b, kind)
    }

    /// A spring at rest where the anchors are now.
    #[must_use]
    pub fn spring(
        a: impl Into<Option<BodyHandle>>,
        b: impl Into<Option<BodyHandle>>,
        hold: Hold,
    ) -> Self {
        Self::new(a, b, JointKind::Distance { length: None, hold, min: 0.0, max: None })
    }

    /// A rope of at most this length (m).
    #[must_use]
    pub fn rope(
        a: impl Into<Option<BodyHandle>>,
        b: impl Into<Option<BodyHandle>>,
        length: Real,
    ) -> Self {
        let kind =
            JointKind::Distance { length: None, hold: Hold::Free, min: 0.0, max: Some(length) };
        Self::new(a, b, kind)
    }

    /// A hinge.
    #[must_use]
    pub fn revolute(a: impl Into<Option<BodyHandle>>, b: impl Into<Option<BodyHandle>>) -> Self {
        Self::new(a, b, JointKind::Revolute { angle: None, travel: Travel::default() })
    }

    /// A rigid weld.
    #[must_use]
    pub fn weld(a: impl Into<Option<BodyHandle>>, b: impl Into<Option<BodyHandle>>) -> Self {
        let (linear, angular) = (Hold::Rigid, Hold::Rigid);
        Self::new(a, b, JointKind::Weld { angle: None, linear, angular })
    }

    /// Anchors at two points of the world.
    #[must_use]
    pub fn anchored(self, a: Vec2, b: Vec2) -> Self {
        Self { anchors: [Given::World(a), Given::World(b)], ..self }
    }

    /// Both anchors at one point of the world.
    #[must_use]
    pub fn at(self, point: Vec2) -> Self {
        self.anchored(point, point)
    }

    /// Anchors in the bodies' frames.
    #[must_use]
    pub fn anchored_locally(self, a: Vec2, b: Vec2) -> Self {
        Self { anchors: [Given::Local(a), Given::Local(b)], ..self }
    }

    /// Every number checked; errors name the field.
    ///
    /// # Errors
    /// [`crate::Error::Invalid`] for the first that is not allowed.
    pub fn validated(&self) -> Result<()> {
        for (anchor, what) in self.anchors.iter().zip(["anchor_a", "anchor_b"]) {
            check::finite_vec(what, anchor.vector())?;
        }
        let breaks =
            [("breaking_force", self.breaking_force), ("breaking_torque", self.breaking_torque)];
        for (what, value) in breaks {
            value.map_or(Ok(0.0), |value| check::not_negative(what, value))?;
        }
        self.kind.validated()
    }

    /// The axis, of the kinds that have one.
    pub(crate) fn axis_mut(&mut self) -> Option<&mut Given> {
        self.kind.axis_mut()
    }
}
