//! Detection: which boxes meet, how far shapes are apart, when they touch, what a ray hits.

#![allow(clippy::unwrap_used, clippy::panic)] // helpers of tests may, as tests do

mod broad_phase;
mod cast;
mod distance;
mod figures;
mod impact;
