//! Named problems with a known answer. They are part of the product: tests, the report, the command
//! line and Python all use this one copy.

mod drag;
mod extremes;
pub mod file;
mod fluid;
mod friction;
mod gauge;
pub mod hard;
mod impact;
mod joints;
mod matter;
mod newton;
mod orbits;
mod reference;
mod reversal;
mod rotation;
mod soft;
mod stacks;
mod stage;

pub use file::SceneFile;
pub use reference::Reference;

use crate::error::{Error, Result};
use crate::math::{Pose, Real, Vec2, vec2};
use crate::world::{Trajectory, World};

/// A problem, and what to reach on it.
#[derive(Clone, Copy)]
pub struct Scene {
    /// Number in the catalogue ("S3").
    pub id: &'static str,
    /// Name ("fall_with_drag").
    pub name: &'static str,
    /// One line.
    pub title: &'static str,
    /// What it is, and the formula of its answer.
    pub about: &'static str,
    /// Where its answer comes from.
    pub reference: Reference,
    /// What is known of it.
    pub answer: Answer,
    /// What is asked beyond the error of the motion.
    pub checks: &'static [Check],
}

/// What is known of a scene.
#[derive(Clone, Copy)]
pub enum Answer {
    /// The motion of every body.
    Motion(Motion),
    /// Numbers.
    Numbers(fn() -> Result<Vec<Number>>),
}

/// A scene whose motion is known.
#[derive(Clone, Copy)]
pub struct Motion {
    /// Makes the world.
    pub build: fn() -> Result<World>,
    /// The bodies' frames at a time, in body order.
    pub exact: fn(Real) -> Vec<Pose>,
    /// How long it runs (s).
    pub duration: Real,
    /// Fixed step at which it is judged (s), divided into the world's substeps.
    pub dt: Real,
    /// Length that errors are measured against (m).
    pub length: Real,
    /// Largest error allowed at the fixed step.
    pub fixed: Real,
    /// What is asked with a tolerance; none where no run with contacts or joints can be held to one yet.
    pub toleranced: Option<Toleranced>,
    /// What is judged on it.
    pub judged: Judged,
}

/// What is asked of a run with a tolerance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Toleranced {
    /// The tolerance.
    pub tolerance: Real,
    /// Largest error allowed.
    pub error: Real,
}

/// What is judged on a motion.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Judged {
    /// The engine as it comes, and the order of every method.
    AllMethods,
    /// Bodies that smooth joints tie and that touch nothing: the engine as it comes, which moves them by the contact step, the
    /// order of that, and every method that holds joints.
    Joined {
        /// The order of those methods is measured as well. Not on pendulums, where DOP853 comes closer with a slope of 8.2 to 8.3
        /// until rounding hides it.
        orders: bool,
    },
    /// The engine as it comes alone: one step is the whole run.
    AsItComes,
    /// The engine as it comes: bodies that touch or are joined are moved by the contact step, whatever the method.
    Contact {
        /// Its order, 2, is measured. Not where the motion has impacts, or kinks that fall inside a substep.
        order: bool,
    },
}

/// A number with its exact value.
#[derive(Clone, Debug, PartialEq)]
pub struct Number {
    /// What it is.
    pub what: String,
    /// As computed.
    pub value: Real,
    /// As it should be.
    pub exact: Real,
    /// Largest difference allowed, relative to the exact value (to 1 where that is 0).
    pub asked: Real,
}

/// Which column of the catalogue a figure stands in.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Column {
    /// At a fixed step.
    Fixed,
    /// With a tolerance.
    Tolerance,
}

/// Something that is asked of a scene.
#[derive(Clone, Copy)]
pub struct Check {
    /// What is measured.
    pub what: &'static str,
    /// How it is run.
    pub column: Column,
    /// Largest value allowed.
    pub asked: Real,
    /// Measures it.
    pub measure: fn() -> Result<Real>,
}

