//! Gaps of convex shapes against distances and depths found from all pairs of features.

use culbuto::collision::{Geometry, collide};
use proptest::prelude::*;

use crate::common::{
    convex, frames, gap, least_gap, manifolds, normal, one, reference_gap, shapes,
};

fn reach(geometry: &Geometry) -> f64 {
    let convex = convex(geometry);
    convex.vertices.iter().map(culbuto::math::Vec2::norm).fold(0.0, f64::max) + convex.radius
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(3000))]

    #[test]
    fn the_least_gap_is_the_distance_or_the_least_depth(
        a in shapes(), b in shapes(), near in frames(1.5), far in frames(30.0), apart in any::<bool>(),
    ) {
        let (a, b) = (one(a), one(b));
        let frame = if apart { far } else { near };
        let found = manifolds(&a, &b, &frame, 1e3);
        prop_assert_eq!(found.len(), 1);
        let scale = frame.position.norm() + reach(&a) + reach(&b);
        let (least, expected) = (least_gap(&found, &frame), reference_gap(&a, &b, &frame));
        prop_assert!((least - expected).abs() <= 1e-12 * scale, "{least} for {expected}: {found:?}");
    }

    #[test]
    fn shapes_are_as_far_apart_as_is_said_where_nothing_is_found(
        a in shapes(), b in shapes(), frame in frames(4.0), margin in 0.0..1.0,
    ) {
        let (a, b) = (one(a), one(b));
        let mut found = Vec::new();
        let said = collide(&a, &b, &frame, margin, &mut found);
        let scale = frame.position.norm() + reach(&a) + reach(&b);
        prop_assert!(said <= reference_gap(&a, &b, &frame) + 1e-12 * scale);
        prop_assert!(found.is_empty() || said == f64::NEG_INFINITY);
    }

    #[test]
    fn nothing_is_found_beyond_the_margin_and_all_within(
        a in shapes(), b in shapes(), frame in frames(3.0), margin in 0.0..1.0,
    ) {
        let (a, b) = (one(a), one(b));
        let expected = reference_gap(&a, &b, &frame);
        let found = manifolds(&a, &b, &frame, margin);
        prop_assume!((expected - margin).abs() > 1e-9);
        prop_assert_eq!(found.len(), usize::from(expected < margin));
        for m in &found {
            for i in 0..m.count {
                prop_assert!(gap(m, &frame, i) <= margin + 1e-12);
                prop_assert!((normal(m, &frame, i).norm() - 1.0).abs() < 1e-15 * 10.0);
            }
        }
    }
}
