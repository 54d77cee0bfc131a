//! What a step or a run took, and the motion it recorded.

use std::ops::Range;

use serde::Serialize;

use crate::body::Bodies;
use crate::math::{Pose, Real, Twist};
use crate::methods::Progress;

/// Time that one stage took.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct StageTime {
    /// Name of the stage.
    pub name: &'static str,
    /// Wall time over the whole call (s).
    pub seconds: f64,
}

/// What the last call took.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StepReport {
    /// World time that passed (s).
    pub duration: Real,
    /// Steps of the methods, summed over the islands; a closed form counts one a call.
    pub steps: u64,
    /// Of the steps, those that Radau's method took in runs to a tolerance, where the motion was stiff.
    pub stiff_steps: u64,
    /// Steps that were tried again because their error was too large.
    pub rejected: u64,
    /// Force evaluations, summed over the islands.
    pub evaluations: u64,
    /// Sweeps over the rows of contacts, summed over islands and substeps.
    pub sweeps: u64,
    /// Systems of the rows of joints solved by the methods, summed over islands.
    pub solves: u64,
    /// Most parts that a substep was divided into because of what joints bear; 256 may not have been enough.
    pub parts: u32,
    /// Factorisations of the rows of contacts and joints together, summed over islands and substeps.
    pub factorisations: u64,
    /// Impacts resolved.
    pub impacts: u64,
    /// Events located in time by runs to a tolerance: shapes that met, contacts that let go, broke away or came to rest.
    pub events: u64,
    /// When (s) and why a run to a tolerance could not go from event to event for the first time: from there on steps were taken twice
    /// for a while, to the same tolerance but with less to say for it.
    pub fallback: Option<(Real, &'static str)>,
    /// Largest change of velocity in the last sweep of a substep (m/s): what the rows of contacts still lack.
    pub residual: Real,
    /// Smallest step (s); infinite where only closed forms were needed.
    pub smallest_step: Real,
    /// Estimated relative error of the call; none where it was not asked for.
    pub estimate: Option<Real>,
    /// Time of each stage, where timing is on.
    pub stages: Vec<StageTime>,
}

impl Default for StepReport {
    fn default() -> Self {
        Self {
            duration: 0.0,
            steps: 0,
            stiff_steps: 0,
            rejected: 0,
            evaluations: 0,
            sweeps: 0,
            solves: 0,
            parts: 1,
            factorisations: 0,
            impacts: 0,
            events: 0,
            fallback: None,
            residual: 0.0,
            smallest_step: Real::INFINITY,
            estimate: None,
            stages: Vec::new(),
        }
    }
}

impl StepReport {
    /// Books what a run to a tolerance took.
    pub(super) fn book_progress(&mut self, progress: &Progress) {
        self.steps += progress.steps;
        self.stiff_steps += progress.stiff;
        self.rejected += progress.rejected;
        self.smallest_step = self.smallest_step.min(progress.smallest);
    }
}

/// The motion of all bodies at a row of times. Row-major: body `i` at time `k` is at `k·bodies + i`.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Trajectory {
    /// World times (s).
    pub times: Vec<Real>,
    /// Number of bodies.
    pub bodies: usize,
    /// Poses of the bodies' frames.
    pub poses: Vec<Pose>,
    /// Velocities of the centres of mass, angular velocities.
    pub twists: Vec<Twist>,
}

impl Trajectory {
    pub(super) fn new(times: Vec<Real>, bodies: &Bodies) -> Self {
        let n = times.len() * bodies.len();
        Self {
            times,
            bodies: bodies.len(),
            poses: vec![Pose::IDENTITY; n],
            twists: vec![Twist::ZERO; n],
        }
    }

    /// Numbers of the times in (from, to], or [from, to] for those that begin at 0.
    pub(super) fn within(&self, from: Real, to: Real) -> Range<usize> {
        // Ends are sums of floating point numbers; a sample that is there but for rounding belongs to it.
        let slack = 8.0 * Real::EPSILON * to;
        let first =
            if from == 0.0 { 0 } else { self.times.partition_point(|t| *t <= from + slack) };
        first..self.times.partition_point(|t| *t <= to + slack)
    }

    /// Writes bodies from `first` on at time `k`.
    pub(super) fn write(&mut self, k: usize, first: usize, poses: &[Pose], twists: &[Twist]) {
        let start = k * self.bodies + first;
        self.poses[start..start + poses.len()].copy_from_slice(poses);
        self.twists[start..start + twists.len()].copy_from_slice(twists);
    }

    /// From the centres of mass to the bodies' frames.
    pub(super) fn in_frames(&mut self, bodies: &Bodies) {
        for (place, pose) in self.poses.iter_mut().enumerate() {
            let local = bodies.local_centers[place % self.bodies];
            if local != crate::math::Vec2::zeros() {
                pose.position -= pose.rot().apply(local);
            }
        }
    }

    /// Counts the times from the world's time 0.
    pub(super) fn shift(&mut self, start: Real) {
        self.times.iter_mut().for_each(|t| *t += start);
    }

    /// Pose of body `i` at time `k`.
    #[must_use]
    pub fn pose(&self, k: usize, i: usize) -> Pose {
        self.poses[k * self.bodies + i]
    }

    /// Twist of body `i` at time `k`.
    #[must_use]
    pub fn twist(&self, k: usize, i: usize) -> Twist {
        self.twists[k * self.bodies + i]
    }
}
