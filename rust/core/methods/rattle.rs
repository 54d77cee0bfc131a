//! RATTLE: half a kick, a drift and half a kick, the first with impulses of the joints at its start that lead the
//! drift to where the joints hold, the second with impulses at its end that leave no velocity against them. Second order,
//! symplectic and reversible; without joints, leapfrog that kicks by halves.
//!
//! H. C. Andersen, "Rattle: a 'velocity' version of the Shake algorithm for molecular dynamics calculations", Journal of
//! Computational Physics 52 (1983).

use crate::error::{Error, Result};
use crate::forces::{Forces, Ledger};
use crate::math::{Pose, Real, Twist};
use crate::methods::joined::Joints;
use crate::methods::leapfrog::{drift, implicit_kick, kick};
use crate::methods::{Facts, Method, Motion, Scratch, Span, System};

pub struct Rattle;

static FACTS: Facts = Facts {
    name: "rattle",
    order: 2,
    symplectic: true,
    reversible: true,
    exact_for_constant_force: true,
    adaptive: false,
    joints: true,
    contacts: false,
    about: "half a kick, a drift and half a kick, with impulses that put bodies exactly where joints hold them",
};

/// Iterations on the impulses of a half kick. They converge by a factor of about half the square of the angle that a body
/// turns in the step.
const MOST: usize = 100;

/// Gaps up to so many times those at the start of a step, or rounding, are as good as none where they no longer shrink.
const STALLED: Real = 4.0;

/// Velocities in the middle of a kick that change by less, in parts of the largest velocity or kick, have settled.
const SETTLED: Real = 16.0 * Real::EPSILON;

impl Method for Rattle {
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
        prepare(system, motion, span, scratch)?;
        for k in 0..span.substeps {
            step(system, motion, (span.time(k), span.h()), scratch)?;
        }
        Ok(())
    }
}

/// Puts the bodies where joints hold, and asks for the accelerations there.
pub fn prepare(
    system: &mut System<'_>,
    motion: &mut Motion<'_>,
    span: Span,
    scratch: &mut Scratch,
) -> Result<()> {
    system.settle_motion(motion);
    if let Some(joints) = &mut system.joints {
        joints.average_over(span.duration);
    }
    let a = &mut scratch.accelerations;
    a.resize(motion.poses.len(), Twist::ZERO);
    system.forces.accelerate_without_resistance(span.start, motion.poses, motion.twists, a)
}

/// One step of length h from a time on, after [`prepare`] or another step. Compositions of it call it with h of either
/// sign.
pub fn step(
    system: &mut System<'_>,
    motion: &mut Motion<'_>,
    (time, h): (Real, Real),
    scratch: &mut Scratch,
) -> Result<()> {
    if system.joints.is_some() {
        lead(system, motion, (time, h), scratch)?;
    } else {
        half_kick(system, motion, (time, h), scratch)?;
        drift(&system.forces, motion, h)?;
    }
    let forces = &mut system.forces;
    if !forces.fields.is_empty() {
        let a = &mut scratch.accelerations;
        forces.accelerate_without_resistance(time + h, motion.poses, motion.twists, a)?;
    }
    if system.joints.is_some() {
        stop(system, motion, (time + h, h), scratch)
    } else {
        half_kick(system, motion, (time + h, h), scratch)
    }
}

/// v += a·h/2 without joints.
fn half_kick(
    system: &mut System<'_>,
    motion: &mut Motion<'_>,
    (time, h): (Real, Real),
    scratch: &mut Scratch,
) -> Result<()> {
    if system.forces.velocity_dependent() {
        return implicit_kick(&mut system.forces, motion, (time, h / 2.0), scratch);
    }
    kick(&system.forces, motion, &scratch.accelerations, h / 2.0);
    Ok(())
}

/// Half a kick from where the joints hold, with impulses there, and the drift, which those lead to where the joints hold
/// again.
fn lead(
    system: &mut System<'_>,
    motion: &mut Motion<'_>,
    (time, h): (Real, Real),
    scratch: &mut Scratch,
) -> Result<()> {
    let Scratch { accelerations, before, middle, start, kicked, led, .. } = scratch;
    let Some(mut half) = HalfKick::new(system, motion, (time, h), (before, middle)) else {
        return Ok(());
    };
    start.clear();
    start.extend_from_slice(motion.poses);
    led.clear();
    led.resize(start.len(), Twist::ZERO);
    let ledger = *motion.ledger;
    let first = half.joints.begin_leading(start).max(1.0);
    let mut gap = Real::INFINITY;
    for _ in 0..MOST {
        let power = half.push(start, (before, middle), (accelerations, kicked))?;
        add(kicked, led);
        let change = half.to_mean(middle, before, kicked);
        motion.poses.copy_from_slice(start);
        motion.twists.copy_from_slice(kicked);
        *motion.ledger = ledger;
        drift(half.forces, motion, h)?;
        let previous =
            std::mem::replace(&mut gap, half.joints.look_ahead(motion.poses, motion.twists));
        let stalled = gap > 0.5 * previous && gap <= STALLED * first;
        let held = gap <= 1.0 || stalled;
        if !held {
            half.joints.lead(motion.twists, h);
            add(led, half.joints.response());
        }
        // Rounding is not led anywhere: over h it would be a velocity that never settles.
        half.joints.look_back();
        if held && half.settled(change) {
            half.joints.end_leading();
            half.book(middle, power, motion.ledger);
            return Ok(());
        }
        if !gap.is_finite() {
            break;
        }
    }
    Err(too_long(h))
}

