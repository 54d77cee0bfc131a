//! What holds whatever the scene: energy, momentum, reversal, gaps.

use culbuto::forces::Air;
use culbuto::joint::{Hold, JointKind, Spring, Travel};
use culbuto::math::{Real, Vec2, vec2};
use culbuto::{BodyDef, JointDef, World};

use crate::orders::with_joints;
use crate::scenes::{double_pendulum, pendulum, rod, world};
use crate::worlds::{EPS, Springs, assert_below, bits};

fn largest_gap(world: &World) -> Real {
    world
        .joint_handles()
        .iter()
        .map(|joint| world.joint(*joint).unwrap().gap())
        .fold(0.0, Real::max)
}

/// Three rods in a row, hinged, the last one welded softly to a fourth, thrown into the void.
fn thrown(method: &str) -> World {
    let mut world = world(method);
    world.set_gravity(vec2(0.0, 0.0)).unwrap();
    let mut before = None;
    let mut end = vec2(0.3, -0.2);
    for (k, angle) in [0.2, 1.1, -0.6, -0.6].into_iter().enumerate() {
        let def = BodyDef {
            velocity: vec2(0.4, -0.1),
            angular_velocity: 1.5 - k as Real,
            ..rod(end, angle)
        };
        let body = world.add_body(def).unwrap();
        if let Some(before) = before {
            let joint = JointDef::revolute(before, body).at(end);
            let kind =
                JointKind::Weld { angle: None, linear: Hold::Rigid, angular: Hold::soft(1.0, 0.0) };
            world.add_joint(if k == 3 { JointDef { kind, ..joint } } else { joint }).unwrap();
        }
        before = Some(body);
        end += vec2(angle.cos(), angle.sin());
    }
    world
}

#[test]
fn nothing_moves_against_a_joint() {
    for facts in with_joints() {
        let mut world = double_pendulum(facts.name);
        world.steps(1e-3, 200).unwrap();
        // Places of up to 1.5 m, lever arms of 0.5 m and angles of up to 2 rad in either body of a hinge, each with
        // an error of a few roundings.
        assert_below(facts.name, largest_gap(&world), 32.0 * EPS);
        // The pin at the world does not move.
        let (pose, twist) = (world.bodies().poses[0], world.bodies().twists[0]);
        let pin = twist.at(pose.rot().apply(vec2(-0.5, 0.0)));
        assert_below(facts.name, pin.norm(), 16.0 * EPS);
    }
}

#[test]
fn rattle_keeps_momentum_and_angular_momentum_to_rounding() {
    for name in ["rattle", "yoshida4", "yoshida6"] {
        let mut world = thrown(name);
        // Joints first take what moves against them, also without a change of either.
        let start = (world.momentum(), world.angular_momentum(vec2(0.0, 0.0)));
        world.steps(0.01, 2000).unwrap();
        let end = (world.momentum(), world.angular_momentum(vec2(0.0, 0.0)));
        // Up to 15 kicks a step at random; the bodies go 4 m/s-metres far: |r||p| ~ 10·1.
        let rounding = EPS * Real::sqrt(2000.0 * 15.0);
        assert_below(name, (end.0 - start.0).norm(), 8.0 * rounding);
        assert_below(name, (end.1 - start.1).abs(), 80.0 * rounding);
    }
}

#[test]
fn symplectic_methods_do_not_drift_in_energy() {
    for (name, h, bound) in
        [("rattle", 0.01, 2e-2), ("yoshida4", 0.01, 1e-3), ("yoshida6", 0.01, 1e-4)]
    {
        let mut world = pendulum(name);
        let off = |world: &World| world.energy().unwrap().total().abs() / 9.81;
        world.steps(h, 1000).unwrap();
        let swings = |world: &mut World| {
            let mut worst: Real = 0.0;
            for _ in 0..300 {
                world.steps(h, 1).unwrap();
                worst = worst.max(off(world));
            }
            worst
        };
        let early = swings(&mut world);
        world.steps(h, 20_000).unwrap();
        let late = swings(&mut world);
        println!("{name}: energy off by {early:.1e} early, {late:.1e} late");
        assert_below(name, late, bound);
        assert_below(name, late, 1.5 * early + 1e-12);
    }
}

