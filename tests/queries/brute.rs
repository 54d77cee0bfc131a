//! Queries say what looking at every body says.

use culbuto::body::Role;
use culbuto::collision::{self, Collider, Frame, Geometry, colliders};
use culbuto::math::{Pose, Real, Vec2};
use culbuto::shapes::{Aabb, Shape};
use culbuto::world::{QueryFilter, ShapeId};
use culbuto::{Part, World};
use proptest::prelude::*;

use super::history::{events, happen, points, poses, shapes, worlds};

/// Every collider that is seen, with the frame of its body: from the definitions and the poses alone.
fn all(world: &World, sensors: bool) -> Vec<(ShapeId, Collider, Frame)> {
    let bodies = world.bodies();
    let mut all = Vec::new();
    for (i, &body) in bodies.handles().iter().enumerate() {
        let def = &bodies.infos[i].def;
        for collider in colliders(i as u32, &def.shapes, bodies.local_centers[i]) {
            let part = collider.part as usize;
            if sensors || def.role_of(&def.shapes[part]) != Role::Sensor {
                all.push((ShapeId { body, part }, collider, Frame::of(&bodies.poses[i])));
            }
        }
    }
    all
}

fn once(mut ids: Vec<ShapeId>) -> Vec<ShapeId> {
    ids.dedup();
    ids
}

/// Pieces of a shape at a pose, and their frame.
fn placed(shape: &Shape, pose: &Pose) -> (Vec<Geometry>, Frame) {
    let parts = [Part::from(shape.clone())];
    let pieces = colliders(0, &parts, shape.centroid());
    let frame = Frame { position: pose.apply(shape.centroid()), rot: pose.rot() };
    (pieces.into_iter().map(|collider| collider.geometry).collect(), frame)
}

