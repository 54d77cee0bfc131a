//! Meshes: triangles of six nodes, and rods of two.

use serde::{Deserialize, Serialize};

use super::triangulate;
use crate::error::{Error, Result, check};
use crate::math::{Real, Vec2, cross, vec2};
use crate::shapes::{Shape, ShapeDef};

/// Nodes at rest, and the elements between them. Triangles have a node at each corner and one half-way along each side.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Mesh {
    /// Places of the nodes at rest (m).
    pub(crate) rest: Vec<Vec2>,
    /// Corners, counter-clockwise, then the nodes on the sides 01, 12, 20.
    pub(crate) triangles: Vec<[u32; 6]>,
    /// Ends of the rods.
    pub(crate) rods: Vec<[u32; 2]>,
    /// Pieces of the border from node to node, with the matter on the left; of ropes, the rods.
    pub(crate) border: Vec<[u32; 2]>,
}

/// Most nodes of a body.
const MOST: usize = 200_000;

/// Making meshes.
impl Mesh {
    /// Triangles between given points; sides get their middle nodes here. Triangles may be given either way round.
    ///
    /// # Errors
    /// Points that are not finite, triangles that name no point or have no area, points in no triangle, and sides that more than two
    /// triangles share.
    pub fn new(points: &[Vec2], triangles: &[[u32; 3]]) -> Result<Self> {
        for point in points {
            check::finite_vec("a point of the mesh", *point)?;
        }
        if triangles.is_empty() || points.len() > MOST {
            let got = format!("{} triangles, {} points", triangles.len(), points.len());
            return Err(Error::invalid(
                "the mesh",
                got,
                format!("1 triangle at least, {MOST} points at most"),
            ));
        }
        let mut used = vec![false; points.len()];
        let mut turned = Vec::with_capacity(triangles.len());
        for (k, triangle) in triangles.iter().enumerate() {
            let wrong = |allowed: &str| {
                Error::invalid(
                    format!("triangle {k} of the mesh"),
                    format!("{triangle:?}"),
                    allowed,
                )
            };
            let [a, b, c] = *triangle;
            if triangle.iter().any(|&i| i as usize >= points.len()) {
                return Err(wrong("numbers of three points"));
            }
            triangle.iter().for_each(|&i| used[i as usize] = true);
            let [p, q, r] = triangle.map(|i| points[i as usize]);
            let area = cross(q - p, r - p);
            let size = (q - p).norm_squared() + (r - p).norm_squared();
            if !(area.abs() > 1e-9 * size && area.is_normal()) {
                return Err(wrong("three points that are not on one line"));
            }
            turned.push(if area > 0.0 { [a, b, c] } else { [a, c, b] });
        }
        if let Some(lone) = used.iter().position(|used| !used) {
            return Err(Error::invalid(
                "points of the mesh",
                format!("point {lone} in no triangle"),
                "points of triangles",
            ));
        }
        Self::with_sides(points, &turned)
    }

    /// Puts a node on each side.
    fn with_sides(points: &[Vec2], triangles: &[[u32; 3]]) -> Result<Self> {
        let mut sides: Vec<([u32; 2], usize, usize)> = Vec::with_capacity(3 * triangles.len());
        for (k, corners) in triangles.iter().enumerate() {
            for side in 0..3 {
                let (a, b) = (corners[side], corners[(side + 1) % 3]);
                sides.push(([a.min(b), a.max(b)], k, side));
            }
        }
        sides.sort_unstable();
        let mut rest = points.to_vec();
        let mut full: Vec<[u32; 6]> =
            triangles.iter().map(|&[a, b, c]| [a, b, c, 0, 0, 0]).collect();
        let mut open = Vec::new();
        for shared in sides.chunk_by(|x, y| x.0 == y.0) {
            let ([a, b], k, side) = shared[0];
            if shared.len() > 2 {
                let got = format!("{} triangles between points {a} and {b}", shared.len());
                return Err(Error::invalid("the mesh", got, "at most two on a side"));
            }
            let middle = rest.len() as u32;
            rest.push((points[a as usize] + points[b as usize]) * 0.5);
            for &(_, k, side) in shared {
                full[k][3 + side] = middle;
            }
            if shared.len() == 1 {
                open.push((triangles[k][side], middle, triangles[k][(side + 1) % 3]));
            }
        }
        let border = open.iter().flat_map(|&(a, m, b)| [[a, m], [m, b]]).collect();
        Ok(Self { rest, triangles: full, rods: Vec::new(), border })
    }

