//! Claims about joints.

#![allow(clippy::unwrap_used)] // helpers of tests may, as tests do

mod bounds;
mod common;
mod contacts;
mod edits;
mod laws;
mod refusals;
mod repeats;
mod symmetry;
mod taut;
#[path = "../common/worlds.rs"]
mod worlds;
