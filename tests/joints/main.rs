//! Joints: what they hold, and what they keep.
mod common;
mod trial;
