//! What shapes are grown from: convex cores and arcs, and how far a point of them is.

use super::{Convex, Frame, Geometry, WireArc};
use crate::math::{Real, Rot, Vec2, perp};

/// A convex core with its radius, or a piece of an arc.
#[derive(Clone, Copy, Debug)]
pub(super) enum Core<'a> {
    Convex(&'a Convex),
    Arc(WireArc),
}

impl<'a> From<&'a Geometry> for Core<'a> {
    fn from(geometry: &'a Geometry) -> Self {
        match geometry {
            Geometry::Convex(convex) => Self::Convex(convex),
            Geometry::Arc(arc) => Self::Arc(*arc),
        }
    }
}

impl Core<'_> {
    /// What it is grown by (m).
    pub fn radius(&self) -> Real {
        if let Self::Convex(convex) = self { convex.radius } else { 0.0 }
    }

    /// Largest p·u of its points p (m).
    pub fn support(&self, u: Vec2) -> Real {
        match self {
            Self::Convex(convex) => highest(convex, u).1,
            Self::Arc(arc) if arc.includes(u) => arc.center.dot(&u) + arc.radius * u.norm(),
            Self::Arc(arc) => {
                ends(arc).map(|end| end.dot(&u)).into_iter().fold(Real::MIN, Real::max)
            }
        }
    }

    /// Largest distance of its points from a point (m).
    pub fn extent_from(&self, point: Vec2) -> Real {
        let farthest = |points: &[Vec2]| {
            points.iter().map(|p| (p - point).norm_squared()).fold(0.0, Real::max).sqrt()
        };
        match self {
            Self::Convex(convex) => farthest(&convex.vertices),
            Self::Arc(arc) => {
                let away = arc.center - point;
                if arc.includes(away) { away.norm() + arc.radius } else { farthest(&ends(arc)) }
            }
        }
    }
}

/// The vertex of a core that lies farthest along a direction, and its p·u.
pub(super) fn highest(core: &Convex, u: Vec2) -> (Vec2, Real) {
    let best = |best: (Vec2, Real), p: &Vec2| {
        let height = p.dot(&u);
        if height > best.1 { (*p, height) } else { best }
    };
    core.vertices.iter().fold((Vec2::zeros(), Real::NEG_INFINITY), best)
}

/// One edge of a core: its outward normal, and its ends.
pub(super) struct Edge {
    pub normal: Vec2,
    pub ends: [Vec2; 2],
}

impl Edge {
    /// The point nearest to `p`.
    pub fn nearest(&self, p: Vec2) -> Vec2 {
        let [from, to] = self.ends;
        let (along, arm) = (to - from, p - from);
        let (reached, length) = (arm.dot(&along), along.norm_squared());
        if reached <= 0.0 {
            from
        } else if reached >= length {
            to
        } else {
            p - self.normal * self.normal.dot(&arm)
        }
    }

    /// Whether `p` lies between the perpendiculars through the ends, which must differ.
    pub fn spans(&self, p: Vec2) -> bool {
        let [from, to] = self.ends;
        let along = to - from;
        from != to && (p - from).dot(&along) >= 0.0 && (p - to).dot(&along) <= 0.0
    }
}

/// The edges, counter-clockwise; of a segment, both sides; of a point, none.
pub(super) fn edges(core: &Convex) -> impl Iterator<Item = Edge> + '_ {
    let next = core.vertices.iter().cycle().skip(1);
    let ends = core.vertices.iter().zip(next);
    core.normals.iter().zip(ends).map(|(&normal, (&from, &to))| Edge { normal, ends: [from, to] })
}

/// Normals of lines that touch a core, with a point of the line, such that two cores that do not meet are
/// parted by one of them: the edges; of a segment, its ends as well; of a point, none.
pub(super) fn faces(core: &Convex) -> impl Iterator<Item = (Vec2, Edge)> + '_ {
    let tips = if let [a, b] = *core.vertices {
        let along = core.normals.first().map_or(Vec2::zeros(), |&normal| perp(normal));
        [(along, b), (-along, a)].map(Some)
    } else {
        [None; 2]
    };
    let tips = tips.into_iter().flatten().map(|(n, p)| (n, Edge { normal: n, ends: [p; 2] }));
    edges(core).map(|edge| (edge.normal, edge)).chain(tips)
}

/// How far a point is from a convex core (m), below 0 inside, and the nearest point of its border.
pub(super) fn point_to_convex(core: &Convex, p: Vec2) -> (Real, Vec2) {
    let two_sided = core.vertices.len() == 2;
    let (mut inside, mut outside) = ((Real::NEG_INFINITY, p), (Real::INFINITY, p));
    for edge in edges(core) {
        let height = edge.normal.dot(&(p - edge.ends[0]));
        if height > inside.0 {
            inside = (height, p - edge.normal * height);
        }
        if height >= 0.0 || two_sided {
            let nearest = edge.nearest(p);
            let distance = if edge.spans(p) { height.abs() } else { (p - nearest).norm() };
            if distance < outside.0 {
                outside = (distance, nearest);
            }
        }
    }
    match *core.vertices {
        [only] => ((p - only).norm(), only),
        [_, _] => outside,
        _ if inside.0 < 0.0 => inside,
        _ => outside,
    }
}

/// The two ends of an arc.
pub(super) fn ends(arc: &WireArc) -> [Vec2; 2] {
    [arc.from, arc.to].map(|end| arc.center + end * arc.radius)
}

/// How far a point is from an arc (m), the nearest point of it, and, where that is not an end, the unit vector that
/// leads there: exact also where the two all but coincide.
pub(super) fn point_to_arc(arc: &WireArc, p: Vec2) -> (Real, Vec2, Option<Vec2>) {
    let arm = p - arc.center;
    let length = arm.norm();
    if length > 0.0 && arc.includes(arm) {
        let outward = arm / length;
        let normal = if length <= arc.radius { outward } else { -outward };
        return ((length - arc.radius).abs(), arc.center + outward * arc.radius, Some(normal));
    }
    let [from, to] = ends(arc).map(|end| ((p - end).norm(), end, None));
    if from.0 <= to.0 { from } else { to }
}

/// An arc given in a frame, in the outer one.
pub(super) fn arc_in(arc: &WireArc, frame: &Frame) -> WireArc {
    let [from, to] = [arc.from, arc.to].map(|end| frame.rot.apply(end));
    WireArc { center: frame.apply(arc.center), from, to, ..*arc }
}

/// The two halves of an arc.
pub(super) fn halves(arc: &WireArc) -> [WireArc; 2] {
    let sweep = arc.sweep / 2.0;
    let middle = Rot::new(sweep).apply(arc.from);
    [WireArc { to: middle, sweep, ..*arc }, WireArc { from: middle, sweep, ..*arc }]
}
