//! Joints of a world: made, read, changed, removed.

mod advance;
pub(super) mod make;
mod step;
mod swings;

pub use swings::SpringMotion;

pub(super) use advance::{Group as JoinedGroup, JoinedScratch, is_smooth};
pub(super) use step::{Memory, keep, tie, tied};

use std::mem::discriminant;
use std::sync::Arc;

use crate::body::{Bodies, BodyHandle};
use crate::constraints::joint::{Action, Law, Pair, Rows};
use crate::error::{Error, Result};
use crate::joint::{
    Coefficients, Constraint, Custom, Joint, JointDef, JointHandle, JointKind, ROWS,
};
use crate::math::{Pose, Real, Rot, Twist, Vec2, Wrench, vec2};
use crate::world::{State, World};

/// A joint that broke in the last call: it bore more than it may, and is no longer in the world.
#[derive(Clone, Debug, PartialEq)]
pub struct BrokenJoint {
    /// World time (s) at the end of the step.
    pub time: Real,
    /// The handle, which names nothing any more.
    pub joint: JointHandle,
    /// What it was.
    pub def: JointDef,
    /// Force (N) on B, and torque (N·m) about its anchor, in the step.
    pub reaction: Wrench,
}

/// Adding, removing and changing joints.
impl World {
    /// Adds a joint. What its definition leaves open is taken from where the bodies stand.
    ///
    /// # Errors
    /// [`crate::Error::Invalid`] for a number that is not allowed, one body twice, or no body that can move;
    /// [`crate::Error::StaleHandle`] for a body that is gone. The world stays as it was.
    pub fn add_joint(&mut self, def: JointDef) -> Result<JointHandle> {
        if def.kind == JointKind::Custom {
            let allowed = "add_custom_joint, with the constraint";
            return Err(Error::invalid("kind", "custom without a constraint", allowed));
        }
        self.insert_joint(make::joint(&self.state.bodies, def, None)?)
    }

    /// How far the joint that is farthest from it is from what it holds (m, or rad where it holds an angle); 0 without joints.
    #[must_use]
    pub fn joint_gap(&self) -> Real {
        let bodies = &self.state.bodies;
        let gap = |joint: &Joint| JointRef { bodies, joint }.gap();
        self.state.joints.values().iter().map(gap).fold(0.0, Real::max)
    }

    /// Adds a joint of the user's own. Its Jacobian is compared with differences of C, where the bodies stand.
    ///
    /// # Errors
    /// Those of [`World::add_joint`]; a constraint that fails, or whose Jacobian is wrong.
    pub fn add_custom_joint(
        &mut self,
        def: JointDef,
        constraint: Arc<dyn Constraint>,
    ) -> Result<JointHandle> {
        let def = JointDef { kind: JointKind::Custom, ..def };
        let custom = Custom::new(constraint)?;
        let joint = make::joint(&self.state.bodies, def, Some(custom.clone()))?;
        let frames = [0, 1].map(|side| {
            index_of(&self.state.bodies, &joint, side)
                .map_or(Pose::IDENTITY, |i| self.state.bodies.origin(i))
        });
        let size = (frames[1].position - frames[0].position).norm();
        custom.check(&frames, if size > 0.0 { size } else { 1.0 })?;
        self.insert_joint(joint)
    }

    fn insert_joint(&mut self, joint: Joint) -> Result<JointHandle> {
        let bodies = joint.def.bodies;
        let handle = self.state.joints.insert(joint);
        self.rejoin(bodies);
        Ok(handle)
    }

    /// Removes a joint.
    pub fn remove_joint(&mut self, joint: JointHandle) -> Result<()> {
        let joint = self.state.joints.remove(joint)?;
        self.forget_soft_joints();
        self.rejoin(joint.def.bodies);
        Ok(())
    }

