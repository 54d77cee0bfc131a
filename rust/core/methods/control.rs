//! What a run to a tolerance is asked for, and what it took.

use crate::forces::BoxError;
use crate::math::{Pose, Real, Twist};

/// Takes samples of a run: the number of the sample, and the state of the run's bodies there.
pub type Sink<'a> = dyn FnMut(usize, &[Pose], &[Twist]) + 'a;

/// Is asked at every step whether to go on; an error stops the run.
pub type Watch<'a> = dyn FnMut() -> Result<(), BoxError> + 'a;

/// What a run to a tolerance is asked for.
pub struct Control<'a> {
    /// Largest local error of a step, relative to the body's size or the way it went (positions), a
    /// radian (angles), and the largest speeds so far.
    pub tolerance: Real,
    /// Sizes ℓ of the bodies (m).
    pub sizes: &'a dyn Fn(usize) -> Real,
    /// Moments at which the state is wanted, in seconds from the start of the span, increasing.
    pub samples: &'a [Real],
}

/// What a run to a tolerance took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Progress {
    /// Steps accepted.
    pub steps: u64,
    /// Steps tried again because their error was too large.
    pub rejected: u64,
    /// Of the steps accepted, those of Radau's method.
    pub stiff: u64,
    /// Smallest step accepted (s); infinite where there was none.
    pub smallest: Real,
    /// Sum of the local errors, in the units of the tolerance.
    pub estimate: Real,
}
