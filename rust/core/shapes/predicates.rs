//! Exact questions about points: every answer here is the one real arithmetic would give
//! (Shewchuk's adaptive predicates, from the `robust` crate).

use std::cmp::Ordering;

use crate::math::{Real, Vec2};

/// Side of the directed line a → b on which c lies: `Greater` left, `Less` right, `Equal` on it.
pub(super) fn side(a: Vec2, b: Vec2, c: Vec2) -> Ordering {
    let coord = |p: Vec2| robust::Coord { x: p.x, y: p.y };
    let det = robust::orient2d(coord(a), coord(b), coord(c));
    det.partial_cmp(&0.0).unwrap_or(Ordering::Equal)
}

/// Whether the closed polygon turns left, strictly, at every vertex and goes round once.
pub(super) fn is_convex(ring: &[Vec2]) -> bool {
    let corners = || corners(ring);
    let rises = |a: Vec2, b: Vec2| (a.y, a.x) < (b.y, b.x);
    // A ring that only turns left goes round once exactly when it has one lowest point.
    corners().all(|[a, b, c]| side(a, b, c) == Ordering::Greater)
        && corners().filter(|&[a, b, c]| !rises(a, b) && rises(b, c)).count() == 1
}

/// Whether a simple ring runs counter-clockwise: it does if it turns left at an extreme vertex.
pub(super) fn is_counter_clockwise(ring: &[Vec2]) -> bool {
    let lowest = corners(ring).min_by(|[_, p, _], [_, q, _]| order(*p, *q));
    lowest.is_some_and(|[a, b, c]| side(a, b, c) == Ordering::Greater)
}

/// Where a point lies relative to a ring.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Place {
    Inside,
    Border,
    Outside,
}

/// Where `p` lies relative to the closed polygon: parity of the crossings of a ray towards +x.
pub(super) fn place(ring: &[Vec2], p: Vec2) -> Place {
    let mut inside = false;
    for [a, b] in edges(ring) {
        if p == a {
            return Place::Border;
        }
        if (a.y <= p.y) != (b.y <= p.y) {
            match side(a, b, p) {
                Ordering::Equal => return Place::Border,
                turn => inside ^= (turn == Ordering::Greater) == (b.y > a.y),
            }
        } else if a.y == p.y && b.y == p.y && (a.x <= p.x) != (b.x <= p.x) {
            return Place::Border;
        }
    }
    if inside { Place::Inside } else { Place::Outside }
}

/// Convex hull, counter-clockwise and without collinear vertices (Andrew's monotone chain).
pub(super) fn convex_hull(points: &[Vec2]) -> Vec<Vec2> {
    let mut sorted = points.to_vec();
    sorted.sort_unstable_by(|p, q| order(*p, *q));
    let mut hull: Vec<Vec2> = Vec::with_capacity(points.len());
    let backwards = sorted.iter().rev().skip(1);
    let mut floor = 1;
    for (i, &p) in sorted.iter().chain(backwards).enumerate() {
        if i == sorted.len() {
            floor = hull.len();
        }
        while hull.len() > floor
            && side(hull[hull.len() - 2], hull[hull.len() - 1], p) != Ordering::Greater
        {
            hull.pop();
        }
        hull.push(p);
    }
    hull.pop(); // the first point again
    hull
}

/// The edges of a closed ring.
pub(super) fn edges(ring: &[Vec2]) -> impl Iterator<Item = [Vec2; 2]> + '_ {
    let next = ring.iter().cycle().skip(1);
    ring.iter().zip(next).map(|(&a, &b)| [a, b])
}

/// Each vertex of a closed ring between its neighbours.
pub(super) fn corners(ring: &[Vec2]) -> impl Iterator<Item = [Vec2; 3]> + '_ {
    let n = ring.len();
    (0..n).map(move |i| [ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]])
}

/// Largest coordinate, in absolute value.
pub(super) fn magnitude(points: &[Vec2]) -> Real {
    points.iter().fold(0.0, |m, p| p.x.abs().max(p.y.abs()).max(m))
}

/// The largest power of two not above `x`, which is normal and positive: scaling by it loses no
/// digit.
pub(super) fn binade(x: Real) -> Real {
    const EXPONENT: u64 = 0x7ff0_0000_0000_0000;
    Real::from_bits(x.to_bits() & EXPONENT)
}

fn order(p: Vec2, q: Vec2) -> Ordering {
    p.y.total_cmp(&q.y).then(p.x.total_cmp(&q.x))
}
