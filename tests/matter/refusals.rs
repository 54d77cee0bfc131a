//! What is mended and what is refused (X9), and how the message names it.

use culbuto::math::{Real, Rot, Vec2, vec2};
use culbuto::shapes::{Shape, ShapeDef};
use proptest::prelude::*;

use crate::common::{outline_and_holes, points, polygons};

fn outline(shape: &Shape) -> Vec<Vec2> {
    match shape.def() {
        ShapeDef::Polygon { vertices, .. } => vertices.clone(),
        _ => panic!("not a polygon"),
    }
}

#[track_caller]
fn refused(vertices: &[(Real, Real)], needles: &[&str]) {
    let vertices: Vec<Vec2> = vertices.iter().map(|&(x, y)| vec2(x, y)).collect();
    let message = Shape::polygon(&vertices).unwrap_err().to_string();
    for needle in needles {
        assert!(message.contains(needle), "{message:?} does not say {needle:?}");
    }
}

#[test]
fn chains_without_links_are_refused() {
    for (points, closed, needle) in [
        (&[(0.0, 0.0)][..], false, "points of the open chain is 1; allowed: 2 or more"),
        (&[(0.0, 0.0), (1.0, 0.0)], true, "points of the closed chain is 2; allowed: 3 or more"),
        (&[(0.0, 0.0), (1.0, 0.0), (1.0, 0.0)], false, "length of link 1–2 of the chain"),
        (&[(0.0, 0.0), (1.0, 0.0), (0.0, 0.0)], true, "length of link 2–0 of the chain"),
        (&[(0.0, 0.0), (1.0, Real::NAN)], false, "point 1 of the chain"),
        (&[(1e9, 0.0), (1e9, 1e-7)], false, "well above rounding"),
    ] {
        let points: Vec<Vec2> = points.iter().map(|&(x, y)| vec2(x, y)).collect();
        let message = Shape::chain(&points, closed).unwrap_err().to_string();
        assert!(message.contains(needle), "{message:?} does not say {needle:?}");
    }
}

#[test]
fn outlines_that_make_no_sense_are_refused_with_their_vertices_named() {
    refused(&[(0.0, 0.0), (1.0, 1.0), (1.0, 0.0), (0.0, 1.0)], &["edge 0–1 crosses edge 2–3"]);
    refused(&[(0.0, 0.0), (1.0, 0.0)], &["corners of the outline", "three or more"]);
    refused(&[], &["corners of the outline", "three or more"]);
    refused(&[(5.0, 5.0); 4], &["left with 1", "three or more"]);
    refused(&[(0.0, 0.0), (1.0, 0.0), (2.0, 0.0)], &["folded back at vertex"]);
    // A spike at vertex 3 (vertex 2, on its way, is merged), and a vertex on an edge.
    refused(
        &[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (4.0, 9.0), (4.0, 4.0), (0.0, 4.0)],
        &["vertex 3", "1–3 and 3–4"],
    );
    refused(
        &[(0.0, 0.0), (4.0, 0.0), (4.0, 4.0), (2.0, 0.0), (0.0, 4.0)],
        &["edge 0–1 touches edge"],
    );
    // Two squares that meet in a corner.
    let pinched = [
        (0.0, 0.0),
        (1.0, 0.0),
        (1.0, 1.0),
        (2.0, 1.0),
        (2.0, 2.0),
        (1.0, 2.0),
        (1.0, 1.0),
        (0.0, 1.0),
    ];
    refused(&pinched, &["touches"]);
    refused(
        &[(0.0, 0.0), (Real::NAN, 0.0), (1.0, 1.0)],
        &["vertex 1 of the outline", "NaN", "finite"],
    );
    refused(&[(0.0, 0.0), (1.0, Real::INFINITY), (1.0, 1.0)], &["vertex 1", "inf"]);
}

#[test]
fn names_are_the_numbers_of_the_vertices_as_given() {
    // Vertices 1, 2 and 4 go; the crossing edges keep their names.
    let bow = [(0.0, 0.0), (0.0, 0.0), (1.0, 1.0), (2.0, 2.0), (2.0, 2.0), (2.0, 0.0), (0.0, 2.0)];
    refused(&bow, &["edge 0–3 crosses edge 5–6"]);
}

