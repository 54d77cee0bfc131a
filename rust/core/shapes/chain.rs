//! The chain: a polyline of thin wires.

use super::geometry::Ring;
use super::limits;
use super::mass::Measures;
use super::predicates::magnitude;
use crate::error::{Error, Result};
use crate::math::{Real, Vec2};

/// The links of a ring, one after another.
pub(super) fn links(ring: &Ring) -> impl Iterator<Item = [Vec2; 2]> + '_ {
    let n = ring.points.len();
    let count = if ring.closed { n } else { n.saturating_sub(1) };
    (0..count).map(move |i| [ring.points[i], ring.points[(i + 1) % n]])
}

/// Refuses chains without links and links that rounding has made of one point. A chain may cross itself.
pub(super) fn check(ring: &Ring) -> Result<()> {
    let least = if ring.closed { 3 } else { 2 };
    let n = ring.points.len();
    if n < least {
        let what = format!("the number of points of the {} chain", kind(ring));
        return Err(Error::invalid(what, n, format!("{least} or more")));
    }
    for (i, &point) in ring.points.iter().enumerate() {
        limits::point(&format!("point {i} of the chain"), point)?;
    }
    let uncertain = 4.0 * Real::EPSILON * magnitude(&ring.points);
    for (i, [a, b]) in links(ring).enumerate() {
        let what = format!("length of link {i}–{} of the chain", (i + 1) % n);
        let length = (b - a).norm();
        limits::length(&what, length)?;
        if length <= uncertain {
            let allowed = format!("well above rounding, {uncertain:e} m so far from the origin");
            return Err(Error::invalid(what, length, allowed));
        }
    }
    Ok(())
}

fn kind(ring: &Ring) -> &'static str {
    if ring.closed { "closed" } else { "open" }
}

/// Of straight wires together: L = Σ Lᵢ, L c = Σ Lᵢ mᵢ, J = Σ Lᵢ (|mᵢ − c|² + Lᵢ²/12), with lengths Lᵢ and
/// middles mᵢ.
pub(super) fn measures(ring: &Ring) -> Measures {
    // About the first point, so that nothing is lost far from the origin.
    let origin = ring.points[0];
    let link = |[a, b]: [Vec2; 2]| ((b - a).norm(), (a - origin) + (b - a) / 2.0);
    let length: Real = links(ring).map(link).map(|(length, _)| length).sum();
    let first: Vec2 = links(ring).map(link).map(|(length, middle)| middle * length).sum();
    let center = first / length;
    let own = |(l, middle): (Real, Vec2)| l * ((middle - center).norm_squared() + l * l / 12.0);
    Measures {
        measure: length,
        perimeter: length,
        centroid: origin + center,
        second_moment: links(ring).map(link).map(own).sum(),
    }
}
