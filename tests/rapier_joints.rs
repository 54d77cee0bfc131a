//! Rapier as a witness on joints: the same scenes, data and step in both engines. Where there is an exact answer ours
//! reaches it and Rapier comes as near as it is known to. Its joints lose energy, and its springs are made by an implicit
//! step that damps them: there the exact answer decides, and Rapier is only shown to be near while little is lost.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // helpers of tests may, as tests do

#[path = "common/worlds.rs"]
mod worlds;

use culbuto::joint::{Coefficients, Given, Hold, JointDef, JointKind, Spring, Travel};
use culbuto::math::{PI, Real, Vec2, vec2};
use culbuto::shapes::Shape;
use culbuto::{BodyDef, BodyHandle, World};
use rapier2d_f64::prelude::{
    ColliderBuilder, GenericJoint, InteractionGroups, PhysicsWorld, PrismaticJointBuilder,
    RevoluteJointBuilder, RigidBodyBuilder, RigidBodyHandle, RopeJointBuilder, SpringJointBuilder,
    Vector,
};
use worlds::APART;

const G: Real = 9.81;
const DT: Real = 1.0 / 60.0;

fn to_rapier(v: Vec2) -> Vector {
    Vector::new(v.x, v.y)
}

/// A scene in both engines; their first body stands for the world.
struct Both {
    ours: World,
    theirs: PhysicsWorld,
    post: RigidBodyHandle,
    bodies: Vec<(BodyHandle, RigidBodyHandle)>,
}

impl Both {
    fn new(gravity: Real) -> Self {
        let ours = World::new(vec2(0.0, -gravity)).unwrap();
        let mut theirs =
            PhysicsWorld { gravity: Vector::new(0.0, -gravity), ..PhysicsWorld::default() };
        theirs.integration_parameters.dt = DT;
        let post = theirs.insert_body(RigidBodyBuilder::fixed());
        Self { ours, theirs, post, bodies: Vec::new() }
    }

    /// A box of density 1 that touches nothing.
    fn add(&mut self, (width, height): (Real, Real), place: Vec2, velocity: Vec2) -> usize {
        let ours = self.ours.add_body(BodyDef {
            position: place,
            velocity,
            filter: APART,
            ..BodyDef::new(Shape::rectangle(width, height).unwrap())
        });
        let body = RigidBodyBuilder::dynamic()
            .translation(to_rapier(place))
            .linvel(to_rapier(velocity))
            .allow_fast_rotation(true)
            .can_sleep(false);
        let collider = ColliderBuilder::cuboid(width / 2.0, height / 2.0)
            .density(1.0)
            .collision_groups(InteractionGroups::none());
        let (theirs, _) = self.theirs.insert(body, collider);
        self.bodies.push((ours.unwrap(), theirs));
        self.bodies.len() - 1
    }

    /// Joins a body, or the world, to a body. Anchors are local.
    fn join(
        &mut self,
        (a, b): (Option<usize>, usize),
        [on_a, on_b]: [Vec2; 2],
        kind: JointKind,
        theirs: impl Into<GenericJoint>,
    ) {
        let def = JointDef::new(a.map(|a| self.bodies[a].0), self.bodies[b].0, kind);
        self.ours.add_joint(def.anchored_locally(on_a, on_b)).unwrap();
        let mut joint: GenericJoint = theirs.into();
        joint.set_local_anchor1(to_rapier(on_a));
        joint.set_local_anchor2(to_rapier(on_b));
        let first = a.map_or(self.post, |a| self.bodies[a].1);
        self.theirs.insert_impulse_joint(first, self.bodies[b].1, joint);
    }

    fn run(&mut self, seconds: Real) {
        let steps = (seconds / DT).round() as u32;
        self.ours.steps(DT, steps).unwrap();
        (0..steps).for_each(|_| self.theirs.step());
    }

    fn places(&self, k: usize) -> [Vec2; 2] {
        let theirs = self.theirs.bodies[self.bodies[k].1].translation();
        [self.ours.body(self.bodies[k].0).unwrap().position(), vec2(theirs.x, theirs.y)]
    }
}

/// Ours is within `ours` of the exact value, Rapier within `theirs`.
#[track_caller]
fn near(what: &str, [own, other]: [Vec2; 2], exact: Vec2, (ours, theirs): (Real, Real)) {
    let (own, other) = ((own - exact).norm(), (other - exact).norm());
    println!("{what}: ours {own:.1e} m off, Rapier {other:.1e}");
    assert!(own <= ours, "{what}: ours is {own:e} off");
    assert!(other <= theirs, "{what}: Rapier is {other:e} off");
}

fn hinge() -> JointKind {
    JointKind::Revolute { angle: None, travel: Travel::default() }
}

