//! Width across the motion (S5b).

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use culbuto::math::{Real, Rot, Vec2, vec2};
use culbuto::shapes::{Shape, ShapeDef, Silhouette};
use proptest::prelude::*;

use crate::common::{assert_close, outline_and_holes, polygons};

fn toward(angle: Real) -> Vec2 {
    Rot::new(angle).apply(vec2(1.0, 0.0))
}

fn alone(shape: &Shape) -> Silhouette {
    Silhouette::new(&[shape])
}

proptest! {
    #[test]
    fn a_turned_box_is_a_sin_plus_b_cos_wide(
        a in 1e-3..1e3, b in 1e-3..1e3, phi in -7.0..7.0, length in 1e-6..1e6, x in -1e6..1e6,
    ) {
        let def = ShapeDef::Box { width: a, height: b, center: vec2(x, 0.0), angle: 0.0 };
        let shadow = alone(&Shape::new(def).unwrap());
        let (sin, cos) = Real::sin_cos(phi);
        let width = shadow.width_across(toward(phi) * length);
        prop_assert!((width - (a * sin.abs() + b * cos.abs())).abs() <= 1e-14 * a.max(b));
    }

    #[test]
    fn circles_and_capsules_are_as_wide_as_their_formula(r in 1e-3..1e3, l in 1e-3..1e3, phi in -7.0..7.0) {
        let circle = alone(&Shape::circle(r).unwrap());
        assert_close(circle.width_across(toward(phi)), 2.0 * r, 1e-15);
        let capsule = alone(&Shape::capsule(vec2(0.0, 0.0), vec2(l, 0.0), r).unwrap());
        let expected = 2.0 * r + l * phi.sin().abs();
        assert_close(capsule.width_across(toward(phi)), expected, 4e-15);
        let wire = alone(&Shape::segment(vec2(0.0, 0.0), vec2(l, 0.0)).unwrap());
        prop_assert!((wire.width_across(toward(phi)) - l * phi.sin().abs()).abs() <= 1e-15 * l);
    }

    #[test]
    fn a_polygon_is_as_wide_as_its_vertices_reach(grid in polygons(), phi in -7.0..7.0) {
        let outline = crate::common::points(&grid[0], [0, 0]);
        let across = vec2(-Real::sin(phi), Real::cos(phi));
        let along = outline.iter().map(|p| p.dot(&across));
        let (min, max) = along.fold((1e9, -1e9), |(a, b): (Real, Real), x| (a.min(x), b.max(x)));
        let width = alone(&Shape::polygon(&outline).unwrap()).width_across(toward(phi));
        prop_assert!((width - (max - min)).abs() <= 1e-10);
    }

    #[test]
    fn gaps_do_not_count_and_overlaps_count_once(
        parts in prop::collection::vec((0..100_i32, 1..20_i32), 1..40),
    ) {
        // Boxes one unit wide on unit cells of a line: the shadow of light from above is the number
        // of cells covered.
        let shapes: Vec<Shape> = parts
            .iter()
            .map(|&(x, w)| {
                let w = Real::from(w);
                let center = vec2(Real::from(x) + w / 2.0, 3.0);
                Shape::new(ShapeDef::Box { width: w, height: 1.0, center, angle: 0.0 }).unwrap()
            })
            .collect();
        let shadow = Silhouette::new(&shapes.iter().collect::<Vec<_>>());
        let covered = (0..200).filter(|c| parts.iter().any(|(x, w)| (x..&(x + w)).contains(&c))).count();
        prop_assert!((shadow.width_across(vec2(0.0, -2.0)) - covered as Real).abs() < 1e-11);
        prop_assert!((shadow.width_across(vec2(5.0, 0.0)) - 1.0).abs() < 1e-14);
    }

    #[test]
    fn the_bounding_box_is_never_narrower_than_the_silhouette(
        grid in polygons(), turn in -7.0..7.0, phi in -7.0..7.0,
    ) {
        let shadow = alone(&Shape::polygon(&crate::common::points(&grid[0], [0, 0])).unwrap());
        let rot = Rot::new(turn);
        let bounding = shadow.bounding_box_width_across(toward(phi), rot);
        prop_assert!(bounding >= shadow.width_across(rot.apply_inverse(toward(phi))) * (1.0 - 1e-14));
    }
}

