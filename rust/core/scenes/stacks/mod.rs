//! Structures that stand.

mod hard;
mod towers;

pub(super) use hard::{CARDS, OVERHANG, RATIOS, TALL, TOP_HEAVY};
pub(super) use towers::{LONG, PYRAMID, TEN, TWENTY, ground, tower};
