//! How rows are solved.

mod block;
pub mod direct;
pub mod sweep;

pub use block::impulses as block_impulses;
