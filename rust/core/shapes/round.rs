//! Measures of the shapes that are known in closed form: boxes, regular and rounded polygons,
//! wires.

use std::f64::consts::PI;

use super::mass::{Measures, polygon};
use super::predicates::edges;
use crate::math::{Real, Vec2, atan2, cross, perp, sin_cos, vec2};

/// A box: A = w h, J = A (w² + h²)/12.
pub(super) fn rectangle(width: Real, height: Real, center: Vec2) -> Measures {
    let area = width * height;
    Measures {
        measure: area,
        perimeter: 2.0 * (width + height),
        centroid: center,
        second_moment: area * (width * width + height * height) / 12.0,
    }
}

/// A regular polygon of n sides, circumradius R, φ = 2π/n: n triangles from the centre, so
/// A = ½ n R² sin φ, J = A R² (2 + cos φ)/6.
pub(super) fn regular(sides: u32, radius: Real, center: Vec2) -> Measures {
    let n = Real::from(sides);
    let (sin, cos) = sin_cos(2.0 * PI / n);
    let area = n * (radius * radius) * sin / 2.0;
    Measures {
        measure: area,
        perimeter: 2.0 * n * radius * sin_cos(PI / n).0,
        centroid: center,
        second_moment: area * (radius * radius) * (2.0 + cos) / 6.0,
    }
}

/// A straight wire: L, J = L³/12.
pub(super) fn segment(a: Vec2, b: Vec2) -> Measures {
    let length = (b - a).norm();
    Measures {
        measure: length,
        perimeter: length,
        centroid: a + (b - a) / 2.0,
        second_moment: length * length * length / 12.0,
    }
}

/// A circular wire, x = half its sweep: L = 2 r x, c on its axis of symmetry at r sinc x from the
/// centre, J = L r² (1 − sinc² x).
pub(super) fn arc(center: Vec2, radius: Real, start: Real, sweep: Real) -> Measures {
    let half = (sweep / 2.0).abs();
    let length = 2.0 * radius * half;
    let defect = sinc_defect(half);
    let (sin, cos) = sin_cos(start + sweep / 2.0);
    Measures {
        measure: length,
        perimeter: length,
        centroid: center + vec2(cos, sin) * (radius * (1.0 - defect)),
        second_moment: length * (radius * radius) * (defect * (2.0 - defect)),
    }
}

/// 1 − sin x / x for x in (0, π]; by its series below 1, where the difference would cancel.
fn sinc_defect(x: Real) -> Real {
    if x > 1.0 {
        return 1.0 - sin_cos(x).0 / x;
    }
    // x²/3! − x⁴/5! + …, nested; nine terms leave 1/21! of the first.
    let terms = (1..=9).rev().map(|k| Real::from(2 * k * (2 * k + 1)));
    terms.fold(0.0, |tail, factor| (1.0 - tail) * (x * x) / factor)
}

/// The Minkowski sum of a convex core and a disk of radius r: one point (a disk), two points (a
/// capsule) or a counter-clockwise convex polygon, with lengths Lᵢ, midpoints mᵢ and outward
/// normals nᵢ of its edges and angles θᵢ by which it turns at its vertices vᵢ. Core, rectangles on
/// the edges and sectors at the corners give
///
/// - A = A₀ + r Σ Lᵢ + π r² (Steiner), perimeter Σ Lᵢ + 2 π r,
/// - A c = A₀ c₀ + r Σ Lᵢ mᵢ + ½ r² Σ θᵢ vᵢ: what rectangles and sectors add off the edges and vertices,
///   ½ r² Σ Lᵢ nᵢ and ⅓ r³ Σ (nᵢ₋₁ − nᵢ) turned by 90°, vanishes because the core is closed,
/// - about c: J = J₀ + A₀ |c₀|² + Σ r Lᵢ (|mᵢ + ½ r nᵢ|² + (Lᵢ² + r²)/12)
///   + Σ (¼ θᵢ r⁴ + ½ θᵢ r² |vᵢ|² + ⅔ r³ vᵢ · (nᵢ₋₁ − nᵢ) turned by 90°).
pub(super) fn swept(core: &[Vec2], radius: Real) -> Measures {
    if radius == 0.0 {
        return polygon(&[core.to_vec()]);
    }
    // About the first vertex, so that nothing is lost far from the origin.
    let origin = core[0];
    let core: Vec<Vec2> = core.iter().map(|v| v - origin).collect();
    let inner = if core.len() > 2 { polygon(std::slice::from_ref(&core)) } else { POINT };
    let (sides, corners) = parts(&core);
    let length: Real = sides.iter().map(|side| side.length).sum();
    let area = inner.measure + radius * length + PI * (radius * radius);

    let first = inner.centroid * inner.measure
        + sides.iter().map(|s| s.middle * (radius * s.length)).sum::<Vec2>()
        + corners.iter().map(|c| c.vertex * (c.turn * radius * radius / 2.0)).sum::<Vec2>();
    let centroid = first / area;

    let rectangle = |side: &Side| {
        let to_center = side.middle + side.normal * (radius / 2.0) - centroid;
        let own = (side.length * side.length + radius * radius) / 12.0;
        radius * side.length * (to_center.norm_squared() + own)
    };
    let sector = |corner: &Corner| {
        let arm = corner.vertex - centroid;
        let lean = perp(corner.before - corner.after) * (radius / 3.0);
        let own = corner.turn * (radius * radius / 2.0 + arm.norm_squared()) / 2.0;
        radius * radius * (own + 2.0 * arm.dot(&lean))
    };
    let core_moment =
        inner.second_moment + inner.measure * (inner.centroid - centroid).norm_squared();
    let second_moment = core_moment
        + sides.iter().map(rectangle).sum::<Real>()
        + corners.iter().map(sector).sum::<Real>();
    Measures {
        measure: area,
        perimeter: length + 2.0 * PI * radius,
        centroid: origin + centroid,
        second_moment,
    }
}

/// An edge of a convex core.
struct Side {
    middle: Vec2,
    length: Real,
    normal: Vec2,
}

/// A vertex of a convex core, the normals before and after it and the angle between them.
pub(super) struct Corner {
    pub vertex: Vec2,
    pub before: Vec2,
    pub after: Vec2,
    pub turn: Real,
}

fn parts(core: &[Vec2]) -> (Vec<Side>, Vec<Corner>) {
    let side = |[a, b]: [Vec2; 2]| {
        let length = (b - a).norm();
        Side { middle: a + (b - a) / 2.0, length, normal: -perp(b - a) / length }
    };
    let sides = if core.len() == 1 { Vec::new() } else { edges(core).map(side).collect() };
    (sides, corners(core))
}

/// The corners of a convex core; a single point is one corner that turns all the way round.
pub(super) fn corners(core: &[Vec2]) -> Vec<Corner> {
    if let [vertex] = *core {
        let east = vec2(1.0, 0.0);
        return vec![Corner { vertex, before: east, after: east, turn: 2.0 * PI }];
    }
    let normal = |a: Vec2, b: Vec2| -perp((b - a).normalize());
    let corner = |[a, b, c]: [Vec2; 3]| {
        let (before, after) = (normal(a, b), normal(b, c));
        // Capsules turn back exactly: the angle is π, whatever sign the zero of the cross product
        // has.
        let turn = atan2(cross(before, after), before.dot(&after)).abs();
        Corner { vertex: b, before, after, turn }
    };
    super::predicates::corners(core).map(corner).collect()
}

/// A core without area.
const POINT: Measures =
    Measures { measure: 0.0, perimeter: 0.0, centroid: vec2(0.0, 0.0), second_moment: 0.0 };
