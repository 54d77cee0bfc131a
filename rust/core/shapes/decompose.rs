//! Convex decomposition: constrained Delaunay triangles (the `spade` crate), merged across
//! inessential diagonals (Hertel and Mehlhorn, "Fast triangulation of simple polygons", 1983: at
//! most four times the fewest pieces).

use std::cmp::Ordering;

use spade::handles::FixedVertexHandle;
use spade::{ConstrainedDelaunayTriangulation, Point2, Triangulation};

use super::predicates::{binade, magnitude, side};
use crate::math::{Real, Vec2};

/// Convex pieces of a polygon: a counter-clockwise outline and clockwise holes, clean.
pub(super) fn convex_pieces(rings: &[Vec<Vec2>]) -> Vec<Vec<Vec2>> {
    let points: Vec<Vec2> = rings.iter().flatten().copied().collect();
    let mut mesh = HalfEdges::new(&points, &triangles(&points, rings));
    for edge in mesh.diagonals() {
        mesh.remove_if_convex(edge);
    }
    mesh.faces()
}

/// Triangles inside the polygon, counter-clockwise, as places of their vertices in `points`.
fn triangles(points: &[Vec2], rings: &[Vec<Vec2>]) -> Vec<[usize; 3]> {
    // Numbers near 1, as spade asks; scaling by a power of two keeps every digit, hence every
    // predicate.
    let shrink = 1.0 / binade(magnitude(points));
    let vertices = points.iter().map(|p| Point2::new(p.x * shrink, p.y * shrink)).collect();
    let mut constraints = Vec::with_capacity(points.len());
    let mut first = 0;
    for ring in rings {
        let n = ring.len();
        constraints.extend((0..n).map(|i| [first + i, first + (i + 1) % n]));
        first += n;
    }
    type Mesh = ConstrainedDelaunayTriangulation<Point2<Real>>;
    // OK because the coordinates are finite and in spade's range, and no two edges of clean rings
    // cross.
    let mesh = Mesh::bulk_load_cdt(vertices, constraints.clone()).expect("clean rings");

    // The polygon lies left of every edge of its rings; from there it spreads up to the next edge.
    let mut inside = vec![false; mesh.num_all_faces()];
    let mut open = Vec::new();
    for [from, to] in constraints {
        let [from, to] = [from, to].map(FixedVertexHandle::from_index);
        let edge = mesh.get_edge_from_neighbors(from, to);
        open.extend(edge.and_then(|edge| edge.face().as_inner()));
    }
    let mut found = Vec::new();
    while let Some(face) = open.pop() {
        if std::mem::replace(&mut inside[face.index()], true) {
            continue;
        }
        found.push(face.vertices().map(|vertex| vertex.index()));
        let free = face.adjacent_edges().into_iter().filter(|edge| !edge.is_constraint_edge());
        open.extend(free.filter_map(|edge| edge.rev().face().as_inner()));
    }
    found
}

/// A mesh of polygons. Half-edge h runs from `origin[h]` to `origin[next[h]]`, with its polygon on
/// the left.
struct HalfEdges<'a> {
    points: &'a [Vec2],
    origin: Vec<usize>,
    next: Vec<usize>,
    previous: Vec<usize>,
    /// The half-edge on the other side, where there is one.
    twin: Vec<Option<usize>>,
    removed: Vec<bool>,
}

impl<'a> HalfEdges<'a> {
    fn new(points: &'a [Vec2], triangles: &[[usize; 3]]) -> Self {
        let n = 3 * triangles.len();
        let origin: Vec<usize> = triangles.iter().flatten().copied().collect();
        let next: Vec<usize> = (0..n).map(|h| h - h % 3 + (h + 1) % 3).collect();
        let previous: Vec<usize> = (0..n).map(|h| h - h % 3 + (h + 2) % 3).collect();
        // Sorted by their ends, the two halves of an edge are neighbours.
        let mut sorted: Vec<([usize; 2], usize)> = (0..n)
            .map(|h| {
                let (a, b) = (origin[h], origin[next[h]]);
                ([a.min(b), a.max(b)], h)
            })
            .collect();
        sorted.sort_unstable();
        let mut twin = vec![None; n];
        for pair in sorted.windows(2) {
            let [(ends, h), (other_ends, t)] = [pair[0], pair[1]];
            if ends == other_ends {
                (twin[h], twin[t]) = (Some(t), Some(h));
            }
        }
        Self { points, origin, next, previous, twin, removed: vec![false; n] }
    }

    /// The edges between two polygons, longest first: dropping long ones first keeps pieces round.
    fn diagonals(&self) -> Vec<usize> {
        let length = |h: usize| (self.start(self.next[h]) - self.start(h)).norm_squared();
        let inner = |&h: &usize| self.twin[h].is_some_and(|twin| h < twin);
        let mut diagonals: Vec<usize> = (0..self.origin.len()).filter(inner).collect();
        diagonals.sort_by(|&g, &h| length(h).total_cmp(&length(g)));
        diagonals
    }

    /// Joins the polygons on both sides of an edge if the result turns left at both its ends.
    fn remove_if_convex(&mut self, h: usize) {
        let Some(t) = self.twin[h] else { return };
        let [(before_h, after_h), (before_t, after_t)] =
            [h, t].map(|edge| (self.previous[edge], self.next[edge]));
        if !self.turns_left(before_h, after_t) || !self.turns_left(before_t, after_h) {
            return;
        }
        for (before, after) in [(before_h, after_t), (before_t, after_h)] {
            self.next[before] = after;
            self.previous[after] = before;
        }
        self.removed[h] = true;
        self.removed[t] = true;
    }

    /// Whether `before`, followed by `after`, turns left, strictly.
    fn turns_left(&self, before: usize, after: usize) -> bool {
        let [a, b, c] = [before, after, self.next[after]].map(|h| self.start(h));
        side(a, b, c) == Ordering::Greater
    }

    fn start(&self, h: usize) -> Vec2 {
        self.points[self.origin[h]]
    }

    fn faces(mut self) -> Vec<Vec<Vec2>> {
        let mut faces = Vec::new();
        for first in 0..self.origin.len() {
            let mut face = Vec::new();
            let mut h = first;
            while !std::mem::replace(&mut self.removed[h], true) {
                face.push(self.start(h));
                h = self.next[h];
            }
            if !face.is_empty() {
                faces.push(face);
            }
        }
        faces
    }
}