#[test]
fn holes_that_make_no_sense_are_refused_with_their_names() {
    let square = |x: Real, y: Real, s: Real| {
        vec![vec2(x, y), vec2(x + s, y), vec2(x + s, y + s), vec2(x, y + s)]
    };
    let message = |holes: &[Vec<Vec2>]| {
        Shape::polygon_with_holes(&square(0.0, 0.0, 10.0), holes).unwrap_err().to_string()
    };
    assert!(message(&[square(20.0, 0.0, 1.0)]).contains("hole 0 is outside the outline"));
    assert!(
        message(&[square(1.0, 1.0, 5.0), square(2.0, 2.0, 1.0)])
            .contains("hole 1 is inside hole 0")
    );
    assert!(
        message(&[square(1.0, 1.0, 1.0), square(-2.0, -2.0, 20.0)]).contains("hole 1 is outside")
    );
    let crossing = message(&[square(1.0, 1.0, 3.0), square(2.0, 2.0, 3.0)]);
    assert!(crossing.contains("of hole 0 crosses edge"), "{crossing}");
    assert!(message(&[square(5.0, 5.0, 8.0)]).contains("of the outline crosses edge"));
    assert!(message(&[square(5.0, 5.0, 5.0)]).contains("touches"));
    assert!(message(&[vec![vec2(1.0, 1.0), vec2(2.0, 2.0)]]).contains("hole 0"));
    let rounded = ShapeDef::Polygon {
        vertices: square(0.0, 0.0, 10.0),
        holes: vec![square(1.0, 1.0, 1.0)],
        radius: 1.0,
    };
    assert!(Shape::new(rounded).unwrap_err().to_string().contains("convex"));
}

#[test]
fn numbers_that_make_no_sense_are_refused() {
    let o = vec2(0.0, 0.0);
    for bad in [0.0, -1.0, Real::NAN, Real::INFINITY, 1e-150, 1e150, 1e-320] {
        let errors = [
            Shape::circle(bad).unwrap_err(),
            Shape::rectangle(bad, 1.0).unwrap_err(),
            Shape::rectangle(1.0, bad).unwrap_err(),
            Shape::regular_polygon(5, bad).unwrap_err(),
            Shape::capsule(o, vec2(1.0, 0.0), bad).unwrap_err(),
            Shape::capsule(o, vec2(bad.max(0.0), 0.0), 1.0).unwrap_err(),
            Shape::segment(o, vec2(0.0, bad.max(0.0))).unwrap_err(),
            Shape::arc(o, bad, 0.0, 1.0).unwrap_err(),
        ];
        for error in errors {
            assert!(error.to_string().contains("allowed"), "{error}");
        }
    }
    for bad in [0.0, 6.29, -6.29, Real::NAN] {
        assert!(Shape::arc(o, 1.0, 0.0, bad).is_err());
    }
    for bad in [0, 2, 70_000] {
        assert!(Shape::regular_polygon(bad, 1.0).is_err());
    }
    for bad in [-1.0, Real::NAN] {
        assert!(Shape::rounded_polygon(&[o, vec2(1.0, 0.0), vec2(0.0, 1.0)], bad).is_err());
    }
    let lost = ShapeDef::Box { width: 1.0, height: 1.0, center: vec2(1e17, 0.0), angle: 0.0 };
    assert!(Shape::new(lost).unwrap_err().to_string().contains("rounding"));
}

#[test]
fn sizes_beyond_measure_are_refused_or_finite() {
    for scale in [1e-300, 1e-150, 1e-77, 1e-70, 1e70, 1e77, 1e150, 1e300] {
        let triangle = [vec2(0.0, 0.0), vec2(scale, 0.0), vec2(0.0, scale)];
        match Shape::polygon(&triangle) {
            Ok(shape) => {
                assert!(shape.second_moment().is_normal() && shape.area() > 0.0, "{scale:e}");
            }
            Err(error) => assert!(error.to_string().contains("allowed"), "{error}"),
        }
        assert_eq!(Shape::polygon(&triangle).is_ok(), (1e-71..1e71).contains(&scale));
    }
}

#[test]
fn needles_and_small_angles_are_not_eaten() {
    for offset in [0.0, 1e6] {
        let (l, w) = (1e6, 1.0);
        let needle = [vec2(0.0, 0.0), vec2(l, 0.0), vec2(l, w), vec2(0.0, w)]
            .map(|p| p + vec2(offset, -offset));
        assert_eq!(outline(&Shape::polygon(&needle).unwrap()), needle);
        let sliver =
            [vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(1.0, 1e-4)].map(|p| p + vec2(offset, offset));
        assert_eq!(outline(&Shape::polygon(&sliver).unwrap()), sliver);
    }
}

