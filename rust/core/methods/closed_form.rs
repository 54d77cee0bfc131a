//! Bodies under forces that are constant in time and place, with linear damping at most: the
//! solution is known, at any step.
//!
//! With damping c, v' = a − cv has v(h) = v₀ + (a − cv₀)·h·φ₁, x(h) = x₀ + v₀·h·φ₁ + a·h²·φ₂ with
//! φ₁ = (1 − e^(−ch))/(ch) and φ₂ = (1 − φ₁)/(ch); without damping φ₁ = 1, φ₂ = ½.

use crate::forces::Ledger;
use crate::math::{Pose, Real, Twist, Vec2, Wrench, exp_m1};

/// A body, and what acts on it.
pub struct Constant<'a> {
    /// Its mass.
    pub mass: &'a crate::body::Mass,
    /// Constant force and torque, gravity apart.
    pub steady: Wrench,
    /// Gravity (m/s²).
    pub gravity: Vec2,
    /// Damping of the velocity against the air, and of the spin (1/s).
    pub damping: (Real, Real),
    /// Velocity of the air (m/s).
    pub wind: Vec2,
}

impl Constant<'_> {
    /// Moves the body for a time h.
    pub fn advance(&self, h: Real, pose: &mut Pose, twist: &mut Twist, ledger: &mut Ledger) {
        let mut a = self.mass.acceleration(&self.steady);
        a.linear += self.gravity.component_mul(&self.mass.gravity_scale);
        let moved = if self.damping == (0.0, 0.0) {
            let moved = Pose::new(
                twist.linear * h + a.linear * (0.5 * h * h),
                twist.angular * h + 0.5 * a.angular * h * h,
            );
            twist.linear += a.linear * h;
            twist.angular += a.angular * h;
            moved
        } else {
            self.advance_damped(h, &a, twist, ledger)
        };
        pose.position += moved.position;
        pose.angle += moved.angle;
        if self.steady != Wrench::ZERO {
            ledger.work += self.work(&self.steady, &moved);
        }
    }

    /// Changes the velocities, books what damping takes, and returns the way.
    fn advance_damped(&self, h: Real, a: &Twist, twist: &mut Twist, ledger: &mut Ledger) -> Pose {
        let before = self.mass.kinetic_energy(twist);
        let free = self.mass.inverse.map(|w| if w > 0.0 { 1.0 } else { 0.0 });
        let wind = self.wind.component_mul(&free);
        let (phi1, phi2) = phi(self.damping.0 * h);
        let relative = twist.linear - wind;
        let way = wind * h + relative * (h * phi1) + a.linear * (h * h * phi2);
        twist.linear += (a.linear - relative * self.damping.0) * (h * phi1);
        let (phi1, phi2) = phi(self.damping.1 * h);
        let turn = twist.angular * h * phi1 + a.angular * h * h * phi2;
        twist.angular += (a.angular - twist.angular * self.damping.1) * h * phi1;
        let moved = Pose::new(way, turn);
        let weight = self.gravity.component_mul(&self.mass.gravity_scale) * self.mass.mass;
        let given = self.work(&self.steady, &moved) + weight.dot(&way);
        ledger.dissipated += before + given - self.mass.kinetic_energy(twist);
        moved
    }

    /// F·Δx + τΔθ over what the body is free to do.
    fn work(&self, wrench: &Wrench, moved: &Pose) -> Real {
        let free = |inverse: Real, x: Real| if inverse > 0.0 { x } else { 0.0 };
        free(self.mass.inverse.x, wrench.force.x * moved.position.x)
            + free(self.mass.inverse.y, wrench.force.y * moved.position.y)
            + free(self.mass.inverse_inertia, wrench.torque * moved.angle)
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
