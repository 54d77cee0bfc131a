//! Problems of the catalogue whose answers are known, to a tolerance.

use std::f64::consts::TAU;

use culbuto::body::BodyKind;
use culbuto::joint::{Hold, JointKind};
use culbuto::math::{Real, Vec2, vec2};
use culbuto::{BodyDef, JointDef, World};

use crate::scenes::{G, chain, double_pendulum, pendulum, rod, spring, swing, world};
use crate::worlds::assert_below;

#[test]
fn s7_soft_distance_joint() {
    let answers = [
        (0.0, -0.202_254_248_594),
        (0.1, -0.044_247_103_839_6),
        (1.0, 3.484_487_624_79e-7),
        (2.0, 3.382_692_447_91e-3),
    ];
    for (damping_ratio, answer) in answers {
        let mut world = spring("leapfrog", damping_ratio);
        let start = world.energy().unwrap().balance();
        world.advance(1.3, 1e-12).unwrap();
        let x = world.bodies().poses[0].position.x - 1.0;
        assert_below("S7", (x - answer).abs(), 1e-9);
        let energy = world.energy().unwrap();
        // Of 5 J; what the damper took is a quadrature of the same order.
        assert_below("S7 balance", (energy.balance() - start).abs(), 1e-9);
        assert_eq!(energy.dissipated > 0.0, damping_ratio > 0.0);
    }
}

#[test]
fn s8_two_masses_on_a_spring() {
    let mut world = world("leapfrog");
    world.set_gravity(vec2(0.0, 0.0)).unwrap();
    let at = |x: Real, m: Real| BodyDef { position: vec2(x, 0.0), ..BodyDef::point(m) };
    let a = world.add_body(at(-0.9, 1.0)).unwrap();
    let b = world.add_body(at(0.3, 3.0)).unwrap();
    let kind =
        JointKind::Distance { length: Some(1.0), hold: Hold::soft(1.5, 0.0), min: 0.0, max: None };
    world.add_joint(JointDef::new(a, b, kind)).unwrap();
    world.advance(2.1, 1e-12).unwrap();
    // ω = √(k/0.75) is the frequency asked for, as the effective mass is 0.75.
    let exact = 1.0 + 0.2 * (TAU * 1.5 * 2.1).cos();
    let [p, q] = [0, 1].map(|i| world.bodies().poses[i].position);
    assert_below("S8", ((q - p).norm() - exact).abs(), 1e-9);
    assert_below("centre", ((p + 3.0 * q) / 4.0).norm(), 1e-14);
    assert_below("momentum", world.momentum().norm(), 1e-14);
}

#[test]
fn s9_point_pendulum() {
    let mut world = pendulum("leapfrog");
    world.advance(10.0, 1e-11).unwrap();
    assert_below("S9", (swing(world.bodies().poses[0].position) - 0.278_680_673_570).abs(), 1e-9);
    assert_below("gap", world.joint(world.joint_handles()[0]).unwrap().gap(), 1e-15);
    // A point has no rotation that a joint could turn.
    assert_eq!(world.bodies().poses[0].angle, 0.0);
}

#[test]
fn s10_rod_pendulum() {
    let mut world = world("leapfrog");
    let body = world.add_body(rod(vec2(0.0, 0.0), 0.0)).unwrap();
    world.add_joint(JointDef::revolute(None, body).at(vec2(0.0, 0.0))).unwrap();
    world.advance(10.0, 1e-11).unwrap();
    let from_below = world.bodies().poses[0].angle + TAU / 4.0;
    assert_below("S10", (from_below - 0.770_957_622_575).abs(), 1e-9);
}

#[test]
fn s11_double_pendulum() {
    let answers = [
        (1.0, vec2(-1.298_461_242_98, -0.698_310_920_025)),
        (3.0, vec2(1.092_597_830_17, -0.958_835_114_754)),
        (5.0, vec2(1.381_623_184_10, -0.579_242_574_199)),
    ];
    for (time, answer) in answers {
        let mut world = double_pendulum("leapfrog");
        world.advance(time, 1e-13).unwrap();
        assert_below("S11", (world.bodies().poses[1].position - answer).norm(), 1e-11);
        assert_below("energy", world.energy().unwrap().balance().abs(), 1e-11);
    }
    let exact = vec2(1.092_597_830_169_892, -0.958_835_114_754_420_9);
    for (tolerance, most, error) in [(5e-6, 700, 2e-6), (1e-11, 4000, 1e-11)] {
        let mut world = double_pendulum("leapfrog");
        world.advance(3.0, tolerance).unwrap();
        let apart = (world.bodies().poses[1].position - exact).norm();
        println!("S11: {apart:.1e} m with {} solves", world.report().solves);
        assert_below("S11 at t = 3", apart, error);
        assert!(world.report().solves <= most, "{}", world.report().solves);
    }
}

