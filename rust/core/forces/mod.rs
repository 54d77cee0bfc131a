//! What acts on bodies: gravity, constant and scheduled forces, the resistance of air, and fields a
//! user adds. Whole columns in, whole columns out.

mod drag;
mod field;
mod library;
mod schedule;

pub use drag::{Air, decay, decay_time};
pub use field::{BodyColumns, BoxError, Field, FieldFacts, FieldHandle, ForceField};
pub use library::{Attraction, BuiltInField, Central, Oscillating};
pub use schedule::{ForceSchedule, Schedule, ScheduleHandle};

use std::sync::Arc;

use crate::arena::HandleMap;
use crate::body::{Body, Info, Mass};
use crate::error::{Error, Result};
use crate::math::{Pose, Real, Twist, Vec2, Wrench};
use crate::shapes::Facet;

/// Energy that crossed the border of a world since it was made (J).
#[derive(Clone, Copy, Debug, Default, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Ledger {
    /// Done on bodies by forces that have no potential.
    pub work: Real,
    /// Taken by drag, damping, friction and impacts (negative where the wind gives more than it takes).
    pub dissipated: Real,
    /// Done where overlap was removed by moving bodies, against the forces on them.
    pub correction_work: Real,
}

impl std::ops::AddAssign for Ledger {
    fn add_assign(&mut self, other: Self) {
        self.work += other.work;
        self.dissipated += other.dissipated;
        self.correction_work += other.correction_work;
    }
}

/// Columns that a force evaluation fills; kept between steps so that a warm step allocates nothing.
#[derive(Clone, Debug, Default)]
pub struct ForceBuffers {
    total: Vec<Wrench>,
    work: Vec<Wrench>,
    own: Vec<Wrench>,
}

/// For each body the facet of its silhouette that the air is let see; none where its width has no kinks.
pub type Facets = Vec<Option<Facet>>;

/// The forces on bodies that move together, as the methods see them. Slices have the same length, but for
/// `steady`, which is empty where there are no steady forces, and `infos` where there are `members`.
pub struct Forces<'a> {
    /// Which body stands where, for fields that act on certain bodies.
    pub handles: &'a HandleMap<Body>,
    /// Masses of the bodies.
    pub masses: &'a [Mass],
    /// Cold data: silhouettes, damping.
    pub infos: &'a [Info],
    /// Place of each body in `infos`; empty: the same as here.
    pub members: &'a [u32],
    /// Forces that stay the same over the span that is stepped, gravity apart.
    pub steady: &'a [Wrench],
    /// Gravity (m/s²).
    pub gravity: Vec2,
    /// The air.
    pub air: Air,
    /// Fields of the user's; they act on all bodies at once.
    pub fields: &'a [Arc<dyn ForceField>],
    /// Whether air or damping acts on any of the bodies.
    pub resistance: bool,
    /// Columns to work in.
    pub buffers: &'a mut ForceBuffers,
    /// What the air is let see of the bodies.
    pub shown: Shown,
    /// Force evaluations so far.
    pub evaluations: u64,
}

/// What the air is let see of the bodies by a method that ends its steps at the kinks of their silhouettes. Default:
/// the true silhouettes.
#[derive(Debug, Default)]
pub struct Shown {
    /// The facets that the air sees, whatever way the bodies turn: with them forces are smooth.
    pub facets: Facets,
    /// Since this was cleared an evaluation met a body that shows another facet, or one that may have done so in
    /// between: the way it turns to the air has changed.
    pub kinked: bool,
    /// Whether each body turned to the left, seen from the air, at the last evaluation.
    left: Vec<Option<bool>>,
}

impl Shown {
    /// Shows the air other facets.
    pub fn show(&mut self, facets: Facets) {
        self.left.resize(facets.len(), None);
        self.facets = facets;
    }

