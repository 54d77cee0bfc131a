//! What can be measured on a world: energy, momentum, angular momentum.

use serde::Serialize;

use crate::body::Mass;
use crate::error::{Error, Result};
use crate::forces::{BodyColumns, ForceField, Ledger};
use crate::math::{Pose, Real, Twist, Vec2, Wrench, cross, vec2};
use crate::soft::SoftBody;
use crate::world::World;

/// Where a world's energy is (J). `total − work + dissipated` stays what it was, whatever happens.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Energy {
    /// Σ ½mv² + ½Iω².
    pub kinetic: Real,
    /// In gravity, against the origin, in the springs of joints, in what is strained, and in fields that have a potential.
    pub potential: Real,
    /// Done on the bodies by forces without a potential, since the world was made.
    pub work: Real,
    /// Taken by drag, damping, friction and impacts, since the world was made.
    pub dissipated: Real,
    /// Done where overlap was removed by moving bodies apart, since the world was made.
    pub correction_work: Real,
}

impl Energy {
    /// Kinetic and potential energy.
    #[must_use]
    pub fn total(&self) -> Real {
        self.kinetic + self.potential
    }

    /// What the laws say stays the same: total − work − correction_work + dissipated.
    #[must_use]
    pub fn balance(&self) -> Real {
        self.total() - self.work - self.correction_work + self.dissipated
    }
}

impl World {
    /// The energies.
    ///
    /// # Errors
    /// A field whose potential fails.
    pub fn energy(&self) -> Result<Energy> {
        let ledger = self.ledger();
        let rigid: Real = self.dynamic().map(|(_, twist, mass)| mass.kinetic_energy(twist)).sum();
        let mut kinetic = rigid + self.fluids().kinetic_energy();
        let gravity = self.settings().gravity;
        let in_gravity = |(pose, _, mass): (&Pose, &Twist, &Mass)| {
            -mass.mass * gravity.component_mul(&mass.gravity_scale).dot(&pose.position)
        };
        let mut potential: Real = self.dynamic().map(in_gravity).sum();
        potential += self.spring_energy() + self.fluids().potential_energy(gravity);
        potential += self.surface_energy();
        for body in self.soft_bodies() {
            kinetic += body.kinetic_energy();
            let weight = gravity * (body.mass() * body.def().gravity_scale);
            potential += body.strain_energy() - weight.dot(&body.center());
        }
        for field in self.fields() {
            let own = field.potential(self.time(), &self.columns());
            potential += own.map_err(failed(field.as_ref()))?.unwrap_or(0.0);
        }
        let Ledger { work, dissipated, correction_work } = ledger;
        Ok(Energy { kinetic, potential, work, dissipated, correction_work })
    }

    /// Σ mv over the dynamic and deformable bodies and the fluids (kg·m/s).
    #[must_use]
    pub fn momentum(&self) -> Vec2 {
        let rigid: Vec2 = self.dynamic().map(|(_, twist, mass)| mass.mass * twist.linear).sum();
        let rigid = rigid + self.fluids().momentum();
        self.soft_bodies().iter().fold(rigid, |sum, body| sum + body.momentum())
    }

    /// Σ m(r − p) × v + Iω over the dynamic and deformable bodies and the fluids (kg·m²/s), about the point p.
    #[must_use]
    pub fn angular_momentum(&self, about: Vec2) -> Real {
        let of_body = |(pose, twist, mass): (&Pose, &Twist, &Mass)| {
            let spin = if mass.inverse_inertia > 0.0 { mass.inertia * twist.angular } else { 0.0 };
            mass.mass * cross(pose.position - about, twist.linear) + spin
        };
        let rigid =
            self.dynamic().map(of_body).sum::<Real>() + self.fluids().angular_momentum(about);
        self.soft_bodies().iter().fold(rigid, |sum, body| sum + body.angular_momentum(about))
    }

