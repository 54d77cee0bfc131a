//! Which edges of closed rings cross or touch: sort and sweep along an axis, then exact predicates.

use std::cmp::Ordering::{self, Equal};

use super::bounds::Interval;
use super::predicates::{edges, side};
use crate::math::Vec2;

/// Two edges that share a point they should not share, as (ring, place in the ring).
pub(super) struct Conflict {
    pub edges: [(usize, usize); 2],
    /// They cross; otherwise they only touch.
    pub cross: bool,
}

struct Edge {
    ends: [Vec2; 2],
    /// Its extent along the sweep.
    span: Interval,
    ring: usize,
    place: usize,
    ring_len: usize,
}

impl Edge {
    /// Neighbours share the vertex between them; that they do not fold back on each other is the
    /// caller's to know.
    fn is_next_to(&self, other: &Self) -> bool {
        let step = self.place.abs_diff(other.place);
        self.ring == other.ring && (step == 1 || step + 1 == self.ring_len)
    }
}

/// A pair of edges that cross or touch, other than neighbours in a ring at their common vertex.
pub(super) fn find(rings: &[&[Vec2]]) -> Option<Conflict> {
    let axis = sweep_axis(rings);
    let mut sorted: Vec<Edge> = Vec::new();
    for (ring, points) in rings.iter().enumerate() {
        let edge = |(place, ends): (usize, [Vec2; 2])| {
            let span = Interval::EMPTY.with(ends[0][axis]).with(ends[1][axis]);
            Edge { ends, span, ring, place, ring_len: points.len() }
        };
        sorted.extend(edges(points).enumerate().map(edge));
    }
    sorted.sort_by(|e, f| e.span.min.total_cmp(&f.span.min));
    let mut open: Vec<&Edge> = Vec::new();
    for edge in &sorted {
        open.retain(|other| other.span.max >= edge.span.min);
        for other in &open {
            if !edge.is_next_to(other)
                && let Some(cross) = meet(edge.ends, other.ends)
            {
                let mut edges = [(edge.ring, edge.place), (other.ring, other.place)];
                edges.sort_unstable();
                return Some(Conflict { edges, cross });
            }
        }
        open.push(edge);
    }
    None
}

/// The axis along which the edges are shorter, in all, relative to the whole: few overlap on it.
fn sweep_axis(rings: &[&[Vec2]]) -> usize {
    let crowding = |axis: usize| {
        let points = rings.iter().flat_map(|ring| ring.iter());
        let whole = points.fold(Interval::EMPTY, |span, p| span.with(p[axis])).length();
        let edges = rings.iter().flat_map(|ring| edges(ring));
        edges.map(|[a, b]| (b[axis] - a[axis]).abs()).sum::<f64>() / whole
    };
    usize::from(crowding(1) < crowding(0))
}

/// Whether two segments share a point, and if so whether they cross there.
fn meet([a, b]: [Vec2; 2], [c, d]: [Vec2; 2]) -> Option<bool> {
    if !overlap([a.y, b.y], [c.y, d.y]) || !overlap([a.x, b.x], [c.x, d.x]) {
        return None;
    }
    let sides = [side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b)];
    let apart = |s: Ordering, t: Ordering| s == t && s != Equal;
    if apart(sides[0], sides[1]) || apart(sides[2], sides[3]) {
        return None;
    }
    if !sides.contains(&Equal) {
        return Some(true);
    }
    let on = |s: Ordering, p: Vec2, q: Vec2, r: Vec2| {
        s == Equal && overlap([p.x, q.x], [r.x, r.x]) && overlap([p.y, q.y], [r.y, r.y])
    };
    let touch = on(sides[0], a, b, c)
        || on(sides[1], a, b, d)
        || on(sides[2], c, d, a)
        || on(sides[3], c, d, b);
    touch.then_some(false)
}

fn overlap([a, b]: [f64; 2], [c, d]: [f64; 2]) -> bool {
    a.min(b) <= c.max(d) && c.min(d) <= a.max(b)
}
