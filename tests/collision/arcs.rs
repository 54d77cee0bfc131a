//! Circular wires.

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use culbuto::collision::{Frame, Geometry, Manifold};
use culbuto::math::{Real, Rot, Vec2, vec2};
use culbuto::shapes::Shape;
use proptest::prelude::*;

use crate::common::{at, gap, least_gap, manifolds, normal, one, shapes};

fn arc(radius: Real, start: Real, sweep: Real) -> Geometry {
    one(Shape::arc(vec2(0.0, 0.0), radius, start, sweep).unwrap())
}

/// A bowl, open above.
fn bowl() -> Geometry {
    arc(2.0, PI, PI)
}

fn single(found: &[Manifold]) -> Manifold {
    assert_eq!(found.len(), 1, "{found:?}");
    found[0]
}

#[test]
fn a_ball_in_a_bowl_touches_it_from_inside() {
    let ball = one(Shape::circle(0.5).unwrap());
    for angle in [-3.0, -2.0, -FRAC_PI_2, -0.3] {
        let place = Rot::new(angle).apply(vec2(1.49, 0.0));
        let frame = at(place.x, place.y, 1.0);
        let m = single(&manifolds(&bowl(), &ball, &frame, 0.1));
        assert!((gap(&m, &frame, 0) - 0.01).abs() < 1e-14);
        assert!((normal(&m, &frame, 0) + place.normalize()).norm() < 1e-14);
    }
}

#[test]
fn a_ball_outside_touches_the_bulge_and_one_at_the_rim_the_end() {
    let ball = one(Shape::circle(0.5).unwrap());
    let frame = at(0.0, -2.51, 0.0);
    let m = single(&manifolds(&bowl(), &ball, &frame, 0.1));
    assert!((gap(&m, &frame, 0) - 0.01).abs() < 1e-14);
    assert_eq!(normal(&m, &frame, 0), vec2(0.0, -1.0));
    let frame = at(2.0, 0.51, 0.0);
    let m = single(&manifolds(&bowl(), &ball, &frame, 0.1));
    assert!((gap(&m, &frame, 0) - 0.01).abs() < 1e-14);
    assert_eq!(normal(&m, &frame, 0), vec2(0.0, 1.0));
}

#[test]
fn a_box_in_a_bowl_stands_on_two_corners() {
    let b = one(Shape::rectangle(2.0, 0.5).unwrap());
    let frame = at(0.0, 0.25 - 3.0_f64.sqrt(), 0.0);
    let found = manifolds(&bowl(), &b, &frame, 0.1);
    assert_eq!(found.len(), 2);
    for m in &found {
        assert!(gap(m, &frame, 0).abs() < 1e-14);
        let corner = frame.apply(m.anchors[0].on_b);
        assert!((normal(m, &frame, 0) + corner / 2.0).norm() < 1e-14);
    }
    assert_ne!(found[0].anchors[0].feature, found[1].anchors[0].feature);
}

#[test]
fn a_big_box_rests_on_both_ends_of_a_bowl() {
    for (width, height) in [(6.0, 6.0), (4.5, 1.0), (4.5, 0.1)] {
        let b = one(Shape::rectangle(width, height).unwrap());
        for turn in [0.0, 1e-3, -1e-3] {
            let frame = at(0.0, height / 2.0 + 0.01, turn);
            let found = manifolds(&bowl(), &b, &frame, 0.05);
            assert_eq!(found.len(), 2, "{found:?}");
            for m in &found {
                assert!((normal(m, &frame, 0) - vec2(0.0, 1.0)).norm() < 2e-3);
                assert!((gap(m, &frame, 0) - 0.01).abs() < 3e-3);
            }
        }
    }
}

#[test]
fn a_corner_that_pokes_into_a_bowl_touches_its_inner_side() {
    let corners = [(0.0, -4.0), (1.0, 0.0), (0.0, 4.0), (-1.0, 0.0)].map(|(x, y)| vec2(x, y));
    let b = one(Shape::polygon(&corners).unwrap());
    let frame = at(0.0, 4.0 - 1.99, 0.0);
    let found = manifolds(&bowl(), &b, &frame, 0.02);
    let m = found.iter().find(|m| (normal(m, &frame, 0) - vec2(0.0, 1.0)).norm() < 1e-12);
    assert!((gap(m.unwrap(), &frame, 0) - 0.01).abs() < 1e-12, "{found:?}");
}

