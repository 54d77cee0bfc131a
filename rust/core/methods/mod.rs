//! How bodies move through time. One file a method; each states its facts in one line of the
//! [`REGISTRY`], from which names, documentation and the tests of order come.

mod adaptive;
pub mod closed_form;
pub mod contact_step;
mod control;
mod dop853;
mod dop853_dense;
mod dop853_table;
pub mod events;
mod explicit_euler;
mod first_order;
mod guard;
mod jacobian;
pub mod joined;
mod leapfrog;
mod lu;
mod radau5;
mod rattle;
mod rk4;
mod scale;
mod semi_implicit_euler;
mod step_size;
mod stiffness;
mod system;
mod trapezoid;
mod yoshida;

pub use adaptive::Adaptive;
pub use control::{Control, Progress, Sink, Watch};
pub use system::System;

use crate::error::{Error, Result};
use crate::forces::Ledger;
use crate::math::{Pose, Real, Twist};

/// What holds of a method.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
pub struct Facts {
    /// Name, as the user writes it.
    pub name: &'static str,
    /// Error after a fixed time falls as h^order.
    pub order: u32,
    /// The map of a step is symplectic (forces that come from a potential; of semi-implicit Euler where nothing is joined).
    pub symplectic: bool,
    /// A run turned round comes back to its start.
    pub reversible: bool,
    /// Exact for a force that is constant in time and place.
    pub exact_for_constant_force: bool,
    /// Chooses its own step to a tolerance.
    pub adaptive: bool,
    /// Moves what smooth joints tie by itself, where nothing touches; what others leave, the contact step moves.
    pub joints: bool,
    /// Treats contacts.
    pub contacts: bool,
    /// What it does, in one sentence.
    pub about: &'static str,
}

/// A stretch of time that is stepped with one method.
#[derive(Clone, Copy, Debug)]
pub struct Span {
    /// World time at its start (s).
    pub start: Real,
    /// World time at its end (s).
    pub end: Real,
    /// Its length (s). More precise than the difference of the two, when the time is large.
    pub duration: Real,
    /// Into how many equal steps it is divided.
    pub substeps: u32,
}

impl Span {
    /// Length of a step (s).
    #[must_use]
    pub fn h(&self) -> Real {
        self.duration / Real::from(self.substeps)
    }

    /// World time before step `k`; the end of the span after the last.
    #[must_use]
    pub fn time(&self, k: u32) -> Real {
        if k == self.substeps { self.end } else { self.start + self.h() * Real::from(k) }
    }
}

/// The state that a method moves: a run of bodies, and the energy that crossed their border.
pub struct Motion<'a> {
    /// Poses.
    pub poses: &'a mut [Pose],
    /// Twists.
    pub twists: &'a mut [Twist],
    /// Work and dissipation are added here.
    pub ledger: &'a mut Ledger,
}

/// Columns that methods work in; kept between steps so that a warm step allocates nothing.
#[derive(Clone, Debug, Default)]
pub struct Scratch {
    /// Accelerations of the last evaluation.
    accelerations: Vec<Twist>,
    /// Velocities before a kick, and in the middle of it.
    before: Vec<Twist>,
    middle: Vec<Twist>,
    /// Places before a step; velocities after a kick; what impulses of joints give them.
    start: Vec<Pose>,
    kicked: Vec<Twist>,
    led: Vec<Twist>,
    /// Flat columns of the methods of first order systems.
    flat: first_order::Columns,
    /// Radau's method, and what its errors are measured against.
    radau: radau5::Radau,
    scales: [scale::Scales; 2],
}

/// A way through time at a fixed step.
pub trait Method: Sync {
    /// What holds of it.
    fn facts(&self) -> &'static Facts;

    /// Moves the bodies through `span`.
    ///
    /// # Errors
    /// Those of the user's fields, and steps that the method cannot take.
    fn run(
        &self,
        system: &mut System<'_>,
        motion: &mut Motion<'_>,
        span: Span,
        scratch: &mut Scratch,
    ) -> Result<()>;
}

impl std::fmt::Debug for dyn Method {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(self.facts().name)
    }
}

/// Every method, the default first.
pub static REGISTRY: &[&dyn Method] = &[
    &leapfrog::Leapfrog,
    &rattle::Rattle,
    &yoshida::YOSHIDA4,
    &yoshida::YOSHIDA6,
    &rk4::Rk4,
    &dop853::Dop853,
    &radau5::Radau5,
    &trapezoid::Trapezoid,
    &semi_implicit_euler::SemiImplicitEuler,
    &explicit_euler::ExplicitEuler,
];

/// The method of this name.
///
/// # Errors
/// [`Error::Invalid`] with the names there are.
pub fn method(name: &str) -> Result<&'static dyn Method> {
    let found = REGISTRY.iter().find(|method| method.facts().name == name);
    found.copied().ok_or_else(|| {
        let names: Vec<_> = REGISTRY.iter().map(|method| method.facts().name).collect();
        Error::invalid("method", format!("{name:?}"), names.join(", "))
    })
}

/// Steps by a rule that asks for the accelerations once, at the start of each step: Euler's rules differ
/// only in the order of kick and drift.
fn each_step(
    system: &mut System<'_>,
    motion: &mut Motion<'_>,
    span: Span,
    scratch: &mut Scratch,
    rule: impl Fn(&mut Motion<'_>, &[Twist], Real),
) -> Result<()> {
    let accelerations = &mut scratch.accelerations;
    accelerations.resize(motion.poses.len(), Twist::ZERO);
    system.settle_motion(motion);
    for k in 0..span.substeps {
        let power = system.accelerate(span.time(k), motion.poses, motion.twists, accelerations)?;
        motion.ledger.book(power, span.h());
        rule(motion, accelerations, span.h());
        system.settle_motion(motion);
    }
    Ok(())
}

/// v += a·h for every body.
fn kick(twists: &mut [Twist], accelerations: &[Twist], h: Real) {
    for (v, a) in twists.iter_mut().zip(accelerations) {
        v.linear += a.linear * h;
        v.angular += a.angular * h;
    }
}

/// x += v·h for every body.
fn drift(poses: &mut [Pose], twists: &[Twist], h: Real) {
    for (pose, v) in poses.iter_mut().zip(twists) {
        pose.position += v.linear * h;
        pose.angle += v.angular * h;
    }
}

impl Ledger {
    /// Books a power (W) over a time h.
    fn book(&mut self, power: Self, h: Real) {
        self.work += power.work * h;
        self.dissipated += power.dissipated * h;
    }
}
