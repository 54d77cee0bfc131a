//! Scene files: a world goes through text and back without losing a bit; what is wrong is named.

#![allow(clippy::unwrap_used, clippy::panic)] // helpers of tests may, as tests do

#[path = "../common/worlds.rs"]
mod worlds;

mod examples;
mod joints;
mod refusals;
mod round_trips;
