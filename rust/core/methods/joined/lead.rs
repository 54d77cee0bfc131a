//! Impulses where bodies stand that lead them to where the joints hold.

use super::Joints;
use crate::math::{Pose, Real, Twist, Wrench};

impl Joints {
    /// From now on reactions are averages over a time (s).
    pub fn average_over(&mut self, duration: Real) {
        self.share = 1.0 / duration;
        self.reactions.fill(Wrench::ZERO);
    }

    /// Begins with no impulses, on rows that were looked at and factored; returns their gap.
    pub fn begin_leading(&mut self, poses: &[Pose]) -> Real {
        self.led.clear();
        self.led.resize(self.held.len(), [0.0; 3]);
        self.gap(poses)
    }

    /// Looks at rows ahead, and sets those aside that impulses act on; returns the gap ahead.
    pub fn look_ahead(&mut self, poses: &[Pose], twists: &[Twist]) -> Real {
        self.look_back();
        self.look(poses, twists);
        self.gap(poses)
    }

    /// Impulses that would close the gap ahead in a time h if bodies did not turn, on top of those before.
    pub fn lead(&mut self, twists: &[Twist], h: Real) {
        self.solve(twists, |row, _| -row.position / h);
        for (sum, impulse) in self.led.iter_mut().zip(&self.impulses) {
            sum.iter_mut().zip(impulse).for_each(|(sum, impulse)| *sum += impulse);
        }
    }

    /// Goes back to the rows that impulses act on.
    pub fn look_back(&mut self) {
        std::mem::swap(&mut self.rows, &mut self.aside.0);
        std::mem::swap(&mut self.rots, &mut self.aside.1);
    }

    /// Makes all impulses that led there the solution.
    pub fn end_leading(&mut self) {
        self.impulses.clone_from(&self.led);
    }

    /// Takes from velocities what moves against the rows.
    pub fn stop(&mut self, twists: &mut [Twist]) {
        if self.holds() {
            self.solve(twists, |row, v| -row.velocity(v));
            twists.iter_mut().zip(&self.response).for_each(|(twist, change)| *twist += *change);
        }
    }
}
