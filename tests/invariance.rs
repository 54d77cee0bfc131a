//! Results do not depend on who looks: on the order of creation, the place and direction of the axes,
//! the unit of length, a steady motion of the observer, or the direction of time.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // helpers of tests may, as tests do

#[path = "common/worlds.rs"]
mod worlds;

use culbuto::forces::{Air, Attraction};
use culbuto::math::{Real, Rot, Twist, Vec2, vec2};
use culbuto::methods::REGISTRY;
use culbuto::shapes::Shape;
use culbuto::{BodyDef, World};
use proptest::prelude::*;
use worlds::{APART, EPS, Lorentz, bits, world_with};

/// A scene as numbers, to be looked at in several ways.
#[derive(Clone, Debug)]
struct Scene {
    bodies: Vec<Rod>,
    gravity: Vec2,
    air: Air,
    damping: Real,
    pull: Option<Real>,
    softening: Real,
    duration: Real,
}

/// A box a × b, a circle at its end, whose centre of mass is beside its frame.
#[derive(Clone, Debug)]
struct Rod {
    sizes: (Real, Real),
    mass: Real,
    position: Vec2,
    angle: Real,
    twist: Twist,
    force: Vec2,
    torque: Real,
}

/// How a scene is run.
#[derive(Clone, Copy, Debug)]
enum Mode {
    Step(&'static str),
    /// To a tolerance.
    Advance(Real),
}

/// Of `advance`: well above rounding, so that steps are few, well below what is asked of the results.
const TIGHT: Real = 1e-12;
/// Steps of a run.
const STEPS: u32 = 64;

impl Rod {
    /// `mirror` = −1 turns left into right.
    fn def(&self, mirror: Real, damping: Real) -> BodyDef {
        let (a, b) = self.sizes;
        let end = culbuto::shapes::ShapeDef::Circle {
            radius: 0.6 * b,
            center: vec2(mirror * a, 0.1 * b),
        };
        let parts = [Shape::rectangle(a, b).unwrap(), Shape::new(end).unwrap()];
        BodyDef {
            mass: Some(self.mass),
            position: self.position,
            angle: self.angle,
            velocity: self.twist.linear,
            angular_velocity: self.twist.angular,
            force: self.force,
            torque: self.torque,
            linear_damping: damping,
            angular_damping: 0.5 * damping,
            filter: APART,
            ..BodyDef::compound(parts.map(Into::into))
        }
    }
}

impl Scene {
    fn run(&self, mode: Mode) -> World {
        self.run_mirrored(mode, 1.0)
    }

    fn run_mirrored(&self, mode: Mode, mirror: Real) -> World {
        let mut world = world_with(if let Mode::Step(name) = mode { name } else { "leapfrog" });
        world.set_gravity(self.gravity).unwrap();
        world.set_air(self.air).unwrap();
        for rod in &self.bodies {
            world.add_body(rod.def(mirror, self.damping)).unwrap();
        }
        if let Some(strength) = self.pull {
            world.add_field(Attraction { strength, exponent: -2.0, softening: self.softening });
        }
        match mode {
            Mode::Step(_) => {
                world.steps(self.duration / Real::from(STEPS), STEPS).unwrap();
            }
            Mode::Advance(tolerance) => {
                world.advance(self.duration, tolerance).unwrap();
            }
        }
        world
    }