/// A quarter of the period of the lowest mode of a hanging chain, measured and by theory; `zero` is the first zero of L_n.
fn quarter_period(n: usize, zero: Real) -> (Real, Real) {
    // ω² = (g/l)·x; of amplitude small enough that the period's relative error, some (amplitude)²/16, is below 1e-9.
    let length = 0.5;
    let omega = (G / length * zero).sqrt();
    // The lowest mode: displacements L_k(x), from below.
    let shape: Vec<Real> = (0..n).map(|k| laguerre(k, zero)).collect();
    let amplitude = 1e-5 * length;
    let mut world = world("leapfrog");
    let places: Vec<Vec2> = (0..n)
        .map(|k| vec2(amplitude * shape[n - 1 - k], 0.0))
        .scan(vec2(0.0, 0.0), |above, at: Vec2| {
            let dx = at.x - above.x;
            *above = vec2(at.x, above.y - (length * length - dx * dx).sqrt());
            Some(*above)
        })
        .collect();
    let mut above = None;
    for (k, place) in places.iter().enumerate() {
        let body = world.add_body(BodyDef { position: *place, ..BodyDef::point(1.0) }).unwrap();
        let from = if k == 0 { vec2(0.0, 0.0) } else { places[k - 1] };
        world.add_joint(JointDef::distance(above, body).anchored(from, *place)).unwrap();
        above = Some(body);
    }
    // A quarter of the period, where the mode passes the middle; then Newton's step to the crossing itself.
    let quarter = TAU / omega / 4.0;
    world.advance(quarter, 1e-13).unwrap();
    let last = n - 1;
    let off = world.bodies().poses[last].position.x / world.bodies().twists[last].linear.x;
    (quarter - off, quarter)
}

/// L_k(x).
fn laguerre(k: usize, x: Real) -> Real {
    let (mut before, mut now) = (0.0, 1.0);
    for i in 0..k {
        let i = i as Real;
        (before, now) = (now, ((2.0 * i + 1.0 - x) * now - i * before) / (i + 1.0));
    }
    now
}

#[test]
fn s14_hanging_chain() {
    for (n, zero) in [(3, 0.415_774_556_783), (5, 0.263_560_319_718), (10, 0.137_793_470_540)] {
        let (measured, exact) = quarter_period(n, zero);
        println!("S14: N = {n}: quarter {measured} against {exact}");
        assert_below("S14", (measured / exact - 1.0).abs(), 1e-8);
    }
}

/// Angles of the rods of a catenary of n rods from one end, and H over the weight of all: with H and the vertical load
/// V_k = W(½ − (k + ½)/n) at the middle of rod k, tan θ_k = V_k/H.
fn catenary(n: usize, length: Real, span: Real) -> (Vec<Real>, Real) {
    let angles = |h: Real| -> Vec<Real> {
        let load = |k: usize| 0.5 - (k as Real + 0.5) / n as Real;
        (0..n).map(|k| -(load(k) / h).atan()).collect()
    };
    let width =
        |h: Real| -> Real { angles(h).iter().map(|angle| length / n as Real * angle.cos()).sum() };
    let (mut low, mut high) = (1e-3, 10.0);
    for _ in 0..200 {
        let middle = 0.5 * (low + high);
        *(if width(middle) < span { &mut low } else { &mut high }) = middle;
    }
    (angles(low), low)
}

