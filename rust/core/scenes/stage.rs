//! What scenes with contacts share: the ground, the fixed step they are judged at, random numbers.

use super::{Check, Column};
use crate::body::{BodyDef, BodyHandle, BodyKind, Friction, Surface};
use crate::error::Result;
use crate::math::{Pose, Real, Rot, vec2};
use crate::shapes::Shape;
use crate::world::World;

/// Gravity (m/s²).
pub(super) const G: Real = 9.81;
/// The fixed step of the catalogue (s); worlds divide it into 4 substeps.
pub(super) const DT: Real = 1.0 / 60.0;
/// tan α of the incline that several scenes use.
pub(super) const HALF: Real = 0.5;

/// A world under gravity, without anything in it.
pub(super) fn heavy() -> Result<World> {
    World::new(vec2(0.0, -G))
}

/// A surface with one coefficient of friction and no restitution.
pub(super) fn rough(friction: Real) -> Surface {
    Surface { friction: Friction::of(friction), ..Surface::default() }
}

/// A surface without friction.
pub(super) fn smooth(restitution: Real) -> Surface {
    Surface { friction: Friction::of(0.0), restitution, ..Surface::default() }
}

/// Where a body stands on a plane through the origin that falls by `slope` (rad) towards +x: `way` along it,
/// `height` over it, and turned by `turn` against it.
pub(super) fn on_plane(slope: Real, [way, height]: [Real; 2], turn: Real) -> Pose {
    Pose::new(Rot::new(-slope).apply(vec2(way, height)), turn - slope)
}

/// Half of the thickness of the ground (m).
const DEPTH: Real = 0.5;

/// Where the ground is.
pub(super) fn ground(slope: Real) -> Pose {
    on_plane(slope, [0.0, -DEPTH], 0.0)
}

/// Adds the plane as a static box of 200 m.
pub(super) fn add_ground(world: &mut World, slope: Real, surface: Surface) -> Result<BodyHandle> {
    let pose = ground(slope);
    world.add_body(BodyDef {
        kind: BodyKind::Static,
        position: pose.position,
        angle: pose.angle,
        surface,
        ..BodyDef::new(Shape::rectangle(200.0, 2.0 * DEPTH)?)
    })
}

/// A shape on the plane, at rest.
pub(super) fn standing(shape: Shape, pose: Pose, surface: Surface) -> BodyDef {
    BodyDef { position: pose.position, angle: pose.angle, surface, ..BodyDef::new(shape) }
}

/// Something measured at the fixed step.
pub(super) const fn at_fixed_step(
    what: &'static str,
    asked: Real,
    measure: fn() -> Result<Real>,
) -> Check {
    Check { what, column: Column::Fixed, asked, measure }
}

/// Something measured on runs to a tolerance.
pub(super) const fn with_tolerance(
    what: &'static str,
    asked: Real,
    measure: fn() -> Result<Real>,
) -> Check {
    Check { what, column: Column::Tolerance, asked, measure }
}

/// The tolerance of the catalogue's column.
pub(super) const TOLERANCE: Real = 1e-9;

/// Value of a growing condition: the smallest number between two for which it holds.
pub(super) fn threshold(
    [low, high]: [Real; 2],
    holds: impl Fn(Real) -> Result<bool>,
) -> Result<Real> {
    threshold_to(20, [low, high], holds)
}

/// The same, by so many halvings.
pub(super) fn threshold_to(
    halvings: usize,
    [mut low, mut high]: [Real; 2],
    holds: impl Fn(Real) -> Result<bool>,
) -> Result<Real> {
    for _ in 0..halvings {
        let middle = 0.5 * (low + high);
        if holds(middle)? {
            high = middle;
        } else {
            low = middle;
        }
    }
    Ok(0.5 * (low + high))
}

/// Numbers that look random and are always the same: `SplitMix64` (Steele, Lea and Flood, "Fast splittable
/// pseudorandom number generators", 2014).
pub(super) struct Random(pub u64);

impl Random {
    /// The next one, between two numbers.
    pub(super) fn between(&mut self, low: Real, high: Real) -> Real {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^= z >> 31;
        low + (high - low) * ((z >> 11) as Real / (1_u64 << 53) as Real)
    }
}
