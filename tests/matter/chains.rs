//! Chains as matter: what they are made of is their segments.

use culbuto::math::{Real, Vec2, vec2};
use culbuto::shapes::{MassProperties, Shape, Silhouette};
use proptest::prelude::*;

use crate::common::{assert_close, assert_near};

proptest! {
    #[test]
    fn a_chain_is_its_segments_together(
        points in prop::collection::vec((-5.0..5.0, -5.0..5.0), 3..12), closed in any::<bool>(),
        density in 0.1..10.0, direction in (-1.0..1.0, 0.1..1.0_f64),
    ) {
        let points: Vec<Vec2> = points.into_iter().map(|(x, y)| vec2(x, y)).collect();
        let chain = Shape::chain(&points, closed).unwrap();
        let mut ends = points.clone();
        if closed {
            ends.push(points[0]);
        }
        let links: Vec<Shape> = ends.windows(2).map(|p| Shape::segment(p[0], p[1]).unwrap()).collect();
        let expected = MassProperties::combine(links.iter().map(|link| link.mass_properties(density)));
        let got = chain.mass_properties(density);
        assert_close(got.mass, expected.mass, 1e-14);
        assert_near(got.center, expected.center, 1e-13);
        assert_close(got.inertia, expected.inertia, 1e-13);
        assert_close(chain.perimeter(), expected.mass / density, 1e-14);

        let bounds = links.iter().map(Shape::bounds).reduce(|a, b| a.merged(&b)).unwrap();
        prop_assert_eq!(chain.bounds(), bounds);
        let farthest = points.iter().map(Vec2::norm).fold(0.0, Real::max);
        prop_assert_eq!(chain.extent_from(vec2(0.0, 0.0)), farthest);
        prop_assert!(chain.is_wire() && chain.area() == 0.0 && !chain.contains(points[0]));
        prop_assert!(chain.convex_pieces().is_empty());
        let outline = chain.outline(0.1);
        prop_assert_eq!((&outline[0].points, outline[0].closed), (&points, closed));

        let direction = vec2(direction.0, direction.1);
        let separate = Silhouette::new(&links.iter().collect::<Vec<_>>());
        let whole = Silhouette::new(&[&chain]);
        let (a, b) = (whole.width_across(direction), separate.width_across(direction));
        prop_assert!((a - b).abs() <= 1e-12);
    }
}

#[test]
fn far_from_the_origin_a_chain_keeps_its_digits() {
    let corners = [(0.0, 0.0), (1.0, 0.0), (1.0, 2.0)].map(|(x, y)| vec2(x, y));
    let near = Shape::chain(&corners, true).unwrap();
    let moved = corners.map(|p| p + vec2(1e9, -4e8));
    let far = Shape::chain(&moved, true).unwrap();
    assert_eq!(far.second_moment(), near.second_moment());
    assert_eq!(far.measure(), near.measure());
}
