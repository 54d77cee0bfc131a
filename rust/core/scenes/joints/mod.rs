//! Joints and springs.

mod chains;
mod drives;
mod elliptic;
mod extremes;
mod pendulums;
mod springs;
mod statics;
mod transmissions;

pub(super) use chains::{CATENARY, CHAIN_SWING, LOADED_CHAIN};
pub(super) use drives::{BOUNDED_GRAB, FRICTION, MOTOR, RATCHET, SLIDER};
pub(super) use extremes::{RATIOS, STIFFNESS};
pub(super) use pendulums::{DOUBLE, MINUTE, POINT, ROD, UPRIGHT};
pub(super) use springs::{ANGLE, GRAB, LONG, SOFT, STIFF, SUSPENSION, TWO_MASSES};
pub(super) use statics::{BEAM, PLATFORM, ROPE};
pub(super) use transmissions::{ATWOOD, GEARS, RACK};

use super::gauge::worse;
use super::stage::DT;
use super::{Judged, Toleranced};
use crate::body::{BodyDef, BodyHandle, Filter};
use crate::error::Result;
use crate::joint::{JointDef, JointHandle};
use crate::math::{Real, Vec2};
use crate::shapes::Shape;
use crate::world::World;

/// Bodies that are joined and touch nothing.
const APART: Filter = Filter { category: 1, mask: 0, group: 0 };

/// What is judged where rows of joints have bounds.
const BOUNDED: Judged = Judged::Contact { order: true };

/// What is asked of a run with a tolerance, where no row has a bound.
const TOLERANCED: Option<Toleranced> = Some(Toleranced { tolerance: 1e-12, error: 1e-9 });

/// A thin rod along its own x axis: I = mℓ²/12.
fn rod(length: Real, mass: Real, position: Vec2) -> Result<BodyDef> {
    Ok(BodyDef {
        position,
        mass: Some(mass),
        inertia: Some(mass * length * length / 12.0),
        filter: APART,
        ..BodyDef::new(Shape::rectangle(length, 0.01 * length)?)
    })
}

/// A disk: I = mr²/2.
fn disk(radius: Real, mass: Real, position: Vec2) -> Result<BodyDef> {
    let shape = Shape::circle(radius)?;
    Ok(BodyDef { position, mass: Some(mass), filter: APART, ..BodyDef::new(shape) })
}

/// Pins a body to another or to the world where a point is now.
fn pin(
    world: &mut World,
    a: Option<BodyHandle>,
    b: BodyHandle,
    point: Vec2,
) -> Result<JointHandle> {
    world.add_joint(JointDef::revolute(a, b).at(point))
}

/// What a run with joints has shown.
#[derive(Clone, Copy, Debug, Default)]
struct Seen {
    /// Largest gap of a joint (m or rad).
    gap: Real,
    /// Largest |E − E₀ − work| (J): what joints that only hold must keep.
    energy: Real,
    /// Largest E − E₀ − work (J).
    gained: Real,
    /// Largest change of E − work − correction_work + dissipated (J).
    unbalanced: Real,
}

/// Runs a world at the fixed step and looks after each step.
fn watch(world: &mut World, seconds: Real) -> Result<Seen> {
    let start = world.energy()?;
    let mut seen = Seen::default();
    for _ in 0..(seconds / DT).round() as u32 {
        world.step(DT)?;
        let now = world.energy()?;
        let more = now.total() - now.work - start.total() + start.work;
        seen.energy = worse(seen.energy, more.abs());
        seen.gained = worse(seen.gained, more);
        seen.unbalanced = worse(seen.unbalanced, (now.balance() - start.balance()).abs());
        seen.gap = worse(seen.gap, widest(world)?);
    }
    Ok(seen)
}

/// The largest gap of a joint.
fn widest(world: &World) -> Result<Real> {
    let mut gap = 0.0;
    for joint in world.joint_handles() {
        gap = worse(gap, world.joint(*joint)?.gap());
    }
    Ok(gap)
}
