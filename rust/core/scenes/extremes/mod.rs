//! Scenes at the edge of what numbers, sizes and speeds allow: they finish, with no energy from nothing and
//! the same bits every time; and what makes no sense is refused with a message.

mod bounds;
mod crowd;
mod grazing;
mod layout;
mod random;
mod refusals;
mod sameness;
mod sleepers;
mod slivers;
mod steps;

pub(super) use bounds::{GRAVITY, SPIN};
pub(super) use crowd::CROWD;
pub(super) use grazing::GRAZING;
pub(super) use layout::{Layout, pile};
pub(super) use random::{ALL_RANDOM, RANDOM, bin};
pub(super) use refusals::{BAD_MATTER, BAD_OUTLINES};
pub(super) use sameness::{OFFSET, REPEATS, SIZES};
pub(super) use sleepers::SLEEPERS;
pub(super) use slivers::SLIVERS;
pub(super) use steps::STEPS;
