//! Joins: what slides along a chain or over the cuts of a concave polygon does not catch on them.

use culbuto::collision::{Frame, Geometry, Manifold};
use culbuto::math::{Real, Rot, Vec2, vec2};
use culbuto::shapes::{Shape, ShapeDef};
use proptest::prelude::*;

use crate::common::{at, gap, manifolds, normal, of, one};

fn chain(points: &[Vec2], one_sided: bool) -> Vec<Geometry> {
    let def = ShapeDef::Chain { points: points.to_vec(), closed: false, one_sided };
    of(Shape::new(def).unwrap()).into_iter().map(|c| c.geometry).collect()
}

fn against_all(all: &[Geometry], b: &Geometry, frame: &Frame, margin: Real) -> Vec<Manifold> {
    all.iter().flat_map(|a| manifolds(a, b, frame, margin)).collect()
}

/// Ground from left to right, with points at odd places.
fn flat() -> Vec<Vec2> {
    [-9.0, -7.3, -4.0, -3.9, -1.0, 0.0, 0.1, 2.0, 5.0, 9.0].map(|x| vec2(x, 0.0)).to_vec()
}

fn sliders() -> impl Strategy<Value = Geometry> {
    prop_oneof![
        (0.1..2.0, 0.1..2.0).prop_map(|(w, h)| one(Shape::rectangle(w, h).unwrap())),
        (0.1..1.0).prop_map(|r| one(Shape::circle(r).unwrap())),
        (0.1..1.0, 0.1..1.0).prop_map(|(l, r): (Real, Real)| {
            one(Shape::capsule(vec2(-l, 0.0), vec2(l, 0.0), r).unwrap())
        }),
        (3..9_u32, 0.2..1.0).prop_map(|(n, r)| one(Shape::regular_polygon(n, r).unwrap())),
    ]
}

/// Lowest point of a shape seen in a frame without position.
fn lowest(b: &Geometry, rot: Rot) -> Real {
    let Geometry::Convex(core) = b else { panic!("an arc") };
    let heights = core.vertices.iter().map(|v| rot.apply(*v).y);
    heights.fold(Real::INFINITY, Real::min) - core.radius
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn on_a_flat_chain_every_normal_is_that_of_the_chain(
        b in sliders(), x in -3.0..3.0, turn in prop_oneof![Just(0.0), -7.0..7.0, -1e-4..1e-4_f64],
        height in prop_oneof![-1e-3..1e-2_f64, Just(0.0), -1e-12..1e-12_f64], one_sided in any::<bool>(), margin in 0.02..3.0,
    ) {
        let rot = Rot::new(turn);
        let frame = at(x, height - lowest(&b, rot), turn);
        let found = against_all(&chain(&flat(), one_sided), &b, &frame, margin);
        let mut least = Real::INFINITY;
        for m in &found {
            for i in 0..m.count {
                let n = normal(m, &frame, i);
                prop_assert!((n - vec2(0.0, 1.0)).norm() < 2e-9, "{n:?} of {m:?}");
                least = least.min(gap(m, &frame, i));
            }
        }
        prop_assert!((least - height).abs() < 1e-8, "{least} for {height}: {found:?}");
    }

    #[test]
    fn over_a_bend_normals_stay_between_those_of_the_links(
        b in sliders(), x in -1.0..1.0, bend in -0.2..0.2_f64, lift in 0.0..0.05_f64, turn in -0.3..0.3_f64,
    ) {
        let points: Vec<Vec2> = (-4..=4).map(|i| {
            let i = Real::from(i);
            vec2(i * 1.7, -bend * i * i / 2.0)
        }).collect();
        let all = chain(&points, true);
        let frame = at(x, lift - lowest(&b, Rot::new(turn)), turn);
        let slopes = points.windows(2).map(|p| (p[1] - p[0]).y / (p[1] - p[0]).x);
        let steepest = slopes.map(Real::abs).fold(0.0, Real::max);
        for m in against_all(&all, &b, &frame, 0.02) {
            let n = normal(&m, &frame, 0);
            prop_assert!(n.y > 0.0 && (n.x / n.y).abs() <= steepest + 1e-8, "{m:?}");
        }
    }
}