    /// A joint, to read.
    pub fn joint(&self, joint: JointHandle) -> Result<JointRef<'_>> {
        Ok(JointRef { bodies: &self.state.bodies, joint: self.state.joints.get(joint)? })
    }

    /// A joint with all that it remembers, to put that back.
    pub(crate) fn joint_mut(&mut self, joint: JointHandle) -> Result<&mut Joint> {
        self.state.joints.get_mut(joint)
    }

    /// Changes a joint: `edit` works on a copy of its definition, and nothing changes if the result is not allowed.
    /// Springs that change take the bodies' places and masses of now for their effective mass; the others stay.
    ///
    /// # Errors
    /// Those of [`World::add_joint`].
    pub fn edit_joint(
        &mut self,
        joint: JointHandle,
        edit: impl FnOnce(&mut JointDef),
    ) -> Result<()> {
        let before = self.state.joints.get(joint)?;
        if before.matter != [None; 2] {
            return self.edit_soft_joint(joint, edit);
        }
        let mut def = before.def.clone();
        edit(&mut def);
        let mut changed = make::joint(&self.state.bodies, def, before.custom.clone())?;
        let bodies = [before.def.bodies, changed.def.bodies];
        let same_pair = bodies[0] == bodies[1];
        let same_tie = same_pair
            && discriminant(&changed.def.kind) == discriminant(&before.def.kind)
            && changed.def.collide_connected == before.def.collide_connected;
        if same_pair {
            make::carry_over(&self.state.bodies, before, &mut changed);
        }
        *self.state.joints.get_mut(joint)? = changed;
        for pair in bodies {
            if same_tie {
                self.wake_joined(pair);
            } else {
                self.rejoin(pair);
            }
        }
        Ok(())
    }

    /// Handles of the joints, in the order of [`World::joints`].
    #[must_use]
    pub fn joint_handles(&self) -> &[JointHandle] {
        self.state.joints.handles()
    }

    /// The joints.
    #[must_use]
    pub fn joints(&self) -> &[Joint] {
        self.state.joints.values()
    }

    /// Joints that broke in the last call, in the order of time.
    #[must_use]
    pub fn broken_joints(&self) -> &[BrokenJoint] {
        &self.broken
    }

    /// Takes away a joint that bore too much, and tells.
    fn break_joint(&mut self, joint: JointHandle) {
        let time = self.time();
        if let Ok(gone) = self.state.joints.remove(joint) {
            let (bodies, reaction) = (gone.def.bodies, gone.reaction);
            self.broken.push(BrokenJoint { time, joint, def: gone.def, reaction });
            self.forget_soft_joints();
            self.rejoin(bodies);
        }
    }

    /// What ties two bodies has changed: both wake, and what they may touch is looked for anew.
    pub(super) fn rejoin(&mut self, bodies: [Option<BodyHandle>; 2]) {
        self.wake_joined(bodies);
        for body in bodies.into_iter().flatten() {
            if let Ok(i) = self.state.bodies.index(body) {
                self.state.contacts.look_anew(i);
            }
        }
        self.plan = None;
    }

    fn wake_joined(&mut self, bodies: [Option<BodyHandle>; 2]) {
        for body in bodies.into_iter().flatten() {
            if let Ok(i) = self.state.bodies.index(body) {
                self.pushed(i);
            }
        }
    }

    /// Forgets the joints of a body that goes.
    pub(super) fn unjoin(&mut self, body: BodyHandle) {
        self.state.joints.retain(|joint| !joint.def.bodies.contains(&Some(body)));
        self.forget_soft_joints();
    }

    /// Energy (J) in the springs of all joints: Σ ½kC².
    #[must_use]
    pub fn spring_energy(&self) -> Real {
        let State { bodies, joints, .. } = &self.state;
        joints.values().iter().map(|joint| JointRef { bodies, joint }.energy()).sum()
    }
}

/// A joint, to read.
#[derive(Clone, Copy)]
pub struct JointRef<'a> {
    bodies: &'a Bodies,
    joint: &'a Joint,
}

