//! The time of impact is the first of a dense set of times at which the shapes are near.

use culbuto::collision::{Collider, Geometry, Sweep, distance, time_of_impact};
use culbuto::math::{Pose, Real, vec2};
use proptest::prelude::*;

use crate::figures::{
    arc, arcs, b_in_a, convex, disk, geometries, points, rectangle, scaled, sweeps,
};

fn distance_at(a: (&Geometry, &Sweep), b: (&Geometry, &Sweep), time: Real) -> Real {
    // Relative to A's place at the start, so that the test itself keeps its digits far away.
    distance(a.0, b.0, &b_in_a(&a.1.at(time), &b.1.at(time))).distance
}

fn impact(a: (&Geometry, &Sweep), b: (&Geometry, &Sweep), target: Real) -> Option<Real> {
    let [x, y] = [a.0, b.0].map(|geometry| Collider::new(0, 0, geometry.clone()));
    time_of_impact(&x, a.1, &y, b.1, target)
}

/// What must hold of a time of impact, by looking at many times.
fn check(
    a: (&Geometry, &Sweep),
    b: (&Geometry, &Sweep),
    target: Real,
    rounding: Real,
) -> Option<Real> {
    const SAMPLES: u32 = 2000;
    let slack = 2e-3 * target + rounding;
    let found = impact(a, b, target);
    let end = found.unwrap_or(1.0);
    assert!((0.0..=1.0).contains(&end));
    if end == 0.0 {
        assert!(distance_at(a, b, end) <= target + slack);
        return found;
    }
    for k in 0..SAMPLES {
        let time = end * Real::from(k) / Real::from(SAMPLES);
        let distance = distance_at(a, b, time);
        assert!(
            distance >= target - slack,
            "missed at {time} ({found:?}): {distance:e} of {target:e}"
        );
    }
    let last = distance_at(a, b, end);
    assert!(last >= target - slack, "{last:e} at {end} is nearer than {target:e}");
    assert!(
        last <= target + slack || found.is_none(),
        "{last:e} at {end} is farther than {target:e}"
    );
    found
}

fn targets() -> impl Strategy<Value = Real> {
    prop_oneof![Just(1e-2), Just(1e-4), Just(1e-6)]
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(300))]

    #[test]
    fn slow_and_fast(
        a in geometries(), b in geometries(),
        (sweep_a, sweep_b) in (sweeps(5.0, 3.0), sweeps(5.0, 3.0)), target in targets(),
    ) {
        check((&a, &sweep_a), (&b, &sweep_b), target, 1e-12);
    }

    #[test]
    fn many_turns(
        a in geometries(), b in geometries(),
        (sweep_a, sweep_b) in (sweeps(3.0, 50.0), sweeps(3.0, 50.0)), target in targets(),
    ) {
        check((&a, &sweep_a), (&b, &sweep_b), target, 1e-11);
    }

    /// Within and through the openings of arcs.
    #[test]
    fn arcs_hold_what_is_in_them(
        a in arcs(), b in geometries(),
        (sweep_a, sweep_b) in (sweeps(1.0, 5.0), sweeps(3.0, 5.0)), size in 0.02..0.5, target in targets(),
    ) {
        let b = scaled(&b, size);
        check((&a, &sweep_a), (&b, &sweep_b), target, 1e-12);
        check((&b, &sweep_b), (&a, &sweep_a), target, 1e-12);
    }

    /// The same in any unit of length; far from the origin as far as positions have digits.
    #[test]
    fn no_scale_and_no_origin(
        a in geometries(), b in geometries(),
        (sweep_a, sweep_b) in (sweeps(4.0, 3.0), sweeps(4.0, 3.0)), k in -6..=6_i32, offset in points(1e7),
    ) {
        let target = 1e-3;
        let here = impact((&a, &sweep_a), (&b, &sweep_b), target);
        let factor = Real::powi(10.0, k);
        let times = |p: Pose| Pose::new(p.position * factor, p.angle);
        let [large_a, large_b] = [sweep_a, sweep_b].map(|s| Sweep { from: times(s.from), to: times(s.to) });
        let large = impact((&scaled(&a, factor), &large_a), (&scaled(&b, factor), &large_b), target * factor);
        let same = |x: Option<Real>, y: Option<Real>, slack| match (x, y) {
            (Some(x), Some(y)) => (x - y).abs() <= slack,
            (x, y) => x == y,
        };
        let grazing = here.is_some() != large.is_some();
        prop_assert!(grazing || same(here, large, 1e-3), "{here:?} {large:?}");
        let moved = |p: Pose| Pose::new(p.position + offset, p.angle);
        let [far_a, far_b] = [sweep_a, sweep_b].map(|s| Sweep { from: moved(s.from), to: moved(s.to) });
        check((&a, &far_a), (&b, &far_b), target, 1e-8);
    }

    /// No shot passes a thin wall, however fast, small or off straight.
    #[test]
    fn bullets_stop(
        speed in 3.0..5.0, aim in -0.4..0.4, slope in -1.0..1.0, turn in -100.0..100.0, long in any::<bool>(),
    ) {
        let bullet = if long { rectangle(0.02, 0.001) } else { disk(vec2(0.0, 0.0), 0.002) };
        let wall = rectangle(1e-3, 10.0);
        let way = Real::powf(10.0, speed) / 60.0;
        let slope = slope / way;
        let from = vec2(-0.3 * way, aim - slope);
        let sweep = Sweep { from: Pose::new(from, 0.3), to: Pose::new(from + vec2(way, slope), 0.3 + turn) };
        let still = Sweep { from: Pose::new(vec2(0.0, 0.0), 0.0), to: Pose::new(vec2(0.0, 0.0), 0.0) };
        let target = 1e-5;
        let found = impact((&bullet, &sweep), (&wall, &still), target).expect("the wall is in the way");
        let distance = distance_at((&bullet, &sweep), (&wall, &still), found);
        prop_assert!((distance - target).abs() < 1e-8 + 1e-14 * way && sweep.at(found).position.x < 0.0);
    }

    /// A thin bar that turns up to 16 times on the spot hits a pin that it reaches, at the angle at which it gets
    /// there, and no pin that it does not.
    #[test]
    fn turning_bars_hit_pins(turns in 0.1..100.0, at in 0.1..1.2, bearing in 0.05..3.0, thin in -6.0..-2.0) {
        let (width, pin) = (Real::powf(10.0, thin), 1e-3);
        let bar = rectangle(2.0, width);
        let sweep = Sweep { from: Pose::IDENTITY, to: Pose::new(vec2(0.0, 0.0), turns) };
        let place = Pose::new(vec2(at * Real::cos(bearing), at * Real::sin(bearing)), 0.0);
        let target = 1e-6;
        let pin_shape = disk(vec2(0.0, 0.0), pin);
        let found = impact((&bar, &sweep), (&pin_shape, &Sweep { from: place, to: place }), target);
        if at > 1.0 + pin + width + 2.0 * target {
            prop_assert_eq!(found, None);
        } else if at < 1.0 {
            // The pin touches the long side when its centre is ½ width + pin + target from the middle line.
            let angle: Real = bearing - Real::asin((width / 2.0 + pin + target) / at);
            if angle <= turns {
                let found = found.expect("the bar sweeps over the pin") * turns;
                prop_assert!((found - angle.max(0.0)).abs() < 2e-8 / at, "{} is not {}", found, angle);
            } else {
                prop_assert_eq!(found, None);
            }
        }
    }
}