#[test]
fn a_pendulum_swings() {
    // A bar of 1 × 0.2 m pinned at its end, let go along +x: for 1 s, by the finest of our own runs (h/16, its error 256
    // times smaller than that of h).
    let swing = |parts: u32| {
        let mut both = Both::new(G);
        both.add((1.0, 0.2), vec2(0.5, 0.0), Vec2::zeros());
        let anchors = [Vec2::zeros(), vec2(-0.5, 0.0)];
        both.join((None, 0), anchors, hinge(), RevoluteJointBuilder::new());
        both.ours.set_substeps(4 * parts).unwrap();
        both.run(1.0);
        both.places(0)
    };
    let exact = swing(16)[0];
    // Rapier: 47 % of the energy in a minute (catalogue, S9), hence some 1 % in a second.
    near("pendulum", swing(1), exact, (2e-3, 0.1));
}

#[test]
fn a_slider_slides() {
    // Down an axis of slope ¾: ½g sin α t².
    let mut both = Both::new(G);
    both.add((0.5, 0.5), Vec2::zeros(), Vec2::zeros());
    let axis = vec2(0.8, -0.6);
    let kind =
        JointKind::Prismatic { axis: Given::Local(axis), angle: None, travel: Travel::default() };
    let theirs = PrismaticJointBuilder::new(to_rapier(axis));
    both.join((None, 0), [Vec2::zeros(); 2], kind, theirs);
    both.run(1.0);
    // Rapier is ½g sin α·ht too far, h a quarter of the step, and soft across.
    near("slider", both.places(0), axis * (0.5 * G * 0.6), (1e-10, 0.05));
}

#[test]
fn a_rope_catches() {
    // Falls ½ m, is caught at 1 m, and hangs.
    let mut both = Both::new(G);
    both.add((0.2, 0.2), vec2(0.0, -0.5), Vec2::zeros());
    let kind = JointKind::Distance { length: None, hold: Hold::Free, min: 0.0, max: Some(1.0) };
    both.join((None, 0), [Vec2::zeros(); 2], kind, RopeJointBuilder::new(1.0));
    both.run(3.0);
    near("rope", both.places(0), vec2(0.0, -1.0), (1e-9, 0.02));
}

#[test]
fn a_chain_of_ten_hangs() {
    // Let go a little aside it swings about the vertical; its end stays at its length. Both keep it within what they are
    // known for: Rapier's joints are springs that give.
    let mut both = Both::new(G);
    for k in 0..10_u8 {
        let top = -0.4 * Real::from(k);
        let b = both.add((0.1, 0.4), vec2(0.0, top - 0.2), vec2(0.05, 0.0));
        let a = b.checked_sub(1);
        let on_a = if a.is_some() { vec2(0.0, -0.2) } else { Vec2::zeros() };
        both.join((a, b), [on_a, vec2(0.0, 0.2)], hinge(), RevoluteJointBuilder::new());
    }
    both.run(2.0);
    let stretch = |places: [Vec2; 2]| places.map(|p| vec2(p.norm(), 0.0));
    // The swing of some 5 cm shortens the way to the end by less than a millimetre.
    near("length of a chain", stretch(both.places(9)), vec2(3.8, 0.0), (2e-3, 0.05));
    let [ours, theirs] = both.places(9);
    println!("ends {:.3} m apart", (ours - theirs).norm());
    assert!((ours - theirs).norm() < 0.1);
}

#[test]
fn a_spring_swings_here_and_dies_there() {
    // x₀ cos ωt, 1 Hz, for ten periods.
    let mut both = Both::new(0.0);
    both.add((0.5, 0.5), vec2(1.25, 0.0), Vec2::zeros());
    let mass = 0.25;
    let stiffness = mass * (2.0 * PI) * (2.0 * PI);
    let hold = Hold::Spring(Spring::Constants(Coefficients { stiffness, damping: 0.0 }));
    let kind = JointKind::Distance { length: Some(1.0), hold, min: 0.0, max: None };
    let theirs = SpringJointBuilder::new(1.0, stiffness, 0.0);
    both.join((None, 0), [Vec2::zeros(); 2], kind, theirs);
    both.run(0.25);
    // A quarter of a period: both near the middle.
    near("spring, ¼ s", both.places(0), vec2(1.0, 0.0), (1e-3, 0.05));
    both.run(9.75);
    let [ours, theirs] = both.places(0).map(|p| p.x - 1.25);
    println!("spring, 10 s: ours {ours:.1e} m off, Rapier {theirs:.1e}");
    assert!(ours.abs() < 1e-3 * 0.25, "{ours:e}");
    // What is lost there is the other's, not ours: the exact amplitude is kept here to 0.1 %.
    assert!(theirs.abs() <= 0.5, "{theirs:e}");
}
