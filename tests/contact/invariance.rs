//! Laws do not depend on where, which way round, how large and in which order.

use culbuto::body::ImpactLaw;
use culbuto::math::{Pose, Real, Rot, Twist, Vec2, vec2};
use culbuto::shapes::Shape;
use culbuto::{BodyDef, World};
use proptest::prelude::*;

use crate::common::{DT, Form, Thrown, fewer, fixed, laws, rush, surface, weightless};

/// How a scene is put down: turned, then mirrored, scaled and moved.
#[derive(Clone, Copy, Debug)]
struct Change {
    /// 1, or −1 for mirrored across the y axis.
    side: Real,
    turn: Real,
    /// Lengths; times go by its root.
    scale: Real,
    offset: Vec2,
}

const NONE: Change = Change { side: 1.0, turn: 0.0, scale: 1.0, offset: vec2(0.0, 0.0) };

impl Change {
    fn direction(&self, v: Vec2) -> Vec2 {
        let v = if self.turn == 0.0 { v } else { Rot::new(self.turn).apply(v) };
        vec2(self.side * v.x, v.y)
    }

    fn pose(&self, pose: &Pose) -> Pose {
        let position = self.direction(pose.position) * self.scale + self.offset;
        Pose::new(position, self.side * (pose.angle + self.turn))
    }

    /// Velocities go by the root of lengths, angular velocities by one over it.
    fn twist(&self, v: &Twist) -> Twist {
        let root = self.scale.sqrt();
        Twist::new(self.direction(v.linear) * root, self.side * v.angular / root)
    }

    /// Bodies above a floor, under gravity.
    fn world(&self, bodies: &[Thrown], law: ImpactLaw) -> World {
        let mut world = World::new(self.direction(vec2(0.0, -10.0))).unwrap();
        world.set_impact_law(law);
        let ground = BodyDef {
            shapes: vec![Shape::rectangle(20.0 * self.scale, 2.0 * self.scale).unwrap().into()],
            ..fixed(1.0, 1.0, vec2(0.0, 0.0))
        };
        let pose = self.pose(&Pose::new(vec2(0.0, -4.0), 0.0));
        let ground = BodyDef { position: pose.position, angle: pose.angle, ..ground };
        world.add_body(ground).unwrap();
        for body in bodies {
            let pose = self.pose(&Pose::new(body.place, body.angle));
            let twist = self.twist(&Twist::new(body.velocity, body.spin));
            let def = BodyDef {
                position: pose.position,
                angle: pose.angle,
                velocity: twist.linear,
                angular_velocity: twist.angular,
                shapes: body.form.parts(self.scale, self.side),
                ..body.def()
            };
            world.add_body(def).unwrap();
        }
        world
    }

    /// Largest difference, in units of the unchanged scene, within `span`.
    fn apart(&self, bodies: &[Thrown], law: ImpactLaw, span: Span) -> Real {
        let (mut one, mut other) = (NONE.world(bodies, law), self.world(bodies, law));
        let (mut impacts, mut worst) = (0, 0.0);
        for _ in 0..span.steps {
            one.step(DT).unwrap();
            other.step(DT * self.scale.sqrt()).unwrap();
            impacts += one.report().impacts;
            if impacts > span.impacts {
                break;
            }
            worst = Real::max(worst, self.difference(&one, &other));
        }
        worst
    }

    fn difference(&self, one: &World, other: &World) -> Real {
        let (one, other) = (one.bodies(), other.bodies());
        let mut worst: Real = 0.0;
        for i in 0..one.len() {
            // In centres of mass, which a body's frame turns about its own.
            let (a, b) = (self.pose(&one.poses[i]), other.poses[i]);
            let (u, v) = (self.twist(&one.twists[i]), other.twists[i]);
            let root = self.scale.sqrt();
            worst = worst
                .max((a.position - b.position).norm() / self.scale)
                .max((a.angle - b.angle).abs())
                .max((u.linear - v.linear).norm() / root)
                .max((u.angular - v.angular).abs() * root);
        }
        worst
    }
}

/// Disks that bounce: their impacts depend on no choice of a face or a piece, and on no order in which overlaps are
/// removed.
fn neat(bodies: &[Thrown]) -> Vec<Thrown> {
    let neat = |body: &Thrown| {
        let radius = 0.2 + 0.3 * body.friction.min(1.0);
        Thrown { form: Form::Disk(radius), restitution: body.restitution.max(0.3), ..body.clone() }
    };
    bodies.iter().map(neat).collect()
}

/// How long scenes are compared: until one of the numbers is reached.
#[derive(Clone, Copy)]
struct Span {
    steps: u32,
    impacts: u64,
}

/// Two bodies meet each other, and mostly the floor, a few times. A difference grows by a factor of perhaps ten an
/// impact, from 1e-15: it stays below 1e-8 for six or so. A light disk caught between a heavy one and the floor bounces
/// dozens of times within a step, and no digit is left.
const SHORT: Span = Span { steps: 40, impacts: 6 };

/// Where no digit changes, scenes may meet as often as they will.
const LONG: Span = Span { steps: 60, impacts: u64::MAX };