    /// A box about the origin of `columns` × `rows` cells of two triangles each, the diagonals mirrored about both axes where the
    /// numbers are even.
    ///
    /// # Errors
    /// Lengths that are not above 0, no cells, too many.
    pub fn rectangle(width: Real, height: Real, [columns, rows]: [u32; 2]) -> Result<Self> {
        check::positive("width", width)?;
        check::positive("height", height)?;
        let cells = u64::from(columns) * u64::from(rows);
        if cells == 0 || 4 * cells > MOST as u64 {
            return Err(Error::invalid(
                "cells",
                format!("{columns} x {rows}"),
                format!("1 to {}", MOST / 4),
            ));
        }
        let at = |i: u32, j: u32| {
            let part =
                |k: u32, n: u32| (2.0 * Real::from(k) - Real::from(n)) / (2.0 * Real::from(n));
            vec2(part(i, columns) * width, part(j, rows) * height)
        };
        let points: Vec<Vec2> =
            (0..=rows).flat_map(|j| (0..=columns).map(move |i| at(i, j))).collect();
        let mut triangles = Vec::with_capacity(2 * cells as usize);
        for (i, j) in (0..rows).flat_map(|j| (0..columns).map(move |i| (i, j))) {
            let a = j * (columns + 1) + i;
            let [a, b, c, d] = [a, a + 1, a + columns + 2, a + columns + 1];
            let rising = (2 * i < columns) == (2 * j < rows);
            triangles.extend(if rising { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] });
        }
        Self::new(&points, &triangles)
    }

    /// A shape with an area, in triangles with sides of about `size` (m).
    ///
    /// # Errors
    /// A size that is not above 0 or asks for too many nodes; a thin shape (segments, arcs, chains).
    pub fn of_shape(shape: &Shape, size: Real) -> Result<Self> {
        check::positive("size", size)?;
        if shape.is_wire() {
            return Err(Error::invalid("shape", "a wire", "a shape with an area"));
        }
        // About √3/4 size² a triangle, twice as many nodes.
        if shape.area() / (size * size) > 0.2 * MOST as Real {
            let allowed = format!("a size of triangles that asks for less than {MOST} nodes");
            return Err(Error::invalid("size", size, allowed));
        }
        if let ShapeDef::Box { width, height, center, angle } = *shape.def() {
            let cells = |length: Real| ((length / size).ceil().max(1.0)) as u32;
            let mut mesh = Self::rectangle(width, height, [cells(width), cells(height)])?;
            let pose = crate::math::Pose::new(center, angle);
            mesh.rest.iter_mut().for_each(|p| *p = pose.apply(*p));
            return Ok(mesh);
        }
        // Round borders in pieces of the size.
        let reach = shape.bounds();
        let radius = 0.5 * (reach.max - reach.min).amax();
        let rings: Vec<Vec<Vec2>> =
            shape.outline((size / radius).min(0.5)).into_iter().map(|ring| ring.points).collect();
        let (points, triangles) = triangulate::refined(&rings, size)?;
        Self::new(&points, &triangles)
    }

    /// A simple polygon with holes, in triangles with sides of about `size` (m).
    ///
    /// # Errors
    /// As [`Shape::polygon_with_holes`] and [`Mesh::of_shape`].
    pub fn polygon(outline: &[Vec2], holes: &[Vec<Vec2>], size: Real) -> Result<Self> {
        Self::of_shape(&Shape::polygon_with_holes(outline, holes)?, size)
    }

    /// A rope through these points, a rod between each and the next; closed, back to the first.
    ///
    /// # Errors
    /// Points that are not finite, fewer than two (three of a closed one), and two in one place in a row.
    pub fn rope(points: &[Vec2], closed: bool) -> Result<Self> {
        let least = if closed { 3 } else { 2 };
        if points.len() < least || points.len() > MOST {
            return Err(Error::invalid(
                "points of the rope",
                points.len(),
                format!("{least} to {MOST}"),
            ));
        }
        for point in points {
            check::finite_vec("a point of the rope", *point)?;
        }
        let n = points.len() as u32;
        let rods: Vec<[u32; 2]> =
            (0..if closed { n } else { n - 1 }).map(|i| [i, (i + 1) % n]).collect();
        for &[a, b] in &rods {
            let length = (points[b as usize] - points[a as usize]).norm();
            check::positive(&format!("distance of points {a} and {b} of the rope"), length)?;
        }
        Ok(Self { rest: points.to_vec(), triangles: Vec::new(), border: rods.clone(), rods })
    }
}

/// What it is made of.
impl Mesh {
    /// Places of the nodes at rest (m).
    #[must_use]
    pub fn rest(&self) -> &[Vec2] {
        &self.rest
    }

    /// The triangles: corners, counter-clockwise, then the nodes on the sides 01, 12, 20.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 6]] {
        &self.triangles
    }

    /// The rods.
    #[must_use]
    pub fn rods(&self) -> &[[u32; 2]] {
        &self.rods
    }

    /// Pieces of the border from node to node, with the matter on the left.
    #[must_use]
    pub fn border(&self) -> &[[u32; 2]] {
        &self.border
    }

    /// The nodes at rest for which something holds, to pin or load them.
    #[must_use]
    pub fn nodes_where(&self, holds: impl Fn(Vec2) -> bool) -> Vec<u32> {
        (0..self.rest.len() as u32).filter(|&i| holds(self.rest[i as usize])).collect()
    }

    /// Groups of nodes that depend on one another directly.
    pub(super) fn cliques(&self) -> impl Iterator<Item = &[u32]> {
        let triangles = self.triangles.iter().map(|nodes| &nodes[..]);
        triangles.chain(self.rods.iter().map(|nodes| &nodes[..]))
    }

    /// Nodes before and after each node at which two rods meet.
    pub(super) fn bends(&self) -> Vec<[u32; 3]> {
        let mut into = vec![None; self.rest.len()];
        for &[a, b] in &self.rods {
            into[b as usize] = Some(a);
        }
        let meets = |&[b, c]: &[u32; 2]| into[b as usize].map(|a| [a, b, c]);
        self.rods.iter().filter_map(meets).collect()
    }
}
