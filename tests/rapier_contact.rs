//! Rapier as a witness in contact: the same scenes, data and settings in both engines. Where there is an exact answer
//! ours reaches it, and Rapier comes as near as it is known to; piles agree in where they rest and in what order.

#![allow(clippy::unwrap_used, clippy::print_stdout)] // helpers of tests may, as tests do

use culbuto::body::{BodyKind, Friction, Surface};
use culbuto::math::{Real, Vec2, vec2};
use culbuto::shapes::Shape;
use culbuto::{BodyDef, World};
use rapier2d_f64::prelude::{
    ColliderBuilder, PhysicsWorld, RigidBodyBuilder, RigidBodyHandle, Vector,
};

const G: Real = 9.81;
const DT: Real = 1.0 / 60.0;

/// What both engines can make.
#[derive(Clone, Debug)]
enum Form {
    Box(Real, Real),
    Disk(Real),
    Convex(Vec<Vec2>),
}

#[derive(Clone, Debug)]
struct Item {
    form: Form,
    fixed: bool,
    position: Vec2,
    angle: Real,
    velocity: Vec2,
    spin: Real,
}

fn item(form: Form, position: Vec2) -> Item {
    Item { form, fixed: false, position, angle: 0.0, velocity: Vec2::zeros(), spin: 0.0 }
}

fn fixed(form: Form, position: Vec2) -> Item {
    Item { fixed: true, ..item(form, position) }
}

fn ground() -> Item {
    fixed(Form::Box(200.0, 2.0), vec2(0.0, -1.0))
}

/// A scene in both engines.
struct Both {
    ours: World,
    theirs: PhysicsWorld,
    bodies: Vec<RigidBodyHandle>,
}

impl Both {
    fn new(items: &[Item], (friction, restitution): (Real, Real)) -> Self {
        let mut ours = World::new(vec2(0.0, -G)).unwrap();
        let mut theirs = PhysicsWorld { gravity: Vector::new(0.0, -G), ..PhysicsWorld::default() };
        let parameters = &mut theirs.integration_parameters;
        parameters.dt = DT;
        parameters.contact_recycling = false;
        parameters.normalized_max_linear_velocity = 400.0;
        let mut bodies = Vec::new();
        for item in items {
            let (shape, collider) = match &item.form {
                Form::Box(a, b) => {
                    (Shape::rectangle(*a, *b).unwrap(), ColliderBuilder::cuboid(a / 2.0, b / 2.0))
                }
                Form::Disk(r) => (Shape::circle(*r).unwrap(), ColliderBuilder::ball(*r)),
                Form::Convex(points) => {
                    let theirs: Vec<_> = points.iter().map(|p| Vector::new(p.x, p.y)).collect();
                    (
                        Shape::polygon(points).unwrap(),
                        ColliderBuilder::convex_hull(&theirs).unwrap(),
                    )
                }
            };
            let kind = if item.fixed { BodyKind::Static } else { BodyKind::Dynamic };
            let surface =
                Surface { friction: Friction::of(friction), restitution, ..Surface::default() };
            ours.add_body(BodyDef {
                kind,
                position: item.position,
                angle: item.angle,
                velocity: item.velocity,
                angular_velocity: item.spin,
                surface,
                ..BodyDef::new(shape)
            })
            .unwrap();
            let body =
                if item.fixed { RigidBodyBuilder::fixed() } else { RigidBodyBuilder::dynamic() };
            let body = body
                .translation(Vector::new(item.position.x, item.position.y))
                .rotation(item.angle)
                .linvel(Vector::new(item.velocity.x, item.velocity.y))
                .angvel(item.spin)
                .allow_fast_rotation(true)
                .can_sleep(false);
            let collider = collider.density(1.0).friction(friction).restitution(restitution);
            bodies.push(theirs.insert(body, collider).0);
        }
        Self { ours, theirs, bodies }
    }