#[test]
fn a_box_sliding_into_the_next_link_meets_no_end() {
    let all = chain(&flat(), false);
    let square = one(Shape::rectangle(1.0, 1.0).unwrap());
    for step in 0..4000 {
        let frame = at(-3.0 + 1.5e-3 * f64::from(step), 0.5 - 1e-4, 0.0);
        let found = against_all(&all, &square, &frame, 0.01);
        assert!(!found.is_empty());
        for m in &found {
            assert_eq!(normal(m, &frame, 0), vec2(0.0, 1.0));
        }
    }
}

#[test]
fn a_ball_on_a_sharp_ridge_is_held_by_it() {
    let all = chain(&[vec2(-2.0, -2.0), vec2(0.0, 0.0), vec2(2.0, -2.0)], true);
    let ball = one(Shape::circle(0.5).unwrap());
    let frame = at(0.1, 0.51, 0.0);
    let found = against_all(&all, &ball, &frame, 0.1);
    assert!(!found.is_empty());
    for m in &found {
        let expected = vec2(0.1, 0.51);
        assert!((normal(m, &frame, 0) - expected.normalize()).norm() < 1e-14);
        assert!((gap(m, &frame, 0) - (expected.norm() - 0.5)).abs() < 1e-14);
    }
}

#[test]
fn a_one_sided_chain_lets_through_what_comes_from_its_right() {
    let ball = one(Shape::circle(0.5).unwrap());
    let count = |one_sided: bool, y: Real| {
        against_all(&chain(&flat(), one_sided), &ball, &at(1.0, y, 0.0), 0.1).len()
    };
    assert_eq!([count(true, 0.4), count(true, -0.4)], [1, 0]);
    assert_eq!([count(false, 0.4), count(false, -0.4)], [1, 1]);
}

#[test]
fn the_ends_of_an_open_chain_stop_what_runs_into_them() {
    let ball = one(Shape::circle(0.5).unwrap());
    let [m] = against_all(&chain(&flat(), false), &ball, &at(9.51, 0.0, 0.0), 0.1)[..] else {
        panic!("one manifold");
    };
    assert!((normal(&m, &at(9.51, 0.0, 0.0), 0) - vec2(1.0, 0.0)).norm() < 1e-14);
}

/// A comb, whose pieces have many cuts.
fn comb() -> Vec<Geometry> {
    let mut points = vec![vec2(0.0, -1.0), vec2(9.0, -1.0)];
    for i in (0..5).rev() {
        let x = 2.0 * Real::from(i);
        points.extend([vec2(x + 1.0, 0.0), vec2(x + 1.0, 2.0), vec2(x, 2.0), vec2(x, 0.0)]);
    }
    points[2].x = 9.0;
    of(Shape::polygon(&points).unwrap()).into_iter().map(|c| c.geometry).collect()
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn cuts_of_a_concave_polygon_give_no_normals(
        radius in 0.02..0.4, x in -1.0..10.0, y in -2.0..3.0,
    ) {
        let all = comb();
        prop_assert!(all.len() > 3);
        let ball = one(Shape::circle(radius).unwrap());
        let frame = at(x, y, 0.0);
        // Outlines run along the axes: in front of a face, normals do.
        for m in against_all(&all, &ball, &frame, 0.1) {
            let n = normal(&m, &frame, 0);
            let foot = frame.position - n * (gap(&m, &frame, 0) + radius);
            let on_x = [-1.0, 0.0, 2.0].iter().any(|e| (foot.y - e).abs() < 1e-9);
            let on_y = (0..10).any(|e| (foot.x - Real::from(e)).abs() < 1e-9);
            prop_assert!(on_x || on_y, "{foot:?}");
            let corner = on_x && on_y;
            prop_assert!(corner || (n.x.abs() < 1e-12 || n.y.abs() < 1e-12), "{n:?} at {foot:?}");
        }
    }
}

#[test]
fn the_cuts_of_a_bar_of_teeth_carry_a_box_between_two() {
    // A box on the floor between two teeth: floor and both walls, nothing aslant.
    let all = comb();
    let square = one(Shape::rectangle(0.98, 0.98).unwrap());
    for frame in [at(1.5, 0.495, 0.0), at(1.5, 0.4899, 0.0), at(3.499, 0.49, 0.0)] {
        let found = against_all(&all, &square, &frame, 0.02);
        assert!(found.len() >= 3, "{found:?}");
        for m in &found {
            let n = normal(m, &frame, 0);
            assert!(n.x.abs() < 1e-12 || n.y.abs() < 1e-12, "{n:?} of {m:?}");
            for i in 0..m.count {
                assert!(gap(m, &frame, i) > -2e-4, "{m:?}");
            }
        }
    }
}
