//! The walk around the Minkowski difference of two cores.

use super::super::{Convex, Frame};
use crate::math::{Real, Vec2};

/// A face of one core, the vertex of the other that lies deepest along its normal, and how far that lies
/// above the face.
#[derive(Clone, Copy, Debug)]
pub(super) struct Axis {
    pub face: usize,
    pub vertex: usize,
    pub separation: Real,
}

/// All faces of `reference` against `other`. The deepest vertex runs round as the normal does (rotating
/// calipers; M. I. Shamos, "Computational geometry", 1978), so this takes as long as both have vertices.
#[inline]
pub(super) fn axes<'a>(
    reference: &'a Convex,
    other: &'a Convex,
    frame: &Frame,
) -> impl Iterator<Item = Axis> + 'a {
    let frame = *frame;
    let vertices = &*other.vertices;
    let mut vertex = None;
    reference.normals.iter().enumerate().map(move |(face, &normal)| {
        let down = frame.rot.apply_inverse(normal);
        let deepest = match vertex {
            Some(last) if vertices.len() > FEW => walk(vertices, down, last),
            _ => scan(vertices, down),
        };
        vertex = Some(deepest);
        let offset = normal.dot(&(frame.position - reference.vertices[face]));
        Axis { face, vertex: deepest, separation: offset + down.dot(&vertices[deepest]) }
    })
}

/// Up to this many vertices, looking at all is as fast.
const FEW: usize = 8;

/// The extent of a core along each of its normals (m).
pub(in super::super) fn widths(core: &Convex) -> impl Iterator<Item = Real> + '_ {
    axes(core, core, &Frame::IDENTITY).map(|axis| -axis.separation)
}

/// The axis of largest separation.
#[inline]
pub(super) fn best(
    reference: &Convex,
    other: &Convex,
    frame: &Frame,
    enough: Real,
) -> Option<Axis> {
    let mut best: Option<Axis> = None;
    for axis in axes(reference, other, frame) {
        if best.is_none_or(|best| axis.separation > best.separation) {
            best = Some(axis);
            if axis.separation > enough {
                break;
            }
        }
    }
    best
}

/// The first vertex of least height along a direction.
#[inline]
fn scan(vertices: &[Vec2], direction: Vec2) -> usize {
    let mut lowest = (0, vertices[0].dot(&direction));
    for (i, v) in vertices.iter().enumerate().skip(1) {
        let height = v.dot(&direction);
        if height < lowest.1 {
            lowest = (i, height);
        }
    }
    lowest.0
}

/// The same from a vertex that comes before it. It looks two vertices ahead, so that an edge as short as
/// rounding does not stop it.
fn walk(vertices: &[Vec2], direction: Vec2, from: usize) -> usize {
    let n = vertices.len();
    let height = |i: usize| vertices[i % n].dot(&direction);
    let mut at = from;
    for _ in 0..n {
        let here = height(at);
        at = if height(at + 1) < here {
            at + 1
        } else if height(at + 2) < here {
            at + 2
        } else {
            break;
        };
    }
    at % n
}
