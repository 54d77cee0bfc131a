//! Area, centroid, second moment of polygons, and sums of parts (S18, X4).

use culbuto::math::{Real, Rot, Vec2, vec2};
use culbuto::shapes::{MassProperties, Shape};
use proptest::prelude::*;

use crate::common::{Exact, Grid, assert_close, assert_near, outline_and_holes, polygons};

const EPS: Real = Real::EPSILON;

/// All roundings together: of the sums' results, of their scaling, and of the reference's two
/// quotients.
const LAST_DIGITS: Real = 8.0 * EPS;

fn shape_of(grid: &Grid, offset: [i64; 2]) -> Shape {
    let (outline, holes) = outline_and_holes(grid, offset);
    Shape::polygon_with_holes(&outline, &holes).unwrap()
}

#[track_caller]
fn assert_exact(shape: &Shape, grid: &Grid, offset: [i64; 2]) {
    let exact = Exact::of(grid);
    let [x, y] = grid[0][0];
    let first = vec2((x + offset[0]) as Real, (y + offset[1]) as Real);
    assert_close(shape.area(), exact.area, LAST_DIGITS);
    assert_close(shape.second_moment(), exact.second_moment, LAST_DIGITS);
    // The position is rounded once, relative to where it is.
    let reach = first.amax() + exact.centroid.amax();
    assert_near(shape.centroid(), first + exact.centroid, 4.0 * EPS * reach);
}

#[test]
fn known_shapes_have_their_rational_measures() {
    let square =
        Shape::polygon(&[vec2(0.0, 0.0), vec2(1.0, 0.0), vec2(1.0, 1.0), vec2(0.0, 1.0)]).unwrap();
    assert_eq!((square.area(), square.perimeter(), square.centroid()), (1.0, 4.0, vec2(0.5, 0.5)));
    assert_close(square.second_moment(), 1.0 / 6.0, EPS);

    // Two unit squares side by side and one on the left one: c = (5/6, 5/6), J = 3·1/6 + Σ d² = 1/2
    // + 4/3.
    let ell: Grid = vec![vec![[0, 0], [2, 0], [2, 1], [1, 1], [1, 2], [0, 2]]];
    let shape = shape_of(&ell, [0, 0]);
    assert_eq!((shape.area(), shape.perimeter()), (3.0, 8.0));
    assert_near(shape.centroid(), vec2(5.0 / 6.0, 5.0 / 6.0), EPS);
    assert_close(shape.second_moment(), 11.0 / 6.0, 2.0 * EPS);

    // A frame: 3² − 1², J = (3⁴ − 1)/6.
    let frame: Grid =
        vec![vec![[0, 0], [3, 0], [3, 3], [0, 3]], vec![[1, 1], [1, 2], [2, 2], [2, 1]]];
    let shape = shape_of(&frame, [0, 0]);
    assert_eq!((shape.area(), shape.perimeter(), shape.centroid()), (8.0, 16.0, vec2(1.5, 1.5)));
    assert_close(shape.second_moment(), 80.0 / 6.0, EPS);
}

