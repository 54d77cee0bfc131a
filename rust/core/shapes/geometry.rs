//! The few kinds of geometry behind all shapes, and the questions each answers.

use std::f64::consts::{FRAC_PI_2, TAU};

use super::arc::WireArc;
use super::bounds::Interval;
use super::predicates::{Place, edges, place};
use super::round::{Corner, corners};
use crate::math::{Real, Rot, Vec2};

/// A polyline: closed for an outline, open for a wire.
#[derive(Clone, Debug, PartialEq)]
pub struct Ring {
    /// Its vertices (m); of a closed one the first is not repeated at the end.
    pub points: Vec<Vec2>,
    /// Whether the last point is joined to the first.
    pub closed: bool,
}

#[derive(Debug)]
pub(super) enum Geometry {
    /// All points within `radius` of a convex core: one point, two, or a counter-clockwise polygon.
    /// Two points without radius are a wire.
    Swept { core: Vec<Vec2>, radius: Real },
    /// A polygon that is not convex: outline, holes, and the hull that bounds them.
    Polygon { rings: Vec<Vec<Vec2>>, hull: Vec<Vec2> },
    /// A circular wire.
    Arc(WireArc),
    /// Straight wires, and the hull that bounds them.
    Chain { ring: Ring, hull: Vec<Vec2> },
}

impl Geometry {
    pub fn is_wire(&self) -> bool {
        match self {
            Self::Swept { core, radius } => core.len() == 2 && *radius == 0.0,
            Self::Polygon { .. } => false,
            Self::Arc(_) | Self::Chain { .. } => true,
        }
    }

    pub fn projection(&self, direction: Vec2) -> Interval {
        match self {
            Self::Swept { core, radius } => Interval::of(core, direction).grown(*radius),
            Self::Polygon { hull, .. } | Self::Chain { hull, .. } => Interval::of(hull, direction),
            Self::Arc(arc) => arc.span(direction).moved(arc.center.dot(&direction)),
        }
    }

    pub fn contains(&self, p: Vec2) -> bool {
        match self {
            _ if self.is_wire() => false,
            Self::Swept { core, radius } => {
                let near = |[a, b]: [Vec2; 2]| distance_squared(a, b, p) <= radius * radius;
                (core.len() > 2 && place(core, p) != Place::Outside)
                    || (*radius > 0.0 && edges(core).any(near))
            }
            Self::Polygon { rings, .. } => {
                let places = || rings.iter().map(|ring| place(ring, p));
                places().any(|at| at == Place::Border)
                    || places().filter(|&at| at == Place::Inside).count() == 1
            }
            Self::Arc(_) | Self::Chain { .. } => false,
        }
    }

    pub fn extent_from(&self, center: Vec2) -> Real {
        let farthest = |points: &[Vec2]| {
            points.iter().map(|p| (p - center).norm_squared()).fold(0.0, Real::max).sqrt()
        };
        match self {
            Self::Swept { core, radius } => farthest(core) + radius,
            Self::Polygon { hull, .. } | Self::Chain { hull, .. } => farthest(hull),
            Self::Arc(arc) => arc.extent_from(center),
        }
    }
}

/// Polylines of a convex core rounded by a disk: each corner turns in equal steps of at most
/// `max_angle`.
pub(super) fn rounded_outline(core: &[Vec2], radius: Real, max_angle: Real) -> Vec<Vec2> {
    let corner = |Corner { vertex, before, turn, .. }: Corner| {
        let steps = steps(turn, max_angle);
        let last = if core.len() == 1 { steps - 1 } else { steps }; // a circle ends where it began
        (0..=last).map(move |k| {
            let angle = turn * Real::from(k) / Real::from(steps);
            vertex + Rot::new(angle).apply(before) * radius
        })
    };
    corners(core).into_iter().flat_map(corner).collect()
}

/// Number of steps in which to draw a turn: at least one a quarter turn, at most 65 536 a turn.
pub(super) fn steps(turn: Real, max_angle: Real) -> u32 {
    const MOST: Real = 65_536.0;
    let max_angle = if max_angle.is_nan() { FRAC_PI_2 } else { max_angle };
    (turn / max_angle.clamp(TAU / MOST, FRAC_PI_2)).ceil().max(1.0) as u32
}

fn distance_squared(a: Vec2, b: Vec2, p: Vec2) -> Real {
    let (ab, ap) = (b - a, p - a);
    let length_squared = ab.norm_squared();
    let t = if length_squared > 0.0 { (ap.dot(&ab) / length_squared).clamp(0.0, 1.0) } else { 0.0 };
    (ap - ab * t).norm_squared()
}
