//! The solver that takes all rows of a group at once: the laws hold with it as they do with sweeps, and both agree.

use culbuto::builders::RagdollDef;
use culbuto::math::{Real, vec2};
use culbuto::shapes::{Shape, ShapeDef};
use culbuto::solvers::Solver;
use culbuto::world::Snapshot;
use culbuto::{BodyDef, Part};
use proptest::prelude::*;

use crate::common::{DT, bin, fewer, floor, laws, pyramid, rush, surface, weightless};
use crate::laws::{energy_is_only_taken_and_booked, scales};
use crate::worlds::{assert_below, bits, bytes};

fn solvers() -> impl Strategy<Value = Solver> {
    prop::sample::select(vec![Solver::Newton, Solver::Auto])
}

proptest! {
    #![proptest_config(fewer(8))]

    /// Of Σm|v| and Σ(m|r||v| + I|ω|) at the start.
    #[test]
    fn no_collision_changes_momenta(bodies in rush(5), law in laws(), solver in solvers()) {
        let mut world = weightless(&bodies, law);
        world.set_solver(solver);
        let center = world.center_of_mass();
        let (linear, angular) = (world.momentum(), world.angular_momentum(center));
        let scale = scales(&world);
        world.steps(DT, 60).unwrap();
        let change = (world.momentum() - linear).norm();
        prop_assert!(change <= 1e-12 * scale.0, "momentum: {:e} of {:e}", change, scale.0);
        let change = (world.angular_momentum(center) - angular).abs();
        prop_assert!(change <= 1e-12 * scale.1, "angular momentum: {:e} of {:e}", change, scale.1);
    }

    #[test]
    fn piles_that_fall_only_take_energy_and_book_it(bodies in rush(8), law in laws(), solver in solvers()) {
        let mut world = bin(&bodies);
        world.set_impact_law(law);
        world.set_solver(solver);
        energy_is_only_taken_and_booked(&mut world, 120)?;
    }

    #[test]
    fn the_same_bits_twice_and_from_bytes(bodies in rush(6), before in 0..60_u32, solver in solvers()) {
        let mut world = bin(&bodies);
        world.set_solver(solver);
        world.steps(DT, before).unwrap();
        let mut copy = Snapshot::from_bytes(&bytes(&world), Vec::new()).unwrap().to_world();
        world.steps(DT, 60).unwrap();
        copy.steps(DT, 60).unwrap();
        prop_assert!(bits(&world) == bits(&copy), "the copy goes on differently");
    }
}

/// Where the load of each contact is known, both solvers find it: k bricks lie on each one below.
#[test]
fn both_solvers_find_the_loads_of_a_stack() {
    for solver in [Solver::Sweep, Solver::Newton, Solver::Auto] {
        let mut world = floor(0.6);
        world.set_solver(solver);
        for k in 0..8 {
            let place = vec2(0.0, 0.5 + Real::from(k));
            let shape = Shape::rectangle(1.0, 1.0).unwrap();
            let def =
                BodyDef { position: place, surface: surface(0.6, 0.0), ..BodyDef::new(shape) };
            world.add_body(def).unwrap();
        }
        world.steps(DT, 240).unwrap();
        let h = DT / Real::from(world.settings().substeps);
        let mut loads: Vec<Real> = (world.contacts().iter())
            .map(|contact| contact.normal_impulses.iter().sum::<Real>() / h)
            .collect();
        loads.sort_by(Real::total_cmp);
        let exact = if solver == Solver::Sweep { 1e-3 } else { 1e-7 };
        for (k, load) in (1..).zip(&loads) {
            assert_below("load of a box", (load / (10.0 * Real::from(k)) - 1.0).abs(), exact);
        }
    }
}

