//! What ends a run to a tolerance before its time.

use crate::error::Result;
use crate::math::Real;
use crate::methods::System;
use crate::methods::first_order::Columns;

/// Looks at each step before it is accepted.
pub trait Guard {
    /// Where in the step, as a fraction of it, the first event is; none: there is none. The columns hold all slopes and the end
    /// of the step.
    fn first(
        &mut self,
        y: &mut Columns,
        system: &mut System<'_>,
        step: (Real, Real),
    ) -> Result<Option<Real>>;

    /// By how much (s) a step that was made to end at the event must be longer to do so.
    fn correct(&mut self, y: &Columns, system: &mut System<'_>, step: (Real, Real))
    -> Result<Real>;
}

/// Where a guarded run ended.
#[derive(Clone, Copy, Debug)]
pub struct Stop {
    /// Time since its start (s).
    pub passed: Real,
    /// Samples that were handed out.
    pub samples: usize,
    /// Whether an event ended it.
    pub early: bool,
}
