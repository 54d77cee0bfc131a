//! Friction and rolling.

mod bowl;
mod rod;
mod roll;
mod slide;
mod tip;

pub(super) use bowl::BOWL;
pub(super) use rod::{FALLING_ROD, PAINLEVE};
pub(super) use roll::{ROLLING, SLIDE_TO_ROLL};
pub(super) use slide::{BREAKAWAY, CONVEYOR, INCLINE, SLIDING, STOPPING};
pub(super) use tip::{DOMINOES, PUSHED_BOX, TIPPING};
