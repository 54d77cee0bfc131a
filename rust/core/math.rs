//! Numbers and vectors: one scalar, two-dimensional vectors, poses, twists and wrenches.
//!
//! nalgebra supplies the vectors; the transcendental functions go through one place here (the `libm`
//! crate), so that every platform gives the same bits.

use bytemuck::{Pod, Zeroable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// The one scalar of the engine. There are no generics over it.
pub type Real = f64;

/// A vector or a point in the plane (SI units, y up).
pub type Vec2 = nalgebra::Vector2<Real>;

/// π.
pub const PI: Real = std::f64::consts::PI;

/// The vector (x, y).
#[must_use]
pub const fn vec2(x: Real, y: Real) -> Vec2 {
    Vec2::new(x, y)
}

/// The vector (0, 0), for what is left out of a file.
#[must_use]
pub(crate) const fn zero() -> Vec2 {
    vec2(0.0, 0.0)
}

/// z component of the cross product a × b: positive when b lies counter-clockwise of a.
#[must_use]
pub fn cross(a: Vec2, b: Vec2) -> Real {
    a.x * b.y - a.y * b.x
}

/// `v` turned by a quarter turn counter-clockwise: the velocity field of a unit spin at `v`.
#[must_use]
pub fn perp(v: Vec2) -> Vec2 {
    vec2(-v.y, v.x)
}

/// (sin, cos) of an angle in radians, the same bits on every platform.
#[must_use]
pub fn sin_cos(angle: Real) -> (Real, Real) {
    libm::sincos(angle)
}

/// Cosine of an angle in radians.
#[must_use]
pub fn cos(angle: Real) -> Real {
    libm::cos(angle)
}

/// The largest whole number that is not above x.
#[must_use]
pub fn floor(x: Real) -> Real {
    libm::floor(x)
}

/// Angle of a vector against +x, in (−π, π].
#[must_use]
pub fn atan2(y: Real, x: Real) -> Real {
    libm::atan2(y, x)
}

/// e^x − 1 without cancellation for small x.
#[must_use]
pub fn exp_m1(x: Real) -> Real {
    libm::expm1(x)
}

/// e^x.
#[must_use]
pub fn exp(x: Real) -> Real {
    libm::exp(x)
}

/// ln(1 + x) without cancellation for small x.
#[must_use]
pub fn ln_1p(x: Real) -> Real {
    libm::log1p(x)
}

/// ln x.
#[must_use]
pub fn ln(x: Real) -> Real {
    libm::log(x)
}

/// √(x² + y²) without overflow on the way.
#[must_use]
pub fn hypot(x: Real, y: Real) -> Real {
    libm::hypot(x, y)
}

/// x^y; small whole exponents by multiplication.
#[must_use]
pub fn powf(x: Real, y: Real) -> Real {
    const WHOLE: Real = 8.0;
    if y.abs() > WHOLE || y != y.trunc() {
        return libm::pow(x, y);
    }
    let product = (0..y.abs() as u32).fold(1.0, |product, _| product * x);
    if y < 0.0 { 1.0 / product } else { product }
}

/// A rotation as a unit complex number cos + i sin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rot {
    /// Cosine of the angle.
    pub cos: Real,
    /// Sine of the angle.
    pub sin: Real,
}

impl Default for Rot {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Rot {
    /// The rotation that turns nothing.
    pub const IDENTITY: Self = Self { cos: 1.0, sin: 0.0 };

    /// The rotation by `angle` radians, counter-clockwise.
    #[must_use]
    pub fn new(angle: Real) -> Self {
        let (sin, cos) = sin_cos(angle);
        Self { cos, sin }
    }

    /// `v` turned by this rotation.
    #[must_use]
    pub fn apply(self, v: Vec2) -> Vec2 {
        vec2(self.cos * v.x - self.sin * v.y, self.sin * v.x + self.cos * v.y)
    }

    /// This rotation after a further one by `angle` radians. Small angles cost no call of sine and cosine;
    /// the length drifts from 1 by rounding alone.
    #[must_use]
    pub fn turned(self, angle: Real) -> Self {
        if angle == 0.0 {
            return self;
        }
        if Self::is_little(angle) {
            return self.turned_little(angle);
        }
        self.after(Self::new(angle))
    }

    /// Whether [`Rot::turned_little`] is right.
    #[inline]
    pub(crate) fn is_little(angle: Real) -> bool {
        angle.abs() < 0.125
    }

