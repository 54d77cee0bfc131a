//! Runs to a tolerance where the fastest rates are far beyond what moves: Radau's method takes the steps that the motion
//! asks for.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // helpers of tests may, as tests do

#[path = "common/worlds.rs"]
mod worlds;

use std::f64::consts::{FRAC_PI_2, TAU};

use culbuto::body::Locks;
use culbuto::forces::{Air, BodyColumns, BoxError, FieldFacts, ForceField};
use culbuto::joint::Hold;
use culbuto::math::{Real, Vec2, Wrench, vec2};
use culbuto::shapes::Shape;
use culbuto::world::StepReport;
use culbuto::{BodyDef, JointDef, World};
use proptest::prelude::*;
use worlds::{assert_below, reference, world_with};

const G: Real = 9.81;

fn shown(report: &StepReport) -> String {
    format!(
        "{} steps ({} stiff), {} rejected, {} evaluations, estimate {:.1e}",
        report.steps,
        report.stiff_steps,
        report.rejected,
        report.evaluations,
        report.estimate.unwrap()
    )
}

/// Van der Pol's oscillator as a force: x″ = ((1 − x²)x′ − x)/ε.
struct VanDerPol {
    epsilon: Real,
}

impl ForceField for VanDerPol {
    fn name(&self) -> &'static str {
        "van der Pol"
    }

    fn add_forces(
        &self,
        _: Real,
        bodies: &BodyColumns<'_>,
        out: &mut [Wrench],
    ) -> Result<(), BoxError> {
        for ((pose, twist), out) in bodies.poses.iter().zip(bodies.twists).zip(out) {
            let (x, v) = (pose.position.x, twist.linear.x);
            out.force.x += ((1.0 - x * x) * v - x) / self.epsilon;
        }
        Ok(())
    }

    fn potential(&self, _: Real, _: &BodyColumns<'_>) -> Result<Option<Real>, BoxError> {
        Ok(None)
    }

    fn facts(&self) -> FieldFacts {
        FieldFacts { velocity_dependent: true, conservative: false, internal: false }
    }
}

fn van_der_pol(epsilon: Real) -> World {
    let mut world = world_with("leapfrog");
    world.add_field(VanDerPol { epsilon });
    world.add_body(BodyDef { position: vec2(2.0, 0.0), ..BodyDef::point(1.0) }).unwrap();
    world
}

#[test]
fn van_der_pols_oscillator_follows_the_tolerance() {
    // At ε = 1e-6 and t = 2: Mazzia, Magherini, "Test set for initial value problems" (2008), problem VDPOL.
    let exact = 1.706_167_732_170_483;
    for power in 4..=10 {
        let tolerance = Real::powi(10.0, -power);
        let mut world = van_der_pol(1e-6);
        world.advance(2.0, tolerance).unwrap();
        let off = (world.bodies().poses[0].position.x - exact).abs();
        println!("1e-{power}: off by {off:.1e}; {}", shown(world.report()));
        assert_below("place", off, 10.0 * tolerance);
        let report = world.report();
        assert!(report.estimate.unwrap() > off, "what the run says of itself");
        // DOP853 takes 600 000, as many as its stability asks for.
        assert!(report.steps < 1000 && report.stiff_steps > 0, "{}", shown(report));
    }
}

#[test]
fn samples_of_a_stiff_run_do_not_change_it() {
    let times: Vec<Real> = (0..=40).map(|k| 0.05 * Real::from(k)).collect();
    let (mut sampled, mut plain) = (van_der_pol(1e-6), van_der_pol(1e-6));
    let whole = sampled.advance_sampled(2.0, 1e-8, &times).unwrap();
    plain.advance(2.0, 1e-8).unwrap();
    assert_eq!(sampled.bodies().poses, plain.bodies().poses);
    assert_eq!(sampled.bodies().twists, plain.bodies().twists);
    for (k, time) in times.iter().enumerate().skip(1) {
        let mut fine = van_der_pol(1e-6);
        fine.advance(*time, 1e-11).unwrap();
        let off = (whole.pose(k, 0).position - fine.bodies().poses[0].position).norm();
        // Where x leaps at 1e6 m/s, the moment of the leap, off by 1e-8 of some hundred steps, counts.
        let leaps = fine.bodies().twists[0].linear.norm();
        assert_below("sample", off, 1e-7 * (1.0 + leaps));
    }
}

/// A point on a spring damped as fast as can be, of length 1, from the side.
fn pendulum(hertz: Real) -> World {
    let mut world = World::new(vec2(0.0, -G)).unwrap();
    let bob = BodyDef { position: vec2(1.0, 0.0), ..BodyDef::point(1.0) };
    let bob = world.add_body(bob).unwrap();
    let def = JointDef::spring(None, bob, Hold::soft(hertz, 1.0));
    world.add_joint(def.anchored(vec2(0.0, 0.0), vec2(1.0, 0.0))).unwrap();
    world
}

