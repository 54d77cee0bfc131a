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
    /// [`Error::Invalid`] with the first entry that differs, [`Error::Joint`] if the user's code fails.
    pub fn check(&self, poses: &[Pose; 2], size: Real) -> Result<()> {
        let (rows, count) = self.evaluate(poses);
        self.take_fault()?;
        let steps = [size, size, 1.0].map(|unit| STEP * unit);
        let mut found = [CustomRow::default(); 3];
        for side in 0..2 {
            for (axis, step) in steps.into_iter().enumerate() {
                let at = |offset: Real| {
                    let mut moved = *poses;
                    match axis {
                        0 => moved[side].position.x += offset,
                        1 => moved[side].position.y += offset,
                        _ => moved[side].angle += offset,
                    }
                    self.evaluate(&moved).0
                };
                let (after, before) = (at(step), at(-step));
                self.take_fault()?;
                for (k, row) in found.iter_mut().enumerate() {
                    let change = after[k].position - before[k].position;
                    row.jacobian[side][axis] = change / (2.0 * step);
                }
            }
        }
        (0..count).try_for_each(|k| self.compare(k, [&rows[k], &found[k]], steps))
    }

    /// An error unless row k is that which differences give, to 1e-4 of the most that a step along any coordinate changes.
    fn compare(&self, k: usize, [given, found]: [&CustomRow; 2], steps: [Real; 3]) -> Result<()> {
        let entries = || (0..2).flat_map(|side| (0..3).map(move |axis| (side, axis)));
        let change =
            |row: &CustomRow, (side, axis): (usize, usize)| row.jacobian[side][axis] * steps[axis];
        let most = entries()
            .map(|entry| change(given, entry).abs().max(change(found, entry).abs()))
            .fold(0.0, Real::max);
        for (side, axis) in entries() {
            let entry = (side, axis);
            if (change(given, entry) - change(found, entry)).abs() > 1e-4 * most {
                let (body, name) = (["A", "B"][side], ["x", "y", "angle"][axis]);
                let what = format!("∂C{k}/∂{name} of {body} in the joint {self:?}");
                let by_difference = found.jacobian[side][axis];
                let allowed = format!("what differences of C give, about {by_difference:.6}");
                return Err(Error::invalid(what, given.jacobian[side][axis], allowed));
            }
        }
        Ok(())
    }
}

/// Step of the differences, in parts of the bodies' distance or a radian: the cube root of rounding.
const STEP: Real = 1e-5;
