//! What must not matter: which of two shapes is first, and the unit of length.

use culbuto::Part;
use culbuto::collision::{Frame, Geometry, Manifold, Normal, colliders};
use culbuto::math::{Pose, Real, Vec2, vec2};
use culbuto::shapes::{Shape, ShapeDef};
use proptest::prelude::*;

use crate::common::{
    at, convex, frames, gap, least_gap, manifolds, normal, one, reference_gap, shapes,
};

/// Normals and places of all points in the frame of A.
fn points(found: &[Manifold], frame: &Frame, swapped: Option<&Frame>) -> Vec<[Real; 4]> {
    let mut all = Vec::new();
    for m in found {
        for i in 0..m.count {
            let (n, anchor) = (normal(m, frame, i), m.anchors[i]);
            let (n, a) = match swapped {
                None => (n, anchor.on_a),
                Some(outer) => (-outer.rot.apply(n), anchor.on_b),
            };
            all.push([n.x, n.y, a.x, a.y]);
        }
    }
    all
}

/// Whether each point of one is one of the other.
fn close(x: &[[Real; 4]], y: &[[Real; 4]], tolerance: Real) -> bool {
    let same =
        |p: &[Real; 4], q: &[Real; 4]| p.iter().zip(q).all(|(p, q)| (p - q).abs() <= tolerance);
    x.len() == y.len() && x.iter().all(|p| y.iter().any(|q| same(p, q)))
}

fn arcs() -> impl Strategy<Value = Shape> {
    (0.5..2.0, -7.0..7.0, 0.2..6.2_f64)
        .prop_map(|(r, start, sweep)| Shape::arc(vec2(0.1, 0.2), r, start, sweep).unwrap())
}