fn close(a: Real, b: Real) -> bool {
    (a - b).abs() <= 1e-11
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(128))]

    #[test]
    fn a_ray_hits_what_is_first(
        world in worlds(), from in points(6.0), way in points(12.0), sensors: bool,
    ) {
        let filter = QueryFilter { sensors, ..QueryFilter::default() };
        let mut expected: Vec<(Real, ShapeId)> = Vec::new();
        for (id, collider, frame) in all(&world, sensors) {
            let start = frame.apply_inverse(from);
            let way = frame.rot.apply_inverse(way);
            if let Some(hit) = collision::cast_ray(&collider.geometry, start, way) {
                match expected.iter_mut().find(|(_, other)| *other == id) {
                    Some(known) => known.0 = known.0.min(hit.fraction),
                    None => expected.push((hit.fraction, id)),
                }
            }
        }
        expected.sort_by(|a, b| a.0.total_cmp(&b.0));
        let hits = world.cast_ray_all(from, way, &filter).unwrap();
        let found: Vec<_> = hits
            .iter()
            .map(|hit| (hit.fraction, ShapeId { body: hit.body, part: hit.part }))
            .collect();
        prop_assert_eq!(&found, &expected);
        let first = world.cast_ray(from, way, &filter).unwrap();
        prop_assert_eq!(first, hits.first().copied());
        for hit in &hits {
            prop_assert!((from + way * hit.fraction - hit.point).norm() < 1e-12);
            prop_assert!(hit.normal.dot(&way) <= 1e-12);
            prop_assert!(close(hit.normal.norm(), 1.0));
        }
    }

    /// Nothing of this knows the functions of collision.
    #[test]
    fn before_a_hit_the_way_is_free(world in worlds(), from in points(6.0), way in points(12.0)) {
        let filter = QueryFilter { sensors: true, ..QueryFilter::default() };
        let hit = world.cast_ray(from, way, &filter).unwrap();
        let free = hit.map_or(1.0, |hit| hit.fraction);
        for k in 0..200 {
            let fraction = free * Real::from(k) / 200.0;
            if fraction < free - 1e-9 {
                let at = world.shapes_at(from + way * fraction, &filter).unwrap();
                prop_assert_eq!(at, vec![]);
            }
        }
    }

    #[test]
    fn points_are_held_by_the_shapes_that_say_so(world in worlds(), point in points(5.0)) {
        let mut expected = Vec::new();
        let bodies = world.bodies();
        for (i, &body) in bodies.handles().iter().enumerate() {
            for (part, own) in bodies.infos[i].def.shapes.iter().enumerate() {
                let role = bodies.infos[i].def.role_of(own);
                if role != Role::Sensor && own.shape.contains(bodies.origin(i).apply_inverse(point)) {
                    expected.push(ShapeId { body, part });
                }
            }
        }
        prop_assert_eq!(world.shapes_at(point, &QueryFilter::default()).unwrap(), expected);
    }

    #[test]
    fn the_nearest_is_nearest(world in worlds(), point in points(8.0), limit in 0.0..4.0_f64) {
        let distances = all(&world, false).into_iter().map(|(id, collider, frame)| {
            let at = collision::distance_to_point(&collider.geometry, frame.apply_inverse(point));
            (at.distance.max(0.0), id)
        });
        let expected = distances.reduce(|a, b| if b.0 < a.0 { b } else { a });
        let filter = QueryFilter::default();
        let nearest = world.nearest(point, Real::INFINITY, &filter).unwrap();
        let found = nearest.map(|near| (near.distance, ShapeId { body: near.body, part: near.part }));
        prop_assert_eq!(found, expected);
        if let Some(near) = nearest {
            prop_assert!(close((near.point - point).norm(), near.distance));
        }
        let limited = world.nearest(point, limit, &filter).unwrap();
        prop_assert_eq!(limited, nearest.filter(|near| near.distance <= limit));
    }

    #[test]
    fn regions_and_shapes_find_what_overlaps(
        world in worlds(), shape in shapes(), pose in poses(5.0), corner in points(5.0),
        size in (0.0..4.0_f64, 0.0..4.0_f64),
    ) {
        let filter = QueryFilter::default();
        let (pieces, frame) = placed(&shape, &pose);
        let overlaps = |(_, collider, other): &(ShapeId, Collider, Frame)| {
            let other = other.seen_from(&frame);
            pieces.iter().any(|piece| collision::overlap(piece, &collider.geometry, &other))
        };
        let expected = all(&world, false).into_iter().filter(overlaps).map(|(id, ..)| id).collect();
        prop_assert_eq!(world.overlapping(&shape, &pose, &filter).unwrap(), once(expected));

        let region = Aabb { min: corner, max: corner + Vec2::new(size.0, size.1) };
        let rectangle = Shape::rectangle(size.0 + 1e-9, size.1 + 1e-9).unwrap();
        let center = Pose::new((region.min + region.max) / 2.0, 0.0);
        let as_shape = world.overlapping(&rectangle, &center, &filter).unwrap();
        let exact = world.shapes_in(&region, &filter).unwrap();
        prop_assert_eq!(&exact, &as_shape);
        let boxes = world.boxes_in(&region, &filter).unwrap();
        prop_assert!(exact.iter().all(|id| boxes.contains(id)), "{exact:?} in {boxes:?}");
        let mut visited = Vec::new();
        world.visit_region(&region, &filter, &mut |id| {
            visited.push(id);
            visited.len() < 2
        }).unwrap();
        prop_assert!(visited.len() <= 2 && visited.iter().all(|id| exact.contains(id)));
        prop_assert_eq!(visited.is_empty(), exact.is_empty());
    }

    #[test]
    fn a_moving_shape_hits_what_is_first(
        world in worlds(), shape in shapes(), pose in poses(5.0), way in points(10.0),
    ) {
        let (pieces, frame) = placed(&shape, &pose);
        let start = Pose::new(frame.position, pose.angle);
        let bodies = world.bodies();
        let mut expected: Vec<(Real, ShapeId)> = Vec::new();
        for (id, collider, _) in all(&world, false) {
            let rest = &bodies.poses[collider.body as usize];
            let hits = pieces.iter().filter_map(|piece| {
                collision::cast_shape((piece, &start), way, (&collider.geometry, rest))
            });
            let Some(fraction) = hits.map(|hit| hit.fraction).reduce(Real::min) else { continue };
            match expected.iter_mut().find(|(_, other)| *other == id) {
                Some(known) => known.0 = known.0.min(fraction),
                None => expected.push((fraction, id)),
            }
        }
        let filter = QueryFilter::default();
        let hits = world.cast_shape_all(&shape, &pose, way, &filter).unwrap();
        // Grazes may go either way by rounding; so compare what is hit firmly.
        for hit in &hits {
            let id = ShapeId { body: hit.body, part: hit.part };
            let known = expected.iter().find(|(_, other)| *other == id);
            prop_assert!(known.is_some_and(|(fraction, _)| close(*fraction, hit.fraction)), "{hit:?}");
        }
        prop_assert_eq!(hits.len(), expected.len());
        prop_assert!(hits.is_sorted_by(|a, b| a.fraction <= b.fraction));
        let first = world.cast_shape(&shape, &pose, way, &filter).unwrap();
        prop_assert_eq!(first, hits.first().copied());
    }

    #[test]
    fn distances_are_those_of_the_nearest_pieces(world in worlds()) {
        let handles = world.bodies().handles();
        let all = all(&world, true);
        for &a in handles {
            for &b in handles.iter().filter(|b| **b != a) {
                let of = |body| all.iter().filter(move |(id, ..)| id.body == body);
                let pairs = of(a).flat_map(|x| of(b).map(move |y| (x, y)));
                let expected = pairs.map(|((_, x, at_x), (_, y, at_y))| {
                    collision::distance(&x.geometry, &y.geometry, &at_y.seen_from(at_x)).distance
                });
                let expected = expected.reduce(Real::min).unwrap();
                let found = world.distance(a, b).unwrap();
                prop_assert!(close(found.distance, expected), "{found:?} {expected}");
                let gap = (found.on_b - found.on_a).dot(&found.normal);
                prop_assert!((gap - found.distance).abs() < 1e-9, "{found:?}");
            }
        }
    }

    #[test]
    fn to_be_asked_changes_nothing(
        defs in prop::collection::vec(super::history::defs(), 0..6), events in events(),
    ) {
        let mut worlds = [World::default(), World::default()];
        for (asked, world) in worlds.iter_mut().enumerate() {
            for def in &defs {
                world.add_body(def.clone()).unwrap();
            }
            for event in &events {
                happen(world, event, |world| {
                    if asked == 1 {
                        world.nearest(Vec2::zeros(), Real::INFINITY, &QueryFilter::default()).unwrap();
                    }
                });
            }
        }
        let [silent, asked] = worlds.map(|world| world.snapshot().to_bytes().unwrap());
        prop_assert_eq!(silent, asked);
    }
}
