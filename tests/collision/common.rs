//! Shapes, frames and independent answers for them.

use culbuto::Part;
use culbuto::collision::{Collider, Convex, Frame, Geometry, Manifold, Normal, collide, colliders};
use culbuto::math::{Real, Rot, Vec2, vec2};
use culbuto::shapes::Shape;
use proptest::prelude::*;

/// Colliders of one shape about the origin of its frame.
pub fn of(shape: Shape) -> Vec<Collider> {
    colliders(0, &[Part::from(shape)], vec2(0.0, 0.0))
}

/// The only collider of a shape.
pub fn one(shape: Shape) -> Geometry {
    let mut all = of(shape);
    assert_eq!(all.len(), 1);
    all.remove(0).geometry
}

pub fn at(x: Real, y: Real, angle: Real) -> Frame {
    Frame { position: vec2(x, y), rot: Rot::new(angle) }
}

pub fn manifolds(a: &Geometry, b: &Geometry, b_in_a: &Frame, margin: Real) -> Vec<Manifold> {
    let mut out = Vec::new();
    collide(a, b, b_in_a, margin, &mut out);
    out
}

/// Normal from A to B in the frame of A.
pub fn normal(manifold: &Manifold, b_in_a: &Frame, point: usize) -> Vec2 {
    let anchor = manifold.anchors[point];
    let arm = b_in_a.apply(anchor.on_b) - anchor.on_a;
    match manifold.normal {
        Normal::OnA(n) => n,
        Normal::OnB(n) => b_in_a.rot.apply(n),
        Normal::Between => arm.normalize(),
        Normal::Inside => -arm.normalize(),
    }
}

/// Gap of a point, as manifolds define it.
pub fn gap(manifold: &Manifold, b_in_a: &Frame, point: usize) -> Real {
    let anchor = manifold.anchors[point];
    let arm = b_in_a.apply(anchor.on_b) - anchor.on_a;
    normal(manifold, b_in_a, point).dot(&arm) - manifold.radius_a - manifold.radius_b
}

/// The smallest gap of all points of all manifolds.
pub fn least_gap(found: &[Manifold], b_in_a: &Frame) -> Real {
    let gaps = found.iter().flat_map(|m| (0..m.count).map(|i| gap(m, b_in_a, i)));
    gaps.fold(Real::INFINITY, Real::min)
}

pub fn convex(geometry: &Geometry) -> &Convex {
    let Geometry::Convex(convex) = geometry else { panic!("an arc") };
    convex
}

/// Circles, boxes, capsules, segments, polygons and rounded ones, of sizes about 1 and off the origin.
pub fn shapes() -> impl Strategy<Value = Shape> {
    let point = || (-1.0..1.0, -1.0..1.0).prop_map(|(x, y)| vec2(x, y));
    let corners = prop::collection::vec((0.2..1.0_f64, 0.6..1.4_f64), 3..9);
    let polygon = (corners, prop_oneof![Just(0.0), 0.0..0.5_f64], point());
    prop_oneof![
        (0.1..1.0).prop_map(|r| Shape::circle(r).unwrap()),
        (0.05..2.0, 0.05..2.0).prop_map(|(w, h)| Shape::rectangle(w, h).unwrap()),
        (point(), 0.1..2.0, 0.0..6.3, 0.05..0.5).prop_map(|(a, l, t, r)| Shape::capsule(
            a,
            a + arm(l, t),
            r
        )
        .unwrap()),
        (point(), 0.1..2.0, 0.0..6.3)
            .prop_map(|(a, l, t)| Shape::segment(a, a + arm(l, t)).unwrap()),
        polygon.prop_map(|(corners, radius, center)| on_circle(&corners, radius, center)),
        (3..12_u32, 0.1..1.0).prop_map(|(n, r)| Shape::regular_polygon(n, r).unwrap()),
    ]
}

fn arm(length: Real, angle: Real) -> Vec2 {
    Rot::new(angle).apply(vec2(length, 0.0))
}

