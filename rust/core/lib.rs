//! Culbuto
pub mod error;
pub mod math;
pub mod shapes;
pub use error::{Error, Result};
