//! Random shapes, built by hand.

use std::f64::consts::TAU;

use culbuto::collision::{Convex, Frame, Geometry, Sweep, WireArc};
use culbuto::math::{Pose, Real, Rot, Vec2, vec2};
use proptest::prelude::*;

pub fn convex(vertices: Vec<Vec2>, radius: Real) -> Geometry {
    Geometry::Convex(Convex::new(vertices, radius))
}

pub fn disk(center: Vec2, radius: Real) -> Geometry {
    convex(vec![center], radius)
}

pub fn rectangle(width: Real, height: Real) -> Geometry {
    let (x, y) = (width / 2.0, height / 2.0);
    convex(vec![vec2(-x, -y), vec2(x, -y), vec2(x, y), vec2(-x, y)], 0.0)
}

pub fn arc(center: Vec2, radius: Real, start: Real, sweep: Real) -> Geometry {
    Geometry::Arc(WireArc::new(center, radius, start, sweep))
}

/// The shape scaled about the origin.
pub fn scaled(geometry: &Geometry, factor: Real) -> Geometry {
    match geometry {
        Geometry::Convex(core) => Geometry::Convex(Convex {
            vertices: core.vertices.iter().map(|v| v * factor).collect(),
            normals: core.normals.clone(),
            radius: core.radius * factor,
            joins: None,
        }),
        Geometry::Arc(arc) => Geometry::Arc(WireArc {
            center: arc.center * factor,
            radius: arc.radius * factor,
            ..*arc
        }),
    }
}

/// Points of the border, about `count` of them.
pub fn outline(geometry: &Geometry, count: u32) -> Vec<Vec2> {
    let steps = |count: u32| (0..=count).map(move |k| Real::from(k) / Real::from(count));
    match geometry {
        Geometry::Arc(arc) => steps(count)
            .map(|t| arc.center + Rot::new(arc.sweep * t).apply(arc.from) * arc.radius)
            .collect(),
        Geometry::Convex(core) => {
            let mut points = Vec::new();
            let n = core.vertices.len();
            let each = count / (2 * n as u32) + 1;
            for (i, &vertex) in core.vertices.iter().enumerate() {
                let next = core.vertices[(i + 1) % n];
                if core.radius > 0.0 {
                    let round = |t| vertex + Rot::new(TAU * t).apply(vec2(core.radius, 0.0));
                    points.extend(steps(each).map(round));
                }
                if let Some(normal) = core.normals.get(i) {
                    let side = |t| vertex + (next - vertex) * t + normal * core.radius;
                    points.extend(steps(each).map(side));
                }
            }
            // Circles around vertices run through the inside as well.
            let inside = |p: &Vec2| culbuto::collision::distance_to_point(geometry, *p).distance;
            points.retain(|p| inside(p) >= -1e-9 * core.radius);
            points
        }
    }
}

pub fn points(size: Real) -> impl Strategy<Value = Vec2> {
    (-size..size, -size..size).prop_map(|(x, y)| vec2(x, y))
}

/// Polygons on ellipses, thin ones too, sharp and rounded; capsules, wires, disks, arcs; about a metre, off the
/// centre of mass.
pub fn geometries() -> impl Strategy<Value = Geometry> {
    let radius = || prop_oneof![Just(0.0), 0.01..0.5];
    let polygon =
        (prop::collection::vec(0.3..1.0, 3..8), 0.01..1.0, points(0.5), radius(), 0.0..TAU)
            .prop_map(|(steps, flat, center, radius, turn)| {
                let total: Real = steps.iter().sum();
                let mut angle = 0.0;
                let vertex = |step: &Real| {
                    angle += step * TAU / total;
                    let on_ellipse = vec2(angle.cos(), angle.sin() * flat);
                    center + Rot::new(turn).apply(on_ellipse)
                };
                convex(steps.iter().map(vertex).collect(), radius)
            });
    let segment = (points(1.0), points(1.0), radius()).prop_map(|(a, b, r)| convex(vec![a, b], r));
    let round = (points(0.5), 0.05..1.0).prop_map(|(c, r)| disk(c, r));
    prop_oneof![3 => polygon, 2 => segment, 1 => round, 2 => arcs()]
}

pub fn arcs() -> impl Strategy<Value = Geometry> {
    let sweep = prop_oneof![0.1..TAU, Just(TAU), Just(TAU / 2.0)];
    (points(0.5), 0.2..3.0, 0.0..TAU, sweep)
        .prop_map(|(c, r, start, sweep)| arc(c, r, start, sweep))
}

pub fn poses(size: Real, angle: Real) -> impl Strategy<Value = Pose> {
    (points(size), -angle..angle).prop_map(|(at, angle)| Pose::new(at, angle))
}

pub fn sweeps(size: Real, angle: Real) -> impl Strategy<Value = Sweep> {
    (poses(size, angle), poses(size, angle)).prop_map(|(from, to)| Sweep { from, to })
}

pub fn b_in_a(a: &Pose, b: &Pose) -> Frame {
    Frame::of(b).seen_from(&Frame::of(a))
}
