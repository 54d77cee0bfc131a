//! Ragdolls.

use super::Assembly;
use super::plan::{Plan, Side};
use crate::body::{BodyDef, BodyHandle, Filter};
use crate::error::{Error, Result, check};
use crate::joint::{Given, JointDef, JointHandle, JointKind, Motor, Spring, Travel};
use crate::math::{Pose, Real, Vec2, vec2};
use crate::shapes::Shape;
use crate::world::World;

/// The bones of a ragdoll, in the order of its bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[expect(missing_docs, reason = "the names say it")]
pub enum Bone {
    Pelvis,
    Chest,
    Head,
    LeftUpperArm,
    LeftForearm,
    RightUpperArm,
    RightForearm,
    LeftThigh,
    LeftShin,
    RightThigh,
    RightShin,
}

/// What a bone is like: lengths in parts of the height, masses in parts of the whole (D. A. Winter, "Biomechanics and motor
/// control of human movement", 2009, table 4.1, after Drillis and Contini), hands and feet being part of forearms and shins.
struct Figure {
    name: &'static str,
    /// What it hangs on, and at which height.
    parent: Option<(Bone, Real)>,
    /// Heights of the ends of the capsule's core.
    core: [Real; 2],
    radius: Real,
    mass: Real,
    /// Of its angle against its parent, facing right (rad).
    limits: [Real; 2],
}

const BONES: [Figure; 11] = [
    bone("pelvis", None, [0.53, 0.585], (0.06, 0.142), [0.0, 0.0]),
    bone("chest", Some((Bone::Pelvis, 0.6)), [0.64, 0.77], (0.07, 0.355), [-1.2, 0.4]),
    bone("head", Some((Bone::Chest, 0.83)), [0.88, 0.945], (0.055, 0.081), [-0.8, 0.8]),
    bone("left upper arm", SHOULDER, [0.614, 0.8], (0.025, 0.028), [-0.9, 3.0]),
    bone("left forearm", Some((Bone::LeftUpperArm, 0.614)), FOREARM, (0.022, 0.022), [0.0, 2.5]),
    bone("right upper arm", SHOULDER, [0.614, 0.8], (0.025, 0.028), [-0.9, 3.0]),
    bone("right forearm", Some((Bone::RightUpperArm, 0.614)), FOREARM, (0.022, 0.022), [0.0, 2.5]),
    bone("left thigh", HIP, [0.285, 0.53], (0.04, 0.1), [-0.4, 2.0]),
    bone("left shin", Some((Bone::LeftThigh, 0.285)), [0.03, 0.285], (0.03, 0.061), [-2.4, 0.0]),
    bone("right thigh", HIP, [0.285, 0.53], (0.04, 0.1), [-0.4, 2.0]),
    bone("right shin", Some((Bone::RightThigh, 0.285)), [0.03, 0.285], (0.03, 0.061), [-2.4, 0.0]),
];

const SHOULDER: Option<(Bone, Real)> = Some((Bone::Chest, 0.8));
const HIP: Option<(Bone, Real)> = Some((Bone::Pelvis, 0.53));
const FOREARM: [Real; 2] = [0.385, 0.614];

const fn bone(
    name: &'static str,
    parent: Option<(Bone, Real)>,
    core: [Real; 2],
    (radius, mass): (Real, Real),
    limits: [Real; 2],
) -> Figure {
    Figure { name, parent, core, radius, mass, limits }
}

/// A human figure of eleven capsules and ten hinges, seen from the side, standing upright.
#[derive(Clone, Debug, PartialEq)]
pub struct RagdollDef {
    /// Bodies are called "`name` pelvis" and so on, joints after the bone that they hang on its parent.
    pub name: String,
    /// Where the soles stand (m).
    pub position: Vec2,
    /// Turn of the whole about that point (rad).
    pub angle: Real,
    /// Velocity of all bones (m/s).
    pub velocity: Vec2,
    /// Height (m).
    pub height: Real,
    /// Mass of the whole (kg).
    pub mass: Real,
    /// Faces left instead of right: all limits the other way.
    pub faces_left: bool,
    /// Whether the hinges have limits.
    pub limits: bool,
    /// Draws every hinge back to the upright pose; none: nothing does.
    pub spring: Option<Spring>,
    /// Torque with which every hinge resists turning (N·m).
    pub friction_torque: Real,
    /// Collision group of all bones: below 0 they never touch each other. None: a group of its own.
    pub group: Option<i32>,
    /// Force (N) above which a hinge breaks; none: never.
    pub breaking_force: Option<Real>,
    /// Surface, filter, damping and the like of all bones. Place, shape, mass and group come from the ragdoll.
    pub body: BodyDef,
}

