//! Queries of worlds: rays, points, regions, shapes that move, distances, wherever the bodies came from.

#![allow(clippy::unwrap_used, clippy::panic)] // helpers of tests may, as tests do

mod brute;
mod claims;
mod history;
mod refusals;
