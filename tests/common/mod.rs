//! What several tests share: random simple polygons on the integer grid, and exact answers for
//! them.

use culbuto::math::{Real, Vec2, vec2};
use proptest::prelude::*;

/// A polygon on the integer grid: outline counter-clockwise, holes clockwise.
pub type Grid = Vec<Vec<[i64; 2]>>;

/// Star-shaped outlines with random radii, some with a star-shaped hole; combs; L-shapes; all
/// sheared. Coordinates stay below 2¹⁷, so that [`Exact`] fits its integers.
pub fn polygons() -> impl Strategy<Value = Grid> {
    let outline = prop::collection::vec(2_000..15_000_i64, 5..20);
    let hole = prop::option::of(prop::collection::vec(50..400_i64, 3..8));
    let star = (outline, hole).prop_map(|(outline, hole)| {
        let mut rings = vec![star(&outline)];
        rings.extend(hole.map(|hole| star(&hole).into_iter().rev().collect()));
        rings
    });
    let comb =
        prop::collection::vec((1..50_i64, 1..50_i64, 2..900_i64), 1..12).prop_map(|t| comb(&t));
    let ell = (2..900_i64, 2..900_i64).prop_flat_map(|(w, h)| {
        (1..w, 1..h)
            .prop_map(move |(x, y)| vec![vec![[0, 0], [w, 0], [w, y], [x, y], [x, h], [0, h]]])
    });
    (prop_oneof![star, comb, ell], -3..=3_i64).prop_map(|(rings, shear)| {
        let sheared =
            |ring: Vec<[i64; 2]>| ring.into_iter().map(|[x, y]| [x + shear * y, y]).collect();
        rings.into_iter().map(sheared).collect()
    })
}

fn star(radii: &[i64]) -> Vec<[i64; 2]> {
    let step = std::f64::consts::TAU / radii.len() as f64;
    let vertex = |(i, &r): (usize, &i64)| {
        let (sin, cos) = (step * i as f64).sin_cos();
        [(r as f64 * cos).round() as i64, (r as f64 * sin).round() as i64]
    };
    radii.iter().enumerate().map(vertex).collect()
}

/// A comb of teeth (gap, width, height) on a bar.
fn comb(teeth: &[(i64, i64, i64)]) -> Grid {
    let mut top = vec![[0, 1]];
    let mut x = 0;
    for &(gap, width, height) in teeth {
        top.extend([
            [x + gap, 1],
            [x + gap, height],
            [x + gap + width, height],
            [x + gap + width, 1],
        ]);
        x += gap + width;
    }
    top.extend([[x + 1, 1], [x + 1, 0], [0, 0]]);
    top.reverse();
    vec![top]
}

/// The vertices as the engine takes them, moved by an integer offset.
pub fn points(ring: &[[i64; 2]], offset: [i64; 2]) -> Vec<Vec2> {
    ring.iter().map(|[x, y]| vec2((x + offset[0]) as Real, (y + offset[1]) as Real)).collect()
}

/// Outline and holes as the engine takes them, moved.
pub fn outline_and_holes(grid: &Grid, offset: [i64; 2]) -> (Vec<Vec2>, Vec<Vec<Vec2>>) {
    let mut rings = grid.iter().map(|ring| points(ring, offset));
    let outline = rings.next().unwrap();
    (outline, rings.collect())
}

/// Area, centroid and second moment of a grid polygon in exact rational arithmetic, rounded at the
/// very end.
pub struct Exact {
    /// Twice the area.
    pub doubled_area: i128,
    pub area: Real,
    /// Relative to the first vertex of the outline.
    pub centroid: Vec2,
    pub second_moment: Real,
}

impl Exact {
    pub fn of(grid: &Grid) -> Self {
        let [ox, oy] = grid[0][0];
        let (mut k_sum, mut sx, mut sy, mut j) = (0_i128, 0_i128, 0_i128, 0_i128);
        for ring in grid {
            for (i, &[ax, ay]) in ring.iter().enumerate() {
                let [bx, by] = ring[(i + 1) % ring.len()];
                let [ax, bx] = [ax, bx].map(|x| i128::from(x - ox));
                let [ay, by] = [ay, by].map(|y| i128::from(y - oy));
                let k = ax * by - ay * bx;
                k_sum += k;
                sx += k * (ax + bx);
                sy += k * (ay + by);
                j += k * (ax * ax + ax * bx + bx * bx + ay * ay + ay * by + by * by);
            }
        }
        // c = s/(3k), J = j/12 − (k/2)|c|² = (3 k j − 2 s·s)/(36 k)
        let ratio = |a: i128, b: i128| a as Real / b as Real;
        Self {
            doubled_area: k_sum,
            area: k_sum as Real / 2.0,
            centroid: vec2(ratio(sx, 3 * k_sum), ratio(sy, 3 * k_sum)),
            second_moment: ratio(3 * k_sum * j - 2 * (sx * sx + sy * sy), 36 * k_sum),
        }
    }
}

/// |a − b| ≤ tolerance · |b|.
#[track_caller]
pub fn assert_close(a: Real, b: Real, tolerance: Real) {
    assert!((a - b).abs() <= tolerance * b.abs(), "{a:e} is not {b:e} to {tolerance:e}");
}

/// |a − b| ≤ tolerance.
#[track_caller]
pub fn assert_near(a: Vec2, b: Vec2, tolerance: Real) {
    assert!((a - b).norm() <= tolerance, "{a:?} is not {b:?} to {tolerance:e}");
}
