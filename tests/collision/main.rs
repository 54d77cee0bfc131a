//! The narrow phase: gaps, normals and anchors against references that share no code with it.

mod common;

mod arcs;
mod boxes;
mod chains;
mod separated;
mod symmetry;
