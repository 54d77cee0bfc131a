//! Every method that treats joints has with them the order that it states.

use culbuto::World;
use culbuto::math::{Real, vec2};
use culbuto::methods::{Facts, REGISTRY};

use crate::scenes::{G, double_pendulum, pendulum, spring};
use crate::worlds::{order, reference};

pub fn with_joints() -> impl Iterator<Item = &'static Facts> {
    REGISTRY.iter().map(|method| method.facts()).filter(|facts| facts.joints)
}

/// The mean order between steps whose errors are below 0.1 and well above rounding, at most the finest three of them.
fn measured(errors: &[Real]) -> Real {
    let usable: Vec<Real> = errors.iter().copied().filter(|e| (2e-11..1e-1).contains(e)).collect();
    let finest = &usable[usable.len().saturating_sub(3)..];
    match finest {
        [first, .., last] => order(*first, *last) / (finest.len() - 1) as Real,
        _ => Real::NAN,
    }
}

/// Checks the order of every method by the error of places and velocities of all bodies after a time, in n = 2, 4, … steps.
fn check(what: &str, make: impl Fn(&str) -> World, time: Real, exact: &[[Real; 4]]) {
    let mut wrong = Vec::new();
    for facts in with_joints() {
        let at = |k: u32| {
            let n = 1_u32 << k;
            let mut world = make(facts.name);
            // A method may refuse a step that is too long for it.
            world.steps(time / Real::from(n), n).map_or(Real::INFINITY, |()| apart(&world, exact))
        };
        let errors: Vec<Real> = (1..14).map(at).collect();
        let order = measured(&errors);
        let shown: Vec<_> = errors.iter().map(|e| format!("{e:.1e}")).collect();
        println!("{what}: {:20} order {order:.3} of {shown:?}", facts.name);
        // Order 8 is at rounding before the terms of its error beyond the first are small.
        let above = if facts.order > 6 { 1.5 } else { 0.25 };
        let off = order - Real::from(facts.order);
        if !(-0.25..above).contains(&off) {
            wrong.push(facts.name);
        }
    }
    assert!(wrong.is_empty(), "{what}: {wrong:?}");
}

/// How far bodies are from places and velocities.
fn apart(world: &World, exact: &[[Real; 4]]) -> Real {
    let bodies = world.bodies();
    let states = bodies.poses.iter().zip(&bodies.twists).zip(exact);
    states
        .map(|((pose, twist), [x, y, u, v])| {
            (pose.position - vec2(*x, *y)).norm() + (twist.linear - vec2(*u, *v)).norm()
        })
        .sum()
}

#[test]
fn of_a_pendulum() {
    let [angle, spin] =
        reference(|_, [a, w]| [*w, -G * a.sin()], [Real::to_radians(90.0), 0.0], 1.5, 40_000);
    let exact = [angle.sin(), -angle.cos(), spin * angle.cos(), spin * angle.sin()];
    check("pendulum", pendulum, 1.5, &[exact]);
}

#[test]
fn of_a_double_pendulum() {
    // The answers of the catalogue are tested in `exact`; here all of the state counts.
    let mut fine = double_pendulum("dop853");
    fine.steps(1.5 / 1500.0, 1500).unwrap();
    let exact: Vec<[Real; 4]> = (0..2)
        .map(|i| {
            let (pose, twist) = (&fine.bodies().poses[i], &fine.bodies().twists[i]);
            [pose.position.x, pose.position.y, twist.linear.x, twist.linear.y]
        })
        .collect();
    check("double pendulum", double_pendulum, 1.5, &exact);
}

#[test]
fn of_springs_with_and_without_damping() {
    let time = 0.9;
    for damping_ratio in [0.0, 0.1, 0.3] {
        // x'' = −ω²x − 2ζωx'.
        let omega = std::f64::consts::TAU * 2.0;
        let slope = |_: Real, [x, v]: &[Real; 2]| {
            [*v, -omega * omega * x - 2.0 * damping_ratio * omega * v]
        };
        let [x, v] = reference(slope, [0.25, 0.0], time, 20_000);
        let make = |method: &str| spring(method, damping_ratio);
        check("spring", make, time, &[[1.0 + x, 0.0, v, 0.0]]);
    }
}