    fn run(&mut self, seconds: Real) {
        let steps = (seconds / DT).round() as u32;
        self.ours.steps(DT, steps).unwrap();
        (0..steps).for_each(|_| self.theirs.step());
    }

    /// Places of body i in both engines.
    fn places(&self, i: usize) -> [Vec2; 2] {
        let theirs = self.theirs.bodies[self.bodies[i]].translation();
        [self.ours.bodies().poses[i].position, vec2(theirs.x, theirs.y)]
    }

    fn velocities(&self, i: usize) -> [Vec2; 2] {
        let theirs = self.theirs.bodies[self.bodies[i]].linvel();
        [self.ours.bodies().twists[i].linear, vec2(theirs.x, theirs.y)]
    }

    /// The largest difference of the heights of all bodies.
    fn heights_apart(&self) -> Real {
        let apart = |i: usize| (self.places(i)[0].y - self.places(i)[1].y).abs();
        (0..self.bodies.len()).map(apart).fold(0.0, Real::max)
    }

    /// Bodies from the lowest to the highest, in both.
    fn orders(&self) -> [Vec<usize>; 2] {
        [0, 1].map(|engine| {
            let mut order: Vec<usize> = (0..self.bodies.len()).collect();
            order.sort_by(|i, j| self.places(*i)[engine].y.total_cmp(&self.places(*j)[engine].y));
            order
        })
    }
}

/// Ours is within `ours` of the exact value, Rapier within `theirs`.
#[track_caller]
fn near(what: &str, [own, other]: [Real; 2], exact: Real, (ours, theirs): (Real, Real)) {
    let (own, other) = ((own - exact).abs(), (other - exact).abs());
    println!("{what}: ours {own:.1e} off, Rapier {other:.1e}");
    assert!(own <= ours, "{what}: ours is {own:e} off");
    assert!(other <= theirs, "{what}: Rapier is {other:e} off");
}

#[test]
fn a_box_falls_and_lies() {
    let mut both = Both::new(&[ground(), item(Form::Box(1.0, 1.0), vec2(0.0, 2.0))], (0.5, 0.0));
    both.run(3.0);
    near("height at rest", both.places(1).map(|p| p.y), 0.5, (1e-3, 1e-2));
}

#[test]
fn a_box_slides_to_a_stop() {
    let thrown = Item { velocity: vec2(10.0, 0.0), ..item(Form::Box(1.0, 1.0), vec2(-50.0, 0.5)) };
    let mut both = Both::new(&[ground(), thrown], (0.5, 0.0));
    both.run(4.0);
    // v²/2μg; Rapier stops 0.4 % early.
    let way = 100.0 / (2.0 * 0.5 * G);
    near("way", both.places(1).map(|p| p.x + 50.0), way, (1e-5 * way, 0.01 * way));
}

#[test]
fn a_disk_bounces_off_obliquely() {
    // C9, without gravity: (3.46, 2.4) for μ = 0.1, e = 0.8.
    let thrown = Item { velocity: vec2(4.0, -3.0), ..item(Form::Disk(0.5), vec2(0.0, 1.0)) };
    let mut both = Both::new(&[ground(), thrown], (0.1, 0.8));
    both.ours.set_gravity(Vec2::zeros()).unwrap();
    both.theirs.gravity = Vector::new(0.0, 0.0);
    both.run(0.5);
    near("along", both.velocities(1).map(|v| v.x), 3.46, (1e-3, 0.3));
    near("away", both.velocities(1).map(|v| v.y), 2.4, (1e-3, 0.3));
}

