//! How bodies move until the next event: on parabolas, or on the dense output of a step.

use crate::collision::Frame;
use crate::math::{Pose, Real, Twist};
use crate::methods::dop853_dense::Dense;

/// The motion of an island's bodies over a while.
pub trait Path {
    /// Where a body is after a time (s), and how it moves.
    fn body(&self, slot: u32, time: Real) -> (Pose, Twist);

    /// How a body accelerates then.
    fn acceleration(&self, slot: u32, time: Real) -> Twist;

    /// The largest accelerations of a body on the way (m/s², rad/s²).
    fn bend(&self, slot: u32) -> [Real; 2];

    /// Frames of two bodies.
    fn frames(&self, slots: [u32; 2], time: Real) -> [Frame; 2] {
        slots.map(|slot| Frame::of(&self.body(slot, time).0))
    }
}

/// Constant accelerations.
pub struct Free<'a> {
    /// Where bodies start.
    pub poses: &'a [Pose],
    /// How they start.
    pub twists: &'a [Twist],
    /// Their accelerations.
    pub accelerations: &'a [Twist],
}

impl Path for Free<'_> {
    fn body(&self, slot: u32, h: Real) -> (Pose, Twist) {
        let i = slot as usize;
        let (pose, twist, a) = (&self.poses[i], &self.twists[i], &self.accelerations[i]);
        // As the closed form has it.
        let way = twist.linear * h + a.linear * (0.5 * h * h);
        let turn = twist.angular * h + 0.5 * a.angular * h * h;
        let end = Twist::new(twist.linear + a.linear * h, twist.angular + a.angular * h);
        (Pose::new(pose.position + way, pose.angle + turn), end)
    }

    fn acceleration(&self, slot: u32, _: Real) -> Twist {
        self.accelerations[slot as usize]
    }

    fn bend(&self, slot: u32) -> [Real; 2] {
        let a = &self.accelerations[slot as usize];
        [a.linear.norm(), a.angular.abs()]
    }
}

/// A step of DOP853.
pub struct Step<'a> {
    /// Its dense output.
    pub dense: &'a Dense,
    /// Its length (s).
    pub h: Real,
    /// Largest accelerations over its stages.
    pub bends: &'a [[Real; 2]],
}

impl Path for Step<'_> {
    fn body(&self, slot: u32, time: Real) -> (Pose, Twist) {
        self.dense.body(slot as usize, time / self.h)
    }

    fn acceleration(&self, slot: u32, time: Real) -> Twist {
        const PART: Real = 1e-3;
        let x = (time / self.h).clamp(PART, 1.0 - PART);
        let [before, after] = [x - PART, x + PART].map(|x| self.dense.body(slot as usize, x).1);
        let per = 1.0 / (2.0 * PART * self.h);
        Twist::new((after.linear - before.linear) * per, (after.angular - before.angular) * per)
    }

    fn bend(&self, slot: u32) -> [Real; 2] {
        // Between the stages it may be a little more.
        self.bends[slot as usize].map(|a| 1.5 * a)
    }
}
