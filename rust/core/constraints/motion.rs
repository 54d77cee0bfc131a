//! Bodies as constraints and solvers see them: what a sweep touches of one body fits one cache line.

use crate::body::Mass;
use crate::math::{Pose, Real, Rot, Twist, Vec2, cross, vec2};

/// Velocity of a body and what impulses do to it.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug)]
pub struct Velocity {
    /// v (m/s) and ω (rad/s).
    pub twist: Twist,
    /// 1/m along x and y (1/kg); 0 where an impulse moves nothing.
    pub inverse_mass: Vec2,
    /// 1/I (1/(kg·m²)).
    pub inverse_inertia: Real,
}

impl Velocity {
    /// Of a body with this mass.
    #[must_use]
    pub fn new(twist: Twist, mass: &Mass) -> Self {
        Self { twist, inverse_mass: mass.inverse, inverse_inertia: mass.inverse_inertia }
    }

    /// 1/m along x and y, 1/I.
    #[must_use]
    pub fn inverse(&self) -> [Real; 3] {
        [self.inverse_mass.x, self.inverse_mass.y, self.inverse_inertia]
    }

    /// Whether no impulse moves the body.
    #[must_use]
    pub fn is_fixed(&self) -> bool {
        self.inverse_mass.x == 0.0 && self.inverse_mass.y == 0.0 && self.inverse_inertia == 0.0
    }

    /// Adds an impulse (N·s) along `direction` whose lever arm about the centre of mass is `arm` (r × d).
    pub fn push(&mut self, direction: Vec2, arm: Real, impulse: Real) {
        self.twist.linear += self.inverse_mass.component_mul(&direction) * impulse;
        self.twist.angular += self.inverse_inertia * arm * impulse;
    }

    /// d·v + arm·ω.
    #[must_use]
    pub fn along(&self, direction: Vec2, arm: Real) -> Real {
        direction.dot(&self.twist.linear) + arm * self.twist.angular
    }

    /// J M⁻¹ J'ᵀ of two rows on this body.
    #[must_use]
    pub fn coupling(&self, (d, arm): (Vec2, Real), (e, other): (Vec2, Real)) -> Real {
        self.inverse_mass.component_mul(&d).dot(&e) + self.inverse_inertia * arm * other
    }
}

/// Where a body is, counted from the start of the step so that no digits are lost far from the origin,
/// and how forces accelerate it.
#[repr(C, align(64))]
#[derive(Clone, Copy, Debug)]
pub struct Place {
    /// Way of the centre of mass since the start (m).
    pub way: Vec2,
    /// Turn since the start (rad).
    pub turn: Real,
    /// Rotation now.
    pub rot: Rot,
    /// Acceleration by forces (m/s², rad/s²).
    pub acceleration: Twist,
}

impl Place {
    /// At the start of a step.
    #[must_use]
    pub fn start(pose: &Pose, acceleration: Twist) -> Self {
        Self { way: vec2(0.0, 0.0), turn: 0.0, rot: pose.rot(), acceleration }
    }

    /// Moves with a twist for a time h.
    pub fn drift(&mut self, twist: &Twist, h: Real) {
        self.way += twist.linear * h;
        self.rotate(twist.angular * h);
    }

    /// Turns by an angle (rad).
    pub fn rotate(&mut self, angle: Real) {
        self.turn += angle;
        self.rot = self.rot.turned(angle);
    }

    /// Velocity that the forces give in a time h.
    #[must_use]
    pub fn kick(&self, h: Real) -> Twist {
        Twist::new(self.acceleration.linear * h, self.acceleration.angular * h)
    }
}

/// r × n of an arm r.
pub(super) fn lever(arm: Vec2, direction: Vec2) -> Real {
    cross(arm, direction)
}
