//! Claims about bodies that touch.

#![allow(clippy::unwrap_used)] // helpers of tests may, as tests do

mod common;
mod invariance;
mod joined;
mod laws;
mod rest;
mod rollback;
mod seams;
mod solvers;
mod surfaces;
#[path = "../common/worlds.rs"]
mod worlds;