proptest! {
    #![proptest_config(fewer(4))]

    #[test]
    fn a_mirrored_scene_moves_as_the_mirror_image(bodies in rush(2), law in laws()) {
        let apart = Change { side: -1.0, ..NONE }.apart(&neat(&bodies), law, SHORT);
        prop_assert!(apart <= 1e-7, "{:e}", apart);
    }

    #[test]
    fn a_turned_scene_moves_as_the_scene_turned(bodies in rush(2), law in laws(), turn in -3.0..3.0_f64) {
        let apart = Change { turn, ..NONE }.apart(&neat(&bodies), law, SHORT);
        prop_assert!(apart <= 1e-7, "{:e}", apart);
    }

    /// 1 km away positions have 1e-13 m.
    #[test]
    fn a_scene_elsewhere_moves_as_the_scene_moved(bodies in rush(2), law in laws(), x in -1e3..1e3_f64, y in -1e3..1e3_f64) {
        let apart = Change { offset: vec2(x, y), ..NONE }.apart(&neat(&bodies), law, SHORT);
        prop_assert!(apart <= 1e-5, "{:e}", apart);
    }

    /// Froude: lengths by s and times by √s leave gravity as it is. By powers of 4 no digit changes: any
    /// difference is a length or a time hidden somewhere.
    #[test]
    fn a_scaled_scene_moves_the_same_to_the_last_bit(bodies in rush(4), law in laws(), k in -10..=10_i32) {
        let apart = Change { scale: 4.0_f64.powi(k), ..NONE }.apart(&bodies, law, LONG);
        prop_assert!(apart == 0.0, "{:e}", apart);
    }

    #[test]
    fn a_single_collision_does_not_depend_on_the_order_of_creation(bodies in rush(2), law in laws()) {
        let bodies = neat(&bodies);
        let back: Vec<Thrown> = bodies.iter().rev().cloned().collect();
        let (mut one, mut other) = (weightless(&bodies, law), weightless(&back, law));
        one.steps(DT, SHORT.steps).unwrap();
        other.steps(DT, SHORT.steps).unwrap();
        for i in 0..2 {
            let apart = one.bodies().poses[i].position - other.bodies().poses[1 - i].position;
            let speed = one.bodies().twists[i].linear - other.bodies().twists[1 - i].linear;
            prop_assert!(apart.norm() <= 1e-8 && speed.norm() <= 1e-8, "{:e} {:e}", apart.norm(), speed.norm());
        }
    }
}

#[test]
fn a_stack_at_rest_does_not_depend_on_the_order_of_creation() {
    let build = |order: &[u32]| {
        let mut world = World::new(vec2(0.0, -10.0)).unwrap();
        world.add_body(fixed(20.0, 2.0, vec2(0.0, -1.0))).unwrap();
        for k in order {
            let def = BodyDef {
                position: vec2(0.1 * Real::from(k % 2), 0.5 + Real::from(*k)),
                surface: surface(0.6, 0.0),
                ..BodyDef::new(Shape::rectangle(1.0, 1.0).unwrap())
            };
            world.add_body(def).unwrap();
        }
        world.steps(DT, 120).unwrap();
        let place = |k: u32| 1 + order.iter().position(|own| *own == k).unwrap();
        (0..5).map(|k| world.bodies().poses[place(k)].position).collect::<Vec<_>>()
    };
    let up = build(&[0, 1, 2, 3, 4]);
    for order in [[4, 3, 2, 1, 0], [2, 0, 4, 1, 3]] {
        for (a, b) in up.iter().zip(build(&order)) {
            assert!((a - b).norm() <= 1e-9, "{:e}", (a - b).norm());
        }
    }
}

proptest! {
    #![proptest_config(fewer(64))]

    /// Twenty disks in a box, elastic and smooth. Backwards 40/60 s, all are where they began; chaos makes of
    /// rounding what it will in some ten collisions each way.
    #[test]
    fn an_elastic_gas_runs_backwards(angles in prop::collection::vec(-3.1..3.1_f64, 20)) {
        let mut world = World::new(vec2(0.0, 0.0)).unwrap();
        let smooth = surface(0.0, 1.0);
        for (x, y, w, h) in [(0.0, -6.0, 14.0, 2.0), (0.0, 6.0, 14.0, 2.0), (-6.0, 0.0, 2.0, 14.0), (6.0, 0.0, 2.0, 14.0)] {
            world.add_body(BodyDef { surface: smooth.clone(), ..fixed(w, h, vec2(x, y)) }).unwrap();
        }
        let mut handles = Vec::new();
        for (k, angle) in angles.iter().enumerate() {
            let place = vec2((k % 5) as Real * 1.8 - 3.6, (k / 5) as Real * 2.0 - 3.0);
            let velocity = Rot::new(*angle).apply(vec2(3.0, 0.0));
            let def = BodyDef {
                position: place,
                velocity,
                surface: smooth.clone(),
                ..BodyDef::new(Shape::circle(0.3).unwrap())
            };
            handles.push(world.add_body(def).unwrap());
        }
        let start = world.bodies().poses.clone();
        world.steps(DT / 16.0, 16 * 40).unwrap();
        for handle in &handles {
            let back = -world.body(*handle).unwrap().velocity();
            world.body_mut(*handle).unwrap().set_velocity(back).unwrap();
        }
        world.steps(DT / 16.0, 16 * 40).unwrap();
        for (a, b) in start.iter().zip(&world.bodies().poses) {
            let apart = (a.position - b.position).norm();
            prop_assert!(apart <= 1e-6, "{:e}", apart);
        }
    }
}
