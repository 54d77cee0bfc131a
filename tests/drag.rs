//! The resistance of air and damping.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // helpers of tests may, as tests do

#[path = "common/worlds.rs"]
mod worlds;

use culbuto::body::{DragWidth, Locks};
use culbuto::forces::Air;
use culbuto::math::{Real, Rot, Vec2, vec2};
use culbuto::methods::REGISTRY;
use culbuto::shapes::Shape;
use culbuto::{BodyDef, World};
use proptest::prelude::*;
use worlds::{EPS, assert_below, order, reference, world_with};

/// A ball one metre wide, for which ½ρCA = k in air of density 1.
fn ball(mass: Real, k: Real) -> BodyDef {
    let shape = Shape::circle(0.5).unwrap();
    BodyDef { mass: Some(mass), drag_coefficient: 2.0 * k, ..BodyDef::new(shape) }
}

/// A world of one body in air of density 1.
fn in_air(def: BodyDef, wind: Vec2) -> World {
    let mut world = world_with("leapfrog");
    world.set_air(Air { density: 1.0, wind }).unwrap();
    world.add_body(def).unwrap();
    world
}

fn state(world: &World) -> (Vec2, Vec2) {
    (world.bodies().poses[0].position, world.bodies().twists[0].linear)
}

fn log_uniform(from: Real, to: Real) -> impl Strategy<Value = Real> {
    (from.ln()..to.ln()).prop_map(Real::exp)
}

#[test]
fn drag_alone_is_exact_at_any_step() {
    // v = v₀/(1 + kv₀t/m), x = (m/k) ln(1 + kv₀t/m): rounding only, of n steps.
    for steps in [1, 3, 10, 300] {
        let mut world =
            in_air(BodyDef { velocity: vec2(20.0, 0.0), ..ball(2.0, 0.24) }, vec2(0.0, 0.0));
        world.steps(5.0 / Real::from(steps), steps).unwrap();
        let (x, v) = state(&world);
        let bound = 1e-13_f64.max(8.0 * Real::from(steps) * EPS);
        assert_below("velocity", (v.x / 1.538_461_538_461_538_4 - 1.0).abs(), bound);
        assert_below("position", (x.x / 21.374_577_978_846_137 - 1.0).abs(), bound);
    }
}

