//! Distances are those of the nearest points of two outlines.

use culbuto::collision::{Geometry, contains, distance, distance_to_point, overlap};
use culbuto::math::{Pose, Real, vec2};
use proptest::prelude::*;

use crate::figures::{
    arc, b_in_a, convex, disk, geometries, outline, points, poses, rectangle, scaled,
};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn no_points_are_nearer(a in geometries(), b in geometries(), pose in poses(4.0, 7.0)) {
        let frame = b_in_a(&Pose::IDENTITY, &pose);
        let closest = distance(&a, &b, &frame);
        let [on_a, on_b] = [&a, &b].map(|geometry| outline(geometry, 400));
        let on_b: Vec<_> = on_b.into_iter().map(|p| frame.apply(p)).collect();
        let nearest = on_a.iter().flat_map(|p| on_b.iter().map(move |q| (p - q).norm()));
        let nearest = nearest.fold(Real::INFINITY, Real::min);
        if closest.distance > 0.0 {
            let spacing = 0.1;
            prop_assert!(closest.distance <= nearest + 1e-12);
            prop_assert!(closest.distance >= nearest - spacing);
            // The points are points of the shapes, so that nothing can be nearer than the distance and
            // the distance is met.
            let gap = closest.on_b - closest.on_a;
            prop_assert!((gap - closest.normal * closest.distance).norm() < 1e-12);
            prop_assert!(distance_to_point(&a, closest.on_a).distance.abs() < 1e-12);
            prop_assert!(distance_to_point(&b, frame.apply_inverse(closest.on_b)).distance.abs() < 1e-12);
        } else {
            prop_assert!(nearest < 0.1 || on_a.iter().any(|p| contains(&b, frame.apply_inverse(*p)))
                || on_b.iter().any(|p| contains(&a, *p)), "they overlap, {nearest}");
        }
        prop_assert!((closest.normal.norm() - 1.0).abs() < 1e-12);
    }

    /// Whoever comes first, and however large.
    #[test]
    fn it_has_no_order_and_no_scale(a in geometries(), b in geometries(), pose in poses(3.0, 7.0), k in -6..=6_i32) {
        let there = distance(&a, &b, &b_in_a(&Pose::IDENTITY, &pose));
        let back = distance(&b, &a, &b_in_a(&pose, &Pose::IDENTITY));
        prop_assert!((there.distance - back.distance).abs() < 1e-12);
        let factor = Real::powi(10.0, k);
        let far = Pose::new(pose.position * factor, pose.angle);
        let large = distance(&scaled(&a, factor), &scaled(&b, factor), &b_in_a(&Pose::IDENTITY, &far));
        prop_assert!((large.distance / factor - there.distance).abs() < 1e-12);
    }

    /// Moving two overlapping convex shapes apart along the normal by their depth makes them touch.
    #[test]
    fn depth_parts(a in geometries(), b in geometries(), pose in poses(1.5, 7.0)) {
        let frame = b_in_a(&Pose::IDENTITY, &pose);
        let closest = distance(&a, &b, &frame);
        if closest.distance < 0.0 && matches!((&a, &b), (Geometry::Convex(_), Geometry::Convex(_))) {
            let mut apart = frame;
            apart.position -= closest.normal * closest.distance;
            prop_assert!(distance(&a, &b, &apart).distance.abs() < 1e-12);
        }
    }

    /// A shape is as far from a point as from a disk about it, less the radius.
    #[test]
    fn a_point_is_a_small_disk(a in geometries(), p in points(3.0), radius in 0.001..0.5) {
        let to_point = distance_to_point(&a, p);
        let to_disk = distance(&a, &disk(p, radius), &b_in_a(&Pose::IDENTITY, &Pose::IDENTITY));
        prop_assert!((to_point.distance - radius - to_disk.distance).abs() < 1e-12);
        prop_assert_eq!(contains(&a, p), matches!(a, Geometry::Convex(_)) && to_point.distance <= 0.0);
    }
}

#[test]
fn known_distances() {
    let quarter = std::f64::consts::FRAC_PI_2;
    let bowl = arc(vec2(0.0, 0.0), 2.0, 2.0 * quarter, 2.0 * quarter);
    let cases = [
        (rectangle(2.0, 2.0), rectangle(2.0, 2.0), vec2(3.0, 0.5), 1.0),
        (rectangle(2.0, 2.0), rectangle(2.0, 2.0), vec2(5.0, 6.0), 5.0),
        (rectangle(2.0, 2.0), rectangle(2.0, 2.0), vec2(1.5, 0.0), -0.5),
        (
            convex(vec![vec2(0.0, 0.0), vec2(1.0, 0.0)], 0.0),
            convex(vec![vec2(0.0, 0.0), vec2(1.0, 0.0)], 0.0),
            vec2(3.0, 0.0),
            2.0,
        ),
        (bowl.clone(), rectangle(1.0, 1.0), vec2(0.0, 0.0), 2.0 - 0.5_f64.sqrt()),
        (bowl.clone(), disk(vec2(0.0, 0.0), 0.5), vec2(0.0, -1.0), 0.5),
        (bowl.clone(), disk(vec2(0.0, 0.0), 0.5), vec2(0.0, -4.0), 1.5),
        (bowl.clone(), disk(vec2(0.0, 0.0), 0.5), vec2(2.0, 3.0), 2.5),
        (bowl.clone(), bowl, vec2(0.0, -5.0), Real::sqrt(29.0) - 2.0),
        (
            arc(vec2(0.0, 0.0), 2.0, 0.0, 4.0 * quarter),
            arc(vec2(0.0, 0.0), 1.0, 0.0, 1.0),
            vec2(0.5, 0.0),
            0.5,
        ),
    ];
    for (a, b, offset, wanted) in cases {
        let found = distance(&a, &b, &b_in_a(&Pose::IDENTITY, &Pose::new(offset, 0.0)));
        assert!(
            (found.distance - wanted).abs() < 1e-15,
            "{} is not {wanted}: {a:?} {b:?}",
            found.distance
        );
        assert_eq!(
            overlap(&a, &b, &b_in_a(&Pose::IDENTITY, &Pose::new(offset, 0.0))),
            wanted <= 0.0
        );
    }
}