#[test]
fn q1_catenary() {
    let answers =
        [(10, 0.337_301_091_711, 0.533_728_851_647), (20, 0.337_976_109_594, 0.531_583_133_233)];
    for (n, horizontal, sag) in answers {
        let (angles, h) = catenary(n, 2.0, 1.6);
        assert_below("H/W", (h - horizontal).abs(), 1e-11);
        let part = 2.0 / n as Real;
        let mut world = world("leapfrog");
        let mut joint = vec2(0.0, 0.0);
        let mut before = None;
        for angle in &angles {
            let way = vec2(angle.cos(), angle.sin()) * part;
            let inertia = Some(part * part / 12.0);
            let def = BodyDef {
                position: joint + way * 0.5,
                angle: *angle,
                inertia,
                ..BodyDef::point(1.0)
            };
            let body = world.add_body(def).unwrap();
            world.add_joint(JointDef::revolute(before, body).at(joint)).unwrap();
            before = Some(body);
            joint += way;
        }
        world.add_joint(JointDef::revolute(before, None).at(joint)).unwrap();
        assert_below("span", (joint - vec2(1.6, 0.0)).norm(), 1e-13);
        world.advance(1.0, 1e-10).unwrap();
        let weight = n as Real * G;
        let ends = [world.joint_handles()[0], world.joint_handles()[n]];
        let reactions = ends.map(|end| world.joint(end).unwrap().reaction().force);
        // On the first rod, and on the world at the last.
        assert_below("H", (reactions[0].x / weight + horizontal).abs(), 1e-9);
        assert_below("V", (reactions[0].y / weight - 0.5).abs(), 1e-9);
        assert_below("H", (reactions[1].x / weight + horizontal).abs(), 1e-9);
        assert_below("V", (reactions[1].y / weight + 0.5).abs(), 1e-9);
        let lowest = world.joint_handles()[n / 2];
        let bottom = world.joint(lowest).unwrap().anchors()[0];
        assert_below("sag", (bottom.y + sag).abs(), 1e-9);
    }
}

#[test]
fn q2_heavy_end_of_a_chain() {
    for ratio in [1.0, 1e2, 1e4, 1e6] {
        let mut world = chain("leapfrog", 20, ratio);
        world.advance(1.0, 1e-10).unwrap();
        for (k, handle) in world.joint_handles().iter().enumerate() {
            let joint = world.joint(*handle).unwrap();
            // Gaps are closed to the rounding of places: 4ε for each body, some 20 m away.
            assert_below("gap", joint.gap(), 2.0 * 4.0 * Real::EPSILON * 20.0);
            let below = (19 - k) as Real + ratio;
            let force = joint.reaction().force;
            assert_below("tension", (force.y / (below * G) - 1.0).abs(), 1e-10);
        }
        let end = world.bodies().poses[19].position;
        assert_below("stretch", (end - vec2(0.0, -20.0)).norm(), 1e-10);
    }
}

#[test]
fn q4_grab_holds_a_weight() {
    for hold in [Hold::Rigid, Hold::soft(5.0, 1.0)] {
        let mut world = world("leapfrog");
        let body = world.add_body(BodyDef::point(3.0)).unwrap();
        let kind = JointKind::Grab { hold, max_force: None };
        world.add_joint(JointDef::new(None, body, kind)).unwrap();
        world.advance(3.0, 1e-14).unwrap();
        let omega = TAU * 5.0;
        let sag = if hold == Hold::Rigid { 0.0 } else { G / (omega * omega) };
        assert_below("Q4", (world.bodies().poses[0].position.y + sag).abs(), 1e-12);
    }
}

#[test]
fn a_crank_that_turns_as_it_is_told_drives_a_rod() {
    // A kinematic crank of radius 0.3 turns at 2 rad/s and carries the end of a free rod without gravity: the work it does
    // is the rod's energy.
    let mut world = World::new(vec2(0.0, 0.0)).unwrap();
    let crank = BodyDef { kind: BodyKind::Kinematic, angular_velocity: 2.0, ..BodyDef::default() };
    let crank = world.add_body(crank).unwrap();
    let body = world.add_body(rod(vec2(0.3, 0.0), 0.4)).unwrap();
    world.body_mut(body).unwrap().set_velocity(vec2(0.0, 0.6)).unwrap();
    world.add_joint(JointDef::revolute(crank, body).at(vec2(0.3, 0.0))).unwrap();
    let start = world.energy().unwrap();
    world.advance(2.0, 1e-12).unwrap();
    let end = world.energy().unwrap();
    assert_below("balance", (end.balance() - start.balance()).abs(), 1e-10);
    assert!(end.work.abs() > 1e-3);
    let pin = vec2(4.0_f64.cos(), 4.0_f64.sin()) * 0.3;
    let anchors = world.joint(world.joint_handles()[0]).unwrap().anchors();
    assert_below("pin", (anchors[0] - pin).norm() + (anchors[1] - pin).norm(), 1e-14);
}
