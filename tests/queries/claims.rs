//! What queries say of scenes that can be worked out by hand.

use culbuto::body::{BodyKind, Filter, Role};
use culbuto::math::{Pose, Real, Vec2, vec2};
use culbuto::shapes::Shape;
use culbuto::world::{Column, QueryFilter, ShapeId, distance_between};
use culbuto::{BodyDef, BodyHandle, World};
use proptest::prelude::*;

use super::history::ell;

fn fixed(shape: Shape, position: Vec2) -> BodyDef {
    BodyDef { kind: BodyKind::Static, position, ..BodyDef::new(shape) }
}

/// Three unit boxes on the x axis, at 0, 2 and 4, all about `origin` and `scale` as large.
fn row(origin: Vec2, scale: Real) -> (World, [BodyHandle; 3]) {
    let mut world = World::default();
    let bodies = [0.0, 2.0, 4.0].map(|x| {
        let shape = Shape::rectangle(scale, scale).unwrap();
        world.add_body(fixed(shape, origin + vec2(x * scale, 0.0))).unwrap()
    });
    (world, bodies)
}

const ALL: QueryFilter<'_> = QueryFilter {
    mask: None,
    category: None,
    group: 0,
    sensors: false,
    exclude: &[],
    predicate: None,
};

#[test]
fn fractions_points_and_normals_do_not_depend_on_size_and_hardly_on_place() {
    for (origin, scale) in [(vec2(0.0, 0.0), 1e-3), (vec2(0.0, 0.0), 1e6), (vec2(1e7, -1e7), 1.0)] {
        let (world, bodies) = row(origin, scale);
        let from = origin + vec2(-1.5, 0.25) * scale;
        let hits = world.cast_ray_all(from, vec2(8.0, 0.0) * scale, &ALL).unwrap();
        assert_eq!(hits.iter().map(|hit| hit.body).collect::<Vec<_>>(), bodies);
        for (hit, x) in hits.iter().zip([-0.5, 1.5, 3.5]) {
            assert!((hit.fraction - (x + 1.5) / 8.0).abs() < 1e-15, "{hit:?}");
            assert!((hit.point - origin - vec2(x, 0.25) * scale).norm() < 4e-15 * scale);
            assert_eq!(hit.normal, vec2(-1.0, 0.0));
        }
        let near = world.nearest(origin + vec2(1.25, 0.0) * scale, scale, &ALL).unwrap().unwrap();
        assert_eq!(near.body, bodies[1]);
        assert!((near.distance / scale - 0.25).abs() < 1e-15);
        let gap = world.distance(bodies[0], bodies[2]).unwrap();
        assert_eq!(gap.normal, vec2(1.0, 0.0));
        assert!((gap.distance / scale - 3.0).abs() < 2e-15);
        let disk = Shape::circle(0.25 * scale).unwrap();
        let start = Pose::new(origin + vec2(1.0, 4.0) * scale, 0.3);
        let hit = world.cast_shape(&disk, &start, vec2(0.0, -8.0) * scale, &ALL).unwrap();
        assert_eq!(hit, None); // half a metre of air on either side
        let start = Pose::new(origin + vec2(2.0, 4.0) * scale, 0.3);
        let hit = world.cast_shape(&disk, &start, vec2(0.0, -8.0) * scale, &ALL).unwrap().unwrap();
        assert!((hit.fraction - 3.25 / 8.0).abs() < 1e-12, "{hit:?}");
        assert_eq!((hit.body, hit.normal), (bodies[1], vec2(0.0, 1.0)));
    }
}

