//! Boxes, and how long they take.

use std::hint::black_box;
use std::time::Instant;

use culbuto::collision::{Normal, collide};
use culbuto::math::vec2;
use culbuto::shapes::Shape;

use crate::common::{at, gap, manifolds, one};

#[test]
fn a_box_on_another_has_two_points_on_the_lower_face() {
    let (a, b) =
        (one(Shape::rectangle(2.0, 1.0).unwrap()), one(Shape::rectangle(1.0, 1.0).unwrap()));
    let frame = at(0.9, 1.01, 0.0);
    let [m] = manifolds(&a, &b, &frame, 0.1)[..] else { panic!("one manifold") };
    assert_eq!(m.normal, Normal::OnA(vec2(0.0, 1.0)));
    assert_eq!(m.count, 2);
    assert_eq!(m.face, [-1.0, 1.0]);
    let mut feet = m.anchors.map(|anchor| anchor.on_a.x);
    feet.sort_by(f64::total_cmp);
    for (foot, expected) in feet.into_iter().zip([0.4, 1.0]) {
        assert!((foot - expected).abs() < 1e-14, "{foot}");
    }
    for point in 0..2 {
        assert!((gap(&m, &frame, point) - 0.01).abs() < 1e-15);
        assert_eq!(m.anchors[point].on_a.y, 0.5);
    }
    assert_ne!(m.anchors[0].feature, m.anchors[1].feature);
}

#[test]
#[ignore = "a measurement: cargo test --release --test collision time -- --ignored --nocapture"]
#[allow(clippy::print_stdout)]
fn time() {
    let square = one(Shape::rectangle(1.0, 1.0).unwrap());
    let disk = one(Shape::circle(0.5).unwrap());
    let capsule = one(Shape::capsule(vec2(-0.5, 0.0), vec2(0.5, 0.0), 0.2).unwrap());
    let gon = one(Shape::regular_polygon(32, 0.5).unwrap());
    let arc = one(Shape::arc(vec2(0.0, 0.0), 2.0, 3.0, 3.5).unwrap());
    let frames: Vec<_> =
        (0..64).map(|i| at(0.3 * (f64::from(i)).sin(), 0.999, 1e-3 * f64::from(i % 7))).collect();
    let far: Vec<_> = (0..64).map(|i| at(1.3, 1.3 + 1e-3 * f64::from(i), 0.1)).collect();
    for (name, a, b, frames, margin) in [
        ("box-box touching", &square, &square, &frames, 0.01),
        ("box-box apart", &square, &square, &far, 0.01),
        ("box-box corner to corner", &square, &square, &far, 10.0),
        ("circle-circle", &disk, &disk, &frames, 0.01),
        ("circle-circle apart", &disk, &disk, &far, 0.01),
        ("box-circle", &square, &disk, &frames, 0.01),
        ("box-capsule", &square, &capsule, &frames, 0.4),
        ("32-gon-32-gon", &gon, &gon, &frames, 0.05),
        ("arc-box", &arc, &square, &frames, 1.0),
        ("arc-arc", &arc, &arc, &frames, 1.0),
    ] {
        let mut out = Vec::new();
        let rounds = 20_000_u32;
        let mut best = f64::INFINITY;
        let mut found = 0;
        for _ in 0..5 {
            let start = Instant::now();
            for _ in 0..rounds / 64 {
                out.clear();
                for frame in black_box(frames) {
                    collide(black_box(a), black_box(b), frame, margin, &mut out);
                }
                found = out.len();
            }
            best = best.min(start.elapsed().as_nanos() as f64 / f64::from(rounds / 64 * 64));
        }
        println!("{name:26} {best:7.1} ns ({found} of 64)");
    }
}