/// Numbers with all lengths multiplied.
fn scaled(geometry: &Geometry, by: Real) -> Geometry {
    let mut geometry = geometry.clone();
    match &mut geometry {
        Geometry::Convex(convex) => {
            convex.vertices.iter_mut().for_each(|v| *v *= by);
            convex.radius *= by;
        }
        Geometry::Arc(arc) => {
            arc.center *= by;
            arc.radius *= by;
        }
    }
    geometry
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn exchanging_two_shapes_mirrors_the_manifold(
        a in prop_oneof![3 => shapes(), 1 => arcs()], b in prop_oneof![3 => shapes(), 1 => arcs()],
        near in frames(1.5), far in frames(20.0), apart in any::<bool>(), margin in prop_oneof![0.0..0.5, Just(100.0)],
    ) {
        let (a, b) = (one(a), one(b));
        let frame = if apart { far } else { near };
        let inverse = frame.inverse();
        let forth = manifolds(&a, &b, &frame, margin);
        let back = manifolds(&b, &a, &inverse, margin);
        let (x, y) = (points(&forth, &frame, None), points(&back, &inverse, Some(&frame)));
        prop_assert!(close(&x, &y, 1e-9), "{forth:?}\n{back:?}");
    }

    #[test]
    fn lengths_in_other_units_give_the_same_numbers(
        a in prop_oneof![3 => shapes(), 1 => arcs()], b in prop_oneof![3 => shapes(), 1 => arcs()],
        frame in frames(2.0), power in -20..20,
    ) {
        let by = 2.0_f64.powi(power);
        let (a, b) = (one(a), one(b));
        let larger = Frame { position: frame.position * by, ..frame };
        let found = manifolds(&a, &b, &frame, 0.5);
        let scaled = manifolds(&scaled(&a, by), &scaled(&b, by), &larger, 0.5 * by);
        prop_assert_eq!(found.len(), scaled.len());
        for (m, s) in found.iter().zip(&scaled) {
            prop_assert_eq!(m.normal, s.normal);
            prop_assert_eq!(m.count, s.count);
            for i in 0..m.count {
                prop_assert_eq!(m.anchors[i].feature, s.anchors[i].feature);
                prop_assert_eq!(m.anchors[i].on_a * by, s.anchors[i].on_a);
                prop_assert_eq!(m.anchors[i].on_b * by, s.anchors[i].on_b);
            }
        }
    }

    /// Frames are subtracted before anything else, so what is left of both moving is rounding of poses.
    #[test]
    fn moving_both_changes_nothing(
        a in shapes(), b in shapes(), frame in frames(1.5), x in -100..100_i32, y in -100..100_i32, quarter in 0..4_usize,
    ) {
        let (a, b) = (one(a), one(b));
        let quarters = [(1.0, 0.0), (0.0, 1.0), (-1.0, 0.0), (0.0, -1.0)];
        let (cos, sin) = quarters[quarter];
        let outer = Frame { position: vec2(Real::from(x), Real::from(y)) * 1e5, rot: culbuto::math::Rot { cos, sin } };
        let placed = Frame { position: outer.position + outer.rot.apply(frame.position), rot: culbuto::math::Rot {
            cos: cos * frame.rot.cos - sin * frame.rot.sin, sin: sin * frame.rot.cos + cos * frame.rot.sin } };
        let again = placed.seen_from(&outer);
        let gap = |frame: &Frame| least_gap(&manifolds(&a, &b, frame, 10.0), frame);
        prop_assert!((gap(&again) - gap(&frame)).abs() <= 1e7 * Real::EPSILON);
    }

    #[test]
    fn anchors_lie_on_the_cores_and_feet_below_them(
        a in shapes(), b in shapes(), frame in frames(2.0),
    ) {
        let (a, b) = (one(a), one(b));
        for m in manifolds(&a, &b, &frame, 10.0) {
            for i in 0..m.count {
                let anchor = m.anchors[i];
                prop_assert!(border(&a, anchor.on_a) < 1e-12);
                prop_assert!(border(&b, anchor.on_b) < 1e-12);
                let arm = frame.apply(anchor.on_b) - anchor.on_a;
                let n = normal(&m, &frame, i);
                prop_assert!((arm - n * n.dot(&arm)).norm() < 1e-12, "a foot is not below: {m:?}");
                if let Normal::OnA(n) = m.normal {
                    let along = vec2(-n.y, n.x).dot(&anchor.on_a);
                    prop_assert!(m.face[0] - 1e-12 <= along && along <= m.face[1] + 1e-12);
                }
                if let Normal::OnB(n) = m.normal {
                    let along = vec2(-n.y, n.x).dot(&anchor.on_b);
                    prop_assert!(m.face[0] - 1e-12 <= along && along <= m.face[1] + 1e-12);
                }
            }
            if m.count == 2 {
                prop_assert_ne!(m.anchors[0].feature, m.anchors[1].feature);
                prop_assert!(m.anchors[0].on_a != m.anchors[1].on_a);
            }
        }
    }

    #[test]
    fn needles_and_narrow_angles_keep_their_digits(
        length in prop_oneof![Just(1e3), Just(1e6)], x in -0.4..0.4, height in -1e-3..1e-3_f64, turn in prop_oneof![Just(0.0), Just(1e-4), -1e-9..1e-9_f64],
    ) {
        let needle = one(Shape::rectangle(length, 1.0).unwrap());
        let square = one(Shape::rectangle(1.0, 1.0).unwrap());
        let frame = at(x * length, 1.0 + height, turn);
        for (a, b, frame) in [(&needle, &square, frame), (&square, &needle, frame.inverse()), (&needle, &needle, frame)] {
            let found = manifolds(a, b, &frame, 0.1);
            let expected = reference_gap(a, b, &frame);
            let least = least_gap(&found, &frame);
            if expected < 0.1 {
                prop_assert!((least - expected).abs() <= 2e-12 * length, "{least} {expected}");
            }
        }
    }
}

/// Distance of a point from the border of a core.
fn border(shape: &Geometry, p: Vec2) -> Real {
    let core = convex(shape);
    let n = core.vertices.len();
    let distance = |i: usize| {
        let (a, b) = (core.vertices[i], core.vertices[(i + 1) % n]);
        let l = (b - a).norm_squared();
        let t = if l > 0.0 { ((p - a).dot(&(b - a)) / l).clamp(0.0, 1.0) } else { 0.0 };
        (p - a - (b - a) * t).norm()
    };
    (0..n).map(distance).fold(Real::INFINITY, Real::min)
}

