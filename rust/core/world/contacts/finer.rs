//! Finer substeps for groups whose joints bear so much that their substep could not follow: a heavy load on a light chain,
//! a fast whip. All others keep theirs.

use crate::error::Result;
use crate::math::Real;
use crate::methods::Span;
use crate::methods::contact_step::joints;
use crate::world::World;

/// ωh of the loads up to which a substep follows them; it would not be stable beyond 2.
const FOLLOWED: Real = 1.0;

/// A run that turns out to be this many times beyond is taken again.
const BEYOND: Real = 1.5;

/// Most parts of a substep, and most times as many in the next attempt.
const MOST: u32 = 256;
const MORE: u32 = 8;

impl World {
    /// Moves group k through a span, in substeps as fine as its joints' loads ask for.
    pub(super) fn advance_group(&mut self, k: usize, span: Span) -> Result<()> {
        self.gather(k, span);
        if !self.scratch.soft.members.is_empty() {
            self.save_members();
        }
        // To a tolerance, steps are as short as their error asks, which sees what grows.
        let most = if self.report.estimate.is_some() { 1 } else { MOST };
        let mut parts = self.parts(span.h()).min(most.into()).ceil().max(1.0) as u32;
        let mut first = true;
        loop {
            let fine = Span { substeps: span.substeps * parts, ..span };
            if !first || parts > 1 {
                self.keep_solver();
                self.gather(k, fine);
            }
            first = false;
            let outcome = self.step_group(fine);
            let Ok(outcome) = outcome else {
                self.keep_solver();
                return outcome.map(drop);
            };
            joints::take_loads(&mut self.scratch.contacts.group, span.duration);
            let needed = self.parts(span.h());
            if needed <= BEYOND * Real::from(parts) || parts == most {
                self.keep_solver();
                self.scatter(outcome, fine);
                self.report.parts = self.report.parts.max(parts);
                return Ok(());
            }
            parts = needed.min(Real::from(parts * MORE)).min(most.into()).ceil() as u32;
        }
    }

    /// Into how many parts a substep of length h must be divided for the loads of the group at hand.
    fn parts(&mut self, h: Real) -> Real {
        joints::turning_rate(&mut self.scratch.contacts.group) * h / FOLLOWED
    }
}
