//! What rays and moving shapes hit.

use culbuto::collision::{Geometry, cast_ray, cast_shape, contains, distance, distance_to_point};
use culbuto::math::{Pose, Real, vec2};
use proptest::prelude::*;

use crate::figures::{arc, b_in_a, convex, disk, geometries, points, poses, rectangle};

proptest! {
    #![proptest_config(ProptestConfig::with_cases(500))]

    /// The hit is on the surface, and nothing of the shape is before it.
    #[test]
    fn a_ray_hits_what_comes_first(a in geometries(), origin in points(3.0), translation in points(6.0)) {
        let hit = cast_ray(&a, origin, translation);
        let inside = contains(&a, origin);
        prop_assert!(!inside || hit.is_some_and(|hit| hit.fraction == 0.0));
        let end = hit.map_or(1.0, |hit| hit.fraction);
        let ends_before = |t: Real| (origin + translation * t, origin + translation * (t + end / 300.0));
        for k in 0..300 {
            let (p, q) = ends_before(end * Real::from(k) / 300.0);
            let [before, after] = [p, q].map(|p| distance_to_point(&a, p).distance);
            prop_assert!(before > -1e-12 || inside);
            // No stretch crosses a wire: at the far side of it the nearest point would lie behind.
            let reached = before.max(after) > 1e-12;
            prop_assert!(reached || inside || k == 299 || translation.norm() < 1e-9, "passed at {}", k);
        }
        if let Some(hit) = hit.filter(|_| !inside) {
            prop_assert!(distance_to_point(&a, hit.point).distance.abs() < 1e-12);
            prop_assert!((hit.point - origin - translation * hit.fraction).norm() < 1e-12);
            prop_assert!((hit.normal.norm() - 1.0).abs() < 1e-12 && hit.normal.dot(&translation) <= 1e-12);
            let along = distance_to_point(&a, hit.point + hit.normal * 1e-3);
            prop_assert!(along.distance <= 1e-3 + 1e-12);
            prop_assert!(along.distance >= 1e-3 - 1e-9 || matches!(a, Geometry::Arc(_)));
        }
    }

    /// A ray is the limit of a small disk that moves.
    #[test]
    fn a_thin_disk_goes_as_a_ray(a in geometries(), origin in points(3.0), translation in points(6.0)) {
        let disk = disk(vec2(0.0, 0.0), 1e-9);
        let [start, rest] = [Pose::new(origin, 0.0), Pose::IDENTITY];
        let shape = cast_shape((&disk, &start), translation, (&a, &rest));
        if let Some(hit) = cast_ray(&a, origin, translation) {
            let shape = shape.expect("the disk is about the ray");
            // Where the surface is nearly along the ray, the disk is earlier.
            let slope = hit.normal.dot(&translation).abs();
            prop_assert!(hit.fraction >= shape.fraction - 1e-12);
            prop_assert!(slope < 0.1 || hit.fraction - shape.fraction < 1e-7);
        }
    }

    /// Where a moved shape is stopped, it touches, with the normal of the touch; before, it is apart.
    #[test]
    fn a_shape_stops_where_it_touches(
        a in geometries(), b in geometries(), start in poses(4.0, 3.0), rest in poses(4.0, 3.0), translation in points(8.0),
    ) {
        let hit = cast_shape((&a, &start), translation, (&b, &rest));
        let apart = |t: Real| {
            let pose = Pose::new(start.position + translation * t, start.angle);
            distance(&b, &a, &b_in_a(&rest, &pose)).distance
        };
        let end = hit.map_or(1.0, |hit| hit.fraction);
        for k in 0..300 {
            prop_assert!(apart(end * Real::from(k) / 300.0) >= -1e-12 || end == 0.0);
        }
        if let Some(hit) = hit.filter(|hit| hit.fraction > 0.0) {
            prop_assert!(apart(hit.fraction).abs() < 1e-12, "{:e} {:?}", apart(hit.fraction), hit);
            let on_b = distance_to_point(&b, rest.apply_inverse(hit.point));
            prop_assert!(on_b.distance.abs() < 1e-12);
            prop_assert!((hit.normal.norm() - 1.0).abs() < 1e-12 && hit.normal.dot(&translation) < 1e-9);
        }
    }
}

#[test]
fn known_hits() {
    let wire = convex(vec![vec2(-1.0, 0.0), vec2(1.0, 0.0)], 0.0);
    let bowl = arc(vec2(0.0, 0.0), 2.0, std::f64::consts::PI, std::f64::consts::PI);
    let cases = [
        (rectangle(2.0, 2.0), [-3.0, 0.0], [4.0, 0.0], Some((0.5, [-1.0, 0.0]))),
        (rectangle(2.0, 2.0), [-3.0, 3.0], [4.0, -4.0], Some((0.5, [0.0, 0.0]))),
        (rectangle(2.0, 2.0), [-3.0, 1.5], [4.0, 0.0], None),
        (rectangle(2.0, 2.0), [0.0, 0.0], [4.0, 0.0], Some((0.0, [-1.0, 0.0]))),
        (disk(vec2(0.0, 0.0), 1.0), [0.0, 3.0], [0.0, -4.0], Some((0.5, [0.0, 1.0]))),
        (wire.clone(), [0.0, 1.0], [0.0, -2.0], Some((0.5, [0.0, 1.0]))),
        (wire.clone(), [0.0, -1.0], [0.0, 2.0], Some((0.5, [0.0, -1.0]))),
        (wire.clone(), [-3.0, 0.0], [4.0, 0.0], Some((0.5, [-1.0, 0.0]))),
        (wire, [1.0, 1.0], [0.0, -2.0], Some((0.5, [0.0, 1.0]))),
        (bowl.clone(), [0.0, 0.0], [0.0, -4.0], Some((0.5, [0.0, 1.0]))),
        (bowl.clone(), [0.0, -4.0], [0.0, 8.0], Some((0.25, [0.0, -1.0]))),
        (bowl, [0.0, 4.0], [0.0, -5.0], None),
    ];
    for (geometry, [x, y], [dx, dy], wanted) in cases {
        let hit = cast_ray(&geometry, vec2(x, y), vec2(dx, dy));
        let found = hit.map(|hit| hit.fraction);
        assert_eq!(found, wanted.map(|w| w.0), "{geometry:?} from {x}, {y}");
        if let (Some(hit), Some((_, [nx, ny]))) = (hit, wanted)
            && (nx, ny) != (0.0, 0.0)
        {
            assert!((hit.normal - vec2(nx, ny)).norm() < 1e-15, "{hit:?}");
        }
    }
}

/// Wires with a common end let no ray through there.
#[test]
fn a_chain_has_no_holes() {
    for k in 0..200 {
        let joint = vec2(0.1 + 0.01 * Real::from(k), 0.3);
        let [left, right] = [vec2(-1.0, 0.1), vec2(3.0, -0.2)];
        let [a, b] = [[left, joint], [joint, right]].map(|ends| convex(ends.to_vec(), 0.0));
        let origin = vec2(0.7, 2.1);
        let beyond = (joint - origin) * 1.7;
        assert!(cast_ray(&a, origin, beyond).or(cast_ray(&b, origin, beyond)).is_some());
    }
}