#[test]
fn a_ball_rolls_down_a_ramp() {
    // F5: a = ⅔g sin α, from rest, on a ramp that rises to the right.
    let angle: Real = 0.3;
    let (sin, cos) = angle.sin_cos();
    let ramp = Item { angle, ..fixed(Form::Box(60.0, 2.0), vec2(sin, -cos)) };
    let ball = item(Form::Disk(0.5), vec2(-0.5 * sin, 0.5 * cos));
    let mut both = Both::new(&[ramp, ball], (0.6, 0.0));
    both.run(2.0);
    let way = |p: Vec2| -(p - vec2(-0.5 * sin, 0.5 * cos)).dot(&vec2(cos, sin));
    let exact = 0.5 * (2.0 / 3.0 * G * sin) * 4.0;
    near("way", both.places(1).map(way), exact, (1e-4 * exact, 0.02 * exact));
}

#[test]
fn a_stack_stands() {
    let mut items = vec![ground()];
    items.extend((0..8).map(|k| item(Form::Box(1.0, 1.0), vec2(0.0, 0.5 + Real::from(k)))));
    let mut both = Both::new(&items, (0.6, 0.0));
    both.run(4.0);
    let top = both.places(8);
    near("height of the top", top.map(|p| p.y), 7.5, (4e-3, 4e-2));
    let [ours, theirs] = both.orders();
    assert_eq!(ours, theirs);
}

#[test]
fn a_pyramid_stands() {
    let mut items = vec![ground()];
    for row in 0..6_u8 {
        for k in 0..6 - row {
            let x = 1.1 * (Real::from(k) - Real::from(6 - row) / 2.0);
            items.push(item(Form::Box(1.0, 1.0), vec2(x, 0.5 + 1.005 * Real::from(row))));
        }
    }
    let mut both = Both::new(&items, (0.6, 0.0));
    both.run(4.0);
    println!("pyramid: heights {:e} m apart", both.heights_apart());
    assert!(both.heights_apart() < 0.03);
}

#[test]
fn a_tumbling_pentagon_comes_to_lie_on_a_side() {
    let corner = |k: u32| {
        let (sin, cos) = (std::f64::consts::TAU * Real::from(k) / 5.0).sin_cos();
        vec2(0.5 * cos, 0.5 * sin)
    };
    let pentagon = Item {
        velocity: vec2(2.0, 0.0),
        spin: 3.0,
        ..item(Form::Convex((0..5).map(corner).collect()), vec2(0.0, 2.0))
    };
    let mut both = Both::new(&[ground(), pentagon], (0.5, 0.0));
    both.run(6.0);
    // The apothem.
    let height = 0.5 * (std::f64::consts::PI / 5.0).cos();
    near("height at rest", both.places(1).map(|p| p.y), height, (1e-3, 1e-2));
}

#[test]
fn a_pile_of_mixed_shapes_fills_a_bin_as_high() {
    let mut items = vec![
        ground(),
        fixed(Form::Box(1.0, 40.0), vec2(-3.5, 20.0)),
        fixed(Form::Box(1.0, 40.0), vec2(3.5, 20.0)),
    ];
    for k in 0..48_u8 {
        let place = vec2(
            -2.4 + 0.96 * Real::from(k % 6) + 0.02 * Real::from(k % 5),
            0.6 + 0.9 * Real::from(k / 6),
        );
        let form = match k % 3 {
            0 => Form::Disk(0.35),
            1 => Form::Box(0.7, 0.5),
            _ => Form::Convex(vec![vec2(-0.4, -0.25), vec2(0.4, -0.25), vec2(0.0, 0.45)]),
        };
        items.push(item(form, place));
    }
    let mut both = Both::new(&items, (0.5, 0.0));
    both.run(8.0);
    let mean = [0, 1].map(|engine| {
        let heights = (3..items.len()).map(|i| both.places(i)[engine].y);
        heights.sum::<Real>() / (items.len() - 3) as Real
    });
    println!("mean heights: ours {}, Rapier {}", mean[0], mean[1]);
    assert!((mean[0] / mean[1] - 1.0).abs() < 0.05, "{mean:?}");
    for i in 3..items.len() {
        assert!(both.places(i)[0].x.abs() < 3.0 && both.places(i)[0].y > 0.0, "body {i} is out");
    }
}