#[test]
fn filters_choose_what_is_seen() {
    let mut world = World::default();
    let at = |x: Real, filter: Filter, role: Role| BodyDef {
        filter,
        role,
        ..fixed(Shape::rectangle(1.0, 1.0).unwrap(), vec2(x, 0.0))
    };
    let wall = Filter { category: 2, ..Filter::default() };
    let ghost = Filter { category: 4, mask: 1, group: -7 };
    let a = world.add_body(at(0.0, Filter::default(), Role::Solid)).unwrap();
    let b = world.add_body(at(2.0, wall, Role::Solid)).unwrap();
    let c = world.add_body(at(4.0, ghost, Role::Solid)).unwrap();
    let d = world.add_body(at(6.0, Filter::default(), Role::Sensor)).unwrap();
    let seen = |filter: QueryFilter<'_>| -> Vec<BodyHandle> {
        let hits = world.cast_ray_all(vec2(-2.0, 0.0), vec2(20.0, 0.0), &filter).unwrap();
        hits.into_iter().map(|hit| hit.body).collect()
    };
    assert_eq!(seen(ALL), [a, b, c]);
    assert_eq!(seen(QueryFilter { sensors: true, ..ALL }), [a, b, c, d]);
    assert_eq!(seen(QueryFilter { mask: Some(2), ..ALL }), [b]);
    assert_eq!(seen(QueryFilter { mask: Some(6), ..ALL }), [b, c]);
    assert_eq!(seen(QueryFilter { category: Some(2), ..ALL }), [a, b]);
    assert_eq!(seen(QueryFilter { group: -7, ..ALL }), [a, b]);
    assert_eq!(seen(QueryFilter { exclude: &[a, c], ..ALL }), [b]);
    let not_b = |id: ShapeId| id.body != b;
    assert_eq!(seen(QueryFilter { predicate: Some(&not_b), ..ALL }), [a, c]);
}

#[test]
fn a_visitor_ends_the_search() {
    let (world, _) = row(vec2(0.0, 0.0), 1.0);
    let count = |answer: Real| {
        let mut count = 0;
        let mut visit = |_: &_| {
            count += 1;
            answer
        };
        world.visit_ray(vec2(-2.0, 0.0), vec2(9.0, 0.0), &ALL, &mut visit).unwrap();
        count
    };
    assert_eq!((count(1.0), count(-1.0)), (3, 1));
    // Ended among what stands still, nothing of what was moved is looked at.
    let (mut world, bodies) = row(vec2(0.0, 0.0), 1.0);
    world.body_mut(bodies[2]).unwrap().set_position(vec2(0.0, 0.5)).unwrap();
    let mut seen = 0;
    let mut visit = |_: &_| {
        seen += 1;
        -1.0
    };
    world.visit_ray(vec2(-2.0, 0.1), vec2(9.0, 0.0), &ALL, &mut visit).unwrap();
    assert_eq!(seen, 1);
}

#[test]
fn of_equals_the_first_in_body_order_is_named() {
    let mut world = World::default();
    let shape = Shape::rectangle(1.0, 1.0).unwrap();
    let bodies: Vec<_> =
        (0..20).map(|_| world.add_body(fixed(shape.clone(), vec2(3.0, 0.0))).unwrap()).collect();
    world.body_mut(bodies[0]).unwrap().set_position(vec2(9.0, 0.0)).unwrap();
    world.body_mut(bodies[0]).unwrap().set_position(vec2(3.0, 0.0)).unwrap();
    let hits = world.cast_ray_all(vec2(0.0, 0.0), vec2(5.0, 0.0), &ALL).unwrap();
    assert_eq!(hits.iter().map(|hit| hit.body).collect::<Vec<_>>(), bodies);
    let first = world.cast_ray(vec2(0.0, 0.0), vec2(5.0, 0.0), &ALL).unwrap().unwrap();
    let near = world.nearest(vec2(0.0, 0.0), 5.0, &ALL).unwrap().unwrap();
    assert_eq!([first.body, near.body], [bodies[0]; 2]);
}

