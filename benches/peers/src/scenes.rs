//! The scenes. Those of Box2D's benchmark keep its numbers (`shared/benchmarks.c`
//! of Box2D 3.2), with two differences: friction is 0.6 everywhere, and the tumbler's frame turns by
//! itself instead of by a motor. The pentagons of the junkyard are regular.

mod jointed;

use std::f64::consts::{PI, TAU};

use culbuto::body::BodyKind;
use culbuto::math::{Real, Rot, Vec2, vec2};

use crate::scene::{Body, Region, Scene, Shape, Swing};

/// 25° a second.
const DRUM: Real = 25.0 * PI / 180.0;

/// All scenes, the quick ones first.
pub fn all() -> Vec<Scene> {
    vec![
        stack(10),
        jointed::chain(),
        jointed::rope(),
        pyramid(20),
        circles(1000),
        circles(5000),
        large_pyramid(),
        jointed::ragdolls(),
        tumbler(),
        jointed::joint_grid(),
        junkyard(),
        compounds(),
        smash(),
        washer(),
        many_pyramids(),
    ]
}

fn scene(name: &'static str, about: &'static str, bodies: Vec<Body>) -> Scene {
    Scene {
        name,
        about,
        bodies,
        joints: Vec::new(),
        gravity: vec2(0.0, -10.0),
        friction: 0.6,
        restitution: 0.0,
        dt: 1.0 / 60.0,
        substeps: 4,
        iterations: 10,
        steps: 500,
        sleeping: true,
        swing: None,
        region: Region::Above(0.0),
        size: None,
    }
}

/// `n` as a length or a number of lengths.
fn real(n: u32) -> Real {
    Real::from(n)
}

fn floor(half_width: Real) -> Body {
    let shape = Shape::Box { center: vec2(0.0, -1.0), half: vec2(half_width, 1.0) };
    Body::ground(vec![shape])
}

fn stack(levels: u32) -> Scene {
    let square = |i| Body::new(vec2(0.0, real(i) + 0.5), vec![Shape::rectangle(0.5, 0.5)]);
    let bodies = std::iter::once(floor(20.0)).chain((0..levels).map(square)).collect();
    Scene { sleeping: false, ..scene("stack_10", "10 unit squares, one on the other", bodies) }
}

/// Unit squares, `base` in the lowest row, one fewer in each above; the middle of its foot at `foot`.
fn squares(base: u32, foot: Vec2) -> impl Iterator<Item = Body> {
    (0..base).flat_map(move |row| {
        (0..base - row).map(move |i| {
            let x = real(i) + 0.5 * real(row) + 0.5 - 0.5 * real(base);
            Body::new(foot + vec2(x, real(row) + 0.5), vec![Shape::rectangle(0.5, 0.5)])
        })
    })
}

fn pyramid(base: u32) -> Scene {
    let bodies = std::iter::once(floor(50.0)).chain(squares(base, vec2(0.0, 0.0))).collect();
    Scene { sleeping: false, ..scene("pyramid_20", "a pyramid of unit squares, base 20", bodies) }
}

fn large_pyramid() -> Scene {
    let bodies = std::iter::once(floor(100.0)).chain(squares(100, vec2(0.0, 0.0))).collect();
    let about = "a pyramid of 5050 unit squares, base 100";
    Scene { sleeping: false, ..scene("large_pyramid", about, bodies) }
}

fn many_pyramids() -> Scene {
    let (rows, columns, pitch) = (20, 20, 11.0);
    let half_width = 0.5 * real(columns) * pitch;
    let line = |row| {
        let y = pitch * real(row);
        Shape::Segment { a: vec2(-half_width, y), b: vec2(half_width, y) }
    };
    let mut bodies = vec![Body::ground((0..rows).map(line).collect())];
    for row in 0..rows {
        for column in 0..columns {
            let x = pitch * (real(column) + 0.5) - half_width;
            bodies.extend(squares(10, vec2(x, pitch * real(row))));
        }
    }
    let about = "20 × 20 pyramids of base 10 on 20 lines";
    Scene { sleeping: false, steps: 200, ..scene("many_pyramids", about, bodies) }
}

