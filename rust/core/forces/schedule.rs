//! Forces that are constant between given times: case 2 of Newton's second law.

use serde::{Deserialize, Serialize};

use crate::arena::{Handle, Named};
use crate::body::BodyHandle;
use crate::error::{Error, Result, check};
use crate::math::{Real, Wrench};

/// A force and torque that change only at given times. Steps end at each of those times, so the
/// motion is as exact as under a constant force.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct ForceSchedule {
    times: Vec<Real>,
    wrenches: Vec<Wrench>,
}

impl ForceSchedule {
    /// `wrenches[i]` acts from `times[i]` until `times[i + 1]` (s, world time); nothing acts outside.
    /// The last time may be infinite.
    ///
    /// # Errors
    /// [`Error::Invalid`] unless there is one time more than there are wrenches, the times increase,
    /// and all numbers are finite.
    pub fn new(times: Vec<Real>, wrenches: Vec<Wrench>) -> Result<Self> {
        if wrenches.is_empty() || times.len() != wrenches.len() + 1 {
            let got = format!("{} times for {} forces", times.len(), wrenches.len());
            return Err(Error::invalid("schedule", got, "at least one force, and one time more"));
        }
        for wrench in &wrenches {
            check::finite_vec("force of the schedule", wrench.force)?;
            check::finite("torque of the schedule", wrench.torque)?;
        }
        let last = times.len() - 1;
        for (i, pair) in times.windows(2).enumerate() {
            check::finite("time of the schedule", pair[0])?;
            if pair[1] <= pair[0] || pair[1].is_nan() {
                let got = format!("{} after {}", pair[1], pair[0]);
                return Err(Error::invalid(
                    format!("time {} of the schedule", i + 1),
                    got,
                    "increasing times",
                ));
            }
        }
        if times[last] != Real::INFINITY {
            check::finite("time of the schedule", times[last])?;
        }
        Ok(Self { times, wrenches })
    }

    /// Times at which the force changes (s).
    #[must_use]
    pub fn times(&self) -> &[Real] {
        &self.times
    }

    /// The wrenches between those times.
    #[must_use]
    pub fn wrenches(&self) -> &[Wrench] {
        &self.wrenches
    }

    /// What acts at a moment; at a time of change, what acts from then on.
    #[must_use]
    pub fn at(&self, time: Real) -> Wrench {
        let after = self.times.partition_point(|t| *t <= time);
        match after {
            0 => Wrench::ZERO,
            i => self.wrenches.get(i - 1).copied().unwrap_or(Wrench::ZERO),
        }
    }

    /// The first change after `time`.
    #[must_use]
    pub fn next_change(&self, time: Real) -> Option<Real> {
        self.times.get(self.times.partition_point(|t| *t <= time)).copied()
    }
}

/// A schedule at work on a body.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Schedule {
    /// The body it acts on, through its centre of mass.
    pub body: BodyHandle,
    /// What acts when.
    pub forces: ForceSchedule,
}

impl Named for Schedule {
    const NAME: &'static str = "force schedule";
}

/// Names a schedule of a world.
pub type ScheduleHandle = Handle<Schedule>;