#[test]
fn bodies_are_seen_where_they_fell_even_if_nothing_can_collide() {
    let mut world = World::new(vec2(0.0, -10.0)).unwrap();
    let ball = world.add_body(BodyDef::new(Shape::circle(0.5).unwrap())).unwrap();
    let down = |world: &World| world.cast_ray(vec2(0.0, 9.0), vec2(0.0, -99.0), &ALL).unwrap();
    assert_eq!(down(&world).unwrap().point.y, 0.5);
    world.steps(0.1, 20).unwrap();
    assert!((down(&world).unwrap().point.y - (0.5 - 20.0)).abs() < 1e-12);
    assert_eq!(world.shapes_at(vec2(0.0, 0.0), &ALL).unwrap(), []);
    let id = ShapeId { body: ball, part: 0 };
    assert_eq!(world.shapes_at(vec2(0.1, -20.0), &ALL).unwrap(), [id]);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(256))]

    /// From anywhere in an L, on the cut between its pieces too, a ray hits it where it starts.
    #[test]
    fn within_a_shape_there_is_no_cut(
        t in 0.0..1.0_f64, turn in -7.0..7.0_f64, at in super::history::points(1e3),
        way in super::history::points(3.0),
    ) {
        let mut world = World::default();
        world.add_body(BodyDef { angle: turn, ..fixed(ell(1.0), at) }).unwrap();
        let pose = Pose::new(at, turn);
        // The inner corner is joined to some outer vertex.
        for outer in [vec2(0.0, 0.0), vec2(2.0, 0.0), vec2(0.0, 2.0), vec2(1.0, 0.0), vec2(0.0, 1.0)] {
            let from = pose.apply(vec2(1.0, 1.0) * t + outer * (1.0 - t));
            let inside = !world.shapes_at(from, &ALL).unwrap().is_empty();
            let hit = world.cast_ray(from, way, &ALL).unwrap();
            if inside {
                prop_assert_eq!(hit.map(|hit| hit.fraction), Some(0.0));
            }
        }
    }
}

#[test]
fn shapes_are_apart_by_what_lies_between_them() {
    let disk = Shape::circle(0.5).unwrap();
    let frame = Pose::new(vec2(3.0, 4.0), 1.0);
    let gap = distance_between((&disk, &Pose::IDENTITY), (&disk, &frame)).unwrap();
    assert!((gap.distance - 4.0).abs() < 1e-15);
    assert!((gap.on_a - vec2(0.3, 0.4)).norm() < 1e-15);
    assert!((gap.on_b - vec2(2.7, 3.6)).norm() < 1e-15);
    // A point body, and one that overlaps.
    let mut world = World::default();
    let point =
        world.add_body(BodyDef { position: vec2(0.0, 2.0), ..BodyDef::point(1.0) }).unwrap();
    let ball = world.add_body(BodyDef::new(disk.clone())).unwrap();
    let other =
        world.add_body(BodyDef { position: vec2(0.75, 0.0), ..BodyDef::new(disk) }).unwrap();
    assert_eq!(world.distance(point, ball).unwrap().distance, 1.5);
    assert_eq!(world.distance(ball, other).unwrap().distance, -0.25);
}

#[test]
fn places_written_as_columns_are_places_set_one_by_one() {
    let mut worlds = [(); 2].map(|()| {
        let mut world = World::new(vec2(0.0, -10.0)).unwrap();
        let floor = Shape::rectangle(4.0, 1.0).unwrap();
        let floor = world.add_body(fixed(floor, vec2(0.0, -100.0))).unwrap();
        let ball =
            BodyDef { position: vec2(0.0, 1.0), ..BodyDef::new(Shape::circle(0.5).unwrap()) };
        let ball = world.add_body(ball).unwrap();
        world.steps(0.01, 1).unwrap();
        (world, floor, ball)
    });
    let at = worlds[0].0.body(worlds[0].2).unwrap().position();
    let (one, floor, ball) = &mut worlds[0];
    one.body_mut(*floor).unwrap().set_position(vec2(0.0, -0.5)).unwrap();
    one.body_mut(*ball).unwrap().set_position(at).unwrap();
    worlds[1].0.write_column(Column::Positions, &[0.0, -0.5, at.x, at.y]).unwrap();
    let [one, other] = worlds.map(|(mut world, _, ball)| {
        world.steps(0.01, 100).unwrap();
        world.body(ball).unwrap().position()
    });
    assert_eq!(one, other);
    assert!((one.y - 0.5).abs() < 1e-6, "it fell through the floor: {one}");
}
