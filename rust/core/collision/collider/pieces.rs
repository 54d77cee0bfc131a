//! The convex pieces of a polygon, and what is border and what is cut.

use std::collections::HashMap;

use super::{Cone, Convex, Joins};
use crate::math::{Real, Vec2, cross, perp};

/// A vertex of the outline between its neighbours.
struct Corner {
    before: Vec2,
    after: Vec2,
    next: Vec2,
}

/// The pieces about `center`. Their vertices are those of the rings, which have their matter on the left.
pub(super) fn joined<'a>(
    rings: impl Iterator<Item = &'a Vec<Vec2>>,
    pieces: &[Vec<Vec2>],
    center: Vec2,
) -> Vec<Convex> {
    let mut corners = HashMap::new();
    for ring in rings {
        let n = ring.len();
        let normal = |i: usize| -perp((ring[(i + 1) % n] - ring[i % n]).normalize());
        for i in 0..n {
            let (before, after, next) = (normal(i + n - 1), normal(i), ring[(i + 1) % n]);
            corners.insert(key(ring[i]), Corner { before, after, next });
        }
    }
    let piece = |vertices: &Vec<Vec2>| {
        let joins = joins(vertices, &corners);
        let vertices = vertices.iter().map(|v| v - center).collect();
        Convex { joins: Some(Box::new(joins)), ..Convex::new(vertices, 0.0) }
    };
    pieces.iter().map(piece).collect()
}

fn joins(vertices: &[Vec2], corners: &HashMap<[u64; 2], Corner>) -> Joins {
    let corner = |v: &Vec2| corners.get(&key(*v));
    let cone = |v: &Vec2| {
        let Corner { before, after, .. } = *corner(v)?;
        (cross(before, after) > 0.0).then_some(Cone { from: before, to: after })
    };
    let is_outer = |(v, next): (&Vec2, &Vec2)| corner(v).is_some_and(|corner| corner.next == *next);
    let ends = vertices.iter().cycle().skip(1);
    Joins {
        outer: vertices.iter().zip(ends).map(is_outer).collect(),
        cones: vertices.iter().map(cone).collect(),
        one_sided: false,
    }
}

/// The bits of a point; both zeros are one.
fn key(p: Vec2) -> [u64; 2] {
    let bits = |x: Real| (x + 0.0).to_bits();
    [bits(p.x), bits(p.y)]
}
