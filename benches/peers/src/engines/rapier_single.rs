//! Rapier in single precision.

use rapier2d as engine;

#[allow(clippy::duplicate_mod)] // one adapter, compiled against either crate
#[path = "rapier.rs"]
pub mod adapter;
