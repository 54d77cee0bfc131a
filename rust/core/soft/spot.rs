//! Points of a deformable body: what a joint holds, where a ray meets it.

use serde::{Deserialize, Serialize};

use super::SoftBody;
use crate::math::{Real, Vec2, cross, vec2};

/// A point of a deformable body: nodes of an element, and their weights (its shape functions), which add up to 1.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
pub struct Spot {
    /// The nodes; those whose weight is 0 say nothing.
    pub nodes: [u32; 6],
    /// Their weights.
    pub weights: [Real; 6],
}

/// Iterations that find a point in a curved triangle.
const ITERATIONS: usize = 8;

impl Spot {
    fn of_rod([a, b]: [u32; 2], part: Real) -> Self {
        Self { nodes: [a, b, a, a, a, a], weights: [1.0 - part, part, 0.0, 0.0, 0.0, 0.0] }
    }

    /// Of a triangle at the coordinates l.
    fn of_triangle(nodes: [u32; 6], l: [Real; 3]) -> Self {
        let corner = |i: usize| l[i] * (2.0 * l[i] - 1.0);
        let side = |i: usize, j: usize| 4.0 * l[i] * l[j];
        let weights = [corner(0), corner(1), corner(2), side(0, 1), side(1, 2), side(2, 0)];
        Self { nodes, weights }
    }

    /// The nodes that count, and their weights.
    pub fn parts(&self) -> impl Iterator<Item = (u32, Real)> + '_ {
        self.nodes.iter().copied().zip(self.weights).filter(|(_, weight)| *weight != 0.0)
    }

    /// Mean of a column over the nodes.
    #[must_use]
    pub fn of(&self, column: &[Vec2]) -> Vec2 {
        self.parts().map(|(node, weight)| column[node as usize] * weight).sum()
    }
}

impl SoftBody {
    /// The point of the body, as its nodes lie now, that is nearest to a point of the world, and how far it is from there (m).
    #[must_use]
    pub fn nearest(&self, point: Vec2) -> (Spot, Real) {
        self.nearest_among(&self.moving.positions, point)
    }

    /// The same in its shape at rest, in the coordinates of its mesh.
    #[must_use]
    pub fn nearest_at_rest(&self, point: Vec2) -> (Spot, Real) {
        self.nearest_among(&self.def.mesh.rest, point)
    }

    fn nearest_among(&self, at: &[Vec2], point: Vec2) -> (Spot, Real) {
        let mesh = &self.def.mesh;
        let rods = mesh.rods.iter().map(|nodes| {
            let [a, b] = nodes.map(|i| at[i as usize]);
            let (way, from) = (b - a, point - a);
            let square = way.norm_squared();
            let part = if square > 0.0 { (way.dot(&from) / square).clamp(0.0, 1.0) } else { 0.0 };
            (Spot::of_rod(*nodes, part), (from - way * part).norm())
        });
        let triangles = mesh.triangles.iter().map(|nodes| in_triangle(*nodes, at, point));
        let nearer = |a: (Spot, Real), b: (Spot, Real)| if b.1 < a.1 { b } else { a };
        let none = (Spot::of_rod([0; 2], 0.0), Real::INFINITY);
        triangles.chain(rods).fold(none, nearer)
    }
}

/// The point of a triangle of six nodes that is nearest to a point, by Newton's method in its coordinates, and how far it is (m).
fn in_triangle(nodes: [u32; 6], at: &[Vec2], point: Vec2) -> (Spot, Real) {
    let places = nodes.map(|i| at[i as usize] - point);
    let mut l = [1.0 / 3.0; 3];
    for _ in 0..ITERATIONS {
        let spot = Spot::of_triangle([0, 1, 2, 3, 4, 5], l);
        let off = spot.of(&places);
        let slope = |i: usize| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            // The node between i and j has the number 3 + i.
            places[i] * (4.0 * l[i] - 1.0) + (places[3 + i] * l[j] + places[3 + k] * l[k]) * 4.0
        };
        let [s0, s1, s2] = [slope(0), slope(1), slope(2)];
        let (a, b) = (s1 - s0, s2 - s0);
        let area = cross(a, b);
        if area == 0.0 {
            break;
        }
        let step = vec2(-cross(off, b) / area, cross(off, a) / area);
        if !(step.x.is_finite() && step.y.is_finite()) {
            break;
        }
        l = inside([l[0] - step.x - step.y, l[1] + step.x, l[2] + step.y]);
    }
    let spot = Spot::of_triangle(nodes, l);
    (spot, Spot::of_triangle([0, 1, 2, 3, 4, 5], l).of(&places).norm())
}

/// The nearest coordinates in the triangle, as far as clamping finds them; exact inside.
fn inside(l: [Real; 3]) -> [Real; 3] {
    let l = l.map(|x| if x > 0.0 { x } else { 0.0 });
    let sum: Real = l.iter().sum();
    if sum > 0.0 && sum.is_finite() { l.map(|x| x / sum) } else { [1.0 / 3.0; 3] }
}