/// A polygon with its corners on an ellipse, hence convex.
fn on_circle(corners: &[(Real, Real)], radius: Real, center: Vec2) -> Shape {
    let total: Real = corners.iter().map(|c| c.1).sum();
    let mut angle = 0.0;
    let vertex = |&(_, step): &(Real, Real)| {
        angle += step / total * std::f64::consts::TAU;
        let unit = Rot::new(angle).apply(vec2(1.0, 0.0));
        center + vec2(unit.x, unit.y * corners[0].0)
    };
    let vertices: Vec<Vec2> = corners.iter().map(vertex).collect();
    Shape::rounded_polygon(&vertices, radius).unwrap()
}

/// Frames up to `distance` away.
pub fn frames(distance: Real) -> impl Strategy<Value = Frame> {
    (-distance..distance, -distance..distance, -7.0..7.0).prop_map(|(x, y, t)| at(x, y, t))
}

/// Vertices of the core in the frame of A.
fn seen(convex: &Convex, frame: &Frame) -> Vec<Vec2> {
    convex.vertices.iter().map(|v| frame.apply(*v)).collect()
}

fn edges(vertices: &[Vec2]) -> Vec<[Vec2; 2]> {
    let n = vertices.len();
    (0..n).map(|i| [vertices[i], vertices[(i + 1) % n]]).collect()
}

fn from_segment(p: Vec2, [a, b]: [Vec2; 2]) -> Real {
    let (ab, ap) = (b - a, p - a);
    let l = ab.norm_squared();
    let t = if l > 0.0 { (ap.dot(&ab) / l).clamp(0.0, 1.0) } else { 0.0 };
    (ap - ab * t).norm()
}

fn cross(a: Vec2, b: Vec2) -> Real {
    a.x * b.y - a.y * b.x
}

/// Gap of two convex shapes from all pairs of vertices and edges: distance of the cores where apart, the
/// least of the depths over the directions across all edges where not; less the radii.
pub fn reference_gap(a: &Geometry, b: &Geometry, frame: &Frame) -> Real {
    let (a, b) = (convex(a), convex(b));
    let (va, vb) = (seen(a, &Frame::IDENTITY), seen(b, frame));
    let axes = edges(&va).into_iter().chain(edges(&vb)).flat_map(|[p, q]| {
        let d = q - p;
        let along = if d.norm() > 0.0 { vec![d.normalize()] } else { Vec::new() };
        along.into_iter().flat_map(|d| [vec2(d.y, -d.x), vec2(-d.y, d.x)]).collect::<Vec<_>>()
    });
    let support = |v: &[Vec2], n: Vec2| v.iter().map(|p| p.dot(&n)).fold(Real::INFINITY, Real::min);
    let separation = |n: Vec2| support(&vb, n) + support(&va, -n);
    let deepest = axes.map(separation).fold(Real::NEG_INFINITY, Real::max);
    let mut distance = Real::INFINITY;
    for (points, others) in [(&va, &vb), (&vb, &va)] {
        for p in points {
            for edge in edges(others) {
                distance = distance.min(from_segment(*p, edge));
            }
        }
    }
    let overlap = overlaps(&va, &vb);
    (if overlap { deepest } else { distance }) - a.radius - b.radius
}

fn overlaps(va: &[Vec2], vb: &[Vec2]) -> bool {
    let inside = |p: Vec2, v: &[Vec2]| {
        v.len() > 2 && edges(v).iter().all(|[a, b]| cross(b - a, p - a) > 0.0)
    };
    let crossing = |[a, b]: [Vec2; 2], [c, d]: [Vec2; 2]| {
        cross(b - a, c - a) * cross(b - a, d - a) < 0.0
            && cross(d - c, a - c) * cross(d - c, b - c) < 0.0
    };
    inside(va[0], vb)
        || inside(vb[0], va)
        || edges(va).iter().any(|e| edges(vb).iter().any(|f| crossing(*e, *f)))
}