/// Disks above a bin, every other row shifted by a quarter of a radius, 50 in a row.
fn circles(count: u32) -> Scene {
    let (radius, in_row, pitch) = (0.5, 50, 1.1);
    let half = 0.5 * pitch * real(in_row) + radius;
    let wall = |x| Shape::Box { center: vec2(x, 100.0), half: vec2(1.0, 101.0) };
    let mut ground = floor(half + 2.0);
    ground.shapes.extend([wall(-half - 1.0), wall(half + 1.0)]);
    let disk = |i: u32| {
        let (row, column) = (i / in_row, i % in_row);
        let shift = if row % 2 == 0 { 0.25 } else { -0.25 } * radius;
        let x = pitch * (real(column) + 0.5 - 0.5 * real(in_row)) + shift;
        Body::new(vec2(x, 2.0 + pitch * real(row)), vec![Shape::disk(radius)])
    };
    let bodies = std::iter::once(ground).chain((0..count).map(disk)).collect();
    let (name, about) = match count {
        1000 => ("circles_1000", "1000 disks falling into a bin"),
        _ => ("circles_5000", "5000 disks falling into a bin"),
    };
    Scene { sleeping: false, ..scene(name, about, bodies) }
}

/// Floor and walls of unit tiles that reach a little into one another.
fn tiles(half_width: u32, height: u32) -> Body {
    let x = real(half_width);
    let low = (0..=2 * half_width)
        .map(|i| Shape::Box { center: vec2(real(i) - x, 0.0), half: vec2(0.55, 0.5) });
    let wall = move |x: Real| {
        (1..=height).map(move |i| Shape::Box { center: vec2(x, real(i)), half: vec2(0.5, 0.55) })
    };
    Body::ground(low.chain(wall(-x)).chain(wall(x)).collect())
}

fn compounds() -> Scene {
    let triangle = |corners: [(Real, Real); 3]| Shape::Polygon {
        vertices: corners.map(|(x, y)| vec2(x, y)).to_vec(),
    };
    let shapes = [
        triangle([(-1.0, 0.0), (0.5, 1.0), (0.0, 2.0)]),
        triangle([(1.0, 0.0), (0.0, 2.0), (-0.5, 1.0)]),
    ];
    let mut ground = tiles(40, 100);
    ground.shapes.push(Shape::Segment { a: vec2(-800.0, -80.0), b: vec2(800.0, -80.0) });
    let mut bodies = vec![ground];
    let mut side = 0.25;
    for column in 0..20 {
        for row in 0..150 {
            let place = vec2(2.0 * real(column) - 19.0 + side, 2.25 * real(row) + 5.575);
            bodies.push(Body::new(place, shapes.to_vec()));
            side = -side;
        }
    }
    scene("compounds", "3000 arrowheads of two triangles each, falling into a tiled bin", bodies)
}

fn junkyard() -> Scene {
    let radius = 0.25;
    let pentagon: Vec<Vec2> =
        (0..5).map(|i| Rot::new(TAU * real(i) / 5.0).apply(vec2(radius, 0.0))).collect();
    let mut bodies = vec![tiles(80, 50)];
    let mut side = -0.1;
    for column in 0..200 {
        for row in 0..40 {
            let x = 1.5 * (2.0 * real(column) - 200.0) * radius + side;
            let place = vec2(x, 4.0 * real(row) * radius + 15.0);
            bodies.push(Body::new(place, vec![Shape::Polygon { vertices: pentagon.clone() }]));
            side = -side;
        }
    }
    let pusher = Shape::Box { center: vec2(0.0, 4.0), half: vec2(2.0, 4.0) };
    let pusher = Body { kind: BodyKind::Kinematic, ..Body::new(vec2(0.0, 0.0), vec![pusher]) };
    bodies.push(pusher);
    let swing = Swing { body: bodies.len() - 1, amplitude: vec2(60.0, 0.0), rate: 0.2 };
    let about = "8000 pentagons in a tiled bin, and a box that pushes through them";
    Scene { steps: 800, swing: Some(swing), ..scene("junkyard", about, bodies) }
}

