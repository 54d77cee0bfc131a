//! Culbuto
pub mod arena;
pub mod body;
pub mod error;
pub mod forces;
pub mod math;
pub mod methods;
pub mod observe;
pub mod report;
pub mod scenes;
pub mod shapes;
pub mod world;

pub use body::{BodyDef, BodyHandle, BodyKind, Part};
pub use error::{Error, Result};
pub use world::World;
