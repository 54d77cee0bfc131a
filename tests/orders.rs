//! The order that a method states is the order that is measured; a tolerance is kept.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // helpers of tests may, as tests do

#[path = "common/worlds.rs"]
mod worlds;

use std::f64::consts::TAU;

use culbuto::forces::{Air, Central, Oscillating};
use culbuto::joint::JointDef;
use culbuto::math::{Real, Vec2, vec2};
use culbuto::methods::REGISTRY;
use culbuto::shapes::Shape;
use culbuto::{BodyDef, World};
use proptest::prelude::*;
use worlds::{EPS, Lorentz, Righting, assert_below, order, reference, world_with};

/// Kepler's ellipse, μ = a = 1, e = 0.6, from its near end.
fn kepler(method: &str) -> World {
    let mut world = world_with(method);
    let center = vec2(0.0, 0.0);
    world.add_field(Central { center, strength: 1.0, exponent: -2.0, per_mass: true });
    let (position, velocity) = (vec2(0.4, 0.0), vec2(0.0, 2.0));
    world.add_body(BodyDef { position, velocity, ..BodyDef::point(1.0) }).unwrap();
    world
}

/// Where it is after a time: Kepler's equation E − e sin E = t by Newton's method.
fn on_ellipse(t: Real) -> Vec2 {
    let mut e = t;
    for _ in 0..50 {
        e -= (e - 0.6 * e.sin() - t) / (1.0 - 0.6 * e.cos());
    }
    vec2(e.cos() - 0.6, 0.8 * e.sin())
}

/// A body that swings far under a torque −3 sin θ.
fn swing(method: &str) -> World {
    let mut world = world_with(method);
    world.add_field(Righting { strength: 3.0 });
    let body =
        BodyDef { inertia: Some(1.0), angle: 0.5, angular_velocity: 2.5, ..BodyDef::point(1.0) };
    world.add_body(body).unwrap();
    world
}

/// A charge in a magnetic field that grows along x.
fn charge(method: &str) -> World {
    let mut world = world_with(method);
    world.add_field(Lorentz { field: 1.5, gradient: 0.6 });
    let body = BodyDef { velocity: vec2(0.6, 0.8), ..BodyDef::point(1.0) };
    world.add_body(body).unwrap();
    world
}

/// Errors after a time at n = 4, 8, … steps, down to rounding.
fn ladder(make: impl Fn() -> World, time: Real, error: impl Fn(&World) -> Real) -> Vec<Real> {
    let at = |k: u32| {
        let n = 1_u32 << k;
        let mut world = make();
        // A method may refuse a step that is too long for it.
        world.steps(time / Real::from(n), n).map_or(Real::INFINITY, |()| error(&world))
    };
    (2..15).map(at).collect()
}

/// The order at the finest two steps whose errors are below 1e-2 and a hundred times above the rounding
/// of the answer.
fn finest_order(errors: &[Real]) -> Real {
    let usable = |pair: &&[Real]| pair[0] < 1e-2 && pair[1] > 1e-12;
    errors.windows(2).rfind(usable).map_or(Real::NAN, |pair| order(pair[0], pair[1]))
}

fn check_orders(make: impl Fn(&str) -> World, time: Real, error: impl Fn(&World) -> Real) {
    for facts in REGISTRY.iter().map(|method| method.facts()) {
        let errors = ladder(|| make(facts.name), time, &error);
        let measured = finest_order(&errors);
        println!("{:20} order {measured:.3}, finest error {:.1e}", facts.name, errors[12]);
        assert!(
            (measured - Real::from(facts.order)).abs() < 0.2,
            "{}: {measured} of {errors:?}",
            facts.name
        );
    }
}

#[test]
fn orders_hold_on_keplers_ellipse() {
    assert_below(
        "S12",
        (on_ellipse(1.0) - vec2(-0.628_948_176_827, 0.799_664_730_970)).norm(),
        1e-12,
    );
    let exact = on_ellipse(2.0);
    check_orders(kepler, 2.0, |world| (world.bodies().poses[0].position - exact).norm());
}

#[test]
fn orders_hold_for_a_torque_that_depends_on_the_angle() {
    // The reference's error: (ωh)⁴ = (1.7·4/40000)⁴ ~ 1e-15 of a few radians. Angle and speed
    // together have no moment at which the error changes its sign.
    let [angle, spin] = reference(|_, [a, w]| [*w, -3.0 * a.sin()], [0.5, 2.5], 4.0, 40_000);
    check_orders(swing, 4.0, |world| {
        let (pose, twist) = (world.bodies().poses[0], world.bodies().twists[0]);
        (pose.angle - angle).hypot(twist.angular - spin)
    });
}

