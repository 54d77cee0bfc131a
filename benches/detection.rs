//! What detection costs: finding pairs of 10 000 unit boxes side by side; single times of impact and distances.

use std::hint::black_box;

use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use culbuto::collision::{
    self, BroadPhase, Collider, Convex, Frame, Geometry, ProxyId, Sweep, WireArc,
};
use culbuto::math::{Pose, Real, Rot, Vec2, vec2};
use culbuto::shapes::Aabb;

const COLUMNS: u32 = 100;
const COUNT: u32 = 10_000;
const MARGIN: Real = 0.05;

/// Centres of a pile, in rows, slightly out of line.
fn center(k: u32) -> Vec2 {
    let jitter = Real::from(k.wrapping_mul(2_654_435_761) >> 16) / 65_536.0;
    vec2(Real::from(k % COLUMNS), Real::from(k / COLUMNS)) * 1.02
        + vec2(jitter, 1.0 - jitter) * 0.02
}

fn unit_box(center: Vec2) -> Aabb {
    Aabb { min: center - vec2(0.5, 0.5), max: center + vec2(0.5, 0.5) }
}

fn pile() -> BroadPhase {
    let mut broad = BroadPhase::default();
    for k in 0..COUNT {
        broad.insert(&unit_box(center(k)), MARGIN, true);
    }
    broad
}

/// Velocity of a box, in all directions, up to `speed` (m/step).
fn velocity(k: u32, speed: Real) -> Vec2 {
    let random = |salt: u32| {
        Real::from(k.wrapping_add(salt).wrapping_mul(0x9E37_79B1) >> 8) / Real::from(1 << 23) - 1.0
    };
    vec2(random(1), random(7919)) * speed
}

/// One step: every box is told anew, and pairs are found.
fn step(broad: &mut BroadPhase, time: Real, speed: Real) -> usize {
    for k in 0..COUNT {
        broad.update(ProxyId(k), &unit_box(center(k) + velocity(k, speed) * time), MARGIN);
    }
    let mut count = 0;
    broad.find_pairs(|_, _| true, |_, _| count += 1);
    count
}

fn broad_phase(criterion: &mut Criterion) {
    criterion.bench_function("broad phase: insert 10 000", |b| b.iter(pile));
    criterion.bench_function("broad phase: all pairs of 10 000", |b| {
        b.iter_batched_ref(pile, |broad| step(broad, 0.0, 0.0), BatchSize::LargeInput);
    });
    for (name, speed) in
        [("at rest", 0.0), ("0.001 widths a step", 1e-3), ("0.1 widths a step", 0.1)]
    {
        let mut settled = pile();
        settled.find_pairs(|_, _| true, |_, _| {});
        let mut time = 0.0;
        criterion.bench_function(&format!("broad phase: 10 000, {name}"), |b| {
            b.iter(|| {
                time += 1.0;
                step(&mut settled, time % 200.0, speed)
            });
        });
    }
    let broad = pile();
    criterion.bench_function("broad phase: query", |b| {
        let mut k = 0;
        b.iter(|| {
            k = (k + 7919) % COUNT;
            let mut count = 0;
            broad.query(&unit_box(center(k)), &mut |_| {
                count += 1;
                true
            });
            count
        });
    });
}

fn moving(from: [Real; 3], to: [Real; 3]) -> Sweep {
    let pose = |[x, y, angle]: [Real; 3]| Pose::new(vec2(x, y), angle);
    Sweep { from: pose(from), to: pose(to) }
}

fn rectangle(width: Real, height: Real) -> Collider {
    let (x, y) = (width / 2.0, height / 2.0);
    let corners = vec![vec2(-x, -y), vec2(x, -y), vec2(x, y), vec2(-x, y)];
    Collider::new(0, 0, Geometry::Convex(Convex::new(corners, 0.0)))
}

fn time_of_impact(criterion: &mut Criterion) {
    let still = moving([0.0; 3], [0.0; 3]);
    let disk = Collider::new(0, 0, Geometry::Convex(Convex::new(vec![vec2(0.0, 0.0)], 0.01)));
    let ring = Collider::new(0, 0, Geometry::Arc(WireArc::new(vec2(0.0, 0.0), 2.0, 0.0, 6.0)));
    let (wall, unit, bar) = (rectangle(1e-3, 10.0), rectangle(1.0, 1.0), rectangle(2.0, 1e-3));
    let cases = [
        ("a disk at a wall", &disk, moving([-600.0, 0.0, 0.0], [1000.0, 0.5, 0.0]), &wall),
        ("a tumbling box at a wall", &unit, moving([-3.0, 0.0, 0.0], [3.0, 0.5, 2.0]), &wall),
        ("a tumbling box past a box", &unit, moving([-3.0, 1.43, 0.0], [3.0, 1.43, 2.0]), &unit),
        (
            "a bar of 16 turns that grazes",
            &bar,
            moving([-1.0006, 0.0, 0.0], [-1.0006, 0.0, 100.0]),
            &wall,
        ),
        ("a box within an open ring", &unit, moving([0.0, 0.0, 0.0], [1.9, 0.5, 2.0]), &ring),
    ];
    for (name, a, sweep, b) in cases {
        criterion.bench_function(&format!("time of impact: {name}"), |bencher| {
            bencher.iter(|| collision::time_of_impact(a, &sweep, b, &still, 1e-5));
        });
    }
    let frame = Frame { position: vec2(1.3, 1.2), rot: Rot::new(0.3) };
    criterion.bench_function("distance of two boxes", |bencher| {
        bencher.iter(|| collision::distance(&unit.geometry, &unit.geometry, black_box(&frame)));
    });
}

criterion_group!(benches, broad_phase, time_of_impact);
criterion_main!(benches);