proptest! {
    #[test]
    fn a_facet_bounds_the_width_where_it_is_shown_and_no_silhouette_is_narrower(
        grid in polygons(), phi in -7.0..7.0, turn in -0.3..0.3, gap in 0.0..9.0,
    ) {
        let (vertices, _) = outline_and_holes(&grid, [0, 0]);
        let polygon = Shape::polygon(&vertices).unwrap();
        let arc = Shape::arc(vec2(gap, -gap), 2.0, phi, 2.0).unwrap();
        let capsule = Shape::capsule(vec2(-gap, gap), vec2(-gap, 0.0), 0.5).unwrap();
        let size = polygon.extent_from(Vec2::zeros()) + 20.0;
        for parts in [&[&polygon][..], &[&arc], &[&capsule], &[&polygon, &arc, &capsule]] {
            let shadow = Silhouette::new(parts);
            let facet = shadow.facet(toward(phi));
            let there = shadow.width_across(toward(phi));
            prop_assert!((facet.width_across(toward(phi)) - there).abs() <= 1e-14 * size);
            // The points that bound one convex body bound it from within everywhere else.
            if parts.len() == 1 && parts[0] != &arc {
                let beyond = toward(phi + turn);
                prop_assert!(facet.width_across(beyond) <= shadow.width_across(beyond) + 1e-14 * size);
            }
        }
    }
}

#[test]
fn the_mean_width_of_a_convex_shape_is_its_perimeter_over_pi() {
    let smooth = [Shape::circle(1.3).unwrap()];
    let cornered = [
        Shape::rectangle(3.0, 0.2).unwrap(),
        Shape::regular_polygon(5, 2.0).unwrap(),
        Shape::regular_polygon(6, 2.0).unwrap(),
        Shape::capsule(vec2(0.0, 0.0), vec2(2.0, 1.0), 0.4).unwrap(),
        Shape::polygon(&[vec2(0.0, 0.0), vec2(3.0, 0.5), vec2(1.0, 2.0)]).unwrap(),
        Shape::rounded_polygon(&[vec2(0.0, 0.0), vec2(3.0, 0.5), vec2(1.0, 2.0)], 0.7).unwrap(),
    ];
    let n = 20_000;
    for (shapes, tolerance) in
        [(&smooth[..], 1e-12), (&cornered[..], 2.0 * (PI / Real::from(n)).powi(2))]
    {
        for shape in shapes {
            let shadow = alone(shape);
            // The midpoint rule; the kinks of the width leave an error of the step squared.
            let width =
                |k: i32| shadow.width_across(toward(PI * (Real::from(k) + 0.5) / Real::from(n)));
            let mean = (0..n).map(width).sum::<Real>() / Real::from(n);
            assert_close(mean, shape.perimeter() / PI, tolerance);
        }
    }
}

#[test]
fn arcs_are_as_wide_as_they_bulge() {
    let half = Shape::arc(vec2(7.0, 7.0), 2.0, 0.0, PI).unwrap();
    assert_close(alone(&half).width_across(vec2(0.0, 1.0)), 4.0, 1e-15);
    assert_close(alone(&half).width_across(vec2(1.0, 0.0)), 2.0, 1e-15);
    let ring = Shape::arc(vec2(7.0, 7.0), 2.0, 1.0, -TAU).unwrap();
    assert_close(alone(&ring).width_across(toward(0.3)), 4.0, 1e-15);
    let quarter = Shape::arc(vec2(7.0, 7.0), 2.0, 0.0, FRAC_PI_2).unwrap();
    // Across 45°: from one end to the other; along it: the bulge.
    assert_close(alone(&quarter).width_across(toward(PI / 4.0)), 8.0_f64.sqrt(), 1e-15);
    assert_close(alone(&quarter).width_across(toward(-PI / 4.0)), 2.0 - 2.0_f64.sqrt(), 1e-14);
}

#[test]
fn the_shortest_arcs_do_not_bulge_behind_their_centre() {
    for k in 0..100 {
        let start = Real::from(k) * 0.37;
        let shadow = alone(&Shape::arc(vec2(0.0, 0.0), 1.0, start, 1e-16).unwrap());
        // Light along the tangent sees a point, up to rounding.
        assert!(shadow.width_across(toward(start + FRAC_PI_2)) < 1e-15);
    }
}

#[test]
fn the_bounding_box_of_the_source_is_the_box_of_the_world() {
    let shadow = alone(&Shape::rectangle(2.0, 1.0).unwrap());
    // Turned by 30°: the box along the axes is (2c + s) × (2s + c).
    let (s, c) = (0.5, 0.75_f64.sqrt());
    let across =
        |phi: Real| shadow.bounding_box_width_across(toward(phi) * 9.0, Rot::new(PI / 6.0));
    assert_close(across(0.0), 2.0 * s + c, 1e-15);
    assert_close(across(FRAC_PI_2), 2.0 * c + s, 1e-15);
    let (w, h) = (2.0 * c + s, 2.0 * s + c);
    assert_close(across(0.4), w * Real::sin(0.4) + h * Real::cos(0.4), 1e-15);
}

#[test]
fn no_shapes_and_no_direction_cast_no_shadow() {
    assert_eq!(Silhouette::new(&[]).width_across(vec2(1.0, 0.0)), 0.0);
    assert_eq!(Silhouette::new(&[]).bounding_box_width_across(vec2(1.0, 0.0), Rot::IDENTITY), 0.0);
    assert_eq!(alone(&Shape::circle(1.0).unwrap()).width_across(vec2(0.0, 0.0)), 0.0);
}
