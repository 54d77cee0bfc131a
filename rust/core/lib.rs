//! Two-dimensional physics in double precision that says how wrong it is.
//!
//! A [`World`] owns everything. Bodies are made from a [`BodyDef`] and named by a [`BodyHandle`];
//! time moves on by a fixed step or to a tolerance; energies, momenta and the report of a run can be
//! asked at any moment.
//!
//! ```
//! use culbuto::forces::Air;
//! use culbuto::math::vec2;
//! use culbuto::shapes::Shape;
//! use culbuto::{BodyDef, World};
//!
//! let mut world = World::new(vec2(0.0, -9.81))?;
//! world.set_air(Air { density: 1.2, wind: vec2(-3.0, 0.0) })?;
//! let plank = world.add_body(BodyDef {
//!     velocity: vec2(10.0, 10.0),
//!     angular_velocity: 5.0,
//!     mass: Some(2.0),
//!     ..BodyDef::new(Shape::rectangle(1.0, 0.1)?)
//! })?;
//!
//! let before = world.energy()?;
//! world.steps(1.0 / 60.0, 60)?; // a second at a fixed step
//! world.advance(1.0, 1e-9)?; // and one to a tolerance
//! let change = world.energy()?.balance() - before.balance();
//! assert!(change.abs() < 1e-3 * before.kinetic);
//! println!("{:?}\n{}", world.body(plank)?.position(), world.explain());
//! # Ok::<(), culbuto::Error>(())
//! ```
//!
//! # Map
//!
//! From the ground up: [`math`], [`error`], [`arena`], [`shapes`], [`body`], [`joint`], [`collision`], [`forces`], [`methods`],
//! [`world`], [`builders`], [`observe`], [`scenes`], [`report`]. [`docs`] holds the guide, the architecture and the
//! decisions.

pub mod arena;
pub mod body;
pub mod builders;
pub mod collision;
pub mod constraints;
pub mod error;
pub mod fluid;
pub mod forces;
pub mod islands;
pub mod joint;
pub mod math;
pub mod methods;
pub mod observe;
pub mod report;
pub mod scenes;
pub mod shapes;
pub mod soft;
pub mod solvers;
pub mod world;

pub use body::{BodyDef, BodyHandle, BodyKind, Part};
pub use error::{Error, Result};
pub use joint::{JointDef, JointHandle};
pub use world::World;

/// The pages of the documentation.
pub mod docs {
    #[doc = include_str!("../../docs/guide.md")]
    pub mod guide {}
    #[doc = include_str!("../../docs/architecture.md")]
    pub mod architecture {}
    #[doc = include_str!("../../docs/decisions.md")]
    pub mod decisions {}
    #[doc = include_str!("../../docs/joints.md")]
    pub mod joints {}
    #[doc = include_str!("../../docs/scene-files.md")]
    pub mod scene_files {}
}
