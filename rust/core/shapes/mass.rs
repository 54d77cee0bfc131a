//! Area, centroid and second moment of polygons, and the mass properties that follow.

use twofloat::TwoFloat;

use super::predicates::{binade, edges};
use crate::math::{Real, Vec2, vec2};

/// Mass, centre of mass and moment of inertia.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct MassProperties {
    /// Mass (kg).
    pub mass: Real,
    /// Centre of mass (m).
    pub center: Vec2,
    /// Moment of inertia about the centre of mass (kg·m²).
    pub inertia: Real,
}

impl MassProperties {
    /// Of nothing.
    pub const ZERO: Self = Self { mass: 0.0, center: vec2(0.0, 0.0), inertia: 0.0 };

    /// Of all parts together: I = Σ (Iᵢ + mᵢ |cᵢ − c|²). Of nothing for no parts.
    #[must_use]
    pub fn combine(parts: impl IntoIterator<Item = Self>) -> Self {
        let parts: Vec<Self> = parts.into_iter().collect();
        let Some(first) = parts.first() else { return Self::ZERO };
        let mass: Real = parts.iter().map(|part| part.mass).sum();
        if mass == 0.0 {
            let inertia = parts.iter().map(|part| part.inertia).sum();
            return Self { mass, center: first.center, inertia };
        }
        // Relative to the first centre, so that far from the origin nothing cancels.
        let moment: Vec2 = parts.iter().map(|part| (part.center - first.center) * part.mass).sum();
        let center = first.center + moment / mass;
        Self { mass, center, inertia: parts.iter().map(|part| part.about(center)).sum() }
    }

    /// Moment of inertia about `point` (kg·m²), by the parallel axis theorem.
    #[must_use]
    pub fn about(&self, point: Vec2) -> Real {
        self.inertia + self.mass * (self.center - point).norm_squared()
    }
}

/// The integrals of a shape: ∫ dA, ∫ r dA / ∫ dA and ∫ |r − c|² dA, and the boundary's length.
/// For wires dA is the element of length.
#[derive(Clone, Copy, Debug)]
pub(super) struct Measures {
    pub measure: Real,
    pub perimeter: Real,
    pub centroid: Vec2,
    pub second_moment: Real,
}

/// Measures of a polygon: a counter-clockwise outline and clockwise holes.
///
/// With the vertices rᵢ taken about a point and kᵢ = rᵢ × rᵢ₊₁, A = ½ Σ kᵢ, A·c = ⅙ Σ kᵢ (rᵢ +
/// rᵢ₊₁) (P. Bourke, "Calculating the area and centroid of a polygon", 1988) and J = 1/12 Σ kᵢ
/// (rᵢ·rᵢ + rᵢ·rᵢ₊₁ + rᵢ₊₁·rᵢ₊₁), the signed sum over the triangles that the edges make with that
/// point. The sums are signed and hence hold for any simple outline. The point is a vertex for A
/// and c, and c itself for J; the products are formed in double-double (Joldes, Muller, Popescu,
/// "Tight and rigorous error bounds for basic building blocks of double-word arithmetic", 2017), so
/// what cancels in needles and far from the origin cancels 16 digits below what is kept.
pub(super) fn polygon(rings: &[Vec<Vec2>]) -> Measures {
    let origin = rings[0][0];
    let reach = rings.iter().flatten().fold(0.0, |m: Real, p| (p - origin).amax().max(m));
    let scale = binade(reach);
    let about_vertex = sums(rings, origin, vec2(0.0, 0.0), scale);
    // Nothing cancels in this quotient, so plain doubles do. (twofloat 0.8 divides one double-double
    // by another no better: the residual of its Newton step is rounded.)
    let offset = about_vertex.first / about_vertex.area;
    let area = about_vertex.area * scale * scale;
    let about_centroid = sums(rings, origin, offset, scale);
    Measures {
        measure: area,
        perimeter: rings.iter().flat_map(|ring| edges(ring)).map(|[a, b]| (b - a).norm()).sum(),
        centroid: origin + offset * scale,
        second_moment: about_centroid.second * scale * scale * scale * scale,
    }
}

struct Sums {
    area: Real,
    first: Vec2,
    second: Real,
}

/// The sums above about `origin + offset·scale`, in units of `scale` (a power of two, so that no
/// product of four lengths over- or underflows on the way and no digit is lost).
fn sums(rings: &[Vec<Vec2>], origin: Vec2, offset: Vec2, scale: Real) -> Sums {
    let shrink = 1.0 / scale;
    let arm = |p: Vec2| {
        let x = TwoFloat::new_sub(p.x, origin.x) * shrink - offset.x;
        let y = TwoFloat::new_sub(p.y, origin.y) * shrink - offset.y;
        [x, y]
    };
    let zero = TwoFloat::from(0.0);
    let (mut area, mut first, mut second) = (zero, [zero; 2], zero);
    for [a, b] in rings.iter().flat_map(|ring| edges(ring)) {
        let ([ax, ay], [bx, by]) = (arm(a), arm(b));
        let k = ax * by - ay * bx;
        let (sx, sy) = (ax + bx, ay + by);
        area += k;
        first = [first[0] + k * sx, first[1] + k * sy];
        // a·a + a·b + b·b = (a + b)·(a + b) − a·b
        second += k * (sx * sx + sy * sy - ax * bx - ay * by);
    }
    let first = vec2(first[0].hi(), first[1].hi());
    Sums { area: area.hi() / 2.0, first: first / 6.0, second: second.hi() / 12.0 }
}