fn moving(from: [Real; 3], to: [Real; 3]) -> Sweep {
    let pose = |[x, y, angle]: [Real; 3]| Pose::new(vec2(x, y), angle);
    Sweep { from: pose(from), to: pose(to) }
}

#[test]
fn cases_that_take_many_steps() {
    use std::f64::consts::{PI, TAU};
    let still = moving([0.0; 3], [0.0; 3]);
    let ring = arc(vec2(0.0, 0.0), 1.0, 0.0, TAU);
    // A bead just inside a ring: the ring turns; the bead runs across.
    let bead = disk(vec2(0.0, 0.0), 0.1);
    let beside = moving([0.0, -0.8999, 0.0], [0.0, -0.8999, 100.0]);
    let turning = moving([0.0; 3], [0.0, 0.0, 100.0]);
    assert_eq!(check((&ring, &turning), (&bead, &beside), 1e-5, 1e-12), None);
    assert!(
        check(
            (&ring, &still),
            (&bead, &moving([0.0, -0.8999, 0.0], [0.1, -0.8999, 0.0])),
            1e-5,
            1e-12
        )
        .is_some()
    );
    // Two boxes at rest on one another on a turntable: each keeps its place on the other.
    let [below, above] = [rectangle(2.0, 1.0), rectangle(1.0, 1.0)];
    let on_top = moving([0.0, 1.00002, 0.0], [0.0, 1.00002, 0.0]);
    assert_eq!(check((&below, &still), (&above, &on_top), 1e-5, 1e-12), None);
    // A rotor whose tips pass a wall at twice the target, sixteen times.
    let rotor = rectangle(2.0, 1e-3);
    let reach = Real::hypot(1.0, 5e-4);
    let wall = convex(vec![vec2(-9.0, 0.0), vec2(9.0, 0.0)], 0.0);
    let passing = moving([0.0, reach + 2e-5, 0.0], [0.0, reach + 2e-5, 100.0]);
    assert_eq!(check((&rotor, &passing), (&wall, &still), 1e-5, 1e-12), None);
    let touching = moving([0.0, reach + 0.9e-5, 0.0], [0.0, reach + 0.9e-5, 100.0]);
    let time = check((&rotor, &touching), (&wall, &still), 1e-5, 1e-12);
    assert!((time.unwrap() * 100.0 - PI / 2.0).abs() < 5e-3, "{time:?}");
    // A body put into half a ring through its opening touches the bottom, not the opening.
    let bowl = arc(vec2(0.0, 0.0), 1.0, PI, PI);
    let time =
        check((&bowl, &still), (&bead, &moving([0.0, 3.0, 0.0], [0.0, -3.0, 0.0])), 1e-5, 1e-12);
    assert!((time.unwrap() - (3.9 - 1e-5) / 6.0).abs() < 1e-8);
}

#[test]
fn they_overlap_at_once() {
    let still = moving([0.0; 3], [5.0, 0.0, 0.0]);
    assert_eq!(
        impact((&rectangle(1.0, 1.0), &still), (&disk(vec2(0.1, 0.0), 1.0), &still), 0.0),
        Some(0.0)
    );
}
