//! Shapes with round parts, against quadrature along their boundary, and membership against area.

use std::f64::consts::{PI, TAU};

use culbuto::math::{Real, Rot, Vec2, cross, perp, vec2};
use culbuto::shapes::{Shape, ShapeDef};
use proptest::prelude::*;

use crate::common::{assert_close, assert_near};

/// A smooth piece of a boundary over [0, 1]: its points and their derivative.
type Piece = Box<dyn Fn(Real) -> (Vec2, Vec2)>;

/// Green's theorem by Gauss–Legendre of five points on each of eight parts of smooth pieces (r,
/// dr/dt) over [0, 1]: (A, c, J about c). Exact for straight pieces, 1e-15 for arcs up to a turn.
fn by_green(pieces: &[Piece], about: Vec2) -> (Real, Vec2, Real) {
    const NODES: [(Real, Real); 5] = [
        (0.0, 0.568_888_888_888_888_9),
        (0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
        (-0.538_469_310_105_683_1, 0.478_628_670_499_366_47),
        (0.906_179_845_938_664, 0.236_926_885_056_189_08),
        (-0.906_179_845_938_664, 0.236_926_885_056_189_08),
    ];
    const PARTS: usize = 8;
    let (mut area, mut first, mut second) = (0.0, vec2(0.0, 0.0), 0.0);
    for piece in pieces {
        for part in 0..PARTS {
            for (node, weight) in NODES {
                let t = (part as Real + (1.0 + node) / 2.0) / PARTS as Real;
                let (r, dr) = piece(t);
                let (r, weight) = (r - about, weight / 2.0 / PARTS as Real);
                let k = weight * cross(r, dr);
                area += k / 2.0;
                first += r * (k / 3.0);
                second += k * r.norm_squared() / 4.0;
            }
        }
    }
    let offset = first / area;
    (area, about + offset, second - area * offset.norm_squared())
}

/// The boundary of a convex polygon grown by a disk.
fn grown(core: &[Vec2], radius: Real) -> Vec<Piece> {
    let n = core.len();
    let mut pieces: Vec<Piece> = Vec::new();
    for i in 0..n {
        let (a, b, c) = (core[i], core[(i + 1) % n], core[(i + 2) % n]);
        let normal = |p: Vec2, q: Vec2| -perp((q - p).normalize());
        let (m, k) = (normal(a, b), normal(b, c));
        pieces.push(Box::new(move |t| (a + (b - a) * t + m * radius, b - a)));
        let turn = (m.x * k.y - m.y * k.x).atan2(m.dot(&k)).rem_euclid(TAU);
        pieces.push(Box::new(move |t| {
            let arm = Rot::new(turn * t).apply(m) * radius;
            (b + arm, perp(arm) * turn)
        }));
    }
    pieces
}

fn convex() -> impl Strategy<Value = Vec<Vec2>> {
    // Points of a circle, hence convex, moved about.
    (prop::collection::vec(0.2..1.0, 3..9), -3.0..3.0, -3.0..3.0).prop_map(|(gaps, x, y)| {
        let total: Real = gaps.iter().sum();
        let angles = gaps.iter().scan(0.0, |angle, gap| {
            *angle += gap / total * TAU;
            Some(*angle)
        });
        angles.map(|angle| Rot::new(angle).apply(vec2(1.5, 0.0)) + vec2(x, y)).collect()
    })
}

proptest! {
    #[test]
    fn rounded_polygons_and_capsules_have_the_measures_of_quadrature(core in convex(), radius in 1e-3..5.0) {
        let rounded = Shape::rounded_polygon(&core, radius).unwrap();
        let capsule = Shape::capsule(core[0], core[1], radius).unwrap();
        for (shape, core) in [(rounded, &core[..]), (capsule, &core[..2])] {
            let (area, centroid, moment) = by_green(&grown(core, radius), core[0]);
            // The quadrature rounds relative to what it sums, |r| |dr|, which for thin shapes is
            // more than the area.
            let reach = shape.extent_from(core[0]);
            let slack = 32.0 * Real::EPSILON * reach * (shape.perimeter() + reach);
            assert_close(shape.area(), area, slack / area);
            assert_near(shape.centroid(), centroid, slack / area * reach);
            assert_close(shape.second_moment(), moment, slack * reach * reach / moment);
        }
    }

    #[test]
    fn arcs_have_the_measures_of_quadrature(start in -7.0..7.0, sweep in -TAU..TAU, radius in 1e-3..1e3) {
        prop_assume!(sweep.abs() > 1e-3);
        let arc = Shape::arc(vec2(0.3, -0.7), radius, start, sweep).unwrap();
        assert_close(arc.measure(), radius * sweep.abs(), 1e-15);
        // The midpoint rule on n points of an arc is off by (sweep/n)²/24 relative to the chord;
        // Richardson takes it out.
        let sums = |n: i32| {
            let point = |k: i32| Rot::new(start + sweep * (Real::from(k) + 0.5) / Real::from(n)).apply(vec2(radius, 0.0));
            (0..n).map(point).sum::<Vec2>() / Real::from(n)
        };
        let mean = (sums(2000) * 4.0 - sums(1000)) / 3.0;
        assert_near(arc.centroid(), vec2(0.3, -0.7) + mean, 1e-11 * radius + 1e-15);
        // J/L = r² − |c|²
        let relative = arc.second_moment() / arc.measure() / (radius * radius);
        let expected = 1.0 - mean.norm_squared() / (radius * radius);
        assert!((relative - expected).abs() < 1e-11);
    }

    #[test]
    fn short_arcs_weigh_as_straight_wires(start in -7.0..7.0, power in 1..9_i32) {
        let sweep = Real::powi(10.0, -power);
        let radius = 1.0 / sweep;
        let arc = Shape::arc(vec2(0.0, 0.0), radius, start, sweep).unwrap();
        // J = L³/12 (1 − sweep²/30 + …)
        assert_close(arc.second_moment(), (1.0 - sweep * sweep / 30.0) / 12.0, 1e-3 * sweep.powi(4) + 4.0 * Real::EPSILON);
    }
}

#[test]
fn closed_forms() {
    let circle = Shape::circle(2.0).unwrap();
    assert_close(circle.area(), 4.0 * PI, 1e-15);
    assert_close(circle.perimeter(), 4.0 * PI, 1e-15);
    assert_close(circle.second_moment(), 8.0 * PI, 1e-15);
    let rod = Shape::segment(vec2(1e6, 1.0), vec2(1e6, 3.0)).unwrap();
    assert_eq!((rod.area(), rod.measure(), rod.perimeter()), (0.0, 2.0, 2.0));
    assert_eq!(rod.centroid(), vec2(1e6, 2.0));
    assert_close(rod.second_moment(), 8.0 / 12.0, 1e-15);
    let ring = Shape::arc(vec2(1.0, 0.0), 3.0, 0.0, TAU).unwrap();
    assert_close(ring.second_moment(), TAU * 27.0, 1e-15);
    assert_near(ring.centroid(), vec2(1.0, 0.0), 1e-15);
    // Stadium of length 2 between the centres, radius 1: 4 + π, and J = 4·(4 + 4)/12 + (π/2 + π +
    // 8/3).
    let capsule = Shape::capsule(vec2(-1.0, 1e6), vec2(1.0, 1e6), 1.0).unwrap();
    assert_close(capsule.area(), 4.0 + PI, 1e-15);
    assert_close(capsule.perimeter(), 4.0 + TAU, 1e-15);
    assert_close(capsule.second_moment(), 8.0 / 3.0 + 1.5 * PI + 8.0 / 3.0, 1e-15);
    for (n, area) in [(3, 0.75 * 3.0_f64.sqrt()), (4, 2.0), (6, 1.5 * 3.0_f64.sqrt())] {
        let def =
            ShapeDef::RegularPolygon { sides: n, radius: 1.0, center: vec2(5.0, 6.0), angle: 0.4 };
        let regular = Shape::new(def).unwrap();
        assert_close(regular.area(), area, 1e-15);
        let ring = &regular.outline(1.0)[0].points;
        let polygon = Shape::polygon(ring).unwrap();
        assert_close(regular.second_moment(), polygon.second_moment(), 1e-14);
        assert_close(regular.perimeter(), polygon.perimeter(), 1e-14);
        assert_near(polygon.centroid(), vec2(5.0, 6.0), 1e-14);
    }
}

#[test]
fn boxes_weigh_as_their_corners() {
    let def = ShapeDef::Box { width: 3.0, height: 0.5, center: vec2(5.0, -2.0), angle: 0.7 };
    let shape = Shape::new(def).unwrap();
    let polygon = Shape::polygon(&shape.outline(1.0)[0].points).unwrap();
    assert_close(shape.area(), polygon.area(), 1e-14);
    assert_close(shape.second_moment(), polygon.second_moment(), 1e-14);
    assert_close(shape.perimeter(), polygon.perimeter(), 1e-14);
    assert_near(shape.centroid(), polygon.centroid(), 1e-14);
}

/// The kinds of shapes, each about one metre large.
fn zoo() -> Vec<Shape> {
    let v = vec2;
    let c = [
        v(0.0, 0.0),
        v(2.0, 0.0),
        v(2.0, 2.0),
        v(0.0, 2.0),
        v(0.0, 1.5),
        v(1.5, 1.5),
        v(1.5, 0.5),
        v(0.0, 0.5),
    ];
    let square = [v(-1.0, -1.0), v(1.0, -1.0), v(1.0, 1.0), v(-1.0, 1.0)];
    let hole = vec![v(-0.5, -0.5), v(0.5, -0.4), v(0.1, 0.6)];
    vec![
        Shape::circle(0.7).unwrap(),
        Shape::new(ShapeDef::Box { width: 2.0, height: 0.3, center: v(0.4, 0.1), angle: 0.5 })
            .unwrap(),
        Shape::regular_polygon(7, 1.1).unwrap(),
        Shape::polygon(&c).unwrap(),
        Shape::polygon_with_holes(&square, &[hole]).unwrap(),
        Shape::rounded_polygon(&[v(0.0, 0.0), v(1.0, 0.2), v(0.2, 0.9)], 0.3).unwrap(),
        Shape::capsule(v(-0.5, 0.1), v(0.6, 0.4), 0.25).unwrap(),
    ]
}

#[test]
fn a_shape_contains_as_many_grid_points_as_its_area_holds() {
    for shape in zoo() {
        // A grid askew, so that no edge runs along it.
        let (h, n) = (4e-3, 750);
        let point = |i: i32, j: i32| Rot::new(0.3).apply(vec2(Real::from(i), Real::from(j)) * h);
        let inside = (-n..n).flat_map(|i| (-n..n).map(move |j| (i, j)));
        let inside = inside.filter(|&(i, j)| shape.contains(point(i, j))).count();
        // Cells off are those on the boundary: they lie within h/√2 of it.
        let bound = shape.perimeter() * h * 2.0_f64.sqrt() + 10.0 * h * h;
        let measured = inside as Real * h * h;
        assert!((measured - shape.area()).abs() < bound, "{shape:?}: {measured}");
        // The boundary averages out: most of that bound is never used.
        assert!((measured - shape.area()).abs() < 0.1 * bound, "{shape:?}: {measured}");
    }
}

#[test]
fn the_border_belongs_to_the_shape_and_what_is_beyond_does_not() {
    let v = vec2;
    let square = [v(0.0, 0.0), v(8.0, 0.0), v(8.0, 8.0), v(0.0, 8.0)];
    let hole = vec![v(2.0, 2.0), v(6.0, 2.0), v(4.0, 6.0)];
    let shape = Shape::polygon_with_holes(&square, &[hole]).unwrap();
    let border = [v(0.0, 0.0), v(8.0, 8.0), v(8.0, 3.0), v(5.0, 8.0), v(2.0, 2.0), v(4.0, 2.0)];
    for p in border.into_iter().chain([v(4.0, 6.0), v(3.0, 4.0), v(5.0, 4.0), v(1.0, 4.0)]) {
        assert!(shape.contains(p), "{p:?}");
    }
    let next = Real::next_up;
    for p in [v(next(8.0), 3.0), v(5.0, next(8.0)), v(3.0, 4.0_f64.next_down()), v(4.0, next(2.0))]
    {
        assert!(!shape.contains(p), "{p:?}");
    }
    assert!(!Shape::segment(square[0], square[1]).unwrap().contains(square[0]));
}

#[test]
fn extents_and_boxes_are_those_of_the_outline() {
    let mut shapes = zoo();
    shapes.push(Shape::segment(vec2(0.3, 1.0), vec2(-2.0, 0.2)).unwrap());
    for sweep in [0.3, -0.3, 2.0, -4.0, 5.5, TAU, -TAU] {
        for start in [0.0, 1.0, 2.5, 4.0, -1.2] {
            shapes.push(Shape::arc(vec2(0.2, 0.5), 1.3, start, sweep).unwrap());
        }
    }
    for shape in shapes {
        let outline: Vec<Vec2> =
            shape.outline(1e-3).into_iter().flat_map(|ring| ring.points).collect();
        // Between drawn points an arc of radius up to 1.3 bulges by r (1 − cos 5e-4) < 2e-7.
        for k in 0..50 {
            let direction = Rot::new(Real::from(k) * 0.13).apply(vec2(1.0, 0.0));
            let along = outline.iter().map(|p| p.dot(&direction));
            let (min, max) =
                along.fold((9.0, -9.0), |(a, b): (Real, Real), x| (a.min(x), b.max(x)));
            let span = shape.projection(direction);
            assert!(
                (span.min - min).abs() < 2e-7 && (span.max - max).abs() < 2e-7,
                "{shape:?} {direction:?}"
            );
            let center = direction * 0.8;
            let farthest = outline.iter().map(|p| (p - center).norm()).fold(0.0, Real::max);
            assert!((shape.extent_from(center) - farthest).abs() < 4e-7, "{shape:?} {center:?}");
        }
        let pose = culbuto::math::Pose::new(vec2(3.0, -4.0), 0.9);
        let placed: Vec<Vec2> = outline.iter().map(|&p| pose.apply(p)).collect();
        let bounds = shape.bounds_at(&pose);
        assert!(
            placed.iter().all(|p| (bounds.min - p).max() < 1e-14 && (p - bounds.max).max() < 1e-14)
        );
        assert!(placed.iter().any(|p| (p.x - bounds.min.x).abs() < 2e-7));
        assert!(placed.iter().any(|p| (p.y - bounds.max.y).abs() < 2e-7));
        assert_eq!(shape.bounds(), shape.bounds_at(&culbuto::math::Pose::IDENTITY));
    }
}

#[test]
fn drawn_arcs_turn_by_no_more_than_asked() {
    for (shape, closed) in [
        (Shape::circle(2.0).unwrap(), true),
        (Shape::capsule(vec2(0.0, 0.0), vec2(1.0, 0.0), 0.5).unwrap(), true),
        (Shape::arc(vec2(0.0, 0.0), 1.0, 0.3, -2.0).unwrap(), false),
    ] {
        for max_angle in [0.01, 0.3, 1.0, -1.0, Real::NAN] {
            let rings = shape.outline(max_angle);
            assert_eq!((rings.len(), rings[0].closed), (1, closed));
            let points = &rings[0].points;
            let turn = |w: &[Vec2]| (w[1] - w[0]).angle(&(w[2] - w[1]));
            let worst = points.windows(3).map(turn).fold(0.0, Real::max);
            let allowed = if max_angle > 0.0 { max_angle } else { PI / 2.0 };
            assert!(worst <= allowed * (1.0 + 1e-6) + 1e-6, "{worst} {max_angle}");
            assert!(worst > 0.0);
        }
    }
}