proptest! {
    #[test]
    fn polygons_have_the_measures_of_exact_arithmetic_wherever_they_are(
        grid in polygons(),
        offset in prop_oneof![Just([0, 0]), prop::array::uniform2(-1_000_000..1_000_000_i64),
            prop::array::uniform2(-1_000_000_000_000..1_000_000_000_000_i64)],
    ) {
        assert_exact(&shape_of(&grid, offset), &grid, offset);
    }

    #[test]
    fn needles_turned_on_a_grid_have_the_measures_of_exact_arithmetic(turn in 0.0..6.3) {
        // 2²⁶ long and 64 wide: 1e6:1, its corners rounded to the grid.
        let (sin, cos) = Real::sin_cos(turn);
        let corner = |x: Real, y: Real| [(cos * x - sin * y).round() as i64, (sin * x + cos * y).round() as i64];
        let (l, w) = (67_108_864.0, 64.0);
        let grid = vec![vec![corner(0.0, 0.0), corner(l, 0.0), corner(l, w), corner(0.0, w)]];
        for offset in [[0, 0], [123_456_789_012, -98_765_432_101]] {
            assert_exact(&shape_of(&grid, offset), &grid, offset);
        }
    }

    #[test]
    fn needles_keep_their_measures_when_turned(turn in 0.0..6.3) {
        let rot = Rot::new(turn);
        let (l, w) = (1.0, 1e-6);
        let corners = [vec2(0.0, 0.0), vec2(l, 0.0), vec2(l, w), vec2(0.0, w)].map(|p| rot.apply(p));
        let needle = Shape::polygon(&corners).unwrap();
        // A corner is off by 2ε; the width feels it a million times.
        assert_close(needle.area(), l * w, 1e-9);
        assert_close(needle.second_moment(), l * w * (l * l + w * w) / 12.0, 1e-9);
    }

    #[test]
    fn thin_triangles_keep_their_measures(turn in 0.0..6.3, angle in 1e-4..1e-2) {
        let rot = Rot::new(turn);
        let (tip, a, b) = (vec2(0.0, 0.0), vec2(1.0, 0.0), Rot::new(angle).apply(vec2(1.0, 0.0)));
        let triangle = Shape::polygon(&[tip, a, b].map(|p| rot.apply(p))).unwrap();
        let area = angle.sin() / 2.0;
        // A corner is off by 2ε, as seen from the side opposite at least 1e-4 long.
        assert_close(triangle.area(), area, 8.0 * EPS / angle);
        // J = A (a² + b² + c²)/36, the sides 1, 1 and √(2 − 2 cos).
        let sides = 2.0 + (2.0 - 2.0 * angle.cos());
        assert_close(triangle.second_moment(), area * sides / 36.0, 16.0 * EPS / angle);
    }

    #[test]
    fn measures_do_not_depend_on_turning(grid in polygons(), turn in 0.0..6.3) {
        let rot = Rot::new(turn);
        let (outline, holes) = outline_and_holes(&grid, [0, 0]);
        let turned = |ring: &Vec<Vec2>| ring.iter().map(|&p| rot.apply(p)).collect::<Vec<_>>();
        let before = Shape::polygon_with_holes(&outline, &holes).unwrap();
        let after =
            Shape::polygon_with_holes(&turned(&outline), &holes.iter().map(turned).collect::<Vec<_>>()).unwrap();
        // Each vertex is off by 2ε of its distance R: the area by that times the perimeter, the
        // moment by R² times that.
        let reach = outline.iter().map(Vec2::norm).fold(0.0, Real::max);
        let strip = 2.0 * EPS * reach * before.perimeter() + 4.0 * EPS * before.area();
        assert!((after.area() - before.area()).abs() <= strip);
        assert!((after.second_moment() - before.second_moment()).abs() <= 4.0 * reach * reach * strip);
        assert_near(after.centroid(), rot.apply(before.centroid()), 4.0 * reach * strip / before.area());
    }

    #[test]
    fn measures_do_not_depend_on_mirroring_start_or_direction(grid in polygons(), start in 0..20_usize) {
        let (outline, holes) = outline_and_holes(&grid, [0, 0]);
        let shape = Shape::polygon_with_holes(&outline, &holes).unwrap();
        let same = |outline: &[Vec2], holes: &[Vec<Vec2>], sign: Real| {
            let other = Shape::polygon_with_holes(outline, holes).unwrap();
            assert_close(other.area(), shape.area(), LAST_DIGITS);
            assert_close(other.second_moment(), shape.second_moment(), LAST_DIGITS);
            let centroid = vec2(sign * other.centroid().x, other.centroid().y);
            assert_near(centroid, shape.centroid(), 32.0 * EPS * shape.extent_from(vec2(0.0, 0.0)));
        };
        let mut other = outline.clone();
        other.rotate_left(start % outline.len());
        same(&other, &holes, 1.0);
        other.reverse();
        same(&other, &holes, 1.0);
        let mirror = |ring: &Vec<Vec2>| ring.iter().map(|p| vec2(-p.x, p.y)).collect::<Vec<_>>();
        same(&mirror(&outline), &holes.iter().map(mirror).collect::<Vec<_>>(), -1.0);
    }

    #[test]
    fn the_two_sides_of_a_cut_make_the_whole_again(
        radii in prop::collection::vec(0.5..2.0, 6..16), cut in 2..4_usize, density in 1e-3..1e4,
        offset in prop::array::uniform2(-1e6..1e6),
    ) {
        // A star is cut by a diagonal through its centre, from the first vertex to another.
        let step = std::f64::consts::TAU / radii.len() as Real;
        let vertex = |(i, r): (usize, &Real)| Rot::new(step * i as Real).apply(vec2(*r, 0.0)) + Vec2::from(offset);
        let star: Vec<Vec2> = radii.iter().enumerate().map(vertex).collect();
        let center = Vec2::from(offset);
        let mut first = star[..=cut].to_vec();
        first.push(center);
        let mut second = star[cut..].to_vec();
        second.extend([star[0], center]);
        let part = |ring: &[Vec2]| Shape::polygon(ring).unwrap().mass_properties(density);
        let (whole, sum) = (part(&star), MassProperties::combine([part(&first), part(&second)]));
        assert_close(sum.mass, whole.mass, 8.0 * EPS);
        // Centres are known to an ulp of 1e6 where they are.
        let ulp = EPS * 1e6;
        assert_near(sum.center, whole.center, 4.0 * ulp);
        assert!((sum.inertia - whole.inertia).abs() <= 16.0 * EPS * whole.inertia + 16.0 * ulp * whole.mass);
    }

    #[test]
    fn scaling_by_a_power_of_two_changes_no_digit(grid in polygons(), power in -200..200_i32) {
        let scale = Real::powi(2.0, power);
        let (outline, holes) = outline_and_holes(&grid, [0, 0]);
        let scaled = |ring: &Vec<Vec2>| ring.iter().map(|p| p * scale).collect::<Vec<_>>();
        let small = Shape::polygon_with_holes(&outline, &holes).unwrap();
        let large =
            Shape::polygon_with_holes(&scaled(&outline), &holes.iter().map(scaled).collect::<Vec<_>>()).unwrap();
        assert_eq!(large.area(), small.area() * scale * scale);
        assert_eq!(large.second_moment(), small.second_moment() * scale * scale * scale * scale);
        assert_eq!(large.centroid(), small.centroid() * scale);
    }
}