fn smash() -> Scene {
    let mut bodies = vec![Body {
        velocity: vec2(40.0, 0.0),
        density: 8.0,
        ..Body::new(vec2(-20.0, 0.0), vec![Shape::rectangle(4.0, 4.0)])
    }];
    let width = 0.4;
    for column in 0..120 {
        for row in 0..80 {
            let place = vec2(width * real(column) + 30.0, width * (real(row) - 40.0));
            let square = vec![Shape::rectangle(0.5 * width, 0.5 * width)];
            bodies.push(Body { asleep: true, ..Body::new(place, square) });
        }
    }
    let about = "a heavy box at 40 m/s hits 9600 sleeping squares, without gravity";
    let (gravity, region) = (vec2(0.0, 0.0), Region::Everywhere);
    Scene { gravity, region, steps: 300, ..scene("smash", about, bodies) }
}

/// A kinematic body that turns about (0, 10), and what is inside: all that is less than `reach` away.
fn drum(shapes: Vec<Shape>, reach: Real) -> (Vec<Body>, Region) {
    let center = vec2(0.0, 10.0);
    let (kind, angular_velocity) = (BodyKind::Kinematic, DRUM);
    let drum = Body { kind, angular_velocity, ..Body::new(center, shapes) };
    (vec![drum], Region::Disk { center, radius: reach })
}

/// `n` × `n` squares of half width `half`, `pitch` apart, the first at `first`.
fn grid(n: u32, half: Real, pitch: Real, first: Vec2) -> impl Iterator<Item = Body> {
    (0..n * n).map(move |i| {
        let place = first + vec2(real(i % n), real(i / n)) * pitch;
        Body::new(place, vec![Shape::rectangle(half, half)])
    })
}

fn tumbler() -> Scene {
    let side = |x: Real, y: Real, half: Vec2| Shape::Box { center: vec2(x, y), half };
    let (upright, level) = (vec2(0.5, 10.0), vec2(10.0, 0.5));
    let frame = vec![
        side(10.0, 0.0, upright),
        side(-10.0, 0.0, upright),
        side(0.0, 10.0, level),
        side(0.0, -10.0, level),
    ];
    let (mut bodies, region) = drum(frame, 9.5 * Real::sqrt(2.0));
    bodies.extend(grid(45, 0.125, 0.4, vec2(-9.0, 1.0)));
    let about = "2025 squares in a box that turns at 25° a second";
    Scene { steps: 750, region, ..scene("tumbler", about, bodies) }
}

fn washer() -> Scene {
    let tooth = PI / 18.0;
    // A wedge of the ring between two radii; neighbours overlap by `more` at each end.
    let wedge = |i: u32, inner: Real, outer: Real, more: Real| {
        let (low, high) = (Rot::new(tooth * real(i) - more), Rot::new(tooth * real(i + 1) + more));
        let corner = |turn: Rot, radius: Real| turn.apply(vec2(radius, 0.0));
        let vertices =
            vec![corner(low, inner), corner(low, outer), corner(high, outer), corner(high, inner)];
        Shape::Polygon { vertices }
    };
    let ring = (0..36).map(|i| wedge(i, 16.0, 18.0, 0.1 * tooth));
    let blades = (0..36).step_by(9).map(|i| wedge(i, 14.0, 16.0, 0.0));
    let (mut bodies, region) = drum(ring.chain(blades).collect(), 17.0);
    bodies.extend(grid(90, 0.1, 0.21, vec2(-9.9, 0.1)));
    let about = "8100 squares in a ring with four blades that turns at 25° a second";
    Scene { region, ..scene("washer", about, bodies) }
}
