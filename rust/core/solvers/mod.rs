//! How rows are solved.

mod block;
pub mod direct;
pub mod links;
mod relaxed;
pub mod sweep;

pub use block::impulses as block_impulses;
