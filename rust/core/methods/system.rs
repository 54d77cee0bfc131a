//! What moves bodies: the forces on them, and the joints that hold them.

use crate::error::Result;
use crate::forces::{Forces, Ledger};
use crate::math::{Pose, Real, Twist};
use crate::methods::Motion;
use crate::methods::events::Modes;
use crate::methods::joined::Joints;

/// Forces, and joints where the bodies have any.
pub struct System<'a> {
    /// The forces.
    pub forces: Forces<'a>,
    /// The joints, none of which has a bound on what it may use.
    pub joints: Option<&'a mut Joints>,
    /// What touches and what joints hold, together; then `joints` is none.
    pub modes: Option<Box<Modes>>,
}

impl System<'_> {
    /// Accelerations by everything, and the power that goes to work and to dissipation (W).
    pub fn accelerate(
        &mut self,
        time: Real,
        poses: &[Pose],
        twists: &[Twist],
        out: &mut [Twist],
    ) -> Result<Ledger> {
        let mut power = self.forces.accelerate(time, poses, twists, out)?;
        if let Some(joints) = &mut self.joints {
            power += joints.accelerate(poses, twists, out);
        }
        if let Some(modes) = &mut self.modes {
            power += modes.accelerate(poses, twists, out);
        }
        Ok(power)
    }

    /// Puts the bodies where the joints hold, and stops what moves against them; returns what that took (J).
    pub fn settle(&mut self, poses: &mut [Pose], twists: &mut [Twist]) -> Ledger {
        let weights = (self.forces.masses, self.forces.gravity);
        match (&mut self.joints, &mut self.modes) {
            (Some(joints), _) => joints.settle(weights, poses, twists),
            (_, Some(modes)) => modes.settle(weights, poses, twists),
            _ => Ledger::default(),
        }
    }

    /// The same for a motion, and books it.
    pub fn settle_motion(&mut self, motion: &mut Motion<'_>) {
        *motion.ledger += self.settle(motion.poses, motion.twists);
    }
}