proptest! {
    /// S4x: where a step of explicit drag explodes (kvh/m > 2), this neither overshoots nor gains.
    #[test]
    fn strong_drag_does_not_overshoot(speed in log_uniform(1e-3, 1e5), mass in log_uniform(1e-3, 1e6),
                                      stiff in log_uniform(1.0, 1e6), direction in 0.0..6.3) {
        let h = 0.5;
        let velocity = Rot::new(direction).apply(vec2(speed, 0.0));
        let mut world = in_air(BodyDef { velocity, ..ball(mass, stiff * mass / (speed * h)) }, vec2(0.0, 0.0));
        world.step(h).unwrap();
        let (x, v) = state(&world);
        // v is a difference of numbers up to v₀, hence the absolute part of the bound.
        prop_assert!((v - velocity / (1.0 + stiff)).norm() <= 8.0 * EPS * speed);
        prop_assert!(v.dot(&velocity) >= -8.0 * EPS * speed * speed);
        let way = speed * h / stiff * stiff.ln_1p();
        prop_assert!((x.norm() / way - 1.0).abs() <= 1e-14);
    }

    /// Linear and quadratic drag together, against the wind: u' = −cu − κ|u|u. The reference is good to
    /// (rate·h)⁴ < (18/20000)⁴ < 1e-12.
    #[test]
    fn damping_and_drag_together_are_exact(speed in 0.1..5.0, rate in 0.0..3.0, k in 0.0..3.0,
                                           wind in (-3.0..3.0, -3.0..3.0), steps in 1..20_u32) {
        let wind = vec2(wind.0, wind.1);
        let relative = Rot::new(1.0).apply(vec2(speed, 0.0));
        let def = BodyDef { velocity: wind + relative, linear_damping: rate, ..ball(1.5, k * 1.5) };
        let mut world = in_air(def, wind);
        world.steps(1.0 / Real::from(steps), steps).unwrap();
        let [way, left] = reference(|_, [_, u]| [*u, -rate * u - k * u * u], [0.0, speed], 1.0, 20_000);
        let (x, v) = state(&world);
        let direction = relative / speed;
        prop_assert!((v - wind - direction * left).norm() <= 1e-11, "{v} {left}");
        prop_assert!((x - wind - direction * way).norm() <= 1e-11, "{x} {way}");
    }

    /// Linear damping alone under a constant force: v' = a − c(v − w), whose solution is known, at any step.
    /// Rounding: n steps of a few terms, each up to the sum of their sizes.
    #[test]
    fn a_damped_fall_is_exact(v in -5.0..5.0_f64, w in -5.0..5.0_f64, a in -10.0..10.0_f64,
                              rates in (1e-3..5.0_f64, 1e-3..5.0_f64), t in 0.1..3.0_f64, steps in 1..40_u32) {
        // As far and as fast, from φ₁ = (1 − e^(−ct))/(ct): x = wt + (v − w)tφ₁ + a(t/c)(1 − φ₁).
        let exact = |v: Real, w: Real, a: Real, c: Real| {
            let phi = -(-c * t).exp_m1() / (c * t);
            let left = (v - w) * (-c * t).exp();
            (w * t + (v - w) * t * phi + a * t / c * (1.0 - phi), w + left + a * t * phi)
        };
        let def = BodyDef {
            velocity: vec2(v, 0.0), linear_damping: rates.0, angular_velocity: w, angular_damping: rates.1,
            inertia: Some(2.0), torque: 2.0 * a, ..BodyDef::point(1.5)
        };
        let mut world = in_air(BodyDef { drag_coefficient: 0.0, ..def }, vec2(w, 0.0));
        world.set_gravity(vec2(a, 0.0)).unwrap();
        world.steps(t / Real::from(steps), steps).unwrap();
        let (place, velocity) = state(&world);
        // 1 − φ₁ ≥ ct/4 or so has lost as many digits here as 1e-3 is small.
        let bound = 1e3 * 64.0 * Real::from(steps) * EPS * 50.0;
        let (x, u) = exact(v, w, a, rates.0);
        prop_assert!((place.x - x).abs() <= bound && (velocity.x - u).abs() <= bound, "{place} {x}");
        let (angle, spin) = exact(w, 0.0, a, rates.1);
        prop_assert!((world.bodies().poses[0].angle - angle).abs() <= bound);
        prop_assert!((world.bodies().twists[0].angular - spin).abs() <= bound);
    }

    /// On a rail the wind from the side brakes too: v' = −κ√(v² + b²)·v, exact at any step.
    #[test]
    fn a_cross_wind_brakes_on_a_rail(velocity in -5.0..5.0_f64, wind in (-3.0..3.0, 0.1..3.0), k in 0.1..3.0_f64,
                                     upright in any::<bool>(), steps in 1..20_u32) {
        let (along, across): (Real, Real) = wind;
        let turn = |x: Real, y: Real| if upright { vec2(y, x) } else { vec2(x, y) };
        let locks = Locks { x: upright, y: !upright, rotation: false };
        let def = BodyDef { velocity: turn(velocity, 0.0), locks, ..ball(2.0, k * 2.0) };
        let mut world = in_air(def, turn(along, across));
        world.steps(1.0 / Real::from(steps), steps).unwrap();
        let slope = |_: Real, &[_, v]: &[Real; 2]| {
            let u = v - along;
            [v, -k * u.hypot(across) * u]
        };
        let [place, left] = reference(slope, [0.0, velocity], 1.0, 4000);
        let (x, v) = state(&world);
        prop_assert!((v - turn(left, 0.0)).norm() <= 1e-10, "{v} {left}");
        prop_assert!((x - turn(place, 0.0)).norm() <= 1e-10, "{x} {place}");
    }

    /// What drag and damping take is what the body loses, to rounding, at any step.
    #[test]
    fn what_is_dissipated_is_what_is_lost(velocity in (-9.0..9.0, -9.0..9.0), spin in -9.0..9.0,
        rates in (0.0..2.0, 0.0..2.0), k in 0.0..2.0, gravity in prop_oneof![Just(0.0), 0.0..20.0_f64], h in 0.001..0.3,
        closed in any::<bool>(), to_tolerance in any::<bool>()) {
        let def = BodyDef {
            velocity: vec2(velocity.0, velocity.1), angular_velocity: spin, linear_damping: rates.0,
            angular_damping: rates.1, torque: 0.3, ..ball(1.3, k)
        };
        let mut world = in_air(def, vec2(0.0, 0.0));
        world.set_gravity(vec2(0.0, -gravity)).unwrap();
        world.set_closed_form(closed);
        let start = world.energy().unwrap();
        let bound = if to_tolerance {
            world.advance(20.0 * h, 1e-12).unwrap();
            1e-9
        } else {
            world.steps(h, 20).unwrap();
            // Leapfrog's energy errs at order h² where gravity bends the way; alone it books exactly.
            if gravity == 0.0 { 1e-12 } else { 2.0 * h }
        };
        let end = world.energy().unwrap();
        let scale = start.kinetic + 1.3 * gravity * gravity + 1.0;
        prop_assert!((end.balance() - start.balance()).abs() <= bound * scale);
        prop_assert!(end.dissipated >= -bound * scale);
    }

    /// The width is that of the true shadow of the turned shape, whatever the direction of motion.
    /// From 1/v = 1/v₀ + κt follows κ, hence the width. Rounding: 1/v − 1/v₀ cancels about one digit.
    #[test]
    fn the_silhouette_of_a_turned_box_brakes(a in 0.1..3.0, b in 0.1..3.0, angle in -4.0..4.0, direction in -4.0..4.0) {
        let width = |drag_width| {
            let velocity = Rot::new(direction).apply(vec2(2.0, 0.0));
            let shape = Shape::rectangle(a, b).unwrap();
            let locks = Locks { rotation: true, ..Locks::default() };
            let def = BodyDef { velocity, angle, drag_width, locks, ..BodyDef::new(shape) };
            let mut world = in_air(BodyDef { mass: Some(1.0), drag_coefficient: 2.0, ..def }, vec2(0.0, 0.0));
            world.step(1.0).unwrap();
            1.0 / state(&world).1.norm() - 0.5
        };
        let phi: Real = direction - angle;
        let shadow = a * phi.sin().abs() + b * phi.cos().abs();
        prop_assert!((width(DragWidth::Silhouette) / shadow - 1.0).abs() <= 1e-13);
        // The box around it, with edges along the axes, is never narrower.
        prop_assert!(width(DragWidth::BoundingBox) >= shadow * (1.0 - 1e-13));
        prop_assert!((width(DragWidth::Fixed(0.7)) / 0.7 - 1.0).abs() <= 1e-13);
    }
}