#[test]
fn orders_hold_for_a_force_that_depends_on_the_velocity() {
    let slope = |_: Real, [x, _, u, v]: &[Real; 4]| {
        let field = 1.5 + 0.6 * x;
        [*u, *v, field * v, -field * u]
    };
    let [x, y, ..] = reference(slope, [0.0, 0.0, 0.6, 0.8], 2.0, 20_000);
    check_orders(charge, 2.0, |world| (world.bodies().poses[0].position - vec2(x, y)).norm());
}

#[test]
fn orders_hold_for_a_force_that_depends_on_the_time() {
    // x'' = A sin(Ωt + φ): x = t·(A/Ω) cos φ + (A/Ω²)(sin φ − sin(Ωt + φ)).
    let (hertz, phase) = (0.5, 0.3_f64);
    let omega = TAU * hertz;
    let exact =
        2.0 / omega * phase.cos() + (phase.sin() - (omega * 2.0 + phase).sin()) / (omega * omega);
    let make = |name: &str| {
        let mut world = world_with(name);
        let body = world.add_body(BodyDef::point(1.0)).unwrap();
        world.add_field(Oscillating { body, force: vec2(1.0, 0.0), torque: 0.0, hertz, phase });
        world
    };
    check_orders(make, 2.0, |world| (world.bodies().poses[0].position.x - exact).abs());
}

/// Two rods of 1 m and 1 kg on hinges, let go along +x.
fn double_pendulum(method: &str) -> World {
    let mut world = world_with(method);
    world.set_gravity(vec2(0.0, -9.81)).unwrap();
    let mut before = None;
    for k in [0.0, 1.0] {
        let rod = BodyDef { inertia: Some(1.0 / 12.0), ..BodyDef::point(1.0) };
        let body = world.add_body(BodyDef { position: vec2(k + 0.5, 0.0), ..rod }).unwrap();
        world.add_joint(JointDef::revolute(before, body).at(vec2(k, 0.0))).unwrap();
        before = Some(body);
    }
    world
}

/// Angular accelerations of the two by Lagrange's equations in their angles from the lowest point.
fn double_slope(_: Real, [a, b, u, v]: &[Real; 4]) -> [Real; 4] {
    let (sin, cos) = (a - b).sin_cos();
    let (m, n, k) = (4.0 / 3.0, 1.0 / 3.0, 0.5 * cos);
    let p = -0.5 * sin * v * v - 1.5 * 9.81 * a.sin();
    let q = 0.5 * sin * u * u - 0.5 * 9.81 * b.sin();
    let det = m * n - k * k;
    [*u, *v, (n * p - k * q) / det, (m * q - k * p) / det]
}

#[test]
fn the_order_holds_for_joints() {
    let outer = |time: Real| {
        let [a, b, ..] = reference(double_slope, [TAU / 4.0, TAU / 4.0, 0.0, 0.0], time, 40_000);
        vec2(a.sin() + 0.5 * b.sin(), -a.cos() - 0.5 * b.cos())
    };
    let known = vec2(-1.298_461_242_98, -0.698_310_920_025);
    assert_below("S11 at t = 1", (outer(1.0) - known).norm(), 1e-10);
    let exact = outer(1.0);
    let off = |world: &World| (world.bodies().poses[1].position - exact).norm();
    let errors = ladder(|| double_pendulum("leapfrog"), 1.0, off);
    let measured = finest_order(&errors);
    println!("double pendulum: order {measured:.3}, finest error {:.1e}", errors[12]);
    assert!((measured - 2.0).abs() < 0.2, "{measured} of {errors:?}");
}

#[test]
fn a_magnetic_field_does_no_work() {
    for name in ["leapfrog", "yoshida4", "yoshida6"] {
        let mut world = charge(name);
        world.steps(0.1, 100_000).unwrap();
        let speed = world.bodies().twists[0].linear.norm();
        // 1e5 steps of up to 7 kicks, each solved to 4ε and rounded a few times more, at random.
        println!("{name}: |v| off by {:e} after 1e5 steps", speed - 1.0);
        assert_below(name, (speed - 1.0).abs(), 64.0 * EPS * Real::sqrt(7e5));
    }
    // The measure tells: Runge and Kutta's method is not made for this.
    let mut world = charge("rk4");
    world.steps(0.1, 100_000).unwrap();
    assert!((world.bodies().twists[0].linear.norm() - 1.0).abs() > 1e-6);
}

