//! Shapes and what follows from them: mass, silhouettes, convex pieces, and what is refused.

#[path = "../common/mod.rs"]
mod common;

mod definitions;
mod mass;
mod pieces;
mod refusals;
mod round;
mod silhouettes;
