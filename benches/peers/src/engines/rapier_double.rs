//! Rapier in double precision.

use rapier2d_f64 as engine;

#[path = "rapier.rs"]
pub mod adapter;
