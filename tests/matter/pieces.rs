//! Convex decomposition.

use culbuto::math::{Real, Vec2, cross, vec2};
use culbuto::shapes::Shape;
use proptest::prelude::*;

use crate::common::{Exact, outline_and_holes, polygons};

fn as_grid(p: &Vec2, scale: Real, offset: [i64; 2]) -> [i64; 2] {
    [(p.x / scale) as i64 - offset[0], (p.y / scale) as i64 - offset[1]]
}

proptest! {
    #[test]
    fn pieces_are_convex_and_cover_the_polygon_exactly(
        grid in polygons(),
        offset in prop_oneof![Just([0, 0]), prop::array::uniform2(-1_000_000_000_000..1_000_000_000_000_i64)],
        power in prop_oneof![Just(0), -180..180_i32],
        samples in prop::collection::vec(prop::array::uniform2(-16_000..16_000_i64), 40),
    ) {
        let scale = Real::powi(2.0, power);
        let (outline, holes) = outline_and_holes(&grid, offset);
        let scaled = |ring: &Vec<Vec2>| ring.iter().map(|p| p * scale).collect::<Vec<_>>();
        let shape =
            Shape::polygon_with_holes(&scaled(&outline), &holes.iter().map(scaled).collect::<Vec<_>>()).unwrap();
        let back: Vec<Vec<[i64; 2]>> = shape
            .convex_pieces()
            .iter()
            .map(|piece| piece.iter().map(|p| as_grid(p, scale, offset)).collect())
            .collect();

        // In integers, hence exactly: every piece turns left at every vertex, and the areas add up.
        let doubled: i128 = back.iter().map(|piece| Exact::of(&vec![piece.clone()]).doubled_area).sum();
        prop_assert_eq!(doubled, Exact::of(&grid).doubled_area);
        for piece in &back {
            let n = piece.len();
            for i in 0..n {
                let [a, b, c] = [piece[i], piece[(i + 1) % n], piece[(i + 2) % n]];
                let turn = (b[0] - a[0]) * (c[1] - b[1]) - (b[1] - a[1]) * (c[0] - b[0]);
                prop_assert!(turn > 0);
                prop_assert!(grid.iter().flatten().any(|&v| v == b));
            }
        }

        // A point is in the polygon exactly when it is in a piece; with the areas, the pieces
        // cannot overlap.
        for sample in samples {
            let p = vec2((sample[0] + offset[0]) as Real, (sample[1] + offset[1]) as Real) * scale;
            let within = |piece: &Vec<[i64; 2]>| {
                (0..piece.len()).all(|i| {
                    let (a, b) = (piece[i], piece[(i + 1) % piece.len()]);
                    (b[0] - a[0]) * (sample[1] - a[1]) - (b[1] - a[1]) * (sample[0] - a[0]) >= 0
                })
            };
            prop_assert_eq!(shape.contains(p), back.iter().any(within));
        }
    }
}

#[test]
fn merging_leaves_few_pieces() {
    let v = vec2;
    let ell = [v(0.0, 0.0), v(2.0, 0.0), v(2.0, 1.0), v(1.0, 1.0), v(1.0, 2.0), v(0.0, 2.0)];
    assert_eq!(Shape::polygon(&ell).unwrap().convex_pieces().len(), 2);
    // Every reflex corner needs at most one cut to be mended, but Hertel and Mehlhorn may keep two.
    let comb: Vec<Vec2> = (0..40)
        .flat_map(|i| [v(f64::from(2 * i), 9.0), v(f64::from(2 * i) + 1.0, 1.0)])
        .chain([v(79.0, 0.0), v(0.0, 0.0)])
        .collect();
    let pieces = Shape::polygon(&comb).unwrap();
    assert!(pieces.convex_pieces().len() <= 2 * 39 + 1);
}

#[test]
fn convex_polygons_are_one_piece_and_round_shapes_none() {
    let square = Shape::rectangle(1.0, 2.0).unwrap();
    assert_eq!(square.convex_pieces(), [square.outline(1.0)[0].points.clone()]);
    let rounded = Shape::rounded_polygon(&square.convex_pieces()[0], 0.1).unwrap();
    assert_eq!((rounded.convex_pieces(), rounded.rounding()), (square.convex_pieces(), 0.1));
    assert!(Shape::circle(1.0).unwrap().convex_pieces().is_empty());
    assert!(Shape::segment(vec2(0.0, 0.0), vec2(1.0, 0.0)).unwrap().convex_pieces().is_empty());
}

#[test]
fn pieces_of_thin_and_noisy_outlines_are_convex() {
    // A spiral of thin arms, coordinates of full precision, far from the origin.
    for offset in [0.0, 1e6, -1e9] {
        let arm = |k: i32, r: Real| {
            let turn = culbuto::math::Rot::new(Real::from(k) * 0.1);
            turn.apply(vec2(r + Real::from(k) * 0.03, 0.0)) + vec2(offset, -offset)
        };
        let spiral: Vec<Vec2> =
            (0..200).map(|k| arm(k, 1.0)).chain((0..200).rev().map(|k| arm(k, 0.9))).collect();
        let shape = Shape::polygon(&spiral).unwrap();
        let area: Real =
            shape.convex_pieces().iter().map(|piece| Shape::polygon(piece).unwrap().area()).sum();
        assert!((area - shape.area()).abs() < 1e-13 * area);
        for piece in shape.convex_pieces() {
            let n = piece.len();
            let turn =
                |i: usize| cross(piece[(i + 1) % n] - piece[i], piece[(i + 2) % n] - piece[i]);
            assert!((0..n).all(|i| turn(i) > 0.0));
        }
    }
}
