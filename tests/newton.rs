//! Newton's three laws.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // helpers of tests may, as tests do

#[path = "common/worlds.rs"]
mod worlds;

use culbuto::body::{BodyKind, Locks};
use culbuto::forces::{Air, Attraction, ForceSchedule};
use culbuto::math::{Real, Twist, Vec2, Wrench, cross, vec2};
use culbuto::methods::{Facts, REGISTRY};
use culbuto::shapes::Shape;
use culbuto::{BodyDef, World};
use proptest::prelude::*;
use worlds::{APART, EPS, Lorentz, Righting, Springs, assert_below, bits, order, world_with};

fn all_facts() -> impl Iterator<Item = &'static Facts> {
    REGISTRY.iter().map(|method| method.facts())
}

/// Numbers that span decades.
fn log_uniform(from: Real, to: Real) -> impl Strategy<Value = Real> {
    (from.ln()..to.ln()).prop_map(Real::exp)
}

fn vector(size: Real) -> impl Strategy<Value = Vec2> {
    (-size..size, -size..size).prop_map(|(x, y)| vec2(x, y))
}

/// A rotating point of this mass and inertia.
fn rotor(mass: Real, inertia: Real) -> BodyDef {
    BodyDef { inertia: Some(inertia), ..BodyDef::point(mass) }
}

/// x₀ + v₀t + ½at², and the same of the angle; the sums of the absolute values stand beside them.
fn parabola(pose: (Vec2, Real), twist: Twist, a: Twist, t: Real) -> [(Real, Real); 3] {
    let term = |x: Real, v: Real, a: Real| {
        let (way, bend) = (v * t, 0.5 * a * t * t);
        (x + way + bend, x.abs() + way.abs() + bend.abs())
    };
    [
        term(pose.0.x, twist.linear.x, a.linear.x),
        term(pose.0.y, twist.linear.y, a.linear.y),
        term(pose.1, twist.angular, a.angular),
    ]
}

