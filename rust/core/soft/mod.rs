//! Deformable bodies: meshes of a material that gives way, ropes, and what is filled with gas.
//!
//! Forces are gradients of an energy ([`Material`]), steps keep it, and the contact step sees a body as
//! [`crate::constraints::Matter`].

mod body;
mod def;
mod factor;
mod gas;
mod material;
mod mesh;
mod plastic;
mod relax;
mod rod;
mod spot;
mod step;
mod tensor;
#[cfg(test)]
mod tests;
mod triangle;
mod triangulate;

pub use body::{Moving, SoftBody, SoftHandle};
pub use def::{Rope, SoftDef};
pub use gas::Gas;
pub use material::{Material, Moduli, Plane};
pub use mesh::Mesh;
pub use spot::Spot;