#[test]
fn corners_of_unlike_size_keep_their_differences() {
    // Seen from the first corner, one far corner rounds up and the other down: half a per cent of
    // the area.
    let far = 1_i64 << 54;
    let corners = [[1, 0], [far, far], [far - 254, far + 256]];
    let arm = |i: usize| {
        [i128::from(corners[i][0] - corners[0][0]), i128::from(corners[i][1] - corners[0][1])]
    };
    let [a, b] = [arm(1), arm(2)];
    let exact = (a[0] * b[1] - a[1] * b[0]) as Real / 2.0;
    let triangle = Shape::polygon(&corners.map(|[x, y]| vec2(x as Real, y as Real))).unwrap();
    assert_close(triangle.area(), exact, LAST_DIGITS);
}

#[test]
fn small_and_large_shapes_keep_their_digits() {
    for scale in [1e-60, 1e-3, 1e6, 1e60] {
        let square = Shape::rectangle(scale, scale).unwrap();
        let same = Shape::polygon(
            &[(0.0, 0.0), (scale, 0.0), (scale, scale), (0.0, scale)].map(|(x, y)| vec2(x, y)),
        );
        assert_close(same.unwrap().second_moment(), square.second_moment(), LAST_DIGITS);
        assert_close(square.second_moment(), scale.powi(4) / 6.0, LAST_DIGITS);
    }
}

#[test]
fn nothing_weighs_nothing_and_one_part_is_itself() {
    assert_eq!(MassProperties::combine([]), MassProperties::ZERO);
    let part = MassProperties { mass: 2.0, center: vec2(3.0, 4.0), inertia: 5.0 };
    assert_eq!(MassProperties::combine([part]), part);
    assert_eq!(part.about(vec2(0.0, 0.0)), 55.0);
}

#[test]
fn two_point_masses_have_the_inertia_of_a_dumbbell() {
    let at = |x: Real| MassProperties { mass: 1.0, center: vec2(x, 1e6), inertia: 0.0 };
    let dumbbell = MassProperties::combine([at(-3.0), at(3.0)]);
    assert_eq!(dumbbell, MassProperties { mass: 2.0, center: vec2(0.0, 1e6), inertia: 18.0 });
}