proptest! {
    #[test]
    fn duplicates_and_collinear_vertices_are_merged(
        grid in polygons(), turn in 0.0..6.3, extra in prop::collection::vec((0..40_usize, 0.0..1.0), 0..20),
    ) {
        let rot = Rot::new(turn);
        let plain: Vec<Vec2> = points(&grid[0], [0, 0]).into_iter().map(|p| rot.apply(p)).collect();
        let clean = outline(&Shape::polygon(&plain).unwrap());
        let mut noisy = plain.clone();
        for (place, along) in extra {
            let i = place % noisy.len();
            let (a, b) = (noisy[i], noisy[(i + 1) % noisy.len()]);
            noisy.insert(i + 1, if along < 0.3 { a } else { a + (b - a) * along });
        }
        prop_assert_eq!(outline(&Shape::polygon(&noisy).unwrap()), clean);
    }

    #[test]
    fn clockwise_is_turned_round(grid in polygons()) {
        let (outline, holes) = outline_and_holes(&grid, [5, 6]);
        let turned = |ring: &Vec<Vec2>| {
            let mut ring = ring.clone();
            ring[1..].reverse();
            ring
        };
        let right = Shape::polygon_with_holes(&outline, &holes).unwrap();
        let wrong = Shape::polygon_with_holes(&turned(&outline), &holes.iter().map(turned).collect::<Vec<_>>());
        prop_assert_eq!(&wrong.unwrap(), &right);
        let again = Shape::new(right.def().clone()).unwrap();
        prop_assert_eq!(again.def(), right.def());
    }

    #[test]
    fn bow_ties_are_refused_with_the_edges_named(
        a in prop::array::uniform2(-1.0..1.0), turn in 0.0..6.3, gaps in prop::array::uniform3(0.3..1.5),
        start in 0..4_usize,
    ) {
        // Four points of a circle, the middle two swapped.
        let angles = [turn, turn + gaps[0], turn + gaps[0] + gaps[1], turn + gaps[0] + gaps[1] + gaps[2]];
        let [p, q, r, s] = angles.map(|t| Vec2::from(a) + Rot::new(t).apply(vec2(1.0, 0.0)));
        let mut ring = [p, r, q, s];
        ring.rotate_left(start);
        let message = Shape::polygon(&ring).unwrap_err().to_string();
        let edges = if start % 2 == 0 { "edge 0–1 crosses edge 2–3" } else { "edge 1–2 crosses edge 3–0" };
        prop_assert!(message.contains(edges), "{}", message);
    }

    #[test]
    fn an_outline_is_accepted_exactly_when_it_is_simple(
        ring in prop::collection::vec(prop::array::uniform2(0..6_i64), 3..9),
    ) {
        let accepted = Shape::polygon(&points(&ring, [0, 0])).is_ok();
        prop_assert_eq!(accepted, is_simple(ring.clone()), "{:?}", ring);
    }
}

/// By definition, in integers: after merging, no two edges share a point other than neighbours
/// their vertex.
fn is_simple(mut ring: Vec<[i64; 2]>) -> bool {
    let turn = |a: [i64; 2], b: [i64; 2], c: [i64; 2]| {
        (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
    };
    let between = |a: [i64; 2], b: [i64; 2], c: [i64; 2]| {
        turn(a, b, c) == 0 && (c[0] - a[0]) * (c[0] - b[0]) + (c[1] - a[1]) * (c[1] - b[1]) <= 0
    };
    // Drop what lies between its neighbours, or on one of them.
    while let Some(i) = (0..ring.len()).find(|&i| {
        let n = ring.len();
        let (a, b, c) = (ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]);
        n > 1 && (a == b || (a != c && between(a, c, b)))
    }) {
        ring.remove(i);
    }
    let n = ring.len();
    if n < 3 {
        return false;
    }
    for i in 0..n {
        let (a, b, next) = (ring[i], ring[(i + 1) % n], ring[(i + 2) % n]);
        if between(a, b, next) || between(b, next, a) {
            return false;
        }
        for j in i + 2..n {
            let (c, d) = (ring[j], ring[(j + 1) % n]);
            if (j + 1) % n == i {
                continue;
            }
            let cross = turn(a, b, c).signum() * turn(a, b, d).signum() < 0
                && turn(c, d, a).signum() * turn(c, d, b).signum() < 0;
            if cross || between(a, b, c) || between(a, b, d) || between(c, d, a) || between(c, d, b)
            {
                return false;
            }
        }
    }
    true
}

#[test]
fn ten_thousand_vertices_are_taken_and_cut_into_pieces() {
    let n = 10_000;
    let star: Vec<Vec2> = (0..n)
        .map(|i| {
            let r = if i % 2 == 0 { 1.0 } else { 0.9 };
            Rot::new(Real::from(i) * std::f64::consts::TAU / Real::from(n)).apply(vec2(r, 0.0))
        })
        .collect();
    // Long teeth along x, one above the other: a sweep along x would compare all with all.
    let comb: Vec<Vec2> = (0..n / 2)
        .flat_map(|i| [vec2(0.0, Real::from(i)), vec2(100.0, Real::from(i) + 0.5)])
        .chain([vec2(-1.0, Real::from(n / 2)), vec2(-1.0, -1.0)])
        .collect();
    for ring in [star, comb] {
        let shape = Shape::polygon(&ring).unwrap();
        assert!(shape.convex_pieces().len() > 100);
    }
}