#[test]
fn vertex_on_vertex_and_grazing_pairs_have_finite_manifolds() {
    let square = one(Shape::rectangle(1.0, 1.0).unwrap());
    let disk = one(Shape::circle(0.5).unwrap());
    let wire = one(Shape::segment(vec2(-1.0, 0.0), vec2(1.0, 0.0)).unwrap());
    for (a, b) in [
        (&square, &square),
        (&square, &disk),
        (&disk, &disk),
        (&wire, &wire),
        (&wire, &square),
        (&wire, &disk),
    ] {
        for frame in [
            at(0.0, 0.0, 0.0),
            at(1.0, 1.0, 0.0),
            at(1.0 + 1e-9, 1.0, 0.0),
            at(1.0 - 1e-9, 1.0 - 1e-9, 0.0),
            at(0.5, 0.0, 0.0),
            at(2.0, 0.0, 0.0),
            at(2.0 + 1e-9, 0.0, 0.0),
            at(1.0, 0.0, 0.0),
            at(0.0, 1e-9, 0.0),
            at(0.0, 0.5, std::f64::consts::FRAC_PI_2),
            at(0.0, 1.0 + 1e-9, 0.0),
            at(0.0, 0.5 + 0.5_f64.sqrt(), std::f64::consts::FRAC_PI_4),
        ] {
            for m in manifolds(a, b, &frame, 1.0) {
                for i in 0..m.count {
                    let arm = frame.apply(m.anchors[i].on_b) - m.anchors[i].on_a;
                    let coincide = m.normal == Normal::Between && arm.norm() == 0.0;
                    assert!(!coincide, "{m:?}");
                    let gap = gap(&m, &frame, i);
                    assert!(gap.is_finite() && gap > -3.0, "{m:?}");
                }
            }
        }
    }
}

#[test]
fn collinear_segments_end_to_end_are_as_far_as_their_ends() {
    let wire = one(Shape::segment(vec2(-1.0, 0.0), vec2(1.0, 0.0)).unwrap());
    let capsule = one(Shape::capsule(vec2(-1.0, 0.0), vec2(1.0, 0.0), 0.25).unwrap());
    let frame = at(3.0, 0.0, 0.0);
    for (a, b, expected) in
        [(&wire, &wire, 1.0), (&capsule, &wire, 0.75), (&capsule, &capsule, 0.5)]
    {
        let found = manifolds(a, b, &frame, 2.0);
        assert!((least_gap(&found, &frame) - expected).abs() < 1e-15);
        assert_eq!(normal(&found[0], &frame, 0), vec2(1.0, 0.0));
    }
    let crossed = manifolds(&wire, &wire, &at(0.9, 0.0, 1.5), 0.1);
    assert!(least_gap(&crossed, &at(0.9, 0.0, 1.5)) < 0.0);
    let [side] = manifolds(&capsule, &capsule, &at(0.5, 0.51, 0.0), 0.1)[..] else { panic!("one") };
    assert_eq!((side.count, side.normal), (2, Normal::OnA(vec2(0.0, 1.0))));
}

#[test]
fn boxes_far_from_the_origin_of_their_body_keep_their_digits() {
    let center = vec2(1e9, -3e8);
    let def = ShapeDef::Box { width: 1e-3, height: 2e-3, center, angle: 0.0 };
    let part = Part::from(Shape::new(def).unwrap());
    let found = colliders(3, &[part.clone(), part], center);
    assert_eq!((found.len(), found[1].body, found[1].part), (2, 3, 1));
    assert_eq!(found[0].width, 1e-3);
    let half = vec2(0.5e-3, 1e-3);
    assert!(convex(&found[0].geometry).vertices.iter().all(|v| v.abs() == half));
    assert!((found[0].reach / half.norm() - 1.0).abs() < 1e-15);
    let pose = Pose::new(vec2(1e7, 1e7), 0.0);
    let above = Pose::new(vec2(1e7, 1e7 + 0.002), 0.0);
    let frame = Frame::of(&above).seen_from(&Frame::of(&pose));
    let m = manifolds(&found[0].geometry, &found[1].geometry, &frame, 1e-3);
    let exact = above.position.y - pose.position.y - 2e-3;
    assert!((least_gap(&m, &frame) - exact).abs() < 1e-17);
}

#[test]
fn features_last_when_the_reference_face_changes_sides() {
    let (a, b) =
        (one(Shape::rectangle(2.0, 1.0).unwrap()), one(Shape::rectangle(1.0, 1.0).unwrap()));
    let features = |turn: Real| {
        let m = manifolds(&a, &b, &at(0.9, 1.01, turn), 0.1)[0];
        let mut features = m.anchors.map(|anchor| anchor.feature);
        features.sort_unstable();
        (m.normal, features)
    };
    let (flat, left, right) = (features(0.0), features(1e-3), features(-1e-3));
    assert!(matches!(flat.0, Normal::OnA(_)));
    assert!([left.0, right.0].iter().any(|n| matches!(n, Normal::OnB(_))));
    assert_eq!((flat.1, flat.1), (left.1, right.1));
}
