//! Surfaces act as stated: friction, its rules and tables, restitution, rolling resistance, conveyors.

use culbuto::body::{Friction, Mixing, PairOfMaterials, Rule, Surface};
use culbuto::math::{Real, Vec2, vec2};
use culbuto::shapes::Shape;
use culbuto::{BodyDef, BodyHandle, World};
use proptest::prelude::*;

use crate::common::{DT, fewer, fixed, surface};
use crate::worlds::assert_below;

const G: Real = 10.0;

/// A shape on (or `up` above) a floor whose top is at y = 0, with a surface each.
fn on_floor(shape: Shape, ground: Surface, own: Surface, up: Real) -> (World, BodyHandle) {
    let mut world = World::new(vec2(0.0, -G)).unwrap();
    let floor = BodyDef { surface: ground, ..fixed(400.0, 2.0, vec2(0.0, -1.0)) };
    world.add_body(floor).unwrap();
    let bottom = -shape.bounds().min.y;
    let def = BodyDef { position: vec2(0.0, bottom + up), surface: own, ..BodyDef::new(shape) };
    let body = world.add_body(def).unwrap();
    (world, body)
}

fn launch(world: &mut World, body: BodyHandle, velocity: Vec2) {
    world.body_mut(body).unwrap().set_velocity(velocity).unwrap();
}

/// Way of a flat box that is thrown along the floor, until it stops.
fn way(ground: Surface, own: Surface, mixing: Mixing, speed: Real) -> Real {
    // Flat, so that it does not tip, whatever the friction.
    let (mut world, body) = on_floor(Shape::rectangle(4.0, 0.2).unwrap(), ground, own, 0.0);
    world.set_mixing(mixing).unwrap();
    launch(&mut world, body, vec2(speed, 0.0));
    for _ in 0..6000 {
        world.step(DT).unwrap();
        if world.body(body).unwrap().velocity().x.abs() < 1e-9 {
            break;
        }
    }
    world.body(body).unwrap().position().x
}