    /// The scene with every vector and every scalar that has a sense of turning changed.
    fn map(
        &self,
        vector: impl Fn(Vec2) -> Vec2,
        place: impl Fn(Vec2) -> Vec2,
        turn: (Real, Real),
    ) -> Self {
        let mut scene = self.clone();
        scene.gravity = vector(self.gravity);
        scene.air.wind = vector(self.air.wind);
        for rod in &mut scene.bodies {
            rod.position = place(rod.position);
            rod.angle = turn.0 * rod.angle + turn.1;
            rod.twist = Twist::new(vector(rod.twist.linear), turn.0 * rod.twist.angular);
            rod.force = vector(rod.force);
            rod.torque *= turn.0;
        }
        scene
    }
}

fn modes(tolerance: Real) -> impl Iterator<Item = Mode> {
    let methods = REGISTRY.iter().map(|method| Mode::Step(method.facts().name));
    methods.chain([Mode::Advance(tolerance)])
}

fn vector(size: Real) -> impl Strategy<Value = Vec2> {
    (-size..size, -size..size).prop_map(|(x, y)| vec2(x, y))
}

/// Accelerations and rates of the order of 1 over a second: nothing is stiff or chaotic.
fn scenes() -> impl Strategy<Value = Scene> {
    let motion = (vector(3.0), -3.0..3.0, vector(2.0), -2.0..2.0, vector(2.0), -0.2..0.2);
    let rod = ((0.3..1.0, 0.1..0.3), 0.5..2.0, motion).prop_map(|(sizes, mass, motion)| {
        let (position, angle, velocity, spin, force, torque) = motion;
        Rod { sizes, mass, position, angle, twist: Twist::new(velocity, spin), force, torque }
    });
    let air = (prop_oneof![Just(0.0), 0.1..2.0], vector(2.0));
    let damping = prop_oneof![Just(0.0), 0.1..1.0];
    let world = (vector(2.0), air, damping, prop::option::of(0.1..1.0));
    (prop::collection::vec(rod, 1..4), world).prop_map(|(bodies, (gravity, air, damping, pull))| {
        let (density, wind) = air;
        let air = Air { density, wind };
        Scene { bodies, gravity, air, damping, pull, softening: 0.5, duration: 1.0 }
    })
}

/// Largest difference between a world, seen through `place` and `vector`, and another.
fn apart(
    one: &World,
    other: &World,
    place: impl Fn(Vec2) -> Vec2,
    vector: impl Fn(Vec2) -> Vec2,
    turn: (Real, Real),
) -> (Real, Real) {
    let (mut far, mut fast): (Real, Real) = (0.0, 0.0);
    for i in 0..one.bodies().len() {
        let (a, b) = (one.bodies().poses[i], other.bodies().poses[i]);
        far = far.max((place(a.position) - b.position).norm());
        far = far.max((turn.0 * a.angle + turn.1 - b.angle).abs());
        let (a, b) = (one.bodies().twists[i], other.bodies().twists[i]);
        fast = fast.max((vector(a.linear) - b.linear).norm());
        fast = fast.max((turn.0 * a.angular - b.angular).abs());
    }
    (far, fast)
}

/// Rounding of a run: STEPS steps of up to 13 stages with a few roundings each of numbers up to 10,
/// which attraction and drag then carry on with factors up to e² or so.
const ROUNDING: Real = 64.0 * 13.0 * 10.0 * 10.0 * EPS;

/// What a run can differ by: rounding, and where steps are chosen by the error, how much that can
/// change when rounding tips a step the other way.
fn bound(mode: Mode) -> Real {
    if let Mode::Advance(tolerance) = mode { 100.0 * tolerance + ROUNDING } else { ROUNDING }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: ProptestConfig::default().cases / 4, ..ProptestConfig::default() })]

    #[test]
    fn the_order_of_creation_does_not_matter(scene in scenes(), turn in 0..3_usize) {
        let mut other = scene.clone();
        let turn = turn % scene.bodies.len();
        other.bodies.rotate_left(turn);
        for mode in modes(TIGHT) {
            let (one, other) = (scene.run(mode), other.run(mode));
            for i in 0..scene.bodies.len() {
                let j = (i + scene.bodies.len() - turn) % scene.bodies.len();
                let (a, b) = (one.bodies().poses[i], other.bodies().poses[j]);
                let (v, w) = (one.bodies().twists[i], other.bodies().twists[j]);
                if scene.pull.is_none() {
                    // Nobody feels anybody else: the same bits.
                    prop_assert_eq!((a, v), (b, w), "{:?}", mode);
                }
                prop_assert!((a.position - b.position).norm() <= bound(mode), "{mode:?}");
                prop_assert!((a.angle - b.angle).abs() <= bound(mode), "{mode:?}");
                prop_assert!((v.linear - w.linear).norm() <= bound(mode), "{mode:?}");
            }
        }
    }

    /// Positions at 1e7 m lie ε·1e7/2 = 1.9e-9 m apart. Each of the roundings, up to 13·64 of them, moves
    /// the body by at most half of that, and at random: √832·1e-9 = 3e-8 m.
    #[test]
    fn the_origin_does_not_matter(scene in scenes(), far in prop::sample::select(vec![1.0, 1e6, 1e7]),
                                  direction in 0.0..6.3) {
        let shift = Rot::new(direction).apply(vec2(far, 0.0));
        let same = |v: Vec2| v;
        let other = scene.map(same, |p| p + shift, (1.0, 0.0));
        for mode in modes(if far == 1.0 { TIGHT } else { 1e-9 }) {
            let (far_off, fast) =
                apart(&scene.run(mode), &other.run(mode), |p| p + shift, same, (1.0, 0.0));
            let most = if far == 1.0 { bound(mode) } else { 1e-7 };
            prop_assert!(far_off <= most && fast <= most, "{mode:?}: {far_off:e} {fast:e}");
        }
    }

    #[test]
    fn the_direction_of_the_axes_does_not_matter(scene in scenes(), angle in -4.0..4.0) {
        let rot = |v: Vec2| Rot::new(angle).apply(v);
        let other = scene.map(rot, rot, (1.0, angle));
        for mode in modes(TIGHT) {
            let (far, fast) = apart(&scene.run(mode), &other.run(mode), rot, rot, (1.0, angle));
            prop_assert!(far <= bound(mode) && fast <= bound(mode), "{mode:?}: {far:e} {fast:e}");
        }
    }

    #[test]
    fn left_and_right_are_alike(scene in scenes()) {
        let mirror = |v: Vec2| vec2(-v.x, v.y);
        let other = scene.map(mirror, mirror, (-1.0, 0.0));
        for mode in modes(TIGHT) {
            let (one, other) = (scene.run(mode), other.run_mirrored(mode, -1.0));
            let (far, fast) = apart(&one, &other, mirror, mirror, (-1.0, 0.0));
            prop_assert!(far <= bound(mode) && fast <= bound(mode), "{mode:?}: {far:e} {fast:e}");
        }
    }

    /// An observer who moves with u sees the same forces; the wind, too, is his. `advance` measures
    /// its error against the way and the speed, which are his: the tolerance holds of those.
    #[test]
    fn a_steady_motion_of_the_observer_does_not_matter(scene in scenes(), u in vector(10.0)) {
        let mut other = scene.clone();
        other.air.wind += u;
        other.bodies.iter_mut().for_each(|rod| rod.twist.linear += u);
        let shift = u * scene.duration;
        for mode in modes(TIGHT) {
            let (far, fast) = apart(
                &scene.run(mode), &other.run(mode), |p| p + shift, |v| v + u, (1.0, 0.0),
            );
            prop_assert!(far <= 10.0 * bound(mode) && fast <= 10.0 * bound(mode), "{mode:?}: {far:e} {fast:e}");
        }
    }

    /// Lengths by s, times by √s, masses by s² (of equal density), forces by s², torques by s³:
    /// gravity stays, and so do the numbers. A hidden length or time would show.
    #[test]
    fn the_unit_of_length_does_not_matter(scene in scenes(), s in prop::sample::select(vec![1e-3, 0.5, 1e6])) {
        let root = Real::sqrt(s);
        let mut other = scene.clone();
        other.air.wind *= root;
        other.damping /= root;
        other.duration *= root;
        other.softening *= s;
        for rod in &mut other.bodies {
            rod.sizes = (rod.sizes.0 * s, rod.sizes.1 * s);
            rod.mass *= s * s;
            rod.position *= s;
            rod.twist = Twist::new(rod.twist.linear * root, rod.twist.angular / root);
            rod.force *= s * s;
            rod.torque *= s * s * s;
        }
        for mode in modes(TIGHT) {
            let (one, other) = (scene.run(mode), other.run(mode));
            for i in 0..scene.bodies.len() {
                let (a, b) = (one.bodies().poses[i], other.bodies().poses[i]);
                let (v, w) = (one.bodies().twists[i], other.bodies().twists[i]);
                let far = (a.position - b.position / s).norm().max((a.angle - b.angle).abs());
                let linear = (v.linear - w.linear / root).norm();
                let fast = linear.max((v.angular - w.angular * root).abs());
                prop_assert!(far <= 1e-9 && fast <= 1e-9, "{mode:?}: {far:e} {fast:e}");
            }
        }
    }

    /// Velocities turned round, a reversible method goes back the way it came.
    #[test]
    fn time_can_run_backwards(scene in scenes()) {
        let conservative = Scene { damping: 0.0, air: Air::default(), ..scene };
        let reversible = REGISTRY.iter().map(|method| method.facts()).filter(|facts| facts.reversible);
        for facts in reversible {
            let start = Scene { duration: 1e-9, ..conservative.clone() }.run(Mode::Step(facts.name));
            let mut world = start.clone();
            world.steps(1.0 / 64.0, 64).unwrap();
            for body in world.bodies().handles().to_vec() {
                let v = world.body(body).unwrap().twist();
                world.body_mut(body).unwrap().set_twist(Twist::new(-v.linear, -v.angular)).unwrap();
            }
            world.steps(1.0 / 64.0, 64).unwrap();
            let (far, _) = apart(&start, &world, |p| p, |v| v, (1.0, 0.0));
            let fast = reversed_apart(&start, &world);
            prop_assert!(far.max(fast) <= 2.0 * ROUNDING, "{}: {far:e} {fast:e}", facts.name);
        }
    }
}