/// Where a pendulum on a rod is.
fn on_a_rod(time: Real) -> Vec2 {
    let [angle, _] = reference(|_, [a, w]| [*w, -G * a.sin()], [FRAC_PI_2, 0.0], time, 200_000);
    vec2(angle.sin(), -angle.cos())
}

#[test]
fn a_stiff_damped_joint_moves_as_a_rod() {
    let exact = on_a_rod(10.0);
    // DOP853 takes 944 000 steps for the first and is at 6 ms after a million for the last.
    for (hertz, tolerance, within, most) in
        [(1e4, 1e-9, 1e-6, 10_000), (1e5, 1e-6, 1e-3, 20_000), (1e6, 1e-6, 1e-3, 50_000)]
    {
        let mut world = pendulum(hertz);
        world.advance(10.0, tolerance).unwrap();
        let report = world.report();
        let off = (world.bodies().poses[0].position - exact).norm();
        println!("{hertz} Hz, {tolerance:e}: off a rod's by {off:.1e}; {}", shown(report));
        assert_below("off a rod", off, within);
        assert!(report.steps < most && 2 * report.stiff_steps > report.steps);
    }
}

#[test]
fn a_step_that_went_astray_is_no_measure() {
    // The first step of DOP853 leaves the spring by far; measured against where it led to, that was within the tolerance, and the
    // point flew off at 1e14 m/s.
    let mut world = pendulum(1e3);
    world.advance(1.0, 1e-6).unwrap();
    let stretch = world.bodies().poses[0].position.norm() - 1.0;
    assert_below("stretch", stretch.abs(), 3.1 * G / (TAU * 1e3).powi(2));
}

#[test]
fn what_is_not_stiff_stays_with_dop853() {
    // A spring that swings visibly, however fast, must be followed.
    for hertz in [1.0, 1e3] {
        let mut world = world_with("leapfrog");
        let body = BodyDef { position: vec2(1.1, 0.0), ..BodyDef::point(1.0) };
        let body = world.add_body(body).unwrap();
        let kind = JointDef::spring(None, body, Hold::soft(hertz, 0.0));
        let def = kind.anchored(vec2(0.0, 0.0), vec2(1.1, 0.0));
        world.add_joint(def).unwrap();
        world.body_mut(body).unwrap().set_position(vec2(1.2, 0.0)).unwrap();
        world.advance(20.0 / hertz, 1e-9).unwrap();
        assert_eq!(world.report().stiff_steps, 0, "{}", shown(world.report()));
    }
}

proptest! {
    /// What starts at rest in the origin has no digits of its own that could say how exact it gets.
    #[test]
    fn constant_forces_are_met_at_any_step(dt in 1e-3..1e3_f64, torque in -5.0..5.0_f64) {
        let mut world = world_with("radau5");
        world.set_closed_form(false);
        world.set_gravity(vec2(0.0, -G)).unwrap();
        let point = BodyDef { inertia: Some(4.0), ..BodyDef::point(1.0) };
        let body = world.add_body(point).unwrap();
        world.body_mut(body).unwrap().set_force(Wrench { torque, ..Wrench::ZERO }).unwrap();
        world.step(dt).unwrap();
        let pose = world.bodies().poses[0];
        let off = (pose.position.y + 0.5 * G * dt * dt).abs() / (G * dt * dt);
        prop_assert!(off < 1e-13, "{:e}", off);
    }

    /// An axis that is locked stays to the last bit, also where factors exchange rows.
    #[test]
    fn locked_axes_stay_in_drag(
        x in any::<bool>(), speed in -5.0..5.0_f64, spin in -5.0..5.0_f64, angle in -1.5..1.5_f64, density in 1.0..3.0_f64,
        size in 0.01..0.03_f64, pull in 1.0..1e3_f64,
    ) {
        let mut world = world_with("radau5");
        world.set_air(Air { density, wind: vec2(0.0, 0.0) }).unwrap();
        world.set_gravity(if x { vec2(0.0, pull) } else { vec2(pull, 0.0) }).unwrap();
        // An L, which drag turns.
        let ell = [[0.0, 0.0], [3.0, 0.0], [3.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]]
            .map(|[x, y]| vec2(x, y) * size);
        let body = BodyDef {
            velocity: if x { vec2(0.0, speed) } else { vec2(speed, 0.0) },
            locks: Locks { x, y: !x, rotation: false },
            angle,
            angular_velocity: spin,
            drag_coefficient: 1.0,
            ..BodyDef::new(Shape::polygon(&ell).unwrap())
        };
        let body = world.add_body(body).unwrap();
        for _ in 0..20 {
            // Where drag turns it too fast for the step, the step is refused.
            if world.step(0.1).is_err() {
                break;
            }
            let along = world.body(body).unwrap().velocity();
            prop_assert!(if x { along.x == 0.0 } else { along.y == 0.0 }, "{}", along);
        }
    }
}