#[test]
fn time_runs_back() {
    for facts in with_joints().filter(|facts| facts.reversible) {
        let mut world = thrown(facts.name);
        world.add_field(Springs { stiffness: 3.0, length: 1.0 });
        // So that velocities are those that the joints let through.
        world.steps(0.01, 1).unwrap();
        let start: Vec<_> = world.bodies().poses.clone();
        world.steps(0.01, 100).unwrap();
        let turn = |world: &mut World| {
            for handle in world.bodies().handles().to_vec() {
                let i = world.bodies().index(handle).unwrap();
                let twist = world.bodies().twists[i];
                let mut body = world.body_mut(handle).unwrap();
                body.set_velocity(-twist.linear).unwrap();
                body.set_angular_velocity(-twist.angular).unwrap();
            }
        };
        turn(&mut world);
        world.steps(0.01, 100).unwrap();
        let apart = start
            .iter()
            .zip(&world.bodies().poses)
            .map(|(a, b)| (a.position - b.position).norm() + (a.angle - b.angle).abs());
        let worst = apart.fold(0.0, Real::max);
        println!("{}: back to {worst:.1e}", facts.name);
        assert_below(facts.name, worst, 1e-11);
    }
}

/// A pendulum of two rods in the air, with dampers and a motorless spring in the second hinge.
fn damped(method: &str) -> World {
    let mut world = world(method);
    world.set_air(Air { density: 0.6, wind: vec2(0.5, 0.0) }).unwrap();
    let air = |def: BodyDef| BodyDef { drag_coefficient: 1.0, linear_damping: 0.2, ..def };
    let a = world.add_body(air(rod(vec2(0.0, 0.0), 0.3))).unwrap();
    let b = world.add_body(air(rod(vec2(0.3_f64.cos(), 0.3_f64.sin()), -0.4))).unwrap();
    world.add_joint(JointDef::revolute(None, a).at(vec2(0.0, 0.0))).unwrap();
    let travel = Travel { spring: Some(Spring::new(1.0, 0.2)), ..Travel::default() };
    let hinge = JointDef::revolute(a, b).at(vec2(0.3_f64.cos(), 0.3_f64.sin()));
    world
        .add_joint(JointDef { kind: JointKind::Revolute { angle: None, travel }, ..hinge })
        .unwrap();
    world
}

#[test]
fn work_and_dissipation_are_booked() {
    for facts in with_joints() {
        let off = |n: u32| {
            let mut world = damped(facts.name);
            let start = world.energy().unwrap().balance();
            world.steps(1.0 / Real::from(n), n).unwrap();
            let energy = world.energy().unwrap();
            assert!(energy.dissipated > 0.1, "{}", facts.name);
            (energy.balance() - start).abs()
        };
        let (coarse, fine) = (off(256), off(1024));
        println!("{:20} balance off by {coarse:.1e}, {fine:.1e}", facts.name);
        // Four times as many steps: 4^order times less, or half of that in the exponent; down to the rounding of some
        // 10 J in up to 7 · 1024 kicks with up to ten solutions each.
        let gain = Real::from(2_u32.pow(facts.order));
        assert_below(facts.name, fine, (coarse / gain).max(10.0 * 70.0 * EPS * 32.0));
    }
}

#[test]
fn methods_agree_with_one_another() {
    let end = |name: &str, n: u32| {
        let mut world = damped(name);
        world.steps(1.0 / Real::from(n), n).unwrap();
        world.bodies().poses[1].position
    };
    let exact = end("dop853", 400);
    for (name, n, bound) in [
        ("rk4", 2000, 1e-10),
        ("rattle", 4000, 1e-5),
        ("yoshida4", 2000, 1e-7),
        ("trapezoid", 8000, 1e-2),
    ] {
        assert_below(name, (end(name, n) - exact).norm(), bound);
    }
    let mut world = damped("leapfrog");
    world.advance(1.0, 1e-12).unwrap();
    assert_below("to a tolerance", (world.bodies().poses[1].position - exact).norm(), 1e-9);
}

