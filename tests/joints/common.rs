//! Random pairs of bodies, and joints for them.

use culbuto::joint::{Given, Hold, JointDef, JointKind, Motor, Spring, Travel};
use culbuto::math::{Real, Vec2, vec2};
use culbuto::shapes::Shape;
use culbuto::{BodyDef, World};
use proptest::prelude::*;

use crate::worlds::APART;

pub const DT: Real = 1.0 / 60.0;
/// Length of a substep (s).
pub const H: Real = DT / 4.0;

/// A part of the cases: each of them steps a world.
pub fn fewer(part: u32) -> ProptestConfig {
    let cases = (ProptestConfig::default().cases / part).max(4);
    ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() }
}

/// A box that moves and touches nothing.
#[derive(Clone, Copy, Debug)]
pub struct Thrown {
    pub size: (Real, Real),
    pub density: Real,
    pub place: Vec2,
    pub angle: Real,
    pub velocity: Vec2,
    pub spin: Real,
}

impl Thrown {
    pub fn def(&self) -> BodyDef {
        BodyDef {
            position: self.place,
            angle: self.angle,
            velocity: self.velocity,
            angular_velocity: self.spin,
            density: self.density,
            filter: APART,
            ..BodyDef::new(Shape::rectangle(self.size.0, self.size.1).unwrap())
        }
    }
}

pub fn vector(size: Real) -> impl Strategy<Value = Vec2> {
    (-size..size, -size..size).prop_map(|(x, y)| vec2(x, y))
}

/// One left of the origin, one right of it, up to 1e4 times as heavy as one another.
pub fn pairs() -> impl Strategy<Value = [Thrown; 2]> {
    let one =
        ((0.3..1.0_f64, 0.3..1.0_f64), -1.0..1.0_f64, vector(0.2), -3.0..3.0_f64, vector(2.0));
    prop::array::uniform2((one, -3.0..3.0_f64)).prop_map(|bodies| {
        let body = |k: usize| {
            let ((size, power, off, angle, velocity), spin) = bodies[k];
            let place = off + vec2(if k == 0 { -0.8 } else { 0.8 }, 0.0);
            Thrown { size, density: 10.0_f64.powf(2.0 * power), place, angle, velocity, spin }
        };
        [body(0), body(1)]
    })
}

/// A joint between two bodies: what it does, and where it holds them in the world.
#[derive(Clone, Copy, Debug)]
pub struct Tied {
    pub kind: JointKind,
    pub anchors: [Vec2; 2],
}

impl Tied {
    pub fn join(&self, world: &mut World, [a, b]: [usize; 2]) {
        let handles = world.bodies().handles();
        let def = JointDef::new(handles[a], handles[b], self.kind);
        world.add_joint(def.anchored(self.anchors[0], self.anchors[1])).unwrap();
    }
}

/// Two bodies without gravity, joined.
pub fn joined(bodies: &[Thrown; 2], tied: &Tied) -> World {
    let mut world = World::new(vec2(0.0, 0.0)).unwrap();
    for body in bodies {
        world.add_body(body.def()).unwrap();
    }
    tied.join(&mut world, [0, 1]);
    world
}

fn holds() -> impl Strategy<Value = Hold> {
    prop_oneof![
        2 => Just(Hold::Rigid),
        2 => (0.5..20.0_f64, 0.0..2.0_f64).prop_map(|(hertz, zeta)| Hold::soft(hertz, zeta)),
    ]
}

fn motors() -> impl Strategy<Value = Option<Motor>> {
    let motor = (-3.0..3.0_f64, prop::option::of(0.0..5.0_f64));
    prop::option::of(motor.prop_map(|(speed, max)| Motor { speed, max }))
}

fn springs() -> impl Strategy<Value = Spring> {
    (0.5..5.0_f64, 0.0..1.0_f64).prop_map(|(hertz, zeta)| Spring::new(hertz, zeta))
}

fn travels() -> impl Strategy<Value = Travel> {
    let limits = prop::option::of((0.1..1.0_f64, 0.1..1.0_f64).prop_map(|(a, b)| [-a, b]));
    (limits, motors(), prop::option::of(springs()), -0.3..0.3_f64)
        .prop_map(|(limits, motor, spring, rest)| Travel { limits, motor, spring, rest })
}

