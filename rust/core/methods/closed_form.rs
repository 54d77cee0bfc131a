//! Bodies under forces that are constant in time and place, with linear damping at most: the
//! solution is known, at any step.
//!
//! With damping c, v' = a − cv has v(h) = v₀ + (a − cv₀)·h·φ₁, x(h) = x₀ + v₀·h·φ₁ + a·h²·φ₂ with
//! φ₁ = (1 − e^(−ch))/(ch) and φ₂ = (1 − φ₁)/(ch); without damping φ₁ = 1, φ₂ = ½.

use crate::body::{Info, Mass};
use crate::forces::{Air, Ledger};
use crate::math::{Pose, Real, Twist, Vec2, Wrench, exp_m1};

/// Constant forces on a body.
pub struct Constant<'a> {
    /// Its mass.
    pub mass: &'a Mass,
    /// Constant force and torque, gravity apart.
    pub steady: Wrench,
    /// Gravity (m/s²).
    pub gravity: Vec2,
}

/// What damps the body: rates (1/s) of velocity and spin, and the air's velocity (m/s) along the axes
/// on which the body is free.
pub struct Damping {
    linear: Real,
    angular: Real,
    wind: Vec2,
}

impl Damping {
    /// Of a body in the air.
    #[must_use]
    pub fn of(mass: &Mass, info: &Info, air: Air) -> Self {
        let free = mass.inverse.map(|w| if w > 0.0 { 1.0 } else { 0.0 });
        let turns = mass.inverse_inertia > 0.0;
        Self {
            linear: info.def.linear_damping,
            angular: if turns { info.def.angular_damping } else { 0.0 },
            wind: air.wind.component_mul(&free),
        }
    }
}

impl Constant<'_> {
    fn acceleration(&self) -> Twist {
        let mut a = self.mass.acceleration(&self.steady);
        a.linear += self.gravity.component_mul(&self.mass.gravity_scale);
        a
    }

    /// Moves the body for a time h without damping.
    pub fn advance(&self, h: Real, pose: &mut Pose, twist: &mut Twist, ledger: &mut Ledger) {
        let a = self.acceleration();
        let way = twist.linear * h + a.linear * (0.5 * h * h);
        let turn = twist.angular * h + 0.5 * a.angular * h * h;
        twist.linear += a.linear * h;
        twist.angular += a.angular * h;
        pose.position += way;
        pose.angle += turn;
        if self.steady != Wrench::ZERO {
            ledger.work += self.work(&Pose::new(way, turn));
        }
    }

    /// Moves the body for a time h with damping.
    pub fn advance_damped(
        &self,
        h: Real,
        damping: &Damping,
        (pose, twist): (&mut Pose, &mut Twist),
        ledger: &mut Ledger,
    ) {
        let a = self.acceleration();
        let before = self.mass.kinetic_energy(twist);
        let (phi1, phi2) = phi(damping.linear * h);
        let relative = twist.linear - damping.wind;
        let way = damping.wind * h + relative * (h * phi1) + a.linear * (h * h * phi2);
        // A locked axis has no velocity to damp; the wind along it is left out above.
        twist.linear += (a.linear - relative * damping.linear) * (h * phi1);
        let (phi1, phi2) = phi(damping.angular * h);
        let turn = twist.angular * h * phi1 + a.angular * h * h * phi2;
        twist.angular += (a.angular - twist.angular * damping.angular) * h * phi1;
        pose.position += way;
        pose.angle += turn;
        let work = self.work(&Pose::new(way, turn));
        let weight = self.gravity.component_mul(&self.mass.gravity_scale) * self.mass.mass;
        ledger.work += work;
        ledger.dissipated += before + work + weight.dot(&way) - self.mass.kinetic_energy(twist);
    }

    /// F·Δx + τΔθ over what the body is free to do.
    fn work(&self, moved: &Pose) -> Real {
        let free = |inverse: Real, x: Real| if inverse > 0.0 { x } else { 0.0 };
        free(self.mass.inverse.x, self.steady.force.x * moved.position.x)
            + free(self.mass.inverse.y, self.steady.force.y * moved.position.y)
            + free(self.mass.inverse_inertia, self.steady.torque * moved.angle)
    }
}

/// φ₁(z) = (1 − e^(−z))/z and φ₂(z) = (1 − φ₁)/z.
fn phi(z: Real) -> (Real, Real) {
    if z.abs() > 0.1 {
        let phi1 = -exp_m1(-z) / z;
        return (phi1, (1.0 - phi1) / z);
    }
    // φ₂ = Σ (−z)^k/(k + 2)!, to the last digit with 9 terms below 0.1; it cancels in the closed form.
    let phi2 = (0..9).rev().fold(0.0, |sum, k| (1.0 - z * sum) / Real::from(k + 2));
    (1.0 - z * phi2, phi2)
}