    /// Σ m over the dynamic and deformable bodies and the fluids (kg).
    #[must_use]
    pub fn mass(&self) -> Real {
        let rigid: Real = self.dynamic().map(|(_, _, mass)| mass.mass).sum();
        let rigid = rigid + self.fluids().mass();
        self.soft_bodies().iter().fold(rigid, |sum, body| sum + body.mass())
    }

    /// Centre of mass of the dynamic and deformable bodies and the fluids (m); the origin where there is none.
    #[must_use]
    pub fn center_of_mass(&self) -> Vec2 {
        let mass = self.mass();
        if mass == 0.0 {
            return vec2(0.0, 0.0);
        }
        // About the first body, so that a distant origin costs no digits.
        let rigid = self.dynamic().next().map(|(pose, _, _)| pose.position);
        let fluid = self.fluids().particles.positions.first().copied();
        let soft = self.soft_bodies().first().map(|body| body.positions()[0]);
        let origin = rigid.or(fluid).or(soft).unwrap_or_else(Vec2::zeros);
        let sum: Vec2 = self.dynamic().map(|(pose, _, m)| m.mass * (pose.position - origin)).sum();
        let sum = sum + self.fluids().first_moment(origin);
        let of_soft = |sum: Vec2, body: &SoftBody| sum + (body.center() - origin) * body.mass();
        origin + self.soft_bodies().iter().fold(sum, of_soft) / mass
    }

    /// Largest net force and net torque of the fields that say they obey Newton's third law, over
    /// the sum of the forces: 0 to rounding where they speak the truth. None without such a field.
    ///
    /// # Errors
    /// A field that fails.
    pub fn third_law_residual(&self) -> Result<Option<Real>> {
        let center = self.center_of_mass();
        let mut worst = None;
        for field in self.fields().iter().filter(|field| field.facts().internal) {
            let mut wrenches = vec![Wrench::ZERO; self.bodies().len()];
            let added = field.add_forces(self.time(), &self.columns(), &mut wrenches);
            added.map_err(failed(field.as_ref()))?;
            let own = net_over_sum(&wrenches, &self.bodies().poses, center);
            worst = Some(own.max(worst.unwrap_or(0.0)));
        }
        Ok(worst)
    }

    fn columns(&self) -> BodyColumns<'_> {
        let bodies = self.bodies();
        BodyColumns {
            poses: &bodies.poses,
            twists: &bodies.twists,
            masses: &bodies.masses,
            handles: bodies.map(),
        }
    }

    /// Bodies that obey Newton's laws.
    fn dynamic(&self) -> impl Iterator<Item = (&Pose, &Twist, &Mass)> {
        let bodies = self.bodies();
        let columns = bodies.poses.iter().zip(&bodies.twists).zip(&bodies.masses);
        let columns = columns.zip(&bodies.infos).filter(|(_, info)| info.def.is_dynamic());
        columns.map(|(((pose, twist), mass), _)| (pose, twist, mass))
    }
}

fn failed(field: &dyn ForceField) -> impl FnOnce(crate::forces::BoxError) -> Error + '_ {
    |source| Error::Field { name: field.name().to_owned(), source }
}

/// |Σ F|/Σ|F| and |Σ τ|/Σ|r||F|, the larger of the two.
fn net_over_sum(wrenches: &[Wrench], poses: &[Pose], center: Vec2) -> Real {
    let (mut net, mut sum) = (Wrench::ZERO, Wrench::ZERO);
    for (wrench, pose) in wrenches.iter().zip(poses) {
        let arm = pose.position - center;
        net += Wrench::new(wrench.force, cross(arm, wrench.force) + wrench.torque);
        sum.force.x += wrench.force.norm();
        sum.torque += arm.norm() * wrench.force.norm() + wrench.torque.abs();
    }
    let ratio = |x: Real, of: Real| if x == 0.0 { 0.0 } else { x / of };
    ratio(net.force.norm(), sum.force.x).max(ratio(net.torque.abs(), sum.torque))
}