proptest! {
    /// Second law, case 1. Rounding: each of N steps of at most 13 stages rounds a few terms, and
    /// compositions go up to 5 times as far back and forth as they get: 100·N·ε of the terms' sum.
    #[test]
    fn a_constant_force_gives_the_exact_parabola_at_any_step(
        mass in log_uniform(1e-3, 1e6), inertia in log_uniform(1e-3, 1e6),
        push in vector(1.0), twist in -1.0..1.0, gravity in vector(20.0),
        place in vector(10.0), velocity in vector(10.0), spin in -10.0..10.0,
        dt in log_uniform(1e-4, 0.5), steps in 1..40_u32, substeps in 1..5_u32,
    ) {
        let (force, torque) = (push * 30.0 * mass, twist * 30.0 * inertia);
        let exact = all_facts().filter(|facts| facts.exact_for_constant_force).map(|f| f.name);
        for (method, closed) in exact.map(|name| (name, false)).chain([("leapfrog", true)]) {
            let mut world = world_with(method);
            world.set_gravity(gravity).unwrap();
            world.set_substeps(substeps).unwrap();
            world.set_closed_form(closed);
            let def = BodyDef {
                position: place, velocity, angular_velocity: spin, force, torque, ..rotor(mass, inertia)
            };
            world.add_body(def).unwrap();
            world.steps(dt, steps).unwrap();
            let (pose, v) = (world.bodies().poses[0], world.bodies().twists[0]);
            let t = dt * Real::from(steps);
            let a = Twist::new(force / mass + gravity, torque / inertia);
            let start = Twist::new(velocity, spin);
            let got = [pose.position.x, pose.position.y, pose.angle];
            let bound = 100.0 * Real::from(steps * substeps) * EPS;
            for (got, (exact, size)) in got.into_iter().zip(parabola((place, 0.0), start, a, t)) {
                prop_assert!((got - exact).abs() <= bound * size, "{method}: {got:e} {exact:e}");
            }
            let faster = start.linear + a.linear * t;
            let size = start.linear.norm() + a.linear.norm() * t;
            prop_assert!((v.linear - faster).norm() <= bound * size, "{method}");
            let spun = (v.angular - (spin + a.angular * t)).abs();
            prop_assert!(spun <= bound * (spin.abs() + a.angular.abs() * t), "{method}");
        }
    }

    /// Second law, case 2: a force that is constant between given times is exact too, wherever the
    /// steps begin and end.
    #[test]
    fn a_scheduled_force_gives_the_exact_pieces_of_parabolas(
        mass in log_uniform(1e-3, 1e6), inertia in log_uniform(1e-3, 1e6),
        first in -0.5..0.5, lengths in prop::collection::vec(0.01..0.4, 1..6),
        pushes in prop::collection::vec((vector(10.0), -10.0..10.0), 6),
        velocity in vector(5.0), dt in log_uniform(1e-3, 0.5), steps in 1..40_u32,
        endless in any::<bool>(), closed in any::<bool>(),
    ) {
        let mut times = vec![first];
        lengths.iter().for_each(|length| times.push(times[times.len() - 1] + length));
        if endless {
            *times.last_mut().unwrap() = Real::INFINITY;
        }
        let wrenches: Vec<Wrench> = pushes[..lengths.len()]
            .iter().map(|(push, twist)| Wrench::new(*push * mass, twist * inertia)).collect();
        let mut world = world_with("leapfrog");
        world.set_closed_form(closed);
        let body = world.add_body(BodyDef { velocity, ..rotor(mass, inertia) }).unwrap();
        let schedule = ForceSchedule::new(times.clone(), wrenches.clone()).unwrap();
        world.add_schedule(body, schedule).unwrap();
        world.steps(dt, steps).unwrap();

        let end = dt * Real::from(steps);
        let (mut x, mut v, mut turn) = (vec2(0.0, 0.0), velocity, (0.0, 0.0));
        let mut cuts: Vec<Real> = times.iter().copied().filter(|t| 0.0 < *t && *t < end).collect();
        cuts.insert(0, 0.0);
        cuts.push(end);
        for cut in cuts.windows(2) {
            let (h, middle) = (cut[1] - cut[0], 0.5 * (cut[0] + cut[1]));
            let piece = times.windows(2).position(|piece| piece[0] <= middle && middle < piece[1]);
            let wrench = piece.map_or(Wrench::ZERO, |k| wrenches[k]);
            x += v * h + wrench.force / mass * (0.5 * h * h);
            v += wrench.force / mass * h;
            turn.0 += turn.1 * h + 0.5 * wrench.torque / inertia * h * h;
            turn.1 += wrench.torque / inertia * h;
        }
        // A change of force within 1e-12 of a step's end counts as there: 1e-12·dt·|a|·t of the way.
        let t = end + 1.0;
        let bound = (1e-12 + 100.0 * Real::from(steps + 6) * EPS) * (5.0 * t + 10.0 * t * t);
        let body = world.body(body).unwrap();
        prop_assert!((body.position() - x).norm() <= bound, "{} {}", body.position(), x);
        prop_assert!((body.velocity() - v).norm() <= bound);
        prop_assert!((body.angle() - turn.0).abs() <= bound);
        prop_assert!((body.angular_velocity() - turn.1).abs() <= bound);
    }

    /// First law, and the second for an impulse: p changes by exactly P, L by r × P.
    #[test]
    fn an_impulse_changes_momentum_by_itself(
        mass in log_uniform(1e-3, 1e6), inertia in log_uniform(1e-3, 1e6),
        impulse in vector(10.0), at in vector(3.0), place in vector(3.0), velocity in vector(3.0),
    ) {
        let mut world = world_with("leapfrog");
        let def = BodyDef { position: place, velocity, ..rotor(mass, inertia) };
        let body = world.add_body(def).unwrap();
        let (p, l) = (world.momentum(), world.angular_momentum(vec2(0.0, 0.0)));
        world.body_mut(body).unwrap().apply_impulse(impulse, Some(at)).unwrap();
        let gained = world.momentum() - p;
        prop_assert!((gained - impulse).norm() <= 8.0 * EPS * (p.norm() + impulse.norm()));
        let turned = world.angular_momentum(vec2(0.0, 0.0)) - l - cross(at, impulse);
        prop_assert!(turned.abs() <= 32.0 * EPS * (p.norm() * 5.0 + 20.0 * impulse.norm()));
        // Then nothing acts, and it goes on straight.
        let v = world.body(body).unwrap().twist();
        world.steps(0.1, 10).unwrap();
        prop_assert_eq!(world.body(body).unwrap().twist(), v);
        let way = world.body(body).unwrap().position() - place;
        prop_assert!((way - v.linear).norm() <= 64.0 * EPS * (v.linear.norm() + place.norm()));
    }

    /// A force at a point acts for one step, with the torque r × F.
    #[test]
    fn a_force_at_a_point_has_the_torque_of_its_lever(
        mass in log_uniform(1e-3, 1e6), inertia in log_uniform(1e-3, 1e6),
        force in vector(10.0), at in vector(3.0), place in vector(3.0), dt in 0.01..0.5,
    ) {
        let mut world = world_with("leapfrog");
        let body = world.add_body(BodyDef { position: place, ..rotor(mass, inertia) }).unwrap();
        world.body_mut(body).unwrap().apply_force(force, Some(at)).unwrap();
        world.step(dt).unwrap();
        let once = world.body(body).unwrap().twist();
        prop_assert!((once.linear * mass - force * dt).norm() <= 8.0 * EPS * force.norm() * dt);
        let turned = once.angular * inertia - cross(at - place, force) * dt;
        prop_assert!(turned.abs() <= 16.0 * EPS * 6.0 * force.norm() * dt);
        world.step(dt).unwrap();
        prop_assert_eq!(world.body(body).unwrap().twist(), once);
    }

    /// Third law: internal forces keep momentum and the motion of the centre of mass under every
    /// method, angular momentum under the symplectic ones. 40 steps of at most 8 kicks, rounded.
    #[test]
    fn internal_forces_keep_momentum(
        bodies in prop::collection::vec((log_uniform(1e-3, 1e3), vector(3.0), vector(1.0)), 2..6),
        springs in any::<bool>(),
    ) {
        for facts in all_facts() {
            let mut world = isolated(facts.name, &bodies, springs);
            let scale: Real = bodies.iter().map(|(m, _, v)| m * (v.norm() + 1.0)).sum();
            let (p, l) = (world.momentum(), world.angular_momentum(vec2(0.0, 0.0)));
            let center = world.center_of_mass();
            let most = 40.0 * 8.0 * 4.0 * EPS;
            prop_assert!(world.third_law_residual().unwrap().unwrap() <= 16.0 * EPS);
            world.steps(0.005, 40).unwrap();
            prop_assert!((world.momentum() - p).norm() <= most * scale, "{}", facts.name);
            let drift = world.center_of_mass() - center - p / world.mass() * 0.2;
            prop_assert!(drift.norm() <= most * 10.0, "{}: {}", facts.name, drift);
            if facts.symplectic {
                let change = world.angular_momentum(vec2(0.0, 0.0)) - l;
                prop_assert!(change.abs() <= most * scale * 5.0, "{}: {change:e}", facts.name);
            }
        }
    }

    /// What is locked stays to the bit, whatever acts; what is kinematic or static heeds no force.
    #[test]
    fn locked_axes_and_given_motions_heed_no_force(
        locks in (any::<bool>(), any::<bool>(), any::<bool>()), velocity in vector(2.0),
        force in vector(9.0), wind in vector(9.0), with_field in any::<bool>(),
    ) {
        let locks = Locks { x: locks.0, y: locks.1, rotation: locks.2 };
        let shape = || BodyDef {
            angle: 0.3,
            filter: APART,
            ..BodyDef::new(Shape::rectangle(1.0, 0.5).unwrap())
        };
        let acted = || BodyDef { force, torque: 2.0, linear_damping: 0.5, angular_damping: 0.2, ..shape() };
        for facts in all_facts() {
            let mut world = world_with(facts.name);
            world.set_gravity(vec2(3.0, -9.81)).unwrap();
            world.set_air(Air { density: 1.3, wind }).unwrap();
            let locked = world.add_body(BodyDef { locks, ..acted() }).unwrap();
            if with_field {
                world.add_field(Righting { strength: 3.0 });
                world.add_field(Lorentz { field: 1.0, gradient: 0.1 });
                world.add_field(Attraction { strength: 1.0, exponent: 1.0, softening: 0.0 });
            }
            let kind = BodyKind::Kinematic;
            let moving = BodyDef { kind, velocity, angular_velocity: 2.0, ..acted() };
            let kinematic = world.add_body(moving).unwrap();
            let fixed = world.add_body(BodyDef { kind: BodyKind::Static, ..acted() }).unwrap();
            let start = world.body(fixed).unwrap().pose();
            world.steps(0.01, 20).unwrap();
            let body = world.body(locked).unwrap();
            for (lock, now, then, v) in [
                (locks.x, body.position().x, 0.0, body.velocity().x),
                (locks.y, body.position().y, 0.0, body.velocity().y),
                (locks.rotation, body.angle(), 0.3, body.angular_velocity()),
            ] {
                prop_assert_eq!(lock, now == then, "{}", facts.name);
                prop_assert_eq!(lock, v == 0.0, "{}", facts.name);
            }
            let body = world.body(kinematic).unwrap();
            prop_assert_eq!(body.twist(), Twist::new(velocity, 2.0), "{}", facts.name);
            prop_assert!((body.position() - velocity * 0.2).norm() <= 1e-14);
            prop_assert!((body.angle() - 0.7).abs() <= 1e-14);
            prop_assert_eq!(world.body(fixed).unwrap().pose(), start);
            prop_assert_eq!(world.body(fixed).unwrap().twist(), Twist::ZERO);
        }
    }
}