/// Largest difference of the velocities, of which those of `there` are turned round.
fn reversed_apart(here: &World, there: &World) -> Real {
    let pairs = here.bodies().twists.iter().zip(&there.bodies().twists);
    let apart =
        |(v, w): (&Twist, &Twist)| (v.linear + w.linear).norm() + (v.angular + w.angular).abs();
    pairs.map(apart).fold(0.0, Real::max)
}

#[test]
fn a_magnetic_field_turned_round_leads_back() {
    let reversible = REGISTRY.iter().map(|method| method.facts()).filter(|facts| facts.reversible);
    for facts in reversible {
        let world = |field: Real, position, velocity| {
            let mut world = world_with(facts.name);
            world.add_field(Lorentz { field, gradient: 0.3 * field });
            world.add_field(Attraction { strength: 1.0, exponent: -2.0, softening: 0.3 });
            for sign in [1.0, -1.0] {
                let def = BodyDef {
                    position: position * sign,
                    velocity: velocity * sign,
                    ..BodyDef::point(1.0)
                };
                world.add_body(def).unwrap();
            }
            world
        };
        let mut there = world(1.7, vec2(1.0, 0.2), vec2(0.3, 0.8));
        let start = there.bodies().poses.clone();
        there.steps(0.02, 200).unwrap();
        let mut back = world(-1.7, vec2(0.0, 0.0), vec2(0.0, 0.0));
        for (i, body) in back.bodies().handles().to_vec().into_iter().enumerate() {
            let (pose, twist) = (there.bodies().poses[i], there.bodies().twists[i]);
            let mut body = back.body_mut(body).unwrap();
            body.set_position(pose.position).unwrap();
            body.set_velocity(-twist.linear).unwrap();
        }
        back.steps(0.02, 200).unwrap();
        for (now, then) in back.bodies().poses.iter().zip(&start) {
            let far = (now.position - then.position).norm();
            // 400 steps of up to 7 kicks, each solved to 4ε.
            assert!(far <= 400.0 * 7.0 * 8.0 * EPS, "{}: {far:e}", facts.name);
        }
    }
}

#[test]
fn a_run_gives_the_same_bits_every_time() {
    let rod = |x: Real| Rod {
        sizes: (0.7, 0.2),
        mass: 1.3,
        position: vec2(x, 0.4),
        angle: 0.3,
        twist: Twist::new(vec2(0.2, 0.9), 1.1),
        force: vec2(0.4, 0.1),
        torque: 0.05,
    };
    let scene = Scene {
        bodies: [0.0, 1.0, 2.5].map(rod).to_vec(),
        gravity: vec2(0.0, -1.0),
        air: Air { density: 0.7, wind: vec2(0.5, 0.0) },
        damping: 0.1,
        pull: Some(0.8),
        softening: 0.5,
        duration: 1.0,
    };
    for mode in modes(TIGHT) {
        assert_eq!(bits(&scene.run(mode)), bits(&scene.run(mode)), "{mode:?}");
    }
}
