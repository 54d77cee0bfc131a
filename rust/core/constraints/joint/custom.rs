//! Joints that a user defines.

use crate::error::Result;
use crate::math::{Pose, Real};

/// One row of a joint of the user's own.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CustomRow {
    /// C: what is kept at 0.
    pub position: Real,
    /// ∂C/∂(x, y, θ) of A and of B.
    pub jacobian: [[Real; 3]; 2],
}

/// A joint of the user's own: C(q) = 0 with up to three rows, between two bodies.
///
/// J̇v is found by differences of J along the motion, so that a constraint needs no second derivatives.
pub trait Constraint: Send + Sync {
    /// Name, for messages.
    fn name(&self) -> &str;

    /// Number of rows, 1 to 3.
    fn rows(&self) -> usize;

    /// Writes C and J where the frames of A and B (of the world, its own) stand at these poses.
    ///
    /// # Errors
    /// What the user's code reports; the step is then not taken.
    fn evaluate(&self, poses: &[Pose; 2], rows: &mut [CustomRow]) -> Result<()>;
}
