//! Shapes and what follows from them: mass, silhouettes, convex pieces, and what is refused.

#![allow(clippy::unwrap_used, clippy::panic)] // helpers of tests may, as tests do

#[path = "../common/mod.rs"]
mod common;

mod chains;
mod definitions;
mod mass;
mod pieces;
mod refusals;
mod round;
mod silhouettes;