    /// This rotation after a further one by a little angle, by its series. Below 1/8 they are right to the last digit
    /// with these terms: 8^-13/13! < 2^-70.
    #[inline]
    pub(crate) fn turned_little(self, angle: Real) -> Self {
        let z = angle * angle;
        // Factors in place of divisors: their rounding counts with z, a 64th at most.
        let part = |n: Real| z * (1.0 / n);
        let sin = 1.0
            - part(6.0)
                * (1.0
                    - part(20.0) * (1.0 - part(42.0) * (1.0 - part(72.0) * (1.0 - part(110.0)))));
        let cos = 1.0
            - part(2.0)
                * (1.0 - part(12.0) * (1.0 - part(30.0) * (1.0 - part(56.0) * (1.0 - part(90.0)))));
        self.after(Self { cos, sin: angle * sin })
    }

    #[inline]
    fn after(self, turn: Self) -> Self {
        Self {
            cos: self.cos * turn.cos - self.sin * turn.sin,
            sin: self.sin * turn.cos + self.cos * turn.sin,
        }
    }

    /// `v` turned back by this rotation.
    #[must_use]
    pub fn apply_inverse(self, v: Vec2) -> Vec2 {
        vec2(self.cos * v.x + self.sin * v.y, self.cos * v.y - self.sin * v.x)
    }
}

/// Where a body is: a position and an angle. The angle is not wrapped, so that turns are counted
/// and a fast spin keeps its full precision; the rotation is derived from it and always of unit length.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable, Serialize, Deserialize, JsonSchema)]
pub struct Pose {
    /// Position (m).
    #[schemars(with = "[Real; 2]")]
    pub position: Vec2,
    /// Angle (rad), counter-clockwise, unwrapped.
    pub angle: Real,
}

impl Pose {
    /// The origin, not turned.
    pub const IDENTITY: Self = Self { position: vec2(0.0, 0.0), angle: 0.0 };

    /// The pose at `position`, turned by `angle` radians.
    #[must_use]
    pub const fn new(position: Vec2, angle: Real) -> Self {
        Self { position, angle }
    }

    /// The rotation of this pose.
    #[must_use]
    pub fn rot(&self) -> Rot {
        if self.angle == 0.0 { Rot::IDENTITY } else { Rot::new(self.angle) }
    }

    /// A point given in this frame, in world coordinates.
    #[must_use]
    pub fn apply(&self, local: Vec2) -> Vec2 {
        self.position + self.rot().apply(local)
    }

    /// A world point in the coordinates of this frame.
    #[must_use]
    pub fn apply_inverse(&self, world: Vec2) -> Vec2 {
        self.rot().apply_inverse(world - self.position)
    }
}

/// How a body moves: the velocity of its centre of mass and its angular velocity.
/// The same three numbers serve for accelerations.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable, Serialize, Deserialize)]
pub struct Twist {
    /// Linear part (m/s).
    pub linear: Vec2,
    /// Angular part (rad/s), counter-clockwise.
    pub angular: Real,
}

impl Twist {
    /// At rest.
    pub const ZERO: Self = Self { linear: vec2(0.0, 0.0), angular: 0.0 };

    /// The twist with these parts.
    #[must_use]
    pub const fn new(linear: Vec2, angular: Real) -> Self {
        Self { linear, angular }
    }

    /// Velocity of the point `arm` away from the centre of mass: v + ω × r.
    #[must_use]
    pub fn at(&self, arm: Vec2) -> Vec2 {
        self.linear + self.angular * perp(arm)
    }
}

/// What acts on a body: a force through its centre of mass and a torque about it.
#[repr(C)]
#[derive(Clone, Copy, Debug, PartialEq, Pod, Zeroable, Serialize, Deserialize)]
pub struct Wrench {
    /// Force (N).
    pub force: Vec2,
    /// Torque (N·m), counter-clockwise.
    pub torque: Real,
}

impl Wrench {
    /// No force, no torque.
    pub const ZERO: Self = Self { force: vec2(0.0, 0.0), torque: 0.0 };

    /// The wrench with these parts.
    #[must_use]
    pub const fn new(force: Vec2, torque: Real) -> Self {
        Self { force, torque }
    }

    /// The wrench of `force` acting `arm` away from the centre of mass: τ = r × F.
    #[must_use]
    pub fn at(force: Vec2, arm: Vec2) -> Self {
        Self { force, torque: cross(arm, force) }
    }
}

impl std::ops::AddAssign for Wrench {
    fn add_assign(&mut self, other: Self) {
        self.force += other.force;
        self.torque += other.torque;
    }
}

impl std::ops::Add for Wrench {
    type Output = Self;
    fn add(mut self, other: Self) -> Self {
        self += other;
        self
    }
}