/// Bodies that only act on one another.
fn isolated(method: &str, bodies: &[(Real, Vec2, Vec2)], springs: bool) -> World {
    let mut world = world_with(method);
    for &(mass, position, velocity) in bodies {
        let def = BodyDef { position, velocity, ..BodyDef::point(mass) };
        world.add_body(BodyDef { angular_velocity: 1.0, inertia: Some(mass), ..def }).unwrap();
    }
    let lightest = bodies.iter().map(|body| body.0).fold(Real::INFINITY, Real::min);
    let heaviest = bodies.iter().map(|body| body.0).fold(0.0, Real::max);
    if springs {
        world.add_field(Springs { stiffness: 10.0 * lightest, length: 1.0 });
    } else {
        world.add_field(Attraction { strength: 1.0 / heaviest, exponent: -2.0, softening: 0.5 });
    }
    world
}

/// Three bodies on springs.
fn triangle(method: &str) -> World {
    let at = |mass, x, y, v| (mass, vec2(x, y), vec2(0.0, v));
    isolated(
        method,
        &[at(1.0, 0.0, 0.0, 0.1), at(2.0, 1.2, 0.1, -0.3), at(0.5, 0.3, 0.9, 0.2)],
        true,
    )
}

/// Largest error of a quantity over n steps of h.
fn worst(world: &mut World, h: Real, n: u32, of: impl Fn(&World) -> Real) -> Real {
    let start = of(world);
    let after = |_| {
        world.step(h).unwrap();
        (of(world) - start).abs()
    };
    (0..n).map(after).fold(0.0, Real::max)
}

