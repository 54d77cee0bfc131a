//! Structures that stand.

mod hard;
mod towers;

pub(super) use hard::{CARDS, OVERHANG, RATIOS, TALL, TOP_HEAVY, bricks, house};
pub(super) use towers::{LONG, PYRAMID, TEN, TWENTY, boxes, ground, pyramid, tower};