/// Every scene, in the order of the catalogue.
pub static CATALOGUE: &[&Scene] = &[
    &newton::PROJECTILE,
    &newton::CONSTANT_FORCE,
    &newton::SCHEDULED_FORCE,
    &drag::FALL,
    &drag::COAST,
    &drag::COAST_IN_ONE_STEP,
    &drag::SILHOUETTE,
    &rotation::SPIN_DECAY,
    &joints::SOFT,
    &joints::STIFF,
    &joints::TWO_MASSES,
    &joints::POINT,
    &joints::ROD,
    &joints::DOUBLE,
    &orbits::KEPLER,
    &orbits::CIRCLE,
    &rotation::FREE_SPIN,
    &joints::CHAIN_SWING,
    &rotation::VARYING_TORQUE,
    &joints::UPRIGHT,
    &matter::POLYGONS,
    &reversal::THREE_BODIES,
    &joints::CATENARY,
    &joints::LOADED_CHAIN,
    &joints::GRAB,
    &joints::MINUTE,
    &joints::LONG,
    &joints::ANGLE,
    &joints::SUSPENSION,
    &joints::ATWOOD,
    &joints::GEARS,
    &joints::RACK,
    &joints::SLIDER,
    &joints::MOTOR,
    &joints::RATCHET,
    &joints::FRICTION,
    &joints::ROPE,
    &joints::BEAM,
    &joints::BOUNDED_GRAB,
    &joints::PLATFORM,
    &impact::DROPS,
    &impact::ELASTIC_BALL,
    &impact::HEAD_ON,
    &impact::SMOOTH_DISKS,
    &impact::CRADLE,
    &impact::OBLIQUE,
    &impact::GALPERIN,
    &impact::BILLIARD,
    &impact::GAS,
    &impact::BULLETS,
    &friction::INCLINE,
    &friction::SLIDING,
    &friction::STOPPING,
    &friction::BREAKAWAY,
    &friction::ROLLING,
    &friction::SLIDE_TO_ROLL,
    &friction::TIPPING,
    &friction::PUSHED_BOX,
    &friction::FALLING_ROD,
    &friction::PAINLEVE,
    &friction::CONVEYOR,
    &friction::BOWL,
    &friction::DOMINOES,
    &stacks::TEN,
    &stacks::TWENTY,
    &stacks::PYRAMID,
    &stacks::TALL[0],
    &stacks::TALL[1],
    &stacks::TOP_HEAVY,
    &stacks::RATIOS,
    &stacks::CARDS,
    &stacks::OVERHANG,
    &joints::RATIOS,
    &joints::STIFFNESS,
    &extremes::GRAVITY,
    &extremes::SIZES,
    &extremes::SLIVERS,
    &extremes::SPIN,
    &extremes::OFFSET,
    &extremes::CROWD,
    &extremes::BAD_OUTLINES,
    &extremes::STEPS,
    &extremes::BAD_MATTER,
    &extremes::SLEEPERS,
    &extremes::GRAZING,
    &extremes::REPEATS,
    &extremes::RANDOM,
    &fluid::COLUMN,
    &fluid::FLOATING,
    &fluid::RISING,
    &fluid::DAM,
    &fluid::POISEUILLE,
    &fluid::COUETTE,
    &fluid::MOMENTUM,
    &soft::END_LOAD,
    &soft::OWN_WEIGHT,
    &soft::AXIAL,
    &soft::LARGE,
    &soft::PATCH,
    &soft::RIGID,
    &soft::AREA,
    &soft::RANDOM,
    &soft::PRESS,
    &soft::STAIRS,
    &soft::BALLOON,
    &soft::CART,
    &soft::ROPES,
];

/// Scenes that take minutes; `make test-full` runs them.
pub static LONG: &[&Scene] = &[
    &stacks::LONG[0],
    &stacks::LONG[1],
    &stacks::LONG[2],
    &extremes::ALL_RANDOM[0],
    &extremes::ALL_RANDOM[1],
    &extremes::ALL_RANDOM[2],
    &extremes::ALL_RANDOM[3],
    &extremes::ALL_RANDOM[4],
    &extremes::ALL_RANDOM[5],
    &extremes::ALL_RANDOM[6],
    &extremes::ALL_RANDOM[7],
    &extremes::ALL_RANDOM[8],
    &extremes::ALL_RANDOM[9],
    &soft::MINUTES[0],
    &soft::MINUTES[1],
    &soft::MINUTES[2],
    &soft::MINUTES[3],
    &soft::MINUTES[4],
];

/// The scene of this id or name, whatever the case.
///
/// # Errors
/// [`Error::Invalid`] with the scenes there are.
pub fn scene(name: &str) -> Result<&'static Scene> {
    let same = |own: &str| own.eq_ignore_ascii_case(name);
    let all = CATALOGUE.iter().chain(LONG);
    let found = all.copied().find(|scene| same(scene.id) || same(scene.name));
    found.ok_or_else(|| {
        let names: Vec<_> = CATALOGUE.iter().map(|s| format!("{} ({})", s.name, s.id)).collect();
        Error::invalid("scene", format!("{name:?}"), names.join(", "))
    })
}

impl Motion {
    /// Largest error of a recorded motion: (|x − x_ref| + ℓ|θ − θ_ref|)/L over times and bodies, ℓ the
    /// body's size and L the scene's length.
    #[must_use]
    pub fn error(&self, world: &World, motion: &Trajectory) -> Real {
        let mut worst: Real = 0.0;
        for (k, time) in motion.times.iter().enumerate() {
            for (i, exact) in (self.exact)(*time).iter().enumerate() {
                let (pose, size) = (motion.pose(k, i), world.bodies().infos[i].size);
                let apart = (pose.position - exact.position).norm()
                    + size * (pose.angle - exact.angle).abs();
                worst = if apart.is_nan() { Real::INFINITY } else { worst.max(apart) };
            }
        }
        worst / self.length
    }
}

impl Number {
    /// Difference from the exact value, relative to it (to 1 where it is 0).
    #[must_use]
    pub fn error(&self) -> Real {
        (self.value - self.exact).abs() / if self.exact == 0.0 { 1.0 } else { self.exact.abs() }
    }
}

/// A pose that is not turned.
fn at(x: Real, y: Real) -> Pose {
    Pose::new(vec2(x, y), 0.0)
}

/// A world without gravity.
fn weightless() -> Result<World> {
    World::new(Vec2::zeros())
}