#[test]
fn energy_of_an_isolated_system_is_kept_to_the_order_of_the_method() {
    for facts in all_facts() {
        let error = |n: u32| {
            let balance = |world: &World| world.energy().unwrap().balance();
            worst(&mut triangle(facts.name), 1.0 / Real::from(n), n, balance)
        };
        // Steps at which the error is of order 1e-3 to 1e-9, well above rounding.
        let n = [0, 4000, 200, 0, 40, 20, 20, 0, 6][facts.order as usize];
        let (coarse, fine) = (error(n), error(2 * n));
        let measured = order(coarse, fine);
        println!("{}: {coarse:e} {fine:e}, order {measured:.2}", facts.name);
        assert!(measured > Real::from(facts.order) - 0.2, "{}: {measured}", facts.name);
        assert!(fine > 1e-13, "{}: {fine:e} is rounding", facts.name);
    }
}

#[test]
fn angular_momentum_is_kept_to_the_order_of_methods_that_are_not_symplectic() {
    for facts in all_facts().filter(|facts| !facts.symplectic) {
        let error = |n: u32| {
            let about_origin = |world: &World| world.angular_momentum(vec2(0.0, 0.0));
            worst(&mut triangle(facts.name), 1.0 / Real::from(n), n, about_origin)
        };
        let n = [0, 4000, 0, 0, 40, 20, 0, 0, 10][facts.order as usize];
        let measured = order(error(n), error(2 * n));
        println!("{}: {:e}, order {measured:.2}", facts.name, error(n));
        assert!(measured > Real::from(facts.order) - 0.2, "{}: {measured}", facts.name);
    }
}

