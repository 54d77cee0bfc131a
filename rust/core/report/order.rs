//! The order of a method, measured.

use crate::error::Result;
use crate::math::Real;
use crate::methods::Method;
use crate::report::study::{Mode, Mover, error_of};
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

/// Rounding of a run of n steps: each adds a few times half a unit in the last place.
fn rounding(steps: Real) -> Real {
    1e-14 + 16.0 * steps * Real::EPSILON
}

/// Order of a method on a scene: the slope log(e₁/e₂)/log(h₁/h₂) between the two finest of a ladder
/// of steps (each √2 times finer than the one before) whose errors are smaller than 1 % and well above
/// rounding. Measured over an eighth of the run, where slow methods come below 1 % and fast ones show their
/// slope before rounding does; over the whole run where the eighth is too short to show anything.
///
/// # Errors
/// Those of the runs.
pub fn measured_order(motion: &Motion, method: &'static dyn Method) -> Result<Order> {
    order_by(motion, Mover::Method(method))
}

/// The same of whatever moves the bodies.
pub(super) fn order_by(motion: &Motion, mover: Mover) -> Result<Order> {
    let part = order_over(&Motion { duration: motion.duration / 8.0, ..*motion }, mover)?;
    if matches!(part, Order::Slope(_)) { Ok(part) } else { order_over(motion, mover) }
}

fn order_over(motion: &Motion, mover: Mover) -> Result<Order> {
    let mut ladder = Vec::new();
    for k in 4..=26 {
        let steps = libm::exp2(Real::from(k) / 2.0).round();
        let h = motion.duration / steps;
        let mut world = (motion.build)()?;
        mover.prepare(&mut world)?;
        // A step that the method refuses is too large, and no rung of the ladder.
        if let Ok((error, _)) = error_of(motion, &mut world, Mode::Step(h)) {
            ladder.push((steps, error));
        }
    }
    if ladder.iter().all(|&(steps, error)| error < rounding(steps)) {
        return Ok(Order::Exact);
    }
    // Rounding also has a floor of the scene's own: the least error that any step reaches.
    let least = ladder.iter().map(|rung| rung.1).fold(Real::INFINITY, Real::min);
    let floor = |steps: Real| if least < rounding(steps) { 30.0 * least } else { 0.0 };
    let usable = |rungs: &&[(Real, Real)]| {
        rungs[0].1 < LARGE && rungs[1].1 > floor(rungs[1].0).max(rounding(rungs[1].0) / 16.0)
    };
    let finest = ladder.windows(2).rfind(usable);
    Ok(finest.map_or(Order::Unclear, |rungs| {
        Order::Slope(libm::log(rungs[0].1 / rungs[1].1) / libm::log(rungs[1].0 / rungs[0].0))
    }))
}
