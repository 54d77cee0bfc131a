//! Structures that stand.

mod towers;

pub(super) use towers::{LONG, PYRAMID, TEN, TWENTY, ground, tower};