/// Half a kick, with impulses after which nothing moves against the joints.
fn stop(
    system: &mut System<'_>,
    motion: &mut Motion<'_>,
    (time, h): (Real, Real),
    scratch: &mut Scratch,
) -> Result<()> {
    let Scratch { accelerations, before, middle, kicked, .. } = scratch;
    let Some(mut half) = HalfKick::new(system, motion, (time, h), (before, middle)) else {
        return Ok(());
    };
    for _ in 0..MOST {
        let power = half.push(motion.poses, (before, middle), (accelerations, kicked))?;
        half.joints.stop(kicked);
        let change = half.to_mean(middle, before, kicked);
        if half.settled(change) {
            motion.twists.copy_from_slice(kicked);
            half.book(middle, power, motion.ledger);
            return Ok(());
        }
        if !change.is_finite() {
            break;
        }
    }
    Err(too_long(h))
}

/// Half a kick of bodies that joints tie, where they stand.
struct HalfKick<'a, 'b> {
    forces: &'a mut Forces<'b>,
    joints: &'a mut Joints,
    time: Real,
    /// Length of the kick (s).
    h: Real,
    /// Forces depend on velocities.
    varies: bool,
    /// The largest energy (J) of a body in the motion before or in the kick.
    scale: Real,
}

impl<'a, 'b> HalfKick<'a, 'b> {
    /// Begins a kick of h/2 with velocities before and, as a guess, in the middle of it. None without joints.
    fn new(
        system: &'a mut System<'b>,
        motion: &Motion<'_>,
        (time, h): (Real, Real),
        (before, middle): (&mut Vec<Twist>, &mut Vec<Twist>),
    ) -> Option<Self> {
        let joints = system.joints.as_deref_mut()?;
        joints.look(motion.poses, motion.twists);
        joints.factor();
        before.clear();
        before.extend_from_slice(motion.twists);
        middle.clone_from(before);
        let forces = &mut system.forces;
        let varies = forces.velocity_dependent() || joints.velocity_dependent();
        Some(Self { forces, joints, time, h: 0.5 * h, varies, scale: 0.0 })
    }

    /// Writes the velocities after a kick without impulses of the joints, for forces as they are at the velocities in the
    /// middle; returns the powers of springs.
    fn push(
        &mut self,
        poses: &[Pose],
        (before, middle): (&[Twist], &[Twist]),
        (accelerations, kicked): (&mut [Twist], &mut Vec<Twist>),
    ) -> Result<Ledger> {
        if self.forces.velocity_dependent() {
            let time = self.time;
            self.forces.accelerate_without_resistance(time, poses, middle, accelerations)?;
        }
        kicked.clear();
        kicked.extend_from_slice(accelerations);
        let power = self.joints.add_springs(middle, kicked);
        self.scale = 0.0;
        for ((v, start), mass) in kicked.iter_mut().zip(before).zip(self.forces.masses) {
            *v = Twist::new(v.linear * self.h, v.angular * self.h);
            self.scale = self.scale.max(mass.kinetic_energy(v)).max(mass.kinetic_energy(start));
            *v += *start;
        }
        Ok(power)
    }

    /// middle = ½(before + after); returns the largest change of it, in parts of the largest velocity or kick, by their
    /// energies.
    fn to_mean(&self, middle: &mut [Twist], before: &[Twist], after: &[Twist]) -> Real {
        let mut worst: Real = 0.0;
        let bodies = middle.iter_mut().zip(before).zip(after).zip(self.forces.masses);
        for (((middle, before), after), mass) in bodies {
            let mean = Twist::new(
                0.5 * (before.linear + after.linear),
                0.5 * (before.angular + after.angular),
            );
            let change = Twist::new(mean.linear - middle.linear, mean.angular - middle.angular);
            worst = worst.max(mass.kinetic_energy(&change));
            *middle = mean;
        }
        if worst == 0.0 { 0.0 } else { (worst / self.scale).sqrt() }
    }

    /// Whether velocities in the middle that changed so much are those that forces are to be taken at.
    fn settled(&self, change: Real) -> bool {
        !self.varies || change <= SETTLED
    }

    /// Books the work of forces, springs and joints, the last solution's, and what joints do to bodies.
    fn book(&mut self, middle: &[Twist], power: Ledger, ledger: &mut Ledger) {
        ledger.book(power, self.h);
        ledger.work += self.h * self.forces.working_power(middle);
        ledger.work += self.joints.driving_of_solution(middle);
        self.joints.book_springs(middle, self.h);
        self.joints.book_impulses();
    }
}

fn add(twists: &mut [Twist], changes: &[Twist]) {
    twists.iter_mut().zip(changes).for_each(|(twist, change)| *twist += *change);
}

fn too_long(h: Real) -> Error {
    let allowed = "a smaller step (or more substeps): bodies turn too far in it for RATTLE to find where the joints hold";
    Error::invalid("dt", h.abs(), allowed)
}