#[test]
fn a_bounding_box_is_not_the_silhouette() {
    // A square turned by 45° seen along x has the shadow √2 both ways; seen along the diagonal its shadow
    // is a side, that of the box around it 2.
    let square = Shape::rectangle(1.0, 1.0).unwrap();
    let left = |drag_width, direction: Real| {
        let angle = std::f64::consts::FRAC_PI_4;
        let velocity = Rot::new(direction).apply(vec2(1.0, 0.0));
        let def = BodyDef {
            mass: Some(1.0),
            angle,
            velocity,
            drag_width,
            ..BodyDef::new(square.clone())
        };
        let mut world = in_air(BodyDef { drag_coefficient: 2.0, ..def }, vec2(0.0, 0.0));
        world.step(1.0).unwrap();
        1.0 / state(&world).1.norm() - 1.0
    };
    let (straight, diagonal) = (0.0, std::f64::consts::FRAC_PI_4);
    let root = Real::sqrt(2.0);
    assert_below("shadow", (left(DragWidth::Silhouette, straight) - root).abs(), 1e-14);
    assert_below("box", (left(DragWidth::BoundingBox, straight) - root).abs(), 1e-14);
    assert_below("shadow", (left(DragWidth::Silhouette, diagonal) - 1.0).abs(), 1e-14);
    assert_below("box", (left(DragWidth::BoundingBox, diagonal) - 2.0).abs(), 1e-14);
}

#[test]
fn a_fall_approaches_its_terminal_velocity_at_the_order_of_the_method() {
    // m = 2, k = 0.24: v = v_t tanh(gt/v_t), y = −(v_t²/g) ln cosh(gt/v_t), v_t = √(mg/k).
    let (m, k, g, t) = (2.0, 0.24, 9.81, 1.0);
    let terminal = Real::sqrt(m * g / k);
    assert_below("terminal velocity", (terminal - 9.041_570_660_01).abs(), 1e-11);
    let (y, v) = (
        -(terminal * terminal / g) * (g * t / terminal).cosh().ln(),
        -terminal * (g * t / terminal).tanh(),
    );
    assert_below("table", (y + 4.166_335_244_75).abs() + (v + 7.188_425_658_92).abs(), 1e-10);
    let error = |method: &str, n: u32| {
        let mut world = in_air(ball(m, k), vec2(0.0, 0.0));
        world.set_gravity(vec2(0.0, -g)).unwrap();
        world.set_method(method).unwrap();
        world.steps(t / Real::from(n), n).unwrap();
        let (place, velocity) = state(&world);
        ((place.y - y) / y).abs().max(((velocity.y - v) / v).abs())
    };
    for facts in REGISTRY.iter().map(|method| method.facts()) {
        let n = [0, 1000, 100, 0, 16, 10, 6, 0, 3][facts.order as usize];
        let (coarse, fine) = (error(facts.name, n), error(facts.name, 2 * n));
        let measured = order(coarse, fine);
        println!("{}: {coarse:e} {fine:e}, order {measured:.2}", facts.name);
        assert!((measured - Real::from(facts.order)).abs() < 0.2, "{}: {measured}", facts.name);
        assert!(fine > 1e-13, "{}: rounding", facts.name);
    }
    // What the catalogue asks at 1/60 with 4 substeps.
    assert_below("S3", error("leapfrog", 240), 1e-4);
}

#[test]
fn spin_decays_exponentially() {
    for closed in [true, false] {
        let def = BodyDef { angular_velocity: 7.0, angular_damping: 0.8, ..ball(1.0, 0.0) };
        let mut world = in_air(def, vec2(0.0, 0.0));
        world.set_closed_form(closed);
        world.steps(0.1, 30).unwrap();
        let body = world.bodies();
        let left = Real::exp(-0.8 * 3.0);
        assert_below("spin", (body.twists[0].angular / (7.0 * left) - 1.0).abs(), 1e-13);
        let turned = 7.0 * (1.0 - left) / 0.8;
        assert_below("turn", (body.poses[0].angle / turned - 1.0).abs(), 1e-13);
    }
}
