//! What finding pairs costs: 10 000 unit boxes side by side.

use criterion::{BatchSize, Criterion, criterion_group, criterion_main};
use culbuto::collision::{BroadPhase, ProxyId};
use culbuto::math::{Real, Vec2, vec2};
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
        let start = settled.quality();
        let mut time = 0.0;
        criterion.bench_function(&format!("broad phase: 10 000, {name}"), |b| {
            b.iter(|| {
                time += 1.0;
                step(&mut settled, time % 200.0, speed)
            });
        });
        let end = settled.quality();
        eprintln!("tree before and after: {start:?} {end:?}");
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

criterion_group!(benches, broad_phase);
criterion_main!(benches);