    /// Takes in how fast the air's direction turns as a body sees it (rad/s).
    fn turn(&mut self, body: usize, rate: Real) {
        let left = rate > 0.0;
        self.kinked |= self.left[body].replace(left) == Some(!left);
    }
}

impl Forces<'_> {
    /// Cold data of body `i`.
    #[must_use]
    pub fn info(&self, i: usize) -> &Info {
        &self.infos[self.place(i)]
    }

    fn place(&self, i: usize) -> usize {
        self.members.get(i).map_or(i, |place| *place as usize)
    }

    /// Whether a force may change with the velocity (resistance apart, which the methods treat by
    /// itself).
    #[must_use]
    pub fn velocity_dependent(&self) -> bool {
        self.fields.iter().any(|field| field.facts().velocity_dependent)
    }

    /// Accelerations by everything but the air and damping, for methods that treat those exactly:
    /// a = g + F/m, α = τ/I.
    pub fn accelerate_without_resistance(
        &mut self,
        time: Real,
        poses: &[Pose],
        twists: &[Twist],
        out: &mut [Twist],
    ) -> Result<()> {
        self.evaluations += 1;
        let buffers = &mut *self.buffers;
        buffers.total.clear();
        buffers.work.clear();
        if !self.steady.is_empty() {
            buffers.total.extend_from_slice(self.steady);
            buffers.work.extend_from_slice(self.steady);
        }
        if !self.fields.is_empty() {
            buffers.total.resize(poses.len(), Wrench::ZERO);
            let bodies = BodyColumns { poses, twists, masses: self.masses, handles: self.handles };
            for field in self.fields {
                add_field(field.as_ref(), time, &bodies, buffers)?;
            }
        }
        let total = &buffers.total;
        for (i, (a, mass)) in out.iter_mut().zip(self.masses).enumerate() {
            let gravity = self.gravity.component_mul(&mass.gravity_scale);
            *a = total.get(i).map_or(Twist::ZERO, |wrench| mass.acceleration(wrench));
            a.linear += gravity;
        }
        Ok(())
    }

    /// Accelerations by everything, and the power that goes to work and to dissipation (W).
    pub fn accelerate(
        &mut self,
        time: Real,
        poses: &[Pose],
        twists: &[Twist],
        out: &mut [Twist],
    ) -> Result<Ledger> {
        self.accelerate_without_resistance(time, poses, twists, out)?;
        let mut dissipated = 0.0;
        for i in 0..if self.resistance { poses.len() } else { 0 } {
            let (info, state) = (&self.infos[self.place(i)], (&poses[i], &twists[i]));
            let facet = self.shown.facets.get(i).and_then(Option::as_ref);
            self.shown.kinked |=
                facet.is_some_and(|facet| !drag::shows(info, self.air, state, facet));
            if let Some(resisting) = drag::resistance(&self.masses[i], info, self.air, state, facet)
            {
                let a = self.masses[i].acceleration(&resisting);
                out[i].linear += a.linear;
                out[i].angular += a.angular;
                dissipated -= power(&resisting, &twists[i], &self.masses[i]);
            }
            if !self.shown.facets.is_empty() {
                let relative = twists[i].linear - self.air.wind;
                self.shown.turn(
                    i,
                    relative.perp(&out[i].linear) / relative.norm_squared() - twists[i].angular,
                );
            }
        }
        Ok(Ledger { work: self.working_power(twists), dissipated, ..Ledger::default() })
    }

    /// The facets that the bodies show to the air in a state; empty where nothing resists.
    #[must_use]
    pub fn facets_of(&self, poses: &[Pose], twists: &[Twist]) -> Facets {
        let shown = if self.resistance { poses.len() } else { 0 };
        let states = poses.iter().zip(twists).enumerate().take(shown);
        states.map(|(i, state)| drag::facet(self.info(i), self.air, state)).collect()
    }

    /// Whether the bodies show, in a state, the facets that are let seen.
    #[must_use]
    pub fn shows_facets(&self, poses: &[Pose], twists: &[Twist]) -> bool {
        let states = poses.iter().zip(twists);
        self.shown.facets.iter().zip(states).enumerate().all(|(i, (facet, state))| {
            facet.as_ref().is_none_or(|facet| drag::shows(self.info(i), self.air, state, facet))
        })
    }

    /// The way a body goes through the air, in its own frame (m/s).
    #[must_use]
    pub fn heading(&self, pose: &Pose, twist: &Twist) -> Vec2 {
        drag::heading(self.air, (pose, twist))
    }

    /// Whether any force of the last evaluation does work that no potential accounts for.
    #[must_use]
    pub fn works(&self) -> bool {
        !self.buffers.work.is_empty()
    }

    /// Power (W) at which the forces of the last evaluation that have no potential do work on bodies
    /// that move with `twists`.
    #[must_use]
    pub fn working_power(&self, twists: &[Twist]) -> Real {
        let wrenches = self.buffers.work.iter();
        wrenches.zip(twists).zip(self.masses).map(|((w, v), m)| power(w, v, m)).sum()
    }

    /// Moves the bodies for a time h with no force but the air's and damping, exactly, and returns
    /// the energy those take (J). `h` may be negative for methods that step back.
    pub fn drift(&self, h: Real, poses: &mut [Pose], twists: &mut [Twist]) -> Result<Real> {
        let mut dissipated = 0.0;
        for (i, (pose, twist)) in poses.iter_mut().zip(twists).enumerate() {
            let (mass, info) = (&self.masses[i], self.info(i));
            if drag::resists(info, self.air) && mass.is_free() {
                let before = mass.kinetic_energy(twist);
                drag::drift(mass, info, self.air, (h, pose, twist))?;
                dissipated += before - mass.kinetic_energy(twist);
            } else {
                pose.position += twist.linear * h;
                pose.angle += twist.angular * h;
            }
        }
        Ok(dissipated)
    }
}

