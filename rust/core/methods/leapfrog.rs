//! Leapfrog (Störmer, Verlet; Strang's splitting): half a kick by the forces, a drift in which air
//! and damping act exactly, half a kick. Second order, symplectic and reversible; exact for constant
//! forces, and for drag alone.
//!
//! Hairer, Lubich, Wanner, "Geometric numerical integration illustrated by the Störmer–Verlet
//! method", Acta Numerica 2003.

use crate::error::{Error, Result};
use crate::forces::Forces;
use crate::math::{Real, Twist};
use crate::methods::{Facts, Method, Motion, Scratch, Span, kick};

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
    about: "half kick, drift with the exact flow of drag and damping, half kick; the default",
};

impl Method for Leapfrog {
    fn facts(&self) -> &'static Facts {
        &FACTS
    }

    fn run(
        &self,
        forces: &mut Forces<'_>,
        motion: &mut Motion<'_>,
        span: Span,
        scratch: &mut Scratch,
    ) -> Result<()> {
        for k in 0..span.substeps {
            step(forces, motion, (span.time(k), span.time(k + 1), span.h()), scratch)?;
        }
        Ok(())
    }
}

/// One step of length h from `start` to `end`. Compositions of it call it with h of either sign.
pub fn step(
    forces: &mut Forces<'_>,
    motion: &mut Motion<'_>,
    (start, end, h): (Real, Real, Real),
    scratch: &mut Scratch,
) -> Result<()> {
    let implicit = forces.velocity_dependent();
    scratch.accelerations.resize(motion.poses.len(), Twist::ZERO);
    if implicit || !scratch.ready {
        let a = &mut scratch.accelerations;
        forces.accelerate_without_resistance(start, motion.poses, motion.twists, a)?;
    }
    half_kick(forces, motion, &scratch.accelerations, h / 2.0);
    motion.ledger.dissipated += forces.drift(h, motion.poses, motion.twists)?;
    if implicit {
        implicit_kick(forces, motion, (end, h / 2.0), scratch)?;
    } else {
        let a = &mut scratch.accelerations;
        forces.accelerate_without_resistance(end, motion.poses, motion.twists, a)?;
        half_kick(forces, motion, a, h / 2.0);
    }
    // Without fields the evaluation is a few additions, and another body's run may come between.
    scratch.ready = !forces.fields.is_empty();
    Ok(())
}

/// v += a·h, booking the work: the mean of the powers before and after is exact for a constant force.
fn half_kick(forces: &Forces<'_>, motion: &mut Motion<'_>, accelerations: &[Twist], h: Real) {
    let before = forces.working_power(motion.twists);
    kick(motion.twists, accelerations, h);
    motion.ledger.work += 0.5 * h * (before + forces.working_power(motion.twists));
}

/// The kick that ends a step where forces depend on velocities: v = v½ + a(x, v)·h, the mirror
/// image in time of the explicit one that begins the next, so the step stays reversible and of
/// second order. Solved by iteration, to the last digits.
fn implicit_kick(
    forces: &mut Forces<'_>,
    motion: &mut Motion<'_>,
    (time, h): (Real, Real),
    scratch: &mut Scratch,
) -> Result<()> {
    const MOST: usize = 60;
    let Scratch { accelerations, before, .. } = scratch;
    before.clear();
    before.extend_from_slice(motion.twists);
    for _ in 0..MOST {
        forces.accelerate_without_resistance(time, motion.poses, motion.twists, accelerations)?;
        let mut change: Real = 0.0;
        for ((v, start), a) in motion.twists.iter_mut().zip(before.iter()).zip(accelerations.iter())
        {
            let new = Twist::new(start.linear + a.linear * h, start.angular + a.angular * h);
            let size = new.linear.amax().max(v.linear.amax());
            change = change.max(relative((new.linear - v.linear).amax(), size));
            change = change.max(relative((new.angular - v.angular).abs(), new.angular.abs()));
            *v = new;
        }
        if change <= 4.0 * Real::EPSILON {
            let mean = forces.working_power(before) + forces.working_power(motion.twists);
            motion.ledger.work += 0.5 * h * mean;
            return Ok(());
        }
    }
    Err(Error::invalid(
        "dt",
        2.0 * h.abs(),
        "a smaller step (or more substeps): a force field changes too fast with the velocity for leapfrog",
    ))
}

fn relative(change: Real, size: Real) -> Real {
    if change == 0.0 { 0.0 } else { change / size }
}