/// A ragdoll in a world.
#[derive(Clone, Debug, PartialEq)]
pub struct Ragdoll {
    /// Bodies in the order of [`Bone`], and the hinges by which all but the pelvis hang on their parents.
    pub parts: Assembly,
}

impl Ragdoll {
    /// The body of a bone.
    #[must_use]
    pub fn bone(&self, bone: Bone) -> BodyHandle {
        self.parts.bodies[bone as usize]
    }

    /// The hinge by which a bone hangs on its parent; the pelvis has none.
    #[must_use]
    pub fn hinge(&self, bone: Bone) -> Option<JointHandle> {
        (bone as usize).checked_sub(1).map(|k| self.parts.joints[k])
    }
}

impl RagdollDef {
    /// A ragdoll of this height (m) and mass (kg) with limits, and neither springs nor friction.
    #[must_use]
    pub fn new(height: Real, mass: Real) -> Self {
        Self {
            name: "ragdoll".into(),
            position: vec2(0.0, 0.0),
            angle: 0.0,
            velocity: vec2(0.0, 0.0),
            height,
            mass,
            faces_left: false,
            limits: true,
            spring: None,
            friction_torque: 0.0,
            group: None,
            breaking_force: None,
            body: BodyDef::default(),
        }
    }

    /// Adds the ragdoll.
    ///
    /// # Errors
    /// [`Error::Invalid`] for numbers that are not allowed. The world stays as it was.
    pub fn build(&self, world: &mut World) -> Result<Ragdoll> {
        check::positive("height", self.height)?;
        check::positive("mass", self.mass)?;
        check::finite_vec("position", self.position)?;
        check::finite("angle", self.angle)?;
        check::not_negative("friction_torque", self.friction_torque)?;
        let group = self.group.map_or_else(|| free_group(world), Ok)?;
        let feet = Pose::new(self.position, self.angle);
        let mut plan = Plan::default();
        for bone in &BONES {
            plan.body(self.body_of(bone, &feet, group)?);
        }
        for (k, bone) in BONES.iter().enumerate() {
            if let Some((parent, height)) = bone.parent {
                let sides = [Side::New(parent as usize), Side::New(k)];
                plan.joint(sides, self.hinge_of(bone, &BONES[parent as usize], height));
            }
        }
        Ok(Ragdoll { parts: plan.add(world)? })
    }

    fn body_of(&self, bone: &Figure, feet: &Pose, group: i32) -> Result<BodyDef> {
        let [low, high] = bone.core;
        let half = vec2(0.0, 0.5 * (high - low) * self.height);
        let shape = Shape::capsule(-half, half, bone.radius * self.height)?;
        Ok(BodyDef {
            name: Some(format!("{} {}", self.name, bone.name)),
            position: feet.apply(vec2(0.0, bone.middle() * self.height)),
            angle: self.angle,
            velocity: self.velocity,
            shapes: vec![shape.into()],
            mass: Some(bone.mass * self.mass),
            filter: Filter { group, ..self.body.filter },
            ..self.body.clone()
        })
    }

    fn hinge_of(&self, bone: &Figure, parent: &Figure, height: Real) -> JointDef {
        let at = |bone: &Figure| Given::Local(vec2(0.0, (height - bone.middle()) * self.height));
        let [low, high] = bone.limits;
        let limits = if self.faces_left { [-high, -low] } else { [low, high] };
        let torque = self.friction_torque;
        let travel = Travel {
            limits: self.limits.then_some(limits),
            motor: (torque > 0.0).then_some(Motor { speed: 0.0, max: Some(torque) }),
            spring: self.spring,
            rest: 0.0,
        };
        JointDef {
            name: Some(format!("{} {}", self.name, bone.name)),
            anchors: [at(parent), at(bone)],
            breaking_force: self.breaking_force,
            ..JointDef::new(None, None, JointKind::Revolute { angle: Some(0.0), travel })
        }
    }
}

impl Figure {
    /// Height of its middle.
    const fn middle(&self) -> Real {
        0.5 * (self.core[0] + self.core[1])
    }
}

/// A group below all those in use.
fn free_group(world: &World) -> Result<i32> {
    let groups = world.bodies().infos.iter().flat_map(|info| {
        let own = info.def.shapes.iter().filter_map(|part| part.filter.group);
        own.chain([info.def.filter.group])
    });
    let lowest = groups.fold(0, i32::min);
    lowest.checked_sub(1).ok_or_else(|| {
        Error::invalid("group", "left open", "a number, since the lowest there is, is in use")
    })
}
