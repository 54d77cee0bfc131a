//! Projection: places back to C = 0, then velocities to Jv = 0, each by the least change that masses allow.
//!
//! What a step of a method leaves of either is of the order of its error, so projection does not change the order; without it
//! gaps would grow with time.
//!
//! Hairer, Lubich, Wanner, "Geometric Numerical Integration" (2006), section VII.1.

use super::Joints;
use crate::body::Mass;
use crate::forces::Ledger;
use crate::math::{Pose, Twist, Vec2};

/// Newton steps on places; quadratic near the answer, and no more where joints contradict one another.
const MOST: usize = 20;

/// Solutions for velocities: linear, so one does but for rounding.
const MOST_OF_VELOCITIES: usize = 3;

/// Halvings of a Newton step that leads away.
const HALVINGS: u32 = 6;

impl Joints {
    /// Moves the bodies to where the joints hold, and stops what moves against them. Nothing is done where both
    /// are so but for rounding.
    ///
    /// Returns what that takes: moving bodies under `gravity` and against springs is correction work, stopping them
    /// dissipates.
    pub fn settle(
        &mut self,
        (masses, gravity): (&[Mass], Vec2),
        poses: &mut [Pose],
        twists: &mut [Twist],
    ) -> Ledger {
        let mut ledger = Ledger::default();
        if !self.holds() {
            return ledger;
        }
        self.look(poses, twists);
        if self.gap(poses) > 1.0 {
            let start = self.spring_energy();
            self.start.clear();
            self.start.extend_from_slice(poses);
            self.close(poses, twists);
            ledger.correction_work += self.spring_energy() - start;
            for ((mass, from), to) in masses.iter().zip(&self.start).zip(&*poses) {
                let weight = mass.mass * gravity.component_mul(&mass.gravity_scale);
                ledger.correction_work -= weight.dot(&(to.position - from.position));
            }
        }
        if self.rate(twists) > 1.0 {
            ledger += self.halt(masses, twists);
        }
        ledger
    }

    /// Newton's method on C = 0, with steps that are halved while they lead away.
    fn close(&mut self, poses: &mut [Pose], twists: &[Twist]) {
        let mut gap = self.gap(poses);
        for _ in 0..MOST {
            self.before.clear();
            self.before.extend_from_slice(poses);
            self.factor();
            self.solve(twists, |row, _| -row.position);
            let before = gap;
            let mut part = 1.0;
            for _ in 0..=HALVINGS {
                for ((pose, from), way) in poses.iter_mut().zip(&self.before).zip(&self.response) {
                    pose.position = from.position + way.linear * part;
                    pose.angle = from.angle + way.angular * part;
                }
                self.look(poses, twists);
                gap = self.gap(poses);
                if gap < before {
                    break;
                }
                part *= 0.5;
            }
            if gap >= before {
                poses.copy_from_slice(&self.before);
                self.look(poses, twists);
                return;
            }
            if gap <= 1.0 {
                return;
            }
        }
    }

    /// Takes from the velocities what moves against the rows.
    fn halt(&mut self, masses: &[Mass], twists: &mut [Twist]) -> Ledger {
        let mut ledger = Ledger::default();
        self.factor();
        let mut rate = self.rate(twists);
        for _ in 0..MOST_OF_VELOCITIES {
            self.solve(twists, |row, v| -row.velocity(v));
            let mut gained = 0.0;
            for ((mass, twist), change) in masses.iter().zip(&mut *twists).zip(&self.response) {
                let mean = Twist::new(
                    twist.linear + change.linear * 0.5,
                    twist.angular + change.angular * 0.5,
                );
                gained += mass.mass * change.linear.dot(&mean.linear)
                    + mass.inertia * change.angular * mean.angular;
                *twist += *change;
            }
            let work = self.driving_of_solution(twists);
            ledger.work += work;
            ledger.dissipated += work - gained;
            let before = std::mem::replace(&mut rate, self.rate(twists));
            if rate <= 1.0 || rate > 0.5 * before {
                break;
            }
        }
        ledger
    }
}