#[test]
fn symplectic_methods_keep_the_energy_bounded() {
    let windows = |name: &str| {
        let mut world = triangle(name);
        let balance = |world: &World| world.energy().unwrap().balance();
        let start = balance(&world);
        let mut window = || {
            let after = |_| {
                world.step(0.02).unwrap();
                (balance(&world) - start).abs()
            };
            (0..5000).map(after).fold(0.0, Real::max)
        };
        let first = window();
        (0..8).for_each(|_| {
            window();
        });
        (first, window())
    };
    for facts in all_facts().filter(|facts| facts.symplectic) {
        let (first, last) = windows(facts.name);
        println!("{}: {first:e} in the first 100 s, {last:e} in the tenth", facts.name);
        // The error swings with the motion; it must not grow with time. 5e4 steps of rounding.
        assert_below(facts.name, last, 1.5 * first + 5e4 * EPS);
    }
    // The measure tells: Euler's explicit method gains energy all the time.
    let (first, last) = windows("explicit_euler");
    assert!(last > 2.0 * first, "{first:e} {last:e}");
}

#[test]
fn a_body_at_rest_stays_at_rest_and_a_moving_one_goes_straight() {
    for facts in all_facts() {
        for closed in [true, false] {
            let mut world = world_with(facts.name);
            world.set_closed_form(closed);
            world.add_body(BodyDef { position: vec2(0.1, 0.2), ..rotor(3.0, 2.0) }).unwrap();
            let still = bits(&world)[..6].to_vec();
            let v = Twist::new(vec2(0.3, -0.7), 0.9);
            let def =
                BodyDef { velocity: v.linear, angular_velocity: v.angular, ..rotor(1.0, 1.0) };
            let body = world.add_body(def).unwrap();
            world.steps(0.37, 100).unwrap();
            let poses = &world.bodies().poses;
            let now = [poses[0].position.x, poses[0].position.y, poses[0].angle];
            assert_eq!(now.map(Real::to_bits), still[..3]);
            assert_eq!(world.body(body).unwrap().twist(), v, "{}", facts.name);
            let way = world.body(body).unwrap().position() - v.linear * 37.0;
            assert_below(facts.name, way.norm(), 100.0 * 8.0 * EPS * 37.0);
        }
    }
}
