//! Joints of a scene file: a [`JointDef`] whose bodies stand by name or by place.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{BodyLabel, wrong};
use crate::body::BodyHandle;
use crate::error::{Error, Result, check};
use crate::joint::{Coefficients, Given, Joint, JointDef, JointKind, ROWS};
use crate::math::{Real, Wrench, vec2};

/// What ties two bodies, or a body and the world.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SceneJoint {
    /// Name; need not be unique.
    #[serde(default)]
    pub name: Option<String>,
    /// A and B, by name or by place; null: the world.
    pub bodies: [Option<BodyLabel>; 2],
    /// Deformable bodies in their place, by name or by place among those.
    #[serde(default)]
    pub soft_bodies: [Option<BodyLabel>; 2],
    /// Where it holds A and B (m).
    #[serde(default = "origins")]
    pub anchors: [Given; 2],
    /// What it does.
    pub joint: JointKind,
    /// Whether A and B can touch each other.
    #[serde(default)]
    pub collide_connected: bool,
    /// Force (N) above which the joint breaks; none: never.
    #[serde(default)]
    pub breaking_force: Option<Real>,
    /// Torque (N·m) above which it breaks; none: never.
    #[serde(default)]
    pub breaking_torque: Option<Real>,
    /// What it has become. Programs write it, so that a world goes on to the bit.
    #[serde(default)]
    pub state: SceneJointState,
}

/// What a joint has become since it was made.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(default, deny_unknown_fields)]
pub struct SceneJointState {
    /// Springs of its rows, as they followed from frequencies where the joint was made; null where a row is no spring.
    pub springs: Vec<Option<Coefficients>>,
    /// Impulses of its rows over the last substep (N·s, N·m·s).
    pub impulses: Vec<Real>,
    /// Length of that substep (s).
    pub substep: Real,
    /// Force (N) on the second body and torque (N·m) about its anchor in the last step: steps are finer under large loads.
    pub reaction: [Real; 3],
    /// The notch at which a ratchet stands (rad); none: the last that its angle has passed.
    pub notch: Option<Real>,
}

fn origins() -> [Given; 2] {
    [Given::Local(vec2(0.0, 0.0)); 2]
}

impl Default for SceneJoint {
    fn default() -> Self {
        Self {
            name: None,
            bodies: [None, None],
            soft_bodies: [None, None],
            anchors: origins(),
            joint: JointKind::Filter,
            collide_connected: false,
            breaking_force: None,
            breaking_torque: None,
            state: SceneJointState::default(),
        }
    }
}

impl SceneJoint {
    /// A joint of a world, whose bodies have these labels.
    pub(super) fn new(joint: &Joint, bodies: [Option<BodyLabel>; 2]) -> Self {
        let JointDef {
            name,
            bodies: _,
            anchors,
            kind,
            collide_connected,
            breaking_force,
            breaking_torque,
        } = joint.def.clone();
        Self {
            name,
            bodies,
            soft_bodies: [None, None],
            anchors,
            joint: kind,
            collide_connected,
            breaking_force,
            breaking_torque,
            state: SceneJointState::of(joint),
        }
    }

    /// The same, holding deformable bodies: their points stand in the world.
    pub(super) fn holding(mut self, soft_bodies: [Option<BodyLabel>; 2]) -> Self {
        for (anchor, _) in
            self.anchors.iter_mut().zip(&soft_bodies).filter(|(_, soft)| soft.is_some())
        {
            *anchor = Given::World(anchor.vector());
        }
        Self { soft_bodies, ..self }
    }

    /// The definition, between these bodies.
    pub(super) fn def(&self, bodies: [Option<BodyHandle>; 2]) -> JointDef {
        JointDef {
            name: self.name.clone(),
            bodies,
            anchors: self.anchors,
            kind: self.joint,
            collide_connected: self.collide_connected,
            breaking_force: self.breaking_force,
            breaking_torque: self.breaking_torque,
        }
    }

    /// An error of the engine's about the joint at a path, as one about the value that is meant, where that is known.
    pub(super) fn wrong(&self, path: &str, error: &Error) -> Error {
        let kind = self.joint.name();
        let what = if let Error::Invalid { what, .. } = error { what.as_str() } else { "" };
        let path = match what {
            "anchor_a" => format!("{path}.anchors[0]"),
            "anchor_b" => format!("{path}.anchors[1]"),
            "the pair of bodies" => format!("{path}.bodies"),
            "the anchor" | "the anchors" => format!("{path}.anchors"),
            "breaking_force" | "breaking_torque" => format!("{path}.{what}"),
            _ => format!("{path}.joint.{kind}"),
        };
        wrong(path, error)
    }
}

impl SceneJointState {
    fn of(joint: &Joint) -> Self {
        let used = |row: usize| joint.springs[row].is_some() || joint.impulses[row] != 0.0;
        let rows = (0..ROWS).rev().find(|row| used(*row)).map_or(0, |row| row + 1);
        let is_ratchet = matches!(joint.def.kind, JointKind::Ratchet { .. });
        let or_none = |any: bool| if any { rows } else { 0 };
        Self {
            springs: joint.springs[..or_none(joint.springs.iter().any(Option::is_some))].to_vec(),
            impulses: joint.impulses[..or_none(joint.impulses.iter().any(|p| *p != 0.0))].to_vec(),
            substep: joint.substep,
            reaction: [joint.reaction.force.x, joint.reaction.force.y, joint.reaction.torque],
            notch: is_ratchet.then_some(joint.notch),
        }
    }

    /// Puts back what a joint that was just made had become.
    ///
    /// # Errors
    /// Of springs and impulses, more than a joint has rows; springs that are none.
    pub(super) fn resume(&self, joint: &mut Joint, path: &str) -> Result<()> {
        let rows = |key: &str, count: usize| {
            if count > ROWS {
                let message = format!("{count} rows; a joint has up to {ROWS}");
                return Err(wrong(format!("{path}.{key}"), message));
            }
            Ok(())
        };
        rows("springs", self.springs.len())?;
        rows("impulses", self.impulses.len())?;
        for (k, Coefficients { stiffness, damping }) in
            self.springs.iter().enumerate().filter_map(|(k, spring)| Some((k, (*spring)?)))
        {
            check::not_negative("stiffness", stiffness)
                .and_then(|_| check::not_negative("damping", damping))
                .map_err(|error| wrong(format!("{path}.springs[{k}]"), error))?;
        }
        check::not_negative("substep", self.substep)
            .map_err(|error| wrong(format!("{path}.substep"), error))?;
        for (k, value) in self.reaction.iter().enumerate() {
            check::finite("reaction", *value)
                .map_err(|error| wrong(format!("{path}.reaction[{k}]"), error))?;
        }
        for (own, spring) in joint.springs.iter_mut().zip(&self.springs) {
            if own.is_some() && spring.is_some() {
                *own = *spring;
            }
        }
        joint.impulses[..self.impulses.len()].copy_from_slice(&self.impulses);
        joint.substep = self.substep;
        let [x, y, torque] = self.reaction;
        joint.reaction = Wrench::new(vec2(x, y), torque);
        joint.notch = self.notch.unwrap_or(joint.notch);
        Ok(())
    }
}
