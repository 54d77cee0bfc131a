//! Bodies: what the user writes ([`BodyDef`]), and the columns the engine works on ([`Bodies`]).
//!
//! What a step touches (pose, twist, mass) stands in parallel columns of small structs; what it
//! rarely needs (shapes, names, what resists the motion) stands apart in [`Info`].

mod columns;
mod def;
mod mixing;
mod surface;

pub use columns::{Bodies, Info, Mass};
pub use def::{BodyDef, BodyKind, DragWidth, Locks, Part};
pub use mixing::{ImpactLaw, Mixing, PairOfMaterials, PairSurface, Rule};
pub use surface::{Filter, FilterOverride, Friction, Role, Surface, SurfaceOverride};

use crate::arena::{Handle, Named};

/// A body of a world. Only its [`BodyHandle`] is ever held by the user.
#[derive(Debug)]
pub enum Body {}

impl Named for Body {
    const NAME: &'static str = "body";
}

/// Names a body.
pub type BodyHandle = Handle<Body>;
