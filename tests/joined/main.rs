//! What joints tie where nothing touches, moved by the methods: orders, exact answers, laws.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // helpers of tests may, as tests do

#[path = "../common/worlds.rs"]
mod worlds;

mod exact;
mod laws;
mod orders;
mod scenes;
