//! The rows of joints: for each a value C of the two bodies' places that is to be kept, bounded or driven, its
//! Jacobian J (Ċ = Jv), and J̇v.
//!
//! A row acts on A and on B along one line, also where the anchors are apart, so that whatever impulses it gives keep momentum
//! and angular momentum to rounding: a point that is held is seen in the frame that turns at the mean rate of both
//! bodies, a point on an axis in the frame of the axis.

mod custom;
mod rows;
mod soft;

pub use rows::{Row, Rows};
pub use soft::{Gains, Rates, Swing};

use crate::joint::{Coefficients, Custom, JointKind, ROWS};
use crate::math::{Real, Rot, Twist, Vec2};

/// What a row does with its coordinate.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Action {
    /// Nothing at all.
    Off,
    /// Keeps C at 0.
    Hold,
    /// A force −kC − cĊ.
    Spring(Coefficients),
    /// Keeps C at 0 or above.
    Limit,
    /// Brings Ċ to a speed (m/s, rad/s).
    Drive(Real),
}

/// Two bodies as a joint sees them. Places are counted from `origin`, so that no digits are lost far from the origin of
/// the world.
#[derive(Clone, Copy, Debug)]
pub struct Pair {
    /// Where places are counted from, in the world (m).
    pub origin: Vec2,
    /// Centres of mass (m).
    pub centers: [Vec2; 2],
    /// Rotations.
    pub rots: [Rot; 2],
    /// Angles (rad).
    pub angles: [Real; 2],
    /// Motions.
    pub twists: [Twist; 2],
}

/// A joint as rows see it: what it does and where it holds.
#[derive(Clone, Debug)]
pub struct Law {
    /// What it does.
    pub kind: JointKind,
    /// Anchors from the centres of mass, in the bodies' frames; of the world, from the origin of its pair (m).
    pub arms: [Vec2; 2],
    /// Springs of its rows.
    pub springs: [Option<Coefficients>; ROWS],
    /// The notch at which a ratchet stands (rad).
    pub notch: Real,
    /// Centres of mass in the bodies' frames, which the user's own rows are written for (m).
    pub locals: [Vec2; 2],
    /// The user's own rows.
    pub custom: Option<Custom>,
}
