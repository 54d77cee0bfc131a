//! Newton's second law as a first order system on flat columns: y = (poses, twists, ledger),
//! y' = (twists, accelerations, powers). The Runge–Kutta methods work on it; work and dissipation
//! are quadratures of the same order as the motion.

use crate::error::Result;
use crate::forces::Ledger;
use crate::math::{Pose, Real, Twist};
use crate::methods::{Motion, System};

/// Numbers of one body in each of the two halves of y.
const BODY: usize = 3;

/// State, stages and working columns of a Runge–Kutta method.
#[derive(Clone, Debug, Default)]
pub struct Columns {
    /// y.
    pub state: Vec<Real>,
    /// y at a stage.
    pub stage: Vec<Real>,
    /// y' at each stage.
    pub slopes: Vec<Vec<Real>>,
}

impl Columns {
    /// Loads y from a motion and makes room for the stages.
    pub fn load(&mut self, motion: &Motion<'_>, stages: usize) {
        self.state.clear();
        self.state.extend_from_slice(bytemuck::cast_slice(motion.poses));
        self.state.extend_from_slice(bytemuck::cast_slice(motion.twists));
        self.state.extend([motion.ledger.work, motion.ledger.dissipated]);
        self.stage.resize(self.state.len(), 0.0);
        self.slopes.resize(stages.max(self.slopes.len()), Vec::new());
        for slope in &mut self.slopes {
            slope.resize(self.state.len(), 0.0);
        }
    }

    /// Writes y to a motion.
    pub fn store(&self, motion: &mut Motion<'_>) {
        write(&self.state, motion);
    }

    /// stage = state + h·Σ weights[j]·slopes[j].
    pub fn combine(&mut self, h: Real, weights: &[Real]) {
        self.stage.copy_from_slice(&self.state);
        for (weight, slope) in weights.iter().zip(&self.slopes) {
            if *weight != 0.0 {
                let factor = h * weight;
                self.stage.iter_mut().zip(slope).for_each(|(y, dy)| *y += factor * dy);
            }
        }
    }

    /// Puts the bodies of the state where joints hold; what that takes goes to the ledger of the motion.
    pub fn settle_state(&mut self, system: &mut System<'_>, motion: &mut Motion<'_>) {
        settle(system, &mut self.state, motion);
    }

    /// The same for the stage.
    pub fn settle_stage(&mut self, system: &mut System<'_>, motion: &mut Motion<'_>) {
        settle(system, &mut self.stage, motion);
    }

    /// slopes[j] = y'(time, stage).
    pub fn slope_of_stage(&mut self, j: usize, system: &mut System<'_>, time: Real) -> Result<()> {
        slope(system, time, &self.stage, &mut self.slopes[j])
    }

    /// slopes[j] = y'(time, state).
    pub fn slope_of_state(&mut self, j: usize, system: &mut System<'_>, time: Real) -> Result<()> {
        slope(system, time, &self.state, &mut self.slopes[j])
    }
}

/// Number of bodies in a flat column.
pub fn bodies(y: &[Real]) -> usize {
    (y.len() - 2) / (2 * BODY)
}

/// Poses and twists in a flat column.
pub fn split(y: &[Real]) -> (&[Pose], &[Twist]) {
    let n = BODY * bodies(y);
    (bytemuck::cast_slice(&y[..n]), bytemuck::cast_slice(&y[n..2 * n]))
}

/// The same, to be changed.
pub fn split_mut(y: &mut [Real]) -> (&mut [Pose], &mut [Twist]) {
    let n = BODY * bodies(y);
    let (poses, rest) = y.split_at_mut(n);
    (bytemuck::cast_slice_mut(poses), bytemuck::cast_slice_mut(&mut rest[..n]))
}

/// Writes a flat column to a motion.
pub fn write(y: &[Real], motion: &mut Motion<'_>) {
    let (poses, twists) = split(y);
    motion.poses.copy_from_slice(poses);
    motion.twists.copy_from_slice(twists);
    *motion.ledger = Ledger { work: y[y.len() - 2], dissipated: y[y.len() - 1], ..*motion.ledger };
}

fn settle(system: &mut System<'_>, y: &mut [Real], motion: &mut Motion<'_>) {
    let n = BODY * bodies(y);
    let (poses, rest) = y.split_at_mut(n);
    let (twists, ledger) = rest.split_at_mut(n);
    let taken = system.settle(bytemuck::cast_slice_mut(poses), bytemuck::cast_slice_mut(twists));
    ledger[0] += taken.work;
    ledger[1] += taken.dissipated;
    motion.ledger.correction_work += taken.correction_work;
}

fn slope(system: &mut System<'_>, time: Real, y: &[Real], dy: &mut [Real]) -> Result<()> {
    let (poses, twists) = split(y);
    let n = BODY * poses.len();
    dy[..n].copy_from_slice(&y[n..2 * n]);
    let out: &mut [Twist] = bytemuck::cast_slice_mut(&mut dy[n..2 * n]);
    let power = system.accelerate(time, poses, twists, out)?;
    dy[2 * n] = power.work;
    dy[2 * n + 1] = power.dissipated;
    Ok(())
}