/// A parallelogram of three rods: its rows depend on one another where all rods lie in a line.
fn four_bar(method: &str) -> World {
    let mut world = world(method);
    let corners = [vec2(0.0, 0.0), vec2(0.0, 1.0), vec2(1.0, 1.0), vec2(1.0, 0.0)];
    let mut before = None;
    for k in 0..3 {
        let way: Vec2 = corners[k + 1] - corners[k];
        let body = world.add_body(rod(corners[k], way.y.atan2(way.x))).unwrap();
        world.add_joint(JointDef::revolute(before, body).at(corners[k])).unwrap();
        before = Some(body);
    }
    world.add_joint(JointDef::revolute(before, None).at(corners[3])).unwrap();
    world.body_mut(world.bodies().handles()[0]).unwrap().set_angular_velocity(-3.0).unwrap();
    world
}

#[test]
fn a_four_bar_passes_its_line() {
    for name in ["rattle", "rk4", "dop853"] {
        let mut world = four_bar(name);
        world.steps(1e-3, 1).unwrap();
        let start = world.energy().unwrap().balance();
        world.steps(1e-3, 1500).unwrap();
        let turn = world.bodies().poses[0].angle;
        println!("{name}: at {turn}");
        assert!(world.bodies().poses.iter().all(|pose| pose.position.x.is_finite()));
        assert_below(name, largest_gap(&world), 1e-12);
        assert_below(name, (world.energy().unwrap().balance() - start).abs(), 1e-2);
    }
}

#[test]
fn a_second_hinge_in_the_same_place_changes_nothing() {
    for facts in with_joints() {
        let mut once = pendulum(facts.name);
        let mut twice = pendulum(facts.name);
        let body = twice.bodies().handles()[0];
        let again = JointDef::distance(None, body).anchored(vec2(0.0, 0.0), vec2(1.0, 0.0));
        twice.add_joint(again).unwrap();
        for world in [&mut once, &mut twice] {
            world.steps(1e-3, 300).unwrap();
        }
        let apart = once.bodies().poses[0].position - twice.bodies().poses[0].position;
        assert_below(facts.name, apart.norm(), 1e-12);
        // Both bear the same.
        let loads = [0, 1].map(|k| twice.joint(twice.joint_handles()[k]).unwrap().reaction().force);
        let whole = once.joint(once.joint_handles()[0]).unwrap().reaction().force;
        assert_below(facts.name, (loads[0] - loads[1]).norm(), 1e-6 * whole.norm());
        assert_below(facts.name, (loads[0] + loads[1] - whole).norm(), 1e-6 * whole.norm());
    }
}

#[test]
fn runs_repeat_to_the_bit_and_go_on_from_a_snapshot() {
    for facts in with_joints() {
        let mut world = thrown(facts.name);
        world.steps(0.01, 10).unwrap();
        let snapshot = world.snapshot();
        world.steps(0.01, 10).unwrap();
        let end = bits(&world);
        world.restore(&snapshot);
        world.steps(0.01, 10).unwrap();
        assert_eq!(bits(&world), end, "{}", facts.name);
    }
}

#[test]
fn a_body_that_is_off_its_joint_is_put_there_and_booked() {
    for facts in with_joints() {
        let mut world = pendulum(facts.name);
        let body = world.bodies().handles()[0];
        world.body_mut(body).unwrap().set_position(vec2(1.2, 0.1)).unwrap();
        world.body_mut(body).unwrap().set_velocity(vec2(0.7, 1.0)).unwrap();
        let start = world.energy().unwrap().balance();
        world.steps(1e-5, 1).unwrap();
        assert_below(facts.name, largest_gap(&world), 8.0 * EPS);
        assert_below(facts.name, (world.energy().unwrap().balance() - start).abs(), 1e-8);
        assert!(world.energy().unwrap().dissipated > 0.2);
    }
}
