//! Random worlds with a random past: steps, places set by hand, bodies that came, changed and went.

use std::f64::consts::{PI, TAU};

use culbuto::body::{BodyKind, Role};
use culbuto::math::{Pose, Real, Vec2, vec2};
use culbuto::shapes::Shape;
use culbuto::world::Column;
use culbuto::{BodyDef, World};
use proptest::prelude::*;

pub fn points(size: Real) -> impl Strategy<Value = Vec2> {
    (-size..size, -size..size).prop_map(|(x, y)| vec2(x, y))
}

pub fn poses(size: Real) -> impl Strategy<Value = Pose> {
    (points(size), -TAU..TAU).prop_map(|(at, angle)| Pose::new(at, angle))
}

/// An L, whose pieces meet in a cut.
pub fn ell(size: Real) -> Shape {
    let corners = [(0.0, 0.0), (2.0, 0.0), (2.0, 1.0), (1.0, 1.0), (1.0, 2.0), (0.0, 2.0)];
    Shape::polygon(&corners.map(|(x, y)| vec2(x, y) * size)).unwrap()
}

fn frame(size: Real) -> Shape {
    let ring = |half: Real| {
        [(-1.0, -1.0), (1.0, -1.0), (1.0, 1.0), (-1.0, 1.0)]
            .map(|(x, y)| vec2(x, y) * half)
            .to_vec()
    };
    Shape::polygon_with_holes(&ring(size), &[ring(0.6 * size)]).unwrap()
}

/// All kinds of shapes, some off their frames.
pub fn shapes() -> impl Strategy<Value = Shape> {
    let size = 0.1..1.0_f64;
    prop_oneof![
        size.clone().prop_map(|r| Shape::circle(r).unwrap()),
        (size.clone(), size.clone()).prop_map(|(w, h)| Shape::rectangle(w, h).unwrap()),
        (3..7_u32, size.clone()).prop_map(|(n, r)| Shape::regular_polygon(n, r).unwrap()),
        (points(1.0), size.clone(), size.clone()).prop_map(|(a, l, r)| Shape::capsule(
            a,
            a + vec2(l, l * 0.3),
            r
        )
        .unwrap()),
        (points(1.0), size.clone()).prop_map(|(a, l)| Shape::segment(a, a + vec2(0.2, l)).unwrap()),
        (points(0.5), size.clone(), -TAU..TAU, 0.5..PI)
            .prop_map(|(c, r, start, sweep)| Shape::arc(c, r, start, sweep).unwrap()),
        (size.clone(), any::<bool>()).prop_map(|(r, closed)| {
            let points = [(0.0, 0.0), (2.0, 0.3), (1.2, 1.7), (-0.4, 1.0)];
            Shape::chain(&points.map(|(x, y)| vec2(x, y) * r), closed).unwrap()
        }),
        size.clone().prop_map(ell),
        size.prop_map(frame),
    ]
}

pub fn defs() -> impl Strategy<Value = BodyDef> {
    let kind = prop_oneof![
        1 => Just(BodyKind::Static),
        1 => Just(BodyKind::Kinematic),
        2 => Just(BodyKind::Dynamic),
    ];
    let role = prop_oneof![4 => Just(Role::Solid), 1 => Just(Role::Sensor)];
    (prop::collection::vec(shapes(), 1..3), kind, role, poses(4.0), points(5.0)).prop_map(
        |(shapes, kind, role, pose, velocity)| BodyDef {
            kind,
            role,
            position: pose.position,
            angle: pose.angle,
            velocity: if kind == BodyKind::Static { vec2(0.0, 0.0) } else { velocity },
            ..BodyDef::compound(shapes.into_iter().map(Into::into))
        },
    )
}

/// What may happen to a world between queries. Numbers choose a body.
#[derive(Clone, Debug)]
pub enum Event {
    Steps(u32),
    Advance(Real),
    Place(usize, Pose),
    Push(usize, Vec2),
    Columns(Vec2),
    Add(Box<BodyDef>),
    Remove(usize),
    Reshape(usize, Shape),
    GoBack,
    Ask,
}

pub fn events() -> impl Strategy<Value = Vec<Event>> {
    let body = 0..100_usize;
    let event = prop_oneof![
        1 => (1..5_u32).prop_map(Event::Steps),
        1 => (0.01..0.3_f64).prop_map(Event::Advance),
        3 => (body.clone(), poses(6.0)).prop_map(|(i, pose)| Event::Place(i, pose)),
        1 => (body.clone(), points(20.0)).prop_map(|(i, v)| Event::Push(i, v)),
        1 => points(3.0).prop_map(Event::Columns),
        1 => defs().prop_map(|def| Event::Add(Box::new(def))),
        1 => body.clone().prop_map(Event::Remove),
        1 => (body, shapes()).prop_map(|(i, shape)| Event::Reshape(i, shape)),
        1 => Just(Event::GoBack),
        3 => Just(Event::Ask),
    ];
    prop::collection::vec(event, 0..12)
}

/// Lets an event happen. `ask` is what a query in between does.
pub fn happen(world: &mut World, event: &Event, ask: impl FnOnce(&World)) {
    let handles = world.bodies().handles().to_vec();
    let body = |i: usize| handles.get(i % handles.len().max(1)).copied();
    match event {
        Event::Steps(n) => world.steps(1.0 / 60.0, *n).unwrap(),
        // Refused where something touches.
        Event::Advance(t) => drop(world.advance(*t, 1e-6)),
        Event::Place(i, pose) => {
            let Some(body) = body(*i) else { return };
            let mut body = world.body_mut(body).unwrap();
            body.set_position(pose.position).unwrap();
            body.set_angle(pose.angle).unwrap();
        }
        Event::Push(i, v) => {
            let moves = |body| world.body(body).unwrap().info().def.kind != BodyKind::Static;
            let Some(body) = body(*i).filter(|body| moves(*body)) else { return };
            world.body_mut(body).unwrap().set_velocity(*v).unwrap();
        }
        Event::Columns(shift) => {
            let mut places = Vec::new();
            world.read_column(Column::Positions, &mut places);
            places.chunks_mut(2).for_each(|p| (p[0], p[1]) = (p[0] + shift.x, p[1] + shift.y));
            world.write_column(Column::Positions, &places).unwrap();
        }
        Event::Add(def) => drop(world.add_body((**def).clone())),
        Event::Remove(i) => drop(body(*i).map(|body| world.remove_body(body))),
        Event::Reshape(i, shape) => {
            let Some(body) = body(*i) else { return };
            world.body_mut(body).unwrap().set_shapes(vec![shape.clone().into()]).unwrap();
        }
        Event::GoBack => {
            let kept = world.snapshot().to_bytes().unwrap();
            let kept = culbuto::world::Snapshot::from_bytes(&kept, Vec::new()).unwrap();
            world.restore(&kept);
        }
        Event::Ask => ask(world),
    }
}

/// A world after events, with queries now and then on the way, or before each event.
pub fn worlds() -> impl Strategy<Value = World> {
    let ask = |world: &World| {
        world.cast_ray(vec2(0.0, 0.0), vec2(1.0, 0.0), &Default::default()).unwrap();
    };
    (prop::collection::vec(defs(), 0..8), events(), any::<bool>()).prop_map(
        move |(defs, events, often)| {
            let mut world = World::default();
            for def in defs {
                world.add_body(def).unwrap();
            }
            for event in &events {
                if often {
                    ask(&world);
                }
                happen(&mut world, event, ask);
            }
            world
        },
    )
}
