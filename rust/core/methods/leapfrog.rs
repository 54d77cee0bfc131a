//! Leapfrog (Störmer, Verlet; Strang's splitting): drifts, in which air and damping act exactly, and
//! kicks by the forces, in a symmetric order. Second order, symplectic and reversible; exact for
//! constant forces, and for drag alone.
//!
//! Steady forces kick by halves around the drift. Where fields act the drift is halved around one
//! kick instead: one evaluation a step, in the middle of it, with a fifth of the error on Kepler's
//! ellipse (e = 0.6).
//!
//! Hairer, Lubich, Wanner, "Geometric numerical integration illustrated by the Störmer–Verlet
//! method", Acta Numerica 2003.

use crate::error::{Error, Result};
use crate::forces::Forces;
use crate::math::{Real, Twist};
use crate::methods::{Facts, Method, Motion, Scratch, Span, System};

pub struct Leapfrog;

static FACTS: Facts = Facts {
    name: "leapfrog",
    order: 2,
    symplectic: true,
    reversible: true,
    exact_for_constant_force: true,
    adaptive: false,
    joints: false,
    contacts: false,
    about: "drifts with the exact flow of drag and damping, and kicks, in a symmetric order; the default",
};

impl Method for Leapfrog {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn run(
        &self,
        system: &mut System<'_>,
        motion: &mut Motion<'_>,
        span: Span,
        scratch: &mut Scratch,
    ) -> Result<()> {
        let forces = &mut system.forces;
        prepare(forces, motion, span.start, scratch)?;
        for k in 0..span.substeps {
            step(forces, motion, (span.time(k), span.h()), scratch)?;
        }
        Ok(())
    }
}

/// Accelerations by forces that are steady over a span need asking only once.
pub fn prepare(
    forces: &mut Forces<'_>,
    motion: &Motion<'_>,
    time: Real,
    scratch: &mut Scratch,
) -> Result<()> {
    let a = &mut scratch.accelerations;
    a.resize(motion.poses.len(), Twist::ZERO);
    if forces.fields.is_empty() {
        forces.accelerate_without_resistance(time, motion.poses, motion.twists, a)?;
    }
    Ok(())
}

/// One step of length h from a time on, after [`prepare`]. Compositions of it call it with h of
/// either sign.
pub fn step(
    forces: &mut Forces<'_>,
    motion: &mut Motion<'_>,
    (time, h): (Real, Real),
    scratch: &mut Scratch,
) -> Result<()> {
    if forces.fields.is_empty() {
        kick(forces, motion, &scratch.accelerations, h / 2.0);
        drift(forces, motion, h)?;
        kick(forces, motion, &scratch.accelerations, h / 2.0);
        return Ok(());
    }
    drift(forces, motion, h / 2.0)?;
    if forces.velocity_dependent() {
        implicit_kick(forces, motion, (time + h / 2.0, h), scratch)?;
    } else {
        let a = &mut scratch.accelerations;
        forces.accelerate_without_resistance(time + h / 2.0, motion.poses, motion.twists, a)?;
        kick(forces, motion, a, h);
    }
    drift(forces, motion, h / 2.0)
}

pub(super) fn drift(forces: &Forces<'_>, motion: &mut Motion<'_>, h: Real) -> Result<()> {
    if !forces.resistance {
        super::drift(motion.poses, motion.twists, h);
        return Ok(());
    }
    motion.ledger.dissipated += forces.drift(h, motion.poses, motion.twists)?;
    Ok(())
}

/// v += a·h. The work of a force over a kick is exactly its mean power times h.
pub(super) fn kick(forces: &Forces<'_>, motion: &mut Motion<'_>, accelerations: &[Twist], h: Real) {
    if !forces.works() {
        return super::kick(motion.twists, accelerations, h);
    }
    let before = forces.working_power(motion.twists);
    super::kick(motion.twists, accelerations, h);
    motion.ledger.work += 0.5 * h * (before + forces.working_power(motion.twists));
}

/// v₁ = v₀ + a(t, x, ½(v₀ + v₁))·h where forces depend on velocities, solved by iteration to the last
/// digits, so that the step stays reversible and of second order.
pub(super) fn implicit_kick(
    forces: &mut Forces<'_>,
    motion: &mut Motion<'_>,
    (time, h): (Real, Real),
    scratch: &mut Scratch,
) -> Result<()> {
    const MOST: usize = 60;
    let Scratch { accelerations, before, middle, .. } = scratch;
    before.clear();
    before.extend_from_slice(motion.twists);
    middle.clone_from(before);
    for _ in 0..MOST {
        forces.accelerate_without_resistance(time, motion.poses, middle, accelerations)?;
        motion.twists.copy_from_slice(before);
        super::kick(motion.twists, accelerations, h);
        let change = to_mean(middle, before, motion.twists);
        if change <= 4.0 * Real::EPSILON {
            motion.ledger.work += h * forces.working_power(middle);
            return Ok(());
        }
        if !change.is_finite() {
            break;
        }
    }
    Err(Error::invalid(
        "dt",
        h.abs(),
        "a smaller step (or more substeps): a force field changes too fast with the velocity for leapfrog",
    ))
}

/// middle = ½(before + after); returns the largest change of it, relative to the velocity.
fn to_mean(middle: &mut [Twist], before: &[Twist], after: &[Twist]) -> Real {
    let relative = |change: Real, size: Real| if change == 0.0 { 0.0 } else { change / size };
    let mut worst: Real = 0.0;
    for ((m, v0), v1) in middle.iter_mut().zip(before).zip(after) {
        let mean = Twist::new((v0.linear + v1.linear) * 0.5, (v0.angular + v1.angular) * 0.5);
        let size = v0.linear.amax().max(v1.linear.amax());
        worst = worst.max(relative((mean.linear - m.linear).amax(), size));
        let size = v0.angular.abs().max(v1.angular.abs());
        worst = worst.max(relative((mean.angular - m.angular).abs(), size));
        *m = mean;
    }
    worst
}