#[test]
fn the_error_falls_with_the_tolerance() {
    let error = |tolerance: Real| {
        let mut world = kepler("leapfrog");
        world.advance(TAU, tolerance).unwrap();
        let estimate = world.report().estimate.unwrap();
        ((world.bodies().poses[0].position - vec2(0.4, 0.0)).norm(), estimate)
    };
    let mut errors: Vec<Real> = Vec::new();
    for k in 3..=13 {
        let tolerance = Real::powi(10.0, -k);
        let (now, estimate) = error(tolerance);
        println!("{tolerance:e}: error {now:.1e}, estimate {estimate:.1e}");
        // An error in the speed becomes one in the place, 3·t times as large: an orbit with a longer
        // period. Some 20 steps of one tolerance each, and speeds up to 2, come before that.
        assert_below("error", now, 100.0 * TAU * tolerance + 1e-12);
        // What the run says of itself is no more than ten times off, either way.
        assert!(estimate > 0.1 * now && estimate < 10.0 * now, "{now:e}, said to be {estimate:e}");
        // Step by step luck has a hand in it; over three decades the error falls by more than one.
        if let Some(before) = errors.len().checked_sub(3).map(|i| errors[i]) {
            assert!(now < 0.1 * before, "{tolerance:e}: {now:e} after {before:e}");
        }
        errors.push(now);
    }
}

#[test]
fn a_thousand_orbits_keep_their_energy() {
    let mut world = kepler("leapfrog");
    let start = world.energy().unwrap().balance();
    world.advance(1000.0 * TAU, 1e-13).unwrap();
    assert_below("dE", (world.energy().unwrap().balance() - start).abs(), 1e-9);
}

#[test]
fn samples_of_a_run_are_what_direct_runs_give() {
    let times: Vec<Real> = (0..=40).map(|k| 0.05 * Real::from(k)).collect();
    for tolerance in [1e-4, 1e-7, 1e-10] {
        let mut world = kepler("leapfrog");
        world.set_time(3.0).unwrap();
        let whole = world.advance_sampled(2.0, tolerance, &times).unwrap();
        // Sampling does not change the run.
        let mut plain = kepler("leapfrog");
        plain.set_time(3.0).unwrap();
        plain.advance(2.0, tolerance).unwrap();
        assert_eq!(plain.bodies().poses, world.bodies().poses);
        for (k, &time) in times.iter().enumerate() {
            let place = whole.pose(k, 0).position;
            let mut direct = kepler("leapfrog");
            if time > 0.0 {
                direct.advance(time, tolerance).unwrap();
            }
            let apart = (place - direct.bodies().poses[0].position).norm();
            // Each step errs by less than the tolerance, and the interpolant, of order 7, by little more.
            assert_below("sample", apart, 5.0 * tolerance);
            assert_below("exact", (place - on_ellipse(time)).norm(), 5.0 * tolerance);
            assert!((whole.times[k] - (3.0 + time)).abs() <= 4.0 * EPS);
        }
        assert_eq!(whole.pose(0, 0).position, vec2(0.4, 0.0));
        assert_eq!(whole.pose(40, 0).position, world.bodies().poses[0].position);
    }
}

#[test]
fn exact_for_a_constant_force_and_only_where_stated() {
    for facts in REGISTRY.iter().map(|method| method.facts()) {
        let mut world = world_with(facts.name);
        world.set_gravity(vec2(0.0, -9.81)).unwrap();
        world.set_closed_form(false);
        world.add_body(BodyDef { velocity: vec2(12.0, 9.0), ..BodyDef::point(1.0) }).unwrap();
        world.steps(0.125, 16).unwrap();
        let error = (world.bodies().poses[0].position - vec2(24.0, -1.62)).norm();
        assert_eq!(error < 1e-12, facts.exact_for_constant_force, "{}: {error:e}", facts.name);
    }
}

proptest! {
    /// Between the kinks of its silhouette a tumbling box moves smoothly, so errors follow the tolerance;
    /// a step across a kink would be wrong by its slope's jump times h², whatever the tolerance.
    #[test]
    fn a_tumbling_box_keeps_its_tolerance(
        angle in -3.0..3.0, spin in -9.0..9.0, speed in 2.0..20.0, length in 0.2..2.0, power in 8..13,
    ) {
        let end = |tolerance: Real| {
            let mut world = World::new(vec2(0.0, -9.81)).unwrap();
            world.set_air(Air { density: 1.2, wind: vec2(-1.0, 0.5) }).unwrap();
            let box_ = BodyDef {
                angle,
                angular_velocity: spin,
                velocity: vec2(speed, 3.0),
                mass: Some(1.0),
                drag_coefficient: 1.0,
                ..BodyDef::new(Shape::rectangle(length, 0.1).unwrap())
            };
            world.add_body(box_).unwrap();
            world.advance(1.5, tolerance).unwrap();
            (world.bodies().poses[0].position, world.bodies().twists[0].linear)
        };
        let tolerance = libm::pow(10.0, -Real::from(power));
        let (at, exact) = (end(tolerance), end(1e-14));
        let error = (at.0 - exact.0).norm().max((at.1 - exact.1).norm());
        // Some thirty steps, each within the tolerance of a way of metres; without an eye for kinks one run
        // in five is beyond that, and the worst a hundred times.
        assert_below("box", error, 30.0 * tolerance);
    }
}