fn axes() -> impl Strategy<Value = Given> {
    (-3.1..3.1_f64).prop_map(|angle| Given::World(vec2(angle.cos(), angle.sin())))
}

/// Joints that hold two points together, or let one slide along an axis.
pub fn at_a_point() -> impl Strategy<Value = Tied> {
    let kinds = prop_oneof![
        travels().prop_map(|travel| JointKind::Revolute { angle: None, travel }),
        (axes(), travels()).prop_map(|(axis, travel)| JointKind::Prismatic {
            axis,
            angle: None,
            travel
        }),
        (holds(), holds()).prop_map(|(linear, angular)| JointKind::Weld {
            angle: None,
            linear,
            angular
        }),
        (axes(), holds(), motors()).prop_map(|(axis, suspension, motor)| JointKind::Wheel {
            axis,
            suspension,
            limits: Some([-0.3, 0.4]),
            motor,
        }),
    ];
    (kinds, vector(0.3)).prop_map(|(kind, point)| Tied { kind, anchors: [point; 2] })
}

/// Joints whose anchors are, or may get, apart.
pub fn apart() -> impl Strategy<Value = Tied> {
    let bound = || prop::option::of(0.0..5.0_f64);
    let kinds = prop_oneof![
        holds().prop_map(|hold| JointKind::Distance { length: None, hold, min: 0.0, max: None }),
        (0.2..0.8_f64, 1.8..2.5_f64).prop_map(|(min, max)| JointKind::Distance {
            length: None,
            hold: Hold::Free,
            min,
            max: Some(max),
        }),
        (holds(), bound()).prop_map(|(hold, max_force)| JointKind::Grab { hold, max_force }),
        (vector(0.5), holds(), holds(), bound(), bound()).prop_map(
            |(offset, linear, angular, max_force, max_torque)| JointKind::Motor {
                offset,
                angle: None,
                linear,
                angular,
                max_force,
                max_torque,
            }
        ),
        (0.0..5.0_f64, 0.0..5.0_f64)
            .prop_map(|(max_force, max_torque)| JointKind::Friction { max_force, max_torque }),
        springs().prop_map(|spring| JointKind::AngleSpring { angle: None, spring }),
        (0.1..0.5_f64).prop_map(|step| JointKind::Ratchet { step, phase: 0.05 }),
        (axes(), 0.2..0.6_f64).prop_map(|(axis, radius)| JointKind::Rack {
            axis,
            radius,
            offset: None
        }),
    ];
    (kinds, vector(0.3), vector(0.3))
        .prop_map(|(kind, a, b)| Tied { kind, anchors: [a + vec2(-0.7, 0.0), b + vec2(0.7, 0.0)] })
}

/// Any joint that acts between two bodies alone: not through a gearbox or over pulleys, which are fixed to the world.
pub fn joints() -> impl Strategy<Value = Tied> {
    prop_oneof![at_a_point(), apart()]
}

/// Σm|v| and Σ(m|r||v| + I|ω|): what momenta are measured by.
pub fn scales(world: &World, about: Vec2) -> (Real, Real) {
    let bodies = world.bodies();
    let of = |i: usize| {
        let (pose, twist, mass) = (&bodies.poses[i], &bodies.twists[i], &bodies.masses[i]);
        let p = mass.mass * twist.linear.norm();
        (p, p * (pose.position - about).norm() + mass.inertia * twist.angular.abs())
    };
    (0..bodies.len()).map(of).fold((0.0, 0.0), |(a, b), (c, d)| (a + c, b + d))
}

/// A rod along x that hangs in gravity from the world by a pin at its left end, and further ones on its right.
pub fn chain(world: &mut World, links: usize, from: Vec2) {
    let mut before = None;
    for i in 0..links {
        let left = from + vec2(i as Real, 0.0);
        let body = world
            .add_body(BodyDef {
                position: left + vec2(0.5, 0.0),
                filter: APART,
                ..BodyDef::new(Shape::rectangle(1.0, 0.1).unwrap())
            })
            .unwrap();
        world.add_joint(JointDef::revolute(before, body).at(left)).unwrap();
        before = Some(body);
    }
}
