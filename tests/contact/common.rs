//! Random bodies that collide, and worlds for them.

use culbuto::body::{Friction, ImpactLaw, Surface};
use culbuto::math::{Real, Vec2, perp, sin_cos, vec2};
use culbuto::shapes::Shape;
use culbuto::{BodyDef, BodyKind, Part, World};
use proptest::prelude::*;

pub const DT: Real = 1.0 / 60.0;

/// A quarter of the cases: each of them steps a world.
pub fn fewer(part: u32) -> ProptestConfig {
    let cases = (ProptestConfig::default().cases / part).max(4);
    ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() }
}

/// What a body is made of, in numbers that can be mirrored and scaled.
#[derive(Clone, Debug)]
pub enum Form {
    Disk(Real),
    Box(Real, Real),
    Polygon(u32, Real),
    Capsule(Real, Real),
    /// An L: not convex.
    Ell(Real, Real),
    /// A disk on either end of a box.
    Dumbbell(Real, Real),
}

impl Form {
    /// The parts at a scale; mirrored across the y axis where `side` is −1.
    pub fn parts(&self, scale: Real, side: Real) -> Vec<Part> {
        let ring = |corners: &[Vec2]| {
            let mut corners: Vec<Vec2> =
                corners.iter().map(|p| vec2(side * p.x, p.y) * scale).collect();
            if side < 0.0 {
                corners.reverse();
            }
            Part::from(Shape::polygon(&corners).unwrap())
        };
        match *self {
            Self::Disk(r) => vec![Shape::circle(r * scale).unwrap().into()],
            Self::Box(w, h) => vec![Shape::rectangle(w * scale, h * scale).unwrap().into()],
            Self::Polygon(n, r) => {
                let corner = |k: u32| {
                    let (sin, cos) = sin_cos(std::f64::consts::TAU * Real::from(k) / Real::from(n));
                    vec2(cos, sin) * r
                };
                vec![ring(&(0..n).map(corner).collect::<Vec<_>>())]
            }
            Self::Capsule(l, r) => {
                let (a, b) = (vec2(-side * l, -0.3 * l), vec2(side * l, 0.3 * l));
                vec![Shape::capsule(a * scale, b * scale, r * scale).unwrap().into()]
            }
            Self::Ell(a, t) => {
                let t = t * a;
                let p = [(0.0, 0.0), (a, 0.0), (a, t), (t, t), (t, a), (0.0, a)];
                vec![ring(&p.map(|(x, y)| vec2(x - 0.4 * a, y - 0.4 * a)))]
            }
            Self::Dumbbell(l, r) => {
                let end = |x: Real| {
                    let circle = Shape::new(culbuto::shapes::ShapeDef::Circle {
                        radius: r * scale,
                        center: vec2(x * scale, 0.0),
                    });
                    Part::from(circle.unwrap())
                };
                let bar = Shape::rectangle(2.0 * l * scale, r * scale).unwrap();
                vec![end(-l), end(l), bar.into()]
            }
        }
    }
}

pub fn forms() -> impl Strategy<Value = Form> {
    prop_oneof![
        (0.2..0.6).prop_map(Form::Disk),
        (0.3..1.0, 0.3..1.0).prop_map(|(w, h)| Form::Box(w, h)),
        (3..8_u32, 0.3..0.7).prop_map(|(n, r)| Form::Polygon(n, r)),
        (0.2..0.5, 0.1..0.3).prop_map(|(l, r)| Form::Capsule(l, r)),
        (0.6..1.0, 0.2..0.5).prop_map(|(a, t)| Form::Ell(a, t)),
        (0.3..0.5, 0.15..0.25).prop_map(|(l, r)| Form::Dumbbell(l, r)),
    ]
}

pub fn laws() -> impl Strategy<Value = ImpactLaw> {
    prop::sample::select(vec![ImpactLaw::Newton, ImpactLaw::Poisson, ImpactLaw::Stronge])
}

