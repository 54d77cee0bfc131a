//! Joints in a step: which bodies they tie, what the contact step gets of them, and what it leaves.

use super::{centers_of, index_of, law_of, make};
use crate::body::Bodies;
use crate::error::Result;
use crate::joint::{Joint, JointKind, ROWS};
use crate::math::{Real, Wrench};
use crate::methods::contact_step::{Group, Tie};
use crate::world::{State, World};

/// What a step changes of a joint, kept to go back to.
#[derive(Clone, Copy, Debug)]
pub(in crate::world) struct Memory {
    impulses: [Real; ROWS],
    substep: Real,
    reaction: Wrench,
    notch: Real,
}

impl Memory {
    pub fn of(joint: &Joint) -> Self {
        let Joint { impulses, substep, reaction, notch, .. } = *joint;
        Self { impulses, substep, reaction, notch }
    }

    pub fn put_back(self, joint: &mut Joint) {
        joint.impulses = self.impulses;
        joint.substep = self.substep;
        joint.reaction = self.reaction;
        joint.notch = self.notch;
    }
}

/// The bodies that a joint ties, if it does anything: of one with the world its body twice.
pub(in crate::world) fn tied(bodies: &Bodies, joint: &Joint) -> Option<[u32; 2]> {
    if !joint.rigid {
        return None;
    }
    match [0, 1].map(|side| index_of(bodies, joint, side).map(|i| i as u32)) {
        [Some(a), Some(b)] => Some([a, b]),
        [Some(own), None] | [None, Some(own)] => Some([own, own]),
        [None, None] => None,
    }
}

/// Times as long as the last a substep may be for joints to begin with the forces of the last.
const MOST_LONGER: Real = 1e7;

/// A joint for a group whose bodies stand in these slots; h is the length of a substep.
pub(in crate::world) fn tie(
    bodies: &Bodies,
    (joint, place): (&Joint, u32),
    slots: [Option<u32>; 2],
    h: Real,
) -> Tie {
    let scale = if joint.substep > 0.0 { h / joint.substep } else { 1.0 };
    // What a vastly shorter step swallowed says nothing of a longer one.
    let scale = if scale < MOST_LONGER { scale } else { 0.0 };
    let centers = centers_of(bodies, joint);
    let impulses = joint.impulses.map(|impulse| impulse * scale);
    let mut tie = Tie::new(law_of(bodies, joint), slots, place, impulses);
    (tie.origin, tie.apart) = (centers[0], centers[1] - centers[0]);
    tie.load = joint.reaction.force;
    tie
}

/// Brings what the joints of a group remember back to them, after a span of this duration in substeps of length h.
pub(in crate::world) fn keep(joints: &mut [Joint], group: &Group, (duration, h): (Real, Real)) {
    for tie in &group.ties.list {
        let joint = &mut joints[tie.place as usize];
        (joint.impulses, joint.substep) = (tie.impulses, h);
        let mean = Wrench::new(tie.given.force / duration, tie.given.torque / duration);
        // In a step so short that a force is no number any more there was none.
        let finite = mean.force.norm_squared().is_finite() && mean.torque.is_finite();
        joint.reaction = if finite { mean } else { Wrench::ZERO };
    }
}

impl World {
    /// Moves ratchets on, and takes away joints that had to bear too much.
    ///
    /// # Errors
    /// What the code of a custom joint reported.
    pub(in crate::world) fn settle_joints(&mut self) -> Result<()> {
        let State { bodies, joints, .. } = &mut self.state;
        for custom in joints.values().iter().filter_map(|joint| joint.custom.as_ref()) {
            custom.take_fault()?;
        }
        let mut broken = Vec::new();
        for k in 0..joints.values().len() {
            let (joint, handle) = (&joints.values()[k], joints.handles()[k]);
            let Wrench { force, torque } = joint.reaction;
            let above = |value: Real, most: Option<Real>| most.is_some_and(|most| value > most);
            if above(force.norm(), joint.def.breaking_force)
                || above(torque.abs(), joint.def.breaking_torque)
            {
                broken.push(handle);
            }
            if let JointKind::Ratchet { step, phase } = joint.def.kind {
                let angle = super::pair_of(bodies, joint).angles;
                let passed = make::notch(angle[1] - angle[0], step, phase);
                if (passed - joint.notch) * step > 0.0 {
                    joints.values_mut()[k].notch = passed;
                }
            }
        }
        for handle in broken {
            self.break_joint(handle);
        }
        Ok(())
    }
}
