//! Which numbers a shape may be made of. Moments hold products of four lengths, and what is left of
//! them after cancelling must not underflow either: hence a range of sizes, the same for all kinds.

use super::predicates::{is_convex, magnitude};
use crate::error::{Error, Result, check};
use crate::math::{Real, Vec2};

const SMALLEST: Real = 1e-70;
const LARGEST: Real = 1e70;

/// A length above 0, in range.
pub(super) fn length(what: &str, x: Real) -> Result<()> {
    check::positive(what, x)?;
    if (SMALLEST..=LARGEST).contains(&x) {
        Ok(())
    } else {
        Err(Error::invalid(what, x, format!("{SMALLEST:e} to {LARGEST:e} m")))
    }
}

/// A point with coordinates in range.
pub(super) fn point(what: &str, p: Vec2) -> Result<()> {
    check::finite_vec(what, p)?;
    if p.amax() <= LARGEST {
        Ok(())
    } else {
        let got = format!("({:e}, {:e})", p.x, p.y);
        Err(Error::invalid(what, got, format!("coordinates up to {LARGEST:e} m")))
    }
}

/// Two distinct ends.
pub(super) fn ends(what: &str, a: Vec2, b: Vec2) -> Result<()> {
    point(&format!("end a of the {what}"), a)?;
    point(&format!("end b of the {what}"), b)?;
    length(&format!("distance between the ends of the {what}"), (b - a).norm())
}

/// Refuses corners that rounding has bent or merged: a shape too small for where it is.
pub(super) fn convex(what: &str, ring: &[Vec2]) -> Result<()> {
    if is_convex(ring) {
        return Ok(());
    }
    Err(Error::invalid(
        format!("size of the {what}"),
        "lost in rounding",
        format!("sizes well above {:e} m so far from the origin", magnitude(ring) * Real::EPSILON),
    ))
}
