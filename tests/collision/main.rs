//! The narrow phase: gaps, normals and anchors against references that share no code with it.

#![allow(clippy::unwrap_used, clippy::panic)] // helpers of tests may, as tests do

mod common;

mod arcs;
mod boxes;
mod chains;
mod separated;
mod symmetry;
