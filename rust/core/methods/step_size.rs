//! How a run to a tolerance chooses its steps by their errors.

use crate::math::{Real, powf};

/// An error below this part of the tolerance says no more than that the step may grow.
pub const CALM: Real = 1e-4;

/// Factor from a step to the next by its error and by that of the step before: 0.9·error^(−0.7/8)·before^(0.4/8)
/// within [1/3, 6]. It takes the trend along, so that few steps are rejected where errors change fast.
///
/// Hairer, Wanner, "Solving Ordinary Differential Equations II" (1996), section IV.2, (2.43c): a PI controller.
pub fn follow(error: Real, before: Real) -> Real {
    (0.9 * powf(error, -0.7 / 8.0) * powf(before, 0.4 / 8.0)).clamp(1.0 / 3.0, 6.0)
}

/// Factor from a step that is rejected to the one that is tried instead: 0.9·error^(−1/order), not below 1/3.
pub fn shrink(error: Real, order: Real) -> Real {
    (0.9 * powf(error, -1.0 / order)).max(1.0 / 3.0)
}

/// Factor from a step of Radau's to the next, by its error, that and the length of the step before, and the iterations it took:
/// within [1/5, 8].
///
/// Hairer, Wanner, "Solving Ordinary Differential Equations II" (1996), section IV.8, (8.21) and (8.25): Gustafsson's controller.
pub fn predict(h: Real, error: Real, before: Option<(Real, Real)>, iterations: u32) -> Real {
    let own = powf(error, -0.25);
    let trend = before.map_or(Real::INFINITY, |(error_before, h_before)| {
        h / h_before * powf(error_before / error, 0.25) * own
    });
    let safe = 0.9 * 21.0 / (20.0 + Real::from(iterations));
    (safe * own.min(trend)).clamp(0.2, 8.0)
}

/// A step of Radau's that may grow by less keeps its length.
pub const SAME: Real = 1.2;

/// Part of the tolerance to which the equations of a stiff step are solved.
pub const SOLVED: Real = 0.01;

/// What the estimate of Radau's method, of order 3, is kept below so that its error, of order 5, is within a tolerance: a tenth
/// of its power 2/3, as its authors' code has it.
pub fn strict(tolerance: Real) -> Real {
    0.1 * powf(tolerance, 2.0 / 3.0)
}