/// F·v + τω over what the body is free to do.
pub(crate) fn power(wrench: &Wrench, twist: &Twist, mass: &Mass) -> Real {
    let free = |inverse: Real, x: Real| if inverse > 0.0 { x } else { 0.0 };
    free(mass.inverse.x, wrench.force.x * twist.linear.x)
        + free(mass.inverse.y, wrench.force.y * twist.linear.y)
        + free(mass.inverse_inertia, wrench.torque * twist.angular)
}

/// Adds one field's forces to `total`, and to `work` if the field has no potential. The field is asked once.
fn add_field(
    field: &dyn ForceField,
    time: Real,
    bodies: &BodyColumns<'_>,
    buffers: &mut ForceBuffers,
) -> Result<()> {
    let ForceBuffers { total, work, own } = buffers;
    let failed = |source| Error::Field { name: field.name().to_owned(), source };
    if field.facts().conservative {
        return field.add_forces(time, bodies, total).map_err(failed);
    }
    own.clear();
    own.resize(total.len(), Wrench::ZERO);
    work.resize(total.len(), Wrench::ZERO);
    field.add_forces(time, bodies, own).map_err(failed)?;
    for ((sum, working), own) in total.iter_mut().zip(work).zip(own) {
        *sum += *own;
        *working += *own;
    }
    Ok(())
}

/// Whether drag or damping acts on a body.
#[must_use]
pub fn has_resistance(info: &Info, air: Air) -> bool {
    drag::resists(info, air)
}

/// Moves a body for a time h by no force but the air's and damping, exactly.
///
/// # Errors
/// A step back in time to where this drag has no state.
pub fn drift_body(
    mass: &Mass,
    info: &Info,
    air: Air,
    motion: (Real, &mut Pose, &mut Twist),
) -> Result<()> {
    drag::drift(mass, info, air, motion)
}

/// Whether air or damping act on a body; the plan sorts bodies by it.
#[must_use]
pub fn has_drag(info: &Info, air: Air) -> bool {
    drag::has_drag(info, air)
}