impl<'a> JointRef<'a> {
    /// The definition, with all that was left open when the joint was made.
    #[must_use]
    pub fn def(&self) -> &'a JointDef {
        &self.joint.def
    }

    /// What it does.
    #[must_use]
    pub fn kind(&self) -> &'a JointKind {
        &self.joint.def.kind
    }

    /// k and c of the springs of its rows, row by row; none where a row is no spring.
    #[must_use]
    pub fn springs(&self) -> &'a [Option<Coefficients>; ROWS] {
        &self.joint.springs
    }

    /// The anchors, in the world (m).
    #[must_use]
    pub fn anchors(&self) -> [Vec2; 2] {
        let locals = self.joint.anchors();
        [0, 1].map(|side| match self.index(side) {
            Some(i) => self.bodies.origin(i).apply(locals[side]),
            None => locals[side],
        })
    }

    /// Force (N) on B at its anchor, and torque (N·m) about it, in the last step, on average; A got the opposite.
    #[must_use]
    pub fn reaction(&self) -> Wrench {
        self.joint.reaction
    }

    /// What the joint acts along, and its rate: the length of a distance joint or of the way along an axis (m, m/s), else
    /// the angle of B against A (rad, rad/s), counted from the joint's own angle.
    #[must_use]
    pub fn travel(&self) -> [Real; 2] {
        let pair = self.pair();
        let [a, b] = self.anchors();
        let (apart, rate) = (b - a, self.anchor_rate(&pair));
        let along = |d: Vec2, spin: Real| {
            [d.dot(&apart), d.dot(&rate) + spin * crate::math::perp(d).dot(&apart)]
        };
        match &self.joint.def.kind {
            JointKind::Distance { .. } => {
                let length = apart.norm();
                [length, if length > 0.0 { apart.dot(&rate) / length } else { rate.norm() }]
            }
            JointKind::Prismatic { axis, .. }
            | JointKind::Wheel { axis, .. }
            | JointKind::Rack { axis, .. } => {
                along(pair.rots[0].apply(axis.vector()), pair.twists[0].angular)
            }
            kind => {
                let zero = kind.angle().unwrap_or(0.0);
                let spin = pair.twists[1].angular - pair.twists[0].angular;
                [pair.angles[1] - pair.angles[0] - zero, spin]
            }
        }
    }

    /// Velocity of B's anchor against A's (m/s).
    fn anchor_rate(&self, pair: &Pair) -> Vec2 {
        let law = law_of(self.bodies, self.joint);
        let [a, b] = [0, 1].map(|side| match &self.joint.matter[side] {
            Some(end) => end.velocity,
            None => pair.twists[side].at(pair.rots[side].apply(law.arms[side])),
        });
        b - a
    }

    /// How far the joint is from what it holds: the largest |C| of its rigid rows and of limits that are passed (m, or rad
    /// where it holds an angle).
    #[must_use]
    pub fn gap(&self) -> Real {
        let gap = |row: &crate::constraints::joint::Row| match row.action {
            Action::Hold => row.position.abs(),
            Action::Limit => (-row.position).max(0.0),
            _ => 0.0,
        };
        self.rows().as_slice().iter().map(gap).fold(0.0, Real::max)
    }

    /// Energy in its springs (J): Σ ½kC².
    #[must_use]
    pub fn energy(&self) -> Real {
        let energy = |row: &crate::constraints::joint::Row| match row.action {
            Action::Spring(spring) => 0.5 * spring.stiffness * row.position * row.position,
            _ => 0.0,
        };
        self.rows().as_slice().iter().map(energy).sum()
    }

    /// The rows where the bodies stand.
    fn rows(&self) -> Rows {
        rows_of(self.bodies, self.joint)
    }

    fn pair(&self) -> Pair {
        pair_of(self.bodies, self.joint)
    }

    fn index(&self, side: usize) -> Option<usize> {
        index_of(self.bodies, self.joint, side)
    }
}

/// The rows of a joint where its ends stand.
pub(super) fn rows_of(bodies: &Bodies, joint: &Joint) -> Rows {
    law_of(bodies, joint).rows(&pair_of(bodies, joint))
}

/// Whether a row acts on angles, and on nothing else.
pub(super) fn row_is_turn(row: &crate::constraints::joint::Row) -> bool {
    let acts = row.action != Action::Off && row.bound > 0.0;
    acts && row.jacobian.iter().all(|[x, y, _]| *x == 0.0 && *y == 0.0)
}

/// Place of a joint's body; none: the world.
pub(super) fn index_of(bodies: &Bodies, joint: &Joint, side: usize) -> Option<usize> {
    joint.def.bodies[side].and_then(|body| bodies.index(body).ok())
}

/// A joint as its rows see it.
pub(super) fn law_of(bodies: &Bodies, joint: &Joint) -> Law {
    let anchors = joint.anchors();
    let arms = [0, 1].map(|side| match index_of(bodies, joint, side) {
        Some(i) => anchors[side] - bodies.local_centers[i],
        None => vec2(0.0, 0.0),
    });
    let locals = [0, 1].map(|side| {
        index_of(bodies, joint, side).map_or_else(Vec2::zeros, |i| bodies.local_centers[i])
    });
    let custom = joint.custom.clone();
    Law { kind: joint.def.kind, arms, springs: joint.springs, notch: joint.notch, locals, custom }
}

/// Where the centres of a joint's bodies stand in the world (m); of the world, its anchor.
pub(super) fn centers_of(bodies: &Bodies, joint: &Joint) -> [Vec2; 2] {
    let anchors = joint.anchors();
    [0, 1].map(|side| {
        index_of(bodies, joint, side).map_or(anchors[side], |i| bodies.poses[i].position)
    })
}

/// The bodies of a joint as they stand.
pub(super) fn pair_of(bodies: &Bodies, joint: &Joint) -> Pair {
    let centers = centers_of(bodies, joint);
    let places = [0, 1].map(|side| index_of(bodies, joint, side));
    Pair {
        origin: centers[0],
        centers: [vec2(0.0, 0.0), centers[1] - centers[0]],
        rots: places.map(|i| i.map_or(Rot::IDENTITY, |i| bodies.poses[i].rot())),
        angles: places.map(|i| i.map_or(0.0, |i| bodies.poses[i].angle)),
        twists: places.map(|i| i.map_or(Twist::ZERO, |i| bodies.twists[i])),
    }
}
