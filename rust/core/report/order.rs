//! The order of a method, measured.

use crate::error::Result;
use crate::math::Real;
use crate::methods::Facts;
use crate::report::study::{Mode, error_of};
use crate::scenes::Motion;

/// What was measured of a method's order on a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Order {
    /// Slope of log error against log step.
    Slope(Real),
    /// No error to measure: the method is exact here.
    Exact,
    /// No two steps in a row whose errors are both small and well above rounding.
    Unclear,
}

/// Errors from here on (relative) are too large for their slope to be the order.
const LARGE: Real = 1e-2;
/// Errors below this, at any step, are rounding.
const ROUNDING: Real = 1e-12;

/// Order of a method on a scene: the slope log(e₁/e₂)/log(h₁/h₂) between the two finest of a ladder
/// of steps (each √2 times finer than the one before) whose errors are smaller than 1 % and well above
/// rounding. The ladder ends where rounding begins.
///
/// # Errors
/// Those of the runs.
pub fn measured_order(motion: &Motion, facts: &Facts) -> Result<Order> {
    let mut last: Option<(Real, Real)> = None;
    let mut slope = None;
    let mut largest: Real = 0.0;
    let mut floor: Real = ROUNDING;
    for k in 4..=26 {
        let steps = (libm::exp2(Real::from(k) / 2.0)).round();
        let h = motion.duration / steps;
        let mut world = (motion.build)()?;
        world.set_closed_form(false);
        world.set_method(facts.name)?;
        world.set_substeps(1)?;
        // A step that the method refuses is too large.
        let Ok((error, _)) = error_of(motion, &mut world, Mode::Step(h)) else { continue };
        largest = largest.max(error);
        if let Some((h1, e1)) = last
            && e1 < LARGE
            && error > 30.0 * floor
            && error < e1
        {
            slope = Some(libm::log(e1 / error) / libm::log(h1 / h));
        }
        if error < ROUNDING * 10.0 {
            floor = floor.max(error);
        }
        last = Some((h, error));
    }
    Ok(match slope {
        _ if largest < ROUNDING => Order::Exact,
        Some(slope) => Order::Slope(slope),
        None => Order::Unclear,
    })
}
