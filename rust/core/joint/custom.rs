//! Joints that a user defines.

use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

use crate::error::{BoxError, Error, Result};
use crate::math::{Pose, Real};

/// One row of a joint of the user's own.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CustomRow {
    /// C: what is kept at 0.
    pub position: Real,
    /// ∂C/∂(x, y, θ) of A and of B.
    pub jacobian: [[Real; 3]; 2],
}

/// A joint of the user's own: C(q) = 0 with one to three rows, between two bodies.
///
/// J̇v is found by differences of J along the motion, so that a constraint needs no second derivatives.
pub trait Constraint: Send + Sync {
    /// Name, for messages.
    fn name(&self) -> &str;

    /// Number of rows, 1 to 3.
    fn rows(&self) -> usize;

    /// Writes C and J where the frames of A and B stand at these poses; the frame of the world is its own.
    ///
    /// # Errors
    /// What the user's code reports; the step is then not taken.
    fn evaluate(
        &self,
        poses: &[Pose; 2],
        rows: &mut [CustomRow],
    ) -> std::result::Result<(), BoxError>;
}

/// A constraint of the user's in a joint, and what went wrong with it in the step at work.
#[derive(Clone)]
pub struct Custom {
    constraint: Arc<dyn Constraint>,
    fault: Arc<Mutex<Option<BoxError>>>,
}

impl PartialEq for Custom {
    fn eq(&self, other: &Self) -> bool {
        Arc::ptr_eq(&self.constraint, &other.constraint)
    }
}

impl fmt::Debug for Custom {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.constraint.name())
    }
}

impl Custom {
    /// Takes a constraint.
    ///
    /// # Errors
    /// [`Error::Invalid`] unless it has one to three rows.
    pub fn new(constraint: Arc<dyn Constraint>) -> Result<Self> {
        let rows = constraint.rows();
        if !(1..=3).contains(&rows) {
            return Err(Error::invalid("rows of a custom joint", rows, "1 to 3"));
        }
        Ok(Self { constraint, fault: Arc::default() })
    }

    /// The user's constraint.
    #[must_use]
    pub fn constraint(&self) -> &Arc<dyn Constraint> {
        &self.constraint
    }

    /// C and J. What fails, or is not finite, does nothing, and is told by [`Custom::take_fault`].
    #[must_use]
    pub fn evaluate(&self, poses: &[Pose; 2]) -> ([CustomRow; 3], usize) {
        let mut rows = [CustomRow::default(); 3];
        let count = self.constraint.rows().min(3);
        let finite = |row: &CustomRow| {
            row.position.is_finite() && row.jacobian.iter().flatten().all(|x| x.is_finite())
        };
        let fault = match self.constraint.evaluate(poses, &mut rows[..count]) {
            Err(fault) => Some(fault),
            Ok(()) if !rows.iter().all(finite) => Some("C or its Jacobian is not finite".into()),
            Ok(()) => None,
        };
        if fault.is_some() {
            *self.fault.lock().unwrap_or_else(PoisonError::into_inner) = fault;
            rows = [CustomRow::default(); 3];
        }
        (rows, count)
    }

    /// What went wrong since the last call.
    ///
    /// # Errors
    /// [`Error::Joint`] with what the user's code reported.
    pub fn take_fault(&self) -> Result<()> {
        let fault = self.fault.lock().unwrap_or_else(PoisonError::into_inner).take();
        let name = || self.constraint.name().to_owned();
        fault.map_or(Ok(()), |source| Err(Error::Joint { name: name(), source }))
    }

    /// Compares J with central differences of C.
    ///
    /// # Errors
    /// [`Error::Invalid`] with the entry that differs most, [`Error::Joint`] if the user's code fails.
    pub fn check(&self, poses: &[Pose; 2], size: Real) -> Result<()> {
        let (rows, count) = self.evaluate(poses);
        self.take_fault()?;
        for side in 0..2 {
            for axis in 0..3 {
                let step = STEP * if axis == 2 { 1.0 } else { size };
                let at = |sign: Real| {
                    let mut moved = *poses;
                    match axis {
                        0 => moved[side].position.x += sign * step,
                        1 => moved[side].position.y += sign * step,
                        _ => moved[side].angle += sign * step,
                    }
                    self.evaluate(&moved).0
                };
                let (after, before) = (at(1.0), at(-1.0));
                self.take_fault()?;
                for k in 0..count {
                    let by_difference = (after[k].position - before[k].position) / (2.0 * step);
                    let given = rows[k].jacobian[side][axis];
                    let scale =
                        given.abs().max(by_difference.abs()) + rows[k].position.abs() / step;
                    if (given - by_difference).abs() > 1e-4 * scale.max(Real::MIN_POSITIVE) {
                        let (body, name) = (["A", "B"][side], ["x", "y", "angle"][axis]);
                        let what = format!("∂C{k}/∂{name} of {body} in the joint {self:?}");
                        return Err(Error::invalid(
                            what,
                            given,
                            format!("what differences of C give, about {by_difference:.6}"),
                        ));
                    }
                }
            }
        }
        Ok(())
    }
}

/// Step of the differences, in parts of the bodies' distance or a radian: the cube root of rounding.
const STEP: Real = 1e-5;