proptest! {
    #![proptest_config(fewer(16))]

    /// v²/2μg by every rule. The stop falls inside a substep h, in which the force is not the exact one: the
    /// way may be off by ⅛μgh² at most.
    #[test]
    fn a_slide_is_as_long_as_the_rule_of_friction_says(
        a in 0.1..1.0_f64, b in 0.1..1.0_f64, speed in 1.0..4.0_f64,
    ) {
        for (name, rule) in Rule::ALL {
            let mixing = Mixing { friction: rule, ..Mixing::default() };
            let mu = rule.apply(a, b);
            prop_assume!(mu > 0.01);
            let exact = speed * speed / (2.0 * mu * G);
            let h = DT / 4.0;
            let found = way(surface(a, 0.0), surface(b, 0.0), mixing, speed);
            prop_assert!((found - exact).abs() <= mu * G * h * h / 8.0 + 1e-12 * exact, "{}: {} {}", name, found, exact);
        }
    }

    /// Apex after the bounce: the speed after is e times the speed before, to rounding.
    #[test]
    fn a_bounce_keeps_restitution_times_the_speed(a in 0.3..1.0_f64, b in 0.3..1.0_f64, up in 0.5..3.0_f64) {
        for (name, rule) in Rule::ALL {
            let e = rule.apply(a, b).min(1.0);
            let (mut world, body) =
                on_floor(Shape::circle(0.3).unwrap(), surface(0.0, a), surface(0.0, b), up);
            world.set_mixing(Mixing { restitution: rule, ..Mixing::default() }).unwrap();
            let fall = (2.0 * up / G).sqrt();
            // A while after the first bounce and before the second.
            let steps = ((fall * (1.0 + e)) / DT).floor();
            world.steps(DT, steps as u32).unwrap();
            let t = steps * DT - fall;
            prop_assume!(t > 0.0 && t < 2.0 * e * fall);
            let v0 = e * G * fall;
            let body = world.body(body).unwrap();
            let height = body.position().y - 0.3;
            prop_assert!((height - (v0 * t - 0.5 * G * t * t)).abs() <= 1e-10, "{}: {} {:e}", name, height, height - (v0 * t - 0.5 * G * t * t));
            prop_assert!((body.velocity().y - (v0 - G * t)).abs() <= 1e-10, "{}", name);
        }
    }

    /// (m + I/r²) a = −(arm/r) mg: a = ⅔ g·arm/r for a disk that rolls.
    #[test]
    fn rolling_resistance_brakes_a_disk_by_its_arm(arm in 0.005..0.05_f64, r in 0.2..1.0_f64, speed in 1.0..5.0_f64) {
        let rough = Surface { rolling_resistance: arm, ..surface(1.0, 0.0) };
        let (mut world, body) =
            on_floor(Shape::circle(r).unwrap(), surface(1.0, 0.0), rough, 0.0);
        launch(&mut world, body, vec2(speed, 0.0));
        world.body_mut(body).unwrap().set_angular_velocity(-speed / r).unwrap();
        let a = 2.0 / 3.0 * G * arm / r;
        let steps = ((0.9 * speed / a / DT).floor()).min(120.0);
        world.steps(DT, steps as u32).unwrap();
        let found = world.body(body).unwrap().velocity().x;
        let exact = speed - a * steps * DT;
        prop_assert!((found - exact).abs() <= 1e-4 * speed, "{} {}", found, exact);
    }

    /// A belt takes a box along at μg until it has the belt's speed, and holds it there.
    #[test]
    fn what_lies_on_a_conveyor_reaches_its_speed(belt in -3.0..3.0_f64, mu in 0.2..1.0_f64) {
        let moving = Surface { tangent_speed: belt, ..surface(mu, 0.0) };
        let (mut world, body) =
            on_floor(Shape::rectangle(4.0, 0.2).unwrap(), moving, surface(mu, 0.0), 0.0);
        let time = belt.abs() / (mu * G);
        let half = (0.5 * time / DT).floor();
        if half > 0.0 {
            world.steps(DT, half as u32).unwrap();
        }
        // Counter-clockwise along the border: the top of the floor runs to −x.
        let speed = -belt.signum() * mu * G * half * DT;
        prop_assert!((world.body(body).unwrap().velocity().x - speed).abs() <= 1e-11);
        world.steps(DT, (time / DT) as u32 + 2).unwrap();
        let found = world.body(body).unwrap().velocity().x;
        prop_assert!((found + belt).abs() <= 1e-11, "{} on a belt of {}", found, belt);
        let energy = world.energy().unwrap();
        prop_assert!(energy.work >= energy.dissipated - 1e-12 && energy.dissipated >= -1e-12);
    }
}

#[test]
fn a_table_of_materials_decides_before_the_rules() {
    let of = |name: &str| Surface { material: Some(name.into()), ..surface(0.9, 0.0) };
    let pair = PairOfMaterials {
        a: "steel".into(),
        b: "ice".into(),
        friction: Some(Friction::of(0.1)),
        restitution: None,
    };
    let mixing = Mixing { table: vec![pair], ..Mixing::default() };
    let exact = 9.0 / (2.0 * 0.1 * G);
    for (a, b) in [("steel", "ice"), ("ice", "steel")] {
        assert_below("by the table", (way(of(a), of(b), mixing.clone(), 3.0) - exact).abs(), 1e-4);
    }
    let by_rule = 9.0 / (2.0 * 0.9 * G);
    assert_below("by the rule", (way(of("ice"), of("ice"), mixing, 3.0) - by_rule).abs(), 1e-4);
}

/// tan of the slope between μk and μs: it stays if it rests, and slides if it was pushed.
#[test]
fn static_friction_holds_what_kinetic_friction_would_let_go() {
    let two = Surface { friction: Friction { sticking: 0.6, sliding: 0.3 }, ..Surface::default() };
    let slope: Real = 0.45;
    let shape = || Shape::rectangle(4.0, 0.2).unwrap();
    let (mut world, body) = on_floor(shape(), two.clone(), two, 0.0);
    world.set_gravity(vec2(G * slope, -G)).unwrap();
    world.steps(DT, 120).unwrap();
    assert_below("at rest", world.body(body).unwrap().velocity().norm(), 1e-12);
    launch(&mut world, body, vec2(1.0, 0.0));
    world.steps(DT, 120).unwrap();
    let exact = 1.0 + (slope - 0.3) * G * 2.0;
    assert_below("sliding", (world.body(body).unwrap().velocity().x - exact).abs(), 1e-11);
}