/// A body that will meet others.
#[derive(Clone, Debug)]
pub struct Thrown {
    pub form: Form,
    pub place: Vec2,
    pub angle: Real,
    pub velocity: Vec2,
    pub spin: Real,
    pub friction: Real,
    pub restitution: Real,
    pub density: Real,
}

impl Thrown {
    pub fn def(&self) -> BodyDef {
        BodyDef {
            position: self.place,
            angle: self.angle,
            velocity: self.velocity,
            angular_velocity: self.spin,
            density: self.density,
            shapes: self.form.parts(1.0, 1.0),
            surface: surface(self.friction, self.restitution),
            ..BodyDef::default()
        }
    }
}

pub fn surface(friction: Real, restitution: Real) -> Surface {
    Surface { friction: Friction::of(friction), restitution, ..Surface::default() }
}

/// Form, angle, speeds inwards and aside, spin, friction, restitution, density.
type Throw = (Form, Real, (Real, Real), Real, Real, Real, Real);

/// Bodies around a circle of radius 2 that fly to its middle, apart from one another at first.
pub fn rush(most: usize) -> impl Strategy<Value = Vec<Thrown>> {
    let one = (
        forms(),
        -3.0..3.0_f64,
        (1.0..6.0_f64, -1.0..1.0_f64),
        -6.0..6.0_f64,
        prop_oneof![Just(0.0), 0.0..1.2_f64],
        prop_oneof![Just(0.0), Just(1.0), 0.0..1.0_f64],
        0.2..5.0_f64,
    );
    prop::collection::vec(one, 2..=most).prop_map(|all| {
        let n = all.len() as Real;
        let body = |(k, one): (usize, Throw)| {
            let (form, angle, (speed, aside), spin, friction, restitution, density) = one;
            let (sin, cos) = sin_cos(std::f64::consts::TAU * k as Real / n + 0.3);
            let out = vec2(cos, sin);
            let place = out * if n > 3.0 { 2.5 } else { 1.6 };
            let velocity = out * -speed + perp(out) * aside;
            Thrown { form, place, angle, velocity, spin, friction, restitution, density }
        };
        all.into_iter().enumerate().map(body).collect()
    })
}

pub fn weightless(bodies: &[Thrown], law: ImpactLaw) -> World {
    let mut world = World::new(vec2(0.0, 0.0)).unwrap();
    world.set_impact_law(law);
    for body in bodies {
        world.add_body(body.def()).unwrap();
    }
    world
}

pub fn fixed(width: Real, height: Real, place: Vec2) -> BodyDef {
    BodyDef {
        kind: BodyKind::Static,
        position: place,
        ..BodyDef::new(Shape::rectangle(width, height).unwrap())
    }
}

/// A world with gravity −10 along y and a floor whose top is at y = 0.
pub fn floor(friction: Real) -> World {
    let mut world = World::new(vec2(0.0, -10.0)).unwrap();
    let floor = BodyDef { surface: surface(friction, 0.0), ..fixed(200.0, 2.0, vec2(0.0, -1.0)) };
    world.add_body(floor).unwrap();
    world
}

/// A bin of width 6 in which bodies lie above one another in rows of three.
pub fn bin(bodies: &[Thrown]) -> World {
    let mut world = floor(0.5);
    for side in [-1.0, 1.0] {
        world.add_body(fixed(1.0, 40.0, vec2(3.5 * side, 19.0))).unwrap();
    }
    for (k, body) in bodies.iter().enumerate() {
        let place = vec2((k % 3) as Real * 1.9 - 1.9, 1.2 + 1.9 * (k / 3) as Real);
        world.add_body(BodyDef { position: place, ..body.def() }).unwrap();
    }
    world
}

pub fn pyramid(base: u32) -> World {
    let mut world = floor(0.6);
    for row in 0..base {
        for k in 0..base - row {
            let x = Real::from(k) - 0.5 * Real::from(base - row - 1);
            let def = BodyDef {
                position: vec2(1.05 * x, 0.5 + Real::from(row)),
                surface: surface(0.6, 0.0),
                ..BodyDef::new(Shape::rectangle(1.0, 1.0).unwrap())
            };
            world.add_body(def).unwrap();
        }
    }
    world
}