#[test]
fn a_whole_circle_holds_a_smaller_one_and_is_met_from_outside() {
    let (ring, small) = (arc(2.0, 0.3, TAU), arc(0.5, 1.0, -TAU));
    let frame = at(0.9, 1.2 - 0.01, 0.0);
    let distance = frame.position.norm();
    let m = single(&manifolds(&ring, &small, &frame, 0.1));
    assert!((gap(&m, &frame, 0) - (1.5 - distance)).abs() < 1e-14);
    let m = single(&manifolds(&small, &ring, &frame.inverse(), 0.1));
    assert!((gap(&m, &frame.inverse(), 0) - (1.5 - distance)).abs() < 1e-14);
    let frame = at(-2.6, 0.0, 0.0);
    let m = single(&manifolds(&ring, &small, &frame, 0.2));
    assert!((gap(&m, &frame, 0) - 0.1).abs() < 1e-14);
    assert_eq!(normal(&m, &frame, 0), vec2(-1.0, 0.0));
}

#[test]
fn two_hooks_meet_end_to_end_and_end_to_side() {
    let (a, b) = (arc(1.0, 0.0, FRAC_PI_2), arc(1.0, 0.0, FRAC_PI_2));
    // b turned by half a turn about the first end of a, then a little down: ends face each other.
    let frame = at(2.0, -0.01, PI);
    let m = single(&manifolds(&a, &b, &frame, 0.05));
    assert!((gap(&m, &frame, 0) - 0.01).abs() < 1e-12, "{m:?}");
    assert!((normal(&m, &frame, 0) - vec2(0.0, -1.0)).norm() < 1e-12);
}

/// Points of a wire, close to one another.
fn points(arc: &Geometry, frame: &Frame) -> Vec<Vec2> {
    let Geometry::Arc(arc) = arc else { panic!("no arc") };
    let point = |i: i32| {
        let turn = Rot::new(arc.sweep * Real::from(i) / 2000.0);
        frame.apply(arc.center + turn.apply(arc.from) * arc.radius)
    };
    (0..=2000).map(point).collect()
}

/// Distance of a point from a convex shape, 0 inside.
fn distance(shape: &Geometry, frame: &Frame, p: Vec2) -> Real {
    let Geometry::Convex(core) = shape else { panic!("an arc") };
    let p = frame.apply_inverse(p);
    let n = core.vertices.len();
    let mut least = Real::INFINITY;
    for i in 0..n {
        let (a, b) = (core.vertices[i], core.vertices[(i + 1) % n]);
        let l = (b - a).norm_squared();
        let t = if l > 0.0 { ((p - a).dot(&(b - a)) / l).clamp(0.0, 1.0) } else { 0.0 };
        least = least.min((p - a - (b - a) * t).norm());
    }
    let within = n > 2 && (0..n).all(|i| core.normals[i].dot(&(p - core.vertices[i])) <= 0.0);
    if within { 0.0 } else { (least - core.radius).max(0.0) }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1500))]

    #[test]
    fn apart_from_a_wire_the_least_gap_is_the_distance(
        b in shapes(), start in -7.0..7.0, sweep in 0.2..TAU, radius in 0.5..4.0,
        x in -4.0..4.0, y in -4.0..4.0, turn in -7.0..7.0,
    ) {
        let (a, b) = (arc(radius, start, sweep), one(b));
        let frame = at(x, y, turn);
        let sampled = points(&a, &Frame::IDENTITY).into_iter().map(|p| distance(&b, &frame, p));
        let expected = sampled.fold(Real::INFINITY, Real::min);
        prop_assume!(expected > 0.01);
        let least = least_gap(&manifolds(&a, &b, &frame, 20.0), &frame);
        // Samples are up to half a step from the closest point.
        let step = radius * sweep / 2000.0;
        prop_assert!(least <= expected + 1e-12 && least >= expected - step, "{least} for {expected}");
    }

    #[test]
    fn two_wires_apart_have_the_gap_of_their_points(
        s in (-7.0..7.0, 0.2..TAU, 0.5..3.0), t in (-7.0..7.0, 0.2..TAU, 0.5..3.0),
        x in -4.0..4.0, y in -4.0..4.0,
    ) {
        let (a, b) = (arc(s.2, s.0, s.1), arc(t.2, t.0, t.1));
        let frame = at(x, y, 0.5);
        let few = |arc: &Geometry, frame: &Frame| -> Vec<Vec2> {
            points(arc, frame).into_iter().step_by(8).collect()
        };
        let (pa, pb) = (few(&a, &Frame::IDENTITY), few(&b, &frame));
        let pairs = pa.iter().flat_map(|p| pb.iter().map(move |q| (p - q).norm()));
        let expected = pairs.fold(Real::INFINITY, Real::min);
        let step = (s.1 * s.2).max(t.1 * t.2) / 250.0;
        prop_assume!(expected > 2.0 * step);
        let least = least_gap(&manifolds(&a, &b, &frame, 20.0), &frame);
        prop_assert!(least <= expected + 1e-12 && least >= expected - 2.0 * step, "{least} for {expected}");
    }
}