/// A board on four legs in a row, whose loads no law of rigid bodies tells: they bear its weight, and share it as symmetrically as it stands,
/// also when one leg came down first.
#[test]
fn a_table_on_four_legs_bears_its_weight_evenly() {
    for tilt in [0.0, 0.02] {
        let mut world = floor(0.5);
        world.set_solver(Solver::Newton);
        let leg = |x: Real| {
            let center = vec2(x, -0.55);
            Shape::new(ShapeDef::Box { width: 0.1, height: 1.0, center, angle: 0.0 }).unwrap()
        };
        let legs = [-1.5, -0.5, 0.5, 1.5].map(leg);
        let board = Shape::rectangle(4.0, 0.1).unwrap();
        let parts: Vec<Part> = legs.into_iter().chain([board]).map(Part::from).collect();
        let position = vec2(0.0, 1.05 + 2.0 * tilt);
        let table = BodyDef { position, angle: tilt, ..BodyDef::compound(parts) };
        let table = world.add_body(table).unwrap();
        world.steps(DT, 240).unwrap();
        let mut feet = world.contacts().to_vec();
        assert_eq!(feet.len(), 4);
        feet.sort_by(|a, b| a.points[0].x.total_cmp(&b.points[0].x));
        let h = DT / Real::from(world.settings().substeps);
        let weight = 10.0 * world.body(table).unwrap().mass().mass;
        let loads: Vec<Real> = (feet.iter())
            .map(|foot| foot.normal_impulses.iter().sum::<Real>() / (h * weight))
            .collect();
        assert_below("weight", (loads.iter().sum::<Real>() - 1.0).abs(), 1e-9);
        for k in 0..2 {
            assert_below("loads of mirrored legs", (loads[k] - loads[3 - k]).abs(), 1e-6);
        }
    }
}

/// Joints and contacts in one system: a ragdoll that falls on the ground keeps together, takes energy only, and comes to rest.
#[test]
fn a_ragdoll_falls_on_the_ground() {
    for solver in [Solver::Newton, Solver::Auto] {
        let mut world = floor(0.6);
        world.set_solver(solver);
        let def = RagdollDef { position: vec2(0.0, 1.0), ..RagdollDef::new(1.8, 75.0) };
        let ragdoll = def.build(&mut world).unwrap();
        let start = world.energy().unwrap().balance();
        for _ in 0..300 {
            world.step(DT).unwrap();
            assert!(ragdoll.parts.gap(&world) < 1e-6);
        }
        let end = world.energy().unwrap().balance();
        assert_below("balance", (end - start).abs() / start.abs().max(75.0 * 10.0), 1e-9);
    }
}

/// What no solver can satisfy: the world stays finite, and the report says what is lacking.
#[test]
fn hopeless_input_stays_finite_and_is_reported() {
    for solver in [Solver::Newton, Solver::Auto] {
        let mut world = floor(1e6);
        world.set_solver(solver);
        for k in 0..100 {
            let mass = if k % 7 == 0 { 1e12 } else { 1.0 };
            let place = vec2(0.01 * Real::from(k % 10), 0.5 + 0.01 * Real::from(k / 10));
            let shape = Shape::rectangle(1.0, 1.0).unwrap();
            let def = BodyDef {
                mass: Some(mass),
                position: place,
                surface: surface(1e6, 0.0),
                ..BodyDef::new(shape)
            };
            world.add_body(def).unwrap();
        }
        for _ in 0..10 {
            world.step(DT).unwrap();
            assert!(world.report().residual.is_finite());
        }
        let fast = world.bodies().twists.iter().map(|v| v.linear.norm()).fold(0.0, Real::max);
        assert!(fast.is_finite() && fast < 1e3, "{fast:e}");
    }
}

#[test]
fn a_pyramid_stands_as_well_as_by_sweeps() {
    let mut world = pyramid(10);
    world.set_solver(Solver::Newton);
    let start = world.bodies().poses.clone();
    world.steps(DT, 300).unwrap();
    let bodies = world.bodies();
    let way = bodies.poses.iter().zip(&start).map(|(a, b)| (a.position - b.position).norm());
    assert_below("way in 5 s", way.fold(0.0, Real::max), 2e-3);
    let speed = bodies.twists.iter().map(|v| v.linear.norm()).fold(0.0, Real::max);
    assert_below("speed", speed, 1e-3);
}
